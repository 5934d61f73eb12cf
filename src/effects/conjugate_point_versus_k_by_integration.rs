//! The second route for first conjugate points of the spin problem as a function of k: the lift, integrated.
//!
//! Each row of the first route is computed again by power-series integration of the lift to R³ × so(3)* with its Jacobi
//! column, [`crate::geometry::spin::lift`]; the closed form's time only says how far to integrate. In `f64` where the
//! first route's own error shows a well-conditioned time and the integration bears it out; else, next to a vertical tangent of `t1(k)` (equator
//! crossings), where rounding of the integration is multiplied by the condition, in double-double. Allowed is a hundred
//! times the accuracy asked for (1e-12 for the article's level), or the first route's own error bound where that is
//! larger.

use super::arithmetic::{ROUNDED_TWICE, of_tolerance};
use super::counted::integrated;
use super::product::{failed, input_table, product};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::geometry::spin::lift::first_conjugate_time_by_integration;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::{Table, TableError};
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "conjugate-point-versus-k-by-integration",
    summary: "the same first conjugate points by integrating the lift: the second route",
    code: &[
        "effects/conjugate_point_versus_k_by_integration.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// The input: a table of kind `conjugate-point-versus-k`.
pub const INPUT: &str = "conjugate-point-versus-k";
/// Rows whose first route claims less than this relative error are integrated in `f64`: their condition is below some
/// 5.
const WELL_CONDITIONED: f64 = 8e-15;
/// From this error asked for on, f64 with the smallest steps does for the others: at a triple root the cube root of its ε is below a hundred times this.
const ROUGH: f64 = 1e-7;
/// Allowed difference in units of the accuracy asked for: the integration multiplies a step's error by the number of
/// steps and by the condition.
const ALLOWED: f64 = 100.0;
/// The integration runs this much longer than the first route's time.
const BEYOND: f64 = 1.05;

/// The second route.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugatePointVersusKByIntegration {
    /// Relative error of the integration's steps; below the ε of f64 in double-double.
    pub accuracy: f64,
}

struct Row {
    t1: f64,
    r: [f64; 3],
    long: bool,
    work: Work,
}

impl Compute for ConjugatePointVersusKByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let first = input_table(inputs, INPUT)?;
        let column = |name: &str| first.f64s(name).map_err(|error: TableError| NodeError::new(error.to_string()));
        let (k, p_theta, t1, error) = (column("k")?, column("p_theta")?, column("t1")?, column("error")?);
        let (r1, r2, r3) = (column("r1")?, column("r2")?, column("r3")?);
        let rows = (0..first.rows())
            .into_par_iter()
            .map(|i| row(k[i], p_theta[i], t1[i], error[i], self.accuracy))
            .collect::<Result<Vec<Row>, NodeError>>()?;
        let work = rows.iter().map(|row| row.work).sum();
        let difference: Vec<f64> = rows.iter().zip(t1).map(|(row, t1)| (row.t1 / t1 - 1.0).abs()).collect();
        let apart = |(i, row): (usize, &Row)| {
            let [d1, d2, d3] = [row.r[0] - r1[i], row.r[1] - r2[i], row.r[2] - r3[i]];
            (d1 * d1 + d2 * d2 + d3 * d3).sqrt()
        };
        let positions: Vec<f64> = rows.iter().enumerate().map(apart).collect();
        let allowed: Vec<f64> =
            error.iter().map(|error| error.max(ALLOWED * self.accuracy).max(ROUNDED_TWICE)).collect();
        let table =
            Table::builder(KIND.name, "first conjugate times and points by integration, beside the closed form's")
                .column("k", "1", "ratio of the couplings", k)
                .column(
                    "t1",
                    "time",
                    "first conjugate time by integration",
                    rows.iter().map(|row| row.t1).collect::<Vec<_>>(),
                )
                .column("t1_difference", "1", "relative difference of t1 to the closed form", difference)
                .column("position_difference", "1", "distance of the two points", positions)
                .column("allowed", "1", "largest difference accepted for t1", allowed)
                .column(
                    "double_double",
                    "",
                    "whether double-double was needed",
                    rows.iter().map(|row| row.long).collect::<Vec<_>>(),
                )
                .build()
                .map_err(failed("second route"))?;
        product(&table, work)
    }
}

fn row(k: f64, p_theta: f64, t1: f64, error: f64, accuracy: f64) -> Result<Row, NodeError> {
    let doing = format!("k = {k:?}, p_theta = {p_theta:?}");
    let mut before = Work::default();
    if of_tolerance(accuracy) == Arithmetic::F64 && error <= WELL_CONDITIONED {
        let (point, work) =
            first_conjugate_time_by_integration(k, p_theta, accuracy, BEYOND * t1).map_err(failed(&doing))?;
        // Next to a vertical tangent the first route went on in double-double by itself, and its error does not show the condition.
        if (point.t1 / t1 - 1.0).abs() <= error.max(ALLOWED * accuracy) {
            return Ok(Row { t1: point.t1, r: point.r, long: false, work: integrated(work) });
        }
        before = integrated(work);
    }
    if accuracy >= ROUGH {
        let (point, work) =
            first_conjugate_time_by_integration(k, p_theta, f64::EPSILON, BEYOND * t1).map_err(failed(&doing))?;
        return Ok(Row { t1: point.t1, r: point.r, long: false, work: integrated(work) });
    }
    let long = DoubleDouble::from_f64;
    let steps = match of_tolerance(accuracy) {
        Arithmetic::F64 => accuracy * f64::EPSILON,
        Arithmetic::DoubleDouble => accuracy,
    };
    let (point, work) = first_conjugate_time_by_integration(long(k), long(p_theta), steps, long(BEYOND * t1))
        .map_err(failed(&doing))?;
    before += integrated(work);
    Ok(Row { t1: point.t1.to_f64(), r: point.r.map(Real::to_f64), long: true, work: before })
}
