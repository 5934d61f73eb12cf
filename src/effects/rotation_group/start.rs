//! The body and the starts that nodes on SO(3) read: Euler angles with momenta, a point of a reduced energy level, and a point of the
//! reduced problem with its momenta.
//!
//! Momenta in the body are computed in double-double and rounded once: near a pole of Euler angles (sin Φ2 = 0.29 in section 5.3) f64
//! would magnify rounding tenfold. Angles in radians, time as in (2) and (9).

use crate::contract::accuracy::{ARTICLE, Accuracy, Arithmetic};
use crate::contract::node::NodeError;
use crate::effects::arithmetic::{ROUNDED_TWICE, long_tolerance};
use crate::effects::product::failed;
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::metric::Metric;
use crate::geometry::serret_andoyer;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use serde::Serialize;

/// The relative difference of two routes that is allowed at full accuracy.
pub const ALLOWED: f64 = 1e-12;

/// Inverse moments of inertia.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Body {
    /// Inverse of the largest moment of inertia.
    #[serde(rename = "A")]
    pub a: f64,
    /// Inverse of the middle moment of inertia.
    #[serde(rename = "B")]
    pub b: f64,
    /// Inverse of the smallest moment of inertia.
    #[serde(rename = "C")]
    pub c: f64,
}

impl Body {
    /// The metric on SO(3).
    ///
    /// # Errors
    /// A, B, C not positive.
    pub fn metric<S: Real>(&self) -> Result<Metric<S>, NodeError> {
        Metric::new(S::from_f64(self.a), S::from_f64(self.b), S::from_f64(self.c)).map_err(failed("metric"))
    }

    /// The Serret-Andoyer metric that it reduces to.
    ///
    /// # Errors
    /// Not `0 < A < B < C`.
    pub fn reduced<S: Real>(&self) -> Result<serret_andoyer::Metric<S>, NodeError> {
        serret_andoyer::Metric::new(S::from_f64(self.a), S::from_f64(self.b), S::from_f64(self.c))
            .map_err(failed("reduced metric"))
    }

    /// Energy and size of a body momentum.
    pub fn energy_and_size(&self, momentum: &[f64; 3]) -> (f64, f64) {
        let [x, y, z] = momentum.map(|m| m * m);
        (0.5 * (self.a * x + self.b * y + self.c * z), (x + y + z).sqrt())
    }
}

/// Euler angles with their momenta.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EulerStart {
    /// Φ1, Φ2, Φ3.
    #[serde(rename = "Phi")]
    pub phi: [f64; 3],
    /// p1, p2, p3.
    pub p: [f64; 3],
}

impl EulerStart {
    /// The point of T*SO(3).
    pub fn point<S: Real>(&self) -> EulerPoint<S> {
        EulerPoint { angles: self.phi.map(S::from_f64), momenta: self.p.map(S::from_f64) }
    }
}

/// A point of the reduced problem with its momenta: x = 0, y in (0, π/2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReducedStart {
    /// cos²y.
    pub cosine_squared: f64,
    /// p_x, the size G of the momentum.
    pub p_x: f64,
    /// p_y, the momentum about the third axis of the body.
    pub p_y: f64,
}

impl ReducedStart {
    /// y, rounded once.
    pub fn y0(&self) -> f64 {
        self.long_y0().to_f64()
    }

    /// y, not rounded.
    pub fn long_y0(&self) -> DoubleDouble {
        let cosine_squared = <DoubleDouble as Real>::from_f64(self.cosine_squared);
        (DoubleDouble::ONE - cosine_squared).sqrt().atan2(cosine_squared.sqrt())
    }
}

impl std::fmt::Display for ReducedStart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { cosine_squared, p_x, p_y } = self;
        write!(f, "cos² y = {cosine_squared:?}, p_x = {p_x:?}, p_y = {p_y:?}")
    }
}

/// A point of the reduced problem on an energy level, with p_y > 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelStart {
    /// cos²y; y in (0, π/2).
    pub cosine_squared: f64,
    /// p_x, the size G of the momentum.
    pub p_x: f64,
    /// The energy.
    pub h: f64,
}

/// How a momentum in the body is given. Conjugate times on SO(3) depend on nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentumStart {
    /// By Euler angles and their momenta.
    Euler(EulerStart),
    /// By a point of a reduced energy level: `(√(G²−L²) sin l, √(G²−L²) cos l, L)`, L from the energy.
    Level(LevelStart),
}

impl MomentumStart {
    /// The angular momentum in the body, to half a unit in the last place of each component.
    ///
    /// # Errors
    /// Euler angles at a pole; a level that the point is not on for any p_y.
    pub fn body_momentum(&self, body: &Body) -> Result<[f64; 3], NodeError> {
        Ok(self.long_body_momentum(body)?.map(Real::to_f64))
    }

    /// The same, not rounded.
    ///
    /// # Errors
    /// As [`MomentumStart::body_momentum`].
    pub fn long_body_momentum(&self, body: &Body) -> Result<[DoubleDouble; 3], NodeError> {
        match self {
            Self::Euler(start) => start.point::<DoubleDouble>().body_momentum().map_err(failed(&self.to_string())),
            Self::Level(level) => level.body_momentum(body),
        }
    }
}

impl LevelStart {
    fn body_momentum(&self, body: &Body) -> Result<[DoubleDouble; 3], NodeError> {
        let number = <DoubleDouble as Real>::from_f64;
        let (cosine_squared, p_x) = (number(self.cosine_squared), number(self.p_x));
        let sine_squared = DoubleDouble::ONE - cosine_squared;
        let z = number(body.a) * sine_squared + number(body.b) * cosine_squared;
        // 2h = G² Z + L² (C − Z).
        let square = (number(2.0 * self.h) - p_x * p_x * z) / (number(body.c) - z);
        let across = p_x * p_x - square;
        if square < DoubleDouble::ZERO || across < DoubleDouble::ZERO {
            let (Self { cosine_squared, p_x, h }, l) = (self, square.to_f64());
            let start = format!("cos² y = {cosine_squared:?}, p_x = {p_x:?}, h = {h:?}");
            return Err(NodeError::new(format!("{start}: p_y² = {l:?} is not between 0 and p_x²")));
        }
        let across = across.sqrt();
        Ok([across * sine_squared.sqrt(), across * cosine_squared.sqrt(), square.sqrt()])
    }
}

impl std::fmt::Display for MomentumStart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Euler(EulerStart { phi, p }) => write!(f, "Phi = {phi:?}, p = {p:?}"),
            Self::Level(LevelStart { cosine_squared, p_x, h }) => {
                write!(f, "cos² y = {cosine_squared:?}, p_x = {p_x:?}, h = {h:?}")
            }
        }
    }
}

/// The relative error per step of an integration at an accuracy: full accuracy for `article`, a tenth of what is asked above, less than the ε of
/// f64 below, which takes double-double.
pub fn tolerance(accuracy: Accuracy) -> f64 {
    let asked = accuracy.relative_error();
    long_tolerance(accuracy).unwrap_or(if asked <= ARTICLE { f64::EPSILON } else { asked / 10.0 })
}

/// The relative difference of two routes that is allowed at an accuracy.
pub fn allowed(accuracy: Accuracy) -> f64 {
    let asked = accuracy.relative_error();
    match accuracy.arithmetic() {
        // Second routes start from rounded numbers of the first: a condition of 4 is that of the article's starts.
        Arithmetic::DoubleDouble => (4.0 * ROUNDED_TWICE).max(100.0 * asked),
        Arithmetic::F64 if asked <= ARTICLE => ALLOWED,
        Arithmetic::F64 => asked.max(ALLOWED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: Body = Body { a: 1.5, b: 2.0, c: 2.8 };

    /// Oracle: mpmath 1.3, 40 digits, section 5.3's case 1 with its decimals, and L on the level h = 1 of its curve.
    #[test]
    fn body_momenta_of_both_kinds_of_start() {
        let euler = EulerStart { phi: [0.0, 2.8506, -0.32175], p: [0.0, 0.0, 0.3155946] };
        let momentum = MomentumStart::Euler(euler).body_momentum(&BODY).unwrap();
        let exact = [-0.999_683_547_993_453_87, -0.333_227_233_529_929_24, 0.315_594_6];
        for i in 0..3 {
            // The inputs are the nearest f64 to those decimals: half an ε of Φ2, whose condition is 10.
            assert!((momentum[i] / exact[i] - 1.0).abs() < 6.0 * f64::EPSILON, "{momentum:?}");
        }
        let level = LevelStart { cosine_squared: 0.1, p_x: 1.1, h: 1.0 };
        let momentum = MomentumStart::Level(level).body_momentum(&BODY).unwrap();
        let exact = [0.999_679_948_783_609_43, 0.333_226_649_594_536_48, 0.315_594_676_761_190_001];
        for i in 0..3 {
            assert!((momentum[i] / exact[i] - 1.0).abs() < 20.0 * f64::EPSILON, "{momentum:?}");
        }
        let (energy, size) = BODY.energy_and_size(&momentum);
        assert!((energy - 1.0).abs() < 8.0 * f64::EPSILON && (size - 1.1).abs() < 8.0 * f64::EPSILON);
    }

    #[test]
    fn impossible_starts_are_refused_with_their_numbers() {
        let level = LevelStart { cosine_squared: 0.1, p_x: 1.1, h: 0.5 };
        let refused = MomentumStart::Level(level).body_momentum(&BODY).unwrap_err().to_string();
        assert!(refused.contains("h = 0.5"), "{refused}");
        let pole = EulerStart { phi: [0.0, 0.0, 0.1], p: [0.1, 0.2, 0.3] };
        assert!(MomentumStart::Euler(pole).body_momentum(&BODY).is_err());
    }
}
