//! Powers of the record as MathML, and as short HTML.

use super::text::exact_or_rounded;
use crate::record::{Estimate, Exponents, Number};
use crate::report::rich::escaped;

/// What a power is of.
#[derive(Clone, Copy)]
struct Base {
    html: &'static str,
    math: &'static str,
}

const BASES: [Base; 5] = [
    Base { html: "d̃", math: "<mover><mi>d</mi><mo>~</mo></mover>" },
    Base { html: "h", math: "<mi>h</mi>" },
    Base { html: "(Δ/h)", math: "<mrow><mo>(</mo><mi>Δ</mi><mo>/</mo><mi>h</mi><mo>)</mo></mrow>" },
    Base { html: "Δ", math: "<mi>Δ</mi>" },
    Base { html: "Δt", math: "<mrow><mi>Δ</mi><mi>t</mi></mrow>" },
];

/// The powers that are there and are not the zeroth, in the order of the papers.
fn factors(exponents: &Exponents) -> Vec<(Base, &Estimate)> {
    let all = [&exponents.displacement, &exponents.h, &exponents.dx_over_h, &exponents.dx, &exponents.dt];
    let there = BASES.into_iter().zip(all).filter_map(|(base, exponent)| Some((base, exponent.as_ref()?)));
    there.filter(|(_, exponent)| !is_number(&exponent.value, 0.0)).collect()
}

fn is_number(value: &Number, wanted: f64) -> bool {
    match value {
        Number::Rational(text) => text.parse() == Ok(wanted),
        Number::Float(value) => *value == wanted,
    }
}

/// `O(d̃ h^{−2} (Δ/h)^{1/2})` as a formula.
pub(super) fn order(exponents: &Exponents) -> String {
    let mut inside: String =
        factors(exponents).iter().map(|(base, exponent)| power(*base, exponent)).collect();
    if inside.is_empty() {
        inside = "<mn>1</mn>".into();
    }
    format!("<math><mi>O</mi><mo>(</mo>{inside}<mo>)</mo></math>")
}

fn power(base: Base, exponent: &Estimate) -> String {
    if is_number(&exponent.value, 1.0) {
        return base.math.to_owned();
    }
    format!("<msup>{}{}</msup>", base.math, script(exponent))
}

/// Two decimals at most: a printed −1 is no −1.00.
fn brief(value: f64) -> String {
    format!("{}", (value * 100.0).round() / 100.0)
}

/// A number as an exponent: a fraction keeps its bar.
fn script(exponent: &Estimate) -> String {
    let text = match &exponent.value {
        Number::Float(value) if exponent.low == exponent.high => brief(*value),
        Number::Float(value) => format!("{value:.2}"),
        Number::Rational(text) => text.clone(),
    };
    let (sign, size) = match text.strip_prefix('-') {
        Some(size) => ("<mo>−</mo>", size),
        None => ("", text.as_str()),
    };
    let body = match size.split_once('/') {
        Some((p, q)) => format!("<mfrac><mn>{}</mn><mn>{}</mn></mfrac>", escaped(p), escaped(q)),
        None => format!("<mn>{}</mn>", escaped(size)),
    };
    if sign.is_empty() { body } else { format!("<mrow>{sign}{body}</mrow>") }
}

/// The same in a line of text, for tables of many rows: `d̃ h⁻² (Δ/h)^{1/2}`.
pub(super) fn short_order(exponents: &Exponents) -> String {
    let factor = |(base, exponent): &(Base, &Estimate)| {
        if is_number(&exponent.value, 1.0) {
            return base.html.to_owned();
        }
        let value = match &exponent.value {
            Number::Float(value) => brief(*value).replace('-', "−"),
            exact => exact_or_rounded(exact),
        };
        format!("{}<sup>{value}</sup>", base.html)
    };
    let all: Vec<String> = factors(exponents).iter().map(factor).collect();
    // No line may break inside a product of powers.
    if all.is_empty() { "1".into() } else { all.join("\u{a0}") }
}

/// The exponents that were measured, each with its interval; what follows from the scaling of lengths is not repeated.
pub(super) fn measured(exponents: &Exponents) -> String {
    let identity = Some(crate::record::Source::Identity);
    let all = [&exponents.displacement, &exponents.h, &exponents.dx_over_h, &exponents.dx, &exponents.dt];
    let of = |(base, exponent): (Base, &Option<Estimate>)| {
        let e = exponent.as_ref().filter(|e| e.by != identity)?;
        let two = |value: &Number| match value {
            Number::Float(value) => format!("{value:.2}").replace('-', "−"),
            exact => exact_or_rounded(exact),
        };
        let interval = if e.low == e.high {
            String::new()
        } else {
            format!(" [{},\u{a0}{}]", two(&e.low), two(&e.high))
        };
        Some(format!("{}<sup>{}</sup>{interval}", base.html, two(&e.value)))
    };
    let all: Vec<String> = BASES.into_iter().zip(all).rev().filter_map(of).collect();
    if all.is_empty() { "–".into() } else { all.join("<br/>") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Source;

    #[test]
    fn fractions_keep_their_bar() {
        let exact = |text: &str| Some(Estimate::exact(text, Source::Derivation));
        let exponents = Exponents {
            displacement: exact("1"),
            h: exact("-2"),
            dx_over_h: exact("1/2"),
            ..Exponents::default()
        };
        assert_eq!(short_order(&exponents), "d̃\u{a0}h<sup>−2</sup>\u{a0}(Δ/h)<sup>1/2</sup>");
        let formula = order(&exponents);
        assert!(formula.contains("<msup><mi>h</mi><mrow><mo>−</mo><mn>2</mn></mrow></msup>"), "{formula}");
        assert!(formula.contains("<mfrac><mn>1</mn><mn>2</mn></mfrac>"), "{formula}");
    }
}
