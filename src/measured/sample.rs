//! Moment sums on disordered particles: samples in blocks.
//!
//! A neighbourhood of particle i is laid on the lattice, displaced, and summed; the statistic of a moment S is the
//! Frobenius norm |S − S^reg|, in units of h. Sample n is a pure function of (seed, n, lattice site): R does not change it,
//! nor does the number of threads.

use super::coefficient::{
    Patch, coefficients, kernel_of_centre, made_ready, norm as coefficient_norm, target_components,
};
use super::stencil::StencilError;
use crate::exact::rational_to_f64;
use crate::kernel::{Evaluator, Kernel};
use crate::language::Subject;
use crate::particles::{
    Cloud, CloudError, Disorder, Draw, Lattice, Motion, Moves, Neighbours, SampleStream, Site, Support,
    VolumeRule,
};
use crate::sums::{Moment, PairSums};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Particles closer than this, in Δ, count as one place.
pub const CLOSEST: f64 = 1e-12;

/// What can go wrong while sampling.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The neighbourhood is no valid cloud.
    #[error("sample {sample}: {source}")]
    Cloud {
        /// Which sample.
        sample: u64,
        /// What is wrong with it.
        source: CloudError,
    },
    /// An operator has no stencil there.
    #[error("sample {sample}: {source}")]
    Stencil {
        /// Which sample.
        sample: u64,
        /// Why.
        source: StencilError,
    },
}

/// What to sample.
#[derive(Debug, Clone)]
pub struct SampleSpec {
    /// The kernel.
    pub kernel: Kernel,
    /// The lattice.
    pub lattice: Lattice,
    /// The disorder model; its own amplitude is not used, `amplitude` is.
    pub disorder: Disorder,
    /// Amplitude of the displacements, in the units of the model and of Δ.
    pub amplitude: f64,
    /// R/Δ.
    pub support_over_dx: f64,
    /// Which volumes.
    pub rule: VolumeRule,
    /// Moment sums and coefficients of operators, sorted.
    pub subjects: Vec<Subject>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Statistics of one subject over a block of samples; all in units of h.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct MomentStatistics {
    /// Σ |S − S^reg|².
    pub sum_square: f64,
    /// Σ |S − S^reg|⁴.
    pub sum_fourth: f64,
    /// Σ |S − S^reg|.
    pub sum: f64,
    /// max |S − S^reg|.
    pub max: f64,
}

/// One block of samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SampleBlock {
    /// How many samples.
    pub samples: u64,
    /// How many of them had particles closer than [`CLOSEST`] Δ and were not evaluated.
    pub degenerate: u64,
    /// Kernel evaluations.
    pub pairs: u64,
    /// By subject, in the order of the request.
    pub moments: Vec<MomentStatistics>,
}

/// A neighbourhood made ready for sampling.
pub struct Sampler {
    spec: SampleSpec,
    moves: Moves,
    motion: Motion,
    /// h/Δ.
    h_over_dx: f64,
    sites: Vec<Site>,
    sums: PairSums<f64>,
    density: PairSums<f64>,
    /// For coefficients of operators, and h/R.
    evaluator: (Evaluator<f64>, f64),
    /// ω R^{-D} of the constant rule.
    weight: f64,
    /// S^reg in units of R: the components of the moments, then those of each coefficient.
    regular: Vec<f64>,
    /// κ^{p−q}: from units of R to units of h.
    to_h: Vec<f64>,
    /// Bound of what rounding does to each moment, in units of h.
    floors: Vec<f64>,
}

/// How many rounding errors of a sum's own magnitude count as its floor: the error of adding n ≤ 10⁵ terms in eight
/// lanes behaves like √(n/8) ε ≲ 112 ε, of which a random walk reaches a fraction.
pub(super) const FLOOR_FACTOR: f64 = 64.0;

/// How far from i, in Δ, lattice sites are laid when no particle moves by more than `longest` Δ: neighbours of i after
/// both moved; with number-density volumes the neighbours of these as well.
pub fn neighbourhood_radius(rule: VolumeRule, support_over_dx: f64, longest: f64) -> f64 {
    match rule {
        VolumeRule::Constant => support_over_dx + 2.0 * longest,
        VolumeRule::NumberDensity => 2.0 * support_over_dx + 4.0 * longest,
    }
}

impl Sampler {
    /// Lays the neighbourhood and takes the regular sums.
    ///
    /// # Errors
    /// As [`Sampler::block`].
    pub fn new(spec: SampleSpec) -> Result<Self, SampleError> {
        let dimension = spec.lattice.dimension();
        let (moves, motion) = (spec.disorder.entry().moves, spec.disorder.motion());
        let longest = motion.longest[dimension - 1] * spec.amplitude;
        let sites = spec.lattice.sites_within(neighbourhood_radius(spec.rule, spec.support_over_dx, longest));
        let moments: Vec<Moment> = spec.subjects.iter().filter_map(Subject::moment).collect();
        let sums = PairSums::new(&spec.kernel, dimension, &moments);
        let density = PairSums::new(&spec.kernel, dimension, &[Moment::default()]);
        let volume = spec.lattice.particle_volume().enclose(96).midpoint_f64();
        let kappa = rational_to_f64(spec.kernel.support_over_h());
        let to_h = spec.subjects.iter().map(|subject| kappa.powi(subject.length_power())).collect();
        let evaluator = made_ready(&spec.kernel, dimension);
        let weight = volume / power(spec.support_over_dx, dimension);
        let h_over_dx = spec.support_over_dx / kappa;
        let mut sampler = Self {
            spec,
            moves,
            motion,
            h_over_dx,
            sites,
            sums,
            density,
            evaluator,
            weight,
            regular: Vec::new(),
            to_h,
            floors: Vec::new(),
        };
        let still: Vec<[f64; 3]> = sampler.sites.iter().map(|site| site.position).collect();
        if let Neighbourhood::Sums(regular, _) = sampler.evaluate(&still, 0)? {
            sampler.regular = regular;
        }
        let magnitudes = sampler.magnitudes(&still)?;
        sampler.floors = magnitudes.iter().map(|m| FLOOR_FACTOR * f64::EPSILON * m).collect();
        Ok(sampler)
    }

    /// Round-off floor of |S − S^reg| by moment, in units of h.
    pub fn floors(&self) -> &[f64] {
        &self.floors
    }

    /// How many sites a sample displaces.
    pub fn sites(&self) -> usize {
        self.sites.len()
    }

    /// Evaluates the samples `first` … `first + count − 1`.
    ///
    /// # Errors
    /// [`SampleError::Cloud`] if the neighbourhood cannot be searched.
    pub fn block(&self, first: u64, count: u64) -> Result<SampleBlock, SampleError> {
        let evaluated: Vec<Neighbourhood> = (first..first + count)
            .into_par_iter()
            .map(|sample| self.evaluate(&self.displaced(sample), sample))
            .collect::<Result<_, _>>()?;
        let mut block = SampleBlock {
            samples: count,
            degenerate: 0,
            pairs: 0,
            moments: vec![MomentStatistics::default(); self.spec.subjects.len()],
        };
        for neighbourhood in evaluated {
            let Neighbourhood::Sums(components, pairs) = neighbourhood else {
                block.degenerate += 1;
                continue;
            };
            block.pairs += pairs;
            let deviation: Vec<f64> = components.iter().zip(&self.regular).map(|(s, reg)| s - reg).collect();
            for (index, statistics) in block.moments.iter_mut().enumerate() {
                let norm = self.norm(index, &deviation) * self.to_h[index];
                let square = norm * norm;
                statistics.sum_square += square;
                statistics.sum_fourth += square * square;
                statistics.sum += norm;
                statistics.max = statistics.max.max(norm);
            }
        }
        Ok(block)
    }

    /// The components of every subject in one sample, in units of R, limits and targets not taken off; `None` if two
    /// particles coincide.
    ///
    /// # Errors
    /// As [`Sampler::block`].
    pub fn values(&self, sample: u64) -> Result<Option<Vec<f64>>, SampleError> {
        Ok(match self.evaluate(&self.displaced(sample), sample)? {
            Neighbourhood::Sums(components, _) => Some(components),
            Neighbourhood::Degenerate => None,
        })
    }

    fn displaced(&self, sample: u64) -> Vec<[f64; 3]> {
        let mut stream = SampleStream::new(self.spec.seed, sample);
        self.sites
            .iter()
            .map(|site| {
                let centre = site.cell == [0; 3] && site.basis == 0;
                if self.moves == Moves::Nothing || (self.moves == Moves::CentreOnly && !centre) {
                    return site.position;
                }
                let mut draw = Draw::new(&self.spec.lattice, site, self.h_over_dx, &mut stream);
                let unit = (self.motion.unit)(&mut draw);
                std::array::from_fn(|a| site.position[a] + self.spec.amplitude * unit[a])
            })
            .collect()
    }

    /// The moments at the centre particle of a neighbourhood.
    fn evaluate(&self, positions: &[[f64; 3]], sample: u64) -> Result<Neighbourhood, SampleError> {
        let Some(centre) = self.sites.iter().position(|site| site.cell == [0; 3] && site.basis == 0) else {
            return Ok(Neighbourhood::Degenerate);
        };
        let radius = self.spec.support_over_dx;
        let mut pairs = Vec::with_capacity(positions.len());
        for (j, position) in positions.iter().enumerate() {
            let r_ij: [f64; 3] = std::array::from_fn(|a| positions[centre][a] - position[a]);
            let square = r_ij[0] * r_ij[0] + r_ij[1] * r_ij[1] + r_ij[2] * r_ij[2];
            if square < radius * radius {
                if square < CLOSEST * CLOSEST && j != centre {
                    return Ok(Neighbourhood::Degenerate);
                }
                pairs.push((j, r_ij));
            }
        }
        let weights: Vec<f64> = match self.spec.rule {
            VolumeRule::Constant => vec![self.weight; pairs.len()],
            VolumeRule::NumberDensity => {
                let centres: Vec<usize> = pairs.iter().map(|(j, _)| *j).collect();
                match self.number_density(positions, &centres, sample)? {
                    Some(weights) => weights,
                    None => return Ok(Neighbourhood::Degenerate),
                }
            }
        };
        let mut sums = self.sums.start();
        for ((_, r_ij), weight) in pairs.iter().zip(&weights) {
            self.sums.add(&mut sums, r_ij.map(|x| x / radius), *weight);
        }
        let (mut components, count) = self.sums.finish(sums);
        if self.sums.moments().len() == self.spec.subjects.len() {
            return Ok(Neighbourhood::Sums(components, count));
        }
        let patch = self.patch(&pairs, &weights);
        let fault = |source| SampleError::Stencil { sample, source };
        for (own, _) in coefficients(&self.spec.subjects, &patch).map_err(fault)? {
            components.extend(own);
        }
        Ok(Neighbourhood::Sums(components, count))
    }

    /// The neighbours of i with their volumes, as operators see them. Particles are numbered by their place in the list.
    fn patch(&self, pairs: &[(usize, [f64; 3])], weights: &[f64]) -> Patch<'_> {
        let radius = self.spec.support_over_dx;
        let centre = pairs.iter().position(|(_, r)| r.iter().all(|x| *x == 0.0)).unwrap_or(0);
        let own = pairs.iter().enumerate().map(|(place, (_, r))| (place, r.map(|x| x / radius)));
        let of_centre: Vec<(usize, [f64; 3])> = own.collect();
        Patch {
            dimension: self.spec.lattice.dimension(),
            evaluator: &self.evaluator.0,
            h: self.evaluator.1,
            centre,
            kernel_of_centre: kernel_of_centre(&self.evaluator.0, &of_centre, of_centre.len()),
            of_centre,
            volumes: weights.to_vec(),
            places: Vec::new(),
        }
    }

    /// The norm of a subject from the components of all.
    fn norm(&self, subject: usize, components: &[f64]) -> f64 {
        let moments = self.sums.moments().len();
        if subject < moments {
            return self.sums.frobenius(subject, components);
        }
        let dimension = self.spec.lattice.dimension();
        let mut from = self.sums.components();
        for (place, coefficient) in self.spec.subjects.iter().filter_map(Subject::coefficient).enumerate() {
            let size = target_components(coefficient, dimension).len();
            if moments + place == subject {
                return coefficient_norm(coefficient, dimension, &components[from..from + size]);
            }
            from += size;
        }
        0.0
    }

    /// V_j R^{-D} = 1 / Σ_k F(|r_jk|/R) for the particles at `centres`; `None` if two particles coincide.
    fn number_density(
        &self,
        positions: &[[f64; 3]],
        centres: &[usize],
        sample: u64,
    ) -> Result<Option<Vec<f64>>, SampleError> {
        let radius = self.spec.support_over_dx;
        let fault = |source| SampleError::Cloud { sample, source };
        let dimension = self.spec.lattice.dimension();
        let volumes = vec![1.0; positions.len()];
        let cloud =
            Cloud::new(dimension, positions.to_vec(), volumes, Support::Uniform(radius)).map_err(fault)?;
        let lists = Neighbours::search_at(&cloud, centres).map_err(fault)?;
        let mut weights = Vec::with_capacity(centres.len());
        for (k, centre) in centres.iter().enumerate() {
            let mut sums = self.density.start();
            for neighbour in lists.of(k) {
                let r = neighbour.r_ij;
                let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
                if square < CLOSEST * CLOSEST && neighbour.j as usize != *centre {
                    return Ok(None);
                }
                self.density.add(&mut sums, r.map(|x| x / radius), 1.0);
            }
            weights.push(1.0 / self.density.finish(sums).0[0]);
        }
        Ok(Some(weights))
    }

    /// Σ over the pairs of the norm of each moment's summand: what rounding errors are relative to.
    fn magnitudes(&self, positions: &[[f64; 3]]) -> Result<Vec<f64>, SampleError> {
        let radius = self.spec.support_over_dx;
        let mut magnitudes = vec![0.0; self.sums.moments().len()];
        for position in positions {
            let mut one = self.sums.start();
            self.sums.add(&mut one, position.map(|x| -x / radius), self.weight);
            let components = self.sums.finish(one).0;
            for (index, magnitude) in magnitudes.iter_mut().enumerate() {
                *magnitude += self.sums.frobenius(index, &components) * self.to_h[index];
            }
        }
        let inside = positions.iter().filter(|x| x.iter().map(|x| x * x).sum::<f64>() < radius * radius);
        let pairs: Vec<(usize, [f64; 3])> = inside.map(|x| (0, x.map(|x| 0.0 - x))).collect();
        let patch = self.patch(&pairs, &vec![self.weight; pairs.len()]);
        let fault = |source| SampleError::Stencil { sample: 0, source };
        for (_, magnitude) in coefficients(&self.spec.subjects, &patch).map_err(fault)? {
            magnitudes.push(magnitude * self.to_h[magnitudes.len()]);
        }
        Ok(magnitudes)
    }
}

enum Neighbourhood {
    /// Components in units of R, and pairs evaluated.
    Sums(Vec<f64>, u64),
    /// Two particles in one place.
    Degenerate,
}

fn power(base: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

/// Statistics over completed blocks, in their order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Samples evaluated.
    pub samples: u64,
    /// √⟨|S − S^reg|²⟩.
    pub rms: f64,
    /// Standard error of `rms`.
    pub rms_error: f64,
    /// ⟨|S − S^reg|⟩.
    pub mean: f64,
    /// max |S − S^reg|.
    pub max: f64,
}

/// Summary of one moment over blocks.
pub fn summarise(blocks: &[SampleBlock], moment: usize) -> Summary {
    let samples: u64 = blocks.iter().map(|block| block.samples - block.degenerate).sum();
    let n = samples as f64;
    let add =
        |field: fn(&MomentStatistics) -> f64| blocks.iter().map(|b| field(&b.moments[moment])).sum::<f64>();
    if samples == 0 {
        return Summary { samples, rms: 0.0, rms_error: 0.0, mean: 0.0, max: 0.0 };
    }
    let mean_square = add(|m| m.sum_square) / n;
    let variance = (add(|m| m.sum_fourth) / n - mean_square * mean_square).max(0.0);
    let rms = mean_square.sqrt();
    // δ(√m) = δm / (2 √m), δm² = variance / (n − 1).
    let rms_error = if rms > 0.0 && samples > 1 { (variance / (n - 1.0)).sqrt() / (2.0 * rms) } else { 0.0 };
    let max = blocks.iter().map(|b| b.moments[moment].max).fold(0.0, f64::max);
    Summary { samples, rms, rms_error, mean: add(|m| m.sum) / n, max }
}

/// Whether the blocks completed so far reach the wanted relative precision of every moment's RMS. A function of the
/// completed blocks alone, so that resumed, sharded and threaded runs stop at the same block.
pub fn is_precise(blocks: &[SampleBlock], precision: f64) -> bool {
    let moments = blocks.first().map_or(0, |block| block.moments.len());
    (0..moments).all(|moment| {
        let summary = summarise(blocks, moment);
        summary.rms_error <= precision * summary.rms
    })
}
