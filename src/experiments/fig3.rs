//! Figure 3 (section 3.3.3, Theorem 3.24): conjugate locus, cut locus, separatrices and wave fronts of `(0, φ0)`, on the universal cover.
//!
//! The right component of the conjugate locus (`p_θ > 0`; the left one is its mirror) has two branches, of ascending and of descending extremals, that
//! tend to the lines `φ = ±K(k)/α` and form a cusp at `(Δθ(p_θ), −φ0)`, `p_θ = √μ(φ0)`. The cut ray starts there: both extremals of one `p_θ`
//! meet at `(Δθ(p_θ), −φ0)` at `t = T(p_θ)/2`. Time is arc length, φ a length, θ in radians.
//!
//! Hard spots: the cusp, where the locus is smooth in `φ'(0)` but not in `p_θ`; the separatrix, where time and θ grow like log 1/δ, `δ = B p_θ² − 1`;
//! fronts from all directions, stretched by `e^(Mt)` there; and their self-crossings, which are found from the fronts alone.
//! The article does not say where its extremals start: the config's starts are a choice.

mod claims;

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{largest_route_difference, unread, value};
use super::nodes::Nodes;
use super::scenes::curves::{curves, minus, mirrored};
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::sweep::Sweep;
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, Phi0Start, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::by_integration::{self, ConjugatePointsByIntegration};
use crate::effects::serret_andoyer::conjugate_locus::{ConjugateLocus, Spacing};
use crate::effects::serret_andoyer::cut_locus::CutLocus;
use crate::effects::serret_andoyer::geodesics::Geodesics;
use crate::effects::serret_andoyer::wave_front::WaveFront;
use crate::effects::serret_andoyer::wave_front_crossings::{self, WaveFrontCrossings};
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side};
use crate::plot::picture::{Cell, Inset, Layout, Panel, Picture, Place, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, starts, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, Phi0Start>,
    /// Points of the loci.
    pub spacing: LocusSpacing,
    /// Wave fronts.
    pub wave_front: Fronts,
    /// What the panels show.
    pub picture: Shown,
}

/// Points of the loci.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LocusSpacing {
    /// The smallest δ as a part of the largest, in [1e-13, 0.2].
    pub smallest: f64,
    /// Intervals near the cusp, 1 to 9999.
    pub cusp: usize,
    /// Intervals in log δ, 1 to 9999.
    pub tail: usize,
}

/// Wave fronts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fronts {
    /// Times (length), above 0, at most 30.
    pub t: Sweep,
    /// Largest distance of a piece's middle from its chord, in [1e-6, 1].
    pub flatness: f64,
}

/// What the panels show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    /// Turns of θ (2π each) to both sides, above 0, at most 100.
    pub turns: f64,
    /// How far down the strips reach, in units of `K(k)/α`, 0.1 to 100.
    pub bottom: f64,
    /// How far up, with room for the inset, in units of `K(k)/α`, 0.1 to 100.
    pub top: f64,
    /// The inset at the right cusp.
    pub inset: Window,
    /// Points of each separatrix, 2 to 9999.
    pub points: usize,
}

/// The size of an inset.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Width in θ (rad), above 0, at most 100.
    pub theta: f64,
    /// Height in φ (length), above 0, at most 100.
    pub phi: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate(self.scene.metric.half_width())?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)?;
        let LocusSpacing { smallest, cusp, tail } = self.spacing;
        let accepted = "a number from 1e-13 to 0.2";
        Invalid::number((1e-13..=0.2).contains(&smallest), "spacing.smallest", smallest, accepted)?;
        Invalid::unless((1..=9999).contains(&cusp), "spacing.cusp", cusp, "1 to 9999")?;
        Invalid::unless((1..=9999).contains(&tail), "spacing.tail", tail, "1 to 9999")?;
        self.wave_front.t.validate_each("wave_front.t", "0 < t <= 30", |t| t > 0.0 && t <= 30.0)?;
        let flatness = self.wave_front.flatness;
        Invalid::number((1e-6..=1.0).contains(&flatness), "wave_front.flatness", flatness, "1e-6 to 1")?;
        let Shown { turns, bottom, top, inset, points } = self.picture;
        let positive = |key: &str, x: f64| Invalid::number(x > 0.0 && x <= 100.0, key, x, "above 0, at most 100");
        positive("picture.turns", turns)?;
        Invalid::number((0.1..=100.0).contains(&bottom), "picture.bottom", bottom, "0.1 to 100")?;
        Invalid::number((0.1..=100.0).contains(&top), "picture.top", top, "0.1 to 100")?;
        positive("picture.inset.theta", inset.theta)?;
        positive("picture.inset.phi", inset.phi)?;
        Invalid::unless((2..=9999).contains(&points), "picture.points", points, "2 to 9999")
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 4] = [Effect::ConjugateLocus, Effect::CutLocus, Effect::WaveFront, Effect::Geodesics];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig3>();

const PICTURE: Kind = picture_kind(
    "fig3-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig3",
        "experiments/findings.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig3-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig3",
        "experiments/findings.rs",
        "table",
    ],
);

struct Fig3;

impl Definition for Fig3 {
    type Params = Params;

    const ID: &'static str = "fig3";
    const TITLE: &'static str = "conjugate and cut loci, separatrices and wave fronts of the Serret-Andoyer metric";
    const PLACE: &'static str = "Figure 3";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::serret_andoyer(&params.scene, &OWN, Some(&params.scene.start.phi0), None)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let Params { scene, spacing, wave_front, picture } = params;
        let body = scene.metric.serret_andoyer.into();
        let spacing = Spacing { smallest: spacing.smallest, cusp: spacing.cusp, tail: spacing.tail };
        let metric = Inertia::origins("serret-andoyer");
        for (i, phi0) in scene.start.phi0.values().into_iter().enumerate() {
            let axis = ("phi0", format!("{phi0:?}"));
            let from = |leaves: &[(&'static str, &str)]| {
                let own = leaves.iter().map(|(leaf, key)| (*leaf, (*key).to_owned()));
                let start = ("phi0", scene.start.phi0.key_of("scene.start.phi0", i));
                metric.iter().cloned().chain(std::iter::once(start)).chain(own).collect::<Vec<_>>()
            };
            let axes = std::slice::from_ref(&axis);
            if scene.asks_for(Effect::ConjugateLocus) {
                let locus = ConjugateLocus { body, phi0, spacing };
                let locus = nodes.add("conjugate-locus", axes, locus, &[], &from(&[]))?;
                let second = ConjugatePointsByIntegration::new(body, scene.accuracy);
                let input = [(by_integration::INPUT, &locus)];
                nodes.add("conjugate-locus-by-integration", axes, second, &input, &metric)?;
            }
            if scene.asks_for(Effect::CutLocus) {
                nodes.add("cut-locus", axes, CutLocus { body, phi0, spacing }, &[], &from(&[]))?;
            }
            if scene.asks_for(Effect::Geodesics) {
                let separatrix = Geodesics {
                    body,
                    phi0,
                    p_theta: Vec::new(),
                    separatrix: true,
                    minor_axis: false,
                    parallel: false,
                    theta_end: 2.0 * PI * picture.turns,
                    phi_end: scene.metric.half_width(),
                    points: picture.points,
                };
                let own = from(&[("theta_end", "picture.turns"), ("points", "picture.points")]);
                nodes.add("separatrix", axes, separatrix, &[], &own)?;
            }
            if scene.asks_for(Effect::WaveFront) {
                for (j, t) in wave_front.t.values().into_iter().enumerate() {
                    let axes = [axis.clone(), ("t", format!("{t:?}"))];
                    let key = wave_front.t.key_of("wave_front.t", j);
                    let own = from(&[("t", &key), ("flatness", "wave_front.flatness")]);
                    let front = WaveFront { body, phi0, t, flatness: wave_front.flatness };
                    let front = nodes.add("wave-front", &axes, front, &[], &own)?;
                    let input = [(wave_front_crossings::INPUT, &front)];
                    let crossings = WaveFrontCrossings { body, phi0, t };
                    nodes.add("wave-front-crossings", &axes, crossings, &input, &from(&[("t", &key)]))?;
                }
            }
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let starts = params.scene.start.phi0.values();
        let rows = starts.len() as f64;
        let fronts = params.scene.asks_for(Effect::WaveFront);
        let strip = STRIP_MM * rows;
        let height = strip + if fronts { WHOLE_MM } else { 0.0 };
        let mut picture =
            Picture::new(Width::Double, height + LEGEND_MM, "Conjugate and cut loci of the Serret-Andoyer metric");
        let mut cells = Vec::new();
        for (i, phi0) in starts.iter().enumerate() {
            let top = STRIP_MM * i as f64 / height;
            cells.push(Cell { left: 0.0, top, width: 1.0, height: STRIP_MM / height });
            picture = picture.panel(strip_panel(params, tables, *phi0)?);
        }
        if fronts {
            for (i, phi0) in starts.iter().enumerate() {
                let width = 1.0 / rows;
                cells.push(Cell { left: i as f64 * width, top: strip / height, width, height: WHOLE_MM / height });
                picture = picture.panel(whole_panel(params, tables, *phi0)?);
            }
        }
        Ok(picture.layout(Layout::Cells(cells)).caption(caption(params, tables)?))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = Vec::new();
        for (i, phi0) in params.scene.start.phi0.values().into_iter().enumerate() {
            let mut add = |name: &str, number: f64, error: f64, unit: &str, meaning: &str, route: &str| {
                let (name, meaning) = (format!("{name}_{}", i + 1), format!("start φ0 = {phi0:?}: {meaning}"));
                values.push(value(name, (number, error), unit, meaning, route));
            };
            if params.scene.asks_for(Effect::ConjugateLocus) {
                let locus = Locus::read(tables.get(&name("conjugate-locus", phi0)).map_err(unread)?)?;
                let closed = "closed form (Lemma 3.8, Proposition 3.23)";
                let cusp = locus.cusp;
                let t1 = locus.t1[cusp];
                add("cusp_time", t1, locus.error[cusp] * t1, "length", "first conjugate time of the cusp", closed);
                let theta = locus.theta[cusp];
                // θ grows at the rate p_θ/μ ≤ B p_θ < 2√B in time.
                add("cusp_theta", theta, 16.0 * f64::EPSILON * theta, "rad", "θ of the cusp", closed);
                let gap = locus.gap(params.scene.metric.half_width());
                let meaning = format!("distance of the locus from φ = ±K(k)/α where δ = {:?}", locus.delta[0]);
                add("asymptote_distance", gap, 1e-14, "length", &meaning, "closed form");
            }
            if params.scene.asks_for(Effect::WaveFront) {
                let crossings = first_crossings(params, tables, phi0)?;
                let worst = crossings.iter().map(|c| c.distance).fold(0.0, f64::max);
                let meaning = format!(
                    "largest distance of a front's first self-crossing from the cut ray, {} fronts",
                    crossings.len()
                );
                add("largest_crossing_distance", worst, CROSSING_ERROR, "1", &meaning, "Newton's method on the front");
            }
        }
        let second = second_routes(params, tables)?;
        if !second.is_empty() {
            values.push(largest_route_difference(&second)?);
        }
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        claims::claims(params, tables)
    }
}

/// Height of a panel with a strip, of the row with whole fronts, of the legend (mm).
const STRIP_MM: f64 = 72.0;
const WHOLE_MM: f64 = 80.0;
const LEGEND_MM: f64 = 10.0;
/// The lightest tone of a front: beyond, it would look like the conjugate locus.
const LIGHTEST: f64 = 0.7;
/// Rounding of a crossing's place: a few ε of θ, times the angle at which the front crosses itself.
const CROSSING_ERROR: f64 = 1e-13;

fn name(table: &str, phi0: f64) -> String {
    format!("{table}/phi0={phi0:?}")
}

fn front_name(table: &str, phi0: f64, t: f64) -> String {
    format!("{table}/phi0={phi0:?}/t={t:?}")
}

fn second_routes<'a>(params: &Params, tables: &'a Tables) -> Result<Vec<&'a Table>, NodeError> {
    if !params.scene.asks_for(Effect::ConjugateLocus) {
        return Ok(Vec::new());
    }
    let starts = params.scene.start.phi0.values();
    let table = |phi0: &f64| tables.get(&name("conjugate-locus-by-integration", *phi0)).map_err(unread);
    starts.iter().map(table).collect()
}

/// The columns of a conjugate locus.
struct Locus<'a> {
    delta: &'a [f64],
    branch: &'a [i64],
    t1: &'a [f64],
    theta: &'a [f64],
    phi: &'a [f64],
    error: &'a [f64],
    /// The row of the cusp.
    cusp: usize,
}

impl<'a> Locus<'a> {
    fn read(table: &'a Table) -> Result<Self, NodeError> {
        let column = |name: &str| table.f64s(name).map_err(unread);
        let branch = table.ints("branch").map_err(unread)?;
        let descending = branch.iter().position(|branch| *branch < 0);
        let cusp = descending.and_then(|row| row.checked_sub(1)).ok_or_else(|| NodeError::new("no cusp"))?;
        Ok(Self {
            delta: column("delta")?,
            branch,
            t1: column("t1")?,
            theta: column("theta")?,
            phi: column("phi")?,
            error: column("t1_error")?,
            cusp,
        })
    }

    fn points(&self) -> Vec<(f64, f64)> {
        self.theta.iter().copied().zip(self.phi.iter().copied()).collect()
    }

    /// The larger distance of both ends from the edges.
    fn gap(&self, half_width: f64) -> f64 {
        let end = |phi: Option<&f64>| phi.map_or(f64::INFINITY, |phi| half_width - phi.abs());
        end(self.phi.first()).max(end(self.phi.last()))
    }
}

/// A front's first self-crossing.
struct FirstCrossing {
    t: f64,
    theta: f64,
    phi: f64,
    distance: f64,
    /// `p_θ` of both extremals.
    momenta: [f64; 2],
    half_period_difference: f64,
}

fn first_crossings(params: &Params, tables: &Tables, phi0: f64) -> Result<Vec<FirstCrossing>, NodeError> {
    let mut first = Vec::new();
    for t in params.wave_front.t.values() {
        let table = tables.get(&front_name("wave-front-crossings", phi0, t)).map_err(unread)?;
        let column = |name: &str| table.f64s(name).map_err(unread);
        let (theta, phi, distance) = (column("theta")?, column("phi")?, column("distance")?);
        let (one, other, late) = (column("p_theta1")?, column("p_theta2")?, column("half_period_difference")?);
        if !theta.is_empty() {
            first.push(FirstCrossing {
                t,
                theta: theta[0],
                phi: phi[0],
                distance: distance[0],
                momenta: [one[0], other[0]],
                half_period_difference: late[0],
            });
        }
    }
    Ok(first)
}

/// One start: the strip with loci, separatrices and fronts, and the cusp magnified.
fn strip_panel(params: &Params, tables: &Tables, phi0: f64) -> Result<Panel, NodeError> {
    let half_width = params.scene.metric.half_width();
    let theta_end = 2.0 * PI * params.picture.turns;
    let (bottom, top) = (-half_width * params.picture.bottom, half_width * params.picture.top);
    let ticks = [(-half_width, "−*K*/*α*"), (0.0, "0"), (half_width, "*K*/*α*")];
    let mut panel = Panel::new(
        Axis::new("*θ*").unit("rad").fixed(-theta_end, theta_end).pi_ticks(),
        Axis::new("*φ*").fixed(bottom, top).ticks_at(ticks),
    )
    .title(format!("*φ*_0 = {}", minus(phi0)));
    for edge in [-half_width, half_width] {
        panel = panel.mark(RuleLine::horizontal(Role::Reference, edge));
    }
    if params.scene.asks_for(Effect::Geodesics) {
        let table = tables.get(&name("separatrix", phi0)).map_err(unread)?;
        for points in curves(table, "curve")? {
            panel = panel
                .mark(Curve::new(Role::Separatrix, mirrored(&points)).legend("separatrices, *p*_*θ* = ±*B*^{−1/2}"))
                .mark(Curve::new(Role::Separatrix, points).legend("separatrices, *p*_*θ* = ±*B*^{−1/2}"));
        }
    }
    panel = with_fronts(panel, params, tables, phi0, false)?;
    let mut cusp = None;
    if params.scene.asks_for(Effect::CutLocus) {
        let table = tables.get(&name("cut-locus", phi0)).map_err(unread)?;
        let (theta, phi) = (table.f64s("theta").map_err(unread)?, table.f64s("phi").map_err(unread)?);
        let points: Vec<(f64, f64)> = theta.iter().copied().zip(phi.iter().copied()).collect();
        cusp = points.first().copied();
        panel = panel
            .mark(Curve::new(Role::CutLocus, mirrored(&points)).legend("cut locus"))
            .mark(Curve::new(Role::CutLocus, points).legend("cut locus"));
    }
    if params.scene.asks_for(Effect::ConjugateLocus) {
        let locus = Locus::read(tables.get(&name("conjugate-locus", phi0)).map_err(unread)?)?;
        let points = locus.points();
        cusp = points.get(locus.cusp).copied();
        panel = panel
            .mark(Curve::new(Role::ConjugateLocus, mirrored(&points)).legend("conjugate locus"))
            .mark(Curve::new(Role::ConjugateLocus, points).legend("conjugate locus"));
    }
    if let Some((theta, phi)) = cusp {
        let Window { theta: wide, phi: high } = params.picture.inset;
        let ranges = ((theta - 0.15 * wide, theta + 0.85 * wide), (phi - 0.5 * high, phi + 0.5 * high));
        panel = panel.inset(Inset::new(ranges.0, ranges.1, Place::At(0.66, 0.69), (0.33, 0.29)));
    }
    Ok(panel.mark(Points::new(Role::Start, vec![(0.0, phi0)]).legend("start")))
}

/// One start: the whole fronts, far beyond the strip.
fn whole_panel(params: &Params, tables: &Tables, phi0: f64) -> Result<Panel, NodeError> {
    let half_width = params.scene.metric.half_width();
    let mut panel = Panel::new(Axis::new("*θ*").unit("rad").pi_ticks(), Axis::new("*φ*").unit("length"))
        .title(format!("whole fronts, *φ*_0 = {}", minus(phi0)));
    for edge in [-half_width, half_width] {
        panel = panel.mark(RuleLine::horizontal(Role::Reference, edge));
    }
    panel = with_fronts(panel, params, tables, phi0, true)?;
    Ok(panel.mark(Points::new(Role::Start, vec![(0.0, phi0)]).legend("start")))
}

fn with_fronts(
    mut panel: Panel,
    params: &Params,
    tables: &Tables,
    phi0: f64,
    labels: bool,
) -> Result<Panel, NodeError> {
    if !params.scene.asks_for(Effect::WaveFront) {
        return Ok(panel);
    }
    let times = params.wave_front.t.values();
    let last = times.len().saturating_sub(1).max(1) as f64;
    for (i, t) in times.iter().enumerate() {
        let table = tables.get(&front_name("wave-front", phi0, *t)).map_err(unread)?;
        let (theta, phi) = (table.f64s("theta").map_err(unread)?, table.f64s("phi").map_err(unread)?);
        let points = theta.iter().copied().zip(phi.iter().copied()).collect();
        let mut curve =
            Curve::new(Role::WaveFront, points).tone(LIGHTEST * i as f64 / last).legend(format!("front, *t* = {t}"));
        if labels {
            curve = curve.label(DirectLabel::new(format!("*t* = {t}")).at(At::Fraction(0.03)).side(Side::Above));
        }
        panel = panel.mark(curve);
    }
    let crossings = first_crossings(params, tables, phi0)?;
    let points: Vec<(f64, f64)> = crossings.iter().flat_map(|c| [(c.theta, c.phi), (-c.theta, c.phi)]).collect();
    if !points.is_empty() {
        panel = panel.mark(Points::new(Role::SelfIntersection, points).legend("self-crossings of the fronts"));
    }
    Ok(panel)
}

fn caption(params: &Params, tables: &Tables) -> Result<String, NodeError> {
    let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
    let starts: Vec<String> = params.scene.start.phi0.values().into_iter().map(minus).collect();
    let asks = |effect| params.scene.asks_for(effect);
    let mut text = format!(
        "Serret-Andoyer metric, A = {a}, B = {b}, C = {c}, on the universal cover; starts (θ, φ) = (0, φ0) with φ0 = {}, a choice: the \
         article states none. Dashed: φ = ±K(k)/α.",
        starts.join(" and ")
    );
    if asks(Effect::ConjugateLocus) {
        let second = second_routes(params, tables)?;
        let rows: usize = second.iter().map(|table| table.rows()).sum();
        let difference = largest_route_difference(&second)?.value;
        text += &format!(
            " Conjugate locus (Theorem 3.24): {rows} first conjugate points with p_θ > 0, closed form, relative error 1e-14, and their \
             mirror images; integration of the flow (9) differs by at most {difference:.0e}."
        );
    }
    if asks(Effect::CutLocus) {
        text += " Cut locus: the points (Δθ(p_θ), −φ0) at t = T(p_θ)/2, from the cusp outwards.";
    }
    if asks(Effect::Geodesics) {
        text += " Separatrices: p_θ = ±B^(−1/2).";
    }
    if asks(Effect::WaveFront) {
        let times: Vec<String> = params.wave_front.t.values().iter().map(f64::to_string).collect();
        text += &format!(
            " Wave fronts at t = {} from all directions, both signs of p_θ and φ', rotating and unphysical ones (p_θ < C^(−1/2)) among \
             them; circles: their first self-crossings, found from the fronts, on the cut locus. Last row: the whole fronts.",
            times.join(", ")
        );
    }
    text += " Insets: the right cusp.";
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::experiments::preview;

    #[test]
    fn values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            let good = match &claim.evidence {
                Evidence::Direct(test) => test.holds(),
                Evidence::OnlyWhen { inside, outside, .. } => inside.holds() && !outside.holds(),
                _ => false,
            };
            assert!(good, "{claim:?}");
        }
        for (name, exact) in CUSP {
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            assert!((found.value - exact).abs() <= found.error, "{name}: {:?} is not {exact:?}", found.value);
            assert!(found.error <= 1e-14 * exact, "{name}: {:e}", found.error);
        }
        assert!(preview.value("largest_route_difference") <= 1e-12);
    }

    /// Oracle: mpmath 1.3.0, 50 digits (see `tests/oracle/values.toml`).
    const CUSP: [(&str, f64); 4] = [
        ("cusp_time_1", 4.772_421_833_446_835_9),
        ("cusp_theta_1", 5.844_999_164_631_256_6),
        ("cusp_time_2", 6.617369457795323609),
        ("cusp_theta_2", 8.2143097847709768694),
    ];

    /// Each effect alone gives its own nodes, claims and picture, and nothing of the others.
    #[test]
    fn effects_are_followed() {
        let all = "[\"conjugate-locus\", \"cut-locus\", \"wave-front\", \"geodesics\"]";
        for (effect, claims) in [("conjugate-locus", 6), ("cut-locus", 2), ("wave-front", 1), ("geodesics", 0)] {
            let preview = preview::run(&EXPERIMENT, |text| {
                let text = text.replace(all, &format!("[\"{effect}\"]"));
                text.replace("cusp = 40\ntail = 44", "cusp = 4\ntail = 6")
            });
            assert_eq!(preview.findings.claims.len(), claims, "{effect}");
        }
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("phi0 = [0.0, -0.75]", "phi0 = [0.0, -1.6]", "scene.start.phi0[1]"),
            ("smallest = 1e-8", "smallest = 0.5", "spacing.smallest"),
            ("t = [3.0,", "t = [-3.0,", "wave_front.t[0]"),
            ("turns = 3.5", "turns = 0.0", "picture.turns"),
            ("\"cut-locus\"", "\"attitude\"", "scene.effects[1]"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/fig3.toml"), &cases);
    }
}
