//! Square roots of many whole numbers at once, in fixed point.
//!
//! The levels of a lattice's shells share their prime factors, so √n is put together from the roots of its primes: only
//! these are taken, the rest are products.

use num_bigint::{BigInt, BigUint};
use std::collections::HashMap;

/// Bits beyond those asked for. A product of k roots is off by at most k √n units of the working precision, which for
/// n < 2⁴⁰ and its at most 12 distinct primes is far below 2³².
const GUARD: u32 = 32;

/// Roots at one precision, remembered.
pub(super) struct Roots {
    bits: u32,
    known: HashMap<u64, BigInt>,
}

impl Roots {
    /// Roots with `bits` fractional bits.
    pub(super) fn new(bits: u32) -> Self {
        Self { bits, known: HashMap::new() }
    }

    /// √n · 2^bits, off by less than two units.
    pub(super) fn of(&mut self, n: u64) -> BigInt {
        self.working(n) >> GUARD
    }

    fn working(&mut self, n: u64) -> BigInt {
        if let Some(root) = self.known.get(&n) {
            return root.clone();
        }
        let bits = self.bits + GUARD;
        let root = match smallest_factor(n) {
            Some(p) if (n / p) % p == 0 => self.working(n / p / p) * p,
            Some(p) => (self.working(p) * self.working(n / p)) >> bits,
            None => BigInt::from((BigUint::from(n) << (2 * bits)).sqrt()),
        };
        self.known.insert(n, root.clone());
        root
    }
}

/// The smallest prime factor of a composite number; `None` for primes, 1 and 0.
fn smallest_factor(n: u64) -> Option<u64> {
    if n < 4 {
        return None;
    }
    if n % 2 == 0 {
        return Some(2);
    }
    (3..).step_by(2).take_while(|p| p * p <= n).find(|p| n % p == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_root_is_within_two_units_of_the_one_taken_whole() {
        for bits in [20, 160] {
            let mut roots = Roots::new(bits);
            for n in (0..5000).chain([262_143, 262_144, 999_999_000_000, 720_720 * 720_720]) {
                let whole = BigInt::from((BigUint::from(n) << (2 * bits)).sqrt());
                let off = roots.of(n) - whole;
                assert!(off >= BigInt::from(-2) && off <= BigInt::from(2), "√{n} is off by {off}");
            }
        }
    }
}
