//! Sample points of the spin problem, for the statements of sections 4 and 5.
//!
//! The samples cover k from 0.05 to 20, with points beside the equator, beside the poles and beside
//! k = 1 among them. Not known here: what is claimed.

use super::differences::{Wide, wide};
use super::statement::{Samples, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// How many points a check sees.
pub const POINTS: usize = 100;
/// What an algebraic identity may leave, relative: 32 digits, and up to ten of them cancel beside the equator and the poles.
pub const ALGEBRA: f64 = 1e-20;
/// What an identity with a difference quotient may leave, relative.
pub const QUOTIENT: f64 = 1e-14;

/// The difference of two sides, relative to the larger.
pub fn gap(left: Wide, right: Wide) -> f64 {
    let scale = left.abs().max(right.abs());
    if scale == Wide::ZERO { 0.0 } else { ((left - right) / scale).to_f64() }
}

/// A covector of the sphere in the chart of Lemma 4.1, and the anisotropy.
#[derive(Clone, Copy, Debug)]
pub struct ChartPoint {
    /// `k`.
    pub k: Wide,
    /// θ.
    pub theta: Wide,
    /// φ, from the pole.
    pub phi: Wide,
    /// `p_θ`.
    pub p_theta: Wide,
    /// `p_φ`.
    pub p_phi: Wide,
}

impl ChartPoint {
    /// `r = (sin φ cos θ, cos φ, sin φ sin θ)`.
    pub fn position(&self) -> [Wide; 3] {
        let ((st, ct), (sp, cp)) = (self.theta.sin_cos(), self.phi.sin_cos());
        [sp * ct, cp, sp * st]
    }

    /// `h = r × p` for the covector `p` of R³ that is tangent to the sphere and restricts to `(p_θ, p_φ)`.
    pub fn momentum(&self) -> [Wide; 3] {
        let ((st, ct), (sp, cp)) = (self.theta.sin_cos(), self.phi.sin_cos());
        let along = self.p_theta / sp;
        // ∂r/∂φ = (cos φ cos θ, −sin φ, cos φ sin θ), ∂r/∂θ = sin φ (−sin θ, 0, cos θ).
        let p = [self.p_phi * cp * ct - along * st, -(self.p_phi * sp), self.p_phi * cp * st + along * ct];
        cross(self.position(), p)
    }
}

/// The vector product.
pub fn cross(a: [Wide; 3], b: [Wide; 3]) -> [Wide; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The scalar product.
pub fn dot<const N: usize>(a: [Wide; N], b: [Wide; N]) -> Wide {
    a.iter().zip(b).fold(Wide::ZERO, |sum, (a, b)| sum + *a * b)
}

/// Values of k from 0.05 to 20, evenly in the logarithm, every fifth one beside 1.
pub fn anisotropy(samples: &mut Samples, index: usize) -> f64 {
    if index % 5 == 4 { 1.0 + samples.sign() * samples.log(1e-9, 1e-2) } else { samples.log(0.05, 20.0) }
}

/// Covectors over the whole sphere without equator and poles, every fourth one beside the equator, every fourth beside a pole.
pub fn chart_points(seed: u64) -> Vec<ChartPoint> {
    let mut samples = Samples::new(seed);
    let half = std::f64::consts::FRAC_PI_2;
    let point = |index: usize| {
        let k = wide(anisotropy(&mut samples, index));
        let phi = match index % 4 {
            2 => half + samples.sign() * samples.log(1e-4, 0.3),
            3 => half + samples.sign() * (half - samples.log(1e-4, 0.3)),
            _ => samples.even(0.1, 1.5) + if samples.sign() > 0.0 { half } else { 0.0 },
        };
        ChartPoint {
            k,
            theta: wide(samples.even(-3.0, 3.0)),
            phi: wide(phi),
            p_theta: wide(samples.sign() * samples.log(0.05, 20.0)),
            p_phi: wide(samples.sign() * samples.log(0.05, 20.0)),
        }
    };
    (0..POINTS).map(point).collect()
}

/// Compares two sides at every sample point.
pub fn at_chart_points(seed: u64, tolerance: f64, sides: impl Fn(&ChartPoint) -> (Wide, Wide)) -> Test {
    let mut worst = Worst::default();
    for point in chart_points(seed) {
        let (left, right) = sides(&point);
        worst.see(gap(left, right));
    }
    worst.at_most(tolerance, reason(tolerance))
}

/// Why this tolerance.
pub fn reason(tolerance: f64) -> &'static str {
    if tolerance <= ALGEBRA {
        "double-double, what cancels beside equator and poles left out"
    } else {
        "difference quotients in double-double"
    }
}
