//! What keeps a store in order: `verify`, `gc`, the format's marker; and each error of the store, reached. Most by the library
//! on the toy experiment (oracle: counts of runs, bytes), the exit codes by the built binary.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod folder;
mod toy;

use folder::{Folder, ended, signal, until};
use polhode::contract::digest::Digest;
use polhode::contract::manifest::{Leaf, Manifest, Part};
use polhode::contract::node::{Address, Node};
use polhode::contract::work::Work;
use polhode::pipeline::disk::{Disk, Operation, Probe};
use polhode::pipeline::events::{Events, Silent};
use polhode::pipeline::format::marker_text;
use polhode::pipeline::gc::{Collected, GcError, GcOptions, gc};
use polhode::pipeline::graph::Graph;
use polhode::pipeline::record::{Malformed, Output, Record};
use polhode::pipeline::report::{Damage, Failure, Outcome, Repair, Report, Subject};
use polhode::pipeline::run::{Options, run};
use polhode::pipeline::store::{Examined, Fault, Store, StoreError};
use polhode::pipeline::verify::{self, Sample, Verified, verify};
use std::collections::BTreeMap;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use toy::{Bench, SOURCE, Step, files};

const ALL: Sample = Sample { nodes: usize::MAX, seed: 0 };
const KEEP_LAST: GcOptions = GcOptions { keep: 1, here: false, dry_run: false };

fn verified(bench: &Bench, graph: &Graph, sample: Sample) -> Verified {
    verify(graph, &graph.all(), &bench.store(), &bench.options(), sample, &mut Silent).expect("a store")
}

fn collected(bench: &Bench, k: f64, what: GcOptions) -> Result<Collected, GcError> {
    let graph = bench.graph(k);
    gc(&graph, &graph.all(), &bench.store(), &bench.options(), what, &mut || panic!("nobody to wait for"))
}

fn snapshot(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    files(folder).into_iter().map(|path| (path.clone(), std::fs::read(&path).expect("readable"))).collect()
}

fn change(path: &Path, edit: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).expect("readable");
    edit(&mut bytes);
    std::fs::write(path, bytes).expect("writable");
}

// ---- verify

#[test]
fn a_sound_store_verifies_and_nothing_is_written() {
    let bench = Bench::new();
    let graph = bench.graph(0.8);
    assert_eq!(verified(&bench, &graph, ALL), Verified::default(), "no store: nothing to verify");
    assert!(files(bench.folder.path()).is_empty());
    bench.run(0.8);
    bench.counts.take();
    let before = snapshot(bench.folder.path());
    let found = verified(&bench, &graph, ALL);
    assert_eq!(bench.counts.take(), "aside middle source top");
    assert_eq!((found.records, found.heads, found.stored, found.unnamed), (4, 1, 4, 0), "{found:?}");
    assert_eq!((found.damage.as_slice(), found.foreign.len()), ([].as_slice(), 0));
    assert!(found.recomputed.len() == 4 && found.is_reproducible());
    // Objects: four outputs, of which two are equal (`0` and ten times 0), and the code listings of two kinds.
    assert_eq!(found.objects, 5);
    assert_eq!(snapshot(bench.folder.path()), before);
    // A sample is the same every time, and another one with another seed.
    let sample = |seed| -> Vec<Address> {
        let found = verified(&bench, &graph, Sample { nodes: 2, seed });
        found.recomputed.into_iter().map(|node| node.address).collect()
    };
    assert_eq!((sample(1).len(), sample(1)), (2, sample(1)));
    assert!((2..20).any(|seed| sample(seed) != sample(1)));
}

/// Each record, object, listing and file of heads, harmed in each way: found, named, and nothing else.
#[test]
fn all_damage_in_the_store_is_found() {
    let bench = Bench::new();
    bench.run(0.8);
    let graph = bench.graph(0.8);
    type Harm = fn(&Path);
    let harms: [(&str, Harm); 4] = [
        ("deleted", |path| std::fs::remove_file(path).expect("removed")),
        ("emptied", |path| change(path, Vec::clear)),
        ("flipped", |path| change(path, |bytes| *bytes.last_mut().expect("bytes") ^= 4)),
        ("replaced", |path| change(path, |bytes| *bytes = b"something else".to_vec())),
    ];
    let mut cases = 0;
    for (path, good) in snapshot(bench.store().folder()) {
        let name = path.display().to_string();
        if !["/records/", "/objects/", "/heads/"].iter().any(|room| name.contains(room)) {
            continue;
        }
        for (harm, damage) in &harms {
            damage(&path);
            let found = verified(&bench, &graph, Sample { nodes: 0, seed: 0 });
            let paths: Vec<&str> = found.damage.iter().map(|damage| damage.path.as_str()).collect();
            // Heads that are not there can't be told from heads that never were.
            let is_silent = name.contains("/heads/") && *harm == "deleted";
            assert_eq!(paths, if is_silent { vec![] } else { vec![name.as_str()] }, "{harm}");
            let belongs =
                found.damage.iter().all(|damage| damage.subject == Subject::Heads || !damage.addresses.is_empty());
            assert!(belongs, "{:?}", found.damage);
            std::fs::write(&path, &good).expect("written");
            cases += 1;
        }
    }
    assert!(cases >= 40, "{cases} cases");
}

#[test]
fn what_does_not_belong_is_named_and_left() {
    let bench = Bench::new();
    bench.run(0.8);
    std::fs::write(bench.store().folder().join("records/notes.md"), "mine").expect("written");
    bench.store().put(b"left by a killed run").expect("put");
    let found = verified(&bench, &bench.graph(0.8), ALL);
    assert_eq!((found.foreign.len(), found.unnamed, found.damage.len()), (1, 1, 0), "{found:?}");
    collected(&bench, 0.8, KEEP_LAST).expect("collected");
    assert!(bench.store().folder().join("records/notes.md").exists());
}

/// Nodes that do not declare what they depend on: the same key, another result, or none.
#[test]
fn a_result_that_does_not_come_out_again_is_found() {
    let bench = Bench::new();
    bench.run(0.8);
    for (step, expected) in [
        (bench.step("source", "floor"), verify::Outcome::Differs(vec!["out.txt".into()])),
        (bench.step("source", "fail"), verify::Outcome::Failed(Failure::Node("no root between 1 and 2".into()))),
        (bench.step("source", "panic"), verify::Outcome::Failed(Failure::Panic("index 7 of 5".into()))),
    ] {
        let lying = Step { k: Some(3.0), kind: Some(&SOURCE), ..step };
        let honest = Step { k: Some(0.8), kind: Some(&SOURCE), ..bench.step("source", "floor") };
        let mut node = Node::new(Address::new("toy", "source"), lying).expect("describable");
        node.params = toy::lines(&honest);
        let mut plan = bench.plan("toy", 0.8);
        plan.nodes.retain(|node| node.address.node != "source");
        plan.nodes.push(node);
        let found = verified(&bench, &Graph::join(vec![plan]).expect("sound"), ALL);
        assert!(!found.is_reproducible());
        let source = found.recomputed.iter().find(|node| node.address.node == "source").expect("recomputed");
        assert_eq!(source.outcome, expected);
        let others = found.recomputed.iter().filter(|node| node.address.node != "source");
        assert!(others.clone().count() == 3 && others.into_iter().all(|node| node.outcome == verify::Outcome::Same));
    }
}

// ---- gc

#[test]
fn gc_drops_what_no_last_run_needs_and_nothing_else() {
    let bench = Bench::new();
    assert_eq!(collected(&bench, 0.8, KEEP_LAST), Ok(Collected::default()), "no store");
    assert!(!bench.store().folder().exists(), "and none was made");
    bench.run(0.8);
    bench.run(1.5);
    bench.run(7.5);
    bench.counts.take();
    std::fs::write(bench.store().scratch().join(".polhode-tmp-1-1"), "half").expect("written");
    let before = snapshot(bench.folder.path());
    let would = collected(&bench, 7.5, GcOptions { dry_run: true, ..KEEP_LAST }).expect("collected");
    assert_eq!(snapshot(bench.folder.path()), before, "a dry run writes nothing");
    // Two former configs: source, middle, top of each; with k = 0.8, source and middle have the same bytes.
    assert_eq!((would.dropped.records, would.dropped.objects, would.dropped.temporary), (6, 5, 1));
    let locks = files(&bench.store().folder().join("locks"));
    let size = |folder: &Path| files(folder).iter().map(|path| path.metadata().expect("a file").len()).sum::<u64>();
    let bytes = size(bench.store().folder());
    assert_eq!(collected(&bench, 7.5, KEEP_LAST), Ok(would.clone()), "the dry run said what happens");
    assert_eq!(bytes - size(bench.store().folder()), would.dropped.bytes);
    assert_eq!(files(&bench.store().folder().join("locks")), locks, "lock files are never unlinked");
    let again = collected(&bench, 7.5, KEEP_LAST).expect("collected");
    assert_eq!((again.dropped.records, again.dropped.objects, again.kept.records), (0, 0, 4));
    let report = bench.run(7.5);
    assert_eq!((bench.counts.take().as_str(), report.damage.len()), ("", 0));
    bench.run(1.5);
    assert_eq!(bench.counts.take(), "middle source top", "dropped results are computed again, and not called damage");
}

/// `keep` = N: going back through the N last states computes nothing, the one before them does.
#[test]
fn gc_keeps_as_many_runs_as_asked() {
    for keep in 1..=4 {
        let bench = Bench::new();
        let states = [0.8, 1.5, 7.5, 0.8];
        states.iter().for_each(|k| drop(bench.run(*k)));
        let mut shrunk = bench.plan("toy", 9.5);
        shrunk.nodes.retain(|node| node.address.node != "aside");
        shrunk.exports.retain(|export| export.from.node != "aside");
        let graph = Graph::join(vec![shrunk]).expect("sound");
        bench.run_graph(&graph);
        let what = GcOptions { keep, ..KEEP_LAST };
        gc(&graph, &graph.all(), &bench.store(), &bench.options(), what, &mut || ()).expect("collected");
        bench.counts.take();
        let ran: Vec<String> = [0.8, 7.5, 1.5].iter().map(|k| (bench.run(*k), bench.counts.take()).1).collect();
        let expected = match keep {
            1 => ["aside middle source top", "middle source top", "middle source top"],
            2 => ["", "middle source top", "middle source top"],
            3 => ["", "", "middle source top"],
            _ => ["", "", ""],
        };
        assert_eq!(ran, expected, "keep {keep}");
    }
}

/// Results that no head names: a killed run's, and those of heads that were lost. The present graph keeps them.
#[test]
fn gc_keeps_what_the_present_graph_needs() {
    let bench = Bench::new();
    bench.run(0.8);
    bench.counts.take();
    std::fs::remove_dir_all(bench.store().folder().join("heads")).expect("removed");
    let kept = collected(&bench, 0.8, KEEP_LAST).expect("collected").kept;
    assert_eq!(kept.records, 4);
    bench.run(0.8);
    assert_eq!(bench.counts.take(), "");
}

#[test]
fn gc_remembers_other_output_folders_until_told_to_forget() {
    let bench = Bench::new();
    let elsewhere = Options::new(bench.folder.path(), bench.folder.path().join("elsewhere"));
    let graph = bench.graph(1.5);
    run(&graph, &graph.all(), &bench.store(), &elsewhere, &mut Silent);
    bench.run(0.8);
    let first = collected(&bench, 0.8, KEEP_LAST).expect("collected");
    assert_eq!((first.dropped.records, first.kept.records), (0, 7));
    let here = collected(&bench, 0.8, GcOptions { here: true, ..KEEP_LAST }).expect("collected");
    assert_eq!((here.dropped.records, here.kept.records, here.forgotten), (3, 4, 1));
}

#[test]
fn gc_refuses_where_it_can_not_know() {
    let bench = Bench::new();
    bench.run(0.8);
    let heads = files(&bench.store().folder().join("heads")).remove(0);
    change(&heads, |bytes| bytes[20] ^= 1);
    let before = snapshot(bench.folder.path());
    assert_eq!(collected(&bench, 1.5, KEEP_LAST), Err(GcError::Heads { path: heads, fault: Fault::Altered }));
    assert_eq!(snapshot(bench.folder.path()), before);
    bench.run(0.8);
    // A damaged record that is to be kept is told, and kept.
    let record = bench.run(0.8).nodes[0].key.map(|key| bench.store().record_path(key)).expect("a key");
    change(&record, |bytes| bytes[90] ^= 1);
    let told = collected(&bench, 0.8, KEEP_LAST).expect("collected").damaged;
    assert_eq!(told, [record.display().to_string()]);
    assert_eq!(bench.run(0.8).outcome(), Outcome::Success);
}

/// A run and `gc` on one store: whoever comes second waits, says so, and is right.
#[test]
fn a_run_and_gc_wait_for_each_other() {
    let bench = Bench::new();
    bench.run(0.8);
    let alone = bench.store().begin_alone(&mut || panic!("free")).expect("a store").expect("there");
    #[derive(Default)]
    struct Heard(Vec<String>);
    impl Events for Heard {
        fn waiting(&mut self, _: Option<&Address>, holder: &str) {
            self.0.push(holder.to_owned());
        }
    }
    let is_released = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(80));
            is_released.store(true, Ordering::SeqCst);
            drop(alone);
        });
        let (graph, mut heard) = (bench.graph(0.8), Heard::default());
        let report = run(&graph, &graph.all(), &bench.store(), &bench.options(), &mut heard);
        assert!(is_released.load(Ordering::SeqCst) && report.outcome() == Outcome::Success);
        assert_eq!(heard.0, ["a process that has the store for itself"]);
    });
    let using = bench.store().begin(&mut || panic!("free")).expect("a store");
    let is_released = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(80));
            is_released.store(true, Ordering::SeqCst);
            drop(using);
        });
        let (graph, mut waits) = (bench.graph(0.8), 0);
        let mut wait = || {
            waits += 1;
            std::thread::sleep(Duration::from_millis(1));
        };
        gc(&graph, &graph.all(), &bench.store(), &bench.options(), KEEP_LAST, &mut wait).expect("collected");
        assert!(is_released.load(Ordering::SeqCst) && waits > 0);
    });
}

/// Killed at any call of its own, `gc` leaves a store that is right: the oracle is the bytes of an undisturbed run.
#[test]
fn gc_may_be_killed_anywhere() {
    struct Stop(AtomicBool, usize, std::sync::atomic::AtomicUsize);
    impl Probe for Stop {
        fn before(&self, operation: Operation, _: &Path) -> io::Result<()> {
            let is_change = [Operation::Remove, Operation::SyncFolder].contains(&operation);
            if is_change && self.2.fetch_add(1, Ordering::SeqCst) >= self.1 {
                self.0.store(true, Ordering::SeqCst);
                return Err(io::Error::from(io::ErrorKind::Interrupted));
            }
            Ok(())
        }
    }
    let undisturbed = Bench::new();
    undisturbed.run(7.5);
    for at in 0.. {
        let bench = Bench::new();
        bench.run(0.8);
        bench.run(7.5);
        let stop = Arc::new(Stop(AtomicBool::new(false), at, 0.into()));
        let store = Store::with_disk(bench.store().folder(), Disk::probed(stop.clone()));
        let graph = bench.graph(7.5);
        let outcome = gc(&graph, &graph.all(), &store, &bench.options(), KEEP_LAST, &mut || ());
        let is_stopped = stop.0.load(Ordering::SeqCst);
        assert_eq!(outcome.is_err(), is_stopped);
        bench.counts.take();
        let report = bench.run(7.5);
        assert_eq!((report.damage.len(), bench.counts.take().as_str()), (0, ""), "stopped at {at}");
        assert_eq!(bench.outputs(), undisturbed.outputs());
        bench.run(0.8);
        assert_eq!(bench.outputs()["toy.txt"], "the number is 0\n", "stopped at {at}");
        if !is_stopped {
            assert!(at >= 6, "{at} removals");
            break;
        }
    }
}

// ---- the format

fn notes_and_damage(report: &Report) -> (usize, Vec<(Subject, Fault)>) {
    (report.notes.len(), report.damage.iter().map(|damage| (damage.subject, damage.fault.clone())).collect())
}

#[test]
fn a_store_of_another_format_beside_is_left_alone_and_said_once() {
    let bench = Bench::new();
    let other = bench.folder.path().join(".polhode/v0");
    std::fs::create_dir_all(&other).expect("made");
    std::fs::write(other.join("index"), "old").expect("written");
    let report = bench.run(0.8);
    assert_eq!(report.outcome(), Outcome::Success);
    let [note] = report.notes.as_slice() else { panic!("{:?}", report.notes) };
    assert!(note.contains("left alone") && note.contains("v0"), "{note}");
    assert!(bench.run(0.8).notes.is_empty());
    assert_eq!(std::fs::read_to_string(other.join("index")).expect("there"), "old");
}

/// A store whose marker names another format: set aside whole, never read, also when several runs find it at once, and
/// when the run that does it is killed in between.
#[test]
fn a_store_of_another_format_in_our_place_is_set_aside() {
    let foreign = |bench: &Bench| {
        let store = bench.store();
        std::fs::create_dir_all(store.folder().join("records")).expect("made");
        std::fs::create_dir_all(store.folder().join("objects/ab")).expect("made");
        std::fs::write(store.folder().join("records/x"), "not ours").expect("written");
        std::fs::write(store.marker_path(), marker_text(2)).expect("written");
        drop(std::fs::create_dir(store.folder().join("locks")));
        std::fs::write(store.lock_path("store"), "").expect("written");
    };
    let is_aside = |bench: &Bench| {
        let place = bench.store().folder().join("aside/v2-1");
        assert_eq!(std::fs::read_to_string(place.join("records/x")).expect("there"), "not ours");
        assert!(place.join("objects/ab").is_dir());
        assert_eq!(std::fs::read_to_string(place.join("format")).expect("there"), marker_text(2));
    };
    let bench = Bench::new();
    foreign(&bench);
    let refused = StoreError::OtherFormat { folder: bench.store().folder().to_owned(), version: 2 };
    assert_eq!(collected(&bench, 0.8, KEEP_LAST), Err(GcError::Store(refused.clone())));
    let graph = bench.graph(0.8);
    let seen = verify(&graph, &graph.all(), &bench.store(), &bench.options(), ALL, &mut Silent);
    assert_eq!(seen, Err(refused));
    let report = bench.run(0.8);
    assert_eq!((report.outcome(), notes_and_damage(&report)), (Outcome::Success, (1, vec![])));
    assert!(report.notes[0].contains("of format 2") && report.notes[0].contains("aside"), "{:?}", report.notes);
    is_aside(&bench);
    assert_eq!(notes_and_damage(&bench.run(0.8)), (0, vec![]));
    // Once more: it gets a place of its own.
    foreign(&bench);
    bench.run(0.8);
    is_aside(&bench);
    assert!(bench.store().folder().join("aside/v2-2/format").exists());

    let bench = Bench::new();
    foreign(&bench);
    let reports: Vec<Report> = std::thread::scope(|scope| {
        let runs: Vec<_> = (0..6).map(|_| scope.spawn(|| bench.run(0.8))).collect();
        runs.into_iter().map(|run| run.join().expect("no panic")).collect()
    });
    assert!(reports.iter().all(|report| report.outcome() == Outcome::Success && report.damage.is_empty()));
    assert_eq!(reports.iter().map(|report| report.notes.len()).sum::<usize>(), 1, "one of them did it");
    is_aside(&bench);

    let bench = Bench::new();
    foreign(&bench);
    let place = bench.store().folder().join("aside/v2-1");
    std::fs::create_dir_all(&place).expect("made");
    std::fs::rename(bench.store().folder().join("objects"), place.join("objects")).expect("moved");
    assert_eq!(bench.run(0.8).outcome(), Outcome::Success);
    is_aside(&bench);
}

#[test]
fn a_damaged_marker_is_damage_and_the_store_stays() {
    let bench = Bench::new();
    bench.run(0.8);
    bench.counts.take();
    let marker = bench.store().marker_path();
    for (fault, harm) in [
        (Fault::Altered, Box::new(|path: &Path| change(path, |bytes| bytes[14] ^= 1)) as Box<dyn Fn(&Path)>),
        (Fault::Missing, Box::new(|path: &Path| std::fs::remove_file(path).expect("removed"))),
    ] {
        harm(&marker);
        let report = bench.run(0.8);
        assert_eq!(notes_and_damage(&report), (0, vec![(Subject::Format, fault)]));
        assert_eq!(
            (bench.counts.take().as_str(), std::fs::read_to_string(&marker).expect("there")),
            ("", marker_text(1))
        );
    }
}

// ---- every error of the store

fn record_text(body: &str) -> Vec<u8> {
    format!("polhode-record 1 {}\n{body}", Digest::of(body.as_bytes())).into_bytes()
}

#[test]
fn every_way_in_which_a_record_is_no_record() {
    let key = Digest::of(b"key");
    let reads = |text: &[u8]| Record::from_text(text, key);
    assert!(matches!(reads(b"polhode-record 2 and so on"), Err(Malformed::Header(_))));
    assert_eq!(reads(b"polhode-record 1 0000"), Err(Malformed::Checksum));
    assert!(matches!(reads(&record_text("{\"key\":3}\n{}\n")), Err(Malformed::Content(_))));
    let other = Record { key: Digest::of(b"other"), outputs: Vec::new(), work: Work::default() };
    let text = other.to_text(&Manifest::default()).expect("text");
    assert_eq!(reads(text.as_bytes()), Err(Malformed::OtherKey(other.key)));
    let of_no_key = Record::manifest_from_text(text.as_bytes(), other.key);
    assert!(matches!(of_no_key, Err(Malformed::OtherKey(_))));
    // The only way to an unwritable text is this conversion: the types that are written can always be written.
    assert!(matches!(StoreError::from(Malformed::Checksum), StoreError::Unwritable(_)));
}

#[test]
fn every_fault_of_a_stored_file() {
    let bench = Bench::new();
    let store = bench.store();
    let (object, _) = store.put(b"bytes").expect("put");
    assert_eq!(store.object_fault(object), None);
    change(&store.object_path(object), |bytes| bytes[0] ^= 1);
    assert_eq!((store.object_fault(object), store.object(object)), (Some(Fault::Altered), Err(Fault::Altered)));
    std::fs::remove_file(store.object_path(object)).expect("removed");
    assert_eq!(store.object_fault(object), Some(Fault::Missing));
    std::fs::create_dir(store.object_path(object)).expect("made");
    assert!(matches!(store.object_fault(object), Some(Fault::Unreadable(_))));
    let Err(StoreError::Disk(error)) = store.put(b"bytes") else { panic!("a folder stands in its place") };
    assert_eq!((error.operation, error.path), (Operation::Rename, store.object_path(object)));

    let mut manifest = Manifest::default();
    manifest.push(Part::Param, "k", Leaf::float(0.8));
    let output = Output { name: "a".into(), object, logical: object, size: 5 };
    let record = Record { key: manifest.key(), outputs: vec![output], work: Work::default() };
    assert_eq!(store.examine(record.key), Examined::Absent);
    store.write_record(&record, &manifest).expect("written");
    assert!(matches!(store.examine(record.key), Examined::Lacking(_, lacking) if lacking.len() == 1));
    std::fs::remove_dir(store.object_path(object)).expect("removed");
    store.put(b"bytes").expect("put");
    assert_eq!(store.examine(record.key), Examined::Sound(record.clone()));
    assert_eq!(store.artifact(record.key, "b"), Err(Fault::Missing));
    change(&store.record_path(record.key), Vec::clear);
    assert_eq!(store.examine(record.key), Examined::Broken(Fault::Altered));
}

/// An object that is right when a run begins and damaged before it is read: the run says so, and stores nothing made
/// from it; the next run repairs it.
#[test]
fn an_object_that_rots_while_a_run_goes_on() {
    struct Rot;
    impl Probe for Rot {
        fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
            let is_object = path.to_string_lossy().contains("/objects/");
            // The result of `source`: the moment `middle` reads it.
            if operation == Operation::Read && is_object && std::fs::read(path).is_ok_and(|bytes| bytes == b"7") {
                std::fs::write(path, "8")?;
            }
            Ok(())
        }
    }
    let bench = Bench::new();
    let store = Store::with_disk(bench.store().folder(), Disk::probed(Arc::new(Rot)));
    let graph = bench.graph(7.5);
    let report = run(&graph, &graph.all(), &store, &bench.options(), &mut Silent);
    assert_eq!(report.store_errors, [StoreError::Rotted { object: Digest::of(b"7") }]);
    assert_eq!(report.outcome(), Outcome::StoreFailed);
    assert!(!bench.out().join("toy.txt").exists());
    let report = bench.run(7.5);
    let [Damage { subject: Subject::Object, fault: Fault::Altered, repair: Repair::RunAgain, .. }] =
        report.damage.as_slice()
    else {
        panic!("{:?}", report.damage)
    };
    assert_eq!(bench.outputs()["toy.txt"], "the number is 70\n");
}

// ---- the built binary

#[test]
fn init_makes_a_folder_in_which_everything_works() {
    let folder = Folder::with(&[]);
    std::fs::remove_dir(folder.path().join("experiments")).expect("removed");
    let made = folder.run(&["init", "work"]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    let again = folder.run(&["init", "work"]);
    assert_eq!((again.code, again.err.contains("nothing was written")), (Some(2), true), "{}", again.err);
    let listed = folder.command(&["list", "--json"]).current_dir(folder.path().join("work")).output().expect("runs");
    let listed: serde_json::Value = serde_json::from_slice(&listed.stdout).expect("JSON");
    let ids: Vec<&str> =
        listed["experiments"].as_array().expect("a list").iter().filter_map(|e| e["id"].as_str()).collect();
    assert!(ids.contains(&"remark_3_25"), "{ids:?}");
    // One of them, in full; all of them are run by other tests.
    let ran =
        folder.command(&["figures", "remark_3_25"]).current_dir(folder.path().join("work")).output().expect("runs");
    assert!(ran.status.success());
    assert!(folder.path().join("work/figures/remark_3_25.svg").exists());
}

#[test]
fn verify_log_and_gc_from_the_command_line() {
    let folder = Folder::with(&[("a", 31)]);
    assert_eq!(folder.run(&["log"]).code, Some(0));
    assert_eq!(folder.run(&["verify"]).code, Some(0), "no store is no damage");
    assert_eq!(folder.run(&["figures"]).code, Some(0));
    let good = folder.results();
    let sound = folder.run(&["verify", "--all"]);
    assert_eq!(sound.code, Some(0), "{}", sound.out);
    assert!(sound.out.contains("computed 11 of 11 stored nodes again: 11 the same to the bit"), "{}", sound.out);

    let store = Store::at(folder.store());
    let picture = Digest::of(&good["figures/a.svg"]);
    change(&store.object_path(picture), |bytes| bytes[100] ^= 2);
    let harmed = folder.run(&["verify", "--sample", "0"]);
    assert_eq!(harmed.code, Some(7), "{}", harmed.out);
    assert!(harmed.out.contains("of a/picture: the next run repairs it"), "{}", harmed.out);
    let json: serde_json::Value = serde_json::from_str(&folder.run(&["verify", "--json"]).out).expect("JSON");
    assert_eq!((json["schema"].as_u64(), json["exit"].as_u64()), (Some(1), Some(7)));
    assert_eq!(json["verified"]["damage"][0]["addresses"][0], "a/picture");
    assert_eq!(folder.run(&["figures"]).code, Some(0));
    assert_eq!((folder.run(&["verify"]).code, folder.results()), (Some(0), good));

    // A record that tells another result, checksum and all: only computing again finds it.
    let (key, _) = store.made_by(picture).expect("listed").remove(0);
    let (mut record, manifest) = (store.record(key).expect("whole"), store.manifest(key).expect("whole"));
    record.outputs[0].object = store.put(b"<svg/>").expect("put").0;
    store.write_record(&record, &manifest).expect("written");
    let lying = folder.run(&["verify", "--all"]);
    assert_eq!(lying.code, Some(1), "{}", lying.out);
    assert!(lying.out.contains("differs: a/picture came out with another picture.svg"), "{}", lying.out);

    let log = folder.run(&["log"]);
    assert!(log.out.contains("11 ran, 0 up to date, 14 outputs written"), "{}", log.out);
    assert!(log.out.contains("repaired: stored object"), "{}", log.out);
    let json: serde_json::Value =
        serde_json::from_str(&folder.run(&["log", "--last", "1", "--json"]).out).expect("JSON");
    assert_eq!(json["runs"].as_array().map(Vec::len), Some(1));

    folder.write("a", &folder::config(41));
    assert_eq!(folder.run(&["figures"]).code, Some(0));
    let dry = folder.run(&["gc", "--dry-run"]);
    assert!(dry.code == Some(0) && dry.out.starts_with("would drop 6 records"), "{}", dry.out);
    let json: serde_json::Value = serde_json::from_str(&folder.run(&["gc", "--json"]).out).expect("JSON");
    assert_eq!(json["collected"]["dropped"]["records"], 6);
    let idle = folder.run(&["figures"]);
    assert!(idle.err.contains("0 ran, 11 up to date"), "{}", idle.err);
    folder.write("a", "kind = \"nothing\"\n");
    assert_eq!(folder.run(&["gc"]).code, Some(3), "with a wrong config it is not known what is needed");
}

#[test]
fn completions_for_every_shell() {
    let folder = Folder::with(&[]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ended = folder.run(&["completions", shell]);
        assert!(ended.code == Some(0) && ended.out.contains("figures") && ended.out.contains("verify"), "{shell}");
    }
}

/// A saved config redraws its figure; a wrong one is said and waited over; Ctrl-C ends.
#[test]
fn watching_redraws_what_is_saved() {
    let folder = Folder::with(&[("a", 31)]);
    let mut child = folder.command(&["figures", "--watch"]);
    let log = folder.path().join("log");
    let mut child = child.stderr(std::fs::File::create(&log).expect("made")).spawn().expect("starts");
    let said = |text: &str| std::fs::read_to_string(&log).is_ok_and(|log| log.contains(text));
    let svg = || std::fs::read(folder.path().join("figures/a.svg")).unwrap_or_default();
    until("the first figure is there", || said("watching experiments"));
    let first = svg();
    assert!(!first.is_empty());
    folder.write("a", &folder::config(41));
    until("the saved config is drawn", || !svg().is_empty() && svg() != first);
    folder.write("a", "kind = \"remark_3_25\"\nscene = 3\n");
    until("the wrong config is told", || said("key: scene"));
    assert_eq!(child.try_wait().expect("asked"), None, "and waited over");
    folder.write("a", &folder::config(31));
    until("it is drawn again", || svg() == first);
    until("the run has ended", || std::fs::read_to_string(&log).is_ok_and(|log| log.matches("watching").count() == 4));
    signal(&child, "INT");
    let status = child.wait().expect("ends");
    assert_eq!(status.signal(), Some(2));
}

/// Ctrl-C in the middle of a long node ends the command at once, and leaves nothing that the next run trips over.
#[test]
fn control_c_ends_at_once() {
    let undisturbed = Folder::with(&[("a", 31)]);
    assert_eq!(undisturbed.run(&["figures"]).code, Some(0));
    // A second route over this many starts takes minutes.
    let folder = Folder::with(&[("a", 2_000_000)]);
    let child = folder.start(&["figures", "--jobs", "2"]);
    until("a node is done", || !folder.files(".polhode/v1/records").is_empty());
    let begun = Instant::now();
    signal(&child, "INT");
    let (status, _) = ended(child);
    assert_eq!(status.signal(), Some(2));
    assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    folder.write("a", &folder::config(31));
    let next = folder.run(&["figures"]);
    assert_eq!(next.code, Some(0), "{}", next.err);
    assert_eq!(folder.files("figures"), undisturbed.files("figures"));
    assert_eq!(folder.run(&["verify"]).code, Some(0));
}
