//! The article's mathematics: metrics, flows, closed forms. Built on numerics alone; knows no files and no figures.

pub mod rotation_group;
pub mod serret_andoyer;
pub mod spin;
