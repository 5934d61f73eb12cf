//! A named value: one number of the article or beyond it, with unit, route and error.

use serde::{Deserialize, Serialize};

/// One number that can be cited by name, as `experiment/name`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedValue {
    /// The name inside its experiment: `k1`, `tau_case_1`.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its unit: `rad`, `1`, `length`.
    pub unit: String,
    /// What it is, in one sentence.
    pub meaning: String,
    /// How it was computed.
    pub route: String,
    /// A bound on the absolute error.
    pub error: f64,
}

/// What an experiment finds: named values, and claims with their evidence. Stored as JSON, floats in the shortest form that reads
/// back to the same bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Findings {
    /// The named values.
    pub values: Vec<NamedValue>,
    /// The claims.
    pub claims: Vec<super::claim::Claim>,
}
