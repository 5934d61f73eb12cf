//! The answers of `conjugate` in double-double arithmetic, rounded to `f64` at the end: for the inputs as given, right to half an ε.
//!
//! The formulas are the same ones, instantiated with [`DoubleDouble`]; so they share what is proved of them (the phase is monotone, no root is
//! skipped) and would share a slip. Independent oracles are in the tests. About 30 times the cost of `f64`.
//!
//! Not known here: when double-double is needed (`conjugate` decides that by its own error estimate).

use super::conjugate::{Arithmetic, ConjugatePoint, CutPoint, cut_point_of, point_at, position_of};
use super::extremal::Extremal;
use super::posed::{Limits, Posed};
use super::solve::{Quantity, SpinError, solve};
use super::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// What rounding to `f64` adds to a relative error.
const ROUNDING: f64 = 0.5 * f64::EPSILON;
/// The estimates of rounding count operations that err by half an ε; those of double-double err by up to 10·2^-106, which is 2.5 of its ε,
/// and its elementary functions by up to 16. Errors of up to 8 estimates were seen, next to a vertical tangent.
const LOOSE_ROUNDING: f64 = 32.0;

/// The first conjugate point, as [`super::conjugate::first_conjugate_point`], right to half an ε.
///
/// Domain: every [`Start`]. Guarantee: `error` bounds the difference of `t1` to the exact answer for the inputs as given, about half an ε
/// where the times can be told at all. Errors: [`SpinError`], where even this arithmetic loses the point.
pub fn first_conjugate_point_to_reference(start: &Start) -> Result<ConjugatePoint, SpinError> {
    let Posed { extremal, scale, mirror } = posed(start);
    let root = solve(&extremal, Quantity::Phase, DoubleDouble::ONE)?;
    let mut point = point_at(mirror, &extremal, &root).member(0).scaled(scale);
    point.arithmetic = Arithmetic::DoubleDouble;
    point.error = LOOSE_ROUNDING * point.error + ROUNDING;
    Ok(point)
}

/// The cut point, as [`super::conjugate::cut_point`], right to half an ε. Domain and errors: as there.
pub fn cut_point_to_reference(start: &Start) -> Result<CutPoint, SpinError> {
    let Posed { extremal, scale, mirror } = posed(start);
    let mut point = cut_point_of(mirror, &extremal)?.scaled(scale);
    point.error = LOOSE_ROUNDING * point.error + ROUNDING;
    Ok(point)
}

/// The point `r(t)`, as [`super::conjugate::position`], each coordinate right to half an ε of one. Domain and errors: as there.
pub fn position_to_reference(start: &Start, t: f64) -> Result<[f64; 3], SpinError> {
    let Posed { extremal, scale, mirror } = Posed::new(start, Limits::POSITION);
    let [r1, r2, r3] = position_of(mirror, &extremal, DoubleDouble::from(t / scale.time))?.map(Real::to_f64);
    Ok([r1, r2 * scale.time, r3])
}

/// The j-th conjugate time, as [`super::conjugate::nth_conjugate_time`], right to half an ε. Domain and errors: as there.
pub fn nth_conjugate_time_to_reference(start: &Start, j: u32) -> Result<f64, SpinError> {
    let Posed { extremal, scale, .. } = Posed::new(start, Limits::POSITION);
    Ok(solve(&extremal, Quantity::Phase, DoubleDouble::from(f64::from(j)))?.t.to_f64() * scale.time)
}

/// A first conjugate point that is not rounded.
#[derive(Debug, Clone, Copy)]
pub struct ReferencePoint {
    /// The first conjugate time.
    pub t1: DoubleDouble,
    /// `atan2(r3, r1)`.
    pub theta: DoubleDouble,
    /// An estimate of the relative error of the time.
    pub error: f64,
}

/// The first conjugate point of `p = |p_θ|` for inputs that need not be `f64` numbers: what condition numbers are taken from.
///
/// Domain: that of [`Start`] with `1e-12 ≤ k`, `p ≤ 1e100`. Errors: [`SpinError`].
pub fn first_conjugate_point_in_double_double(k: DoubleDouble, p: DoubleDouble) -> Result<ReferencePoint, SpinError> {
    let extremal = Extremal::new(k, p);
    let root = solve(&extremal, Quantity::Phase, DoubleDouble::ONE)?;
    let point = point_at(DoubleDouble::ONE, &extremal, &root);
    Ok(ReferencePoint { t1: point.t1, theta: point.theta, error: LOOSE_ROUNDING * point.error.to_f64() })
}

/// The position of `p = |p_θ|` at a time, for inputs that need not be `f64` numbers. Domain: `p ≤ 1e100`.
pub fn position_in_double_double(
    k: DoubleDouble,
    p: DoubleDouble,
    t: DoubleDouble,
) -> Result<[DoubleDouble; 3], SpinError> {
    position_of(DoubleDouble::ONE, &Extremal::new(k, p), t)
}

/// `δβ` at the n-th return to the equator: it vanishes where this return is conjugate, and `t1(p_θ)` has a vertical tangent.
pub fn delta_beta_at_return(k: DoubleDouble, p: DoubleDouble, n: u32) -> Result<DoubleDouble, SpinError> {
    let extremal = Extremal::new(k, p);
    let t = solve(&extremal, Quantity::Lambda, DoubleDouble::from(f64::from(n)))?.t;
    let state = extremal.state_near(t);
    Ok(state.delta_beta + state.delta_beta_rate * (t - state.t))
}

fn posed(start: &Start) -> Posed<DoubleDouble> {
    Posed::new(start, Limits::DOUBLE_DOUBLE)
}
