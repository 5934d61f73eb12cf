//! From TOML text to checked parameters.

use super::error::{ConfigError, ConfigProblem};
use super::explain::{explain, written};
use super::place::{Place, Shape, parent, places};
use super::validate::{Invalid, Validate};
use crate::contract::digest::{Digest, Framed};
use crate::contract::manifest::{self, Line};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::HashMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The key that names what a config is for; the reader of the parameters need not know it.
const KIND: &str = "kind";

/// Reads and checks parameters from the text of a config.
///
/// The top-level `kind` is left out when the parameters have no field of that name.
///
/// # Errors
/// The first thing that is wrong, in this order: syntax, a number that is not finite, unknown keys, wrong types, missing
/// keys, values that [`Validate`] does not accept.
pub fn read<P: DeserializeOwned + Serialize + Validate>(file: &str, text: &str) -> Result<P, ConfigError> {
    let document = parse(file, text)?;
    let places = places(document.get_ref());
    finite(file, text, document.get_ref(), &places)?;
    let fail = |error: &toml::de::Error| {
        let (span, problem) = explain(text, &places, error.span().unwrap_or(0..0), error.message());
        ConfigError::at(file, text, span, problem)
    };
    let params: P = match P::deserialize(toml::de::Deserializer::from(document.clone())) {
        Ok(params) => params,
        Err(error) if fail(&error).key == KIND && error.message().starts_with("unknown field") => {
            let mut document = document;
            document.get_mut().remove(KIND);
            P::deserialize(toml::de::Deserializer::from(document)).map_err(|error| fail(&error))?
        }
        Err(error) => return Err(fail(&error)),
    };
    shapes(file, text, &places, &params)?;
    params.validate().map_err(|invalid| refused(file, text, &places, invalid))?;
    Ok(params)
}

/// The top-level `kind` of a config: `kind = "fig7"`.
///
/// # Errors
/// A syntax error, or no `kind` that is a text.
pub fn peek_kind(file: &str, text: &str) -> Result<String, ConfigError> {
    let document = parse(file, text)?;
    let accepted = "kind = \"…\", the name of an experiment module or \"scene\"; `polhode list` shows them".to_owned();
    let key = KIND.to_owned();
    match document.get_ref().get(KIND).map(|value| (value.span(), value.get_ref())) {
        Some((_, DeValue::String(kind))) if !kind.is_empty() => Ok(kind.to_string()),
        Some((span, _)) => {
            let (found, message) = (written(text, &span), "`kind` is not a name".to_owned());
            let problem = ConfigProblem { key, found, accepted, message, ..ConfigProblem::default() };
            Err(ConfigError::at(file, text, span, problem))
        }
        None => {
            let (found, message) = ("nothing".to_owned(), "missing key `kind`".to_owned());
            let names: Vec<String> = document.get_ref().keys().map(|key| key.get_ref().to_string()).collect();
            let similar = super::explain::nearest(KIND, &names);
            let place = document.get_ref().keys().find(|key| Some(key.get_ref().as_ref()) == similar.as_deref());
            let (span, found) = place.map_or((0..0, found), |key| (key.span(), format!("`{}`", key.get_ref())));
            let nearest = similar.map(|_| KIND.to_owned());
            let problem = ConfigProblem { key, found, accepted, message, nearest, ..ConfigProblem::default() };
            Err(ConfigError::at(file, text, span, problem))
        }
    }
}

/// The error for a `kind` that is a name, but none of the known ones.
pub fn unknown_kind(file: &str, text: &str, known: &[&str]) -> ConfigError {
    let document = match parse(file, text) {
        Ok(document) => document,
        Err(error) => return error,
    };
    let value = document.get_ref().get(KIND);
    let span = value.map_or(0..0, Spanned::span);
    let kind = value.and_then(|value| value.get_ref().as_str()).unwrap_or_default();
    let known: Vec<String> = known.iter().map(|name| (*name).to_owned()).collect();
    let problem = ConfigProblem {
        key: KIND.to_owned(),
        found: written(text, &span),
        accepted: known.join(", "),
        nearest: super::explain::nearest(kind, &known),
        message: "`kind` is the name of no experiment".to_owned(),
        ..ConfigProblem::default()
    };
    ConfigError::at(file, text, span, problem)
}

/// What a config says, as leaves in order of their paths: comments, layout and the order of keys are not in them; `0.80`
/// is `0.8`, and `1` is `1.0`.
///
/// # Errors
/// A syntax error.
pub fn leaves(file: &str, text: &str) -> Result<Vec<Line>, ConfigError> {
    parse(file, text)?;
    let whole = |message: String| ConfigError::whole_file(file, message, "TOML");
    let document: toml::Value = toml::from_str(text).map_err(|error| whole(error.to_string()))?;
    let mut lines = manifest::describe(&with_floats(document)).map_err(|error| whole(error.to_string()))?;
    lines.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(lines)
}

/// The digest of a config's [`leaves`].
///
/// # Errors
/// A syntax error.
pub fn digest(file: &str, text: &str) -> Result<Digest, ConfigError> {
    let manifest = manifest::Manifest { lines: leaves(file, text)? };
    let mut framed = Framed::new("polhode config 1");
    framed.field(&manifest.key().0);
    Ok(framed.finish())
}

fn with_floats(value: toml::Value) -> toml::Value {
    /// Up to here every integer is a float.
    const EXACT: u64 = 1 << f64::MANTISSA_DIGITS;
    match value {
        toml::Value::Integer(x) if x.unsigned_abs() <= EXACT => toml::Value::Float(x as f64),
        toml::Value::Array(items) => toml::Value::Array(items.into_iter().map(with_floats).collect()),
        toml::Value::Table(table) => {
            toml::Value::Table(table.into_iter().map(|(key, value)| (key, with_floats(value))).collect())
        }
        other => other,
    }
}

fn parse<'t>(file: &str, text: &'t str) -> Result<Spanned<DeTable<'t>>, ConfigError> {
    DeTable::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let problem = ConfigProblem {
            message: format!("not TOML: {}", error.message().lines().next().unwrap_or("")),
            found: written(text, &span),
            ..ConfigProblem::default()
        };
        ConfigError::at(file, text, span, problem)
    })
}

/// TOML knows `nan` and `inf`; no quantity here does. A decimal too large for a float is refused with them.
fn finite(file: &str, text: &str, document: &DeTable<'_>, places: &[Place]) -> Result<(), ConfigError> {
    fn in_value(value: &DeValue<'_>, bad: &mut Vec<usize>, start: usize) {
        match value {
            DeValue::Float(x) if !x.as_str().parse::<f64>().is_ok_and(f64::is_finite) => bad.push(start),
            DeValue::Array(items) => items.iter().for_each(|item| in_value(item.get_ref(), bad, item.span().start)),
            DeValue::Table(table) => table.iter().for_each(|(_, v)| in_value(v.get_ref(), bad, v.span().start)),
            _ => {}
        }
    }
    let mut bad = Vec::new();
    document.iter().for_each(|(_, value)| in_value(value.get_ref(), &mut bad, value.span().start));
    let Some(first) = bad.into_iter().min() else { return Ok(()) };
    let Some(place) = places.iter().rev().find(|place| place.value.start == first) else { return Ok(()) };
    let problem = ConfigProblem {
        key: place.path.clone(),
        found: written(text, &place.value),
        accepted: "a finite number".to_owned(),
        message: format!("`{}` is not a finite number", place.path),
        ..ConfigProblem::default()
    };
    Err(ConfigError::at(file, text, place.value.clone(), problem))
}

/// serde's derived readers take a list for a table, its elements for the fields in their order, and a table for a name: nobody means
/// that in a config. What was read, written again, tells what each place should be.
fn shapes<P: Serialize>(file: &str, text: &str, places: &[Place], params: &P) -> Result<(), ConfigError> {
    fn walk<'v>(value: &'v toml::Value, path: String, found: &mut HashMap<String, &'v toml::Value>) {
        match value {
            toml::Value::Table(table) => table.iter().for_each(|(key, inner)| {
                walk(inner, if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, found);
            }),
            toml::Value::Array(items) => {
                items.iter().enumerate().for_each(|(index, inner)| walk(inner, format!("{path}[{index}]"), found));
            }
            _ => {}
        }
        found.insert(path, value);
    }
    // What can't be written is found out when nodes are made of it.
    let Ok(value) = toml::Value::try_from(params) else { return Ok(()) };
    let mut meant = HashMap::new();
    walk(&value, String::new(), &mut meant);
    for place in places {
        let accepted = match (place.shape, meant.get(&place.path)) {
            (Shape::List, Some(toml::Value::Table(_))) => "a table: { key = … }",
            (Shape::Table, Some(toml::Value::Array(_))) => "a list: [ … ]",
            (Shape::List | Shape::Table, Some(toml::Value::String(_))) => "a text in quotes",
            _ => continue,
        };
        let problem = ConfigProblem {
            key: place.path.clone(),
            found: written(text, &place.shown(text)),
            accepted: accepted.to_owned(),
            message: format!("wrong type of `{}`", place.path),
            ..ConfigProblem::default()
        };
        return Err(ConfigError::at(file, text, place.shown(text), problem));
    }
    Ok(())
}

/// A value that is not accepted, shown where it stands, or where the innermost table of its path stands (a default that
/// another value makes wrong stands nowhere).
fn refused(file: &str, text: &str, places: &[Place], invalid: Invalid) -> ConfigError {
    let mut path = invalid.key.as_str();
    let place = loop {
        match places.iter().find(|place| place.path == path) {
            None if !path.is_empty() => path = parent(path),
            other => break other,
        }
    };
    let span = place.map_or(0..0, |place| place.shown(text));
    let message = format!("`{}` is not accepted", invalid.key);
    let Invalid { key, found, accepted } = invalid;
    ConfigError::at(file, text, span, ConfigProblem { key, found, accepted, message, ..ConfigProblem::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::sweep::Sweep;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Params {
        scene: Scene,
        #[serde(default)]
        count: u32,
    }

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Scene {
        metric: Metric,
        #[serde(default)]
        effects: Vec<Effect>,
        bounds: Option<[f64; 2]>,
    }

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case", deny_unknown_fields)]
    enum Metric {
        Spin(Spin),
        SerretAndoyer {
            #[serde(rename = "A")]
            a: f64,
        },
    }

    #[derive(Debug, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Spin {
        k: Sweep,
    }

    #[derive(Debug, Serialize, Deserialize, PartialEq)]
    #[serde(rename_all = "kebab-case")]
    enum Effect {
        Geodesics,
        ConjugateLocus,
    }

    impl Validate for Params {
        fn validate(&self) -> Result<(), Invalid> {
            Invalid::unless(self.count < 10, "count", self.count, "count < 10")?;
            match &self.scene.metric {
                Metric::Spin(spin) => spin
                    .k
                    .validate_each("k", "k > 0", |k| k > 0.0)
                    .map_err(|invalid| invalid.within("scene.metric.spin")),
                Metric::SerretAndoyer { a } => Invalid::unless(*a > 0.0, "scene.metric.serret-andoyer.A", a, "A > 0"),
            }
        }
    }

    const GOOD: &str = "\
# Figure 7
kind = \"scene\"
count = 3
[scene]
metric.spin = { k = [0.8, 0.5] }
effects = [\"geodesics\", \"conjugate-locus\"]
";

    /// The error of GOOD with one piece of its text replaced.
    fn error(old: &str, new: &str) -> ConfigError {
        assert_eq!(GOOD.matches(old).count(), 1, "{old}");
        let error = read::<Params>("experiments/fig7.toml", &GOOD.replace(old, new)).expect_err(new);
        assert_eq!(error.file, "experiments/fig7.toml");
        error
    }

    /// (line, column, key, found, nearest)
    type Summary<'a> = (usize, usize, &'a str, &'a str, Option<&'a str>);

    fn summary(error: &ConfigError) -> Summary<'_> {
        (error.line, error.column, &error.key, &error.found, error.nearest.as_deref())
    }

    #[test]
    fn a_good_config_is_read_with_or_without_a_field_for_kind() {
        let params: Params = read("f", GOOD).expect("good");
        assert_eq!(params.scene.effects, [Effect::Geodesics, Effect::ConjugateLocus]);
        assert_eq!(params.scene.bounds, None);
        #[derive(Debug, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        struct WithKind {
            kind: String,
        }
        impl Validate for WithKind {
            fn validate(&self) -> Result<(), Invalid> {
                Ok(())
            }
        }
        assert_eq!(read::<WithKind>("f", "kind = \"fig1\"").map(|params| params.kind), Ok("fig1".to_owned()));
        assert!(read::<WithKind>("f", "").is_err());
    }

    #[test]
    fn misspelt_keys_at_every_depth() {
        let top = error("count = 3", "cuont = 3");
        assert_eq!(summary(&top), (3, 1, "cuont", "`cuont`", Some("count")));
        assert_eq!(top.accepted, "`scene`, `count`");
        let empty = error("count = 3", "\"\" = 3");
        assert_eq!(summary(&empty), (3, 1, "\"\"", "`\"\"`", None));
        let nested = error("metric.spin", "metrics.spin");
        assert_eq!(summary(&nested), (5, 1, "scene.metrics", "`metrics`", Some("metric")));
        let variant = error("metric.spin", "metric.spim");
        assert_eq!(summary(&variant), (5, 8, "scene.metric.spim", "`spim`", Some("spin")));
        let inline = error("k = [0.8, 0.5]", "kk = [0.8, 0.5]");
        assert_eq!(summary(&inline), (5, 17, "scene.metric.spin.kk", "`kk`", Some("k")));
        let range = error("[0.8, 0.5]", "{ from = 1, to = 2, cuont = 3 }");
        assert_eq!(summary(&range), (5, 41, "scene.metric.spin.k.cuont", "`cuont`", Some("count")));
        let in_variant = error("spin = { k = [0.8, 0.5] }", "serret-andoyer = { A = 1, B = 2 }");
        assert_eq!(summary(&in_variant), (5, 34, "scene.metric.serret-andoyer.B", "`B`", None));
        let far = error("count = 3", "zebra = 3");
        assert_eq!(far.nearest, None);
        let name = error("\"geodesics\"", "\"geodesic\"");
        assert_eq!(summary(&name), (6, 12, "scene.effects[0]", "`geodesic`", Some("geodesics")));
        assert_eq!(name.accepted, "`geodesics`, `conjugate-locus`");
    }

    #[test]
    fn wrong_types() {
        let text = error("[0.8, 0.5]", "\"0.8\"");
        assert_eq!(summary(&text), (5, 21, "scene.metric.spin.k", "\"0.8\"", None));
        assert!(text.accepted.starts_with("a number, a list of numbers, or"), "{}", text.accepted);
        let element = error("[0.8, 0.5]", "[0.8, true]");
        assert_eq!(summary(&element), (5, 27, "scene.metric.spin.k[1]", "true", None));
        assert_eq!(element.accepted, "a number");
        let whole = error("count = 3", "count = 3.5");
        assert_eq!(summary(&whole), (3, 9, "count", "3.5", None));
        let negative = error("count = 3", "count = -3");
        assert_eq!(summary(&negative), (3, 9, "count", "-3", None));
        assert_eq!(negative.accepted, "a whole number, 0 or larger");
        let table = error("{ k = [0.8, 0.5] }", "0.8");
        assert_eq!(summary(&table), (5, 15, "scene.metric.spin", "0.8", None));
        assert_eq!(table.accepted, "a table: { key = … }");
        // A list of a table's values, a table in place of a name.
        let list = error("{ k = [0.8, 0.5] }", "[[0.8, 0.5], 1]");
        assert_eq!(summary(&list), (5, 15, "scene.metric.spin", "[[0.8, 0.5], 1]", None));
        assert_eq!(list.accepted, "a table: { key = … }");
        let name = error("\"geodesics\"", "{ geodesics = {} }");
        assert_eq!((name.line, name.key.as_str()), (6, "scene.effects[0]"));
        let short = error("[scene]", "[scene]\nbounds = [1.0]");
        assert_eq!(summary(&short), (5, 10, "scene.bounds", "[1.0]", None));
        let spacing = error("[0.8, 0.5]", "{ from = 1, to = 2, count = 3, spacing = \"logg\" }");
        assert_eq!(summary(&spacing), (5, 62, "scene.metric.spin.k.spacing", "`logg`", Some("log")));
    }

    #[test]
    fn missing_keys_point_at_the_table_that_lacks_them() {
        let inline = error("k = [0.8, 0.5]", "");
        assert_eq!(summary(&inline), (5, 15, "scene.metric.spin.k", "nothing", None));
        let range = error("[0.8, 0.5]", "{ from = 1, to = 2 }");
        assert_eq!(summary(&range), (5, 21, "scene.metric.spin.k.count", "nothing", None));
        let header = error("metric.spin = { k = [0.8, 0.5] }", "");
        assert_eq!(summary(&header), (4, 2, "scene.metric", "nothing", None));
        let top = read::<Params>("f", "kind = \"scene\"\n").expect_err("no scene");
        assert_eq!(summary(&top), (1, 1, "scene", "nothing", None));
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused_everywhere() {
        for bad in ["nan", "-inf", "1e400"] {
            let element = error("0.5]", &format!("{bad}]"));
            assert_eq!(summary(&element), (5, 27, "scene.metric.spin.k[1]", bad, None));
            assert_eq!(element.accepted, "a finite number");
        }
        assert_eq!(error("count = 3", "count = nan").key, "count");
        // In a nested inline table, and before the complaint about the unknown key.
        let inline = error("[0.8, 0.5]", "{ from = 1, tu = inf, count = 3 }");
        assert_eq!(summary(&inline), (5, 38, "scene.metric.spin.k.tu", "inf", None));
    }

    #[test]
    fn values_out_of_range_and_empty_lists() {
        let empty = error("[0.8, 0.5]", "[]");
        assert_eq!(summary(&empty), (5, 21, "scene.metric.spin.k", "[]", None));
        assert_eq!(empty.accepted, "at least one value");
        let negative = error("0.5]", "-0.5]");
        assert_eq!(summary(&negative), (5, 27, "scene.metric.spin.k[1]", "-0.5", None));
        assert_eq!(negative.accepted, "k > 0");
        assert_eq!(summary(&error("count = 3", "count = 30")), (3, 9, "count", "30", None));
    }

    #[test]
    fn parameters_of_a_name_that_has_none() {
        let error = error("\"geodesics\"", "{ geodesics = { count = 3 } }");
        assert_eq!(error.key, "scene.effects[0].geodesics");
        assert_eq!((error.found.as_str(), error.line), ("{ count = 3 }", 6));
        assert_eq!(error.accepted, "the name alone, \"geodesics\": it has no parameters");
    }

    #[test]
    fn syntax_errors() {
        let open = error("count = 3", "count = ");
        assert_eq!((open.line, open.key.as_str()), (3, ""), "{open}");
        // A list may go on in the next line, so that is where its end is missed.
        let unclosed = error("[0.8, 0.5] }", "[0.8, 0.5");
        assert_eq!((unclosed.line, unclosed.column), (6, 1), "{unclosed}");
        let twice = error("count = 3", "count = 3\ncount = 4");
        assert_eq!((twice.line, twice.column), (4, 1), "{twice}");
        assert!(twice.message.contains("duplicate key"), "{twice}");
    }

    #[test]
    fn the_message_shows_the_line_with_a_caret_and_what_to_do() {
        let message = error("0.5]", "-0.5]").to_string();
        let expected = "\
`scene.metric.spin.k[1]` is not accepted
 --> experiments/fig7.toml:5:27
  |
5 | metric.spin = { k = [0.8, -0.5] }
  |                           ^^^^
  = key: scene.metric.spin.k[1]
  = found: -0.5
  = accepted: k > 0
  = next: correct `scene.metric.spin.k[1]` in experiments/fig7.toml and run again";
        assert_eq!(message, expected);
        let json = serde_json::to_value(error("count = 3", "cuont = 3")).expect("serialises");
        assert_eq!((json["line"].as_u64(), json["nearest"].as_str()), (Some(3), Some("count")));
    }

    #[test]
    fn the_kind_is_read_before_anything_else() {
        assert_eq!(peek_kind("f", GOOD), Ok("scene".to_owned()));
        let wrong = peek_kind("f", "\nkind = 7\n").expect_err("no name");
        assert_eq!(summary(&wrong), (2, 8, "kind", "7", None));
        let near = peek_kind("f", "\nkinds = \"fig7\"\n").expect_err("misspelt");
        assert_eq!(summary(&near), (2, 1, "kind", "`kinds`", Some("kind")));
        assert_eq!(peek_kind("f", "").expect_err("empty").key, "kind");
    }

    #[test]
    fn the_digest_is_that_of_the_values() {
        let digest = |text: &str| digest("f", text).expect("TOML");
        let original = digest(GOOD);
        assert_eq!(digest(&GOOD.replace("0.8,", "0.80, # so\n")), original);
        assert_eq!(digest(&GOOD.replace("count = 3", "count = 3.0")), original);
        let reordered = "count = 3\nscene.effects = [\"geodesics\", \"conjugate-locus\"]\nkind = 'scene'\n\
            [scene.metric.spin]\nk = [0.8, 0.5]\n";
        assert_eq!(digest(reordered), original);
        assert_ne!(digest(&GOOD.replace("0.8", "0.7")), original);
        assert_ne!(digest(&GOOD.replace("[0.8, 0.5]", "[]")), original);
    }
}
