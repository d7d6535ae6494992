//! Moment sums over a lattice, exactly.
//!
//! For rational R/Δ every radial function at a site is E + O √n with rational E and O, so a moment component is a finite
//! sum of rational × √n, times ω, σ_D and one square root of its own. [`LatticeSums::exact`] gives that closed form;
//! [`LatticeSums::enclose`] gives the same number as an enclosure, in whole-number arithmetic with a fixed count of
//! fractional bits, fast enough for ladders that reach hundreds of spacings.
//!
//! A kernel that is not polynomial has no closed form: [`LatticeSums::exact`] then answers with an enclosure, and the type
//! of the number says so.
//!
//! Lengths are in units of Δ. Particle i itself is included.

use super::moment::Component;
use super::roots::Roots;
use super::shells::{Shells, split_square};
use super::{Moment, SumError};
use crate::exact::{Coefficient, Enclosure, MultiIndex, Radical, Rational, int, rational_to_f64};
use crate::kernel::{Kernel, RadialFunction, RadialPiece};
use crate::particles::{Lattice, VolumeRule, sites_are_equivalent};
use num_bigint::{BigInt, BigUint};
use num_integer::{Integer, Roots as _};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::BTreeMap;

/// Bytes a site takes while shells are gathered (hash entry and sums), for the estimate before allocating.
const BYTES_PER_SITE: f64 = 64.0;

/// Fractional bits of what [`LatticeSums::exact`] encloses.
const ENCLOSED_BITS: u32 = 256;

/// The sums of one kernel over one lattice, ready for any R/Δ up to a largest one.
#[derive(Debug, Clone)]
pub struct LatticeSums {
    kernel: Kernel,
    lattice: Lattice,
    shells: Shells,
    /// Whether Σ W is the same at every particle, which V = 1/ΣW takes for granted here.
    equivalent_sites: bool,
}

/// The sites of one support.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SupportCount {
    /// Particles in the support without i.
    pub neighbours: u64,
    /// With i.
    pub in_support: u64,
}

impl LatticeSums {
    /// Gathers the shells out to `largest` = R/Δ for these moments (and Σ W, which the number-density rule needs).
    ///
    /// # Errors
    /// [`SumError::Memory`] before anything large is allocated, [`SumError::Support`], [`SumError::TooFine`].
    pub fn new(
        kernel: &Kernel,
        lattice: &Lattice,
        largest: &Rational,
        moments: &[Moment],
        memory_mib: u64,
    ) -> Result<Self, SumError> {
        let radius = rational_to_f64(largest);
        if !largest.is_positive() || !radius.is_finite() {
            return Err(SumError::Support { support_over_dx: largest.to_string() });
        }
        let monomials = monomials_of(moments, lattice.dimension());
        let sites = lattice.estimate_within(radius);
        let needed = sites * (BYTES_PER_SITE + 16.0 * monomials.len() as f64) / f64::from(1 << 20);
        if needed > memory_mib as f64 {
            return Err(SumError::Memory {
                support_over_dx: radius,
                lattice: lattice.id().to_owned(),
                sites,
                needed_mib: needed as u64,
                allowed_mib: memory_mib,
            });
        }
        if !Shells::fit(lattice, radius, &monomials) {
            return Err(SumError::TooFine { support_over_dx: radius, lattice: lattice.id().to_owned() });
        }
        let shells = Shells::gather(lattice, radius, &monomials);
        let equivalent_sites = sites_are_equivalent(lattice);
        Ok(Self { kernel: kernel.clone(), lattice: lattice.clone(), shells, equivalent_sites })
    }

    /// # Errors
    /// [`SumError::UnequalVolumes`] if Σ W differs from particle to particle.
    fn check_equal_volumes(&self) -> Result<(), SumError> {
        if self.equivalent_sites {
            return Ok(());
        }
        Err(SumError::UnequalVolumes { lattice: self.lattice.id().to_owned() })
    }

    /// How many particles the support holds.
    ///
    /// # Errors
    /// [`SumError::NoNeighbours`] if i is alone.
    pub fn count(&self, support_over_dx: &Rational) -> Result<SupportCount, SumError> {
        let (_, in_support) = self.shells.within(support_over_dx);
        if in_support < 2 {
            return Err(SumError::NoNeighbours {
                support_over_dx: rational_to_f64(support_over_dx),
                lattice: self.lattice.id().to_owned(),
                nearest: nearest_distance(&self.lattice),
            });
        }
        Ok(SupportCount { neighbours: in_support - 1, in_support })
    }

    /// The closed form of one component, in units of Δ: a [`Radical`] for constant volumes, a quotient of two for
    /// V = 1/ΣW. For a kernel that is not polynomial, an enclosure.
    ///
    /// # Errors
    /// [`SumError::NoVolume`] if ΣW vanishes under the number-density rule, [`SumError::UnequalVolumes`].
    pub fn exact(
        &self,
        support_over_dx: &Rational,
        component: &Component,
        rule: VolumeRule,
    ) -> Result<Coefficient, SumError> {
        let Some(numerator) = self.bare(support_over_dx, component) else {
            let components = std::slice::from_ref(component);
            let enclosed = self.enclose(support_over_dx, components, rule, ENCLOSED_BITS)?;
            return Ok(enclosed.into_iter().next().map_or_else(Coefficient::zero, Coefficient::from));
        };
        match rule {
            VolumeRule::Constant => Ok(Coefficient::from(&numerator * &self.lattice.particle_volume())),
            VolumeRule::NumberDensity => {
                self.check_equal_volumes()?;
                let sum_w = sum_w_component(self.lattice.dimension());
                let sum_w = self.bare(support_over_dx, &sum_w).unwrap_or_default();
                Coefficient::quotient(numerator, sum_w)
                    .map_err(|_| SumError::NoVolume { support_over_dx: rational_to_f64(support_over_dx) })
            }
        }
    }

    /// Enclosures of components, in units of Δ, from `bits` fractional bits.
    ///
    /// # Errors
    /// [`SumError::NoVolume`] if ΣW is not shown to differ from zero under the number-density rule,
    /// [`SumError::UnequalVolumes`].
    pub fn enclose(
        &self,
        support_over_dx: &Rational,
        components: &[Component],
        rule: VolumeRule,
        bits: u32,
    ) -> Result<Vec<Enclosure>, SumError> {
        let table = RadialTable::new(self, support_over_dx, components, bits);
        let bare: Vec<Enclosure> = components.iter().map(|component| table.sum(component)).collect();
        let weigh = |factor: &Enclosure| bare.iter().map(|sum| (sum * factor).round(bits + 64)).collect();
        match rule {
            VolumeRule::Constant => Ok(weigh(&self.lattice.particle_volume().enclose(bits + 32))),
            VolumeRule::NumberDensity => {
                self.check_equal_volumes()?;
                let sum_w = sum_w_component(self.lattice.dimension());
                let table = RadialTable::new(self, support_over_dx, std::slice::from_ref(&sum_w), bits);
                let density = table.sum(&sum_w);
                bare.iter()
                    .map(|sum| sum.div(&density, bits + 32))
                    .collect::<Result<_, _>>()
                    .map_err(|_| SumError::NoVolume { support_over_dx: rational_to_f64(support_over_dx) })
            }
        }
    }

    /// h in units of Δ.
    fn h(&self, support_over_dx: &Rational) -> Rational {
        support_over_dx / self.kernel.support_over_h()
    }

    /// The sum without ω, as a radical; `None` for a kernel that is not polynomial.
    fn bare(&self, support_over_dx: &Rational, component: &Component) -> Option<Radical> {
        let sigma = self.kernel.normalisation(self.lattice.dimension())?;
        let d = self.lattice.dimension() as u32;
        let h = self.h(support_over_dx);
        let (shells, _) = self.shells.within(support_over_dx);
        // q = √(level · unit) / h.
        let unit = self.shells.unit();
        let (outside, inside) = split_square_of(unit);
        let mut rational = Rational::zero();
        let mut radicals: BTreeMap<BigUint, Rational> = BTreeMap::new();
        for term in &component.terms {
            let weight = int(term.coefficient) * monomial_rational(&self.lattice, &term.monomial)
                / power(&h, d + 2 * term.radial as u32);
            let RadialFunction::Pieces(pieces) = self.kernel.radial_function(term.radial) else {
                return None;
            };
            if term.monomial.order() == 0 {
                rational += &weight * value_at_origin(&pieces[0]);
            }
            let Some(sums) = self.shells.moment(&term.monomial) else { continue };
            for (index, (level, _)) in self.shells.levels()[..shells].iter().enumerate().skip(1) {
                if sums[index] == 0 {
                    continue;
                }
                let square = int(*level as i64) * unit / (&h * &h);
                let Some(piece) = pieces.iter().find(|piece| square < &piece.to * &piece.to) else {
                    continue;
                };
                let (even, odd) = even_and_odd(piece, &square);
                let sum = &weight * Rational::from_integer(sums[index].into());
                rational += &even * &sum;
                if !odd.is_zero() {
                    // q = outside · √(level · inside) / h.
                    let (whole, free) = split_square(*level * inside);
                    let root = &outside * int(whole as i64) / &h;
                    *radicals.entry(free).or_default() += odd * sum * root;
                }
            }
        }
        let sum = radicals.into_iter().fold(Radical::from(rational), |sum, (free, weight)| {
            let root = Radical::sqrt_of(&Rational::from_integer(free.into())).unwrap_or_default();
            &sum + &root.scale(&weight)
        });
        let root = component
            .terms
            .first()
            .map(|term| monomial_root(&self.lattice, &term.monomial))
            .unwrap_or_default();
        Some(&(&sum * &root) * &sigma)
    }
}

/// G_k at every shell of one support, in fixed point, for the k that the components need.
struct RadialTable<'a> {
    sums: &'a LatticeSums,
    h: Rational,
    bits: u32,
    /// By k: the value at each shell (level 0 first) and the bound of its error in units of 2^{-bits}.
    values: [Vec<(BigInt, u64)>; 3],
}

impl<'a> RadialTable<'a> {
    fn new(sums: &'a LatticeSums, support_over_dx: &Rational, components: &[Component], bits: u32) -> Self {
        let h = sums.h(support_over_dx);
        let (shells, _) = sums.shells.within(support_over_dx);
        let levels = &sums.shells.levels()[..shells];
        let unit = sums.shells.unit();
        let (outside, inside) = split_square_of(unit);
        let mut exponentials = None;
        let needed = |k: usize| components.iter().flat_map(|c| &c.terms).any(|term| term.radial == k);
        let mut known = Roots::new(bits);
        let roots: Vec<BigInt> = levels.iter().map(|(level, _)| known.of(level * inside)).collect();
        let step = unit / (&h * &h);
        let values = std::array::from_fn(|k| {
            if !needed(k) {
                return Vec::new();
            }
            let pieces = match sums.kernel.radial_function(k) {
                RadialFunction::Pieces(pieces) => pieces,
                RadialFunction::Gaussian { factor } => {
                    let table = exponentials.get_or_insert_with(|| exponentials_at(levels, &step, bits));
                    return table.iter().map(|v| (v * factor, 2 * factor.unsigned_abs())).collect();
                }
            };
            let origin = fixed(&value_at_origin(&pieces[0]), bits);
            let pieces: Vec<FixedPiece> =
                pieces.iter().map(|piece| FixedPiece::new(piece, &step, &(&outside / &h))).collect();
            let mut values = Vec::with_capacity(levels.len());
            let mut current = 0;
            for ((level, _), root) in levels.iter().zip(&roots) {
                while current + 1 < pieces.len() && BigInt::from(*level) >= pieces[current].first_level_beyond
                {
                    current += 1;
                }
                values.push(if *level == 0 {
                    (origin.clone(), 1)
                } else {
                    pieces[current].evaluate(*level, root, bits)
                });
            }
            values
        });
        Self { sums, h, bits, values }
    }

    /// Σ over the sites of one component, without ω.
    fn sum(&self, component: &Component) -> Enclosure {
        let lattice = &self.sums.lattice;
        let dimension = lattice.dimension();
        let guard = self.bits + 32;
        let total = component.terms.iter().fold(Enclosure::from_i64(0), |total, term| {
            let Some(moments) = self.sums.shells.moment(&term.monomial) else { return total };
            let (mut mid, mut rad) = (BigInt::zero(), BigUint::zero());
            for ((value, error), moment) in self.values[term.radial].iter().zip(moments) {
                if *moment != 0 {
                    mid += value * moment;
                    rad += BigUint::from(moment.unsigned_abs()) * *error;
                }
            }
            let weight = int(term.coefficient) * monomial_rational(lattice, &term.monomial)
                / power(&self.h, dimension as u32 + 2 * term.radial as u32);
            let sum = Enclosure::from_parts(mid, rad, -i64::from(self.bits));
            &total + &(&sum * &Enclosure::exact(&weight, guard)).round(guard + 64)
        });
        let root =
            component.terms.first().map(|term| monomial_root(lattice, &term.monomial)).unwrap_or_default();
        let sigma = self.sums.kernel.enclose_normalisation(dimension, guard);
        let unit = if root == Radical::one() { sigma } else { &root.enclose(guard) * &sigma };
        (&total * &unit).round(guard + 64)
    }
}

/// One piece of G_k with whole-number coefficients: Σ_e a_e q^{e−d} = (even polynomial + √· odd polynomial) in
/// x = level · A, t = q² = level · A/B.
struct FixedPiece {
    /// The first level that is beyond this piece.
    first_level_beyond: BigInt,
    /// Numerator of the level's share of t.
    a: BigInt,
    even: FixedPolynomial,
    odd: FixedPolynomial,
}

/// Σ_j c_j x^j / (denominator · x^shift).
struct FixedPolynomial {
    /// Descending.
    coefficients: Vec<BigInt>,
    denominator: BigInt,
    shift: u32,
}

impl FixedPiece {
    /// `step` is q² of level 1, `root_unit` the q of √(level · inside) = 1.
    fn new(piece: &RadialPiece, step: &Rational, root_unit: &Rational) -> Self {
        let mut parts: [Vec<(i64, Rational)>; 2] = [Vec::new(), Vec::new()];
        for (e, coefficient) in piece.numerator.coefficients().iter().enumerate() {
            let exponent = e as i64 - piece.denominator_power as i64;
            let odd = exponent.rem_euclid(2);
            let scaled = if odd == 1 { coefficient * root_unit } else { coefficient.clone() };
            parts[odd as usize].push(((exponent - odd) / 2, scaled));
        }
        let [even, odd] = parts.map(|terms| FixedPolynomial::new(terms, step));
        let beyond = (&piece.to * &piece.to / step).ceil().to_integer();
        Self { first_level_beyond: beyond, a: step.numer().clone(), even, odd }
    }

    /// G_k at a level, and the bound of the error in units of 2^{-bits}.
    fn evaluate(&self, level: u64, root: &BigInt, bits: u32) -> (BigInt, u64) {
        let x = &self.a * level;
        let even = self.even.evaluate(&x, bits);
        let odd = self.odd.evaluate(&x, bits);
        if odd.is_zero() && self.odd.coefficients.is_empty() {
            return (even, 1);
        }
        // even and odd are off by less than one unit, root by less than two: |Δ(odd·root)| < 2|odd| + |root| + 2, and
        // one for the shift.
        let whole = |v: &BigInt| (v.abs() >> bits).to_u64().unwrap_or(u64::MAX / 8) + 1;
        let error = 2 * whole(&odd) + whole(root) + 4;
        ((even + ((odd * root) >> bits)), error)
    }
}

impl FixedPolynomial {
    /// Σ c t^j from pairs (j, c), with t = x/B and x = level · A for `step` = A/B.
    fn new(terms: Vec<(i64, Rational)>, step: &Rational) -> Self {
        let terms: Vec<(i64, Rational)> = terms.into_iter().filter(|(_, c)| !c.is_zero()).collect();
        let (Some(lowest), Some(highest)) =
            (terms.iter().map(|t| t.0).min(), terms.iter().map(|t| t.0).max())
        else {
            return Self { coefficients: Vec::new(), denominator: BigInt::one(), shift: 0 };
        };
        let b = step.denom();
        let shift = (-lowest).max(0);
        let base = lowest.min(0);
        let lcm = terms.iter().fold(BigInt::one(), |lcm, (_, c)| lcm.lcm(c.denom()));
        // c_j t^j = c_j x^{j+shift} B^{highest−j} / (B^highest x^shift); B^highest may be a negative power.
        let mut coefficients = vec![BigInt::zero(); (highest - base + 1) as usize];
        for (j, c) in &terms {
            let whole = (c * Rational::from_integer(lcm.clone())).to_integer();
            coefficients[(highest - j) as usize] = whole * num_traits::pow(b.clone(), (highest - j) as usize);
        }
        let mut denominator = lcm;
        if highest >= 0 {
            denominator *= num_traits::pow(b.clone(), highest as usize);
        } else {
            let raise = num_traits::pow(b.clone(), (-highest) as usize);
            coefficients.iter_mut().for_each(|c| *c *= &raise);
        }
        Self { coefficients, denominator, shift: shift as u32 }
    }

    fn evaluate(&self, x: &BigInt, bits: u32) -> BigInt {
        let Some((first, rest)) = self.coefficients.split_first() else { return BigInt::zero() };
        let numerator = rest.iter().fold(first.clone(), |sum, c| sum * x + c);
        let denominator =
            if self.shift == 0 { self.denominator.clone() } else { &self.denominator * x.pow(self.shift) };
        (numerator << bits).div_floor(&denominator)
    }
}

/// 2^bits · exp(−level · step) at each shell, off by less than 2: exp(−low) · exp(−high) from two short tables, with eight
/// bits more than asked for.
fn exponentials_at(levels: &[(u64, u64)], step: &Rational, bits: u32) -> Vec<BigInt> {
    let last = levels.last().map_or(0, |(level, _)| *level);
    let block = last.sqrt() + 1;
    let working = bits + 8;
    let table = |unit: &Rational, count: u64| -> Vec<BigInt> {
        let exponent = |n: u64| unit * Rational::from_integer(n.into());
        let value = |n| fixed(&Enclosure::exp_of_negative(&exponent(n), working).midpoint(), working);
        (0..count).map(value).collect()
    };
    let low = table(step, block);
    let high = table(&(step * Rational::from_integer(block.into())), last / block + 1);
    let product = |level: u64| &low[(level % block) as usize] * &high[(level / block) as usize];
    levels.iter().map(|(level, _)| product(*level) >> (working + 8)).collect()
}

fn fixed(value: &Rational, bits: u32) -> BigInt {
    (value.numer() << bits).div_floor(value.denom())
}

/// The even and the odd part of G_k at q² = `square`: G_k = even + q · odd.
fn even_and_odd(piece: &RadialPiece, square: &Rational) -> (Rational, Rational) {
    let (mut even, mut odd) = (Rational::zero(), Rational::zero());
    for (e, coefficient) in piece.numerator.coefficients().iter().enumerate() {
        let exponent = e as i64 - piece.denominator_power as i64;
        let parity = exponent.rem_euclid(2);
        let half = (exponent - parity) / 2;
        let raised =
            if half >= 0 { power(square, half as u32) } else { power(square, (-half) as u32).recip() };
        *(if parity == 0 { &mut even } else { &mut odd }) += coefficient * raised;
    }
    (even, odd)
}

/// G_k(0) where it is finite; where it is not, the summand it belongs to vanishes there by antisymmetry.
fn value_at_origin(first: &RadialPiece) -> Rational {
    if first.denominator_power > 0 {
        return Rational::zero();
    }
    first.numerator.coefficients().first().cloned().unwrap_or_default()
}

/// √(p/q) = outside · √inside with inside a squarefree whole number.
fn split_square_of(value: &Rational) -> (Rational, u64) {
    let product = (value.numer() * value.denom()).to_u64().unwrap_or(1);
    let (whole, free) = split_square(product);
    (int(whole as i64) / Rational::from_integer(value.denom().clone()), free.to_u64().unwrap_or(1))
}

/// The rational part of r_ij^μ / k^μ: (−1)^{|μ|} Π s_a^{⌊μ_a/2⌋}, as r_ij = r_i − r_j = −k √s for i at the origin.
fn monomial_rational(lattice: &Lattice, monomial: &MultiIndex) -> Rational {
    let sign = if monomial.order() % 2 == 0 { 1 } else { -1 };
    (0..3).fold(int(sign), |product, a| {
        product * power(&lattice.axis_squares()[a], u32::from(monomial.powers[a] / 2))
    })
}

/// The radical part of r^μ / k^μ: √Π s_a over the axes with odd μ_a. All terms of a component share it.
fn monomial_root(lattice: &Lattice, monomial: &MultiIndex) -> Radical {
    let product = (0..3).fold(Rational::one(), |product, a| {
        if monomial.powers[a] % 2 == 1 { product * &lattice.axis_squares()[a] } else { product }
    });
    Radical::sqrt_of(&product).unwrap_or_default()
}

fn power(base: &Rational, exponent: u32) -> Rational {
    (0..exponent).fold(Rational::one(), |product, _| product * base)
}

fn sum_w_component(dimension: usize) -> Component {
    let mut components = Moment::default().components(dimension);
    components.swap_remove(0)
}

fn monomials_of(moments: &[Moment], dimension: usize) -> Vec<MultiIndex> {
    let terms = |moment: &Moment| moment.components(dimension).into_iter().flat_map(|c| c.terms);
    let mut monomials: Vec<MultiIndex> = moments.iter().flat_map(terms).map(|term| term.monomial).collect();
    monomials.push(MultiIndex::default());
    monomials.sort();
    monomials.dedup();
    monomials
}

/// The distance to the nearest neighbour, in Δ.
pub fn nearest_distance(lattice: &Lattice) -> f64 {
    // 1.001 Δ reaches it on every lattice whose unit is the cell edge or the nearest distance; double it until it does.
    let mut radius = 1.001;
    loop {
        let nearest = lattice
            .sites_within(radius)
            .iter()
            .map(|site| site.position.iter().map(|x| x * x).sum::<f64>().sqrt())
            .filter(|distance| *distance > 0.0)
            .fold(f64::INFINITY, f64::min);
        if nearest.is_finite() {
            return nearest;
        }
        radius *= 2.0;
    }
}
