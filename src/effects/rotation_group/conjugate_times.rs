//! The first two conjugate times on SO(3) of one start: momentum and Jacobi fields in the body frame, eigenphases (numerics: section 5.3).
//!
//! They depend on the momentum in the body alone: left translations carry extremals to extremals. Time as in (2).

use super::start::{Body, MomentumStart};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::of_tolerance;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::geometry::rotation_group::conjugate::first_conjugate_times;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// Conjugate times looked for.
pub const WANTED: usize = 2;
/// What the rounding of the momentum (half an ε in each component) can do to a time, relative: its condition is 3 at most unless
/// the start is near the separatrix.
const MOMENTUM_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The conjugate times of one start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugateTimes {
    /// The body.
    pub body: Body,
    /// Its momentum at the start.
    pub start: MomentumStart,
    /// Relative error per step; below the ε of f64 in double-double, from a momentum that is not rounded.
    pub tolerance: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-conjugate-times",
    summary: "first two conjugate times on SO(3): Jacobi fields in the body frame, eigenphases",
    code: &[
        "effects/rotation_group/conjugate_times.rs",
        "effects/rotation_group/start.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/rotation_group",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for ConjugateTimes {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let momentum = self.start.body_momentum(&self.body)?;
        let doing = self.start.to_string();
        let (times, error, counted) = match of_tolerance(self.tolerance) {
            Arithmetic::F64 => {
                let found = first_conjugate_times(&self.body.metric()?, momentum, WANTED, self.tolerance)
                    .map_err(failed(&doing))?;
                (found.times, found.error + self.tolerance.max(f64::EPSILON) + MOMENTUM_ROUNDING, found.work)
            }
            Arithmetic::DoubleDouble => {
                let momentum = self.start.long_body_momentum(&self.body)?;
                let found = first_conjugate_times(&self.body.metric()?, momentum, WANTED, self.tolerance)
                    .map_err(failed(&doing))?;
                (found.times.into_iter().map(Real::to_f64).collect(), found.error + f64::EPSILON, found.work)
            }
        };
        let (energy, size) = self.body.energy_and_size(&momentum);
        let table = Table::builder("conjugate-times", "first two conjugate times of one start on SO(3)")
            .column("M1", "momentum", "angular momentum in the body, first axis", vec![momentum[0]])
            .column("M2", "momentum", "angular momentum in the body, second axis", vec![momentum[1]])
            .column("M3", "momentum", "angular momentum in the body, third axis", vec![momentum[2]])
            .column("h", "energy", "the Hamiltonian", vec![energy])
            .column("G", "momentum", "size of the momentum", vec![size])
            .column("t1", "time", "first conjugate time", vec![times[0]])
            .column("t2", "time", "second conjugate time, with multiplicity", vec![times[1]])
            .column("error", "1", "bound on the relative error of both", vec![error])
            .build()
            .map_err(failed("conjugate times"))?;
        product(&table, Work { roots_solved: WANTED as u64, ..integrated(counted) })
    }
}
