//! Every error that a node, an object, a record, a lock, an output or the store itself can end with, reached on purpose. The names
//! are `match`es without a wildcard: a new variant does not compile until it stands here, and each name must have been reached.
//! (Errors of records and of `gc` are reached in `upkeep.rs`, those of `show` in `pipeline.rs`.)

#![expect(clippy::expect_used, reason = "helpers of tests")]

mod toy;

use polhode::contract::digest::Digest;
use polhode::contract::node::{Artifact, Compute, Inputs, Kind, Node, NodeError, Product};
use polhode::contract::plan::Plan;
use polhode::contract::work::Work;
use polhode::pipeline::disk::{Disk, DiskError, Operation, Probe};
use polhode::pipeline::events::Silent;
use polhode::pipeline::format::marker_text;
use polhode::pipeline::gc::{GcError, GcOptions, gc};
use polhode::pipeline::graph::Graph;
use polhode::pipeline::record::Malformed;
use polhode::pipeline::report::{ExportStatus, Failure, Outcome, Repair, Report, Status, Subject};
use polhode::pipeline::run::{Options, run};
use polhode::pipeline::settled::Question;
use polhode::pipeline::store::{Fault, Store, StoreError};
use polhode::pipeline::verify::{Sample, verify};
use serde::Serialize;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toy::{Bench, STEP, files};

/// Names that were reached.
#[derive(Default)]
struct Reached(BTreeSet<&'static str>);

impl Reached {
    fn fault(&mut self, fault: &Fault) {
        let name = match fault {
            Fault::Missing => "missing",
            Fault::Altered => "altered",
            Fault::Unreadable(_) => "unreadable",
        };
        self.0.insert(name);
    }

    fn store(&mut self, error: &StoreError) {
        let name = match error {
            StoreError::Disk(_) => "disk",
            StoreError::Rotted { .. } => "rotted",
            StoreError::OtherFormat { .. } => "other format",
            StoreError::Unwritable(_) => "unwritable",
        };
        self.0.insert(name);
        assert!(!error.to_string().is_empty());
    }

    fn failure(&mut self, failure: &Failure) {
        let name = match failure {
            Failure::Node(_) => "node",
            Failure::Panic(_) => "panic",
            Failure::NoSuchArtifact { .. } => "no such artifact",
            Failure::DuplicateArtifact(_) => "duplicate artifact",
            Failure::Store(error) => {
                self.store(error);
                "a node's store"
            }
        };
        self.0.insert(name);
    }

    /// Everything in a report.
    fn report(&mut self, report: &Report) {
        for node in &report.nodes {
            let name = match &node.status {
                Status::Cached => "cached",
                Status::Ran => "ran",
                Status::SameAs(_) => "same as",
                Status::Failed(failure) => {
                    self.failure(failure);
                    "failed"
                }
                Status::Blocked(_) => "blocked",
                Status::NotReached => "not reached",
            };
            self.0.insert(name);
        }
        for export in &report.exports {
            let name = match &export.status {
                ExportStatus::Unchanged => "unchanged",
                ExportStatus::New => "new",
                ExportStatus::Updated => "updated",
                ExportStatus::Repaired(fault) => {
                    self.fault(fault);
                    "repaired"
                }
                ExportStatus::Replaced => "replaced",
                ExportStatus::Failed(error) => {
                    self.store(error);
                    "output failed"
                }
                ExportStatus::NoSuchArtifact(failure) => {
                    self.failure(failure);
                    "output of nothing"
                }
                ExportStatus::NotMade => "not made",
            };
            self.0.insert(name);
        }
        for damage in &report.damage {
            self.fault(&damage.fault);
            let name = match damage.subject {
                Subject::Record => "record",
                Subject::Object => "object",
                Subject::Listing => "listing",
                Subject::Heads => "heads",
                Subject::Settled => "settled",
                Subject::Format => "format",
                Subject::Output => "output",
            };
            self.0.insert(name);
            let name = match damage.repair {
                Repair::FromStore => "from store",
                Repair::FromOutput => "from output",
                Repair::RunAgain => "run again",
                Repair::Rewritten => "rewritten",
            };
            self.0.insert(name);
        }
        report.store_errors.iter().for_each(|error| self.store(error));
    }
}

const NAMES: [&str; 39] = [
    // Of stored files.
    "missing",
    "altered",
    "unreadable",
    // Of the store.
    "disk",
    "rotted",
    "other format",
    "unwritable",
    // Of nodes.
    "node",
    "panic",
    "no such artifact",
    "duplicate artifact",
    "a node's store",
    "cached",
    "ran",
    "same as",
    "failed",
    "blocked",
    "not reached",
    // Of outputs.
    "unchanged",
    "new",
    "updated",
    "repaired",
    "replaced",
    "output failed",
    "output of nothing",
    "not made",
    // What was damaged, and what was done about it.
    "record",
    "object",
    "listing",
    "heads",
    "settled",
    "format",
    "output",
    "from store",
    "from output",
    "run again",
    "rewritten",
    // Of `verify` and `gc` of a store that can't be read.
    "verify",
    "gc",
];

/// Fails each call that it is asked about.
struct Refuse<F>(F);

impl<F: Fn(Operation, &Path) -> bool + Send + Sync> Probe for Refuse<F> {
    fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
        if (self.0)(operation, path) { Err(io::ErrorKind::StorageFull.into()) } else { Ok(()) }
    }
}

fn refusing(bench: &Bench, refuse: impl Fn(Operation, &Path) -> bool + Send + Sync + 'static) -> Store {
    Store::with_disk(bench.store().folder(), Disk::probed(Arc::new(Refuse(refuse))))
}

/// Makes two artifacts of one name.
#[derive(Serialize)]
struct Twice {}

impl Compute for Twice {
    fn kind(&self) -> &'static Kind {
        &STEP
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let artifact = || Artifact::opaque("out.txt", b"twice".to_vec());
        Ok(Product { artifacts: vec![artifact(), artifact()], work: Work::default() })
    }
}

/// The toy with another node in place of the one at an address.
fn with_node(bench: &Bench, name: &str, make: impl FnOnce(&Plan) -> Node) -> Graph {
    let mut plan = bench.plan("toy", 0.8);
    let node = make(&plan);
    let place = plan.nodes.iter().position(|node| node.address.node == name).expect("there");
    plan.nodes[place] = node;
    Graph::join(vec![plan]).expect("sound")
}

fn flip(path: &Path) {
    let mut bytes = std::fs::read(path).expect("readable");
    *bytes.last_mut().expect("bytes") ^= 1;
    std::fs::write(path, bytes).expect("writable");
}

/// Nodes that fail in every way.
fn failing_nodes(reached: &mut Reached) {
    let bench = Bench::new();
    for act in ["fail", "panic"] {
        let step = bench.step("source", act);
        let graph = with_node(&bench, "source", |plan| Node::new(plan.nodes[2].address.clone(), step).expect("lines"));
        let report = bench.run_graph(&graph);
        assert_eq!(report.outcome(), Outcome::NodeFailed);
        reached.report(&report);
    }
    let twice = with_node(&bench, "aside", |plan| Node::new(plan.nodes[3].address.clone(), Twice {}).expect("lines"));
    reached.report(&bench.run_graph(&twice));
    let mut plan = bench.plan("toy", 0.8);
    plan.exports[0].artifact = "none.txt".to_owned();
    plan.nodes[1].inputs[0].artifact = "none.txt".to_owned();
    reached.report(&bench.run_graph(&Graph::join(vec![plan]).expect("sound")));
    // An output alone that asks for what its node does not make.
    let mut plan = bench.plan("toy", 0.8);
    plan.exports[1].artifact = "none.txt".to_owned();
    reached.report(&bench.run_graph(&Graph::join(vec![plan]).expect("sound")));
    // Two experiments that ask for the same.
    let twins = Graph::join(vec![bench.plan("one", 3.5), bench.plan("two", 3.5)]).expect("sound");
    reached.report(&bench.run_graph(&twins));
    // A run that ends at the first failure.
    let step = bench.step("aside", "fail");
    let graph = with_node(&bench, "aside", |plan| Node::new(plan.nodes[3].address.clone(), step).expect("lines"));
    let mut options = bench.options();
    (options.fail_fast, options.jobs, options.force) = (true, 1, true);
    reached.report(&run(&graph, &graph.all(), &bench.store(), &options, &mut Silent));
}

/// Outputs in every state.
fn outputs(reached: &mut Reached) {
    let bench = Bench::new();
    let file = bench.out().join("toy.txt");
    std::fs::create_dir_all(bench.out()).expect("made");
    std::fs::write(&file, "mine").expect("written");
    reached.report(&bench.run(0.8));
    reached.report(&bench.run(0.8));
    reached.report(&bench.run(1.8));
    std::fs::remove_file(&file).expect("removed");
    reached.report(&bench.run(1.8));
    flip(&file);
    reached.report(&bench.run(1.8));
    let is_output = |path: &Path| path.ends_with("figures/toy.txt");
    let store = refusing(&bench, move |operation, path| operation == Operation::Read && is_output(path));
    let graph = bench.graph(1.8);
    reached.report(&run(&graph, &graph.all(), &store, &bench.options(), &mut Silent));
    std::fs::remove_file(&file).expect("removed");
    std::fs::create_dir(&file).expect("made");
    let report = bench.run(1.8);
    assert_eq!(report.outcome(), Outcome::StoreFailed);
    reached.report(&report);
}

/// Everything in the store, harmed.
fn damage(reached: &mut Reached) {
    let bench = Bench::new();
    let first = bench.run(0.8);
    let store = bench.store();
    let key = |name: &str| {
        let node = first.nodes.iter().find(|node| node.address.node == name).expect("there");
        node.key.expect("a key")
    };
    flip(&store.record_path(key("source")));
    reached.report(&bench.run(0.8));
    // The object of an output comes back from the output, that of an inner node by running again.
    flip(&store.object_path(store.record(key("aside")).expect("a record").outputs[0].object));
    reached.report(&bench.run(0.8));
    flip(&store.object_path(store.record(key("middle")).expect("a record").outputs[0].object));
    reached.report(&bench.run(0.8));
    // The listing of code is looked at when a node of that code runs.
    let listing = store.manifest(key("aside")).and_then(|manifest| manifest.code()).expect("a listing");
    flip(&store.object_path(listing));
    std::fs::remove_file(store.record_path(key("aside"))).expect("removed");
    reached.report(&bench.run(0.8));
    files(&store.folder().join("heads")).iter().for_each(|path| flip(path));
    flip(&store.marker_path());
    reached.report(&bench.run(0.8));
    assert_eq!(bench.run(0.8).damage, []);
    let question = Some(Question { digest: Digest::of(b"0.8"), note: String::new() });
    let (graph, options) = (bench.graph(0.8), Options { question, ..bench.options() });
    run(&graph, &graph.all(), &store, &options, &mut Silent);
    files(&store.folder().join("settled")).iter().for_each(|path| flip(path));
    reached.report(&run(&graph, &graph.all(), &store, &options, &mut Silent));
}

/// The store as a whole.
fn store(reached: &mut Reached) {
    let sample = Sample { nodes: 1, seed: 0 };
    let options = GcOptions { keep: 1, here: false, dry_run: false };
    // No lock file can be opened.
    let bench = Bench::new();
    let is_lock = |operation, path: &Path| operation == Operation::OpenLock && !path.ends_with("locks/store");
    let graph = bench.graph(0.8);
    let report = run(&graph, &graph.all(), &refusing(&bench, is_lock), &bench.options(), &mut Silent);
    assert_eq!(report.outcome(), Outcome::StoreFailed);
    reached.report(&report);
    // An object rots between the look at it and its use.
    bench.run(0.8);
    let object = Digest::of(b"0");
    let place: PathBuf = bench.store().object_path(object);
    let graph = bench.graph(0.8);
    let mut forced = bench.options();
    forced.force = true;
    let is_done = AtomicBool::new(false);
    let rots = move |operation, path: &Path| {
        // `top` reads what `middle` made: the same object as that of `source`.
        if operation == Operation::Read && path == place && is_done.swap(true, Ordering::SeqCst) {
            std::fs::write(&place, "9").expect("written");
        }
        false
    };
    reached.report(&run(&graph, &graph.all(), &refusing(&bench, rots), &forced, &mut Silent));
    // Another format: who only looks refuses it.
    std::fs::write(bench.store().marker_path(), marker_text(7)).expect("written");
    let error = verify(&graph, &graph.all(), &bench.store(), &bench.options(), sample, &mut Silent).expect_err("old");
    reached.store(&error);
    // What can't be listed can't be verified or collected.
    let bench = Bench::new();
    bench.run(0.8);
    let store = refusing(&bench, |operation, _| operation == Operation::List);
    if let Err(error) = verify(&graph, &graph.all(), &store, &bench.options(), sample, &mut Silent) {
        reached.store(&error);
        reached.0.insert("verify");
    }
    if let Err(GcError::Store(error)) = gc(&graph, &graph.all(), &store, &bench.options(), options, &mut || {}) {
        reached.store(&error);
        reached.0.insert("gc");
    }
    // The only way to this one is the conversion: what is written can always be written.
    reached.store(&StoreError::from(Malformed::Checksum));
}

#[test]
fn every_error_of_the_store_is_reached() {
    let mut reached = Reached::default();
    failing_nodes(&mut reached);
    outputs(&mut reached);
    damage(&mut reached);
    store(&mut reached);
    let missed: Vec<&str> = NAMES.into_iter().filter(|name| !reached.0.contains(name)).collect();
    assert!(missed.is_empty(), "not reached: {missed:?}");
    assert!(reached.0.iter().all(|name| NAMES.contains(name)), "a name that is not listed: {:?}", reached.0);
}

/// Each call to the file system, refused: the error says which call it was and on which path, from a run, `gc` or `verify`;
/// the next run is right. A refused read is no error but a fault of the file that can't be read.
#[test]
fn every_call_to_the_file_system_is_an_error_that_says_so() {
    let name = |operation| match operation {
        Operation::CreateFolder => "create the folder",
        Operation::Read => "read",
        Operation::Create => "create",
        Operation::Write => "write",
        Operation::SyncFile | Operation::SyncFolder => "sync",
        Operation::Rename => "rename",
        Operation::List => "list",
        Operation::Remove => "remove",
        Operation::OpenLock => "open the lock file",
        Operation::Lock => "lock",
    };
    let all = [
        Operation::CreateFolder,
        Operation::Read,
        Operation::Create,
        Operation::Write,
        Operation::SyncFile,
        Operation::Rename,
        Operation::SyncFolder,
        Operation::List,
        Operation::Remove,
        Operation::OpenLock,
        Operation::Lock,
    ];
    for operation in all {
        let bench = Bench::new();
        let graph = bench.graph(0.8);
        let store = refusing(&bench, move |asked, _| asked == operation);
        let mut errors: Vec<StoreError> = Vec::new();
        let is_fresh = !matches!(operation, Operation::Read | Operation::List | Operation::Remove);
        if !is_fresh {
            // Something to read, to list and to remove.
            bench.run(0.7);
            bench.run(1.7);
        }
        let report = run(&graph, &graph.all(), &store, &bench.options(), &mut Silent);
        errors.extend(report.store_errors.clone());
        let options = GcOptions { keep: 1, here: true, dry_run: false };
        match gc(&graph, &graph.all(), &store, &bench.options(), options, &mut || {}) {
            Err(GcError::Store(error)) => errors.push(error),
            Err(GcError::Heads { .. }) | Ok(_) => {}
        }
        let disk: Vec<&DiskError> = errors
            .iter()
            .filter_map(|error| match error {
                StoreError::Disk(disk) => Some(disk),
                _ => None,
            })
            .collect();
        let own = disk.iter().find(|error| error.operation == operation);
        let own = own.unwrap_or_else(|| panic!("{operation:?}: {errors:?}"));
        assert_eq!(own.kind, io::ErrorKind::StorageFull, "{own}");
        let text = own.to_string();
        assert!(text.contains(name(operation)) && text.contains(&own.path.display().to_string()), "{text}");
        let next = bench.run(0.8);
        assert_eq!((next.outcome(), bench.outputs()["toy.txt"].as_str()), (Outcome::Success, "the number is 0\n"));
    }
}
