//! Mean and variance of a moment sum over the whole law of the displacements, by quadrature; volumes constant.
//!
//! S = ω Σ_j f(x_ij + d_i − d_j), f = r^{⊗p} ∇^q W, with f(0) for j = i, which carries itself along. The displacement of particle i
//! stands in all terms; given it, those of independent particles are independent:
//!
//! ⟨S⟩ = ⟨M(d_i)⟩, Var S = ⟨V(d_i)⟩ + Var M(d_i), M = ω Σ_j ⟨f⟩_j, V = ω² Σ_j (⟨f²⟩_j − ⟨f⟩_j²).
//!
//! Sites out to R + 2 d_max enter. Rows that slide as a whole stand in place of the particles j; under a wave all follows
//! from its phase. Where a particle crosses a knot of the kernel, its integral is split. The order of the quadrature is raised
//! until the result settles; the radius is four times the last change, an estimate and no proof.

use super::DeriveError;
use super::expectation::{Expectation, Node, polarisations};
use super::rms::{ComponentError, Model, RmsError, Setting, moment_components};
use crate::exact::rational_to_f64;
use crate::kernel::Evaluator;
use crate::particles::{Law, Moves, PointGroup, Site, VolumeRule};
use crate::sums::{Component, Moment};
use rayon::prelude::*;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering};

/// Terms of summands that one level of refinement may take: about half a second on one core.
const MOST_TERMS: f64 = 5e7;
/// Levels of refinement.
const MOST_LEVELS: usize = 12;
/// A change by less than this, relative to the root mean square, ends the refinement.
const SETTLED: f64 = 1e-10;

/// What the centre's chance decides: everything else is independent given it.
#[derive(Clone, Copy)]
enum Given {
    /// Nothing is left to chance.
    Nothing,
    /// The displacement of particle i.
    Centre([f64; 3]),
    /// Phase, direction and displacement of a wave.
    Wave { phase: f64, n: [f64; 3], e: [f64; 3] },
    /// How far the row of particle i has slid.
    Row(f64),
}

/// Mean and variance by component.
type Moments = Vec<[f64; 2]>;

/// The RMS distance of a moment sum from its continuum limit over the whole law of the displacements.
///
/// # Errors
/// [`DeriveError::Finite`] with volumes other than constant.
pub fn finite(setting: &Setting<'_>, moment: Moment) -> Result<RmsError, DeriveError> {
    if setting.rule != VolumeRule::Constant {
        return Err(DeriveError::Finite { what: "volumes that follow the density" });
    }
    let sum = Sum::new(setting, moment);
    let still = sum.given(Given::Nothing, 0, &[], true);
    let mut components = moment_components(moment, setting.kernel, sum.dimension, sum.h);
    for (component, [regular, _]) in components.iter_mut().zip(&still) {
        component.regular = regular - component.limit;
    }
    let mut radius = 0.0;
    let mut last: Option<f64> = None;
    for level in 0..MOST_LEVELS {
        // What the level before took, and how much more there is to do.
        let taken = sum.taken.swap(0, Ordering::Relaxed) as f64;
        if level > 1 && taken * sum.cost(level) / sum.cost(level - 1) > MOST_TERMS {
            break;
        }
        for (component, [mean, variance]) in components.iter_mut().zip(sum.expected(level)) {
            component.mean = mean - component.limit;
            component.variance = variance;
            component.mean_square = component.mean * component.mean + variance;
        }
        let rms = norm(&components);
        if let Some(last) = last {
            radius = 4.0 * (rms - last).abs() + 256.0 * f64::EPSILON * (rms + sum.size);
            if (rms - last).abs() <= SETTLED * rms {
                break;
            }
        }
        last = Some(rms);
    }
    Ok(RmsError { model: Model::Finite, components, radius, model_error: 0.0 })
}

fn norm(components: &[ComponentError]) -> f64 {
    let squares = components.iter().map(|c| c.multiplicity as f64 * c.mean_square);
    squares.sum::<f64>().sqrt()
}

struct Sum {
    dimension: usize,
    components: Vec<Component>,
    evaluator: Evaluator<f64>,
    /// R/Δ.
    support: f64,
    h: f64,
    /// ω R^{−D} R^{p−q}: from sums in units of R to units of Δ.
    unit: f64,
    /// |ω f(0)| and the like, to which rounding errors are relative.
    size: f64,
    law: Law,
    moves: Moves,
    amplitude: f64,
    sites: Vec<Site>,
    centre: usize,
    /// Sites of other rows than the centre's, by row.
    rows: BTreeMap<i64, Vec<usize>>,
    row_of_centre: i64,
    expectation: Expectation,
    /// The axes that the lattice and the law may be reflected along: one side of each stands for both.
    mirrors: Vec<usize>,
    /// Terms of f evaluated.
    taken: AtomicU64,
}

impl Sum {
    fn new(setting: &Setting<'_>, moment: Moment) -> Self {
        let Setting { kernel, lattice, disorder, support_over_dx: support, .. } = *setting;
        let dimension = lattice.dimension();
        let motion = disorder.motion();
        let amplitude = disorder.amplitude();
        let moves = disorder.entry().moves;
        let longest = if moves == Moves::Nothing { 0.0 } else { motion.longest[dimension - 1] * amplitude };
        let sites = lattice.sites_within(support + 2.0 * longest);
        let centre = sites.iter().position(|site| site.cell == [0; 3] && site.basis == 0).unwrap_or(0);
        let row = |site: &Site| lattice.row(site.cell, site.basis);
        let mut rows: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        for (place, site) in sites.iter().enumerate() {
            rows.entry(row(site)).or_default().push(place);
        }
        let row_of_centre = row(&sites[centre]);
        let volume = lattice.particle_volume().enclose(96).midpoint_f64();
        let unit = volume * support.powi(moment.length_power() - dimension as i32);
        let h = support / rational_to_f64(kernel.support_over_h());
        let knots = kernel.jumps().iter().map(|jump| rational_to_f64(&jump.at) * h).collect();
        let components = moment.components(dimension);
        let order = components.iter().flat_map(|c| &c.terms).map(|term| term.radial).max().unwrap_or(0);
        let rank = usize::from(moment.positions() + moment.derivatives());
        let group = PointGroup::of(lattice);
        let mirrored =
            |axis: &usize| matches!(motion.law, Law::Independent(_)) && group.has_reflection(*axis);
        let mirrors = (0..dimension).filter(mirrored).collect();
        let expectation = Expectation::new(dimension, amplitude, knots, rank);
        Self {
            dimension,
            components,
            evaluator: Evaluator::new(kernel, dimension, order),
            support,
            h,
            unit,
            size: support.powi(moment.length_power()),
            law: motion.law,
            moves,
            amplitude,
            sites,
            centre,
            rows,
            row_of_centre,
            expectation,
            mirrors,
            taken: AtomicU64::new(0),
        }
    }

    /// Adds weight · f(r) and weight · f(r)² by component.
    fn add(&self, r: [f64; 3], weight: f64, sums: &mut Moments) {
        let x = r.map(|r| r / self.support);
        let distance = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
        if distance >= 1.0 {
            return;
        }
        let g = self.evaluator.radial(distance);
        for (sum, component) in sums.iter_mut().zip(&self.components) {
            let mut value = 0.0;
            for term in &component.terms {
                let mut product = term.coefficient as f64 * g[term.radial];
                for (x, power) in x.iter().zip(term.monomial.powers) {
                    for _ in 0..power {
                        product *= x;
                    }
                }
                value += product;
            }
            sum[0] += weight * value;
            sum[1] += weight * value * value;
        }
    }

    /// Mean and variance of S given the centre's chance, in units of Δ; `still` leaves all sites where they are.
    fn given(&self, given: Given, level: usize, whole: &[Node], still: bool) -> Moments {
        let mut total = vec![[0.0; 2]; self.components.len()];
        // A group of particles whose terms are one random number each: its mean and variance are added.
        let mut group = |visit: &mut dyn FnMut(&mut Moments)| {
            let mut sums = vec![[0.0; 2]; self.components.len()];
            visit(&mut sums);
            for (total, [mean, square]) in total.iter_mut().zip(sums) {
                total[0] += mean;
                total[1] += (square - mean * mean).max(0.0);
            }
        };
        let separation = |j: usize, d_i: [f64; 3], d_j: [f64; 3]| -> [f64; 3] {
            let (i, j) = (self.sites[self.centre].position, self.sites[j].position);
            std::array::from_fn(|a| i[a] - j[a] + d_i[a] - d_j[a])
        };
        let others = (0..self.sites.len()).filter(|j| *j != self.centre);
        let evaluations = Cell::new(0);
        // The term j = i.
        group(&mut |sums| self.add([0.0; 3], 1.0, sums));
        match (given, self.law) {
            (Given::Centre(d_i), Law::Independent(shape)) if self.moves == Moves::All => {
                for j in others {
                    let y = separation(j, d_i, [0.0; 3]);
                    group(&mut |sums| {
                        self.expectation.visit(shape, y, level, whole, &mut |d_j, weight| {
                            evaluations.set(evaluations.get() + 1);
                            self.add(std::array::from_fn(|a| y[a] - d_j[a]), weight, sums);
                        });
                    });
                }
            }
            (Given::Row(slid), _) => {
                let mut at = |row: i64, places: &[usize], weights: &[(f64, f64)]| {
                    group(&mut |sums| {
                        let mut own = vec![[0.0; 2]; self.components.len()];
                        for (slides, weight) in weights {
                            own.iter_mut().for_each(|sum| *sum = [0.0; 2]);
                            for j in places.iter().filter(|j| **j != self.centre) {
                                evaluations.set(evaluations.get() + 1);
                                let along = if row == self.row_of_centre { 0.0 } else { slid - slides };
                                self.add(separation(*j, [along, 0.0, 0.0], [0.0; 3]), 1.0, &mut own);
                            }
                            for (sum, [value, _]) in sums.iter_mut().zip(&own) {
                                sum[0] += weight * value;
                                sum[1] += weight * value * value;
                            }
                        }
                    });
                };
                let slides = self.slides(level);
                for (row, places) in &self.rows {
                    let own = *row == self.row_of_centre;
                    at(*row, places, if own { &[(0.0, 1.0)] } else { &slides });
                }
            }
            _ => {
                let displacement = |j: usize| match given {
                    _ if still => [0.0; 3],
                    Given::Centre(d) => {
                        if j == self.centre {
                            d
                        } else {
                            [0.0; 3]
                        }
                    }
                    Given::Wave { phase, n, e } => {
                        let path: f64 = n.iter().zip(self.sites[j].position).map(|(n, x)| n * x).sum();
                        let sine = libm::sin(TAU * (path + phase));
                        e.map(|e| self.amplitude * e * sine)
                    }
                    Given::Nothing | Given::Row(_) => {
                        let slid = self.row(j).rem_euclid(2) == 1 && self.law == Law::AlternateRows;
                        if slid { [self.amplitude, 0.0, 0.0] } else { [0.0; 3] }
                    }
                };
                let d_i = displacement(self.centre);
                for j in others {
                    let r = separation(j, d_i, displacement(j));
                    evaluations.set(evaluations.get() + 1);
                    group(&mut |sums| {
                        self.add(r, 1.0, sums);
                        // One number, no chance.
                        sums.iter_mut().for_each(|sum| sum[1] = sum[0] * sum[0]);
                    });
                }
            }
        }
        // The radial functions take about as long as four terms.
        let terms = 4 + self.components.iter().map(|component| component.terms.len() as u64).sum::<u64>();
        self.taken.fetch_add(evaluations.get() * terms, Ordering::Relaxed);
        total.iter().map(|[mean, variance]| [mean * self.unit, variance * self.unit * self.unit]).collect()
    }

    fn row(&self, j: usize) -> i64 {
        self.rows.iter().find(|(_, places)| places.contains(&j)).map_or(0, |(row, _)| *row)
    }

    /// How far rows slide, with weights of sum 1.
    fn slides(&self, level: usize) -> Vec<(f64, f64)> {
        self.expectation.interval(-0.5 * self.amplitude, 0.5 * self.amplitude, 12 << level)
    }

    /// What the centre's chance decides, with weights of sum 1.
    fn outer(&self, level: usize) -> Vec<(Given, f64)> {
        if self.moves == Moves::Nothing {
            return vec![(Given::Nothing, 1.0)];
        }
        match self.law {
            Law::Independent(shape) => {
                let nodes = self.expectation.nodes(shape, level, self.moves == Moves::CentreOnly);
                nodes.into_iter().filter_map(|(d, weight)| self.one_side(d, weight)).collect()
            }
            Law::Rows => self.slides(level).into_iter().map(|(x, weight)| (Given::Row(x), weight)).collect(),
            Law::AlternateRows => vec![(Given::Nothing, 1.0)],
            Law::Wave { wavelength, in_h, along, transverse } => {
                let wavelength = if in_h { wavelength * self.h } else { wavelength };
                let directions = match along {
                    Some(axis) => vec![(std::array::from_fn(|a| if a == axis { 1.0 } else { 0.0 }), 1.0)],
                    None => self.expectation.directions(level),
                };
                let phases = 16 << level;
                let mut nodes = Vec::new();
                for (n, weight) in directions {
                    for (e, share) in polarisations(self.dimension, n, transverse, level) {
                        for phase in 0..phases {
                            let phase = f64::from(phase) / f64::from(phases);
                            let n = n.map(|n: f64| n / wavelength);
                            nodes.push((Given::Wave { phase, n, e }, weight * share / f64::from(phases)));
                        }
                    }
                }
                nodes
            }
        }
    }

    /// A displacement of particle i on the positive side of every mirror, for all its images.
    fn one_side(&self, d: [f64; 3], weight: f64) -> Option<(Given, f64)> {
        let rounding = 1e-12 * self.amplitude;
        let images = self.mirrors.iter().filter(|axis| d[**axis].abs() > rounding).count();
        let kept = self.mirrors.iter().all(|axis| d[*axis] >= -rounding);
        kept.then(|| (Given::Centre(d), weight * f64::from(1_u32 << images)))
    }

    /// Whether a component changes sign in some mirror.
    fn is_odd(&self, component: &Component) -> bool {
        let powers = component.terms.first().map(|term| term.monomial.powers).unwrap_or_default();
        self.mirrors.iter().any(|axis| powers[*axis] % 2 == 1)
    }

    /// Evaluations of f at a level, about.
    fn cost(&self, level: usize) -> f64 {
        let outer = self.outer(level).len() as f64;
        let inner = match self.law {
            Law::Independent(shape) if self.moves == Moves::All => self.expectation.inner_nodes(shape, level),
            Law::Rows => self.slides(level).len() as f64,
            _ => 1.0,
        };
        outer * self.sites.len() as f64 * inner
    }

    /// Mean and variance over everything.
    fn expected(&self, level: usize) -> Moments {
        let nodes = self.outer(level);
        let whole = match self.law {
            Law::Independent(shape) => self.expectation.whole(shape, level),
            _ => Vec::new(),
        };
        let given: Vec<Moments> =
            nodes.par_iter().map(|(given, _)| self.given(*given, level, &whole, false)).collect();
        let count = self.components.len();
        let mut total = vec![[0.0; 2]; count];
        for (moments, (_, weight)) in given.iter().zip(&nodes) {
            for (total, [mean, _]) in total.iter_mut().zip(moments) {
                total[0] += weight * mean;
            }
        }
        for (total, component) in total.iter_mut().zip(&self.components) {
            if self.is_odd(component) {
                total[0] = 0.0;
            }
        }
        for (moments, (_, weight)) in given.iter().zip(&nodes) {
            for (total, [mean, variance]) in total.iter_mut().zip(moments) {
                let off = mean - total[0];
                total[1] += weight * (variance + off * off);
            }
        }
        total
    }
}
