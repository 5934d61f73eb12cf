//! Embedded Runge-Kutta pairs with dense output: peers of the power-series integrator, and the way to integrate flows
//! that are not polynomial.
//!
//! Settings, errors, arrival, counted work, observers, events and samples are those of [`crate::numerics::taylor`]: on a
//! step the pair's interpolant is a polynomial in time, and observers see it in the place of the power series. So the
//! same flow, with columns or without, and the same observers run under every method ([`method`]).
//!
//! - [`rate`]: what is integrated, a right-hand side: that of a polynomial flow (coefficient 0), or any other;
//! - [`tableau`]: what a pair is; [`dop853`] and [`verner98`] are two;
//! - [`step`](mod@step): the stages, the estimate of the error and the interpolant of one step;
//! - [`integrator`]: the loop over steps, of chosen or of equal lengths;
//! - [`method`]: one name for each method, so that one can be put for another.
//!
//! **Events.** Their function must be a polynomial of the state, as with power series: its polynomial on the step is
//! formed and its roots are isolated, no signs are sampled. For another function add it to the state, by its derivative
//! along the flow. Times of events carry the error of the interpolant, which is about that of the step; `blur` and the
//! joining of double and triple roots know of rounding alone. So where the function only touches zero, the error of the
//! step may part the roots or lose them: a power series at full accuracy does not.
//!
//! Coefficients are `f64`: a longer scalar gains nothing beyond 1e-16. Not known here: any geometry.

pub mod dop853;
pub mod integrator;
pub mod method;
pub mod rate;
pub mod step;
pub mod tableau;
pub mod verner98;

#[cfg(test)]
mod order_conditions;
#[cfg(test)]
mod tests;
