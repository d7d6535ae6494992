//! Particles in rows of cells, sorted along each row, one column per quantity.
//!
//! The axes but the last are cut into cells of edge R; a cell of these is a row along the last axis. Only rows that hold
//! particles are stored, so an outlier costs one row. In a row the particles stand in ascending order of the last
//! coordinate, then of the others, weight and fields: the order in which they were given does not matter.
//!
//! Particles are dealt out to their rows first, each thread a part of them in the order given; then each row, which now
//! stands together, is sorted by itself. So memory is never read here and there, whatever the order given.

use super::lanes::{larger, smaller};
use super::run::Points;
use super::vector::{Table, shared};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Cells of a row on each side that may hold neighbours.
const CELLS: u32 = 1;

/// How much wider than R a cell is, against rounding of cell numbers up to [`MOST_CELLS`].
const MARGIN: f64 = 1.0 + 1.0 / 65536.0;

/// Cell numbers end here; what lies beyond is in the last cell. Each error of a number is below 2^−20.
const MOST_CELLS: f64 = (1_u64 << 31) as f64;

/// A row with more particles than this in one of its stretches is sorted by comparison.
const CROWDED: u32 = 16;

/// Particles dealt out together, quantity by quantity.
const HAND: usize = 256;

/// Particles of one task.
const TASK: usize = 8192;

/// The particles, sorted.
#[derive(Debug, Default)]
pub(super) struct Sorted {
    /// Coordinates by axis, then weight, then fields.
    pub(super) table: Table,
    /// The particle that stands at each place.
    pub(super) order: Vec<u32>,
    /// By key.
    pub(super) rows: Vec<Row>,
}

/// The particles of one row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Row {
    key: (u32, u32),
    pub(super) first: u32,
    pub(super) end: u32,
    /// Where its particles are, by axis across the rows.
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
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
        positions.iter().fold(none, |(low, high), x| (smaller(low, x[axis]), larger(high, x[axis])))
    };
    positions.par_chunks(TASK).map(of).reduce(|| none, |p, q| (p.0.min(q.0), p.1.max(q.1)))
}

/// How keys of rows are numbered.
enum Numbers {
    /// Every key up to the last: a × width + b.
    All { width: u32, count: u32 },
    /// Those that occur, ascending.
    Some(Vec<(u32, u32)>),
}

impl Numbers {
    fn new(grid: &Grid, points: &Points<'_>, dimension: usize) -> Self {
        let most = grid.key(&grid.high, dimension);
        let width = u64::from(most.1) + 1;
        let cells = (u64::from(most.0) + 1).saturating_mul(width);
        if cells <= points.positions.len() as u64 / 2 + 1024 {
            return Self::All { width: width as u32, count: cells as u32 };
        }
        let mut keys: Vec<(u32, u32)> = points.positions.par_iter().map(|x| grid.key(x, dimension)).collect();
        keys.par_sort_unstable();
        keys.dedup();
        Self::Some(keys)
    }

    fn count(&self) -> usize {
        match self {
            Self::All { count, .. } => *count as usize,
            Self::Some(keys) => keys.len(),
        }
    }

    #[inline]
    fn of(&self, key: (u32, u32)) -> usize {
        match self {
            Self::All { width, .. } => (key.0 * width + key.1) as usize,
            Self::Some(keys) => keys.partition_point(|known| *known < key),
        }
    }

    fn key(&self, number: usize) -> (u32, u32) {
        match self {
            Self::All { width, .. } => (number as u32 / width, number as u32 % width),
            Self::Some(keys) => keys[number],
        }
    }
}

impl Sorted {
    /// Sorts the particles anew, in the memory there is.
    pub(super) fn rebuild(&mut self, points: &Points<'_>, dimension: usize, support: f64) {
        let count = points.positions.len();
        self.order.resize(count, 0);
        self.table.shape(dimension + 1 + points.fields.len(), count);
        let grid = Grid::new(points, dimension, support);
        let numbers = Numbers::new(&grid, points, dimension);
        self.deal(&grid, &numbers, points, dimension);
        let rows = Rows {
            columns: self.table.columns().map(|column| &mut column[..count]).collect(),
            order: &mut self.order,
            rows: &mut self.rows,
        };
        rows.sort(dimension - 1);
    }

    /// Puts each particle into its row, in the order given.
    fn deal(&mut self, grid: &Grid, numbers: &Numbers, points: &Points<'_>, dimension: usize) {
        let number = |x: &[f64; 3]| numbers.of(grid.key(x, dimension));
        let part = points.positions.len().div_ceil(rayon::current_num_threads().clamp(1, 16)).max(1);
        let parts = points.positions.par_chunks(part);
        let count = |positions: &[[f64; 3]]| {
            let mut counts = vec![0_u32; numbers.count()];
            positions.iter().for_each(|x| counts[number(x)] += 1);
            counts
        };
        let mut counts: Vec<Vec<u32>> = parts.clone().map(count).collect();
        self.rows.clear();
        let mut end = 0;
        for row in 0..numbers.count() {
            let first = end;
            for counts in &mut counts {
                end += std::mem::replace(&mut counts[row], end);
            }
            if end > first {
                self.rows.push(Row { key: numbers.key(row), first, end, ..Row::default() });
            }
        }
        // Each place is written once; atomics let the parts write side by side without a lock.
        let ((table, step), order) = (self.table.shared(), shared(&mut self.order));
        parts.zip(counts).enumerate().for_each(|(index, (positions, mut next))| {
            let mut places = [0; HAND];
            for (hand, positions) in positions.chunks(HAND).enumerate() {
                let first = index * part + hand * HAND;
                let particles = first..first + positions.len();
                for (place, x) in places.iter_mut().zip(positions) {
                    let slot = &mut next[number(x)];
                    *place = *slot as usize;
                    *slot += 1;
                }
                let places = &places[..positions.len()];
                for axis in 0..dimension {
                    enter(&table[axis * step..][..step], places, positions.iter().map(|x| x[axis]));
                }
                let others = [points.weights].into_iter().chain(points.fields.iter().copied());
                for (column, values) in (dimension..).zip(others) {
                    enter(&table[column * step..][..step], places, values[particles.clone()].iter().copied());
                }
                for (place, particle) in places.iter().zip(particles) {
                    order[*place].store(particle as u32, Relaxed);
                }
            }
        });
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
        self.table.bytes() + 4 * self.order.capacity() + self.rows.capacity() * size_of::<Row>()
    }
}

/// Enters values into a column at these places.
#[inline]
fn enter(column: &[AtomicU64], places: &[usize], values: impl Iterator<Item = f64>) {
    for (place, value) in places.iter().zip(values) {
        column[*place].store(value.to_bits(), Relaxed);
    }
}

/// Some rows, next to each other.
struct Rows<'a> {
    columns: Vec<&'a mut [f64]>,
    order: &'a mut [u32],
    rows: &'a mut [Row],
}

impl Rows<'_> {
    /// Sorts each row along `axis` and enters where its particles are.
    fn sort(self, axis: usize) {
        if self.order.len() <= TASK || self.rows.len() < 2 {
            self.sort_here(axis);
            return;
        }
        let half = self.rows.len() / 2;
        let particles = (self.rows[half].first - self.rows[0].first) as usize;
        let (left_columns, right_columns) =
            self.columns.into_iter().map(|column| column.split_at_mut(particles)).unzip();
        let (left_order, right_order) = self.order.split_at_mut(particles);
        let (left_rows, right_rows) = self.rows.split_at_mut(half);
        let left = Rows { columns: left_columns, order: left_order, rows: left_rows };
        let right = Rows { columns: right_columns, order: right_order, rows: right_rows };
        rayon::join(|| left.sort(axis), || right.sort(axis));
    }

    fn sort_here(mut self, axis: usize) {
        let Some(base) = self.rows.first().map(|row| row.first) else { return };
        let mut places = Places::default();
        let (mut values, mut particles) = (Vec::new(), Vec::new());
        for row in self.rows.iter_mut() {
            let of_row = (row.first - base) as usize..(row.end - base) as usize;
            let mut columns: Vec<&mut [f64]> =
                self.columns.iter_mut().map(|column| &mut column[of_row.clone()]).collect();
            for (a, column) in columns.iter().enumerate().take(axis) {
                (row.low[a], row.high[a]) = ends(column);
            }
            let compare = |p: usize, q: usize| {
                // Numbers are finite; −0 and 0 are one place.
                let along = columns[axis][p].partial_cmp(&columns[axis][q]).unwrap_or(Ordering::Equal);
                along.then_with(|| {
                    let mut beside = columns.iter().map(|column| column[p].total_cmp(&column[q]));
                    beside.find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
                })
            };
            places.sort(columns[axis], compare);
            for (index, column) in columns.iter_mut().enumerate() {
                if index == axis {
                    column.iter_mut().zip(&places.sorted).for_each(|(slot, (u, _))| *slot = *u);
                } else {
                    permute(column, &places.sorted, &mut values);
                }
            }
            permute(&mut self.order[of_row], &places.sorted, &mut particles);
        }
    }
}

fn permute<T: Copy>(values: &mut [T], places: &[(f64, u32)], copy: &mut Vec<T>) {
    copy.clear();
    copy.extend_from_slice(values);
    for (value, (_, place)) in values.iter_mut().zip(places) {
        *value = copy[*place as usize];
    }
}

/// The lowest and the highest number.
fn ends(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (smaller(low, *u), larger(high, *u)))
}

/// The places of a row's particles, sorted.
#[derive(Default)]
struct Places {
    starts: Vec<u32>,
    sorted: Vec<(f64, u32)>,
}

impl Places {
    /// Sorts by `compare`, which goes by `along` first: into stretches, one for each particle, and then within these.
    fn sort(&mut self, along: &[f64], compare: impl Fn(usize, usize) -> Ordering) {
        let Self { starts, sorted } = self;
        let (low, high) = ends(along);
        let stretches = along.len();
        let scale = stretches as f64 / (high - low);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        let stretch = |u: f64| (((u - low) * scale) as usize).min(stretches - 1);
        starts.clear();
        starts.resize(stretches, 0);
        for u in along {
            starts[stretch(*u)] += 1;
        }
        let (mut total, mut most) = (0, 0);
        for start in starts.iter_mut() {
            most = most.max(*start);
            total += std::mem::replace(start, total);
        }
        sorted.clear();
        sorted.resize(along.len(), (0.0, 0));
        for (place, u) in along.iter().enumerate() {
            let start = &mut starts[stretch(*u)];
            sorted[*start as usize] = (*u, place as u32);
            *start += 1;
        }
        let less = |p: &(f64, u32), q: &(f64, u32)| {
            p.0 < q.0 || p.0 == q.0 && compare(p.1 as usize, q.1 as usize).is_lt()
        };
        if most > CROWDED {
            sorted.sort_unstable_by(|p, q| compare(p.1 as usize, q.1 as usize));
            return;
        }
        for at in 1..sorted.len() {
            let own = sorted[at];
            let mut to = at;
            while to > 0 && less(&own, &sorted[to - 1]) {
                sorted[to] = sorted[to - 1];
                to -= 1;
            }
            sorted[to] = own;
        }
    }
}
