//! Expansions, which the record holds as text, as MathML: `1/2 ∇∇u : Σ_j ω_j r_ij r_ij B_i·∇W_ij`.
//!
//! A symbol is one character with its accent; `_` takes the lowercase letters behind it, and what a sum runs over
//! (`Σ_k(j)`); `^` takes letters or a signed number. Bars group. What is no symbol is an operator.

use crate::report::rich::escaped;
use std::iter::Peekable;
use std::str::Chars;

/// One `<math>` for each term, so that lines can break between them.
pub(super) fn formula(text: &str) -> String {
    let mut terms: Vec<String> = Vec::new();
    for word in text.split_inclusive(' ') {
        match terms.last_mut() {
            Some(term) if !["+ ", "− "].contains(&word) => term.push_str(word),
            _ => terms.push(word.to_owned()),
        }
    }
    let math = |term: &String| format!("<math>{}</math>", row(&mut term.trim().chars().peekable(), None));
    terms.iter().map(math).collect::<Vec<_>>().join(" ")
}

type Text<'a> = Peekable<Chars<'a>>;

/// What stands up to `end`, or up to the end of the text.
fn row(text: &mut Text<'_>, end: Option<char>) -> String {
    let mut out = String::new();
    while let Some(c) = text.next() {
        if Some(c) == end {
            break;
        }
        match c {
            ' ' => {}
            '0'..='9' => out.push_str(&number(c, text)),
            // With the sum's index below.
            'Σ' => {
                let under = lowered(text).map(|index| letters(&index));
                out.push_str(&under.map_or_else(
                    || "<mo>∑</mo>".to_owned(),
                    |index| format!("<munder><mo>∑</mo>{index}</munder>"),
                ));
            }
            '|' => {
                let inside = row(text, Some('|'));
                out.push_str(&scripted(format!("<mrow><mo>|</mo>{inside}<mo>|</mo></mrow>"), text));
            }
            c if c.is_alphabetic() || "∂∇".contains(c) => {
                let own = if c.is_alphabetic() { format!("<mi>{c}</mi>") } else { format!("<mo>{c}</mo>") };
                let accent = text.next_if(|c| ['\u{302}', '\u{303}'].contains(c));
                let own = match accent {
                    Some('\u{302}') => format!("<mover accent=\"true\">{own}<mo>^</mo></mover>"),
                    Some(_) => format!("<mover accent=\"true\">{own}<mo>~</mo></mover>"),
                    None => own,
                };
                out.push_str(&scripted(own, text));
            }
            c => out.push_str(&format!("<mo>{}</mo>", escaped(c.encode_utf8(&mut [0; 4])))),
        }
    }
    out
}

/// A whole number, or a fraction.
fn number(first: char, text: &mut Text<'_>) -> String {
    let digits = |text: &mut Text<'_>| {
        let mut found = String::new();
        while let Some(digit) = text.next_if(char::is_ascii_digit) {
            found.push(digit);
        }
        found
    };
    let whole = format!("<mn>{first}{}</mn>", digits(text));
    if text.next_if_eq(&'/').is_none() {
        return whole;
    }
    format!("<mfrac>{whole}<mn>{}</mn></mfrac>", digits(text))
}

/// A base with what is lowered and raised behind it.
fn scripted(base: String, text: &mut Text<'_>) -> String {
    let below = lowered(text).map(|index| letters(&index));
    let above = raised(text);
    match (below, above) {
        (Some(below), Some(above)) => format!("<msubsup>{base}{below}{above}</msubsup>"),
        (Some(below), None) => format!("<msub>{base}{below}</msub>"),
        (None, Some(above)) => format!("<msup>{base}{above}</msup>"),
        (None, None) => base,
    }
}

/// `_ij`, `_k(j)`.
fn lowered(text: &mut Text<'_>) -> Option<String> {
    text.next_if_eq(&'_')?;
    let mut index = String::new();
    while let Some(c) = text.next_if(|c| c.is_ascii_lowercase() || "()".contains(*c)) {
        index.push(c);
    }
    Some(index)
}

/// `^ab`, `^-2`, `⁻¹`, `²`.
fn raised(text: &mut Text<'_>) -> Option<String> {
    let (mut sign, mut size) = (false, String::new());
    if text.next_if_eq(&'^').is_some() {
        sign = text.next_if(|c| ['-', '−'].contains(c)).is_some();
        while let Some(c) = text.next_if(|c| c.is_ascii_lowercase() || c.is_ascii_digit()) {
            size.push(c);
        }
    } else {
        const DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        sign = text.next_if_eq(&'⁻').is_some() || sign;
        while let Some(c) = text.next_if(|c| DIGITS.contains(*c)) {
            size.extend(
                DIGITS.chars().zip('0'..='9').filter(|(raised, _)| *raised == c).map(|(_, digit)| digit),
            );
        }
    }
    match (sign, size.as_str()) {
        (false, "") => None,
        (true, size) => Some(format!("<mrow><mo>−</mo><mn>{size}</mn></mrow>")),
        (false, size) if size.bytes().all(|byte| byte.is_ascii_digit()) => Some(format!("<mn>{size}</mn>")),
        (false, size) => Some(letters(size)),
    }
}

/// Each letter a symbol of its own.
fn letters(text: &str) -> String {
    let each = text
        .chars()
        .map(|c| if c.is_alphabetic() { format!("<mi>{c}</mi>") } else { format!("<mo>{c}</mo>") });
    let all: String = each.collect();
    if text.chars().count() == 1 { all } else { format!("<mrow>{all}</mrow>") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_powers_are_set() {
        assert_eq!(
            formula("1/2 u_i Σ_j |r_ij|^-2"),
            "<math><mfrac><mn>1</mn><mn>2</mn></mfrac><msub><mi>u</mi><mi>i</mi></msub>\
             <munder><mo>∑</mo><mi>j</mi></munder>\
             <msup><mrow><mo>|</mo><msub><mi>r</mi><mrow><mi>i</mi><mi>j</mi></mrow></msub><mo>|</mo></mrow>\
             <mrow><mo>−</mo><mn>2</mn></mrow></msup></math>"
        );
        assert_eq!(
            formula("− ∇²u + B̂_i^ab"),
            "<math><mo>−</mo><msup><mo>∇</mo><mn>2</mn></msup><mi>u</mi></math> \
             <math><mo>+</mo><msubsup><mover accent=\"true\"><mi>B</mi><mo>^</mo></mover><mi>i</mi>\
             <mrow><mi>a</mi><mi>b</mi></mrow></msubsup></math>"
        );
    }

    #[test]
    fn indices_end_where_the_next_symbol_starts() {
        assert_eq!(
            formula("∂_aW_ij"),
            "<math><msub><mo>∂</mo><mi>a</mi></msub><msub><mi>W</mi><mrow><mi>i</mi><mi>j</mi></mrow></msub></math>"
        );
        assert!(formula("Σ_k(j) ω_k").starts_with(
            "<math><munder><mo>∑</mo><mrow><mi>k</mi><mo>(</mo><mi>j</mi><mo>)</mo></mrow></munder>"
        ));
        assert!(formula("∇u · B_i⁻¹").ends_with(
            "<mo>·</mo><msubsup><mi>B</mi><mi>i</mi><mrow><mo>−</mo><mn>1</mn></mrow></msubsup></math>"
        ));
    }
}
