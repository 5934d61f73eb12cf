//! Tests of the room's front door (`conjugate`) against independent oracles.

use super::conjugate::*;
use super::extremal::Regime;
use super::solve::SpinError;
use super::start::Start;

/// One row of an oracle file.
struct Row {
    region: String,
    start: Start,
    t1: f64,
    theta: f64,
    phi: f64,
    crossings: u32,
    condition: f64,
}

/// tests/oracle/spin_extra.json: Taylor integration of r, h, δh at 300 bits, see its `origin`.
fn oracle() -> Vec<Row> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/oracle/spin_extra.json");
    let text = std::fs::read_to_string(path).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |row: &serde_json::Value, name: &str| -> f64 { row[name].as_str().unwrap().parse().unwrap() };
    let rows = file["points"].as_array().unwrap().iter();
    rows.map(|row| Row {
        region: row["region"].as_str().unwrap().to_owned(),
        start: Start::new(number(row, "k"), number(row, "p_theta")).unwrap(),
        t1: number(row, "t1"),
        theta: number(row, "theta"),
        phi: number(row, "phi"),
        crossings: row["crossings"].as_u64().unwrap() as u32,
        condition: number(row, "condition"),
    })
    .collect()
}

/// Error of t1 in ε·max(1, condition), by region, median and maximum as measured: random 0.5, 3.1; near k = 1 0.0, 1.0;
/// separatrix 0.6, 1.9; p_θ = 0 or 1e-300 0.1, 0.7; p_θ = 1e8 0.9, 1.7; triple root 0.2, 0.4; k small 0.6, 2.5; k from
/// 2.5 to 3 0.6, 1.0; k from 6 to 400 0.3, 1.7. Asserted: 6 (the requirement is 22).
#[test]
fn conjugate_points_against_integration_at_300_bits() {
    let rows = oracle();
    assert!(rows.len() >= 150);
    for row in rows {
        let point = first_conjugate_point(&row.start).unwrap();
        let (k, p) = (row.start.k(), row.start.p_theta());
        let relative = ((point.t1 - row.t1) / row.t1).abs();
        let units = relative / f64::EPSILON / row.condition.max(1.0);
        assert!(units <= 6.0, "{} k = {k} p = {p:e}: {units} ε·max(1, cond)", row.region);
        // The error printed is a bound, up to the half unit in which the oracle itself is rounded.
        assert!(relative <= point.error + f64::EPSILON, "{k} {p:e}: {relative:e} above {:e}", point.error);
        // … and not a wild one: at most 100 times the rounding unit times the condition number.
        assert!(point.error <= 100.0 * f64::EPSILON * row.condition.max(1.0), "{k} {p:e}: {:e}", point.error);
        // The point moves with speed |ω × r| ≤ |ω| when t1 does.
        let extremal = extremal(&row.start);
        let speed = 2.0 * (1.0 + 1.0 / k).min(extremal.casimir);
        let tolerance = 16.0 * f64::EPSILON + speed * row.t1 * point.error;
        let radius = libm::sin(row.phi).max(1e-3);
        let turned = libm::remainder(point.theta - row.theta, 2.0 * std::f64::consts::PI).abs();
        assert!(turned * radius <= tolerance, "{k} {p:e}: θ {} {}", point.theta, row.theta);
        assert!((point.phi - row.phi).abs() <= tolerance, "{k} {p:e}: φ {} {}", point.phi, row.phi);
        assert!((point.theta - row.theta).abs() < 1.0, "{k} {p:e}: θ on the wrong side of π: {}", point.theta);
        if row.condition < 1e6 {
            assert_eq!(point.crossings, row.crossings, "{k} {p:e}");
        }
    }
}

/// Oracles: the project's reference values spin_conjugate_points.json and spin_fig4.json (mpmath, at least 22 digits,
/// for decimal inputs, so that the inputs' own rounding, up to one ε times the condition number, is in the error).
#[test]
fn conjugate_points_against_the_reference_files() {
    let mut points = 0;
    for name in ["spin_conjugate_points.json", "spin_fig4.json"] {
        let path = format!("{}/tests/oracle/{name}", env!("CARGO_MANIFEST_DIR"));
        let file: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        for row in file.as_array().unwrap() {
            let number = |part: &str, name: &str| -> f64 { row[part][name].as_str().unwrap().parse().unwrap() };
            let start = Start::new(number("params", "k"), number("params", "p_theta")).unwrap();
            let point = first_conjugate_point(&start).unwrap();
            let condition = condition_estimate(&start).unwrap().max(1.0);
            let relative = (point.t1 / number("value", "t1") - 1.0).abs();
            assert!(relative <= 12.0 * f64::EPSILON * condition, "{start:?}: {relative:e} {condition}");
            let tolerance = 32.0 * f64::EPSILON * condition * (1.0 + point.t1);
            let radius = libm::sin(point.phi);
            assert!(((point.theta - number("value", "theta")) * radius).abs() <= tolerance, "{start:?} {point:?}");
            assert!((point.phi - number("value", "phi")).abs() <= tolerance, "{start:?} {point:?}");
            points += 1;
        }
    }
    assert_eq!(points, 86);
}

/// The hard cases of the literature of this project, 25 digits (mpmath, two routes): p_θ down to 1e-14, up to 1e6.
#[test]
#[expect(clippy::approx_constant, reason = "an angle within 4e-31 of π, not π")]
fn hard_cases() {
    for (k, p, t1, theta, phi) in [
        (1.2, 1e-8, 7.525512756464467502984594405, 1.8180805184495769462497407e-24, 0.32846887751001559317201405),
        (1.00000001, 1e-4, 4.493409482248365832837189316, 3.1415926535860130210226250, 2.9226131554534692844849306),
        (1.0, 1e6, 8.986818915800154712784179514e-6, 8.5627268940431562688157701e-12, 1.5707982790341757769763140),
        (0.5, 1e6, 4.493409457896707299298673500e-6, 4.2813634470104910849577584e-12, 1.5707973029145361976042421),
        (0.1, 1e-14, 3.241760074751353034808166563, 3.1415926535897932384626434, 1.6709637479564564155768449),
    ] {
        let point = first_conjugate_point(&Start::new(k, p).unwrap()).unwrap();
        assert!((point.t1 / t1 - 1.0).abs() < 8.0 * f64::EPSILON, "{k} {p}: {}", point.t1);
        assert!((point.theta - theta).abs() < 4e-15 && (point.phi - phi).abs() < 4e-15, "{k} {p}: {point:?}");
    }
}

/// Oracle: as above, the first four conjugate times and r, h at a time. 24 digits.
#[test]
fn later_times_and_positions_against_integration() {
    for (k, p, times) in LATER_TIMES {
        let start = Start::new(k, p).unwrap();
        for (j, expected) in (1..).zip(times) {
            let t = nth_conjugate_time(&start, j).unwrap();
            assert!((t / expected - 1.0).abs() < 24.0 * f64::EPSILON, "{k} {p} {j}: {t} {expected}");
            assert_eq!(conjugate_count(&start, t * (1.0 + 1e-9)).unwrap(), j);
            assert_eq!(conjugate_count(&start, t * (1.0 - 1e-9)).unwrap(), j - 1);
        }
    }
    for (k, p, t, r, h) in POSITIONS {
        for mirror in [1.0, -1.0] {
            let start = Start::new(k, mirror * p).unwrap();
            let (found, momenta) = (position(&start, t).unwrap(), momentum(&start, t).unwrap());
            let expected = [r[0], r[1], start.mirror() * r[2]];
            let expected_h = [start.mirror() * h[0], start.mirror() * h[1], h[2]];
            for i in 0..3 {
                assert!((found[i] - expected[i]).abs() < 1e-14, "{k} {p} r{i}: {} {}", found[i], expected[i]);
                let difference = (momenta[i] - expected_h[i]).abs();
                assert!(difference < 1e-14 * (1.0 + p), "{k} {p} h{i}: {} {}", momenta[i], expected_h[i]);
            }
        }
    }
}

const LATER_TIMES: [(f64, f64, [f64; 4]); 5] = [
    (
        0.3,
        0.7,
        [1.41994778426498796828382, 2.87117142118757769217137, 4.25302817317974028533245, 5.20095673669223641901595],
    ),
    (
        1.2,
        0.1,
        [7.50790535625881797237334, 14.0794961831757453033169, 20.6214079274473891439176, 27.2989479076616295176211],
    ),
    (
        1.7,
        0.9,
        [11.6584863685952864763247, 25.9208870972705821183358, 39.2467488934372517328147, 53.823267747999783218216],
    ),
    (
        1.7,
        6.0,
        [2.55133581831183059425687, 4.36433210874501294141245, 6.10886169820431491463621, 7.78524071554296396014623],
    ),
    (
        2.6,
        3.0,
        [11.6686054834948658660204, 33.164461896501397599741, 53.7170788442593365529999, 75.657698185764546071487],
    ),
];

/// k, p, t, r, h.
type Position = (f64, f64, f64, [f64; 3], [f64; 3]);

const POSITIONS: [Position; 7] = [
    (
        0.3,
        0.7,
        5.0,
        [-0.967852306808727733042973, 0.183454582389968044776033, 0.172064895911823882969808],
        [-0.518454223207193181021573, -1.79103710247830815821896, -1.00667339091918592843561],
    ),
    (
        1.2,
        0.1,
        11.0,
        [0.00487839464680181648886347, -0.998799635080471369445207, -0.0487390011057600719272501],
        [-0.0380039215921943313295217, -0.097768536375427413956621, 1.9997492380892713002169],
    ),
    (
        1.7,
        6.0,
        9.0,
        [0.106801797722309369673598, -0.20610330289615729861072, 0.972684329337415485650858],
        [2.31952283581923301054079, -5.69925169945995197747994, -1.46230772422084697289621],
    ),
    (
        0.05,
        0.001,
        2.5,
        [-0.588403430344815359405226, -0.808500501619396459552293, 0.0104087482262913048474243],
        [0.00133667448454179293721569, -0.0267187719098839194981906, -1.99982132215079404401866],
    ),
    (
        1.25,
        1.5,
        6.0,
        [0.00477802866744424172092647, -0.744510629122497267986865, -0.667593509229738095653508],
        [2.49626985583081651456907, -0.0819100144874973886483898, 0.109213352649996518197853],
    ),
    (0.7, 0.0, 2.0, [-0.416146836547142386997568, 0.90929742682568169539602, 0.0], [0.0, 0.0, 2.0]),
    (
        1.0,
        2.0,
        3.0,
        [0.359153621184917408434755, -0.630514568805764362523552, 0.688084337064463256172893],
        [0.28224001611973444420149, -2.0, -1.97998499320089091454315],
    ),
];

/// The first conjugate point is also a point of the extremal at t1, in every regime; the cut point likewise, and it
/// comes first (curvature is negative off the equator, Lemma 4.4).
#[test]
fn conjugate_and_cut_points_lie_on_the_extremal() {
    for k in [0.05, 0.3, 0.9, 1.0, 1.1, 1.25, 2.0, 3.0] {
        for p in [0.0, 1e-6, 0.01, 0.4, 1.5, 7.0, 300.0] {
            for sign in [1.0, -1.0] {
                let start = Start::new(k, sign * p).unwrap();
                let point = first_conjugate_point(&start).unwrap();
                let cut = cut_point(&start).unwrap();
                assert!(cut.t_cut < point.t1);
                let momentum_size = libm::sqrt(p * p + 4.0);
                for (t, error, r) in [(point.t1, point.error, point.r), (cut.t_cut, cut.error, cut.r)] {
                    let there = position(&start, t).unwrap();
                    let speed = (1.0 + 1.0 / k).min(momentum_size);
                    let tolerance = 64.0 * f64::EPSILON + 4.0 * speed * t * error;
                    for i in 0..3 {
                        assert!((there[i] - r[i]).abs() <= tolerance, "{k} {p} r{i}: {} {}", there[i], r[i]);
                    }
                    let norm = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
                    assert!((norm - 1.0).abs() < 16.0 * f64::EPSILON);
                }
                assert_eq!(cut.r[1], 0.0);
                assert!(sign * point.theta >= 0.0 || p == 0.0);
            }
        }
    }
    let north = first_conjugate_point(&Start::new(0.8, -0.0).unwrap()).unwrap();
    assert_eq!(north.theta, std::f64::consts::PI);
}

/// First integrals along the extremal: |r| = 1, r·h = 0, |h|² = p² + 4, H = 1; 200 pseudo-random cases.
#[test]
fn invariants() {
    let mut seed = 7_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / 9_007_199_254_740_992.0
    };
    for _ in 0..200 {
        let k = 0.05 * libm::pow(60.0, next());
        let p = libm::pow(10.0, -6.0 + 8.0 * next());
        let start = Start::new(k, p).unwrap();
        let t = 10.0 * next() * k.min(1.0) / (1.0 + p);
        let (r, h) = (position(&start, t).unwrap(), momentum(&start, t).unwrap());
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let square = p * p + 4.0;
        assert!((dot(r, r) - 1.0).abs() < 32.0 * f64::EPSILON, "{k} {p} {t}");
        assert!(dot(r, h).abs() < 64.0 * f64::EPSILON * libm::sqrt(square), "{k} {p} {t}");
        assert!((dot(h, h) / square - 1.0).abs() < 32.0 * f64::EPSILON, "{k} {p} {t}");
        let energy = (h[2] * h[2] + h[0] * h[0] / (k * k)) / 4.0;
        assert!((energy - 1.0).abs() < 32.0 * f64::EPSILON, "{k} {p} {t}: {energy}");
    }
}

/// Nowhere in the supported range does the solver fail or wander: 60 000 pseudo-random starts, k from 1e-3 to 1e3,
/// with a third of them within 1e-16 … 1 (relative) of the separatrix and of k = 1.
#[test]
fn every_start_is_solved() {
    let mut seed = 11_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / 9_007_199_254_740_992.0
    };
    let power = |x: f64| libm::pow(10.0, x);
    let (mut evaluations, mut starts) = (0, 0);
    for i in 0..60_000 {
        let (k, p) = match i % 3 {
            0 => (power(-3.0 + 6.0 * next()), power(-140.0 + 240.0 * next())),
            1 => {
                let k = 1.0 + power(-15.0 + 16.0 * next());
                let near = 1.0 + (next() - 0.5) * power(-16.0 * next());
                (k, 2.0 * ((k - 1.0) * (k + 1.0)).sqrt() * near)
            }
            _ => (1.0 + (next() - 0.5) * power(-16.0 * next()), power(-20.0 + 25.0 * next())),
        };
        let start = Start::new(k, p).unwrap();
        let point = first_conjugate_point(&start).unwrap();
        assert!(point.iterations <= 30, "{k} {p:e}: {}", point.iterations);
        assert!(point.error < 1e-4 && point.theta >= 0.0, "{k} {p:e}: {point:?}");
        assert!(point.crossings >= 1);
        evaluations += point.iterations;
        starts += 1;
    }
    assert!(f64::from(evaluations) < 3.0 * f64::from(starts));
}

/// The condition number of three points, by mpmath differences at 300 bits; all six regimes occur in this file.
#[test]
fn condition_numbers() {
    for (k, p, expected) in [(1.2, 0.420_528_213_000_000_04, 4.654), (0.3, 0.0, 0.091), (2.5, 0.01, 5.108)] {
        let found = condition_estimate(&Start::new(k, p).unwrap()).unwrap();
        assert!((found / expected - 1.0).abs() < 2e-2, "{k} {p}: {found} {expected}");
    }
    let regimes = [(1.0, 1.0), (0.5, 0.0), (0.5, 1.0), (1.25, 9.0), (1.25, 1.5), (1.25, 1.0)]
        .map(|(k, p)| extremal(&Start::new(k, p).unwrap()).regime);
    use Regime::{Meridian, Oscillating, RotatingAbove, RotatingBelow, Round, Separatrix};
    assert_eq!(regimes, [Round, Meridian, RotatingBelow, RotatingAbove, Separatrix, Oscillating]);
}

/// For p_θ = 0 and large k, t1 ≈ 2πk²: `f64` tells the time (16 digits against the elementary equation) but from k = 1e4 or so not the
/// point, where double-double goes on; k = 1e15 says that there is no answer.
#[test]
fn too_long_a_time_is_refused() {
    for (k, arithmetic) in [(1e3, Arithmetic::F64), (7e5, Arithmetic::DoubleDouble), (1e8, Arithmetic::DoubleDouble)] {
        let point = first_conjugate_point(&Start::new(k, 0.0).unwrap()).unwrap();
        let limit: f64 = super::limits::meridian_conjugate_time(k).unwrap();
        assert!((point.t1 / limit - 1.0).abs() < 16.0 * f64::EPSILON, "{} {limit}", point.t1);
        assert_eq!(point.arithmetic, arithmetic, "{k}");
    }
    assert!(matches!(first_conjugate_point(&Start::new(1e15, 0.0).unwrap()), Err(SpinError::PrecisionLost { .. })));
}

#[test]
fn arguments_outside_their_domain() {
    let start = Start::new(1.2, 0.3).unwrap();
    assert!(matches!(nth_conjugate_time(&start, 0), Err(SpinError::OutOfDomain { .. })));
    assert!(matches!(position(&start, -1.0), Err(SpinError::OutOfDomain { .. })));
    assert!(matches!(conjugate_count(&start, f64::NAN), Err(SpinError::OutOfDomain { .. })));
    assert_eq!(position(&start, 0.0).unwrap(), [1.0, 0.0, 0.0]);
    assert_eq!(momentum(&start, 0.0).unwrap(), [0.0, -0.3, 2.0]);
}
