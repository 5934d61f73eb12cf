//! Fig. 7 (section 5.2.2): conjugate loci of the spin problem for k < 1, with the extremals that reach them.
//!
//! The metric `(dr1² + k² dr3²)/r2²` on S²; start `θ = 0`, `φ = π/2` on its singular equator, `H = 1`, `p_φ = ±2`, `p_θ ∈ R`. Shown in
//! the chart (θ, φ), φ from the pole, both in radians, θ and θ + 2π being the same. Times are in the unit that `H = 1` fixes.
//!
//! Hard spots: the cusp is the limit `p_θ → 0`, and it is approached slowly: for k = 0.1 while p_θ falls from 1e-4 to 1e-8. There an integration in
//! f64 loses digits like `ε/p_θ²`, so the second route goes to double-double. The locus runs close by the pole φ = π, where the chart
//! stretches it: between p_θ = 0.0008 and 0.001 for k = 0.1 it turns through 3 radians of θ.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim, unread};
use super::nodes::Nodes;
use super::scenes::curves::curves;
use super::scenes::more::Asked;
use super::spin_branches::{
    Branch, ask_for_branch, contact, cusp_inset, cusp_values, largest_route_difference, name_of, origins, other_half,
    routes_agree, turned,
};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{BranchStart, Effect, SPIN, Scene, SpinMetric};
use crate::effects::spin::by_integration::tolerance;
use crate::effects::spin::geodesics::Geodesics;
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points, RuleLine};
use crate::plot::picture::{Layout, Panel, Picture, Place, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// The values of k in (0, 1), the starts, the effects, the accuracy.
    pub scene: Scene<SpinMetric, BranchStart>,
    /// The extremals shown.
    pub trajectories: Trajectories,
}

/// Extremals whose ends are spread evenly along the branch `p_φ = −2`, `p_θ ≥ 0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trajectories {
    /// How many, 1 to 100.
    pub count: u32,
    /// Largest distance of neighbouring points, radians, 0.001 to 0.5.
    pub step: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene
            .metric
            .spin
            .k
            .validate_each("scene.metric.spin.k", "0 < k < 1 (Fig. 5 is for k ≥ 1)", |k| k < 1.0)?;
        Invalid::unless(
            self.scene.metric.spin.k.count() <= 12,
            "scene.metric.spin.k",
            format_args!("{} values", self.scene.metric.spin.k.count()),
            "at most 12 values: one panel each",
        )?;
        self.scene.start.validate()?;
        self.scene.validate_effects(&OWN, SPIN)?;
        let Trajectories { count, step } = self.trajectories;
        Invalid::unless((1..=100).contains(&count), "trajectories.count", count, "1 to 100")?;
        Invalid::number((1e-3..=0.5).contains(&step), "trajectories.step", step, "a number from 0.001 to 0.5 (radians)")
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 2] = [Effect::Geodesics, Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig7>();

const PICTURE: Kind = picture_kind(
    "fig7-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig7.rs",
        "experiments/spin_branches.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig7-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "effects/spin/contact.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig7.rs",
        "experiments/spin_branches.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
);
const GEODESICS: &str = "geodesics";

struct Fig7;

/// A change of θ along an extremal that counts as one: far above the error of its points.
const SEEN: f64 = 1e-6;

/// How far θ moves along a curve in the direction of `sign`, in all.
fn moved(curve: &[(f64, f64)], sign: f64) -> f64 {
    curve.windows(2).map(|pair| (sign * (pair[1].0 - pair[0].0)).max(0.0)).sum()
}

/// The claim that θ is not monotone along some extremal of each k.
fn not_monotone(ks: &[f64], tables: &Tables) -> Result<Claim, NodeError> {
    let mut all: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for k in ks {
        let table = tables.get(&name_of(GEODESICS, *k)).map_err(unread)?;
        let moves = curves(table, "index")?.iter().map(|curve| [-1.0, 1.0].map(|sign| moved(curve, sign))).collect();
        all.push((*k, moves));
    }
    // Decrease and increase along each extremal of one k.
    let test = |holds: fn(&[[f64; 2]]) -> bool| {
        let case = |(k, moves): &(f64, Vec<[f64; 2]>)| {
            let falls = moves.iter().map(|[fall, _]| *fall).fold(0.0, f64::max);
            (holds(moves), format!("k = {k:?}: the largest decrease is {falls:e}"))
        };
        Cases::of(all.iter().map(case)).test()
    };
    Ok(claim(
        "theta_not_monotone",
        "section 5.2.2",
        "For k < 1 the variable θ is not monotone (along some extremal, up to t1).",
        Evidence::Direct(test(|moves| moves.iter().any(|[fall, growth]| *fall > SEEN && *growth > SEEN))),
        "",
    )
    .refusing("θ never falls", test(|moves| moves.iter().all(|[fall, _]| *fall <= SEEN)))
    .refusing("θ never grows", test(|moves| moves.iter().all(|[_, growth]| *growth <= SEEN)))
    .refusing("θ falls somewhere along every extremal", test(|moves| moves.iter().all(|[fall, _]| *fall > SEEN))))
}

/// The claim about where the cusp of each k is.
fn cusp_claim(branches: &[Branch<'_>]) -> Claim {
    // t1 between two multiples of π, and whether the cusp is beyond the equator then.
    let test = |low: f64, high: f64, beyond: bool| {
        let case = |branch: &Branch<'_>| {
            let (k, t1, phi) = (branch.k, branch.t1[0], branch.phi[0]);
            let inside = t1 > low * PI && t1 < high * PI && (phi > FRAC_PI_2) == beyond;
            (inside, format!("k = {k:?}: t1 = {t1:?}, φ = {phi:?}"))
        };
        Cases::of(branches.iter().map(case)).test()
    };
    claim(
        "cusp_stays_beyond_equator",
        "section 5.2.3",
        "For k < 1 the cusp does not cross the equator.",
        Evidence::Direct(test(1.0, 1.5, true)),
        "For p_θ = 0 and k < 1, t1 solves l tan t = tanh(l t), l² = 1/k² − 1, which has its first root in (π, 3π/2) for every l: \
         between the equator, reached as k → 0, and the round case.",
    )
    .refusing("it does: φ < π/2, with t1 in (π, 3π/2)", test(1.0, 1.5, false))
    .refusing("it stays beyond, with t1 in (π/2, π)", test(0.5, 1.0, true))
    .refusing("it stays beyond, with t1 in (3π/2, 2π)", test(1.5, 2.0, true))
}

fn branches<'a>(params: &Params, tables: &'a Tables) -> Result<Vec<Branch<'a>>, NodeError> {
    if !params.scene.asks_for(Effect::ConjugateLocus) {
        return Ok(Vec::new());
    }
    params.scene.metric.spin.k.values().into_iter().map(|k| Branch::of(tables, k)).collect()
}

fn panel(params: &Params, tables: &Tables, k: f64) -> Result<Panel, NodeError> {
    let theta = Axis::new("*θ*").fixed(-1.12 * PI, 1.12 * PI).pi_ticks();
    let phi = Axis::new("*φ*").fixed(0.0, PI).pi_ticks();
    let mut panel = Panel::new(theta, phi).equal().title(format!("*k* = {k}"));
    panel = panel
        .mark(RuleLine::horizontal(Role::Equator, FRAC_PI_2).legend("equator"))
        .mark(RuleLine::vertical(Role::Reference, PI).legend("*θ* = ±π, one meridian"))
        .mark(RuleLine::vertical(Role::Reference, -PI));
    if params.scene.asks_for(Effect::Geodesics) {
        let table = tables.get(&name_of(GEODESICS, k)).map_err(unread)?;
        let text = "extremals up to their first conjugate points";
        panel = panel
            .marks(curves(table, "index")?.into_iter().map(|points| Curve::new(Role::Geodesic, points).legend(text)));
    }
    if params.scene.asks_for(Effect::ConjugateLocus) {
        let branch = Branch::of(tables, k)?;
        let half = branch.half();
        for half in [half.clone(), other_half(&half)] {
            panel = panel.marks(
                [-1.0, 0.0, 1.0]
                    .map(|turns| Curve::new(Role::ConjugateLocus, turned(&half, turns)).legend("conjugate locus")),
            );
        }
        let cusp = branch.phi[0];
        let cusps = [-PI, PI].into_iter().flat_map(|theta| [(theta, cusp), (theta, PI - cusp)]).collect();
        panel = panel.mark(Points::new(Role::CuspPoint, cusps).legend("cusp, *p*_θ = 0"));
        panel = panel.inset(cusp_inset(&branch, Place::At(0.075, 0.29), (0.27, 0.42)));
    }
    Ok(panel.mark(Points::new(Role::Start, vec![(0.0, FRAC_PI_2)]).legend("start")))
}

impl Definition for Fig7 {
    type Params = Params;

    const ID: &'static str = "fig7";
    const TITLE: &'static str = "conjugate loci of the spin problem for k < 1";
    const PLACE: &'static str = "Figure 7, section 5.2.2";
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
        for (index, k) in sweep.values().into_iter().enumerate() {
            if params.scene.asks_for(Effect::Geodesics) {
                let Trajectories { count, step } = params.trajectories;
                let geodesics =
                    Geodesics { k, p_theta: p_theta.into(), count, step, tolerance: tolerance(params.scene.accuracy) };
                let mut origins = origins(sweep, index);
                origins.push(("count", "trajectories.count".to_owned()));
                origins.push(("step", "trajectories.step".to_owned()));
                origins.push(("tolerance", "scene.accuracy".to_owned()));
                nodes.add(GEODESICS, &[("k", format!("{k:?}"))], geodesics, &[], &origins)?;
            }
            if params.scene.asks_for(Effect::ConjugateLocus) {
                ask_for_branch(nodes, (sweep, index), p_theta, params.scene.accuracy)?;
            }
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let ks = params.scene.metric.spin.k.values();
        let columns = if ks.len() > 1 { 2 } else { 1 };
        let rows = ks.len().div_ceil(columns);
        let mut caption =
            "Spin problem, start (θ, φ) = (0, π/2) on the equator, H = 1, in the chart (θ, φ), φ from the pole."
                .to_owned();
        if params.scene.asks_for(Effect::ConjugateLocus) {
            let counts: Vec<String> = branches(params, tables)?
                .iter()
                .map(|branch| format!("{} for k = {}", branch.p_theta.len(), branch.k))
                .collect();
            caption.push_str(&format!(
                " Thick: the conjugate locus for p_φ(0) = ±2 and p_θ(0) of both signs, points where the phase of the closed form is π, relative \
                 error of t1 below 1e-14; one branch, p_φ = −2, p_θ ≥ 0, has {} points, the others are its mirror images. It is continued beyond \
                 θ = ±π, which is one meridian, to show the cusps: the limits p_θ → 0, on the far side of the equator. Insets: the cusp of p_φ = −2 at its own scale, as difference of φ over difference of θ to its tip, which points away from the \
                 equator; the smaller k, the smaller it is (for k = 0.2 less than 1e-14).",
                counts.join(", ")
            ));
        }
        if params.scene.asks_for(Effect::Geodesics) {
            caption.push_str(&format!(
                " Thin: {} extremals with p_φ = −2, p_θ ≥ 0 up to their first conjugate points, which are spread evenly along that branch; \
                 h' = ω × h, r' = ω × r integrated in R³ × so(3)*.",
                params.trajectories.count
            ));
        }
        let mut picture =
            Picture::new(Width::Double, 45.0 * rows as f64 + 12.0, "Conjugate loci of the spin problem for k < 1")
                .caption(caption)
                .layout(Layout::Columns(columns));
        for k in ks {
            picture = picture.panel(panel(params, tables, k)?);
        }
        Ok(picture)
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let branches = branches(params, tables)?;
        if branches.is_empty() {
            return Ok(Vec::new());
        }
        let mut values = cusp_values(&branches);
        values.push(largest_route_difference(tables)?);
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let mut claims = Vec::new();
        if params.scene.asks_for(Effect::Geodesics) {
            claims.push(not_monotone(&params.scene.metric.spin.k.values(), tables)?);
        }
        let branches = branches(params, tables)?;
        if !branches.is_empty() {
            claims.push(cusp_claim(&branches));
            claims.push(contact(&branches));
            claims.push(routes_agree(tables)?);
        }
        Ok(claims)
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
        let claims = ["theta_not_monotone", "cusp_stays_beyond_equator", "contact_of_order_two", "routes_agree"];
        assert_claims(&preview, &claims);
    }

    #[test]
    fn an_effect_left_out_takes_its_findings_along() {
        let without = preview::run(&EXPERIMENT, |text| {
            text.replace("\"geodesics\", ", "").replace("[0.8, 0.5, 0.2, 0.1]", "0.8")
        });
        assert_claims(&without, &["cusp_stays_beyond_equator", "contact_of_order_two", "routes_agree"]);
        let without = preview::run(&EXPERIMENT, |text| {
            text.replace(", \"conjugate-locus\"]", "]").replace("[0.8, 0.5, 0.2, 0.1]", "0.8")
        });
        assert_claims(&without, &["theta_not_monotone"]);
        assert!(without.findings.values.is_empty());
    }

    /// Oracle: the closed form at every sample of every extremal; the ends are conjugate points of the branch.
    #[test]
    fn trajectories_are_accurate() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for k in ["0.8", "0.5", "0.2", "0.1"] {
            let table = preview.table(&format!("geodesics/k={k}"));
            assert_eq!(table.ints("index").unwrap().last(), Some(&14));
            assert!(table.f64s("difference").unwrap().iter().all(|difference| *difference < 1e-11));
        }
    }
}
