//! Points in double-double arithmetic, rounded to `f64` at the end: what `point … --accuracy reference` answers, for inputs taken as exact.
//!
//! Closed forms, the same as in `f64`; on SO(3) integration where the closed form does not resolve a start. Inputs are what `f64` holds, so an
//! answer is half an ε off, however badly the problem is conditioned, as long as 106 bits hold it.

use super::{Answer, Metric, PointError, Reader, rotation_group, serret_andoyer, spin};
use crate::contract::work::Work;
use crate::geometry::rotation_group::first_two::first_two_conjugate_times_to_reference;
use crate::geometry::spin::reference::first_conjugate_point_to_reference;

/// What rounding at the end adds to a relative error.
const ROUNDING: f64 = 0.5 * f64::EPSILON;

/// The answer in double-double arithmetic, rounded.
pub(super) fn answer(reader: &Reader<'_>) -> Result<Answer, PointError> {
    match reader.metric {
        Metric::Spin => on_spin(reader),
        Metric::SerretAndoyer => serret_andoyer::to_reference(reader),
        Metric::RotationGroup => {
            let found = first_two_conjugate_times_to_reference(&rotation_group::read(reader)?);
            let answer = rotation_group::told(found)?;
            Ok(Answer {
                error: answer.error.map(|error| error + ROUNDING),
                route: format!("{}; rounded", answer.route),
                ..answer
            })
        }
    }
}

fn on_spin(reader: &Reader<'_>) -> Result<Answer, PointError> {
    let start = spin::read(reader)?;
    let point = first_conjugate_point_to_reference(&start).map_err(|error| PointError::Failed(error.to_string()))?;
    let numbers = [point.t1, point.theta, point.phi, point.r[0], point.r[1], point.r[2]];
    Ok(Answer {
        numbers: numbers.map(Some).to_vec(),
        reason: None,
        error: Some(point.error),
        route: "closed form: the only solution of Theta = pi (monotone phase), in double-double arithmetic, rounded"
            .into(),
        work: Work { elliptic_calls: u64::from(point.elliptic_calls), roots_solved: 1, rows: 1, ..Work::default() },
    })
}
