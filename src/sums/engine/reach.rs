//! The stretch of each row that a support covers.
//!
//! A ball cuts a row in a chord. Its ends are found for eight rows at a time, from where the particles of each row really
//! are; the table of columns says which places lie between. What is found may hold more than the ball, never less.

#![allow(clippy::needless_range_loop)] // Axes, lanes and orders index several arrays at once.

use super::lanes::Lanes;
use super::sorted::Sorted;
use crate::kernel::LANES;

/// Widens R² against the roundings of squared distances.
const WIDER: f64 = 1.0 + 1e-12;

/// Against the rounding of an end of a chord, relative to the coordinate.
const ROUNDING: f64 = 1e-15;

/// Ranges longer than this are cut by bisection: the columns of their row are too coarse.
const COARSE: usize = 64;

/// The rows around one row, eight by eight.
#[derive(Debug, Default)]
pub(super) struct Reach {
    rows: Vec<u32>,
    blocks: Vec<Block>,
}

/// Eight rows.
#[derive(Debug, Clone)]
struct Block {
    /// By axis across the rows: where their particles are.
    low: [[f64; LANES]; 2],
    high: [[f64; LANES]; 2],
    /// Along the rows.
    origin: [f64; LANES],
    inverse_width: [f64; LANES],
    last: [f64; LANES],
    table: [u32; LANES],
    rows: usize,
}

impl Reach {
    /// The rows around `row`.
    pub(super) fn aim(&mut self, sorted: &Sorted, row: usize, dimension: usize) {
        sorted.near(row, &mut self.rows);
        self.blocks.clear();
        for rows in self.rows.chunks(LANES) {
            let mut block = Block {
                low: [[0.0; LANES]; 2],
                high: [[0.0; LANES]; 2],
                origin: [0.0; LANES],
                inverse_width: [0.0; LANES],
                last: [0.0; LANES],
                table: [0; LANES],
                rows: rows.len(),
            };
            for (lane, index) in rows.iter().enumerate() {
                let row = &sorted.rows[*index as usize];
                for axis in 0..dimension - 1 {
                    block.low[axis][lane] = row.low[axis];
                    block.high[axis][lane] = row.high[axis];
                }
                block.origin[lane] = row.low[dimension - 1];
                block.inverse_width[lane] = row.inverse_width;
                block.last[lane] = f64::from(row.last_column());
                block.table[lane] = row.table;
            }
            self.blocks.push(block);
        }
    }

    /// The places to look at for neighbours of a particle at `centre`, row by row, as (first, end).
    #[inline(always)]
    pub(super) fn ranges<L: Lanes, const D: usize>(
        &self,
        sorted: &Sorted,
        centre: [f64; D],
        square: f64,
        found: &mut Vec<(u32, u32)>,
    ) {
        found.clear();
        let zero = L::splat(0.0);
        let along = centre[D - 1];
        let rounding = L::splat(along.abs() * ROUNDING);
        for block in &self.blocks {
            let mut left = L::splat(square * WIDER);
            for a in 0..D - 1 {
                let x = L::splat(centre[a]);
                let apart = L::load(&block.low[a]).sub(x).max(x.sub(L::load(&block.high[a]))).max(zero);
                left = left.sub(apart.mul(apart));
            }
            // Outside the ball the chord is none: its end comes to lie before its start.
            let chord = left.max(zero).sqrt().add(rounding);
            let (origin, inverse) = (L::load(&block.origin), L::load(&block.inverse_width));
            let last = L::load(&block.last);
            let x = L::splat(along);
            let column = |u: L| u.sub(origin).mul(inverse).max(zero).min(last).whole();
            let from = column(x.sub(chord));
            let to = column(x.add(chord));
            let mut chords = [0.0; LANES];
            left.store(&mut chords);
            for lane in 0..block.rows {
                if chords[lane] <= 0.0 {
                    continue;
                }
                let table = block.table[lane];
                let mut first = sorted.starts[(table + from[lane]) as usize];
                let mut end = sorted.starts[(table + to[lane] + 1) as usize];
                if (end - first) as usize > COARSE {
                    let mut half = [0.0; LANES];
                    chord.store(&mut half);
                    let row = &sorted.columns[D - 1][first as usize..end as usize];
                    let skip = row.partition_point(|u| *u < along - half[lane]);
                    let keep = row.partition_point(|u| *u <= along + half[lane]);
                    (first, end) = (first + skip as u32, first + keep as u32);
                }
                if first < end {
                    found.push((first, end));
                }
            }
        }
    }
}
