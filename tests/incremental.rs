//! What an edit makes the command compute: what depends on it, and nothing else. The oracle is the list of nodes that a
//! run reports to have run, and the bytes of the outputs.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;
#[path = "../src/contract/tokens.rs"]
#[allow(dead_code, reason = "a part of it is for build.rs")]
mod tokens;

use polhode::cli::arguments::PlaceArguments;
use polhode::cli::collected;
use polhode::cli::page;
use polhode::cli::session::Session;
use polhode::contract::code::{self, CodeListing};
use polhode::contract::node::{Address, Kind};
use polhode::contract::plan::Plan;
use polhode::pipeline::events::Silent;
use polhode::pipeline::forecast::{Prospect, forecast};
use polhode::pipeline::graph::Graph;
use polhode::pipeline::reason::Reason;
use polhode::pipeline::report::Status;
use polhode::pipeline::run::run;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};
use support::{Report, Shared, Workspace, all_experiments, files, repository};

/// Figures 7 and 8, computed once, 7 before 8; and what the run for Figure 8 reported.
fn spin() -> &'static (Shared, Report) {
    static SPIN: OnceLock<(Shared, Report)> = OnceLock::new();
    SPIN.get_or_init(|| {
        let shared = Shared::empty("incremental", &["fig7", "fig8"]);
        shared.workspace.line("figures fig7 --no-progress").ends(0);
        let report = Report(shared.workspace.line("figures fig8 --json --no-progress").ends(0).json());
        shared.workspace.figures();
        (shared, report)
    })
}

/// A workspace of one's own in which both are up to date, and known to be.
fn up_to_date() -> Workspace {
    let workspace = spin().0.workspace.copy();
    let report = workspace.figures();
    assert_eq!(report.nodes("ran"), [""; 0]);
    assert_eq!(report.outputs("unchanged").len(), report.0["report"]["exports"].as_array().expect("exports").len());
    workspace
}

fn has_k(node: &str, k: &str) -> bool {
    node.split('/').any(|part| part == format!("k={k}"))
}

#[track_caller]
fn nothing_runs(workspace: &Workspace, why: &str) {
    let report = workspace.figures();
    assert_eq!(report.nodes("ran"), [""; 0], "{why}");
    assert_eq!(report.nodes("cached").len(), report.all_nodes().len(), "{why}");
    assert_eq!(report.0["report"]["damage"].as_array().map(Vec::len), Some(0), "{why}");
}

#[test]
fn editing_one_k_runs_its_nodes_the_picture_and_the_findings() {
    let workspace = up_to_date();
    let before = workspace.figures().all_nodes();
    let outputs = workspace.files("figures");
    workspace.edit("fig7", "[0.8, 0.5, 0.2, 0.1]", "[0.8, 0.55, 0.2, 0.1]");

    let of_k: BTreeSet<String> =
        before.iter().filter(|node| node.starts_with("fig7/") && has_k(node, "0.5")).cloned().collect();
    assert!(of_k.len() >= 2, "the locus, and its second route at least: {of_k:?}");
    let mut expected: BTreeSet<String> = of_k.iter().map(|node| node.replace("k=0.5", "k=0.55")).collect();
    expected.extend(["fig7/picture", "fig7/findings"].map(str::to_owned));

    let report = workspace.figures();
    let ran: BTreeSet<String> = report.nodes("ran").into_iter().collect();
    // values.toml and the page collect what all found.
    let collected = BTreeSet::from(["article/page".to_owned(), "values/all".to_owned()]);
    assert_eq!(&ran - &collected, expected);
    assert_eq!(report.nodes("cached").len() + ran.len(), before.len());
    assert!(workspace.files("figures").get("fig8.svg") == outputs.get("fig8.svg"));
    assert!(workspace.files("figures").get("fig7.svg") != outputs.get("fig7.svg"));

    // Going back computes nothing, and brings back the same bytes.
    workspace.edit("fig7", "0.55", "0.5");
    nothing_runs(&workspace, "going back");
    let mut back = workspace.files("figures");
    // The files of k = 0.55 are made by nobody now: they are reported, and kept.
    back.retain(|path, _| !path.contains("k=0.55"));
    assert!(back == outputs, "other bytes after going back");
    // And forth again.
    workspace.edit("fig7", "[0.8, 0.5, 0.2, 0.1]", "[0.8, 0.55, 0.2, 0.1]");
    nothing_runs(&workspace, "going forth again");
}

#[test]
fn figure_8_finds_what_figure_7_computed() {
    let (_, report) = spin();
    let nodes = report.all_nodes();
    let locus = |k: &str| {
        nodes
            .iter()
            .find(|node| node.starts_with("fig8/conjugate-locus") && has_k(node, k))
            .unwrap_or_else(|| panic!("no locus for k = {k} in {nodes:?}"))
    };
    assert!(report.nodes("cached").contains(locus("0.8")), "{report:?}");
    for k in ["1.15", "1.18"] {
        assert!(report.nodes("ran").contains(locus(k)), "{report:?}");
    }
    // One key, two addresses.
    let key = |experiment: &str| {
        let listed = spin().0.workspace.line(&format!("list {experiment} --json")).ends(0).json();
        let nodes = listed["experiments"][0]["nodes"].as_array().expect("nodes").clone();
        let is = |address: &str| address.starts_with(&format!("{experiment}/conjugate-locus")) && has_k(address, "0.8");
        nodes.iter().find(|node| is(node["address"].as_str().expect("an address"))).expect("the locus")["key"].clone()
    };
    assert_eq!(key("fig7"), key("fig8"));
}

/// Comments, layout, spelling of numbers, order of keys: the same values.
#[test]
fn other_words_for_the_same_values_run_nothing() {
    let workspace = up_to_date();
    let outputs = workspace.files("figures");
    workspace.edit("fig7", "[0.8, 0.5, 0.2, 0.1]", "[ 0.80, 5e-1,\n  0.2, # a comment\n  0.1 ]");
    nothing_runs(&workspace, "0.80 for 0.8, 5e-1 for 0.5");
    let text = workspace.read("experiments/fig8.toml");
    workspace.write(
        "experiments/fig8.toml",
        format!("# A comment first.\n\n{}\n# and one last", text.replace(" = ", "   =  ")),
    );
    nothing_runs(&workspace, "comments and blanks");
    for id in ["fig7", "fig8"] {
        workspace
            .write(&format!("experiments/{id}.toml"), reordered(&workspace.read(&format!("experiments/{id}.toml"))));
    }
    nothing_runs(&workspace, "another order of keys");
    assert!(workspace.files("figures") == outputs, "other bytes");
}

/// The same TOML with all keys in another order, and other layout.
fn reordered(text: &str) -> String {
    fn write(value: &toml::Value, out: &mut String) {
        match value {
            toml::Value::Table(table) => {
                out.push_str("{ ");
                for (index, (key, value)) in table.iter().rev().enumerate() {
                    out.push_str(if index == 0 { "" } else { ", " });
                    out.push_str(&format!("{key:?} = "));
                    write(value, out);
                }
                out.push_str(" }");
            }
            other => out.push_str(&other.to_string()),
        }
    }
    let table: toml::Table = text.parse().expect("TOML");
    let mut out = String::new();
    for (key, value) in table.iter().rev() {
        out.push_str(&format!("{key} = "));
        write(value, &mut out);
        out.push('\n');
    }
    assert_eq!(out.parse::<toml::Table>().as_ref(), Ok(&table), "the same values");
    assert_ne!(out, text);
    out
}

/// For every experiment there is: the keys of all nodes whose inputs are known do not depend on how its config is written.
#[test]
fn keys_do_not_depend_on_how_configs_are_written() {
    let workspace = Workspace::with(&all_experiments());
    let keys = || {
        let listed = workspace.line("list --json").ends(0).json();
        let experiments = listed["experiments"].as_array().expect("experiments").clone();
        let nodes = experiments.iter().flat_map(|experiment| experiment["nodes"].as_array().expect("nodes").clone());
        let mut keys: Vec<(String, String)> =
            nodes.map(|node| (node["address"].to_string(), node["key"].to_string())).collect();
        keys.sort();
        keys
    };
    let before = keys();
    assert!(before.iter().filter(|(_, key)| key != "null").count() >= 4, "{before:?}");
    for id in all_experiments() {
        let file = format!("experiments/{id}.toml");
        let text = reordered(&workspace.read(&file));
        workspace.write(&file, format!("# Another hand.\n{text}"));
    }
    assert_eq!(keys(), before);
}

/// The plans of the real graph, as the command makes them.
fn plans(session: &Session) -> Vec<Plan> {
    let mut plans: Vec<Plan> = session.experiments.iter().map(|experiment| experiment.plan.clone()).collect();
    let ids: Vec<&str> = session.experiments.iter().map(|experiment| experiment.plan.id.as_str()).collect();
    plans.push(collected::plan(&ids).expect("a plan"));
    plans.push(page::plan(&session.experiments, session.workspace.has_source()).expect("a plan"));
    plans
}

fn session(workspace: &Workspace) -> Session {
    let place = PlaceArguments { experiments: Some(workspace.path("experiments")), ..PlaceArguments::default() };
    Session::begin(&place, &[]).unwrap_or_else(|refused| panic!("{}", refused.text))
}

/// The listing that a kind would have if every file of a room had one more token.
fn with_room_edited(kind: &Kind, room: &str) -> Result<Arc<CodeListing>, code::UnknownCode> {
    let listing = code::listing(kind)?;
    let edited = listing.lines.iter().map(|(name, digest)| {
        let is_in_room = name.starts_with(&format!("{room}/"));
        let digest = if is_in_room { with_one_more_token(name).into() } else { digest.clone() };
        (name.clone(), digest)
    });
    Ok(Arc::new(CodeListing::new(edited)))
}

fn digest_of(path: &str, edit: impl Fn(String) -> String) -> String {
    let text = std::fs::read_to_string(repository().join("src").join(path)).expect("source");
    let module: Vec<&str> = path.trim_end_matches(".rs").trim_end_matches("/mod").split('/').collect();
    tokens::read(&edit(text), &module).expect("tokens").digest
}

fn with_one_more_token(path: &str) -> String {
    static KNOWN: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
    if let Some(known) = KNOWN.lock().expect("unpoisoned").get(path) {
        return known.clone();
    }
    let edited = digest_of(path, |text| text + "\nconst ONE_MORE: u8 = 1;\n");
    assert_ne!(edited, digest_of(path, |text| text), "{path}");
    KNOWN.lock().expect("unpoisoned").insert(path.to_owned(), edited.clone());
    edited
}

/// Comments, docs, layout and test code do not count in any file of `src`.
#[test]
fn what_is_no_code_does_not_count() {
    let mut seen = 0;
    for path in files(&repository().join("src")).into_keys().filter(|path| path.ends_with(".rs")) {
        let as_it_is = digest_of(&path, |text| text);
        let noise = "\n\n// A remark.\n/* Another. */\n#[cfg(test)]\nmod more_tests {\n    #[test]\n    fn f() {}\n}\n";
        assert_eq!(digest_of(&path, |text| text + noise), as_it_is, "{path}");
        with_one_more_token(&path);
        seen += 1;
    }
    assert!(seen > 100, "{seen} files");
}

/// Every room edited, file by file: stale are exactly the kinds that declare it or a file of it.
#[test]
fn a_change_to_a_room_makes_stale_the_kinds_that_declare_it() {
    let workspace = Workspace::with(&all_experiments());
    let session = session(&workspace);
    let kinds: BTreeMap<&str, &Kind> =
        session.graph.nodes.iter().map(|placed| placed.node.compute.kind()).map(|kind| (kind.name, kind)).collect();
    let rooms: BTreeSet<String> = files(&repository().join("src"))
        .into_keys()
        .filter_map(|path| path.split_once('/').map(|(room, _)| room.to_owned()))
        .collect();
    assert!(rooms.len() >= 10 && kinds.len() >= 50, "{rooms:?}, {} kinds", kinds.len());
    for room in &rooms {
        for kind in kinds.values() {
            let before = code::listing(kind).expect("code that exists").digest;
            let after = with_room_edited(kind, room).expect("code that exists").digest;
            let is_declared = kind.code.iter().any(|code| code.split('/').next() == Some(room));
            assert_eq!(before != after, is_declared, "{} and {room}: it declares {:?}", kind.name, kind.code);
        }
    }
}

/// A change to every file of `src/plot`: the pictures run, and only they, for every experiment there is. What they draw is the same, so
/// no output changes. The code that the program runs is the real one; its fingerprints are those of edited copies.
#[test]
fn a_change_to_the_plot_room_runs_only_pictures() {
    let workspace = Workspace::with(&all_experiments());
    let session = session(&workspace);
    let plot = |kind: &Kind| with_room_edited(kind, "plot");
    let graph = Graph::join_with(plans(&session), &plot).expect("sound");
    let (mut pictures, mut kinds) = (0, BTreeSet::new());
    for (old, new) in session.graph.nodes.iter().zip(&graph.nodes) {
        assert_eq!(old.node.address, new.node.address);
        let is_picture = old.node.address.node == "picture";
        pictures += usize::from(is_picture);
        assert_eq!(old.code.digest != new.code.digest, is_picture, "{}", old.node.address);
        let kind = old.node.compute.kind();
        if !kinds.insert(kind.name) {
            continue;
        }
        let has = |room: &str| old.code.lines.iter().any(|(name, _)| name.starts_with(&format!("{room}/")));
        // The nodes that compute: by effect, on numerics; neither the command nor the experiments can make them stale.
        if !["picture", "findings"].contains(&old.node.address.node.as_str())
            && old.node.address.experiment != collected::ID
            && old.node.address != Address::new(page::ID, "page")
        {
            assert!(has("effects") && has("table"), "{}", kind.name);
            let computes = has("numerics") || has("geometry");
            // One that only rearranges what it reads needs no mathematics.
            assert!(computes || !old.node.inputs.is_empty(), "{}", kind.name);
            for room in ["plot", "experiments", "cli", "check", "pipeline", "article"] {
                assert!(!has(room), "{} declares {room}", kind.name);
            }
            for edited in ["plot", "experiments", "cli", "check", "pipeline"] {
                let after = with_room_edited(kind, edited).expect("code that exists");
                assert_eq!(after.digest, old.code.digest, "{} and {edited}", kind.name);
            }
            let numerics = ["numerics", "geometry"].map(|room| with_room_edited(kind, room).expect("code that exists"));
            assert_eq!(numerics.iter().any(|after| after.digest != old.code.digest), computes, "{}", kind.name);
        }
    }
    assert_eq!(pictures, session.experiments.len());
}

/// The same through a store: what a run after such a change does.
#[test]
fn after_a_change_to_the_plot_room_a_run_draws_and_integrates_nothing() {
    let workspace = up_to_date();
    let outputs = workspace.files("figures");
    let session = session(&workspace);
    let plot = |kind: &Kind| with_room_edited(kind, "plot");
    let graph = Graph::join_with(plans(&session), &plot).expect("sound");
    let foreseen = forecast(&graph, &session.selection, &session.store, &session.options);
    // The page reads pictures: what becomes of it is known when they are drawn.
    for node in foreseen.nodes.iter().filter(|node| node.address.node != "page") {
        let is_picture = node.address.node == "picture";
        let expected = if is_picture { Prospect::WillRun } else { Prospect::UpToDate };
        assert_eq!(node.prospect, expected, "{}: {:?}", node.address, node.reasons);
        if is_picture {
            let [Reason::Code { changes }] = node.reasons.as_slice() else { panic!("{:?}", node.reasons) };
            assert!(
                !changes.is_empty() && changes.iter().all(|change| change.name.starts_with("plot/")),
                "{changes:?}"
            );
        }
    }
    let report = run(&graph, &session.selection, &session.store, &session.options, &mut Silent);
    for node in &report.nodes {
        let expected = if node.address.node == "picture" { Status::Ran } else { Status::Cached };
        assert_eq!(node.status, expected, "{}", node.address);
    }
    assert_eq!(report.written().count(), 0, "drawn as before");
    assert!(workspace.files("figures") == outputs);
    // The program as it is finds its own pictures again.
    nothing_runs(&workspace, "the edit is taken back");
}

/// A change of numerics makes what computes stale; where results come out the same, what reads them does not follow.
#[test]
fn after_a_change_to_numerics_equal_results_stop_the_run() {
    let workspace = Workspace::with(&["remark_3_25"]);
    workspace.figures();
    let session = session(&workspace);
    let numerics = |kind: &Kind| with_room_edited(kind, "numerics");
    let graph = Graph::join_with(plans(&session), &numerics).expect("sound");
    let report = run(&graph, &session.selection, &session.store, &session.options, &mut Silent);
    let mut ran = 0;
    for (node, placed) in
        report.nodes.iter().zip(session.selection.nodes.iter().map(|node| &session.graph.nodes[*node]))
    {
        assert_eq!(node.address, placed.node.address);
        let is_stale = placed.code.lines.iter().any(|(name, _)| name.starts_with("numerics/"));
        assert_eq!(node.status, if is_stale { Status::Ran } else { Status::Cached }, "{}", node.address);
        ran += usize::from(is_stale);
    }
    assert!((1..report.nodes.len()).contains(&ran), "{ran} ran");
    assert_eq!(report.written().count(), 0);
    assert!(Path::new(&session.workspace.out).join("remark_3_25.svg").is_file());
}
