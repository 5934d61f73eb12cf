//! The store's format: a marker that says which one it is, and what becomes of a store in another one.
//!
//! The folder's name is the format (`v1`); beside it may lie folders of other versions, which are left alone. Inside, the
//! file `format` says the same, under a checksum: a store under a wrong name (copied, or made by a program that changed
//! the format and not the name) is found out before anything in it is read. Its content is moved to `aside/`, whole, and
//! an empty store takes its place; the locks stay where they are, since processes may hold them. Every record carries its
//! own format too, so that nothing is misread even where no marker was looked at (`why`, `show`).
//!
//! A marker that is missing or damaged while there are records is damage like any other: said, and written anew.

use super::disk::DiskError;
use super::record::{Malformed, seal, unseal};
use super::store::{FORMAT, Fault, Store, StoreError};
use std::path::PathBuf;

/// The number in [`FORMAT`].
pub const VERSION: u32 = 1;

const HEADER: &str = "polhode-store";
const MARKER: &str = "format";
const ASIDE: &str = "aside";
/// What stays where it is when a store is set aside.
const STAYING: [&str; 2] = ["locks", ASIDE];

/// What was found out about the format when the store was opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// The store is new here, and folders of other formats lie beside it.
    Others(Vec<PathBuf>),
    /// What lay here was of another format and was moved away.
    SetAside {
        /// Its version.
        version: u32,
        /// Where it is now.
        place: PathBuf,
    },
    /// The marker was missing or damaged; it was written anew.
    Damaged(PathBuf, Fault),
}

impl std::fmt::Display for Notice {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Others(folders) => {
                let names: Vec<String> = folders.iter().map(|folder| folder.display().to_string()).collect();
                write!(f, "stores of other formats are left alone: {}", names.join(", "))
            }
            Self::SetAside { version, place } => {
                write!(
                    f,
                    "the store was of format {version}, which this program does not read: set aside in {}",
                    place.display()
                )
            }
            Self::Damaged(marker, fault) => write!(f, "{} was {fault}: written anew", marker.display()),
        }
    }
}

/// What the marker says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Marker {
    Ours,
    Other(u32),
    Missing,
    Damaged,
    /// It can't be read, so what it says is not known.
    Unreadable(DiskError),
}

/// The marker of a version.
pub fn marker_text(version: u32) -> String {
    seal(HEADER, &format!("{version}\n"))
}

fn version_of(text: &[u8]) -> Result<u32, Malformed> {
    let body = unseal(HEADER, text)?;
    body.trim_end().parse().map_err(|error: std::num::ParseIntError| Malformed::Content(error.to_string()))
}

impl Store {
    /// Where the marker lies.
    pub fn marker_path(&self) -> PathBuf {
        self.folder().join(MARKER)
    }

    pub(super) fn marker(&self) -> Marker {
        match self.disk().read(&self.marker_path()) {
            Ok(text) => match version_of(&text) {
                Ok(VERSION) => Marker::Ours,
                Ok(other) => Marker::Other(other),
                Err(_) => Marker::Damaged,
            },
            Err(error) if error.is_missing() => Marker::Missing,
            Err(error) => Marker::Unreadable(error),
        }
    }

    /// Refuses a store of another format: for those who look and don't write.
    pub(super) fn refuse_other_format(&self) -> Result<(), StoreError> {
        match self.marker() {
            Marker::Other(version) => Err(StoreError::OtherFormat { folder: self.folder().to_owned(), version }),
            Marker::Unreadable(error) => Err(error.into()),
            Marker::Ours | Marker::Missing | Marker::Damaged => Ok(()),
        }
    }

    /// Marks a store that lacks a marker, given what the marker said.
    pub(super) fn mark(&self, found: Marker) -> Result<Option<Notice>, StoreError> {
        let notice = match found {
            Marker::Ours | Marker::Other(_) => return Ok(None),
            // It may be of another format: nothing is written over it.
            Marker::Unreadable(error) => return Err(error.into()),
            Marker::Damaged => Some(Notice::Damaged(self.marker_path(), Fault::Altered)),
            Marker::Missing if self.has_records() => Some(Notice::Damaged(self.marker_path(), Fault::Missing)),
            Marker::Missing => Some(self.other_formats()).filter(|others| !others.is_empty()).map(Notice::Others),
        };
        self.replace(&self.marker_path(), marker_text(VERSION).as_bytes())?;
        Ok(notice)
    }

    fn has_records(&self) -> bool {
        self.disk().list(&self.folder().join("records")).is_ok_and(|entries| !entries.is_empty())
    }

    /// Folders of other formats beside this one: `v0`, `v2`.
    pub fn other_formats(&self) -> Vec<PathBuf> {
        let Some(parent) = self.folder().parent() else { return Vec::new() };
        let is_version =
            |name: &str| name != FORMAT && name.strip_prefix('v').is_some_and(|rest| rest.parse::<u32>().is_ok());
        let entries = self.disk().list(parent).unwrap_or_default().into_iter();
        entries.filter(|entry| entry.is_folder && is_version(&entry.name)).map(|e| parent.join(e.name)).collect()
    }

    /// Moves everything of a store of another format away, its marker last: a process that is killed here leaves the
    /// rest to the next one. The caller has the store for itself.
    pub(super) fn set_aside(&self, version: u32) -> Result<Notice, StoreError> {
        let place_of = |n: u32| self.folder().join(ASIDE).join(format!("v{version}-{n}"));
        let is_taken = |place: &PathBuf| place.join(MARKER).exists();
        let place = (1..).map(place_of).find(|place| !is_taken(place)).unwrap_or_else(|| place_of(0));
        self.disk().create_folder(&place)?;
        let mut names: Vec<String> = self.disk().list(self.folder())?.into_iter().map(|entry| entry.name).collect();
        names.retain(|name| !STAYING.contains(&name.as_str()) && name != MARKER);
        names.push(MARKER.to_owned());
        for name in &names {
            self.disk().rename(&self.folder().join(name), &place.join(name))?;
        }
        let sync = |folder| -> Result<(), DiskError> { self.disk().sync_folder(folder) };
        sync(&place)?;
        sync(self.folder())?;
        Ok(Notice::SetAside { version, place })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every truncation and every flipped bit of the marker is damage, never another version.
    #[test]
    fn a_damaged_marker_is_never_taken_for_another_format() {
        let text = marker_text(VERSION).into_bytes();
        assert_eq!(version_of(&text), Ok(VERSION));
        assert_eq!(version_of(marker_text(7).as_bytes()), Ok(7));
        for length in 0..text.len() {
            assert!(version_of(&text[..length]).is_err(), "truncated to {length}");
        }
        for bit in 0..text.len() * 8 {
            let mut flipped = text.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(version_of(&flipped).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn the_folder_and_the_number_agree() {
        assert_eq!(FORMAT, format!("v{VERSION}"));
    }
}
