//! The values of `k` at which the first conjugate point passes a pole or the equator (Figs. 4, 5, 8; section 5.2.1).
//!
//! For fixed `p_θ` the conjugate point moves along the half locus as `k` grows. Two functions of `k`, both continuous:
//!
//! - *pole*: `r1 ∝ cos α` with `α = λ + arg(h3 + i h1 h2/G)`, continuous, at `t1`. The article's k1, k2, k3 are
//!   `α = 3π/2, 5π/2, 7π/2`: index n is `α = (n + ½)π`.
//! - *equator*: at the n-th return to the equator, `λ = nπ`, the phase is `Θ = nπ − χ`. The conjugate point lies there
//!   when `Θ = π`, which is a simple root of δβ, although `t1(k)` has a vertical tangent. The article's k̄ is n = 2,
//!   and k̄' (not named there) is n = 3.
//!
//! As `p_θ → 0`, on the meridian, both are elementary: `k = (2n+1)/√(8n)` (3/√8, 5/4, 7/√24 …) and `k = n/√(2n−1)`
//! (2/√3, 3/√5 …), from `w tan t = tan(wt)` with `t = (n+½)π`, `w = (2n−1)/(2n+1)`, and `t = nπ`, `w = (n−1)/n`.
//!
//! The range of `k` is scanned in equal steps for the whole turns that α, or the sign that Θ − π, has; every change is
//! then polished. Not known here: a proof that α and Θ(λ = nπ) are monotone in `k`; two changes of the same index
//! inside one scan step, if there were such, would be missed.

use super::extremal::{Extremal, Regime};
use super::solve::{Quantity, SpinError, solve};
use super::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// Steps in which a range of `k` is scanned. The switches are at least 0.08 apart for `k < 1.5`.
const SCAN_STEPS: u32 = 64;
/// Steps of the polishing iteration; bisection alone would need 53.
const MOST_STEPS: u32 = 100;
/// Relative step of the difference quotient that turns an error of a function into one of `k`.
const SLOPE_STEP: f64 = 1e-6;
/// The same in double-double.
const SLOPE_STEP_LONG: f64 = 1e-10;
/// Steps of the polishing in double-double: from some fifteen digits, ten more each.
const LONG_STEPS: u32 = 2;

/// What the first conjugate point passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// A pole: `r1 = 0`, θ changes between 0 and π in the limit `p_θ → 0`.
    Pole,
    /// The equator: `r2 = 0`.
    Equator,
}

/// A value of `k` at which the first conjugate point passes a pole or the equator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwitchPoint {
    /// What is passed.
    pub passage: Passage,
    /// `n`: `α = (n + ½)π` for a pole (k1, k2, k3 are 1, 2, 3), `λ = nπ` for the equator (k̄ is 2).
    pub index: u32,
    /// The value of `k`.
    pub k: f64,
    /// Estimated absolute error of `k`.
    pub error: f64,
    /// The first conjugate time there.
    pub t1: f64,
    /// The value of `k` in the limit `p_θ → 0`.
    pub meridian_limit: f64,
    /// Solutions of a phase equation that the scan and the polishing took.
    pub solutions: u32,
}

/// `k` of a switch in the limit `p_θ → 0`: `(2n+1)/√(8n)` or `n/√(2n−1)`.
pub fn meridian_switch(passage: Passage, index: u32) -> f64 {
    let n = f64::from(index);
    match passage {
        Passage::Pole => (2.0 * n + 1.0) / (8.0 * n).sqrt(),
        Passage::Equator => n / (2.0 * n - 1.0).sqrt(),
    }
}

/// All switches in `[k_low, k_high]` for one `p_θ`, in ascending order of `k`.
///
/// Domain: `0 < k_low < k_high`. Guarantee: full precision of the function solved; `error` says how much that is.
pub fn switch_points(passage: Passage, p_theta: f64, k_low: f64, k_high: f64) -> Result<Vec<SwitchPoint>, SpinError> {
    if !(k_low > 0.0 && k_high > k_low && k_high.is_finite()) {
        return Err(SpinError::OutOfDomain { what: "k_high", found: k_high, accepted: "finite and above k_low > 0" });
    }
    let mut solutions = 0;
    let mut found = Vec::new();
    let (mut k0, mut n0) = (k_low, whole_turns(passage, k_low, p_theta)?);
    for step in 1..=SCAN_STEPS {
        let k1 = k_low + (k_high - k_low) * f64::from(step) / f64::from(SCAN_STEPS);
        let n1 = whole_turns(passage, k1, p_theta)?;
        solutions += 1;
        let (from, to) = (n0.min(n1), n0.max(n1));
        for index in from + 1..=to {
            found.push(polish(passage, index, p_theta, (k0, k1), solutions)?);
            solutions = 0;
        }
        (k0, n0) = (k1, n1);
    }
    found.sort_by(|a, b| a.k.total_cmp(&b.k));
    Ok(found)
}

/// The number of switches passed by the conjugate point: the largest index whose function is not negative.
fn whole_turns(passage: Passage, k: f64, p_theta: f64) -> Result<u32, SpinError> {
    let start = Start::new(k, p_theta)?;
    let alpha = match passage {
        Passage::Pole => pole_angle(k, p_theta)?.value / f64::PI + 0.5,
        Passage::Equator => return Ok(super::conjugate::first_conjugate_point(&start)?.crossings),
    };
    // α = (n + ½)π is switch n.
    Ok((alpha - 1.0).floor().max(0.0) as u32)
}

/// A function of `k`, how well it is known, and the time it belongs to.
struct Sample<S> {
    value: S,
    rounding: S,
    t: S,
}

/// `α = λ + arg(h3 + i h1h2/G)` at the first conjugate point.
fn pole_angle<S: Real>(k: S, p_theta: S) -> Result<Sample<S>, SpinError> {
    let extremal = Extremal::new(k, p_theta.abs());
    let root = solve(&extremal, Quantity::Phase, S::ONE)?;
    let (zero, one, two, half_turn) = (S::ZERO, S::ONE, S::from_f64(2.0), S::from_f64(0.5));
    // Rotating: β has made so many half turns, and so has the argument, backwards. (At k = 1 they are not counted apart: β = bt.)
    let half_turns = match extremal.regime {
        Regime::Round => (extremal.b * root.t / S::PI + half_turn).floor(),
        _ if root.chi_turns == zero => root.half_turns,
        _ => zero,
    };
    let sign = if half_turns - two * (half_turns / two).floor() > half_turn { -one } else { one };
    let across = -(two * k * k * root.sin_beta) * (root.beta_rate / extremal.casimir);
    let argument = (sign * across).atan2(sign * root.cos_beta);
    let value = (one + root.chi_turns - half_turns) * S::PI + root.chi_rest + argument;
    let lambda_rate = extremal.casimir / (two * extremal.ellipse(root.sin_beta, root.cos_beta));
    let rounding = lambda_rate * root.t * root.error + S::from_f64(4.0) * S::EPSILON * value.abs();
    Ok(Sample { value, rounding, t: root.t })
}

/// `π − Θ` at the n-th return to the equator: positive once the conjugate point has passed it.
fn equator_lag<S: Real>(k: S, p_theta: S, index: u32) -> Result<Sample<S>, SpinError> {
    let extremal = Extremal::new(k, p_theta.abs());
    let index = S::from_f64(f64::from(index));
    let root = solve(&extremal, Quantity::Lambda, index)?;
    let value = (root.chi_turns + S::ONE - index) * S::PI + root.chi_rest;
    Ok(Sample { value, rounding: S::from_f64(8.0) * S::EPSILON * (S::ONE + root.chi_rest.abs()), t: root.t })
}

/// The function of `k` whose root is the switch.
fn switch_function<S: Real>(passage: Passage, index: u32, k: S, p_theta: S) -> Result<Sample<S>, SpinError> {
    match passage {
        Passage::Pole => {
            let sample = pole_angle(k, p_theta)?;
            Ok(Sample { value: sample.value - S::from_f64(f64::from(index) + 0.5) * S::PI, ..sample })
        }
        Passage::Equator => equator_lag(k, p_theta, index),
    }
}

/// The same switches, polished in double-double and rounded: `k` to half a unit in the last place.
///
/// Newton's method from the `f64` answer, with difference quotients good to some ten digits: each step gains as many.
///
/// Domain and errors as for [`switch_points`].
pub fn switch_points_to_reference(
    passage: Passage,
    p_theta: f64,
    k_low: f64,
    k_high: f64,
) -> Result<Vec<SwitchPoint>, SpinError> {
    let found = switch_points(passage, p_theta, k_low, k_high)?;
    found.into_iter().map(|switch| polish_long(&switch, p_theta)).collect()
}

fn polish_long(switch: &SwitchPoint, p_theta: f64) -> Result<SwitchPoint, SpinError> {
    let (mut k, p) = (DoubleDouble::from(switch.k), DoubleDouble::from(p_theta));
    let function = |k: DoubleDouble| switch_function(switch.passage, switch.index, k, p);
    let step = k * DoubleDouble::from(SLOPE_STEP_LONG);
    let slope = (function(k + step)?.value - function(k - step)?.value) / (step + step);
    let mut t1 = DoubleDouble::ZERO;
    for _ in 0..LONG_STEPS {
        let sample = function(k)?;
        (k, t1) = (k - sample.value / slope, sample.t);
    }
    Ok(SwitchPoint {
        k: k.to_f64(),
        error: 0.5 * f64::EPSILON * k.to_f64(),
        t1: t1.to_f64(),
        solutions: switch.solutions + 2 + LONG_STEPS,
        ..*switch
    })
}

fn polish(
    passage: Passage,
    index: u32,
    p_theta: f64,
    bracket: (f64, f64),
    scanned: u32,
) -> Result<SwitchPoint, SpinError> {
    let mut solutions = scanned;
    let mut function = |k: f64| -> Result<Sample<f64>, SpinError> {
        solutions += 1;
        Start::new(k, p_theta)?;
        switch_function(passage, index, k, p_theta)
    };
    let (mut a, mut b) = bracket;
    let (mut fa, mut fb) = (function(a)?.value, function(b)?.value);
    let (mut k, mut sample) = (b, function(b)?);
    if fa == 0.0 || ((fa > 0.0) == (fb > 0.0) && fa.abs() < fb.abs()) {
        (k, sample) = (a, function(a)?);
    }
    // Regula falsi in the form of Anderson and Björck, with a bisection when the bracket is slow to shrink.
    // An end that is a root, or that the scan and this function see on different sides by rounding, is the answer.
    let steps = if fa * fb < 0.0 { MOST_STEPS } else { 0 };
    for step in 0..steps {
        let before = (b - a).abs();
        let secant = b - fb * (b - a) / (fb - fa);
        let inside = secant > a.min(b) && secant < a.max(b);
        k = if inside && step % 8 != 7 { secant } else { 0.5 * (a + b) };
        sample = function(k)?;
        let value = sample.value;
        if value == 0.0 || before <= 2.0 * f64::EPSILON * k || !(k > a.min(b) && k < a.max(b)) {
            break;
        }
        if value.abs() <= 0.25 * sample.rounding && (k - b).abs() <= 4.0 * f64::EPSILON * k {
            break;
        }
        if (value > 0.0) == (fb > 0.0) {
            let weight = 1.0 - value / fb;
            fa *= if weight > 0.0 { weight } else { 0.5 };
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (k, value);
    }
    let slope =
        (function(k * (1.0 + SLOPE_STEP))?.value - function(k * (1.0 - SLOPE_STEP))?.value) / (2.0 * SLOPE_STEP * k);
    Ok(SwitchPoint {
        passage,
        index,
        k,
        error: sample.rounding / slope.abs() + f64::EPSILON * k,
        t1: sample.t,
        meridian_limit: meridian_switch(passage, index),
        solutions,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: roots in k of r1(t1) and of J at the n-th return, by Taylor integration of r, h, δh at 300 bits (mpmath
    /// 1.3, secant until 1e-32); 23 digits kept.
    #[expect(clippy::approx_constant, reason = "a time within 3e-17 of 2π, not 2π")]
    const SWITCHES: [(Passage, u32, f64, f64, f64); 10] = [
        (Passage::Pole, 1, 1e-4, 1.060660173768559100609, 4.7123889803846898135),
        (Passage::Pole, 2, 1e-4, 1.250000002343749997314, 7.8539816339744830797),
        (Passage::Pole, 3, 1e-4, 1.428869019302649961408, 10.995574287564276322),
        (Passage::Equator, 2, 1e-4, 1.154700540544315034758, 6.2831853071795864548),
        (Passage::Equator, 3, 1e-4, 1.341640789015450290272, 9.4247779607693797015),
        (Passage::Pole, 1, 0.3, 1.077953771394159858215, 4.7094947499198506744),
        (Passage::Pole, 2, 0.3, 1.270849583646162557754, 7.8527648307500230105),
        (Passage::Pole, 3, 0.3, 1.452785337494511829669, 10.994636821646419773),
        (Passage::Equator, 2, 0.3, 1.173865356684086375726, 6.2815865378660723245),
        (Passage::Equator, 3, 0.3, 1.364068943634060879113, 9.4237387576476601059),
    ];

    /// The angle is continuous across k = 1, where the pendulum is uniform: a range that begins there has the switches of one that begins
    /// just above, and one around it none at 1. (With p_θ = 2 and more the first switch is beyond 1.5.)
    #[test]
    fn nothing_switches_at_the_round_case() {
        for p in [0.5, 1.5, 1.9, 2.0, 2.5, 3.0, 5.0] {
            let at = |low| switch_points(Passage::Pole, p, low, 1.5).unwrap();
            let expected: Vec<(u32, f64)> = at(1.0 + 1e-7).iter().map(|switch| (switch.index, switch.k)).collect();
            assert_eq!(expected.is_empty(), p >= 2.0, "{p}: {expected:?}");
            for low in [0.5, 0.9, 1.0] {
                let found = at(low);
                assert_eq!(found.len(), expected.len(), "{p} from {low}: {found:?}");
                let is_same = |(switch, (index, k)): (&SwitchPoint, &(u32, f64))| {
                    switch.index == *index && (switch.k - k).abs() <= switch.error
                };
                assert!(found.iter().zip(&expected).all(is_same), "{p} from {low}: {found:?}, {expected:?}");
            }
        }
    }

    /// The reference is rounded: half a unit in the last place of what has 22 digits and more.
    #[test]
    fn switches_to_reference_against_the_same() {
        for (passage, index, p, k, t1) in SWITCHES {
            let found = switch_points_to_reference(passage, p, 1.0, 1.5).unwrap();
            let here = found.iter().find(|switch| switch.index == index).unwrap();
            assert_eq!(here.k, k, "{passage:?} {index} {p}");
            assert!((here.t1 / t1 - 1.0).abs() <= f64::EPSILON, "{passage:?} {index} {p}: {} {t1}", here.t1);
        }
    }

    #[test]
    fn switches_against_integration_at_300_bits() {
        for (passage, index, p, k, t1) in SWITCHES {
            let found = switch_points(passage, p, 1.0, 1.5).unwrap();
            let here = found.iter().find(|switch| switch.index == index).unwrap();
            assert!((here.k - k).abs() <= 4.0 * f64::EPSILON, "{passage:?} {index} {p}: {} {k}", here.k);
            assert!((here.k - k).abs() <= here.error && here.error < 6e-15, "{}", here.error);
            assert!((here.t1 / t1 - 1.0).abs() < 32.0 * f64::EPSILON, "{} {t1}", here.t1);
            assert!(here.solutions < 120, "{}", here.solutions);
        }
    }

    /// At p_θ = 0 the numeric route gives the elementary values; one of them, 5/4, is itself a point of the scan.
    #[test]
    fn on_the_meridian_the_switches_are_elementary() {
        for (passage, indices) in [(Passage::Pole, 1..=6), (Passage::Equator, 2..=7)] {
            let found = switch_points(passage, 0.0, 1.0, 2.0).unwrap();
            let expected: Vec<u32> = indices.filter(|&n| meridian_switch(passage, n) < 2.0).collect();
            let indices: Vec<u32> = found.iter().map(|switch| switch.index).collect();
            assert_eq!(indices, expected);
            for switch in found {
                let limit = meridian_switch(passage, switch.index);
                assert_eq!(switch.meridian_limit, limit);
                assert!((switch.k - limit).abs() <= 6.0 * f64::EPSILON, "{switch:?}");
            }
        }
    }

    /// The article's Fig. 4 (p_θ = 1e-4): approximately 1.061, 1.250, 1.429. It has no other pole passage in [1, 1.5].
    #[test]
    fn the_articles_values() {
        let found = switch_points(Passage::Pole, 1e-4, 1.0, 1.5).unwrap();
        let rounded: Vec<f64> = found.iter().map(|switch| (switch.k * 1000.0).round() / 1000.0).collect();
        assert_eq!(rounded, [1.061, 1.25, 1.429]);
        assert_eq!(switch_points(Passage::Pole, 1e-4, 0.5, 1.05).unwrap(), []);
        assert!(switch_points(Passage::Pole, 1e-4, 1.5, 1.0).is_err());
    }
}
