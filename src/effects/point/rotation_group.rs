//! `point rotation-group A= B= C=` and a body momentum, or Euler angles with their momenta: the first two conjugate times.
//!
//! The metric's conjugate times depend on the body momentum alone, not on the attitude: `Phi1` is accepted and of no effect.

use super::{Answer, PointError, Reader};
use crate::contract::work::Work;
use crate::geometry::rotation_group::conjugate::{ConjugateError, first_conjugate_times};
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::metric::Metric;

const METRIC: &str = "the metric is A=… B=… C=…, inverse moments of inertia above 0";
const ACCEPTED: &str = "a start is H1=… H2=… H3=…, or Phi2=… Phi3=… p1=… p2=… p3=…";
/// Conjugate times asked for.
const WANTED: usize = 2;

pub(super) fn answer(reader: &Reader<'_>, relative_error: f64) -> Result<Answer, PointError> {
    let refused = |error: &dyn std::fmt::Display| PointError::Refused(error.to_string());
    let [a, b, c] = [reader.number("A", METRIC)?, reader.number("B", METRIC)?, reader.number("C", METRIC)?];
    let metric = Metric::new(a, b, c).map_err(|error| refused(&error))?;
    let momentum = momentum(reader)?;
    // Beyond "article" nothing is gained: rounding decides.
    let tolerance = relative_error.max(f64::EPSILON);
    let tolerance = if tolerance <= crate::contract::accuracy::ARTICLE { f64::EPSILON } else { tolerance };
    let route = "integration of momentum and Jacobi fields in the body frame; eigenphases";
    match first_conjugate_times(&metric, momentum, WANTED, tolerance) {
        Ok(found) => Ok(Answer {
            numbers: (0..WANTED).map(|index| found.times.get(index).copied()).collect(),
            reason: None,
            error: Some(found.error),
            route: route.into(),
            work: Work { rows: 1, ..crate::effects::counted::integrated(found.work) },
        }),
        Err(ConjugateError::Domain(error)) => Err(refused(&error)),
        Err(ConjugateError::Fewer { found, t_max, .. }) => Ok(Answer {
            numbers: (0..WANTED).map(|index| found.get(index).copied()).collect(),
            reason: Some(format!(
                "no {} conjugate time up to t = {t_max:?}",
                if found.is_empty() { "first" } else { "second" }
            )),
            error: None,
            route: route.into(),
            work: Work { rows: 1, ..Work::default() },
        }),
        Err(error) => Err(PointError::Failed(error.to_string())),
    }
}

fn momentum(reader: &Reader<'_>) -> Result<[f64; 3], PointError> {
    for euler in ["Phi1", "Phi2", "Phi3", "p1", "p2", "p3"] {
        for body in ["H1", "H2", "H3"] {
            reader.exclusive(body, euler, ACCEPTED)?;
        }
    }
    let number = |key| reader.number(key, ACCEPTED);
    if reader.has("H1") || reader.has("H2") || reader.has("H3") {
        return Ok([number("H1")?, number("H2")?, number("H3")?]);
    }
    let phi1 = if reader.has("Phi1") { number("Phi1")? } else { 0.0 };
    let point = EulerPoint {
        angles: [phi1, number("Phi2")?, number("Phi3")?],
        momenta: [number("p1")?, number("p2")?, number("p3")?],
    };
    point.body_momentum().map_err(|error| PointError::Refused(error.to_string()))
}
