//! Where things lie: the root, the experiment configs, the output folder, the store; and the configs, planned.

use crate::cli::arguments::PlaceArguments;
use crate::contract::accuracy::{Accuracy, UnknownAccuracy};
use crate::contract::code;
use crate::contract::config::{self, ConfigError};
use crate::contract::digest::{Digest, Framed};
use crate::contract::plan::{ConfigSource, Plan};
use crate::experiments;
use crate::experiments::definition::{MEASURED_FOLDER, PlanError, Request};
use std::io;
use std::path::{Path, PathBuf};

/// The folder that holds the experiment configs.
pub const EXPERIMENTS: &str = "experiments";
/// The folder of the outputs.
pub const FIGURES: &str = "figures";
/// The folder of the store.
pub const STORE: &str = ".polhode";

/// Where things lie.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The folder of the configs.
    pub experiments: PathBuf,
    /// The folder of the outputs of this accuracy.
    pub out: PathBuf,
    /// The folder of the store.
    pub store: PathBuf,
    /// The folder that holds them all.
    pub root: PathBuf,
    /// The accuracy that the command line puts in place of the configs'.
    pub accuracy: Option<Accuracy>,
    /// Whether measurements are planned too.
    pub measure: bool,
}

/// An experiment, planned, and the digest of its config's values.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The plan.
    pub plan: Plan,
    /// The kind of experiment: the module.
    pub kind: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// Where it stands in the article.
    pub place: &'static str,
    /// The digest of its config's values.
    pub config_digest: Digest,
    /// Whether it has measurements, planned or not.
    pub measures: bool,
}

/// Why the configs can't be used.
#[derive(Debug, thiserror::Error)]
pub enum WorkspaceError {
    /// No folder of configs.
    #[error(
        "no folder {EXPERIMENTS}/ in {from} or any folder above it\n  run polhode inside its repository, or say where the configs are: --experiments DIR"
    )]
    NoRoot {
        /// Where the search began.
        from: String,
    },
    /// A folder or file that can't be read.
    #[error("{path} can't be read: {error}")]
    Unreadable {
        /// Which.
        path: String,
        /// Why.
        error: io::Error,
    },
    /// An accuracy that is not accepted.
    #[error("--accuracy: {0}")]
    Accuracy(#[from] UnknownAccuracy),
    /// Wrong configs: all of them, so that one run shows all.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Configs(Vec<ConfigError>),
    /// A target that is neither experiment, output nor node.
    #[error("no experiment, output or node is called {target:?}\n  experiments: {known}{nearest}")]
    UnknownTarget {
        /// What was asked for.
        target: String,
        /// The experiments there are.
        known: String,
        /// The nearest name, as a question.
        nearest: String,
    },
    /// A defect of an experiment.
    #[error("{0}")]
    Defect(String),
}

/// `\n  did you mean …?` where a name is near enough.
pub fn nearest<'a>(wanted: &str, known: impl Iterator<Item = &'a str>) -> String {
    known
        .map(|name| (strsim::damerau_levenshtein(wanted, name), name))
        .filter(|(distance, name)| *distance <= 1 + name.len() / 4)
        .min()
        .map_or_else(String::new, |(_, name)| format!("\n  did you mean {name:?}?"))
}

impl Workspace {
    /// Finds the folders that the options leave open.
    ///
    /// # Errors
    /// No folder of configs, or an accuracy that is not accepted.
    pub fn find(place: &PlaceArguments) -> Result<Self, WorkspaceError> {
        let accuracy: Option<Accuracy> = place.accuracy.as_deref().map(str::parse).transpose()?;
        let here = PathBuf::from(".");
        let experiments = match &place.experiments {
            Some(folder) => folder.clone(),
            None => {
                let from = std::env::current_dir()
                    .map_err(|error| WorkspaceError::Unreadable { path: here.display().to_string(), error })?;
                let root = from
                    .ancestors()
                    .find(|folder| folder.join(EXPERIMENTS).is_dir())
                    .ok_or_else(|| WorkspaceError::NoRoot { from: from.display().to_string() })?;
                // Relative where that is short: paths in messages are read by people.
                if root == from { PathBuf::from(EXPERIMENTS) } else { root.join(EXPERIMENTS) }
            }
        };
        let root = match experiments.parent() {
            Some(parent) if parent.as_os_str().is_empty() => PathBuf::new(),
            Some(parent) => parent.to_owned(),
            None => here,
        };
        let mut out = place.out.clone().unwrap_or_else(|| root.join(FIGURES));
        if let Some(level) = accuracy.filter(|level| *level != Accuracy::Article) {
            out = out.join(level.to_string());
        }
        let store = place.store.clone().unwrap_or_else(|| root.join(STORE));
        Ok(Self { experiments, out, store, root, accuracy, measure: false })
    }

    /// Whether the outputs lie in a clone of this program's repository, beside its source: then the page can link to it.
    pub fn has_source(&self) -> bool {
        self.out == self.root.join(FIGURES) && self.root.join("src").join(EXPERIMENTS).is_dir()
    }

    /// The configs there are: id and file, by id.
    ///
    /// # Errors
    /// A folder that can't be read.
    pub fn configs(&self) -> Result<Vec<(String, PathBuf)>, WorkspaceError> {
        let unreadable = |error| WorkspaceError::Unreadable { path: self.experiments.display().to_string(), error };
        let mut configs = Vec::new();
        for entry in std::fs::read_dir(&self.experiments).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            let is_config = path.extension().is_some_and(|ending| ending == "toml");
            if let Some(id) = path.file_stem().and_then(|stem| stem.to_str()).filter(|_| is_config) {
                configs.push((id.to_owned(), path.clone()));
            }
        }
        configs.sort_by_key(|(id, _)| sort_key(id));
        Ok(configs)
    }

    /// What a run of the whole is asked: the program, the accuracy, whether there is source to link to, and these configs, as (id, text).
    pub fn question<'a>(&self, configs: impl Iterator<Item = (&'a str, &'a str)>) -> Digest {
        let mut framed = Framed::new("polhode question 1");
        framed.field(&code::program().0);
        framed.field(self.accuracy.map(|level| level.to_string()).unwrap_or_default().as_bytes());
        framed.field(&[u8::from(self.has_source())]);
        for (id, text) in configs {
            framed.field(id.as_bytes()).field(text.as_bytes());
        }
        framed.finish()
    }

    /// Plans the experiments that the targets need; all where none is given. A target is an experiment's id, an output
    /// (`figures/fig7.svg`) or a node's address (`fig7/…`).
    ///
    /// # Errors
    /// Wrong configs, all of them; a target that nothing answers to.
    pub fn load(&self, targets: &[String]) -> Result<Vec<Loaded>, WorkspaceError> {
        let configs = self.configs()?;
        let mut wanted = Vec::new();
        for target in targets {
            wanted.push(self.experiment_of(target, &configs)?);
        }
        let mut loaded = Vec::new();
        let mut wrong = Vec::new();
        for (id, path) in &configs {
            if !wanted.is_empty() && !wanted.contains(id) {
                continue;
            }
            match load_one(id, path, Request { accuracy: self.accuracy, measure: self.measure }) {
                Ok(experiment) => loaded.push(experiment),
                Err(WorkspaceError::Configs(errors)) => wrong.extend(errors),
                Err(other) => return Err(other),
            }
        }
        if wrong.is_empty() { Ok(loaded) } else { Err(WorkspaceError::Configs(wrong)) }
    }

    /// The id of the experiment that a target belongs to.
    fn experiment_of(&self, target: &str, configs: &[(String, PathBuf)]) -> Result<String, WorkspaceError> {
        let inside = self.relative(target);
        let known = |id: &str| configs.iter().any(|(known, _)| known == id);
        let first = inside.split('/').next().unwrap_or_default();
        let below = |folder: &str| {
            let rest = inside.strip_prefix(folder).and_then(|rest| rest.strip_prefix('/'));
            rest.and_then(|rest| rest.split('/').next()).unwrap_or_default()
        };
        let candidates = [
            inside.strip_suffix(".svg").unwrap_or(&inside).to_owned(),
            first.to_owned(),
            below("data").to_owned(),
            below(MEASURED_FOLDER).trim_end_matches(".svg").to_owned(),
        ];
        candidates.into_iter().find(|candidate| known(candidate)).ok_or_else(|| WorkspaceError::UnknownTarget {
            target: target.to_owned(),
            known: configs.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>().join(", "),
            nearest: nearest(first, configs.iter().map(|(id, _)| id.as_str())),
        })
    }

    /// A target without the path of the output folder in front of it.
    pub fn relative(&self, target: &str) -> String {
        let path = Path::new(target);
        for folder in [self.out.as_path(), Path::new(FIGURES)] {
            if let Ok(rest) = path.strip_prefix(folder) {
                return rest.to_string_lossy().into_owned();
            }
        }
        target.trim_start_matches("./").to_owned()
    }
}

/// Numbers in ids sort as numbers: fig2 before fig10.
fn sort_key(id: &str) -> (String, u64, String) {
    let stem: String = id.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    let number = id[stem.len()..].parse().unwrap_or(0);
    (stem, number, id.to_owned())
}

fn load_one(id: &str, path: &Path, request: Request) -> Result<Loaded, WorkspaceError> {
    let file = path.display().to_string();
    let text =
        std::fs::read_to_string(path).map_err(|error| WorkspaceError::Unreadable { path: file.clone(), error })?;
    let kind = config::peek_kind(&file, &text).map_err(|error| WorkspaceError::Configs(vec![error]))?;
    let experiment = experiments::ALL.iter().find(|experiment| experiment.kind == kind).ok_or_else(|| {
        let known: Vec<&str> = experiments::ALL.iter().map(|experiment| experiment.kind).collect();
        WorkspaceError::Configs(vec![config::unknown_kind(&file, &text, &known)])
    })?;
    let planned =
        experiment.plan_requested(id, &ConfigSource { file, text }, request).map_err(|error| match error {
            PlanError::Config(error) => WorkspaceError::Configs(vec![*error]),
            PlanError::Defect { .. } => WorkspaceError::Defect(error.to_string()),
        })?;
    Ok(Loaded {
        plan: planned.plan,
        kind: experiment.kind,
        title: experiment.title,
        place: experiment.place,
        config_digest: planned.config_digest,
        measures: experiment.measures,
    })
}
