//! The tasks: what is placed and summed, and what is derived, each a pure function of its inputs.

use super::{ChaussonnetTable, KERNEL, LATTICES, RULE, lattice};
use crate::derived::{RmsError, Setting, linearised};
use crate::kernel;
use crate::language::{Coefficient, Subject, operators};
use crate::measured::precision::{Storage, stored_errors};
use crate::measured::{Domain, DomainSpec, Fields, Laid, Program, SquaredError, applied, mean_neighbours};
use crate::particles::{Disorder, Neighbours, VolumeRule};
use crate::study::survey::{SurveyTask, TaskError};
use crate::sums::{Engine, Factor, Moment, Points, RadialSum};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// One unit of work.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Work {
    /// Distances of neighbours, Fig. 2.
    Distances { lattice: &'static str, eta: f64 },
    /// Consistency errors, Figs. 4 and 5.
    Consistency { lattice: &'static str, eta: f64, h: f64 },
    /// Gradients and Laplacians of all fields, Figs. 6–14.
    Operators { lattice: &'static str, eta: f64, h: f64, scale: f64 },
    /// Errors by the way numbers are stored.
    Precision { storage: Storage },
    /// Sums over open clouds, and what wall particles do.
    Checks { lattice: &'static str },
    /// Moments of the derived errors.
    Derived { lattice: &'static str, disorder: &'static str, rule: VolumeRule },
}

/// Fig. 2.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Distances {
    /// Counts in [`BINS`] equal bins of [1 − 2η, 1 + 2η].
    pub bins: Vec<u64>,
    pub count: u64,
    /// Σ (d/Δ − 1) and Σ (d/Δ − 1)².
    pub sum: f64,
    pub sum_square: f64,
    pub least: f64,
    pub largest: f64,
    /// Mean number of particles in the support, the particle itself included.
    pub neighbours: f64,
    pub samples: u64,
    pub pairs: u64,
}

/// Figs. 4–14: squared errors by name, `E_1^1`, `G0/F1/x`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Errors {
    pub squares: BTreeMap<String, SquaredError>,
    /// Means with their sign, by name.
    pub means: BTreeMap<String, f64>,
    pub samples: u64,
    pub pairs: u64,
}

/// Relative totals of pair forces on an open cloud, and the walls.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Checks {
    /// |Σ V ⟨Lu⟩| / Σ |V ⟨Lu⟩| by operator.
    pub linear: BTreeMap<String, f64>,
    /// |Σ V r × ⟨Lu⟩| / Σ |V r × ⟨Lu⟩| by operator.
    pub angular: BTreeMap<String, f64>,
    /// By how much h ΣV∇W of an inner particle changes if the wall particles are displaced as well: the largest, and the
    /// root mean square of h ΣV∇W itself.
    pub walls: [f64; 2],
}

/// A derived component: of e = e₀ + J·d + ½ d·H·d the regular value, and mean and variance over η².
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Component {
    pub regular: f64,
    pub shift: f64,
    pub variance: f64,
}

/// Derived components by subject, in units of Δ.
pub(super) type Moments = BTreeMap<String, Vec<Component>>;

/// Bins of Fig. 2.
pub(super) const BINS: usize = 40;
/// The amplitude at which derived moments are taken; they are given per η².
const AMPLITUDE: f64 = 1e-3;
/// What is derived: coefficients (operator, order of the field), and moments.
const COEFFICIENTS: [(&str, u8); 7] =
    [("G0", 0), ("G-", 1), ("G-", 2), ("MCG", 1), ("MCG", 2), ("MEA", 1), ("MEA", 2)];
const MOMENTS: [&str; 4] = ["sum_w", "sum_dw", "sum_rw", "b_inverse"];
/// Gradients by name in the catalogue.
pub(super) const GRADIENTS: [&str; 3] = ["G0", "G+", "G-"];
/// Laplacians.
pub(super) const LAPLACIANS: [&str; 2] = ["MCG-pi", "MEA"];
/// K_x over which the arithmetic is tried, whatever the scene says.
pub(super) const SCALES: [f64; 5] = [0.01, 0.1, 1.0, 10.0, 100.0];
/// η and L/h at which it is tried.
pub(super) const PRECISION_CASES: [(f64, f64); 3] = [(1e-4, 10.0), (2.5e-3, 20.0), (6.25e-2, 20.0)];

/// η of the checks.
pub(super) const CHECKED_ETA: f64 = 6.25e-2;

/// All work of a scene, in a fixed order.
pub(super) fn works(table: &ChaussonnetTable, quick: bool) -> Vec<Work> {
    let mut works = Vec::new();
    let with_zero = || std::iter::once(0.0).chain(table.eta.iter().copied());
    for lattice in LATTICES {
        works.extend(table.eta.iter().map(|eta| Work::Distances { lattice, eta: *eta }));
        let last = table.consistency_h_m.len() - 1;
        for (place, h) in table.consistency_h_m.iter().enumerate() {
            // Fig. 4 holds η at its largest, Fig. 5 holds h at its least.
            let all = place == last;
            let etas = with_zero().filter(|eta| all || *eta == 0.0 || *eta == table.largest_eta());
            works.extend(etas.map(|eta| Work::Consistency { lattice, eta, h: *h }));
        }
        for (place, h) in table.ladder(lattice).iter().enumerate() {
            for eta in with_zero() {
                for scale in &table.field_scales {
                    // Operators are linear: beside the lattice of the paper's fits, one h shows what K_x does.
                    if lattice == "square" || *scale == 1.0 || place == 0 {
                        works.push(Work::Operators { lattice, eta, h: *h, scale: *scale });
                    }
                }
            }
        }
        works.push(Work::Checks { lattice });
        let three = ChaussonnetTable::is_3d(lattice);
        for (disorder, printed) in [("canonical:0.001", false), ("canonical:0.001,angles=printed", true)] {
            for rule in VolumeRule::ALL {
                // A first look derives in 3-D only what it measures.
                let own = rule == RULE && printed == (table.angles == "printed");
                if if three { !quick || own } else { !printed } {
                    works.push(Work::Derived { lattice, disorder, rule });
                }
            }
        }
    }
    works.extend(super::precision::STORAGES.iter().map(|(_, storage)| Work::Precision { storage: *storage }));
    works
}

impl Work {
    /// As a task; its inputs are all that its result depends on.
    pub(super) fn task(&self, table: &ChaussonnetTable, seed: u64) -> SurveyTask {
        let common = format!("chaussonnet 1 seed {seed} h/dx {} layer {}", table.h_over_dx, table.layer_h);
        let points = |lattice: &str| table.points[usize::from(ChaussonnetTable::is_3d(lattice))];
        let side = |lattice: &str| table.consistency_side[usize::from(ChaussonnetTable::is_3d(lattice))];
        let (label, inputs, cost) = match self {
            Self::Distances { lattice, eta } => (
                format!("distances {lattice} η = {eta}"),
                format!(
                    "points {} side {} {}",
                    points(lattice),
                    side(lattice),
                    table.disorder(lattice, *eta)
                ),
                points(lattice) * 60,
            ),
            Self::Consistency { lattice, eta, h } => (
                format!("consistency {lattice} η = {eta} h = {h:e}"),
                format!(
                    "points {} side {} {}",
                    points(lattice),
                    side(lattice),
                    table.disorder(lattice, *eta)
                ),
                points(lattice) * if ChaussonnetTable::is_3d(lattice) { 6000 } else { 300 },
            ),
            Self::Operators { lattice, eta, h, scale } => (
                format!("operators {lattice} η = {eta} h = {h:e} K_x = {scale}"),
                format!(
                    "points {} L {} origin {} {}",
                    points(lattice),
                    table.domain_size_m,
                    table.origin_h,
                    table.disorder(lattice, *eta)
                ),
                points(lattice) * if ChaussonnetTable::is_3d(lattice) { 20_000 } else { 1000 },
            ),
            Self::Precision { storage } => {
                let name = super::precision::name_of(*storage);
                (format!("arithmetic {name}"), format!("L {}", table.domain_size_m), 5_000_000)
            }
            Self::Checks { lattice } => {
                (format!("checks {lattice}"), table.disorder(lattice, CHECKED_ETA), 10_000_000)
            }
            Self::Derived { lattice, disorder, rule } => {
                let cost = if ChaussonnetTable::is_3d(lattice) { 200_000_000 } else { 5_000_000 };
                (format!("derived {lattice} {disorder} {rule}"), String::new(), cost)
            }
        };
        SurveyTask { inputs: format!("{common}: {label}: {inputs}"), label, cost }
    }

    pub(super) fn compute(&self, table: &ChaussonnetTable, seed: u64) -> Result<Value, TaskError> {
        let first = first_sample(&self.task(table, seed).inputs);
        Ok(match self {
            Self::Distances { lattice, eta } => {
                let bench = Bench::new(table, seed, lattice, *eta, 1e-3, side_of(table, lattice, 1e-3))?;
                serde_json::to_value(bench.distances(*eta, points(table, lattice), first)?)?
            }
            Self::Consistency { lattice, eta, h } => {
                let bench = Bench::new(table, seed, lattice, *eta, *h, side_of(table, lattice, *h))?;
                serde_json::to_value(bench.consistency(points(table, lattice), first)?)?
            }
            Self::Operators { lattice, eta, h, scale } => {
                let bench = Bench::new(table, seed, lattice, *eta, *h, table.domain_size_m)?;
                let points = if *eta == 0.0 { 1 } else { points(table, lattice) };
                serde_json::to_value(bench.operators(*scale, points, first)?)?
            }
            Self::Precision { storage } => serde_json::to_value(precision(table, seed, *storage)?)?,
            Self::Checks { lattice } => serde_json::to_value(checks(table, seed, lattice, first)?)?,
            Self::Derived { lattice, disorder, rule } => {
                serde_json::to_value(derived(table, lattice, disorder, *rule)?)?
            }
        })
    }
}

/// The number of a task's first sample: far from those of others.
fn first_sample(inputs: &str) -> u64 {
    // Fowler, Noll and Vo's hash; 2²⁰ samples are left to each task, and room for the streams of a sample.
    let hash = inputs.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    (hash >> 28) << 20
}

fn points(table: &ChaussonnetTable, lattice: &str) -> u64 {
    table.points[usize::from(ChaussonnetTable::is_3d(lattice))]
}

/// The side of a consistency test, of a constant number of particles.
fn side_of(table: &ChaussonnetTable, lattice: &str, h: f64) -> f64 {
    let side = table.consistency_side[usize::from(ChaussonnetTable::is_3d(lattice))];
    f64::from(side) * h / table.h_over_dx
}

/// A domain and what is done on it.
struct Bench {
    domain: Domain,
    kernel: kernel::Kernel,
    dimension: usize,
    h: f64,
    size: f64,
    /// How far outside of the inner region ξ is zero, in metres.
    origin: f64,
}

impl Bench {
    fn new(
        table: &ChaussonnetTable,
        seed: u64,
        lattice_id: &str,
        eta: f64,
        h: f64,
        size: f64,
    ) -> Result<Self, TaskError> {
        let lattice = lattice(lattice_id)?;
        let kernel = kernel::by_id(KERNEL)?;
        let dimension = lattice.dimension();
        let spec = DomainSpec {
            kernel: kernel.clone(),
            lattice,
            disorder: Disorder::parse(&table.disorder(lattice_id, eta))?,
            h,
            h_over_dx: table.h_over_dx,
            size,
            layer: table.layer_h,
            seed,
        };
        Ok(Self { domain: Domain::new(spec)?, kernel, dimension, h, size, origin: table.origin_h * h })
    }

    fn xi(&self, x: f64) -> f64 {
        (x + self.origin) / self.size
    }

    fn grids(&self, points: u64) -> u64 {
        points.div_ceil(self.domain.inner().len() as u64)
    }

    fn distances(&self, eta: f64, points: u64, first: u64) -> Result<Distances, TaskError> {
        let mut found =
            Distances { bins: vec![0; BINS], least: f64::INFINITY, largest: 0.0, ..Distances::default() };
        let grids = self.grids(points);
        for grid in 0..grids {
            let laid = self.domain.lay(first + grid)?;
            for d in self.domain.neighbour_distances(&laid)? {
                let bin = ((d - 1.0 + 2.0 * eta) / (4.0 * eta) * BINS as f64).floor();
                found.bins[bin.clamp(0.0, BINS as f64 - 1.0) as usize] += 1;
                found.count += 1;
                found.sum += d - 1.0;
                found.sum_square += (d - 1.0) * (d - 1.0);
                found.least = found.least.min(d);
                found.largest = found.largest.max(d);
            }
            found.neighbours += mean_neighbours(&self.domain, &laid)? / grids as f64;
            found.pairs += laid.pairs;
        }
        found.samples = grids;
        Ok(found)
    }

    /// E_0^0, E_0^1, E_1^0, E_1^1 by r_ab, and E_1^1 by r_b as Eq. (7) prints it, the origin at the corner of the inner region.
    fn consistency(&self, points: u64, first: u64) -> Result<Errors, TaskError> {
        let d = self.dimension;
        let moments = MOMENTS.map(Moment::by_name).into_iter().collect::<Result<Vec<_>, _>>()?;
        let support = self.domain.support();
        let mut engine = Engine::for_moments(&self.kernel, d, support, &moments)?;
        let gradient = RadialSum { positions: 1, radial: 1, factor: Factor::One };
        let mut gradients = Engine::for_radial_sums(&self.kernel, d, support, &[gradient])?;
        let mut found = Errors { samples: self.grids(points), ..Errors::default() };
        for grid in 0..found.samples {
            let laid = self.domain.lay(first + grid)?;
            let (places, volumes) = (laid.cloud.positions(), laid.cloud.volumes());
            let mut sums = vec![0.0; places.len() * engine.columns()];
            engine.run(&Points { positions: places, weights: volumes, fields: &[] }, &mut sums)?;
            found.pairs += laid.pairs + engine.pairs() + d as u64 * engine.pairs();
            let width = engine.columns();
            let row = |i: usize| &sums[i * width..(i + 1) * width];
            let square = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>();
            // Σ V_b r_b ⊗ ∇W, one row of the matrix after the other: the weight is V_b times a coordinate.
            let mut printed = vec![0.0; places.len()];
            for a in 0..d {
                let weights: Vec<f64> = places.iter().zip(volumes).map(|(x, volume)| x[a] * volume).collect();
                let mut rows = vec![0.0; places.len() * d];
                gradients.run(&Points { positions: places, weights: &weights, fields: &[] }, &mut rows)?;
                for (i, total) in printed.iter_mut().enumerate() {
                    for b in 0..d {
                        let unit = if a == b { 1.0 } else { 0.0 };
                        let off = rows[i * d + b] - unit;
                        *total += off * off;
                    }
                }
            }
            let unit = |b_inverse: &[f64]| {
                let off = |(place, x): (usize, &f64)| if place % (d + 1) == 0 { x - 1.0 } else { *x };
                b_inverse.iter().enumerate().map(off).map(|x| x * x).sum::<f64>()
            };
            let inner = || self.domain.inner().iter().copied();
            let mut add = |name: &str, values: &mut dyn Iterator<Item = f64>| {
                found.squares.entry(name.to_owned()).or_default().add(&self.domain, values);
            };
            let h_square = self.h * self.h;
            add("E_0^0", &mut inner().map(|i| (row(i)[0] - 1.0) * (row(i)[0] - 1.0)));
            add("E_0^1", &mut inner().map(|i| square(&row(i)[1..=d]) * h_square));
            add("E_1^0", &mut inner().map(|i| square(&row(i)[d + 1..=2 * d]) / h_square));
            add("E_1^1", &mut inner().map(|i| unit(&row(i)[2 * d + 1..])));
            add("E_1^1 printed", &mut inner().map(|i| printed[i]));
        }
        Ok(found)
    }

    /// λ of Eq. (23) and ω of Eq. (35) by component.
    fn operators(&self, scale: f64, points: u64, first: u64) -> Result<Errors, TaskError> {
        let compiled = |id: &str| -> Result<Program, TaskError> {
            Ok(Program::new(&operators::by_id(id)?.operator()?, &self.kernel, self.dimension)?)
        };
        let gradients = GRADIENTS.map(compiled).into_iter().collect::<Result<Vec<_>, _>>()?;
        let laplacians = LAPLACIANS.map(compiled).into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut found = Errors { samples: self.grids(points), ..Errors::default() };
        // Of the sites: what does not depend on the sample.
        let sites: Vec<f64> = self.domain.sites().map(|x| self.xi(x[0])).collect();
        let mean_of =
            |f: &dyn Fn(f64) -> f64| sites.iter().map(|xi| f(*xi)).sum::<f64>() / sites.len() as f64;
        found.means.insert("ξ²".into(), mean_of(&|xi| xi * xi));
        found.means.insert("1/ξ²".into(), mean_of(&|xi| 1.0 / (xi * xi)));
        let (slope, curvature) = (scale / self.size, scale / (self.size * self.size));
        for grid in 0..found.samples {
            let laid = self.domain.lay(first + grid)?;
            let xi: Vec<f64> = laid.cloud.positions().iter().map(|x| self.xi(x[0])).collect();
            let fields: [Vec<f64>; 3] = [
                vec![scale; xi.len()],
                xi.iter().map(|xi| scale * xi).collect(),
                xi.iter().map(|xi| scale * xi * xi / 2.0).collect(),
            ];
            let vectors: Vec<Vec<[f64; 3]>> =
                fields.iter().map(|field| field.iter().map(|u| [*u, 0.0, 0.0]).collect()).collect();
            let mut requests: Vec<(&Program, Fields<'_>)> = Vec::new();
            for program in &gradients {
                requests.extend(fields.iter().map(|field| (program, Fields::Scalar(field))));
            }
            for program in &laplacians {
                requests.extend(vectors.iter().map(|field| (program, Fields::Vector(field))));
            }
            let values = applied(&self.domain, &laid, &requests)?;
            found.pairs += laid.pairs;
            let inner: Vec<f64> = self.domain.inner().iter().map(|i| xi[*i]).collect();
            let norm = (inner.iter().map(|xi| xi * xi).sum::<f64>() / inner.len() as f64).sqrt();
            for (number, values) in values.iter().enumerate() {
                let (operator, field) = (number / 3, number % 3);
                for a in 0..self.dimension {
                    let axis = ["x", "y", "z"][a];
                    let along = |k: usize| values[k * self.dimension + a];
                    let mut add = |name: String, squares: &mut dyn Iterator<Item = f64>| {
                        found.squares.entry(name).or_default().add(&self.domain, squares);
                    };
                    if let Some(id) = GRADIENTS.get(operator) {
                        let exact = |k: usize| match (field, a) {
                            (1, 0) => slope,
                            (2, 0) => slope * inner[k],
                            _ => 0.0,
                        };
                        let error = |k: usize| (along(k) - exact(k)) / slope;
                        let name = format!("{id}/F{field}/{axis}");
                        let local = |k: usize| if field == 2 { error(k) / inner[k] } else { error(k) };
                        add(name.clone(), &mut (0..inner.len()).map(|k| local(k) * local(k)));
                        if field == 2 {
                            // N₂ one number for the whole domain: the root mean square of the analytical gradient.
                            let squares = (0..inner.len()).map(|k| error(k) * error(k) / (norm * norm));
                            add(format!("{name}/whole"), &mut { squares });
                        }
                    } else {
                        let id = LAPLACIANS[operator - GRADIENTS.len()];
                        let exact = if (field, a) == (2, 0) { 1.0 } else { 0.0 };
                        let value = |k: usize, factor: f64| factor * along(k) / curvature - exact;
                        let squares = |factor: f64| (0..inner.len()).map(move |k| value(k, factor).powi(2));
                        add(format!("{id}/U{field}/{axis}"), &mut squares(1.0));
                        if id == "MCG-pi" {
                            // Without the printed 1/π.
                            add(format!("MCG/U{field}/{axis}"), &mut squares(std::f64::consts::PI));
                        }
                        if (field, a) == (2, 0) {
                            let mean = (0..inner.len()).map(|k| along(k) / curvature).sum::<f64>();
                            let mean = mean / (inner.len() as u64 * found.samples) as f64;
                            *found.means.entry(format!("{id}/U2/x")).or_default() += mean;
                        }
                    }
                }
            }
        }
        Ok(found)
    }
}

/// Totals of pair forces over all particles of an open cloud, of a field without any order, and the influence of the walls.
fn checks(table: &ChaussonnetTable, seed: u64, lattice_id: &str, first: u64) -> Result<Checks, TaskError> {
    let h = 1.0;
    let size = 10.0 * h / table.h_over_dx;
    let bench = Bench::new(table, seed, lattice_id, CHECKED_ETA, h, size)?;
    let laid = bench.domain.lay(first)?;
    let cloud = &laid.cloud;
    let lists = Neighbours::search(cloud)?;
    // Fractions of the golden ratio: no symmetry, no smoothness.
    let noise = |n: usize| (n as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
    let scalar: Vec<f64> = (0..cloud.len()).map(noise).collect();
    let vector: Vec<[f64; 3]> = (0..cloud.len())
        .map(|i| std::array::from_fn(|a| if a < bench.dimension { noise(7 * i + a) } else { 0.0 }))
        .collect();
    let mut found = Checks::default();
    for id in GRADIENTS.into_iter().chain(["MCG", "MEA"]) {
        let program = Program::new(&operators::by_id(id)?.operator()?, &bench.kernel, bench.dimension)?;
        let field = if GRADIENTS.contains(&id) { Fields::Scalar(&scalar) } else { Fields::Vector(&vector) };
        let values = program.apply(cloud, &lists, field)?;
        let (mut linear, mut angular) = ([0.0; 3], [0.0; 3]);
        let (mut forces, mut torques) = (0.0, 0.0);
        for (i, place) in cloud.positions().iter().enumerate() {
            let mut force = [0.0; 3];
            for (a, force) in force.iter_mut().enumerate().take(bench.dimension) {
                *force = cloud.volumes()[i] * values[i * bench.dimension + a];
            }
            let torque: [f64; 3] = std::array::from_fn(|a| {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                place[b] * force[c] - place[c] * force[b]
            });
            for a in 0..3 {
                linear[a] += force[a];
                angular[a] += torque[a];
            }
            forces += length(force);
            torques += length(torque);
        }
        found.linear.insert(id.into(), length(linear) / forces);
        found.angular.insert(id.into(), length(angular) / torques);
    }
    // The same particles in and around the inner region, with what were walls displaced as well.
    let wider = ChaussonnetTable { layer_h: 2.0 * table.layer_h, ..table.clone() };
    let loose = Bench::new(&wider, seed, lattice_id, CHECKED_ETA, h, size)?;
    let laid_loose = loose.domain.lay(first)?;
    let program = Program::new(&operators::by_id("G0")?.operator()?, &bench.kernel, bench.dimension)?;
    let sums = |bench: &Bench, laid: &Laid| -> Result<Vec<f64>, TaskError> {
        let ones = vec![1.0; laid.cloud.len()];
        Ok(applied(&bench.domain, laid, &[(&program, Fields::Scalar(&ones))])?.concat())
    };
    let (still, moved) = (sums(&bench, &laid)?, sums(&loose, &laid_loose)?);
    let largest = still.iter().zip(&moved).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let rms = (still.iter().map(|x| x * x).sum::<f64>() / bench.domain.inner().len() as f64).sqrt();
    found.walls = [h * largest, h * rms];
    Ok(found)
}

fn length(x: [f64; 3]) -> f64 {
    (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
}

/// Errors by case, K_x and what is taken, for one way of storing numbers.
fn precision(table: &ChaussonnetTable, seed: u64, storage: Storage) -> Result<Vec<Vec<[f64; 5]>>, TaskError> {
    let mut by_case = Vec::new();
    for (case, (eta, sides)) in PRECISION_CASES.into_iter().enumerate() {
        let h = table.domain_size_m / sides;
        let bench = Bench::new(table, seed, "square", eta, h, table.domain_size_m)?;
        // The same particles for every K_x and every storage.
        let laid = bench.domain.lay(case as u64)?;
        let errors = SCALES
            .map(|k| stored_errors(&bench.kernel, &bench.domain, &laid, bench.size, k, storage))
            .into_iter()
            .collect::<Result<Vec<_>, _>>()?;
        by_case.push(errors);
    }
    Ok(by_case)
}

fn derived(
    table: &ChaussonnetTable,
    lattice_id: &str,
    disorder: &str,
    rule: VolumeRule,
) -> Result<Moments, TaskError> {
    let (kernel, lattice) = (kernel::by_id(KERNEL)?, lattice(lattice_id)?);
    let disorder = Disorder::parse(disorder)?;
    let support_over_dx = table.h_over_dx * crate::exact::rational_to_f64(kernel.support_over_h());
    let setting = Setting { kernel: &kernel, lattice: &lattice, disorder: &disorder, support_over_dx, rule };
    let components = |error: RmsError| -> Vec<Component> {
        let square = AMPLITUDE * AMPLITUDE;
        let entry = |c: &crate::derived::ComponentError| Component {
            regular: c.regular,
            shift: (c.mean - c.regular) / square,
            variance: c.variance / square,
        };
        error.components.iter().map(entry).collect()
    };
    let mut moments = Moments::new();
    for (operator, order) in COEFFICIENTS {
        let subject = Subject::Coefficient(Coefficient::new(operator, order)?);
        moments.insert(subject.name(), components(linearised(&setting, &subject)?));
    }
    for name in MOMENTS {
        let subject = Subject::Moment(Moment::by_name(name)?);
        moments.insert(name.into(), components(linearised(&setting, &subject)?));
    }
    Ok(moments)
}
