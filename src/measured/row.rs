//! The sum Σ V_b W′(x_a − x_b) on displaced particles of a line, u = 1: the F_a/h of Basa et al. (2009), Eq. (15), measured.
//!
//! Every sample is taken with its displacements d and with −d: the odd part holds the first order in d, the even part the
//! second, each without the other.

use crate::exact::rational_to_f64;
use crate::kernel::{Evaluator, Kernel};
use crate::particles::disorder::Draw;
use crate::particles::{Disorder, Lattice, SampleStream, Site};
use rayon::prelude::*;

/// What V_b is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RowVolumes {
    /// Δ.
    Constant,
    /// 1/ΣW: m/ρ with Eq. (11).
    NumberDensity,
    /// What is nearer to b than to any other particle: the volume whose centroid Eq. (15) speaks of.
    OwnCell,
}

impl RowVolumes {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Constant, Self::NumberDensity, Self::OwnCell];

    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::NumberDensity => "number-density",
            Self::OwnCell => "own-cell",
        }
    }
}

/// Root mean squares over samples, in units of F_a/h.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowErrors {
    /// Of the part odd in d, and its standard error.
    pub odd: [f64; 2],
    /// Of the even part, and its standard error.
    pub even: [f64; 2],
    /// Root mean square distance between a particle and the centroid of its own cell, in Δ.
    pub centroid: f64,
}

/// The errors on a line at this R/Δ, over samples of the disorder.
pub fn row_errors(
    kernel: &Kernel,
    line: &Lattice,
    support: f64,
    volumes: RowVolumes,
    disorder: &Disorder,
    samples: u64,
    seed: u64,
) -> RowErrors {
    // Neighbours of neighbours set the volumes; one more on each side closes the last cell.
    let sites = line.sites_within(2.0 * support + 4.0);
    let h = support / rational_to_f64(kernel.support_over_h());
    let evaluator = Evaluator::<f64>::new(kernel, 1, 1);
    let row = Row { evaluator: &evaluator, sites: &sites, support, volumes };
    let one = |sample: u64| -> [f64; 3] {
        let motion = disorder.motion();
        let mut stream = SampleStream::new(seed, sample);
        let d: Vec<f64> = sites
            .iter()
            .map(|site| disorder.amplitude() * (motion.unit)(&mut Draw::new(line, site, h, &mut stream))[0])
            .collect();
        let (plus, minus) = (h * row.sum(&d, 1.0), h * row.sum(&d, -1.0));
        let offset = row.centroid(&d);
        [0.5 * (plus - minus), 0.5 * (plus + minus), offset * offset]
    };
    let all: Vec<[f64; 3]> = (0..samples).into_par_iter().map(one).collect();
    let part =
        |k: usize| super::pressure::root_mean_square(&all.iter().map(|e| e[k] * e[k]).collect::<Vec<f64>>());
    let centroid = (all.iter().map(|e| e[2]).sum::<f64>() / samples.max(1) as f64).sqrt();
    RowErrors { odd: part(0), even: part(1), centroid }
}

struct Row<'a> {
    evaluator: &'a Evaluator<f64>,
    sites: &'a [Site],
    support: f64,
    volumes: RowVolumes,
}

impl Row<'_> {
    fn place(&self, d: &[f64], sign: f64, b: usize) -> f64 {
        self.sites[b].position[0] + sign * d[b]
    }

    fn centre(&self) -> usize {
        self.sites.iter().position(|site| site.cell == [0; 3]).unwrap_or(0)
    }

    /// Σ_b V_b W′(x_a − x_b) in 1/Δ.
    fn sum(&self, d: &[f64], sign: f64) -> f64 {
        let a = self.place(d, sign, self.centre());
        let mut sum = 0.0;
        for b in 1..self.sites.len() - 1 {
            let x = (a - self.place(d, sign, b)) / self.support;
            if x.abs() < 1.0 {
                let slope = self.evaluator.radial(x.abs())[1] * x / (self.support * self.support);
                sum += self.volume(d, sign, b) * slope;
            }
        }
        sum
    }

    fn volume(&self, d: &[f64], sign: f64, b: usize) -> f64 {
        match self.volumes {
            RowVolumes::Constant => 1.0,
            RowVolumes::OwnCell => 0.5 * (self.place(d, sign, b + 1) - self.place(d, sign, b - 1)).abs(),
            RowVolumes::NumberDensity => {
                let here = self.place(d, sign, b);
                let distance = |c: usize| (here - self.place(d, sign, c)).abs() / self.support;
                let density = (0..self.sites.len()).map(|c| self.evaluator.radial(distance(c))[0]);
                self.support / density.sum::<f64>()
            }
        }
    }

    /// Of the centre: x_a less the centroid of its cell.
    fn centroid(&self, d: &[f64]) -> f64 {
        let a = self.centre();
        0.25 * (2.0 * d[a] - d[a - 1] - d[a + 1])
    }
}
