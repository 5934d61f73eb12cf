//! What an experiment is: parameters from TOML, the nodes that it asks for, a picture, named values and claims.
//!
//! A module implements [`Definition`]; [`Experiment::of`] makes the constant that the command knows it by. Planning turns
//! one config into a [`Plan`]: the compute nodes, and two more that read their tables, the picture and the findings.

use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::config::{self, ConfigError, Validate};
use crate::contract::digest::Digest;
use crate::contract::manifest::{self, Manifest};
use crate::contract::node::{Address, Artifact, Compute, Inputs, Kind, Node, NodeError, Product};
use crate::contract::plan::{ConfigSource, Export, Plan};
use crate::contract::value::{Findings, NamedValue};
use crate::contract::work::Work;
use crate::experiments::nodes::Nodes;
use crate::experiments::scenes::more::Asked;
use crate::plot::error::PlotError;
use crate::plot::picture::{Picture, Width};
use crate::plot::render;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Serialize, Serializer};

/// The output of a picture node.
pub const PICTURE_FILE: &str = "picture.svg";
/// Another output of a picture node, but of measurements: the same page for LaTeX.
pub const PDF_FILE: &str = "picture.pdf";
/// And its third: the values of its config, without comments, as a config that makes the same figure.
pub const CONFIG_FILE: &str = "config.toml";
/// The output of a findings node.
pub const FINDINGS_FILE: &str = "findings.json";
/// The name of the node that draws an experiment.
pub const PICTURE_NODE: &str = "picture";
/// The name of the node that draws what an experiment measured.
pub const MEASURED_PICTURE_NODE: &str = "measured-picture";
/// The name of the node that holds an experiment's values and claims.
pub const FINDINGS_NODE: &str = "findings";

/// Height of a picture without panels of its own: that of its legend (mm).
const LEGEND_MM: f64 = 6.0;

/// The place of an experiment that the article does not have.
pub const NOT_IN_ARTICLE: &str = "not in the article";

/// An experiment, as its module writes it.
pub trait Definition: 'static {
    /// The config's content beside `kind = "…"`.
    type Params: Serialize + DeserializeOwned + JsonSchema + Validate + Clone + Send + Sync;

    /// The module's name, and the `kind` of its configs.
    const ID: &'static str;
    /// What it shows, in a few words.
    const TITLE: &'static str;
    /// Where it stands in the article.
    const PLACE: &'static str;
    /// The kind of its picture node: see [`picture_kind`].
    const PICTURE: &'static Kind;
    /// The kind of its findings node: see [`findings_kind`].
    const FINDINGS: &'static Kind;

    /// Puts the command line's accuracy in place of the config's.
    fn set_accuracy(params: &mut Self::Params, accuracy: Accuracy);

    /// The accuracy that the whole was made with, for its caption; none where an experiment is about several.
    fn accuracy(_: &Self::Params) -> Option<Accuracy> {
        None
    }

    /// Which of the scene's effects are this experiment's own, and what else its metric is asked for: that is computed and drawn beside it.
    fn asked(_: &Self::Params) -> Asked {
        Asked::own()
    }

    /// Asks for nodes. This and what follows is left out where the scene calls for no effect of the experiment's own.
    ///
    /// # Errors
    /// Parameters that can't be turned into nodes.
    fn nodes(params: &Self::Params, nodes: &mut Nodes) -> Result<(), NodeError>;

    /// The picture of the tables.
    ///
    /// # Errors
    /// A table that is missing or can't be drawn.
    fn picture(params: &Self::Params, tables: &Tables) -> Result<Picture, NodeError>;

    /// The named values in the tables.
    ///
    /// # Errors
    /// A table that is missing, or without the value.
    fn values(params: &Self::Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError>;

    /// The article's claims, with the evidence that the tables hold.
    ///
    /// # Errors
    /// A table that is missing, or without the evidence.
    fn claims(params: &Self::Params, tables: &Tables) -> Result<Vec<Claim>, NodeError>;

    /// What it measures on demand; most measure nothing.
    const MEASURED: Option<Measured<Self::Params>> = None;
}

/// What an experiment measures when `--measure` asks for it: times, which no committed file, value or claim may hold.
pub struct Measured<P> {
    /// The kind of the picture node that draws the measurements: see [`picture_kind`].
    pub picture_kind: &'static Kind,
    /// Asks for nodes, whose kinds are measurements.
    pub nodes: fn(&P, &mut Nodes) -> Result<(), NodeError>,
    /// The picture of their tables.
    pub picture: fn(&P, &Tables) -> Result<Picture, NodeError>,
}

/// What is asked of a plan beside what the config says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Request {
    /// Put in place of the config's accuracy.
    pub accuracy: Option<Accuracy>,
    /// Whether the experiment's measurements are part of the plan.
    pub measure: bool,
}

/// The folder of measurements below the output folder: nothing in it is committed or compared.
pub const MEASURED_FOLDER: &str = "measured";

/// The kind of a picture node whose code is in `code`: the experiment's own file with all that it draws by, how experiments are read and
/// combined with scenes, and the plot and table rooms; not what it plans by.
pub const fn picture_kind(name: &'static str, code: &'static [&'static str]) -> Kind {
    Kind { name, summary: "the figure, drawn from its tables", code, measurement: false }
}

/// The kind of a findings node whose code is in `code`: the experiment's own file with all that it reads values and claims by, how
/// experiments are read and combined with scenes, the form of claims and values, and the table room; not what it plans or draws by.
pub const fn findings_kind(name: &'static str, code: &'static [&'static str]) -> Kind {
    Kind { name, summary: "named values and evidence for the claims, read from the tables", code, measurement: false }
}

/// One experiment, as the command knows it.
#[derive(Clone, Copy)]
pub struct Experiment {
    /// The module's name, and the `kind` of its configs.
    pub kind: &'static str,
    /// What it shows, in a few words.
    pub title: &'static str,
    /// Where it stands in the article.
    pub place: &'static str,
    /// Whether it has measurements.
    pub measures: bool,
    plan: fn(&str, &ConfigSource, Request) -> Result<Planned, PlanError>,
    schema: fn() -> serde_json::Value,
}

/// A plan, and the digest of the config it was made from (of its values: layout and comments are free).
#[derive(Clone, Debug)]
pub struct Planned {
    /// The plan.
    pub plan: Plan,
    /// The digest of the canonical form of the config's values.
    pub config_digest: Digest,
}

/// Why a config gives no plan.
#[derive(Clone, Debug, thiserror::Error)]
pub enum PlanError {
    /// The config is wrong.
    #[error("{0}")]
    Config(Box<ConfigError>),
    /// The experiment can't write down its own nodes: a defect.
    #[error("experiment {id}: {error}")]
    Defect {
        /// The experiment.
        id: String,
        /// What went wrong.
        error: NodeError,
    },
}

impl Experiment {
    /// The constant of a definition.
    pub const fn of<D: Definition>() -> Self {
        Self {
            kind: D::ID,
            title: D::TITLE,
            place: D::PLACE,
            measures: D::MEASURED.is_some(),
            plan: plan::<D>,
            schema: config::schema::<D::Params>,
        }
    }

    /// The JSON schema of its configs, made from the types that read them.
    pub fn schema(&self) -> serde_json::Value {
        let describing = format!("Config of {} ({})", self.title, self.place);
        config::with_kind((self.schema)(), self.kind, &describing)
    }

    /// Reads a config and plans its nodes; `id` is the stem of the config's file name.
    ///
    /// # Errors
    /// A wrong config, by file, line, column and key.
    pub fn plan(&self, id: &str, source: &ConfigSource, accuracy: Option<Accuracy>) -> Result<Planned, PlanError> {
        self.plan_requested(id, source, Request { accuracy, measure: false })
    }

    /// The same with all that can be asked of a plan.
    ///
    /// # Errors
    /// As [`Experiment::plan`].
    pub fn plan_requested(&self, id: &str, source: &ConfigSource, request: Request) -> Result<Planned, PlanError> {
        (self.plan)(id, source, request)
    }
}

fn plan<D: Definition>(id: &str, source: &ConfigSource, request: Request) -> Result<Planned, PlanError> {
    let mut params: D::Params =
        config::read(&source.file, &source.text).map_err(|error| PlanError::Config(Box::new(error)))?;
    let defect = |error: NodeError| PlanError::Defect { id: id.to_owned(), error };
    let undescribable = |error: manifest::NotDescribable| defect(NodeError::new(error.to_string()));
    if let Some(accuracy) = request.accuracy {
        D::set_accuracy(&mut params, accuracy);
    }
    let mut config = Manifest { lines: manifest::describe(&params).map_err(undescribable)? };
    config.push(manifest::Part::Kind, "", manifest::Leaf::Text(D::ID.to_owned()));

    let mut nodes = Nodes::new(id);
    let asked = D::asked(&params);
    if asked.own {
        D::nodes(&params, &mut nodes).map_err(defect)?;
    }
    asked.nodes(&mut nodes).map_err(defect)?;
    let (nodes, tables) = nodes.finish();
    let mut plan = Plan { id: id.to_owned(), config: source.clone(), nodes, exports: Vec::new() };
    for (_, address) in &tables {
        plan.exports.push(Export {
            path: format!("data/{id}/{}.parquet", address.file_stem()),
            from: address.clone(),
            artifact: crate::effects::product::TABLE.to_owned(),
        });
    }
    if let Some(measured) = D::MEASURED.filter(|_| request.measure) {
        add_measurements(id, &params, &measured, &mut plan).map_err(defect)?;
    }
    let readers: [(&str, &str, Node); 2] = [
        (PICTURE_FILE, "svg", {
            let (id, params) = (id.to_owned(), params.clone());
            let reader = Picturing { id: id.clone(), params, kind: D::PICTURE, draw: drawn::<D>, of: Some(D::ID) };
            Node::new(Address::new(id, PICTURE_NODE), reader).map_err(undescribable)?.origin(CONFIG, "")
        }),
        (FINDINGS_FILE, "json", {
            Node::new(Address::new(id, FINDINGS_NODE), Finding::<D> { params }).map_err(undescribable)?
        }),
    ];
    for (artifact, ending, mut node) in readers {
        for (name, address) in &tables {
            node = node.input(name.clone(), address, crate::effects::product::TABLE);
        }
        let path = if ending == "svg" { format!("{id}.svg") } else { format!("data/{id}/{FINDINGS_FILE}") };
        plan.exports.push(Export { path, from: node.address.clone(), artifact: artifact.to_owned() });
        if ending == "svg" {
            let files =
                [(format!("article/pdf/{id}.pdf"), PDF_FILE), (format!("article/config/{id}.toml"), CONFIG_FILE)];
            plan.exports.extend(files.map(|(path, artifact)| {
                let (from, artifact) = (node.address.clone(), artifact.to_owned());
                Export { path, from, artifact }
            }));
        }
        plan.nodes.push(node);
    }
    Ok(Planned { plan, config_digest: config.key() })
}

/// Adds the nodes that measure, and the picture of what they measured.
fn add_measurements<P: Serialize + Clone + Send + Sync + 'static>(
    id: &str,
    params: &P,
    measured: &Measured<P>,
    plan: &mut Plan,
) -> Result<(), NodeError> {
    let mut nodes = Nodes::new(id);
    (measured.nodes)(params, &mut nodes)?;
    let (nodes, tables) = nodes.finish();
    let undescribable = |error: manifest::NotDescribable| NodeError::new(error.to_string());
    let (name, params) = (id.to_owned(), params.clone());
    let reader = Picturing { id: name, params, kind: measured.picture_kind, draw: measured.picture, of: None };
    let mut picture =
        Node::new(Address::new(id, MEASURED_PICTURE_NODE), reader).map_err(undescribable)?.origin(CONFIG, "");
    let mut export = |path: String, from: &Address, artifact: &str| {
        plan.exports.push(Export { path, from: from.clone(), artifact: artifact.to_owned() });
    };
    for (name, address) in &tables {
        let path = format!("{MEASURED_FOLDER}/{id}/{}.parquet", address.file_stem());
        export(path, address, crate::effects::product::TABLE);
        picture = picture.input(name.clone(), address, crate::effects::product::TABLE);
    }
    export(format!("{MEASURED_FOLDER}/{id}.svg"), &picture.address, PICTURE_FILE);
    plan.nodes.extend(nodes);
    plan.nodes.push(picture);
    Ok(())
}

fn read_tables(inputs: &Inputs) -> Result<Tables, NodeError> {
    let mut tables = Tables::new();
    for (name, file) in inputs.iter() {
        let table =
            Table::from_parquet(&file.bytes).map_err(|error| NodeError::new(format!("table {name}: {error}")))?;
        tables.insert(name, table).map_err(|error| NodeError::new(error.to_string()))?;
    }
    Ok(tables)
}

/// The picture of what the scene asks for: the experiment's own, with what else is computed drawn under it.
fn drawn<D: Definition>(params: &D::Params, tables: &Tables) -> Result<Picture, NodeError> {
    let asked = D::asked(params);
    let own = if asked.own { D::picture(params, tables)? } else { Picture::new(Width::Double, LEGEND_MM, D::TITLE) };
    let mut picture = asked.drawn_under(own, tables)?;
    if let Some(accuracy) = D::accuracy(params) {
        picture.caption = format!("{} Accuracy: {}.", picture.caption, accuracy.in_words()).trim_start().to_owned();
    }
    Ok(picture)
}

/// The node that draws.
struct Picturing<P> {
    id: String,
    params: P,
    kind: &'static Kind,
    draw: fn(&P, &Tables) -> Result<Picture, NodeError>,
    /// The `kind` of its configs, for the page and the config beside the figure; none for a picture of measurements, which has neither.
    of: Option<&'static str>,
}

/// Where the leaves of a picture's parameters stand in its manifest.
const CONFIG: &str = "config";

/// The picture names its experiment and shows its parameters, so both are leaves of its manifest.
impl<P: Serialize> Serialize for Picturing<P> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Leaves<'a, P> {
            id: &'a str,
            config: &'a P,
        }
        Leaves { id: &self.id, config: &self.params }.serialize(serializer)
    }
}

impl<P: Serialize + Send + Sync> Compute for Picturing<P> {
    fn kind(&self) -> &'static Kind {
        self.kind
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let tables = read_tables(inputs)?;
        let mut picture = (self.draw)(&self.params, &tables)?;
        picture.metadata.push(("experiment".to_owned(), self.id.clone()));
        for line in manifest::describe(&self.params).map_err(|error| NodeError::new(error.to_string()))? {
            picture.metadata.push((format!("config {}", line.path), line.leaf.to_string()));
        }
        for (name, file) in inputs.iter() {
            picture.metadata.push((format!("table {name}"), file.logical.to_string()));
        }
        let drawing = |error: PlotError| NodeError::new(format!("drawing: {error}"));
        let artifacts = match self.of {
            Some(kind) => {
                let (svg, pdf) = render::render_both(&picture).map_err(drawing)?;
                let values = toml::to_string(&self.params).map_err(|error| NodeError::new(error.to_string()))?;
                let config = format!("kind = {kind:?}\n{values}");
                vec![
                    Artifact::opaque(PICTURE_FILE, svg),
                    Artifact::opaque(PDF_FILE, pdf),
                    Artifact::opaque(CONFIG_FILE, config.into_bytes()),
                ]
            }
            None => vec![Artifact::opaque(PICTURE_FILE, render::render(&picture).map_err(drawing)?)],
        };
        Ok(Product { artifacts, work: Work::default() })
    }
}

/// The node that reads values and claims off the tables.
struct Finding<D: Definition> {
    params: D::Params,
}

impl<D: Definition> Serialize for Finding<D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.params.serialize(serializer)
    }
}

impl<D: Definition> Compute for Finding<D> {
    fn kind(&self) -> &'static Kind {
        D::FINDINGS
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let tables = read_tables(inputs)?;
        let asked = D::asked(&self.params);
        let mut findings = if asked.own {
            Findings { values: D::values(&self.params, &tables)?, claims: D::claims(&self.params, &tables)? }
        } else {
            Findings::default()
        };
        if let Some(more) = &asked.more {
            findings.values.extend(more.values(&tables)?);
        }
        findings.claims.extend(asked.claims(&tables)?);
        for value in &findings.values {
            if !(value.value.is_finite() && value.error.is_finite()) {
                return Err(NodeError::new(format!("value {} or its error is not finite", value.name)));
            }
        }
        // Two renderings of equal findings have equal bytes, so the bytes are the content.
        let mut bytes = serde_json::to_vec_pretty(&findings).map_err(|error| NodeError::new(error.to_string()))?;
        bytes.push(b'\n');
        Ok(Product { artifacts: vec![Artifact::opaque(FINDINGS_FILE, bytes)], work: Work::default() })
    }
}
