//! Gauss–Legendre quadrature.

use std::f64::consts::PI;

/// Nodes in (−1, 1), rising, and weights of sum 2, exact for polynomials of degree 2n − 1: Newton's method on P_n from the
/// Chebyshev-like first guess cos(π (k + 3/4)/(n + 1/2)).
pub(super) fn gauss_legendre(n: usize) -> (Vec<f64>, Vec<f64>) {
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
    (nodes, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_exact_to_degree_2n_less_1_and_not_beyond() {
        for n in [1, 2, 5, 16, 41] {
            let (nodes, weights) = gauss_legendre(n);
            let of = |degree: i32| nodes.iter().zip(&weights).map(|(x, w)| w * x.powi(degree)).sum::<f64>();
            for degree in 0..2 * n as i32 {
                let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
                assert!((of(degree) - exact).abs() < 1e-14, "n = {n}, degree {degree}");
            }
        }
        let (nodes, weights) = gauss_legendre(3);
        let sixth: f64 = nodes.iter().zip(&weights).map(|(x, w)| w * x.powi(6)).sum();
        assert!((sixth - 2.0 / 7.0).abs() > 1e-3);
    }
}
