//! What a report's claims state, as displayed formulas, and the expansions of the operators that they are about.

use super::LatexError;
use super::text::{symbol, tex};
use crate::claim::{Statement, catalogue};
use crate::language::operators;
use crate::record::Report;
use crate::report::expansion_report;
use crate::report::rich::{Level, pieces};
use std::fmt::Write as _;

/// The highest order that is printed of an expansion.
const ORDER: usize = 3;

/// Whether there is any: a claim of the catalogue, or an operator.
pub(super) fn any(report: &Report) -> bool {
    let known = catalogue();
    let stated = |claim: &crate::claim::Claim| !matches!(claim.statement, Statement::Convergence { .. });
    known.iter().any(|claim| stated(claim) && report.verdicts.iter().any(|rolled| rolled.id == claim.id))
        || operators_of(report).iter().any(|id| operators::by_id(id).is_ok())
}

/// The operators that the claims are about, each once.
fn operators_of(report: &Report) -> Vec<&str> {
    let mut named: Vec<&str> = Vec::new();
    for entry in &report.claims {
        let operator = entry.case.more.get("operator").and_then(|value| value.as_str());
        named.extend(operator.filter(|id| !named.contains(id)));
    }
    named
}

/// Nothing if the report has neither claims of orders nor operators.
pub(super) fn equations(report: &Report) -> Result<String, LatexError> {
    let mut text = String::new();
    let known = catalogue();
    let claims: Vec<_> = report
        .verdicts
        .iter()
        .filter_map(|rolled| known.iter().find(|claim| claim.id == rolled.id))
        .collect();
    let rows: Vec<String> = claims
        .iter()
        .filter_map(|claim| {
            let subject = &claim.subject;
            // An operator as text is no formula; its expansion follows.
            let place = tex(&claim.location);
            let (left, right) = match &claim.statement {
                Statement::PowerLaw { quantity, powers } => (quantity.formula(subject), powers.to_string()),
                Statement::Zero => (subject.formula(), "0".into()),
                Statement::Convergence { .. } => return None,
            };
            Some(format!("{} &= {} && \\text{{{place}}}", math(&left), math(&right)))
        })
        .collect();
    if !rows.is_empty() {
        let _ = writeln!(
            text,
            "% What is claimed.\n\\begin{{align*}}\n{}\n\\end{{align*}}",
            rows.join(" \\\\\n")
        );
    }
    for entry in operators_of(report).iter().filter_map(|id| operators::by_id(id).ok()) {
        // A catalogued operator parses: a test of the catalogue holds that.
        let Ok(operator) = entry.operator() else { continue };
        let expansion = expansion_report(Some(&entry), operator, ORDER, &[])?;
        let _ =
            writeln!(text, "\n\\noindent Truncation error of {}:\n{}", tex(entry.id), expansion.to_latex());
    }
    Ok(text)
}

/// A formula of the record in LaTeX's mathematics.
pub(super) fn math(text: &str) -> String {
    let pieces = pieces(text).into_iter().map(|(level, piece)| {
        let set = symbols(&piece);
        match level {
            Level::Line => set,
            Level::Superscript => format!("^{{{set}}}"),
            Level::Subscript => format!("_{{{set}}}"),
        }
    });
    pieces.collect()
}

fn symbols(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let mut out = String::new();
    let mut at = 0;
    while let Some(&c) = characters.get(at) {
        let word = characters[at..].iter().take_while(|c| c.is_ascii_lowercase()).count();
        let accent = match characters.get(at + 1) {
            Some('\u{303}') => Some("tilde"),
            Some('\u{302}') => Some("hat"),
            _ => None,
        };
        at += 1;
        if let Some(accent) = accent {
            let _ = write!(out, "\\{accent}{{{c}}}");
            at += 1;
        } else if word > 1 && !repeated(&characters[at - 1..at - 1 + word]) {
            let name: String = characters[at - 1..at - 1 + word].iter().collect();
            let _ = write!(out, "\\text{{{name}}}");
            at += word - 1;
        } else if let Some(symbol) = symbol(c) {
            let _ = write!(out, "{symbol} ");
        } else {
            match c {
                ' ' => out.push_str("\\,"),
                '{' | '}' | '_' | '&' | '%' | '#' | '$' => {
                    let _ = write!(out, "\\{c}");
                }
                '^' => out.push_str("\\hat{}"),
                c => out.push(c),
            }
        }
    }
    out
}

/// `rrr` is a product, not a word.
fn repeated(word: &[char]) -> bool {
    word.windows(2).all(|pair| pair[0] == pair[1])
}

#[cfg(test)]
mod tests {
    use super::math;

    #[test]
    fn formulas_are_set_as_mathematics() {
        assert_eq!(
            math("rms |Σωrr∇W − reg|"),
            "\\text{rms}\\,|\\Sigma \\omega rr\\nabla W\\,- \\,\\text{reg}|"
        );
        assert_eq!(math("O(d\u{303} h^{-2})"), "O(\\tilde{d}\\,h^{- 2})");
    }
}
