//! What is compared: a problem with its starts, and the effects that are added to its base flow.
//!
//! Each start has one span of time, up to the conjugate time that a scene would ask for; every set of effects is integrated over that
//! span, so that rows differ by the effects alone. What each set is, in types of the power-series engine, the problems' files say.

use crate::contract::node::{Kind, NodeError};
use crate::numerics::counts::Work;
use crate::numerics::taylor::step::order_for;
use serde::Serialize;

/// What is asked of an integration beside, or in place of, its base flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectSet {
    /// The base flow alone: where the extremal is at the end.
    Base,
    /// One Jacobi column, whose error steers the steps too.
    OneColumn,
    /// One Jacobi column that has no say in the steps.
    OneColumnNotSteering,
    /// Two Jacobi columns.
    TwoColumns,
    /// Two Jacobi columns that have no say in the steps.
    TwoColumnsNotSteering,
    /// Three Jacobi columns.
    ThreeColumns,
    /// Three Jacobi columns that have no say in the steps.
    ThreeColumnsNotSteering,
    /// The columns that conjugate times need, and the event that finds them.
    Conjugate,
    /// The series of every step, kept.
    SeriesKept,
    /// States at given times, none kept.
    StatesAtTimes,
    /// The attitude in place of the momentum in the body, which follows from it.
    Attitude,
    /// The energy, watched.
    Monitor,
}

impl EffectSet {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Base => "base",
            Self::OneColumn => "one-column",
            Self::OneColumnNotSteering => "one-column-not-steering",
            Self::TwoColumns => "two-columns",
            Self::TwoColumnsNotSteering => "two-columns-not-steering",
            Self::ThreeColumns => "three-columns",
            Self::ThreeColumnsNotSteering => "three-columns-not-steering",
            Self::Conjugate => "conjugate",
            Self::SeriesKept => "series-kept",
            Self::StatesAtTimes => "states-at-times",
            Self::Attitude => "attitude",
            Self::Monitor => "monitor",
        }
    }
}

/// A problem with its starts.
pub trait Problem: Clone + Serialize + Send + Sync + 'static {
    /// One start, ready to be integrated: flow, state, columns, span, times.
    type Posed: Send + Sync;
    /// The sets of effects that it has, the base flow first.
    const SETS: &'static [EffectSet];
    /// The kind of the node that counts.
    const COUNTED: &'static Kind;
    /// The kind of the node that measures.
    const TIMED: &'static Kind;

    /// All starts with their spans; `samples` is the number of times at which states are asked for.
    ///
    /// # Errors
    /// A start outside the domain, named.
    fn pose(&self, samples: usize) -> Result<Vec<Self::Posed>, NodeError>;

    /// Integrates one start with one set of effects.
    ///
    /// # Errors
    /// An integration that failed, with its start; a set that the problem does not have.
    fn integrate(&self, posed: &Self::Posed, set: EffectSet, tolerance: f64) -> Result<Work, NodeError>;

    /// Multiplications in the series of one step of this order.
    ///
    /// # Errors
    /// A set that the problem does not have.
    fn multiplications(&self, set: EffectSet, order: usize) -> Result<u64, NodeError>;
}

/// A set that a problem does not have: a defect.
pub fn no_such_set(set: EffectSet) -> NodeError {
    NodeError::new(format!("this problem has no set of effects {:?}", set.name()))
}

/// The times `(i/samples)·end`, i from 1 on.
pub fn times_until(end: f64, samples: usize) -> Vec<f64> {
    (1..=samples).map(|i| end * (i as f64 / samples as f64)).collect()
}

/// All multiplications in the series of a work's steps.
///
/// # Errors
/// A set that the problem does not have; steps of another order than the accuracy asks for.
pub fn multiplications<P: Problem>(problem: &P, set: EffectSet, tolerance: f64, work: &Work) -> Result<u64, NodeError> {
    let order = order_for(tolerance.max(f64::EPSILON));
    if work.flow_evaluations != work.steps * order as u64 {
        let (steps, found) = (work.steps, work.flow_evaluations);
        return Err(NodeError::new(format!("{steps} steps of order {order} have not {found} coefficients")));
    }
    Ok(work.steps * problem.multiplications(set, order)?)
}
