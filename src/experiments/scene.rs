//! A scene: any metric, any of its effects, any sweep, from a config alone.
//!
//! Nothing here is about one figure. What is asked for is computed by the node kinds that the article's figures use (so equal work is done once), drawn with the
//! looks that it has there, and described by what the tables hold. It says nothing about the article: its only claim is that independent routes agree.
//!
//! ```toml
//! kind = "scene"
//! [scene]
//! metric.spin = { k = [0.8, 0.5] }
//! start = { p_theta = { from = 1e-4, to = 50, count = 400, spacing = "log" } }
//! effects = ["geodesics", "conjugate-locus", "cut-locus", "wave-front"]
//! accuracy = "article"
//! ```
//!
//! | metric | start | sweep: one node a value | tables that may follow |
//! |---|---|---|---|
//! | `spin = { k }` | `p_theta`: `{ from, to, step }` samples as densely as the curves need, a list or `{ from, to, count, spacing }` is taken as it is | `k` | `wave_front`, `trajectories` |
//! | `serret-andoyer = { A, B, C }` | `phi0`, and `p_theta` for extremals and potentials (may be left out) | `phi0` | `wave_front`, `picture.turns` |
//! | `rotation-group = { A, B, C }` | `cases`, as in Fig. 9 | `cases` | `picture.t_end`, `picture.points` |

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::nodes::Nodes;
use super::scenes::more::{defaults, keyed};
use super::scenes::page::page;
use super::scenes::rotation_group::{self, RotationGroup};
use super::scenes::scenery::Scenery;
use super::scenes::serret_andoyer::{self, SerretAndoyer};
use super::scenes::spin::{self, Keyed, Spin};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::sweep::{Range, Spacing, Sweep};
use crate::contract::value::NamedValue;
use crate::effects::scene::{
    BranchStart, EulerCase, EulerCases, Inertia, Phi0Start, ROTATION_GROUP, RotationGroupMetric, SERRET_ANDOYER, SPIN,
    Scene as SceneOf, SerretAndoyerMetric, SpinMetric, SpinParameters,
};
use crate::effects::spin::momenta::Momenta;
use crate::effects::spin::starts::Starts;
use crate::plot::picture::Picture;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Metric, starts, effects, accuracy.
    pub scene: SceneOf<AnyMetric, AnyStart>,
    /// Times of wave fronts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wave_front: Option<Fronts>,
    /// The extremals of a spin scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trajectories: Option<Trajectories>,
    /// How far curves reach.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<Shown>,
}

/// One of the metrics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("minProperties" = 1, "maxProperties" = 1))]
pub struct AnyMetric {
    /// `{ A, B, C }`, inverse moments of inertia, `A < B < C`.
    #[serde(rename = "serret-andoyer", default, skip_serializing_if = "Option::is_none")]
    pub serret_andoyer: Option<Inertia>,
    /// `{ k }`, the ratio of the couplings, 0.1 to 3; one node a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin: Option<SpinParameters>,
    /// `{ A, B, C }`, inverse moments of inertia, `A < B < C`.
    #[serde(rename = "rotation-group", default, skip_serializing_if = "Option::is_none")]
    pub rotation_group: Option<Inertia>,
}

/// Where extremals start; which of these, the metric says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnyStart {
    /// Momenta `p_θ ≥ 0`: rows inside a node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub p_theta: Option<StartMomenta>,
    /// Distances from the equator (length), `|phi0| < K(k)/alpha`; one node a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phi0: Option<Sweep>,
    /// Single extremals on SO(3).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cases: Option<Vec<EulerCase>>,
}

/// Momenta: as many as a curve needs, or those that are listed.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
pub enum StartMomenta {
    /// `{ from, to, step }`.
    Branch(Momenta),
    /// A number, a list, or `{ from, to, count, spacing }`.
    Swept(Sweep),
}

/// Wave fronts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fronts {
    /// Times, above 0, at most 30; one node a value and start.
    pub t: Sweep,
}

/// Extremals of a spin scene, up to their first conjugate points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trajectories {
    /// How many, 1 to 100.
    pub count: u32,
    /// Largest distance of neighbouring points, radians, 0.001 to 0.5.
    pub step: f64,
}

/// How far curves reach.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    /// Serret-Andoyer: turns of θ (2π each) to both sides, above 0, at most 100.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turns: Option<f64>,
    /// Rotation group: where curves end (time), above 0, at most 100.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t_end: Option<f64>,
    /// Rotation group: points of each curve, 2 to 9999.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<usize>,
}

impl Serialize for StartMomenta {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Branch(momenta) => momenta.serialize(serializer),
            Self::Swept(sweep) => sweep.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for StartMomenta {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            from: f64,
            to: f64,
            step: Option<f64>,
            count: Option<usize>,
            spacing: Option<Spacing>,
        }
        struct Visitor;
        impl<'de> de::Visitor<'de> for Visitor {
            type Value = StartMomenta;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "{ from = …, to = …, step = … }, { from = …, to = …, count = …, spacing = \"lin\" or \"log\" }, or a list of numbers",
                )
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<StartMomenta, E> {
                Ok(StartMomenta::Swept(Sweep::One(value)))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<StartMomenta, E> {
                self.visit_f64(value as f64)
            }
            fn visit_u64<E: de::Error>(self, value: u64) -> Result<StartMomenta, E> {
                self.visit_f64(value as f64)
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, mut items: A) -> Result<StartMomenta, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = items.next_element::<f64>()? {
                    values.push(value);
                }
                Ok(StartMomenta::Swept(Sweep::List(values)))
            }
            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<StartMomenta, A::Error> {
                let Table { from, to, step, count, spacing } = Table::deserialize(MapAccessDeserializer::new(map))?;
                match (step, count) {
                    (Some(step), None) if spacing.is_none() => Ok(StartMomenta::Branch(Momenta { from, to, step })),
                    (None, Some(count)) => {
                        let spacing = spacing.unwrap_or_default();
                        Ok(StartMomenta::Swept(Sweep::Range(Range { from, to, count, spacing })))
                    }
                    _ => Err(de::Error::invalid_value(de::Unexpected::Map, &self)),
                }
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// Most values of one sweep.
const MOST_VALUES: usize = 10_000;
/// Smallest and largest k. Below 0.1 momenta below `e^(−π/k)` matter, and the second routes take minutes in double-double.
const K: (f64, f64) = (0.1, 3.0);

impl AnyMetric {
    /// The name of the only one given.
    fn name(&self) -> Result<&'static str, Invalid> {
        let given = [
            (self.serret_andoyer.is_some(), SERRET_ANDOYER),
            (self.spin.is_some(), SPIN),
            (self.rotation_group.is_some(), ROTATION_GROUP),
        ];
        let mut given = given.into_iter().filter(|(is_given, _)| *is_given).map(|(_, name)| name);
        let accepted = format!("one of {SERRET_ANDOYER}, {SPIN}, {ROTATION_GROUP}");
        match (given.next(), given.next()) {
            (Some(name), None) => Ok(name),
            (Some(_), Some(second)) => Err(Invalid::new(format!("scene.metric.{second}"), "a second metric", accepted)),
            _ => Err(Invalid::new("scene.metric", "no metric", accepted)),
        }
    }
}

impl Params {
    /// Refuses a key that the metric has no use for, and asks for one that it needs.
    fn validate_keys(&self, metric: &str) -> Result<(), Invalid> {
        let AnyStart { p_theta, phi0, cases } = &self.scene.start;
        let picture = self.picture.as_ref();
        let keys = [
            ("scene.start.p_theta", p_theta.is_some(), metric == SPIN, metric != ROTATION_GROUP),
            ("scene.start.phi0", phi0.is_some(), metric == SERRET_ANDOYER, metric == SERRET_ANDOYER),
            ("scene.start.cases", cases.is_some(), metric == ROTATION_GROUP, metric == ROTATION_GROUP),
            ("wave_front", self.wave_front.is_some(), false, metric != ROTATION_GROUP),
            ("trajectories", self.trajectories.is_some(), false, metric == SPIN),
            ("picture.turns", picture.is_some_and(|p| p.turns.is_some()), false, metric == SERRET_ANDOYER),
            ("picture.t_end", picture.is_some_and(|p| p.t_end.is_some()), false, metric == ROTATION_GROUP),
            ("picture.points", picture.is_some_and(|p| p.points.is_some()), false, metric == ROTATION_GROUP),
        ];
        for (key, is_given, is_needed, is_known) in keys {
            let name = key.rsplit('.').next().unwrap_or(key);
            let accepted = format!("no `{name}` with the metric {metric}");
            Invalid::unless(is_known || !is_given, key, "a key of another metric", accepted)?;
            let table = key.rsplit_once('.').map_or("", |(table, _)| table);
            let accepted = format!("`{name}`, which the metric {metric} needs");
            Invalid::unless(is_given || !is_needed, table, format!("no `{name}`"), accepted)?;
        }
        Ok(())
    }

    fn validate_spin(&self, spin: &SpinParameters) -> Result<(), Invalid> {
        let key = "scene.metric.spin.k";
        let accepted = format!("{} <= k <= {}", K.0, K.1);
        spin.k.validate_each(key, &accepted, |k| (K.0..=K.1).contains(&k))?;
        SpinMetric { spin: spin.clone() }.validate()?;
        at_most(&spin.k, key, MOST_VALUES)?;
        match &self.scene.start.p_theta {
            Some(StartMomenta::Branch(p_theta)) => BranchStart { p_theta: *p_theta }.validate()?,
            Some(StartMomenta::Swept(sweep)) => {
                let key = "scene.start.p_theta";
                sweep.validate_each(key, "p_theta >= 0 (the rest are mirror images)", |p| (0.0..=1e12).contains(&p))?;
                let values = sweep.values();
                let ascending = values.len() >= 2 && values.windows(2).all(|pair| pair[0] < pair[1]);
                Invalid::unless(ascending, key, format!("{} values", values.len()), "at least two values, ascending")?;
                at_most(sweep, key, 100_000)?;
            }
            None => {}
        }
        if let Some(Trajectories { count, step }) = self.trajectories {
            Invalid::unless((1..=100).contains(&count), "trajectories.count", count, "1 to 100")?;
            let accepted = "a number from 0.001 to 0.5 (radians)";
            Invalid::number((1e-3..=0.5).contains(&step), "trajectories.step", step, accepted)?;
        }
        Ok(())
    }

    fn validate_serret_andoyer(&self, inertia: Inertia) -> Result<(), Invalid> {
        let metric = SerretAndoyerMetric { serret_andoyer: inertia };
        metric.validate()?;
        if let Some(phi0) = &self.scene.start.phi0 {
            Phi0Start { phi0: phi0.clone() }.validate(metric.half_width())?;
            at_most(phi0, "scene.start.phi0", MOST_VALUES)?;
        }
        match &self.scene.start.p_theta {
            Some(StartMomenta::Branch(momenta)) => {
                let key = "scene.start.p_theta.step";
                Invalid::number(false, key, momenta.step, "a list, or a range with count: no step with this metric")?;
            }
            Some(StartMomenta::Swept(sweep)) => {
                let largest = metric.equator_p_theta();
                let accepted = format!("0 <= p_theta <= A^(-1/2) = {largest:.6}");
                let key = "scene.start.p_theta";
                sweep.validate_each(key, &accepted, |p| (0.0..=largest).contains(&p))?;
                at_most(sweep, key, MOST_VALUES)?;
            }
            None => {}
        }
        if let Some(turns) = self.picture.and_then(|picture| picture.turns) {
            let accepted = "above 0, at most 100";
            Invalid::number(turns > 0.0 && turns <= 100.0, "picture.turns", turns, accepted)?;
        }
        Ok(())
    }

    fn validate_rotation_group(&self, inertia: Inertia) -> Result<(), Invalid> {
        RotationGroupMetric { rotation_group: inertia }.validate()?;
        if let Some(cases) = &self.scene.start.cases {
            EulerCases { cases: cases.clone() }.validate()?;
            let most = rotation_group::MOST_CASES;
            let found = format!("{} starts", cases.len());
            Invalid::unless(cases.len() <= most, "scene.start.cases", found, format!("one to {most} starts"))?;
        }
        if let Some(Shown { t_end, points, .. }) = self.picture {
            let end = t_end.unwrap_or(1.0);
            Invalid::number(end > 0.0 && end <= 100.0, "picture.t_end", end, "above 0, at most 100")?;
            let points = points.unwrap_or(2);
            Invalid::unless((2..=9999).contains(&points), "picture.points", points, "2 to 9999")?;
        }
        Ok(())
    }

    fn times(&self, default: &[f64]) -> Vec<Keyed> {
        self.wave_front.as_ref().map_or_else(|| defaults(default), |fronts| keyed(&fronts.t, "wave_front.t"))
    }

    /// The scene, once validated; none for a config that is refused.
    fn scenery(&self) -> Option<Scenery> {
        let SceneOf { metric, start, effects, accuracy } = &self.scene;
        let (effects, accuracy) = (effects.clone(), *accuracy);
        if let Some(spin) = &metric.spin {
            let starts = match start.p_theta.as_ref()? {
                StartMomenta::Branch(momenta) => Starts::Branch(*momenta),
                StartMomenta::Swept(sweep) => Starts::Listed(sweep.values()),
            };
            let Trajectories { count, step } = self
                .trajectories
                .unwrap_or(Trajectories { count: spin::DEFAULT_TRAJECTORIES.0, step: spin::DEFAULT_TRAJECTORIES.1 });
            let k = keyed(&spin.k, "scene.metric.spin.k");
            let times = self.times(&spin::DEFAULT_TIMES);
            return Some(Scenery::Spin(Spin { effects, k, starts, trajectories: (count, step), times, accuracy }));
        }
        if let Some(inertia) = metric.serret_andoyer {
            let p_theta = match &start.p_theta {
                Some(StartMomenta::Swept(sweep)) => sweep.values(),
                _ => Vec::new(),
            };
            return Some(Scenery::SerretAndoyer(SerretAndoyer {
                effects,
                metric: SerretAndoyerMetric { serret_andoyer: inertia },
                phi0: keyed(start.phi0.as_ref()?, "scene.start.phi0"),
                p_theta,
                times: self.times(&serret_andoyer::DEFAULT_TIMES),
                turns: self.picture.and_then(|p| p.turns).unwrap_or(serret_andoyer::DEFAULT_TURNS),
                accuracy,
            }));
        }
        let (t_end, points) = rotation_group::DEFAULT_CURVES;
        let curves = (
            self.picture.and_then(|p| p.t_end).unwrap_or(t_end),
            self.picture.and_then(|p| p.points).unwrap_or(points),
        );
        let (inertia, cases) = (metric.rotation_group?, start.cases.clone()?);
        Some(Scenery::RotationGroup(RotationGroup { effects, inertia, cases, curves, accuracy }))
    }
}

fn at_most(sweep: &Sweep, key: &str, most: usize) -> Result<(), Invalid> {
    let found = format!("{} values", sweep.count());
    Invalid::unless(sweep.count() <= most, key, found, format!("at most {most} values"))
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        let metric = self.scene.metric.name()?;
        self.validate_keys(metric)?;
        let AnyMetric { serret_andoyer, spin, rotation_group } = &self.scene.metric;
        spin.as_ref().map_or(Ok(()), |spin| self.validate_spin(spin))?;
        serret_andoyer.map_or(Ok(()), |inertia| self.validate_serret_andoyer(inertia))?;
        rotation_group.map_or(Ok(()), |inertia| self.validate_rotation_group(inertia))?;
        if let Some(Fronts { t }) = &self.wave_front {
            t.validate_each("wave_front.t", "0 < t <= 30", |t| t > 0.0 && t <= 30.0)?;
            at_most(t, "wave_front.t", 30)?;
        }
        self.scene.validate_effects(&[], metric)
    }
}

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Scene>();

const PICTURE: Kind = picture_kind(
    "scene-picture",
    &[
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scene.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "scene-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scene.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "table",
    ],
);

struct Scene;

fn scenery(params: &Params) -> Result<Scenery, NodeError> {
    params.scenery().ok_or_else(|| NodeError::new("a scene without a metric or a start"))
}

impl Definition for Scene {
    type Params = Params;

    const ID: &'static str = "scene";
    const TITLE: &'static str = "a scene";
    const PLACE: &'static str = "not of the article";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        scenery(params)?.nodes(nodes)
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let scene = scenery(params)?;
        let title = match &scene {
            Scenery::Spin(_) => "A scene of the spin problem",
            Scenery::SerretAndoyer(_) => "A scene of the Serret-Andoyer metric",
            Scenery::RotationGroup(_) => "A scene of the rotation group",
        };
        Ok(page(title, scene.caption(tables)?, scene.blocks(tables)?))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        scenery(params)?.values(tables)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        scenery(params)?.claims(tables, "routes_agree")
    }
}
