//! Quadrature rules of Gauss: Legendre's on an interval, Hermite's for the normal law.

use nalgebra::DMatrix;
use std::f64::consts::PI;

/// Nodes and weights.
#[derive(Debug, Clone)]
pub(super) struct Rule {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl Rule {
    /// Each node with its weight.
    pub(super) fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }
}

/// For a mean over the standard normal law, weights of sum 1, exact for polynomials of degree 2n − 1: the eigenvalues of the
/// Jacobi matrix of the polynomials He_k and the squares of the first components of its eigenvectors (Golub & Welsch).
pub(super) fn gauss_hermite(n: usize) -> Rule {
    let beside = |a: usize, b: usize| if a.abs_diff(b) == 1 { (a.max(b) as f64).sqrt() } else { 0.0 };
    let eigen = DMatrix::from_fn(n, n, beside).symmetric_eigen();
    let weights = (0..n).map(|k| eigen.eigenvectors[(0, k)] * eigen.eigenvectors[(0, k)]);
    Rule { nodes: eigen.eigenvalues.iter().copied().collect(), weights: weights.collect() }
}

/// Nodes in (−1, 1), rising, and weights of sum 2, exact for polynomials of degree 2n − 1: Newton's method on P_n from the
/// Chebyshev-like first guess cos(π (k + 3/4)/(n + 1/2)).
pub(super) fn gauss_legendre(n: usize) -> Rule {
    let (mut nodes, mut weights) = (vec![0.0; n], vec![0.0; n]);
    for k in 0..n.div_ceil(2) {
        let mut x = libm::cos(PI * (k as f64 + 0.75) / (n as f64 + 0.5));
        let mut derivative = 1.0;
        for _ in 0..64 {
            // P_n and P_{n−1} by their recurrence.
            let (mut p, mut before) = (1.0, 0.0);
            for m in 1..=n {
                let m = m as f64;
                (p, before) = (((2.0 * m - 1.0) * x * p - (m - 1.0) * before) / m, p);
            }
            derivative = n as f64 * (x * p - before) / (x * x - 1.0);
            let step = p / derivative;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        let weight = 2.0 / ((1.0 - x * x) * derivative * derivative);
        (nodes[k], nodes[n - 1 - k]) = (-x, x);
        (weights[k], weights[n - 1 - k]) = (weight, weight);
    }
    Rule { nodes, weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_exact_to_degree_2n_less_1_and_not_beyond() {
        for n in [1, 2, 5, 16, 41] {
            let rule = gauss_legendre(n);
            let of = |degree: i32| rule.iter().map(|(x, w)| w * x.powi(degree)).sum::<f64>();
            for degree in 0..2 * n as i32 {
                let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
                assert!((of(degree) - exact).abs() < 1e-14, "n = {n}, degree {degree}");
            }
        }
        let sixth: f64 = gauss_legendre(3).iter().map(|(x, w)| w * x.powi(6)).sum();
        assert!((sixth - 2.0 / 7.0).abs() > 1e-3);
    }

    #[test]
    fn hermites_rule_has_the_moments_of_the_normal_law() {
        for n in [2, 5, 12] {
            let rule = gauss_hermite(n);
            let of = |degree: i32| rule.iter().map(|(x, w)| w * x.powi(degree)).sum::<f64>();
            let mut exact = 1.0;
            for degree in (0..2 * n as i32).step_by(2) {
                assert!((of(degree) / exact - 1.0).abs() < 1e-12, "n = {n}, degree {degree}");
                assert!(of(degree + 1).abs() < 1e-12 * exact);
                exact *= f64::from(degree + 1);
            }
            assert!((of(2 * n as i32) / exact - 1.0).abs() > 1e-6, "not beyond, n = {n}");
        }
    }
}
