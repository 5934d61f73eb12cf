//! The spin problem in the angles (θ, φ) of Lemma 4.1, as printed ([`PrintedChart`]): not the way to integrate it, and here to show why.
//!
//! Eight equations together, with six values of sines, cosines and quotients of them for each evaluation; an extremal that passes near a
//! pole makes the steps short. `p_φ δθ − p_θ δφ` is a polynomial of the state, as events need it, and vanishes to third order at the
//! start. Scales are what a library takes for its relative and absolute tolerances together: the larger of 1 and the component's size.
//!
//! Not known here: the lift, which this is compared with.

use crate::effects::cost_of_accuracy::problem::Found;
use crate::geometry::spin::printed_chart::PrintedChart;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::integrator::integrate;
use crate::numerics::runge_kutta::rate::{ByRate, RightHandSide, Trace};
use crate::numerics::taylor::events::{EventFunction, EventSeries, Events};
use crate::numerics::taylor::flow::product_each;
use crate::numerics::taylor::integrator::Settings;
use crate::numerics::taylor::step::{Jet, absolute_sum};

/// The printed equations with the scales of a library.
struct Chart<S>(PrintedChart<S>);

impl<S: Real> RightHandSide<S> for Chart<S> {
    type State<T: Copy> = [T; 8];
    const BASE_DIMENSION: usize = 4;
    const COLUMNS: usize = 1;

    fn rate(&self, _: S, state: &[S; 8]) -> [S; 8] {
        self.0.rate(state)
    }

    fn scales(&self, state: &[S; 8]) -> [S; 8] {
        state.map(|x| x.abs().max(S::ONE))
    }
}

/// `p_φ δθ − p_θ δφ`.
struct Across;

impl<S: Real> EventFunction<S, Trace<Chart<S>>> for Across {
    const DEGREE: usize = 2;
    fn series(&self, jet: &Jet<S, Trace<Chart<S>>>, last: usize, out: &mut EventSeries<S>) {
        let [_, _, p, q, d_theta, d_phi, ..] = &jet.state;
        for (n, coefficient) in out.iter_mut().enumerate().take(last + 1) {
            let [first, second] = product_each([(q, d_theta), (p, d_phi)], jet.order(), n);
            *coefficient = first - second;
        }
    }
    fn magnitude(&self, jet: &Jet<S, Trace<Chart<S>>>, length: S) -> S {
        let [p, q, d_theta, d_phi] = [2, 3, 4, 5].map(|i| absolute_sum(&jet.state[i], jet.order(), length));
        q * d_theta + p * d_phi
    }
}

/// The first conjugate time up to `until` of the start `p_θ` on the equator, by DOP853 in the chart; none where the integration fails.
pub fn first_conjugate_time<S: Real>(k: S, p_theta: S, asked: f64, until: S) -> Found<S> {
    let mut events = Events::first(1, Across).vanishing_at_start(3);
    let (flow, start) = (ByRate::new(Chart(PrintedChart::new(k))), PrintedChart::start(p_theta));
    match integrate(Dop853, &flow, &start, (S::ZERO, until), &Settings::new(asked), &mut events) {
        Ok(arrival) => Found { time: events.found.first().map(|root| root.time), work: arrival.work },
        Err(_) => Found::nothing(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spin::lift::first_conjugate_time_by_integration;

    /// Oracle: the lift, far from the poles (p_θ = 5), on both sides of k = 1: there the chart is as good as any.
    #[test]
    fn far_from_the_poles_the_times_are_those_of_the_lift() {
        for k in [0.8, 1.0, 1.15] {
            let (lifted, _) = first_conjugate_time_by_integration(k, 5.0, f64::EPSILON, 100.0).unwrap();
            let found = first_conjugate_time(k, 5.0, 1e-13, 100.0).time.unwrap();
            assert!((found / lifted.t1 - 1.0).abs() < 1e-11, "{k}: {found} {}", lifted.t1);
        }
    }
}
