//! The page over all analyses.

use super::shell;
use super::text::rich;
use super::verdicts::badge;
use crate::record::{Report, Verdict};
use crate::report::rich::escaped;
use std::fmt::Write as _;

/// One analysis of the index.
#[derive(Debug, Clone, PartialEq)]
pub struct IndexEntry {
    /// Where its page is, seen from the index.
    pub href: String,
    name: String,
    title: String,
    cases: usize,
    claims: usize,
    verdicts: Vec<(Verdict, usize)>,
}

impl IndexEntry {
    /// The entry of a report whose page is at `href`.
    pub fn of(report: &Report, href: impl Into<String>) -> Self {
        let all = [
            Verdict::Confirmed,
            Verdict::Bound,
            Verdict::Conditional,
            Verdict::Refuted,
            Verdict::Inconclusive,
        ];
        let count =
            |verdict: Verdict| report.verdicts.iter().filter(|rolled| rolled.verdict == verdict).count();
        Self {
            href: href.into(),
            name: report.provenance.scene.clone(),
            title: report.provenance.title.clone(),
            cases: report.claims.len(),
            claims: report.verdicts.len(),
            verdicts: all
                .into_iter()
                .map(|verdict| (verdict, count(verdict)))
                .filter(|(_, n)| *n > 0)
                .collect(),
        }
    }
}

/// The index of these analyses.
pub fn index_page(entries: &[IndexEntry]) -> String {
    let mut body = String::from(
        "<header><h1>Truncation errors: published, derived, measured</h1>\
         <p>One page per analysis. Each compares what is printed with what algebra derives and what particles show.</p></header>\
         <main><h2 id=\"analyses\">Analyses</h2><ul class=\"index\">\n",
    );
    for entry in entries {
        let _ = write!(
            body,
            "<li><a href=\"{}\"><b>{}</b></a> <code>{}</code><p>{} claims in {} cases:</p><p class=\"counts\">",
            escaped(&entry.href),
            rich(if entry.title.is_empty() { &entry.name } else { &entry.title }),
            escaped(&entry.name),
            entry.claims,
            entry.cases
        );
        for (verdict, count) in &entry.verdicts {
            let _ = write!(body, "<span>{count} {}</span> ", badge(*verdict));
        }
        body.push_str("</p></li>\n");
    }
    body.push_str("</ul></main>");
    shell::page("Truncation errors: published, derived, measured", &body)
}
