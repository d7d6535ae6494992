//! Text fits the width it is given, colours stay out of pipes, shells and manuals know every command.

use crate::folder::{Folder, PROGRAM};
use crate::{committed, repository};

fn lines_at(width: &str, arguments: &[&str]) -> String {
    let output = assert_cmd::Command::new(PROGRAM)
        .args(arguments)
        .env("COLUMNS", width)
        .current_dir(repository("."))
        .output()
        .expect("the program starts");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn tables_and_texts_fit_the_width() {
    let mut commands: Vec<Vec<String>> =
        committed().iter().map(|name| vec!["report".to_owned(), format!("reports/{name}")]).collect();
    let others = [
        "list",
        "explain fatehi-table-1 --all",
        "diff reports/fatehi-table-1 reports/fatehi-table-2",
        "plan analyses/fatehi-table-1",
    ];
    commands.extend(others.map(|command| command.split(' ').map(str::to_owned).collect()));
    for command in commands {
        let arguments: Vec<&str> = command.iter().map(String::as_str).collect();
        let mut heights = Vec::new();
        for width in [80, 120] {
            let text = lines_at(&width.to_string(), &arguments);
            let long: Vec<&str> =
                text.lines().filter(|line| textwrap::core::display_width(line) > width).collect();
            assert!(long.is_empty(), "{command:?} at {width}: {long:#?}");
            assert!(!text.is_empty(), "{command:?}");
            assert!(!text.contains('\x1b'), "{command:?} has colours in a pipe");
            heights.push(text.lines().count());
        }
        // In a pipe lines stay whole.
        let whole = lines_at("", &arguments);
        heights.push(whole.lines().count());
        assert!(heights.is_sorted_by(|a, b| a >= b), "{command:?}: {heights:?}");
        // Breaking loses no letter.
        let letters = |text: &str| {
            let mut letters: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
            letters.sort_unstable();
            letters
        };
        assert_eq!(letters(&whole), letters(&lines_at("80", &arguments)), "{command:?}");
    }
}

const COMMANDS: [&str; 20] = [
    "new",
    "run",
    "merge",
    "report",
    "diff",
    "plan",
    "sums",
    "schema",
    "kernel",
    "expand",
    "rms",
    "symbol",
    "orders",
    "advise",
    "list",
    "explain",
    "reference",
    "completions",
    "man",
    "help",
];

#[test]
fn completions_know_every_command_and_option() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.run_to(0, &format!("completions {shell}")).stdout;
        for word in COMMANDS.iter().chain(&["junit", "csv", "support-over-dx"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    folder.run_to(2, "completions tcsh").says(&["bash", "zsh"]);
    let help = folder.run_to(0, "--help").stdout;
    for command in COMMANDS {
        assert!(help.contains(&format!("\n  {command} ")), "'{command}' is hidden in:\n{help}");
    }
}

#[test]
fn every_command_has_its_manual_page() {
    let folder = Folder::new();
    let page = folder.run_to(0, "man").stdout;
    assert!(page.contains(".TH remainder 1") && page.contains("Exit codes"), "{page}");
    folder.run_to(0, "man --out share/man1");
    assert_eq!(folder.text("share/man1/remainder.1"), page);
    for command in COMMANDS.iter().filter(|command| **command != "help") {
        let page = folder.text(&format!("share/man1/remainder-{command}.1"));
        assert!(page.contains(".SH SYNOPSIS") && page.contains(command), "{command}");
    }
    assert_eq!(std::fs::read_dir(folder.path("share/man1")).expect("pages").count(), COMMANDS.len());
}

/// Commands that print data print JSON too.
#[test]
fn json_is_there_wherever_it_makes_sense() {
    let reports = "reports/fatehi-table-1";
    for command in [
        "list".to_owned(),
        "plan analyses/fatehi-table-1".to_owned(),
        "kernel wendland-c2".to_owned(),
        "expand F4".to_owned(),
        "orders --kernel wendland-c2 --dim 1 --moment sum_dw --disorder box".to_owned(),
        "sums --kernel wendland-c2 --lattice line --support-over-dx 2.5".to_owned(),
        "rms --operator F4 --disorder box:0.1 --kernel wendland-c2 --lattice line --support-over-dx 2.5"
            .to_owned(),
        "symbol S3 --lattice line --waves 2".to_owned(),
        "advise --tolerance 0.5 --dim 1".to_owned(),
        format!("report {reports}"),
        format!("report {reports} {reports}"),
        format!("diff {reports} {reports}"),
        "explain fatehi-table-1/F4".to_owned(),
    ] {
        let arguments: Vec<&str> = command.split(' ').chain(["--json"]).collect();
        let text = lines_at("40", &arguments);
        let value: Result<serde_json::Value, _> = serde_json::from_str(&text);
        assert!(value.is_ok(), "{command}: {text}");
    }
}
