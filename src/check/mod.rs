//! Whether what was computed is what it should be: verdicts on claims, goldens, reference values, agreement of routes.
//!
//! Experiments state evidence; the rules here turn it into verdicts. Goldens pin numbers, verdicts, tables and work of the
//! committed configs; references are values computed elsewhere, with their origin. A statement of the article found false
//! is a result, not a failure; a verdict that differs from the pinned one is a failure.
//!
//! What it does not know: where files lie, how anything was computed, how the program ends (it names the class of the
//! exit code only).

pub mod difference;
pub mod golden;
pub mod movement;
mod number;
pub mod reference;
pub mod report;
pub mod values_tex;
pub mod values_toml;
pub mod verdict;
