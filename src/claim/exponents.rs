//! Exponents as rationals in β.

use super::ClaimError;
use crate::exact::{Rational, int, parse_rational, rational_text};
use crate::language::Subject;
use num_traits::{One, Signed, Zero};
use std::fmt;

/// slope · β + constant. Where papers give another exponent for even β, `even_beta_adds` holds the difference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BetaExponent {
    slope: Rational,
    constant: Rational,
    even_beta_adds: Rational,
}

impl BetaExponent {
    /// Reads `2`, `-1/2`, `beta+1`, `2*beta-1/2`.
    ///
    /// # Errors
    /// [`ClaimError::Exponent`].
    ///
    /// # Examples
    /// ```
    /// use remainder::{claim::BetaExponent, exact::int};
    /// assert_eq!(BetaExponent::parse("beta-1").unwrap().at(3), int(2));
    /// ```
    pub fn parse(text: &str) -> Result<Self, ClaimError> {
        let fault = || ClaimError::Exponent { text: text.to_owned() };
        let plain: String = text.replace('β', "beta").chars().filter(|c| !c.is_whitespace()).collect();
        let number = |text: &str| parse_rational(text).map_err(|_| fault());
        let Some((before, after)) = plain.split_once("beta") else {
            return Ok(Self {
                slope: Rational::zero(),
                constant: number(&plain)?,
                even_beta_adds: Rational::zero(),
            });
        };
        let slope = match before {
            "" | "+" => Rational::one(),
            "-" => -Rational::one(),
            factor => number(factor.strip_suffix('*').unwrap_or(factor))?,
        };
        let constant = if after.is_empty() {
            Rational::zero()
        } else {
            number(after.strip_prefix('+').unwrap_or(after))?
        };
        Ok(Self { slope, constant, even_beta_adds: Rational::zero() })
    }

    /// The same with this added when β is even (Fatehi & Manzari 2011, the remark after Eq. 32).
    pub fn with_even(mut self, adds: Rational) -> Self {
        self.even_beta_adds = adds;
        self
    }

    /// The exponent for a kernel of this β.
    pub fn at(&self, beta: i64) -> Rational {
        let even = if beta.rem_euclid(2) == 0 { self.even_beta_adds.clone() } else { Rational::zero() };
        &self.slope * int(beta) + &self.constant + even
    }
}

impl fmt::Display for BetaExponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.slope.is_zero() {
            return f.write_str(&rational_text(&self.constant));
        }
        match self.slope.is_one() {
            true => f.write_str("β")?,
            false => write!(f, "{}β", rational_text(&self.slope))?,
        }
        if self.constant.is_positive() {
            write!(f, "+{}", rational_text(&self.constant))?;
        } else if self.constant.is_negative() {
            write!(f, "−{}", rational_text(&-self.constant.clone()))?;
        }
        Ok(())
    }
}

/// The exponents of d̃, h and Δ/h. A printed Δ counts as h · Δ/h.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Powers {
    /// Of d̃.
    pub displacement: BetaExponent,
    /// Of h.
    pub h: BetaExponent,
    /// Of Δ/h.
    pub dx_over_h: BetaExponent,
}

impl Powers {
    /// Reads the three exponents.
    ///
    /// # Errors
    /// [`ClaimError::Exponent`].
    pub fn parse(displacement: &str, h: &str, dx_over_h: &str) -> Result<Self, ClaimError> {
        Ok(Self {
            displacement: BetaExponent::parse(displacement)?,
            h: BetaExponent::parse(h)?,
            dx_over_h: BetaExponent::parse(dx_over_h)?,
        })
    }

    /// Whether d̃^a h^b has the dimension of what it is stated of.
    ///
    /// # Errors
    /// [`ClaimError::Dimension`].
    pub fn check(&self, subject: &Subject) -> Result<(), ClaimError> {
        let found = self.displacement.at(3) + self.h.at(3);
        if found == int(i64::from(subject.length_power())) {
            return Ok(());
        }
        Err(ClaimError::Dimension {
            subject: subject.name(),
            found: rational_text(&found),
            needed: subject.length_power(),
        })
    }
}

impl fmt::Display for Powers {
    /// As papers print it: `O(d̃ h^-2 (Δ/h)^{β−1})`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factor = |name: &str, exponent: &BetaExponent| match exponent.to_string().as_str() {
            "0" => None,
            "1" => Some(name.to_owned()),
            other if other.len() == 1 => Some(format!("{name}^{other}")),
            other => Some(format!("{name}^{{{other}}}")),
        };
        let factors = [("d̃", &self.displacement), ("h", &self.h), ("(Δ/h)", &self.dx_over_h)];
        let factors: Vec<String> =
            factors.iter().filter_map(|(name, exponent)| factor(name, exponent)).collect();
        write!(f, "O({})", if factors.is_empty() { "1".into() } else { factors.join(" ") })
    }
}
