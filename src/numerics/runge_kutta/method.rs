//! The integration methods under one name each, so that one can be put for another in a computation.
//!
//! ```
//! use polhode::numerics::runge_kutta::{dop853::Dop853, method::{Method, PowerSeries}, verner98::Verner98};
//! use polhode::numerics::taylor::events::{Component, Events};
//! use polhode::numerics::taylor::flow::{Flow, Series};
//! use polhode::numerics::taylor::integrator::{IntegrationError, Settings};
//!
//! /// `x'' = −x` from (1, 0): the cosine.
//! struct Circle;
//! impl Flow<f64> for Circle {
//!     type State<T: Copy> = [T; 2];
//!     type Auxiliary<T: Copy> = [T; 0];
//!     fn coefficients(&self, n: usize, x: &[Series<f64>; 2], _: &mut [Series<f64>; 0]) -> [f64; 2] {
//!         [-x[1][n], x[0][n]]
//!     }
//!     fn scales(&self, _: &[f64; 2]) -> [f64; 2] {
//!         [1.0; 2]
//!     }
//! }
//!
//! fn quarter_turn(method: impl Method) -> Result<f64, IntegrationError> {
//!     let mut events = Events::first(1, Component(0));
//!     method.integrate(&Circle, &[1.0, 0.0], (0.0, 5.0), &Settings::new(1e-12), &mut events)?;
//!     Ok(events.found[0].time)
//! }
//!
//! # fn main() -> Result<(), IntegrationError> {
//! for time in [quarter_turn(PowerSeries)?, quarter_turn(Dop853)?, quarter_turn(Verner98)?] {
//!     assert!((time - std::f64::consts::FRAC_PI_2).abs() < 1e-11);
//! }
//! # Ok(())
//! # }
//! ```

use crate::numerics::real::Real;
use crate::numerics::runge_kutta::integrator as pairs;
use crate::numerics::runge_kutta::rate::ByCoefficients;
use crate::numerics::runge_kutta::tableau::Pair;
use crate::numerics::taylor::flow::Flow;
use crate::numerics::taylor::integrator as series;
use crate::numerics::taylor::integrator::{Arrival, IntegrationError, Observer, Settings};

/// An integration method for polynomial flows.
pub trait Method: Copy {
    /// Its name, for people.
    const NAME: &'static str;

    /// Integrates from `initial` at `span.0` to `span.1`, later or earlier; see the method's own `integrate`.
    ///
    /// # Errors
    /// [`IntegrationError`], with time and state.
    fn integrate<S: Real, F: Flow<S>, O: Observer<S, F>>(
        self,
        flow: &F,
        initial: &F::State<S>,
        span: (S, S),
        settings: &Settings,
        observer: &mut O,
    ) -> Result<Arrival<S, F::State<S>>, IntegrationError>;
}

/// Power series of an order that the tolerance decides ([`crate::numerics::taylor`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PowerSeries;

impl Method for PowerSeries {
    const NAME: &'static str = "power series";
    fn integrate<S: Real, F: Flow<S>, O: Observer<S, F>>(
        self,
        flow: &F,
        initial: &F::State<S>,
        span: (S, S),
        settings: &Settings,
        observer: &mut O,
    ) -> Result<Arrival<S, F::State<S>>, IntegrationError> {
        series::integrate(flow, initial, span, settings, observer)
    }
}

impl<P: Pair> Method for P {
    const NAME: &'static str = <P as Pair>::NAME;
    fn integrate<S: Real, F: Flow<S>, O: Observer<S, F>>(
        self,
        flow: &F,
        initial: &F::State<S>,
        span: (S, S),
        settings: &Settings,
        observer: &mut O,
    ) -> Result<Arrival<S, F::State<S>>, IntegrationError> {
        pairs::integrate(self, &ByCoefficients(flow), initial, span, settings, observer)
    }
}
