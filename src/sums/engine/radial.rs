//! G_k = W′…/r in lanes, as a function of x = r/R.
//!
//! The formulas of [`Evaluator`]: polynomials in s = x_right − x. The powers of s that divide a polynomial are taken out, as
//! these are most of the polynomials of kernels that join zero smoothly.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.

use super::lanes::Lanes;
use crate::kernel::{Evaluator, Kernel, LANES, Shape};

/// The kernel of an engine.
#[derive(Debug, Clone)]
pub(super) enum Radial {
    /// One polynomial for each G_k: apart, as a division in sight is carried out even where no power of x divides.
    Smooth { to: f64, functions: Vec<Function> },
    /// By ascending x.
    Pieces(Vec<Piece>),
    /// G_k = factor_k exp(−rate x²).
    Gaussian { rate: f64, factors: Vec<f64> },
}

#[derive(Debug, Clone)]
pub(super) struct Piece {
    from: f64,
    to: f64,
    functions: Vec<Function>,
}

/// s^power × (descending coefficients in s) × x^{−inverse}.
#[derive(Debug, Clone)]
pub(super) struct Function {
    power: usize,
    coefficients: Vec<f64>,
    inverse: usize,
}

impl Radial {
    /// G_0 … G_`order`. `unit` is G_k's: R^{−D−2k}.
    pub(super) fn new(kernel: &Kernel, dimension: usize, order: usize, unit: impl Fn(usize) -> f64) -> Self {
        match Evaluator::<f64>::new(kernel, dimension, order).shape() {
            Shape::Gaussian { rate, factors } => {
                let factors = factors.iter().enumerate().map(|(k, factor)| factor * unit(k)).collect();
                Self::Gaussian { rate: *rate, factors }
            }
            Shape::Pieces(pieces) => {
                let piece = pieces.iter().map(|piece| Piece {
                    from: piece.from,
                    to: piece.to,
                    functions: piece
                        .functions
                        .iter()
                        .enumerate()
                        .map(|(k, f)| function(f, unit(k)))
                        .collect(),
                });
                let mut pieces: Vec<Piece> = piece.collect();
                match &mut pieces[..] {
                    [only] if only.functions.iter().all(|function| function.inverse == 0) => {
                        Self::Smooth { to: only.to, functions: std::mem::take(&mut only.functions) }
                    }
                    _ => Self::Pieces(pieces),
                }
            }
        }
    }

    /// Those G_k that are wanted, at 0 ≤ x ≤ 1. At x = 0, G_k is its limit where that is finite and 0 where it is not.
    ///
    /// N times eight places at once, as each step of a polynomial waits for the one before it.
    #[inline(always)]
    pub(super) fn evaluate<L: Lanes, const N: usize>(&self, x: [L; N], wanted: &[bool; 3]) -> [[L; N]; 3] {
        let mut g = [[L::splat(0.0); N]; 3];
        match self {
            Self::Smooth { to, functions } => {
                for k in 0..3 {
                    if wanted[k] {
                        g[k] = functions[k].polynomial(*to, x);
                    }
                }
            }
            Self::Pieces(pieces) => {
                for piece in pieces {
                    let from = L::splat(piece.from);
                    for k in 0..3 {
                        if wanted[k] {
                            // A piece holds from its left end on, until the next one takes over.
                            let values = piece.functions[k].at(piece.to, x);
                            for n in 0..N {
                                g[k][n] = x[n].where_below(from, g[k][n], values[n]);
                            }
                        }
                    }
                }
            }
            Self::Gaussian { rate, factors } => {
                for n in 0..N {
                    let mut values = [0.0; LANES];
                    x[n].store(&mut values);
                    let exponential = L::load(&values.map(|x| libm::exp(-rate * x * x)));
                    for k in 0..3 {
                        if wanted[k] {
                            g[k][n] = L::splat(factors[k]).mul(exponential);
                        }
                    }
                }
            }
        }
        g
    }
}

fn function((coefficients, inverse): &(Vec<f64>, usize), unit: f64) -> Function {
    let mut coefficients: Vec<f64> = coefficients.iter().map(|c| c * unit).collect();
    let length = coefficients.len();
    while coefficients.len() > 1 && coefficients.last() == Some(&0.0) {
        coefficients.pop();
    }
    Function { power: length - coefficients.len(), coefficients, inverse: *inverse }
}

impl Function {
    #[inline(always)]
    fn polynomial<L: Lanes, const N: usize>(&self, to: f64, x: [L; N]) -> [L; N] {
        let mut s = x;
        for n in 0..N {
            s[n] = L::splat(to).sub(x[n]);
        }
        let mut coefficients = self.coefficients.iter();
        let mut values = [L::splat(coefficients.next().copied().unwrap_or(0.0)); N];
        for coefficient in coefficients {
            for n in 0..N {
                values[n] = values[n].mul(s[n]).add(L::splat(*coefficient));
            }
        }
        for _ in 0..self.power {
            for n in 0..N {
                values[n] = values[n].mul(s[n]);
            }
        }
        values
    }

    #[inline(always)]
    fn at<L: Lanes, const N: usize>(&self, to: f64, x: [L; N]) -> [L; N] {
        let mut values = self.polynomial(to, x);
        if self.inverse > 0 {
            let zero = L::splat(0.0);
            for n in 0..N {
                let inverse = zero.where_below(x[n], L::splat(1.0).div(x[n]), zero);
                for _ in 0..self.inverse {
                    values[n] = values[n].mul(inverse);
                }
            }
        }
        values
    }
}
