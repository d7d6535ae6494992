//! Writing a report, never over something that is none.

use super::layout::to_json;
use super::markdown::markdown;
use crate::record::{Report, SCHEMA};
use crate::study::write_whole;
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What can go wrong when a report is written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// A file stands where the report should go, and is no report.
    #[error("{} does not belong to a {SCHEMA} ({what}) and is left as it is: move it away, or write elsewhere with --out", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// The file system refused.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// Checks that a report may be written into a folder: that what stands there as `report.json` is one, and that nothing
/// stands under the other names without it (`report.json` is written first, so what is there then is not ours).
///
/// # Errors
/// [`WriteError::Foreign`], [`WriteError::File`].
pub fn check_target(folder: &Path) -> Result<(), WriteError> {
    #[derive(Deserialize)]
    struct Head {
        schema: String,
    }
    let path = folder.join("report.json");
    let foreign = |what: String| WriteError::Foreign { path: path.clone(), what };
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return check_folder(folder),
        Err(source) => return Err(WriteError::File { path, source }),
    };
    let head: Head = serde_json::from_slice(&bytes).map_err(|error| foreign(error.to_string()))?;
    if head.schema != SCHEMA {
        return Err(foreign(format!("its schema is '{}'", head.schema)));
    }
    Ok(())
}

/// A folder that is to be made must not be a file, nor below one.
fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let existing = folder.ancestors().find(|path| path.exists());
    match existing {
        Some(path) if !path.is_dir() => Err(WriteError::Foreign {
            path: path.to_owned(),
            what: "a file stands where a folder is needed".into(),
        }),
        _ => match ["report.md", "timings.json"]
            .map(|name| folder.join(name))
            .into_iter()
            .find(|p| p.exists())
        {
            Some(path) => Err(WriteError::Foreign { path, what: "there is no report.json beside it".into() }),
            None => Ok(()),
        },
    }
}

/// Writes `report.json`, `report.md` and `timings.json`, each whole or not at all.
///
/// # Errors
/// As [`check_target`].
pub fn write_report(folder: &Path, report: &Report, timings: &serde_json::Value) -> Result<(), WriteError> {
    check_target(folder)?;
    fs::create_dir_all(folder).map_err(|source| WriteError::File { path: folder.to_owned(), source })?;
    let files = [
        ("report.json", to_json(report)),
        ("report.md", markdown(report)),
        ("timings.json", to_json(timings)),
    ];
    for (name, text) in files {
        let path = folder.join(name);
        write_whole(&path, text.as_bytes()).map_err(|source| WriteError::File { path, source })?;
    }
    Ok(())
}
