//! Heads: for each address the key it had last, for `why` (old → new), estimates, and as the roots of `gc`.
//!
//! One file per experiment and *view* (a folder of configs with its output folder), so that a sweep of a thousand nodes
//! costs one read. Heads are never needed for a right result: lost ones lose the old → new, nothing else. The times in
//! here are those of the last real run of a node; no record holds a time.

use super::record::{Malformed, seal, unseal};
use super::store::{Fault, Store, StoreError};
use crate::contract::digest::{Digest, Framed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What is remembered of an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// Its last key.
    pub key: Digest,
    /// How long its last real run took, in microseconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub micros: Option<u64>,
    /// Whether the last plan still had this address.
    pub live: bool,
}

impl Head {
    /// How long its last real run took.
    pub fn duration(&self) -> Option<Duration> {
        self.micros.map(Duration::from_micros)
    }
}

/// What is remembered of an experiment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Heads {
    /// By address.
    pub nodes: BTreeMap<String, Head>,
    /// The object that each output was last brought to, by path.
    pub exports: BTreeMap<String, Digest>,
}

const HEADER: &str = "polhode-heads 1";

/// The name of a view in the store: a digest of the folder of configs' root and the output folder.
pub fn view(root: &Path, out: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut framed = Framed::new("polhode view 1");
    framed.field(absolute(root).as_os_str().as_encoded_bytes());
    framed.field(absolute(out).as_os_str().as_encoded_bytes());
    framed.finish().to_string()[..16].to_owned()
}

/// The heads of one experiment in one view: the view, the experiment, and what its file says.
pub(super) type Remembered = (String, String, Result<Heads, Fault>);

impl Store {
    fn heads_path(&self, view: &str, experiment: &str) -> PathBuf {
        self.folder().join("heads").join(view).join(experiment)
    }

    /// What is remembered of an experiment, and what is wrong with that file if something is.
    pub fn heads(&self, view: &str, experiment: &str) -> (Heads, Option<Fault>) {
        let text = match self.disk().read(&self.heads_path(view, experiment)) {
            Ok(text) => text,
            Err(error) if error.is_missing() => return (Heads::default(), None),
            Err(error) => return (Heads::default(), Some(error.into())),
        };
        let parsed = unseal(HEADER, &text).and_then(|body| {
            serde_json::from_str::<Heads>(body).map_err(|error| Malformed::Content(error.to_string()))
        });
        parsed.map_or((Heads::default(), Some(Fault::Altered)), |heads| (heads, None))
    }

    /// Where an experiment's heads lie and what that file's bytes digest to, when it is there and whole.
    pub(super) fn sound_heads(&self, view: &str, experiment: &str) -> Option<(PathBuf, Digest)> {
        let path = self.heads_path(view, experiment);
        let text = self.disk().read(&path).ok()?;
        unseal(HEADER, &text).is_ok().then(|| (path, Digest::of(&text)))
    }

    /// What is remembered of all experiments of all views, as (view, experiment, heads or what is wrong with the file).
    ///
    /// # Errors
    /// Folders that can't be listed.
    pub(super) fn all_heads(&self) -> Result<Vec<Remembered>, StoreError> {
        let folder = self.folder().join("heads");
        let mut found = Vec::new();
        for view in self.list_if_there(&folder)?.into_iter().filter(|entry| entry.is_folder) {
            for file in self.list_if_there(&folder.join(&view.name))?.into_iter().filter(|entry| !entry.is_folder) {
                let (heads, fault) = self.heads(&view.name, &file.name);
                found.push((view.name.clone(), file.name, fault.map_or(Ok(heads), Err)));
            }
        }
        Ok(found)
    }

    /// Changes what is remembered of an experiment, under its lock, against what stands there now; writes only when
    /// that makes a difference.
    ///
    /// # Errors
    /// The disk's.
    pub(super) fn update_heads(
        &self,
        view: &str,
        experiment: &str,
        change: impl FnOnce(&mut Heads),
    ) -> Result<(), StoreError> {
        let lock_path = self.lock_path(&format!("heads-{view}-{experiment}"));
        let lock = self.disk().open_lock(&lock_path)?;
        while !self.disk().try_lock(&lock, &lock_path)? {
            // Held only while another run writes one small file.
            std::thread::sleep(Duration::from_millis(1));
        }
        let (mut heads, fault) = self.heads(view, experiment);
        let before = heads.clone();
        change(&mut heads);
        if heads == before && fault.is_none() {
            return Ok(());
        }
        let body = serde_json::to_string(&heads).map_err(|error| StoreError::Unwritable(error.to_string()))?;
        self.replace(&self.heads_path(view, experiment), seal(HEADER, &body).as_bytes())
    }

    /// The file that holds an experiment's heads, for messages.
    pub(super) fn heads_name(&self, view: &str, experiment: &str) -> String {
        self.heads_path(view, experiment).display().to_string()
    }
}
