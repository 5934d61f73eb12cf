//! Hard cases: families of starts that run into a limit, each answered by a naive formulation and by ours, beside the truth.

pub mod family;
pub mod rotation_group;
pub mod rotation_group_naive;
pub mod serret_andoyer;
pub mod serret_andoyer_naive;
pub mod spin;
mod spin_limit;
mod spin_naive;
mod told;
