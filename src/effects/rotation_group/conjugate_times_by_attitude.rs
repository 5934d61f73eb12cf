//! The second route to conjugate times on SO(3): the attitude as a unit quaternion with its own variations, momentum constant in space.
//!
//! The equations integrated have nothing in common with those of the first route but the body. Starts are read from its table.

use super::start::Body;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::effects::arithmetic::{in_arithmetic, of_tolerance};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::rotation_group::attitude_route::first_conjugate_times_by_attitude;
use crate::numerics::counts;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// The input: the first route's table.
pub const INPUT: &str = "conjugate-times";

/// The second route of one start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugateTimesByAttitude {
    /// The body.
    pub body: Body,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest relative difference allowed between the routes.
    pub allowed: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-conjugate-times-by-attitude",
    summary: "conjugate times on SO(3) by the attitude and its variations: the second route",
    code: &[
        "effects/rotation_group/conjugate_times_by_attitude.rs",
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

impl ConjugateTimesByAttitude {
    fn times<S: Real>(&self, momentum: [f64; 3]) -> Result<(Vec<f64>, counts::Work), NodeError> {
        let found =
            first_conjugate_times_by_attitude(&self.body.metric::<S>()?, momentum.map(S::from_f64), 2, self.tolerance)
                .map_err(failed(&format!("M = {momentum:?}")))?;
        Ok((found.times.into_iter().map(S::to_f64).collect(), found.work))
    }
}

impl Compute for ConjugateTimesByAttitude {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let first = input_table(inputs, INPUT)?;
        let read = |name: &str| -> Result<f64, NodeError> {
            let column = first.f64s(name).map_err(failed("second route"))?;
            column.first().copied().ok_or_else(|| NodeError::new("second route: no start"))
        };
        let momentum = [read("M1")?, read("M2")?, read("M3")?];
        let (times, counted) = in_arithmetic!(of_tolerance(self.tolerance), S => self.times::<S>(momentum))?;
        let difference =
            |name: &str, second: f64| -> Result<Vec<f64>, NodeError> { Ok(vec![(second / read(name)? - 1.0).abs()]) };
        let (t1, t2) = (times[0], times[1]);
        let table = Table::builder("conjugate-times-by-attitude", "first two conjugate times by the attitude")
            .column("t1", "time", "first conjugate time", vec![t1])
            .column("t2", "time", "second conjugate time, with multiplicity", vec![t2])
            .column("t1_difference", "1", "relative difference of t1 to the first route", difference("t1", t1)?)
            .column("t2_difference", "1", "relative difference of t2 to the first route", difference("t2", t2)?)
            .column("allowed", "1", "largest difference allowed", vec![self.allowed])
            .build()
            .map_err(failed("second route"))?;
        product(&table, integrated(counted))
    }
}
