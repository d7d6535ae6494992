//! Particles in rows of cells, sorted along each row, one array per quantity.
//!
//! The axes but the last are cut into cells of edge R/2; a cell of these is a row along the last axis. Only rows that hold
//! particles are stored, so an outlier costs one row. In a row the particles stand in ascending order of the last
//! coordinate, then of the others, weight and fields: the order in which they were given does not matter. A table of columns,
//! two for each particle, says where in a row a coordinate is.

use super::run::Points;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Cells of a row on each side that may hold neighbours.
const CELLS: u32 = 2;

/// How much wider than R/2 a cell is, against rounding of cell numbers up to [`MOST_CELLS`].
const MARGIN: f64 = 1.0 + 1.0 / 65536.0;

/// Cell numbers end here; what lies beyond is in the last cell. Each error of a number is below 2^−20.
const MOST_CELLS: f64 = (1_u64 << 31) as f64;

/// Elements behind the last particle, so that eight can be loaded from any place.
const PADDING: usize = 8;

/// A row with more particles than this in one column is sorted by comparison.
const CROWDED: u32 = 16;

/// Particles of one task.
const TASK: usize = 8192;

/// The particles, sorted.
#[derive(Debug, Default)]
pub(super) struct Sorted {
    /// Coordinates by axis, then weight, then fields.
    pub(super) columns: Vec<Vec<f64>>,
    /// The particle that stands at each place.
    pub(super) order: Vec<u32>,
    /// By key.
    pub(super) rows: Vec<Row>,
    /// Of each row, the place where each of its columns begins, and its end.
    pub(super) starts: Vec<u32>,
}

/// The particles of one row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Row {
    key: (u32, u32),
    pub(super) first: u32,
    pub(super) end: u32,
    /// Where its particles are, by axis.
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    /// Columns per length.
    pub(super) inverse_width: f64,
    /// Its place in `starts`.
    pub(super) table: u32,
}

impl Row {
    /// The highest number of a column.
    pub(super) fn last_column(&self) -> u32 {
        2 * (self.end - self.first) - 1
    }
}

/// Where cells are.
struct Grid {
    origin: [f64; 2],
    /// The highest coordinates across the rows.
    high: [f64; 3],
    inverse_edge: f64,
}

impl Grid {
    fn new(points: &Points<'_>, dimension: usize, support: f64) -> Self {
        let inverse_edge = f64::from(CELLS) / support / MARGIN;
        let (mut origin, mut high) = ([0.0; 2], [0.0; 3]);
        for (axis, origin) in origin.iter_mut().enumerate().take(dimension - 1) {
            let (low, most) = bounds(points.positions, axis);
            (*origin, high[axis]) = (low, most);
            let high = most;
            if (high - low) * inverse_edge >= MOST_CELLS {
                // Half the cells on either side of the middle particle, whatever the outliers.
                let mut all: Vec<f64> = points.positions.iter().map(|x| x[axis]).collect();
                let middle = all.len() / 2;
                let middle = *all.select_nth_unstable_by(middle, f64::total_cmp).1;
                *origin = middle - 0.5 * MOST_CELLS / inverse_edge;
            }
        }
        Self { origin, high, inverse_edge }
    }

    fn key(&self, position: &[f64; 3], dimension: usize) -> (u32, u32) {
        // A cast saturates: what lies below the first cell is in the first.
        let cell =
            |axis: usize| ((position[axis] - self.origin[axis]) * self.inverse_edge).min(MOST_CELLS) as u32;
        match dimension {
            1 => (0, 0),
            2 => (0, cell(0)),
            _ => (cell(0), cell(1)),
        }
    }
}

/// The lowest and the highest coordinate.
fn bounds(positions: &[[f64; 3]], axis: usize) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let of = |positions: &[[f64; 3]]| {
        positions.iter().fold(none, |(low, high), x| (low.min(x[axis]), high.max(x[axis])))
    };
    positions.par_chunks(TASK).map(of).reduce(|| none, |p, q| (p.0.min(q.0), p.1.max(q.1)))
}

impl Sorted {
    /// Sorts the particles anew, in the memory there is.
    pub(super) fn rebuild(&mut self, points: &Points<'_>, dimension: usize, support: f64, fields: usize) {
        let count = points.positions.len();
        let grid = Grid::new(points, dimension, support);
        let (keys, ids) = number_rows(&grid, points, dimension);
        let (firsts, scattered) = scatter(&ids, keys.len());
        drop(ids);

        self.rows.clear();
        self.rows.extend(keys.iter().enumerate().map(|(r, key)| Row {
            key: *key,
            first: firsts[r],
            end: firsts[r + 1],
            table: 2 * firsts[r] + r as u32,
            ..Row::default()
        }));
        self.order.resize(count, 0);
        self.starts.resize(2 * count + self.rows.len(), 0);
        self.columns.resize_with(dimension + 1 + fields, Vec::new);
        for column in &mut self.columns {
            column.resize(count + PADDING, 0.0);
        }
        let slots = Slots {
            columns: self.columns.iter_mut().map(|column| &mut column[..count]).collect(),
            order: &mut self.order,
            starts: &mut self.starts,
            rows: &mut self.rows,
        };
        slots.fill(points, dimension, &scattered);
    }

    /// The rows that may hold neighbours of particles in `row`, ascending.
    pub(super) fn near(&self, row: usize, found: &mut Vec<u32>) {
        found.clear();
        let (a, b) = self.rows[row].key;
        for a in a.saturating_sub(CELLS)..=a.saturating_add(CELLS) {
            let low = (a, b.saturating_sub(CELLS));
            let from = self.rows.partition_point(|row| row.key < low);
            let near = self.rows[from..].iter().take_while(|row| row.key <= (a, b.saturating_add(CELLS)));
            found.extend((from as u32..).zip(near).map(|(index, _)| index));
        }
    }

    /// The row of the particle at a place.
    pub(super) fn row_at(&self, place: usize) -> usize {
        self.rows.partition_point(|row| row.end as usize <= place)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let columns: usize = self.columns.iter().map(|column| column.capacity() * 8).sum();
        columns
            + 4 * (self.order.capacity() + self.starts.capacity())
            + self.rows.capacity() * size_of::<Row>()
    }
}

/// The keys of the rows that hold particles, ascending, and the row of each particle.
fn number_rows(grid: &Grid, points: &Points<'_>, dimension: usize) -> (Vec<(u32, u32)>, Vec<u32>) {
    let positions = points.positions;
    let key = |x: &[f64; 3]| grid.key(x, dimension);
    let most = grid.key(&grid.high, dimension);
    let width = u64::from(most.1) + 1;
    let cells = (u64::from(most.0) + 1).saturating_mul(width);
    if cells > 2 * positions.len() as u64 + 1024 {
        let mut keys: Vec<(u32, u32)> = positions.par_iter().map(key).collect();
        keys.par_sort_unstable();
        keys.dedup();
        keys.shrink_to_fit();
        let number = |x: &[f64; 3]| {
            let key = key(x);
            keys.partition_point(|known| *known < key) as u32
        };
        let ids = positions.par_iter().map(number).collect();
        return (keys, ids);
    }
    let cell = |x: &[f64; 3]| {
        let (a, b) = key(x);
        (u64::from(a) * width + u64::from(b)) as u32
    };
    let mut ids: Vec<u32> = positions.par_iter().map(cell).collect();
    let mut numbers = vec![0_u32; cells as usize];
    for id in &ids {
        numbers[*id as usize] = 1;
    }
    let mut keys = Vec::new();
    for (cell, number) in numbers.iter_mut().enumerate().filter(|(_, occupied)| **occupied == 1) {
        *number = keys.len() as u32;
        keys.push(((cell as u64 / width) as u32, (cell as u64 % width) as u32));
    }
    ids.par_iter_mut().for_each(|id| *id = numbers[*id as usize]);
    (keys, ids)
}

/// Where each row begins, and the particles row by row.
fn scatter(ids: &[u32], rows: usize) -> (Vec<u32>, Vec<AtomicU32>) {
    let parts = rayon::current_num_threads().clamp(1, 16);
    let part = ids.len().div_ceil(parts).max(1);
    let mut counts: Vec<Vec<u32>> = ids
        .par_chunks(part)
        .map(|ids| {
            let mut counts = vec![0; rows];
            for id in ids {
                counts[*id as usize] += 1;
            }
            counts
        })
        .collect();
    let mut firsts = Vec::with_capacity(rows + 1);
    let mut total = 0;
    for row in 0..rows {
        firsts.push(total);
        for counts in &mut counts {
            total += std::mem::replace(&mut counts[row], total);
        }
    }
    firsts.push(total);
    // Each place is written once; atomics let the parts write side by side without a lock or unsafe code.
    let scattered: Vec<AtomicU32> = ids.iter().map(|_| AtomicU32::new(0)).collect();
    ids.par_chunks(part).zip(counts).enumerate().for_each(|(index, (ids, mut next))| {
        for (particle, id) in (index * part..).zip(ids) {
            let place = &mut next[*id as usize];
            scattered[*place as usize].store(particle as u32, Relaxed);
            *place += 1;
        }
    });
    (firsts, scattered)
}

/// Room for the particles of some rows.
struct Slots<'a> {
    columns: Vec<&'a mut [f64]>,
    order: &'a mut [u32],
    starts: &'a mut [u32],
    rows: &'a mut [Row],
}

/// What sorting a row needs.
#[derive(Default)]
struct Scratch {
    along: Vec<f64>,
    keyed: Vec<(f64, u32)>,
}

impl Slots<'_> {
    fn fill(self, points: &Points<'_>, dimension: usize, scattered: &[AtomicU32]) {
        if self.order.len() <= TASK || self.rows.len() < 2 {
            self.fill_here(points, dimension, scattered);
            return;
        }
        let (first, half) = (self.rows[0].first, self.rows.len() / 2);
        let particles = (self.rows[half].first - first) as usize;
        let (left_columns, right_columns) =
            self.columns.into_iter().map(|column| column.split_at_mut(particles)).unzip();
        let (left_order, right_order) = self.order.split_at_mut(particles);
        let (left_starts, right_starts) = self.starts.split_at_mut(2 * particles + half);
        let (left_rows, right_rows) = self.rows.split_at_mut(half);
        let left = Slots { columns: left_columns, order: left_order, starts: left_starts, rows: left_rows };
        let right =
            Slots { columns: right_columns, order: right_order, starts: right_starts, rows: right_rows };
        rayon::join(|| left.fill(points, dimension, scattered), || right.fill(points, dimension, scattered));
    }

    fn fill_here(mut self, points: &Points<'_>, dimension: usize, scattered: &[AtomicU32]) {
        let mut scratch = Scratch::default();
        let Some(base) = self.rows.first().map(|row| row.first as usize) else { return };
        for (r, row) in self.rows.iter_mut().enumerate() {
            let (first, end) = (row.first as usize, row.end as usize);
            let places = first - base..end - base;
            let starts = &mut self.starts[2 * places.start + r..2 * places.end + r + 1];
            let order = &mut self.order[places.clone()];
            sort_row(row, points, dimension, &scattered[first..end], &mut scratch, order, starts);
            for (index, column) in self.columns.iter_mut().enumerate() {
                let column = &mut column[places.clone()];
                let of = order.iter().map(|particle| *particle as usize);
                match index.checked_sub(dimension) {
                    None => {
                        let values = of.map(|particle| points.positions[particle][index]);
                        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                        for (slot, value) in column.iter_mut().zip(values) {
                            *slot = value;
                            low = low.min(value);
                            high = high.max(value);
                        }
                        (row.low[index], row.high[index]) = (low, high);
                    }
                    Some(0) => copy(column, of.map(|particle| points.weights[particle])),
                    Some(field) => copy(column, of.map(|particle| points.fields[field - 1][particle])),
                }
            }
        }
    }
}

fn copy(column: &mut [f64], values: impl Iterator<Item = f64>) {
    for (slot, value) in column.iter_mut().zip(values) {
        *slot = value;
    }
}

/// Sorts the particles of a row into `order` and enters its columns.
fn sort_row(
    row: &mut Row,
    points: &Points<'_>,
    dimension: usize,
    particles: &[AtomicU32],
    scratch: &mut Scratch,
    order: &mut [u32],
    starts: &mut [u32],
) {
    let axis = dimension - 1;
    let Scratch { along, keyed } = scratch;
    along.clear();
    along.extend(particles.iter().map(|particle| points.positions[particle.load(Relaxed) as usize][axis]));
    let low = along.iter().copied().fold(f64::INFINITY, f64::min);
    let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let columns = 2 * particles.len() as u32;
    let inverse_width = f64::from(columns) / (high - low);
    row.inverse_width = if inverse_width.is_finite() { inverse_width } else { 0.0 };
    (row.low[axis], row.high[axis]) = (low, high);

    let column = |u: f64| (((u - low) * row.inverse_width) as u32).min(columns - 1);
    starts.fill(0);
    for u in along.iter() {
        starts[column(*u) as usize] += 1;
    }
    let (mut total, mut most) = (0, 0);
    for start in starts.iter_mut() {
        most = most.max(*start);
        total += std::mem::replace(start, total);
    }
    keyed.clear();
    keyed.resize(particles.len(), (0.0, 0));
    for (u, particle) in along.iter().zip(particles) {
        let start = &mut starts[column(*u) as usize];
        keyed[*start as usize] = (*u, particle.load(Relaxed));
        *start += 1;
    }
    // Each start has moved on to the next one.
    starts.copy_within(..columns as usize, 1);
    starts[0] = 0;
    for start in starts.iter_mut() {
        *start += row.first;
    }
    let compare = |p: &(f64, u32), q: &(f64, u32)| {
        // Numbers are finite; −0 and 0 are one place.
        let by_place = p.0.partial_cmp(&q.0).unwrap_or(Ordering::Equal);
        by_place.then_with(|| beside(points, dimension, p.1 as usize, q.1 as usize))
    };
    if most > CROWDED {
        keyed.sort_unstable_by(compare);
    } else {
        for at in 1..keyed.len() {
            let mut to = at;
            while to > 0 && compare(&keyed[to], &keyed[to - 1]) == Ordering::Less {
                keyed.swap(to, to - 1);
                to -= 1;
            }
        }
    }
    for (slot, (_, particle)) in order.iter_mut().zip(keyed.iter()) {
        *slot = *particle;
    }
}

/// The order of particles side by side.
fn beside(points: &Points<'_>, dimension: usize, p: usize, q: usize) -> Ordering {
    let of = |particle: usize| {
        let axes = points.positions[particle][..dimension].iter().copied();
        axes.chain([points.weights[particle]]).chain(points.fields.iter().map(move |field| field[particle]))
    };
    of(p).zip(of(q)).map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}
