//! Jacobi's amplitude from an argument: descending Landen transformations.
//!
//! Source: R. Bulirsch, *Numerical calculation of elliptic integrals and elliptic functions*, Numer. Math. 7 (1965)
//! 78-90 (procedure `sncndn`), on the arithmetic-geometric mean of `1` and `√m'`. The complementary parameter
//! `m' = 1 − m` is the input, so nothing is lost near the separatrix.
//!
//! Here it only chooses where to evaluate: an instant is described by its amplitude, and the time belonging to that
//! amplitude is computed from it. So its own rounding errors do not reach a result.

use crate::numerics::real::Real;

/// Transformations kept. The mean of 1 and 1e-154 (`m'` at the end of the normal numbers) needs 11.
const LEVELS: usize = 16;

/// The chain of arithmetic-geometric means for one complementary parameter.
#[derive(Debug, Clone, Copy)]
pub struct Landen<S> {
    arithmetic: [S; LEVELS],
    geometric: [S; LEVELS],
    levels: usize,
    mean: S,
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

impl<S: Real> Landen<S> {
    /// The chain for `0 < m' ≤ 1`.
    pub fn new(complementary_parameter: S) -> Self {
        let half = S::from_f64(0.5);
        // The mean is taken once its two arguments agree to √ε: the next step would agree to ε.
        let agreement = S::EPSILON.sqrt();
        let mut arithmetic = [S::ONE; LEVELS];
        let mut geometric = [S::ONE; LEVELS];
        let mut a = S::ONE;
        let mut g = complementary_parameter.sqrt();
        let mut levels = 0;
        let mut mean = half * (a + g);
        while levels < LEVELS {
            arithmetic[levels] = a;
            geometric[levels] = g;
            levels += 1;
            mean = half * (a + g);
            if (a - g).abs() <= agreement * a {
                break;
            }
            g = (a * g).sqrt();
            a = mean;
        }
        Self { arithmetic, geometric, levels, mean }
    }

    /// The complete integral of the first kind, `K`, to a few ε.
    pub fn quarter_period(&self) -> S {
        S::PI / (S::from_f64(2.0) * self.mean)
    }

    /// The amplitude of the argument `u`, given the quarter period `K`.
    ///
    /// Guarantee: a few ε relative to the argument.
    pub fn amplitude(&self, u: S, quarter_period: S) -> Amplitude<S> {
        let half = S::from_f64(0.5);
        let period = quarter_period + quarter_period;
        let half_turns = (u / period + half).floor();
        let odd = half_turns - S::from_f64(2.0) * (half_turns * half).floor();
        let sign = S::ONE - (odd + odd);
        let v = u - half_turns * period;
        let (sine, cosine) = (v.abs() * self.mean).sin_cos();
        if sine <= S::ZERO {
            return Amplitude { half_turns, sign, sine: S::ZERO, cosine: S::ONE };
        }
        // a and c are cotangents all the way up; rounding may leave the last one just below zero at φ = π/2.
        let mut a = cosine.max(S::ZERO) / sine;
        let mut c = self.mean * a;
        let mut d = S::ONE;
        for level in (0..self.levels).rev() {
            a *= c;
            c *= d;
            d = (self.geometric[level] + a) / (self.arithmetic[level] + a);
            a = c / self.arithmetic[level];
        }
        let cotangent = c.max(S::from_f64(1e-140));
        let sine = S::ONE / (S::ONE + cotangent * cotangent).sqrt();
        let cosine = cotangent * sine;
        Amplitude { half_turns, sign, sine: if v < S::ZERO { -sine } else { sine }, cosine }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elliptic::carlson::r_f;

    /// Oracle: the inverse function, F(φ) by Carlson's R_F, on both sides of K and over several periods.
    #[test]
    fn the_amplitude_inverts_the_first_kind() {
        for complementary in [1.0, 0.9, 0.3, 1e-3, 1e-10, 1e-40, 1e-250] {
            let chain = Landen::new(complementary);
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
