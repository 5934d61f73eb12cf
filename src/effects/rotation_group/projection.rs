//! What an extremal on SO(3) projects to: its Serret-Andoyer variables (section 2.4), beside the reduced extremal in closed form.
//!
//! Each row of an attitude table is transformed by section 2.4; the reduced extremal of (9) with the start's `(x, y, p_x, p_y)` is computed by
//! elliptic functions. That they are the same curve, and that the inverse transformation leads back, is measured row by row.
//! Angles in radians, time as in (9), which is that of (2).

use super::projected_conjugate_point::into_half_turn;
use super::start::Body;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::serret_andoyer_transformation::SerretAndoyerVariables;
use crate::geometry::serret_andoyer::{Extremal, Start};
use crate::table::Table;
use serde::Serialize;
use std::f64::consts::PI;

/// The input: an attitude table.
pub const INPUT: &str = "attitude";
/// Elliptic functions and integrals of one position: Jacobi, F and the third kind.
const ELLIPTIC_CALLS: u64 = 3;

/// The projection of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Projection {
    /// The body, `A < B < C`.
    pub body: Body,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-projection",
    summary: "Serret-Andoyer variables along an extremal on SO(3), beside the reduced extremal in closed form",
    code: &[
        "effects/rotation_group/projection.rs",
        "effects/rotation_group/projected_conjugate_point.rs",
        "effects/rotation_group/start.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/rotation_group",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// The distance of two angles on the circle.
fn apart(a: f64, b: f64) -> f64 {
    let turns = (a - b) / (2.0 * PI);
    2.0 * PI * (turns - libm::round(turns)).abs()
}

/// How far l of the closed form is from `Φ3 − arctan`, the arctangent a function of K, L, cos Φ2 and p2 sin Φ2.
fn off(point: &EulerPoint<f64>, l: f64, arctangent: impl Fn(f64, f64, f64, f64) -> f64) -> f64 {
    let (sine, cosine) = libm::sincos(point.angles[1]);
    let [p1, p2, p3] = point.momenta;
    apart(l, point.angles[2] - arctangent(p1, p3, cosine, p2 * sine))
}

/// The largest difference of a point and its image under the transformation and its inverse.
fn round_trip(point: &EulerPoint<f64>, variables: &SerretAndoyerVariables<f64>) -> Result<f64, NodeError> {
    let back = variables.to_euler().map_err(failed("inverse transformation"))?;
    let angles = point.angles.iter().zip(back.angles).map(|(a, b)| apart(*a, b));
    let momenta = point.momenta.iter().zip(back.momenta).map(|(a, b)| (a - b).abs());
    Ok(angles.chain(momenta).fold(0.0, f64::max))
}

impl Compute for Projection {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let attitude = input_table(inputs, INPUT)?;
        let read = |name: &str| attitude.f64s(name).map_err(failed("projection"));
        let (t, angles) = (read("t")?, [read("Phi1")?, read("Phi2")?, read("Phi3")?]);
        let momenta = [read("M1")?, read("M2")?, read("M3")?];
        let conjugate = attitude.ints("conjugate").map_err(failed("projection"))?;
        let at = |i: usize| -> Result<(EulerPoint<f64>, SerretAndoyerVariables<f64>), NodeError> {
            let row = format!("t = {:?}", t[i]);
            let point = EulerPoint::from_body_momentum(angles.map(|a| a[i]), momenta.map(|m| m[i]));
            let point = point.map_err(failed(&row))?;
            Ok((point, SerretAndoyerVariables::from_euler(&point).map_err(failed(&row))?))
        };
        let start = at(0)?.1;
        let [x0, y0, p_x, p_y] = start.reduced();
        let extremal = Extremal::new(&self.body.reduced()?, Start::Momenta { y0, p_x, p_y });
        let path = extremal.map_err(failed("reduced extremal"))?.path();
        let shift = into_half_turn(y0) - y0;
        let mut columns: [Vec<f64>; 11] = Default::default();
        for (i, &time) in t.iter().enumerate() {
            let (point, variables) = at(i)?;
            let [x, y, big_g, p_y] = variables.reduced();
            let reduced = path.position(time - t[0]);
            let row = [
                x0 + reduced.x,
                reduced.y + shift,
                reduced.p_y,
                apart(x0 + reduced.x, x).max(apart(reduced.y, y)),
                (reduced.p_y - p_y).abs().max((big_g - p_x).abs()),
                apart(variables.k, start.k).max((variables.momentum_k - start.momentum_k).abs()),
                round_trip(&point, &variables)?,
                off(&point, reduced.y, |k, l, cosine, below| libm::atan2(k - l * cosine, below)),
                off(&point, reduced.y, |k, l, cosine, below| libm::atan((k - l * cosine) / below)),
                off(&point, reduced.y, |k, l, cosine, below| libm::atan2(l - k * cosine, below)),
                off(&point, reduced.y, |k, l, cosine, below| libm::atan2(l * cosine - k, below)),
            ];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
        let [x, y, p_y, angle_difference, momentum_difference, constants_difference, round_trip, forms @ ..] = columns;
        let [quadrant, principal, exchanged, opposite] = forms;
        let rows = t.len() as u64;
        let table = Table::builder("projection", "an extremal on SO(3) in Serret-Andoyer variables")
            .column("t", "time", "time", t)
            .column(
                "conjugate",
                "1",
                "1 and 2 at the first and second conjugate time on SO(3), else 0",
                conjugate.to_vec(),
            )
            .column("x", "rad", "x = g of the reduced extremal, in closed form", x)
            .column("y", "rad", "y = l of the reduced extremal, from [0, π) on", y)
            .column("p_y", "momentum", "p_y = L of the reduced extremal", p_y)
            .column("angle_difference", "rad", "difference of g and l transformed from the attitude", angle_difference)
            .column(
                "momentum_difference",
                "momentum",
                "difference of G and L transformed from the attitude",
                momentum_difference,
            )
            .column(
                "constants_difference",
                "rad",
                "change since the start of k and K, which are constant",
                constants_difference,
            )
            .column(
                "round_trip",
                "rad",
                "difference of angles and momenta after transformation and inverse",
                round_trip,
            )
            .column(
                "principal_value_difference",
                "rad",
                "difference of l to the printed arctangent's principal value",
                principal,
            )
            .column("quadrant_difference", "rad", "difference of l to that arctangent in its quadrant", quadrant)
            .column("exchanged_difference", "rad", "difference of l to the same with K and L exchanged", exchanged)
            .column("opposite_difference", "rad", "difference of l to the same with L cos Φ2 − K above", opposite)
            .build()
            .map_err(failed("projection"))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * rows, dense_points: rows, ..Work::default() })
    }
}
