//! A left-invariant metric on SO(3): three inverse moments of inertia.
//!
//! `H = ½ (A M1² + B M2² + C M3²)` with A = 1/I1, B = 1/I2, C = 1/I3 and M the angular momentum in the body frame
//! (the article's H_n of section 2.1, its H = (H1, H2, H3) being our M). The article orders A < B < C; nothing on SO(3)
//! needs an order, so none is asked for: equal and unordered values are accepted (spherical and symmetric bodies too).

use crate::geometry::rotation_group::vectors::dot;
use crate::numerics::real::Real;

/// Why a metric or a momentum is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} = {value}: {accepted}")]
pub struct DomainError {
    /// Which argument.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// What is accepted.
    pub accepted: &'static str,
}

/// The inverse moments of inertia A, B, C, all positive and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metric<S> {
    inverse_inertia: [S; 3],
}

impl<S: Real> Metric<S> {
    /// The metric with these inverse moments of inertia.
    ///
    /// # Errors
    /// [`DomainError`] unless all three are finite and positive.
    pub fn new(a: S, b: S, c: S) -> Result<Self, DomainError> {
        for (name, value) in [("A", a), ("B", b), ("C", c)] {
            if !(value > S::ZERO && value.is_finite()) {
                return Err(DomainError { name, value: value.to_f64(), accepted: "must be finite and positive" });
            }
        }
        Ok(Metric { inverse_inertia: [a, b, c] })
    }

    /// A, B, C.
    pub fn inverse_inertia(&self) -> [S; 3] {
        self.inverse_inertia
    }

    /// The angular velocity Ω = I⁻¹ M in the body frame.
    pub fn angular_velocity(&self, body_momentum: &[S; 3]) -> [S; 3] {
        let [a, b, c] = self.inverse_inertia;
        [a * body_momentum[0], b * body_momentum[1], c * body_momentum[2]]
    }

    /// The energy H.
    pub fn energy(&self, body_momentum: &[S; 3]) -> S {
        S::from_f64(0.5) * dot(body_momentum, &self.angular_velocity(body_momentum))
    }
}

/// Refuses a momentum that is zero or not finite: there is no direction to start in.
pub(super) fn check_momentum<S: Real>(body_momentum: &[S; 3]) -> Result<(), DomainError> {
    let mut size = S::ZERO;
    for (name, value) in ["M1", "M2", "M3"].into_iter().zip(body_momentum) {
        if !value.is_finite() {
            return Err(DomainError { name, value: value.to_f64(), accepted: "must be finite" });
        }
        size = size.max(value.abs());
    }
    if size > S::ZERO {
        Ok(())
    } else {
        Err(DomainError { name: "|M|", value: 0.0, accepted: "the momentum must not be zero" })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_and_velocity_follow_the_definition() {
        let metric = Metric::new(1.5, 2.0, 2.75).unwrap();
        assert_eq!(metric.angular_velocity(&[2.0, -1.0, 4.0]), [3.0, -2.0, 11.0]);
        assert_eq!(metric.energy(&[2.0, -1.0, 4.0]), 0.5 * (6.0 + 2.0 + 44.0));
    }

    #[test]
    fn wrong_values_are_named() {
        let refused = Metric::new(1.0, -2.0, 3.0).unwrap_err();
        assert_eq!((refused.name, refused.value), ("B", -2.0));
        assert!(Metric::new(f64::INFINITY, 1.0, 1.0).is_err() && Metric::new(1.0, 1.0, f64::NAN).is_err());
        assert!(Metric::new(2.0, 2.0, 1.0).is_ok(), "no order is needed");
        assert_eq!(check_momentum(&[0.0, 0.0, 0.0]).unwrap_err().name, "|M|");
        assert_eq!(check_momentum(&[0.0, f64::NAN, 0.0]).unwrap_err().name, "M2");
    }
}
