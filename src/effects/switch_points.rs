//! The values of k at which the first conjugate point of the spin problem passes a pole or the equator (section 5.2.1).
//!
//! Closed form, [`crate::geometry::spin::switch_points`]: a pole is passed where `r1(t1) = 0` (the article's k1, k2,
//! k3), the equator where the n-th return to it is conjugate (k̄ and its successors). k has no unit; times are in the
//! unit that `H = 1` fixes. Not known here: names and what figures do with the values.

use super::product::{failed, product};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::geometry::spin::switch_points::{Passage, SwitchPoint, switch_points, switch_points_to_reference};
use crate::table::Table;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "switch-points",
    summary: "values of k at which the first conjugate point passes a pole or the equator, in closed form",
    code: &["effects/switch_points.rs", "effects/product.rs", "geometry/spin", "numerics", "table"],
    measurement: false,
};
/// The text of [`Passage::Pole`] in tables.
pub const POLE: &str = "pole";
/// The text of [`Passage::Equator`] in tables.
pub const EQUATOR: &str = "equator";

/// The switch points of one `p_θ` in a range of k.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SwitchPoints {
    /// `p_θ(0)`; `p_φ(0) = −2`.
    pub p_theta: f64,
    /// Lower end of the range, above 0.
    pub k_low: f64,
    /// Upper end of the range.
    pub k_high: f64,
}

impl Compute for SwitchPoints {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, _: &Inputs) -> Result<Product, NodeError> {
        let Self { p_theta, k_low, k_high } = *self;
        let mut found: Vec<SwitchPoint> = Vec::new();
        for passage in [Passage::Pole, Passage::Equator] {
            let doing = format!("p_theta = {p_theta:?}, k from {k_low:?} to {k_high:?}, {}", passage_name(passage));
            let switches = match arithmetic {
                Arithmetic::F64 => switch_points(passage, p_theta, k_low, k_high),
                Arithmetic::DoubleDouble => switch_points_to_reference(passage, p_theta, k_low, k_high),
            };
            found.extend(switches.map_err(failed(&doing))?);
        }
        found.sort_by(|a, b| a.k.total_cmp(&b.k));
        let solved: u64 = found.iter().map(|switch| u64::from(switch.solutions)).sum();
        let numbers = |of: fn(&SwitchPoint) -> f64| found.iter().map(of).collect::<Vec<f64>>();
        let table =
            Table::builder(KIND.name, "values of k at which the first conjugate point passes a pole or the equator")
                .column("p_theta", "1", "p_θ at the start", vec![p_theta; found.len()])
                .column("passage", "", "what is passed: pole or equator", names(&found))
                .column(
                    "index",
                    "1",
                    "pole: r1 vanishes after index + 1/2 half turns; equator: the return that is conjugate",
                    indices(&found),
                )
                .column("k", "1", "the value of k", numbers(|switch| switch.k))
                .column("error", "1", "bound on the absolute error of k", numbers(|switch| switch.error))
                .column("t1", "time", "first conjugate time there", numbers(|switch| switch.t1))
                .column("limit", "1", "k in the limit p_θ → 0, algebraic", numbers(|switch| switch.meridian_limit))
                .build()
                .map_err(failed("switch points"))?;
        product(&table, Work { roots_solved: solved, ..Work::default() })
    }
}

/// The text of a passage in tables.
pub fn passage_name(passage: Passage) -> &'static str {
    match passage {
        Passage::Pole => POLE,
        Passage::Equator => EQUATOR,
    }
}

fn names(found: &[SwitchPoint]) -> Vec<&'static str> {
    found.iter().map(|switch| passage_name(switch.passage)).collect()
}

fn indices(found: &[SwitchPoint]) -> Vec<i64> {
    found.iter().map(|switch| i64::from(switch.index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The order along k, and an empty range: below k = 1 nothing is passed.
    #[test]
    fn poles_and_equator_alternate() {
        let run = |k_low, k_high| {
            let product = SwitchPoints { p_theta: 1e-4, k_low, k_high }.run(&Inputs::default()).unwrap();
            (Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap(), product.work)
        };
        let (table, work) = run(1.0, 1.5);
        assert_eq!(table.texts("passage").unwrap(), &["pole", "equator", "pole", "equator", "pole"]);
        assert_eq!(table.ints("index").unwrap(), &[1, 2, 2, 3, 3]);
        assert!(work.roots_solved > 100 && work.elliptic_calls == 0);
        assert_eq!(run(0.5, 1.0).0.rows(), 0);
        assert!(SwitchPoints { p_theta: 1e-4, k_low: 0.0, k_high: 1.0 }.run(&Inputs::default()).is_err());
    }
}
