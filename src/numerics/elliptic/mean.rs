//! Complete elliptic integrals by the arithmetic-geometric mean, several of one parameter by one run of it.
//!
//! `K = π/(2 agm(1, √m'))`. Bulirsch's generalized integral
//! `cel(√m', p, a, b) = ∫₀^{π/2} (a cos² + b sin²)/(cos² + p sin²) dx/√(cos² + m' sin²)` follows the same mean: with `a, b ≥ 0` and
//! `p > 0` each step adds positive terms, so nothing cancels, and the number of right digits doubles. `B = cel(√m', 1, 1, 0)`,
//! `J = cel(√m', n', 0, 1)`. Here both means and coefficients are halved at every step, where Bulirsch lets them double.
//!
//! Sources: R. Bulirsch, Numer. Math. 13 (1969) 305-315 (`cel`); NIST Digital Library 19.8.5.
//!
//! On a pack the steps go on while any member needs one; the others keep what they have. Not known here: `p < 0`.

use crate::numerics::pack::{Mask, Pack};

/// Steps after which the mean gives up: the square root of the ratio of two `f64` is taken at each of the first ten
/// steps, then the number of right digits doubles.
pub(super) const MAX_MEAN_STEPS: usize = 24;

/// `cel` on its way: `π/2 (β + α M)/(M (M + p))` at the mean `M`.
#[derive(Clone, Copy)]
struct Generalized<P> {
    p: P,
    alpha: P,
    beta: P,
}

/// `K(m) = ∫₀^{π/2} dx / √(1 − m sin²x) = π / (2 agm(1, √m'))`.
///
/// Domain: `m' ≥ 0` (`m' > 1`, that is `m < 0`, included). Guarantee: 2 ε relative. `m' = 0`: infinity.
#[inline(always)]
pub fn complete_k<P: Pack>(mc: P) -> P {
    first_kind(mc, mean_of(mc, |_, _, _| {}))
}

/// `(K, B)`, `B = ∫₀^{π/2} cos²x / √(1 − m sin²x) dx = (E − m' K)/m`.
///
/// Domain: `m' > 0`. Guarantee: 2 ε and 4 ε relative. The bits of K are those of [`complete_k`].
#[inline(always)]
pub fn complete_k_and_b<P: Pack>(mc: P) -> (P, P) {
    let mut second = (P::ONE, P::ZERO);
    let mean = mean_of(mc, |active, a, b| second_step(&mut second, active, a, b));
    (first_kind(mc, mean), second_kind(second, mean))
}

/// `(K, B, J)`, `J = ∫₀^{π/2} sin²x / ((1 − n sin²x) √(1 − m sin²x)) dx = (Π − K)/n`; only `n' = 1 − n` enters.
///
/// Domain: `m' > 0`, `n' > 0`. Guarantee: 2, 4 and 6 ε relative. The bits of K and B are those of [`complete_k_and_b`].
#[inline(always)]
pub fn complete_k_b_and_j<P: Pack>(mc: P, nc: P) -> (P, P, P) {
    let half = P::from_f64(0.5);
    let mut second = (P::ONE, P::ZERO);
    let root = nc.sqrt();
    let mut third = Generalized { p: root, alpha: P::ZERO, beta: P::ONE / root };
    let mean = mean_of(mc, |active, a, b| {
        second_step(&mut second, active, a, b);
        let inverse = P::ONE / third.p;
        let quotient = a * b * inverse;
        let Generalized { p, alpha, beta } = third;
        third = Generalized {
            p: P::select(active, (p + quotient) * half, p),
            alpha: P::select(active, (alpha + beta * inverse) * half, alpha),
            beta: P::select(active, (beta + alpha * quotient) * half, beta),
        };
    });
    let j = P::PI * half * (third.beta + third.alpha * mean) / (mean * (mean + third.p));
    (first_kind(mc, mean), second_kind(second, mean), j)
}

#[inline(always)]
fn first_kind<P: Pack>(mc: P, mean: P) -> P {
    let value = P::PI * P::from_f64(0.5) / mean;
    let outside = P::select(mc.equals(P::ZERO), P::from_f64(f64::INFINITY), P::from_f64(f64::NAN));
    P::select(mc.more(P::ZERO), value, outside)
}

/// A step of `cel` with `p = 1`: there the mean itself takes the place of `p`.
#[inline(always)]
fn second_step<P: Pack>(second: &mut (P, P), active: P::Mask, a: P, b: P) {
    let half = P::from_f64(0.5);
    let (alpha, beta) = *second;
    second.0 = P::select(active, (alpha + beta / a) * half, alpha);
    second.1 = P::select(active, (beta + alpha * b) * half, beta);
}

#[inline(always)]
fn second_kind<P: Pack>((alpha, beta): (P, P), mean: P) -> P {
    P::PI * P::from_f64(0.5) * (beta + alpha * mean) / (mean * (mean + mean))
}

/// The mean of `1` and `√m'`; `step(active, a, b)` is told every pair on the way.
#[inline(always)]
fn mean_of<P: Pack>(mc: P, mut step: impl FnMut(P::Mask, P, P)) -> P {
    let half = P::from_f64(0.5);
    let near = P::EPSILON.sqrt();
    let (mut a, mut b) = (P::ONE, mc.sqrt());
    let mut mean = (a + b) * half;
    let mut active = mc.more(P::ZERO);
    for _ in 0..MAX_MEAN_STEPS {
        step(active, a, b);
        // The limit differs from this mean by (a − b)²/(16 a): below rounding once |a − b| ≤ √ε a.
        active = active.and((a - b).abs().at_most(near * a).not());
        if !active.any() {
            break;
        }
        b = P::select(active, (a * b).sqrt(), b);
        a = P::select(active, mean, a);
        mean = (a + b) * half;
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elliptic::complete::{complete_b, complete_j};

    /// Oracle: Carlson's duplication, from the nearly degenerate to the nearly singular.
    #[test]
    fn the_mean_and_the_duplication_agree() {
        let mut worst = [0.0_f64; 2];
        for i in 0..=300 {
            let mc: f64 = libm::exp10(f64::from(i) - 290.0);
            for nc in [1e-12, 1e-3, 0.2, 1.0, 1.0 + 1e-9, 1.7, 40.0, 1e6, 1e13] {
                let (k, b, j) = complete_k_b_and_j(mc, nc);
                assert_eq!(k, complete_k(mc));
                assert_eq!((k, b), complete_k_and_b(mc));
                worst[0] = worst[0].max((b / complete_b(mc) - 1.0).abs() / f64::EPSILON);
                worst[1] = worst[1].max((j / complete_j(nc, mc) - 1.0).abs() / f64::EPSILON);
            }
        }
        println!("B {:.1} ε, J {:.1} ε", worst[0], worst[1]);
        assert!(worst[0] <= 8.0 && worst[1] <= 12.0, "{worst:?}");
    }
}
