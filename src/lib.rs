//! polhode

pub mod contract;
pub mod numerics;
