//! The verdict table on the terminal.

use crate::report::{Report, Section, Verdict, sections};
use std::fmt::Write as _;
use std::io::IsTerminal as _;

/// The report as text for standard output.
pub(super) fn table(report: &Report) -> String {
    let coloured = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let sections = sections(report);
    let mut text = String::new();
    if !report.provenance.title.is_empty() {
        let _ = writeln!(text, "{}\n", report.provenance.title);
    }
    let rows = || sections.iter().flat_map(|section| &section.rows);
    let width = |measure: &dyn Fn(&crate::report::Row) -> usize, least: usize| {
        rows().map(measure).max().unwrap_or(0).max(least)
    };
    let widths = [
        width(&|row| row.case.chars().count(), 4),
        width(&|row| row.published.chars().count(), 9),
        width(&|row| row.derived.chars().count(), 7),
        width(&|row| row.displacement.chars().count(), 11),
        width(&|row| row.dx_over_h.chars().count(), 13),
    ];
    for section in &sections {
        section_text(&mut text, section, widths, coloured);
    }
    let mut counts = Vec::new();
    for verdict in
        [Verdict::Confirmed, Verdict::Bound, Verdict::Conditional, Verdict::Refuted, Verdict::Inconclusive]
    {
        let count = sections.iter().filter(|section| section.verdict == verdict).count();
        if count > 0 {
            counts.push(format!("{count} {verdict}"));
        }
    }
    let _ = writeln!(text, "{} claims: {}.", sections.len(), counts.join(", "));
    text
}

fn section_text(text: &mut String, section: &Section, widths: [usize; 5], coloured: bool) {
    let expected = section.expected.filter(|e| *e != section.verdict);
    let expected = expected.map(|e| format!(", expected {e}")).unwrap_or_default();
    let _ = writeln!(text, "{}  ({})", section.statement, section.location);
    let _ = writeln!(text, "  {}{expected}: {}", paint(section.verdict, coloured, 0), section.why);
    let [case, published, derived, displacement, dx_over_h] = widths;
    let disordered = section.rows.iter().any(|row| !row.displacement.is_empty());
    let titles = match (section.of_exponents, disordered) {
        (true, true) => "d̃, Δ/h",
        (true, false) => "Δ/h",
        (false, _) => "published",
    };
    let _ = writeln!(
        text,
        "      {:case$}  {:published$}  {:derived$}  {:displacement$}  {:dx_over_h$}",
        "",
        titles,
        "derived",
        if disordered { "measured d̃ " } else { "" },
        if section.of_exponents { "measured Δ/h" } else { "measured" }
    );
    for row in &section.rows {
        let _ = writeln!(
            text,
            "  {} {:case$}  {:published$}  {:derived$}  {:displacement$}  {:dx_over_h$}  {}",
            row.dimension,
            row.case,
            row.published,
            row.derived,
            row.displacement,
            row.dx_over_h,
            paint(row.verdict, coloured, 0)
        );
    }
    text.push('\n');
}

fn paint(verdict: Verdict, coloured: bool, width: usize) -> String {
    let word = format!("{verdict:width$}");
    if !coloured {
        return word;
    }
    let code = match verdict {
        Verdict::Confirmed => 32,
        Verdict::Bound => 36,
        Verdict::Conditional => 33,
        Verdict::Refuted => 31,
        Verdict::Inconclusive => 35,
    };
    format!("\x1b[{code}m{word}\x1b[0m")
}
