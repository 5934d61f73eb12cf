//! The shape of a spin conjugate locus at its start.

use crate::geometry::spin::limits::TANGENT_ROOT;

/// The limit of `θ/(φ − π/2)²` along the conjugate locus as `p_θ → ∞`: `x0/(2k)`, `tan x0 = x0` (first positive root).
///
/// Near the start the metric is that of the Grushin plane, `x = φ − π/2`: `x = −(2k/p_θ) sin s`, `θ = (2k/p_θ²)(s − sin s cos s)` with
/// `s = p_θ t/(2k)`, whose first conjugate time is `s = x0`.
pub fn contact_coefficient(k: f64) -> f64 {
    TANGENT_ROOT / (2.0 * k)
}
