//! What a run writes and prints.

use crate::folder::Folder;
use crate::scenes::SMALL;
use serde_json::{Value, json};

#[test]
fn a_run_writes_its_report_and_prints_the_table() {
    let folder = Folder::with_scene(SMALL);
    let ran = folder.run_to(0, "run small.toml");
    for name in ["report.json", "report.md", "timings.json"] {
        assert!(folder.path("reports/small").join(name).is_file(), "{name} is missing");
    }
    for shown in
        ["A small study", "Eq. (33)", "1-D regular", "2-D box:0.4", "zero by symmetry", "reports/small"]
    {
        assert!(ran.stdout.contains(shown), "'{shown}' is not in:\n{}", ran.stdout);
    }
    assert!(ran.stdout.contains("4 claims: "), "{}", ran.stdout);
    let markdown = folder.text("reports/small/report.md");
    assert!(markdown.starts_with("# A small study\n"), "{markdown}");
    assert!(markdown.contains("## `own/mine`"), "{markdown}");
    // In a pipe neither colours nor bars: no control character but the ends of lines.
    for text in [&ran.stdout, &ran.stderr] {
        assert!(!text.chars().any(|c| c.is_control() && c != '\n'), "{text:?}");
    }
}

#[test]
fn a_report_fits_the_schema_that_the_program_prints() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml");
    let schema: Value = serde_json::from_str(&folder.run_to(0, "schema report").stdout).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a JSON Schema");
    let report = folder.json("reports/small/report.json");
    let faults: Vec<String> = validator.iter_errors(&report).map(|error| error.to_string()).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    assert_eq!(report["schema"], "remainder-report/1");
    // The schema refuses what is no report.
    let mut without = report.clone();
    without.as_object_mut().expect("an object").remove("claims");
    assert!(!validator.is_valid(&without));
    let mut more = report.clone();
    more["surprise"] = json!(1);
    assert!(!validator.is_valid(&more));
}

#[test]
fn every_fit_that_a_claim_names_is_in_the_report() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml");
    let report = folder.json("reports/small/report.json");
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let known: Vec<Value> = list(&report["fits"]).iter().map(|fit| fit["id"].clone()).collect();
    let named: Vec<Value> =
        list(&report["claims"]).iter().flat_map(|claim| list(&claim["measured"]["fits"])).collect();
    // 2 regular claims and 1 disordered one along two ladders for two disorders, in two dimensions.
    assert_eq!(named.len(), 2 * (2 + 2 * 2), "{named:#?}");
    for id in &named {
        assert!(known.contains(id), "{id} is not among {known:#?}");
    }
    // Every rung of the ladder is there, kept or left out with a reason.
    for fit in list(&report["fits"]) {
        for point in list(&fit["points"]) {
            assert_eq!(point["kept"] == json!(true), point["why"].is_null(), "{point}");
        }
    }
}

#[test]
fn json_on_standard_output_is_the_record_of_the_file() {
    let folder = Folder::with_scene(SMALL);
    let ran = folder.run_to(0, "run small.toml --json");
    assert_eq!(ran.stdout, folder.text("reports/small/report.json"));
    let merged = folder.run_to(0, "merge small.toml --json");
    assert_eq!(merged.stdout, ran.stdout);
}

#[test]
fn times_stand_in_their_own_file() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --threads 2");
    let timings = folder.json("reports/small/timings.json");
    assert!(timings["wall_seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{timings}");
    assert_eq!(timings["threads"], 2);
    assert_eq!(timings["blocks_found_stored"], 0);
    assert!(!folder.text("reports/small/report.json").contains("seconds"));
}

#[test]
fn a_first_look_takes_less_and_says_so() {
    let folder = Folder::with_scene(SMALL);
    folder.run_to(0, "run small.toml --out whole");
    // What the shorter ladders cannot decide stays open.
    let code = folder.run("run small.toml --quick --out first").code;
    assert!([0, 3].contains(&code), "exit {code}");
    let (whole, first) = (folder.json("whole/report.json"), folder.json("first/report.json"));
    assert_eq!(whole["provenance"]["quick"], false);
    assert_eq!(first["provenance"]["quick"], true);
    assert!(first["cost"]["samples"].as_u64() < whole["cost"]["samples"].as_u64());
    assert!(folder.text("first/report.md").contains("A first look"));
}

#[test]
fn the_default_folders_are_those_of_the_scene() {
    let folder = Folder::new();
    folder.write("analyses/mine/scene.toml", SMALL);
    folder.run_to(0, "run analyses/mine");
    assert!(folder.path("reports/mine/report.json").is_file());
    assert!(!folder.blocks(".remainder").is_empty());
    // Nothing was left behind beside whole files.
    let left: Vec<_> =
        folder.snapshot().into_keys().filter(|p| p.extension().is_some_and(|e| e == "tmp")).collect();
    assert!(left.is_empty(), "{left:?}");
}
