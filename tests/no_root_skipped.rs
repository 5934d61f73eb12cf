//! No conjugate time is skipped, and the printed errors are bounds: 10 000 random starts of the spin problem, many of them
//! at the vertical tangents of `t1`, and 2000 on SO(3), many of them near the sphere, where conjugate times are nearly double.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]
#![expect(clippy::print_stdout, reason = "`cargo test -- --nocapture` shows what was measured")]

use polhode::geometry::rotation_group::attitude_route::first_conjugate_times_by_attitude;
use polhode::geometry::rotation_group::body_flow::BodyFlow;
use polhode::geometry::rotation_group::conjugate::first_conjugate_times;
use polhode::geometry::rotation_group::metric::Metric;
use polhode::geometry::spin::conjugate::{Arithmetic, conjugate_count, first_conjugate_point};
use polhode::geometry::spin::extremal::Extremal;
use polhode::geometry::spin::lift::first_conjugate_time_by_integration;
use polhode::geometry::spin::solve::{Quantity, solve};
use polhode::geometry::spin::start::Start;
use polhode::geometry::spin::switch_points::{Passage, switch_points};
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;
use polhode::numerics::taylor::dense::sample;
use polhode::numerics::taylor::flow::{Columns, Joined, WithColumns};
use polhode::numerics::taylor::integrator::Settings;
use std::f64::consts::PI;

const EPSILON: f64 = f64::EPSILON;
/// Request of the double-double runs: far below what they judge.
const REFERENCE: f64 = 1e-26;

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

/// Shows the largest and the median of what was measured; returns the median.
fn summary(what: &str, mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    println!("{what}: median {:.2e}, largest {:.2e}", values[values.len() / 2], values[values.len() - 1]);
    values[values.len() / 2]
}

const SPIN_STARTS: usize = 10_000;

/// `(k, p_θ)`: half anywhere, half at a crossing of the equator, from on it to a hundredth beside it.
fn spin_starts() -> Vec<(f64, f64)> {
    let mut random = Random(11);
    let mut starts: Vec<(f64, f64)> = Vec::new();
    while starts.len() < SPIN_STARTS / 2 {
        starts.push((random.between(0.3, 3.0), random.sign() * random.log_between(1e-6, 100.0)));
    }
    while starts.len() < SPIN_STARTS {
        let p_theta = random.log_between(1e-4, 5.0);
        for switch in switch_points(Passage::Equator, p_theta, 1.001, 3.0).unwrap() {
            for _ in 0..4 {
                let beside = 1.0 + random.sign() * random.log_between(1e-17, 1e-2);
                starts.push((switch.k * beside, random.sign() * p_theta));
            }
        }
    }
    starts.truncate(SPIN_STARTS);
    starts
}

fn spin_reference(k: f64, p_theta: f64) -> DoubleDouble {
    let extremal = Extremal::new(DoubleDouble::from_f64(k), DoubleDouble::from_f64(p_theta.abs()));
    solve(&extremal, Quantity::Phase, DoubleDouble::ONE).unwrap().t
}

/// Points that went on in double-double lie next to a triple root, where Θ − π is the cube of the distance: its rounding, 1e-31, hides 1e-10.
const CLEAR_OF_A_TRIPLE_ROOT: f64 = 1e-9;

/// `floor(Θ/π)` at `t (1 + beside)`, in double-double.
fn count_in_double_double(k: f64, p_theta: f64, t: f64, beside: f64) -> u32 {
    let extremal = Extremal::new(DoubleDouble::from_f64(k), DoubleDouble::from_f64(p_theta.abs()));
    let t = DoubleDouble::from_f64(t) * (DoubleDouble::ONE + DoubleDouble::from_f64(beside));
    let state = extremal.state_near(t);
    let phase = state.phase_beyond(DoubleDouble::ZERO) + (t - state.t) * state.phase_rate(&extremal);
    Real::floor(phase / DoubleDouble::PI).to_f64() as u32
}

#[test]
fn the_first_conjugate_time_of_the_spin_problem() {
    // Oracles: the phase Θ in double-double arithmetic (the same formulas, 32 digits); the count floor(Θ/π).
    let (mut ratios, mut errors) = (Vec::new(), Vec::new());
    for (k, p_theta) in spin_starts() {
        let start = Start::new(k, p_theta).unwrap();
        let point = first_conjugate_point(&start).unwrap();
        let reference = spin_reference(k, p_theta);
        let off = ((DoubleDouble::from_f64(point.t1) - reference) / reference).to_f64().abs();
        assert!(off <= point.error, "k = {k}, p_theta = {p_theta}: off by {off:e}, error {:e}", point.error);
        // The count has Θ's own rounding: t1 ± twice the error is clear of it, where both are in the same arithmetic.
        let count = |sign: f64| match point.arithmetic {
            Arithmetic::F64 => conjugate_count(&start, point.t1 * (1.0 + sign * 2.0 * point.error)).unwrap(),
            Arithmetic::DoubleDouble => count_in_double_double(k, p_theta, point.t1, sign * CLEAR_OF_A_TRIPLE_ROOT),
        };
        assert_eq!((count(-1.0), count(1.0)), (0, 1), "k = {k}, p_theta = {p_theta}: {point:?}");
        ratios.push(off / point.error);
        errors.push(point.error);
    }
    let typical = summary("spin: |t1 − reference| / error", ratios);
    // Honest bounds are not huge ones.
    assert!(typical > 0.01, "{typical}");
    summary("spin: error", errors);
}

/// How far rounding along an integration may move a conjugate time, as changes of the inputs: this many ε of each.
const ROUNDING_OF_AN_INTEGRATION: f64 = 60.0;

#[test]
fn the_engines_own_events_on_the_spin_lift() {
    // Oracle: the closed form. The first event of the lift is the first conjugate time: within the blur of the event, the
    // error of the closed form, and what changes of 60 ε in k or p_θ do to t1 (at a vertical tangent (60 ε)^(1/3): there the
    // event is a cluster, which counts as one root). In t1·(1 + 1/5) units of time there is one to be found.
    let mut ratios = Vec::new();
    for (k, p_theta) in spin_starts() {
        let point = first_conjugate_point(&Start::new(k, p_theta).unwrap()).unwrap();
        let (found, _) = first_conjugate_time_by_integration(k, p_theta, EPSILON, 1.2 * point.t1).unwrap();
        let moved = |(dk, dp): (f64, f64)| {
            let change = ROUNDING_OF_AN_INTEGRATION * EPSILON;
            let there = Start::new(k * (1.0 + change * dk), p_theta * (1.0 + change * dp)).unwrap();
            (first_conjugate_point(&there).unwrap().t1 - point.t1).abs()
        };
        let spread = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)].map(moved).into_iter().fold(0.0, f64::max);
        let (off, allowed) = ((found.t1 - point.t1).abs(), spread + found.blur + point.error * point.t1);
        assert!(off <= allowed, "k = {k}, p_theta = {p_theta}: {found:?} against {point:?}, spread {spread:e}");
        ratios.push(off / allowed);
    }
    summary("spin lift: |t1 − closed form| / allowed", ratios);
}

const BODIES: usize = 2000;

/// `[A, B, C]` and M: two in three anywhere, one in three spherical within 1e-8 to 1e-4.
fn bodies() -> Vec<([f64; 3], [f64; 3])> {
    let mut random = Random(12);
    let draw = |i: usize| {
        let spread = if i.is_multiple_of(3) { random.log_between(1e-8, 1e-4) } else { 1.0 };
        let a = random.between(0.4, 2.0);
        let b = a * (1.0 + spread * random.unit());
        let c = b * (1.0 + spread * random.unit());
        // Any order of the axes.
        let mut inertia = [a, b, c];
        inertia.rotate_left(i % 3);
        (inertia, [0; 3].map(|_| random.between(-1.0, 1.0)))
    };
    (0..BODIES).map(draw).collect()
}

type Vector = [f64; 3];

fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Samples up to a time, for a continuous sum of phases: the sum moves by less than a quarter turn from one to the next.
const SAMPLES: usize = 400;

/// The conjugate times up to each of the given times, counted by phases alone: no root is looked for.
///
/// With two columns ξⱼ, Qⱼ = δMⱼ − ½ M × ξⱼ across M and `a × b = M̂·(a × b)` of two vectors, Q/|M| + iX has the determinant
/// `D = (Q₁ + iξ₁) × (Q₂ + iξ₂)`, whose argument is the sum of the two phases, `Σ = θ₁ + θ₂`; and
/// `cos(θ₁ − θ₂) = (Q₁ × Q₂ + ξ₁ × ξ₂)/|D|`. Phases pass multiples of π upward only, from 0 at the start, so the count is
/// `⌊θ₁/π⌋ + ⌊θ₂/π⌋`, with Σ continuous.
fn counts_by_phases(inertia: Vector, momentum: Vector, times: &[f64]) -> Vec<i64> {
    let size = dot(&momentum, &momentum).sqrt();
    let omega = [0, 1, 2].map(|i| inertia[i] * momentum[i]);
    // Two variations across Ω that span the plane of those across Ω, oriented by M.
    let along = if omega[0].abs() < omega[1].abs() { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let first = cross(&omega, &along);
    let second = cross(&omega, &first);
    let scaled = |v: Vector| {
        let length = dot(&v, &v).sqrt();
        [v[0] / length * size, v[1] / length * size, v[2] / length * size, 0.0, 0.0, 0.0]
    };
    let system = WithColumns { flow: BodyFlow { inverse_inertia: inertia }, parameters: [(), ()] };
    let start = Joined { base: momentum, columns: Columns([scaled(first), scaled(second)]) };
    let end = times.iter().copied().fold(0.0, f64::max);
    let mut grid: Vec<f64> =
        (1..=SAMPLES).map(|i| end * i as f64 / SAMPLES as f64).chain(times.iter().copied()).collect();
    grid.sort_by(f64::total_cmp);
    let (states, _) = sample(&system, &start, 0.0, &grid, &Settings::new(EPSILON)).unwrap();
    let (mut sum, mut counts) = (0.0, vec![0; times.len()]);
    for (time, state) in grid.iter().zip(states) {
        let m = state.base;
        let across = |a: &Vector, b: &Vector| dot(&m, &cross(a, b)) / size;
        let [(x1, q1), (x2, q2)] = state.columns.0.map(|[p1, p2, p3, x1, x2, x3]| {
            let (xi, turned) = ([x1, x2, x3], cross(&m, &[x1, x2, x3]));
            (xi, [p1, p2, p3].iter().zip(turned).map(|(p, t)| (p - 0.5 * t) / size).collect::<Vec<f64>>())
        });
        let (q1, q2) = ([q1[0], q1[1], q1[2]], [q2[0], q2[1], q2[2]]);
        let (qq, xx) = (across(&q1, &q2), across(&x1, &x2));
        let (real, imaginary) = (qq - xx, across(&q1, &x2) + across(&x1, &q2));
        let principal = libm::atan2(imaginary, real);
        let moved = principal - sum - 2.0 * PI * ((principal - sum) / (2.0 * PI)).round();
        assert!(moved.abs() < 0.5 * PI, "{inertia:?} {momentum:?}: the sum of phases moves by {moved}");
        sum += moved;
        let difference = libm::acos(((qq + xx) / (real * real + imaginary * imaginary).sqrt()).clamp(-1.0, 1.0));
        let turns = |phase: f64| (phase / PI).floor() as i64;
        let count = turns(0.5 * (sum + difference)) + turns(0.5 * (sum - difference));
        for (of, value) in times.iter().zip(&mut counts) {
            if of == time {
                *value = count;
            }
        }
    }
    counts
}

#[test]
fn the_first_two_conjugate_times_on_the_rotation_group() {
    // Oracles: the same route in double-double arithmetic, the attitude route (other equations), the count by phases.
    let (mut ratios, mut errors, mut apart) = (Vec::new(), Vec::new(), 0);
    for (inertia, momentum) in bodies() {
        let metric = Metric::new(inertia[0], inertia[1], inertia[2]).unwrap();
        let found = first_conjugate_times(&metric, momentum, 2, EPSILON).unwrap();
        let [a, b, c] = inertia.map(DoubleDouble::from_f64);
        let long = Metric::new(a, b, c).unwrap();
        let reference = first_conjugate_times(&long, momentum.map(DoubleDouble::from_f64), 2, REFERENCE).unwrap();
        let attitude = first_conjugate_times_by_attitude(&metric, momentum, 2, EPSILON).unwrap();
        let what = format!("{inertia:?} {momentum:?}: {found:?}");
        for i in 0..2 {
            let exact = reference.times[i];
            let off = |t: f64| ((DoubleDouble::from_f64(t) - exact) / exact).to_f64().abs();
            assert!(off(found.times[i]) <= found.error, "{what}; reference {exact:?}");
            assert!(off(attitude.times[i]) <= attitude.error, "{what}; {attitude:?}; reference {exact:?}");
            ratios.push(off(found.times[i]) / found.error);
        }
        errors.push(found.error);
        let [t1, t2] = [found.times[0], found.times[1]];
        // Phases near zero are good to 1e-8 by their cosine: a margin of 1e-6 is clear of that.
        const MARGIN: f64 = 1e-6;
        let counts = |first: f64, second: f64| counts_by_phases(inertia, momentum, &[t1 * first, t2 * second]);
        assert_eq!(counts(1.0 - MARGIN, 1.0 + MARGIN), [0, 2], "{what}");
        if t2 - t1 > 4.0 * MARGIN * t2 {
            apart += 1;
            assert_eq!(counts(1.0 + MARGIN, 1.0 - MARGIN), [1, 1], "{what}");
        }
    }
    // Both kinds were there: pairs that are apart, and pairs that are nearly double.
    assert!((1000..1900).contains(&apart), "{apart}");
    summary("rotation group: |t − reference| / error", ratios);
    summary("rotation group: error", errors);
}
