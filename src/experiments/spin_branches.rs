//! What the figures of spin conjugate loci (Figs. 5, 7, 8) share: the nodes of a branch, its table unpacked, its values and claims.
//!
//! A branch is `p_φ(0) = −2`, `p_θ(0) ≥ 0`. For equal k and equal sampling all figures ask for equal nodes, so the work is done once. The other
//! three branches are mirror images, made here: `p_θ < 0` is `θ → −θ`, `p_φ = +2` is `φ → π − φ`.

use super::findings::{claim, unread, value};
use super::nodes::{Nodes, TableRef};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::Invalid;
use crate::contract::node::NodeError;
use crate::contract::sweep::Sweep;
use crate::contract::value::NamedValue;
use crate::effects::spin::by_integration::{self, ConjugateLocusByIntegration};
use crate::effects::spin::conjugate_locus::ConjugateLocus;
use crate::effects::spin::contact::contact_coefficient;
use crate::effects::spin::double_points::DoublePoints;
use crate::effects::spin::momenta::Momenta;
use crate::plot::axis::Axis;
use crate::plot::mark::Curve;
use crate::plot::picture::{Inset, Place};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use std::f64::consts::{FRAC_PI_2, PI};

/// The table of a branch.
pub const LOCUS: &str = "conjugate-locus";
/// The table of its second route.
pub const BY_INTEGRATION: &str = "conjugate-locus-by-integration";
/// The table of its double points.
pub const DOUBLE_POINTS: &str = "double-points";
/// The table of their second route.
pub const DOUBLE_POINTS_BY_INTEGRATION: &str = "double-points-by-integration";

/// The name of a table of one k.
pub fn name_of(table: &str, k: f64) -> String {
    format!("{table}/k={k:?}")
}

/// Which config keys the parameters of a node of one k came from.
pub fn origins(sweep: &Sweep, index: usize) -> Vec<(&'static str, String)> {
    let mut origins = vec![("k", sweep.key_of("scene.metric.spin.k", index))];
    for (leaf, key) in [("p_theta.from", "from"), ("p_theta.to", "to"), ("p_theta.step", "step")] {
        origins.push((leaf, format!("scene.start.p_theta.{key}")));
    }
    origins
}

/// Asks for the branch of one k and its second route.
///
/// # Errors
/// Parameters that can't be written as a manifest.
pub fn ask_for_branch(
    nodes: &mut Nodes,
    (sweep, index): (&Sweep, usize),
    p_theta: Momenta,
    accuracy: Accuracy,
) -> Result<TableRef, NodeError> {
    let k = sweep.values()[index];
    let axes = [("k", format!("{k:?}"))];
    let origins = origins(sweep, index);
    let locus = nodes.add(LOCUS, &axes, ConjugateLocus { k, p_theta: p_theta.into() }, &[], &origins)?;
    let second = ConjugateLocusByIntegration::new(k, accuracy);
    nodes.add(BY_INTEGRATION, &axes, second, &[(by_integration::INPUT, &locus)], &origins[..1])?;
    Ok(locus)
}

/// Refuses panels whose values of k are not those of the scene: no panel, more than `most`, none or more than four values in one, a value twice or one
/// that is not in the scene; and a value of the scene that no panel shows.
///
/// # Errors
/// The first of these.
pub fn validate_panels(scene: &Sweep, panels: &[&Vec<f64>], most: usize) -> Result<(), Invalid> {
    let known = scene.values();
    let accepted = format!("1 to {most} tables [[panels]]");
    Invalid::unless((1..=most).contains(&panels.len()), "panels", format!("{} panels", panels.len()), accepted)?;
    for (i, group) in panels.iter().enumerate() {
        let key = format!("panels[{i}].k");
        Invalid::unless((1..=4).contains(&group.len()), &key, format!("{group:?}"), "a list of 1 to 4 values")?;
        for (j, k) in group.iter().enumerate() {
            let accepted = format!("a value of scene.metric.spin.k: {known:?}");
            Invalid::number(known.contains(k), format!("{key}[{j}]"), *k, accepted)?;
            Invalid::number(!group[..j].contains(k), format!("{key}[{j}]"), *k, "each value once in a panel")?;
        }
    }
    for (i, k) in known.iter().enumerate() {
        let shown = panels.iter().any(|group| group.contains(k));
        Invalid::number(
            shown,
            scene.key_of("scene.metric.spin.k", i),
            *k,
            "values that a panel shows: add it to a panel's k",
        )?;
    }
    Ok(())
}

/// Asks for the double points of the branch of one k and their second route.
///
/// # Errors
/// Parameters that can't be written as a manifest.
pub fn ask_for_double_points(
    nodes: &mut Nodes,
    (sweep, index): (&Sweep, usize),
    p_theta: Momenta,
    accuracy: Accuracy,
) -> Result<(), NodeError> {
    let k = sweep.values()[index];
    let axes = [("k", format!("{k:?}"))];
    let origins = origins(sweep, index);
    let points = nodes.add(DOUBLE_POINTS, &axes, DoublePoints { k, p_theta }, &[], &origins)?;
    let second = ConjugateLocusByIntegration::new(k, accuracy);
    nodes.add(DOUBLE_POINTS_BY_INTEGRATION, &axes, second, &[(by_integration::INPUT, &points)], &origins[..1])?;
    Ok(())
}

/// A double point as its table holds it.
pub struct DoublePoint {
    /// The ratio of the couplings.
    pub k: f64,
    /// The two momenta with bounds on their relative errors, the smaller first.
    pub p_theta: [(f64, f64); 2],
    /// Where it stands in the chart.
    pub place: (f64, f64),
    /// Where it stands on the sphere, the pole `r2 = 1` up.
    pub on_sphere: [f64; 3],
    /// A bound on the error of its place.
    pub error: f64,
}

/// The double points of one k.
///
/// # Errors
/// No such table, or one of another form.
pub fn double_points(tables: &Tables, k: f64) -> Result<Vec<DoublePoint>, NodeError> {
    let table = tables.get(&name_of(DOUBLE_POINTS, k)).map_err(unread)?;
    let column = |name: &str| table.f64s(name).map_err(unread);
    let (p, p_error, theta, phi) = (column("p_theta")?, column("p_theta_error")?, column("theta")?, column("phi")?);
    let (r1, r2, r3, error) = (column("r1")?, column("r2")?, column("r3")?, column("place_error")?);
    let at = |row: usize| DoublePoint {
        k,
        p_theta: [(p[row], p_error[row]), (p[row + 1], p_error[row + 1])],
        place: (theta[row], phi[row]),
        on_sphere: [r1[row], r3[row], r2[row]],
        error: error[row],
    };
    Ok((0..table.rows() / 2).map(|i| at(2 * i)).collect())
}

/// Place and momenta of double points, as named values.
pub fn double_point_values(points: &[DoublePoint]) -> Vec<NamedValue> {
    let mut values = Vec::new();
    for (i, point) in points.iter().enumerate() {
        // Several of one k are told apart by their number.
        let rank = points[..i].iter().filter(|other| other.k == point.k).count();
        let number = if rank > 0 { format!("_{}", rank + 1) } else { String::new() };
        let [(p_a, a), (p_b, b)] = point.p_theta;
        for (name, found, unit, error, meaning) in [
            ("p_a", p_a, "1", a * p_a, "smaller p_theta of the double point of the branch"),
            ("p_b", p_b, "1", b * p_b, "larger p_theta of the double point of the branch"),
            ("theta", point.place.0, "rad", point.error, "θ of the double point of the branch"),
            ("phi", point.place.1, "rad", point.error, "φ of the double point of the branch"),
        ] {
            let (name, meaning) =
                (format!("double_point{number}_{name}_k={:?}", point.k), format!("{meaning}, k = {:?}", point.k));
            let route = "Newton on two momenta with equal conjugate points (closed form); integration as second route";
            values.push(value(name, (found, error), unit, meaning, route));
        }
    }
    values
}

/// The switches of section 5.2.1 in the limit `p_θ → 0`, where they are elementary.
pub struct Switches {
    /// The cusp passes the pole φ = π.
    pub k1: f64,
    /// The cusp passes the equator.
    pub k_bar: f64,
    /// The cusp passes the pole φ = 0.
    pub k2: f64,
    /// The cusp passes the pole φ = π again.
    pub k3: f64,
}

/// The switches: `t1` is 3π/2, 2π, 5π/2 and 7π/2, and `w tan t1 = tan(w t1)` with `w² = 1 − 1/k²`.
pub fn switches() -> Switches {
    Switches { k1: 3.0 / 8.0_f64.sqrt(), k_bar: 2.0 / 3.0_f64.sqrt(), k2: 1.25, k3: 7.0 / 24.0_f64.sqrt() }
}

/// The columns of a branch, in order of ascending `p_θ`, `p_θ = 0` first.
pub struct Branch<'a> {
    /// The ratio of the couplings.
    pub k: f64,
    /// `p_θ(0)`.
    pub p_theta: &'a [f64],
    /// First conjugate time.
    pub t1: &'a [f64],
    /// θ there, continuous.
    pub theta: &'a [f64],
    /// φ there.
    pub phi: &'a [f64],
    /// The point there.
    pub r: [&'a [f64]; 3],
    /// Relative error of `t1`.
    pub error: &'a [f64],
}

impl<'a> Branch<'a> {
    /// The branch of one k among the tables.
    ///
    /// # Errors
    /// No such table, or one of another form.
    pub fn of(tables: &'a Tables, k: f64) -> Result<Self, NodeError> {
        let table = tables.get(&name_of(LOCUS, k)).map_err(unread)?;
        let column = |name: &str| table.f64s(name).map_err(unread);
        if table.rows() < 2 {
            return Err(NodeError::new(format!("k = {k:?}: the branch has fewer than two points")));
        }
        Ok(Self {
            k,
            p_theta: column("p_theta")?,
            t1: column("t1")?,
            theta: column("theta")?,
            phi: column("phi")?,
            r: [column("r1")?, column("r2")?, column("r3")?],
            error: column("error")?,
        })
    }

    /// The branch in the chart from its cusp at `p_θ = 0` to its start, which is the limit `p_θ → ∞`.
    pub fn chart(&self) -> Vec<(f64, f64)> {
        let points = self.theta.iter().copied().zip(self.phi.iter().copied());
        points.chain([(0.0, FRAC_PI_2)]).collect()
    }

    /// The half locus `p_φ = −2`, `p_θ` of both signs, in the chart: from the cusp through the start to the mirror image of the cusp.
    pub fn half(&self) -> Vec<(f64, f64)> {
        let mut points = self.chart();
        let mirrored: Vec<_> = points.iter().rev().skip(1).map(|(theta, phi)| (-theta, *phi)).collect();
        points.extend(mirrored);
        points
    }

    /// The half locus on the sphere, the pole `r2 = 1` up: from the start through the cusp back to the start.
    pub fn half_on_sphere(&self) -> Vec<[f64; 3]> {
        let [r1, r2, r3] = self.r;
        let point = |i: usize, sign: f64| [r1[i], sign * r3[i], r2[i]];
        let start = [1.0, 0.0, 0.0];
        let there = (0..r1.len()).rev().map(|i| point(i, 1.0));
        let back = (1..r1.len()).map(|i| point(i, -1.0));
        std::iter::once(start).chain(there).chain(back).chain([start]).collect()
    }
}

/// How far from a cusp its inset reaches at most, in R³.
const REACH: f64 = 0.15;
/// A cusp that turns back within less than this is not shown: its points are known to 1e-15.
const SMALLEST_CUSP: f64 = 1e-9;
/// How far the inset of a cusp that turns back reaches, in units of where it is level with its tip again.
const BEYOND_TURN: f64 = 2.5;

/// An inset that shows the cusp of a half locus at its own scale: `φ − phi` over `θ − theta`, from the cusp.
///
/// For k < 1 the tip points away from the equator and the locus soon turns back past it; the smaller k, the smaller is that tip.
pub fn cusp_inset(branch: &Branch<'_>, place: Place, size: (f64, f64)) -> Inset {
    let [r1, r2, r3] = branch.r;
    let away = |i: usize| {
        let [x, y, z] = [r1[i] - r1[0], r2[i] - r2[0], r3[i] - r3[0]];
        (x * x + y * y + z * z).sqrt()
    };
    let count = r1.len();
    let offset = |i: usize| (branch.theta[i] - branch.theta[0], branch.phi[i] - branch.phi[0]);
    let farthest = (1..count).find(|i| away(*i) > REACH).unwrap_or(count) - 1;
    // The last point within reach on the other side of the tip's level.
    let direction = offset(farthest).1;
    let turn = (1..=farthest).rev().find(|i| offset(*i).1 * direction < 0.0 && away(*i) > SMALLEST_CUSP);
    let reach = turn.map_or(REACH, |i| (BEYOND_TURN * away(i)).min(REACH));
    let shown = ((1..count).find(|i| away(*i) > reach).unwrap_or(count) + 1).min(count);
    let inside = || (0..shown - 1).map(offset);
    let width = inside().map(|(x, _)| x.abs()).fold(f64::MIN_POSITIVE, f64::max);
    let (low, high) = inside().fold((0.0, 0.0), |(low, high): (f64, f64), (_, y)| (low.min(y), high.max(y)));
    let margin = 0.15 * (high - low).max(f64::MIN_POSITIVE);
    let half: Vec<(f64, f64)> = (0..shown).map(offset).collect();
    let mirrored = half.iter().skip(1).map(|(x, y)| (-x, *y));
    let points = half.iter().rev().copied().chain(mirrored).collect();
    let ((x, across), (y, up)) = (round_below(width), round_below(high.max(-low)));
    let y = if high >= -low { (y, up) } else { (-y, format!("−{up}")) };
    Inset {
        x: Axis::new("").fixed(-1.15 * width, 1.15 * width).ticks_at([(-x, format!("−{across}")), (x, across)]),
        y: Axis::new("").fixed(low - margin, high + margin).ticks_at([(0.0, "0".to_owned()), y]),
        place,
        size,
        marks: Some(vec![Curve::new(Role::ConjugateLocus, points).into()]),
        source: false,
    }
}

/// The largest number of one digit that is not above `x > 0`, and how it is written.
fn round_below(x: f64) -> (f64, String) {
    let exponent = libm::log10(x).floor();
    // Powers of ten with positive exponents are exact, and so the quotient is the float that a reader would write.
    let scaled =
        |digit: f64| if exponent < 0.0 { digit / libm::exp10(-exponent) } else { digit * libm::exp10(exponent) };
    let digit = (1..=9).rev().map(f64::from).find(|digit| scaled(*digit) <= x).unwrap_or(1.0);
    let text = if exponent >= -2.0 {
        format!("{}", scaled(digit))
    } else {
        let power = format!("10^{{−{}}}", -exponent);
        if digit > 1.0 { format!("{digit}·{power}") } else { power }
    };
    (scaled(digit), text)
}

/// A curve of the chart in the other half, `p_φ = +2`.
pub fn other_half(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().map(|(theta, phi)| (*theta, PI - phi)).collect()
}

/// A curve of the chart, moved by a number of turns in θ.
pub fn turned(points: &[(f64, f64)], turns: f64) -> Vec<(f64, f64)> {
    points.iter().map(|(theta, phi)| (theta + 2.0 * PI * turns, *phi)).collect()
}

/// The cusp of each branch: conjugate time and φ in the limit `p_θ → 0`, which is the ordinary point `p_θ = 0`.
pub fn cusp_values(branches: &[Branch<'_>]) -> Vec<NamedValue> {
    let of_cusp = |name: &str, k: f64, number: f64, unit: &str, meaning: &str, error: f64| {
        let (name, meaning) = (format!("{name}_k={k:?}"), format!("{meaning}, k = {k:?}"));
        let route = "closed form at p_theta = 0; integration of the lift as second route";
        value(name, (number, error), unit, meaning, route)
    };
    branches
        .iter()
        .flat_map(|branch| {
            let (k, t1) = (branch.k, branch.t1[0]);
            // On the meridian φ changes at unit rate.
            let error = t1 * branch.error[0];
            [
                of_cusp("cusp_t1", k, t1, "time", "first conjugate time in the limit p_theta → 0", error),
                of_cusp(
                    "cusp_phi",
                    k,
                    branch.phi[0],
                    "rad",
                    "φ of the cusp of the conjugate locus",
                    error + 8.0 * f64::EPSILON,
                ),
            ]
        })
        .collect()
}

fn second_routes(tables: &Tables) -> Vec<&Table> {
    [BY_INTEGRATION, DOUBLE_POINTS_BY_INTEGRATION]
        .into_iter()
        .flat_map(|name| tables.starting_with(name).map(|(_, table)| table))
        .collect()
}

fn rows_of(table: &Table) -> Result<impl Iterator<Item = (f64, f64)>, NodeError> {
    let column = |name: &str| table.f64s(name).map_err(unread);
    Ok(column("t1_difference")?.iter().copied().zip(column("allowed")?.iter().copied()))
}

/// The largest difference of the two routes, over all second routes of the experiment.
///
/// # Errors
/// A table of another form.
pub fn largest_route_difference(tables: &Tables) -> Result<NamedValue, NodeError> {
    let (mut worst, mut rows): (f64, usize) = (0.0, 0);
    for table in second_routes(tables) {
        worst = rows_of(table)?.fold(worst, |largest, (difference, _)| largest.max(difference));
        rows += table.rows();
    }
    Ok(value(
        "largest_route_difference",
        (worst, 4.0 * f64::EPSILON),
        "1",
        format!("largest relative difference of t1 between closed form and integration, {rows} conjugate times"),
        "closed form against the lift by power series (f64, double-double where rounding would show)",
    ))
}

/// The claim that the routes agree for every conjugate time, each within what is allowed for it.
///
/// # Errors
/// A table of another form.
pub fn routes_agree(tables: &Tables) -> Result<Claim, NodeError> {
    let (mut worst, mut largest_allowed): (f64, f64) = (0.0, 0.0);
    for table in second_routes(tables) {
        for (difference, allowed) in rows_of(table)? {
            worst = worst.max(difference / allowed);
            largest_allowed = largest_allowed.max(allowed);
        }
    }
    let reason = format!(
        "difference in units of what is allowed: 1e-12 relative, or the closed form's own error bound beside vertical tangents of t1 (at \
         most {largest_allowed:.1e})"
    );
    Ok(claim(
        "routes_agree",
        "all conjugate times of this experiment",
        "Closed form and integration give the same first conjugate times.",
        Evidence::Direct(Test::AtMost { measured: worst, tolerance: 1.0, reason }),
        "",
    ))
}

/// The test that `θ ~ coefficient (φ − π/2)^order` at the start, the coefficient a function of k.
fn contact_test(branches: &[Branch<'_>], order: usize, coefficient: impl Fn(f64) -> f64) -> Test {
    let (mut measured, mut tolerance): (f64, f64) = (0.0, 0.0);
    for branch in branches {
        let last = branch.p_theta.len() - 1;
        let height = branch.phi[last] - FRAC_PI_2;
        let power: f64 = std::iter::repeat_n(height, order).product();
        let ratio = branch.theta[last] / power / coefficient(branch.k);
        measured = measured.max((ratio - 1.0).abs());
        tolerance = tolerance.max(100.0 / (branch.p_theta[last] * branch.p_theta[last]));
    }
    let reason = "largest relative difference of θ from the leading term at the largest p_θ of each k; the next term is of order 1/p_θ²";
    Test::AtMost { measured, tolerance, reason: reason.to_owned() }
}

/// The claim of a contact of order two at the start: `θ ~ x0/(2k) (φ − π/2)²` with `tan x0 = x0`.
pub fn contact(branches: &[Branch<'_>]) -> Claim {
    let test = |order: usize, coefficient: fn(f64) -> f64| contact_test(branches, order, coefficient);
    claim(
        "contact_of_order_two",
        "section 5.2",
        "For p_θ(0) → ∞ the conjugate locus has a contact of order two at the initial point.",
        Evidence::Direct(test(2, contact_coefficient)),
        "The model at the start is the Grushin plane, whose conjugate points are x = −(2k/p_θ) sin x0, θ = 2k (x0 − sin x0 cos \
               x0)/p_θ², so θ/x² = x0/(2k): a parabola tangent to the meridian, one for each sign of p_θ.",
    )
    .refusing("a contact of order one, with the same coefficient", test(1, contact_coefficient))
    .refusing("a contact of order three, with the same coefficient", test(3, contact_coefficient))
    .refusing("θ/(φ − π/2)² → x0/k", test(2, |k| 2.0 * contact_coefficient(k)))
    .refusing("θ/(φ − π/2)² → π/(2k): x0 = π, where sin x0 = 0", test(2, |k| PI / (2.0 * k)))
}

/// Checks that the three figures share.
#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::contract::plan::{ConfigSource, Plan};
    use crate::experiments::definition::Experiment;
    use crate::experiments::preview::{Preview, refuses};
    use crate::experiments::{fig5, fig7, fig8};

    /// Every value with a reference is within its own error bound of it, and all have one but the difference of the routes.
    pub fn assert_references(id: &str, preview: &Preview) {
        let text = include_str!("../../tests/oracle/values.toml");
        let references: toml::Table = text.parse().unwrap();
        let of_figure = references[id].as_table().unwrap();
        for value in &preview.findings.values {
            if value.name == "largest_route_difference" {
                assert!(value.value <= 1e-12, "{}", value.value);
                continue;
            }
            let exact: f64 = of_figure[&value.name]["value"].as_str().unwrap().parse().unwrap();
            assert!(
                (value.value - exact).abs() <= value.error,
                "{}: {:?} {exact:?} ± {:e}",
                value.name,
                value.value,
                value.error
            );
            // Where branches meet at a small angle the bound of t1, whole turns of λ included, is magnified most.
            assert!(value.error < 1.5e-10, "{}: {:e}", value.name, value.error);
        }
    }

    /// Each claim holds: directly, or after the correction that it states.
    pub fn assert_claims(preview: &Preview, ids: &[&str]) {
        let found: Vec<&str> = preview.findings.claims.iter().map(|claim| claim.id.as_str()).collect();
        assert_eq!(found, ids);
        for claim in &preview.findings.claims {
            let holds = match &claim.evidence {
                Evidence::Direct(test) => test.holds(),
                Evidence::OnlyWhen { inside, outside, .. } => inside.holds() && !outside.holds(),
                _ => false,
            };
            assert!(holds, "{claim:?}");
        }
    }

    fn config(experiment: &Experiment) -> String {
        let file = format!("{}/experiments/{}.toml", env!("CARGO_MANIFEST_DIR"), experiment.kind);
        std::fs::read_to_string(file).unwrap()
    }

    fn plan(experiment: &Experiment, text: String) -> Result<Plan, String> {
        let source = ConfigSource { file: "f".to_owned(), text };
        experiment.plan(experiment.kind, &source, None).map(|planned| planned.plan).map_err(|error| error.to_string())
    }

    /// Kind and parameters of the nodes of one k.
    fn nodes_of(plan: &Plan, k: &str, name: &str) -> Vec<String> {
        let named = plan.nodes.iter().filter(|node| node.address.node.starts_with(name));
        let of_k = named.filter(|node| node.address.axes == [("k".to_owned(), k.to_owned())]);
        of_k.map(|node| format!("{} {:?}", node.compute.kind().name, node.params)).collect()
    }

    #[test]
    fn equal_work_is_one_node_in_all_figures() {
        let [fig5, fig7, fig8] = [&fig5::EXPERIMENT, &fig7::EXPERIMENT, &fig8::EXPERIMENT]
            .map(|experiment| plan(experiment, config(experiment)).unwrap());
        assert_eq!(nodes_of(&fig7, "0.8", LOCUS).len(), 2);
        assert_eq!(nodes_of(&fig7, "0.8", LOCUS), nodes_of(&fig8, "0.8", LOCUS));
        assert_eq!(nodes_of(&fig5, "1.0", LOCUS), nodes_of(&fig8, "1.0", LOCUS));
        assert_eq!(nodes_of(&fig5, "1.0", DOUBLE_POINTS), nodes_of(&fig8, "1.0", DOUBLE_POINTS));
        // Another way to write a number is no other work.
        let same = plan(&fig7::EXPERIMENT, config(&fig7::EXPERIMENT).replace("[0.8, 0.5,", "[0.80, 5e-1,")).unwrap();
        for k in ["0.8", "0.5"] {
            assert_eq!(nodes_of(&fig7, k, ""), nodes_of(&same, k, ""));
        }
    }

    #[test]
    fn only_the_listed_effects_have_nodes() {
        let without = |effects: &str| {
            let text = config(&fig7::EXPERIMENT).replace("[\"geodesics\", \"conjugate-locus\"]", effects);
            let plan = plan(&fig7::EXPERIMENT, text).unwrap();
            let mut names: Vec<String> = plan.nodes.iter().map(|node| node.address.node.clone()).collect();
            names.sort();
            names.dedup();
            names
        };
        assert_eq!(without("[\"geodesics\"]"), ["findings", "geodesics", "picture"]);
        assert_eq!(without("[\"conjugate-locus\"]"), ["conjugate-locus", BY_INTEGRATION, "findings", "picture"]);
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("0.1] }", "1.1] }", "scene.metric.spin.k[3]"),
            ("0.1] }", "-0.1] }", "scene.metric.spin.k[3]"),
            ("from = 1e-9", "from = 0.0", "scene.start.p_theta.from"),
            ("to = 1e4", "to = 1.0", "scene.start.p_theta.to"),
            ("step = 0.1 ", "step = 1.0 ", "scene.start.p_theta.step"),
            ("step = 0.15", "step = nan", "trajectories.step"),
            ("count = 15", "count = 0", "trajectories.count"),
            ("count = 15", "cuont = 15", "cuont"),
        ];
        refuses::<fig7::Params>(&config(&fig7::EXPERIMENT), &cases);
        let cases = [
            ("k = [1.0, 1.18]", "k = [1.0, 1.19]", "panels[1].k[1]"),
            ("k = [1.0, 1.18]", "k = [1.0]", "scene.metric.spin.k[3]"),
            ("[\"conjugate-locus\"]", "[\"attitude\"]", "scene.effects[0]"),
            ("latitude = -35.0", "latitude = -135.0", "panels[0].latitude"),
        ];
        refuses::<fig8::Params>(&config(&fig8::EXPERIMENT), &cases);
        let cases = [
            ("[1.0, 1.05, 1.1, ", "[0.9, 1.05, 1.1, ", "scene.metric.spin.k[0]"),
            ("size = [0.5, 0.5]", "size = [0.5, 1.5]", "panels[0].inset.size[1]"),
            ("to = 1.425", "to = 0.5", "loops.k.to"),
        ];
        refuses::<fig5::Params>(&config(&fig5::EXPERIMENT), &cases);
    }

    #[test]
    fn round_numbers_below() {
        assert_eq!(round_below(0.37), (0.3, "0.3".to_owned()));
        assert_eq!(round_below(0.3), (0.3, "0.3".to_owned()));
        assert_eq!(round_below(47.0), (40.0, "40".to_owned()));
        assert_eq!(round_below(2.4e-7).1, "2·10^{−7}");
        assert_eq!(round_below(1.4e-7).1, "10^{−7}");
    }
}
