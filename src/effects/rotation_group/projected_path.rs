//! A reduced extremal (9), given by its momenta or projected from SO(3), in closed form at equal steps of time: for drawing.

use super::projected_conjugate_point::Projected;
use super::start::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::{Extremal, Start};
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// Elliptic functions and integrals of one position: Jacobi, F and the third kind.
const ELLIPTIC_CALLS: u64 = 3;

/// One curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProjectedPath {
    /// The body, `A < B < C`.
    pub body: Body,
    /// Where it starts.
    pub start: Projected,
    /// Where it ends (time).
    pub t_end: f64,
    /// Points, both ends included.
    pub points: usize,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-projected-path",
    summary: "a Serret-Andoyer extremal, given or projected from SO(3), in closed form",
    code: &[
        "effects/rotation_group/projected_path.rs",
        "effects/rotation_group/projected_conjugate_point.rs",
        "effects/rotation_group/start.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/rotation_group",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for ProjectedPath {
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
        match arithmetic {
            Arithmetic::F64 => self.computed(self.start.reduced()?),
            Arithmetic::DoubleDouble => self.computed(self.start.long_reduced()?),
        }
    }
}

impl ProjectedPath {
    fn computed<S: Real>(&self, [x0, y0, p_x, p_y]: [S; 4]) -> Result<Product, NodeError> {
        let extremal = Extremal::new(&self.body.reduced()?, Start::Momenta { y0, p_x, p_y })
            .map_err(failed(&self.start.to_string()))?;
        let path = extremal.path();
        let last = self.points.saturating_sub(1).max(1) as f64;
        let times: Vec<f64> = (0..self.points).map(|i| self.t_end * (i as f64 / last)).collect();
        let positions: Vec<_> = times.iter().map(|t| path.position(S::from_f64(*t))).collect();
        let rows = times.len() as u64;
        let meaning = match self.start {
            Projected::Given(_) => "x, zero at the start",
            Projected::From(_) => "x",
        };
        let table = Table::builder("projected-path", "a Serret-Andoyer extremal")
            .column("t", "time", "time", times)
            .column("x", "rad", meaning, positions.iter().map(|p| (x0 + p.x).to_f64()).collect::<Vec<_>>())
            .column("y", "rad", "y, on the universal cover", positions.iter().map(|p| p.y.to_f64()).collect::<Vec<_>>())
            .column("p_y", "momentum", "its momentum", positions.iter().map(|p| p.p_y.to_f64()).collect::<Vec<_>>())
            .build()
            .map_err(failed("projected path"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * rows, dense_points: rows, ..Work::default() })
    }
}
