//! polhode

pub mod contract;
pub mod numerics;
pub mod pipeline;
