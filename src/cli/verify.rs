//! `polhode verify`: re-hashes the store and computes a sample of it again.

use crate::cli::arguments::VerifyArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::progress::{Shown, Style};
use crate::cli::session::Session;
use crate::pipeline::verify::{Outcome, Sample, Verified, verify};
use serde_json::json;
use std::fmt::Write as _;

/// The version of the JSON that `verify` prints.
const SCHEMA: u32 = 1;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &VerifyArguments) -> Result<Exit, ConsoleError> {
    let mut session = match Session::begin(&arguments.place, &arguments.targets) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    if let Some(jobs) = arguments.jobs {
        session.options.jobs = jobs.get();
    }
    // A pool that is there already serves as well.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(session.options.jobs).build_global();
    let sample = Sample { nodes: if arguments.all { usize::MAX } else { arguments.sample }, seed: arguments.seed };
    let mut shown = Shown::new(Style::fitting(arguments.no_progress));
    let Session { graph, selection, store, options, .. } = &session;
    let verified = verify(graph, selection, store, options, sample, &mut shown);
    shown.clear();
    let verified = match verified {
        Ok(verified) => verified,
        Err(error) => {
            console::message(&format!("{} {error}", console::paint("error:", "1;31")));
            return Ok(Exit::Store);
        }
    };
    for other in store.other_formats() {
        console::message(&format!("note: {} is a store of another format; it was not looked at", other.display()));
    }
    let exit = exit_of(&verified);
    if arguments.json {
        let value = json!({ "schema": SCHEMA, "exit": exit.code(), "verified": verified });
        console::data(&format!("{value:#}\n"))?;
    } else {
        console::data(&text(&verified))?;
    }
    Ok(exit)
}

fn exit_of(verified: &Verified) -> Exit {
    let reproducible = if verified.is_reproducible() { Exit::Success } else { Exit::Defect };
    reproducible.and(if verified.damage.is_empty() { Exit::Success } else { Exit::Store })
}

fn text(verified: &Verified) -> String {
    let Verified { records, objects, heads, bytes, .. } = verified;
    let mut text = format!("read {records} records, {objects} objects, {heads} heads: {bytes} bytes\n");
    for found in &verified.damage {
        let of = if found.addresses.is_empty() {
            ", which no present node needs: polhode gc drops it".to_owned()
        } else {
            format!(" of {}: the next run repairs it", found.addresses.join(", "))
        };
        // Writing to a String does not fail.
        let _ = writeln!(text, "damaged: {} is {}{of}", found.path, found.fault);
    }
    for path in &verified.foreign {
        let _ = writeln!(text, "no file of the store: {path}; it is left alone");
    }
    if verified.unnamed > 0 {
        let _ = writeln!(text, "{} objects belong to no record: polhode gc drops them", verified.unnamed);
    }
    let mut same = 0;
    for node in &verified.recomputed {
        match &node.outcome {
            Outcome::Same => same += 1,
            Outcome::Differs(what) => {
                let _ = writeln!(text, "differs: {} came out with another {}", node.address, what.join(", "));
            }
            Outcome::Failed(failure) => {
                let _ = writeln!(text, "differs: {} is stored, but now fails: {failure}", node.address);
            }
        }
    }
    let (done, of) = (verified.recomputed.len(), verified.stored);
    let _ = writeln!(text, "computed {done} of {of} stored nodes again: {same} the same to the bit");
    text
}
