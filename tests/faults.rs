//! Faults, systematically: what is harmed × how × when. After each, the next run ends, without any flag, with the bytes of an
//! undisturbed run; harm that can be seen is reported. The tables that are printed (`--nocapture`) are also left in
//! `target/tmp/faults-*.txt`.
//!
//! | variable | what | default |
//! |---|---|---|
//! | `POLHODE_KILLS` | random SIGKILLs of the built binary on a small graph | 25 |
//! | `POLHODE_ARTICLE_KILLS` | the same on the experiments of this repository (`--ignored`) | 12 |
//! | `POLHODE_SEED` | the seed of their moments | 1 |
//!
//! Five hundred, and twelve on the article: `just long`, or
//! `POLHODE_KILLS=500 cargo test --test faults random_kills -- --include-ignored --nocapture --test-threads 1`.

#![expect(clippy::expect_used, clippy::print_stdout, reason = "helpers of tests; reports")]

mod folder;
mod toy;

use folder::{Folder, signal};
use polhode::contract::node::Address;
use polhode::pipeline::disk::{Disk, Operation, Probe};
use polhode::pipeline::events::{Events, Silent};
use polhode::pipeline::report::{Outcome, Report};
use polhode::pipeline::run::run;
use polhode::pipeline::store::Store;
use polhode::pipeline::verify::{Sample, Verified, verify};
use std::collections::BTreeMap;
use std::fs::{File, FileTimes};
use std::io;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use toy::{Bench, files};

/// Cases by row and column, and the ones that went wrong.
#[derive(Default)]
struct Matrix {
    counts: BTreeMap<(String, String), usize>,
    cases: usize,
    wrong: Vec<String>,
}

impl Matrix {
    fn case(&mut self, row: &str, column: &str, moment: &str, outcome: Result<(), String>) {
        *self.counts.entry((row.to_owned(), column.to_owned())).or_default() += 1;
        self.cases += 1;
        if let Err(why) = outcome {
            self.wrong.push(format!("{row} × {column} × {moment}: {why}"));
        }
    }

    /// Prints and keeps the table; fails when a case went wrong.
    fn report(&self, name: &str, at_least: usize) {
        let (mut rows, mut columns): (Vec<_>, Vec<_>) = self.counts.keys().cloned().unzip();
        rows.sort();
        rows.dedup();
        columns.sort();
        columns.dedup();
        let wide = rows.iter().map(|row| row.chars().count()).max().unwrap_or(0);
        let mut text = format!("{name}: {} cases, {} wrong\n{:wide$}", self.cases, self.wrong.len(), "");
        columns.iter().for_each(|column| text.push_str(&format!("  {column}")));
        for row in &rows {
            text.push_str(&format!("\n{row:wide$}"));
            for column in &columns {
                let count = self.counts.get(&(row.clone(), column.clone()));
                let count = count.map_or_else(|| "·".to_owned(), ToString::to_string);
                text.push_str(&format!("  {count:>wide$}", wide = column.chars().count()));
            }
        }
        text.push('\n');
        println!("{text}");
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("faults-{}.txt", name.replace(' ', "-")));
        std::fs::write(file, &text).expect("written");
        assert!(self.wrong.is_empty(), "{}", self.wrong.join("\n"));
        assert!(self.cases >= at_least, "only {} cases", self.cases);
    }
}

fn check(holds: bool, why: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(why()) }
}

// ---- what is harmed, and how

/// Ways to harm a file. `other` is another file of the same kind.
const HARMS: [&str; 10] = [
    "deleted",
    "emptied",
    "cut in half",
    "cut by a byte",
    "grown by a byte",
    "first bit flipped",
    "last bit flipped",
    "replaced by text",
    "swapped for a sibling",
    "rotted, size and time kept",
];

fn harm(how: &str, path: &Path, sibling: &[u8]) {
    let bytes = std::fs::read(path).expect("readable");
    let write = |bytes: &[u8]| std::fs::write(path, bytes).expect("written");
    let flipped = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1;
        bytes
    };
    match how {
        "deleted" => std::fs::remove_file(path).expect("removed"),
        "emptied" => write(b""),
        "cut in half" => write(&bytes[..bytes.len() / 2]),
        "cut by a byte" => write(&bytes[..bytes.len() - 1]),
        "grown by a byte" => write(&[bytes.as_slice(), b"\n"].concat()),
        "first bit flipped" => write(&flipped(0)),
        "last bit flipped" => write(&flipped(bytes.len() - 1)),
        "replaced by text" => write(b"something else\n"),
        "swapped for a sibling" => write(sibling),
        _ => {
            let time = path.metadata().and_then(|data| data.modified()).expect("a time");
            write(&flipped(bytes.len() / 2));
            let file = File::options().write(true).open(path).expect("opened");
            file.set_times(FileTimes::new().set_modified(time)).expect("set");
        }
    }
}

/// The files of a bench that can be harmed, by a name that says what they are.
fn targets(bench: &Bench, report: &Report) -> Vec<(&'static str, PathBuf)> {
    let store = bench.store();
    let record = |name: &str| {
        let node = report.node(&Address::new("toy", name)).expect("a node");
        store.record(node.key.expect("a key")).expect("a record")
    };
    let object = |name: &str| store.object_path(record(name).outputs[0].object);
    let listing = store.manifest(record("top").key).and_then(|manifest| manifest.code()).expect("a listing");
    let heads = files(&store.folder().join("heads")).remove(0);
    vec![
        ("first record", store.record_path(record("source").key)),
        ("last record", store.record_path(record("top").key)),
        ("inner object", object("middle")),
        ("exported object", object("top")),
        ("code listing", store.object_path(listing)),
        ("heads", heads),
        ("marker", store.marker_path()),
        ("output", bench.out().join("toy.txt")),
        ("deep output", bench.out().join("data/toy/aside.txt")),
        ("lock", store.lock_path(&record("top").key.to_string())),
        ("log", files(&store.folder().join("runs")).remove(0)),
    ]
}

/// Harm that nothing can see or that harms nothing: heads that are gone can't be told from heads that never were; locks
/// and logs hold no result.
fn is_silent(what: &str, how: &str) -> bool {
    what == "lock" || what == "log" || (what == "heads" && how == "deleted")
}

fn verified(bench: &Bench, k: f64) -> Verified {
    let graph = bench.graph(k);
    let sample = Sample { nodes: usize::MAX, seed: 0 };
    verify(&graph, &graph.all(), &bench.store(), &bench.options(), sample, &mut Silent).expect("a store")
}

/// What a run must leave: outputs of an undisturbed run, a store in which nothing is damaged and all comes out again.
fn is_right(bench: &Bench, k: f64, right: &BTreeMap<String, String>) -> Result<(), String> {
    check(bench.outputs() == *right, || format!("outputs are {:?}", bench.outputs()))?;
    let found = verified(bench, k);
    check(found.damage.is_empty() && found.is_reproducible(), || format!("{:?}", found.damage))?;
    check(found.stored == 4, || format!("{} of 4 nodes stored", found.stored))
}

/// Harms a file as soon as a node starts, in the middle of a run.
struct AtStart<'a>(&'a str, Box<dyn FnMut() + 'a>);

impl Events for AtStart<'_> {
    fn started(&mut self, address: &Address, _: Option<Duration>) {
        if address.node == self.0 {
            (self.1)();
        }
    }
}

/// Every kind of file × every harm × four moments, by the library.
#[test]
fn matrix_of_harmed_files() {
    let right = |k: f64| {
        let bench = Bench::new();
        bench.run(k);
        bench.outputs()
    };
    let (right_old, right_new) = (right(7.5), right(3.5));
    let mut matrix = Matrix::default();
    for how in HARMS {
        for index in 0.. {
            let prepared = || {
                let bench = Bench::new();
                let report = bench.run(7.5);
                let (what, path) = targets(&bench, &report).into_iter().nth(index)?;
                // A sibling: the file's own kind, whole, but another one.
                let folder = path.parent().map(Path::to_owned).expect("a folder");
                let others = files(&folder).into_iter().chain(files(&bench.store().folder().join("objects")));
                let sibling = others.filter(|other| *other != path).map(|other| std::fs::read(other).expect("read"));
                let own = std::fs::read(&path).expect("read");
                let sibling = sibling.into_iter().find(|bytes| *bytes != own).expect("a sibling");
                Some((bench, what, path, sibling))
            };
            let Some((bench, what, path, sibling)) = prepared() else { break };
            let is_told = |reports: &[&Report]| {
                let damage = reports.iter().map(|report| report.damage.len()).sum::<usize>();
                // With an edit between, a result that is gone looks like one that gc dropped.
                let is_gone =
                    reports.len() > 1 && how == "deleted" && (what.ends_with("record") || what == "code listing");
                let expected = usize::from(!is_silent(what, how) && !is_gone);
                check(damage == expected, || format!("{damage} reports of damage, not {expected}"))
            };
            let succeeds = |report: &Report| {
                check(report.outcome() == Outcome::Success, || {
                    format!("{:?} {:?}", report.outcome(), report.store_errors)
                })
            };

            harm(how, &path, &sibling);
            let report = bench.run(7.5);
            let outcome = succeeds(&report)
                .and_then(|()| is_right(&bench, 7.5, &right_old))
                .and_then(|()| is_told(&[&report]))
                .and_then(|()| {
                    let again = bench.run(7.5);
                    check((again.ran(), again.damage.len()) == (0, 0), || "the next run is not idle".to_owned())
                });
            matrix.case(what, how, "at rest", outcome);

            // An edited config runs over the harm, and going back finds it.
            let Some((bench, what, path, sibling)) = prepared() else { break };
            harm(how, &path, &sibling);
            let edited = bench.run(3.5);
            let new = succeeds(&edited).and_then(|()| check(bench.outputs() == right_new, || "outputs".to_owned()));
            let back = bench.run(7.5);
            let outcome = new
                .and_then(|()| succeeds(&back))
                .and_then(|()| is_right(&bench, 7.5, &right_old))
                // An output that is replaced anyway need not be called damaged.
                .and_then(|()| if what == "output" || what == "heads" { Ok(()) } else { is_told(&[&edited, &back]) });
            matrix.case(what, how, "beside an edit", outcome);

            // While a run of an edited config is at its first node: the run may fail, it may not be wrong.
            let Some((bench, what, path, sibling)) = prepared() else { break };
            let graph = bench.graph(3.5);
            let mut events = AtStart("source", Box::new(|| harm(how, &path, &sibling)));
            let during = run(&graph, &graph.all(), &bench.store(), &bench.options(), &mut events);
            drop(events);
            let is_honest = during.outcome() != Outcome::Success || bench.outputs()["toy.txt"] == right_new["toy.txt"];
            let next = bench.run(3.5);
            let outcome = check(is_honest, || "a success with wrong outputs".to_owned())
                .and_then(|()| succeeds(&next))
                .and_then(|()| check(bench.outputs() == right_new, || "outputs".to_owned()))
                .and_then(|()| succeeds(&bench.run(7.5)))
                .and_then(|()| is_right(&bench, 7.5, &right_old));
            matrix.case(what, how, "during a run", outcome);

            // With everything else of the store lost but this file.
            let Some((bench, what, path, sibling)) = prepared() else { break };
            harm(how, &path, &sibling);
            for file in files(bench.store().folder()) {
                let is_spared = file == path || file.to_string_lossy().contains("/locks/");
                if !is_spared && file.to_string_lossy().contains("/objects/") {
                    std::fs::remove_file(file).expect("removed");
                }
            }
            let report = bench.run(7.5);
            let outcome = succeeds(&report).and_then(|()| is_right(&bench, 7.5, &right_old));
            matrix.case(what, how, "objects lost too", outcome);
        }
    }
    matrix.report("harmed files", 400);
}

// ---- calls that fail

struct Refuse {
    operation: Operation,
    place: &'static str,
    kind: io::ErrorKind,
    /// How many are let through, and whether all that follow fail or one.
    after: usize,
    is_lasting: bool,
    seen: AtomicUsize,
    is_hit: AtomicBool,
}

impl Probe for Refuse {
    fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
        let name = path.to_string_lossy();
        let is_here = if self.place == "figures" {
            name.contains("/figures")
        } else {
            name.split_once("/.polhode/v1")
                .is_some_and(|(_, rest)| rest.trim_start_matches('/').starts_with(self.place))
        };
        if operation != self.operation || !is_here {
            return Ok(());
        }
        let seen = self.seen.fetch_add(1, Ordering::SeqCst);
        if seen == self.after || (self.is_lasting && seen > self.after) {
            self.is_hit.store(true, Ordering::SeqCst);
            return Err(io::Error::from(self.kind));
        }
        Ok(())
    }
}

/// Every operation × every place × four errors, lasting or once, on an empty store, on an edit, and with nothing to do.
#[test]
fn matrix_of_failing_calls() {
    use Operation::{Create, CreateFolder, List, Lock, OpenLock, Read, Remove, Rename, SyncFile, SyncFolder, Write};
    let operations = [CreateFolder, Read, Create, Write, SyncFile, Rename, SyncFolder, List, Remove, OpenLock, Lock];
    let places = ["objects", "records", "heads", "runs", "tmp", "locks", "format", "figures"];
    let kinds = [
        io::ErrorKind::StorageFull,
        io::ErrorKind::ReadOnlyFilesystem,
        io::ErrorKind::PermissionDenied,
        io::ErrorKind::Other,
    ];
    let right = {
        let bench = Bench::new();
        bench.run(3.5);
        bench.outputs()
    };
    let mut matrix = Matrix::default();
    for operation in operations {
        for place in places {
            for (number, kind) in kinds.into_iter().enumerate() {
                let moments = ["empty store", "edit", "nothing to do"].into_iter();
                for (moment, is_lasting) in moments.flat_map(|moment| [(moment, true), (moment, false)]) {
                    let bench = Bench::new();
                    match moment {
                        "edit" => drop(bench.run(0.8)),
                        "nothing to do" => drop(bench.run(3.5)),
                        _ => {}
                    }
                    let (seen, is_hit) = (AtomicUsize::new(0), AtomicBool::new(false));
                    let refuse =
                        Arc::new(Refuse { operation, place, kind, after: number / 2, is_lasting, seen, is_hit });
                    let store = Store::with_disk(bench.store().folder(), Disk::probed(refuse.clone()));
                    let graph = bench.graph(3.5);
                    let report = run(&graph, &graph.all(), &store, &bench.options(), &mut Silent);
                    if !refuse.is_hit.load(Ordering::SeqCst) {
                        continue;
                    }
                    let is_honest = match report.outcome() {
                        Outcome::Success => bench.outputs() == right,
                        Outcome::StoreFailed => !report.store_errors.is_empty(),
                        Outcome::NodeFailed => false,
                    };
                    let next = bench.run(3.5);
                    let outcome = check(is_honest, || format!("{:?}, outputs {:?}", report.outcome(), bench.outputs()))
                        .and_then(|()| {
                            check(next.outcome() == Outcome::Success, || format!("then {:?}", next.store_errors))
                        })
                        .and_then(|()| is_right(&bench, 3.5, &right))
                        .and_then(|()| check(next.damage.is_empty(), || format!("damage: {:?}", next.damage)));
                    matrix.case(
                        &format!("{operation:?}"),
                        place,
                        &format!("{kind:?}, {moment}, lasting: {is_lasting}"),
                        outcome,
                    );
                }
            }
        }
    }
    matrix.report("failing calls", 200);
}

// ---- power loss

/// What a power loss leaves: for every call of a run, the worst and the best that POSIX allows. A file is there for sure
/// once its bytes, the folder that has its name, and the entries of all folders above were synced; a name that was not synced may
/// be there or not; bytes that were not synced are not.
#[test]
fn power_loss_at_every_call() {
    struct Watch(Mutex<Vec<(Operation, PathBuf)>>);
    impl Probe for Watch {
        fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
            self.0.lock().expect("unpoisoned").push((operation, path.to_owned()));
            Ok(())
        }
    }
    let bench = Bench::new();
    let watch = Arc::new(Watch(Mutex::default()));
    let store = Store::with_disk(bench.store().folder(), Disk::probed(watch.clone()));
    let graph = bench.graph(3.5);
    let options = polhode::pipeline::run::Options { jobs: 1, ..bench.options() };
    run(&graph, &graph.all(), &store, &options, &mut Silent);
    let root = bench.folder.path();
    let calls: Vec<_> = watch.0.lock().expect("unpoisoned").clone();
    let right = bench.outputs();
    let mut matrix = Matrix::default();
    for end in 0..=calls.len() {
        // The probe is asked before a call: those before `end` have been made.
        let made = &calls[..end];
        let synced_after = |folder: &Path, from: usize| {
            made[from..].iter().any(|(operation, path)| *operation == Operation::SyncFolder && path == folder)
        };
        let mut images: [BTreeMap<PathBuf, Vec<u8>>; 2] = Default::default();
        for (at, (operation, path)) in made.iter().enumerate() {
            if *operation != Operation::Rename {
                continue;
            }
            let is_content_synced = at > 0 && made[at - 1].0 == Operation::SyncFile
                || (at > 1
                    && made[..at]
                        .iter()
                        .rev()
                        .find(|c| c.0 == Operation::Write || c.0 == Operation::SyncFile)
                        .is_some_and(|c| c.0 == Operation::SyncFile));
            let bytes = if is_content_synced { std::fs::read(path).expect("there") } else { Vec::new() };
            let folder = path.parent().expect("a folder");
            let are_folders_synced = folder.ancestors().take_while(|above| *above != root).all(|above| {
                let born = made
                    .iter()
                    .position(|(operation, made)| *operation == Operation::CreateFolder && made.starts_with(above));
                born.is_none_or(|born| synced_after(above.parent().expect("above"), born))
            });
            if synced_after(folder, at) && are_folders_synced {
                images[0].insert(path.clone(), bytes.clone());
            }
            images[1].insert(path.clone(), bytes);
        }
        for (name, image) in ["only what is sure", "all that may be"].into_iter().zip(&images) {
            let after = Bench::new();
            for (path, bytes) in image {
                let path = after.folder.path().join(path.strip_prefix(root).expect("below"));
                std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
                std::fs::write(path, bytes).expect("written");
            }
            let report = after.run(3.5);
            let room = made.last().map_or_else(|| "nothing".to_owned(), |(operation, _)| format!("{operation:?}"));
            let outcome = check(report.outcome() == Outcome::Success, || format!("{:?}", report.store_errors))
                .and_then(|()| is_right(&after, 3.5, &right))
                // A record that names objects which did not reach the disk would be told as damage.
                .and_then(|()| {
                    let damage: Vec<_> = report.damage.iter().filter(|d| d.path.contains(".polhode")).collect();
                    check(damage.is_empty(), || format!("{damage:?}"))
                });
            matrix.case(&room, name, &format!("after call {end}"), outcome);
        }
    }
    matrix.report("power loss", 200);
}

// ---- the built binary

/// What can be harmed in a folder that the binary works on.
fn harmable(folder: &Folder) -> Vec<(&'static str, PathBuf)> {
    let store = Store::at(folder.store());
    let svg = folder.path().join("figures/a.svg");
    let bytes = std::fs::read(&svg).expect("there");
    let object = polhode::contract::digest::Digest::of(&bytes);
    let (key, _) = store.made_by(object).expect("listed").remove(0);
    let table = folder.path().join("figures/data/a/cusps.parquet");
    let table_object = polhode::contract::digest::Digest::of(&std::fs::read(&table).expect("there"));
    vec![
        ("figure", svg),
        ("table", table),
        ("findings", folder.path().join("figures/data/a/findings.json")),
        ("values", folder.path().join("figures/values.toml")),
        ("record", store.record_path(key)),
        ("stored figure", store.object_path(object)),
        ("stored table", store.object_path(table_object)),
    ]
}

/// The same by the built binary on real nodes.
#[test]
fn matrix_of_harmed_files_by_the_binary() {
    let folder = Folder::with(&[("a", 31)]);
    assert_eq!(folder.run(&["figures"]).code, Some(0));
    let right = folder.results();
    let mut matrix = Matrix::default();
    for how in HARMS {
        for (what, path) in harmable(&folder) {
            harm(how, &path, b"a sibling of another kind");
            let repaired = folder.run(&["figures"]);
            let outcome = check(repaired.code == Some(0), || repaired.err.clone())
                .and_then(|()| check(repaired.err.matches("repair:").count() == 1, || repaired.err.clone()))
                .and_then(|()| check(folder.results() == right, || "bytes differ".to_owned()));
            matrix.case(what, how, "at rest", outcome);
        }
    }
    matrix.report("harmed files by the binary", 70);
}

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).ok().map_or(default, |text| text.parse().expect("a number"))
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: Duration) -> Duration {
        let micros = u64::try_from(end.as_micros()).expect("short").max(1);
        Duration::from_micros(self.next() % micros)
    }
}

/// How long a killed run had got.
fn kill_after(folder: &Folder, delay: Duration) -> &'static str {
    let mut child = folder.command(&["figures"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts");
    std::thread::sleep(delay);
    if child.try_wait().expect("asked").is_none() {
        signal(&child, "KILL");
    }
    let status = child.wait().expect("ends");
    let records = folder.files(".polhode/v1/records").len();
    match (status.success(), records, folder.files("figures").is_empty()) {
        (true, ..) => "had ended",
        (_, 0, _) => "before a record",
        (_, _, true) => "before an output",
        _ => "in the middle",
    }
}

#[test]
fn random_kills_on_a_small_graph() {
    let kills = number("POLHODE_KILLS", 25);
    let mut random = Random(number("POLHODE_SEED", 1));
    let configs = [("a", 31), ("b", 21)];
    let edited = [("a", 41), ("b", 21)];
    let timed = |configs: &[(&str, usize)]| {
        let folder = Folder::with(configs);
        let begun = Instant::now();
        assert_eq!(folder.run(&["figures"]).code, Some(0));
        (begun.elapsed(), folder)
    };
    let (undisturbed_duration, undisturbed) = timed(&configs);
    let (_, undisturbed_edit) = timed(&edited);
    let edit_duration = {
        let folder = timed(&configs).1;
        folder.write("a", &folder::config(41));
        let begun = Instant::now();
        assert_eq!(folder.run(&["figures"]).code, Some(0));
        begun.elapsed()
    };
    let mut matrix = Matrix::default();
    let (mut duration, mut edit_duration) = (undisturbed_duration, edit_duration);
    let (mut killed, mut round) = (0, 0);
    while killed < kills {
        round += 1;
        let is_edit = round % 3 == 0;
        let folder = if is_edit { timed(&configs).1 } else { Folder::with(&configs) };
        if is_edit {
            folder.write("a", &folder::config(41));
        }
        let delay = random.below(if is_edit { edit_duration } else { duration });
        let state = kill_after(&folder, delay);
        // A run that had ended was not killed: earlier moments from then on.
        if state == "had ended" {
            let duration = if is_edit { &mut edit_duration } else { &mut duration };
            *duration = *duration * 9 / 10;
        } else {
            killed += 1;
        }
        let next = folder.run(&["figures"]);
        let expected = if is_edit { &undisturbed_edit } else { &undisturbed };
        let is_same = if is_edit {
            folder.files("figures") == expected.files("figures")
        } else {
            folder.results() == expected.results()
        };
        let outcome = check(next.code == Some(0), || next.err.clone())
            .and_then(|()| check(is_same, || "bytes differ".to_owned()))
            .and_then(|()| check(!next.err.contains("repair:"), || next.err.clone()))
            .and_then(|()| check(folder.files(".polhode/v1/tmp").is_empty(), || "leftovers".to_owned()));
        matrix.case(if is_edit { "edit" } else { "empty store" }, state, &format!("{delay:?}"), outcome);
    }
    println!("an undisturbed run took {undisturbed_duration:?}; {killed} runs were killed");
    matrix.report("random kills", usize::try_from(kills).expect("a number"));
}

#[test]
#[ignore = "computes all the article's experiments again and again; run by hand, in release"]
fn random_kills_on_the_articles_graph() {
    let kills = number("POLHODE_ARTICLE_KILLS", 12);
    let mut random = Random(number("POLHODE_SEED", 1));
    let article = || {
        let folder = Folder::with(&[]);
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
        for config in files(&source) {
            let name = config.file_name().expect("a name");
            std::fs::copy(&config, folder.path().join("experiments").join(name)).expect("copied");
        }
        folder
    };
    let undisturbed = article();
    let begun = Instant::now();
    assert_eq!(undisturbed.run(&["figures"]).code, Some(0));
    let duration = begun.elapsed();
    let mut matrix = Matrix::default();
    let (mut killed, mut latest) = (0, duration);
    while killed < kills {
        let folder = article();
        let delay = random.below(latest);
        let state = kill_after(&folder, delay);
        if state == "had ended" {
            latest = latest * 9 / 10;
        } else {
            killed += 1;
        }
        let next = folder.run(&["figures"]);
        let outcome = check(next.code == Some(0), || next.err.clone())
            .and_then(|()| check(folder.results() == undisturbed.results(), || "bytes differ".to_owned()));
        matrix.case("empty store", state, &format!("{delay:?}"), outcome);
    }
    println!("an undisturbed run took {duration:?}; {killed} runs were killed");
    matrix.report("random kills on the article", usize::try_from(kills).expect("a number"));
}

/// The nodes that a run's JSON says ran, by key.
fn ran(json: &str) -> Vec<String> {
    let value: serde_json::Value = serde_json::from_str(json).expect("JSON");
    let nodes = value["report"]["nodes"].as_array().expect("nodes").iter();
    nodes.filter(|node| node["status"] == "ran").map(|node| node["key"].as_str().expect("a key").to_owned()).collect()
}

/// Eight processes on an empty store: all end well, each key is computed by one of them, same bytes. Then eight more
/// with `gc` among them.
#[test]
fn eight_processes_at_once() {
    let configs = [("a", 31), ("b", 4001), ("c", 2001)];
    let undisturbed = Folder::with(&configs);
    let alone = undisturbed.run(&["figures", "--json"]);
    assert_eq!(alone.code, Some(0), "{}", alone.err);
    let mut expected = ran(&alone.out);
    expected.sort();
    let folder = Folder::with(&configs);
    let at_once = |verbs: &[&[&str]]| {
        let start = |arguments: &&[&str]| {
            let mut command = folder.command(arguments);
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts")
        };
        let children: Vec<_> = verbs.iter().map(start).collect();
        let wait = |child: std::process::Child| folder::Ended::from(child.wait_with_output().expect("ends"));
        // Each on a thread of its own: a full pipe would stop a run.
        let threads: Vec<_> = children.into_iter().map(|child| std::thread::spawn(move || wait(child))).collect();
        threads.into_iter().map(|thread| thread.join().expect("joined")).collect::<Vec<_>>()
    };
    let runs = at_once(&[["figures", "--json"].as_slice(); 8]);
    for run in &runs {
        assert_eq!(run.code, Some(0), "{}", run.err);
    }
    let mut done: Vec<String> = runs.iter().flat_map(|run| ran(&run.out)).collect();
    done.sort();
    assert_eq!(done, expected, "each key was computed once");
    assert_eq!(folder.results(), undisturbed.results());
    let busy = runs.iter().filter(|run| !ran(&run.out).is_empty()).count();
    let waited = runs.iter().filter(|run| run.err.contains("waits: process")).count();
    println!("{} keys by 8 processes, {busy} of which computed some; {waited} said that they waited", done.len());

    folder.write("b", &folder::config(3001));
    let (figures, gc): (&[&str], &[&str]) = (&["figures", "--json"], &["gc"]);
    for run in at_once(&[figures, gc, figures, gc, figures, figures, gc, figures]) {
        assert_eq!(run.code, Some(0), "{}", run.err);
    }
    let idle = folder.run(&["figures", "--json"]);
    assert_eq!((idle.code, ran(&idle.out).len()), (Some(0), 0));
    assert_eq!(folder.run(&["verify", "--sample", "0"]).code, Some(0));
}
