//! The second route to the conjugate point of a reduced extremal: the flow (9) with one Jacobi field, from the first route's start.
//!
//! No elliptic integral enters.

use super::start::Body;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::effects::arithmetic::{in_arithmetic, of_tolerance};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::numerics::counts;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// The input: the first route's table.
pub const INPUT: &str = "projected-conjugate-point";

/// The second route of one reduced extremal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProjectedConjugatePointByIntegration {
    /// The body, `A < B < C`.
    pub body: Body,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest relative difference allowed between the routes.
    pub allowed: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-projected-conjugate-point-by-integration",
    summary: "first conjugate point of a reduced extremal by integrating the flow: the second route",
    code: &[
        "effects/rotation_group/projected_conjugate_point_by_integration.rs",
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

impl ProjectedConjugatePointByIntegration {
    /// t1, x and y from `(y0, p_x, p_y)`, up to `t_max`.
    fn point<S: Real>(&self, start: [f64; 3], t_max: f64) -> Result<([f64; 3], counts::Work), NodeError> {
        let [a, b, c] = [self.body.a, self.body.b, self.body.c].map(S::from_f64);
        let [y0, p_x, p_y] = start.map(S::from_f64);
        let end = S::from_f64(t_max);
        let found = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, S::ZERO, end, self.tolerance)
            .map_err(failed(&format!("y0 = {:?}, p_x = {:?}, p_y = {:?}", start[0], start[1], start[2])))?;
        Ok(([found.t1, found.x, found.y].map(S::to_f64), found.work))
    }
}

impl Compute for ProjectedConjugatePointByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let first = input_table(inputs, INPUT)?;
        let read = |name: &str| -> Result<f64, NodeError> {
            let column = first.f64s(name).map_err(failed("second route"))?;
            column.first().copied().ok_or_else(|| NodeError::new("second route: no start"))
        };
        let (y0, p_x, p_y, t1) = (read("y0")?, read("p_x")?, read("p_y")?, read("t1")?);
        // The first conjugate time lies between T/2 and T: twice the first route's is beyond it.
        let (found, counted) =
            in_arithmetic!(of_tolerance(self.tolerance), S => self.point::<S>([y0, p_x, p_y], 2.0 * t1))?;
        let [second, x, y] = found;
        let x = read("x0")? + x;
        let table = Table::builder("projected-conjugate-point-by-integration", "the same point by integration")
            .column("t1", "time", "first conjugate time", vec![second])
            .column("x", "rad", "x there", vec![x])
            .column("y", "rad", "y there", vec![y])
            .column(
                "t1_difference",
                "1",
                "relative difference of t1 to the first route",
                vec![(second / t1 - 1.0).abs()],
            )
            .column("x_difference", "rad", "difference of x to the first route", vec![(x - read("x")?).abs()])
            .column("y_difference", "rad", "difference of y to the first route", vec![(y - read("y")?).abs()])
            .column("allowed", "1", "largest difference of t1 allowed", vec![self.allowed])
            .build()
            .map_err(failed("second route"))?;
        product(&table, integrated(counted))
    }
}
