//! Extremals from one point `(0, φ0)` at arc length, for a fan of Clairaut constants and both signs of `φ'`, in closed form.
//!
//! Each runs until it has left the frame `|θ| ≤ theta_end`, `|φ| ≤ phi_end` for certain: `|θ'| ≥ |p_θ| A`, and where `p_θ² B < 1`, `|φ'| ≥ √(1 − p_θ² B)`.
//! Three more can be added, which no config could state to the last bit: the separatrix `p_θ = B^(−1/2)`, the steady rotations about the minor axis
//! `p_θ = C^(−1/2)`, the largest constant `p_θ = √μ(φ0)` (from the equator: the equator itself).

use super::body::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, ExtremalClass, Start};
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The separatrix, as `class` names it.
pub const SEPARATRIX: &str = "separatrix";
/// Steady rotations about the minor axis.
pub const PERMANENT_ROTATION: &str = "permanent-rotation";
/// Geodesics that are no motion of a body.
pub const UNPHYSICAL: &str = "unphysical";
/// Rotating trajectories.
pub const ROTATING: &str = "rotating";
/// Oscillating trajectories.
pub const OSCILLATING: &str = "oscillating";
/// The equator.
pub const EQUATOR: &str = "equator";
/// The unstable steady rotation at the edge of the strip.
pub const MIDDLE_AXIS: &str = "middle-axis";

/// The fan of extremals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Geodesics {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Clairaut constants, `|p_θ| ≤ √μ(φ0)`.
    pub p_theta: Vec<f64>,
    /// Whether the separatrix is added.
    pub separatrix: bool,
    /// Whether the steady rotations about the minor axis are added.
    pub minor_axis: bool,
    /// Whether the extremal with `φ' = 0` is added.
    pub parallel: bool,
    /// θ at which the frame ends.
    pub theta_end: f64,
    /// φ at which the frame ends.
    pub phi_end: f64,
    /// Points of each curve.
    pub points: usize,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-geodesics",
    summary: "extremals from one point for a fan of Clairaut constants, in closed form",
    code: &[
        "effects/serret_andoyer/geodesics.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// The name of a class in tables.
pub fn class_name(class: ExtremalClass) -> &'static str {
    match class {
        ExtremalClass::Equator => EQUATOR,
        ExtremalClass::Oscillating => OSCILLATING,
        ExtremalClass::Separatrix => SEPARATRIX,
        ExtremalClass::MiddleAxis => MIDDLE_AXIS,
        ExtremalClass::Rotating => ROTATING,
        ExtremalClass::Unphysical => UNPHYSICAL,
    }
}

/// Elliptic functions and integrals of one position: Jacobi, F and the third kind.
const ELLIPTIC_CALLS: u64 = 3;

impl Compute for Geodesics {
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

impl Geodesics {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<S>()?;
        let phi0 = S::from_f64(self.phi0);
        if self.points < 2 {
            return Err(NodeError::new(format!("points = {}: at least 2 are needed", self.points)));
        }
        let mut wanted: Vec<(Clairaut<S>, Option<&str>)> =
            self.p_theta.iter().map(|p_theta| (Clairaut::PTheta(S::from_f64(*p_theta)), None)).collect();
        if self.separatrix {
            wanted.push((Clairaut::Delta(S::ZERO), None));
        }
        if self.minor_axis {
            wanted.push((Clairaut::PTheta(metric.minor_axis_clairaut()), Some(PERMANENT_ROTATION)));
        }
        if self.parallel {
            wanted.push((Clairaut::PTheta(metric.mu(phi0).sqrt()), None));
        }
        let both = [Branch::Ascending, Branch::Descending];
        let wanted: Vec<_> = wanted.iter().flat_map(|(p, class)| both.map(|branch| (*p, *class, branch))).collect();
        let curve = |&(clairaut, class, branch): &(Clairaut<S>, Option<&'static str>, Branch)| {
            let start = Start::Darboux { phi0, clairaut, branch };
            let extremal = Extremal::new(&metric, start).map_err(failed(&format!("{clairaut:?}")))?;
            let Body { a, b, .. } = self.body;
            let p = extremal.p_x().abs().to_f64();
            let along = self.theta_end / (p * a);
            let across = (self.phi_end + self.phi0.abs()) / (1.0 - p * p * b).max(0.0).sqrt();
            let end = along.min(across);
            let path = extremal.path();
            let rows = (0..self.points).map(|i| {
                let t = end * (i as f64 / (self.points - 1) as f64);
                let at = path.position(S::from_f64(t));
                (t, at.theta.to_f64(), at.phi.to_f64())
            });
            let class = class.unwrap_or(class_name(extremal.class()));
            Ok((extremal.p_x().to_f64(), extremal.direction().to_f64() as i64, class, rows.collect::<Vec<_>>()))
        };
        let curves = wanted.par_iter().map(curve).collect::<Result<Vec<_>, NodeError>>()?;
        let count = curves.len() * self.points;
        let mut ids = Vec::with_capacity(count);
        let (mut p_theta, mut branch, mut class) = (Vec::new(), Vec::new(), Vec::new());
        let (mut t, mut theta, mut phi) = (Vec::new(), Vec::new(), Vec::new());
        for (id, (p, direction, name, rows)) in curves.into_iter().enumerate() {
            for row in rows {
                ids.push(id as i64);
                p_theta.push(p);
                branch.push(direction);
                class.push(name);
                t.push(row.0);
                theta.push(row.1);
                phi.push(row.2);
            }
        }
        let table = Table::builder("geodesics", "extremals from one point, arc length as time")
            .column("curve", "1", "number of the extremal", ids)
            .column("p_theta", "1", "Clairaut's constant", p_theta)
            .column("branch", "1", "sign of φ' at the start", branch)
            .column("class", "", "kind of motion", class)
            .column("t", "length", "arc length", t)
            .column("theta", "rad", "θ, zero at the start", theta)
            .column("phi", "length", "φ, distance from the equator on the universal cover", phi)
            .build()
            .map_err(failed("geodesics"))?;
        let points = count as u64;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * points, dense_points: points, ..Work::default() })
    }
}
