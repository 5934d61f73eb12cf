//! The same bits everywhere: for one thread and many, in any folder, with the C library's FMA variants switched off; and
//! nothing in the outputs says when, where or by what they were made. All experiments there are.

#![expect(clippy::expect_used, reason = "helpers of tests")]

mod support;

use std::collections::BTreeMap;
use std::process::Command;
use std::sync::OnceLock;
use support::{Workspace, all_experiments, finish, text};

/// Takes the variants with fused multiply-add away from the C library's mathematics; ignored where there is no glibc.
const WITHOUT_FMA: (&str, &str) = ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-FMA4");

type Files = BTreeMap<String, Vec<u8>>;

/// A run from nothing, in a folder of its own.
struct Made {
    outputs: Files,
    /// The folder it was in, and the keys of its nodes.
    traces: Vec<String>,
}

fn make(inside: &str, arguments: &str, environment: &[(&str, &str)]) -> Made {
    let workspace = Workspace::with(&all_experiments());
    let (out, store) = (workspace.path(inside).join("out"), workspace.path(inside).join("store"));
    let mut command = support::polhode();
    command.args(["figures", "--json", "--no-progress", "--experiments"]).arg(workspace.path("experiments"));
    command.arg("--out").arg(&out).arg("--store").arg(&store).args(arguments.split_whitespace());
    command.envs(environment.iter().copied()).current_dir(std::env::temp_dir());
    let ran = finish(&mut command).ends(0);
    let report = support::Report(ran.json());
    assert_eq!(report.nodes("cached"), [""; 0], "a run from nothing");
    let nodes = report.0["report"]["nodes"].as_array().expect("nodes");
    let mut traces: Vec<String> = nodes.iter().map(|node| text(&node["key"])).collect();
    traces.push(workspace.root().display().to_string());
    traces.push(workspace.root().file_name().expect("a name").to_string_lossy().into_owned());
    Made { outputs: support::files(&out), traces }
}

/// One thread.
fn first() -> &'static Made {
    static FIRST: OnceLock<Made> = OnceLock::new();
    FIRST.get_or_init(|| make("a", "--jobs 1", &[("RAYON_NUM_THREADS", "1")]))
}

#[track_caller]
fn same(made: &Files, of: &str) {
    let first = &first().outputs;
    assert_eq!(made.keys().collect::<Vec<_>>(), first.keys().collect::<Vec<_>>(), "{of}");
    let different: Vec<&String> =
        first.iter().filter(|(path, bytes)| made[*path] != **bytes).map(|(path, _)| path).collect();
    assert!(different.is_empty(), "{of}: other bytes in {different:?}");
}

/// Data, SVG and values.toml; another folder, at another depth, with a name that is no ASCII.
#[test]
fn many_threads_in_another_folder() {
    let made = make("a folder/ñ/deeper", "--jobs 5", &[("RAYON_NUM_THREADS", "3")]);
    same(&made.outputs, "5 jobs");
    for ending in [".svg", ".parquet", "values.toml", "findings.json"] {
        assert!(made.outputs.keys().any(|path| path.ends_with(ending)), "no {ending}");
    }
}

#[test]
fn without_the_c_librarys_fma_variants() {
    same(&make("c", "--jobs 2", &[WITHOUT_FMA, ("RAYON_NUM_THREADS", "7")]).outputs, "without FMA");
}

/// The committed pictures and values are what a run makes on any machine.
#[test]
fn the_committed_outputs_are_these() {
    let first = &first().outputs;
    let committed = support::files(&support::repository().join("figures"));
    let is_committed = |path: &&String| path.ends_with(".svg") && !path.contains('/') || *path == "values.toml";
    let different: Vec<&String> =
        first.keys().filter(is_committed).filter(|path| committed.get(*path) != first.get(*path)).collect();
    assert!(
        different.is_empty(),
        "other than the committed ones: {different:?}; run `polhode figures` and commit them"
    );
}

/// No path, no key, no compiler, no machine, no date: only what they show.
#[test]
fn outputs_say_nothing_of_how_they_came_about() {
    let Made { outputs, traces } = first();
    let mut traces = traces.clone();
    traces.push(polhode::contract::code::COMPILER.to_owned());
    traces.push(format!("polhode {}", env!("CARGO_PKG_VERSION")));
    traces.push(support::repository().display().to_string());
    traces.push(today());
    let name = std::fs::read_to_string("/etc/hostname").unwrap_or_default();
    // A short name could be a word.
    traces.extend(Some(name.trim().to_owned()).filter(|name| name.len() >= 8));
    for (path, bytes) in outputs {
        for trace in &traces {
            let is_in = bytes.windows(trace.len()).any(|window| window == trace.as_bytes());
            assert!(!is_in, "{path} holds {trace:?}");
        }
    }
}

/// Today as `2026-01-31`.
fn today() -> String {
    let seconds = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).expect("after 1970").as_secs();
    // Civil date from days, H. Hinnant's algorithm.
    let days = i64::try_from(seconds / 86400).expect("small") + 719_468;
    let era = days / 146_097;
    let day_of_era = days - era * 146_097;
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

/// Tables of points too, for all metrics.
#[test]
fn points_are_the_same_bits() {
    let workspace = Workspace::with::<&str>(&[]);
    let mut spin = String::from("k,p_theta\n");
    for row in 0..60 {
        spin.push_str(&format!("{},{}\n", 0.1 + 0.03 * f64::from(row), 1e-9 * f64::from(1u32 << (row % 30))));
    }
    let mut serret_andoyer = String::from("phi0,delta,branch\n");
    for row in 0..60 {
        let branch = if row % 2 == 0 { "ascending" } else { "descending" };
        serret_andoyer.push_str(&format!(
            "{},{},{branch}\n",
            -0.9 + 0.03 * f64::from(row),
            1e-12 * f64::from(1u32 << (row % 30))
        ));
    }
    let mut rotation_group = String::from("H1,H2,H3\n");
    for row in 0..20 {
        rotation_group.push_str(&format!("{},-0.3,{}\n", -1.0 + 0.06 * f64::from(row), 0.3 - 0.01 * f64::from(row)));
    }
    let body = "A=1.5 B=2 C=2.8";
    for (metric, fixed, starts) in
        [("spin", "", spin), ("serret-andoyer", body, serret_andoyer), ("rotation-group", body, rotation_group)]
    {
        workspace.write("starts.csv", starts);
        let make = |jobs: &str, environment: &[(&str, &str)]| {
            let mut command: Command = workspace.command();
            command.args(["point", metric]).args(fixed.split_whitespace());
            command.args(["--input", "starts.csv", "--output", "points.csv", "--jobs", jobs]);
            finish(command.envs(environment.iter().copied())).ends(0);
            workspace.read("points.csv")
        };
        let one = make("1", &[]);
        assert_eq!(one, make("5", &[("RAYON_NUM_THREADS", "2")]), "{metric}");
        assert_eq!(one, make("2", &[WITHOUT_FMA]), "{metric}");
    }
}
