//! From tables to a node's product and back: the file name, the Parquet footer, the logical digest.

use crate::contract::digest::Digest;
use crate::contract::node::{Artifact, Encode, Inputs, NodeError, Product};
use crate::contract::work::Work;
use crate::table::Table;
use std::fmt::Display;

/// The name of the one table that a compute node makes.
pub const TABLE: &str = "table.parquet";

/// A table that becomes a Parquet file; its footer says what it was made from.
struct Parquet(Table);

impl Encode for Parquet {
    fn encode(&self, made_from: &[(String, String)]) -> Result<Vec<u8>, NodeError> {
        self.0.to_parquet(made_from).map_err(failed("the table can't be written"))
    }
}

/// The product of a node that makes one table; the rows are counted into its work.
///
/// # Errors
/// None now; the file is written after the work, and may fail then.
pub fn product(table: &Table, mut work: Work) -> Result<Product, NodeError> {
    work.rows = table.rows() as u64;
    let artifact = Artifact::unwritten(TABLE, Digest(table.logical_digest()), Parquet(table.clone()));
    Ok(Product { artifacts: vec![artifact], work })
}

/// Reads an input that is a table.
///
/// # Errors
/// An input that was not declared, or is no table.
pub fn input_table(inputs: &Inputs, name: &str) -> Result<Table, NodeError> {
    Table::from_parquet(&inputs.get(name)?.bytes).map_err(failed(&format!("input {name:?} can't be read")))
}

/// Puts what was being done before an error: `map_err(failed("k = 0.8"))`.
pub fn failed<E: Display>(doing: &str) -> impl FnOnce(E) -> NodeError {
    let doing = doing.to_owned();
    move |error| NodeError::new(format!("{doing}: {error}"))
}
