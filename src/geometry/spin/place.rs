//! Where first conjugate points stand, in any scalar and not rounded: for equations whose unknown is a momentum, such as double points.
//!
//! The formulas are those of [`super::conjugate`]: with `λ = π + χ`, `r = (1/ρ) [−cos χ (h3, 0, −h1) − (sin χ/G)(−h1 h2, ρ², −h2 h3)]`, `ρ² = h1² + h3²`.
//! Angles in radians.

use super::extremal::{Extremal, hypotenuse};
use super::solve::{Quantity, SpinError, solve};
use crate::numerics::real::Real;

/// The place of a first conjugate point in the chart.
#[derive(Debug, Clone, Copy)]
pub struct Place<S> {
    /// θ, in `(−π, π]`.
    pub theta: S,
    /// φ, from the pole `r2 = 1`.
    pub phi: S,
}

/// The place of the first conjugate point.
///
/// Domain: `k > 0`, `p_θ > 0`, neither near the bounds of [`super::start::Start`], which are not checked. Guarantee: a few ε of the scalar times the condition.
///
/// # Errors
/// [`SpinError`].
pub fn first_conjugate_place<S: Real>(k: S, p_theta: S) -> Result<Place<S>, SpinError> {
    let extremal = Extremal::new(k, p_theta);
    let root = solve(&extremal, Quantity::Phase, S::ONE)?;
    let two = S::from_f64(2.0);
    let h = [two * k * root.sin_beta, -(two * k * root.beta_rate), two * root.cos_beta];
    let rho = hypotenuse(h[0].abs(), h[2].abs());
    let (across, along) = (-root.cos_chi / rho, -root.sin_chi / extremal.casimir);
    let h2 = h[1] / rho;
    let r = [across * h[2] - along * h[0] * h2, along * rho, -(across * h[0]) - along * h[2] * h2];
    Ok(Place { theta: r[2].atan2(r[0]), phi: hypotenuse(r[0].abs(), r[2].abs()).atan2(r[1]) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spin::reference::first_conjugate_point_to_reference;
    use crate::geometry::spin::start::Start;
    use crate::numerics::double_double::DoubleDouble;

    /// Oracle: the rounded points of `reference`.
    #[test]
    fn places_round_to_those_of_points() {
        for (k, p) in [(0.5, 0.3), (0.8, 1.0), (1.2, 0.1), (1.4, 2.0)] {
            let point = first_conjugate_point_to_reference(&Start::new(k, p).unwrap()).unwrap();
            let place = first_conjugate_place(DoubleDouble::from(k), DoubleDouble::from(p)).unwrap();
            assert_eq!((place.theta.to_f64(), place.phi.to_f64()), (point.theta, point.phi), "k = {k}, p = {p}");
        }
    }
}
