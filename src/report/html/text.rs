//! Text and numbers of the record in HTML.

use crate::record::{Estimate, Number, significant};
use crate::report::rich::{Level, escaped, pieces};
use serde_json::Value;

/// Text with powers and indices: `(Δ/h)^{β+1}`, `r_ij`, and `1.0e-6` as a power of ten.
pub(super) fn rich(text: &str) -> String {
    let piece = |(level, text): (Level, String)| match level {
        Level::Line => escaped(&text),
        Level::Superscript => format!("<sup>{}</sup>", escaped(&text)),
        Level::Subscript => format!("<sub>{}</sub>", escaped(&text)),
    };
    pieces(&without_e(text)).into_iter().map(piece).collect()
}

/// `2.50e-6` as `2.50×10^{-6}`, and `1.0e0` as `1.0`.
fn without_e(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let mut written = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(c) = characters.get(at) {
        let follows_digit = at > 0 && characters[at - 1].is_ascii_digit() && in_number(&characters[..at]);
        let power = if *c == 'e' && follows_digit { power_length(&characters[at + 1..]) } else { 0 };
        if power == 0 {
            written.push(*c);
            at += 1;
            continue;
        }
        let digits: String = characters[at + 1..at + 1 + power].iter().collect();
        if digits != "0" {
            written.push_str(&format!("×10^{{{digits}}}"));
        }
        at += 1 + power;
    }
    written
}

/// Whether the digits before stand by themselves, not inside a name.
fn in_number(before: &[char]) -> bool {
    let rest = before.iter().rev().find(|c| !(c.is_ascii_digit() || **c == '.'));
    !rest.is_some_and(|c| c.is_alphanumeric() || *c == '_')
}

fn power_length(rest: &[char]) -> usize {
    let sign = usize::from(rest.first() == Some(&'-'));
    let digits = rest.iter().skip(sign).take_while(|c| c.is_ascii_digit()).count();
    let ends = rest.get(sign + digits).is_none_or(|c| !c.is_alphanumeric());
    if digits > 0 && ends { sign + digits } else { 0 }
}

/// Four significant digits, with a power of ten where zeros would be counted.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || (1e-3..1e5).contains(&size) || (value.fract() == 0.0 && size < 1e7) {
        let shown = if value.fract() == 0.0 { value } else { significant(value, 4) };
        return format!("{shown}").replace('-', "−");
    }
    if !value.is_finite() {
        return "–".into();
    }
    rich(&format!("{:e}", significant(value, 4))).replace('-', "−")
}

/// An exact number as it is, another with four digits.
pub(super) fn exact_or_rounded(value: &Number) -> String {
    match value {
        Number::Rational(text) => escaped(&text.replace('-', "−")),
        Number::Float(value) => number(*value),
    }
}

/// A number with its interval, if it has one.
pub(super) fn estimate(estimate: &Estimate) -> String {
    let value = exact_or_rounded(&estimate.value);
    if estimate.low == estimate.high {
        return value;
    }
    format!("{value} [{},\u{a0}{}]", exact_or_rounded(&estimate.low), exact_or_rounded(&estimate.high))
}

/// A value of a table or a case.
pub(super) fn value(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => "–".into(),
        Some(Value::String(text)) => rich(text),
        Some(Value::Bool(true)) => "yes".into(),
        Some(Value::Bool(false)) => "no".into(),
        Some(Value::Number(number_)) => number_.as_f64().map_or_else(|| number_.to_string(), number),
        Some(other) => escaped(&other.to_string()),
    }
}

/// A key of the record as words: `h_over_dx` as `h/Δ`.
pub(super) fn key(name: &str) -> String {
    let known = [
        ("dx_over_h", "Δ/h"),
        ("h_over_dx", "h/Δ"),
        ("support_over_dx", "R/Δ"),
        ("l2", "L2"),
        ("linf", "L∞"),
        ("ec", "EC"),
        ("epsilon", "ε"),
        ("eta", "η"),
        ("xi", "ξ"),
    ];
    if let Some((_, words)) = known.iter().find(|(own, _)| *own == name) {
        return (*words).to_owned();
    }
    // Lengths of the record say their unit at the end of their name.
    let (name, unit) = match name.strip_suffix("_m") {
        Some(name) => (name, " [m]"),
        None => (name, ""),
    };
    format!("{}{unit}", escaped(&name.replace("_over_", " over ").replace('_', " ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(rich("above (1.0e-6), 1.000e0"), "above (1.0×10<sup>−6</sup>), 1.000");
        assert_eq!(rich("0.0439 fatehi-2e"), "0.0439 fatehi-2e");
    }

    #[test]
    fn numbers_have_four_digits() {
        assert_eq!(number(0.123_456), "0.1235");
        assert_eq!(number(-2.5e-7), "−2.5×10<sup>−7</sup>");
        assert_eq!(number(965_120.0), "965120");
    }
}
