//! Past runs: when, what ran, how long it took. For `log` and people, and for `gc --keep`.

use super::report::{Report, Status};
use super::store::{Store, StoreError};
use crate::contract::digest::Digest;
use serde::{Deserialize, Serialize};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// A node that ran in a past run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PastNode {
    /// Its address.
    pub address: String,
    /// Its key.
    pub key: String,
    /// How long it took.
    pub seconds: f64,
}

/// A past run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PastRun {
    /// When it began, in seconds since 1970.
    pub began: f64,
    /// How long it took.
    pub seconds: f64,
    /// Its targets; none means everything.
    pub targets: Vec<String>,
    /// The nodes that ran.
    pub ran: Vec<PastNode>,
    /// How many nodes were in the store.
    pub cached: usize,
    /// The nodes that failed, with why.
    pub failed: Vec<(String, String)>,
    /// The outputs that were written.
    pub written: Vec<String>,
    /// What was damaged, and what was done about it.
    pub damage: Vec<String>,
    /// The keys that were last ones before this run and are no more: what the run before it had left.
    #[serde(default)]
    pub superseded: Vec<Digest>,
}

impl PastRun {
    /// What is to be remembered of a run; nothing when it changed nothing.
    pub(super) fn of(
        report: &Report,
        targets: &[String],
        superseded: Vec<Digest>,
        began: SystemTime,
        elapsed: Duration,
    ) -> Option<Self> {
        let ran = report.nodes.iter().filter(|node| node.status == Status::Ran).map(|node| PastNode {
            address: node.address.to_string(),
            key: node.key.map(|key| key.to_string()).unwrap_or_default(),
            seconds: node.duration.unwrap_or_default().as_secs_f64(),
        });
        let run = Self {
            began: began.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs_f64(),
            seconds: elapsed.as_secs_f64(),
            targets: targets.to_vec(),
            ran: ran.collect(),
            cached: report.count(|status| *status == Status::Cached),
            failed: report.failures().map(|(address, why)| (address.to_string(), why.to_string())).collect(),
            written: report.written().map(|export| export.path.clone()).collect(),
            damage: report.damage.iter().map(ToString::to_string).collect(),
            superseded,
        };
        let is_same = run.ran.is_empty() && run.written.is_empty() && run.superseded.is_empty();
        let is_idle = is_same && run.failed.is_empty() && run.damage.is_empty();
        (!is_idle).then_some(run)
    }
}

impl Store {
    pub(super) fn remember(&self, run: &PastRun) -> Result<(), StoreError> {
        let text = serde_json::to_string(run).map_err(|error| StoreError::Unwritable(error.to_string()))?;
        // Names sort by time until the year 2286.
        let name = format!("{:017.6}-{}.json", run.began, std::process::id());
        self.replace(&self.folder().join("runs").join(name), text.as_bytes())
    }

    /// The last runs that did something, the newest first.
    pub fn runs(&self, limit: usize) -> Vec<PastRun> {
        let folder = self.folder().join("runs");
        let entries = self.disk().list(&folder).unwrap_or_default();
        let read = |name: &str| serde_json::from_slice(&self.disk().read(&folder.join(name)).ok()?).ok();
        entries.iter().rev().filter_map(|entry| read(&entry.name)).take(limit).collect()
    }
}
