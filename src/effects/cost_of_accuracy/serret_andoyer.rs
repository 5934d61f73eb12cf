//! The Serret-Andoyer flow (9): ascending, oscillating extremals of one start; the flow, and the closed form from equation (15).

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_accuracy::problem::{Found, Problem, no_such_route};
use crate::effects::cost_of_accuracy::route::Route;
use crate::effects::product::failed;
use crate::effects::serret_andoyer::body::Body;
use crate::geometry::serret_andoyer::conjugate::first_conjugate_time;
use crate::geometry::serret_andoyer::flow::{FlowError, first_conjugate_time_by_method};
use crate::geometry::serret_andoyer::flow_lanes::{FlowStart, first_conjugate_times_by_integration};
use crate::geometry::serret_andoyer::lanes::first_conjugate_times;
use crate::geometry::serret_andoyer::{Extremal, Start};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::Method;
use serde::Serialize;

/// Later than every conjugate time that is asked for here.
const T_MAX: f64 = 1e6;

/// The Serret-Andoyer flow with its starts: ascending extremals from `(0, y0)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SerretAndoyer {
    /// The body.
    pub body: Body,
    /// The angle y at the start.
    pub y0: f64,
    /// `ξ1` of the extremals, between cos² y0 and 1.
    pub xi1: Vec<f64>,
}

const COUNTED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/counted.rs",
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/cost_of_accuracy/serret_andoyer.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/serret_andoyer/body.rs",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];
const TIMED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/cost_of_accuracy/serret_andoyer.rs",
    "effects/cost_of_accuracy/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/serret_andoyer/body.rs",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];

impl Problem for SerretAndoyer {
    /// `[y0, p_x, p_y]`.
    type Start = [f64; 3];
    const COUNTED_ROUTES: &'static [Route] =
        &[Route::ClosedForm, Route::Taylor, Route::TaylorDoubleDouble, Route::Dop853, Route::Verner98];
    const TIMED_ROUTES: &'static [Route] = &[
        Route::ClosedForm,
        Route::ClosedFormLanes,
        Route::Taylor,
        Route::TaylorLanes,
        Route::TaylorDoubleDouble,
        Route::Dop853,
        Route::Verner98,
    ];
    const COUNTED: &'static Kind = &Kind {
        name: "serret-andoyer-cost-of-accuracy",
        summary: "achieved error and counted work of the Serret-Andoyer conjugate times, by method and request",
        code: COUNTED_CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "serret-andoyer-time-of-accuracy",
        summary: "time of the Serret-Andoyer conjugate times on this machine, by method and request",
        code: TIMED_CODE,
        measurement: true,
    };

    fn starts(&self) -> Result<Vec<[f64; 3]>, NodeError> {
        let one = |xi1: &f64| {
            let [p_x, p_y] = self.body.ascending_momenta(self.y0, *xi1);
            [self.y0, p_x, p_y]
        };
        Ok(self.xi1.iter().map(one).collect())
    }

    fn integrated<M: Method, S: Real>(
        &self,
        method: M,
        start: &[f64; 3],
        asked: f64,
        until: f64,
    ) -> Result<Found<S>, NodeError> {
        let Body { a, b, c } = self.body;
        let inverse_inertia = [a, b, c].map(S::from_f64);
        let until = S::from_f64(until);
        match first_conjugate_time_by_method(method, inverse_inertia, start.map(S::from_f64), S::ZERO, until, asked) {
            Ok(found) => Ok(Found { time: Some(found.t1), work: found.work }),
            Err(FlowError::NoneBefore { .. } | FlowError::Integration(_)) => Ok(Found::nothing()),
            Err(error) => Err(failed(&format!("{start:?}"))(error)),
        }
    }

    fn closed_form<S: Real>(&self, start: &[f64; 3]) -> Result<Found<S>, NodeError> {
        let [y0, p_x, p_y] = start.map(S::from_f64);
        let doing = format!("{start:?}");
        let extremal = Extremal::new(&self.body.metric()?, Start::Momenta { y0, p_x, p_y }).map_err(failed(&doing))?;
        Ok(Found::at(first_conjugate_time(&extremal).map_err(failed(&doing))?.t1))
    }

    fn second_route(&self, start: &[f64; 3]) -> Result<DoubleDouble, NodeError> {
        let found = self.closed_form(start)?;
        found.time.ok_or_else(|| no_such_route(Route::ClosedForm, start))
    }

    fn together(&self, route: Route, starts: &[[f64; 3]], asked: f64) -> Result<Vec<Option<f64>>, NodeError> {
        match route {
            Route::ClosedFormLanes => {
                let momenta = starts.iter().map(|[y0, p_x, p_y]| Start::Momenta { y0: *y0, p_x: *p_x, p_y: *p_y });
                let momenta: Vec<Start> = momenta.collect();
                let found = first_conjugate_times(&self.body.metric()?, &momenta);
                Ok(found.iter().map(|time| time.as_ref().ok().map(|time| time.t1)).collect())
            }
            Route::TaylorLanes => {
                let Body { a, b, c } = self.body;
                let one =
                    |[y0, p_x, p_y]: &[f64; 3]| FlowStart { inverse_inertia: [a, b, c], y0: *y0, p_x: *p_x, p_y: *p_y };
                let flows: Vec<FlowStart> = starts.iter().map(one).collect();
                let found = first_conjugate_times_by_integration(&flows, asked, T_MAX);
                Ok(found.iter().map(|point| point.as_ref().ok().map(|point| point.t1)).collect())
            }
            other => Err(no_such_route(other, &starts.first())),
        }
    }
}
