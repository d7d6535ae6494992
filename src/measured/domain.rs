//! The test domain of Chaussonnet et al. (2015), §II.C: inner particles on which errors are taken, around them outer ones
//! that move as well, around these wall particles that do not; V = 1/ΣW of all of them.
//!
//! Lengths are in metres. The inner particles fill a square or cube of side L with a corner at the origin; outer and wall
//! particles lie around it. (The paper counts both layers into its L, which leaves no inner particle where L < 16 h.)

use super::ProgramError;
use crate::kernel::Kernel;
use crate::particles::{
    Cloud, CloudError, Disorder, Draw, Lattice, Motion, Moves, Neighbour, Neighbours, SampleStream, Site,
    Support,
};
use crate::sums::{Engine, Moment, Points, SumError};
use thiserror::Error;

/// Side of the tiles over which errors are gathered, in Δ: two particles farther apart than 2 R + 2 R share no particle.
const TILE: f64 = 13.0;

/// What can go wrong on a domain.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DomainError {
    /// The particles are no valid cloud.
    #[error("the domain's particles: {0}")]
    Cloud(#[from] CloudError),
    /// Their volumes cannot be summed.
    #[error("the domain's volumes: {0}")]
    Sum(#[from] SumError),
    /// An operator cannot be applied.
    #[error("an operator on the domain: {0}")]
    Program(#[from] ProgramError),
    /// There is nothing to take errors on.
    #[error(
        "a domain of {size:e} m holds no inner particle at Δ = {dx:e} m: choose a larger domain or a smaller h"
    )]
    Empty {
        /// L.
        size: f64,
        /// Δ.
        dx: f64,
    },
}

/// A domain to be laid.
#[derive(Debug, Clone)]
pub struct DomainSpec {
    /// The kernel.
    pub kernel: Kernel,
    /// The lattice.
    pub lattice: Lattice,
    /// How particles leave it.
    pub disorder: Disorder,
    /// h in metres.
    pub h: f64,
    /// h/Δ.
    pub h_over_dx: f64,
    /// Side of the inner region in metres.
    pub size: f64,
    /// Thickness of the outer and of the wall layer, in h.
    pub layer: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A domain whose sites are known.
pub struct Domain {
    spec: DomainSpec,
    motion: Motion,
    dx: f64,
    support: f64,
    /// Of the inner region, in Δ.
    corner: [f64; 3],
    sites: Vec<Site>,
    /// Whether the particle of each site moves.
    moves: Vec<bool>,
    inner: Vec<usize>,
    /// By inner particle.
    tiles: Vec<usize>,
    tile_count: usize,
}

/// A domain with its particles displaced.
pub struct Laid {
    /// All particles, in metres; the corner of the inner region is the origin.
    pub cloud: Cloud,
    /// Pairs that entered the volumes.
    pub pairs: u64,
}

impl Domain {
    /// Finds the sites.
    ///
    /// # Errors
    /// [`DomainError::Empty`].
    pub fn new(spec: DomainSpec) -> Result<Self, DomainError> {
        let dimension = spec.lattice.dimension();
        let dx = spec.h / spec.h_over_dx;
        let support = spec.h * crate::exact::rational_to_f64(spec.kernel.support_over_h());
        let half = 0.5 * spec.size / dx;
        let layer = spec.layer * spec.h_over_dx;
        // The corner stands half-way between two planes of sites, so that none has ξ = 0.
        let units = spec.lattice.axis_units();
        let corner: [f64; 3] = std::array::from_fn(|a| {
            if a < dimension { ((-half / units[a]).floor() + 0.5) * units[a] } else { 0.0 }
        });
        let within = |site: &Site, margin: f64| {
            (0..dimension).all(|a| {
                let x = site.position[a] - corner[a];
                -margin <= x && x < 2.0 * half + margin
            })
        };
        let whole = 2.0 * layer;
        let mut sites = spec.lattice.sites_within((half + whole + 1.0) * (dimension as f64).sqrt());
        sites.retain(|site| within(site, whole));
        let still = spec.disorder.entry().moves == Moves::Nothing;
        let moves = sites.iter().map(|site| !still && within(site, layer)).collect();
        let inner: Vec<usize> = (0..sites.len()).filter(|place| within(&sites[*place], 0.0)).collect();
        if inner.is_empty() {
            return Err(DomainError::Empty { size: spec.size, dx });
        }
        let side = (2.0 * half / TILE).floor().max(1.0);
        let tile = |place: &usize| {
            (0..dimension).rev().fold(0, |tile, a| {
                let x = sites[*place].position[a] - corner[a];
                let along = (x / (2.0 * half) * side).floor().clamp(0.0, side - 1.0);
                tile * side as usize + along as usize
            })
        };
        let tiles = inner.iter().map(tile).collect();
        let tile_count = (side as usize).pow(dimension as u32);
        let motion = spec.disorder.motion();
        Ok(Self { spec, motion, dx, support, corner, sites, moves, inner, tiles, tile_count })
    }

    /// Δ in metres.
    pub fn dx(&self) -> f64 {
        self.dx
    }

    /// R in metres.
    pub fn support(&self) -> f64 {
        self.support
    }

    /// All particles.
    pub fn len(&self) -> usize {
        self.sites.len()
    }

    /// Whether there is no particle; never.
    pub fn is_empty(&self) -> bool {
        self.sites.is_empty()
    }

    /// The inner particles.
    pub fn inner(&self) -> &[usize] {
        &self.inner
    }

    /// By inner particle, the tile it stands in: errors on one tile are gathered, so that their scatter from tile to tile
    /// tells how certain their mean is.
    pub fn tiles(&self) -> &[usize] {
        &self.tiles
    }

    /// How many tiles there are.
    pub fn tile_count(&self) -> usize {
        self.tile_count
    }

    /// Where the unperturbed inner particles stand, in metres.
    pub fn sites(&self) -> impl Iterator<Item = [f64; 3]> {
        self.inner.iter().map(|place| self.place(&self.sites[*place], [0.0; 3]))
    }

    fn place(&self, site: &Site, displacement: [f64; 3]) -> [f64; 3] {
        let dimension = self.spec.lattice.dimension();
        std::array::from_fn(|a| {
            if a < dimension { (site.position[a] - self.corner[a] + displacement[a]) * self.dx } else { 0.0 }
        })
    }

    /// Sample `sample` of the domain.
    ///
    /// # Errors
    /// [`DomainError`].
    pub fn lay(&self, sample: u64) -> Result<Laid, DomainError> {
        let mut stream = SampleStream::new(self.spec.seed, sample);
        let amplitude = self.spec.disorder.amplitude();
        let positions: Vec<[f64; 3]> = self
            .sites
            .iter()
            .zip(&self.moves)
            .map(|(site, moves)| {
                let mut displacement = [0.0; 3];
                if *moves {
                    let mut draw = Draw::new(&self.spec.lattice, site, self.spec.h_over_dx, &mut stream);
                    displacement = (self.motion.unit)(&mut draw).map(|u| amplitude * u);
                }
                self.place(site, displacement)
            })
            .collect();
        let dimension = self.spec.lattice.dimension();
        let mut density =
            Engine::for_moments(&self.spec.kernel, dimension, self.support, &[Moment::default()])?;
        let ones = vec![1.0; positions.len()];
        let mut volumes = vec![0.0; positions.len()];
        let points = Points { positions: &positions, weights: &ones, fields: &[] };
        density.run_with(&points, 1, &mut volumes, |_, sums, volume| volume[0] = 1.0 / sums[0])?;
        let cloud = Cloud::new(dimension, positions, volumes, Support::Uniform(self.support))?;
        Ok(Laid { cloud, pairs: density.pairs() })
    }

    /// d/Δ of all pairs of inner particles and their neighbours that stood nearest on the lattice, each pair from both sides.
    pub fn neighbour_distances(&self, laid: &Laid) -> Result<Vec<f64>, DomainError> {
        let nearest = crate::exact::rational_to_f64(&self.spec.lattice.least_square()).sqrt() * (1.0 + 1e-9);
        let longest = self.motion.longest[self.spec.lattice.dimension() - 1] * self.spec.disorder.amplitude();
        let reach = (nearest + 2.0 * longest + 1e-9) * self.dx;
        let places = laid.cloud.positions();
        let near = Cloud::new(
            laid.cloud.dimension(),
            places.to_vec(),
            laid.cloud.volumes().to_vec(),
            Support::Uniform(reach),
        )?;
        let lists = Neighbours::search_at(&near, &self.inner)?;
        let mut distances = Vec::new();
        for (k, i) in self.inner.iter().enumerate() {
            let here = self.sites[*i].position;
            for Neighbour { j, r_ij } in lists.of(k) {
                let there = self.sites[*j as usize].position;
                let square: f64 = here.iter().zip(there).map(|(x, y)| (x - y) * (x - y)).sum();
                if square > 0.0 && square <= nearest * nearest {
                    let square: f64 = r_ij.iter().map(|x| x * x).sum();
                    distances.push(square.sqrt() / self.dx);
                }
            }
        }
        Ok(distances)
    }
}
