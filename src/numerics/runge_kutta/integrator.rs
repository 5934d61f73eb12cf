//! The loop over the steps of a pair, of lengths that the error decides, or of equal ones.
//!
//! As with power series, state and time are compensated sums, nothing is allocated, and observers see a polynomial on each
//! step; its further stages are evaluated only for observers that look into the step. The step length follows from the
//! last estimate, `0.9 (tolerance / error)^(1/q)` with the estimate of order `h^q` (Hairer, Norsett and Wanner, II.4).

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::rate::{Rate, StateOf};
use crate::numerics::runge_kutta::step::Stepper;
use crate::numerics::runge_kutta::tableau::Pair;
use crate::numerics::taylor::flow::{Elements, Flow};
use crate::numerics::taylor::integrator::{
    Arrival, Compensated, IntegrationError, Observer, Settings, Step, as_numbers, check_request,
};
use crate::numerics::taylor::step::ErrorNorm;

/// Lengths aim a little below what the estimate allows, so that few steps are refused.
const SAFETY: f64 = 0.9;
/// A refused or accepted step's length shrinks at most by this factor: the estimate is only trusted so far.
const SHRINK: f64 = 0.2;
/// It grows at most by this factor.
const GROW: f64 = 6.0;

/// What moves from step to step.
struct Run<'a, P: Pair, S: Real, R: Rate<S>> {
    flow: &'a R,
    stepper: Stepper<P, S, R>,
    end: S,
    time: Compensated<S>,
    state: StateOf<S, R>,
    rest: StateOf<S, R>,
    /// Whether the first stage has the rate at `state`.
    started: bool,
    work: Work,
}

impl<'a, P: Pair, S: Real, R: Rate<S>> Run<'a, P, S, R> {
    const DIMENSION: usize = <StateOf<S, R> as Elements<S>>::LEN;

    fn new(flow: &'a R, initial: &StateOf<S, R>, span: (S, S)) -> Self {
        let work = Work { state_dimension: Self::DIMENSION as u64, ..Work::default() };
        let (time, rest) = (Compensated::new(span.0), StateOf::<S, R>::filled(S::ZERO));
        Run { flow, stepper: Stepper::new(), end: span.1, time, state: *initial, rest, started: false, work }
    }

    fn remaining(&self) -> S {
        (self.end - self.time.value) - self.time.rest
    }

    fn numbers(&self) -> Vec<f64> {
        as_numbers::<S, R::Seen>(&self.state)
    }

    /// Evaluates the first stage unless the last step's end was it.
    fn begin_step(&mut self) -> Result<(), IntegrationError> {
        if !self.started {
            let rate = self.stepper.evaluate(self.flow, self.time.value, &self.state, &mut self.work);
            self.stepper.set_start(rate);
            self.started = true;
        }
        if !is_finite(self.stepper.start()) || !is_finite(&self.state) {
            return Err(IntegrationError::NotFinite { time: self.time.value.to_f64(), state: self.numbers() });
        }
        Ok(())
    }

    /// Lets the observer look at the step just advanced, and moves on. True when the observer stops.
    fn end_step<O: Observer<S, R::Seen>>(
        &mut self,
        increment: &StateOf<S, R>,
        length: S,
        last: bool,
        observer: &mut O,
    ) -> bool {
        self.work.steps += 1;
        let (mut state, mut rest) = (self.state, self.rest);
        for i in 0..Self::DIMENSION {
            let mut sum = Compensated { value: *state.get(i), rest: *rest.get(i) };
            sum.add(*increment.get(i));
            *state.get_mut(i) = sum.value;
            *rest.get_mut(i) = sum.rest;
        }
        let mut time = self.time;
        if last {
            time = Compensated::new(self.end);
        } else {
            time.add(length);
        }
        let inside = observer.looks_into(&self.time, length);
        if inside {
            self.stepper.finish(self.flow, time.value, &state, &mut self.work);
            let (start, stepper) = (self.time.value, &mut self.stepper);
            stepper.interpolate(self.flow, start, &self.state, increment, length, &mut self.work);
        }
        let (flow, jet, start) = (self.flow.seen(), self.stepper.interpolant(), self.time);
        // An event function's series is short here (the interpolant's order times its degree) and taken whole.
        let (first, tolerance) = (self.work.steps == 1, S::EPSILON.to_f64());
        let step = Step { flow, jet, start, length, first, last, tolerance, rest: &self.rest };
        if observer.observe(&step, &mut self.work).is_break() {
            return true;
        }
        (self.time, self.state, self.rest, self.started) = (time, state, rest, inside);
        if inside {
            self.stepper.set_start(*self.stepper.end());
        }
        false
    }

    fn arrival(self, stopped: bool) -> Arrival<S, StateOf<S, R>> {
        let time = if stopped { self.time.plus(S::ZERO) } else { self.end };
        Arrival { time, state: self.state, stopped, work: self.work }
    }

    /// A first length, from the rate and its change over a short Euler step: as in Hairer, Norsett and Wanner, II.4,
    /// but with one unit of time throughout, `1/max(‖y'‖, √‖y''‖)`.
    fn first_length(&mut self, scales: &StateOf<S, R>, components: usize, tolerance: f64) -> f64 {
        let remaining = self.remaining();
        let start = *self.stepper.start();
        let rate = largest_ratio::<S, R>(&start, scales, components);
        let trial = if rate > 0.0 { 0.01 / rate } else { 1e-3 * remaining.to_f64().abs() };
        let trial = trial.min(remaining.to_f64().abs());
        let length = S::from_f64(if remaining < S::ZERO { -trial } else { trial });
        let mut at = self.state;
        for i in 0..Self::DIMENSION {
            *at.get_mut(i) += length * *start.get(i);
        }
        let mut change = self.stepper.evaluate(self.flow, self.time.value + length, &at, &mut self.work);
        for i in 0..Self::DIMENSION {
            *change.get_mut(i) -= *start.get(i);
        }
        let curvature = (largest_ratio::<S, R>(&change, scales, components) / trial).sqrt();
        let frequency = if curvature.is_finite() { rate.max(curvature) } else { 100.0 / trial };
        let fraction = libm::pow(tolerance, 1.0 / P::ESTIMATE_POWER as f64);
        if frequency > 0.0 { fraction / frequency } else { remaining.to_f64().abs() }
    }
}

fn is_finite<S: Real, E: Elements<S>>(elements: &E) -> bool {
    (0..E::LEN).all(|i| elements.get(i).is_finite())
}

fn largest_ratio<S: Real, R: Rate<S>>(values: &StateOf<S, R>, scales: &StateOf<S, R>, components: usize) -> f64 {
    (0..components).fold(0.0, |largest: f64, i| {
        let value = values.get(i).to_f64();
        if value == 0.0 { largest } else { largest.max((value / scales.get(i).to_f64()).abs()) }
    })
}

/// Integrates `x' = f(t, x)` from `initial` at `span.0` to `span.1` (later or earlier) by this pair.
///
/// Guarantee: each step's estimated error is at most `tolerance` of the flow's scales at the start of the step; the
/// error itself is usually smaller, the estimate being that of a lower order. Special case: an empty span returns the
/// initial state. Below a tolerance of 1e-14 the steps shrink under the rounding of the estimate: a power series does the
/// same for less. `maximum_steps` counts refused steps too; `Work::steps` counts accepted ones, evaluations are all.
///
/// # Errors
/// [`IntegrationError`], with time and state.
pub fn integrate<P: Pair, S: Real, R: Rate<S>, O: Observer<S, R::Seen>>(
    _: P,
    flow: &R,
    initial: &StateOf<S, R>,
    span: (S, S),
    settings: &Settings,
    observer: &mut O,
) -> Result<Arrival<S, StateOf<S, R>>, IntegrationError> {
    check_request(span, settings)?;
    let tolerance = settings.tolerance.max(S::EPSILON.to_f64());
    let components = match settings.norm {
        ErrorNorm::WithColumns => <StateOf<S, R> as Elements<S>>::LEN,
        ErrorNorm::BaseOnly => <R::Seen as Flow<S>>::BASE_DIMENSION,
    };
    let direction = if span.1 < span.0 { -S::ONE } else { S::ONE };
    let mut run = Run::<P, S, R>::new(flow, initial, span);
    let (mut wanted, mut refused) = (None, 0);
    loop {
        let remaining = run.remaining();
        if remaining * direction <= S::ZERO {
            return Ok(run.arrival(false));
        }
        run.begin_step()?;
        let scales = flow.seen().scales(&run.state);
        let mut length = match wanted {
            Some(length) => length,
            None => run.first_length(&scales, components, tolerance),
        };
        let mut largest_growth = GROW;
        loop {
            if run.work.steps + refused >= settings.maximum_steps {
                let (time, end, state) = (run.time.value.to_f64(), span.1.to_f64(), run.numbers());
                return Err(IntegrationError::StepLimit { steps: run.work.steps, time, end, state });
            }
            let last = S::from_f64(length) >= remaining.abs();
            let signed = if last { remaining } else { S::from_f64(length) * direction };
            if !last && run.time.value + signed == run.time.value {
                let (time, length, state) = (run.time.value.to_f64(), signed.to_f64(), run.numbers());
                return Err(IntegrationError::StepTooShort { time, length, state });
            }
            let increment = run.stepper.advance(flow, run.time.value, &run.state, signed, &mut run.work);
            let error = run.stepper.error(&scales, components, signed) / tolerance;
            // Zero gives an infinite factor, cut to the largest; not a number, the smallest.
            let factor = SAFETY * libm::pow(error, -1.0 / P::ESTIMATE_POWER as f64);
            length = signed.to_f64().abs() * factor.max(SHRINK).min(largest_growth);
            if error <= 1.0 && is_finite(&increment) {
                if run.end_step(&increment, signed, last, observer) {
                    return Ok(run.arrival(true));
                }
                break;
            }
            // After a refusal the next step is no longer than this one.
            refused += 1;
            largest_growth = 1.0;
        }
        wanted = Some(length);
    }
}

/// Integrates over a span in `steps` steps of equal length, without looking at the error: what orders of convergence
/// are measured with. Otherwise as [`integrate`]; no steps return the initial state if the span is empty.
///
/// # Errors
/// [`IntegrationError`]: a time or a state that is not finite, or no steps for a span that is not empty.
pub fn integrate_in_equal_steps<P: Pair, S: Real, R: Rate<S>, O: Observer<S, R::Seen>>(
    _: P,
    flow: &R,
    initial: &StateOf<S, R>,
    span: (S, S),
    steps: u64,
    observer: &mut O,
) -> Result<Arrival<S, StateOf<S, R>>, IntegrationError> {
    check_request(span, &Settings::new(1.0))?;
    let mut run = Run::<P, S, R>::new(flow, initial, span);
    let length = (span.1 - span.0) / S::from_f64(steps.max(1) as f64);
    for step in 1..=steps {
        run.begin_step()?;
        let last = step == steps;
        let length = if last { run.remaining() } else { length };
        let increment = run.stepper.advance(flow, run.time.value, &run.state, length, &mut run.work);
        if run.end_step(&increment, length, last, observer) {
            return Ok(run.arrival(true));
        }
    }
    if steps == 0 && span.0 != span.1 {
        let (time, end, state) = (span.0.to_f64(), span.1.to_f64(), run.numbers());
        return Err(IntegrationError::StepLimit { steps, time, end, state });
    }
    if !is_finite(&run.state) {
        return Err(IntegrationError::NotFinite { time: run.time.value.to_f64(), state: run.numbers() });
    }
    Ok(run.arrival(false))
}
