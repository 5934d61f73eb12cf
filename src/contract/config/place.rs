//! Where things stand in a TOML text: from key paths and spans to lines and columns.

use std::ops::Range;
use toml::de::{DeArray, DeTable, DeValue};

/// What stands at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Table,
    List,
    /// A number, a text, a date, true or false.
    Leaf,
}

impl Shape {
    fn of(value: &DeValue<'_>) -> Self {
        match value {
            DeValue::Table(_) => Self::Table,
            DeValue::Array(_) => Self::List,
            _ => Self::Leaf,
        }
    }
}

/// A key or list element of a document.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    /// The path: `scene.metric.spin.k[1]`.
    pub path: String,
    /// The bytes of the key (of a list element: of the element itself).
    pub key: Range<usize>,
    /// The bytes of the value; of a table with a header, those of the header.
    pub value: Range<usize>,
    /// What it is.
    pub shape: Shape,
}

impl Place {
    /// The bytes to point at for a value: those of the value, or of the key for tables that have no text of their own.
    pub fn shown(&self, text: &str) -> Range<usize> {
        let written = text.get(self.value.clone()).unwrap_or("");
        if self.value.is_empty() || written.starts_with('[') && self.key.start > self.value.start {
            self.key.clone()
        } else {
            self.value.clone()
        }
    }
}

/// How the empty key is written.
pub(super) const EMPTY: &str = "\"\"";

/// All places of a document; tables before what they hold.
pub(super) fn places(document: &DeTable<'_>) -> Vec<Place> {
    let mut found = Vec::new();
    in_table(document, "", &mut found);
    found
}

fn in_table(table: &DeTable<'_>, path: &str, found: &mut Vec<Place>) {
    for (key, value) in table {
        // The empty key is a key: shown as it is written.
        let name = if key.get_ref().is_empty() { EMPTY } else { key.get_ref() };
        let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        let shape = Shape::of(value.get_ref());
        found.push(Place { path: path.clone(), key: key.span(), value: value.span(), shape });
        in_value(value.get_ref(), &path, found);
    }
}

fn in_array(array: &DeArray<'_>, path: &str, found: &mut Vec<Place>) {
    for (index, value) in array.iter().enumerate() {
        let path = format!("{path}[{index}]");
        let shape = Shape::of(value.get_ref());
        found.push(Place { path: path.clone(), key: value.span(), value: value.span(), shape });
        in_value(value.get_ref(), &path, found);
    }
}

fn in_value(value: &DeValue<'_>, path: &str, found: &mut Vec<Place>) {
    match value {
        DeValue::Table(table) => in_table(table, path, found),
        DeValue::Array(array) => in_array(array, path, found),
        _ => {}
    }
}

/// The path of the table or list that holds this one; empty at the top.
pub(super) fn parent(path: &str) -> &str {
    path.rfind(['.', '[']).map_or("", |end| &path[..end])
}

/// Line and column of a byte, both counted from 1; columns count characters, not bytes.
pub(super) fn line_and_column(text: &str, byte: usize) -> (usize, usize) {
    let byte = (0..=byte.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let before = &text[..byte];
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
}

/// Line and column, counted from 1, of the value at a key path such as `scene.metric.spin.k[1]`.
///
/// `None` when the text is no TOML or has no such key: parameters that took a default stand nowhere.
pub fn locate(text: &str, key_path: &str) -> Option<(usize, usize)> {
    let document = DeTable::parse(text).ok()?;
    let place = places(document.get_ref()).into_iter().find(|place| place.path == key_path)?;
    Some(line_and_column(text, place.shown(text).start))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
kind = \"scene\" # a comment
[scene]
metric.spin = { k = [0.8, 0.5] }
φ = 1
\"start\".p_theta = { from = 1e-4,
  to = 50 }
[[scene.list]]
x = 1
[[scene.list]]
x = 2
[scene.deep.er]
y = 3
";

    #[test]
    fn key_paths_are_found_wherever_they_are_written() {
        let at = |path: &str| locate(TEXT.replace('φ', "\"φ\"").as_str(), path);
        assert_eq!(at("kind"), Some((1, 8)));
        assert_eq!(at("scene"), Some((2, 2)));
        assert_eq!(at("scene.metric"), Some((3, 1)));
        assert_eq!(at("scene.metric.spin"), Some((3, 15)));
        assert_eq!(at("scene.metric.spin.k[1]"), Some((3, 27)));
        assert_eq!(at("scene.φ"), Some((4, 7)));
        assert_eq!(at("scene.start.p_theta.to"), Some((6, 8)));
        assert_eq!(at("scene.list[1].x"), Some((10, 5)));
        assert_eq!(at("scene.deep.er.y"), Some((12, 5)));
        assert_eq!(at("scene.metric.spin.k[2]"), None);
        assert_eq!(locate("a = ", "a"), None);
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(line_and_column("é = 1\nφφx", 11), (2, 3));
        assert_eq!(line_and_column("a", 99), (1, 2));
        assert_eq!(line_and_column("", 0), (1, 1));
    }

    #[test]
    fn parents_are_cut_at_the_last_step() {
        assert_eq!(parent("a.b[1]"), "a.b");
        assert_eq!(parent("a.b"), "a");
        assert_eq!(parent("a"), "");
    }
}
