//! Numbers that carry their first and second derivatives along several directions: truncated Taylor series.
//!
//! A jet of x(t) = x + Σ_l … is kept lane by lane, x, dx/dt_l and d²x/dt_l² at t = 0, one direction l a lane. Whatever is
//! computed with jets is differentiated exactly, to rounding, without a formula of its own.

use crate::exact::{Number, Rational, rational_to_f64};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Directions that are differentiated along at once.
pub(super) const LANES: usize = 16;

/// A value with its first and second derivatives along [`LANES`] directions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Jet {
    pub value: f64,
    pub first: [f64; LANES],
    pub second: [f64; LANES],
}

impl Jet {
    pub(super) fn constant(value: f64) -> Self {
        Self { value, first: [0.0; LANES], second: [0.0; LANES] }
    }

    /// f of this jet, for f with these value and derivatives at its value.
    pub(super) fn through(&self, [f, df, ddf]: [f64; 3]) -> Self {
        let mut jet = Self::constant(f);
        for lane in 0..LANES {
            jet.first[lane] = df * self.first[lane];
            jet.second[lane] = df * self.second[lane] + ddf * self.first[lane] * self.first[lane];
        }
        jet
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for lane in 0..LANES {
            self.first[lane] += other.first[lane];
            self.second[lane] += other.second[lane];
        }
        self
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(mut self, other: Self) -> Self {
        self.value -= other.value;
        for lane in 0..LANES {
            self.first[lane] -= other.first[lane];
            self.second[lane] -= other.second[lane];
        }
        self
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(mut self, other: Self) -> Self {
        for lane in 0..LANES {
            self.second[lane] = self.second[lane] * other.value
                + 2.0 * self.first[lane] * other.first[lane]
                + self.value * other.second[lane];
            self.first[lane] = self.first[lane] * other.value + self.value * other.first[lane];
        }
        self.value *= other.value;
        self
    }
}

impl Div for Jet {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        self * other.through([inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse])
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(mut self) -> Self {
        self.value = -self.value;
        self.first = self.first.map(|x| -x);
        self.second = self.second.map(|x| -x);
        self
    }
}

impl Number for Jet {
    fn from_rational(value: &Rational) -> Self {
        Self::constant(rational_to_f64(value))
    }
    fn nought() -> Self {
        Self::constant(0.0)
    }
    fn is_nought(&self) -> bool {
        let zero = |x: &f64| *x == 0.0;
        zero(&self.value) && self.first.iter().all(zero) && self.second.iter().all(zero)
    }
    fn size(&self) -> f64 {
        self.value.abs()
    }
    fn root(&self) -> Option<Self> {
        if self.is_nought() {
            return Some(self.clone());
        }
        let root = self.value.sqrt();
        (self.value > 0.0).then(|| self.through([root, 0.5 / root, -0.25 / (root * self.value)]))
    }
    fn pi() -> Option<Self> {
        Some(Self::constant(std::f64::consts::PI))
    }
    const SINGULAR: f64 = <f64 as Number>::SINGULAR;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = a + b t in the first lane, with d²x = 0.
    fn line(a: f64, b: f64) -> Jet {
        let mut jet = Jet::constant(a);
        jet.first[0] = b;
        jet
    }

    #[test]
    fn derivatives_are_those_of_calculus() {
        // f(t) = √(x y) / (x + y²) with x = 2 + 3t, y = 5 − t, against central differences.
        let f = |x: Jet, y: Jet| {
            let root = (x.clone() * y.clone()).root();
            root.map(|root| root / (x + y.clone() * y))
        };
        let at = |t: f64| {
            let (x, y): (f64, f64) = (2.0 + 3.0 * t, 5.0 - t);
            (x * y).sqrt() / (x + y * y)
        };
        let jet = f(line(2.0, 3.0), line(5.0, -1.0));
        let step = 1e-4;
        let first = (at(step) - at(-step)) / (2.0 * step);
        let second = (at(step) - 2.0 * at(0.0) + at(-step)) / (step * step);
        assert!(jet.is_some_and(|jet| (jet.value - at(0.0)).abs() < 1e-15
            && (jet.first[0] - first).abs() < 1e-8
            && (jet.second[0] - second).abs() < 1e-6
            && jet.first[1] == 0.0));
        assert_eq!(line(-1.0, 1.0).root(), None);
        assert!(!line(0.0, 1.0).is_nought() && Jet::nought().is_nought());
    }
}
