//! Values and claims of Fig. 9: conjugate times against the printed ones, the projection, and the agreement of the routes.

use super::{
    ARTICLE_CASES, ARTICLE_CURVE, LEVEL, NEEDED_START, POINT, POINT_CHECK, PROJECTION, Params, PrintedCase, Reduced,
    TIMES, TIMES_CHECK, given, is_article_body, of_case, printed, read,
};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::effects::rotation_group::start::tolerance;
use crate::effects::scene::{Effect, Inertia};
use crate::experiments::findings::{claim, largest, unread, value};
use crate::table::{Table, Tables};
use std::f64::consts::FRAC_PI_2;

const PLACE: &str = "section 5.3";
const CAPTION: &str = "caption of Figure 9";
const BEYOND: &str = "beyond the article";
const DERIVED: &str = "derived from the caption of Figure 9";
const ARTICLE_T1: f64 = 5.4177;
/// The same with two digits swapped.
const ARTICLE_T1_SWAPPED: f64 = 5.4717;

fn is_article_curve(params: &Params) -> bool {
    let Reduced { cosine_squared, p_x, p_y, h, .. } = params.projection;
    is_article_body(params) && [cosine_squared, p_x, p_y] == ARTICLE_CURVE && h == 1.0
}

/// The named values of what is asked for.
pub(super) fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
    let asks = |effect| params.scene.asks_for(effect);
    let mut values = Vec::new();
    if asks(Effect::ConjugateTimes) {
        time_values(params, tables, &mut values)?;
    }
    if asks(Effect::Projection) {
        projection_values(params, tables, &mut values)?;
    }
    let seconds = second_routes(tables);
    if !seconds.is_empty() {
        let (difference, _) = route_difference(&seconds)?;
        let meaning =
            format!("largest relative difference of a conjugate time between the routes, {} starts", seconds.len());
        let route = "SO(3): body frame against attitude; reduced: closed form against power series";
        values.push(value("largest_route_difference", (difference, 4.0 * f64::EPSILON), "1", &meaning, route));
    }
    Ok(values)
}

/// The claims of what is asked for.
pub(super) fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let asks = |effect| params.scene.asks_for(effect);
    let mut claims = Vec::new();
    if asks(Effect::ConjugateTimes) {
        time_claims(params, tables, &mut claims)?;
    }
    if asks(Effect::Projection) {
        projection_claims(params, tables, &mut claims)?;
    }
    let seconds = second_routes(tables);
    if !seconds.is_empty() {
        let (measured, tolerance) = route_difference(&seconds)?;
        let reason = "what two integrations to rounding give over a few turns".to_owned();
        let statement = "Two independent routes give the same conjugate times, on SO(3) and on the projection.";
        let test = Test::AtMost { measured, tolerance, reason };
        claims.push(claim(
            "routes_agree",
            "all conjugate times of this experiment",
            statement,
            Evidence::Direct(test),
            "",
        ));
    }
    Ok(claims)
}

fn time_values(params: &Params, tables: &Tables, values: &mut Vec<NamedValue>) -> Result<(), NodeError> {
    let route = "body frame, eigenphases; second route: variations of the attitude";
    let mut times = |table: &str, name: &str, what: &str| -> Result<(), NodeError> {
        let of = |column: &str| read(tables, table, column);
        let error = of("error")?;
        for (column, symbol, which) in [("t1", "tau", "first"), ("t2", "tau2", "second")] {
            let meaning = format!("{which} conjugate time on SO(3) of {what}");
            let time = of(column)?;
            values.push(value(format!("{symbol}_{name}"), (time, error * time), "time", meaning, route));
        }
        let rounding = 8.0 * f64::EPSILON;
        let (h, g) = (of("h")?, of("G")?);
        let from = "the momentum in the body";
        values.push(value(format!("h_{name}"), (h, rounding * h), "energy", format!("energy of {what}"), from));
        values.push(value(
            format!("G_{name}"),
            (g, rounding * g),
            "momentum",
            format!("size of the momentum of {what}"),
            from,
        ));
        Ok(())
    };
    for i in 0..params.scene.start.cases.len() {
        times(&of_case(TIMES, i), &format!("case_{}", i + 1), &format!("case {}", i + 1))?;
    }
    let level = format!("{TIMES}/case={LEVEL}");
    if tables.get(&level).is_ok() {
        let Reduced { h, .. } = params.projection;
        times(
            &level,
            LEVEL,
            &format!("the start that projects to p_x, cos²y of the curve on the level h = {h} exactly"),
        )?;
    }
    for (i, case) in params.scene.start.cases.iter().enumerate() {
        let Some(known) = printed(params, case) else { continue };
        let phi2 = read(tables, &of_case(NEEDED_START, i), "Phi2")?;
        let name = format!("phi2_for_printed_tau_case_{}", i + 1);
        let meaning = format!("Φ2 for which the first conjugate time of case {} is {} as printed", i + 1, known.tau.0);
        values.push(value(&name, (phi2, 1e-10), "rad", &meaning, "secant on the first route"));
    }
    Ok(())
}

fn projection_values(params: &Params, tables: &Tables, values: &mut Vec<NamedValue>) -> Result<(), NodeError> {
    let route = "closed form; second route: power series with a Jacobi field";
    let mut point = |table: &str, name: &str, what: &str| -> Result<(), NodeError> {
        let (t1, error) = (read(tables, table, "t1")?, read(tables, table, "t1_error")?);
        values.push(value(name, (t1, error * t1), "time", format!("first conjugate time of {what}"), route));
        Ok(())
    };
    point(&given(POINT), "t1_projected", "the reduced extremal as given")?;
    for i in 0..params.scene.start.cases.len() {
        let case = i + 1;
        let what = format!("the reduced extremal that case {case} projects to");
        point(&of_case(POINT, i), &format!("t1_projected_case_{case}"), &what)?;
    }
    let h = read(tables, &given(POINT), "h")?;
    let rounding = 8.0 * f64::EPSILON * h;
    values.push(value(
        "h_projected",
        (h, rounding),
        "energy",
        "energy of the reduced extremal as given",
        "the Hamiltonian of (9)",
    ));
    if params.scene.asks_for(Effect::Attitude) {
        let measured = transformation_error(params, tables)?;
        let meaning = "largest difference between an extremal on SO(3) transformed by section 2.4 and the reduced extremal, \
                       or after transformation and inverse";
        let route = "attitude integrated as a quaternion against the closed form";
        values.push(value("largest_projection_difference", (measured, 1e-14), "rad", meaning, route));
    }
    Ok(())
}

fn over_projections(params: &Params, tables: &Tables, columns: &[&str]) -> Result<f64, NodeError> {
    let mut all: f64 = 0.0;
    for i in 0..params.scene.start.cases.len() {
        let table = tables.get(&of_case(PROJECTION, i)).map_err(unread)?;
        for column in columns {
            all = all.max(largest(table, column)?);
        }
    }
    Ok(all)
}

fn transformation_error(params: &Params, tables: &Tables) -> Result<f64, NodeError> {
    over_projections(params, tables, &["angle_difference", "momentum_difference", "constants_difference", "round_trip"])
}

/// The tables of second routes that there are.
fn second_routes(tables: &Tables) -> Vec<&Table> {
    let of = |prefix: &'static str| tables.starting_with(prefix).map(|(_, table)| table);
    of(TIMES_CHECK).chain(of(POINT_CHECK)).collect()
}

/// The largest difference of a conjugate time between the routes, and the one that is allowed.
fn route_difference(seconds: &[&Table]) -> Result<(f64, f64), NodeError> {
    let (mut difference, mut allowed): (f64, f64) = (0.0, 0.0);
    for table in seconds {
        difference = difference.max(largest(table, "t1_difference")?);
        if table.has("t2_difference") {
            difference = difference.max(largest(table, "t2_difference")?);
        }
        allowed = allowed.max(largest(table, "allowed")?);
    }
    Ok((difference, allowed))
}

fn time_claims(params: &Params, tables: &Tables, claims: &mut Vec<Claim>) -> Result<(), NodeError> {
    for (i, case) in params.scene.start.cases.iter().enumerate() {
        let Some(known) = printed(params, case) else { continue };
        let (number, (printed, half)) = (i + 1, known.tau);
        let ours = read(tables, &of_case(TIMES, i), "t1")?;
        let change = read(tables, &of_case(NEEDED_START, i), "change")?;
        let test = |printed: f64, ours: f64| Test::Equal {
            printed,
            ours,
            tolerance: half,
            reason: "half a unit of the last printed digit".into(),
        };
        let note = format!(
            "Off by {:.1e}; two routes that share no equation agree on ours to rounding. Φ2 larger by {change:.1e} would give it; a change of \
             the time's scale would have to be one of {:.1e}, and √h is 1 + 3e-6 at most.",
            (printed - ours).abs(),
            (printed / ours - 1.0).abs(),
        );
        let statement = format!("The first conjugate time of case {number} is τ = {printed}.");
        let (unit, second) = (2.0 * half, read(tables, &of_case(TIMES, i), "t2")?);
        let mut claimed =
            claim(&format!("tau_case_{number}"), CAPTION, statement, Evidence::Direct(test(printed, ours)), note)
                .refusing("τ one unit of its last digit larger", test(printed + unit, ours))
                .refusing("τ is the second conjugate time", test(printed, second));
        for other in ARTICLE_CASES.iter().filter(|other| other.phi != known.phi) {
            claimed = claimed.refusing("the times of the two cases exchanged", test(other.tau.0, ours));
        }
        claims.push(claimed);
        claims.push(rounding_claim(number, known, change));
    }
    equal_times_claims(params, tables, claims)
}

/// Whether the rounding of the printed start is a reason for the printed τ: the change of Φ2 that would give it, against half a unit of
/// the last digit printed.
fn rounding_claim(number: usize, known: &PrintedCase, change: f64) -> Claim {
    let test = |explains: bool, half: f64| {
        let (measured, tolerance, what) = if explains {
            (change.abs(), half, "the change of Φ2 needed, against half a unit of its last printed digit")
        } else {
            (half, change.abs(), "half a unit of the last printed digit of Φ2, against the change needed")
        };
        let reason = format!("{what}; the digits of Φ3 and p3 move τ by 3e-6 at most");
        Test::AtMost { measured, tolerance, reason }
    };
    let half = known.phi2;
    if known.rounding_explains {
        let statement =
            format!("The printed τ of case {number} belongs to a start that is printed with the same digits of Φ2.");
        let note = "So the rounding of Φ2 could explain this τ; but the projected curve, p1 and h = 1 as printed give a Φ2 with our τ.";
        let evidence = Evidence::Direct(test(true, half));
        claim(&format!("tau_case_{number}_by_rounding"), BEYOND, statement, evidence, note)
            .refusing("no start with the same digits of Φ2 has it", test(false, half))
            .refusing("one with these digits of Φ2 and a zero more has it", test(true, half / 10.0))
    } else {
        let statement =
            format!("No start that is printed with the same digits of Φ2 as case {number} has the τ printed for it.");
        let note = "So rounding of the start does not explain this τ; it is unexplained.";
        let evidence = Evidence::Direct(test(false, half));
        claim(&format!("tau_case_{number}_not_by_rounding"), BEYOND, statement, evidence, note)
            .refusing("a start with the same digits of Φ2 has it", test(true, half))
            .refusing("nor has one with a digit of Φ2 less", test(false, 10.0 * half))
    }
}

/// Where two cases are the article's: their conjugate times are one number.
fn equal_times_claims(params: &Params, tables: &Tables, claims: &mut Vec<Claim>) -> Result<(), NodeError> {
    let cases = &params.scene.start.cases;
    let known: Vec<(usize, &PrintedCase)> =
        cases.iter().enumerate().filter_map(|(i, case)| Some((i, printed(params, case)?))).collect();
    let [(i, first), (j, second)] = known[..] else { return Ok(()) };
    let of = |index: usize, column: &str| read(tables, &of_case(TIMES, index), column);
    let times = [of(i, "t1")?, of(j, "t1")?];
    let second_times = [of(i, "t2")?, of(j, "t2")?];
    let printed_times = [first.tau.0, second.tau.0];
    let apart = |[a, b]: [f64; 2]| (a - b).abs();
    let printed = apart(printed_times);
    let mut momenta: f64 = 0.0;
    for column in ["M1", "M2", "M3"] {
        momenta = momenta.max((of(i, column)? - of(j, column)?).abs());
    }
    let tolerance = first.tau.1 + second.tau.1;
    let test = |printed: f64, times: [f64; 2]| {
        let reason = "half a unit of the last digits of both numbers".to_owned();
        Test::Equal { printed, ours: apart(times), tolerance, reason }
    };
    let statement =
        format!("The first conjugate times of both cases differ by {printed:.8}, as the two printed ones do.");
    let note = format!(
        "Not printed itself: it follows from the two printed times, and fails with them. Conjugate times depend on the momentum in the body alone; both cases start with the same one up to {momenta:.1e}, which is rounding \
         of the printed starts."
    );
    let claimed = claim("times_differ", DERIVED, statement, Evidence::Direct(test(printed, times)), note)
        .refusing("by as much with the decimal point one place to the left", test(printed / 10.0, times))
        .refusing("the second conjugate times differ by it", test(printed, second_times))
        .refusing("the first of case 1 and the second of case 2 do", test(printed, [times[0], second_times[1]]));
    claims.push(claimed);
    let test = |slope: f64, times: [f64; 2]| Test::AtMost {
        measured: apart(times),
        tolerance: slope * momenta,
        reason: format!("|∂τ/∂M| is below {slope} here, times the difference of the momenta in the body"),
    };
    let statement = "Both cases have the same first conjugate time, up to the rounding of their starts.";
    let note = "The start exactly on the curve's energy level has τ = tau_level, whatever k, K and Φ1 are.";
    let claimed = claim("times_equal", BEYOND, statement, Evidence::Direct(test(3.0, times)), note)
        .refusing("the two printed times are equal in this sense", test(3.0, printed_times))
        .refusing("equal with |∂τ/∂M| below 2", test(2.0, times))
        .refusing("the second of case 1 is the first of case 2", test(3.0, [second_times[0], times[1]]));
    claims.push(claimed);
    Ok(())
}

fn projection_claims(params: &Params, tables: &Tables, claims: &mut Vec<Claim>) -> Result<(), NodeError> {
    if params.scene.asks_for(Effect::Attitude) {
        claims.push(transformation_claim(params, tables)?);
    }
    if !is_article_curve(params) {
        return Ok(());
    }
    let curve = |column: &str| read(tables, &given(POINT), column);
    let start = |table: &str| -> Result<[f64; 4], NodeError> {
        let of = |column: &str| read(tables, table, column);
        Ok([of("x0")?, of("y0")?, of("p_x")?, of("p_y")?])
    };
    let mut starts = Vec::new();
    for (i, _) in params.scene.start.cases.iter().enumerate().filter(|(_, case)| printed(params, case).is_some()) {
        starts.push(start(&of_case(POINT, i))?);
    }
    if !starts.is_empty() {
        let test = |curve: [f64; 4]| {
            let off = |start: &[f64; 4]| start.iter().zip(curve).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            Test::AtMost {
                measured: starts.iter().map(off).fold(0.0, f64::max),
                tolerance: 5e-6,
                reason: "half a unit of the last printed digit of Φ3, the finest angle printed".to_owned(),
            }
        };
        let [x, y, p_x, p_y] = start(&given(POINT))?;
        let statement = "Both cases project on the curve with p_x = 1.1, p_y = 0.3155946, x = 0, y = arccos √0.1.";
        let note = "The largest difference of x, y, p_x, p_y at the start is that of p_x in case 1. y is meant mod π: section 2.4 with the \
                    right quadrant gives y − π, which (9) does not notice.";
        let claimed = claim("same_curve", PLACE, statement, Evidence::Direct(test([x, y, p_x, p_y])), note)
            .refusing("y = arccos 0.1", test([x, libm::acos(ARTICLE_CURVE[0]), p_x, p_y]))
            .refusing("y = arcsin √0.1", test([x, FRAC_PI_2 - y, p_x, p_y]))
            .refusing("p_y = −0.3155946", test([x, y, p_x, -p_y]));
        claims.push(claimed);
    }
    let Inertia { a, b, c } = params.scene.metric.rotation_group;
    let [cosine_squared, p_x, p_y] = ARTICLE_CURVE;
    // The Hamiltonian of (9) at the start.
    let energy = |cosine_squared: f64, p_y: f64| {
        let z = a + (b - a) * cosine_squared;
        0.5 * (p_x * p_x * z + p_y * p_y * (c - z))
    };
    let test = |level: f64, ours: f64| Test::Equal {
        printed: level,
        ours,
        tolerance: 4e-8,
        reason: "one unit of the last printed digit of p_y, 1e-7, times ∂h/∂p_y = 0.39".to_owned(),
    };
    let note = "h = 1 needs p_y = 0.31559468: the printed number is cut, not rounded.";
    let on_level = Evidence::Direct(test(1.0, energy(cosine_squared, p_y)));
    let claimed = claim("energy_level", PLACE, "This curve lies on the energy level h = 1.", on_level, note)
        .refusing("so it does with the last digit of p_y one lower", test(1.0, energy(cosine_squared, p_y - 1e-7)))
        .refusing("so it does with y = arccos 0.1", test(1.0, energy(cosine_squared * cosine_squared, p_y)))
        .refusing("on the energy level 2h = 1", test(0.5, energy(cosine_squared, p_y)));
    claims.push(claimed);
    let t1 = curve("t1")?;
    let half = 5e-5;
    let test = |printed: f64| Test::Equal {
        printed,
        ours: t1,
        tolerance: half,
        reason: "half a unit of the last printed digit".to_owned(),
    };
    let note = format!(
        "{:.1e} relative: the last digit printed is one too low. p_y exactly on h = 1 moves t1 by 7e-7 only, the starts of both cases by \
         3e-5 at most.",
        (ARTICLE_T1 / t1 - 1.0).abs()
    );
    let statement = "The first conjugate time of this curve is approximately 5.4177.";
    let claimed = claim("t1_projected", PLACE, statement, Evidence::Direct(test(ARTICLE_T1)), note)
        .refusing("one unit of the last digit less", test(ARTICLE_T1 - 2.0 * half))
        .refusing("two units of the last digit more", test(ARTICLE_T1 + 4.0 * half))
        .refusing("approximately 5.4717", test(ARTICLE_T1_SWAPPED));
    claims.push(claimed);
    Ok(())
}

fn transformation_claim(params: &Params, tables: &Tables) -> Result<Claim, NodeError> {
    // Angles and momenta lose 1/sin²Φ2 and 1/tilt², some tens, and steps add up: a thousand times the error of a step is ample.
    let tolerance = 1e-12_f64.max(1e3 * tolerance(params.scene.accuracy));
    let reason = "error of the integration, magnified where the body's axis is near e3 or near the momentum".to_owned();
    let at_most = |measured: f64| Test::AtMost { measured, tolerance, reason: reason.clone() };
    let form = |column: &str| over_projections(params, tables, &[column]).map(&at_most);
    let claimed = Claim {
        id: "transformation".to_owned(),
        place: "section 2.4".to_owned(),
        statement: "Φ1 = k + arctan((L − K cos Φ2)/(p2 sin Φ2)), Φ3 = l + arctan((K − L cos Φ2)/(p2 sin Φ2)) invert the Serret-Andoyer \
                    transformation; extremals on SO(3) project on those of (9)."
            .to_owned(),
        evidence: Evidence::Slip {
            printed: form("principal_value_difference")?,
            correction: "the arctangents in the quadrant of numerator and denominator".to_owned(),
            corrected: at_most(
                transformation_error(params, tables)?.max(over_projections(params, tables, &["quadrant_difference"])?),
            ),
        },
        note: "With the principal value l is off by π where p2 sin Φ2 < 0; (9) has period π in y and does not notice, the momentum in the \
               body changes sign."
            .to_owned(),
        wrong: Vec::new(),
    };
    Ok(claimed
        .refusing("Φ3 = l + arctan((L − K cos Φ2)/(p2 sin Φ2)), in its quadrant", form("exchanged_difference")?)
        .refusing("Φ3 = l + arctan((L cos Φ2 − K)/(p2 sin Φ2)), in its quadrant", form("opposite_difference")?))
}
