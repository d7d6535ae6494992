//! The radial functions G_k of a kernel on a block of pairs, lengths in units of R.
//!
//! As in [`crate::kernel::Evaluator`] each piece is expanded about its right end and the power of 1/x split off; besides,
//! only the functions that are used are evaluated, and the power of the distance to the right end is split off as well.

use crate::exact::{Polynomial, Rational, int, rational_to_f64};
use crate::kernel::{Kernel, Profile, RadialFunction, RadialPiece};
use num_traits::Zero;

/// Pairs that go through a polynomial together.
const TOGETHER: usize = 8;

/// Where the distances of a block stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Distance<T> {
    /// As they are.
    Itself(T),
    /// Squared.
    Square(T),
}

/// G_0, G_1, G_2.
#[derive(Debug, Clone)]
pub(super) enum RadialFunctions {
    Pieces([Vec<Piece>; 3]),
    /// G_k = `first` `multiple`^k exp(−`rate` x²).
    Gaussian {
        first: f64,
        multiple: f64,
        rate: f64,
    },
}

/// (Σ_n c_n s^n) s^`zeros` / x^`inverse_power` for `from` ≤ x < `to`, s = `to` − x.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    from: f64,
    to: f64,
    /// Descending.
    coefficients: Vec<f64>,
    zeros: usize,
    inverse_power: usize,
}

impl RadialFunctions {
    pub(super) fn new(kernel: &Kernel, dimension: usize) -> Self {
        let kappa = kernel.support_over_h();
        // W = R^{-D} F(x), F = σ_D κ^D w(κ x).
        let sigma = kernel.enclose_normalisation(dimension, 128).midpoint_f64()
            * rational_to_f64(&power(kappa, dimension as i64));
        if let Profile::Gaussian { cut } = kernel.profile() {
            let rate = rational_to_f64(&(cut * cut));
            return Self::Gaussian { first: sigma, multiple: -2.0 * rate, rate };
        }
        Self::Pieces([0, 1, 2].map(|k| match kernel.radial_function(k) {
            RadialFunction::Pieces(pieces) => {
                pieces.iter().map(|piece| Piece::new(piece, k, kappa, sigma)).collect()
            }
            RadialFunction::Gaussian { .. } => Vec::new(),
        }))
    }

    /// c if G_k = c G_0.
    pub(super) fn multiple_of_first(&self, k: usize) -> Option<f64> {
        match self {
            Self::Pieces(_) => None,
            Self::Gaussian { multiple, .. } => Some(multiple.powi(k as i32)),
        }
    }

    /// Whether G_k is evaluated with 1/x.
    pub(super) fn needs_inverse(&self, k: usize) -> bool {
        match self {
            Self::Pieces(functions) => functions[k].iter().any(|piece| piece.inverse_power > 0),
            Self::Gaussian { .. } => false,
        }
    }

    /// G_k at each x, times the weight; zero from x = 1 on. 1/x is read only if it is needed.
    pub(super) fn evaluate(
        &self,
        k: usize,
        x: Distance<&[f64]>,
        inverse: Option<&[f64]>,
        weight: Option<&[f64]>,
        values: &mut [f64],
    ) {
        match (self, x, weight) {
            // The common case in one loop: a single piece, which vanishes at its end, so that nothing is to be chosen.
            (Self::Pieces(functions), Distance::Square(square), Some(weight)) if functions[k].len() == 1 => {
                let piece = &functions[k][0];
                if piece.zeros > 0 {
                    let eights = square.chunks_exact(TOGETHER).zip(weight.chunks_exact(TOGETHER));
                    for (at, (square, weight)) in eights.enumerate() {
                        let at = at * TOGETHER..(at + 1) * TOGETHER;
                        let x = std::array::from_fn(|lane| square[lane].sqrt());
                        let new = piece.values(x, inverse.map(|inverse| &inverse[at.clone()]));
                        for ((value, new), weight) in values[at].iter_mut().zip(new).zip(weight) {
                            *value = new * weight;
                        }
                    }
                    return;
                }
                self.evaluate_any(k, x, inverse, values);
            }
            _ => self.evaluate_any(k, x, inverse, values),
        }
        if let Some(weight) = weight {
            for (value, weight) in values.iter_mut().zip(weight) {
                *value *= weight;
            }
        }
    }

    fn evaluate_any(&self, k: usize, x: Distance<&[f64]>, inverse: Option<&[f64]>, values: &mut [f64]) {
        let lanes = values.len();
        let x_of = |at: usize| -> [f64; TOGETHER] {
            match x {
                Distance::Itself(x) => std::array::from_fn(|lane| x[at + lane]),
                Distance::Square(square) => std::array::from_fn(|lane| square[at + lane].sqrt()),
            }
        };
        for at in (0..lanes).step_by(TOGETHER) {
            let x = x_of(at);
            let values = &mut values[at..at + TOGETHER];
            match self {
                Self::Gaussian { first, rate, .. } => {
                    for (value, x) in values.iter_mut().zip(x) {
                        *value = if x < 1.0 { first * libm::exp(-rate * x * x) } else { 0.0 };
                    }
                }
                Self::Pieces(functions) => {
                    values.fill(0.0);
                    for piece in &functions[k] {
                        let new = piece.values(x, inverse.map(|inverse| &inverse[at..at + TOGETHER]));
                        for ((value, new), x) in values.iter_mut().zip(new).zip(x) {
                            *value = if x >= piece.from && x < piece.to { new } else { *value };
                        }
                    }
                }
            }
        }
    }
}

impl Piece {
    /// Additions, multiplications and the root of an evaluation.
    pub(super) fn operations(&self) -> u64 {
        (2 * self.coefficients.len() + self.zeros + self.inverse_power + 1) as u64
    }

    fn new(piece: &RadialPiece, k: usize, kappa: &Rational, sigma: f64) -> Self {
        // q = κ (x_right − s): numerator in s; G_k in units of R carries κ^{2k} and κ^{-n} from q^{-n}.
        let q_of_s = Polynomial::new(vec![piece.to.clone(), -kappa.clone()]);
        let scale = power(kappa, 2 * k as i64 - piece.denominator_power as i64);
        let in_s = piece.numerator.compose(&q_of_s).scale(&scale);
        let zeros = in_s.coefficients().iter().position(|c| !c.is_zero()).unwrap_or(0);
        let coefficients = in_s.coefficients().iter().skip(zeros).rev();
        Self {
            from: rational_to_f64(&(&piece.from / kappa)),
            to: rational_to_f64(&(&piece.to / kappa)),
            coefficients: coefficients.map(|c| rational_to_f64(c) * sigma).collect(),
            zeros,
            inverse_power: piece.denominator_power,
        }
    }

    #[inline(always)]
    fn values(&self, x: [f64; TOGETHER], inverse: Option<&[f64]>) -> [f64; TOGETHER] {
        let s = x.map(|x| self.to - x);
        let mut values = [self.coefficients.first().copied().unwrap_or(0.0); TOGETHER];
        for coefficient in self.coefficients.iter().skip(1) {
            for (value, s) in values.iter_mut().zip(s) {
                *value = *value * s + coefficient;
            }
        }
        for _ in 0..self.zeros {
            for (value, s) in values.iter_mut().zip(s) {
                *value *= s;
            }
        }
        if let (true, Some(inverse)) = (self.inverse_power > 0, inverse) {
            for _ in 0..self.inverse_power {
                for (value, inverse) in values.iter_mut().zip(inverse) {
                    *value *= inverse;
                }
            }
        }
        values
    }
}

fn power(base: &Rational, exponent: i64) -> Rational {
    let positive = (0..exponent.abs()).fold(int(1), |product, _| product * base);
    if exponent < 0 { positive.recip() } else { positive }
}
