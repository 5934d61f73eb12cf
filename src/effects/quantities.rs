//! Tables of single numbers, each with its name, unit, error, meaning and route: what becomes a named value unchanged.
//!
//! Columns: `quantity`, `value`, `unit`, `error` (a bound on the absolute error), `meaning`, `route`.

use super::product::{failed, product};
use crate::contract::node::{NodeError, Product};
use crate::contract::work::Work;
use crate::table::Table;

/// Single numbers in the making.
#[derive(Clone, Debug)]
pub struct Quantities {
    name: String,
    meaning: String,
    numbers: Vec<(f64, f64)>,
    texts: [Vec<String>; 4],
}

impl Quantities {
    /// No numbers yet, for a table of this name and meaning.
    pub fn new(name: &str, meaning: &str) -> Self {
        Self { name: name.to_owned(), meaning: meaning.to_owned(), numbers: Vec::new(), texts: Default::default() }
    }

    /// Adds a number with a bound on its absolute error.
    pub fn add(&mut self, quantity: &str, (value, error): (f64, f64), unit: &str, meaning: &str, route: &str) {
        self.numbers.push((value, error));
        let texts = [quantity, unit, meaning, route];
        self.texts.iter_mut().zip(texts).for_each(|(column, text)| column.push(text.to_owned()));
    }

    /// The product of a node that makes this table.
    ///
    /// # Errors
    /// A number or an error that is not finite.
    pub fn product(self, work: Work) -> Result<Product, NodeError> {
        let [quantity, unit, meaning, route] = self.texts;
        let (values, errors): (Vec<f64>, Vec<f64>) = self.numbers.into_iter().unzip();
        let table = Table::builder(self.name, self.meaning)
            .column("quantity", "", "its name", quantity)
            .column("value", "see unit", "the number", values)
            .column("unit", "", "its unit", unit)
            .column("error", "see unit", "bound on its absolute error", errors)
            .column("meaning", "", "what it is", meaning)
            .column("route", "", "how it was computed", route)
            .build()
            .map_err(failed("quantities"))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_is_not_finite_is_refused() {
        let with = |value| {
            let mut quantities = Quantities::new("limits", "test");
            quantities.add("t_star", (value, 1e-15), "time", "a time", "formula");
            quantities.product(Work::default())
        };
        assert_eq!(with(1.0).expect("a table").work.rows, 1);
        assert!(with(f64::NAN).is_err());
    }
}
