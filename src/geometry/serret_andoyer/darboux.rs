//! The Darboux chart, `g = dφ² + μ(φ) dθ²` (section 3.3.2, Proposition 3.21 i).
//!
//! `θ = x` and `y = π/2 + am(αφ|k)`, on the universal cover: φ is the distance from the equator `y = π/2`, grows with `y`, and the
//! strip `|φ| ≤ K(k)/α` is `0 ≤ y ≤ π`. `1/μ = Z = A cn²(αφ|k) + B sn²(αφ|k)`; the article's `z` is `2Z`.

use super::metric::Metric;
use crate::numerics::elliptic::incomplete::incomplete_f_sc;
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// An angle `y` as a whole number of half turns and the angle `a ∈ [−π/2, π/2]` from the equator: `y = π/2 + jπ + a`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FromEquator<S: Real = f64> {
    /// The half turns `j`: the strip `jπ ≤ y ≤ (j+1)π`.
    pub half_turns: S,
    /// `sin a = −(−1)^j cos y`.
    pub sine: S,
    /// `cos a = (−1)^j sin y ≥ 0`.
    pub cosine: S,
}

impl<S: Real> FromEquator<S> {
    /// Splits an angle `y`. Sine and cosine are those of `y` itself: nothing is lost by subtracting π/2. On the border of two
    /// strips (`sin y = 0`) the upper one is taken.
    pub fn of_y(y: S) -> Self {
        let half = S::from_f64(0.5);
        let (sine_y, cosine_y) = y.sin_cos();
        let quotient = y / S::PI;
        let mut half_turns = quotient.floor();
        let is_odd = |n: S| (n * half).floor() * S::from_f64(2.0) != n;
        // Beside a multiple of π the rounded quotient may be on the wrong side: the sign of sin y decides.
        if sine_y != S::ZERO && is_odd(half_turns) != (sine_y < S::ZERO) {
            half_turns = if quotient - half_turns > half { half_turns + S::ONE } else { half_turns - S::ONE };
        }
        // Beyond 2^53 half turns parity is lost, and the sign is not.
        let odd = if sine_y == S::ZERO { is_odd(half_turns) } else { sine_y < S::ZERO };
        if odd {
            Self { half_turns, sine: cosine_y, cosine: -sine_y }
        } else {
            Self { half_turns, sine: -cosine_y, cosine: sine_y }
        }
    }

    /// The angle `y = π/2 + jπ + a`.
    pub fn y(&self) -> S {
        S::PI * (self.half_turns + S::from_f64(0.5)) + self.sine.atan2(self.cosine)
    }
}

impl<S: Real> Metric<S> {
    /// `φ = F(y − π/2|k)/α`, the inverse of [`Metric::y_of_phi`]; any real `y`. Guarantee: a few ε times the condition.
    pub fn phi_of_y(&self, y: S) -> S {
        self.phi_of_angle(FromEquator::of_y(y))
    }

    /// φ of an angle given by half turns, sine and cosine: nothing is lost at the edges of the strip.
    pub fn phi_of_angle(&self, angle: FromEquator<S>) -> S {
        let (k, kc) = (self.parameter(), self.complementary_parameter());
        let whole = (angle.half_turns + angle.half_turns) * self.complete_k();
        (whole + incomplete_f_sc(angle.sine, angle.cosine, k, kc)) / self.alpha()
    }

    /// `y = π/2 + am(αφ|k)`; any real φ, on the universal cover. Guarantee: a few ε times the condition.
    pub fn y_of_phi(&self, phi: S) -> S {
        S::PI * S::from_f64(0.5) + self.jacobi_of_phi(phi).am
    }

    /// Jacobi's functions of `αφ` for the parameter `k`: `sn = sin a = −cos y`, `cn = cos a = sin y`.
    pub fn jacobi_of_phi(&self, phi: S) -> Jacobi<S> {
        Jacobi::new(self.alpha() * phi, self.parameter(), self.complementary_parameter())
    }

    /// `Z(φ) = A cn²(αφ|k) + B sn²(αφ|k) ∈ [A, B]`; the article's `z(φ)` is `2Z`.
    pub fn z(&self, phi: S) -> S {
        self.z_of_sine(self.jacobi_of_phi(phi).sn)
    }

    /// `μ(φ) = 1/Z(φ) ∈ [1/B, 1/A]`, even, of period `2K(k)/α`.
    pub fn mu(&self, phi: S) -> S {
        S::ONE / self.z(phi)
    }

    /// The potential of `φ'² + V = 1` (`h = 1/2`): `V(φ, p_θ) = p_θ²/μ(φ)` (section 3.3.3, Fig. 2).
    pub fn potential(&self, phi: S, p_theta: S) -> S {
        p_theta * p_theta * self.z(phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metric() -> Metric {
        Metric::new(1.5, 2.0, 2.8).unwrap()
    }

    /// Oracle: mpmath at 40 digits, φ = F(y − π/2|k)/α over the universal cover.
    #[test]
    fn chart_and_its_inverse_on_the_universal_cover() {
        for (y, phi) in PHI_OF_Y {
            let got = metric().phi_of_y(y);
            assert!((got - phi).abs() <= 4.0 * f64::EPSILON * phi.abs().max(1.0), "y = {y}: {got} is not {phi}");
            // dy/dφ = √(C − Z) lies in [√0.8, √1.3].
            let back = metric().y_of_phi(got);
            assert!((back - y).abs() <= 8.0 * f64::EPSILON * y.abs().max(1.0), "y = {y}: back to {back}");
        }
    }

    #[test]
    fn half_turns_follow_the_sign_of_the_sine() {
        use std::f64::consts::PI;
        for j in -5_i32..=5 {
            let border = f64::from(j) * PI;
            for y in [border - 1e-9, border + 1e-9, border + 1.0, border] {
                let split = FromEquator::of_y(y);
                assert!(split.cosine >= 0.0, "{y}: {split:?}");
                assert!((split.y() - y).abs() <= 4.0 * f64::EPSILON * (1.0 + y.abs()), "{y}: {split:?}");
            }
        }
    }

    #[test]
    fn mu_lies_between_its_bounds_and_is_even_and_periodic() {
        let width = metric().half_width();
        assert_eq!(metric().mu(0.0), 1.0 / 1.5);
        assert!((metric().mu(width) - 0.5).abs() <= f64::EPSILON);
        for i in 0..50 {
            let phi = f64::from(i) * 0.061;
            let mu = metric().mu(phi);
            assert!((0.5..=1.0 / 1.5).contains(&mu));
            assert_eq!(mu, metric().mu(-phi));
            assert!((metric().mu(phi + 2.0 * width) - mu).abs() <= 8.0 * f64::EPSILON);
            assert!((metric().potential(phi, 0.7) * mu - 0.49).abs() <= 2.0 * f64::EPSILON);
        }
    }

    const PHI_OF_Y: [(f64, f64); 10] = [
        (0.0, -1.5497599827738209454),
        (0.1, -1.4380724882817391456),
        (1.0, -0.51095824107037905312),
        (std::f64::consts::FRAC_PI_2, -5.3704314800543544261e-17),
        (2.5, 0.85817785018621469215),
        (std::f64::consts::PI, 1.5497599827738208085),
        (3.2, 1.615038214033536878),
        (-0.3, -1.8821556846521873934),
        (-7.5, -8.9856131092154610943),
        (25.0, 23.098260644239096847),
    ];
}
