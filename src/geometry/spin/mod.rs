//! The metric of three coupled spins (article, section 4).

pub mod lift;
