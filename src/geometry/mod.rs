//! The article's mathematics: flows, tangents, closed forms. Built on numerics alone.

pub mod serret_andoyer;
pub mod spin;
