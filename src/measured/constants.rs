//! Whether an operator vanishes on constant fields wherever particles stand and whatever the kernel: an identity in volumes,
//! separations and kernel values, tested at random points of a prime field (J. T. Schwartz, J. ACM 27, 1980; R. Zippel, 1979).
//!
//! A false identity passes one point with a probability below degree / 2⁶¹.

use super::stencil::value;
use crate::exact::{Number, Rational};
use crate::language::Operator;
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::OfParticle;
use num_bigint::BigInt;
use num_integer::Integer as _;
use num_traits::ToPrimitive as _;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// 2⁶¹ − 1, a prime that leaves 3 when divided by 4.
const PRIME: u64 = (1 << 61) - 1;

/// Neighbours of the particle: more than the unknowns of any tensor that is solved for, so that none is singular.
const NEIGHBOURS: usize = 9;

/// Points at which an identity is tested.
const POINTS: u64 = 2;

/// An integer modulo [`PRIME`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Modular(u64);

impl Modular {
    fn raised(self, mut exponent: u64) -> Self {
        let (mut power, mut square) = (Self(1), self);
        while exponent > 0 {
            if exponent & 1 == 1 {
                power = power * square;
            }
            square = square * square;
            exponent >>= 1;
        }
        power
    }
}

impl Neg for Modular {
    type Output = Self;
    fn neg(self) -> Self {
        Self((PRIME - self.0) % PRIME)
    }
}

impl Add for Modular {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self((self.0 + other.0) % PRIME)
    }
}

impl Sub for Modular {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Modular {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self((u128::from(self.0) * u128::from(other.0) % u128::from(PRIME)) as u64)
    }
}

impl Div for Modular {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self * other.raised(PRIME - 2)
    }
}

impl Number for Modular {
    fn from_rational(value: &Rational) -> Self {
        let residue = |n: &BigInt| Self(n.mod_floor(&BigInt::from(PRIME)).to_u64().unwrap_or(0));
        residue(value.numer()) / residue(value.denom())
    }
    fn nought() -> Self {
        Self(0)
    }
    fn is_nought(&self) -> bool {
        self.0 == 0
    }
    fn size(&self) -> f64 {
        f64::from(u8::from(self.0 != 0))
    }
    /// One of the two, the same for equal squares.
    fn root(&self) -> Option<Self> {
        let root = self.raised(PRIME.div_ceil(4));
        (root * root == *self).then_some(root)
    }
    fn pi() -> Option<Self> {
        // Nothing is known of it but that it is transcendental: any number will do.
        Some(Self(314_159_265_358_979_323))
    }
    const SINGULAR: f64 = 0.0;
}

/// A particle and its neighbours with random numbers for everything.
struct Random {
    dimension: usize,
    point: u64,
}

impl Random {
    /// A number for a name.
    fn number(&self, name: [u64; 3]) -> Modular {
        let mut z = name
            .iter()
            .fold(self.point, |z, part| (z ^ part).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Modular((z ^ (z >> 31)) % PRIME)
    }

    /// r_0p, of a length that is a number of the field: s times a point of the unit sphere.
    fn separation(&self, p: usize) -> [Modular; 3] {
        let number = |k| self.number([1, p as u64, k]);
        let (s, a, b) = (number(0), number(1), number(2));
        let (one, two) = (Modular(1), Modular(2));
        match (p, self.dimension) {
            (0, _) => [Modular(0); 3],
            (_, 1) => [s, Modular(0), Modular(0)],
            (_, 2) => {
                let over = s / (one + a * a);
                [(one - a * a) * over, two * a * over, Modular(0)]
            }
            _ => {
                let over = s / (one + a * a + b * b);
                [two * a * over, two * b * over, (one - a * a - b * b) * over]
            }
        }
    }
}

impl Ground<Modular> for Random {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [Modular; 3])> {
        let here = self.separation(p);
        let apart = |q: usize| {
            let there = self.separation(q);
            std::array::from_fn(|a| there[a] - here[a])
        };
        (0..=NEIGHBOURS).map(|q| (q, apart(q))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<Modular, MissingQuantity> {
        Ok(self.number([2, p as u64, quantity as u64]))
    }

    fn smoothing_length(&self) -> Modular {
        self.number([3, 0, 0])
    }

    fn kernel(&self, p: usize, q: usize, _r: &[Modular; 3]) -> [Modular; 3] {
        let (first, second) = (p.min(q) as u64, p.max(q) as u64);
        std::array::from_fn(|k| self.number([4 + k as u64, first, second]))
    }
}

/// Whether ⟨L1⟩ = 0 identically. An operator of which this cannot be tested, as one with distances between two neighbours, is
/// not said to.
pub(super) fn vanishes_on_constants(operator: &Operator, dimension: usize) -> bool {
    (0..POINTS).all(|point| {
        // For vectors: any constant one.
        let ground = Random { dimension, point: 0x7265_6d61 + point };
        let constant: Vec<Modular> = (0..3).map(|a| ground.number([9, a, 0])).collect();
        value(operator, &ground, 0, &|_| constant.clone())
            .is_ok_and(|found| found.components.iter().all(Number::is_nought))
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

    use super::*;
    use crate::language::operators;

    #[test]
    fn arithmetic_is_that_of_a_field() {
        let x = Modular(123_456_789_012_345);
        assert_eq!(x / x, Modular(1));
        assert_eq!((x * x).root().map(|root| root == x || root == -x), Some(true));
        assert_eq!(x - x, Modular(0));
        let half = Rational::new(BigInt::from(-1), BigInt::from(2));
        assert_eq!(Modular::from_rational(&half) * Modular(2), -Modular(1));
    }

    #[test]
    fn knows_who_vanishes_on_constants() {
        let vanish = |id: &str| vanishes_on_constants(&operators::by_id(id).unwrap().operator().unwrap(), 2);
        for id in
            ["F2", "F4", "S3", "G-", "MCG", "MEA", "shepard-gradient", "shepard-hessian", "mixed-correction"]
        {
            assert!(vanish(id), "{id}");
        }
        for id in ["F1", "F3", "G0", "G+", "shepard", "A", "basa-9"] {
            assert!(!vanish(id), "{id}");
        }
    }
}
