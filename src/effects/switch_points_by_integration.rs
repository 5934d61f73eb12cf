//! The second route for the switch points of the spin problem: roots in k of the integrated lift.
//!
//! The closed form is not used: for each k the lift to R³ × so(3)* and its Jacobi column are integrated by power
//! series. A pole is passed where `r1` vanishes at the first zero of the Jacobi scalar; the equator where the Jacobi
//! scalar vanishes at the n-th zero of `r2` (there `t1(k)` has a vertical tangent, but this function of k has a simple
//! root). All in double-double: for `p_θ = 1e-4` and less, `r3` is of order `p_θ³` when the pole is passed, below what
//! `f64` holds. The first route's k is where the search starts: the function must change sign within [`HALF_BRACKET`]
//! of it.

use super::counted::integrated;
use super::product::{failed, input_table, product};
use super::switch_points::POLE;
use crate::contract::accuracy::{ARTICLE, Accuracy};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::geometry::spin::lift::{first_conjugate_time_by_integration, jacobi_scalar_at_crossing};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::roots::{RootTolerance, bracketed};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "switch-points-by-integration",
    summary: "the switch points as roots in k of the integrated lift, in double-double: the second route",
    code: &[
        "effects/switch_points_by_integration.rs",
        "effects/switch_points.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// The input: a table of kind `switch-points`.
pub const INPUT: &str = "switch-points";
/// Half the width, in k, within which the function must change sign.
pub const HALF_BRACKET: f64 = 1e-7;
/// Relative error of the integration's steps, in double-double.
const STEP_TOLERANCE: f64 = 1e-28;
/// Relative tolerance of the root in k: eight digits beyond `f64`.
const ROOT_TOLERANCE: f64 = 1e-24;
/// The integration runs this much longer than the first route's time.
const BEYOND: f64 = 1.05;

/// For levels above `article`: of the error asked for, what steps may make, and what is left of the root; the function must still change sign
/// within the bracket.
const ROUGH: (f64, f64) = (1e-6, 1e-5);

/// And the difference in k that is allowed then.
const ROUGH_ALLOWED: f64 = 1e-3;

/// The second route; it has no parameters unless less than full accuracy is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SwitchPointsByIntegration {
    /// The relative error asked for, where it is above that of `article`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub asked: Option<f64>,
}

impl SwitchPointsByIntegration {
    /// At an accuracy: in double-double at any.
    pub fn new(accuracy: Accuracy) -> Self {
        Self { asked: Some(accuracy.relative_error()).filter(|asked| *asked > ARTICLE) }
    }

    /// Relative errors of steps and of the root.
    fn tolerances(&self) -> (f64, f64) {
        self.asked.map_or((STEP_TOLERANCE, ROOT_TOLERANCE), |asked| {
            ((ROUGH.0 * asked).max(STEP_TOLERANCE), (ROUGH.1 * asked).max(ROOT_TOLERANCE))
        })
    }
}

struct Row {
    passage: String,
    index: i64,
    k: f64,
    root: DoubleDouble,
    residual: f64,
    work: Work,
}

impl Compute for SwitchPointsByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let first = input_table(inputs, INPUT)?;
        let unread = |error: crate::table::TableError| NodeError::new(error.to_string());
        let (p_theta, k, t1) = (
            first.f64s("p_theta").map_err(unread)?,
            first.f64s("k").map_err(unread)?,
            first.f64s("t1").map_err(unread)?,
        );
        let (passage, index) = (first.texts("passage").map_err(unread)?, first.ints("index").map_err(unread)?);
        let error = first.f64s("error").map_err(unread)?;
        let rough = self.asked.map_or(0.0, |asked| ROUGH_ALLOWED * asked);
        let allowed: Vec<f64> = error.iter().map(|error| error.max(rough)).collect();
        let rows = (0..first.rows())
            .into_par_iter()
            .map(|i| root(&passage[i], index[i], p_theta[i], (k[i], t1[i]), self.tolerances()))
            .collect::<Result<Vec<Row>, NodeError>>()?;
        let work = rows.iter().map(|row| row.work).sum();
        let numbers = |of: fn(&Row) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let table =
            Table::builder(KIND.name, "switch points by integration in double-double, beside the closed form's")
                .column("p_theta", "1", "p_θ at the start", p_theta)
                .column(
                    "passage",
                    "",
                    "what is passed: pole or equator",
                    rows.iter().map(|row| row.passage.clone()).collect::<Vec<_>>(),
                )
                .column("index", "1", "which passage", rows.iter().map(|row| row.index).collect::<Vec<_>>())
                .column("k", "1", "the value of k, rounded to f64", numbers(|row| row.root.to_f64()))
                .column(
                    "k_rest",
                    "1",
                    "what rounding left out: k + k_rest has some 24 digits",
                    numbers(|row| row.root.low()),
                )
                .column(
                    "residual",
                    "1",
                    "r1 at the conjugate point (pole), Jacobi scalar at the return (equator), at the closed form's k",
                    numbers(|row| row.residual),
                )
                .column(
                    "difference",
                    "1",
                    "|closed form − integration| in k",
                    numbers(|row| (DoubleDouble::from_f64(row.k) - row.root).abs().to_f64()),
                )
                .column("allowed", "1", "what the closed form's own error allows", allowed)
                .build()
                .map_err(failed("switch points by integration"))?;
        product(&table, work)
    }
}

fn root(
    passage: &str,
    index: i64,
    p_theta: f64,
    (k, t1): (f64, f64),
    (step_tolerance, root_tolerance): (f64, f64),
) -> Result<Row, NodeError> {
    let long = DoubleDouble::from_f64;
    let mut work = Work::default();
    let mut failure = None;
    let mut function = |k: DoubleDouble| -> DoubleDouble {
        let t_max = long(BEYOND * t1);
        let result = if passage == POLE {
            first_conjugate_time_by_integration(k, long(p_theta), step_tolerance, t_max)
                .map(|(point, w)| (point.r[0], w))
        } else {
            jacobi_scalar_at_crossing(k, long(p_theta), step_tolerance, t_max, usize::try_from(index).unwrap_or(0))
                .map(|(crossing, w)| (crossing.jacobi, w))
        };
        match result {
            Ok((value, w)) => {
                work += integrated(w);
                value
            }
            Err(error) => {
                failure = Some(error.to_string());
                long(f64::NAN)
            }
        }
    };
    let residual = function(long(k)).to_f64();
    let half = long(HALF_BRACKET);
    let tolerance = RootTolerance { relative: long(root_tolerance), absolute: long(0.0), max_evaluations: 200 };
    let found = bracketed(&mut function, long(k) - half, long(k) + half, tolerance);
    let doing = format!("p_theta = {p_theta:?}, {passage} {index} near k = {k:?}");
    match (found, failure) {
        (_, Some(failure)) => Err(NodeError::new(format!("{doing}: {failure}"))),
        (Err(error), None) => Err(NodeError::new(format!("{doing}: {error}"))),
        (Ok(root), None) => {
            work.roots_solved += 1;
            Ok(Row { passage: passage.to_owned(), index, k, root: root.x, residual, work })
        }
    }
}
