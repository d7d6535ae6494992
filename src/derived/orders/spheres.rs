//! The reciprocal lattice by shells of equal |K|, with the structure factor of the basis.

use crate::exact::{MultiIndex, Radical, Rational, int, rational_to_f64};
use crate::particles::{Lattice, SiteIndex};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Reciprocal vectors that are summed, by dimension.
const VECTORS: [f64; 3] = [4_000.0, 20_000.0, 200_000.0];

/// g = K/2π in units of 1/Δ, as a lattice of the crate: g_a = m_a/(|det| √s_a).
#[derive(Debug, Clone)]
pub(super) struct Reciprocal {
    lattice: Lattice,
    basis: Vec<SiteIndex>,
    determinant: i64,
    /// Volume of the cell in Δ^D: reciprocal vectors per unit of g^D.
    pub(super) density: f64,
    /// No vector of the reciprocal cell's surface is farther from its centre.
    reach: f64,
}

impl Reciprocal {
    pub(super) fn of(lattice: &Lattice) -> Self {
        let d = lattice.dimension();
        let mut v = [[0_i64; 3], [0, 1, 0], [0, 0, 1]];
        v[..d].copy_from_slice(lattice.vectors());
        (d..3).for_each(|row| v[row] = std::array::from_fn(|a| i64::from(a == row)));
        // The rows of det · V^{-T}.
        let cross = |a: SiteIndex, b: SiteIndex| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let mut rows = [cross(v[1], v[2]), cross(v[2], v[0]), cross(v[0], v[1])];
        let determinant: i64 = (0..3).map(|a| v[0][a] * rows[0][a]).sum();
        rows[d..].fill([0; 3]);
        let squares = std::array::from_fn(|a| {
            if a < d { (&lattice.axis_squares()[a] * int(determinant * determinant)).recip() } else { int(1) }
        });
        let reciprocal = Lattice::new("reciprocal", "reciprocal", d, squares, rows, vec![[0; 3]])
            .unwrap_or_else(|error| {
                unreachable!("independent vectors have independent reciprocals: {error}")
            });
        let length = |k: &SiteIndex| rational_to_f64(&reciprocal.square(k)).sqrt();
        let reach = reciprocal.vectors().iter().map(length).sum::<f64>() / 2.0;
        let volume = lattice.particle_volume().enclose(64).midpoint_f64();
        let density = volume * lattice.basis().len() as f64;
        Self { lattice: reciprocal, basis: lattice.basis().to_vec(), determinant, density, reach }
    }

    /// Whether a cell holds one particle.
    pub(super) fn is_simple(&self) -> bool {
        self.basis.len() == 1
    }

    /// Visits every g within `radius` but 0: m, g, and the mean over the basis of cos and sin of 2π g·b.
    pub(super) fn visit(&self, radius: f64, mut visit: impl FnMut(SiteIndex, [f64; 3], [f64; 2])) {
        let units = self.lattice.axis_units();
        self.lattice.visit_indices(radius, |m| {
            if m == [0; 3] {
                return;
            }
            let phase = |b: &SiteIndex| {
                let turns: i64 = (0..3).map(|a| m[a] * b[a]).sum();
                let turn = turns.rem_euclid(self.determinant.abs()) as f64 / self.determinant.abs() as f64;
                libm::sincos(TAU * turn)
            };
            let (sine, cosine) = match self.basis.as_slice() {
                [_] => (0.0, 1.0),
                basis => {
                    let sums = basis.iter().map(phase).fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
                    (sums.0 / basis.len() as f64, sums.1 / basis.len() as f64)
                }
            };
            visit(m, std::array::from_fn(|a| m[a] as f64 * units[a]), [cosine, sine]);
        });
    }

    /// A bound of Σ |K|^{−e} over all |K| > 2π `radius`; infinite where that diverges, e ≤ D.
    ///
    /// Each g stands for its cell, in which |y| ≤ |g| + c: the sum is below ∫ (2π (|y| − c))^{−e} dy · density over
    /// |y| > radius − c.
    pub(super) fn beyond(&self, radius: f64, e: f64) -> f64 {
        let d = self.lattice.dimension() as f64;
        let from = radius - self.reach;
        if e <= d || from <= self.reach {
            return f64::INFINITY;
        }
        let surface = [2.0, TAU, 2.0 * TAU][self.lattice.dimension() - 1];
        let shrunk = 1.0 - self.reach / from;
        self.density * surface * libm::pow(from, d - e) / (e - d) * libm::pow(TAU * shrunk, -e)
    }
}

/// Shells of the reciprocal lattice, |g| rising.
#[derive(Debug, Clone)]
pub(super) struct Spheres {
    /// |K| Δ by shell.
    pub(super) wave_numbers: Vec<f64>,
    /// |g| = c √n with n squarefree: n and c, by shell.
    pub(super) roots: Vec<(BigInt, Rational)>,
    /// Σ over the shell of (K/|K|)^ν times the cosine (|ν| even) or the sine (odd) of the structure factor.
    sums: BTreeMap<MultiIndex, Vec<f64>>,
    /// Out to this |g| all vectors are here.
    pub(super) radius: f64,
}

impl Spheres {
    /// Gathers the shells with their sums for these monomials.
    pub(super) fn gather(reciprocal: &Reciprocal, monomials: &[MultiIndex]) -> Self {
        let d = reciprocal.lattice.dimension();
        let ball = [2.0, PI, 4.0 / 3.0 * PI][d - 1];
        let radius = libm::pow(VECTORS[d - 1] / (ball * reciprocal.density), 1.0 / d as f64);
        let (weights, unit) = level_weights(&reciprocal.lattice);
        let mut shells: BTreeMap<i128, Vec<f64>> = BTreeMap::new();
        reciprocal.visit(radius, |m, g, [cosine, sine]| {
            let level = (0..d).map(|a| weights[a] * i128::from(m[a] * m[a])).sum();
            let length = g.iter().map(|x| x * x).sum::<f64>().sqrt();
            let n = g.map(|x| x / length);
            let sums = shells.entry(level).or_insert_with(|| vec![0.0; monomials.len()]);
            for (sum, nu) in sums.iter_mut().zip(monomials) {
                let structure = if nu.order() % 2 == 0 { cosine } else { sine };
                *sum += structure * monomial(&n, nu);
            }
        });
        let levels: Vec<Rational> =
            shells.keys().map(|level| &unit * Rational::from_integer(BigInt::from(*level))).collect();
        let roots = levels.iter().map(|square| {
            let root = Radical::sqrt_of(square).unwrap_or_default();
            root.terms()
                .next()
                .map_or((BigInt::one(), Rational::zero()), |(_, n, c)| (n.clone().into(), c.clone()))
        });
        let sums = monomials.iter().enumerate();
        Self {
            wave_numbers: levels.iter().map(|square| TAU * rational_to_f64(square).sqrt()).collect(),
            roots: roots.collect(),
            sums: sums.map(|(i, nu)| (*nu, shells.values().map(|sums| sums[i]).collect())).collect(),
            radius,
        }
    }

    /// The sums of one monomial, by shell.
    pub(super) fn of(&self, nu: &MultiIndex) -> &[f64] {
        self.sums.get(nu).map_or(&[], Vec::as_slice)
    }
}

/// n^ν.
pub(super) fn monomial(n: &[f64; 3], nu: &MultiIndex) -> f64 {
    (0..3).fold(1.0, |product, a| (0..nu.powers[a]).fold(product, |product, _| product * n[a]))
}

/// Whole numbers w_a and a unit with |g|² = Σ w_a m_a² · unit.
fn level_weights(lattice: &Lattice) -> (Vec<i128>, Rational) {
    let squares = &lattice.axis_squares()[..lattice.dimension()];
    let denominator = squares.iter().fold(BigInt::one(), |lcm, s| lcm.lcm(s.denom()));
    let whole: Vec<BigInt> = squares.iter().map(|s| s.numer() * (&denominator / s.denom())).collect();
    let common = whole.iter().fold(BigInt::zero(), |gcd, n| gcd.gcd(n));
    let weights = whole.iter().map(|n| (n / &common).abs().to_i128().unwrap_or(i128::MAX >> 64)).collect();
    (weights, Rational::new(common, denominator))
}
