//! Reads the whole store, believing nothing, and computes a sample of it again.
//!
//! Every record: its checksum, its key, the key of the manifest inside; every object: its hash against its name; every
//! object and code listing that a record names, and every record that a last run had: whether it is there; every file of
//! heads: its checksum. What is found damaged is only reported: the next run that needs it repairs it, and `gc` drops
//! what no run needs.
//!
//! Then stored nodes of the present graph are computed again from their stored inputs, one after the other (each uses all
//! cores inside), and every artifact's bytes and the counted work are compared. A difference is a defect of the
//! program: its result depends on something that is not in its key. Measurements hold times and are never in the sample.
//! Which nodes make the sample is decided by a hash of key and seed: the same every time, until the seed changes.

use super::events::Events;
use super::forecast::{Prospect, forecast};
use super::graph::Graph;
use super::parallel;
use super::record::Record;
use super::report::{Failure, Subject, as_text};
use super::run::{Options, STORE_POLL};
use super::select::Selection;
use super::start::STACK;
use super::store::{Fault, Store, StoreError};
use super::work;
use crate::contract::digest::{Digest, Framed};
use crate::contract::manifest::Manifest;
use crate::contract::node::Address;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::PathBuf;
use std::thread::Builder;
use std::time::Instant;

/// How much to compute again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// How many nodes; `usize::MAX` for all.
    pub nodes: usize,
    /// Another seed takes another sample.
    pub seed: u64,
}

/// Something damaged.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What kind of thing.
    pub subject: Subject,
    /// Where it lies.
    pub path: String,
    /// What is wrong with it.
    pub fault: Fault,
    /// The nodes of the present graph that it belongs to.
    pub addresses: Vec<String>,
}

/// How a node came out when it was computed again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// To the bit as it is stored.
    Same,
    /// These artifacts (or `work`) came out otherwise.
    Differs(Vec<String>),
    /// It failed, though it once succeeded with the same inputs.
    Failed(Failure),
}

/// A node that was computed again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Recomputed {
    /// Where it stands.
    #[serde(serialize_with = "as_text")]
    pub address: Address,
    /// Its key.
    pub key: Digest,
    /// How it came out.
    pub outcome: Outcome,
    /// How long it took, in seconds.
    pub seconds: f64,
}

/// What was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verified {
    /// Records read.
    pub records: usize,
    /// Objects hashed, code listings among them.
    pub objects: usize,
    /// Files of heads read.
    pub heads: usize,
    /// Bytes read.
    pub bytes: u64,
    /// What is damaged.
    pub damage: Vec<Finding>,
    /// Files among records and objects that are neither.
    pub foreign: Vec<String>,
    /// Objects that no record names: left by killed runs, dropped by `gc`.
    pub unnamed: usize,
    /// Nodes of the present graph that are stored whole and are no measurements.
    pub stored: usize,
    /// Those of them that were computed again.
    pub recomputed: Vec<Recomputed>,
}

impl Verified {
    /// Whether a node came out otherwise than stored.
    pub fn is_reproducible(&self) -> bool {
        self.recomputed.iter().all(|node| node.outcome == Outcome::Same)
    }
}

/// Reads the whole store and computes a sample of the selected nodes again. Writes nothing.
///
/// # Errors
/// A store that can't be listed, or is of another format. Damage is no error: it is what this is for.
pub fn verify(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    options: &Options,
    sample: Sample,
    events: &mut dyn Events,
) -> Result<Verified, StoreError> {
    let mut is_told = false;
    let session = store.begin_looking(&mut || {
        if !std::mem::replace(&mut is_told, true) {
            events.waiting(None, "a process that has the store for itself");
        }
        std::thread::sleep(STORE_POLL);
    })?;
    let Some(_session) = session else { return Ok(Verified::default()) };
    let forecast_options = Options { force: false, ..options.clone() };
    let forecast = forecast(graph, selection, store, &forecast_options);
    let mut addresses: BTreeMap<Digest, Vec<String>> = BTreeMap::new();
    for (key, address) in forecast.nodes.iter().filter_map(|node| Some((node.key?, &node.address))) {
        addresses.entry(key).or_default().push(address.to_string());
    }
    let mut verified = read_all(store, options.jobs, &addresses)?;

    let mut records: HashMap<usize, Record> = HashMap::new();
    let mut candidates = Vec::new();
    for (&node, seen) in selection.nodes.iter().zip(&forecast.nodes) {
        if let (Prospect::UpToDate, Some(key)) = (seen.prospect, seen.key)
            && let Ok(record) = store.record(key)
        {
            records.insert(node, record);
            if !graph.nodes[node].node.compute.kind().measurement {
                candidates.push((rank(key, sample.seed), key, node));
            }
        }
    }
    candidates.sort_unstable();
    candidates.dedup_by_key(|(_, key, _)| *key);
    verified.stored = candidates.len();
    candidates.truncate(sample.nodes);
    for (_, key, node) in candidates {
        let address = graph.address(node).clone();
        events.started(&address, None);
        let begun = Instant::now();
        let Some(outcome) = again(graph, store, node, &records) else { continue };
        let duration = begun.elapsed();
        events.finished(&address, duration, &records.get(&node).map(|record| record.work).unwrap_or_default());
        // An input that can't be read is damage, and told as such: nothing is known of the node that reads it.
        if matches!(outcome, Outcome::Failed(Failure::Store(_))) {
            continue;
        }
        verified.recomputed.push(Recomputed { address, key, outcome, seconds: duration.as_secs_f64() });
    }
    Ok(verified)
}

fn rank(key: Digest, seed: u64) -> Digest {
    let mut framed = Framed::new("polhode sample 1");
    framed.field(&seed.to_le_bytes());
    framed.field(&key.0);
    framed.finish()
}

/// Computes one node again, on a thread with the stack that a run gives it. None where an input's node is not stored whole.
fn again(graph: &Graph, store: &Store, node: usize, records: &HashMap<usize, Record>) -> Option<Outcome> {
    let placed = &graph.nodes[node];
    let (mut logical, mut objects) = (Vec::new(), Vec::new());
    for (input, from) in placed.node.inputs.iter().zip(&placed.inputs) {
        let output = records.get(from).and_then(|record| record.output(&input.artifact))?;
        logical.push(output.logical);
        objects.push(output.object);
    }
    let stored = records.get(&node)?;
    let outcome = std::thread::scope(|scope| {
        let act = || work::recompute(graph, store, node, stored, &logical, &objects);
        let thread = Builder::new().stack_size(STACK).spawn_scoped(scope, act);
        match thread.map(std::thread::ScopedJoinHandle::join) {
            Ok(Ok(outcome)) => outcome,
            Ok(Err(_)) => Err(Failure::Panic("outside the node's own work".to_owned())),
            Err(error) => Err(Failure::Node(format!("can't start a thread: {error}"))),
        }
    });
    Some(match outcome {
        Ok(differing) if differing.is_empty() => Outcome::Same,
        Ok(differing) => Outcome::Differs(differing),
        Err(failure) => Outcome::Failed(failure),
    })
}

/// Reads every record, object and file of heads.
fn read_all(store: &Store, jobs: usize, addresses: &BTreeMap<Digest, Vec<String>>) -> Result<Verified, StoreError> {
    let mut verified = Verified::default();
    let mut named: BTreeMap<Digest, (Subject, BTreeSet<Digest>)> = BTreeMap::new();
    read_records(store, jobs, addresses, &mut named, &mut verified)?;
    read_objects(store, jobs, addresses, &named, &mut verified)?;
    let mut lost: BTreeMap<Digest, Vec<String>> = BTreeMap::new();
    for (view, experiment, heads) in store.all_heads()? {
        verified.heads += 1;
        match heads {
            Ok(heads) => {
                let live = heads.nodes.into_iter().filter(|(_, head)| head.live);
                live.for_each(|(address, head)| lost.entry(head.key).or_default().push(address));
            }
            Err(fault) => {
                let path = store.heads_name(&view, &experiment);
                verified.damage.push(Finding { subject: Subject::Heads, path, fault, addresses: Vec::new() });
            }
        }
    }
    // A last run had a record under each of these.
    lost.retain(|key, _| !store.record_path(*key).exists());
    verified.damage.extend(lost.into_iter().map(|(key, addresses)| Finding {
        subject: Subject::Record,
        path: store.record_path(key).display().to_string(),
        fault: Fault::Missing,
        addresses,
    }));
    Ok(verified)
}

fn read_records(
    store: &Store,
    jobs: usize,
    addresses: &BTreeMap<Digest, Vec<String>>,
    named: &mut BTreeMap<Digest, (Subject, BTreeSet<Digest>)>,
    verified: &mut Verified,
) -> Result<(), StoreError> {
    let folder = store.folder().join("records");
    let mut keys = Vec::new();
    for entry in store.list_if_there(&folder)? {
        match entry.name.parse::<Digest>() {
            Ok(key) => keys.push(key),
            Err(_) => verified.foreign.push(folder.join(&entry.name).display().to_string()),
        }
    }
    let read = parallel::map(&keys, jobs, |key| -> Result<(Record, Manifest, u64), Fault> {
        let text = store.disk().read(&store.record_path(*key))?;
        let record = Record::from_text(&text, *key).map_err(|_| Fault::Altered)?;
        let manifest = Record::manifest_from_text(&text, *key).map_err(|_| Fault::Altered)?;
        Ok((record, manifest, text.len() as u64))
    });
    for (key, read) in keys.into_iter().zip(read) {
        verified.records += 1;
        match read {
            Ok((record, manifest, size)) => {
                verified.bytes += size;
                for output in &record.outputs {
                    named.entry(output.object).or_insert((Subject::Object, BTreeSet::new())).1.insert(key);
                }
                if let Some(code) = manifest.code() {
                    named.entry(code).or_insert((Subject::Listing, BTreeSet::new())).1.insert(key);
                }
            }
            Err(fault) => verified.damage.push(Finding {
                subject: Subject::Record,
                path: store.record_path(key).display().to_string(),
                fault,
                addresses: addresses.get(&key).cloned().unwrap_or_default(),
            }),
        }
    }
    Ok(())
}

fn read_objects(
    store: &Store,
    jobs: usize,
    addresses: &BTreeMap<Digest, Vec<String>>,
    named: &BTreeMap<Digest, (Subject, BTreeSet<Digest>)>,
    verified: &mut Verified,
) -> Result<(), StoreError> {
    let present: Vec<(Digest, PathBuf)> = store.all_objects()?;
    let sizes = parallel::map(&present, jobs, |(object, path)| match store.disk().hash(path) {
        Ok((found, size)) if found == *object => Ok(size),
        Ok(_) => Err(Fault::Altered),
        Err(error) => Err(Fault::from(error)),
    });
    let mut faults: Vec<(Digest, Fault)> = Vec::new();
    for ((object, _), size) in present.iter().zip(sizes) {
        verified.objects += 1;
        verified.unnamed += usize::from(!named.contains_key(object));
        match size {
            Ok(size) => verified.bytes += size,
            Err(fault) => faults.push((*object, fault)),
        }
    }
    let there: BTreeSet<Digest> = present.into_iter().map(|(object, _)| object).collect();
    faults.extend(named.keys().filter(|object| !there.contains(*object)).map(|object| (*object, Fault::Missing)));
    for (object, fault) in faults {
        let owners = named.get(&object);
        let keys = owners.map(|(_, keys)| keys.iter()).into_iter().flatten();
        verified.damage.push(Finding {
            subject: owners.map_or(Subject::Object, |(subject, _)| *subject),
            path: store.object_path(object).display().to_string(),
            fault,
            addresses: keys.filter_map(|key| addresses.get(key)).flatten().cloned().collect(),
        });
    }
    Ok(())
}
