//! What whole-program tests share: a folder of its own for each test, and the built command run in it.

#![allow(dead_code, reason = "each test file uses a part")]
#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

use polhode::check::golden::{Golden, render};
use polhode::check::report::verdicts;
use polhode::cli::arguments::{PlaceArguments, RunArguments};
use polhode::cli::session::Session;
use polhode::cli::{check, figures};
use polhode::pipeline::report::Outcome;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use tempfile::TempDir;

/// The repository.
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The ids of the committed experiments.
pub fn all_experiments() -> Vec<String> {
    let entries = std::fs::read_dir(repository().join("experiments")).expect("experiments/");
    let names = entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("Unicode"));
    let mut ids: Vec<String> = names.filter_map(|name| Some(name.strip_suffix(".toml")?.to_owned())).collect();
    ids.sort();
    ids
}

/// How the command ended.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Ran {
    /// It ended with this exit code, and nothing in it panicked.
    #[track_caller]
    pub fn ends(self, code: i32) -> Self {
        assert_eq!(self.code, code, "exit code; stdout:\n{}\nstderr:\n{}", self.out, self.err);
        assert!(!self.err.contains("panicked") && !self.err.contains("RUST_BACKTRACE"), "{}", self.err);
        self
    }

    /// Standard output as JSON with a version.
    #[track_caller]
    pub fn json(&self) -> Value {
        let value: Value = serde_json::from_str(&self.out)
            .unwrap_or_else(|error| panic!("no JSON: {error}\n{}\nstderr:\n{}", self.out, self.err));
        assert!(value["schema"].is_u64(), "JSON without its schema's version: {}", self.out);
        value
    }
}

/// A folder as a user has one: `experiments/`, and what the command makes beside it.
pub struct Workspace {
    root: PathBuf,
    /// Removed with everything in it when the test ends.
    _temporary: Option<TempDir>,
}

impl Workspace {
    /// A new one with copies of the committed configs of these experiments.
    pub fn with<I: AsRef<str>>(ids: &[I]) -> Self {
        let temporary = tempfile::Builder::new().prefix("polhode-test-").tempdir().expect("a temporary folder");
        let root = temporary.path().to_owned();
        std::fs::create_dir(root.join("experiments")).expect("a folder");
        let workspace = Self { root, _temporary: Some(temporary) };
        for id in ids {
            let file = format!("experiments/{}.toml", id.as_ref());
            std::fs::copy(repository().join(&file), workspace.path(&file))
                .unwrap_or_else(|error| panic!("{file}: {error}"));
        }
        workspace
    }

    /// One with everything in it that another has, at a place of its own.
    pub fn copy(&self) -> Self {
        let copy = Self::with::<&str>(&[]);
        copy_tree(&self.root, &copy.root);
        copy
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    pub fn path(&self, inside: &str) -> PathBuf {
        self.root.join(inside)
    }

    /// The command, to be run in this folder.
    pub fn command(&self) -> Command {
        let mut command = polhode();
        command.current_dir(&self.root);
        command
    }

    /// Runs the command in this folder.
    pub fn run<I: IntoIterator<Item = S>, S: AsRef<OsStr>>(&self, arguments: I) -> Ran {
        finish(self.command().args(arguments))
    }

    /// Runs the command with the words of a line.
    pub fn line(&self, words: &str) -> Ran {
        self.run(words.split_whitespace())
    }

    /// Brings everything up to date and gives the report of the run.
    #[track_caller]
    pub fn figures(&self) -> Report {
        Report(self.line("figures --json").ends(0).json())
    }

    pub fn read(&self, inside: &str) -> String {
        let path = self.path(inside);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    pub fn write(&self, inside: &str, text: impl AsRef<[u8]>) {
        let path = self.path(inside);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("written");
    }

    /// Replaces the first occurrence of a text in a config, which must have it.
    #[track_caller]
    pub fn edit(&self, id: &str, from: &str, to: &str) {
        let file = format!("experiments/{id}.toml");
        let text = self.read(&file);
        assert!(text.contains(from), "{file} has no {from:?}:\n{text}");
        self.write(&file, text.replacen(from, to, 1));
    }

    /// All files below a folder with their bytes, by path below it.
    pub fn files(&self, below: &str) -> BTreeMap<String, Vec<u8>> {
        files(&self.path(below))
    }
}

/// The report of a run, as `figures --json` prints it.
#[derive(Debug)]
pub struct Report(pub Value);

impl Report {
    /// The addresses of the nodes with a status, such as `ran`, `cached`, `same-as`; in order of their names.
    pub fn nodes(&self, status: &str) -> Vec<String> {
        let nodes = self.0["report"]["nodes"].as_array().expect("nodes").iter();
        let is = |found: &Value| found == status || found.get(status).is_some();
        let found = nodes.filter(|node| is(&node["status"]));
        let mut found: Vec<String> = found.map(|node| text(&node["address"])).collect();
        found.sort();
        found
    }

    /// The outputs with a status such as `new`, `updated`, `unchanged`, `repaired`; in order of their names.
    pub fn outputs(&self, status: &str) -> Vec<String> {
        let exports = self.0["report"]["exports"].as_array().expect("exports").iter();
        let is = |found: &Value| found == status || found.get(status).is_some();
        let found = exports.filter(|export| is(&export["status"]));
        let mut found: Vec<String> = found.map(|export| text(&export["path"])).collect();
        found.sort();
        found
    }

    /// The addresses of all nodes.
    pub fn all_nodes(&self) -> Vec<String> {
        let nodes = self.0["report"]["nodes"].as_array().expect("nodes").iter();
        nodes.map(|node| text(&node["address"])).collect()
    }

    pub fn damage(&self) -> &[Value] {
        self.0["report"]["damage"].as_array().expect("damage")
    }
}

/// A text in JSON.
#[track_caller]
pub fn text(value: &Value) -> String {
    value.as_str().unwrap_or_else(|| panic!("no text: {value}")).to_owned()
}

/// The built command, with nothing of this process's environment that it listens to.
pub fn polhode() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_polhode"));
    for name in ["NO_COLOR", "RAYON_NUM_THREADS", "POLHODE_SIMD", "GLIBC_TUNABLES", "RUST_BACKTRACE"] {
        command.env_remove(name);
    }
    command
}

/// No command of the tests runs longer, even on a busy machine.
const LIMIT: Duration = Duration::from_secs(300);

/// Runs a command to its end.
#[track_caller]
pub fn finish(command: &mut Command) -> Ran {
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().expect("the command starts");
    let (out, err) = (collect(child.stdout.take()), collect(child.stderr.take()));
    let (Ok(out), Ok(err)) = (out.recv_timeout(LIMIT), err.recv_timeout(LIMIT)) else {
        child.kill().expect("killed");
        panic!("{command:?} does not end");
    };
    let status = child.wait().expect("the command ends");
    let code = status.code().unwrap_or_else(|| panic!("killed: {status:?}"));
    Ran { code, out, err }
}

/// What a stream gives until its end.
fn collect(stream: Option<impl Read + Send + 'static>) -> Receiver<String> {
    let mut stream = stream.expect("a pipe");
    let (sender, receiver) = channel();
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("readable");
        // Nobody listens any more when the command took too long.
        drop(sender.send(String::from_utf8(bytes).expect("UTF-8")));
    });
    receiver
}

/// All files below a folder with their bytes, by path below it.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let (mut found, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(inner) = open.pop() {
        let Ok(entries) = std::fs::read_dir(&inner) else { continue };
        for entry in entries {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below").to_string_lossy().into_owned();
                found.insert(name, std::fs::read(&path).expect("readable"));
            }
        }
    }
    found
}

fn copy_tree(from: &Path, to: &Path) {
    for (name, bytes) in files(from) {
        let path = to.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, bytes).expect("written");
    }
}

/// A workspace that the tests of one file share: made once, below `target/tmp`, up to date. A static is never dropped,
/// so it is removed by the next run instead; a lock keeps a second run of the same tests waiting meanwhile.
pub struct Shared {
    pub workspace: Workspace,
    _lock: File,
}

impl Shared {
    /// Empties the folder `target/tmp/NAME`, puts the configs of these experiments there and runs `figures`.
    pub fn computed<I: AsRef<str>>(name: &str, ids: &[I]) -> Self {
        let shared = Self::empty(name, ids);
        shared.workspace.line("figures --no-progress").ends(0);
        shared
    }

    /// The same without the run.
    pub fn empty<I: AsRef<str>>(name: &str, ids: &[I]) -> Self {
        let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let lock = File::create(root.with_extension("lock")).expect("a lock");
        lock.lock().expect("locked");
        let _ = std::fs::remove_dir_all(&root);
        let fresh = Workspace::with(ids);
        copy_tree(&fresh.root, &root);
        Self { workspace: Workspace { root, _temporary: None }, _lock: lock }
    }
}

/// What the goldens should say now, by experiment.
pub fn goldens(workspace: &Workspace) -> Vec<(String, String)> {
    let place = PlaceArguments { experiments: Some(workspace.path("experiments")), ..PlaceArguments::default() };
    let mut session = Session::begin(&place, &[]).unwrap_or_else(|refused| panic!("{}", refused.text));
    let report = figures::execute(&mut session, &RunArguments { place, no_progress: true, ..RunArguments::default() });
    let failures: Vec<String> = report.failures().map(|(address, failure)| format!("{address}: {failure}")).collect();
    assert_eq!(report.outcome(), Outcome::Success, "{}", failures.join("\n"));
    let subjects = check::subjects(&session, &report).unwrap_or_else(|refused| panic!("{}", refused.text));
    let golden = subjects.into_iter().map(|subject| {
        let golden = Golden { verdicts: verdicts(&subject.findings.claims), ..subject.golden };
        (golden.experiment.clone(), render(&golden))
    });
    golden.collect()
}
