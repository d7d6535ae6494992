//! `reference`: the chapters of the book that follow from the code: catalogues, the keys of scenes, the fields of reports.

use super::arguments::ReferenceArguments;
use super::catalogue::catalogues;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::files::write_file;
use crate::claim::known;
use crate::report::Report;
use crate::study::{RawScene, survey_kinds};
use serde_json::Value;
use std::fmt::Write as _;

const MADE: &str = "<!-- Made by `remainder reference docs/reference`; a test compares. -->\n\n";

pub(super) fn reference(arguments: &ReferenceArguments) -> Result<Exit, Failure> {
    let mut pages = vec![("names.md".to_owned(), names()), ("claims.md".to_owned(), claims())];
    pages.push((
        "report.md".to_owned(),
        fields("The fields of `report.json`", schemars::schema_for!(Report).as_value()),
    ));
    let orders = schemars::schema_for!(RawScene);
    let mut scenes = fields("The keys of scenes of orders", orders.as_value());
    for (kind, schema) in survey_kinds() {
        scenes += "\n";
        scenes +=
            &fields(&format!("The keys of scenes of kind `{kind}`"), schema.as_value()).replace(MADE, "");
    }
    pages.push(("scene.md".to_owned(), scenes));
    for (name, text) in pages {
        write_file(&arguments.out.join(name), &text)?;
    }
    print_out(&format!("Written to {}.\n", arguments.out.display()));
    Ok(Exit::AsExpected)
}

/// Kernels, lattices, disorders, volume rules, moments, operators.
fn names() -> String {
    let mut text = format!("{MADE}# Names\n\nAs `remainder list` prints them.\n");
    for (_, name, entries) in catalogues().into_iter().filter(|(_, name, _)| *name != "claims") {
        let _ = writeln!(text, "\n## {}\n\n| id | what | source |\n|---|---|---|", name.replace('_', " "));
        for (id, what, source) in entries {
            let _ = writeln!(text, "| `{}` | {} | {} |", cell(&id), cell(&what), cell(&source));
        }
    }
    text
}

/// Every built-in claim with its formula; `remainder explain` tells more.
fn claims() -> String {
    let mut text = format!(
        "{MADE}# Claims\n\nWhat the papers state and analyses check; `remainder explain CLAIM` adds what was found.\n\n\
         | id | statement | checked | printed in |\n|---|---|---|---|\n"
    );
    for claim in known() {
        let cells = [&claim.text, &claim.formula].map(|text| cell(text));
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {}, {} |",
            cell(&claim.id),
            cells[0],
            cells[1],
            claim.source,
            cell(&claim.location)
        );
    }
    text
}

/// Every property of a schema, object by object.
fn fields(title: &str, schema: &Value) -> String {
    let mut text = format!("{MADE}# {title}\n");
    object(&mut text, schema.get("title").and_then(Value::as_str).unwrap_or("top"), schema);
    for (name, definition) in schema.get("$defs").and_then(Value::as_object).into_iter().flatten() {
        object(&mut text, name, definition);
    }
    text
}

fn object(text: &mut String, name: &str, schema: &Value) {
    let described = schema.get("description").and_then(Value::as_str).unwrap_or_default();
    let properties = schema.get("properties").and_then(Value::as_object);
    let choices = schema.get("oneOf").or(schema.get("anyOf")).and_then(Value::as_array);
    if properties.is_none() && choices.is_none() {
        return;
    }
    let _ = writeln!(text, "\n## {name}\n\n{}", prose(described));
    for choice in choices.into_iter().flatten() {
        let value = choice.get("const").map(Value::to_string).unwrap_or_else(|| kind(choice));
        let described = choice.get("description").and_then(Value::as_str).unwrap_or_default();
        let _ = writeln!(text, "- `{value}` {}", prose(described));
    }
    let Some(properties) = properties else { return };
    let required = schema.get("required").and_then(Value::as_array);
    text.push_str("\n| field | type | what |\n|---|---|---|\n");
    for (field, property) in properties {
        let needed = required.is_some_and(|required| required.iter().any(|name| name == field));
        let described = property.get("description").and_then(Value::as_str).unwrap_or_default();
        let optional = if needed { "" } else { ", optional" };
        let _ = writeln!(text, "| `{field}` | {}{optional} | {} |", kind(property), cell(&prose(described)));
    }
}

/// The type of a property in a word or two.
fn kind(property: &Value) -> String {
    if let Some(reference) = property.get("$ref").and_then(Value::as_str) {
        return reference.rsplit('/').next().unwrap_or_default().to_owned();
    }
    for key in ["anyOf", "oneOf", "allOf"] {
        if let Some(choices) = property.get(key).and_then(Value::as_array) {
            let words: Vec<String> = choices.iter().map(kind).filter(|word| word != "null").collect();
            return words.join(" or ");
        }
    }
    let word = |name: &str| match name {
        "array" => match property.get("items") {
            Some(items) => format!("list of {}", kind(items)),
            None => "list".to_owned(),
        },
        "object" => match property.get("additionalProperties").filter(|inner| inner.is_object()) {
            Some(inner) => format!("map to {}", kind(inner)),
            None => "object".to_owned(),
        },
        name => name.to_owned(),
    };
    match property.get("type") {
        Some(Value::String(name)) => word(name),
        Some(Value::Array(names)) => {
            let names = names.iter().filter_map(Value::as_str).filter(|name| *name != "null");
            names.map(word).collect::<Vec<_>>().join(" or ")
        }
        _ => "any".into(),
    }
}

/// One paragraph, without links into the code.
fn prose(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Text inside a table: a bar would end the cell, and `<` would begin a tag.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}
