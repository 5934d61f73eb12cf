//! Fig. 6 (section 5.2.1): the four types of trajectory of the spin problem for `k ≥ 1`, found by a classification.
//!
//! Start on the equator, φ(0) = π/2, θ(0) = 0, p_φ(0) = −2, H = 1, `p_θ > 0`; angles in radians, φ from the pole. Over
//! a grid of k and `p_θ`: type i, θ does not decrease on `[0, t1]`; else by the first exit t̄ from 0 ≤ θ ≤ π (which
//! lies after t1) and by self-intersection on `[0, t̄]`: ii, none and θ(t̄) = 0; iii, one and θ(t̄) = 0; iv, one and
//! θ(t̄) = π. The range of k of each type, one trajectory of each, and the article's example k = 1.01, `p_θ = 0.1` of a
//! θ that is not monotone.
//!
//! Hard spots: θ turns at every crossing of the equator with sin 2θ ≠ 0 as soon as k ≠ 1, if only by 1e-8: literally one
//! start of each k is of type i, which is computed by itself, and monotony on a grid needs a tolerance; passes near the poles, where θ changes by almost π at once: turning points and exit are roots of
//! polynomials in the lift, never sampled.

mod claims;

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{largest, unread, value};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::arithmetic::short_step_error;
use crate::effects::scene::{Effect, EquatorStarts, SPIN, Scene, SpinMetric};
use crate::effects::spin::monotone_theta::MonotoneTheta;
use crate::effects::switch_points::SwitchPoints;
use crate::effects::theta_turning_points::ThetaTurningPoints;
use crate::effects::trajectory_types::TrajectoryTypes;
use crate::effects::type_ranges::{self, TypeRanges};
use crate::effects::typed_trajectories::{self, CONJUGATE, EXIT, INTERSECTION, START, TypedTrajectories};
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points, RuleLine};
use crate::plot::picture::{Layout, Letter, Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// The grid of k and `p_θ`, effects, accuracy.
    pub scene: Scene<SpinMetric, EquatorStarts>,
    /// How types are told apart.
    pub types: Types,
    /// The article's example of a θ that is not monotone.
    pub example: Example,
}

/// How types are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Types {
    /// A total decrease of θ on `[0, t1]` up to this counts as none, radians, in (0, π).
    pub decrease_tolerance: f64,
    /// One more `p_θ` of the grid, above 0.
    pub smallest_p_theta: f64,
    /// The switch points are looked for up to this k, above the grid's smallest.
    pub switch_points_to: f64,
}

/// One extremal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Example {
    /// Ratio of the couplings, above 0.
    pub k: f64,
    /// `p_θ(0)`, above 0.
    pub p_theta: f64,
    /// How far it is followed, above 0.
    pub t_end: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        let k = &self.scene.metric.spin.k;
        k.validate_each("scene.metric.spin.k", "k ≥ 1, in ascending order", |k| k >= 1.0)?;
        let values = k.values();
        let ascending = values.len() >= 2 && values.is_sorted();
        Invalid::unless(ascending, "scene.metric.spin.k", format!("{values:?}"), "at least two values, ascending")?;
        self.scene.start.p_theta.validate_each("scene.start.p_theta", "p_theta > 0", |p| p > 0.0)?;
        self.scene.validate_effects(&OWN, SPIN)?;
        let Types { decrease_tolerance, smallest_p_theta, switch_points_to } = self.types;
        let right = decrease_tolerance > 0.0 && decrease_tolerance < PI;
        Invalid::number(right, "types.decrease_tolerance", decrease_tolerance, "an angle above 0, below π")?;
        let positive =
            |key: &str, value: f64| Invalid::number(value > 0.0 && value.is_finite(), key, value, "a number above 0");
        positive("types.smallest_p_theta", smallest_p_theta)?;
        let right = switch_points_to > values[0] && switch_points_to.is_finite();
        Invalid::number(right, "types.switch_points_to", switch_points_to, "a number above the grid's smallest k")?;
        positive("example.k", self.example.k)?;
        positive("example.p_theta", self.example.p_theta)?;
        positive("example.t_end", self.example.t_end)
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 2] = [Effect::TrajectoryTypes, Effect::Geodesics];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig6>();

const PICTURE: Kind = picture_kind(
    "fig6-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/fig6",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig6-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/fig6",
        "table",
    ],
);
const GRID: &str = "trajectory-types";
const RANGES: &str = "type-ranges";
const SWITCHES: &str = "switch-points";
const TURNS: &str = "theta-turning-points";
const MONOTONE: &str = "monotone-theta";
const DRAWN: &str = "typed-trajectories";
/// What rounding leaves of a θ that never decreases, radians: a few ε (next to a pole divided by `p_θ`).
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// A fall of θ that is more than rounding next to a pole, radians.
const A_FALL: f64 = 1e-9;
struct Fig6;

impl Definition for Fig6 {
    type Params = Params;

    const ID: &'static str = "fig6";
    const TITLE: &'static str = "the four types of trajectory of the spin problem for k ≥ 1";
    const PLACE: &'static str = "Figure 6";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::spin(&params.scene, &OWN, None)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let Types { decrease_tolerance, smallest_p_theta, switch_points_to } = params.types;
        let accuracy = short_step_error(params.scene.accuracy);
        let k = params.scene.metric.spin.k.clone();
        let key = |key: &str| key.to_owned();
        let tolerances = [("decrease_tolerance", key("types.decrease_tolerance")), ("accuracy", key("scene.accuracy"))];
        let mut origins = tolerances.to_vec();
        origins.push(("k", key("scene.metric.spin.k")));
        origins.push(("p_theta", key("scene.start.p_theta")));
        origins.push(("smallest_p_theta", key("types.smallest_p_theta")));
        let p_theta = params.scene.start.p_theta.clone();
        let grid = TrajectoryTypes { k: k.clone(), p_theta, smallest_p_theta, decrease_tolerance, accuracy };
        let grid = nodes.add(GRID, &[], grid, &[], &origins)?;
        if params.scene.asks_for(Effect::Geodesics) {
            let input = [(typed_trajectories::INPUT, &grid)];
            nodes.add(DRAWN, &[], TypedTrajectories { accuracy }, &input, &tolerances[1..])?;
        }
        if params.scene.asks_for(Effect::TrajectoryTypes) {
            let input = [(type_ranges::INPUT, &grid)];
            nodes.add(RANGES, &[], TypeRanges { decrease_tolerance, accuracy }, &input, &tolerances)?;
            let monotone = MonotoneTheta { k: k.clone(), accuracy };
            let k_and_accuracy = [("k", key("scene.metric.spin.k")), ("accuracy", key("scene.accuracy"))];
            nodes.add(MONOTONE, &[], monotone, &[], &k_and_accuracy)?;
            let k_low = k.values()[0];
            let switches = SwitchPoints { p_theta: smallest_p_theta, k_low, k_high: switch_points_to };
            let origins = [
                ("p_theta", key("types.smallest_p_theta")),
                ("k_low", key("scene.metric.spin.k")),
                ("k_high", key("types.switch_points_to")),
            ];
            nodes.add(SWITCHES, &[], switches, &[], &origins)?;
            let Example { k, p_theta, t_end } = params.example;
            let origins = [
                ("k", key("example.k")),
                ("p_theta", key("example.p_theta")),
                ("t_end", key("example.t_end")),
                ("accuracy", key("scene.accuracy")),
            ];
            nodes.add(TURNS, &[], ThetaTurningPoints { k, p_theta, t_end, accuracy }, &[], &origins)?;
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let picture = Picture::new(Width::Double, 170.0, "The four types of trajectory").layout(Layout::Columns(2));
        if !params.scene.asks_for(Effect::Geodesics) {
            return chart_of_types(params, tables.get(GRID).map_err(unread)?);
        }
        let table = tables.get(DRAWN).map_err(unread)?;
        let mut picture = picture;
        let mut drawn = Vec::new();
        for kind in ["i", "ii", "iii", "iv"] {
            let Some(example) = Drawn::read(table, kind)? else { continue };
            drawn.push(format!("({kind}) k = {:.4}, p_θ = {:.4}", example.k, example.p_theta));
            picture = picture.panel(example.panel(kind));
        }
        Ok(picture.caption(format!(
            "Spin problem, start on the equator with p_φ = −2, H = 1: {}. Line: equator, singular. Cross: start. Disc: \
             first conjugate point (closed form, 1e-14). Diamond: first exit from 0 ≤ θ ≤ π, at t̄. Circle: \
             self-intersection. (i) θ does not decrease on [0, t1], within {} rad in all; (ii) no self-intersection, \
             θ(t̄) = 0; (iii) self-intersection, θ(t̄) = 0; (iv) self-intersection, θ(t̄) = π. Chosen by rule from a \
             classified grid: the middle k with all four types, the middle p_θ of each. Integrated on R³ × so(3)* by \
             power series, {} points, no side longer than 0.04 rad.",
            drawn.join(", "),
            params.types.decrease_tolerance,
            table.rows(),
        )))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = Vec::new();
        if params.scene.asks_for(Effect::TrajectoryTypes) {
            values.extend(range_values(tables.get(RANGES).map_err(unread)?)?);
            values.extend(grid_values(tables.get(GRID).map_err(unread)?)?);
            values.extend(example_values(tables.get(TURNS).map_err(unread)?, params.types.decrease_tolerance)?);
        }
        let drawn =
            if params.scene.asks_for(Effect::Geodesics) { Some(tables.get(DRAWN).map_err(unread)?) } else { None };
        // Where no trajectory is of any of the four types, none is drawn.
        if let Some(drawn) = drawn.filter(|drawn| drawn.rows() > 0) {
            let distance = largest(drawn, "closed_form_distance")?;
            values.push(value(
                "largest_position_difference",
                (distance, 4.0 * f64::EPSILON),
                "rad",
                "largest distance of a drawn point to the closed form's point of the same time",
                "power series against closed form",
            ));
        }
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        claims::claims(params, tables)
    }
}

/// One trajectory, as it is drawn.
struct Drawn {
    k: f64,
    p_theta: f64,
    points: Vec<(f64, f64)>,
    marks: Vec<(String, (f64, f64))>,
}

impl Drawn {
    fn read(table: &Table, kind: &str) -> Result<Option<Self>, NodeError> {
        let of_kind = table.texts("type").map_err(unread)?;
        let (theta, phi) = (table.f64s("theta").map_err(unread)?, table.f64s("phi").map_err(unread)?);
        let (p_theta, mark) = (table.f64s("p_theta").map_err(unread)?, table.texts("mark").map_err(unread)?);
        let rows: Vec<usize> = (0..table.rows()).filter(|i| of_kind[*i] == kind).collect();
        let Some(&first) = rows.first() else { return Ok(None) };
        let points = rows.iter().map(|i| (theta[*i], phi[*i])).collect();
        let marks = rows.iter().map(|i| (mark[*i].clone(), (theta[*i], phi[*i]))).collect();
        let k = table.f64s("k").map_err(unread)?[first];
        Ok(Some(Self { k, p_theta: p_theta[first], points, marks }))
    }

    fn panel(self, kind: &str) -> Panel {
        let ticks = [(0.0, "0"), (FRAC_PI_4, "π/4"), (FRAC_PI_2, "π/2"), (3.0 * FRAC_PI_4, "3π/4"), (PI, "π")];
        let angle = |name: &str| Axis::new(name).unit("rad").ticks_at(ticks).fixed(-0.12, PI + 0.12);
        let mut panel = Panel::new(angle("*θ*"), angle("*φ*"))
            .equal()
            .title(format!("({kind})  *k* = {:.4}, *p*_*θ* = {:.4}", self.k, self.p_theta))
            .mark(RuleLine::horizontal(Role::Equator, FRAC_PI_2))
            .mark(RuleLine::vertical(Role::Reference, 0.0))
            .mark(RuleLine::vertical(Role::Reference, PI))
            .mark(Curve::new(Role::Geodesic, self.points).arrow(0.25));
        panel.letter = Letter::None;
        let looks = [
            (START, Role::Start, "start"),
            (CONJUGATE, Role::ConjugatePoint, "first conjugate point"),
            (EXIT, Role::EquatorCrossing, "first exit from 0 ≤ *θ* ≤ π"),
            (INTERSECTION, Role::SelfIntersection, "self-intersection"),
        ];
        for (mark, role, text) in looks {
            // Both times of a self-intersection are one point.
            let point = self.marks.iter().find(|(name, _)| name == mark).map(|(_, point)| *point);
            panel = panel.marks(point.map(|point| Points::new(role, vec![point]).legend(text)));
        }
        panel
    }
}

/// The types over the plane of k and `p_θ`: what is drawn when no trajectories are asked for.
fn chart_of_types(params: &Params, table: &Table) -> Result<Picture, NodeError> {
    let (k, p_theta) = (table.f64s("k").map_err(unread)?, table.f64s("p_theta").map_err(unread)?);
    let types = table.texts("type").map_err(unread)?;
    let mut panel = Panel::new(Axis::new("*k*"), Axis::new("*p*_*θ*").log());
    let looks = [("i", Role::SeriesA), ("ii", Role::SeriesB), ("iii", Role::SeriesC), ("iv", Role::SeriesD)];
    for (kind, role) in looks {
        let apart = |i: &usize| p_theta[*i] != params.types.smallest_p_theta;
        let rows = (0..table.rows()).filter(|i| types[*i] == kind).filter(apart);
        let points: Vec<(f64, f64)> = rows.map(|i| (k[i], p_theta[i])).collect();
        panel = panel.mark(Points::new(role, points).legend(format!("type {kind}")));
    }
    let picture = Picture::new(Width::Double, 100.0, "Types of trajectories");
    let caption = "Types of the trajectories over the grid of k and p_θ (section 5.2.1).";
    Ok(picture.caption(caption).panel(panel))
}

fn range_values(table: &Table) -> Result<Vec<NamedValue>, NodeError> {
    let column = |name: &str| table.f64s(name).map_err(unread);
    let kinds = table.texts("type").map_err(unread)?;
    let mut values = Vec::new();
    for (end, what) in [("from", "smallest"), ("to", "largest")] {
        let (k, error) = (column(&format!("k_{end}"))?, column(&format!("error_{end}"))?);
        let of_grid = table.bools(&format!("{end}_is_end_of_grid")).map_err(unread)?;
        for (i, kind) in kinds.iter().enumerate() {
            let route = if of_grid[i] { "the grid ends there" } else { "bisection in k of the classification" };
            let meaning = format!("{what} k with a trajectory of type {kind}, on the grid of p_θ");
            values.push(value(format!("type_{kind}_k_{end}"), (k[i], error[i]), "1", &meaning, route));
        }
    }
    Ok(values)
}

fn grid_values(table: &Table) -> Result<[NamedValue; 4], NodeError> {
    let grid = Grid::read(table)?;
    let of_type_i = |i: &usize| grid.types[*i] == "i";
    let rows = || 0..grid.k.len();
    let most = rows().filter(of_type_i).map(|i| grid.decrease[i]).fold(0.0, f64::max);
    let least = rows().filter(|i| !of_type_i(i)).map(|i| grid.decrease[i]).fold(PI, f64::min);
    let delay = rows().map(|i| grid.t_exit[i] - grid.t1[i]).filter(|delay| delay.is_finite()).fold(100.0, f64::min);
    let route = "turning points of θ as roots of polynomials along the lift";
    // θ next to a pole and exits for small p_θ: a few ε divided by p_θ.
    let smallest = grid.p_theta.iter().copied().fold(1.0, f64::min);
    let error = ROUNDING / smallest;
    Ok([
        value("largest_decrease_in_type_i", (most, error), "rad", "largest total decrease of θ in a type i", route),
        value("smallest_decrease_elsewhere", (least, error), "rad", "smallest decrease of θ in types ii to iv", route),
        value(
            "smallest_exit_delay",
            (delay, error),
            "time",
            "smallest t̄ − t1 on the grid",
            "r3 = 0 along the lift, closed form of t1",
        ),
        value(
            "largest_route_difference",
            (largest(table, "t1_difference")?, 4.0 * f64::EPSILON),
            "1",
            "largest relative difference of t1 between closed form and integration",
            "closed form against power series",
        ),
    ])
}

/// The first turning point after which θ falls by more than a bound before it rises again.
fn first_fall(table: &Table, bound: f64) -> Result<Option<(f64, f64)>, NodeError> {
    let (t, change) = (table.f64s("t").map_err(unread)?, table.f64s("change").map_err(unread)?);
    let fall = (1..table.rows()).find(|i| -change[*i] > bound);
    Ok(fall.map(|i| (t[i - 1], -change[i])))
}

fn example_values(table: &Table, tolerance: f64) -> Result<Vec<NamedValue>, NodeError> {
    let route = "turning points of θ as roots of polynomials along the lift";
    let mut values = Vec::new();
    if let Some((t, _)) = first_fall(table, A_FALL)? {
        let meaning = "time at which θ first falls in the article's example of a θ that is not monotone";
        values.push(value("example_first_fall", (t, 1e-12), "time", meaning, route));
    }
    if let Some((t, fall)) = first_fall(table, tolerance)? {
        let meaning = "time at which θ first begins to fall by more than the tolerance in that example";
        values.push(value("example_visible_fall", (t, 1e-12), "time", meaning, route));
        let meaning = "how far θ falls from there until it rises again";
        values.push(value("example_visible_fall_by", (fall, 1e-12), "rad", meaning, route));
    }
    Ok(values)
}

/// The grid as it is read.
struct Grid<'a> {
    k: &'a [f64],
    p_theta: &'a [f64],
    types: &'a [String],
    t1: &'a [f64],
    decrease: &'a [f64],
    t_exit: &'a [f64],
    values: Vec<f64>,
}

impl<'a> Grid<'a> {
    fn read(table: &'a Table) -> Result<Self, NodeError> {
        let column = |name: &str| table.f64s(name).map_err(unread);
        let k = column("k")?;
        let mut values = k.to_vec();
        values.dedup();
        let types = table.texts("type").map_err(unread)?;
        let (t1, p_theta) = (column("t1")?, column("p_theta")?);
        Ok(Self { k, p_theta, types, t1, decrease: column("decrease")?, t_exit: column("t_exit")?, values })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::experiments::preview;

    /// Oracle for the ends: k1, k̄, k2 for p_θ = 1e-4 (tests/oracle/values.toml, fig4); the others are checked in
    /// geometry::spin.
    #[test]
    fn values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for value in &preview.findings.values {
            println!("{:<32} {:<24?} {:.1e}", value.name, value.value, value.error);
        }
        for claim in &preview.findings.claims {
            println!("{claim:?}");
        }
        for (name, exact) in [
            ("type_ii_k_from", 1.060_660_173_768_559_1),
            ("type_iii_k_from", 1.154_700_540_544_315),
            ("type_iv_k_from", 1.250_000_002_343_75),
        ] {
            // p_θ² = 1e-8, by which the exit lies later than t1, beside the value's own error.
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            assert!((found.value - exact).abs() < 1e-8 + found.error, "{name}: {:?}", found.value);
        }
        for claim in &preview.findings.claims {
            match &claim.evidence {
                Evidence::Direct(test) => assert!(test.holds(), "{claim:?}"),
                _ => panic!("{claim:?}"),
            }
        }
        assert!(preview.value("largest_route_difference") <= 1e-12);
        assert!(preview.value("largest_position_difference") <= 1e-12);
    }

    #[test]
    fn an_effect_removed_takes_its_nodes_values_and_claims_with_it() {
        let smaller = |text: String| text.replace("count = 23", "count = 3").replace("count = 61", "count = 4");
        let drawn = preview::run(&EXPERIMENT, |text| smaller(text).replace("\"trajectory-types\", ", ""));
        assert!(drawn.findings.claims.is_empty() && drawn.findings.values.len() == 1);
        let types = preview::run(&EXPERIMENT, |text| smaller(text).replace(", \"geodesics\"", ""));
        assert!(types.findings.values.iter().all(|value| value.name != "largest_position_difference"));
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("from = 1.0,", "from = 0.9,", "scene.metric.spin.k.from"),
            ("from = 0.05", "from = -0.05", "scene.start.p_theta"),
            ("decrease_tolerance = 0.03", "decrease_tolerance = 0.0", "types.decrease_tolerance"),
            ("smallest_p_theta = 1e-4", "smallest_p_theta = 0", "types.smallest_p_theta"),
            ("switch_points_to = 1.5", "switch_points_to = 0.5", "types.switch_points_to"),
            ("t_end = 16.0", "t_end = -1", "example.t_end"),
            ("\"geodesics\"", "\"attitude\"", "scene.effects[1]"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/fig6.toml"), &cases);
    }
}
