//! Scenes of the rotation group (sections 2 and 5.3): single extremals on SO(3), one case a start. Angles in radians, time as in (2).
//!
//! As in Fig. 9: Euler angles against time, the body's third axis on the sphere of space, Φ1 and Φ2; the reduced extremals that the cases
//! project to, with their first conjugate points.

use super::attitude::{CASES, SPHERE_VIEW, Trajectory, each, plane};
use super::findings::{SecondRoute, agreement, counts, differences};
use super::page::Block;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::effects::rotation_group::attitude::{self, AttitudeTrajectory};
use crate::effects::rotation_group::conjugate_times::ConjugateTimes;
use crate::effects::rotation_group::conjugate_times_by_attitude::{self, ConjugateTimesByAttitude};
use crate::effects::rotation_group::projected_conjugate_point::{Projected, ProjectedConjugatePoint};
use crate::effects::rotation_group::projected_conjugate_point_by_integration::{
    self, ProjectedConjugatePointByIntegration,
};
use crate::effects::rotation_group::projected_path::ProjectedPath;
use crate::effects::rotation_group::start::{MomentumStart, allowed, tolerance};
use crate::effects::scene::{Effect, EulerCase, Inertia};
use crate::experiments::findings::{unread, value};
use crate::experiments::nodes::Nodes;
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points};
use crate::plot::picture::Panel;
use crate::plot::role::Role;
use crate::table::Tables;

/// Where curves end (time), and their points, where a scene does not say: as in Fig. 9.
pub const DEFAULT_CURVES: (f64, usize) = (3.2, 161);
/// How much longer than a case's curves its projection is: its conjugate point comes later.
const PROJECTION_END: f64 = 2.0;
/// Most cases of one picture.
pub const MOST_CASES: usize = 4;

const TIMES: &str = "conjugate-times";
const TIMES_CHECK: &str = "conjugate-times-by-attitude";
const ATTITUDE: &str = "attitude";
const POINT: &str = "projected-conjugate-point";
const POINT_CHECK: &str = "projected-conjugate-point-by-integration";
const PATH: &str = "projected-path";
const ROUTES: [(Effect, SecondRoute); 3] = [
    (
        Effect::ConjugateTimes,
        SecondRoute {
            node: TIMES_CHECK,
            difference: "t1_difference",
            what: "first conjugate times on SO(3) (relative)",
        },
    ),
    (
        Effect::ConjugateTimes,
        SecondRoute {
            node: TIMES_CHECK,
            difference: "t2_difference",
            what: "second conjugate times on SO(3) (relative)",
        },
    ),
    (
        Effect::Projection,
        SecondRoute {
            node: POINT_CHECK,
            difference: "t1_difference",
            what: "conjugate times of the projections (relative)",
        },
    ),
];

/// What a scene of the rotation group asks for.
#[derive(Clone, Debug)]
pub struct RotationGroup {
    /// Which effects.
    pub effects: Vec<Effect>,
    /// The body.
    pub inertia: Inertia,
    /// The starts.
    pub cases: Vec<EulerCase>,
    /// Where curves end (time), and their points.
    pub curves: (f64, usize),
    /// The accuracy of integrations.
    pub accuracy: Accuracy,
}

fn of_case(node: &str, index: usize) -> String {
    format!("{node}/case={}", index + 1)
}

fn only(tables: &Tables, table: &str, column: &str) -> Result<f64, NodeError> {
    let values = tables.get(table).map_err(unread)?.f64s(column).map_err(unread)?;
    values.first().copied().ok_or_else(|| NodeError::new(format!("{table}: no row")))
}

impl RotationGroup {
    fn asks(&self, effect: Effect) -> bool {
        self.effects.contains(&effect)
    }

    /// Asks for the nodes.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn nodes(&self, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(self.accuracy);
        let (tolerance, allowed) = (tolerance(self.accuracy), allowed(self.accuracy));
        let body = self.inertia.into();
        let mut origins = Inertia::origins("rotation-group");
        origins.extend(["tolerance", "allowed"].map(|leaf| (leaf, "scene.accuracy".to_owned())));
        for (i, case) in self.cases.iter().enumerate() {
            let axis = [("case", (i + 1).to_string())];
            let key = |leaf: &'static str| (leaf, format!("scene.start.cases[{i}]"));
            let with = |more: &[(&'static str, String)]| [origins.as_slice(), more].concat();
            let start = (*case).into();
            let mut times = None;
            if self.asks(Effect::ConjugateTimes) {
                let first = ConjugateTimes { body, start: MomentumStart::Euler(start), tolerance };
                let first = nodes.add(TIMES, &axis, first, &[], &with(&[key("start.euler")]))?;
                let second = ConjugateTimesByAttitude { body, tolerance, allowed };
                nodes.add(TIMES_CHECK, &axis, second, &[(conjugate_times_by_attitude::INPUT, &first)], &origins)?;
                times = Some(first);
            }
            let (t_end, points) = self.curves;
            let ends = [("t_end", "picture.t_end".to_owned()), ("points", "picture.points".to_owned())];
            if self.asks(Effect::Attitude) {
                let curve =
                    AttitudeTrajectory { body, start, t_end, points, conjugate_times: times.is_some(), tolerance };
                let inputs: Vec<_> = times.iter().map(|table| (attitude::INPUT, table)).collect();
                let more = [ends.as_slice(), &[key("start"), ("conjugate_times", "scene.effects".to_owned())]].concat();
                nodes.add(ATTITUDE, &axis, curve, &inputs, &with(&more))?;
            }
            if self.asks(Effect::Projection) {
                let start = Projected::From(start);
                let first = ProjectedConjugatePoint { body, start };
                let first = nodes.add(POINT, &axis, first, &[], &with(&[key("start.from")]))?;
                let second = ProjectedConjugatePointByIntegration { body, tolerance, allowed };
                let input = [(projected_conjugate_point_by_integration::INPUT, &first)];
                nodes.add(POINT_CHECK, &axis, second, &input, &origins)?;
                let path = ProjectedPath { body, start, t_end: PROJECTION_END * t_end, points };
                let more = [ends.as_slice(), &[key("start.from")]].concat();
                nodes.add(PATH, &axis, path, &[], &with(&more))?;
            }
        }
        Ok(())
    }

    /// Euler angles against time, one panel a case; below, sphere, plane and projection.
    ///
    /// # Errors
    /// A table that is missing or of another form.
    pub fn blocks(&self, tables: &Tables) -> Result<Vec<Block>, NodeError> {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        if self.asks(Effect::Attitude) {
            let trajectories = (0..self.cases.len())
                .map(|i| Trajectory::read(tables.get(&of_case(ATTITUDE, i)).map_err(unread)?))
                .collect::<Result<Vec<_>, _>>()?;
            for (i, trajectory) in trajectories.iter().enumerate() {
                above.push(trajectory.against_time().title(format!("case {}", i + 1)));
            }
            let sphere = Panel::sphere(SPHERE_VIEW).title("axis *E*_3 in space");
            below.push(each(&trajectories, sphere, Trajectory::on_sphere));
            below.push(each(&trajectories, plane(&trajectories), Trajectory::in_plane).title("Euler angles"));
        } else if self.asks(Effect::ConjugateTimes) {
            above.push(self.times_panel(tables)?);
        }
        if self.asks(Effect::Projection) {
            below.push(self.projection_panel(tables)?);
        }
        let columns = above.len().clamp(1, 2);
        let across = below.len().clamp(1, 3);
        Ok(vec![Block { panels: above, columns, row_mm: 58.0 }, Block { panels: below, columns: across, row_mm: 64.0 }])
    }

    /// Conjugate times case by case: where no curve is asked for.
    fn times_panel(&self, tables: &Tables) -> Result<Panel, NodeError> {
        let cases = self.cases.len();
        let ticks = (1..=cases).map(|i| (i as f64, i.to_string()));
        let y = Axis::new("case").fixed(0.5, cases as f64 + 0.5).ticks_at(ticks).reversed();
        let mut panel = Panel::new(Axis::new("conjugate time").unit("time"), y);
        for (column, role, words) in [
            ("t1", Role::ConjugatePoint, "first conjugate point"),
            ("t2", Role::SecondConjugatePoint, "second conjugate point"),
        ] {
            let points = (0..cases).map(|i| Ok((only(tables, &of_case(TIMES, i), column)?, (i + 1) as f64)));
            panel = panel.mark(Points::new(role, points.collect::<Result<Vec<_>, NodeError>>()?).legend(words));
        }
        Ok(panel)
    }

    /// The reduced extremals with their first conjugate points.
    fn projection_panel(&self, tables: &Tables) -> Result<Panel, NodeError> {
        let axis = |name: &str| Axis::new(name).unit("rad").pi_ticks();
        let mut panel = Panel::new(axis("*x*"), axis("*y*")).title("projection");
        for i in 0..self.cases.len() {
            let path = tables.get(&of_case(PATH, i)).map_err(unread)?;
            let (x, y) = (path.f64s("x").map_err(unread)?, path.f64s("y").map_err(unread)?);
            let points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
            let start = points.first().copied().ok_or_else(|| NodeError::new("a path without points"))?;
            let point = of_case(POINT, i);
            let conjugate = (only(tables, &point, "x")?, only(tables, &point, "y")?);
            panel = panel
                .mark(Curve::new(CASES[i % CASES.len()], points).legend(format!("case {}", i + 1)))
                .mark(Points::new(Role::Start, vec![start]).legend("start"))
                .mark(Points::new(Role::ConjugatePoint, vec![conjugate]).legend("first conjugate point"));
        }
        Ok(panel)
    }

    /// What is drawn.
    pub fn caption(&self) -> String {
        let Inertia { a, b, c } = self.inertia;
        let list = |numbers: &[f64; 3]| numbers.map(|x| x.to_string()).join(", ");
        let starts: Vec<String> =
            self.cases.iter().map(|case| format!("({}; {})", list(&case.phi), list(&case.p))).collect();
        let mut text = format!(
            "Euler-Poinsot problem on SO(3), A = {a}, B = {b}, C = {c}. Starts (Φ1, Φ2, Φ3; p1, p2, p3) = {}.",
            starts.join(", ")
        );
        let (_, points) = self.curves;
        if self.asks(Effect::Attitude) {
            text += &format!(
                " Euler angles against time, one panel a case, continuous branches; the third axis of the body on the unit sphere of space, e3 \
                 upwards, thin and light on the back; Φ1 and Φ2. Attitude integrated as a unit quaternion, {points} points on each curve."
            );
        }
        if self.asks(Effect::ConjugateTimes) {
            text += " Conjugate times on SO(3): momentum and Jacobi fields in the body frame, eigenphases; disc: first, circle: second.";
        }
        if self.asks(Effect::Projection) {
            text += &format!(
                " Projection: the reduced extremals of (9) in Serret-Andoyer variables (section 2.4), closed form, {points} points each, with \
                 their first conjugate points."
            );
        }
        text
    }

    /// Numbers of points, conjugate times, and the largest difference of each pair of routes.
    ///
    /// # Errors
    /// A table of another form.
    pub fn values(&self, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let nodes = [(Effect::Attitude, ATTITUDE), (Effect::Projection, PATH)];
        let asked: Vec<&str> = nodes.iter().filter(|(effect, _)| self.asks(*effect)).map(|(_, node)| *node).collect();
        let mut values = counts(tables, &asked);
        let mut time = |node: &str, column: &str, error: &str, name: String, meaning: String| {
            let time = only(tables, node, column)?;
            let error = only(tables, node, error)? * time;
            let route = "first route; see the second one's table for the difference";
            values.push(value(name, (time, error), "time", meaning, route));
            Ok::<_, NodeError>(())
        };
        for i in 0..self.cases.len() {
            let case = i + 1;
            if self.asks(Effect::ConjugateTimes) {
                for (column, which) in [("t1", "first"), ("t2", "second")] {
                    let meaning = format!("{which} conjugate time on SO(3) of case {case}");
                    time(&of_case(TIMES, i), column, "error", format!("{column}_case_{case}"), meaning)?;
                }
            }
            if self.asks(Effect::Projection) {
                let meaning = format!("first conjugate time of the reduced extremal of case {case}");
                time(&of_case(POINT, i), "t1", "t1_error", format!("t1_projected_case_{case}"), meaning)?;
            }
        }
        // One value a table: that of first conjugate times stands for both.
        let first: Vec<SecondRoute> =
            self.routes().into_iter().filter(|route| route.difference == "t1_difference").collect();
        values.extend(differences(tables, &first)?);
        Ok(values)
    }

    fn routes(&self) -> Vec<SecondRoute> {
        ROUTES.into_iter().filter(|(effect, _)| self.asks(*effect)).map(|(_, route)| route).collect()
    }

    /// That the routes agree.
    ///
    /// # Errors
    /// A table of another form.
    pub fn claims(&self, tables: &Tables, id: &str) -> Result<Vec<Claim>, NodeError> {
        Ok(agreement(tables, &self.routes(), id)?.into_iter().collect())
    }
}
