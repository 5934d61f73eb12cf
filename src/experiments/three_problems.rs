//! What experiments that compare methods and effects have in common: the three problems with their starts, and how times are measured.

use crate::contract::accuracy::Accuracy;
use crate::contract::config::Invalid;
use crate::contract::sweep::Sweep;
use crate::effects::scene::Inertia;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The spin problem, as a table and below configs.
pub const SPIN: &str = "spin";
/// The Serret-Andoyer flow.
pub const SERRET_ANDOYER: &str = "serret-andoyer";
/// The left-invariant metric on SO(3).
pub const ROTATION_GROUP: &str = "rotation-group";
/// The problems, as tables and in words.
pub const PROBLEMS: [(&str, &str); 3] =
    [(SPIN, "spin problem"), (SERRET_ANDOYER, "Serret-Andoyer"), (ROTATION_GROUP, "SO(3)")];

/// The leaves of a node's spin problem.
pub const SPIN_LEAVES: &[&str] = &["problem.k", "problem.p_theta"];
/// Those of its Serret-Andoyer flow, beside the body.
pub const SERRET_ANDOYER_LEAVES: &[&str] = &["problem.y0", "problem.xi1"];
/// Those of its metric on SO(3), beside the body.
pub const ROTATION_GROUP_LEAVES: &[&str] = &["problem.directions"];

/// The spin problem's starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinStarts {
    /// `k > 0`.
    pub k: f64,
    /// `p_θ(0) > 0`: a number, a list or a range.
    pub p_theta: Sweep,
}

/// The Serret-Andoyer flow's starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SerretAndoyerStarts {
    /// Inverse moments of inertia.
    pub body: Inertia,
    /// The angle y at the start (rad).
    pub y0: f64,
    /// `ξ1`, between cos² y0 and 1: a number, a list or a range.
    pub xi1: Sweep,
}

/// The starts on SO(3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationGroupStarts {
    /// Inverse moments of inertia.
    pub body: Inertia,
    /// Number of momenta, 1 to 10000.
    pub directions: usize,
}

/// How times are measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measurement {
    /// How often each start is integrated, 1 to 10000.
    pub repetitions: usize,
}

/// Accepted of numbers of starts and of repetitions: more is a slip.
const MOST: &str = "1 to 10000";

impl SpinStarts {
    /// Refuses a k or a p_θ that is not positive.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self) -> Result<(), Invalid> {
        Invalid::number(self.k > 0.0 && self.k.is_finite(), "spin.k", self.k, "a number above 0")?;
        self.p_theta.validate_each("spin.p_theta", "p_theta > 0", |p_theta| p_theta > 0.0)
    }
}

impl SerretAndoyerStarts {
    /// Refuses a body out of order, or a ξ1 that does not oscillate.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self) -> Result<(), Invalid> {
        self.body.validate("serret-andoyer.body")?;
        Invalid::number(self.y0.is_finite(), "serret-andoyer.y0", self.y0, "a finite number")?;
        let cosine = libm::cos(self.y0);
        let least = cosine * cosine;
        let accepted = format!("cos^2(y0) = {least:.6} < xi1 < 1 (oscillating)");
        self.xi1.validate_each("serret-andoyer.xi1", &accepted, |xi1| xi1 > least && xi1 < 1.0)
    }
}

impl RotationGroupStarts {
    /// Refuses a body out of order, or too many directions or none.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self) -> Result<(), Invalid> {
        self.body.validate("rotation-group.body")?;
        let accepted = (1..=10_000).contains(&self.directions);
        Invalid::unless(accepted, "rotation-group.directions", self.directions, MOST)
    }
}

impl Measurement {
    /// Refuses no repetitions, and more than anybody waits for.
    ///
    /// # Errors
    /// A number of repetitions that is not accepted.
    pub fn validate(&self) -> Result<(), Invalid> {
        let accepted = (1..=10_000).contains(&self.repetitions);
        Invalid::unless(accepted, "measurement.repetitions", self.repetitions, MOST)
    }
}

/// Refuses a list without an accuracy, and errors that do not fall.
///
/// # Errors
/// The first that does not fall.
pub fn validate_accuracies(accuracies: &[Accuracy]) -> Result<(), Invalid> {
    Invalid::unless(!accuracies.is_empty(), "accuracies", "[]", "at least one accuracy")?;
    for (i, pair) in accuracies.windows(2).enumerate() {
        let falls = pair[1].relative_error() < pair[0].relative_error();
        let accepted = format!("a relative error below {} (falling)", pair[0]);
        Invalid::unless(falls, format!("accuracies[{}]", i + 1), pair[1], accepted)?;
    }
    Ok(())
}

/// Accuracies in words.
pub fn in_words(asked: &[f64]) -> String {
    asked.iter().map(|asked| format!("{asked:e}")).collect::<Vec<_>>().join(", ")
}

/// Which config keys the leaves of a problem's nodes come from.
pub fn origins(problem: &str, leaves: &[&'static str]) -> Vec<(&'static str, String)> {
    let body = [("problem.body.A", "A"), ("problem.body.B", "B"), ("problem.body.C", "C")];
    let mut origins: Vec<(&'static str, String)> = vec![("asked", "accuracies".to_owned())];
    if problem != SPIN {
        origins.extend(body.map(|(leaf, name)| (leaf, format!("{problem}.body.{name}"))));
    }
    origins.extend(leaves.iter().map(|leaf| {
        let name = leaf.rsplit('.').next().unwrap_or(leaf);
        (*leaf, format!("{problem}.{name}"))
    }));
    origins
}
