//! Where θ turns along one extremal of the spin problem (section 5.2: "θ is not monotonous for all the trajectories").
//!
//! All zeros of θ' up to a time, [`crate::geometry::spin::theta`]: crossings of the equator and zeros of `h1 r1/k² + h3
//! r3`, with θ on its continuous branch and what θ has lost so far. Angles in radians; times in the unit that `H = 1`
//! fixes.
//!
//! Integrated in `f64` at every level: a level tighter than `article` gives the numbers of `article`.

use super::counted::integrated;
use super::product::{failed, product};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::geometry::spin::theta::turning_points;
use crate::table::Table;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "theta-turning-points",
    summary: "all instants at which θ turns along one extremal, and how far it falls between them",
    code: &[
        "effects/theta_turning_points.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// One extremal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThetaTurningPoints {
    /// Ratio of the couplings.
    pub k: f64,
    /// `p_θ(0)`, above 0.
    pub p_theta: f64,
    /// How far the extremal is followed.
    pub t_end: f64,
    /// Relative error of the integration's steps.
    pub accuracy: f64,
}

impl Compute for ThetaTurningPoints {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let Self { k, p_theta, t_end, accuracy } = *self;
        let doing = format!("k = {k:?}, p_theta = {p_theta:?}, up to t = {t_end:?}");
        let (found, work) = turning_points(k, p_theta, accuracy, t_end).map_err(failed(&doing))?;
        let mut before = 0.0;
        let mut fallen = 0.0;
        let (mut change, mut decrease) = (Vec::new(), Vec::new());
        for turning in &found {
            change.push(turning.theta - before);
            fallen += (before - turning.theta).max(0.0);
            decrease.push(fallen);
            before = turning.theta;
        }
        let numbers =
            |of: fn(&crate::geometry::spin::theta::TurningPoint) -> f64| found.iter().map(of).collect::<Vec<f64>>();
        let table =
            Table::builder(KIND.name, format!("instants at which theta may turn, k = {k:?}, p_theta = {p_theta:?}"))
                .column("t", "time", "the instant", numbers(|turning| turning.t))
                .column("theta", "rad", "θ there, on the branch that starts at 0", numbers(|turning| turning.theta))
                .column("phi", "rad", "φ there, from the pole", numbers(|turning| turning.phi))
                .column(
                    "on_equator",
                    "",
                    "whether the equator is crossed",
                    found.iter().map(|turning| turning.on_equator).collect::<Vec<_>>(),
                )
                .column("change", "rad", "change of θ since the instant before", change)
                .column("decrease", "rad", "total decrease of θ so far", decrease)
                .build()
                .map_err(failed("turning points"))?;
        product(&table, integrated(work))
    }
}
