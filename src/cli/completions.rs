//! `polhode completions SHELL`: the shell's completions, made from the arguments themselves.

use crate::cli::arguments::{Arguments, CompletionsArguments};
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use clap::CommandFactory;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &CompletionsArguments) -> Result<Exit, ConsoleError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "polhode", &mut script);
    console::data(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Success)
}
