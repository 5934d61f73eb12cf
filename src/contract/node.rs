//! A node: one piece of work with declared parameters and inputs, and what it gives back.

use super::accuracy::Arithmetic;
use super::digest::Digest;
use super::manifest::{self, Leaf, Line, NotDescribable, Part};
use super::work::Work;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// What nodes of one kind have in common.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// The name, unique among kinds: `conjugate-locus`.
    pub name: &'static str,
    /// What it computes, in one sentence.
    pub summary: &'static str,
    /// The rooms (`numerics`) and files (`effects/curvature.rs`) below `src/` whose code the result depends on.
    pub code: &'static [&'static str],
    /// Whether the result holds a time: then it is run alone, and is never pinned.
    pub measurement: bool,
}

/// Where a node stands, for people: experiment, kind, axis values. Not part of the key.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Address {
    /// The experiment's id (the stem of its config's file name).
    pub experiment: String,
    /// The name of the node within the experiment: its kind's name, or that with a suffix.
    pub node: String,
    /// Axis values, such as `("k", "0.8")`, in the order of the config.
    pub axes: Vec<(String, String)>,
}

impl Address {
    /// An address without axis values.
    pub fn new(experiment: impl Into<String>, node: impl Into<String>) -> Self {
        Self { experiment: experiment.into(), node: node.into(), axes: Vec::new() }
    }

    /// The same with one more axis value.
    #[must_use]
    pub fn with(mut self, axis: impl Into<String>, value: impl fmt::Display) -> Self {
        self.axes.push((axis.into(), value.to_string()));
        self
    }

    /// `conjugate-locus-k=0.8`: the part of a file name that tells nodes of an experiment apart.
    pub fn file_stem(&self) -> String {
        let mut stem = self.node.clone();
        self.axes.iter().for_each(|(axis, value)| stem.push_str(&format!("-{axis}={value}")));
        stem
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.experiment, self.node)?;
        self.axes.iter().try_for_each(|(axis, value)| write!(f, "/{axis}={value}"))
    }
}

/// What becomes a file when it is written.
pub trait Encode: Send + Sync {
    /// The file's bytes, with what it was made from, as (name, value), where its format has a place for that.
    ///
    /// # Errors
    /// What the format refuses.
    fn encode(&self, made_from: &[(String, String)]) -> Result<Vec<u8>, NodeError>;
}

#[derive(Clone)]
enum Content {
    Bytes(Arc<Vec<u8>>),
    Unwritten(Arc<dyn Encode>),
}

/// One output of a node.
#[derive(Clone)]
pub struct Artifact {
    /// The name inside the node: `table.parquet`.
    pub name: String,
    content: Content,
    /// The digest of what the file says: of a table, its schema and the bits of its columns; of other files, their
    /// bytes. Nodes downstream depend on this one.
    pub logical: Digest,
}

impl Artifact {
    /// A file whose meaning is its bytes.
    pub fn opaque(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        let logical = Digest::of(&bytes);
        Self { name: name.into(), content: Content::Bytes(Arc::new(bytes)), logical }
    }

    /// A file that is written after the node's work: that takes time, and is no part of computing.
    pub fn unwritten(name: impl Into<String>, logical: Digest, content: impl Encode + 'static) -> Self {
        Self { name: name.into(), content: Content::Unwritten(Arc::new(content)), logical }
    }

    /// The file's bytes.
    ///
    /// # Errors
    /// What its format refuses.
    pub fn bytes(&self, made_from: &[(String, String)]) -> Result<Arc<Vec<u8>>, NodeError> {
        match &self.content {
            Content::Bytes(bytes) => Ok(Arc::clone(bytes)),
            Content::Unwritten(content) => content.encode(made_from).map(Arc::new),
        }
    }
}

impl fmt::Debug for Artifact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Artifact").field("name", &self.name).field("logical", &self.logical).finish_non_exhaustive()
    }
}

/// Artifacts are equal when they say the same under the same name.
impl PartialEq for Artifact {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, self.logical) == (&other.name, other.logical)
    }
}
impl Eq for Artifact {}

/// What a node gives back.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Product {
    /// Its outputs.
    pub artifacts: Vec<Artifact>,
    /// What it did.
    pub work: Work,
}

/// An input, as the node reads it.
#[derive(Clone, Debug)]
pub struct InputFile {
    /// The bytes, verified against the store's digest before they got here.
    pub bytes: Arc<Vec<u8>>,
    /// The logical digest, which is part of the node's key.
    pub logical: Digest,
}

/// The inputs of a node by the names that it gave them.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    files: BTreeMap<String, InputFile>,
}

impl Inputs {
    /// Adds an input.
    pub fn insert(&mut self, name: impl Into<String>, file: InputFile) {
        self.files.insert(name.into(), file);
    }

    /// The input of that name.
    ///
    /// # Errors
    /// A node that reads an input which it did not declare: a defect of the node.
    pub fn get(&self, name: &str) -> Result<&InputFile, NodeError> {
        self.files.get(name).ok_or_else(|| NodeError::new(format!("input {name:?} was not declared by the node")))
    }

    /// All inputs, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &InputFile)> {
        self.files.iter().map(|(name, file)| (name.as_str(), file))
    }
}

/// Why a node failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct NodeError {
    /// What went wrong, with the data that tells where.
    pub message: String,
}

impl NodeError {
    /// An error with this message.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }
}

/// The work of a node. Its parameters are those of the implementing value, written by its `Serialize`.
pub trait Compute: Send + Sync {
    /// The kind.
    fn kind(&self) -> &'static Kind;

    /// Does the work.
    ///
    /// # Errors
    /// Whatever keeps the result from being right: nothing is half trusted.
    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError>;

    /// Whether [`Compute::run_in`] heeds its arithmetic. Kinds that are computed in one arithmetic only, and those whose own parameters say
    /// which, leave this as it is; their docs say why.
    fn heeds_arithmetic(&self) -> bool {
        false
    }

    /// Does the work in an arithmetic; in `f64` the same as [`Compute::run`].
    ///
    /// # Errors
    /// Those of [`Compute::run`].
    fn run_in(&self, _: Arithmetic, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run(inputs)
    }
}

/// A node's work in an arithmetic of its own.
struct InArithmetic {
    arithmetic: Arithmetic,
    compute: Arc<dyn Compute>,
}

impl Compute for InArithmetic {
    fn kind(&self) -> &'static Kind {
        self.compute.kind()
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.compute.run_in(self.arithmetic, inputs)
    }
}

/// The parameter that names an arithmetic other than `f64`.
pub const ARITHMETIC: &str = "arithmetic";

/// An input as a node declares it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputRef {
    /// The name under which the node reads it.
    pub name: String,
    /// The node that makes it.
    pub from: Address,
    /// Which of that node's outputs.
    pub artifact: String,
}

/// A planned node.
#[derive(Clone)]
pub struct Node {
    /// Where it stands.
    pub address: Address,
    /// Its parameters, as lines of the manifest.
    pub params: Vec<Line>,
    /// Its inputs.
    pub inputs: Vec<InputRef>,
    /// For display: which key of the config a parameter came from, as (leaf path, config key).
    pub origins: Vec<(String, String)>,
    /// Its work.
    pub compute: Arc<dyn Compute>,
}

impl Node {
    /// A node whose parameters are all those that `compute` serialises.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn new<C: Compute + Serialize + 'static>(address: Address, compute: C) -> Result<Self, NotDescribable> {
        let params = manifest::describe(&compute)?;
        Ok(Self { address, params, inputs: Vec::new(), origins: Vec::new(), compute: Arc::new(compute) })
    }

    /// The same in an arithmetic, where its kind heeds that: then it is a parameter, unless it is `f64`.
    #[must_use]
    pub fn in_arithmetic(mut self, arithmetic: Arithmetic) -> Self {
        if arithmetic != Arithmetic::F64 && self.compute.heeds_arithmetic() {
            let leaf = Leaf::Text(arithmetic.name().to_owned());
            self.params.push(Line { part: Part::Param, path: ARITHMETIC.to_owned(), leaf });
            self.compute = Arc::new(InArithmetic { arithmetic, compute: self.compute });
        }
        self
    }

    /// What its files are made from, as far as they say so: kind, arithmetic where it is chosen, parameters.
    pub fn made_from(&self) -> Vec<(String, String)> {
        let parameters: Vec<String> = self.params.iter().map(|line| format!("{} = {}", line.path, line.leaf)).collect();
        vec![("kind".to_owned(), self.compute.kind().name.to_owned()), ("parameters".to_owned(), parameters.join("\n"))]
    }

    /// Declares an input.
    #[must_use]
    pub fn input(mut self, name: impl Into<String>, from: &Address, artifact: impl Into<String>) -> Self {
        self.inputs.push(InputRef { name: name.into(), from: from.clone(), artifact: artifact.into() });
        self
    }

    /// Says which key of the config a parameter came from.
    #[must_use]
    pub fn origin(mut self, leaf: impl Into<String>, config_key: impl Into<String>) -> Self {
        self.origins.push((leaf.into(), config_key.into()));
        self
    }
}

impl fmt::Debug for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node").field("address", &self.address).field("kind", &self.compute.kind().name).finish()
    }
}
