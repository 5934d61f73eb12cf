//! Oracles: `tests/oracle/serret_andoyer_extra.json` (the pole-free form of eq. (15) and the printed Proposition 3.2 in mpmath,
//! 45 digits, with condition numbers), and values of independent integrations with a Jacobi field.

use super::*;
use crate::geometry::serret_andoyer::{Branch, Clairaut, Metric, Start};
use crate::numerics::ulp::{next_down, next_up, relative_error_in_epsilon};

#[derive(serde::Deserialize)]
struct Row {
    group: String,
    #[serde(rename = "A")]
    a: f64,
    #[serde(rename = "B")]
    b: f64,
    #[serde(rename = "C")]
    c: f64,
    kind: String,
    inputs: [f64; 3],
    t1: String,
    x: String,
    y: String,
    phi: String,
    condition: String,
}

impl Row {
    fn start(&self, inputs: [f64; 3]) -> Start {
        let [u, v, w] = inputs;
        let branch = if w < 0.0 { Branch::Descending } else { Branch::Ascending };
        match self.kind.as_str() {
            "mom" => Start::Momenta { y0: u, p_x: v, p_y: w },
            "delta" => Start::Darboux { phi0: u, clairaut: Clairaut::Delta(v), branch },
            "p" => Start::Darboux { phi0: u, clairaut: Clairaut::PTheta(v), branch },
            other => panic!("unknown kind {other}"),
        }
    }

    fn solve(&self) -> (Extremal, ConjugatePoint) {
        let metric = Metric::new(self.a, self.b, self.c).unwrap();
        let extremal = Extremal::new(&metric, self.start(self.inputs)).unwrap();
        (extremal, first_conjugate_point(&extremal).unwrap())
    }
}

fn rows() -> Vec<Row> {
    let rows: Vec<Row> = serde_json::from_str(include_str!("../../../tests/oracle/serret_andoyer_extra.json")).unwrap();
    assert!(rows.len() >= 100);
    rows
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// Errors in units of ε × max(1, condition), condition over all inputs A, B, C included; the printed error must bound the truth.
#[test]
fn times_are_right_to_a_few_epsilon_times_the_condition() {
    let mut groups: std::collections::BTreeMap<String, (f64, f64, usize)> = Default::default();
    let mut overestimates = vec![];
    for row in rows() {
        let (_, point) = row.solve();
        let error = relative_error_in_epsilon(point.t1, number(&row.t1));
        let condition = number(&row.condition).max(1.0);
        let group = groups.entry(row.group.clone()).or_default();
        *group = (group.0.max(error / condition), group.1.max(error), group.2.max(point.iterations));
        let label = format!("{} {} {} {} {:?}", row.group, row.a, row.b, row.c, row.inputs);
        assert!(error / condition <= 6.0, "{label}: {error} ε, condition {condition}");
        if condition <= 100.0 {
            assert!(error * f64::EPSILON <= 2e-13, "{label}: {error} ε, condition {condition}");
        }
        assert!(error * f64::EPSILON <= point.error, "{label}: {error} ε is above its bound {:e}", point.error);
        overestimates.push(point.error / (f64::EPSILON * condition));
        assert!(point.t1 >= point.lower_bound);
    }
    for (group, (scaled, error, iterations)) in groups {
        println!("{group}: {scaled:.2} ε × condition, {error:.1} ε, {iterations} steps");
    }
    overestimates.sort_by(f64::total_cmp);
    println!(
        "printed error / (ε × condition): median {:.1}, largest {:.1}",
        overestimates[overestimates.len() / 2],
        overestimates[overestimates.len() - 1]
    );
    assert!(overestimates[overestimates.len() - 1] <= 60.0);
}

/// Places to the same measure; x grows with time, so relative to its size.
#[test]
fn places_are_right_to_a_few_epsilon_times_the_condition() {
    let mut worst = 0.0_f64;
    for row in rows() {
        let (_, point) = row.solve();
        let condition = number(&row.condition).max(1.0);
        let scale = |v: f64| f64::EPSILON * condition * (1.0 + v.abs());
        for (got, expected) in [(point.x, &row.x), (point.y, &row.y), (point.phi, &row.phi)] {
            let expected = number(expected);
            let error = (got - expected).abs() / scale(expected);
            worst = worst.max(error);
            assert!(error <= 10.0, "{} {:?}: {got} is not {expected}, {error}", row.group, row.inputs);
        }
        assert_eq!(point.x, point.theta);
    }
    println!("places: {worst:.2} ε × condition");
}

/// The path, evaluated at t1, is at the conjugate point: two closed forms of the same place.
#[test]
fn the_path_passes_through_the_conjugate_point() {
    for row in rows() {
        let (extremal, point) = row.solve();
        let at = extremal.position(point.t1);
        // The phase carries ε (2K + …); the speed of a is at most M G.
        let slack = 40.0 * f64::EPSILON * (1.0 + extremal.complete_k()) * (1.0 + extremal.speed() * point.t1);
        assert!((at.y - point.y).abs() <= slack * (1.0 + extremal.gain), "{}: {at:?} {point:?}", row.group);
        assert!((at.x - point.x).abs() <= slack * (1.0 + point.x.abs()), "{}: {at:?} {point:?}", row.group);
    }
}

/// Stability (DESIGN.md section 3): error at most 20 max |t1(x') − t1(x)| over inputs within one unit in the last place, plus 20 ε t1.
#[test]
fn answers_are_stable() {
    for row in rows() {
        let (_, point) = row.solve();
        let mut spread = 0.0_f64;
        for i in 0..5 + usize::from(row.kind == "mom") {
            for step in [next_up, next_down] {
                let mut all = [row.a, row.b, row.c, row.inputs[0], row.inputs[1], row.inputs[2]];
                all[i] = step(all[i]);
                let metric = Metric::new(all[0], all[1], all[2]).unwrap();
                let Ok(extremal) = Extremal::new(&metric, row.start([all[3], all[4], all[5]])) else { continue };
                if let Ok(moved) = first_conjugate_time(&extremal) {
                    spread = spread.max((moved.t1 - point.t1).abs());
                }
            }
        }
        let error = (point.t1 - number(&row.t1)).abs();
        assert!(error <= 20.0 * spread + 20.0 * f64::EPSILON * point.t1, "{} {:?}", row.group, row.inputs);
    }
}

/// Values not of this equation: by eq. (9) integrated with its Jacobi field, to 26 digits and more (A = 1.5, B = 2, C = 2.8).
#[test]
fn integrated_values() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    // [y0, p_x, p_y], t1, x, y; condition at most 20.
    for ([y0, p_x, p_y], t1, x, y) in INTEGRATED {
        let extremal = Extremal::new(&metric, Start::Momenta { y0, p_x, p_y }).unwrap();
        let got = first_conjugate_point(&extremal).unwrap();
        assert!(relative_error_in_epsilon(got.t1, t1) <= 12.0, "{got:?}");
        assert!(relative_error_in_epsilon(got.x, x) <= 60.0 && relative_error_in_epsilon(got.y, y) <= 12.0, "{got:?}");
    }
}

const INTEGRATED: [([f64; 3], f64, f64, f64); 4] = [
    (
        [1.24904577239825442582991707728, 1.1, 0.3155946],
        5.41781860183799075980432766516,
        9.32458112775174811618814271716,
        1.24536159351747857997657237644,
    ),
    (
        [1.24904577239825442582991707728, 1.1, -0.315594676761190000905765885799],
        4.61236377724086507731882842846,
        8.02539313061163599880661660427,
        2.08193549612533063024942246855,
    ),
    (
        [0.5, 1.01273936708366661627889543814, 0.269779616342609124186529815184],
        12.2284333421201090665130636704,
        21.94914567529384440518704296,
        0.3467593678495203244051377658,
    ),
    (
        [1.0, 1.06904496764969753873821392352, 0.320981102765143304453245020223],
        6.97630292479518301081316475299,
        12.03858280235188613142774316,
        0.9249010328603057021129366284,
    ),
];

#[test]
fn special_starts() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    let solve = |phi0, clairaut, branch| {
        first_conjugate_point(&Extremal::new(&metric, Start::Darboux { phi0, clairaut, branch }).unwrap()).unwrap()
    };
    let both = [Branch::Ascending, Branch::Descending];
    // p_θ = √μ(φ0), as rounding gives it: t1 = 2K/M whatever the branch.
    for phi0 in [-1.2, -0.5, -0.1, 0.3, 1.0] {
        let p_theta = metric.mu(phi0).sqrt();
        for p_theta in [p_theta, next_up(p_theta), next_down(p_theta), -p_theta] {
            for branch in both {
                let point = solve(phi0, Clairaut::PTheta(p_theta), branch);
                assert!((point.t1 / point.lower_bound - 1.0).abs() <= 1e-14, "{phi0} {p_theta} {point:?}");
                assert!((point.phi + phi0).abs() <= 2e-7, "{point:?}"); // square root of rounding: p_φ ~ √ε
                assert!(point.theta * p_theta > 0.0);
            }
        }
    }
    // φ0 = 0, p_θ = A^(−1/2): the limit on the equator.
    let limit = equator_conjugate_time(&metric, 0.5);
    for branch in both {
        let point = solve(0.0, Clairaut::PTheta(metric.equator_clairaut()), branch);
        assert!(relative_error_in_epsilon(point.t1, limit) <= 4.0, "{point:?} {limit}");
        assert!((point.theta / (5.844_999_164_631_256_6) - 1.0).abs() <= 4.0 * f64::EPSILON, "{point:?}");
    }
    // Descending mirrors ascending, a negative p_θ mirrors θ.
    let up = solve(-0.4, Clairaut::PTheta(0.75), Branch::Ascending);
    let down = solve(0.4, Clairaut::PTheta(0.75), Branch::Descending);
    let left = solve(-0.4, Clairaut::PTheta(-0.75), Branch::Ascending);
    assert_eq!((up.t1, up.x, up.phi), (down.t1, down.x, -down.phi));
    assert_eq!((up.t1, up.x, up.phi), (left.t1, -left.x, left.phi));
    // The universal cover: y0 + 3π is the same start, three half turns on.
    let at = |y0: f64, p_y: f64| {
        first_conjugate_point(&Extremal::new(&metric, Start::Momenta { y0, p_x: 1.1, p_y }).unwrap()).unwrap()
    };
    let (near, far) = (at(1.2, 0.3), at(1.2 + 3.0 * std::f64::consts::PI, 0.3));
    assert!((near.t1 - far.t1).abs() <= 1e-13 && (far.y - near.y - 3.0 * std::f64::consts::PI).abs() <= 1e-13);
    assert!((far.phi - near.phi - 6.0 * metric.half_width()).abs() <= 1e-13);
    // h is arbitrary: momenta doubled, time halved, place unchanged.
    let fast = first_conjugate_point(&Extremal::new(&metric, Start::Momenta { y0: 1.2, p_x: 2.2, p_y: 0.6 }).unwrap());
    let fast = fast.unwrap();
    assert!((2.0 * fast.t1 / near.t1 - 1.0).abs() <= 4.0 * f64::EPSILON && (fast.x - near.x).abs() <= 1e-14);
}

#[test]
fn extremals_without_conjugate_point_say_why() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    let reason = |start| first_conjugate_point(&Extremal::new(&metric, start).unwrap()).unwrap_err();
    let darboux = |clairaut| Start::Darboux { phi0: -0.4, clairaut, branch: Branch::Ascending };
    assert!(matches!(reason(darboux(Clairaut::Delta(-1e-3))), NoConjugatePoint::Rotating { .. }));
    assert_eq!(reason(darboux(Clairaut::Delta(0.0))), NoConjugatePoint::Separatrix);
    assert!(matches!(reason(darboux(Clairaut::PTheta(0.3))), NoConjugatePoint::Unphysical { .. }));
    assert!(matches!(reason(darboux(Clairaut::PTheta(0.0))), NoConjugatePoint::Unphysical { .. }));
    assert_eq!(reason(Start::Momenta { y0: 0.0, p_x: 1.0, p_y: 0.0 }), NoConjugatePoint::MiddleAxis);
    let text = reason(Start::Momenta { y0: 1.0, p_x: 1.0, p_y: 0.95 }).to_string();
    assert!(text.contains("Corollary 3.11"), "{text}");
}

#[test]
fn starts_that_do_not_exist_are_refused() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    let refused = |start| Extremal::new(&metric, start).unwrap_err();
    let darboux = |phi0, clairaut| Start::Darboux { phi0, clairaut, branch: Branch::Ascending };
    use crate::geometry::serret_andoyer::StartError;
    assert!(matches!(refused(darboux(1.6, Clairaut::Delta(0.01))), StartError::OutsideStrip { .. }));
    assert!(matches!(refused(darboux(metric.half_width(), Clairaut::Delta(0.0))), StartError::OutsideStrip { .. }));
    assert!(matches!(refused(darboux(0.0, Clairaut::PTheta(0.82))), StartError::ClairautTooLarge { .. }));
    assert!(matches!(refused(darboux(0.5, Clairaut::Delta(0.3))), StartError::ClairautTooLarge { .. }));
    assert!(matches!(refused(darboux(0.0, Clairaut::Delta(-1.5))), StartError::DeltaTooSmall { .. }));
    assert!(matches!(refused(darboux(f64::NAN, Clairaut::Delta(0.1))), StartError::NotFinite { name: "phi0", .. }));
    assert!(matches!(refused(darboux(0.0, Clairaut::Delta(f64::NAN))), StartError::NotFinite { name: "delta", .. }));
    assert_eq!(refused(Start::Momenta { y0: 1.0, p_x: 0.0, p_y: 0.0 }), StartError::NoMomentum);
    assert!(matches!(refused(Start::Momenta { y0: 1.0, p_x: 1e-200, p_y: 0.0 }), StartError::OutOfScale { .. }));
}

/// Theorem 3.9: the printed upper bound 3K/M fails for the first t > 0, the corrected one holds everywhere.
#[test]
fn bounds_of_theorem_3_9() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    let counterexample = Start::Momenta { y0: 0.5, p_x: 1.01273936708366661627889543814, p_y: 0.269779616342609124 };
    let bounds = conjugate_time_bounds(&Extremal::new(&metric, counterexample).unwrap()).unwrap();
    assert!((bounds.ratio - 3.392158842222841).abs() <= 1e-13 && bounds.ratio > bounds.printed_upper);
    for row in rows() {
        let (extremal, _) = row.solve();
        let bounds = conjugate_time_bounds(&extremal).unwrap();
        assert!(bounds.ratio >= bounds.lower * (1.0 - f64::EPSILON), "{bounds:?}");
        assert!(bounds.ratio <= bounds.upper * (1.0 + 4.0 * f64::EPSILON), "{bounds:?}");
    }
}

/// A deterministic sweep over very unequal and nearly equal metrics, the whole strip and δ from 1e-300 to its largest value: the
/// solver always ends, in few steps, between the bounds of the theory.
#[test]
fn the_solver_never_fails() {
    let (mut most_steps, mut solved) = (0, 0);
    for i in 0..20_000_u32 {
        // A Kronecker sequence in six dimensions.
        let u = |k: u32| {
            let x = f64::from(i) * libm::sqrt(f64::from([2, 3, 5, 7, 11, 13][k as usize]));
            x - x.floor()
        };
        let a = libm::exp10(4.0 * u(0) - 2.0);
        let b = a * (1.0 + libm::exp10(10.0 * u(1) - 8.0));
        let c = b * (1.0 + libm::exp10(10.0 * u(2) - 8.0));
        let Ok(metric) = Metric::new(a, b, c) else { continue };
        let phi0 = metric.half_width() * (2.0 * u(3) - 1.0);
        let cn = metric.jacobi_of_phi(phi0).cn;
        let largest = (b - a) * cn * cn * metric.mu(phi0);
        let smallest = if u(5) < 0.5 { 1e-300 } else { largest * 1e-6 };
        let delta = smallest * libm::pow(largest * 0.999_999 / smallest, u(4));
        let branch = if i % 2 == 0 { Branch::Ascending } else { Branch::Descending };
        let start = Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch };
        let Ok(extremal) = Extremal::new(&metric, start) else { continue };
        let point = first_conjugate_point(&extremal).unwrap();
        let bounds = conjugate_time_bounds(&extremal).unwrap();
        assert!(point.t1.is_finite() && point.x.is_finite() && point.error.is_finite(), "{a} {b} {c} {start:?}");
        assert!(point.phi.abs() <= metric.half_width() * (1.0 + 1e-14), "{a} {b} {c} {start:?}: {point:?}");
        assert!(bounds.ratio >= 2.0 - 1e-14 && bounds.ratio <= bounds.upper + 1e-14, "{start:?} {bounds:?}");
        most_steps = most_steps.max(point.iterations);
        solved += 1;
    }
    println!("{solved} starts, at most {most_steps} steps");
    assert!(solved >= 19_000 && most_steps <= 12);
}
