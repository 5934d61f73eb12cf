//! Timing for the benchmarks: many passes over the same work on one thread, warm; the fastest pass and the median one.
//!
//! A pass goes over all work in blocks; each block's fastest time counts, and their sum is what is reported: a block is shorter than the
//! time slices of the system, so other processes disturb few of them. The median pass says how disturbed the machine was. No
//! statistics beyond that: the differences of interest are factors.

use std::time::{Duration, Instant};

/// Passes that are always made.
const LEAST_PASSES: usize = 9;
/// Passes after which it is enough.
const MOST_PASSES: usize = 2000;
/// Time after which it is enough.
const BUDGET: Duration = Duration::from_millis(700);

/// Microseconds of one pass over all blocks: the sum of each block's fastest time, and the median pass.
pub struct Pass {
    pub fastest: f64,
    pub median: f64,
}

/// Repeats `work` on the blocks `0..blocks`, after one pass that warms up.
pub fn passes(blocks: usize, mut work: impl FnMut(usize)) -> Pass {
    (0..blocks).for_each(&mut work);
    let mut fastest = vec![f64::INFINITY; blocks];
    let mut microseconds = Vec::new();
    let begun = Instant::now();
    while microseconds.len() < LEAST_PASSES || (microseconds.len() < MOST_PASSES && begun.elapsed() < BUDGET) {
        let mut pass = 0.0;
        for (block, fastest) in fastest.iter_mut().enumerate() {
            let start = Instant::now();
            work(block);
            let time = start.elapsed().as_secs_f64() * 1e6;
            pass += time;
            *fastest = fastest.min(time);
        }
        microseconds.push(pass);
    }
    microseconds.sort_by(f64::total_cmp);
    Pass { fastest: fastest.iter().sum(), median: microseconds[microseconds.len() / 2] }
}
