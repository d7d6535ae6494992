//! The sites of a lattice gathered into shells of equal |r|, with the exact moments of each shell.

use crate::exact::{MultiIndex, Radical, Rational, int, rational_to_f64};
use crate::particles::Lattice;
use num_bigint::BigUint;
use num_integer::Integer;
use num_traits::ToPrimitive;
use std::collections::{BTreeMap, HashMap};

/// Shells about the first particle of the basis, out to a radius. Coordinates are the whole numbers k of
/// [`crate::particles::lattice`]: r^μ = k^μ √(Π s_a^{μ_a}).
#[derive(Debug, Clone)]
pub struct Shells {
    radius: f64,
    /// |r|² = level · `unit`, in Δ².
    unit: Rational,
    /// Levels that occur, rising, and the number of sites on each. The first is the site itself, level 0.
    levels: Vec<(u64, u64)>,
    /// Σ k^μ over each shell, by monomial, in the order of `levels`.
    moments: BTreeMap<MultiIndex, Vec<i128>>,
}

impl Shells {
    /// Whether levels and sums out to `radius` (in Δ) fit their types, with room to spare.
    pub fn fit(lattice: &Lattice, radius: f64, monomials: &[MultiIndex]) -> bool {
        let (weights, unit) = level_weights(lattice);
        let levels = radius * radius / rational_to_f64(&unit);
        let k = weights.iter().map(|weight| (levels / *weight as f64).sqrt()).fold(1.0, f64::max);
        let order = monomials.iter().map(MultiIndex::order).max().unwrap_or(0);
        let sums = lattice.estimate_within(radius + 1.0) * k.powi(order as i32);
        !weights.contains(&i64::MAX) && levels < 2_f64.powi(60) && sums < 2_f64.powi(120)
    }

    /// Gathers the sites within `radius` (in Δ), with Σ k^μ for each monomial asked for.
    pub fn gather(lattice: &Lattice, radius: f64, monomials: &[MultiIndex]) -> Self {
        let (weights, unit) = level_weights(lattice);
        let mut monomials = monomials.to_vec();
        monomials.sort();
        monomials.dedup();
        let width = monomials.len();
        let mut place: HashMap<u64, usize> = HashMap::new();
        let (mut counts, mut sums): (Vec<(u64, u64)>, Vec<i128>) = (Vec::new(), Vec::new());
        lattice.visit_indices(radius, |k| {
            let level = weights.iter().zip(k).map(|(weight, k)| weight * k * k).sum::<i64>() as u64;
            let shell = *place.entry(level).or_insert_with(|| {
                counts.push((level, 0));
                sums.resize(sums.len() + width, 0);
                counts.len() - 1
            });
            counts[shell].1 += 1;
            for (sum, monomial) in sums[shell * width..].iter_mut().zip(&monomials) {
                let powers = monomial.powers;
                *sum += (0..3).fold(1, |product, a| product * i128::from(k[a]).pow(u32::from(powers[a])));
            }
        });
        let mut order: Vec<usize> = (0..counts.len()).collect();
        order.sort_by_key(|shell| counts[*shell].0);
        let levels = order.iter().map(|shell| counts[*shell]).collect();
        let moments = monomials
            .iter()
            .enumerate()
            .map(|(index, monomial)| {
                (*monomial, order.iter().map(|shell| sums[shell * width + index]).collect())
            })
            .collect();
        Self { radius, unit, levels, moments }
    }

    /// The radius out to which all sites are here, in Δ.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// |r|² in Δ² of level 1.
    pub fn unit(&self) -> &Rational {
        &self.unit
    }

    /// The levels that occur with the number of sites on each.
    pub fn levels(&self) -> &[(u64, u64)] {
        &self.levels
    }

    /// Σ k^μ over each shell.
    pub fn moment(&self, monomial: &MultiIndex) -> Option<&[i128]> {
        self.moments.get(monomial).map(Vec::as_slice)
    }

    /// How many shells and sites lie strictly within `support` (in Δ), the site itself included.
    pub fn within(&self, support: &Rational) -> (usize, u64) {
        let limit = support * support / &self.unit;
        // level < limit ⟺ level ≤ ⌈limit⌉ − 1.
        let last = (limit.ceil().to_integer() - 1_i32).to_u64().unwrap_or(u64::MAX);
        let shells = self.levels.partition_point(|(level, _)| *level <= last);
        (shells, self.levels[..shells].iter().map(|(_, count)| count).sum())
    }

    /// √(Π s_a^{μ_a}), the factor between k^μ and r^μ.
    pub fn monomial_unit(lattice: &Lattice, monomial: &MultiIndex) -> Radical {
        let product = (0..3).fold(int(1), |product, a| {
            (0..monomial.powers[a]).fold(product, |product, _| product * &lattice.axis_squares()[a])
        });
        Radical::sqrt_of(&product).unwrap_or_default()
    }
}

/// Whole numbers w_a and the unit in Δ² with |r|² = Σ w_a k_a² · unit; an w_a beyond its type is `i64::MAX`.
fn level_weights(lattice: &Lattice) -> (Vec<i64>, Rational) {
    let squares = &lattice.axis_squares()[..lattice.dimension()];
    // The common measure of the axis squares: |r|² is a whole multiple of it.
    let denominator = squares.iter().fold(num_bigint::BigInt::from(1), |lcm, s| lcm.lcm(s.denom()));
    let numerators: Vec<_> =
        squares.iter().map(|s| (s * Rational::from_integer(denominator.clone())).to_integer()).collect();
    let common = numerators.iter().fold(num_bigint::BigInt::from(0), |gcd, n| gcd.gcd(n));
    let weights = numerators.iter().map(|n| (n / &common).to_i64().unwrap_or(i64::MAX)).collect();
    (weights, Rational::new(common, denominator))
}

/// n = square² · free with free squarefree, for a level of a shell.
pub(super) fn split_square(n: u64) -> (u64, BigUint) {
    let (mut square, mut free, mut rest, mut factor) = (1, 1, n, 2);
    while factor * factor <= rest {
        let mut power = 0;
        while rest % factor == 0 {
            rest /= factor;
            power += 1;
        }
        square *= factor.pow(power / 2);
        if power % 2 == 1 {
            free *= factor;
        }
        factor += 1;
    }
    (square, BigUint::from(free * rest))
}
