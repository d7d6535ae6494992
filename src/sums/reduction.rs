//! What the symmetry of a site leaves of a moment: which components vanish, which are equal.

use super::moment::{Component, Moment};
use crate::exact::{MultiIndex, Multivariate, Rational, int};
use crate::particles::{Lattice, PointGroup};
use std::collections::BTreeMap;

/// What symmetry says of one component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It has to be computed.
    Free,
    /// It vanishes for every radial kernel and every R/Δ.
    ZeroBySymmetry,
    /// It equals the free component at `index`, or its negative.
    Equal {
        /// Index of the free component.
        index: usize,
        /// Whether the sign is turned.
        negative: bool,
    },
}

/// The components of a moment on a lattice, and what symmetry says of each.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// The components, in the order of [`Moment::components`].
    pub components: Vec<Component>,
    /// One entry per component.
    pub standing: Vec<Standing>,
}

impl Reduction {
    /// Applies the point group to a moment.
    pub fn of(moment: Moment, lattice: &Lattice, group: &PointGroup) -> Self {
        let components = moment.components(lattice.dimension());
        let mut means: BTreeMap<MultiIndex, Multivariate> = BTreeMap::new();
        let invariants: Vec<_> = components
            .iter()
            .map(|component| {
                let mut by_radial: [Multivariate; 3] = std::array::from_fn(|_| Multivariate::zero());
                for term in &component.terms {
                    let mean = means.entry(term.monomial).or_insert_with(|| group.mean(&term.monomial));
                    let weight = int(term.coefficient) * axis_weight(lattice, &term.monomial);
                    by_radial[term.radial] = &by_radial[term.radial] + &mean.scale(&weight);
                }
                let root =
                    component.terms.first().map(|term| odd_axes(lattice, &term.monomial)).unwrap_or(int(1));
                (root, by_radial)
            })
            .collect();
        let mut standing: Vec<Standing> = Vec::with_capacity(components.len());
        for (index, (root, polynomials)) in invariants.iter().enumerate() {
            let same = |sign: i64| {
                (0..index).find(|other| {
                    standing[*other] == Standing::Free
                        && invariants[*other].0 == *root
                        && invariants[*other]
                            .1
                            .iter()
                            .zip(polynomials)
                            .all(|(a, b)| *a == b.scale(&int(sign)))
                })
            };
            let this = if polynomials.iter().all(Multivariate::is_zero) {
                Standing::ZeroBySymmetry
            } else if let Some(index) = same(1) {
                Standing::Equal { index, negative: false }
            } else if let Some(index) = same(-1) {
                Standing::Equal { index, negative: true }
            } else {
                Standing::Free
            };
            standing.push(this);
        }
        Self { components, standing }
    }

    /// Whether every component vanishes by symmetry.
    pub fn vanishes(&self) -> bool {
        self.standing.iter().all(|standing| *standing == Standing::ZeroBySymmetry)
    }

    /// The components that have to be computed, each with the multiplicity of all that equal it.
    pub fn free(&self) -> Vec<Component> {
        let mut free: Vec<(usize, Component)> = Vec::new();
        for (index, (component, standing)) in self.components.iter().zip(&self.standing).enumerate() {
            match standing {
                Standing::Free => free.push((index, component.clone())),
                Standing::Equal { index, .. } => {
                    if let Some((_, target)) = free.iter_mut().find(|(i, _)| i == index) {
                        target.multiplicity += component.multiplicity;
                    }
                }
                Standing::ZeroBySymmetry => {}
            }
        }
        free.into_iter().map(|(_, component)| component).collect()
    }

    /// How many components are zero, and how many equal another.
    pub fn left_out(&self) -> (usize, usize) {
        let zero = self.standing.iter().filter(|s| **s == Standing::ZeroBySymmetry).count();
        let equal = self.standing.iter().filter(|s| matches!(s, Standing::Equal { .. })).count();
        (zero, equal)
    }
}

fn axis_weight(lattice: &Lattice, monomial: &MultiIndex) -> Rational {
    axis_product(lattice, |a| monomial.powers[a] / 2)
}

fn odd_axes(lattice: &Lattice, monomial: &MultiIndex) -> Rational {
    axis_product(lattice, |a| monomial.powers[a] % 2)
}

fn axis_product(lattice: &Lattice, times: impl Fn(usize) -> u8) -> Rational {
    (0..3).fold(int(1), |product, a| {
        (0..times(a)).fold(product, |product, _| product * &lattice.axis_squares()[a])
    })
}
