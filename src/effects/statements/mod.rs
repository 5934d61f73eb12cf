//! The article's statements, each with the check that decides it.

pub mod group;
pub mod statement;
