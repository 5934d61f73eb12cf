//! The accuracy level that a config or the command line asks for. It enters the parameters of nodes, and so their key.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Unexpected;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// Relative error asked of a draft.
pub const DRAFT: f64 = 1e-4;
/// Relative error asked for the article: what `f64` can give.
pub const ARTICLE: f64 = 1e-14;

/// The largest relative error that can be asked for.
pub const COARSEST: f64 = 0.1;

/// How accurate results are asked to be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Accuracy {
    /// Relative error [`DRAFT`].
    Draft,
    /// Relative error [`ARTICLE`], the default.
    #[default]
    Article,
    /// A relative error asked for by number, from 1e-14 to 1e-1.
    Asked(f64),
}

impl Accuracy {
    /// The relative error asked for.
    pub fn relative_error(self) -> f64 {
        match self {
            Self::Draft => DRAFT,
            Self::Article => ARTICLE,
            Self::Asked(error) => error,
        }
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Draft => f.write_str("draft"),
            Self::Article => f.write_str("article"),
            Self::Asked(error) => write!(f, "{error:e}"),
        }
    }
}

/// A level that is not one of those accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "accuracy {found:?} is not accepted: use \"draft\" (1e-4), \"article\" (1e-14) or a relative error from 1e-14 to 0.1"
)]
pub struct UnknownAccuracy {
    /// What was found.
    pub found: String,
}

impl FromStr for Accuracy {
    type Err = UnknownAccuracy;
    fn from_str(text: &str) -> Result<Self, UnknownAccuracy> {
        match text {
            "draft" => Ok(Self::Draft),
            "article" => Ok(Self::Article),
            _ => match text.parse::<f64>() {
                Ok(error) if (ARTICLE..=COARSEST).contains(&error) => Ok(Self::Asked(error)),
                _ => Err(UnknownAccuracy { found: text.to_owned() }),
            },
        }
    }
}

impl Serialize for Accuracy {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Accuracy {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = Accuracy;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"draft\", \"article\" or a relative error from 1e-14 to 0.1")
            }
            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Accuracy, E> {
                text.parse().map_err(|_| E::invalid_value(Unexpected::Str(text), &self))
            }
            fn visit_f64<E: serde::de::Error>(self, x: f64) -> Result<Accuracy, E> {
                format!("{x:e}").parse().map_err(|_| E::invalid_value(Unexpected::Float(x), &self))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// Written by hand beside the reader: a name or a number, which no derive can know. (A number in quotes is read too, as on the
/// command line; an editor need not offer that.)
impl JsonSchema for Accuracy {
    fn schema_name() -> Cow<'static, str> {
        "Accuracy".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "How accurate results are asked to be: \"draft\" (1e-4), \"article\" (1e-14), or a relative error from 1e-14 to 0.1.",
            "anyOf": [
                { "enum": [Self::Draft, Self::Article] },
                { "type": "number", "minimum": ARTICLE, "maximum": COARSEST },
            ],
        })
    }
}
