//! `polhode why`: the changed leaf, old → new, and what follows from it.

use crate::cli::arguments::WhyArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Session;
use crate::pipeline::why::why;
use serde_json::json;

/// The version of the JSON that `why` prints.
const SCHEMA: u32 = 1;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &WhyArguments) -> Result<Exit, ConsoleError> {
    let session = match Session::begin(&arguments.place, std::slice::from_ref(&arguments.target)) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    let target = session.workspace.relative(&arguments.target);
    let why = match why(&session.graph, &session.store, &session.options, &target) {
        Ok(why) => why,
        Err(error) => {
            console::message(&format!("error: {error}"));
            return Ok(Exit::Usage);
        }
    };
    if arguments.json {
        console::data(&format!("{:#}\n", json!({ "schema": SCHEMA, "idle": why.forecast.is_idle(), "why": why })))?;
    } else {
        console::data(&why.text())?;
    }
    Ok(if why.forecast.is_idle() { Exit::Success } else { Exit::GoldenDiffers })
}
