//! Many starts of one flow at once: eight integrations beside each other, each with its own time and steps.
//!
//! The same flow, tangent columns, event function, step policy and sums as in [`crate::numerics::taylor::integrator`],
//! instantiated with packs. No member of a pack reads another, so an integration ends with the same bits as alone, in any
//! lane and beside any others. A lane that is done is given the next start at once, so that lanes do not wait for each other.
//!
//! Not known here: which instructions carry it out ([`crate::numerics::lanes`]), dense output (integrate one at a time
//! for that), times before the start.

use crate::numerics::counts::Work;
use crate::numerics::pack::{Mask, Pack};
use crate::numerics::taylor::events::{EventFunction, Expansion, ZeroCluster, Zeros};
use crate::numerics::taylor::flow::{Elements, Flow};
use crate::numerics::taylor::integrator::{Compensated, IntegrationError, Settings};
use crate::numerics::taylor::step::{Jet, StepPolicy, horner_increments};
use std::ops::ControlFlow;

/// Lanes of the widest pack.
const MOST_LANES: usize = 8;

/// Where starts come from and where results go.
pub trait Starts<P: Pack<Scalar = f64>, F: Flow<P>> {
    /// Puts the next start into a lane, its parameters into the flow and its state into the state, and returns the time up
    /// to which it is to be integrated (positive, from time zero); `None` when there are no more.
    fn load(&mut self, lane: usize, flow: &mut F, state: &mut F::State<P>) -> Option<f64>;

    /// Takes the result of the start that was loaded last into this lane.
    fn finish(&mut self, lane: usize, result: Result<LaneArrival<F::State<f64>>, IntegrationError>);
}

/// Where an integration in a lane ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneArrival<State> {
    /// The time of the event, or the end of the span.
    pub time: f64,
    /// The state there.
    pub state: State,
    /// Half width and multiplicity of the zero; `None` at the end of the span.
    pub event: Option<(f64, usize)>,
    /// What was done.
    pub work: Work,
}

/// An event function that never vanishes, for integrations without events: nothing is expanded.
#[derive(Clone, Copy, Debug)]
pub struct NoEvent;

/// An event function, or none.
pub trait LaneEvent<P: Pack, F: Flow<P>>: Clone {
    /// Whether there is anything to look for; if not, none of its code is compiled in.
    const PRESENT: bool;
    /// See [`Expansion::of`].
    fn expand(&self, expansion: &mut Expansion<P>, jet: &Jet<P, F>, length: P, tolerance: f64, active: P::Mask) -> P;
}

impl<P: Pack, F: Flow<P>> LaneEvent<P, F> for NoEvent {
    const PRESENT: bool = false;
    #[inline(always)]
    fn expand(&self, _: &mut Expansion<P>, _: &Jet<P, F>, _: P, _: f64, _: P::Mask) -> P {
        P::ZERO
    }
}

/// The zeros of a function.
#[derive(Clone, Copy, Debug)]
pub struct FirstZero<E>(
    /// The function.
    pub E,
);

impl<P: Pack, F: Flow<P>, E: EventFunction<P, F> + Clone> LaneEvent<P, F> for FirstZero<E> {
    const PRESENT: bool = true;
    #[inline(always)]
    fn expand(&self, expansion: &mut Expansion<P>, jet: &Jet<P, F>, length: P, tolerance: f64, active: P::Mask) -> P {
        expansion.of(&self.0, jet, length, tolerance, active)
    }
}

/// What is known of one lane.
struct Lane {
    end: f64,
    zeros: Zeros<(), f64>,
    /// Roots isolated and found; what every step costs is counted by `loaded_at`.
    work: Work,
    /// Steps that all lanes had taken when this one was loaded.
    loaded_at: u64,
    busy: bool,
}

impl Lane {
    /// The work after so many steps of all lanes.
    fn work_at(&self, steps: u64, order: usize, columns: usize, events: bool) -> Work {
        let steps = steps - self.loaded_at;
        Work {
            steps,
            flow_evaluations: steps * order as u64,
            tangent_evaluations: steps * (order * columns) as u64,
            event_evaluations: if events { steps } else { 0 },
            ..self.work
        }
    }
}

/// Integrates all starts, each from time zero up to the first zero of the event function (known to vanish to
/// `vanishing_order` at the start) or to its end.
///
/// `flow` is any flow of the kind: its parameters are overwritten by [`Starts::load`]. Guarantee: result for result the
/// bits of [`crate::numerics::taylor::integrator::integrate`] with `Events::first(1, …)`.
#[inline(always)]
pub fn integrate_lanes<P, F, E, Q>(mut flow: F, event: &E, vanishing_order: usize, settings: &Settings, starts: &mut Q)
where
    P: Pack<Scalar = f64>,
    F: Flow<P>,
    E: LaneEvent<P, F>,
    Q: Starts<P, F>,
{
    let dimension = <F::State<P> as Elements<P>>::LEN;
    let policy = StepPolicy::new(settings.tolerance, f64::EPSILON);
    let mut jet = Jet::<P, F>::new(policy.order);
    let order = jet.order();
    let mut expansion = Expansion::<P>::new();
    let mut scratch = [0.0; crate::numerics::polynomial_roots::MAX_COEFFICIENTS];
    let mut state = F::State::<P>::filled(P::ONE);
    let mut rest = F::State::<P>::filled(P::ZERO);
    let mut time = Compensated::new(P::ZERO);
    let mut end = P::ZERO;
    let mut lanes: [Lane; MOST_LANES] = std::array::from_fn(|_| Lane {
        end: 0.0,
        zeros: Zeros::new((), vanishing_order),
        work: Work::default(),
        loaded_at: 0,
        busy: false,
    });
    let mut more = true;
    let mut steps = 0;
    // When the first lane may have taken as many steps as are allowed.
    let mut first_limit = settings.maximum_steps;
    for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
        reload(lane, &mut more, starts, &mut flow, (&mut state, &mut rest, &mut time), of);
        end = end.with_lane(lane, of.end);
    }
    let mut busy = P::Mask::from_lanes(|lane| lanes[lane].busy);
    let mut holding = P::Mask::splat(false);
    while busy.any() {
        jet.expand(&flow, &state);
        let norms = jet.norms(&flow, &state, settings.norm);
        let mut length = norms.step_length(&policy);
        let remaining = (end - time.value) - time.rest;
        let last = length.at_least(remaining);
        length = P::select(last, remaining, length);
        length = P::select(busy, length, P::ZERO);
        // Lanes whose step can't be taken. A length that is not a number is not finite either.
        let finite = length.abs().less(P::from_f64(f64::INFINITY));
        let advances = last.or((time.value + length).equals(time.value).not());
        let mut done = P::Mask::splat(false);
        let trouble = busy.and(finite.and(advances).not());
        if trouble.any() {
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                if trouble.lane(lane) {
                    let (time, state) = (time.value.lane(lane), numbers::<P, F>(&state, lane));
                    let error = if finite.lane(lane) {
                        IntegrationError::StepTooShort { time, length: length.lane(lane), state }
                    } else {
                        IntegrationError::NotFinite { time, state }
                    };
                    starts.finish(lane, Err(error));
                    of.busy = false;
                }
            }
            done = trouble;
            length = P::select(trouble, P::ZERO, length);
        }
        let stepping = busy.and(trouble.not());
        steps += 1;
        // Zeros of the event function on this step.
        let mut found: [Option<ZeroCluster<f64>>; MOST_LANES] = [None; MOST_LANES];
        let mut offsets = P::ZERO;
        let mut hit = P::Mask::splat(false);
        if E::PRESENT {
            let noise = event.expand(&mut expansion, &jet, length, policy.tolerance, stepping);
            let first = P::Mask::from_lanes(|lane| steps - lanes[lane].loaded_at == 1);
            let may = expansion.may_vanish(first, vanishing_order, noise);
            let looked_at = stepping.and(may.or(holding));
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                if !looked_at.any() || !looked_at.lane(lane) {
                    continue;
                }
                let (zeros, work, found) = (&mut of.zeros, &mut of.work, &mut found[lane]);
                let visitor = |zero: ZeroCluster<f64>, _: &mut Work| {
                    *found = Some(zero);
                    ControlFlow::Break(())
                };
                let _ = if may.lane(lane) {
                    let shift = if first.lane(lane) { vanishing_order } else { 0 };
                    let count = expansion.last[lane] + 1 - shift;
                    for (n, coefficient) in scratch.iter_mut().enumerate().take(count) {
                        *coefficient = expansion.scaled[n + shift].lane(lane);
                    }
                    let span = (length.lane(lane), last.lane(lane));
                    zeros.isolate(&scratch[..count], noise.lane(lane), span, work, visitor)
                } else {
                    zeros.pass(work, visitor)
                };
            }
            if looked_at.any() {
                holding = P::Mask::from_lanes(|lane| lanes[lane].zeros.holds());
            }
            hit = P::Mask::from_lanes(|lane| found[lane].is_some());
            if hit.any() {
                offsets = P::from_lanes(|lane| found[lane].map_or(0.0, |zero| zero.offset));
            }
        }
        if hit.any() {
            let mut at = F::State::<P>::filled(P::ZERO);
            let increments = horner_increments::<P, F>(&jet.state, order, offsets);
            for i in 0..dimension {
                *at.get_mut(i) = jet.state.get(i)[0] + (*rest.get(i) + *increments.get(i));
            }
            let times = time.plus(offsets);
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                if let Some(zero) = found[lane] {
                    let event = Some((zero.blur, zero.multiplicity));
                    let (time, state) = (times.lane(lane), lane_of::<P, F>(&at, lane));
                    let work = of.work_at(steps, order, F::COLUMNS, E::PRESENT);
                    starts.finish(lane, Ok(LaneArrival { time, state, event, work }));
                    of.busy = false;
                }
            }
            done = done.or(hit);
        }
        // The others move on.
        let increments = horner_increments::<P, F>(&jet.state, order, length);
        for i in 0..dimension {
            let mut sum = Compensated { value: *state.get(i), rest: *rest.get(i) };
            sum.add(*increments.get(i));
            *state.get_mut(i) = sum.value;
            *rest.get_mut(i) = sum.rest;
        }
        let mut later = time;
        later.add(length);
        time = Compensated { value: P::select(last, end, later.value), rest: P::select(last, P::ZERO, later.rest) };
        let arrived = stepping.and(last).and(hit.not());
        if arrived.any() {
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                if arrived.lane(lane) {
                    let (time, state) = (of.end, lane_of::<P, F>(&state, lane));
                    let work = of.work_at(steps, order, F::COLUMNS, E::PRESENT);
                    starts.finish(lane, Ok(LaneArrival { time, state, event: None, work }));
                    of.busy = false;
                }
            }
            done = done.or(arrived);
        }
        if steps >= first_limit {
            first_limit = u64::MAX;
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                let taken = steps - of.loaded_at;
                if of.busy && taken >= settings.maximum_steps {
                    let (time, end) = (time.value.lane(lane), of.end);
                    let state = numbers::<P, F>(&state, lane);
                    starts.finish(lane, Err(IntegrationError::StepLimit { steps: taken, time, end, state }));
                    of.busy = false;
                    done = done.or(P::Mask::from_lanes(|i| i == lane));
                } else if of.busy {
                    first_limit = first_limit.min(of.loaded_at + settings.maximum_steps);
                }
            }
        }
        if done.any() {
            for (lane, of) in lanes.iter_mut().enumerate().take(P::WIDTH) {
                if done.lane(lane) {
                    of.zeros = Zeros::new((), vanishing_order);
                    of.loaded_at = steps;
                    reload(lane, &mut more, starts, &mut flow, (&mut state, &mut rest, &mut time), of);
                    end = end.with_lane(lane, of.end);
                }
            }
            busy = P::Mask::from_lanes(|lane| lanes[lane].busy);
            holding = P::Mask::from_lanes(|lane| lanes[lane].zeros.holds());
        }
    }
}

/// Loads the next start into a lane, if there is one.
#[inline(always)]
fn reload<P: Pack<Scalar = f64>, F: Flow<P>, Q: Starts<P, F>>(
    lane: usize,
    more: &mut bool,
    starts: &mut Q,
    flow: &mut F,
    (state, rest, time): (&mut F::State<P>, &mut F::State<P>, &mut Compensated<P>),
    of: &mut Lane,
) {
    of.busy = false;
    while *more && !of.busy {
        let Some(end) = starts.load(lane, flow, state) else {
            *more = false;
            break;
        };
        let dimension = <F::State<P> as Elements<P>>::LEN as u64;
        of.end = end;
        of.work = Work { state_dimension: dimension, ..Work::default() };
        of.busy = end > 0.0 && end.is_finite();
        if !of.busy {
            let refused = IntegrationError::Request { name: "end of the time span", value: end };
            starts.finish(lane, Err(refused));
        }
    }
    for i in 0..<F::State<P> as Elements<P>>::LEN {
        let member = rest.get_mut(i);
        *member = member.with_lane(lane, 0.0);
        if !of.busy {
            // An idle lane rests at a harmless state.
            let member = state.get_mut(i);
            *member = member.with_lane(lane, 1.0);
        }
    }
    time.value = time.value.with_lane(lane, 0.0);
    time.rest = time.rest.with_lane(lane, 0.0);
}

fn lane_of<P: Pack<Scalar = f64>, F: Flow<P>>(state: &F::State<P>, lane: usize) -> F::State<f64> {
    let mut one = F::State::<f64>::filled(0.0);
    for i in 0..<F::State<P> as Elements<P>>::LEN {
        *one.get_mut(i) = state.get(i).lane(lane);
    }
    one
}

fn numbers<P: Pack<Scalar = f64>, F: Flow<P>>(state: &F::State<P>, lane: usize) -> Vec<f64> {
    (0..<F::State<P> as Elements<P>>::LEN).map(|i| state.get(i).lane(lane)).collect()
}

/// Starts in a slice, and their outcomes in the same order.
pub struct Slice<'a, T, O, L, D> {
    starts: &'a [T],
    next: usize,
    /// Which start each lane has.
    loaded: [usize; MOST_LANES],
    outcomes: Vec<Option<O>>,
    load: L,
    done: D,
}

impl<'a, T, O, L, D> Slice<'a, T, O, L, D> {
    /// `load(start, lane, flow, state)` puts a start into a lane and returns the end of its span, or the outcome of a
    /// start that is refused; `done(start, result)` makes an outcome of a result.
    pub fn new(starts: &'a [T], load: L, done: D) -> Self {
        Slice { starts, next: 0, loaded: [0; MOST_LANES], outcomes: starts.iter().map(|_| None).collect(), load, done }
    }

    /// The outcomes, in the order of the starts.
    pub fn outcomes(self) -> Vec<O> {
        // Every start was loaded and finished, or refused.
        self.outcomes.into_iter().flatten().collect()
    }
}

impl<P, F, T, O, L, D> Starts<P, F> for Slice<'_, T, O, L, D>
where
    P: Pack<Scalar = f64>,
    F: Flow<P>,
    L: FnMut(&T, usize, &mut F, &mut F::State<P>) -> Result<f64, Box<O>>,
    D: FnMut(&T, Result<LaneArrival<F::State<f64>>, IntegrationError>) -> O,
{
    #[inline(always)]
    fn load(&mut self, lane: usize, flow: &mut F, state: &mut F::State<P>) -> Option<f64> {
        while let Some(start) = self.starts.get(self.next) {
            let index = self.next;
            self.next += 1;
            match (self.load)(start, lane, flow, state) {
                Ok(end) => {
                    self.loaded[lane] = index;
                    return Some(end);
                }
                Err(outcome) => self.outcomes[index] = Some(*outcome),
            }
        }
        None
    }

    fn finish(&mut self, lane: usize, result: Result<LaneArrival<F::State<f64>>, IntegrationError>) {
        let index = self.loaded[lane];
        self.outcomes[index] = Some((self.done)(&self.starts[index], result));
    }
}

/// Sets one member of several packs.
#[inline(always)]
pub fn set_lane<P: Pack<Scalar = f64>>(lane: usize, members: &mut [P], values: &[f64]) {
    for (member, value) in members.iter_mut().zip(values) {
        *member = member.with_lane(lane, *value);
    }
}
