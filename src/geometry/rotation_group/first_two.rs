//! The first two conjugate times of a start: closed form in `f64`, in double-double where that is not enough, integration where
//! neither is.
//!
//! The closed form ([`super::closed_form`]) estimates its own rounding. Beyond [`ENOUGH`] it is evaluated in double-double; where the
//! separating polhode is nearer than that resolves (the estimate is beyond `BELIEVED`), momentum and Jacobi fields are integrated
//! ([`super::conjugate`]), which knows no separating polhode, again in double-double where `f64` says that it is not enough.
//!
//! The condition number of t1 is at least 1/3 (t is homogeneous of degree −1 in M and in A, B, C), so an answer within `ENOUGH`
//! is stable whatever the start. Units: those of the start. Not known here: how inputs are named.

use crate::geometry::rotation_group::closed_form::{ClosedForm, Root};
use crate::geometry::rotation_group::conjugate::{ConjugateError, first_conjugate_times_by};
use crate::geometry::rotation_group::metric::Metric;
use crate::geometry::rotation_group::polhode_curve::{Polhode, Start};
use crate::numerics::counts::Work;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::PowerSeries;
use crate::numerics::taylor::integrator::Settings;

/// The relative error up to which an answer is taken as it is: stable whatever the condition number (it is 1/3 at least).
pub const ENOUGH: f64 = 20.0 * f64::EPSILON;
/// What rounding to `f64` adds.
const ROUNDED: f64 = 0.5 * f64::EPSILON;
/// What the closed form's estimate may say at most to be believed, in `f64` and in double-double (far below what an `f64` can tell):
/// it is made of first derivatives.
const BELIEVED: [f64; 2] = [1e-6, 1e-19];
/// For want of better.
const LAST_RESORT: f64 = 1e-17;
/// Relative error a step of integrations in double-double: half of their digits to spare.
const LONG_TOLERANCE: f64 = 1e-26;
/// Beyond this ratio of A, B, C products leave the range of double-double.
const LARGEST_RATIO: f64 = 1e100;
/// An answer with a larger relative error is none.
const WORST: f64 = 1e-3;
/// Steps after which an integration in `f64`, and in double-double, gives up: half a second of either.
const MOST_STEPS: [u64; 2] = [25_000, 1500];

/// How the times were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The closed form in `f64`.
    ClosedForm,
    /// The closed form in double-double.
    LongClosedForm,
    /// Integration in `f64`.
    Integration,
    /// Integration in double-double.
    LongIntegration,
}

impl Route {
    /// As an answer says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form: the only solutions of F+ = 2 pi and F- = 2 pi",
            Self::LongClosedForm => "closed form in double-double: the only solutions of F+ = 2 pi and F- = 2 pi",
            Self::Integration => "integration of momentum and Jacobi fields in the body frame; eigenphases",
            Self::LongIntegration => {
                "integration in double-double of momentum and Jacobi fields in the body frame; eigenphases"
            }
        }
    }
}

/// t1 ≤ t2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTwo {
    /// Rounded.
    pub times: [f64; 2],
    /// What rounding left out, where double-double knew more.
    pub rests: [f64; 2],
    /// Bound on the relative error of both.
    pub error: f64,
    /// How they were found.
    pub route: Route,
    /// Elliptic integrals and functions evaluated.
    pub elliptic_calls: u64,
    /// Of integrations.
    pub work: Work,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FirstTwoError {
    /// The times are too large or too small for an `f64`.
    #[error("t1 = {mantissa} times 2^{exponent}, which is not a number in double precision")]
    NotRepresentable {
        /// t1 is this
        mantissa: f64,
        /// times two to this power.
        exponent: i32,
    },
    /// No route resolves the start.
    #[error(
        "the start is {distance:e} from the separating polhode (in 2H/|M|^2 less the middle one of A, B, C, relative to the largest), and \
         the largest of A, B, C is {ratio:e} times the smallest: its conjugate times depend on more digits than double-double has"
    )]
    Unresolved {
        /// The relative distance of k to the middle value.
        distance: f64,
        /// The largest inverse moment over the smallest.
        ratio: f64,
    },
    /// The inverse moments of inertia are too far apart.
    #[error("the largest of A, B, C is {ratio:e} times the smallest: not both are numbers in common units")]
    TooFarApart {
        /// The largest over the smallest.
        ratio: f64,
    },
    /// The integration says.
    #[error(transparent)]
    Integration(#[from] ConjugateError),
}

/// The first two conjugate times, with multiplicity.
///
/// `t1 ≤ t2`. Domain: any start. Guarantee: `error` bounds the relative error of both; wherever the closed form applies it is at most
/// [`ENOUGH`], and half an ε more for the rounding to `f64`. Special cases: equal values among A, B, C, and momenta along an axis, have the exact limit.
///
/// # Errors
/// [`FirstTwoError`].
pub fn first_two_conjugate_times(start: &Start) -> Result<FirstTwo, FirstTwoError> {
    find(start, Asked::Within(ENOUGH))
}

/// The same to a relative error, [`ENOUGH`] at least: what asks for less gets no double-double where `f64` reaches it.
///
/// # Errors
/// [`FirstTwoError`].
pub fn first_two_conjugate_times_within(start: &Start, relative_error: f64) -> Result<FirstTwo, FirstTwoError> {
    find(start, Asked::Within(relative_error.max(ENOUGH)))
}

/// The same in double-double throughout, rounded at the end: `times + rests`. What answers are measured against.
///
/// # Errors
/// [`FirstTwoError`].
pub fn first_two_conjugate_times_to_reference(start: &Start) -> Result<FirstTwo, FirstTwoError> {
    find(start, Asked::Reference)
}

/// By how much the times of another start differ from those found, relative and to first order: what condition numbers are made of.
/// None where the other one lies on the separating polhode or the closed form does not resolve it.
pub fn relative_change(found: &FirstTwo, moved: &Start) -> Option<[f64; 2]> {
    let mut form = ClosedForm::new(Polhode::of(moved).ok()?);
    let size = size(moved);
    let times = [0, 1].map(|i| {
        let (high, low) = (libm::ldexp(found.times[i], moved.exponent), libm::ldexp(found.rests[i], moved.exponent));
        DoubleDouble::from_sum(high, low) * size
    });
    let change = form.relative_change(times);
    let believed = found.error <= BELIEVED[1] && matches!(found.route, Route::LongClosedForm);
    (believed && change.iter().all(|x| x.is_finite())).then_some(change)
}

/// The cosine of the angle between the momentum at a time and the axis that it goes round, in the body, in any scalar; its relative error
/// (rounding of the phase, that is, in proportion to the time). Positive: which end of the axis is that of the start.
///
/// Formula: `√(p/(p+r)) dn(u0 + ω t)` of [`super::closed_form`]. None on the separating polhode, and for a symmetric body,
/// where it is constant.
pub fn steady_cosine<S: Real>(
    start: &Start,
    time: f64,
    scalar: impl Fn(&Polhode<DoubleDouble>) -> Polhode<S>,
) -> Option<(S, f64)> {
    let polhode = Polhode::of(start).ok().filter(|polhode| !polhode.symmetric)?;
    let here = DoubleDouble::from_sum(libm::ldexp(time, start.exponent), 0.0) * size(start);
    let time = S::from_f64(here.high()) + S::from_f64(here.low());
    Some(ClosedForm::new(scalar(&polhode)).steady_cosine(time))
}

/// The time in which the cosine of [`steady_cosine`] comes back: 2K/ω. None where that has no number.
pub fn steady_period(start: &Start) -> Option<f64> {
    let polhode = Polhode::of(start).ok().filter(|polhode| !polhode.symmetric)?;
    let period = ClosedForm::new(polhode.rounded()).period() / size(start).to_f64();
    Some(libm::ldexp(period, -start.exponent))
}

/// |M| in the units of [`Start`].
fn size(start: &Start) -> DoubleDouble {
    Real::sqrt(start.momentum.iter().fold(DoubleDouble::default(), |sum, m| sum + *m * *m))
}

/// How good an answer is asked for.
#[derive(Clone, Copy)]
enum Asked {
    /// Within a relative error; one in `f64` will do.
    Within(f64),
    /// In double-double throughout, with the rest that rounding leaves out.
    Reference,
}

fn find(start: &Start, asked: Asked) -> Result<FirstTwo, FirstTwoError> {
    let [first, second] = spread(start);
    if second / first > LARGEST_RATIO {
        return Err(FirstTwoError::TooFarApart { ratio: second / first });
    }
    let (in_f64, rounded) = match asked {
        Asked::Within(enough) => (Some(enough), ROUNDED),
        // It keeps its rest.
        Asked::Reference => (None, 0.0),
    };
    let mut calls = 0;
    let mut best: Option<FirstTwo> = None;
    if let Ok(polhode) = Polhode::of(start) {
        let mut short = ClosedForm::new(polhode.rounded());
        let found = short.roots(None);
        calls += short.calls();
        let error = largest_error(&found);
        if in_f64.is_some_and(|enough| error <= enough.min(BELIEVED[0])) {
            let times = found.map(|root| (root.time, 0.0));
            return told(start, times, error + rounded, Route::ClosedForm, calls, Work::default());
        }
        let mut long = ClosedForm::new(polhode);
        let found = long.roots(Some(found));
        calls += long.calls();
        let error = largest_error(&found);
        let times = found.map(|root| (root.time.high(), root.time.low()));
        let answer = told(start, times, error + rounded, Route::LongClosedForm, calls, Work::default());
        if error <= BELIEVED[1] {
            return answer;
        }
        // Between is a range where it is right more often than not: for want of better only.
        best = answer.ok().filter(|_| error < LAST_RESORT);
    }
    let mut work = Work::default();
    let exact = start.momentum.iter().all(|m| m.low() == 0.0);
    if let Some(enough) = in_f64.filter(|_| exact) {
        let metric = metric(start.inverse_inertia.map(Real::to_f64))?;
        let settings = Settings { maximum_steps: MOST_STEPS[0], ..Settings::new(f64::EPSILON) };
        if let Ok(found) =
            first_conjugate_times_by(PowerSeries, &metric, start.momentum.map(Real::to_f64), 2, &settings)
        {
            work = work.plus(found.work);
            if found.error <= enough {
                let times = [0, 1].map(|i| (found.times[i], 0.0));
                return told(start, times, found.error, Route::Integration, calls, work);
            }
        }
    }
    let settings = Settings { maximum_steps: MOST_STEPS[1], ..Settings::new(LONG_TOLERANCE) };
    if let Ok(found) =
        first_conjugate_times_by(PowerSeries, &metric(start.inverse_inertia)?, start.momentum, 2, &settings)
    {
        let times = [0, 1].map(|i| (found.times[i].high(), found.times[i].low()));
        let work = work.plus(found.work);
        let answer = told(start, times, found.error + rounded, Route::LongIntegration, calls, work)?;
        if answer.error < WORST && best.as_ref().is_none_or(|best| answer.error <= best.error) {
            return Ok(answer);
        }
    }
    best.ok_or_else(|| FirstTwoError::Unresolved { distance: distance(start), ratio: second / first })
}

fn metric<S: Real>([a, b, c]: [S; 3]) -> Result<Metric<S>, FirstTwoError> {
    Metric::new(a, b, c).map_err(|error| FirstTwoError::Integration(error.into()))
}

/// The smallest and the largest inverse moment of inertia.
fn spread(start: &Start) -> [f64; 2] {
    let values = start.inverse_inertia.map(Real::to_f64);
    [values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(0.0, f64::max)]
}

fn distance(start: &Start) -> f64 {
    Polhode::of(start).map_or(0.0, |polhode| (polhode.middle / polhode.a[2]).to_f64())
}

fn largest_error<S: Real>(roots: &[Root<S>; 2]) -> f64 {
    roots[0].error.max(roots[1].error)
}

/// An answer in the units of the start.
fn told(
    start: &Start,
    times: [(f64, f64); 2],
    error: f64,
    route: Route,
    elliptic_calls: u64,
    work: Work,
) -> Result<FirstTwo, FirstTwoError> {
    let size = size(start);
    let closed = matches!(route, Route::ClosedForm | Route::LongClosedForm);
    let mut answer = FirstTwo { times: [0.0; 2], rests: [0.0; 2], error, route, elliptic_calls, work };
    for (i, (high, low)) in times.into_iter().enumerate() {
        let mut time = DoubleDouble::from_sum(high, low);
        if closed {
            time /= size;
        }
        let high = libm::ldexp(time.high(), -start.exponent);
        let normal = high.is_finite() && high >= f64::MIN_POSITIVE;
        if !normal {
            return Err(FirstTwoError::NotRepresentable { mantissa: time.high(), exponent: -start.exponent });
        }
        (answer.times[i], answer.rests[i]) = (high, libm::ldexp(time.low(), -start.exponent));
    }
    // Double ones, one rounding apart.
    if answer.times[0] > answer.times[1] {
        answer.times.swap(0, 1);
        answer.rests.swap(0, 1);
    }
    Ok(answer)
}

#[cfg(test)]
#[path = "first_two_tests.rs"]
mod tests;
