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
use super::graph::{Graph, Selection};
use super::heads::Heads;
use super::parallel;
use super::record::Record;
use super::report::{Damage, ExportReport, ExportStatus, Failure, Repair, Status, Subject};
use super::run::Options;
use super::store::{Examined, Fault, Lacking, Store, StoreError};
use super::work::{self, Done, Job, Outgoing};
use crate::contract::digest::Digest;
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};
use std::fs::File;
use std::io::{Read, Seek, Write};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{Builder, Scope};
use std::time::{Duration, Instant};

/// How often a lock that another run holds is tried again.
const LOCK_POLL: Duration = Duration::from_millis(10);
/// How often progress is told while nodes run.
const TICK: Duration = Duration::from_millis(100);
/// Stack of a node's thread: the pool's is not enough for deep recursion in a debug build of a dependency.
const STACK: usize = 8 << 20;

/// A node of the run.
#[derive(Debug, Default)]
pub(super) struct Slot {
    is_needed: bool,
    /// Inputs that are not settled.
    waiting: usize,
    pub(super) key: Option<Digest>,
    pub(super) record: Option<Arc<Record>>,
    /// None while it is on its way.
    pub(super) status: Option<Status>,
    pub(super) duration: Option<Duration>,
    pub(super) differs: Vec<String>,
    /// What the store had under its key, if it runs nevertheless.
    previous: Option<Record>,
    last: Option<Duration>,
    begun: Option<Instant>,
    is_told_waiting: bool,
}

type Message = (usize, Result<Done, Failure>);

pub(super) struct Scheduler<'a> {
    graph: &'a Graph,
    store: &'a Store,
    options: &'a Options,
    events: &'a mut dyn Events,
    /// By plan.
    heads: &'a [Heads],
    pub(super) slots: Vec<Slot>,
    pub(super) exports: Vec<Option<ExportReport>>,
    pub(super) damage: Vec<Damage>,
    pub(super) store_errors: Vec<StoreError>,
    /// Code listings that this run put into the store.
    pub(super) listings: HashSet<Digest>,
    total: usize,
    ready: Vec<usize>,
    queue: VecDeque<usize>,
    running: BTreeSet<usize>,
    /// The node that settles a key, and those that wait for it to do so.
    owners: HashMap<Digest, usize>,
    twins: HashMap<usize, Vec<usize>>,
    due: Vec<usize>,
    wanted_exports: HashSet<usize>,
    settled: usize,
    is_stopped: bool,
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
                if !self.ready.is_empty() {
                    continue;
                }
                if self.running.is_empty() && (self.queue.is_empty() || self.is_stopped) {
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

    // ---- what the store holds ------------------------------------------------------------------------------------

    /// Makes the keys of all nodes that are ready, and settles those that the store holds; again, as long as that makes
    /// others ready.
    fn settle_ready(&mut self) {
        while !self.ready.is_empty() && !self.is_stopped {
            let batch = std::mem::take(&mut self.ready);
            let (graph, store, slots) = (self.graph, self.store, &self.slots);
            let keys = parallel::map(&batch, self.options.jobs, |&node| {
                inputs(graph, slots, node).map(|(logical, _)| graph.key(node, &logical))
            });
            let mut fresh = Vec::new();
            for (node, key) in batch.into_iter().zip(keys) {
                match key {
                    Ok(key) => {
                        self.slots[node].key = Some(key);
                        self.slots[node].last = self.head(node).and_then(|head| head.duration());
                        match self.owners.get(&key) {
                            None => {
                                self.owners.insert(key, node);
                                fresh.push((node, key));
                            }
                            Some(&owner) => self.join_owner(node, owner),
                        }
                    }
                    Err(failure) => self.fail(node, failure),
                }
            }
            let found = parallel::map(&fresh, self.options.jobs, |(_, key)| store.examine(*key));
            for ((node, key), examined) in fresh.into_iter().zip(found) {
                self.judge(node, key, examined);
            }
        }
    }

    fn head(&self, node: usize) -> Option<&super::heads::Head> {
        self.heads[self.graph.nodes[node].plan].nodes.get(&self.graph.address(node).to_string())
    }

    /// A node whose key another one already has: settled with it.
    fn join_owner(&mut self, node: usize, owner: usize) {
        match (self.slots[owner].status.clone(), self.slots[owner].record.clone()) {
            (Some(status), Some(record)) => self.settle_twin(node, owner, &status, record),
            (Some(Status::Failed(failure)), None) => self.fail(node, failure),
            _ => self.twins.entry(owner).or_default().push(node),
        }
    }

    fn settle_twin(&mut self, node: usize, owner: usize, status: &Status, record: Arc<Record>) {
        match status {
            Status::Ran => {
                let with = self.graph.address(owner);
                self.events.shared(self.graph.address(node), with);
                self.settle(node, record, Status::SameAs(with.clone()));
            }
            _ => {
                self.events.cached(self.graph.address(node));
                self.settle(node, record, Status::Cached);
            }
        }
    }

    /// Decides what becomes of a node, given what the store holds under its key.
    fn judge(&mut self, node: usize, key: Digest, examined: Examined) {
        match examined {
            Examined::Sound(record) | Examined::Lacking(record, _) if self.options.force => {
                self.slots[node].previous = Some(record);
                self.queue.push_back(node);
            }
            Examined::Sound(record) => {
                self.events.cached(self.graph.address(node));
                self.settle(node, Arc::new(record), Status::Cached);
            }
            Examined::Lacking(record, lacking) => self.mend(node, record, &lacking),
            Examined::Broken(why) => {
                let fault = if why.is_empty() { Fault::Altered } else { Fault::Unreadable(why) };
                self.tell_damage(node, Subject::Record, self.record_name(key), fault, Repair::RunAgain);
                self.queue.push_back(node);
            }
            Examined::Absent => {
                if self.head(node).is_some_and(|head| head.key == key) {
                    self.tell_damage(node, Subject::Record, self.record_name(key), Fault::Missing, Repair::RunAgain);
                }
                self.queue.push_back(node);
            }
        }
    }

    fn record_name(&self, key: Digest) -> String {
        self.store.record_path(key).display().to_string()
    }

    /// Objects are damaged: brings them back from outputs whose bytes are right, or runs the node again.
    fn mend(&mut self, node: usize, record: Record, lacking: &[Lacking]) {
        let mut is_whole = true;
        for Lacking { output, fault } in lacking {
            let is_back = self.restore(node, &output.name, output.object);
            is_whole &= is_back;
            let repair = if is_back { Repair::FromOutput } else { Repair::RunAgain };
            let path = self.store.object_path(output.object).display().to_string();
            self.tell_damage(node, Subject::Object, path, fault.clone(), repair);
        }
        if is_whole {
            self.events.cached(self.graph.address(node));
            self.settle(node, Arc::new(record), Status::Cached);
        } else {
            self.slots[node].previous = Some(record);
            self.queue.push_back(node);
        }
    }

    fn restore(&self, node: usize, artifact: &str, object: Digest) -> bool {
        let placed = self.graph.nodes[node].exports.iter().map(|export| &self.graph.exports[*export].export);
        placed.filter(|export| export.artifact == artifact).any(|export| {
            let bytes = self.store.disk().read(&exports::file_of(&self.options.out, &export.path));
            bytes.is_ok_and(|bytes| Digest::of(&bytes) == object && self.store.put(&bytes).is_ok())
        })
    }

    fn tell_damage(&mut self, node: usize, subject: Subject, path: String, fault: Fault, repair: Repair) {
        let address = Some(self.graph.address(node).to_string());
        let damage = Damage { subject, path, address, fault, repair };
        self.events.damaged(&damage);
        self.damage.push(damage);
    }

    // ---- running ---------------------------------------------------------------------------------------------------

    /// Starts what can be started. True when a queued node waits for a lock that another run holds.
    fn start<'scope>(&mut self, scope: &'scope Scope<'scope, '_>, sender: &Sender<Message>) -> bool
    where
        'a: 'scope,
    {
        let mut is_lock_awaited = false;
        for _ in 0..self.queue.len() {
            let is_measured = |node: &usize| self.graph.nodes[*node].node.compute.kind().measurement;
            let is_alone = self.running.iter().any(is_measured);
            if self.is_stopped || is_alone || self.running.len() >= self.options.jobs.max(1) {
                break;
            }
            let Some(node) = self.queue.pop_front() else { break };
            if is_measured(&node) && !self.running.is_empty() {
                self.queue.push_back(node);
                continue;
            }
            match self.take(node) {
                Ok(Some(job)) => self.launch(scope, sender, job),
                Ok(None) if self.slots[node].status.is_some() => {}
                Ok(None) => {
                    is_lock_awaited = true;
                    self.queue.push_back(node);
                }
                Err(failure) => self.fail(node, failure),
            }
        }
        is_lock_awaited
    }

    /// Takes a queued node's lock and makes it a job; none when the lock is held elsewhere, or when the node is settled,
    /// since another run did it meanwhile.
    fn take(&mut self, node: usize) -> Result<Option<Job>, Failure> {
        let Some(key) = self.slots[node].key else { return Ok(None) };
        let path = self.store.lock_path(&key.to_string());
        let disk = self.store.disk();
        let mut lock = disk.open_lock(&path).map_err(|error| Failure::Store(error.into()))?;
        if !disk.try_lock(&lock, &path).map_err(|error| Failure::Store(error.into()))? {
            self.tell_waiting(node, &mut lock);
            return Ok(None);
        }
        if !self.options.force
            && let Examined::Sound(record) = self.store.examine(key)
        {
            self.events.cached(self.graph.address(node));
            self.settle(node, Arc::new(record), Status::Cached);
            return Ok(None);
        }
        let code = &self.graph.nodes[node].code;
        if self.listings.insert(code.digest) {
            self.store.put(code.text().as_bytes()).map_err(Failure::Store)?;
        }
        self.sign(node, &mut lock);
        let (logical, objects) = inputs(self.graph, &self.slots, node)?;
        let outgoing = self.outgoing(node);
        Ok(Some(Job { node, key, logical, objects, previous: self.slots[node].previous.take(), outgoing, lock }))
    }

    /// Writes into a lock file who holds it: only for the message of whoever waits, so errors don't matter.
    fn sign(&self, node: usize, lock: &mut File) {
        let text = format!("process {} for {}", std::process::id(), self.graph.address(node));
        drop(lock.set_len(0).and_then(|()| lock.rewind()).and_then(|()| lock.write_all(text.as_bytes())));
    }

    fn tell_waiting(&mut self, node: usize, lock: &mut File) {
        if !std::mem::replace(&mut self.slots[node].is_told_waiting, true) {
            let mut holder = String::new();
            drop(lock.read_to_string(&mut holder));
            self.events.waiting(Some(self.graph.address(node)), &holder);
        }
    }

    fn outgoing(&self, node: usize) -> Vec<Outgoing> {
        let exports = self.graph.nodes[node].exports.iter().filter(|export| self.wanted_exports.contains(export));
        exports
            .map(|&export| {
                let placed = &self.graph.exports[export];
                let file = exports::file_of(&self.options.out, &placed.export.path);
                let last = self.heads[placed.plan].exports.get(&placed.export.path).copied();
                Outgoing { export, artifact: placed.export.artifact.clone(), file, last }
            })
            .collect()
    }

    fn launch<'scope>(&mut self, scope: &'scope Scope<'scope, '_>, sender: &Sender<Message>, job: Job)
    where
        'a: 'scope,
    {
        let node = job.node;
        let (graph, store, sender) = (self.graph, self.store, sender.clone());
        let act = move || {
            let outcome = work::execute(graph, store, job);
            // The receiver lives as long as this thread's scope.
            drop(sender.send((node, outcome)));
        };
        self.events.started(self.graph.address(node), self.slots[node].last);
        self.slots[node].begun = Some(Instant::now());
        match Builder::new().name(format!("node {node}")).stack_size(STACK).spawn_scoped(scope, act) {
            Ok(_) => drop(self.running.insert(node)),
            Err(error) => self.fail(node, Failure::Node(format!("can't start a thread: {error}"))),
        }
    }

    // ---- endings ---------------------------------------------------------------------------------------------------

    fn finish(&mut self, node: usize, done: Done) {
        self.events.finished(self.graph.address(node), done.duration, &done.record.work);
        self.slots[node].duration = Some(done.duration);
        self.slots[node].differs = done.differs;
        for (export, object, status) in done.exports {
            self.tell_export(export, object, status);
        }
        self.settle(node, Arc::new(done.record), Status::Ran);
    }

    /// A node has its result: goes on to its exports, its twins, and those that read from it.
    fn settle(&mut self, node: usize, record: Arc<Record>, status: Status) {
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

    fn fail(&mut self, node: usize, failure: Failure) {
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

    // ---- outputs ---------------------------------------------------------------------------------------------------

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

/// The logical digests and the objects of a node's inputs, all of which are settled.
fn inputs(graph: &Graph, slots: &[Slot], node: usize) -> Result<(Vec<Digest>, Vec<Digest>), Failure> {
    let placed = &graph.nodes[node];
    let (mut logical, mut objects) = (Vec::new(), Vec::new());
    for (input, &from) in placed.node.inputs.iter().zip(&placed.inputs) {
        let Some(record) = &slots[from].record else { continue };
        let output = record
            .output(&input.artifact)
            .ok_or_else(|| work::no_such_artifact(graph, from, record, &input.artifact))?;
        logical.push(output.logical);
        objects.push(output.object);
    }
    Ok((logical, objects))
}
