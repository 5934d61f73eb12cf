//! What a straightforward program would compute for the spin problem in `f64`: the first conjugate time by the chart of Lemma 4.1, by the
//! lift, or by the closed forms as one writes them down at first. They are here to be compared with; nothing else uses them.
//!
//! Each returns NaN where nothing comes out. What they do not know: limits, cancellation, and how large their own error is.

use crate::geometry::spin::lift::{first_conjugate_time_by_integration, trajectory};
use crate::geometry::spin::printed_chart::PrintedChart;
use crate::numerics::counts::Work;
use crate::numerics::elliptic::incomplete::incomplete_pi;
use crate::numerics::elliptic::jacobi::{Jacobi, jacobi_epsilon};
use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::integrator::integrate;
use crate::numerics::runge_kutta::rate::{ByRate, RightHandSide, Trace};
use crate::numerics::taylor::integrator::{Observer, Settings, Step};
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// The relative error that the integrations ask of a step: what one asks of a good integrator in `f64`.
const TOLERANCE: f64 = 1e-12;
/// Steps after which the chart is given up.
const MOST_STEPS: u64 = 3_000;
/// Halvings of a bracket: more than 53 bits.
const HALVINGS: usize = 60;
/// What the variation of the place is measured by while it is small, in units of that of the momenta.
const AT_START: f64 = 1e-3;
/// Steps in which the closed form's sign is looked at, per half turn of a great circle.
const SAMPLES: f64 = 24.0;

/// The printed equations of Lemma 4.1 with their variation by `p_θ(0)`.
struct Chart(PrintedChart<f64>);

impl RightHandSide<f64> for Chart {
    type State<T: Copy> = [T; 8];

    fn rate(&self, _: f64, state: &[f64; 8]) -> [f64; 8] {
        self.0.rate(state)
    }

    fn scales(&self, state: &[f64; 8]) -> [f64; 8] {
        let momentum = state[2].abs().max(state[3].abs());
        let pushed = state[6].abs().max(state[7].abs());
        // The variation of the place is zero at the start; that of the momenta is not.
        let moved = state[4].abs().max(state[5].abs()).max(AT_START * pushed);
        [1.0, 1.0, momentum, momentum, moved, moved, pushed, pushed]
    }
}

/// Stops at the first sign change of `p_φ δθ − p_θ δφ` from one end of a step to the other, and halves it down to the time.
struct FirstSignChange {
    found: ChartPoint,
}

/// A first conjugate point in the chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChartPoint {
    /// The time.
    pub(super) time: f64,
    /// θ, as the integration has it, brought to (−π, π].
    pub(super) theta: f64,
}

impl Observer<f64, Trace<Chart>> for FirstSignChange {
    fn observe(&mut self, step: &Step<'_, f64, Trace<Chart>>, _: &mut Work) -> ControlFlow<()> {
        let determinant = |offset: f64| {
            let [_, _, pt, pp, dtheta, dphi, ..] = step.state(offset);
            pp * dtheta - pt * dphi
        };
        let (first, last) = (determinant(0.0), determinant(step.length));
        if step.first || first * last >= 0.0 {
            return ControlFlow::Continue(());
        }
        let (mut low, mut high) = (0.0, step.length);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if determinant(middle) * first > 0.0 { low = middle } else { high = middle }
        }
        let turn = 2.0 * PI;
        let theta = step.state(high)[0];
        self.found = ChartPoint { time: step.time(high), theta: theta - turn * (theta / turn + 0.5).floor() };
        ControlFlow::Break(())
    }
}

/// The first conjugate time by integration of Lemma 4.1's Hamiltonian in its chart, up to `t_max`.
pub(super) fn by_chart(k: f64, p_theta: f64, t_max: f64) -> ChartPoint {
    let settings = Settings { maximum_steps: MOST_STEPS, ..Settings::new(TOLERANCE) };
    let mut first = FirstSignChange { found: ChartPoint { time: f64::NAN, theta: f64::NAN } };
    // An integration that fails has found nothing.
    let _ = integrate(
        Dop853,
        &ByRate::new(Chart(PrintedChart::new(k))),
        &PrintedChart::start(p_theta),
        (0.0, t_max),
        &settings,
        &mut first,
    );
    first.found
}

/// The first conjugate time by integration of the lift to R³ × so(3)*, up to `t_max`.
pub(super) fn by_lift(k: f64, p_theta: f64, t_max: f64) -> f64 {
    first_conjugate_time_by_integration(k, p_theta, TOLERANCE, t_max).map_or(f64::NAN, |(found, _)| found.t1)
}

/// The points at these times by integration of the lift.
pub(super) fn points_by_lift(k: f64, p_theta: f64, times: &[f64]) -> Vec<[f64; 3]> {
    trajectory(k, p_theta, times, TOLERANCE).map_or_else(|_| vec![[f64::NAN; 3]; times.len()], |(points, _)| points)
}

/// `A cos λ − B sin λ` at a time, in the closed form as it is first written down: `m' = 1 − m`, divisions by m and m', `G² δβ' − p β'`.
fn conjugate_scalar(k: f64, p: f64, t: f64) -> f64 {
    let g = (p * p + 4.0).sqrt();
    let b = p / (2.0 * k);
    let q2 = 4.0 * (k * k - 1.0);
    let (lambda, delta, delta_rate, rate);
    if k < 1.0 {
        let l2 = 1.0 / (k * k) - 1.0;
        let c0 = (b * b + l2).sqrt();
        let m = l2 / (c0 * c0);
        let mc = 1.0 - m;
        let u = c0 * t;
        let Jacobi { sn, cn, dn, am } = Jacobi::new(u, m, mc);
        let energy = jacobi_epsilon(u, m, mc);
        delta = energy / (2.0 * k * c0 * dn);
        delta_rate = (dn + m * energy * sn * cn / (dn * dn)) / (2.0 * k);
        rate = b / dn;
        let n = 1.0 - k * k * mc;
        lambda = 2.0 / g * (t + p * p / (4.0 * c0) * incomplete_pi(am, n, 1.0 - n, m, mc));
    } else if p * p > q2 {
        let m = q2 / (p * p);
        let mc = 1.0 - m;
        let u = b * t;
        let Jacobi { sn, cn, dn, am } = Jacobi::new(u, m, mc);
        let x = (jacobi_epsilon(u, m, mc) - m * sn * cn / dn) / mc;
        delta = dn * x / (2.0 * k * b);
        delta_rate = (1.0 / dn - m * sn * cn * x) / (2.0 * k);
        rate = b * dn;
        let n = 1.0 - mc / (k * k);
        lambda = 2.0 / g * t
            + 2.0 * b * mc / g * incomplete_pi(am, n, 1.0 - n, m, mc)
            + libm::atan((k * k - 1.0) * g * sn * cn / (k * p * dn));
    } else {
        let w = (1.0 - 1.0 / (k * k)).sqrt();
        let m = p * p / q2;
        let mc = 1.0 - m;
        let u = w * t;
        let Jacobi { sn, cn, dn, am } = Jacobi::new(u, m, mc);
        let c = (jacobi_epsilon(u, m, mc) - mc * u) / m;
        let (y, v) = ((sn * dn - m * cn * c) / mc, (cn * (dn * dn - m) + m * sn * dn * c) / mc);
        delta = y / (2.0 * k * w);
        delta_rate = v / (2.0 * k);
        rate = b * cn;
        let n = 1.0 - 4.0 * mc / (g * g);
        lambda = g * u / (2.0 * k * k * w)
            + 2.0 * w * mc / g * incomplete_pi(am, n, 1.0 - n, m, mc)
            + libm::atan(p * p * sn * cn / (2.0 * w * g * dn));
    }
    let (sine, cosine) = libm::sincos(lambda);
    2.0 * g * delta * cosine - (g * g * delta_rate - p * rate) * sine
}

/// The first conjugate time by the closed form as it is first written down: the first sign change that a scan up to `t_max` sees, halved down.
pub(super) fn by_printed_forms(k: f64, p_theta: f64, t_max: f64) -> f64 {
    // λ' = G/2 at the start. The scalar vanishes there to third order: the first samples are left out.
    let step = 2.0 * PI / (SAMPLES * (p_theta * p_theta + 4.0).sqrt()) * k.min(1.0);
    let value = |t: f64| conjugate_scalar(k, p_theta, t);
    let mut low = 3.0 * step;
    let first = value(low);
    while low < t_max {
        let mut high = low + step;
        if value(high) * first <= 0.0 {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if value(middle) * first > 0.0 { low = middle } else { high = middle }
            }
            return high;
        }
        low = high;
    }
    f64::NAN
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spin::conjugate::first_conjugate_point;
    use crate::geometry::spin::start::Start;

    /// Where nothing is hard all three find what the closed form finds: the formulas are written down rightly, and what they lose elsewhere is
    /// lost by the formulation. 1e-9: a tolerance of 1e-12 a step, and conditions below 100.
    #[test]
    fn naive_formulations_are_right_where_nothing_is_hard() {
        for (k, p) in [(0.8, 0.7), (0.5, 3.0), (1.2, 0.8), (1.2, 3.0), (1.5, 1.0), (2.0, 9.0)] {
            let t1 = first_conjugate_point(&Start::new(k, p).unwrap()).unwrap().t1;
            for (name, found) in [
                ("chart", by_chart(k, p, 1.2 * t1).time),
                ("lift", by_lift(k, p, 1.2 * t1)),
                ("printed", by_printed_forms(k, p, 1.2 * t1)),
            ] {
                assert!((found / t1 - 1.0).abs() < 1e-9, "{name} {k} {p}: {found} {t1}");
            }
        }
    }
}
