//! Wrong configs: exit code 3, a message that says what to change and where, and nothing is written.

#![expect(clippy::panic, reason = "helpers of tests")]

mod support;

use std::collections::BTreeMap;
use std::sync::OnceLock;
use support::{Shared, Workspace};

const SERRET_ANDOYER: &str = "remark_3_25";
const SPIN: &str = "fig4";

const K: &str = "k = { from = 1.0, to = 1.5, count = 201 }";

/// A config, the text in it that becomes another and makes it wrong, and what the message must say: the key, and in what is found,
/// accepted and nearest these words (an empty nearest: there is none).
type Case = (&'static str, [&'static str; 2], [&'static str; 4]);

const CASES: &[Case] = &[
    // A misspelt key, at each depth.
    (SERRET_ANDOYER, ["effects =", "efects ="], ["scene.efects", "`efects`", "`effects`", "effects"]),
    (SERRET_ANDOYER, ["[limit]", "[limits]"], ["limits", "`limits`", "`limit`", "limit"]),
    (SPIN, ["metric.spin", "metric.spim"], ["scene.metric.spim", "`spim`", "`spin`", "spin"]),
    (SPIN, ["count = 201", "cont = 201"], ["scene.metric.spin.k.cont", "`cont`", "`count`", "count"]),
    (SPIN, ["kind =", "knd ="], ["kind", "`knd`", "kind =", "kind"]),
    // A wrong type.
    (SERRET_ANDOYER, ["A = 1.5", "A = \"1.5\""], ["scene.metric.serret-andoyer.A", "\"1.5\"", "a number", ""]),
    (SPIN, [K, "k = true"], ["scene.metric.spin.k", "true", "number", ""]),
    (SPIN, ["count = 201", "count = 20.5"], ["scene.metric.spin.k.count", "20.5", "a whole number", ""]),
    // Values out of range: A > B, A = B, A < 0, a start outside the strip, k = 0, k < 0, a range that falls.
    (SERRET_ANDOYER, ["A = 1.5", "A = 2.5"], ["scene.metric.serret-andoyer.B", "2", "above A = 2.5", ""]),
    (SERRET_ANDOYER, ["A = 1.5", "A = 2.0"], ["scene.metric.serret-andoyer.B", "2", "A < B < C", ""]),
    (SERRET_ANDOYER, ["A = 1.5", "A = -1.5"], ["scene.metric.serret-andoyer.A", "-1.5", "above 0", ""]),
    (SERRET_ANDOYER, ["to = 1.2", "to = 1.7"], ["scene.start.phi0.to", "1.7", "|phi0| <", ""]),
    (SPIN, [K, "k = 0.0"], ["scene.metric.spin.k", "0", "k > 0", ""]),
    (SPIN, [K, "k = [\n  1.1,\n  -0.5,\n]"], ["scene.metric.spin.k[1]", "-0.5", "k > 0", ""]),
    (SPIN, ["from = 1.0, to", "from = 2.5, to"], ["scene.metric.spin.k.to", "1.5", "2.5", ""]),
    // Numbers that are none.
    (SPIN, [K, "k = [1.1, nan]"], ["scene.metric.spin.k[1]", "nan", "a finite number", ""]),
    (SPIN, ["p_theta = 1e-4", "p_theta = -inf"], ["scene.start.p_theta", "-inf", "a finite number", ""]),
    (SERRET_ANDOYER, ["C = 2.8", "C = 1e999"], ["scene.metric.serret-andoyer.C", "1e999", "a finite number", ""]),
    // Empty lists.
    (SPIN, [K, "k = []"], ["scene.metric.spin.k", "[]", "at least one value", ""]),
    (SERRET_ANDOYER, ["[\"conjugate-locus\"]", "[]"], ["scene.effects", "[]", "conjugate-locus", ""]),
    // Names that there are not, or not here.
    (SPIN, ["kind = \"fig4\"", "kind = \"fog4\""], ["kind", "\"fog4\"", "remark_3_25", "fig4"]),
    (
        SPIN,
        ["\"switch-points\"]", "\"swich-points\"]"],
        ["scene.effects[1]", "`swich-points`", "`switch-points`", "switch-points"],
    ),
    (
        SERRET_ANDOYER,
        ["[\"conjugate-locus\"]", "[\"attitude\"]"],
        ["scene.effects[0]", "attitude", "conjugate-locus", ""],
    ),
    (SPIN, ["accuracy = \"article\"", "accuracy = \"articel\""], ["scene.accuracy", "articel", "article", ""]),
    // A key that is missing, and no TOML at all.
    (SERRET_ANDOYER, [", C = 2.8", ""], ["scene.metric.serret-andoyer.C", "", "C", ""]),
    (SPIN, ["[scene]", "[scene"], ["", "", "", ""]),
];

/// Both experiments, up to date.
fn computed() -> Workspace {
    static COMPUTED: OnceLock<Shared> = OnceLock::new();
    let shared = COMPUTED.get_or_init(|| Shared::computed("bad-configs", &[SERRET_ANDOYER, SPIN]));
    let workspace = shared.workspace.copy();
    workspace.figures();
    workspace
}

/// Everything but the configs, with its bytes.
fn written(workspace: &Workspace) -> BTreeMap<String, Vec<u8>> {
    let mut files = workspace.files("");
    files.retain(|path, _| !path.starts_with("experiments"));
    assert!(files.keys().any(|path| path.starts_with(".polhode")) && files.keys().any(|path| path.ends_with(".svg")));
    files
}

/// The value of a line such as `  = found: 2` of a message.
fn field<'a>(message: &'a str, name: &str) -> &'a str {
    let line = message.lines().find_map(|line| line.trim_start().strip_prefix(&format!("= {name}: ")));
    line.unwrap_or("")
}

/// The number of the line that is wrong: the first from where the texts differ that holds what is found.
fn line_of(good: &str, bad: &str, found: &str) -> usize {
    let same = good.lines().zip(bad.lines()).take_while(|(good, bad)| good == bad).count();
    let holds = |line: &str| line.contains(found.trim_matches('`'));
    same + bad.lines().skip(same).position(holds).unwrap_or_else(|| panic!("no {found} in\n{bad}")) + 1
}

#[test]
fn a_wrong_config_is_refused_with_what_to_change() {
    let workspace = computed();
    let before = written(&workspace);
    for (id, [from, to], [key, found, accepted, nearest]) in CASES {
        let good = workspace.read(&format!("experiments/{id}.toml"));
        workspace.edit(id, from, to);
        let text = workspace.read(&format!("experiments/{id}.toml"));
        let line = line_of(&good, &text, found);
        let ran = workspace.line("figures").ends(3);
        let case = format!("{to:?}:\n{}", ran.err);
        assert_eq!(ran.out, "", "{case}");
        assert!(ran.err.contains(&format!("experiments/{id}.toml:{line}:")), "line {line}; {case}");
        assert_eq!(field(&ran.err, "key"), *key, "{case}");
        assert!(field(&ran.err, "found").contains(found), "{case}");
        // Some values say what they accept in the first line.
        let says = [field(&ran.err, "accepted"), ran.err.lines().next().unwrap_or_default()];
        assert!(says.iter().any(|line| line.contains(accepted)), "{case}");
        let next = field(&ran.err, "next");
        if nearest.is_empty() {
            assert!(next.starts_with("correct "), "{case}");
        } else {
            assert_eq!(next, format!("did you mean `{nearest}`?"), "{case}");
        }
        // The line itself, with a mark under the place.
        assert!(ran.err.contains(text.lines().nth(line - 1).expect("the line")) && ran.err.contains('^'), "{case}");
        assert!(written(&workspace) == before, "something was written; {case}");
        workspace.write(&format!("experiments/{id}.toml"), good);
    }
    assert_eq!(workspace.figures().nodes("ran"), [""; 0], "all is as it was");
}

/// All verbs that read configs refuse them in the same way, and write nothing.
#[test]
fn every_verb_refuses_a_wrong_config() {
    let workspace = computed();
    workspace.edit(SPIN, K, "k = -1");
    let before = written(&workspace);
    for verb in [
        "figures",
        "figures --dry-run",
        "figures --force",
        "figures --json",
        "check",
        "check --strict --json",
        "why fig4",
        "why values.toml",
        "list",
        "list --json",
        "graph",
        "show fig4/conjugate-point-versus-k",
    ] {
        let ran = workspace.line(verb).ends(3);
        assert!(ran.err.contains("scene.metric.spin.k") && ran.out.is_empty(), "{verb}: {}", ran.err);
        assert!(written(&workspace) == before, "{verb} wrote something");
    }
}

/// Only the configs that the targets need are judged.
#[test]
fn only_the_targets_configs_are_judged() {
    let workspace = computed();
    workspace.edit(SPIN, K, "k = -1");
    for line in [
        "figures remark_3_25",
        "figures figures/remark_3_25.svg",
        "figures remark_3_25/cusps",
        "check remark_3_25",
        "why remark_3_25",
        "list remark_3_25",
        "graph remark_3_25",
        "show remark_3_25/cusps",
    ] {
        workspace.line(line).ends(0);
    }
    // values.toml belongs to the whole.
    for line in ["figures", "figures fig4", "figures figures/values.toml", "figures remark_3_25 fig4"] {
        workspace.line(line).ends(3);
    }
    // A config that is no experiment yet is in nobody's way either.
    workspace.write("experiments/fig99.toml", "kind = \"fig99\"\n");
    workspace.line("figures remark_3_25").ends(0);
}

/// Several wrong configs are told in one go.
#[test]
fn all_wrong_configs_are_told_at_once() {
    let workspace = computed();
    workspace.edit(SPIN, K, "k = -1");
    workspace.edit(SERRET_ANDOYER, "A = 1.5", "A = 3");
    workspace.write("experiments/fig99.toml", "kind = \"fig99\"\n");
    let ran = workspace.line("figures").ends(3);
    for place in ["experiments/fig4.toml:7:", "experiments/remark_3_25.toml:6:", "experiments/fig99.toml:1:"] {
        assert!(ran.err.contains(place), "{place}: {}", ran.err);
    }
}

/// A fresh folder: nothing is made at all.
#[test]
fn nothing_is_made_in_a_fresh_folder() {
    let workspace = Workspace::with(&[SPIN]);
    workspace.edit(SPIN, K, "k = nan");
    workspace.line("figures").ends(3);
    assert_eq!(workspace.files("").keys().collect::<Vec<_>>(), ["experiments/fig4.toml"]);
    assert!(!workspace.path("figures").exists() && !workspace.path(".polhode").exists());
}
