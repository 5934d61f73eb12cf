//! `polhode graph`: the graph of nodes, drawn.

use crate::cli::arguments::{GraphArguments, GraphForm};
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Session;
use crate::pipeline::render::{Format, render};

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &GraphArguments) -> Result<Exit, ConsoleError> {
    let session = match Session::begin(&arguments.place, &arguments.targets) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    let format = match (arguments.json, arguments.form) {
        (true, _) | (_, GraphForm::Json) => Format::Json,
        (_, GraphForm::Text) => Format::Text,
        (_, GraphForm::Svg) => Format::Svg,
        (_, GraphForm::Dot) => Format::Dot,
        (_, GraphForm::Mermaid) => Format::Mermaid,
    };
    let mut text = render(&session.graph, &session.selection, format);
    if !text.ends_with('\n') {
        text.push('\n');
    }
    console::data(&text)?;
    Ok(Exit::Success)
}
