//! A wave front of the spin problem by integration: the second route beside the closed form, row by row of its table.
//!
//! The base flow of the lift to R³ × so(3)* ([`crate::geometry::spin::lift`]) up to the front's time, from the first route's momenta. A row whose f64 point is
//! farther from the closed form's than a tenth of what is allowed is integrated again in double-double, and that is what counts.

use super::by_integration::{DOUBLE_DOUBLE_TOLERANCE, allowed, tolerance};
use super::chart::distance;
use crate::contract::accuracy::{Accuracy, Arithmetic};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::of_tolerance;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::spin::lift::trajectory;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The input: a table of kind `spin-wave-front`.
pub const INPUT: &str = "front";
/// The part of the allowed distance beyond which a row is integrated again.
const TENTH: f64 = 0.1;

/// The second route of a front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WaveFrontByIntegration {
    /// The ratio of the couplings.
    pub k: f64,
    /// The time.
    pub t: f64,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest distance in R³ that is allowed.
    pub allowed: f64,
}

impl WaveFrontByIntegration {
    /// At an accuracy. The closed form loses a few ε of `1 + λ(t)`, λ ~ `p_θ t/2`: below 1e-12 for all momenta of a front.
    pub fn new(k: f64, t: f64, accuracy: Accuracy) -> Self {
        Self { k, t, tolerance: tolerance(accuracy), allowed: allowed(accuracy) }
    }
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-wave-front-by-integration",
    summary: "points of a wave front of the spin problem by integrating the lift: the second route",
    code: &[
        "effects/spin/wave_front_by_integration.rs",
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
    distance: f64,
    double_double: bool,
    work: Work,
}

impl WaveFrontByIntegration {
    fn point<S: Real>(&self, p_theta: f64, r: [f64; 3], tolerance: f64) -> Result<Row, NodeError> {
        let (k, p, t) = (S::from_f64(self.k), S::from_f64(p_theta), S::from_f64(self.t));
        let doing = format!("k = {:?}, p_theta = {p_theta:?}, t = {:?}", self.k, self.t);
        let (points, work) = trajectory(k, p, &[t], tolerance).map_err(failed(&doing))?;
        let found = points.first().ok_or_else(|| NodeError::new(format!("{doing}: no point")))?.map(S::to_f64);
        Ok(Row { distance: distance(found, r), double_double: false, work: integrated(work) })
    }

    fn row(&self, p_theta: f64, r: [f64; 3]) -> Result<Row, NodeError> {
        if of_tolerance(self.tolerance) == Arithmetic::DoubleDouble {
            let row = self.point::<DoubleDouble>(p_theta, r, self.tolerance)?;
            return Ok(Row { double_double: true, ..row });
        }
        let row = self.point::<f64>(p_theta, r, self.tolerance)?;
        if row.distance <= TENTH * self.allowed {
            return Ok(row);
        }
        let again = self.point::<DoubleDouble>(p_theta, r, DOUBLE_DOUBLE_TOLERANCE)?;
        Ok(Row { double_double: true, work: row.work + again.work, ..again })
    }
}

impl Compute for WaveFrontByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let front = input_table(inputs, INPUT)?;
        let column = |name: &str| front.f64s(name).map_err(failed("second route"));
        let p_theta = column("p_theta")?;
        let r = [column("r1")?, column("r2")?, column("r3")?];
        let rows = (0..front.rows())
            .into_par_iter()
            .map(|i| self.row(p_theta[i], [0, 1, 2].map(|c| r[c][i])))
            .collect::<Result<Vec<Row>, NodeError>>()?;
        let work: Work = rows.iter().map(|row| row.work).sum();
        let table = Table::builder("spin-wave-front-by-integration", "points of a front by integrating the lift")
            .column("p_theta", "1", "p_θ(0)", p_theta)
            .column(
                "distance",
                "1",
                "distance of the point in R³ to the closed form's",
                rows.iter().map(|row| row.distance).collect::<Vec<_>>(),
            )
            .column("allowed", "1", "largest distance that is allowed", vec![self.allowed; rows.len()])
            .column(
                "double_double",
                "",
                "integrated with 106 bits",
                rows.iter().map(|row| row.double_double).collect::<Vec<_>>(),
            )
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
    use crate::effects::spin::wave_front::WaveFront;

    #[test]
    fn both_routes_agree_row_by_row() {
        for (k, t) in [(0.1, 3.0), (0.5, 1.0), (0.5, 3.0), (0.8, 4.0), (1.0, 2.0), (1.3, 6.0)] {
            let first = WaveFront { k, t, step: 0.2 }.run(&Inputs::default()).unwrap();
            let mut inputs = Inputs::default();
            let artifact = &first.artifacts[0];
            inputs.insert(INPUT, InputFile { bytes: artifact.bytes(&[]).unwrap(), logical: artifact.logical });
            let second = WaveFrontByIntegration::new(k, t, Accuracy::Article).run(&inputs).unwrap();
            assert_eq!((second.work.tangent_evaluations, second.work.event_evaluations), (0, 0));
            let table = Table::from_parquet(&second.artifacts[0].bytes(&[]).unwrap()).unwrap();
            let long = table.bools("double_double").unwrap().iter().filter(|long| **long).count();
            let largest = table.f64s("distance").unwrap().iter().copied().fold(0.0, f64::max);
            println!("k = {k}, t = {t}: {} rows, {long} long, {largest:e}", table.rows());
            assert!(largest <= 1e-12, "k = {k}, t = {t}: {largest:e}");
        }
    }

    #[test]
    fn all_code_is_declared() {
        assert_eq!(undeclared(&KIND), Ok(vec![]));
        assert_eq!(undeclared(&crate::effects::spin::wave_front::KIND), Ok(vec![]));
    }
}
