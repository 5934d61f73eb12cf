//! What experiments, effects and the runner promise each other. Names no other room.

pub mod accuracy;
pub mod claim;
pub mod code;
pub mod config;
pub mod digest;
pub mod manifest;
pub mod node;
pub mod plan;
pub mod sweep;
#[cfg(test)]
pub mod tokens;
pub mod value;
pub mod work;
