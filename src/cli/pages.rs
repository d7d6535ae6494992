//! `report`, and `run --html`: pages and figures from the JSON alone.

use super::arguments::ReportArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use crate::report::html::{Placed, read_report, write_pages};
use crate::report::{WriteError, figure::figures, svg};
use crate::study::write_whole;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) fn report(arguments: &ReportArguments) -> Result<Exit, Failure> {
    let mut reports = Vec::new();
    // The folder whose index the pages belong to: that of the reports, if one was named.
    let mut whole = None;
    for path in &arguments.reports {
        let inside = folders(path);
        if inside.is_empty() {
            reports.push(read_report(path)?);
        } else {
            whole = Some(path.clone());
            for folder in inside {
                reports.push(read_report(&folder)?);
            }
        }
    }
    let mut written = Vec::new();
    if arguments.html {
        written = match (&arguments.out, whole) {
            (Some(out), _) => write_pages(&reports, Some(out), Some(out))?,
            (None, Some(whole)) if arguments.reports.len() == 1 => write_pages(&reports, None, Some(&whole))?,
            _ => each_beside(&reports)?,
        };
    }
    if let Some(folder) = &arguments.figures {
        written.extend(write_figures(&reports, folder)?);
    }
    let text: String = written.iter().map(|path| format!("{}\n", path.display())).collect();
    print_out(&text);
    Ok(Exit::AsExpected)
}

/// Writes the page of a report that was just written, and the index of its neighbours if it lies where reports lie.
pub(super) fn beside(folder: &Path, among_reports: bool) -> Result<(), Failure> {
    let parent = folder.parent().filter(|_| among_reports);
    match parent {
        // The others are listed, and their pages written again, so that every link of the index leads somewhere.
        Some(parent) => {
            let all: Result<Vec<Placed>, _> = folders(parent).iter().map(|path| read_report(path)).collect();
            write_pages(&all?, None, Some(parent))?;
        }
        None => {
            write_pages(&[read_report(folder)?], None, None)?;
        }
    }
    Ok(())
}

/// Pages of single reports; the link to an index only where there is one.
fn each_beside(reports: &[Placed]) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    for placed in reports {
        let indexed = placed.folder.parent().is_some_and(|parent| parent.join("index.html").is_file());
        if indexed {
            beside(&placed.folder, true)?;
        } else {
            write_pages(std::slice::from_ref(placed), None, None)?;
        }
        written.push(placed.folder.join("report.html"));
    }
    Ok(written)
}

/// The folders with a report right below this one, in the order of their names.
pub(super) fn folders(path: &Path) -> Vec<PathBuf> {
    if path.join("report.json").is_file() {
        return Vec::new();
    }
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| path.join("report.json").is_file()).collect();
    found.sort();
    found
}

fn write_figures(reports: &[Placed], out: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    for placed in reports {
        let folder = out.join(&placed.report.provenance.scene);
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| Failure::Write(WriteError::File { path, source })
        };
        fs::create_dir_all(&folder).map_err(failed(&folder))?;
        for figure in figures(&placed.report) {
            let path = folder.join(format!("{}.svg", figure.file_stem()));
            write_whole(&path, svg::standalone(&figure).as_bytes()).map_err(failed(&path))?;
            written.push(path);
        }
    }
    Ok(written)
}
