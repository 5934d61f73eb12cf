//! What an experiment asks for: nodes, and the files that readers see.

use super::node::{Address, Node};

/// A file in the output folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// The path below the output folder, with `/`: `fig7.svg`, `data/fig7/conjugate-locus-k=0.8.parquet`.
    pub path: String,
    /// The node that makes it.
    pub from: Address,
    /// Which of its outputs.
    pub artifact: String,
}

/// The config an experiment was read from, kept for display: line numbers, digests.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ConfigSource {
    /// The file, as the user would name it.
    pub file: String,
    /// Its text.
    pub text: String,
}

/// One experiment, planned.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The experiment's id.
    pub id: String,
    /// The config.
    pub config: ConfigSource,
    /// Its nodes, in any order.
    pub nodes: Vec<Node>,
    /// The files it makes.
    pub exports: Vec<Export>,
}
