//! Incomplete elliptic integrals of Legendre, with the complementary parameter as an input.
//!
//! Each integral comes in two forms. The `_sc` form takes the sine and the cosine of an amplitude in `[−π/2, π/2]`: where
//! both are known accurately (near π/2 the cosine carries all the information), nothing is lost. The other form takes any
//! real amplitude, reduces it by whole multiples of π and adds as many half periods.
//!
//! With `q = m' + m c²` (`1 − m s²` for `m < 0`) and `r = n' + n c²` (`1 − n s²` for `n < 0`), all terms are positive:
//! `F = s R_F(c², q, 1)`, `E = m' F + m m' s³/3 R_D(c², 1, q) + m s c/√q` for `m ≥ 0` (`F − m s³/3 R_D(c², q, 1)` for `m < 0`),
//! `Π = F + n s³/3 R_J(c², q, 1, r)`. Sources: NIST Digital Library 19.25.5, 19.25.9-10, 19.25.14.
//!
//! Not known here: `n s² > 1` (Cauchy principal values). Outside its domain a function returns NaN.

use super::carlson::{r_d, r_f, r_f_and_r_d, r_j};
use super::complete::{complete_d, complete_e, complete_j, complete_k, complete_pi};
use crate::numerics::real::Real;

/// A cosine whose square may underflow beside m' = 1e-300; what is of second order in it is far below rounding.
const TINY_COSINE: f64 = 1e-100;

/// `1 − m s²` as a sum of positive terms.
pub fn delta_squared<S: Real>(s: S, c: S, m: S, mc: S) -> S {
    if m >= S::ZERO { mc + m * c * c } else { S::ONE - m * s * s }
}

/// First kind of an amplitude in `[−π/2, π/2]`, `F = ∫₀^φ dx / √(1 − m sin²x)`, from `s = sin φ` and `c = cos φ ≥ 0`.
///
/// Domain: `m' ≥ 0`. Guarantee: 4 ε relative. At `m' = 0` it is `asinh(s/c)`, infinite at `c = 0`.
pub fn incomplete_f_sc<S: Real>(s: S, c: S, m: S, mc: S) -> S {
    if mc == S::ZERO {
        return if c == S::ZERO { s / S::ZERO } else { (s / c).asinh() };
    }
    if c < S::from_f64(TINY_COSINE) {
        // F = K − ∫₀^c dx/√(m' + m x²) up to O(c²).
        return s * (complete_k(mc) - if m > S::ZERO { (c / mc.sqrt()).asinh() } else { S::ZERO });
    }
    s * r_f(c * c, delta_squared(s, c, m, mc), S::ONE)
}

/// Second kind of an amplitude in `[−π/2, π/2]`, `E = ∫₀^φ √(1 − m sin²x) dx`, from `s = sin φ` and `c = cos φ ≥ 0`.
///
/// Domain: `m' ≥ 0`. Guarantee: 6 ε relative.
pub fn incomplete_e_sc<S: Real>(s: S, c: S, m: S, mc: S) -> S {
    if mc == S::ZERO {
        return s;
    }
    if c < S::from_f64(TINY_COSINE) {
        // E(φ) differs from E(π/2) by less than c √(1 + m').
        return s * complete_e(mc);
    }
    let third = S::ONE / S::from_f64(3.0);
    let q = delta_squared(s, c, m, mc);
    let cc = c * c;
    if m >= S::ZERO {
        let s3 = s * s * s * third;
        mc * (s * r_f(cc, q, S::ONE) + m * s3 * r_d(cc, S::ONE, q)) + m * s * c / q.sqrt()
    } else {
        s * r_f(cc, q, S::ONE) - m * incomplete_d_sc(s, c, m, mc)
    }
}

/// Associate second kind of an amplitude in `[−π/2, π/2]`, `D = ∫₀^φ sin²x / √(1 − m sin²x) dx = (F − E)/m`.
///
/// Domain: `m' ≥ 0`, not both `m'` and `c` zero. Guarantee: 4 ε relative.
pub fn incomplete_d_sc<S: Real>(s: S, c: S, m: S, mc: S) -> S {
    s * s * s * r_d(c * c, delta_squared(s, c, m, mc), S::ONE) / S::from_f64(3.0)
}

/// Associate third kind of an amplitude in `[−π/2, π/2]`, `J = ∫₀^φ sin²x / ((1 − n sin²x) √(1 − m sin²x)) dx = (Π − F)/n`.
///
/// Domain: `1 − n s² > 0`, `m' ≥ 0`, not both `m'` and `c` zero. Guarantee: 6 ε relative, for every sign of `n`.
pub fn incomplete_j_sc<S: Real>(s: S, c: S, n: S, nc: S, m: S, mc: S) -> S {
    let r = delta_squared(s, c, n, nc);
    s * s * s * r_j(c * c, delta_squared(s, c, m, mc), S::ONE, r) / S::from_f64(3.0)
}

/// Third kind of an amplitude in `[−π/2, π/2]`, `Π = ∫₀^φ dx / ((1 − n sin²x) √(1 − m sin²x))`.
///
/// Domain: `1 − n s² > 0`, `m' ≥ 0`, not both `m'` and `c` zero. Guarantee: 8 ε relative for `n ≥ 0`; for `n < 0` the two
/// terms of `F + n J` cancel by the factor `F/Π` (use [`incomplete_j_sc`] where a formula allows it).
pub fn incomplete_pi_sc<S: Real>(s: S, c: S, n: S, nc: S, m: S, mc: S) -> S {
    incomplete_f_sc(s, c, m, mc) + n * incomplete_j_sc(s, c, n, nc, m, mc)
}

/// An amplitude reduced by whole multiples of π.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedAmplitude<S: Real> {
    /// The number of multiples of π taken away.
    pub half_turns: S,
    /// Sine of the rest, which lies in `[−π/2, π/2]`.
    pub sine: S,
    /// Cosine of the rest, `≥ 0`.
    pub cosine: S,
}

/// Reduces an amplitude to `[−π/2, π/2]`.
///
/// Sine and cosine are those of the whole amplitude up to sign, so that the rest is as accurate as they are, near π/2 too.
/// Beside an odd multiple of π/2 the quotient may round to the wrong side: the sign of the cosine decides.
pub fn reduce_amplitude<S: Real>(phi: S) -> ReducedAmplitude<S> {
    let half = S::from_f64(0.5);
    let (sine, cosine) = phi.sin_cos();
    let quotient = phi / S::PI;
    let mut half_turns = (quotient + half).floor();
    let is_odd = |n: S| (n * half).floor() * S::from_f64(2.0) != n;
    if is_odd(half_turns) != (cosine < S::ZERO) {
        half_turns = if quotient < half_turns { half_turns - S::ONE } else { half_turns + S::ONE };
    }
    if cosine < S::ZERO {
        ReducedAmplitude { half_turns, sine: -sine, cosine: -cosine }
    } else {
        ReducedAmplitude { half_turns, sine, cosine }
    }
}

fn whole_periods<S: Real>(half_turns: S, complete: impl FnOnce() -> S) -> S {
    if half_turns == S::ZERO { S::ZERO } else { (half_turns + half_turns) * complete() }
}

/// First kind of any real amplitude, `F(φ|m) = ∫₀^φ dx / √(1 − m sin²x)`; odd in φ, `F(φ + π) = F(φ) + 2K`.
///
/// Domain: `m' ≥ 0` (at `m' = 0` only `|φ| < π/2`, else infinite). Guarantee: 4 ε relative, times the condition in φ.
pub fn incomplete_f<S: Real>(phi: S, m: S, mc: S) -> S {
    let a = reduce_amplitude(phi);
    whole_periods(a.half_turns, || complete_k(mc)) + incomplete_f_sc(a.sine, a.cosine, m, mc)
}

/// Second kind of any real amplitude, `E(φ|m) = ∫₀^φ √(1 − m sin²x) dx`; odd in φ, `E(φ + π) = E(φ) + 2E`.
///
/// Domain: `m' ≥ 0`. Guarantee: 6 ε relative, times the condition in φ.
pub fn incomplete_e<S: Real>(phi: S, m: S, mc: S) -> S {
    let a = reduce_amplitude(phi);
    whole_periods(a.half_turns, || complete_e(mc)) + incomplete_e_sc(a.sine, a.cosine, m, mc)
}

/// Third kind of any real amplitude, `Π(n; φ|m) = ∫₀^φ dx / ((1 − n sin²x) √(1 − m sin²x))`; odd in φ.
///
/// Domain: `n' > 0`, `m' > 0`. Guarantee: 8 ε relative for `n ≥ 0` (see [`incomplete_pi_sc`] for `n < 0`).
pub fn incomplete_pi<S: Real>(phi: S, n: S, nc: S, m: S, mc: S) -> S {
    let a = reduce_amplitude(phi);
    whole_periods(a.half_turns, || complete_pi(n, nc, m, mc)) + incomplete_pi_sc(a.sine, a.cosine, n, nc, m, mc)
}

/// Associate second kind of any real amplitude, `D(φ|m) = (F − E)/m`; odd in φ. See [`incomplete_d_sc`].
pub fn incomplete_d<S: Real>(phi: S, m: S, mc: S) -> S {
    let a = reduce_amplitude(phi);
    whole_periods(a.half_turns, || complete_d(mc)) + incomplete_d_sc(a.sine, a.cosine, m, mc)
}

/// Associate third kind of any real amplitude, `J(n; φ|m) = (Π − F)/n`; odd in φ. See [`incomplete_j_sc`].
pub fn incomplete_j<S: Real>(phi: S, n: S, nc: S, m: S, mc: S) -> S {
    let a = reduce_amplitude(phi);
    whole_periods(a.half_turns, || complete_j(nc, mc)) + incomplete_j_sc(a.sine, a.cosine, n, nc, m, mc)
}

/// The integral of `tan²` along the first kind, `∫₀^φ tan²x / √(1 − m sin²x) dx = s³/3 R_D(q, 1, c²)`, together with `F`.
///
/// In Jacobi's functions `∫₀^u sc² du` and `u` with `φ = am u`; `m' ∫ sc² = sc dn − ε(u)` without its cancellation.
/// Domain: `c > 0`, `m' ≥ 0`. Guarantee: 4 ε relative each.
pub fn tangent_squared_and_f_sc<S: Real>(s: S, c: S, m: S, mc: S) -> (S, S) {
    let (f, d) = r_f_and_r_d(delta_squared(s, c, m, mc), S::ONE, c * c);
    (s * s * s * d / S::from_f64(3.0), s * f)
}

#[cfg(test)]
#[path = "incomplete_tests.rs"]
mod tests;
