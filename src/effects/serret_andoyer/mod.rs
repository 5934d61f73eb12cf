//! Node kinds of the Serret-Andoyer metric (section 3 of the article).

pub mod body;
pub mod by_integration;
pub mod conjugate_locus;
pub mod conjugate_time_bounds;
pub mod conjugate_time_supremum;
pub mod curvature;
pub mod curvature_profile;
pub mod cusp_limit;
pub mod cusps;
pub mod cut_locus;
pub mod equator_limits;
pub mod geodesics;
pub mod named_start;
pub mod period;
pub mod potential;
pub mod wave_front;
pub mod wave_front_crossings;
