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

impl<P: Pack> Generalized<P> {
    /// `cel(√m', p², a, b)` before its first step.
    #[inline(always)]
    fn new(p: P, a: P, b: P) -> Self {
        Self { p, alpha: a, beta: b / p }
    }

    #[inline(always)]
    fn step(&mut self, mean: &Mean<P>) {
        let half = P::from_f64(0.5);
        let Self { p, alpha, beta } = *self;
        let inverse = P::ONE / p;
        let quotient = mean.a * mean.b * inverse;
        self.p = P::select(mean.active, (p + quotient) * half, p);
        self.alpha = P::select(mean.active, (alpha + beta * inverse) * half, alpha);
        self.beta = P::select(mean.active, (beta + alpha * quotient) * half, beta);
    }

    /// A step with `p = 1` at the first: then `p` is the mean itself.
    #[inline(always)]
    fn step_along(&mut self, mean: &Mean<P>) {
        let half = P::from_f64(0.5);
        let Self { alpha, beta, .. } = *self;
        self.alpha = P::select(mean.active, (alpha + beta / mean.a) * half, alpha);
        self.beta = P::select(mean.active, (beta + alpha * mean.b) * half, beta);
    }

    #[inline(always)]
    fn value(&self, mean: P) -> P {
        P::PI * P::from_f64(0.5) * (self.beta + self.alpha * mean) / (mean * (mean + self.p))
    }
}

/// The mean of `1` and `√m'` on its way.
struct Mean<P: Pack> {
    a: P,
    b: P,
    mean: P,
    /// Members of which the last pair was not yet close enough.
    active: P::Mask,
}

impl<P: Pack> Mean<P> {
    #[inline(always)]
    fn new(mc: P) -> Self {
        let b = mc.sqrt();
        Self { a: P::ONE, b, mean: (P::ONE + b) * P::from_f64(0.5), active: mc.more(P::ZERO) }
    }

    /// The next pair, if any member needs one.
    #[inline(always)]
    fn advance(&mut self) -> bool {
        // The limit differs from this mean by (a − b)²/(16 a): below rounding once |a − b| ≤ √ε a.
        let near = (self.a - self.b).abs().at_most(P::EPSILON.sqrt() * self.a);
        self.active = self.active.and(near.not());
        if !self.active.any() {
            return false;
        }
        self.b = P::select(self.active, (self.a * self.b).sqrt(), self.b);
        self.a = P::select(self.active, self.mean, self.a);
        self.mean = (self.a + self.b) * P::from_f64(0.5);
        true
    }

    #[inline(always)]
    fn first_kind(&self, mc: P) -> P {
        let value = P::PI * P::from_f64(0.5) / self.mean;
        let outside = P::select(mc.equals(P::ZERO), P::from_f64(f64::INFINITY), P::from_f64(f64::NAN));
        P::select(mc.more(P::ZERO), value, outside)
    }
}

/// `K(m) = ∫₀^{π/2} dx / √(1 − m sin²x) = π / (2 agm(1, √m'))`.
///
/// Domain: `m' ≥ 0` (`m' > 1`, that is `m < 0`, included). Guarantee: 2 ε relative. `m' = 0`: infinity.
#[inline(always)]
pub fn complete_k<P: Pack>(mc: P) -> P {
    let mut mean = Mean::new(mc);
    for _ in 0..MAX_MEAN_STEPS {
        if !mean.advance() {
            break;
        }
    }
    mean.first_kind(mc)
}

/// `(K, B)`, `B = ∫₀^{π/2} cos²x / √(1 − m sin²x) dx = (E − m' K)/m`.
///
/// Domain: `m' > 0`. Guarantee: 2 ε and 4 ε relative. The bits of K are those of [`complete_k`].
#[inline(always)]
pub fn complete_k_and_b<P: Pack>(mc: P) -> (P, P) {
    let mut mean = Mean::new(mc);
    let mut second = Generalized::new(P::ONE, P::ONE, P::ZERO);
    for _ in 0..MAX_MEAN_STEPS {
        second.step_along(&mean);
        if !mean.advance() {
            break;
        }
    }
    second.p = mean.mean;
    (mean.first_kind(mc), second.value(mean.mean))
}

/// `(K, B, J)`, `J = ∫₀^{π/2} sin²x / ((1 − n sin²x) √(1 − m sin²x)) dx = (Π − K)/n`; only `n' = 1 − n` enters.
///
/// Domain: `m' > 0`, `n' > 0`. Guarantee: 2, 4 and 6 ε relative. The bits of K and B are those of [`complete_k_and_b`].
#[inline(always)]
pub fn complete_k_b_and_j<P: Pack>(mc: P, nc: P) -> (P, P, P) {
    let mut mean = Mean::new(mc);
    let mut second = Generalized::new(P::ONE, P::ONE, P::ZERO);
    let mut third = Generalized::new(nc.sqrt(), P::ZERO, P::ONE);
    for _ in 0..MAX_MEAN_STEPS {
        second.step_along(&mean);
        third.step(&mean);
        if !mean.advance() {
            break;
        }
    }
    second.p = mean.mean;
    (mean.first_kind(mc), second.value(mean.mean), third.value(mean.mean))
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
