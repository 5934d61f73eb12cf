//! Events: every time at which a polynomial function of the state vanishes, none skipped.
//!
//! The function is expanded as a Taylor series over the step, as the state itself is, and the real roots of that
//! polynomial are isolated ([`crate::numerics::polynomial_roots`]): no signs are sampled. A double or triple root is
//! reported once, as a cluster with its width. What the rounding of the series may hide is kept as `noise`: roots at
//! the joint of two steps, seen by both or by neither within the noise, are joined to one.
//!
//! A root of known multiplicity at the start of the integration (a Jacobi determinant vanishes at its starting point)
//! is divided out of the first step's series, or skipped by arming after a proven lower bound.
//!
//! Not known here: what the function means.

use crate::numerics::counts::Work;
use crate::numerics::polynomial_roots::{RootCluster, visit_unit_interval_roots};
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{CAPACITY, Elements, Flow, Series};
use crate::numerics::taylor::integrator::{Observer, Step};
use crate::numerics::taylor::step::{Jet, absolute_sum};
use std::ops::ControlFlow;

/// Rounding errors of a product series' values in units of ε times the sum of the absolute values of its terms: one
/// per product and one per sum that meet in a coefficient, most of them far smaller; doubled for both sides of a joint.
const NOISE_IN_EPSILONS: f64 = 4.0;

/// A function of the state whose zeros are the events.
pub trait EventFunction<S: Real, F: Flow<S>> {
    /// Writes the coefficients `0..=order` of the function's series. Returns an upper bound, on offsets up to `length`,
    /// of the sum of the absolute values of the terms that it adds up: what rounding errors are relative to.
    fn series(&self, jet: &Jet<S, F>, length: S, out: &mut Series<S>) -> S;
}

/// A component of the state as event function.
#[derive(Clone, Copy, Debug)]
pub struct Component(
    /// Index of the component.
    pub usize,
);

impl<S: Real, F: Flow<S>> EventFunction<S, F> for Component {
    fn series(&self, jet: &Jet<S, F>, length: S, out: &mut Series<S>) -> S {
        *out = *jet.state.get(self.0);
        absolute_sum(out, jet.order(), length)
    }
}

/// One event: a zero of the function, or a cluster of zeros that rounding does not separate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventRoot<S, State> {
    /// Time of the event.
    pub time: S,
    /// How far from `time` rounding inside this step may have moved the zero (half the width of a cluster); what was
    /// lost before the step is not in it.
    pub blur: S,
    /// Number of zeros in the cluster; 1 for a simple zero.
    pub multiplicity: usize,
    /// The state at `time`.
    pub state: State,
}

/// Finds the zeros of an event function, in the order of the integration.
pub struct Events<E, S: Real, F: Flow<S>> {
    function: E,
    armed_after: Option<S>,
    vanishing_order: usize,
    wanted: usize,
    /// What was found so far.
    pub found: Vec<EventRoot<S, F::State<S>>>,
    /// A root that touches the end of the last step, held back until the next step has been seen.
    held: Option<EventRoot<S, F::State<S>>>,
    /// 1 forward in time, −1 backward.
    direction: S,
}

impl<E: EventFunction<S, F>, S: Real, F: Flow<S>> Events<E, S, F> {
    /// Looks for the first `wanted` events; the integration stops once they are found.
    pub fn first(wanted: usize, function: E) -> Self {
        let found = Vec::with_capacity(wanted.min(64));
        Events { function, armed_after: None, vanishing_order: 0, wanted, found, held: None, direction: S::ONE }
    }

    /// The function is known to vanish to this order at the start: those roots are divided out.
    pub fn vanishing_at_start(mut self, order: usize) -> Self {
        self.vanishing_order = order;
        self
    }

    /// Events up to and at this time (in the direction of the integration) are not reported.
    pub fn armed_after(mut self, time: S) -> Self {
        self.armed_after = Some(time);
        self
    }

    fn report(&mut self, root: EventRoot<S, F::State<S>>, direction: S, work: &mut Work) -> ControlFlow<()> {
        let armed = match self.armed_after {
            Some(time) => (root.time - time) * direction > S::ZERO,
            None => true,
        };
        if armed {
            work.roots_found += 1;
            self.found.push(root);
        }
        if self.found.len() >= self.wanted { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

impl<E: EventFunction<S, F>, S: Real, F: Flow<S>> Observer<S, F> for Events<E, S, F> {
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        if self.found.len() >= self.wanted {
            return ControlFlow::Break(());
        }
        work.event_evaluations += 1;
        let mut series = [S::ZERO; CAPACITY];
        let magnitude = self.function.series(step.jet, step.length, &mut series);
        // In units of the step, u = offset / length: the coefficients become comparable, the interval is [0, 1].
        let shift = if step.first { self.vanishing_order } else { 0 };
        let count = step.jet.order() + 1 - shift;
        let mut scaled = [S::ZERO; CAPACITY];
        let mut power = S::ONE;
        for k in 0..step.jet.order() + 1 {
            if k >= shift {
                scaled[k - shift] = series[k] * power;
            }
            power *= step.length;
        }
        let noise = S::from_f64(NOISE_IN_EPSILONS) * S::EPSILON * magnitude;
        let direction = if step.length < S::ZERO { -S::ONE } else { S::ONE };
        self.direction = direction;
        let rest = scaled[1..count].iter().fold(noise, |sum, c| sum + c.abs());
        if scaled[0].abs() > rest {
            // No root on this step: the constant term outweighs all others.
            return match self.held.take() {
                Some(root) => self.report(root, direction, work),
                None => ControlFlow::Continue(()),
            };
        }
        work.root_isolations += 1;
        let mut previous = self.held.take();
        let flow = visit_unit_interval_roots(&scaled[..count], noise, |cluster| {
            let mut root = locate(&cluster, step);
            if let Some(before) = previous.take() {
                if cluster.lower <= S::ZERO {
                    // Both sides of the joint see it: one root.
                    root.blur = root.blur.max(before.blur);
                    root.multiplicity = root.multiplicity.max(before.multiplicity);
                } else {
                    self.report(before, direction, work)?;
                }
            }
            if cluster.upper >= S::ONE {
                self.held = Some(root);
                return ControlFlow::Continue(());
            }
            self.report(root, direction, work)
        });
        flow?;
        match previous {
            Some(root) => self.report(root, direction, work),
            None => ControlFlow::Continue(()),
        }
    }

    fn finish(&mut self, work: &mut Work) {
        if let Some(root) = self.held.take() {
            let _ = self.report(root, self.direction, work);
        }
    }
}

fn locate<S: Real, F: Flow<S>>(cluster: &RootCluster<S>, step: &Step<'_, S, F>) -> EventRoot<S, F::State<S>> {
    let offset = cluster.root * step.length;
    let blur = (cluster.upper - cluster.lower) * S::from_f64(0.5) * step.length.abs();
    EventRoot { time: step.time(offset), blur, multiplicity: cluster.multiplicity, state: step.state(offset) }
}
