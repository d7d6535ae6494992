//! `report`: a report read back, shown or written in other forms.

use super::arguments::ReportArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::{terminal, views};
use crate::report::{Report, read_report, to_json};

pub(super) fn report(arguments: &ReportArguments) -> Result<Exit, Failure> {
    let reports = arguments.paths.iter().map(|path| Ok(read_report(path)?));
    let reports: Vec<Report> = reports.collect::<Result<_, Failure>>()?;
    views::write(&arguments.views, &reports)?;
    match reports.as_slice() {
        [report] if arguments.json => print_out(&to_json(report)),
        reports if arguments.json => print_out(&to_json(&reports)),
        _ if arguments.views.any() => {}
        reports => reports.iter().for_each(|report| print_out(&terminal::table(report))),
    }
    Ok(Exit::AsExpected)
}
