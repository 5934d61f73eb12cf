//! Random points on SO(3): A, B, C in any order from equal to four orders of magnitude apart, momenta near every axis and near the
//! separating polhode, Euler angles near their poles, each distance to a limit log-uniform, alone and together.
//!
//! Oracle: the closed form in double-double (where it does not reach, the integration in double-double) on the inputs as given. A
//! part of the points is integrated in double-double as well, which shares no formula with the closed form; a few once more by the attitude.

#![expect(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

use super::{Random, count};
use polhode::effects::point::{Answer, Given, Inputs, Metric as Asked, PointError, answer};
use polhode::geometry::rotation_group::attitude_route::first_conjugate_times_by_attitude;
use polhode::geometry::rotation_group::conjugate::first_conjugate_times;
use polhode::geometry::rotation_group::euler_angles::EulerPoint;
use polhode::geometry::rotation_group::first_two::first_two_conjugate_times_to_reference;
use polhode::geometry::rotation_group::metric::Metric;
use polhode::geometry::rotation_group::polhode_curve::Start;
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;
use std::collections::BTreeMap;

/// The relative gap between two neighbours of A, B, C.
fn gap(random: &mut Random) -> f64 {
    match random.below(6) {
        0 => 0.0,
        1 | 2 => random.log(1e-14, 1.0),
        3 => random.log(1e-2, 1.0),
        4 => random.unit(),
        _ => random.log(1.0, 100.0),
    }
}

fn inertia(random: &mut Random) -> [f64; 3] {
    let a = random.log(1e-3, 1e3);
    let b = a * (1.0 + gap(random));
    let mut values = [a, b, b * (1.0 + gap(random))];
    for i in [2, 1] {
        let j = random.below(i + 1);
        values.swap(i, j);
    }
    values
}

/// A direction: anywhere, near an axis, on it, near the separating polhode.
fn direction(random: &mut Random, inertia: [f64; 3]) -> [f64; 3] {
    let anywhere = [0; 3].map(|_| 2.0 * random.unit() - 1.0);
    match random.below(8) {
        0 | 1 => anywhere,
        2 => {
            let mut axis = [0.0; 3];
            axis[random.below(3)] = random.sign();
            axis
        }
        3..=5 => {
            let (axis, common, alike) = (random.below(3), random.log(1e-15, 1.0), random.unit() < 0.5);
            [0, 1, 2].map(|i| {
                let off = if alike { common } else { random.log(1e-15, 1.0) } * (0.3 + random.unit());
                random.sign() * if i == axis { 1.0 } else { off }
            })
        }
        _ => {
            let mut order = [0, 1, 2];
            order.sort_by(|i, j| inertia[*i].total_cmp(&inertia[*j]));
            let [first, middle, third] = order;
            let (low, high) = (inertia[middle] - inertia[first], inertia[third] - inertia[middle]);
            let across = 2.0 * random.unit() - 1.0;
            let mut there = anywhere;
            if low > 0.0 && high > 0.0 {
                there[first] = across * (high / (low + high)).sqrt();
                there[third] = random.sign() * across * (low / (low + high)).sqrt();
                there[third] *= 1.0 + random.sign() * random.log(1e-16, 1.0);
                there[middle] = random.sign() * (1.0 - across * across).sqrt();
            }
            there
        }
    }
}

/// A point, as keys and as the start that the oracle takes; none where there is no start.
fn draw(random: &mut Random) -> (Inputs, Option<Start>, [f64; 3], Option<[f64; 3]>) {
    let inertia = inertia(random);
    let metric = Metric::new(inertia[0], inertia[1], inertia[2]).unwrap();
    let size = random.log(1e-6, 1e6);
    let number = |(key, x): (&str, f64)| (key.to_owned(), Given::Number(x));
    let [a, b, c] = inertia;
    let mut given = Inputs::from([("A", a), ("B", b), ("C", c)].map(number));
    if random.below(4) > 0 {
        let momentum = direction(random, inertia).map(|x| x * size);
        let [x, y, z] = momentum;
        given.extend([("H1", x), ("H2", y), ("H3", z)].map(number));
        return (given, Start::new(&metric, momentum).ok(), inertia, Some(momentum));
    }
    let phi2 = match random.below(4) {
        0 => 0.0,
        1 => random.sign() * random.log(1e-15, 1.0),
        2 => std::f64::consts::PI - random.log(1e-16, 1.0),
        _ => 6.0 * random.unit() - 3.0,
    };
    let (phi3, p2) = (6.0 * random.unit() - 3.0, size * (2.0 * random.unit() - 1.0));
    let p3 = size * (2.0 * random.unit() - 1.0);
    let p1 = match random.below(4) {
        0 => p3,
        1 => -p3,
        2 => p3 * libm::cos(phi2) + size * random.unit() * libm::sin(phi2),
        _ => p3 * (1.0 + random.log(1e-15, 1.0)),
    };
    given.extend([("Phi2", phi2), ("Phi3", phi3), ("p1", p1), ("p2", p2), ("p3", p3)].map(number));
    let point = EulerPoint { angles: [0.0, phi2, phi3], momenta: [p1, p2, p3] };
    (given, Start::from_euler(&metric, &point).ok(), inertia, None)
}

/// `[t1, t2]` and the error; nothing where none was given. Anything but finite numbers in order is a failure.
fn times(given: &Inputs, result: Result<Answer, PointError>) -> Option<([f64; 2], f64, Answer)> {
    match result {
        Ok(answer) => {
            let [Some(t1), Some(t2)] = answer.numbers[..] else { panic!("{given:?}: {answer:?}") };
            let error = answer.error.unwrap_or(f64::NAN);
            assert!(t1 > 0.0 && t1 <= t2 && t2.is_finite() && error > 0.0 && error < 1e-2, "{given:?}: {answer:?}");
            Some(([t1, t2], error, answer))
        }
        Err(PointError::Refused(reason)) => {
            assert!(reason.len() > 20 && !reason.contains("NaN"), "{given:?}: {reason}");
            None
        }
        Err(other) => panic!("{given:?}: {other}"),
    }
}

fn long(x: f64) -> DoubleDouble {
    <DoubleDouble as Real>::from_f64(x)
}

#[test]
fn errors_are_honest_at_random_points() {
    let count = count(600);
    let mut random = Random(20_140_215);
    let (mut refused, mut impossible, mut violated, mut loose) = (0, 0, Vec::new(), 0);
    let (mut ratios, mut worst, mut integrated, mut routes) = (Vec::new(), (0.0, String::new()), 0, BTreeMap::new());
    for index in 0..count {
        let (given, start, inertia, momentum) = draw(&mut random);
        let found = times(&given, answer(Asked::RotationGroup, &given, 1e-14));
        let Some(start) = start else {
            assert!(found.is_none(), "{given:?}");
            impossible += 1;
            continue;
        };
        let Some((found, claimed, answer)) = found else {
            refused += 1;
            continue;
        };
        *routes.entry(answer.route).or_insert(0) += 1;
        let exact = first_two_conjugate_times_to_reference(&start).unwrap();
        if exact.error > 1e-18 {
            // No oracle: the answer then says as much.
            assert!(claimed >= exact.error, "{given:?}");
            loose += 1;
            continue;
        }
        let exact = [0, 1].map(|i| DoubleDouble::from_sum(exact.times[i], exact.rests[i]));
        let off = |t: DoubleDouble, i: usize| ((t - exact[i]) / exact[i]).to_f64().abs();
        let error = off(long(found[0]), 0).max(off(long(found[1]), 1));
        if error > claimed {
            violated.push(format!("{given:?}: {error:e} > {claimed:e}"));
        }
        ratios.push(claimed / error.max(0.5 * f64::EPSILON));
        // The condition number is 1/3 at least.
        let relative = error / (4.0 / 3.0 * f64::EPSILON);
        if relative > worst.0 {
            worst = (relative, format!("{given:?}"));
        }
        let slow = |inertia: [f64; 3]| {
            inertia.iter().fold(0.0, |x: f64, y| x.max(*y))
                > 20.0 * inertia.iter().fold(f64::INFINITY, |x, y| x.min(*y))
        };
        if let (0, Some(momentum), false) = (index % 40, momentum, slow(inertia)) {
            // In units near one (powers of two, exact): coefficients of order 39 underflow in others.
            let unit = |values: [f64; 3]| {
                libm::ldexp(1.0, -libm::ilogb(values.iter().fold(0.0, |most: f64, x| most.max(x.abs()))))
            };
            let (by, by_momentum) = (unit(inertia), unit(momentum));
            let [a, b, c] = inertia.map(|x| long(x * by));
            let metric = Metric::new(a, b, c).unwrap();
            let momentum_here = momentum.map(|m| long(m * by_momentum));
            let by_integration = first_conjugate_times(&metric, momentum_here, 2, 1e-30).unwrap();
            for i in 0..2 {
                let apart = off(by_integration.times[i] * long(by) * long(by_momentum), i);
                assert!(apart < 1e-18 + by_integration.error, "{given:?}: {apart:e}, {by_integration:?}");
            }
            if integrated % 8 == 0 {
                let metric = Metric::new(inertia[0], inertia[1], inertia[2]).unwrap();
                let third = first_conjugate_times_by_attitude(&metric, momentum, 2, f64::EPSILON).unwrap();
                assert!((0..2).all(|i| off(long(third.times[i]), i) <= third.error + 40.0 * f64::EPSILON), "{given:?}");
            }
            integrated += 1;
        }
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    println!(
        "{count} points: {impossible} impossible, {refused} refused, {} answered; {loose} without oracle, {integrated} integrated; \
         {} violations, claimed/true median {median:.1}, largest {:.1}; worst error {:.2} in units of eps (condition + 1): {}",
        ratios.len() + loose,
        violated.len(),
        ratios[ratios.len() - 1],
        worst.0,
        worst.1
    );
    println!("{routes:?}");
    assert!(violated.len() * 1000 <= ratios.len(), "{violated:#?}");
    assert!(median <= 100.0 && worst.0 <= 20.0, "{median} {worst:?}");
    assert!(
        refused * 50 <= count && loose * 50 <= count && integrated * 200 >= count,
        "{refused} {loose} {integrated}"
    );
}

fn given(text: &str) -> Inputs {
    text.split_whitespace()
        .map(|pair| {
            let (key, value) = pair.split_once('=').unwrap();
            (key.to_owned(), Given::parse(value))
        })
        .collect()
}

/// Exact limits. Oracles: the sphere, `2π/(A|M|)` twice; a body with A = B: `2π/(A|M|)`, and x = A|M|t/2 with `tan x = −(r/k) x`, `k = 2H/|M|²`, `r = C − k`
/// (the endpoint map `exp(A t M^) exp((C−A) t M3 e3^)` has that determinant), here where x is a literal; powers of two as scales are exact.
#[test]
fn limits_have_their_exact_answers() {
    let pi = std::f64::consts::PI;
    let cases = [
        ("A=2 B=2 C=2 H1=0.3 H2=0 H3=-0.4", [2.0 * pi; 2]),
        ("A=2 B=2 C=2 H1=-0.0 H2=0 H3=0.5", [2.0 * pi; 2]),
        // Along the axis of symmetry the rest is a sphere; across it r/k = C/A − 1 = 1: tan x = −x.
        ("A=1 B=1 C=3 H1=0 H2=0 H3=1", [2.0 * pi; 2]),
        ("A=1 B=1 C=2 H1=1 H2=0 H3=0", [2.0 * 2.028757838110434, 2.0 * pi]),
        ("A=1 B=2 C=1 H1=1 H2=-0.0 H3=0", [2.0 * 2.028757838110434, 2.0 * pi]),
        ("A=2 B=1 C=1 H1=0 H2=0 H3=-1", [2.0 * 2.028757838110434, 2.0 * pi]),
        // A prolate one, C = A/2 across the axis: tan x = x/2 beyond π.
        ("A=1 B=1 C=0.5 H1=1 H2=0 H3=0", [2.0 * pi, 2.0 * 4.274782271458128]),
        // Principal axes of a body without symmetry: 20 digits, the rotation matrix, mpmath (tests of geometry).
        ("A=1 B=2 C=3 H1=1 H2=0 H3=0", [2.531_343_810_042_343_8, 2.677_523_780_011_692_8]),
        ("A=1 B=2 C=3 H1=0 H2=1 H3=0", [2.442_886_300_519_586_2, 3.906_890_612_653_043_9]),
        ("A=1 B=2 C=3 H1=0 H2=0 H3=1", [3.767_687_733_605_730_4, 4.059_376_566_572_731_2]),
        // Any order, any sign, and any size that a time has.
        ("A=3 B=1 C=2 H1=0 H2=-1 H3=0", [2.531_343_810_042_343_8, 2.677_523_780_011_692_8]),
        ("A=1e-300 B=2e-300 C=3e-300 H1=1e300 H2=0 H3=0", [2.531_343_810_042_343_8, 2.677_523_780_011_692_8]),
        ("A=1e300 B=2e300 C=3e300 H1=0 H2=1e-300 H3=0", [2.442_886_300_519_586_2, 3.906_890_612_653_043_9]),
        ("A=5e-324 B=5e-324 C=5e-324 H1=0 H2=0 H3=1e308", [2.0 * pi / (5e-324 * 1e308); 2]),
        // At a pole p1 = p3 is the limit q = 0: M = (p2 sin Φ3, p2 cos Φ3, p3).
        ("A=1 B=2 C=3 Phi2=0 Phi3=0 p1=1 p2=0 p3=1", [3.767_687_733_605_730_4, 4.059_376_566_572_731_2]),
        ("A=1 B=2 C=3 Phi2=-0.0 Phi3=0 p1=0 p2=1 p3=0", [2.442_886_300_519_586_2, 3.906_890_612_653_043_9]),
        ("A=1 B=2 C=3 Phi2=1e-300 Phi3=0 p1=1 p2=0 p3=1", [3.767_687_733_605_730_4, 4.059_376_566_572_731_2]),
        (
            "A=1 B=2 C=3 Phi2=3.141592653589793 Phi3=0 p1=-1 p2=0 p3=1",
            [3.767_687_733_605_730_4, 4.059_376_566_572_731_2],
        ),
    ];
    for (text, exact) in cases {
        let given = given(text);
        let (found, claimed, _) = times(&given, answer(Asked::RotationGroup, &given, 1e-14)).expect(text);
        for i in 0..2 {
            let error = (found[i] / exact[i] - 1.0).abs();
            // The literals' own rounding, and that of 2π/….
            assert!(
                error <= claimed + 2.0 * f64::EPSILON && claimed < 1e-14,
                "{text}: {found:?}, {exact:?}, {claimed:e}"
            );
        }
    }
}

#[test]
fn impossible_inputs_are_refused_with_their_reason() {
    for (text, word) in [
        ("A=0 B=2 C=3 H1=1 H2=0 H3=0", "A = 0"),
        ("A=1 B=-2 C=3 H1=1 H2=0 H3=0", "B = -2"),
        ("A=1 B=2 C=-0.0 H1=1 H2=0 H3=0", "C = -0"),
        ("A=1 B=2 C=3 H1=0 H2=0 H3=-0.0", "must not be zero"),
        ("A=1 B=2 C=3 Phi2=1 Phi3=0 p1=0 p2=0 p3=0", "must not be zero"),
        ("A=1 B=2 C=3 Phi2=0 Phi3=0 p1=1 p2=0 p3=2", "Φ2 = 0"),
        ("A=1 B=2 C=3 Phi2=0 Phi3=0 p1=-1 p2=0 p3=1", "p1 = -1"),
        ("A=1 B=2 C=3 Phi2=1 Phi3=1e300 p1=1 p2=0 p3=2", "whole turns"),
        // t1 beyond the largest number; A, B, C with no common unit; the separating polhode of a body whose fields grow
        // by e^3000 along it.
        ("A=1e-200 B=2e-200 C=3e-200 H1=1e-200 H2=0 H3=0", "double precision"),
        ("A=1e200 B=2e200 C=3e200 H1=1e200 H2=0 H3=0", "double precision"),
        ("A=1e-300 B=1 C=1e300 H1=1 H2=1 H3=1", "times the smallest"),
        ("A=1 B=2 C=1048578 H1=1024 H2=512 H3=1", "separating polhode"),
    ] {
        let given = given(text);
        match answer(Asked::RotationGroup, &given, 1e-14) {
            Err(PointError::Refused(reason)) => assert!(reason.contains(word), "{text}: {reason}"),
            other => panic!("{text}: {other:?}"),
        }
    }
    for text in ["A=inf B=2 C=3 H1=1 H2=0 H3=0", "A=1 B=nan C=3 H1=1 H2=0 H3=0", "A=1 B=2 C=3 H1=1 H2=-inf H3=0"] {
        assert!(matches!(answer(Asked::RotationGroup, &given(text), 1e-14), Err(PointError::Value { .. })), "{text}");
    }
}

/// Numbers at every edge of the format in every place: an answer in order or a reason, nothing else.
#[test]
fn edges_of_the_format_do_no_harm() {
    const EDGES: [f64; 16] = [
        0.0,
        -0.0,
        5e-324,
        2.3e-308,
        1e-160,
        1e-17,
        1e-8,
        0.3,
        1.0,
        1.0000000000000002,
        -2.0,
        std::f64::consts::PI,
        1e8,
        1e17,
        1e160,
        1.7e308,
    ];
    let count = count(1200) / 4;
    let mut random = Random(4);
    for _ in 0..count {
        let keys: &[&str] = if random.below(2) == 0 {
            &["A", "B", "C", "H1", "H2", "H3"]
        } else {
            &["A", "B", "C", "Phi2", "Phi3", "p1", "p2", "p3"]
        };
        // Mostly near one, a few at an edge: else nothing is ever answered.
        let value = |random: &mut Random| {
            let edge = EDGES[random.below(EDGES.len())];
            if random.below(3) > 0 { 0.5 + random.unit() } else { edge }
        };
        let given: Inputs = keys.iter().map(|key| ((*key).to_owned(), Given::Number(value(&mut random)))).collect();
        times(&given, answer(Asked::RotationGroup, &given, 1e-14));
    }
}
