//! Reading a report back, with a word on what is wrong where it is none or comes from a newer program.

use crate::record::{Report, SCHEMA};
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a report could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// There is no such file, or no `report.json` in the folder.
    #[error("cannot read {}: {source}; name a report.json, or the folder that holds one", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A later version of the program wrote it.
    #[error(
        "{} has the schema '{schema}', which is newer than the '{SCHEMA}' that remainder {} reads: read it with the version that wrote it, or a later one",
        path.display(),
        env!("CARGO_PKG_VERSION")
    )]
    Newer {
        /// The file.
        path: PathBuf,
        /// Its schema.
        schema: String,
    },
    /// It is no report.
    #[error("{} is no {SCHEMA}: {what}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

/// The report in a file, or in `report.json` of a folder.
///
/// # Errors
/// [`ReadError`].
pub fn read_report(path: &Path) -> Result<Report, ReadError> {
    #[derive(Deserialize)]
    struct Head {
        schema: String,
    }
    let path = if path.is_dir() { path.join("report.json") } else { path.to_owned() };
    let foreign =
        |error: serde_json::Error| ReadError::Foreign { path: path.clone(), what: error.to_string() };
    let bytes = fs::read(&path).map_err(|source| ReadError::File { path: path.clone(), source })?;
    // The head alone first: what a newer schema adds is no fault of the file.
    let Head { schema } = serde_json::from_slice(&bytes).map_err(foreign)?;
    if schema != SCHEMA {
        return Err(match (version(&schema), version(SCHEMA)) {
            (Some(theirs), Some(ours)) if theirs > ours => ReadError::Newer { path, schema },
            _ => ReadError::Foreign { path, what: format!("its schema is '{schema}'") },
        });
    }
    serde_json::from_slice(&bytes).map_err(foreign)
}

/// n of `remainder-report/n`.
fn version(schema: &str) -> Option<u32> {
    schema.strip_prefix("remainder-report/")?.parse().ok()
}
