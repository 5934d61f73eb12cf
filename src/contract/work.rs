//! What a node did, counted: deterministic, a second output of the node, pinned by tests. Times are never in here.

use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign};

/// Counted work. Zero means "not done": what a scene does not ask for stays zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Work {
    /// Dimension of the integrated state (the largest one, where nodes are added up).
    pub state_dimension: u64,
    /// Integration steps.
    pub steps: u64,
    /// Taylor coefficients (or stages) of the base flow.
    pub flow_evaluations: u64,
    /// The same for tangent columns (Jacobi fields).
    pub tangent_evaluations: u64,
    /// The same for event functions.
    pub event_evaluations: u64,
    /// Elliptic integrals and functions evaluated.
    pub elliptic_calls: u64,
    /// Equations solved for a root.
    pub roots_solved: u64,
    /// Points of dense output.
    pub dense_points: u64,
    /// Coefficients of series kept beyond their step; not written where there is none.
    #[serde(skip_serializing_if = "is_zero")]
    pub kept_coefficients: u64,
    /// Evaluations of watched invariants; not written where there is none.
    #[serde(skip_serializing_if = "is_zero")]
    pub monitor_evaluations: u64,
    /// Rows of the result.
    pub rows: u64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.state_dimension = self.state_dimension.max(other.state_dimension);
        self.steps += other.steps;
        self.flow_evaluations += other.flow_evaluations;
        self.tangent_evaluations += other.tangent_evaluations;
        self.event_evaluations += other.event_evaluations;
        self.elliptic_calls += other.elliptic_calls;
        self.roots_solved += other.roots_solved;
        self.dense_points += other.dense_points;
        self.kept_coefficients += other.kept_coefficients;
        self.monitor_evaluations += other.monitor_evaluations;
        self.rows += other.rows;
    }
}

impl Add for Work {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl std::iter::Sum for Work {
    fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
        iter.fold(Self::default(), Add::add)
    }
}
