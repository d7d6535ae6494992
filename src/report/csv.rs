//! The record as comma-separated values: a file per kind of list, a row per item, numbers in full.
//!
//! | file | a row is |
//! | --- | --- |
//! | `verdicts.csv` | a claim over all its cases |
//! | `claims.csv` | a claim in one case, as the verdict table shows it |
//! | `estimates.csv` | a number of a claim's case: column, quantity, value, interval |
//! | `fits.csv`, `fit_points.csv` | a fit; a rung of its ladder, kept or left out and why |
//! | `series.csv`, `series/ID.csv` | a figure's data: its axes; its points, line by line |
//! | `tables/NAME.csv` | a row of a further table |
//! | `runs.csv`, `viscosity_constants.csv`, `laplacian_factors.csv`, `inferred_domain_size.csv`, `left_out.csv` | as in the record |

use super::numbers::{Held, numbers};
use super::table::sections;
use crate::record::{Axis, Case, ClaimEntry, Fit, LeftOut, Number, Report, Series};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The files by their paths below the report's folder; lists that are empty have none.
///
/// # Errors
/// What the writer refuses, which is nothing that a report holds.
pub fn csv_files(report: &Report) -> Result<BTreeMap<String, String>, csv::Error> {
    let mut files = BTreeMap::new();
    let mut add = |name: String, text: Option<String>| {
        if let Some(text) = text {
            files.insert(name, text);
        }
    };
    add("verdicts.csv".into(), structs(&verdicts(report))?);
    add("claims.csv".into(), claims(report)?);
    add("estimates.csv".into(), estimates(report)?);
    add("fits.csv".into(), fits(&report.fits)?);
    add("fit_points.csv".into(), structs(&points(&report.fits))?);
    let names = file_names(report.series.iter().map(|series| series.id.as_str()));
    add("series.csv".into(), structs(&index(&report.series, &names))?);
    for (series, name) in report.series.iter().zip(&names) {
        add(format!("series/{name}.csv"), lines(series)?);
    }
    add("runs.csv".into(), structs(&report.runs)?);
    add("viscosity_constants.csv".into(), structs(&report.viscosity_constants)?);
    add("laplacian_factors.csv".into(), structs(&report.laplacian_factors)?);
    add("inferred_domain_size.csv".into(), structs(&report.inferred_domain_size)?);
    add("left_out.csv".into(), left_out(report)?);
    let names = file_names(report.tables.keys().map(String::as_str));
    for (rows, name) in report.tables.values().zip(names) {
        add(format!("tables/{name}.csv"), table(rows)?);
    }
    Ok(files)
}

/// Ids as names of files: what is no letter, digit, dot or sign becomes `_`; where two would be the same, the later ones
/// are numbered.
pub fn file_names<'a>(ids: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let safe = |c: char| if c.is_ascii_alphanumeric() || "-+.=".contains(c) { c } else { '_' };
    ids.map(|id| {
        let plain: String = id.chars().map(safe).collect();
        let mut name = plain.clone();
        let mut number = 2;
        // Lower case, for file systems that do not tell it from upper case.
        while !taken.insert(name.to_lowercase()) {
            name = format!("{plain}-{number}");
            number += 1;
        }
        name
    })
    .collect()
}

/// Rows that are structs of plain fields, with a head of the fields' names.
fn structs<T: Serialize>(rows: &[T]) -> Result<Option<String>, csv::Error> {
    if rows.is_empty() {
        return Ok(None);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    text(writer).map(Some)
}

/// Rows of strings below a head.
fn strings(
    head: &[&str],
    rows: impl ExactSizeIterator<Item = Vec<String>>,
) -> Result<Option<String>, csv::Error> {
    if rows.len() == 0 {
        return Ok(None);
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(head)?;
    for row in rows {
        writer.write_record(row)?;
    }
    text(writer).map(Some)
}

fn text(writer: csv::Writer<Vec<u8>>) -> Result<String, csv::Error> {
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[derive(Serialize)]
struct VerdictRow<'a> {
    claim: &'a str,
    source: &'a str,
    location: &'a str,
    statement: &'a str,
    verdict: String,
    expected: Option<String>,
    cases: usize,
    why: &'a str,
}

fn verdicts(report: &Report) -> Vec<VerdictRow<'_>> {
    report
        .verdicts
        .iter()
        .map(|rolled| {
            let entry = report.claims.iter().find(|claim| claim.id == rolled.id);
            let of = |text: fn(&ClaimEntry) -> &str| entry.map(text).unwrap_or_default();
            VerdictRow {
                claim: &rolled.id,
                source: of(|entry| &entry.citation.source),
                location: of(|entry| &entry.citation.location),
                statement: of(|entry| &entry.statement),
                verdict: rolled.verdict.to_string(),
                expected: rolled.expected.map(|verdict| verdict.to_string()),
                cases: rolled.cases,
                why: &rolled.why,
            }
        })
        .collect()
}

/// The fields of a case, then one column for each key that any case has besides.
struct CaseColumns {
    more: Vec<String>,
}

impl CaseColumns {
    fn of<'a>(cases: impl Iterator<Item = &'a Case>) -> Self {
        let more: BTreeSet<String> = cases.flat_map(|case| case.more.keys().cloned()).collect();
        Self { more: more.into_iter().collect() }
    }

    fn head(&self) -> Vec<&str> {
        let fixed = ["case_source", "dimension", "kernel", "lattice", "disorder", "volume_rule"];
        fixed.into_iter().chain(self.more.iter().map(String::as_str)).collect()
    }

    fn values(&self, case: &Case) -> Vec<String> {
        let mut values = vec![
            case.source.clone(),
            case.dimension.to_string(),
            case.kernel.clone(),
            case.lattice.clone().unwrap_or_default(),
            case.disorder.clone().unwrap_or_default(),
            case.volume_rule.clone(),
        ];
        values.extend(self.more.iter().map(|key| case.more.get(key).map(plain).unwrap_or_default()));
        values
    }
}

/// A JSON value as a field: text without quotes, nothing for null.
fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        value => value.to_string(),
    }
}

fn claims(report: &Report) -> Result<Option<String>, csv::Error> {
    let columns = CaseColumns::of(report.claims.iter().map(|claim| &claim.case));
    let mut head = vec!["claim", "location"];
    head.extend(columns.head());
    head.extend(["published", "derived", "measured_displacement", "measured", "margin", "verdict", "why"]);
    let sections = sections(report);
    let mut rows = Vec::with_capacity(report.claims.len());
    for section in &sections {
        let entries = report.claims.iter().filter(|entry| entry.id == section.id);
        for (row, entry) in section.rows.iter().zip(entries) {
            let mut fields = vec![section.id.clone(), section.location.clone()];
            fields.extend(columns.values(&entry.case));
            let shown = [&row.published, &row.derived, &row.displacement, &row.dx_over_h];
            fields.extend(shown.map(String::clone));
            fields.push(entry.margin.map(|margin| margin.to_string()).unwrap_or_default());
            fields.extend([row.verdict.to_string(), row.why.clone()]);
            rows.push(fields);
        }
    }
    strings(&head, rows.into_iter())
}

fn estimates(report: &Report) -> Result<Option<String>, csv::Error> {
    let columns = CaseColumns::of(report.claims.iter().map(|claim| &claim.case));
    let mut head = vec!["claim"];
    head.extend(columns.head());
    head.extend(["column", "quantity", "value", "low", "high", "unit", "by"]);
    let mut rows = Vec::new();
    for entry in &report.claims {
        for number in numbers(entry) {
            let mut fields = vec![entry.id.clone()];
            fields.extend(columns.values(&entry.case));
            fields.extend([number.column.to_owned(), number.quantity.to_owned()]);
            fields.extend(match &number.held {
                Held::Estimate(estimate) => [&estimate.value, &estimate.low, &estimate.high].map(full),
                Held::Word(word) => [word.clone(), String::new(), String::new()],
                Held::Bound(bound) => [bound.to_string(), String::new(), String::new()],
            });
            fields.extend([number.unit.to_owned(), number.held.by().to_owned()]);
            rows.push(fields);
        }
    }
    strings(&head, rows.into_iter())
}

/// A number with all its digits.
fn full(number: &Number) -> String {
    match number {
        Number::Float(value) => value.to_string(),
        Number::Rational(text) => text.clone(),
    }
}

fn fits(fits: &[Fit]) -> Result<Option<String>, csv::Error> {
    let columns = CaseColumns::of(fits.iter().map(|fit| &fit.case));
    let mut head = vec!["fit", "quantity"];
    head.extend(columns.head());
    head.extend(["varies", "held", "x", "x_unit", "y", "y_unit"]);
    head.extend(["slope", "slope_low", "slope_high", "intercept", "intercept_low", "intercept_high"]);
    head.extend(["residual_sd", "degrees_of_freedom", "coverage", "interval", "points_kept", "points"]);
    let rows = fits.iter().map(|fit| {
        let mut fields = vec![fit.id.clone(), fit.quantity.clone()];
        fields.extend(columns.values(&fit.case));
        let held = fit.held.iter().map(|(key, value)| format!("{key} = {value}")).collect::<Vec<_>>();
        fields.extend([fit.varies.clone(), held.join("; ")]);
        fields.extend([&fit.x.name, &fit.x.unit, &fit.y.name, &fit.y.unit].map(String::clone));
        for estimate in [&fit.slope, &fit.intercept] {
            fields.extend([&estimate.value, &estimate.low, &estimate.high].map(full));
        }
        fields.extend([fit.residual_sd.to_string(), fit.degrees_of_freedom.to_string()]);
        fields.extend([fit.coverage.to_string(), fit.interval.clone()]);
        let kept = fit.points.iter().filter(|point| point.kept).count();
        fields.extend([kept.to_string(), fit.points.len().to_string()]);
        fields
    });
    strings(&head, rows)
}

/// A rung with the fit that it belongs to: the record's fields, flat.
#[derive(Serialize)]
struct PointRow<'a> {
    fit: &'a str,
    x: f64,
    y: f64,
    y_error: Option<f64>,
    mean: Option<f64>,
    max: Option<f64>,
    samples: Option<u64>,
    support_over_dx: Option<f64>,
    kept: bool,
    why: Option<&'a str>,
    residual: Option<f64>,
}

fn points(fits: &[Fit]) -> Vec<PointRow<'_>> {
    let mut rows = Vec::new();
    for fit in fits {
        rows.extend(fit.points.iter().map(|point| PointRow {
            fit: &fit.id,
            x: point.x,
            y: point.y,
            y_error: point.y_error,
            mean: point.mean,
            max: point.max,
            samples: point.samples,
            support_over_dx: point.support_over_dx,
            kept: point.kept,
            why: point.why.as_deref(),
            residual: point.residual,
        }));
    }
    rows
}

#[derive(Serialize)]
struct SeriesRow<'a> {
    series: &'a str,
    figure: Option<&'a str>,
    x: &'a str,
    x_unit: &'a str,
    x_log: bool,
    y: &'a str,
    y_unit: &'a str,
    y_log: bool,
    lines: usize,
    file: String,
}

fn index<'a>(series: &'a [Series], names: &[String]) -> Vec<SeriesRow<'a>> {
    let row = |(series, name): (&'a Series, &String)| {
        let (Axis { name: x, unit: x_unit, log: x_log }, y) = (&series.x, &series.y);
        SeriesRow {
            series: &series.id,
            figure: series.figure.as_deref(),
            x,
            x_unit,
            x_log: *x_log,
            y: &y.name,
            y_unit: &y.unit,
            y_log: y.log,
            lines: series.lines.len(),
            file: format!("series/{name}.csv"),
        }
    };
    series.iter().zip(names).map(row).collect()
}

fn lines(series: &Series) -> Result<Option<String>, csv::Error> {
    let points = series.lines.iter().flat_map(|line| line.points.iter().map(move |point| (line, point)));
    let rows: Vec<Vec<String>> = points
        .map(|(line, point)| {
            let at = |index: usize| point.get(index).map(f64::to_string).unwrap_or_default();
            vec![line.name.clone(), at(0), at(1), at(2)]
        })
        .collect();
    strings(&["line", "x", "y", "y_error"], rows.into_iter())
}

/// Not as structs: `saved` is missing where there is nothing to say.
fn left_out(report: &Report) -> Result<Option<String>, csv::Error> {
    let fields =
        |item: &LeftOut| vec![item.what.clone(), item.why.clone(), item.saved.clone().unwrap_or_default()];
    strings(&["what", "why", "saved"], report.left_out.iter().map(fields))
}

fn table(rows: &[BTreeMap<String, Value>]) -> Result<Option<String>, csv::Error> {
    let keys: BTreeSet<&str> = rows.iter().flat_map(|row| row.keys().map(String::as_str)).collect();
    let head: Vec<&str> = keys.into_iter().collect();
    let value = |row: &BTreeMap<String, Value>, key: &str| row.get(key).map(plain).unwrap_or_default();
    strings(&head, rows.iter().map(|row| head.iter().map(|key| value(row, key)).collect()))
}
