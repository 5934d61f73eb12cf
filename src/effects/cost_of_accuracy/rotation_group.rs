//! The left-invariant metric on SO(3): momenta of length 1, spread evenly; Euler's equations in the body with two Jacobi columns.
//!
//! There is no closed form here; the second route integrates the attitude, whose equations are others.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_accuracy::problem::{Found, Problem, no_such_route};
use crate::effects::cost_of_accuracy::route::Route;
use crate::effects::product::failed;
use crate::effects::rotation_group::directions::spread_evenly;
use crate::effects::rotation_group::start::Body;
use crate::geometry::rotation_group::attitude_route::first_conjugate_times_by_attitude;
use crate::geometry::rotation_group::conjugate::{ConjugateError, first_conjugate_times_by_method};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::Method;
use serde::Serialize;

/// The left-invariant metric with its starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotationGroup {
    /// The body.
    pub body: Body,
    /// Number of directions.
    pub directions: usize,
}

const COUNTED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/counted.rs",
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/rotation_group.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/rotation_group/directions.rs",
    "effects/arithmetic.rs",
    "effects/rotation_group/start.rs",
    "geometry/rotation_group",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];
const TIMED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/rotation_group.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/cost_of_accuracy/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/rotation_group/directions.rs",
    "effects/arithmetic.rs",
    "effects/rotation_group/start.rs",
    "geometry/rotation_group",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];

const ROUTES: &[Route] = &[Route::Taylor, Route::TaylorDoubleDouble, Route::Dop853, Route::Verner98];

impl Problem for RotationGroup {
    /// The momentum in the body.
    type Start = [f64; 3];
    const COUNTED_ROUTES: &'static [Route] = ROUTES;
    const TIMED_ROUTES: &'static [Route] = ROUTES;
    const COUNTED: &'static Kind = &Kind {
        name: "rotation-group-cost-of-accuracy",
        summary: "achieved error and counted work of conjugate times on SO(3), by method and request",
        code: COUNTED_CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "rotation-group-time-of-accuracy",
        summary: "time of conjugate times on SO(3) on this machine, by method and request",
        code: TIMED_CODE,
        measurement: true,
    };

    fn starts(&self) -> Result<Vec<[f64; 3]>, NodeError> {
        Ok(spread_evenly(self.directions).collect())
    }

    fn integrated<M: Method, S: Real>(
        &self,
        method: M,
        start: &[f64; 3],
        asked: f64,
        _: f64,
    ) -> Result<Found<S>, NodeError> {
        match first_conjugate_times_by_method(method, &self.body.metric()?, start.map(S::from_f64), 1, asked) {
            Ok(found) => Ok(Found { time: found.times.first().copied(), work: found.work }),
            Err(ConjugateError::Fewer { .. } | ConjugateError::Integration(_)) => Ok(Found::nothing()),
            Err(error) => Err(failed(&format!("{start:?}"))(error)),
        }
    }

    fn second_route(&self, start: &[f64; 3]) -> Result<DoubleDouble, NodeError> {
        let (momentum, asked) = (start.map(DoubleDouble::from_f64), DoubleDouble::EPSILON.to_f64());
        let found = first_conjugate_times_by_attitude(&self.body.metric()?, momentum, 1, asked);
        let found = found.map_err(failed(&format!("{start:?}")))?;
        found.times.first().copied().ok_or_else(|| no_such_route(Route::TaylorDoubleDouble, start))
    }

    fn together(&self, route: Route, starts: &[[f64; 3]], _: f64) -> Result<Vec<Option<f64>>, NodeError> {
        Err(no_such_route(route, &starts.first()))
    }
}
