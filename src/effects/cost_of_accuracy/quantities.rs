//! Single numbers from the table of achieved errors: errors at the tightest request, work at an equal error, orders seen.
//!
//! Methods are compared at equal *achieved* error, never at equal request: one may give more digits than it is asked for. Between two requests the
//! logarithm of the work is interpolated linearly in the logarithm of the largest error. The order seen is minus the slope of the
//! logarithm of the median error over that of the number of steps, by least squares: part of the work does not grow with accuracy. All of it is arithmetic on counts and errors of a table.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, input_table};
use crate::effects::quantities::Quantities;
use crate::table::{Table, TableError};
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "cost-of-accuracy-quantities",
    summary: "errors at the tightest request, work at equal error, orders seen, from a table of achieved errors",
    code: &["effects/cost_of_accuracy/quantities.rs", "effects/product.rs", "effects/quantities.rs", "table"],
    measurement: false,
};
/// The input: a table of achieved errors.
pub const INPUT: &str = "cost-of-accuracy";

/// Errors between which orders are seen: above, steps are a large part of the solution's own scale, and the first term of the error does not lead;
/// below, rounding does.
const ORDER_FROM: f64 = 1e-8;
const ORDER_TO: f64 = 1e-15;
/// Fewest requests between these for an order.
const FEWEST: usize = 4;
/// Rounding of logarithms and of what is made of them, relatively.
const ROUNDING: f64 = 1e-13;

/// The numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CostOfAccuracyQuantities {
    /// The achieved error at which work is compared.
    pub equal_error: f64,
}

/// One method's rows: request, median and largest error, multiplications and steps per start.
struct Method {
    name: String,
    rows: Vec<[f64; 5]>,
}

fn methods(table: &Table) -> Result<Vec<Method>, TableError> {
    let (names, asked) = (table.texts("method")?, table.f64s("asked")?);
    let (median, largest) = (table.f64s("median_error")?, table.f64s("largest_error")?);
    let (work, steps) = (table.numbers("multiplications")?, table.numbers("steps")?);
    let starts = table.numbers("starts")?;
    let mut methods: Vec<Method> = Vec::new();
    for i in 0..table.rows() {
        let row = [asked[i], median[i], largest[i], work[i] / starts[i], steps[i] / starts[i]];
        match methods.last_mut().filter(|method| method.name == names[i]) {
            Some(method) => method.rows.push(row),
            None => methods.push(Method { name: names[i].clone(), rows: vec![row] }),
        }
    }
    Ok(methods)
}

impl Method {
    /// Multiplications per start at this largest error, between two requests; none outside of them.
    fn work_at(&self, error: f64) -> Option<f64> {
        let pair = self.rows.windows(2).find(|pair| pair[0][2] >= error && pair[1][2] <= error)?;
        let [looser, tighter] = [pair[0], pair[1]].map(|row| [libm::log(row[2]), libm::log(row[3])]);
        let width = tighter[0] - looser[0];
        let part = if width < 0.0 { (libm::log(error) - looser[0]) / width } else { 0.0 };
        Some(libm::exp(looser[1] + part * (tighter[1] - looser[1])))
    }

    /// The order seen.
    fn order(&self) -> Option<f64> {
        let seen = self.rows.iter().filter(|row| (ORDER_TO..=ORDER_FROM).contains(&row[1]));
        let points: Vec<[f64; 2]> = seen.map(|row| [libm::log(row[4]), libm::log(row[1])]).collect();
        let count = points.len() as f64;
        let mean = |i: usize| points.iter().map(|point| point[i]).sum::<f64>() / count;
        let (steps, error) = (mean(0), mean(1));
        let product = |i: usize, of: f64| points.iter().map(|point| (point[0] - steps) * (point[i] - of)).sum::<f64>();
        let spread = product(0, steps);
        (points.len() >= FEWEST && spread > 0.0).then(|| -product(1, error) / spread)
    }
}

impl Compute for CostOfAccuracyQuantities {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let table = input_table(inputs, INPUT)?;
        let methods = methods(&table).map_err(failed("achieved errors"))?;
        let apart = table.f64s("reference_difference").map_err(failed("achieved errors"))?;
        let apart = apart.first().copied().unwrap_or_default();
        let mut quantities = Quantities::new("cost-of-accuracy-quantities", "what accuracy costs, in single numbers");
        let route = "counted, against double-double";
        for method in &methods {
            let name = method.name.replace('-', "_");
            if let Some([asked, _, largest, work, _]) = method.rows.last().copied() {
                let meaning = format!("largest relative error of {}, asked for {asked:e}", method.name);
                quantities.add(&format!("{name}_error"), (largest, apart), "1", &meaning, route);
                if method.rows.len() == 1 {
                    let meaning = format!("multiplications per conjugate time, {}", method.name);
                    quantities.add(&format!("{name}_work"), (work, f64::EPSILON * work), "1", &meaning, route);
                }
            }
            if let Some(work) = method.work_at(self.equal_error) {
                let meaning = format!(
                    "multiplications per conjugate time for a largest error of {:e}, {}, between requests",
                    self.equal_error, method.name
                );
                quantities.add(&format!("{name}_work"), (work, ROUNDING * work), "1", &meaning, route);
            }
            // The order of a power series grows with the request.
            if !name.starts_with("taylor")
                && let Some(order) = method.order()
            {
                let meaning =
                    format!("power of the number of steps with which the median error of {} falls", method.name);
                quantities.add(&format!("{name}_order"), (order, ROUNDING * order), "1", &meaning, route);
            }
        }
        let meaning = "largest relative difference of the reference to its second route, both in double-double";
        quantities.add("reference_difference", (apart, f64::EPSILON * apart), "1", meaning, "double-double");
        quantities.product(Work::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a method whose error is steps to the power −8 exactly, ten multiplications each, in powers of ten.
    #[test]
    fn orders_and_work_between_requests_are_those_of_a_power_law() {
        let row = |n: i32| {
            let error = libm::pow(10.0, f64::from(-n));
            let steps = libm::pow(error, -0.125);
            [error, 0.5 * error, error, 10.0 * steps, steps]
        };
        let method = Method { name: "power".to_owned(), rows: (3..=15).map(row).collect() };
        assert!((method.order().unwrap() - 8.0).abs() < 1e-12);
        // Between 1e-9 and 1e-10, in the middle of the logarithms.
        let error = libm::pow(10.0, -9.5);
        assert!((method.work_at(error).unwrap() / (10.0 * libm::pow(error, -0.125)) - 1.0).abs() < 1e-13);
        assert!(method.work_at(0.1).is_none() && method.work_at(1e-17).is_none());
        let short = Method { name: "power".to_owned(), rows: (3..=7).map(row).collect() };
        assert!(short.order().is_none());
    }
}
