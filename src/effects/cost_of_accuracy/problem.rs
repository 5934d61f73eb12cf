//! What is compared: first conjugate times from a fixed list of starts, each by every route, against a reference tighter than all.
//!
//! The reference is the power series in double-double at its own ε. It is compared with a second route in double-double that shares
//! no equation with it: so its accuracy is known, not assumed.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_accuracy::route::Route;
use crate::numerics::counts::Work;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::method::{Method, PowerSeries};
use crate::numerics::runge_kutta::verner98::Verner98;
use serde::Serialize;
use std::fmt::Debug;

/// A first conjugate time, if the route found one, and what it did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<S> {
    /// The time.
    pub time: Option<S>,
    /// Counted work: steps and evaluations of an integration.
    pub work: Work,
}

impl<S> Found<S> {
    /// Without an integration.
    pub fn at(time: S) -> Self {
        Self { time: Some(time), work: Work::default() }
    }

    /// An integration that failed, or found nothing: a careless one may.
    pub fn nothing() -> Self {
        Self { time: None, work: Work::default() }
    }
}

/// A problem with its starts.
pub trait Problem: Clone + Serialize + Send + Sync + 'static {
    /// One start.
    type Start: Clone + Debug + Send + Sync;
    /// The routes that are counted, one by one.
    const COUNTED_ROUTES: &'static [Route];
    /// The routes that are timed.
    const TIMED_ROUTES: &'static [Route];
    /// The kind of the node that counts.
    const COUNTED: &'static Kind;
    /// The kind of the node that measures.
    const TIMED: &'static Kind;

    /// All starts.
    ///
    /// # Errors
    /// Parameters outside the domain.
    fn starts(&self) -> Result<Vec<Self::Start>, NodeError>;

    /// The first conjugate time by integration with one Jacobi column or two, looked for up to `until`.
    ///
    /// # Errors
    /// A start outside the domain.
    fn integrated<M: Method, S: Real>(
        &self,
        method: M,
        start: &Self::Start,
        asked: f64,
        until: f64,
    ) -> Result<Found<S>, NodeError>;

    /// The first conjugate time by the closed form.
    ///
    /// # Errors
    /// The problem has none; a start outside the domain.
    fn closed_form<S: Real>(&self, start: &Self::Start) -> Result<Found<S>, NodeError> {
        Err(no_such_route(Route::ClosedForm, start))
    }

    /// The same by DOP853 in the printed chart.
    ///
    /// # Errors
    /// The problem has no such chart.
    fn in_printed_chart<S: Real>(&self, start: &Self::Start, asked: f64, until: f64) -> Result<Found<S>, NodeError> {
        let _ = (asked, until);
        Err(no_such_route(Route::PrintedChart, start))
    }

    /// The first conjugate time in double-double by equations that have nothing in common with [`Self::integrated`].
    ///
    /// # Errors
    /// A start outside the domain, or none found.
    fn second_route(&self, start: &Self::Start) -> Result<DoubleDouble, NodeError>;

    /// The first conjugate times of all starts by a route that takes many together; none where nothing was found.
    ///
    /// # Errors
    /// The problem has no such route.
    fn together(&self, route: Route, starts: &[Self::Start], asked: f64) -> Result<Vec<Option<f64>>, NodeError>;

    /// The first conjugate time by any route that takes starts one by one, in this scalar.
    ///
    /// # Errors
    /// A start outside the domain, or a route that the problem does not have.
    fn by_route<S: Real>(
        &self,
        route: Route,
        start: &Self::Start,
        asked: f64,
        until: f64,
    ) -> Result<Found<S>, NodeError> {
        match route {
            Route::ClosedForm => self.closed_form(start),
            Route::Taylor => self.integrated(PowerSeries, start, asked, until),
            Route::Dop853 => self.integrated(Dop853, start, asked, until),
            Route::Verner98 => self.integrated(Verner98, start, asked, until),
            Route::PrintedChart => self.in_printed_chart(start, asked, until),
            Route::TaylorDoubleDouble | Route::ClosedFormLanes | Route::TaylorLanes => Err(no_such_route(route, start)),
        }
    }
}

/// A route that a problem does not have, or not so: a defect.
pub fn no_such_route<T: Debug>(route: Route, start: &T) -> NodeError {
    NodeError::new(format!("{start:?}: no route {:?} of this kind", route.name()))
}

/// A conjugate time that was not found has no digit right.
pub const NOT_FOUND: f64 = 1.0;
/// Farther than any reference is looked for.
const FAR: f64 = 1e6;
/// A route looks for conjugate times up to this many times the reference's.
const BEYOND: f64 = 1.9;

/// What the others are compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The first conjugate time.
    pub time: DoubleDouble,
    /// By how much the second route differs, relatively.
    pub difference: f64,
    /// What was done for it, the second route left out.
    pub work: Work,
}

impl Reference {
    /// Of one start.
    ///
    /// # Errors
    /// A start outside the domain, or one whose conjugate time is not found.
    pub fn new<P: Problem>(problem: &P, start: &P::Start) -> Result<Self, NodeError> {
        let found = problem.integrated::<_, DoubleDouble>(PowerSeries, start, DoubleDouble::EPSILON.to_f64(), FAR)?;
        let time = found.time.ok_or_else(|| NodeError::new(format!("{start:?}: no conjugate time up to {FAR:e}")))?;
        let mut reference = Self { time, difference: 0.0, work: found.work };
        reference.difference = reference.error(problem.second_route(start)?);
        Ok(reference)
    }

    /// Up to when a route looks for the first conjugate time: less than twice as far, beyond which it would be another one.
    pub fn until(&self) -> f64 {
        BEYOND * self.time.to_f64()
    }

    /// The relative error of a time.
    pub fn error(&self, time: DoubleDouble) -> f64 {
        ((time - self.time) / self.time).abs().to_f64()
    }
}
