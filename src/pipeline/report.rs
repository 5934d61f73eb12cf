//! What a run did, as data. Everything here can be written as JSON.

use super::store::{Fault, StoreError};
use crate::contract::digest::Digest;
use crate::contract::node::Address;
use crate::contract::work::Work;
use serde::{Serialize, Serializer};
use std::time::Duration;

/// Writes an address as people read it.
pub(super) fn as_text<T: std::fmt::Display, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}

fn as_seconds<S: Serializer>(value: &Option<Duration>, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Some(duration) => serializer.serialize_f64(duration.as_secs_f64()),
        None => serializer.serialize_none(),
    }
}

/// Why a node has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// Its work returned an error.
    #[error("{0}")]
    Node(String),
    /// Its work panicked.
    #[error("panicked: {0}")]
    Panic(String),
    /// It reads, or an output shows, an artifact that its maker does not make.
    #[error("{from} makes no {artifact:?}; it makes {made}")]
    NoSuchArtifact {
        /// The node that should make it.
        from: String,
        /// What it should make.
        artifact: String,
        /// What it makes.
        made: String,
    },
    /// It made two artifacts of one name.
    #[error("made two artifacts called {0:?}")]
    DuplicateArtifact(String),
    /// The store can't be used.
    #[error("{0}")]
    Store(StoreError),
}

/// How a node came to its end.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Its result was in the store.
    Cached,
    /// It ran.
    Ran,
    /// Another node of this run, with the same key, ran for it.
    SameAs(#[serde(serialize_with = "as_text")] Address),
    /// It failed.
    Failed(Failure),
    /// A node that it needs failed.
    Blocked(#[serde(serialize_with = "as_text")] Address),
    /// The run ended before its turn (`fail_fast`, or a store that can't be used).
    NotReached,
}

/// One node of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NodeReport {
    /// Where it stands.
    #[serde(serialize_with = "as_text")]
    pub address: Address,
    /// Its kind.
    pub kind: &'static str,
    /// Its key, when it is known.
    pub key: Option<Digest>,
    /// The key it had in the last run that settled it.
    pub previous: Option<Digest>,
    /// How it came to its end.
    pub status: Status,
    /// Its work, as stored or as done now.
    pub work: Option<Work>,
    /// How long it took, when it ran now.
    #[serde(rename = "seconds", serialize_with = "as_seconds")]
    pub duration: Option<Duration>,
    /// Artifacts that came out otherwise than the store had them under the same key: work that is not reproducible.
    pub differs: Vec<String>,
}

/// What became of an output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExportStatus {
    /// Its bytes were right.
    Unchanged,
    /// It was not there before.
    New,
    /// It has new content.
    Updated,
    /// It was deleted, edited or damaged since it was made, and is right again.
    Repaired(Fault),
    /// Something that this store never made stood in its place.
    Replaced,
    /// It can't be written.
    Failed(StoreError),
    /// The node has no such artifact.
    NoSuchArtifact(Failure),
    /// Its node has no result.
    NotMade,
}

/// One output of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ExportReport {
    /// Its path below the output folder.
    pub path: String,
    /// The node that makes it.
    #[serde(serialize_with = "as_text")]
    pub from: Address,
    /// The digest of its bytes, when it is known.
    pub object: Option<Digest>,
    /// What became of it.
    pub status: ExportStatus,
}

/// What was damaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Subject {
    /// A record.
    Record,
    /// An object.
    Object,
    /// A stored code listing.
    Listing,
    /// The memory of an experiment's last keys.
    Heads,
    /// The memory of what the last whole run left settled.
    Settled,
    /// The marker of the store's format.
    Format,
    /// A file in the output folder.
    Output,
}

/// What was done about damage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Repair {
    /// Brought back from the store.
    FromStore,
    /// Brought back from the file in the output folder, whose bytes were right.
    FromOutput,
    /// The node runs again.
    RunAgain,
    /// Written anew.
    Rewritten,
}

/// Something that was damaged or missing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Damage {
    /// What kind of thing.
    pub subject: Subject,
    /// Where it lies.
    pub path: String,
    /// The node that it belongs to.
    pub address: Option<String>,
    /// What is wrong with it.
    pub fault: Fault,
    /// What was done about it.
    pub repair: Repair,
}

impl std::fmt::Display for Damage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let subject = match self.subject {
            Subject::Record => "record",
            Subject::Object => "stored object",
            Subject::Listing => "stored code listing",
            Subject::Heads => "memory of last keys",
            Subject::Settled => "memory of the last settled run",
            Subject::Format => "marker of the store's format",
            Subject::Output => "output",
        };
        let repair = match self.repair {
            Repair::FromStore => "restored from the store",
            Repair::FromOutput => "restored from the output folder",
            Repair::RunAgain => "the node runs again",
            Repair::Rewritten => "written anew",
        };
        write!(f, "{subject} {} was {}: {repair}", self.path, self.fault)
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Everything is as it should be.
    Success,
    /// A node failed.
    NodeFailed,
    /// The store or the output folder can't be used.
    StoreFailed,
}

/// What a run did.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Report {
    /// The nodes, each after those that it reads from.
    pub nodes: Vec<NodeReport>,
    /// The outputs.
    pub exports: Vec<ExportReport>,
    /// What was damaged, and what was done about it.
    pub damage: Vec<Damage>,
    /// Files in the output folder that no experiment makes.
    pub unknown_files: Vec<String>,
    /// What kept the store or the output folder from being used.
    pub store_errors: Vec<StoreError>,
    /// What could not be remembered (heads, the log of runs), though all results are right.
    pub warnings: Vec<String>,
    /// What is worth knowing about the store: other formats beside it, one that was set aside.
    pub notes: Vec<String>,
    /// How long the run took.
    #[serde(skip)]
    pub elapsed: Duration,
}

impl Report {
    /// How the run ended.
    pub fn outcome(&self) -> Outcome {
        let is_failed = |node: &NodeReport| matches!(node.status, Status::Failed(_));
        let is_defect = |export: &ExportReport| matches!(export.status, ExportStatus::NoSuchArtifact(_));
        if !self.store_errors.is_empty() {
            Outcome::StoreFailed
        } else if self.nodes.iter().any(is_failed) || self.exports.iter().any(is_defect) {
            Outcome::NodeFailed
        } else {
            Outcome::Success
        }
    }

    /// The report of the node at an address.
    pub fn node(&self, address: &Address) -> Option<&NodeReport> {
        self.nodes.iter().find(|node| node.address == *address)
    }

    /// How many nodes have a status of this kind.
    pub fn count(&self, is: impl Fn(&Status) -> bool) -> usize {
        self.nodes.iter().filter(|node| is(&node.status)).count()
    }

    /// How many nodes ran.
    pub fn ran(&self) -> usize {
        self.count(|status| *status == Status::Ran)
    }

    /// The nodes that failed, with why.
    pub fn failures(&self) -> impl Iterator<Item = (&Address, &Failure)> {
        self.nodes.iter().filter_map(|node| match &node.status {
            Status::Failed(failure) => Some((&node.address, failure)),
            _ => None,
        })
    }

    /// The outputs whose bytes were written.
    pub fn written(&self) -> impl Iterator<Item = &ExportReport> {
        let is_written = |export: &&ExportReport| {
            let status = &export.status;
            matches!(
                status,
                ExportStatus::New | ExportStatus::Updated | ExportStatus::Repaired(_) | ExportStatus::Replaced
            )
        };
        self.exports.iter().filter(is_written)
    }
}
