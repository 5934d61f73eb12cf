//! The spin problem: starts on the equator; the lift to R³ × so(3)*, the closed form of the monotone phase, the printed chart.
//!
//! The second route to the reference integrates the pendulum form, whose equations are others: the closed form, though written over any
//! scalar, has constants and series made for `f64`.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_accuracy::printed_chart;
use crate::effects::cost_of_accuracy::problem::{Found, Problem, no_such_route};
use crate::effects::cost_of_accuracy::route::Route;
use crate::effects::product::failed;
use crate::geometry::spin::extremal::Extremal;
use crate::geometry::spin::lanes::first_conjugate_points;
use crate::geometry::spin::lift::{LiftError, conjugate_times_by_method};
use crate::geometry::spin::lift_lanes::first_conjugate_times_by_integration;
use crate::geometry::spin::pendulum::first_conjugate_time_by_pendulum;
use crate::geometry::spin::solve::{Quantity, solve};
use crate::geometry::spin::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::Method;
use serde::Serialize;

/// Later than every conjugate time that is asked for here.
const T_MAX: f64 = 1e6;

/// The spin problem with its starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spin {
    /// `k > 0`.
    pub k: f64,
    /// `p_θ(0)` of the starts.
    pub p_theta: Vec<f64>,
}

const COUNTED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/counted.rs",
    "effects/cost_of_accuracy/printed_chart.rs",
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/cost_of_accuracy/spin.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "geometry/spin",
    "numerics",
    "table",
];
const TIMED_CODE: &[&str] = &[
    "effects/cost_of_accuracy/printed_chart.rs",
    "effects/cost_of_accuracy/problem.rs",
    "effects/cost_of_accuracy/route.rs",
    "effects/cost_of_accuracy/spin.rs",
    "effects/cost_of_accuracy/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "geometry/spin",
    "numerics",
    "table",
];

impl Problem for Spin {
    /// `(k, p_θ)`.
    type Start = (f64, f64);
    const COUNTED_ROUTES: &'static [Route] = &[
        Route::ClosedForm,
        Route::Taylor,
        Route::TaylorDoubleDouble,
        Route::Dop853,
        Route::Verner98,
        Route::PrintedChart,
    ];
    const TIMED_ROUTES: &'static [Route] = &[
        Route::ClosedForm,
        Route::ClosedFormLanes,
        Route::Taylor,
        Route::TaylorLanes,
        Route::TaylorDoubleDouble,
        Route::Dop853,
        Route::Verner98,
        Route::PrintedChart,
    ];
    const COUNTED: &'static Kind = &Kind {
        name: "spin-cost-of-accuracy",
        summary: "achieved error and counted work of the spin problem's conjugate times, by method and request",
        code: COUNTED_CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "spin-time-of-accuracy",
        summary: "time of the spin problem's conjugate times on this machine, by method and request",
        code: TIMED_CODE,
        measurement: true,
    };

    fn starts(&self) -> Result<Vec<(f64, f64)>, NodeError> {
        Ok(self.p_theta.iter().map(|p_theta| (self.k, *p_theta)).collect())
    }

    fn integrated<M: Method, S: Real>(
        &self,
        method: M,
        start: &(f64, f64),
        asked: f64,
        until: f64,
    ) -> Result<Found<S>, NodeError> {
        let (k, p_theta) = *start;
        let [k, p_theta, until] = [k, p_theta, until].map(S::from_f64);
        match conjugate_times_by_method(method, k, p_theta, asked, until, 1) {
            Ok((found, work)) => Ok(Found { time: found.first().map(|point| point.t1), work }),
            Err(LiftError::Integration(_)) => Ok(Found::nothing()),
            Err(error) => Err(failed(&format!("{start:?}"))(error)),
        }
    }

    fn closed_form<S: Real>(&self, start: &(f64, f64)) -> Result<Found<S>, NodeError> {
        let extremal = Extremal::new(S::from_f64(start.0), S::from_f64(start.1).abs());
        let root = solve(&extremal, Quantity::Phase, S::ONE).map_err(failed(&format!("{start:?}")))?;
        Ok(Found::at(root.t))
    }

    fn in_printed_chart<S: Real>(&self, start: &(f64, f64), asked: f64, until: f64) -> Result<Found<S>, NodeError> {
        let (k, p_theta) = *start;
        Ok(printed_chart::first_conjugate_time(S::from_f64(k), S::from_f64(p_theta), asked, S::from_f64(until)))
    }

    fn second_route(&self, start: &(f64, f64)) -> Result<DoubleDouble, NodeError> {
        let [k, p_theta, far] = [start.0, start.1, T_MAX].map(DoubleDouble::from_f64);
        let found = first_conjugate_time_by_pendulum(k, p_theta, DoubleDouble::EPSILON.to_f64(), far);
        Ok(found.map_err(failed(&format!("{start:?}")))?.0.t1)
    }

    fn together(&self, route: Route, starts: &[(f64, f64)], asked: f64) -> Result<Vec<Option<f64>>, NodeError> {
        match route {
            Route::ClosedFormLanes => {
                let checked = starts.iter().map(|(k, p_theta)| Start::new(*k, *p_theta));
                let checked = checked.collect::<Result<Vec<Start>, _>>().map_err(failed("starts"))?;
                Ok(first_conjugate_points(&checked)
                    .iter()
                    .map(|point| point.as_ref().ok().map(|point| point.t1))
                    .collect())
            }
            Route::TaylorLanes => {
                let found = first_conjugate_times_by_integration(starts, asked, T_MAX);
                Ok(found.iter().map(|found| found.as_ref().ok().map(|(point, _)| point.t1)).collect())
            }
            other => Err(no_such_route(other, &starts.first())),
        }
    }
}
