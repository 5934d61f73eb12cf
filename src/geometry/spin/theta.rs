//! θ along an extremal of the spin problem: where it turns, its continuous branch, where it leaves [0, π] (section
//! 5.2.1).
//!
//! With the lift of [`super::lift`], `tan θ = r3/r1` and `r' = ω × r` give
//!
//! `θ' = r2 Q/(2 (r1² + r3²))`, `Q = h1 r1/k² + h3 r3`,
//!
//! so that θ turns where `r2` or `Q` vanishes: both are polynomials of the state, and all their zeros are found as the
//! roots of the steps' polynomials, none by sampling. On the equator `r·h = 0` leaves `Q = (1 − 1/k²) h3 r3`: for k ≠ 1
//! θ has a strict extremum at *every* crossing of the equator with `sin 2θ ≠ 0`, however small (at k = 1, `Q = −r2 h2`
//! and `θ' ≥ 0`). The total decrease is a sum over the turning points, exact but for rounding.
//!
//! θ leaves [0, π] where `r3` changes sign: 0 if `r1 > 0` there, π if `r1 < 0`. Up to then θ = atan2(r3, r1) is
//! continuous, past the poles too. Beyond, the zeros of `r1` and `r3` cut time into pieces on which θ stays within one
//! quadrant, so that the continuous branch is certain. Angles in radians, time in the unit that `H = 1` fixes; `p_θ >
//! 0`.

use super::lift::{ConjugateScalar, LiftError, Lifted, LiftedState, posed};
use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::dense::Kept;
use crate::numerics::taylor::events::{Component, EventFunction, EventRoot, EventSeries, Events};
use crate::numerics::taylor::flow::{Columns, Elements, Flow, Joined, WithColumns, product};
use crate::numerics::taylor::integrator::{Settings, integrate};
use crate::numerics::taylor::step::{Jet, absolute_sum};

/// As many roots as there are.
const ALL: usize = usize::MAX;

/// `Q = h1 r1/k² + h3 r3` as an event function.
#[derive(Clone, Copy, Debug)]
struct SlopeFactor<S> {
    inverse_k_squared: S,
}

impl<S: Real, F: Flow<S>> EventFunction<S, F> for SlopeFactor<S> {
    const DEGREE: usize = 2;
    fn series(&self, jet: &Jet<S, F>, last: usize, out: &mut EventSeries<S>) {
        let component = |i: usize| &jet.state.get(i)[..=jet.order()];
        let (r1, r3, h1, h3) = (component(0), component(2), component(3), component(5));
        for (n, coefficient) in out.iter_mut().enumerate().take(last + 1) {
            *coefficient = self.inverse_k_squared * product(h1, r1, n) + product(h3, r3, n);
        }
    }
    fn magnitude(&self, jet: &Jet<S, F>, length: S) -> S {
        let size = |i: usize| absolute_sum(jet.state.get(i), jet.order(), length);
        self.inverse_k_squared * (size(3) * size(0)) + size(5) * size(2)
    }
}

/// An instant at which θ turns or may turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningPoint {
    /// The time.
    pub t: f64,
    /// θ there, on the continuous branch that starts at 0.
    pub theta: f64,
    /// φ there, from the pole.
    pub phi: f64,
    /// Whether it is a crossing of the equator; else `Q = 0`.
    pub on_equator: bool,
}

/// What θ does on `[0, t1]`.
#[derive(Clone, Debug, PartialEq)]
pub struct UpToConjugate {
    /// The first conjugate time, by integration.
    pub t1: f64,
    /// θ there, in [0, π] unless it has left that range before.
    pub theta: f64,
    /// The sum of all decreases of θ on `[0, t1]`.
    pub decrease: f64,
    /// The first zero of `r3` after the start, if it lies before `t1`.
    pub earlier_exit: Option<f64>,
    /// What was done.
    pub work: Work,
}

/// The first exit from 0 ≤ θ ≤ π.
#[derive(Clone, Debug)]
pub struct Exit {
    /// The time t̄.
    pub t: f64,
    /// Whether θ(t̄) is π; else it is 0.
    pub at_pi: bool,
    /// φ there.
    pub phi: f64,
    /// The trajectory up to there (and a little further), as its steps' polynomials: r and h.
    pub path: Kept<f64>,
    /// What was done.
    pub work: Work,
}

/// The angle φ from the pole, from a point in R³.
pub fn phi_of(r: [f64; 3]) -> f64 {
    libm::atan2((r[0] * r[0] + r[2] * r[2]).sqrt(), r[1])
}

/// θ on `[0, t1]`: its total decrease, by the turning points, and `t1` itself by integration with the Jacobi column.
///
/// Domain: `k > 0`, `p_θ > 0`; `t_max` lies behind the first conjugate time (some per cent behind it is best) and
/// before the second. Guarantee: no turning point is skipped; the decrease is right to a few ε·(1 + 1/p_θ), the
/// rounding of θ next to a pole.
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed, no conjugate time up to `t_max`.
pub fn up_to_conjugate(k: f64, p_theta: f64, tolerance: f64, t_max: f64) -> Result<UpToConjugate, LiftError> {
    let (flow, base) = posed(k, p_theta)?;
    let system: Lifted<f64> = WithColumns { flow, parameters: [()] };
    let start: LiftedState<f64> = Joined { base, columns: Columns([[0.0, -1.0, 0.0]]) };
    // Two are asked for, so that the integration goes on to t_max and no root at a joint of steps is held back.
    let conjugate = Events::first(2, ConjugateScalar).vanishing_at_start(3);
    let equator = Events::first(ALL, Component(1)).vanishing_at_start(1);
    let slope = Events::first(ALL, SlopeFactor { inverse_k_squared: 1.0 / (k * k) }).vanishing_at_start(1);
    let side = Events::first(ALL, Component(2)).vanishing_at_start(3);
    let mut events = ((conjugate, side), (equator, slope));
    let arrival = integrate(&system, &start, (0.0, t_max), &Settings::new(tolerance), &mut events)?;
    let ((conjugate, side), (equator, slope)) = events;
    let first: &EventRoot<f64, LiftedState<f64>> = conjugate.found.first().ok_or(LiftError::NoneBefore { t_max })?;
    let t1 = first.time;
    let angle = |state: &LiftedState<f64>| libm::atan2(state.base[2], state.base[0]);
    let mut turns: Vec<(f64, f64)> =
        equator.found.iter().chain(&slope.found).map(|e| (e.time, angle(&e.state))).collect();
    turns.retain(|(t, _)| *t < t1);
    turns.push((t1, angle(&first.state)));
    turns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut decrease = 0.0;
    let mut before = 0.0;
    for (_, theta) in &turns {
        decrease += Real::max(before - theta, 0.0);
        before = *theta;
    }
    let earlier_exit = side.found.first().map(|root| root.time).filter(|t| *t < t1);
    Ok(UpToConjugate { t1, theta: angle(&first.state), decrease, earlier_exit, work: arrival.work })
}

/// The first exit from 0 ≤ θ ≤ π after the start, up to `t_max`, and the trajectory until then.
///
/// Domain: `k > 0`, `p_θ > 0`. Guarantee: the first zero of `r3`, none is skipped.
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed, no exit up to `t_max`.
pub fn first_exit(k: f64, p_theta: f64, tolerance: f64, t_max: f64) -> Result<Exit, LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let mut observers = (Events::first(1, Component(2)).vanishing_at_start(3), Kept::new());
    let arrival = integrate(&flow, &start, (0.0, t_max), &Settings::new(tolerance), &mut observers)?;
    let (events, path) = observers;
    let root: &EventRoot<f64, [f64; 6]> = events.found.first().ok_or(LiftError::NoneBefore { t_max })?;
    let [r1, r2, r3, ..] = root.state;
    Ok(Exit { t: root.time, at_pi: r1 < 0.0, phi: phi_of([r1, r2, r3]), path, work: arrival.work })
}

/// All instants in `(0, t_end]` at which θ turns or may turn (at k = 1 it only may), with θ on its continuous branch.
///
/// Domain, guarantee: as for [`up_to_conjugate`]; θ may leave [0, π].
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn turning_points(
    k: f64,
    p_theta: f64,
    tolerance: f64,
    t_end: f64,
) -> Result<(Vec<TurningPoint>, Work), LiftError> {
    /// Why an instant is in the list.
    #[derive(Clone, Copy, PartialEq)]
    enum Cause {
        Quadrant,
        Equator,
        Slope,
    }
    let (flow, start) = posed(k, p_theta)?;
    let quadrants = (Events::first(ALL, Component(0)), Events::first(ALL, Component(2)).vanishing_at_start(3));
    let turns = (
        Events::first(ALL, Component(1)).vanishing_at_start(1),
        Events::first(ALL, SlopeFactor { inverse_k_squared: 1.0 / (k * k) }).vanishing_at_start(1),
    );
    let mut events = (quadrants, turns);
    let arrival = integrate(&flow, &start, (0.0, t_end), &Settings::new(tolerance), &mut events)?;
    let ((r1, r3), (r2, slope)) = events;
    let mut all: Vec<(Cause, EventRoot<f64, [f64; 6]>)> = Vec::new();
    for (cause, roots) in [
        (Cause::Quadrant, r1.found),
        (Cause::Quadrant, r3.found),
        (Cause::Equator, r2.found),
        (Cause::Slope, slope.found),
    ] {
        all.extend(roots.into_iter().map(|root| (cause, root)));
    }
    all.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
    let mut theta = 0.0;
    let mut found = Vec::new();
    for (cause, root) in all {
        let [x, y, z, ..] = root.state;
        // Between neighbours in this list θ changes by at most a quarter turn: the nearest branch is the right one.
        let change = libm::atan2(z, x) - theta;
        theta += change - 2.0 * f64::PI * (change / (2.0 * f64::PI) + 0.5).floor();
        if cause != Cause::Quadrant {
            found.push(TurningPoint {
                t: root.time,
                theta,
                phi: phi_of([x, y, z]),
                on_equator: cause == Cause::Equator,
            });
        }
    }
    Ok((found, arrival.work))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: mpmath 1.3, Taylor integration of r and h at 34 digits, k = 1.01, p_θ = 0.1: times of r2 = 0 and Q = 0,
    /// θ there. (The two inputs as written, not as rounded: 1e-16 relative.) Near a zero of Q the angle moves by the
    /// square of the time's error.
    #[test]
    fn turning_points_of_the_articles_example() {
        let turn = f64::PI * 2.0;
        let expected = [
            (true, 3.138_158_832_302_640_6, 2.989_709_925_955_938),
            (false, 3.204_767_330_704_302, 2.989_707_748_157_929),
            (true, 6.278_773_203_882_787, turn - 0.275_346_090_506_425_96),
            (false, 6.444_694_833_241_124, turn - 0.275_369_659_175_992_5),
            (true, 9.422_483_493_053_965, turn + 2.792_822_555_967_057),
            (false, 9.981_175_488_591_089, turn + 2.792_507_264_933_791_5),
            (true, 12.567_847_116_861_794, 2.0 * turn - 0.360_431_442_540_103_8),
            (false, 15.481_438_331_226_027, turn + 2.832_976_172_286_061),
            (true, 15.712_407_033_623_593, turn + 2.833_026_506_662_934_6),
        ];
        let (found, _) = turning_points(1.01, 0.1, 1e-15, 16.0).unwrap();
        assert_eq!(found.len(), expected.len());
        for (turning, (on_equator, t, theta)) in found.iter().zip(expected) {
            assert_eq!(turning.on_equator, on_equator);
            assert!((turning.t - t).abs() < 1e-12, "{turning:?} {t}");
            assert!((turning.theta - theta).abs() < 1e-13, "{turning:?} {theta}");
        }
    }

    /// At k = 1 θ never decreases (Q = −r2 h2); decrease and angle against the great circle's own θ(t).
    #[test]
    fn at_k_1_theta_never_decreases() {
        for p in [1e-3, 0.1, 1.0, 5.0] {
            let t1 = 8.986_818_915_818_128 / (p * p + 4.0_f64).sqrt();
            let found = up_to_conjugate(1.0, p, 1e-15, 1.05 * t1).unwrap();
            assert!((found.t1 / t1 - 1.0).abs() < 1e-14 && found.earlier_exit.is_none());
            assert!(found.decrease <= 4.0 * f64::EPSILON * (1.0 + 1.0 / p), "{p}: {:e}", found.decrease);
        }
    }
}
