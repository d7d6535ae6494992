//! The Fourier symbol of an operator on a lattice: what it makes of u = exp(i k·(r − r_i)).
//!
//! σ(k) = Σ_j c_ij exp(i k·(r_j − r_i)), beside the target's own, Σ_α t_α (i k)^α. A mode with σ = 0 that the target does not
//! take to zero is a null mode: the operator does not see it. Where the particles of all weights generate a sublattice of
//! index n, the equations ⟨Lu⟩ = f fall into n sets that do not know of each other. Lengths are in units of Δ.

use super::coefficient::{made_ready, regular_patch};
use super::stencil::{StencilError, stencil};
use crate::exact::{MultiIndex, rational_to_f64};
use crate::kernel::Kernel;
use crate::language::{Coefficient, Field};
use crate::particles::{Lattice, VolumeRule};
use std::f64::consts::PI;
use thiserror::Error;

/// Why an operator has no symbol on a lattice.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SymbolError {
    /// The particles of a cell do not all see the same.
    #[error(
        "the {particles} particles of a cell of lattice '{lattice}' do not all see the same, so that the symbol is a matrix: \
         take a lattice on which they do (line, square, hexagonal, simple-cubic, bcc, fcc)"
    )]
    Basis {
        /// The lattice.
        lattice: String,
        /// Particles of its cell.
        particles: usize,
    },
    /// There is no stencil.
    #[error(transparent)]
    Stencil(#[from] StencilError),
}

/// A complex number, real and imaginary part.
type Complex = [f64; 2];

/// One wave: by component of the field, then of the value.
#[derive(Debug, Clone, PartialEq)]
pub struct SymbolValue {
    /// k Δ.
    pub k: [f64; 3],
    /// σ(k), in units of a power of 1/Δ.
    pub symbol: Vec<[f64; 2]>,
    /// What the target has there.
    pub exact: Vec<[f64; 2]>,
}

/// One particle of the stencil.
#[derive(Debug, Clone)]
struct Entry {
    /// r_j − r_i.
    r: [f64; 3],
    /// Its cell, that of i being the origin.
    cell: [i64; 3],
    /// By component of the field, then of the value.
    weights: Vec<Vec<f64>>,
}

/// The symbol of an operator at the sites of a lattice with one particle a cell.
#[derive(Debug, Clone)]
pub struct Symbol {
    dimension: usize,
    operator: Coefficient,
    entries: Vec<Entry>,
    reciprocal: Vec<[f64; 3]>,
}

impl Symbol {
    /// Of an operator, by its stencil. The order of `operator` has no meaning here.
    ///
    /// # Errors
    /// [`SymbolError`].
    pub fn of(
        operator: &Coefficient,
        kernel: &Kernel,
        lattice: &Lattice,
        support_over_dx: f64,
        rule: VolumeRule,
    ) -> Result<Self, SymbolError> {
        let Some(vectors) = primitive_vectors(lattice) else {
            return Err(SymbolError::Basis {
                lattice: lattice.id().to_owned(),
                particles: lattice.basis().len(),
            });
        };
        let dimension = lattice.dimension();
        let (evaluator, h) = made_ready(kernel, dimension);
        let patch = regular_patch(&evaluator, h, lattice, support_over_dx, rule, operator.is_nested());
        let stencil = stencil(operator.operator(), &patch, patch.centre)?;
        // From units of R to units of Δ.
        let unit = support_over_dx.powi(operator.operator().root.units.length);
        let reciprocal = reciprocal(&vectors, dimension);
        let mut entries: Vec<Entry> = Vec::new();
        for entry in &stencil.entries {
            let r = entry.displacement.map(|x| x * support_over_dx);
            let along = |g: &[f64; 3]| (dot(g, &r) / (2.0 * PI)).round() as i64;
            let mut cell = [0; 3];
            for (c, g) in cell.iter_mut().zip(&reciprocal) {
                *c = along(g);
            }
            let weights: Vec<Vec<f64>> =
                entry.weights.iter().map(|values| values.iter().map(|w| w * unit).collect()).collect();
            match entries.iter_mut().find(|known| known.cell == cell) {
                Some(known) => {
                    for (known, more) in known.weights.iter_mut().flatten().zip(weights.iter().flatten()) {
                        *known += more;
                    }
                }
                None => entries.push(Entry { r, cell, weights }),
            }
        }
        Ok(Self { dimension, operator: operator.clone(), entries, reciprocal })
    }

    /// σ at k, in units of 1/Δ.
    pub fn at(&self, k: [f64; 3]) -> SymbolValue {
        let components = if self.operator.operator().field == Field::Vector { self.dimension } else { 1 };
        let values = self.dimension.pow(u32::from(self.operator.operator().rank()));
        let mut symbol = vec![[0.0; 2]; components * values];
        for Entry { r, weights, .. } in &self.entries {
            let (sine, cosine) = libm::sincos(dot(&k, r));
            for (sum, weight) in symbol.iter_mut().zip(weights.iter().flatten()) {
                sum[0] += weight * cosine;
                sum[1] += weight * sine;
            }
        }
        let exact = (0..components).flat_map(|component| {
            let at = move |value: usize| (component, value);
            (0..values).map(at)
        });
        let exact = exact.map(|(component, value)| self.exact(k, component, value)).collect();
        SymbolValue { k, symbol, exact }
    }

    /// Σ_α t_α (i k)^α.
    fn exact(&self, k: [f64; 3], component: usize, value: usize) -> Complex {
        let Some(target) = self.operator.target() else { return [f64::NAN; 2] };
        let field = self.operator.operator().field;
        let rank = self.operator.operator().rank();
        let mut rest = value;
        let mut indices: Vec<usize> = (0..rank)
            .map(|_| {
                let index = rest % self.dimension;
                rest /= self.dimension;
                index
            })
            .collect();
        indices.reverse();
        let mut sum = 0.0;
        for alpha in MultiIndex::all(self.dimension, target.order()).unwrap_or_default() {
            let letters: Vec<usize> =
                (0..3).flat_map(|axis| std::iter::repeat_n(axis, usize::from(alpha.powers[axis]))).collect();
            let power: f64 = letters.iter().map(|axis| k[*axis]).product();
            sum += rational_to_f64(&target.coefficient(field, &indices, &letters, component)) * power;
        }
        // i^order.
        match target.order() % 4 {
            0 => [sum, 0.0],
            1 => [0.0, sum],
            2 => [-sum, 0.0],
            _ => [0.0, -sum],
        }
    }

    /// The half reciprocal vectors, where a wave has opposite signs on neighbouring planes: by symmetry the only places
    /// where an operator that is odd under inversion must vanish.
    pub fn half_reciprocal_vectors(&self) -> Vec<[f64; 3]> {
        let count = 1_usize << self.dimension;
        let sum = |choice: usize| -> [f64; 3] {
            std::array::from_fn(|a| {
                let chosen = (0..self.dimension).filter(|b| choice >> b & 1 == 1);
                chosen.map(|b| 0.5 * self.reciprocal[b][a]).sum()
            })
        };
        (1..count).map(|choice| self.shortest(sum(choice))).collect()
    }

    /// The shortest of all wave vectors that are the same wave on the lattice.
    fn shortest(&self, k: [f64; 3]) -> [f64; 3] {
        let steps = |axis: usize| if axis < self.dimension { -3..=3 } else { 0..=0 };
        let mut best = k;
        for (a, b, c) in itertools::iproduct!(steps(0), steps(1), steps(2)) {
            let moved: [f64; 3] = std::array::from_fn(|x| {
                let along = self.reciprocal.iter().zip([a, b, c]).map(|(g, n)| f64::from(n) * g[x]);
                k[x] + along.sum::<f64>()
            });
            if dot(&moved, &moved) < dot(&best, &best) - 1e-9 {
                best = moved;
            }
        }
        // Rounding leaves what should be zero.
        best.map(|x| if x.abs() < 1e-12 { 0.0 } else { x })
    }

    /// Whether the wave at k is a null mode: σ vanishes to rounding, and the target's does not.
    pub fn is_null_mode(&self, k: [f64; 3]) -> bool {
        let value = self.at(k);
        let most = |parts: &[Complex]| parts.iter().map(|z| z[0].hypot(z[1])).fold(0.0, f64::max);
        let weights = self.entries.iter().flat_map(|entry| entry.weights.iter().flatten());
        let size: f64 = weights.map(|w| w.abs()).sum();
        most(&value.symbol) <= 1e-12 * size && most(&value.exact) > 1e-9
    }

    /// Into how many sets the particles fall that no weight connects; `None` if infinitely many.
    pub fn decoupled_sets(&self) -> Option<u64> {
        let weight = |entry: &Entry| entry.weights.iter().flatten().map(|w| w.abs()).fold(0.0, f64::max);
        let largest = self.entries.iter().map(weight).fold(0.0, f64::max);
        let connected = self.entries.iter().filter(|entry| weight(entry) > 1e-12 * largest);
        index(connected.map(|entry| entry.cell).collect(), self.dimension)
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// b_m with a_l·b_m = 2π δ_lm.
fn reciprocal(vectors: &[[f64; 3]], dimension: usize) -> Vec<[f64; 3]> {
    let matrix = nalgebra::DMatrix::from_fn(dimension, dimension, |row, a| vectors[row][a]);
    let inverse = matrix.try_inverse().unwrap_or_else(|| unreachable!("lattice vectors are independent"));
    let vector =
        |m: usize| std::array::from_fn(|a| if a < dimension { 2.0 * PI * inverse[(a, m)] } else { 0.0 });
    (0..dimension).map(vector).collect()
}

/// Vectors of a smallest cell, in units of Δ; none if no cell has one particle.
fn primitive_vectors(lattice: &Lattice) -> Option<Vec<[f64; 3]>> {
    let first = lattice.basis()[0];
    let between: Vec<[i64; 3]> =
        lattice.basis().iter().map(|b| std::array::from_fn(|a| b[a] - first[a])).collect();
    if !between.iter().all(|k| lattice.is_translation(*k)) {
        return None;
    }
    let rows = eliminated([lattice.vectors(), &between].concat(), lattice.dimension())?;
    let units = lattice.axis_units();
    Some(rows.iter().map(|k| std::array::from_fn(|a| k[a] as f64 * units[a])).collect())
}

/// The index in Z^D of the lattice that these vectors generate; `None` if it has fewer dimensions.
fn index(rows: Vec<[i64; 3]>, dimension: usize) -> Option<u64> {
    let rows = eliminated(rows, dimension)?;
    Some((0..dimension).map(|column| rows[column][column].unsigned_abs()).product())
}

/// A triangular basis of the lattice that these vectors generate, by integer elimination; `None` if it has fewer dimensions.
fn eliminated(mut rows: Vec<[i64; 3]>, dimension: usize) -> Option<Vec<[i64; 3]>> {
    for column in 0..dimension {
        loop {
            let nonzero = (column..rows.len()).filter(|row| rows[*row][column] != 0);
            let pivot = nonzero.clone().min_by_key(|row| rows[*row][column].abs())?;
            let single = nonzero.count() == 1;
            rows.swap(column, pivot);
            if single {
                break;
            }
            let above = rows[column];
            for row in &mut rows[column + 1..] {
                let times = row[column] / above[column];
                for (entry, pivot) in row.iter_mut().zip(above) {
                    *entry -= times * pivot;
                }
            }
        }
    }
    rows.truncate(dimension);
    Some(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sublattices_have_their_index() {
        assert_eq!(index(vec![[2, 0, 0], [-2, 0, 0], [0, 0, 0]], 1), Some(2));
        assert_eq!(index(vec![[1, 1, 0], [1, -1, 0]], 2), Some(2));
        assert_eq!(index(vec![[1, 1, 0], [1, -1, 0], [0, 3, 0]], 2), Some(1));
        assert_eq!(index(vec![[1, 0, 0], [3, 0, 0]], 2), None);
        assert_eq!(index(vec![[0, 1, 1], [1, 0, 1], [1, 1, 0]], 3), Some(2));
    }
}
