//! How what the record names is said in a figure.

use crate::record::{Case, Estimate, Number};

/// The number as `f64`; "p/q" is divided.
pub(in crate::report) fn value_of(number: &Number) -> Option<f64> {
    match number {
        Number::Float(value) => Some(*value),
        Number::Rational(text) => match text.split_once('/') {
            Some((p, q)) => Some(p.trim().parse::<f64>().ok()? / q.trim().parse::<f64>().ok()?),
            None => text.trim().parse().ok(),
        },
    }
}

/// An exponent as a label: exact as it is, else with two decimals.
pub(in crate::report) fn exponent_label(estimate: &Estimate) -> String {
    match &estimate.value {
        Number::Rational(text) => text.replace('-', "−"),
        Number::Float(value) => format!("{value:.2}").replace('-', "−"),
    }
}

/// A disorder, or `regular`.
pub(in crate::report) fn disorder_name(case: &Case) -> &str {
    match case.disorder.as_deref() {
        None | Some("none") => "regular",
        Some(disorder) => disorder,
    }
}

/// The case in a line: dimension, kernel, lattice, disorder, volume rule.
pub(in crate::report) fn case_name(case: &Case) -> String {
    let lattice = case.lattice.as_deref().unwrap_or(&case.source);
    format!(
        "{}-D, {}, {lattice}, {}, {} volumes",
        case.dimension,
        case.kernel,
        disorder_name(case),
        case.volume_rule
    )
}
