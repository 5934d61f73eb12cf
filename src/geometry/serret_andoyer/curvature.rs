//! Gauss curvature of the Serret-Andoyer metric (Proposition 3.21 ii).
//!
//! With `e1 = A + B + C`, `e2 = AB + AC + BC`, `e3 = ABC` and `Z = 1/μ`, from `G = −(√μ)''/√μ` and
//! `Z'² = 4(Z − A)(Z − B)(Z − C)`: `G = (e1 Z² − 2 e2 Z + 3 e3)/Z²`. That is the printed formula (`z = 2Z`). Its zeros in `Z` are
//! `Z± = (e2 ± √Δ)/e1`, `Δ = e2² − 3 e1 e3`, with `A < Z− < B < Z+ < C`; its only minimum is at `Z* = 3 e3/e2`, the harmonic mean of
//! A, B, C, where `G = e1 − e2²/(3 e3) = −e1 (Z+ − Z−)²/(4 Z+ Z−)`.
//!
//! The article takes `Z* < B` for granted. It holds if and only if `B > 2AC/(A + C)` (harmonic mean of A and C); else `G`
//! decreases all the way to `φ = K(k)/α`, which is then its minimum and no local maximum.
//!
//! Differences `Z − A`, `B − Z` are never formed by subtraction of `Z`s: near a sphere (A ≈ B ≈ C) that would lose everything.

use super::darboux::FromEquator;
use super::metric::Metric;
use crate::numerics::real::Real;

/// Where the Gauss curvature vanishes, and its extrema on `0 ≤ φ ≤ K(k)/α`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureProfile<S: Real = f64> {
    /// The zero `φ1 > 0`: `G > 0` for `|φ| < φ1`, `G < 0` beyond, up to `K(k)/α`.
    pub zero: S,
    /// The value `Z− = 1/μ(φ1)` at the zero (`z−/2` in the article).
    pub z_at_zero: S,
    /// Where `G` is least, `φ* > 0`: inside the strip, or at its edge (see `edge_is_maximum`).
    pub minimum_at: S,
    /// The least value.
    pub minimum: S,
    /// The largest value, at the equator: `G(0) = (B − A)(C − A)/A`.
    pub maximum: S,
    /// The value at the edge: `G(K/α) = −(B − A)(C − B)/B`.
    pub at_edge: S,
    /// Whether the edge is a local maximum, as the article says: if and only if `B > 2AC/(A + C)`.
    pub edge_is_maximum: bool,
}

/// `√Δ = √(e2² − 3 e1 e3)` as a sum of squares: `Δ = ½[A²(C − B)² + B²(C − A)² + C²(B − A)²]`.
fn root_of_discriminant<S: Real>(metric: &Metric<S>) -> S {
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    let sum = (a * (c - b)).squared() + (b * (c - a)).squared() + (c * (b - a)).squared();
    (sum * S::from_f64(0.5)).sqrt()
}

/// `BC − A²` and `B² − AC` without cancellation near a sphere.
fn shifts<S: Real>(metric: &Metric<S>) -> (S, S) {
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    (b * (c - a) + a * (b - a), b * (b - a) - a * (c - b))
}

impl<S: Real> Metric<S> {
    /// Gauss curvature `G(φ)`; any real φ, even, of period `2K(k)/α`.
    ///
    /// Guarantee: a few ε relative, times the condition in φ near its zeros.
    pub fn gauss_curvature(&self, phi: S) -> S {
        let sn = self.jacobi_of_phi(phi).sn;
        let (a, b, c) = (self.a(), self.b(), self.c());
        let from_a = (b - a) * sn * sn;
        let (shift, _) = shifts(self);
        let root = root_of_discriminant(self);
        let sum = a + b + c;
        // Z − Z− = (Z − A) − (Z− − A) and Z+ − Z = (Z+ − A) − (Z − A).
        let lower = a * (b - a) * (c - a) / (shift + root);
        let upper = (shift + root) / sum;
        let z = a + from_a;
        sum * ((lower - from_a) / z) * ((upper - from_a) / z)
    }

    /// Zeros and extrema of the Gauss curvature.
    pub fn curvature_profile(&self) -> CurvatureProfile<S> {
        let (a, b, c) = (self.a(), self.b(), self.c());
        let (ba, ca, cb) = (b - a, c - a, c - b);
        let (shift_a, shift_b) = shifts(self);
        let root = root_of_discriminant(self);
        let sum = a + b + c;
        // Z− − A and B − Z−, each by the root formula that does not cancel.
        let above_a = a * ba * ca / (shift_a + root);
        let below_b = if shift_b >= S::ZERO { (shift_b + root) / sum } else { b * ba * cb / (root - shift_b) };
        let at_sine_squared = |above: S, below: S| {
            let angle = FromEquator { half_turns: S::ZERO, sine: (above / ba).sqrt(), cosine: (below / ba).sqrt() };
            self.phi_of_angle(angle)
        };
        let e2 = a * b + a * c + b * c;
        // Z* − A and B − Z* with Z* = 3 e3/e2; the second is positive exactly when B > 2AC/(A + C).
        let star_above_a = a * (b * ca + c * ba) / e2;
        let star_below_b = b * (c * ba - a * cb) / e2;
        let maximum = ba * ca / a;
        let at_edge = -(ba * cb / b);
        let edge_is_maximum = star_below_b > S::ZERO;
        let (minimum_at, minimum) = if edge_is_maximum {
            // e1 − e2²/(3 e3) = −Δ/(3 e3).
            let least = -(root * root / (S::from_f64(3.0) * a * b * c));
            (at_sine_squared(star_above_a, star_below_b), least)
        } else {
            (self.half_width(), at_edge)
        };
        CurvatureProfile {
            zero: at_sine_squared(above_a, below_b),
            z_at_zero: a + above_a,
            minimum_at,
            minimum,
            maximum,
            at_edge,
            edge_is_maximum,
        }
    }
}

#[cfg(test)]
#[path = "curvature_tests.rs"]
mod tests;
