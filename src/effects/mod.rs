//! Node kinds: what a scene can call for. A kind belongs to its effect, never to a figure.

pub mod arithmetic;
pub mod conjugate_point_versus_k;
pub mod conjugate_point_versus_k_by_integration;
pub mod cost_of_accuracy;
pub mod cost_of_effects;
pub mod counted;
pub mod hard_cases;
pub mod point;
pub mod product;
pub mod quantities;
pub mod rotation_group;
pub mod scene;
pub mod serret_andoyer;
pub mod spin;
pub mod statements;
pub mod switch_points;
pub mod switch_points_by_integration;
pub mod theta_turning_points;
pub mod trajectory_types;
pub mod type_ranges;
pub mod typed_trajectories;
