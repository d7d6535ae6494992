//! Piecewise polynomials on `[0, R]`, zero beyond: the shape of every compact radial kernel.

use itertools::Itertools;
use num_traits::Zero;

use super::{ExactError, Polynomial, Rational};

/// Polynomial `pieces[k]` between `knots[k]` and `knots[k + 1]`, zero beyond the last knot.
///
/// All pieces are polynomials in the same variable (not in the distance to their knot). The function is defined for
/// arguments `x ≥ 0`.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Piecewise {
    knots: Vec<Rational>,
    pieces: Vec<Polynomial>,
}

impl Piecewise {
    /// `pieces.len() + 1` knots, increasing from 0, and at least one piece.
    ///
    /// # Errors
    /// [`ExactError::KnotCount`], [`ExactError::FirstKnot`] or [`ExactError::KnotsNotIncreasing`].
    pub fn new(knots: Vec<Rational>, pieces: Vec<Polynomial>) -> Result<Self, ExactError> {
        if pieces.is_empty() || knots.len() != pieces.len() + 1 {
            return Err(ExactError::KnotCount { knots: knots.len(), pieces: pieces.len() });
        }
        if !knots[0].is_zero() {
            return Err(ExactError::FirstKnot { knot: knots[0].to_string() });
        }
        if let Some(index) = (1..knots.len()).find(|&index| knots[index] <= knots[index - 1]) {
            return Err(ExactError::KnotsNotIncreasing { index, knot: knots[index].to_string() });
        }
        Ok(Self { knots, pieces })
    }

    /// The `n + 1` knots, the first of them 0.
    pub fn knots(&self) -> &[Rational] {
        &self.knots
    }

    /// The `n` pieces.
    pub fn pieces(&self) -> &[Polynomial] {
        &self.pieces
    }

    /// The end of the support, which is the last knot.
    pub fn support(&self) -> &Rational {
        &self.knots[self.pieces.len()]
    }

    /// The derivative of each piece. A jump of the function itself leaves no trace (no delta function is added).
    pub fn derivative(&self) -> Self {
        self.map(Polynomial::derivative)
    }

    /// The sum with a function of the same knots; pieces without a partner are left out.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        let pieces = self.pieces.iter().zip(&other.pieces).map(|(a, b)| a + b).collect();
        Self { knots: self.knots.clone(), pieces }
    }

    /// The function times `factor`.
    pub fn times(&self, factor: &Polynomial) -> Self {
        self.map(|piece| piece * factor)
    }

    /// The function times `c`.
    pub fn scale(&self, c: &Rational) -> Self {
        self.map(|piece| piece.scale(c))
    }

    /// `∫₀^R f(x) dx` over the whole support, exact.
    pub fn integrate(&self) -> Rational {
        let integral = |(piece, (from, to)): (&Polynomial, (&Rational, &Rational))| {
            let primitive = piece.antiderivative();
            primitive.evaluate(to) - primitive.evaluate(from)
        };
        self.pieces.iter().zip(self.knots.iter().tuple_windows()).map(integral).sum()
    }

    /// `f(x)`. At a knot the piece on its right counts, except at the last knot, where the last piece does: the support
    /// is the closed interval `[0, R]`. Zero outside it, for negative `x` too.
    pub fn evaluate(&self, x: &Rational) -> Rational {
        self.piece_at(x).map_or_else(Rational::zero, |piece| piece.evaluate(x))
    }

    /// The piece that [`evaluate`](Self::evaluate) uses at `x`; `None` outside `[0, R]`.
    pub fn piece_at(&self, x: &Rational) -> Option<&Polynomial> {
        if x < &self.knots[0] || x > self.support() {
            return None;
        }
        let knots_up_to_x = self.knots.partition_point(|knot| knot <= x);
        self.pieces.get(knots_up_to_x.min(self.pieces.len()) - 1)
    }

    /// The lowest `m ≥ 0` whose `m`-th derivative jumps at knot `k`; `None` if the pieces continue each other.
    ///
    /// Knots are counted from 0 and `k` runs from 1 to the last knot, which is compared with zero outside. Knot 0 has no
    /// piece on its left: there, and beyond the last knot, the answer is `None` too (smoothness at the origin is a matter
    /// of parity, see [`Polynomial::first_odd_power`]).
    pub fn jump_order(&self, k: usize) -> Option<usize> {
        let knot = self.knots.get(k)?;
        let left = self.pieces.get(k.checked_sub(1)?)?;
        let outside = Polynomial::zero();
        let right = self.pieces.get(k).unwrap_or(&outside);
        // In powers of (x - knot) the m-th coefficient of the difference is its m-th derivative over m!.
        let around_knot = Polynomial::new(vec![knot.clone(), super::int(1)]);
        let difference = (right - left).compose(&around_knot);
        difference.coefficients().iter().position(|c| !c.is_zero())
    }

    fn map(&self, change: impl Fn(&Polynomial) -> Polynomial) -> Self {
        Self { knots: self.knots.clone(), pieces: self.pieces.iter().map(change).collect() }
    }
}
