//! Accuracy levels through the whole program: points in double-double against independent digits, a scene at every level, `polhode accuracy`.
//!
//! Oracles: `tests/oracle/spin_extra.json` and `serret_andoyer_extra.json` (20 digits and more, for inputs that are `f64` numbers), and section 5.3's case 1 in
//! `rotation_group_conjugate_times.json`; `tests/oracle/README.md` says how they were made.

#![expect(clippy::panic, reason = "helpers of tests")]

mod support;

use polhode::effects::point::{Answer, Given, Inputs, Metric, answer, answers};
use polhode::table::{Data, Table};
use serde_json::Value;
use std::path::Path;
use support::{Workspace, repository};

const REFERENCE: f64 = 1e-28;
const ARTICLE: f64 = 1e-14;

fn oracle(name: &str) -> Value {
    let path = repository().join("tests/oracle").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A number, or a text that is one, rounded to `f64`.
fn number(value: &Value) -> f64 {
    let parsed = value.as_f64().or_else(|| value.as_str().and_then(|text| text.parse().ok()));
    parsed.unwrap_or_else(|| panic!("no number: {value}"))
}

fn given(pairs: &[(&str, f64)]) -> Inputs {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), Given::Number(*value))).collect()
}

/// Rounded once, an answer is the oracle's number rounded; its own error is half an ε and a little, so they may be neighbours.
#[track_caller]
fn is_rounded(answer: &Answer, t1: f64, what: &str) {
    let found = answer.numbers[0].unwrap_or_else(|| panic!("{what}: {answer:?}"));
    assert!((found / t1 - 1.0).abs() <= f64::EPSILON, "{what}: {found:?}, {t1:?}");
    assert!(answer.error.is_some_and(|error| error <= 2.0 * f64::EPSILON), "{what}: {answer:?}");
    assert!(answer.route.contains("double-double") && answer.route.contains("rounded"), "{}", answer.route);
}

#[test]
fn serret_andoyer_points_at_reference() {
    let rows = oracle("serret_andoyer_extra.json");
    let mut compared = 0;
    for row in rows.as_array().into_iter().flatten() {
        let inputs: Vec<f64> = row["inputs"].as_array().into_iter().flatten().map(number).collect();
        let mut start = given(&[("A", number(&row["A"])), ("B", number(&row["B"])), ("C", number(&row["C"]))]);
        match row["kind"].as_str() {
            Some("delta") => start.extend(given(&[("phi0", inputs[0]), ("delta", inputs[1])])),
            Some("p") => start.extend(given(&[("phi0", inputs[0]), ("p_theta", inputs[1])])),
            Some("mom") => start.extend(given(&[("y0", inputs[0]), ("p_x", inputs[1]), ("p_y", inputs[2])])),
            _ => continue,
        }
        if row["kind"] != "mom" {
            let branch = if inputs[2] < 0.0 { "descending" } else { "ascending" };
            start.insert("branch".to_owned(), Given::Word(branch.to_owned()));
        }
        let found = answer(Metric::SerretAndoyer, &start, REFERENCE).unwrap_or_else(|error| panic!("{row}: {error}"));
        is_rounded(&found, number(&row["t1"]), &row.to_string());
        compared += 1;
    }
    assert!(compared > 150, "{compared}");
}

#[test]
fn spin_points_at_reference() {
    let rows = oracle("spin_extra.json");
    let mut compared = 0;
    for row in rows["points"].as_array().into_iter().flatten() {
        let (k, p) = (number(&row["k"]), number(&row["p_theta"]));
        let found = answer(Metric::Spin, &given(&[("k", k), ("p_theta", p)]), REFERENCE);
        let found = found.unwrap_or_else(|error| panic!("{row}: {error}"));
        is_rounded(&found, number(&row["t1"]), &row.to_string());
        compared += 1;
    }
    assert!(compared >= 150, "{compared}");
}

/// In between: the error asked for is that of the integration, the arithmetic double-double.
#[test]
fn rotation_group_points_below_the_articles_error() {
    let case = &oracle("rotation_group_conjugate_times.json")[0];
    let number_at = |list: &str, i: usize| number(&case["params"][list][i]);
    let start = given(&[
        ("A", 1.5),
        ("B", 2.0),
        ("C", 2.8),
        ("Phi2", number_at("Phi", 1)),
        ("Phi3", number_at("Phi", 2)),
        ("p1", number_at("p", 0)),
        ("p2", number_at("p", 1)),
        ("p3", number_at("p", 2)),
    ]);
    for asked in [REFERENCE, 1e-20] {
        let found = answer(Metric::RotationGroup, &start, asked).unwrap_or_else(|error| panic!("{error}"));
        for (i, time) in found.numbers.iter().enumerate() {
            let exact = number(&case["value"]["tau"][i]);
            // The decimals given are not f64 numbers: half an ε of Φ2, whose condition is below 20.
            assert!(time.is_some_and(|time| (time / exact - 1.0).abs() <= 20.0 * f64::EPSILON), "{found:?}, {exact}");
        }
        assert!(found.route.contains("double-double"));
    }
    let article = answer(Metric::RotationGroup, &start, ARTICLE).unwrap_or_else(|error| panic!("{error}"));
    assert!(!article.route.contains("double-double"));
}

/// A cusp's constant, rounded, may lie beyond the cusp by its rounding; many rows at once are the same as each alone; refusals stay refusals.
#[test]
fn special_starts_at_reference() {
    let cusp = |p_theta: f64| {
        let mut start = given(&[("A", 1.5), ("B", 2.0), ("C", 2.8), ("phi0", 0.0), ("p_theta", p_theta)]);
        start.insert("branch".to_owned(), Given::Word("ascending".to_owned()));
        start
    };
    let largest = 1.0 / 1.5_f64.sqrt();
    let limit = std::f64::consts::PI * (1.5_f64 / (0.5 * 1.3)).sqrt();
    let rows = [cusp(largest), cusp(largest * (1.0 + f64::EPSILON)), cusp(0.72), cusp(1.0), cusp(0.6)];
    let found = answers(Metric::SerretAndoyer, &rows, REFERENCE);
    for row in &found[..2] {
        let t1 = row.as_ref().ok().and_then(|answer| answer.numbers[0]);
        assert!(t1.is_some_and(|t1| (t1 / limit - 1.0).abs() < 8.0 * f64::EPSILON), "{row:?}");
    }
    assert!(found[2].as_ref().is_ok_and(|answer| answer.numbers[0].is_some()));
    assert!(found[3].is_err());
    assert!(found[4].as_ref().is_ok_and(|answer| answer.numbers[0].is_none() && answer.reason.is_some()));
    for (row, together) in rows.iter().zip(&found) {
        assert_eq!(&answer(Metric::SerretAndoyer, row, REFERENCE), together);
    }
}

const SCENE: &str = r#"kind = "scene"
[scene]
metric.spin = { k = [0.8] }
start = { p_theta = { from = 1e-9, to = 1e4, step = 0.2 } }
effects = ["geodesics", "conjugate-locus", "cut-locus"]
accuracy = "article"
[trajectories]
count = 3
step = 0.3
"#;

const BODY: &str = r#"kind = "scene"
[scene]
metric.serret-andoyer = { A = 1.5, B = 2.0, C = 2.8 }
start = { phi0 = [-0.75] }
effects = ["conjugate-locus", "cut-locus", "period"]
accuracy = "article"
"#;

fn table(folder: &Path, name: &str) -> Table {
    let path = folder.join(name);
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Table::from_parquet(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The rows of closed forms are the same at every level; their numbers are within their own bounds of the reference's; what `draft` integrates is off by more.
#[test]
fn a_scene_at_every_level() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("experiments/spins.toml", SCENE);
    workspace.write("experiments/body.toml", BODY);
    for level in ["article", "draft", "1e-9", "1e-20", "reference"] {
        workspace.line(&format!("figures spins body --accuracy {level} --no-progress")).ends(0);
    }
    let at = |level: &str, name: &str| {
        let folder = if level == "article" { "figures".to_owned() } else { format!("figures/{level}") };
        table(&workspace.path(&folder), name)
    };
    let t1 = |table: &Table| table.f64s("t1").map(<[f64]>::to_vec).unwrap_or_else(|error| panic!("{error}"));
    for (name, error) in [
        ("data/spins/conjugate-locus-k=0.8.parquet", "error"),
        ("data/body/conjugate-locus-phi0=-0.75.parquet", "t1_error"),
    ] {
        let (article, reference) = (at("article", name), at("reference", name));
        assert_eq!(article.rows(), reference.rows());
        let errors = article.f64s(error).map(<[f64]>::to_vec).unwrap_or_else(|error| panic!("{error}"));
        let (short, long) = (t1(&article), t1(&reference));
        assert!(short != long, "{name}: double-double changes some last digits");
        for i in 0..short.len() {
            assert!((short[i] / long[i] - 1.0).abs() <= errors[i] + f64::EPSILON, "{name}, row {i}");
        }
        // Closed forms have no tolerance.
        assert_eq!(t1(&at("draft", name)), short);
        assert_eq!(t1(&at("1e-20", name)), long);
    }
    for name in [
        "data/spins/conjugate-locus-by-integration-k=0.8.parquet",
        "data/body/conjugate-locus-by-integration-phi0=-0.75.parquet",
    ] {
        let off = |level: &str| {
            let table = at(level, name);
            let column = |name: &str| table.f64s(name).map(<[f64]>::to_vec).unwrap_or_else(|error| panic!("{error}"));
            let (difference, allowed) = (column("t1_difference"), column("allowed"));
            assert!(
                difference.iter().zip(&allowed).all(|(difference, allowed)| difference <= allowed),
                "{level}: {name}"
            );
            difference.into_iter().fold(0.0, f64::max)
        };
        let found = ["draft", "1e-9", "article", "reference"].map(off);
        assert!(found.windows(2).all(|pair| pair[1] < pair[0]), "{name}: {found:?}");
        assert!(found[0] > 1e-9 && found[3] <= 2.0 * f64::EPSILON, "{name}: {found:?}");
        let all = at("reference", name).column("double_double").map(|column| column.data.clone());
        assert!(matches!(all, Ok(Data::Bool(all)) if all.iter().all(|long| *long)));
    }
}

#[test]
fn what_accuracy_costs() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("experiments/spins.toml", SCENE);
    let ran = workspace.line("accuracy spins --levels article,draft --json").ends(0);
    let found = ran.json();
    let levels: Vec<&str> =
        found["levels"].as_array().into_iter().flatten().filter_map(|level| level["level"].as_str()).collect();
    assert_eq!(levels, ["draft", "article", "reference"]);
    let of = |level: usize, path: &str| found["levels"][level].pointer(path).and_then(Value::as_f64);
    for level in 0..3 {
        assert!(of(level, "/compute_seconds").is_some_and(|seconds| seconds > 0.0));
        assert!(of(level, "/work/steps").is_some_and(|steps| steps > 0.0));
    }
    assert!(of(0, "/work/flow_evaluations") < of(1, "/work/flow_evaluations"));
    assert!(of(1, "/tables/columns/largest").is_some_and(|size| size > 0.0 && size < 1e-9), "{found}");
    assert!(of(1, "/picture/mm").is_some_and(|mm| mm < 0.05) && found["unchanged_from"].is_string(), "{found}");
    assert!(
        found["faster_than_reference"]["draft"].is_f64() && found["left_out"].as_array().is_some_and(Vec::is_empty)
    );
    assert!(workspace.read("figures/measured/accuracy-spins.svg").contains("What accuracy costs in time: spins"));
    assert!(ran.err.contains("spins at reference"), "{}", ran.err);
    // Nothing else was made or kept.
    assert!(!workspace.path(".polhode").exists() && !workspace.path("figures/spins.svg").exists());
    let text = workspace.line("accuracy spins --levels draft --no-progress").ends(0);
    assert!(text.out.contains("draft") && text.out.contains("times faster") && text.err.is_empty(), "{}", text.out);
    assert!(workspace.line("accuracy nothing").ends(2).err.contains("nothing"));
    assert!(workspace.line("accuracy spins --levels best").ends(2).err.contains("best"));
}

/// What no level changes has no price: it is refused by itself and left out of the whole, by name.
#[test]
fn what_no_level_changes_is_left_out() {
    let workspace = Workspace::with(&["hard_cases", "remark_3_25"]);
    let refused = workspace.line("accuracy hard_cases").ends(2);
    assert!(refused.err.contains("no level of accuracy changes what hard_cases computes"), "{}", refused.err);
    let whole = workspace.line("accuracy --levels draft --json").ends(0).json();
    assert_eq!(whole["left_out"].as_array().map(Vec::len), Some(1), "{whole}");
    assert!(whole["left_out"][0].as_str().is_some_and(|why| why.starts_with("hard_cases ")), "{whole}");
}
