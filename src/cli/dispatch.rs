//! From the command line to a verb, and from its end to an exit code.

use crate::cli::arguments::{Arguments, Verb};
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::{
    accuracy, check, completions, figures, gc, graph, init, list, log, new, point, schema, show, verify, version,
    watch, why,
};
use crate::numerics::lanes::dispatch::from_environment;
use clap::Parser;
use std::sync::Mutex;

/// Where the last panic happened: told only when it was not a node's, which the run reports itself.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Runs the command with the arguments of this process.
pub fn main() -> Exit {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if version::is_asked_as_json(std::env::args_os().skip(1), &error) => {
            return version::run().map_or(Exit::Success, |()| Exit::Success);
        }
        Err(error) => {
            // Help and version are data, the rest is a message; a closed pipe is no defect.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage } else { Exit::Success };
        }
    };
    std::panic::set_hook(Box::new(|panic| {
        if let Ok(mut place) = PANIC.lock() {
            *place = Some(panic.to_string());
        }
    }));
    if let Err(error) = from_environment() {
        console::message(&format!("error: {error}"));
        return Exit::Usage;
    }
    let ended = std::panic::catch_unwind(|| verb(&arguments.verb));
    match ended {
        Ok(Ok(exit)) => exit,
        Ok(Err(ConsoleError::Closed)) => Exit::Success,
        Ok(Err(error)) => {
            console::message(&format!("error: {error}"));
            Exit::Usage
        }
        Err(_) => {
            let place = PANIC.lock().ok().and_then(|place| place.clone()).unwrap_or_default();
            console::message(&format!(
                "error: a defect in polhode: {place}\n  what is stored stays right; please report this"
            ));
            Exit::Defect
        }
    }
}

fn verb(verb: &Verb) -> Result<Exit, ConsoleError> {
    match verb {
        Verb::Figures(arguments) if arguments.watch => watch::run(arguments),
        Verb::Figures(arguments) => figures::run(arguments),
        Verb::Check(arguments) => check::run(arguments),
        Verb::Why(arguments) => why::run(arguments),
        Verb::List(arguments) => list::run(arguments),
        Verb::Graph(arguments) => graph::run(arguments),
        Verb::Show(arguments) => show::run(arguments),
        Verb::Point(arguments) => point::run(arguments),
        Verb::Accuracy(arguments) => accuracy::run(arguments),
        Verb::New(arguments) => new::run(arguments),
        Verb::Init(arguments) => init::run(arguments),
        Verb::Verify(arguments) => verify::run(arguments),
        Verb::Gc(arguments) => gc::run(arguments),
        Verb::Log(arguments) => log::run(arguments),
        Verb::Schema(arguments) => schema::run(arguments),
        Verb::Completions(arguments) => completions::run(arguments),
    }
}
