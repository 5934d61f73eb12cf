//! `polhode schema [KIND]`: the JSON schema of configs, for editors and other programs.

use crate::cli::arguments::SchemaArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::contract::config;
use crate::experiments;

/// The schema of the configs of one kind, or of all.
pub fn schema(kind: Option<&str>) -> Option<serde_json::Value> {
    match kind {
        Some(kind) => experiments::ALL.iter().find(|experiment| experiment.kind == kind).map(|found| found.schema()),
        None => {
            let schemas = experiments::ALL.iter().map(|experiment| (experiment.kind, experiment.schema())).collect();
            Some(config::one_of(schemas, "Config of an experiment of polhode"))
        }
    }
}

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &SchemaArguments) -> Result<Exit, ConsoleError> {
    // clap has refused all other kinds.
    if let Some(schema) = schema(arguments.kind.as_deref()) {
        console::data(&format!("{schema:#}\n"))?;
    }
    Ok(Exit::Success)
}
