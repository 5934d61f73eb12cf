//! The cut locus of the spin problem by integration: the second route beside the closed form, row by row of its table.
//!
//! The lift of the flow to R³ × so(3)* ([`crate::geometry::spin::lift`]) without any Jacobi column, until `r2 = 0` first. Of the first route it takes the
//! starts, how long to integrate before giving up, and the time to compare with. A row whose f64 time differs by more than a tenth of what is allowed is
//! integrated again in double-double, and that is what counts: near the meridian, for k < 1, rounding grows like `e^(π√(1/k²−1))`.

use super::by_integration::{DOUBLE_DOUBLE_TOLERANCE, allowed, tolerance};
use super::chart::distance;
use crate::contract::accuracy::{Accuracy, Arithmetic};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::of_tolerance;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::spin::lift::equator_crossings;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The input: a table of kind `spin-cut-locus`.
pub const INPUT: &str = "locus";
/// The part of the allowed difference beyond which a row is integrated again.
const TENTH: f64 = 0.1;
/// How much longer than the first route's time is integrated.
const BEYOND: f64 = 1.25;

/// The second route of a cut locus.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CutLocusByIntegration {
    /// The ratio of the couplings.
    pub k: f64,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest relative difference of t that is allowed.
    pub allowed: f64,
}

impl CutLocusByIntegration {
    /// At an accuracy.
    pub fn new(k: f64, accuracy: Accuracy) -> Self {
        Self { k, tolerance: tolerance(accuracy), allowed: allowed(accuracy) }
    }
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-cut-locus-by-integration",
    summary: "first returns to the equator of the spin problem by integrating the lift: the second route",
    code: &[
        "effects/spin/cut_locus_by_integration.rs",
        "effects/spin/by_integration.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/spin/starts.rs",
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
    t: f64,
    r: [f64; 3],
    double_double: bool,
    work: Work,
}

fn first_return<S: Real>(k: f64, p_theta: f64, t_max: f64, tolerance: f64) -> Result<Row, NodeError> {
    let doing = format!("k = {k:?}, p_theta = {p_theta:?}");
    let (found, work) = equator_crossings(S::from_f64(k), S::from_f64(p_theta), tolerance, S::from_f64(t_max), 1)
        .map_err(failed(&doing))?;
    let first = found.first().ok_or_else(|| NodeError::new(format!("{doing}: no return up to t = {t_max:?}")))?;
    Ok(Row { t: first.time.to_f64(), r: first.r.map(S::to_f64), double_double: false, work: integrated(work) })
}

impl CutLocusByIntegration {
    fn row(&self, p_theta: f64, t: f64) -> Result<Row, NodeError> {
        if of_tolerance(self.tolerance) == Arithmetic::DoubleDouble {
            let row = first_return::<DoubleDouble>(self.k, p_theta, BEYOND * t, self.tolerance)?;
            return Ok(Row { double_double: true, ..row });
        }
        let row = first_return::<f64>(self.k, p_theta, BEYOND * t, self.tolerance)?;
        if (row.t / t - 1.0).abs() <= TENTH * self.allowed {
            return Ok(row);
        }
        let again = first_return::<DoubleDouble>(self.k, p_theta, BEYOND * t, DOUBLE_DOUBLE_TOLERANCE)?;
        Ok(Row { double_double: true, work: row.work + again.work, ..again })
    }
}

impl Compute for CutLocusByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let locus = input_table(inputs, INPUT)?;
        let column = |name: &str| locus.f64s(name).map_err(failed("second route"));
        let (p_theta, t, error) = (column("p_theta")?, column("t")?, column("error")?);
        let (r1, r3) = (column("r1")?, column("r3")?);
        let rows = p_theta.par_iter().zip(t).map(|(p, t)| self.row(*p, *t)).collect::<Result<Vec<Row>, NodeError>>()?;
        let work: Work = rows.iter().map(|row| row.work).sum();
        let difference: Vec<f64> = rows.iter().zip(t).map(|(row, t)| (row.t / t - 1.0).abs()).collect();
        let distance: Vec<f64> = rows.iter().enumerate().map(|(i, row)| distance(row.r, [r1[i], 0.0, r3[i]])).collect();
        let allowed: Vec<f64> = error.iter().map(|error| error.max(self.allowed)).collect();
        let long: Vec<bool> = rows.iter().map(|row| row.double_double).collect();
        let table =
            Table::builder("spin-cut-locus-by-integration", "first returns to the equator by integrating the lift")
                .column("p_theta", "1", "p_θ(0)", p_theta)
                .column("t", "time", "first return to the equator", rows.iter().map(|row| row.t).collect::<Vec<_>>())
                .column("t_difference", "1", "relative difference of t to the closed form", difference)
                .column("distance", "1", "distance of the point in R³ to the closed form's", distance)
                .column("allowed", "1", "largest relative difference of t that is allowed", allowed)
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
    use crate::effects::spin::cut_locus::CutLocus;
    use crate::effects::spin::momenta::Momenta;

    /// No row differs by more than is allowed, for every k of Figs. 5, 7 and 8; the base flow alone is integrated.
    #[test]
    fn both_routes_agree_row_by_row() {
        let p_theta = Momenta { from: 1e-9, to: 1e4, step: 0.2 };
        for k in [0.1, 0.2, 0.5, 0.8, 1.0, 1.1, 1.2, 1.4] {
            let first = CutLocus { k, p_theta: p_theta.into() }.run(&Inputs::default()).unwrap();
            let mut inputs = Inputs::default();
            let artifact = &first.artifacts[0];
            inputs.insert(INPUT, InputFile { bytes: artifact.bytes(&[]).unwrap(), logical: artifact.logical });
            let second = CutLocusByIntegration::new(k, Accuracy::Article).run(&inputs).unwrap();
            assert_eq!((second.work.tangent_evaluations, second.work.state_dimension), (0, 6));
            let table = Table::from_parquet(&second.artifacts[0].bytes(&[]).unwrap()).unwrap();
            let column = |name: &str| table.f64s(name).unwrap();
            let long = table.bools("double_double").unwrap().iter().filter(|long| **long).count();
            let largest = |name: &str| column(name).iter().copied().fold(0.0, f64::max);
            println!(
                "k = {k}: {} rows, {long} long, {:e}, {:e}",
                table.rows(),
                largest("t_difference"),
                largest("distance")
            );
            for i in 0..table.rows() {
                assert!(column("t_difference")[i] <= column("allowed")[i], "k = {k}, p = {}", column("p_theta")[i]);
                // The point moves with t by the speed 1 to 1/k times; t ≤ π max(1, k).
                assert!(column("distance")[i] <= 5.0 / k.min(1.0) * column("allowed")[i], "k = {k}");
            }
        }
    }

    #[test]
    fn all_code_is_declared() {
        assert_eq!(undeclared(&KIND), Ok(vec![]));
        assert_eq!(undeclared(&crate::effects::spin::cut_locus::KIND), Ok(vec![]));
    }
}
