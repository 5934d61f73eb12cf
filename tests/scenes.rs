//! Scenes: every effect of every metric, in configs of kind `scene` and in every figure. What is added adds nodes, a curve and work; what is removed
//! takes them away; equal work is one node.

#![expect(clippy::panic, clippy::expect_used, reason = "helpers of tests")]

mod support;

use polhode::cli::arguments::SCENES;
use polhode::effects::scene::{Effect, METRICS, supported};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use support::{Workspace, repository, text};

/// The experiments of the article: their metric, and the effects of their own beside those of the metric.
const FIGURES: [(&str, &str); 11] = [
    ("fig1", "serret-andoyer"),
    ("fig2", "serret-andoyer"),
    ("theorem_3_9", "serret-andoyer"),
    ("remark_3_25", "serret-andoyer"),
    ("fig3", "serret-andoyer"),
    ("fig4", "spin"),
    ("fig5", "spin"),
    ("fig6", "spin"),
    ("fig7", "spin"),
    ("fig8", "spin"),
    ("fig9", "rotation-group"),
];

/// The layer of the picture that an effect of a metric draws. (The potentials' zone: without constants asked for there is no other curve of their own.)
fn role(metric: &str, effect: &str) -> &'static str {
    match (metric, effect) {
        ("serret-andoyer", "geodesics") => "separatrix",
        ("spin", "geodesics") => "geodesic",
        (_, "conjugate-locus") => "conjugate-locus",
        (_, "cut-locus") => "cut-locus",
        (_, "wave-front") => "wave-front",
        (_, "curvature") => "curvature",
        (_, "potential") => "oscillation-zone",
        (_, "period") => "period",
        (_, "attitude") => "theta",
        (_, "conjugate-times") => "second-conjugate-point",
        (_, "projection") => "series-a",
        _ => panic!("no role for {effect} of {metric}"),
    }
}

fn names(effects: &[Effect]) -> Vec<String> {
    effects.iter().map(|effect| effect.name().to_owned()).collect()
}

/// The line `effects = [...]` of a config and the names in it.
fn effects_of(config: &str) -> (String, Vec<String>) {
    let line = config.lines().find(|line| line.starts_with("effects = ")).expect("a line of effects");
    (line.to_owned(), line.split('"').skip(1).step_by(2).map(str::to_owned).collect())
}

/// The config with other effects.
fn with_effects(config: &str, effects: &[String]) -> String {
    let list: Vec<String> = effects.iter().map(|effect| format!("{effect:?}")).collect();
    config.replacen(&effects_of(config).0, &format!("effects = [{}]", list.join(", ")), 1)
}

fn without(effects: &[String], left_out: &str) -> Vec<String> {
    effects.iter().filter(|effect| *effect != left_out).cloned().collect()
}

/// An id for a case: `fig7_without_cut_locus`.
fn id(parts: &[&str]) -> String {
    parts.join("_").replace('-', "_")
}

/// What one experiment came to.
#[derive(Default)]
struct Made {
    /// Its compute nodes, without the experiment's id.
    nodes: BTreeSet<String>,
    /// Everything that they counted, added up.
    work: u64,
    /// How many layers of each role its picture has.
    layers: BTreeMap<String, usize>,
}

impl Made {
    fn layer(&self, role: &str) -> usize {
        self.layers.get(role).copied().unwrap_or(0)
    }

    fn all_layers(&self) -> usize {
        self.layers.values().sum()
    }
}

fn counted(work: &Value) -> u64 {
    let counts = work.as_object().into_iter().flatten().filter(|(name, _)| *name != "state_dimension");
    counts.filter_map(|(_, count)| count.as_u64()).sum()
}

fn layers(svg: &str) -> BTreeMap<String, usize> {
    let mut layers = BTreeMap::new();
    for piece in svg.split("data-role=\"").skip(1) {
        let role = piece.split('"').next().unwrap_or_default();
        *layers.entry(role.to_owned()).or_insert(0) += 1;
    }
    layers
}

/// Runs these configs in one folder: equal work of all of them is done once.
fn made(configs: &BTreeMap<String, String>) -> BTreeMap<String, Made> {
    let workspace = Workspace::with::<&str>(&[]);
    configs.iter().for_each(|(id, config)| workspace.write(&format!("experiments/{id}.toml"), config));
    let ran = workspace.line("figures --json");
    assert_eq!(ran.code, 0, "{}", ran.err);
    let report = ran.json();
    let mut made: BTreeMap<String, Made> = BTreeMap::new();
    for node in report["report"]["nodes"].as_array().expect("nodes") {
        let address = text(&node["address"]);
        let (id, name) = address.split_once('/').expect("an address");
        if configs.contains_key(id) && !["picture", "findings"].contains(&name) {
            let one = made.entry(id.to_owned()).or_default();
            one.nodes.insert(name.to_owned());
            one.work += counted(&node["work"]);
        }
    }
    for (id, one) in &mut made {
        one.layers = layers(&workspace.read(&format!("figures/{id}.svg")));
    }
    made
}

/// More effects ask for all the nodes that fewer ask for, and others; they count more, and the role has more layers.
fn assert_adds(case: &str, fewer: &Made, more: &Made, role: Option<&str>) {
    assert!(fewer.nodes.is_subset(&more.nodes), "{case}: {:?} besides {:?}", fewer.nodes, more.nodes);
    assert!(more.nodes.len() > fewer.nodes.len(), "{case}: no node more than {:?}", fewer.nodes);
    assert!(more.work > fewer.work, "{case}: {} counted, with fewer effects {}", more.work, fewer.work);
    if let Some(role) = role {
        assert!(more.layer(role) > fewer.layer(role), "{case}: layers {role}: {:?}", more.layers);
    }
}

#[test]
fn a_scene_has_what_its_effects_ask_for() {
    let mut configs = BTreeMap::new();
    for (metric, config) in SCENES {
        let all = effects_of(config).1;
        assert_eq!(
            all.iter().collect::<BTreeSet<_>>(),
            names(supported(metric)).iter().collect(),
            "the first config has every effect of {metric}"
        );
        configs.insert(id(&[metric, "all"]), config.to_owned());
        for effect in &all {
            configs.insert(id(&[metric, "without", effect]), with_effects(config, &without(&all, effect)));
            configs.insert(id(&[metric, "only", effect]), with_effects(config, std::slice::from_ref(effect)));
        }
    }
    let made = made(&configs);
    for (metric, effects) in METRICS {
        let all = &made[&id(&[metric, "all"])];
        for effect in names(effects) {
            let role = role(metric, &effect);
            let fewer = &made[&id(&[metric, "without", &effect])];
            assert_adds(&format!("{metric} without {effect}"), fewer, all, Some(role));
            let only = &made[&id(&[metric, "only", &effect])];
            assert!(only.layer(role) > 0, "{metric}, {effect} alone: {:?}", only.layers);
            assert!(!only.nodes.is_empty() && only.nodes.is_subset(&all.nodes), "{:?}", only.nodes);
            // Alone and left out, an effect's nodes make up the whole.
            let union: BTreeSet<&String> = only.nodes.union(&fewer.nodes).collect();
            assert_eq!(union, all.nodes.iter().collect(), "{metric}, {effect}");
        }
    }
}

#[test]
fn every_figure_takes_every_effect_of_its_metric() {
    let mut configs = BTreeMap::new();
    let mut cases = Vec::new();
    for (figure, metric) in FIGURES {
        let config =
            std::fs::read_to_string(repository().join(format!("experiments/{figure}.toml"))).expect("a config");
        let own = effects_of(&config).1;
        let further: Vec<String> = names(supported(metric)).into_iter().filter(|e| !own.contains(e)).collect();
        let all = [own.as_slice(), &further].concat();
        configs.insert(id(&[figure, "all"]), with_effects(&config, &all));
        configs.insert(figure.to_owned(), config.clone());
        for effect in &further {
            configs.insert(
                id(&[figure, "with", effect]),
                with_effects(&config, &[own.as_slice(), std::slice::from_ref(effect)].concat()),
            );
        }
        for effect in &all {
            configs.insert(id(&[figure, "without", effect]), with_effects(&config, &without(&all, effect)));
        }
        cases.push((figure, metric, own, further));
    }
    let made = made(&configs);
    for (figure, metric, own, further) in &cases {
        let (plain, all) = (&made[*figure], &made[&id(&[figure, "all"])]);
        for effect in further {
            let role = role(metric, effect);
            assert_adds(&format!("{figure} with {effect}"), plain, &made[&id(&[figure, "with", effect])], Some(role));
            assert_adds(
                &format!("{figure} without {effect}"),
                &made[&id(&[figure, "without", effect])],
                all,
                Some(role),
            );
        }
        for effect in own {
            let fewer = &made[&id(&[figure, "without", effect])];
            assert_adds(&format!("{figure} without {effect}"), fewer, all, None);
            // The types of Fig. 6 are the words at its trajectories, which are those of another effect.
            let is_drawn = effect != "trajectory-types";
            assert!(!is_drawn || all.all_layers() > fewer.all_layers(), "{figure} without {effect}: no layer less");
        }
        // The figure as it is committed is not touched by what it could show besides.
        let committed = std::fs::read_to_string(repository().join(format!("figures/{figure}.svg"))).expect("committed");
        assert_eq!(plain.layers, layers(&committed), "{figure}");
    }
}

/// k = 0.8 of the first spin scene is k = 0.8 of Fig. 7: one node each, whoever asks.
#[test]
fn a_scene_shares_its_nodes_with_the_figures() {
    let workspace = Workspace::with(&["fig7", "fig3"]);
    workspace.line("new --scene spins").ends(0);
    workspace.line("new --scene body --metric serret-andoyer").ends(0);
    workspace.edit("body", "phi0 = -0.5", "phi0 = -0.75");
    let keys: BTreeMap<String, String> = {
        let list = workspace.line("list --json").ends(0).json();
        let nodes = list["experiments"].as_array().expect("experiments").iter();
        let nodes = nodes.flat_map(|experiment| experiment["nodes"].as_array().expect("nodes"));
        nodes.filter(|node| node["key"].is_string()).map(|node| (text(&node["address"]), text(&node["key"]))).collect()
    };
    for (scene, figure, node) in [
        ("spins", "fig7", "conjugate-locus/k=0.8"),
        ("spins", "fig7", "geodesics/k=0.8"),
        ("body", "fig3", "conjugate-locus/phi0=-0.75"),
        ("body", "fig3", "cut-locus/phi0=-0.75"),
        ("body", "fig3", "wave-front/phi0=-0.75/t=5.5"),
    ] {
        assert_eq!(keys[&format!("{scene}/{node}")], keys[&format!("{figure}/{node}")], "{node}");
    }
    let report = workspace.figures();
    let shared = report.nodes("same-as");
    for node in ["conjugate-locus/k=0.8", "conjugate-locus-by-integration/k=0.8", "geodesics/k=0.8"] {
        let of = |id: &str| shared.contains(&format!("{id}/{node}"));
        assert!(of("spins") != of("fig7"), "{node} is computed once: {shared:?}");
    }
}

/// In a folder that `init` made, without any source.
#[test]
fn a_new_scene_is_ready_to_run() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.line("init paper").ends(0);
    std::fs::remove_dir_all(workspace.path("paper/experiments")).expect("removed");
    workspace.write("paper/experiments/README", "scenes");
    let inside = |line: &str| {
        let mut command = support::polhode();
        support::finish(command.current_dir(workspace.path("paper")).args(line.split_whitespace()))
    };
    for (metric, _) in SCENES {
        let id = id(&["my", metric]);
        let wrote = inside(&format!("new --scene {id} --metric {metric}")).ends(0);
        assert!(wrote.err.contains(&format!("polhode figures {id}")), "{}", wrote.err);
        let config = workspace.read(&format!("paper/experiments/{id}.toml"));
        assert!(config.contains(&format!("polhode figures {id}`")) && config.contains(&format!("metric.{metric} = ")));
        inside(&format!("new --scene {id} --metric {metric}")).ends(2);
        assert_eq!(workspace.read(&format!("paper/experiments/{id}.toml")), config, "not written over");
    }
    inside("new --scene plain").ends(0);
    assert!(workspace.read("paper/experiments/plain.toml").contains("metric.spin = "), "the default");
    inside("figures --no-progress").ends(0);
    inside("check").ends(0);
    assert!(!workspace.path("paper/src").exists());
    for wrong in [
        "new --scene Wrong",
        "new --scene 1st",
        "new --scene a-b",
        "new --scene x --metric sphere",
        "new x --metric spin",
    ] {
        let ran = inside(wrong).ends(2);
        assert!(!ran.err.is_empty(), "{wrong}");
    }
    assert!(!workspace.path("paper/experiments/x.toml").exists());
    let overview = inside("list").ends(0).out;
    for (metric, effects) in METRICS {
        let line =
            overview.lines().find(|line| line.trim_start().starts_with(metric)).unwrap_or_else(|| panic!("{overview}"));
        assert!(effects.iter().all(|effect| line.contains(effect.name())), "{line}");
    }
}

/// The example of the design, to the letter; a sweep of as many values as one likes; one value.
#[test]
fn starts_and_sweeps_may_be_lists_ranges_or_numbers() {
    let example = r#"
kind = "scene"
[scene]
metric.spin = { k = [0.8, 0.5] }                 # a list, or { from = 0.5, to = 1.5, count = 101, spacing = "lin" }: one node a value
start       = { p_theta = { from = 1e-4, to = 50, count = 400, spacing = "log" } }   # inside a node: its rows
effects     = ["geodesics", "conjugate-locus", "cut-locus", "wave-front"]
accuracy    = "article"
"#;
    let cut_only =
        example.replace("\"geodesics\", \"conjugate-locus\", \"cut-locus\", \"wave-front\"", "\"cut-locus\"");
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("experiments/example.toml", example);
    let sweep = cut_only.replace("[0.8, 0.5]", "{ from = 0.5, to = 1.5, count = 101, spacing = \"lin\" }");
    workspace.write("experiments/sweep.toml", sweep.replace("count = 400", "count = 20"));
    workspace.write(
        "experiments/one.toml",
        example
            .replace("[0.8, 0.5]", "1.2")
            .replace("{ from = 1e-4, to = 50, count = 400, spacing = \"log\" }", "[0, 0.5, 2, 8]"),
    );
    let report = workspace.figures();
    let nodes = report.all_nodes();
    assert_eq!(nodes.iter().filter(|node| node.starts_with("sweep/cut-locus/")).count(), 101);
    assert_eq!(layers(&workspace.read("figures/sweep.svg"))["cut-locus"], 12 + 1, "twelve panels and the legend");
    let shown = workspace.line("show example/conjugate-locus/k=0.8 --json");
    let rows = if shown.code == 0 { shown.json()["rows"].as_u64() } else { None };
    assert!(rows.is_none_or(|rows| rows == 400), "{rows:?}");
    let values = workspace.read("figures/values.toml");
    assert!(values.contains("points_conjugate_locus_k=0.8"), "{values}");
    workspace.line("check").ends(0);
}

/// File, line and key of what is wrong, and nothing written.
#[test]
fn a_wrong_scene_is_refused_with_its_place() {
    let config =
        |metric: &str| SCENES.iter().find(|(name, _)| *name == metric).map(|(_, text)| *text).expect("a metric");
    let start = "{ from = 1e-9, to = 1e4, step = 0.1 }";
    for (metric, from, to, key) in [
        ("spin", "k = [0.8, 0.5]", "k = [0.8, -0.5]", "scene.metric.spin.k[1]"),
        ("spin", "k = [0.8, 0.5]", "k = [0.8, 4.0]", "scene.metric.spin.k[1]"),
        ("spin", "metric.spin", "metric.spim", "scene.metric.spim"),
        (
            "spin",
            "metric.spin = { k = [0.8, 0.5] }",
            "metric.rotation-group = { A = 1.0, B = 2.0, C = 3.0 }",
            "scene.start.p_theta",
        ),
        ("spin", start, "{ from = 1e-9, to = 1e4, step = 0.1, count = 3 }", "scene.start.p_theta"),
        ("spin", start, "{ from = 1e-9, to = 1e4, stap = 0.1 }", "scene.start.p_theta.stap"),
        ("spin", start, "[0.5, 0.2]", "scene.start.p_theta"),
        ("spin", start, "[-0.5, 0.2]", "scene.start.p_theta[0]"),
        ("spin", "start = { p_theta", "start = { phi0 = 0.1, p_theta", "scene.start.phi0"),
        ("spin", "\"cut-locus\"", "\"attitude\"", "scene.effects[2]"),
        ("spin", "\"cut-locus\"", "\"conjugate-locus\"", "scene.effects[2]"),
        ("spin", "\"cut-locus\"", "\"cut-lokus\"", "scene.effects[2]"),
        ("spin", "t = [1.0, 2.0, 3.0]", "t = [1.0, 0.0]", "wave_front.t[1]"),
        ("spin", "count = 15", "count = 0", "trajectories.count"),
        ("spin", "count = 15", "cuont = 15", "trajectories.cuont"),
        ("serret-andoyer", "phi0 = -0.5", "phi0 = -1.6", "scene.start.phi0"),
        ("serret-andoyer", "phi0 = -0.5, ", "", "scene.start"),
        ("serret-andoyer", "0.76]", "0.96]", "scene.start.p_theta[4]"),
        ("serret-andoyer", "B = 2.0", "B = 1.0", "scene.metric.serret-andoyer.B"),
        ("serret-andoyer", "turns = 3.5", "turns = -1.0", "picture.turns"),
        ("serret-andoyer", "turns = 3.5", "t_end = 3.5", "picture.t_end"),
        ("rotation-group", "2.8506", "0.0", "scene.start.cases[0].Phi[1]"),
        ("rotation-group", "\"projection\"]", "\"wave-front\"]", "scene.effects[2]"),
        ("rotation-group", "points = 161", "points = 1", "picture.points"),
    ] {
        let good = config(metric);
        // The last occurrence: comments come first.
        let (before, after) = good.rsplit_once(from).unwrap_or_else(|| panic!("{from}"));
        let bad = format!("{before}{to}{after}");
        let workspace = Workspace::with::<&str>(&[]);
        workspace.write("experiments/mine.toml", &bad);
        let ran = workspace.line("figures").ends(3);
        let line = good.lines().zip(bad.lines()).position(|(good, bad)| good != bad).expect("a line") + 1;
        let said = format!("{to}: {}", ran.err);
        assert!(ran.err.contains(&format!("= key: {key}\n")), "{key} in {said}");
        assert!(ran.err.contains("experiments/mine.toml:"), "{said}");
        // An unknown or another metric is told where its starts or its name stand.
        if !to.contains("rotation-group") {
            assert!(ran.err.contains(&format!("experiments/mine.toml:{line}:")), "line {line} in {said}");
        }
        assert_eq!(workspace.files("").keys().collect::<Vec<_>>(), ["experiments/mine.toml"], "{said}");
    }
}
