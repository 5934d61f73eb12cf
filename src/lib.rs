//! polhode

pub mod geometry;
pub mod numerics;
pub mod plot;
pub mod table;
