//! The engine: checks, blocks of particles, threads.

use super::arithmetic::{BATCH, Scratch, Task};
use super::radial::Radial;
use super::request::{Plan, RadialSum};
use super::sorted::Sorted;
use super::vector::{Path, block, write_rows};
use crate::kernel::Kernel;
use crate::particles::LENGTH_LIMIT;
use crate::sums::{Moment, SumError};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Particles of one task: enough to outweigh its start, few enough to share among threads.
const STRETCH: usize = 512;

/// Places in arrays and tables are 32-bit numbers.
const MOST_PARTICLES: usize = 1 << 30;

/// The particles of a cloud, by reference.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    /// x, y, z in one unit of length; axes beyond D are not read.
    pub positions: &'a [[f64; 3]],
    /// ω_j, of any sign.
    pub weights: &'a [f64],
    /// Values at the particles.
    pub fields: &'a [&'a [f64]],
}

/// The particle i of some sums, with its own quantities: they are read where the engine has them side by side, which is
/// not where the caller keeps them.
#[derive(Debug, Clone, Copy)]
pub struct Centre<'a> {
    sorted: &'a Sorted,
    dimension: usize,
    place: usize,
    index: usize,
}

impl Centre<'_> {
    /// Its place among the particles given.
    pub fn index(&self) -> usize {
        self.index
    }

    /// A coordinate.
    ///
    /// # Panics
    /// If there is no such axis.
    #[inline]
    pub fn position(&self, axis: usize) -> f64 {
        assert!(axis < self.dimension, "no such axis");
        self.sorted.table.column(axis)[self.place]
    }

    /// ω_i.
    #[inline]
    pub fn weight(&self) -> f64 {
        self.sorted.table.column(self.dimension)[self.place]
    }

    /// Value of a field that the sums name.
    ///
    /// # Panics
    /// If none of them names this field or a later one.
    #[inline]
    pub fn field(&self, field: usize) -> f64 {
        self.sorted.table.column(self.dimension + 1 + field)[self.place]
    }
}

/// Sums over all neighbours of all particles, r_ij · r_ij < R² as evaluated in f64, i included, no axis periodic.
///
/// Results are in the units of positions and weights: a moment sum with constant weights ω = Δ^D is the one of a paper.
///
/// # Examples
/// ```
/// use remainder::kernel::by_id;
/// use remainder::sums::{Engine, Moment, Points};
///
/// let positions: Vec<[f64; 3]> = (0..100).map(|i| [0.01 * f64::from(i), 0.0, 0.0]).collect();
/// let weights = vec![0.01; 100];
/// let kernel = by_id("wendland-c2").unwrap();
/// let mut engine = Engine::for_moments(&kernel, 1, 0.05, &[Moment::default()]).unwrap();
/// let points = Points { positions: &positions, weights: &weights, fields: &[] };
/// let mut sums = vec![0.0; 100 * engine.columns()];
/// engine.run(&points, &mut sums).unwrap();
/// assert!((sums[50] - 1.0).abs() < 1e-3 && sums[0] < 0.9);
/// ```
#[derive(Debug)]
pub struct Engine {
    dimension: usize,
    support: f64,
    plan: Plan,
    radial: Radial,
    path: Path,
    sorted: Sorted,
    pairs: u64,
}

impl Engine {
    /// For moment sums: their components in order, one column each.
    ///
    /// # Errors
    /// [`SumError::Dimension`], [`SumError::SupportLength`].
    pub fn for_moments(
        kernel: &Kernel,
        dimension: usize,
        support: f64,
        moments: &[Moment],
    ) -> Result<Self, SumError> {
        check(dimension, support)?;
        let plan = Plan::of_moments(dimension, moments);
        Ok(Self::new(kernel, dimension, support, plan))
    }

    /// For sums of r^{⊗p} G_k, with or without the difference of a field: their components in order, one column each.
    ///
    /// # Errors
    /// As [`Engine::for_moments`], and [`SumError::Moment`] beyond p = 8 or k = 2.
    pub fn for_radial_sums(
        kernel: &Kernel,
        dimension: usize,
        support: f64,
        wanted: &[RadialSum],
    ) -> Result<Self, SumError> {
        check(dimension, support)?;
        let plan = Plan::of_radial(dimension, wanted)?;
        Ok(Self::new(kernel, dimension, support, plan))
    }

    fn new(kernel: &Kernel, dimension: usize, support: f64, plan: Plan) -> Self {
        let order = plan.radials.iter().rposition(|wanted| *wanted).unwrap_or(0);
        let radial = Radial::new(kernel, dimension, order, |k| unit(dimension, support, k));
        Self { dimension, support, plan, radial, path: Path::best(), sorted: Sorted::default(), pairs: 0 }
    }

    /// The same on another path. One that this machine does not have is replaced by the portable one; the bits are the same.
    #[must_use]
    pub fn on_path(self, path: Path) -> Self {
        Self { path: if path.is_available() { path } else { Path::Portable }, ..self }
    }

    /// The path taken.
    pub fn path(&self) -> Path {
        self.path
    }

    /// Number of sums for each particle.
    pub fn columns(&self) -> usize {
        self.plan.columns.len()
    }

    /// Pairs (i, j) of the last run, (i, i) included.
    pub fn pairs(&self) -> u64 {
        self.pairs
    }

    /// Bytes that are kept from run to run: the sorted copy of the particles, and where to find them.
    pub fn bytes(&self) -> usize {
        self.sorted.bytes()
    }

    /// All sums of all particles: `out` has a row of [`Engine::columns`] numbers for each, in the order of the particles.
    /// Uses the threads of the pool it is called in.
    ///
    /// # Errors
    /// [`SumError::NotFinite`] and [`SumError::Length`] name what is at fault, [`SumError::TooManyParticles`].
    pub fn run(&mut self, points: &Points<'_>, out: &mut [f64]) -> Result<(), SumError> {
        let width = self.columns();
        self.run_with(points, width, out, |_, sums, row| row.copy_from_slice(sums))
    }

    /// As [`Engine::run`], but each row, of `width` numbers, is made of the sums of its particle by
    /// `finish(centre, sums, row)`.
    ///
    /// # Errors
    /// As [`Engine::run`].
    pub fn run_with(
        &mut self,
        points: &Points<'_>,
        width: usize,
        out: &mut [f64],
        finish: impl Fn(Centre<'_>, &[f64], &mut [f64]) + Sync + Send,
    ) -> Result<(), SumError> {
        self.check_points(points, width, out)?;
        let points = Points { fields: &points.fields[..self.plan.fields], ..*points };
        self.sorted.rebuild(&points, self.dimension, self.support);
        self.pairs = self.sums(width, out, &finish);
        Ok(())
    }

    fn sums(
        &self,
        width: usize,
        out: &mut [f64],
        finish: &(impl Fn(Centre<'_>, &[f64], &mut [f64]) + Sync + Send),
    ) -> u64 {
        let dimension = self.dimension;
        let (sorted, plan) = (&self.sorted, &self.plan);
        let task = Task { sorted, plan, radial: &self.radial, support: self.support };
        let pairs = AtomicU64::new(0);
        let start = || (Scratch::new(plan, dimension), vec![0.0; plan.columns.len()]);
        write_rows(&sorted.order, out, width, STRETCH, start, |(scratch, columns), places, rows| {
            let mut last = places.start;
            block(dimension, self.path, &task, places, scratch, &mut |first, count, scratch| {
                while last < first + 3 * BATCH {
                    rows.fetch(last);
                    last += 1;
                }
                for particle in 0..count {
                    let mut sums = scratch.sums(particle);
                    if plan.plain {
                        sums = &sums[..columns.len()];
                    } else {
                        plan.combine(sums, columns);
                        sums = columns;
                    }
                    let place = first + particle;
                    let (index, row) = rows.row(place);
                    finish(Centre { sorted, dimension, place, index }, sums, row);
                }
            });
            pairs.fetch_add(std::mem::take(&mut scratch.pairs), Relaxed);
        });
        pairs.into_inner()
    }

    fn check_points(&self, points: &Points<'_>, width: usize, out: &[f64]) -> Result<(), SumError> {
        let count = points.positions.len();
        if count > MOST_PARTICLES {
            return Err(SumError::TooManyParticles { found: count, most: MOST_PARTICLES });
        }
        let length = |what: &str, found: usize, expected: usize| {
            let what = what.to_owned();
            if found == expected { Ok(()) } else { Err(SumError::Length { what, found, expected }) }
        };
        length("weights", points.weights.len(), count)?;
        length("results", out.len(), count * width)?;
        if points.fields.len() < self.plan.fields {
            return length("fields", points.fields.len(), self.plan.fields);
        }
        let out_of_range = |x: f64| x.is_nan() || x.abs() > LENGTH_LIMIT;
        let bad = |x: &[f64; 3]| x[..self.dimension].iter().fold(false, |bad, x| bad | out_of_range(*x));
        if let Some(particle) = first(points.positions, bad) {
            let place = points.positions[particle];
            let axis = (0..self.dimension).find(|axis| out_of_range(place[*axis])).unwrap_or(0);
            let what = format!("{} coordinate", ["x", "y", "z"][axis]);
            return Err(SumError::NotFinite { what, particle, value: place[axis] });
        }
        let finite = |what: &dyn Fn() -> String, values: &[f64]| {
            first(values, |value| !value.is_finite()).map_or(Ok(()), |particle| {
                Err(SumError::NotFinite { what: what(), particle, value: values[particle] })
            })
        };
        finite(&|| "weight".to_owned(), points.weights)?;
        for (index, field) in points.fields.iter().enumerate().take(self.plan.fields) {
            length(&format!("values of field {index}"), field.len(), count)?;
            finite(&|| format!("value of field {index}"), field)?;
        }
        Ok(())
    }
}

/// The first value that is bad, which hardly ever is there: whole chunks are tested at a time.
fn first<T: Sync>(values: &[T], bad: impl Fn(&T) -> bool + Sync + Send) -> Option<usize> {
    const CHUNK: usize = 4096;
    let chunk =
        values.par_chunks(CHUNK).position_first(|chunk| chunk.iter().fold(false, |any, x| any | bad(x)))?;
    let within = values[chunk * CHUNK..].iter().position(bad)?;
    Some(chunk * CHUNK + within)
}

fn check(dimension: usize, support: f64) -> Result<(), SumError> {
    if !(1..=3).contains(&dimension) {
        return Err(SumError::Dimension { found: dimension });
    }
    if !(LENGTH_LIMIT.recip()..=LENGTH_LIMIT).contains(&support) {
        return Err(SumError::SupportLength { found: support });
    }
    Ok(())
}

/// The unit of G_k, R^{−D−2k}.
fn unit(dimension: usize, support: f64, k: usize) -> f64 {
    (0..dimension + 2 * k).fold(1.0, |unit, _| unit / support)
}
