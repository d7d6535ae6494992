//! What the property tests draw: kernels, particles, weights, moments, rotations.

mod rotations;

pub(crate) use rotations::orthogonal;

use proptest::prelude::*;
use remainder::exact::{Piecewise, Polynomial, Rational, int, ratio};
use remainder::kernel::{self, Kernel};
use remainder::particles::{Lattice, lattice};
use remainder::sums::Moment;

/// One of the kernels of the catalogue.
pub(crate) fn kernel() -> impl Strategy<Value = Kernel> {
    let closed = kernel::catalogue().into_iter().filter(|kernel| kernel.polynomial().is_some());
    prop::sample::select(closed.collect::<Vec<_>>())
}

/// One of the lattices of the catalogue.
pub(crate) fn any_lattice() -> impl Strategy<Value = Lattice> {
    prop::sample::select(lattice::catalogue())
}

/// D.
pub(crate) fn dimension() -> impl Strategy<Value = usize> {
    1_usize..=3
}

/// R/Δ between 3/2 and 4, with denominators up to 12.
pub(crate) fn support() -> impl Strategy<Value = Rational> {
    (1_i64..=12).prop_flat_map(|q| (3 * q / 2 + 1..=4 * q).prop_map(move |p| ratio(p, q)))
}

/// A kernel nobody uses: up to three pieces between awkward knots, any polynomials of degree up to five, jumps of every
/// order, a kink or a pole of G_1 at the origin. Only those that can be normalised in every dimension.
pub(crate) fn polynomial_kernel() -> impl Strategy<Value = Kernel> {
    let coefficient = (-9_i64..=9, 1_i64..=6).prop_map(|(p, q)| ratio(p, q));
    let piece = (prop::collection::vec(coefficient, 1..=6), 1_i64..=7, 1_i64..=5);
    prop::collection::vec(piece, 1..=3).prop_filter_map("not normalisable", |pieces| {
        let mut knots = vec![int(0)];
        let mut polynomials = Vec::new();
        for (coefficients, p, q) in pieces {
            knots.push(&knots[knots.len() - 1] + ratio(p, q));
            polynomials.push(Polynomial::new(coefficients));
        }
        let profile = Piecewise::new(knots, polynomials).ok()?;
        Kernel::new("own", "a random kernel", "none", profile).ok()
    })
}

/// A moment with p ≤ 3.
pub(crate) fn moment() -> impl Strategy<Value = Moment> {
    prop::sample::select(Moment::all(3))
}

/// Some moments in some order, none twice.
pub(crate) fn moments() -> impl Strategy<Value = Vec<Moment>> {
    let all = Moment::all(3);
    let count = all.len();
    prop::sample::subsequence(all, 1..=count).prop_shuffle()
}

/// Pairs (x, weight) in D dimensions, x = r_ij/R within and a little beyond the support, the pair i = j among them.
pub(crate) fn pairs(dimension: usize) -> impl Strategy<Value = Vec<([f64; 3], f64)>> {
    let x = [-1.05..1.05_f64, -1.05..1.05, -1.05..1.05]
        .prop_map(move |x| std::array::from_fn(|a| if a < dimension { x[a] } else { 0.0 }));
    prop::collection::vec((x, 0.01..2.0_f64), 1..60).prop_map(|mut pairs| {
        pairs.push(([0.0; 3], 1.0));
        pairs
    })
}

/// Positions on the grid of 2^−12 in the box of edge 4, so that moderate translations are exact.
pub(crate) fn positions(dimension: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
    let on_grid = |n: i32| f64::from(n) / 4096.0;
    let position = [0..16384_i32, 0..16384, 0..16384]
        .prop_map(move |n| std::array::from_fn(|a| if a < dimension { on_grid(n[a]) } else { 0.0 }));
    prop::collection::vec(position, 2..40)
}
