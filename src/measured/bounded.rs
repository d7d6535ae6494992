//! Numbers with a bound on what rounding made of them: running error analysis (N. J. Higham, Accuracy and Stability of
//! Numerical Algorithms, 2nd ed., 2002, §3.3), one operation at a time.
//!
//! Bounds are computed in `f64` themselves and are right to first order in the unit roundoff.

use crate::exact::{Number, Rational, rational_to_f64};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Unit roundoff, 2⁻⁵³.
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

/// Half of the least positive number: what a result below the normal ones may be off by.
const UNDERFLOW: f64 = f64::MIN_POSITIVE * f64::EPSILON;

/// A value, and a bound on its distance from what exact arithmetic on the same data gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    /// A datum.
    pub(super) fn exactly(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// A result of one rounding, with what its operands were off by.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self { value, error: inherited + UNIT * value.abs() }
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error)
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.value.abs(), other.value.abs());
        let inherited = a * other.error + b * self.error + self.error * other.error;
        let lost = if a == 0.0 || b == 0.0 { 0.0 } else { UNDERFLOW };
        Self::rounded(self.value * other.value, inherited + lost)
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.value.abs() - other.error;
        // A divisor that may be zero: nothing is known.
        let inherited =
            if least > 0.0 { (self.error + value.abs() * other.error) / least } else { f64::INFINITY };
        Self::rounded(value, inherited + if self.value == 0.0 { 0.0 } else { UNDERFLOW })
    }
}

impl Number for Bounded {
    fn from_rational(value: &Rational) -> Self {
        let nearest = rational_to_f64(value);
        let exact = Rational::from_float(nearest).is_some_and(|nearest| nearest == *value);
        Self { value: nearest, error: if exact { 0.0 } else { UNIT * nearest.abs() } }
    }

    fn nought() -> Self {
        Self::exactly(0.0)
    }

    fn is_nought(&self) -> bool {
        self.value == 0.0
    }

    fn size(&self) -> f64 {
        self.value.abs()
    }

    fn root(&self) -> Option<Self> {
        (self.value >= 0.0).then(|| {
            let root = self.value.sqrt();
            // |√(a + e) − √a| ≤ e / (√a + √(a − e)), and √e where a may be zero.
            let inherited = match self.value - self.error {
                least if least > 0.0 => self.error / (root + least.sqrt()),
                _ => self.error.sqrt(),
            };
            Self::rounded(root, inherited)
        })
    }

    fn pi() -> Option<Self> {
        Some(Self::rounded(std::f64::consts::PI, 0.0))
    }

    const SINGULAR: f64 = <f64 as Number>::SINGULAR;
}

#[cfg(test)]
mod tests {
    use super::super::double_double::Dd;
    use super::*;
    use proptest::prelude::*;

    /// ((a − b) · c / (d + 3) + √(c² + d²)) − c, which cancels in places.
    fn formula<T: Number>(of: impl Fn(f64) -> T, [a, b, c, d]: [f64; 4]) -> T {
        let (a, b, c, d) = (of(a), of(b), of(c), of(d));
        let root = (c.clone() * c.clone() + d.clone() * d.clone()).root().unwrap_or_else(T::nought);
        (a - b) * c.clone() / (d + of(3.0)) + root - c
    }

    proptest! {
        #[test]
        fn bounds_hold(x in prop::array::uniform4(-2.0_f64..2.0), close in -40_i32..0) {
            let [a, b, c, d] = x;
            let data = [a, a + b * f64::from(close).exp2(), c, d];
            let found = formula(Bounded::exactly, data);
            let exact = formula(Dd::from, data);
            let off = (Dd::from(found.value) - exact).to_f64().abs();
            prop_assert!(off <= found.error * (1.0 + 1e-10), "{off:e} > {:e}", found.error);
            // And they are not idle: of the order of the roundings.
            prop_assert!(found.error <= 64.0 * UNIT * 16.0);
        }
    }
}
