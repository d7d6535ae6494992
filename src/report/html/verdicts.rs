//! The verdict table: a row per claim that opens to its cases, a row per case that opens to its evidence.

use super::Detail;
use super::citation::paper;
use super::column::{Which, cell, summary};
use super::evidence::{Fitted, evidence};
use super::formula::formula;
use super::math::order;
use super::text::rich;
use crate::record::{ClaimEntry, Report, Verdict};
use crate::report::figure::Ladder;
use crate::report::rich::escaped;
use crate::report::table::{Row, Section, sections};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The verdict as colour and word.
pub(super) fn badge(verdict: Verdict) -> String {
    format!("<span class=\"v {verdict}\">{verdict}</span>")
}

/// The section of a page.
pub(super) fn verdicts(page: &mut String, report: &Report, ladders: &[Ladder], detail: Detail) {
    let fits: BTreeMap<&str, Fitted<'_>> = ladders
        .iter()
        .filter_map(|ladder| {
            let fit = report.fits.get(ladder.fit)?;
            Some((fit.id.as_str(), (fit, ladder)))
        })
        .collect();
    page.push_str(HEAD);
    if detail == Detail::Compact {
        page.push_str(KEY);
    }
    page.push_str(COLUMNS);
    for section in sections(report) {
        let entries: Vec<&ClaimEntry> = report.claims.iter().filter(|entry| entry.id == section.id).collect();
        claim(page, &section, &entries, &fits, detail);
    }
    page.push_str("</div></section>");
}

const HEAD: &str = "<section aria-labelledby=\"verdicts\"><h2 id=\"verdicts\">Verdicts</h2>\
    <p>Each row opens to its cases, each case to its evidence. <i>Confirmed</i>: equal within the margin, and sharp. \
    <i>Bound</i>: true as an upper bound, not sharp. <i>Refuted</i>: it does not hold. <i>Conditional</i>: it holds for some \
    cases and not for others. <i>Inconclusive</i>: the evidence does not decide. Intervals cover 95 %.</p>";

const KEY: &str = "<p>In the small figures: points kept by the fit, outlines left out, solid line fitted, dashed line the \
    published slope, triangle the derived slope, dotted line the largest of the samples.</p>";

const COLUMNS: &str = "<div class=\"claims\"><div class=\"row head\" aria-hidden=\"true\"><span>verdict</span><span>claim</span>\
    <span>published</span><span>derived</span><span>measured</span></div>";

/// What a row says in the three columns; their names are shown where there is no head above them.
fn columns(text: impl Fn(Which) -> String) -> String {
    let one = |which: Which| format!("<span><i>{} </i><span>{}</span></span>", which.name(), text(which));
    Which::ALL.into_iter().map(one).collect()
}

fn claim(
    page: &mut String,
    section: &Section,
    entries: &[&ClaimEntry],
    fits: &BTreeMap<&str, Fitted<'_>>,
    detail: Detail,
) {
    let expected = section.expected.filter(|expected| *expected != section.verdict);
    let _ = write!(
        page,
        "<details class=\"claim\" id=\"{}\"><summary class=\"row\"><span>{}{}</span><span><b>{}</b> <small>{}</small></span>{}</summary>",
        escaped(&section.id),
        badge(section.verdict),
        expected.map(|expected| format!(" <small>expected {expected}</small>")).unwrap_or_default(),
        rich(&section.statement),
        rich(&section.location),
        columns(|which| summary(entries, which))
    );
    let _ = write!(page, "<div class=\"body\"><p>{}</p>", rich(&section.why));
    let source = entries.first().map(|entry| entry.citation.source.as_str()).unwrap_or_default();
    let reference = paper(source).map(|paper| escaped(&paper.short()));
    let _ = write!(
        page,
        "<p class=\"small\">Claim <code>{}</code>, {}, {}.</p>",
        escaped(&section.id),
        match &reference {
            Some(short) => format!("<a href=\"#ref-{source}\">{short}</a>"),
            None => "of the scene".into(),
        },
        rich(&section.location)
    );
    let orders: Vec<_> =
        entries.iter().filter_map(|entry| Which::Published.of(entry)?.exponents.as_ref()).collect();
    if let [first, rest @ ..] = orders.as_slice() {
        // In terms of β the printed order differs from kernel to kernel: the cases have it then.
        if rest.iter().all(|other| other == first) {
            let _ = write!(page, "<p>Published: {}</p>", order(first));
        }
    }
    if let Some([operator, expansion, conserves]) = &section.operator {
        let _ = write!(
            page,
            "<p>Expansion of {}, which conserves {}:</p><div class=\"scroll\" tabindex=\"0\" role=\"group\" \
             aria-label=\"Expansion\">{}</div>",
            rich(operator),
            rich(conserves),
            formula(expansion)
        );
    }
    page.push_str("<div class=\"cases\">");
    for (row, entry) in section.rows.iter().zip(entries) {
        case(page, row, entry, fits, detail);
    }
    page.push_str("</div></div></details>\n");
}

fn case(page: &mut String, row: &Row, entry: &ClaimEntry, fits: &BTreeMap<&str, Fitted<'_>>, detail: Detail) {
    let _ = write!(
        page,
        "<details class=\"case\"><summary class=\"row\"><span>{}</span><span>{} {}</span>{}</summary>",
        badge(row.verdict),
        row.dimension,
        rich(&row.case),
        columns(|which| cell(entry, which))
    );
    let own: Vec<Fitted<'_>> = Which::Measured
        .of(entry)
        .iter()
        .flat_map(|column| &column.fits)
        .filter_map(|id| fits.get(id.as_str()).copied())
        .collect();
    evidence(page, entry, &own, detail);
    page.push_str("</details>\n");
}
