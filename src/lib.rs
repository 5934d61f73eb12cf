//! polhode

pub mod check;
pub mod contract;
pub mod numerics;
pub mod table;
