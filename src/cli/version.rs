//! `polhode --version --json`: the version, the compiler, and the code fingerprints that results depend on.

use crate::cli::arguments::PlaceArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::session::Session;
use crate::contract::code;
use serde_json::{Map, Value, json};
use std::ffi::OsString;

/// The version of the JSON that this prints.
const SCHEMA: u32 = 1;

/// Whether the whole command line asks for this: `--version` and `--json`, nothing else. `error` is what the parser made of it.
pub fn is_asked_as_json(arguments: impl Iterator<Item = OsString>, error: &clap::Error) -> bool {
    let mut words: Vec<OsString> = arguments.collect();
    words.sort();
    let is_version =
        ["--version", "-V"].iter().any(|version| words == ["--json", version] || words == [version, "--json"]);
    is_version
        && matches!(error.kind(), clap::error::ErrorKind::DisplayVersion | clap::error::ErrorKind::UnknownArgument)
}

/// Prints it. The kinds are those of the experiments here; outside a folder with experiments there are none, which is no error.
///
/// # Errors
/// Standard output that can't be written.
pub fn run() -> Result<(), ConsoleError> {
    let mut kinds = Map::new();
    if let Ok(session) = Session::begin(&PlaceArguments::default(), &[]) {
        for placed in &session.graph.nodes {
            kinds.insert(placed.node.compute.kind().name.to_owned(), json!(placed.code.digest));
        }
    }
    let files: Map<String, Value> = code::FILES.iter().map(|file| (file.path.to_owned(), json!(file.digest))).collect();
    let version = json!({
        "schema": SCHEMA, "version": env!("CARGO_PKG_VERSION"), "compiler": code::COMPILER, "kinds": kinds, "files": files,
    });
    console::data(&format!("{version:#}\n"))
}
