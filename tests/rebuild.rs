//! One real rebuild confirms what the tests of edited copies foresee: the crate is copied, one file of a room gets a token more, others
//! get comments, docs, test code and blank lines, cargo builds it, and the fingerprints that the new program prints are those that
//! the function of `build.rs` gives: of that file and of the kinds that declare it, no others.
//!
//! Takes some minutes, so it is run by hand: `cargo test --test rebuild -- --ignored --nocapture`. Dependencies are linked from this build.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;
#[path = "../src/contract/tokens.rs"]
#[allow(dead_code, reason = "a part of it is for build.rs")]
mod tokens;

use polhode::contract::code::{CodeListing, listing};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use support::{Workspace, all_experiments, repository};

/// The file that gets a token more, and what that is.
const EDITED: (&str, &str) = ("numerics/roots.rs", "\nconst ONE_MORE: u8 = 1;\n");
/// Files that get what does not count.
const REMARKED: [(&str, &str); 4] = [
    ("geometry/spin/theta.rs", "\n// A remark.\n"),
    ("effects/point.rs", "\n/* Another,\n   of two lines. */\n"),
    ("plot/axis.rs", "\n\n\n"),
    ("table/digest.rs", "\n#[cfg(test)]\nmod more_tests {\n    #[test]\n    fn nothing() {}\n}\n"),
];

/// Copies a folder, or links its files; not what `skip` names.
fn bring(from: &Path, to: &Path, is_linked: bool, skip: &dyn Fn(&str) -> bool) {
    std::fs::create_dir_all(to).expect("made");
    for entry in std::fs::read_dir(from).expect("listed") {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name())).expect("an entry");
        let target = to.join(&name);
        if skip(&name.to_string_lossy()) {
            continue;
        }
        if path.is_dir() {
            bring(&path, &target, is_linked, skip);
        } else if !is_linked || std::fs::hard_link(&path, &target).is_err() {
            std::fs::copy(&path, &target).expect("copied");
        }
    }
}

fn version(program: &Path, workspace: &Workspace) -> Value {
    let output = Command::new(program).args(["--version", "--json"]).current_dir(workspace.root()).output();
    serde_json::from_slice(&output.expect("runs").stdout).expect("JSON")
}

#[test]
#[ignore = "builds the crate once more: minutes"]
fn a_rebuild_changes_the_fingerprints_that_were_foreseen() {
    let program = Path::new(env!("CARGO_BIN_EXE_polhode"));
    let built = program.parent().expect("target/debug");
    // Beside the folder that is linked from: links don't cross file systems.
    let copy = tempfile::tempdir_in(built.parent().expect("target")).expect("a folder");
    // Some modules of tests include oracles.
    for name in ["src", "benches", "experiments", "tests"] {
        bring(&repository().join(name), &copy.path().join(name), false, &|_| false);
    }
    for name in ["Cargo.toml", "Cargo.lock", "build.rs", "README.md"] {
        std::fs::copy(repository().join(name), copy.path().join(name)).expect("copied");
    }
    let is_own = |name: &str| name == "incremental" || name == "examples" || name.contains("polhode");
    for name in ["deps", "build", ".fingerprint"] {
        bring(&built.join(name), &copy.path().join("target/debug").join(name), true, &is_own);
    }
    for (file, text) in REMARKED.iter().chain([&EDITED]) {
        let path = copy.path().join("src").join(file);
        let source = std::fs::read_to_string(&path).expect("source");
        std::fs::write(path, source + text).expect("written");
    }

    // What is foreseen.
    let workspace = Workspace::with(&all_experiments());
    let before = version(program, &workspace);
    let source = std::fs::read_to_string(repository().join("src").join(EDITED.0)).expect("source") + EDITED.1;
    let module: Vec<&str> = EDITED.0.trim_end_matches(".rs").split('/').collect();
    let digest = tokens::read(&source, &module).expect("tokens").digest;
    let mut foreseen = before.clone();
    assert_ne!(foreseen["files"][EDITED.0], digest.as_str());
    foreseen["files"][EDITED.0] = digest.clone().into();
    let kinds = kinds(&workspace);
    let mut stale = 0;
    for (name, lines) in &kinds {
        let edited = lines
            .lines
            .iter()
            .map(|(file, old)| (file.clone(), if file == EDITED.0 { digest.clone().into() } else { old.clone() }));
        let listing = serde_json::to_value(CodeListing::new(edited).digest).expect("text");
        stale += usize::from(foreseen["kinds"][name] != listing);
        foreseen["kinds"][name] = listing;
    }
    assert!(stale > 0 && stale < kinds.len(), "{stale} of {} kinds", kinds.len());

    let begun = Instant::now();
    let ended = Command::new(env!("CARGO"))
        .args(["build", "--bin", "polhode", "--offline"])
        .current_dir(copy.path())
        .env("CARGO_TARGET_DIR", copy.path().join("target"))
        // Fingerprints are of the source: quickly built is well built.
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0")
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{said}");
    let compiled = said.matches("Compiling").count();
    let after = version(&copy.path().join("target/debug/polhode"), &workspace);
    println!("{compiled} crates built in {:?}; {stale} of {} kinds are stale", begun.elapsed(), kinds.len());
    assert_eq!(after["compiler"], foreseen["compiler"]);
    for part in ["files", "kinds"] {
        let changed = |value: &Value| -> Vec<String> {
            let old = before[part].as_object().expect("names");
            let new = value[part].as_object().expect("names");
            assert_eq!(old.len(), new.len());
            old.iter().filter(|(name, digest)| new[*name] != **digest).map(|(name, _)| name.clone()).collect()
        };
        assert_eq!(changed(&after), changed(&foreseen), "{part} that changed");
        assert_eq!(after[part], foreseen[part], "{part}");
    }
}

/// The kinds of the experiments there are, with the code that they depend on.
fn kinds(workspace: &Workspace) -> BTreeMap<String, CodeListing> {
    let place = polhode::cli::arguments::PlaceArguments {
        experiments: Some(workspace.path("experiments")),
        ..Default::default()
    };
    let session =
        polhode::cli::session::Session::begin(&place, &[]).unwrap_or_else(|refused| panic!("{}", refused.text));
    let nodes = session.graph.nodes.iter().map(|placed| placed.node.compute.kind());
    nodes.map(|kind| (kind.name.to_owned(), listing(kind).expect("code that exists").as_ref().clone())).collect()
}
