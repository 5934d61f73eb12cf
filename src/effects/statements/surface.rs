//! The surfaces on which the statements of section 3.3.1 are checked, and their geodesics.
//!
//! `1/μ = W = 1 + aφ² + bφ⁴` has an equator, a mirror there, and a pendulum that is hard or soft by the choice of `b`. The Gauss curvature
//! is `W''/(2W) − 3W'²/(4W²)`, `a` on the equator. For `b < 2a²/3` that is the largest, and the first return falls with `p_θ` (tame); for
//! larger `b` it grows about the equator. Geodesics are integrated with the variation by `p_θ` by a Runge-Kutta pair that shares nothing with
//! the closed forms. The substitution `φ = φ+ sin s` makes period and first return means over a turn.

use super::differences::{Wide, wide};
use super::statement::{Samples, Unexamined, unexamined};
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::integrator::integrate;
use crate::numerics::runge_kutta::rate::{ByRate, RightHandSide};
use crate::numerics::taylor::integrator::Settings;

/// A surface and Clairaut's constant `p_θ < 1` of a geodesic that oscillates about the equator.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// `a`.
    pub a: f64,
    /// `b`.
    pub b: f64,
    /// `p_θ`.
    pub p: f64,
}

impl Surface {
    /// A tame one: `−0.2 < b/a² < 0.5`, for `b ≥ 0` with any `p_θ`.
    pub fn tame(samples: &mut Samples) -> Self {
        let (a, part) = (samples.log(0.3, 3.0), samples.even(-0.2, 0.5));
        // 1/p² − 1 < 1 stays below the height a²/(4|b|) of a soft pendulum's wall.
        let p = if part < 0.0 { low(samples) } else { any(samples) };
        Self { a, b: a * a * part, p }
    }

    /// One whose first return grows with `p_θ`.
    pub fn hard(samples: &mut Samples) -> Self {
        let a = samples.log(0.3, 3.0);
        Self { a, b: a * a * samples.even(2.0, 5.0), p: low(samples) }
    }

    /// One with any of these, tame or not: `0 ≤ b/a² < 5`.
    pub fn any(samples: &mut Samples) -> Self {
        let a = samples.log(0.3, 3.0);
        Self { a, b: a * a * samples.even(0.0, 5.0), p: any(samples) }
    }

    /// `W` and its first two derivatives.
    pub fn inverse_mu(&self, phi: f64) -> [f64; 3] {
        let s = phi * phi;
        let slope = phi * (2.0 * self.a + 4.0 * self.b * s);
        [1.0 + s * (self.a + self.b * s), slope, 2.0 * self.a + 12.0 * self.b * s]
    }

    /// The Gauss curvature `−(√μ)''/√μ`.
    pub fn curvature(&self, phi: f64) -> f64 {
        let [w, w1, w2] = self.inverse_mu(phi);
        w2 / (2.0 * w) - 0.75 * (w1 / w) * (w1 / w)
    }

    /// `φ+`, where `p² W = 1`.
    pub fn turning(&self, p: Wide) -> Wide {
        let (a, b, two) = (wide(self.a), wide(self.b), wide(2.0));
        let height = Wide::ONE / (p * p) - Wide::ONE;
        (two * height / (a + (a * a + wide(4.0) * b * height).sqrt())).sqrt()
    }

    /// Period and first return as means over a turn of `1/√(a + b φ+²(1 + sin² s))`, and of W times that.
    pub fn returns(&self, p: Wide) -> [Wide; 2] {
        let (a, b, square) = (wide(self.a), wide(self.b), self.turning(p) * self.turning(p));
        let count = 24;
        let mut sums = [Wide::ZERO; 2];
        for i in 0..count {
            let sine = (Wide::PI * wide((f64::from(i) + 0.5) / f64::from(count))).sin();
            let x = square * sine * sine;
            let weight = Wide::ONE / (a + b * (square + x)).sqrt();
            sums[0] += weight;
            sums[1] += weight * (Wide::ONE + a * x + b * x * x);
        }
        let mean = wide(1.0 / f64::from(count));
        [wide(2.0) * Wide::PI / p * sums[0] * mean, Wide::PI * sums[1] * mean]
    }

    /// `T`.
    pub fn period(&self) -> f64 {
        self.returns(wide(self.p))[0].to_f64()
    }

    /// `[φ, p_φ, θ, δφ, δp_φ, δθ]` after a time, from the equator upwards.
    pub fn after(&self, from: &[f64; 6], span: f64) -> Result<[f64; 6], Unexamined> {
        let flow = ByRate::new(*self);
        let arrival =
            integrate(Dop853, &flow, from, (0.0, span), &Settings::new(1e-14), &mut ()).map_err(unexamined)?;
        Ok(arrival.state)
    }

    /// The state on the equator, ascending; the variation by `p_θ` keeps the energy.
    pub fn start(&self) -> [f64; 6] {
        let p_phi = ((1.0 - self.p) * (1.0 + self.p)).sqrt();
        [0.0, p_phi, 0.0, 0.0, -self.p / p_phi, 0.0]
    }

    /// Whether `δφ` keeps its sign on `(0, end)`. Its zeros are at least a half turn of the largest curvature apart, many times the step.
    pub fn no_conjugate_point(&self, end: f64) -> Result<bool, Unexamined> {
        let (mut state, count) = (self.start(), 24);
        for _ in 0..count {
            state = self.after(&state, end / f64::from(count))?;
            if state[3] >= 0.0 {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// A `p_θ` whose geodesic stays at a moderate height.
fn low(samples: &mut Samples) -> f64 {
    1.0 / (1.0 + samples.even(0.05, 0.9)).sqrt()
}

/// Any `p_θ`: a third each close to the meridian, close to the equator, and between.
fn any(samples: &mut Samples) -> f64 {
    match samples.even(0.0, 3.0) {
        x if x < 1.0 => samples.log(0.02, 0.3),
        x if x < 2.0 => 1.0 - samples.log(1e-3, 0.1),
        _ => samples.even(0.3, 0.9),
    }
}

impl RightHandSide<f64> for Surface {
    type State<T: Copy> = [T; 6];

    fn rate(&self, _: f64, x: &[f64; 6]) -> [f64; 6] {
        let (p, [w, w1, w2]) = (self.p, self.inverse_mu(x[0]));
        [x[1], -0.5 * p * p * w1, p * w, x[4], -p * w1 - 0.5 * p * p * w2 * x[3], w + p * w1 * x[3]]
    }

    fn scales(&self, _: &[f64; 6]) -> [f64; 6] {
        [1.0; 6]
    }
}
