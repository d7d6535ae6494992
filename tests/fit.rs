//! `measured::fit` against cases done by hand, and the refusals of its public functions.
//!
//! Guards `src/measured/fit.rs`. Planted error that made the tests of Student's t fail: one tail given the whole of 1 − coverage.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use remainder::measured::fit::{line, multilinear, polynomial, student_t};
use remainder::measured::{FitError, Input};

/// Relative agreement asked of Student's t: reports print eight digits.
const T_ACCURACY: f64 = 1e-8;

#[test]
fn t_quantile_agrees_with_closed_forms() {
    for coverage in [0.05, 0.1, 0.5, 0.68, 0.9, 0.95, 0.99, 0.999] {
        let cauchy = (std::f64::consts::FRAC_PI_2 * coverage).tan();
        let two = coverage * (2.0 / (1.0 - coverage * coverage)).sqrt();
        for (nu, exact) in [(1, cauchy), (2, two)] {
            let t = student_t(coverage, nu).unwrap();
            assert!((t / exact - 1.0).abs() < T_ACCURACY, "nu {nu}, {coverage}: {t} for {exact}");
        }
    }
}

#[test]
fn t_quantile_agrees_with_printed_tables() {
    // Abramowitz & Stegun, table 26.10, prints three decimals; the further ones are 50-digit quadrature of
    // P(|T| ≤ t) ∝ ∫ (1 − s²)^((ν−2)/2) ds over 0 ≤ s ≤ t/√(ν + t²).
    for (coverage, nu, exact) in [
        (0.95, 3, 3.182_446_305_283_7),
        (0.95, 5, 2.570_581_835_636_3),
        (0.5, 8, 0.706_386_612_644_8),
        (0.9, 10, 1.812_461_122_811_7),
        (0.95, 10, 2.228_138_851_986_3),
        (0.99, 10, 3.169_272_672_617_0),
        (0.95, 30, 2.042_272_456_301_2),
        (0.99, 30, 2.749_995_653_567_2),
        (0.95, 60, 2.000_297_822_014_3),
        (0.95, 120, 1.979_930_405_082_4),
    ] {
        let t = student_t(coverage, nu).unwrap();
        assert!((t / exact - 1.0).abs() < T_ACCURACY, "nu {nu}, {coverage}: {t} for {exact}");
    }
}

#[test]
fn t_quantile_refuses_what_has_no_meaning() {
    for coverage in [0.0, 1.0, -0.5, f64::NAN] {
        assert!(matches!(student_t(coverage, 3), Err(FitError::Coverage { .. })));
    }
    assert!(matches!(student_t(0.9, 0), Err(FitError::TooFewPoints { .. })));
}

#[test]
fn a_weight_acts_as_a_repeated_point() {
    let (x, y) = ([0.0, 1.0, 2.0, 4.0], [1.0, 2.5, 2.0, 6.0]);
    let weighted: Vec<_> = (0..4).map(|i| (x[i], y[i], if i == 1 { 3.0 } else { 1.0 })).collect();
    let mut repeated: Vec<_> = (0..4).map(|i| (x[i], y[i], 1.0)).collect();
    repeated.extend([repeated[1]; 2]);
    let (a, b) = (line(&weighted).unwrap(), line(&repeated).unwrap());
    // Both are the exact fit rounded once from 106 bits.
    assert!((a.slope - b.slope).abs() <= f64::EPSILON * b.slope.abs());
    assert!((a.intercept - b.intercept).abs() <= f64::EPSILON * b.intercept.abs());
    for j in 0..2 {
        assert!((a.fit.cofactor[j][j] / b.fit.cofactor[j][j] - 1.0).abs() <= f64::EPSILON);
    }
    let unweighted = line(&(0..4).map(|i| (x[i], y[i], 1.0)).collect::<Vec<_>>()).unwrap();
    assert!((a.slope - unweighted.slope).abs() > 1e-3);
}

#[test]
fn common_weight_leaves_the_covariance_and_scales_the_cofactor() {
    let points = |w: f64| [(1.0, 2.0, w), (2.0, 2.5, w), (3.0, 4.5, w), (5.0, 4.0, w)];
    let (one, many) = (line(&points(1.0)).unwrap().fit, line(&points(1e12)).unwrap().fit);
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 4.0 * f64::EPSILON;
    assert!(close(one.standard_errors[1], many.standard_errors[1]));
    assert!(close(one.covariance[0][1], many.covariance[0][1]));
    assert!(close(one.cofactor[1][1], 1e12 * many.cofactor[1][1]));
    assert!(close(1e6 * one.residual_sd, many.residual_sd));
}

#[test]
fn extreme_units_do_not_disturb_the_fit() {
    let at = |ux: f64, uy: f64| {
        line(&[1.0, 2.0, 3.0, 4.0].map(|x: f64| (ux * x, uy * (1.0 + 2.0 * x), 1.0))).map(|fit| fit.slope)
    };
    for (ux, uy) in [(1e-150, 1e-150), (1e140, 1e140), (1e-100, 1e30)] {
        assert!((at(ux, uy).unwrap() / (2.0 * uy / ux) - 1.0).abs() < 1e-14);
    }
    assert_eq!(at(1e-200, 1e200), Err(FitError::Overflow));
}

#[test]
fn r_squared_is_centred_only_with_a_constant_column() {
    let y = [10.0, 10.5, 11.5];
    let with = multilinear(&[1.0, 2.0, 3.0].map(|x| vec![1.0, x]), &y, None).unwrap();
    let without = multilinear(&[1.0, 2.0, 3.0].map(|x| vec![x]), &y, None).unwrap();
    // By hand: slope 3/4, S = 1/24, SST = 7/6; and b = 65.5/14, R² = 65.5²/14/342.5.
    assert!((with.r_squared.unwrap() - (1.0 - 1.0 / 28.0)).abs() < 1e-15);
    assert!((without.r_squared.unwrap() - 65.5 * 65.5 / 14.0 / 342.5).abs() < 1e-15);
    assert_eq!(line(&[(0.0, 2.0, 1.0), (1.0, 2.0, 1.0), (2.0, 2.0, 1.0)]).unwrap().fit.r_squared, None);
}

#[test]
fn faults_are_named_with_their_place() {
    let rows =
        |columns: [[f64; 4]; 2]| (0..4).map(|i| vec![columns[0][i], columns[1][i]]).collect::<Vec<_>>();
    let good = rows([[1.0; 4], [1.0, 2.0, 3.0, 4.0]]);
    let y = [1.0, 2.0, 2.0, 3.0];
    assert!(multilinear(&good, &y, None).is_ok());
    assert_eq!(
        multilinear(&rows([[0.1, 0.2, 0.3, 0.4], [0.3, 0.6, 0.9, 1.2]]), &y, None),
        Err(FitError::RankDeficient { column: 1 })
    );
    assert_eq!(
        multilinear(&rows([[0.0; 4], [1.0; 4]]), &y, None),
        Err(FitError::RankDeficient { column: 0 })
    );
    assert!(matches!(
        multilinear(&good, &y[..3], None),
        Err(FitError::LengthMismatch { what: Input::Y, found: 3, expected: 4 })
    ));
    assert!(matches!(
        multilinear(&good, &y, Some(&[1.0; 5])),
        Err(FitError::LengthMismatch { what: Input::Weight, found: 5, expected: 4 })
    ));
    for bad in [0.0, -1.0] {
        assert!(matches!(
            multilinear(&good, &y, Some(&[1.0, 1.0, bad, 1.0])),
            Err(FitError::OutOfDomain { what: Input::Weight, index: 2, .. })
        ));
    }
    assert!(matches!(
        multilinear(&good, &[1.0, 2.0, 3.0, f64::INFINITY], None),
        Err(FitError::NonFinite { what: Input::Y, index: 3, .. })
    ));
    assert!(matches!(
        polynomial(&[1.0, f64::NAN, 2.0], &[1.0; 3], 1),
        Err(FitError::NonFinite { what: Input::X, index: 1, .. })
    ));
    assert!(matches!(
        multilinear(&[vec![1.0], vec![1.0, 2.0]], &[1.0; 2], None),
        Err(FitError::RaggedDesign { row: 1, found: 2, expected: 1 })
    ));
    assert_eq!(multilinear(&[vec![], vec![]], &[1.0; 2], None), Err(FitError::NoColumns));
    assert_eq!(multilinear(&good[..2], &y[..2], None), Err(FitError::TooFewPoints { found: 2, needed: 3 }));
    assert_eq!(line(&[]).map(|fit| fit.slope), Err(FitError::TooFewPoints { found: 0, needed: 3 }));
    assert_eq!(line(&[(1.0, 2.0, 1.0); 5]).map(|fit| fit.slope), Err(FitError::RankDeficient { column: 1 }));
    let fit = multilinear(&good, &y, None).unwrap();
    assert_eq!(fit.interval(2, 0.95), Err(FitError::NoSuchCoefficient { index: 2, count: 2 }));
    assert!(matches!(fit.interval(0, 1.0), Err(FitError::Coverage { .. })));
}
