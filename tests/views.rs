//! Views of reports and commands about them, as processes: CSV, JUnit, LaTeX, differences, stories of claims, new scenes.

#![allow(clippy::panic, reason = "a test fails by panicking, also in the functions that it shares")]
#![allow(dead_code, reason = "the folder is shared with the tests of runs, which use more of it")]

#[path = "views/csv.rs"]
mod csv;
#[path = "views/diff.rs"]
mod diff;
#[path = "views/explain.rs"]
mod explain;
#[path = "cli/folder.rs"]
mod folder;
#[path = "views/junit.rs"]
mod junit;
#[path = "views/latex.rs"]
mod latex;
#[path = "views/new.rs"]
mod new;
#[path = "views/schema.rs"]
mod schema;
#[path = "views/terminal.rs"]
mod terminal;

use serde_json::Value;
use std::path::{Path, PathBuf};

/// A folder of the repository.
fn repository(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The names of the committed reports.
fn committed() -> Vec<String> {
    let entries = std::fs::read_dir(repository("reports")).expect("reports");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.join("report.json").is_file())
        .map(|path| path.file_name().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert!(names.len() >= 9, "{names:?}");
    names
}

/// A committed report.
fn report(name: &str) -> Value {
    let path = repository("reports").join(name).join("report.json");
    serde_json::from_slice(&std::fs::read(path).expect("a report")).expect("JSON")
}

/// The items of a list.
fn list(value: &Value) -> &[Value] {
    value.as_array().map(Vec::as_slice).unwrap_or_default()
}
