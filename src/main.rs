//! The `polhode` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    polhode::cli::dispatch::main().into()
}
