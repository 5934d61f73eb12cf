//! The Serret-Andoyer metric, `g = dx²/Z(y) + dy²/(C − Z(y))` with `Z(y) = A sin²y + B cos²y` (eq. 8).
//!
//! A, B, C are inverse moments of inertia; angles in radians. Holds what every formula of section 3 shares: the parameter of
//! the Darboux chart `k = (B − A)/(C − A)`, `k' = (C − B)/(C − A)`, `α = √(C − A)`, and the half-width `K(k)/α` of its strip.
//! The article calls `k` a modulus; in its formulas, as here, it stands where the parameter `m` stands.

use super::start::StartError;
use crate::numerics::elliptic::complete::complete_k;
use crate::numerics::real::Real;

/// A Serret-Andoyer metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric<S: Real = f64> {
    a: S,
    b: S,
    c: S,
    alpha: S,
    parameter: S,
    complementary_parameter: S,
    complete_k: S,
}

impl<S: Real> Metric<S> {
    /// The metric of a body with inverse moments of inertia `A`, `B`, `C`.
    ///
    /// Errors: [`StartError::NotFinite`] and [`StartError::InertiaOrder`] unless `0 < A < B < C` are finite.
    pub fn new(a: S, b: S, c: S) -> Result<Self, StartError> {
        for (name, value) in [("A", a), ("B", b), ("C", c)] {
            if !value.is_finite() {
                return Err(StartError::NotFinite { name, value: value.to_f64() });
            }
        }
        if !(S::ZERO < a && a < b && b < c) {
            return Err(StartError::InertiaOrder { a: a.to_f64(), b: b.to_f64(), c: c.to_f64() });
        }
        let parameter = (b - a) / (c - a);
        let complementary_parameter = (c - b) / (c - a);
        let complete_k = complete_k(complementary_parameter);
        Ok(Self { a, b, c, alpha: (c - a).sqrt(), parameter, complementary_parameter, complete_k })
    }

    /// The smallest inverse moment of inertia.
    pub fn a(&self) -> S {
        self.a
    }
    /// The middle inverse moment of inertia.
    pub fn b(&self) -> S {
        self.b
    }
    /// The largest inverse moment of inertia.
    pub fn c(&self) -> S {
        self.c
    }
    /// `α = √(C − A)`.
    pub fn alpha(&self) -> S {
        self.alpha
    }
    /// The parameter of the Darboux chart, `k = (B − A)/(C − A)`.
    pub fn parameter(&self) -> S {
        self.parameter
    }
    /// `k' = 1 − k = (C − B)/(C − A)`.
    pub fn complementary_parameter(&self) -> S {
        self.complementary_parameter
    }
    /// The complete integral `K(k)`.
    pub fn complete_k(&self) -> S {
        self.complete_k
    }
    /// The half-width `K(k)/α` of the strip `|φ| < K(k)/α` in which oscillating trajectories move.
    pub fn half_width(&self) -> S {
        self.complete_k / self.alpha
    }
    /// `Z = A sin²y + B cos²y = 1/μ` at the angle from the equator whose sine is given.
    pub fn z_of_sine(&self, sine: S) -> S {
        self.a + (self.b - self.a) * sine * sine
    }
    /// `C − Z = C − A sin²y − B cos²y` at the angle from the equator whose cosine is given: a sum of positive terms.
    pub fn c_minus_z_of_cosine(&self, cosine: S) -> S {
        (self.c - self.b) + (self.b - self.a) * cosine * cosine
    }
    /// The Clairaut constant of the equator at arc length, `A^(−1/2)`: the largest one.
    pub fn equator_clairaut(&self) -> S {
        S::ONE / self.a.sqrt()
    }
    /// The Clairaut constant of the separatrices at arc length, `B^(−1/2)`.
    pub fn separatrix_clairaut(&self) -> S {
        S::ONE / self.b.sqrt()
    }
    /// The Clairaut constant of the rotations about the minor axis at arc length, `C^(−1/2)`: below it no motion of a body.
    pub fn minor_axis_clairaut(&self) -> S {
        S::ONE / self.c.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_no_metric() {
        assert!(matches!(Metric::new(2.0, 1.5, 2.8), Err(StartError::InertiaOrder { a: 2.0, .. })));
        assert!(matches!(Metric::new(1.5, 2.0, 2.0), Err(StartError::InertiaOrder { .. })));
        assert!(matches!(Metric::new(0.0, 2.0, 2.8), Err(StartError::InertiaOrder { .. })));
        assert!(matches!(Metric::new(1.5, f64::NAN, 2.8), Err(StartError::NotFinite { name: "B", .. })));
        assert!(matches!(Metric::new(1.5, 2.0, f64::INFINITY), Err(StartError::NotFinite { name: "C", .. })));
    }

    /// Oracle: mpmath, K(5/13)/√1.3 at 30 digits.
    #[test]
    fn strip_of_the_articles_metric() {
        let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
        assert!((metric.half_width() - HALF_WIDTH).abs() <= 3.0 * f64::EPSILON, "{}", metric.half_width());
        assert!((metric.parameter() + metric.complementary_parameter() - 1.0).abs() <= f64::EPSILON);
    }

    const HALF_WIDTH: f64 = 1.549_759_982_773_820_945_4;
}
