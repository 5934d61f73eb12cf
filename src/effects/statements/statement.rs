//! What a statement of the article is to this program: forms, one check for all of them, and which form is the printed one.
//!
//! A *form* is one way to write the statement: as printed, corrected, or wrong on purpose (a sign, a factor, an exponent). One function
//! examines any of them and returns what it measured; a wrong form that passes shows that the check is worth nothing. Verdicts follow from
//! the tests by the rules of the `check` room; none is written by hand.

use crate::contract::claim::{Claim, Evidence, Test, WrongForm};
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// What a slip that may be the reader's and not the article's is noted with.
pub const TRANSCRIPTION: &str =
    "Known to us through a transcription of the page, which may have lost a sign, a root, an exponent or a factor.";

/// Which form a check examines: an index into [`Statement::forms`].
pub type Form = usize;

/// How a statement stands to its forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// It is examined as printed: form 0.
    Direct,
    /// It is printed with a slip: form 0 is the printed one, form 1 the corrected one.
    Slip {
        /// The corrected statement, with its formula.
        correction: &'static str,
    },
    /// It holds under a condition: form 0 is examined where it is met, form 1 where it is not (and must fail there).
    OnlyWhen {
        /// The condition.
        condition: &'static str,
    },
    /// It is not checked by computing.
    NotChecked {
        /// Why.
        reason: &'static str,
    },
}

impl Shape {
    /// The forms that belong to the statement itself; those after them are wrong on purpose.
    pub fn own_forms(self) -> usize {
        match self {
            Self::Direct => 1,
            Self::Slip { .. } | Self::OnlyWhen { .. } => 2,
            Self::NotChecked { .. } => 0,
        }
    }
}

/// A statement and its check.
#[derive(Clone, Copy)]
pub struct Statement {
    /// Its name: letters, digits and `_`, unique among all.
    pub id: &'static str,
    /// Where it stands in the article.
    pub place: &'static str,
    /// What is claimed, in our words, with its formula.
    pub says: &'static str,
    /// How it is checked: what is sampled, against what.
    pub method: &'static str,
    /// How it stands to its forms.
    pub shape: Shape,
    /// The forms: the statement's own, then at least two that are wrong on purpose (where it is checked at all).
    pub forms: &'static [&'static str],
    /// Examines a form.
    pub examine: fn(Form) -> Result<Test, Unexamined>,
    /// What else there is to say: what was newly found, what the check does not see. No digit of a result.
    pub note: &'static str,
}

/// A check that could not be carried out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unexamined(pub String);

/// Makes any error one of a check.
pub fn unexamined<E: Display>(error: E) -> Unexamined {
    Unexamined(error.to_string())
}

/// A statement, examined.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Examined {
    /// The claim with its evidence and its wrong forms.
    pub claim: Claim,
    /// How it was checked.
    pub method: String,
}

impl Statement {
    /// Examines all forms.
    ///
    /// # Errors
    /// A check that could not be carried out, with the statement's name and the form.
    pub fn examined(&self) -> Result<Examined, Unexamined> {
        let test = |form: Form| {
            let words = self.forms.get(form).copied().unwrap_or("a form that is not there");
            (self.examine)(form).map_err(|error| Unexamined(format!("{}, {words}: {error}", self.id)))
        };
        let evidence = match self.shape {
            Shape::Direct => Evidence::Direct(test(0)?),
            Shape::Slip { correction } => {
                Evidence::Slip { printed: test(0)?, correction: correction.to_owned(), corrected: test(1)? }
            }
            Shape::OnlyWhen { condition } => {
                Evidence::OnlyWhen { condition: condition.to_owned(), inside: test(0)?, outside: test(1)? }
            }
            Shape::NotChecked { reason } => Evidence::NotChecked { reason: reason.to_owned() },
        };
        let wrong = self.shape.own_forms()..self.forms.len();
        let wrong = wrong
            .map(|form| Ok(WrongForm { form: self.forms[form].to_owned(), test: test(form)? }))
            .collect::<Result<Vec<_>, Unexamined>>()?;
        let claim = Claim {
            id: self.id.to_owned(),
            place: self.place.to_owned(),
            statement: self.says.to_owned(),
            evidence,
            note: self.note.to_owned(),
            wrong,
        };
        Ok(Examined { claim, method: self.method.to_owned() })
    }
}

/// The largest relative residual seen so far, for identities at many points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// The largest; infinite once a residual was no number.
    pub measured: f64,
    /// How many were seen.
    pub cases: u64,
}

impl Worst {
    /// Takes one residual.
    pub fn see(&mut self, residual: f64) {
        let residual = residual.abs();
        self.measured = if residual.is_nan() { f64::INFINITY } else { self.measured.max(residual) };
        self.cases += 1;
    }

    /// The difference of two sides, relative to the larger of them and of `scale`.
    pub fn compare(&mut self, left: f64, right: f64, scale: f64) {
        self.see((left - right) / left.abs().max(right.abs()).max(scale));
    }

    /// The test that none is above `tolerance`. A residual that is not finite counts as 1e300: no claim can hold with it, and it can be written down.
    pub fn at_most(self, tolerance: f64, reason: &str) -> Test {
        let measured = if self.cases == 0 { f64::INFINITY } else { self.measured }.min(1e300);
        Test::AtMost { measured, tolerance, reason: format!("{reason}; {} cases", self.cases) }
    }
}

/// Counterexamples among cases.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cases {
    /// Examined.
    pub all: u64,
    /// Counterexamples.
    pub against: u64,
    /// The first of them.
    pub example: String,
}

impl Cases {
    /// Takes one case; `words` are asked for at the first counterexample only.
    pub fn see(&mut self, holds: bool, words: impl FnOnce() -> String) {
        self.all += 1;
        if !holds {
            self.against += 1;
            if self.example.is_empty() {
                self.example = words();
            }
        }
    }

    /// The test that there is none.
    pub fn none(self) -> Test {
        Test::None { counterexamples: self.against, cases: self.all, example: self.example }
    }
}

/// A repeatable source of numbers, SplitMix64 (Steele, Lea and Flood 2014): the samples of a check are the same on every machine.
#[derive(Clone, Debug)]
pub struct Samples(u64);

impl Samples {
    /// A source of its own for each check.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly in `(from, to)`.
    pub fn even(&mut self, from: f64, to: f64) -> f64 {
        let unit = ((self.bits() >> 12) as f64 + 0.5) / 4_503_599_627_370_496.0;
        from + (to - from) * unit
    }

    /// Evenly in the logarithm, in `(from, to)`, both above zero.
    pub fn log(&mut self, from: f64, to: f64) -> f64 {
        libm::exp(self.even(libm::log(from), libm::log(to)))
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.bits() >> 63 == 0 { 1.0 } else { -1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// sin²x + cos²x = 1, printed as 2: the corrected form holds, the printed and the wrong ones fail.
    const PYTHAGORAS: Statement = Statement {
        id: "pythagoras",
        place: "nowhere",
        says: "sin² x + cos² x = 2",
        method: "at random x",
        shape: Shape::Slip { correction: "sin² x + cos² x = 1" },
        forms: &["as printed", "corrected", "a sign", "an exponent"],
        examine: |form| {
            let (mut samples, mut worst) = (Samples::new(1), Worst::default());
            for _ in 0..100 {
                let (sine, cosine) = libm::sincos(samples.even(-3.0, 3.0));
                let left = match form {
                    2 => cosine * cosine - sine * sine,
                    3 => cosine * cosine + sine,
                    _ => cosine * cosine + sine * sine,
                };
                worst.compare(left, if form == 0 { 2.0 } else { 1.0 }, 1.0);
            }
            Ok(worst.at_most(1e-15, "a few ε"))
        },
        note: "",
    };

    #[test]
    fn a_slip_is_told_from_a_truth_and_wrong_forms_are_refused() {
        let examined = PYTHAGORAS.examined().unwrap();
        let Evidence::Slip { printed, corrected, .. } = &examined.claim.evidence else { panic!("{examined:?}") };
        assert!(!printed.holds() && corrected.holds());
        assert_eq!((examined.claim.wrong.len(), examined.claim.survivors().count()), (2, 0));
    }

    #[test]
    fn no_case_proves_nothing() {
        assert!(!Worst::default().at_most(1.0, "").holds());
        assert!(!Cases::default().none().holds());
        let mut worst = Worst::default();
        worst.see(f64::NAN);
        worst.see(0.0);
        assert!(!worst.at_most(1e200, "").holds());
    }
}
