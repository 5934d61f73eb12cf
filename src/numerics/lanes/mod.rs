//! Eight `f64` beside each other, and the choice of the instructions that carry them out.

mod avx512;
pub mod dispatch;
pub mod elementary;
mod portable;
