//! What each point where the kernel is not smooth leaves of a component, as exact polynomials on the sphere.

use super::singular::Knot;
use crate::exact::{MultiIndex, Multivariate, Rational, int, ratio};
use crate::kernel::SummandTerm;
use crate::particles::{Lattice, PointGroup};
use num_traits::{One, Zero};
use std::collections::BTreeMap;

/// Σ_ν c_ν n^ν on the unit sphere; all |ν| have the same parity.
pub(super) type Spherical = BTreeMap<MultiIndex, Rational>;

/// The term of order N of one knot: f̂(K) has the part
///
/// i^M F ρ^{(D−1)/2} |K|^{−(D+1)/2−N} P(K/|K|) cos(|K|ρ − (D + 1)π/4 − (M + N)π/2),
///
/// F = σ_D 2^{(D+1)/2} π^{(D−1)/2}, M = |μ| of the component's first term; this is P.
///
/// J_λ(x) = √(2/πx) Σ_i a_i(λ) x^{−i} cos(x − λπ/2 − π/4 + iπ/2), a_i = Π_{r≤i} (4λ² − (2r−1)²)/(8r), at
/// λ = D/2 + T + l; then N = |j| + l + i.
pub(super) fn of_knot(knot: &Knot, dimension: usize, terms: &[SummandTerm], order: usize) -> Spherical {
    let mut polynomial = Spherical::new();
    for term in terms {
        let degree = term.monomial.order() as usize;
        for (halves, weight) in contractions(&term.monomial) {
            let j = halves.order() as usize;
            let derivatives = degree - j;
            for i in 0..=order.saturating_sub(j) {
                let Some(l) = order.checked_sub(j + i) else { continue };
                let jump = &knot.jumps[term.radial + l];
                if jump.is_zero() {
                    continue;
                }
                let sign = if (degree + l + 1 + i) % 2 == 0 { 1 } else { -1 };
                let length = power(&knot.at, (derivatives + l) as i64 - i as i64);
                let bessel = bessel_coefficient(dimension + 2 * (derivatives + l), i);
                let nu =
                    MultiIndex::new(std::array::from_fn(|a| term.monomial.powers[a] - 2 * halves.powers[a]));
                *polynomial.entry(nu).or_default() +=
                    int(sign * term.coefficient) * &weight * jump * length * bessel;
            }
        }
    }
    polynomial.retain(|_, c| !c.is_zero());
    polynomial
}

/// What ∇^q of r^s is made of: Σ_t c_t s(s−2)…(s−2k_t+2) x^{μ_t} |x|^{s−2k_t}, on the sphere.
pub(super) fn of_power(s: usize, terms: &[SummandTerm]) -> Spherical {
    let mut polynomial = Spherical::new();
    for term in terms {
        *polynomial.entry(term.monomial).or_default() += int(term.coefficient) * falling(s, term.radial);
    }
    polynomial
}

/// s(s−2)…(s−2k+2): G_k of r^s over r^{s−2k}.
pub(super) fn falling(s: usize, k: usize) -> Rational {
    (0..k).fold(Rational::one(), |product, step| product * int(s as i64 - 2 * step as i64))
}

/// All j with 2j ≤ μ, each with C(μ, j).
pub(super) fn contractions(monomial: &MultiIndex) -> Vec<(MultiIndex, Rational)> {
    let [x, y, z] = monomial.powers;
    let mut all = Vec::new();
    for a in 0..=x / 2 {
        for b in 0..=y / 2 {
            for c in 0..=z / 2 {
                let halves = [a, b, c];
                let weight = (0..3).fold(Rational::one(), |product, axis| {
                    let (n, j) = (monomial.powers[axis], halves[axis]);
                    product * factorial(n) / (factorial(j) * factorial(n - 2 * j) * int(1_i64 << j))
                });
                all.push((MultiIndex::new(halves), weight));
            }
        }
    }
    all
}

/// a_i(λ) with 2λ = `twice`.
fn bessel_coefficient(twice: usize, i: usize) -> Rational {
    let square = (twice * twice) as i64;
    (1..=i as i64)
        .fold(Rational::one(), |product, r| product * ratio(square - (2 * r - 1) * (2 * r - 1), 8 * r))
}

fn factorial(n: u8) -> Rational {
    (1..=i64::from(n)).fold(Rational::one(), |product, k| product * int(k))
}

fn power(base: &Rational, exponent: i64) -> Rational {
    let positive = num_traits::pow(base.clone(), exponent.unsigned_abs() as usize);
    if exponent < 0 { positive.recip() } else { positive }
}

/// Whether something is left of polynomials on the sphere when they are summed over a site's surroundings.
pub(super) struct Symmetry<'a> {
    lattice: &'a Lattice,
    group: PointGroup,
    means: BTreeMap<MultiIndex, Multivariate>,
}

impl<'a> Symmetry<'a> {
    pub(super) fn of(lattice: &'a Lattice) -> Self {
        Self { lattice, group: PointGroup::of(lattice), means: BTreeMap::new() }
    }

    pub(super) fn group(&self) -> &PointGroup {
        &self.group
    }

    /// Whether a summand's lattice sum can differ from zero: for some radial functions, that is.
    pub(super) fn keeps_some(&mut self, terms: &[SummandTerm]) -> bool {
        let mut by_radial: BTreeMap<usize, Spherical> = BTreeMap::new();
        for term in terms {
            let polynomial = by_radial.entry(term.radial).or_default();
            *polynomial.entry(term.monomial).or_default() += int(term.coefficient);
        }
        by_radial.values().any(|polynomial| self.keeps(polynomial))
    }

    /// Whether the mean over the point group differs from zero somewhere on the sphere: then, and only then, the sums over
    /// shells of the lattice (and of the reciprocal one, whose structure factor the group keeps) do not all vanish.
    ///
    /// In coordinates K_a = y_a √s_a all terms share one root, and |K|² is invariant: made homogeneous with it, a
    /// polynomial vanishes on the sphere exactly when it is zero.
    pub(super) fn keeps(&mut self, polynomial: &Spherical) -> bool {
        let squares = self.lattice.axis_squares();
        let norm = (0..self.lattice.dimension()).fold(Multivariate::zero(), |sum, a| {
            let mut square = MultiIndex::default();
            square.powers[a] = 2;
            &sum + &Multivariate::monomial(square, squares[a].clone())
        });
        let highest = polynomial.keys().map(MultiIndex::order).max().unwrap_or(0);
        let group = &self.group;
        let sum = polynomial.iter().fold(Multivariate::zero(), |sum, (nu, c)| {
            let mean = self.means.entry(*nu).or_insert_with(|| group.mean(nu));
            let weight = (0..3).fold(c.clone(), |product, a| {
                product * num_traits::pow(squares[a].clone(), usize::from(nu.powers[a] / 2))
            });
            let raised = (0..(highest - nu.order()) / 2).fold(mean.scale(&weight), |mean, _| &mean * &norm);
            &sum + &raised
        });
        !sum.is_zero()
    }
}
