//! The spin problem as a pendulum beside a scalar equation: the cheapest equations for its conjugate times.
//!
//! With `h = (2k sin β, −2k β', 2 cos β)` the momentum is a pendulum, `β'² = b² − w² sin²β`, `b = p_θ/(2k)`,
//! `w² = 1 − 1/k²` (the article's (31)). From `r' = ω × r`, `ω = (sin β/k, 0, cos β)` and `r·h = 0` follows for the
//! component across the equator, and from the pendulum for `δβ = ∂β/∂p_θ`:
//!
//! ```text
//! r2'' = −(g + w² cos 2β) r2,    δβ'' = −w² cos 2β · δβ,    g = G²/(4k²) = 1/k² + b²
//! J = −r·δh = −2k (δβ r2' − δβ' r2) = −2k W,    W' = −g δβ r2
//! ```
//!
//! so that J vanishes where the Wronskian-like `W` does. With `S = sin 2β`, `U = cos 2β`, `v = β'` as states the system is
//! polynomial with five products (the lift of [`super::lift`] has sixteen): `S' = 2Uv`, `U' = −2Sv`, `v' = −½ w² S`. The point:
//! `r1 = cos β r2' + sin β v r2`, `r3 = k (cos β v r2 − sin β r2')`.
//!
//! Derived here from the lift; the tests compare the two. Start, units and mirror image as there: everything is for `|p_θ|`.
//! Not known here: trajectories (they are drawn by the lift), the closed form.

use super::lift::{IntegratedConjugate, LiftError, posed as checked};
use crate::numerics::counts::Work;
use crate::numerics::lanes::dispatch::{LaneWork, dispatch};
use crate::numerics::pack::Pack;
use crate::numerics::real::Real;
use crate::numerics::taylor::events::{Component, Events};
use crate::numerics::taylor::flow::{
    Algebra, Columns, Flow, Joined, Series, Tangent, WithColumns, convolve_each, largest,
};
use crate::numerics::taylor::integrator::{IntegrationError, Settings, integrate};
use crate::numerics::taylor::lanes::{FirstZero, LaneArrival, Slice, integrate_lanes, set_lane};

/// W is the last component.
const W: Component = Component(8);
/// The order to which W vanishes at the start: `W = −g t³/(6k) + …`.
const VANISHING_ORDER: usize = 3;
/// The smallest scale of `(sin 2β, v)`: below it they don't matter to anything up to times of `70/√(1/k² − 1)`.
const SMALLEST_SCALE: f64 = 1e-30;

/// The flow. State: `[β, S = sin 2β, U = cos 2β, v = β', r2, r2']`.
#[derive(Clone, Copy, Debug)]
pub struct SpinPendulum<S> {
    /// `w² = (k − 1)(k + 1)/k²`, negative for k < 1.
    pub stiffness: S,
    /// `g = G²/(4k²)`.
    pub gain: S,
    /// `√g`, the rate of everything.
    pub rate: S,
    /// `max(1, 1/k)`: how large r2' may be.
    pub across: S,
}

impl<S: Real> SpinPendulum<S> {
    /// The flow of the extremal with this `p = |p_θ|`, and its state at the start.
    pub fn new(k: S, p: S) -> (Self, [S; 6]) {
        let (zero, one, two) = (S::ZERO, S::ONE, S::from_f64(2.0));
        let (b, inverse) = (p / (two * k), one / k);
        let gain = inverse * inverse + b * b;
        let stiffness = (k - one) * (k + one) * (inverse * inverse);
        let flow = SpinPendulum { stiffness, gain, rate: gain.sqrt(), across: one.max(inverse) };
        (flow, [zero, zero, one, b, zero, one])
    }
}

impl<S: Algebra> Flow<S> for SpinPendulum<S> {
    type State<T: Copy> = [T; 6];
    type Auxiliary<T: Copy> = [T; 0];

    #[inline(always)]
    fn coefficients(&self, n: usize, state: &[Series<S>; 6], _: &mut [Series<S>; 0]) -> [S; 6] {
        let [_, sine, cosine, v, r2, r2_rate] = state;
        let [cosine_v, sine_v, cosine_r2] = convolve_each([(cosine, v), (sine, v), (cosine, r2)], n);
        [
            v[n],
            cosine_v + cosine_v,
            -(sine_v + sine_v),
            -(self.stiffness * S::number(0.5) * sine[n]),
            r2_rate[n],
            -(self.gain * r2[n] + self.stiffness * cosine_r2),
        ]
    }

    #[inline(always)]
    fn scales(&self, state: &[S; 6]) -> [S; 6] {
        // Near the meridian (k < 1, p → 0) β and v grow exponentially from the size of p: measured by their own size.
        let one = S::number(1.0);
        let own = largest(&[state[1], state[3] / self.rate]).larger(S::number(SMALLEST_SCALE));
        let turned = own.larger(state[0].size());
        [turned, own, one, own * self.rate, self.across / self.rate, self.across]
    }
}

impl<S: Algebra> Tangent<S> for SpinPendulum<S> {
    /// `[δβ, δβ', W]`.
    type Column<T: Copy> = [T; 3];
    type ColumnAuxiliary<T: Copy> = [T; 0];
    type ColumnParameter = ();

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        _: &(),
        (state, _): (&[Series<S>; 6], &[Series<S>; 0]),
        [delta, delta_rate, _]: &[Series<S>; 3],
        _: &mut [Series<S>; 0],
    ) -> [S; 3] {
        let [_, _, cosine, _, r2, _] = state;
        let [cosine_delta, delta_r2] = convolve_each([(cosine, delta), (delta, r2)], n);
        [delta_rate[n], -(self.stiffness * cosine_delta), -(self.gain * delta_r2)]
    }

    #[inline(always)]
    fn column_scales(&self, _: &[S; 6], column: &[S; 3]) -> [S; 3] {
        let size = largest(&[column[0] * self.rate, column[1]]);
        [size / self.rate, size, size * self.across / self.rate]
    }
}

type System<S> = WithColumns<SpinPendulum<S>, (), 1>;
type State<T> = Joined<[T; 6], Columns<[T; 3], 1>>;

/// The flow and the start with its column, for checked inputs.
fn posed<S: Real>(k: S, p_theta: S) -> Result<(SpinPendulum<S>, State<S>), LiftError> {
    checked(k, p_theta)?;
    let (flow, base) = SpinPendulum::new(k, p_theta.abs());
    let column = [S::ZERO, S::ONE / (S::from_f64(2.0) * k), S::ZERO];
    Ok((flow, Joined { base, columns: Columns([column]) }))
}

fn point<S: Real>(k: S, p_theta: S, t1: S, state: &State<S>, blur: S, multiplicity: usize) -> IntegratedConjugate<S> {
    let [beta, _, _, v, r2, r2_rate] = state.base;
    let (sine, cosine) = beta.sin_cos();
    let mirror = if p_theta < S::ZERO { -S::ONE } else { S::ONE };
    let (r1, r3) = (cosine * r2_rate + sine * v * r2, mirror * (k * (cosine * v * r2 - sine * r2_rate)));
    let two_k = k + k;
    // The reflection r3 → −r3 acts on h, a pseudovector, by (h1, h2, h3) → (−h1, −h2, h3).
    let h = [mirror * two_k * sine, -(mirror * two_k * v), cosine + cosine];
    IntegratedConjugate { t1, r: [r1, r2, r3], h, blur, multiplicity }
}

/// The first conjugate time and point in `(0, t_max]`, and the work.
///
/// Domain, guarantee and errors as for [`super::lift::first_conjugate_time_by_integration`].
///
/// # Errors
/// [`LiftError`].
pub fn first_conjugate_time_by_pendulum<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
) -> Result<(IntegratedConjugate<S>, Work), LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let system = WithColumns { flow, parameters: [()] };
    let mut events = Events::first(1, W).vanishing_at_start(VANISHING_ORDER);
    let arrival = integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let root = events.found.first().ok_or(LiftError::NoneBefore { t_max: t_max.to_f64() })?;
    Ok((point(k, p_theta, root.time, &root.state, root.blur, root.multiplicity), arrival.work))
}

/// The outcome for one start.
pub type Outcome = Result<(IntegratedConjugate<f64>, Work), LiftError>;

/// The first conjugate times up to `t_max` of the starts `(k, p_θ)`, in their order, eight at a time.
///
/// Result for result the bits of [`first_conjugate_time_by_pendulum`].
pub fn first_conjugate_times_by_pendulum(starts: &[(f64, f64)], tolerance: f64, t_max: f64) -> Vec<Outcome> {
    dispatch(Integrate { starts, tolerance, t_max })
}

struct Integrate<'a> {
    starts: &'a [(f64, f64)],
    tolerance: f64,
    t_max: f64,
}

impl LaneWork for Integrate<'_> {
    type Output = Vec<Outcome>;

    #[inline(always)]
    fn run<P: Pack<Scalar = f64>>(self) -> Vec<Outcome> {
        let Self { starts, tolerance, t_max } = self;
        let load = |&(k, p_theta): &(f64, f64), lane: usize, system: &mut System<P>, state: &mut State<P>| {
            let (flow, start) = posed(k, p_theta).map_err(|error| Box::new(Err(error)))?;
            let of = &mut system.flow;
            for (member, value) in [
                (&mut of.stiffness, flow.stiffness),
                (&mut of.gain, flow.gain),
                (&mut of.rate, flow.rate),
                (&mut of.across, flow.across),
            ] {
                *member = member.with_lane(lane, value);
            }
            set_lane(lane, &mut state.base, &start.base);
            set_lane(lane, &mut state.columns.0[0], &start.columns.0[0]);
            Ok(t_max)
        };
        let done = |&(k, p_theta): &(f64, f64), result: Result<LaneArrival<State<f64>>, IntegrationError>| {
            let LaneArrival { time: t1, state, event, work } = result?;
            let (blur, multiplicity) = event.ok_or(LiftError::NoneBefore { t_max })?;
            Ok((point(k, p_theta, t1, &state, blur, multiplicity), work))
        };
        let mut queue = Slice::new(starts, load, done);
        let flow = SpinPendulum { stiffness: P::ONE, gain: P::ONE, rate: P::ONE, across: P::ONE };
        let system = WithColumns { flow, parameters: [()] };
        integrate_lanes(system, &FirstZero(W), VANISHING_ORDER, &Settings::new(tolerance), &mut queue);
        queue.outcomes()
    }
}
