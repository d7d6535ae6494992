//! Pages as files: beside their reports, or in a folder of their own.

use super::index::{IndexEntry, index_page};
use super::{Links, page, shell};
use crate::record::Report;
use crate::report::WriteError;
use crate::report::read::{self, ReadError};
use crate::study::write_whole;
use std::fs;
use std::path::{Path, PathBuf};

/// A report and the folder that it was read from.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// The folder with its `report.json`.
    pub folder: PathBuf,
    /// The report.
    pub report: Report,
}

impl Placed {
    /// The folder's own name.
    fn name(&self) -> String {
        let whole = fs::canonicalize(&self.folder).unwrap_or_else(|_| self.folder.clone());
        whole.file_name().map_or_else(|| "report".to_owned(), |name| name.to_string_lossy().into_owned())
    }
}

/// Reads a report, and keeps where it lies.
///
/// # Errors
/// [`ReadError`].
pub fn read_report(path: &Path) -> Result<Placed, ReadError> {
    let report = read::read_report(path)?;
    let folder = if path.is_dir() { Some(path) } else { path.parent() };
    Ok(Placed { folder: folder.map_or_else(PathBuf::new, Path::to_owned), report })
}

/// Writes `report.html` for each report, into its folder or into a folder of its name under `out`, and with `index` the
/// page over all of them. Returns what was written.
///
/// # Errors
/// [`WriteError::Foreign`] where a file stands that is no page of ours, [`WriteError::File`].
pub fn write_pages(
    reports: &[Placed],
    out: Option<&Path>,
    index: Option<&Path>,
) -> Result<Vec<PathBuf>, WriteError> {
    let mut written = Vec::new();
    let mut entries = Vec::new();
    for placed in reports {
        let name = placed.name();
        let folder = out.map_or_else(|| placed.folder.clone(), |out| out.join(&name));
        let links = Links {
            index: index.map(|_| "../index.html"),
            // Beside its JSON only when it is written there.
            json: out.is_none().then_some("report.json"),
        };
        let path = folder.join("report.html");
        put(&path, &page(&placed.report, links))?;
        written.push(path);
        entries.push(IndexEntry::of(&placed.report, format!("{name}/report.html")));
    }
    if let Some(folder) = index {
        let path = folder.join("index.html");
        put(&path, &index_page(&entries))?;
        written.push(path);
    }
    Ok(written)
}

fn put(path: &Path, text: &str) -> Result<(), WriteError> {
    if let Ok(there) = fs::read_to_string(path)
        && !there.contains(shell::MARK)
    {
        let what = "it is no page of this program".to_owned();
        return Err(WriteError::Foreign { path: path.to_owned(), what });
    }
    let file = |source| WriteError::File { path: path.to_owned(), source };
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(file)?;
    }
    write_whole(path, text.as_bytes()).map_err(file)
}
