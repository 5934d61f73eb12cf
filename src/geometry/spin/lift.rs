//! The spin problem lifted to R³ × so(3)*: the second route for its conjugate times, and its trajectories.
//!
//! Article, section 4, in the form of DESIGN.md section 3: `r ∈ R³` on the unit sphere, `h = r × p`,
//! `H = (h3² + h1²/k²)/4`, `r' = ω × r`, `h' = ω × h`, `ω = (h1/(2k²), 0, h3/2)`. Polynomial of degree 2, regular at the
//! equator `r2 = 0`, where the metric is singular, and at the poles.
//!
//! **Start.** φ(0) = π/2, θ(0) = 0, p_φ(0) = −2, p_θ: `r = (1, 0, 0)`, `h = (0, −p_θ, 2)`, H = 1. The variation in p_θ at
//! a fixed starting point and energy is `δh(0) = (0, −1, 0)`, `δr(0) = 0` (δH = h3 δh3/2 + … = 0 holds).
//!
//! **Conjugate scalar.** δr stays parallel to h, so it vanishes exactly with `J = h·δr = −r·δh` (r·h = 0 for every p_θ). So
//! δr itself needs no equation: nine in all. `J' = −δω·(h × r)`, and with `δh1 = t + …`, `δh3 = −p_θ t²/(2k²) + …`,
//! `h × r = (−2t + …, 2, p_θ + …)` follows `J = (4 + p_θ²) t³/(12 k²) + …`: the zero at t = 0 is triple for every start of
//! this kind; it is divided out of the first step.
//!
//! Zeros of J are simple, or triple where the conjugate point crosses the equator. Units: radians; H = 1. Not known
//! here: the closed form, the metric's chart beyond θ and φ of a point.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::dense::sample;
use crate::numerics::taylor::events::{Component, EventFunction, EventRoot, Events};
use crate::numerics::taylor::flow::{Algebra, Columns, Flow, Joined, Series, Tangent, WithColumns, convolve, largest};
use crate::numerics::taylor::integrator::{IntegrationError, Settings, integrate};
use crate::numerics::taylor::step::{Jet, absolute_sum};

/// The lifted flow. State: `[r1, r2, r3, h1, h2, h3]`.
#[derive(Clone, Copy, Debug)]
pub struct SpinLift<S> {
    /// `1/(2k²)`: ω1 = h1/(2k²).
    pub half_inverse_k_squared: S,
}

impl<S: Real> SpinLift<S> {
    /// The flow for this k.
    pub fn new(k: S) -> Self {
        SpinLift { half_inverse_k_squared: S::from_f64(0.5) / (k * k) }
    }

    /// The energy `H = (h3² + h1²/k²)/4`, which the flow conserves.
    pub fn energy(&self, state: &[S; 6]) -> S {
        let [.., h1, _, h3] = *state;
        S::from_f64(0.25) * (h3 * h3) + S::from_f64(0.5) * self.half_inverse_k_squared * (h1 * h1)
    }
}

impl<S: Algebra> Flow<S> for SpinLift<S> {
    type State<T: Copy> = [T; 6];
    type Auxiliary<T: Copy> = [T; 0];

    #[inline(always)]
    fn coefficients(&self, n: usize, state: &[Series<S>; 6], _: &mut [Series<S>; 0]) -> [S; 6] {
        let (first, third) = (self.half_inverse_k_squared, S::number(0.5));
        let [r1, r2, r3, h1, h2, h3] = state;
        let product = |a, b| convolve(a, b, n);
        [
            -(third * product(h3, r2)),
            third * product(h3, r1) - first * product(h1, r3),
            first * product(h1, r2),
            -(third * product(h3, h2)),
            (third - first) * product(h1, h3),
            first * product(h1, h2),
        ]
    }

    #[inline(always)]
    fn scales(&self, state: &[S; 6]) -> [S; 6] {
        // r is a unit vector; the components of h turn into each other. Within √3 of |h|.
        let one = S::number(1.0);
        let h = largest(&state[3..]);
        [one, one, one, h, h, h]
    }
}

impl<S: Algebra> Tangent<S> for SpinLift<S> {
    /// δh.
    type Column<T: Copy> = [T; 3];
    type ColumnAuxiliary<T: Copy> = [T; 0];
    type ColumnParameter = ();

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        _: &(),
        (state, _): (&[Series<S>; 6], &[Series<S>; 0]),
        column: &[Series<S>; 3],
        _: &mut [Series<S>; 0],
    ) -> [S; 3] {
        let (first, third) = (self.half_inverse_k_squared, S::number(0.5));
        let [_, _, _, h1, h2, h3] = state;
        let [d1, d2, d3] = column;
        let product = |a, b| convolve(a, b, n);
        [
            -(third * (product(d3, h2) + product(h3, d2))),
            (third - first) * (product(d1, h3) + product(h1, d3)),
            first * (product(d1, h2) + product(h1, d2)),
        ]
    }

    #[inline(always)]
    fn column_scales(&self, _: &[S; 6], column: &[S; 3]) -> [S; 3] {
        [largest(column); 3]
    }
}

/// `J = −r·δh` along one column.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConjugateScalar;

pub(super) type Lifted<S> = WithColumns<SpinLift<S>, (), 1>;
pub(super) type LiftedState<T> = Joined<[T; 6], Columns<[T; 3], 1>>;

impl<S: Real> EventFunction<S, Lifted<S>> for ConjugateScalar {
    fn series(&self, jet: &Jet<S, Lifted<S>>, length: S, out: &mut Series<S>) -> S {
        let (r, column) = (&jet.state.base, &jet.state.columns.0[0]);
        let order = jet.order();
        for (n, coefficient) in out.iter_mut().enumerate().take(order + 1) {
            let product = |i: usize| convolve(&r[i], &column[i], n);
            *coefficient = -(product(0) + product(1) + product(2));
        }
        let bound = |i: usize| absolute_sum(&r[i], order, length) * absolute_sum(&column[i], order, length);
        bound(0) + bound(1) + bound(2)
    }
}

/// A conjugate point found by integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratedConjugate<S> {
    /// The conjugate time.
    pub t1: S,
    /// The point, in R³.
    pub r: [S; 3],
    /// The momentum h there.
    pub h: [S; 3],
    /// How far rounding inside the last step may have moved `t1` (half the width of a cluster); the growth of the flow
    /// before it is not in it.
    pub blur: S,
    /// 1 for a simple zero, 3 where the conjugate point crosses the equator (within the noise).
    pub multiplicity: usize,
}

impl<S: Real> IntegratedConjugate<S> {
    /// `(θ, φ)`, θ in (−π, π], φ in [0, π] measured from the pole `(0, 1, 0)`:
    /// `r = (sin φ cos θ, cos φ, sin φ sin θ)`.
    pub fn angles(&self) -> (S, S) {
        let [r1, r2, r3] = self.r;
        (r3.atan2(r1), (r1 * r1 + r3 * r3).sqrt().atan2(r2))
    }
}

/// Why the lift could not be integrated, or what it did not find.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LiftError {
    /// k or p_θ is outside the domain.
    #[error("{name} = {value}: {accepted}")]
    Domain {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// No conjugate time, or no such return to the equator, up to the time asked for.
    #[error("no such conjugate time or return up to t = {t_max}")]
    NoneBefore {
        /// The time asked for.
        t_max: f64,
    },
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// The flow and the start of the module page, for checked inputs.
pub(super) fn posed<S: Real>(k: S, p_theta: S) -> Result<(SpinLift<S>, [S; 6]), LiftError> {
    if !(k > S::ZERO && k.is_finite()) {
        return Err(LiftError::Domain { name: "k", value: k.to_f64(), accepted: "must be finite and positive" });
    }
    if !p_theta.is_finite() {
        return Err(LiftError::Domain { name: "p_theta", value: p_theta.to_f64(), accepted: "must be finite" });
    }
    let (zero, one) = (S::ZERO, S::ONE);
    Ok((SpinLift::new(k), [one, zero, zero, zero, -p_theta, S::from_f64(2.0)]))
}

/// The conjugate times in `(0, t_max]`, at most the first `wanted`, in order, with their points; a triple one stands once.
///
/// Start: on the equator, H = 1 (module page). Domain: k > 0, p_θ finite (a negative p_θ mirrors θ). Guarantee: none
/// is skipped, the roots of each step's polynomial being isolated. Accuracy at `tolerance = ε`: a few ε of the time while
/// the flow is ordinary; for k < 1 and p_θ → 0 the flow passes a separatrix and multiplies rounding by `1/p_θ`-like
/// factors, for k ≫ 1 the conjugate times grow like 2πk².
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed. Fewer than `wanted` are no error.
pub fn conjugate_times_by_integration<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    wanted: usize,
) -> Result<(Vec<IntegratedConjugate<S>>, Work), LiftError> {
    let (flow, base) = posed(k, p_theta)?;
    let system = WithColumns { flow, parameters: [()] };
    let start: LiftedState<S> = Joined { base, columns: Columns([[S::ZERO, -S::ONE, S::ZERO]]) };
    let mut events = Events::first(wanted, ConjugateScalar).vanishing_at_start(3);
    let arrival = integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let point = |root: &EventRoot<S, LiftedState<S>>| {
        let [r1, r2, r3, h1, h2, h3] = root.state.base;
        let (t1, blur, multiplicity) = (root.time, root.blur, root.multiplicity);
        IntegratedConjugate { t1, r: [r1, r2, r3], h: [h1, h2, h3], blur, multiplicity }
    };
    Ok((events.found.iter().map(point).collect(), arrival.work))
}

/// The first conjugate time and point; see [`conjugate_times_by_integration`].
///
/// # Errors
/// As there, and [`LiftError::NoneBefore`].
pub fn first_conjugate_time_by_integration<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
) -> Result<(IntegratedConjugate<S>, Work), LiftError> {
    let (found, work) = conjugate_times_by_integration(k, p_theta, tolerance, t_max, 1)?;
    let first = found.first().ok_or(LiftError::NoneBefore { t_max: t_max.to_f64() })?;
    Ok((*first, work))
}

/// The times in `(0, t_max]` at which the extremal crosses the equator `r2 = 0`, in order, with the points.
///
/// Base flow alone: no tangent is integrated. Domain, guarantee and errors as for [`conjugate_times_by_integration`].
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn equator_crossings<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    wanted: usize,
) -> Result<(Vec<(S, [S; 3])>, Work), LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let mut events = Events::first(wanted, Component(1)).vanishing_at_start(1);
    let arrival = integrate(&flow, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let crossing = |root: &EventRoot<S, [S; 6]>| (root.time, [root.state[0], root.state[1], root.state[2]]);
    Ok((events.found.iter().map(crossing).collect(), arrival.work))
}

/// A return to the equator, with the Jacobi scalar there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossingWithJacobi<S> {
    /// The time of the return.
    pub t: S,
    /// The point, in R³.
    pub r: [S; 3],
    /// `J = −r·δh` there: zero when the return is a conjugate point.
    pub jacobi: S,
}

/// The `crossing`-th return to the equator `r2 = 0` (from 1), with `J` there.
///
/// As a function of `k` or `p_θ` this `J` has a simple root where a conjugate point crosses the equator, although the
/// conjugate time has a vertical tangent there. Domain, guarantee and errors as for [`conjugate_times_by_integration`].
///
/// # Errors
/// [`LiftError`]; [`LiftError::NoneBefore`] when there is no such return up to `t_max`.
pub fn jacobi_scalar_at_crossing<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    crossing: usize,
) -> Result<(CrossingWithJacobi<S>, Work), LiftError> {
    let (flow, base) = posed(k, p_theta)?;
    let system = WithColumns { flow, parameters: [()] };
    let start: LiftedState<S> = Joined { base, columns: Columns([[S::ZERO, -S::ONE, S::ZERO]]) };
    let mut events = Events::first(crossing, Component(1)).vanishing_at_start(1);
    let arrival = integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let root: &EventRoot<S, LiftedState<S>> = crossing
        .checked_sub(1)
        .and_then(|last| events.found.get(last))
        .ok_or(LiftError::NoneBefore { t_max: t_max.to_f64() })?;
    let [r1, r2, r3, ..] = root.state.base;
    let [d1, d2, d3] = root.state.columns.0[0];
    Ok((CrossingWithJacobi { t: root.time, r: [r1, r2, r3], jacobi: -(r1 * d1 + r2 * d2 + r3 * d3) }, arrival.work))
}

/// `r(t)` at the given times (any order, negative too). Base flow alone; domain as above.
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn trajectory<S: Real>(k: S, p_theta: S, times: &[S], tolerance: f64) -> Result<(Vec<[S; 3]>, Work), LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let (states, work) = sample(&flow, &start, S::ZERO, times, &Settings::new(tolerance))?;
    Ok((states.into_iter().map(|[r1, r2, r3, ..]| [r1, r2, r3]).collect(), work))
}
