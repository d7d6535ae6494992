//! Report schema 1: the hand-written samples, one for each kind of claim and of run, validate against the schema the
//! program prints, and are read and written back without loss.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use jsonschema::Validator;
use remainder::report::{ClaimKind, Report};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn validator() -> Validator {
    let schema = schemars::schema_for!(Report);
    jsonschema::validator_for(schema.as_value()).unwrap()
}

fn samples() -> Vec<(String, Value)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/reports");
    let mut samples: Vec<(String, Value)> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            (name, serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap())
        })
        .collect();
    samples.sort_by(|a, b| a.0.cmp(&b.0));
    samples
}

/// Objects without the keys whose value is null or an empty list: what is missing and what is nothing are the same.
fn bare(value: &Value) -> Value {
    match value {
        Value::Object(map) => map
            .iter()
            .map(|(key, value)| (key.clone(), bare(value)))
            .filter(|(_, value)| !value.is_null() && *value != json!([]))
            .collect::<serde_json::Map<_, _>>()
            .into(),
        Value::Array(list) => list.iter().map(bare).collect::<Vec<_>>().into(),
        // 12 and 12.0 are one number.
        Value::Number(number) => json!(number.as_f64()),
        other => other.clone(),
    }
}

#[test]
fn every_sample_validates_and_survives_reading_and_writing() {
    let validator = validator();
    let samples = samples();
    assert_eq!(samples.len(), 8);
    for (name, value) in &samples {
        let faults: Vec<String> =
            validator.iter_errors(value).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert!(faults.is_empty(), "{name}: {faults:?}");
        let report: Report = serde_json::from_value(value.clone()).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(bare(&serde_json::to_value(&report).unwrap()), bare(value), "{name}");
    }
}

#[test]
fn the_samples_cover_every_kind_of_claim_a_cloud_and_a_run() {
    let reports: Vec<Report> =
        samples().into_iter().map(|(_, value)| serde_json::from_value(value).unwrap()).collect();
    let claims = || reports.iter().flat_map(|report| &report.claims);
    use ClaimKind::{Constant, Inequality, PowerLaw, Ratio, Trend, Zero};
    for kind in [PowerLaw, Constant, Ratio, Zero, Trend, Inequality] {
        assert!(claims().any(|claim| claim.kind == kind), "{kind:?}");
    }
    assert!(claims().any(|claim| claim.case.source == "cloud" && claim.case.more.contains_key("file")));
    assert!(reports.iter().any(|report| !report.runs.is_empty()));
}

#[test]
fn the_schema_refuses_what_is_no_report() {
    let validator = validator();
    let (_, good) = samples().remove(0);
    for (path, value) in [
        ("/claims/0/verdict", json!("true")),
        ("/claims/0/kind", json!("law")),
        ("/provenance/seed", json!("one")),
        ("/claims/0/citation", json!({"source": "fatehi-manzari-2011"})),
    ] {
        let mut bad = good.clone();
        *bad.pointer_mut(path).unwrap() = value;
        assert!(!validator.is_valid(&bad), "{path}");
    }
    let mut extra = good.clone();
    extra["unknown"] = json!(1);
    assert!(!validator.is_valid(&extra));
}

/// The committed reports are reports.
#[test]
fn lines_of_a_figure_can_be_told_apart() {
    // Seen to fail where a lattice came twice, with two disorders.
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports");
    for entry in fs::read_dir(folder).unwrap() {
        let Ok(text) = fs::read_to_string(entry.unwrap().path().join("report.json")) else { continue };
        let Ok(report) = serde_json::from_str::<Report>(&text) else { continue };
        let ids: BTreeSet<&str> = report.series.iter().map(|series| series.id.as_str()).collect();
        assert_eq!(ids.len(), report.series.len(), "{}", report.provenance.scene);
        for series in &report.series {
            let names: BTreeSet<&str> = series.lines.iter().map(|line| line.name.as_str()).collect();
            assert_eq!(names.len(), series.lines.len(), "{} {}", report.provenance.scene, series.id);
        }
    }
}

#[test]
fn the_committed_reports_validate() {
    let validator = validator();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reports");
    let mut read = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path().join("report.json");
        // The index of the pages is a file among the folders. Expansions are no study: text, LaTeX, and printed equations beside derived ones.
        let folder = path.parent().unwrap();
        if folder.is_file() || !path.exists() && folder.ends_with("expansions") {
            continue;
        }
        let value: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
        let faults: Vec<String> = validator.iter_errors(&value).map(|e| e.to_string()).collect();
        assert!(faults.is_empty(), "{}: {faults:?}", path.display());
        let report: Report = serde_json::from_value(value).unwrap();
        assert!(report.claims.iter().all(|claim| claim.published.is_some() && !claim.why.is_empty()));
        read += 1;
    }
    assert!(read > 0);
}
