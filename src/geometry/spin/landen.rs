//! Jacobi's amplitude from an argument: descending Landen transformations.
//!
//! Source: R. Bulirsch, *Numerical calculation of elliptic integrals and elliptic functions*, Numer. Math. 7 (1965)
//! 78-90 (procedure `sncndn`), on the arithmetic-geometric mean of `1` and `√m'`. The complementary parameter
//! `m' = 1 − m` is the input, so nothing is lost near the separatrix.
//!
//! Here it only chooses where to evaluate: an instant is described by its amplitude, and the time belonging to that
//! amplitude is computed from it. So its own rounding errors do not reach a result.

use crate::numerics::pack::{Mask, Pack};

/// Transformations kept. The mean of 1 and 1e-154 (`m'` at the end of the normal numbers) needs 11.
const LEVELS: usize = 16;

/// The chain of arithmetic-geometric means for one complementary parameter, and the complete integrals it gives.
#[derive(Debug, Clone, Copy)]
pub struct Landen<S: Pack> {
    arithmetic: [S; LEVELS],
    geometric: [S; LEVELS],
    /// Whose chain has this level.
    present: [S::Mask; LEVELS],
    levels: usize,
    mean: S,
    /// `B = ∫₀^K cn²`.
    pub cosine_integral: S,
    /// `D = ∫₀^K sn²`, `K = B + D`, `K − E = m D`.
    pub sine_integral: S,
}

/// An amplitude `π·half_turns + φ`, `|φ| ≤ π/2`, by the sine and cosine of φ.
#[derive(Debug, Clone, Copy)]
pub struct Amplitude<S> {
    /// Whole half turns, each of argument `2K`.
    pub half_turns: S,
    /// `(−1)^half_turns`.
    pub sign: S,
    /// `sin φ`.
    pub sine: S,
    /// `cos φ ≥ 0`, with full relative precision.
    pub cosine: S,
}

/// Sine and cosine of an angle in `[0, π/2]` (a little beyond it the cosine is negative), to an ε absolutely.
///
/// Taylor polynomials of degree 17 and 16 on `[0, π/4]`: what they omit is below 3e-18.
#[inline(always)]
fn first_quadrant<S: Pack>(x: S) -> (S, S) {
    let one = S::ONE;
    let upper = x.more(S::from_f64(0.25) * S::PI);
    let x = S::select(upper, S::from_f64(0.5) * S::PI - x, x);
    let square = x * x;
    let (mut sine, mut cosine) = (one, one);
    for step in (0..8).rev() {
        let (n, m) = (f64::from(2 * step + 2), f64::from(2 * step + 1));
        sine = one - square * sine * S::from_f64(1.0 / (n * (n + 1.0)));
        cosine = one - square * cosine * S::from_f64(1.0 / (n * m));
    }
    sine *= x;
    (S::select(upper, cosine, sine), S::select(upper, sine, cosine))
}

/// One step of Bulirsch's `cel2` for the members that are active. (A function, not a closure: those can't be told to be
/// compiled with the caller's instructions.)
#[inline(always)]
fn advanced<S: Pack>(active: S::Mask, modulus: S, inverse: S, (upper, lower, b): (S, S, S)) -> (S, S, S) {
    let sum = lower * modulus + b;
    let new_b = sum + sum;
    (S::select(active, new_b * inverse + upper, upper), S::select(active, upper, lower), S::select(active, new_b, b))
}

impl<S: Pack> Landen<S> {
    /// The chain for `0 < m' ≤ 1`.
    ///
    /// The complete integrals come along by Bulirsch's `cel2` (same source), a sum of positive terms on the same means.
    #[inline(always)]
    pub fn new(complementary_parameter: S) -> Self {
        let half = S::from_f64(0.5);
        // The mean is taken once its two arguments agree to √ε: the next step would agree to ε.
        let agreement = S::EPSILON.sqrt();
        let mut arithmetic = [S::ONE; LEVELS];
        let mut geometric = [S::ONE; LEVELS];
        let mut present = [S::Mask::splat(false); LEVELS];
        let mut a = S::ONE;
        let mut g = complementary_parameter.sqrt();
        let mut levels = 0;
        let mut mean = half * (a + g);
        let mut active = S::Mask::splat(true);
        // ∫ (α cos² + β sin²)/Δ for (α, β) = (1, 0) and (0, 1), in Bulirsch's notation `a` (upper), `c` (lower), `b`.
        let (mut cosine_upper, mut cosine_lower, mut cosine_b) = (S::ONE, S::ONE, S::ZERO);
        let (mut sine_upper, mut sine_lower, mut sine_b) = (S::ONE, S::ZERO, S::ONE);
        let mut scale = S::ONE;
        while levels < LEVELS {
            (arithmetic[levels], geometric[levels], present[levels]) = (a, g, active);
            levels += 1;
            let next = half * (a + g);
            mean = S::select(active, next, mean);
            // Bulirsch's m is 2^level times the mean, his k_c 2^level times g.
            let double = scale + scale;
            let inverse = S::ONE / (double * next);
            let modulus = scale * g;
            (cosine_upper, cosine_lower, cosine_b) =
                advanced(active, modulus, inverse, (cosine_upper, cosine_lower, cosine_b));
            (sine_upper, sine_lower, sine_b) = advanced(active, modulus, inverse, (sine_upper, sine_lower, sine_b));
            scale = S::select(active, double, scale);
            active = active.and((a - g).abs().more(agreement * a));
            if !active.any() {
                break;
            }
            g = S::select(active, (a * g).sqrt(), g);
            a = S::select(active, next, a);
        }
        let factor = S::PI / (S::from_f64(4.0) * scale * mean);
        Self {
            arithmetic,
            geometric,
            present,
            levels,
            mean,
            cosine_integral: factor * cosine_upper,
            sine_integral: factor * sine_upper,
        }
    }

    /// The complete integral of the first kind, `K`, to a few ε.
    #[inline(always)]
    pub fn quarter_period(&self) -> S {
        S::PI / (S::from_f64(2.0) * self.mean)
    }

    /// The amplitude of the argument `u`, given the quarter period `K`.
    ///
    /// Guarantee: a few ε relative to the argument.
    #[inline(always)]
    pub fn amplitude(&self, u: S, quarter_period: S) -> Amplitude<S> {
        let half = S::from_f64(0.5);
        let period = quarter_period + quarter_period;
        let half_turns = (u / period + half).floor();
        let odd = half_turns - S::from_f64(2.0) * (half_turns * half).floor();
        let sign = S::ONE - (odd + odd);
        let v = u - half_turns * period;
        let (sine, cosine) = first_quadrant(v.abs() * self.mean);
        let nothing = sine.at_most(S::ZERO);
        // a and c are cotangents all the way up; rounding may leave the last one just below zero at φ = π/2.
        let mut a = cosine.max(S::ZERO) / S::select(nothing, S::ONE, sine);
        let mut c = self.mean * a;
        let mut d = S::ONE;
        for level in (0..self.levels).rev() {
            let (present, arithmetic) = (self.present[level], self.arithmetic[level]);
            let (next_a, next_c) = (a * c, c * d);
            let next_d = (self.geometric[level] + next_a) / (arithmetic + next_a);
            a = S::select(present, next_c / arithmetic, a);
            c = S::select(present, next_c, c);
            d = S::select(present, next_d, d);
        }
        let cotangent = c.max(S::from_f64(1e-140));
        let sine = S::ONE / (S::ONE + cotangent * cotangent).sqrt();
        let cosine = S::select(nothing, S::ONE, cotangent * sine);
        let sine = S::select(v.less(S::ZERO), -sine, sine);
        Amplitude { half_turns, sign, sine: S::select(nothing, S::ZERO, sine), cosine }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elliptic::carlson::{r_d, r_f};

    /// Oracle: the inverse function, F(φ) by Carlson's R_F, on both sides of K and over several periods.
    #[test]
    fn the_amplitude_inverts_the_first_kind() {
        for complementary in [1.0, 0.9, 0.3, 1e-3, 1e-10, 1e-40, 1e-250] {
            let chain = Landen::<f64>::new(complementary);
            let integrals = (chain.cosine_integral, chain.sine_integral);
            let expected = (r_d(0.0, 1.0, complementary) * complementary / 3.0, r_d(0.0, complementary, 1.0) / 3.0);
            assert!((integrals.0 / expected.0 - 1.0).abs() < 8.0 * f64::EPSILON, "{complementary:e}: B");
            assert!((integrals.1 / expected.1 - 1.0).abs() < 8.0 * f64::EPSILON, "{complementary:e}: D");
            let quarter = r_f(0.0, complementary, 1.0);
            assert!((chain.quarter_period() / quarter - 1.0).abs() < 8.0 * f64::EPSILON);
            for fraction in [1e-9, 0.1, 0.5, 0.9, 0.999, 1.1, 1.9, 2.3, 5.4, 8.7] {
                let u = fraction * quarter;
                let a = chain.amplitude(u, quarter);
                let square = a.cosine * a.cosine;
                let remainder = complementary * a.sine * a.sine + square;
                let v = a.sine * r_f(square, remainder, 1.0);
                let back = v + 2.0 * quarter * a.half_turns;
                assert!((back / u - 1.0).abs() < 16.0 * f64::EPSILON, "{complementary:e} {fraction}: {back} {u}");
                assert_eq!(a.sign, if (a.half_turns as i64) % 2 == 0 { 1.0 } else { -1.0 });
            }
        }
    }
}
