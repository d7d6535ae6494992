//! What changed from one report to another: verdicts, exponents, constants and fits by name, each change in standard errors.
//!
//! The record does not hold standard errors but intervals. An interval that covers a share c has the standard error
//! (high − low) / 2 over the quantile (1 + c)/2: of Student's t with the fit's degrees of freedom where a fit gave it, else of
//! the normal distribution with c = 95 %. Widened intervals give larger standard errors, so that a change is rather
//! understated. Two numbers differ by |b − a| / √(s_a² + s_b²) standard errors, as if they were independent; numbers
//! without intervals on either side are compared exactly, and "p/q" as rationals.

mod items;
mod text;

use crate::record::Report;
use items::{Item, Items, items};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

pub use text::difference_text;

/// All that differs between two reports.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Difference {
    /// What made the first report, where it differs from what made the second: field, then both values. No change by itself.
    pub provenance: BTreeMap<String, [Value; 2]>,
    /// Verdicts over all cases of a claim, and in single cases.
    pub verdicts: Vec<VerdictChange>,
    /// Exponents, constants, fits, and what else is a number or a word.
    pub values: Vec<ValueChange>,
    /// What only the second report has.
    pub added: Vec<Place>,
    /// What only the first report has.
    pub removed: Vec<Place>,
    /// Lists compared row by row: series, further tables, runs.
    pub lists: Vec<ListChange>,
}

/// Where in a report something stands.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Place {
    /// The list: `verdicts`, `claims`, `fits`, `viscosity_constants`, `laplacian_factors`, `inferred_domain_size`, `series`,
    /// `tables`, `runs`.
    pub list: &'static str,
    /// Which item of it, in words: its id, and its case.
    pub item: String,
}

/// A verdict that changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VerdictChange {
    /// Whose: in `verdicts` over all cases, in `claims` in one.
    #[serde(flatten)]
    pub place: Place,
    /// In the first report.
    pub before: String,
    /// In the second.
    pub after: String,
    /// The second report's reason.
    pub why: String,
}

/// A number or a word that changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValueChange {
    /// Of what.
    #[serde(flatten)]
    pub place: Place,
    /// Which: `measured: exponent of Δ/h`, `slope`, ….
    pub quantity: String,
    /// In the first report; null where it has none.
    pub before: Value,
    /// In the second report; null where it has none.
    pub after: Value,
    /// Second minus first, where both are numbers.
    pub difference: Option<f64>,
    /// The difference in its standard errors; null where neither number has an interval.
    pub standard_errors: Option<f64>,
}

/// A list some of whose rows changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ListChange {
    /// Which.
    #[serde(flatten)]
    pub place: Place,
    /// Rows in the first report.
    pub rows_before: usize,
    /// Rows in the second report.
    pub rows_after: usize,
    /// Rows that are not the same in both, by their place in the list.
    pub rows_changed: usize,
}

impl Difference {
    /// What changed from `before` to `after`.
    pub fn between(before: &Report, after: &Report) -> Self {
        let mut difference = Self {
            provenance: provenance(before, after),
            verdicts: Vec::new(),
            values: Vec::new(),
            added: Vec::new(),
            removed: Vec::new(),
            lists: Vec::new(),
        };
        let (first, second) = (items(before), items(after));
        difference.removed = missing(&first, &second);
        difference.added = missing(&second, &first);
        for (place, item) in &first {
            if let Some(other) = second.get(place) {
                difference.compare(place, item, other);
            }
        }
        difference
    }

    /// Whether nothing changed.
    pub fn is_nothing(&self) -> bool {
        let Self { provenance: _, verdicts, values, added, removed, lists } = self;
        verdicts.is_empty() && values.is_empty() && added.is_empty() && removed.is_empty() && lists.is_empty()
    }

    fn compare(&mut self, place: &Place, before: &Item, after: &Item) {
        if let (Some(first), Some(second)) = (&before.rows, &after.rows) {
            let same = first.iter().zip(second).filter(|(a, b)| a == b).count();
            let rows_changed = first.len().max(second.len()) - same;
            if rows_changed > 0 {
                let (rows_before, rows_after) = (first.len(), second.len());
                let place = place.clone();
                self.lists.push(ListChange { place, rows_before, rows_after, rows_changed });
            }
        }
        if before.verdict != after.verdict {
            let word = |item: &Item| item.verdict.map(|verdict| verdict.to_string()).unwrap_or_default();
            self.verdicts.push(VerdictChange {
                place: place.clone(),
                before: word(before),
                after: word(after),
                why: after.why.clone(),
            });
        }
        let names = before.values.iter().chain(&after.values).map(|(name, _)| name);
        let mut seen = Vec::new();
        for name in names {
            if seen.contains(&name) {
                continue;
            }
            seen.push(name);
            let (first, second) = (before.value(name), after.value(name));
            if first == second {
                continue;
            }
            let both = first.zip(second);
            let gap = both.and_then(|(a, b)| a.gap(b));
            self.values.push(ValueChange {
                place: place.clone(),
                quantity: name.clone(),
                before: first.map_or(Value::Null, items::Quantity::to_json),
                after: second.map_or(Value::Null, items::Quantity::to_json),
                difference: gap.map(|(difference, _)| difference),
                standard_errors: gap.and_then(|(difference, error)| error.map(|e| difference.abs() / e)),
            });
        }
    }
}

/// What stands in the first and not in the second.
fn missing(first: &Items, second: &Items) -> Vec<Place> {
    first.keys().filter(|place| !second.contains_key(place)).cloned().collect()
}

fn provenance(before: &Report, after: &Report) -> BTreeMap<String, [Value; 2]> {
    let fields = |report: &Report| match serde_json::to_value(&report.provenance) {
        Ok(Value::Object(map)) => map,
        _ => unreachable!("provenance is a struct of plain fields"),
    };
    let (first, second) = (fields(before), fields(after));
    let differing = first.iter().filter(|(key, value)| second.get(*key) != Some(value));
    differing
        .map(|(key, value)| (key.clone(), [value.clone(), second.get(key).cloned().unwrap_or_default()]))
        .collect()
}
