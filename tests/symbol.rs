//! Fourier symbols of operators: against the operator applied to a wave, against closed forms, and what S1 does not see.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::kernel;
use remainder::language::Coefficient;
use remainder::measured::{Symbol, SymbolError};
use remainder::particles::{VolumeRule, lattice_by_id};
use std::f64::consts::PI;

fn symbol(operator: &str, lattice: &str, support: f64) -> Symbol {
    let kernel = kernel::by_id("wendland-c2").unwrap();
    let operator = Coefficient::new(operator, 0).unwrap();
    Symbol::of(&operator, &kernel, &lattice_by_id(lattice).unwrap(), support, VolumeRule::Constant).unwrap()
}

/// On a line with R/Δ = 1.5 only the nearest neighbours count, and F4 is the central difference: B makes its weights ±1/2.
#[test]
fn nearest_neighbours_make_the_differences_of_textbooks() {
    let f4 = symbol("F4", "line", 1.5);
    let s4 = symbol("S4", "line", 1.5);
    for k in [0.1_f64, 0.7, 1.9, 3.0] {
        let [re, im] = f4.at([k, 0.0, 0.0]).symbol[0];
        assert!(re.abs() < 1e-14 && (im - k.sin()).abs() < 1e-14, "F4 at {k}");
        let [re, im] = s4.at([k, 0.0, 0.0]).symbol[0];
        assert!((re + 2.0 - 2.0 * k.cos()).abs() < 1e-13 && im.abs() < 1e-14, "S4 at {k}: {re}");
        assert_eq!(f4.at([k, 0.0, 0.0]).exact, vec![[0.0, k]]);
        assert_eq!(s4.at([k, 0.0, 0.0]).exact, vec![[-k * k, 0.0]]);
    }
}

/// Long waves are seen with the error that the expansion says: F4's is −k³ times a multiple of h², S3 and S4 likewise.
#[test]
fn long_waves_are_right_to_the_operators_order() {
    for (name, lattice, least) in
        [("F4", "square", 1.9), ("S4", "hexagonal", 1.9), ("F4", "simple-cubic", 1.9), ("S4", "fcc", 1.9)]
    {
        let symbol = symbol(name, lattice, 2.3);
        let error = |k: f64| {
            let k = [k * 0.6, if lattice == "line" { 0.0 } else { k * 0.8 }, 0.0];
            let value = symbol.at(k);
            let parts = value.symbol.iter().zip(&value.exact);
            let off: f64 = parts.map(|(s, e)| (s[0] - e[0]).powi(2) + (s[1] - e[1]).powi(2)).sum();
            let size: f64 = value.exact.iter().map(|e| e[0] * e[0] + e[1] * e[1]).sum();
            (off / size).sqrt()
        };
        let slope = (error(0.02) / error(0.01)).log2();
        assert!((least..2.1).contains(&slope), "{name} on {lattice}: {slope}");
    }
}

/// Fatehi & Manzari 2011, Sec. 3.2: sums over neighbours of neighbours leave decoupled sets of equations. On a line with
/// R/Δ = 1.5 the weights of S1 stand on every other particle.
#[test]
fn s1_falls_into_decoupled_sets_and_does_not_see_the_shortest_wave() {
    for name in ["S1-7-F2", "S1-8-F2", "S1-9-F2", "S1-8-F4"] {
        let line = symbol(name, "line", 1.5);
        assert_eq!(line.decoupled_sets(), Some(2), "{name}");
        assert!(line.is_null_mode([PI, 0.0, 0.0]) && !line.is_null_mode([0.5 * PI, 0.0, 0.0]), "{name}");
        assert_eq!(symbol(name, "square", 1.2).decoupled_sets(), Some(4), "{name}");
    }
    // More neighbours connect the sets, and the shortest waves stay unseen.
    let wide = symbol("S1-8-F2", "square", 3.0);
    assert_eq!(wide.decoupled_sets(), Some(1));
    let null = |symbol: &Symbol| {
        symbol.half_reciprocal_vectors().into_iter().filter(|k| symbol.is_null_mode(*k)).count()
    };
    assert_eq!(null(&wide), 3, "an inner gradient vanishes at all half reciprocal vectors");
    for name in ["S3", "S4", "S2-11"] {
        let other = symbol(name, "square", 3.0);
        assert_eq!((other.decoupled_sets(), null(&other)), (Some(1), 0), "{name}");
        assert_eq!(symbol(name, "line", 1.5).decoupled_sets(), Some(1), "{name}");
    }
}

#[test]
fn lattices_whose_sites_differ_have_no_scalar_symbol() {
    let kernel = kernel::by_id("wendland-c2").unwrap();
    let operator = Coefficient::new("F4", 0).unwrap();
    let hcp = lattice_by_id("hcp").unwrap();
    let refused = Symbol::of(&operator, &kernel, &hcp, 2.0, VolumeRule::Constant);
    assert!(matches!(refused, Err(SymbolError::Basis { particles: 2, .. })), "{refused:?}");
    // A cubic cell of bcc has two particles that see the same.
    let bcc = lattice_by_id("bcc").unwrap();
    let symbol = Symbol::of(&operator, &kernel, &bcc, 2.0, VolumeRule::Constant).unwrap();
    assert_eq!(symbol.half_reciprocal_vectors().len(), 7);
    assert_eq!(symbol.decoupled_sets(), Some(1));
}
