//! The one instant at which Θ, or λ, reaches a given level.
//!
//! Both never decrease, so the root is unique and none can be skipped. It is bracketed by quarter periods, where only
//! complete integrals are needed; then each closed-form evaluation gives a Taylor series (`expansion`) whose root is
//! the next iterate, and the answer as soon as the omitted terms are below the rounding of Θ. From the first guess,
//! one or two evaluations are usual.
//!
//! The *short way* ([`short_way`], written over packs) is the same without the bracket: evaluations and series from a
//! guess, a few Newton steps each. What it ends at is a root of a monotone function, so it is the root wherever the guess
//! was. Where it does not settle (a triple root near by, a far guess, a time too long), the bracketed way decides.

use super::expansion::{self, Expansion};
use super::extremal::{CALLS_FOR_CONSTANTS, Elliptic, Extremal, Regime};
use super::phase::{CALLS_FOR_STATE, State};
use crate::numerics::pack::{Mask, Pack};
use crate::numerics::real::Real;
use thiserror::Error;

/// Closed-form evaluations after which the solver gives up (one or two are usual; halving every fourth time, as where t1 lies in a transition of width 1/k, 250 give 62 bits).
const MOST_EVALUATIONS: u32 = 250;
/// Evaluations after which the bracket must have halved, or it is halved.
const CHECK_EVERY: u32 = 4;
/// An error of the point, in radians, or of the time, relative, above which there is no answer. (At p_θ = 0 that is k above 8e5 in
/// `f64`, above 5e13 in double-double.)
const WORTHLESS: f64 = 1e-2;
/// Closed-form evaluations of the short way.
const MOST_SHORT_EVALUATIONS: u32 = 4;
/// Below this `k` the guess without a bracket is too far off to be worth an evaluation.
const SMALL_K: f64 = 0.4;
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
    /// The time is so long that its rounding moves the point by more than a hundredth of a radian, or it is not known to a hundredth.
    #[error(
        "k = {k}, p_theta = {p_theta}: the time is too long for an arithmetic of relative accuracy {epsilon:.0e} (rounding \
         moves the point by {moved:.1e}), and far too long to be integrated"
    )]
    PrecisionLost {
        /// Anisotropy.
        k: f64,
        /// Covector.
        p_theta: f64,
        /// Estimated error of the point, in radians, or of the time, relative.
        moved: f64,
        /// The rounding unit of the arithmetic.
        epsilon: f64,
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
    /// sin χ there, of the whole χ.
    pub sin_chi: S,
    /// cos χ there.
    pub cos_chi: S,
    /// sin β there.
    pub sin_beta: S,
    /// cos β there.
    pub cos_beta: S,
    /// β' there.
    pub beta_rate: S,
    /// Estimated relative error of the time.
    pub error: S,
    /// Closed-form evaluations, a whole number.
    pub evaluations: S,
    /// Carlson functions called, those for the constants of the extremal included; a whole number.
    pub elliptic_calls: S,
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
    let (mut calls, mut short_evaluations) = (0, 0);
    if extremal.regime.is_elliptic() {
        let (root, settled) = short_way(extremal, quantity, turns);
        if settled {
            return Ok(root);
        }
        calls = CALLS_FOR_CONSTANTS + CALLS_FOR_STATE * MOST_SHORT_EVALUATIONS;
        short_evaluations = MOST_SHORT_EVALUATIONS;
    }
    let Bracket { mut low, mut high, guess } = match &extremal.elliptic {
        Some(elliptic) => {
            let central = central_guess(extremal, quantity, turns * S::PI);
            quarter_bracket(extremal, elliptic, quantity, turns, central)
        }
        None => elementary_bracket(extremal, quantity, turns),
    };
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
        let rounding = match quantity {
            Quantity::Phase => state.phase_rounding(turns),
            Quantity::Lambda => state.lambda_rounding(turns),
        };
        if series.omitted(y) <= negligible(rounding) {
            let evaluation = short_evaluations + evaluation;
            return accept(extremal, &state, &series, y, rounding, Count { evaluation, calls });
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
    // Where Θ itself is rounding there is nothing to converge to.
    let moved = (S::from_f64(ROUNDING_OF_TIME) * S::EPSILON * t).to_f64();
    if moved > WORTHLESS {
        return Err(precision_lost(extremal, moved));
    }
    Err(SpinError::NoConvergence {
        k: extremal.k.to_f64(),
        p_theta: extremal.p.to_f64(),
        turns: turns.to_f64(),
        evaluations: MOST_EVALUATIONS,
    })
}

/// The root by evaluations and series from a first guess, without a bracket; and for which members it has settled: the series
/// omits nothing, Newton's iteration on it has come to rest, and the slope is the same within the rounding error.
///
/// Domain: the elliptic regimes. The root of a member that has not settled means nothing.
#[inline(always)]
pub fn short_way<S: Pack>(extremal: &Extremal<S>, quantity: Quantity, turns: S) -> (PhaseRoot<S>, S::Mask) {
    let mut found: Option<PhaseRoot<S>> = None;
    let mut settled = S::Mask::splat(false);
    let Some(elliptic) = &extremal.elliptic else {
        return (PhaseRoot::nothing(), settled);
    };
    let mut t = first_guess(extremal, elliptic, quantity, turns);
    for evaluation in 1..=MOST_SHORT_EVALUATIONS {
        let state = extremal.elliptic_state(elliptic, t);
        let series = Expansion::new(extremal, &state, quantity, turns);
        let (y, at_rest) = series.near_root();
        let rounding = match quantity {
            Quantity::Phase => state.phase_rounding(turns),
            Quantity::Lambda => state.lambda_rounding(turns),
        };
        let complete = series.omitted(y).at_most(negligible(rounding));
        let (shift, straight) = straight_shift(&series, y, rounding);
        let count = Count { evaluation, calls: CALLS_FOR_CONSTANTS + CALLS_FOR_STATE * evaluation };
        let (root, moved) = finish(extremal, &state, &series, y, shift, count);
        let useful = moved.less(S::from_f64(WORTHLESS)).and(root.t.more(S::ZERO));
        let settles = complete.and(at_rest).and(straight).and(useful).and(settled.not());
        settled = settled.or(settles);
        found = Some(match found {
            None => root,
            Some(earlier) => PhaseRoot::select(settles, root, earlier),
        });
        if settled.all() {
            break;
        }
        t = S::select(settled, t, root.t);
    }
    (found.unwrap_or_else(PhaseRoot::nothing), settled)
}

impl<S: Pack> PhaseRoot<S> {
    /// What stands where there is no root.
    #[inline(always)]
    fn nothing() -> Self {
        let zero = S::ZERO;
        Self {
            t: zero,
            half_turns: zero,
            chi_turns: zero,
            chi_rest: zero,
            sin_chi: zero,
            cos_chi: zero,
            sin_beta: zero,
            cos_beta: zero,
            beta_rate: zero,
            error: zero,
            evaluations: zero,
            elliptic_calls: zero,
        }
    }

    /// `yes` where the mask is true, else `no`.
    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        Self {
            t: S::select(mask, yes.t, no.t),
            half_turns: S::select(mask, yes.half_turns, no.half_turns),
            chi_turns: S::select(mask, yes.chi_turns, no.chi_turns),
            chi_rest: S::select(mask, yes.chi_rest, no.chi_rest),
            sin_chi: S::select(mask, yes.sin_chi, no.sin_chi),
            cos_chi: S::select(mask, yes.cos_chi, no.cos_chi),
            sin_beta: S::select(mask, yes.sin_beta, no.sin_beta),
            cos_beta: S::select(mask, yes.cos_beta, no.cos_beta),
            beta_rate: S::select(mask, yes.beta_rate, no.beta_rate),
            error: S::select(mask, yes.error, no.error),
            evaluations: S::select(mask, yes.evaluations, no.evaluations),
            elliptic_calls: S::select(mask, yes.elliptic_calls, no.elliptic_calls),
        }
    }
}

/// What a series may omit: a quarter of ε, and of the rounding error where the phase is known far better than to ε (small k,
/// where it hardly changes with time).
#[inline(always)]
fn negligible<S: Pack>(rounding: S) -> S {
    S::from_f64(0.25) * rounding.min(S::EPSILON)
}

#[derive(Clone, Copy)]
struct Count {
    evaluation: u32,
    calls: u32,
}

/// How far a rounding error of the phase shifts the root, and whether the slope is the same within that distance.
#[inline(always)]
fn straight_shift<S: Pack>(series: &Expansion<S>, y: S, rounding: S) -> (S, S::Mask) {
    let slope = expansion::slope(&series.target, y);
    let shift = rounding / slope;
    (shift, (shift * series.target[2].abs()).less(S::from_f64(0.1) * slope))
}

fn accept<S: Real>(
    extremal: &Extremal<S>,
    state: &State<S>,
    series: &Expansion<S>,
    y: S,
    rounding: S,
    count: Count,
) -> Result<PhaseRoot<S>, SpinError> {
    let (mut shift, straight) = straight_shift(series, y, rounding);
    // Where the slope changes within that distance (next to a triple root) the series itself gives the distance.
    if !straight {
        let far = series.radius;
        let above = series.root(rounding, -far, far);
        let below = series.root(-rounding, -far, far);
        shift = (above - y).abs().max((y - below).abs());
    }
    let (root, moved) = finish(extremal, state, series, y, shift, count);
    let moved = moved.to_f64();
    let useful = moved < WORTHLESS;
    if !useful {
        return Err(precision_lost(extremal, moved));
    }
    Ok(root)
}

fn precision_lost<S: Real>(extremal: &Extremal<S>, moved: f64) -> SpinError {
    SpinError::PrecisionLost {
        k: extremal.k.to_f64(),
        p_theta: extremal.p.to_f64(),
        moved,
        epsilon: S::EPSILON.to_f64(),
    }
}

/// The root `y` of the series as a [`PhaseRoot`], and by how much its error moves the point.
#[inline(always)]
fn finish<S: Pack>(
    extremal: &Extremal<S>,
    state: &State<S>,
    series: &Expansion<S>,
    y: S,
    shift: S,
    count: Count,
) -> (PhaseRoot<S>, S) {
    let rate = extremal.rate;
    let t = state.t + y / rate;
    let error = shift / (rate * t) + S::from_f64(ROUNDING_OF_TIME) * S::EPSILON;
    let sin_beta = expansion::value(&series.sin_beta, y);
    // The point moves with speed |ω × r| ≤ max(1, |sin β|/k).
    let moved = error * (t * S::ONE.max(sin_beta.abs() / extremal.k)).max(S::ONE);
    let root = PhaseRoot {
        t,
        half_turns: state.half_turns,
        chi_turns: state.chi_turns,
        chi_rest: expansion::value(&series.chi, y),
        sin_chi: expansion::value(&series.sin_chi, y),
        cos_chi: expansion::value(&series.cos_chi, y),
        sin_beta,
        cos_beta: expansion::value(&series.cos_beta, y),
        beta_rate: expansion::value(&series.beta_rate, y) * rate,
        error,
        evaluations: S::from_f64(f64::from(count.evaluation)),
        elliptic_calls: S::from_f64(f64::from(count.calls)),
    };
    (root, moved)
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

/// Where the short way begins: while rotating and `k` is not small the guess alone, else a guess inside the bracket.
#[inline(always)]
fn first_guess<S: Pack>(extremal: &Extremal<S>, elliptic: &Elliptic<S>, quantity: Quantity, turns: S) -> S {
    let central = central_guess(extremal, quantity, turns * S::PI);
    let enough = match extremal.regime {
        Regime::Oscillating => S::Mask::splat(false),
        Regime::RotatingBelow => extremal.k.less(S::from_f64(SMALL_K)).not(),
        _ => return central,
    };
    if enough.all() {
        return central;
    }
    S::select(enough, central, quarter_bracket(extremal, elliptic, quantity, turns, central).guess)
}

/// A guess that is right in the limits: `p → 0` for `k < 1`, `p → q` for `k > 1`, `p → ∞`, and at `k = 1`.
#[inline(always)]
fn central_guess<S: Pack>(extremal: &Extremal<S>, quantity: Quantity, level: S) -> S {
    let (one, two) = (S::ONE, S::from_f64(2.0));
    let (k, p) = (extremal.k, extremal.p);
    let tangent = k * extremal.anisotropy; // √|k² − 1|
    let conjugate = quantity == Quantity::Phase;
    let below = matches!(extremal.regime, Regime::RotatingBelow | Regime::Meridian);
    let far = if conjugate {
        // The roots of tan x = x.
        let asymptote = level + S::PI / two;
        asymptote - one / asymptote
    } else {
        level
    };
    let center = match (extremal.regime, conjugate) {
        (Regime::Round, _) => far,
        (_, true) if below => {
            let argument = S::from_f64(1.3) * level * extremal.anisotropy;
            let ratio = argument.tanh() / extremal.anisotropy;
            level + ratio.atan()
        }
        (_, false) if below => level,
        (_, true) => k * (level + (one / tangent).atan() - tangent.atan()),
        (_, false) => k * (level - tangent.atan()),
    };
    let momentum = if below { p * p } else { p * p - S::from_f64(4.0) * (k - one) * (k + one) };
    let from_center = one / (center * center);
    let from_far = momentum / (S::from_f64(4.0) * k * k * far * far);
    one / (from_center + from_far).max(from_center * S::from_f64(0.2)).sqrt()
}

/// The quarter period in which the level is reached, and a guess inside.
#[inline(always)]
fn quarter_bracket<S: Pack>(
    extremal: &Extremal<S>,
    elliptic: &Elliptic<S>,
    quantity: Quantity,
    turns: S,
    central: S,
) -> Bracket<S> {
    let (one, two) = (S::ONE, S::from_f64(2.0));
    let level = turns * S::PI;
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
    let (mut below, mut above) = ((S::ZERO, S::ZERO), (S::ZERO, S::ZERO));
    let mut active = S::Mask::splat(true);
    loop {
        below = chosen(active, at_quarter(extremal, elliptic, quantity, first, turns), below);
        active = active.and(below.0.more(S::ZERO)).and(first.more(S::ZERO)).and((first - one).less(first));
        if !active.any() {
            break;
        }
        first = S::select(active, first - one, first);
    }
    active = S::Mask::splat(true);
    for _ in 0..8 {
        above = chosen(active, at_quarter(extremal, elliptic, quantity, last, turns), above);
        active = active.and(above.0.more(S::ZERO).not());
        if !active.any() {
            break;
        }
        last = S::select(active, last + one, last);
    }
    loop {
        let middle = ((first + last) / two).floor();
        // Whole numbers above 2^53 may have none between them.
        let active = (last - first).more(one).and(middle.more(first)).and(middle.less(last));
        if !active.any() {
            break;
        }
        let value = at_quarter(extremal, elliptic, quantity, middle, turns);
        let up = active.and(value.0.more(S::ZERO));
        let down = active.and(value.0.more(S::ZERO).not());
        (last, above) = (S::select(up, middle, last), chosen(up, value, above));
        (first, below) = (S::select(down, middle, first), chosen(down, value, below));
    }
    let quarter = elliptic.quarter / extremal.rate;
    let (low, high) = (first * quarter, last * quarter);
    let inside = central.more(low).and(central.less(high));
    let cubic = low + quarter * hermite_root(below.0, above.0, below.1 * quarter, above.1 * quarter);
    Bracket { low, high, guess: S::select(inside, central, cubic) }
}

/// The quantity less its level, and its rate, after `n` quarter turns.
#[inline(always)]
fn at_quarter<S: Pack>(extremal: &Extremal<S>, elliptic: &Elliptic<S>, quantity: Quantity, n: S, turns: S) -> (S, S) {
    let point = extremal.quarter_phase(elliptic, n, turns);
    match quantity {
        Quantity::Phase => (point.phase, point.phase_rate),
        Quantity::Lambda => (point.lambda, point.lambda_rate),
    }
}

/// Of two pairs, member by member.
#[inline(always)]
fn chosen<S: Pack>(mask: S::Mask, yes: (S, S), no: (S, S)) -> (S, S) {
    (S::select(mask, yes.0, no.0), S::select(mask, yes.1, no.1))
}

/// Where in [0, 1] the cubic with these end values (of opposite sign) and end slopes vanishes, roughly.
#[inline(always)]
fn hermite_root<S: Pack>(f0: S, f1: S, d0: S, d1: S) -> S {
    let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
    let rise = f1 - f0;
    // Slopes above three times the mean would make the cubic leave the range of its end values.
    let (d0, d1) = (d0.min(three * rise), d1.min(three * rise));
    let (quadratic, cubic) = (three * rise - two * d0 - d1, d0 + d1 - two * rise);
    let (mut low, mut high) = (S::ZERO, S::ONE);
    let mut x = -f0 / rise;
    for _ in 0..6 {
        let value = f0 + x * (d0 + x * (quadratic + x * cubic));
        let positive = value.more(S::ZERO);
        high = S::select(positive, x, high);
        low = S::select(positive, low, x);
        let next = x - value / (d0 + x * (two * quadratic + x * three * cubic));
        x = S::select(next.more(low).and(next.less(high)), next, (low + high) / two);
    }
    S::select(rise.more(S::ZERO), x, S::from_f64(0.5))
}
