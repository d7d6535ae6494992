//! The book: every command in it runs as it stands, prints what is shown and returns what is said; every snippet of a scene
//! is used; the reference is what the code makes; every chapter is listed, and every link leads somewhere.

#![allow(clippy::panic, reason = "a test fails by panicking, also in the functions that it shares")]
#![allow(dead_code, reason = "the folder is shared with the tests of runs, which use more of it")]

#[path = "cli/folder.rs"]
mod folder;

use folder::Folder;
use std::fs;
use std::path::{Path, PathBuf};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Every chapter by its path below `docs`.
fn chapters() -> Vec<(String, String)> {
    fn look(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => look(&path, found),
                false => found.extend(path.extension().is_some_and(|e| e == "md").then(|| path.clone())),
            }
        }
    }
    let mut paths = Vec::new();
    look(&docs(), &mut paths);
    paths.sort();
    let named = paths.into_iter().map(|path| {
        let name = path.strip_prefix(docs()).expect("below docs").to_string_lossy().replace('\\', "/");
        (name, fs::read_to_string(path).expect("text"))
    });
    let chapters: Vec<_> = named.collect();
    assert!(chapters.len() > 15, "{}", chapters.len());
    chapters
}

/// A fenced block: its language, the line before it, its text.
fn blocks(text: &str) -> Vec<(&str, &str, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines();
    let mut before = "";
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let inner: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
            found.push((language, before, inner.join("\n")));
        }
        before = line;
    }
    found
}

/// The words of a command line; single quotes hold blanks together.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in command.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().expect("a word").push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Runs the commands of one block, and compares what is shown below each.
fn console(folder: &Folder, chapter: &str, block: &str) -> usize {
    let mut commands: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in block.lines() {
        match line.strip_prefix("$ ") {
            Some(command) => commands.push((command, Vec::new())),
            None => commands.last_mut().unwrap_or_else(|| panic!("{chapter}: {line}")).1.push(line),
        }
    }
    for (line, shown) in &commands {
        let (command, code) = line.split_once("  # exit code ").unwrap_or((line, "0"));
        let arguments = command.strip_prefix("remainder ").unwrap_or_else(|| panic!("{chapter}: {command}"));
        let arguments = words(arguments);
        let ran = folder.run_arguments(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(ran.code.to_string(), code, "{chapter}: {command}\n{}{}", ran.stdout, ran.stderr);
        let printed = if ran.stdout.is_empty() { &ran.stderr } else { &ran.stdout };
        let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
        let (mut at, mut gap) = (0, false);
        for expected in shown {
            if *expected == "…" {
                gap = true;
                continue;
            }
            let rest = &printed[at.min(printed.len())..];
            let found = rest.iter().position(|line| *line == expected.trim_end());
            let found = found.filter(|found| gap || *found == 0);
            let all = printed.join("\n");
            at += 1 + found
                .unwrap_or_else(|| panic!("{chapter}: {command}: '{expected}' is not next in:\n{all}"));
            gap = false;
        }
        if !shown.is_empty() && !gap {
            assert_eq!(at, printed.len(), "{chapter}: {command} prints more:\n{}", printed.join("\n"));
        }
    }
    commands.len()
}

/// Runs a chapter's blocks in a folder of its own: how many commands, how many snippets.
fn run(chapter: &str, text: &str) -> (usize, usize) {
    let folder = Folder::new();
    let (mut commands, mut snippets) = (0, 0);
    for (language, before, block) in blocks(text) {
        match language {
            "console" => commands += console(&folder, chapter, &block),
            "toml" => {
                let file = before.strip_prefix("<!-- file: ").and_then(|rest| rest.strip_suffix(" -->"));
                let file =
                    file.unwrap_or_else(|| panic!("{chapter}: a snippet that no file is made of:\n{block}"));
                folder.write(file, format!("{block}\n"));
                let used = text.matches(file).count();
                assert!(used > 2, "{chapter}: {file} is named {used} times: no command takes it");
                snippets += 1;
            }
            // Grammars, trees of formulas, LaTeX, and what is for the shell alone.
            "text" | "operator" | "tex" | "sh" | "rust" => {}
            other => {
                panic!("{chapter}: a block of '{other}': write console, toml, text, operator, tex or sh")
            }
        }
    }
    (commands, snippets)
}

#[test]
fn every_command_and_snippet_runs_as_written() {
    let ran: Vec<(usize, usize)> = chapters().iter().map(|(name, text)| run(name, text)).collect();
    let commands: usize = ran.iter().map(|(commands, _)| commands).sum();
    let snippets: usize = ran.iter().map(|(_, snippets)| snippets).sum();
    assert!(commands >= 20 && snippets >= 7, "{commands} commands, {snippets} snippets");
}

#[test]
fn the_reference_is_what_the_code_makes() {
    let folder = Folder::new();
    folder.run_to(0, "reference made");
    let mut names = Vec::new();
    for entry in fs::read_dir(folder.path("made")).expect("pages") {
        let name = entry.expect("an entry").file_name().into_string().expect("a name");
        let committed = fs::read_to_string(docs().join("reference").join(&name)).unwrap_or_default();
        let same = committed == folder.text(&format!("made/{name}"));
        assert!(same, "docs/reference/{name} is not up to date: remainder reference docs/reference");
        names.push(name);
    }
    let committed = fs::read_dir(docs().join("reference")).expect("pages").count();
    assert_eq!(committed, names.len(), "a page that nothing makes");
}

#[test]
fn chapters_are_listed_and_links_lead_somewhere() {
    let chapters = chapters();
    let summary = fs::read_to_string(docs().join("SUMMARY.md")).expect("SUMMARY.md");
    for (name, text) in &chapters {
        assert!(
            name == "SUMMARY.md" || summary.contains(&format!("({name})")),
            "{name} is not in SUMMARY.md"
        );
        let folder = docs().join(name).parent().expect("a folder").to_owned();
        for (at, _) in text.match_indices("](") {
            let target = text[at + 2..].split(')').next().unwrap_or_default();
            let file = target.split('#').next().unwrap_or_default();
            let elsewhere = target.contains("://") || file.is_empty() || !file.ends_with(".md");
            assert!(elsewhere || folder.join(file).is_file(), "{name}: {target} leads nowhere");
        }
    }
}
