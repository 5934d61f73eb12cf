//! The article's mathematics: metrics, flows, closed forms. Knows no files and no figures.

pub mod serret_andoyer;
