//! Eight `f64` beside each other, and the choice of the instructions that carry them out.
//!
//! A formula is written over [`crate::numerics::pack::Pack`] and knows nothing of this folder; [`dispatch`] runs it with the packs of
//! the widest instructions that the processor has. `unsafe` code stands here alone.

mod avx512;
pub mod dispatch;
pub mod elementary;
mod portable;
