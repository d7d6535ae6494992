//! `advise`: an answer that meets what was asked, and refusals that say what to change.

use crate::folder::Folder;
use serde_json::Value;

#[test]
fn the_cheapest_that_meets_the_tolerance_comes_first() {
    let folder = Folder::new();
    let line = "advise --laplacian --tolerance 0.02 --dim 1 --disorder box:0.2";
    let advice: Value =
        serde_json::from_str(&folder.run_to(0, &format!("{line} --json")).stdout).expect("JSON");
    let number = |of: &str, name: &str| advice[of][name].as_f64().unwrap_or(f64::NAN);
    assert!(number("best", "error") <= 0.02 && number("runner_up", "error") <= 0.02, "{advice:#}");
    assert!(number("best", "weights") <= number("runner_up", "weights"));
    assert!(advice["evaluated"].as_u64() > Some(0) && advice["left_out"].as_u64() > Some(0));
    // The error of the best one is that of `rms`, field by field.
    let by_order = advice["best"]["by_order"].as_array().expect("orders");
    let k = 2.0 * std::f64::consts::PI / 100.0;
    for (m, field) in ["constant", "linear", "quadratic"].into_iter().enumerate() {
        let (operator, kernel) = (&advice["best"]["operator"], &advice["best"]["kernel"]);
        let (operator, kernel) = (operator.as_str().expect("id"), kernel.as_str().expect("id"));
        let support = number("best", "support_over_dx");
        let line = format!(
            "rms --operator {operator} --field {field} --kernel {kernel} --lattice line --support-over-dx {support} \
             --disorder box:0.2 --json"
        );
        let rms: Value = serde_json::from_str(&folder.run_to(0, &line).stdout).expect("JSON");
        let expected = rms["rms"].as_f64().unwrap_or(f64::NAN) * k.powi(m as i32 - 2);
        let found = by_order[m].as_f64().unwrap_or(f64::NAN);
        assert!((found - expected).abs() <= 1e-9 * expected.abs() + 1e-12, "m = {m}: {found} and {expected}");
    }
    let text = folder.run_to(0, line).stdout;
    assert!(["take", "runner-up", "weights a row"].iter().all(|part| text.contains(part)), "{text}");
}

#[test]
fn what_cannot_be_met_is_refused_with_the_nearest() {
    let folder = Folder::new();
    folder.run_to(2, "advise --tolerance 1e-14 --dim 1 --disorder box:0.4 --budget-neighbours 4").says(&[
        "nothing meets a tolerance of",
        "the best is",
        "raise --tolerance",
    ]);
    folder.run_to(2, "advise --tolerance 0.1 --dim 2 --budget-neighbours 3").says(&["4 nearest neighbours"]);
    folder.run_to(2, "advise --tolerance 0 --dim 2").says(&["must be finite and positive"]);
    folder.run_to(2, "advise --tolerance 0.1 --dim 4").says(&["1, 2 or 3"]);
    folder.run_to(2, "advise --tolerance 0.1 --dim 1 --wavelength 1").says(&["shorter than 2 Δ"]);
}
