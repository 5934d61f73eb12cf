//! What each effect costs: counted work, and on demand time, of the same starts with one effect more each.

pub mod counted;
pub mod machine;
pub mod problem;
pub mod rotation_group;
pub mod serret_andoyer;
pub mod spin;
pub mod timed;
