//! Which sums are wanted, and the fewest passes over a neighbourhood that give them.
//!
//! Every moment is a combination of Σ_j ω_j r^μ G_k (see [`Moment::components`]). A pass takes these for one k and for all
//! degrees |μ| wanted of it; each product r^μ G_k is an earlier one times an axis.

use crate::exact::MultiIndex;
use crate::kernel::LANES;
use crate::sums::{Moment, SumError};

/// The highest degree of r^μ: p = 6 and q = 2.
pub(super) const MOST_DEGREE: usize = 8;

/// The highest k of G_k.
const MOST_RADIAL: usize = 2;

/// What multiplies ω_j in a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Factor {
    /// 1.
    One,
    /// f_j − f_i of the field with this number.
    Difference(usize),
}

/// Σ_j ω_j a_ij r_ij^{⊗p} G_k(|r_ij|), j = i included, with G_0 = W, G_1 = W′/r, G_2 = (W′/r)′/r and a_ij a [`Factor`].
///
/// Its components are those of a symmetric tensor: sorted indices, each once, `xx`, `xy`, `yy`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RadialSum {
    /// p, at most 8.
    pub positions: u8,
    /// k, at most 2.
    pub radial: u8,
    /// a_ij.
    pub factor: Factor,
}

/// All degrees of one r^μ G_k a_ij.
#[derive(Debug, Clone)]
pub(super) struct Pass {
    pub(super) radial: usize,
    pub(super) factor: Factor,
    /// Bit n: degree n is wanted.
    pub(super) degrees: u16,
    /// By degree, where its sums stand if it is wanted.
    pub(super) offsets: [usize; MOST_DEGREE + 1],
}

impl Pass {
    /// The highest degree wanted.
    pub(super) fn highest(&self) -> usize {
        (15 - self.degrees.leading_zeros() as usize).min(MOST_DEGREE)
    }
}

/// What to compute, made ready.
#[derive(Debug, Clone)]
pub(super) struct Plan {
    pub(super) passes: Vec<Pass>,
    /// Number of sums that the passes leave behind, filled up to a multiple of eight.
    pub(super) sums: usize,
    /// By column of the result, Σ coefficient × sum.
    pub(super) columns: Vec<Vec<(f64, usize)>>,
    /// Whether the sums are the columns as they stand.
    pub(super) plain: bool,
    /// Which G_k are needed.
    pub(super) radials: [bool; MOST_RADIAL + 1],
    /// One more than the highest field asked for.
    pub(super) fields: usize,
}

/// How many μ have |μ| = `degree`.
#[inline(always)]
pub(super) const fn monomials(dimension: usize, degree: usize) -> usize {
    match dimension {
        1 => 1,
        2 => degree + 1,
        _ => (degree + 1) * (degree + 2) / 2,
    }
}

/// How many μ have |μ| < `degree`.
#[inline(always)]
pub(super) const fn monomials_below(dimension: usize, degree: usize) -> usize {
    match dimension {
        1 => degree,
        2 => degree * (degree + 1) / 2,
        _ => degree * (degree + 1) * (degree + 2) / 6,
    }
}

/// The place of r^μ among those of its degree: the more x the earlier, then the more y.
fn place(dimension: usize, monomial: &MultiIndex) -> usize {
    let [_, y, z] = monomial.powers.map(usize::from);
    match dimension {
        1 => 0,
        2 => y,
        _ => (y + z) * (y + z + 1) / 2 + z,
    }
}

impl Plan {
    /// For radial sums, component by component.
    ///
    /// # Errors
    /// [`SumError::Moment`] beyond p = 8 or k = 2.
    pub(super) fn of_radial(dimension: usize, wanted: &[RadialSum]) -> Result<Self, SumError> {
        let mut terms = Vec::new();
        for sum in wanted {
            let (p, k) = (usize::from(sum.positions), usize::from(sum.radial));
            if p > MOST_DEGREE || k > MOST_RADIAL {
                return Err(SumError::Moment { what: format!("r^{p} G_{k}") });
            }
            let all = 0..monomials(dimension, p);
            terms.extend(
                all.map(|place| vec![(1.0, Product { radial: k, factor: sum.factor, degree: p, place })]),
            );
        }
        Ok(Self::new(dimension, &terms))
    }

    /// For moments, component by component.
    pub(super) fn of_moments(dimension: usize, moments: &[Moment]) -> Self {
        let components = moments.iter().flat_map(|moment| moment.components(dimension));
        let terms: Vec<Vec<(f64, Product)>> = components
            .map(|component| {
                let product = |monomial: &MultiIndex, radial| Product {
                    radial,
                    factor: Factor::One,
                    degree: monomial.powers.iter().map(|power| usize::from(*power)).sum(),
                    place: place(dimension, monomial),
                };
                let term = component.terms.iter();
                term.map(|t| (t.coefficient as f64, product(&t.monomial, t.radial))).collect()
            })
            .collect();
        Self::new(dimension, &terms)
    }

    fn new(dimension: usize, terms: &[Vec<(f64, Product)>]) -> Self {
        let mut passes: Vec<Pass> = Vec::new();
        let mut sums = 0;
        let columns: Vec<Vec<(f64, usize)>> = terms
            .iter()
            .map(|terms| {
                let sum =
                    |(c, product): &(f64, Product)| (*c, sum_of(product, dimension, &mut passes, &mut sums));
                terms.iter().map(sum).collect()
            })
            .collect();
        let fields = passes.iter().map(|pass| match pass.factor {
            Factor::One => 0,
            Factor::Difference(field) => field + 1,
        });
        Self {
            plain: columns.iter().enumerate().all(|(column, terms)| terms[..] == [(1.0, column)]),
            sums: sums.next_multiple_of(LANES),
            columns,
            radials: std::array::from_fn(|k| passes.iter().any(|pass| pass.radial == k)),
            fields: fields.max().unwrap_or(0),
            passes,
        }
    }

    /// The columns of the result from the sums of one particle.
    pub(super) fn combine(&self, sums: &[f64], columns: &mut [f64]) {
        for (column, terms) in columns.iter_mut().zip(&self.columns) {
            // From +0, so that −0 is never a result: which of both a sum of zeros gives would depend on its neighbours.
            *column = terms.iter().fold(0.0, |column, (coefficient, sum)| column + coefficient * sums[*sum]);
        }
    }
}

/// Where a sum stands; its degree and its pass are entered where they are not known yet.
fn sum_of(product: &Product, dimension: usize, passes: &mut Vec<Pass>, sums: &mut usize) -> usize {
    let Product { radial, factor, degree, place } = *product;
    let known = passes.iter().position(|pass| pass.radial == radial && pass.factor == factor);
    let pass = known.unwrap_or_else(|| {
        passes.push(Pass { radial, factor, degrees: 0, offsets: [0; MOST_DEGREE + 1] });
        passes.len() - 1
    });
    let pass = &mut passes[pass];
    if pass.degrees & (1 << degree) == 0 {
        pass.degrees |= 1 << degree;
        pass.offsets[degree] = *sums;
        *sums += monomials(dimension, degree);
    }
    pass.offsets[degree] + place
}

/// One r^μ G_k a_ij.
#[derive(Debug, Clone, Copy)]
struct Product {
    radial: usize,
    factor: Factor,
    degree: usize,
    place: usize,
}
