//! The neighbours of a particle: windows that slide along the rows around it, and candidates that a few particles share.
//!
//! The particles of a row are taken in ascending order of the last coordinate, so that what one of them leaves behind in a
//! row beside it, the next ones need not look at. A few that stand next to each other take what is within R of the box
//! around them out of the windows together; what is kept of these candidates, and then of the neighbours of each, is
//! tested eight at a time and packed without gaps.
//!
//! Nothing is lost by rounding, as rounding is monotone: where the difference of one coordinate alone reaches R, or the
//! distance from the box, the sum of squares does so, as evaluated.

#![allow(clippy::needless_range_loop)] // Axes index several arrays at once.

use super::lanes::{Lanes, larger, smaller};
use super::request::Plan;
use super::sorted::Sorted;
use super::vector::Table;
use crate::kernel::LANES;

/// Particles that share their candidates.
const TOGETHER: usize = 8;

/// The rows around one row, and the candidates of a few of its particles.
#[derive(Debug, Default)]
pub(super) struct Reach {
    rows: Vec<u32>,
    windows: Vec<Window>,
    /// Coordinates, weight and fields of all that stand within R of the box around some particles next to each other, in the
    /// order of the sorted particles, filled up to a multiple of eight with what is infinitely far away.
    candidates: Table,
    count: usize,
    /// Where these particles end.
    until: usize,
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
    /// For particles with this number of columns: coordinates, weight, fields.
    pub(super) fn new(columns: usize) -> Self {
        let mut candidates = Table::default();
        candidates.shape(columns, 32 * LANES);
        Self { candidates, ..Self::default() }
    }

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
        self.until = place;
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

    /// Enters r_ij, ω_j and f_j − f_i of the neighbours of the particle at `place`, in a row that ends at `end`, into `near` from
    /// `at` on, fills up with zeros to a multiple of eight, and returns how many neighbours there are.
    #[inline(always)]
    pub(super) fn neighbours<L: Lanes, const D: usize, const FIELDS: usize>(
        &mut self,
        sorted: &Sorted,
        plan: &Plan,
        bounds: Bounds,
        (place, end): (usize, usize),
        near: &mut Table,
        at: usize,
    ) -> usize {
        if place >= self.until {
            // Particles far from each other have no candidates in common.
            let along = sorted.table.column(D - 1);
            self.until = place + 1;
            while self.until < end.min(place + TOGETHER) && along[self.until] - along[place] < bounds.reach {
                self.until += 1;
            }
            self.gather::<L, D, FIELDS>(sorted, plan, bounds, place);
        }
        let columns = columns::<D, FIELDS>(plan);
        near.reserve(at + self.count + LANES);
        let (candidates, mut packed) = (self.candidates.view(columns), near.view_mut(columns));
        let own = sorted.table.view(columns);
        let mut centre = [L::splat(0.0); D];
        for a in 0..D {
            centre[a] = L::splat(own.eight(a, place)[0]);
        }
        let square = L::splat(bounds.square);
        let mut to = at;
        for from in (0..self.count).step_by(LANES) {
            let mut r = centre;
            let mut distance = L::splat(0.0);
            for a in 0..D {
                r[a] = centre[a].sub(L::load(candidates.eight(a, from)));
                distance = if a == 0 { r[a].mul(r[a]) } else { distance.add(r[a].mul(r[a])) };
            }
            let inside = distance.below(square);
            for a in 0..D {
                r[a].pack(inside, packed.eight(a, to));
            }
            L::load(candidates.eight(D, from)).pack(inside, packed.eight(D, to));
            for column in D + 1..columns {
                let own = L::splat(own.eight(column, place)[0]);
                L::load(candidates.eight(column, from)).sub(own).pack(inside, packed.eight(column, to));
            }
            to += inside.count_ones() as usize;
        }
        for column in 0..columns {
            L::splat(0.0).store(packed.eight(column, to));
        }
        to - at
    }

    /// The candidates of the particles from `place` to `self.until`.
    #[inline(always)]
    fn gather<L: Lanes, const D: usize, const FIELDS: usize>(
        &mut self,
        sorted: &Sorted,
        plan: &Plan,
        bounds: Bounds,
        place: usize,
    ) {
        let columns = columns::<D, FIELDS>(plan);
        let along = sorted.table.column(D - 1);
        let (mut low, mut high) = ([0.0; D], [0.0; D]);
        for a in 0..D {
            let of = &sorted.table.column(a)[place..self.until];
            (low[a], high[a]) = (of[0], of[0]);
            for x in of {
                (low[a], high[a]) = (smaller(low[a], *x), larger(high[a], *x));
            }
        }
        let here = sorted.table.view(columns);
        let (mut lows, mut highs) = ([L::splat(0.0); D], [L::splat(0.0); D]);
        for a in 0..D {
            (lows[a], highs[a]) = (L::splat(low[a]), L::splat(high[a]));
        }
        let (zero, square) = (L::splat(0.0), L::splat(bounds.square));
        let reach = L::splat(bounds.reach.next_down());
        let mut to = 0;
        for window in &mut self.windows {
            let mut beside = 0.0;
            for a in 0..D - 1 {
                let apart = larger(larger(window.low[a] - high[a], low[a] - window.high[a]), 0.0);
                beside += apart * apart;
            }
            if beside >= bounds.square {
                continue;
            }
            let (mut first, end) = (window.first, window.end);
            while first + LANES <= end && low[D - 1] - along[first + LANES - 1] >= bounds.reach {
                first += LANES;
            }
            window.first = first;
            let mut next = first;
            while next < end && along[next] - high[D - 1] < bounds.reach {
                self.candidates.reserve(to + LANES);
                let mut candidates = self.candidates.view_mut(columns);
                let mut distance = zero;
                for a in 0..D {
                    let x = L::load(here.eight(a, next));
                    let apart = lows[a].sub(x).max(x.sub(highs[a])).max(zero);
                    distance = if a == 0 { apart.mul(apart) } else { distance.add(apart.mul(apart)) };
                }
                let ahead = 0xff_u8 >> LANES.saturating_sub(end - next);
                let inside = distance.below(square) & ahead;
                for column in 0..columns {
                    L::load(here.eight(column, next)).pack(inside, candidates.eight(column, to));
                }
                to += inside.count_ones() as usize;
                // What is behind stands together: it is never found in a later eight if not in all before.
                let behind = reach.below(lows[D - 1].sub(L::load(here.eight(D - 1, next))));
                window.first += (behind & ahead).count_ones() as usize;
                next += LANES;
            }
        }
        L::splat(f64::INFINITY).store(self.candidates.view_mut(columns).eight(0, to));
        self.count = to;
    }
}

/// As a number of fields known when compiling: more than those that are written out.
pub(super) const MANY: usize = usize::MAX;

/// Coordinates, weight, fields.
#[inline(always)]
fn columns<const D: usize, const FIELDS: usize>(plan: &Plan) -> usize {
    D + 1 + if FIELDS == MANY { plan.fields } else { FIELDS }
}
