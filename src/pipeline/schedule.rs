//! The scheduler: decides what is sound in the store and what runs, and when.
//!
//! It lives on the thread that called the run, outside rayon's pool. A node passes these states:
//!
//! ```text
//! waiting for inputs → ready → (key made, store examined) → settled from the store
//!                                                         → queued → running → settled, or failed
//!                                                         → twin of a queued or running node with the same key
//! a failure blocks all that need it
//! ```
//!
//! A queued node starts when fewer than `jobs` run and its lock is free. The lock is taken before the node is handed to
//! a thread and is never waited for: a node whose lock another run holds stays queued and is tried again. Under the lock the
//! store is examined once more, since the other run may have done the work. A measurement runs alone.

use super::events::{Events, Progress};
use super::exports::{self, Wanted};
use super::graph::Graph;
use super::heads::Heads;
use super::parallel;
use super::record::Record;
use super::report::{Damage, ExportReport, ExportStatus, Failure, Repair, Status, Subject};
use super::run::Options;
use super::select::Selection;
use super::store::{Store, StoreError};
use super::work::{self, Done};
use crate::contract::digest::Digest;
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// How often a lock that another run holds is tried again.
const LOCK_POLL: Duration = Duration::from_millis(10);
/// How often progress is told while nodes run.
const TICK: Duration = Duration::from_millis(100);

/// A node of the run.
#[derive(Debug, Default)]
pub(super) struct Slot {
    pub(super) is_needed: bool,
    /// Inputs that are not settled.
    pub(super) waiting: usize,
    pub(super) key: Option<Digest>,
    pub(super) record: Option<Arc<Record>>,
    /// None while it is on its way.
    pub(super) status: Option<Status>,
    pub(super) duration: Option<Duration>,
    pub(super) differs: Vec<String>,
    /// What the store had under its key, if it runs nevertheless.
    pub(super) previous: Option<Record>,
    pub(super) last: Option<Duration>,
    pub(super) begun: Option<Instant>,
    pub(super) is_told_waiting: bool,
}

pub(super) type Message = (usize, Result<Done, Failure>);

pub(super) struct Scheduler<'a> {
    pub(super) graph: &'a Graph,
    pub(super) store: &'a Store,
    pub(super) options: &'a Options,
    pub(super) events: &'a mut dyn Events,
    /// By plan.
    pub(super) heads: &'a [Heads],
    pub(super) slots: Vec<Slot>,
    pub(super) exports: Vec<Option<ExportReport>>,
    pub(super) damage: Vec<Damage>,
    pub(super) store_errors: Vec<StoreError>,
    /// Code listings that this run put into the store.
    pub(super) listings: HashSet<Digest>,
    pub(super) total: usize,
    pub(super) ready: Vec<usize>,
    pub(super) queue: VecDeque<usize>,
    pub(super) running: BTreeSet<usize>,
    /// The node that settles a key, and those that wait for it to do so.
    pub(super) owners: HashMap<Digest, usize>,
    pub(super) twins: HashMap<usize, Vec<usize>>,
    pub(super) due: Vec<usize>,
    pub(super) wanted_exports: HashSet<usize>,
    pub(super) settled: usize,
    pub(super) is_stopped: bool,
}

impl<'a> Scheduler<'a> {
    pub(super) fn new(
        graph: &'a Graph,
        selection: &Selection,
        store: &'a Store,
        options: &'a Options,
        heads: &'a [Heads],
        events: &'a mut dyn Events,
    ) -> Self {
        let mut slots: Vec<Slot> = Vec::new();
        slots.resize_with(graph.nodes.len(), Slot::default);
        let mut ready = Vec::new();
        for &node in &selection.nodes {
            let placed = &graph.nodes[node];
            slots[node].is_needed = true;
            slots[node].waiting = placed.inputs.iter().collect::<BTreeSet<_>>().len();
            if slots[node].waiting == 0 {
                ready.push(node);
            }
        }
        Self {
            graph,
            store,
            options,
            events,
            heads,
            slots,
            exports: vec![None; graph.exports.len()],
            damage: Vec::new(),
            store_errors: Vec::new(),
            listings: HashSet::new(),
            total: selection.nodes.len(),
            ready,
            queue: VecDeque::new(),
            running: BTreeSet::new(),
            owners: HashMap::new(),
            twins: HashMap::new(),
            due: Vec::new(),
            wanted_exports: selection.exports.iter().copied().collect(),
            settled: 0,
            is_stopped: false,
        }
    }

    /// Goes on until nothing can be done any more.
    pub(super) fn drive(&mut self) {
        let (sender, receiver) = channel();
        std::thread::scope(|scope| {
            loop {
                self.settle_ready();
                self.bring_due();
                let is_lock_awaited = self.start(scope, &sender);
                self.tick();
                if !self.ready.is_empty() && !self.is_stopped {
                    continue;
                }
                if self.running.is_empty() && (self.queue.is_empty() || self.is_stopped) {
                    // Nodes that another run did while this one waited for their locks were settled by `start`.
                    self.bring_due();
                    break;
                }
                self.receive(&receiver, if is_lock_awaited { LOCK_POLL } else { TICK });
            }
        });
    }

    fn receive(&mut self, receiver: &Receiver<Message>, patience: Duration) {
        let mut message = receiver.recv_timeout(patience).ok();
        while let Some((node, outcome)) = message {
            self.running.remove(&node);
            match outcome {
                Ok(done) => self.finish(node, done),
                Err(failure) => self.fail(node, failure),
            }
            message = receiver.try_recv().ok();
        }
    }

    fn tick(&mut self) {
        let last = |node: &usize| self.slots[*node].last.unwrap_or_default();
        let left = |node: &usize| {
            let elapsed = self.slots[*node].begun.map(|begun| begun.elapsed()).unwrap_or_default();
            last(node).saturating_sub(elapsed)
        };
        let work: Duration = self.queue.iter().map(last).sum::<Duration>() + self.running.iter().map(left).sum();
        let lanes = u32::try_from(self.options.jobs).unwrap_or(1).max(1);
        self.events.tick(Progress {
            nodes: self.total,
            settled: self.settled,
            running: self.running.len(),
            queued: self.queue.len(),
            remaining: work / lanes,
        });
    }

    fn finish(&mut self, node: usize, done: Done) {
        self.events.finished(self.graph.address(node), done.duration, &done.record.work);
        self.slots[node].duration = Some(done.duration);
        self.slots[node].differs = done.differs;
        for (object, fault) in done.replaced {
            let path = self.store.object_path(object).display().to_string();
            // Damage that made the node run has been told.
            if !self.damage.iter().any(|damage| damage.path == path) {
                self.tell_damage(node, Subject::Object, path, fault, Repair::Rewritten);
            }
        }
        for (export, object, status) in done.exports {
            self.tell_export(export, object, status);
        }
        self.settle(node, Arc::new(done.record), Status::Ran);
    }

    /// A node has its result: goes on to its exports, its twins, and those that read from it.
    pub(super) fn settle(&mut self, node: usize, record: Arc<Record>, status: Status) {
        let slot = &mut self.slots[node];
        slot.record = Some(Arc::clone(&record));
        slot.status = Some(status.clone());
        self.settled += 1;
        let exports = self.graph.nodes[node].exports.iter().copied();
        self.due.extend(exports.filter(|e| self.wanted_exports.contains(e) && self.exports[*e].is_none()));
        for &dependent in &self.graph.nodes[node].dependents {
            let slot = &mut self.slots[dependent];
            if slot.is_needed {
                slot.waiting -= 1;
                if slot.waiting == 0 && slot.status.is_none() {
                    self.ready.push(dependent);
                }
            }
        }
        for twin in self.twins.remove(&node).unwrap_or_default() {
            self.settle_twin(twin, node, &status, Arc::clone(&record));
        }
    }

    pub(super) fn fail(&mut self, node: usize, failure: Failure) {
        self.events.failed(self.graph.address(node), &failure);
        if let Failure::Store(error) = &failure {
            self.store_failed(error.clone());
        }
        self.is_stopped |= self.options.fail_fast;
        self.slots[node].status = Some(Status::Failed(failure.clone()));
        self.settled += 1;
        let cause = self.graph.address(node).clone();
        let mut open: Vec<usize> = self.graph.nodes[node].dependents.clone();
        while let Some(next) = open.pop() {
            let slot = &mut self.slots[next];
            if slot.is_needed && slot.status.is_none() {
                slot.status = Some(Status::Blocked(cause.clone()));
                self.settled += 1;
                self.events.blocked(self.graph.address(next), &cause);
                open.extend(&self.graph.nodes[next].dependents);
            }
        }
        for twin in self.twins.remove(&node).unwrap_or_default() {
            self.fail(twin, failure.clone());
        }
    }

    fn store_failed(&mut self, error: StoreError) {
        // What can't be written now can't be written for the next node either; those that run come to their end.
        self.is_stopped = true;
        if !self.store_errors.contains(&error) {
            self.store_errors.push(error);
        }
    }

    /// Brings the outputs of nodes that were settled without running.
    fn bring_due(&mut self) {
        let due = std::mem::take(&mut self.due);
        let (graph, store, slots, heads, out) = (self.graph, self.store, &self.slots, self.heads, &self.options.out);
        let brought = parallel::map(&due, self.options.jobs, |&export| {
            let placed = &graph.exports[export];
            let record = slots[placed.node].record.as_ref()?;
            let Some(output) = record.output(&placed.export.artifact) else {
                let failure = work::no_such_artifact(graph, placed.node, record, &placed.export.artifact);
                return Some((None, ExportStatus::NoSuchArtifact(failure)));
            };
            let file = exports::file_of(out, &placed.export.path);
            let last = heads[placed.plan].exports.get(&placed.export.path).copied();
            let wanted = Wanted { file, object: output.object, last };
            Some((Some(output.object), exports::bring(store, &wanted, None)))
        });
        for (export, (object, status)) in due.into_iter().zip(brought).filter_map(|(e, b)| Some((e, b?))) {
            self.tell_export(export, object, status);
        }
    }

    fn tell_export(&mut self, export: usize, object: Option<Digest>, status: ExportStatus) {
        let placed = &self.graph.exports[export];
        match &status {
            ExportStatus::Repaired(fault) => {
                let path = exports::file_of(&self.options.out, &placed.export.path).display().to_string();
                self.tell_damage(placed.node, Subject::Output, path, fault.clone(), Repair::FromStore);
            }
            ExportStatus::Failed(error) if !self.store_errors.contains(error) => self.store_errors.push(error.clone()),
            _ => {}
        }
        let path = placed.export.path.clone();
        let report = ExportReport { path, from: placed.export.from.clone(), object, status };
        self.events.output(&report);
        self.exports[export] = Some(report);
    }
}
