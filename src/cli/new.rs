//! `polhode new ID`: a new experiment, ready to run: its module, its config, and the word in the list of experiments; or, with `--scene`, the
//! config of a scene, which needs none of the rest.

use crate::cli::arguments::{NewArguments, PlaceArguments, SCENES};
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Refused;
use crate::cli::workspace::Workspace;
use std::path::{Path, PathBuf};

/// The module that new ones are made from: compiled and run by the tests, so that it can't rot.
const MODULE: &str = include_str!("../experiments/template.rs");
/// Its config.
const CONFIG: &str = include_str!("../experiments/template.toml");
/// The names in them that the new ones take the place of.
const NAMES: [(&str, Case); 2] = [("template", Case::Snake), ("Template", Case::Camel)];

#[derive(Clone, Copy)]
enum Case {
    Snake,
    Camel,
}

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &NewArguments) -> Result<Exit, ConsoleError> {
    match create(arguments) {
        Ok(written) => {
            for path in &written {
                console::message(&format!("wrote {}", path.display()));
            }
            let id = &arguments.id;
            console::message(&if arguments.scene {
                format!("next: polhode figures {id}, then edit {}", written[0].display())
            } else {
                format!("next: cargo run -- figures {id}, then edit experiments/{id}.toml and src/experiments/{id}.rs")
            });
            Ok(Exit::Success)
        }
        Err(refused) => Ok(refused.tell()),
    }
}

fn usage(text: String) -> Refused {
    Refused { exit: Exit::Usage, text }
}

fn create(arguments: &NewArguments) -> Result<Vec<PathBuf>, Refused> {
    let id = &arguments.id;
    let first_is_letter = id.chars().next().is_some_and(|c| c.is_ascii_lowercase());
    let plain = id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    if !(first_is_letter && plain) {
        return Err(usage(format!(
            "{id:?} is no id: a lower-case letter, then lower-case letters, digits, underscores"
        )));
    }
    let place = PlaceArguments { experiments: arguments.experiments.clone(), ..PlaceArguments::default() };
    let workspace = Workspace::find(&place)?;
    if arguments.scene {
        return create_scene(id, &arguments.metric, &workspace);
    }
    let room = workspace.root.join("src").join("experiments");
    let list = room.join("mod.rs");
    let names = std::fs::read_to_string(&list).map_err(|error| {
        usage(format!(
            "{}: {error}\n  a new experiment is a module of polhode's own source: run this in its repository\n  \
             a scene needs no module: polhode new --scene {id}",
            list.display()
        ))
    })?;
    let (module, config) = (room.join(format!("{id}.rs")), workspace.experiments.join(format!("{id}.toml")));
    for path in [&module, &config] {
        if path.exists() {
            return Err(usage(format!("{} is there already: nothing was written", path.display())));
        }
    }
    let names = with_name(&names, id)
        .ok_or_else(|| usage(format!("{}: no list `experiments! {{ … }}` in it", list.display())))?;
    write(&module, &renamed(MODULE, id))?;
    write(&config, &renamed(CONFIG, id))?;
    write(&list, &names)?;
    Ok(vec![module, config, list])
}

/// The config of a scene.
fn create_scene(id: &str, metric: &str, workspace: &Workspace) -> Result<Vec<PathBuf>, Refused> {
    let text = SCENES.iter().find(|(name, _)| *name == metric).map(|(_, text)| text.replace("ID`", &format!("{id}`")));
    let text = text.ok_or_else(|| usage(format!("no metric is called {metric:?}")))?;
    let config = workspace.experiments.join(format!("{id}.toml"));
    if config.exists() {
        return Err(usage(format!("{} is there already: nothing was written", config.display())));
    }
    write(&config, &text)?;
    Ok(vec![config])
}

fn write(path: &Path, text: &str) -> Result<(), Refused> {
    std::fs::write(path, text).map_err(|error| usage(format!("{} can't be written: {error}", path.display())))
}

fn renamed(text: &str, id: &str) -> String {
    NAMES.iter().fold(text.to_owned(), |text, (name, case)| {
        let new = match case {
            Case::Snake => id.to_owned(),
            Case::Camel => id.split('_').map(capitalised).collect(),
        };
        text.replace(name, &new)
    })
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The list of experiments with one more name at its end.
fn with_name(text: &str, id: &str) -> Option<String> {
    let begin = text.rfind("experiments! {")?;
    let end = begin + text[begin..].find('}')?;
    let (before, after) = text.split_at(end);
    Some(format!("{} {id} {after}", before.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::verdict::{Verdict, judge};
    use crate::experiments::{preview, template};

    /// The template plans, computes and draws as it stands.
    #[test]
    fn the_template_runs() {
        let preview = preview::run_text(&template::EXPERIMENT, CONFIG.to_owned());
        assert!(preview.value("least_time") > 4.772);
        assert!(preview.findings.claims.iter().all(|claim| judge(&claim.evidence).verdict == Verdict::Holds));
    }

    #[test]
    fn a_name_joins_the_list_and_the_template_takes_it() {
        let list = "macro_rules! experiments { () => {} }\n\nexperiments! { fig1 fig2 }\n";
        assert_eq!(with_name(list, "fig10").as_deref(), Some(&*list.replace("fig2 }", "fig2 fig10 }")));
        assert_eq!(with_name("nothing", "fig10"), None);
        let module = renamed(MODULE, "two_words");
        assert!(module.contains("pub struct TwoWords") && !module.to_lowercase().contains("template"));
    }
}
