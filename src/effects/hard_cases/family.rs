//! One family of hard cases: the distances it is swept over, what a case holds, when an answer counts as stable, and the table of a family.
//!
//! A family is a sequence of starts whose `distance` to a limit falls over many orders of magnitude. Each case has a truth, from
//! double-double arithmetic or an exact limit for the inputs as given; the answer of a naive formulation, which is what a straightforward program
//! would compute in f64 (the printed formula, or an integration in the chart); and ours, with the error that it claims.
//!
//! **Verdict.** With the condition number κ of the posed problem, an answer is *stable* when its relative error is at most
//! `20 ε (κ + 1)`: what rounding the inputs once does to the exact answer, and as much again for the result. *Honest* when the error is at
//! most the claimed one, or half an ε, which no answer in f64 goes below.

use crate::contract::work::Work;
use crate::table::{Table, TableError};

/// How often the error that one rounding of the inputs makes is allowed to a stable answer.
pub const STABLE: f64 = 20.0;

/// The answer of a program in f64 to one case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// The answer; NaN where none comes out.
    pub value: f64,
    /// The relative error that it claims; NaN where it claims none.
    pub claimed: f64,
}

/// One case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Distance to the limit: the parameter that falls.
    pub distance: f64,
    /// The exact answer for the inputs as given, rounded to f64.
    pub truth: f64,
    /// The same less its rounding to f64: the truth is the sum of both.
    pub truth_rest: f64,
    /// The naive formulation's answer; NaN where none comes out.
    pub naive: f64,
    /// Ours.
    pub ours: Told,
    /// Condition number of the posed problem: the largest `|∂ ln answer/∂ ln input|`.
    pub condition: f64,
    /// How ours was found, as `point` says it.
    pub route: String,
    /// Work of ours.
    pub work: Work,
}

/// What is to be said about our answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Stable, and the claimed error is a bound.
    Stable,
    /// Not stable, but the claimed error says so.
    Lossy,
    /// The error is above the claimed one.
    Wrong,
    /// No answer, with a reason.
    Refused,
}

impl Verdict {
    /// In tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Lossy => "lossy",
            Self::Wrong => "wrong",
            Self::Refused => "refused",
        }
    }
}

impl Case {
    /// The relative error of an answer: 1 at most, and where no number comes out.
    pub fn error_of(&self, answer: f64) -> f64 {
        let error = (((answer - self.truth) - self.truth_rest) / self.truth).abs();
        if error.is_nan() { 1.0 } else { error.min(1.0) }
    }

    /// The verdict about our answer.
    pub fn verdict(&self) -> Verdict {
        if self.ours.value.is_nan() {
            return Verdict::Refused;
        }
        let error = self.error_of(self.ours.value);
        if error > self.ours.claimed.max(0.5 * f64::EPSILON) {
            return Verdict::Wrong;
        }
        let stable = error <= STABLE * f64::EPSILON * (self.condition + 1.0);
        if stable { Verdict::Stable } else { Verdict::Lossy }
    }
}

/// A parameter of a sweep that is not accepted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: found {found}, accepted: {accepted}")]
pub struct Refused {
    /// Its place in the sweep: `to`, `family.pole.passage`.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is accepted.
    pub accepted: String,
}

impl Refused {
    /// A number is refused unless it `holds`.
    ///
    /// # Errors
    /// It does not.
    pub fn unless(holds: bool, key: impl Into<String>, found: f64, accepted: impl Into<String>) -> Result<(), Self> {
        let refused = || Self { key: key.into(), found: format!("{found:?}"), accepted: accepted.into() };
        if holds { Ok(()) } else { Err(refused()) }
    }
}

/// Refuses a sweep that does not fall, or leaves what its family is made for.
///
/// # Errors
/// [`Refused`], with the key `from` or `to`.
pub fn check_ends(from: f64, to: f64, nearest: f64, farthest: f64) -> Result<(), Refused> {
    let accepted = format!("above {farthest:?}, at most {nearest:?}");
    Refused::unless(from > farthest && from <= nearest, "from", from, accepted)?;
    Refused::unless(to >= farthest && to < from, "to", to, format!("at least {farthest:?}, below {from:?}"))
}

/// The distances of a sweep from `from` down to `to`, equally spaced in the logarithm, about as many a decade; both ends exact, and never fewer
/// than these two. Domain: `from > to > 0`.
pub fn distances(from: f64, to: f64, per_decade: u32) -> Vec<f64> {
    let steps = (libm::log10(from / to) * f64::from(per_decade) + 0.5).floor().max(1.0);
    let at = |i: f64| if i == steps { to } else { from * libm::pow(to / from, i / steps) };
    (0..=steps as u32).map(|i| at(f64::from(i))).collect()
}

/// The table of a family whose answers have this unit.
///
/// # Errors
/// A truth or a condition that is no number.
pub fn table(family: &str, unit: &str, meaning: &str, cases: &[Case]) -> Result<Table, TableError> {
    let column = |of: &dyn Fn(&Case) -> f64| cases.iter().map(of).collect::<Vec<f64>>();
    let text = |of: &dyn Fn(&Case) -> String| cases.iter().map(of).collect::<Vec<String>>();
    // An answer that was refused claims nothing; it counts as claiming all.
    let claimed = |case: &Case| if case.ours.claimed.is_nan() { 1.0 } else { case.ours.claimed };
    Table::builder(family, meaning)
        .column("distance", "1", "distance to the limit", column(&|case| case.distance))
        .column("truth", unit, "the exact answer for the inputs as given, rounded", column(&|case| case.truth))
        .column_with_gaps("naive", unit, "the naive formulation's answer", column(&|case| case.naive))
        .column("naive_error", "1", "its relative error; 1 at most", column(&|case| case.error_of(case.naive)))
        .column_with_gaps("ours", unit, "our answer", column(&|case| case.ours.value))
        .column("our_error", "1", "its relative error; 1 at most", column(&|case| case.error_of(case.ours.value)))
        .column("claimed", "1", "the relative error that ours claims", column(&claimed))
        .column("condition", "1", "condition number of the posed problem", column(&|case| case.condition))
        .column("elliptic_calls", "1", "elliptic functions that ours took", column(&|c| c.work.elliptic_calls as f64))
        .column("steps", "1", "integration steps that ours took", column(&|case| case.work.steps as f64))
        .column("route", "", "how ours was found", text(&|case| case.route.clone()))
        .column("verdict", "", "stable, lossy, wrong or refused", text(&|case| case.verdict().name().to_owned()))
        .build()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(value: f64, claimed: f64) -> Case {
        Case {
            distance: 0.1,
            truth: 2.0,
            truth_rest: 0.0,
            naive: f64::NAN,
            ours: Told { value, claimed },
            condition: 3.0,
            route: "closed form".to_owned(),
            work: Work::default(),
        }
    }

    /// The definitions of the module's page, at their borders.
    #[test]
    fn verdicts() {
        let off = |ulps: f64| 2.0 * (1.0 + ulps * f64::EPSILON);
        assert_eq!(case(off(80.0), 1e-13).verdict(), Verdict::Stable);
        assert_eq!(case(off(81.0), 1e-13).verdict(), Verdict::Lossy);
        assert_eq!(case(off(2.0), f64::EPSILON).verdict(), Verdict::Wrong);
        assert_eq!(case(2.0, 0.0).verdict(), Verdict::Stable);
        assert_eq!(case(f64::NAN, f64::NAN).verdict(), Verdict::Refused);
        let told = table("t", "rad", "a family", &[case(off(1.0), 1e-13)]).unwrap();
        assert_eq!(told.f64s("naive_error").unwrap(), [1.0]);
        assert_eq!(told.f64s("our_error").unwrap(), [f64::EPSILON]);
        for (column, unit) in [("truth", "rad"), ("naive", "rad"), ("ours", "rad"), ("our_error", "1")] {
            assert_eq!(told.column(column).unwrap().unit, unit, "{column}");
        }
    }

    #[test]
    fn sweeps_fall_from_one_end_to_the_other() {
        let found = distances(0.1, 1e-15, 3);
        assert_eq!((found.len(), found[0], found[42]), (43, 0.1, 1e-15));
        // Two roundings of the power's argument, magnified by ln 1e14, and those of the power and the product.
        assert!(found.windows(2).all(|pair| (libm::log10(pair[0] / pair[1]) * 3.0 - 1.0).abs() < 1e-13));
        assert_eq!(distances(1.0, 0.9, 0), [1.0, 0.9]);
        let refused = |from, to| check_ends(from, to, 1.0, 1e-15).unwrap_err().key;
        assert!(check_ends(1.0, 1e-15, 1.0, 1e-15).is_ok());
        for (from, to) in [(2.0, 0.1), (f64::NAN, 0.1), (1e-15, 1e-16), (0.0, 0.0)] {
            assert_eq!(refused(from, to), "from");
        }
        for (from, to) in [(0.1, 0.1), (0.1, 0.2), (0.1, 1e-16), (0.1, f64::NAN)] {
            assert_eq!(refused(from, to), "to");
        }
    }
}
