//! What many experiments say alike: values, claims, numbers off a table of quantities, cases, and the agreement of two routes.

use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::table::{Table, TableError};

/// A table that can't be read the way an experiment reads it.
pub fn unread(error: TableError) -> NodeError {
    NodeError::new(error.to_string())
}

/// A claim.
pub fn claim(
    id: &str,
    place: &str,
    statement: impl Into<String>,
    evidence: Evidence,
    note: impl Into<String>,
) -> Claim {
    let (id, place, statement, note) = (id.to_owned(), place.to_owned(), statement.into(), note.into());
    Claim { id, place, statement, evidence, note, wrong: Vec::new() }
}

/// A named value with the bound of its absolute error.
pub fn value(
    name: impl Into<String>,
    (value, error): (f64, f64),
    unit: &str,
    meaning: impl Into<String>,
    route: &str,
) -> NamedValue {
    let (unit, route) = (unit.to_owned(), route.to_owned());
    NamedValue { name: name.into(), value, unit, meaning: meaning.into(), route, error }
}

/// The named value among others.
///
/// # Errors
/// No value of this name.
pub fn named<'a>(values: &'a [NamedValue], name: &str) -> Result<&'a NamedValue, NodeError> {
    values.iter().find(|value| value.name == name).ok_or_else(|| NodeError::new(format!("no value {name}")))
}

/// All numbers of a table of quantities, as named values.
///
/// # Errors
/// A table of another form.
pub fn quantities(table: &Table) -> Result<Vec<NamedValue>, NodeError> {
    let numbers = |name: &str| table.f64s(name).map_err(unread);
    let texts = |name: &str| table.texts(name).map_err(unread);
    let (values, errors) = (numbers("value")?, numbers("error")?);
    let (names, units, meanings, routes) = (texts("quantity")?, texts("unit")?, texts("meaning")?, texts("route")?);
    Ok((0..table.rows())
        .map(|i| NamedValue {
            name: names[i].clone(),
            value: values[i],
            unit: units[i].clone(),
            meaning: meanings[i].clone(),
            route: routes[i].clone(),
            error: errors[i],
        })
        .collect())
}

/// The largest value of a column.
///
/// # Errors
/// No such column, or no row.
pub fn largest(table: &Table, column: &str) -> Result<f64, NodeError> {
    let values = table.f64s(column).map_err(unread)?;
    values.iter().copied().reduce(f64::max).ok_or_else(|| NodeError::new(format!("{}: no rows", table.name())))
}

/// The largest difference of the two routes over tables of second routes, as a named value.
///
/// # Errors
/// A table of another form.
pub fn largest_route_difference(second_routes: &[&Table]) -> Result<NamedValue, NodeError> {
    let mut worst: f64 = 0.0;
    let mut rows = 0;
    for table in second_routes {
        worst = worst.max(largest(table, "t1_difference")?);
        rows += table.rows();
    }
    Ok(value(
        "largest_route_difference",
        // The differences of nearby numbers are exact; their own rounding is that of the two routes.
        (worst, 4.0 * f64::EPSILON),
        "1",
        format!("largest relative difference of a conjugate time between closed form and integration, {rows} rows"),
        "closed form against power-series integration (double-double where f64 loses too much)",
    ))
}

/// The claim that both routes agree, with the difference that the tables allow.
///
/// # Errors
/// A table of another form.
pub fn routes_agree(second_routes: &[&Table]) -> Result<Claim, NodeError> {
    let measured = largest_route_difference(second_routes)?.value;
    let allowed = second_routes.iter().try_fold(0.0, |all: f64, table| Ok(all.max(largest(table, "allowed")?)))?;
    Ok(claim(
        "routes_agree",
        "all conjugate times of this experiment",
        "Closed form and integration give the same conjugate times.",
        Evidence::Direct(Test::AtMost {
            measured,
            tolerance: allowed,
            reason: "what integration gives: f64, and double-double where f64 loses more than a tenth of this"
                .to_owned(),
        }),
        "",
    ))
}

/// Cases examined, and those that fail.
#[derive(Clone, Debug, Default)]
pub struct Cases {
    all: u64,
    faults: u64,
    example: String,
}

impl Cases {
    /// Cases in words, each with whether it holds.
    pub fn of(cases: impl IntoIterator<Item = (bool, String)>) -> Self {
        let mut all = Self::default();
        for (holds, words) in cases {
            all.add(!holds, || words);
        }
        all
    }

    /// One more case, and whether it fails; the words are kept of the first that does.
    pub fn add(&mut self, fault: bool, words: impl FnOnce() -> String) {
        self.all += 1;
        if fault {
            self.faults += 1;
            if self.example.is_empty() {
                self.example = words();
            }
        }
    }

    /// Whether nothing was examined.
    pub fn is_empty(&self) -> bool {
        self.all == 0
    }

    /// The test that none fails.
    pub fn test(self) -> Test {
        Test::None { counterexamples: self.faults, cases: self.all, example: self.example }
    }

    /// The claim that none fails.
    pub fn claim(self, id: &str, place: &str, statement: impl Into<String>, note: impl Into<String>) -> Claim {
        claim(id, place, statement, Evidence::Direct(self.test()), note)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: faults are counted among all cases, and the words of the first are kept.
    #[test]
    fn cases_keep_the_first_fault() {
        let words = |text: &str| text.to_owned();
        let mut cases = Cases::of([(true, words("right")), (false, words("first")), (false, words("second"))]);
        cases.add(true, || words("third"));
        assert!(!cases.is_empty() && Cases::default().is_empty());
        assert_eq!(cases.test(), Test::None { counterexamples: 3, cases: 4, example: words("first") });
        // Nothing examined proves nothing.
        assert!(!Cases::default().test().holds() && Cases::of([(true, String::new())]).test().holds());
    }
}
