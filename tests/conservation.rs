//! What an operator conserves, and how its value turns with the particles, in numbers.
//!
//! Two modules are compared: `derived::Conservation`, decided from what multiplies the field of each particle, and
//! `measured::stencil`, summed over all particles of an open cloud with a random field.
//!
//! Planted errors that were seen to fail: r_ij not turned with the pair, V_i for m_i, the torque's tensor not compared with its
//! transpose, B_i for B_j, and ∇W of a cloud scaled with 1/R for 1/R².
#![allow(clippy::unwrap_used, clippy::panic, clippy::needless_range_loop)] // A failed unwrap is a failed test.

mod patches;
#[path = "strategies/rotations.rs"]
mod rotations;

use patches::{Patch, Recipe, conditions, noise};
use proptest::prelude::*;
use remainder::derived::{Conservation, Conserved};
use remainder::kernel;
use remainder::language::ground::Ground;
use remainder::language::tree::OfParticle;
use remainder::language::{Field, Operator, operators};
use remainder::measured::stencil;
use remainder::particles::{Cloud, Neighbours, Support};

/// Rounding errors of a sum of some thousand terms, and what no rounding error reaches, relative to Σ|terms|.
const ROUNDING: f64 = 1e-12;
const SHOWN: f64 = 1e-6;

/// |Σ_i w_i ⟨Lu⟩_i| and |Σ_i w_i r_i × ⟨Lu⟩_i|, by the sum of the magnitudes of the terms.
fn totals(operator: &Operator, patch: &Patch) -> (f64, f64) {
    let (ground, d) = (patch.ground(), patch.cloud.dimension());
    let components = if operator.field == Field::Vector { d } else { 1 };
    let mut state = 77;
    let field: Vec<Vec<f64>> = patch
        .cloud
        .positions()
        .iter()
        .map(|_| (0..components).map(|_| noise(&mut state)).collect())
        .collect();
    let weight = if operator.root.units.mass == -1 { OfParticle::Mass } else { OfParticle::Volume };
    let (mut total, mut moment) = (vec![0.0; d.pow(operator.rank().into())], [0.0; 3]);
    let (mut terms, mut moments) = (0.0_f64, 0.0_f64);
    for (i, place) in patch.cloud.positions().iter().enumerate() {
        let stencil = stencil(operator, &ground, i).unwrap();
        let weight = ground.of_particle(weight, i).unwrap();
        let mut value = stencil.apply(|j| field[j].clone());
        value.iter_mut().for_each(|value| *value *= weight);
        let size = stencil.magnitude(0) * weight;
        terms += size;
        moments += size * place.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (total, value) in total.iter_mut().zip(&value) {
            *total += value;
        }
        if operator.rank() == 1 {
            value.resize(3, 0.0);
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                moment[a] += place[b] * value[c] - place[c] * value[b];
            }
        }
    }
    let norm = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm(&total) / terms, norm(&moment) / moments)
}

/// A few dozen particles with nothing around them.
fn open_clouds() -> [Patch; 2] {
    let recipe =
        |lattice, support, reach, jitter| Recipe { lattice, support, reach, jitter, surface: None, seed: 9 };
    let kernel = kernel::by_id("wendland-c4").unwrap();
    [recipe("square", 2.7, 1.5, 0.2).patch(&kernel), recipe("simple-cubic", 2.1, 1.0, 0.12).patch(&kernel)]
}

fn assert_is(what: Conserved, found: f64, text: &str) {
    match what {
        Conserved::Yes => assert!(found <= ROUNDING, "{text} is said to be conserved and is {found:e}"),
        Conserved::No => assert!(found >= SHOWN, "{text} is said not to be conserved and is {found:e}"),
        Conserved::DoesNotApply => {}
    }
}

#[test]
fn what_is_said_to_be_conserved_is() {
    for patch in open_clouds() {
        let d = patch.cloud.dimension();
        for entry in operators::catalogue() {
            let operator = entry.operator().unwrap();
            let said = Conservation::of(&operator).unwrap();
            let (total, angular) = totals(&operator, &patch);
            eprintln!("{} {d}-D {said:?}: {total:.1e}, {angular:.1e}", entry.id);
            assert_is(said.total, total, &format!("Σ w ⟨Lu⟩ of {} in {d}-D", entry.id));
            assert_is(said.angular, angular, &format!("Σ w r × ⟨Lu⟩ of {} in {d}-D", entry.id));
        }
    }
}

#[test]
fn what_is_conserved_by_the_catalogue() {
    use Conserved::{DoesNotApply, No, Yes};
    let said = |id: &str| {
        let conservation = Conservation::of(&operators::by_id(id).unwrap().operator().unwrap()).unwrap();
        (conservation.total, conservation.angular)
    };
    // The symmetrised gradient's exchange is not along r_ij: it is B · Σ ω r ∇W = −I that saves the angular momentum.
    for id in ["F3", "G+", "basa-8", "basa-9", "MCG", "MCG-pi", "C", "D", "F4-symmetrised"] {
        assert_eq!(said(id), (Yes, Yes), "{id}");
    }
    for id in ["MEA", "E"] {
        assert_eq!(said(id), (Yes, No), "{id}");
    }
    for id in ["S2-11", "S3", "S1-9-F1", "S1-9-F2", "S1-9-F3", "S1-9-F4"] {
        assert_eq!(said(id), (Yes, DoesNotApply), "{id}");
    }
    for id in ["F1", "F2", "F4", "G0", "G-", "pressure-reduction", "shepard-gradient", "mixed-correction"] {
        assert_eq!(said(id), (No, No), "{id}");
    }
    for id in ["S1-7-F1", "S1-7-F4", "S1-8-F1", "S1-8-F4", "S2-10", "S2-12", "S4"] {
        assert_eq!(said(id), (No, DoesNotApply), "{id}");
    }
    for id in ["A", "B", "shepard", "shepard-hessian", "basa-10", "basa-17"] {
        assert_eq!(said(id), (DoesNotApply, DoesNotApply), "{id}");
    }
}

/// The same particles elsewhere, all lengths times `scale`.
fn elsewhere(patch: &Patch, positions: Vec<[f64; 3]>, scale: f64) -> Patch {
    let (old, d) = (&patch.cloud, patch.cloud.dimension());
    let volumes = old.volumes().iter().map(|volume| volume * scale.powi(d as i32)).collect();
    let support = Support::Uniform(old.support_of(0) * scale);
    let cloud = Cloud::new(d, positions, volumes, support).unwrap();
    let lists = Neighbours::search(&cloud).unwrap();
    Patch { cloud, lists, kernel: patch.kernel.clone(), centre: patch.centre }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// The value of a scalar operator at a particle does not see how the axes lie, and with the unit of length it changes as
    /// its order says: a Laplacian as 1/s². That of a gradient turns as a vector.
    #[test]
    fn values_turn_and_scale_with_the_particles(
        (dimension, q) in (2_usize..=3).prop_flat_map(|d| (Just(d), rotations::orthogonal(d))),
        scale in 0.2..5.0_f64,
        seed in any::<u64>(),
    ) {
        let (lattice, support) = if dimension == 2 { ("hexagonal", 2.1) } else { ("simple-cubic", 1.6) };
        let recipe = Recipe { lattice, support, reach: 1.3, jitter: 0.1, surface: None, seed };
        let kernel = kernel::by_id("wendland-c4").unwrap();
        let here = recipe.patch(&kernel);
        let i = here.centre;
        let turn = |x: &[f64]| -> [f64; 3] {
            std::array::from_fn(|a| x.iter().enumerate().map(|(b, x)| q[a][b] * x).sum())
        };
        let turned = here.cloud.positions().iter().map(|x| turn(x).map(|x| x * scale)).collect();
        // Volumes are a length to the power D.
        let there = elsewhere(&here, turned, scale);
        let mut state = seed;
        let field: Vec<f64> = here.cloud.positions().iter().map(|_| noise(&mut state)).collect();
        let condition = conditions(&here.ground(), i);
        for id in ["S2-10", "S2-11", "S3", "S4", "shepard", "F2", "F4", "mixed-correction"] {
            let entry = operators::by_id(id).unwrap();
            let operator = entry.operator().unwrap();
            let value = |patch: &Patch| {
                let stencil = stencil(&operator, &patch.ground(), i).unwrap();
                (stencil.apply(|j| vec![field[j]]), stencil.magnitude(0))
            };
            let ((old, size), (new, _)) = (value(&here), value(&there));
            let expected = if operator.rank() == 1 { turn(&old)[..dimension].to_vec() } else { old };
            for (new, expected) in new.iter().zip(expected) {
                let found = new * scale.powi(entry.target.order().into());
                let off = (found - expected).abs();
                prop_assert!(off <= 1e-12 * condition * size, "{id} in {dimension}-D: {found} and {expected}");
            }
        }
    }
}
