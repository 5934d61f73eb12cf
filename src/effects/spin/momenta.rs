//! How one branch of a spin conjugate locus is sampled: a parameter of configs and of nodes alike, without any logic.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `p_theta = { from = 1e-9, to = 1e4, step = 0.1 }`: the momenta of one branch, `p_φ(0) = −2`, `p_θ ≥ 0`.
///
/// `p_θ = 0` is always a sample. Between `from` and `to` the samples stand so densely in `log p_θ` that neighbouring
/// points of the locus are at most `step` apart on the sphere, and less where the locus bends: it is within `step²/25` of the
/// polygon in the chart (θ, φ).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Momenta {
    /// The smallest positive `p_θ`; the conjugate point there must be within `step/10` of its limit `p_θ = 0`.
    pub from: f64,
    /// The largest `p_θ`, where the locus is within `9 k/to` of its start.
    pub to: f64,
    /// Largest distance of neighbours, radians.
    pub step: f64,
}
