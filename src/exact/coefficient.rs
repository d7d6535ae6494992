//! A number that stays exact for as long as its operands are, and says which kind it is.

use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

use super::{Enclosure, ExactError, Radical, Rational, rational_to_f64};

/// An answer that may be "cannot tell".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Truth {
    /// Proved.
    True,
    /// Disproved.
    False,
    /// The enclosure is too wide to tell.
    Unknown,
}

/// A coefficient of an expansion, in the simplest form that holds it exactly, or an enclosure.
///
/// Build it with `From` or [`quotient`](Self::quotient): those and all operations normalise downwards, so that a rational is
/// always `Exact` and zero that is known to be zero is always `Exact(0)`. A result is `Enclosed` only if an operand is.
///
/// `==` compares representations. For two coefficients that are `Exact` or `Radical` this is mathematical equality; for the
/// other kinds ask [`equals`](Self::equals).
///
/// In JSON `{"kind": "radical", "text": "1/2·√3"}`, with [`kind`](Self::kind) and the [`Display`](fmt::Display) text.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Coefficient {
    /// A rational number.
    Exact(Rational),
    /// An irrational sum of `rational · √n · π^k`.
    Radical(Radical),
    /// A ratio of two such sums that is not known to be one itself.
    #[non_exhaustive]
    Quotient {
        /// Not zero.
        numerator: Radical,
        /// Not zero, at least two terms, the first coefficient 1.
        denominator: Radical,
    },
    /// A number known to lie in a ball.
    Enclosed(Enclosure),
}

impl Coefficient {
    /// Zero, exactly.
    pub fn zero() -> Self {
        Self::Exact(Rational::zero())
    }

    /// One, exactly.
    pub fn one() -> Self {
        Self::Exact(Rational::one())
    }

    /// `numerator / denominator`.
    ///
    /// # Errors
    /// [`ExactError::DivisionByZero`] if the denominator is zero.
    ///
    /// # Examples
    /// ```
    /// use remainder::exact::{Coefficient, Radical, int, ratio};
    /// let root = Radical::sqrt_of(&int(3)).unwrap();
    /// let three = Radical::from(int(3));
    /// assert_eq!(Coefficient::quotient(root, three).unwrap().to_string(), "1/3·√3");
    /// ```
    pub fn quotient(numerator: Radical, denominator: Radical) -> Result<Self, ExactError> {
        if denominator.is_zero() {
            return Err(ExactError::DivisionByZero { what: format!("({numerator})/({denominator})") });
        }
        Ok(Self::normalised(&numerator, &denominator))
    }

    /// `self / divisor`.
    ///
    /// # Errors
    /// [`ExactError::DivisionByZero`] if the divisor is zero, [`ExactError::DivisorMayVanish`] if it is an enclosure that
    /// contains zero.
    pub fn div(&self, divisor: &Self) -> Result<Self, ExactError> {
        if divisor.is_zero() == Truth::True {
            return Err(ExactError::DivisionByZero { what: format!("({self})/({divisor})") });
        }
        if let (Some((a, b)), Some((c, d))) = (self.fraction(), divisor.fraction()) {
            return Self::quotient(&a * &d, &b * &c);
        }
        if self.is_zero() == Truth::True && divisor.is_zero() == Truth::False {
            return Ok(Self::zero());
        }
        let (x, y) = Self::factors(self, divisor);
        let accuracy = accuracy(&x).min(accuracy(&y));
        let bits = MARGIN + accuracy + magnitude(&largest(&y)) - magnitude(&largest(&x));
        Ok(Self::from(x.div(&y, clamp_bits(bits))?.trimmed()))
    }

    /// Whether the number is zero. For every kind but `Enclosed` this is decided.
    pub fn is_zero(&self) -> Truth {
        let decided = |zero| if zero { Truth::True } else { Truth::False };
        match self {
            Self::Exact(value) => decided(value.is_zero()),
            Self::Radical(radical) => decided(radical.is_zero()),
            Self::Quotient { numerator, .. } => decided(numerator.is_zero()),
            Self::Enclosed(enclosure) => match enclosure.sign() {
                Some(sign) => decided(sign.is_eq()),
                None => Truth::Unknown,
            },
        }
    }

    /// Whether two coefficients are the same number, by [`is_zero`](Self::is_zero) of their difference.
    pub fn equals(&self, other: &Self) -> Truth {
        (self - other).is_zero()
    }

    /// An enclosure of radius at most `2^-bits`; an `Enclosed` number is returned as it is, whatever its radius.
    pub fn enclose(&self, bits: u32) -> Enclosure {
        match self {
            Self::Exact(value) => Enclosure::exact(value, bits),
            Self::Radical(radical) => radical.enclose(bits),
            Self::Quotient { numerator, denominator } => enclose_quotient(numerator, denominator, bits),
            Self::Enclosed(enclosure) => enclosure.clone(),
        }
    }

    /// An enclosure whose [`relative_accuracy_bits`](Enclosure::relative_accuracy_bits) are at least `accuracy`; an
    /// `Enclosed` number is returned as it is.
    pub fn enclose_relative(&self, accuracy: u32) -> Enclosure {
        if self.is_zero() == Truth::True {
            return Enclosure::from_i64(0);
        }
        let mut bits = accuracy.saturating_add(32);
        loop {
            let enclosure = self.enclose(bits);
            // An exact number that is not zero gets there, since the radius halves with every bit.
            let accurate = enclosure.relative_accuracy_bits() >= Some(accuracy.into());
            if accurate || matches!(self, Self::Enclosed(_)) || bits == u32::MAX {
                return enclosure;
            }
            bits = bits.saturating_mul(2);
        }
    }

    /// The number as an `f64`, within 1 ulp for the exact kinds; the midpoint of an enclosure.
    pub fn to_f64(&self) -> f64 {
        match self {
            Self::Exact(value) => rational_to_f64(value),
            _ => self.enclose_relative(64).midpoint_f64(),
        }
    }

    /// `exact`, `radical`, `quotient` or `enclosed`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Exact(_) => "exact",
            Self::Radical(_) => "radical",
            Self::Quotient { .. } => "quotient",
            Self::Enclosed(_) => "enclosed",
        }
    }

    /// The simplest form of `numerator / denominator`, for a denominator that is not zero.
    fn normalised(numerator: &Radical, denominator: &Radical) -> Self {
        debug_assert!(!denominator.is_zero());
        if let Some(reciprocal) = denominator.single_term_reciprocal() {
            return Self::from(numerator * &reciprocal);
        }
        // The coefficient and the power of π of the denominator's first term are free: make them 1 and 0.
        let (unit, power) =
            denominator.terms().next().map_or_else(|| (Rational::one(), 0), |(k, _, c)| (c.recip(), -k));
        let factor = Radical::pi_power(power).scale(&unit);
        let (numerator, denominator) = (numerator * &factor, denominator * &factor);
        match single_term_ratio(&numerator, &denominator) {
            Some(ratio) => Self::from(ratio),
            None => Self::Quotient { numerator, denominator },
        }
    }

    /// The number as numerator and denominator, unless it is an enclosure.
    fn fraction(&self) -> Option<(Radical, Radical)> {
        match self {
            Self::Exact(value) => Some((Radical::from(value.clone()), Radical::one())),
            Self::Radical(radical) => Some((radical.clone(), Radical::one())),
            Self::Quotient { numerator, denominator } => Some((numerator.clone(), denominator.clone())),
            Self::Enclosed(_) => None,
        }
    }

    /// Both operands as enclosures, an exact one so accurate relatively that it hardly widens a product.
    fn factors(a: &Self, b: &Self) -> (Enclosure, Enclosure) {
        let given = |c: &Self| match c {
            Self::Enclosed(enclosure) => accuracy(enclosure),
            _ => 0,
        };
        let needed = clamp_bits(given(a).max(given(b)) + MARGIN);
        (a.enclose_relative(needed), b.enclose_relative(needed))
    }

    /// Both operands as enclosures, an exact one so accurate absolutely that it hardly widens a sum.
    fn addends(a: &Self, b: &Self) -> (Enclosure, Enclosure) {
        let given = |c: &Self| match c {
            Self::Enclosed(enclosure) => -magnitude(&enclosure.radius()),
            _ => 0,
        };
        let needed = clamp_bits(given(a).max(given(b)) + MARGIN);
        (a.enclose(needed), b.enclose(needed))
    }
}

/// Binary digits by which an exact operand, or a rounding, is finer than the enclosure it meets.
const MARGIN: i64 = 64;

/// Relative accuracy of an enclosure in bits, at most 4096 so that one of radius zero does not ask for more.
fn accuracy(enclosure: &Enclosure) -> i64 {
    enclosure.relative_accuracy_bits().unwrap_or(0).min(4096)
}

/// The largest absolute value that an enclosure contains.
fn largest(enclosure: &Enclosure) -> Rational {
    enclosure.midpoint().abs() + enclosure.radius()
}

/// `log₂` of a positive number, within 1.
fn magnitude(value: &Rational) -> i64 {
    value.numer().bits() as i64 - value.denom().bits() as i64
}

fn clamp_bits(bits: i64) -> u32 {
    u32::try_from(bits.max(0)).unwrap_or(u32::MAX)
}

/// `numerator / denominator` for a denominator that is not zero.
fn enclose_quotient(numerator: &Radical, denominator: &Radical, bits: u32) -> Enclosure {
    debug_assert!(!denominator.is_zero());
    let target = Rational::new(BigInt::one(), BigInt::one() << bits);
    let mut working = bits.saturating_add(32);
    loop {
        // The denominator is not zero, so that enough digits separate it from zero.
        let (above, below) = (numerator.enclose(working), denominator.enclose(working));
        match above.div(&below, bits.saturating_add(2)) {
            Ok(quotient) if quotient.radius() <= target => return quotient,
            _ => working = working.saturating_mul(2),
        }
    }
}

/// The `t` of a single term with `numerator = t · denominator`, if there is one.
fn single_term_ratio(numerator: &Radical, denominator: &Radical) -> Option<Radical> {
    if numerator.is_zero() {
        return Some(Radical::zero());
    }
    // Multiplication by one term maps terms one to one, so one of them is t times the denominator's first.
    if numerator.terms().len() != denominator.terms().len() {
        return None;
    }
    let reciprocal = denominator.single_terms().next()?.single_term_reciprocal()?;
    numerator.single_terms().map(|term| &term * &reciprocal).find(|t| t * denominator == *numerator)
}

impl From<Rational> for Coefficient {
    fn from(value: Rational) -> Self {
        Self::Exact(value)
    }
}

impl From<Radical> for Coefficient {
    fn from(radical: Radical) -> Self {
        match radical.as_rational() {
            Some(value) => Self::Exact(value),
            None => Self::Radical(radical),
        }
    }
}

impl From<Enclosure> for Coefficient {
    /// An enclosure of radius zero is the rational number it encloses.
    fn from(enclosure: Enclosure) -> Self {
        if enclosure.radius().is_zero() {
            Self::Exact(enclosure.midpoint())
        } else {
            Self::Enclosed(enclosure)
        }
    }
}

impl Add for &Coefficient {
    type Output = Coefficient;
    fn add(self, other: Self) -> Coefficient {
        match (self, other) {
            (Coefficient::Exact(a), Coefficient::Exact(b)) => return Coefficient::Exact(a + b),
            (zero, sum) | (sum, zero) if zero.is_zero() == Truth::True => return sum.clone(),
            _ => {}
        }
        match (self.fraction(), other.fraction()) {
            (Some((a, b)), Some((c, d))) if b == d => Coefficient::normalised(&(&a + &c), &b),
            // Neither denominator is zero, so their product is not.
            (Some((a, b)), Some((c, d))) => Coefficient::normalised(&(&(&a * &d) + &(&c * &b)), &(&b * &d)),
            _ => {
                let (x, y) = Coefficient::addends(self, other);
                Coefficient::from((&x + &y).trimmed())
            }
        }
    }
}

impl Sub for &Coefficient {
    type Output = Coefficient;
    fn sub(self, other: Self) -> Coefficient {
        self + &-other
    }
}

impl Mul for &Coefficient {
    type Output = Coefficient;
    fn mul(self, other: Self) -> Coefficient {
        if self.is_zero() == Truth::True || other.is_zero() == Truth::True {
            return Coefficient::zero();
        }
        match (self.fraction(), other.fraction()) {
            // Neither denominator is zero, so their product is not.
            (Some((a, b)), Some((c, d))) => Coefficient::normalised(&(&a * &c), &(&b * &d)),
            _ => {
                let (x, y) = Coefficient::factors(self, other);
                Coefficient::from((&x * &y).trimmed())
            }
        }
    }
}

impl Neg for &Coefficient {
    type Output = Coefficient;
    fn neg(self) -> Coefficient {
        match self {
            Coefficient::Exact(value) => Coefficient::Exact(-value),
            Coefficient::Radical(radical) => Coefficient::Radical(-radical),
            Coefficient::Quotient { numerator, denominator } => {
                Coefficient::Quotient { numerator: -numerator, denominator: denominator.clone() }
            }
            Coefficient::Enclosed(enclosure) => Coefficient::Enclosed(-enclosure),
        }
    }
}

/// As in `7/2`, `1/2·√3 + 1`, `(1 + √2)/(1 + √3)` or `[0.33 ± 1e-3]`.
impl fmt::Display for Coefficient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact(value) => write!(f, "{value}"),
            Self::Radical(radical) => write!(f, "{radical}"),
            Self::Quotient { numerator, denominator } => write!(f, "({numerator})/({denominator})"),
            Self::Enclosed(enclosure) => write!(f, "{enclosure}"),
        }
    }
}

impl Serialize for Coefficient {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut entry = serializer.serialize_struct("Coefficient", 2)?;
        entry.serialize_field("kind", self.kind())?;
        entry.serialize_field("text", &self.to_string())?;
        entry.end()
    }
}
