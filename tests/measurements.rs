//! Measurements: only when asked for, apart from everything that is committed or compared, and once on a machine.

mod support;

use polhode::table::Table;
use support::{Report, Workspace, files};

const ID: &str = "cost_of_effects";
const TABLES: [&str; 3] = ["time-rotation-group", "time-serret-andoyer", "time-spin"];

/// A folder with the experiment, few starts, little accuracy.
fn workspace() -> Workspace {
    let workspace = Workspace::with(&[ID]);
    workspace.edit(ID, "accuracies = [1e-6, 1e-9, 1e-12, \"article\"]", "accuracies = [1e-6, 1e-9]");
    workspace.edit(ID, "count = 40, spacing", "count = 4, spacing");
    workspace.edit(ID, "count = 40 }", "count = 4 }");
    workspace.edit(ID, "directions = 40", "directions = 4");
    workspace.edit(ID, "repetitions = 25", "repetitions = 3");
    workspace
}

fn measured(workspace: &Workspace, more: &str) -> Report {
    Report(workspace.line(&format!("figures --measure --json {more}")).ends(0).json())
}

fn is_measurement(node: &str) -> bool {
    node.contains("/time-") || node.ends_with("measured-picture")
}

#[test]
fn without_being_asked_nothing_is_measured() {
    let workspace = workspace();
    let ran = workspace.line("figures --json").ends(0);
    assert!(ran.err.contains("times not measured here: polhode figures cost_of_effects --measure"), "{}", ran.err);
    let report = Report(ran.json());
    assert!(!report.all_nodes().iter().any(|node| is_measurement(node)), "{:?}", report.all_nodes());
    assert!(!workspace.path("figures/measured").exists());
    let graph = workspace.line("graph --form json").ends(0).json();
    let kinds = graph["nodes"].as_array().expect("nodes");
    assert!(kinds.iter().all(|node| node["measurement"] == false), "{graph}");
    for line in ["figures figures/measured/cost_of_effects.svg", "why measured/cost_of_effects/time-spin.parquet"] {
        let refused = workspace.line(line).ends(2);
        assert!(refused.err.contains("is a measurement") && refused.err.contains("--measure"), "{}", refused.err);
    }
    for verb in ["list", "check", "why cost_of_effects"] {
        assert!(!workspace.line(verb).out.contains("time-spin"), "{verb}");
    }
}

#[test]
fn measurements_stand_apart_and_are_made_once() {
    let workspace = workspace();
    let before = workspace.figures();
    assert!(!before.nodes("ran").is_empty());
    let committed = || {
        let mut all = files(&workspace.path("figures"));
        all.retain(|path, _| !path.starts_with("measured/"));
        all
    };
    let plain = committed();

    let first = measured(&workspace, "");
    let ran = first.nodes("ran");
    let expected: Vec<String> = ["measured-picture"].iter().chain(&TABLES).map(|node| format!("{ID}/{node}")).collect();
    assert_eq!(ran, expected, "measurements and nothing else");
    assert_eq!(committed(), plain, "what is committed has the bytes it had");
    let made = || files(&workspace.path("figures/measured"));
    let names: Vec<String> = made().into_keys().collect();
    let tables = TABLES.map(|name| format!("{ID}/{name}.parquet"));
    assert_eq!(names, [&[format!("{ID}.svg")], tables.as_slice()].concat());
    let here = polhode::effects::cost_of_effects::machine::describe();
    let table = Table::from_parquet(&made()[&format!("{ID}/time-spin.parquet")]).expect("a table");
    assert!(table.texts("machine").expect("a machine").iter().all(|machine| *machine == here));
    assert!(table.f64s("microseconds").expect("times").iter().all(|time| *time > 0.0));
    assert!(String::from_utf8_lossy(&made()[&format!("{ID}.svg")]).contains(&here), "the caption names the machine");

    // A run without them says where the last ones are, touches none, and reports no foreign file.
    let times = made();
    let plain_again = workspace.line("figures --json").ends(0);
    assert!(plain_again.err.contains("times as last measured: "), "{}", plain_again.err);
    let report = Report(plain_again.json());
    assert!(
        report.nodes("ran").is_empty() && report.0["report"]["unknown_files"].as_array().expect("files").is_empty()
    );
    assert_eq!(made(), times);
    assert_eq!(committed(), plain);

    // Asked again on the same machine, they stand; with --force they are made again, and differing is no fault of theirs.
    let second = measured(&workspace, "");
    assert!(second.nodes("ran").is_empty(), "{:?}", second.nodes("ran"));
    let forced = measured(&workspace, "--force measured/cost_of_effects.svg");
    assert!(forced.nodes("ran").iter().any(|node| node.ends_with("/time-spin")), "{:?}", forced.nodes("ran"));
    for node in forced.0["report"]["nodes"].as_array().expect("nodes") {
        assert!(node["differs"].as_array().is_none_or(Vec::is_empty), "{node}");
    }
    assert_eq!(committed(), plain);

    // Neither the sample that is computed again nor the claims look at them.
    let verified = workspace.line("verify --sample 100").ends(0);
    assert!(!format!("{}{}", verified.out, verified.err).contains("/time-"), "{}", verified.out);
}
