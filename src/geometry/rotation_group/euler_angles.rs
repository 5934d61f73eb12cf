//! Euler angles on SO(3) and their momenta: a chart for posing problems and reading results, never for integrating.
//!
//! `R = exp(Φ1 A3) exp(Φ2 A2) exp(Φ3 A3)` (section 2.3), so R takes body components to space components. With
//! `R' = R Ω^` the momenta are `p1 = M·Rᵀe3`, `p2 = M·exp(−Φ3 A3) e2`, `p3 = M3`, which solved for M gives
//! `M1 = p2 sin Φ3 − q cos Φ3`, `M2 = p2 cos Φ3 + q sin Φ3`, `M3 = p3`, `q = (p1 − p3 cos Φ2)/sin Φ2`.
//! The article's (4) is the special case of a momentum along e3 (p2 = 0, p1 = |M|).
//!
//! The chart fails at sin Φ2 = 0, where only Φ1 ± Φ3 is defined: refused with data. A momentum alone may have a limit there
//! ([`EulerPoint::body_momentum_to_the_poles`]).
//!
//! As unit quaternion `(w, x, y, z)`, with σ = (Φ1+Φ3)/2 and δ = (Φ1−Φ3)/2:
//! `w = cos(Φ2/2) cos σ`, `z = cos(Φ2/2) sin σ`, `y = sin(Φ2/2) cos δ`, `x = −sin(Φ2/2) sin δ`.
//!
//! Units: radians. Not known here: the metric.

use crate::numerics::real::Real;

/// Why a chart can't be used at a point.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChartError {
    /// Euler angles have a pole here.
    #[error("Euler angles are not defined at sin Φ2 = 0 (Φ2 = {phi2}, sin Φ2 = {sine}){}", .time.map(|t| format!(", reached at t = {t}")).unwrap_or_default())]
    Pole {
        /// Φ2 there.
        phi2: f64,
        /// Its sine.
        sine: f64,
        /// When, if along a trajectory.
        time: Option<f64>,
    },
    /// Serret-Andoyer variables need |L| < G and |K| < G.
    #[error("Serret-Andoyer variables are not defined at |{name}| ≥ G ({name} = {value}, G = {g})")]
    Aligned {
        /// `K` or `L`.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The size of the momentum.
        g: f64,
    },
    /// Momenta that no body momentum has at this Φ2.
    #[error("at Φ2 = {phi2}, p1 = {p1} and p3 = {p3} belong to no finite momentum (at a pole p1 = p3 cos Φ2)")]
    Impossible {
        /// Φ2.
        phi2: f64,
        /// p1.
        p1: f64,
        /// p3.
        p3: f64,
    },
    /// An angle so large that its digits do not say where it is.
    #[error("{name} = {value} is beyond {largest:e}: take whole turns away", largest = LARGEST_ANGLE)]
    Far {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A coordinate that is not finite.
    #[error("{name} = {value} must be finite")]
    NotFinite {
        /// Which.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Closer to a pole than this (in sin Φ2) the chart is refused: the momenta would lose half of their digits.
pub const SMALLEST_SINE: f64 = 1e-8;

/// Angles beyond this are refused where digits matter: neighbouring numbers are more than 1e-4 apart.
pub const LARGEST_ANGLE: f64 = 1e12;

/// A point of T*SO(3) in Euler angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerPoint<S> {
    /// Φ1, Φ2, Φ3.
    pub angles: [S; 3],
    /// p1, p2, p3.
    pub momenta: [S; 3],
}

/// Sine and cosine of Φ2, refused near the pole.
pub(super) fn away_from_poles<S: Real>(angles: &[S; 3]) -> Result<(S, S), ChartError> {
    for (name, value) in ["Phi1", "Phi2", "Phi3"].into_iter().zip(angles) {
        if !value.is_finite() {
            return Err(ChartError::NotFinite { name, value: value.to_f64() });
        }
    }
    let (sine, cosine) = angles[1].sin_cos();
    if sine.abs().to_f64() < SMALLEST_SINE {
        return Err(ChartError::Pole { phi2: angles[1].to_f64(), sine: sine.to_f64(), time: None });
    }
    Ok((sine, cosine))
}

impl<S: Real> EulerPoint<S> {
    /// The angular momentum in the body frame.
    ///
    /// # Errors
    /// [`ChartError::Pole`] near sin Φ2 = 0.
    pub fn body_momentum(&self) -> Result<[S; 3], ChartError> {
        let (sine, cosine) = away_from_poles(&self.angles)?;
        let [p1, p2, p3] = self.momenta;
        let (s3, c3) = self.angles[2].sin_cos();
        let q = (p1 - p3 * cosine) / sine;
        Ok([p2 * s3 - q * c3, p2 * c3 + q * s3, p3])
    }

    /// The angular momentum in the body frame up to the poles: `q = (p1 ∓ p3)/sin Φ2 ± p3 tan^±1(Φ2/2)`, which does not cancel for
    /// p1 = ±p3. At Φ2 = 0 itself it is the limit for fixed momenta, q = 0, which exists for p1 = p3 alone (no `f64` but 0 is a pole).
    ///
    /// # Errors
    /// [`ChartError::Impossible`] where that is no finite number; [`ChartError::Far`].
    pub fn body_momentum_to_the_poles(&self) -> Result<[S; 3], ChartError> {
        for (name, value) in ["Phi1", "Phi2", "Phi3"].into_iter().zip(&self.angles) {
            let value = value.to_f64();
            if !value.is_finite() {
                return Err(ChartError::NotFinite { name, value });
            }
            if value.abs() > LARGEST_ANGLE {
                return Err(ChartError::Far { name, value });
            }
        }
        let half = S::from_f64(0.5);
        let (sine, cosine) = self.angles[1].sin_cos();
        let (half_sine, half_cosine) = (self.angles[1] * half).sin_cos();
        let [p1, p2, p3] = self.momenta;
        let (excess, rest) = if cosine >= S::ZERO {
            (p1 - p3, p3 * half_sine / half_cosine)
        } else {
            (p1 + p3, -(p3 * half_cosine / half_sine))
        };
        let q = if excess == S::ZERO { rest } else { excess / sine + rest };
        if !q.is_finite() {
            let [phi2, p1, p3] = [self.angles[1], p1, p3].map(S::to_f64);
            return Err(ChartError::Impossible { phi2, p1, p3 });
        }
        let (s3, c3) = self.angles[2].sin_cos();
        Ok([p2 * s3 - q * c3, p2 * c3 + q * s3, p3])
    }

    /// The point with these angles and this body momentum: the inverse of [`EulerPoint::body_momentum`].
    ///
    /// # Errors
    /// [`ChartError::Pole`] near sin Φ2 = 0.
    pub fn from_body_momentum(angles: [S; 3], body_momentum: [S; 3]) -> Result<Self, ChartError> {
        let (sine, cosine) = away_from_poles(&angles)?;
        let [m1, m2, m3] = body_momentum;
        let (s3, c3) = angles[2].sin_cos();
        let momenta = [sine * (m2 * s3 - m1 * c3) + m3 * cosine, m1 * s3 + m2 * c3, m3];
        Ok(EulerPoint { angles, momenta })
    }

    /// The attitude as unit quaternion `(w, x, y, z)`. Defined at the poles too.
    pub fn attitude(&self) -> [S; 4] {
        quaternion(&self.angles)
    }
}

/// The unit quaternion of Euler angles.
pub fn quaternion<S: Real>(angles: &[S; 3]) -> [S; 4] {
    let half = S::from_f64(0.5);
    let (sum_sine, sum_cosine) = ((angles[0] + angles[2]) * half).sin_cos();
    let (difference_sine, difference_cosine) = ((angles[0] - angles[2]) * half).sin_cos();
    let (s, c) = (angles[1] * half).sin_cos();
    [c * sum_cosine, -(s * difference_sine), s * difference_cosine, c * sum_sine]
}

/// The Euler angles of a unit quaternion on the branch closest to `near` (in Φ1 + Φ3 and Φ1 − Φ3), Φ2 in [0, π] if
/// `near[1]` is, else continued to the sheet of `near`.
///
/// q and −q, and the two sheets `(Φ1, Φ2, Φ3) ~ (Φ1+π, −Φ2, Φ3−π)`, are one attitude: of all representatives the one on
/// Φ2's side of `near` is taken. Guarantee: `quaternion` of the result is ±q to a few ε. Errors: at a pole.
///
/// # Errors
/// [`ChartError::Pole`] near sin Φ2 = 0.
pub fn angles_near<S: Real>(q: &[S; 4], near: &[S; 3]) -> Result<[S; 3], ChartError> {
    let two = S::from_f64(2.0);
    let [w, x, y, z] = *q;
    let (c, s) = ((w * w + z * z).sqrt(), (x * x + y * y).sqrt());
    let phi2 = two * s.atan2(c);
    let sine = two * s * c;
    if sine.to_f64() < SMALLEST_SINE {
        return Err(ChartError::Pole { phi2: phi2.to_f64(), sine: sine.to_f64(), time: None });
    }
    // On the sheet Φ2 < 0 the half sine is negative: δ turns by π.
    let (phi2, delta) = if near[1] < S::ZERO { (-phi2, x.atan2(-y)) } else { (phi2, (-x).atan2(y)) };
    let sigma = z.atan2(w);
    // σ and δ are each known mod 2π for q, and turn by π together for −q.
    let half = S::from_f64(0.5);
    let (near_sigma, near_delta) = ((near[0] + near[2]) * half, (near[0] - near[2]) * half);
    let nearest = |angle: S, to: S, turn: S| angle + turn * ((to - angle) / turn + half).floor();
    let full = two * S::PI;
    let plain = (nearest(sigma, near_sigma, full), nearest(delta, near_delta, full));
    let turned = (nearest(sigma + S::PI, near_sigma, full), nearest(delta + S::PI, near_delta, full));
    let distance = |(a, b): (S, S)| (a - near_sigma).abs() + (b - near_delta).abs();
    let (sigma, delta) = if distance(plain) <= distance(turned) { plain } else { turned };
    Ok([sigma + delta, phi2, sigma - delta])
}

/// The rotation matrix of a unit quaternion: rows are space components of body vectors.
pub fn rotation_matrix<S: Real>(q: &[S; 4]) -> [[S; 3]; 3] {
    let [w, x, y, z] = *q;
    let two = S::from_f64(2.0);
    [
        [w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y)],
        [two * (x * y + w * z), w * w - x * x + y * y - z * z, two * (y * z - w * x)],
        [two * (x * z - w * y), two * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 3]; 5] =
        [[0.3, 1.2, -2.0], [2.9, 2.8506, -0.32175], [-1.0, -0.7, 4.0], [0.0, 0.1, 0.0], [7.0, 3.0, -9.0]];

    /// exp(a A3), exp(a A2) of section 2.1, multiplied out.
    fn product_of_exponentials([a, b, c]: [f64; 3]) -> [[f64; 3]; 3] {
        let about_3 = |a: f64| [[libm::cos(a), -libm::sin(a), 0.0], [libm::sin(a), libm::cos(a), 0.0], [0.0, 0.0, 1.0]];
        let about_2 = |b: f64| [[libm::cos(b), 0.0, libm::sin(b)], [0.0, 1.0, 0.0], [-libm::sin(b), 0.0, libm::cos(b)]];
        let times = |p: [[f64; 3]; 3], q: [[f64; 3]; 3]| {
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| p[i][k] * q[k][j]).sum::<f64>()))
        };
        times(times(about_3(a), about_2(b)), about_3(c))
    }

    #[test]
    fn the_quaternion_is_the_article_decomposition() {
        for angles in POINTS {
            let (matrix, expected) = (rotation_matrix(&quaternion(&angles)), product_of_exponentials(angles));
            for i in 0..3 {
                for j in 0..3 {
                    assert!((matrix[i][j] - expected[i][j]).abs() < 8.0 * f64::EPSILON, "{angles:?} {i} {j}");
                }
            }
        }
    }

    #[test]
    fn momenta_are_the_derivatives_of_the_kinetic_energy() {
        // p_i = ∂/∂Φi' of ½ Ω·IΩ with Ω = vee(Rᵀ R'): since Ω is linear in Φ', p_i = M·∂Ω/∂Φi', and Ω for Φi' = 1 alone is
        // the derivative of R by Φi: central differences, δ = 1e-6, error δ²/6 + ε/δ ~ 1e-10.
        for angles in POINTS {
            let m = [0.7, -1.1, 0.4];
            let point = EulerPoint::from_body_momentum(angles, m).unwrap();
            let r = product_of_exponentials(angles);
            for i in 0..3 {
                let (mut plus, mut minus) = (angles, angles);
                plus[i] += 1e-6;
                minus[i] -= 1e-6;
                let (plus, minus) = (product_of_exponentials(plus), product_of_exponentials(minus));
                let entry =
                    |a: usize, b: usize| -> f64 { (0..3).map(|k| r[k][a] * (plus[k][b] - minus[k][b]) / 2e-6).sum() };
                let omega = [entry(2, 1), entry(0, 2), entry(1, 0)];
                let p: f64 = (0..3).map(|k| m[k] * omega[k]).sum();
                assert!((p - point.momenta[i]).abs() < 1e-9, "{angles:?} p{}", i + 1);
            }
            let back = point.body_momentum().unwrap();
            // q is divided by sin Φ2 ≥ 0.1.
            assert!((0..3).all(|i| (back[i] - m[i]).abs() < 100.0 * f64::EPSILON), "{back:?}");
        }
    }

    #[test]
    fn the_article_case_has_its_momentum() {
        // Case 1 of section 5.3: M0 of reference/rotation_group_conjugate_times.json.
        let point = EulerPoint { angles: [0.0, 2.8506, -0.32175], momenta: [0.0, 0.0, 0.3155946] };
        let m = point.body_momentum().unwrap();
        let expected = [-0.9996835479934538695850229, -0.3332272335299292407786545, 0.3155946];
        assert!((0..3).all(|i| (m[i] - expected[i]).abs() < 16.0 * f64::EPSILON), "{m:?}");
    }

    #[test]
    fn angles_come_back_on_the_branch_asked_for() {
        for angles in POINTS {
            let q = quaternion(&angles);
            let shifted = angles.map(|a| a + 0.3);
            let near = [shifted[0], angles[1], shifted[2] - 0.5];
            for sign in [1.0, -1.0] {
                let found = angles_near(&q.map(|c| sign * c), &near).unwrap();
                assert!((0..3).all(|i| (found[i] - angles[i]).abs() < 60.0 * f64::EPSILON), "{angles:?} {found:?}");
            }
        }
    }

    #[test]
    fn poles_are_refused_with_data() {
        let pole = EulerPoint { angles: [0.1, 0.0, 0.2], momenta: [1.0, 0.0, 1.0] };
        assert_eq!(pole.body_momentum(), Err(ChartError::Pole { phi2: 0.0, sine: 0.0, time: None }));
        assert!(matches!(angles_near(&quaternion(&[0.1, 0.0, 0.2]), &[0.0; 3]), Err(ChartError::Pole { .. })));
        let wrong = EulerPoint { angles: [f64::NAN, 1.0, 0.2], momenta: [1.0, 0.0, 1.0] };
        assert!(matches!(wrong.body_momentum(), Err(ChartError::NotFinite { name: "Phi1", .. })));
    }
}
