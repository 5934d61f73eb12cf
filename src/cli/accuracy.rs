//! `polhode accuracy`: what accuracy costs in time, for the whole article or one experiment, on this machine.
//!
//! The target is computed at each level from nothing, in a store of its own that is thrown away: one level after another, one node after another, the reference
//! first. Then each level's named values, tables and pictures are compared with those of the reference ([`crate::check::difference`], [`crate::check::movement`]).
//! Closed forms have no tolerance: at `draft` they are as good as at `article`, and what is off is what was integrated.
//!
//! The whole article means its experiments: those it does not have are left out, and so are those that no level changes (statements are checked and hard
//! cases are computed at the accuracy that each of them says). Both are named.
//!
//! Times are the shortest of up to `REPEATS` runs on one core: of compute nodes alone, and with drawing and reading values. They are measurements: on stdout and in
//! `OUT/measured/`, in nothing that is committed or compared.

use crate::check::difference::Differences;
use crate::check::movement::{Movement, movement};
use crate::cli::accuracy_picture::picture;
use crate::cli::accuracy_report::{as_json, as_text, time};
use crate::cli::arguments::{AccuracyArguments, PlaceArguments};
use crate::cli::collected;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::{Refused, Session};
use crate::cli::workspace::Workspace;
use crate::contract::accuracy::Accuracy;
use crate::contract::node::Address;
use crate::contract::plan::Plan;
use crate::contract::value::Findings;
use crate::contract::work::Work;
use crate::effects::cost_of_effects::machine;
use crate::experiments::definition::{FINDINGS_FILE, FINDINGS_NODE, MEASURED_FOLDER, NOT_IN_ARTICLE, PICTURE_NODE};
use crate::pipeline::events::Silent;
use crate::pipeline::report::{Report, Status};
use crate::pipeline::run::run as run_pipeline;
use crate::plot::render::render;
use crate::table::Table;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The ladder of levels where none is asked for, from the least accurate.
const LADDER: [Accuracy; 7] = [
    Accuracy::Draft,
    Accuracy::Asked(1e-6),
    Accuracy::Asked(1e-8),
    Accuracy::Asked(1e-10),
    Accuracy::Asked(1e-12),
    Accuracy::Article,
    Accuracy::Reference,
];
/// Runs of one level at most; the shortest counts.
const REPEATS: u32 = 3;
/// No further run of a level is begun after this time: a figure's answer comes within a minute.
const LONG_ENOUGH: Duration = Duration::from_secs(3);
/// What the whole article is called among files.
const WHOLE: &str = "article";

/// What one level took and made.
pub struct Measured {
    /// The level.
    pub level: Accuracy,
    /// Seconds of the compute nodes.
    pub compute_seconds: f64,
    /// Seconds of all nodes.
    pub seconds: f64,
    /// Counted work.
    pub work: Work,
    /// Nodes that failed at this level, with what they say.
    pub failed: Vec<String>,
    /// How far the numbers are from the reference.
    pub differences: Differences,
    /// The picture that has moved most, and by how much.
    pub moved: Option<(String, Movement)>,
}

/// What a run left in its output folder.
#[derive(Default)]
struct Outputs {
    tables: BTreeMap<String, Table>,
    findings: BTreeMap<String, Findings>,
    pictures: BTreeMap<String, String>,
}

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &AccuracyArguments) -> Result<Exit, ConsoleError> {
    match answered(arguments) {
        Ok((text, exit)) => {
            console::data(&text)?;
            Ok(exit)
        }
        Err(refused) => Ok(refused.tell()),
    }
}

fn answered(arguments: &AccuracyArguments) -> Result<(String, Exit), Refused> {
    let levels = levels(arguments)?;
    let scope = scope(arguments)?;
    // How well work spreads over cores is not what accuracy costs. A pool that is there already has its own number of threads.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    let name = arguments.target.as_deref().map_or(WHOLE.to_owned(), |target| {
        Path::new(target).file_stem().map_or(target.to_owned(), |stem| stem.to_string_lossy().into_owned())
    });
    let mut reference = None;
    let mut measured = Vec::new();
    // The reference first: the others are compared with it as they come.
    for level in std::iter::once(Accuracy::Reference).chain(levels) {
        if !arguments.no_progress {
            console::message(&format!("{name} at {level} …"));
        }
        let (mut found, outputs) = measure(arguments, &scope.targets, level)?;
        if reference.is_none() {
            reference = Some(outputs);
        } else if let Some(reference) = &reference {
            compare(&mut found, &outputs, reference);
        }
        if !arguments.no_progress {
            console::message(&format!("{name} at {level}: {}", time(found.compute_seconds)));
        }
        measured.push(found);
    }
    measured.rotate_left(1);
    let exit = if measured.iter().any(|found| !found.failed.is_empty()) { Exit::NodeFailed } else { Exit::Success };
    let machine = machine::describe();
    let file = written(arguments, &name, &measured, &machine)?;
    let text = if arguments.json {
        format!("{:#}\n", as_json(&name, &measured, &machine, &scope.left_out))
    } else {
        let left_out = if scope.left_out.is_empty() {
            String::new()
        } else {
            format!("Left out: {}\n", scope.left_out.join("; "))
        };
        format!("{}{left_out}\nplot: {}\n", as_text(&name, &measured, &machine), file.display())
    };
    Ok((text, exit))
}

/// The levels asked for, from the least accurate, without the reference.
fn levels(arguments: &AccuracyArguments) -> Result<Vec<Accuracy>, Refused> {
    let mut levels = Vec::new();
    for text in &arguments.levels {
        let level = text.parse::<Accuracy>();
        levels.push(level.map_err(|error| Refused { exit: Exit::Usage, text: format!("--levels: {error}") })?);
    }
    if levels.is_empty() {
        levels.extend(LADDER);
    }
    levels.retain(|level| *level != Accuracy::Reference);
    levels.sort_by(|a, b| b.relative_error().total_cmp(&a.relative_error()));
    levels.dedup();
    Ok(levels)
}

/// What is computed, and what of the whole is not, with why.
struct Scope {
    targets: Vec<String>,
    left_out: Vec<String>,
}

/// The target, or the article's experiments that a level of accuracy changes.
fn scope(arguments: &AccuracyArguments) -> Result<Scope, Refused> {
    let wanted: Vec<String> = arguments.target.iter().cloned().collect();
    let planned = |level: Accuracy| {
        let place = PlaceArguments {
            experiments: arguments.experiments.clone(),
            accuracy: Some(level.to_string()),
            ..PlaceArguments::default()
        };
        let workspace = Workspace::find(&place)?;
        workspace.load(&wanted)
    };
    let (loose, tight) = (planned(Accuracy::Draft)?, planned(Accuracy::Reference)?);
    let mut scope = Scope { targets: wanted.clone(), left_out: Vec::new() };
    for (loose, tight) in loose.iter().zip(&tight) {
        let id = &loose.plan.id;
        let is_same = is_unchanged(&loose.plan, &tight.plan);
        if !wanted.is_empty() {
            if is_same {
                let text = format!("no level of accuracy changes what {id} computes: each part of it says its own");
                return Err(Refused { exit: Exit::Usage, text });
            }
        } else if loose.place == NOT_IN_ARTICLE {
            scope.left_out.push(format!("{id} is not in the article"));
        } else if is_same {
            scope.left_out.push(format!("no level changes {id}"));
        } else {
            scope.targets.push(id.clone());
        }
    }
    if scope.targets.is_empty() {
        return Err(Refused {
            exit: Exit::Usage,
            text: "no experiment here depends on the level of accuracy".to_owned(),
        });
    }
    Ok(scope)
}

/// Whether two plans compute the same: pictures and findings say the level in words.
fn is_unchanged(loose: &Plan, tight: &Plan) -> bool {
    let computed = |plan: &Plan| {
        let nodes = plan.nodes.iter().filter(|node| !is_shown(&node.address));
        nodes.map(|node| (node.address.to_string(), node.params.clone())).collect::<Vec<_>>()
    };
    computed(loose) == computed(tight)
}

/// Whether a node shows what others computed.
fn is_shown(address: &Address) -> bool {
    address.experiment == collected::ID || [PICTURE_NODE, FINDINGS_NODE].contains(&address.node.as_str())
}

/// Computes the targets at a level, from nothing, as often as its time allows.
fn measure(arguments: &AccuracyArguments, targets: &[String], level: Accuracy) -> Result<(Measured, Outputs), Refused> {
    let began = Instant::now();
    let mut best: Option<(Measured, Outputs)> = None;
    for _ in 0..REPEATS {
        let unwritable = |error: std::io::Error| Refused {
            exit: Exit::Store,
            text: format!("no folder for a store of its own: {error}\n  say where: TMPDIR=DIR"),
        };
        let folder = tempfile::tempdir().map_err(unwritable)?;
        let place = PlaceArguments {
            experiments: arguments.experiments.clone(),
            out: Some(folder.path().join("figures")),
            store: Some(folder.path().join("store")),
            accuracy: Some(level.to_string()),
        };
        let mut session = Session::begin(&place, targets)?;
        session.options.jobs = 1;
        let report = run_pipeline(&session.graph, &session.selection, &session.store, &session.options, &mut Silent);
        let found = taken(level, &report);
        if best.as_ref().is_none_or(|(best, _)| found.compute_seconds < best.compute_seconds) {
            let mut found = found;
            let outputs = outputs_of(&report, &session.workspace.out, &mut found.failed);
            best = Some((found, outputs));
        }
        if began.elapsed() > LONG_ENOUGH {
            break;
        }
    }
    best.ok_or_else(|| Refused { exit: Exit::Defect, text: format!("nothing was run at {level}") })
}

/// Times and work of a run.
fn taken(level: Accuracy, report: &Report) -> Measured {
    let mut found = Measured {
        level,
        compute_seconds: 0.0,
        seconds: 0.0,
        work: Work::default(),
        failed: report.failures().map(|(address, failure)| format!("{address}: {failure}")).collect(),
        differences: Differences::default(),
        moved: None,
    };
    for node in report.nodes.iter().filter(|node| node.status == Status::Ran) {
        let seconds = node.duration.map_or(0.0, |duration| duration.as_secs_f64());
        found.seconds += seconds;
        if !is_shown(&node.address) {
            found.compute_seconds += seconds;
            found.work += node.work.unwrap_or_default();
        }
    }
    found
}

/// What a run left; what can't be read is told with what failed.
fn outputs_of(report: &Report, out: &Path, failed: &mut Vec<String>) -> Outputs {
    let mut outputs = Outputs::default();
    for export in &report.exports {
        // What a failed node did not make is not there: it is told as failed.
        let Ok(bytes) = std::fs::read(out.join(&export.path)) else { continue };
        let (from, path) = (&export.from, &export.path);
        let mut unreadable = |why: String| failed.push(format!("{path}: {why}"));
        if path.ends_with(".parquet") {
            match Table::from_parquet(&bytes) {
                Ok(table) => drop(outputs.tables.insert(from.to_string(), table)),
                Err(error) => unreadable(error.to_string()),
            }
        } else if path.ends_with(FINDINGS_FILE) {
            match collected::findings(&bytes) {
                Ok(findings) => drop(outputs.findings.insert(from.experiment.clone(), findings)),
                Err(error) => unreadable(error.to_string()),
            }
        } else if path.ends_with(".svg") {
            match String::from_utf8(bytes) {
                Ok(text) => drop(outputs.pictures.insert(path.clone(), text)),
                Err(error) => unreadable(error.to_string()),
            }
        }
    }
    outputs
}

fn compare(found: &mut Measured, ours: &Outputs, reference: &Outputs) {
    for (experiment, findings) in &reference.findings {
        let own = ours.findings.get(experiment).map_or(&[][..], |own| &own.values);
        found.differences.add_values(experiment, own, &findings.values);
    }
    for (name, table) in &reference.tables {
        match ours.tables.get(name) {
            Some(own) => found.differences.add_table(name, own, table),
            None => found.differences.not_comparable.push(name.clone()),
        }
    }
    for (path, svg) in &reference.pictures {
        let Some(own) = ours.pictures.get(path) else { continue };
        let moved = movement(own, svg);
        let more = |most: &Movement| (moved.is_visible(), moved.mm) > (most.is_visible(), most.mm);
        if found.moved.as_ref().is_none_or(|(_, most)| more(most)) {
            found.moved = Some((path.clone(), moved));
        }
    }
}

/// Writes the plot, and says where.
fn written(
    arguments: &AccuracyArguments,
    name: &str,
    measured: &[Measured],
    machine: &str,
) -> Result<PathBuf, Refused> {
    let place = PlaceArguments {
        experiments: arguments.experiments.clone(),
        out: arguments.out.clone(),
        ..PlaceArguments::default()
    };
    let folder = Workspace::find(&place)?.out.join(MEASURED_FOLDER);
    let file = folder.join(format!("accuracy-{name}.svg"));
    let bytes = render(&picture(name, measured, machine))
        .map_err(|error| Refused { exit: Exit::Defect, text: format!("drawing: {error}") })?;
    let wrote = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&file, bytes));
    wrote.map_err(|error| Refused {
        exit: Exit::Usage,
        text: format!("{} can't be written: {error}", file.display()),
    })?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_run_from_the_least_accurate_and_wrong_ones_are_refused() {
        let asked = |levels: &[&str]| {
            let levels = levels.iter().map(|level| (*level).to_owned()).collect();
            super::levels(&AccuracyArguments { levels, ..AccuracyArguments::default() })
        };
        let ladder = asked(&["article", "1e-8", "reference", "draft", "1e-8"]).ok();
        assert_eq!(ladder, Some(vec![Accuracy::Draft, Accuracy::Asked(1e-8), Accuracy::Article]));
        assert_eq!(asked(&[]).ok().map(|levels| levels.len()), Some(LADDER.len() - 1));
        assert!(asked(&["best"]).is_err_and(|refused| refused.exit == Exit::Usage && refused.text.contains("best")));
    }
}
