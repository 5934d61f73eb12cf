//! Figure 2 (section 3.3.3): the potentials `V(φ, p_θ) = p_θ²/μ(φ)` of the motion in φ at arc length, `φ'² + V = 1`.
//!
//! V grows with `p_θ` at every φ. Where V < 1 the extremal moves; it turns where V = 1. The grey zone holds the potentials of oscillating extremals,
//! `B^(−1/2) < p_θ < A^(−1/2)`; its lower border, the separatrix, has the largest value 1 at the edges `φ = ±K(k)/α`, its upper border, the equator,
//! the least value 1 at φ = 0. The darker zone holds those that start at `φ0`: up to `p_θ = √μ(φ0) = √(2/z(φ0))`. φ is a length, V a number.
//!
//! The article states no `φ0` for this figure: the config's is a choice.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim, named, unread, value};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use super::scenes::potential::{Member, member, members, potential_panel};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, Phi0Family, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::geodesics::{EQUATOR, OSCILLATING, SEPARATRIX};
use crate::effects::serret_andoyer::potential::{FAMILY, Potential, START};
use crate::plot::picture::{Picture, Width};
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, start, Clairaut constants, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, Phi0Family>,
    /// What is drawn.
    pub picture: Shown,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    /// Points of each curve: odd, 3 to 9999.
    pub points: usize,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate(self.scene.metric.serret_andoyer)?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)?;
        let points = self.picture.points;
        let odd = (3..=9999).contains(&points) && points % 2 == 1;
        Invalid::unless(odd, "picture.points", points, "an odd number from 3 to 9999")
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::Potential];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig2>();

const PICTURE: Kind = picture_kind(
    "fig2-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig2.rs",
        "experiments/findings.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig2-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig2.rs",
        "experiments/findings.rs",
        "table",
    ],
);

struct Fig2;

impl Definition for Fig2 {
    type Params = Params;

    const ID: &'static str = "fig2";
    const TITLE: &'static str = "potentials of the motion in φ";
    const PLACE: &'static str = "Figure 2";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::serret_andoyer(
            &params.scene,
            &OWN,
            Some(&params.scene.start.phi0.into()),
            Some(&params.scene.start.p_theta),
        )
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let Params { scene, picture } = params;
        let potential = Potential {
            body: scene.metric.serret_andoyer.into(),
            phi0: scene.start.phi0,
            p_theta: scene.start.p_theta.values(),
            points: picture.points,
        };
        let own = [("phi0", "scene.start.phi0"), ("p_theta", "scene.start.p_theta"), ("points", "picture.points")]
            .map(|(leaf, key)| (leaf, key.to_owned()));
        let origins = [Inertia::origins("serret-andoyer"), own.to_vec()].concat();
        nodes.add("potential", &[], potential, &[], &origins)?;
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let members = members(tables.get("potential").map_err(unread)?)?;
        let panel = potential_panel(&members, params.scene.start.phi0)?;
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        Ok(Picture::new(Width::Single, 88.0, "Potentials of the motion in φ")
            .caption(format!(
                "Potentials V(φ, p_θ) = p_θ²/μ(φ) of the motion in φ at arc length, φ'² + V = 1 (section 3.3.3), over the strip |φ| ≤ \
                 K(k)/α; A = {a}, B = {b}, C = {c}. An extremal moves where V < 1 and turns where V = 1 (dashed). Grey: potentials of \
                 oscillating extremals, between the separatrix p_θ = B^(−1/2), whose largest value is 1 at the edges, and the equator \
                 p_θ = A^(−1/2), whose least value is 1. Darker: those of them that start at φ0 = {} (a choice: the article states \
                 none), up to p_θ = (2/z(φ0))^(1/2), which turns there (cross). At the curves: p_θ. Below the separatrix \
                 extremals rotate. {} curves of {} points, closed form, relative error 1e-15.",
                params.scene.start.phi0,
                members.len(),
                params.picture.points
            ))
            .panel(panel))
    }

    fn values(_: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let members = members(tables.get("potential").map_err(unread)?)?;
        let mut values = Vec::new();
        let mut add = |name: &str, number: f64, relative: f64, meaning: &str, route: &str| {
            values.push(value(name, (number, relative * f64::EPSILON * number), "1", meaning, route));
        };
        let (separatrix, equator, start) =
            (member(&members, SEPARATRIX)?, member(&members, EQUATOR)?, member(&members, START)?);
        add("p_theta_separatrix", separatrix.p_theta, 1.0, "Clairaut's constant of the separatrix", "B^(−1/2)");
        add("p_theta_equator", equator.p_theta, 1.0, "Clairaut's constant of the equator", "A^(−1/2)");
        add("p_theta_start", start.p_theta, 8.0, "largest Clairaut constant at φ0", "√μ(φ0) = √(2/z(φ0))");
        let separatrix_largest = separatrix.points.iter().map(|p| p.1).fold(0.0, f64::max);
        let equator_least = equator.points.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
        let route = "over the points of the curve, edges and equator among them";
        add("separatrix_largest_potential", separatrix_largest, 4.0, "largest value of V(φ, B^(−1/2))", route);
        add("equator_least_potential", equator_least, 4.0, "least value of V(φ, A^(−1/2))", route);
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let mut members = members(tables.get("potential").map_err(unread)?)?;
        members.sort_by(|a, b| a.p_theta.total_cmp(&b.p_theta));
        let values = Self::values(params, tables)?;
        let value = |name: &str| named(&values, name).map(|found| found.value);
        // What is said of V at the larger of two constants over V at the smaller, given the quotient of the constants.
        let quotients = |holds: fn(f64, f64) -> bool| {
            let mut cases = Cases::default();
            for pair in members.windows(2).filter(|pair| pair[1].p_theta > pair[0].p_theta) {
                for (low, high) in pair[0].points.iter().zip(&pair[1].points) {
                    cases.add(!holds(high.1 / low.1, pair[1].p_theta / pair[0].p_theta), || {
                        format!("φ = {:?}: p_θ = {:?} and {:?}", low.0, pair[0].p_theta, pair[1].p_theta)
                    });
                }
            }
            cases.test()
        };
        let zone = |holds: &dyn Fn(f64) -> bool| {
            let family = members.iter().filter(|m| m.curve == FAMILY || m.curve == START);
            let case = |m: &Member| {
                let as_said = (m.class == OSCILLATING) == holds(m.p_theta);
                (as_said, format!("p_θ = {:?}: {}", m.p_theta, m.class))
            };
            Cases::of(family.map(case)).test()
        };
        let (low, high) = (value("p_theta_separatrix")?, value("p_theta_start")?);
        let (lowest, highest) = (1.0 / params.scene.metric.serret_andoyer.c.sqrt(), value("p_theta_equator")?);
        let claim = |id: &str, statement: &str, test: Test| {
            claim(id, "section 3.3.3, before Figure 2", statement, Evidence::Direct(test), "")
        };
        let one = |curve: &str, extremum: fn(f64, f64) -> f64| -> Result<Test, NodeError> {
            let potentials = member(&members, curve)?.points.iter().map(|point| point.1);
            Ok(Test::Equal {
                printed: 1.0,
                ours: potentials.reduce(extremum).unwrap_or(f64::NAN),
                tolerance: 4.0 * f64::EPSILON,
                reason: "rounding of a product of three".to_owned(),
            })
        };
        Ok(vec![
            claim("increasing", "V(φ, p_θ) increases with p_θ at every φ.", quotients(|v, _| v > 1.0))
                .refusing("decreases", quotients(|v, _| v < 1.0))
                .refusing("increases at least like p_θ³", quotients(|v, p| v >= p * p * p))
                .refusing("increases at most like p_θ", quotients(|v, p| v > 1.0 && v <= p)),
            claim(
                "separatrix",
                "p_θ = B^(−1/2) describes the separatrix: its potential reaches 1 only at the edges.",
                one(SEPARATRIX, f64::max)?,
            )
            .refusing("p_θ = A^(−1/2)", one(EQUATOR, f64::max)?)
            .refusing("p_θ = (2/z(φ0))^(1/2)", one(START, f64::max)?)
            .refusing("reaches 1 only at φ = 0", one(SEPARATRIX, f64::min)?),
            claim(
                "equator",
                "p_θ = A^(−1/2) is the largest constant: its potential is at least 1 everywhere.",
                one(EQUATOR, f64::min)?,
            )
            .refusing("p_θ = B^(−1/2)", one(SEPARATRIX, f64::min)?)
            .refusing("p_θ = (2/z(φ0))^(1/2)", one(START, f64::min)?)
            .refusing("at most 1 everywhere", one(EQUATOR, f64::max)?),
            claim(
                "start_zone",
                "Oscillating trajectories from φ0 have p_θ in (B^(−1/2), (2/z(φ0))^(1/2)].",
                zone(&|p| p > low && p <= high),
            )
            .refusing("without the upper end", zone(&|p| p > low && p < high))
            .refusing("up to A^(−1/2)", zone(&|p| p > low && p <= highest))
            .refusing("from C^(−1/2)", zone(&|p| p > lowest && p <= high)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::preview;

    #[test]
    fn values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            assert!(matches!(&claim.evidence, Evidence::Direct(test) if test.holds()), "{claim:?}");
        }
        let separatrix = preview.value("p_theta_separatrix");
        assert!((separatrix - std::f64::consts::FRAC_1_SQRT_2).abs() <= f64::EPSILON * separatrix);
        let largest = preview.value("p_theta_start");
        assert!((largest - P_THETA_START).abs() <= 8.0 * f64::EPSILON, "{largest:?}");
    }

    /// Oracle: mpmath 1.3.0, 40 digits: 1/√(A + (B − A) sn²(0.75 √1.3 | 5/13)).
    const P_THETA_START: f64 = 0.75214459499759531142;
}
