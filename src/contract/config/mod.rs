//! Reading a config: TOML text to checked parameters, with errors that a user can act on.
//!
//! Whatever is wrong (syntax, an unknown or missing key, a wrong type, a number that is not finite, a value out of range),
//! the error names file, line, column, key, what was found, what is accepted and the nearest accepted key, and shows the
//! line with a caret. Parameters are plain serde structs with `deny_unknown_fields` and a [`Validate`].
//!
//! Places come from the spans of the TOML parser. serde's untagged, internally tagged and flattened forms lose them: don't
//! use those in parameters.

mod error;
mod explain;
mod place;
mod read;
mod schema;
mod validate;

pub use error::{ConfigError, ConfigProblem};
pub use place::locate;
pub use read::{digest, leaves, peek_kind, read, unknown_kind};
pub use schema::{one_of, schema, with_kind};
pub use validate::{Invalid, Validate};
