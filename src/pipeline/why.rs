//! `why TARGET`: the forecast of what stands behind a target, with the origin of the target's file, as data and as text.

use super::exports;
use super::forecast::{ExportForecast, Forecast, NodeForecast, Prospect, forecast};
use super::graph::Graph;
use super::report::ExportStatus;
use super::run::Options;
use super::select::UnknownTarget;
use super::store::Store;
use crate::contract::digest::Digest;
use serde::Serialize;
use std::fmt::Write;

/// Which stored work a file's bytes come from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Origin {
    /// The digest of the file's bytes.
    pub object: Digest,
    /// The key of the record that has them among its outputs.
    pub key: Digest,
    /// The artifact's name in that record.
    pub artifact: String,
    /// What that record was made with, a line each: `param k = 0.8`.
    pub made_with: Vec<String>,
}

/// Why a target will, or will not, be made anew.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Why {
    /// The target, as asked for.
    pub target: String,
    /// What a run would do.
    pub forecast: Forecast,
    /// Where the target's present bytes come from, when it is an output that is there; empty when nothing in the store
    /// made them.
    pub origins: Vec<Origin>,
}

/// Explains a target: an experiment, an output's path, or a node's address. Writes nothing.
///
/// # Errors
/// A target that names nothing.
pub fn why(graph: &Graph, store: &Store, options: &Options, target: &str) -> Result<Why, UnknownTarget> {
    let selection = graph.select(&[target])?;
    let forecast = forecast(graph, &selection, store, options);
    let is_file = forecast.exports.iter().any(|export| export.path == target);
    let origins = if is_file { origins(store, options, target) } else { Vec::new() };
    Ok(Why { target: target.to_owned(), forecast, origins })
}

/// The stored work that made the bytes which a file in the output folder has now.
pub fn origins(store: &Store, options: &Options, path: &str) -> Vec<Origin> {
    let Ok((object, _)) = store.disk().hash(&exports::file_of(&options.out, path)) else { return Vec::new() };
    let found = store.made_by(object).unwrap_or_default();
    let origin = |(key, artifact)| {
        let manifest = store.manifest(key).unwrap_or_default();
        let lines = manifest.lines.iter().map(|line| format!("{} {} = {}", line.part.name(), line.path, line.leaf));
        Origin { object, key, artifact, made_with: lines.collect() }
    };
    found.into_iter().map(origin).collect()
}

impl Why {
    /// The text form: what will run first, with its reasons and what follows; then the outputs.
    pub fn text(&self) -> String {
        let mut text = self.forecast.text();
        for origin in &self.origins {
            let _ = writeln!(text, "{} holds {} of record {}", self.target, origin.artifact, origin.key.short());
        }
        text
    }
}

impl Forecast {
    /// The text form: what will run first, with its reasons and what follows; then the outputs.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let up_to_date = self.with(Prospect::UpToDate).count();
        for prospect in [Prospect::WillRun, Prospect::WillRestore, Prospect::MayRun] {
            self.with(prospect).for_each(|node| node_text(node, &mut text));
        }
        let changing = self.exports.iter().filter(|export| !export.is_unchanged());
        for export in changing {
            let _ = writeln!(text, "{}: {}", export.path, export_text(export));
        }
        let nodes = self.nodes.len();
        let _ = match (up_to_date == nodes, self.is_idle()) {
            (_, true) => {
                writeln!(text, "nothing to do: {nodes} nodes and {} outputs are up to date", self.exports.len())
            }
            (true, false) => writeln!(text, "{nodes} nodes are up to date"),
            _ => writeln!(text, "{up_to_date} of {nodes} nodes are up to date"),
        };
        text
    }
}

fn node_text(node: &NodeForecast, text: &mut String) {
    let what = match node.prospect {
        Prospect::UpToDate => "is up to date",
        Prospect::WillRestore => "will be restored",
        Prospect::WillRun => "will run",
        Prospect::MayRun => "may run",
    };
    let last = node.last_seconds.map_or_else(String::new, |seconds| format!(" (last time {seconds:.2} s)"));
    let _ = writeln!(text, "{} {what}{last}", node.address);
    for reason in &node.reasons {
        let _ = writeln!(text, "    {reason}");
    }
    if !node.follows.is_empty() {
        let _ = writeln!(text, "    then may follow: {}", node.follows.join(", "));
    }
}

fn export_text(export: &ExportForecast) -> String {
    match &export.status {
        None => "will be written if its node changes it".to_owned(),
        Some(ExportStatus::Unchanged) => "is up to date".to_owned(),
        Some(ExportStatus::New) => "will be written".to_owned(),
        Some(ExportStatus::Updated) => "will be brought up to date from the store".to_owned(),
        Some(ExportStatus::Repaired(fault)) => format!("is {fault}; will be restored from the store"),
        Some(ExportStatus::Replaced) => "was not made by this store; will be replaced".to_owned(),
        Some(other) => format!("{other:?}"),
    }
}
