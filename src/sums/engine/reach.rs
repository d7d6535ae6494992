//! Windows that slide along the rows around a particle, and the neighbours in them.
//!
//! The particles of a row are taken in ascending order of the last coordinate, so that what one of them leaves behind in a
//! row beside it, the next ones need not look at. Distances to what stands in a window are tested eight at a time, and what
//! is kept of the neighbours is packed without gaps.
//!
//! Nothing is lost by rounding, as rounding is monotone: where the difference of one coordinate alone reaches R, the sum of
//! squares does so, as evaluated.

#![allow(clippy::needless_range_loop)] // Axes index several arrays at once.

use super::lanes::Lanes;
use super::request::Plan;
use super::sorted::Sorted;
use super::vector::Table;
use crate::kernel::LANES;

/// The rows around one row.
#[derive(Debug, Default)]
pub(super) struct Reach {
    rows: Vec<u32>,
    windows: Vec<Window>,
}

/// What of one row is still ahead.
#[derive(Debug, Clone, Copy)]
struct Window {
    /// By axis across the rows: where the particles are.
    low: [f64; 2],
    high: [f64; 2],
    first: usize,
    end: usize,
}

/// What a distance is compared with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// R².
    pub(super) square: f64,
    /// The smallest number with a square of at least R².
    reach: f64,
}

impl Bounds {
    pub(super) fn new(support: f64) -> Self {
        let square = support * support;
        let mut reach = support;
        while reach.next_down() * reach.next_down() >= square {
            reach = reach.next_down();
        }
        Self { square, reach }
    }
}

impl Reach {
    /// Opens the rows around `row` for its particles from `place` on.
    pub(super) fn aim(
        &mut self,
        sorted: &Sorted,
        row: usize,
        place: usize,
        dimension: usize,
        bounds: Bounds,
    ) {
        sorted.near(row, &mut self.rows);
        self.windows.clear();
        let along = sorted.table.column(dimension - 1);
        let own = along[place];
        self.windows.extend(self.rows.iter().map(|near| {
            let row = &sorted.rows[*near as usize];
            let (first, end) = (row.first as usize, row.end as usize);
            let behind = along[first..end].partition_point(|u| own - u >= bounds.reach);
            Window { low: row.low, high: row.high, first: first + behind, end }
        }));
    }

    /// Enters r_ij, ω_j and f_j − f_i of the neighbours of the particle at `place` into `near` from `at` on, fills up with
    /// zeros to a multiple of eight, and returns how many neighbours there are.
    #[inline(always)]
    pub(super) fn neighbours<L: Lanes, const D: usize>(
        &mut self,
        sorted: &Sorted,
        plan: &Plan,
        bounds: Bounds,
        place: usize,
        near: &mut Table,
        at: usize,
    ) -> usize {
        let table = &sorted.table;
        let along = table.column(D - 1);
        let here = table.view();
        let mut packed = near.view_mut();
        let (mut own, mut centre) = ([0.0; D], [L::splat(0.0); D]);
        for a in 0..D {
            own[a] = here.eight(a, place)[0];
            centre[a] = L::splat(own[a]);
        }
        let (square, reach) = (L::splat(bounds.square), L::splat(bounds.reach.next_down()));
        let mut to = at;
        for window in &mut self.windows {
            let mut beside = 0.0;
            for a in 0..D - 1 {
                let apart = larger(larger(window.low[a] - own[a], own[a] - window.high[a]), 0.0);
                beside += apart * apart;
            }
            if beside >= bounds.square {
                continue;
            }
            let (mut first, end) = (window.first, window.end);
            while first + LANES <= end && own[D - 1] - along[first + LANES - 1] >= bounds.reach {
                first += LANES;
            }
            window.first = first;
            let mut next = first;
            while next < end && along[next] - own[D - 1] < bounds.reach {
                let mut r = centre;
                let mut distance = L::splat(0.0);
                for a in 0..D {
                    r[a] = centre[a].sub(L::load(here.eight(a, next)));
                    distance = if a == 0 { r[a].mul(r[a]) } else { distance.add(r[a].mul(r[a])) };
                }
                let ahead = 0xff_u8 >> LANES.saturating_sub(end - next);
                let inside = distance.below(square) & ahead;
                if to + LANES > packed.length() {
                    near.grow();
                    packed = near.view_mut();
                }
                for a in 0..D {
                    r[a].pack(inside, packed.eight(a, to));
                }
                L::load(here.eight(D, next)).pack(inside, packed.eight(D, to));
                for column in D + 1..=D + plan.fields {
                    let own = L::splat(here.eight(column, place)[0]);
                    L::load(here.eight(column, next)).sub(own).pack(inside, packed.eight(column, to));
                }
                to += inside.count_ones() as usize;
                next += LANES;
                // What is behind stands together: it is never found in a later eight if not in all before.
                window.first += (reach.below(r[D - 1]) & ahead).count_ones() as usize;
            }
        }
        for column in 0..=D + plan.fields {
            L::splat(0.0).store(packed.eight(column, to));
        }
        to - at
    }
}

/// `f64::max` without its care for NaN, which costs.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
