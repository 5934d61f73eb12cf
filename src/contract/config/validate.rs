//! Range checks of parameters, which types can't express.

use std::fmt;

/// Parameters that know which values they accept.
pub trait Validate {
    /// Checks values beyond their types: ranges, orders, lengths.
    ///
    /// # Errors
    /// The first value that is not accepted, with its key as written in the config.
    fn validate(&self) -> Result<(), Invalid>;
}

/// A value that is not accepted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: found {found}, accepted: {accepted}")]
pub struct Invalid {
    /// Where it stands: `scene.metric.spin.k[1]`.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is accepted: `k > 0`, `A < B < C`.
    pub accepted: String,
}

impl Invalid {
    /// A value that is not accepted.
    pub fn new(key: impl Into<String>, found: impl fmt::Display, accepted: impl Into<String>) -> Self {
        Self { key: key.into(), found: found.to_string(), accepted: accepted.into() }
    }

    /// Passes when `holds`, else gives the error: `Invalid::unless(k > 0.0, "k", k, "k > 0")?`.
    ///
    /// # Errors
    /// The condition does not hold.
    pub fn unless(
        holds: bool,
        key: impl Into<String>,
        found: impl fmt::Display,
        accepted: impl Into<String>,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::new(key, found, accepted)) }
    }

    /// As [`Invalid::unless`] for a number, shown in its shortest form: `1e-20` rather than twenty zeros.
    ///
    /// # Errors
    /// The condition does not hold.
    pub fn number(holds: bool, key: impl Into<String>, found: f64, accepted: impl Into<String>) -> Result<(), Self> {
        Self::unless(holds, key, format_args!("{found:?}"), accepted)
    }

    /// The same error seen from the table that holds the value: `k[1]` within `scene.metric.spin`.
    #[must_use]
    pub fn within(mut self, table: &str) -> Self {
        self.key = match (table, self.key.as_str()) {
            ("", _) => self.key,
            (_, "") => table.to_owned(),
            (_, key) if key.starts_with('[') => format!("{table}{key}"),
            (_, key) => format!("{table}.{key}"),
        };
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_joined_as_in_toml() {
        let invalid = |key: &str| Invalid::new(key, 0.0, "k > 0");
        assert_eq!(invalid("k[1]").within("spin").within("scene.metric").key, "scene.metric.spin.k[1]");
        assert_eq!(invalid("[1]").within("k").key, "k[1]");
        assert_eq!(invalid("").within("k").key, "k");
        assert_eq!(invalid("k").within("").key, "k");
        assert_eq!(Invalid::unless(false, "k", -1.0, "k > 0"), Err(Invalid::new("k", "-1", "k > 0")));
        assert_eq!(Invalid::unless(true, "k", 1.0, "k > 0"), Ok(()));
    }
}
