//! `remainder sums` as a process: certified digits against values computed another way, names and components of the
//! contract, closed forms, zeros by symmetry and by value, wrong input.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use assert_cmd::Command;
use remainder::exact::parse_rational;
use serde_json::Value;

fn remainder(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::cargo_bin("remainder").unwrap().arg("sums").args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn json(arguments: &[&str]) -> Value {
    let (code, out, err) = remainder(&[arguments, &["--json"]].concat());
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap()
}

fn entry<'a>(value: &'a Value, name: &str, component: &str) -> &'a Value {
    let moments = value["moments"].as_array().unwrap();
    moments.iter().find(|m| m["name"] == name && m["component"] == component).unwrap()
}

/// Σ W over the square lattice at R = 32 Δ, Wendland C2 with W_0 = 7/π: summed site by site in 60-digit arithmetic by
/// mpmath and by python-flint, which agree (`benches/peers/lattice_sum.py`).
const SUM_W_AT_32: &str = "1.0000000383697132021122460917780159099097597660306161214934";

#[test]
fn fifty_digits_agree_with_direct_summation_elsewhere() {
    let value = json(&[
        "--kernel",
        "wendland-c2",
        "--lattice",
        "square",
        "--support-over-dx",
        "32",
        "--digits",
        "50",
        "--moment",
        "sum_w",
    ]);
    assert_eq!(value["neighbours"], 3204);
    assert_eq!(value["in_support"], 3205);
    let sum = entry(&value, "sum_w", "");
    let number = |text: &Value| parse_rational(text.as_str().unwrap()).unwrap();
    let (found, radius) = (number(&sum["value"]), number(&sum["radius"]));
    assert!(radius < parse_rational("1e-50").unwrap());
    let off = &found - parse_rational(SUM_W_AT_32).unwrap();
    assert!(off <= radius && -off <= radius, "{sum}");
    assert_eq!(sum["value"].as_str().unwrap().split('.').nth(1).unwrap().len(), 50);
}

#[test]
fn every_component_is_named_once_in_the_order_of_the_contract() {
    let value = json(&["--kernel", "wendland-c2", "--lattice", "square", "--support-over-dx", "2.5"]);
    let names: Vec<String> = value["moments"]
        .as_array()
        .unwrap()
        .iter()
        .map(|m| format!("{}:{}", m["name"].as_str().unwrap(), m["component"].as_str().unwrap()))
        .collect();
    assert_eq!(
        names[..9],
        [
            "sum_w:",
            "sum_dw:x",
            "sum_dw:y",
            "b_inverse:xx",
            "b_inverse:xy",
            "b_inverse:yx",
            "b_inverse:yy",
            "sum_rrdw:xxx",
            "sum_rrdw:xxy"
        ]
    );
    let mut unique = names.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), names.len());
    assert_eq!(names.iter().filter(|n| n.starts_with("sum_rrrdw")).count(), 8);
    assert_eq!(entry(&value, "sum_dw", "x")["zero_by"], "symmetry");
    assert_eq!(entry(&value, "b_inverse", "xx")["zero_by"], Value::Null);
    assert_eq!(entry(&value, "sum_rddw", "xyy")["p"], 1);
    assert_eq!(entry(&value, "sum_rddw", "xyy")["q"], 2);
}

/// The cubic spline at R = 2Δ in 1-D has neighbours at q = 1 alone: W″(0) + 2W″(1) = (−2 + 2·1)·σ/Δ³ with
/// w″ = −2 + 3q… = 0: zero, and not by symmetry.
#[test]
fn a_zero_by_value_is_told_from_a_zero_by_symmetry() {
    let scene = ["--kernel", "cubic-spline", "--lattice", "line", "--support-over-dx"];
    let at =
        |support| json(&[&scene[..], &[support, "--moment", "sum_lapw", "--moment", "sum_rlapw"]].concat());
    assert_eq!(entry(&at("2"), "sum_lapw", "")["zero_by"], "value");
    assert_eq!(entry(&at("2"), "sum_rlapw", "x")["zero_by"], "symmetry");
    assert_eq!(entry(&at("2.1"), "sum_lapw", "")["zero_by"], Value::Null);
}

#[test]
fn closed_forms_are_rationals_radicals_or_quotients() {
    let exact = |kernel, lattice, support, rule| {
        let value = json(&[
            "--kernel",
            kernel,
            "--lattice",
            lattice,
            "--support-over-dx",
            support,
            "--volume-rule",
            rule,
            "--moment",
            "b_inverse",
            "--exact",
        ]);
        entry(&value, "b_inverse", "xx")["exact"].as_str().unwrap().to_owned()
    };
    assert_eq!(exact("wendland-c2", "line", "5/2", "constant"), "2976/3125");
    assert_eq!(
        exact("wendland-c2", "square", "5/2", "constant"),
        "4274816/15625·π^-1 - 297472/15625·√2·π^-1 - 68096/625·√5·π^-1"
    );
    assert!(exact("wendland-c2", "square", "5/2", "number-density").contains(")/("));
}

#[test]
fn wrong_input_says_what_and_exits_with_2() {
    let good = ["--kernel", "wendland-c2", "--lattice", "square", "--support-over-dx", "2.5"];
    for (at, bad, words) in [
        (1, "wendland-c3", "did you mean 'wendland-c"),
        (3, "sqare", "did you mean 'square'"),
        (5, "1", "without neighbours"),
        (5, "-2.5", "positive"),
        (5, "0", "positive"),
        (5, "NaN", "NaN"),
        (5, "inf", "inf"),
        (5, "1/0", "1/0"),
        (5, "1e9", "MiB"),
    ] {
        let mut arguments = good;
        arguments[at] = bad;
        let (code, out, err) = remainder(&arguments);
        assert_eq!((code, out.as_str()), (2, ""), "{bad}");
        assert!(err.contains(words) && !err.contains("panicked"), "{bad}: {err}");
    }
    for (extra, words) in [
        (["--moment", "sum_rdx"], "there is no moment sum"),
        (["--volume-rule", "density"], "known rules"),
        (["--digits", "1000000"], "digits"),
    ] {
        let (code, _, err) = remainder(&[&good[..], &extra[..]].concat());
        assert_eq!(code, 2);
        assert!(err.contains(words), "{err}");
    }
}
