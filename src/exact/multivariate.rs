//! Polynomials in x, y and z with rational coefficients.
//!
//! The polynomial factors of a moment sum, and what a lattice basis or a symmetry does to them.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

use num_traits::{One, Zero};

use super::rational::write_sum;
use super::{MultiIndex, Rational};

/// `Σ_α c_α x^α`; no stored coefficient is zero, so `==` is equality of polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Multivariate {
    terms: BTreeMap<MultiIndex, Rational>,
}

impl Multivariate {
    /// The zero polynomial.
    pub fn zero() -> Self {
        Self::default()
    }

    /// The constant `c`.
    pub fn constant(c: Rational) -> Self {
        Self::monomial(MultiIndex::default(), c)
    }

    /// `c x^α`.
    pub fn monomial(index: MultiIndex, c: Rational) -> Self {
        let mut polynomial = Self::zero();
        polynomial.accumulate(index, c);
        polynomial
    }

    /// The non-zero terms in graded order.
    pub fn terms(&self) -> impl Iterator<Item = (MultiIndex, &Rational)> {
        self.terms.iter().map(|(&index, c)| (index, c))
    }

    /// `c_α`, zero if the term is absent.
    pub fn coefficient(&self, index: MultiIndex) -> Rational {
        self.terms.get(&index).cloned().unwrap_or_else(Rational::zero)
    }

    /// Whether this is the zero polynomial.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// `c p`.
    pub fn scale(&self, c: &Rational) -> Self {
        self.terms().fold(Self::zero(), |mut scaled, (index, a)| {
            scaled.accumulate(index, a * c);
            scaled
        })
    }

    /// `p(x, y, z)` at `point = [x, y, z]`.
    pub fn evaluate(&self, point: &[Rational; 3]) -> Rational {
        let monomial = |index: MultiIndex| -> Rational {
            point
                .iter()
                .zip(index.powers)
                .map(|(x, power)| num_traits::pow(x.clone(), power.into()))
                .product()
        };
        self.terms().map(|(index, c)| c * monomial(index)).sum()
    }

    /// `p(M x)`: every `x_a` is replaced by `Σ_b M[a][b] x_b`. The first index of `matrix` is the variable that is replaced.
    pub fn substitute_linear(&self, matrix: &[[Rational; 3]; 3]) -> Self {
        let powers_of_row = |axis: usize| {
            let row = Self::linear(&matrix[axis]);
            let highest = self.terms.keys().map(|index| index.powers[axis]).max().unwrap_or(0);
            let mut powers = vec![Self::constant(Rational::one())];
            for power in 0..usize::from(highest) {
                powers.push(&powers[power] * &row);
            }
            powers
        };
        let [x, y, z] = [powers_of_row(0), powers_of_row(1), powers_of_row(2)];
        self.terms().fold(Self::zero(), |sum, (index, c)| {
            let [a, b, d] = index.powers.map(usize::from);
            &sum + &(&(&x[a] * &y[b]) * &z[d]).scale(c)
        })
    }

    /// `Σ_b row[b] x_b`.
    fn linear(row: &[Rational; 3]) -> Self {
        let axes = [MultiIndex::new([1, 0, 0]), MultiIndex::new([0, 1, 0]), MultiIndex::new([0, 0, 1])];
        let mut form = Self::zero();
        for (axis, c) in axes.into_iter().zip(row) {
            form.accumulate(axis, c.clone());
        }
        form
    }

    /// Adds `c x^α` in place and drops the term if it cancels.
    fn accumulate(&mut self, index: MultiIndex, c: Rational) {
        let sum = self.coefficient(index) + c;
        if sum.is_zero() {
            self.terms.remove(&index);
        } else {
            self.terms.insert(index, sum);
        }
    }
}

impl Add for &Multivariate {
    type Output = Multivariate;
    fn add(self, other: Self) -> Multivariate {
        other.terms().fold(self.clone(), |mut sum, (index, c)| {
            sum.accumulate(index, c.clone());
            sum
        })
    }
}

impl Sub for &Multivariate {
    type Output = Multivariate;
    fn sub(self, other: Self) -> Multivariate {
        self + &-other
    }
}

impl Mul for &Multivariate {
    type Output = Multivariate;

    /// The product.
    ///
    /// # Panics
    /// If a power of the product exceeds 255.
    fn mul(self, other: Self) -> Multivariate {
        let mut product = Multivariate::zero();
        for (alpha, a) in self.terms() {
            for (beta, b) in other.terms() {
                product.accumulate(alpha + beta, a * b);
            }
        }
        product
    }
}

impl Neg for &Multivariate {
    type Output = Multivariate;
    fn neg(self) -> Multivariate {
        self.scale(&-Rational::one())
    }
}

impl fmt::Display for Multivariate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_sum(f, self.terms().map(|(index, c)| (c, index.letters())))
    }
}
