//! Why a node will run: what differs from its last run, leaf by leaf, with the place where a reader finds it.

use super::graph::Graph;
use super::locate;
use super::store::{Fault, Store};
use crate::contract::code::CodeChange;
use crate::contract::digest::Digest;
use crate::contract::manifest::{Change, Leaf, Part};
use serde::Serialize;
use std::fmt;

/// One reason why a node will, or may, run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// It was never run at this address.
    New,
    /// It was, but what it was run with is no longer in the store.
    NoHistory,
    /// A parameter differs.
    Parameter {
        /// The leaf: `metric.k`.
        leaf: String,
        /// What it was.
        old: Option<String>,
        /// What it is.
        new: Option<String>,
        /// The config's file.
        file: String,
        /// The key in the config that it comes from.
        key: String,
        /// The line of that key, from 1.
        line: Option<usize>,
    },
    /// Code differs.
    Code {
        /// The files, crates or compiler that differ; empty when the old listing is no longer in the store.
        changes: Vec<CodeChange>,
    },
    /// An input has other content.
    Input {
        /// The input's name.
        input: String,
        /// The node that it comes from.
        from: Option<String>,
        /// The digest it had.
        old: Option<String>,
        /// The digest it has.
        new: Option<String>,
    },
    /// The node is of another kind.
    Kind {
        /// What it was.
        old: String,
        /// What it is.
        new: String,
    },
    /// A node that it reads from will run.
    Upstream {
        /// That node.
        node: String,
    },
    /// Its record was there and is gone.
    RecordMissing {
        /// Where it lay.
        record: String,
    },
    /// Its record can't be believed.
    RecordDamaged {
        /// Where it lies.
        record: String,
        /// What is wrong with it.
        fault: Fault,
    },
    /// An object is missing or damaged.
    ObjectDamaged {
        /// The artifact's name.
        artifact: String,
        /// Where the object lies.
        object: String,
        /// What is wrong with it.
        fault: Fault,
        /// The output that still has the right bytes, from which it will be brought back.
        restored_from: Option<String>,
    },
    /// Asked for by `--force`.
    Forced,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let or_none = |text: &Option<String>| text.clone().unwrap_or_else(|| "absent".to_owned());
        match self {
            Self::New => f.write_str("it was never run at this address"),
            Self::NoHistory => f.write_str("what it was last run with is no longer in the store"),
            Self::Parameter { leaf, old, new, file, key, line } => {
                write!(f, "{leaf}: {} → {}", or_none(old), or_none(new))?;
                match line {
                    Some(line) => write!(f, " ({file}:{line}, {key})"),
                    None if file.is_empty() => Ok(()),
                    None => write!(f, " ({file})"),
                }
            }
            Self::Code { changes } if changes.is_empty() => f.write_str("code changed"),
            Self::Code { changes } => {
                let names: Vec<String> = changes.iter().map(describe).collect();
                write!(f, "code changed: {}", names.join(", "))
            }
            Self::Input { input, from, old, new } => {
                write!(f, "input {input}: {} → {}", or_none(old), or_none(new))?;
                from.as_ref().map_or(Ok(()), |from| write!(f, " (from {from})"))
            }
            Self::Kind { old, new } => write!(f, "kind: {old} → {new}"),
            Self::Upstream { node } => write!(f, "{node} will run or may run"),
            Self::RecordMissing { record } => write!(f, "its record is missing: {record}"),
            Self::RecordDamaged { record, fault } => write!(f, "its record is {fault}: {record}"),
            Self::ObjectDamaged { artifact, object, fault, restored_from } => {
                write!(f, "stored {artifact} is {fault}: {object}")?;
                restored_from.as_ref().map_or(Ok(()), |path| write!(f, "; restored from {path}"))
            }
            Self::Forced => f.write_str("forced"),
        }
    }
}

fn describe(change: &CodeChange) -> String {
    let short = |value: &String| {
        if change.name.ends_with(".rs") { value[..value.len().min(8)].to_owned() } else { value.clone() }
    };
    match (&change.old, &change.new) {
        (None, _) => format!("{} (new)", change.name),
        (_, None) => format!("{} (gone)", change.name),
        (Some(old), Some(new)) => format!("{} {} → {}", change.name, short(old), short(new)),
    }
}

/// What differs between a node and what was last run at its address. Without `inputs` (their digests are not known yet)
/// inputs are passed over.
pub(super) fn changes(
    graph: &Graph,
    store: &Store,
    node: usize,
    head: Option<Digest>,
    inputs: Option<&[Digest]>,
) -> Vec<Reason> {
    let Some(head) = head else { return vec![Reason::New] };
    let Some(old) = store.manifest(head) else { return vec![Reason::NoHistory] };
    let new = graph.manifest(node, inputs.unwrap_or_default());
    let changes = old.changes(&new);
    let known = changes.iter().filter(|change| change.part != Part::Input || inputs.is_some());
    known.map(|change| reason(graph, store, node, change)).collect()
}

fn reason(graph: &Graph, store: &Store, node: usize, change: &Change) -> Reason {
    let placed = &graph.nodes[node];
    let (old, new) = (change.old.as_ref().map(Leaf::to_string), change.new.as_ref().map(Leaf::to_string));
    match change.part {
        Part::Kind => Reason::Kind { old: old.unwrap_or_default(), new: new.unwrap_or_default() },
        Part::Code => {
            let before = match &change.old {
                Some(Leaf::Digest(digest)) => store.listing(*digest),
                _ => None,
            };
            Reason::Code { changes: before.map(|before| before.changes(&placed.code)).unwrap_or_default() }
        }
        Part::Input => {
            let input = placed.node.inputs.iter().find(|input| input.name == change.path);
            Reason::Input { input: change.path.clone(), from: input.map(|input| input.from.to_string()), old, new }
        }
        Part::Param => {
            let config = &graph.experiments[placed.plan].1;
            let key = locate::config_key(&placed.node.origins, &change.path);
            let line = locate::line(&config.text, &key);
            Reason::Parameter { leaf: change.path.clone(), old, new, file: config.file.clone(), key, line }
        }
    }
}
