//! What targets need: experiments, outputs, nodes, by name.

use super::graph::Graph;
use std::collections::BTreeSet;

impl Graph {
    /// Everything.
    pub fn all(&self) -> Selection {
        let exports = (0..self.exports.len()).collect();
        Selection { targets: Vec::new(), nodes: self.order.clone(), exports }
    }

    /// What targets need; no target means everything. A target is an experiment's id (its files and all its nodes), the
    /// path of an export (that file), or a node's address as it is shown (that node and its files).
    ///
    /// # Errors
    /// Targets that name nothing.
    pub fn select<T: AsRef<str>>(&self, targets: &[T]) -> Result<Selection, UnknownTarget> {
        if targets.is_empty() {
            return Ok(self.all());
        }
        let (mut wanted, mut exports) = (BTreeSet::new(), BTreeSet::new());
        for target in targets.iter().map(AsRef::as_ref) {
            if let Some(plan) = self.experiments.iter().position(|(id, _)| id == target) {
                wanted.extend((0..self.nodes.len()).filter(|node| self.nodes[*node].plan == plan));
                exports.extend((0..self.exports.len()).filter(|export| self.exports[*export].plan == plan));
            } else if let Some(export) = self.exports.iter().position(|placed| placed.export.path == target) {
                exports.insert(export);
            } else if let Some(node) = self.nodes.iter().position(|placed| placed.node.address.to_string() == target) {
                wanted.insert(node);
                exports.extend(&self.nodes[node].exports);
            } else {
                return Err(self.unknown(target));
            }
        }
        wanted.extend(exports.iter().map(|export| self.exports[*export].node));
        let targets = targets.iter().map(|target| target.as_ref().to_owned()).collect();
        Ok(Selection { targets, nodes: self.closure(wanted), exports: exports.into_iter().collect() })
    }

    /// These nodes and all that they need, in order.
    fn closure(&self, wanted: BTreeSet<usize>) -> Vec<usize> {
        let mut is_needed = vec![false; self.nodes.len()];
        let mut open: Vec<usize> = wanted.into_iter().collect();
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut is_needed[node], true) {
                open.extend(&self.nodes[node].inputs);
            }
        }
        self.order.iter().copied().filter(|node| is_needed[*node]).collect()
    }

    fn unknown(&self, target: &str) -> UnknownTarget {
        let ids = self.experiments.iter().map(|(id, _)| id.clone());
        let paths = self.exports.iter().map(|placed| placed.export.path.clone());
        let addresses = self.nodes.iter().map(|placed| placed.node.address.to_string());
        let scored = ids.chain(paths).chain(addresses).map(|name| (strsim::jaro_winkler(target, &name), name));
        let mut near: Vec<(f64, String)> = scored.filter(|(score, _)| *score > NEAR).collect();
        near.sort_by(|a, b| b.0.total_cmp(&a.0));
        UnknownTarget { target: target.to_owned(), near: near.into_iter().take(3).map(|(_, name)| name).collect() }
    }
}

/// How similar a name must be to be suggested: clap's own bound.
const NEAR: f64 = 0.7;

/// A target that names nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no experiment, output or node is called {target:?}{}", suggestion(near))]
pub struct UnknownTarget {
    /// What was asked for.
    pub target: String,
    /// Names like it, the likest first.
    pub near: Vec<String>,
}

fn suggestion(near: &[String]) -> String {
    near.first().map_or_else(String::new, |name| format!("; did you mean {name:?}?"))
}

/// What targets need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// The targets; none means everything.
    pub targets: Vec<String>,
    /// The nodes, each after those that it reads from.
    pub nodes: Vec<usize>,
    /// The exports.
    pub exports: Vec<usize>,
}
