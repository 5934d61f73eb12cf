//! The loop over steps: from a start over a span of time, forward or backward, with observers looking at each step.
//!
//! State and time are sums of many increments and are kept compensated (Knuth's two-sum: the rounding error of each
//! addition is carried to the next), so what accumulates is the rounding inside the steps' series alone. No step
//! allocates. An observer sees each step's polynomial, may evaluate it anywhere inside, and may stop the integration;
//! observers are types, compiled in, and `()` is the one that costs nothing.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Algebra, Elements, Flow};
use crate::numerics::taylor::step::{ErrorNorm, Jet, StepPolicy, horner_increment, horner_increments};
use std::ops::ControlFlow;

/// Steps after which an integration gives up unless told otherwise. 1e4 periods of the article's problems take some
/// 40 steps each; more than this is a wrong request rather than a long one.
pub const DEFAULT_MAXIMUM_STEPS: u64 = 1_000_000;

/// What is asked of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Relative error per step: what the last terms kept may amount to. Requests below the scalar's ε are taken as ε: the
    /// rest is rounding.
    pub tolerance: f64,
    /// Steps after which to give up.
    pub maximum_steps: u64,
    /// Which components decide the step length.
    pub norm: ErrorNorm,
}

impl Settings {
    /// This tolerance, [`DEFAULT_MAXIMUM_STEPS`], columns steering too.
    pub fn new(tolerance: f64) -> Self {
        Settings { tolerance, maximum_steps: DEFAULT_MAXIMUM_STEPS, norm: ErrorNorm::WithColumns }
    }
}

/// Why an integration could not be carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IntegrationError {
    /// More steps than allowed.
    #[error("no end after {steps} steps, at time {time} (asked: up to {end}); state {state:?}")]
    StepLimit {
        /// Steps taken.
        steps: u64,
        /// Time reached.
        time: f64,
        /// Time asked for.
        end: f64,
        /// State reached.
        state: Vec<f64>,
    },
    /// A component became infinite or "not a number".
    #[error("the solution is not finite at time {time}; state {state:?}")]
    NotFinite {
        /// Time of the last finite state.
        time: f64,
        /// The state there.
        state: Vec<f64>,
    },
    /// The steps became too short to move the time: the solution runs into a singularity.
    #[error("steps of {length} no longer advance the time {time}; state {state:?}")]
    StepTooShort {
        /// Time reached.
        time: f64,
        /// Length of the step refused.
        length: f64,
        /// State reached.
        state: Vec<f64>,
    },
    /// A tolerance that is not a positive number, or a time that is not finite.
    #[error("the {name} must be finite{}, not {value}", if *.name == "tolerance" { " and positive" } else { "" })]
    Request {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

/// A number kept as the sum of a rounded value and a small rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensated<S> {
    /// The sum, rounded.
    pub value: S,
    /// What rounding left out.
    pub rest: S,
}

impl<S: Algebra> Compensated<S> {
    /// A value with nothing left out.
    pub fn new(value: S) -> Self {
        Compensated { value, rest: S::number(0.0) }
    }

    /// Adds an increment: `value` becomes the rounded sum, `rest` the rounding error (Knuth's two-sum, exact).
    #[inline(always)]
    pub fn add(&mut self, increment: S) {
        let increment = increment + self.rest;
        let sum = self.value + increment;
        let virtual_increment = sum - self.value;
        self.rest = (self.value - (sum - virtual_increment)) + (increment - virtual_increment);
        self.value = sum;
    }

    /// The sum with an offset, rounded once.
    #[inline(always)]
    pub fn plus(&self, offset: S) -> S {
        self.value + (self.rest + offset)
    }
}

/// One step as an observer sees it.
pub struct Step<'a, S: Real, F: Flow<S>> {
    /// The flow.
    pub flow: &'a F,
    /// Series about the start of the step.
    pub jet: &'a Jet<S, F>,
    /// Time at the start.
    pub start: Compensated<S>,
    /// Signed length.
    pub length: S,
    /// Whether this is the first step.
    pub first: bool,
    /// Whether this is the last step of the span.
    pub last: bool,
    /// The relative error asked for.
    pub tolerance: f64,
    /// What the compensated sums hold beside the state at the start.
    pub rest: &'a F::State<S>,
}

impl<S: Real, F: Flow<S>> Step<'_, S, F> {
    /// Time at an offset from the start.
    pub fn time(&self, offset: S) -> S {
        self.start.plus(offset)
    }

    /// The state at an offset between zero and `length`.
    pub fn state(&self, offset: S) -> F::State<S> {
        let mut state = F::State::<S>::filled(S::ZERO);
        for i in 0..<F::State<S> as Elements<S>>::LEN {
            let series = self.jet.state.get(i);
            *state.get_mut(i) = series[0] + (*self.rest.get(i) + horner_increment(series, self.jet.order(), offset));
        }
        state
    }
}

/// What looks at each step of an integration.
pub trait Observer<S: Real, F: Flow<S>> {
    /// Whether it will evaluate the polynomial of the step from `start` over `length`. Where it will not, a method that
    /// would have to work for that polynomial leaves it out, and the step's series mean nothing.
    #[inline(always)]
    fn looks_into(&self, _start: &Compensated<S>, _length: S) -> bool {
        true
    }

    /// Called after each step's series is known and before the state moves on; `Break` ends the integration there.
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()>;
}

/// Looks at nothing.
impl<S: Real, F: Flow<S>> Observer<S, F> for () {
    #[inline(always)]
    fn looks_into(&self, _: &Compensated<S>, _: S) -> bool {
        false
    }
    #[inline(always)]
    fn observe(&mut self, _: &Step<'_, S, F>, _: &mut Work) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Both look; the first to stop stops.
impl<S: Real, F: Flow<S>, A: Observer<S, F>, B: Observer<S, F>> Observer<S, F> for (A, B) {
    fn looks_into(&self, start: &Compensated<S>, length: S) -> bool {
        self.0.looks_into(start, length) || self.1.looks_into(start, length)
    }
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        let first = self.0.observe(step, work);
        let second = self.1.observe(step, work);
        if first.is_break() { first } else { second }
    }
}

/// Where an integration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival<S, State> {
    /// The end of the span, or the start of the step in which an observer stopped.
    pub time: S,
    /// The state there.
    pub state: State,
    /// Whether an observer stopped it.
    pub stopped: bool,
    /// What was done.
    pub work: Work,
}

/// Integrates `x' = f(x)` from `initial` at `span.0` to `span.1` (later or earlier).
///
/// Guarantee: each step's truncation error is about `tolerance` of the flow's scales (see
/// [`crate::numerics::taylor::step`]; on the way to the end the flow multiplies it by its growth); at `tolerance = ε`
/// rounding alone is left, a few ε times the growth of the flow. Special case: an empty span returns the initial state.
///
/// # Errors
/// [`IntegrationError`], with time and state.
pub fn integrate<S: Real, F: Flow<S>, O: Observer<S, F>>(
    flow: &F,
    initial: &F::State<S>,
    span: (S, S),
    settings: &Settings,
    observer: &mut O,
) -> Result<Arrival<S, F::State<S>>, IntegrationError> {
    let dimension = <F::State<S> as Elements<S>>::LEN;
    check_request(span, settings)?;
    let policy = StepPolicy::new(settings.tolerance, S::EPSILON.to_f64());
    let mut jet = Jet::<S, F>::new(policy.order);
    let order = jet.order();
    let mut work = Work { state_dimension: dimension as u64, ..Work::default() };
    let (mut time, mut state) = (Compensated::new(span.0), *initial);
    let mut rest = F::State::<S>::filled(S::ZERO);
    let direction = if span.1 < span.0 { -S::ONE } else { S::ONE };
    loop {
        let remaining = (span.1 - time.value) - time.rest;
        if remaining * direction <= S::ZERO {
            return Ok(Arrival { time: span.1, state, stopped: false, work });
        }
        if work.steps >= settings.maximum_steps {
            let (time, end, state) = (time.value.to_f64(), span.1.to_f64(), as_numbers::<S, F>(&state));
            return Err(IntegrationError::StepLimit { steps: work.steps, time, end, state });
        }
        jet.expand(flow, &state);
        let mut length = S::from_f64(jet.step_length(flow, &state, settings.norm, &policy));
        // "Not less than" and not "more than": false for NaN, which falls through to the error below.
        let last = length >= remaining.abs();
        length = if last { remaining } else { length * direction };
        if !length.is_finite() {
            return Err(IntegrationError::NotFinite { time: time.value.to_f64(), state: as_numbers::<S, F>(&state) });
        }
        if !last && time.value + length == time.value {
            let (time, length, state) = (time.value.to_f64(), length.to_f64(), as_numbers::<S, F>(&state));
            return Err(IntegrationError::StepTooShort { time, length, state });
        }
        work.steps += 1;
        work.flow_evaluations += order as u64;
        work.tangent_evaluations += (order * F::COLUMNS) as u64;
        let (first, tolerance) = (work.steps == 1, policy.tolerance);
        let step = Step { flow, jet: &jet, start: time, length, first, last, tolerance, rest: &rest };
        if observer.observe(&step, &mut work).is_break() {
            return Ok(Arrival { time: time.plus(S::ZERO), state, stopped: true, work });
        }
        let increments = horner_increments::<S, F>(&jet.state, order, length);
        for i in 0..dimension {
            let mut sum = Compensated { value: *state.get(i), rest: *rest.get(i) };
            sum.add(*increments.get(i));
            *state.get_mut(i) = sum.value;
            *rest.get_mut(i) = sum.rest;
        }
        if last {
            time = Compensated::new(span.1);
        } else {
            time.add(length);
        }
    }
}

pub(in crate::numerics) fn check_request<S: Real>(span: (S, S), settings: &Settings) -> Result<(), IntegrationError> {
    for (name, value) in [("start of the time span", span.0), ("end of the time span", span.1)] {
        if !value.is_finite() {
            return Err(IntegrationError::Request { name, value: value.to_f64() });
        }
    }
    if !(settings.tolerance > 0.0 && settings.tolerance.is_finite()) {
        return Err(IntegrationError::Request { name: "tolerance", value: settings.tolerance });
    }
    Ok(())
}

pub(in crate::numerics) fn as_numbers<S: Real, F: Flow<S>>(state: &F::State<S>) -> Vec<f64> {
    (0..<F::State<S> as Elements<S>>::LEN).map(|i| state.get(i).to_f64()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::flow::{Columns, Joined, Series, Tangent, WithColumns, convolve};
    use crate::numerics::taylor::step::order_for;

    /// `x'' = −x³` with its tangent: Duffing's oscillator without a linear term; x(0) = 1, x'(0) = 0 has the period
    /// 4·K(½) = 7.416298709205487… (lemniscate), energy x'²/2 + x⁴/4.
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
    impl Tangent<f64> for Quartic {
        type Column<T: Copy> = [T; 2];
        type ColumnAuxiliary<T: Copy> = [T; 0];
        type ColumnParameter = ();
        fn column_coefficients(
            &self,
            n: usize,
            _: &(),
            base: (&[Series<f64>; 2], &[Series<f64>; 1]),
            d: &[Series<f64>; 2],
            _: &mut [Series<f64>; 0],
        ) -> [f64; 2] {
            [d[1][n], -3.0 * convolve(&base.1[0], &d[0], n)]
        }
        fn column_scales(&self, _: &[f64; 2], d: &[f64; 2]) -> [f64; 2] {
            [d[0].abs().max(d[1].abs()); 2]
        }
    }

    const PERIOD: f64 = 7.416298709205487;

    #[test]
    fn one_period_returns_to_the_start() {
        // Oracle: the period 4 K(½) (DLMF 19.20.2, the lemniscate constant). dx/dt = 0 there; dv/dt = −1: the last
        // bit of PERIOD counts 4 ε. Errors at least as small as asked, times the number of steps.
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, f64::EPSILON] {
            let end = integrate(&Quartic, &[1.0, 0.0], (0.0, PERIOD), &Settings::new(tolerance), &mut ()).unwrap();
            let allowed = 30.0 * tolerance;
            assert!((end.state[0] - 1.0).abs() <= allowed, "{tolerance}: {end:?}");
            assert!(end.state[1].abs() <= allowed, "{tolerance}: {end:?}");
            assert_eq!(end.work.state_dimension, 2);
            assert_eq!(end.work.flow_evaluations, end.work.steps * order_for(tolerance) as u64);
            assert_eq!((end.work.tangent_evaluations, end.work.event_evaluations, end.work.dense_points), (0, 0, 0));
        }
    }

    #[test]
    fn there_and_back_again() {
        let settings = Settings::new(f64::EPSILON);
        let there = integrate(&Quartic, &[1.0, 0.25], (2.0, 12.0), &settings, &mut ()).unwrap();
        let back = integrate(&Quartic, &there.state, (12.0, 2.0), &settings, &mut ()).unwrap();
        // The flow's growth over t = 10 is about 10 (linear in t): 10² · a few ε.
        assert!((back.state[0] - 1.0).abs() < 300.0 * f64::EPSILON, "{back:?}");
        assert!((back.state[1] - 0.25).abs() < 300.0 * f64::EPSILON, "{back:?}");
        let none = integrate(&Quartic, &[1.0, 0.25], (2.0, 2.0), &settings, &mut ()).unwrap();
        assert_eq!((none.state, none.work.steps), ([1.0, 0.25], 0));
    }

    #[test]
    fn columns_are_derivatives_and_steer_only_when_asked() {
        let system = WithColumns { flow: Quartic, parameters: [(), ()] };
        let start = Joined { base: [1.0, 0.25], columns: Columns([[1.0, 0.0], [0.0, 1.0]]) };
        let with = |norm| Settings { norm, ..Settings::new(f64::EPSILON) };
        let end = integrate(&system, &start, (0.0, 3.0), &with(ErrorNorm::WithColumns), &mut ()).unwrap();
        let [[a, c], [b, d]] = end.state.columns.0;
        // Liouville: the flow keeps areas, the determinant of the columns is 1 (terms of size 5: 30 ε).
        assert!((a * d - b * c - 1.0).abs() < 30.0 * f64::EPSILON, "{end:?}");
        // Central differences of the base flow: error δ²·x''' ~ 1e-9 at δ = 1e-5.
        let base = |x, v| integrate(&Quartic, &[x, v], (0.0, 3.0), &with(ErrorNorm::WithColumns), &mut ()).unwrap();
        let (plus, minus) = (base(1.0 + 1e-5, 0.25), base(1.0 - 1e-5, 0.25));
        assert!(((plus.state[0] - minus.state[0]) / 2e-5 - a).abs() < 1e-7, "{a}");
        assert!(((plus.state[1] - minus.state[1]) / 2e-5 - c).abs() < 1e-7, "{c}");
        assert_eq!(end.work.tangent_evaluations, 2 * end.work.flow_evaluations);
        assert_eq!(end.work.state_dimension, 6);
        // With the base flow steering, columns change no bit of it.
        let alone = base(1.0, 0.25);
        let beside = integrate(&system, &start, (0.0, 3.0), &with(ErrorNorm::BaseOnly), &mut ()).unwrap();
        assert_eq!(alone.state.map(f64::to_bits), beside.state.base.map(f64::to_bits));
        assert_eq!(alone.work.steps, beside.work.steps);
    }

    struct Riccati;
    impl Flow<f64> for Riccati {
        type State<T: Copy> = [T; 1];
        type Auxiliary<T: Copy> = [T; 0];
        fn coefficients(&self, n: usize, x: &[Series<f64>; 1], _: &mut [Series<f64>; 0]) -> [f64; 1] {
            [convolve(&x[0], &x[0], n)]
        }
        fn scales(&self, x: &[f64; 1]) -> [f64; 1] {
            [x[0].abs()]
        }
    }

    #[test]
    fn errors_carry_time_and_state() {
        // x' = x² from 1 blows up at t = 1.
        let settings = Settings { maximum_steps: 20, ..Settings::new(1e-12) };
        match integrate(&Riccati, &[1.0], (0.0, 2.0), &settings, &mut ()) {
            Err(IntegrationError::StepLimit { steps: 20, time, end, state }) => {
                assert!(time > 0.8 && time < 1.0 && end == 2.0 && state.len() == 1, "{time} {state:?}");
                assert!((state[0] * (1.0 - time) - 1.0).abs() < 1e-10, "{time} {state:?}");
            }
            other => panic!("{other:?}"),
        }
        let long = integrate(&Riccati, &[1.0], (0.0, 2.0), &Settings::new(1e-12), &mut ());
        assert!(
            matches!(long, Err(IntegrationError::StepTooShort { time, .. }) if (time - 1.0).abs() < 1e-12),
            "{long:?}"
        );
        let wrong = integrate(&Riccati, &[f64::NAN], (0.0, 2.0), &settings, &mut ());
        assert!(matches!(wrong, Err(IntegrationError::NotFinite { time, .. }) if time == 0.0), "{wrong:?}");
        for (tolerance, end) in [(0.0, 1.0), (f64::NAN, 1.0), (1e-9, f64::INFINITY)] {
            let refused = integrate(&Riccati, &[1.0], (0.0, end), &Settings::new(tolerance), &mut ());
            assert!(matches!(refused, Err(IntegrationError::Request { .. })), "{refused:?}");
        }
    }
}
