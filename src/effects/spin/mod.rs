//! Effects of the spin problem (sections 4 and 5.2): the metric `(dr1² + k² dr3²)/r2²` on S², starts on the equator.

pub mod branch;
pub mod by_integration;
pub mod chart;
pub mod conjugate_loci;
pub mod conjugate_locus;
pub mod contact;
pub mod cut_locus;
pub mod cut_locus_by_integration;
pub mod double_points;
pub mod geodesics;
pub mod loops;
pub mod momenta;
pub mod monotone_theta;
pub mod starts;
pub mod wave_front;
pub mod wave_front_by_integration;
