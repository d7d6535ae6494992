//! What the layers above report: orders, exponents and intervals.

use std::fmt;
use std::ops::{Add, Sub};
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ExactError, Rational, parse_rational, serde_rational};

/// An order of accuracy, with "we stopped looking" kept apart from "we found it".
///
/// In JSON `{"exactly": 2}` or `{"at_least": 5}`.
///
/// There is no `Ord`: of `Exactly(3)` and `AtLeast(2)` neither is known to be the smaller. [`min`](Self::min) is what can be
/// said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// The term of this order is proved not to vanish, and all below it vanish.
    Exactly(u32),
    /// Every term below this order vanishes; nothing is known about the rest.
    AtLeast(u32),
}

impl Order {
    /// What is known about the smaller of two orders.
    ///
    /// The numbers' minimum, and exact only if the smaller operand is: `AtLeast(5)` and `Exactly(2)` give `Exactly(2)`,
    /// but `AtLeast(2)` and `Exactly(5)` give `AtLeast(2)`. This is not the order of a sum, whose leading terms may cancel.
    ///
    /// # Examples
    /// ```
    /// use remainder::exact::Order::{AtLeast, Exactly};
    /// assert_eq!(AtLeast(5).min(Exactly(2)), Exactly(2));
    /// assert_eq!(AtLeast(2).min(Exactly(5)), AtLeast(2));
    /// assert_eq!(AtLeast(2).min(Exactly(2)), Exactly(2));
    /// ```
    pub fn min(self, other: Self) -> Self {
        match (self, other) {
            (Self::Exactly(p), bound) | (bound, Self::Exactly(p)) if p <= bound.at_least() => {
                Self::Exactly(p)
            }
            _ => Self::AtLeast(self.at_least().min(other.at_least())),
        }
    }

    /// The number below which the order is proved not to lie.
    pub fn at_least(self) -> u32 {
        match self {
            Self::Exactly(p) | Self::AtLeast(p) => p,
        }
    }

    /// Whether the order is known and not only bounded.
    pub fn is_exact(self) -> bool {
        matches!(self, Self::Exactly(_))
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exactly(p) => write!(f, "exactly {p}"),
            Self::AtLeast(p) => write!(f, "at least {p}"),
        }
    }
}

/// A derived exponent: a rational such as 5/2, never a float. In JSON the string `"p/q"`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub struct Exponent(
    #[serde(with = "serde_rational")]
    #[schemars(with = "String")]
    pub Rational,
);

impl From<Rational> for Exponent {
    fn from(value: Rational) -> Self {
        Self(value)
    }
}

impl From<i64> for Exponent {
    fn from(value: i64) -> Self {
        Self(super::int(value))
    }
}

impl FromStr for Exponent {
    type Err = ExactError;

    /// Reads what [`parse_rational`] reads.
    fn from_str(text: &str) -> Result<Self, ExactError> {
        parse_rational(text).map(Self)
    }
}

impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&super::rational_text(&self.0))
    }
}

impl Add for &Exponent {
    type Output = Exponent;
    fn add(self, other: Self) -> Exponent {
        Exponent(&self.0 + &other.0)
    }
}

impl Sub for &Exponent {
    type Output = Exponent;
    fn sub(self, other: Self) -> Exponent {
        Exponent(&self.0 - &other.0)
    }
}

/// A measured number between two bounds: finite, `low ≤ value ≤ high`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Bounds")]
#[schemars(!try_from)]
pub struct Interval {
    value: f64,
    low: f64,
    high: f64,
}

/// What an [`Interval`] is read from, before its bounds are checked.
#[derive(Deserialize)]
struct Bounds {
    value: f64,
    low: f64,
    high: f64,
}

impl TryFrom<Bounds> for Interval {
    type Error = ExactError;
    fn try_from(Bounds { value, low, high }: Bounds) -> Result<Self, ExactError> {
        Self::new(value, low, high)
    }
}

impl Interval {
    /// `value` with its lower and upper bound.
    ///
    /// # Errors
    /// [`ExactError::NotAnInterval`] unless all three are finite and `low ≤ value ≤ high`.
    pub fn new(value: f64, low: f64, high: f64) -> Result<Self, ExactError> {
        let ordered = low <= value && value <= high;
        if ordered && low.is_finite() && high.is_finite() {
            Ok(Self { value, low, high })
        } else {
            Err(ExactError::NotAnInterval { value, low, high })
        }
    }

    /// The best single number.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The lower bound.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// The upper bound.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Whether `x` lies between the bounds, ends included.
    pub fn contains(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// `high − low`.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}, {}]", self.value, self.low, self.high)
    }
}
