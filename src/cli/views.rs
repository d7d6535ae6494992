//! The forms of a report that `run`, `merge` and `report` write where they are asked to.

use super::arguments::ViewArguments;
use super::execute::note;
use super::exit::Failure;
use super::files::write_file;
use crate::report::{Report, csv_files, file_names, junit, latex_files, latex_shared};
use std::path::Path;

/// Writes what is asked for: of several reports, each into a folder of its own name.
pub(super) fn write(views: &ViewArguments, reports: &[Report]) -> Result<(), Failure> {
    let fault = |error: &dyn std::fmt::Display| Failure::Arguments(error.to_string());
    let scenes = || reports.iter().map(|report| report.provenance.scene.as_str());
    // Names come from files that anyone may have written: none leads out of the folder.
    let names = file_names(scenes());
    if let Some(folder) = &views.csv {
        for (report, name) in reports.iter().zip(&names) {
            let files = csv_files(report).map_err(|error| fault(&error))?;
            for (file, text) in files {
                write_file(&folder.join(name).join(file), &text)?;
            }
        }
        said(folder);
    }
    if let Some(file) = &views.junit {
        write_file(file, &junit(reports).map_err(|error| fault(&error))?)?;
        said(file);
    }
    if let Some(folder) = &views.latex {
        let named: Vec<(&str, &Report)> = names.iter().map(String::as_str).zip(reports).collect();
        for (name, report) in &named {
            for (file, text) in latex_files(report).map_err(|error| fault(&error))? {
                write_file(&folder.join(name).join(file), &text)?;
            }
        }
        for (file, text) in latex_shared(&named).map_err(|error| fault(&error))? {
            write_file(&folder.join(file), &text)?;
        }
        said(folder);
    }
    Ok(())
}

/// On standard error: standard output may hold the record.
fn said(path: &Path) {
    note(&format!("Written to {}.", path.display()));
}

impl ViewArguments {
    /// Whether any is asked for.
    pub(super) fn any(&self) -> bool {
        let Self { csv, junit, latex } = self;
        csv.is_some() || junit.is_some() || latex.is_some()
    }
}
