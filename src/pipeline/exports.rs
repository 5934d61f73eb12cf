//! The output folder: bringing files to the bytes they should have, and finding files that nobody makes.
//!
//! A file is judged by its bytes alone, and written only when they differ. No hard links: an edit of a figure must not
//! reach the store.

use super::disk::{Disk, DiskError, TEMPORARY};
use super::report::ExportStatus;
use super::store::{Fault, Store, StoreError};
use crate::contract::digest::Digest;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// What an output should be.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    /// The file.
    pub(super) file: PathBuf,
    /// The digest of the bytes it should have.
    pub(super) object: Digest,
    /// The digest that this store last brought it to.
    pub(super) last: Option<Digest>,
}

/// How a file stands to what it should be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    Right,
    Missing,
    Other(Digest),
    Unreadable(String),
}

/// Where an export lies.
pub(super) fn file_of(out: &Path, path: &str) -> PathBuf {
    path.split('/').fold(out.to_owned(), |file, part| file.join(part))
}

/// Reads a file and says how it stands.
pub(super) fn standing(disk: &Disk, file: &Path, object: Digest) -> Standing {
    match disk.hash(file) {
        Ok((found, _)) if found == object => Standing::Right,
        Ok((found, _)) => Standing::Other(found),
        Err(error) if error.is_missing() => Standing::Missing,
        Err(error) => Standing::Unreadable(error.message),
    }
}

/// What stands at an output's place, in the words of a report: whether it was changed behind our back, or is merely old.
pub(super) fn judge(store: &Store, wanted: &Wanted) -> ExportStatus {
    match (standing(store.disk(), &wanted.file, wanted.object), wanted.last) {
        (Standing::Right, _) => ExportStatus::Unchanged,
        (Standing::Missing, None) => ExportStatus::New,
        (Standing::Missing, Some(_)) => ExportStatus::Repaired(Fault::Missing),
        (Standing::Unreadable(why), _) => ExportStatus::Repaired(Fault::Unreadable(why)),
        (Standing::Other(_), Some(last)) if last == wanted.object => ExportStatus::Repaired(Fault::Altered),
        (Standing::Other(found), Some(last)) if found == last => ExportStatus::Updated,
        // Made by a run that was killed before it could remember so, or brought back from version control.
        (Standing::Other(found), _) if store.object_fault(found).is_none() => ExportStatus::Updated,
        (Standing::Other(_), Some(_)) => ExportStatus::Repaired(Fault::Altered),
        (Standing::Other(_), None) => ExportStatus::Replaced,
    }
}

/// Brings an output to what it should be. `bytes` are read from the store when they are needed and not given. The folder
/// is not synced.
pub(super) fn bring(store: &Store, wanted: &Wanted, bytes: Option<&[u8]>) -> ExportStatus {
    let status = judge(store, wanted);
    if status == ExportStatus::Unchanged {
        return status;
    }
    let write = |bytes: &[u8]| Ok(store.disk().replace(&store.scratch(), &wanted.file, bytes)?);
    let written: Result<(), StoreError> = match bytes {
        Some(bytes) => write(bytes),
        None => match store.object(wanted.object) {
            Ok(bytes) => write(&bytes),
            Err(_) => Err(StoreError::Rotted { object: wanted.object }),
        },
    };
    written.map_or_else(ExportStatus::Failed, |()| status)
}

/// What is in the output folder and should not be there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Strays {
    /// Files that no experiment makes, by path below the folder.
    pub(super) unknown: Vec<String>,
    /// Temporary files of runs, alive or killed.
    pub(super) temporary: Vec<PathBuf>,
}

/// Looks through the output folder. `known` are the paths of all exports; folders and files in `unscanned` belong to
/// others.
pub(super) fn strays(
    disk: &Disk,
    out: &Path,
    known: &BTreeSet<String>,
    unscanned: &[String],
) -> Result<Strays, DiskError> {
    let mut strays = Strays::default();
    let mut open = vec![String::new()];
    while let Some(folder) = open.pop() {
        let entries = match disk.list(&file_of(out, &folder)) {
            Err(error) if error.is_missing() => continue,
            entries => entries?,
        };
        for entry in entries {
            let path = if folder.is_empty() { entry.name.clone() } else { format!("{folder}/{}", entry.name) };
            if unscanned.contains(&path) {
                continue;
            }
            if entry.is_folder {
                open.push(path);
            } else if entry.name.starts_with(TEMPORARY) {
                strays.temporary.push(file_of(out, &path));
            } else if !known.contains(&path) {
                strays.unknown.push(path);
            }
        }
    }
    strays.unknown.sort();
    Ok(strays)
}
