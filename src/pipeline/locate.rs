//! Where a parameter stands in its config: for messages only, never part of a key.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The config's key that a leaf comes from: by the longest origin that is the leaf or holds it, else the leaf itself. An
/// origin with an empty key stands for the config as a whole.
pub(super) fn config_key(origins: &[(String, String)], leaf: &str) -> String {
    let holds = |origin: &str| {
        leaf.strip_prefix(origin).is_some_and(|rest| rest.is_empty() || rest.starts_with('.') || rest.starts_with('['))
    };
    let found = origins.iter().filter(|(origin, _)| holds(origin)).max_by_key(|(origin, _)| origin.len());
    let key = |(origin, key): &(String, String)| format!("{key}{}", &leaf[origin.len()..]);
    found.map_or_else(|| leaf.to_owned(), |origin| key(origin).trim_start_matches('.').to_owned())
}

/// The line, from 1, of a key such as `scene.metric.spin.k[2]`; of as much of it as is there. None when nothing is.
pub(super) fn line(text: &str, key: &str) -> Option<usize> {
    let table = DeTable::parse(text).ok()?;
    let offset = offset(table.get_ref(), &segments(key))?;
    Some(text.get(..offset)?.matches('\n').count() + 1)
}

enum Segment<'a> {
    Name(&'a str),
    Index(usize),
}

fn segments(key: &str) -> Vec<Segment<'_>> {
    let mut segments = Vec::new();
    for part in key.split('.') {
        let mut pieces = part.split('[');
        segments.extend(pieces.next().map(Segment::Name));
        segments.extend(pieces.filter_map(|piece| piece.strip_suffix(']')?.parse().ok()).map(Segment::Index));
    }
    segments
}

fn offset(table: &DeTable<'_>, segments: &[Segment<'_>]) -> Option<usize> {
    let (Segment::Name(name), rest) = segments.split_first()? else { return None };
    let (key, value) = table.iter().find(|(key, _)| key.get_ref() == name)?;
    Some(offset_in(value, rest).unwrap_or_else(|| key.span().start))
}

fn offset_in(value: &Spanned<DeValue<'_>>, segments: &[Segment<'_>]) -> Option<usize> {
    match (value.get_ref(), segments.split_first()?) {
        (DeValue::Table(table), _) => offset(table, segments),
        (DeValue::Array(items), (Segment::Index(index), rest)) => {
            let item = items.get(*index)?;
            Some(offset_in(item, rest).unwrap_or_else(|| item.span().start))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONFIG: &str =
        "kind = \"scene\"\n\n[scene]\nmetric.spin = { k = [\n  0.8,\n  0.5,\n] }\n# start\nstart = 1.0\n";

    #[test]
    fn lines_of_keys() {
        assert_eq!(line(CONFIG, "kind"), Some(1));
        assert_eq!(line(CONFIG, "scene.start"), Some(9));
        assert_eq!(line(CONFIG, "scene.metric.spin.k"), Some(4));
        assert_eq!(line(CONFIG, "scene.metric.spin.k[1]"), Some(6));
        assert_eq!(line(CONFIG, "scene.start.deeper"), Some(9));
        assert_eq!(line(CONFIG, "nothing"), None);
        assert_eq!(line("not = = toml", "not"), None);
    }

    #[test]
    fn the_longest_origin_counts() {
        let origins = [("k".to_owned(), "scene.k".to_owned()), ("k.list".to_owned(), "scene.list".to_owned())];
        assert_eq!(config_key(&origins, "k"), "scene.k");
        assert_eq!(config_key(&origins, "k.list[3]"), "scene.list[3]");
        assert_eq!(config_key(&origins, "kk"), "kk");
        assert_eq!(config_key(&[("config".to_owned(), String::new())], "config.scene.k[1]"), "scene.k[1]");
    }
}
