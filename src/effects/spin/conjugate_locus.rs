//! The conjugate locus of the spin problem: one branch of first conjugate points, by the closed form.
//!
//! Start on the equator, `θ = 0`, `φ = π/2`, `p_φ = −2`, `H = 1`; `p_θ ≥ 0` from 0 to a large value (module [`super::branch`]). Angles in
//! radians, times in the unit that `H = 1` fixes. The phase of the closed form is monotone, so no earlier conjugate time is missed.

use super::starts::Starts;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::effects::product::{failed, product};
use crate::table::Table;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-conjugate-locus",
    summary: "one branch of first conjugate points of the spin problem, by the closed form",
    code: &[
        "effects/spin/conjugate_locus.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/spin/starts.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// One branch of the locus.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConjugateLocus {
    /// The ratio of the couplings.
    pub k: f64,
    /// Which momenta.
    pub p_theta: Starts,
}

impl Compute for ConjugateLocus {
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
        let (branch, work) = self.p_theta.branch_in(arithmetic, self.k)?;
        let column = |of: fn(&super::branch::BranchPoint) -> f64| branch.iter().map(of).collect::<Vec<f64>>();
        let crossings: Vec<i64> = branch.iter().map(|row| i64::from(row.point.crossings)).collect();
        let table = Table::builder("spin-conjugate-locus", "first conjugate points for p_φ(0) = −2, p_θ(0) ≥ 0")
            .column("p_theta", "1", "p_θ(0), ascending from 0", column(|row| row.p_theta))
            .column("t1", "time", "first conjugate time", column(|row| row.point.t1))
            .column("theta", "rad", "θ there, continuous along the branch from 0", column(|row| row.theta))
            .column("phi", "rad", "φ there, from the pole", column(|row| row.point.phi))
            .column("r1", "1", "first coordinate on the unit sphere", column(|row| row.point.r[0]))
            .column("r2", "1", "second coordinate, along the axis of the poles", column(|row| row.point.r[1]))
            .column("r3", "1", "third coordinate", column(|row| row.point.r[2]))
            .column("error", "1", "bound on the relative error of t1", column(|row| row.point.error))
            .column("crossings", "1", "returns to the equator by then", crossings)
            .build()
            .map_err(failed(&format!("k = {:?}", self.k)))?;
        product(&table, work)
    }
}
