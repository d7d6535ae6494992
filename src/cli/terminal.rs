//! The verdict table on the terminal, and text that fits its width.

use crate::report::{Report, Section, Verdict, sections};
use std::fmt::Write as _;
use std::io::IsTerminal as _;
use textwrap::core::display_width;
use textwrap::{Options, WrapAlgorithm, wrap};

/// Columns narrower than this are not worth reading; below it lines run over instead.
const NARROWEST: usize = 9;

/// Blanks between columns.
const GAP: usize = 2;

/// The width to fit into: that of `COLUMNS`, or of the terminal. In a pipe there is none: lines stay whole.
fn width() -> Option<usize> {
    let asked = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let found = || terminal_size::terminal_size_of(std::io::stdout()).map(|(width, _)| usize::from(width.0));
    asked.or_else(found).filter(|width| *width >= 20)
}

/// Breaks lines that are too long; what follows is indented by two more.
pub(super) fn fitted(text: &str) -> String {
    let Some(width) = width() else { return text.to_owned() };
    let mut fitted = String::with_capacity(text.len());
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        let hanging = " ".repeat(indent + 2);
        let options = Options::new(width).subsequent_indent(&hanging).wrap_algorithm(WrapAlgorithm::FirstFit);
        for part in wrap(line, options) {
            let _ = writeln!(fitted, "{}", part.trim_end());
        }
    }
    fitted
}

/// The report as text for standard output.
pub(super) fn table(report: &Report) -> String {
    let coloured = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let sections = sections(report);
    let mut text = String::new();
    if !report.provenance.title.is_empty() {
        text += &fitted(&format!("{}\n\n", report.provenance.title));
    }
    let widths = widths(&sections, width());
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
    text += &fitted(&format!("{} claims: {}.\n", sections.len(), counts.join(", ")));
    text
}

/// Widths of all columns but the verdict, the same for all sections: as wide as what they hold, or, where that does not
/// fit, with the widest narrowed first.
fn widths(sections: &[Section], most: Option<usize>) -> [usize; 5] {
    let rows = || sections.iter().flat_map(|section| &section.rows);
    let width = |measure: &dyn Fn(&crate::report::Row) -> usize, least: usize| {
        rows().map(measure).max().unwrap_or(0).max(least)
    };
    let mut widths = [
        width(&|row| display_width(&row.dimension) + 1 + display_width(&row.case), 4),
        width(&|row| display_width(&row.published), 9),
        width(&|row| display_width(&row.derived), 7),
        width(&|row| display_width(&row.displacement), 11),
        width(&|row| display_width(&row.dx_over_h), 13),
    ];
    let verdicts = rows().map(|row| row.verdict.to_string().len()).max().unwrap_or(0);
    let taken = GAP * (widths.len() + 1) + verdicts;
    while let Some(most) = most.filter(|most| widths.iter().sum::<usize>() + taken > *most) {
        let widest = (0..widths.len()).max_by_key(|column| widths[*column]).unwrap_or(0);
        if widths[widest] <= NARROWEST {
            break;
        }
        // All at once what this column alone has too much, but not below the next widest.
        let next = (0..widths.len()).filter(|other| *other != widest).map(|other| widths[other]).max();
        let surplus = widths.iter().sum::<usize>() + taken - most;
        let down = widths[widest].saturating_sub(surplus).max(next.unwrap_or(0)).max(NARROWEST);
        widths[widest] = down.min(widths[widest] - 1);
    }
    widths
}

fn section_text(text: &mut String, section: &Section, widths: [usize; 5], coloured: bool) {
    let expected = section.expected.filter(|e| *e != section.verdict);
    let expected = expected.map(|e| format!(", expected {e}")).unwrap_or_default();
    *text += &fitted(&format!("{}  ({})\n", section.statement, section.location));
    let judged = fitted(&format!("  {}{expected}: {}\n", section.verdict, section.why));
    // Painted after breaking: colours have no width.
    *text += &judged.replacen(&section.verdict.to_string(), &paint(section.verdict, coloured), 1);
    let disordered = section.rows.iter().any(|row| !row.displacement.is_empty());
    let titles = match (section.of_exponents, disordered) {
        (true, true) => "d̃, Δ/h",
        (true, false) => "Δ/h",
        (false, _) => "published",
    };
    let heads = [
        "",
        titles,
        "derived",
        if disordered { "measured d̃" } else { "" },
        if section.of_exponents { "measured Δ/h" } else { "measured" },
    ];
    line(text, heads.map(str::to_owned), widths, "");
    for row in &section.rows {
        let case = format!("{} {}", row.dimension, row.case);
        let cells = [
            case,
            row.published.clone(),
            row.derived.clone(),
            row.displacement.clone(),
            row.dx_over_h.clone(),
        ];
        line(text, cells, widths, &paint(row.verdict, coloured));
    }
    text.push('\n');
}

/// One row, over as many lines as its longest cell takes.
fn line(text: &mut String, cells: [String; 5], widths: [usize; 5], verdict: &str) {
    let broken: Vec<Vec<String>> = cells
        .iter()
        .zip(widths)
        .map(|(cell, width)| {
            let options = Options::new(width.max(1)).wrap_algorithm(WrapAlgorithm::FirstFit);
            wrap(cell, options).into_iter().map(|part| part.into_owned()).collect()
        })
        .collect();
    let height = broken.iter().map(Vec::len).max().unwrap_or(1).max(1);
    for at in 0..height {
        let mut out = String::new();
        for (cell, width) in broken.iter().zip(widths) {
            let part = cell.get(at).map_or("", String::as_str);
            out += &" ".repeat(GAP);
            out += part;
            out += &" ".repeat(width.saturating_sub(display_width(part)));
        }
        if at == 0 && !verdict.is_empty() {
            out += &" ".repeat(GAP);
            out += verdict;
        }
        let _ = writeln!(text, "{}", out.trim_end());
    }
}

fn paint(verdict: Verdict, coloured: bool) -> String {
    let word = verdict.to_string();
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
