//! A run: brings the store and the output folder to where the graph says they should be.

use super::events::Events;
use super::exports;
use super::format::Notice;
use super::graph::Graph;
use super::heads::{self, Head, Heads};
use super::report::{Damage, ExportReport, ExportStatus, NodeReport, Repair, Report, Status, Subject};
use super::runs::PastRun;
use super::schedule::Scheduler;
use super::select::Selection;
use super::settled::{self, Question};
use super::store::{Session, Store, StoreError};
use crate::contract::digest::Digest;
use crate::contract::plan::Export;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// How to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// The folder that the configs belong to: with `out`, it says whose heads these are.
    pub root: PathBuf,
    /// The output folder.
    pub out: PathBuf,
    /// How many nodes may run at once (and how many threads hash).
    pub jobs: usize,
    /// Run the selected nodes even when the store has their results.
    pub force: bool,
    /// Start nothing more once a node has failed.
    pub fail_fast: bool,
    /// The paths of all outputs that any experiment makes: other files in the output folder are reported. None: not looked at.
    pub known_exports: Option<BTreeSet<String>>,
    /// Paths below the output folder that are not looked at: `measured`, `article`, `draft`.
    pub unscanned: Vec<String>,
    /// What this run answers, when it is of the whole: if everything is settled, the next one need not plan to know it.
    pub question: Option<Question>,
}

impl Options {
    /// The usual: as many nodes at once as there are processors, nothing forced, strays not looked for.
    pub fn new(root: impl Into<PathBuf>, out: impl Into<PathBuf>) -> Self {
        Self {
            root: root.into(),
            out: out.into(),
            jobs: std::thread::available_parallelism().map_or(1, usize::from),
            force: false,
            fail_fast: false,
            known_exports: None,
            unscanned: Vec::new(),
            question: None,
        }
    }
}

/// How long a run waits before it tries a held store again.
pub(super) const STORE_POLL: Duration = Duration::from_millis(10);

/// Runs what is selected. Never panics on what it finds on the disk; everything that went wrong is in the report.
pub fn run(graph: &Graph, selection: &Selection, store: &Store, options: &Options, events: &mut dyn Events) -> Report {
    let (began, clock) = (SystemTime::now(), Instant::now());
    events.planned(selection.nodes.len(), selection.exports.len());
    let session = begin(store, events);
    let view = heads::view(&options.root, &options.out);
    let (heads, mut damage) = read_heads(graph, selection, store, &view);
    // In a store that can't be used nothing will be written anew.
    damage.retain(|_| session.is_ok());
    let mut notes = Vec::new();
    for notice in session.iter().flat_map(|session| &session.notices) {
        match notice {
            Notice::Damaged(marker, fault) => damage.push(Damage {
                subject: Subject::Format,
                path: marker.display().to_string(),
                address: None,
                fault: fault.clone(),
                repair: Repair::Rewritten,
            }),
            notice => {
                notes.push(notice.to_string());
                events.noted(&notice.to_string());
            }
        }
    }
    damage.iter().for_each(|damage| events.damaged(damage));
    let mut scheduler = Scheduler::new(graph, selection, store, options, &heads, events);
    scheduler.damage = damage;
    match &session {
        Ok(_) => scheduler.drive(),
        Err(error) => scheduler.store_errors.push(error.clone()),
    }
    let listings = std::mem::take(&mut scheduler.listings);
    let mut report = assemble(graph, selection, &heads, scheduler);
    report.notes = notes;
    report.elapsed = clock.elapsed();
    let Ok(session) = session else { return report };
    sync_folders(&mut report, store, options);
    keep_listings(graph, selection, store, &listings, &mut report, events);
    remember_heads(graph, selection, store, &view, &heads, &mut report);
    remember_settled(graph, selection, store, options, &mut report, events);
    report.elapsed = clock.elapsed();
    let superseded = superseded(graph, selection, &heads, &report);
    if let Some(past) = PastRun::of(&report, &selection.targets, superseded, began, report.elapsed)
        && let Err(error) = store.remember(&past)
    {
        report.warnings.push(format!("this run is not in the log: {error}"));
    }
    find_strays(store, session, options, &mut report, events);
    report.elapsed = clock.elapsed();
    report
}

fn begin(store: &Store, events: &mut dyn Events) -> Result<Session, StoreError> {
    let mut is_told = false;
    store.begin(&mut || {
        if !std::mem::replace(&mut is_told, true) {
            events.waiting(None, "a process that has the store for itself");
        }
        std::thread::sleep(STORE_POLL);
    })
}

/// The plans that have a node or an export in the selection.
fn plans(graph: &Graph, selection: &Selection) -> BTreeSet<usize> {
    let nodes = selection.nodes.iter().map(|node| graph.nodes[*node].plan);
    nodes.chain(selection.exports.iter().map(|export| graph.exports[*export].plan)).collect()
}

/// Heads by plan; empty for plans that are not selected.
pub(super) fn read_heads(graph: &Graph, selection: &Selection, store: &Store, view: &str) -> (Vec<Heads>, Vec<Damage>) {
    let mut heads = vec![Heads::default(); graph.experiments.len()];
    let mut damage = Vec::new();
    for plan in plans(graph, selection) {
        let id = &graph.experiments[plan].0;
        let (found, fault) = store.heads(view, id);
        heads[plan] = found;
        damage.extend(fault.map(|fault| Damage {
            subject: Subject::Heads,
            path: store.heads_name(view, id),
            address: None,
            fault,
            repair: Repair::Rewritten,
        }));
    }
    (heads, damage)
}

fn assemble(graph: &Graph, selection: &Selection, heads: &[Heads], scheduler: Scheduler<'_>) -> Report {
    let mut slots = scheduler.slots;
    let nodes = selection.nodes.iter().map(|&node| {
        let placed = &graph.nodes[node];
        let slot = std::mem::take(&mut slots[node]);
        NodeReport {
            previous: heads[placed.plan].nodes.get(&placed.node.address.to_string()).map(|head| head.key),
            address: placed.node.address.clone(),
            kind: placed.node.compute.kind().name,
            key: slot.key,
            status: slot.status.unwrap_or(Status::NotReached),
            work: slot.record.map(|record| record.work),
            duration: slot.duration,
            differs: slot.differs,
        }
    });
    let nodes = nodes.collect();
    let mut brought = scheduler.exports;
    let exports = selection.exports.iter().map(|&export| {
        let Export { path, from, .. } = graph.exports[export].export.clone();
        brought[export].take().unwrap_or(ExportReport { path, from, object: None, status: ExportStatus::NotMade })
    });
    Report {
        nodes,
        exports: exports.collect(),
        damage: scheduler.damage,
        unknown_files: Vec::new(),
        store_errors: scheduler.store_errors,
        warnings: Vec::new(),
        notes: Vec::new(),
        elapsed: Duration::ZERO,
    }
}

/// Syncs the folders that outputs were written to, each once.
fn sync_folders(report: &mut Report, store: &Store, options: &Options) {
    let file = |export: &ExportReport| exports::file_of(&options.out, &export.path);
    let folders: BTreeSet<PathBuf> =
        report.written().filter_map(|export| file(export).parent().map(Path::to_owned)).collect();
    for folder in folders {
        if let Err(error) = store.disk().sync_folder(&folder) {
            report.store_errors.push(error.into());
        }
    }
}

/// The code listings of all settled kinds are in the store, whole: `why` needs them after the next change.
fn keep_listings(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    written: &HashSet<Digest>,
    report: &mut Report,
    events: &mut dyn Events,
) {
    let is_cached = |index: usize| report.nodes[index].status == Status::Cached;
    let cached = selection.nodes.iter().enumerate().filter(|(index, _)| is_cached(*index));
    let codes: BTreeMap<Digest, usize> = cached.map(|(_, &node)| (graph.nodes[node].code.digest, node)).collect();
    for (digest, node) in codes.into_iter().filter(|(digest, _)| !written.contains(digest)) {
        let Some(fault) = store.object_fault(digest) else { continue };
        if let Err(error) = store.put(graph.nodes[node].code.text().as_bytes()) {
            report.warnings.push(format!("a code listing is damaged and can't be repaired: {error}"));
            continue;
        }
        let path = store.object_path(digest).display().to_string();
        let damage = Damage { subject: Subject::Listing, path, address: None, fault, repair: Repair::Rewritten };
        events.damaged(&damage);
        report.damage.push(damage);
    }
}

/// Writes down the last keys, for the experiments where they changed.
fn remember_heads(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    view: &str,
    before: &[Heads],
    report: &mut Report,
) {
    let mut nodes: BTreeMap<usize, Vec<(String, Digest, Option<Duration>)>> = BTreeMap::new();
    for (&node, done) in selection.nodes.iter().zip(&report.nodes) {
        let is_settled = matches!(done.status, Status::Cached | Status::Ran | Status::SameAs(_));
        if let (true, Some(key)) = (is_settled, done.key) {
            let entry = nodes.entry(graph.nodes[node].plan).or_default();
            entry.push((done.address.to_string(), key, done.duration));
        }
    }
    let mut outputs: BTreeMap<usize, Vec<(String, Digest)>> = BTreeMap::new();
    for (&export, done) in selection.exports.iter().zip(&report.exports) {
        if let (Some(object), false) = (done.object, matches!(done.status, ExportStatus::Failed(_))) {
            outputs.entry(graph.exports[export].plan).or_default().push((done.path.clone(), object));
        }
    }
    for plan in plans(graph, selection) {
        let (nodes, outputs) = (nodes.remove(&plan).unwrap_or_default(), outputs.remove(&plan).unwrap_or_default());
        let is_damaged = report.damage.iter().any(|damage| {
            damage.subject == Subject::Heads && damage.path == store.heads_name(view, &graph.experiments[plan].0)
        });
        let (planned, paths) = planned(graph, plan);
        let change = |heads: &mut Heads| {
            for (address, key, duration) in &nodes {
                let micros = duration.map(|duration| u64::try_from(duration.as_micros()).unwrap_or(u64::MAX));
                let kept = heads.nodes.get(address).and_then(|head| head.micros);
                heads.nodes.insert(address.clone(), Head { key: *key, micros: micros.or(kept), live: true });
            }
            heads.nodes.iter_mut().for_each(|(address, head)| head.live &= planned.contains(address));
            heads.exports.extend(outputs.iter().cloned());
            heads.exports.retain(|path, _| paths.contains(path));
        };
        let mut after = before[plan].clone();
        change(&mut after);
        if (after != before[plan] || is_damaged)
            && let Err(error) = store.update_heads(view, &graph.experiments[plan].0, change)
        {
            report.warnings.push(format!("the keys of {} are not remembered: {error}", graph.experiments[plan].0));
        }
    }
}

/// Writes down what a whole run left. It saves time and nothing else, so a store that can't be written is no matter here.
fn remember_settled(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    options: &Options,
    report: &mut Report,
    events: &mut dyn Events,
) {
    let Some(question) = &options.question else { return };
    if let Some((path, fault)) = settled::fault(store, options) {
        let path = path.display().to_string();
        let damage = Damage { subject: Subject::Settled, path, address: None, fault, repair: Repair::Rewritten };
        events.damaged(&damage);
        report.damage.push(damage);
    }
    let _ = settled::remember(graph, selection, store, options, question, report);
}

/// The keys that were the last ones of their addresses before this run and no longer are: what `gc --keep` needs to know
/// about past runs.
fn superseded(graph: &Graph, selection: &Selection, before: &[Heads], report: &Report) -> Vec<Digest> {
    let is_settled = |node: &NodeReport| matches!(node.status, Status::Cached | Status::Ran | Status::SameAs(_));
    let now: BTreeMap<String, Option<Digest>> =
        report.nodes.iter().filter(|node| is_settled(node)).map(|node| (node.address.to_string(), node.key)).collect();
    let mut gone = BTreeSet::new();
    for plan in plans(graph, selection) {
        let (planned, _) = planned(graph, plan);
        for (address, head) in before[plan].nodes.iter().filter(|(_, head)| head.live) {
            let is_other = now.get(address).is_some_and(|key| *key != Some(head.key));
            if is_other || !planned.contains(address) {
                gone.insert(head.key);
            }
        }
    }
    gone.into_iter().collect()
}

/// All addresses and paths of a plan, selected or not.
fn planned(graph: &Graph, plan: usize) -> (BTreeSet<String>, BTreeSet<String>) {
    let nodes = graph.nodes.iter().filter(|placed| placed.plan == plan);
    let paths = graph.exports.iter().filter(|placed| placed.plan == plan);
    (nodes.map(|p| p.node.address.to_string()).collect(), paths.map(|p| p.export.path.clone()).collect())
}

fn find_strays(store: &Store, session: Session, options: &Options, report: &mut Report, events: &mut dyn Events) {
    let Some(known) = &options.known_exports else { return };
    match exports::strays(store.disk(), &options.out, known, &options.unscanned) {
        Ok(strays) => {
            strays.unknown.iter().for_each(|path| events.unknown_file(path));
            report.unknown_files = strays.unknown;
            // Written beside the outputs only where the store is on another file system, and left there by killed runs.
            if !strays.temporary.is_empty() && store.end(session) {
                strays.temporary.iter().for_each(|file| drop(store.disk().remove(file)));
            }
        }
        Err(error) => report.warnings.push(format!("the output folder was not looked through: {error}")),
    }
}
