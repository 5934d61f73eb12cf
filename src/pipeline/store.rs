//! The store: content-addressed objects, records by key, heads by address, locks, past runs.
//!
//! ```text
//! ROOT/.polhode/v1/objects/ab/ab12…   bytes, named by their SHA-256
//!                  records/KEY        what a node gave back (see `record`)
//!                  heads/VIEW/ID      per experiment: address → last key (see `heads`)
//!                  settled/VIEW       what the last whole run left, when it left all in order (see `settled`)
//!                  locks/KEY          held while that key is computed; `store` is shared by runs, exclusive for gc
//!                  runs/TIME-PID.json past runs, durations included (see `runs`)
//!                  tmp/               files being written; leftovers of killed runs are removed when no run is alive
//!                  format             which format this is (see `format`)
//!                  aside/             what was found here in another format
//! ```
//!
//! Nothing is believed unread: [`Store::examine`] hashes the record and every object that it names. Objects reach the
//! disk before the record that names them. The folder's version is its format: another format is another folder.

use super::disk::{Disk, DiskError, Entry};
use super::format::{Marker, Notice};
use super::record::{Malformed, Output, Record};
use crate::contract::code::CodeListing;
use crate::contract::digest::Digest;
use crate::contract::manifest::Manifest;
use serde::Serialize;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The folder of this format below `ROOT/.polhode`.
pub const FORMAT: &str = "v1";

/// Why the store, or the output folder, can't be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StoreError {
    /// A call to the file system failed.
    #[error("{0}")]
    Disk(#[from] DiskError),
    /// An object was whole when this run began, and is no more.
    #[error("object {} was damaged while this run went on; run again to repair it", object.short())]
    Rotted {
        /// Its digest.
        object: Digest,
    },
    /// The store is of another format: a run sets it aside, who only looks refuses it.
    #[error(
        "the store in {} is of format {version}, which this program does not read; polhode figures sets it aside and \
         begins a new one",
        folder.display()
    )]
    OtherFormat {
        /// The store.
        folder: PathBuf,
        /// Its version.
        version: u32,
    },
    /// A text could not be written; a defect of the program.
    #[error("can't write a record: {0}")]
    Unwritable(String),
}

impl From<Malformed> for StoreError {
    fn from(error: Malformed) -> Self {
        Self::Unwritable(error.to_string())
    }
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// It is not there.
    Missing,
    /// Its bytes are not those that its name or the store promises.
    Altered,
    /// It can't be read.
    Unreadable(String),
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missing => f.write_str("missing"),
            Self::Altered => f.write_str("altered"),
            Self::Unreadable(why) => write!(f, "unreadable ({why})"),
        }
    }
}

impl From<DiskError> for Fault {
    fn from(error: DiskError) -> Self {
        if error.is_missing() { Self::Missing } else { Self::Unreadable(error.message) }
    }
}

/// An output that a record names and the store does not hold whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lacking {
    /// The output.
    pub output: Output,
    /// What is wrong with its object.
    pub fault: Fault,
}

/// What the store holds under a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Examined {
    /// A record, and all its objects, every byte as it should be.
    Sound(Record),
    /// A sound record with damaged or missing objects.
    Lacking(Record, Vec<Lacking>),
    /// A record that can't be believed.
    Broken(Fault),
    /// No record.
    Absent,
}

/// The store. Making one touches nothing.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
    disk: Disk,
}

/// Held while a run uses the store, so that `gc` keeps away.
#[derive(Debug)]
pub struct Session {
    lock: File,
    /// What was found out about the store's format.
    pub notices: Vec<Notice>,
}

/// What became of an object that was put into the store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Put {
    /// It was there.
    Kept,
    /// It was not.
    New,
    /// What was there under its name was damaged.
    Replaced(Fault),
}

impl Store {
    /// The store in this folder (`ROOT/.polhode/v1`, or what `--store` says).
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self::with_disk(folder, Disk::default())
    }

    /// The usual place below a root.
    pub fn below(root: &Path) -> Self {
        Self::at(root.join(".polhode").join(FORMAT))
    }

    /// A store on a given disk.
    pub fn with_disk(folder: impl Into<PathBuf>, disk: Disk) -> Self {
        Self { folder: folder.into(), disk }
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The disk that it is on.
    pub fn disk(&self) -> &Disk {
        &self.disk
    }

    /// Where an object lies.
    pub fn object_path(&self, object: Digest) -> PathBuf {
        let name = object.to_string();
        let mut path = self.folder.join("objects");
        path.push(&name[..2]);
        path.push(name);
        path
    }

    /// Where a record lies.
    pub fn record_path(&self, key: Digest) -> PathBuf {
        self.folder.join("records").join(key.to_string())
    }

    /// Where the lock of that name lies.
    pub fn lock_path(&self, name: &str) -> PathBuf {
        self.folder.join("locks").join(name)
    }

    /// Where files are written before they are put in their places.
    pub fn scratch(&self) -> PathBuf {
        self.folder.join("tmp")
    }

    /// Replaces a file in the store, durably.
    pub(super) fn replace(&self, path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
        self.disk.replace(&self.scratch(), path, bytes)?;
        Ok(path.parent().map_or(Ok(()), |folder| self.disk.sync_folder(folder))?)
    }

    /// Puts bytes into the store, unless they are there, whole.
    ///
    /// # Errors
    /// The disk's.
    pub fn put(&self, bytes: &[u8]) -> Result<(Digest, Put), StoreError> {
        let object = Digest::of(bytes);
        let put = match self.object_fault(object) {
            None => return Ok((object, Put::Kept)),
            Some(Fault::Missing) => Put::New,
            Some(fault) => Put::Replaced(fault),
        };
        self.replace(&self.object_path(object), bytes)?;
        Ok((object, put))
    }

    /// What is wrong with an object; nothing when it is there, every byte as it should be.
    pub fn object_fault(&self, object: Digest) -> Option<Fault> {
        match self.disk.hash(&self.object_path(object)) {
            Ok((found, _)) if found == object => None,
            Ok(_) => Some(Fault::Altered),
            Err(error) => Some(error.into()),
        }
    }

    /// The bytes of an object, verified.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn object(&self, object: Digest) -> Result<Vec<u8>, Fault> {
        let bytes = self.disk.read(&self.object_path(object))?;
        if Digest::of(&bytes) == object { Ok(bytes) } else { Err(Fault::Altered) }
    }

    /// The verified bytes of an output of a record: for `show` and `check`.
    ///
    /// # Errors
    /// What is wrong with the record or the object. [`Fault::Missing`] also when the record has no such output.
    pub fn artifact(&self, key: Digest, name: &str) -> Result<Vec<u8>, Fault> {
        let record = self.record(key)?;
        let output = record.output(name).ok_or(Fault::Missing)?;
        self.object(output.object)
    }

    /// The record of a key, verified; its objects are not looked at.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn record(&self, key: Digest) -> Result<Record, Fault> {
        let text = self.disk.read(&self.record_path(key))?;
        Record::from_text(&text, key).map_err(|_| Fault::Altered)
    }

    /// The manifest that a record was made from, when the record is there and whole.
    pub fn manifest(&self, key: Digest) -> Option<Manifest> {
        let text = self.disk.read(&self.record_path(key)).ok()?;
        Record::manifest_from_text(&text, key).ok()
    }

    /// A code listing, when the store holds it whole.
    pub fn listing(&self, digest: Digest) -> Option<CodeListing> {
        let bytes = self.object(digest).ok()?;
        CodeListing::parse(std::str::from_utf8(&bytes).ok()?)
    }

    /// What the store holds under a key, every byte of it read.
    pub fn examine(&self, key: Digest) -> Examined {
        let text = match self.disk.read(&self.record_path(key)) {
            Ok(text) => text,
            Err(error) if error.is_missing() => return Examined::Absent,
            Err(error) => return Examined::Broken(error.into()),
        };
        let record = match Record::from_text(&text, key) {
            Ok(record) => record,
            Err(_) => return Examined::Broken(Fault::Altered),
        };
        let lacking: Vec<Lacking> = record
            .outputs
            .iter()
            .filter_map(|output| Some(Lacking { fault: self.object_fault(output.object)?, output: output.clone() }))
            .collect();
        if lacking.is_empty() { Examined::Sound(record) } else { Examined::Lacking(record, lacking) }
    }

    /// Writes a record. Its objects must be there already.
    ///
    /// # Errors
    /// The disk's.
    pub fn write_record(&self, record: &Record, manifest: &Manifest) -> Result<(), StoreError> {
        self.replace(&self.record_path(record.key), record.to_text(manifest)?.as_bytes())
    }

    /// The records that have an output with these bytes, as (key, artifact): what made a file whose origin is in
    /// question. Reads all records.
    ///
    /// # Errors
    /// A store whose records can't be listed; damaged records are passed over.
    pub fn made_by(&self, object: Digest) -> Result<Vec<(Digest, String)>, StoreError> {
        let mut found = Vec::new();
        let entries = self.list_if_there(&self.folder.join("records"))?;
        for key in entries.iter().filter_map(|entry| entry.name.parse::<Digest>().ok()) {
            if let Ok(record) = self.record(key) {
                let outputs = record.outputs.into_iter().filter(|output| output.object == object);
                found.extend(outputs.map(|output| (key, output.name)));
            }
        }
        Ok(found)
    }

    /// Begins to use the store for a run: makes its folder when it is missing and shares its lock. `wait` is called,
    /// again and again, while another holds the store for itself.
    ///
    /// # Errors
    /// The disk's: this is where a store that can't be used is found out.
    pub fn begin(&self, wait: &mut dyn FnMut()) -> Result<Session, StoreError> {
        let path = self.lock_path("store");
        let lock = match self.disk.open_existing_lock(&path) {
            Err(error) if error.is_missing() => self.disk.open_lock(&path)?,
            lock => lock?,
        };
        let leftovers = self.leftovers(&self.scratch());
        if !leftovers.is_empty() && self.disk.try_lock(&lock, &path)? {
            // Nobody else is alive here, so nobody is writing these. A store that can't be written keeps them.
            leftovers.iter().for_each(|leftover| drop(self.disk.remove(leftover)));
            drop(lock.unlock());
        }
        let mut notices = Vec::new();
        loop {
            while !self.disk.try_lock_shared(&lock, &path)? {
                wait();
            }
            match self.marker() {
                Marker::Ours => return Ok(Session { lock, notices }),
                Marker::Other(_) => {
                    // Alone, and looked at again: another run may have done it meanwhile.
                    drop(lock.unlock());
                    while !self.disk.try_lock(&lock, &path)? {
                        wait();
                    }
                    if let Marker::Other(version) = self.marker() {
                        notices.push(self.set_aside(version)?);
                    }
                    notices.extend(self.mark(self.marker())?);
                    drop(lock.unlock());
                }
                lacking => {
                    notices.extend(self.mark(lacking)?);
                    return Ok(Session { lock, notices });
                }
            }
        }
    }

    /// Begins to look at the store without writing: `gc` keeps away meanwhile. None where there is no store.
    ///
    /// # Errors
    /// The disk's; a store of another format.
    pub fn begin_looking(&self, wait: &mut dyn FnMut()) -> Result<Option<Session>, StoreError> {
        let path = self.lock_path("store");
        let lock = match self.disk.open_existing_lock(&path) {
            Err(error) if error.is_missing() => return Ok(None),
            lock => lock?,
        };
        while !self.disk.try_lock_shared(&lock, &path)? {
            wait();
        }
        self.refuse_other_format()?;
        Ok(Some(Session { lock, notices: Vec::new() }))
    }

    /// Takes the store for oneself: no run is alive while the session is held, and runs that begin wait for its end. None
    /// where there is no store.
    ///
    /// # Errors
    /// The disk's; a store of another format.
    pub fn begin_alone(&self, wait: &mut dyn FnMut()) -> Result<Option<Session>, StoreError> {
        let path = self.lock_path("store");
        let lock = match self.disk.open_existing_lock(&path) {
            Err(error) if error.is_missing() => return Ok(None),
            lock => lock?,
        };
        while !self.disk.try_lock(&lock, &path)? {
            wait();
        }
        self.refuse_other_format()?;
        Ok(Some(Session { lock, notices: Vec::new() }))
    }

    /// Ends a run's use of the store; true when no other run is alive, in which case none is writing anything.
    pub(super) fn end(&self, session: Session) -> bool {
        self.disk.try_lock(&session.lock, &self.lock_path("store")).unwrap_or(false)
    }

    /// The entries of a folder; none where there is no such folder.
    pub(super) fn list_if_there(&self, folder: &Path) -> Result<Vec<Entry>, StoreError> {
        match self.disk.list(folder) {
            Err(error) if error.is_missing() => Ok(Vec::new()),
            entries => Ok(entries?),
        }
    }

    /// Temporary files in a folder.
    pub(super) fn leftovers(&self, folder: &Path) -> Vec<PathBuf> {
        let entries = self.disk.list(folder).unwrap_or_default();
        let names = entries.into_iter().filter(|entry| entry.name.starts_with(super::disk::TEMPORARY));
        names.map(|entry| folder.join(entry.name)).collect()
    }
}
