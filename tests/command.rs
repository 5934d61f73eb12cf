//! The command as its users meet it: exit codes, streams, messages, JSON, repairs.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Stdio;
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::Duration;
use support::{Ran, Report, Shared, Workspace, all_experiments, finish, goldens, repository, text};

const ID: &str = "remark_3_25";

/// One experiment, up to date.
fn computed() -> Workspace {
    static COMPUTED: OnceLock<Shared> = OnceLock::new();
    let workspace = COMPUTED.get_or_init(|| Shared::computed("command", &[ID])).workspace.copy();
    workspace.figures();
    workspace
}

// Exit codes ----------------------------------------------------------------------------------------------------------

#[test]
fn usage_errors_end_with_2() {
    let workspace = computed();
    let before = workspace.files("");
    for (line, words) in [
        ("", vec!["Usage"]),
        ("figure", vec!["figures"]),
        ("figures --job 2", vec!["--jobs"]),
        ("figures --jobs 0", vec!["--jobs"]),
        ("figures --accuracy best", vec!["best", "article"]),
        ("figures remark_3_26", vec!["remark_3_26", "remark_3_25"]),
        ("figures remark_3_25/cusp", vec!["remark_3_25/cusps"]),
        ("figures figures/remark_3_25.png", vec!["remark_3_25"]),
        ("check nothing", vec!["nothing"]),
        ("why", vec!["TARGET"]),
        ("why fig77", vec!["fig77"]),
        ("show remark_3_25/findings", vec!["remark_3_25/cusps"]),
        ("graph --form png", vec!["mermaid"]),
        ("new Fig10", vec!["Fig10"]),
        ("new fig10", vec!["src/experiments/mod.rs"]),
        ("figures --experiments nowhere", vec!["nowhere"]),
    ] {
        let ran = workspace.line(line).ends(2);
        assert_eq!(ran.out, "", "{line}");
        for word in words {
            assert!(ran.err.contains(word), "{line:?} does not say {word:?}:\n{}", ran.err);
        }
        assert!(workspace.files("") == before, "{line:?} wrote something");
    }
    // Outside of any folder with experiments.
    let elsewhere = tempfile::tempdir().expect("a folder");
    let ran = finish(support::polhode().arg("figures").current_dir(&elsewhere)).ends(2);
    assert!(ran.err.contains("experiments/") && ran.err.contains("--experiments DIR"), "{}", ran.err);
}

#[test]
fn a_dry_run_says_6_when_something_would_change() {
    let workspace = Workspace::with(&[ID]);
    workspace.line("figures --dry-run").ends(6);
    assert_eq!(workspace.files("").len(), 1, "a dry run writes nothing");
    workspace.figures();
    let before = workspace.files("");
    workspace.line("figures --dry-run").ends(0);
    workspace.line("why remark_3_25").ends(0);
    assert!(workspace.line("figures --dry-run").ends(0).out.contains("nothing to do"));
    assert_eq!(workspace.line("figures --dry-run --json").ends(0).json()["idle"], true);

    let again = workspace.line("figures --dry-run --force").ends(6);
    assert!(again.out.contains("forced"), "{}", again.out);
    std::fs::remove_file(workspace.path("figures/remark_3_25.svg")).expect("removed");
    let ran = workspace.line("figures --dry-run").ends(6);
    assert!(ran.out.contains("remark_3_25.svg"), "{}", ran.out);
    workspace.line("why figures/remark_3_25.svg").ends(6);
    workspace.line("why remark_3_25/cusps").ends(0);
    workspace.figures();
    workspace.edit(ID, "A = 1.5", "A = 1.6");
    let ran = workspace.line("figures --dry-run --json").ends(6);
    assert_eq!(ran.json()["idle"], false);
    workspace.line("figures --dry-run").ends(6);
    let mut after = workspace.files("");
    let config = format!("experiments/{ID}.toml");
    after.insert(config.clone(), before[&config].clone());
    // The log of runs and the heads are the runs' own.
    let rest = |mut files: BTreeMap<String, Vec<u8>>| {
        files.retain(|path, _| !path.contains("/runs/") && !path.contains("/heads/"));
        files
    };
    assert!(rest(after) == rest(before), "a dry run wrote something");
}

#[test]
fn a_store_that_can_not_be_used_ends_with_7() {
    let workspace = computed();
    workspace.write("a-file", "not a folder");
    let before = workspace.files("");
    for line in [
        "figures --store a-file",
        "check --store a-file",
        "figures --store a-file/deeper",
        "why remark_3_25 --store a-file",
        "figures --dry-run --store a-file",
    ] {
        let ran = workspace.line(line).ends(7);
        assert!(ran.err.contains("a-file") && ran.err.contains("--store"), "{}", ran.err);
        assert!(!ran.err.contains("repair"), "{}", ran.err);
    }
    assert!(workspace.files("") == before);
    // A folder inside of it that is a file.
    workspace.write("broken/v1/locks", "not a folder");
    let ran = workspace.line("figures --store broken").ends(7);
    assert!(ran.err.contains("locks"), "{}", ran.err);
}

/// 5 when a verdict is not the pinned one, before 6 when another entry of a golden differs; a golden for another config,
/// or none, is no failure, except with `--strict`.
#[test]
fn goldens_and_verdicts_decide_how_check_ends() {
    let workspace = computed();
    workspace.line("check").ends(0);
    workspace.line("check --strict").ends(6);
    let (_, golden) = goldens(&workspace).remove(0);
    let snapshot = |text: &str| format!("---\nsource: tests/golden.rs\n---\n{text}");
    let put = |text: &str| workspace.write("golden/remark_3_25.snap", snapshot(text));
    put(&golden);
    let ran = workspace.line("check --strict --json").ends(0);
    assert_eq!(ran.json()["goldens"][0]["outcome"], "same");
    let table = workspace.line("check").ends(0).out;
    assert!(table.contains("Claims of the article") && table.contains("same"), "{table}");

    let value = golden.lines().find(|line| line.starts_with("t_star: ")).expect("a value");
    put(&golden.replace(value, "t_star: 5.00000000000e0 length"));
    let ran = workspace.line("check").ends(6);
    assert!(ran.out.contains(&format!("t_star: 5.00000000000e0 length → {}", &value[8..])), "{}", ran.out);
    put(&golden.replace(value, "t_star: 5.00000000000e0 length").replace("time: holds", "time: fails"));
    let ran = workspace.line("check").ends(5);
    assert!(ran.out.contains("pinned: fails"), "{}", ran.out);

    put(&golden);
    workspace.edit(ID, "A = 1.5", "A = 1.4");
    let ran = workspace.line("check").ends(0);
    assert!(ran.out.contains("not comparable"), "{}", ran.out);
    workspace.line("check --strict").ends(6);
}

// Help ----------------------------------------------------------------------------------------------------------------

/// The commands under `Examples:` of a help text.
fn examples(help: &str) -> Vec<String> {
    let block = help.split_once("Examples:\n").unwrap_or_else(|| panic!("no examples first:\n{help}"));
    assert_eq!(block.0, "", "help begins with examples");
    let lines = block.1.lines().take_while(|line| !line.trim().is_empty());
    // What follows after a gap is a remark.
    lines.map(|line| line.trim_start().split("   ").next().expect("a command").trim_end().to_owned()).collect()
}

/// Every example of every help text runs, where they are meant to be run.
#[test]
fn the_examples_of_help_run() {
    let shared = Shared::computed("command-examples", &all_experiments());
    let workspace = &shared.workspace;
    workspace
        .write("src/experiments/mod.rs", std::fs::read(repository().join("src/experiments/mod.rs")).expect("the list"));
    workspace.write("starts.csv", "p_theta\n1\n2\n");
    for (name, bytes) in support::files(&repository().join("golden")) {
        workspace.write(&format!("golden/{name}"), bytes);
    }
    let help = workspace.line("--help").ends(0).out;
    let verbs: Vec<String> = help
        .lines()
        .skip_while(|line| !line.starts_with("Commands:"))
        .skip(1)
        .map_while(|line| line.strip_prefix("  ").map(|line| line.split(' ').next().unwrap_or_default().to_owned()))
        .collect();
    for verb in ["figures", "check", "why", "list", "graph", "show", "point", "new", "schema"] {
        assert!(verbs.iter().any(|known| known == verb), "{verb} in {verbs:?}");
    }
    let mut all = examples(&help);
    for verb in &verbs {
        let own = examples(&workspace.line(&format!("{verb} --help")).ends(0).out);
        assert!(own.iter().all(|line| line.starts_with(&format!("polhode {verb}"))), "{own:?}");
        all.extend(own);
    }
    // New experiments are no part of this program, so that what follows would refuse them.
    all.sort_by_key(|line| line.starts_with("polhode new"));
    all.dedup();
    assert!(all.len() >= 25, "{all:?}");
    let mut failed = Vec::new();
    let mut done = BTreeSet::new();
    // What watches does not end: it has a test of its own.
    for line in all.iter().filter(|line| !line.contains("--watch")) {
        // As a shell would: what is piped, redirected or done next is not this command's.
        let own =
            [" | ", " > ", " && "].iter().fold(line.as_str(), |own, mark| own.split(mark).next().unwrap_or_default());
        let own = own.strip_prefix("polhode ").unwrap_or_else(|| panic!("{line:?} is not ours"));
        if !done.insert(own) {
            continue;
        }
        let ran = workspace.line(&own.replace("/tmp/", "scratch/"));
        let is_strict = own.contains("--strict");
        if !(ran.code == 0 || is_strict && ran.code == 6) || ran.err.contains("panicked") {
            failed.push(format!("{line}: exit {}\n{}", ran.code, ran.err));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    assert!(workspace.path("points.csv").is_file() && workspace.path("scratch/f/remark_3_25.svg").is_file());
    assert!(workspace.path("src/experiments/fig10.rs").is_file() && workspace.path("experiments/fig10.toml").is_file());
}

/// A config that is saved is drawn again, a wrong one is said and waited over.
#[test]
fn watching_runs_again_when_a_config_is_saved() {
    let workspace = computed();
    let mut command = workspace.command();
    command.args(["figures", ID, "--watch", "--no-progress"]).stdin(Stdio::null()).stdout(Stdio::null());
    let mut child = command.stderr(Stdio::piped()).spawn().expect("starts");
    let (sender, receiver) = channel();
    let err = child.stderr.take().expect("a pipe");
    std::thread::spawn(move || {
        BufReader::new(err).lines().map_while(Result::ok).try_for_each(|line| sender.send(line))
    });
    // What is said until the next look.
    let watched = || {
        let mut said = Vec::new();
        loop {
            let line =
                receiver.recv_timeout(Duration::from_secs(60)).unwrap_or_else(|_| panic!("silent after {said:?}"));
            if line.starts_with("watching ") {
                return said.join("\n");
            }
            said.push(line);
        }
    };
    let first = watched();
    assert!(first.contains("8 nodes: 0 ran"), "{first}");
    let picture = || std::fs::read(workspace.path("figures/remark_3_25.svg")).expect("the picture");
    let before = picture();
    workspace.edit(ID, "A = 1.5", "A = 1.6");
    let edited = watched();
    assert!(edited.contains("changed: remark_3_25/t_star") && picture() != before, "{edited}");
    workspace.edit(ID, "A = 1.6", "A = 2.6");
    let wrong = watched();
    assert!(wrong.contains("scene.metric.serret-andoyer.B"), "{wrong}");
    workspace.edit(ID, "A = 2.6", "A = 1.5");
    let back = watched();
    assert!(back.contains("0 ran") && picture() == before, "{back}");
    child.kill().expect("killed");
    child.wait().expect("ended");
}

#[test]
fn help_and_version_are_data() {
    let workspace = Workspace::with::<&str>(&[]);
    let ran = workspace.line("--help").ends(0);
    assert!(ran.err.is_empty() && ran.out.starts_with("Examples:"), "{}", ran.out);
    let ran = workspace.line("--version").ends(0);
    assert_eq!((ran.out.trim(), ran.err.as_str()), (format!("polhode {}", env!("CARGO_PKG_VERSION")).as_str(), ""));
    // Fingerprints: of files anywhere, of kinds where there are experiments.
    let version = workspace.line("--version --json").ends(0).json();
    assert_eq!(version["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(version["compiler"], polhode::contract::code::COMPILER);
    let digest = version["files"]["numerics/real.rs"].as_str().expect("a digest");
    assert!(digest.len() == 64 && digest.chars().all(|c| c.is_ascii_hexdigit()), "{digest}");
    let version = Workspace::with(&[ID]).line("--json --version").ends(0).json();
    assert_eq!(version["kinds"]["remark_3_25-picture"].as_str().map(str::len), Some(64), "{}", version["kinds"]);
}

// Streams -------------------------------------------------------------------------------------------------------------

/// The reader of standard output is gone before the command begins: it ends quietly.
#[test]
fn a_closed_pipe_ends_quietly() {
    let workspace = computed();
    for line in [
        "--help",
        "--version",
        "list",
        "list remark_3_25 --json",
        "graph",
        "graph --form dot",
        "figures --json --no-progress",
        "figures --dry-run",
        "show remark_3_25/cusps --csv",
        "check",
        "check --json",
        "why remark_3_25",
        "point spin k=0.8 p_theta=1",
    ] {
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let mut command = workspace.command();
        let child = command.args(line.split(' ')).stdin(Stdio::null()).stdout(writer).stderr(Stdio::piped());
        let output = child.spawn().and_then(std::process::Child::wait_with_output).expect("runs");
        let err = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(0), "{line}: {err}");
        for word in ["panic", "pipe", "defect", "error"] {
            assert!(!err.to_lowercase().contains(word), "{line}: {err}");
        }
    }
}

/// Data to stdout, messages to stderr; no colours or cursor movements where nobody sees them.
#[test]
fn messages_are_plain_when_they_are_not_on_a_terminal() {
    let workspace = Workspace::with(&[ID]);
    let first = workspace.line("figures").ends(0);
    assert_eq!(first.out, "");
    assert!(first.err.contains("ran remark_3_25/cusps"), "{}", first.err);
    workspace.write("figures/remark_3_25.svg", "damaged");
    let repair = workspace.line("figures --no-progress").ends(0);
    assert!(repair.err.contains("repair") && !repair.err.contains("ran "), "{}", repair.err);
    let wrong = workspace.line("figures nothing").ends(2);
    for ran in [first, repair, wrong] {
        assert!(!ran.err.contains('\x1b') && !ran.err.contains('\r'), "{:?}", ran.err);
    }
}

/// On a terminal there are colours and a progress line; `NO_COLOR` and `--no-progress` take them away. `script` gives a terminal.
#[test]
fn no_color_is_honoured_on_a_terminal() {
    let workspace = computed();
    let on_terminal = |line: &str, no_color: &str| {
        let command = format!("{} {line}", env!("CARGO_BIN_EXE_polhode"));
        let mut script = std::process::Command::new("script");
        script.args(["-qec", &command, "/dev/null"]).current_dir(workspace.root()).env("NO_COLOR", no_color);
        let output = script.stdin(Stdio::null()).output().ok()?;
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let Some(coloured) = on_terminal("figures nothing", "") else {
        println!("not tested: there is no `script` here");
        return;
    };
    assert!(coloured.contains("\x1b[1;31m"), "{coloured:?}");
    let plain = on_terminal("figures nothing", "1").expect("runs");
    assert!(plain.contains("nothing") && !plain.contains("\x1b["), "{plain:?}");
    let silent = on_terminal("figures --force --no-progress", "1").expect("runs");
    assert!(silent.contains("nodes") && !silent.contains("\x1b["), "{silent:?}");
}

#[test]
fn json_has_a_schema_and_nothing_else_is_on_stdout() {
    let workspace = computed();
    for line in [
        "figures --json",
        "figures --dry-run --json",
        "check --json",
        "why remark_3_25 --json",
        "why figures/remark_3_25.svg --json",
        "list --json",
        "list remark_3_25 --json",
        "graph --json",
        "graph --form json",
        "point spin k=0.8 p_theta=1 --json",
        "--version --json",
    ] {
        let ran = workspace.line(line).ends(0);
        assert!(ran.json().is_object(), "{line}");
        assert!(ran.out.ends_with("}\n"), "{line}: ends with a line break");
    }
    let listed = workspace.line("list --json").ends(0).json();
    let node = &listed["experiments"][0]["nodes"][1];
    assert_eq!(node["ran"], false, "work from the store: {node}");
    assert!(node["work"]["rows"].as_u64() > Some(0), "{node}");
    let metrics: BTreeSet<String> =
        listed["metrics"].as_array().expect("metrics").iter().map(|m| text(&m["metric"])).collect();
    assert_eq!(metrics, ["serret-andoyer", "spin", "rotation-group"].map(str::to_owned).into());
}

// Why -----------------------------------------------------------------------------------------------------------------

#[test]
fn why_names_the_changed_leaf_with_its_place() {
    let workspace = computed();
    let idle = workspace.line("why remark_3_25").ends(0);
    assert!(idle.out.contains("nothing to do"), "{}", idle.out);
    let fresh = Workspace::with(&[ID]).line("why remark_3_25").ends(6);
    assert!(fresh.out.contains("never run at this address"), "{}", fresh.out);

    workspace.edit(ID, "0.00625", "0.003125");
    let config = workspace.read("experiments/remark_3_25.toml");
    let line = 1 + config.lines().position(|line| line.contains("0.003125")).expect("the line");
    let place = format!("(experiments/remark_3_25.toml:{line}, limit.phi0[6])");
    let ran = workspace.line("why remark_3_25").ends(6);
    assert!(ran.out.contains(&format!("phi0[6]: 0.00625 → 0.003125 {place}")), "{}", ran.out);
    // The picture's and the findings' own leaves have the same place.
    assert!(ran.out.contains(&format!("config.limit.phi0[6]: 0.00625 → 0.003125 {place}")), "{}", ran.out);
    // Only what reads it: the curves do not.
    assert!(!ran.out.contains("remark_3_25/cusps will run"), "{}", ran.out);
    let follows = ran.out.lines().find(|line| line.contains("then may follow")).expect("what follows");
    for node in ["remark_3_25/cusp-limit", "remark_3_25/picture", "remark_3_25/findings"] {
        assert!(follows.contains(node), "{follows}");
    }
    let json = workspace.line("why remark_3_25 --json").ends(6).json();
    let nodes = json["why"]["forecast"]["nodes"].as_array().expect("nodes");
    let node = nodes.iter().find(|node| node["address"] == "remark_3_25/cusps-towards-equator").expect("the node");
    let reason = &node["reasons"][0]["parameter"];
    assert_eq!(
        (&reason["leaf"], &reason["key"], &reason["line"]),
        (&"phi0[6]".into(), &"limit.phi0[6]".into(), &line.into()),
        "{reason}"
    );
    assert_eq!((&reason["old"], &reason["new"]), (&"0.00625".into(), &"0.003125".into()));

    // What `why` says is what a run does.
    let foreseen: BTreeSet<String> =
        nodes.iter().filter(|node| node["prospect"] != "up-to-date").map(|node| text(&node["address"])).collect();
    let ran: BTreeSet<String> =
        Report(workspace.line("figures remark_3_25 --json").ends(0).json()).nodes("ran").into_iter().collect();
    assert!(ran.is_subset(&foreseen), "{ran:?} in {foreseen:?}");
    assert!(ran.contains("remark_3_25/cusp-limit"));
    // Where the bytes of a file come from.
    let origin = workspace.line("why figures/remark_3_25.svg").ends(0);
    assert!(origin.out.contains("remark_3_25.svg holds picture.svg of record"), "{}", origin.out);
}

/// After a run, the values that changed, old → new.
#[test]
fn values_that_changed_are_listed() {
    let workspace = computed();
    workspace.edit(ID, "A = 1.5", "A = 1.6");
    let ran = workspace.line("figures --json").ends(0);
    assert!(ran.err.contains("changed: remark_3_25/t_star: 4.77242… → 5.73574…"), "{}", ran.err);
    let changes = ran.json()["changed_values"].as_array().expect("a list").len();
    assert!(changes >= 5, "{changes}");
    let again = workspace.line("figures --json").ends(0);
    assert!(
        !again.err.contains("changed:") && again.json()["changed_values"] == Value::Array(Vec::new()),
        "{}",
        again.err
    );
}

// Tables and graphs -----------------------------------------------------------------------------------------------------

#[test]
fn show_prints_tables() {
    let workspace = computed();
    let text = workspace.line("show remark_3_25/cusps").ends(0).out;
    for word in ["phi0", "length", "t1", "theta", "rad"] {
        assert!(text.contains(word), "no {word}: {text}");
    }
    let csv = workspace.line("show remark_3_25/cusps --csv").ends(0).out;
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let names = reader.headers().expect("a head").clone();
    assert!(names.iter().any(|name| name == "t1"), "{names:?}");
    let phi0: Vec<f64> = reader.records().map(|row| row.expect("a row")[0].parse().expect("a number")).collect();
    assert_eq!((phi0.len(), phi0[0], phi0[120]), (121, -1.2, 1.2));
    // By its file, of the output folder or elsewhere, the same.
    let file = "figures/data/remark_3_25/cusps.parquet";
    assert_eq!(workspace.line(&format!("show {file} --csv")).ends(0).out, csv);
    std::fs::copy(workspace.path(file), workspace.path("elsewhere.parquet")).expect("copied");
    assert_eq!(workspace.line("show elsewhere.parquet --csv").ends(0).out, csv);
    assert!(workspace.line("show remark_3_25/cusps --rows 3").ends(0).out.lines().count() < text.lines().count());
    // Not computed for these parameters: said, with what to do.
    workspace.edit(ID, "A = 1.5", "A = 1.6");
    let ran = workspace.line("show remark_3_25/cusps").ends(6);
    assert!(ran.err.contains("polhode figures remark_3_25") && ran.out.is_empty(), "{}", ran.err);
    workspace.write("no.parquet", "PAR1");
    let ran = workspace.line("show no.parquet").ends(2);
    assert!(ran.err.contains("no.parquet"), "{}", ran.err);
}

#[test]
fn graphs_in_all_forms_hold_all_nodes() {
    let workspace = computed();
    let nodes = workspace.figures().all_nodes();
    let forms =
        [("text", "remark_3_25/"), ("svg", "<svg "), ("dot", "digraph"), ("mermaid", "flowchart"), ("json", "{")];
    for (form, begin) in forms {
        let graph = workspace.line(&format!("graph --form {form}")).ends(0).out;
        assert!(graph.starts_with(begin), "{form}: {graph}");
        for node in &nodes {
            assert!(graph.contains(node.as_str()), "{form}: no {node}");
        }
    }
    let json = workspace.line("graph --json").ends(0).json();
    assert_eq!(json["nodes"].as_array().map(Vec::len), Some(nodes.len()));
    assert_eq!(workspace.line("graph").ends(0).out, workspace.line("graph --form text").ends(0).out);
}

/// All experiments: few boxes, every node and file named once, lengths that are whole numbers, the same bytes again.
#[test]
fn the_picture_of_the_whole_graph_is_small() {
    let workspace = Workspace::with(&support::all_experiments());
    let svg = workspace.line("graph --format svg").ends(0).out;
    let json = workspace.line("graph --json").ends(0).json();
    let list = |name: &str, key: &str| -> Vec<String> {
        let items = json[name].as_array().expect("a list").iter();
        items.map(|item| item[key].as_str().expect("text").to_owned()).collect()
    };
    let (nodes, files) = (list("nodes", "address"), list("exports", "path"));
    let titles: Vec<&str> = svg.lines().map(|line| line.trim_end_matches("</title>")).collect();
    for name in nodes.iter().chain(&files.iter().map(|file| format!("→ {file}")).collect::<Vec<_>>()) {
        let named = |line: &&&str| line.split("</title>").next().is_some_and(|line| line == name);
        assert_eq!(titles.iter().filter(named).count(), 1, "{name}");
    }
    let boxes = svg.matches(" rx=\"3\"").count();
    assert!(nodes.len() > 150 && 3 * boxes < 2 * nodes.len(), "{} nodes in {boxes} boxes", nodes.len());
    let drawn = svg.split("</style>").nth(1).expect("drawn");
    let lengths = ["x=\"", "y=\"", "width=\"", "height=\"", "d=\"M"].map(|begin| drawn.split(begin).skip(1));
    for length in lengths.into_iter().flatten() {
        assert!(!length.split('"').next().expect("ends").contains('.'), "{length}");
    }
    assert_eq!(workspace.line("graph --form svg").ends(0).out, svg);
}

// Targets and folders ---------------------------------------------------------------------------------------------------

#[test]
fn targets_write_their_files_only() {
    let workspace = Workspace::with(&[ID, "fig4"]);
    workspace.line("figures remark_3_25").ends(0);
    let made: Vec<String> = workspace.files("figures").into_keys().collect();
    let own = ["remark_3_25.svg", "article/config/remark_3_25.toml", "article/pdf/remark_3_25.pdf"];
    let is_own = |path: &String| own.contains(&path.as_str()) || path.starts_with("data/remark_3_25/");
    assert!(made.iter().all(is_own) && made.len() >= 8, "{made:?}");

    let whole = Workspace::with(&[ID, "fig4"]);
    whole.line("figures figures/remark_3_25.svg").ends(0);
    assert_eq!(whole.files("figures").into_keys().collect::<Vec<_>>(), ["remark_3_25.svg"]);
    whole.line("figures remark_3_25/cusps").ends(0);
    assert_eq!(
        whole.files("figures").into_keys().collect::<Vec<_>>(),
        ["data/remark_3_25/cusps.parquet", "remark_3_25.svg"]
    );
}

/// values.toml belongs to the whole: a run for a target leaves it, and says that it is old.
#[test]
fn values_toml_is_reported_when_it_is_old() {
    let workspace = computed();
    let values = workspace.read("figures/values.toml");
    assert!(values.parse::<toml::Table>().expect("TOML")[ID].get("t_star").is_some(), "{values}");
    let ran = workspace.line("figures remark_3_25").ends(0);
    assert!(!ran.err.contains("values.toml"), "{}", ran.err);
    workspace.edit(ID, "A = 1.5", "A = 1.6");
    let ran = workspace.line("figures remark_3_25").ends(0);
    assert!(ran.err.contains("values.toml does not hold the present values of remark_3_25"), "{}", ran.err);
    assert_eq!(workspace.read("figures/values.toml"), values);
    let report = workspace.figures();
    let ran: BTreeSet<String> = report.nodes("ran").into_iter().collect();
    assert_eq!(ran, BTreeSet::from(["article/page".to_owned(), "values/all".to_owned()]), "what belongs to the whole");
    let updated = report.outputs("updated");
    assert!(updated.contains(&"values.toml".to_owned()), "{updated:?}");
    assert!(updated.iter().all(|path| path == "values.toml" || path.starts_with("article/")), "{updated:?}");
}

/// Folders by option, from anywhere; another level of accuracy goes to a folder of its own.
#[test]
fn folders_are_where_the_options_say() {
    let workspace = computed();
    let path = |inside: &str| workspace.path(inside).display().to_string();
    let elsewhere = tempfile::tempdir().expect("a folder");
    let run = |more: &[&str]| -> Ran {
        let mut command = support::polhode();
        command.args([
            "figures",
            "--json",
            "--experiments",
            &path("experiments"),
            "--store",
            &path("other-store"),
            "--out",
            &path("other/out"),
        ]);
        finish(command.args(more).current_dir(&elsewhere)).ends(0)
    };
    run(&[]);
    assert!(workspace.files("other/out") == workspace.files("figures"), "the same bytes in another folder");
    let before = workspace.files("other/out");
    let draft = Report(run(&["--accuracy", "draft"]).json());
    assert!(draft.nodes("ran").contains(&"remark_3_25/cusps-by-integration".to_owned()));
    // Closed forms do not know of accuracies.
    assert!(draft.nodes("cached").contains(&"remark_3_25/cusps".to_owned()), "{draft:?}");
    let (drafts, rest): (Vec<_>, Vec<_>) =
        workspace.files("other/out").into_iter().partition(|(path, _)| path.starts_with("draft/"));
    // The page is made at the article's level alone; an experiment's own PDF and config are made at each.
    let of_page = |path: &&String| {
        path.starts_with("article/") && !path.starts_with("article/pdf/") && !path.starts_with("article/config/")
    };
    assert_eq!(drafts.len(), before.len() - before.keys().filter(of_page).count());
    assert!(rest.into_iter().collect::<BTreeMap<_, _>>() == before);
    assert_eq!(std::fs::read_dir(&elsewhere).expect("a folder").count(), 0);
    // The drafts are no strays.
    assert_eq!(Report(run(&[]).json()).0["report"]["unknown_files"], Value::Array(Vec::new()));
}

#[test]
fn force_computes_all_again_to_the_same_bytes() {
    let workspace = computed();
    let before = workspace.files("figures");
    let report = Report(workspace.line("figures --force --jobs 1 --json").ends(0).json());
    assert_eq!(report.nodes("ran").len(), report.all_nodes().len());
    assert!(workspace.files("figures") == before);
    for node in report.0["report"]["nodes"].as_array().expect("nodes") {
        assert_eq!(node["differs"], Value::Array(Vec::new()), "work that is not reproducible");
    }
}

// Outputs and store -----------------------------------------------------------------------------------------------------

#[test]
fn strays_are_reported_and_kept() {
    let workspace = computed();
    let strays = ["data/remark_3_25/old-table.parquet", "fig4.svg", "notes/mine.txt"];
    for stray in strays {
        workspace.write(&format!("figures/{stray}"), "mine");
    }
    // Measurements and the article page are other verbs' own.
    workspace.write("figures/measured/clock.json", "{}");
    let ran = workspace.line("figures --json").ends(0);
    assert_eq!(ran.json()["report"]["unknown_files"], Value::from(strays.to_vec()));
    for stray in strays {
        assert!(ran.err.contains(stray), "{}", ran.err);
        assert_eq!(workspace.read(&format!("figures/{stray}")), "mine");
    }
    // A run for a target does not look through the folder.
    let ran = workspace.line("figures remark_3_25 --json").ends(0);
    assert_eq!(ran.json()["report"]["unknown_files"], Value::Array(Vec::new()));
}

type Harm = (&'static str, fn(&Path));

const HARMS: [Harm; 3] = [
    ("deleted", |path| std::fs::remove_file(path).expect("removed")),
    ("truncated", |path| harm(path, |bytes| bytes.truncate(bytes.len() / 2))),
    ("flipped", |path| {
        harm(path, |bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 0x10;
        });
    }),
];

fn harm(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).expect("readable");
    change(&mut bytes);
    std::fs::write(path, bytes).expect("written");
}

/// Files of the output folder, damaged in three ways: said, and restored from the store; nothing is computed.
#[test]
fn damaged_outputs_are_repaired() {
    let workspace = computed();
    let good = workspace.files("figures");
    for path in good.keys() {
        for (name, harm) in HARMS {
            harm(&workspace.path("figures").join(path));
            let dry = workspace.line("figures --dry-run").ends(6);
            assert!(dry.out.contains(path.as_str()), "{path} {name}: {}", dry.out);
            let ran = workspace.line("figures --json").ends(0);
            let report = Report(ran.json());
            assert_eq!(report.outputs("repaired"), [path.as_str()], "{name}");
            assert_eq!(report.nodes("ran"), [""; 0], "{path} {name}");
            assert!(ran.err.contains("repair") && ran.err.contains(path.as_str()), "{path} {name}: {}", ran.err);
            assert!(workspace.files("figures") == good, "{path} {name}");
        }
    }
    // All at once.
    std::fs::remove_dir_all(workspace.path("figures")).expect("removed");
    let report = workspace.figures();
    assert_eq!((report.outputs("repaired").len(), report.nodes("ran").len()), (good.len(), 0));
    assert!(workspace.files("figures") == good);
}

/// The same for the store's records and objects: restored from the outputs, or by running again.
#[test]
fn a_damaged_store_is_repaired() {
    let workspace = computed();
    let outputs = workspace.files("figures");
    let good = workspace.files(".polhode/v1");
    let mut cases = 0;
    for path in good.keys().filter(|path| path.starts_with("objects/") || path.starts_with("records/")) {
        for (name, harm) in HARMS {
            harm(&workspace.path(".polhode/v1").join(path));
            let ran = workspace.line("figures --json").ends(0);
            let report = Report(ran.json());
            assert_eq!(report.damage().len(), 1, "{path} {name}: {:?}", report.damage());
            assert!(ran.err.contains("repair"), "{path} {name}: {}", ran.err);
            assert!(workspace.files("figures") == outputs, "{path} {name}");
            assert!(workspace.files(".polhode/v1")[path] == good[path], "{path} {name}: not as it was");
            cases += 1;
        }
    }
    assert!(cases >= 60, "{cases} cases");
    let report = workspace.figures();
    assert_eq!((report.damage().len(), report.nodes("ran").len()), (0, 0));
    // Without any store, all is computed again, to the same bytes.
    std::fs::remove_dir_all(workspace.path(".polhode")).expect("removed");
    let report = workspace.figures();
    assert_eq!(report.nodes("ran").len(), report.all_nodes().len());
    assert!(workspace.files("figures") == outputs);
}

/// An output and its object, both damaged: the node runs again.
#[test]
fn damage_on_both_sides_is_repaired_by_running() {
    let workspace = computed();
    let good = workspace.files("figures");
    let listed = workspace.figures();
    let exports = listed.0["report"]["exports"].as_array().expect("exports");
    let picture = exports.iter().find(|export| export["path"] == "remark_3_25.svg").expect("the picture");
    let object = text(&picture["object"]);
    let objects = workspace.files(".polhode/v1/objects");
    let name = objects
        .keys()
        .find(|name| name.replace('/', "").contains(&object))
        .unwrap_or_else(|| panic!("no object {object}"));
    workspace.write(&format!(".polhode/v1/objects/{name}"), "rotten");
    workspace.write("figures/remark_3_25.svg", "rotten too");
    let report = workspace.figures();
    assert_eq!(report.nodes("ran"), ["remark_3_25/picture"]);
    assert!(workspace.files("figures") == good);
}

/// Two commands on one store at the same time: both end well, and no node is computed twice.
#[test]
fn two_runs_at_once_share_the_work() {
    let workspace = Workspace::with(&[ID]);
    let spawn = |out: &str| {
        let mut command = workspace.command();
        command.args(["figures", "--json", "--no-progress", "--out", out]);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("starts")
    };
    let children = [spawn("one"), spawn("two")];
    let mut ran: Vec<String> = Vec::new();
    let mut nodes = Vec::new();
    for child in children {
        let output = child.wait_with_output().expect("ends");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let report = Report(serde_json::from_slice(&output.stdout).expect("JSON"));
        ran.extend(report.nodes("ran"));
        nodes = report.all_nodes();
    }
    ran.sort();
    nodes.sort();
    assert_eq!(ran, nodes, "each node once");
    assert!(workspace.files("one") == workspace.files("two"));
}

// New -----------------------------------------------------------------------------------------------------------------

/// A module, a config and the word in the list; nothing is overwritten.
#[test]
fn new_writes_a_module_and_its_config() {
    let workspace = Workspace::with(&[ID]);
    let list = std::fs::read_to_string(repository().join("src/experiments/mod.rs")).expect("the list");
    workspace.write("src/experiments/mod.rs", &list);
    workspace.line("new fig10").ends(0);
    let config = workspace.read("experiments/fig10.toml");
    assert_eq!(config.parse::<toml::Table>().expect("TOML")["kind"].as_str(), Some("fig10"), "{config}");
    assert!(config.contains('#'), "commented: {config}");
    let module = workspace.read("src/experiments/fig10.rs");
    assert!(
        module.starts_with("//!") && module.contains("\"fig10\"") && !module.to_lowercase().contains("template"),
        "{module}"
    );
    let names = workspace.read("src/experiments/mod.rs");
    assert!(names.contains(" fig10 }") || names.contains(" fig10\n"), "{names}");
    assert_eq!(
        names.replace("fig10", "").split_whitespace().collect::<Vec<_>>(),
        list.split_whitespace().collect::<Vec<_>>()
    );
    let before = workspace.files("");
    for id in ["fig10", "remark_3_25", "9lives", "Fig11", "a-b", "../x"] {
        workspace.line(&format!("new {id}")).ends(2);
        assert!(workspace.files("") == before, "{id}");
    }
}
