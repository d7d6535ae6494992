//! Eigenvalues of assembled operators, and the largest steps that they allow.

use super::matrix::norm;
use super::{Explicit, Matrix};
use nalgebra::Complex;

/// All eigenvalues, by Schur's form of the dense matrix: for matrices of a few hundred rows.
pub fn eigenvalues(matrix: &Matrix) -> Vec<Complex<f64>> {
    let mut values: Vec<Complex<f64>> = matrix.dense().complex_eigenvalues().iter().copied().collect();
    values.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
    values
}

/// An estimate of the spectral radius from below, by `iterations` products with a vector that alternates in sign.
pub fn radius(matrix: &Matrix, iterations: usize) -> f64 {
    // Neither symmetric nor smooth, and the same everywhere.
    let mut state = 1_u64;
    let mut v: Vec<f64> = (0..matrix.len())
        .map(|i| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let jitter = (state >> 40) as f64 / (1_u64 << 24) as f64;
            if i % 2 == 0 { 1.0 + jitter } else { -1.0 - jitter }
        })
        .collect();
    let mut found = 0.0;
    for _ in 0..iterations {
        let size = norm(&v);
        if size == 0.0 {
            return 0.0;
        }
        v.iter_mut().for_each(|v| *v /= size);
        v = matrix.apply(&v);
        found = norm(&v);
    }
    found
}

/// The largest step for which no mode that decays is made to grow: the supremum of all Δt up to which every eigenvalue λ with
/// Re λ < 0 has |R(λΔt)| ≤ 1. `None` if some eigenvalue does not decay.
pub fn largest_step(eigenvalues: &[Complex<f64>], method: Explicit) -> Option<f64> {
    let radius = eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if radius == 0.0 || eigenvalues.iter().any(|value| value.re >= 0.0) {
        return None;
    }
    let stable =
        |step: f64| eigenvalues.iter().all(|value| method.amplification(*value * step).norm() <= 1.0 + 1e-12);
    let (mut low, mut high) = (0.0, 1.0 / radius);
    while stable(high) {
        low = high;
        high *= 1.25;
        if high * radius > 1e6 {
            return Some(low);
        }
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stable(middle) { low = middle } else { high = middle }
    }
    Some(low)
}
