//! What accuracy costs: first conjugate times on the three metrics by closed form, power series and Runge-Kutta pairs, from careless
//! requests to the last digit of `f64`, and beyond it in double-double.
//!
//! Not in the article: it is what a reader needs to choose a method, and why this program integrates by power series. Every method gets
//! the same starts and the same requests; its errors are taken against a reference in double-double that a second route confirms. Work
//! is counted in multiplications of `f64`, by running each method on numbers that count (`numerics::counting`): series, stages, events,
//! interpolants and roots alike. It does not depend on the machine. Time does: it is measured on demand only, and stands under `measured/`.
//!
//! The hard spot: methods must be compared at equal *achieved* error, as one gives more digits than it is asked for, another fewer. So
//! work is drawn against the error achieved, and what was asked for in a second row. The equations of Lemma 4.1 as printed, in angles,
//! are integrated too: as a warning.

mod panels;

use self::panels::{
    CLOSED_FORM, DOP853, Errors, PRINTED_CHART, TAYLOR, TAYLOR_DOUBLE_DOUBLE, epsilon_of, error_axis, request_panel,
    rounding, work_marks, work_panel,
};
use super::definition::{Definition, Experiment, Measured, NOT_IN_ARTICLE, findings_kind, picture_kind};
use super::findings::{Cases, claim, quantities, unread};
use super::nodes::Nodes;
use super::three_problems::{
    self, Measurement, PROBLEMS, ROTATION_GROUP, ROTATION_GROUP_LEAVES, RotationGroupStarts, SERRET_ANDOYER,
    SERRET_ANDOYER_LEAVES, SPIN, SPIN_LEAVES, SerretAndoyerStarts, SpinStarts,
};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::cost_of_accuracy::counted::{CostOfAccuracy, DIVISION, DOUBLE_DOUBLE_PRODUCT, FUNCTION, ROOT};
use crate::effects::cost_of_accuracy::problem::Problem;
use crate::effects::cost_of_accuracy::quantities::{CostOfAccuracyQuantities, INPUT};
use crate::effects::cost_of_accuracy::rotation_group::RotationGroup;
use crate::effects::cost_of_accuracy::serret_andoyer::SerretAndoyer;
use crate::effects::cost_of_accuracy::spin::Spin;
use crate::effects::cost_of_accuracy::timed::TimeOfAccuracy;
use crate::effects::cost_of_effects::machine;
use crate::effects::scene::Inertia;
use crate::plot::axis::Axis;
use crate::plot::picture::{Layout, Panel, Picture, Width};
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Relative errors asked of methods in `f64`, falling; at least one.
    pub accuracies: Vec<Accuracy>,
    /// Relative errors asked of double-double, falling, 1e-30 to 0.1; none leaves it out.
    pub double_double: Vec<f64>,
    /// The achieved error at which work is compared, 1e-15 to 0.1.
    pub equal_error: f64,
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
        for (i, asked) in self.double_double.iter().enumerate() {
            let before = if i == 0 { f64::INFINITY } else { self.double_double[i - 1] };
            let accepted = (1e-30..=0.1).contains(asked) && *asked < before;
            Invalid::number(accepted, format!("double_double[{i}]"), *asked, "1e-30 to 0.1, falling")?;
        }
        let accepted = (1e-15..=0.1).contains(&self.equal_error);
        Invalid::number(accepted, "equal_error", self.equal_error, "1e-15 to 0.1")?;
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

    /// The bodies and starts, in words.
    fn starts(&self) -> String {
        let body = |Inertia { a, b, c }: Inertia| format!("A = {a}, B = {b}, C = {c}");
        format!(
            "(a) Spin problem, k = {}, {} starts on the equator. (b) Serret-Andoyer flow (9), {}, {} oscillating extremals. (c) SO(3), \
             equation (2), {}, {} momenta.",
            self.spin.k,
            self.spin.p_theta.count(),
            body(self.serret_andoyer.body),
            self.serret_andoyer.xi1.count(),
            body(self.rotation_group.body),
            self.rotation_group.directions,
        )
    }
}

/// Which config keys the leaves of a problem's nodes come from.
fn origins(problem: &str, leaves: &[&'static str]) -> Vec<(&'static str, String)> {
    let mut origins = three_problems::origins(problem, leaves);
    origins.push(("asked_in_double_double", "double_double".to_owned()));
    origins
}

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<AccuracyCost>();

const PICTURE: Kind = picture_kind(
    "accuracy-picture",
    &[
        "experiments/accuracy",
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
    "accuracy-measured-picture",
    &[
        "experiments/accuracy",
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
    "accuracy-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/accuracy",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/three_problems.rs",
        "table",
    ],
);

struct AccuracyCost;

impl AccuracyCost {
    fn add<P: Problem>(
        params: &Params,
        nodes: &mut Nodes,
        (name, leaves): (&str, &[&'static str]),
        problem: P,
    ) -> Result<(), NodeError> {
        let (asked, asked_in_double_double) = (params.asked(), params.double_double.clone());
        let counted = CostOfAccuracy { problem, asked, asked_in_double_double };
        let table = nodes.add(name, &[], counted, &[], &origins(name, leaves))?;
        let quantities = CostOfAccuracyQuantities { equal_error: params.equal_error };
        nodes.add(&format!("{name}-quantities"), &[], quantities, &[(INPUT, &table)], &[])?;
        Ok(())
    }

    fn measure<P: Problem>(
        params: &Params,
        nodes: &mut Nodes,
        (name, leaves): (&str, &[&'static str]),
        problem: P,
    ) -> Result<(), NodeError> {
        let mut origins = origins(name, leaves);
        origins.push(("repetitions", "measurement.repetitions".to_owned()));
        let timed = TimeOfAccuracy {
            problem,
            asked: params.asked(),
            asked_in_double_double: params.double_double.clone(),
            repetitions: params.measurement.repetitions,
            machine: machine::describe(),
        };
        nodes.add(&format!("time-{name}"), &[], timed, &[], &origins)?;
        Ok(())
    }
}

impl Definition for AccuracyCost {
    type Params = Params;

    const ID: &'static str = "accuracy";
    const TITLE: &'static str = "what accuracy costs";
    const PLACE: &'static str = NOT_IN_ARTICLE;
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;
    const MEASURED: Option<Measured<Params>> =
        Some(Measured { picture_kind: &MEASURED_PICTURE, nodes: measurements, picture: measured_picture });

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.accuracies = vec![accuracy];
        params.double_double.clear();
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        Self::add(params, nodes, (SPIN, SPIN_LEAVES), params.spin())?;
        Self::add(params, nodes, (SERRET_ANDOYER, SERRET_ANDOYER_LEAVES), params.serret_andoyer())?;
        Self::add(params, nodes, (ROTATION_GROUP, ROTATION_GROUP_LEAVES), params.rotation_group())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let mut apart = 0.0_f64;
        let (mut work, mut requests) = (Vec::new(), Vec::new());
        for (name, title) in PROBLEMS {
            let errors = Errors::read(tables.get(name).map_err(unread)?)?;
            apart = apart.max(errors.column("reference_difference")?.first().copied().unwrap_or_default());
            work.push(work_panel(title, &errors, work.is_empty()));
            requests.push(request_panel(title, &errors, requests.is_empty())?);
        }
        let layout = Layout::Weighted { columns: vec![1.0; 3], rows: vec![1.35, 1.0] };
        let picture = Picture::new(Width::Double, 160.0, "What accuracy costs").layout(layout).caption(format!(
            "First conjugate times by each method. {} Upper row: largest relative error over the starts against work per conjugate time, in \
             multiplications of f64: of series, stages, events, interpolants and roots alike, counted by running each method on numbers that \
             count; of f64 a division counts {DIVISION}, a square root {ROOT}, a value of an elementary function {FUNCTION}; a product in \
             double-double {DOUBLE_DOUBLE_PRODUCT}. A mark is a \
             request: relative errors of {} of methods in f64, of {} of double-double; nothing is asked of the closed form. Grey guides: \
             error proportional to work to the power −8 (the order of DOP853) and −9 (of Verner's pair), and work proportional to the square of the \
             order 2 + ½ ln(1/error) of a power series. Marks fall faster than the guides: finding the conjugate time is work that hardly grows with \
             accuracy, and the second terms of the pairs' errors show. Lower row: error achieved over error asked for; marks are the largest errors, lines \
             the medians. Lemma 4.1: the equations in angles as printed, integrated by DOP853. \
             The reference is the power series in double-double at its own rounding; a second route in double-double (the pendulum form; the closed \
             form; the attitude) differs from it by at most {apart:.1e}.",
            params.starts(),
            three_problems::in_words(&params.asked()),
            if params.double_double.is_empty() { "none".to_owned() } else { three_problems::in_words(&params.double_double) },
        ));
        Ok(work.into_iter().chain(requests).fold(picture, Picture::panel))
    }

    fn values(_: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = Vec::new();
        for (name, title) in PROBLEMS {
            let table = tables.get(&format!("{name}-quantities")).map_err(unread)?;
            for mut value in quantities(table)? {
                value.name = format!("{}_{}", name.replace('-', "_"), value.name);
                value.meaning = format!("{title}: {}", value.meaning);
                values.push(value);
            }
        }
        Ok(values)
    }

    fn claims(_: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let place = "not in the article: how this program computes";
        let (mut falls, mut beaten, mut charts) = (Cases::default(), Cases::default(), Cases::default());
        let (mut over, mut apart, mut closed) = (0.0_f64, 0.0_f64, None::<f64>);
        for (name, _) in PROBLEMS {
            let errors = Errors::read(tables.get(name).map_err(unread)?)?;
            apart = apart.max(errors.column("reference_difference")?.first().copied().unwrap_or_default());
            for row in 0..errors.rows() {
                let words = || format!("{name}, {}, {:e}", errors.methods[row], errors.asked[row]);
                let method = errors.methods[row].as_str();
                if row > 0 && errors.methods[row - 1] == method {
                    let rounding = errors.largest[row] <= ROUNDED * epsilon_of(method);
                    falls.add(errors.largest[row] > errors.largest[row - 1] && !rounding, words);
                }
                match method {
                    TAYLOR | TAYLOR_DOUBLE_DOUBLE => {
                        over = over.max(errors.largest[row] / errors.asked[row].max(ROUNDED * epsilon_of(method)));
                    }
                    CLOSED_FORM => closed = Some(closed.unwrap_or_default().max(errors.largest[row])),
                    _ => beaten.add(!errors.is_beaten(row, TAYLOR), words),
                }
                if method == PRINTED_CHART
                    && let Some(lifted) = errors.row(DOP853, errors.asked[row])
                {
                    let cheap = errors.work[row] < CHART_COSTS * errors.work[lifted];
                    charts.add(cheap || errors.largest[row] <= errors.largest[lifted], words);
                }
            }
        }
        let at_most = |id: &str, statement: &str, measured: f64, tolerance: f64, reason: &str| {
            let test = Test::AtMost { measured, tolerance, reason: reason.to_owned() };
            claim(id, place, statement, Evidence::Direct(test), "")
        };
        let mut claims = vec![
            at_most(
                "reference_is_confirmed",
                "The reference and its second route, which shares no equation with it, agree.",
                apart,
                1e-29,
                "a hundred times the rounding of double-double: orders of magnitude below all errors judged but those of double-double at 1e-28",
            ),
            falls.claim(
                "errors_fall",
                place,
                "Asking for less error gives less, down to rounding, for every method.",
                "",
            ),
            at_most(
                "power_series_give_what_is_asked",
                "The largest error of power series, over the error asked for.",
                over,
                10.0,
                "near the separatrix the flow multiplies the error of a step; requests below a hundred roundings count as that",
            ),
            beaten.claim(
                "power_series_are_cheapest",
                place,
                "Of the integrations in f64 power series take the fewest multiplications: each mark of another has a mark of theirs with no \
                 more error and no more work.",
                "",
            ),
        ];
        if let Some(closed) = closed {
            claims.push(at_most(
                "closed_forms_are_exact",
                "The largest relative error of a closed form in f64.",
                closed,
                20.0 * f64::EPSILON,
                "twenty roundings: starts are given by momenta, whose own rounding is no smaller near the separatrix",
            ));
        }
        claims.push(charts.claim(
            "printed_chart_is_worse",
            place,
            "In the angles of Lemma 4.1 the same method, asked for the same, takes at least four times the work and errs more.",
            "",
        ));
        Ok(claims)
    }
}

/// An error of so many roundings is rounding.
const ROUNDED: f64 = 100.0;
/// The printed chart's work, at least, over that of the lift.
const CHART_COSTS: f64 = 4.0;

fn measurements(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
    AccuracyCost::measure(params, nodes, (SPIN, SPIN_LEAVES), params.spin())?;
    AccuracyCost::measure(params, nodes, (SERRET_ANDOYER, SERRET_ANDOYER_LEAVES), params.serret_andoyer())?;
    AccuracyCost::measure(params, nodes, (ROTATION_GROUP, ROTATION_GROUP_LEAVES), params.rotation_group())
}

fn measured_picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
    let mut machine = String::new();
    let mut panels = Vec::new();
    for (name, title) in PROBLEMS {
        let table = tables.get(&format!("time-{name}")).map_err(unread)?;
        machine = table.texts("machine").map_err(unread)?.first().cloned().unwrap_or_default();
        let errors = Errors::timed(table)?;
        let x = Axis::new("time per conjugate time").unit("µs").log();
        let panel = Panel::new(x, error_axis()).title(title.to_owned()).mark(rounding());
        panels.push(work_marks(panel, &errors, false));
    }
    let picture = Picture::new(Width::Double, 86.0, "What accuracy costs in time").caption(format!(
        "Measured on {machine}, one thread: largest relative error against time per first conjugate time, mean of the starts' shortest of {} times. {} \
         Requests are those of the counted figure. In lanes: eight starts at a time, in a list of all starts eight times over.",
        params.measurement.repetitions,
        params.starts(),
    ));
    Ok(panels.into_iter().fold(picture, Picture::panel))
}

#[cfg(test)]
mod tests {
    use super::panels::TAYLOR_LANES;
    use super::*;
    use crate::experiments::definition::Request;
    use crate::experiments::preview;
    use crate::table::Table;

    #[test]
    fn errors_values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            assert!(matches!(&claim.evidence, Evidence::Direct(test) if test.holds()), "{claim:?}");
        }
        let table = preview.table(SPIN);
        // One row of the closed form, twelve of four methods each, six of double-double; nothing missed.
        assert_eq!(table.rows(), 1 + 4 * 12 + 6);
        let (found, starts) = (table.ints("found").unwrap(), table.ints("starts").unwrap());
        assert_eq!(found, starts);
        // Orders 8 and 9 from the tableaux; at these requests the second term of the error shows too, most in Verner's pair.
        for name in ["spin", "serret_andoyer", "rotation_group"] {
            let order = |method: &str| preview.value(&format!("{name}_{method}_order"));
            let orders = (order("dop853"), order("verner98"));
            assert!((7.5..9.5).contains(&orders.0) && (8.5..12.0).contains(&orders.1), "{name}: {orders:?}");
        }
    }

    #[test]
    fn the_command_lines_accuracy_takes_the_place_of_all() {
        let text = include_str!("../../experiments/accuracy.toml").to_owned();
        let edited = text
            .replace("1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, \"article\"", "\"draft\"");
        let edited =
            edited.replace("[1e-8, 1e-12, 1e-16, 1e-20, 1e-24, 1e-28]", "[]").replace("count = 24", "count = 3");
        // One request: no order, no work between requests, and a picture all the same.
        let preview = preview::run_text(&EXPERIMENT, edited);
        assert!(preview.findings.values.iter().all(|value| !value.name.ends_with("_order")));
        let source = crate::contract::plan::ConfigSource { file: "f".to_owned(), text };
        let planned = EXPERIMENT.plan("accuracy", &source, Some(Accuracy::Draft)).unwrap();
        let of_spin = planned.plan.nodes.iter().find(|node| node.address.node == SPIN).unwrap();
        let asked: Vec<_> = of_spin.params.iter().filter(|line| line.path.starts_with("asked")).collect();
        assert!(asked.iter().any(|line| line.leaf.to_string().contains("0.0001")) && asked.len() <= 4, "{asked:?}");
    }

    #[test]
    fn measurements_are_planned_and_drawn_when_asked_for() {
        let text = include_str!("../../experiments/accuracy.toml")
            .replace("1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, \"article\"", "1e-3, 1e-9")
            .replace("[1e-8, 1e-12, 1e-16, 1e-20, 1e-24, 1e-28]", "[1e-16]")
            .replace("count = 24", "count = 3")
            .replace("directions = 24", "directions = 3")
            .replace("repetitions = 15", "repetitions = 1");
        let source = crate::contract::plan::ConfigSource { file: "f".to_owned(), text: text.clone() };
        let plan =
            |measure| EXPERIMENT.plan_requested("accuracy", &source, Request { accuracy: None, measure }).unwrap().plan;
        let count = |measure| plan(measure).nodes.iter().filter(|node| node.compute.kind().measurement).count();
        assert_eq!((count(false), count(true)), (0, 3));
        let mut tables = Tables::new();
        for node in plan(true).nodes.iter().filter(|node| node.compute.kind().measurement) {
            let product = node.compute.run(&crate::contract::node::Inputs::default()).unwrap();
            let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
            assert!(table.f64s("microseconds").unwrap().iter().all(|time| *time > 0.0));
            // Lanes have the numbers of one at a time, and nothing was missed.
            let errors = Errors::timed(&table).unwrap();
            assert!(errors.largest.iter().all(|error| *error < 0.1));
            for row in errors.of(TAYLOR_LANES) {
                let alone = errors.row(TAYLOR, errors.asked[row]).unwrap();
                assert_eq!(errors.largest[row].to_bits(), errors.largest[alone].to_bits());
            }
            tables.insert(&node.address.node, table).unwrap();
        }
        let params = crate::contract::config::read::<Params>("f", &text).unwrap();
        let picture = measured_picture(&params, &tables).unwrap();
        assert_eq!(picture.panels.len(), 3);
        assert!(crate::plot::render::render(&picture).is_ok());
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("1e-12, 1e-13", "1e-12, 1e-12", "accuracies[10]"),
            ("1e-16, 1e-20", "1e-16, 1e-16", "double_double[3]"),
            ("1e-24, 1e-28", "1e-24, 1e-32", "double_double[5]"),
            ("equal_error = 1e-12", "equal_error = 0.0", "equal_error"),
            ("k = 0.8", "k = -1.0", "spin.k"),
            ("to = 0.99", "to = 1.0", "serret-andoyer.xi1"),
            ("directions = 24", "directions = 0", "rotation-group.directions"),
            ("repetitions = 15", "repetitions = 0", "measurement.repetitions"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/accuracy.toml"), &cases);
    }
}
