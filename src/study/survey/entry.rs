//! Entries of the record from what a survey found.

use crate::claim::{Assertion, Direction, Judgement, Measured, Observed, Published, Sign, Variable, Verdict};
use crate::record::{
    Case, Citation, ClaimEntry, ClaimKind, Column, Estimate, Exponents, Relation, Source, Trend, Zero,
    significant,
};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Significant digits of what is reported.
const DIGITS: usize = 8;

/// A row of a table of the report.
pub type Row = BTreeMap<String, Value>;

/// A row from a struct of plain fields.
pub fn table_row(row: &impl Serialize) -> Row {
    match serde_json::to_value(row) {
        Ok(Value::Object(map)) => map.into_iter().collect(),
        _ => unreachable!("a row is a struct of plain fields"),
    }
}

/// A statement in one case, judged. The measured column decides; where it does not, and does not contradict the derived one,
/// that does. `fits` are the ids of the fits behind the measured numbers.
pub fn entry(
    assertion: &Assertion,
    case: Case,
    derived: Option<Observed>,
    measured: Option<Observed>,
    fits: Vec<String>,
) -> ClaimEntry {
    let published = &assertion.published;
    let by_measure = measured.as_ref().map(|found| published.judge(found));
    let by_algebra = derived.as_ref().map(|found| published.judge(found));
    let judgement = combine(by_measure, by_algebra);
    let column = |found: &Observed, by| column(published, found, by);
    ClaimEntry {
        id: assertion.id.clone(),
        kind: kind(published),
        citation: Citation { source: assertion.source.into(), location: assertion.location.clone() },
        statement: assertion.text.clone(),
        case,
        published: Some(printed(published)),
        derived: derived.as_ref().map(|found| column(found, Source::Derivation)),
        measured: measured.as_ref().map(|found| Column { fits, ..column(found, Source::Fit) }),
        margin: margin(published),
        verdict: judgement.verdict,
        why: judgement.why,
    }
}

fn combine(measured: Option<Judgement>, derived: Option<Judgement>) -> Judgement {
    match (measured, derived) {
        (Some(measured), Some(derived)) if measured.verdict == derived.verdict => {
            let why = format!("{} Derived: {}", measured.why, derived.why);
            Judgement { verdict: measured.verdict, why }
        }
        (Some(measured), Some(derived)) if measured.verdict == Verdict::Inconclusive => Judgement {
            verdict: derived.verdict,
            why: format!("Derived: {} Measured: {}", derived.why, measured.why),
        },
        (Some(measured), Some(derived)) if derived.verdict == Verdict::Inconclusive => {
            Judgement { verdict: measured.verdict, why: format!("{} Derived: {}", measured.why, derived.why) }
        }
        (Some(measured), Some(derived)) => Judgement {
            verdict: Verdict::Inconclusive,
            why: format!("the columns disagree. Measured: {} Derived: {}", measured.why, derived.why),
        },
        (Some(one), None) => one,
        (None, Some(one)) => Judgement { why: format!("Derived: {}", one.why), ..one },
        (None, None) => {
            Judgement { verdict: Verdict::Inconclusive, why: "nothing was derived or measured.".into() }
        }
    }
}

fn kind(published: &Published) -> ClaimKind {
    match published {
        Published::Constant { .. } | Published::Never => ClaimKind::Constant,
        Published::Ratio { .. } => ClaimKind::Ratio,
        Published::Exponent { .. } | Published::Order { .. } => ClaimKind::PowerLaw,
        Published::Zero => ClaimKind::Zero,
        Published::Trend { .. } => ClaimKind::Trend,
        Published::Relation { .. } => ClaimKind::Inequality,
    }
}

fn margin(published: &Published) -> Option<f64> {
    match published {
        Published::Constant { value, margin, .. } | Published::Ratio { value, margin } => {
            Some(margin * value.abs())
        }
        Published::Exponent { margin, .. }
        | Published::Order { margin, .. }
        | Published::Trend { margin, .. } => Some(*margin),
        Published::Zero | Published::Never | Published::Relation { .. } => None,
    }
}

fn printed(published: &Published) -> Column {
    let number = |value: f64| Estimate::float(value, value, value, Source::Print);
    match published {
        Published::Constant { value, unit, .. } => {
            Column { value: Some(number(*value)), unit: Some((*unit).into()), ..Column::default() }
        }
        Published::Ratio { value, .. } => {
            Column { value: Some(number(*value)), unit: Some("1".into()), ..Column::default() }
        }
        Published::Exponent { of, value, .. } | Published::Order { of, value, .. } => {
            Column { exponents: Some(exponents(*of, number(*value))), ..Column::default() }
        }
        Published::Never => exceptions(0, Source::Print),
        Published::Zero => {
            Column { zero: Some(Zero { holds: true, by: None, bound: None }), ..Column::default() }
        }
        Published::Trend { direction, .. } => {
            Column { trend: Some(trend(published, direction_word(*direction), None)), ..Column::default() }
        }
        Published::Relation { .. } => {
            Column { relation: relation(published, true, None), ..Column::default() }
        }
    }
}

fn column(published: &Published, found: &Observed, by: Source) -> Column {
    let number = |found: &Measured| {
        let round = |value| significant(value, DIGITS);
        Estimate::float(round(found.value), round(found.low), round(found.high), by)
    };
    match (published, found) {
        (Published::Exponent { of, .. } | Published::Order { of, .. }, Observed::Number(found)) => {
            Column { exponents: Some(exponents(*of, number(found))), ..Column::default() }
        }
        (Published::Trend { margin, .. }, Observed::Number(slope)) => {
            let word = if slope.low > *margin {
                "rising"
            } else if slope.high < -margin {
                "falling"
            } else {
                "constant"
            };
            Column { trend: Some(trend(published, word, Some(number(slope)))), ..Column::default() }
        }
        (Published::Constant { unit, .. }, Observed::Number(found)) => {
            Column { value: Some(number(found)), unit: Some((*unit).into()), ..Column::default() }
        }
        (_, Observed::Number(found)) => {
            Column { value: Some(number(found)), unit: Some("1".into()), ..Column::default() }
        }
        (_, Observed::Zero { largest, floor }) => {
            let holds = largest <= floor;
            let by = holds.then(|| if *floor == 0.0 { "symmetry" } else { "value" }.to_owned());
            Column {
                zero: Some(Zero { holds, by, bound: Some(significant(*largest, DIGITS)) }),
                ..Column::default()
            }
        }
        (_, Observed::Exceptions { count, .. }) => exceptions(*count, by),
        (_, Observed::Sides { left, right }) => {
            let holds = published.judge(found).verdict == Verdict::Confirmed;
            let sides = Some((number(left), number(right)));
            Column { relation: relation(published, holds, sides), ..Column::default() }
        }
    }
}

fn exceptions(count: usize, by: Source) -> Column {
    Column {
        value: Some(Estimate::exact(count.to_string(), by)),
        unit: Some("exceptions".into()),
        ..Column::default()
    }
}

fn exponents(of: Variable, value: Estimate) -> Exponents {
    let value = Some(value);
    match of {
        Variable::Displacement => Exponents { displacement: value, ..Exponents::default() },
        Variable::H => Exponents { h: value, ..Exponents::default() },
        Variable::DxOverH => Exponents { dx_over_h: value, ..Exponents::default() },
        Variable::Dx => Exponents { dx: value, ..Exponents::default() },
        Variable::Dt => Exponents { dt: value, ..Exponents::default() },
    }
}

fn direction_word(direction: Direction) -> &'static str {
    match direction {
        Direction::Rising => "rising",
        Direction::Falling => "falling",
        Direction::Constant => "constant",
    }
}

fn trend(published: &Published, direction: &str, slope: Option<Estimate>) -> Trend {
    let (of, against) = match published {
        Published::Trend { of, against, .. } => (*of, *against),
        _ => ("", ""),
    };
    Trend { of: of.into(), against: against.into(), direction: direction.into(), slope }
}

fn relation(published: &Published, holds: bool, sides: Option<(Estimate, Estimate)>) -> Option<Relation> {
    let Published::Relation { left, sign, right } = published else { return None };
    let sign = match sign {
        Sign::Less => "<",
        Sign::Greater => ">",
        Sign::Equal => "=",
    };
    let (left_value, right_value) = sides.map_or((None, None), |(left, right)| (Some(left), Some(right)));
    Some(Relation {
        left: (*left).into(),
        sign: sign.into(),
        right: (*right).into(),
        holds,
        left_value,
        right_value,
    })
}
