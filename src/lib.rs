//! polhode

pub mod geometry;
pub mod numerics;
