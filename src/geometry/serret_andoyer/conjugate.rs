//! The first conjugate point of an oscillating extremal (section 3.2.2, Lemma 3.5), and why others have none (Corollary 3.11).
//!
//! Equation (15), `I(T) = ΛT`, becomes by the addition theorems and the phase `v` from the equator
//!
//! `P(v1) − P(v0) = 2N`, `T = M t1 = 2K + v1 − v0`, `P(v) = ∫₀^v (dc² − Λ) = m' ∫₀^v sc² + λ v`, `N = E − λK = m B + (m' − λ) K`,
//!
//! with `λ = 1 − Λ = A D/(B X1 + A D)`, `B = ∫cos²/Δ`, `m' − λ = C D X1/(X3 (B X1 + A D)) > 0`. `P` is odd, strictly increasing and runs from −∞ to ∞ on `(−K, K)`;
//! `N > 0`. So there is exactly one root, above `v0`; no bracket and no case is needed: not for a start on the equator
//! (`v0 = 0`), not for one near a turning point (`v0 → ∓K`: `T − 2K ~ 2N/P'(v0)`), not for the separatrix (`m' → 0`). The first
//! positive conjugate time lies between `2K` and `2K` plus the time to the first turning point. Descending extremals are
//! mirrored, `v → −v`; the article's `ψ0` is `K + v0`.
//!
//! The unknown is `S = sc(v) = sinh w`; with `D = √(1 + m'S²) = dc(v)`, `dP/dw = (m'S² + λ)/D` and
//! `d²P/dw² = (1 + Λ/D²) m' S √(1+S²)/D`, both positive for `S > 0`: P is convex in w. How it is solved, for one extremal
//! or for eight beside each other, is `equation.rs`; for many starts there is `lanes.rs`. Everything summed is positive.
//!
//! Checked against the pole-free equation of eq. (15) solved with 50 digits and against the printed locus. Not known here:
//! later conjugate times (each needs one more `2N` and `2K`), cut points.

use super::equation::{self, MAX_ITERATIONS, Time};
use super::extremal::{Extremal, ExtremalClass};
use crate::numerics::real::Real;

/// The time of a first conjugate point, without its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConjugateTime<S: Real = f64> {
    /// The first conjugate time `t1 > 0`.
    pub t1: S,
    /// `2K/M`, the half period: `t1` is never smaller (Theorem 3.9).
    pub lower_bound: S,
    /// Estimate of the relative difference between `t1` and the exact value for the inputs as given.
    pub error: S,
    /// Steps of the root finder.
    pub iterations: usize,
    /// Elliptic integrals evaluated.
    pub elliptic_calls: usize,
}

/// A first conjugate point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConjugatePoint<S: Real = f64> {
    /// The first conjugate time `t1 > 0`.
    pub t1: S,
    /// The angle `x` there, zero at the start.
    pub x: S,
    /// The angle `y` there, on the universal cover.
    pub y: S,
    /// The angle θ of the Darboux chart; the same as `x`.
    pub theta: S,
    /// The distance φ from the equator there.
    pub phi: S,
    /// `2K/M`, the half period: `t1` is never smaller (Theorem 3.9).
    pub lower_bound: S,
    /// Estimate of the relative difference between `t1` and the exact value for the inputs as given.
    pub error: S,
    /// Steps of the root finder.
    pub iterations: usize,
    /// Elliptic integrals evaluated.
    pub elliptic_calls: usize,
}

impl<S: Real> ConjugatePoint<S> {
    /// Whether no number of it is infinite or "not a number".
    pub fn numbers_are_finite(&self) -> bool {
        [self.t1, self.x, self.y, self.phi, self.lower_bound, self.error].into_iter().all(S::is_finite)
    }
}

/// Why an extremal has no conjugate point.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoConjugatePoint {
    /// `ξ1 > 1`.
    #[error(
        "the trajectory rotates (xi1 = {xi1} > 1): rotating trajectories have no conjugate points (Corollary 3.11)"
    )]
    Rotating {
        /// `ξ1`.
        xi1: f64,
    },
    /// `ξ1 > ξ3`.
    #[error(
        "p_theta = {p_theta} is below C^(-1/2) times sqrt(2h): no motion of a rigid body, y is monotone and there are no \
         conjugate points"
    )]
    Unphysical {
        /// `p_θ`.
        p_theta: f64,
    },
    /// `ξ1 = 1`.
    #[error("the trajectory lies on the separatrix (xi1 = 1): t1 tends to infinity there, no conjugate point")]
    Separatrix,
    /// `y = 0 mod π` at rest.
    #[error(
        "the trajectory rests at y = 0 mod pi (rotation about the middle axis): the curvature is negative there, no conjugate point"
    )]
    MiddleAxis,
    /// The root finder gave up: a defect.
    #[error("the equation for the conjugate time was not solved in {iterations} steps: please report this input")]
    NotSolved {
        /// Steps made.
        iterations: usize,
    },
}

/// The first conjugate time `t1 > 0` of an extremal.
///
/// Domain: oscillating extremals (`0 ≤ ξ1 < 1`, `δ > 0`). Guarantee: a few ε times the condition of the problem; `error` says
/// how many. Special cases: starts at a turning point and the equator have `t1 = 2K/M` exactly. Errors: [`NoConjugatePoint`].
pub fn first_conjugate_time<S: Real>(extremal: &Extremal<S>) -> Result<ConjugateTime<S>, NoConjugatePoint> {
    why_none(extremal)?;
    let found = equation::time(&extremal.oscillating());
    let iterations = solved_in(&found)?;
    Ok(ConjugateTime {
        t1: found.t1,
        lower_bound: found.lower_bound,
        error: found.error,
        iterations,
        elliptic_calls: elliptic_calls_of_time(iterations),
    })
}

/// The first conjugate point of an extremal: its time and its place.
///
/// Domain, guarantee and errors as for [`first_conjugate_time`]; angles to a few ε times their own condition.
pub fn first_conjugate_point<S: Real>(extremal: &Extremal<S>) -> Result<ConjugatePoint<S>, NoConjugatePoint> {
    why_none(extremal)?;
    let found = equation::place(&extremal.oscillating(), &extremal.chart());
    let iterations = solved_in(&found.time)?;
    Ok(ConjugatePoint {
        t1: found.time.t1,
        x: found.x,
        y: found.y,
        theta: found.x,
        phi: found.phi,
        lower_bound: found.time.lower_bound,
        error: found.time.error,
        iterations,
        elliptic_calls: elliptic_calls_of_point(iterations),
    })
}

/// The reason why an extremal has no conjugate point, if it has none.
pub(super) fn why_none<S: Real>(extremal: &Extremal<S>) -> Result<(), NoConjugatePoint> {
    match extremal.class {
        ExtremalClass::Equator | ExtremalClass::Oscillating => Ok(()),
        ExtremalClass::Rotating => Err(NoConjugatePoint::Rotating { xi1: extremal.xi1().to_f64() }),
        ExtremalClass::Unphysical => Err(NoConjugatePoint::Unphysical { p_theta: extremal.p_x.to_f64() }),
        ExtremalClass::Separatrix => Err(NoConjugatePoint::Separatrix),
        ExtremalClass::MiddleAxis => Err(NoConjugatePoint::MiddleAxis),
    }
}

/// The steps that the solution took. Errors: there is none.
fn solved_in<S: Real>(found: &Time<S>) -> Result<usize, NoConjugatePoint> {
    if found.unsolved {
        return Err(NoConjugatePoint::NotSolved { iterations: MAX_ITERATIONS });
    }
    Ok(found.iterations.to_f64() as usize)
}

/// K and B; F and R_D together for the start, for the coarse step and for each other one.
pub(super) fn elliptic_calls_of_time(iterations: usize) -> usize {
    if iterations == 0 { 2 } else { 4 + iterations }
}

/// Besides, J over a quarter period, at the start and at the end.
pub(super) fn elliptic_calls_of_point(iterations: usize) -> usize {
    elliptic_calls_of_time(iterations) + 3
}

/// What Theorem 3.9 says about `t1`, in units of `K/M`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConjugateTimeBounds<S: Real = f64> {
    /// `t1 M/K`.
    pub ratio: S,
    /// The lower bound: 2, attained at turning points.
    pub lower: S,
    /// The printed upper bound: 3. True of the smaller of both `|t1|` at starts with `ψ0 ∈ [0, K]`, not of every first `t > 0`.
    pub printed_upper: S,
    /// The upper bound that holds: `(3K − v0)/K = 4 − ψ0/K`, half a period plus the time to the first turning point.
    pub upper: S,
}

/// `t1 M/K` and its bounds (Theorem 3.9). Errors: [`NoConjugatePoint`].
pub fn conjugate_time_bounds<S: Real>(extremal: &Extremal<S>) -> Result<ConjugateTimeBounds<S>, NoConjugatePoint> {
    let time = first_conjugate_time(extremal)?;
    let k = extremal.complete_k;
    let three = S::from_f64(3.0);
    Ok(ConjugateTimeBounds {
        ratio: time.t1 * extremal.speed / k,
        lower: S::from_f64(2.0),
        printed_upper: three,
        upper: three - extremal.direction * extremal.phase() / k,
    })
}

/// The limit of `t1` on the equator, `π √(A/((B − A)(C − A) 2h))` (Theorem 3.9, part 2; Lemma 3.18).
pub fn equator_conjugate_time<S: Real>(metric: &super::metric::Metric<S>, energy: S) -> S {
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    S::PI * (a / ((b - a) * (c - a) * (energy + energy))).sqrt()
}

#[cfg(test)]
#[path = "conjugate_tests.rs"]
mod tests;
