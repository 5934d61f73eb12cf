//! Joins the plans of experiments to one graph, and selects what targets need.
//!
//! Joining refuses what could not be right: two nodes at one address, inputs from nowhere, cycles, two files at one path,
//! paths that leave the output folder, code that does not exist. All defects are returned, not the first one only.

use crate::contract::code::{self, CodeListing, UnknownCode};
use crate::contract::digest::Digest;
use crate::contract::manifest::{Leaf, Line, Manifest, Part, key_of};
use crate::contract::node::{Address, Kind, Node};
use crate::contract::plan::{ConfigSource, Export, Plan};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Why plans don't make a graph.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GraphError {
    /// Two nodes stand at one address.
    #[error("two nodes stand at {0}")]
    DuplicateAddress(Address),
    /// Two plans have one id.
    #[error("two experiments are called {0:?}")]
    DuplicateExperiment(String),
    /// An id that can't name a file.
    #[error("the experiment's id {0:?} can't be used: it must be a plain file name")]
    BadId(String),
    /// A node reads from an address where nothing stands.
    #[error("{node}: input {input:?} comes from {from}, where no node stands")]
    UnknownInput {
        /// The node that reads.
        node: Address,
        /// The input's name.
        input: String,
        /// Where it should come from.
        from: Address,
    },
    /// A node has two inputs of one name.
    #[error("{node}: two inputs are called {input:?}")]
    DuplicateInput {
        /// The node.
        node: Address,
        /// The input's name.
        input: String,
    },
    /// Nodes wait for each other.
    #[error("nodes wait for each other: {}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join(" → "))]
    Cycle(Vec<Address>),
    /// An export comes from an address where nothing stands.
    #[error("the file {path:?} comes from {from}, where no node stands")]
    UnknownExport {
        /// The path.
        path: String,
        /// Where it should come from.
        from: Address,
    },
    /// Two exports go to one path, or one goes to where another needs a folder.
    #[error("two outputs go to one place: {first:?} and {second:?}")]
    DuplicatePath {
        /// One.
        first: String,
        /// The other.
        second: String,
    },
    /// A path that is not plainly below the output folder.
    #[error("the output path {0:?} can't be used: it must be relative, with `/`, without `.` and `..`")]
    BadPath(String),
    /// A kind declares code that does not exist.
    #[error(transparent)]
    UnknownCode(#[from] UnknownCode),
}

/// A node in the graph.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The node.
    pub node: Node,
    /// The plan that it comes from.
    pub plan: usize,
    /// The nodes that its inputs come from, in the order of `node.inputs`.
    pub inputs: Vec<usize>,
    /// The nodes that read from it, each once.
    pub dependents: Vec<usize>,
    /// The exports that come from it.
    pub exports: Vec<usize>,
    /// The code that its kind depends on.
    pub code: Arc<CodeListing>,
}

/// A file to be made.
#[derive(Clone, Debug)]
pub struct PlacedExport {
    /// Its path below the output folder, and where it comes from.
    pub export: Export,
    /// The node.
    pub node: usize,
    /// The plan.
    pub plan: usize,
}

/// Plans, joined.
#[derive(Clone, Debug)]
pub struct Graph {
    /// The nodes.
    pub nodes: Vec<Placed>,
    /// The exports.
    pub exports: Vec<PlacedExport>,
    /// Indices of the nodes, each after those that it reads from.
    pub order: Vec<usize>,
    /// Ids of the experiments and their configs.
    pub experiments: Vec<(String, ConfigSource)>,
    by_address: HashMap<Address, usize>,
}

impl Graph {
    /// Joins plans. Code listings are those of this program.
    ///
    /// # Errors
    /// All defects found.
    pub fn join(plans: Vec<Plan>) -> Result<Self, Vec<GraphError>> {
        Self::join_with(plans, &code::listing)
    }

    /// Joins plans with the code listings that `listing` gives: tests change code by it.
    ///
    /// # Errors
    /// All defects found.
    pub fn join_with(
        plans: Vec<Plan>,
        listing: &dyn Fn(&Kind) -> Result<Arc<CodeListing>, UnknownCode>,
    ) -> Result<Self, Vec<GraphError>> {
        let mut errors = Vec::new();
        let mut graph = Self {
            nodes: Vec::new(),
            exports: Vec::new(),
            order: Vec::new(),
            experiments: Vec::new(),
            by_address: HashMap::new(),
        };
        let mut listings: HashMap<&'static str, Arc<CodeListing>> = HashMap::new();
        let mut planned_exports = Vec::new();
        for (index, plan) in plans.into_iter().enumerate() {
            if plan.id.is_empty() || plan.id.starts_with('.') || plan.id.contains(['/', '\\', '\0']) {
                errors.push(GraphError::BadId(plan.id.clone()));
            }
            if graph.experiments.iter().any(|(id, _)| *id == plan.id) {
                errors.push(GraphError::DuplicateExperiment(plan.id.clone()));
            }
            for node in plan.nodes {
                let kind = node.compute.kind();
                let code = match listings.get(kind.name) {
                    Some(known) => Arc::clone(known),
                    None => match listing(kind) {
                        Ok(code) => Arc::clone(listings.entry(kind.name).or_insert(code)),
                        Err(error) => {
                            errors.push(error.into());
                            continue;
                        }
                    },
                };
                if graph.by_address.insert(node.address.clone(), graph.nodes.len()).is_some() {
                    errors.push(GraphError::DuplicateAddress(node.address.clone()));
                }
                let (inputs, dependents, exports) = (Vec::new(), Vec::new(), Vec::new());
                graph.nodes.push(Placed { node, plan: index, inputs, dependents, exports, code });
            }
            planned_exports.extend(plan.exports.into_iter().map(|export| (index, export)));
            graph.experiments.push((plan.id, plan.config));
        }
        graph.connect(&mut errors);
        graph.place_exports(planned_exports, &mut errors);
        if errors.is_empty() {
            graph.sort(&mut errors);
        }
        if errors.is_empty() { Ok(graph) } else { Err(errors) }
    }

    fn connect(&mut self, errors: &mut Vec<GraphError>) {
        for index in 0..self.nodes.len() {
            let mut inputs = Vec::with_capacity(self.nodes[index].node.inputs.len());
            let mut names = BTreeSet::new();
            let Node { address, inputs: declared, .. } = &self.nodes[index].node;
            for input in declared {
                if !names.insert(&input.name) {
                    errors.push(GraphError::DuplicateInput { node: address.clone(), input: input.name.clone() });
                }
                match self.by_address.get(&input.from) {
                    Some(&from) => inputs.push(from),
                    None => errors.push(GraphError::UnknownInput {
                        node: address.clone(),
                        input: input.name.clone(),
                        from: input.from.clone(),
                    }),
                }
            }
            for from in inputs.iter().collect::<BTreeSet<_>>() {
                self.nodes[*from].dependents.push(index);
            }
            self.nodes[index].inputs = inputs;
        }
    }

    fn place_exports(&mut self, planned: Vec<(usize, Export)>, errors: &mut Vec<GraphError>) {
        let mut taken: BTreeMap<String, ()> = BTreeMap::new();
        for (plan, export) in planned {
            if !is_plain_path(&export.path) {
                errors.push(GraphError::BadPath(export.path.clone()));
            }
            let folder = format!("{}/", export.path);
            let below = taken.range(folder.clone()..).next().map(|(path, ())| path).filter(|p| p.starts_with(&folder));
            let above = export.path.match_indices('/').map(|(at, _)| &export.path[..at]);
            let above = above.chain([export.path.as_str()]).find(|path| taken.contains_key(*path));
            if let Some(first) = below.cloned().or(above.map(str::to_owned)) {
                errors.push(GraphError::DuplicatePath { first, second: export.path.clone() });
            }
            taken.insert(export.path.clone(), ());
            match self.by_address.get(&export.from) {
                Some(&node) => {
                    self.nodes[node].exports.push(self.exports.len());
                    self.exports.push(PlacedExport { export, node, plan });
                }
                None => errors.push(GraphError::UnknownExport { path: export.path, from: export.from }),
            }
        }
    }

    fn sort(&mut self, errors: &mut Vec<GraphError>) {
        let mut waiting: Vec<usize> =
            self.nodes.iter().map(|placed| placed.inputs.iter().collect::<BTreeSet<_>>().len()).collect();
        let mut order: Vec<usize> = (0..self.nodes.len()).filter(|index| waiting[*index] == 0).collect();
        let mut at = 0;
        while at < order.len() {
            for &dependent in &self.nodes[order[at]].dependents {
                waiting[dependent] -= 1;
                if waiting[dependent] == 0 {
                    order.push(dependent);
                }
            }
            at += 1;
        }
        if let Some(stuck) = (0..self.nodes.len()).find(|index| waiting[*index] > 0) {
            errors.push(GraphError::Cycle(self.cycle_from(stuck, &waiting)));
        }
        self.order = order;
    }

    /// Follows inputs that wait until a node comes twice.
    fn cycle_from(&self, start: usize, waiting: &[usize]) -> Vec<Address> {
        let mut path = vec![start];
        let mut at = start;
        while let Some(&next) = self.nodes[at].inputs.iter().find(|input| waiting[**input] > 0) {
            if let Some(first) = path.iter().position(|seen| *seen == next) {
                path.drain(..first);
                path.push(next);
                break;
            }
            path.push(next);
            at = next;
        }
        path.reverse();
        path.into_iter().map(|index| self.nodes[index].node.address.clone()).collect()
    }

    /// The node at an address.
    pub fn find(&self, address: &Address) -> Option<usize> {
        self.by_address.get(address).copied()
    }

    /// The address of a node.
    pub fn address(&self, node: usize) -> &Address {
        &self.nodes[node].node.address
    }

    /// The paths of all exports: the files that may stand in the output folder.
    pub fn export_paths(&self) -> BTreeSet<String> {
        self.exports.iter().map(|placed| placed.export.path.clone()).collect()
    }

    /// The manifest's lines that are not parameters: kind, code, and inputs by the logical digests given in their order.
    fn own_lines(&self, node: usize, inputs: &[Digest]) -> Vec<Line> {
        let placed = &self.nodes[node];
        let line = |part, path: &str, leaf| Line { part, path: path.to_owned(), leaf };
        let mut lines = vec![
            line(Part::Kind, "name", Leaf::Text(placed.node.compute.kind().name.to_owned())),
            line(Part::Code, "listing", Leaf::Digest(placed.code.digest)),
        ];
        let named = placed.node.inputs.iter().zip(inputs);
        lines.extend(named.map(|(input, logical)| line(Part::Input, &input.name, Leaf::Digest(*logical))));
        lines
    }

    /// The key of a node, given the logical digests of its inputs in their order.
    pub fn key(&self, node: usize, inputs: &[Digest]) -> Digest {
        key_of(self.own_lines(node, inputs).iter().chain(&self.nodes[node].node.params))
    }

    /// The manifest of a node: what [`Self::key`] is the digest of.
    pub fn manifest(&self, node: usize, inputs: &[Digest]) -> Manifest {
        let mut lines = self.own_lines(node, inputs);
        lines.extend(self.nodes[node].node.params.iter().cloned());
        Manifest { lines }
    }
}

fn is_plain_path(path: &str) -> bool {
    !path.is_empty()
        && !path.contains(['\\', '\0'])
        && path.split('/').all(|part| !part.is_empty() && part != "." && part != "..")
        && !path.starts_with(super::disk::TEMPORARY)
}
