//! What a run of everything left settled, remembered, so that the next run can ask the disk whether it still is before anything is planned.
//!
//! Which nodes there are, and under which keys, follows from the program and the configs alone; their digest is the [`Question`]. When it is the same,
//! and every file that a run looks at (records, objects, code listings, heads, the marker of the format, outputs) has, byte for byte, the content that it
//! had, and no other file came into the output folder, then a run would find nothing to do: planning it again would only say so later. Every byte is read
//! and hashed; no time stamp is looked at.
//!
//! This is no second opinion on what is right: when anything is otherwise, this memory among it, the answer is "not known", and the usual run finds out,
//! tells and repairs. It is written by runs that ended with everything settled, never by one that failed or warned.
//!
//! ```text
//! polhode-settled 1 SHA-256-OF-THE-REST
//! QUESTION
//! NODES OUTPUTS
//! NOTE
//! s SHA-256 path below the store
//! o SHA-256 path below the output folder
//! ```

use super::exports;
use super::format::{VERSION, marker_text};
use super::graph::Graph;
use super::heads;
use super::parallel;
use super::record::{Record, seal, unseal};
use super::report::{ExportStatus, Report, Status};
use super::run::Options;
use super::select::Selection;
use super::store::{Fault, Store, StoreError};
use crate::contract::digest::Digest;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const HEADER: &str = "polhode-settled 1";
const FOLDER: &str = "settled";

/// What a whole run is asked, as far as its answer depends on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Question {
    /// The digest of the program, the configs and the level of accuracy.
    pub digest: Digest,
    /// One line that the caller wants back with the answer.
    pub note: String,
}

/// A whole run that would find nothing to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settled {
    /// How many nodes it has.
    pub nodes: usize,
    /// How many outputs.
    pub outputs: usize,
    /// What the caller wanted back.
    pub note: String,
}

/// Whether everything is as the last whole run for this question left it; None where that is not known.
///
/// Nothing is written. A store that another process has for itself is not waited for.
pub fn settled(store: &Store, options: &Options, question: &Digest) -> Option<Settled> {
    let text = store.disk().read(&path(store, options)).ok()?;
    let mut lines = unseal(HEADER, &text).ok()?.lines();
    if lines.next()?.parse::<Digest>().ok()? != *question {
        return None;
    }
    let (nodes, outputs) = lines.next()?.split_once(' ')?;
    let answer = Settled { nodes: nodes.parse().ok()?, outputs: outputs.parse().ok()?, note: lines.next()?.to_owned() };
    let mut known = BTreeSet::new();
    let mut files = Vec::new();
    for line in lines {
        let (place, digest, path) = (line.get(..2)?, line.get(2..66)?, line.get(67..)?);
        let folder = if place == "s " { store.folder() } else { &options.out };
        files.push((exports::file_of(folder, path), digest.parse::<Digest>().ok()?));
        if place == "o " {
            known.insert(path.to_owned());
        }
    }
    // Held until the answer is there, so that no `gc` takes away what was found whole.
    let lock_path = store.lock_path("store");
    let lock = store.disk().open_existing_lock(&lock_path).ok()?;
    if !store.disk().try_lock_shared(&lock, &lock_path).ok()? || !store.leftovers(&store.scratch()).is_empty() {
        return None;
    }
    let is_as_it_was =
        |(file, digest): &(PathBuf, Digest)| store.disk().hash(file).is_ok_and(|(found, _)| found == *digest);
    if !parallel::map(&files, options.jobs, is_as_it_was).into_iter().all(|is| is) {
        return None;
    }
    let strays = exports::strays(store.disk(), &options.out, &known, &options.unscanned).ok()?;
    (strays == exports::Strays::default()).then_some(answer)
}

/// What is wrong with the memory, where there is one that can't be read.
pub(super) fn fault(store: &Store, options: &Options) -> Option<(PathBuf, Fault)> {
    let path = path(store, options);
    match store.disk().read(&path) {
        Ok(text) => unseal(HEADER, &text).is_err().then_some((path, Fault::Altered)),
        Err(error) if error.is_missing() => None,
        Err(error) => Some((path, error.into())),
    }
}

/// Remembers what a whole run left, when all of it is settled.
///
/// # Errors
/// The disk's. What can't be read or is damaged by now is no error: then nothing is remembered.
pub(super) fn remember(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    options: &Options,
    question: &Question,
    report: &Report,
) -> Result<(), StoreError> {
    let Some(files) = files(graph, selection, store, options, report) else { return Ok(()) };
    let Question { digest, note } = question;
    let mut body = format!("{digest}\n{} {}\n{}\n", report.nodes.len(), report.exports.len(), note.replace('\n', " "));
    for ((place, path), digest) in files {
        let _ = writeln!(body, "{place} {digest} {path}");
    }
    let (text, path) = (seal(HEADER, &body), path(store, options));
    if store.disk().read(&path).is_ok_and(|old| old == text.as_bytes()) {
        return Ok(());
    }
    store.replace(&path, text.as_bytes())
}

fn path(store: &Store, options: &Options) -> PathBuf {
    store.folder().join(FOLDER).join(heads::view(&options.root, &options.out))
}

/// The files that a run looks at, by place (`s`tore or `o`utput folder) and path, with the content that they are known to have; None
/// when not everything is settled.
fn files(
    graph: &Graph,
    selection: &Selection,
    store: &Store,
    options: &Options,
    report: &Report,
) -> Option<BTreeMap<(char, String), Digest>> {
    if !report.store_errors.is_empty() || !report.warnings.is_empty() {
        return None;
    }
    let mut files = BTreeMap::new();
    let mut stored = |path: &Path, digest: Digest| {
        let inside = path.strip_prefix(store.folder()).ok()?;
        let parts: Option<Vec<&str>> = inside.iter().map(|part| part.to_str()).collect();
        files.insert(('s', parts?.join("/")), digest);
        Some(())
    };
    for (&node, done) in selection.nodes.iter().zip(&report.nodes) {
        if !matches!(done.status, Status::Cached | Status::Ran | Status::SameAs(_)) {
            return None;
        }
        let (key, code) = (done.key?, graph.nodes[node].code.digest);
        // Read again, and believed only as far as its own checksum goes: what it names was hashed, or written, by this run.
        let path = store.record_path(key);
        let text = store.disk().read(&path).ok()?;
        let record = Record::from_text(&text, key).ok()?;
        stored(&path, Digest::of(&text))?;
        for object in record.outputs.iter().map(|output| output.object).chain([code]) {
            stored(&store.object_path(object), object)?;
        }
    }
    let view = heads::view(&options.root, &options.out);
    for (experiment, _) in &graph.experiments {
        if let Some((path, digest)) = store.sound_heads(&view, experiment) {
            stored(&path, digest)?;
        }
    }
    stored(&store.marker_path(), Digest::of(marker_text(VERSION).as_bytes()))?;
    for export in &report.exports {
        if matches!(export.status, ExportStatus::Failed(_) | ExportStatus::NoSuchArtifact(_) | ExportStatus::NotMade) {
            return None;
        }
        files.insert(('o', export.path.clone()), export.object?);
    }
    Some(files)
}
