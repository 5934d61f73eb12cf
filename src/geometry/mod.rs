//! The article's mathematics: metrics, extremals, conjugate points. Uses the numerics room only.

pub mod spin;
