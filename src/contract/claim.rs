//! A claim: a statement of the article, and the evidence computed for or against it.
//!
//! An experiment states evidence; it never writes a verdict. Verdicts follow from the evidence by fixed rules in the
//! `check` room.

use serde::{Deserialize, Serialize};

/// What the reason of a tolerance says where a claim's number stands in the article digit by digit: half a unit of the last printed digit.
pub const LAST_PRINTED_DIGIT: &str = "of the last printed digit";

/// A statement of the article with the evidence of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The name inside its experiment: `upper_bound`.
    pub id: String,
    /// Where it stands in the article: `Theorem 3.9, part 1`.
    pub place: String,
    /// What is claimed, in our words.
    pub statement: String,
    /// What was computed.
    pub evidence: Evidence,
    /// Why the numbers differ, or under which condition the statement holds; empty where there is nothing to say.
    #[serde(default)]
    pub note: String,
    /// Forms of the statement that are wrong on purpose, tested as it is: none may hold, or the check would not tell right from wrong.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wrong: Vec<WrongForm>,
}

/// A form of a statement that is wrong on purpose: a sign, a factor, a neighbouring digit, a bound on the other side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrongForm {
    /// What it says in the place of what is right.
    pub form: String,
    /// The test of it.
    pub test: Test,
}

impl Claim {
    /// With one more form that has to be refused.
    #[must_use]
    pub fn refusing(mut self, form: impl Into<String>, test: Test) -> Self {
        self.wrong.push(WrongForm { form: form.into(), test });
        self
    }

    /// The wrong forms that the check takes for right.
    pub fn survivors(&self) -> impl Iterator<Item = &WrongForm> {
        self.wrong.iter().filter(|wrong| wrong.test.holds())
    }
}

/// One comparison: a number against what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum Test {
    /// A printed number against ours: holds when they differ by at most `tolerance` (absolute).
    Equal {
        /// The number in the article.
        printed: f64,
        /// The number computed here.
        ours: f64,
        /// The largest difference that counts as equal.
        tolerance: f64,
        /// Why this tolerance: half a unit of the last printed digit, …
        reason: String,
    },
    /// The largest violation found of an identity or an inequality: holds when at most `tolerance`.
    AtMost {
        /// What was measured.
        measured: f64,
        /// What is allowed.
        tolerance: f64,
        /// Why this tolerance.
        reason: String,
    },
    /// A count of counterexamples among cases examined: holds when there is none, and at least one case.
    None {
        /// Counterexamples.
        counterexamples: u64,
        /// Cases examined.
        cases: u64,
        /// The first counterexample, in words and numbers; empty when there is none.
        example: String,
    },
}

impl Test {
    /// Whether the comparison holds. Numbers that are not finite never hold.
    pub fn holds(&self) -> bool {
        match self {
            Self::Equal { printed, ours, tolerance, .. } => (printed - ours).abs() <= *tolerance,
            Self::AtMost { measured, tolerance, .. } => measured <= tolerance,
            Self::None { counterexamples, cases, .. } => *counterexamples == 0 && *cases > 0,
        }
    }
}

/// What an experiment computed about a claim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum Evidence {
    /// One test of the statement as printed.
    Direct(Test),
    /// The statement as printed, and a corrected form.
    Slip {
        /// The test of what is printed.
        printed: Test,
        /// The corrected statement.
        correction: String,
        /// The test of the corrected form.
        corrected: Test,
    },
    /// A statement that holds under a condition that the article does not state.
    OnlyWhen {
        /// The condition.
        condition: String,
        /// The test where the condition holds.
        inside: Test,
        /// The test where it does not; the statement must fail there.
        outside: Test,
    },
    /// A statement that is not checked by computing, and why.
    NotChecked {
        /// The reason.
        reason: String,
    },
}
