//! How one branch of the spin conjugate locus changes with k: its extent in θ, the number of its double points, the length of its first loop.
//!
//! One row for each k; a branch is sampled and searched as in [`super::double_points`]. Angles in radians, lengths on the unit sphere.

use super::branch::sample_in;
use super::double_points::find_in;
use super::momenta::Momenta;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-loops",
    summary: "extent and double points of one branch of the spin conjugate locus, over k",
    code: &[
        "effects/spin/loops.rs",
        "effects/spin/double_points.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Branches over k.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loops {
    /// The ratios of the couplings.
    pub k: Vec<f64>,
    /// How each branch is sampled.
    pub p_theta: Momenta,
}

struct Row {
    theta: (f64, f64),
    cusp: (f64, f64),
    count: i64,
    length: f64,
    work: Work,
}

impl Loops {
    fn row(&self, arithmetic: Arithmetic, k: f64) -> Result<Row, NodeError> {
        let (branch, work) = sample_in(arithmetic, k, &self.p_theta)?;
        let (found, polishing) = find_in(arithmetic, k, &branch)?;
        let thetas = || branch.iter().map(|row| row.theta);
        Ok(Row {
            theta: (thetas().fold(f64::INFINITY, f64::min), thetas().fold(f64::NEG_INFINITY, f64::max)),
            cusp: (branch[0].theta, branch[0].point.phi),
            count: found.len() as i64,
            // The first loop on the way from the start.
            length: found.last().map_or(f64::NAN, |double| double.loop_length),
            work: work + polishing,
        })
    }
}

impl Compute for Loops {
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
        let rows = self.k.par_iter().map(|k| self.row(arithmetic, *k)).collect::<Result<Vec<Row>, NodeError>>()?;
        let work = rows.iter().map(|row| row.work).sum();
        let number = |of: fn(&Row) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let table = Table::builder("spin-loops", "the branch p_φ(0) = −2, p_θ(0) ≥ 0 over k")
            .column("k", "1", "ratio of the couplings", self.k.clone())
            .column("theta_low", "rad", "smallest θ of the branch", number(|row| row.theta.0))
            .column("theta_high", "rad", "largest θ of the branch", number(|row| row.theta.1))
            .column("cusp_theta", "rad", "θ of the cusp, p_θ = 0", number(|row| row.cusp.0))
            .column("cusp_phi", "rad", "φ of the cusp, from the pole", number(|row| row.cusp.1))
            .column(
                "double_points",
                "1",
                "how many double points",
                rows.iter().map(|row| row.count).collect::<Vec<_>>(),
            )
            .column_with_gaps("loop_length", "rad", "length of the loop nearest to the start", number(|row| row.length))
            .build()
            .map_err(failed("loops"))?;
        product(&table, work)
    }
}
