//! What a straightforward program computes on SO(3), in plain `f64`: the naive formulations that the hard cases are compared with.
//!
//! - The first conjugate time as the first change of sign of `det[ξ1 ξ2 ξ3]` along an integration of momentum and three Jacobi fields by
//!   DOP853 at 1e-13, looked at in `LOOKS` places a step: pairs of roots between two looks are not seen.
//! - The body momentum of Euler angles by the printed `q = (p1 − p3 cos Φ2)/sin Φ2`.
//! - The momentum after a long time by integrating Hamilton's equations of the printed `H_n(Φ, p)` (section 2.3) in the chart.
//!
//! Units: radians, time as in (2). Nothing here is used by any answer.

use crate::geometry::rotation_group::body_flow::BodyFlow;
use crate::numerics::counts::Work;
use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::integrator::integrate;
use crate::numerics::runge_kutta::rate::{ByCoefficients, ByRate, RightHandSide};
use crate::numerics::taylor::flow::{Columns, Flow, Joined, WithColumns};
use crate::numerics::taylor::integrator::{Compensated, Observer, Settings, Step};
use std::ops::ControlFlow;

/// Requested relative error a step.
const TOLERANCE: f64 = 1e-13;
/// The same in the chart, for a long time: what one asks for where 1e-13 would take too long.
const LONG_TOLERANCE: f64 = 1e-9;
/// Places a step where the sign is looked at.
const LOOKS: usize = 8;
/// Steps after which the search for a sign gives up: a family must not take longer than the answers themselves.
const MOST_STEPS: u64 = 300;
/// Steps after which the long integration gives up.
const MOST_LONG_STEPS: u64 = 250_000;
/// Turns of the slowest axis that are searched.
const TURNS: f64 = 4.0;
/// Before this fraction of a turn of the fastest axis the determinant is zero by rounding.
const ARMED: f64 = 0.05;

type System = WithColumns<BodyFlow<f64>, (), 3>;

fn determinant(state: &Joined<[f64; 3], Columns<[f64; 6], 3>>) -> f64 {
    let [a, b, c] = state.columns.0.map(|[_, _, _, x, y, z]| [x, y, z]);
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

struct SignChange {
    armed: f64,
    sign: Option<bool>,
    found: Option<f64>,
}

impl Observer<f64, System> for SignChange {
    fn observe(&mut self, step: &Step<'_, f64, System>, _: &mut Work) -> ControlFlow<()> {
        let mut before = 0.0;
        for look in 1..=LOOKS {
            let offset = step.length * look as f64 / LOOKS as f64;
            if step.time(offset) < self.armed {
                continue;
            }
            let positive = |offset: f64| determinant(&step.state(offset)) > 0.0;
            let now = positive(offset);
            if self.sign.is_some_and(|sign| sign != now) {
                let (mut low, mut high) = (before, offset);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if positive(middle) == now { high = middle } else { low = middle }
                }
                self.found = Some(step.time(high));
                return ControlFlow::Break(());
            }
            self.sign = Some(now);
            before = offset;
        }
        ControlFlow::Continue(())
    }
}

/// The first change of sign of the determinant; NaN where none is seen.
pub fn first_sign_change([a, b, c]: [f64; 3], momentum: [f64; 3]) -> f64 {
    let system = WithColumns { flow: BodyFlow { inverse_inertia: [a, b, c] }, parameters: [(), (), ()] };
    let size = libm::sqrt(momentum.iter().map(|m| m * m).sum());
    let column = |i: usize| {
        let mut column = [0.0; 6];
        column[i] = size;
        column
    };
    let start = Joined { base: momentum, columns: Columns([column(0), column(1), column(2)]) };
    let turn = |inverse: f64| 2.0 * std::f64::consts::PI / (inverse * size);
    let mut seen = SignChange { armed: ARMED * turn(a.max(b).max(c)), sign: None, found: None };
    let settings = Settings { maximum_steps: MOST_STEPS, ..Settings::new(TOLERANCE) };
    let span = (0.0, TURNS * turn(a.min(b).min(c)));
    // Out of steps: what was found so far, that is nothing.
    let _ = integrate(Dop853, &ByCoefficients(&system), &start, span, &settings, &mut seen);
    seen.found.unwrap_or(f64::NAN)
}

/// The body momentum by the printed formula.
pub fn printed_momentum(phi2: f64, phi3: f64, [p1, p2, p3]: [f64; 3]) -> [f64; 3] {
    let (s2, c2) = libm::sincos(phi2);
    let (s3, c3) = libm::sincos(phi3);
    let q = (p1 - p3 * c2) / s2;
    [p2 * s3 - q * c3, p2 * c3 + q * s3, p3]
}

/// Hamilton's equations of the printed Hamiltonian: `[Φ2, Φ3, p2, p3]`, p1 constant.
struct PrintedEquations {
    inverse_inertia: [f64; 3],
    p1: f64,
}

impl RightHandSide<f64> for PrintedEquations {
    type State<T: Copy> = [T; 4];

    fn rate(&self, _: f64, &[phi2, phi3, p2, p3]: &[f64; 4]) -> [f64; 4] {
        let [a, b, c] = self.inverse_inertia;
        let (s2, c2) = libm::sincos(phi2);
        let (s3, c3) = libm::sincos(phi3);
        let q = (self.p1 - p3 * c2) / s2;
        let (m1, m2) = (p2 * s3 - q * c3, p2 * c3 + q * s3);
        let by_q = b * m2 * s3 - a * m1 * c3;
        [a * m1 * s3 + b * m2 * c3, c * p3 - by_q * c2 / s2, -by_q * (p3 - q * c2 / s2), (b - a) * m1 * m2]
    }

    fn scales(&self, _: &[f64; 4]) -> [f64; 4] {
        [1.0, 1.0, self.p1, self.p1]
    }
}

/// Records p3 at given times.
struct Recorder<'t> {
    times: &'t [f64],
    values: Vec<f64>,
}

impl<F: Flow<f64, State<f64> = [f64; 4]>> Observer<f64, F> for Recorder<'_> {
    fn looks_into(&self, start: &Compensated<f64>, length: f64) -> bool {
        self.times.get(self.values.len()).is_some_and(|time| *time <= start.value + length)
    }

    fn observe(&mut self, step: &Step<'_, f64, F>, _: &mut Work) -> ControlFlow<()> {
        while let Some(time) = self.times.get(self.values.len()) {
            let offset = (time - step.start.value) - step.start.rest;
            if offset > step.length {
                return ControlFlow::Continue(());
            }
            self.values.push(step.state(offset)[3]);
        }
        ControlFlow::Break(())
    }
}

/// `M3/|M|` at rising times by the chart, with the momentum along the third axis in space (the article's (4)); NaN from where it gives up.
pub fn cosines_in_the_chart(inverse_inertia: [f64; 3], momentum: [f64; 3], times: &[f64]) -> Vec<f64> {
    let [x, y, z] = momentum;
    let size = libm::sqrt(x * x + y * y + z * z);
    let (phi2, phi3) = (libm::acos(z / size), libm::atan2(y, -x));
    let mut seen = Recorder { times, values: Vec::with_capacity(times.len()) };
    let settings = Settings { maximum_steps: MOST_LONG_STEPS, ..Settings::new(LONG_TOLERANCE) };
    let equations = PrintedEquations { inverse_inertia, p1: size };
    let span = (0.0, times.last().copied().unwrap_or(0.0) * 1.001);
    let _ = integrate(Dop853, &ByRate::new(equations), &[phi2, phi3, 0.0, z], span, &settings, &mut seen);
    seen.values.resize(times.len(), f64::NAN);
    seen.values.iter().map(|p3| p3 / size).collect()
}
