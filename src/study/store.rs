//! Finished blocks on disk: one file per block, whole or not at all.

use super::StudyError;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

const SCHEMA: &str = "remainder-block/1";

/// Blocks under a folder (`.remainder`), by case key and number.
#[derive(Debug, Clone)]
pub struct BlockStore {
    folder: PathBuf,
    /// Further stores to read from, such as those of other shards.
    also: Vec<PathBuf>,
}

#[derive(Serialize, Deserialize)]
struct Stored<T> {
    schema: String,
    key: String,
    block: u64,
    data: T,
    /// The last field: a file cut short does not have it.
    end: bool,
}

impl BlockStore {
    /// A store in this folder, reading from `also` as well.
    pub fn new(folder: impl Into<PathBuf>, also: Vec<PathBuf>) -> Self {
        Self { folder: folder.into(), also }
    }

    /// The block, if it is stored; `is_whole` says whether its data have the shape that the case needs.
    ///
    /// # Errors
    /// [`StudyError::ForeignBlock`] if the file is not a whole block of this key, [`StudyError::File`].
    pub fn load<T: DeserializeOwned>(
        &self,
        key: &str,
        block: u64,
        is_whole: impl Fn(&T) -> bool,
    ) -> Result<Option<T>, StudyError> {
        for folder in std::iter::once(&self.folder).chain(&self.also) {
            let path = folder.join(file_name(key, block));
            let text = match fs::read_to_string(&path) {
                Ok(text) => text,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
                Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {
                    return Err(StudyError::ForeignBlock { path, what: "it is not text".into() });
                }
                Err(source) => return Err(StudyError::File { action: "cannot read", path, source }),
            };
            let foreign = |what: String| StudyError::ForeignBlock { path: path.clone(), what };
            let stored: Stored<T> =
                serde_json::from_str(&text).map_err(|error| foreign(error.to_string()))?;
            if stored.schema != SCHEMA || stored.key != key || stored.block != block || !stored.end {
                return Err(foreign("it belongs to another case".into()));
            }
            if !is_whole(&stored.data) {
                return Err(foreign("its data are not all there".into()));
            }
            return Ok(Some(stored.data));
        }
        Ok(None)
    }

    /// Stores a block.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub fn save<T: Serialize>(&self, key: &str, block: u64, data: &T) -> Result<(), StudyError> {
        let path = self.folder.join(file_name(key, block));
        let stored = Stored { schema: SCHEMA.into(), key: key.into(), block, data, end: true };
        let text = serde_json::to_string(&stored).unwrap_or_else(|error| unreachable!("plain data: {error}"));
        fs::create_dir_all(&self.folder).map_err(|source| StudyError::File {
            action: "cannot make folder",
            path: self.folder.clone(),
            source,
        })?;
        write_whole(&path, text.as_bytes()).map_err(|source| StudyError::File {
            action: "cannot write",
            path,
            source,
        })
    }
}

fn file_name(key: &str, block: u64) -> String {
    format!("{key}.{block}.json")
}

/// Writes a file so that it appears whole or not at all: a temporary file beside it, flushed, then renamed over it.
///
/// # Errors
/// As the file system has them.
pub fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
    let written = fs::File::create(&temporary).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()
    });
    let renamed = written.and_then(|()| fs::rename(&temporary, path));
    if renamed.is_err() {
        // The error that matters is the first one.
        let _ = fs::remove_file(&temporary);
    }
    renamed
}
