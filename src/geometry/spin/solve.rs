//! The one instant at which Θ, or λ, reaches a given level.
//!
//! Both never decrease, so the root is unique and none can be skipped. It is bracketed by quarter periods, where only
//! complete integrals are needed; then each closed-form evaluation gives a Taylor series (`expansion`) whose root is
//! the next iterate, and the answer as soon as the omitted terms are below the rounding of Θ. From the first guess,
//! one or two evaluations are usual.

use super::expansion::{self, Expansion};
use super::extremal::{Extremal, Regime};
use super::phase::State;
use crate::numerics::real::Real;
use thiserror::Error;

/// Closed-form evaluations after which the solver gives up (one or two are usual, bisection alone would need 60).
const MOST_EVALUATIONS: u32 = 100;
/// A relative error of a time above this means that the phase has no digits left.
const WORTHLESS: f64 = 1e-2;

/// What is to reach its level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Θ: the j-th conjugate time is where Θ = jπ.
    Phase,
    /// λ: the n-th return to the equator is where λ = nπ.
    Lambda,
}

/// Why no instant could be given.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SpinError {
    /// The phase is a difference of two numbers of size `k²`: its digits are gone.
    #[error("k = {k}, p_theta = {p_theta}: the phase has no digits left in this precision (estimated relative error {error:e})")]
    PrecisionLost {
        /// Anisotropy.
        k: f64,
        /// Covector.
        p_theta: f64,
        /// Estimated relative error of the time.
        error: f64,
    },
    /// The iteration did not end. A defect.
    #[error("k = {k}, p_theta = {p_theta}: no convergence to level {level} after {evaluations} evaluations")]
    NoConvergence {
        /// Anisotropy.
        k: f64,
        /// Covector.
        p_theta: f64,
        /// The level sought.
        level: f64,
        /// Evaluations spent.
        evaluations: u32,
    },
    /// A time, level or index outside the domain.
    #[error("{what} = {found} must be {accepted}")]
    OutOfDomain {
        /// Which argument.
        what: &'static str,
        /// Its value.
        found: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// A scan in `k` met a start that is refused.
    #[error(transparent)]
    Start(#[from] super::start::StartError),
}

/// The state at a root.
#[derive(Debug, Clone, Copy)]
pub struct PhaseRoot<S> {
    /// The time.
    pub t: S,
    /// λ there.
    pub lambda: S,
    /// χ there.
    pub chi: S,
    /// sin β there.
    pub sin_beta: S,
    /// cos β there.
    pub cos_beta: S,
    /// β' there.
    pub beta_rate: S,
    /// Estimated relative error of the time.
    pub error: S,
    /// Closed-form evaluations.
    pub evaluations: u32,
    /// Carlson functions called, those for the constants of the extremal included.
    pub elliptic_calls: u32,
}

struct Bracket<S> {
    low: S,
    high: S,
    guess: S,
}

/// The instant at which `quantity` reaches `level > 0`.
///
/// Guarantee: a few ε of λ + χ in the phase, that is a few ε relative in time times the problem's condition for
/// moderate `k`; about `2k²ε` when oscillating with large `k`. `error` says so.
pub fn solve<S: Real>(extremal: &Extremal<S>, quantity: Quantity, level: S) -> Result<PhaseRoot<S>, SpinError> {
    if !(level > S::ZERO && level.is_finite()) {
        let found = level.to_f64();
        return Err(SpinError::OutOfDomain { what: "level", found, accepted: "positive and finite" });
    }
    let Bracket { mut low, mut high, guess } = match extremal.elliptic {
        Some(_) => quarter_bracket(extremal, quantity, level),
        None => elementary_bracket(extremal, quantity, level),
    };
    let mut calls = if extremal.elliptic.is_some() { 2 } else { 0 };
    let mut t = guess;
    for evaluation in 1..=MOST_EVALUATIONS {
        let state = extremal.state_near(t);
        calls += state.elliptic_calls;
        let series = Expansion::new(extremal, &state, quantity == Quantity::Lambda);
        if series.target[0] < level {
            low = low.max(state.t);
        } else {
            high = high.min(state.t);
        }
        let rate = extremal.rate;
        let y = series.root(level, (low - state.t) * rate, (high - state.t) * rate);
        let found = state.t + y / rate;
        if series.omitted(y) <= S::EPSILON * S::from_f64(0.25) {
            return finish(extremal, &state, &series, level, y, evaluation, calls);
        }
        t = found;
        let residual = level - expansion::value(&series.target, y);
        if residual.abs() > S::EPSILON.sqrt() {
            // The series did not reach: go on by Newton's step from its end, at most half of what is left.
            let step = residual / (expansion::slope(&series.target, y) * rate);
            let half = S::from_f64(0.5);
            let (nearest, farthest) = (low + half * (found - low), found + half * (high - found));
            t = found + step;
            if !(t >= nearest && t <= farthest) {
                t = if residual > S::ZERO { farthest } else { nearest };
            }
        }
    }
    Err(SpinError::NoConvergence {
        k: extremal.k.to_f64(),
        p_theta: extremal.p.to_f64(),
        level: level.to_f64(),
        evaluations: MOST_EVALUATIONS,
    })
}

fn finish<S: Real>(
    extremal: &Extremal<S>,
    state: &State<S>,
    series: &Expansion<S>,
    level: S,
    y: S,
    evaluations: u32,
    elliptic_calls: u32,
) -> Result<PhaseRoot<S>, SpinError> {
    let two = S::from_f64(2.0);
    let rate = extremal.rate;
    let t = state.t + y / rate;
    let chi = expansion::value(&series.chi, y);
    let lambda = expansion::value(&series.phase, y) + chi;
    // Rounding of the phase: measured at most … of this (see the tests of `conjugate`).
    let rounding = S::EPSILON * (two + lambda + chi);
    let slope = expansion::slope(&series.target, y);
    let mut shift = rounding / slope;
    // Where the slope changes within that distance (next to a triple root) the series itself gives the distance.
    if !(shift * series.target[2].abs() < S::from_f64(0.1) * slope) {
        let far = series.radius;
        let above = series.root(level + rounding, -far, far);
        let below = series.root(level - rounding, -far, far);
        shift = (above - y).max(y - below);
    }
    let error = shift / (rate * t) + S::from_f64(4.0) * S::EPSILON;
    if !(error.to_f64() < WORTHLESS) {
        let (k, p_theta) = (extremal.k.to_f64(), extremal.p.to_f64());
        return Err(SpinError::PrecisionLost { k, p_theta, error: error.to_f64() });
    }
    Ok(PhaseRoot {
        t,
        lambda,
        chi,
        sin_beta: expansion::value(&series.sin_beta, y),
        cos_beta: expansion::value(&series.cos_beta, y),
        beta_rate: expansion::value(&series.beta_rate, y) * rate,
        error,
        evaluations,
        elliptic_calls,
    })
}

/// Brackets from `λ − π < Θ ≤ λ` and elementary bounds of λ; guesses from the limits.
fn elementary_bracket<S: Real>(extremal: &Extremal<S>, quantity: Quantity, level: S) -> Bracket<S> {
    let half = S::from_f64(0.5);
    let lag = if quantity == Quantity::Phase { S::PI } else { S::ZERO };
    let guess = central_guess(extremal, quantity, level);
    match extremal.regime {
        Regime::Separatrix => {
            Bracket { low: extremal.k * (level - half * S::PI).max(S::ZERO), high: extremal.k * (level + lag), guess }
        }
        Regime::Round => Bracket { low: level / extremal.rate, high: (level + lag) / extremal.rate, guess },
        _ => Bracket { low: level, high: level + lag, guess },
    }
}

/// A guess that is right in the limits: `p → 0` for `k < 1`, `p → q` for `k > 1`, `p → ∞`, and at `k = 1`.
fn central_guess<S: Real>(extremal: &Extremal<S>, quantity: Quantity, level: S) -> S {
    let (one, two) = (S::ONE, S::from_f64(2.0));
    let (k, p) = (extremal.k, extremal.p);
    let tangent = k * extremal.anisotropy; // √|k² − 1|
    let conjugate = quantity == Quantity::Phase;
    let center = if k < one {
        if conjugate {
            let argument = S::from_f64(1.3) * level * extremal.anisotropy;
            let ratio = argument.tanh() / extremal.anisotropy;
            level + ratio.atan()
        } else {
            level
        }
    } else {
        let lead = if conjugate && tangent > S::ZERO { (one / tangent).atan() } else { S::ZERO };
        k * (level + lead - tangent.atan())
    };
    let far = if conjugate {
        // The roots of tan x = x.
        let asymptote = level + S::PI / two;
        asymptote - one / asymptote
    } else {
        level
    };
    let center = if extremal.regime == Regime::Round { far } else { center };
    let momentum = if k > one { p * p - S::from_f64(4.0) * (k - one) * (k + one) } else { p * p };
    let from_center = one / (center * center);
    let from_far = momentum / (S::from_f64(4.0) * k * k * far * far);
    one / (from_center + from_far).max(from_center * S::from_f64(0.2)).sqrt()
}

/// The quarter period in which the level is reached, and a guess inside.
fn quarter_bracket<S: Real>(extremal: &Extremal<S>, quantity: Quantity, level: S) -> Bracket<S> {
    let Some(elliptic) = &extremal.elliptic else {
        return elementary_bracket(extremal, quantity, level);
    };
    let (one, two) = (S::ONE, S::from_f64(2.0));
    let lambda = elliptic.quarter_lambda;
    let at = |n: S| -> (S, S) {
        match (quantity, extremal.quarter_phase(n)) {
            (Quantity::Phase, Some(point)) => (point.phase - level, point.phase_rate),
            (_, point) => (n * lambda - level, point.map_or(S::ZERO, |point| point.lambda_rate)),
        }
    };
    let (mut first, mut last) = match (quantity, extremal.regime) {
        (Quantity::Lambda, _) => ((level / lambda).floor(), (level / lambda).floor() + one),
        (_, Regime::Oscillating) => {
            // Θ gains 2λ(K) − π a half turn, and leads j times that by less than π/2 after j half turns.
            let gain = two * lambda - S::PI;
            let half = S::PI / two;
            let first = ((level - half) / gain).floor();
            (two * first.max(S::ZERO), two * ((level / gain).floor() + one))
        }
        _ => ((level / lambda).floor(), ((level + S::PI) / lambda).floor() + one),
    };
    let mut below = at(first);
    while below.0 > S::ZERO && first > S::ZERO {
        first = first - one;
        below = at(first);
    }
    let mut above = at(last);
    for _ in 0..8 {
        if above.0 > S::ZERO {
            break;
        }
        last += one;
        above = at(last);
    }
    while last - first > one {
        let middle = ((first + last) / two).floor();
        let value = at(middle);
        if value.0 > S::ZERO {
            (last, above) = (middle, value);
        } else {
            (first, below) = (middle, value);
        }
    }
    let quarter = elliptic.quarter / extremal.rate;
    let (low, high) = (first * quarter, last * quarter);
    let central = central_guess(extremal, quantity, level);
    let guess = if central > low && central < high {
        central
    } else {
        low + quarter * hermite_root(below.0, above.0, below.1 * quarter, above.1 * quarter)
    };
    Bracket { low, high, guess }
}

/// Where in [0, 1] the cubic with these end values (of opposite sign) and end slopes vanishes, roughly.
fn hermite_root<S: Real>(f0: S, f1: S, d0: S, d1: S) -> S {
    let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
    let rise = f1 - f0;
    if !(rise > S::ZERO) {
        return S::from_f64(0.5);
    }
    // Slopes above three times the mean would make the cubic leave the range of its end values.
    let (d0, d1) = (d0.min(three * rise), d1.min(three * rise));
    let (quadratic, cubic) = (three * rise - two * d0 - d1, d0 + d1 - two * rise);
    let (mut low, mut high) = (S::ZERO, S::ONE);
    let mut x = -f0 / rise;
    for _ in 0..6 {
        let value = f0 + x * (d0 + x * (quadratic + x * cubic));
        if value > S::ZERO {
            high = x;
        } else {
            low = x;
        }
        let next = x - value / (d0 + x * (two * quadratic + x * three * cubic));
        x = if next > low && next < high { next } else { (low + high) / two };
    }
    x
}
