//! Eight lanes on AVX2 and AVX-512, tables of columns, and rows of results that several threads write: all unsafe code of
//! the crate.
//!
//! Why it is sound:
//! - **Instructions.** A [`Wide`] or a [`Pair`] is used only by `block_avx512` and `block_avx2`, which [`block`] calls after
//!   the machine was asked for the features that these functions enable. Both types are private to this file. All of their
//!   loads and stores go through references to eight numbers.
//! - **Tables.** A [`Table`] keeps its columns at least [`LANES`] longer than `length`, and eight numbers are reached at a place
//!   of at most `length` only. It is made of lines of eight numbers, without gaps between them. Its numbers can be seen as atomic ones while it is borrowed mutably.
//! - **Rows.** [`write_rows`] checks that `order` names each row of the result once and hands each stretch of it to one task.
//!
//! Only correctly rounded operations on single lanes are used, and none is fused.

#![allow(unsafe_code)]

use super::arithmetic::{Scratch, Space, Take, Task, block_of};
use super::lanes::{Lanes, Portable};
use crate::kernel::LANES;
use rayon::prelude::*;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicU64};

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

/// What is called with the first place of some particles and how many there are, their sums in the scratch.
pub(super) type Done<'a, 'b> = &'a mut (dyn FnMut(usize, usize, &mut Scratch) + 'b);

/// Evaluates the particles at `places`, a few at a time. Without parameters of type, so that it is compiled here, once, and not
/// with every caller.
pub(super) fn block(
    dimension: usize,
    path: Path,
    task: &Task<'_>,
    places: Range<usize>,
    scratch: &mut Scratch,
    done: Done<'_, '_>,
) {
    match dimension {
        1 => block_in::<1>(path, task, places, scratch, done),
        2 => block_in::<2>(path, task, places, scratch, done),
        _ => block_in::<3>(path, task, places, scratch, done),
    }
}

fn block_in<const D: usize>(
    path: Path,
    task: &Task<'_>,
    places: Range<usize>,
    scratch: &mut Scratch,
    done: Done<'_, '_>,
) where
    Space<D>: Take,
{
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

/// Eight numbers in one line of the cache.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C, align(64))]
struct Line([f64; LANES]);

/// Columns of one length, read and written eight numbers at a time: each has room for eight more behind its end.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// Column by column, each of `step` numbers.
    lines: Vec<Line>,
    columns: usize,
    length: usize,
    /// `length` up to the next multiple of eight, and eight more.
    step: usize,
}

impl Table {
    /// Gives it this shape; what stands in it is anything.
    pub(super) fn shape(&mut self, columns: usize, length: usize) {
        let step = length.next_multiple_of(LANES) + LANES;
        *self = Self { lines: std::mem::take(&mut self.lines), columns, length, step };
        self.lines.resize(columns * step / LANES, Line::default());
    }

    /// Makes it at least as long as this, what stands in it kept.
    #[inline(always)]
    pub(super) fn reserve(&mut self, length: usize) {
        if length > self.length {
            self.grow(length);
        }
    }

    #[cold]
    fn grow(&mut self, length: usize) {
        let mut longer = Self::default();
        longer.shape(self.columns, 2 * length);
        for (to, from) in longer.columns().zip(self.columns()) {
            to[..from.len()].copy_from_slice(from);
        }
        *self = longer;
    }

    /// Each column, with what is behind its end.
    pub(super) fn columns(&mut self) -> impl Iterator<Item = &mut [f64]> {
        let numbers = self.lines.len() * LANES;
        // SAFETY: a line is eight numbers, without gaps, and the borrow is a mutable one for as long.
        let all = unsafe { std::slice::from_raw_parts_mut(self.lines.as_mut_ptr().cast(), numbers) };
        all.chunks_mut(self.step.max(1))
    }

    /// One column, with what is behind its end.
    #[inline(always)]
    pub(super) fn column(&self, column: usize) -> &[f64] {
        let lines = &self.lines[column * self.step / LANES..][..self.step / LANES];
        // SAFETY: a line is eight numbers, without gaps; borrowed for as long.
        unsafe { std::slice::from_raw_parts(lines.as_ptr().cast(), self.step) }
    }

    /// To read it eight by eight.
    #[inline(always)]
    pub(super) fn view(&self, columns: usize) -> View<'_> {
        assert!(columns <= self.columns, "no such columns");
        let first = self.lines.as_ptr().cast();
        View { first, length: self.length, step: self.step, columns, of: PhantomData }
    }

    /// To read and write it eight by eight.
    #[inline(always)]
    pub(super) fn view_mut(&mut self, columns: usize) -> ViewMut<'_> {
        assert!(columns <= self.columns, "no such columns");
        let first = self.lines.as_mut_ptr().cast();
        ViewMut { first, length: self.length, step: self.step, columns, of: PhantomData }
    }

    /// For several threads to write, each its own places: the bits of the numbers, column by column, and the step from one
    /// column to the next.
    pub(super) fn shared(&mut self) -> (&[AtomicU64], usize) {
        let numbers = self.lines.len() * LANES;
        // SAFETY: a line is eight numbers, without gaps; an AtomicU64 has the size of an f64, the alignment of a line is enough
        // for it, as is asserted, all bits are valid for both, and the borrow is a mutable one for as long.
        const { assert!(align_of::<AtomicU64>() <= align_of::<Line>()) };
        (unsafe { std::slice::from_raw_parts(self.lines.as_mut_ptr().cast(), numbers) }, self.step)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Line>() * self.lines.capacity()
    }
}

/// A table to read. By value: so it stays in registers while other tables are written.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    first: *const f64,
    length: usize,
    step: usize,
    columns: usize,
    of: PhantomData<&'a Table>,
}

impl<'a> View<'a> {
    /// Eight numbers of a column from place `at` on.
    #[inline(always)]
    pub(super) fn eight(self, column: usize, at: usize) -> &'a [f64; LANES] {
        assert!(column < self.columns && at <= self.length, "outside the table");
        // SAFETY: each column has LANES numbers from this place on; the table is borrowed.
        unsafe { &*self.first.add(column * self.step + at).cast() }
    }
}

/// A table to read and write.
pub(super) struct ViewMut<'a> {
    first: *mut f64,
    length: usize,
    step: usize,
    columns: usize,
    of: PhantomData<&'a mut Table>,
}

impl ViewMut<'_> {
    /// Eight numbers of a column from place `at` on.
    #[inline(always)]
    pub(super) fn eight(&mut self, column: usize, at: usize) -> &mut [f64; LANES] {
        assert!(column < self.columns && at <= self.length, "outside the table");
        // SAFETY: each column has LANES numbers from this place on; the table is borrowed mutably, and so is this.
        unsafe { &mut *self.first.add(column * self.step + at).cast() }
    }
}

/// For several threads to write, each its own places.
pub(super) fn shared(values: &mut [u32]) -> &[AtomicU32] {
    // SAFETY: as in `Table::shared`; size and alignment are those of u32.
    unsafe { std::slice::from_raw_parts(values.as_mut_ptr().cast(), values.len()) }
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
    /// Has the row of a place fetched before it is written.
    #[inline(always)]
    pub(super) fn fetch(&self, place: usize) {
        #[cfg(target_arch = "x86_64")]
        if let Some(particle) = self.order.get(place.wrapping_sub(self.first)) {
            let row = self.base.wrapping_add(*particle as usize * self.width);
            for line in (0..self.width).step_by(LANES) {
                // SAFETY: a hint that reads nothing.
                unsafe {
                    use std::arch::x86_64::{_MM_HINT_ET0, _mm_prefetch};
                    _mm_prefetch::<_MM_HINT_ET0>(row.wrapping_add(line).cast());
                }
            }
        }
    }

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
use x86::{block_avx2, block_avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::*;
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx512f,avx512vl,popcnt")]
    pub(super) fn block_avx512<const D: usize>(
        task: &Task<'_>,
        places: Range<usize>,
        scratch: &mut Scratch,
        done: Done<'_, '_>,
    ) where
        Space<D>: Take,
    {
        block_of::<Wide, D>(task, places, scratch, done);
    }

    #[target_feature(enable = "avx2,popcnt")]
    pub(super) fn block_avx2<const D: usize>(
        task: &Task<'_>,
        places: Range<usize>,
        scratch: &mut Scratch,
        done: Done<'_, '_>,
    ) where
        Space<D>: Take,
    {
        block_of::<Pair, D>(task, places, scratch, done);
    }

    /// Eight lanes in one register.
    #[derive(Clone, Copy)]
    struct Wide(__m512d);

    /// Eight lanes in two registers.
    #[derive(Clone, Copy)]
    struct Pair(__m256d, __m256d);

    macro_rules! intrinsics {
        ($e:expr) => {
            // SAFETY: registers, and references to eight numbers; used under `block_avx512` or `block_avx2` alone (head of
            // this file).
            unsafe { $e }
        };
    }

    /// The operations lane by lane: of one register, for each of `$part`.
    macro_rules! lane_by_lane {
        ($splat:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $sqrt:ident, $min:ident, $max:ident, $($part:tt),+) => {
            #[inline(always)]
            fn splat(value: f64) -> Self {
                intrinsics!(Self($({ let _ = $part; $splat(value) }),+))
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                intrinsics!(Self($($add(self.$part, other.$part)),+))
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                intrinsics!(Self($($sub(self.$part, other.$part)),+))
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                intrinsics!(Self($($mul(self.$part, other.$part)),+))
            }

            #[inline(always)]
            fn div(self, other: Self) -> Self {
                intrinsics!(Self($($div(self.$part, other.$part)),+))
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                intrinsics!(Self($($sqrt(self.$part)),+))
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                intrinsics!(Self($($min(self.$part, other.$part)),+))
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                intrinsics!(Self($($max(self.$part, other.$part)),+))
            }
        };
    }

    impl Lanes for Wide {
        lane_by_lane!(
            _mm512_set1_pd,
            _mm512_add_pd,
            _mm512_sub_pd,
            _mm512_mul_pd,
            _mm512_div_pd,
            _mm512_sqrt_pd,
            _mm512_min_pd,
            _mm512_max_pd,
            0
        );

        #[inline(always)]
        fn load(values: &[f64; LANES]) -> Self {
            Self(intrinsics!(_mm512_loadu_pd(values.as_ptr())))
        }

        #[inline(always)]
        fn store(self, values: &mut [f64; LANES]) {
            intrinsics!(_mm512_storeu_pd(values.as_mut_ptr(), self.0));
        }

        #[inline(always)]
        fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
            Self(intrinsics!(_mm512_mask_blend_pd(self.below(other), no.0, yes.0)))
        }

        #[inline(always)]
        fn below(self, other: Self) -> u8 {
            intrinsics!(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0))
        }

        #[inline(always)]
        fn pack(self, inside: u8, to: &mut [f64; LANES]) {
            intrinsics!(_mm512_storeu_pd(to.as_mut_ptr(), _mm512_maskz_compress_pd(inside, self.0)));
        }

        #[inline(always)]
        fn totals(of: [Self; LANES]) -> Self {
            let [a, e, b, f, c, g, d, h] = of;
            let p = quarters(halves(a.0, b.0), halves(c.0, d.0));
            let q = quarters(halves(e.0, f.0), halves(g.0, h.0));
            Self(intrinsics!(_mm512_add_pd(_mm512_unpacklo_pd(p, q), _mm512_unpackhi_pd(p, q))))
        }
    }

    /// Lanes l + (l + 4) of two.
    #[inline(always)]
    fn halves(p: __m512d, q: __m512d) -> __m512d {
        intrinsics!({
            let low = _mm512_shuffle_f64x2::<0b01_00_01_00>(p, q);
            _mm512_add_pd(low, _mm512_shuffle_f64x2::<0b11_10_11_10>(p, q))
        })
    }

    /// Of lanes added by [`halves`], l + (l + 2).
    #[inline(always)]
    fn quarters(p: __m512d, q: __m512d) -> __m512d {
        intrinsics!({
            let low = _mm512_shuffle_f64x2::<0b10_00_10_00>(p, q);
            _mm512_add_pd(low, _mm512_shuffle_f64x2::<0b11_01_11_01>(p, q))
        })
    }

    /// For each set of four lanes, the halves of the lanes of the set first.
    static FIRST: [[i32; 8]; 16] = {
        let mut table = [[0; 8]; 16];
        let mut set = 0;
        while set < 16 {
            let (mut lane, mut to) = (0, 0);
            while lane < 4 {
                if set >> lane & 1 == 1 {
                    (table[set][to], table[set][to + 1]) = (2 * lane, 2 * lane + 1);
                    to += 2;
                }
                lane += 1;
            }
            set += 1;
        }
        table
    };

    impl Lanes for Pair {
        lane_by_lane!(
            _mm256_set1_pd,
            _mm256_add_pd,
            _mm256_sub_pd,
            _mm256_mul_pd,
            _mm256_div_pd,
            _mm256_sqrt_pd,
            _mm256_min_pd,
            _mm256_max_pd,
            0,
            1
        );

        #[inline(always)]
        fn load(values: &[f64; LANES]) -> Self {
            intrinsics!(Self(_mm256_loadu_pd(values.as_ptr()), _mm256_loadu_pd(values.as_ptr().add(4))))
        }

        #[inline(always)]
        fn store(self, values: &mut [f64; LANES]) {
            intrinsics!({
                _mm256_storeu_pd(values.as_mut_ptr(), self.0);
                _mm256_storeu_pd(values.as_mut_ptr().add(4), self.1);
            });
        }

        #[inline(always)]
        fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
            intrinsics!(Self(
                _mm256_blendv_pd(no.0, yes.0, _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)),
                _mm256_blendv_pd(no.1, yes.1, _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1)),
            ))
        }

        #[inline(always)]
        fn below(self, other: Self) -> u8 {
            intrinsics!({
                let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0));
                let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1));
                (low | high << 4) as u8
            })
        }

        #[inline(always)]
        fn pack(self, inside: u8, to: &mut [f64; LANES]) {
            let (low, high) = (usize::from(inside & 15), usize::from(inside >> 4));
            intrinsics!({
                _mm256_storeu_pd(to.as_mut_ptr(), packed(self.0, low));
                // The low part fills at most the first half.
                _mm256_storeu_pd(to.as_mut_ptr().add(low.count_ones() as usize), packed(self.1, high));
            });
        }

        #[inline(always)]
        fn totals(of: [Self; LANES]) -> Self {
            let [a, b, c, d, e, f, g, h] = of;
            Self(totals([a, b, c, d]), totals([e, f, g, h]))
        }
    }

    /// The lanes of the set first, in their order.
    #[inline(always)]
    fn packed(part: __m256d, set: usize) -> __m256d {
        intrinsics!({
            let lanes = _mm256_loadu_si256(FIRST[set].as_ptr().cast());
            _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(part), lanes))
        })
    }

    /// Of four.
    #[inline(always)]
    fn totals([a, b, c, d]: [Pair; 4]) -> __m256d {
        intrinsics!({
            // Lanes l + (l + 4); of these l + (l + 2), of two; of these l + (l + 1), of four.
            let (a, b) = (_mm256_add_pd(a.0, a.1), _mm256_add_pd(b.0, b.1));
            let (c, d) = (_mm256_add_pd(c.0, c.1), _mm256_add_pd(d.0, d.1));
            let p = _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(a, c), _mm256_permute2f128_pd::<0x31>(a, c));
            let q = _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(b, d), _mm256_permute2f128_pd::<0x31>(b, d));
            _mm256_add_pd(_mm256_unpacklo_pd(p, q), _mm256_unpackhi_pd(p, q))
        })
    }
}
