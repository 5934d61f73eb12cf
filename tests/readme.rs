//! The README's commands run, as they stand, in a copy of what a clone holds.

#![expect(clippy::expect_used, reason = "helpers of tests")]

mod support;

use std::collections::BTreeSet;
use support::{Shared, all_experiments, repository};

fn readme() -> String {
    std::fs::read_to_string(repository().join("README.md")).expect("README.md")
}

/// The lines of the README's shell blocks, without comments and prompts.
fn lines() -> Vec<String> {
    let mut lines = Vec::new();
    let mut is_shell = false;
    for line in readme().lines() {
        if let Some(language) = line.trim().strip_prefix("```") {
            is_shell = ["sh", "bash", "console", "shell"].contains(&language);
        } else if is_shell {
            let command = line.split(" #").next().unwrap_or_default().trim().trim_start_matches("$ ");
            if !command.is_empty() && !command.starts_with('#') {
                lines.push(command.to_owned());
            }
        }
    }
    lines
}

/// A command as arguments of the binary; none where it is not ours to run here: cloning, the tests themselves, recipes.
fn ours(command: &str) -> Option<String> {
    const OTHERS: [&str; 5] = ["git clone", "cd ", "cargo test", "just", "pip install"];
    let own = [
        ("polhode ", ""),
        ("cargo polhode ", ""),
        ("cargo run -- ", ""),
        ("target/debug/polhode ", ""),
        ("cargo figures", "figures"),
    ];
    // What is piped or redirected further is not ours.
    let command = command.split(" | ").next().and_then(|command| command.split(" > ").next()).unwrap_or_default();
    let found = own.iter().find_map(|(begin, verb)| Some(format!("{verb}{}", command.strip_prefix(begin)?)));
    assert!(found.is_some() || OTHERS.iter().any(|other| command.starts_with(other)), "what is {command:?}?");
    found
}

#[test]
fn the_commands_of_the_readme_run() {
    let shared = Shared::empty("readme", &all_experiments());
    let workspace = &shared.workspace;
    for (name, bytes) in support::files(&repository().join("golden")) {
        workspace.write(&format!("golden/{name}"), bytes);
    }
    workspace
        .write("src/experiments/mod.rs", std::fs::read(repository().join("src/experiments/mod.rs")).expect("the list"));
    workspace.write("starts.csv", "p_theta\n0.5\n1\n2\n");
    let commands: Vec<String> = lines().iter().filter_map(|line| ours(line)).collect();
    assert!(commands.len() >= 10, "{commands:?}");
    assert_eq!(commands[0], "figures", "the first is the main job");
    for command in &commands {
        let ran = workspace.line(command);
        // The scene made on the way has values that values.toml does not have yet: a dry run says so by its exit code.
        let well = ran.code == 0 || ran.code == 6 && command.contains("--dry-run");
        assert!(
            well && !ran.err.contains("panicked"),
            "polhode {command}: exit {}\n{}\n{}",
            ran.code,
            ran.out,
            ran.err
        );
    }
    assert_eq!(workspace.line("figures --json").ends(0).json()["report"]["unknown_files"], serde_json::json!([]));
}

/// Files and folders that the README speaks of are there, pictures and links too.
#[test]
fn what_the_readme_points_at_is_there() {
    let text = readme();
    let mut named = BTreeSet::new();
    for piece in text.split("](").skip(1) {
        let target = piece.split(')').next().unwrap_or_default();
        if !target.contains("://") && !target.starts_with('#') {
            named.insert(target.to_owned());
        }
    }
    for word in text.split('`').skip(1).step_by(2) {
        let is_place = ["experiments/", "src/", "tests/", "golden/", "benches/", "figures/"]
            .iter()
            .any(|begin| word.starts_with(begin));
        // Places that a run makes, and patterns.
        let is_made = word.starts_with("figures/data")
            || word.starts_with("figures/measured")
            || word.starts_with("figures/article")
            || word.contains(['<', '*', ' ', '=']);
        if is_place && !is_made {
            named.insert(word.to_owned());
        }
    }
    assert!(named.len() >= 5, "{named:?}");
    let missing: Vec<&String> = named.iter().filter(|name| !repository().join(name).exists()).collect();
    assert!(missing.is_empty(), "the README points at what is not there: {missing:?}");
}

/// The exit codes it lists are those of the program.
#[test]
fn the_readme_lists_the_exit_codes() {
    let text = readme();
    let list = text.split("Exit codes: ").nth(1).unwrap_or_else(|| panic!("no list of exit codes"));
    let list = list.split("\n\n").next().unwrap_or_default();
    let codes: BTreeSet<String> =
        list.split([' ', '\n']).filter(|word| word.parse::<u8>().is_ok()).map(str::to_owned).collect();
    assert_eq!(codes, (0..=7).map(|code| code.to_string()).collect());
}
