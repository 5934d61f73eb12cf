//! The panels of a trajectory on SO(3): Euler angles against time and in their plane, the body's third axis on a sphere. Fig. 9, and scenes
//! of the rotation group.

use crate::contract::node::NodeError;
use crate::experiments::findings::unread;
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side, SphereCurve, SpherePoints};
use crate::plot::picture::{Panel, View};
use crate::plot::role::Role;
use crate::table::Table;
use std::f64::consts::PI;

/// Both starts and all conjugate points of the article's cases are in front.
pub const SPHERE_VIEW: View = View::new(-0.95, -0.15);

/// Roles of the cases, in order, and then again from the first.
pub const CASES: [Role; 4] = [Role::SeriesA, Role::SeriesB, Role::SeriesC, Role::SeriesD];

/// The plane of Φ1 and Φ2, without the curves.
pub fn plane(trajectories: &[Trajectory<'_>]) -> Panel {
    let y = Axis::new("*Φ*_2").unit("rad");
    let inside = trajectories.iter().all(|t| t.angles[1].iter().all(|phi2| (0.0..=PI).contains(phi2)));
    let y = if inside { y.fixed(0.0, PI).ticks_at([(0.0, "0"), (0.5 * PI, "π/2"), (PI, "π")]) } else { y.pi_ticks() };
    Panel::new(Axis::new("*Φ*_1").unit("rad").pi_ticks(), y).equal()
}

/// A panel to which every trajectory adds its marks.
pub fn each<'a>(
    trajectories: &'a [Trajectory<'a>],
    panel: Panel,
    add: impl Fn(Panel, &'a Trajectory<'a>, usize) -> Panel,
) -> Panel {
    trajectories.iter().enumerate().fold(panel, |panel, (i, trajectory)| add(panel, trajectory, i))
}

/// An attitude table, unpacked.
pub struct Trajectory<'t> {
    /// Time.
    pub time: &'t [f64],
    /// 1 and 2 at the first and second conjugate time, else 0.
    pub conjugate: &'t [i64],
    /// Φ1, Φ2, Φ3.
    pub angles: [&'t [f64]; 3],
    /// The third axis of the body, in space.
    pub axis: [&'t [f64]; 3],
}

impl<'t> Trajectory<'t> {
    /// Unpacks a table of kind `rotation-group-attitude`.
    ///
    /// # Errors
    /// A table of another form.
    pub fn read(table: &'t Table) -> Result<Self, NodeError> {
        let column = |name: &str| table.f64s(name).map_err(unread);
        Ok(Self {
            time: column("t")?,
            conjugate: table.ints("conjugate").map_err(unread)?,
            angles: [column("Phi1")?, column("Phi2")?, column("Phi3")?],
            axis: [column("E3_1")?, column("E3_2")?, column("E3_3")?],
        })
    }

    /// The row of the first (1) or second (2) conjugate time, if the curve reaches it.
    fn row(&self, conjugate: i64) -> Option<usize> {
        self.conjugate.iter().position(|mark| *mark == conjugate)
    }

    /// Start and conjugate points of a curve: the role, the row and the words of the legend.
    fn marks(&self) -> Vec<(Role, usize, &'static str)> {
        let found = [
            (Role::ConjugatePoint, 1, "first conjugate point"),
            (Role::SecondConjugatePoint, 2, "second conjugate point"),
        ];
        let found = found.into_iter().filter_map(|(role, mark, words)| Some((role, self.row(mark)?, words)));
        std::iter::once((Role::Start, 0, "start")).chain(found).collect()
    }

    /// The Euler angles against time.
    pub fn against_time(&self) -> Panel {
        let all = || self.angles.iter().flat_map(|angles| angles.iter().copied());
        let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        // Room above the curves for the names of the conjugate times.
        let (below, above) = (0.05 * (high - low), 0.14 * (high - low));
        let y = Axis::new("Euler angles").unit("rad").pi_ticks().fixed(low - below, high + above);
        let mut panel = Panel::new(Axis::new("*t*").unit("time"), y);
        for (mark, name) in [(1, "*τ*_1"), (2, "*τ*_2")] {
            if let Some(row) = self.row(mark) {
                let label = DirectLabel::new(name).at(At::End).side(Side::Right);
                panel = panel.mark(RuleLine::vertical(Role::Reference, self.time[row]).label(label));
            }
        }
        for (j, role) in [Role::Theta, Role::Phi, Role::Psi].into_iter().enumerate() {
            let points: Vec<(f64, f64)> = self.time.iter().copied().zip(self.angles[j].iter().copied()).collect();
            for (role, row, words) in self.marks() {
                panel = panel.mark(Points::new(role, vec![points[row]]).legend(words));
            }
            let label = DirectLabel::new(format!("*Φ*_{}", j + 1)).at(At::Fraction(0.36));
            panel = panel.mark(Curve::new(role, points).label(label));
        }
        panel
    }

    /// Adds Φ1 and Φ2 as a curve.
    pub fn in_plane(panel: Panel, trajectory: &Self, case: usize) -> Panel {
        let [phi1, phi2, _] = trajectory.angles;
        let points: Vec<(f64, f64)> = phi1.iter().copied().zip(phi2.iter().copied()).collect();
        let panel = trajectory
            .marks()
            .into_iter()
            .fold(panel, |panel, (role, row, words)| panel.mark(Points::new(role, vec![points[row]]).legend(words)));
        panel.mark(Curve::new(CASES[case % CASES.len()], points).label(format!("case {}", case + 1)))
    }

    /// Adds the third axis of the body on the unit sphere of space.
    pub fn on_sphere(panel: Panel, trajectory: &Self, case: usize) -> Panel {
        let [x, y, z] = trajectory.axis;
        let points: Vec<[f64; 3]> = (0..trajectory.time.len()).map(|i| [x[i], y[i], z[i]]).collect();
        let panel = trajectory.marks().into_iter().fold(panel, |panel, (role, row, words)| {
            panel.mark(SpherePoints::new(role, vec![points[row]]).legend(words))
        });
        panel.mark(SphereCurve::new(CASES[case % CASES.len()], points).label(format!("case {}", case + 1)))
    }
}
