//! The story of a claim: what is printed where, what is checked, and what reports found.

use super::table::sections;
use crate::claim::{Known, Paper, known, literature};
use crate::names::nearest_few;
use crate::record::{ClaimEntry, Report, RolledVerdict};
use serde::Serialize;
use std::fmt::Write as _;
use thiserror::Error;

/// One claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Story {
    /// For example `fatehi-table-2/sum_dw#disorder`.
    pub id: String,
    /// The statement as the paper makes it.
    pub statement: String,
    /// What is checked, as a formula; nothing for claims that only a report knows.
    pub formula: Option<String>,
    /// Key in `references.bib`, or `scene`.
    pub source: String,
    /// Equation, table, section.
    pub location: String,
    /// The paper; nothing for a scene's own claims.
    pub paper: Option<Paper>,
    /// What each report that judges it found.
    pub evidence: Vec<Evidence>,
}

/// What one report found about a claim.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evidence {
    /// Name of its scene.
    pub scene: String,
    /// Whether it was a first look.
    pub quick: bool,
    /// The verdict over all cases.
    pub rolled: RolledVerdict,
    /// The cases, published, derived and measured side by side.
    pub cases: Vec<ClaimEntry>,
    /// The same as rows of the verdict table.
    #[serde(skip)]
    rows: Vec<super::Row>,
    #[serde(skip)]
    of_exponents: bool,
}

/// No claim of this name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "there is no claim '{name}', neither built in nor in a report{}",
    if nearest.is_empty() {
        "; `remainder list claims` prints those of orders".to_owned()
    } else {
        format!(": did you mean {}?", nearest.join(", "))
    }
)]
pub struct UnknownClaim {
    /// The name given.
    pub name: String,
    /// What may have been meant, the nearest first.
    pub nearest: Vec<String>,
}

/// The stories of the claims that `name` means: one by its id, or all that share the part before the `/`.
///
/// # Errors
/// [`UnknownClaim`] with the nearest known names.
pub fn stories(name: &str, reports: &[Report]) -> Result<Vec<Story>, UnknownClaim> {
    let known = known();
    let mut ids: Vec<&str> = known.iter().map(|known| known.id.as_str()).collect();
    for entry in reports.iter().flat_map(|report| &report.verdicts) {
        if !ids.contains(&entry.id.as_str()) {
            ids.push(&entry.id);
        }
    }
    fn group(id: &str) -> &str {
        id.split('/').next().unwrap_or_default()
    }
    let exact = ids.iter().filter(|id| **id == name);
    let chosen: Vec<&str> = match exact.copied().collect::<Vec<_>>() {
        found if !found.is_empty() => found,
        _ => ids.iter().copied().filter(|id| group(id) == name).collect(),
    };
    if chosen.is_empty() {
        let mut names: Vec<&str> = ids.iter().flat_map(|id| [*id, group(id)]).collect();
        names.sort_unstable();
        names.dedup();
        return Err(UnknownClaim { name: name.to_owned(), nearest: nearest_few(name, &names, 3) });
    }
    // A test reads the literature; a story without its paper is still one.
    let papers = literature().unwrap_or_default();
    Ok(chosen.into_iter().filter_map(|id| story(id, &known, &papers, reports)).collect())
}

fn story(id: &str, known: &[Known], papers: &[Paper], reports: &[Report]) -> Option<Story> {
    let evidence: Vec<Evidence> = reports.iter().filter_map(|report| evidence(id, report)).collect();
    let entry = evidence.iter().find_map(|evidence| evidence.cases.first());
    let built_in = known.iter().find(|known| known.id == id);
    let (statement, source, location) = match (built_in, entry) {
        (Some(known), _) => (&known.text, &known.source, &known.location),
        (None, Some(entry)) => (&entry.statement, &entry.citation.source, &entry.citation.location),
        (None, None) => return None,
    };
    Some(Story {
        id: id.to_owned(),
        statement: statement.clone(),
        formula: built_in.map(|known| known.formula.clone()),
        source: source.clone(),
        location: location.clone(),
        paper: papers.iter().find(|paper| paper.key == *source).cloned(),
        evidence,
    })
}

fn evidence(id: &str, report: &Report) -> Option<Evidence> {
    let rolled = report.verdicts.iter().find(|rolled| rolled.id == id)?;
    let section = sections(report).into_iter().find(|section| section.id == id)?;
    Some(Evidence {
        scene: report.provenance.scene.clone(),
        quick: report.provenance.quick,
        rolled: rolled.clone(),
        cases: report.claims.iter().filter(|entry| entry.id == id).cloned().collect(),
        of_exponents: section.of_exponents,
        rows: section.rows,
    })
}

impl Story {
    /// For the terminal, `most` cases of each report at most.
    pub fn to_text(&self, most: usize) -> String {
        let mut text = format!("{}\n  {}\n", self.id, self.statement);
        if let Some(formula) = &self.formula {
            let _ = writeln!(text, "\nChecked\n  {formula}");
        }
        text.push_str("\nPrinted in\n");
        let _ = match &self.paper {
            Some(paper) => {
                let doi = paper.doi.as_ref().map(|doi| format!(", doi:{doi}")).unwrap_or_default();
                let Paper { title, published_in, key, .. } = paper;
                writeln!(
                    text,
                    "  {}, {}\n  {title}, {published_in}{doi} [{key}]",
                    paper.short(),
                    self.location
                )
            }
            None => writeln!(text, "  {}, {}", self.source, self.location),
        };
        if self.evidence.is_empty() {
            text.push_str("\nNo report judges it yet: name it under [claims] use of a scene, or run the analysis of its paper.\n");
        }
        for evidence in &self.evidence {
            evidence.text(&mut text, most);
        }
        text
    }
}

impl Evidence {
    fn text(&self, text: &mut String, most: usize) {
        let expected = match self.rolled.expected {
            Some(expected) if expected == self.rolled.verdict => ", as its scene expects".into(),
            Some(expected) => format!(", where its scene expects {expected}"),
            None => String::new(),
        };
        let quick = if self.quick { " (a first look)" } else { "" };
        let _ = writeln!(
            text,
            "\nFound by {}{quick}: {}{expected}\n  {}",
            self.scene, self.rolled.verdict, self.rolled.why
        );
        for row in self.rows.iter().take(most) {
            let of = if self.of_exponents { " (exponents of d̃, Δ/h)" } else { "" };
            let measured = [row.displacement.as_str(), row.dx_over_h.as_str()];
            let measured: Vec<&str> = measured.into_iter().filter(|part| !part.is_empty()).collect();
            let _ = writeln!(
                text,
                "\n  {} {}: {}\n    published {}, derived {}, measured {}{of}\n    {}",
                row.dimension,
                row.case,
                row.verdict,
                row.published,
                row.derived,
                measured.join(", "),
                row.why
            );
        }
        if self.rows.len() > most {
            let _ = writeln!(text, "\n  and {} cases more: add --all", self.rows.len() - most);
        }
    }
}
