//! The right component (`p_θ > 0`) of the conjugate locus of a start `(0, φ0)` (Theorem 3.24), in closed form; the left one is its mirror.
//!
//! Rows run from the asymptote of the ascending branch through the cusp, `p_θ = √μ(φ0)`, to the asymptote of the descending branch. With
//! `δ = B p_θ² − 1` and `φ'(0)² = s² φ'_max²`, `δ = δ_max (1 − s²)`: rows are equally spaced in s near the cusp, where place and time are smooth in s (as they are in
//! ψ0, but not in `p_θ`), and then in √(log 1/δ) towards the separatrix: ever wider apart where the locus runs to infinity.

use super::body::{Body, ClairautStart};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::{ConjugatePoint, Extremal, Metric, first_conjugate_point};
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Where the spacing in s gives way to that in √(log 1/δ), as a part of `δ_max`.
const JOIN: f64 = 0.25;

/// How the constants of an oscillating fan are spaced, from the cusp to the separatrix.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spacing {
    /// The smallest δ as a part of the largest, below 1/4.
    pub smallest: f64,
    /// Intervals in s, from the cusp.
    pub cusp: usize,
    /// Intervals in √(log 1/δ), to the separatrix.
    pub tail: usize,
}

impl Spacing {
    /// δ from the largest at `φ0` to the smallest.
    ///
    /// # Errors
    /// A start outside the strip, or a spacing that is none.
    pub fn deltas(&self, metric: &Metric, phi0: f64) -> Result<Vec<f64>, NodeError> {
        let width = metric.half_width();
        if phi0.is_nan() || phi0.abs() >= width {
            return Err(NodeError::new(format!("phi0 = {phi0:?}: |phi0| < K(k)/alpha = {width:?} is needed")));
        }
        let Self { smallest, cusp, tail } = *self;
        if !(smallest > 0.0 && smallest < JOIN) || cusp == 0 || tail == 0 {
            return Err(NodeError::new(format!("no spacing: smallest {smallest:?}, {cusp} and {tail} intervals")));
        }
        let jacobi = metric.jacobi_of_phi(phi0);
        // δ_max = B μ − 1 = (B − A) cn²/Z: nothing cancels.
        let largest = (metric.b() - metric.a()) * jacobi.cn * jacobi.cn / metric.z_of_sine(jacobi.sn);
        let near = (0..=cusp).map(|i| {
            let part = i as f64 / cusp as f64;
            largest * (1.0 - (1.0 - JOIN) * part * part)
        });
        let (from, to) = (Real::ln(JOIN), Real::ln(smallest));
        let far = (1..=tail).map(|j| {
            let part = j as f64 / tail as f64;
            largest * Real::exp(from + (to - from) * part * part)
        });
        Ok(near.chain(far).collect())
    }
}

/// The conjugate locus of one start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugateLocus {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Which constants.
    pub spacing: Spacing,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-conjugate-locus",
    summary: "first conjugate points of all oscillating extremals from one point, in closed form",
    code: &[
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

/// An extremal and its first conjugate point.
pub type OnExtremal<S> = (Extremal<S>, ConjugatePoint<S>);

/// The first conjugate points of these starts.
///
/// # Errors
/// A start without a conjugate point, by its parameters.
pub fn conjugate_points<S: Real>(
    metric: &Metric<S>,
    starts: &[ClairautStart],
) -> Result<Vec<OnExtremal<S>>, NodeError> {
    let point = |start: &ClairautStart| {
        let extremal = start.extremal(metric)?;
        let point = first_conjugate_point(&extremal).map_err(failed(&start.to_string()))?;
        Ok((extremal, point))
    };
    starts.par_iter().map(point).collect()
}

/// The work of closed-form conjugate points.
pub fn closed_form_work<S: Real>(points: &[OnExtremal<S>]) -> Work {
    let elliptic_calls = points.iter().map(|(_, point)| point.elliptic_calls as u64).sum();
    let roots_solved = points.iter().filter(|(_, point)| point.iterations > 0).count() as u64;
    Work { elliptic_calls, roots_solved, ..Work::default() }
}

impl Compute for ConjugateLocus {
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

impl ConjugateLocus {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<f64>()?;
        let deltas = self.spacing.deltas(&metric, self.phi0)?;
        let start = |branch| move |delta: &f64| ClairautStart { phi0: self.phi0, delta: *delta, branch };
        let ascending = deltas.iter().rev().map(start(1));
        let starts: Vec<ClairautStart> = ascending.chain(deltas.iter().skip(1).map(start(-1))).collect();
        let points = conjugate_points(&self.body.metric::<S>()?, &starts)?;
        let column = |f: fn(&OnExtremal<S>) -> S| points.iter().map(|row| f(row).to_f64()).collect::<Vec<_>>();
        let table = Table::builder("conjugate-locus", "first conjugate points of one start, p_θ > 0")
            .column("phi0", "length", "distance of the start from the equator", vec![self.phi0; starts.len()])
            .column("delta", "1", "B p_θ² − 1", starts.iter().map(|s| s.delta).collect::<Vec<_>>())
            .column("branch", "1", "sign of φ' at the start", starts.iter().map(|s| s.branch).collect::<Vec<_>>())
            .column("p_theta", "1", "Clairaut's constant", column(|(extremal, _)| extremal.p_x()))
            .column("t1", "length", "first conjugate time", column(|(_, point)| point.t1))
            .column("theta", "rad", "θ there", column(|(_, point)| point.theta))
            .column("phi", "length", "φ there", column(|(_, point)| point.phi))
            .column("t1_error", "1", "estimate of the relative error of t1", column(|(_, point)| point.error))
            .build()
            .map_err(failed("conjugate locus"))?;
        product(&table, closed_form_work(&points))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_fall_from_the_cusp_to_the_smallest() {
        let metric = Body { a: 1.5, b: 2.0, c: 2.8 }.metric::<f64>().unwrap();
        let spacing = Spacing { smallest: 1e-8, cusp: 10, tail: 20 };
        let deltas = spacing.deltas(&metric, 0.0).unwrap();
        assert_eq!(deltas.len(), 31);
        assert!(deltas.windows(2).all(|pair| pair[1] < pair[0]), "{deltas:?}");
        // B/A − 1 and 1e-8 of it; exp loses ε times its argument, 18.
        assert!((deltas[0] - 1.0 / 3.0).abs() <= f64::EPSILON);
        assert!((deltas[30] * 3e8 - 1.0).abs() <= 32.0 * f64::EPSILON);
        assert!(spacing.deltas(&metric, 1.55).is_err());
        assert!(Spacing { smallest: 0.3, ..spacing }.deltas(&metric, 0.0).is_err());
    }
}
