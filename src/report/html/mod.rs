//! Reports as pages that a person reads: one file, no network, no script.
//!
//! [`page`] renders one report from its JSON alone, [`index_page`] the list of all. Both are written in the syntax that
//! HTML and XML share.

mod citation;
mod column;
mod evidence;
mod formula;
mod index;
mod math;
mod shell;
mod tables;
mod text;
mod verdicts;
mod write;

pub use index::{IndexEntry, index_page};
pub use write::{Placed, read_report, write_pages};

use super::figure::{Figure, Ladder, drawings, exponents, ladders, overviews};
use super::rich::escaped;
use super::svg::{self, Size};
use crate::record::Report;
use citation::{cited, paper};
use std::fmt::Write as _;
use text::{number, rich};

/// The most bytes of a page.
pub const MOST_BYTES: usize = 2_000_000;

/// How much of the evidence a page shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Detail {
    /// Every fit with its figure, its points and residuals.
    Full,
    /// A small figure of the fit that the verdict is about, and the other fits in words.
    Compact,
    /// Words.
    Least,
}

/// Where a page may point to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Links<'a> {
    /// The index.
    pub index: Option<&'a str>,
    /// The report as JSON.
    pub json: Option<&'a str>,
}

/// The page of a report: with all evidence if that stays within [`MOST_BYTES`], else with less of it.
pub fn page(report: &Report, links: Links<'_>) -> String {
    let ladders = ladders(report);
    let full = render(report, &ladders, links, Detail::Full);
    if full.len() <= MOST_BYTES {
        return full;
    }
    let compact = render(report, &ladders, links, Detail::Compact);
    if compact.len() <= MOST_BYTES { compact } else { render(report, &ladders, links, Detail::Least) }
}

fn render(report: &Report, ladders: &[Ladder], links: Links<'_>, detail: Detail) -> String {
    let provenance = &report.provenance;
    let title = if provenance.title.is_empty() { &provenance.scene } else { &provenance.title };
    let mut body = String::from("<header>");
    if let Some(index) = links.index {
        let _ = write!(body, "<p><a href=\"{}\">All analyses</a></p>", escaped(index));
    }
    let _ = write!(body, "<h1>{}</h1>", rich(title));
    if provenance.quick {
        body.push_str("<p><strong>A first look: shortened ladders, few samples.</strong></p>");
    }
    let mut main = String::new();
    verdicts::verdicts(&mut main, report, ladders, detail);
    figures(&mut main, report, ladders, detail);
    computed(&mut main, report);
    tables::tables(&mut main, report);
    left_out(&mut main, report);
    references(&mut main, report);
    provenance_section(&mut main, report, links);
    contents(&mut body, &main);
    let _ = write!(body, "</header>\n<main>{main}</main>");
    shell::page(title, &body)
}

/// Links to the sections that are there.
fn contents(body: &mut String, main: &str) {
    let sections = [
        ("verdicts", "Verdicts"),
        ("figures", "Figures"),
        ("computed", "What was computed"),
        ("tables", "Tables"),
        ("left-out", "Left out"),
        ("references", "References"),
        ("provenance", "Provenance"),
    ];
    body.push_str("<nav aria-label=\"Contents\"><ul>");
    for (id, name) in sections.iter().filter(|(id, _)| main.contains(&format!("<h2 id=\"{id}\">"))) {
        let _ = write!(body, "<li><a href=\"#{id}\">{name}</a></li>");
    }
    body.push_str("</ul></nav>");
}

fn figure(body: &mut String, figure: &Figure) {
    let _ = write!(
        body,
        "<figure id=\"fig-{}\">{}<figcaption>",
        figure.file_stem(),
        svg::inline(figure, Size::FULL)
    );
    if let Some(number) = &figure.number {
        let _ = write!(body, "<b>Fig. {} of the paper.</b> ", rich(number));
    }
    let _ = write!(body, "{}.", rich(&figure.title));
    for note in &figure.notes {
        let _ = write!(body, " {}", rich(note));
    }
    body.push_str("</figcaption></figure>\n");
}

fn computed(body: &mut String, report: &Report) {
    let shown = drawings(report);
    if shown.is_empty() {
        return;
    }
    body.push_str("<section aria-labelledby=\"computed\"><h2 id=\"computed\">What was computed</h2><div class=\"figures\">\n");
    for drawing in &shown {
        figure(body, drawing);
    }
    body.push_str("</div></section>\n");
}

fn figures(body: &mut String, report: &Report, ladders: &[Ladder], detail: Detail) {
    let shown: Vec<Figure> = exponents(report).into_iter().chain(overviews(report)).collect();
    // Fits that no claim rests on stand here; the others are in the evidence of their claims.
    let own: Vec<&Ladder> = ladders.iter().filter(|ladder| ladder.claims.is_empty()).collect();
    if shown.is_empty() && own.is_empty() {
        return;
    }
    body.push_str(
        "<section aria-labelledby=\"figures\"><h2 id=\"figures\">Figures</h2><div class=\"figures\">\n",
    );
    for one in &shown {
        figure(body, one);
    }
    body.push_str("</div>");
    if !own.is_empty() && detail == Detail::Full {
        let _ = write!(
            body,
            "<details><summary><h3>Further fits</h3> <small>{}</small></summary><div class=\"figures\">",
            own.len()
        );
        for ladder in own {
            figure(body, &ladder.figure);
        }
        body.push_str("</div></details>");
    }
    body.push_str("</section>\n");
}

fn left_out(body: &mut String, report: &Report) {
    if report.left_out.is_empty() {
        return;
    }
    body.push_str("<section aria-labelledby=\"left-out\"><h2 id=\"left-out\">Left out</h2><ul>");
    for item in &report.left_out {
        let saved = item.saved.as_ref().map(|saved| format!(" (saves {})", rich(saved))).unwrap_or_default();
        let _ = write!(body, "<li>{}: {}{saved}</li>", rich(&item.what), rich(&item.why));
    }
    body.push_str("</ul></section>\n");
}

fn references(body: &mut String, report: &Report) {
    let mut keys: Vec<&str> = Vec::new();
    for entry in &report.claims {
        if !keys.contains(&entry.citation.source.as_str()) {
            keys.push(&entry.citation.source);
        }
    }
    body.push_str("<section aria-labelledby=\"references\"><h2 id=\"references\">References</h2><ul>");
    for key in keys {
        match paper(key) {
            Some(paper) => {
                let _ = write!(body, "<li id=\"ref-{}\">{}</li>", escaped(key), cited(paper));
            }
            None => body.push_str("<li>Claims of the scene itself.</li>"),
        }
    }
    body.push_str("</ul></section>\n");
}

fn provenance_section(body: &mut String, report: &Report, links: Links<'_>) {
    let (provenance, cost) = (&report.provenance, report.cost);
    let features =
        if provenance.features.is_empty() { "none".to_owned() } else { provenance.features.join(", ") };
    let rows = [
        ("Scene", format!("<code>{}</code>", escaped(&provenance.scene))),
        ("SHA-256 of the scene", format!("<code>{}</code>", escaped(&provenance.scene_sha256))),
        ("Seed", provenance.seed.to_string()),
        ("Version", format!("remainder {}", escaped(&provenance.version))),
        ("Features", escaped(&features)),
        ("Exact sums", number(cost.exact_sums as f64)),
        ("Samples", number(cost.samples as f64)),
        ("Pairs", number(cost.pairs as f64)),
    ];
    body.push_str(
        "<section aria-labelledby=\"provenance\"><h2 id=\"provenance\">Provenance and cost</h2><dl>",
    );
    for (name, value) in rows {
        let _ = write!(body, "<div><dt>{name}</dt><dd>{value}</dd></div>");
    }
    body.push_str("</dl>");
    if let Some(json) = links.json {
        let _ = write!(
            body,
            "<p>All of this, and every number in full, is in <a href=\"{0}\">{0}</a>.</p>",
            escaped(json)
        );
    }
    body.push_str("</section>");
}
