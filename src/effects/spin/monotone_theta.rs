//! The extremal of the spin problem whose θ never decreases up to its first conjugate time (section 5.2.1, type i), for each `k ≥ 1`.
//!
//! On the equator θ' changes sign unless k = 1 or `sin 2θ = 0` ([`crate::geometry::spin::theta`]), and the first return to it is the
//! cut point, before `t1`. So for k > 1 only a start that returns at θ = π/2 can do: β = π/2 where λ = π. There is one: with
//! `w2 = 1 − 1/k²`, `b = p_θ/(2k)`
//!
//! `λ(β = π/2) = (G/2b) ∫_0^{π/2} dβ/((cos²β + k² sin²β) √(1 − (w2/b²) sin²β))`
//!
//! falls as `p_θ` grows, from ∞ at the separatrix (`p_θ = 0` for k = 1) to π/2. It is π between `2/√3` (with `sin β = 0` in the root) and
//! `2√((4k² − 3)/3)` (with `sin β = 1`). First route: the closed form of the return, solved for `p_θ`. Second: the flow integrated from that
//! `p_θ`, which must return at θ = π/2, and all turning points of its θ. Angles in radians, times in the unit that `H = 1` fixes.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::sweep::Sweep;
use crate::contract::work::Work;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::{cut_point, first_conjugate_point};
use crate::geometry::spin::lift::equator_crossings;
use crate::geometry::spin::start::Start;
use crate::geometry::spin::theta::up_to_conjugate;
use crate::numerics::roots::{RootTolerance, bracketed};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-monotone-theta",
    summary: "for each k the extremal that first returns to the equator at θ = π/2, and how far its θ falls up to t1",
    code: &[
        "contract/sweep.rs",
        "effects/spin/monotone_theta.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// Lower end of the bracket of `p_θ`: below `2/√3`, which is the root itself for k = 1.
const LOW: f64 = 1.0;
/// Closed-form returns after which the search for `p_θ` is given up: bisection alone would need some sixty.
const MOST: usize = 200;
/// The integration runs this much longer than the closed form's conjugate time.
const BEYOND: f64 = 1.05;
/// What the integration may make of a closed form's angle, in units of the accuracy asked for.
const ALLOWED: f64 = 100.0;

/// One extremal for each k.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MonotoneTheta {
    /// The values of k, from 1.
    pub k: Sweep,
    /// Relative error of the integration's steps.
    pub accuracy: f64,
}

struct Row {
    k: f64,
    p_theta: f64,
    t_return: f64,
    return_difference: f64,
    t1: f64,
    theta: f64,
    decrease: f64,
    work: Work,
}

/// The `p_θ` whose first return to the equator lies at θ = π/2, with the work.
fn momentum(k: f64) -> Result<(f64, Work), NodeError> {
    let doing = format!("k = {k:?}, the return at theta = pi/2");
    if k.is_nan() || k < 1.0 {
        return Err(NodeError::new(format!("{doing}: only k of 1 and more is examined")));
    }
    let mut work = Work::default();
    let mut failure = None;
    let across = |p_theta: f64| match Start::new(k, p_theta).map_err(failed(&doing)).and_then(|start| {
        let point = cut_point(&start).map_err(failed(&doing))?;
        work.elliptic_calls += u64::from(point.elliptic_calls);
        Ok(point.r[0])
    }) {
        Ok(r1) => r1,
        Err(error) => {
            failure = Some(error);
            f64::NAN
        }
    };
    // Above the upper end of the root, 2√((4k² − 3)/3).
    let high = 2.0 * (4.0 * k * k - 3.0).sqrt();
    let tolerance = RootTolerance { relative: f64::EPSILON, absolute: 0.0, max_evaluations: MOST };
    let root = bracketed(across, LOW, high, tolerance);
    match failure {
        Some(error) => Err(error),
        None => {
            work.roots_solved += 1;
            Ok((root.map_err(failed(&doing))?.x, work))
        }
    }
}

impl MonotoneTheta {
    fn row(&self, k: f64) -> Result<Row, NodeError> {
        let (p_theta, mut work) = momentum(k)?;
        let doing = format!("k = {k:?}, p_theta = {p_theta:?}");
        let start = Start::new(k, p_theta).map_err(failed(&doing))?;
        let t_return = cut_point(&start).map_err(failed(&doing))?.t_cut;
        let t1 = first_conjugate_point(&start).map_err(failed(&doing))?.t1;
        let t_max = BEYOND * t1;
        let (crossings, counted) = equator_crossings(k, p_theta, self.accuracy, t_max, 1).map_err(failed(&doing))?;
        let crossing = crossings.first().ok_or_else(|| NodeError::new(format!("{doing}: no return")))?;
        work += integrated(counted);
        let path = up_to_conjugate(k, p_theta, self.accuracy, t_max).map_err(failed(&doing))?;
        work += integrated(path.work);
        if let Some(t) = path.earlier_exit {
            return Err(NodeError::new(format!("{doing}: θ leaves [0, π] before t1, at t = {t:?}")));
        }
        let return_difference = (libm::atan2(crossing.r[2], crossing.r[0]) - FRAC_PI_2).abs();
        Ok(Row { k, p_theta, t_return, return_difference, t1, theta: path.theta, decrease: path.decrease, work })
    }
}

impl Compute for MonotoneTheta {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let rows = self.k.values().into_par_iter().map(|k| self.row(k)).collect::<Result<Vec<Row>, NodeError>>()?;
        let numbers = |of: fn(&Row) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let allowed = vec![(ALLOWED * self.accuracy).max(ALLOWED * f64::EPSILON); rows.len()];
        let table = Table::builder(KIND.name, "extremals that first return to the equator at theta = pi/2")
            .column("k", "1", "ratio of the couplings", numbers(|row| row.k))
            .column("p_theta", "1", "p_θ at the start, closed form", numbers(|row| row.p_theta))
            .column("t_return", "time", "first return to the equator, closed form", numbers(|row| row.t_return))
            .column(
                "return_difference",
                "rad",
                "|θ − π/2| at the first return, by integration",
                numbers(|row| row.return_difference),
            )
            .column("allowed", "rad", "what the integration allows", allowed)
            .column("t1", "time", "first conjugate time, closed form", numbers(|row| row.t1))
            .column("theta", "rad", "θ at t1, by integration", numbers(|row| row.theta))
            .column(
                "decrease",
                "rad",
                "total decrease of θ on [0, t1], by its turning points",
                numbers(|row| row.decrease),
            )
            .build()
            .map_err(failed("extremals with a monotone theta"))?;
        product(&table, rows.iter().map(|row| row.work).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle for k = 1: the metric is `(dr1² + dr3²)/r2²`, `λ = Gt/2` and `β = p_θ t/2`, so λ = π and β = π/2 give `G = 2 p_θ`,
    /// `p_θ = 2/√3`. For the others the bounds derived above, and the integrated flow itself: it returns at π/2, and its θ does not fall.
    #[test]
    fn theta_does_not_fall_from_the_one_start() {
        let node = MonotoneTheta { k: Sweep::List(vec![1.0, 1.06, 1.4]), accuracy: 1e-14 };
        let product = node.run(&Inputs::default()).unwrap();
        let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
        let column = |name: &str| table.f64s(name).unwrap().to_vec();
        let (k, p_theta) = (column("k"), column("p_theta"));
        // One rounding of 2/√3 and one of the root.
        assert!((p_theta[0] - 2.0 / 3.0_f64.sqrt()).abs() <= 4.0 * f64::EPSILON, "{p_theta:?}");
        for i in 1..3 {
            let high = 2.0 * ((4.0 * k[i] * k[i] - 3.0) / 3.0).sqrt();
            assert!(p_theta[i] > 2.0 / 3.0_f64.sqrt() && p_theta[i] < high, "{p_theta:?}");
        }
        for ((difference, decrease), allowed) in
            column("return_difference").iter().zip(column("decrease")).zip(column("allowed"))
        {
            assert!(*difference <= allowed && decrease <= allowed, "{difference} {decrease}");
        }
        // Rounding of θ, a few ε.
        assert!(column("decrease").iter().all(|decrease| *decrease <= 16.0 * f64::EPSILON));
        let below = MonotoneTheta { k: Sweep::List(vec![0.9]), accuracy: 1e-14 };
        assert!(below.run(&Inputs::default()).is_err());
    }

    /// Any other start has a θ that falls, if only a little: on both sides of the one by more than rounding.
    #[test]
    fn theta_falls_from_its_neighbours() {
        let (p_theta, _) = momentum(1.2).unwrap();
        for factor in [0.9, 1.1] {
            let p = factor * p_theta;
            let t1 = first_conjugate_point(&Start::new(1.2, p).unwrap()).unwrap().t1;
            assert!(up_to_conjugate(1.2, p, 1e-14, BEYOND * t1).unwrap().decrease > 1e-6, "{factor}");
        }
    }
}
