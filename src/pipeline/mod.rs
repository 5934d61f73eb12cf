//! The runner.

pub mod disk;
pub mod events;
pub mod exports;
pub mod graph;
pub mod heads;
mod parallel;
pub mod record;
pub mod report;
pub mod run;
pub mod runs;
mod schedule;
pub mod store;
mod work;
