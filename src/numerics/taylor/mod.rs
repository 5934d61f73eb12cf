//! Power-series (Taylor) integration of polynomial flows.
//!
//! The Taylor coefficients of a solution of `x' = f(x)` with polynomial `f` follow order by order from Cauchy products;
//! a step goes as far as the last terms kept stay at the requested error, which alone decides the order. The system
//! that is integrated is assembled at compile time from types, so what is not asked for has no state, no equation and
//! no cost:
//!
//! - [`flow`]: what a flow and its tangent columns (Jacobi fields) are; Cauchy products; type composition;
//! - [`step`](mod@step): order and step length from the requested error, the coefficients of one step;
//! - [`integrator`]: the loop over steps, compensated sums, errors as values, observers;
//! - [`dense`]: states between steps, streamed or kept;
//! - [`events`]: every root of a function of the state, by isolating the roots of the step's polynomial;
//! - [`lanes`]: eight integrations beside each other, from the same flows and with the same bits;
//! - [`monitor`]: how far a conserved quantity drifts;
//! - [`multiplications`]: what the series of a step cost, counted.
//!
//! Sources: À. Jorba and M. Zou, *A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods*, Experimental Mathematics 14 (2005) 99-117. Not known here: any geometry.

pub mod dense;
pub mod events;
pub mod flow;
pub mod integrator;
pub mod lanes;
pub mod monitor;
pub mod multiplications;
pub mod step;
