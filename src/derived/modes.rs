//! The displacements of a disorder model as uncorrelated modes: d = m + Σ_v ξ_v v with ⟨ξ_v⟩ = 0 and ⟨ξ_v ξ_w⟩ = δ_vw, so that
//! the covariance of the displacements is Σ_v v v^T. First and second moments are all that a linearised error needs.

use super::DeriveError;
use super::expectation::across;
use super::quadrature::gauss_legendre;
use crate::particles::{Disorder, Lattice, Law, Moves, Site};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A pattern of displacements: sites by their place in the list, each with its displacement in units of Δ.
pub(super) type Mode = Vec<(usize, [f64; 3])>;

/// The displacements of the sites in a list.
pub(super) struct Modes {
    /// ⟨d⟩.
    pub mean: Mode,
    /// Uncorrelated, each of unit variance.
    pub random: Vec<Mode>,
}

impl Modes {
    /// Of the sites around particle i, which stands at `centre` in their list.
    pub(super) fn of(
        disorder: &Disorder,
        lattice: &Lattice,
        sites: &[Site],
        centre: usize,
        h_over_dx: f64,
    ) -> Result<Self, DeriveError> {
        let dimension = lattice.dimension();
        let amplitude = disorder.amplitude();
        let mut modes = Self { mean: Mode::new(), random: Vec::new() };
        let moved: Vec<usize> = match disorder.entry().moves {
            Moves::Nothing => return Ok(modes),
            Moves::CentreOnly => vec![centre],
            Moves::All | Moves::Together => (0..sites.len()).collect(),
        };
        let unit = |axis: usize, length: f64| -> [f64; 3] {
            std::array::from_fn(|a| if a == axis { length } else { 0.0 })
        };
        match disorder.motion().law {
            Law::Independent(shape) => {
                for site in moved {
                    for axis in 0..dimension {
                        let deviation = amplitude * shape.variance(dimension, axis).sqrt();
                        modes.random.push(vec![(site, unit(axis, deviation))]);
                    }
                }
            }
            Law::Wave { wavelength, in_h, along, transverse } => {
                let wavelength = if in_h { wavelength * h_over_dx } else { wavelength };
                // Directions with weights that add up to 1; each with the vectors that e is spread over evenly.
                let farthest = sites.iter().map(|site| length(site.position)).fold(0.0, f64::max);
                let directions = match along {
                    Some(axis) => vec![(unit(axis, 1.0), 1.0)],
                    None => evenly(dimension, 2.0 * farthest / wavelength),
                };
                for (n, weight) in directions {
                    let polarisations = match (transverse, dimension) {
                        (false, _) => vec![n],
                        (true, 2) => vec![[-n[1], n[0], 0.0]],
                        (true, _) => across(n).to_vec(),
                    };
                    // ⟨sin²⟩ = ⟨cos²⟩ = 1/2, and the two are uncorrelated.
                    let scale = amplitude * (0.5 * weight / polarisations.len() as f64).sqrt();
                    for e in polarisations {
                        for quarter in [0.0, 0.25] {
                            let displaced = sites.iter().enumerate().map(|(place, site)| {
                                let path: f64 = n.iter().zip(site.position).map(|(n, x)| n * x).sum();
                                let sine = libm::sin(TAU * (path / wavelength + quarter));
                                (place, e.map(|e| scale * sine * e))
                            });
                            modes.random.push(displaced.collect());
                        }
                    }
                }
            }
            Law::Rows => {
                let mut rows: BTreeMap<i64, Mode> = BTreeMap::new();
                for (place, site) in sites.iter().enumerate() {
                    // ξ is even in [−1/2, 1/2).
                    let row = rows.entry(lattice.row(site.cell, site.basis)).or_default();
                    row.push((place, unit(0, amplitude / 12.0_f64.sqrt())));
                }
                modes.random = rows.into_values().collect();
            }
            Law::AlternateRows => {
                let moves =
                    |site: &&(usize, &Site)| lattice.row(site.1.cell, site.1.basis).rem_euclid(2) == 1;
                let rows: Vec<(usize, &Site)> = sites.iter().enumerate().collect();
                modes.mean =
                    rows.iter().filter(moves).map(|(place, _)| (*place, unit(0, amplitude))).collect();
            }
        }
        Ok(modes)
    }

    /// Sums of all random modes with signs that are as good as uncorrelated, for `count` different choices of them: the
    /// Legendre symbols of a prime, shifted (Paley's construction).
    pub(super) fn signed_sums(&self, count: usize) -> Vec<Mode> {
        // Larger than twice the number of modes that neighbourhoods have, and 3 mod 4.
        const PRIME: u64 = 1_000_003;
        let sign = |mode: usize, choice: usize| {
            let residue = (mode as u64 + 1 + 7919 * choice as u64) % PRIME;
            if legendre(residue, PRIME) { 1.0 } else { -1.0 }
        };
        let sum = |choice: usize| {
            let mut total: BTreeMap<usize, [f64; 3]> = self.mean.iter().copied().collect();
            for (number, mode) in self.random.iter().enumerate() {
                let sign = sign(number, choice);
                for (site, d) in mode {
                    let sum = total.entry(*site).or_insert([0.0; 3]);
                    *sum = std::array::from_fn(|a| sum[a] + sign * d[a]);
                }
            }
            total.into_iter().collect()
        };
        (0..count).map(sum).collect()
    }
}

/// Whether a residue is a square modulo an odd prime (Euler's criterion).
fn legendre(residue: u64, prime: u64) -> bool {
    let (mut power, mut base, mut exponent) = (1, residue % prime, (prime - 1) / 2);
    while exponent > 0 {
        if exponent % 2 == 1 {
            power = power * base % prime;
        }
        base = base * base % prime;
        exponent /= 2;
    }
    power == 1
}

fn length(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Directions of a half of the circle or sphere with weights of sum 1, for a mean over all of them of products of two waves
/// that pass `waves` wavelengths between the farthest sites. n and −n give the same mode.
fn evenly(dimension: usize, waves: f64) -> Vec<([f64; 3], f64)> {
    // The products are band-limited to 2π·waves and fall off beyond it faster than any power.
    let count = (TAU * waves).ceil() as usize + 24;
    match dimension {
        1 => vec![([1.0, 0.0, 0.0], 1.0)],
        2 => {
            let direction = |n: usize| {
                let (sine, cosine) = libm::sincos(0.5 * TAU * n as f64 / count as f64);
                ([cosine, sine, 0.0], 1.0 / count as f64)
            };
            (0..count).map(direction).collect()
        }
        _ => {
            let mut directions = Vec::new();
            for (z, weight) in gauss_legendre(count).iter() {
                for n in 0..count {
                    let (sine, cosine) = libm::sincos(0.5 * TAU * n as f64 / count as f64);
                    let rho = (1.0 - z * z).sqrt();
                    directions.push(([rho * cosine, rho * sine, z], 0.5 * weight / count as f64));
                }
            }
            directions
        }
    }
}
