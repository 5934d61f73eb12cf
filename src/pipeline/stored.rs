//! Stored artifacts by address, as they are for the present configs and code: for `show`.
//!
//! Whoever has just run has the keys in the report: [`Store::artifact`] is quicker then.

use super::forecast::forecast;
use super::graph::Graph;
use super::run::Options;
use super::store::{Fault, Store};
use crate::contract::node::Address;

/// Why a stored artifact can't be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotStored {
    /// Nothing stands at the address.
    #[error("no node stands at {0}")]
    NoSuchNode(Address),
    /// The node's result is not in the store.
    #[error("{0} has no stored result for the present configs and code: run it first")]
    NotRun(Address),
    /// The node makes no such artifact.
    #[error("{address} makes no {artifact:?}; it makes {made}")]
    NoSuchArtifact {
        /// The node.
        address: String,
        /// What was asked for.
        artifact: String,
        /// What there is.
        made: String,
    },
    /// The stored bytes are damaged.
    #[error("the stored {artifact} of {address} is {fault}: run again to repair it")]
    Damaged {
        /// The node.
        address: String,
        /// What was asked for.
        artifact: String,
        /// What is wrong with it.
        fault: Fault,
    },
}

/// The verified bytes of a node's artifact, as they are for the present configs and code. Writes nothing, runs nothing.
///
/// # Errors
/// What keeps it from being had.
pub fn stored(
    graph: &Graph,
    store: &Store,
    options: &Options,
    address: &Address,
    artifact: &str,
) -> Result<Vec<u8>, NotStored> {
    let none = || NotStored::NoSuchNode(address.clone());
    graph.find(address).ok_or_else(none)?;
    let mut selection = graph.select(&[address.to_string()]).map_err(|_| none())?;
    selection.exports.clear();
    let options = Options { force: false, ..options.clone() };
    let forecast = forecast(graph, &selection, store, &options);
    let node = forecast.nodes.iter().find(|node| node.address == *address).ok_or_else(none)?;
    let not_run = || NotStored::NotRun(address.clone());
    let record = store.record(node.key.ok_or_else(not_run)?).map_err(|_| not_run())?;
    let output = record.output(artifact).ok_or_else(|| {
        let made: Vec<&str> = record.outputs.iter().map(|output| output.name.as_str()).collect();
        NotStored::NoSuchArtifact { address: address.to_string(), artifact: artifact.to_owned(), made: made.join(", ") }
    })?;
    store.object(output.object).map_err(|fault| NotStored::Damaged {
        address: address.to_string(),
        artifact: artifact.to_owned(),
        fault,
    })
}
