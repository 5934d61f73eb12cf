//! The scheduler's first question: what does the store hold for the nodes that are ready?
//!
//! Keys are made and the store is examined for a whole batch at once, in parallel; equal keys are examined once.

use super::exports;
use super::graph::Graph;
use super::heads::Head;
use super::parallel;
use super::record::Record;
use super::report::{Damage, Failure, Repair, Status, Subject};
use super::schedule::{Scheduler, Slot};
use super::store::{Examined, Fault, Lacking};
use super::work;
use crate::contract::digest::Digest;
use std::sync::Arc;

impl Scheduler<'_> {
    /// Makes the keys of all nodes that are ready, and settles those that the store holds; again, as long as that makes
    /// others ready.
    pub(super) fn settle_ready(&mut self) {
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

    fn head(&self, node: usize) -> Option<&Head> {
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

    pub(super) fn settle_twin(&mut self, node: usize, owner: usize, status: &Status, record: Arc<Record>) {
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
            Examined::Broken(fault) => {
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

    pub(super) fn tell_damage(&mut self, node: usize, subject: Subject, path: String, fault: Fault, repair: Repair) {
        let address = Some(self.graph.address(node).to_string());
        let damage = Damage { subject, path, address, fault, repair };
        self.events.damaged(&damage);
        self.damage.push(damage);
    }
}

/// The logical digests and the objects of a node's inputs, all of which are settled.
pub(super) fn inputs(graph: &Graph, slots: &[Slot], node: usize) -> Result<(Vec<Digest>, Vec<Digest>), Failure> {
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
