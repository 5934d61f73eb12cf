//! What the page is made of: parts as the runner stored them, and what belongs to the whole.

use crate::contract::value::Findings;
use crate::table::Table;

/// An experiment's part of the page.
#[derive(Clone, Debug)]
pub struct Part {
    /// The experiment's id: the stem of its config.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// Where it stands in the article.
    pub place: String,
    /// Its picture: SVG as it was written.
    pub picture: String,
    /// What it found.
    pub findings: Findings,
    /// Its module in this program's source.
    pub module: String,
    /// Whether the source lies beside the output folder, so that the page can link to it.
    pub has_source: bool,
    /// Its tables, by name, with the path of the Parquet file from the output folder.
    pub tables: Vec<(String, String, Table)>,
}

impl Part {
    /// The table of that name.
    pub fn table(&self, name: &str) -> Option<&Table> {
        self.tables.iter().find(|(known, ..)| known == name).map(|(.., table)| table)
    }
}

/// A metric, its effects, and how the command calls them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MetricEffects {
    /// The metric's name in configs.
    pub metric: String,
    /// Its effects' names in configs.
    pub effects: Vec<String>,
}

/// Everything on the page.
#[derive(Clone, Debug, Default)]
pub struct Content {
    /// The parts, in the article's order.
    pub parts: Vec<Part>,
    /// What a scene can call for.
    pub metrics: Vec<MetricEffects>,
    /// The graph of the run, as SVG.
    pub graph: String,
    /// Conjugate loci of the spin problem for many k: columns `k`, `p_theta`, `theta`, `r1`, `r2`, `r3`.
    pub loci: Option<Table>,
}

impl Content {
    /// The part of an experiment.
    pub fn part(&self, id: &str) -> Option<&Part> {
        self.parts.iter().find(|part| part.id == id)
    }
}

/// Why there is no page.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PageError {
    /// A place of the template that nothing fills: a defect.
    #[error("nothing fills the place {place:?} of the template")]
    Template {
        /// What it is called.
        place: String,
    },
    /// A picture that is no SVG as this program writes it.
    #[error("{part}: the picture can't be read: {why}")]
    Picture {
        /// The experiment.
        part: String,
        /// What is missing.
        why: &'static str,
    },
    /// A table without a column that the page shows.
    #[error("{part}: {why}")]
    Table {
        /// The experiment.
        part: String,
        /// What is missing.
        why: String,
    },
}
