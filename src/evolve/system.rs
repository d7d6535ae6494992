//! u′ = A u + b.

use super::Matrix;

/// A linear system of ordinary differential equations with a constant source, u′ = A u + b.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// A, square.
    pub matrix: Matrix,
    /// b.
    pub source: Vec<f64>,
}

impl System {
    /// out = u + step (A u + b).
    pub(super) fn step(&self, u: &[f64], step: f64, out: &mut [f64]) {
        self.matrix.rows_with(u, out, |i, value| u[i] + step * (value + self.source[i]));
    }

    /// A u + b.
    pub fn rate(&self, u: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        self.matrix.rows_with(u, &mut out, |i, value| value + self.source[i]);
        out
    }
}
