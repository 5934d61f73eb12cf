//! `polhode gc`: drops from the store what the last runs don't need.

use crate::cli::arguments::GcArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Session;
use crate::pipeline::gc::{Collected, GcOptions, Tally, gc};
use serde_json::json;
use std::time::Duration;

/// The version of the JSON that `gc` prints.
const SCHEMA: u32 = 1;

/// Time between two tries to take the store.
const POLL: Duration = Duration::from_millis(50);

/// Runs the verb. A wrong config is a refusal, since it is not known what it needs.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &GcArguments) -> Result<Exit, ConsoleError> {
    let session = match Session::begin(&arguments.place, &[]) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    let what = GcOptions { keep: arguments.keep.get(), here: arguments.here, dry_run: arguments.dry_run };
    let mut is_told = false;
    let mut wait = || {
        if !std::mem::replace(&mut is_told, true) {
            console::message("gc waits: a run is using the store; Ctrl-C ends the waiting");
        }
        std::thread::sleep(POLL);
    };
    let collected = match gc(&session.graph, &session.selection, &session.store, &session.options, what, &mut wait) {
        Ok(collected) => collected,
        Err(error) => {
            console::message(&format!("{} {error}", console::paint("error:", "1;31")));
            return Ok(Exit::Store);
        }
    };
    for other in session.store.other_formats() {
        console::message(&format!("note: {} is a store of another format; it is left alone", other.display()));
    }
    if arguments.json {
        let value = json!({ "schema": SCHEMA, "dry_run": arguments.dry_run, "collected": collected });
        console::data(&format!("{value:#}\n"))?;
    } else {
        console::data(&text(&collected, arguments.dry_run))?;
    }
    Ok(Exit::Success)
}

fn text(collected: &Collected, dry_run: bool) -> String {
    let verb = if dry_run { "would drop" } else { "dropped" };
    let mut text = format!("{verb} {}\nkept {}\n", counted(&collected.dropped), counted(&collected.kept));
    if collected.forgotten > 0 {
        text.push_str(&format!("{verb} the memory of {} experiments in other places\n", collected.forgotten));
    }
    for record in &collected.damaged {
        text.push_str(&format!("damaged, and kept: {record}; the next run that needs it makes it anew\n"));
    }
    text
}

fn counted(tally: &Tally) -> String {
    let Tally { records, objects, temporary, bytes } = tally;
    let temporary = if *temporary > 0 { format!(", {temporary} temporary files") } else { String::new() };
    format!("{records} records, {objects} objects{temporary}: {bytes} bytes")
}
