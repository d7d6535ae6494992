//! `rms` and `symbol`: what they print, in JSON too, and what they refuse.

use crate::folder::Folder;
use serde_json::Value;

const SPEC: &str =
    "--kernel quintic-spline --lattice square --support-over-dx 3.15 --disorder canonical:0.0625";

fn json(folder: &Folder, line: &str) -> Value {
    serde_json::from_str(&folder.run_to(0, &format!("{line} --json")).stdout).expect("JSON")
}

#[test]
fn an_operators_error_is_split_and_sampled() {
    let folder = Folder::new();
    let report = json(&folder, &format!("rms --operator F4 --field quadratic --sample 4000 {SPEC}"));
    let number = |name: &str| report[name].as_f64().unwrap_or(f64::NAN);
    // From differences of sixth order, tests/fixtures/rms.
    assert!((number("rms") / 0.018_587_479_823_722 - 1.0).abs() < 1e-10, "{report:#}");
    assert_eq!((report["model"].as_str(), report["unit"].as_str()), (Some("linearised"), Some("Δ^1")));
    let components: Vec<f64> =
        report["components"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    assert_eq!(components.len(), 2);
    assert!((components.iter().map(|c| c * c).sum::<f64>().sqrt() / number("rms") - 1.0).abs() < 1e-14);
    assert!(
        number("radius") < 1e-8 * number("rms")
            && number("model_error") > 0.0
            && number("mean").abs() < 1e-12
    );
    let sampled = &report["sampled"];
    let off = sampled["rms"].as_f64().unwrap_or(f64::NAN) - number("rms");
    let allowed = 5.0 * sampled["standard_error"].as_f64().unwrap_or(0.0) + number("model_error");
    assert!(off.abs() < allowed, "{report:#}");
    let text = folder.run_to(0, &format!("rms --operator F4 --field quadratic {SPEC}")).stdout;
    assert!(text.contains("RMS error of F4 on u = x²/2") && text.contains("linearised"), "{text}");
}

#[test]
fn a_moment_is_averaged_over_the_whole_law_unless_told_otherwise() {
    let folder = Folder::new();
    let of = |more: &str| json(&folder, &format!("rms --moment sum_dw {SPEC} {more}"));
    let (finite, linearised, density) =
        (of(""), of("--model linearised"), of("--volume-rule number-density"));
    assert_eq!(finite["model"], "finite");
    assert_eq!(finite["model_error"], 0.0);
    assert_eq!(linearised["model"], "linearised");
    assert_eq!(density["model"], "linearised");
    assert_eq!(finite["component_names"], serde_json::json!(["x", "y"]));
    let rms = |report: &Value| report["rms"].as_f64().unwrap_or(f64::NAN);
    let off = (rms(&finite) - rms(&linearised)).abs();
    assert!(off < 4.0 * linearised["model_error"].as_f64().unwrap_or(0.0) && off > 0.0);
}

#[test]
fn a_symbol_names_what_is_not_seen() {
    let folder = Folder::new();
    let text = folder.run_to(0, "symbol S1-7-F2 --lattice line --support-over-dx 1.5 --waves 4").stdout;
    assert!(text.contains("2 sets that no weight connects") && text.contains("(3.141593)"), "{text}");
    let report = json(&folder, "symbol F4 --lattice line --support-over-dx 1.5 --waves 2");
    let modified = report["waves"][0]["modified"].as_f64().unwrap_or(f64::NAN);
    assert!((modified - 1.0).abs() < 1e-11, "sin(π/2): {report:#}");
}

#[test]
fn wrong_input_says_what_and_where() {
    let folder = Folder::new();
    for (line, says) in [
        (format!("rms --operator F5 {SPEC}"), "there is no operator 'F5'"),
        (format!("rms --moment sum_dx {SPEC}"), "did you mean 'sum_dw'"),
        (format!("rms {SPEC}"), "--operator"),
        (format!("rms --operator F4 --model finite {SPEC}"), "ask for the linearised one"),
        (format!("rms --operator S1-8-F2 --sample 10 {SPEC}"), "leave --sample out"),
        (format!("rms --operator F4 --sample 1 {SPEC}"), "2..=100000000"),
        (
            format!("rms --moment sum_w --model finite --volume-rule number-density {SPEC}"),
            "constant volumes",
        ),
        (
            "rms --operator F4 --kernel wendland-c2 --lattice square --support-over-dx 0 --disorder box:1"
                .into(),
            "R/Δ = 0",
        ),
        (
            "rms --operator F4 --kernel wendland-c2 --lattice square --support-over-dx 0.9 --disorder box:1"
                .into(),
            "B is singular",
        ),
        (
            "rms --operator F4 --kernel wendland-c2 --lattice line --support-over-dx 3 --disorder shear:1"
                .into(),
            "at least 2 dimensions",
        ),
        ("symbol F4 --lattice hcp".into(), "the symbol is a matrix"),
        ("symbol F4 --direction 1,2,3".into(), "has 3 components, not 2"),
        ("symbol F4 --direction z".into(), "leaves the 2 dimensions"),
        ("symbol F4 --direction 0,0".into(), "has no direction"),
    ] {
        let ran = folder.run_to(2, &line);
        assert!(ran.stderr.contains(says) && ran.stdout.is_empty(), "{line}: {}", ran.stderr);
    }
}
