//! From the messages of serde and toml to what a user needs: the key, what is accepted, the nearest name.
//!
//! The messages are those of `serde::de::Error`'s provided methods (`unknown field …, expected one of …`) and of toml's
//! check of struct variants; an unforeseen one is passed on as it is.

use super::error::ConfigProblem;
use super::place::{EMPTY, Place, parent};
use std::ops::Range;

/// Names less alike than this (Jaro-Winkler) are not suggested; clap uses the same bound.
const ALIKE: f64 = 0.7;

/// The accepted name most like the one found.
pub(super) fn nearest(found: &str, accepted: &[String]) -> Option<String> {
    let score = |name: &String| strsim::jaro_winkler(&found.to_lowercase(), &name.to_lowercase());
    let best = accepted.iter().map(|name| (score(name), name)).filter(|(score, _)| *score > ALIKE);
    best.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name.clone())
}

/// Explains an error of serde at a span: which bytes to point at, and what to say.
pub(super) fn explain(
    text: &str,
    places: &[Place],
    span: Range<usize>,
    message: &str,
) -> (Range<usize>, ConfigProblem) {
    let place = find(places, &span);
    let path = place.map_or("", |place| place.path.as_str());
    let shown = place.map_or(0..0, |place| if place.key == span { span.clone() } else { place.shown(text) });
    let names = quoted(message);
    let problem = |key: String, found: String, accepted: String, message: String| ConfigProblem {
        key,
        found,
        accepted,
        message,
        ..ConfigProblem::default()
    };

    if let (true, [name, accepted @ ..]) = (message.starts_with("unknown field"), names.as_slice()) {
        return unknown(shown, path.to_owned(), "key", name, accepted);
    }
    if let Some((extra, available)) =
        message.strip_prefix("unexpected keys in table: ").and_then(|rest| rest.split_once(", available keys: "))
    {
        let accepted: Vec<String> = available.split(", ").map(str::to_owned).collect();
        let first = extra.split(", ").next().unwrap_or(extra);
        return unknown(shown, path.to_owned(), "key", first, &accepted);
    }
    if let (true, [name, accepted @ ..]) = (message.starts_with("unknown variant"), names.as_slice()) {
        return unknown(shown, path.to_owned(), "name", name, accepted);
    }
    if let (true, [name]) = (message.starts_with("missing field"), names.as_slice()) {
        let key = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let said = format!("missing key `{key}`");
        return (shown, problem(key, "nothing".to_owned(), format!("a value for `{name}`"), said));
    }
    let found = written(text, &shown);
    if let Some((what, expected)) = message.strip_prefix("invalid ").and_then(|rest| rest.split_once(", expected ")) {
        let what = what.split([':', ' ']).next().unwrap_or("value");
        let said = format!("wrong {what} of `{path}`");
        return (shown, problem(path.to_owned(), found, plain(expected), said));
    }
    if let Some(expected) = message.strip_prefix("expected ") {
        let name = path.rsplit('.').next().unwrap_or(path);
        // toml's words for a name that was given parameters and has none.
        let accepted = if expected == "empty table" {
            format!("the name alone, \"{name}\": it has no parameters")
        } else {
            plain(expected)
        };
        return (shown, problem(path.to_owned(), found, accepted, format!("wrong value of `{path}`")));
    }
    let said = if path.is_empty() { message.to_owned() } else { format!("`{path}`: {message}") };
    (shown, problem(path.to_owned(), found, String::new(), said))
}

fn unknown(
    shown: Range<usize>,
    path: String,
    what: &str,
    name: &str,
    accepted: &[String],
) -> (Range<usize>, ConfigProblem) {
    let name = if name.is_empty() { EMPTY } else { name };
    // A key is itself the last step of its path; a name stands at one.
    let key = match what {
        "key" if path.is_empty() => name.to_owned(),
        "key" if path != name && !path.ends_with(&format!(".{name}")) => format!("{path}.{name}"),
        _ => path,
    };
    let list: Vec<String> = accepted.iter().map(|name| format!("`{name}`")).collect();
    let list = if list.is_empty() { "nothing".to_owned() } else { list.join(", ") };
    let place = if what == "key" { parent(&key) } else { key.as_str() };
    let place = if place.is_empty() { String::new() } else { format!(" in `{place}`") };
    let problem = ConfigProblem {
        message: format!("unknown {what} `{name}`{place}"),
        found: format!("`{name}`"),
        accepted: list,
        nearest: nearest(name, accepted),
        key,
        ..ConfigProblem::default()
    };
    (shown, problem)
}

/// The place that a span means: that of a key, or the innermost value of that span, or the innermost one around it.
fn find<'a>(places: &'a [Place], span: &Range<usize>) -> Option<&'a Place> {
    let key = places.iter().find(|place| place.key == *span && place.key != place.value);
    let value = || places.iter().rev().find(|place| place.value == *span);
    let around = || {
        let holds = |place: &&Place| place.value.start <= span.start && span.end <= place.value.end;
        places.iter().filter(holds).min_by_key(|place| place.value.len())
    };
    key.or_else(value).or_else(around)
}

/// What stands between backticks.
fn quoted(message: &str) -> Vec<String> {
    message.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// What is written there, cut to one line of reasonable length.
pub(super) fn written(text: &str, span: &Range<usize>) -> String {
    const LONGEST: usize = 60;
    let whole = text.get(span.clone()).unwrap_or("");
    let line: String = whole.lines().next().unwrap_or("").chars().take(LONGEST).collect();
    if line.len() < whole.len() { format!("{} …", line.trim_end()) } else { line }
}

/// serde's names of Rust types in a user's words.
fn plain(expected: &str) -> String {
    let words = match expected {
        "f64" | "f32" => "a number",
        "i8" | "i16" | "i32" | "i64" | "isize" => "a whole number",
        "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number, 0 or larger",
        "a boolean" => "true or false",
        "a sequence" => "a list: [ … ]",
        "a map" => "a table: { key = … }",
        "a string" => "a text in quotes",
        _ if expected.starts_with("struct ") || expected.starts_with("internally tagged") => "a table: { key = … }",
        _ => expected,
    };
    words.to_owned()
}
