//! The Serret-Andoyer transformation (section 2.4) between Euler angles with momenta and `(g, k, l, G, K, L)`.
//!
//! G = |M|, K = p1 (the momentum along e3), L = p3 = M3; l is the angle of M in the body: `M1 = √(G²−L²) sin l`,
//! `M2 = √(G²−L²) cos l`; k that of the plane across the momentum in space, g between the two nodes in that plane.
//! On the reduced problem `x = g`, `y = l`, `p_x = G`, `p_y = L`.
//!
//! The printed inverse is right in substance (checked here by G and the canonical equations `k' = 0`, `g' = ∂H/∂G`), with
//! one slip: its arctangents must be taken in the quadrant of numerator and denominator, `atan2`. With the principal
//! value l is off by π wherever `p2 sin Φ2 < 0`, and also at g = 0, where the article's own example lies: then M1 and M2
//! change sign, and (x, y) goes to (x, y ± π), which (9) does not notice.
//!
//! Source: section 2.4; A. Deprit (1967) for the geometry. Units: radians. Domain: |L| < G, |K| < G (and sin Φ2 ≠ 0).
//! Not known here: the flow.

use crate::geometry::rotation_group::euler_angles::{ChartError, EulerPoint, away_from_poles};
use crate::numerics::real::Real;

/// The Serret-Andoyer variables of a point of T*SO(3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SerretAndoyerVariables<S> {
    /// Angle from the node with the space's plane to the node with the body's, in the plane across the momentum.
    pub g: S,
    /// Angle in space.
    pub k: S,
    /// Angle in the body.
    pub l: S,
    /// The size of the momentum, conjugate to `g`.
    pub momentum_g: S,
    /// The momentum along e3, conjugate to `k`.
    pub momentum_k: S,
    /// The momentum along E3, conjugate to `l`.
    pub momentum_l: S,
}

fn across<S: Real>(name: &'static str, value: S, g: S) -> Result<S, ChartError> {
    // (G − v)(G + v): exact near |v| = G.
    let square = (g - value) * (g + value);
    if square > S::ZERO {
        Ok(square.sqrt())
    } else {
        Err(ChartError::Aligned { name, value: value.to_f64(), g: g.to_f64() })
    }
}

impl<S: Real> SerretAndoyerVariables<S> {
    /// The variables of a point given in Euler angles.
    ///
    /// # Errors
    /// [`ChartError`] at sin Φ2 = 0, |K| = G or |L| = G.
    pub fn from_euler(point: &EulerPoint<S>) -> Result<Self, ChartError> {
        let (sine, cosine) = away_from_poles(&point.angles)?;
        let [p1, p2, p3] = point.momenta;
        let q = (p1 - p3 * cosine) / sine;
        let momentum_g = (p2 * p2 + q * q + p3 * p3).sqrt();
        across("L", p3, momentum_g)?;
        across("K", p1, momentum_g)?;
        // √(G²−L²) √(G²−K²) (sin g, cos g).
        let sine_part = -(p2 * sine * momentum_g);
        let cosine_part = p1 * p3 - momentum_g * momentum_g * cosine;
        let lean = p2 * sine;
        Ok(SerretAndoyerVariables {
            g: sine_part.atan2(cosine_part),
            k: point.angles[0] - (p3 - p1 * cosine).atan2(lean),
            l: point.angles[2] - (p1 - p3 * cosine).atan2(lean),
            momentum_g,
            momentum_k: p1,
            momentum_l: p3,
        })
    }

    /// The point in Euler angles, Φ2 in (0, π).
    ///
    /// # Errors
    /// [`ChartError`] at |K| = G, |L| = G, or where sin Φ2 = 0 comes out.
    pub fn to_euler(&self) -> Result<EulerPoint<S>, ChartError> {
        let (big_g, big_k, big_l) = (self.momentum_g, self.momentum_k, self.momentum_l);
        let (across_l, across_k) = (across("L", big_l, big_g)?, across("K", big_k, big_g)?);
        let (sine_g, cosine_g) = self.g.sin_cos();
        let cosine = (big_k * big_l - across_l * across_k * cosine_g) / (big_g * big_g);
        let lean = -(across_l * across_k * sine_g) / big_g;
        // G² sin²Φ2 = (p2 sin Φ2)² + (K² − 2KL cos Φ2 + L² cos²Φ2) + L² sin²Φ2, without the cancellation of 1 − cos².
        let over = big_k - big_l * cosine;
        let square = lean * lean + over * over;
        let sine = (square / ((big_g - big_l) * (big_g + big_l))).sqrt();
        let phi2 = sine.atan2(cosine);
        let angles = [self.k + (big_l - big_k * cosine).atan2(lean), phi2, self.l + over.atan2(lean)];
        away_from_poles(&angles)?;
        Ok(EulerPoint { angles, momenta: [big_k, lean / sine, big_l] })
    }

    /// The angular momentum in the body frame: `(√(G²−L²) sin l, √(G²−L²) cos l, L)`.
    ///
    /// # Errors
    /// [`ChartError::Aligned`] at |L| > G.
    pub fn body_momentum(&self) -> Result<[S; 3], ChartError> {
        let across_l = across("L", self.momentum_l, self.momentum_g)?;
        let (sine, cosine) = self.l.sin_cos();
        Ok([across_l * sine, across_l * cosine, self.momentum_l])
    }

    /// What the point projects to: `(x, y, p_x, p_y) = (g, l, G, L)`.
    pub fn reduced(&self) -> [S; 4] {
        [self.g, self.l, self.momentum_g, self.momentum_l]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_group::attitude_trajectory::attitude_at;
    use crate::geometry::rotation_group::euler_angles::angles_near;
    use crate::geometry::rotation_group::metric::Metric;

    const POINTS: [([f64; 3], [f64; 3]); 5] = [
        ([0.3, 1.2, -2.0], [0.4, -0.9, 0.2]),
        ([2.9, 2.1, -0.3], [-0.4, 0.8, 0.5]),
        ([-1.0, 0.7, 1.0], [0.1, -0.2, -0.9]),
        ([0.5, 1.5, 0.0], [0.8, 0.3, 0.7]),
        ([-0.4, 2.6, 2.2], [-0.6, -1.3, -0.1]),
    ];

    #[test]
    fn there_and_back() {
        for (angles, momenta) in POINTS {
            let point = EulerPoint { angles, momenta };
            let variables = SerretAndoyerVariables::from_euler(&point).unwrap();
            let back = variables.to_euler().unwrap();
            for i in 0..3 {
                // Angles mod 2π; sin Φ2 ≥ 0.5 and the tilts ≥ 0.2: some tens of ε.
                let turn = (back.angles[i] - angles[i]) / (2.0 * std::f64::consts::PI);
                assert!((turn - turn.round()).abs() < 50.0 * f64::EPSILON, "{point:?} {back:?}");
                assert!((back.momenta[i] - momenta[i]).abs() < 100.0 * f64::EPSILON, "{point:?} {back:?}");
            }
            // The same body momentum by both charts, and its size.
            let (m, n) = (point.body_momentum().unwrap(), variables.body_momentum().unwrap());
            assert!((0..3).all(|i| (m[i] - n[i]).abs() < 30.0 * f64::EPSILON), "{m:?} {n:?}");
        }
    }

    #[test]
    fn the_transformation_is_canonical_along_the_flow() {
        // Along the motion G, K, k are constant and g' = G (A sin²l + B cos²l): x' of (9), with g = x. Oracle: attitude
        // integrated as quaternion at t = ±1e-4; differences are exact to (1e-4)²: 1e-7 with the constants met here.
        let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
        for (angles, momenta) in POINTS {
            let start = EulerPoint { angles, momenta };
            let at = |t: f64| {
                let m0 = start.body_momentum().unwrap();
                let (states, _) = attitude_at(&metric, start.attitude(), m0, &[t], f64::EPSILON).unwrap();
                let angles = angles_near(&states[0].quaternion, &angles).unwrap();
                let point = EulerPoint::from_body_momentum(angles, states[0].body_momentum).unwrap();
                SerretAndoyerVariables::from_euler(&point).unwrap()
            };
            let (before, now, after) = (at(-1e-4), at(0.0), at(1e-4));
            assert!((after.momentum_g - before.momentum_g).abs() < 1e-14 && (after.k - before.k).abs() < 1e-13);
            assert!((after.momentum_k - before.momentum_k).abs() < 1e-14);
            let (sine, cosine) = libm::sincos(now.l);
            let nu = 1.5 * sine * sine + 2.0 * cosine * cosine;
            assert!(((after.g - before.g) / 2e-4 - now.momentum_g * nu).abs() < 1e-6, "{now:?}");
            let l_rate = now.momentum_l * (2.8 - nu);
            assert!(((after.l - before.l) / 2e-4 - l_rate).abs() < 1e-6, "{now:?}");
        }
    }

    #[test]
    fn the_article_cases_project_to_one_curve() {
        // Section 5.3: both project on p_x = 1.1, p_y = 0.3155946, x = 0, y = arccos √0.1 (as printed with 4 to 7 digits);
        // with the right quadrant y − π for g = 0 (module page).
        for (angles, momenta) in
            [([0.0, 2.8506, -0.32175], [0.0, 0.0, 0.3155946]), ([0.0, 2.327, -0.32175], [0.55, 0.0, 0.3155946])]
        {
            let variables = SerretAndoyerVariables::from_euler(&EulerPoint { angles, momenta }).unwrap();
            let [x, y, p_x, p_y] = variables.reduced();
            assert!(x.abs() < 1e-12 && (p_x - 1.1).abs() < 2e-4 && p_y == 0.3155946, "{variables:?}");
            let y0 = libm::acos(0.1_f64.sqrt());
            assert!((y - (y0 - std::f64::consts::PI)).abs() < 1e-5, "{variables:?}");
        }
    }

    #[test]
    fn aligned_momenta_are_refused_with_data() {
        // p1 = p3 cos Φ2, p2 = 0: M along E3.
        let point = EulerPoint { angles: [0.0, 1.0, 0.0], momenta: [libm::cos(1.0), 0.0, 1.0] };
        let refused = SerretAndoyerVariables::from_euler(&point);
        assert!(matches!(refused, Err(ChartError::Aligned { name: "L", .. })), "{refused:?}");
    }
}
