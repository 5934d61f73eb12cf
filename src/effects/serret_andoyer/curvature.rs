//! `μ(φ)` and the Gauss curvature `G(φ)` over one strip `|φ| ≤ K(k)/α` (Proposition 3.21), by two routes.
//!
//! First route: the formula `G = (A+B+C)(z − z−)(z − z+)/z²`, `z = 2/μ`. Second route: `G = −(√μ)''/√μ` itself, the second derivative by the
//! central difference of sixth order on seven points in double-double: with the step `h = K(k)/(1000 α)` it leaves
//! `h⁶ (√μ)⁽⁸⁾/560`, below 1e-16 for the article's body, and rounding of 1e-26.

use super::body::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::Metric;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Step of the difference quotient in units of the strip's half-width.
const STEP: f64 = 1e-3;
/// The central second difference of sixth order, times 180 h²: weights at 0, ±h, ±2h, ±3h.
const WEIGHTS: [f64; 4] = [-490.0, 270.0, -27.0, 2.0];
/// Jacobi functions of one row: one in f64, seven in double-double.
const ELLIPTIC_CALLS: u64 = 8;

/// `−(√μ)''/√μ` by differences.
pub fn curvature_by_differences(metric: &Metric<DoubleDouble>, phi: f64) -> f64 {
    let long = DoubleDouble::from_f64;
    let step = metric.half_width() * long(STEP);
    let root = |steps: f64| metric.mu(long(phi) + long(steps) * step).sqrt();
    let middle = root(0.0);
    let mut sum = middle * long(WEIGHTS[0]);
    for (j, weight) in WEIGHTS.iter().enumerate().skip(1) {
        let steps = j as f64;
        sum += (root(steps) + root(-steps)) * long(*weight);
    }
    (-sum / (long(180.0) * step * step * middle)).to_f64()
}

/// Curvature of one body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Curvature {
    /// The body.
    pub body: Body,
    /// Number of rows, odd, so that the equator is one of them.
    pub points: usize,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-curvature",
    summary: "metric coefficient and Gauss curvature over one strip, by formula and by differences",
    code: &[
        "effects/serret_andoyer/curvature.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Curvature {
    /// z, μ and G by their formulas.
    fn formulas<S: Real>(&self, phi: &[f64]) -> Result<Vec<[f64; 3]>, NodeError> {
        let metric = self.body.metric::<S>()?;
        let row = |phi: &f64| {
            let phi = S::from_f64(*phi);
            [S::from_f64(2.0) * metric.z(phi), metric.mu(phi), metric.gauss_curvature(phi)].map(S::to_f64)
        };
        Ok(phi.iter().map(row).collect())
    }
}

impl Compute for Curvature {
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
        if self.points < 3 || self.points.is_multiple_of(2) {
            return Err(NodeError::new(format!("points = {}: an odd number of at least 3 is needed", self.points)));
        }
        let metric = self.body.metric::<f64>()?;
        let long = self.body.metric::<DoubleDouble>()?;
        let half = (self.points / 2) as f64;
        let phi: Vec<f64> = (0..self.points).map(|i| metric.half_width() * ((i as f64 - half) / half)).collect();
        let by_differences: Vec<f64> = phi.par_iter().map(|phi| curvature_by_differences(&long, *phi)).collect();
        let formulas = in_arithmetic!(arithmetic, S => self.formulas::<S>(&phi))?;
        let of = |i: usize| formulas.iter().map(|row| row[i]).collect::<Vec<_>>();
        let table = Table::builder("curvature", "metric coefficient and Gauss curvature over the strip |φ| ≤ K(k)/α")
            .column("z", "1/length²", "z(φ) = 2/μ(φ)", of(0))
            .column("mu", "length²", "μ(φ), the square of the radius of the parallel", of(1))
            .column("curvature", "1/length²", "Gauss curvature, formula in z", of(2))
            .column("curvature_by_differences", "1/length²", "Gauss curvature, −(√μ)''/√μ", by_differences)
            .column("phi", "length", "distance from the equator", phi)
            .build()
            .map_err(failed("curvature"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * self.points as u64, ..Work::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the sphere-like limit is out of the chart's reach, so the formula at the equator, (B−A)(C−A)/A, and at the edge,
    /// −(B−A)(C−B)/B, for a body that is none of the article's.
    #[test]
    fn differences_at_equator_and_edge() {
        let body = Body { a: 0.7, b: 1.1, c: 1.9 };
        let metric = body.metric::<DoubleDouble>().unwrap();
        let edge = body.metric::<f64>().unwrap().half_width();
        let at = |phi| curvature_by_differences(&metric, phi);
        // Truncation below 1e-15; the edge itself is rounded, where G' = 0.
        assert!((at(0.0) - 0.4 * 1.2 / 0.7).abs() <= 1e-14, "{}", at(0.0));
        assert!((at(edge) + 0.4 * 0.8 / 1.1).abs() <= 1e-14, "{}", at(edge));
    }
}
