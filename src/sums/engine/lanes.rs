//! Eight f64, and what is done with them: one meaning, three implementations.
//!
//! Every operation is correctly rounded by itself and acts on each lane alone, but for [`Lanes::totals`], which adds lanes
//! in one order: every implementation gives the same bits.

use crate::kernel::LANES;

/// Eight f64.
pub(super) trait Lanes: Copy {
    fn splat(value: f64) -> Self;
    fn load(values: &[f64; LANES]) -> Self;
    fn store(self, values: &mut [f64; LANES]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// The smaller; no argument may be NaN, and zeros of either sign are alike.
    fn min(self, other: Self) -> Self;
    /// The larger, likewise.
    fn max(self, other: Self) -> Self;
    /// `yes` where self < other, else `no`.
    fn where_below(self, other: Self, yes: Self, no: Self) -> Self;
    /// Bit l: self < other in lane l.
    fn below(self, other: Self) -> u8;
    /// The lanes of the set `inside` in their order, first to last; what stands behind them is anything.
    fn pack(self, inside: u8, to: &mut [f64; LANES]);
    /// Lane l: the lanes of `of[l]` added, ((0+4)+(2+6)) + ((1+5)+(3+7)).
    fn totals(of: [Self; LANES]) -> Self;
}

/// `f64::max` without its care for NaN, which costs.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `f64::min`, likewise.
#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The portable path: eight numbers in an array.
#[derive(Debug, Clone, Copy)]
pub(super) struct Portable([f64; LANES]);

#[inline(always)]
fn each(mut f: impl FnMut(usize) -> f64) -> Portable {
    let mut values = [0.0; LANES];
    for (lane, value) in values.iter_mut().enumerate() {
        *value = f(lane);
    }
    Portable(values)
}

impl Lanes for Portable {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(values: &[f64; LANES]) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn store(self, values: &mut [f64; LANES]) {
        *values = self.0;
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        each(|l| self.0[l] + other.0[l])
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        each(|l| self.0[l] - other.0[l])
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        each(|l| self.0[l] * other.0[l])
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        each(|l| self.0[l] / other.0[l])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each(|l| self.0[l].sqrt())
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each(|l| if self.0[l] < other.0[l] { self.0[l] } else { other.0[l] })
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each(|l| if self.0[l] > other.0[l] { self.0[l] } else { other.0[l] })
    }

    #[inline(always)]
    fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
        each(|l| if self.0[l] < other.0[l] { yes.0[l] } else { no.0[l] })
    }

    #[inline(always)]
    fn below(self, other: Self) -> u8 {
        (0..LANES).fold(0, |set, l| set | u8::from(self.0[l] < other.0[l]) << l)
    }

    #[inline(always)]
    fn pack(self, inside: u8, to: &mut [f64; LANES]) {
        let mut next = 0;
        for l in 0..LANES {
            to[next % LANES] = self.0[l];
            next += usize::from(inside >> l & 1);
        }
    }

    #[inline(always)]
    fn totals(of: [Self; LANES]) -> Self {
        each(|l| {
            let [a, b, c, d, e, f, g, h] = of[l].0;
            ((a + e) + (c + g)) + ((b + f) + (d + h))
        })
    }
}
