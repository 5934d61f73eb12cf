//! Fig. 9 (section 5.3): two extremals of the Euler-Poinsot problem on SO(3), their Euler angles, their conjugate points, and the
//! Serret-Andoyer extremal to which both project.
//!
//! Starts as printed: Euler angles (radians) and momenta. Time as in (2); time of the reduced problem (9) is the same. Left translations carry
//! extremals to extremals, so conjugate times depend on the momentum in the body alone; those of both cases agree to 4e-6, and so must their
//! conjugate times, whatever Φ1, k and K are.
//!
//! Hard spots: the start of case 1 is near a pole of Euler angles (sin Φ2 = 0.29), so a unit in the fourth decimal of Φ2 moves its conjugate time
//! by 8e-4; the arctangents of section 2.4 need their quadrant, as both cases start at g = 0.

mod findings;

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::unread;
use super::nodes::Nodes;
use super::scenes::attitude::{CASES, SPHERE_VIEW, Trajectory, each, plane};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::rotation_group::attitude::{self, AttitudeTrajectory};
use crate::effects::rotation_group::conjugate_times::ConjugateTimes;
use crate::effects::rotation_group::conjugate_times_by_attitude::{self, ConjugateTimesByAttitude};
use crate::effects::rotation_group::projected_conjugate_point::{Projected, ProjectedConjugatePoint};
use crate::effects::rotation_group::projected_conjugate_point_by_integration::{
    self, ProjectedConjugatePointByIntegration,
};
use crate::effects::rotation_group::projected_path::ProjectedPath;
use crate::effects::rotation_group::projection::{self, Projection};
use crate::effects::rotation_group::start::{LevelStart, MomentumStart, ReducedStart, allowed, tolerance};
use crate::effects::rotation_group::start_of_conjugate_time::StartOfConjugateTime;
use crate::effects::scene::{Effect, EulerCase, EulerCases, Inertia, ROTATION_GROUP, RotationGroupMetric, Scene};
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points};
use crate::plot::picture::{Cell, Layout, Legend, Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, starts, effects, accuracy.
    pub scene: Scene<RotationGroupMetric, EulerCases>,
    /// Length and points of the curves on SO(3).
    pub picture: Curves,
    /// The reduced extremal.
    pub projection: Reduced,
}

/// How long curves are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// Where they end (time), above 0.
    pub t_end: f64,
    /// Points of each, at least 2.
    pub points: usize,
}

/// The reduced extremal that the article names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reduced {
    /// cos²y at its start, in (0, 1); y = arccos of its root.
    pub cosine_squared: f64,
    /// p_x = G, above 0.
    pub p_x: f64,
    /// p_y at its start, in (0, p_x).
    pub p_y: f64,
    /// The energy level, above 0.
    pub h: f64,
    /// Where the curve drawn ends (time), above 0.
    pub t_end: f64,
    /// Points of the curve drawn, at least 2.
    pub points: usize,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate()?;
        let cases = self.scene.start.cases.len();
        Invalid::unless(cases <= CASES.len(), "scene.start.cases", format!("{cases} starts"), "one to four starts")?;
        self.scene.validate_effects(&OWN, ROTATION_GROUP)?;
        let Reduced { cosine_squared, p_x, p_y, h, t_end, points } = self.projection;
        let positive = |key: &str, value: f64| {
            Invalid::number(value > 0.0 && value.is_finite(), key, value, "a finite number above 0")
        };
        positive("picture.t_end", self.picture.t_end)?;
        Invalid::unless(self.picture.points >= 2, "picture.points", self.picture.points, "at least 2")?;
        let inside = cosine_squared > 0.0 && cosine_squared < 1.0;
        Invalid::number(inside, "projection.cosine_squared", cosine_squared, "a number between 0 and 1")?;
        positive("projection.p_x", p_x)?;
        let accepted = format!("a number between 0 and p_x = {p_x:?}");
        Invalid::number(p_y > 0.0 && p_y < p_x, "projection.p_y", p_y, accepted)?;
        let Inertia { a, b, c } = self.scene.metric.rotation_group;
        // On the level p_y² = (2h − p_x² Z)/(C − Z), between 0 and p_x² when 2h is between p_x² Z and p_x² C.
        let z = a + (b - a) * cosine_squared;
        let (low, high) = (0.5 * p_x * p_x * z, 0.5 * p_x * p_x * c);
        let accepted = format!("between {low:?} (p_y = 0) and {high:?} (p_y = p_x)");
        Invalid::number(low < h && h < high, "projection.h", h, accepted)?;
        positive("projection.t_end", t_end)?;
        Invalid::unless(points >= 2, "projection.points", points, "at least 2")
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 3] = [Effect::Attitude, Effect::ConjugateTimes, Effect::Projection];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig9>();

const PICTURE: Kind = picture_kind(
    "fig9-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/fig9",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig9-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/fig9",
        "table",
    ],
);

const TIMES: &str = "conjugate-times";
const TIMES_CHECK: &str = "conjugate-times-by-attitude";
const NEEDED_START: &str = "start-of-conjugate-time";
const ATTITUDE: &str = "attitude";
const PROJECTION: &str = "projection";
const POINT: &str = "projected-conjugate-point";
const POINT_CHECK: &str = "projected-conjugate-point-by-integration";
const PATH: &str = "projected-path";
/// The axis value of the start on the energy level, and of the reduced extremal as given.
const LEVEL: &str = "level";
const GIVEN: &str = "given";

/// What the article prints about one start.
struct PrintedCase {
    phi: [f64; 3],
    p: [f64; 3],
    /// The first conjugate time, and half a unit of its last digit.
    tau: (f64, f64),
    /// Half a unit of the last digit of Φ2.
    phi2: f64,
    /// Whether the claim is that a start with these digits has this time, or that none has.
    rounding_explains: bool,
}

const ARTICLE_BODY: [f64; 3] = [1.5, 2.0, 2.8];
const ARTICLE_CASES: [PrintedCase; 2] = [
    PrintedCase {
        phi: [0.0, 2.8506, -0.32175],
        p: [0.0, 0.0, 0.3155946],
        tau: (2.421_858_46, 5e-9),
        phi2: 5e-5,
        rounding_explains: false,
    },
    PrintedCase {
        phi: [0.0, 2.327, -0.32175],
        p: [0.55, 0.0, 0.3155946],
        tau: (2.423_529_2, 5e-8),
        phi2: 5e-4,
        rounding_explains: true,
    },
];
/// cos²y, p_x, p_y of the reduced extremal as printed, and its first conjugate time.
const ARTICLE_CURVE: [f64; 3] = [0.1, 1.1, 0.3155946];
fn is_article_body(params: &Params) -> bool {
    let Inertia { a, b, c } = params.scene.metric.rotation_group;
    [a, b, c] == ARTICLE_BODY
}

/// The article's start that a case is, if it is one.
fn printed(params: &Params, case: &EulerCase) -> Option<&'static PrintedCase> {
    let same = |known: &&PrintedCase| known.phi == case.phi && known.p == case.p;
    ARTICLE_CASES.iter().find(same).filter(|_| is_article_body(params))
}

/// `name/case=1` for the first case.
fn of_case(name: &str, index: usize) -> String {
    format!("{name}/case={}", index + 1)
}

struct Fig9;

impl Definition for Fig9 {
    type Params = Params;

    const ID: &'static str = "fig9";
    const TITLE: &'static str = "two extremals on SO(3), their conjugate points and their projection";
    const PLACE: &'static str = "Figure 9";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let scene = &params.scene;
        let asks = |effect| scene.asks_for(effect);
        let (tolerance, allowed) = (tolerance(scene.accuracy), allowed(scene.accuracy));
        let body = scene.metric.rotation_group.into();
        let accuracy = ["tolerance", "allowed"].map(|leaf| (leaf, "scene.accuracy".to_owned()));
        let mut origins = Inertia::origins("rotation-group");
        origins.extend(accuracy);
        let with = |more: &[(&'static str, String)]| [origins.as_slice(), more].concat();
        let conjugate_times = |nodes: &mut Nodes, case: &str, start, key: String| {
            let axis = [("case", case.to_owned())];
            let leaf = if case == LEVEL { "start.level" } else { "start.euler" };
            let first = ConjugateTimes { body, start, tolerance };
            let first = nodes.add(TIMES, &axis, first, &[], &with(&[(leaf, key)]))?;
            let second = ConjugateTimesByAttitude { body, tolerance, allowed };
            let input = [(conjugate_times_by_attitude::INPUT, &first)];
            nodes.add(TIMES_CHECK, &axis, second, &input, &origins)?;
            Ok::<_, NodeError>(first)
        };
        let projected = |nodes: &mut Nodes, case: &str, start, key: String| {
            let axis = [("case", case.to_owned())];
            let leaf = if case == GIVEN { "start.given" } else { "start.from" };
            let first = ProjectedConjugatePoint { body, start };
            let first = nodes.add(POINT, &axis, first, &[], &with(&[(leaf, key)]))?;
            let second = ProjectedConjugatePointByIntegration { body, tolerance, allowed };
            let input = [(projected_conjugate_point_by_integration::INPUT, &first)];
            nodes.add(POINT_CHECK, &axis, second, &input, &origins)?;
            Ok::<_, NodeError>(())
        };
        for (i, case) in scene.start.cases.iter().enumerate() {
            let (name, key) = ((i + 1).to_string(), format!("scene.start.cases[{i}]"));
            let axis = [("case", name.clone())];
            let start = (*case).into();
            let mut times = None;
            if asks(Effect::ConjugateTimes) {
                times = Some(conjugate_times(nodes, &name, MomentumStart::Euler(start), key.clone())?);
                if let Some(known) = printed(params, case) {
                    let node = StartOfConjugateTime { body, start, t1: known.tau.0, tolerance };
                    nodes.add(NEEDED_START, &axis, node, &[], &with(&[("start", key.clone())]))?;
                }
            }
            if asks(Effect::Attitude) {
                let Curves { t_end, points } = params.picture;
                let node =
                    AttitudeTrajectory { body, start, t_end, points, conjugate_times: times.is_some(), tolerance };
                let more = [
                    ("start", key.clone()),
                    ("t_end", "picture.t_end".to_owned()),
                    ("points", "picture.points".to_owned()),
                    ("conjugate_times", "scene.effects".to_owned()),
                ];
                let inputs: Vec<_> = times.iter().map(|table| (attitude::INPUT, table)).collect();
                let table = nodes.add(ATTITUDE, &axis, node, &inputs, &with(&more))?;
                if asks(Effect::Projection) {
                    nodes.add(PROJECTION, &axis, Projection { body }, &[(projection::INPUT, &table)], &origins)?;
                }
            }
            if asks(Effect::Projection) {
                projected(nodes, &name, Projected::From(start), key)?;
            }
        }
        let Reduced { cosine_squared, p_x, p_y, h, t_end, points } = params.projection;
        if asks(Effect::Projection) {
            let start = ReducedStart { cosine_squared, p_x, p_y };
            projected(nodes, GIVEN, Projected::Given(start), "projection".to_owned())?;
            let more = ["start", "t_end", "points"];
            let more = more.map(|leaf| {
                (leaf, if leaf == "start" { "projection".to_owned() } else { format!("projection.{leaf}") })
            });
            nodes.add(
                PATH,
                &[],
                ProjectedPath { body, start: Projected::Given(start), t_end, points },
                &[],
                &with(&more),
            )?;
        }
        if asks(Effect::ConjugateTimes) && asks(Effect::Projection) {
            let level = MomentumStart::Level(LevelStart { cosine_squared, p_x, h });
            conjugate_times(nodes, LEVEL, level, "projection".to_owned())?;
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let asks = |effect| params.scene.asks_for(effect);
        let Inertia { a, b, c } = params.scene.metric.rotation_group;
        let mut caption = format!("Euler-Poinsot problem on SO(3), A = {a}, B = {b}, C = {c} (section 5.3).");
        caption.push_str(&format!(" Starts (Φ1, Φ2, Φ3; p1, p2, p3) = {}.", starts(params)));
        let (mut above, mut below) = (Vec::new(), Vec::new());
        if asks(Effect::Attitude) {
            let trajectories = (0..params.scene.start.cases.len())
                .map(|i| Trajectory::read(tables.get(&of_case(ATTITUDE, i)).map_err(unread)?))
                .collect::<Result<Vec<_>, _>>()?;
            for (i, trajectory) in trajectories.iter().enumerate() {
                above.push(trajectory.against_time().title(format!("case {}", i + 1)));
            }
            let sphere = Panel::sphere(SPHERE_VIEW).title("axis *E*_3 in space");
            above.push(each(&trajectories, sphere, Trajectory::on_sphere));
            below.push(each(&trajectories, plane(&trajectories), Trajectory::in_plane).title("Euler angles"));
            let rows = trajectories.first().map_or(0, |t| t.time.len());
            let letters: Vec<String> = (b'a'..).take(trajectories.len() + 2).map(|l| char::from(l).into()).collect();
            let (cases, rest) = letters.split_at(trajectories.len());
            caption.push_str(&format!(
                " ({}) Euler angles against time, one panel a case, continuous branches. ({}) The third axis of the body on the unit sphere of \
                 space, e3 upwards; thin and light: on the back. ({}) Φ1 and Φ2. Cross: start.{} Attitude integrated as a unit quaternion by \
                 power series to rounding, {rows} points on each curve.",
                cases.join("), ("),
                rest[0],
                rest[1],
                if asks(Effect::ConjugateTimes) { " Disc: first conjugate point; circle: second." } else { "" },
            ));
        }
        if asks(Effect::Projection) {
            below.push(projection_panel(params, tables)?);
            let Reduced { cosine_squared, p_x, p_y, points, .. } = params.projection;
            let t1 = read(tables, &given(POINT), "t1")?;
            let square = "; square: where it is at the first conjugate times τ1 on SO(3), one point to the eye";
            caption.push_str(&format!(
                " Projection: the Serret-Andoyer extremal (9) with p_x = {p_x}, p_y = {p_y}, y = arccos √{cosine_squared} at x = 0, to which \
                 the starts project. Disc: its first conjugate point, t1 = {t1:.7}{}. Closed form, {points} points.",
                if asks(Effect::Attitude) && asks(Effect::ConjugateTimes) { square } else { "" }
            ));
        }
        if asks(Effect::ConjugateTimes) {
            if above.is_empty() && below.is_empty() {
                above.push(times_panel(params, tables)?);
            }
            let times = (0..params.scene.start.cases.len()).map(|i| {
                let (t1, t2) = (read(tables, &of_case(TIMES, i), "t1")?, read(tables, &of_case(TIMES, i), "t2")?);
                Ok(format!("{t1:.8} and {t2:.8} (case {})", i + 1))
            });
            let times = times.collect::<Result<Vec<_>, NodeError>>()?.join(", ");
            caption.push_str(&format!(
                " Conjugate times τ1, τ2: {times}; Jacobi fields in the body frame, eigenphases, relative error 1e-14, checked by the \
                 attitude's own variations."
            ));
        }
        let (height, cells) = cells(above.len(), below.len());
        let mut picture =
            Picture::new(Width::Double, height, "Extremals on SO(3), their conjugate points and their projection")
                .layout(Layout::Cells(cells))
                .caption(caption);
        picture.panels = above.into_iter().chain(below).collect();
        Ok(picture)
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        findings::values(params, tables)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        findings::claims(params, tables)
    }
}

/// Height on paper (mm) and the cells of two rows of panels: equal ones above; below, the wide one first.
fn cells(above: usize, below: usize) -> (f64, Vec<Cell>) {
    let rows = [above, below].into_iter().filter(|panels| *panels > 0).count().max(1);
    let height = 1.0 / rows as f64;
    let row = |top: f64, widths: Vec<f64>| {
        let mut left = 0.0;
        let cell = move |width: f64| {
            let cell = Cell { left, top, width, height };
            left += width;
            cell
        };
        widths.into_iter().map(cell).collect::<Vec<_>>()
    };
    let first = row(0.0, vec![1.0 / above.max(1) as f64; above]);
    let widths = if below == 2 { vec![0.62, 0.38] } else { vec![1.0; below] };
    let second = row(if above > 0 { height } else { 0.0 }, widths);
    (8.0 + 51.0 * rows as f64, [first, second].concat())
}

/// Conjugate times case by case: where no curve is asked for.
fn times_panel(params: &Params, tables: &Tables) -> Result<Panel, NodeError> {
    let cases = params.scene.start.cases.len();
    let ticks = (1..=cases).map(|i| (i as f64, i.to_string()));
    let y = Axis::new("case").fixed(0.5, cases as f64 + 0.5).ticks_at(ticks).reversed();
    let mut panel = Panel::new(Axis::new("conjugate time").unit("time"), y).legend(Legend::Strip);
    for (column, role, words) in [
        ("t1", Role::ConjugatePoint, "first conjugate point"),
        ("t2", Role::SecondConjugatePoint, "second conjugate point"),
    ] {
        let points = (0..cases).map(|i| Ok((read(tables, &of_case(TIMES, i), column)?, (i + 1) as f64)));
        panel = panel.mark(Points::new(role, points.collect::<Result<Vec<_>, NodeError>>()?).legend(words));
    }
    Ok(panel)
}

/// The reduced extremal, its conjugate point, and where it is at the first conjugate times on SO(3).
fn projection_panel(params: &Params, tables: &Tables) -> Result<Panel, NodeError> {
    let path = tables.get(PATH).map_err(unread)?;
    let (x, y) = (path.f64s("x").map_err(unread)?, path.f64s("y").map_err(unread)?);
    let points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let start = points.first().copied().ok_or_else(|| NodeError::new("a path without points"))?;
    let conjugate = (read(tables, &given(POINT), "x")?, read(tables, &given(POINT), "y")?);
    let axis = |name: &str| Axis::new(name).unit("rad").pi_ticks();
    let mut panel = Panel::new(axis("*x*"), axis("*y*"))
        .title("projection")
        .mark(Curve::new(Role::Geodesic, points))
        .mark(Points::new(Role::Start, vec![start]).legend("start"))
        .mark(Points::new(Role::ConjugatePoint, vec![conjugate]).labels(["*t*_1"]).legend("first conjugate point"));
    let mut at_tau = Vec::new();
    for i in 0..params.scene.start.cases.len() {
        let Ok(table) = tables.get(&of_case(PROJECTION, i)) else { continue };
        let rows = table.ints("conjugate").map_err(unread)?;
        if let Some(row) = rows.iter().position(|mark| *mark == 1) {
            at_tau.push((table.f64s("x").map_err(unread)?[row], table.f64s("y").map_err(unread)?[row]));
        }
    }
    if !at_tau.is_empty() {
        panel = panel.mark(Points::new(Role::SwitchPoint, at_tau).legend("first conjugate time on SO(3)"));
    }
    Ok(panel)
}

fn starts(params: &Params) -> String {
    let list = |numbers: &[f64; 3]| numbers.map(|x| x.to_string()).join(", ");
    let case = |case: &EulerCase| format!("({}; {})", list(&case.phi), list(&case.p));
    params.scene.start.cases.iter().map(case).collect::<Vec<_>>().join(", ")
}

fn given(name: &str) -> String {
    format!("{name}/case={GIVEN}")
}

/// The only row of a column.
fn read(tables: &Tables, table: &str, column: &str) -> Result<f64, NodeError> {
    let values = tables.get(table).map_err(unread)?.f64s(column).map_err(unread)?;
    values.first().copied().ok_or_else(|| NodeError::new(format!("{table}: no row")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::claim::Evidence;
    use crate::experiments::preview;
    use crate::plot::render::flaws;

    /// Oracle: mpmath 1.3, 30 digits, starts as decimals: power series of the momentum and three columns in the body frame, root of their
    /// determinant; the closed form for the reduced curve (40 digits).
    #[test]
    fn values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for value in &preview.findings.values {
            println!("{:<36} {:<24?} {:.1e}", value.name, value.value, value.error);
        }
        for (name, exact) in [
            ("tau_case_1", 2.423_789_613_627_669_824_3),
            ("tau2_case_1", 2.824_313_641_879_256_206_9),
            ("tau_case_2", 2.423_798_008_183_302_579_3),
            ("tau2_case_2", 2.824_324_930_011_402_428_5),
            ("tau_level", 2.423_797_407_985_826_684_2),
            ("tau2_level", 2.824_323_853_352_733_180_1),
            ("h_case_1", 1.000_005_718_431_419_138_1),
            ("h_case_2", 0.999_999_253_544_035_826_9),
            ("G_case_1", 1.100_003_425_832_824_479_2),
            ("G_case_2", 1.099_999_634_114_886_001_5),
            ("t1_projected", 5.417_818_601_837_990_759_8),
        ] {
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            // The decimals of the starts are rounded to f64: at most ε/2 of Φ2 = 2.85, times ∂τ/∂Φ2 = 8.1.
            let inputs = 12.0 * f64::EPSILON;
            assert!((found.value - exact).abs() <= found.error + inputs, "{name}: {:?} is not {exact}", found.value);
            assert!(found.error < 2e-14 * exact, "{name}: {}", found.error);
        }
        let mut verdicts: Vec<(&str, bool)> = Vec::new();
        for claim in &preview.findings.claims {
            println!("{claim:?}");
            match &claim.evidence {
                Evidence::Direct(test) => verdicts.push((&claim.id, test.holds())),
                Evidence::Slip { printed, corrected, .. } => {
                    assert!(!printed.holds() && corrected.holds(), "{claim:?}");
                }
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(
            verdicts,
            [
                ("tau_case_1", false),
                ("tau_case_1_not_by_rounding", true),
                ("tau_case_2", false),
                ("tau_case_2_by_rounding", true),
                ("times_differ", false),
                ("times_equal", true),
                ("same_curve", true),
                ("energy_level", true),
                ("t1_projected", false),
                ("routes_agree", true),
            ]
        );
    }

    fn tables(preview: &preview::Preview, names: &[&str]) -> Tables {
        let mut tables = Tables::new();
        for name in names {
            tables.insert(*name, preview.table(name)).unwrap();
        }
        tables
    }

    #[test]
    fn the_picture_has_no_flaws() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        let text = include_str!("../../experiments/fig9.toml");
        let params: Params = crate::contract::config::read("f", text).unwrap();
        let names = [
            "attitude/case=1",
            "attitude/case=2",
            "conjugate-times/case=1",
            "conjugate-times/case=2",
            "projection/case=1",
            "projection/case=2",
            "projected-path",
            "projected-conjugate-point/case=given",
        ];
        let picture = Fig9::picture(&params, &tables(&preview, &names)).unwrap();
        assert_eq!(flaws(&picture).unwrap(), Vec::<String>::new());
    }

    #[test]
    fn an_effect_removed_takes_its_nodes_values_and_claims_with_it() {
        let only = |effects: &'static str| {
            preview::run(&EXPERIMENT, |text| text.replace(r#"["attitude", "conjugate-times", "projection"]"#, effects))
        };
        let attitude = only(r#"["attitude"]"#);
        assert!(attitude.findings.values.is_empty() && attitude.findings.claims.is_empty());
        assert_eq!(attitude.table("attitude/case=2").rows(), 161);
        let times = only(r#"["conjugate-times", "attitude"]"#);
        assert_eq!(times.table("attitude/case=1").rows(), 163);
        assert!(times.findings.values.iter().all(|value| !value.name.contains("projected")));
        let alone = only(r#"["conjugate-times"]"#);
        assert!(alone.findings.claims.iter().any(|claim| claim.id == "times_equal"));
        let projection = only(r#"["projection"]"#);
        assert!(projection.findings.claims.iter().any(|claim| claim.id == "t1_projected"));
        assert!(projection.findings.claims.iter().all(|claim| !claim.id.starts_with("tau")));
    }

    #[test]
    fn other_starts_have_values_and_no_printed_numbers() {
        let other = preview::run(&EXPERIMENT, |text| text.replace("2.8506", "2.6"));
        assert!(other.value("tau_case_1") > 1.0);
        for id in ["tau_case_1", "times_differ"] {
            assert!(other.findings.claims.iter().all(|claim| claim.id != id), "{id}");
        }
        assert!(other.findings.claims.iter().any(|claim| claim.id == "tau_case_2"));
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("A = 1.5", "A = 2.5", "scene.metric.rotation-group.B"),
            ("[0.0, 2.8506, -0.32175]", "[0.0, 0.0, -0.32175]", "scene.start.cases[0].Phi[1]"),
            ("p = [0.55, 0.0, 0.3155946]", "p = [0.0, 0.0, 0.0]", "scene.start.cases[1].p"),
            ("p = [0.55, 0.0,", "p = [0.55, nan,", "scene.start.cases[1].p[1]"),
            ("\"attitude\",", "\"geodesics\",", "scene.effects[0]"),
            ("p_y = 0.3155946", "p_y = 1.2", "projection.p_y"),
            ("h = 1.0", "h = 3.0", "projection.h"),
            ("points = 161\n\n", "points = 1\n\n", "picture.points"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/fig9.toml"), &cases);
    }
}
