//! The heat problem of Fatehi & Manzari (2011), §6: ∂T/∂t = α∇²T on the unit square with α = 1, T = 0 at first and on three
//! walls, T = sin πx on the fourth (y = 1).
//!
//! Particles stand on the vertices of an N × N grid, Δ = 1/(N − 1), walls included; those on the walls hold the boundary values
//! and do not move. How supports go on beyond the walls is not said in print: [`Boundary::CutOff`] ends them there, which is
//! how the figures read, and [`Boundary::Ghosts`] mirrors the particles, with T reflected about its value on the wall.

use super::{EvolveError, Matrix, System, assemble};
use crate::language::tree::OfParticle;
use crate::measured::Program;
use crate::particles::{Cloud, Disorder, Draw, SampleStream, Site, Support, lattice_by_id};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Terms of the series (43): at t = 10⁻⁴ the next one is below 10⁻¹⁶.
const TERMS: u32 = 400;

/// What lies beyond the walls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Boundary {
    /// Nothing.
    CutOff,
    /// Mirrored particles.
    Ghosts,
}

impl Boundary {
    /// The name used in scenes and reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::CutOff => "cut-off",
            Self::Ghosts => "ghosts",
        }
    }
}

/// One discretisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatProblem {
    /// Particles a side, walls included.
    pub n: usize,
    /// h/Δ = R/Δ.
    pub h_over_dx: f64,
    /// ε of §6.2.
    pub epsilon: f64,
    /// Seed of the displacements.
    pub seed: u64,
    /// What lies beyond the walls.
    pub boundary: Boundary,
    /// Of the layered problem, the diffusivity of the upper half over that of the lower half.
    pub jump: Option<f64>,
}

/// The steady solution of the layered problem: T = 0 below and 1 above, diffusivity 1 for y < 1/2 and `jump` beyond.
pub fn layered(y: f64, jump: f64) -> f64 {
    let flux = 2.0 / (1.0 + 1.0 / jump);
    if y < 0.5 { flux * y } else { 1.0 - flux * (1.0 - y) / jump }
}

/// The semi-discrete problem: unknowns are the particles that are not on a wall.
#[derive(Debug, Clone)]
pub struct HeatSystem {
    /// T′ = A T + b.
    pub system: System,
    /// Places of the unknowns.
    pub places: Vec<[f64; 2]>,
    /// The least distance between two particles.
    pub closest: f64,
    /// R.
    pub support: f64,
    /// All particles, walls included.
    pub particles: usize,
    /// Neighbours of the particle nearest the centre, without itself.
    pub neighbours: usize,
}

/// The errors (44)–(46).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatErrors {
    /// L₂.
    pub l2: f64,
    /// L∞.
    pub linf: f64,
    /// EC.
    pub ec: f64,
}

/// The solution (43) at (x, y) and time t.
pub fn exact(x: f64, y: f64, t: f64) -> f64 {
    let mut sum = libm::sinh(PI * y) / libm::sinh(PI);
    for m in 1..=TERMS {
        let m = f64::from(m);
        let decay = libm::exp(-PI * PI * (1.0 + m * m) * t);
        if decay < 1e-20 {
            break;
        }
        let sign = if m % 2.0 == 0.0 { 1.0 } else { -1.0 };
        sum += 2.0 * m / (PI * (m * m + 1.0)) * sign * decay * libm::sin(m * PI * y);
    }
    sum * libm::sin(PI * x)
}

/// A particle of the extended cloud: its value is `factor` times that of a particle of the grid, plus `constant`.
struct Image {
    of: usize,
    factor: f64,
    constant: f64,
}

impl HeatProblem {
    /// The square matrix and source of the operator on these particles.
    ///
    /// # Errors
    /// What the operator lacks on these particles.
    pub fn discretise(&self, program: &Program) -> Result<HeatSystem, EvolveError> {
        let n = self.n;
        let dx = 1.0 / (n - 1) as f64;
        let support = self.h_over_dx * dx;
        let grid = self.grid(dx);
        let on_wall = |k: usize| {
            let (i, j) = (k / n, k % n);
            i == 0 || j == 0 || i == n - 1 || j == n - 1
        };
        let wall_value = |k: usize| match self.jump {
            Some(jump) => layered(grid[k][1], jump),
            None if k % n == n - 1 => libm::sin(PI * grid[k][0]),
            None => 0.0,
        };
        let inner: Vec<usize> = (0..n * n).filter(|k| !on_wall(*k)).collect();
        let mut unknown = vec![usize::MAX; n * n];
        for (index, k) in inner.iter().enumerate() {
            unknown[*k] = index;
        }
        let images = match self.boundary {
            Boundary::CutOff => Vec::new(),
            Boundary::Ghosts => ghosts(&grid, support),
        };
        let positions: Vec<[f64; 3]> =
            grid.iter().copied().chain(images.iter().map(|(place, _)| *place)).collect();
        let volumes = vec![dx * dx; positions.len()];
        let diffusivity = |y: f64| if y < 0.5 { 1.0 } else { self.jump.unwrap_or(1.0) };
        let carried = positions.iter().map(|[_, y, _]| diffusivity(*y)).collect();
        let cloud = Cloud::new(2, positions, volumes, Support::Uniform(support))?;
        let cloud = cloud.with_field(OfParticle::Viscosity.field_name(), carried)?;
        let rows = assemble(program, &cloud, &inner)?;
        let (source, folded): (Vec<f64>, Vec<Vec<(u32, f64)>>) = (0..inner.len())
            .into_par_iter()
            .map(|i| {
                let (mut source, mut row) = (0.0, Vec::new());
                for (column, value) in rows.row(i) {
                    let image = match column.checked_sub(n * n) {
                        None => &Image { of: column, factor: 1.0, constant: 0.0 },
                        Some(ghost) => &images[ghost].1,
                    };
                    source += value * image.constant;
                    let value = value * image.factor;
                    if on_wall(image.of) {
                        source += value * wall_value(image.of);
                    } else {
                        row.push((unknown[image.of] as u32, value));
                    }
                }
                (source, row)
            })
            .unzip();
        let matrix = Matrix::from_rows(inner.len(), folded);
        let alone = Cloud::new(2, grid.clone(), vec![dx * dx; n * n], Support::Uniform(support))?;
        let closest = alone.closest_pair().map_or(dx, |pair| pair.distance);
        let centre = &grid[(n / 2) * n + n / 2];
        let near = grid.iter().filter(|x| {
            let (a, b) = (x[0] - centre[0], x[1] - centre[1]);
            a * a + b * b < support * support
        });
        let neighbours = near.count() - 1;
        let places = inner.iter().map(|k| [grid[*k][0], grid[*k][1]]).collect();
        Ok(HeatSystem {
            system: System { matrix, source },
            places,
            closest,
            support,
            particles: n * n,
            neighbours,
        })
    }

    /// Particles in the order i n + j, x = iΔ, y = jΔ, those inside displaced.
    fn grid(&self, dx: f64) -> Vec<[f64; 3]> {
        let n = self.n;
        let disorder = Disorder::parse(&format!("box:{}", self.epsilon)).ok();
        let motion = disorder.filter(|_| self.epsilon > 0.0).map(|disorder| disorder.motion());
        let lattice = lattice_by_id("square");
        let mut stream = SampleStream::new(self.seed, 0);
        let mut grid = Vec::with_capacity(n * n);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut place = [i as f64, j as f64, 0.0];
            let inside = i > 0 && j > 0 && i < n - 1 && j < n - 1;
            if let (true, Some(motion), Ok(lattice)) = (inside, &motion, &lattice) {
                let site = Site { cell: [i as i64, j as i64, 0], basis: 0, position: place };
                let mut draw = Draw::new(lattice, &site, self.h_over_dx, &mut stream);
                let unit = (motion.unit)(&mut draw);
                for axis in 0..2 {
                    place[axis] += self.epsilon * unit[axis];
                }
            }
            let on = |c: f64| if c == (n - 1) as f64 { 1.0 } else { c * dx };
            grid.push([on(place[0]), on(place[1]), 0.0]);
        }
        grid
    }
}

/// Particles mirrored at the walls, and at both walls of a corner.
fn ghosts(grid: &[[f64; 3]], support: f64) -> Vec<([f64; 3], Image)> {
    let mirrored = |c: f64| {
        let low = (c > 0.0 && c < support).then_some(-c);
        let high = (c < 1.0 && c > 1.0 - support).then_some(2.0 - c);
        [low, high]
    };
    let mut found = Vec::new();
    for (of, [x, y, _]) in grid.iter().enumerate() {
        let top = 2.0 * libm::sin(PI * x);
        let across = |gx: f64| ([gx, *y, 0.0], Image { of, factor: -1.0, constant: 0.0 });
        let along = |gy: f64| {
            let constant = if gy > 1.0 { top } else { 0.0 };
            ([*x, gy, 0.0], Image { of, factor: -1.0, constant })
        };
        found.extend(mirrored(*x).into_iter().flatten().map(across));
        found.extend(mirrored(*y).into_iter().flatten().map(along));
        for gx in mirrored(*x).into_iter().flatten() {
            for gy in mirrored(*y).into_iter().flatten() {
                let constant = if gy > 1.0 { -top } else { 0.0 };
                found.push(([gx, gy, 0.0], Image { of, factor: 1.0, constant }));
            }
        }
    }
    found
}

impl HeatSystem {
    /// Errors against the solution (43) at time t; on the walls they are zero.
    pub fn errors(&self, u: &[f64], t: f64) -> HeatErrors {
        self.norms(&self.difference(u, t))
    }

    /// T − T^num at the unknowns.
    pub fn difference(&self, u: &[f64], t: f64) -> Vec<f64> {
        self.places.iter().zip(u).map(|([x, y], u)| exact(*x, *y, t) - u).collect()
    }

    /// The three norms of a difference.
    pub fn norms(&self, difference: &[f64]) -> HeatErrors {
        let n = self.particles as f64;
        let (mut square, mut largest, mut sum) = (0.0, 0.0_f64, 0.0);
        for e in difference {
            square += e * e;
            largest = largest.max(e.abs());
            sum += e;
        }
        HeatErrors { l2: (square / n).sqrt(), linf: largest, ec: (sum / n).abs() }
    }

    /// Root mean squares of a difference over the unknowns nearer than R to a wall, and over the others.
    pub fn near_and_far(&self, difference: &[f64]) -> [f64; 2] {
        let mut sums = [(0.0, 0_u32); 2];
        for ([x, y], e) in self.places.iter().zip(difference) {
            let near = x.min(1.0 - x).min(*y).min(1.0 - y) < self.support;
            let sum = &mut sums[usize::from(!near)];
            sum.0 += e * e;
            sum.1 += 1;
        }
        sums.map(|(sum, count)| (sum / f64::from(count.max(1))).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_starts_from_zero_meets_its_walls_and_solves_the_equation() {
        assert!(exact(0.3, 0.4, 1e-4).abs() < 1e-12);
        assert!((exact(0.3, 1.0, 0.1) - libm::sin(PI * 0.3)).abs() < 1e-12);
        assert!(exact(0.0, 0.7, 0.1).abs() < 1e-15 && exact(0.7, 0.0, 0.1).abs() < 1e-15);
        let (x, y, t, d) = (0.37, 0.61, 0.05, 1e-3);
        let second = |f: &dyn Fn(f64) -> f64| (f(d) - 2.0 * f(0.0) + f(-d)) / (d * d);
        let laplacian = second(&|e| exact(x + e, y, t)) + second(&|e| exact(x, y + e, t));
        let rate = (exact(x, y, t + 1e-5) - exact(x, y, t - 1e-5)) / 2e-5;
        assert!((laplacian - rate).abs() < 1e-4 * rate.abs().max(1.0), "{laplacian} {rate}");
    }
}
