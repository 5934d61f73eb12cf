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
//! `d²P/dw² = (1 + Λ/D²) m' S √(1+S²)/D`, both positive for `S > 0`: P is convex in w. From an upper bound Newton's method falls
//! monotonically to the root; Halley's correction is added, with a bracket as a guard. Everything summed is positive.
//!
//! Checked against the pole-free equation of eq. (15) solved with 50 digits and against the printed locus. Not known here:
//! later conjugate times (each needs one more `2N` and `2K`), cut points.

use super::darboux::FromEquator;
use super::extremal::{Extremal, ExtremalClass};
use crate::numerics::elliptic::complete::complete_b;
use crate::numerics::elliptic::incomplete::tangent_squared_and_f_sc;
use crate::numerics::real::Real;

/// Steps of Halley's method after which the solver gives up; twenty thousand starts over the whole domain needed four at most.
const MAX_ITERATIONS: usize = 80;

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
    /// Sine and cosine of the amplitude of `v1`, in the frame where the extremal starts ascending.
    amplitude: (S, S),
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

/// What the equation needs to know of the extremal.
struct Equation<S: Real> {
    m: S,
    mc: S,
    /// `λ = 1 − Λ` and `Λ`.
    lambda: S,
    capital: S,
    complete_k: S,
    /// `B = (E − m'K)/m`.
    complete_b: S,
    /// `N = E − λK`.
    n: S,
}

/// A phase and what is known there.
#[derive(Clone, Copy)]
struct AtPhase<S: Real> {
    /// `sn`, `cn`, `sc` and `dc = √(1 + m' sc²)`.
    sine: S,
    cosine: S,
    tangent: S,
    dc: S,
    /// The phase `v`, `m'∫sc²` and `P(v)`.
    v: S,
    tangent_part: S,
    p: S,
    /// `dP/dw`.
    slope: S,
}

impl<S: Real> Equation<S> {
    fn new(extremal: &Extremal<S>) -> Self {
        let (a, b) = (extremal.metric.a(), extremal.metric.b());
        let e = &extremal.energies;
        let denominator = b * e.to_equator + a * e.to_separatrix;
        let lambda = a * e.to_separatrix / denominator;
        let capital = b * e.to_equator / denominator;
        let (m, mc, k) = (extremal.m, extremal.mc, extremal.complete_k);
        let complete_b = complete_b(mc);
        // N = E − λK = m B + (m' − λ) K, and m' − λ is a product.
        let difference = extremal.metric.c() * e.to_separatrix * e.to_equator / (e.to_minor_axis * denominator);
        let n = m * complete_b + difference * k;
        Self { m, mc, lambda, capital, complete_k: k, complete_b, n }
    }

    fn at(&self, sine: S, cosine: S) -> AtPhase<S> {
        let (integral, v) = tangent_squared_and_f_sc(sine, cosine, self.m, self.mc);
        let tangent = sine / cosine;
        let square = self.mc * tangent * tangent;
        let dc = (S::ONE + square).sqrt();
        let tangent_part = self.mc * integral;
        let p = tangent_part + self.lambda * v;
        AtPhase { sine, cosine, tangent, dc, v, tangent_part, p, slope: (square + self.lambda) / dc }
    }

    fn at_tangent(&self, tangent: S) -> AtPhase<S> {
        let secant = (S::ONE + tangent * tangent).sqrt();
        AtPhase { tangent, ..self.at(tangent / secant, S::ONE / secant) }
    }

    /// An upper bound of the root `S > 0` of `P = p`.
    ///
    /// `P = sc dn − [ε(v) − λv]`, and the bracket is at most `N`: so `sc dn ≤ p + N`, a quadratic for `S²`. And `P ≥ λw` by convexity.
    fn upper_bound(&self, p: S) -> S {
        let (two, four) = (S::from_f64(2.0), S::from_f64(4.0));
        let r2 = (p + self.n).squared();
        let b = r2 - S::ONE;
        let root = (b * b + four * self.mc * r2).sqrt();
        let s2 = if b >= S::ZERO { (b + root) / (two * self.mc) } else { two * r2 / (root - b) };
        let first = s2.sqrt();
        let w = p / self.lambda;
        if w < S::ONE { first.min(w.sinh()) } else { first }
    }

    /// The phase where `P(v) = p`, and the steps it took; `None` if they did not suffice.
    fn solve(&self, p: S) -> Option<(AtPhase<S>, usize)> {
        if p < S::ZERO {
            // P is odd.
            return self.solve(-p).map(|(at, steps)| (at.mirrored(), steps));
        }
        if p == S::ZERO {
            return Some((self.at_tangent(S::ZERO), 0));
        }
        let half = S::from_f64(0.5);
        let mut tangent = self.upper_bound(p);
        let (mut lower, mut upper) = (S::ZERO, S::from_f64(f64::INFINITY));
        // Halley's error is of the order of its step cubed: below rounding.
        let last_step = S::EPSILON_ROOT_8 * S::EPSILON_ROOT_8 * S::EPSILON_ROOT_8;
        for step in 1..=MAX_ITERATIONS {
            let at = self.at_tangent(tangent);
            let excess = at.p - p;
            if excess > S::ZERO {
                upper = tangent;
            } else {
                lower = tangent;
            }
            let secant = S::ONE / at.cosine;
            let bend = (S::ONE + self.capital / (at.dc * at.dc)) * self.mc * tangent * secant / at.dc;
            let newton = -(excess / at.slope);
            let correction = (S::ONE + half * newton * bend / at.slope).max(half);
            let delta = newton / correction;
            let moved = |delta: S| {
                // sinh(w + δ) with sinh w = tangent.
                let sinh_half = (delta * half).sinh();
                tangent + tangent * (sinh_half * sinh_half + sinh_half * sinh_half) + secant * delta.sinh()
            };
            let next = moved(delta);
            if delta.abs() <= last_step {
                return Some((self.moved_slightly(at, next, delta), step));
            }
            tangent = if next > lower && next < upper {
                next
            } else {
                let next = moved(newton);
                if next > lower && next < upper { next } else { lower + half * (tangent.min(upper) - lower) }
            };
        }
        None
    }

    /// The phase after a last step `δ` of `w`: `v` by its Taylor polynomial, `dv/dw = 1/D`.
    fn moved_slightly(&self, at: AtPhase<S>, tangent: S, delta: S) -> AtPhase<S> {
        let secant = (S::ONE + tangent * tangent).sqrt();
        let bend = self.mc * tangent * secant / (at.dc * at.dc * at.dc);
        let v = at.v + delta / at.dc - S::from_f64(0.5) * bend * delta * delta;
        AtPhase { sine: tangent / secant, cosine: S::ONE / secant, tangent, v, ..at }
    }
}

impl<S: Real> AtPhase<S> {
    fn mirrored(self) -> Self {
        Self {
            sine: -self.sine,
            tangent: -self.tangent,
            v: -self.v,
            tangent_part: -self.tangent_part,
            p: -self.p,
            ..self
        }
    }
}

/// The first conjugate time `t1 > 0` of an extremal.
///
/// Domain: oscillating extremals (`0 ≤ ξ1 < 1`, `δ > 0`). Guarantee: a few ε times the condition of the problem; `error` says
/// how many. Special cases: starts at a turning point and the equator have `t1 = 2K/M` exactly. Errors: [`NoConjugatePoint`].
pub fn first_conjugate_time<S: Real>(extremal: &Extremal<S>) -> Result<ConjugateTime<S>, NoConjugatePoint> {
    match extremal.class {
        ExtremalClass::Equator | ExtremalClass::Oscillating => {}
        ExtremalClass::Rotating => return Err(NoConjugatePoint::Rotating { xi1: extremal.xi1().to_f64() }),
        ExtremalClass::Unphysical => return Err(NoConjugatePoint::Unphysical { p_theta: extremal.p_x.to_f64() }),
        ExtremalClass::Separatrix => return Err(NoConjugatePoint::Separatrix),
        ExtremalClass::MiddleAxis => return Err(NoConjugatePoint::MiddleAxis),
    }
    let equation = Equation::new(extremal);
    let k = equation.complete_k;
    let lower_bound = (k + k) / extremal.speed;
    let sine = extremal.direction * extremal.sine;
    if extremal.cosine == S::ZERO {
        // A turning point (or the equator): P is infinite at both ends, the next turning point is conjugate.
        return Ok(ConjugateTime {
            t1: lower_bound,
            lower_bound,
            error: equation.error(extremal, None),
            iterations: 0,
            elliptic_calls: 2,
            amplitude: (sine, S::ZERO),
        });
    }
    let start = equation.at(sine, extremal.cosine);
    let Some((end, iterations)) = equation.solve(start.p + equation.n + equation.n) else {
        return Err(NoConjugatePoint::NotSolved { iterations: MAX_ITERATIONS });
    };
    let phase = k + k + (end.v - start.v);
    Ok(ConjugateTime {
        t1: phase / extremal.speed,
        lower_bound,
        error: equation.error(extremal, Some((&start, &end, phase))),
        iterations,
        // K and B; F and R_D together for the start and for each step.
        elliptic_calls: 3 + iterations,
        amplitude: (end.sine, end.cosine),
    })
}

/// The first conjugate point of an extremal: its time and its place.
///
/// The place is computed from the amplitude that the time's equation was solved for, not from the time: on the second half
/// period `sin a = −G sn v1/√(1 + ν sn²v1)`, `x` with the integral of the third kind over `2K + v1 − v0`. Domain, guarantee and
/// errors as for [`first_conjugate_time`]; angles to a few ε times their own condition.
pub fn first_conjugate_point<S: Real>(extremal: &Extremal<S>) -> Result<ConjugatePoint<S>, NoConjugatePoint> {
    let time = first_conjugate_time(extremal)?;
    let (sine, cosine) = time.amplitude;
    let dn = (extremal.mc + extremal.m * cosine * cosine).sqrt();
    let angle: FromEquator<S> = extremal.angle_at(extremal.angle.half_turns, -(extremal.direction * sine), dn);
    let half_period = extremal.complete_third_kind() + extremal.complete_third_kind();
    let third_kind = if cosine == S::ZERO {
        half_period
    } else {
        let at_start = extremal.third_kind(extremal.direction * extremal.sine, extremal.cosine);
        half_period + (extremal.third_kind(sine, cosine) - at_start)
    };
    let x = extremal.x_after(time.t1, third_kind);
    Ok(ConjugatePoint {
        t1: time.t1,
        x,
        y: angle.y(),
        theta: x,
        phi: extremal.metric.phi_of_angle(angle),
        lower_bound: time.lower_bound,
        error: time.error,
        iterations: time.iterations,
        elliptic_calls: time.elliptic_calls + 3,
    })
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

impl<S: Real> Equation<S> {
    /// First-order bound of the relative error of `t1`: known errors of `D`, `X3` and the starting phase, times the derivatives
    /// of `T`, plus the rounding of the sums themselves.
    fn error(&self, extremal: &Extremal<S>, solution: Option<(&AtPhase<S>, &AtPhase<S>, S)>) -> S {
        let half = S::from_f64(0.5);
        let (m, mc, lambda, capital, k) = (self.m, self.mc, self.lambda, self.capital, self.complete_k);
        let e = &extremal.energies;
        let rounding = S::from_f64(6.0) * S::EPSILON;
        let of_d = e.separatrix_error + S::from_f64(4.0) * S::EPSILON;
        let of_speed = half * e.minor_axis_error + S::EPSILON;
        // d ln m'/d ln D = m, dK/d ln m' = −B/2.
        let k_slope = -(half * m * self.complete_b);
        let Some((start, end, phase)) = solution else {
            return (k_slope / k).abs() * of_d + of_speed + rounding;
        };
        // −∂v/∂ln m' = V/2 at a fixed tangent, with V = ∫m'sc²/dc² at most v and at most m'∫sc².
        let spread = |at: &AtPhase<S>| at.v.abs().min(at.tangent_part.abs());
        let p_slope =
            |at: &AtPhase<S>| m * half * (at.tangent_part.abs() + capital * spread(at)) + capital * lambda * at.v.abs();
        let n_slope = m * half * (mc * (k - self.complete_b) + lambda * self.complete_b) - capital * lambda * k;
        let own = p_slope(end) + p_slope(start) + (n_slope + n_slope).abs();
        let d_slope = (k_slope + k_slope).abs() + half * m * (spread(start) + spread(end)) + own / (end.slope * end.dc);
        // ln S0 moves w by tanh w = sn.
        let start_slope = start.sine.abs() * (start.slope / (end.slope * end.dc) - S::ONE / start.dc).abs();
        let of_start = half * e.in_y_error + S::from_f64(3.0) * S::EPSILON;
        let noise = rounding * (start.p.abs() + self.n + self.n) / (end.slope * end.dc);
        (d_slope * of_d + start_slope * of_start + noise) / phase + of_speed + rounding
    }
}

#[cfg(test)]
#[path = "conjugate_tests.rs"]
mod tests;
