//! The kernel in floating point: W, W′/r and (W′/r)′/r, eight lanes at a time.
//!
//! Lengths are in units of R, x = r/R, W = R^{-D} F(x). Each piece is expanded about its right end, s = x_right − x, and
//! the factor x^{-n} it has in G_k is split off exactly, so that a kernel keeps its relative accuracy where it joins zero
//! and near the origin. No fused operations; the same bits on every machine.

use super::radial::radial_pieces;
use super::{Kernel, Profile};
use crate::exact::{Piecewise, Polynomial, Rational, int, rational_to_f64};
use num_traits::Float;

/// The highest k of G_k.
pub(super) const MOST_ORDER: usize = 4;

/// Lanes of a block.
pub(crate) const LANES: usize = 8;

/// The values of G_0 = F, G_1 = F′/x and G_2 = (F′/x)′/x, unit of length R, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct RadialValues<T> {
    /// G_0, G_1, G_2 by lane; those that were not asked for are zero.
    pub g: [[T; LANES]; 3],
}

/// A kernel made ready for evaluation in T = f32 or f64, in one dimension count, up to G_`order`.
#[derive(Debug, Clone)]
pub struct Evaluator<T> {
    shape: Shape<T>,
    order: usize,
}

/// How G_k is computed.
#[derive(Debug, Clone)]
pub(crate) enum Shape<T> {
    /// Polynomials over powers of x, in ascending order of x.
    Pieces(Vec<Piece<T>>),
    /// G_k = factor_k · exp(−rate · x²) for x < 1.
    Gaussian {
        /// κ².
        rate: f64,
        /// σ_D κ^D (−2 κ²)^k.
        factors: Vec<T>,
    },
}

/// G_k for from ≤ x < to.
#[derive(Debug, Clone)]
pub(crate) struct Piece<T> {
    /// Where it begins.
    pub(crate) from: T,
    /// Where it ends: s = to − x.
    pub(crate) to: T,
    /// For each G_k: descending coefficients in s, and the power n of 1/x.
    pub(crate) functions: Vec<(Vec<T>, usize)>,
}

impl<T: Float> Evaluator<T> {
    /// Prepares G_0 … G_`order`, at most G_4, in `dimension` dimensions.
    pub fn new(kernel: &Kernel, dimension: usize, order: usize) -> Self {
        let order = order.min(MOST_ORDER);
        let kappa = kernel.support_over_h();
        // W = R^{-D} F(x), F = σ_D κ^D w(κ x).
        let sigma = kernel
            .enclose_normalisation(dimension, 128)
            .scale(&power(kappa, dimension as i64), 128)
            .midpoint_f64();
        let shape = match kernel.profile() {
            Profile::Polynomial(profile) => Shape::Pieces(polynomial_pieces(profile, sigma, order)),
            Profile::Gaussian { cut } => {
                let rate = rational_to_f64(&(cut * cut));
                let factor = |k: usize| cast(sigma * (0..k).fold(1.0, |product, _| product * (-2.0 * rate)));
                Shape::Gaussian { rate, factors: (0..=order).map(factor).collect() }
            }
        };
        Self { shape, order }
    }

    /// G_0 … G_order, at most G_2, at x = r/R in each lane. Beyond the support they are zero. At x = 0, G_k is its limit where that
    /// is finite and 0 where it is not: the moments it belongs to vanish there by antisymmetry.
    pub fn evaluate(&self, x: &[T; LANES]) -> RadialValues<T> {
        let mut values = RadialValues { g: [[T::zero(); LANES]; 3] };
        let pieces = match &self.shape {
            Shape::Pieces(pieces) => pieces,
            Shape::Gaussian { rate, factors } => {
                for lane in (0..LANES).filter(|lane| x[*lane] < T::one()) {
                    let x = x[lane].to_f64().unwrap_or(f64::NAN);
                    let exponential: T = cast(libm::exp(-rate * x * x));
                    for (k, factor) in factors.iter().enumerate().take(3) {
                        values.g[k][lane] = *factor * exponential;
                    }
                }
                return values;
            }
        };
        let inverse = x.map(|x| if x > T::zero() { T::one() / x } else { T::zero() });
        for piece in pieces {
            let inside = x.map(|x| x >= piece.from && x < piece.to);
            if !inside.contains(&true) {
                continue;
            }
            let s = x.map(|x| piece.to - x);
            for (k, (coefficients, inverse_power)) in piece.functions.iter().enumerate().take(3) {
                let mut sum = [T::zero(); LANES];
                for coefficient in coefficients {
                    for lane in 0..LANES {
                        sum[lane] = sum[lane] * s[lane] + *coefficient;
                    }
                }
                for _ in 0..*inverse_power {
                    for lane in 0..LANES {
                        sum[lane] = sum[lane] * inverse[lane];
                    }
                }
                for lane in 0..LANES {
                    if inside[lane] {
                        values.g[k][lane] = sum[lane];
                    }
                }
            }
        }
        values
    }

    /// G_0 … G_4 at one x, those up to G_order; as [`Evaluator::evaluate`] at the origin and beyond the support.
    pub fn radial(&self, x: T) -> [T; 5] {
        let mut values = [T::zero(); 5];
        match &self.shape {
            Shape::Pieces(pieces) => {
                let Some(piece) = pieces.iter().find(|piece| x >= piece.from && x < piece.to) else {
                    return values;
                };
                let s = piece.to - x;
                let inverse = if x > T::zero() { T::one() / x } else { T::zero() };
                for (value, (coefficients, inverse_power)) in values.iter_mut().zip(&piece.functions) {
                    let sum = coefficients.iter().fold(T::zero(), |sum, c| sum * s + *c);
                    *value = (0..*inverse_power).fold(sum, |sum, _| sum * inverse);
                }
            }
            Shape::Gaussian { rate, factors } if x < T::one() => {
                let x = x.to_f64().unwrap_or(f64::NAN);
                let exponential: T = cast(libm::exp(-rate * x * x));
                for (value, factor) in values.iter_mut().zip(factors) {
                    *value = *factor * exponential;
                }
            }
            Shape::Gaussian { .. } => {}
        }
        values
    }

    /// The formulas behind the values.
    pub(crate) fn shape(&self) -> &Shape<T> {
        &self.shape
    }

    /// The highest k for which G_k is evaluated.
    pub fn order(&self) -> usize {
        self.order
    }
}

fn polynomial_pieces<T: Float>(profile: &Piecewise, sigma: f64, order: usize) -> Vec<Piece<T>> {
    let kappa = profile.support();
    let by_function: Vec<_> = (0..=order).map(|k| radial_pieces(profile, k)).collect();
    (0..by_function[0].len())
        .map(|index| {
            let edges = &by_function[0][index];
            let functions = by_function
                .iter()
                .enumerate()
                .map(|(k, pieces)| {
                    let piece = &pieces[index];
                    // q = κ (x_right − s): numerator in s; G_k in units of R carries κ^{2k} and κ^{-n} from q^{-n}.
                    let q_of_s = Polynomial::new(vec![piece.to.clone(), -kappa.clone()]);
                    let in_s = piece
                        .numerator
                        .compose(&q_of_s)
                        .scale(&power(kappa, 2 * k as i64 - piece.denominator_power as i64));
                    let coefficients =
                        in_s.coefficients().iter().rev().map(|c| cast(rational_to_f64(c) * sigma)).collect();
                    (coefficients, piece.denominator_power)
                })
                .collect();
            Piece {
                from: cast(rational_to_f64(&(&edges.from / kappa))),
                to: cast(rational_to_f64(&(&edges.to / kappa))),
                functions,
            }
        })
        .collect()
}

fn cast<T: Float>(value: f64) -> T {
    // Every f64 has a nearest f32 and itself as f64; `from` fails for neither.
    T::from(value).unwrap_or_else(T::nan)
}

fn power(base: &Rational, exponent: i64) -> Rational {
    let positive = (0..exponent.abs()).fold(int(1), |product, _| product * base);
    if exponent < 0 { positive.recip() } else { positive }
}
