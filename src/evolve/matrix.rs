//! Sparse matrices by rows, and the few vector operations that go with them.

use rayon::prelude::*;

/// Rows of one task: the order of additions within a row does not depend on it.
const ROWS: usize = 512;

/// Numbers that are added up together in a dot product: fixed, so that threads do not change the result.
const CHUNK: usize = 1024;

/// A sparse matrix: row i has the entries `starts[i] .. starts[i + 1]`, by ascending column.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    width: usize,
}

impl Matrix {
    /// From rows of (column, value); entries of one column are added up, zeros left out.
    pub fn from_rows(width: usize, rows: impl IntoIterator<Item = Vec<(u32, f64)>>) -> Self {
        let mut matrix = Self { starts: vec![0], columns: Vec::new(), values: Vec::new(), width };
        for mut row in rows {
            row.sort_by_key(|(column, _)| *column);
            let start = matrix.columns.len();
            for (column, value) in row {
                if matrix.columns.len() > start && matrix.columns.last() == Some(&column) {
                    if let Some(last) = matrix.values.last_mut() {
                        *last += value;
                    }
                } else if value != 0.0 {
                    matrix.columns.push(column);
                    matrix.values.push(value);
                }
            }
            matrix.starts.push(matrix.columns.len() as u32);
        }
        matrix
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// Bytes of the entries and their places.
    pub fn bytes(&self) -> usize {
        12 * self.values.len() + 4 * self.starts.len()
    }

    /// The entries of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()]
            .iter()
            .map(|column| *column as usize)
            .zip(self.values[range].iter().copied())
    }

    pub(super) fn parts(&self) -> (&[u32], &[u32], &[f64]) {
        (&self.starts, &self.columns, &self.values)
    }

    /// out_i = f(i, (A u)_i).
    pub(super) fn rows_with(&self, u: &[f64], out: &mut [f64], f: impl Fn(usize, f64) -> f64 + Sync) {
        out.par_chunks_mut(ROWS).enumerate().for_each(|(chunk, out)| {
            for (place, out) in out.iter_mut().enumerate() {
                let i = chunk * ROWS + place;
                let range = self.starts[i] as usize..self.starts[i + 1] as usize;
                let (columns, values) = (&self.columns[range.clone()], &self.values[range]);
                // Two sums side by side, so that one addition need not wait for the other.
                let mut sums = [0.0; 2];
                let (mut pairs, mut factors) = (columns.chunks_exact(2), values.chunks_exact(2));
                for (j, a) in pairs.by_ref().zip(factors.by_ref()) {
                    sums[0] += a[0] * u[j[0] as usize];
                    sums[1] += a[1] * u[j[1] as usize];
                }
                for (j, a) in pairs.remainder().iter().zip(factors.remainder()) {
                    sums[0] += a * u[*j as usize];
                }
                *out = f(i, sums[0] + sums[1]);
            }
        });
    }

    /// A u.
    pub fn apply(&self, u: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        self.rows_with(u, &mut out, |_, value| value);
        out
    }

    /// The matrix with dense rows, for eigenvalues of small ones.
    pub fn dense(&self) -> nalgebra::DMatrix<f64> {
        let mut dense = nalgebra::DMatrix::zeros(self.len(), self.width);
        for i in 0..self.len() {
            for (j, value) in self.row(i) {
                dense[(i, j)] = value;
            }
        }
        dense
    }
}

/// a · b, always added up in the same order.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let partial: Vec<f64> = a
        .par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .map(|(a, b)| a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b))
        .collect();
    partial.iter().sum()
}

/// |a|.
pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// a += factor · b.
pub(super) fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    a.par_chunks_mut(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .for_each(|(a, b)| a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b));
}
