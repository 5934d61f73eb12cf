//! The Serret-Andoyer metric of the Euler-Poinsot rigid body motion (sections 2.4 and 3 of the article), in closed form.
//!
//! `H = ½[p_x² Z(y) + p_y² (C − Z(y))]` with `Z(y) = A sin²y + B cos²y` and `0 < A < B < C` the inverse moments of inertia.
//! Everything is written over the angle `a = y − π/2` from the equator, on the universal cover: `Z = A + (B − A) sin²a`.

pub mod conjugate;
pub mod curvature;
pub mod darboux;
mod equation;
pub mod extremal;
pub mod flow;
pub mod flow_lanes;
pub mod lanes;
pub mod metric;
pub mod path;
pub mod period;
pub mod reference;
pub mod start;

pub use conjugate::{ConjugatePoint, NoConjugatePoint, first_conjugate_point};
pub use extremal::{Extremal, ExtremalClass};
pub use metric::Metric;
pub use path::{Path, Position};
pub use start::{Branch, Clairaut, Start, StartError};
