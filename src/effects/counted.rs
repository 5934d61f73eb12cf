//! Counted work as nodes report it, from what the power-series integrator counts.

use crate::contract::work::Work;
use crate::numerics::counts;

/// The work of integrations, roots included.
pub fn integrated(work: counts::Work) -> Work {
    Work {
        state_dimension: work.state_dimension,
        steps: work.steps,
        flow_evaluations: work.flow_evaluations,
        tangent_evaluations: work.tangent_evaluations,
        event_evaluations: work.event_evaluations,
        roots_solved: work.roots_found,
        dense_points: work.dense_points,
        kept_coefficients: work.kept_coefficients,
        monitor_evaluations: work.monitor_evaluations,
        ..Work::default()
    }
}
