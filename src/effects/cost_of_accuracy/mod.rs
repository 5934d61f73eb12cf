//! What accuracy costs: achieved errors of first conjugate times, with counted work, and on demand time, by method and request.

pub mod counted;
pub mod printed_chart;
pub mod problem;
pub mod quantities;
pub mod rotation_group;
pub mod route;
pub mod serret_andoyer;
pub mod spin;
pub mod timed;
