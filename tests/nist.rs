//! `measured::fit` against the NIST Statistical Reference Datasets (`tests/fixtures/nist/README.md` tells their origin).
//!
//! Guards `src/measured/fit.rs`. Planted errors that made these tests fail: the rounding error of a double-double product set to
//! zero (Wampler 1, 3–5), and the residual sum of squares divided by the number of points (every set with residuals).

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use remainder::measured::fit::{LinearFit, line, multilinear, polynomial};
use serde_json::Value;

/// Correct digits asked of every certified number, as −log₁₀ of the relative error.
///
/// The decimal data are rounded to `f64` before the fit sees them, a relative change of 1e-16 that the worst of these problems
/// (Longley) amplifies by a few thousand: 12 digits remain. Plain `f64` factorisation keeps 7 on Wampler 5.
const DIGITS: f64 = 12.0;

struct Problem {
    name: &'static str,
    rows: Vec<Vec<f64>>,
    certified: Value,
}

impl Problem {
    fn read(name: &'static str) -> Self {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/nist");
        let csv = std::fs::read_to_string(format!("{folder}/{name}.csv")).unwrap();
        let rows = csv.lines().skip(1).map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect();
        let json = std::fs::read_to_string(format!("{folder}/certified.json")).unwrap();
        let certified = serde_json::from_str::<Value>(&json).unwrap()[name].take();
        let problem = Problem { name, rows, certified };
        assert_eq!(problem.rows.len() as u64, problem.certified["observations"].as_u64().unwrap());
        problem
    }

    fn column(&self, j: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row[j]).collect()
    }

    fn polynomial(&self, degree: usize) -> LinearFit {
        polynomial(&self.column(1), &self.column(0), degree).unwrap()
    }

    fn number(&self, field: &str) -> f64 {
        self.certified[field].as_str().unwrap().parse().unwrap()
    }

    fn numbers(&self, field: &str) -> Vec<f64> {
        self.certified[field]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_str().unwrap().parse().unwrap())
            .collect()
    }

    /// Every `(what, fitted, certified)`; a missing number would be noticed by the count.
    fn pairs(&self, fit: &LinearFit) -> Vec<(String, f64, f64)> {
        let mut pairs = vec![
            ("residual_sd".to_owned(), fit.residual_sd, self.number("residual_sd")),
            ("r_squared".to_owned(), fit.r_squared.unwrap(), self.number("r_squared")),
        ];
        for (field, fitted) in
            [("coefficients", &fit.coefficients), ("standard_errors", &fit.standard_errors)]
        {
            let certified = self.numbers(field);
            assert_eq!(fitted.len(), certified.len(), "{}: {field}", self.name);
            let named = fitted.iter().zip(certified).enumerate();
            pairs.extend(named.map(|(j, (&a, b))| (format!("{field}[{j}]"), a, b)));
        }
        pairs
    }

    /// Holds every number to [`DIGITS`], or to `absolute` where the certified value is exactly zero.
    fn check(&self, fit: &LinearFit, absolute: f64) {
        assert_eq!(fit.degrees_of_freedom, self.rows.len() - fit.coefficients.len());
        let mut fewest: (f64, String) = (f64::INFINITY, "all exact".to_owned());
        for (what, fitted, certified) in self.pairs(fit) {
            if certified == 0.0 {
                println!("{}: {what} = {fitted:e} (certified 0)", self.name);
                assert!(fitted.abs() <= absolute, "{}: {what} = {fitted:e}, certified 0", self.name);
                continue;
            }
            let digits = -((fitted - certified) / certified).abs().log10();
            if digits < fewest.0 {
                fewest = (digits, what.clone());
            }
            assert!(
                digits >= DIGITS,
                "{}: {what} = {fitted:e}, certified {certified:e}, {digits:.1} digits",
                self.name
            );
        }
        println!("{}: at least {:.1} digits ({})", self.name, fewest.0, fewest.1);
    }
}

#[test]
fn norris_line() {
    let problem = Problem::read("norris");
    let points: Vec<_> = problem.rows.iter().map(|row| (row[1], row[0], 1.0)).collect();
    problem.check(&line(&points).unwrap().fit, 0.0);
}

#[test]
fn pontius_quadratic() {
    let problem = Problem::read("pontius");
    problem.check(&problem.polynomial(2), 0.0);
}

#[test]
fn longley_multilinear() {
    let problem = Problem::read("longley");
    let design: Vec<Vec<f64>> = problem.rows.iter().map(|row| [&[1.0], &row[1..]].concat()).collect();
    problem.check(&multilinear(&design, &problem.column(0), None).unwrap(), 0.0);
}

/// Certified residuals are zero. `y` consists of integers below 2²², exact in `f64`, so what is left is double-double rounding,
/// 2⁻¹⁰⁴ × 4e6 ≈ 2e-25, times at most 1e4 for the conditioning of the scaled powers.
#[test]
fn wampler1_exact_integers() {
    let problem = Problem::read("wampler1");
    problem.check(&problem.polynomial(5), 2e-21);
}

/// Certified residuals are zero, but `y` is decimal and at most 63: reading it rounds each value by up to 2⁻⁵³ × 64 ≈ 7e-15,
/// and no standard error exceeds the residual sd by more than the factor 1.01 (ratio of the certified values of Wampler 3).
#[test]
fn wampler2_exact_decimals() {
    let problem = Problem::read("wampler2");
    let fit = problem.polynomial(5);
    problem.check(&fit, 7.2e-15);
    // From the other side: the rounding of the input is there, and an exact zero would mean residuals are not computed.
    assert!(fit.residual_sd > 0.0);
}

#[test]
fn wampler3_to_5_growing_residuals() {
    for name in ["wampler3", "wampler4", "wampler5"] {
        let problem = Problem::read(name);
        problem.check(&problem.polynomial(5), 0.0);
    }
}

/// The same problem through the two entry points: powers formed inside in double-double, or given as integers.
#[test]
fn polynomial_and_multilinear_agree_on_wampler5() {
    let problem = Problem::read("wampler5");
    let design: Vec<Vec<f64>> =
        problem.rows.iter().map(|row| (0..6).map(|j| row[1].powi(j)).collect()).collect();
    let (a, b) = (problem.polynomial(5), multilinear(&design, &problem.column(0), None).unwrap());
    problem.check(&b, 0.0);
    // Same exact problem, solved with differently scaled columns: each rounded once from about 26 remaining digits.
    for (x, y) in a.coefficients.iter().zip(&b.coefficients) {
        assert!((x - y).abs() <= f64::EPSILON * x.abs());
    }
}

/// The certified numbers notice a wrong model: each polynomial is refitted one degree too low.
#[test]
fn a_degree_too_low_is_far_from_certified() {
    for name in ["wampler1", "wampler2", "pontius"] {
        let problem = Problem::read(name);
        let right = if name == "pontius" { 2 } else { 5 };
        let wrong = problem.polynomial(right - 1);
        assert!(wrong.residual_sd > 1.3 * problem.number("residual_sd").max(1e-9), "{name}");
        let certified = problem.numbers("coefficients");
        assert!((wrong.coefficients[0] / certified[0] - 1.0).abs() > 1e-3, "{name}");
    }
}
