//! Points in double-double arithmetic, rounded to `f64` at the end: what `point … --accuracy reference` answers, for inputs taken as exact.
//!
//! Closed forms where there are any, the same as in `f64`; on SO(3) the same integration, its steps to a hundredth of the error asked for. Inputs are
//! what `f64` holds, so an answer is half an ε off, however badly the problem is conditioned, as long as 106 bits hold it.

use super::{Answer, Metric, PointError, Reader, serret_andoyer, spin};
use crate::contract::accuracy::REFERENCE;
use crate::contract::work::Work;
use crate::effects::counted::integrated;
use crate::geometry::rotation_group::conjugate::{ConjugateError, first_conjugate_times};
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::metric::Metric as Inertia;
use crate::geometry::serret_andoyer::{
    Clairaut, Extremal, Metric as Body, NoConjugatePoint, Start, StartError, first_conjugate_point,
};
use crate::geometry::spin::reference::first_conjugate_point_to_reference;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// What rounding at the end adds to a relative error.
const ROUNDING: f64 = 0.5 * f64::EPSILON;
/// Of the error asked for, the part that steps may make.
const SHARE: f64 = 0.01;
/// Conjugate times asked for on SO(3).
const WANTED: usize = 2;
const INERTIA: &str = "the metric is A=… B=… C=…, inverse moments of inertia above 0";
const MOMENTUM: &str = "a start is H1=… H2=… H3=…, or Phi2=… Phi3=… p1=… p2=… p3=…";

/// The answer in double-double arithmetic, rounded.
pub(super) fn answer(reader: &Reader<'_>, relative_error: f64) -> Result<Answer, PointError> {
    match reader.metric {
        Metric::Spin => on_spin(reader),
        Metric::SerretAndoyer => on_serret_andoyer(reader),
        Metric::RotationGroup => on_rotation_group(reader, (SHARE * relative_error).max(REFERENCE)),
    }
}

fn refused(error: impl std::fmt::Display) -> PointError {
    PointError::Refused(error.to_string())
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

/// A start with its numbers taken as exact.
fn exact(start: Start) -> Start<DoubleDouble> {
    let number = DoubleDouble::from;
    match start {
        Start::Momenta { y0, p_x, p_y } => Start::Momenta { y0: number(y0), p_x: number(p_x), p_y: number(p_y) },
        Start::Darboux { phi0, clairaut, branch } => {
            let clairaut = match clairaut {
                Clairaut::PTheta(p_theta) => Clairaut::PTheta(number(p_theta)),
                Clairaut::Delta(delta) => Clairaut::Delta(number(delta)),
            };
            Start::Darboux { phi0: number(phi0), clairaut, branch }
        }
    }
}

/// The extremal; a start that in `f64` is the cusp's, and that only its rounding puts beyond, is that of the cusp.
fn extremal(metric: &Body<DoubleDouble>, start: Start, in_f64: &Body) -> Result<Extremal<DoubleDouble>, StartError> {
    let long = exact(start);
    let found = Extremal::new(metric, long);
    match (&found, long) {
        (Err(StartError::ClairautTooLarge { .. }), Start::Darboux { phi0, clairaut, branch })
            if Extremal::new(in_f64, start).is_ok() =>
        {
            let mirrored = matches!(clairaut, Clairaut::PTheta(p) if p < DoubleDouble::ZERO);
            let p_theta = metric.mu(phi0).sqrt();
            let clairaut = Clairaut::PTheta(if mirrored { -p_theta } else { p_theta });
            Extremal::new(metric, Start::Darboux { phi0, clairaut, branch })
        }
        _ => found,
    }
}

fn on_serret_andoyer(reader: &Reader<'_>) -> Result<Answer, PointError> {
    let (in_f64, start) = serret_andoyer::read(reader)?;
    let number = DoubleDouble::from;
    let metric = Body::new(number(in_f64.a()), number(in_f64.b()), number(in_f64.c())).map_err(refused)?;
    match first_conjugate_point(&extremal(&metric, start, &in_f64).map_err(refused)?) {
        Ok(point) => Ok(Answer {
            numbers: [point.t1, point.x, point.y, point.theta, point.phi, point.lower_bound]
                .map(|number| Some(number.to_f64()))
                .to_vec(),
            reason: None,
            error: Some(point.error.to_f64() + ROUNDING),
            route: "closed form: the pole-free equation of the conjugate time (from eq. 15), in double-double arithmetic, rounded"
                .into(),
            work: Work { elliptic_calls: point.elliptic_calls as u64, roots_solved: 1, rows: 1, ..Work::default() },
        }),
        Err(error @ NoConjugatePoint::NotSolved { .. }) => Err(PointError::Failed(error.to_string())),
        Err(reason) => Ok(Answer {
            numbers: vec![None; reader.metric.answers().len()],
            reason: Some(reason.to_string()),
            error: None,
            route: "classification of the trajectory by xi1, in double-double arithmetic".into(),
            work: Work { rows: 1, ..Work::default() },
        }),
    }
}

fn on_rotation_group(reader: &Reader<'_>, tolerance: f64) -> Result<Answer, PointError> {
    let number = |key, accepted| reader.number(key, accepted).map(DoubleDouble::from);
    let metric = Inertia::new(number("A", INERTIA)?, number("B", INERTIA)?, number("C", INERTIA)?).map_err(refused)?;
    let momentum = momentum(reader)?;
    let route = "integration of momentum and Jacobi fields in the body frame; eigenphases; in double-double arithmetic, rounded";
    let answered = |times: &[f64], reason, error, work: Work| Answer {
        numbers: (0..WANTED).map(|index| times.get(index).copied()).collect(),
        reason,
        error,
        route: route.into(),
        work: Work { rows: 1, ..work },
    };
    match first_conjugate_times(&metric, momentum, WANTED, tolerance) {
        Ok(found) => {
            let times: Vec<f64> = found.times.iter().map(|time| time.to_f64()).collect();
            Ok(answered(&times, None, Some(found.error + ROUNDING), integrated(found.work)))
        }
        Err(ConjugateError::Domain(error)) => Err(refused(error)),
        Err(ConjugateError::Fewer { found, t_max, .. }) => {
            let which = if found.is_empty() { "first" } else { "second" };
            let reason = format!("no {which} conjugate time up to t = {t_max:?}");
            Ok(answered(&found, Some(reason), None, Work::default()))
        }
        Err(error) => Err(PointError::Failed(error.to_string())),
    }
}

/// The momentum in the body, not rounded where it comes from Euler angles.
fn momentum(reader: &Reader<'_>) -> Result<[DoubleDouble; 3], PointError> {
    for euler in ["Phi1", "Phi2", "Phi3", "p1", "p2", "p3"] {
        for body in ["H1", "H2", "H3"] {
            reader.exclusive(body, euler, MOMENTUM)?;
        }
    }
    let number = |key| reader.number(key, MOMENTUM).map(DoubleDouble::from);
    if reader.has("H1") || reader.has("H2") || reader.has("H3") {
        return Ok([number("H1")?, number("H2")?, number("H3")?]);
    }
    let phi1 = if reader.has("Phi1") { number("Phi1")? } else { DoubleDouble::ZERO };
    let angles = [phi1, number("Phi2")?, number("Phi3")?];
    let momenta = [number("p1")?, number("p2")?, number("p3")?];
    EulerPoint { angles, momenta }.body_momentum().map_err(refused)
}
