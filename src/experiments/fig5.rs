//! Fig. 5 (section 5.2.1): how one branch of the spin problem's conjugate locus deforms with k ≥ 1.
//!
//! The metric `(dr1² + k² dr3²)/r2²` on S²; start `θ = 0`, `φ = π/2` on its singular equator, `H = 1`, `p_φ = −2`, `p_θ ≥ 0`. Shown in the
//! chart (θ, φ), φ from the pole, both in radians. The branch leaves the start tangentially to the meridian and ends, for `p_θ → 0`, in
//! a cusp on the meridian of the start: on its far half θ = π for `k < k1`, at θ = 0 for `k1 < k < k2`, at θ = π again for `k2 < k < k3`.
//!
//! Hard spots: beside the poles the chart stretches the branch; where it crosses the equator `t1(p_θ)` has a vertical tangent. For
//! `k > k̄ = 2/√3` the strand that comes from the cusp crosses the arc that leaves the start: the loop of the article. Its double point is solved as
//! two momenta with one conjugate point; for `k → k̄` it goes to the start.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim, unread};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use super::spin_branches::{
    Branch, Switches, ask_for_branch, ask_for_double_points, contact, cusp_values, double_point_values, double_points,
    largest_route_difference, routes_agree, switches, validate_panels,
};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::sweep::Sweep;
use crate::contract::value::NamedValue;
use crate::effects::scene::{BranchStart, Effect, SPIN, Scene, SpinMetric};
use crate::effects::spin::loops::Loops;
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points, RuleLine};
use crate::plot::picture::{Inset, Panel, Picture, Place, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// The values of k ≥ 1, the starts, the effect, the accuracy.
    pub scene: Scene<SpinMetric, BranchStart>,
    /// The search for loops.
    pub loops: LoopSearch,
    /// One to four panels.
    pub panels: Vec<PanelParams>,
}

/// Where the branch is searched for double points, for statements about all k.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoopSearch {
    /// Values of k, 1 to 3, at most 400 of them.
    pub k: Sweep,
}

/// One panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PanelParams {
    /// Its values of k, one to four of the scene's.
    pub k: Vec<f64>,
    /// A part of it drawn again at its own scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inset: Option<InsetParams>,
}

/// A part of a panel drawn again at its own scale.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InsetParams {
    /// The range of θ, radians.
    pub theta: (f64, f64),
    /// The range of φ, radians.
    pub phi: (f64, f64),
    /// The inset's lower left corner, in fractions of the panel.
    pub at: (f64, f64),
    /// Its width and height, in fractions of the panel.
    pub size: (f64, f64),
}

impl InsetParams {
    fn validate(&self, key: &str) -> Result<(), Invalid> {
        for (name, (from, to)) in [("theta", self.theta), ("phi", self.phi)] {
            Invalid::number(
                from < to && to - from <= PI,
                format!("{key}.{name}[1]"),
                to,
                format!("a number above {from:?}"),
            )?;
        }
        for (axis, (at, size)) in [(self.at.0, self.size.0), (self.at.1, self.size.1)].into_iter().enumerate() {
            let accepted = "at and size from 0 to 1, size at least 0.2, at + size at most 1";
            let inside = at >= 0.0 && size >= 0.2 && at + size <= 1.0;
            Invalid::number(inside, format!("{key}.size[{axis}]"), size, accepted)?;
        }
        Ok(())
    }
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        let sweep = &self.scene.metric.spin.k;
        sweep
            .validate_each("scene.metric.spin.k", "1 <= k <= 3 (Fig. 7 is for k < 1)", |k| (1.0..=3.0).contains(&k))?;
        self.scene.start.validate()?;
        self.scene.validate_effects(&OWN, SPIN)?;
        self.loops.k.validate_each("loops.k", "1 <= k <= 3", |k| (1.0..=3.0).contains(&k))?;
        let count = self.loops.k.count();
        Invalid::unless(count <= 400, "loops.k", format_args!("{count} values"), "at most 400 values")?;
        validate_panels(sweep, &self.panels.iter().map(|panel| &panel.k).collect::<Vec<_>>(), 4)?;
        for (i, panel) in self.panels.iter().enumerate() {
            panel.inset.map_or(Ok(()), |inset| inset.validate(&format!("panels[{i}].inset")))?;
        }
        Ok(())
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig5>();

const PICTURE: Kind = picture_kind(
    "fig5-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig5.rs",
        "experiments/spin_branches.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig5-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "effects/spin/contact.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig5.rs",
        "experiments/spin_branches.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
);
const LOOPS: &str = "loops";

struct Fig5;

fn branches<'a>(params: &Params, tables: &'a Tables) -> Result<Vec<Branch<'a>>, NodeError> {
    params.scene.metric.spin.k.values().into_iter().map(|k| Branch::of(tables, k)).collect()
}

/// Where k stands in the family of all curves: within the darker three quarters of the colour scale.
fn tone(params: &Params, k: f64) -> f64 {
    let ks = params.scene.metric.spin.k.values();
    let (low, high) = ks.iter().fold((k, k), |(low, high), k| (low.min(*k), high.max(*k)));
    if high > low { 0.75 * (k - low) / (high - low) } else { 0.0 }
}

fn panel(params: &Params, tables: &Tables, shown: &PanelParams) -> Result<Panel, NodeError> {
    let ticks = || [(0.0, "0"), (0.25 * PI, "π/4"), (FRAC_PI_2, "π/2"), (0.75 * PI, "3π/4"), (PI, "π")];
    let (theta, phi) = (Axis::new("*θ*").fixed(0.0, PI), Axis::new("*φ*").fixed(0.0, PI));
    let mut panel = Panel::new(theta.ticks_at(ticks()), phi.ticks_at(ticks()))
        .equal()
        .mark(RuleLine::horizontal(Role::Equator, FRAC_PI_2).legend("equator"));
    for k in &shown.k {
        let branch = Branch::of(tables, *k)?;
        let curve = Curve::new(Role::ConjugateLocus, branch.chart()).tone(tone(params, *k));
        panel = panel.mark(curve.label(format!("*k* = {k}")));
        let cusp = vec![(branch.theta[0], branch.phi[0])];
        panel = panel.mark(Points::new(Role::CuspPoint, cusp).legend("cusp, *p*_θ = 0"));
        let places: Vec<_> = double_points(tables, *k)?.iter().map(|point| point.place).collect();
        panel = panel.mark(Points::new(Role::SelfIntersection, places).legend("double point"));
    }
    panel = panel.mark(Points::new(Role::Start, vec![(0.0, FRAC_PI_2)]).legend("start"));
    if let Some(InsetParams { theta, phi, at, size }) = shown.inset {
        panel = panel.inset(Inset::new(theta, phi, Place::At(at.0, at.1), size));
    }
    Ok(panel)
}

impl Definition for Fig5 {
    type Params = Params;

    const ID: &'static str = "fig5";
    const TITLE: &'static str = "deformation of a branch of the spin problem's conjugate locus, k ≥ 1";
    const PLACE: &'static str = "Figure 5, section 5.2.1";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::spin(&params.scene, &OWN, Some(params.scene.start.p_theta))
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let (sweep, p_theta) = (&params.scene.metric.spin.k, params.scene.start.p_theta);
        for index in 0..sweep.count() {
            ask_for_branch(nodes, (sweep, index), p_theta, params.scene.accuracy)?;
            ask_for_double_points(nodes, (sweep, index), p_theta, params.scene.accuracy)?;
        }
        let loops = Loops { k: params.loops.k.values(), p_theta };
        let origins = [("k", "loops.k".to_owned()), ("p_theta", "scene.start.p_theta".to_owned())];
        nodes.add(LOOPS, &[], loops, &[], &origins)?;
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let counts: Vec<String> = branches(params, tables)?
            .iter()
            .map(|branch| format!("{} for k = {}", branch.p_theta.len(), branch.k))
            .collect();
        let columns = params.panels.len() as f64;
        let width = if params.panels.len() > 1 { Width::Double } else { Width::Single };
        let height = ((width.millimetres() - 6.0) / columns - 10.0).min(110.0) + 19.0;
        let mut picture = Picture::new(width, height, "Deformation of one branch of the conjugate locus, k ≥ 1").caption(format!(
            "Spin problem: the branch p_φ(0) = −2, p_θ(0) ≥ 0 of the conjugate locus of the start (0, π/2) on the equator, H = 1, in the chart (θ, φ), φ \
             from the pole. It ends in a cusp for p_θ → 0 and touches the meridian at the start for p_θ → ∞. From k̄ = 2/√3 = 1.1547… on, \
             where the cusp passes the start, it has a loop; circles: its double point. First conjugate points where the phase of the closed form is π, \
             relative error of t1 below 1e-11, each checked by integrating h' = ω × h, r' = ω × r; points: {}.",
            counts.join(", ")
        ));
        for shown in &params.panels {
            picture = picture.panel(panel(params, tables, shown)?);
        }
        Ok(picture)
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = cusp_values(&branches(params, tables)?);
        for k in params.scene.metric.spin.k.values() {
            values.extend(double_point_values(&double_points(tables, k)?));
        }
        values.push(largest_route_difference(tables)?);
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let loops = tables.get(LOOPS).map_err(unread)?;
        let column = |name: &str| loops.f64s(name).map_err(unread);
        let (ks, low, high, cusp) = (column("k")?, column("theta_low")?, column("theta_high")?, column("cusp_theta")?);
        let (length, count) = (column("loop_length")?, loops.ints("double_points").map_err(unread)?);
        let Switches { k1, k_bar, k2, k3 } = switches();
        let considered = || (0..ks.len()).filter(|i| ks[*i] <= k3);
        let lies = |inside: &dyn Fn(f64, f64) -> bool| {
            let words = |i: usize| format!("k = {:?}: θ from {:?} to {:?}", ks[i], low[i], high[i]);
            Cases::of(considered().map(|i| (inside(low[i], high[i]), words(i)))).test()
        };
        let loops_from = |from: f64, loops: i64| {
            let expected = |i: usize| if ks[i] < from { 0 } else { loops };
            let words = |i: usize| format!("k = {:?}: {} double points", ks[i], count[i]);
            Cases::of(considered().map(|i| (count[i] == expected(i), words(i)))).test()
        };
        let ends = |[first, second]: [f64; 2], [outside, between]: [f64; 2]| {
            let expected = |i: usize| if ks[i] > first && ks[i] < second { between } else { outside };
            let words = |i: usize| format!("k = {:?}: the cusp is at θ = {:?}", ks[i], cusp[i]);
            // On the meridian θ is 0 or π exactly.
            Cases::of(considered().map(|i| (cusp[i] == expected(i) || ks[i] == second, words(i)))).test()
        };
        let lengths: Vec<_> = (0..ks.len()).filter(|i| length[*i].is_finite()).map(|i| (ks[i], length[i])).collect();
        let falls = |values: &[(f64, f64)]| {
            Cases::of(values.windows(2).map(|pair| (pair[1].1 < pair[0].1, format!("(k, value): {pair:?}")))).test()
        };
        let backwards: Vec<_> = lengths.iter().rev().copied().collect();
        let steps: Vec<_> = lengths.windows(2).map(|pair| (pair[1].0, pair[1].1 - pair[0].1)).collect();
        Ok(vec![
            claim(
                "half_plane",
                "section 5.2.1",
                "For any k in [1, k3] the branch lies in the half-plane θ ≥ 0.",
                Evidence::Direct(lies(&|low, high| low >= 0.0 && high <= PI)),
                "Every sample of every branch; also θ ≤ π.",
            )
            .refusing("It lies in the half-plane θ ≤ 0.", lies(&|low, high| low >= -PI && high <= 0.0))
            .refusing("It lies in 0 ≤ θ ≤ π/2.", lies(&|low, high| low >= 0.0 && high <= FRAC_PI_2))
            .refusing("It nowhere reaches θ = 0.", lies(&|low, high| low > 0.0 && high <= PI)),
            claim(
                "loop",
                "section 5.2.1",
                "The branch forms a loop for k̄ ≤ k ≤ k3 (and none before).",
                Evidence::Direct(loops_from(k_bar, 1)),
                "At k̄ the cusp passes the start along the meridian θ = 0. From then on the strand that comes from the cusp has to cross the arc that \
                 leaves the start, which touches the meridian from the other side of the equator: a double point, one for each k examined.",
            )
            .refusing("from k1 on", loops_from(k1, 1))
            .refusing("from k2 on", loops_from(k2, 1))
            .refusing("two loops", loops_from(k_bar, 2)),
            claim(
                "ends_on_meridian",
                "section 5.2.1",
                "The branch ends at θ = π for k < k1, at θ = 0 for k1 < k < k2, at θ = π for k2 < k < k3.",
                Evidence::Direct(ends([k1, k2], [PI, 0.0])),
                "The limit p_θ → 0: k1 = 3/√8, k2 = 5/4, k3 = 7/√24.",
            )
            .refusing("0 and π exchanged", ends([k1, k2], [0.0, PI]))
            .refusing("at θ = 0 for k̄ < k < k2", ends([k_bar, k2], [PI, 0.0]))
            .refusing("at θ = 0 for k1 < k < k3", ends([k1, k3], [PI, 0.0])),
            claim(
                "loops_shrink",
                "section 5.2.3",
                "The loops become smaller and smaller for greater values of k.",
                Evidence::Direct(falls(&lengths)),
                "The length of the loop on the sphere, over the values of k examined.",
            )
            .refusing("They become smaller for smaller values of k.", falls(&backwards))
            .refusing("They become smaller faster and faster.", falls(&steps)),
            contact(&branches(params, tables)?),
            routes_agree(tables)?,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::preview;
    use crate::experiments::spin_branches::tests::{assert_claims, assert_references};

    /// Oracle: mpmath, tests/oracle/values.toml.
    #[test]
    fn values_and_claims() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        assert_references(EXPERIMENT.kind, &preview);
        let claims = ["half_plane", "loop", "ends_on_meridian", "loops_shrink", "contact_of_order_two", "routes_agree"];
        assert_claims(&preview, &claims);
    }
}
