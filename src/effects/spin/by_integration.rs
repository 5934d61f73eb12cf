//! The conjugate locus by integration: the second route beside the closed form, row by row of its table.
//!
//! The lift of the flow to R³ × so(3)* with one Jacobi column ([`crate::geometry::spin::lift`]), until `J = −r·δh` vanishes first.
//! Of the first route it takes the starts and, from `t1`, how long to integrate before giving up and how many digits it needs.
//!
//! **What f64 can give, and where more is needed.** For k < 1 and p_θ → 0 an extremal passes the unstable meridian twice, with
//! its momentum known from `G² = 4 + p_θ²` alone; for k > 1 the conjugate time has vertical tangents. Rounding is then multiplied, by
//! [`rounding`]'s estimate; where that is above a tenth of what is allowed, the row is integrated in double-double arithmetic.
//!
//! **Allowed** is 1e-12 relative (for lower accuracies a hundred times the error asked for), or the closed form's own error bound where that
//! is larger: next to a vertical tangent `t1` itself, as a function of the rounded inputs, is not known better in f64.

use super::branch::{rounding, slopes};
use super::chart::distance;
use crate::contract::accuracy::{ARTICLE, Accuracy, Arithmetic};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::{ROUNDED_TWICE, long_tolerance, of_tolerance};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::spin::lift::first_conjugate_time_by_integration;
use crate::numerics::counts;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The input: a table of kind `spin-conjugate-locus`.
pub const INPUT: &str = "locus";
/// Largest relative difference of the two routes that is allowed at full accuracy.
const ALLOWED: f64 = 1e-12;
/// The same for lower accuracies, in units of the error asked for per step.
const ALLOWED_PER_ASKED: f64 = 100.0;
/// Of what is allowed, the part that rounding in f64 may take.
const SHARE: f64 = 0.1;
/// Relative error per step in double-double. Errors grow by `1/p_θ²` at most where that matters, p_θ > 1e-8 for k ≥ 0.1; the
/// scale of small momenta is their own.
pub const DOUBLE_DOUBLE_TOLERANCE: f64 = 1e-22;
/// How much longer than the first route's time is integrated.
const BEYOND: f64 = 1.25;

/// The second route of a locus.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugateLocusByIntegration {
    /// The ratio of the couplings.
    pub k: f64,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest relative difference of t1 that is allowed.
    pub allowed: f64,
}

/// The relative error per step that an accuracy asks for: f64's own for `article`, less than that where it takes double-double.
pub fn tolerance(accuracy: Accuracy) -> f64 {
    let asked = accuracy.relative_error();
    long_tolerance(accuracy).unwrap_or(if asked <= ARTICLE { f64::EPSILON } else { asked })
}

/// The largest relative difference of the routes that an accuracy allows.
pub fn allowed(accuracy: Accuracy) -> f64 {
    match accuracy.arithmetic() {
        Arithmetic::F64 => ALLOWED.max(ALLOWED_PER_ASKED * tolerance(accuracy)),
        Arithmetic::DoubleDouble => ROUNDED_TWICE.max(ALLOWED_PER_ASKED * accuracy.relative_error()),
    }
}

impl ConjugateLocusByIntegration {
    /// At an accuracy.
    pub fn new(k: f64, accuracy: Accuracy) -> Self {
        Self { k, tolerance: tolerance(accuracy), allowed: allowed(accuracy) }
    }
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-conjugate-locus-by-integration",
    summary: "first conjugate points of the spin problem by integrating the lift with a Jacobi column: the second route",
    code: &[
        "effects/spin/by_integration.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

struct Row {
    t1: f64,
    r: [f64; 3],
    double_double: bool,
    work: counts::Work,
}

/// The first conjugate time and point in the scalar `S`, rounded to f64.
fn integrate<S: Real>(k: f64, p_theta: f64, t_max: f64, tolerance: f64) -> Result<Row, NodeError> {
    let (k, p, end) = (S::from_f64(k), S::from_f64(p_theta), S::from_f64(t_max));
    let doing = format!("k = {:?}, p_theta = {p_theta:?}", k.to_f64());
    let (found, work) = first_conjugate_time_by_integration(k, p, tolerance, end).map_err(failed(&doing))?;
    Ok(Row { t1: found.t1.to_f64(), r: found.r.map(S::to_f64), double_double: false, work })
}

impl ConjugateLocusByIntegration {
    fn row(&self, p_theta: f64, t1: f64, slope: f64) -> Result<Row, NodeError> {
        let t_max = BEYOND * t1;
        let mut before = counts::Work::default();
        if of_tolerance(self.tolerance) == Arithmetic::DoubleDouble {
            let row = integrate::<DoubleDouble>(self.k, p_theta, t_max, self.tolerance)?;
            return Ok(Row { double_double: true, ..row });
        }
        if rounding(p_theta, slope) <= SHARE * self.allowed {
            // Below full accuracy what an extremal near the meridian multiplies is the error of steps: then smaller steps do.
            let full = (self.tolerance > f64::EPSILON).then_some(f64::EPSILON);
            for tolerance in [Some(self.tolerance), full].into_iter().flatten() {
                let row = match integrate::<f64>(self.k, p_theta, t_max, tolerance) {
                    Err(_) if tolerance > f64::EPSILON => continue,
                    row => row?,
                };
                // Between the few starts of a list secants tell little about slopes: what rounding did there is seen here.
                if (row.t1 / t1 - 1.0).abs() <= self.allowed {
                    return Ok(Row { work: before.plus(row.work), ..row });
                }
                before = before.plus(row.work);
            }
        }
        let row = integrate::<DoubleDouble>(self.k, p_theta, t_max, DOUBLE_DOUBLE_TOLERANCE)?;
        Ok(Row { double_double: true, work: before.plus(row.work), ..row })
    }
}

impl Compute for ConjugateLocusByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let locus = input_table(inputs, INPUT)?;
        let column = |name: &str| locus.f64s(name).map_err(failed("second route"));
        let (p_theta, t1, error) = (column("p_theta")?, column("t1")?, column("error")?);
        let r = [column("r1")?, column("r2")?, column("r3")?];
        let slopes = slopes(p_theta, t1);
        let rows = (0..locus.rows())
            .into_par_iter()
            .map(|i| self.row(p_theta[i], t1[i], slopes[i]))
            .collect::<Result<Vec<Row>, NodeError>>()?;
        let work: Work = rows.iter().map(|row| integrated(row.work)).sum();
        let difference: Vec<f64> = rows.iter().zip(t1).map(|(row, t1)| (row.t1 / t1 - 1.0).abs()).collect();
        let distance = |(i, row): (usize, &Row)| distance(row.r, [0, 1, 2].map(|c| r[c][i]));
        let distance: Vec<f64> = rows.iter().enumerate().map(distance).collect();
        let allowed: Vec<f64> = error.iter().map(|error| error.max(self.allowed)).collect();
        let long: Vec<bool> = rows.iter().map(|row| row.double_double).collect();
        let table =
            Table::builder("spin-conjugate-locus-by-integration", "first conjugate times by integrating the lift")
                .column("p_theta", "1", "p_θ(0)", p_theta)
                .column("t1", "time", "first conjugate time", rows.iter().map(|row| row.t1).collect::<Vec<_>>())
                .column("t1_difference", "1", "relative difference of t1 to the closed form", difference)
                .column("distance", "1", "distance of the point in R³ to the closed form's", distance)
                .column("allowed", "1", "largest relative difference of t1 that is allowed", allowed)
                .column("double_double", "", "integrated with 106 bits", long)
                .build()
                .map_err(failed("second route"))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::code::undeclared;
    use crate::contract::node::InputFile;
    use crate::effects::spin::conjugate_locus::ConjugateLocus;
    use crate::effects::spin::momenta::Momenta;

    /// Every k of Figs. 5, 7 and 8: no row differs by more than is allowed, and f64 is used where it is enough.
    #[test]
    fn both_routes_agree_row_by_row() {
        let p_theta = Momenta { from: 1e-9, to: 1e4, step: 0.2 };
        for k in [0.1, 0.2, 0.5, 0.8, 1.0, 1.05, 1.1, 1.15, 1.18, 1.2, 1.3, 1.4] {
            let first = ConjugateLocus { k, p_theta: p_theta.into() }.run(&Inputs::default()).unwrap();
            let mut inputs = Inputs::default();
            let artifact = &first.artifacts[0];
            inputs.insert(INPUT, InputFile { bytes: artifact.bytes(&[]).unwrap(), logical: artifact.logical });
            let second = ConjugateLocusByIntegration::new(k, Accuracy::Article).run(&inputs).unwrap();
            let table = Table::from_parquet(&second.artifacts[0].bytes(&[]).unwrap()).unwrap();
            let column = |name: &str| table.f64s(name).unwrap();
            let long = table.bools("double_double").unwrap().iter().filter(|long| **long).count();
            let largest = |name: &str| column(name).iter().copied().fold(0.0, f64::max);
            println!(
                "k = {k}: {} rows, {long} long, {:e}, {:e}",
                table.rows(),
                largest("t1_difference"),
                largest("allowed")
            );
            for i in 0..table.rows() {
                assert!(column("t1_difference")[i] <= column("allowed")[i], "k = {k}, p = {}", column("p_theta")[i]);
                // The point moves with t1 by the speed 1 to 1/k times; t1 < 16.
                assert!(column("distance")[i] <= 16.0 / k.min(1.0) * column("allowed")[i]);
            }
            assert!(if k < 0.3 { long < 110 } else { long < 12 }, "{long}");
        }
    }

    #[test]
    fn all_code_is_declared() {
        assert_eq!(undeclared(&KIND), Ok(vec![]));
        assert_eq!(undeclared(&crate::effects::spin::conjugate_locus::KIND), Ok(vec![]));
        assert_eq!(undeclared(&crate::effects::spin::geodesics::KIND), Ok(vec![]));
    }
}
