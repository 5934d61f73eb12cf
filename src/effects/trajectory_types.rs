//! The four types of trajectory of the spin problem over a grid of k and `p_θ` (section 5.2.1, Fig. 6).
//!
//! Each cell is classified by [`crate::geometry::spin::trajectory_type`]. The first conjugate time stands twice, by the
//! closed form and by the integration that follows θ up to it, with their relative difference: the second route costs
//! nothing more here. Next to a vertical tangent of `t1(p_θ)` the closed form's own bound is what is allowed. Angles in
//! radians; times in the unit that `H = 1` fixes.
//!
//! What is found is a type, which signs decide: it is looked for in `f64` at every level, and a level tighter than `article` gives the numbers of
//! `article`.

use super::counted::integrated;
use super::product::{failed, product};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::sweep::Sweep;
use crate::contract::work::Work;
use crate::geometry::spin::trajectory_type::{Classified, classify};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "trajectory-types",
    summary: "type of the trajectory for each k and p_θ: turning points of θ, first exit, self-intersection",
    code: &[
        "contract/sweep.rs",
        "effects/trajectory_types.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// Allowed difference of the two conjugate times in units of the accuracy asked for.
const ALLOWED: f64 = 100.0;

/// The grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrajectoryTypes {
    /// The values of k.
    pub k: Sweep,
    /// The values of `p_θ(0)`, above 0.
    pub p_theta: Sweep,
    /// One more, smaller `p_θ`: near the limit in which the types begin.
    pub smallest_p_theta: f64,
    /// A total decrease of θ on `[0, t1]` up to this counts as none, radians.
    pub decrease_tolerance: f64,
    /// Relative error of the integrations' steps.
    pub accuracy: f64,
}

impl TrajectoryTypes {
    /// The momenta of every k, in ascending order, the smallest included.
    pub fn momenta(&self) -> Vec<f64> {
        let mut momenta = self.p_theta.values();
        momenta.push(self.smallest_p_theta);
        momenta.sort_by(f64::total_cmp);
        momenta.dedup();
        momenta
    }
}

struct Cell {
    k: f64,
    p_theta: f64,
    found: Classified,
}

impl Compute for TrajectoryTypes {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let momenta = self.momenta();
        let grid: Vec<(f64, f64)> =
            self.k.values().into_iter().flat_map(|k| momenta.iter().map(move |p_theta| (k, *p_theta))).collect();
        let cells = grid
            .into_par_iter()
            .map(|(k, p_theta)| {
                let doing = format!("k = {k:?}, p_theta = {p_theta:?}");
                let found = classify(k, p_theta, self.decrease_tolerance, self.accuracy).map_err(failed(&doing))?;
                Ok(Cell { k, p_theta, found })
            })
            .collect::<Result<Vec<Cell>, NodeError>>()?;
        let numbers = |of: &dyn Fn(&Cell) -> f64| cells.iter().map(of).collect::<Vec<f64>>();
        let exits = |of: fn(&Classified) -> Option<f64>| {
            cells.iter().map(|cell| of(&cell.found).unwrap_or(f64::NAN)).collect::<Vec<f64>>()
        };
        let names: Vec<&str> = cells.iter().map(|cell| cell.found.kind.name()).collect();
        let difference = |found: &Classified| (found.t1_by_integration / found.t1 - 1.0).abs();
        let table = Table::builder(KIND.name, "types of the trajectories over a grid of k and p_theta")
            .column("k", "1", "ratio of the couplings", numbers(&|cell| cell.k))
            .column("p_theta", "1", "p_θ at the start", numbers(&|cell| cell.p_theta))
            .column("type", "", "i, ii, iii, iv, or none of them", names)
            .column("t1", "time", "first conjugate time, closed form", numbers(&|cell| cell.found.t1))
            .column("error", "1", "bound on the relative error of t1", numbers(&|cell| cell.found.error))
            .column(
                "t1_difference",
                "1",
                "relative difference of t1 by integration",
                numbers(&|cell| difference(&cell.found)),
            )
            .column(
                "allowed",
                "1",
                "largest difference accepted",
                numbers(&|cell| cell.found.error.max(ALLOWED * self.accuracy)),
            )
            .column("theta", "rad", "θ at t1", numbers(&|cell| cell.found.theta))
            .column("decrease", "rad", "total decrease of θ on [0, t1]", numbers(&|cell| cell.found.decrease))
            .column_with_gaps(
                "t_exit",
                "time",
                "first exit from 0 ≤ θ ≤ π; not looked for in type i",
                exits(|found| found.exit.map(|exit| exit.t)),
            )
            .column_with_gaps("theta_exit", "rad", "θ there, 0 or π", exits(|found| found.exit.map(|exit| exit.theta)))
            .column_with_gaps("phi_exit", "rad", "φ there", exits(|found| found.exit.map(|exit| exit.phi)))
            .column_with_gaps(
                "s",
                "time",
                "first time at the first self-intersection",
                exits(|found| found.intersection.map(|at| at.s)),
            )
            .column_with_gaps("t", "time", "second time there", exits(|found| found.intersection.map(|at| at.t)))
            .build()
            .map_err(failed("trajectory types"))?;
        let work = cells.iter().map(|cell| work_of(&cell.found)).sum();
        product(&table, work)
    }
}

/// The work of one classification.
pub fn work_of(found: &Classified) -> Work {
    let elliptic_calls = u64::from(found.elliptic_calls);
    Work { elliptic_calls, ..integrated(found.work) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stand_in_order_with_the_smallest_momentum_first() {
        let (k, p_theta) = (Sweep::List(vec![1.0, 1.3]), Sweep::List(vec![0.5, 3.0]));
        let node = TrajectoryTypes { k, p_theta, smallest_p_theta: 1e-4, decrease_tolerance: 0.03, accuracy: 1e-14 };
        let product = node.run(&Inputs::default()).unwrap();
        let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
        assert_eq!(table.texts("type").unwrap(), &["i", "i", "i", "iv", "iv", "i"]);
        assert_eq!(table.f64s("p_theta").unwrap()[..3], [1e-4, 0.5, 3.0]);
        assert!(table.f64s("t_exit").unwrap()[0].is_nan());
        assert!(product.work.steps > 0 && product.work.tangent_evaluations > 0 && product.work.dense_points > 0);
    }
}
