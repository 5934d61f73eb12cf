//! The arrows between rooms, and no others: every path `crate::ROOM` in every file below `src/`, test code too, by its
//! tokens. The fingerprints of code stand on these arrows.

#![expect(clippy::expect_used, reason = "helpers of tests")]

#[path = "../src/contract/tokens.rs"]
#[allow(dead_code, reason = "a part of it is for build.rs")]
mod tokens;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// From each room, the rooms that it may name (besides itself).
const ARROWS: &[(&str, &[&str])] = &[
    (
        "cli",
        &[
            "article",
            "check",
            "contract",
            "effects",
            "experiments",
            "geometry",
            "numerics",
            "pipeline",
            "plot",
            "table",
        ],
    ),
    ("experiments", &["effects", "contract", "table", "plot"]),
    ("effects", &["geometry", "numerics", "table", "contract"]),
    ("pipeline", &["contract"]),
    ("check", &["contract", "table"]),
    ("article", &["check", "contract", "table"]),
    ("geometry", &["numerics"]),
    ("contract", &[]),
    ("numerics", &[]),
    ("table", &[]),
    ("plot", &[]),
];

/// Outside crates that one room keeps to itself.
const KEPT: &[(&str, &str)] = &[("polars", "table"), ("plotters", "plot")];

/// What is wrong with a file at `path` below `src/`.
fn faults(path: &str, text: &str) -> Vec<String> {
    let tokens = match tokens::all_tokens(text) {
        Ok(tokens) => tokens,
        Err(error) => return vec![error],
    };
    let stem = path.trim_end_matches(".rs").trim_end_matches("/mod");
    let module: Vec<&str> = if stem == "lib" || stem == "main" { Vec::new() } else { stem.split('/').collect() };
    let mut faults = Vec::new();
    match module.first() {
        None if stem == "lib" => root_faults(&tokens, &mut faults),
        None => main_faults(&tokens, &mut faults),
        Some(room) => room_faults(room, &module, &tokens, &mut faults),
    }
    for (name, keeper) in KEPT {
        let is_named = tokens.iter().any(|token| token == name || token.starts_with(&format!("{name}_")));
        if is_named && module.first() != Some(keeper) {
            faults.push(format!("names {name}, which belongs to {keeper} alone"));
        }
    }
    faults
}

/// The root lists rooms and re-exports nothing, so that every path to a room begins with its name.
fn root_faults(tokens: &[String], faults: &mut Vec<String>) {
    if tokens.iter().any(|token| token == "use" || token == "fn") {
        faults.push("the root of the crate only lists rooms".into());
    }
}

fn main_faults(tokens: &[String], faults: &mut Vec<String>) {
    for path in tokens::inside(tokens, &[]) {
        faults.push(format!("main.rs has no modules of its own, but names crate::{}", path.join("::")));
    }
    for at in (0..tokens.len()).filter(|at| tokens[*at] == "polhode") {
        let next = (tokens.get(at + 1).map(String::as_str), tokens.get(at + 2).map(String::as_str));
        if next != (Some("::"), Some("cli")) {
            faults.push("main.rs may use polhode::cli only".into());
        }
    }
}

fn room_faults(room: &str, module: &[&str], tokens: &[String], faults: &mut Vec<String>) {
    let word = |at: usize| tokens.get(at).map_or("", String::as_str);
    for at in 0..tokens.len() {
        if word(at) == "super" && word(at + 1) == "::" && word(at + 2) == "super" {
            faults.push("climbs by super::super; use crate::".into());
        }
        let is_bare = word(at) == "crate" && word(at + 1) != "::" && !["(", "in"].contains(&word(at.wrapping_sub(1)));
        if is_bare || (word(at) == "polhode" && word(at + 1) == "::") {
            faults.push(format!("names the crate otherwise than by crate::ROOM: {} {}", word(at), word(at + 1)));
        }
    }
    let Some((_, allowed)) = ARROWS.iter().find(|(from, _)| *from == room) else {
        faults.push(format!("the room {room} has no arrows; add it to the list of the design first"));
        return;
    };
    for path in tokens::inside(tokens, module) {
        match path.first().map(String::as_str) {
            Some("*") | None => faults.push("names the root of the crate as a whole".into()),
            Some(target) if target == room || allowed.contains(&target) => {}
            Some(target) => faults.push(format!("{room} → {target} ({}) is not an arrow", path.join("::"))),
        }
    }
}

fn sources(folder: &Path, below: &str, found: &mut BTreeMap<String, PathBuf>) {
    for entry in fs::read_dir(folder).expect("readable") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().into_string().expect("Unicode");
        let path = if below.is_empty() { name } else { format!("{below}/{name}") };
        if entry.path().is_dir() {
            sources(&entry.path(), &path, found);
        } else if path.ends_with(".rs") {
            found.insert(path, entry.path());
        }
    }
}

#[test]
fn rooms_name_only_the_rooms_that_the_arrows_allow() {
    let mut found = BTreeMap::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut found);
    assert!(found.len() > 10, "the sources are found");
    let mut all = Vec::new();
    for (path, file) in found {
        let text = fs::read_to_string(file).expect("text");
        all.extend(faults(&path, &text).into_iter().map(|fault| format!("src/{path}: {fault}")));
    }
    assert!(all.is_empty(), "\n{}", all.join("\n"));
}

/// The scan itself: each way around the arrows is caught, and what is allowed is not.
#[test]
fn ways_around_the_arrows_are_caught() {
    let caught = [
        ("pipeline/run.rs", "use crate::geometry::spin::Spin;"),
        ("pipeline/run.rs", "use crate::{contract::node, numerics::{real, ulp}};"),
        ("pipeline/run.rs", "fn f() { crate::effects::period::run() }"),
        ("pipeline/run.rs", "#[cfg(test)] mod tests { use crate::experiments::fig1; }"),
        ("pipeline/run.rs", "use super::super::numerics::real;"),
        ("pipeline/mod.rs", "use super::numerics::real;"),
        ("pipeline/run.rs", "use crate as root; use root::numerics;"),
        ("pipeline/run.rs", "use crate::*;"),
        ("pipeline/run.rs", "use polhode::numerics;"),
        ("numerics/real.rs", "use crate::contract::digest::Digest;"),
        ("effects/period.rs", "use polars::prelude::*;"),
        ("table/plot.rs", "fn f() { plotters::style::RED; }"),
        ("lib.rs", "pub mod numerics; pub use numerics::real::Real;"),
        ("main.rs", "fn main() { polhode::pipeline::run::run() }"),
        ("attic/old.rs", ""),
    ];
    for (path, text) in caught {
        assert!(!faults(path, text).is_empty(), "{path}: {text}");
    }
    let fine = [
        (
            "pipeline/run.rs",
            "/// See crate::geometry.\npub(crate) use crate::contract::{node::Node, plan}; use super::graph;",
        ),
        (
            "effects/period.rs",
            "use crate::{geometry::spin, numerics::{real::{Real, self}, ulp}, table, contract::work};",
        ),
        ("table/parquet.rs", "use polars::prelude::*; use polars_parquet::write;"),
        ("geometry/spin/flow.rs", "mod tests { use super::*; } use super::chart; use crate::numerics;"),
        ("lib.rs", "//! Map.\npub mod numerics;\npub mod pipeline;"),
        ("main.rs", "fn main() -> std::process::ExitCode { polhode::cli::main() }"),
    ];
    for (path, text) in fine {
        assert_eq!(faults(path, text), Vec::<String>::new(), "{path}: {text}");
    }
}
