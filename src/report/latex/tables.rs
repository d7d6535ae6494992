//! Which tables a report makes: the verdicts, published, derived and measured side by side, and all others.

use super::table::{Cell, Row, Table, Width};
use super::text::{plain, tex};
use crate::record::{ClaimEntry, Estimate, Fit, Number, Report};
use crate::report::csv::file_names;
use crate::report::numbers::{Held, Named, numbers};
use crate::report::table::{Section, sections, short};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The most rows of a further table; all of them are in the JSON and in CSV.
const MOST_ROWS: usize = 40;

/// The most fits; likewise.
const MOST_FITS: usize = 120;

/// The tables by the names of their files, without extension.
pub(super) fn tables(report: &Report) -> Vec<(String, String)> {
    let sections = sections(report);
    let mut found = vec![
        ("summary".to_owned(), summary(report, &sections).long()),
        ("verdicts".to_owned(), verdicts(report, &sections).long()),
    ];
    let mut add = |name: &str, text: Option<String>| {
        if let Some(text) = text {
            found.push((name.to_owned(), text));
        }
    };
    add("fits", (!report.fits.is_empty()).then(|| fits(report).long() + &more(report.fits.len(), MOST_FITS)));
    add("viscosity-constants", structs(&report.viscosity_constants));
    add("laplacian-factors", structs(&report.laplacian_factors));
    add("inferred-domain-size", structs(&report.inferred_domain_size));
    add("runs", structs(&report.runs));
    let names = file_names(report.tables.keys().map(String::as_str));
    for (rows, name) in report.tables.values().zip(names) {
        add(&format!("table-{name}"), plain_rows(rows));
    }
    found
}

fn natural(head: &str) -> (String, Width) {
    (head.to_owned(), Width::Natural)
}

/// One row a claim.
fn summary(report: &Report, sections: &[Section]) -> Table {
    let rows = sections.iter().map(|section| {
        let cases = report.claims.iter().filter(|entry| entry.id == section.id).count();
        Row::Cells(vec![
            Cell::Text(tex(&section.statement)),
            Cell::Text(tex(&section.location)),
            Cell::Text(section.verdict.to_string()),
            Cell::Number(cases.to_string()),
        ])
    });
    let heads = vec![
        ("claim".to_owned(), Width::Share(54)),
        ("printed in".to_owned(), Width::Share(18)),
        natural("verdict"),
        natural("cases"),
    ];
    Table { heads, rows: rows.collect() }
}

/// One row a claim, case and quantity: published, derived and measured side by side.
fn verdicts(report: &Report, sections: &[Section]) -> Table {
    let heads = vec![
        natural("$D$"),
        ("case".to_owned(), Width::Share(24)),
        ("quantity".to_owned(), Width::Share(16)),
        natural("published"),
        natural("derived"),
        natural("measured"),
        natural("95\\,\\%"),
        natural("verdict"),
    ];
    let mut rows = Vec::new();
    for section in sections {
        rows.push(Row::Heading(format!(
            "\\textbf{{{}}}: {} ({})",
            section.verdict,
            tex(&section.statement),
            tex(&section.location)
        )));
        let entries = report.claims.iter().filter(|entry| entry.id == section.id);
        for (row, entry) in section.rows.iter().zip(entries) {
            let case = [Cell::Text(entry.case.dimension.to_string()), Cell::Text(tex(&row.case))];
            let found = of_entry(entry);
            for (at, [quantity, published, derived, measured, interval]) in found.into_iter().enumerate() {
                let mut cells = match at {
                    0 => case.to_vec(),
                    _ => vec![Cell::Text(String::new()), Cell::Text(String::new())],
                };
                cells.extend([quantity, published, derived, measured, interval]);
                let verdict = if at == 0 { entry.verdict.to_string() } else { String::new() };
                cells.push(Cell::Text(verdict));
                rows.push(Row::Cells(cells));
            }
        }
    }
    Table { heads, rows }
}

/// One row a fit: quantity ∝ x^exponent, the residual standard deviation of its logarithm, points kept of all.
fn fits(report: &Report) -> Table {
    let heads = vec![
        natural("$D$"),
        ("quantity".to_owned(), Width::Share(18)),
        ("case".to_owned(), Width::Share(28)),
        natural("against"),
        natural("exponent"),
        natural("95\\,\\%"),
        natural("$s$"),
        natural("points"),
    ];
    let row = |fit: &Fit| {
        let case = &fit.case;
        let named = [Some(&case.kernel), case.lattice.as_ref(), case.disorder.as_ref()];
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let more = case.more.values().map(text);
        let words = named.into_iter().flatten().cloned().chain([case.volume_rule.clone()]).chain(more);
        let kept = fit.points.iter().filter(|point| point.kept).count();
        Row::Cells(vec![
            Cell::Text(case.dimension.to_string()),
            Cell::Text(tex(&fit.quantity)),
            Cell::Text(tex(&words.collect::<Vec<_>>().join(", "))),
            Cell::Text(tex(&fit.x.name)),
            number(&fit.slope.value),
            interval(&fit.slope),
            float(fit.residual_sd),
            Cell::Text(format!("{kept} of {}", fit.points.len())),
        ])
    };
    Table { heads, rows: report.fits.iter().take(MOST_FITS).map(row).collect() }
}

/// Quantity, published, derived, measured, its interval.
fn of_entry(entry: &ClaimEntry) -> Vec<[Cell; 5]> {
    let all = numbers(entry);
    let mut quantities: Vec<&str> = Vec::new();
    for named in &all {
        if !quantities.contains(&named.quantity) {
            quantities.push(named.quantity);
        }
    }
    let nothing = || Cell::Text("--".into());
    let of = |column: &str, quantity: &str| -> Option<&Named<'_>> {
        all.iter().find(|named| named.column == column && named.quantity == quantity)
    };
    let mut rows: Vec<[Cell; 5]> = quantities
        .iter()
        .map(|quantity| {
            let cell = |column| of(column, quantity).map_or_else(nothing, |named| held(&named.held));
            let measured = of("measured", quantity).map(|named| &named.held);
            let interval = match measured {
                Some(Held::Estimate(estimate)) if estimate.low != estimate.high => interval(estimate),
                _ => Cell::Text(String::new()),
            };
            [Cell::Text(tex(quantity)), cell("published"), cell("derived"), cell("measured"), interval]
        })
        .collect();
    if rows.is_empty() {
        rows.push([nothing(), nothing(), nothing(), nothing(), Cell::Text(String::new())]);
    }
    rows
}

fn held(held: &Held<'_>) -> Cell {
    match held {
        Held::Estimate(estimate) => number(&estimate.value),
        Held::Bound(bound) => float(*bound),
        Held::Word(word) => Cell::Text(tex(word)),
    }
}

/// Rationals as fractions in text; floating point in four digits.
fn number(number: &Number) -> Cell {
    match number {
        Number::Rational(text) if text.contains('/') => Cell::Text(format!("${text}$")),
        Number::Rational(text) => Cell::Number(text.clone()),
        Number::Float(value) => float(*value),
    }
}

fn float(value: f64) -> Cell {
    if value.is_finite() { Cell::Number(short(value)) } else { Cell::Text("--".into()) }
}

fn interval(estimate: &Estimate) -> Cell {
    let end = |value: &Number| match number(value) {
        Cell::Number(number) => format!("\\num{{{number}}}"),
        Cell::Text(text) => text,
    };
    Cell::Text(format!("{{[}}{}, {}{{]}}", end(&estimate.low), end(&estimate.high)))
}

fn structs(rows: &[impl Serialize]) -> Option<String> {
    let row = |row| match serde_json::to_value(row) {
        Ok(Value::Object(map)) => map.into_iter().collect(),
        _ => unreachable!("a row is a struct of plain fields"),
    };
    plain_rows(&rows.iter().map(row).collect::<Vec<BTreeMap<String, Value>>>())
}

fn plain_rows(rows: &[BTreeMap<String, Value>]) -> Option<String> {
    let keys: BTreeSet<&str> = rows.iter().flat_map(|row| row.keys().map(String::as_str)).collect();
    if keys.is_empty() {
        return None;
    }
    let cell = |value: Option<&Value>| match value {
        Some(Value::String(text)) => Cell::Text(tex(text)),
        Some(Value::Number(number)) => number.as_f64().map_or(Cell::Text("--".into()), float),
        Some(Value::Bool(true)) => Cell::Text("yes".into()),
        Some(Value::Bool(false)) => Cell::Text("no".into()),
        Some(Value::Null) | None => Cell::Text("--".into()),
        Some(other) => Cell::Text(plain(&other.to_string())),
    };
    let body = rows.iter().take(MOST_ROWS);
    let body = body.map(|row| Row::Cells(keys.iter().map(|key| cell(row.get(*key))).collect()));
    let heads = keys.iter().map(|key| natural(&plain(&key.replace('_', " ")))).collect();
    Some(Table { heads, rows: body.collect() }.short() + &more(rows.len(), MOST_ROWS))
}

/// Says what a table leaves out.
fn more(rows: usize, most: usize) -> String {
    match rows.saturating_sub(most) {
        0 => String::new(),
        left => format!("\n% {left} rows more are in report.json and in CSV.\n"),
    }
}
