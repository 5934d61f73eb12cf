//! The answers of `conjugate` in double-double arithmetic, rounded to `f64` at the end: for the inputs as given, right to half an ε.
//!
//! The formulas are the same ones, instantiated with [`DoubleDouble`]; so they share what is proved of them (the phase is monotone, no root is
//! skipped) and would share a slip. Independent oracles are in the tests. About 30 times the cost of `f64`.
//!
//! Not known here: when double-double is needed (`conjugate` decides that by its own error estimate).

use super::conjugate::{ConjugatePoint, CutPoint, cut_point_of, point_at, position_of};
use super::extremal::Extremal;
use super::solve::{Quantity, SpinError, solve};
use super::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// What rounding to `f64` adds to a relative error.
const ROUNDING: f64 = 0.5 * f64::EPSILON;
/// Above this `p/max(1, k)` the extremal is that of its limit `p → ∞` to 60 digits, where `p t1` and `p r2` depend on k alone. Squares of much
/// larger numbers leave the range of the arithmetic.
const LIMIT_MOMENTUM: f64 = 1e30;

/// The first conjugate point, as [`super::conjugate::first_conjugate_point`], right to half an ε.
///
/// Domain: every [`Start`]. Guarantee: `error` bounds the difference of `t1` to the exact answer for the inputs as given, about half an ε
/// where the times can be told at all. Errors: [`SpinError`], where even this arithmetic loses the point.
pub fn first_conjugate_point_to_reference(start: &Start) -> Result<ConjugatePoint, SpinError> {
    let Posed { extremal, scale, mirror } = Posed::new(start);
    let root = solve(&extremal, Quantity::Phase, DoubleDouble::ONE)?;
    let mut point = point_at(mirror, &extremal, &root).member(0);
    point.t1 *= scale;
    point.r[1] *= scale;
    point.error += ROUNDING;
    Ok(point)
}

/// The cut point, as [`super::conjugate::cut_point`], right to half an ε. Domain and errors: as there.
pub fn cut_point_to_reference(start: &Start) -> Result<CutPoint, SpinError> {
    let Posed { extremal, scale, mirror } = Posed::new(start);
    let mut point = cut_point_of(mirror, &extremal)?;
    point.t_cut *= scale;
    point.error += ROUNDING;
    Ok(point)
}

/// The point `r(t)`, as [`super::conjugate::position`], each coordinate right to half an ε of one. Domain and errors: as there.
pub fn position_to_reference(start: &Start, t: f64) -> Result<[f64; 3], SpinError> {
    let Posed { extremal, scale, mirror } = Posed::new(start);
    let [r1, r2, r3] = position_of(mirror, &extremal, DoubleDouble::from(t / scale))?.map(Real::to_f64);
    Ok([r1, r2 * scale, r3])
}

/// The first conjugate time for inputs that need not be `f64` numbers, not rounded, and an estimate of its relative error.
///
/// Domain: that of [`Start`], `|p_θ| ≤ 1e100`. This is what condition numbers are taken from, by difference quotients.
pub fn first_conjugate_time_in_double_double(
    k: DoubleDouble,
    p_theta: DoubleDouble,
) -> Result<(DoubleDouble, f64), SpinError> {
    let root = solve(&Extremal::new(k, p_theta.abs()), Quantity::Phase, DoubleDouble::ONE)?;
    Ok((root.t, root.error.to_f64()))
}

/// A start in double-double, its `p_θ` brought into range: times and r2 are to be multiplied by `scale`, a power of two.
struct Posed {
    extremal: Extremal<DoubleDouble>,
    scale: f64,
    mirror: DoubleDouble,
}

impl Posed {
    fn new(start: &Start) -> Self {
        let (k, p) = (start.k(), start.p_theta().abs());
        let limit = LIMIT_MOMENTUM * k.max(1.0);
        let scale = if p > limit { libm::exp2(f64::from(libm::ilogb(limit) - libm::ilogb(p))) } else { 1.0 };
        let extremal = Extremal::new(k.into(), DoubleDouble::from(p * scale));
        Self { extremal, scale, mirror: start.mirror().into() }
    }
}
