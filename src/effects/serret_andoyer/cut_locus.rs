//! The right ray of the cut locus of a start `(0, φ0)`: both extremals of one `p_θ` meet at `(Δθ(p_θ), −φ0)` at `t = T(p_θ)/2` (Corollary 3.3 ii).
//!
//! Rows run from the cusp of the conjugate locus, the end of the ray, outwards. With the derivatives of the first return
//! `R = Δθ` by `p_θ`, for Proposition 3.23.

use super::body::{Body, delta_at};
use super::conjugate_locus::Spacing;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::Clairaut;
use crate::geometry::serret_andoyer::period::{Period, period};
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Elliptic integrals of one row: K, F, Π and B.
const ELLIPTIC_CALLS: u64 = 4;

/// The cut locus of one start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CutLocus {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Which constants.
    pub spacing: Spacing,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-cut-locus",
    summary: "cut points of all oscillating extremals from one point, with period and first return",
    code: &[
        "effects/serret_andoyer/cut_locus.rs",
        "effects/serret_andoyer/conjugate_locus.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for CutLocus {
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
        in_arithmetic!(arithmetic, S => self.computed::<S>())
    }
}

impl CutLocus {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<f64>()?;
        let deltas = self.spacing.deltas(&metric, self.phi0)?;
        let metric = self.body.metric::<S>()?;
        let rows: Vec<Period<S>> = deltas
            .par_iter()
            .map(|delta| {
                period(&metric, Clairaut::Delta(delta_at(&metric, self.phi0, *delta)))
                    .map_err(failed(&format!("delta = {delta:?}")))
            })
            .collect::<Result<_, _>>()?;
        let column = |f: fn(&Period<S>) -> S| rows.iter().map(|row| f(row).to_f64()).collect::<Vec<_>>();
        let table = Table::builder("cut-locus", "cut points of one start, p_θ > 0")
            .column("p_theta", "1", "Clairaut's constant", column(|row| row.p_theta))
            .column("t", "length", "time of the cut point, half a period", column(|row| row.half_period))
            .column("theta", "rad", "θ there, the first return Δθ", column(|row| row.first_return))
            .column("phi", "length", "φ there", vec![-self.phi0; rows.len()])
            .column("slope", "rad", "dΔθ/dp_θ", column(|row| row.first_return_slope))
            .column("bend", "rad", "d²Δθ/dp_θ²", column(|row| row.first_return_bend))
            .column("delta", "1", "B p_θ² − 1", deltas)
            .build()
            .map_err(failed("cut locus"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * rows.len() as u64, ..Work::default() })
    }
}
