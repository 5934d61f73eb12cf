//! What a run would do, and why, without writing anything: behind `--dry-run`, `why`, `show`.
//!
//! Walks the graph as a run does and examines the store in the same way, so it can't say something else than what the
//! run will do. Past a node that would run, keys are not known: what follows *may* run, since its input may come out
//! as it was.

use super::exports::{self, Wanted};
use super::graph::Graph;
use super::heads::{self, Heads};
use super::parallel;
use super::reason::{self, Reason};
use super::record::Record;
use super::report::{ExportStatus, as_text};
use super::run::{Options, read_heads};
use super::select::Selection;
use super::store::{Examined, Lacking, Store};
use crate::contract::digest::Digest;
use crate::contract::node::Address;
use serde::Serialize;
use std::collections::{BTreeSet, HashMap};

/// What would become of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Prospect {
    /// Its result is in the store, whole.
    UpToDate,
    /// Its result is in the store but for objects that are whole in the output folder, and will be brought back.
    WillRestore,
    /// It will run.
    WillRun,
    /// A node that it needs will run; if that changes an input, it will run too.
    MayRun,
}

/// A node, as a run would find it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NodeForecast {
    /// Where it stands.
    #[serde(serialize_with = "as_text")]
    pub address: Address,
    /// Its kind.
    pub kind: &'static str,
    /// Its key, when it is known.
    pub key: Option<Digest>,
    /// What would become of it.
    pub prospect: Prospect,
    /// Why.
    pub reasons: Vec<Reason>,
    /// The selected nodes that follow from it, each after those it reads from; empty when it is up to date.
    pub follows: Vec<String>,
    /// How long it took the last time it ran, in seconds.
    pub last_seconds: Option<f64>,
}

/// An output, as a run would find it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ExportForecast {
    /// Its path below the output folder.
    pub path: String,
    /// The node that makes it.
    #[serde(serialize_with = "as_text")]
    pub from: Address,
    /// The digest of the bytes it should have, when it is known.
    pub object: Option<Digest>,
    /// What would become of it; none when its node runs or may run.
    pub status: Option<ExportStatus>,
}

impl ExportForecast {
    /// Whether a run is known to leave it as it is.
    pub fn is_unchanged(&self) -> bool {
        self.status == Some(ExportStatus::Unchanged)
    }
}

/// What a run would do.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Forecast {
    /// The nodes, each after those that it reads from.
    pub nodes: Vec<NodeForecast>,
    /// The outputs.
    pub exports: Vec<ExportForecast>,
}

impl Forecast {
    /// Whether a run would do nothing at all.
    pub fn is_idle(&self) -> bool {
        self.nodes.iter().all(|node| node.prospect == Prospect::UpToDate)
            && self.exports.iter().all(ExportForecast::is_unchanged)
    }

    /// The nodes of a prospect.
    pub fn with(&self, prospect: Prospect) -> impl Iterator<Item = &NodeForecast> {
        self.nodes.iter().filter(move |node| node.prospect == prospect)
    }
}

/// A node on the walk.
#[derive(Clone, Debug, Default)]
struct Seen {
    is_needed: bool,
    waiting: usize,
    key: Option<Digest>,
    record: Option<Record>,
    prospect: Option<Prospect>,
    reasons: Vec<Reason>,
}

/// Says what [`super::run::run`] would do with the same arguments. Writes nothing, takes no lock.
pub fn forecast(graph: &Graph, selection: &Selection, store: &Store, options: &Options) -> Forecast {
    let view = heads::view(&options.root, &options.out);
    let (heads, _) = read_heads(graph, selection, store, &view);
    let mut walk = Walk { graph, store, options, heads: &heads, seen: vec![Seen::default(); graph.nodes.len()] };
    walk.all(selection);
    let nodes = selection.nodes.iter().map(|&node| walk.node(node)).collect();
    let exports = parallel::map(&selection.exports, options.jobs, |&export| walk.export(export));
    Forecast { nodes, exports }
}

struct Walk<'a> {
    graph: &'a Graph,
    store: &'a Store,
    options: &'a Options,
    heads: &'a [Heads],
    seen: Vec<Seen>,
}

impl Walk<'_> {
    fn all(&mut self, selection: &Selection) {
        let mut ready = Vec::new();
        for &node in &selection.nodes {
            let inputs = self.graph.nodes[node].inputs.iter().collect::<BTreeSet<_>>().len();
            self.seen[node].is_needed = true;
            self.seen[node].waiting = inputs;
            if inputs == 0 {
                ready.push(node);
            }
        }
        let mut known: HashMap<Digest, Examined> = HashMap::new();
        while !ready.is_empty() {
            let keys: Vec<(usize, Option<Vec<Digest>>)> = ready.drain(..).map(|n| (n, self.inputs(n))).collect();
            let graph = self.graph;
            let keyed = parallel::map(&keys, self.options.jobs, |(node, inputs)| {
                inputs.as_ref().map(|inputs| graph.key(*node, inputs))
            });
            let fresh: BTreeSet<Digest> =
                keyed.iter().flatten().filter(|key| !known.contains_key(*key)).copied().collect();
            let fresh: Vec<Digest> = fresh.into_iter().collect();
            let found = parallel::map(&fresh, self.options.jobs, |key| self.store.examine(*key));
            known.extend(fresh.into_iter().zip(found));
            for ((node, inputs), key) in keys.iter().zip(keyed) {
                let examined = key.and_then(|key| known.get(&key));
                self.judge(*node, key, inputs.as_deref(), examined);
                for &dependent in &graph.nodes[*node].dependents {
                    let seen = &mut self.seen[dependent];
                    if seen.is_needed {
                        seen.waiting -= 1;
                        if seen.waiting == 0 {
                            ready.push(dependent);
                        }
                    }
                }
            }
        }
    }

    /// The logical digests of a node's inputs, when all are known.
    fn inputs(&self, node: usize) -> Option<Vec<Digest>> {
        let placed = &self.graph.nodes[node];
        let named = placed.node.inputs.iter().zip(&placed.inputs);
        named.map(|(input, &from)| Some(self.seen[from].record.as_ref()?.output(&input.artifact)?.logical)).collect()
    }

    fn judge(&mut self, node: usize, key: Option<Digest>, inputs: Option<&[Digest]>, examined: Option<&Examined>) {
        let address = self.graph.address(node).to_string();
        let plan = self.graph.nodes[node].plan;
        let head = self.heads[plan].nodes.get(&address).map(|head| head.key);
        let record_path = |key| self.store.record_path(key).display().to_string();
        let mut reasons = Vec::new();
        let (prospect, record) = match (key, examined) {
            (Some(_), Some(Examined::Sound(record))) => (Prospect::UpToDate, Some(record.clone())),
            (Some(_), Some(Examined::Lacking(record, lacking))) => {
                let prospect = self.lacking(node, lacking, &mut reasons);
                (prospect, Some(record.clone()))
            }
            (Some(key), Some(Examined::Broken(fault))) => {
                reasons.push(Reason::RecordDamaged { record: record_path(key), fault: fault.clone() });
                (Prospect::WillRun, None)
            }
            (Some(key), Some(Examined::Absent)) => {
                if head == Some(key) {
                    reasons.push(Reason::RecordMissing { record: record_path(key) });
                } else {
                    reasons.extend(reason::changes(self.graph, self.store, node, head, inputs));
                }
                (Prospect::WillRun, None)
            }
            _ => {
                // What changed besides the inputs is known already.
                if head.is_some() {
                    reasons.extend(reason::changes(self.graph, self.store, node, head, None));
                }
                reasons.extend(self.upstream(node));
                (Prospect::MayRun, None)
            }
        };
        let is_forced = self.options.force && prospect != Prospect::MayRun;
        if is_forced && prospect != Prospect::WillRun {
            reasons.push(Reason::Forced);
        }
        let prospect = if is_forced { Prospect::WillRun } else { prospect };
        let seen = &mut self.seen[node];
        (seen.key, seen.record, seen.prospect, seen.reasons) = (key, record, Some(prospect), reasons);
    }

    fn upstream(&self, node: usize) -> Vec<Reason> {
        let placed = &self.graph.nodes[node];
        let from: BTreeSet<usize> =
            placed.inputs.iter().copied().filter(|from| self.seen[*from].record.is_none()).collect();
        from.into_iter().map(|from| Reason::Upstream { node: self.graph.address(from).to_string() }).collect()
    }

    fn lacking(&self, node: usize, lacking: &[Lacking], reasons: &mut Vec<Reason>) -> Prospect {
        let mut prospect = Prospect::WillRestore;
        for Lacking { output, fault } in lacking {
            let exports = self.graph.nodes[node].exports.iter().map(|export| &self.graph.exports[*export].export);
            let mut files = exports.filter(|export| export.artifact == output.name);
            let restored_from = files.find(|export| {
                let file = exports::file_of(&self.options.out, &export.path);
                exports::standing(self.store.disk(), &file, output.object) == exports::Standing::Right
            });
            if restored_from.is_none() {
                prospect = Prospect::WillRun;
            }
            reasons.push(Reason::ObjectDamaged {
                artifact: output.name.clone(),
                object: self.store.object_path(output.object).display().to_string(),
                fault: fault.clone(),
                restored_from: restored_from.map(|export| export.path.clone()),
            });
        }
        prospect
    }

    fn node(&self, node: usize) -> NodeForecast {
        let placed = &self.graph.nodes[node];
        let seen = &self.seen[node];
        let prospect = seen.prospect.unwrap_or(Prospect::MayRun);
        let follows = if prospect == Prospect::WillRun { self.follows(node) } else { Vec::new() };
        let head = self.heads[placed.plan].nodes.get(&placed.node.address.to_string());
        NodeForecast {
            address: placed.node.address.clone(),
            kind: placed.node.compute.kind().name,
            key: seen.key,
            prospect,
            reasons: seen.reasons.clone(),
            follows,
            last_seconds: head.and_then(|head| head.duration()).map(|duration| duration.as_secs_f64()),
        }
    }

    /// The nodes that may run because this one does.
    fn follows(&self, node: usize) -> Vec<String> {
        let mut reached = BTreeSet::new();
        let mut open = vec![node];
        while let Some(at) = open.pop() {
            for &dependent in &self.graph.nodes[at].dependents {
                if self.seen[dependent].prospect == Some(Prospect::MayRun) && reached.insert(dependent) {
                    open.push(dependent);
                }
            }
        }
        let order = self.graph.order.iter().filter(|node| reached.contains(node));
        order.map(|node| self.graph.address(*node).to_string()).collect()
    }

    fn export(&self, export: usize) -> ExportForecast {
        let placed = &self.graph.exports[export];
        let (path, from) = (placed.export.path.clone(), placed.export.from.clone());
        let seen = &self.seen[placed.node];
        let object = seen.record.as_ref().and_then(|record| record.output(&placed.export.artifact)).map(|o| o.object);
        let is_settled = matches!(seen.prospect, Some(Prospect::UpToDate | Prospect::WillRestore));
        let status = object.filter(|_| is_settled).map(|object| {
            let file = exports::file_of(&self.options.out, &path);
            let last = self.heads[placed.plan].exports.get(&path).copied();
            exports::judge(self.store, &Wanted { file, object, last })
        });
        ExportForecast { path, from, object, status }
    }
}
