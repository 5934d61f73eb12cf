//! The limit of conjugate points for `φ0 → 0`, extrapolated: no formula for the limit enters.
//!
//! `t1` and `θ` of the cusp are even analytic functions of `φ0`, so Neville's scheme in `x = φ0²` gives their values at `x = 0`.
//! Its weights grow by less than `Π 1/(1 − 4^(−j)) < 1.5` for starts halved each time, so rounding stays at a few ε. The error of
//! a row is the difference to the row before, and 4 ε.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, input_table, product};
use crate::table::Table;
use serde::Serialize;

/// The input: a table with columns `phi0`, `t1`, `theta`, rows towards `φ0 = 0`.
pub const INPUT: &str = "cusps";

/// The extrapolation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CuspLimit {}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-cusp-limit",
    summary: "the limit of conjugate points at the equator, extrapolated in φ0²",
    code: &["effects/serret_andoyer/cusp_limit.rs", "effects/product.rs", "table"],
    measurement: false,
};

/// The polynomial through the first `n` points, at zero, for every `n`.
fn extrapolated(x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut column = y.to_vec();
    let mut diagonal = Vec::with_capacity(y.len());
    for step in 0..y.len() {
        diagonal.push(column[0]);
        for i in 0..y.len() - 1 - step {
            let (left, right) = (x[i], x[i + step + 1]);
            column[i] = column[i + 1] + right * (column[i + 1] - column[i]) / (left - right);
        }
    }
    diagonal
}

fn errors(values: &[f64]) -> Vec<f64> {
    let before = std::iter::once(&0.0).chain(values);
    values.iter().zip(before).map(|(value, before)| (value - before).abs() + 4.0 * f64::EPSILON * value.abs()).collect()
}

impl Compute for CuspLimit {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let cusps = input_table(inputs, INPUT)?;
        let read = |name: &str| cusps.f64s(name).map_err(failed("extrapolation"));
        let (phi0, t1, theta) = (read("phi0")?, read("t1")?, read("theta")?);
        let x: Vec<f64> = phi0.iter().map(|phi0| phi0 * phi0).collect();
        if x.len() < 2 || x.windows(2).any(|pair| pair[1] >= pair[0]) {
            return Err(NodeError::new(format!("starts must tend to φ0 = 0, at least two: found {phi0:?}")));
        }
        let (t_limit, theta_limit) = (extrapolated(&x, t1), extrapolated(&x, theta));
        let table =
            Table::builder("cusp-limit", "limits at φ0 = 0 by Neville's scheme in φ0², from the rows up to this")
                .column("phi0", "length", "last start used", phi0)
                .column("t1", "length", "first conjugate time there", t1)
                .column("theta", "rad", "θ of the conjugate point there", theta)
                .column("t_error", "length", "error of t_limit", errors(&t_limit))
                .column("theta_error", "rad", "error of theta_limit", errors(&theta_limit))
                .column("t_limit", "length", "extrapolated conjugate time", t_limit)
                .column("theta_limit", "rad", "extrapolated θ", theta_limit)
                .build()
                .map_err(failed("extrapolation"))?;
        product(&table, Work::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: cos at 0 is 1; seven even powers leave (0.4)¹⁴/14!·… ≪ ε.
    #[test]
    fn an_even_function_is_extrapolated_to_rounding() {
        let phi: Vec<f64> = (0..7).map(|j| 0.4 / f64::from(1 << j)).collect();
        let x: Vec<f64> = phi.iter().map(|p| p * p).collect();
        let y: Vec<f64> = phi.iter().map(|p| libm::cos(*p)).collect();
        let limits = extrapolated(&x, &y);
        assert_eq!(limits[0], y[0]);
        // Rounding: weights below 1.5, at most 7 values with half an ε each.
        assert!((limits[6] - 1.0).abs() <= 3.0 * f64::EPSILON, "{limits:?}");
        assert!((limits[1] - 1.0).abs() > 1e-6, "two points cannot do that well");
    }
}
