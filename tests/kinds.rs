//! The code that a kind of node declares is the code that it reaches: else an edit would not make its results stale.

#![expect(clippy::panic, reason = "a test that can't read its input fails")]

use polhode::cli::arguments::SCENES;
use polhode::cli::{collected, page};
use polhode::contract::code;
use polhode::contract::node::Kind;
use polhode::contract::plan::{ConfigSource, Plan};
use polhode::experiments;
use polhode::experiments::definition::Request;
use std::collections::BTreeMap;

/// The plans of the committed configs, and of the configs that scenes begin with, which ask for every effect of every metric.
fn plans() -> Vec<Plan> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/experiments");
    let plan = |experiment: &experiments::definition::Experiment, file: String, text: String| {
        let request = Request { measure: true, ..Request::default() };
        let planned = experiment.plan_requested(experiment.kind, &ConfigSource { file, text }, request);
        planned.unwrap_or_else(|error| panic!("{error}")).plan
    };
    let mut plans = Vec::new();
    for experiment in experiments::ALL {
        if experiment.kind == experiments::scene::EXPERIMENT.kind {
            plans.extend(SCENES.map(|(metric, text)| plan(experiment, metric.to_owned(), text.to_owned())));
            continue;
        }
        let file = format!("{folder}/{}.toml", experiment.kind);
        let text = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{file}: {error}"));
        plans.push(plan(experiment, file, text));
    }
    plans
}

fn kinds() -> BTreeMap<&'static str, &'static Kind> {
    let mut kinds = BTreeMap::new();
    for node in plans().iter().flat_map(|plan| &plan.nodes) {
        let kind = node.compute.kind();
        let known = kinds.insert(kind.name, kind);
        assert!(known.is_none_or(|known| known == kind), "two kinds are called {}", kind.name);
    }
    kinds
}

/// Experiments plan, draw and find in one file, so a reader's file names rooms that only its planning uses. A picture depends on
/// its experiment's file, on how experiments are read, on plot and table; findings on the first two, on claims, values and table.
fn is_planning(kind: &Kind, to: &str) -> bool {
    let planning = ["effects/", "experiments/nodes.rs", "contract/config", "contract/sweep.rs"];
    let finding = ["contract/claim.rs", "contract/value.rs"];
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| to.starts_with(prefix));
    match kind.name.rsplit('-').next() {
        Some("picture") => starts(&planning) || starts(&finding),
        Some("findings") => starts(&planning) || to.starts_with("plot/"),
        // A sweep is refused by the config's rules; its values stand in the key themselves.
        _ => to.starts_with("contract/config"),
    }
}

#[test]
fn every_kind_declares_all_the_code_that_it_reaches() {
    let mut wrong = Vec::new();
    for kind in kinds().values() {
        match code::undeclared(kind) {
            Ok(missing) => {
                let missing = missing.iter().filter(|(_, to)| !is_planning(kind, to));
                wrong.extend(missing.map(|(from, to)| format!("{}: {from} uses {to}", kind.name)));
            }
            Err(error) => wrong.push(format!("{}: {error}", kind.name)),
        }
    }
    assert!(wrong.is_empty(), "code used and not declared:\n{}", wrong.join("\n"));
}

/// The page and `values.toml` belong to the whole, so no experiment's plan has their kinds; their files plan them too.
#[test]
fn what_belongs_to_the_whole_declares_its_code() {
    let planning = ["cli/workspace.rs", "effects/scene.rs", "effects/spin/", "experiments/", "contract/config"];
    for kind in [&page::KIND, &collected::KIND] {
        let missing = code::undeclared(kind).expect("code that exists").into_iter();
        let missing: Vec<_> = missing.filter(|(_, to)| !planning.iter().any(|prefix| to.starts_with(prefix))).collect();
        assert!(missing.is_empty(), "{}: used and not declared: {missing:?}", kind.name);
    }
}

/// A change to `src/plot` must rerun no integration, and one to numerics must redraw nothing by itself.
#[test]
fn only_pictures_depend_on_how_things_are_drawn() {
    for kind in kinds().values() {
        let listing = code::listing(kind).expect("code that exists");
        let has = |room: &str| listing.lines.iter().any(|(file, _)| file.starts_with(&format!("{room}/")));
        let is_picture = kind.name.ends_with("picture");
        assert_eq!(has("plot"), is_picture, "{} and plot", kind.name);
        assert!(!(is_picture && (has("numerics") || has("geometry"))), "{} reaches numerics", kind.name);
        assert!(!(has("pipeline") || has("cli")), "{} reaches the runner", kind.name);
    }
}

/// A time can reach a table only by code that reads the clock, and only measurements declare such code.
#[test]
fn only_measurements_read_the_clock() {
    let mut clocks = 0;
    for kind in kinds().values() {
        let listing = code::listing(kind).expect("code that exists");
        for (file, _) in listing.lines.iter().filter(|(file, _)| file.ends_with(".rs")) {
            let text = std::fs::read_to_string(format!("{}/src/{file}", env!("CARGO_MANIFEST_DIR"))).expect("a file");
            let program = text.split("#[cfg(test)]").next().unwrap_or_default();
            if program.contains("std::time") || program.contains("Instant::now") || program.contains("SystemTime") {
                assert!(kind.measurement, "{} depends on {file}, which reads the clock", kind.name);
                clocks += 1;
            }
        }
    }
    // The three problems of `cost_of_effects`: else the search would find nothing at all.
    assert!(clocks >= 3, "measurements without a clock: {clocks}");
}
