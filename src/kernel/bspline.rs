//! Schoenberg's B-splines as radial kernels.
//!
//! I. J. Schoenberg, Quart. Appl. Math. 4 (1946) 45–99; in SPH: J. J. Monaghan & J. C. Lattanzio, Astron. Astrophys. 149
//! (1985) 135–143. The central B-spline of degree n with knots one h apart (n odd) is
//! w(q) = Σ_k (−1)^k C(n+1, k) ((n+1)/2 − k − q)₊ⁿ. Its support is R = (n + 1)/2 h: 2h for the cubic, 3h for the quintic.

use super::Kernel;
use crate::exact::{Piecewise, Polynomial, Rational, int, ratio};

/// Cubic spline, R = 2h (Basa et al. 2009; Monaghan & Lattanzio 1985).
pub fn cubic_spline() -> Kernel {
    Kernel::of_catalogue("cubic-spline", "cubic B-spline", "monaghan-lattanzio-1985", central(3))
}

/// Quintic spline, R = 3h (Chaussonnet et al. 2015).
pub fn quintic_spline() -> Kernel {
    Kernel::of_catalogue(
        "quintic-spline",
        "quintic B-spline",
        "schoenberg-1946; chaussonnet-2015, §II.B",
        central(5),
    )
}

/// The central B-spline of this degree on q ≥ 0, from its truncated powers: on each piece those that are positive there.
fn central(degree: u32) -> Result<Piecewise, crate::exact::ExactError> {
    let order = i64::from(degree) + 1;
    let powers: Vec<(Rational, Rational)> = (0..=order / 2)
        .scan(1_i64, |binomial, k| {
            let this = *binomial;
            *binomial = this * (order - k) / (k + 1);
            Some((k, this))
        })
        .map(|(k, binomial)| (ratio(order - 2 * k, 2), int(if k % 2 == 0 { binomial } else { -binomial })))
        .filter(|(edge, _)| *edge > int(0))
        .collect();
    let mut knots: Vec<Rational> = powers.iter().map(|(edge, _)| edge.clone()).collect();
    knots.push(int(0));
    knots.reverse();
    let pieces = knots[1..]
        .iter()
        .map(|right| {
            powers.iter().filter(|(edge, _)| edge >= right).fold(Polynomial::zero(), |sum, (edge, weight)| {
                &sum + &Polynomial::new(vec![edge.clone(), int(-1)]).pow(degree).scale(weight)
            })
        })
        .collect();
    Piecewise::new(knots, pieces)
}
