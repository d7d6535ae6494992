//! The difference of two reports in words.

use super::{Difference, Place, ValueChange};
use crate::report::table::short;
use serde_json::Value;
use std::fmt::Write as _;

/// For the terminal: verdicts first, then numbers, then what came and went.
pub fn difference_text(difference: &Difference) -> String {
    let mut text = String::new();
    let mut line = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    for (field, [before, after]) in &difference.provenance {
        line(format!("{field}: {} → {}", word(before), word(after)));
    }
    if !difference.verdicts.is_empty() {
        line("\nVerdicts".into());
        for change in &difference.verdicts {
            line(format!("  {}: {} → {}", place(&change.place), change.before, change.after));
            line(format!("    {}", change.why));
        }
    }
    if !difference.values.is_empty() {
        line("\nNumbers".into());
        let mut last: Option<&Place> = None;
        for change in &difference.values {
            if last != Some(&change.place) {
                line(format!("  {}", place(&change.place)));
                last = Some(&change.place);
            }
            line(format!("    {}", value(change)));
        }
    }
    if !difference.lists.is_empty() {
        line("\nLists".into());
        for change in &difference.lists {
            let rows = change.rows_before.max(change.rows_after);
            line(format!("  {}: {} of {rows} rows differ", place(&change.place), change.rows_changed));
        }
    }
    for (title, places) in [("Added", &difference.added), ("Removed", &difference.removed)] {
        if !places.is_empty() {
            line(format!("\n{title}"));
            places.iter().for_each(|found| line(format!("  {}", place(found))));
        }
    }
    line(summary(difference));
    text
}

fn summary(difference: &Difference) -> String {
    if difference.is_nothing() {
        return "No verdict, exponent, constant, fit, series, table or run differs.".into();
    }
    let Difference { verdicts, values, added, removed, lists, .. } = difference;
    let largest = values.iter().filter_map(|change| change.standard_errors).max_by(f64::total_cmp);
    let largest = largest.map(|most| format!(" (by up to {} standard errors)", short(most)));
    format!(
        "\nChanged: {} verdicts, {} numbers{}, {} lists. Added: {}. Removed: {}.",
        verdicts.len(),
        values.len(),
        largest.unwrap_or_default(),
        lists.len(),
        added.len(),
        removed.len()
    )
}

fn place(place: &Place) -> String {
    match place.list {
        "verdicts" => place.item.clone(),
        list => format!("{}: {}", list.replace('_', " "), place.item),
    }
}

fn value(change: &ValueChange) -> String {
    let by = match (change.difference, change.standard_errors) {
        (_, Some(0.0)) => "  the interval alone".to_owned(),
        (_, Some(errors)) => format!("  {} standard errors", short(errors)),
        (Some(difference), None) => format!("  by {}", short(difference)),
        (None, None) => String::new(),
    };
    format!("{}: {} → {}{by}", change.quantity, word(&change.before), word(&change.after))
}

/// A value of the record in words; numbers in the digits that tell them apart are in the JSON.
fn word(value: &Value) -> String {
    match value {
        Value::Null => "–".into(),
        Value::String(text) => text.clone(),
        // All digits, in which it may differ; but 7, not 7.0.
        Value::Number(number) => number.to_string().trim_end_matches(".0").to_owned(),
        Value::Object(map) => {
            let number = |key: &str| match map.get(key) {
                Some(Value::Number(number)) => number.as_f64().map_or_else(String::new, short),
                Some(Value::String(text)) => text.clone(),
                _ => String::new(),
            };
            format!("{} [{}, {}]", number("value"), number("low"), number("high"))
        }
        other => other.to_string(),
    }
}
