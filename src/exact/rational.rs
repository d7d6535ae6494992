//! Rational numbers: reading, printing, and the nearest `f64`.
//!
//! A literature constant enters the crate through [`ratio`] or [`parse_rational`] and stays exact from there on.

use std::fmt;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::ExactError;

/// A rational number of unlimited size, always in lowest terms with a positive denominator.
pub type Rational = BigRational;

/// Largest decimal exponent that [`parse_rational`] reads; `f64` needs 324.
const LARGEST_DECIMAL_EXPONENT: u32 = 10_000;

/// The integer `n` as a [`Rational`].
pub fn int(n: i64) -> Rational {
    Rational::from_integer(BigInt::from(n))
}

/// The fraction `numerator / denominator` in lowest terms.
///
/// # Panics
/// If `denominator` is zero; for a denominator that is not a literal use [`parse_rational`] or check it first.
pub fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(BigInt::from(numerator), BigInt::from(denominator))
}

/// Reads `3`, `-7/2`, `2.5` or `1e-3`; a decimal is read exactly, so `0.1` is 1/10.
///
/// # Errors
/// [`ExactError::NotARational`] for any other text, [`ExactError::DivisionByZero`] for `p/0`,
/// [`ExactError::ExponentTooLarge`] for a decimal exponent beyond ±10000.
///
/// # Examples
/// ```
/// use remainder::exact::{parse_rational, ratio};
/// assert_eq!(parse_rational("2.5"), Ok(ratio(5, 2)));
/// assert_eq!(parse_rational("1e-3"), Ok(ratio(1, 1000)));
/// assert!(parse_rational("0.333…").is_err());
/// ```
pub fn parse_rational(text: &str) -> Result<Rational, ExactError> {
    let not_a_rational = || ExactError::NotARational { text: text.to_owned() };
    let trimmed = text.trim();
    let (negative, unsigned) = match trimmed.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, trimmed.strip_prefix('+').unwrap_or(trimmed)),
    };
    let magnitude = match unsigned.split_once('/') {
        Some((numerator, denominator)) => {
            let numerator = digits(numerator).ok_or_else(not_a_rational)?;
            let denominator = digits(denominator).ok_or_else(not_a_rational)?;
            if denominator.is_zero() {
                return Err(ExactError::DivisionByZero { what: format!("`{text}`") });
            }
            Rational::new(numerator, denominator)
        }
        None => decimal(unsigned, text)?,
    };
    Ok(if negative { -magnitude } else { magnitude })
}

/// A non-empty string of ASCII digits.
fn digits(text: &str) -> Option<BigInt> {
    let only_digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if only_digits { text.parse().ok() } else { None }
}

/// An unsigned decimal with optional point and exponent; `whole` is the text quoted in errors.
fn decimal(unsigned: &str, whole: &str) -> Result<Rational, ExactError> {
    let not_a_rational = || ExactError::NotARational { text: whole.to_owned() };
    let (mantissa, exponent) = unsigned.split_once(['e', 'E']).unwrap_or((unsigned, "0"));
    let (integer_part, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let mantissa = digits(&format!("{integer_part}{fraction}")).ok_or_else(not_a_rational)?;

    let (negative_exponent, exponent_digits) = match exponent.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, exponent.strip_prefix('+').unwrap_or(exponent)),
    };
    let exponent = digits(exponent_digits).ok_or_else(not_a_rational)?;
    let exponent = match exponent.to_u32() {
        Some(exponent) if exponent <= LARGEST_DECIMAL_EXPONENT => exponent as usize,
        _ => {
            let limit = LARGEST_DECIMAL_EXPONENT;
            return Err(ExactError::ExponentTooLarge { text: whole.to_owned(), limit });
        }
    };
    let power_of_ten = |power: usize| num_traits::pow(BigInt::from(10), power);
    let (up, down) = if negative_exponent { (0, exponent) } else { (exponent, 0) };
    Ok(Rational::new(mantissa * power_of_ten(up), power_of_ten(down + fraction.len())))
}

/// The shortest decimal that prints as `value`, read exactly: 3.15 becomes 63/20, not the binary neighbour.
///
/// This is what a person who typed `3.15` meant.
///
/// # Errors
/// [`ExactError::NotFinite`] for NaN and infinities.
pub fn rational_from_decimal(value: f64) -> Result<Rational, ExactError> {
    if !value.is_finite() {
        return Err(ExactError::NotFinite { value });
    }
    parse_rational(&format!("{value:e}"))
}

/// `p/q`, or `p` when the denominator is 1; [`parse_rational`] reads it back.
pub fn rational_text(value: &Rational) -> String {
    value.to_string()
}

/// The `f64` nearest to `value` (within 1 ulp whatever the size of numerator and denominator; ±∞ on overflow).
pub fn rational_to_f64(value: &Rational) -> f64 {
    // Small whole numbers, which are most, need no division of big ones.
    if let (true, Some(whole)) = (value.is_integer(), value.numer().to_i32()) {
        return f64::from(whole);
    }
    // `to_f64` answers `None` only for 0/0, which no `Rational` is.
    value.to_f64().unwrap_or(f64::NAN)
}

/// Writes `c1·s1 + c2·s2 - …`, leaving out zero terms and unit coefficients; an empty symbol is the constant term.
pub(super) fn write_sum<'a>(
    f: &mut fmt::Formatter<'_>,
    terms: impl Iterator<Item = (&'a Rational, String)>,
) -> fmt::Result {
    let mut first = true;
    for (coefficient, symbol) in terms.filter(|(coefficient, _)| !coefficient.is_zero()) {
        let sign = match (first, coefficient.is_negative()) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        first = false;
        let magnitude = coefficient.abs();
        match (symbol.is_empty(), magnitude.is_one()) {
            (true, _) => write!(f, "{sign}{magnitude}")?,
            (false, true) => write!(f, "{sign}{symbol}")?,
            (false, false) => write!(f, "{sign}{magnitude}·{symbol}")?,
        }
    }
    if first { write!(f, "0") } else { Ok(()) }
}

/// A [`Rational`] as a `"p/q"` string, for `#[serde(with = "serde_rational")]`.
pub mod serde_rational {
    use serde::{Deserialize, Deserializer, Serializer, de};

    use super::{Rational, parse_rational, rational_text};

    /// Writes `"p/q"`, or `"p"` when the denominator is 1.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(value: &Rational, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&rational_text(value))
    }

    /// Reads a string by [`parse_rational`].
    ///
    /// # Errors
    /// Those of the deserializer, and the message of [`parse_rational`].
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Rational, D::Error> {
        let text = String::deserialize(deserializer)?;
        parse_rational(&text).map_err(de::Error::custom)
    }
}
