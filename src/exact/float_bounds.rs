//! The way from dyadic numbers `m · 2^e` to `f64`: to the nearest, or to a proved bound.

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};
use num_traits::{Float, Signed, ToPrimitive, Zero};

use super::Rational;

/// The `f64` nearest to `m · 2^e`.
pub(super) fn nearest(m: &BigInt, e: i64) -> f64 {
    let sign = if m.is_negative() { -1.0 } else { 1.0 };
    // 2^(top - 1) <= |m 2^e| < 2^top; the finite non-zero floats lie between 2^-1074 and 2^1024.
    let top = bit_length(m).saturating_add(e);
    if m.is_zero() || top < -1100 {
        return 0.0 * sign;
    }
    if top > 1100 {
        return f64::INFINITY * sign;
    }
    let dyadic = if e >= 0 {
        Rational::from_integer(m << e.unsigned_abs())
    } else {
        Rational::new_raw(m.clone(), BigInt::from(1) << e.unsigned_abs())
    };
    // `to_f64` answers `None` only for 0/0; the denominator is a power of two.
    dyadic.to_f64().unwrap_or(f64::NAN)
}

/// The largest `f64` that is not above `m · 2^e`.
pub(super) fn at_most(m: &BigInt, e: i64) -> f64 {
    let x = nearest(m, e);
    if compare(m, e, x) == Ordering::Less { next_below(x) } else { x }
}

/// The smallest `f64` that is not below `m · 2^e`.
pub(super) fn at_least(m: &BigInt, e: i64) -> f64 {
    -at_most(&-m, e)
}

/// Number of binary digits of `|m|`.
pub(super) fn bit_length(m: &BigInt) -> i64 {
    // An integer with 2^63 digits does not fit in memory.
    m.bits() as i64
}

/// `m · 2^e` compared with `x`, its nearest float.
fn compare(m: &BigInt, e: i64, x: f64) -> Ordering {
    if x.is_infinite() {
        return if x > 0.0 { Ordering::Less } else { Ordering::Greater };
    }
    if x == 0.0 {
        return match m.sign() {
            Sign::Minus => Ordering::Less,
            Sign::NoSign => Ordering::Equal,
            Sign::Plus => Ordering::Greater,
        };
    }
    let (digits, exponent, sign) = Float::integer_decode(x);
    let (digits, exponent) = (BigInt::from(digits) * sign, i64::from(exponent));
    let common = e.min(exponent);
    let aligned = |n: &BigInt, from: i64| n << from.abs_diff(common);
    aligned(m, e).cmp(&aligned(&digits, exponent))
}

/// The next `f64` towards −∞ (`f64::next_down` needs a newer compiler than the crate promises).
fn next_below(x: f64) -> f64 {
    if x == 0.0 {
        -f64::from_bits(1)
    } else if x > 0.0 {
        f64::from_bits(x.to_bits() - 1)
    } else {
        f64::from_bits(x.to_bits() + 1)
    }
}
