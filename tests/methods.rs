//! One flow, three methods: power series, DOP853 and Verner 9(8) on the article's flows, columns and events included.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use polhode::geometry::serret_andoyer::flow::{SerretAndoyerFlow, first_conjugate_time_by_integration};
use polhode::geometry::spin::lift::{SpinLift, conjugate_times_by_integration};
use polhode::numerics::counts::Work;
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;
use polhode::numerics::runge_kutta::dop853::Dop853;
use polhode::numerics::runge_kutta::integrator::integrate_in_equal_steps;
use polhode::numerics::runge_kutta::method::{Method, PowerSeries};
use polhode::numerics::runge_kutta::rate::ByCoefficients;
use polhode::numerics::runge_kutta::tableau::Pair;
use polhode::numerics::runge_kutta::verner98::Verner98;
use polhode::numerics::taylor::events::{Component, EventFunction, EventSeries, Events};
use polhode::numerics::taylor::flow::{Columns, Joined, WithColumns, product};
use polhode::numerics::taylor::integrator::{Observer, Settings, Step};
use polhode::numerics::taylor::step::{Jet, absolute_sum, horner_increment};
use std::ops::ControlFlow;

type Lifted = WithColumns<SpinLift<f64>, (), 1>;
type LiftedState = Joined<[f64; 6], Columns<[f64; 3], 1>>;

/// `J = −r·δh`, whose zeros are the conjugate times of the spin problem.
struct ConjugateScalar;
impl EventFunction<f64, Lifted> for ConjugateScalar {
    const DEGREE: usize = 2;
    fn series(&self, jet: &Jet<f64, Lifted>, last: usize, out: &mut EventSeries<f64>) {
        let (r, column) = (&jet.state.base, &jet.state.columns.0[0]);
        let term = |i: usize, n| product(&r[i][..=jet.order()], &column[i][..=jet.order()], n);
        for (n, coefficient) in out.iter_mut().enumerate().take(last + 1) {
            *coefficient = -(term(0, n) + term(1, n) + term(2, n));
        }
    }
    fn magnitude(&self, jet: &Jet<f64, Lifted>, length: f64) -> f64 {
        let (r, column) = (&jet.state.base, &jet.state.columns.0[0]);
        let bound = |series| absolute_sum(series, jet.order(), length);
        (0..3).map(|i| bound(&r[i]) * bound(&column[i])).sum()
    }
}

fn spin(k: f64, p_theta: f64) -> (Lifted, LiftedState) {
    let system = WithColumns { flow: SpinLift::new(k), parameters: [()] };
    let base = [1.0, 0.0, 0.0, 0.0, -p_theta, 2.0];
    (system, Joined { base, columns: Columns([[0.0, -1.0, 0.0]]) })
}

/// The first conjugate times of the spin problem up to `end`, and the work.
fn spin_times<M: Method>(method: M, k: f64, p_theta: f64, end: f64, wanted: usize, tolerance: f64) -> (Vec<f64>, Work) {
    let (system, start) = spin(k, p_theta);
    let mut events = Events::first(wanted, ConjugateScalar).vanishing_at_start(3);
    let arrival = method.integrate(&system, &start, (0.0, end), &Settings::new(tolerance), &mut events).unwrap();
    (events.found.iter().map(|root| root.time).collect(), arrival.work)
}

/// `v` turned about `axis` (of length 1) by `angle`.
fn turned(v: [f64; 3], axis: [f64; 3], angle: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(angle);
    let along = (0..3).map(|i| axis[i] * v[i]).sum::<f64>() * (1.0 - cosine);
    let across = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2], axis[0] * v[1] - axis[1] * v[0]];
    std::array::from_fn(|i| cosine * v[i] + sine * across[i] + along * axis[i])
}

/// Oracle: the lift at k = 1, where `ω = (h − h2 e2)/2`. In the frame that turns about e2 at the rate −h2/2, h is constant
/// and r turns about it at the rate |h|/2: two rotations.
fn round_sphere(p_theta: f64, t: f64) -> [f64; 6] {
    let (h, e2) = ([0.0, -p_theta, 2.0], [0.0, 1.0, 0.0]);
    let length = (p_theta * p_theta + 4.0).sqrt();
    let about_e2 = p_theta * t / 2.0;
    let r = turned(turned([1.0, 0.0, 0.0], h.map(|x| x / length), length * t / 2.0), e2, about_e2);
    let h = turned(h, e2, about_e2);
    [r[0], r[1], r[2], h[0], h[1], h[2]]
}

fn largest_difference(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// Largest error against two rotations, inside the steps and at their ends.
struct Rotations {
    p_theta: f64,
    inside: f64,
    ends: f64,
}
impl Observer<f64, SpinLift<f64>> for Rotations {
    fn observe(&mut self, step: &Step<'_, f64, SpinLift<f64>>, _: &mut Work) -> ControlFlow<()> {
        let at = |offset| largest_difference(&step.state(offset), &round_sphere(self.p_theta, step.time(offset)));
        self.inside = (1..10).map(|i| at(step.length * f64::from(i) / 10.0)).fold(self.inside, f64::max);
        self.ends = self.ends.max(at(step.length));
        ControlFlow::Continue(())
    }
}

fn errors_on_the_round_sphere<P: Pair>(pair: P, steps: u64) -> [f64; 2] {
    let (system, start) = spin(1.0, 0.7);
    let mut errors = Rotations { p_theta: 0.7, inside: 0.0, ends: 0.0 };
    let flow = ByCoefficients(&system.flow);
    integrate_in_equal_steps(pair, &flow, &start.base, (0.0, 10.0), steps, &mut errors).unwrap();
    [errors.inside, errors.ends]
}

fn series_error_on_the_round_sphere(order: usize, steps: u64) -> f64 {
    let (system, start) = spin(1.0, 0.7);
    let mut jet = Jet::<f64, SpinLift<f64>>::new(order);
    let (mut state, length) = (start.base, 10.0 / steps as f64);
    let mut worst = 0.0_f64;
    for step in 1..=steps {
        jet.expand(&system.flow, &state);
        for (x, series) in state.iter_mut().zip(&jet.state) {
            *x += horner_increment(series, order, length);
        }
        worst = worst.max(largest_difference(&state, &round_sphere(0.7, step as f64 * length)));
    }
    worst
}

fn halving(error: impl Fn(u64) -> f64, steps: u64) -> f64 {
    libm::log2(error(steps) / error(2 * steps))
}

#[test]
fn orders_on_the_round_sphere() {
    // Global orders from halving equal steps over t = 10, where errors lie between 1e-6 and 1e-13: the first term of the
    // error leads, and rounding (1e-15) does not. Inside the steps DOP853's interpolant, of order 7, errs by h^8 too.
    for which in [0, 1] {
        let seen = halving(|n| errors_on_the_round_sphere(Dop853, n)[which], 20);
        assert!((seen - 8.0).abs() < 0.3, "DOP853: {seen}");
    }
    // The first term of Verner's pair is so small that the second shows until rounding takes over: the order seen is 9 plus
    // a part that halves with h. Extrapolated to h = 0 it is 9. (One interpolated step and problems without second term
    // stand beside the pair.)
    let seen = |steps| halving(|n| errors_on_the_round_sphere(Verner98, n)[1], steps);
    let (coarse, fine) = (seen(10), seen(20));
    assert!(coarse > fine && fine > 9.0, "Verner: {coarse} {fine}");
    assert!((2.0 * fine - coarse - 9.0).abs() < 0.3, "Verner: {coarse} {fine}");
    for (order, steps) in [(5, 40), (8, 20), (12, 15)] {
        let seen = halving(|n| series_error_on_the_round_sphere(order, n), steps);
        assert!((seen - order as f64).abs() < 0.3, "power series of order {order}: {seen}");
    }
}

#[test]
fn exact_conjugate_times_of_the_round_sphere() {
    // k = 1: t1 = 8.986818915818128/√(p_θ² + 4) (first root of tan s = s, doubled).
    for p_theta in [0.0, 0.1, 1.0, 3.0, 20.0] {
        let exact = 8.986818915818128 / (p_theta * p_theta + 4.0_f64).sqrt();
        for tolerance in [1e-5, 1e-8, 1e-11, 1e-14] {
            let times = [
                spin_times(PowerSeries, 1.0, p_theta, 100.0, 1, tolerance).0,
                spin_times(Dop853, 1.0, p_theta, 100.0, 1, tolerance).0,
                spin_times(Verner98, 1.0, p_theta, 100.0, 1, tolerance).0,
            ];
            for time in times {
                let error = (time[0] / exact - 1.0).abs();
                assert!(error < 3.0 * tolerance, "{p_theta} {tolerance}: {error}");
            }
        }
    }
}

#[test]
fn a_longer_scalar_runs_and_is_as_accurate_as_the_coefficients() {
    // Coefficients are f64: errors of some 1e-16 a step, whatever is asked, in some hundred steps.
    fn run<P: Pair>(pair: P, tolerance: f64) -> f64 {
        let flow = SpinLift::new(DoubleDouble::ONE);
        let start = [1.0, 0.0, 0.0, 0.0, -0.7, 2.0].map(DoubleDouble::from_f64);
        let span = (DoubleDouble::ZERO, DoubleDouble::from_f64(10.0));
        let end = pair.integrate(&flow, &start, span, &Settings::new(tolerance), &mut ()).unwrap();
        largest_difference(&end.state.map(Real::to_f64), &round_sphere(0.7, 10.0))
    }
    for error in [run(Dop853, 1e-14), run(Verner98, 1e-14), run(Verner98, 1e-16)] {
        assert!(error < 1e-13, "{error}");
    }
}

/// A small generator (SplitMix64): the same numbers in every run.
struct Random(u64);
impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        low + (high - low) * (((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64)
    }
}

/// Largest error of the first two spin conjugate times, in units of the tolerance, over random starts.
fn spin_events_agree<M: Method>(method: M, tolerance: f64) -> f64 {
    let (mut random, mut worst) = (Random(7), 0.0_f64);
    for _ in 0..200 {
        let (k, p_theta) = (random.between(0.6, 2.0), libm::exp(random.between(-3.0, 3.0)));
        let reference = conjugate_times_by_integration(k, p_theta, f64::EPSILON, 200.0, 2).unwrap().0;
        let (times, work) = spin_times(method, k, p_theta, 200.0, 2, tolerance);
        assert_eq!(times.len(), reference.len(), "{}: {k} {p_theta}: {times:?}", M::NAME);
        for (time, exact) in times.iter().zip(&reference) {
            worst = worst.max((time / exact.t1 - 1.0).abs() / tolerance);
        }
        assert_eq!((work.state_dimension, work.tangent_evaluations), (9, work.flow_evaluations), "{}", M::NAME);
        assert_eq!(work.event_evaluations, work.steps, "{}", M::NAME);
    }
    worst
}

/// As [`spin_events_agree`], for the Serret-Andoyer problem.
fn serret_andoyer_events_agree<M: Method>(method: M, tolerance: f64) -> f64 {
    let (mut random, mut worst) = (Random(8), 0.0_f64);
    for _ in 0..200 {
        let a = random.between(0.5, 2.0);
        let b = a * random.between(1.1, 2.0);
        let c = b * random.between(1.1, 2.0);
        let (y0, p_x) = (random.between(0.4, 2.7), random.between(0.4, 2.0));
        let p_y = 0.3 * p_x * random.between(-1.0, 1.0);
        let Ok(reference) = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, 100.0, f64::EPSILON) else {
            continue;
        };
        let (flow, base) = SerretAndoyerFlow::new([a, b, c], y0, p_x, p_y);
        let (column, parameter) = flow.column(&base);
        let system = WithColumns { flow, parameters: [parameter] };
        let start = Joined { base, columns: Columns([column]) };
        let mut events = Events::first(1, Component(5)).vanishing_at_start(1);
        let settings = Settings::new(tolerance);
        let arrival = method.integrate(&system, &start, (0.0, 101.0), &settings, &mut events).unwrap();
        assert_eq!(events.found.len(), 1, "{}: {a} {b} {c} {y0} {p_x} {p_y}", M::NAME);
        worst = worst.max((events.found[0].time / reference.t1 - 1.0).abs() / tolerance);
        assert_eq!((arrival.stopped, arrival.work.state_dimension), (true, 7), "{}", M::NAME);
    }
    worst
}

#[test]
fn events_of_all_methods_agree() {
    // Errors of the steps add up over some units of time and are divided by the function's slope: up to twice the tolerance
    // for DOP853, half of it and less for the others; ten times it is allowed.
    for tolerance in [1e-6, 1e-9, 1e-12] {
        for worst in [
            spin_events_agree(Dop853, tolerance),
            spin_events_agree(Verner98, tolerance),
            spin_events_agree(PowerSeries, tolerance),
            serret_andoyer_events_agree(Dop853, tolerance),
            serret_andoyer_events_agree(Verner98, tolerance),
            serret_andoyer_events_agree(PowerSeries, tolerance),
        ] {
            assert!(worst < 10.0, "{tolerance}: {worst} times the tolerance");
        }
    }
}
