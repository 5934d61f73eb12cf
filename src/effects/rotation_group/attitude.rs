//! The attitude along one extremal on SO(3): Euler angles with continuous branches, the unit quaternion, the axis E3 in space, the momentum
//! in the body, at equal steps of time and, when its input is there, at the conjugate times.
//!
//! Integrated as a quaternion under a momentum constant in space; Euler angles are read off at the end. Angles in radians, time as in (2).

use super::start::{Body, EulerStart};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::effects::arithmetic::{in_arithmetic, of_tolerance};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::rotation_group::attitude_trajectory::{attitude_at, euler_angles_at};
use crate::geometry::rotation_group::euler_angles::rotation_matrix;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// The input: a table of conjugate times, when `conjugate_times` is set.
pub const INPUT: &str = "conjugate-times";

/// One trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AttitudeTrajectory {
    /// The body.
    pub body: Body,
    /// Angles and momenta at the start.
    pub start: EulerStart,
    /// Where it ends (time).
    pub t_end: f64,
    /// Points at equal steps of time, both ends included.
    pub points: usize,
    /// Whether the conjugate times before its end are added.
    pub conjugate_times: bool,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-attitude",
    summary: "Euler angles, quaternion and body momentum along one extremal on SO(3)",
    code: &[
        "effects/rotation_group/attitude.rs",
        "effects/rotation_group/start.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/rotation_group",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl AttitudeTrajectory {
    /// The times, each with 0, or 1 and 2 for the first and second conjugate time.
    fn times(&self, inputs: &Inputs) -> Result<Vec<(f64, i64)>, NodeError> {
        let last = self.points.saturating_sub(1).max(1) as f64;
        let mut times: Vec<(f64, i64)> = (0..self.points).map(|i| (self.t_end * (i as f64 / last), 0)).collect();
        if self.conjugate_times {
            let table = input_table(inputs, INPUT)?;
            for (mark, name) in [(1, "t1"), (2, "t2")] {
                let found = table.f64s(name).map_err(failed("conjugate times"))?;
                times.extend(found.iter().filter(|t| **t <= self.t_end).map(|t| (*t, mark)));
            }
            times.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        Ok(times)
    }
}

impl Compute for AttitudeTrajectory {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        in_arithmetic!(of_tolerance(self.tolerance), S => self.computed::<S>(inputs))
    }
}

impl AttitudeTrajectory {
    fn computed<S: Real>(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let named = || format!("Phi = {:?}, p = {:?}", self.start.phi, self.start.p);
        let metric = self.body.metric::<S>()?;
        let marked = self.times(inputs)?;
        let times: Vec<f64> = marked.iter().map(|(t, _)| *t).collect();
        let instants: Vec<S> = times.iter().map(|t| S::from_f64(*t)).collect();
        let point = self.start.point::<S>();
        let momentum = point.body_momentum().map_err(failed(&named()))?;
        let (angles, on_angles) =
            euler_angles_at(&metric, &point, &instants, self.tolerance).map_err(failed(&named()))?;
        let (states, on_states) =
            attitude_at(&metric, point.attitude(), momentum, &instants, self.tolerance).map_err(failed(&named()))?;
        // E3 in space is the third column of R, which takes components in the body to components in space.
        let axis: Vec<[S; 3]> = states.iter().map(|s| rotation_matrix(&s.quaternion).map(|row| row[2])).collect();
        let angle = |i: usize| angles.iter().map(|a| a[i].to_f64()).collect::<Vec<_>>();
        let quaternion = |i: usize| states.iter().map(|s| s.quaternion[i].to_f64()).collect::<Vec<_>>();
        let body_momentum = |i: usize| states.iter().map(|s| s.body_momentum[i].to_f64()).collect::<Vec<_>>();
        let axis = |i: usize| axis.iter().map(|a| a[i].to_f64()).collect::<Vec<_>>();
        let mut table = Table::builder("attitude", "one extremal on SO(3)")
            .column("t", "time", "time", times)
            .column(
                "conjugate",
                "1",
                "1 and 2 at the first and second conjugate time, else 0",
                marked.iter().map(|(_, mark)| *mark).collect::<Vec<_>>(),
            )
            .column("Phi1", "rad", "Φ1, continuous", angle(0))
            .column("Phi2", "rad", "Φ2", angle(1))
            .column("Phi3", "rad", "Φ3, continuous", angle(2));
        for (i, name) in ["q_w", "q_x", "q_y", "q_z"].into_iter().enumerate() {
            table = table.column(name, "1", "component of the unit quaternion of the attitude", quaternion(i));
        }
        for (i, name) in ["E3_1", "E3_2", "E3_3"].into_iter().enumerate() {
            table = table.column(name, "1", "component in space of the third axis of the body", axis(i));
        }
        for (i, name) in ["M1", "M2", "M3"].into_iter().enumerate() {
            table = table.column(name, "momentum", "component in the body of the angular momentum", body_momentum(i));
        }
        let table = table.build().map_err(failed("attitude"))?;
        product(&table, integrated(on_angles) + integrated(on_states))
    }
}
