//! `polhode init DIR`: a folder to work in outside the repository. The article's configs are in the program itself.

use crate::cli::arguments::InitArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Refused;
use crate::cli::workspace::{EXPERIMENTS, FIGURES};
use std::path::Path;

mod generated {
    include!(concat!(env!("OUT_DIR"), "/configs.rs"));
}

/// The configs that this program was built with: file name and text.
pub const CONFIGS: &[(&str, &str)] = generated::CONFIGS;

const IGNORED: &str = "/.polhode\n/figures/data\n/figures/measured\n/figures/article\n";

const README: &str = "\
# Experiments

Each file in `experiments/` is one experiment: edit it, or copy it under another name, and run

    polhode figures            # everything that is stale, into figures/
    polhode figures --watch    # again whenever a config is saved
    polhode why figures/ID.svg # why a figure will (not) be drawn again
    polhode list               # experiments, nodes, outputs

The figures, their data (`figures/data/`, Parquet) and the named values (`figures/values.toml`) follow from the configs and the
program alone. `.polhode/` holds stored results; it can be deleted at any time.
";

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &InitArguments) -> Result<Exit, ConsoleError> {
    match create(&arguments.folder) {
        Ok(count) => {
            let folder = arguments.folder.display();
            console::message(&format!("wrote {count} files to {folder}\nnext: cd {folder} && polhode figures"));
            Ok(Exit::Success)
        }
        Err(text) => Ok(Refused { exit: Exit::Usage, text }.tell()),
    }
}

fn create(folder: &Path) -> Result<usize, String> {
    let configs = CONFIGS.iter().map(|(name, text)| (folder.join(EXPERIMENTS).join(name), *text));
    let others = [(folder.join(".gitignore"), IGNORED), (folder.join("README.md"), README)];
    let files: Vec<_> = configs.chain(others).collect();
    // Looked at before anything is written: all or nothing.
    if let Some((there, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(format!("{} is there already: nothing was written", there.display()));
    }
    for folder in [folder.join(EXPERIMENTS), folder.join(FIGURES)] {
        std::fs::create_dir_all(&folder).map_err(|error| format!("{} can't be made: {error}", folder.display()))?;
    }
    for (path, text) in &files {
        std::fs::write(path, text).map_err(|error| format!("{} can't be written: {error}", path.display()))?;
    }
    Ok(files.len())
}
