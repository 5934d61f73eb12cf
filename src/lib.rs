//! polhode

pub mod check;
pub mod cli;
pub mod contract;
pub mod effects;
pub mod experiments;
pub mod geometry;
pub mod numerics;
pub mod pipeline;
pub mod plot;
pub mod table;
