//! The Serret-Andoyer flow (9) and its conjugate times by integration: the second route beside the closed forms.
//!
//! Equation (9): with `ν(y) = A sin²y + B cos²y`, `x' = p_x ν`, `y' = p_y (C − ν)`, `p_x' = 0`,
//! `p_y' = (B−A)(p_x² − p_y²) sin y cos y`. With `S = sin 2y` and `w = sin²y` as states it is polynomial:
//!
//! `C − ν = (C−B) + (B−A) w` (nothing cancels for B ≈ C), `w' = S y'`, `S' = 2 (1 − 2w) y'`,
//! `p_y' = ½ (B−A)(p_x² − p_y²) S`.
//!
//! **Conjugate scalar.** H is homogeneous of degree 2 in p, so `p·δq` is constant along every variation that keeps H;
//! started at a fixed point it is zero: `p_x δx + p_y δy = 0`. As `p_x` is a constant that is not zero, δq vanishes
//! exactly with δy. The variation is `δp(0) = (−y'(0), x'(0))`, tangent to the energy level; then
//! `δy'(0) = (C − ν) x'(0) > 0`: δy has a simple zero at t = 0 for every start, `p_y(0) = 0` included, and (as the
//! normal part of a Jacobi field on a surface) simple zeros only. No equation for δx is needed.
//!
//! Source: derived here from (9); the linearised equations are checked against 60-digit differences in the tests.
//! Units: angles in radians, time as in (9). Not known here: the chart (φ, θ), periods, closed forms.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::dense::sample;
use crate::numerics::taylor::events::{Component, Events};
use crate::numerics::taylor::flow::{Columns, Flow, Joined, Series, Tangent, WithColumns, convolve, convolve_square};
use crate::numerics::taylor::integrator::{IntegrationError, Settings, integrate};

/// The flow (9) at a fixed `p_x`. State: `[x, y, p_y, S = sin 2y, w = sin²y]`.
#[derive(Clone, Copy, Debug)]
pub struct SerretAndoyerFlow<S> {
    /// A, B, C: the inverse moments of inertia.
    pub inverse_inertia: [S; 3],
    /// The conserved momentum.
    pub p_x: S,
}

impl<S: Real> SerretAndoyerFlow<S> {
    /// The state at `x = 0` and this y and p_y.
    pub fn start(&self, y: S, p_y: S) -> [S; 5] {
        let (sine, cosine) = y.sin_cos();
        [S::ZERO, y, p_y, (sine + sine) * cosine, sine * sine]
    }

    /// `(x', y')` at a state.
    pub fn velocity(&self, state: &[S; 5]) -> (S, S) {
        let [a, b, c] = self.inverse_inertia;
        let [_, _, p_y, _, w] = *state;
        (self.p_x * (b - (b - a) * w), p_y * ((c - b) + (b - a) * w))
    }

    /// The energy H of (7).
    pub fn energy(&self, state: &[S; 5]) -> S {
        let (x_rate, y_rate) = self.velocity(state);
        (self.p_x * x_rate + state[2] * y_rate) * S::from_f64(0.5)
    }
}

impl<S: Real> Flow<S> for SerretAndoyerFlow<S> {
    type State<T: Copy> = [T; 5];
    /// `[C − ν, y', p_x² − p_y²]`.
    type Auxiliary<T: Copy> = [T; 3];

    #[inline(always)]
    fn coefficients(&self, n: usize, state: &[Series<S>; 5], auxiliary: &mut [Series<S>; 3]) -> [S; 5] {
        let [a, b, c] = self.inverse_inertia;
        let [_, _, p_y, sine, w] = state;
        let constant = |value: S| if n == 0 { value } else { S::ZERO };
        let half = S::from_f64(0.5);
        auxiliary[0][n] = constant(c - b) + (b - a) * w[n];
        auxiliary[1][n] = convolve(p_y, &auxiliary[0], n);
        auxiliary[2][n] = constant(self.p_x * self.p_x) - convolve_square(p_y, n);
        let y_rate = &auxiliary[1];
        [
            self.p_x * (constant(b) - (b - a) * w[n]),
            y_rate[n],
            (b - a) * half * convolve(&auxiliary[2], sine, n),
            (y_rate[n] - (convolve(w, y_rate, n) * S::from_f64(2.0))) * S::from_f64(2.0),
            convolve(sine, y_rate, n),
        ]
    }

    #[inline(always)]
    fn scales(&self, state: &[S; 5]) -> [S; 5] {
        let one = S::ONE;
        [one.max(state[0].abs()), one.max(state[1].abs()), self.p_x.abs(), one, one]
    }
}

impl<S: Real> Tangent<S> for SerretAndoyerFlow<S> {
    /// `[δy, δp_y]`.
    type Column<T: Copy> = [T; 2];
    /// `[p_y S, p_y δp_y, (p_x² − p_y²) δy]`.
    type ColumnAuxiliary<T: Copy> = [T; 3];
    /// δp_x, which is constant.
    type ColumnParameter = S;

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        delta_p_x: &S,
        (state, auxiliary): (&[Series<S>; 5], &[Series<S>; 3]),
        column: &[Series<S>; 2],
        own: &mut [Series<S>; 3],
    ) -> [S; 2] {
        let [a, b, _] = self.inverse_inertia;
        let [_, _, p_y, sine, w] = state;
        let [delta_y, delta_p_y] = column;
        own[0][n] = convolve(p_y, sine, n);
        own[1][n] = convolve(p_y, delta_p_y, n);
        own[2][n] = convolve(&auxiliary[2], delta_y, n);
        // δ(½(p_x² − p_y²) sin 2y) = (p_x δp_x − p_y δp_y) S + (p_x² − p_y²)(1 − 2w) δy.
        let direction = self.p_x * *delta_p_x * sine[n] - convolve(&own[1], sine, n);
        let position = own[2][n] - convolve(&own[2], w, n) * S::from_f64(2.0);
        [
            convolve(&auxiliary[0], delta_p_y, n) + (b - a) * convolve(&own[0], delta_y, n),
            (b - a) * (direction + position),
        ]
    }

    #[inline(always)]
    fn column_scales(&self, state: &[S; 5], column: &[S; 2]) -> [S; 2] {
        // δy and δp_y differ in unit by p_x (an angle against a momentum): one size in each unit.
        let p = self.p_x.abs().max(state[2].abs());
        let size = (column[0].abs() * p).max(column[1].abs());
        [size / p, size]
    }
}

/// A conjugate point found by integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratedConjugate<S> {
    /// The conjugate time.
    pub t1: S,
    /// x there (x = 0 at the start).
    pub x: S,
    /// y there (continuous from the start).
    pub y: S,
    /// How far rounding inside the last step may have moved `t1`; the growth of the flow before it is not in it.
    pub blur: S,
    /// Steps taken.
    pub steps: u64,
    /// What was done.
    pub work: Work,
}

/// Why no conjugate point was found by integration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// The metric or the start is outside the domain.
    #[error("{name} = {value}: {accepted}")]
    Domain {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// No conjugate time up to the time asked for.
    #[error("no conjugate time up to t = {t_max}")]
    NoneBefore {
        /// The time asked for.
        t_max: f64,
    },
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

fn posed<S: Real>(a: S, b: S, c: S, y0: S, p_x: S, p_y: S) -> Result<SerretAndoyerFlow<S>, FlowError> {
    let positive = "must be finite and positive";
    let check = |name, value: S, accepted, good: bool| {
        let good = good && value.is_finite();
        if good { Ok(()) } else { Err(FlowError::Domain { name, value: value.to_f64(), accepted }) }
    };
    check("A", a, positive, a > S::ZERO)?;
    check("B", b, "must be finite and not below A", b >= a)?;
    check("C", c, "must be finite and above B", c > b)?;
    check("y0", y0, "must be finite", true)?;
    check("p_x", p_x, positive, p_x > S::ZERO)?;
    check("p_y", p_y, "must be finite, and |p_y| ≤ p_x", p_y.abs() <= p_x)?;
    Ok(SerretAndoyerFlow { inverse_inertia: [a, b, c], p_x })
}

/// The first conjugate time `armed_after < t ≤ t_max` along the extremal of (9) from `(0, y0)` with momentum
/// `(p_x, p_y)`, as the first zero of δy (module page). Negative `t_max` looks backward in time.
///
/// Domain: 0 < A ≤ B < C, p_x > 0, |p_y| ≤ p_x. Guarantee: no zero is skipped; at `tolerance = ε` only rounding is
/// left, a few ε times the problem's condition while it is ordinary, more near the separatrix (as for every integration).
/// Special cases: at `p_y = 0` the point is found as everywhere. `armed_after = 0` is safe, the zero at t = 0 being
/// divided out.
///
/// # Errors
/// [`FlowError`]: outside the domain, none found, integration failed.
#[allow(clippy::too_many_arguments)]
pub fn first_conjugate_time_by_integration<S: Real>(
    a: S,
    b: S,
    c: S,
    y0: S,
    p_x: S,
    p_y: S,
    armed_after: S,
    t_max: S,
    tolerance: f64,
) -> Result<IntegratedConjugate<S>, FlowError> {
    let flow = posed(a, b, c, y0, p_x, p_y)?;
    let base = flow.start(y0, p_y);
    let (x_rate, y_rate) = flow.velocity(&base);
    let system = WithColumns { flow, parameters: [-y_rate] };
    let start = Joined { base, columns: Columns([[S::ZERO, x_rate]]) };
    let mut events = Events::first(1, Component(5)).vanishing_at_start(1).armed_after(armed_after);
    let arrival = integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let Some(root) = events.found.first() else { return Err(FlowError::NoneBefore { t_max: t_max.to_f64() }) };
    let [x, y, ..] = root.state.base;
    Ok(IntegratedConjugate { t1: root.time, x, y, blur: root.blur, steps: arrival.work.steps, work: arrival.work })
}

/// `[x, y, p_y]` at the given times (any order, negative too), from `x = 0`.
///
/// Domain and guarantee as for [`first_conjugate_time_by_integration`]; rotating extremals too.
///
/// # Errors
/// [`FlowError`]: outside the domain, integration failed.
#[allow(clippy::too_many_arguments)]
pub fn trajectory<S: Real>(
    a: S,
    b: S,
    c: S,
    y0: S,
    p_x: S,
    p_y: S,
    times: &[S],
    tolerance: f64,
) -> Result<(Vec<[S; 3]>, Work), FlowError> {
    let flow = posed(a, b, c, y0, p_x, p_y)?;
    let (states, work) = sample(&flow, &flow.start(y0, p_y), S::ZERO, times, &Settings::new(tolerance))?;
    Ok((states.into_iter().map(|[x, y, p_y, ..]| [x, y, p_y]).collect(), work))
}
