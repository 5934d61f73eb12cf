//! `polhode show`: a computed table as text or CSV, with units and meanings.

use crate::cli::arguments::ShowArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Session;
use crate::effects::product::TABLE;
use crate::pipeline::stored::stored;
use crate::table::{Table, render_text};

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &ShowArguments) -> Result<Exit, ConsoleError> {
    let table = match bytes(arguments) {
        Ok(bytes) => Table::from_parquet(&bytes),
        Err(exit) => return Ok(exit),
    };
    match table {
        Ok(table) if arguments.csv => match table.to_csv() {
            Ok(text) => console::data(&text).map(|()| Exit::Success),
            Err(error) => Ok(refused(&arguments.table, &error)),
        },
        Ok(table) => console::data(&render_text(&table, arguments.rows)).map(|()| Exit::Success),
        Err(error) => Ok(refused(&arguments.table, &error)),
    }
}

fn refused(table: &str, error: &dyn std::fmt::Display) -> Exit {
    console::message(&format!("error: {table}: {error}"));
    Exit::Usage
}

fn bytes(arguments: &ShowArguments) -> Result<Vec<u8>, Exit> {
    let path = std::path::Path::new(&arguments.table);
    if path.extension().is_some_and(|ending| ending == "parquet") && path.is_file() {
        return std::fs::read(path).map_err(|error| refused(&arguments.table, &error));
    }
    let session = Session::begin(&arguments.place, std::slice::from_ref(&arguments.table))
        .map_err(super::session::Refused::tell)?;
    let target = session.workspace.relative(&arguments.table);
    let tables = || {
        let makers = session.graph.exports.iter().filter(|export| export.export.artifact == TABLE);
        makers.map(|export| &export.export)
    };
    let Some(export) = tables().find(|export| export.path == target || export.from.to_string() == target) else {
        let known: Vec<String> = tables().map(|export| export.from.to_string()).collect();
        console::message(&format!("error: {target} is no table; there are\n  {}", known.join("\n  ")));
        return Err(Exit::Usage);
    };
    stored(&session.graph, &session.store, &session.options, &export.from, TABLE).map_err(|error| {
        console::message(&format!("error: {error}\n  compute it: polhode figures {}", export.from.experiment));
        Exit::GoldenDiffers
    })
}
