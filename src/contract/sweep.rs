//! A swept quantity: one number, a list, or a range with a count.
//!
//! In a config: `k = 0.8`, `k = [0.8, 0.5]`, `k = { from = 0.5, to = 1.5, count = 101, spacing = "lin" }`. The shapes are
//! told apart by a visitor, so that errors keep line and column (serde's untagged form loses them).

use super::config::Invalid;
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;

/// How the values of a range are spaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Equal differences, the default.
    #[default]
    Lin,
    /// Equal ratios; both ends must be positive.
    Log,
}

/// A range of values with both ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// The first value, exactly.
    pub from: f64,
    /// The last value, exactly; larger than the first.
    pub to: f64,
    /// The number of values, at least 2.
    pub count: usize,
    /// How they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
}

/// A swept quantity.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
pub enum Sweep {
    /// One value.
    One(f64),
    /// The values in the order of the config.
    List(Vec<f64>),
    /// A range.
    Range(Range),
}

impl Range {
    /// The values, both ends exact.
    ///
    /// Linear: (from·(n−1−i) + to·i)/(n−1), so that `{ from = 0.5, to = 1.5, count = 101 }` holds the very floats that
    /// are written 0.51, 0.52, …: equal work in two configs is then one node. Logarithmic: from^(1−s)·to^s with
    /// s = i/(n−1), by `libm`.
    pub fn values(&self) -> Vec<f64> {
        let Self { from, to, count, spacing } = *self;
        let last = count.saturating_sub(1);
        let inside = |i: usize| {
            let (left, right, all) = ((last - i) as f64, i as f64, last as f64);
            match spacing {
                Spacing::Lin => {
                    let value = (from * left + to * right) / all;
                    // The products overflow only for ends near the largest float.
                    if value.is_finite() { value } else { from * (left / all) + to * (right / all) }
                }
                Spacing::Log => libm::pow(from, left / all) * libm::pow(to, right / all),
            }
        };
        (0..count)
            .map(|i| match i {
                0 => from,
                i if i == last => to,
                i => inside(i),
            })
            .collect()
    }
}

impl Sweep {
    /// All values, in order.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::One(value) => vec![*value],
            Self::List(values) => values.clone(),
            Self::Range(range) => range.values(),
        }
    }

    /// The number of values.
    pub fn count(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::List(values) => values.len(),
            Self::Range(range) => range.count,
        }
    }

    /// The key of one value below the key of the sweep: `k`, `k[2]`, or `k` for the values of a range.
    pub fn key_of(&self, key: &str, index: usize) -> String {
        match self {
            Self::List(_) => format!("{key}[{index}]"),
            Self::One(_) | Self::Range(_) => key.to_owned(),
        }
    }

    /// Checks the shape: at least one value, all finite, no value of a list twice, ranges that ascend with a count of at
    /// least 2, positive ends for logarithmic ones. A range of more than ten million values is taken for a slip.
    ///
    /// # Errors
    /// The first thing that is not accepted; keys are those of the config, below `key`.
    pub fn validate(&self, key: &str) -> Result<(), Invalid> {
        const MOST: usize = 10_000_000;
        match self {
            Self::One(value) => Invalid::number(value.is_finite(), key, *value, "a finite number"),
            Self::List(values) => {
                Invalid::unless(!values.is_empty(), key, "[]", "at least one value")?;
                for (index, value) in values.iter().enumerate() {
                    let key = format!("{key}[{index}]");
                    Invalid::number(value.is_finite(), key.as_str(), *value, "a finite number")?;
                    let first = values[..index].iter().all(|earlier| earlier != value);
                    Invalid::number(first, key, *value, "each value once")?;
                }
                Ok(())
            }
            Self::Range(Range { from, to, count, spacing }) => {
                let key = |end: &str| format!("{key}.{end}");
                Invalid::number(from.is_finite(), key("from"), *from, "a finite number")?;
                Invalid::number(to.is_finite(), key("to"), *to, "a finite number")?;
                if *spacing == Spacing::Log {
                    Invalid::number(*from > 0.0, key("from"), *from, "from > 0 with spacing = \"log\"")?;
                }
                Invalid::number(from < to, key("to"), *to, format!("to > from (which is {from:?})"))?;
                let accepted = format!("a count from 2 to {MOST}");
                Invalid::unless((2..=MOST).contains(count), key("count"), count, accepted)
            }
        }
    }

    /// Checks the shape, and every value by `accept`; `accepted` says in words what it accepts: `k > 0`.
    ///
    /// # Errors
    /// The first thing that is not accepted. Of a range, `from` or `to` is named when it is at fault.
    pub fn validate_each(&self, key: &str, accepted: &str, accept: impl Fn(f64) -> bool) -> Result<(), Invalid> {
        self.validate(key)?;
        if let Self::Range(Range { from, to, .. }) = self {
            Invalid::number(accept(*from), format!("{key}.from"), *from, accepted)?;
            Invalid::number(accept(*to), format!("{key}.to"), *to, accepted)?;
        }
        for (index, value) in self.values().into_iter().enumerate() {
            Invalid::number(accept(value), self.key_of(key, index), value, accepted)?;
        }
        Ok(())
    }
}

impl From<f64> for Sweep {
    fn from(value: f64) -> Self {
        Self::One(value)
    }
}

impl From<Vec<f64>> for Sweep {
    fn from(values: Vec<f64>) -> Self {
        Self::List(values)
    }
}

impl Serialize for Sweep {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::One(value) => serializer.serialize_f64(*value),
            Self::List(values) => values.serialize(serializer),
            Self::Range(range) => range.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Sweep {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> de::Visitor<'de> for Visitor {
            type Value = Sweep;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a number, a list of numbers, or { from = …, to = …, count = …, spacing = \"lin\" or \"log\" }",
                )
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Sweep, E> {
                Ok(Sweep::One(value))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Sweep, E> {
                Ok(Sweep::One(value as f64))
            }
            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Sweep, E> {
                Ok(Sweep::One(value as f64))
            }
            fn visit_seq<A: de::SeqAccess<'de>>(self, mut items: A) -> Result<Sweep, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = items.next_element::<f64>()? {
                    values.push(value);
                }
                Ok(Sweep::List(values))
            }
            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Sweep, A::Error> {
                Range::deserialize(MapAccessDeserializer::new(map)).map(Sweep::Range)
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::manifest::describe;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Holder {
        k: Sweep,
    }

    fn sweep(text: &str) -> Sweep {
        toml::from_str::<Holder>(&format!("k = {text}")).expect("a good sweep").k
    }

    #[test]
    fn three_shapes() {
        assert_eq!(sweep("1").values(), [1.0]);
        assert_eq!(sweep("[0.8, 1]").values(), [0.8, 1.0]);
        let range = sweep("{ from = 0, to = 1, count = 3 }");
        assert_eq!(range.values(), [0.0, 0.5, 1.0]);
        assert_eq!(range.count(), 3);
    }

    /// Oracle: the decimal literals themselves.
    #[test]
    fn linear_values_are_the_floats_a_reader_would_write() {
        let values = sweep("{ from = 0.5, to = 1.5, count = 101 }").values();
        for (i, value) in values.iter().enumerate() {
            let written: f64 = format!("{}.{:02}", (50 + i) / 100, (50 + i) % 100).parse().expect("a decimal");
            assert_eq!(value.to_bits(), written.to_bits(), "{i}");
        }
    }

    /// Oracle: mpmath 1.3, 30 digits: 1e-4 · (5·10⁵)^(i/4) for i = 1, 2, 3. Two powers of relative error below ε each, so
    /// 2 ε and the rounding of the exponents s (below ε/2), amplified by |ln(from)| + |ln(to)| < 14.
    #[test]
    fn logarithmic_values_have_exact_ends_and_equal_ratios() {
        let values = sweep("{ from = 1e-4, to = 50.0, count = 5, spacing = \"log\" }").values();
        let expected = [1e-4, LOG_1, LOG_2, LOG_3, 50.0];
        assert_eq!((values[0], values[4]), (1e-4, 50.0));
        for (value, expected) in values.iter().zip(expected) {
            assert!((value / expected - 1.0).abs() <= 10.0 * f64::EPSILON, "{value:e} {expected:e}");
        }
    }
    const LOG_1: f64 = 0.002_659_147_948_472_494_308;
    const LOG_2: f64 = 0.070_710_678_118_654_752_44;
    const LOG_3: f64 = 1.880_301_546_543_196_784;

    #[test]
    fn what_is_refused_and_under_which_key() {
        let key = |text: &str| sweep(text).validate("k").map_err(|invalid| invalid.key);
        let refused = |key: &str| Err(key.to_owned());
        assert_eq!(key("[]"), refused("k"));
        assert_eq!(key("[1.0, 2.0, 1.0]"), refused("k[2]"));
        assert_eq!(key("{ from = 2, to = 1, count = 3 }"), refused("k.to"));
        assert_eq!(key("{ from = 0, to = 1, count = 1 }"), refused("k.count"));
        assert_eq!(key("{ from = 0, to = 1, count = 3, spacing = \"log\" }"), refused("k.from"));
        assert_eq!(key("{ from = 0, to = 1, count = 2 }"), Ok(()));
        assert_eq!(Sweep::One(f64::NAN).validate("k").map_err(|invalid| invalid.key), refused("k"));
        let positive = |text: &str| sweep(text).validate_each("k", "k > 0", |k| k > 0.0).map_err(|i| (i.key, i.found));
        assert_eq!(positive("[0.8, -0.5]"), Err(("k[1]".to_owned(), "-0.5".to_owned())));
        assert_eq!(positive("{ from = -1, to = 1, count = 3 }").map_err(|found| found.0), refused("k.from"));
        assert_eq!(positive("0.8"), Ok(()));
    }

    #[test]
    fn written_back_as_read() {
        for text in ["0.8", "[0.8, 0.5]", "{ from = 0.5, to = 1.5, count = 3, spacing = \"log\" }"] {
            let holder = Holder { k: sweep(text) };
            let again: Holder = toml::from_str(&toml::to_string(&holder).expect("writes")).expect("reads");
            assert_eq!(again, holder);
            assert!(!describe(&holder).expect("describable").is_empty());
        }
    }
}
