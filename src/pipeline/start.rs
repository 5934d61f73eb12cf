//! The scheduler's second question: what can start? Takes locks, hands jobs to threads.

use super::examine::inputs;
use super::exports;
use super::report::{Failure, Repair, Status, Subject};
use super::schedule::{Message, Scheduler};
use super::store::{Examined, Put};
use super::work::{self, Job, Outgoing};
use std::fs::File;
use std::io::{Read, Seek, Write};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread::{Builder, Scope};
use std::time::Instant;

/// Stack of a node's thread: the default of 2 MiB is little for deep recursion in an unoptimised dependency.
pub(super) const STACK: usize = 8 << 20;

impl<'a> Scheduler<'a> {
    /// Starts what can be started. True when a queued node waits for a lock that another run holds.
    pub(super) fn start<'scope>(&mut self, scope: &'scope Scope<'scope, '_>, sender: &Sender<Message>) -> bool
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
            let (object, put) = self.store.put(code.text().as_bytes()).map_err(Failure::Store)?;
            if let Put::Replaced(fault) = put {
                let path = self.store.object_path(object).display().to_string();
                self.tell_damage(node, Subject::Listing, path, fault, Repair::Rewritten);
            }
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
}
