//! Fatehi & Manzari's Eqs. (17)–(27) and (48) as printed, beside what the operator does to monomials in rational arithmetic:
//! `report::printed_verdicts` (algebra) and `measured::stencil` (particles) must agree on which hold.

#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use num_traits::Zero;
use remainder::claim::printed_coefficients;
use remainder::derived::{Arrangement, Expansion};
use remainder::exact::{MultiIndex, Rational};
use remainder::language::{Coefficient, Field, Operator, operators};
use remainder::measured::stencil;
use remainder::report::printed_verdicts;

/// What the stencil multiplies ∂_α u by, less the target's, for each α: by value component.
fn by_stencil(
    coefficient: &Coefficient,
    known: bool,
    ground: &Arrangement,
    dimension: usize,
) -> Vec<Vec<Rational>> {
    let stencil = stencil::<Rational>(coefficient.operator(), ground, 0).unwrap();
    let rank = u32::from(coefficient.operator().rank());
    let all = MultiIndex::all(dimension, coefficient.order()).unwrap();
    let of = |alpha: &MultiIndex| {
        let letters: Vec<usize> =
            (0..3).flat_map(|axis| std::iter::repeat_n(axis, usize::from(alpha.powers[axis]))).collect();
        let moments = stencil.moment(alpha).remove(0);
        let less = moments.into_iter().enumerate().map(|(out, moment)| {
            let value: Vec<usize> =
                (0..rank).rev().map(|place| out / dimension.pow(place) % dimension).collect();
            let target = coefficient.target().filter(|_| known);
            let taken = target.map(|t| t.coefficient(Field::Scalar, &value, &letters, 0));
            moment - taken.unwrap_or_else(Rational::zero)
        });
        less.collect()
    };
    all.iter().map(of).collect()
}

#[test]
fn algebra_and_particles_agree_on_which_printed_equations_hold() {
    let verdicts = printed_verdicts().unwrap();
    for (printed, verdict) in printed_coefficients().iter().zip(&verdicts) {
        let coefficient = Coefficient::new(printed.operator, printed.order).unwrap();
        let tensor = Operator::parse_coefficient(printed.text).unwrap();
        let order = usize::from(printed.order);
        let rank = coefficient.operator().rank();
        let printed_terms = Expansion::given(tensor, Field::Scalar, order, rank).unwrap();
        let mut holds = true;
        for dimension in 1..=3 {
            let ground = Arrangement::new(dimension, 1);
            let as_printed = printed_terms.error_at::<Rational>(&ground, 0, order).unwrap();
            let as_printed: Vec<Vec<Rational>> = as_printed.into_iter().map(|mut by| by.remove(0)).collect();
            let known = operators::by_id(printed.operator).is_ok();
            holds &= as_printed == by_stencil(&coefficient, known, &ground, dimension);
        }
        assert_eq!(holds, verdict.difference.is_empty(), "{} {}", printed.location, printed.operator);
    }
}

/// The three that do not hold share one sign: ⟨∇u⟩_j has −B_j⁻¹·∇∇u·r_ij, and what is summed from it +.
#[test]
fn the_equations_of_s1_have_a_sign_wrong_and_all_others_hold() {
    let verdicts = printed_verdicts().unwrap();
    let wrong: Vec<(&str, u8)> = verdicts
        .iter()
        .filter(|verdict| !verdict.difference.is_empty())
        .map(|verdict| (verdict.location.as_str(), verdict.order))
        .collect();
    assert_eq!(wrong, [("Eqs. (21), (22)", 2), ("Eq. (23)", 2), ("Eq. (24)", 2)]);
    let right = ["-I + sum_j V_j ((sum_k V_k r_jk gradW_jk) . gradW_ij) r_ij \
         + 1/2 sum_j V_j (sum_k V_k r_jk r_jk gradW_jk) . gradW_ij"];
    for text in right {
        let s1 = Coefficient::new("S1-7-F2", 2).unwrap();
        let derived = Expansion::of(s1.operator().clone(), s1.target().cloned(), 2).unwrap();
        let given =
            Expansion::given(Operator::parse_coefficient(text).unwrap(), Field::Scalar, 2, 0).unwrap();
        assert!(derived.minus(&given, 2).unwrap().vanishes(2));
    }
}
