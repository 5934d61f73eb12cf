//! The accuracy level that a config or the command line asks for, and the arithmetic that it takes.
//!
//! | level | relative error | arithmetic |
//! |---|---|---|
//! | `draft` | 1e-4 | f64 |
//! | a number from 1e-14 to 0.1 | that | f64 |
//! | `article` | 1e-14: what f64 can give | f64, longer where a kind knows that f64 loses too much |
//! | a number from 1e-28 to 1e-14 | that | double-double, rounded at the end |
//! | `reference` | 1e-28 | double-double, rounded at the end |
//!
//! An error asked for is that of integrations, step by step. Closed forms have no tolerance: in either arithmetic they give what it can.
//! The level enters the parameters of nodes where it matters, and so their key.

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
/// Relative error asked for a reference: some two thousand ε of double-double arithmetic, room for the growth of errors.
pub const REFERENCE: f64 = 1e-28;
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
    /// Double-double arithmetic, [`REFERENCE`] for integrations, rounded at the end.
    Reference,
    /// A relative error asked for by number, from [`REFERENCE`] to 0.1.
    Asked(f64),
}

/// The scalar that formulas are evaluated in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Arithmetic {
    /// 53 bits.
    #[default]
    F64,
    /// 106 bits, rounded to 53 at the end.
    DoubleDouble,
}

impl Arithmetic {
    /// Its name in manifests and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::DoubleDouble => "double-double",
        }
    }
}

impl Accuracy {
    /// The relative error asked for.
    pub fn relative_error(self) -> f64 {
        match self {
            Self::Draft => DRAFT,
            Self::Article => ARTICLE,
            Self::Reference => REFERENCE,
            Self::Asked(error) => error,
        }
    }

    /// The arithmetic that it takes: double-double for whatever is below [`ARTICLE`].
    pub fn arithmetic(self) -> Arithmetic {
        if self.relative_error() < ARTICLE { Arithmetic::DoubleDouble } else { Arithmetic::F64 }
    }

    /// The level in words, for captions: `article: 1e-14, what f64 gives`.
    pub fn in_words(self) -> String {
        match self {
            Self::Draft => format!("draft: integrations to {DRAFT:e}, closed forms in f64"),
            Self::Article => format!("article: {ARTICLE:e}, what f64 gives"),
            Self::Reference => "reference: double-double arithmetic, rounded".to_owned(),
            Self::Asked(error) => match self.arithmetic() {
                Arithmetic::F64 => format!("integrations to {error:e}, closed forms in f64"),
                Arithmetic::DoubleDouble => {
                    format!("integrations to {error:e}, closed forms, too, in double-double arithmetic, rounded")
                }
            },
        }
    }
}

impl fmt::Display for Accuracy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Draft => f.write_str("draft"),
            Self::Article => f.write_str("article"),
            Self::Reference => f.write_str("reference"),
            Self::Asked(error) => write!(f, "{error:e}"),
        }
    }
}

/// A level that is not one of those accepted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "accuracy {found:?} is not accepted: use \"draft\" (1e-4), \"article\" (1e-14), \"reference\" (double-double) or a \
     relative error from 1e-28 to 0.1"
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
            "reference" => Ok(Self::Reference),
            _ => match text.parse::<f64>() {
                Ok(error) if (REFERENCE..=COARSEST).contains(&error) => Ok(Self::Asked(error)),
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
                f.write_str("\"draft\", \"article\", \"reference\" or a relative error from 1e-28 to 0.1")
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
            "description": "How accurate results are asked to be: \"draft\" (1e-4), \"article\" (1e-14), \"reference\" (double-double), or a relative error from 1e-28 to 0.1.",
            "anyOf": [
                { "enum": [Self::Draft, Self::Article, Self::Reference] },
                { "type": "number", "minimum": REFERENCE, "maximum": COARSEST },
            ],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_by_name_and_number_and_the_arithmetic_they_take() {
        for (text, level, arithmetic) in [
            ("draft", Accuracy::Draft, Arithmetic::F64),
            ("article", Accuracy::Article, Arithmetic::F64),
            ("reference", Accuracy::Reference, Arithmetic::DoubleDouble),
            ("1e-14", Accuracy::Asked(1e-14), Arithmetic::F64),
            ("9e-15", Accuracy::Asked(9e-15), Arithmetic::DoubleDouble),
            ("1e-28", Accuracy::Asked(1e-28), Arithmetic::DoubleDouble),
            ("0.1", Accuracy::Asked(0.1), Arithmetic::F64),
        ] {
            let read: Accuracy = text.parse().unwrap();
            assert_eq!((read, read.arithmetic()), (level, arithmetic), "{text}");
            assert_eq!(read.to_string().parse(), Ok(level));
        }
        for wrong in ["best", "0.2", "9e-29", "NaN", "-1e-9", ""] {
            let message = wrong.parse::<Accuracy>().unwrap_err().to_string();
            assert!(message.contains("reference") && message.contains("1e-28"), "{message}");
        }
    }
}
