//! The article's mathematics: metrics, flows, closed forms. Built on numerics alone; knows no files and no figures.

pub mod serret_andoyer;
pub mod spin;
