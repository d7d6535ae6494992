//! Eight lanes on AVX2 and AVX-512, and rows of results that several threads write: all unsafe code of the crate.
//!
//! Why it is sound:
//! - **Instructions.** A [`Wide`] or a [`Pair`] is used only by `block_avx512` and `block_avx2`, which [`block`] calls after
//!   the machine was asked for the features that these functions enable. Both types are private to this file.
//! - **Loads.** Each gather compares its eight places with the length of every array first; `select` checks the range and
//!   the room in the list once for all it loads and stores.
//! - **Rows.** [`write_rows`] checks that `order` names each row of the result once and hands each stretch of it to one task.
//!
//! Only correctly rounded operations on single lanes are used: none is fused, none adds across lanes.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.
#![allow(unsafe_code)]

use super::arithmetic::{Scratch, Task, eight};
use super::lanes::{Lanes, Lists, Portable};
use crate::kernel::LANES;
use rayon::prelude::*;
use std::ops::Range;

/// Which instructions the sums are taken with. The results are the same to the bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Path {
    /// What every machine has.
    Portable,
    /// AVX2: two registers for eight lanes.
    Avx2,
    /// AVX-512 F and VL: one register.
    Avx512,
}

impl Path {
    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("popcnt"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// The widest that this machine has.
    pub fn best() -> Self {
        let wide = [Self::Avx512, Self::Avx2].into_iter().find(|path| path.is_available());
        wide.unwrap_or(Self::Portable)
    }
}

/// Evaluates the particles at `places`, eight at a time; `done` gets the first place and how many, and finds their sums in
/// the scratch.
pub(super) fn block<const D: usize>(
    path: Path,
    task: &Task<'_>,
    places: Range<usize>,
    scratch: &mut Scratch,
    done: &mut dyn FnMut(usize, usize, &mut Scratch),
) {
    match path {
        // SAFETY: the machine has the features that the function enables, as was just asked.
        #[cfg(target_arch = "x86_64")]
        Path::Avx512 if path.is_available() => unsafe { block_avx512::<D>(task, places, scratch, done) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Path::Avx2 if path.is_available() => unsafe { block_avx2::<D>(task, places, scratch, done) },
        _ => block_of::<Portable, D>(task, places, scratch, done),
    }
}

#[inline(always)]
fn block_of<L: Lanes, const D: usize>(
    task: &Task<'_>,
    places: Range<usize>,
    scratch: &mut Scratch,
    done: &mut dyn FnMut(usize, usize, &mut Scratch),
) {
    for first in places.clone().step_by(LANES) {
        let count = LANES.min(places.end - first);
        eight::<L, D>(task, first, count, scratch);
        done(first, count, scratch);
    }
}

/// Calls `write` with each stretch of at most `stretch` places of `order` and a way to the rows of `out` that belong to
/// these places: row `order[place]`, of `width` numbers.
pub(super) fn write_rows<S, I, W>(
    order: &[u32],
    out: &mut [f64],
    width: usize,
    stretch: usize,
    start: I,
    write: W,
) where
    S: Send,
    I: Fn() -> S + Sync + Send,
    W: Fn(&mut S, Range<usize>, &mut RowsAt<'_>) + Sync + Send,
{
    assert_eq!(out.len(), order.len() * width, "one row for each particle");
    let mut seen = vec![0_u64; order.len().div_ceil(64)];
    for row in order {
        let (word, bit) = (*row as usize / 64, 1 << (row % 64));
        assert!((*row as usize) < order.len() && seen[word] & bit == 0, "each row is named once");
        seen[word] |= bit;
    }
    drop(seen);
    let base = Shared(out.as_mut_ptr());
    (0..order.len().div_ceil(stretch)).into_par_iter().with_min_len(4).for_each_init(
        start,
        |state, index| {
            let places = index * stretch..order.len().min((index + 1) * stretch);
            let base = &base;
            let mut rows = RowsAt { order: &order[places.clone()], first: places.start, base: base.0, width };
            write(state, places, &mut rows);
        },
    );
}

struct Shared(*mut f64);

// SAFETY: through it, each task of `write_rows` reaches the rows of its own places alone.
unsafe impl Sync for Shared {}

/// The rows of the result that belong to a stretch of places.
pub(super) struct RowsAt<'a> {
    order: &'a [u32],
    first: usize,
    base: *mut f64,
    width: usize,
}

impl RowsAt<'_> {
    /// The particle at a place, and its row.
    #[inline(always)]
    pub(super) fn row(&mut self, place: usize) -> (usize, &mut [f64]) {
        let particle = self.order[place - self.first] as usize;
        // SAFETY: `write_rows` has seen that `order` is a permutation of the rows of `out`, so the row lies inside and belongs
        // to this place alone; the place belongs to this stretch alone, and the borrow of `self` keeps it to one caller.
        let row = unsafe { std::slice::from_raw_parts_mut(self.base.add(particle * self.width), self.width) };
        (particle, row)
    }
}

#[cfg(target_arch = "x86_64")]
pub(super) use x86::{block_avx2, block_avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx512f,avx512vl,popcnt")]
    pub(in super::super) fn block_avx512<const D: usize>(
        task: &Task<'_>,
        places: Range<usize>,
        scratch: &mut Scratch,
        done: &mut dyn FnMut(usize, usize, &mut Scratch),
    ) {
        block_of::<Wide, D>(task, places, scratch, done);
    }

    #[target_feature(enable = "avx2,popcnt")]
    pub(in super::super) fn block_avx2<const D: usize>(
        task: &Task<'_>,
        places: Range<usize>,
        scratch: &mut Scratch,
        done: &mut dyn FnMut(usize, usize, &mut Scratch),
    ) {
        block_of::<Pair, D>(task, places, scratch, done);
    }

    /// Eight lanes in one register.
    #[derive(Clone, Copy)]
    struct Wide(__m512d);

    /// Eight lanes in two registers.
    #[derive(Clone, Copy)]
    struct Pair(__m256d, __m256d);

    /// Checks what `select` relies on: eight elements behind the range in each array, and room for it in the list.
    #[inline(always)]
    fn check<const D: usize>(axes: &[&[f64]; D], (first, end): (usize, usize), list: &[u32], len: usize) {
        let room = first <= end && len + (end - first) + LANES <= list.len();
        assert!(room && axes.iter().all(|axis| end + LANES <= axis.len()), "room for a range");
    }

    #[inline(always)]
    fn shortest<const C: usize>(arrays: &[&[f64]; C]) -> u32 {
        let shortest = arrays.iter().map(|array| array.len()).min().unwrap_or(0);
        shortest.min(i32::MAX as usize) as u32
    }

    macro_rules! wide {
        ($e:expr) => {
            // SAFETY: registers only; used under `block_avx512` alone (head of this file).
            unsafe { $e }
        };
    }

    impl Lanes for Wide {
        type Index = __m256i;

        #[inline(always)]
        fn splat(value: f64) -> Self {
            Self(wide!(_mm512_set1_pd(value)))
        }

        #[inline(always)]
        fn load(values: &[f64; LANES]) -> Self {
            Self(wide!(_mm512_loadu_pd(values.as_ptr())))
        }

        #[inline(always)]
        fn store(self, values: &mut [f64; LANES]) {
            wide!(_mm512_storeu_pd(values.as_mut_ptr(), self.0));
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(wide!(_mm512_add_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            Self(wide!(_mm512_sub_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(wide!(_mm512_mul_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            Self(wide!(_mm512_div_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(wide!(_mm512_sqrt_pd(self.0)))
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(wide!(_mm512_max_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            Self(wide!(_mm512_min_pd(self.0, other.0)))
        }

        #[inline(always)]
        fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
            Self(wide!(_mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0), no.0, yes.0)))
        }

        #[inline(always)]
        fn whole(self) -> [u32; LANES] {
            let mut whole = [0; LANES];
            wide!(_mm256_storeu_si256(whole.as_mut_ptr().cast(), _mm512_cvttpd_epi32(self.0)));
            whole
        }

        #[inline(always)]
        fn entries(lists: &Lists, k: usize) -> Self::Index {
            let stride = lists.stride;
            assert!(k < stride && lists.of.len() >= LANES * stride && lists.of.len() <= i32::MAX as usize);
            wide!({
                let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
                let starts = _mm256_mullo_epi32(lane, _mm256_set1_epi32(stride as i32));
                _mm256_i32gather_epi32::<4>(lists.of.as_ptr().add(k).cast(), starts)
            })
        }

        #[inline(always)]
        fn gather<const C: usize>(arrays: [&[f64]; C], index: Self::Index) -> [Self; C] {
            let length = shortest(&arrays) as i32;
            wide!({
                let inside = _mm256_cmplt_epu32_mask(index, _mm256_set1_epi32(length));
                assert!(inside == 0xff, "a place outside its array");
                let mut values = [Self(_mm512_setzero_pd()); C];
                for (value, array) in values.iter_mut().zip(&arrays) {
                    *value = Self(_mm512_i32gather_pd::<8>(index, array.as_ptr().cast()));
                }
                values
            })
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
            check(&axes, (first, end), list, len);
            let bound = Self::splat(square);
            let mut at = first;
            while at < end {
                wide!({
                    let mut distance = Self::splat(0.0);
                    for a in 0..D {
                        let r = Self::splat(centre[a]).sub(Self(_mm512_loadu_pd(axes[a].as_ptr().add(at))));
                        distance = if a == 0 { r.mul(r) } else { distance.add(r.mul(r)) };
                    }
                    let rest = ((1_u32 << (end - at).min(LANES)) - 1) as u8;
                    let inside = _mm512_mask_cmp_pd_mask::<_CMP_LT_OQ>(rest, distance.0, bound.0);
                    let places = _mm256_add_epi32(
                        _mm256_set1_epi32(at as i32),
                        _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                    );
                    let kept = _mm256_maskz_compress_epi32(inside, places);
                    _mm256_storeu_si256(list.as_mut_ptr().add(len).cast(), kept);
                    len += inside.count_ones() as usize;
                });
                at += LANES;
            }
            len
        }
    }

    macro_rules! pair {
        ($e:expr) => {
            // SAFETY: registers only; used under `block_avx2` alone (head of this file).
            unsafe { $e }
        };
    }

    /// For each set of lanes, the lanes of the set first.
    static FIRST: [[u32; LANES]; 256] = {
        let mut table = [[0; LANES]; 256];
        let mut set = 0;
        while set < 256 {
            let (mut lane, mut to) = (0, 0);
            while lane < LANES {
                if set >> lane & 1 == 1 {
                    table[set][to] = lane as u32;
                    to += 1;
                }
                lane += 1;
            }
            set += 1;
        }
        table
    };

    impl Lanes for Pair {
        type Index = __m256i;

        #[inline(always)]
        fn splat(value: f64) -> Self {
            pair!(Self(_mm256_set1_pd(value), _mm256_set1_pd(value)))
        }

        #[inline(always)]
        fn load(values: &[f64; LANES]) -> Self {
            pair!(Self(_mm256_loadu_pd(values.as_ptr()), _mm256_loadu_pd(values.as_ptr().add(4))))
        }

        #[inline(always)]
        fn store(self, values: &mut [f64; LANES]) {
            pair!({
                _mm256_storeu_pd(values.as_mut_ptr(), self.0);
                _mm256_storeu_pd(values.as_mut_ptr().add(4), self.1);
            });
        }

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            pair!(Self(_mm256_add_pd(self.0, other.0), _mm256_add_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            pair!(Self(_mm256_sub_pd(self.0, other.0), _mm256_sub_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            pair!(Self(_mm256_mul_pd(self.0, other.0), _mm256_mul_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            pair!(Self(_mm256_div_pd(self.0, other.0), _mm256_div_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            pair!(Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)))
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            pair!(Self(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn min(self, other: Self) -> Self {
            pair!(Self(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)))
        }

        #[inline(always)]
        fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
            pair!(Self(
                _mm256_blendv_pd(no.0, yes.0, _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)),
                _mm256_blendv_pd(no.1, yes.1, _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1)),
            ))
        }

        #[inline(always)]
        fn whole(self) -> [u32; LANES] {
            let mut whole = [0; LANES];
            pair!({
                let both = _mm256_set_m128i(_mm256_cvttpd_epi32(self.1), _mm256_cvttpd_epi32(self.0));
                _mm256_storeu_si256(whole.as_mut_ptr().cast(), both);
            });
            whole
        }

        #[inline(always)]
        fn entries(lists: &Lists, k: usize) -> Self::Index {
            let stride = lists.stride;
            assert!(k < stride && lists.of.len() >= LANES * stride && lists.of.len() <= i32::MAX as usize);
            pair!({
                let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
                let starts = _mm256_mullo_epi32(lane, _mm256_set1_epi32(stride as i32));
                _mm256_i32gather_epi32::<4>(lists.of.as_ptr().add(k).cast(), starts)
            })
        }

        #[inline(always)]
        fn gather<const C: usize>(arrays: [&[f64]; C], index: Self::Index) -> [Self; C] {
            let length = shortest(&arrays) as i32;
            pair!({
                // Of two numbers below 2³², the smaller is the place exactly if the place is within bounds.
                let last = _mm256_set1_epi32(length - 1);
                let inside = _mm256_cmpeq_epi32(_mm256_min_epu32(index, last), index);
                assert!(length > 0 && _mm256_movemask_epi8(inside) == -1, "a place outside its array");
                let (low, high) = (_mm256_castsi256_si128(index), _mm256_extracti128_si256::<1>(index));
                let mut values = [Self(_mm256_setzero_pd(), _mm256_setzero_pd()); C];
                for (value, array) in values.iter_mut().zip(&arrays) {
                    let base = array.as_ptr();
                    *value = Self(_mm256_i32gather_pd::<8>(base, low), _mm256_i32gather_pd::<8>(base, high));
                }
                values
            })
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
            check(&axes, (first, end), list, len);
            let bound = Self::splat(square);
            let mut at = first;
            while at < end {
                pair!({
                    let mut distance = Self::splat(0.0);
                    for a in 0..D {
                        let base = axes[a].as_ptr().add(at);
                        let other = Self(_mm256_loadu_pd(base), _mm256_loadu_pd(base.add(4)));
                        let r = Self::splat(centre[a]).sub(other);
                        distance = if a == 0 { r.mul(r) } else { distance.add(r.mul(r)) };
                    }
                    let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(distance.0, bound.0));
                    let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(distance.1, bound.1));
                    let rest = (1_u32 << (end - at).min(LANES)) - 1;
                    let inside = ((low | high << 4) as u32 & rest) as usize;
                    let lanes = _mm256_loadu_si256(FIRST[inside].as_ptr().cast());
                    let kept = _mm256_add_epi32(_mm256_set1_epi32(at as i32), lanes);
                    _mm256_storeu_si256(list.as_mut_ptr().add(len).cast(), kept);
                    len += inside.count_ones() as usize;
                });
                at += LANES;
            }
            len
        }
    }
}
