//! `point serret-andoyer A= B= C=` and a start: momenta at `y0`, or the Darboux chart at arc length, in closed form.

use super::{Answer, Given, PointError, Reader, in_lanes};
use crate::contract::work::Work;
use crate::geometry::serret_andoyer::lanes::{NoPoint, first_conjugate_points};
use crate::geometry::serret_andoyer::{
    Branch, Clairaut, ConjugatePoint, Extremal, Metric, NoConjugatePoint, Start, first_conjugate_point,
};

const METRIC: &str = "the metric is A=… B=… C=… with 0 < A < B < C";
const ACCEPTED: &str =
    "a start is y0=… p_x=… p_y=…, or phi0=… with p_theta=… or delta=… and branch=ascending|descending";

pub(super) fn answer(reader: &Reader<'_>) -> Result<Answer, PointError> {
    let (metric, start) = read(reader)?;
    let point = Extremal::new(&metric, start).map_err(NoPoint::from);
    told(point.and_then(|extremal| first_conjugate_point(&extremal).map_err(NoPoint::from)))
}

/// Many rows at once: for each the answer that it has alone.
pub(super) fn answers(readers: &[Reader<'_>]) -> Vec<Result<Answer, PointError>> {
    in_lanes(readers, read, first_conjugate_points, told)
}

pub(super) fn read(reader: &Reader<'_>) -> Result<(Metric, Start), PointError> {
    let [a, b, c] = [reader.number("A", METRIC)?, reader.number("B", METRIC)?, reader.number("C", METRIC)?];
    let metric = Metric::new(a, b, c).map_err(|error| PointError::Refused(error.to_string()))?;
    Ok((metric, start(reader)?))
}

fn told(point: Result<ConjugatePoint, NoPoint>) -> Result<Answer, PointError> {
    match point {
        Ok(point) => Ok(Answer {
            numbers: [point.t1, point.x, point.y, point.theta, point.phi, point.lower_bound].map(Some).to_vec(),
            reason: None,
            error: Some(point.error),
            route: "closed form: the pole-free equation of the conjugate time (from eq. 15)".into(),
            work: Work { elliptic_calls: point.elliptic_calls as u64, roots_solved: 1, rows: 1, ..Work::default() },
        }),
        Err(NoPoint::Start(error)) => Err(PointError::Refused(error.to_string())),
        Err(NoPoint::Extremal(error @ NoConjugatePoint::NotSolved { .. })) => {
            Err(PointError::Failed(error.to_string()))
        }
        Err(NoPoint::Extremal(reason)) => Ok(Answer {
            numbers: vec![None; 6],
            reason: Some(reason.to_string()),
            error: None,
            route: "classification of the trajectory by xi1".into(),
            work: Work { rows: 1, ..Work::default() },
        }),
    }
}

fn start(reader: &Reader<'_>) -> Result<Start, PointError> {
    for (darboux, momenta) in [("phi0", "y0"), ("p_theta", "p_x"), ("delta", "p_x"), ("branch", "p_y")] {
        reader.exclusive(darboux, momenta, ACCEPTED)?;
    }
    if reader.has("y0") || reader.has("p_x") || reader.has("p_y") {
        for key in ["phi0", "p_theta", "delta", "branch"] {
            reader.exclusive("y0", key, ACCEPTED)?;
        }
        let [y0, p_x, p_y] =
            [reader.number("y0", ACCEPTED)?, reader.number("p_x", ACCEPTED)?, reader.number("p_y", ACCEPTED)?];
        return Ok(Start::Momenta { y0, p_x, p_y });
    }
    reader.exclusive("p_theta", "delta", ACCEPTED)?;
    let phi0 = reader.number("phi0", ACCEPTED)?;
    let clairaut = if reader.has("delta") {
        Clairaut::Delta(reader.number("delta", ACCEPTED)?)
    } else {
        Clairaut::PTheta(reader.number("p_theta", ACCEPTED)?)
    };
    let branch = match reader.given.get("branch") {
        Some(Given::Word(word)) if word == "ascending" => Branch::Ascending,
        Some(Given::Word(word)) if word == "descending" => Branch::Descending,
        Some(other) => {
            let found = match other {
                Given::Word(word) => format!("{word:?}"),
                Given::Number(number) => number.to_string(),
            };
            let accepted = "ascending (phi' > 0 at the start) or descending".to_owned();
            return Err(PointError::Value { key: "branch".into(), found, accepted });
        }
        // Where the extremal starts at its turning point the branch does not matter; elsewhere it must be said.
        None => return Err(PointError::Missing { metric: reader.metric.name(), key: "branch", accepted: ACCEPTED }),
    };
    Ok(Start::Darboux { phi0, clairaut, branch })
}
