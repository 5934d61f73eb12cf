//! `polhode check`: runs what is stale, then compares with goldens and references and judges the claims.

use crate::check::golden::{self, Golden};
use crate::check::reference::References;
use crate::check::report::{Failure, Subject, check};
use crate::cli::arguments::CheckArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::figures;
use crate::cli::session::{Refused, Session};
use crate::cli::workspace::Loaded;
use crate::contract::accuracy::Accuracy;
use crate::contract::config;
use crate::effects::product::TABLE;
use crate::pipeline::report::Report;

/// The folder of the goldens, beside that of the configs.
pub const GOLDEN: &str = "golden";

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &CheckArguments) -> Result<Exit, ConsoleError> {
    let mut session = match Session::begin(&arguments.run.place, &arguments.targets) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    let report = figures::execute(&mut session, &arguments.run);
    figures::summarise(&session, &report, &session.changed_values(&report));
    let ran = figures::exit_of(&report);
    let subjects = match subjects(&session, &report) {
        Ok(subjects) => subjects,
        // A node that failed has said so already.
        Err(_) if ran != Exit::Success => return Ok(ran),
        Err(refused) => return Ok(refused.tell()),
    };
    let references = match References::embedded() {
        Ok(references) => references,
        Err(error) => return Ok(Refused { exit: Exit::Defect, text: error.to_string() }.tell()),
    };
    let checked = check(&subjects, &references, arguments.strict);
    if arguments.run.json {
        let text = serde_json::to_string_pretty(&checked).unwrap_or_default();
        console::data(&format!("{text}\n"))?;
    } else {
        console::data(&checked.text())?;
    }
    let verdict = match checked.failure() {
        None => Exit::Success,
        Some(Failure::VerdictOrReference) => Exit::VerdictDiffers,
        Some(Failure::Golden) => Exit::GoldenDiffers,
    };
    Ok(ran.and(verdict))
}

/// What each experiment gives to check, after a run.
///
/// # Errors
/// Findings or configs that can't be read.
pub fn subjects(session: &Session, report: &Report) -> Result<Vec<Subject>, Refused> {
    session.experiments.iter().map(|experiment| subject(session, report, experiment)).collect()
}

fn subject(session: &Session, report: &Report, experiment: &Loaded) -> Result<Subject, Refused> {
    let id = &experiment.plan.id;
    let source = &experiment.plan.config;
    let wrong = |error: config::ConfigError| Refused { exit: Exit::Config, text: error.to_string() };
    let findings =
        session.findings(id).map_err(|error| Refused { exit: Exit::NodeFailed, text: format!("{id}: {error}") })?;
    let (mut tables, mut work) = (Vec::new(), Vec::new());
    for node in report.nodes.iter().filter(|node| node.address.experiment == *id) {
        let record = node.key.and_then(|key| session.store.record(key).ok());
        if let Some(output) = record.as_ref().and_then(|record| record.output(TABLE)) {
            tables.push((node.address.to_string(), output.logical));
            work.extend(node.work.map(|work| (node.address.to_string(), work)));
        }
    }
    // Goldens pin the level "article"; at another level the digest of the config is made to differ.
    let leveled = session.workspace.accuracy.filter(|level| *level != Accuracy::Article);
    let text =
        leveled.map_or_else(|| source.text.clone(), |level| format!("accuracy-level = \"{level}\"\n{}", source.text));
    let golden = Golden {
        experiment: id.clone(),
        config: config::digest(&source.file, &text).map_err(wrong)?,
        values: findings.values.clone(),
        tables,
        verdicts: Vec::new(),
        work,
    };
    let file = session.workspace.root.join(GOLDEN).join(golden::file_name(id));
    Ok(Subject {
        config: config::leaves(&source.file, &source.text).map_err(wrong)?,
        stored: std::fs::read_to_string(file).ok(),
        findings,
        golden,
    })
}
