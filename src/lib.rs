//! polhode

pub mod check;
pub mod contract;
pub mod effects;
pub mod experiments;
pub mod geometry;
pub mod numerics;
pub mod plot;
pub mod table;
