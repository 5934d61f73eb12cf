//! What verbs that look at the graph share: configs planned, joined to a graph, beside a store and an output folder.

use crate::check::values_toml::{self, Change, Values};
use crate::cli::arguments::{PlaceArguments, RunArguments};
use crate::cli::collected;
use crate::cli::console;
use crate::cli::exit::Exit;
use crate::cli::page;
use crate::cli::workspace::{Loaded, Workspace, WorkspaceError};
use crate::contract::accuracy::Accuracy;
use crate::contract::code;
use crate::contract::node::{Address, Kind};
use crate::contract::plan::Plan;
use crate::contract::value::Findings;
use crate::experiments::definition::{FINDINGS_FILE, FINDINGS_NODE, MEASURED_FOLDER};
use crate::pipeline::graph::Graph;
use crate::pipeline::report::Report;
use crate::pipeline::run::Options;
use crate::pipeline::select::Selection;
use crate::pipeline::settled::{self, Question, Settled};
use crate::pipeline::store::Store;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The version of the store's format, which is the name of its folder.
pub const STORE_FORMAT: &str = crate::pipeline::store::FORMAT;

/// Everything planned, nothing run.
pub struct Session {
    /// Where things lie.
    pub workspace: Workspace,
    /// The experiments that the targets need.
    pub experiments: Vec<Loaded>,
    /// Their graph.
    pub graph: Graph,
    /// What of it the targets need.
    pub selection: Selection,
    /// The store.
    pub store: Store,
    /// How to run.
    pub options: Options,
}

/// Why a session can't begin: what to say, and how to end.
pub struct Refused {
    /// How the command ends.
    pub exit: Exit,
    /// What to say.
    pub text: String,
}

impl Refused {
    /// Says it, and gives the exit.
    pub fn tell(self) -> Exit {
        console::message(&format!("{} {}", console::paint("error:", "1;31"), self.text));
        self.exit
    }
}

impl From<WorkspaceError> for Refused {
    fn from(error: WorkspaceError) -> Self {
        let exit = match error {
            WorkspaceError::NoRoot { .. }
            | WorkspaceError::Unreadable { .. }
            | WorkspaceError::Accuracy(_)
            | WorkspaceError::UnknownTarget { .. } => Exit::Usage,
            WorkspaceError::Configs(_) => Exit::Config,
            WorkspaceError::Defect(_) => Exit::Defect,
        };
        Self { exit, text: error.to_string() }
    }
}

/// A list of errors, one a line.
fn lines<E: ToString>(errors: &[E]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

impl Session {
    /// Plans what the targets need; everything where there is none.
    ///
    /// # Errors
    /// Wrong configs, unknown targets, no place to work in.
    pub fn begin(place: &PlaceArguments, targets: &[String]) -> Result<Self, Refused> {
        Self::begin_in(Workspace::find(place)?, targets)
    }

    /// The same, with the experiments' measurements among what is planned.
    ///
    /// # Errors
    /// As [`Session::begin`].
    pub fn begin_measuring(place: &PlaceArguments, targets: &[String]) -> Result<Self, Refused> {
        Self::begin_in(Workspace { measure: true, ..Workspace::find(place)? }, targets)
    }

    fn begin_in(workspace: Workspace, targets: &[String]) -> Result<Self, Refused> {
        let folder = workspace.store.join(STORE_FORMAT);
        if let Some(file) = folder.ancestors().find(|path| path.exists()).filter(|path| !path.is_dir()) {
            let text =
                format!("{} is no folder, so the store can't be there\n  say where: --store DIR", file.display());
            return Err(Refused { exit: Exit::Store, text });
        }
        let targets: Vec<String> = targets.iter().map(|target| workspace.relative(target)).collect();
        let of_measurements = |target: &&String| target.starts_with(&format!("{MEASURED_FOLDER}/"));
        if let Some(target) = targets.iter().find(of_measurements).filter(|_| !workspace.measure) {
            let text = format!(
                "{target} is a measurement, which is part of nothing else\n  measure it: polhode figures {target} --measure"
            );
            return Err(Refused { exit: Exit::Usage, text });
        }
        // What is asked of values.toml is asked of the whole.
        let of_values = |target: &String| [collected::ID, collected::VALUES_FILE].contains(&target.as_str());
        let whole = targets.is_empty() || targets.iter().any(of_values);
        let experiments = workspace.load(if whole { &[] } else { &targets })?;
        let mut plans: Vec<_> = experiments.iter().map(|experiment| experiment.plan.clone()).collect();
        if whole {
            let ids: Vec<&str> = experiments.iter().map(|experiment| experiment.plan.id.as_str()).collect();
            let plan = collected::plan(&ids);
            plans.push(plan.map_err(|error| Refused { exit: Exit::Defect, text: error.to_string() })?);
            let has_article = experiments.iter().any(|experiment| experiment.kind != "scene");
            if has_article && workspace.accuracy.is_none_or(|level| level == Accuracy::Article) {
                let plan = page::plan(&experiments, workspace.has_source());
                plans.push(plan.map_err(|error| Refused { exit: Exit::Defect, text: error.to_string() })?);
            }
        }
        warm_listings(&plans);
        let graph = Graph::join(plans).map_err(|errors| Refused { exit: Exit::Defect, text: lines(&errors) })?;
        let selection =
            graph.select(&targets).map_err(|error| Refused { exit: Exit::Usage, text: error.to_string() })?;
        let store = Store::at(folder);
        let mut options = options(&workspace);
        if whole && !workspace.measure {
            let configs = experiments.iter().map(|loaded| (loaded.plan.id.as_str(), loaded.plan.config.text.as_str()));
            let measuring = experiments.iter().filter(|loaded| loaded.measures).map(|loaded| loaded.plan.id.as_str());
            let note = measuring.collect::<Vec<_>>().join(" ");
            options.question = Some(Question { digest: workspace.question(configs), note });
        }
        if whole {
            options.known_exports = Some(graph.export_paths());
        }
        Ok(Self { workspace, experiments, graph, selection, store, options })
    }

    /// The findings of an experiment, as stored for the present configs and code.
    ///
    /// # Errors
    /// What keeps them from being had.
    pub fn findings(&self, id: &str) -> Result<Findings, String> {
        let address = Address::new(id, FINDINGS_NODE);
        let bytes = crate::pipeline::stored::stored(&self.graph, &self.store, &self.options, &address, FINDINGS_FILE)
            .map_err(|error| error.to_string())?;
        collected::findings(&bytes).map_err(|error| error.to_string())
    }

    /// The named values that are not what they were after the last run, old → new.
    pub fn changed_values(&self, report: &Report) -> Vec<Change> {
        let (mut old, mut new) = (Values::new(), Values::new());
        for node in &report.nodes {
            if node.address.node != FINDINGS_NODE || node.previous == node.key {
                continue;
            }
            let read = |key: Option<crate::contract::digest::Digest>| {
                let bytes = self.store.artifact(key?, FINDINGS_FILE).ok()?;
                let values = collected::findings(&bytes).ok()?.values;
                Some(values.into_iter().map(|value| (value.name.clone(), value)).collect())
            };
            // A first run changes nothing: there was nothing.
            if let (Some(before), Some(now)) = (read(node.previous), read(node.key)) {
                old.insert(node.address.experiment.clone(), before);
                new.insert(node.address.experiment.clone(), now);
            }
        }
        values_toml::changes(&old, &new)
    }

    /// The experiments of a run with targets whose values are not those that values.toml holds.
    pub fn stale_in_values_file(&self) -> Vec<String> {
        let Ok(text) = std::fs::read_to_string(self.workspace.out.join(collected::VALUES_FILE)) else {
            return Vec::new();
        };
        let Ok(written) = values_toml::parse(&text) else { return Vec::new() };
        let mut stale = Vec::new();
        for experiment in &self.experiments {
            let id = &experiment.plan.id;
            let Ok(findings) = self.findings(id) else { continue };
            let now = findings.values.into_iter().map(|value| (value.name.clone(), value)).collect();
            let old = Values::from([(id.clone(), written.get(id).cloned().unwrap_or_default())]);
            if !values_toml::changes(&old, &Values::from([(id.clone(), now)])).is_empty() {
                stale.push(id.clone());
            }
        }
        stale
    }
}

/// Asks the disk whether a run of the whole would find nothing to do: nothing is planned, every byte is hashed. None where that is
/// not known.
pub fn settled(arguments: &RunArguments) -> Option<(Workspace, Settled)> {
    let workspace = Workspace::find(&arguments.place).ok()?;
    let mut configs = Vec::new();
    for (id, file) in workspace.configs().ok()? {
        configs.push((id, std::fs::read_to_string(file).ok()?));
    }
    let question = workspace.question(configs.iter().map(|(id, text)| (id.as_str(), text.as_str())));
    let store = Store::at(workspace.store.join(STORE_FORMAT));
    let mut options = options(&workspace);
    options.jobs = arguments.jobs.map_or(options.jobs, std::num::NonZeroUsize::get);
    let settled = settled::settled(&store, &options, &question)?;
    Some((workspace, settled))
}

/// How runs in a workspace go.
fn options(workspace: &Workspace) -> Options {
    let root = if workspace.root.as_os_str().is_empty() { PathBuf::from(".") } else { workspace.root.clone() };
    let mut options = Options::new(root, workspace.out.clone());
    options.unscanned = unscanned(workspace);
    options
}

/// Makes the code listings of all kinds on two threads: they are remembered, and half of what planning takes.
fn warm_listings(plans: &[Plan]) {
    let kinds: BTreeMap<&str, &'static Kind> = plans
        .iter()
        .flat_map(|plan| &plan.nodes)
        .map(|node| node.compute.kind())
        .map(|kind| (kind.name, kind))
        .collect();
    let kinds: Vec<&'static Kind> = kinds.into_values().collect();
    let (first, second) = kinds.split_at(kinds.len() / 2);
    // A kind whose code is not there is an error of the graph, which is joined next.
    let warm = |kinds: &[&'static Kind]| kinds.iter().for_each(|kind| drop(code::listing(kind)));
    std::thread::scope(|scope| {
        scope.spawn(|| warm(first));
        warm(second);
    });
}

/// The folders below the output folder that hold other things: measurements, other levels of accuracy.
fn unscanned(workspace: &Workspace) -> Vec<String> {
    let mut folders = vec![MEASURED_FOLDER.to_owned(), Accuracy::Draft.to_string(), Accuracy::Reference.to_string()];
    for entry in std::fs::read_dir(&workspace.out).into_iter().flatten().flatten() {
        if let Ok(name) = entry.file_name().into_string()
            && name.parse::<Accuracy>().is_ok()
            && !folders.contains(&name)
        {
            folders.push(name);
        }
    }
    folders
}
