//! The exponential function, enclosed.

use super::{Enclosure, Rational, ratio};
use num_bigint::{BigInt, BigUint};
use num_traits::{One, Zero};

impl Enclosure {
    /// `e^(−x)` for `x ≥ 0`, with a radius of at most `2^-bits`.
    ///
    /// The argument is halved until it is at most 1/2; there the alternating series falls, so that what is cut off is
    /// smaller than the last term kept. Squaring back at most doubles the radius, since no value exceeds 1.
    ///
    /// # Examples
    /// ```
    /// use remainder::exact::{Enclosure, int};
    /// assert_eq!(Enclosure::exp_of_negative(&int(1), 100).decimal(20).0, "0.36787944117144232160");
    /// ```
    pub fn exp_of_negative(x: &Rational, bits: u32) -> Self {
        let halvings = x.ceil().to_integer().bits() as u32 + 1;
        let working = bits + 2 * halvings + 16;
        let halved = x / Rational::from_integer(BigInt::one() << halvings);
        let step = -&Self::exact(&halved, working);
        let (mut sum, mut term) = (Self::from_i64(1), Self::from_i64(1));
        // The n-th term is below 2^-n / n!, of which `small` counts the binary digits.
        let (mut n, mut small) = (0_i64, 0_u32);
        while small < working {
            n += 1;
            small += 1 + n.ilog2();
            term = (&term * &step).scale(&ratio(1, n), working);
            sum = &sum + &term;
        }
        let cut_off = Self::from_parts(BigInt::zero(), BigUint::one(), -i64::from(working));
        let value = &sum + &cut_off;
        (0..halvings).fold(value, |value, _| (&value * &value).round(working)).round(bits + 2)
    }
}
