//! Data flows one way: a layer names only the layers below it, and the derived and the measured column never name each
//! other. Read from the sources, so that it holds for code behind features as well.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Lowest first. Layers that stand together may not name each other.
const LAYERS: &[&[&str]] = &[
    &["names"],
    &["exact"],
    &["kernel"],
    &["particles"],
    &["sums"],
    &["language"],
    &["derived", "measured"],
    &["evolve"],
    &["claim"],
    &["record"],
    &["study"],
    &["report"],
    &["cli"],
];

fn rank(layer: &str) -> Option<usize> {
    LAYERS.iter().position(|group| group.contains(&layer))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// The layers that a source names: every `crate::layer`, also inside `crate::{…}`, outside comments.
fn named(text: &str) -> Vec<String> {
    let code: String =
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let mut item = String::new();
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' if depth == 0 => break,
                    '}' => depth -= 1,
                    ',' if depth == 0 => found.push(std::mem::take(&mut item)),
                    c => item.push(c),
                }
            }
            found.push(item);
        } else {
            found.push(rest.to_owned());
        }
    }
    found
        .iter()
        .map(|item| item.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .filter(|name: &String| !name.is_empty())
        .collect()
}

#[test]
fn no_layer_names_a_higher_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut faults = Vec::new();
    for file in sources(&root) {
        let relative = file.strip_prefix(&root).unwrap();
        let first = relative.components().next().unwrap().as_os_str().to_string_lossy().replace(".rs", "");
        if first == "lib" || first == "main" {
            continue;
        }
        let own = rank(&first).unwrap_or_else(|| panic!("{first} is no layer: give it a place in LAYERS"));
        *seen.entry(first.clone()).or_default() += 1;
        for other in named(&fs::read_to_string(&file).unwrap()) {
            let Some(theirs) = rank(&other) else {
                panic!("{} names crate::{other}, which is no layer", relative.display());
            };
            if theirs > own || (theirs == own && other != first) {
                faults.push(format!("{} names {other}", relative.display()));
            }
        }
    }
    assert!(faults.is_empty(), "layers are crossed:\n{}", faults.join("\n"));
    for layer in ["exact", "kernel", "particles", "sums", "measured", "claim", "study", "report", "cli"] {
        assert!(seen.contains_key(layer), "nothing was read of layer {layer}");
    }
}

#[test]
fn the_reader_finds_every_way_to_name_a_layer() {
    let text = "use crate::study::Scene;\nuse crate::{exact::{int, ratio}, report::Report};\nlet x = crate::cli::main();\n// crate::nothing\n";
    assert_eq!(named(text), ["study", "exact", "report", "cli"]);
}
