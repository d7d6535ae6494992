//! The catalogue of operators, written in the language: one file per paper, one entry per operator.

mod basa_2009;
mod chaussonnet_2015;
mod fatehi_manzari_2011;

use super::target::Target;
use super::tree::{Field, Operator};
use crate::names::nearest;
use thiserror::Error;

/// A built-in operator.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The id: `F4`.
    pub id: &'static str,
    /// The text, in the language.
    pub text: &'static str,
    /// The field it acts on.
    pub field: Field,
    /// What it approximates.
    pub target: Target,
    /// Key in `references.bib`.
    pub source: &'static str,
    /// The equation.
    pub location: &'static str,
    /// Where the entry differs from the print, and why; empty if it does not.
    pub remark: &'static str,
}

impl Entry {
    /// The checked tree.
    ///
    /// # Errors
    /// [`super::LanguageError`]; a test shows that no entry of the catalogue has one.
    pub fn operator(&self) -> Result<Operator, super::LanguageError> {
        Operator::parse(self.text)
    }
}

/// The operator of this id, or the one written: a word is an id, anything else is text in the language.
///
/// # Errors
/// What is wrong with it.
pub fn named_or_written(text: &str) -> Result<Operator, String> {
    if text.chars().all(|c| c.is_alphanumeric() || "-+_".contains(c)) {
        return by_id(text).map_err(|e| e.to_string())?.operator().map_err(|e| e.to_string());
    }
    Operator::parse(text).map_err(|error| {
        let shown = text.get(error.span.clone()).unwrap_or_default();
        format!("{error} (at byte {}: '{shown}')", error.span.start + 1)
    })
}

/// There is no operator of this name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no operator '{name}'{}", nearest.as_ref().map(|n| format!(": did you mean '{n}'?")).unwrap_or_default())]
pub struct UnknownOperator {
    /// As given.
    pub name: String,
    /// The nearest known id.
    pub nearest: Option<String>,
}

/// All built-in operators, in the order of their papers.
pub fn catalogue() -> Vec<Entry> {
    [fatehi_manzari_2011::entries(), chaussonnet_2015::entries(), basa_2009::entries()].concat()
}

/// The operator of this id.
///
/// # Errors
/// [`UnknownOperator`] with the nearest known id.
pub fn by_id(id: &str) -> Result<Entry, UnknownOperator> {
    let known = catalogue();
    if let Some(entry) = known.iter().find(|entry| entry.id == id) {
        return Ok(entry.clone());
    }
    let names: Vec<&str> = known.iter().map(|entry| entry.id).collect();
    Err(UnknownOperator { name: id.to_owned(), nearest: nearest(id, &names) })
}
