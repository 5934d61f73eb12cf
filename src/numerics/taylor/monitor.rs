//! The invariant monitor: how far a quantity that the flow conserves drifts along an integration.
//!
//! The quantity (an energy, a Casimir, `|r|²`, `r·h`) is evaluated once at the start and once at the end of every step; the
//! largest difference to its first value is kept, relative to that value or, for a quantity that is zero, to a scale that the caller
//! gives. The state at a step's end is, for power series, the one that the integration goes on from, bit for bit (for a
//! Runge-Kutta pair the end of its interpolant). Nothing is integrated for it: a monitor adds no state and no equation, and
//! an integration without one evaluates nothing.
//!
//! Not known here: which quantities are conserved, and what drift is too much. A small drift proves little: errors along the
//! level set do not show.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::Flow;
use crate::numerics::taylor::integrator::{Observer, Step};
use std::ops::ControlFlow;

/// Watches a function of the state that should not change.
#[derive(Clone, Copy, Debug)]
pub struct Invariant<Q, S> {
    quantity: Q,
    scale: Option<S>,
    initial: Option<S>,
    largest_drift: S,
}

impl<Q, S: Real> Invariant<Q, S> {
    /// Drift relative to the quantity's value at the start, which must not be zero.
    pub fn relative(quantity: Q) -> Self {
        Invariant { quantity, scale: None, initial: None, largest_drift: S::ZERO }
    }

    /// Drift in units of a scale: for quantities that are zero at the start.
    pub fn in_units_of(scale: S, quantity: Q) -> Self {
        Invariant { scale: Some(scale), ..Self::relative(quantity) }
    }

    /// The value at the start; none before the first step.
    pub fn initial(&self) -> Option<S> {
        self.initial
    }

    /// The largest `|I(x) − I(x0)| / scale` so far; infinite once the quantity, or its ratio to the scale, was not a finite number.
    pub fn largest_drift(&self) -> S {
        self.largest_drift
    }
}

impl<S: Real, F: Flow<S>, Q: Fn(&F::State<S>) -> S> Observer<S, F> for Invariant<Q, S> {
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        let mut evaluate = |offset: S| {
            work.monitor_evaluations += 1;
            (self.quantity)(&step.state(offset))
        };
        let initial = *self.initial.get_or_insert_with(|| evaluate(S::ZERO));
        let drift = ((evaluate(step.length) - initial) / self.scale.unwrap_or(initial)).abs();
        // A maximum would lose what is not a number.
        self.largest_drift = if drift.is_finite() { self.largest_drift.max(drift) } else { S::from_f64(f64::INFINITY) };
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::flow::{Series, convolve};
    use crate::numerics::taylor::integrator::{Settings, integrate};

    /// `x'' = −x³`; energy `x'²/2 + x⁴/4`.
    struct Quartic;
    impl Flow<f64> for Quartic {
        type State<T: Copy> = [T; 2];
        type Auxiliary<T: Copy> = [T; 1];
        fn coefficients(&self, n: usize, x: &[Series<f64>; 2], a: &mut [Series<f64>; 1]) -> [f64; 2] {
            a[0][n] = convolve(&x[0], &x[0], n);
            [x[1][n], -convolve(&a[0], &x[0], n)]
        }
        fn scales(&self, _: &[f64; 2]) -> [f64; 2] {
            [1.0; 2]
        }
    }

    fn energy([x, v]: &[f64; 2]) -> f64 {
        0.5 * v * v + 0.25 * (x * x) * (x * x)
    }

    fn drift(tolerance: f64, end: f64) -> (f64, [f64; 2], Work) {
        let mut monitor = Invariant::relative(energy);
        let arrival = integrate(&Quartic, &[1.0, 0.0], (0.0, end), &Settings::new(tolerance), &mut monitor).unwrap();
        assert_eq!(monitor.initial(), Some(0.25));
        (monitor.largest_drift(), arrival.state, arrival.work)
    }

    #[test]
    fn what_drifts_is_seen_and_what_does_not_is_not() {
        // The drift grows with the request; at ε only rounding is left: a few ε over 100 steps (compensated sums).
        for (tolerance, least, most) in
            [(1e-3, 1e-5, 1.0), (1e-6, 1e-9, 1e-3), (f64::EPSILON, 0.0, 40.0 * f64::EPSILON)]
        {
            let (drift, ..) = drift(tolerance, 100.0);
            assert!(drift > least && drift < most, "{tolerance}: {drift}");
        }
    }

    #[test]
    fn one_evaluation_a_step_and_one_at_the_start_on_the_very_states() {
        for end in [20.0, -20.0] {
            let (drift, state, work) = drift(1e-6, end);
            assert_eq!(work.monitor_evaluations, work.steps + 1);
            // It changes nothing, and its last evaluation is at the state that the integration ends with.
            let plain = integrate(&Quartic, &[1.0, 0.0], (0.0, end), &Settings::new(1e-6), &mut ()).unwrap();
            assert_eq!((plain.state, plain.work), (state, Work { monitor_evaluations: 0, ..work }));
            assert!(drift >= (energy(&state) / 0.25 - 1.0).abs());
        }
        // A quantity that reads a component: the largest |x(end of a step)| of the circle through (1, 0) is reached exactly.
        let mut last = Invariant::in_units_of(1.0, |state: &[f64; 2]| state[1]);
        let one = integrate(&Quartic, &[1.0, 0.0], (0.0, 1e-3), &Settings::new(1e-9), &mut last).unwrap();
        assert_eq!((one.work.steps, last.largest_drift()), (1, one.state[1].abs()));
    }

    #[test]
    fn a_quantity_that_is_zero_needs_a_scale_and_one_that_is_no_number_is_told() {
        let run = |mut monitor: Invariant<fn(&[f64; 2]) -> f64, f64>| {
            integrate(&Quartic, &[1.0, 0.0], (0.0, 5.0), &Settings::new(1e-9), &mut monitor).unwrap();
            monitor.largest_drift()
        };
        let excess: fn(&[f64; 2]) -> f64 = |state| energy(state) - 0.25;
        assert!(run(Invariant::in_units_of(0.25, excess)) < 1e-7);
        assert_eq!(run(Invariant::relative(excess)), f64::INFINITY);
        // Not a number at the first of several steps, finite afterwards.
        let broken: fn(&[f64; 2]) -> f64 = |state| if state[0] > 0.0 { f64::NAN } else { 1.0 };
        assert_eq!(run(Invariant::in_units_of(1.0, broken)), f64::INFINITY);
    }
}
