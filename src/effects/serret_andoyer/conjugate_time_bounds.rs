//! `t1 M/K` of oscillating extremals of one `ξ1` against the phase of the start (Theorem 3.9, part 1), in closed form.
//!
//! `ψ0` is the phase since the last turning point, in `(0, 2K)`; rows are spaced like `1 − cos`, closer at the turning points. The bounds: 2 from below;
//! from above 3 as printed, and `4 − ψ0/K`, which holds: half a period and the time to the first turning point. The article's `t1` is the smaller
//! `|t|` of both signs; the first conjugate time backward is that of the descending extremal.
//!
//! Starts are φ0 at the phase wanted, rounded; the phase in the table is that of the rounded start. Between a turning point near the edge
//! `φ = ±K(k)/α` and the edge, φ0 is a poor coordinate: at `ξ1 = 0.9999` t1 moves by 8e4 times what φ0 moves by. So the closed forms are evaluated in
//! double-double for the start as it stands in the table, and rounded: times are good to f64 whatever the condition.

use super::body::{Body, ClairautStart};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::conjugate::conjugate_time_bounds;
use crate::geometry::serret_andoyer::{Metric, first_conjugate_point};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::PI;

/// The extremals of one `ξ1`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugateTimeBounds {
    /// The body.
    pub body: Body,
    /// `1 − ξ1`, in `(0, 1)`.
    pub one_minus_xi1: f64,
    /// Number of starts.
    pub starts: usize,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-conjugate-time-bounds",
    summary: "first conjugate times in units of K/M against the phase of the start, with their bounds",
    code: &[
        "effects/serret_andoyer/conjugate_time_bounds.rs",
        "effects/serret_andoyer/body.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// `δ = B p_θ² − 1` of `1 − ξ1`, from `1 − ξ1 = Bδ/((1 + δ)(B − A))`.
pub fn delta_of(body: &Body, one_minus_xi1: f64) -> Result<f64, NodeError> {
    if !(one_minus_xi1 > 0.0 && one_minus_xi1 < 1.0) {
        return Err(NodeError::new(format!("1 − xi1 = {one_minus_xi1:?}: a number between 0 and 1 is needed")));
    }
    let part = (body.b - body.a) * one_minus_xi1;
    Ok(part / (body.b - part))
}

/// The ascending start of constant δ at the phase `ψ0 = part·K`.
///
/// # Errors
/// No oscillating extremal.
pub fn start_at_phase(metric: &Metric, delta: f64, part: f64) -> Result<ClairautStart, NodeError> {
    let on_equator = ClairautStart { phi0: 0.0, delta, branch: 1 }.extremal(metric)?;
    let time = on_equator.complete_k() * (part - 1.0) / on_equator.speed();
    Ok(ClairautStart { phi0: on_equator.position(time).phi, delta, branch: 1 })
}

/// An ascending start, its first conjugate point, and `t1 M/K` of it and of the descending one.
pub(super) struct Row {
    pub(super) start: ClairautStart,
    pub(super) phase: f64,
    pub(super) complete_k: f64,
    pub(super) t1: f64,
    pub(super) theta: f64,
    pub(super) phi: f64,
    pub(super) ratio: f64,
    pub(super) backward: f64,
    pub(super) upper: f64,
    pub(super) elliptic_calls: u64,
}

impl Row {
    /// Everything about a start, in double-double, rounded.
    pub(super) fn of(metric: &Metric<DoubleDouble>, start: ClairautStart) -> Result<Self, NodeError> {
        let doing = start.to_string();
        let extremal = start.extremal(metric)?;
        let point = first_conjugate_point(&extremal).map_err(failed(&doing))?;
        let bounds = conjugate_time_bounds(&extremal).map_err(failed(&doing))?;
        let descending = ClairautStart { branch: -1, ..start }.extremal(metric)?;
        let backward = conjugate_time_bounds(&descending).map_err(failed(&doing))?.ratio;
        Ok(Self {
            start,
            phase: (extremal.psi0() / extremal.complete_k()).to_f64(),
            complete_k: extremal.complete_k().to_f64(),
            t1: point.t1.to_f64(),
            theta: point.theta.to_f64(),
            phi: point.phi.to_f64(),
            ratio: bounds.ratio.to_f64(),
            backward: backward.to_f64(),
            upper: bounds.upper.to_f64(),
            elliptic_calls: 3 * point.elliptic_calls as u64 + 6,
        })
    }
}

impl Compute for ConjugateTimeBounds {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let metric = self.body.metric::<f64>()?;
        let long = self.body.metric::<DoubleDouble>()?;
        let delta = delta_of(&self.body, self.one_minus_xi1)?;
        let row = |i: usize| {
            // 1 − cos, without cancellation.
            let half = Real::sin(0.5 * PI * (i as f64 / (self.starts + 1) as f64));
            Row::of(&long, start_at_phase(&metric, delta, 2.0 * half * half)?)
        };
        let rows = (1..=self.starts).into_par_iter().map(row).collect::<Result<Vec<_>, NodeError>>()?;
        let column = |f: fn(&Row) -> f64| rows.iter().map(f).collect::<Vec<_>>();
        let table = Table::builder("conjugate-time-bounds", "first conjugate times in units of K/M against the phase")
            .column("phi0", "length", "distance of the start from the equator", column(|r| r.start.phi0))
            .column("delta", "1", "B p_θ² − 1", column(|r| r.start.delta))
            .column("branch", "1", "sign of φ' at the start", vec![1_i64; rows.len()])
            .column("psi0_over_k", "1", "phase since the last turning point over K(m)", column(|r| r.phase))
            .column("t1", "length", "first conjugate time t > 0", column(|r| r.t1))
            .column("theta", "rad", "θ there", column(|r| r.theta))
            .column("phi", "length", "φ there", column(|r| r.phi))
            .column("ratio", "1", "t1 M/K", column(|r| r.ratio))
            .column("ratio_backward", "1", "the same backward in time", column(|r| r.backward))
            .column("ratio_smaller", "1", "the smaller of both", column(|r| r.ratio.min(r.backward)))
            .column("upper", "1", "the bound that holds, 4 − ψ0/K", column(|r| r.upper))
            .build()
            .map_err(failed("bounds"))?;
        let elliptic_calls = rows.iter().map(|row| row.elliptic_calls).sum();
        product(&table, Work { elliptic_calls, roots_solved: 3 * rows.len() as u64, ..Work::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the definition, and the phase that comes back.
    #[test]
    fn starts_have_the_xi1_and_the_phase_asked_for() {
        let body = Body { a: 1.5, b: 2.0, c: 2.8 };
        let metric = body.metric::<f64>().unwrap();
        for (d, part) in [(0.9, 0.2), (0.1, 1.7), (1e-9, 0.5), (1e-15, 1.0)] {
            let delta = delta_of(&body, d).unwrap();
            let extremal = start_at_phase(&metric, delta, part).unwrap().extremal(&metric).unwrap();
            assert!((extremal.one_minus_xi1() / d - 1.0).abs() <= 8.0 * f64::EPSILON);
            // φ0 near the edge K/α is rounded to ε, and the phase moves by 1/√m' times that: 3e7 at d = 1e-15.
            let condition = 1.0 / Real::sqrt(extremal.complementary_parameter());
            let back = extremal.psi0() / extremal.complete_k();
            assert!((back - part).abs() <= 64.0 * f64::EPSILON * condition, "{d} {part}: {back}");
        }
        assert!(delta_of(&body, 0.0).is_err() && delta_of(&body, 1.0).is_err());
    }
}
