//! `run --html` and `report`: pages as files.

use crate::folder::Folder;
use crate::scenes::SMALL;

#[test]
fn a_run_with_html_writes_its_page_and_the_index() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --html");
    let page = folder.text("reports/small/report.html");
    assert!(page.starts_with("<!DOCTYPE html>"), "{}", &page[..80]);
    assert!(page.contains("A small study") && page.contains("own/mine"), "no content");
    assert!(folder.text("reports/index.html").contains("small/report.html"));
    // From the JSON alone, the same bytes: for one report, for all of them.
    for arguments in ["report reports/small --html", "report reports --html"] {
        folder.run_to(0, arguments);
        assert!(page == folder.text("reports/small/report.html"), "{arguments} gives another page");
    }
}

#[test]
fn pages_and_figures_go_where_they_are_told() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml");
    let ran = folder.run_to(0, "report reports/small --html --out elsewhere --figures figures");
    assert!(ran.stdout.contains("elsewhere"), "{}", ran.stdout);
    assert!(folder.path("elsewhere/small/report.html").is_file());
    assert!(folder.path("elsewhere/index.html").is_file());
    assert!(!folder.path("reports/small/report.html").exists());
    let drawn = folder.text("figures/small/kernels-0.svg");
    assert!(drawn.starts_with("<?xml") && drawn.trim_end().ends_with("</svg>"), "no whole drawing");
}

#[test]
fn what_is_no_report_and_what_is_no_page_is_left_alone() {
    let folder = Folder::with_scene(SMALL);
    let ran = folder.run_to(2, "report nowhere --html");
    assert!(ran.stderr.contains("nowhere"), "{}", ran.stderr);
    folder.run_to(0, "run small.toml");
    std::fs::write(folder.path("reports/small/report.html"), "<p>mine</p>").expect("a writable folder");
    let ran = folder.run_to(2, "report reports/small --html");
    assert!(ran.stderr.contains("report.html"), "{}", ran.stderr);
    assert_eq!(folder.text("reports/small/report.html"), "<p>mine</p>");
}
