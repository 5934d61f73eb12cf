//! The article's statements, each with the check that decides it.

pub mod spin_points;
pub mod spin_system;
pub mod spin_metric;
pub mod statement;
