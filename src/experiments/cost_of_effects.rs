//! What each effect costs, in counted work: the spin problem, the Serret-Andoyer flow and SO(3), integrated by power series.
//!
//! Not in the article: it shows that this program computes what a scene asks for and nothing else. Each start is integrated over one
//! span (up to its first conjugate time; on SO(3) the second) with the base flow alone, then with one effect more each: Jacobi columns,
//! the event that finds conjugate times, dense output, the attitude, a watched invariant. Counts are per start and have no unit; they
//! do not depend on the machine. Time, which does, is measured on demand only and stands under `measured/`.
//!
//! The hard spot: work per coefficient differs. So the multiplications in the series are counted too, by running the equations on
//! numbers that count; what observers do (an event's own series, roots) is counted apart.

mod judges;

use self::judges::JUDGES;
use super::definition::{Definition, Experiment, Measured, NOT_IN_ARTICLE, findings_kind, picture_kind};
use super::findings::{Cases, unread, value};
use super::nodes::Nodes;
use super::three_problems::{
    self, Measurement, PROBLEMS, ROTATION_GROUP, ROTATION_GROUP_LEAVES, RotationGroupStarts, SERRET_ANDOYER,
    SERRET_ANDOYER_LEAVES, SPIN, SPIN_LEAVES, SerretAndoyerStarts, SpinStarts,
};
use crate::contract::accuracy::{Accuracy, Arithmetic};
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::cost_of_effects::counted::CostOfEffects;
use crate::effects::cost_of_effects::machine;
use crate::effects::cost_of_effects::rotation_group::RotationGroup;
use crate::effects::cost_of_effects::serret_andoyer::SerretAndoyer;
use crate::effects::cost_of_effects::spin::Spin;
use crate::effects::cost_of_effects::timed::TimeOfEffects;
use crate::plot::axis::Axis;
use crate::plot::label::Label;
use crate::plot::mark::{Curve, Points, RuleLine, Side, Text};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::{Marker, Role};
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Relative errors asked for, falling; at least one.
    pub accuracies: Vec<Accuracy>,
    /// Times at which states are asked for, 1 to 10000.
    pub samples: usize,
    /// The spin problem.
    pub spin: SpinStarts,
    /// The Serret-Andoyer flow.
    #[serde(rename = "serret-andoyer")]
    pub serret_andoyer: SerretAndoyerStarts,
    /// The left-invariant metric.
    #[serde(rename = "rotation-group")]
    pub rotation_group: RotationGroupStarts,
    /// How times are measured.
    pub measurement: Measurement,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        three_problems::validate_accuracies(&self.accuracies)?;
        let most = "1 to 10000";
        Invalid::unless((1..=10_000).contains(&self.samples), "samples", self.samples, most)?;
        self.spin.validate()?;
        self.serret_andoyer.validate()?;
        self.rotation_group.validate()?;
        self.measurement.validate()
    }
}

impl Params {
    fn asked(&self) -> Vec<f64> {
        self.accuracies.iter().map(|accuracy| accuracy.relative_error()).collect()
    }

    fn spin(&self) -> Spin {
        Spin { k: self.spin.k, p_theta: self.spin.p_theta.values() }
    }

    fn serret_andoyer(&self) -> SerretAndoyer {
        let SerretAndoyerStarts { body, y0, xi1 } = &self.serret_andoyer;
        SerretAndoyer { body: (*body).into(), y0: *y0, xi1: xi1.values() }
    }

    fn rotation_group(&self) -> RotationGroup {
        RotationGroup { body: self.rotation_group.body.into(), directions: self.rotation_group.directions }
    }
}

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Cost>();

const PICTURE: Kind = picture_kind(
    "cost_of_effects-picture",
    &[
        "experiments/cost_of_effects",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/three_problems.rs",
        "plot",
        "table",
    ],
);
const MEASURED_PICTURE: Kind = picture_kind(
    "cost_of_effects-measured-picture",
    &[
        "experiments/cost_of_effects",
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
    "cost_of_effects-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/cost_of_effects",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/three_problems.rs",
        "table",
    ],
);

struct Cost;

impl Definition for Cost {
    type Params = Params;

    const ID: &'static str = "cost_of_effects";
    const TITLE: &'static str = "what each effect costs";
    const PLACE: &'static str = NOT_IN_ARTICLE;
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;
    const MEASURED: Option<Measured<Params>> =
        Some(Measured { picture_kind: &MEASURED_PICTURE, nodes: measurements, picture: measured_picture });

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        // Its integrations count work in f64, which can give no more than `article`.
        params.accuracies = vec![if accuracy.arithmetic() == Arithmetic::F64 { accuracy } else { Accuracy::Article }];
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        let (asked, samples) = (params.asked(), params.samples);
        let spin = CostOfEffects { problem: params.spin(), asked: asked.clone(), samples };
        nodes.add(SPIN, &[], spin, &[], &three_problems::origins(SPIN, SPIN_LEAVES))?;
        let reduced = CostOfEffects { problem: params.serret_andoyer(), asked: asked.clone(), samples };
        nodes.add(
            SERRET_ANDOYER,
            &[],
            reduced,
            &[],
            &three_problems::origins(SERRET_ANDOYER, SERRET_ANDOYER_LEAVES),
        )?;
        let group = CostOfEffects { problem: params.rotation_group(), asked, samples };
        nodes.add(ROTATION_GROUP, &[], group, &[], &three_problems::origins(ROTATION_GROUP, ROTATION_GROUP_LEAVES))?;
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let mut picture = Picture::new(Width::Double, 84.0, "What each effect costs").caption(format!(
            "Counted work per start of power-series integrations with one effect each added to the base flow. (a) Spin problem, k = {}, \
             {} starts on the equator, up to the first conjugate time (the lift to the sphere). (b) Serret-Andoyer flow (9), {} oscillating extremals, up to the first \
             conjugate time. (c) Left-invariant metric on SO(3), equation (2), {} momenta, up to the second. Lines: relative error asked for \
             {}; the mark is the last one. A coefficient is one order of the series of the whole flow, or of one Jacobi column, on one \
             step. What is not asked for is zero, and has no mark. n: dimension of the integrated state. mult.: multiplications in the series of \
             flow and columns over those of the base flow at the last accuracy. Columns steer the steps here, so the flow of a row with columns \
             takes a few steps more; conjugate: with the columns that conjugate times need.",
            params.spin.k,
            params.spin.p_theta.count(),
            params.serret_andoyer.xi1.count(),
            params.rotation_group.directions,
            three_problems::in_words(&params.asked()),
        ));
        let range = count_range(tables)?;
        for (problem, title) in PROBLEMS {
            let table = tables.get(problem).map_err(unread)?;
            picture = picture.panel(counted_panel(title, table, params.samples, range)?);
        }
        Ok(picture)
    }

    fn values(_: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = Vec::new();
        for (problem, title) in PROBLEMS {
            let counts = Counts::read(tables.get(problem).map_err(unread)?)?;
            let last = counts.last_accuracy();
            let base = counts.row("base", last)?;
            let mut add = |name: String, ratio: f64, meaning: String| {
                // A quotient of two integers, rounded once.
                values.push(value(name, (ratio, f64::EPSILON * ratio), "1", meaning, "counted"));
            };
            let prefix = problem.replace('-', "_");
            for (set, words) in [
                ("one-column", "one Jacobi column"),
                ("two-columns", "two Jacobi columns"),
                ("three-columns", "three Jacobi columns"),
                ("attitude", "the attitude"),
            ] {
                let Ok(row) = counts.row(set, last) else { continue };
                let ratio = counts.of("multiplications", row)? / counts.of("multiplications", base)?;
                let meaning = format!("{title}: multiplications with {words} over those of the base flow, at {last:e}");
                add(format!("{prefix}_{}", set.replace('-', "_")), ratio, meaning);
            }
            let event = counts.row("conjugate", last)?;
            let isolated = counts.of("root_isolations", event)? / counts.of("event_evaluations", event)?;
            let meaning =
                format!("{title}: part of the steps on which roots of the event had to be isolated, at {last:e}");
            add(format!("{prefix}_isolated"), isolated, meaning);
        }
        Ok(values)
    }

    fn claims(_: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let mut tests: Vec<(&str, &str, Cases)> = vec![
            ("nothing_unasked", "What is not asked for is not done: its count is zero.", Cases::default()),
            (
                "smallest_state",
                "The state has the base flow's equations and those of the columns asked for, no more.",
                Cases::default(),
            ),
            (
                "columns_not_steering",
                "Columns that do not steer leave steps and coefficients of the base flow as they were.",
                Cases::default(),
            ),
            (
                "watching_is_apart",
                "Dense output and a watched invariant leave the integration as it was.",
                Cases::default(),
            ),
            ("asking_for_less", "Taking any one effect away does less: its count falls to zero.", Cases::default()),
        ];
        for (problem, _) in PROBLEMS {
            let counts = Counts::read(tables.get(problem).map_err(unread)?)?;
            for row in 0..counts.table.rows() {
                for ((_, _, cases), judge) in tests.iter_mut().zip(JUDGES) {
                    if let Some(fault) = judge(problem, &counts, row)? {
                        cases.add(fault, || format!("{problem}, {}, {:e}", counts.sets[row], counts.asked[row]));
                    }
                }
            }
        }
        let place = "not in the article: how this program computes";
        Ok(tests.into_iter().map(|(id, statement, cases)| cases.claim(id, place, statement, "")).collect())
    }
}

/// A table of counts, read.
struct Counts<'t> {
    table: &'t Table,
    sets: &'t [String],
    asked: &'t [f64],
}

impl<'t> Counts<'t> {
    fn read(table: &'t Table) -> Result<Self, NodeError> {
        Ok(Self { table, sets: table.texts("effects").map_err(unread)?, asked: table.f64s("asked").map_err(unread)? })
    }

    fn last_accuracy(&self) -> f64 {
        self.asked.last().copied().unwrap_or_default()
    }

    fn row(&self, set: &str, asked: f64) -> Result<usize, NodeError> {
        let found = (0..self.table.rows()).find(|row| self.sets[*row] == set && self.asked[*row] == asked);
        found.ok_or_else(|| NodeError::new(format!("no row {set} at {asked:e}")))
    }

    fn of(&self, column: &str, row: usize) -> Result<f64, NodeError> {
        Ok(self.table.numbers(column).map_err(unread)?[row])
    }

    /// The same per start.
    fn per_start(&self, column: &str, row: usize) -> Result<f64, NodeError> {
        Ok(self.of(column, row)? / self.of("starts", row)?)
    }
}

/// The rows of the figure, from above: set of effects and words.
fn figure_rows(counts: &Counts<'_>, samples: usize) -> Vec<(&'static str, String)> {
    let words = [
        ("base", "base flow".to_owned()),
        ("one-column", "+ 1 column".to_owned()),
        ("two-columns", "+ 2 columns".to_owned()),
        ("three-columns", "+ 3 columns".to_owned()),
        ("conjugate", "+ conjugate".to_owned()),
        ("series-kept", "+ series kept".to_owned()),
        ("states-at-times", format!("+ {samples} states")),
        ("monitor", "+ energy".to_owned()),
        ("attitude", "attitude".to_owned()),
    ];
    words.into_iter().filter(|(set, _)| counts.sets.iter().any(|known| known == set)).collect()
}

/// What the dots of a row stand for: column, role, shape, words, place within the row.
const DOTS: [(&str, Role, Option<Marker>, &str, f64); 7] = [
    ("flow_evaluations", Role::SeriesA, None, "coefficients of the flow", -0.22),
    ("tangent_evaluations", Role::SeriesB, None, "coefficients of the columns", 0.0),
    ("event_evaluations", Role::SeriesC, None, "steps with the event expanded", 0.0),
    ("root_isolations", Role::SeriesD, None, "steps with roots isolated", 0.24),
    ("kept_coefficients", Role::SeriesE, None, "coefficients kept", 0.0),
    ("states_inside", Role::SeriesF, None, "states inside steps", 0.0),
    ("monitor_evaluations", Role::SeriesF, Some(Marker::Cross), "energy evaluated", 0.0),
];

fn rows_axis(rows: &[(&'static str, String)], from: f64) -> Axis {
    let ticks = rows.iter().enumerate().map(|(i, (_, words))| (i as f64, Label::from(words.as_str())));
    Axis::new("").fixed(from, rows.len() as f64 - 0.4).ticks_at(ticks).reversed()
}

/// The least and the largest count per start that the figure shows, over all problems.
fn count_range(tables: &Tables) -> Result<(f64, f64), NodeError> {
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for (problem, _) in PROBLEMS {
        let counts = Counts::read(tables.get(problem).map_err(unread)?)?;
        for row in 0..counts.table.rows() {
            for (column, ..) in DOTS {
                let count = counts.per_start(column, row)?;
                if count > 0.0 {
                    (least, most) = (least.min(count), most.max(count));
                }
            }
        }
    }
    Ok((least, most))
}

fn counted_panel(title: &str, table: &Table, samples: usize, (least, most): (f64, f64)) -> Result<Panel, NodeError> {
    let counts = Counts::read(table)?;
    let rows = figure_rows(&counts, samples);
    let last = counts.last_accuracy();
    let base = counts.row("base", last)?;
    // Room on the right for two columns of numbers, above for their heads.
    let beyond = |part: f64| most * libm::pow(most / least, part);
    let decade = |n: i32| (libm::pow(10.0, f64::from(n)), if n == 0 { "1".to_owned() } else { format!("10^{n}") });
    let decades = (0..=9).map(decade).filter(|(at, _)| *at <= most);
    let x =
        Axis::new("count per start").log().fixed(least / libm::pow(most / least, 0.06), beyond(0.66)).ticks_at(decades);
    let y = rows_axis(&rows, -1.3);
    let mut panel = Panel::new(x, y).title(title.to_owned());
    for (i, (set, _)) in rows.iter().enumerate() {
        for (column, role, marker, words, shift) in DOTS {
            let mut points = Vec::new();
            for row in (0..table.rows()).filter(|row| counts.sets[*row] == *set) {
                let count = counts.per_start(column, row)?;
                if count > 0.0 {
                    points.push((count, i as f64 + shift));
                }
            }
            if let Some(end) = points.last().copied() {
                panel = panel.mark(Points { marker, ..Points::new(role, vec![end]) }.legend(words));
                // Counts that are the same at all accuracies have no line.
                if points.iter().any(|point| *point != end) {
                    panel = panel.mark(Curve::new(role, points));
                }
            }
        }
        let row = counts.row(set, last)?;
        let ratio = counts.of("multiplications", row)? / counts.of("multiplications", base)?;
        let dimension = counts.of("state_dimension", row)?;
        panel = panel.mark(Text::new((beyond(0.24), i as f64), Side::Left, format!("{dimension}"))).mark(Text::new(
            (beyond(0.65), i as f64),
            Side::Left,
            format!("{ratio:.2}"),
        ));
    }
    Ok(panel.mark(Text::new((beyond(0.24), -0.9), Side::Left, "*n*")).mark(Text::new(
        (beyond(0.65), -0.9),
        Side::Left,
        "mult.",
    )))
}

fn measurements(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
    let Measurement { repetitions } = params.measurement;
    let (asked, samples, machine) = (params.asked(), params.samples, machine::describe());
    let with = |problem: &str, leaves: &[&'static str]| {
        let mut origins = three_problems::origins(problem, leaves);
        origins.push(("repetitions", "measurement.repetitions".to_owned()));
        origins
    };
    let (every, here) = (asked.clone(), machine.clone());
    let spin = TimeOfEffects { problem: params.spin(), asked: every, samples, repetitions, machine: here };
    nodes.add(TIME_SPIN, &[], spin, &[], &with(SPIN, SPIN_LEAVES))?;
    let (every, here) = (asked.clone(), machine.clone());
    let reduced = TimeOfEffects { problem: params.serret_andoyer(), asked: every, samples, repetitions, machine: here };
    nodes.add(TIME_SERRET_ANDOYER, &[], reduced, &[], &with(SERRET_ANDOYER, SERRET_ANDOYER_LEAVES))?;
    let group = TimeOfEffects { problem: params.rotation_group(), asked, samples, repetitions, machine };
    nodes.add(TIME_ROTATION_GROUP, &[], group, &[], &with(ROTATION_GROUP, ROTATION_GROUP_LEAVES))?;
    Ok(())
}

const TIME_SPIN: &str = "time-spin";
const TIME_SERRET_ANDOYER: &str = "time-serret-andoyer";
const TIME_ROTATION_GROUP: &str = "time-rotation-group";

fn measured_picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
    let mut machine = String::new();
    let mut panels = Vec::new();
    for (name, (_, title)) in [TIME_SPIN, TIME_SERRET_ANDOYER, TIME_ROTATION_GROUP].into_iter().zip(PROBLEMS) {
        let table = tables.get(name).map_err(unread)?;
        machine = table.texts("machine").map_err(unread)?.first().cloned().unwrap_or_default();
        panels.push(timed_panel(title, table, params.samples)?);
    }
    let picture = Picture::new(Width::Double, 84.0, "What each effect costs in time").caption(format!(
        "Measured on {machine}, one thread: time of an integration with one effect added, over that of the base flow, for the starts of the counted \
         figure. Each start was integrated {} times; the mean of the starts' shortest times counts. Circles: multiplications in the series of flow and \
         columns over those of the base flow, counted, at the last accuracy; what observers do (events, dense output, the watched energy) is not in \
         them. On the right: microseconds of one start at the last accuracy.",
        params.measurement.repetitions,
    ));
    Ok(panels.into_iter().fold(picture, Picture::panel))
}

fn timed_panel(title: &str, table: &Table, samples: usize) -> Result<Panel, NodeError> {
    let counts = Counts::read(table)?;
    let rows = figure_rows(&counts, samples);
    let last = counts.last_accuracy();
    let mut accuracies: Vec<f64> = counts.asked.to_vec();
    accuracies.dedup();
    let most = table.f64s("ratio").map_err(unread)?.iter().copied().fold(1.0, f64::max);
    let x = Axis::new("time over base flow").fixed(0.0, 1.5 * most);
    let mut panel =
        Panel::new(x, rows_axis(&rows, -0.6)).title(title.to_owned()).mark(RuleLine::vertical(Role::Reference, 1.0));
    let roles = [Role::SeriesA, Role::SeriesB, Role::SeriesC, Role::SeriesD, Role::SeriesE];
    for (j, asked) in accuracies.iter().enumerate() {
        let shift = if accuracies.len() > 1 { 0.4 * (j as f64 / (accuracies.len() - 1) as f64) - 0.2 } else { 0.0 };
        let mut points = Vec::new();
        for (i, (set, _)) in rows.iter().enumerate() {
            points.push((counts.of("ratio", counts.row(set, *asked)?)?, i as f64 + shift));
        }
        panel = panel.mark(Points::new(roles[j % roles.len()], points).legend(format!("asked {asked:e}")));
    }
    let mut multiplied = Vec::new();
    for (i, (set, _)) in rows.iter().enumerate() {
        let row = counts.row(set, last)?;
        multiplied.push((counts.of("multiplications_ratio", row)?, i as f64 + 0.36));
        let time = format!("{:.1} µs", counts.of("microseconds", row)?);
        panel = panel.mark(Text::new((1.48 * most, i as f64), Side::Left, time));
    }
    Ok(panel.mark(Points::new(Role::SeriesF, multiplied).legend("multiplications, counted")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::experiments::preview;

    #[test]
    fn counts_values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            assert!(matches!(&claim.evidence, Evidence::Direct(test) if test.holds()), "{claim:?}");
        }
        let counts = preview.table("spin");
        // Nine sets at four accuracies.
        assert_eq!(counts.rows(), 36);
        // One conjugate time is found from every start, at every accuracy.
        let (sets, roots) = (counts.texts("effects").unwrap(), counts.ints("roots_found").unwrap());
        assert!(sets.iter().zip(roots).all(|(set, roots)| *roots == if set == "conjugate" { 40 } else { 0 }));
        // Seven products against thirteen and nineteen (`geometry::spin::lift`): with all else between these and one column for three.
        for (name, least, most) in
            [("spin_one_column", 1.5, 13.0 / 7.0 + 0.2), ("spin_two_columns", 2.2, 19.0 / 7.0 + 0.3)]
        {
            let ratio = preview.value(name);
            assert!(ratio > least && ratio < most, "{name}: {ratio}");
        }
    }

    #[test]
    fn the_command_lines_accuracy_takes_the_place_of_all() {
        let text = include_str!("../../experiments/cost_of_effects.toml").to_owned();
        let source = crate::contract::plan::ConfigSource { file: "f".to_owned(), text };
        let planned = EXPERIMENT.plan("cost_of_effects", &source, Some(Accuracy::Draft)).unwrap();
        let of_spin = planned.plan.nodes.iter().find(|node| node.address.node == "spin").unwrap();
        let asked: Vec<_> = of_spin.params.iter().filter(|line| line.path.starts_with("asked")).collect();
        assert!(asked.len() <= 2 && asked.iter().any(|line| line.leaf.to_string().contains("0.0001")), "{asked:?}");
    }

    #[test]
    fn measurements_are_planned_only_when_asked_for() {
        let text = include_str!("../../experiments/cost_of_effects.toml").to_owned();
        let source = crate::contract::plan::ConfigSource { file: "f".to_owned(), text };
        for measure in [false, true] {
            let request = crate::experiments::definition::Request { accuracy: None, measure };
            let plan = EXPERIMENT.plan_requested("cost_of_effects", &source, request).unwrap().plan;
            let measured = plan.nodes.iter().filter(|node| node.compute.kind().measurement).count();
            let exports = plan.exports.iter().filter(|export| export.path.starts_with("measured/")).count();
            assert_eq!((measured, exports), if measure { (3, 4) } else { (0, 0) });
        }
        let measuring = crate::experiments::ALL.iter().filter(|experiment| experiment.measures);
        assert_eq!(measuring.map(|experiment| experiment.kind).collect::<Vec<_>>(), ["cost_of_effects", "accuracy"]);
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("1e-9, 1e-12", "1e-9, 1e-9", "accuracies[2]"),
            ("samples = 100", "samples = 0", "samples"),
            ("k = 0.8", "k = 0.0", "spin.k"),
            ("from = 0.11", "from = 0.09", "serret-andoyer.xi1"),
            ("directions = 40", "directions = 0", "rotation-group.directions"),
            ("repetitions = 25", "repetitions = 0", "measurement.repetitions"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/cost_of_effects.toml"), &cases);
    }
}
