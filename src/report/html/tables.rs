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

/// Columns in the order of their types.
const DOMAIN: &[&str] = &["fit", "value_m", "low", "high"];
const LAPLACIAN: &[&str] = &[
    "operator",
    "dimension",
    "lattice",
    "h_over_dx",
    "volume_rule",
    "continuum",
    "lattice_value",
    "published",
];
const VISCOSITY: &[&str] = &[
    "model",
    "dimension",
    "kernel",
    "lattice",
    "dx_over_h",
    "volume_rule",
    "regularised",
    "direction",
    "derived",
    "published",
];
const RUNS: &[&str] =
    &["scheme", "n", "h_over_dx", "epsilon", "integrator", "boundary", "l2", "linf", "ec", "steps"];

/// All tables, those of their own type first.
pub(super) fn tables(page: &mut String, report: &Report) {
    let mut all: Vec<(String, Vec<Value>, &[&str])> = vec![
        ("inferred domain size".into(), plain(&report.inferred_domain_size), DOMAIN),
        ("laplacian factors".into(), plain(&report.laplacian_factors), LAPLACIAN),
        ("viscosity constants".into(), plain(&report.viscosity_constants), VISCOSITY),
        ("runs".into(), plain(&report.runs), RUNS),
    ];
    all.extend(
        report.tables.iter().map(|(name, rows)| (name.replace('_', " "), plain(rows), &[] as &[&str])),
    );
    all.retain(|(_, rows, _)| !rows.is_empty());
    if all.is_empty() {
        return;
    }
    page.push_str("<section aria-labelledby=\"tables\"><h2 id=\"tables\">Tables</h2>");
    for (name, rows, order) in &all {
        table(page, name, rows, order);
    }
    page.push_str("</section>");
}

fn plain<T: Serialize>(rows: &[T]) -> Vec<Value> {
    rows.iter().filter_map(|row| serde_json::to_value(row).ok()).collect()
}

/// The columns: as their type has them, else those of words first, as they say what the row is about.
fn columns<'a>(rows: &'a [Value], order: &[&'a str]) -> Vec<&'a str> {
    let Some(first) = rows.first().and_then(Value::as_object) else { return Vec::new() };
    if !order.is_empty() {
        return order.to_vec();
    }
    let mut keys: Vec<&str> = first.keys().map(String::as_str).collect();
    keys.sort_by_key(|key| !is_text(rows, key));
    keys
}

fn is_text(rows: &[Value], key: &str) -> bool {
    rows.iter().any(|row| row.get(key).is_some_and(Value::is_string))
}

fn table(page: &mut String, name: &str, rows: &[Value], order: &[&str]) {
    let keys = columns(rows, order);
    let name = escaped(name);
    let open = if rows.len() <= OPEN_ROWS { " open=\"open\"" } else { "" };
    let _ = write!(
        page,
        "<details class=\"table\"{open}><summary><h3>{name}</h3> <small>{} rows</small></summary>\
         <div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"Table {name}\"><table><thead><tr>",
        rows.len()
    );
    let classes: Vec<&str> =
        keys.iter().map(|key| if is_text(rows, key) { " class=\"w\"" } else { "" }).collect();
    for (name, class) in keys.iter().zip(&classes) {
        let _ = write!(page, "<th scope=\"col\"{class}>{}</th>", key(name));
    }
    page.push_str("</tr></thead><tbody>");
    for row in rows.iter().take(MOST_ROWS) {
        page.push_str("<tr>");
        for (key, class) in keys.iter().zip(&classes) {
            let _ = write!(page, "<td{class}>{}</td>", value(row.get(*key)));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody></table></div>");
    if rows.len() > MOST_ROWS {
        let _ = write!(page, "<p>And {} rows more, in <code>report.json</code>.</p>", rows.len() - MOST_ROWS);
    }
    page.push_str("</details>\n");
}
