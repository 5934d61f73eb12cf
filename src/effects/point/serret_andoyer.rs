//! `point serret-andoyer A= B= C=` and a start: momenta at `y0`, or the Darboux chart at arc length, in closed form.

use super::{Answer, Given, PointError, Reader, in_lanes};
use crate::contract::work::Work;
use crate::geometry::serret_andoyer::lanes::{NoPoint, first_conjugate_points};
use crate::geometry::serret_andoyer::reference::{first_conjugate_point_to_reference, in_doubt};
use crate::geometry::serret_andoyer::{
    Branch, Clairaut, ConjugatePoint, Extremal, Metric, NoConjugatePoint, Start, first_conjugate_point,
};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

const METRIC: &str = "the metric is A=… B=… C=… with 0 < A < B < C";
const CLOSED_FORM: &str = "closed form: the pole-free equation of the conjugate time (from eq. 15)";
const LONG: &str = ", in double-double: rounding in f64 hides how near to a limit this start is";
const ACCEPTED: &str =
    "a start is y0=… p_x=… p_y=…, or phi0=… with p_theta=… or delta=… and branch=ascending|descending";

pub(super) fn answer(reader: &Reader<'_>) -> Result<Answer, PointError> {
    let (metric, start) = read(reader)?;
    let extremal = Extremal::new(&metric, start).map_err(NoPoint::from);
    let point = extremal.and_then(|extremal| first_conjugate_point(&extremal).map_err(NoPoint::from));
    told(((metric, start), point))
}

/// Many rows at once: for each the answer that it has alone.
pub(super) fn answers(readers: &[Reader<'_>]) -> Vec<Result<Answer, PointError>> {
    let solve = |starts: &[(Metric, Start)]| starts.iter().copied().zip(first_conjugate_points(starts)).collect();
    in_lanes(readers, read, solve, told)
}

pub(super) fn read(reader: &Reader<'_>) -> Result<(Metric, Start), PointError> {
    let [a, b, c] = [reader.number("A", METRIC)?, reader.number("B", METRIC)?, reader.number("C", METRIC)?];
    let metric = Metric::new(a, b, c).map_err(|error| PointError::Refused(error.to_string()))?;
    Ok((metric, start(reader)?))
}

/// The answer in `f64`, or where that is in doubt in double-double.
fn told(((metric, start), point): ((Metric, Start), Result<ConjugatePoint, NoPoint>)) -> Result<Answer, PointError> {
    if !in_doubt(&metric, start, &point) {
        let calls = point.as_ref().map_or(0, |point| point.elliptic_calls);
        return written(point, "", calls);
    }
    let before = point.map_or(0, |point| point.elliptic_calls);
    let long = first_conjugate_point_to_reference([metric.a(), metric.b(), metric.c()], start);
    let calls = before + long.as_ref().map_or(0, |point| point.elliptic_calls);
    written(long.map(rounded), LONG, calls)
}

/// The answer in double-double, rounded.
pub(super) fn to_reference(reader: &Reader<'_>) -> Result<Answer, PointError> {
    let (metric, start) = read(reader)?;
    let long = first_conjugate_point_to_reference([metric.a(), metric.b(), metric.c()], start);
    let calls = long.as_ref().map_or(0, |point| point.elliptic_calls);
    written(long.map(rounded), ", in double-double arithmetic, rounded", calls)
}

/// Rounds to `f64`, which may be half an ε of the error.
fn rounded(point: ConjugatePoint<DoubleDouble>) -> ConjugatePoint {
    let error = point.error.to_f64() + 0.5 * f64::EPSILON;
    ConjugatePoint {
        t1: point.t1.to_f64(),
        x: point.x.to_f64(),
        y: point.y.to_f64(),
        theta: point.theta.to_f64(),
        phi: point.phi.to_f64(),
        lower_bound: point.lower_bound.to_f64(),
        error,
        iterations: point.iterations,
        elliptic_calls: point.elliptic_calls,
    }
}

fn written(
    point: Result<ConjugatePoint, NoPoint>,
    precision: &str,
    elliptic_calls: usize,
) -> Result<Answer, PointError> {
    let elliptic_calls = elliptic_calls as u64;
    match point {
        Ok(point) => Ok(Answer {
            numbers: [point.t1, point.x, point.y, point.theta, point.phi, point.lower_bound].map(Some).to_vec(),
            reason: None,
            error: Some(point.error),
            route: format!("{CLOSED_FORM}{precision}"),
            work: Work { elliptic_calls, roots_solved: 1, rows: 1, ..Work::default() },
        }),
        Err(NoPoint::Start(error)) => Err(PointError::Refused(error.to_string())),
        Err(NoPoint::Extremal(error @ NoConjugatePoint::NotSolved { .. })) => {
            Err(PointError::Failed(error.to_string()))
        }
        Err(NoPoint::Extremal(reason)) => Ok(Answer {
            numbers: vec![None; 6],
            reason: Some(reason.to_string()),
            error: None,
            route: format!("classification of the trajectory by xi1{precision}"),
            work: Work { elliptic_calls, rows: 1, ..Work::default() },
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
