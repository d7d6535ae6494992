//! `diff`: what changed from one report to another.

use super::arguments::DiffArguments;
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::terminal::fitted;
use crate::report::{Difference, difference_text, read_report, to_json};

pub(super) fn diff(arguments: &DiffArguments) -> Result<Exit, Failure> {
    let difference = Difference::between(&read_report(&arguments.before)?, &read_report(&arguments.after)?);
    print_out(&if arguments.json { to_json(&difference) } else { fitted(&difference_text(&difference)) });
    Ok(if difference.is_nothing() { Exit::AsExpected } else { Exit::Differs })
}
