//! Real numbers known to lie in a ball: midpoint ± radius, every operation rounding outward.
//!
//! The contract is Arb's (F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE
//! Transactions on Computers 66, 2017): if the true operands lie in the operands' enclosures, the true result lies in the
//! result's enclosure. Nothing is promised about how narrow the result is, except where `bits` says so.
//!
//! **`bits`** is everywhere the number of binary digits after the point, an absolute accuracy and not a relative one. Rounding
//! to `bits` widens the radius by at most `2 · 2^-bits`: once for the midpoint, once because the radius itself rounds up.
//! Addition, subtraction and multiplication do not round at all, so their midpoints grow; [`Enclosure::round`] cuts them
//! back.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::float_bounds::{self, bit_length};
use super::{ExactError, Rational};

/// All real numbers in `(mid ± rad) · 2^exp`, ends included.
///
/// `==` compares the representation, not the numbers enclosed: of those one can only ask whether they
/// [overlap](Self::overlaps).
///
/// Operands of very different `exp` are aligned by shifting, which costs memory in proportion to the difference.
///
/// # Examples
/// ```
/// use remainder::exact::Enclosure;
/// let two = Enclosure::sqrt_of_integer(&2u32.into(), 100);
/// assert!((&two * &two).contains(&remainder::exact::int(2)));
/// assert_eq!(two.decimal(10).0, "1.4142135624");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Enclosure {
    mid: BigInt,
    rad: BigUint,
    exp: i64,
}

impl Enclosure {
    /// `(mid ± rad) · 2^exp`.
    pub fn from_parts(mid: BigInt, rad: BigUint, exp: i64) -> Self {
        Self { mid, rad, exp }
    }

    /// The integer `n`, with radius zero.
    pub fn from_i64(n: i64) -> Self {
        Self::from_parts(n.into(), BigUint::zero(), 0)
    }

    /// A rational number; the radius is zero if `2^bits · value` is an integer and `2^-bits` otherwise.
    pub fn exact(value: &Rational, bits: u32) -> Self {
        Self::integer(value.numer()).div_separated(&Self::integer(value.denom()), bits)
    }

    /// `√n`; the radius is zero for a square and `2^-bits` otherwise.
    pub fn sqrt_of_integer(n: &BigUint, bits: u32) -> Self {
        let scaled = n << (2 * u64::from(bits));
        let root = scaled.sqrt();
        let rad = BigUint::from(u8::from(&root * &root != scaled));
        Self::from_parts(root.into(), rad, -i64::from(bits))
    }

    /// `π = 16 atan(1/5) − 4 atan(1/239)` (J. Machin, 1706); the radius is at most `2^-bits`.
    pub fn pi(bits: u32) -> Self {
        let working = u64::from(bits) + 32;
        let (a, error_a) = inverse_arctangent(5, working);
        let (b, error_b) = inverse_arctangent(239, working);
        let pi = Self::from_parts(a * 16 - b * 4, error_a * 16u32 + error_b * 4u32, -(working as i64));
        // Fewer than 2^24 steps of arctangent leave an error below 2^30, which is 1 after rounding; rounding adds 1.
        pi.rounded_to(-i64::from(bits) - 1)
    }

    /// The midpoint, exact.
    pub fn midpoint(&self) -> Rational {
        dyadic(self.mid.clone(), self.exp)
    }

    /// The radius, exact.
    pub fn radius(&self) -> Rational {
        dyadic(self.rad.clone().into(), self.exp)
    }

    /// `self / divisor`, rounded to `bits`.
    ///
    /// # Errors
    /// [`ExactError::DivisionByZero`] if the divisor is exactly zero, [`ExactError::DivisorMayVanish`] if zero is one of
    /// several numbers it encloses.
    pub fn div(&self, divisor: &Self, bits: u32) -> Result<Self, ExactError> {
        match (divisor.contains_zero(), divisor.rad.is_zero()) {
            (true, true) => Err(ExactError::DivisionByZero { what: "an enclosure".to_owned() }),
            (true, false) => Err(ExactError::DivisorMayVanish { divisor: divisor.to_string() }),
            (false, _) => Ok(self.div_separated(divisor, bits)),
        }
    }

    /// `c · self`, rounded to `bits`.
    pub fn scale(&self, c: &Rational, bits: u32) -> Self {
        (self * &Self::integer(c.numer())).div_separated(&Self::integer(c.denom()), bits)
    }

    /// `self / divisor` for a divisor that does not contain zero.
    ///
    /// With `x = a ± r` and `y = b ± s`: `|x/y − a/b| ≤ (r|b| + s|a|) / (|b| (|b| − s))`.
    pub(super) fn div_separated(&self, divisor: &Self, bits: u32) -> Self {
        debug_assert!(!divisor.contains_zero());
        let shift = self.exp - divisor.exp + i64::from(bits);
        let (up, down) = if shift >= 0 { (shift.unsigned_abs(), 0) } else { (0, shift.unsigned_abs()) };
        let (a, b) = (self.mid.magnitude(), divisor.mid.magnitude());
        let (r, s) = (&self.rad, &divisor.rad);

        let (mid, remainder) = (&self.mid << up).div_mod_floor(&(&divisor.mid << down));
        let propagated: BigUint = (r * b + s * a) << up;
        let rad = propagated.div_ceil(&((b * (b - s)) << down)) + u8::from(!remainder.is_zero());
        Self::from_parts(mid, rad, -i64::from(bits))
    }

    /// `√self`, rounded to `bits`.
    ///
    /// # Errors
    /// [`ExactError::NegativeRadicand`] if every number enclosed is negative, [`ExactError::RadicandMayBeNegative`] if
    /// some are.
    pub fn sqrt(&self, bits: u32) -> Result<Self, ExactError> {
        let (low, high) = self.ends();
        if high.is_negative() {
            return Err(ExactError::NegativeRadicand { radicand: self.to_string() });
        }
        if low.is_negative() {
            return Err(ExactError::RadicandMayBeNegative { radicand: self.to_string() });
        }
        let shift = self.exp + 2 * i64::from(bits);
        let (low, high) = (shift_floor(&low, shift), -shift_floor(&-high, shift));
        let root = high.sqrt();
        let high_root = if &root * &root == high { root } else { root + 1 };
        Ok(Self::between(&low.sqrt(), &high_root, -i64::from(bits)))
    }

    /// `self^n`, rounded to `bits`; `x⁰ = 1`.
    ///
    /// # Errors
    /// For negative `n` those of [`div`](Self::div).
    pub fn pow_i32(&self, n: i32, bits: u32) -> Result<Self, ExactError> {
        let power = self.pow_u32(n.unsigned_abs());
        if n < 0 { Self::from_i64(1).div(&power, bits) } else { Ok(power.round(bits)) }
    }

    /// `self^n` without rounding.
    pub(super) fn pow_u32(&self, n: u32) -> Self {
        let mut power = Self::from_i64(1);
        let mut square = self.clone();
        let mut rest = n;
        while rest > 0 {
            if rest & 1 == 1 {
                power = &power * &square;
            }
            rest >>= 1;
            if rest > 0 {
                square = &square * &square;
            }
        }
        power
    }

    /// The same number with at most `bits` binary digits after the point.
    pub fn round(&self, bits: u32) -> Self {
        self.rounded_to(-i64::from(bits))
    }

    /// The same number with a radius of at most 64 binary digits and digits of the midpoint below it dropped; widens the
    /// radius by less than one part in `2^60`. An enclosure of radius zero is left alone.
    pub fn trimmed(&self) -> Self {
        let excess = self.rad.bits().saturating_sub(64);
        self.rounded_to(self.exp + excess as i64)
    }

    /// Multiples of `2^exp` at most as fine as before.
    fn rounded_to(&self, exp: i64) -> Self {
        if exp <= self.exp {
            return self.clone();
        }
        let shift = exp.abs_diff(self.exp);
        let mid = (&self.mid + (BigInt::one() << (shift - 1))) >> shift;
        let lost = &mid << shift != self.mid;
        let rad = shift_ceil(&self.rad, shift) + u8::from(lost);
        Self::from_parts(mid, rad, exp)
    }

    /// Whether `value` is one of the numbers enclosed.
    pub fn contains(&self, value: &Rational) -> bool {
        (value - self.midpoint()).abs() <= self.radius()
    }

    /// Whether some number lies in both enclosures. Two enclosures of one number always overlap.
    pub fn overlaps(&self, other: &Self) -> bool {
        (self - other).contains_zero()
    }

    /// Whether zero is one of the numbers enclosed.
    pub fn contains_zero(&self) -> bool {
        self.mid.magnitude() <= &self.rad
    }

    /// The sign that all numbers enclosed share, as comparison with zero; `None` if they differ.
    pub fn sign(&self) -> Option<Ordering> {
        if !self.contains_zero() {
            Some(self.mid.cmp(&BigInt::zero()))
        } else if self.rad.is_zero() {
            Some(Ordering::Equal)
        } else {
            None
        }
    }

    /// The `f64` nearest to the midpoint.
    pub fn midpoint_f64(&self) -> f64 {
        float_bounds::nearest(&self.mid, self.exp)
    }

    /// A lower and an upper bound of all numbers enclosed, each the tightest there is in `f64`.
    pub fn bounds_f64(&self) -> (f64, f64) {
        let (low, high) = self.ends();
        (float_bounds::at_most(&low, self.exp), float_bounds::at_least(&high, self.exp))
    }

    /// An upper bound of the absolute value of all numbers enclosed.
    pub fn abs_upper_f64(&self) -> f64 {
        let (low, high) = self.bounds_f64();
        low.abs().max(high.abs())
    }

    /// An upper bound of the radius.
    pub fn radius_f64(&self) -> f64 {
        float_bounds::at_least(&self.rad.clone().into(), self.exp)
    }

    /// Whether the radius is less than 2^-`bits`.
    pub fn radius_is_below(&self, bits: u32) -> bool {
        self.rad.is_zero() || self.exp + (self.rad.bits() as i64) <= -i64::from(bits)
    }

    /// A lower bound of `log₂(|midpoint| / radius)`, less than 2 too low; `None` if zero is one
    /// of several numbers enclosed, `i64::MAX` if the radius is zero.
    pub fn relative_accuracy_bits(&self) -> Option<i64> {
        if self.rad.is_zero() {
            Some(i64::MAX)
        } else if self.contains_zero() {
            None
        } else {
            Some((bit_length(&self.mid) - 1 - self.rad.bits() as i64).max(0))
        }
    }

    /// The midpoint rounded to `digits` decimals after the point, and a radius that covers this rounding too, rounded up to
    /// three significant digits as in `1.24e-30` (`0` if nothing was lost). [`parse_rational`](super::parse_rational) reads both.
    pub fn decimal(&self, digits: u32) -> (String, String) {
        let unit = Rational::from_integer(BigInt::from(10).pow(digits)).recip();
        let units = (self.midpoint() / &unit).round().to_integer();
        let lost = (self.midpoint() - &unit * &units).abs();
        (fixed_point(&units, digits as usize), scientific_upward(&(self.radius() + lost)))
    }

    fn integer(n: &BigInt) -> Self {
        Self::from_parts(n.clone(), BigUint::zero(), 0)
    }

    /// Lowest and highest number, in multiples of `2^exp`.
    fn ends(&self) -> (BigInt, BigInt) {
        let rad = BigInt::from(self.rad.clone());
        (&self.mid - &rad, &self.mid + rad)
    }

    /// All numbers from `low · 2^exp` to `high · 2^exp`.
    fn between(low: &BigInt, high: &BigInt, exp: i64) -> Self {
        Self::from_parts(low + high, (high - low).magnitude().clone(), exp - 1)
    }

    /// Midpoint and radius in multiples of `2^exp`, for an `exp` not above the own one.
    fn at_exp(&self, exp: i64) -> (BigInt, BigUint) {
        let shift = self.exp.abs_diff(exp);
        (&self.mid << shift, &self.rad << shift)
    }
}

/// `2^working · atan(1/x)` and a bound of its error, from the series `Σ (−1)^k / ((2k+1) x^(2k+1))`.
///
/// Every power is at most 2 below the true one (each step adds less than 1 and divides the error so far by `x² ≥ 25`), so a
/// term is less than 3 off; the series alternates, so that what follows the first power of 0 is below 2.
fn inverse_arctangent(x: u32, working: u64) -> (BigInt, BigUint) {
    let mut power = (BigInt::one() << working) / x;
    let mut sum = BigInt::zero();
    let mut k = 0u32;
    while !power.is_zero() {
        let term = &power / (2 * k + 1);
        sum += if k % 2 == 0 { term } else { -term };
        power /= x * x;
        k += 1;
    }
    (sum, BigUint::from(k) * 3u32 + 2u32)
}

/// `⌊n · 2^shift⌋`.
fn shift_floor(n: &BigInt, shift: i64) -> BigInt {
    // `>>` on a `BigInt` rounds towards −∞.
    if shift >= 0 { n << shift.unsigned_abs() } else { n >> shift.unsigned_abs() }
}

/// `⌈n / 2^shift⌉`.
fn shift_ceil(n: &BigUint, shift: u64) -> BigUint {
    let floor = n >> shift;
    let lost = &floor << shift != *n;
    floor + u8::from(lost)
}

/// `m · 2^e`.
fn dyadic(m: BigInt, e: i64) -> Rational {
    let power = BigInt::one() << e.unsigned_abs();
    if e >= 0 { Rational::from_integer(m * power) } else { Rational::new(m, power) }
}

/// `units · 10^-digits` written out.
fn fixed_point(units: &BigInt, digits: usize) -> String {
    let sign = if units.is_negative() { "-" } else { "" };
    let all = format!("{:0>width$}", units.magnitude().to_string(), width = digits + 1);
    let (integer, fraction) = all.split_at(all.len() - digits);
    let point = if digits == 0 { "" } else { "." };
    format!("{sign}{integer}{point}{fraction}")
}

/// A non-negative number rounded up to three significant digits.
fn scientific_upward(value: &Rational) -> String {
    if value.is_zero() {
        return "0".to_owned();
    }
    let ten = Rational::from_integer(BigInt::from(10));
    let mut exponent = decimal_exponent(value);
    let mut digits = (value / ten.pow(exponent - 2)).ceil().to_integer();
    if digits > BigInt::from(999) {
        // 9.991 has become 10.00: the first digit moves up one power.
        digits = BigInt::from(100);
        exponent += 1;
    }
    let digits = digits.to_string();
    let (lead, rest) = digits.split_at(1);
    let rest = rest.trim_end_matches('0');
    let point = if rest.is_empty() { "" } else { "." };
    format!("{lead}{point}{rest}e{exponent}")
}

/// The `e` with `10^e ≤ value < 10^(e+1)`, for a positive value.
fn decimal_exponent(value: &Rational) -> i32 {
    let ten = Rational::from_integer(BigInt::from(10));
    let log2 = bit_length(value.numer()) - bit_length(value.denom());
    let mut exponent = (log2 as f64 * std::f64::consts::LOG10_2).floor() as i32;
    while ten.pow(exponent) > *value {
        exponent -= 1;
    }
    while ten.pow(exponent + 1) <= *value {
        exponent += 1;
    }
    exponent
}

impl Add for &Enclosure {
    type Output = Enclosure;
    fn add(self, other: Self) -> Enclosure {
        let exp = self.exp.min(other.exp);
        let ((a, r), (b, s)) = (self.at_exp(exp), other.at_exp(exp));
        Enclosure::from_parts(a + b, r + s, exp)
    }
}

impl Sub for &Enclosure {
    type Output = Enclosure;
    fn sub(self, other: Self) -> Enclosure {
        self + &-other
    }
}

impl Mul for &Enclosure {
    type Output = Enclosure;

    /// `(a ± r)(b ± s) ⊆ ab ± (|a|s + |b|r + rs)`.
    fn mul(self, other: Self) -> Enclosure {
        let (a, b) = (self.mid.magnitude(), other.mid.magnitude());
        let (r, s) = (&self.rad, &other.rad);
        Enclosure::from_parts(&self.mid * &other.mid, a * s + b * r + r * s, self.exp + other.exp)
    }
}

impl Neg for &Enclosure {
    type Output = Enclosure;
    fn neg(self) -> Enclosure {
        Enclosure::from_parts(-&self.mid, self.rad.clone(), self.exp)
    }
}

/// `[value ± radius]` with as many decimals as the radius supports, and at most 40 where the radius is zero.
impl fmt::Display for Enclosure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = if self.rad.is_zero() {
            self.exp.saturating_neg().clamp(0, 40)
        } else {
            i64::from(1 - decimal_exponent(&self.radius())).max(0)
        };
        let (value, radius) = self.decimal(digits as u32);
        write!(f, "[{value} ± {radius}]")
    }
}
