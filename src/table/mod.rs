//! Typed columns with a unit and a meaning, in memory, as Parquet, as CSV and as text: the only room that names polars.
//!
//! A [`Table`] is what a node of the graph gives back and what a picture reads. It is checked when it is built: columns of
//! equal length, unique names, and no NaN or infinity except in columns whose schema allows gaps. Its *logical digest*
//! covers the schema and the bits of the columns, and nothing of how a file encodes them: work downstream depends on that
//! digest alone.
//!
//! What it does not know: what any column is for, where files lie, when and by what they were made.

mod build;
mod delimited;
mod digest;
mod error;
mod parquet;
mod schema;
mod set;
mod text;

pub use build::{Builder, Table};
pub use error::TableError;
pub use parquet::footer;
pub use schema::{Column, Data};
pub use set::Tables;
pub use text::render_text;
