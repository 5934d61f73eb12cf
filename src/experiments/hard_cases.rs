//! Hard cases: digits that a naive formulation, and ours, keep on the way to each limit of the three problems.
//!
//! Not in the article. A family is a sequence of starts whose distance to a limit falls: the separatrix, a cusp, a pole, two moments of inertia that
//! become equal. Each case has a truth in double-double, the answer of a straightforward program, ours with the error that it claims, and the condition
//! number of the posed problem, which says how many digits the inputs leave at all (`effects/hard_cases`).
//!
//! The hard spot: an answer that is wrong where no answer in `f64` could be right is no fault of it; one that claims more than it holds is.

use super::definition::{Definition, Experiment, NOT_IN_ARTICLE, findings_kind, picture_kind};
use super::findings::{Cases, unread, value};
use super::nodes::Nodes;
use super::three_problems::{ROTATION_GROUP, SERRET_ANDOYER, SPIN};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Compute, Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::hard_cases::family::Refused;
use crate::effects::hard_cases::rotation_group::{self, HardCasesRotationGroup};
use crate::effects::hard_cases::serret_andoyer::{self, HardCasesSerretAndoyer};
use crate::effects::hard_cases::spin::{self, HardCasesSpin};
use crate::effects::scene::Inertia;
use crate::plot::axis::Axis;
use crate::plot::mark::Curve;
use crate::plot::picture::{Layout, Letter, Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Cases a decade of the distance, 1 to 50.
    pub per_decade: u32,
    /// The Serret-Andoyer metric.
    #[serde(rename = "serret-andoyer")]
    pub serret_andoyer: OfBody<serret_andoyer::Family>,
    /// The spin problem.
    pub spin: OfSpin,
    /// SO(3).
    #[serde(rename = "rotation-group")]
    pub rotation_group: OfBody<rotation_group::Family>,
}

/// Families of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OfBody<F> {
    /// Inverse moments of inertia.
    pub body: Inertia,
    /// The families.
    pub families: Vec<Swept<F>>,
}

/// Families of the spin problem.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OfSpin {
    /// The families.
    pub families: Vec<Swept<spin::Family>>,
}

/// A family, and how far it goes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Swept<F> {
    /// The family, with its parameters where it has any.
    pub family: F,
    /// The first distance to the limit, at most 1.
    pub from: f64,
    /// The last one, which is smaller.
    pub to: f64,
}

/// Refuses a sweep that its family does not accept.
fn validate_all<F>(
    families: &[Swept<F>],
    metric: &str,
    validate: impl Fn(&Swept<F>) -> Result<(), Refused>,
) -> Result<(), Invalid> {
    families.iter().enumerate().try_for_each(|(i, swept)| {
        let key = format!("{metric}.families[{i}]");
        validate(swept).map_err(|Refused { key: at, found, accepted }| Invalid::new(at, found, accepted).within(&key))
    })
}

/// Refuses a family, with its parameters, that stands twice.
fn once<F: Serialize + Copy>(
    families: &[Swept<F>],
    metric: &str,
    name: impl Fn(F) -> &'static str,
) -> Result<(), Invalid> {
    let words = |swept: &Swept<F>| format!("{} {:?}", name(swept.family), axes(&swept.family));
    for (i, swept) in families.iter().enumerate() {
        let key = format!("{metric}.families[{i}].family");
        let is_new = families[..i].iter().all(|earlier| words(earlier) != words(swept));
        Invalid::unless(is_new, key, format!("{} again", name(swept.family)), "each family once, with its parameters")?;
    }
    Ok(())
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        Invalid::unless((1..=50).contains(&self.per_decade), "per_decade", self.per_decade, "1 to 50")?;
        self.serret_andoyer.body.validate("serret-andoyer.body")?;
        self.rotation_group.body.validate("rotation-group.body")?;
        let body = self.serret_andoyer.body.into();
        validate_all(&self.serret_andoyer.families, "serret-andoyer", |s| s.family.validate(body, s.from, s.to))?;
        validate_all(&self.spin.families, "spin", |s| s.family.validate(s.from, s.to))?;
        validate_all(&self.rotation_group.families, "rotation-group", |s| s.family.validate(s.from, s.to))?;
        once(&self.serret_andoyer.families, "serret-andoyer", serret_andoyer::Family::name)?;
        once(&self.spin.families, "spin", |family| family.name())?;
        once(&self.rotation_group.families, "rotation-group", rotation_group::Family::name)
    }
}

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<HardCases>();

const PICTURE: Kind = picture_kind(
    "hard_cases-picture",
    &[
        "experiments/hard_cases.rs",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/three_problems.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "hard_cases-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/hard_cases.rs",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/three_problems.rs",
        "table",
    ],
);

/// One family as the picture and the findings know it: its panel, and the name of its table.
struct Named {
    metric: &'static str,
    family: &'static str,
    table: String,
}

/// The problems in the order of the figure, as tables and in words, and short enough for a panel's title.
const METRICS: [(&str, &str, &str); 3] =
    [(SERRET_ANDOYER, "Serret-Andoyer", "SA"), (SPIN, "spin problem", "spin"), (ROTATION_GROUP, "SO(3)", "SO(3)")];

/// The parameters of a family as axes of its node's address: `k=0.1`.
fn axes<F: Serialize>(family: &F) -> Vec<(String, String)> {
    let value = serde_json::to_value(family).unwrap_or_default();
    let parameters = value.as_object().and_then(|outer| outer.values().next()).and_then(|inner| inner.as_object());
    let text = |value: &serde_json::Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    parameters.map_or_else(Vec::new, |all| all.iter().map(|(key, value)| (key.clone(), text(value))).collect())
}

impl Params {
    /// All families in the order of the config.
    fn named(&self) -> Vec<Named> {
        let name = |metric, family, axes: Vec<(String, String)>| {
            let table =
                axes.iter().fold(format!("{metric}-{family}"), |name, (axis, value)| format!("{name}/{axis}={value}"));
            Named { metric, family, table }
        };
        let reduced =
            self.serret_andoyer.families.iter().map(|s| name(SERRET_ANDOYER, s.family.name(), axes(&s.family)));
        let spins = self.spin.families.iter().map(|s| name(SPIN, s.family.name(), axes(&s.family)));
        let groups =
            self.rotation_group.families.iter().map(|s| name(ROTATION_GROUP, s.family.name(), axes(&s.family)));
        reduced.chain(spins).chain(groups).collect()
    }
}

/// Adds the node of a family.
fn add<C: Compute + Serialize + 'static>(
    nodes: &mut Nodes,
    (metric, family, axes): (&str, &str, Vec<(String, String)>),
    place: usize,
    compute: C,
) -> Result<(), NodeError> {
    let axes: Vec<(&str, String)> = axes.iter().map(|(axis, value)| (axis.as_str(), value.clone())).collect();
    let key = |name: &str| format!("{metric}.families[{place}].{name}");
    let body = |name: &str| format!("{metric}.body.{name}");
    let origins = [
        ("family", key("family")),
        ("from", key("from")),
        ("to", key("to")),
        ("body.A", body("A")),
        ("body.B", body("B")),
        ("body.C", body("C")),
    ];
    nodes.add(&format!("{metric}-{family}"), &axes, compute, &[], &origins).map(|_| ())
}

struct HardCases;

impl Definition for HardCases {
    type Params = Params;

    const ID: &'static str = "hard_cases";
    const TITLE: &'static str = "hard cases: digits kept on the way to each limit";
    const PLACE: &'static str = NOT_IN_ARTICLE;
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(_: &mut Params, _: Accuracy) {
        // What f64 loses is the subject; the truth is double-double at every level.
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        let per_decade = params.per_decade;
        for (i, Swept { family, from, to }) in params.serret_andoyer.families.iter().copied().enumerate() {
            let body = params.serret_andoyer.body.into();
            let cases = HardCasesSerretAndoyer { family, body, from, to, per_decade };
            add(nodes, (SERRET_ANDOYER, family.name(), axes(&family)), i, cases)?;
        }
        for (i, Swept { family, from, to }) in params.spin.families.iter().copied().enumerate() {
            let cases = HardCasesSpin { family, from, to, per_decade };
            add(nodes, (SPIN, family.name(), axes(&family)), i, cases)?;
        }
        for (i, Swept { family, from, to }) in params.rotation_group.families.iter().copied().enumerate() {
            let body = params.rotation_group.body.into();
            let cases = HardCasesRotationGroup { family, body, from, to, per_decade };
            add(nodes, (ROTATION_GROUP, family.name(), axes(&family)), i, cases)?;
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let mut panels: Vec<(&'static str, &'static str, Vec<&Table>)> = Vec::new();
        let mut cases = 0;
        for Named { metric, family, table } in params.named() {
            let table = tables.get(&table).map_err(unread)?;
            cases += table.rows();
            match panels.iter_mut().find(|(known, name, _)| (*known, *name) == (metric, family)) {
                Some((.., all)) => all.push(table),
                None => panels.push((metric, family, vec![table])),
            }
        }
        let rows = panels.len().div_ceil(COLUMNS).max(1);
        let height = 14.0 + 30.0 * rows as f64;
        let mut picture = Picture::new(Width::Double, height, "Hard cases").layout(Layout::Columns(COLUMNS)).caption(format!(
            "Digits of the first conjugate time (long time: of a place; third kind and one curve at the pole: of an angle) against the distance to a limit, \
             which falls to the right; {cases} cases in {} families of the Serret-Andoyer metric (SA), the spin problem and SO(3), {} a decade. Digits are minus the \
             decimal logarithm of the relative error against double-double arithmetic, {DIGITS} at most. Dashed: what a straightforward program keeps (the printed \
             formulas, or an integration in the chart, in f64). Full: our answer. Grey: what rounding of the inputs leaves at all, from the condition number of the \
             posed problem. Several curves in a panel are other parameters or the other side of the limit.",
            panels.len(),
            params.per_decade,
        ));
        for (place, (metric, family, tables)) in panels.iter().enumerate() {
            let is_last = place + COLUMNS >= panels.len();
            picture = picture.panel(panel(metric, family, tables, place % COLUMNS == 0, is_last)?);
        }
        Ok(picture)
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = Vec::new();
        let mut add = |name: String, count: usize, meaning: String| {
            values.push(value(name, (count as f64, 0.0), "1", meaning, "counted"));
        };
        for (metric, words, _) in METRICS {
            let (mut cases, mut stable, mut lost) = (0, 0, 0);
            for named in params.named().iter().filter(|named| named.metric == metric) {
                let table = tables.get(&named.table).map_err(unread)?;
                cases += table.rows();
                stable += table.texts("verdict").map_err(unread)?.iter().filter(|verdict| *verdict == "stable").count();
                // Half of the digits that an f64 has.
                lost += table.f64s("naive_error").map_err(unread)?.iter().filter(|error| **error > 1e-8).count();
            }
            let prefix = metric.replace('-', "_");
            add(format!("{prefix}_cases"), cases, format!("{words}: hard cases computed"));
            add(format!("{prefix}_stable"), stable, format!("{words}: of them, those that ours answers stably"));
            add(
                format!("{prefix}_naive_lost"),
                lost,
                format!("{words}: of them, those where the naive formulation keeps fewer than eight digits"),
            );
        }
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let (mut honest, mut stable) = (Cases::default(), Cases::default());
        for Named { table: name, .. } in params.named() {
            let table = tables.get(&name).map_err(unread)?;
            let distance = table.f64s("distance").map_err(unread)?;
            for (row, verdict) in table.texts("verdict").map_err(unread)?.iter().enumerate() {
                let words = || format!("{name}, distance {:e}: {verdict}", distance[row]);
                honest.add(verdict == "wrong", words);
                stable.add(verdict != "stable", words);
            }
        }
        let place = "not in the article: how this program computes";
        Ok(vec![
            honest.claim(
                "error_is_a_bound",
                place,
                "The error printed with an answer is never smaller than the true one.",
                "",
            ),
            stable.claim(
                "answers_are_stable",
                place,
                "Every answer is as near to the truth as twenty roundings of its inputs would leave it.",
                "",
            ),
        ])
    }
}

/// Panels side by side.
const COLUMNS: usize = 5;
/// The most digits that are shown.
const DIGITS: f64 = 17.0;

/// Digits of a relative error.
fn digits(error: f64) -> f64 {
    if error > 0.0 { (-libm::log10(error)).clamp(0.0, DIGITS) } else { DIGITS }
}

fn panel(metric: &str, family: &str, tables: &[&Table], is_first: bool, is_last: bool) -> Result<Panel, NodeError> {
    let short = METRICS.iter().find(|(name, ..)| *name == metric).map_or(metric, |(_, _, short)| *short);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for table in tables {
        for distance in table.f64s("distance").map_err(unread)? {
            (least, most) = (least.min(*distance), most.max(*distance));
        }
    }
    // Few enough that their texts stand apart in a fifth of the page.
    let width = libm::log10(most / least);
    let step = if width > 40.0 {
        20
    } else if width > 20.0 {
        8
    } else if width > 6.0 {
        4
    } else {
        2
    };
    let decades = (0..=300).step_by(step).map(|n| {
        let words = if n == 0 { "1".to_owned() } else { format!("10^{{−{n}}}") };
        (libm::pow(10.0, -f64::from(n)), words)
    });
    let shown = decades.filter(|(at, _)| *at >= 0.5 * least && *at <= 2.0 * most);
    let mut x = Axis::new(if is_last { "distance" } else { "" }).log().reversed().ticks_at(shown);
    if least < most {
        x = x.fixed(least, most);
    }
    let y = Axis::new(if is_first { "digits" } else { "" })
        .fixed(-0.5, DIGITS + 0.5)
        .ticks_at([0.0, 4.0, 8.0, 12.0, 16.0].map(|at| (at, format!("{at}"))));
    // Short enough for a fifth of the page.
    let family = family.replace('-', " ").replace(" with separatrix", ", separatrix").replace(" momenta", ", momenta");
    let mut panel = Panel { letter: Letter::None, ..Panel::new(x, y).title(format!("{short}: {family}")) };
    for table in tables {
        let distance = table.f64s("distance").map_err(unread)?;
        let line = |errors: &[f64]| {
            distance.iter().copied().zip(errors.iter().map(|error| digits(*error))).collect::<Vec<_>>()
        };
        let condition = table.f64s("condition").map_err(unread)?;
        let allowed: Vec<f64> = condition.iter().map(|condition| f64::EPSILON * (condition + 1.0)).collect();
        panel = panel
            .mark(Curve::new(Role::Equator, line(&allowed)).legend("what the inputs leave"))
            .mark(
                Curve::new(Role::SeriesB, line(table.f64s("naive_error").map_err(unread)?)).legend("naive formulation"),
            )
            .mark(Curve::new(Role::SeriesA, line(table.f64s("our_error").map_err(unread)?)).legend("ours"));
    }
    Ok(panel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::experiments::preview;

    /// The claims hold on every case of the config, and the naive formulations do lose digits.
    #[test]
    fn ours_holds_where_the_naive_does_not() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            assert!(matches!(&claim.evidence, Evidence::Direct(test) if test.holds()), "{claim:?}");
        }
        for metric in ["serret_andoyer", "spin", "rotation_group"] {
            assert!(preview.value(&format!("{metric}_naive_lost")) >= 20.0, "{metric}");
        }
    }

    #[test]
    fn parameters_become_axes() {
        let family = spin::Family::SmallMomentum { k: 0.05 };
        assert_eq!(axes(&family), [("k".to_owned(), "0.05".to_owned())]);
        assert_eq!(axes(&serret_andoyer::Family::Cusp), []);
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("per_decade = 3", "per_decade = 0", "per_decade"),
            ("from = 0.1", "from = 2.0", "serret-andoyer.families[0].from"),
            ("to = 1e-15", "to = 0.5", "serret-andoyer.families[0].to"),
            ("\"cusp\"", "\"cups\"", "families"),
            ("from = 0.05, to = 1e-16", "from = 0.5, to = 1e-16", "serret-andoyer.families[2].from"),
            (
                "family = \"long-time\", from = 1.0, to = 1e-4",
                "family = \"long-time\", from = 1.0, to = 1e-5",
                "rotation-group.families[9].to",
            ),
            ("{ k = 0.05 }", "{ k = -0.05 }", "spin.families[0].family.small-momentum.k"),
            ("passage = 2", "passage = 9", "spin.families[8].family.pole.passage"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/hard_cases.toml"), &cases);
    }
}
