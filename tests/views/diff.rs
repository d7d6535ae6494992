//! Differences of two reports: which verdicts and numbers, by how many standard errors.

use crate::folder::Folder;
use crate::{committed, report, repository};
use serde_json::{Value, json};

fn folder_with(before: &Value, after: &Value) -> Folder {
    let folder = Folder::new();
    folder.write("a.json", before.to_string());
    folder.write("b.json", after.to_string());
    folder
}

fn difference(before: &Value, after: &Value) -> (i32, Value, String) {
    let folder = folder_with(before, after);
    let json = folder.run("diff a.json b.json --json");
    let text = folder.run("diff a.json b.json");
    assert_eq!(json.code, text.code);
    (json.code, serde_json::from_str(&json.stdout).expect("JSON"), text.stdout)
}

#[test]
fn a_report_does_not_differ_from_itself() {
    let folder = Folder::new();
    for name in committed() {
        let path = repository("reports").join(name);
        let path = path.to_str().expect("UTF-8");
        let ran = folder.run_arguments(&["diff", path, path]);
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
        assert!(ran.stdout.starts_with("No verdict"), "{}", ran.stdout);
    }
}

/// Student's t for 95 % and three degrees of freedom, and the normal quantile, from printed tables.
const T_3: f64 = 3.182_446_305;
const NORMAL: f64 = 1.959_963_985;

#[test]
fn a_fitted_exponent_differs_by_its_standard_errors() {
    let mut before = report("fatehi-table-1");
    let fit = before["claims"][0]["measured"]["fits"][0].clone();
    let exponent = |value: f64| json!({"value": value, "low": value - 0.3, "high": value + 0.3, "by": "fit"});
    let fits = before["fits"].as_array_mut().expect("fits");
    let named = fits.iter_mut().find(|entry| entry["id"] == fit).expect("the fit");
    named["degrees_of_freedom"] = json!(3);
    named["slope"] = exponent(2.0);
    before["claims"][0]["measured"]["exponents"]["dx_over_h"] = exponent(2.0);
    before["claims"][0]["measured"]["fits"] = json!([fit]);
    let mut after = before.clone();
    after["claims"][0]["measured"]["exponents"]["dx_over_h"] = exponent(2.4);
    let (code, found, text) = difference(&before, &after);
    assert_eq!(code, 1);
    let changes = found["values"].as_array().expect("values");
    assert_eq!(changes.len(), 1, "{found:#}");
    assert_eq!(changes[0]["quantity"], "measured: exponent of Δ/h");
    assert_eq!(changes[0]["list"], "claims");
    let expected = 0.4 / (std::f64::consts::SQRT_2 * 0.3 / T_3);
    let errors = changes[0]["standard_errors"].as_f64().expect("a number");
    assert!((errors - expected).abs() < 1e-6, "{errors} and {expected}");
    assert!((changes[0]["difference"].as_f64().expect("a number") - 0.4).abs() < 1e-12);
    assert!(text.contains("2 [1.7, 2.3] → 2.4 [2.1, 2.7]"), "{text}");
    assert!(text.contains("Changed: 0 verdicts, 1 numbers (by up to "), "{text}");
    // The fit itself, with its own degrees of freedom.
    let mut other = before.clone();
    let fits = other["fits"].as_array_mut().expect("fits");
    fits.iter_mut().find(|entry| entry["id"] == fit).expect("the fit")["slope"] = exponent(1.9);
    let (_, found, _) = difference(&before, &other);
    let slope = &found["values"][0];
    assert_eq!((&slope["list"], &slope["quantity"]), (&json!("fits"), &json!("slope")));
    let errors = slope["standard_errors"].as_f64().expect("a number");
    assert!((errors - 0.1 / (std::f64::consts::SQRT_2 * 0.3 / T_3)).abs() < 1e-6, "{errors}");
}

#[test]
fn constants_differ_exactly_or_by_their_intervals() {
    let before = report("basa-2009");
    let mut after = before.clone();
    after["viscosity_constants"][7]["derived"] = json!(12.0);
    let (code, found, _) = difference(&before, &after);
    let change = &found["values"][0];
    assert_eq!((code, found["values"].as_array().map(Vec::len)), (1, Some(1)));
    assert_eq!((&change["list"], &change["quantity"]), (&json!("viscosity_constants"), &json!("derived")));
    assert_eq!((&change["after"], &change["standard_errors"]), (&json!(12.0), &Value::Null));
    let before = report("chaussonnet-2015");
    let mut after = before.clone();
    let size = &mut after["inferred_domain_size"][0];
    let value = |size: &Value, key: &str| size[key].as_f64().expect("a number");
    let width = (value(size, "high") - value(size, "low")) / 2.0;
    let moved = value(size, "value_m") + width;
    size["value_m"] = json!(moved);
    let (_, found, _) = difference(&before, &after);
    let errors = found["values"][0]["standard_errors"].as_f64().expect("a number");
    assert!((errors - NORMAL / std::f64::consts::SQRT_2).abs() < 1e-6, "{errors}");
    let mut after = before.clone();
    after["laplacian_factors"][0]["published"] = json!(0.25);
    after["tables"]["fits"][0]["measured"] = json!(1);
    after["series"][0]["lines"][0]["points"][0][1] = json!(1);
    let (_, found, text) = difference(&before, &after);
    assert_eq!(found["values"][0]["list"], "laplacian_factors");
    let lists: Vec<&str> = found["lists"]
        .as_array()
        .expect("lists")
        .iter()
        .filter_map(|change| change["list"].as_str())
        .collect();
    assert_eq!(lists, ["series", "tables"]);
    assert!(text.contains("tables: fits: 1 of 28 rows differ"), "{text}");
}

#[test]
fn rationals_are_compared_by_value() {
    let mut before = report("fatehi-table-2");
    let exponent = |text: &str| json!({"value": text, "low": text, "high": text, "by": "derivation"});
    before["claims"][0]["derived"]["exponents"]["dx_over_h"] = exponent("3/2");
    let mut after = before.clone();
    after["claims"][0]["derived"]["exponents"]["dx_over_h"] = exponent("6/4");
    assert_eq!(difference(&before, &after).0, 0);
    after["claims"][0]["derived"]["exponents"]["dx_over_h"] = exponent("5/2");
    let (code, found, text) = difference(&before, &after);
    assert_eq!((code, &found["values"][0]["difference"]), (1, &json!(1.0)));
    assert!(text.contains("derived: exponent of Δ/h: 3/2 → 5/2  by 1\n"), "{text}");
}

#[test]
fn verdicts_cases_and_fits_come_and_go() {
    let before = report("fatehi-table-2");
    let mut after = before.clone();
    after["verdicts"][1]["verdict"] = json!("refuted");
    after["verdicts"][1]["why"] = json!("a new reason");
    after["claims"][3]["verdict"] = json!("inconclusive");
    after["claims"].as_array_mut().expect("claims").remove(0);
    after["fits"][0]["id"] = json!("another");
    after["provenance"]["seed"] = json!(5);
    let (code, found, text) = difference(&before, &after);
    assert_eq!(code, 1);
    let verdicts = found["verdicts"].as_array().expect("verdicts");
    assert_eq!(verdicts.len(), 2, "{found:#}");
    assert!(
        text.contains("fatehi-table-2/b_inverse#regular: confirmed → refuted\n    a new reason"),
        "{text}"
    );
    assert_eq!(found["added"][0]["item"], "another");
    assert_eq!(found["removed"].as_array().map(Vec::len), Some(2));
    assert_eq!(found["provenance"]["seed"], json!([2011, 5]));
    // What made a report is said, and is no change.
    let mut seed = before.clone();
    seed["provenance"]["seed"] = json!(5);
    assert_eq!(difference(&before, &seed).0, 0);
}

#[test]
fn what_is_no_report_of_ours_is_wrong_input() {
    let before = report("fatehi-table-1");
    let folder = folder_with(&before, &before);
    let mut newer = before.clone();
    newer["schema"] = json!("remainder-report/2");
    newer["surprise"] = json!({"a": 1});
    folder.write("newer.json", newer.to_string());
    folder.run_to(2, "diff a.json newer.json").says(&[
        "newer.json",
        "'remainder-report/2'",
        "newer than",
        "remainder-report/1",
    ]);
    folder.run_to(2, "report newer.json").says(&["newer than"]);
    newer["schema"] = json!("remainder-report/0");
    folder.write("older.json", newer.to_string());
    folder
        .run_to(2, "diff older.json a.json")
        .says(&["older.json is no remainder-report/1", "its schema is"]);
    folder.write("text.json", "{}");
    folder.run_to(2, "diff text.json a.json").says(&["text.json", "schema"]);
    folder.run_to(2, "diff a.json nowhere").says(&["cannot read nowhere", "name a report.json"]);
    folder.run_to(2, "diff a.json .").says(&["cannot read ./report.json"]);
    folder.run_to(2, "diff a.json");
    folder.run_to(2, "report");
}
