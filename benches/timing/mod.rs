//! Timing for the benchmarks: many passes over the same work on one thread, warm; the fastest pass and the median one.
//!
//! The fastest pass is the one that other processes disturbed least, so ratios are made of it; the median says how disturbed the machine
//! was. No statistics beyond that: the differences of interest are factors.

use std::time::{Duration, Instant};

/// Passes that are always made.
const LEAST_PASSES: usize = 9;
/// Passes after which it is enough.
const MOST_PASSES: usize = 2000;
/// Time after which it is enough.
const BUDGET: Duration = Duration::from_millis(700);

/// Microseconds of the fastest pass and of the median one.
pub struct Pass {
    pub fastest: f64,
    pub median: f64,
}

/// Repeats `work`, after one pass that warms up.
pub fn passes(mut work: impl FnMut()) -> Pass {
    work();
    let mut microseconds = Vec::new();
    let begun = Instant::now();
    while microseconds.len() < LEAST_PASSES || (microseconds.len() < MOST_PASSES && begun.elapsed() < BUDGET) {
        let start = Instant::now();
        work();
        microseconds.push(start.elapsed().as_secs_f64() * 1e6);
    }
    microseconds.sort_by(f64::total_cmp);
    Pass { fastest: microseconds[0], median: microseconds[microseconds.len() / 2] }
}
