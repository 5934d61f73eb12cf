//! What a settled run leaves remembered: the next one is answered without planning exactly when nothing on the disk is otherwise.

#![expect(clippy::expect_used, reason = "helpers of tests")]

mod toy;

use polhode::contract::digest::Digest;
use polhode::pipeline::events::Silent;
use polhode::pipeline::report::{Report, Subject};
use polhode::pipeline::run::{Options, run};
use polhode::pipeline::settled::{Question, Settled, settled};
use std::fs;
use std::path::Path;
use toy::{Bench, files};

fn question(text: &str) -> Question {
    Question { digest: Digest::of(text.as_bytes()), note: "a note".to_owned() }
}

fn options(bench: &Bench, text: &str) -> Options {
    Options { question: Some(question(text)), ..bench.options() }
}

fn run_whole(bench: &Bench, k: f64) -> Report {
    let graph = bench.graph(k);
    let known_exports = Some(graph.export_paths());
    let options = Options { known_exports, ..options(bench, &k.to_string()) };
    run(&graph, &graph.all(), &bench.store(), &options, &mut Silent)
}

fn answer(bench: &Bench, k: f64) -> Option<Settled> {
    settled(&bench.store(), &bench.options(), &question(&k.to_string()).digest)
}

#[test]
fn a_settled_run_is_known_and_a_changed_question_is_not() {
    let bench = Bench::new();
    assert_eq!(answer(&bench, 0.8), None);
    run_whole(&bench, 0.8);
    assert_eq!(answer(&bench, 0.8), Some(Settled { nodes: 4, outputs: 2, note: "a note".to_owned() }));
    assert_eq!(answer(&bench, 1.8), None);
    // Another output folder is another view.
    let elsewhere = Options { out: bench.folder.path().join("other"), ..bench.options() };
    assert_eq!(settled(&bench.store(), &elsewhere, &question("0.8").digest), None);
    run_whole(&bench, 1.8);
    assert_eq!((answer(&bench, 0.8), answer(&bench, 1.8).is_some()), (None, true));
}

/// Deleted, truncated, flipped in one bit, lengthened: each file of the store that a run looks at, and each output. The usual run
/// mends it, and then everything is settled again.
#[test]
fn every_harm_to_every_file_is_noticed() {
    type Harm = (&'static str, fn(&Path));
    let harms: [Harm; 4] = [
        ("deleted", |path| fs::remove_file(path).expect("removed")),
        ("truncated", |path| {
            let bytes = fs::read(path).expect("read");
            fs::write(path, &bytes[..bytes.len() / 2]).expect("written");
        }),
        ("flipped", |path| {
            let mut bytes = fs::read(path).expect("read");
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            fs::write(path, bytes).expect("written");
        }),
        ("lengthened", |path| {
            let mut bytes = fs::read(path).expect("read");
            bytes.push(b'\n');
            fs::write(path, bytes).expect("written");
        }),
    ];
    let bench = Bench::new();
    run_whole(&bench, 0.8);
    let mut paths = files(bench.store().folder());
    // Locks hold nothing, the log of runs is the runs' own.
    paths.retain(|path| !path.iter().any(|part| part == "locks" || part == "runs"));
    paths.extend(files(&bench.out()));
    assert!(paths.len() >= 14, "{paths:?}");
    for path in &paths {
        for (harm, harmful) in harms {
            assert!(answer(&bench, 0.8).is_some(), "settled before {harm} {}", path.display());
            harmful(path);
            assert_eq!(answer(&bench, 0.8), None, "{harm} {}", path.display());
            let report = run_whole(&bench, 0.8);
            let is_silent =
                harm == "deleted" && ["heads", "settled"].iter().any(|room| path.iter().any(|part| part == *room));
            assert!(
                is_silent != report.damage.iter().any(|damage| Path::new(&damage.path) == path),
                "{harm} {}: {:?}",
                path.display(),
                report.damage
            );
        }
    }
    assert!(answer(&bench, 0.8).is_some());
}

/// A file that nobody makes, in the output folder; what a killed run left; a store that another process has for itself.
#[test]
fn what_a_run_would_tell_or_wait_for_is_left_to_it() {
    let bench = Bench::new();
    run_whole(&bench, 0.8);
    fs::write(bench.out().join("mine.txt"), "mine").expect("written");
    assert_eq!(answer(&bench, 0.8), None);
    fs::remove_file(bench.out().join("mine.txt")).expect("removed");
    assert!(answer(&bench, 0.8).is_some());
    let alone = bench.store().begin_alone(&mut || {}).expect("a store").expect("there");
    assert_eq!(answer(&bench, 0.8), None);
    drop(alone);
    assert!(answer(&bench, 0.8).is_some());
    let leftover = bench.store().scratch().join(".polhode-tmp-1");
    fs::create_dir_all(bench.store().scratch()).expect("made");
    fs::write(&leftover, "half").expect("written");
    let is_leftover = answer(&bench, 0.8).is_none();
    assert!(is_leftover, "what a killed run left is for a run to remove");
}

/// A run that failed, or in which a node failed, settles nothing.
#[test]
fn a_failed_run_is_not_remembered() {
    let bench = Bench::new();
    let mut plan = bench.plan("toy", 0.8);
    let failing = bench.step("aside", "fail");
    for node in &mut plan.nodes {
        if node.address.node == "aside" {
            *node = polhode::contract::node::Node::new(node.address.clone(), failing.clone()).expect("describable");
        }
    }
    let graph = polhode::pipeline::graph::Graph::join(vec![plan]).expect("sound");
    let report = run(&graph, &graph.all(), &bench.store(), &options(&bench, "0.8"), &mut Silent);
    assert_eq!(report.failures().count(), 1);
    assert_eq!(answer(&bench, 0.8), None);
}

/// A memory that can't be read is damage: told, and written anew.
#[test]
fn a_damaged_memory_is_told() {
    let bench = Bench::new();
    run_whole(&bench, 0.8);
    for path in files(&bench.store().folder().join("settled")) {
        fs::write(path, "nonsense").expect("written");
    }
    assert_eq!(answer(&bench, 0.8), None);
    let subjects: Vec<Subject> = run_whole(&bench, 0.8).damage.iter().map(|damage| damage.subject).collect();
    assert_eq!(subjects, [Subject::Settled]);
    assert!(answer(&bench, 0.8).is_some());
}
