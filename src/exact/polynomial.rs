//! Polynomials in one variable with rational coefficients.
//!
//! A kernel's piece between two knots is one of these; so is every factor that multiplies it in a radial moment.

use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::BigInt;
use num_traits::{One, Zero};

use super::Rational;
use super::rational::write_sum;

/// `p(x) = c₀ + c₁ x + … + c_d x^d` with `c_d ≠ 0`; the zero polynomial has no coefficients.
///
/// Because trailing zeros are trimmed, `==` is equality of polynomials.
///
/// # Examples
/// ```
/// use remainder::exact::{Polynomial, int};
/// let p = Polynomial::new(vec![int(1), int(2)]);
/// assert_eq!(p.pow(2).to_string(), "1 + 4·x + 4·x^2");
/// assert_eq!(p.antiderivative().derivative(), p);
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Polynomial {
    coefficients: Vec<Rational>,
}

impl Polynomial {
    /// The polynomial with these coefficients in ascending order of power.
    pub fn new(mut coefficients: Vec<Rational>) -> Self {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Self { coefficients }
    }

    /// The zero polynomial.
    pub fn zero() -> Self {
        Self::default()
    }

    /// The constant `c`.
    pub fn constant(c: Rational) -> Self {
        Self::new(vec![c])
    }

    /// `c x^power`.
    pub fn monomial(c: Rational, power: usize) -> Self {
        Self::constant(c).shift_multiply(power)
    }

    /// The coefficients in ascending order of power, the last one non-zero.
    pub fn coefficients(&self) -> &[Rational] {
        &self.coefficients
    }

    /// The highest power with a non-zero coefficient; `None` for the zero polynomial.
    pub fn degree(&self) -> Option<usize> {
        self.coefficients.len().checked_sub(1)
    }

    /// Whether this is the zero polynomial.
    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// `c p(x)`.
    pub fn scale(&self, c: &Rational) -> Self {
        Self::new(self.coefficients.iter().map(|a| a * c).collect())
    }

    /// `p(x)^exponent`, with `p⁰ = 1` for every `p`.
    pub fn pow(&self, exponent: u32) -> Self {
        (0..exponent).fold(Self::constant(Rational::one()), |power, _| &power * self)
    }

    /// `p'(x)`.
    pub fn derivative(&self) -> Self {
        Self::new(self.coefficients.iter().enumerate().skip(1).map(|(power, c)| c * integer(power)).collect())
    }

    /// `∫₀ˣ p(t) dt`.
    pub fn antiderivative(&self) -> Self {
        let raised = self.coefficients.iter().enumerate().map(|(power, c)| c / integer(power + 1));
        Self::new(std::iter::once(Rational::zero()).chain(raised).collect())
    }

    /// `p(x)`.
    pub fn evaluate(&self, x: &Rational) -> Rational {
        self.coefficients.iter().rev().fold(Rational::zero(), |sum, c| sum * x + c)
    }

    /// `p(inner(x))`.
    pub fn compose(&self, inner: &Polynomial) -> Self {
        let step = |sum: Self, c: &Rational| &(&sum * inner) + &Self::constant(c.clone());
        self.coefficients.iter().rev().fold(Self::zero(), step)
    }

    /// `x^k p(x)`.
    pub fn shift_multiply(&self, k: usize) -> Self {
        let mut coefficients = vec![Rational::zero(); k];
        coefficients.extend_from_slice(&self.coefficients);
        Self::new(coefficients)
    }

    /// `p(x) / x^k`, or `None` if the division leaves a remainder.
    pub fn shift_divide(&self, k: usize) -> Option<Self> {
        let k = k.min(self.coefficients.len());
        let (low, high) = self.coefficients.split_at(k);
        low.iter().all(Zero::is_zero).then(|| Self { coefficients: high.to_vec() })
    }

    /// The lowest odd power with a non-zero coefficient; `None` if the polynomial is even.
    ///
    /// For a kernel's innermost piece this is the power that makes `W(|x|)` not smooth at the origin.
    pub fn first_odd_power(&self) -> Option<usize> {
        (1..self.coefficients.len()).step_by(2).find(|&power| !self.coefficients[power].is_zero())
    }

    /// Coefficient by coefficient `combine(a_k, b_k)`, the shorter operand padded with zeros.
    fn zip_with(&self, other: &Self, combine: impl Fn(&Rational, &Rational) -> Rational) -> Self {
        let zero = Rational::zero();
        let length = self.coefficients.len().max(other.coefficients.len());
        let at = |p: &Self, power: usize| p.coefficients.get(power).unwrap_or(&zero).clone();
        Self::new((0..length).map(|power| combine(&at(self, power), &at(other, power))).collect())
    }
}

/// A power as a rational factor.
fn integer(power: usize) -> Rational {
    Rational::from_integer(BigInt::from(power))
}

impl Add for &Polynomial {
    type Output = Polynomial;
    fn add(self, other: Self) -> Polynomial {
        self.zip_with(other, |a, b| a + b)
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;
    fn sub(self, other: Self) -> Polynomial {
        self.zip_with(other, |a, b| a - b)
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;
    fn mul(self, other: Self) -> Polynomial {
        let mut product = vec![Rational::zero(); self.coefficients.len() + other.coefficients.len()];
        for (i, a) in self.coefficients.iter().enumerate() {
            for (j, b) in other.coefficients.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Polynomial::new(product)
    }
}

impl Neg for &Polynomial {
    type Output = Polynomial;
    fn neg(self) -> Polynomial {
        self.zip_with(&Polynomial::zero(), |a, _| -a)
    }
}

impl fmt::Display for Polynomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbol = |power| match power {
            0 => String::new(),
            1 => "x".to_owned(),
            _ => format!("x^{power}"),
        };
        write_sum(f, self.coefficients.iter().enumerate().map(|(power, c)| (c, symbol(power))))
    }
}
