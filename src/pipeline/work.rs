//! One node's work, on a thread of its own: read the inputs, compute, store, bring its outputs. No decision is made here.

use super::exports::{self, Wanted};
use super::graph::Graph;
use super::record::{Output, Record};
use super::report::{ExportStatus, Failure};
use super::store::{Fault, Put, Store, StoreError};
use crate::contract::digest::Digest;
use crate::contract::node::{Artifact, InputFile, Inputs};
use crate::contract::work::Work;
use std::any::Any;
use std::collections::BTreeSet;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// An export that a job brings when its node is done.
#[derive(Debug)]
pub(super) struct Outgoing {
    pub(super) export: usize,
    pub(super) artifact: String,
    pub(super) file: PathBuf,
    pub(super) last: Option<Digest>,
}

/// A node about to run.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) node: usize,
    pub(super) key: Digest,
    /// The logical digests of its inputs, in their order.
    pub(super) logical: Vec<Digest>,
    /// Their objects.
    pub(super) objects: Vec<Digest>,
    /// What the store had under this key, when it ran for that reason or by force.
    pub(super) previous: Option<Record>,
    pub(super) outgoing: Vec<Outgoing>,
    /// Held until the record is written.
    pub(super) lock: File,
}

/// A node that ran.
#[derive(Debug)]
pub(super) struct Done {
    pub(super) record: Record,
    pub(super) duration: Duration,
    pub(super) differs: Vec<String>,
    pub(super) exports: Vec<(usize, Option<Digest>, ExportStatus)>,
    /// Stored objects that were damaged and are right again, since this node makes the same bytes.
    pub(super) replaced: Vec<(Digest, Fault)>,
}

/// Does a job. A panic is a failure of the node.
pub(super) fn execute(graph: &Graph, store: &Store, job: Job) -> Result<Done, Failure> {
    let done = catch_unwind(AssertUnwindSafe(|| attempt(graph, store, job)));
    done.unwrap_or_else(|panic| Err(Failure::Panic(words(panic.as_ref()))))
}

fn attempt(graph: &Graph, store: &Store, job: Job) -> Result<Done, Failure> {
    let (made, duration) = compute(graph, store, job.node, &job.logical, &job.objects)?;
    let (record, replaced) = keep(graph, store, &job, &made).map_err(Failure::Store)?;
    // From here on another run finds the result in the store.
    drop(job.lock);
    // A measurement comes out otherwise each time, and that is no fault of it.
    let pinned = job.previous.as_ref().filter(|_| !graph.nodes[job.node].node.compute.kind().measurement);
    let differs = pinned.map_or_else(Vec::new, |previous| differing(previous, &record));
    let exports = job.outgoing.iter().map(|outgoing| bring(graph, store, &record, &made, outgoing)).collect();
    Ok(Done { record, duration, differs, exports, replaced })
}

/// What a node made, as files.
struct Made {
    files: Vec<MadeFile>,
    work: Work,
}

struct MadeFile {
    name: String,
    bytes: Arc<Vec<u8>>,
    logical: Digest,
}

/// Reads the inputs of a node, whose logical digests and objects are given in their order, computes, and writes what it made as
/// files. The time is that of computing.
fn compute(
    graph: &Graph,
    store: &Store,
    node: usize,
    logical: &[Digest],
    objects: &[Digest],
) -> Result<(Made, Duration), Failure> {
    let placed = &graph.nodes[node];
    let mut inputs = Inputs::default();
    for ((input, object), logical) in placed.node.inputs.iter().zip(objects).zip(logical) {
        let bytes = store.object(*object).map_err(|_| Failure::Store(StoreError::Rotted { object: *object }))?;
        inputs.insert(&input.name, InputFile { bytes: Arc::new(bytes), logical: *logical });
    }
    let begun = Instant::now();
    let product = placed.node.compute.run(&inputs).map_err(|error| Failure::Node(error.message))?;
    let duration = begun.elapsed();
    let mut names = BTreeSet::new();
    if let Some(twice) = product.artifacts.iter().find(|artifact| !names.insert(&artifact.name)) {
        return Err(Failure::DuplicateArtifact(twice.name.clone()));
    }
    let made_from = placed.node.made_from();
    let file = |artifact: &Artifact| {
        let bytes = artifact.bytes(&made_from).map_err(|error| Failure::Node(error.message))?;
        Ok(MadeFile { name: artifact.name.clone(), bytes, logical: artifact.logical })
    };
    let files = product.artifacts.iter().map(file).collect::<Result<_, Failure>>()?;
    Ok((Made { files, work: product.work }, duration))
}

/// Computes a stored node again, storing nothing: the artifacts that come out otherwise, `work` among them.
pub(super) fn recompute(
    graph: &Graph,
    store: &Store,
    node: usize,
    stored: &Record,
    logical: &[Digest],
    objects: &[Digest],
) -> Result<Vec<String>, Failure> {
    let attempt = || {
        let (made, _) = compute(graph, store, node, logical, objects)?;
        let outputs = made.files.iter().map(|file| Output {
            name: file.name.clone(),
            object: Digest::of(&file.bytes),
            logical: file.logical,
            size: file.bytes.len() as u64,
        });
        Ok(differing(stored, &Record { key: stored.key, outputs: outputs.collect(), work: made.work }))
    };
    let done = catch_unwind(AssertUnwindSafe(attempt));
    done.unwrap_or_else(|panic| Err(Failure::Panic(words(panic.as_ref()))))
}

/// Stores what was made: objects first, then the record that names them.
fn keep(graph: &Graph, store: &Store, job: &Job, made: &Made) -> Result<(Record, Vec<(Digest, Fault)>), StoreError> {
    let mut outputs = Vec::with_capacity(made.files.len());
    let mut replaced = Vec::new();
    for file in &made.files {
        let (object, put) = store.put(&file.bytes)?;
        if let Put::Replaced(fault) = put {
            replaced.push((object, fault));
        }
        let size = file.bytes.len() as u64;
        outputs.push(Output { name: file.name.clone(), object, logical: file.logical, size });
    }
    let record = Record { key: job.key, outputs, work: made.work };
    // A damaged record may be what brought us here: only one that is there, whole and equal, is left alone.
    if store.record(job.key).as_ref() != Ok(&record) {
        store.write_record(&record, &graph.manifest(job.node, &job.logical))?;
    }
    Ok((record, replaced))
}

fn differing(previous: &Record, now: &Record) -> Vec<String> {
    let differs = |output: &&Output| now.output(&output.name) != Some(*output);
    let mut names: BTreeSet<String> =
        previous.outputs.iter().filter(differs).map(|output| output.name.clone()).collect();
    names.extend(now.outputs.iter().filter(|o| previous.output(&o.name).is_none()).map(|o| o.name.clone()));
    if previous.work != now.work {
        names.insert("work".to_owned());
    }
    names.into_iter().collect()
}

fn bring(
    graph: &Graph,
    store: &Store,
    record: &Record,
    made: &Made,
    outgoing: &Outgoing,
) -> (usize, Option<Digest>, ExportStatus) {
    let export = outgoing.export;
    let file = made.files.iter().find(|file| file.name == outgoing.artifact);
    let (Some(output), Some(file)) = (record.output(&outgoing.artifact), file) else {
        let failure = no_such_artifact(graph, graph.exports[export].node, record, &outgoing.artifact);
        return (export, None, ExportStatus::NoSuchArtifact(failure));
    };
    let wanted = Wanted { file: outgoing.file.clone(), object: output.object, last: outgoing.last };
    (export, Some(output.object), exports::bring(store, &wanted, Some(&file.bytes)))
}

/// The failure of whoever asks for an artifact that a node does not make.
pub(super) fn no_such_artifact(graph: &Graph, from: usize, record: &Record, artifact: &str) -> Failure {
    let made: Vec<&str> = record.outputs.iter().map(|output| output.name.as_str()).collect();
    let made = if made.is_empty() { "nothing".to_owned() } else { made.join(", ") };
    Failure::NoSuchArtifact { from: graph.address(from).to_string(), artifact: artifact.to_owned(), made }
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "without a message".to_owned())
}
