//! The record as Markdown.

use super::table::{Section, sections, short};
use crate::record::Report;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// `report.md`: the verdicts first, then the cases of each claim, then what was left out.
pub fn markdown(report: &Report) -> String {
    let mut text = String::new();
    let title =
        if report.provenance.title.is_empty() { &report.provenance.scene } else { &report.provenance.title };
    let _ = writeln!(text, "# {title}\n");
    let first_look =
        if report.provenance.quick { " A first look: ladders and samples were shortened." } else { "" };
    let _ = writeln!(
        text,
        "Scene `{}` (SHA-256 {}…), seed {}, remainder {}.{first_look}\n",
        report.provenance.scene,
        &report.provenance.scene_sha256[..12.min(report.provenance.scene_sha256.len())],
        report.provenance.seed,
        report.provenance.version
    );
    let sections = sections(report);
    text.push_str("| claim | printed in | verdict | on what it depends |\n|---|---|---|---|\n");
    for section in &sections {
        let _ = writeln!(
            text,
            "| {} | {} | **{}**{} | {} |",
            cell(&section.statement),
            cell(&section.location),
            section.verdict,
            section
                .expected
                .filter(|e| *e != section.verdict)
                .map(|e| format!(" (expected {e})"))
                .unwrap_or_default(),
            cell(&section.why)
        );
    }
    if sections.iter().any(|section| section.of_exponents) {
        text.push_str(EXPONENTS);
    } else {
        text.push_str("\nIntervals cover 95 %. A statement is judged by where the whole interval lies.\n");
    }
    for section in &sections {
        section_text(&mut text, section);
    }
    for (name, rows) in &report.tables {
        table_text(&mut text, name, rows);
    }
    text.push_str("\n## Left out\n\n");
    for item in &report.left_out {
        let saved = item.saved.as_ref().map(|saved| format!(" (saves {saved})")).unwrap_or_default();
        let _ = writeln!(text, "- {}: {}{saved}", item.what, item.why);
    }
    let cost = report.cost;
    let _ = writeln!(
        text,
        "\nTaken: {} exact sums, {} samples, {} pairs.",
        cost.exact_sums, cost.samples, cost.pairs
    );
    text
}

const EXPONENTS: &str = "\nExponents are over the basis (d̃, h, Δ/h); that of h follows from the scaling of all lengths and is no fit. \
         Intervals cover 95 %. `confirmed`: equal within the margin; `bound`: true as an upper bound, not sharp; \
         `refuted`: the sum outgrows the printed order.\n";

/// The most rows of a further table that are shown; all of them are in the JSON.
const MOST_ROWS: usize = 60;

fn table_text(text: &mut String, name: &str, rows: &[BTreeMap<String, Value>]) {
    let Some(first) = rows.first() else { return };
    let _ = writeln!(text, "\n## Table `{name}`\n");
    let keys: Vec<&String> = first.keys().collect();
    let head = keys.iter().map(|key| key.replace('_', " ")).collect::<Vec<_>>();
    let _ = writeln!(text, "| {} |\n|{}", head.join(" | "), "---|".repeat(keys.len()));
    for row in rows.iter().take(MOST_ROWS) {
        let values = keys.iter().map(|key| match row.get(*key) {
            Some(Value::String(text)) => cell(text),
            Some(Value::Number(number)) => number.as_f64().map_or_else(String::new, short),
            Some(Value::Null) | None => "–".into(),
            Some(value) => cell(&value.to_string()),
        });
        let _ = writeln!(text, "| {} |", values.collect::<Vec<_>>().join(" | "));
    }
    if rows.len() > MOST_ROWS {
        let _ = writeln!(text, "\nAnd {} rows more, in `report.json`.", rows.len() - MOST_ROWS);
    }
}

fn section_text(text: &mut String, section: &Section) {
    let _ = writeln!(text, "\n## `{}`\n\n{}, {}.\n", section.id, cell(&section.statement), section.location);
    if let Some([operator, expansion, conserves]) = &section.operator {
        let _ = writeln!(text, "Expansion of {operator}: `{expansion}`. It conserves: {conserves}.\n");
    }
    if !section.of_exponents {
        text.push_str(
            "| D | case | published | derived | measured | verdict | why |\n|---|---|---|---|---|---|---|\n",
        );
        for row in &section.rows {
            let (measured, why) = (&row.dx_over_h, cell(&row.why));
            let columns = [&row.dimension, &row.case, &row.published, &row.derived, measured];
            let columns = columns.map(|column| cell(column)).join(" | ");
            let _ = writeln!(text, "| {columns} | {} | {why} |", row.verdict);
        }
        return;
    }
    text.push_str("| D | case | published d̃, Δ/h | derived | measured d̃ | measured Δ/h | verdict | why |\n|---|---|---|---|---|---|---|---|\n");
    for row in &section.rows {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            row.dimension,
            row.case,
            row.published,
            row.derived,
            row.displacement,
            row.dx_over_h,
            row.verdict,
            cell(&row.why)
        );
    }
}

/// Text inside a table cell: a bar would end it.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
