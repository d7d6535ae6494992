//! Where a kernel is not smooth: odd powers at the origin, jumps of G_0, G_1, G_2, … at the knots. Exact.

use crate::exact::{Rational, int, rational_to_f64};
use crate::kernel::{Kernel, RadialFunction, RadialPiece};
use num_traits::Zero;

/// The points where w(q) is not smooth, lengths in h.
#[derive(Debug, Clone)]
pub(super) struct Singular {
    /// s and w_s of each odd power w_s q^s at the origin.
    pub(super) odd_powers: Vec<(usize, Rational)>,
    /// The knots at which some derivative jumps.
    pub(super) knots: Vec<Knot>,
    /// What multiplies all jumps: 1, or exp(−c²) of a Gaussian cut at c.
    pub(super) factor: f64,
}

/// One knot.
#[derive(Debug, Clone)]
pub(super) struct Knot {
    /// q.
    pub(super) at: Rational,
    /// r/R.
    pub(super) over_support: Rational,
    /// m: the lowest derivative of w that jumps.
    pub(super) derivative: usize,
    /// [G_k] = right − left, k = 0, 1, …, without the common factor.
    pub(super) jumps: Vec<Rational>,
}

impl Singular {
    /// The jumps of G_0 to G_`highest`.
    pub(super) fn of(kernel: &Kernel, highest: usize) -> Self {
        let support = kernel.support_over_h();
        let odd_powers = kernel.polynomial().map_or_else(Vec::new, |profile| {
            let first = profile.pieces()[0].coefficients().iter().enumerate();
            first.filter(|(s, c)| s % 2 == 1 && !c.is_zero()).map(|(s, c)| (s, c.clone())).collect()
        });
        let functions: Vec<RadialFunction> = (0..=highest).map(|k| kernel.radial_function(k)).collect();
        let knots = kernel.jumps().into_iter().enumerate().filter_map(|(index, jump)| {
            let derivative = jump.order?;
            let jumps = functions.iter().map(|function| match function {
                RadialFunction::Pieces(pieces) => {
                    let right =
                        pieces.get(index + 1).map_or_else(Rational::zero, |piece| value(piece, &jump.at));
                    right - value(&pieces[index], &jump.at)
                }
                RadialFunction::Gaussian { factor } => int(-factor),
            });
            Some(Knot { jumps: jumps.collect(), over_support: &jump.at / support, at: jump.at, derivative })
        });
        let factor = match kernel.polynomial() {
            Some(_) => 1.0,
            None => libm::exp(-rational_to_f64(&(support * support))),
        };
        Self { odd_powers, knots: knots.collect(), factor }
    }
}

fn value(piece: &RadialPiece, q: &Rational) -> Rational {
    piece.numerator.evaluate(q) / num_traits::pow(q.clone(), piece.denominator_power)
}
