//! A report as named items, so that two can be laid side by side.

use super::Place;
use crate::exact::{Rational, parse_rational, rational_to_f64};
use crate::measured::fit::student_t;
use crate::record::{Case, ClaimEntry, Estimate, Fit, Number, Report, Verdict};
use crate::report::numbers::{Held, numbers};
use serde::Serialize;
use serde_json::{Value, json};
use statrs::distribution::{ContinuousCDF, Normal};
use std::collections::BTreeMap;

/// Coverage of the intervals of the record where no fit says another.
const COVERAGE: f64 = 0.95;

/// By their places.
pub(super) type Items = BTreeMap<Place, Item>;

/// What stands in one place.
#[derive(Debug, Default)]
pub(super) struct Item {
    pub(super) verdict: Option<Verdict>,
    pub(super) why: String,
    /// By name, in a fixed order.
    pub(super) values: Vec<(String, Quantity)>,
    /// Of a list without names, its rows.
    pub(super) rows: Option<Vec<Value>>,
}

impl Item {
    pub(super) fn value(&self, name: &str) -> Option<&Quantity> {
        self.values.iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

/// A number with what is known of its error, or a word.
#[derive(Debug, Clone)]
pub(super) enum Quantity {
    Number { estimate: Estimate, standard_error: f64 },
    Word(String),
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number { estimate: a, .. }, Self::Number { estimate: b, .. }) => {
                [(&a.value, &b.value), (&a.low, &b.low), (&a.high, &b.high)].iter().all(|(a, b)| same(a, b))
            }
            (Self::Word(a), Self::Word(b)) => a == b,
            _ => false,
        }
    }
}

impl Quantity {
    /// A number without an interval.
    fn exactly(value: f64) -> Self {
        let value = Number::Float(value);
        let estimate = Estimate { value: value.clone(), low: value.clone(), high: value, by: None };
        Self::Number { estimate, standard_error: 0.0 }
    }

    /// The number, its interval and the quantile that its half-width is a multiple of the standard error by.
    fn with_interval(estimate: &Estimate, quantile: f64) -> Self {
        Self::Number { estimate: estimate.clone(), standard_error: half_width(estimate) / quantile }
    }

    /// The difference of two numbers, and its standard error unless both are exact.
    pub(super) fn gap(&self, after: &Self) -> Option<(f64, Option<f64>)> {
        let (
            Self::Number { estimate: a, standard_error: of_a },
            Self::Number { estimate: b, standard_error: of_b },
        ) = (self, after)
        else {
            return None;
        };
        let error = of_a.hypot(*of_b);
        Some((float(&b.value) - float(&a.value), (error > 0.0).then_some(error)))
    }

    pub(super) fn to_json(&self) -> Value {
        match self {
            Self::Word(word) => json!(word),
            Self::Number { estimate, .. } if same(&estimate.low, &estimate.high) => json!(estimate.value),
            Self::Number { estimate, standard_error } => json!({
                "value": estimate.value,
                "low": estimate.low,
                "high": estimate.high,
                "standard_error": standard_error,
            }),
        }
    }
}

fn float(number: &Number) -> f64 {
    match number {
        Number::Float(value) => *value,
        Number::Rational(text) => parse_rational(text).map_or(f64::NAN, |value| rational_to_f64(&value)),
    }
}

/// Whether two numbers are one: rationals by value, however they are written.
fn same(a: &Number, b: &Number) -> bool {
    let exact = |number: &Number| -> Option<Rational> {
        let Number::Rational(text) = number else { return None };
        parse_rational(text).ok()
    };
    match (a, b) {
        (Number::Rational(a_text), Number::Rational(b_text)) => {
            a_text == b_text || exact(a).zip(exact(b)).is_some_and(|(a, b)| a == b)
        }
        _ => float(a) == float(b),
    }
}

fn half_width(estimate: &Estimate) -> f64 {
    (float(&estimate.high) - float(&estimate.low)) / 2.0
}

/// The quantile that an interval of this coverage is a multiple of the standard error by.
fn quantile(coverage: f64, degrees_of_freedom: Option<usize>) -> f64 {
    let t = degrees_of_freedom.and_then(|freedom| student_t(coverage, freedom).ok());
    t.unwrap_or_else(|| -Normal::standard().inverse_cdf(0.5 * (1.0 - coverage)))
}

/// All that is compared.
pub(super) fn items(report: &Report) -> Items {
    let fits: BTreeMap<&str, &Fit> = report.fits.iter().map(|fit| (fit.id.as_str(), fit)).collect();
    let mut found = Items::new();
    let mut add = |list, item: String, mut value: Item| {
        let place = |item| Place { list, item };
        let mut key = place(item.clone());
        let mut number = 2;
        // Two of one name stay two: the second is told by its number.
        while found.contains_key(&key) {
            key = place(format!("{item} ({number})"));
            number += 1;
        }
        value.values.retain(|(_, value)| !matches!(value, Quantity::Word(word) if word.is_empty()));
        found.insert(key, value);
    };
    for rolled in &report.verdicts {
        let expected = rolled.expected.map(|verdict| verdict.to_string()).unwrap_or_default();
        let values = vec![
            ("expected".to_owned(), Quantity::Word(expected)),
            ("cases".to_owned(), Quantity::exactly(rolled.cases as f64)),
        ];
        let item = Item { verdict: Some(rolled.verdict), why: rolled.why.clone(), values, rows: None };
        add("verdicts", rolled.id.clone(), item);
    }
    for entry in &report.claims {
        add("claims", format!("{}, {}", entry.id, case_label(&entry.case)), claim(entry, &fits));
    }
    for fit in &report.fits {
        add("fits", fit.id.clone(), of_fit(fit));
    }
    let exact = |name: &str, value: f64| (name.to_owned(), Quantity::exactly(value));
    for row in &report.viscosity_constants {
        let values = vec![exact("derived", row.derived), exact("published", row.published)];
        add("viscosity_constants", label(row, &["derived", "published"]), Item { values, ..Item::default() });
    }
    for row in &report.laplacian_factors {
        let numbers = [
            exact("continuum", row.continuum),
            exact("lattice_value", row.lattice_value),
            exact("published", row.published),
        ];
        let item = label(row, &["continuum", "lattice_value", "published"]);
        add("laplacian_factors", item, Item { values: numbers.into(), ..Item::default() });
    }
    for row in &report.inferred_domain_size {
        let [value, low, high] = [row.value_m, row.low, row.high].map(Number::Float);
        let estimate = Estimate { value, low, high, by: None };
        let size = Quantity::with_interval(&estimate, quantile(COVERAGE, None));
        let values = vec![("value_m".to_owned(), size)];
        add("inferred_domain_size", row.fit.clone(), Item { values, ..Item::default() });
    }
    let rows = |rows: Vec<Value>| Item { rows: Some(rows), ..Item::default() };
    for series in &report.series {
        let lines = series.lines.iter().map(|line| json!(line)).chain([json!([series.x, series.y])]);
        add("series", series.id.clone(), rows(lines.collect()));
    }
    for (name, table) in &report.tables {
        add("tables", name.clone(), rows(table.iter().map(|row| json!(row)).collect()));
    }
    if !report.runs.is_empty() {
        add("runs", "all".into(), rows(report.runs.iter().map(|run| json!(run)).collect()));
    }
    found
}

/// Of a case's further fields, those that say what was found rather than for what.
const FOUND: [&str; 2] = ["expansion", "conserves"];

fn claim(entry: &ClaimEntry, fits: &BTreeMap<&str, &Fit>) -> Item {
    let mut values = Vec::new();
    for named in numbers(entry) {
        let quantity = match &named.held {
            Held::Estimate(estimate) => Quantity::with_interval(estimate, quantile_of(estimate, entry, fits)),
            Held::Bound(bound) => Quantity::exactly(*bound),
            Held::Word(word) => Quantity::Word(word.clone()),
        };
        values.push((format!("{}: {}", named.column, named.quantity), quantity));
    }
    if let Some(margin) = entry.margin {
        values.push(("margin".into(), Quantity::exactly(margin)));
    }
    for key in FOUND {
        let text = entry.case.more.get(key).and_then(Value::as_str).unwrap_or_default();
        values.push((key.into(), Quantity::Word(text.into())));
    }
    Item { verdict: Some(entry.verdict), why: entry.why.clone(), values, rows: None }
}

/// The quantile behind an estimate: that of the fit whose slope has an interval of the same width, if one is named.
fn quantile_of(estimate: &Estimate, entry: &ClaimEntry, fits: &BTreeMap<&str, &Fit>) -> f64 {
    let width = half_width(estimate);
    let named = entry.measured.iter().flat_map(|column| &column.fits);
    let fit = named
        .filter_map(|id| fits.get(id.as_str()))
        .find(|fit| (half_width(&fit.slope) - width).abs() <= 1e-6 * width.abs());
    match fit {
        Some(fit) if width > 0.0 => quantile(fit.coverage, Some(fit.degrees_of_freedom)),
        _ => quantile(COVERAGE, None),
    }
}

fn of_fit(fit: &Fit) -> Item {
    let quantile = quantile(fit.coverage, Some(fit.degrees_of_freedom));
    let kept = fit.points.iter().filter(|point| point.kept).count();
    let values = vec![
        ("slope".to_owned(), Quantity::with_interval(&fit.slope, quantile)),
        ("intercept".to_owned(), Quantity::with_interval(&fit.intercept, quantile)),
        ("points kept".to_owned(), Quantity::exactly(kept as f64)),
    ];
    Item { values, ..Item::default() }
}

/// A case in words: everything that tells it from others.
fn case_label(case: &Case) -> String {
    let mut parts = vec![format!("{}-D", case.dimension), case.source.clone(), case.kernel.clone()];
    parts.extend([&case.lattice, &case.disorder].into_iter().flatten().cloned());
    parts.push(case.volume_rule.clone());
    let more = case.more.iter().filter(|(key, _)| !FOUND.contains(&key.as_str()));
    parts.extend(more.map(|(key, value)| match value {
        Value::String(text) => format!("{key} = {text}"),
        value => format!("{key} = {value}"),
    }));
    parts.join(" ")
}

/// A row in words: all its fields but those that are its results.
fn label(row: &impl Serialize, results: &[&str]) -> String {
    let fields = match serde_json::to_value(row) {
        Ok(Value::Object(map)) => map,
        _ => unreachable!("a row is a struct of plain fields"),
    };
    let parts =
        fields.iter().filter(|(key, _)| !results.contains(&key.as_str())).map(|(key, value)| match value {
            Value::String(text) => text.clone(),
            Value::Bool(true) => key.clone(),
            Value::Bool(false) => format!("not {key}"),
            value => format!("{key} = {value}"),
        });
    parts.collect::<Vec<_>>().join(" ")
}
