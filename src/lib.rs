//! polhode

pub mod contract;
pub mod numerics;
pub mod plot;
pub mod table;
