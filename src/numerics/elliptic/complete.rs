//! Complete elliptic integrals of Legendre, with the complementary parameter as an input.
//!
//! Near the separatrix of the article (m → 1) it is `m' = 1 − m` that is known accurately, and near a stable rotation
//! (m → 0) it is `m`; so the functions take both where both matter, and the caller passes what he knows. Likewise the
//! characteristic `n` of the third kind comes with `n' = 1 − n`. Nothing here subtracts nearly equal numbers: `K` is an
//! arithmetic-geometric mean, everything else a sum of positive Carlson integrals.
//!
//! Sources: NIST Digital Library 19.8.5 (`K`), 19.25.1-2 (`E`, `K − E`, `Π`), 19.7.9 (negative characteristic);
//! T. Fukushima, J. Comput. Appl. Math. 235 (2011) 4140, for the *associate* integrals B, D and J.
//!
//! Not known here: `n > 1` (Cauchy principal values), complex parameters. Outside its domain a function returns NaN.

use super::carlson::{r_d, r_j};
pub(super) use super::mean::MAX_MEAN_STEPS;
pub use super::mean::complete_k;
use crate::numerics::real::Real;

/// Second kind, `E(m) = ∫₀^{π/2} √(1 − m sin²x) dx`.
///
/// Domain: `m' ≥ 0`. Guarantee: 4 ε relative. `m' = 0`: one.
pub fn complete_e<S: Real>(mc: S) -> S {
    if mc == S::ZERO {
        return S::ONE;
    }
    if mc <= S::ONE {
        mc * (complete_k(mc) + (S::ONE - mc) * r_d(S::ZERO, S::ONE, mc) / S::from_f64(3.0))
    } else {
        complete_k(mc) - complete_k_minus_e(S::ONE - mc, mc)
    }
}

/// `K(m) − E(m) = m ∫₀^{π/2} sin²x / √(1 − m sin²x) dx = (m/3) R_D(0, m', 1)`, without subtraction.
///
/// Domain: `m' > 0`, `m + m' = 1`. Guarantee: 4 ε relative, also for `m → 0`.
pub fn complete_k_minus_e<S: Real>(m: S, mc: S) -> S {
    m * complete_d(mc)
}

/// Associate second kind, `D(m) = ∫₀^{π/2} sin²x / √(1 − m sin²x) dx = (K − E)/m`.
///
/// Domain: `m' > 0`. Guarantee: 4 ε relative. `m = 0`: π/4.
pub fn complete_d<S: Real>(mc: S) -> S {
    r_d(S::ZERO, mc, S::ONE) / S::from_f64(3.0)
}

/// Associate second kind, `B(m) = ∫₀^{π/2} cos²x / √(1 − m sin²x) dx = (E − m' K)/m`; `dK/dm = B/(2m')`.
///
/// Domain: `m' > 0`. Guarantee: 4 ε relative. `m = 0`: π/4.
pub fn complete_b<S: Real>(mc: S) -> S {
    mc * r_d(S::ZERO, S::ONE, mc) / S::from_f64(3.0)
}

/// Associate third kind, `J(n|m) = ∫₀^{π/2} sin²x / ((1 − n sin²x) √(1 − m sin²x)) dx = (Π − K)/n`.
///
/// Only `n' = 1 − n` enters: `J = R_J(0, m', 1, n')/3`. Domain: `m' > 0`, `n' > 0`. Guarantee: 6 ε relative for every
/// sign of `n`. `n = m = 0`: π/4.
pub fn complete_j<S: Real>(nc: S, mc: S) -> S {
    r_j(S::ZERO, mc, S::ONE, nc) / S::from_f64(3.0)
}

/// Third kind, `Π(n|m) = ∫₀^{π/2} dx / ((1 − n sin²x) √(1 − m sin²x))`.
///
/// Domain: `n' = 1 − n > 0`, `m' = 1 − m > 0`, `m'/n'` no denormal number. Guarantee: 8 ε relative for `n ≥ 0`, and for `n < 0` when `m ≥ 0` (by
/// the change of characteristic `N = (m − n)/(1 − n)`, whose terms are positive); for `n < 0` and `m < 0` the sum `K + n J`
/// loses what its terms cancel.
pub fn complete_pi<S: Real>(n: S, nc: S, m: S, mc: S) -> S {
    if n < S::ZERO && m >= S::ZERO {
        // With 1 − N = m'/n': Π(n) = [m K − n (m'/n') Π(N)] / (m − n).
        let changed = (m - n) / nc;
        let changed_complement = mc / nc;
        let k = complete_k(mc);
        let pi_changed = k + changed * complete_j(changed_complement, mc);
        (m * k - n * changed_complement * pi_changed) / (m - n)
    } else {
        complete_k(mc) + n * complete_j(nc, mc)
    }
}

#[cfg(test)]
#[path = "complete_tests.rs"]
mod tests;
