//! Conjugate loci of the spin problem for many k in one table: what the page's slider draws.
//!
//! Each is one branch, sampled by the closed form as in [`super::conjugate_locus`]; the other three are its mirror images. θ in radians, continuous
//! along the branch; r on the unit sphere.

use super::momenta::Momenta;
use super::starts::Starts;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-conjugate-loci",
    summary: "one branch of first conjugate points of the spin problem for each of many k, by the closed form",
    code: &[
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/conjugate_loci.rs",
        "effects/spin/momenta.rs",
        "effects/spin/starts.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Branches for many k.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConjugateLoci {
    /// The ratios of the couplings.
    pub k: Vec<f64>,
    /// Which momenta.
    pub p_theta: Momenta,
}

impl Compute for ConjugateLoci {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let branches =
            self.k.par_iter().map(|k| Starts::from(self.p_theta).branch(*k)).collect::<Result<Vec<_>, NodeError>>()?;
        let work: Work = branches.iter().map(|(_, work)| *work).sum();
        let rows: Vec<_> =
            self.k.iter().zip(&branches).flat_map(|(k, (branch, _))| branch.iter().map(move |row| (*k, row))).collect();
        let column =
            |of: &dyn Fn(&(f64, &super::branch::BranchPoint)) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let table = Table::builder("spin-conjugate-loci", "first conjugate points for p_φ(0) = −2, p_θ(0) ≥ 0")
            .column("k", "1", "ratio of the couplings", column(&|row| row.0))
            .column("p_theta", "1", "p_θ(0), ascending from 0 for each k", column(&|row| row.1.p_theta))
            .column("theta", "rad", "θ there, continuous along the branch from 0", column(&|row| row.1.theta))
            .column("r1", "1", "first coordinate on the unit sphere", column(&|row| row.1.point.r[0]))
            .column("r2", "1", "second coordinate, along the axis of the poles", column(&|row| row.1.point.r[1]))
            .column("r3", "1", "third coordinate", column(&|row| row.1.point.r[2]))
            .build()
            .map_err(failed("conjugate loci"))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::code::undeclared;

    /// The rows of a k are those of its branch alone.
    #[test]
    fn each_locus_is_its_branch() {
        let p_theta = Momenta { from: 1e-9, to: 1e4, step: 0.3 };
        let loci = ConjugateLoci { k: vec![0.5, 1.2], p_theta }.run(&Inputs::default()).unwrap();
        let table = Table::from_parquet(&loci.artifacts[0].bytes(&[]).unwrap()).unwrap();
        let (branch, _) = Starts::from(p_theta).branch(1.2).unwrap();
        let k = table.f64s("k").unwrap();
        let first = k.iter().position(|k| *k == 1.2).unwrap();
        let theta: Vec<u64> = table.f64s("theta").unwrap()[first..].iter().map(|x| x.to_bits()).collect();
        assert_eq!(theta, branch.iter().map(|row| row.theta.to_bits()).collect::<Vec<_>>());
        assert_eq!(undeclared(&KIND), Ok(vec![]));
    }
}
