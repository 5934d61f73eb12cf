//! The Serret-Andoyer metric (article, section 3).

pub mod flow;
