//! Node kinds of the left-invariant metrics on SO(3) (sections 2 and 5.3 of the article), and of what they project to.

pub mod attitude;
pub mod conjugate_times;
pub mod conjugate_times_by_attitude;
pub mod directions;
pub mod projected_conjugate_point;
pub mod projected_conjugate_point_by_integration;
pub mod projected_path;
pub mod projection;
pub mod start;
pub mod start_of_conjugate_time;
