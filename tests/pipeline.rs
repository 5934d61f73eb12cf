//! The runner on a toy experiment: what runs, what is reused, what is repaired. The oracle is the count of runs of each
//! node, and the bytes of an undisturbed run.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod toy;

use polhode::contract::code::{CodeLine, CodeListing, listing};
use polhode::contract::digest::Digest;
use polhode::contract::node::{Address, Node};
use polhode::contract::plan::{Export, Plan};
use polhode::pipeline::disk::{Disk, Operation, Probe};
use polhode::pipeline::events::{Events, Silent};
use polhode::pipeline::forecast::{Prospect, forecast};
use polhode::pipeline::graph::{Graph, GraphError};
use polhode::pipeline::reason::Reason;
use polhode::pipeline::render::{Format, render};
use polhode::pipeline::report::{Damage, ExportStatus, Failure, Outcome, Repair, Report, Status, Subject};
use polhode::pipeline::run::{Options, run};
use polhode::pipeline::store::{Fault, Store, StoreError};
use polhode::pipeline::stored::{NotStored, stored};
use polhode::pipeline::why::why;
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toy::{Bench, CLOCK, SOURCE, Step, files};

fn statuses(report: &Report) -> Vec<(String, Status)> {
    let mut statuses: Vec<_> = report.nodes.iter().map(|n| (n.address.node.clone(), n.status.clone())).collect();
    statuses.sort_by(|a, b| a.0.cmp(&b.0));
    statuses
}

#[test]
fn the_first_run_computes_all_and_the_second_nothing() {
    let bench = Bench::new();
    let report = bench.run(0.8);
    assert_eq!(report.outcome(), Outcome::Success);
    assert_eq!(bench.counts.take(), "aside middle source top");
    assert!(report.exports.iter().all(|export| export.status == ExportStatus::New), "{:?}", report.exports);
    assert_eq!(bench.outputs()["toy.txt"], "the number is 0\n");
    let before = snapshot(&bench);
    let report = bench.run(0.8);
    assert_eq!(bench.counts.take(), "");
    assert!(report.nodes.iter().all(|node| node.status == Status::Cached));
    assert!(report.exports.iter().all(|export| export.status == ExportStatus::Unchanged));
    assert_eq!((report.damage.len(), report.warnings.len()), (0, 0));
    assert_eq!(snapshot(&bench), before, "a run with nothing to do writes nothing");
}

/// All files of store and outputs with their bytes, locks apart.
fn snapshot(bench: &Bench) -> Vec<(String, Vec<u8>)> {
    let all = files(bench.folder.path()).into_iter().filter(|path| !path.to_string_lossy().contains("/locks/"));
    all.map(|path| (path.display().to_string(), std::fs::read(&path).expect("readable"))).collect()
}

/// 0.8 and 0.9 round to the same number: `source` runs, what reads it does not. 1.5 changes all that follow.
#[test]
fn early_cutoff_and_going_back() {
    let bench = Bench::new();
    bench.run(0.8);
    bench.counts.take();
    bench.run(0.9);
    assert_eq!(bench.counts.take(), "source");
    let report = bench.run(1.5);
    assert_eq!(bench.counts.take(), "middle source top");
    assert_eq!(bench.outputs()["toy.txt"], "the number is 10\n");
    assert_eq!(report.written().map(|export| export.path.as_str()).collect::<Vec<_>>(), ["toy.txt"]);
    assert!(report.damage.is_empty());
    let report = bench.run(0.8);
    assert_eq!(bench.counts.take(), "", "going back computes nothing");
    assert_eq!(report.exports[0].status, ExportStatus::Updated);
    assert_eq!(bench.outputs()["toy.txt"], "the number is 0\n");
}

/// A float's spelling, the order of nodes, the experiment's id and its config's text are not part of the key.
#[test]
fn only_what_a_node_reads_is_in_its_key() {
    let bench = Bench::new();
    bench.run("0.8".parse().expect("a number"));
    bench.counts.take();
    let mut plan = bench.plan("other", "0.800".parse().expect("a number"));
    plan.nodes.reverse();
    plan.config.text = "# quite another comment\n\nk=0.800".into();
    bench.run_graph(&Graph::join(vec![plan]).expect("sound"));
    assert_eq!(bench.counts.take(), "");
    bench.run(-0.0);
    bench.counts.take();
    bench.run(0.0);
    assert_eq!(bench.counts.take(), "source");
}

#[test]
fn equal_work_at_two_addresses_is_done_once() {
    let bench = Bench::new();
    let graph = Graph::join(vec![bench.plan("a", 0.8), bench.plan("b", 0.8)]).expect("sound");
    let report = bench.run_graph(&graph);
    assert_eq!(bench.counts.take(), "aside middle source top");
    assert_eq!(report.ran(), 4);
    assert_eq!(report.count(|status| matches!(status, Status::SameAs(_))), 4);
    assert_eq!(bench.outputs()["a.txt"], bench.outputs()["b.txt"]);
}

/// Each file of store and outputs, deleted, truncated, flipped in one bit or replaced: noticed, repaired, reported; and
/// the next run finds nothing to do.
#[test]
fn all_damage_is_noticed_repaired_and_reported() {
    let bench = Bench::new();
    bench.run(0.8);
    let good = snapshot(&bench);
    type Harm = fn(&Path);
    let faults: [(&str, Harm); 5] = [
        ("deleted", |path| std::fs::remove_file(path).expect("removed")),
        ("truncated", |path| change(path, |bytes| bytes.truncate(bytes.len() / 2))),
        ("emptied", |path| change(path, Vec::clear)),
        ("flipped", |path| change(path, |bytes| bytes[0] ^= 1)),
        ("replaced", |path| change(path, |bytes| *bytes = b"something else".to_vec())),
    ];
    let mut cases = 0;
    for (path, _) in &good {
        if path.contains("/runs/") {
            continue;
        }
        for (name, damage) in &faults {
            bench.counts.take();
            let is_heads = path.contains("/heads/");
            damage(Path::new(path));
            let report = bench.run(0.8);
            let case = format!("{path} {name}");
            assert_eq!(report.outcome(), Outcome::Success, "{case}");
            // Deleted heads can't be told from heads that never were; they hold nothing that a result needs.
            let is_silent = is_heads && *name == "deleted";
            assert_eq!(report.damage.len(), usize::from(!is_silent), "{case}: {:?}", report.damage);
            // All but the time of the last run, which is in the heads, is as it was.
            let ignore_times = |files: Vec<(String, Vec<u8>)>| {
                let kept = files.into_iter().filter(|(path, _)| !path.contains("/runs/") && !path.contains("/heads/"));
                kept.collect::<Vec<_>>()
            };
            assert_eq!(ignore_times(snapshot(&bench)), ignore_times(good.clone()), "{case}");
            let again = bench.run(0.8);
            assert_eq!((again.damage.len(), again.ran()), (0, 0), "{case}");
            cases += 1;
        }
    }
    assert!(cases >= 60, "{cases} cases");
}

fn change(path: &Path, edit: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).expect("readable");
    edit(&mut bytes);
    std::fs::write(path, bytes).expect("writable");
}

fn damage_of(report: &Report) -> (Subject, Fault, Repair) {
    let [Damage { subject, fault, repair, .. }] = report.damage.as_slice() else { panic!("{:?}", report.damage) };
    (*subject, fault.clone(), *repair)
}

/// The cheapest repair is taken: an output from the store, an object from its output, and only else the node runs.
#[test]
fn repairs_take_the_shortest_way() {
    let bench = Bench::new();
    let report = bench.run(3.5);
    bench.counts.take();
    let object = |node: &str| {
        let key = report.node(&Address::new("toy", node)).and_then(|node| node.key).expect("a key");
        bench.store().record(key).expect("a record").outputs[0].object
    };
    std::fs::remove_file(bench.out().join("toy.txt")).expect("removed");
    assert_eq!(damage_of(&bench.run(3.5)), (Subject::Output, Fault::Missing, Repair::FromStore));
    assert_eq!(bench.counts.take(), "");
    change(&bench.store().object_path(object("top")), |bytes| bytes[3] ^= 8);
    assert_eq!(damage_of(&bench.run(3.5)), (Subject::Object, Fault::Altered, Repair::FromOutput));
    assert_eq!(bench.counts.take(), "");
    std::fs::remove_file(bench.store().object_path(object("middle"))).expect("removed");
    assert_eq!(damage_of(&bench.run(3.5)), (Subject::Object, Fault::Missing, Repair::RunAgain));
    assert_eq!(bench.counts.take(), "middle");
    // Both the object and its output: the node runs, and the output is reported too.
    std::fs::remove_file(bench.store().object_path(object("top"))).expect("removed");
    change(&bench.out().join("toy.txt"), |bytes| bytes.extend(b"by hand"));
    let report = bench.run(3.5);
    assert_eq!(bench.counts.take(), "top");
    let subjects: Vec<Subject> = report.damage.iter().map(|damage| damage.subject).collect();
    assert_eq!(subjects, [Subject::Object, Subject::Output]);
    assert_eq!(bench.outputs()["toy.txt"], "the number is 30\n");
}

fn with_node(bench: &Bench, mut plan: Plan, name: &str, step: Step) -> Plan {
    let node = Node::new(Address::new(&plan.id, name), step).expect("describable");
    let after = Node::new(Address::new(&plan.id, "after"), bench.step("after", "words")).expect("describable");
    plan.nodes.push(after.input("x", &node.address, "out.txt"));
    plan.nodes.insert(0, node);
    let from = Address::new(&plan.id, "after");
    plan.exports.push(Export { path: "after.txt".into(), from, artifact: "out.txt".into() });
    plan
}

#[test]
fn a_failure_and_a_panic_block_what_needs_them_and_nothing_else() {
    let expected = [Failure::Node("no root between 1 and 2".into()), Failure::Panic("index 7 of 5".into())];
    for (act, failure) in ["fail", "panic"].into_iter().zip(expected) {
        let bench = Bench::new();
        let plan = with_node(&bench, bench.plan("toy", 0.8), "bad", bench.step("bad", act));
        let graph = Graph::join(vec![plan]).expect("sound");
        let report = bench.run_graph(&graph);
        assert_eq!(report.outcome(), Outcome::NodeFailed);
        let failures: Vec<_> = report.failures().map(|(address, why)| (address.to_string(), why.clone())).collect();
        assert_eq!(failures, [("toy/bad".to_owned(), failure)]);
        let cause = Address::new("toy", "bad");
        let after = report.node(&Address::new("toy", "after")).expect("reported");
        assert_eq!(after.status, Status::Blocked(cause));
        assert_eq!(bench.counts.take(), "aside bad middle source top");
        assert_eq!(bench.outputs().len(), 2, "the others are there");
        // A failure is not stored: the next run tries again, and only that.
        bench.run_graph(&graph);
        assert_eq!(bench.counts.take(), "bad");
    }
}

#[test]
fn fail_fast_starts_nothing_more() {
    let bench = Bench::new();
    let plan = with_node(&bench, bench.plan("toy", 0.8), "bad", bench.step("bad", "fail"));
    let graph = Graph::join(vec![plan]).expect("sound");
    let options = Options { fail_fast: true, jobs: 1, ..bench.options() };
    let report = run(&graph, &graph.all(), &bench.store(), &options, &mut Silent);
    assert_eq!(bench.counts.take(), "bad");
    assert!(report.count(|status| *status == Status::NotReached) >= 3, "{:?}", statuses(&report));
}

#[test]
fn an_artifact_that_is_not_made_fails_who_asks_for_it() {
    let bench = Bench::new();
    let mut plan = bench.plan("toy", 0.8);
    plan.nodes.retain(|node| node.address.node != "top");
    let top = Node::new(Address::new("toy", "top"), bench.step("top", "words")).expect("describable");
    plan.nodes.push(top.input("x", &Address::new("toy", "middle"), "none.txt"));
    plan.exports.push(Export {
        path: "none.txt".into(),
        from: Address::new("toy", "aside"),
        artifact: "none.txt".into(),
    });
    let report = bench.run_graph(&Graph::join(vec![plan]).expect("sound"));
    assert_eq!(report.outcome(), Outcome::NodeFailed);
    let failures: Vec<String> = report.failures().map(|(address, why)| format!("{address}: {why}")).collect();
    assert_eq!(failures, ["toy/top: toy/middle makes no \"none.txt\"; it makes out.txt"]);
    let status = &report.exports.last().expect("an export").status;
    assert!(matches!(status, ExportStatus::NoSuchArtifact(_)), "{status:?}");
}

#[test]
fn two_runs_at_once_compute_each_node_once() {
    let bench = Bench::new();
    let plans = |ids: &[&str]| -> Vec<Plan> {
        let slow = |id: &&str| {
            let mut plan = bench.plan(id, 0.8);
            for (index, name) in ["slow-a", "slow-b", "slow-c", "slow-d"].into_iter().enumerate() {
                let takes = Duration::from_millis(30);
                let step = Step { takes, k: Some(index as f64), ..bench.step(name, "floor") };
                plan.nodes.push(Node::new(Address::new(*id, name), step).expect("describable"));
            }
            plan
        };
        ids.iter().map(slow).collect()
    };
    let graphs: Vec<Graph> = (0..8).map(|_| Graph::join(plans(&["toy"])).expect("sound")).collect();
    let reports: Vec<Report> = std::thread::scope(|scope| {
        let runs: Vec<_> = graphs.iter().map(|graph| scope.spawn(|| bench.run_graph(graph))).collect();
        runs.into_iter().map(|run| run.join().expect("no panic")).collect()
    });
    assert_eq!(bench.counts.take(), "aside middle slow-a slow-b slow-c slow-d source top");
    assert!(reports.iter().all(|report| report.outcome() == Outcome::Success));
    assert_eq!(reports.iter().map(Report::ran).sum::<usize>(), 8);
    assert_eq!(bench.run(0.8).damage, []);
}

/// A run that waits says for what.
#[test]
fn a_waiting_run_names_the_holder() {
    #[derive(Default)]
    struct Heard(Vec<String>);
    impl Events for Heard {
        fn waiting(&mut self, address: Option<&Address>, holder: &str) {
            self.0.push(format!("{} {holder}", address.map(ToString::to_string).unwrap_or_default()));
        }
    }
    let bench = Bench::new();
    let key = bench.run(0.8).nodes.iter().find(|n| n.address.node == "aside").and_then(|n| n.key).expect("a key");
    let lock = std::fs::OpenOptions::new().write(true).open(bench.store().lock_path(&key.to_string())).expect("lock");
    lock.lock().expect("locked");
    std::fs::remove_file(bench.store().record_path(key)).expect("removed");
    let graph = bench.graph(0.8);
    let mut heard = Heard::default();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(60));
            drop(lock);
        });
        let report = run(&graph, &graph.all(), &bench.store(), &bench.options(), &mut heard);
        assert_eq!(report.outcome(), Outcome::Success);
    });
    assert_eq!(heard.0, [format!("toy/aside process {} for toy/aside", std::process::id())]);
}

#[test]
fn a_measurement_runs_alone() {
    let bench = Bench::new();
    let mut plan = bench.plan("toy", 0.8);
    let takes = Duration::from_millis(20);
    let clock = Step { takes, kind: Some(&CLOCK), ..bench.step("clock", "alone") };
    plan.nodes.insert(1, Node::new(Address::new("toy", "clock"), clock).expect("describable"));
    #[derive(Default)]
    struct Heard(Vec<String>);
    impl Events for Heard {
        fn started(&mut self, address: &Address, _: Option<Duration>) {
            self.0.push(format!("+{}", address.node));
        }
        fn finished(&mut self, address: &Address, _: Duration, _: &polhode::contract::work::Work) {
            self.0.push(format!("-{}", address.node));
        }
    }
    let graph = Graph::join(vec![plan]).expect("sound");
    let mut heard = Heard::default();
    run(&graph, &graph.all(), &bench.store(), &bench.options(), &mut heard);
    let at = heard.0.iter().position(|event| event == "+clock").expect("it ran");
    assert_eq!(heard.0[at + 1], "-clock", "{:?}", heard.0);
    let open: i32 = heard.0[..at].iter().map(|event| if event.starts_with('+') { 1 } else { -1 }).sum();
    assert_eq!(open, 0, "{:?}", heard.0);
}

#[test]
fn a_forecast_writes_nothing_and_says_what_the_run_will_do() {
    let bench = Bench::new();
    let graph = bench.graph(0.8);
    let (store, options) = (bench.store(), bench.options());
    let empty = forecast(&graph, &graph.all(), &store, &options);
    assert!(files(bench.folder.path()).is_empty(), "a forecast of an empty folder leaves it empty");
    assert_eq!(empty.with(Prospect::WillRun).count(), 2, "source and aside");
    assert_eq!(empty.with(Prospect::MayRun).count(), 2, "middle and top");
    bench.run(0.8);
    let before = snapshot(&bench);
    assert!(forecast(&graph, &graph.all(), &store, &options).is_idle());
    let edited = bench.graph(1.5);
    let report = why(&edited, &store, &options, "toy.txt").expect("a target");
    assert_eq!(snapshot(&bench), before);
    let source = &report.forecast.nodes[0];
    assert_eq!((source.address.node.as_str(), source.prospect), ("source", Prospect::WillRun));
    let file = "experiments/toy.toml".to_owned();
    let (old, new) = (Some("0.8".to_owned()), Some("1.5".to_owned()));
    let expected = Reason::Parameter { leaf: "k".into(), old, new, file, key: "k".into(), line: Some(2) };
    assert_eq!(source.reasons, [expected]);
    assert_eq!(source.follows, ["toy/middle", "toy/top"]);
    assert!(source.last_seconds.is_some());
    assert!(report.text().contains("k: 0.8 → 1.5 (experiments/toy.toml:2, k)"), "{}", report.text());
    assert_eq!(report.origins.len(), 1, "the present bytes are those of a record");
    // Going back, or on to a value whose work is done: nothing runs, and the forecast knows.
    bench.run(1.5);
    let back = forecast(&graph, &graph.all(), &store, &options);
    assert_eq!(back.with(Prospect::UpToDate).count(), 4);
    assert!(!back.is_idle(), "toy.txt will be brought back");
}

#[test]
fn why_names_damage() {
    let bench = Bench::new();
    let report = bench.run(0.8);
    let key = |name: &str| report.node(&Address::new("toy", name)).and_then(|node| node.key).expect("a key");
    let (store, options, graph) = (bench.store(), bench.options(), bench.graph(0.8));
    std::fs::remove_file(store.record_path(key("aside"))).expect("removed");
    change(&store.record_path(key("source")), |bytes| bytes[90] ^= 1);
    std::fs::remove_file(bench.out().join("toy.txt")).expect("removed");
    let found = forecast(&graph, &graph.all(), &store, &options);
    let reasons = |name: &str| {
        found.nodes.iter().find(|node| node.address.node == name).map(|node| node.reasons.clone()).expect("a node")
    };
    assert!(matches!(reasons("aside").as_slice(), [Reason::RecordMissing { .. }]));
    assert!(matches!(reasons("source").as_slice(), [Reason::RecordDamaged { .. }]));
    let bench = Bench::new();
    bench.run(0.8);
    std::fs::remove_file(bench.out().join("toy.txt")).expect("removed");
    let text = why(&graph, &bench.store(), &bench.options(), "toy").expect("a target").text();
    assert!(text.contains("toy.txt: is missing; will be restored from the store"), "{text}");
}

/// Code listings that a test edits: what reads the changed room runs, and `why` names the file.
#[test]
fn a_change_of_code_is_named_and_reruns_only_its_kinds() {
    let bench = Bench::new();
    bench.run(0.8);
    bench.counts.take();
    let edited = |kind: &polhode::contract::node::Kind| {
        let lines = listing(kind)?.lines.clone();
        let edit = |(name, value): CodeLine| {
            let is_edited = name == "numerics/real.rs";
            (name, if is_edited { Digest::of(b"edited").to_string().into() } else { value })
        };
        Ok(Arc::new(CodeListing::new(lines.into_iter().map(edit))))
    };
    let graph = Graph::join_with(vec![bench.plan("toy", 0.8)], &edited).expect("sound");
    let report = why(&graph, &bench.store(), &bench.options(), "toy").expect("a target");
    let source = report.forecast.nodes.iter().find(|node| node.address.node == "source").expect("a node");
    let [Reason::Code { changes }] = source.reasons.as_slice() else { panic!("{:?}", source.reasons) };
    assert_eq!(changes.iter().map(|change| change.name.as_str()).collect::<Vec<_>>(), ["numerics/real.rs"]);
    bench.run_graph(&graph);
    assert_eq!(bench.counts.take(), "source", "its kind alone declares numerics, and its result is the same");
}

#[test]
fn targets_select_what_they_need_and_leave_the_rest_alone() {
    let bench = Bench::new();
    let graph = Graph::join(vec![bench.plan("a", 0.8), bench.plan("b", 7.0)]).expect("sound");
    let run_targets = |targets: &[&str]| {
        let selection = graph.select(targets).expect("targets");
        run(&graph, &selection, &bench.store(), &bench.options(), &mut Silent)
    };
    run_targets(&["a.txt"]);
    assert_eq!(bench.counts.take(), "middle source top");
    assert_eq!(bench.outputs().into_keys().collect::<Vec<_>>(), ["a.txt"]);
    run_targets(&["b"]);
    assert_eq!(bench.counts.take(), "aside middle source top");
    assert_eq!(bench.outputs().into_keys().collect::<Vec<_>>(), ["a.txt", "b.txt", "data/b/aside.txt"]);
    let error = graph.select(&["a.txd"]).expect_err("no such target");
    assert_eq!(error.near.first().map(String::as_str), Some("a.txt"));
}

#[test]
fn files_that_nobody_makes_are_reported_and_left() {
    let bench = Bench::new();
    let graph = bench.graph(0.8);
    std::fs::create_dir_all(bench.out().join("measured")).expect("made");
    std::fs::write(bench.out().join("notes.md"), "mine").expect("written");
    std::fs::write(bench.out().join("measured/time.svg"), "other").expect("written");
    let known_exports = Some(graph.export_paths());
    let options = Options { known_exports, unscanned: vec!["measured".into()], ..bench.options() };
    let report = run(&graph, &graph.all(), &bench.store(), &options, &mut Silent);
    assert_eq!(report.unknown_files, ["notes.md"]);
    assert_eq!(bench.outputs()["notes.md"], "mine");
}

#[test]
fn stored_artifacts_are_had_by_address() {
    let bench = Bench::new();
    let (store, options, graph) = (bench.store(), bench.options(), bench.graph(0.8));
    let top = Address::new("toy", "top");
    let get = |address: &Address, name: &str| stored(&graph, &store, &options, address, name);
    assert_eq!(get(&top, "out.txt"), Err(NotStored::NotRun(top.clone())));
    bench.run(0.8);
    assert_eq!(get(&top, "out.txt").as_deref(), Ok(b"the number is 0\n".as_slice()));
    assert!(matches!(get(&top, "no.txt"), Err(NotStored::NoSuchArtifact { .. })));
    let nowhere = Address::new("toy", "nowhere");
    assert_eq!(get(&nowhere, "out.txt"), Err(NotStored::NoSuchNode(nowhere.clone())));
    let object = Digest::of(b"the number is 0\n");
    change(&store.object_path(object), |bytes| bytes[0] ^= 1);
    assert!(matches!(get(&top, "out.txt"), Err(NotStored::Damaged { fault: Fault::Altered, .. })));
}

#[test]
fn force_runs_all_and_tells_what_is_not_reproducible() {
    let bench = Bench::new();
    bench.run(0.8);
    bench.counts.take();
    let graph = bench.graph(0.8);
    let options = Options { force: true, ..bench.options() };
    let report = run(&graph, &graph.all(), &bench.store(), &options, &mut Silent);
    assert_eq!(bench.counts.take(), "aside middle source top");
    assert!(report.nodes.iter().all(|node| node.differs.is_empty()));
    // A source that does not declare what it depends on: same key, another result.
    let mut plan = bench.plan("toy", 0.8);
    let lying = Step { k: Some(3.0), kind: Some(&SOURCE), ..bench.step("source", "floor") };
    let honest = toy::lines(&Step { k: Some(0.8), ..lying.clone() });
    let mut node = Node::new(Address::new("toy", "source"), lying).expect("describable");
    node.params = honest;
    plan.nodes.retain(|node| node.address.node != "source");
    plan.nodes.push(node);
    let graph = Graph::join(vec![plan]).expect("sound");
    let report = run(&graph, &graph.all(), &bench.store(), &options, &mut Silent);
    let source = report.node(&Address::new("toy", "source")).expect("reported");
    assert_eq!(source.differs, ["out.txt"]);
}

/// Plans with every defect at once: all are returned.
#[test]
fn all_defects_of_plans_are_returned() {
    static ODD: polhode::contract::node::Kind =
        polhode::contract::node::Kind { name: "odd", summary: "", code: &["nowhere"], measurement: false };
    let bench = Bench::new();
    let mut plan = bench.plan("toy", 0.8);
    let at = |name: &str| Address::new("toy", name);
    let node = |name: &str| Node::new(at(name), bench.step(name, "alone")).expect("describable");
    plan.nodes.push(node("aside"));
    plan.nodes.push(node("lost").input("x", &at("nowhere"), "out.txt"));
    plan.nodes.push(node("twice").input("x", &at("aside"), "out.txt").input("x", &at("aside"), "out.txt"));
    let odd = Step { kind: Some(&ODD), ..bench.step("odd", "alone") };
    plan.nodes.push(Node::new(at("odd"), odd).expect("describable"));
    let export = |path: &str, from: &str| Export { path: path.into(), from: at(from), artifact: "out.txt".into() };
    plan.exports.extend([export("toy.txt", "aside"), export("data", "aside"), export("toy.txt/deep", "aside")]);
    plan.exports.extend([export("../escape", "aside"), export("/abs", "aside"), export("fine", "nowhere")]);
    let errors = Graph::join(vec![plan, bench.plan("a/b", 0.8), bench.plan("c", 0.8), bench.plan("c", 0.8)])
        .expect_err("defects");
    let count = |is: fn(&GraphError) -> bool| errors.iter().filter(|error| is(error)).count();
    assert_eq!(count(|e| matches!(e, GraphError::DuplicateAddress(a) if a.experiment == "toy")), 1);
    assert_eq!(count(|e| matches!(e, GraphError::UnknownInput { .. })), 1);
    assert_eq!(count(|e| matches!(e, GraphError::DuplicateInput { .. })), 1);
    assert_eq!(count(|e| matches!(e, GraphError::UnknownExport { .. })), 1);
    assert_eq!(count(|e| matches!(e, GraphError::UnknownCode(_))), 1);
    assert_eq!(count(|e| matches!(e, GraphError::BadPath(_))), 2);
    assert_eq!(count(|e| matches!(e, GraphError::BadId(_))), 1);
    assert_eq!(count(|e| matches!(e, GraphError::DuplicateExperiment(_))), 1);
    assert!(count(|e| matches!(e, GraphError::DuplicatePath { .. })) >= 3, "{errors:?}");
}

#[test]
fn a_cycle_is_shown_as_it_goes() {
    let bench = Bench::new();
    let at = |name: &str| Address::new("toy", name);
    let node = |name: &str, from: &str| {
        Node::new(at(name), bench.step(name, "alone")).expect("describable").input("x", &at(from), "out.txt")
    };
    let plan =
        Plan { id: "toy".into(), nodes: vec![node("a", "b"), node("b", "a"), node("c", "a")], ..Plan::default() };
    let errors = Graph::join(vec![plan]).expect_err("a cycle");
    let [GraphError::Cycle(path)] = errors.as_slice() else { panic!("{errors:?}") };
    assert_eq!(path.first(), path.last());
    assert_eq!(path.len(), 3);
}

/// Refuses one operation from the n-th call on.
struct Refuse(Operation);

impl Probe for Refuse {
    fn before(&self, operation: Operation, _: &Path) -> io::Result<()> {
        if operation == self.0 { Err(io::Error::from(io::ErrorKind::ReadOnlyFilesystem)) } else { Ok(()) }
    }
}

/// A store that refuses an operation: a value with the operation and the path, nothing half done; then it works again.
#[test]
fn a_store_that_cannot_be_used_is_an_error_with_data() {
    let operations = [
        Operation::CreateFolder,
        Operation::Create,
        Operation::Write,
        Operation::SyncFile,
        Operation::Rename,
        Operation::SyncFolder,
        Operation::OpenLock,
        Operation::Lock,
    ];
    for operation in operations {
        let bench = Bench::new();
        let refusing = Store::with_disk(bench.store().folder(), Disk::probed(Arc::new(Refuse(operation))));
        let graph = bench.graph(0.8);
        let report = run(&graph, &graph.all(), &refusing, &bench.options(), &mut Silent);
        assert_eq!(report.outcome(), Outcome::StoreFailed, "{operation:?}");
        let StoreError::Disk(error) = &report.store_errors[0] else { panic!("{:?}", report.store_errors) };
        assert_eq!((error.operation, error.kind), (operation, io::ErrorKind::ReadOnlyFilesystem));
        let report = bench.run(0.8);
        assert_eq!(report.outcome(), Outcome::Success, "{operation:?}");
        assert_eq!(report.damage, [], "{operation:?}");
    }
}

/// A store and outputs that can't be written are fine as long as there is nothing to write.
#[test]
fn nothing_to_do_needs_no_writing() {
    let bench = Bench::new();
    bench.run(0.8);
    for operation in [Operation::CreateFolder, Operation::Create, Operation::Write, Operation::Rename] {
        let store = Store::with_disk(bench.store().folder(), Disk::probed(Arc::new(Refuse(operation))));
        let graph = bench.graph(0.8);
        let report = run(&graph, &graph.all(), &store, &bench.options(), &mut Silent);
        assert_eq!((report.outcome(), report.warnings.len()), (Outcome::Success, 0), "{operation:?}");
    }
}

/// Objects are durable before the record that names them, and each file before it gets its name.
#[test]
fn the_order_of_writes_is_safe() {
    struct Watch(std::sync::Mutex<Vec<(Operation, String)>>);
    impl Probe for Watch {
        fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
            self.0.lock().expect("unpoisoned").push((operation, path.display().to_string()));
            Ok(())
        }
    }
    let bench = Bench::new();
    let watch = Arc::new(Watch(std::sync::Mutex::default()));
    let store = Store::with_disk(bench.store().folder(), Disk::probed(watch.clone()));
    let graph = bench.graph(0.8);
    let options = Options { jobs: 1, ..bench.options() };
    let selection = graph.select(&["toy/source"]).expect("a target");
    run(&graph, &selection, &store, &options, &mut Silent);
    let calls = watch.0.lock().expect("unpoisoned");
    let writes: Vec<String> = calls
        .iter()
        .filter_map(|(operation, path)| {
            let room = ["objects", "records", "heads", "runs", "tmp"].into_iter().find(|room| path.contains(room))?;
            use Operation::{Create, Rename, SyncFile, SyncFolder, Write};
            [Create, Write, SyncFile, Rename, SyncFolder].contains(operation).then(|| format!("{operation:?} {room}"))
        })
        .collect();
    let one = |room: &str| {
        let file = ["Create tmp", "Write tmp", "SyncFile tmp"].map(str::to_owned);
        file.into_iter().chain([format!("Rename {room}"), format!("SyncFolder {room}")]).collect::<Vec<_>>()
    };
    let order = ["objects", "objects", "records", "heads", "runs"];
    let mut at = writes.iter();
    for (number, room) in order.into_iter().enumerate() {
        for step in one(room) {
            assert!(at.any(|write| *write == step), "{step} of file {number} in order: {writes:#?}");
        }
    }
}

#[test]
fn the_graph_can_be_drawn() {
    let bench = Bench::new();
    let graph = bench.graph(0.8);
    let selection = graph.select(&["toy.txt"]).expect("a target");
    let text = render(&graph, &selection, Format::Text);
    assert!(text.contains("toy/top [step]\n    ← toy/middle out.txt\n    → toy.txt\n"), "{text}");
    assert!(render(&graph, &selection, Format::Dot).contains("n0 -> n1;"));
    assert!(render(&graph, &selection, Format::Mermaid).contains("n1 --> n2"));
    let json: serde_json::Value = serde_json::from_str(&render(&graph, &selection, Format::Json)).expect("JSON");
    assert_eq!(json["nodes"].as_array().map(Vec::len), Some(3));
    assert_eq!(json["exports"][0]["path"], "toy.txt");
}

/// What a killed run left in the store's `tmp` is removed as soon as no other run is alive, and not before.
#[test]
fn leftovers_of_killed_runs_go_when_nobody_is_alive() {
    let bench = Bench::new();
    bench.run(0.8);
    let leftover = bench.store().scratch().join(".polhode-tmp-1-1");
    std::fs::write(&leftover, "half a file").expect("written");
    let alive = bench.store().begin(&mut || ()).expect("begun");
    assert!(!leftover.exists(), "nobody was alive");
    std::fs::write(&leftover, "being written").expect("written");
    bench.run(1.5);
    assert!(leftover.exists(), "another run was alive");
    drop(alive);
    bench.run(1.5);
    assert!(!leftover.exists());
}

/// A store on another file system than the outputs: files are written beside their places, and nothing stays there.
#[test]
fn outputs_may_lie_on_another_file_system() {
    struct Apart;
    impl Probe for Apart {
        fn before(&self, operation: Operation, path: &Path) -> io::Result<()> {
            // The probe sees the target of a rename only: the first for each path comes from the store's folder.
            static SEEN: std::sync::Mutex<Vec<std::path::PathBuf>> = std::sync::Mutex::new(Vec::new());
            let mut seen = SEEN.lock().expect("unpoisoned");
            let is_output = operation == Operation::Rename && path.to_string_lossy().contains("figures");
            if is_output && !seen.contains(&path.to_owned()) {
                seen.push(path.to_owned());
                return Err(io::Error::from(io::ErrorKind::CrossesDevices));
            }
            Ok(())
        }
    }
    let bench = Bench::new();
    let store = Store::with_disk(bench.store().folder(), Disk::probed(Arc::new(Apart)));
    std::fs::create_dir_all(bench.out()).expect("made");
    std::fs::write(bench.out().join(".polhode-tmp-1-1"), "left by a killed run").expect("written");
    let graph = bench.graph(0.8);
    let options = Options { known_exports: Some(graph.export_paths()), ..bench.options() };
    let report = run(&graph, &graph.all(), &store, &options, &mut Silent);
    assert_eq!((report.outcome(), report.unknown_files.len()), (Outcome::Success, 0));
    assert_eq!(bench.outputs().into_keys().collect::<Vec<_>>(), ["data/toy/aside.txt", "toy.txt"]);
    assert!(files(&store.scratch()).is_empty());
}

/// Heads of an experiment whose sweep has changed: the old address is kept, and marked as no longer planned.
#[test]
fn heads_remember_addresses_that_are_gone() {
    use polhode::pipeline::heads::view;
    let bench = Bench::new();
    bench.run(0.8);
    let mut plan = bench.plan("toy", 0.8);
    plan.nodes.retain(|node| node.address.node != "aside");
    plan.exports.retain(|export| export.from.node != "aside");
    bench.run_graph(&Graph::join(vec![plan]).expect("sound"));
    let (heads, fault) = bench.store().heads(&view(bench.folder.path(), &bench.out()), "toy");
    assert_eq!(fault, None);
    let live: Vec<(&str, bool)> = heads.nodes.iter().map(|(address, head)| (address.as_str(), head.live)).collect();
    assert_eq!(live, [("toy/aside", false), ("toy/middle", true), ("toy/source", true), ("toy/top", true)]);
    assert_eq!(heads.exports.keys().collect::<Vec<_>>(), ["toy.txt"]);
    let runs = bench.store().runs(9);
    assert_eq!(runs.len(), 2, "the second run only dropped an address; gc --keep must know which key it had");
    assert_eq!((runs[0].ran.len(), runs[0].superseded.as_slice()), (0, [heads.nodes["toy/aside"].key].as_slice()));
}

/// Single calls to the file system, and all calls from one on, made to fail in turn: the run says so or is right,
/// and the next run, without any flag, ends with the bytes of an undisturbed one.
#[test]
fn whatever_call_fails_the_next_run_is_right() {
    struct Fail {
        at: usize,
        is_lasting: bool,
        calls: std::sync::atomic::AtomicUsize,
    }
    impl Probe for Fail {
        fn before(&self, _: Operation, _: &Path) -> io::Result<()> {
            let call = self.calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            let is_hit = call == self.at || (self.is_lasting && call > self.at);
            if is_hit { Err(io::Error::from(io::ErrorKind::StorageFull)) } else { Ok(()) }
        }
    }
    // Every seventh call (prime to the calls of one node); POLHODE_FAULT_STEP=1 takes them all, in about a minute.
    let step = std::env::var("POLHODE_FAULT_STEP").ok().and_then(|step| step.parse().ok()).unwrap_or(7);
    let undisturbed = Bench::new();
    undisturbed.run(3.5);
    for is_lasting in [false, true] {
        let mut at = 0;
        loop {
            let bench = Bench::new();
            let fail = Arc::new(Fail { at, is_lasting, calls: 0.into() });
            let store = Store::with_disk(bench.store().folder(), Disk::probed(fail.clone()));
            let graph = bench.graph(3.5);
            let report = run(&graph, &graph.all(), &store, &bench.options(), &mut Silent);
            let is_right = bench.outputs() == undisturbed.outputs();
            assert!(report.outcome() != Outcome::Success || is_right, "call {at}: success, but the outputs are wrong");
            let next = bench.run(3.5);
            assert_eq!(next.outcome(), Outcome::Success, "after call {at}");
            assert_eq!(bench.outputs(), undisturbed.outputs(), "after call {at}");
            let objects = |bench: &Bench| {
                let names = files(&bench.store().folder().join("objects")).into_iter();
                names.map(|path| path.file_name().expect("a name").to_owned()).collect::<Vec<_>>()
            };
            assert_eq!(objects(&bench), objects(&undisturbed), "after call {at}");
            assert!(files(&bench.store().scratch()).is_empty(), "after call {at}");
            if fail.calls.load(std::sync::atomic::Ordering::Relaxed) <= at {
                break;
            }
            at += step;
        }
        assert!(at > 80, "only {at} calls");
    }
}
