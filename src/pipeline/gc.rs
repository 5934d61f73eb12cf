//! Drops from the store what no last run needs.
//!
//! Kept are the results of: the present graph, as far as its keys are known; every address of every view, as the last run
//! left it (the heads); with `keep` = N, also what the N−1 runs before that left, which the log of runs tells. A kept record
//! keeps its objects and its code listing. Everything else goes: records first, then, once the folder of records is
//! on the disk, the objects that no kept record names, then what killed runs left in `tmp`. Killed in between, it leaves
//! objects that no record names, which the next `gc` finds.
//!
//! The store is taken alone: no run is alive while it works, and runs that begin wait. Lock files are never unlinked (a
//! process may have one open and believe that it holds it), nor are logs, or stores that were set aside.

use super::forecast::forecast;
use super::graph::Graph;
use super::heads;
use super::record::Record;
use super::run::Options;
use super::select::Selection;
use super::store::{Fault, Store, StoreError};
use crate::contract::digest::Digest;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What to keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GcOptions {
    /// The results of how many last runs are kept; 1 keeps what the last one left, 0 counts as 1.
    pub keep: usize,
    /// Only the heads of this view count: what was shown in other output folders, or at other accuracies, is forgotten.
    pub here: bool,
    /// Only say what would go.
    pub dry_run: bool,
}

/// Why nothing was dropped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GcError {
    /// The store can't be used.
    #[error("{0}")]
    Store(#[from] StoreError),
    /// A file of heads is damaged, so it is not known what it keeps.
    #[error("{} is {fault}, so it is not known which results it keeps; nothing was dropped\n  the next polhode figures of that \
             experiment and output folder writes it anew; or remove the file, and what it keeps may go", path.display())]
    Heads {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: Fault,
    },
}

/// Files, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Records.
    pub records: usize,
    /// Objects, code listings among them.
    pub objects: usize,
    /// Temporary files of killed runs.
    pub temporary: usize,
    /// The bytes of them all.
    pub bytes: u64,
}

/// What was kept and dropped, or would be.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Collected {
    /// What stays.
    pub kept: Tally,
    /// What went, or would go.
    pub dropped: Tally,
    /// Records that are to be kept and can't be read: the next run that needs one makes it anew.
    pub damaged: Vec<String>,
    /// Files of heads that went: of other views, with `here`.
    pub forgotten: usize,
}

/// Drops what no last run needs. `wait` is called again and again while another process uses the store.
///
/// # Errors
/// A store that can't be used; heads that can't be read.
pub fn gc(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    options: &Options,
    what: GcOptions,
    wait: &mut dyn FnMut(),
) -> Result<Collected, GcError> {
    let session = if what.dry_run { store.begin_looking(wait)? } else { store.begin_alone(wait)? };
    let Some(_session) = session else { return Ok(Collected::default()) };
    let view = heads::view(&options.root, &options.out);
    let mut collected = Collected::default();
    let mut roots = present(graph, selection, store, options);
    let forgotten = head_roots(store, &view, what.here, &mut roots)?;
    for past in store.runs(what.keep.saturating_sub(1)) {
        roots.extend(past.superseded);
    }
    let mut objects = BTreeSet::new();
    let mut plan = Plan::default();
    records(store, &roots, &mut objects, &mut plan, &mut collected)?;
    sweep_objects(store, &objects, &mut plan, &mut collected)?;
    for leftover in store.leftovers(&store.scratch()) {
        collected.dropped.temporary += 1;
        collected.dropped.bytes += store.disk().size(&leftover).unwrap_or_default();
        plan.temporary.push(leftover);
    }
    collected.forgotten = forgotten.len();
    if !what.dry_run {
        carry_out(store, &forgotten, &plan)?;
    }
    Ok(collected)
}

/// What is to be removed, in this order.
#[derive(Default)]
struct Plan {
    records: Vec<PathBuf>,
    objects: Vec<PathBuf>,
    temporary: Vec<PathBuf>,
}

fn present(graph: &Graph, selection: &Selection, store: &Store, options: &Options) -> BTreeSet<Digest> {
    let forecast = forecast(graph, selection, store, options);
    forecast.nodes.iter().filter_map(|node| node.key).collect()
}

/// Adds the heads' keys to the roots; gives the files of heads that are to be forgotten.
fn head_roots(store: &Store, view: &str, here: bool, roots: &mut BTreeSet<Digest>) -> Result<Vec<PathBuf>, GcError> {
    let mut forgotten = Vec::new();
    for (other, experiment, heads) in store.all_heads()? {
        let path = store.folder().join("heads").join(&other).join(&experiment);
        if here && other != view {
            forgotten.push(path);
            continue;
        }
        let heads = heads.map_err(|fault| GcError::Heads { path, fault })?;
        roots.extend(heads.nodes.values().filter(|head| head.live).map(|head| head.key));
    }
    Ok(forgotten)
}

/// Parts the records, and notes which objects the kept ones name.
fn records(
    store: &Store,
    roots: &BTreeSet<Digest>,
    objects: &mut BTreeSet<Digest>,
    plan: &mut Plan,
    collected: &mut Collected,
) -> Result<(), StoreError> {
    let folder = store.folder().join("records");
    for entry in store.list_if_there(&folder)? {
        // What is not named like a record was not put here by this program.
        let Ok(key) = entry.name.parse::<Digest>() else { continue };
        let path = folder.join(&entry.name);
        let size = store.disk().size(&path)?;
        if !roots.contains(&key) {
            collected.dropped.records += 1;
            collected.dropped.bytes += size;
            plan.records.push(path);
            continue;
        }
        collected.kept.records += 1;
        collected.kept.bytes += size;
        match store.disk().read(&path).map(|text| (Record::from_text(&text, key), text)) {
            Ok((Ok(record), text)) => {
                objects.extend(record.outputs.iter().map(|output| output.object));
                objects.extend(Record::manifest_from_text(&text, key).ok().and_then(|manifest| manifest.code()));
            }
            _ => collected.damaged.push(path.display().to_string()),
        }
    }
    Ok(())
}

fn sweep_objects(
    store: &Store,
    kept: &BTreeSet<Digest>,
    plan: &mut Plan,
    collected: &mut Collected,
) -> Result<(), StoreError> {
    for (object, path) in store.all_objects()? {
        let size = store.disk().size(&path)?;
        let tally = if kept.contains(&object) { &mut collected.kept } else { &mut collected.dropped };
        tally.objects += 1;
        tally.bytes += size;
        if !kept.contains(&object) {
            plan.objects.push(path);
        }
    }
    Ok(())
}

fn carry_out(store: &Store, forgotten: &[PathBuf], plan: &Plan) -> Result<(), StoreError> {
    let remove = |path: &Path| -> Result<(), StoreError> { Ok(store.disk().remove(path)?) };
    forgotten.iter().try_for_each(|path| remove(path))?;
    plan.records.iter().try_for_each(|path| remove(path))?;
    if !plan.records.is_empty() {
        store.disk().sync_folder(&store.folder().join("records"))?;
    }
    plan.objects.iter().try_for_each(|path| remove(path))?;
    plan.temporary.iter().try_for_each(|path| remove(path))
}

impl Store {
    /// All files that are named like objects, and lie where these lie.
    ///
    /// # Errors
    /// Folders that can't be listed.
    pub(super) fn all_objects(&self) -> Result<Vec<(Digest, PathBuf)>, StoreError> {
        let folder = self.folder().join("objects");
        let mut found = Vec::new();
        for part in self.list_if_there(&folder)?.into_iter().filter(|entry| entry.is_folder) {
            for entry in self.list_if_there(&folder.join(&part.name))? {
                if let Ok(object) = entry.name.parse::<Digest>()
                    && entry.name.starts_with(&part.name)
                    && !entry.is_folder
                {
                    found.push((object, folder.join(&part.name).join(&entry.name)));
                }
            }
        }
        Ok(found)
    }
}
