//! A folder with configs, worked on by the built binary.
//!
//! The graph is small: copies of one fast experiment, with fewer starts.

#![allow(dead_code, reason = "each test file uses a part")]

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::time::{Duration, Instant};

const CONFIG: &str = include_str!("../../experiments/remark_3_25.toml");

/// The config with this many starts of its curves.
pub fn config(count: usize) -> String {
    let text = CONFIG.replace("count = 121", &format!("count = {count}"));
    assert_ne!(text, CONFIG, "the line is there");
    text
}

/// What ended.
pub struct Ended {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Ended {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

pub struct Folder {
    pub folder: tempfile::TempDir,
}

impl Folder {
    /// Configs by id and number of starts.
    pub fn with(configs: &[(&str, usize)]) -> Self {
        let folder = Self { folder: tempfile::tempdir().expect("a folder") };
        std::fs::create_dir(folder.path().join("experiments")).expect("made");
        configs.iter().for_each(|(id, count)| folder.write(id, &config(*count)));
        folder
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn write(&self, id: &str, text: &str) {
        std::fs::write(self.path().join(format!("experiments/{id}.toml")), text).expect("written");
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_polhode"));
        command.args(arguments).current_dir(self.path()).stdin(Stdio::null()).env_remove("NO_COLOR");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Ended {
        self.command(arguments).output().expect("the binary runs").into()
    }

    pub fn start(&self, arguments: &[&str]) -> Child {
        self.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the binary starts")
    }

    pub fn store(&self) -> PathBuf {
        self.path().join(".polhode/v1")
    }

    /// The files of a folder below this one, with their bytes.
    pub fn files(&self, below: &str) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut open = vec![self.path().join(below)];
        while let Some(folder) = open.pop() {
            for entry in std::fs::read_dir(&folder).into_iter().flatten() {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    open.push(path);
                } else {
                    let name = path.strip_prefix(self.path()).expect("below").to_string_lossy().into_owned();
                    found.insert(name, std::fs::read(&path).expect("readable"));
                }
            }
        }
        found
    }

    /// What a right run leaves, whatever went before: outputs, records, objects.
    pub fn results(&self) -> BTreeMap<String, Vec<u8>> {
        let mut files = self.files("figures");
        files.extend(self.files(".polhode/v1/records"));
        files.extend(self.files(".polhode/v1/objects"));
        files
    }
}

/// Sends a signal by its name.
pub fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").arg(format!("-{name}")).arg(child.id().to_string()).status();
    assert!(status.expect("kill runs").success());
}

/// Waits until a condition holds, at most a minute.
pub fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < Duration::from_secs(60), "waited a minute until {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Waits for the end; what was on standard error.
pub fn ended(mut child: Child) -> (ExitStatus, String) {
    let mut text = String::new();
    if let Some(mut err) = child.stderr.take() {
        err.read_to_string(&mut text).expect("text");
    }
    (child.wait().expect("waited for"), text)
}
