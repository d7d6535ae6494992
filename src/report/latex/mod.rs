//! What a paper takes in: tables, figures, equations and the literature, as LaTeX.
//!
//! Of each report, in a folder of its name:
//!
//! | file | what it is |
//! | --- | --- |
//! | `summary.tex`, `verdicts.tex` | tables of the verdicts; published, derived and measured side by side |
//! | `fits.tex` | fitted exponents with interval, residual deviation and points kept |
//! | `table-NAME.tex`, `runs.tex`, … | the other tables, as far as a page holds them |
//! | `equations.tex` | what is claimed, and the expansions of the operators that it is about |
//! | `figures/ID.tex`, `figures/ID.dat` | a PGFPlots source and its data |
//!
//! Beside the folders: `remainder.sty`, which loads what these need and nothing else, `references.bib` with the works cited,
//! `all.tex`, a document that takes all of it in, and `figure.tex`, which makes a PDF of one figure. Everything compiles with
//! pdfLaTeX.

mod equations;
mod figure;
mod table;
mod tables;
mod text;

use super::figure::figures;
use crate::claim::literature;
use crate::derived::DeriveError;
use crate::record::Report;
use biblatex::ParseError;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use text::{plain, tex};
use thiserror::Error;

/// Why a report could not be set.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LatexError {
    /// The literature is no BibTeX.
    #[error("references.bib: {0}")]
    Literature(ParseError),
    /// An operator of the report could not be expanded.
    #[error(transparent)]
    Expansion(#[from] DeriveError),
}

/// The preamble's package.
const STYLE: &str = include_str!("remainder.sty");

/// A PDF of one figure.
const FIGURE: &str = include_str!("figure.tex");

/// The files of one report by their paths below its folder.
///
/// # Errors
/// [`LatexError`].
pub fn latex_files(report: &Report) -> Result<BTreeMap<String, String>, LatexError> {
    let mut files = BTreeMap::new();
    for (name, text) in tables::tables(report) {
        files.insert(format!("{name}.tex"), text);
    }
    let equations = equations::equations(report)?;
    if !equations.is_empty() {
        files.insert("equations.tex".into(), equations);
    }
    for figure in figures(report) {
        let stem = figure.file_stem();
        let (source, data) = figure::pgfplots(&figure, &stem);
        files.insert(format!("figures/{stem}.tex"), source);
        files.insert(format!("figures/{stem}.dat"), data);
    }
    Ok(files)
}

/// What several reports share, by name: the package, the literature, a document with all of it, the frame of a figure.
///
/// # Errors
/// [`LatexError`].
pub fn latex_shared(reports: &[(&str, &Report)]) -> Result<BTreeMap<String, String>, LatexError> {
    let mut files = BTreeMap::from([
        ("remainder.sty".to_owned(), STYLE.to_owned()),
        ("figure.tex".to_owned(), FIGURE.to_owned()),
        ("references.bib".to_owned(), bibliography(reports.iter().map(|(_, report)| *report))?),
    ]);
    let mut all = String::from(
        "% Everything that was written here, to look at and to copy from.\n\
         %   pdflatex all && bibtex all && pdflatex all && pdflatex all\n\
         \\documentclass{article}\n\\usepackage[margin=2cm]{geometry}\n\\usepackage{remainder}\n",
    );
    all.push_str("\\begin{document}\n");
    for (name, report) in reports {
        let title = match report.provenance.title.as_str() {
            "" => &report.provenance.scene,
            title => title,
        };
        let cited: Vec<String> = cited(report).into_iter().collect();
        let cite = if cited.is_empty() { String::new() } else { format!(" \\cite{{{}}}", cited.join(",")) };
        let _ = writeln!(all, "\\section{{{}{cite}}}", tex(title));
        for (file, _) in tables::tables(report) {
            let _ = writeln!(
                all,
                "\\subsection*{{{}}}\n{{\\footnotesize\\input{{{name}/{file}}}}}",
                plain(&file)
            );
        }
        if equations::any(report) {
            let _ = writeln!(all, "\\input{{{name}/equations}}");
        }
        for figure in figures(report) {
            let number =
                figure.number.as_ref().map(|number| format!("Figure {number}. ")).unwrap_or_default();
            let stem = figure.file_stem();
            let caption = tex(&format!("{number}{}", figure.title));
            let _ = writeln!(all, "\\remainderfigure{{{name}/figures}}{{{stem}}}{{{caption}}}");
        }
    }
    all.push_str("\\bibliographystyle{plain}\n\\bibliography{references}\n\\end{document}\n");
    files.insert("all.tex".into(), all);
    Ok(files)
}

/// The keys of the works that a report cites; claims of a scene's own cite none.
fn cited(report: &Report) -> BTreeSet<String> {
    report.claims.iter().map(|entry| entry.citation.source.clone()).filter(|key| key != "scene").collect()
}

/// The entries of `references.bib` that the reports cite, as they stand there.
fn bibliography<'a>(reports: impl Iterator<Item = &'a Report>) -> Result<String, LatexError> {
    let keys: BTreeSet<String> = reports.flat_map(cited).collect();
    let papers = literature().map_err(LatexError::Literature)?;
    let entries = papers.iter().filter(|paper| keys.contains(&paper.key)).map(|paper| paper.bibtex.as_str());
    Ok(entries.map(|entry| format!("{entry}\n")).collect::<Vec<_>>().join("\n"))
}
