//! Every call to the file system that the store and the output folder need, in one place.
//!
//! Each call passes a [`Probe`] first, if there is one: a test sees the order of writes, syncs and renames, and can
//! make any of them fail or end the process there. Without a probe this is the standard library.
//!
//! Files are replaced atomically: temporary file, fsync, rename, fsync of the folder. A reader sees the old file or
//! the new one, and after a power loss one of the two is there.

use crate::contract::digest::Digest;
use serde::{Serialize, Serializer};
use sha2::{Digest as _, Sha256};
use std::cell::RefCell;
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What is done to a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Operation {
    /// Make a folder.
    CreateFolder,
    /// Read a file.
    Read,
    /// Create a temporary file.
    Create,
    /// Write its bytes.
    Write,
    /// Wait until its bytes are on the disk.
    SyncFile,
    /// Put it in its place.
    Rename,
    /// Wait until the folder's entries are on the disk.
    SyncFolder,
    /// List a folder.
    List,
    /// Remove a file.
    Remove,
    /// Open a lock file.
    OpenLock,
    /// Lock it.
    Lock,
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CreateFolder => "create the folder",
            Self::Read => "read",
            Self::Create => "create",
            Self::Write => "write",
            Self::SyncFile | Self::SyncFolder => "sync",
            Self::Rename => "rename a temporary file to",
            Self::List => "list",
            Self::Remove => "remove",
            Self::OpenLock => "open the lock file",
            Self::Lock => "lock",
        })
    }
}

/// Sees each call before it is made, and may refuse it.
pub trait Probe: Send + Sync {
    /// Called before the operation.
    ///
    /// # Errors
    /// The error that the operation shall end with.
    fn before(&self, operation: Operation, path: &Path) -> io::Result<()>;
}

/// A call to the file system that failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[error("can't {operation} {}: {message}", path.display())]
pub struct DiskError {
    /// What was tried.
    pub operation: Operation,
    /// On which path.
    pub path: PathBuf,
    /// The class of the error.
    #[serde(serialize_with = "debug_text")]
    pub kind: io::ErrorKind,
    /// The system's words.
    pub message: String,
}

fn debug_text<T: fmt::Debug, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&format_args!("{value:?}"))
}

impl DiskError {
    /// Whether there is no such file.
    pub fn is_missing(&self) -> bool {
        self.kind == io::ErrorKind::NotFound
    }
}

/// An entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Whether it is a folder (links are not followed).
    pub is_folder: bool,
}

/// The file system, perhaps with a probe.
#[derive(Clone, Default)]
pub struct Disk {
    probe: Option<Arc<dyn Probe>>,
}

impl fmt::Debug for Disk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Disk").field("probed", &self.probe.is_some()).finish()
    }
}

type Done<T> = Result<T, DiskError>;

/// Bytes read at once when hashing.
const BLOCK: usize = 64 * 1024;

thread_local! {
    static BUFFER: RefCell<Vec<u8>> = RefCell::new(vec![0; BLOCK]);
}

impl Disk {
    /// The file system behind a probe.
    pub fn probed(probe: Arc<dyn Probe>) -> Self {
        Self { probe: Some(probe) }
    }

    fn call<T>(&self, operation: Operation, path: &Path, act: impl FnOnce() -> io::Result<T>) -> Done<T> {
        let probed = self.probe.as_ref().map_or(Ok(()), |probe| probe.before(operation, path));
        probed.and_then(|()| act()).map_err(|error| DiskError {
            operation,
            path: path.to_owned(),
            kind: error.kind(),
            message: error.to_string(),
        })
    }

    /// The bytes of a file.
    pub fn read(&self, path: &Path) -> Done<Vec<u8>> {
        self.call(Operation::Read, path, || fs::read(path))
    }

    /// The digest of a file's bytes, and their number, without holding them.
    pub fn hash(&self, path: &Path) -> Done<(Digest, u64)> {
        self.call(Operation::Read, path, || {
            let mut file = File::open(path)?;
            BUFFER.with_borrow_mut(|buffer| {
                let (mut hasher, mut size) = (Sha256::new(), 0);
                loop {
                    match file.read(buffer) {
                        Ok(0) => return Ok((Digest(hasher.finalize().into()), size)),
                        Ok(n) => {
                            hasher.update(&buffer[..n]);
                            size += n as u64;
                        }
                        Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                        Err(error) => return Err(error),
                    }
                }
            })
        })
    }

    /// Makes a folder and those above it; an existing one is fine. Syncs every folder that got an entry.
    pub fn create_folder(&self, path: &Path) -> Done<()> {
        let mut gaining = Vec::new();
        let mut lowest = path;
        while !lowest.exists() {
            match lowest.parent() {
                Some(above) if !above.as_os_str().is_empty() => {
                    gaining.push(above);
                    lowest = above;
                }
                _ => break,
            }
        }
        if lowest == path && path.is_dir() {
            return Ok(());
        }
        self.call(Operation::CreateFolder, path, || fs::create_dir_all(path))?;
        gaining.into_iter().rev().try_for_each(|folder| self.sync_folder(folder))
    }

    /// The entries of a folder, by name; names that are not Unicode are left out.
    pub fn list(&self, path: &Path) -> Done<Vec<Entry>> {
        self.call(Operation::List, path, || {
            let mut entries = Vec::new();
            for entry in fs::read_dir(path)? {
                let entry = entry?;
                if let Ok(name) = entry.file_name().into_string() {
                    entries.push(Entry { name, is_folder: entry.file_type()?.is_dir() });
                }
            }
            entries.sort();
            Ok(entries)
        })
    }

    /// Removes a file.
    pub fn remove(&self, path: &Path) -> Done<()> {
        self.call(Operation::Remove, path, || fs::remove_file(path))
    }

    /// The size of a file, in bytes.
    pub fn size(&self, path: &Path) -> Done<u64> {
        self.call(Operation::Read, path, || Ok(fs::metadata(path)?.len()))
    }

    /// Gives a file or folder another name on the same file system.
    pub fn rename(&self, from: &Path, to: &Path) -> Done<()> {
        self.call(Operation::Rename, to, || fs::rename(from, to))
    }

    /// Waits until the entries of a folder are on the disk. Does nothing where folders can't be opened.
    pub fn sync_folder(&self, path: &Path) -> Done<()> {
        self.call(Operation::SyncFolder, path, || if cfg!(unix) { File::open(path)?.sync_all() } else { Ok(()) })
    }

    /// Puts a file with these bytes at `path`, by way of a temporary file in `scratch` (or beside `path`, when that is
    /// another file system). The folder of `path` is made when it is missing, and is not synced: see [`Self::sync_folder`].
    pub fn replace(&self, scratch: &Path, path: &Path, bytes: &[u8]) -> Done<()> {
        match self.replace_through(scratch, path, bytes) {
            Err(error) if error.operation == Operation::Rename && error.kind == io::ErrorKind::CrossesDevices => {
                self.replace_through(parent(path), path, bytes)
            }
            outcome => outcome,
        }
    }

    fn replace_through(&self, scratch: &Path, path: &Path, bytes: &[u8]) -> Done<()> {
        let (temporary, mut file) = self.create_temporary(scratch)?;
        let written = self
            .call(Operation::Write, &temporary, || file.write_all(bytes))
            .and_then(|()| self.call(Operation::SyncFile, &temporary, || file.sync_all()))
            .and_then(|()| {
                let rename = || self.call(Operation::Rename, path, || fs::rename(&temporary, path));
                match rename() {
                    // Not asked whether the folder is there: another thread may have made it since.
                    Err(error) if error.is_missing() => {
                        self.create_folder(parent(path))?;
                        rename()
                    }
                    outcome => outcome,
                }
            });
        if written.is_err() {
            // Best effort: the first error is the one to tell.
            drop(self.remove(&temporary));
        }
        written
    }

    fn create_temporary(&self, scratch: &Path) -> Done<(PathBuf, File)> {
        static COUNTER: AtomicU64 = AtomicU64::new(0);
        let mut is_made = false;
        loop {
            let count = COUNTER.fetch_add(1, Ordering::Relaxed);
            let path = scratch.join(format!("{TEMPORARY}{}-{count}", std::process::id()));
            let created =
                self.call(Operation::Create, &path, || OpenOptions::new().write(true).create_new(true).open(&path));
            match created {
                Ok(file) => return Ok((path, file)),
                // Left behind by a killed process of the same number, or in use in another container: take the next.
                Err(error) if error.kind == io::ErrorKind::AlreadyExists => {}
                Err(error) if error.is_missing() && !is_made => {
                    self.create_folder(scratch)?;
                    is_made = true;
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// Opens a lock file for writing, making it when it is missing.
    pub fn open_lock(&self, path: &Path) -> Done<File> {
        let open = || {
            self.call(Operation::OpenLock, path, || {
                OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
            })
        };
        match open() {
            Err(error) if error.is_missing() => {
                self.create_folder(parent(path))?;
                open()
            }
            outcome => outcome,
        }
    }

    /// Opens an existing lock file for reading: enough to lock it, and possible in a store that can't be written.
    pub fn open_existing_lock(&self, path: &Path) -> Done<File> {
        self.call(Operation::OpenLock, path, || File::open(path))
    }

    /// Tries to take a lock for this process alone; false when another holds it.
    pub fn try_lock(&self, file: &File, path: &Path) -> Done<bool> {
        self.call(Operation::Lock, path, || taken(file.try_lock()))
    }

    /// Tries to take a lock that others may share; false when another holds it alone.
    pub fn try_lock_shared(&self, file: &File, path: &Path) -> Done<bool> {
        self.call(Operation::Lock, path, || taken(file.try_lock_shared()))
    }
}

fn taken(outcome: Result<(), TryLockError>) -> io::Result<bool> {
    match outcome {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// How the names of temporary files begin.
pub const TEMPORARY: &str = ".polhode-tmp-";

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Many threads at once put files into folders that are not there yet; none may be refused for another's sake.
    #[test]
    fn folders_are_made_by_whoever_comes_first() {
        let folder = tempfile::tempdir().expect("a folder");
        for round in 0..50 {
            let scratch = folder.path().join(format!("scratch-{round}"));
            let place = folder.path().join(format!("objects-{round}/ab"));
            std::thread::scope(|scope| {
                for file in 0..4 {
                    let (scratch, place) = (&scratch, &place);
                    scope.spawn(move || {
                        let path = place.join(file.to_string());
                        Disk::default().replace(scratch, &path, b"x").expect("written");
                    });
                }
            });
            assert_eq!(Disk::default().list(&place).expect("listed").len(), 4);
            assert!(Disk::default().list(&scratch).expect("listed").is_empty());
        }
    }
}
