//! Events: every time at which a polynomial function of the state vanishes, none skipped.
//!
//! On a step the state is a polynomial in time, so the function is one too, of higher degree: its coefficients are
//! computed as far as they matter on the step (a product of two series may converge more slowly than each), and its
//! real roots are isolated ([`crate::numerics::polynomial_roots`]): no signs are sampled. A double or triple root is
//! reported once, as a cluster with its width. What the rounding of the series may hide is kept as `noise`: roots at
//! the joint of two steps, seen by both or by neither within the noise, are joined to one.
//!
//! A root of known multiplicity at the start of the integration (a Jacobi determinant vanishes at its starting point)
//! is divided out of the first step's series, or skipped by arming after a proven lower bound.
//!
//! Not known here: what the function means.

use crate::numerics::counts::Work;
use crate::numerics::pack::{Mask, Pack};
use crate::numerics::polynomial_roots::{MAX_COEFFICIENTS, RootCluster, visit_unit_interval_roots};
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Algebra, Elements, Flow};
use crate::numerics::taylor::integrator::{Observer, Step};
use crate::numerics::taylor::step::{Jet, absolute_sum};
use std::ops::ControlFlow;

/// Rounding errors of a product series' values in units of ε times the sum of the absolute values of its terms: one
/// per product and one per sum that meet in a coefficient, most of them far smaller; doubled for both sides of a joint.
const NOISE_IN_EPSILONS: f64 = 4.0;

/// What a function's series may leave out, in units of the request: far less than what the step's own series leave out.
const LEFT_OUT: f64 = 1e-2;

/// Members of the widest pack.
const MOST_MEMBERS: usize = 8;

/// Coefficients of an event function along a step.
pub type EventSeries<S> = [S; MAX_COEFFICIENTS];

/// A polynomial function of the state whose zeros are the events.
pub trait EventFunction<S: Algebra, F: Flow<S>> {
    /// Its degree in the components of the state.
    const DEGREE: usize;

    /// Writes the coefficients `0..=last` of the function of the step's polynomials, which end with the jet's order.
    fn series(&self, jet: &Jet<S, F>, last: usize, out: &mut EventSeries<S>);

    /// Writes the coefficients `first..=last`, those before being there already.
    #[inline(always)]
    fn extend(&self, jet: &Jet<S, F>, first: usize, last: usize, out: &mut EventSeries<S>) {
        let _ = first;
        self.series(jet, last, out);
    }

    /// An upper bound, on offsets up to `length`, of the sum of the absolute values of the terms that the function adds
    /// up: what rounding errors are relative to.
    fn magnitude(&self, jet: &Jet<S, F>, length: S) -> S;
}

/// A component of the state as event function.
#[derive(Clone, Copy, Debug)]
pub struct Component(
    /// Index of the component.
    pub usize,
);

impl<S: Algebra, F: Flow<S>> EventFunction<S, F> for Component {
    const DEGREE: usize = 1;
    #[inline(always)]
    fn series(&self, jet: &Jet<S, F>, last: usize, out: &mut EventSeries<S>) {
        out[..=last].copy_from_slice(&jet.state.get(self.0)[..=last]);
    }
    #[inline(always)]
    fn magnitude(&self, jet: &Jet<S, F>, length: S) -> S {
        absolute_sum(jet.state.get(self.0), jet.order(), length)
    }
}

/// A zero of the function on a step, or a cluster of zeros that rounding does not separate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroCluster<S> {
    /// Where, from the start of the step (a hair before it, if the step before has held it back).
    pub offset: S,
    /// How far from `offset` rounding inside this step may have moved the zero (half the width of a cluster).
    pub blur: S,
    /// Number of zeros in the cluster; 1 for a simple zero.
    pub multiplicity: usize,
}

/// Visits the zeros of an event function step by step, in the order of the integration: what observers are built from.
#[derive(Clone, Copy, Debug)]
pub struct Zeros<E, S> {
    function: E,
    vanishing_order: usize,
    /// A zero that touches the end of the last step, held back until the next step has been seen.
    held: Option<ZeroCluster<S>>,
}

impl<E, S: Real> Zeros<E, S> {
    /// Of this function, which is known to vanish to this order at the start of the integration.
    pub fn new(function: E, vanishing_order: usize) -> Self {
        Zeros { function, vanishing_order, held: None }
    }

    /// Visits the zeros on one step. Guarantee: over all steps every zero is visited once.
    pub fn visit<F: Flow<S>>(
        &mut self,
        step: &Step<'_, S, F>,
        work: &mut Work,
        visitor: impl FnMut(ZeroCluster<S>, &mut Work) -> ControlFlow<()>,
    ) -> ControlFlow<()>
    where
        E: EventFunction<S, F>,
    {
        let mut expansion = Expansion::new();
        let noise = expansion.of(&self.function, step.jet, step.length, step.tolerance, true);
        let shift = if step.first { self.vanishing_order } else { 0 };
        let scaled = &expansion.scaled[shift..=expansion.last[0]];
        if expansion.may_vanish(step.first, self.vanishing_order, noise) {
            self.isolate(scaled, noise, (step.length, step.last), work, visitor)
        } else {
            self.pass(work, visitor)
        }
    }

    /// Whether a zero of the last step is held back.
    pub(super) fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// No zero on this step: what was held back from the step before is visited.
    pub(super) fn pass(
        &mut self,
        work: &mut Work,
        mut visitor: impl FnMut(ZeroCluster<S>, &mut Work) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        work.event_evaluations += 1;
        match self.held.take() {
            Some(zero) => {
                work.roots_found += 1;
                visitor(zero, work)
            }
            None => ControlFlow::Continue(()),
        }
    }

    /// Visits the zeros on a step of this length (and whether it is the last) with these coefficients in units of the step.
    pub(super) fn isolate(
        &mut self,
        scaled: &[S],
        noise: S,
        (length, is_last): (S, bool),
        work: &mut Work,
        mut visitor: impl FnMut(ZeroCluster<S>, &mut Work) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        work.event_evaluations += 1;
        let mut previous = self.held.take();
        work.root_isolations += 1;
        let held = &mut self.held;
        visit_unit_interval_roots(scaled, noise, |cluster| {
            let mut zero = on_step(&cluster, length);
            if let Some(before) = previous.take() {
                if cluster.lower <= S::ZERO {
                    // Both sides of the joint see it: one zero.
                    zero.blur = zero.blur.max(before.blur);
                    zero.multiplicity = zero.multiplicity.max(before.multiplicity);
                } else {
                    work.roots_found += 1;
                    visitor(before, work)?;
                }
            }
            if cluster.upper >= S::ONE && !is_last {
                *held = Some(ZeroCluster { offset: zero.offset - length, ..zero });
                return ControlFlow::Continue(());
            }
            work.roots_found += 1;
            visitor(zero, work)
        })?;
        match previous {
            Some(zero) => {
                work.roots_found += 1;
                visitor(zero, work)
            }
            None => ControlFlow::Continue(()),
        }
    }
}

/// A function's coefficients along a step in units of the step, `u = offset / length`, so that they are comparable and
/// the interval is `[0, 1]`. Made once, and reused by every step.
#[derive(Clone, Copy, Debug)]
pub struct Expansion<P> {
    raw: EventSeries<P>,
    /// The coefficients.
    pub scaled: EventSeries<P>,
    /// The last that matters, for each member of the pack.
    pub last: [usize; MOST_MEMBERS],
    /// The least and the largest of these.
    lowest: usize,
    highest: usize,
}

impl<P: Pack> Default for Expansion<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P: Pack> Expansion<P> {
    /// Room for one.
    pub fn new() -> Self {
        let zero = [P::ZERO; MAX_COEFFICIENTS];
        Expansion { raw: zero, scaled: zero, last: [0; MOST_MEMBERS], lowest: 0, highest: 0 }
    }

    /// Expands a function over a step until what is left out does not matter, for the members that are `active`; returns
    /// the noise: what rounding, and what was left out, may hide.
    #[inline(always)]
    pub fn of<F: Flow<P>, E: EventFunction<P, F>>(
        &mut self,
        function: &E,
        jet: &Jet<P, F>,
        length: P,
        tolerance: f64,
        active: P::Mask,
    ) -> P {
        let order = jet.order();
        let magnitude = function.magnitude(jet, length);
        let unit = P::EPSILON * magnitude;
        let mut noise = unit * P::from_f64(NOISE_IN_EPSILONS);
        let negligible = P::EPSILON.max(P::from_f64(tolerance * LEFT_OUT)) * magnitude;
        let highest = (E::DEGREE * order).min(MAX_COEFFICIENTS - 1);
        let (mut first, mut last, mut power) = (0, order.min(highest), P::ONE);
        self.lowest = last;
        let mut open = active;
        loop {
            function.extend(jet, first, last, &mut self.raw);
            for n in first..=last {
                self.scaled[n] = self.raw[n] * power;
                power *= length;
            }
            for member in 0..P::WIDTH {
                if open.lane(member) {
                    self.last[member] = last;
                }
            }
            self.highest = last;
            if last == order * E::DEGREE {
                return noise;
            }
            let tail = self.scaled[last].abs() + self.scaled[last - 1].abs();
            // What is left out is part of the noise, unless rounding is larger anyway.
            let hidden = tail.at_most(unit * P::from_f64(0.25));
            let ends = open.and(if last == highest { P::Mask::splat(true) } else { tail.at_most(negligible) });
            noise = P::select(ends.and(hidden.not()), noise + tail, noise);
            open = open.and(ends.not());
            if !open.any() {
                return noise;
            }
            (first, last) = (last + 1, (last + order / 4).min(highest));
        }
    }

    /// Where there may be a zero on the step; elsewhere there is none. For the members whose step is the first,
    /// `vanishing_order` coefficients are left out.
    ///
    /// On `[0, 1]` a polynomial is a mean of the partial sums of its coefficients (Abel's summation: the weights `uⁿ − uⁿ⁺¹`
    /// are not negative and add up to 1), so there is no zero where all of them have one sign beyond the noise.
    #[inline(always)]
    pub fn may_vanish(&self, first: P::Mask, vanishing_order: usize, noise: P) -> P::Mask {
        let mut sum = P::select(first, P::ZERO, self.scaled[0]);
        let (mut lowest, mut largest) = (sum, sum);
        if first.any() {
            // Members whose step is the first begin later.
            for n in 1..=vanishing_order {
                sum += P::select(first, P::ZERO, self.scaled[n]);
                (lowest, largest) = (lowest.min(sum), largest.max(sum));
            }
            let begun = sum + self.scaled[vanishing_order];
            sum = P::select(first, begun, sum);
            lowest = P::select(first, sum, lowest);
            largest = P::select(first, sum, largest);
        } else {
            for n in 1..=vanishing_order {
                sum += self.scaled[n];
                (lowest, largest) = (lowest.min(sum), largest.max(sum));
            }
        }
        for n in vanishing_order + 1..=self.highest {
            if n > self.lowest {
                let counts = P::Mask::from_lanes(|member| n <= self.last[member]);
                sum = P::select(counts, sum + self.scaled[n], sum);
            } else {
                sum += self.scaled[n];
            }
            (lowest, largest) = (lowest.min(sum), largest.max(sum));
        }
        lowest.more(noise).or(largest.less(-noise)).not()
    }
}

fn on_step<S: Real>(cluster: &RootCluster<S>, length: S) -> ZeroCluster<S> {
    let blur = (cluster.upper - cluster.lower) * S::from_f64(0.5) * length.abs();
    ZeroCluster { offset: cluster.root * length, blur, multiplicity: cluster.multiplicity }
}

/// One event.
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

/// Collects the first zeros of an event function, in the order of the integration, then stops it.
pub struct Events<E, S: Real, F: Flow<S>> {
    zeros: Zeros<E, S>,
    armed_after: Option<S>,
    wanted: usize,
    /// What was found so far.
    pub found: Vec<EventRoot<S, F::State<S>>>,
}

impl<E: EventFunction<S, F>, S: Real, F: Flow<S>> Events<E, S, F> {
    /// Looks for the first `wanted` events; the integration stops once they are found.
    pub fn first(wanted: usize, function: E) -> Self {
        let found = Vec::with_capacity(wanted.min(64));
        Events { zeros: Zeros::new(function, 0), armed_after: None, wanted, found }
    }

    /// The function is known to vanish to this order at the start: those roots are divided out.
    pub fn vanishing_at_start(mut self, order: usize) -> Self {
        self.zeros.vanishing_order = order;
        self
    }

    /// Events up to and at this time (in the direction of the integration) are not reported.
    pub fn armed_after(mut self, time: S) -> Self {
        self.armed_after = Some(time);
        self
    }
}

impl<E: EventFunction<S, F>, S: Real, F: Flow<S>> Observer<S, F> for Events<E, S, F> {
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        if self.found.len() >= self.wanted {
            return ControlFlow::Break(());
        }
        let direction = if step.length < S::ZERO { -S::ONE } else { S::ONE };
        let (found, wanted, armed_after) = (&mut self.found, self.wanted, self.armed_after);
        self.zeros.visit(step, work, |zero, _| {
            let time = step.time(zero.offset);
            if armed_after.is_none_or(|armed| (time - armed) * direction > S::ZERO) {
                let (blur, multiplicity) = (zero.blur, zero.multiplicity);
                found.push(EventRoot { time, blur, multiplicity, state: step.state(zero.offset) });
            }
            if found.len() >= wanted { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::flow::{Series, product};
    use crate::numerics::taylor::integrator::{Settings, integrate};

    /// `(cos t, sin t)` and a clock.
    struct Circle;
    impl Flow<f64> for Circle {
        type State<T: Copy> = [T; 3];
        type Auxiliary<T: Copy> = [T; 0];
        fn coefficients(&self, n: usize, x: &[Series<f64>; 3], _: &mut [Series<f64>; 0]) -> [f64; 3] {
            [-x[1][n], x[0][n], if n == 0 { 1.0 } else { 0.0 }]
        }
        fn scales(&self, _: &[f64; 3]) -> [f64; 3] {
            [1.0; 3]
        }
    }

    /// `(cos t − c)(cos t − c − gap)` or, cubed, `(cos t − c)³`.
    struct Power {
        level: f64,
        gap: f64,
        exponent: usize,
    }
    impl Power {
        fn factors(&self, jet: &Jet<f64, Circle>) -> [Series<f64>; 3] {
            [self.level, self.level + self.gap, self.level].map(|by| {
                let mut series = jet.state[0];
                series[0] -= by;
                series
            })
        }
    }
    impl EventFunction<f64, Circle> for Power {
        const DEGREE: usize = 3;
        fn series(&self, jet: &Jet<f64, Circle>, last: usize, out: &mut EventSeries<f64>) {
            let factors = self.factors(jet);
            let mut powers = [0.0; MAX_COEFFICIENTS];
            powers[0] = 1.0;
            for factor in &factors[..self.exponent] {
                let mut next = [0.0; MAX_COEFFICIENTS];
                for (n, c) in next.iter_mut().enumerate().take(last + 1) {
                    *c = product(&powers, &factor[..=jet.order()], n);
                }
                powers = next;
            }
            *out = powers;
        }
        fn magnitude(&self, jet: &Jet<f64, Circle>, length: f64) -> f64 {
            let sizes = self.factors(jet).map(|factor| absolute_sum(&factor, jet.order(), length));
            sizes[..self.exponent].iter().product()
        }
    }

    fn events(function: Power, end: f64, wanted: usize) -> (Vec<EventRoot<f64, [f64; 3]>>, Work) {
        let mut events = Events::first(wanted, function);
        let arrival =
            integrate(&Circle, &[1.0, 0.0, 0.0], (0.0, end), &Settings::new(f64::EPSILON), &mut events).unwrap();
        (events.found, arrival.work)
    }

    #[test]
    fn simple_roots_forward_and_backward() {
        // cos t = c at ±acos c + 2πn. Oracle: libm's acos; slope sin ≥ 0.1, so 60 ε of absolute error cover rounding.
        for level in [-0.9, -0.3, 0.0, 0.7, 0.99] {
            for direction in [1.0, -1.0] {
                let (found, work) = events(Power { level, gap: 0.0, exponent: 1 }, direction * 40.0, 100);
                let angle = libm::acos(level);
                let mut expected = Vec::new();
                for n in 0..8 {
                    let turn = 2.0 * std::f64::consts::PI * f64::from(n);
                    expected.extend([turn + angle, turn + 2.0 * std::f64::consts::PI - angle]);
                }
                expected.retain(|t| *t < 40.0);
                assert_eq!(found.len(), expected.len(), "{level} {direction}: {found:?}");
                for (root, t) in found.iter().zip(&expected) {
                    assert!((root.time - direction * t).abs() < 60.0 * f64::EPSILON, "{level}: {root:?} {t}");
                    assert!((root.state[2] - root.time).abs() < 1e-14 && root.multiplicity == 1);
                }
                assert_eq!(work.event_evaluations, work.steps);
            }
        }
    }

    #[test]
    fn touching_and_triple_roots_are_one_cluster() {
        // (cos t − c)^m: width (C ε)^(1/m).
        for (exponent, width) in [(2, 1e-6), (3, 1e-4)] {
            let (found, _) = events(Power { level: 0.3, gap: 0.0, exponent }, 12.0, 100);
            let angle = libm::acos(0.3);
            let turn = 2.0 * std::f64::consts::PI;
            let expected = [angle, turn - angle, turn + angle, 2.0 * turn - angle];
            assert_eq!(found.len(), 4, "{exponent}: {found:?}");
            for (root, t) in found.iter().zip(expected) {
                assert_eq!(root.multiplicity, exponent, "{root:?}");
                assert!((root.time - t).abs() < width && root.blur < width, "{root:?} {t}");
            }
        }
    }

    #[test]
    fn close_pairs_are_not_skipped() {
        // Roots acos(0.3) and acos(0.3 + gap), closer than any step: signs at steps never see them.
        let (found, work) = events(Power { level: 0.3, gap: 1e-6, exponent: 2 }, 3.0, 100);
        assert_eq!(found.len(), 2, "{found:?}");
        // The pair's slope is 1e-6: ε/1e-6 of error, a few.
        assert!((found[0].time - libm::acos(0.3 + 1e-6)).abs() < 2e-9, "{found:?}");
        assert!((found[1].time - libm::acos(0.3)).abs() < 2e-9, "{found:?}");
        assert!(work.root_isolations <= work.steps);
    }

    #[test]
    fn the_start_is_divided_out_and_arming_waits() {
        // sin t vanishes at 0: divided out, the first event is π; armed after 4, it is 2π.
        let run = |events: &mut Events<Component, f64, Circle>| {
            integrate(&Circle, &[1.0, 0.0, 0.0], (0.0, 20.0), &Settings::new(f64::EPSILON), events).unwrap()
        };
        let mut first = Events::first(1, Component(1)).vanishing_at_start(1);
        assert!(run(&mut first).stopped);
        assert!((first.found[0].time - std::f64::consts::PI).abs() < 4.0 * f64::EPSILON, "{:?}", first.found);
        let mut later = Events::first(2, Component(1)).vanishing_at_start(1).armed_after(4.0);
        run(&mut later);
        assert!((later.found[0].time - 2.0 * std::f64::consts::PI).abs() < 8.0 * f64::EPSILON, "{:?}", later.found);
        let mut raw = Events::first(9, Component(1));
        run(&mut raw);
        assert_eq!(raw.found.len(), 7, "0, π, …, 6π: {:?}", raw.found);
    }

    #[test]
    fn a_root_on_the_joint_of_two_steps_is_counted_once() {
        // The clock reaches the end of a step exactly: every level tried is a step's end, seen from both sides.
        struct Clock(f64);
        impl EventFunction<f64, Circle> for Clock {
            const DEGREE: usize = 1;
            fn series(&self, jet: &Jet<f64, Circle>, last: usize, out: &mut EventSeries<f64>) {
                out[..=last].copy_from_slice(&jet.state[2][..=last]);
                out[0] -= self.0;
            }
            fn magnitude(&self, jet: &Jet<f64, Circle>, length: f64) -> f64 {
                jet.state[2][0] + length.abs() + self.0.abs()
            }
        }
        let mut ends = Vec::new();
        struct Ends<'a>(&'a mut Vec<f64>);
        impl Observer<f64, Circle> for Ends<'_> {
            fn observe(&mut self, step: &Step<'_, f64, Circle>, _: &mut Work) -> ControlFlow<()> {
                self.0.push(step.time(step.length));
                ControlFlow::Continue(())
            }
        }
        let settings = Settings::new(f64::EPSILON);
        integrate(&Circle, &[1.0, 0.0, 0.0], (0.0, 30.0), &settings, &mut Ends(&mut ends)).unwrap();
        for end in ends {
            let mut events = Events::first(5, Clock(end));
            integrate(&Circle, &[1.0, 0.0, 0.0], (0.0, 31.0), &settings, &mut events).unwrap();
            assert_eq!(events.found.len(), 1, "{end}: {:?}", events.found);
            assert!((events.found[0].time - end).abs() < 1e-14);
        }
    }
}
