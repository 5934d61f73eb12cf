//! The one instant at which Θ, or λ, reaches a given level.
//!
//! Both never decrease, so the root is unique and none can be skipped. It is bracketed by quarter periods, where only
//! complete integrals are needed; then each closed-form evaluation gives a Taylor series (`expansion`) whose root is
//! the next iterate, and the answer as soon as the omitted terms are below the rounding of Θ. From the first guess,
//! one or two evaluations are usual.

use super::expansion::{self, Expansion};
use super::extremal::{CALLS_FOR_CONSTANTS, Elliptic, Extremal, Regime};
use super::phase::State;
use crate::numerics::real::Real;
use thiserror::Error;

/// Closed-form evaluations after which the solver gives up (one or two are usual, bisection alone would need 60).
const MOST_EVALUATIONS: u32 = 100;
/// Evaluations after which the bracket must have halved, or it is halved.
const CHECK_EVERY: u32 = 4;
/// An error of the point, in radians, above which there is no answer. (At p_θ = 0 that is k above 8e5.)
const WORTHLESS: f64 = 1e-2;
/// Rounding of a time that is not rounding of the phase: of the rate and of u, in ε.
const ROUNDING_OF_TIME: f64 = 4.0;

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
    /// The time is so long that its rounding moves the point by more than a hundredth of a radian.
    #[error(
        "k = {k}, p_theta = {p_theta}: the time is too long for this precision (its rounding moves the point by {moved:e})"
    )]
    PrecisionLost {
        /// Anisotropy.
        k: f64,
        /// Covector.
        p_theta: f64,
        /// Estimated error of the point, in radians.
        moved: f64,
    },
    /// The iteration did not end. A defect.
    #[error("k = {k}, p_theta = {p_theta}: no convergence to {turns} half turns after {evaluations} evaluations")]
    NoConvergence {
        /// Anisotropy.
        k: f64,
        /// Covector.
        p_theta: f64,
        /// The half turns sought.
        turns: f64,
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
    /// Whole half turns of β's argument at the last evaluation.
    pub half_turns: S,
    /// Whole half turns in χ.
    pub chi_turns: S,
    /// χ less its half turns.
    pub chi_rest: S,
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

/// The instant at which `quantity` reaches `turns·π`, for a whole number `turns ≥ 1`.
///
/// Guarantee: a few ε relative in time, times the problem's condition; `error` is an estimate meant as a bound.
pub fn solve<S: Real>(extremal: &Extremal<S>, quantity: Quantity, turns: S) -> Result<PhaseRoot<S>, SpinError> {
    if !(turns >= S::ONE && turns.is_finite() && turns.floor() == turns) {
        let found = turns.to_f64();
        return Err(SpinError::OutOfDomain { what: "number of half turns", found, accepted: "a whole number from 1" });
    }
    let Bracket { mut low, mut high, guess } = match &extremal.elliptic {
        Some(elliptic) => quarter_bracket(extremal, elliptic, quantity, turns),
        None => elementary_bracket(extremal, quantity, turns),
    };
    let mut calls = if extremal.elliptic.is_some() { CALLS_FOR_CONSTANTS } else { 0 };
    let rate = extremal.rate;
    let half = S::from_f64(0.5);
    let mut t = guess;
    let mut width = high - low;
    for evaluation in 1..=MOST_EVALUATIONS {
        let state = extremal.state_near(t);
        calls += state.elliptic_calls;
        let series = Expansion::new(extremal, &state, quantity, turns);
        if series.target[0] < S::ZERO {
            low = low.max(state.t);
        } else {
            high = high.min(state.t);
        }
        let y = series.root(S::ZERO, (low - state.t) * rate, (high - state.t) * rate);
        if series.omitted(y) <= S::EPSILON * S::from_f64(0.25) {
            let rounding = match quantity {
                Quantity::Phase => state.phase_rounding(turns),
                Quantity::Lambda => state.lambda_rounding(turns),
            };
            return finish(extremal, &state, &series, y, rounding, Count { evaluation, calls });
        }
        let found = state.t + y / rate;
        let residual = -expansion::value(&series.target, y);
        t = found;
        if residual.abs() > S::EPSILON.sqrt() {
            // The series does not reach that far: go on by Newton's step from its end, at most half of what is left.
            let step = residual / (expansion::slope(&series.target, y) * rate);
            let (nearest, farthest) = (found + half * (low - found), found + half * (high - found));
            t = found + step;
            if !(t >= nearest && t <= farthest) {
                t = if residual > S::ZERO { farthest } else { nearest };
            }
        }
        if evaluation % CHECK_EVERY == 0 {
            // Bisection if the bracket is not shrinking as fast as bisection would shrink it.
            if high - low > half * width {
                t = half * (low + high);
            }
            width = high - low;
        }
    }
    Err(SpinError::NoConvergence {
        k: extremal.k.to_f64(),
        p_theta: extremal.p.to_f64(),
        turns: turns.to_f64(),
        evaluations: MOST_EVALUATIONS,
    })
}

struct Count {
    evaluation: u32,
    calls: u32,
}

fn finish<S: Real>(
    extremal: &Extremal<S>,
    state: &State<S>,
    series: &Expansion<S>,
    y: S,
    rounding: S,
    count: Count,
) -> Result<PhaseRoot<S>, SpinError> {
    let rate = extremal.rate;
    let t = state.t + y / rate;
    let slope = expansion::slope(&series.target, y);
    let mut shift = rounding / slope;
    // Where the slope changes within that distance (next to a triple root) the series itself gives the distance.
    let straight = shift * series.target[2].abs() < S::from_f64(0.1) * slope;
    if !straight {
        let far = series.radius;
        let above = series.root(rounding, -far, far);
        let below = series.root(-rounding, -far, far);
        shift = (above - y).abs().max((y - below).abs());
    }
    let error = shift / (rate * t) + S::from_f64(ROUNDING_OF_TIME) * S::EPSILON;
    // The point moves with speed |ω × r| ≤ max(1, 1/k).
    let moved = (error * t * S::ONE.max(S::ONE / extremal.k)).to_f64();
    let useful = moved < WORTHLESS;
    if !useful {
        return Err(SpinError::PrecisionLost { k: extremal.k.to_f64(), p_theta: extremal.p.to_f64(), moved });
    }
    Ok(PhaseRoot {
        t,
        half_turns: state.half_turns,
        chi_turns: state.chi_turns,
        chi_rest: expansion::value(&series.chi, y),
        sin_beta: expansion::value(&series.sin_beta, y),
        cos_beta: expansion::value(&series.cos_beta, y),
        beta_rate: expansion::value(&series.beta_rate, y) * rate,
        error,
        evaluations: count.evaluation,
        elliptic_calls: count.calls,
    })
}

/// Brackets from `λ − π < Θ ≤ λ` and elementary bounds of λ; guesses from the limits.
fn elementary_bracket<S: Real>(extremal: &Extremal<S>, quantity: Quantity, turns: S) -> Bracket<S> {
    let half = S::from_f64(0.5);
    let level = turns * S::PI;
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
fn quarter_bracket<S: Real>(
    extremal: &Extremal<S>,
    elliptic: &Elliptic<S>,
    quantity: Quantity,
    turns: S,
) -> Bracket<S> {
    let (one, two) = (S::ONE, S::from_f64(2.0));
    let level = turns * S::PI;
    let at = |n: S| -> (S, S) {
        let point = extremal.quarter_phase(elliptic, n, turns);
        match quantity {
            Quantity::Phase => (point.phase, point.phase_rate),
            Quantity::Lambda => (point.lambda, point.lambda_rate),
        }
    };
    let quarter_lambda = (S::PI + elliptic.excess) / two;
    let (mut first, mut last) = match (quantity, extremal.regime) {
        (Quantity::Phase, Regime::Oscillating) => {
            // Θ gains the excess in a half turn, and leads that by less than π/2 after whole half turns.
            let first = ((level - S::PI / two) / elliptic.excess).floor();
            (two * first, two * ((level / elliptic.excess).floor() + one))
        }
        (Quantity::Phase, _) => ((level / quarter_lambda).floor(), ((level + S::PI) / quarter_lambda).floor() + one),
        (Quantity::Lambda, _) => ((level / quarter_lambda).floor(), (level / quarter_lambda).floor() + one),
    };
    let mut below = at(first);
    while below.0 > S::ZERO && first > S::ZERO {
        first += -one;
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
    if rise <= S::ZERO {
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
