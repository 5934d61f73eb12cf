//! `point rotation-group A= B= C=` and a body momentum, or Euler angles with their momenta: the first two conjugate times.
//!
//! The metric's conjugate times depend on the body momentum alone, not on the attitude: `Phi1` is accepted and of no effect. The
//! momentum of Euler angles is computed in double-double and never rounded. `error` bounds the relative errors of t1 and of t2.

use super::{Answer, PointError, Reader};
use crate::contract::work::Work;
use crate::effects::counted::integrated;
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::first_two::{FirstTwo, FirstTwoError, first_two_conjugate_times_within};
use crate::geometry::rotation_group::metric::Metric;
use crate::geometry::rotation_group::polhode_curve::Start;

const METRIC: &str = "the metric is A=… B=… C=…, inverse moments of inertia above 0";
const ACCEPTED: &str = "a start is H1=… H2=… H3=…, or Phi2=… Phi3=… p1=… p2=… p3=…";

pub(super) fn answer(reader: &Reader<'_>, relative_error: f64) -> Result<Answer, PointError> {
    told(first_two_conjugate_times_within(&read(reader)?, relative_error))
}

fn refused(error: &dyn std::fmt::Display) -> PointError {
    PointError::Refused(error.to_string())
}

/// The start that is given.
pub(super) fn read(reader: &Reader<'_>) -> Result<Start, PointError> {
    let [a, b, c] = [reader.number("A", METRIC)?, reader.number("B", METRIC)?, reader.number("C", METRIC)?];
    let metric = Metric::new(a, b, c).map_err(|error| refused(&error))?;
    for euler in ["Phi1", "Phi2", "Phi3", "p1", "p2", "p3"] {
        for body in ["H1", "H2", "H3"] {
            reader.exclusive(body, euler, ACCEPTED)?;
        }
    }
    let number = |key| reader.number(key, ACCEPTED);
    if reader.has("H1") || reader.has("H2") || reader.has("H3") {
        let momentum = [number("H1")?, number("H2")?, number("H3")?];
        return Start::new(&metric, momentum).map_err(|error| refused(&error));
    }
    if reader.has("Phi1") {
        number("Phi1")?;
    }
    let point = EulerPoint {
        angles: [0.0, number("Phi2")?, number("Phi3")?],
        momenta: [number("p1")?, number("p2")?, number("p3")?],
    };
    Start::from_euler(&metric, &point).map_err(|error| refused(&error))
}

/// What is answered with a result.
pub(super) fn told(found: Result<FirstTwo, FirstTwoError>) -> Result<Answer, PointError> {
    match found {
        Ok(found) => Ok(Answer {
            numbers: found.times.map(Some).to_vec(),
            reason: None,
            error: Some(found.error),
            route: found.route.name().into(),
            work: Work { elliptic_calls: found.elliptic_calls, roots_solved: 2, rows: 1, ..integrated(found.work) },
        }),
        Err(FirstTwoError::Integration(error)) => Err(PointError::Failed(error.to_string())),
        Err(error) => Err(refused(&error)),
    }
}
