//! The first conjugate point of the reduced extremal that an extremal on SO(3) projects to, in closed form.
//!
//! The start is `(x, y, p_x, p_y) = (g, l, G, L)` of section 2.4, or given itself. Only y mod π matters to (9): it is moved to [0, π).
//! Angles in radians, time as in (9).

use super::start::{Body, EulerStart, ReducedStart};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::rotation_group::serret_andoyer_transformation::SerretAndoyerVariables;
use crate::geometry::serret_andoyer::{Extremal, Start, first_conjugate_point};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;
use std::f64::consts::PI;

/// Where a reduced extremal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Projected {
    /// From a point of T*SO(3).
    From(EulerStart),
    /// It is given.
    Given(ReducedStart),
}

/// The first conjugate point of one reduced extremal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ProjectedConjugatePoint {
    /// The body, `A < B < C`.
    pub body: Body,
    /// The extremal.
    pub start: Projected,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-projected-conjugate-point",
    summary: "first conjugate point of the Serret-Andoyer extremal that one on SO(3) projects to, in closed form",
    code: &[
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

/// `y` moved by a multiple of π into [0, π).
pub(super) fn into_half_turn(y: f64) -> f64 {
    y - PI * libm::floor(y / PI)
}

impl Projected {
    /// `[x, y, p_x, p_y]` at the start. Transformed in double-double and rounded once.
    pub(super) fn reduced(&self) -> Result<[f64; 4], NodeError> {
        Ok(self.long_reduced()?.map(Real::to_f64))
    }

    /// The same, not rounded.
    pub(super) fn long_reduced(&self) -> Result<[DoubleDouble; 4], NodeError> {
        let number = DoubleDouble::from;
        match self {
            Self::Given(start) => Ok([number(0.0), start.long_y0(), number(start.p_x), number(start.p_y)]),
            Self::From(start) => {
                let variables = SerretAndoyerVariables::from_euler(&start.point::<DoubleDouble>());
                let [x, y, p_x, p_y] = variables.map_err(failed(&self.to_string()))?.reduced();
                let half_turns = DoubleDouble::PI * Real::floor(y / DoubleDouble::PI);
                Ok([x, y - half_turns, p_x, p_y])
            }
        }
    }
}

impl std::fmt::Display for Projected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Given(start) => start.fmt(f),
            Self::From(start) => write!(f, "Phi = {:?}, p = {:?}", start.phi, start.p),
        }
    }
}

impl Compute for ProjectedConjugatePoint {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, _: &Inputs) -> Result<Product, NodeError> {
        match arithmetic {
            Arithmetic::F64 => self.computed(self.start.reduced()?),
            Arithmetic::DoubleDouble => self.computed(self.start.long_reduced()?),
        }
    }
}

impl ProjectedConjugatePoint {
    fn computed<S: Real>(&self, [x0, y0, p_x, p_y]: [S; 4]) -> Result<Product, NodeError> {
        let metric = self.body.reduced::<S>()?;
        let named = self.start.to_string();
        let extremal = Extremal::new(&metric, Start::Momenta { y0, p_x, p_y }).map_err(failed(&named))?;
        let point = first_conjugate_point(&extremal).map_err(failed(&named))?;
        let number = |x: S| vec![x.to_f64()];
        let table = Table::builder("projected-conjugate-point", "first conjugate point of a reduced extremal")
            .column("x0", "rad", "x at the start", number(x0))
            .column("y0", "rad", "y at the start, in [0, π) where it is projected", number(y0))
            .column("p_x", "momentum", "the constant p_x = G", number(p_x))
            .column("p_y", "momentum", "p_y = L at the start", number(p_y))
            .column("h", "energy", "the Hamiltonian of (9)", number(extremal.energy()))
            .column("t1", "time", "first conjugate time", number(point.t1))
            .column("x", "rad", "x there", number(x0 + point.x))
            .column("y", "rad", "y there", number(point.y))
            .column("t1_error", "1", "estimate of the relative error of t1", number(point.error))
            .build()
            .map_err(failed("projected conjugate point"))?;
        let roots_solved = u64::from(point.iterations > 0);
        product(&table, Work { elliptic_calls: point.elliptic_calls as u64, roots_solved, ..Work::default() })
    }
}
