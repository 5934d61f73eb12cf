//! The largest `t1 M/K` over all starts of one `ξ1`, for `ξ1 → 1`: the upper bound that Theorem 3.9 should state.
//!
//! In the limit `m → 1` equation (15) reads `coth w = 4 − coth ψ0`, `M t1 = 4K − ψ0 − w`; the largest value is at `coth ψ0 = coth w = 2`:
//! `M t1 = 4K − ln 3`. So the supremum of `t1 M/K` over all oscillating extremals is 4, approached like `4 − ln 3/K` and never attained.
//! Here the maximum is found by golden section in the phase, from the closed form of `t1` alone; the place of a maximum is known to √ε only, its value to ε.

use super::body::Body;
use super::conjugate_time_bounds::{Row, delta_of, start_at_phase};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::Metric;
use crate::geometry::serret_andoyer::conjugate::conjugate_time_bounds;
use crate::numerics::double_double::DoubleDouble;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Steps of the golden section: the interval shrinks by 0.618 each time, to below √ε.
const STEPS: usize = 44;
/// `(√5 − 1)/2`.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// Elliptic calls of one value: start, extremal, about six steps of the solver.
const ELLIPTIC_CALLS: u64 = 24;

/// The maxima of several `ξ1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConjugateTimeSupremum {
    /// The body.
    pub body: Body,
    /// `1 − ξ1`, in `(0, 1)`.
    pub one_minus_xi1: Vec<f64>,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-conjugate-time-supremum",
    summary: "largest first conjugate time over all starts, in units of K/M, towards the separatrix",
    code: &[
        "effects/serret_andoyer/conjugate_time_supremum.rs",
        "effects/serret_andoyer/conjugate_time_bounds.rs",
        "effects/serret_andoyer/body.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

fn ratio(metric: &Metric, delta: f64, part: f64) -> Result<f64, NodeError> {
    let extremal = start_at_phase(metric, delta, part)?.extremal(metric)?;
    conjugate_time_bounds(&extremal).map(|bounds| bounds.ratio).map_err(failed(&format!("delta = {delta:?}")))
}

/// The phase, over K, at which `t1 M/K` is largest: it has one maximum, below `ψ0 = K`.
fn largest(metric: &Metric, delta: f64) -> Result<f64, NodeError> {
    let (mut low, mut high) = (1e-3, 1.0);
    let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_left, mut at_right) = (ratio(metric, delta, left)?, ratio(metric, delta, right)?);
    for _ in 0..STEPS {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - GOLDEN * (high - low);
            at_left = ratio(metric, delta, left)?;
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + GOLDEN * (high - low);
            at_right = ratio(metric, delta, right)?;
        }
    }
    Ok(0.5 * (low + high))
}

impl Compute for ConjugateTimeSupremum {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let metric = self.body.metric::<f64>()?;
        let long = self.body.metric::<DoubleDouble>()?;
        let row = |d: &f64| {
            let delta = delta_of(&self.body, *d)?;
            Row::of(&long, start_at_phase(&metric, delta, largest(&metric, delta)?)?)
        };
        let rows = self.one_minus_xi1.par_iter().map(row).collect::<Result<Vec<_>, NodeError>>()?;
        let column = |f: fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<_>>();
        let table = Table::builder("conjugate-time-supremum", "largest first conjugate time over all starts of one ξ1")
            .column("one_minus_xi1", "1", "1 − ξ1", self.one_minus_xi1.clone())
            .column("phi0", "length", "distance of the start from the equator", column(|r| r.start.phi0))
            .column("delta", "1", "B p_θ² − 1", column(|r| r.start.delta))
            .column("branch", "1", "sign of φ' at the start", vec![1_i64; rows.len()])
            .column("psi0_over_k", "1", "phase since the last turning point over K(m)", column(|r| r.phase))
            .column("complete_k", "1", "K(m)", column(|r| r.complete_k))
            .column("t1", "length", "first conjugate time", column(|r| r.t1))
            .column("theta", "rad", "θ there", column(|r| r.theta))
            .column("phi", "length", "φ there", column(|r| r.phi))
            .column("ratio", "1", "t1 M/K, the largest over all starts", column(|r| r.ratio))
            .column(
                "below_four_times_k",
                "1",
                "(4 − t1 M/K) K, which tends to ln 3",
                column(|r| (4.0 - r.ratio) * r.complete_k),
            )
            .build()
            .map_err(failed("supremum"))?;
        let solved = (STEPS as u64 + 3) * rows.len() as u64;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * solved, roots_solved: solved, ..Work::default() })
    }
}
