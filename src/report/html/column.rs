//! One of the three columns of an entry, whatever it holds.

use super::math::{measured, short_order};
use super::text::{estimate, number, rich};
use crate::record::{ClaimEntry, Column, Estimate, significant};
use crate::report::figure::value_of;
use crate::report::rich::escaped;

/// Which of the three.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    Published,
    Derived,
    Measured,
}

impl Which {
    pub(super) const ALL: [Self; 3] = [Self::Published, Self::Derived, Self::Measured];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Derived => "derived",
            Self::Measured => "measured",
        }
    }

    pub(super) fn of(self, entry: &ClaimEntry) -> Option<&Column> {
        match self {
            Self::Published => entry.published.as_ref(),
            Self::Derived => entry.derived.as_ref(),
            Self::Measured => entry.measured.as_ref(),
        }
    }
}

/// The column in a cell of a table.
pub(super) fn cell(entry: &ClaimEntry, which: Which) -> String {
    let Some(column) = which.of(entry) else { return "–".into() };
    if let Some(exponents) = &column.exponents {
        return if which == Which::Measured { measured(exponents) } else { short_order(exponents) };
    }
    if let Some(value) = &column.value {
        let unit = column.unit.as_deref().filter(|unit| *unit != "1");
        // Of a condition of convergence, the value is the power of h that Δ has to fall faster than.
        return match unit {
            Some(unit) if unit.contains("power") => format!("h<sup>{}</sup>", estimate(value)),
            Some(unit) => format!("{} {}", estimate(value), rich(unit)),
            None => estimate(value),
        };
    }
    if let Some(zero) = &column.zero {
        return match (zero.holds, zero.by.as_deref(), zero.bound) {
            (true, Some(by), _) => format!("0 by {}", escaped(by)),
            (true, None, _) => "0".into(),
            (false, _, Some(bound)) => format!("up to {}", number(bound)),
            (false, _, None) => "not 0".into(),
        };
    }
    if let Some(trend) = &column.trend {
        let slope = trend.slope.as_ref().map(|slope| format!(", slope {}", estimate(slope)));
        return format!("{}{}", escaped(&trend.direction), slope.unwrap_or_default());
    }
    if let Some(relation) = &column.relation {
        return match (&relation.left_value, &relation.right_value) {
            (Some(left), Some(right)) => format!("{} and {}", estimate(left), estimate(right)),
            _ => format!("{} {} {}", rich(&relation.left), escaped(&relation.sign), rich(&relation.right)),
        };
    }
    "–".into()
}

/// The column over all cases of a claim, dimension by dimension where they differ.
pub(super) fn summary(entries: &[&ClaimEntry], which: Which) -> String {
    let distinct = |own: &[&ClaimEntry]| {
        let mut cells: Vec<String> = Vec::new();
        for entry in own {
            let cell = cell(entry, which);
            if !cells.contains(&cell) {
                cells.push(cell);
            }
        }
        cells
    };
    let all = distinct(entries);
    if let [only] = all.as_slice() {
        return only.clone();
    }
    let mut lines = Vec::new();
    let dimensions: Vec<u8> =
        (1..=3).filter(|d| entries.iter().any(|entry| entry.case.dimension == *d)).collect();
    for dimension in &dimensions {
        let own: Vec<&ClaimEntry> =
            entries.iter().filter(|entry| entry.case.dimension == *dimension).copied().collect();
        let cells = distinct(&own);
        let told = match cells.as_slice() {
            [only] => only.clone(),
            [one, two] if which != Which::Measured => format!("{one}\u{a0}or<br/>{two}"),
            _ => spread(&own, which).unwrap_or_else(|| format!("{} cases", own.len())),
        };
        let head = if dimensions.len() > 1 { format!("<b>{dimension}-D</b> ") } else { String::new() };
        lines.push(format!("{head}{told}"));
    }
    lines.join("<br/>")
}

/// From the least to the largest exponent or value.
fn spread(entries: &[&ClaimEntry], which: Which) -> Option<String> {
    type Pick = fn(&Column) -> Option<&Estimate>;
    let picks: [(&str, Pick); 6] = [
        ("(Δ/h)", |column| column.exponents.as_ref()?.dx_over_h.as_ref()),
        ("d̃", |column| column.exponents.as_ref()?.displacement.as_ref()),
        ("h", |column| column.exponents.as_ref()?.h.as_ref()),
        ("Δ", |column| column.exponents.as_ref()?.dx.as_ref()),
        ("Δt", |column| column.exponents.as_ref()?.dt.as_ref()),
        ("", |column| column.value.as_ref()),
    ];
    let short = |value: f64| number(significant(value, 3));
    picks.into_iter().find_map(|(base, pick)| {
        let values: Option<Vec<f64>> =
            entries.iter().map(|entry| value_of(&pick(which.of(entry)?)?.value)).collect();
        let values = values?;
        let least = short(values.iter().copied().reduce(f64::min)?);
        let most = short(values.iter().copied().reduce(f64::max)?);
        let range = if least == most { least } else { format!("{least} … {most}") };
        Some(if base.is_empty() { range } else { format!("{base}<sup>{range}</sup>") })
    })
}
