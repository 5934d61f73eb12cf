//! Every family at its limit: ours is stable everywhere, the naive formulations lose what their names say, and the truth is the truth.

use super::*;
use crate::contract::code::undeclared;
use crate::effects::hard_cases::family::Verdict;

fn sweep(family: Family, from: f64, to: f64) -> Vec<Case> {
    let cases = HardCasesSpin { family, from, to, per_decade: 3 }.cases().unwrap();
    for case in &cases {
        // Double-double is stable and honest far below: the verdict has no room for a wrong truth.
        assert_eq!(case.verdict(), Verdict::Stable, "{family:?} at {:e}: {case:?}", case.distance);
    }
    cases
}

/// The largest error of the naive formulation among the cases within this distance; 0 where it was never tried.
fn worst_naive(cases: &[Case], within: f64) -> f64 {
    let tried = cases.iter().filter(|case| case.distance <= within && !case.naive.is_nan());
    tried.map(|case| case.error_of(case.naive)).fold(0.0, f64::max)
}

#[test]
fn small_momenta_are_stable_and_the_lift_loses_digits_for_small_k() {
    for (k, lost) in [(0.05, 1e-2), (0.1, 1e-7), (0.2, 1e-13), (0.8, 0.0), (1.0, 0.0), (1.2, 0.0)] {
        let cases = sweep(Family::SmallMomentum { k }, 1.0, 1e-14);
        assert!(worst_naive(&cases, 1.0) > lost, "{k}: {:e}", worst_naive(&cases, 1.0));
    }
}

/// `G² δβ' − p β'` cancels by p²: with p = 1e8 nothing is left.
#[test]
fn large_momenta_are_stable_and_the_printed_difference_cancels() {
    for k in [0.5, 1.2, 3.0] {
        let cases = sweep(Family::LargeMomentum { k }, 0.1, 1e-15);
        assert!(worst_naive(&cases, 1e-7) > 1e-3, "{k}");
    }
}

/// Divisions by m' = 1 − m, which itself is rounding.
#[test]
fn the_separatrix_is_stable_and_the_printed_forms_lose_it() {
    for (side, lost) in [(Side::Below, 1e-2), (Side::Above, 1e-6)] {
        let cases = sweep(Family::Separatrix { k: 1.2, side }, 0.1, 1e-15);
        assert!(worst_naive(&cases, 1e-10) > lost, "{side:?}: {:e}", worst_naive(&cases, 1e-10));
        // The problem itself is well posed: that is what makes it a hard case for formulas and not for the reader.
        assert!(cases.iter().all(|case| case.condition < 2.0));
    }
}

/// The tangent is vertical: one ε of p_θ moves t1 by 1e-6, and so does the integration's rounding.
#[test]
fn the_equator_crossing_is_stable() {
    for side in [Side::Below, Side::Above] {
        let cases = sweep(Family::EquatorCrossing { k: 1.2, side }, 1e-2, 1e-15);
        let closest = cases.last().unwrap();
        assert!(closest.condition > 1e9, "{closest:?}");
        assert!(worst_naive(&cases, 1e-9) > 1e-9);
        // (t1 − tc)/tc = −0.279 sign(d) |d|^(1/3): three decades of d are one of t1.
        assert!((cases[0].truth - closest.truth).abs() > 0.2, "{closest:?}");
    }
}

/// The time knows nothing of the pole; the angle does, and so does the chart.
#[test]
fn pole_passages_are_stable_in_time_and_angle() {
    for (passage, side) in [(1, Side::Below), (2, Side::Above), (3, Side::Below)] {
        let family = |answered| Family::Pole { p_theta: 1e-4, passage, side, answered };
        let times = sweep(family(Answered::Time), 1e-2, 1e-15);
        assert!(times.iter().all(|case| case.condition < 20.0));
        let angles = sweep(family(Answered::Theta), 1e-2, 1e-15);
        // θ turns by a quarter where k − k_s is of the order of r3.
        assert!(angles.iter().any(|case| case.condition > 1e10));
        assert!(worst_naive(&angles, 1e-2) > 1e-9, "{:e}", worst_naive(&angles, 1e-2));
    }
    assert!(sweep_fails(Family::Pole { p_theta: 1e-4, passage: 9, side: Side::Below, answered: Answered::Time }));
}

fn sweep_fails(family: Family) -> bool {
    HardCasesSpin { family, from: 0.1, to: 0.01, per_decade: 2 }.cases().is_err()
}

#[test]
fn the_round_case_is_stable_from_both_sides() {
    for side in [Side::Below, Side::Above] {
        for p_theta in [1.0, 1e-6] {
            sweep(Family::Round { p_theta, side }, 0.1, 1e-15);
        }
    }
}

/// f64 tells t1 for every k, and the point up to k = 1e4 or so; then double-double goes on, and says so.
#[test]
fn large_k_is_stable_and_says_where_f64_ends() {
    let cases = sweep(Family::LargeK { p_theta: 0.5 }, 0.5, 1e-12);
    let longer = |case: &Case| case.route.contains("double-double");
    assert!(cases.iter().filter(|case| case.distance > 2e-3).all(|case| !longer(case)));
    assert!(cases.iter().filter(|case| case.distance < 1e-5).all(longer));
    assert!(cases.iter().filter(|case| case.distance < 1e-3).all(|case| case.route.contains("no second route")));
}

#[test]
fn small_k_is_stable() {
    let cases = sweep(Family::SmallK { p_theta: 1.0 }, 0.1, 1e-12);
    assert!(cases.iter().all(|case| case.condition < 2.0));
}

#[test]
fn long_times_are_stable_and_integration_loses_digits_as_they_grow() {
    for k in [1.2, 0.8] {
        let cases = sweep(Family::LongTime { k, p_theta: 0.7 }, 1.0, 1e-10);
        assert!(worst_naive(&cases, 1e-3) > 1e-12);
    }
    assert!(sweep_fails(Family::LongTime { k: 1.0, p_theta: 1.0 }));
}

/// One number of an oracle: two doubles whose sum has 32 digits.
fn number(row: &serde_json::Value, name: &str) -> DoubleDouble {
    let part = |i: usize| row[name][i].as_str().unwrap().parse::<f64>().unwrap();
    DoubleDouble::from_sum(part(0), part(1))
}

fn oracle() -> serde_json::Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/oracle/hard_cases_spin.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Oracle: tests/oracle/hard_cases_spin.json, mpmath, Taylor integration of r, h, δh at 60 digits (see its `origin`): the truth of each
/// family agrees with it to 28 digits, up to the condition, and ours to what it claims.
#[test]
fn the_truth_is_that_of_integration_at_60_digits() {
    let file = oracle();
    let rows = file["points"].as_array().unwrap();
    assert!(rows.len() >= 40);
    for row in rows {
        let input = |name: &str| row[name].as_str().unwrap().parse::<f64>().unwrap();
        let (k, p) = (input("k"), input("p_theta"));
        let (t1, theta) = (number(row, "t1"), number(row, "theta"));
        let truth = first_conjugate_point_in_double_double(k.into(), p.into()).unwrap();
        let off = ((truth.t1 - t1) / t1).abs().to_f64();
        assert!(off <= truth.error.max(1e-30), "{k} {p:e}: {off:e} {:e}", truth.error);
        assert!(((truth.theta - theta).abs().to_f64()) < 1e-18, "{k} {p:e}: {:?} {theta:?}", truth.theta);
        let ours = first_conjugate_point(&Start::new(k, p).unwrap()).unwrap();
        let off = ((DoubleDouble::from(ours.t1) - t1) / t1).abs().to_f64();
        assert!(off <= ours.error, "{k} {p:e}: {off:e} {:e}", ours.error);
    }
    for row in file["positions"].as_array().unwrap() {
        let input = |name: &str| row[name].as_str().unwrap().parse::<f64>().unwrap();
        let (k, p, t) = (input("k"), input("p_theta"), input("t"));
        let start = Start::new(k, p).unwrap();
        let truth = position_in_double_double(k.into(), p.into(), t.into()).unwrap();
        let ours = position(&start, t).unwrap();
        for (i, name) in ["r1", "r2", "r3"].into_iter().enumerate() {
            let expected = number(row, name);
            assert!((truth[i] - expected).abs().to_f64() < 1e-28, "{k} {p} {name}: {:?} {expected:?}", truth[i]);
            assert!((ours[i] - expected.to_f64()).abs() <= position_error(&start, t).unwrap());
        }
    }
}

/// Oracle: the project's reference file, spin rows, 25 digits for decimal inputs (whose rounding is in the error).
#[test]
fn the_reference_values_of_the_project() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/oracle/hard_cases.json");
    let file: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let mut seen = 0;
    for row in file.as_array().unwrap().iter().filter(|row| row["quantity"] == "spin hard case") {
        let of = |part: &str, name: &str| row[part][name].as_str().unwrap().parse::<f64>().unwrap();
        let start = Start::new(of("params", "k"), of("params", "p_theta")).unwrap();
        let point = first_conjugate_point(&start).unwrap();
        // Conditions of these starts are below 40.
        assert!((point.t1 / of("value", "t1") - 1.0).abs() <= point.error + 40.0 * f64::EPSILON, "{start:?}");
        assert!((point.phi - of("value", "phi")).abs() < 4e-15 && (point.theta - of("value", "theta")).abs() < 4e-15);
        seen += 1;
    }
    assert_eq!(seen, 5);
}

/// Each parameter is refused by its key; and what is accepted, at its ends, is answered.
#[test]
fn sweeps_that_are_none_are_refused_by_key() {
    let (side, answered) = (Side::Below, Answered::Theta);
    // 2√(k² − 1), exactly.
    let separatrix = 1.5;
    for (family, from, to, key) in [
        (Family::SmallMomentum { k: 0.0 }, 1.0, 0.1, "family.small-momentum.k"),
        (Family::LargeMomentum { k: f64::NAN }, 1.0, 0.1, "family.large-momentum.k"),
        (Family::LargeMomentum { k: 1.2 }, 1.0, 1e-200, "to"),
        (Family::Separatrix { k: 1.0, side }, 0.1, 1e-3, "family.separatrix.k"),
        (Family::Separatrix { k: 1.2, side }, 0.1, 1e-17, "to"),
        (Family::EquatorCrossing { k: 1.15, side }, 0.1, 1e-3, "family.equator-crossing.k"),
        (Family::EquatorCrossing { k: 20.0, side }, 0.1, 1e-3, "family.equator-crossing.k"),
        (Family::Pole { p_theta: -0.5, passage: 1, side, answered }, 0.1, 1e-3, "family.pole.p_theta"),
        (Family::Pole { p_theta: 1e-4, passage: 0, side, answered }, 0.1, 1e-3, "family.pole.passage"),
        (Family::Pole { p_theta: 1e-4, passage: 4, side, answered }, 0.1, 1e-3, "family.pole.passage"),
        (Family::Round { p_theta: 0.0, side }, 0.1, 1e-3, "family.round.p_theta"),
        (Family::Round { p_theta: 0.5, side }, 1.0, 1e-3, "from"),
        (Family::LargeK { p_theta: -1.0 }, 0.1, 1e-3, "family.large-k.p_theta"),
        (Family::SmallK { p_theta: 1e100 }, 0.1, 1e-3, "family.small-k.p_theta"),
        (Family::LongTime { k: 1.0, p_theta: 1.0 }, 0.1, 1e-3, "family.long-time.k"),
        (Family::LongTime { k: 1.25, p_theta: separatrix }, 0.1, 1e-3, "family.long-time.p_theta"),
    ] {
        let refused = family.validate(from, to).unwrap_err();
        assert_eq!(refused.key, key, "{family:?}: {refused}");
        assert!(HardCasesSpin { family, from, to, per_decade: 1 }.cases().unwrap_err().to_string().contains(key));
    }
    for family in [
        Family::SmallMomentum { k: K.0 },
        Family::SmallMomentum { k: K.1 },
        Family::LargeMomentum { k: K.0 },
        Family::LargeMomentum { k: 100.0 },
        Family::Separatrix { k: 1.0 + f64::EPSILON, side },
        Family::Separatrix { k: K.1, side: Side::Above },
        Family::EquatorCrossing { k: 1.1548, side },
        Family::EquatorCrossing { k: LARGEST_K_OF_CROSSING, side },
        Family::Pole { p_theta: MOMENTUM.0, passage: 3, side, answered },
        Family::Pole { p_theta: LARGEST_MOMENTUM_OF_POLE, passage: 2, side, answered },
        Family::Round { p_theta: MOMENTUM.0, side },
        Family::Round { p_theta: MOMENTUM.1, side },
        Family::LargeK { p_theta: MOMENTUM.0 },
        Family::LargeK { p_theta: MOMENTUM.1 },
        Family::SmallK { p_theta: MOMENTUM.0 },
        Family::SmallK { p_theta: MOMENTUM.1 },
        Family::LongTime { k: K.0, p_theta: MOMENTUM.0 },
        Family::LongTime { k: K.1, p_theta: MOMENTUM.1 },
    ] {
        let (nearest, farthest) = family.ends();
        for (from, to) in [(nearest, nearest / 2.0), (farthest * 8.0, farthest)] {
            let cases = HardCasesSpin { family, from, to, per_decade: 1 }.cases().unwrap();
            assert!(cases.iter().all(|case| case.verdict() == Verdict::Stable && case.distance > 0.0), "{cases:?}");
        }
    }
}

#[test]
fn units_are_those_of_the_question() {
    let side = Side::Below;
    let pole = |answered| Family::Pole { p_theta: 1e-4, passage: 1, side, answered };
    assert_eq!((pole(Answered::Theta).unit(), pole(Answered::Time).unit()), ("rad", "time"));
    assert_eq!(Family::LongTime { k: 0.8, p_theta: 0.5 }.unit(), "rad");
    assert_eq!(Family::SmallK { p_theta: 0.5 }.unit(), "time");
}

/// The table has a row for each case, and the kind declares the code it reaches.
#[test]
fn the_node_makes_the_table() {
    let node = HardCasesSpin { family: Family::SmallMomentum { k: 0.1 }, from: 1.0, to: 1e-3, per_decade: 2 };
    let product = node.run(&Inputs::default()).unwrap();
    assert_eq!(product.work.rows, 7);
    assert!(product.work.elliptic_calls > 0 && product.work.roots_solved == 7);
    assert_eq!(undeclared(&KIND), Ok(vec![]));
}
