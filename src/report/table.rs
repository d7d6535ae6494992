//! The verdict table as plain rows, for the terminal and for Markdown alike.

use super::assemble::POWER;
use crate::record::{ClaimEntry, ClaimKind, Column, Estimate, Number, Report, Verdict, significant};
use serde_json::Value;
use std::collections::BTreeMap;

/// One claim with its cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The claim's id.
    pub id: String,
    /// Where it is printed.
    pub location: String,
    /// The statement.
    pub statement: String,
    /// The verdict over all cases, and why.
    pub verdict: Verdict,
    /// Why.
    pub why: String,
    /// What the scene expects.
    pub expected: Option<Verdict>,
    /// Of a claim on an operator: the coefficient by its expansion, and what the operator conserves.
    pub operator: Option<[String; 3]>,
    /// Whether it is about exponents of d̃ and Δ/h; else [`Row::dx_over_h`] holds whatever was measured.
    pub of_exponents: bool,
    /// The cases.
    pub rows: Vec<Row>,
}

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// `2-D`.
    pub dimension: String,
    /// What varies between the cases of the report: disorder, kernel, lattice, volume rule.
    pub case: String,
    /// Published exponents of d̃ and Δ/h, or what else is published.
    pub published: String,
    /// Derived exponents of d̃ and Δ/h, exact.
    pub derived: String,
    /// Measured exponent of d̃.
    pub displacement: String,
    /// Measured exponent of Δ/h.
    pub dx_over_h: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Why.
    pub why: String,
}

/// The report's claims in order, each with its cases.
pub fn sections(report: &Report) -> Vec<Section> {
    let shown = varying(report);
    report
        .verdicts
        .iter()
        .map(|rolled| {
            let entries: Vec<&ClaimEntry> =
                report.claims.iter().filter(|claim| claim.id == rolled.id).collect();
            Section {
                id: rolled.id.clone(),
                location: entries.first().map(|entry| entry.citation.location.clone()).unwrap_or_default(),
                statement: entries.first().map(|entry| entry.statement.clone()).unwrap_or_default(),
                verdict: rolled.verdict,
                why: rolled.why.clone(),
                expected: rolled.expected,
                operator: entries.first().and_then(|entry| operator(entry)),
                of_exponents: entries.iter().all(|entry| !is_of_survey(entry)),
                rows: entries.iter().map(|entry| row(entry, &shown)).collect(),
            }
        })
        .collect()
}

fn operator(entry: &ClaimEntry) -> Option<[String; 3]> {
    let text = |name: &str| entry.case.more.get(name).and_then(|value| value.as_str()).map(str::to_owned);
    Some([text("operator")?, text("expansion")?, text("conserves")?])
}

/// The fields of a case that differ within the report, besides the dimension and the disorder.
fn varying(report: &Report) -> Vec<&'static str> {
    let mut values: BTreeMap<(&'static str, u8), Vec<String>> = BTreeMap::new();
    for entry in &report.claims {
        let fields = [
            ("kernel", Some(&entry.case.kernel)),
            ("lattice", entry.case.lattice.as_ref()),
            ("volumes", Some(&entry.case.volume_rule)),
        ];
        for (name, value) in fields {
            let seen = values.entry((name, entry.case.dimension)).or_default();
            if let Some(value) = value.filter(|value| !seen.contains(value)) {
                seen.push(value.clone());
            }
        }
    }
    ["kernel", "lattice", "volumes"]
        .into_iter()
        .filter(|name| values.iter().any(|((known, _), seen)| known == name && seen.len() > 1))
        .collect()
}

/// What else tells the cases of a survey apart.
fn more(entry: &ClaimEntry) -> impl Iterator<Item = String> {
    let of_orders = ["operator", "order", "expansion", "conserves"];
    let orders = entry.case.more.contains_key("expansion");
    let told = entry.case.more.iter().filter(move |(key, _)| !(orders && of_orders.contains(&key.as_str())));
    told.map(|(key, value)| match value {
        Value::String(text) => text.clone(),
        value => format!("{key} {value}"),
    })
}

/// Whether the entry is about something else than exponents of d̃ and Δ/h, a zero, or a condition of convergence.
fn is_of_survey(entry: &ClaimEntry) -> bool {
    let Some(published) = &entry.published else { return true };
    match entry.kind {
        ClaimKind::Ratio | ClaimKind::Trend | ClaimKind::Inequality => true,
        ClaimKind::Zero => false,
        ClaimKind::Constant => published.unit.as_deref() != Some(POWER),
        ClaimKind::PowerLaw => {
            published.exponents.as_ref().is_none_or(|e| e.dx_over_h.is_none() || e.displacement.is_none())
        }
    }
}

/// A column in words, whatever it holds.
fn plain(column: Option<&Column>) -> String {
    let Some(column) = column else { return "–".into() };
    if let Some(e) = &column.exponents {
        let all = [("d̃", &e.displacement), ("h", &e.h), ("Δ/h", &e.dx_over_h), ("Δ", &e.dx), ("Δt", &e.dt)];
        let there = all.iter().filter_map(|(name, e)| e.as_ref().map(|e| format!("{name}^{}", spread(e))));
        return there.collect::<Vec<_>>().join(", ");
    }
    if let Some(value) = &column.value {
        let unit = column.unit.as_deref().filter(|unit| *unit != "1");
        return format!("{}{}", spread(value), unit.map(|unit| format!(" {unit}")).unwrap_or_default());
    }
    if let Some(zero) = &column.zero {
        let bound = zero.bound.unwrap_or(0.0);
        return if zero.holds { "0".into() } else { format!("up to {bound:.2e}") };
    }
    if let Some(trend) = &column.trend {
        let slope = trend.slope.as_ref().map(|slope| format!(", slope {}", spread(slope)));
        return format!("{}{}", trend.direction, slope.unwrap_or_default());
    }
    if let Some(relation) = &column.relation {
        return match (&relation.left_value, &relation.right_value) {
            (Some(left), Some(right)) => format!("{} and {}", spread(left), spread(right)),
            _ => format!("{} {} {}", relation.left, relation.sign, relation.right),
        };
    }
    "–".into()
}

/// A number, with its interval if it has one.
fn spread(estimate: &Estimate) -> String {
    if estimate.low == estimate.high {
        return text_of(&estimate.value);
    }
    format!("{} [{}, {}]", text_of(&estimate.value), text_of(&estimate.low), text_of(&estimate.high))
}

fn text_of(value: &Number) -> String {
    match value {
        Number::Rational(text) => text.clone(),
        Number::Float(value) => short(*value),
    }
}

/// Four significant digits; whole numbers as they are.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        return format!("{}", significant(value, 4));
    }
    if value.fract() == 0.0 && value.abs() < 1e15 { format!("{value}") } else { format!("{value:.3e}") }
}

fn row(entry: &ClaimEntry, shown: &[&str]) -> Row {
    let case = &entry.case;
    let mut parts = vec![match case.disorder.as_deref() {
        None | Some("none") => "regular".to_owned(),
        Some(disorder) => disorder.to_owned(),
    }];
    for name in shown {
        parts.push(match *name {
            "kernel" => case.kernel.clone(),
            "lattice" => case.lattice.clone().unwrap_or_default(),
            _ => case.volume_rule.clone(),
        });
    }
    parts.extend(more(entry));
    if is_of_survey(entry) {
        return Row {
            dimension: format!("{}-D", case.dimension),
            case: parts.join(" "),
            published: plain(entry.published.as_ref()),
            derived: plain(entry.derived.as_ref()),
            displacement: String::new(),
            dx_over_h: plain(entry.measured.as_ref()),
            verdict: entry.verdict,
            why: entry.why.clone(),
        };
    }
    let exponent = |column: &Option<Column>, which: fn(&super::Exponents) -> &Option<Estimate>| {
        column.as_ref().and_then(|c| c.exponents.as_ref()).and_then(|e| which(e).clone())
    };
    let published =
        match (exponent(&entry.published, |e| &e.displacement), exponent(&entry.published, |e| &e.dx_over_h))
        {
            (Some(d), Some(x)) if number(&d.value) == "0" => number(&x.value),
            (Some(d), Some(x)) => format!("{}, {}", number(&d.value), number(&x.value)),
            _ => {
                power(&entry.published).map_or("0".into(), |power| format!("Δ ≪ h^{}", number(&power.value)))
            }
        };
    let derived =
        match (exponent(&entry.derived, |e| &e.displacement), exponent(&entry.derived, |e| &e.dx_over_h)) {
            _ if power(&entry.derived).is_some() => {
                power(&entry.derived).map(|power| format!("h^{}", number(&power.value))).unwrap_or_default()
            }
            (Some(d), Some(x)) if number(&d.value) == "0" => number(&x.value),
            (Some(d), Some(x)) => format!("{}, {}", number(&d.value), number(&x.value)),
            _ if entry.derived.is_some() => {
                let zero = entry.derived.as_ref().and_then(|column| column.zero.as_ref());
                match zero.filter(|zero| !zero.holds).and_then(|zero| zero.bound) {
                    Some(bound) => format!("up to {bound:.2e}"),
                    None => "0".into(),
                }
            }
            _ => "–".into(),
        };
    let zero = entry.measured.as_ref().and_then(|column| column.zero.as_ref());
    let dx_over_h = match (exponent(&entry.measured, |e| &e.dx_over_h), zero) {
        (Some(x), _) => interval(&x),
        (None, None) if power(&entry.measured).is_some() => {
            power(&entry.measured).map(|power| format!("h^{}", interval(&power))).unwrap_or_default()
        }
        (None, Some(zero)) if zero.holds => format!("zero by {}", zero.by.as_deref().unwrap_or("value")),
        (None, Some(zero)) => format!("up to {:.2e}", zero.bound.unwrap_or(f64::NAN)),
        _ => "–".into(),
    };
    let displacement = match exponent(&entry.measured, |e| &e.displacement) {
        Some(d) if d.by == Some(super::Source::Identity) => String::new(),
        Some(d) => interval(&d),
        None => String::new(),
    };
    Row {
        dimension: format!("{}-D", case.dimension),
        case: parts.join(" "),
        published,
        derived,
        displacement,
        dx_over_h,
        verdict: entry.verdict,
        why: entry.why.clone(),
    }
}

/// Of a claim on convergence, the power of h that Δ must fall faster than.
fn power(column: &Option<Column>) -> Option<Estimate> {
    column.as_ref().and_then(|column| column.value.clone())
}

fn number(value: &Number) -> String {
    match value {
        Number::Rational(text) => text.clone(),
        Number::Float(value) => format!("{value:.2}"),
    }
}

fn interval(estimate: &Estimate) -> String {
    format!("{} [{}, {}]", number(&estimate.value), number(&estimate.low), number(&estimate.high))
}
