//! Multi-indices: the keys of an expansion.
//!
//! A numerical operator and the exact one are maps with these keys in graded order; the order of the method is that of
//! the first key at which the two maps differ.

use std::cmp::Ordering;
use std::fmt;
use std::ops::Add;

use num_bigint::BigUint;
use serde::{Deserialize, Serialize};

use super::ExactError;

/// `α = (α_x, α_y, α_z)`, the powers in `x^α = x^{α_x} y^{α_y} z^{α_z}` or the numbers of derivatives in `∂^α`.
///
/// Ordered by `|α|` first and by letters second: 1, x, y, z, xx, xy, xz, yy, … In JSON it is its string of letters.
///
/// # Examples
/// ```
/// use remainder::exact::MultiIndex;
/// let xxy = MultiIndex::from_letters("xyx").unwrap();
/// assert_eq!(xxy.letters(), "xxy");
/// assert_eq!(xxy.multiplicity(), 3u32.into());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct MultiIndex {
    /// Powers of x, y and z.
    pub powers: [u8; 3],
}

const LETTERS: [char; 3] = ['x', 'y', 'z'];

impl MultiIndex {
    /// The multi-index with these powers of x, y and z.
    pub const fn new(powers: [u8; 3]) -> Self {
        Self { powers }
    }

    /// Every multi-index of exactly this order in the first `dimension` letters, in their `Ord`: xx, xy, yy.
    ///
    /// There are `C(order + dimension − 1, dimension − 1)` of them.
    ///
    /// # Errors
    /// [`ExactError::Dimension`] unless `dimension` is 1, 2 or 3.
    pub fn all(dimension: usize, order: u8) -> Result<Vec<Self>, ExactError> {
        let all = match dimension {
            1 => vec![Self::new([order, 0, 0])],
            2 => (0..=order).rev().map(|x| Self::new([x, order - x, 0])).collect(),
            3 => (0..=order)
                .rev()
                .flat_map(|x| (0..=order - x).rev().map(move |y| Self::new([x, y, order - x - y])))
                .collect(),
            _ => return Err(ExactError::Dimension { dimension }),
        };
        Ok(all)
    }

    /// Reads letters in any order; the empty string is the index of order zero.
    ///
    /// # Errors
    /// [`ExactError::NotAMultiIndex`] for another letter, or more than 255 of one.
    pub fn from_letters(text: &str) -> Result<Self, ExactError> {
        let not_a_multi_index = || ExactError::NotAMultiIndex { text: text.to_owned() };
        let mut powers = [0u8; 3];
        for letter in text.chars() {
            let axis = LETTERS.iter().position(|&known| known == letter).ok_or_else(not_a_multi_index)?;
            powers[axis] = powers[axis].checked_add(1).ok_or_else(not_a_multi_index)?;
        }
        Ok(Self { powers })
    }

    /// The letters in sorted order, as in `xxy`; empty for order zero.
    pub fn letters(&self) -> String {
        LETTERS
            .iter()
            .zip(self.powers)
            .map(|(letter, power)| letter.to_string().repeat(power.into()))
            .collect()
    }

    /// `|α| = α_x + α_y + α_z`.
    pub fn order(&self) -> u32 {
        self.powers.iter().map(|&power| u32::from(power)).sum()
    }

    /// `α! = α_x! α_y! α_z!`.
    pub fn factorial(&self) -> BigUint {
        self.powers.iter().map(|&power| factorial(power.into())).product()
    }

    /// `|α|! / α!`, the number of distinct sequences of axes that share this multi-index.
    pub fn multiplicity(&self) -> BigUint {
        factorial(self.order()) / self.factorial()
    }

    /// `α + β`, or `None` if a power would exceed 255.
    pub fn checked_add(self, other: Self) -> Option<Self> {
        self.combine(other, u8::checked_add)
    }

    /// `α − β`, or `None` if a power would be negative.
    pub fn checked_sub(self, other: Self) -> Option<Self> {
        self.combine(other, u8::checked_sub)
    }

    fn combine(self, other: Self, operation: fn(u8, u8) -> Option<u8>) -> Option<Self> {
        let [a, b] = [self.powers, other.powers];
        Some(Self::new([operation(a[0], b[0])?, operation(a[1], b[1])?, operation(a[2], b[2])?]))
    }
}

fn factorial(n: u32) -> BigUint {
    (1..=n).map(BigUint::from).product()
}

impl Ord for MultiIndex {
    fn cmp(&self, other: &Self) -> Ordering {
        // At equal order the larger power of x comes first, as its letters do.
        self.order().cmp(&other.order()).then_with(|| other.powers.cmp(&self.powers))
    }
}

impl PartialOrd for MultiIndex {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Add for MultiIndex {
    type Output = Self;

    /// `α + β`.
    ///
    /// # Panics
    /// If a power exceeds 255, in release builds too; see [`checked_add`](MultiIndex::checked_add).
    fn add(self, other: Self) -> Self {
        let sum = |axis: usize| {
            let power = u16::from(self.powers[axis]) + u16::from(other.powers[axis]);
            assert!(power <= u16::from(u8::MAX), "the power {power} of a multi-index exceeds 255");
            power as u8
        };
        Self::new([sum(0), sum(1), sum(2)])
    }
}

/// The letters, or `1` for order zero.
impl fmt::Display for MultiIndex {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.order() == 0 { f.pad("1") } else { f.pad(&self.letters()) }
    }
}

impl From<MultiIndex> for String {
    fn from(index: MultiIndex) -> Self {
        index.letters()
    }
}

impl TryFrom<String> for MultiIndex {
    type Error = ExactError;
    fn try_from(text: String) -> Result<Self, ExactError> {
        Self::from_letters(&text)
    }
}
