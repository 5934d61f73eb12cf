//! Counted work: what a computation did, in numbers that do not depend on the machine.
//!
//! Asking for less does measurably less, and these counters are how that is shown: they are deterministic, so tests pin
//! them. Units: plain counts. Not known here: time.

/// What an integration (or several, added up) has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Number of scalar differential equations integrated together (the largest, when works are added up).
    pub state_dimension: u64,
    /// Steps taken.
    pub steps: u64,
    /// Evaluations of the base flow's right-hand side; for a power series, one per order and step; for a Runge-Kutta
    /// pair, one per stage, those of refused steps included.
    pub flow_evaluations: u64,
    /// Evaluations of one tangent column (Jacobi field), one per column and evaluation of the base flow.
    pub tangent_evaluations: u64,
    /// Event functions expanded along a step.
    pub event_evaluations: u64,
    /// Steps on which a root could not be excluded at once, so that roots were isolated.
    pub root_isolations: u64,
    /// Roots (or clusters of roots) found and refined.
    pub roots_found: u64,
    /// States evaluated inside steps.
    pub dense_points: u64,
    /// Coefficients of series kept beyond their step.
    pub kept_coefficients: u64,
    /// Evaluations of a watched invariant: one at the start, one for each step.
    pub monitor_evaluations: u64,
}

impl Work {
    /// The work of this and the other together.
    pub fn plus(self, other: Work) -> Work {
        Work {
            state_dimension: self.state_dimension.max(other.state_dimension),
            steps: self.steps + other.steps,
            flow_evaluations: self.flow_evaluations + other.flow_evaluations,
            tangent_evaluations: self.tangent_evaluations + other.tangent_evaluations,
            event_evaluations: self.event_evaluations + other.event_evaluations,
            root_isolations: self.root_isolations + other.root_isolations,
            roots_found: self.roots_found + other.roots_found,
            dense_points: self.dense_points + other.dense_points,
            kept_coefficients: self.kept_coefficients + other.kept_coefficients,
            monitor_evaluations: self.monitor_evaluations + other.monitor_evaluations,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adding_keeps_the_largest_dimension_and_sums_the_rest() {
        let first = Work { state_dimension: 9, steps: 3, roots_found: 1, ..Work::default() };
        let second = Work { state_dimension: 6, steps: 4, dense_points: 2, ..Work::default() };
        let watched = Work { monitor_evaluations: 4, kept_coefficients: 5, ..Work::default() };
        assert_eq!(watched.plus(watched), Work { monitor_evaluations: 8, kept_coefficients: 10, ..Work::default() });
        let sum = first.plus(second);
        assert_eq!((sum.state_dimension, sum.steps, sum.roots_found, sum.dense_points), (9, 7, 1, 2));
    }
}
