//! `figures/article/index.html`: the page, as a node that reads what all experiments found, drew and computed; its CSV tables and TeX macros beside it.
//!
//! It belongs to the whole, like `values.toml`: runs with targets leave it alone, and so do levels of accuracy other than `article`.

use crate::article::content::{Content, MetricEffects, PageError, Part};
use crate::article::figure::csv_name;
use crate::article::page::page;
use crate::article::zip;
use crate::check::values_tex;
use crate::cli::collected;
use crate::cli::workspace::Loaded;
use crate::contract::digest::Digest;
use crate::contract::node::{Address, Artifact, Compute, Inputs, Kind, Node, NodeError, Product};
use crate::contract::plan::{Export, Plan};
use crate::contract::work::Work;
use crate::effects::product::{TABLE, input_table};
use crate::effects::scene::METRICS;
use crate::effects::spin::conjugate_loci::ConjugateLoci;
use crate::effects::spin::momenta::Momenta;
use crate::experiments;
use crate::experiments::definition::{
    FINDINGS_FILE, FINDINGS_NODE, MEASURED_FOLDER, MEASURED_PICTURE_NODE, PICTURE_FILE, PICTURE_NODE,
};
use crate::pipeline::graph::Graph;
use crate::pipeline::render::{Format, render};
use serde::Serialize;

/// The id of the plan.
pub const ID: &str = "article";
/// The folder below the output folder.
pub const FOLDER: &str = "article";
const PAGE_FILE: &str = "index.html";
const TEX_FILE: &str = "values.tex";
const LOCI: &str = "loci";
/// The kind of configs that stand for themselves.
const SCENE: &str = "scene";
/// The slider's values of k, in thousandths: from, to, step.
const LOCI_K: (u32, u32, u32) = (100, 1500, 25);
/// How its branches are sampled: coarser than the figures, since they are drawn small.
const LOCI_MOMENTA: Momenta = Momenta { from: 1e-9, to: 1e4, step: 0.2 };

/// The kind.
pub const KIND: Kind = Kind {
    name: "article",
    summary: "the page: figures, statements with verdicts, values, links",
    code: &[
        "article",
        "check",
        "cli/collected.rs",
        "cli/page.rs",
        "contract/claim.rs",
        "contract/value.rs",
        "effects/product.rs",
        "pipeline/diagram.rs",
        "pipeline/disk.rs",
        "pipeline/graph.rs",
        "pipeline/picture.rs",
        "pipeline/render.rs",
        "pipeline/select.rs",
        "table",
    ],
    measurement: false,
};

/// What the page says of an experiment beside what it reads.
#[derive(Clone, Debug, Serialize)]
struct Entry {
    id: String,
    title: &'static str,
    place: &'static str,
    /// Its module in this program's source.
    module: String,
    /// Whether that file lies where the page can link to it.
    has_source: bool,
    /// Names and paths of its tables.
    tables: Vec<(String, String)>,
}

/// Makes the page.
#[derive(Serialize)]
struct PageOf {
    entries: Vec<Entry>,
    metrics: Vec<(&'static str, Vec<&'static str>)>,
    /// The digest of what the graph's picture shows; the plans that it is drawn from are no leaves.
    graph: String,
    #[serde(skip)]
    plans: Vec<Plan>,
}

/// The plan that makes the page.
///
/// # Errors
/// Parameters that can't be written in a manifest.
pub fn plan(experiments: &[Loaded], has_source: bool) -> Result<Plan, NodeError> {
    let defect = |error: crate::contract::manifest::NotDescribable| NodeError::new(error.to_string());
    // Scenes are no part of the article.
    let mut in_order: Vec<&Loaded> = experiments.iter().filter(|loaded| loaded.kind != SCENE).collect();
    let rank = |loaded: &&Loaded| experiments::ALL.iter().position(|known| known.kind == loaded.kind);
    in_order.sort_by_key(rank);
    let entries: Vec<Entry> = in_order.iter().map(|loaded| entry(loaded, has_source)).collect();
    let metrics = METRICS
        .iter()
        .map(|(metric, effects)| (*metric, effects.iter().map(|effect| effect.name()).collect()))
        .collect();
    let (from, to, step) = LOCI_K;
    let k = (from..=to).step_by(step as usize).map(|k| f64::from(k) / 1000.0).collect();
    let loci = Node::new(Address::new(ID, LOCI), ConjugateLoci { k, p_theta: LOCI_MOMENTA }).map_err(defect)?;
    let plans: Vec<Plan> = in_order.iter().map(|loaded| without_measurements(&loaded.plan)).collect();
    let compute = PageOf { entries: entries.clone(), metrics, graph: graph_digest(&plans), plans };
    let mut node = Node::new(Address::new(ID, "page"), compute).map_err(defect)?.input(LOCI, &loci.address, TABLE);
    let export = |path: String, node: &Address, artifact: String| Export { path, from: node.clone(), artifact };
    let mut exports: Vec<Export> =
        [PAGE_FILE, TEX_FILE].map(|file| export(format!("{FOLDER}/{file}"), &node.address, file.to_owned())).into();
    for (loaded, entry) in in_order.iter().zip(&entries) {
        let id = &entry.id;
        node = node.input(picture_input(id), &Address::new(id.clone(), PICTURE_NODE), PICTURE_FILE).input(
            findings_input(id),
            &Address::new(id.clone(), FINDINGS_NODE),
            FINDINGS_FILE,
        );
        for made in tables_of(loaded) {
            let name = made.from.file_stem();
            node = node.input(table_input(id, &name), &made.from, TABLE);
        }
        if !entry.tables.is_empty() {
            let csv = csv_artifact(id);
            exports.push(export(format!("{FOLDER}/{csv}"), &node.address, csv));
        }
    }
    Ok(Plan { id: ID.to_owned(), nodes: vec![loci, node], exports, ..Plan::default() })
}

/// The tables that an experiment shows its readers.
fn tables_of(loaded: &Loaded) -> impl Iterator<Item = &Export> {
    loaded.plan.exports.iter().filter(|made| made.artifact == TABLE && made.path.starts_with("data/"))
}

fn entry(loaded: &Loaded, has_source: bool) -> Entry {
    let (id, module) = (loaded.plan.id.clone(), format!("src/experiments/{}.rs", loaded.kind));
    let tables = tables_of(loaded).map(|made| (made.from.file_stem(), made.path.clone())).collect();
    Entry { id, title: loaded.title, place: loaded.place, module, has_source, tables }
}

/// A plan as it is where nothing is measured: the page is the same before and after.
fn without_measurements(plan: &Plan) -> Plan {
    let mut plan = plan.clone();
    plan.exports.retain(|export| !export.path.starts_with(MEASURED_FOLDER));
    let is_kept = |node: &Node| !node.compute.kind().measurement && node.address.node != MEASURED_PICTURE_NODE;
    plan.nodes.retain(is_kept);
    plan
}

/// The digest of all addresses, kinds and edges.
fn graph_digest(plans: &[Plan]) -> String {
    let mut shown = String::new();
    for node in plans.iter().flat_map(|plan| &plan.nodes) {
        shown.push_str(&format!("{} {}\n", node.address, node.compute.kind().name));
        node.inputs.iter().for_each(|input| shown.push_str(&format!("  {}\n", input.from)));
    }
    Digest::of(shown.as_bytes()).to_string()
}

/// The picture of the plans' graph.
fn graph_picture(plans: &[Plan]) -> Result<String, NodeError> {
    let graph = Graph::join(plans.to_vec())
        .map_err(|errors| NodeError::new(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")))?;
    let selection = graph.all();
    let svg = render(&graph, &selection, Format::Svg);
    // Inside a page there is no prologue, and rules of style must not reach beyond the picture.
    let picture = svg.find("<svg").map_or("", |start| &svg[start..]);
    let Some((before, rest)) = picture.split_once("<style>") else { return Ok(picture.to_owned()) };
    let Some((style, after)) = rest.split_once("</style>") else { return Ok(picture.to_owned()) };
    let scoped: String = style.split_inclusive('}').map(|rule| format!(".graph {rule}")).collect();
    let before = before.replacen("<svg", "<svg class=\"graph\"", 1);
    Ok(format!("{before}<style>{scoped}</style>{after}"))
}

fn picture_input(id: &str) -> String {
    format!("picture/{id}")
}

fn findings_input(id: &str) -> String {
    format!("findings/{id}")
}

fn table_input(id: &str, name: &str) -> String {
    format!("table/{id}/{name}")
}

fn csv_artifact(id: &str) -> String {
    format!("csv/{id}.zip")
}

impl Compute for PageOf {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let mut parts = Vec::new();
        let mut artifacts = Vec::new();
        for Entry { id, title, place, module, has_source, tables } in &self.entries {
            let picture = String::from_utf8_lossy(&inputs.get(&picture_input(id))?.bytes).into_owned();
            let findings = collected::findings(&inputs.get(&findings_input(id))?.bytes)?;
            let (mut read, mut csv_files) = (Vec::new(), Vec::new());
            for (name, path) in tables {
                let table = input_table(inputs, &table_input(id, name))?;
                let csv = table.to_csv().map_err(|error| NodeError::new(format!("{id}/{name}: {error}")))?;
                csv_files.push((csv_name(name), csv.into_bytes()));
                read.push((name.clone(), path.clone(), table));
            }
            if !csv_files.is_empty() {
                artifacts.push(Artifact::opaque(csv_artifact(id), zip::archive(&csv_files)));
            }
            parts.push(Part {
                id: id.clone(),
                title: (*title).to_owned(),
                place: (*place).to_owned(),
                picture,
                findings,
                module: module.clone(),
                has_source: *has_source,
                tables: read,
            });
        }
        let metrics = self.metrics.iter().map(|(metric, effects)| MetricEffects {
            metric: (*metric).to_owned(),
            effects: effects.iter().map(|effect| (*effect).to_owned()).collect(),
        });
        let content = Content {
            parts,
            metrics: metrics.collect(),
            graph: graph_picture(&self.plans)?,
            loci: Some(input_table(inputs, LOCI)?),
        };
        let values = content.parts.iter().map(|part| (part.id.as_str(), part.findings.values.as_slice()));
        artifacts.push(Artifact::opaque(TEX_FILE, values_tex::write(values).into_bytes()));
        let page = page(&content).map_err(|error: PageError| NodeError::new(error.to_string()))?;
        artifacts.push(Artifact::opaque(PAGE_FILE, page.into_bytes()));
        Ok(Product { artifacts, work: Work::default() })
    }
}
