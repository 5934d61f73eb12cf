//! What the power-series engine is asked for, and what it delivers.
//!
//! Oracle: the same engine in double-double arithmetic at [`REFERENCE`], whose own error is measured against a still
//! tighter request. 1000 random starts of each of three flows with their tangent columns: the spin lift (k in [0.3, 3],
//! p_θ log-uniform in ±[1e-2, 30], up to the first conjugate time), the Serret-Andoyer flow and the body flow on SO(3)
//! (random moments of inertia and directions, 2 to 6 units of time).
//!
//! The error is the largest over the components of the final state, columns included, in units of the flow's own scales
//! there (`Flow::scales`): the norm in which the request is posed.
//!
//! *Growth of the flow*: the norm of the tangent map of the whole system (base flow and columns) in the same scales, from the
//! start, the middle and three quarters of the span to its end, by differences of one part in 1e7: what multiplies an
//! error that is made there. Good to a few digits.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]
#![expect(clippy::print_stdout, reason = "`cargo test -- --nocapture` shows what was measured")]

use polhode::geometry::rotation_group::body_flow::BodyFlow;
use polhode::geometry::serret_andoyer::flow::SerretAndoyerFlow;
use polhode::geometry::spin::conjugate::first_conjugate_point;
use polhode::geometry::spin::lift::SpinLift;
use polhode::geometry::spin::start::Start;
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;
use polhode::numerics::taylor::flow::{Elements, Flow, WithColumns};
use polhode::numerics::taylor::integrator::{Settings, integrate};
use polhode::numerics::taylor::step::order_for;
use std::f64::consts::TAU;

const STARTS: usize = 1000;
/// When this variable is set all starts are run in double-double arithmetic too, not every fifth: a minute instead of 15 s.
const ALL_STARTS: &str = "POLHODE_ALL_STARTS";
/// Request of the reference runs; a thousand times below the tightest request that is judged by them.
const REFERENCE: f64 = 1e-31;
/// The bounds: largest error and median error, in requests.
const MOST: f64 = 30.0;
const MEDIAN_AT_LEAST: f64 = 1e-3;

/// SplitMix64: every run draws the same starts.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
    fn log_between(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }
    fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }
}

/// A flow with columns over any scalar, a start and a span; the start is exact in both scalars.
trait Problem: Sized {
    type System<S: Real>: Flow<S>;
    fn draw(random: &mut Random) -> Self;
    fn system<S: Real>(&self) -> Self::System<S>;
    fn start(&self) -> Vec<f64>;
    fn span(&self) -> f64;
}

struct Spin {
    k: f64,
    p_theta: f64,
    t1: f64,
}

impl Problem for Spin {
    type System<S: Real> = WithColumns<SpinLift<S>, (), 1>;
    fn draw(random: &mut Random) -> Self {
        let (k, p_theta) = (random.log_between(0.3, 3.0), random.sign() * random.log_between(1e-2, 30.0));
        Spin { k, p_theta, t1: first_conjugate_point(&Start::new(k, p_theta).unwrap()).unwrap().t1 }
    }
    fn system<S: Real>(&self) -> Self::System<S> {
        WithColumns { flow: SpinLift::new(S::from_f64(self.k)), parameters: [()] }
    }
    fn start(&self) -> Vec<f64> {
        vec![1.0, 0.0, 0.0, 0.0, -self.p_theta, 2.0, 0.0, -1.0, 0.0]
    }
    fn span(&self) -> f64 {
        self.t1
    }
}

struct SerretAndoyer {
    flow: SerretAndoyerFlow<f64>,
    base: [f64; 5],
    span: f64,
}

fn random_inertia(random: &mut Random) -> [f64; 3] {
    let a = random.between(0.5, 2.0);
    let b = a + random.between(0.1, 2.0);
    [a, b, b + random.between(0.1, 2.0)]
}

impl SerretAndoyer {
    fn flow<S: Real>(&self) -> SerretAndoyerFlow<S> {
        let SerretAndoyerFlow { inverse_inertia, p_x, alpha, beta } = self.flow;
        SerretAndoyerFlow {
            inverse_inertia: inverse_inertia.map(S::from_f64),
            p_x: S::from_f64(p_x),
            alpha: S::from_f64(alpha),
            beta: S::from_f64(beta),
        }
    }
}

impl Problem for SerretAndoyer {
    type System<S: Real> = WithColumns<SerretAndoyerFlow<S>, S, 1>;
    fn draw(random: &mut Random) -> Self {
        let inverse_inertia = random_inertia(random);
        let (p_y, p_x) = libm::sincos(random.between(0.0, TAU));
        let (flow, base) = SerretAndoyerFlow::new(inverse_inertia, random.between(0.0, TAU), p_x, p_y);
        SerretAndoyer { flow, base, span: random.between(2.0, 6.0) }
    }
    fn system<S: Real>(&self) -> Self::System<S> {
        let (_, parameter) = self.flow.column(&self.base);
        WithColumns { flow: self.flow(), parameters: [S::from_f64(parameter)] }
    }
    fn start(&self) -> Vec<f64> {
        self.base.into_iter().chain(self.flow.column(&self.base).0).collect()
    }
    fn span(&self) -> f64 {
        self.span
    }
}

struct Body {
    inverse_inertia: [f64; 3],
    start: Vec<f64>,
    span: f64,
}

impl Problem for Body {
    type System<S: Real> = WithColumns<BodyFlow<S>, (), 2>;
    fn draw(random: &mut Random) -> Self {
        let inverse_inertia = random_inertia(random);
        let mut vector = || [random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
        let (m, first, second) = (vector(), vector(), vector());
        let start = [m, first, [0.0; 3], second, [0.0; 3]].concat();
        Body { inverse_inertia, start, span: random.between(2.0, 6.0) }
    }
    fn system<S: Real>(&self) -> Self::System<S> {
        WithColumns { flow: BodyFlow { inverse_inertia: self.inverse_inertia.map(S::from_f64) }, parameters: [(), ()] }
    }
    fn start(&self) -> Vec<f64> {
        self.start.clone()
    }
    fn span(&self) -> f64 {
        self.span
    }
}

type State<P, S> = <<P as Problem>::System<S> as Flow<S>>::State<S>;

fn state_of<P: Problem, S: Real>(numbers: &[f64]) -> State<P, S> {
    let mut state = State::<P, S>::filled(S::ZERO);
    for (i, &x) in numbers.iter().enumerate() {
        *state.get_mut(i) = S::from_f64(x);
    }
    state
}

/// The final state, and the work: `p²` for each step.
fn run<P: Problem, S: Real>(problem: &P, start: &State<P, S>, span: f64, tolerance: f64) -> (State<P, S>, f64) {
    let span = (S::ZERO, S::from_f64(span));
    let end = integrate(&problem.system::<S>(), start, span, &Settings::new(tolerance), &mut ()).unwrap();
    (end.state, end.work.flow_evaluations as f64 * order_for(tolerance.max(S::EPSILON.to_f64())) as f64)
}

/// The largest difference of a component to the reference, in the flow's scales there.
fn distance<P: Problem, S: Real>(problem: &P, found: &State<P, S>, reference: &State<P, S>) -> f64 {
    let scales = problem.system::<S>().scales(reference);
    let of = |i| ((*found.get(i) - *reference.get(i)) / *scales.get(i)).abs().to_f64();
    (0..problem.start().len()).map(of).fold(0.0, f64::max)
}

/// See the module page.
fn growth<P: Problem>(problem: &P) -> f64 {
    const DIFFERENCE: f64 = 1e-7;
    let mut largest = 1.0_f64;
    for part in [1.0, 0.5, 0.25] {
        let to_here = problem.span() * (1.0 - part);
        let here = run::<P, f64>(problem, &state_of::<P, f64>(&problem.start()), to_here, f64::EPSILON).0;
        let to_end = |state| run::<P, f64>(problem, &state, problem.span() * part, f64::EPSILON).0;
        let (end, scales) = (to_end(here), problem.system::<f64>().scales(&here));
        for i in 0..problem.start().len() {
            let mut moved = here;
            *moved.get_mut(i) += DIFFERENCE * *scales.get(i);
            largest = largest.max(distance::<P, f64>(problem, &to_end(moved), &end) / DIFFERENCE);
        }
    }
    largest
}

struct Judged<P: Problem> {
    problem: P,
    growth: f64,
    reference: State<P, DoubleDouble>,
}

fn judged<P: Problem>(seed: u64) -> Vec<Judged<P>> {
    let mut random = Random(seed);
    let judge = |problem: P| {
        let start = state_of::<P, DoubleDouble>(&problem.start());
        let reference = run::<P, DoubleDouble>(&problem, &start, problem.span(), REFERENCE).0;
        Judged { growth: growth(&problem), reference, problem }
    };
    (0..STARTS).map(|_| judge(P::draw(&mut random))).collect()
}

/// Error and work of one start.
fn outcome<P: Problem, S: Real>(start: &Judged<P>, tolerance: f64) -> (f64, f64) {
    let (problem, begin) = (&start.problem, state_of::<P, S>(&start.problem.start()));
    let (end, work) = run::<P, S>(problem, &begin, problem.span(), tolerance);
    let mut found = State::<P, DoubleDouble>::filled(DoubleDouble::ZERO);
    for i in 0..problem.start().len() {
        let (high, low) = (end.get(i).to_f64(), *end.get(i) - S::from_f64(end.get(i).to_f64()));
        *found.get_mut(i) = DoubleDouble::from_sum(high, low.to_f64());
    }
    (distance::<P, DoubleDouble>(problem, &found, &start.reference), work / problem.span())
}

fn check<P: Problem, S: Real>(name: &str, starts: &[&Judged<P>], tolerances: impl Iterator<Item = f64>) {
    let mut last_work = 0.0;
    for tolerance in tolerances {
        let outcomes: Vec<(f64, f64)> = starts.iter().map(|start| outcome::<P, S>(start, tolerance)).collect();
        for ((error, _), start) in outcomes.iter().zip(starts) {
            let allowed = MOST * tolerance.max(S::EPSILON.to_f64() * start.growth);
            assert!(*error <= allowed, "{name} at {tolerance:e}: {error:e}, growth {}", start.growth);
        }
        let mut errors: Vec<f64> = outcomes.iter().map(|(error, _)| *error).collect();
        errors.sort_by(f64::total_cmp);
        let median = errors[errors.len() / 2];
        let work = outcomes.iter().map(|(_, work)| *work).sum::<f64>();
        let worst = outcomes.iter().zip(starts).max_by(|a, b| a.0.0.total_cmp(&b.0.0)).unwrap();
        println!(
            "{name} {tolerance:.0e}: median {:.3} requests; largest {:.1}, where the growth is {:.0}; work {work:.0}",
            median / tolerance,
            worst.0.0 / tolerance,
            worst.1.growth
        );
        assert!(median >= MEDIAN_AT_LEAST * tolerance, "{name} at {tolerance:e}: median {median:e}");
        // A looser request costs less (in order of tightening requests here).
        assert!(work > last_work, "{name} at {tolerance:e}: {work} after {last_work}");
        last_work = work;
    }
}

/// Requests from 1e-3 to 1e-15, and on to 1e-28 in double-double arithmetic.
fn check_all<P: Problem>(name: &str, seed: u64) {
    let starts = judged::<P>(seed);
    // The reference against the tightest request there is: far below what it judges.
    for start in starts.iter().step_by(20) {
        let (error, _) = outcome::<P, DoubleDouble>(start, DoubleDouble::EPSILON.to_f64());
        assert!(error <= REFERENCE * MOST.max(start.growth), "{name}: {error:e}, growth {}", start.growth);
    }
    let powers = |from: i32, to: i32, step| (from..=to).step_by(step).map(|n| libm::pow(10.0, f64::from(-n)));
    let all: Vec<&Judged<P>> = starts.iter().collect();
    check::<P, f64>(name, &all, powers(3, 15, 1));
    let sample: Vec<&Judged<P>> =
        starts.iter().step_by(if std::env::var_os(ALL_STARTS).is_some() { 1 } else { 5 }).collect();
    check::<P, DoubleDouble>(&format!("{name}, double-double"), &sample, powers(4, 28, 4));
}

#[test]
fn spin_lift() {
    check_all::<Spin>("spin", 1);
}

#[test]
fn serret_andoyer_flow() {
    check_all::<SerretAndoyer>("Serret-Andoyer", 2);
}

#[test]
fn body_flow() {
    check_all::<Body>("body", 3);
}
