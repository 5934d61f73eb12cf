//! `point spin k= p_theta=`: the start of section 5.2 (H = 1, φ(0) = π/2, θ(0) = 0, p_φ(0) = −2), in closed form.

use super::{Answer, PointError, Reader, in_lanes};
use crate::contract::work::Work;
use crate::geometry::spin::conjugate::{ConjugatePoint, first_conjugate_point};
use crate::geometry::spin::lanes::first_conjugate_points;
use crate::geometry::spin::solve::SpinError;
use crate::geometry::spin::start::Start;

const ACCEPTED: &str = "a start is k=… p_theta=…";

pub(super) fn answer(reader: &Reader<'_>) -> Result<Answer, PointError> {
    told(first_conjugate_point(&read(reader)?))
}

/// Many rows at once: for each the answer that it has alone.
pub(super) fn answers(readers: &[Reader<'_>]) -> Vec<Result<Answer, PointError>> {
    in_lanes(readers, read, first_conjugate_points, told)
}

pub(super) fn read(reader: &Reader<'_>) -> Result<Start, PointError> {
    let (k, p_theta) = (reader.number("k", ACCEPTED)?, reader.number("p_theta", ACCEPTED)?);
    Start::new(k, p_theta).map_err(|error| PointError::Refused(error.to_string()))
}

fn told(point: Result<ConjugatePoint, SpinError>) -> Result<Answer, PointError> {
    let point = point.map_err(|error| PointError::Failed(error.to_string()))?;
    let numbers = [point.t1, point.theta, point.phi, point.r[0], point.r[1], point.r[2]];
    Ok(Answer {
        numbers: numbers.map(Some).to_vec(),
        reason: None,
        error: Some(point.error),
        route: point.route(),
        work: Work { elliptic_calls: u64::from(point.elliptic_calls), roots_solved: 1, rows: 1, ..Work::default() },
    })
}
