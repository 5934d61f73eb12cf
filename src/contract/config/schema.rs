//! JSON schemas (draft 2020-12) of configs, for editors: derived from the very types that read them, so that keys, types, names and
//! what may be left out are those of the reader. Their doc lines become descriptions.
//!
//! What a schema can't say is left to [`Validate`](super::Validate): ranges and orders stand in the descriptions as words. TOML has
//! no null, so an option is a key that may be missing, never a null.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

/// The dialect of all schemas made here.
const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// The schema of parameters, all in one piece, without the key `kind`.
pub fn schema<P: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft2020_12().for_deserialize();
    settings.inline_subschemas = true;
    settings.meta_schema = None;
    let mut schema = settings.into_generator().into_root_schema_for::<P>().to_value();
    without_null(&mut schema);
    schema
}

/// The schema of a whole config: that of its parameters, and `kind = "…"`, which they don't know of.
pub fn with_kind(schema: Value, kind: &str, title: &str) -> Value {
    let Value::Object(mut schema) = schema else { return schema };
    schema.insert("$schema".to_owned(), json!(DIALECT));
    schema.insert("title".to_owned(), json!(title));
    schema.remove("description");
    let kind = json!({ "const": kind, "description": "What the config is for." });
    if let Value::Object(properties) = schema.entry("properties").or_insert_with(|| Value::Object(Map::new())) {
        properties.insert("kind".to_owned(), kind);
    }
    if let Value::Array(required) = schema.entry("required").or_insert_with(|| json!([])) {
        required.insert(0, json!("kind"));
    }
    Value::Object(schema)
}

/// One schema of several: a config is of exactly one kind. Given by kind.
pub fn one_of(schemas: Vec<(&str, Value)>, title: &str) -> Value {
    let references: Vec<Value> = schemas.iter().map(|(kind, _)| json!({ "$ref": format!("#/$defs/{kind}") })).collect();
    let mut definitions = Map::new();
    for (kind, mut schema) in schemas {
        if let Value::Object(schema) = &mut schema {
            schema.remove("$schema");
        }
        definitions.insert(kind.to_owned(), schema);
    }
    json!({ "$schema": DIALECT, "title": title, "type": "object", "oneOf": references, "$defs": definitions })
}

/// Takes the null out of what an option may be, and the default that is one.
fn without_null(schema: &mut Value) {
    match schema {
        Value::Object(fields) => {
            if fields.get("default") == Some(&Value::Null) {
                fields.remove("default");
            }
            if let Some(Value::Array(types)) = fields.get_mut("type") {
                types.retain(|name| name != "null");
                if let [only] = types.as_slice() {
                    let only = only.clone();
                    fields.insert("type".to_owned(), only);
                }
            }
            if let Some(Value::Array(choices)) = fields.get_mut("anyOf") {
                choices.retain(|choice| choice.get("type") != Some(&json!("null")));
            }
            // A choice of one is that one; what is said about it here comes first.
            if fields.get("anyOf").and_then(Value::as_array).is_some_and(|choices| choices.len() == 1)
                && let Some(Value::Array(mut only)) = fields.remove("anyOf")
                && let Some(Value::Object(only)) = only.pop()
            {
                only.into_iter().for_each(|(name, value)| {
                    fields.entry(name).or_insert(value);
                });
            }
            fields.values_mut().for_each(without_null);
        }
        Value::Array(items) => items.iter_mut().for_each(without_null),
        _ => {}
    }
}
