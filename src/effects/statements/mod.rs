//! The article's statements, each with the check that decides it.

pub mod group;
pub mod left_invariant;
pub mod spin_closed_form;
pub mod spin_closed_form_regimes;
pub mod spin_closed_form_special;
pub mod spin_conjugate_times;
pub mod spin_curvature;
pub mod spin_fronts;
pub mod spin_integrability;
pub mod spin_limits;
pub mod spin_metric;
pub mod spin_parametrisation;
pub mod spin_pendulum;
pub mod spin_pendulum_energy;
pub mod spin_points;
pub mod spin_switch_points;
pub mod spin_system;
pub mod spin_trajectories;
pub mod statement;
