//! Left-invariant metrics on SO(3), the Euler-Poinsot motion (article, sections 2 and 5.3).
//!
//! Integration happens in the body frame and in unit quaternions; Euler angles and Serret-Andoyer variables are charts for
//! posing problems and reading results.
//!
//! The first two conjugate times have a closed form ([`closed_form`], asked for by [`first_two`]); any number of them come from integrating
//! Jacobi fields ([`conjugate`], [`attitude_route`]), which is the second route and takes over where the closed form does not resolve a start.

pub mod attitude_route;
pub mod attitude_trajectory;
pub mod body_flow;
pub mod closed_form;
pub mod conjugate;
pub mod euler_angles;
pub mod first_two;
mod lagrangian_plane;
pub mod metric;
pub mod polhode_curve;
pub mod serret_andoyer_transformation;
mod vectors;
