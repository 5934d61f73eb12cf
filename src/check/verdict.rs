//! Verdicts on claims, from their evidence by fixed rules.
//!
//! | evidence | holds when |
//! |---|---|
//! | direct | the test holds |
//! | slip | what is printed fails and the corrected form holds |
//! | only when | the test holds inside the condition and fails outside |
//! | not checked | never: it is said why not |
//!
//! A test that compares nothing (a number that is not finite, no case examined, a tolerance that is no tolerance) proves
//! neither; a claim with such a test fails.

use super::number::short;
use crate::contract::claim::{Evidence, Test};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What became of a claim. The order is that of a report: what needs attention first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The statement does not hold, or its evidence does not show what it should.
    Fails,
    /// It holds after a correction of what is printed.
    HoldsPrintedWithSlip,
    /// It holds under a condition that is not stated.
    HoldsOnlyWhen,
    /// It is not checked by computing.
    NotChecked,
    /// It holds as printed.
    Holds,
}

impl Verdict {
    const ALL: [Self; 5] =
        [Self::Fails, Self::HoldsPrintedWithSlip, Self::HoldsOnlyWhen, Self::NotChecked, Self::Holds];

    /// The name in goldens and machine output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fails => "fails",
            Self::HoldsPrintedWithSlip => "holds-printed-with-slip",
            Self::HoldsOnlyWhen => "holds-only-when",
            Self::NotChecked => "not-checked",
            Self::Holds => "holds",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A text that names no verdict.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no verdict")]
pub struct NoVerdict(pub String);

impl FromStr for Verdict {
    type Err = NoVerdict;
    fn from_str(text: &str) -> Result<Self, NoVerdict> {
        Self::ALL.into_iter().find(|verdict| verdict.name() == text).ok_or_else(|| NoVerdict(text.to_owned()))
    }
}

/// A verdict with the evidence in one line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Judgement {
    /// The verdict.
    pub verdict: Verdict,
    /// The evidence in one line.
    pub evidence: String,
}

/// What a test shows.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Holds,
    Fails,
    ComparesNothing,
}

fn outcome(test: &Test) -> Outcome {
    let compares = match test {
        Test::Equal { printed, ours, tolerance, .. } => {
            printed.is_finite() && ours.is_finite() && tolerance.is_finite() && *tolerance >= 0.0
        }
        Test::AtMost { measured, tolerance, .. } => measured.is_finite() && tolerance.is_finite(),
        Test::None { cases, counterexamples, .. } => *cases > 0 && counterexamples <= cases,
    };
    match (compares, test.holds()) {
        (false, _) => Outcome::ComparesNothing,
        (true, true) => Outcome::Holds,
        (true, false) => Outcome::Fails,
    }
}

/// The verdict that evidence leads to.
pub fn judge(evidence: &Evidence) -> Judgement {
    use Outcome::{ComparesNothing, Fails, Holds};
    let (verdict, evidence) = match evidence {
        Evidence::Direct(test) => match outcome(test) {
            Holds => (Verdict::Holds, describe(test)),
            Fails => (Verdict::Fails, describe(test)),
            ComparesNothing => nothing("the test", test),
        },
        Evidence::Slip { printed, correction, corrected } => match (outcome(printed), outcome(corrected)) {
            (ComparesNothing, _) => nothing("the test of what is printed", printed),
            (_, ComparesNothing) => nothing("the test of the corrected form", corrected),
            (Fails, Holds) => {
                let both = format!("{}; corrected to {correction}: {}", describe(printed), describe(corrected));
                (Verdict::HoldsPrintedWithSlip, both)
            }
            (Holds, _) => {
                (Verdict::Fails, format!("said to be a slip, but what is printed holds: {}", describe(printed)))
            }
            (Fails, Fails) => {
                let said = format!("the correction to {correction} does not hold either: {}", describe(corrected));
                (Verdict::Fails, said)
            }
        },
        Evidence::OnlyWhen { condition, inside, outside } => match (outcome(inside), outcome(outside)) {
            (ComparesNothing, _) => nothing("the test inside the condition", inside),
            (_, ComparesNothing) => nothing("the test outside the condition", outside),
            (Holds, Fails) => {
                let both = format!("when {condition}: {}; else: {}", describe(inside), describe(outside));
                (Verdict::HoldsOnlyWhen, both)
            }
            (Holds, Holds) => {
                let said = format!("the condition {condition} is not needed: outside it, {}", describe(outside));
                (Verdict::Fails, said)
            }
            (Fails, _) => (Verdict::Fails, format!("not even when {condition}: {}", describe(inside))),
        },
        Evidence::NotChecked { reason } => (Verdict::NotChecked, reason.clone()),
    };
    Judgement { verdict, evidence }
}

fn nothing(which: &str, test: &Test) -> (Verdict, String) {
    (Verdict::Fails, format!("{which} compares nothing: {}", describe(test)))
}

fn because(reason: &str) -> String {
    if reason.is_empty() { String::new() } else { format!(", {reason}") }
}

/// A test in one line: what was compared, and what was allowed.
fn describe(test: &Test) -> String {
    match test {
        Test::Equal { printed, ours, tolerance, reason } => format!(
            "printed {}, ours {}: difference {:.1e} (allowed {:.1e}{})",
            short(*printed),
            short(*ours),
            (printed - ours).abs(),
            tolerance,
            because(reason)
        ),
        Test::AtMost { measured, tolerance, reason } => {
            format!("largest violation {measured:.1e} (allowed {tolerance:.1e}{})", because(reason))
        }
        Test::None { counterexamples: 0, cases, .. } => format!("no counterexample in {cases} cases"),
        Test::None { counterexamples, cases, example } => {
            let first = if example.is_empty() { String::new() } else { format!("; the first: {example}") };
            format!("{counterexamples} counterexamples in {cases} cases{first}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equal(ours: f64) -> Test {
        Test::Equal { printed: 1.0, ours, tolerance: 0.1, reason: "half a digit".to_owned() }
    }

    fn slip(printed: f64, corrected: f64) -> Judgement {
        let (printed, corrected) = (equal(printed), equal(corrected));
        judge(&Evidence::Slip { printed, correction: "x".to_owned(), corrected })
    }

    fn only_when(inside: f64, outside: f64) -> Judgement {
        let (inside, outside) = (equal(inside), equal(outside));
        judge(&Evidence::OnlyWhen { condition: "p > 0".to_owned(), inside, outside })
    }

    #[test]
    fn each_rule() {
        let direct = |ours| judge(&Evidence::Direct(equal(ours))).verdict;
        assert_eq!((direct(1.05), direct(1.2)), (Verdict::Holds, Verdict::Fails));
        assert_eq!(slip(2.0, 1.0).verdict, Verdict::HoldsPrintedWithSlip);
        assert_eq!(slip(1.0, 1.0).verdict, Verdict::Fails);
        assert!(slip(1.0, 1.0).evidence.starts_with("said to be a slip, but what is printed holds"));
        assert_eq!(slip(2.0, 2.0).verdict, Verdict::Fails);
        assert_eq!(only_when(1.0, 2.0).verdict, Verdict::HoldsOnlyWhen);
        assert_eq!(only_when(1.0, 1.0).verdict, Verdict::Fails);
        assert_eq!(only_when(2.0, 2.0).verdict, Verdict::Fails);
        assert_eq!(judge(&Evidence::NotChecked { reason: "why".to_owned() }).verdict, Verdict::NotChecked);
    }

    /// A NaN must not pass for the failure that a slip or a condition needs.
    #[test]
    fn a_test_of_nothing_proves_nothing() {
        assert_eq!(slip(f64::NAN, 1.0).verdict, Verdict::Fails);
        assert_eq!(only_when(1.0, f64::INFINITY).verdict, Verdict::Fails);
        let none = |counterexamples, cases| Test::None { counterexamples, cases, example: String::new() };
        assert_eq!(judge(&Evidence::Direct(none(0, 0))).verdict, Verdict::Fails);
        let outside = judge(&Evidence::OnlyWhen { condition: "c".to_owned(), inside: none(0, 5), outside: none(0, 0) });
        assert_eq!(outside.verdict, Verdict::Fails);
        assert!(outside.evidence.contains("compares nothing"), "{}", outside.evidence);
    }

    #[test]
    fn evidence_is_one_line() {
        let text = slip(2.0, 1.0).evidence;
        assert_eq!(
            text,
            "printed 1.0, ours 2.0: difference 1.0e0 (allowed 1.0e-1, half a digit); corrected to x: \
             printed 1.0, ours 1.0: difference 0.0e0 (allowed 1.0e-1, half a digit)"
        );
    }

    #[test]
    fn names_read_back() {
        assert!(Verdict::ALL.into_iter().all(|verdict| verdict.name().parse() == Ok(verdict)));
        assert!("maybe".parse::<Verdict>().is_err());
    }
}
