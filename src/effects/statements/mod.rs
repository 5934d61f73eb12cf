//! The article's statements, each with the check that decides it.

pub mod bodies;
pub mod conjugate_locus;
pub mod conjugate_roots;
pub mod conjugate_times;
pub mod darboux_form;
pub mod euler_angles;
pub mod euler_poinsot;
pub mod first_return;
pub mod parameterization;
pub mod pendulum;
pub mod serret_andoyer_transformation;
pub mod statement;
pub mod surfaces_of_revolution;
