//! Fig. 8 (section 5.2.3): how the conjugate locus of the spin problem deforms with k, on the sphere.
//!
//! The metric `(dr1² + k² dr3²)/r2²` on S²; start `r = (1, 0, 0)` on its singular equator `r2 = 0`, `H = 1`. Half of each locus is
//! shown, `p_φ = −2`, `p_θ ∈ R`: it leaves the start along the meridian, to both sides of it, and ends in a cusp on the same meridian, the
//! limit `p_θ → 0`. Angles in radians; the pole `r2 = 1`, φ = 0, is up and called N.
//!
//! Hard spot: for `k > k̄ = 2/√3` the cusp has passed the start, and each branch, p_θ ≥ 0 and p_θ ≤ 0, has a loop, whose double point
//! is close to the start.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use super::spin_branches::{
    Branch, ask_for_branch, ask_for_double_points, contact, cusp_values, double_point_values, double_points,
    largest_route_difference, routes_agree, switches, validate_panels,
};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{BranchStart, Effect, SPIN, Scene, SpinMetric};
use crate::plot::mark::{SphereCurve, SpherePoints};
use crate::plot::picture::{Panel, Picture, View, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// The values of k, the starts, the effect, the accuracy.
    pub scene: Scene<SpinMetric, BranchStart>,
    /// One to three spheres.
    pub panels: Vec<Sphere>,
}

/// The loci on one sphere, and from where it is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its values of k, one to four of the scene's; the first of several is the reference.
    pub k: Vec<f64>,
    /// Where the viewer stands: degrees from the start towards θ > 0, −360 to 360.
    pub longitude: f64,
    /// Where the viewer stands: degrees north of the equator (towards φ = 0), −90 to 90.
    pub latitude: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        let sweep = &self.scene.metric.spin.k;
        sweep.validate_each("scene.metric.spin.k", "0 < k <= 3", |k| k <= 3.0)?;
        self.scene.start.validate()?;
        self.scene.validate_effects(&OWN, SPIN)?;
        validate_panels(sweep, &self.panels.iter().map(|panel| &panel.k).collect::<Vec<_>>(), 3)?;
        for (i, Sphere { longitude, latitude, .. }) in self.panels.iter().enumerate() {
            let key = |name: &str| format!("panels[{i}].{name}");
            Invalid::number(longitude.abs() <= 360.0, key("longitude"), *longitude, "-360 to 360 (degrees)")?;
            Invalid::number(latitude.abs() <= 90.0, key("latitude"), *latitude, "-90 to 90 (degrees)")?;
        }
        Ok(())
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig8>();

const PICTURE: Kind = picture_kind(
    "fig8-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig8.rs",
        "experiments/spin_branches.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig8-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "effects/spin/contact.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/findings.rs",
        "experiments/fig8.rs",
        "experiments/spin_branches.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
);

struct Fig8;

fn branches<'a>(params: &Params, tables: &'a Tables) -> Result<Vec<Branch<'a>>, NodeError> {
    params.scene.metric.spin.k.values().into_iter().map(|k| Branch::of(tables, k)).collect()
}

fn sphere(tables: &Tables, shown: &Sphere) -> Result<Panel, NodeError> {
    let mut panel = Panel::sphere(View::new(shown.longitude.to_radians(), shown.latitude.to_radians()));
    let others: Vec<f64> = shown.k.iter().skip(1).copied().collect();
    for (place, k) in shown.k.iter().enumerate() {
        let branch = Branch::of(tables, *k)?;
        let is_reference = place == 0 && !others.is_empty();
        let role = if is_reference { Role::ConjugateLocusReference } else { Role::ConjugateLocus };
        let mut curve = SphereCurve::new(role, branch.half_on_sphere());
        // Several loci of one role are told apart by lightness, in the order of the list.
        if !is_reference && others.len() > 1 {
            curve = curve.tone(0.15 + 0.5 * (place - 1) as f64 / (others.len() - 1) as f64);
        }
        panel = panel.mark(curve);
        let [r1, r2, r3] = branch.r;
        let cusp = SpherePoints::new(Role::CuspPoint, vec![[r1[0], r3[0], r2[0]]]);
        panel = panel.mark(cusp.labels([format!("*k* = {k}")]).legend("cusp, *p*_θ = 0"));
        let places: Vec<[f64; 3]> = double_points(tables, *k)?
            .iter()
            .flat_map(|point| {
                let [x, y, z] = point.on_sphere;
                [[x, y, z], [x, -y, z]]
            })
            .collect();
        if !places.is_empty() {
            panel = panel.mark(SpherePoints::new(Role::SelfIntersection, places).legend("double point"));
        }
    }
    Ok(panel
        .mark(SpherePoints::new(Role::Start, vec![[1.0, 0.0, 0.0]]).labels(["start"]))
        .mark(SpherePoints::new(Role::Pole, vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]).labels(["N", "S"])))
}

/// Whether a cusp is on the half of its meridian that is opposite to the start.
fn is_far(branch: &Branch<'_>) -> bool {
    branch.theta[0] == PI
}

/// Whether a cusp is on the other side of the equator than the pole φ = 0.
fn is_beyond(branch: &Branch<'_>) -> bool {
    branch.phi[0] > FRAC_PI_2
}

/// The test of where the cusps of some loci are.
fn places<'a>(branches: impl Iterator<Item = &'a Branch<'a>>, holds: impl Fn(&Branch<'_>) -> bool) -> Test {
    let place = |branch: &Branch<'_>| {
        format!("k = {:?}: the cusp is at θ = {:?}, φ = {:?}", branch.k, branch.theta[0], branch.phi[0])
    };
    Cases::of(branches.map(|branch| (holds(branch), place(branch)))).test()
}

/// The claim about the cusps of k < 1, if the scene has one.
fn below_claim(branches: &[Branch<'_>]) -> Option<Claim> {
    let below = || branches.iter().filter(|branch| branch.k < 1.0);
    below().next()?;
    let test = |far: bool, beyond: bool| places(below(), |branch| is_far(branch) == far && is_beyond(branch) == beyond);
    let claimed = claim(
        "cusp_stays_beyond_equator",
        "section 5.2.3",
        "For k < 1 the cusp does not cross the equator.",
        Evidence::Direct(test(true, true)),
        "",
    );
    Some(
        claimed
            .refusing("it crosses the equator: φ < π/2 at θ = π", test(true, false))
            .refusing("it does not, and is on the half of the start: φ > π/2 at θ = 0", test(false, true)),
    )
}

/// The claim about the order of the cusp's crossings for k from 1 to k2, if the scene has one.
fn order_claim(branches: &[Branch<'_>]) -> Option<Claim> {
    let switches = switches();
    let above = || branches.iter().filter(|branch| branch.k >= 1.0 && branch.k < switches.k2);
    above().next()?;
    let test = |pole: f64, equator: f64| {
        places(above(), |branch| is_far(branch) == (branch.k < pole) && is_beyond(branch) == (branch.k < equator))
    };
    let claimed = claim(
        "pole_then_equator",
        "section 5.2.3",
        "For k > 1 the cusp first crosses a pole (k = k1), then the equator (k = k̄).",
        Evidence::Direct(test(switches.k1, switches.k_bar)),
        "It moves along the meridian of the start: θ = π before k1, θ = 0 after it; φ > π/2 before k̄, φ < π/2 after it. The crossing of the \
         equator is at the start itself. k1 = 3/√8 and k̄ = 2/√3 in the limit p_θ → 0.",
    );
    Some(
        claimed
            .refusing("first the equator (k = k1), then a pole (k = k̄)", test(switches.k_bar, switches.k1))
            .refusing("a pole at k = k1, the equator at k = k2", test(switches.k1, switches.k2))
            .refusing("a pole at k = k̄, the equator at k = k2", test(switches.k_bar, switches.k2))
            .refusing("a pole at k = 1, the equator at k = k̄", test(1.0, switches.k_bar)),
    )
}

/// The claim about which pole the cusp crosses at k1, if the scene has a k on either side of it.
fn pole_claim(branches: &[Branch<'_>]) -> Claim {
    let switches = switches();
    let within = |low: f64, high: f64| branches.iter().find(|branch| branch.k > low && branch.k < high);
    let before = branches.iter().find(|branch| branch.k >= 1.0 && branch.k < switches.k1);
    let after = within(switches.k1, switches.k_bar);
    // What lies on the meridian between two cusps, as φ: a pole if they are on opposite halves, else the equator.
    let between = |before: &Branch<'_>, after: &Branch<'_>| {
        if is_far(before) == is_far(after) {
            FRAC_PI_2
        } else if is_beyond(before) && is_beyond(after) {
            PI
        } else {
            0.0
        }
    };
    let test = |north: f64, passed: f64| Test::Equal {
        printed: north,
        ours: passed,
        tolerance: 0.0,
        reason: "φ of what lies between the cusps of a k below the crossing and of one above it".to_owned(),
    };
    let evidence = if let (Some(before), Some(after)) = (before, after) {
        let passed = between(before, after);
        Evidence::OnlyWhen {
            condition: "the North pole is φ = π, not φ = 0".to_owned(),
            inside: test(PI, passed),
            outside: test(0.0, passed),
        }
    } else {
        Evidence::NotChecked { reason: "the scene has no k in [1, k1), or none in (k1, k̄)".to_owned() }
    };
    let mut claimed = claim(
        "first_pole",
        "section 5.2.3",
        "For k > 1 the cusp first crosses the North pole (k = k1).",
        evidence,
        "The text does not say which pole is North; φ is measured from the pole φ = 0, which is N in the figure. With p_φ(0) = −2 \
               the extremals go first over φ = 0; the cusp is reached on the way back, after t1 = 3π/2 on the meridian, at the pole φ = \
               π. It is φ = 0 for the other half, p_φ(0) = 2.",
    );
    if let (Some(before), Some(after)) = (before, after) {
        let passed = between(before, after);
        claimed = claimed
            .refusing("the cusp of the other half, p_φ(0) = 2, crosses φ = π", test(PI, PI - passed))
            .refusing("the cusp first crosses the equator (k = k1)", test(FRAC_PI_2, passed));
        if let Some(later) = within(switches.k_bar, switches.k2) {
            claimed = claimed.refusing("the cusp crosses φ = π at k = k̄", test(PI, between(after, later)));
        }
    }
    claimed
}

/// The claim about from which k on the locus has double points, if the scene has a k up to k3.
fn loops_claim(branches: &[Branch<'_>], tables: &Tables) -> Result<Option<Claim>, NodeError> {
    let switches = switches();
    let mut counts = Vec::new();
    for branch in branches.iter().filter(|branch| branch.k <= switches.k3) {
        counts.push((branch.k, double_points(tables, branch.k)?.len()));
    }
    if counts.is_empty() {
        return Ok(None);
    }
    // So many double points or more above a value of k, fewer below.
    let test = |least: usize, from: f64| {
        let words = |k: f64, count: usize| format!("k = {k:?}: {count} double points");
        Cases::of(counts.iter().map(|(k, count)| ((*count >= least) == (*k > from), words(*k, *count)))).test()
    };
    let claimed = claim(
        "self_intersections",
        "section 5.2.3",
        "For k ≥ k̄ the conjugate locus has self-intersections (and not before).",
        Evidence::Direct(test(1, switches.k_bar)),
        "Of one branch, p_θ ≥ 0, with itself; those of p_θ ≤ 0 are their mirror images. Fig. 5 examines more values of k.",
    );
    Ok(Some(
        claimed
            .refusing("from k1 on", test(1, switches.k1))
            .refusing("from k2 on", test(1, switches.k2))
            .refusing("from k̄ on, two of one branch", test(2, switches.k_bar)),
    ))
}

impl Definition for Fig8 {
    type Params = Params;

    const ID: &'static str = "fig8";
    const TITLE: &'static str = "deformation of the spin problem's conjugate locus on the sphere";
    const PLACE: &'static str = "Figure 8, section 5.2.3";
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
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let counts: Vec<String> = branches(params, tables)?
            .iter()
            .map(|branch| format!("{} for k = {}", branch.p_theta.len(), branch.k))
            .collect();
        let views: Vec<String> =
            params.panels.iter().map(|panel| format!("({}°, {}°)", panel.longitude, panel.latitude)).collect();
        let (width, height) = match params.panels.len() {
            1 => (Width::Single, 96.0),
            2 => (Width::Double, 96.0),
            _ => (Width::Double, 70.0),
        };
        let mut picture = Picture::new(width, height, "Deformation of the conjugate locus of the spin problem").caption(format!(
            "Half of the conjugate locus (p_φ(0) = −2, p_θ(0) ∈ R, H = 1) of the start on the equator of S², where the metric (dr1² + k² dr3²)/r2² is \
             singular; orthographic projection from over (longitude, latitude) {}, N being the pole φ = 0; what lies on the back is thin and light. Dashed: the \
             reference, the first k of each sphere. Each locus ends at its cusp, p_θ = 0, on the meridian of the start, where k is written. First conjugate \
             points where the phase of the closed form is π, relative error of t1 below 1e-11, each checked by integrating h' = ω × h, r' = ω × r; points \
             for p_θ ≥ 0: {}; mirrored for p_θ < 0.",
            views.join(" and "),
            counts.join(", ")
        ));
        for shown in &params.panels {
            picture = picture.panel(sphere(tables, shown)?);
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
        let branches = branches(params, tables)?;
        let mut claims: Vec<Claim> = [below_claim(&branches), order_claim(&branches)].into_iter().flatten().collect();
        claims.push(pole_claim(&branches));
        claims.extend(loops_claim(&branches, tables)?);
        claims.push(contact(&branches));
        claims.push(routes_agree(tables)?);
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
        let claims = [
            "cusp_stays_beyond_equator",
            "pole_then_equator",
            "first_pole",
            "self_intersections",
            "contact_of_order_two",
            "routes_agree",
        ];
        assert_claims(&preview, &claims);
    }
}
