//! `explain`: the story of a claim.

use super::arguments::ExplainArguments;
use super::execute::{note, print_out};
use super::exit::{Exit, Failure};
use super::terminal::fitted;
use crate::report::{Report, read_report, stories, to_json};
use std::path::{Path, PathBuf};

/// Cases shown of each report unless all are asked for.
const MOST_CASES: usize = 6;

pub(super) fn explain(arguments: &ExplainArguments) -> Result<Exit, Failure> {
    let name = arguments.claim.as_str();
    let files = files(&arguments.reports);
    // Most reports say nothing of the claim: only those that name it are read, unless none does.
    let quoted = [format!("\"{name}\""), format!("\"{name}/")];
    let stories = stories(name, &reports(&files, |text| quoted.iter().any(|id| text.contains(id))))
        .or_else(|_| stories(name, &reports(&files, |_| true)))
        .map_err(|error| Failure::Arguments(error.to_string()))?;
    if arguments.json {
        print_out(&to_json(&stories));
        return Ok(Exit::AsExpected);
    }
    let most = if arguments.all { usize::MAX } else { MOST_CASES };
    let texts: Vec<String> = stories.iter().map(|story| fitted(&story.to_text(most))).collect();
    print_out(&texts.join("\n"));
    Ok(Exit::AsExpected)
}

/// The `report.json` below a folder, by name; none where there is no folder, and the catalogue alone is told.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path().join("report.json")).filter(|path| path.is_file());
    let mut paths: Vec<PathBuf> = paths.collect();
    paths.sort();
    paths
}

/// The reports whose text is wanted. One that cannot be read is named and left out: the others still tell.
fn reports(files: &[PathBuf], wanted: impl Fn(&str) -> bool) -> Vec<Report> {
    let mut reports = Vec::new();
    for path in files {
        // What cannot even be read as text is left to `read_report`, which says why.
        if std::fs::read_to_string(path).is_ok_and(|text| !wanted(&text)) {
            continue;
        }
        match read_report(path) {
            Ok(report) => reports.push(report),
            Err(error) => note(&format!("left out: {error}")),
        }
    }
    reports
}
