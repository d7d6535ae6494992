//! Squared errors gathered over the inner particles of domains: their mean, and how certain it is.

use super::domain::{Domain, DomainError, Laid};
use super::program::{Fields, Program};
use crate::particles::Neighbours;
use serde::{Deserialize, Serialize};

/// Lists of neighbours that are held at a time: 8192 in 3-D take some 40 MB.
const LISTS: usize = 8192;

/// ⟨ε⟩ of a squared error ε ≥ 0, over particles and grids.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SquaredError {
    /// Σ ε.
    pub sum: f64,
    /// Particles.
    pub count: u64,
    /// The largest ε.
    pub largest: f64,
    /// Σ over tiles of (Σ ε in the tile)².
    pub tile_square: f64,
    /// Σ over tiles of (Σ ε in the tile) × particles in it.
    pub tile_cross: f64,
    /// Σ over tiles of (particles in it)².
    pub tile_count_square: f64,
    /// Tiles.
    pub tiles: u64,
}

impl SquaredError {
    /// Adds the squared errors of one grid, by inner particle.
    pub fn add(&mut self, domain: &Domain, squares: impl Iterator<Item = f64>) {
        let mut tiles = vec![(0.0, 0.0); domain.tile_count()];
        for (square, tile) in squares.zip(domain.tiles()) {
            self.largest = self.largest.max(square);
            tiles[*tile].0 += square;
            tiles[*tile].1 += 1.0;
        }
        for (sum, count) in tiles.into_iter().filter(|(_, count)| *count > 0.0) {
            self.sum += sum;
            self.count += count as u64;
            self.tile_square += sum * sum;
            self.tile_cross += sum * count;
            self.tile_count_square += count * count;
            self.tiles += 1;
        }
    }

    /// √⟨ε⟩, Eq. (13).
    pub fn rms(&self) -> f64 {
        (self.sum / self.count.max(1) as f64).sqrt()
    }

    /// The standard error of the root mean square, from the scatter of the tiles' sums: that of a ratio of sums.
    pub fn rms_error(&self) -> f64 {
        let (mean, tiles) = (self.sum / self.count.max(1) as f64, self.tiles as f64);
        if self.tiles < 2 || mean == 0.0 {
            return 0.0;
        }
        let scatter = self.tile_square - 2.0 * mean * self.tile_cross + mean * mean * self.tile_count_square;
        let of_mean = (scatter.max(0.0) * tiles / (tiles - 1.0)).sqrt() / self.count as f64;
        0.5 * of_mean / mean.sqrt()
    }
}

/// The values of an operator on a field at the inner particles, component by component.
///
/// # Errors
/// [`DomainError`].
pub fn applied(
    domain: &Domain,
    laid: &Laid,
    requests: &[(&Program, Fields<'_>)],
) -> Result<Vec<Vec<f64>>, DomainError> {
    let mut values = vec![Vec::new(); requests.len()];
    for centres in domain.inner().chunks(LISTS) {
        let lists = Neighbours::search_at(&laid.cloud, centres)?;
        for ((program, field), values) in requests.iter().zip(&mut values) {
            values.extend(program.apply(&laid.cloud, &lists, *field)?);
        }
    }
    Ok(values)
}

/// Mean number of particles in the support of the inner ones, themselves included.
///
/// # Errors
/// [`DomainError`].
pub fn mean_neighbours(domain: &Domain, laid: &Laid) -> Result<f64, DomainError> {
    let mut entries = 0;
    for centres in domain.inner().chunks(LISTS) {
        entries += Neighbours::search_at(&laid.cloud, centres)?.entry_count();
    }
    Ok(entries as f64 / domain.inner().len() as f64)
}
