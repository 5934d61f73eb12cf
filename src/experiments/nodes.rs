//! The list of compute nodes that an experiment asks for, each making one table.

use crate::contract::accuracy::{Accuracy, Arithmetic};
use crate::contract::node::{ARITHMETIC, Address, Compute, Node, NodeError};
use crate::effects::product::TABLE;
use serde::Serialize;

/// Collects the nodes of one experiment.
pub struct Nodes {
    id: String,
    arithmetic: Arithmetic,
    nodes: Vec<Node>,
    tables: Vec<(String, Address)>,
}

/// A table that an earlier node makes, as input of a later one.
#[derive(Clone, Debug)]
pub struct TableRef(Address);

impl Nodes {
    /// No nodes yet, for the experiment `id`.
    pub fn new(id: &str) -> Self {
        Self { id: id.to_owned(), arithmetic: Arithmetic::F64, nodes: Vec::new(), tables: Vec::new() }
    }

    /// From now on, nodes whose kinds heed it run in the arithmetic of this level.
    pub fn at(&mut self, accuracy: Accuracy) {
        self.arithmetic = accuracy.arithmetic();
    }

    /// Asks for a node. Its table is found as `name`, with `/axis=value` for each axis, by the picture and the findings.
    ///
    /// `origins` says which config key each leaf of the parameters came from, where the paths differ; an empty key: from none, a default.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn add<C: Compute + Serialize + 'static>(
        &mut self,
        name: &str,
        axes: &[(&str, String)],
        compute: C,
        inputs: &[(&str, &TableRef)],
        origins: &[(&str, String)],
    ) -> Result<TableRef, NodeError> {
        let address =
            axes.iter().fold(Address::new(self.id.clone(), name), |address, (axis, value)| address.with(*axis, value));
        let mut node =
            Node::new(address.clone(), compute).map_err(|error| NodeError::new(format!("{address}: {error}")))?;
        node = node.in_arithmetic(self.arithmetic).origin(ARITHMETIC, "scene.accuracy");
        for (input, table) in inputs {
            node = node.input(*input, &table.0, TABLE);
        }
        for (leaf, key) in origins.iter().filter(|(_, key)| !key.is_empty()) {
            node = node.origin(*leaf, key.clone());
        }
        self.nodes.push(node);
        let name = axes.iter().fold(name.to_owned(), |name, (axis, value)| format!("{name}/{axis}={value}"));
        self.tables.push((name, address.clone()));
        Ok(TableRef(address))
    }

    /// The nodes, and the tables by the names that readers use.
    pub fn finish(self) -> (Vec<Node>, Vec<(String, Address)>) {
        (self.nodes, self.tables)
    }
}
