//! The cusp of the conjugate locus of each start `(0, φ0)`: the conjugate point of the extremal that starts with `φ' = 0`.
//!
//! There `p_θ = √μ(φ0)`, `t1 = 2K(m)/M` (Lemma 3.8), half a period, and the point is `(Δθ(p_θ), −φ0)` (Theorem 3.24 b). On the
//! equator, `φ0 = 0`, it is the limit `π √(A/((B−A)(C−A)))`. Arc length and radians; `h = 1/2`.

use super::body::{Body, largest_delta};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::Clairaut;
use crate::geometry::serret_andoyer::period::period;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Elliptic integrals of one row: sn and F of the start, K, F and Π of the extremal.
const ELLIPTIC_CALLS: u64 = 5;

/// The cusps of these starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cusps {
    /// The body.
    pub body: Body,
    /// The starts, `|φ0| < K(k)/α`.
    pub phi0: Vec<f64>,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-cusps",
    summary: "the cusp of the conjugate locus of each start, in closed form",
    code: &[
        "effects/serret_andoyer/cusps.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for Cusps {
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

impl Cusps {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<S>()?;
        let width = metric.half_width();
        let row = |&phi0: &f64| {
            if phi0.is_nan() || S::from_f64(phi0).abs() >= width {
                let width = width.to_f64();
                return Err(NodeError::new(format!("phi0 = {phi0:?}: |phi0| < K(k)/alpha = {width:?} is needed")));
            }
            let delta = largest_delta(&metric, S::from_f64(phi0));
            period(&metric, Clairaut::Delta(delta)).map(|p| (delta, p)).map_err(failed(&format!("phi0 = {phi0:?}")))
        };
        let rows = self.phi0.par_iter().map(row).collect::<Result<Vec<_>, _>>()?;
        let table = Table::builder("cusps", "cusps of conjugate loci: the conjugate point of the start with φ' = 0")
            .column("phi0", "length", "distance of the start from the equator", self.phi0.clone())
            .column("delta", "1", "B p_θ² − 1 with p_θ = √μ(φ0)", rows.iter().map(|r| r.0.to_f64()).collect::<Vec<_>>())
            .column("branch", "1", "sign of φ' (without meaning here)", vec![1_i64; rows.len()])
            .column(
                "p_theta",
                "1",
                "Clairaut's constant",
                rows.iter().map(|r| r.1.p_theta.to_f64()).collect::<Vec<_>>(),
            )
            .column(
                "t1",
                "length",
                "first conjugate time",
                rows.iter().map(|r| r.1.half_period.to_f64()).collect::<Vec<_>>(),
            )
            .column("theta", "rad", "θ of the cusp", rows.iter().map(|r| r.1.first_return.to_f64()).collect::<Vec<_>>())
            .column("phi", "length", "φ of the cusp", self.phi0.iter().map(|phi0| -phi0).collect::<Vec<_>>())
            .build()
            .map_err(failed("cusps"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * rows.len() as u64, ..Work::default() })
    }
}
