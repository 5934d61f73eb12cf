//! Code fingerprints: what of this program's source a kind of node depends on.
//!
//! `build.rs` digests the token stream of every file below `src/` (`tokens.rs` says what counts) and writes the table
//! that is included here: files with their digests, the external crates that each names, the crates' checksums from
//! `Cargo.lock`, the compiler. A [`Kind`] declares rooms and files; its listing holds
//! these files, the external crates that they reach, and the compiler. Comments, docs, layout, test code and files that
//! only list modules are not in it.

use super::digest::{Digest, Framed};
use super::node::Kind;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::{Arc, LazyLock, Mutex};

/// One file: its path below `src/`, its digest, the external crates it names, the paths in this crate it names.
pub struct FileCode {
    /// `numerics/real.rs`.
    pub path: &'static str,
    /// The digest of its tokens.
    pub digest: &'static str,
    /// The external crates that it names, as indices into the table of crates.
    pub crates: &'static [usize],
    /// The places in this crate that it names: `geometry/spin`, `numerics/real`.
    pub paths: &'static [&'static str],
}

/// One external crate: its name, version and checksum, and the crates that it depends on.
pub struct CrateCode {
    /// `libm`.
    pub name: &'static str,
    /// `0.2.16 1234…`: version and checksum.
    pub version: &'static str,
    /// What it depends on, as indices into the table of crates.
    pub dependencies: &'static [usize],
}

mod generated {
    use super::{CrateCode, FileCode};
    include!(concat!(env!("OUT_DIR"), "/fingerprints.rs"));
}

/// The compiler that this program was built with.
pub const COMPILER: &str = generated::COMPILER;

/// The files that take part, ordered by path.
pub const FILES: &[FileCode] = generated::FILES;

/// The digest of this program: all files, the external crates, the compiler. What is planned follows from it and the configs.
pub fn program() -> Digest {
    let mut framed = Framed::new("polhode program 1");
    let files = FILES.iter().map(|file| (file.path, file.digest));
    let crates = generated::CRATES.iter().map(|found| (found.name, found.version));
    for (name, value) in files.chain(crates).chain([("compiler", COMPILER)]) {
        framed.field(name.as_bytes()).field(value.as_bytes());
    }
    framed.finish()
}

/// Rooms' parts that results do not depend on: the contract's own machinery, whose changes show in the keys themselves.
const MACHINERY: &[&str] = &[
    "contract/accuracy.rs",
    "contract/code.rs",
    "contract/digest.rs",
    "contract/manifest.rs",
    "contract/node.rs",
    "contract/plan.rs",
    "contract/work.rs",
];

/// A line of a listing: `("numerics/real.rs", digest)`, `("crate libm", version and checksum)`, `("compiler", version)`. This program's
/// own lines are borrowed from its tables: every command makes the listings of all kinds before anything else.
pub type CodeLine = (Cow<'static, str>, Cow<'static, str>);

/// The code that a kind depends on, line by line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CodeListing {
    /// The lines, ordered.
    pub lines: Vec<CodeLine>,
    /// The digest of [`Self::text`].
    pub digest: Digest,
}

/// A line that differs between two listings.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CodeChange {
    /// The file, crate or `compiler`.
    pub name: String,
    /// What it was, if it was there.
    pub old: Option<String>,
    /// What it is, if it is there.
    pub new: Option<String>,
}

impl CodeListing {
    /// A listing of these lines.
    pub fn new(lines: impl IntoIterator<Item = CodeLine>) -> Self {
        let mut lines: Vec<_> = lines.into_iter().collect();
        // Stable on purpose: the lines come as a few sorted runs, which it merges.
        lines.sort();
        let digest = Digest::of(text_of(&lines).as_bytes());
        Self { lines, digest }
    }

    /// The text form: a line each, name and value parted by a tab. Stored, so that a later run can say what changed.
    pub fn text(&self) -> String {
        text_of(&self.lines)
    }

    /// Reads the text form.
    pub fn parse(text: &str) -> Option<Self> {
        let lines: Option<Vec<_>> = text.lines().map(|line| line.split_once('\t')).collect();
        Some(Self::new(lines?.into_iter().map(|(name, value)| (name.to_owned().into(), value.to_owned().into()))))
    }

    /// What differs in a newer listing.
    pub fn changes(&self, newer: &Self) -> Vec<CodeChange> {
        let lines = |listing: &Self| listing.lines.iter().cloned().collect::<BTreeMap<_, _>>();
        let (old, new) = (lines(self), lines(newer));
        let names: BTreeSet<&Cow<'static, str>> = old.keys().chain(new.keys()).collect();
        let differing = names.into_iter().filter(|name| old.get(*name) != new.get(*name));
        let value = |listing: &BTreeMap<_, Cow<'static, str>>, name| listing.get(name).map(|value| value.to_string());
        differing
            .map(|name| CodeChange { name: name.to_string(), old: value(&old, name), new: value(&new, name) })
            .collect()
    }
}

fn text_of(lines: &[CodeLine]) -> String {
    let mut text = String::with_capacity(lines.iter().map(|(name, value)| name.len() + value.len() + 2).sum());
    for (name, value) in lines {
        for part in [name, "\t", value, "\n"] {
            text.push_str(part);
        }
    }
    text
}

/// An entry of [`Kind::code`] that names no file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("kind {kind:?} declares the code {entry:?}, but there is no such room, folder or file below src/")]
pub struct UnknownCode {
    /// The kind.
    pub kind: &'static str,
    /// The entry.
    pub entry: &'static str,
}

/// The code that a kind depends on. Computed once per kind.
///
/// # Errors
/// An entry that matches no file.
pub fn listing(kind: &Kind) -> Result<Arc<CodeListing>, UnknownCode> {
    type Known = HashMap<(&'static str, &'static [&'static str]), Arc<CodeListing>>;
    static KNOWN: LazyLock<Mutex<Known>> = LazyLock::new(Mutex::default);
    let known = || KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some(listing) = known().get(&(kind.name, kind.code)) {
        return Ok(Arc::clone(listing));
    }
    let files = files_of(kind)?;
    let mut lines: Vec<CodeLine> = files.iter().map(|file| (file.path.into(), file.digest.into())).collect();
    lines.extend(crates_of(&files).into_iter().map(|(name, version)| (name.into(), version)));
    lines.push(("compiler".into(), COMPILER.into()));
    let listing = Arc::new(CodeListing::new(lines));
    known().insert((kind.name, kind.code), Arc::clone(&listing));
    Ok(listing)
}

/// Whether a file is, or lies in, a room, folder or file as kinds declare them.
fn covers(entry: &str, path: &str) -> bool {
    path.strip_prefix(entry).is_some_and(|rest| rest.is_empty() || rest.starts_with('/') || rest == ".rs")
}

fn files_of(kind: &Kind) -> Result<Vec<&'static FileCode>, UnknownCode> {
    let mut is_in = vec![false; FILES.len()];
    for entry in kind.code {
        // Files are ordered by path, so those that begin alike stand together.
        let first = FILES.partition_point(|file| file.path < *entry);
        let alike = FILES[first..].iter().take_while(|file| file.path.starts_with(entry)).enumerate();
        let mut is_there = false;
        for (i, _) in alike.filter(|(_, file)| covers(entry, file.path)) {
            (is_in[first + i], is_there) = (true, true);
        }
        if !is_there {
            return Err(UnknownCode { kind: kind.name, entry });
        }
    }
    Ok(FILES.iter().zip(is_in).filter(|(_, is_in)| *is_in).map(|(file, _)| file).collect())
}

/// The external crates that files name, and all that these depend on, as lines: `crate libm`, version; versions of one crate on one line.
fn crates_of(files: &[&FileCode]) -> BTreeMap<&'static str, Cow<'static, str>> {
    static LINES: LazyLock<Vec<String>> =
        LazyLock::new(|| generated::CRATES.iter().map(|found| format!("crate {}", found.name)).collect());
    let mut reached = vec![false; generated::CRATES.len()];
    let mut open: Vec<usize> = files.iter().flat_map(|file| file.crates.iter().copied()).collect();
    while let Some(index) = open.pop() {
        if let (Some(found), Some(reached)) = (generated::CRATES.get(index), reached.get_mut(index))
            && !std::mem::replace(reached, true)
        {
            open.extend(found.dependencies);
        }
    }
    let mut versions: BTreeMap<&'static str, Cow<'static, str>> = BTreeMap::new();
    let all = LINES.iter().zip(generated::CRATES).zip(reached);
    for ((line, found), _) in all.filter(|(_, is_reached)| *is_reached) {
        let entry = versions.entry(line).or_default();
        *entry = if entry.is_empty() { found.version.into() } else { format!("{entry}, {}", found.version).into() };
    }
    versions
}

/// The files that the declared code of a kind names and the kind does not declare, as (file, names): a kind for which
/// this is not empty could serve an old result for new code.
///
/// # Errors
/// An entry that matches no file.
pub fn undeclared(kind: &Kind) -> Result<Vec<(&'static str, &'static str)>, UnknownCode> {
    let declared = files_of(kind)?;
    let mut missing = BTreeSet::new();
    for file in &declared {
        for target in file.paths.iter().filter_map(|path| resolve(path)) {
            let is_declared = declared.iter().any(|known| known.path == target);
            if !is_declared && !MACHINERY.contains(&target) {
                missing.insert((file.path, target));
            }
        }
    }
    Ok(missing.into_iter().collect())
}

/// The file that a path names: the longest beginning of it that is a file or a folder's `mod.rs`.
fn resolve(path: &str) -> Option<&'static str> {
    let mut path = path;
    loop {
        let is_it = |file: &&FileCode| {
            file.path.strip_suffix(".rs").is_some_and(|stem| stem == path || stem.strip_suffix("/mod") == Some(path))
        };
        if let Some(file) = FILES.iter().find(is_it) {
            return Some(file.path);
        }
        path = path.rsplit_once('/')?.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(code: &'static [&'static str]) -> Kind {
        Kind { name: "toy", summary: "", code, measurement: false }
    }

    #[test]
    fn an_entry_is_a_room_a_folder_or_a_file() {
        assert!(covers("numerics", "numerics/real.rs"));
        assert!(covers("numerics/elliptic", "numerics/elliptic/carlson.rs"));
        assert!(covers("numerics/real.rs", "numerics/real.rs"));
        assert!(covers("numerics/real", "numerics/real.rs"));
        assert!(!covers("numerics/real", "numerics/realm.rs"));
        assert!(!covers("num", "numerics/real.rs"));
    }

    #[test]
    fn an_entry_that_matches_nothing_is_an_error() {
        let error = listing(&kind(&["numerics", "numeric"])).expect_err("no such room");
        assert_eq!(error, UnknownCode { kind: "toy", entry: "numeric" });
    }

    /// The listing of `numerics` holds its files, `libm` with its checksum, the compiler; no list of names, no other room.
    #[test]
    fn a_listing_names_files_crates_and_compiler() {
        let listing = listing(&kind(&["numerics"])).expect("known");
        let names: Vec<&str> = listing.lines.iter().map(|(name, _)| name.as_ref()).collect();
        for name in ["numerics/real.rs", "numerics/elliptic/carlson.rs", "crate libm", "compiler"] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        for name in ["numerics/mod.rs", "contract/node.rs", "crate serde", "crate polars"] {
            assert!(!names.contains(&name), "{name} in {names:?}");
        }
        assert_eq!(CodeListing::parse(&listing.text()).as_ref(), Some(&*listing));
    }

    /// `contract/node.rs` uses serde, which depends on more: the closure is in the listing.
    #[test]
    fn crates_are_closed_over_their_dependencies() {
        let listing = listing(&kind(&["contract/node.rs"])).expect("known");
        let names: Vec<&str> = listing.lines.iter().map(|(name, _)| name.as_ref()).collect();
        assert!(names.contains(&"crate serde") && names.contains(&"crate serde_core"), "{names:?}");
    }

    #[test]
    fn code_that_is_used_but_not_declared_is_found() {
        assert_eq!(undeclared(&kind(&["numerics"])), Ok(vec![]));
        let missing = undeclared(&kind(&["numerics/elliptic"])).expect("known");
        assert!(missing.contains(&("numerics/elliptic/complete.rs", "numerics/real.rs")), "{missing:?}");
    }
}
