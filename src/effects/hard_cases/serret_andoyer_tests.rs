use super::*;
use crate::effects::hard_cases::family::Verdict;
use serde_json::Value;

const CASES: &str = include_str!("../../../tests/oracle/hard_cases_serret_andoyer.json");
const GIVEN: &str = include_str!("../../../tests/oracle/hard_cases.json");

/// The article's.
const INERTIA: Body = Body { a: 1.5, b: 2.0, c: 2.8 };
const ALL: [Family; 12] = [
    Family::Separatrix,
    Family::SeparatrixMomenta,
    Family::Cusp,
    Family::Equator,
    Family::StripEnd,
    Family::StripEndWithSeparatrix,
    Family::NearOblate,
    Family::NearProlate,
    Family::NearProlateMomenta,
    Family::NearSphere,
    Family::ThirdKind,
    Family::LongTime,
];

/// The distances between which a family is of interest.
fn ends(family: Family) -> (f64, f64) {
    let from = match family {
        Family::Cusp | Family::Equator => 0.05,
        Family::LongTime => 1.0,
        _ => 0.1,
    };
    (from, family.farthest().max(1e-16))
}

fn cases(family: Family) -> Vec<Case> {
    let (from, to) = ends(family);
    HardCasesSerretAndoyer { family, body: INERTIA, from, to, per_decade: 6 }.cases().unwrap()
}

/// What the naive formulation loses on its way to the limit: at least this much at some case. Of the families that are not here it loses
/// nothing: there t1 is well conditioned, and what cancels in the printed formulas is multiplied by zero.
const LOST: [(Family, f64); 9] = [
    (Family::Separatrix, 1e-4),
    (Family::SeparatrixMomenta, 1e-3),
    (Family::StripEnd, 0.99),
    (Family::StripEndWithSeparatrix, 0.99),
    (Family::NearOblate, 1e-3),
    (Family::NearProlateMomenta, 1e-5),
    (Family::NearSphere, 1e-3),
    (Family::ThirdKind, 1e-2),
    (Family::LongTime, 0.1),
];

#[test]
fn every_case_of_every_family_is_stable_and_honest() {
    for family in ALL {
        let (from, to) = ends(family);
        let cases = cases(family);
        let decades = libm::log10(from / to);
        assert!(decades >= 9.0 && cases.len() as f64 >= 6.0 * decades, "{family:?}: {} cases", cases.len());
        for case in &cases {
            assert_eq!(case.verdict(), Verdict::Stable, "{family:?}: {case:?}");
            // δ is an input: nothing may be lost with it.
            if family == Family::Separatrix {
                assert!(case.error_of(case.ours.value) <= 1e-13 && case.ours.claimed <= 1e-13, "{case:?}");
            }
        }
        let lost = cases.iter().map(|case| case.error_of(case.naive)).fold(0.0, f64::max);
        if let Some((_, least)) = LOST.iter().find(|(of, _)| *of == family) {
            assert!(lost >= *least, "{family:?}: naive loses {lost:e} only");
        }
    }
}

/// f64 is enough wherever the inputs say how near the limit is; where momenta hide it, or the edge of the strip is a rounding away, it is not.
#[test]
fn double_double_is_for_what_rounding_hides() {
    for family in ALL {
        let long = |case: &Case| case.route.contains("double-double");
        let cases = cases(family);
        let hidden = [Family::SeparatrixMomenta, Family::StripEnd, Family::StripEndWithSeparatrix].contains(&family);
        let taken = cases.iter().filter(|case| long(case)).count();
        assert_eq!(taken > 0, hidden, "{family:?}: {taken} of {}", cases.len());
        assert!(!long(&cases[0]) && taken * 3 <= cases.len(), "{family:?}: {taken} of {}", cases.len());
    }
}

fn posed_of(entry: &Value) -> (Posed, DoubleDouble) {
    let inputs = &entry["inputs"];
    let number = |key: &str| inputs[key].as_f64();
    let at = |key: &str| number(key).unwrap();
    let branch = if inputs["branch"] == "descending" { Branch::Descending } else { Branch::Ascending };
    let start = match (number("y0"), number("delta")) {
        (Some(y0), _) => Start::Momenta { y0, p_x: at("p_x"), p_y: at("p_y") },
        (_, Some(delta)) => Start::Darboux { phi0: at("phi0"), clairaut: Clairaut::Delta(delta), branch },
        _ => Start::Darboux { phi0: at("phi0"), clairaut: Clairaut::PTheta(at("p_theta")), branch },
    };
    let (asked, key) = match (entry["t"].as_f64(), entry["family"].as_str()) {
        (Some(t), _) => (Asked::Phi(t), "phi"),
        (None, Some("third-kind")) => (Asked::ConjugateX, "x"),
        _ => (Asked::ConjugateTime, "t1"),
    };
    let nearest: f64 = entry[key].as_str().unwrap().parse().unwrap();
    let rest = entry[format!("{key}_rest")].as_f64().unwrap();
    (Posed { inertia: [at("A"), at("B"), at("C")], start, asked }, DoubleDouble::from_sum(nearest, rest))
}

/// Oracle: 60 cases of all families by mpmath with 90 digits, by the printed constants and the equation of `numerics.md`
/// (`tests/oracle/README.md`). The truth of every family is held to 1e-27 times its condition, ours to the definition of stable.
#[test]
fn truth_and_answers_against_other_formulas_with_90_digits() {
    let document: Value = serde_json::from_str(CASES).unwrap();
    let entries = document["cases"].as_array().unwrap();
    assert_eq!(entries.len(), 5 * ALL.len());
    for entry in entries {
        let (posed, exact) = posed_of(entry);
        let truth = posed.truth();
        let condition = posed.condition(truth);
        let off = ((truth - exact) / exact).to_f64().abs();
        assert!(off <= 1e-27 * (1.0 + condition), "{entry}: truth is off by {off:e}, condition {condition:e}");
        let (ours, route, _) = posed.ours();
        let error = ((DoubleDouble::from_f64(ours.value) - exact) / exact).to_f64().abs();
        assert!(
            error <= 20.0 * f64::EPSILON * (1.0 + condition),
            "{entry}: {error:e}, condition {condition:e}, {route}"
        );
        assert!(error <= ours.claimed, "{entry}: {error:e} > {:e}", ours.claimed);
    }
}

/// `1-1e-8`, `2-1e-3`, `0.5`, `pi/2`, `arccos sqrt(.1)` of the given file.
fn read(text: &str) -> f64 {
    match text {
        "pi/2" => std::f64::consts::FRAC_PI_2,
        "arccos sqrt(.1)" => libm::acos(libm::sqrt(0.1)),
        _ => match text.split_once("-1e") {
            Some((whole, exponent)) => whole.parse::<f64>().unwrap() - format!("1e{exponent}").parse::<f64>().unwrap(),
            None => text.parse().unwrap(),
        },
    }
}

/// Oracle: the values given with the project, 30 digits. Their inputs are no doubles: the nearest doubles of `δ` and φ0 are asked, and the
/// difference is what one rounding of these, and of A beside B, is allowed.
#[test]
fn given_values() {
    let document: Value = serde_json::from_str(GIVEN).unwrap();
    let mut compared = 0;
    for entry in document.as_array().unwrap() {
        let (params, value) = (&entry["params"], &entry["value"]);
        let (Some(t1), Some(xi1), Some(y0)) = (value["t1"].as_str(), params["xi1"].as_str(), params["y0"].as_str())
        else {
            continue;
        };
        let t1: f64 = t1.parse().unwrap();
        let a = params["A"].as_str().map_or(INERTIA.a, read);
        let (b, c) = (INERTIA.b, INERTIA.c);
        // 1 − ξ1 as it is written, and δ = (1 − ξ1)(B − A)/(B − (1 − ξ1)(B − A)).
        let less = xi1.strip_prefix("1-").map_or_else(|| 1.0 - read(xi1), |less| less.parse().unwrap());
        let gap = less * (b - a);
        let metric = Metric::new(a, b, c).unwrap();
        let phi0 = if y0 == "pi/2" { 0.0 } else { metric.phi_of_y(read(y0)) };
        let branch = if params["ascending"] == false { Branch::Descending } else { Branch::Ascending };
        let start = Start::Darboux { phi0, clairaut: Clairaut::Delta(gap / (b - gap)), branch };
        let posed = Posed { inertia: [a, b, c], start, asked: Asked::ConjugateTime };
        let (ours, _, _) = posed.ours();
        let error = (ours.value / t1 - 1.0).abs();
        assert!(error <= 20.0 * f64::EPSILON * (1.0 + posed.condition(posed.truth())), "{entry}: {error:e}");
        // With δ as the input, near the separatrix: the bound that is promised.
        if a == INERTIA.a {
            assert!(error <= 1e-13, "{entry}: {error:e}");
        }
        compared += 1;
    }
    assert_eq!(compared, 19);
}

#[test]
fn sweeps_that_are_none_are_refused_by_key() {
    let flat = Body { a: 1.0, b: 100.0, c: 1000.0 };
    for (family, body, from, to, key, word) in [
        (Family::Cusp, INERTIA, 0.05, 1e-17, "to", "1e-16"),
        (Family::NearOblate, INERTIA, 0.1, 1e-16, "to", "1e-15"),
        (Family::Cusp, INERTIA, 0.1, 0.2, "to", "below 0.1"),
        (Family::Cusp, INERTIA, 2.0, 0.1, "from", "at most 1.0"),
        // The first case has no answer: it rotates; the body is none; the strip of this body is narrower than φ0.
        (Family::Cusp, INERTIA, 0.2, 0.1, "from", "rotat"),
        (Family::NearOblate, INERTIA, 1.0, 0.1, "from", "A < B < C"),
        (Family::Separatrix, flat, 0.1, 1e-3, "from", "|phi0|"),
    ] {
        let refused = family.validate(body, from, to).unwrap_err();
        assert!(refused.key == key && refused.accepted.contains(word), "{refused}");
        let node = HardCasesSerretAndoyer { family, body, from, to, per_decade: 3 };
        assert!(node.cases().unwrap_err().to_string().contains(word), "{refused}");
    }
    assert!(ALL.iter().all(|family| family.validate(INERTIA, ends(*family).0, family.farthest()).is_ok()));
}

/// δ is exact however small it is; x is an angle there, φ a length, everything else a time.
#[test]
fn the_separatrix_goes_as_far_as_it_says_and_units_are_those_of_the_question() {
    let node =
        HardCasesSerretAndoyer { family: Family::Separatrix, body: INERTIA, from: 1e-190, to: 1e-200, per_decade: 1 };
    assert!(node.cases().unwrap().iter().all(|case| case.verdict() == Verdict::Stable));
    let with = |unit: &str| ALL.iter().copied().filter(|family| family.unit() == unit).collect::<Vec<_>>();
    assert_eq!((with("rad"), with("length")), (vec![Family::ThirdKind], vec![Family::LongTime]));
    assert_eq!(with("time").len(), 10);
}

#[test]
fn the_kind_declares_its_code() {
    assert_eq!(crate::contract::code::undeclared(&KIND), Ok(vec![]));
}
