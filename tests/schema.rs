//! `polhode schema` says what the reader of configs does: every config of this repository fits its schema, and wherever a config is
//! changed, schema and reader refuse alike, as far as a schema can know (ranges and orders are the reader's alone). The oracle is
//! the reader itself; keys are compared with the list of accepted ones in its messages.

#![expect(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

mod support;

use polhode::cli::arguments::SCENES;
use polhode::cli::schema::schema;
use polhode::contract::plan::ConfigSource;
use polhode::experiments;
use polhode::experiments::definition::PlanError;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use support::{Workspace, all_experiments, repository};

/// A checker of the part of JSON schema that is used here; any other keyword is an error of this test.
fn fits(schema: &Value, value: &Value, root: &Value) -> bool {
    let number = |limit: &Value| limit.as_f64().expect("a number");
    let count = |limit: &Value| usize::try_from(limit.as_u64().expect("a count")).expect("small");
    let list = |of: &Value| of.as_array().expect("a list").clone();
    schema.as_object().expect("a schema").iter().all(|(keyword, says)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" | "default" | "format" => true,
        "$ref" => {
            let pointer = says.as_str().and_then(|name| name.strip_prefix('#')).expect("of this document");
            fits(root.pointer(pointer).expect("defined"), value, root)
        }
        "type" => match says.as_str().expect("one type") {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
            other => panic!("type {other}"),
        },
        "const" => value == says,
        "enum" => list(says).contains(value),
        "anyOf" => list(says).iter().any(|choice| fits(choice, value, root)),
        "oneOf" => list(says).iter().filter(|choice| fits(choice, value, root)).count() == 1,
        "minimum" => value.as_f64().is_none_or(|x| x >= number(says)),
        "maximum" => value.as_f64().is_none_or(|x| x <= number(says)),
        "minItems" => value.as_array().is_none_or(|items| items.len() >= count(says)),
        "maxItems" => value.as_array().is_none_or(|items| items.len() <= count(says)),
        "minProperties" => value.as_object().is_none_or(|fields| fields.len() >= count(says)),
        "maxProperties" => value.as_object().is_none_or(|fields| fields.len() <= count(says)),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| fits(says, item, root))),
        "prefixItems" => value
            .as_array()
            .is_none_or(|items| list(says).iter().zip(items).all(|(schema, item)| fits(schema, item, root))),
        "required" => value
            .as_object()
            .is_none_or(|fields| list(says).iter().all(|name| fields.contains_key(name.as_str().expect("a name")))),
        "properties" => value.as_object().is_none_or(|fields| {
            fields.iter().all(|(name, field)| says.get(name).is_none_or(|schema| fits(schema, field, root)))
        }),
        "additionalProperties" => {
            assert_eq!(says, &json!(false), "tables are closed");
            let known = schema["properties"].as_object().expect("properties");
            value.as_object().is_none_or(|fields| fields.keys().all(|name| known.contains_key(name)))
        }
        other => panic!("keyword {other}"),
    })
}

/// The configs of the repository, those that scenes begin with, and one with every key that no other has: by kind.
fn configs() -> Vec<(String, Value)> {
    let read = |id: &String| std::fs::read_to_string(repository().join(format!("experiments/{id}.toml")));
    let mut texts: Vec<String> = all_experiments().iter().map(|id| read(id).expect("a config")).collect();
    texts.extend(SCENES.map(|(_, text)| text.to_owned()));
    texts.push(
        "kind = \"scene\"\naccuracy_is_default = 0\n[scene]\nmetric.spin = { k = { from = 0.5, to = 0.8, count = 2 } }\n\
         start = { p_theta = { from = 1e-3, to = 1e3, step = 0.2 } }\neffects = [\"geodesics\"]\n\
         [trajectories]\ncount = 3\nstep = 0.1\n[wave_front]\nt = { from = 0.5, to = 1, count = 2, spacing = \"log\" }\n\
         [picture]\n"
            .replace("accuracy_is_default = 0\n", ""),
    );
    let parsed = texts.into_iter().map(|text| {
        let value: toml::Value = toml::from_str(&text).expect("TOML");
        let value = serde_json::to_value(value).expect("JSON");
        (value["kind"].as_str().expect("a kind").to_owned(), value)
    });
    parsed.collect()
}

/// What the reader says: nothing, or its message and the names in what it accepts.
fn refusal(kind: &str, config: &Value) -> Option<(String, BTreeSet<String>)> {
    let text = toml::to_string(config).expect("TOML");
    let experiment = experiments::ALL.iter().find(|experiment| experiment.kind == kind).expect("a kind");
    match experiment.plan("x", &ConfigSource { file: "x.toml".to_owned(), text }, None) {
        Ok(_) => None,
        Err(PlanError::Config(error)) => {
            let names = error.accepted.split('`').skip(1).step_by(2).map(str::to_owned).collect();
            Some((error.message.clone(), names))
        }
        Err(error) => panic!("{error}"),
    }
}

/// Whether a message is about keys, types and names, which a schema knows, and not about a value's range.
fn is_of_form(message: &str) -> bool {
    ["wrong ", "unknown ", "missing key"].iter().any(|begin| message.starts_with(begin))
}

/// The schemas that speak about the table at a place: by their keys. Choices are followed all.
fn tables_at<'s>(schema: &'s Value, path: &[String], found: &mut Vec<&'s Map<String, Value>>) {
    for choice in schema.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
        tables_at(choice, path, found);
    }
    match path {
        [] => found.extend(schema.get("properties").and_then(Value::as_object)),
        [step, rest @ ..] => {
            let below = schema.get("properties").and_then(|fields| fields.get(step)).or(schema.get("items"));
            below.into_iter().for_each(|below| tables_at(below, rest, found));
        }
    }
}

/// The places of all tables that a schema speaks about; elements of a list are one place.
fn tables_of(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    for choice in schema.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
        tables_of(choice, path, found);
    }
    if let Some(fields) = schema.get("properties").and_then(Value::as_object) {
        found.insert(path.to_owned());
        fields.iter().for_each(|(name, field)| tables_of(field, &format!("{path}/{name}"), found));
    }
    schema.get("items").into_iter().for_each(|items| tables_of(items, &format!("{path}/0"), found));
}

/// All places of a value, below the top.
fn places(value: &Value, path: &[String], found: &mut Vec<Vec<String>>) {
    let below: Vec<(String, &Value)> = match value {
        Value::Object(fields) => fields.iter().map(|(name, field)| (name.clone(), field)).collect(),
        Value::Array(items) => items.iter().enumerate().map(|(i, item)| (i.to_string(), item)).collect(),
        _ => Vec::new(),
    };
    for (name, field) in below {
        let path = [path, &[name]].concat();
        found.push(path.clone());
        places(field, &path, found);
    }
}

fn pointer(path: &[String]) -> String {
    path.iter().map(|step| format!("/{step}")).collect()
}

#[test]
fn every_config_fits_its_schema_and_no_other() {
    let all = schema(None).expect("a schema");
    for (kind, config) in configs() {
        let own = schema(Some(&kind)).expect("a schema");
        assert_eq!(refusal(&kind, &config), None, "{kind}");
        assert!(fits(&own, &config, &own) && fits(&all, &config, &all), "{kind}");
        for other in experiments::ALL.iter().filter(|other| other.kind != kind) {
            assert!(!fits(&other.schema(), &config, &all), "{kind} is no {}", other.kind);
        }
    }
    assert_eq!(schema(Some("fig99")), None);
}

/// In every table: the keys of the schema are those that the reader accepts, and no table of a schema is left out.
#[test]
fn keys_are_those_of_the_reader() {
    let mut seen: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (kind, config) in configs() {
        let own = schema(Some(&kind)).expect("a schema");
        let mut found = vec![Vec::new()];
        places(&config, &[], &mut found);
        for path in found {
            let mut changed = config.clone();
            let Some(Value::Object(table)) = changed.pointer_mut(&pointer(&path)) else { continue };
            table.insert("zzz".to_owned(), json!(1));
            assert!(!fits(&own, &changed, &own), "{kind} {path:?}");
            let (message, accepted) = refusal(&kind, &changed).expect("refused");
            // A name with parameters is a table of one key: a second one is too many, whatever its name.
            if message.contains("exactly 1 element") {
                assert_eq!(path.last().map(String::as_str), Some("family"), "{kind} {path:?}: {message}");
                continue;
            }
            assert!(message.starts_with("unknown key `zzz`"), "{kind} {path:?}: {message}");
            // Parameters under one of several names: that they are refused was seen; their lists are not compared.
            if path.iter().any(|step| step == "family") {
                continue;
            }
            let mut tables = Vec::new();
            tables_at(&own, &path, &mut tables);
            let mut keys: BTreeSet<String> = tables.iter().flat_map(|table| table.keys().cloned()).collect();
            if path.is_empty() {
                assert!(keys.remove("kind"));
            }
            assert_eq!(keys, accepted, "{kind} {path:?}");
            let place =
                path.iter().map(|step| if step.parse::<usize>().is_ok() { "/0".into() } else { format!("/{step}") });
            seen.entry(kind.clone()).or_default().insert(place.collect());
        }
    }
    for experiment in experiments::ALL {
        let mut all = BTreeSet::new();
        tables_of(&experiment.schema(), "", &mut all);
        let mut left = all;
        left.retain(|place| !seen[experiment.kind].contains(place));
        // A range in place of a number or a list is read by the same code everywhere: seen where some config has one.
        left.retain(|place| {
            let mut tables = Vec::new();
            let path: Vec<String> = place.split('/').skip(1).map(str::to_owned).collect();
            let schema = experiment.schema();
            tables_at(&schema, &path, &mut tables);
            !tables.iter().all(|table| table.keys().eq(["count", "from", "spacing", "to"]))
        });
        assert!(left.is_empty(), "{}: no config with {left:?}", experiment.kind);
    }
}

/// At every place of every config: another type, a misspelt name, a missing key. What the reader refuses for its form the
/// schema refuses; what the schema refuses the reader does.
#[test]
fn what_is_wrong_in_form_is_refused_by_both() {
    let wrong = [
        json!(true),
        json!("zzz"),
        json!(0.5),
        json!(-1),
        json!([]),
        json!({}),
        json!([[1]]),
        json!([1.5, "x"]),
        json!({ "lin": {} }),
        json!({ "geodesics": {} }),
        json!({ "from": 1.0 }),
        json!({ "from": 1.0, "to": 2.0, "count": "3" }),
        json!({ "from": 1.0, "to": 2.0, "count": 3, "spacing": "cubic" }),
    ];
    let (mut by_both, mut by_the_reader, mut differ) = (0, 0, Vec::new());
    for (kind, config) in configs() {
        let own = schema(Some(&kind)).expect("a schema");
        let mut found = Vec::new();
        places(&config, &[], &mut found);
        let mut judge = |changed: &Value, what: String| {
            let (fits, refused) = (fits(&own, changed, &own), refusal(&kind, changed));
            match (fits, refused) {
                (false, Some(_)) => by_both += 1,
                (true, None) => {}
                (true, Some((message, _))) if !is_of_form(&message) => by_the_reader += 1,
                (fits, refused) => differ.push(format!("{kind} {what}: fits {fits}, the reader: {refused:?}")),
            }
        };
        for path in found.iter().filter(|path| path.as_slice() != ["kind"]) {
            for wrong in &wrong {
                let mut changed = config.clone();
                *changed.pointer_mut(&pointer(path)).expect("there") = wrong.clone();
                judge(&changed, format!("{path:?} = {wrong}"));
            }
            let (name, table) = path.split_last().expect("below the top");
            let mut changed = config.clone();
            if let Some(Value::Object(table)) = changed.pointer_mut(&pointer(table)) {
                table.remove(name);
                judge(&changed, format!("no {path:?}"));
            }
        }
    }
    assert!(differ.is_empty(), "{} of {by_both}:\n{}", differ.len(), differ.join("\n"));
    assert!(by_both >= 2000 && by_the_reader >= 200, "{by_both} by both, {by_the_reader} by the reader alone");
}

/// Editors show the doc lines, with their units and ranges.
#[test]
fn every_key_is_described() {
    fn undescribed(schema: &Value, path: &str, found: &mut Vec<String>) {
        for (name, field) in schema.get("properties").and_then(Value::as_object).into_iter().flatten() {
            if field.get("description").and_then(Value::as_str).is_none_or(str::is_empty) {
                found.push(format!("{path}.{name}"));
            }
            undescribed(field, &format!("{path}.{name}"), found);
        }
    }
    let mut found = Vec::new();
    for experiment in experiments::ALL {
        undescribed(&experiment.schema(), experiment.kind, &mut found);
    }
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn the_command_prints_them() {
    let workspace = Workspace::with::<&str>(&[]);
    for (line, kind) in [("schema", None), ("schema fig7", Some("fig7"))] {
        let printed: Value = serde_json::from_str(&workspace.line(line).ends(0).out).expect("JSON");
        assert_eq!(Some(printed), schema(kind));
    }
    let ran = workspace.line("schema fig77").ends(2);
    assert!(ran.err.contains("fig7"), "{}", ran.err);
}
