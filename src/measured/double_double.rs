//! Numbers held as an unevaluated sum of two `f64`, after Dekker (1971) and Knuth (TAOCP 2, §4.2.2); no fused operations.

use crate::exact::{Enclosure, Number, Rational, rational_to_f64};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `hi + lo` with `|lo|` at most half an ulp of `hi`: about 106 bits. Magnitudes must stay well below 2⁹⁹⁶, where
/// Veltkamp's split overflows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dd {
    hi: f64,
    lo: f64,
}

/// `a + b` and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let b_part = hi - a;
    Dd { hi, lo: (a - (hi - b_part)) + (b - b_part) }
}

/// As [`two_sum`] for `|a| ≥ |b|` (Dekker).
fn ordered_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd { hi, lo: b - (hi - a) }
}

/// Two parts of at most 26 bits (Veltkamp), so that products of parts are exact.
fn split(a: f64) -> (f64, f64) {
    const TWO_TO_27_PLUS_1: f64 = 134_217_729.0;
    let c = TWO_TO_27_PLUS_1 * a;
    let high = c - (c - a);
    (high, a - high)
}

/// `a · b` and its rounding error (Dekker).
fn two_product(a: f64, b: f64) -> Dd {
    let hi = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    Dd { hi, lo: ((a_high * b_high - hi) + a_high * b_low + a_low * b_high) + a_low * b_low }
}

impl Dd {
    pub(super) const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };
    pub(super) const ONE: Dd = Dd { hi: 1.0, lo: 0.0 };

    pub(super) fn to_f64(self) -> f64 {
        self.hi
    }

    /// `self · 2^exponent`.
    pub(super) fn scaled_by(self, exponent: i32) -> Dd {
        Dd { hi: libm::scalbn(self.hi, exponent), lo: libm::scalbn(self.lo, exponent) }
    }

    /// The root of a number that is not negative: one Newton step from the `f64` root doubles its digits.
    pub(super) fn sqrt(self) -> Dd {
        let root = self.hi.sqrt();
        if root == 0.0 {
            return Dd::ZERO;
        }
        let remainder = self - two_product(root, root);
        ordered_sum(root, remainder.hi / (2.0 * root))
    }
}

impl From<f64> for Dd {
    fn from(hi: f64) -> Self {
        Dd { hi, lo: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, other: Dd) -> Dd {
        let high = two_sum(self.hi, other.hi);
        let low = two_sum(self.lo, other.lo);
        let sum = ordered_sum(high.hi, high.lo + low.hi);
        ordered_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, other: Dd) -> Dd {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, other: Dd) -> Dd {
        let product = two_product(self.hi, other.hi);
        ordered_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for Dd {
    type Output = Dd;
    /// Long division with three `f64` digits of the quotient.
    fn div(self, other: Dd) -> Dd {
        let first = self.hi / other.hi;
        let remainder = self - other * Dd::from(first);
        let second = remainder.hi / other.hi;
        let third = (remainder - other * Dd::from(second)).hi / other.hi;
        ordered_sum(first, second) + Dd::from(third)
    }
}

impl Number for Dd {
    fn from_rational(value: &Rational) -> Self {
        let hi = rational_to_f64(value);
        let lo = Rational::from_float(hi).map_or(0.0, |hi| rational_to_f64(&(value - hi)));
        ordered_sum(hi, lo)
    }
    fn nought() -> Self {
        Dd::ZERO
    }
    fn is_nought(&self) -> bool {
        self.hi == 0.0
    }
    fn size(&self) -> f64 {
        self.hi.abs()
    }
    fn root(&self) -> Option<Self> {
        (self.hi >= 0.0).then(|| self.sqrt())
    }
    fn pi() -> Option<Self> {
        Some(Self::from_rational(&Enclosure::pi(120).midpoint()))
    }
    const SINGULAR: f64 = 1e-27;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2⁻¹⁰²: a few units in the last of 106 bits.
    const ROUNDING: f64 = 1.97e-31;

    #[test]
    fn keeps_what_a_double_drops() {
        let tiny = 1e-25;
        assert_eq!((Dd::ONE + Dd::from(tiny) - Dd::ONE).to_f64(), tiny);
        // (2²⁷ + 1)² = 2⁵⁴ + 2²⁸ + 1 does not fit in 53 bits.
        let square = Dd::from(134_217_729.0) * Dd::from(134_217_729.0);
        assert_eq!((square.hi, square.lo), (18_014_398_777_917_440.0, 1.0));
    }

    #[test]
    fn quotient_and_root_undo_product() {
        let (a, b) = (Dd::from(2.0).sqrt(), Dd::ONE / Dd::from(3.0));
        assert!((a * a - Dd::from(2.0)).to_f64().abs() <= 2.0 * ROUNDING);
        assert!((b * Dd::from(3.0) - Dd::ONE).to_f64().abs() <= ROUNDING);
        assert!((a * b / b - a).to_f64().abs() <= 2.0 * ROUNDING);
        assert!(a.lo != 0.0 && b.lo != 0.0);
    }
}
