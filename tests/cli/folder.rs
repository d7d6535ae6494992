//! A folder to run the program in, and what came of a run.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

/// The program under test.
pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_remainder");

/// A temporary folder; all paths are relative to it, and runs have it as their working directory.
pub(crate) struct Folder(TempDir);

/// What a run returned and printed.
pub(crate) struct Ran {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().expect("a temporary folder"))
    }

    /// A folder that holds `scene.toml` with this text.
    pub(crate) fn with_scene(text: &str) -> Self {
        let folder = Self::new();
        folder.write("small.toml", text);
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a file in a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file written");
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).expect("text")
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Runs `remainder` with these arguments, separated by blanks.
    pub(crate) fn run(&self, arguments: &str) -> Ran {
        self.run_arguments(&arguments.split_whitespace().collect::<Vec<_>>())
    }

    /// Runs `remainder` with these arguments, which may hold blanks.
    pub(crate) fn run_arguments(&self, arguments: &[&str]) -> Ran {
        let output = assert_cmd::Command::new(PROGRAM)
            .current_dir(self.0.path())
            .args(arguments)
            .timeout(Duration::from_secs(120))
            .output()
            .expect("the program starts");
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the program prints UTF-8");
        let code = output.status.code();
        let ran = Ran { code: code.unwrap_or(-1), stdout: text(output.stdout), stderr: text(output.stderr) };
        let arguments = arguments.join(" ");
        assert!(code.is_some(), "`{arguments}` ended by a signal:\n{}", ran.stderr);
        assert!(
            !ran.stderr.contains("panicked") && !ran.stdout.contains("panicked"),
            "`{arguments}` panicked:\n{}",
            ran.stderr
        );
        ran
    }

    /// Runs and expects this exit code.
    pub(crate) fn run_to(&self, code: i32, arguments: &str) -> Ran {
        let ran = self.run(arguments);
        assert_eq!(ran.code, code, "`{arguments}`:\n{}{}", ran.stdout, ran.stderr);
        ran
    }

    /// All files below the folder with their bytes; folders as well, with none.
    pub(crate) fn snapshot(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut seen = BTreeMap::new();
        look(self.0.path(), &mut seen);
        seen
    }

    /// The stored blocks in a folder by file name; temporary files do not count.
    pub(crate) fn blocks(&self, store: &str) -> BTreeMap<String, Value> {
        let Ok(entries) = fs::read_dir(self.path(store)) else { return BTreeMap::new() };
        let names = entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name"));
        let blocks = names.filter(|name| name.ends_with(".json"));
        blocks.map(|name| (name.clone(), self.json(&format!("{store}/{name}")))).collect()
    }
}

fn look(folder: &Path, seen: &mut BTreeMap<PathBuf, Option<Vec<u8>>>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            look(&path, seen);
            seen.insert(path, None);
        } else {
            let bytes = fs::read(&path).expect("a file");
            seen.insert(path, Some(bytes));
        }
    }
}

impl Ran {
    /// Expects each of these words on standard error.
    pub(crate) fn says(&self, words: &[&str]) {
        for word in words {
            assert!(self.stderr.contains(word), "'{word}' is not in:\n{}", self.stderr);
        }
    }
}
