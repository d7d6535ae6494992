//! A few particles at a time: their neighbours, the kernel, the sums.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.

use super::lanes::Lanes;
use super::radial::Radial;
use super::reach::{Bounds, MANY, Reach};
use super::request::{Factor, Pass, Plan, monomials, monomials_below};
use super::sorted::Sorted;
use super::vector::{Done, Table};
use crate::kernel::LANES;
use std::ops::Range;

/// Particles that go through each step together.
pub(super) const BATCH: usize = 8;

/// No more particles join those that have this many neighbours: what is kept of these should stay in the nearest cache.
const ENOUGH: usize = 512;

/// All that particles are evaluated from.
#[derive(Debug)]
pub(super) struct Task<'a> {
    pub(super) sorted: &'a Sorted,
    pub(super) plan: &'a Plan,
    pub(super) radial: &'a Radial,
    pub(super) support: f64,
}

/// Memory of one thread.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    reach: Reach,
    /// Of the neighbours of each particle of a batch, one particle behind the other: r_ij by axis, ω_j, f_j − f_i by field, and
    /// ω_j G_k by k.
    near: Table,
    /// Where the neighbours of each particle end.
    ends: [usize; BATCH],
    /// The sums of each particle of a batch.
    sums: Vec<f64>,
    /// Neighbours seen, i itself included.
    pub(super) pairs: u64,
}

impl Scratch {
    pub(super) fn new(plan: &Plan, dimension: usize) -> Self {
        let mut near = Table::default();
        near.shape(dimension + 1 + plan.fields + 3, 2 * ENOUGH);
        let sums = BATCH * plan.sums;
        let reach = Reach::new(dimension + 1 + plan.fields);
        Self { reach, near, sums: vec![0.0; sums], ..Self::default() }
    }

    /// The sums of one particle of the batch.
    #[inline(always)]
    pub(super) fn sums(&self, particle: usize) -> &[f64] {
        let each = self.sums.len() / BATCH;
        &self.sums[particle * each..][..each]
    }
}

/// Evaluates the particles at `places`, batch by batch.
#[inline(always)]
pub(super) fn block_of<L: Lanes, const D: usize>(
    task: &Task<'_>,
    places: Range<usize>,
    scratch: &mut Scratch,
    done: Done<'_, '_>,
) where
    Space<D>: Take,
{
    let (sorted, plan) = (task.sorted, task.plan);
    let bounds = Bounds::new(task.support);
    let mut row = sorted.row_at(places.start);
    scratch.reach.aim(sorted, row, places.start, D, bounds);
    let mut place = places.start;
    while place < places.end {
        let (mut count, mut length) = (0, 0);
        while count < BATCH && length < ENOUGH && place < places.end {
            if place == sorted.rows[row].end as usize {
                row += 1;
                scratch.reach.aim(sorted, row, place, D, bounds);
            }
            let Scratch { reach, near, .. } = scratch;
            let own = (place, sorted.rows[row].end as usize);
            let neighbours = match plan.fields {
                0 => reach.neighbours::<L, D, 0>(sorted, plan, bounds, own, near, length),
                1 => reach.neighbours::<L, D, 1>(sorted, plan, bounds, own, near, length),
                _ => reach.neighbours::<L, D, MANY>(sorted, plan, bounds, own, near, length),
            };
            scratch.pairs += neighbours as u64;
            length += neighbours.next_multiple_of(LANES);
            scratch.ends[count] = length;
            count += 1;
            place += 1;
        }
        evaluate::<L, D>(task, &mut scratch.near, length);
        for pass in &plan.passes {
            Space::<D>::take::<L>(plan, pass, count, scratch);
        }
        done(place - count, count, scratch);
    }
}

/// ω G_k of all neighbours of a batch.
#[inline(always)]
fn evaluate<L: Lanes, const D: usize>(task: &Task<'_>, near: &mut Table, length: usize) {
    const STEP: usize = 4 * LANES;
    let whole = length / STEP * STEP;
    for at in (0..whole).step_by(STEP) {
        evaluate_at::<L, D, 4>(task, near, at);
    }
    for at in (whole..length).step_by(LANES) {
        evaluate_at::<L, D, 1>(task, near, at);
    }
}

/// N times eight neighbours from place `at` on.
#[inline(always)]
fn evaluate_at<L: Lanes, const D: usize, const N: usize>(task: &Task<'_>, near: &mut Table, at: usize) {
    let (one, inverse_support) = (L::splat(1.0), L::splat(1.0 / task.support));
    let first = D + 1 + task.plan.fields;
    let wanted = task.plan.radials;
    let mut near = near.view_mut(first + 3);
    let mut x = [one; N];
    for n in 0..N {
        let mut square = L::splat(0.0);
        for a in 0..D {
            let r = L::load(near.eight(a, at + n * LANES));
            square = if a == 0 { r.mul(r) } else { square.add(r.mul(r)) };
        }
        x[n] = square.sqrt().mul(inverse_support).min(one);
    }
    let g = task.radial.evaluate::<L, N>(x, &wanted);
    for k in 0..3 {
        if wanted[k] {
            for n in 0..N {
                let weight = L::load(near.eight(D, at + n * LANES));
                g[k][n].mul(weight).store(near.eight(first + k, at + n * LANES));
            }
        }
    }
}

/// A space of D dimensions, in which the number of sums up to each degree is known.
pub(super) struct Space<const D: usize>;

/// One pass: Σ r^μ g of every wanted degree.
pub(super) trait Take {
    fn take<L: Lanes>(plan: &Plan, pass: &Pass, count: usize, scratch: &mut Scratch);
}

macro_rules! take {
    ($($dimension:literal)*) => {
        $(impl Take for Space<$dimension> {
            #[inline(always)]
            fn take<L: Lanes>(plan: &Plan, pass: &Pass, count: usize, scratch: &mut Scratch) {
                take!($dimension: plan, pass, count, scratch; 0 1 2 3 4 5 6 7 8)
            }
        })*
    };
    ($dimension:literal: $plan:ident, $pass:ident, $count:ident, $scratch:ident; $($highest:literal)*) => {
        match $pass.highest() {
            $($highest => {
                const SUMS: usize = monomials_below($dimension, $highest + 1);
                const PRODUCTS: usize = monomials($dimension, $highest);
                const EIGHTS: usize = SUMS.div_ceil(LANES);
                up_to::<L, $dimension, $highest, SUMS, PRODUCTS, EIGHTS>($plan, $pass, $count, $scratch)
            })*
            _ => {}
        }
    };
}

take!(1 2 3);

/// What is to be done for each degree up to the highest, written out: so that all places in arrays are known and the arrays
/// become registers.
macro_rules! degrees {
    ($n:ident <= $highest:ident => $do:expr) => {
        degrees!($n <= $highest => $do; 0 1 2 3 4 5 6 7 8)
    };
    ($n:ident <= $highest:ident => $do:expr; $($degree:literal)*) => {
        $(if $degree < $highest + 1 {
            const $n: usize = $degree;
            $do
        })*
    };
}

#[inline(always)]
fn up_to<
    L: Lanes,
    const D: usize,
    const HIGHEST: usize,
    const SUMS: usize,
    const PRODUCTS: usize,
    const EIGHTS: usize,
>(
    plan: &Plan,
    pass: &Pass,
    count: usize,
    scratch: &mut Scratch,
) {
    let (near, degrees) = (scratch.near.view(D + 4 + plan.fields), pass.degrees);
    let g_column = D + 1 + plan.fields + pass.radial;
    let mut at = 0;
    for (particle, end) in scratch.ends.iter().enumerate().take(count) {
        let mut own = [L::splat(0.0); SUMS];
        while at < *end {
            let mut x = [L::splat(0.0); D];
            for a in 0..D {
                x[a] = L::load(near.eight(a, at));
            }
            let mut g = L::load(near.eight(g_column, at));
            if let Factor::Difference(field) = pass.factor {
                g = g.mul(L::load(near.eight(D + 1 + field, at)));
            }
            let mut products = [g; PRODUCTS];
            degrees!(N <= HIGHEST => {
                raise::<L, D, N, PRODUCTS>(&mut products, x);
                if degrees & (1 << N) != 0 {
                    let from = const { monomials_below(D, N) };
                    for a in 0..const { monomials(D, N) } {
                        own[from + a] = own[from + a].add(products[a]);
                    }
                }
            });
            at += LANES;
        }
        let mut totals = [[0.0; LANES]; EIGHTS];
        for eight in 0..EIGHTS {
            let mut of = [L::splat(0.0); LANES];
            for l in 0..LANES {
                if eight * LANES + l < SUMS {
                    of[l] = own[eight * LANES + l];
                }
            }
            L::totals(of).store(&mut totals[eight]);
        }
        let sums = &mut scratch.sums[particle * plan.sums..][..plan.sums];
        degrees!(N <= HIGHEST => if degrees & (1 << N) != 0 {
            let (from, count) = const { (monomials_below(D, N), monomials(D, N)) };
            sums[pass.offsets[N]..][..count].copy_from_slice(&totals.as_flattened()[from..][..count]);
        });
    }
}

/// The products of degree N − 1 become those of degree N: all times x, those without x times y, the last times z.
#[inline(always)]
fn raise<L: Lanes, const D: usize, const N: usize, const PRODUCTS: usize>(
    products: &mut [L; PRODUCTS],
    x: [L; D],
) {
    if N == 0 {
        return;
    }
    let before = const { monomials(D, N.saturating_sub(1)) };
    if D == 3 {
        products[before + N] = products[before - 1].mul(x[2]);
        for a in 0..N {
            products[before + a] = products[before - N + a].mul(x[1]);
        }
    } else if D == 2 {
        products[before] = products[before - 1].mul(x[1]);
    }
    for a in 0..before {
        products[a] = products[a].mul(x[0]);
    }
}
