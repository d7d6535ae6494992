//! The tables of a report, whatever their rows hold.

use super::text::{key, value};
use crate::record::Report;
use crate::report::rich::escaped;
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write as _;

/// The most rows that a page shows; all of them are in the JSON.
const MOST_ROWS: usize = 240;

/// Longer tables are closed at first.
const OPEN_ROWS: usize = 16;

/// All tables, those of their own type first.
pub(super) fn tables(page: &mut String, report: &Report) {
    let mut all: Vec<(String, Vec<Value>)> = vec![
        ("inferred domain size".into(), plain(&report.inferred_domain_size)),
        ("laplacian factors".into(), plain(&report.laplacian_factors)),
        ("viscosity constants".into(), plain(&report.viscosity_constants)),
        ("runs".into(), plain(&report.runs)),
    ];
    all.extend(report.tables.iter().map(|(name, rows)| (name.replace('_', " "), plain(rows))));
    all.retain(|(_, rows)| !rows.is_empty());
    if all.is_empty() {
        return;
    }
    page.push_str("<section aria-labelledby=\"tables\"><h2 id=\"tables\">Tables</h2>");
    for (name, rows) in &all {
        table(page, name, rows);
    }
    page.push_str("</section>");
}

fn plain<T: Serialize>(rows: &[T]) -> Vec<Value> {
    rows.iter().filter_map(|row| serde_json::to_value(row).ok()).collect()
}

fn table(page: &mut String, name: &str, rows: &[Value]) {
    let Some(keys) = rows.first().and_then(Value::as_object).map(|first| first.keys().collect::<Vec<_>>())
    else {
        return;
    };
    let name = escaped(name);
    let open = if rows.len() <= OPEN_ROWS { " open=\"open\"" } else { "" };
    let _ = write!(
        page,
        "<details class=\"table\"{open}><summary><h3>{name}</h3> <small>{} rows</small></summary>\
         <div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table {name}\"><table><thead><tr>",
        rows.len()
    );
    for name in &keys {
        let _ = write!(page, "<th scope=\"col\">{}</th>", key(name));
    }
    page.push_str("</tr></thead><tbody>");
    for row in rows.iter().take(MOST_ROWS) {
        page.push_str("<tr>");
        for key in &keys {
            let held = row.get(key.as_str());
            let class = if held.is_some_and(Value::is_string) { " class=\"w\"" } else { "" };
            let _ = write!(page, "<td{class}>{}</td>", value(held));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody></table></div>");
    if rows.len() > MOST_ROWS {
        let _ = write!(page, "<p>And {} rows more, in <code>report.json</code>.</p>", rows.len() - MOST_ROWS);
    }
    page.push_str("</details>\n");
}
