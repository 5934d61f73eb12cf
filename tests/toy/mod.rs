//! A toy experiment that counts how often its nodes run.
//!
//! `source` (a value `k`, rounded down) → `middle` (times ten) → `top` (as words, exported), and `aside` (stands alone,
//! exported). What a node does can be made to fail, to panic or to take time by its parameters' names.

#![allow(dead_code, reason = "each test file uses a part")]

use polhode::contract::manifest::{Line, describe};
use polhode::contract::node::{Address, Artifact, Compute, Inputs, Kind, Node, NodeError, Product};
use polhode::contract::plan::{ConfigSource, Export, Plan};
use polhode::contract::work::Work;
use polhode::pipeline::events::Silent;
use polhode::pipeline::graph::Graph;
use polhode::pipeline::report::Report;
use polhode::pipeline::run::{Options, run};
use polhode::pipeline::store::Store;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;

pub static SOURCE: Kind = Kind { name: "source", summary: "a number", code: &["numerics"], measurement: false };
pub static STEP: Kind = Kind { name: "step", summary: "a step", code: &["contract/value.rs"], measurement: false };
pub static CLOCK: Kind = Kind { name: "clock", summary: "a time", code: &["numerics"], measurement: true };

/// How often each node ran, by label.
#[derive(Clone, Default)]
pub struct Counts(Arc<Mutex<BTreeMap<String, usize>>>);

impl Counts {
    fn add(&self, label: &str) {
        *self.0.lock().expect("unpoisoned").entry(label.to_owned()).or_default() += 1;
    }

    /// The labels that ran since the last call, with how often, as `source middle×2`.
    pub fn take(&self) -> String {
        let counts = std::mem::take(&mut *self.0.lock().expect("unpoisoned"));
        let words = counts.iter().map(|(label, n)| if *n == 1 { label.clone() } else { format!("{label}×{n}") });
        words.collect::<Vec<_>>().join(" ")
    }
}

/// A node of the toy.
#[derive(Clone, Serialize)]
pub struct Step {
    #[serde(skip)]
    pub label: String,
    #[serde(skip)]
    pub kind: Option<&'static Kind>,
    #[serde(skip)]
    pub counts: Counts,
    #[serde(skip)]
    pub takes: Duration,
    /// `floor`, `times ten`, `words`, `fail`, `panic`.
    pub act: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k: Option<f64>,
}

impl Compute for Step {
    fn kind(&self) -> &'static Kind {
        self.kind.unwrap_or(&STEP)
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.counts.add(&self.label);
        std::thread::sleep(self.takes);
        let input = || -> Result<f64, NodeError> {
            let text = String::from_utf8(inputs.get("x")?.bytes.to_vec()).map_err(|e| NodeError::new(e.to_string()))?;
            text.parse().map_err(|_| NodeError::new(format!("no number: {text:?}")))
        };
        let text = match self.act {
            "floor" => self.k.unwrap_or_default().floor().to_string(),
            "times ten" => (10.0 * input()?).to_string(),
            "words" => format!("the number is {}\n", input()?),
            "alone" => "alone\n".to_owned(),
            "fail" => return Err(NodeError::new("no root between 1 and 2")),
            "panic" => none("index 7 of 5"),
            other => return Err(NodeError::new(format!("what is {other:?}?"))),
        };
        let work = Work { steps: 1, ..Work::default() };
        Ok(Product { artifacts: vec![Artifact::opaque("out.txt", text.into_bytes())], work })
    }
}

/// A folder with configs, a store and an output folder.
pub struct Bench {
    pub folder: tempfile::TempDir,
    pub counts: Counts,
}

impl Bench {
    pub fn new() -> Self {
        // In memory where there is such a place: thousands of stores are written, and fsync on a busy disk takes its time.
        let memory = Path::new("/dev/shm");
        let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        Self { folder: folder.or_else(|_| tempfile::tempdir()).expect("a folder"), counts: Counts::default() }
    }

    pub fn store(&self) -> Store {
        Store::below(self.folder.path())
    }

    pub fn out(&self) -> PathBuf {
        self.folder.path().join("figures")
    }

    pub fn options(&self) -> Options {
        let mut options = Options::new(self.folder.path(), self.out());
        options.jobs = 2;
        options
    }

    pub fn step(&self, label: &str, act: &'static str) -> Step {
        let (label, counts) = (label.to_owned(), self.counts.clone());
        Step { label, kind: None, counts, takes: Duration::ZERO, act, k: None }
    }

    /// The toy experiment; `config` is what its text would be.
    pub fn plan(&self, id: &str, k: f64) -> Plan {
        let source = Step { k: Some(k), kind: Some(&SOURCE), ..self.step("source", "floor") };
        let at = |name: &str| Address::new(id, name);
        let node = |name: &str, step: Step| Node::new(at(name), step).expect("describable");
        let export = |path: &str, from: &str| Export { path: path.into(), from: at(from), artifact: "out.txt".into() };
        Plan {
            id: id.into(),
            config: ConfigSource { file: format!("experiments/{id}.toml"), text: format!("# the toy\nk = {k}\n") },
            nodes: vec![
                node("top", self.step("top", "words")).input("x", &at("middle"), "out.txt"),
                node("middle", self.step("middle", "times ten")).input("x", &at("source"), "out.txt"),
                node("source", source).origin("k", "k"),
                node("aside", self.step("aside", "alone")),
            ],
            exports: vec![export(&format!("{id}.txt"), "top"), export(&format!("data/{id}/aside.txt"), "aside")],
        }
    }

    pub fn graph(&self, k: f64) -> Graph {
        Graph::join(vec![self.plan("toy", k)]).expect("a sound graph")
    }

    pub fn run(&self, k: f64) -> Report {
        self.run_graph(&self.graph(k))
    }

    pub fn run_graph(&self, graph: &Graph) -> Report {
        run(graph, &graph.all(), &self.store(), &self.options(), &mut Silent)
    }

    /// The files of the output folder, with their texts.
    pub fn outputs(&self) -> BTreeMap<String, String> {
        let mut found = BTreeMap::new();
        for path in files(&self.out()) {
            let name = path.strip_prefix(self.out()).expect("below").to_string_lossy().into_owned();
            found.insert(name, std::fs::read_to_string(&path).expect("text"));
        }
        found
    }
}

/// All files below a folder.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry").path();
        if path.is_dir() { found.extend(files(&path)) } else { found.push(path) }
    }
    found.sort();
    found
}

/// Parameters as lines, for comparing.
pub fn lines<T: Serialize>(params: &T) -> Vec<Line> {
    describe(params).expect("describable")
}

/// Panics with this message, as a defect would.
#[expect(clippy::panic, reason = "a node with a defect is what some tests are about")]
fn none(message: &str) -> String {
    panic!("{message}")
}
