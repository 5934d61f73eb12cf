//! `polhode figures --watch`: runs again whenever a config is saved.
//!
//! The folder of configs is read and hashed a few times a second: no time stamps, no notifications that a file system
//! may not have. A text counts once it has been the same in two looks, so that a file that is being written is not read half. A
//! wrong config is said and waited over. Ctrl-C ends, at any moment: nothing is left half-written.

use crate::cli::arguments::FiguresArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::figures;
use crate::cli::session::Refused;
use crate::cli::workspace::{Workspace, WorkspaceError};
use crate::contract::digest::Digest;
use std::path::PathBuf;
use std::time::Duration;

/// Time between two looks: shorter than a person's patience, long enough to cost nothing.
const INTERVAL: Duration = Duration::from_millis(200);

/// The configs, by content; none for one that can't be read.
type Seen = Vec<(PathBuf, Option<Digest>)>;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &FiguresArguments) -> Result<Exit, ConsoleError> {
    let workspace = match Workspace::find(&arguments.run.place) {
        Ok(workspace) => workspace,
        Err(error) => return Ok(Refused::from(error).tell()),
    };
    let mut done: Option<Seen> = None;
    let mut last = look(&workspace);
    loop {
        if let Ok(seen) = &last
            && done.as_ref() != Some(seen)
        {
            let exit = figures::run(arguments)?;
            // A wrong command line stays wrong whatever is saved.
            if done.is_none() && exit == Exit::Usage {
                return Ok(exit);
            }
            done = Some(seen.clone());
            console::message(&format!("watching {}; Ctrl-C ends", workspace.experiments.display()));
        }
        last = settled(&workspace);
    }
}

/// Looks until two looks agree.
fn settled(workspace: &Workspace) -> Result<Seen, WorkspaceError> {
    let mut before = look(workspace);
    loop {
        std::thread::sleep(INTERVAL);
        let now = look(workspace);
        match (&before, &now) {
            (Ok(then), Ok(seen)) if then == seen => return now,
            // The folder is away for a moment, as when a branch is changed.
            _ => before = now,
        }
    }
}

fn look(workspace: &Workspace) -> Result<Seen, WorkspaceError> {
    let hashed = |path: PathBuf| {
        let digest = std::fs::read(&path).ok().map(|bytes| Digest::of(&bytes));
        (path, digest)
    };
    Ok(workspace.configs()?.into_iter().map(|(_, path)| hashed(path)).collect())
}
