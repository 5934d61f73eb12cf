//! Theorem 3.9 (section 3.2.2): bounds of the first conjugate time `t1` along oscillating extremals, its infimum and its limit.
//!
//! Part 1: `2K(m)/M ≤ t1 < 3K(m)/M`. The lower bound holds and is attained at turning points. The upper one holds as stated: `t1` is defined before
//! Lemma 3.4 as the smaller `|t|` of both signs; for the first `t > 0` alone it does not: there `M t1 < 4K − ψ0`, with ψ0 the phase since the last turning point, and
//! the supremum of `M t1/K` is 4, approached like `4 − ln 3/K` for `ξ1 → 1`. Part 2: the least `t1` is `π√A/√(2h(B−A)(C−A))`, and
//! `t1 → ∞` at the separatrix. Time is arc length (`h = 1/2`) except for the named start, which has its own h; lengths as in the Darboux chart.
//!
//! Hard spots: starts near turning points and `ξ1` near 1, where t1 M/K climbs from 2 to nearly 4 within a phase of order 1/K.

mod claims;

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{largest_route_difference, quantities, unread, value};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, OscillatingStart, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::by_integration::{self, ConjugatePointsByIntegration};
use crate::effects::serret_andoyer::conjugate_locus::{ConjugateLocus, Spacing};
use crate::effects::serret_andoyer::conjugate_time_bounds::ConjugateTimeBounds;
use crate::effects::serret_andoyer::conjugate_time_supremum::ConjugateTimeSupremum;
use crate::effects::serret_andoyer::equator_limits::EquatorConjugatePoint;
use crate::effects::serret_andoyer::named_start::NamedStart;
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, extremals of part 1, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, OscillatingStart>,
    /// Towards the supremum.
    pub supremum: Supremum,
    /// Extremals of part 2.
    pub part_2: Part2,
    /// One extremal beyond the printed bound.
    pub counterexample: Counterexample,
}

/// Towards the supremum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Supremum {
    /// `1 − ξ1`, in [1e-18, 1), falling; at least one.
    pub one_minus_xi1: Vec<f64>,
}

/// Extremals of part 2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part2 {
    /// Starts (length), `|φ0| < K(k)/α`; at least one, each once.
    pub phi0: Vec<f64>,
    /// Which constants `p_θ`.
    pub spacing: ConstantSpacing,
}

/// Which constants `p_θ`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstantSpacing {
    /// The smallest δ as a part of the largest, in [1e-13, 0.2].
    pub smallest: f64,
    /// Intervals near the cusp, 1 to 9999.
    pub cusp: usize,
    /// Intervals towards the separatrix, 1 to 9999.
    pub tail: usize,
}

/// One extremal beyond the printed bound.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Counterexample {
    /// Energy, above 0.
    pub h: f64,
    /// The angle y at the start (rad).
    pub y0: f64,
    /// `ξ1`, between cos² y0 and 1.
    pub xi1: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate()?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)?;
        let list = &self.supremum.one_minus_xi1;
        Invalid::unless(!list.is_empty(), "supremum.one_minus_xi1", "[]", "at least one value")?;
        let mut before = 1.0;
        for (i, d) in list.iter().enumerate() {
            let accepted = format!("at least 1e-18, below {before:?} (falling)");
            Invalid::number(*d >= 1e-18 && *d < before, format!("supremum.one_minus_xi1[{i}]"), *d, accepted)?;
            before = *d;
        }
        let half_width = self.scene.metric.half_width();
        Invalid::unless(!self.part_2.phi0.is_empty(), "part_2.phi0", "[]", "at least one value")?;
        for (i, phi0) in self.part_2.phi0.iter().enumerate() {
            let inside = phi0.abs() < half_width && !self.part_2.phi0[..i].contains(phi0);
            let accepted = format!("|phi0| < K(k)/alpha = {half_width:.6}, each value once");
            Invalid::number(inside, format!("part_2.phi0[{i}]"), *phi0, accepted)?;
        }
        let ConstantSpacing { smallest, cusp, tail } = self.part_2.spacing;
        let accepted = "a number from 1e-13 to 0.2";
        Invalid::number((1e-13..=0.2).contains(&smallest), "part_2.spacing.smallest", smallest, accepted)?;
        Invalid::unless((1..=9999).contains(&cusp), "part_2.spacing.cusp", cusp, "1 to 9999")?;
        Invalid::unless((1..=9999).contains(&tail), "part_2.spacing.tail", tail, "1 to 9999")?;
        let Counterexample { h, y0, xi1 } = self.counterexample;
        Invalid::number(h > 0.0 && h.is_finite(), "counterexample.h", h, "a number above 0")?;
        Invalid::number(y0.is_finite(), "counterexample.y0", y0, "a finite number")?;
        let cosine = libm::cos(y0);
        let accepted = format!("above cos^2(y0) = {:.6}, below 1", cosine * cosine);
        Invalid::number(xi1 > cosine * cosine && xi1 < 1.0, "counterexample.xi1", xi1, accepted)
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Theorem>();

const PICTURE: Kind = picture_kind(
    "theorem_3_9-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/theorem_3_9",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "theorem_3_9-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/theorem_3_9",
        "table",
    ],
);

struct Theorem;

impl Definition for Theorem {
    type Params = Params;

    const ID: &'static str = "theorem_3_9";
    const TITLE: &'static str = "bounds of the first conjugate time";
    const PLACE: &'static str = "Theorem 3.9";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::serret_andoyer(&params.scene, &OWN, None, None)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let Params { scene, supremum, part_2, counterexample } = params;
        let body = scene.metric.serret_andoyer.into();
        let metric = Inertia::origins("serret-andoyer");
        let from = |own: &[(&'static str, String)]| [metric.clone(), own.to_vec()].concat();
        let second = ConjugatePointsByIntegration::new(body, scene.accuracy);
        for (i, xi1) in scene.start.xi1.values().into_iter().enumerate() {
            let axes = [("xi1", format!("{xi1:?}"))];
            let bounds = ConjugateTimeBounds { body, one_minus_xi1: 1.0 - xi1, starts: scene.start.starts };
            let own = [
                ("one_minus_xi1", scene.start.xi1.key_of("scene.start.xi1", i)),
                ("starts", "scene.start.starts".to_owned()),
            ];
            let points = nodes.add("bounds", &axes, bounds, &[], &from(&own))?;
            nodes.add("bounds-by-integration", &axes, second, &[(by_integration::INPUT, &points)], &metric)?;
        }
        let own = [("one_minus_xi1", "supremum.one_minus_xi1".to_owned())];
        let towards = ConjugateTimeSupremum { body, one_minus_xi1: supremum.one_minus_xi1.clone() };
        let towards = nodes.add("supremum", &[], towards, &[], &from(&own))?;
        nodes.add("supremum-by-integration", &[], second, &[(by_integration::INPUT, &towards)], &metric)?;
        let ConstantSpacing { smallest, cusp, tail } = part_2.spacing;
        for (i, phi0) in part_2.phi0.iter().enumerate() {
            let axes = [("phi0", format!("{phi0:?}"))];
            let locus = ConjugateLocus { body, phi0: *phi0, spacing: Spacing { smallest, cusp, tail } };
            let own = [
                ("phi0", format!("part_2.phi0[{i}]")),
                ("spacing.smallest", "part_2.spacing.smallest".to_owned()),
                ("spacing.cusp", "part_2.spacing.cusp".to_owned()),
                ("spacing.tail", "part_2.spacing.tail".to_owned()),
            ];
            let locus = nodes.add("conjugate-locus", &axes, locus, &[], &from(&own))?;
            nodes.add("conjugate-locus-by-integration", &axes, second, &[(by_integration::INPUT, &locus)], &metric)?;
        }
        nodes.add("equator-conjugate-point", &[], EquatorConjugatePoint { body }, &[], &metric)?;
        let Counterexample { h, y0, xi1 } = *counterexample;
        let own = ["h", "y0", "xi1"].map(|leaf| (leaf, format!("counterexample.{leaf}")));
        nodes.add("counterexample", &[], NamedStart { body, h, y0, xi1 }, &[], &from(&own))?;
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        let xi1 = params.scene.start.xi1.values();
        let named = tables.get("counterexample").map_err(unread)?;
        let named = |name: &str| named.lookup("quantity", name, "value").map_err(unread);
        let phase = || Axis::new("*ψ*_0/*K*").fixed(0.0, 2.0);
        let ratio = |text: &str| Axis::new(text).fixed(1.8, 4.1);
        let rule = |at: f64, text: &str, fraction: f64, side| {
            RuleLine::horizontal(Role::Bound, at).label(DirectLabel::new(text).at(At::Fraction(fraction)).side(side))
        };
        let mut first = Panel::new(phase(), ratio("*t*_1*M*/*K*, first *t* > 0"))
            .mark(rule(2.0, "lower bound 2", 0.5, Side::Below))
            .mark(rule(3.0, "printed bound 3", 0.82, Side::Above))
            .mark(
                Curve::new(Role::Bound, vec![(0.0, 4.0), (2.0, 2.0)])
                    .label(DirectLabel::new("4 − *ψ*_0/*K*").at(At::Fraction(0.3)).side(Side::AboveRight)),
            );
        let mut smaller = Panel::new(phase(), ratio("*t*_1*M*/*K*, smaller |*t*| of both signs"))
            .mark(rule(2.0, "lower bound 2", 0.5, Side::Below))
            .mark(rule(3.0, "printed bound 3", 0.5, Side::Above));
        let last = xi1.len().saturating_sub(1).max(1) as f64;
        for (i, value) in xi1.iter().enumerate() {
            let table = tables.get(&format!("bounds/xi1={value:?}")).map_err(unread)?;
            let column = |name: &str| table.f64s(name).map_err(unread);
            let x = column("psi0_over_k")?;
            let points = |y: &[f64]| x.iter().copied().zip(y.iter().copied()).collect::<Vec<_>>();
            let curve = |name: &str| -> Result<Curve, NodeError> {
                let curve = Curve::new(Role::SeriesA, points(column(name)?));
                Ok(curve.tone(i as f64 / last).legend(format!("*ξ*_1 = {value}")))
            };
            first = first.mark(curve("ratio")?);
            smaller = smaller.mark(curve("ratio_smaller")?);
        }
        let first = first.mark(
            Points::new(Role::Extremum, vec![(named("counterexample_phase")?, named("counterexample_ratio")?)])
                .legend("named start"),
        );
        let formulas = tables.get("equator-conjugate-point").map_err(unread)?;
        let t_star = formulas.lookup("quantity", "t_star", "value").map_err(unread)?;
        let mut times = Panel::new(Axis::new("*δ* = *B* *p*_*θ*^2 − 1").log(), Axis::new("*t*_1").unit("length")).mark(
            RuleLine::horizontal(Role::Reference, t_star)
                .label(DirectLabel::new("π√*A*/√((*B*−*A*)(*C*−*A*))").at(At::Start).side(Side::Above)),
        );
        let roles = [Role::SeriesA, Role::SeriesB, Role::SeriesC, Role::SeriesD, Role::SeriesE, Role::SeriesF];
        for (i, phi0) in params.part_2.phi0.iter().enumerate() {
            let table = tables.get(&format!("conjugate-locus/phi0={phi0:?}")).map_err(unread)?;
            let (delta, t1) = (table.f64s("delta").map_err(unread)?, table.f64s("t1").map_err(unread)?);
            let points = delta.iter().copied().zip(t1.iter().copied()).collect();
            let text = format!("*φ*_0 = {phi0}").replace('-', "−");
            times = times.mark(Curve::new(roles[i % roles.len()], points).legend(text));
        }
        let starts: Vec<String> = params.part_2.phi0.iter().map(f64::to_string).collect();
        let Counterexample { h, y0, xi1: named_xi1 } = params.counterexample;
        Ok(Picture::new(Width::Double, 78.0, "Bounds of the first conjugate time")
            .caption(format!(
                "Oscillating extremals of the Serret-Andoyer metric, A = {a}, B = {b}, C = {c}: first conjugate time t1 in units of K(m)/M \
                 against the phase ψ0 since the last turning point, for ξ1 = {}. (a) First t > 0. Dotted: the lower bound 2, attained at \
                 turning points; the upper bound 3, which does not hold for t > 0 alone; the bound 4 − ψ0/K, which does. Triangle: h = {h}, y0 = \
                 {y0}, ξ1 = {named_xi1}. (b) The smaller |t| of both signs, which the article means and for which its bound holds. (c) t1 over all \
                 oscillating constants p_θ, both branches, for the starts φ0 = {}: it is least on the equator (dashed: \
                 π√A/√((B−A)(C−A))) and grows like log(1/δ) towards the separatrix. {} starts for each ξ1; closed form, equation (15) without \
                 poles, relative error 1e-14; every time checked by integrating the flow (9).",
                xi1.iter().map(f64::to_string).collect::<Vec<_>>().join(", "),
                starts.join(", "),
                params.scene.start.starts
            ))
            .panel(first)
            .panel(smaller)
            .panel(times))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = quantities(tables.get("counterexample").map_err(unread)?)?;
        let formulas = quantities(tables.get("equator-conjugate-point").map_err(unread)?)?;
        values.extend(formulas.into_iter().filter(|value| value.name == "t_star"));
        let grid = Grid::read(params, tables)?;
        let mut add = |name: &str, number: f64, error: f64, unit: &str, meaning: &str, route: &str| {
            values.push(value(name, (number, error), unit, meaning, route));
        };
        let closed = "closed form, equation (15) without poles";
        add("grid_smallest_ratio", grid.smallest(), RATIO_ERROR, "1", "smallest t1 M/K of the grid", closed);
        add(
            "grid_largest_ratio",
            grid.largest(|start| start.forward),
            RATIO_ERROR,
            "1",
            "largest t1 M/K of the grid, t > 0",
            closed,
        );
        add(
            "grid_largest_smaller_ratio",
            grid.largest(|start| start.smaller),
            RATIO_ERROR,
            "1",
            "largest t1 M/K of the grid, smaller |t| of both signs",
            closed,
        );
        let supremum = tables.get("supremum").map_err(unread)?;
        let last = supremum.rows().checked_sub(1).ok_or_else(|| NodeError::new("no supremum"))?;
        let at_last = |name: &str| supremum.f64s(name).map(|values| values[last]).map_err(unread);
        let meaning = format!("largest t1 M/K over all starts where 1 − ξ1 = {:?}", at_last("one_minus_xi1")?);
        add("supremum_ratio", at_last("ratio")?, RATIO_ERROR, "1", &meaning, "golden section in the phase");
        let rate = at_last("below_four_times_k")?;
        let error = RATIO_ERROR * at_last("complete_k")?;
        add("supremum_rate", rate, error, "1", "(4 − t1 M/K) K there; tends to ln 3", "golden section in the phase");
        let least = least_time(params, tables)?;
        add("smallest_time", least, 1e-14 * least, "length", "least t1 over starts and constants of part 2", closed);
        values.push(largest_route_difference(&second_routes(params, tables)?)?);
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        claims::claims(params, tables, &Self::values(params, tables)?)
    }
}

/// ln 3.
const LN_3: f64 = 1.098_612_288_668_109_7;
/// Absolute error of t1 M/K, a number of size 4: a few ε of its parts.
const RATIO_ERROR: f64 = 1e-14;

/// A start of the grid of part 1: times in units of K(m)/M.
struct GridStart {
    xi1: f64,
    /// The phase ψ0 since the last turning point, in units of K(m).
    phase: f64,
    /// The first conjugate time t > 0.
    forward: f64,
    /// The smaller |t| of both signs.
    smaller: f64,
}

/// The grid of part 1.
struct Grid(Vec<GridStart>);

impl Grid {
    fn read(params: &Params, tables: &Tables) -> Result<Self, NodeError> {
        let mut starts = Vec::new();
        for xi1 in params.scene.start.xi1.values() {
            let table = tables.get(&format!("bounds/xi1={xi1:?}")).map_err(unread)?;
            let column = |name: &str| table.f64s(name).map_err(unread);
            let (phase, forward, smaller) = (column("psi0_over_k")?, column("ratio")?, column("ratio_smaller")?);
            starts.extend((0..table.rows()).map(|row| GridStart {
                xi1,
                phase: phase[row],
                forward: forward[row],
                smaller: smaller[row],
            }));
        }
        Ok(Self(starts))
    }

    fn smallest(&self) -> f64 {
        self.0.iter().map(|start| start.smaller).fold(f64::INFINITY, f64::min)
    }

    fn largest(&self, time: fn(&GridStart) -> f64) -> f64 {
        self.0.iter().map(time).fold(0.0, f64::max)
    }
}

fn part_2_tables<'a>(params: &Params, tables: &'a Tables, name: &str) -> Result<Vec<&'a Table>, NodeError> {
    let table = |phi0: &f64| tables.get(&format!("{name}/phi0={phi0:?}")).map_err(unread);
    params.part_2.phi0.iter().map(table).collect()
}

fn second_routes<'a>(params: &Params, tables: &'a Tables) -> Result<Vec<&'a Table>, NodeError> {
    let mut all = part_2_tables(params, tables, "conjugate-locus-by-integration")?;
    all.push(tables.get("supremum-by-integration").map_err(unread)?);
    for xi1 in params.scene.start.xi1.values() {
        all.push(tables.get(&format!("bounds-by-integration/xi1={xi1:?}")).map_err(unread)?);
    }
    Ok(all)
}

fn least_time(params: &Params, tables: &Tables) -> Result<f64, NodeError> {
    let mut least = f64::INFINITY;
    for table in part_2_tables(params, tables, "conjugate-locus")? {
        least = table.f64s("t1").map_err(unread)?.iter().copied().fold(least, f64::min);
    }
    Ok(least)
}

fn cusp_row(table: &Table) -> Result<usize, NodeError> {
    let branch = table.ints("branch").map_err(unread)?;
    let descending = branch.iter().position(|branch| *branch < 0);
    descending.and_then(|row| row.checked_sub(1)).ok_or_else(|| NodeError::new("no cusp"))
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
        for (name, exact) in ORACLE {
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            assert!((found.value - exact).abs() <= found.error, "{name}: {:?} is not {exact:?}", found.value);
        }
        assert!(preview.value("largest_route_difference") <= 1e-12);
    }

    /// Oracle: mpmath 1.3.0, 50 digits (see `tests/oracle/values.toml`), and ln 3 up to terms of 1 − ξ1 = 1e-15.
    const ORACLE: [(&str, f64); 6] = [
        ("counterexample_ratio", 3.392_158_842_222_841_54),
        ("counterexample_ratio_backward", 2.301_333_977_186_953_09),
        ("counterexample_phase", 0.437_468_178_637_943_40),
        ("counterexample_time", 12.228_433_342_120_109_1),
        ("t_star", 4.772_421_833_446_835_9),
        ("supremum_rate", LN_3),
    ];

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("xi1 = [0.05,", "xi1 = [1.05,", "scene.start.xi1[0]"),
            ("[1e-3, 1e-6,", "[1e-6, 1e-3,", "supremum.one_minus_xi1[1]"),
            ("-1.2]", "0.0]", "part_2.phi0[2]"),
            ("xi1 = 0.9\n", "xi1 = 0.7\n", "counterexample.xi1"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/theorem_3_9.toml"), &cases);
    }
}
