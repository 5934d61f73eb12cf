//! Claims of Fig. 4: the printed switches, how they lie, their limits, and that θ is 0 or π.

use super::{CURVE, Check, Params, SWITCHES_CHECK, Switch, at, momenta, switches};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::effects::scene::Effect;
use crate::experiments::findings::{Cases, claim, unread};
use crate::table::Tables;
use std::f64::consts::{FRAC_PI_2, PI};

const PLACE: &str = "section 5.2.1, Fig. 4";
/// An angle counts as one of the values asked for when it is this near: a thousandth of a radian, invisible in the figure.
const NEAR: f64 = 1e-3;
/// The last printed digit of the switches.
const LAST_DIGIT: f64 = 1e-3;

/// The claims of what is asked for.
pub(super) fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let mut claims = Vec::new();
    if params.scene.asks_for(Effect::SwitchPoints) {
        claims.extend(printed_switches(&switches(tables, params.scene.start.p_theta)?));
        claims.extend(limit_claim(params, tables)?);
        claims.push(switch_routes_agree(params, tables)?);
    }
    if params.scene.asks_for(Effect::ConjugateLocus) {
        claims.push(meridian_claim(tables)?);
        claims.push(curve_routes_agree(tables)?);
    }
    Ok(claims)
}

/// What the article prints about k1, k2, k3 and k̄.
fn printed_switches(found: &[Switch]) -> Vec<Claim> {
    let poles: Vec<&Switch> = found.iter().filter(|switch| switch.pole).collect();
    let mut claims: Vec<Claim> =
        poles.iter().zip([1.061, 1.250, 1.429]).map(|(switch, printed)| printed_claim(switch, printed)).collect();
    claims.push(count_claim(found));
    let [first, second, third] = poles[..] else { return claims };
    claims.push(steps_claim([first, second, third]));
    claims.extend(equator_claim(found, [first, second, third]));
    claims
}

/// A switch as it is printed.
fn printed_claim(switch: &Switch, printed: f64) -> Claim {
    let name = switch.name();
    let says = |printed: f64| format!("{name} is approximately {printed:.3}.");
    let test = |printed: f64| {
        let reason = "half a unit of the last printed digit".to_owned();
        Test::Equal { printed, ours: switch.k, tolerance: 0.5 * LAST_DIGIT, reason }
    };
    let (lower, higher) = (printed - LAST_DIGIT, printed + LAST_DIGIT);
    claim(&name, PLACE, says(printed), Evidence::Direct(test(printed)), "")
        .refusing(says(lower), test(lower))
        .refusing(says(higher), test(higher))
}

/// How often θ switches.
fn count_claim(found: &[Switch]) -> Claim {
    let test = |times: f64, counts: &dyn Fn(&Switch) -> bool| {
        let ours = found.iter().filter(|switch| counts(switch)).count() as f64;
        let reason = "a count; the range of k is scanned for every whole turn".to_owned();
        Test::Equal { printed: times, ours, tolerance: 0.0, reason }
    };
    let at_poles = |switch: &Switch| switch.pole;
    let statement = "θ of the first conjugate point switches three times for k in [1, 1.5].";
    claim("three_switches", PLACE, statement, Evidence::Direct(test(3.0, &at_poles)), "")
        .refusing("It switches twice.", test(2.0, &at_poles))
        .refusing("It switches four times.", test(4.0, &at_poles))
        .refusing("It switches three times for k in [1, 1.4].", test(3.0, &|switch| switch.pole && switch.k <= 1.4))
        .refusing("It switches where the point passes the equator, too: three times in all.", test(3.0, &|_| true))
}

/// That the steps from switch to switch differ.
fn steps_claim([first, second, third]: [&Switch; 3]) -> Claim {
    let (below, above) = (second.k - first.k, third.k - second.k);
    let known = first.error + 2.0 * second.error + third.error;
    let test =
        |holds: &dyn Fn(f64) -> bool| Cases::of([(holds(above - below), format!("{below:?} and {above:?}"))]).test();
    let differ = test(&|growth| growth.abs() > known);
    let note = format!("They are {below:.12} and {above:.12}.");
    claim("unequal_steps", PLACE, "k2 − k1 differs from k3 − k2.", Evidence::Direct(differ), note)
        .refusing("k2 − k1 equals k3 − k2.", test(&|growth| growth.abs() <= known))
        .refusing("k3 − k2 is the larger of them.", test(&|growth| growth > known))
}

/// Where the conjugate point crosses the equator.
fn equator_claim(found: &[Switch], [first, second, third]: [&Switch; 3]) -> Option<Claim> {
    let bars: Vec<&Switch> = found.iter().filter(|switch| !switch.pole).collect();
    let bar = *bars.first()?;
    let test =
        |low: f64, bar: &Switch, high: f64| Cases::of([(low < bar.k && bar.k < high, format!("{:?}", bar.k))]).test();
    let between = test(first.k, bar, second.k);
    let statement = "The conjugate point crosses the equator at a k̄ between k1 and k2.";
    let note = "A second crossing, k̄', lies between k2 and k3.";
    let mut claim = claim("k_bar_between", PLACE, statement, Evidence::Direct(between), note)
        .refusing("k̄ lies between k2 and k3.", test(second.k, bar, third.k))
        .refusing("k̄ lies between 1 and k1.", test(1.0, bar, first.k));
    if let Some(prime) = bars.get(1) {
        claim = claim.refusing("k̄', too, lies between k1 and k2.", test(first.k, prime, second.k));
    }
    Some(claim)
}

fn limit_claim(params: &Params, tables: &Tables) -> Result<Option<Claim>, NodeError> {
    let Some(smallest) = params.limit.p_theta.iter().copied().reduce(f64::min) else { return Ok(None) };
    let found = switches(tables, smallest)?;
    let test = |at_pole: &dyn Fn(f64) -> f64, at_equator: &dyn Fn(f64) -> f64| {
        let apart = found.iter().map(|switch| {
            let n = switch.index as f64;
            let limit = if switch.pole { at_pole(n) } else { at_equator(n) };
            (switch.k - limit).abs() - switch.error
        });
        Test::AtMost {
            measured: apart.fold(0.0, f64::max),
            tolerance: smallest * smallest + 2.0 * f64::EPSILON,
            reason: format!(
                "they differ from their limits by less than p_θ², here for p_θ = {smallest:?}, and rounding"
            ),
        }
    };
    let at_pole = |n: f64| (2.0 * n + 1.0) / (8.0 * n).sqrt();
    let at_equator = |n: f64| n / (2.0 * n - 1.0).sqrt();
    let limits = claim(
        "limits",
        "beyond the article",
        "For p_θ → 0 the switch points tend to (2n+1)/√(8n) (poles) and n/√(2n−1) (equator).",
        Evidence::Direct(test(&at_pole, &at_equator)),
        "On the meridian w tan t = tan(wt), w² = 1 − 1/k²; a pole is t = (n+½)π, w = (2n−1)/(2n+1), the equator \
         t = nπ, w = (n−1)/n.",
    );
    let limits = limits
        .refusing("(2n+3)/√(8n+8) at the poles", test(&|n| at_pole(n + 1.0), &at_equator))
        .refusing("(2n+1)/√(8n+1) at the poles", test(&|n| (2.0 * n + 1.0) / (8.0 * n + 1.0).sqrt(), &at_equator))
        .refusing("n/√(2n+1) on the equator", test(&at_pole, &|n| n / (2.0 * n + 1.0).sqrt()));
    Ok(Some(limits))
}

fn switch_routes_agree(params: &Params, tables: &Tables) -> Result<Claim, NodeError> {
    let (mut measured, mut tolerance): (f64, f64) = (0.0, 0.0);
    for (p_theta, _) in momenta(params) {
        let check = tables.get(&at(SWITCHES_CHECK, p_theta)).map_err(unread)?;
        measured = check.f64s("difference").map_err(unread)?.iter().copied().fold(measured, f64::max);
        tolerance = check.f64s("allowed").map_err(unread)?.iter().copied().fold(tolerance, f64::max);
    }
    let reason = "the closed form's own error in k, a few units in its last place".to_owned();
    let statement = "Closed form and integration give the same switch points.";
    let test = Test::AtMost { measured, tolerance, reason };
    Ok(claim("switch_routes_agree", "all switch points of this experiment", statement, Evidence::Direct(test), ""))
}

fn meridian_claim(tables: &Tables) -> Result<Claim, NodeError> {
    let table = tables.get(CURVE).map_err(unread)?;
    let column = |name: &str| table.f64s(name).map_err(unread);
    let (k, theta, phi) = (column("k")?, column("theta")?, column("phi")?);
    let whole = k.last().zip(k.first()).map_or(0.0, |(last, first)| last - first);
    let test = |angle: &[f64], values: &[f64]| {
        Test::AtMost {
        measured: width_off(k, angle, values) / whole,
        tolerance: 1e-6,
        reason: "share of the range of k in which the angle is farther than 1e-3 rad from these values; the figure shows no less \
                 than 1e-3"
            .to_owned(),
    }
    };
    let statement = "θ of the first conjugate point only takes approximately the values 0 and π: it lies on the \
                     meridian of the start.";
    let width = width_off(k, theta, &[0.0, PI]);
    let note = format!(
        "θ passes continuously from π to 0 and back, since r3 is of order p_θ³ and not 0; it is farther than 1e-3 rad \
         from both within less than {width:.1e} of k in all."
    );
    Ok(claim("theta_is_0_or_pi", PLACE, statement, Evidence::Direct(test(theta, &[0.0, PI])), note)
        .refusing("θ only takes the value 0.", test(theta, &[0.0]))
        .refusing("θ only takes the values 0 and π/2.", test(theta, &[0.0, FRAC_PI_2]))
        .refusing("φ only takes the values 0 and π.", test(phi, &[0.0, PI])))
}

fn curve_routes_agree(tables: &Tables) -> Result<Claim, NodeError> {
    let check = Check::read(tables)?;
    let test = Test::AtMost {
        measured: check.in_bounds,
        tolerance: 1.0,
        reason: "in units of what each row allows: a hundred times the accuracy asked for (1e-12), or the closed \
                 form's own bound next to the vertical tangents at the equator"
            .to_owned(),
    };
    let statement = "Closed form and integration give the same conjugate times.";
    let note = format!("{} of {} rows needed double-double.", check.long, check.rows);
    Ok(claim("routes_agree", "all conjugate times of this experiment", statement, Evidence::Direct(test), note))
}

/// The length of the parts of the range of k whose ends are not both near the same of some values of an angle.
fn width_off(k: &[f64], angle: &[f64], values: &[f64]) -> f64 {
    let nearest = |angle: f64| values.iter().position(|value| (angle.abs() - value).abs() < NEAR);
    let pairs = k.windows(2).zip(angle.windows(2));
    let off = pairs.filter(|(_, angle)| nearest(angle[0]).is_none() || nearest(angle[0]) != nearest(angle[1]));
    off.map(|(k, _)| k[1] - k[0]).sum()
}
