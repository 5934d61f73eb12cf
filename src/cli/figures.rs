//! `polhode figures`: the main job.

use crate::check::values_toml::Change;
use crate::cli::arguments::{FiguresArguments, RunArguments};
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::progress::{Shown, Style};
use crate::cli::session::{Session, settled};
use crate::cli::workspace::Workspace;
use crate::experiments::definition::MEASURED_FOLDER;
use crate::pipeline::forecast::forecast;
use crate::pipeline::report::{ExportStatus, Outcome, Report, Status};
use crate::pipeline::run::run as run_pipeline;
use crate::pipeline::settled::Settled;
use serde_json::json;
use std::time::{Duration, Instant};

/// The version of the JSON that `figures` prints.
const SCHEMA: u32 = 1;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &FiguresArguments) -> Result<Exit, ConsoleError> {
    let clock = Instant::now();
    let is_plain = arguments.targets.is_empty() && !arguments.run.json;
    let is_told_otherwise = arguments.measure || arguments.force || arguments.dry_run;
    if is_plain
        && !is_told_otherwise
        && let Some((workspace, settled)) = settled(&arguments.run)
    {
        console::message(&counts(&workspace, &settled, clock.elapsed()));
        tell_measurements(&workspace, settled.note.split_whitespace());
        return Ok(Exit::Success);
    }
    let begin = if arguments.measure { Session::begin_measuring } else { Session::begin };
    let mut session = match begin(&arguments.run.place, &arguments.targets) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    session.options.force = arguments.force;
    session.options.fail_fast = arguments.fail_fast;
    if arguments.dry_run {
        return dry_run(&session, arguments.run.json);
    }
    let report = execute(&mut session, &arguments.run);
    let changes = session.changed_values(&report);
    let exit = exit_of(&report);
    if arguments.run.json {
        let value = json!({ "schema": SCHEMA, "exit": exit.code(), "report": report, "changed_values": changes });
        console::data(&format!("{value:#}\n"))?;
    }
    summarise(&session, &report, &changes);
    if !arguments.measure {
        let measuring = session.experiments.iter().filter(|experiment| experiment.measures);
        tell_measurements(&session.workspace, measuring.map(|experiment| experiment.plan.id.as_str()));
    }
    if !arguments.targets.is_empty() {
        for id in session.stale_in_values_file() {
            console::message(&format!(
                "note: values.toml does not hold the present values of {id}: run polhode figures"
            ));
        }
    }
    Ok(exit)
}

/// Runs what the session selected, with progress.
pub fn execute(session: &mut Session, arguments: &RunArguments) -> Report {
    if let Some(jobs) = arguments.jobs {
        session.options.jobs = jobs.get();
    }
    // Nodes compute in parallel inside, on this pool; a pool that is there already serves as well.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(session.options.jobs).build_global();
    let mut shown = Shown::new(Style::fitting(arguments.no_progress));
    let report = run_pipeline(&session.graph, &session.selection, &session.store, &session.options, &mut shown);
    shown.clear();
    report
}

/// How a run ends the command.
pub fn exit_of(report: &Report) -> Exit {
    match report.outcome() {
        Outcome::Success => Exit::Success,
        Outcome::NodeFailed => Exit::NodeFailed,
        Outcome::StoreFailed => Exit::Store,
    }
}

fn dry_run(session: &Session, as_json: bool) -> Result<Exit, ConsoleError> {
    let forecast = forecast(&session.graph, &session.selection, &session.store, &session.options);
    if as_json {
        let value = json!({ "schema": SCHEMA, "idle": forecast.is_idle(), "forecast": forecast });
        console::data(&format!("{value:#}\n"))?;
    } else {
        console::data(&forecast.text())?;
    }
    Ok(if forecast.is_idle() { Exit::Success } else { Exit::GoldenDiffers })
}

/// Says where the last measurement lies of the experiments that have one and were not measured in this run.
fn tell_measurements<'a>(workspace: &Workspace, measuring: impl Iterator<Item = &'a str>) {
    for id in measuring {
        let picture = workspace.out.join(MEASURED_FOLDER).join(format!("{id}.svg"));
        if picture.is_file() {
            console::message(&format!("{id}: times as last measured: {}", picture.display()));
        } else {
            console::message(&format!("{id}: times not measured here: polhode figures {id} --measure"));
        }
    }
}

/// What is said where a run would find nothing to do: as after a run that found so.
fn counts(workspace: &Workspace, settled: &Settled, elapsed: Duration) -> String {
    let Settled { nodes, outputs, .. } = settled;
    format!(
        "{nodes} nodes: 0 ran, {nodes} up to date; {outputs} outputs in {}: 0 written; {:.2} s",
        workspace.out.display(),
        elapsed.as_secs_f64()
    )
}

/// Says on standard error what a run did.
pub fn summarise(session: &Session, report: &Report, changes: &[Change]) {
    for error in &report.store_errors {
        console::message(&format!("{} {error}", console::paint("error:", "1;31")));
    }
    for warning in &report.warnings {
        console::message(&format!("warning: {warning}"));
    }
    for export in &report.exports {
        match &export.status {
            ExportStatus::Failed(error) => console::message(&format!("error: {}: {error}", export.path)),
            ExportStatus::NoSuchArtifact(failure) => console::message(&format!("error: {}: {failure}", export.path)),
            ExportStatus::Replaced => {
                console::message(&format!("note: {} stood there already and was replaced", export.path))
            }
            _ => {}
        }
    }
    let failed = report.count(|status| matches!(status, Status::Failed(_)));
    let blocked = report.count(|status| matches!(status, Status::Blocked(_) | Status::NotReached));
    if failed > 0 {
        console::message(&format!("{failed} nodes failed, {blocked} could not run for want of them:"));
        for (address, failure) in report.failures() {
            console::message(&format!("  {address}: {failure}"));
        }
    }
    for change in changes {
        console::message(&format!("changed: {change}"));
    }
    let cached = report.count(|status| *status == Status::Cached);
    let shared = report.count(|status| matches!(status, Status::SameAs(_)));
    let shared = if shared > 0 { format!(", {shared} the same as another") } else { String::new() };
    console::message(&format!(
        "{} nodes: {} ran, {cached} up to date{shared}; {} outputs in {}: {} written; {:.2} s",
        report.nodes.len(),
        report.ran(),
        report.exports.len(),
        session.workspace.out.display(),
        report.written().count(),
        report.elapsed.as_secs_f64(),
    ));
}
