//! LaTeX: tables, figures and equations of all committed reports compile in one document.

use crate::folder::{Folder, PROGRAM};
use crate::{committed, list, report, repository};
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use std::sync::OnceLock;

/// All committed reports, written once.
fn written() -> &'static Folder {
    static FOLDER: OnceLock<Folder> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = Folder::new();
        let reports = repository("reports");
        // Without a limit of time: unoptimised, expanding every operator takes minutes.
        let ran = Command::new(PROGRAM)
            .arg("report")
            .arg(reports)
            .args(["--latex", "tex"])
            .current_dir(folder.path("."))
            .output()
            .expect("the program starts");
        assert!(ran.status.success() && ran.stdout.is_empty(), "{}", String::from_utf8_lossy(&ran.stderr));
        folder
    })
}

/// Whether a program is there; if not, says so.
fn found(program: &str) -> bool {
    let found = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !found {
        eprintln!("skipped: {program} is not installed (Debian: .ci/texlive names the packages)");
    }
    found
}

fn pdflatex(folder: &Folder, arguments: &[&str]) {
    let output = Command::new("pdflatex")
        .args(["-interaction=nonstopmode", "-halt-on-error"])
        .args(arguments)
        .current_dir(folder.path("tex"))
        .output()
        .expect("pdflatex starts");
    let log = String::from_utf8_lossy(&output.stdout).into_owned();
    let end: Vec<&str> = log.lines().rev().take(40).collect();
    let end: Vec<&str> = end.into_iter().rev().collect();
    assert!(output.status.success(), "{arguments:?}:\n{}", end.join("\n"));
}

/// Figures of one report that are compiled, evenly out of all: its ladders are made alike, and each takes a second.
const FIGURES: usize = 3;

/// Rows of one table that are compiled: setting a column by its decimal points takes siunitx some 20 ms a row.
const ROWS: usize = 100;

/// A table that goes over pages, to its first rows.
fn shortened(table: &str) -> String {
    let Some((head, body)) = table.split_once("\\endlastfoot\n") else { return table.to_owned() };
    let Some((rows, end)) = body.split_once("\\end{longtable}") else { return table.to_owned() };
    let cut = rows.match_indices("\\\\\n").nth(ROWS).map_or(rows.len(), |(at, row)| at + row.len());
    format!("{head}\\endlastfoot\n{}\\end{{longtable}}{end}", &rows[..cut])
}

#[test]
fn one_document_takes_in_all_reports() {
    if !found("pdflatex") || !found("bibtex") {
        return;
    }
    let folder = written();
    let all = folder.text("tex/all.tex");
    let report_of = |line: &str| {
        line.strip_prefix("\\remainderfigure{").and_then(|rest| Some(rest.split_once('/')?.0.to_owned()))
    };
    let mut figures = BTreeMap::<String, usize>::new();
    all.lines().filter_map(report_of).for_each(|report| *figures.entry(report).or_default() += 1);
    assert!(figures.len() == committed().len(), "{figures:?}");
    let (mut kept, mut seen) = (String::new(), BTreeMap::<String, usize>::new());
    for line in all.lines() {
        if let Some(report) = report_of(line) {
            let step = figures[&report].div_ceil(FIGURES);
            let place = seen.entry(report).or_default();
            *place += 1;
            if *place % step != 0 {
                continue;
            }
        }
        kept += line;
        kept.push('\n');
    }
    for name in committed() {
        let table = folder.text(&format!("tex/{name}/verdicts.tex"));
        folder.write(&format!("tex/{name}/verdicts-first.tex"), shortened(&table));
        kept = kept.replace(&format!("{{{name}/verdicts}}"), &format!("{{{name}/verdicts-first}}"));
    }
    assert_eq!(kept.matches("/verdicts-first}").count(), committed().len());
    folder.write("tex/most.tex", kept);
    pdflatex(folder, &["most"]);
    let bibtex = Command::new("bibtex").arg("most").current_dir(folder.path("tex")).output().expect("bibtex");
    assert!(bibtex.status.success(), "{}", String::from_utf8_lossy(&bibtex.stdout));
    let log = String::from_utf8_lossy(&folder.bytes("tex/most.log")).into_owned();
    let missing: Vec<&str> = log.lines().filter(|line| line.contains("Missing character")).collect();
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn a_figure_becomes_a_pdf_of_its_own_size() {
    if !found("pdflatex") {
        return;
    }
    let folder = written();
    // Uncompressed, so that the page's size can be read.
    let path = "\\pdfobjcompresslevel=0 \\def\\remainderpath{chaussonnet-2015/figures}\\def\\remaindername{chaussonnet-figure-10a}\\input{figure}";
    pdflatex(folder, &["-jobname", "one", path]);
    let pdf = folder.bytes("tex/one.pdf");
    let text = String::from_utf8_lossy(&pdf);
    let sizes = text.split("/MediaBox [0 0 ").nth(1).and_then(|rest| rest.split(']').next());
    let sizes: Vec<f64> =
        sizes.expect("a page").split(' ').map(|size| size.parse().expect("a size")).collect();
    // Twelve centimetres wide at most; A4 is 595 by 842 points.
    assert!(sizes[0] < 400.0 && sizes[1] < 400.0, "{sizes:?}");
    let log = String::from_utf8_lossy(&folder.bytes("tex/one.log")).into_owned();
    assert!(log.contains("Output written on one.pdf (1 page"), "{log}");
}

#[test]
fn no_character_is_lost_and_only_what_is_cited_is_in_the_literature() {
    let folder = written();
    for (path, bytes) in folder.snapshot() {
        let Some(text) = bytes.and_then(|bytes| String::from_utf8(bytes).ok()) else { continue };
        if path.extension().is_some_and(|extension| extension == "tex") {
            assert!(!text.contains("U+"), "{}: a character without a symbol", path.display());
        }
    }
    let mut cited = BTreeSet::new();
    for name in committed() {
        let report = report(&name);
        cited.extend(list(&report["claims"]).iter().map(|claim| claim["citation"]["source"].to_string()));
    }
    // What a scene states itself is in no literature.
    cited.remove("\"scene\"");
    let bibliography = folder.text("tex/references.bib");
    let entries: BTreeSet<String> = bibliography
        .lines()
        .filter_map(|line| line.strip_prefix('@')?.split_once('{'))
        .map(|(_, key)| format!("\"{}\"", key.trim_end_matches(',')))
        .collect();
    assert_eq!(entries, cited);
    // As it stands in references.bib.
    let source = std::fs::read_to_string(repository("references.bib")).expect("references");
    for entry in bibliography.split("\n\n").filter(|entry| !entry.trim().is_empty()) {
        assert!(source.contains(entry.trim()), "{entry}");
    }
}

#[test]
fn the_verdict_table_says_what_the_report_says() {
    let folder = written();
    let table = folder.text("tex/fatehi-table-1/verdicts.tex");
    for part in [
        "\\toprule",
        "\\bottomrule",
        "S[table-format=",
        "{$9/2$} & 4.656 & {[}\\num{4.498}, \\num{4.813}{]}",
        "\\textbf{conditional}: on regular particles the leading error of F1",
    ] {
        assert!(table.contains(part), "'{part}' is not in:\n{table}");
    }
    let data = folder.text("tex/chaussonnet-2015/figures/chaussonnet-figure-10a.dat");
    let mut lines = data.lines();
    let width = lines.next().expect("a head").split(' ').count();
    assert!(data.starts_with("x1 y1") && lines.all(|line| line.split(' ').count() == width));
    assert!(folder.text("tex/fatehi-table-1/equations.tex").contains("Truncation error of F1"));
}

#[test]
fn every_fit_has_its_row() {
    let folder = written();
    for name in ["fatehi-table-1", "fatehi-table-2", "chaussonnet-2015"] {
        let table = folder.text(&format!("tex/{name}/fits.tex"));
        let body = table.split_once("\\endlastfoot\n").expect("a table over pages").1;
        let rows: Vec<&str> = body.lines().filter(|line| line.ends_with("\\\\")).collect();
        let report = report(name);
        let fits = list(&report["fits"]);
        assert_eq!(rows.len(), fits.len(), "{name}");
        for (row, fit) in rows.iter().zip(fits) {
            let points = list(&fit["points"]);
            let kept = points.iter().filter(|point| point["kept"] == true).count();
            assert!(row.contains(&format!("& {kept} of {} ", points.len())), "{row}: {kept}");
            let slope = fit["slope"]["value"].as_f64().expect("an exponent");
            let printed =
                row.split('&').nth(4).expect("eight cells").trim().parse::<f64>().expect("a number");
            assert!((printed - slope).abs() < 1e-3 * (1.0 + slope.abs()), "{row}: {slope}");
        }
    }
    assert!(!folder.path("tex/stiff/fits.tex").exists());
}
