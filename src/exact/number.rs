//! Numbers that sums over particles are taken in: f64, f32 to see what it loses, or rationals where nothing may be lost.

use super::{Rational, rational_to_f64};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// f64, f32, [`Rational`], or a kind of number of one's own.
pub trait Number:
    Clone
    + Debug
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest number to a rational.
    fn from_rational(value: &Rational) -> Self;
    /// Zero.
    fn nought() -> Self;
    /// Whether it is zero.
    fn is_nought(&self) -> bool;
    /// |x|, to compare magnitudes with.
    fn size(&self) -> f64;
    /// The square root, if this number has one of its own kind.
    fn root(&self) -> Option<Self>;
    /// π, if it is a number of this kind.
    fn pi() -> Option<Self>;
    /// A pivot smaller than this times the largest entry counts as zero.
    const SINGULAR: f64;

    /// x^n; `None` for a negative power of zero.
    fn power(&self, n: i32) -> Option<Self> {
        if n == 1 {
            return Some(self.clone());
        }
        let one = Self::from_rational(&Rational::from_integer(BigInt::from(1)));
        let magnitude = (0..n.unsigned_abs()).fold(one.clone(), |product, _| product * self.clone());
        match n {
            0.. => Some(magnitude),
            _ if magnitude.is_nought() => None,
            _ => Some(one / magnitude),
        }
    }
}

impl Number for f64 {
    fn from_rational(value: &Rational) -> Self {
        rational_to_f64(value)
    }
    fn nought() -> Self {
        0.0
    }
    fn is_nought(&self) -> bool {
        *self == 0.0
    }
    fn size(&self) -> f64 {
        self.abs()
    }
    fn root(&self) -> Option<Self> {
        (*self >= 0.0).then(|| self.sqrt())
    }
    fn pi() -> Option<Self> {
        Some(std::f64::consts::PI)
    }
    const SINGULAR: f64 = 1e-12;
}

impl Number for f32 {
    fn from_rational(value: &Rational) -> Self {
        rational_to_f64(value) as f32
    }
    fn nought() -> Self {
        0.0
    }
    fn is_nought(&self) -> bool {
        *self == 0.0
    }
    fn size(&self) -> f64 {
        f64::from(self.abs())
    }
    fn root(&self) -> Option<Self> {
        (*self >= 0.0).then(|| self.sqrt())
    }
    fn pi() -> Option<Self> {
        Some(std::f32::consts::PI)
    }
    const SINGULAR: f64 = 1e-6;
}

impl Number for Rational {
    fn from_rational(value: &Rational) -> Self {
        value.clone()
    }
    fn nought() -> Self {
        Self::zero()
    }
    fn is_nought(&self) -> bool {
        self.is_zero()
    }
    fn size(&self) -> f64 {
        // Only zero has no size: what is too small for a float still counts.
        if self.is_zero() { 0.0 } else { rational_to_f64(self).abs().max(f64::MIN_POSITIVE) }
    }
    fn root(&self) -> Option<Self> {
        if self.is_negative() {
            return None;
        }
        let (n, d) = (self.numer().sqrt(), self.denom().sqrt());
        (&n * &n == *self.numer() && &d * &d == *self.denom()).then(|| Self::new(n, d))
    }
    fn pi() -> Option<Self> {
        None
    }
    const SINGULAR: f64 = 0.0;
}
