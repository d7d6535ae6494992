//! `report`: reports read back, shown or written in other forms.

use super::arguments::ReportArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::{pages, terminal, views};
use crate::report::{Report, read_report, to_json};
use std::path::PathBuf;

pub(super) fn report(arguments: &ReportArguments) -> Result<Exit, Failure> {
    let pages = arguments.html || arguments.figures.is_some();
    // Nothing is written before all can be read.
    let reports: Vec<Report> = paths(&arguments.reports)
        .iter()
        .map(|path| Ok(read_report(path)?))
        .collect::<Result<_, Failure>>()?;
    if pages {
        pages::report(arguments)?;
    }
    views::write(&arguments.views, &reports)?;
    match reports.as_slice() {
        [report] if arguments.json => print_out(&to_json(report)),
        reports if arguments.json => print_out(&to_json(&reports)),
        _ if pages || arguments.views.any() => {}
        reports => reports.iter().for_each(|report| print_out(&terminal::table(report))),
    }
    Ok(Exit::AsExpected)
}

/// Folders of folders with reports stand for these.
fn paths(named: &[PathBuf]) -> Vec<PathBuf> {
    let inside = |path: &PathBuf| match pages::folders(path) {
        none if none.is_empty() => vec![path.clone()],
        folders => folders,
    };
    named.iter().flat_map(inside).collect()
}
