//! Period and first return of the oscillating extremals of one body (Proposition 3.23), in closed form, over all Clairaut constants.
//!
//! Rows run from the equator, `p_θ = A^(−1/2)`, where both have limits, towards the separatrix `p_θ = B^(−1/2)`, where both grow like log 1/δ, `δ = B p_θ² − 1`.
//! They do not depend on the start. Arc length, θ in radians.

use super::body::{Body, delta_at};
use super::conjugate_locus::Spacing;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::Clairaut;
use crate::geometry::serret_andoyer::period::{Period as Found, period};
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Elliptic integrals of one row: K, F, Π and B.
const ELLIPTIC_CALLS: u64 = 4;

/// Periods of one body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Period {
    /// The body.
    pub body: Body,
    /// Which constants.
    pub spacing: Spacing,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-period",
    summary: "period and first return of all oscillating extremals of a body, in closed form",
    code: &[
        "effects/serret_andoyer/period.rs",
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

impl Compute for Period {
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

impl Period {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<f64>()?;
        let deltas = self.spacing.deltas(&metric, 0.0)?;
        let metric = self.body.metric::<S>()?;
        let rows: Vec<Found<S>> = deltas
            .par_iter()
            .map(|delta| {
                period(&metric, Clairaut::Delta(delta_at(&metric, 0.0, *delta)))
                    .map_err(failed(&format!("delta = {delta:?}")))
            })
            .collect::<Result<_, _>>()?;
        let column = |f: fn(&Found<S>) -> S| rows.iter().map(|row| f(row).to_f64()).collect::<Vec<_>>();
        let table = Table::builder("period", "period and first return of oscillating extremals")
            .column("p_theta", "1", "Clairaut's constant, from A^(−1/2) towards B^(−1/2)", column(|row| row.p_theta))
            .column("delta", "1", "B p_θ² − 1", deltas)
            .column("half_period", "length", "T/2, the time of the first return to −φ0", column(|row| row.half_period))
            .column("first_return", "rad", "Δθ, the change of θ over half a period", column(|row| row.first_return))
            .build()
            .map_err(failed("period"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * rows.len() as u64, ..Work::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::code::undeclared;
    use std::f64::consts::PI;

    /// Oracle: the limits on the equator (Theorem 3.9, Remark 3.25 corrected), `π√A/√((B−A)(C−A))` and `√A` times that; both grow
    /// towards the separatrix.
    #[test]
    fn periods_begin_at_the_equators_limits() {
        let spacing = Spacing { smallest: 1e-8, cusp: 10, tail: 20 };
        let product = Period { body: Body { a: 1.5, b: 2.0, c: 2.8 }, spacing }.run(&Inputs::default()).unwrap();
        let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
        let (half, turn) = (table.f64s("half_period").unwrap(), table.f64s("first_return").unwrap());
        let limit = PI * (1.5_f64 / (0.5 * 1.3)).sqrt();
        assert!((half[0] / limit - 1.0).abs() < 1e-14 && (turn[0] / limit / 1.5_f64.sqrt() - 1.0).abs() < 1e-14);
        assert!(half.windows(2).all(|pair| pair[1] > pair[0]) && turn.windows(2).all(|pair| pair[1] > pair[0]));
    }

    #[test]
    fn all_code_is_declared() {
        assert_eq!(undeclared(&KIND), Ok(vec![]));
    }
}
