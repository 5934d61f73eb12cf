//! `figures/values.toml`: the named values of all experiments, as a node of its own that reads their findings.

use crate::check::values_toml;
use crate::contract::node::{Address, Artifact, Compute, Inputs, Kind, Node, NodeError, Product};
use crate::contract::plan::{Export, Plan};
use crate::contract::value::Findings;
use crate::contract::work::Work;
use crate::experiments::definition::{FINDINGS_FILE, FINDINGS_NODE};
use serde::Serialize;

/// The id of the plan, and of its one node.
pub const ID: &str = "values";
/// The file.
pub const VALUES_FILE: &str = "values.toml";

/// The kind.
pub const KIND: Kind = Kind {
    name: "values",
    summary: "the named values of all experiments",
    code: &["check/number.rs", "check/values_toml.rs", "cli/collected.rs", "contract/claim.rs", "contract/value.rs"],
    measurement: false,
};

/// Collects the values. The experiments' ids are the names of its inputs.
#[derive(Serialize)]
struct Collected {
    experiments: Vec<String>,
}

/// The plan that makes `values.toml` from the findings of the given experiments.
///
/// # Errors
/// Ids that can't be written in a manifest.
pub fn plan(experiments: &[&str]) -> Result<Plan, NodeError> {
    let experiments: Vec<String> = experiments.iter().map(|id| (*id).to_owned()).collect();
    let mut node = Node::new(Address::new(ID, "all"), Collected { experiments: experiments.clone() })
        .map_err(|error| NodeError::new(error.to_string()))?;
    for id in &experiments {
        node = node.input(id.clone(), &Address::new(id.clone(), FINDINGS_NODE), FINDINGS_FILE);
    }
    let exports =
        vec![Export { path: VALUES_FILE.to_owned(), from: node.address.clone(), artifact: VALUES_FILE.to_owned() }];
    Ok(Plan { id: ID.to_owned(), nodes: vec![node], exports, ..Plan::default() })
}

/// Reads an experiment's findings.
///
/// # Errors
/// Bytes that are no findings.
pub fn findings(bytes: &[u8]) -> Result<Findings, NodeError> {
    serde_json::from_slice(bytes).map_err(|error| NodeError::new(format!("findings can't be read: {error}")))
}

impl Compute for Collected {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let mut all = Vec::new();
        for (id, file) in inputs.iter() {
            all.push((id, findings(&file.bytes)?));
        }
        let values = all.iter().map(|(id, findings)| (*id, findings.values.as_slice()));
        let text = values_toml::write(values).map_err(|error| NodeError::new(error.to_string()))?;
        Ok(Product { artifacts: vec![Artifact::opaque(VALUES_FILE, text.into_bytes())], work: Work::default() })
    }
}
