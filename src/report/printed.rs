//! Printed expansions beside derived ones, coefficient by coefficient, with the evidence of numbers where they differ.

use crate::claim::{PrintedCoefficient, printed_coefficients};
use crate::derived::{Arrangement, DeriveError, Expansion, Format};
use crate::exact::{Number, Rational, rational_to_f64};
use crate::language::{Coefficient, Field, LanguageError, Operator, operators};
use serde::Serialize;
use std::fmt::Write as _;
use thiserror::Error;

/// One printed coefficient judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PrintedVerdict {
    /// Where it is printed.
    pub location: String,
    /// The operator.
    pub operator: String,
    /// m.
    pub order: u8,
    /// As printed, in the language.
    pub printed: String,
    /// As derived.
    pub derived: Vec<String>,
    /// What is left of derived minus printed; nothing if they are the same for every kernel and arrangement.
    pub difference: Vec<String>,
    /// On particles with rational places in the plane: the norms of derived, printed and their difference.
    pub evidence: [f64; 3],
}

/// Why the comparison could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PrintedError {
    /// A text is wrong.
    #[error(transparent)]
    Language(#[from] LanguageError),
    /// An expansion.
    #[error(transparent)]
    Derive(#[from] DeriveError),
}

/// All printed coefficients against the derived ones.
///
/// # Errors
/// [`PrintedError`].
pub fn printed_verdicts() -> Result<Vec<PrintedVerdict>, PrintedError> {
    printed_coefficients().iter().map(verdict).collect()
}

fn verdict(printed: &PrintedCoefficient) -> Result<PrintedVerdict, PrintedError> {
    let order = usize::from(printed.order);
    let coefficient = Coefficient::new(printed.operator, printed.order)?;
    // What an equation of its own approximates is nothing but itself.
    let target = operators::by_id(printed.operator).ok().map(|entry| entry.target);
    let expansion = Expansion::of(coefficient.operator().clone(), target, order)?;
    let as_printed = Expansion::given(
        Operator::parse_coefficient(printed.text)?,
        Field::Scalar,
        order,
        expansion.operator.rank(),
    )?;
    let difference = expansion.minus(&as_printed, order)?;
    let ground = Arrangement::new(2, 0);
    let norm = |expansion: &Expansion| -> Result<f64, DeriveError> {
        let values = expansion.error_at::<Rational>(&ground, 0, order)?;
        let squares = values.iter().flatten().flatten().map(|value| rational_to_f64(value).powi(2));
        Ok(squares.sum::<f64>().sqrt())
    };
    let terms = |expansion: &Expansion| {
        let printed = expansion.printed(Format::Text);
        printed.into_iter().filter(|terms| terms.order == order).flat_map(|terms| terms.terms).collect()
    };
    let exactly_zero = |expansion: &Expansion| -> Result<bool, DeriveError> {
        let values = expansion.error_at::<Rational>(&ground, 0, order)?;
        Ok(values.iter().flatten().flatten().all(Number::is_nought))
    };
    debug_assert_eq!(difference.vanishes(order), exactly_zero(&difference).unwrap_or(false));
    Ok(PrintedVerdict {
        location: printed.location.into(),
        operator: coefficient.id().into(),
        order: printed.order,
        printed: printed.text.into(),
        derived: terms(&expansion),
        difference: terms(&difference),
        evidence: [norm(&expansion)?, norm(&as_printed)?, norm(&difference)?],
    })
}

/// The comparison as Markdown.
pub fn printed_markdown(verdicts: &[PrintedVerdict]) -> String {
    let mut text = String::from(
        "# Printed expansions beside derived ones\n\n\
         Each row is what an equation of Fatehi & Manzari (2011) multiplies ∇^m u by in a truncation error, and what the \
         expansion of the operator gives. *The same* means for every kernel, weight and arrangement: the difference vanishes \
         identically. Where it does not, the norms of derived, printed and difference are given on one arrangement of \
         particles with rational places in the plane (and rationals in place of W′/r and its derivative), so that nothing \
         is rounded away.\n\n\
         | equation | operator | m | verdict | norms: derived, printed, difference |\n|---|---|---|---|---|\n",
    );
    for verdict in verdicts {
        let same = verdict.difference.is_empty();
        let [derived, printed, difference] = verdict.evidence;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} |",
            verdict.location,
            verdict.operator.replace('|', "\\|"),
            verdict.order,
            if same { "the same" } else { "**differs**" },
            if same { "–".into() } else { format!("{derived:.4e}, {printed:.4e}, {difference:.4e}") },
        );
    }
    for verdict in verdicts.iter().filter(|verdict| !verdict.difference.is_empty()) {
        let _ = writeln!(
            text,
            "\n## {}, ∇^{} u of {}\n\nPrinted, in the operator language:\n\n```text\n{}\n```\n\nDerived:\n\n```text\n{}\n```\n\n\
             Derived minus printed:\n\n```text\n{}\n```",
            verdict.location,
            verdict.order,
            verdict.operator,
            verdict.printed,
            verdict.derived.join("\n"),
            verdict.difference.join("\n"),
        );
    }
    text
}
