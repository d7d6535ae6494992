//! Schoenberg's B-splines as radial kernels.
//!
//! I. J. Schoenberg, Quart. Appl. Math. 4 (1946) 45–99; in SPH: J. J. Monaghan & J. C. Lattanzio, Astron. Astrophys. 149
//! (1985) 135–143. The central B-spline of degree n with knots one h apart is
//! w(q) = Σ_k (−1)^k C(n+1, k) ((n+1)/2 − k − q)₊ⁿ. Its support is R = (n + 1)/2 h: 2h for the
//! cubic, 5/2 h for the quartic (whose knots are half-integers), 3h for the quintic.

use super::Kernel;
use super::wendland::{over_pi, rational};
use crate::exact::{Piecewise, Polynomial, Rational, int, ratio};

/// Cubic spline, R = 2h (Basa et al. 2009; Monaghan & Lattanzio 1985).
pub fn cubic_spline() -> Kernel {
    Kernel::of_catalogue("cubic-spline", "cubic B-spline", "monaghan-lattanzio-1985", central(3)).printed_by(
        // Printed as 1 − 3/2 q² + 3/4 q³, …
        "monaghan-lattanzio-1985",
        ratio(1, 4),
        [rational(2, 3), over_pi(10, 7), over_pi(1, 1)],
    )
}

/// Quartic spline, R = 5/2 h (Price 2012, Eq. 7; without h, Dehnen & Aly 2012, Table 1).
pub fn quartic_spline() -> Kernel {
    let citation = "schoenberg-1946; dehnen-aly-2012, Table 1";
    Kernel::of_catalogue("quartic-spline", "quartic B-spline", citation, central(4)).printed_by(
        "price-2012, Eq. (7)",
        int(1),
        [rational(1, 24), over_pi(96, 1199), over_pi(1, 20)],
    )
}

/// Quintic spline, R = 3h (Chaussonnet et al. 2015).
pub fn quintic_spline() -> Kernel {
    let citation = "schoenberg-1946; chaussonnet-2015, §II.B";
    Kernel::of_catalogue("quintic-spline", "quintic B-spline", citation, central(5))
        .printed_by("price-2012, Eq. (8)", int(1), [rational(1, 120), over_pi(7, 478), over_pi(1, 120)])
        // Until commit 4f73366. Copied into many codes, such as Project Chrono (SphGeneral.cuh).
        .printed_by("PySPH until 2020", int(1), [None, over_pi(7, 478), over_pi(3, 359)])
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
