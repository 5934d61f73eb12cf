//! Where the spin families' limits lie: the separatrix in closed form, the others as roots in double-double, next to which an `f64` can be chosen.

use super::spin::Family;
use crate::geometry::spin::reference::{delta_beta_at_return, first_conjugate_point_in_double_double};
use crate::geometry::spin::solve::SpinError;
use crate::geometry::spin::switch_points::{Passage, SwitchPoint, meridian_switch, switch_points};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// The return to the equator that becomes conjugate first as `p_θ` grows.
const FIRST_CONJUGATE_RETURN: u32 = 2;
/// Where pole passages are looked for (Fig. 4).
const POLE_RANGE: (f64, f64) = (1.0, 1.5);
/// Secant steps from a root known to 1e-10: three are enough for double-double.
const SECANT_STEPS: usize = 6;
/// Halvings of a bracket in `f64`.
const HALVINGS: usize = 60;

/// The k above which some `p_θ` has the second return to the equator conjugate: 2/√3.
pub(super) fn crossings_begin() -> f64 {
    meridian_switch(Passage::Equator, FIRST_CONJUGATE_RETURN)
}

/// The value of the swept parameter in the limit, where it is not 0 or infinite.
pub(super) fn limit(family: &Family) -> Result<DoubleDouble, SpinError> {
    match *family {
        Family::Separatrix { k, .. } => {
            let k = DoubleDouble::from(k);
            Ok(DoubleDouble::from(2.0) * ((k - DoubleDouble::ONE) * (k + DoubleDouble::ONE)).sqrt())
        }
        Family::EquatorCrossing { k, .. } => {
            let at = |p: DoubleDouble| delta_beta_at_return(k.into(), p, FIRST_CONJUGATE_RETURN);
            let q = 2.0 * ((k - 1.0) * (k + 1.0)).sqrt();
            // δβ at the second return is negative for small p_θ above k̄, and positive next to the separatrix.
            let (mut low, mut high) = (1e-6 * q, 0.999 * q);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if at(middle.into())? < DoubleDouble::ZERO { low = middle } else { high = middle }
            }
            secant(low.into(), at)
        }
        Family::Pole { p_theta, passage, .. } => {
            let found = pole_passages(p_theta)?;
            let missing = SpinError::OutOfDomain {
                what: "passage",
                found: f64::from(passage),
                accepted: "the number of a pole passage between k = 1 and 1.5, from 1",
            };
            let switch = found.get((passage as usize).wrapping_sub(1)).ok_or(missing)?;
            // r1 vanishes where θ = π/2.
            let half = DoubleDouble::PI / DoubleDouble::from(2.0);
            let tangent = |k: DoubleDouble| {
                let theta = first_conjugate_point_in_double_double(k, p_theta.into())?.theta;
                let (sine, cosine) = (half - theta).sin_cos();
                Ok(sine / cosine)
            };
            secant(switch.k.into(), tangent)
        }
        _ => Ok(DoubleDouble::ONE),
    }
}

/// The passages of a pole that are numbered.
pub(super) fn pole_passages(p_theta: f64) -> Result<Vec<SwitchPoint>, SpinError> {
    switch_points(Passage::Pole, p_theta, POLE_RANGE.0, POLE_RANGE.1)
}

/// The root of a function near a point that is within rounding in `f64` of it.
fn secant(
    near: DoubleDouble,
    function: impl Fn(DoubleDouble) -> Result<DoubleDouble, SpinError>,
) -> Result<DoubleDouble, SpinError> {
    let (mut last, mut x) = (near * DoubleDouble::from(1.0 - 4.0 * f64::EPSILON), near);
    let (mut value_there, mut value) = (function(last)?, function(x)?);
    for _ in 0..SECANT_STEPS {
        if value == value_there || value == DoubleDouble::ZERO {
            break;
        }
        let next = x - value * ((x - last) / (value - value_there));
        (last, value_there) = (x, value);
        x = next;
        value = function(x)?;
    }
    Ok(x)
}
