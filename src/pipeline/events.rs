//! What a run tells while it goes on. All calls come from the thread that called the run.

use super::report::{Damage, ExportReport, Failure};
use crate::contract::node::Address;
use crate::contract::work::Work;
use std::time::Duration;

/// How far a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Nodes in all.
    pub nodes: usize,
    /// Nodes that are settled: from the store, run, failed, or blocked.
    pub settled: usize,
    /// Nodes that run now.
    pub running: usize,
    /// Nodes known to have to run that have not begun.
    pub queued: usize,
    /// What the running and queued nodes will still take, by their last times, where known.
    pub remaining: Duration,
}

/// Listens to a run. Every method does nothing unless implemented.
pub trait Events {
    /// The run begins.
    fn planned(&mut self, _nodes: usize, _exports: usize) {}
    /// A node's result is in the store, verified.
    fn cached(&mut self, _address: &Address) {}
    /// A node begins; how long it took last time, if that is known.
    fn started(&mut self, _address: &Address, _last: Option<Duration>) {}
    /// A node has run.
    fn finished(&mut self, _address: &Address, _duration: Duration, _work: &Work) {}
    /// A node's work was done by another node of this run, which has the same key.
    fn shared(&mut self, _address: &Address, _with: &Address) {}
    /// A node failed.
    fn failed(&mut self, _address: &Address, _failure: &Failure) {}
    /// A node can't run since one that it needs failed.
    fn blocked(&mut self, _address: &Address, _by: &Address) {}
    /// A node (or, without address, the run) waits for what another run holds; `holder` says what is known of it.
    fn waiting(&mut self, _address: Option<&Address>, _holder: &str) {}
    /// Something was damaged or missing; the damage says what was done about it.
    fn damaged(&mut self, _damage: &Damage) {}
    /// Something worth knowing about the store, such as one of another format that was set aside.
    fn noted(&mut self, _note: &str) {}
    /// An output was looked at and, where needed, written.
    fn output(&mut self, _export: &ExportReport) {}
    /// A file in the output folder that no experiment makes.
    fn unknown_file(&mut self, _path: &str) {}
    /// Called after every change, and every tenth of a second while nodes run.
    fn tick(&mut self, _progress: Progress) {}
}

/// Listens to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Events for Silent {}
