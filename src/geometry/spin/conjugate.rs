//! Conjugate points, the cut point and the extremal itself, for a start of the spin problem: the room's front door.
//!
//! At the j-th conjugate time `λ = jπ + χ` (see `phase`), so that the point there needs no angle λ:
//! `r = ((−1)^j/ρ) [cos χ (h3, 0, −h1) + (sin χ/G)(−h1 h2, ρ², −h2 h3)]`, `ρ² = h1² + h3²`. At any other time λ itself
//! stands in the place of `jπ + χ`. At the cut time `λ = π` (Lemma 4.4), and the cut point is
//! `θ = atan2(k sin β, −cos β)` on the equator.
//!
//! Times are in the unit that `H = 1` fixes, angles in radians, `r` on the unit sphere.

use super::extremal::{Extremal, hypotenuse};
use super::phase::State;
use super::solve::{PhaseRoot, Quantity, SpinError, solve};
use super::start::Start;
use crate::numerics::pack::Pack;
use crate::numerics::real::Real;

/// A coordinate below this many ε (in size) is rounding: near the meridian `r3` then has no sign of its own.
const COORDINATE_ROUNDING: f64 = 32.0;
/// Relative step of the difference quotients that estimate the condition number.
const CONDITION_STEP: f64 = 1e-6;

/// The first conjugate point of an extremal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConjugatePoint {
    /// The first conjugate time.
    pub t1: f64,
    /// `atan2(r3, r1)`, in `(−π, π]`.
    pub theta: f64,
    /// The angle from the pole `r2 = 1`, in `[0, π]`.
    pub phi: f64,
    /// The point on the unit sphere.
    pub r: [f64; 3],
    /// Relative bound of the difference of `t1` to the exact answer for the inputs as given.
    pub error: f64,
    /// Closed-form evaluations.
    pub iterations: u32,
    /// Carlson functions called.
    pub elliptic_calls: u32,
    /// How often the extremal has returned to the equator by then: `floor(λ/π)`.
    pub crossings: u32,
}

/// The cut point of an extremal: its first return to the equator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutPoint {
    /// The cut time.
    pub t_cut: f64,
    /// Its place on the equator, in `(−π, π]`.
    pub theta: f64,
    /// The point on the unit sphere, `r2 = 0`.
    pub r: [f64; 3],
    /// Relative bound of the difference of `t_cut` to the exact answer for the inputs as given.
    pub error: f64,
    /// Closed-form evaluations.
    pub iterations: u32,
    /// Carlson functions called.
    pub elliptic_calls: u32,
}

/// The extremal's constants for a start, mirror image left out.
pub fn extremal(start: &Start) -> Extremal<f64> {
    Extremal::new(start.k(), start.p_theta().abs())
}

/// The first conjugate point: the only instant at which the monotone phase Θ is π, so no root can be skipped.
///
/// Domain: every [`Start`]. Guarantee: `t1` to a few ε relative times the problem's condition number, the point to a
/// few ε absolutely beyond what `t1` moves it; `error` is a bound. Special cases: `p_θ = 0` is an ordinary start (θ is
/// then exactly 0 or π); for `p_θ < 0` the mirror image `θ → −θ`. Errors: [`SpinError`].
pub fn first_conjugate_point(start: &Start) -> Result<ConjugatePoint, SpinError> {
    let extremal = extremal(start);
    let root = solve(&extremal, Quantity::Phase, 1.0)?;
    Ok(point_at(start.mirror(), &extremal, &root).member(0))
}

/// [`ConjugatePoint`] over packs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Points<S> {
    t1: S,
    theta: S,
    phi: S,
    r: [S; 3],
    error: S,
    iterations: S,
    elliptic_calls: S,
    crossings: S,
}

impl<S: Pack> Points<S> {
    /// The point of member `i`, rounded to `f64`.
    #[inline(always)]
    pub(super) fn member(&self, i: usize) -> ConjugatePoint {
        let rounded = |x: S| Real::to_f64(x.lane(i));
        ConjugatePoint {
            t1: rounded(self.t1),
            theta: rounded(self.theta),
            phi: rounded(self.phi),
            r: self.r.map(rounded),
            error: rounded(self.error),
            iterations: rounded(self.iterations) as u32,
            elliptic_calls: rounded(self.elliptic_calls) as u32,
            crossings: rounded(self.crossings) as u32,
        }
    }
}

/// The first conjugate point for the root of Θ = π; `mirror` is −1 for `p_θ < 0`, else 1.
#[inline(always)]
pub(super) fn point_at<S: Pack>(mirror: S, extremal: &Extremal<S>, root: &PhaseRoot<S>) -> Points<S> {
    let r = conjugate_position(mirror, extremal, root);
    Points {
        t1: root.t,
        theta: r[2].atan2(r[0]),
        phi: hypotenuse(r[0].abs(), r[2].abs()).atan2(r[1]),
        r,
        error: root.error,
        iterations: root.evaluations,
        elliptic_calls: root.elliptic_calls,
        crossings: S::ONE + root.chi_turns + (root.chi_rest / S::PI).floor(),
    }
}

/// The j-th conjugate time, `j ≥ 1`: where `Θ = jπ`. Errors: [`SpinError`], also for `j = 0`.
pub fn nth_conjugate_time(start: &Start, j: u32) -> Result<f64, SpinError> {
    Ok(solve(&extremal(start), Quantity::Phase, f64::from(j))?.t)
}

/// How many conjugate times lie in `(0, t]`: `floor(Θ(t)/π)`.
///
/// Domain: `t ≥ 0` finite. Within the rounding of Θ of a conjugate time the count may be off by that one.
pub fn conjugate_count(start: &Start, t: f64) -> Result<u32, SpinError> {
    let extremal = extremal(start);
    let (state, late) = state_at(&extremal, t)?;
    let phase = state.phase_beyond(0.0) + late * state.phase_rate(&extremal);
    Ok((phase / std::f64::consts::PI).floor().max(0.0) as u32)
}

/// The cut point (Lemma 4.4): the first return to the equator, `λ = π`.
///
/// Domain: every [`Start`]. Guarantee: as for [`first_conjugate_point`].
pub fn cut_point(start: &Start) -> Result<CutPoint, SpinError> {
    cut_point_of(start.mirror(), &extremal(start))
}

/// [`cut_point`] in any scalar, rounded to `f64`.
pub(super) fn cut_point_of<S: Real>(mirror: S, extremal: &Extremal<S>) -> Result<CutPoint, SpinError> {
    let root = solve(extremal, Quantity::Lambda, S::ONE)?;
    let across = mirror * extremal.k * root.sin_beta;
    let length = hypotenuse(across.abs(), root.cos_beta.abs());
    let r = [-root.cos_beta / length, S::ZERO, positive_zero(across) / length];
    Ok(CutPoint {
        t_cut: root.t.to_f64(),
        theta: r[2].atan2(r[0]).to_f64(),
        r: r.map(Real::to_f64),
        error: root.error.to_f64(),
        iterations: root.evaluations.to_f64() as u32,
        elliptic_calls: root.elliptic_calls.to_f64() as u32,
    })
}

/// The point `r(t)` on the unit sphere.
///
/// Domain: `t ≥ 0` finite. Guarantee: a few ε of `1 + λ(t)` absolutely; poles and equator are ordinary points.
pub fn position(start: &Start, t: f64) -> Result<[f64; 3], SpinError> {
    position_of(start.mirror(), &extremal(start), t)
}

/// [`position`] in any scalar.
pub(super) fn position_of<S: Real>(mirror: S, extremal: &Extremal<S>, t: S) -> Result<[S; 3], SpinError> {
    let (state, late) = state_at(extremal, t)?;
    let (two, one) = (S::from_f64(2.0), S::ONE);
    let half = (state.half_turns / two).floor();
    let sign = if state.half_turns - two * half > S::from_f64(0.5) { -one } else { one };
    let (sine, cosine) = state.lambda_rest.sin_cos();
    let h = state.momentum(extremal.k);
    let r = rotated(extremal, h, sign * sine, sign * cosine);
    let moved = shifted(extremal, h, r, late);
    Ok([moved[0], moved[1], mirror * moved[2]])
}

/// The momentum `h(t)` in so(3)*.
///
/// Domain: `t ≥ 0` finite. Guarantee: a few ε of `|h| (1 + |dh/dt| t)`.
pub fn momentum(start: &Start, t: f64) -> Result<[f64; 3], SpinError> {
    let extremal = extremal(start);
    let (state, late) = state_at(&extremal, t)?;
    let h = state.momentum(extremal.k);
    let moved = shifted(&extremal, h, h, late);
    // The reflection r3 → −r3 acts on h, a pseudovector, by (h1, h2, h3) → (−h1, −h2, h3).
    Ok([start.mirror() * moved[0], start.mirror() * moved[1], moved[2]])
}

/// An estimate of the condition number `max(|∂ ln t1/∂ ln k|, |∂ ln t1/∂ ln p_θ|)`, by central differences.
///
/// Costs four more solutions. Next to a vertical tangent of `t1` it is the mean over a relative step of 1e-6.
pub fn condition_estimate(start: &Start) -> Result<f64, SpinError> {
    let step = CONDITION_STEP;
    let time = |k: f64, p_theta: f64| -> Result<f64, SpinError> { nth_conjugate_time(&Start::new(k, p_theta)?, 1) };
    let (k, p) = (start.k(), start.p_theta());
    let center = time(k, p)?;
    let by_k = time(k * (1.0 + step), p)? - time(k * (1.0 - step), p)?;
    let by_p = if p == 0.0 { 0.0 } else { time(k, p * (1.0 + step))? - time(k, p * (1.0 - step))? };
    Ok(by_k.abs().max(by_p.abs()) / (2.0 * step * center))
}

/// The state whose time is nearest to `t`, and how much later `t` is (a few ε of `t`).
fn state_at<S: Real>(extremal: &Extremal<S>, t: S) -> Result<(State<S>, S), SpinError> {
    if !(t >= S::ZERO && t.is_finite()) {
        return Err(SpinError::OutOfDomain { what: "t", found: t.to_f64(), accepted: "finite and not negative" });
    }
    let state = extremal.state_near(t);
    Ok((state, t - state.t))
}

/// `r` for the angle λ whose sine and cosine are given.
#[inline(always)]
fn rotated<S: Pack>(extremal: &Extremal<S>, h: [S; 3], sine: S, cosine: S) -> [S; 3] {
    let rho = hypotenuse(h[0].abs(), h[2].abs());
    let (across, along) = (cosine / rho, sine / extremal.casimir);
    let h2 = h[1] / rho;
    [across * h[2] - along * h[0] * h2, along * rho, -across * h[0] - along * h[2] * h2]
}

/// `v + ω × v·dt`, `ω = (h1/2k², 0, h3/2)`, for a `dt` of the size of rounding errors.
fn shifted<S: Real>(extremal: &Extremal<S>, h: [S; 3], v: [S; 3], dt: S) -> [S; 3] {
    let two = S::from_f64(2.0);
    let (w1, w3) = (h[0] / (two * extremal.k * extremal.k) * dt, h[2] / two * dt);
    [v[0] - w3 * v[1], v[1] + w3 * v[0] - w1 * v[2], v[2] + w1 * v[1]]
}

#[inline(always)]
fn conjugate_position<S: Pack>(mirror: S, extremal: &Extremal<S>, root: &PhaseRoot<S>) -> [S; 3] {
    let two_k = extremal.k + extremal.k;
    let h = [two_k * root.sin_beta, -two_k * root.beta_rate, root.cos_beta + root.cos_beta];
    // λ = π + χ.
    let [r1, r2, r3] = rotated(extremal, h, -root.sin_chi, -root.cos_chi);
    // r3 is positive for p > 0, of order p³; below rounding its sign would put θ at −π instead of π. The error of the time
    // moves the point with a speed of at most max(1, 1/k).
    let moved = root.error * root.t * S::ONE.max(S::ONE / extremal.k);
    let rounding = (S::from_f64(COORDINATE_ROUNDING) * S::EPSILON).max(moved);
    let r3 = S::select(r3.abs().at_most(rounding), r3.abs(), r3);
    let r3 = S::select(extremal.p.equals(S::ZERO), S::ZERO, r3);
    [r1, r2, positive_zero(mirror * r3)]
}

/// `−0.0` becomes `0.0`, so that `atan2` gives π and not −π.
#[inline(always)]
fn positive_zero<S: Pack>(x: S) -> S {
    S::select(x.equals(S::ZERO), S::ZERO, x)
}
