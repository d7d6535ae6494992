//! Files that commands write.

use super::exit::Failure;
use crate::study::write_whole;
use std::path::Path;

/// Writes a file whole or not at all, and the folders that it needs.
pub(super) fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    let refused = |path: &Path, error: std::io::Error| {
        Failure::Arguments(format!("cannot write {}: {error}", path.display()))
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|error| refused(folder, error))?;
    }
    write_whole(path, text.as_bytes()).map_err(|error| refused(path, error))
}
