//! `orders`: what it prints, as text and as JSON, and what it says of wrong input.

use crate::folder::Folder;
use serde_json::Value;

#[test]
fn every_moment_gets_its_orders() {
    let folder = Folder::new();
    let ran = folder.run_to(0, "orders --kernel wendland-c2 --dim 2 --moment b_inverse --moment sum_dw");
    for says in [
        "wendland-c2 on square, 2-D: R = 1 h, β = 3",
        "regular: S − limit ~ (Δ/h)^9/2; S itself has a limit",
        "the jump of derivative 4 at R (Δ/h)^9/2, oscillating",
        "r^3 at the origin (Δ/h)^5",
        "zero at R/Δ = ",
        "box: d̃ h^-1 (Δ/h); the random walk over the neighbours",
        "offset: d̃^2 h^-2 (Δ/h)^2; the particle's own term",
        "shear: d̃ h^-1 (Δ/h)^7/2",
        "paper: β+1 = 4 (regular-deviation, Table 2, row 3",
        "regular: zero by symmetry, of no order",
    ] {
        assert!(ran.stdout.contains(says), "{says}:\n{}", ran.stdout);
    }
    let wide = ran.stdout.lines().find(|line| line.chars().count() > 100);
    assert!(wide.is_none(), "{wide:?}");
}

#[test]
fn json_holds_exact_exponents() {
    let folder = Folder::new();
    let ran = folder.run_to(
        0,
        "orders --kernel cubic-spline --lattice line --moment b_inverse --disorder offset --disorder wave:0.1,wavelength=8,unit=dx \
         --spectrum 1 --from 3 --to 5 --json",
    );
    let report: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    let moment = &report["moments"][0];
    assert_eq!(moment["deviation"], "3");
    assert_eq!(moment["value"], "0");
    assert_eq!(moment["contributions"][0]["source"], "knot");
    let component = &moment["components"][0];
    assert_eq!(component["exponent"], "3");
    let crossings = component["zero_crossings"].as_array().expect("a list");
    assert!(!crossings.is_empty());
    assert!(
        crossings.iter().all(|u| u[0].as_f64().is_some_and(|u| (3.0..5.0).contains(&u))),
        "{crossings:?}"
    );
    let disorder: Vec<&str> = moment["disorder"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|d| d["disorder"].as_str())
        .collect();
    assert_eq!(disorder, ["offset", "wave:0.1,wavelength=8,unit=dx", "spectrum k^1"]);
    assert_eq!(moment["disorder"][2]["terms"][0]["dx_over_h"], "1");
    assert_eq!(moment["published"][1]["printed"], "β+1");
}

#[test]
fn what_cannot_be_derived_is_said_in_its_place() {
    let folder = Folder::new();
    let ran = folder.run_to(0, "orders --kernel gaussian --dim 2 --moment sum_w --disorder none");
    assert!(ran.stdout.contains("does not converge absolutely"), "{}", ran.stdout);
    let ran = folder.run_to(0, "orders --kernel wendland-c2 --dim 1 --moment sum_w --disorder shear");
    assert!(ran.stdout.contains("shear: shear needs at least 2 dimensions"), "{}", ran.stdout);
}

#[test]
fn wrong_input_says_what_to_do() {
    let folder = Folder::new();
    for (arguments, says) in [
        ("--kernel quintic-splin --dim 3", "did you mean 'quintic-spline'"),
        ("--kernel quintic-spline", "--dim 1, 2 or 3, or --lattice ID"),
        ("--kernel quintic-spline --dim 4", "--dim is 4: it must be 1, 2 or 3"),
        ("--kernel quintic-spline --dim 3 --lattice square", "lattice 'square' is 2-D, not 3-D"),
        ("--kernel quintic-spline --dim 3 --lattice square", "simple-cubic, bcc, fcc, hcp"),
        ("--kernel quintic-spline --lattice squar", "did you mean 'square'"),
        ("--kernel quintic-spline --dim 2 --moment sum_dv", "did you mean 'sum_dw'"),
        ("--kernel quintic-spline --dim 2 --disorder boxx", "did you mean 'box'"),
        ("--kernel quintic-spline --dim 2 --from 5 --to 3", "0 < --from < --to"),
        ("--kernel quintic-spline --dim 2 --spectrum k", "k"),
    ] {
        let ran = folder.run_to(2, &format!("orders {arguments}"));
        assert!(ran.stderr.contains(says) && ran.stdout.is_empty(), "{arguments}: {}", ran.stderr);
    }
}
