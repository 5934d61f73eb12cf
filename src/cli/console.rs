//! Where a command writes: data to standard output, messages and progress to standard error.
//!
//! A closed pipe ends the command quietly: whoever read it has seen enough.

use std::io::{self, IsTerminal, Write};

/// Why nothing more can be written.
#[derive(Debug, thiserror::Error)]
pub enum ConsoleError {
    /// The reader of standard output is gone.
    #[error("the reader of standard output is gone")]
    Closed,
    /// Another failure.
    #[error("standard output can't be written: {0}")]
    Failed(io::Error),
}

/// Writes data to standard output.
///
/// # Errors
/// A closed pipe, a full disk.
pub fn data(text: &str) -> Result<(), ConsoleError> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => ConsoleError::Closed,
        _ => ConsoleError::Failed(error),
    })
}

/// Writes a message to standard error. That it can't be written is no reason to stop.
pub fn message(text: &str) {
    let mut err = io::stderr().lock();
    let _ = writeln!(err, "{text}");
}

/// Whether messages may use colour: a terminal, and no `NO_COLOR`.
pub fn coloured() -> bool {
    let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    io::stderr().is_terminal() && !unwanted
}

/// Paints a word for standard error, where colours are welcome.
pub fn paint(text: &str, code: &str) -> String {
    if coloured() { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
}
