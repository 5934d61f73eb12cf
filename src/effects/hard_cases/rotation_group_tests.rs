use super::*;
use crate::contract::accuracy::ARTICLE;
use crate::effects::hard_cases::family::Verdict;

fn cases(family: Family) -> Vec<Case> {
    let to = family.farthest();
    HardCasesRotationGroup { family, body: INERTIA, from: 0.1, to, per_decade: 2 }.cases().unwrap()
}

/// Every case of every family: stable, the claim honest and not more than 100 times too large in the median; and what the naive
/// formulation loses at least (relative error at its worst), where it loses.
#[test]
fn ours_is_stable_in_every_family() {
    for (family, lost) in [
        (Family::NearSphere, 1.0),
        (Family::NearOblate, 1e-15),
        (Family::NearProlate, 1e-15),
        (Family::StableAxis, 1e-15),
        (Family::StableAxisFirst, 1e-15),
        (Family::MiddleAxis, 1e-15),
        (Family::SeparatingPolhode, 1e-15),
        (Family::EulerPole, 1e-10),
        (Family::EulerPoleLimit, 1e-11),
        (Family::LongTime, 1e-8),
        (Family::LargeAnisotropy, 1.0),
    ] {
        let cases = cases(family);
        let mut ratios = Vec::new();
        let mut naive = 0.0_f64;
        for case in &cases {
            assert_eq!(case.verdict(), Verdict::Stable, "{}: {case:?}", family.name());
            ratios.push(case.ours.claimed / case.error_of(case.ours.value).max(0.5 * f64::EPSILON));
            naive = naive.max(case.error_of(case.naive));
            assert!(case.condition >= 0.3 && case.condition < 1e17, "{}: {case:?}", family.name());
        }
        ratios.sort_by(f64::total_cmp);
        assert!(ratios[ratios.len() / 2] <= 100.0, "{}: {ratios:?}", family.name());
        assert!(naive >= lost, "{}: the naive formulation loses {naive:e}", family.name());
        assert!(cases.len() >= if family == Family::LongTime { 7 } else { 23 });
        assert!((cases[0].distance, cases[cases.len() - 1].distance) == (0.1, family.farthest()));
    }
}

/// Pairs of conjugate times are not seen by signs: at 1e-3 from the sphere and nearer the naive search passes them all.
#[test]
fn signs_miss_the_pairs_near_the_sphere() {
    let cases = cases(Family::NearSphere);
    let missed = cases.iter().filter(|case| case.distance < 1e-3).all(|case| case.error_of(case.naive) > 0.1);
    assert!(missed && cases[0].error_of(cases[0].naive) < 1e-12);
}

#[test]
fn ranges_and_bodies_that_are_none_are_refused() {
    let good = HardCasesRotationGroup { family: Family::LongTime, body: INERTIA, from: 0.1, to: 1e-3, per_decade: 1 };
    assert_eq!(good.cases().unwrap().len(), 3);
    for bad in [
        HardCasesRotationGroup { to: 1e-5, ..good },
        HardCasesRotationGroup { from: 1e-3, ..good },
        HardCasesRotationGroup { from: f64::NAN, ..good },
        HardCasesRotationGroup { per_decade: 0, ..good },
        HardCasesRotationGroup { body: Body { a: 1.0, b: 1.0, c: 2.0 }, ..good },
        HardCasesRotationGroup { body: Body { a: -1.0, ..INERTIA }, ..good },
    ] {
        let refused = bad.cases().unwrap_err().to_string();
        assert!(refused.len() > 20, "{refused}");
    }
    assert_eq!(serde_json::to_string(&Family::StableAxisFirst).unwrap(), "\"stable-axis-first\"");
    assert!(Family::ALL.iter().all(|family| serde_json::to_string(family).unwrap() == format!("{:?}", family.name())));
}

/// Oracle: `tests/oracle/hard_cases_rotation_group.json` (its `origin`), which no part of this crate computed.
#[test]
fn truth_and_answers_are_those_of_the_oracle() {
    let oracle: serde_json::Value =
        serde_json::from_str(include_str!("../../../tests/oracle/hard_cases_rotation_group.json")).unwrap();
    let points = oracle["points"].as_array().unwrap();
    assert!(points.len() >= 20);
    for point in points {
        let number = |key: &str| point[key].as_f64().unwrap();
        let posed = Posed {
            inertia: ["A", "B", "C"].map(number),
            momentum: Given3::Body(["H1", "H2", "H3"].map(number)),
            time: None,
        };
        let truth = first_two_conjugate_times_to_reference(&posed.start().unwrap()).unwrap();
        let answer = point::answer(point::Metric::RotationGroup, &posed.given(), ARTICLE).unwrap();
        for (i, key) in ["t1", "t2"].into_iter().enumerate() {
            let exact = decimal(point[key].as_str().unwrap());
            let off = |t: DoubleDouble| ((t - exact) / exact).to_f64().abs();
            let error = off(DoubleDouble::from_sum(truth.times[i], truth.rests[i]));
            // 30 digits are stored.
            assert!(error <= truth.error + 1e-28 && truth.error < 1e-18, "{point}: {error:e} {truth:?}");
            let found = answer.numbers[i].unwrap();
            assert!(off(DoubleDouble::from_sum(found, 0.0)) <= answer.error.unwrap(), "{point}: {answer:?}");
        }
    }
}

/// A decimal with more digits than an `f64`: `d.ddd…`, digit by digit.
fn decimal(text: &str) -> DoubleDouble {
    let ten = DoubleDouble::from_sum(10.0, 0.0);
    let (whole, part) = text.split_once('.').unwrap();
    let (mut sum, mut unit) = (DoubleDouble::from_sum(0.0, 0.0), DoubleDouble::from_sum(1.0, 0.0));
    for digit in whole.bytes().chain(part.bytes()) {
        sum = sum * ten + DoubleDouble::from_sum(f64::from(digit - b'0'), 0.0);
    }
    for _ in 0..part.len() {
        unit *= ten;
    }
    sum / unit
}
