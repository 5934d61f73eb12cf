//! Node kinds of the Serret-Andoyer metric (section 3 of the article).

pub mod body;
pub mod by_integration;
pub mod cusp_limit;
pub mod cusps;
pub mod equator_limits;
