//! The manifest of a node: what its result depends on, as a list of leaves. The key is its digest.
//!
//! One walk writes the manifest; the key and the explanation ("this leaf changed from … to …") both come from it, so
//! they cannot disagree. Floats count by their bits: `0.4` and `0.400` are one value, `0.0` and `-0.0` are two. Layout,
//! comments and the order of keys in a config never get here, nor does the experiment's id: equal work is one node.

use super::digest::{Digest, Framed};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt;

/// Which part of the identity a leaf belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Part {
    /// The node's kind.
    Kind,
    /// The fingerprint of the code that the kind runs.
    Code,
    /// A parameter that the node reads.
    Param,
    /// The content of an input.
    Input,
}

impl Part {
    /// The name used in records and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kind => "kind",
            Self::Code => "code",
            Self::Param => "param",
            Self::Input => "input",
        }
    }
}

/// The value of a leaf, in canonical form.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leaf {
    /// A float, compared by its bits; written as bits so that nothing is lost.
    Float(FloatBits),
    /// An integer.
    Int(i64),
    /// A boolean.
    Bool(bool),
    /// A text.
    Text(String),
    /// A digest of content.
    Digest(Digest),
    /// An empty list: it has no leaves of its own, and must not look like an absent one.
    Empty,
}

/// The bits of a float, as sixteen hexadecimal digits in text form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FloatBits(pub u64);

impl Serialize for FloatBits {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&format_args!("{:016x}", self.0))
    }
}

impl<'de> Deserialize<'de> for FloatBits {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        u64::from_str_radix(&text, 16).map(Self).map_err(serde::de::Error::custom)
    }
}

impl PartialEq for Leaf {
    fn eq(&self, other: &Self) -> bool {
        self.tag() == other.tag() && self.payload() == other.payload()
    }
}
impl Eq for Leaf {}

impl Leaf {
    /// A leaf for a float.
    pub fn float(x: f64) -> Self {
        Self::Float(FloatBits(x.to_bits()))
    }

    fn tag(&self) -> u8 {
        match self {
            Self::Float(_) => b'f',
            Self::Int(_) => b'i',
            Self::Bool(_) => b'b',
            Self::Text(_) => b't',
            Self::Digest(_) => b'd',
            Self::Empty => b'e',
        }
    }

    fn payload(&self) -> Vec<u8> {
        match self {
            Self::Float(bits) => bits.0.to_le_bytes().to_vec(),
            Self::Int(x) => x.to_le_bytes().to_vec(),
            Self::Bool(x) => vec![u8::from(*x)],
            Self::Text(text) => text.as_bytes().to_vec(),
            Self::Digest(digest) => digest.0.to_vec(),
            Self::Empty => Vec::new(),
        }
    }
}

impl fmt::Display for Leaf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Float(bits) => write!(f, "{:?}", f64::from_bits(bits.0)),
            Self::Int(x) => write!(f, "{x}"),
            Self::Bool(x) => write!(f, "{x}"),
            Self::Text(text) => write!(f, "{text:?}"),
            Self::Digest(digest) => f.write_str(&digest.short()),
            Self::Empty => f.write_str("[]"),
        }
    }
}

/// One line of a manifest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Line {
    /// Which part of the identity it belongs to.
    pub part: Part,
    /// Where the leaf stands: `metric.spin.k`, `start.p_theta[3]`, the name of an input.
    pub path: String,
    /// Its value.
    pub leaf: Leaf,
}

/// What a node's result depends on.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// The lines, in the order in which they were written.
    pub lines: Vec<Line>,
}

impl Manifest {
    /// Adds a line.
    pub fn push(&mut self, part: Part, path: impl Into<String>, leaf: Leaf) {
        self.lines.push(Line { part, path: path.into(), leaf });
    }

    /// The key: the digest of the framed lines, in canonical order (part, then path).
    pub fn key(&self) -> Digest {
        key_of(&self.lines)
    }

    /// The leaf at a place, if it is there.
    pub fn get(&self, part: Part, path: &str) -> Option<&Leaf> {
        self.lines.iter().find(|line| line.part == part && line.path == path).map(|line| &line.leaf)
    }

    /// The digest of the code listing that the kind depended on.
    pub fn code(&self) -> Option<Digest> {
        match self.get(Part::Code, "listing") {
            Some(Leaf::Digest(digest)) => Some(*digest),
            _ => None,
        }
    }

    /// The leaves that differ: `(part, path, old, new)`; empty exactly when the keys agree.
    pub fn changes(&self, new: &Self) -> Vec<Change> {
        let (before, after) = (self.by_place(), new.by_place());
        let mut changes = Vec::new();
        for line in &self.lines {
            let now = after.get(&(line.part, line.path.as_str())).copied();
            if now != Some(&line.leaf) {
                changes.push(Change::of(line.part, &line.path, Some(&line.leaf), now));
            }
        }
        for line in &new.lines {
            if !before.contains_key(&(line.part, line.path.as_str())) {
                changes.push(Change::of(line.part, &line.path, None, Some(&line.leaf)));
            }
        }
        changes
    }

    fn by_place(&self) -> HashMap<(Part, &str), &Leaf> {
        self.lines.iter().map(|line| ((line.part, line.path.as_str()), &line.leaf)).collect()
    }
}

/// The key of the manifest that has these lines, without building it.
pub fn key_of<'a>(lines: impl IntoIterator<Item = &'a Line>) -> Digest {
    let mut order: Vec<&Line> = lines.into_iter().collect();
    order.sort_by(|a, b| (a.part, &a.path).cmp(&(b.part, &b.path)));
    let mut framed = Framed::new("polhode manifest 1");
    for line in order {
        framed.field(line.part.name().as_bytes());
        framed.field(line.path.as_bytes());
        framed.field(&[line.leaf.tag()]);
        framed.field(&line.leaf.payload());
    }
    framed.finish()
}

/// A leaf that differs between two manifests.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// The part it belongs to.
    pub part: Part,
    /// Where it stands.
    pub path: String,
    /// What it was, if it was there.
    pub old: Option<Leaf>,
    /// What it is, if it is there.
    pub new: Option<Leaf>,
}

impl Change {
    fn of(part: Part, path: &str, old: Option<&Leaf>, new: Option<&Leaf>) -> Self {
        Self { part, path: path.to_owned(), old: old.cloned(), new: new.cloned() }
    }
}

/// Parameters that can't be written as a manifest.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("parameters can't be written as a manifest: {0}")]
pub struct NotDescribable(pub String);

/// Walks the parameters of a node through their `Serialize` and returns their leaves, as [`Part::Param`] lines.
///
/// Floats stay floats (a field typed `f64` never turns into an integer); absent options leave no line.
///
/// # Errors
/// Parameters that have no TOML form (maps with keys that are no texts, integers beyond `i64`).
pub fn describe<P: Serialize + ?Sized>(params: &P) -> Result<Vec<Line>, NotDescribable> {
    let value = toml::Value::try_from(params).map_err(|error| NotDescribable(error.to_string()))?;
    let mut lines = Vec::new();
    walk(&value, String::new(), &mut lines);
    Ok(lines)
}

fn walk(value: &toml::Value, path: String, lines: &mut Vec<Line>) {
    let leaf = match value {
        toml::Value::Table(table) => {
            for (key, inner) in table {
                let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                walk(inner, path, lines);
            }
            return;
        }
        toml::Value::Array(items) if items.is_empty() => Leaf::Empty,
        toml::Value::Array(items) => {
            for (index, inner) in items.iter().enumerate() {
                walk(inner, format!("{path}[{index}]"), lines);
            }
            return;
        }
        toml::Value::Float(x) => Leaf::float(*x),
        toml::Value::Integer(x) => Leaf::Int(*x),
        toml::Value::Boolean(x) => Leaf::Bool(*x),
        toml::Value::String(text) => Leaf::Text(text.clone()),
        toml::Value::Datetime(when) => Leaf::Text(when.to_string()),
    };
    lines.push(Line { part: Part::Param, path, leaf });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Params {
        k: f64,
        list: Vec<f64>,
        name: &'static str,
    }

    fn manifest(k: f64, list: Vec<f64>) -> Manifest {
        let lines = describe(&Params { k, list, name: "x" }).expect("describable");
        Manifest { lines }
    }

    #[test]
    fn floats_count_by_their_bits() {
        assert_eq!(manifest(0.4, vec![]).key(), manifest(0.400, vec![]).key());
        assert_ne!(manifest(0.0, vec![]).key(), manifest(-0.0, vec![]).key());
        assert_ne!(manifest(0.4, vec![]).key(), manifest(0.4 + f64::EPSILON, vec![]).key());
    }

    #[test]
    fn an_empty_list_is_not_an_absent_one_and_order_of_lines_is_free() {
        let mut a = manifest(0.4, vec![1.0, 2.0]);
        let b = a.clone();
        a.lines.reverse();
        assert_eq!(a.key(), b.key());
        assert_ne!(manifest(0.4, vec![]).key(), Manifest { lines: manifest(0.4, vec![]).lines[..1].to_vec() }.key());
    }

    #[test]
    fn changes_name_the_leaf() {
        let changes = manifest(0.4, vec![1.0]).changes(&manifest(0.5, vec![1.0, 2.0]));
        let paths: Vec<_> = changes.iter().map(|change| change.path.as_str()).collect();
        assert_eq!(paths, ["k", "list[1]"]);
        assert_eq!(changes[0].old.as_ref().map(Leaf::to_string).as_deref(), Some("0.4"));
        assert!(manifest(0.4, vec![]).changes(&manifest(0.4, vec![])).is_empty());
    }
}
