//! What this experiment shows: the section and the equations of the article, its quantities with units, the hard spots.
//!
//! As it stands: for each start `(0, φ0)` of the Serret-Andoyer metric, the time `t1 = T/2` (arc length) at which its
//! conjugate locus has its cusp (Theorem 3.24).

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{claim, unread, value};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, Phi0Start, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::cusps::Cusps;
use crate::plot::axis::Axis;
use crate::plot::mark::Curve;
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters: what the config holds beside `kind`. One doc line a field, with unit and range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, starts, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, Phi0Start>,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate(self.scene.metric.half_width())?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Template>();

// What the picture and the findings depend on: this file, and the rooms that draw and read.
const PICTURE: Kind = picture_kind(
    "template-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/template.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "template-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/template.rs",
        "table",
    ],
);

/// The experiment's definition.
pub struct Template;

impl Definition for Template {
    type Params = Params;

    const ID: &'static str = "template";
    const TITLE: &'static str = "times of the cusps";
    const PLACE: &'static str = "Theorem 3.24";
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

    // The nodes asked for: a kind and its parameters each. Kinds live in `effects`.
    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let cusps = Cusps { body: params.scene.metric.serret_andoyer.into(), phi0: params.scene.start.phi0.values() };
        let origins = [Inertia::origins("serret-andoyer"), vec![("phi0", "scene.start.phi0".to_owned())]].concat();
        nodes.add("cusps", &[], cusps, &[], &origins)?;
        Ok(())
    }

    // Roles, panels, caption; no numerics and no colours.
    fn picture(_: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let cusps = tables.get("cusps").map_err(unread)?;
        let (phi0, t1) = (cusps.f64s("phi0").map_err(unread)?, cusps.f64s("t1").map_err(unread)?);
        let points = phi0.iter().copied().zip(t1.iter().copied()).collect();
        let panel = Panel::new(Axis::new("*φ*_0").unit("length"), Axis::new("*t*_1").unit("length"))
            .mark(Curve::new(Role::ConjugateTime, points).label("cusp"));
        let caption = format!("Time of the cusp of the conjugate locus against the start; {} starts.", cusps.rows());
        Ok(Picture::new(Width::Single, 70.0, Self::TITLE).caption(caption).panel(panel))
    }

    // Numbers that can be cited by name.
    fn values(_: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let t1 = tables.get("cusps").map_err(unread)?.f64s("t1").map_err(unread)?;
        let least = t1.iter().copied().fold(f64::INFINITY, f64::min);
        let meaning = "least time of a cusp among the starts";
        Ok(vec![value("least_time", (least, 1e-14 * least), "length", meaning, "closed form")])
    }

    // Statements, with the evidence that the tables hold. A verdict is never written: it follows from the evidence.
    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        let least = Self::values(params, tables)?[0].value;
        let bound = std::f64::consts::PI * (a / ((b - a) * (c - a))).sqrt();
        let test = Test::AtMost {
            measured: bound / least - 1.0,
            tolerance: 1e-14,
            reason: "rounding of the closed form".to_owned(),
        };
        let statement = "No first conjugate time is below π√A/√((B−A)(C−A)).";
        Ok(vec![claim("lower_bound", "Theorem 3.9, part 2", statement, Evidence::Direct(test), "")])
    }
}
