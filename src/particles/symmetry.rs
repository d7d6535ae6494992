//! The point group of a lattice site, computed, and what it makes of a monomial.
//!
//! The group is found by trying all images of the lattice vectors among translations of the same length and keeping
//! the maps that preserve every scalar product and carry the particles around the site onto each other. In the
//! whole-number coordinates k (see [`super::lattice`]) its matrices are rational, so the mean of a monomial over the
//! group is an exact polynomial: a moment component vanishes by symmetry when that polynomial is zero, and two
//! components are equal when their polynomials are.

use super::lattice::{Lattice, SiteIndex};
use crate::exact::{MultiIndex, Multivariate, Rational, int, rational_to_f64};
use num_traits::{One, Zero};

/// A matrix acting on k.
pub type Operation = [[Rational; 3]; 3];

/// The operations that leave a site and its surroundings as they are.
#[derive(Debug, Clone, PartialEq)]
pub struct PointGroup {
    dimension: usize,
    operations: Vec<Operation>,
}

impl PointGroup {
    /// The point group at the first particle of the basis.
    pub fn of(lattice: &Lattice) -> Self {
        let operations = isometries(lattice)
            .into_iter()
            .filter(|operation| carries_sites_onto_sites(lattice, operation, &[0, 0, 0]))
            .collect();
        Self { dimension: lattice.dimension(), operations }
    }

    /// D.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of operations.
    pub fn order(&self) -> usize {
        self.operations.len()
    }

    /// The operations, as matrices acting on k.
    pub fn operations(&self) -> &[Operation] {
        &self.operations
    }

    /// Whether r → −r is among them.
    pub fn has_inversion(&self) -> bool {
        self.turns(|_| true)
    }

    /// Whether x_axis → −x_axis is among them.
    pub fn has_reflection(&self, axis: usize) -> bool {
        self.turns(|a| a == axis)
    }

    /// Whether turning these axes, and nothing else, is among them.
    fn turns(&self, turned: impl Fn(usize) -> bool) -> bool {
        let image = |a: usize, b: usize| {
            int(if a != b {
                0
            } else if turned(a) {
                -1
            } else {
                1
            })
        };
        let axes = 0..self.dimension;
        self.operations
            .iter()
            .any(|operation| axes.clone().all(|a| axes.clone().all(|b| operation[a][b] == image(a, b))))
    }

    /// The mean of k^monomial over the group.
    pub fn mean(&self, monomial: &MultiIndex) -> Multivariate {
        let one = Multivariate::monomial(*monomial, Rational::one());
        let sum = self
            .operations
            .iter()
            .fold(Multivariate::zero(), |sum, operation| &sum + &one.substitute_linear(operation));
        sum.scale(&(int(1) / int(self.operations.len() as i64)))
    }
}

/// The matrix that carries each vector to its image.
fn linear_map(vectors: &[SiteIndex], images: &[SiteIndex], dimension: usize) -> Operation {
    let mut operation: Operation =
        std::array::from_fn(|a| std::array::from_fn(|b| if a == b { int(1) } else { int(0) }));
    // M V = I with the vectors as columns, by Cramer's rule: M = I V⁻¹.
    let v = |row: usize, axis: usize| int(vectors[row][axis]);
    let determinant = |m: &dyn Fn(usize, usize) -> Rational| match dimension {
        1 => m(0, 0),
        2 => m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
        _ => {
            m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1))
                - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
                + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0))
        }
    };
    let whole = determinant(&v);
    for (a, row) in operation.iter_mut().enumerate().take(dimension) {
        for (b, entry) in row.iter_mut().enumerate().take(dimension) {
            // Σ_r image_r[a] · (coefficient of e_b on vector r).
            *entry = (0..dimension).fold(Rational::zero(), |sum, r| {
                let replaced = |row: usize, axis: usize| {
                    if row == r { int(i64::from(axis == b)) } else { v(row, axis) }
                };
                sum + int(images[r][a]) * determinant(&replaced) / &whole
            });
        }
    }
    operation
}

fn apply(operation: &Operation, k: &SiteIndex) -> Option<SiteIndex> {
    let mut image = [0; 3];
    for (a, component) in image.iter_mut().enumerate() {
        let exact = (0..3).fold(Rational::zero(), |sum, b| sum + &operation[a][b] * int(k[b]));
        *component = i64::try_from(exact.is_integer().then(|| exact.to_integer())?).ok()?;
    }
    Some(image)
}

/// Whether k → Mk + `shift` carries every particle onto a particle.
fn carries_sites_onto_sites(lattice: &Lattice, operation: &Operation, shift: &SiteIndex) -> bool {
    lattice.basis().iter().all(|particle| {
        apply(operation, particle)
            .is_some_and(|image| lattice.has_site(std::array::from_fn(|a| image[a] + shift[a])))
    })
}

/// Whether some isometry of the lattice carries its first particle onto each other one: then every particle sees the same
/// distances, and Σ_k W_jk is the same for all j.
///
/// # Examples
/// ```
/// use remainder::particles::{lattice_by_id, sites_are_equivalent};
/// assert!(sites_are_equivalent(&lattice_by_id("hcp").unwrap()));
/// ```
pub fn sites_are_equivalent(lattice: &Lattice) -> bool {
    let isometries = isometries(lattice);
    lattice
        .basis()
        .iter()
        .all(|target| isometries.iter().any(|operation| carries_sites_onto_sites(lattice, operation, target)))
}

/// All linear maps that carry the lattice's translations onto translations and preserve scalar products.
fn isometries(lattice: &Lattice) -> Vec<Operation> {
    let d = lattice.dimension();
    let vectors = lattice.vectors();
    let product = |a: &SiteIndex, b: &SiteIndex| {
        (0..d).fold(int(0), |sum, axis| sum + &lattice.axis_squares()[axis] * int(a[axis] * b[axis]))
    };
    let squares: Vec<Rational> = vectors.iter().map(|v| lattice.square(v)).collect();
    let longest = squares.iter().map(rational_to_f64).fold(0.0, f64::max).sqrt();
    let candidates: Vec<(SiteIndex, Rational)> = lattice
        .indices_within(longest * 1.001)
        .into_iter()
        .map(|k| (k, lattice.square(&k)))
        .filter(|(k, square)| squares.contains(square) && lattice.is_translation(*k))
        .collect();
    let mut images: Vec<Vec<SiteIndex>> = vec![Vec::new()];
    for (row, vector) in vectors.iter().enumerate() {
        images = images
            .into_iter()
            .flat_map(|chosen| {
                let (chosen, product, squares) = (chosen.clone(), &product, &squares);
                candidates.iter().filter_map(move |(candidate, square)| {
                    let fits = *square == squares[row]
                        && (0..row).all(|i| product(candidate, &chosen[i]) == product(vector, &vectors[i]));
                    fits.then(|| [chosen.as_slice(), &[*candidate]].concat())
                })
            })
            .collect();
    }
    images.iter().map(|image| linear_map(vectors, image, d)).collect()
}
