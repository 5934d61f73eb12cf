//! polhode

pub mod numerics;
