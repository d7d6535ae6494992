//! What rounding takes: bounds that hold, digits that a constant does not cost, powers of two that change nothing, and how
//! much a program computes.
//!
//! Independent of the compiled programs: `measured::rounding` walks the typed tree in twice the digits.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use proptest::prelude::*;
use remainder::kernel::by_id;
use remainder::language::{Operator, operators};
use remainder::measured::{Operations, Program, RoundingError, computed, rounding};
use remainder::particles::{Cloud, Support};

/// 7 × 7 particles moved by up to ±`jitter`/2, lengths times `length`; the middle one is number 24.
fn cloud(jitter: f64, seed: u64, length: f64) -> Cloud {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut places = Vec::new();
    for k in 0..49 {
        let [x, y] = [(k / 7) as f64, (k % 7) as f64].map(|x| (x + jitter * next()) * length);
        places.push([x, y, 0.0]);
    }
    let volumes = places.iter().map(|_| (1.0 + 0.2 * next()) * length * length).collect();
    Cloud::new(2, places, volumes, Support::Uniform(2.2 * length)).unwrap()
}

fn field(cloud: &Cloud, plus: f64) -> Vec<[f64; 3]> {
    let of = |x: &[f64; 3]| [(0.8 * x[0]).sin() + 0.3 * x[1] * x[0] + plus, (0.4 * x[1]).cos() + plus, 0.0];
    cloud.positions().iter().map(of).collect()
}

fn operator(id: &str) -> Operator {
    operators::by_id(id).unwrap().operator().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn no_more_is_lost_than_foretold(jitter in 0.0_f64..0.9, seed in 1_u64.., plus in prop::sample::select(vec![0.0, 1e3, -1e9])) {
        let cloud = cloud(jitter, seed, 1.0);
        let kernel = by_id("quintic-spline").unwrap();
        for id in ["F2", "F4", "S3", "S4", "S1-7-F2", "shepard-gradient", "MEA"] {
            let operator = operator(id);
            match rounding(&operator, &kernel, &cloud, 24, &field(&cloud, plus)) {
                Ok(found) => {
                    prop_assert!(found.lost <= found.predicted + 0.01, "{id}: {} of {}", found.lost, found.predicted);
                    prop_assert!(found.computed.iter().all(|value| value.is_finite()));
                }
                Err(RoundingError::Program(_)) => {}
                Err(error) => prop_assert!(false, "{id}: {error}"),
            }
        }
    }
}

#[test]
fn a_loss_is_seen() {
    let cloud = cloud(0.3, 5, 1.0);
    let kernel = by_id("wendland-c2").unwrap();
    let found = rounding(&operator("F4"), &kernel, &cloud, 24, &field(&cloud, 0.0)).unwrap();
    assert!(found.lost < 2.0, "{found:?}");
    // F1 does not vanish on constants: what f32 keeps of them is seen.
    let lossy = rounding(&operator("F1"), &kernel, &cloud, 24, &field(&cloud, 1e9)).unwrap();
    let single = lossy.single.unwrap();
    assert!((2.0..8.0).contains(&single), "{single} digits in f32");
    assert!(lossy.predicted > lossy.lost, "{lossy:?}");
}

#[test]
fn a_constant_costs_no_digits_where_it_vanishes() {
    let cloud = cloud(0.3, 5, 1.0);
    let count = cloud.len();
    let cloud = cloud.with_field("density", vec![1.25; count]).unwrap();
    let cloud = cloud.with_field("mass", vec![1.25; count]).unwrap();
    let kernel = by_id("wendland-c2").unwrap();
    for id in ["shepard-gradient", "shepard-hessian", "mixed-correction", "pressure-reduction", "F2", "S4"] {
        let found = rounding(&operator(id), &kernel, &cloud, 24, &field(&cloud, 1e12)).unwrap();
        assert!(found.lost < 3.0, "{id} loses {} digits", found.lost);
    }
}

#[test]
fn powers_of_two_change_no_bit() {
    let (plain, large) = (cloud(0.3, 9, 1.0), cloud(0.3, 9, 400_f64.exp2()));
    let kernel = by_id("cubic-spline").unwrap();
    let field = field(&plain, 0.0);
    for (id, power) in [("F4", -1), ("S3", -2), ("S4", -2), ("S1-7-F2", -2), ("shepard", 0)] {
        let operator = operator(id);
        let here = computed(&operator, &kernel, &plain, 24, &field).unwrap();
        let there = computed(&operator, &kernel, &large, 24, &field).unwrap();
        let back: Vec<f64> = there.iter().map(|value| value * f64::from(-400 * power).exp2()).collect();
        assert_eq!(here, back, "{id}");
    }
}

#[test]
fn kernels_of_no_polynomials_are_refused() {
    let cloud = cloud(0.3, 5, 1.0);
    let error = rounding(&operator("F2"), &by_id("gaussian").unwrap(), &cloud, 24, &field(&cloud, 0.0));
    assert!(matches!(error, Err(RoundingError::Kernel { .. })));
}

/// The least that each needs, by hand: kernel functions (W, W′/r, (W′/r)′/r) for each pair, and systems for each particle.
#[test]
fn ten_operators_compute_what_they_need() {
    let kernel = by_id("wendland-c2").unwrap();
    let needed = [
        // W′/r alone, in one pass; no system.
        ("F1", 1, 1, 0),
        ("F2", 1, 1, 0),
        ("G0", 1, 1, 0),
        ("S3", 1, 1, 0),
        // And B of the particle itself, from the same W′/r.
        ("F4", 1, 1, 1),
        // And B̂ from B.
        ("S4", 1, 1, 2),
        // Sums at the neighbours first: W′/r again in the second pass.
        ("S1-7-F2", 2, 2, 0),
        // W alone.
        ("shepard", 1, 1, 0),
        // W and W′/r.
        ("shepard-gradient", 1, 2, 0),
        // And (W′/r)′/r.
        ("shepard-hessian", 1, 3, 0),
    ];
    for (id, passes, kernels, systems) in needed {
        let program = Program::new(&operator(id), &kernel, 2).unwrap();
        let Operations { kernels_per_pair, systems_per_particle, .. } = program.operations();
        assert_eq!(
            (program.passes(), kernels_per_pair, systems_per_particle),
            (passes, kernels, systems),
            "{id}"
        );
    }
}

/// F1 by hand, in 2-D with Wendland C2, W′/r = c s³: r² takes 3, the kernel 2 and 3 powers and s itself, the weight 1, u 1, and two
/// components are multiplied and added. F2 subtracts u_i besides.
#[test]
fn operations_are_counted() {
    let kernel = by_id("wendland-c2").unwrap();
    let of = |id: &str| Program::new(&operator(id), &kernel, 2).unwrap().operations();
    assert!(of("F4").per_pair > of("F3").per_pair);
    assert!(of("S4").per_pair > 2 * of("S3").per_pair);
    assert!(of("F3").per_particle < of("F4").per_particle);
    assert_eq!(of("F1").per_pair, 3 + (2 + 3 + 1) + 1 + 1 + 2 * 2);
    assert_eq!(of("F2").per_pair, of("F1").per_pair + 1);
}
