//! `expand`: an operator's truncation error, term by term.

use super::arguments::{ExpandArguments, ExpandFormat};
use super::execute::print_out;
use super::exit::{Exit, Failure};
use super::files::write_file;
use crate::language::{Operator, operators};
use crate::particles::{Lattice, lattice, lattice_by_id};
use crate::report::{ExpansionReport, expansion_report, printed_markdown, printed_verdicts, to_json};
use std::path::Path;

pub(super) fn expand(arguments: &ExpandArguments) -> Result<Exit, Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let lattices: Vec<Lattice> = match arguments.lattices.as_slice() {
        [] => lattice::catalogue(),
        named => {
            let found: Result<_, _> = named.iter().map(|id| lattice_by_id(id)).collect();
            found.map_err(|error| fault(&error))?
        }
    };
    let report = |entry: Option<&operators::Entry>, operator: Operator| {
        expansion_report(entry, operator, arguments.to, &lattices).map_err(|error| fault(&error))
    };
    if let Some(folder) = &arguments.all {
        for entry in operators::catalogue() {
            let operator = entry.operator().map_err(|error| fault(&error))?;
            write(folder, &report(Some(&entry), operator)?)?;
        }
        let verdicts = printed_verdicts().map_err(|error| fault(&error))?;
        write_file(&folder.join("printed-equations.md"), &printed_markdown(&verdicts))?;
        write_file(&folder.join("printed-equations.json"), &to_json(&verdicts))?;
        print_out(&format!("Written to {}.\n", folder.display()));
        return Ok(Exit::AsExpected);
    }
    let Some(named) = &arguments.operator else {
        return Err(Failure::Arguments(
            "name an operator, or give its text; `remainder list operators` names all".into(),
        ));
    };
    let report = match operators::by_id(named) {
        Ok(entry) => {
            let operator = entry.operator().map_err(|error| fault(&error))?;
            report(Some(&entry), operator)?
        }
        // One word is meant as a name.
        Err(unknown) if named.chars().all(|c| c.is_alphanumeric() || "+-".contains(c)) => {
            return Err(fault(&unknown));
        }
        Err(_) => {
            let operator = Operator::parse(named).map_err(|error| Failure::Operator(named.clone(), error))?;
            report(None, operator)?
        }
    };
    print_out(&match arguments.format {
        _ if arguments.json => to_json(&report),
        ExpandFormat::Json => to_json(&report),
        ExpandFormat::Text => report.to_text(),
        ExpandFormat::Latex => report.to_latex(),
    });
    Ok(Exit::AsExpected)
}

/// `ID.txt` and `ID.tex`, each whole or not at all.
fn write(folder: &Path, report: &ExpansionReport) -> Result<(), Failure> {
    write_file(&folder.join(format!("{}.txt", report.id)), &report.to_text())?;
    write_file(&folder.join(format!("{}.tex", report.id)), &report.to_latex())
}
