//! CSV: everything that the record holds is there, and can be read back.

use crate::folder::Folder;
use crate::{committed, list, report, repository};
use serde_json::Value;
use std::collections::BTreeMap;

/// A file's head and rows.
fn rows(folder: &Folder, name: &str) -> Vec<BTreeMap<String, String>> {
    let path = folder.path(name);
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
    let rows: Result<_, _> = reader.deserialize().collect();
    rows.unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn every_series_fit_and_table_is_there_in_full() {
    let folder = Folder::new();
    for name in committed() {
        let path = repository("reports").join(&name);
        let ran = folder.run_arguments(&["report", path.to_str().expect("UTF-8"), "--csv", "out"]);
        assert_eq!(ran.code, 0, "{name}: {}", ran.stderr);
        let report = report(&name);
        let file = |file: &str| format!("out/{name}/{file}");
        assert_eq!(rows(&folder, &file("verdicts.csv")).len(), list(&report["verdicts"]).len(), "{name}");
        let claims = rows(&folder, &file("claims.csv"));
        assert_eq!(claims.len(), list(&report["claims"]).len(), "{name}");
        let mut told: Vec<[String; 3]> = Vec::new();
        told.extend(claims.iter().map(|row| ["claim", "verdict", "why"].map(|key| row[key].clone())));
        let mut held: Vec<[String; 3]> = Vec::new();
        held.extend(
            list(&report["claims"]).iter().map(|c| ["id", "verdict", "why"].map(|key| text(&c[key]))),
        );
        told.sort();
        held.sort();
        assert_eq!(told, held, "{name}");
        if !list(&report["left_out"]).is_empty() {
            assert_eq!(rows(&folder, &file("left_out.csv")).len(), list(&report["left_out"]).len(), "{name}");
        }
        let fits = list(&report["fits"]);
        if !fits.is_empty() {
            assert_eq!(rows(&folder, &file("fits.csv")).len(), fits.len(), "{name}");
            let points = rows(&folder, &file("fit_points.csv"));
            assert_eq!(points.len(), fits.iter().map(|fit| list(&fit["points"]).len()).sum::<usize>());
            let left_out = points.iter().filter(|point| point["kept"] == "false").count();
            let expected = fits.iter().flat_map(|fit| list(&fit["points"])).filter(|p| p["kept"] == false);
            assert_eq!(left_out, expected.count(), "{name}");
        }
        for (table, expected) in report["tables"].as_object().into_iter().flatten() {
            let found = rows(&folder, &file(&format!("tables/{table}.csv")));
            assert_eq!(found.len(), list(expected).len(), "{name}: {table}");
            for (row, expected) in found.iter().zip(list(expected)) {
                for (key, value) in expected.as_object().expect("a row") {
                    same(&row[key], value, &format!("{name}: {table}: {key}"));
                }
            }
        }
        let series = list(&report["series"]);
        if !series.is_empty() {
            let index = rows(&folder, &file("series.csv"));
            assert_eq!(index.len(), series.len(), "{name}");
            for (row, series) in index.iter().zip(series) {
                assert_eq!(
                    (&row["series"], &row["y_unit"]),
                    (&text(&series["id"]), &text(&series["y"]["unit"]))
                );
                let found = rows(&folder, &file(&row["file"]));
                let lines = list(&series["lines"]);
                let points = lines.iter().flat_map(|line| list(&line["points"]));
                assert_eq!(found.len(), points.clone().count(), "{name}: {}", row["series"]);
                for (row, point) in found.iter().zip(points) {
                    same(&row["x"], &point[0], "x");
                    same(&row["y"], &point[1], "y");
                }
            }
        }
    }
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// A field says what the record says, to the last bit.
fn same(field: &str, value: &Value, what: &str) {
    match value {
        Value::String(text) => assert_eq!(field, text, "{what}"),
        Value::Null => assert_eq!(field, "", "{what}"),
        Value::Number(number) => {
            assert_eq!(field.parse::<f64>().expect("a number"), number.as_f64().expect("finite"), "{what}");
        }
        other => assert_eq!(field, other.to_string(), "{what}"),
    }
}

#[test]
fn every_number_of_a_claim_is_an_estimate_with_its_interval() {
    let folder = Folder::new();
    let path = repository("reports/chaussonnet-2015");
    let ran = folder.run_arguments(&["report", path.to_str().expect("UTF-8"), "--csv", "out"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""));
    ran.says(&["Written to out."]);
    let estimates = rows(&folder, "out/chaussonnet-2015/estimates.csv");
    let report = report("chaussonnet-2015");
    let mut expected = 0;
    for claim in list(&report["claims"]) {
        for column in ["published", "derived", "measured"] {
            let column = &claim[column];
            expected += column["exponents"].as_object().map_or(0, serde_json::Map::len);
            expected += usize::from(!column["value"].is_null());
            for (field, inner) in [("zero", "bound"), ("trend", "slope")] {
                expected +=
                    usize::from(!column[field].is_null()) + usize::from(!column[field][inner].is_null());
            }
            let relation = &column["relation"];
            expected += usize::from(!relation.is_null());
            expected +=
                ["left_value", "right_value"].iter().filter(|side| !relation[**side].is_null()).count();
        }
    }
    assert_eq!(estimates.len(), expected);
    assert!(estimates.iter().any(|row| row["unit"] == "1"), "no unit");
    let fitted = estimates.iter().find(|row| row["by"] == "fit" && row["low"] != row["high"]).expect("a fit");
    let number = |key: &str| fitted[key].parse::<f64>().expect("a number");
    assert!(number("low") < number("value") && number("value") < number("high"), "{fitted:?}");
}

#[test]
fn names_lead_nowhere_else_and_do_not_meet() {
    let folder = Folder::new();
    let mut report = report("fatehi-table-1");
    report["provenance"]["scene"] = "../../away".into();
    report["tables"] =
        serde_json::json!({"a/b": [{"x": 1}], "a b": [{"x": 2}], "A b": [{"x": "1,5 \"m\"\n"}]});
    folder.write("here/report.json", report.to_string());
    folder.run_to(0, "report here here/report.json --csv here/out");
    let outside = |path: &std::path::PathBuf| !path.starts_with(folder.path("here"));
    assert!(!folder.snapshot().keys().any(|path| outside(path) && *path != folder.path("here")));
    let tables = |name: &str| rows(&folder, &format!("here/out/.._.._away/tables/{name}.csv"));
    assert_eq!(tables("a_b-2")[0]["x"], "2");
    assert_eq!(tables("a_b-3")[0]["x"], "1");
    assert_eq!(tables("A_b")[0]["x"], "1,5 \"m\"\n");
    assert!(folder.path("here/out/.._.._away-2/verdicts.csv").is_file());
}
