//! Scenes of kind `extremes` and `work-precision`: what they say, what they refuse, and that nothing of the clock enters a report.

use crate::folder::Folder;
use serde_json::Value;

const EXTREMES: &str = "[study]\nkind = \"extremes\"\n\n[survey]\noperators = [\"F2\", \"F4\", \"S3\", \"S4\", \"shepard-hessian\"]\n\
                        supports = [1.2]\njitters = [0.3]\npairs = [1e-12, 0]\naspects = [10]\nlength_powers = [-494, 494]\n\
                        field_powers = [996]\norigins = [1e8]\nconstants = [1e12]\ndecades = [10]\n\
                        \n[expect]\n\"extremes/loss-foretold\" = \"confirmed\"\n\"extremes/powers-of-two\" = \"confirmed\"\n";

fn rows(report: &Value, table: &str) -> Vec<Value> {
    report["tables"][table].as_array().cloned().unwrap_or_default()
}

#[test]
fn extreme_cases_are_accurate_degraded_or_refused_and_never_unnoticed() {
    let folder = Folder::new();
    folder.write("ends.toml", EXTREMES);
    folder.run_to(0, "run ends.toml --out out --threads 1");
    folder.run_to(0, "run ends.toml --out again --store other --threads 2");
    assert_eq!(folder.bytes("out/report.json"), folder.bytes("again/report.json"));
    let report = folder.json("out/report.json");
    let rows = rows(&report, "extremes");
    assert_eq!(rows.len(), 2 * 5 * (1 + 1 + 4 + 3 + 1 + 2 + 1 + 1 + 1 + 1));
    let in_dimension = |dimension: usize, situation: &str, operator: &str| {
        let is = |row: &&Value| {
            row["dimension"] == dimension && row["situation"] == situation && row["operator"] == operator
        };
        rows.iter().find(is).cloned().unwrap_or_else(|| panic!("no {operator} {situation}"))
    };
    let of = |situation: &str, operator: &str| in_dimension(2, situation, operator);
    assert_eq!(in_dimension(3, "R/Δ = 1.2", "F2")["neighbours"], 6);
    assert_eq!(in_dimension(3, "R/Δ = 1.2", "S4")["status"], "refused");
    assert_eq!(in_dimension(3, "on a line", "F4")["status"], "refused");
    // One eighth of the neighbours says less of B̂ than all of them.
    let condition = |situation: &str| in_dimension(3, situation, "S4")["condition_b_hat"].as_f64();
    assert!(condition("in a corner") > condition("moved by up to 0.3 Δ along each axis"));
    assert!(
        report["claims"]
            .as_array()
            .into_iter()
            .flatten()
            .all(|claim| claim["measured"]["value"]["value"] == "0")
    );
    // Four neighbours on the axes do not tell xy apart.
    let s4 = of("R/Δ = 1.2", "S4");
    assert!(s4["status"] == "refused" && s4["reason"].as_str().is_some_and(|why| why.contains("B̂")), "{s4}");
    assert_eq!(of("R/Δ = 1.2", "F2")["neighbours"], 4);
    let on_a_line = of("on a line", "F4");
    assert!(
        on_a_line["status"] == "refused" && on_a_line["reason"].as_str().is_some_and(|w| w.contains("B"))
    );
    // Storing u + 10¹² costs digits; taking differences costs no more.
    let shepard = of("1e12 added to u", "shepard-hessian");
    assert!(shepard["digits_lost_in_data"].as_f64().is_some_and(|digits| digits > 9.0), "{shepard}");
    assert!(shepard["digits_lost"].as_f64().is_some_and(|digits| digits < 4.0), "{shepard}");
    for row in &rows {
        let (lost, predicted) = (row["digits_lost"].as_f64(), row["digits_lost_predicted"].as_f64());
        assert_eq!(row["status"] == "refused", lost.is_none(), "{row}");
        assert!(lost.zip(predicted).is_none_or(|(lost, predicted)| lost <= predicted + 0.01), "{row}");
        assert!(row["status"] == "accurate" || row["reason"].is_string(), "{row}");
    }
}

const WORK: &str = "[study]\nkind = \"work-precision\"\n\n[survey]\nderivatives = [\"laplacian\"]\noperators = [\"S3\", \"S4\"]\n\
                    kernels = [\"wendland-c2\"]\nsupport_over_dx = [1.5, 2.5]\ndisorders = [\"none\", \"box:0.2\"]\nwavelength = 12\n";

#[test]
fn nothing_on_a_front_is_beaten_and_no_second_enters_the_report() {
    let folder = Folder::new();
    folder.write("work.toml", WORK);
    folder.run_to(0, "run work.toml --out out --threads 1");
    folder.run_to(0, "run work.toml --out again --store other --threads 2");
    assert_eq!(folder.bytes("out/report.json"), folder.bytes("again/report.json"));
    let report = folder.json("out/report.json");
    let points = rows(&report, "work_precision");
    assert_eq!(points.len(), 2 * 2 * 2);
    let number = |row: &Value, key: &str| row[key].as_f64().unwrap_or(f64::NAN);
    for row in rows(&report, "fronts") {
        let by = row["by"].as_str().expect("a cost");
        let own = points.iter().filter(|point| point["disorder"] == row["disorder"]);
        let better = own.filter(|point| {
            number(point, by) <= number(&row, "cost")
                && number(point, "error_measured") < number(&row, "error")
        });
        assert_eq!(better.count(), 0, "{row}");
    }
    // S4 has the weights of S3, and more to do for each.
    let of = |operator: &str, key: &str| {
        let found = points.iter().find(|p| p["operator"] == operator && p["support_over_dx"] == 1.5);
        found.map_or(f64::NAN, |point| number(point, key))
    };
    assert_eq!(of("S3", "flops_applied"), of("S4", "flops_applied"));
    assert!(of("S4", "flops_direct") > 2.0 * of("S3", "flops_direct"));
    assert_eq!(of("S3", "neighbours"), 8.0);
    let timed = &folder.json("out/timings.json")["timed"]["fronts"];
    assert!(timed.as_array().is_some_and(|fronts| !fronts.is_empty()), "{timed}");
}

#[test]
fn bad_batteries_are_refused_at_their_place() {
    let folder = Folder::new();
    for (kind, line, word) in [
        ("extremes", "kernel = \"gaussian\"", "twice the digits"),
        ("extremes", "aspects = [1e6]", "1000"),
        ("extremes", "operators = [\"F9\"]", "F9"),
        ("extremes", "dimensions = [1]", "neither 2 nor 3"),
        ("extremes", "dimensions = []", "names none"),
        ("work-precision", "disorders = [\"box:x\"]", "box"),
        ("work-precision", "support_over_dx = [40]", "40"),
        ("work-precision", "operators = [\"MEA\"]", "MEA"),
        ("work-precision", "derivatives = [\"curl\"]", "curl"),
    ] {
        folder.write("bad.toml", format!("[study]\nkind = \"{kind}\"\n[survey]\n{line}\n"));
        let ran = folder.run_to(2, "run bad.toml --out out");
        assert!(ran.stderr.contains(word) && ran.stderr.contains("bad.toml:4"), "{line}: {}", ran.stderr);
        assert!(!folder.path("out").exists());
    }
}
