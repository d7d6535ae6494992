//! The schema of reports says in words what every field is, and in which unit every number.

use crate::folder::Folder;
use serde_json::Value;

/// Every property below a schema: its path and its schema.
fn properties<'a>(schema: &'a Value, path: &str, found: &mut Vec<(String, &'a Value)>) {
    match schema {
        Value::Object(map) => {
            for (key, inner) in map {
                if key == "properties" {
                    for (name, property) in inner.as_object().expect("properties") {
                        let path = format!("{path}.{name}");
                        found.push((path.clone(), property));
                        properties(property, &path, found);
                    }
                } else if key == "$defs" {
                    for (name, inner) in inner.as_object().expect("definitions") {
                        properties(inner, name, found);
                    }
                } else {
                    properties(inner, path, found);
                }
            }
        }
        Value::Array(list) => list.iter().for_each(|inner| properties(inner, path, found)),
        _ => {}
    }
}

fn schema(arguments: &str) -> Value {
    serde_json::from_str(&Folder::new().run_to(0, arguments).stdout).expect("JSON")
}

const KINDS: [&str; 6] = ["moment-orders", "operator-orders", "basa", "chaussonnet", "heat", "stiff"];

#[test]
fn every_field_is_described_in_draft_2020_12() {
    let scenes = KINDS.map(|kind| format!("schema scene --kind {kind}"));
    for arguments in scenes.iter().map(String::as_str).chain(["schema report"]) {
        let schema = schema(arguments);
        assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema", "{arguments}");
        assert!(jsonschema::draft202012::meta::is_valid(&schema), "{arguments}");
        let mut found = Vec::new();
        properties(&schema, "", &mut found);
        assert!(found.len() >= 10, "{arguments}: {}", found.len());
        let bare = found.iter().filter(|(_, property)| {
            property["description"].as_str().is_none_or(|text| text.trim().is_empty())
        });
        let bare: Vec<&String> = bare.map(|(path, _)| path).collect();
        assert!(bare.is_empty(), "{arguments}: no description: {bare:#?}");
    }
}

/// Words of a description that say what a number is measured in.
const UNITS: [&str; 8] =
    ["pure number", "in metres", "in units", "in pairs", "a count", "as a power", "unit of", "whole number"];

#[test]
fn every_number_of_a_report_says_its_unit() {
    let schema = schema("schema report");
    let mut found = Vec::new();
    properties(&schema, "Report", &mut found);
    let numeric = |property: &Value| {
        let text = property.to_string();
        let types = ["\"number\"", "\"integer\"", "#/$defs/Estimate\"", "#/$defs/Number\""];
        types.iter().any(|name| text.contains(name))
    };
    let numbers: Vec<_> = found.iter().filter(|(_, property)| numeric(property)).collect();
    assert!(numbers.len() > 40, "{}", numbers.len());
    let without: Vec<String> = numbers
        .iter()
        .filter(|(_, property)| {
            let text = property["description"].as_str().unwrap_or_default().to_lowercase();
            !UNITS.iter().any(|unit| text.contains(unit))
        })
        .map(|(path, property)| format!("{path}: {}", property["description"]))
        .collect();
    assert!(without.is_empty(), "{without:#?}");
}
