//! The point group of a lattice site, computed, and what it makes of a monomial.
//!
//! The group is found by trying all images of the lattice vectors among lattice vectors of the same length and keeping
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
        let d = lattice.dimension();
        let vectors = lattice.vectors();
        let product = |a: &SiteIndex, b: &SiteIndex| {
            (0..d).fold(int(0), |sum, axis| sum + &lattice.axis_squares()[axis] * int(a[axis] * b[axis]))
        };
        let longest = vectors.iter().map(|v| rational_to_f64(&lattice.square(v))).fold(0.0, f64::max).sqrt();
        let candidates: Vec<SiteIndex> = lattice
            .indices_within(longest * 1.001)
            .into_iter()
            .filter(|k| lattice.is_lattice_vector(*k) && *k != [0, 0, 0])
            .collect();
        let mut images: Vec<Vec<SiteIndex>> = vec![Vec::new()];
        for (row, vector) in vectors.iter().enumerate() {
            images = images
                .into_iter()
                .flat_map(|chosen| {
                    let (chosen, product) = (chosen.clone(), &product);
                    candidates.iter().filter_map(move |candidate| {
                        let fits = product(candidate, candidate) == product(vector, vector)
                            && (0..row)
                                .all(|i| product(candidate, &chosen[i]) == product(vector, &vectors[i]));
                        fits.then(|| [chosen.as_slice(), &[*candidate]].concat())
                    })
                })
                .collect();
        }
        let operations = images
            .iter()
            .map(|image| linear_map(vectors, image, d))
            .filter(|operation| carries_basis_onto_itself(lattice, operation))
            .collect();
        Self { dimension: d, operations }
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
        // Axes that the lattice does not have are left alone by every operation.
        let minus: Operation = std::array::from_fn(|a| {
            std::array::from_fn(|b| match a == b {
                true if a < self.dimension => int(-1),
                same => int(i64::from(same)),
            })
        });
        self.operations.contains(&minus)
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

fn carries_basis_onto_itself(lattice: &Lattice, operation: &Operation) -> bool {
    lattice.basis().iter().all(|particle| {
        apply(operation, particle).is_some_and(|image| {
            lattice
                .basis()
                .iter()
                .any(|other| lattice.is_lattice_vector(std::array::from_fn(|a| image[a] - other[a])))
        })
    })
}
