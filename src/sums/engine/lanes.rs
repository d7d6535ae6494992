//! Eight f64, and what is done with them: one meaning, three implementations.
//!
//! Every operation is correctly rounded by itself and acts on each lane alone, so that every implementation gives the same
//! bits. Nothing here adds across lanes.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.

use crate::kernel::LANES;

/// The neighbours of eight particles: lane l has its list at `l * stride`.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) of: Vec<u32>,
    pub(super) stride: usize,
}

/// Eight f64.
pub(super) trait Lanes: Copy {
    /// Eight places in an array.
    type Index: Copy;

    fn splat(value: f64) -> Self;
    fn load(values: &[f64; LANES]) -> Self;
    fn store(self, values: &mut [f64; LANES]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// The larger; no argument may be NaN, and zeros of either sign are alike.
    fn max(self, other: Self) -> Self;
    /// The smaller, likewise.
    fn min(self, other: Self) -> Self;
    /// `yes` where self < other, else `no`.
    fn where_below(self, other: Self, yes: Self, no: Self) -> Self;
    /// Rounded towards zero; the values are between 0 and 2³¹ − 1.
    fn whole(self) -> [u32; LANES];

    /// Entry `k` of each list.
    fn entries(lists: &Lists, k: usize) -> Self::Index;
    /// The values at these places of each array.
    fn gather<const C: usize>(arrays: [&[f64]; C], index: Self::Index) -> [Self; C];

    /// Appends to `list` at `len`, in order, each j from `first` to `end` whose distance to `centre` squared is below
    /// `square`, and returns the new length. There has to be room for end − first + 8 entries, and the arrays must have
    /// eight elements beyond `end`.
    fn select<const D: usize>(
        axes: [&[f64]; D],
        centre: [f64; D],
        square: f64,
        range: (usize, usize),
        list: &mut [u32],
        len: usize,
    ) -> usize;
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
    type Index = [u32; LANES];

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
    fn max(self, other: Self) -> Self {
        each(|l| if self.0[l] > other.0[l] { self.0[l] } else { other.0[l] })
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each(|l| if self.0[l] < other.0[l] { self.0[l] } else { other.0[l] })
    }

    #[inline(always)]
    fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
        each(|l| if self.0[l] < other.0[l] { yes.0[l] } else { no.0[l] })
    }

    #[inline(always)]
    fn whole(self) -> [u32; LANES] {
        self.0.map(|value| value as u32)
    }

    #[inline(always)]
    fn entries(lists: &Lists, k: usize) -> Self::Index {
        std::array::from_fn(|lane| lists.of[lane * lists.stride + k])
    }

    #[inline(always)]
    fn gather<const C: usize>(arrays: [&[f64]; C], index: Self::Index) -> [Self; C] {
        let mut values = [Self::splat(0.0); C];
        for (value, array) in values.iter_mut().zip(&arrays) {
            *value = each(|l| array[index[l] as usize]);
        }
        values
    }

    #[inline(always)]
    fn select<const D: usize>(
        axes: [&[f64]; D],
        centre: [f64; D],
        square: f64,
        (first, end): (usize, usize),
        list: &mut [u32],
        mut len: usize,
    ) -> usize {
        let axes = axes.map(|axis| &axis[first..end]);
        for at in 0..end - first {
            let mut distance = 0.0;
            for a in 0..D {
                let r = centre[a] - axes[a][at];
                distance += r * r;
            }
            list[len] = (first + at) as u32;
            len += usize::from(distance < square);
        }
        len
    }
}
