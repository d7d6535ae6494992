//! Finite sums of `rational · √n · π^k`: the numbers in which lattice sums of Wendland and B-spline kernels are exact.
//!
//! Distances on a lattice of rational spacing are `√n` times a rational, a kernel's pieces are polynomials in the distance,
//! and its normalisation brings the power of π.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};
use serde::{Serialize, Serializer};

use super::rational::write_sum;
use super::{Enclosure, ExactError, Rational};

/// Largest trial divisor in the search for a squarefree part: enough for every integer below 2^63.
const LARGEST_DIVISOR: u64 = 1 << 21;

/// `Σ c_{k,n} √n π^k` with rational `c_{k,n} ≠ 0` and squarefree `n ≥ 1`.
///
/// The square roots of distinct squarefree integers are linearly independent over ℚ (A. S. Besicovitch, J. London Math. Soc.
/// 15, 1940), and π is transcendental, so its powers are linearly independent over the algebraic numbers. Hence every such number
/// has exactly one representation of this form: `==` is mathematical equality and [`is_zero`](Self::is_zero) is a proof.
///
/// In JSON it is its [`Display`](fmt::Display) text.
///
/// # Examples
/// ```
/// use remainder::exact::{Radical, int};
/// let root = |n| Radical::sqrt_of(&int(n)).unwrap();
/// let sum = &root(2) + &root(3);
/// assert_eq!((&sum * &sum).to_string(), "5 + 2·√6");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Radical {
    /// Keyed by the power of π and the squarefree integer under the root.
    terms: BTreeMap<(i32, BigUint), Rational>,
}

impl Radical {
    /// Zero.
    pub fn zero() -> Self {
        Self::default()
    }

    /// One.
    pub fn one() -> Self {
        Self::pi_power(0)
    }

    /// `π^k`.
    pub fn pi_power(k: i32) -> Self {
        Self::single(k, BigUint::one(), Rational::one())
    }

    /// `√(p/q) = √(pq) / q` with squares taken out of the root.
    ///
    /// # Errors
    /// [`ExactError::NegativeRadicand`] for a negative radicand, [`ExactError::NotFactored`] if `p` or `q` is above 2^63 and
    /// has a squarefree part that trial division up to 2^21 does not settle.
    pub fn sqrt_of(radicand: &Rational) -> Result<Self, ExactError> {
        if radicand.is_negative() {
            return Err(ExactError::NegativeRadicand { radicand: radicand.to_string() });
        }
        if radicand.is_zero() {
            return Ok(Self::zero());
        }
        // p = a² b and q = c² d have no common factor, so bd is squarefree and √(p/q) = a √(bd) / (cd).
        let (a, b) = take_out_squares(radicand.numer().magnitude())?;
        let (c, d) = take_out_squares(radicand.denom().magnitude())?;
        let outside = Rational::new(BigInt::from(a), BigInt::from(c * &d));
        Ok(Self::single(0, b * d, outside))
    }

    /// The terms as (power of π, squarefree integer under the root, coefficient), in that order.
    pub fn terms(&self) -> impl ExactSizeIterator<Item = (i32, &BigUint, &Rational)> {
        self.terms.iter().map(|((k, n), c)| (*k, n, c))
    }

    /// Whether the number is zero. Either answer is a proof.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// The number as a rational, `None` if it is irrational. Either answer is a proof.
    pub fn as_rational(&self) -> Option<Rational> {
        let mut terms = self.terms();
        match (terms.next(), terms.next()) {
            (None, _) => Some(Rational::zero()),
            (Some((0, n, c)), None) if n.is_one() => Some(c.clone()),
            _ => None,
        }
    }

    /// `c` times the number.
    pub fn scale(&self, c: &Rational) -> Self {
        self * &Self::from(c.clone())
    }

    /// The number to a power, with `x⁰ = 1`.
    pub fn pow(&self, exponent: u32) -> Self {
        (0..exponent).fold(Self::one(), |power, _| &power * self)
    }

    /// The reciprocal of a number with exactly one term, `1/(c √n π^k) = √n π^-k / (cn)`; `None` for any other number.
    pub fn single_term_reciprocal(&self) -> Option<Self> {
        let mut terms = self.terms();
        match (terms.next(), terms.next()) {
            (Some((k, n, c)), None) => {
                let outside = (c * BigInt::from(n.clone())).recip();
                Some(Self::single(-k, n.clone(), outside))
            }
            _ => None,
        }
    }

    /// An enclosure of radius at most `2^-bits`.
    pub fn enclose(&self, bits: u32) -> Enclosure {
        // Each factor of a term is known to 2^-working; `headroom` bounds log₂ of what the others multiply that error by.
        let headroom = |(k, n, c): (i32, &BigUint, &Rational)| {
            let pi = 2 * u64::from(k.unsigned_abs()) + 4;
            c.numer().bits().saturating_sub(c.denom().bits()) + n.bits().div_ceil(2) + pi
        };
        let terms = u64::from(usize::BITS - self.terms.len().leading_zeros());
        let largest = self.terms().map(headroom).max().unwrap_or(0);
        let working = (u64::from(bits) + largest + terms + 4).to_u32().unwrap_or(u32::MAX);

        // `working` is at least 8, so that this enclosure of π is far from zero.
        let pi = Enclosure::pi(working);
        let inverse_pi = Enclosure::from_i64(1).div_separated(&pi, working);
        let sum = self.terms().fold(Enclosure::from_i64(0), |sum, (k, n, c)| {
            let root = Enclosure::sqrt_of_integer(n, working);
            let base = if k < 0 { &inverse_pi } else { &pi };
            let power = base.pow_u32(k.unsigned_abs()).round(working);
            &sum + &(&root * &power).scale(c, working)
        });
        sum.round(bits + 2)
    }

    /// Each term as a number of its own.
    pub(super) fn single_terms(&self) -> impl Iterator<Item = Self> {
        self.terms().map(|(k, n, c)| Self::single(k, n.clone(), c.clone()))
    }

    /// `c √n π^k` for a squarefree `n`.
    fn single(k: i32, n: BigUint, c: Rational) -> Self {
        let mut radical = Self::zero();
        radical.accumulate(k, n, c);
        radical
    }

    /// Adds `c √n π^k` in place, for a squarefree `n`, and drops the term if it cancels.
    fn accumulate(&mut self, k: i32, n: BigUint, c: Rational) {
        let key = (k, n);
        let sum = match self.terms.remove(&key) {
            Some(present) => present + c,
            None => c,
        };
        if !sum.is_zero() {
            self.terms.insert(key, sum);
        }
    }
}

/// `(a, b)` with `integer = a² b` and `b` squarefree, for a positive integer.
///
/// Trial division stops at the cube root of what is left: that has at most two prime factors and is squarefree or a square.
fn take_out_squares(integer: &BigUint) -> Result<(BigUint, BigUint), ExactError> {
    let (mut outside, mut inside, mut rest) = (BigUint::one(), BigUint::one(), integer.clone());
    let mut limit = rest.cbrt();
    for divisor in std::iter::once(2).chain((3..).step_by(2)) {
        if BigUint::from(divisor) > limit {
            break;
        }
        if divisor > LARGEST_DIVISOR {
            // What is left may still be a square, which is all that is asked.
            let root = rest.sqrt();
            if &root * &root == rest {
                break;
            }
            return Err(ExactError::NotFactored { integer: integer.to_string(), limit: LARGEST_DIVISOR });
        }
        let mut multiplicity = 0u32;
        while (&rest % divisor).is_zero() {
            rest /= divisor;
            multiplicity += 1;
        }
        if multiplicity > 0 {
            outside *= BigUint::from(divisor).pow(multiplicity / 2);
            inside *= BigUint::from(divisor).pow(multiplicity % 2);
            limit = rest.cbrt();
        }
    }
    let root = rest.sqrt();
    if &root * &root == rest { Ok((outside * root, inside)) } else { Ok((outside, inside * rest)) }
}

impl From<Rational> for Radical {
    fn from(c: Rational) -> Self {
        Self::single(0, BigUint::one(), c)
    }
}

impl Add for &Radical {
    type Output = Radical;
    fn add(self, other: Self) -> Radical {
        other.terms().fold(self.clone(), |mut sum, (k, n, c)| {
            sum.accumulate(k, n.clone(), c.clone());
            sum
        })
    }
}

impl Sub for &Radical {
    type Output = Radical;
    fn sub(self, other: Self) -> Radical {
        self + &-other
    }
}

impl Mul for &Radical {
    type Output = Radical;

    /// `√m √n = g √(mn/g²)` with `g = gcd(m, n)`, which is squarefree again.
    fn mul(self, other: Self) -> Radical {
        let mut product = Radical::zero();
        for (j, m, a) in self.terms() {
            for (k, n, b) in other.terms() {
                let g = m.gcd(n);
                let inside = (m / &g) * (n / &g);
                product.accumulate(j + k, inside, a * b * BigInt::from(g));
            }
        }
        product
    }
}

impl Neg for &Radical {
    type Output = Radical;
    fn neg(self) -> Radical {
        Radical { terms: self.terms.iter().map(|(key, c)| (key.clone(), -c)).collect() }
    }
}

/// As in `7/2·√3·π^-1 + 1/4`.
impl fmt::Display for Radical {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let symbol = |k: i32, n: &BigUint| {
            let root = if n.is_one() { String::new() } else { format!("√{n}") };
            let pi = match k {
                0 => String::new(),
                1 => "π".to_owned(),
                _ => format!("π^{k}"),
            };
            let dot = if root.is_empty() || pi.is_empty() { "" } else { "·" };
            format!("{root}{dot}{pi}")
        };
        write_sum(f, self.terms().map(|(k, n, c)| (c, symbol(k, n))))
    }
}

impl Serialize for Radical {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
