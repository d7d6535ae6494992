//! Lattices: unperturbed particles with exact coordinates.
//!
//! A site has r_a = k_a √s_a Δ with whole numbers k and one rational s per axis, so that every |r|² is a rational
//! multiple of Δ² and every monomial of the coordinates a rational times one square root. A new lattice is one entry in
//! [`catalogue`].

use super::ParticleError;
use crate::exact::{Radical, Rational, int, ratio, rational_to_f64};
use crate::names::nearest;
use num_integer::Integer;

/// Whole-number coordinates of a site, r_a = k_a √s_a.
pub type SiteIndex = [i64; 3];

/// A cell has at most this many particles: each has its own stream of random words.
pub const MOST_PARTICLES: usize = 63;

/// A lattice with a basis. Lengths are in units of Δ: the cell edge for cubic lattices, the distance between nearest
/// neighbours for the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    id: String,
    name: String,
    dimension: usize,
    /// s_a by axis.
    axis_squares: [Rational; 3],
    /// The vectors that span the cell, in k; unused rows are zero.
    vectors: [SiteIndex; 3],
    /// The particles of one cell, in k; the first is the origin.
    basis: Vec<SiteIndex>,
}

/// A site in floating point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Which cell: the coefficient of each lattice vector.
    pub cell: [i64; 3],
    /// Which particle of the cell.
    pub basis: usize,
    /// Position in units of Δ.
    pub position: [f64; 3],
}

impl Lattice {
    /// A lattice from its vectors and basis in whole-number coordinates k, r_a = k_a √s_a.
    ///
    /// # Errors
    /// [`ParticleError::Lattice`] if the vectors are dependent, an s is not positive, or two particles of the basis
    /// share a place.
    pub fn new(
        id: &str,
        name: &str,
        dimension: usize,
        axis_squares: [Rational; 3],
        vectors: [SiteIndex; 3],
        basis: Vec<SiteIndex>,
    ) -> Result<Self, ParticleError> {
        let fault = |what: &str| ParticleError::Lattice { id: id.to_owned(), what: what.to_owned() };
        if !(1..=3).contains(&dimension) {
            return Err(fault("has a dimension other than 1, 2 or 3"));
        }
        if axis_squares[..dimension].iter().any(|s| *s <= int(0)) {
            return Err(fault("has an axis scale that is not positive"));
        }
        let outside = |k: &SiteIndex| k[dimension..].iter().any(|c| *c != 0);
        if vectors[..dimension].iter().any(outside) || basis.iter().any(outside) {
            return Err(fault("has a coordinate beyond its dimension"));
        }
        if basis.first() != Some(&[0, 0, 0]) {
            return Err(fault("must have its first particle of the basis at the origin"));
        }
        if basis.len() > MOST_PARTICLES {
            return Err(fault("has more than 63 particles in its cell"));
        }
        let lattice =
            Self { id: id.to_owned(), name: name.to_owned(), dimension, axis_squares, vectors, basis };
        if lattice.cell_determinant() == 0 {
            return Err(fault("has vectors that are linearly dependent"));
        }
        for (i, a) in lattice.basis.iter().enumerate() {
            for b in &lattice.basis[..i] {
                if lattice.is_lattice_vector([a[0] - b[0], a[1] - b[1], a[2] - b[2]]) {
                    return Err(fault("has two particles of its basis in one place"));
                }
            }
        }
        Ok(lattice)
    }

    /// The id used in scenes and reports.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// A name for people.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// D.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// s_a: the square of the unit of k along each axis, in Δ².
    pub fn axis_squares(&self) -> &[Rational; 3] {
        &self.axis_squares
    }

    /// The vectors that span the cell, in k.
    pub fn vectors(&self) -> &[SiteIndex] {
        &self.vectors[..self.dimension]
    }

    /// The particles of one cell, in k.
    pub fn basis(&self) -> &[SiteIndex] {
        &self.basis
    }

    /// Volume of the cell over the particles in it, in Δ^D: ω of the `constant` volume rule.
    pub fn particle_volume(&self) -> Radical {
        let product = self.axis_squares[..self.dimension].iter().fold(int(1), |product, s| product * s);
        let per_particle = ratio(self.cell_determinant().abs(), self.basis.len() as i64);
        // The s are positive by construction.
        Radical::sqrt_of(&product).map(|root| root.scale(&per_particle)).unwrap_or_default()
    }

    /// |r|² of a site in units of Δ².
    pub fn square(&self, k: &SiteIndex) -> Rational {
        (0..self.dimension).fold(int(0), |sum, a| sum + &self.axis_squares[a] * int(k[a] * k[a]))
    }

    /// The unit of each axis in floating point, √s_a.
    pub fn axis_units(&self) -> [f64; 3] {
        std::array::from_fn(|a| {
            if a < self.dimension { rational_to_f64(&self.axis_squares[a]).sqrt() } else { 0.0 }
        })
    }

    /// Whether a particle stands at k.
    pub fn has_site(&self, k: SiteIndex) -> bool {
        self.basis.iter().any(|b| self.is_lattice_vector(std::array::from_fn(|a| k[a] - b[a])))
    }

    /// Whether the vector k carries the whole lattice onto itself. Where the cell is not the smallest one, these are more
    /// than those that join cells.
    pub fn is_translation(&self, k: SiteIndex) -> bool {
        self.basis.iter().all(|b| self.has_site(std::array::from_fn(|a| k[a] + b[a])))
    }

    /// The row (in 3-D, layer) a site is in, counted along the last axis from that of particle i: sites of one row have
    /// the same last coordinate. In 1-D every site is its own.
    pub fn row(&self, cell: [i64; 3], basis: usize) -> i64 {
        let last = self.dimension - 1;
        let period = self.vectors().iter().fold(0_i64, |gcd, vector| gcd.gcd(&vector[last]));
        let mut heights: Vec<i64> = self.basis.iter().map(|b| b[last].rem_euclid(period)).collect();
        heights.sort_unstable();
        heights.dedup();
        let height =
            (0..3).map(|row| cell[row] * self.vectors[row][last]).sum::<i64>() + self.basis[basis][last];
        let within = heights.partition_point(|other| *other < height.rem_euclid(period));
        height.div_euclid(period) * heights.len() as i64 + within as i64
    }

    /// Whether the vector k joins two cells.
    pub fn is_lattice_vector(&self, k: SiteIndex) -> bool {
        let determinant = self.cell_determinant();
        (0..self.dimension).all(|row| {
            let mut vectors = self.vectors;
            vectors[row] = k;
            determinant_of(&vectors, self.dimension) % determinant == 0
        })
    }

    /// All sites within `radius` (in Δ) of the first particle of the origin's cell, that particle included, cell by
    /// cell in rising order of the last coefficient, then the one before it.
    pub fn sites_within(&self, radius: f64) -> Vec<Site> {
        let mut sites = Vec::new();
        self.for_each_site(radius, |cell, basis, _, position| {
            sites.push(Site { cell, basis, position });
        });
        sites
    }

    /// The whole-number coordinates of all sites with |r|² ≤ `radius`² up to rounding.
    pub fn indices_within(&self, radius: f64) -> Vec<SiteIndex> {
        let mut indices = Vec::new();
        self.visit_indices(radius, |k| indices.push(k));
        indices
    }

    /// Visits the whole-number coordinates of all sites with |r|² ≤ `radius`² up to rounding.
    pub fn visit_indices(&self, radius: f64, mut visit: impl FnMut(SiteIndex)) {
        self.for_each_site(radius, |_, _, k, _| visit(k));
    }

    /// All vectors within `radius` (in Δ) from a particle of the cell to another particle.
    pub fn separations_within(&self, radius: f64) -> Vec<[f64; 3]> {
        let units = self.axis_units();
        let mut separations = Vec::new();
        for from in &self.basis {
            let origin: [f64; 3] = std::array::from_fn(|a| from[a] as f64 * units[a]);
            let extent = origin.iter().map(|x| x * x).sum::<f64>().sqrt();
            self.for_each_site(radius + extent, |_, _, k, position| {
                let r: [f64; 3] = std::array::from_fn(|a| position[a] - origin[a]);
                if k != *from && r[0] * r[0] + r[1] * r[1] + r[2] * r[2] <= radius * radius * (1.0 + 1e-12) {
                    separations.push(r);
                }
            });
        }
        separations
    }

    /// The square of the least distance between two particles, in Δ².
    pub fn least_square(&self) -> Rational {
        let units = self.axis_units();
        let place = |k: &SiteIndex| -> [f64; 3] { std::array::from_fn(|a| k[a] as f64 * units[a]) };
        // Two particles a vector of the cell apart are no nearest ones if others are nearer.
        let start = self.vectors().iter().map(|vector| self.square(vector)).min().unwrap_or_else(|| int(1));
        let radius = rational_to_f64(&start).sqrt() * (1.0 + 1e-9);
        let mut least = start;
        for from in &self.basis {
            let extent = place(from).iter().map(|x| x * x).sum::<f64>().sqrt();
            self.visit_indices(radius + extent, |k| {
                let square = self.square(&std::array::from_fn(|a| k[a] - from[a]));
                if k != *from && square < least {
                    least = square;
                }
            });
        }
        least
    }

    /// About how many sites lie within `radius` (in Δ).
    pub fn estimate_within(&self, radius: f64) -> f64 {
        let ball = match self.dimension {
            1 => 2.0 * radius,
            2 => std::f64::consts::PI * radius * radius,
            _ => 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius,
        };
        ball / self.particle_volume().enclose(64).midpoint_f64()
    }

    fn for_each_site(&self, radius: f64, mut visit: impl FnMut([i64; 3], usize, SiteIndex, [f64; 3])) {
        let units = self.axis_units();
        let reach = self.cell_reach(radius, &units);
        let limit = radius * radius * (1.0 + 1e-12);
        for c2 in -reach[2]..=reach[2] {
            for c1 in -reach[1]..=reach[1] {
                for c0 in -reach[0]..=reach[0] {
                    for (b, offset) in self.basis.iter().enumerate() {
                        let k: SiteIndex = std::array::from_fn(|a| {
                            c0 * self.vectors[0][a]
                                + c1 * self.vectors[1][a]
                                + c2 * self.vectors[2][a]
                                + offset[a]
                        });
                        let position: [f64; 3] = std::array::from_fn(|a| k[a] as f64 * units[a]);
                        let square =
                            position[0] * position[0] + position[1] * position[1] + position[2] * position[2];
                        if square <= limit {
                            visit([c0, c1, c2], b, k, position);
                        }
                    }
                }
            }
        }
    }

    /// How far the coefficients of the lattice vectors go within `radius`: the length of the reciprocal vectors times
    /// the radius, plus the reach of the basis.
    fn cell_reach(&self, radius: f64, units: &[f64; 3]) -> [i64; 3] {
        let d = self.dimension;
        let matrix = nalgebra::DMatrix::from_fn(d, d, |row, a| self.vectors[row][a] as f64 * units[a]);
        let mut reach = [0; 3];
        if let Some(inverse) = matrix.try_inverse() {
            for (row, reach) in reach.iter_mut().enumerate().take(d) {
                let reciprocal = inverse.column(row);
                // How many cells away the basis names its particles.
                let cells =
                    |k: &SiteIndex| (0..d).map(|a| k[a] as f64 * units[a] * reciprocal[a]).sum::<f64>();
                let basis = self.basis.iter().map(|k| cells(k).abs()).fold(0.0, f64::max);
                *reach = (radius * reciprocal.norm() + basis).ceil() as i64 + 1;
            }
        }
        reach
    }

    fn cell_determinant(&self) -> i64 {
        determinant_of(&self.vectors, self.dimension)
    }
}

fn determinant_of(rows: &[SiteIndex; 3], dimension: usize) -> i64 {
    let m = rows;
    match dimension {
        1 => m[0][0],
        2 => m[0][0] * m[1][1] - m[0][1] * m[1][0],
        _ => {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        }
    }
}

/// The lattices that can be named in a scene or on the command line.
///
/// Cartesian vectors in units of Δ:
///
/// | id | a₁, a₂, a₃ | basis | volume per particle | nearest |
/// | --- | --- | --- | --- | --- |
/// | `line` | (1) | origin | 1 | 2 at 1 |
/// | `square` | (1, 0), (0, 1) | origin | 1 | 4 at 1 |
/// | `staggered` | (1, 0), (1/2, 1) | origin | 1 | 2 at 1, then 4 at √5/2 |
/// | `hexagonal` | (1, 0), (1/2, √3/2) | origin | √3/2 | 6 at 1 |
/// | `simple-cubic` | (1, 0, 0), (0, 1, 0), (0, 0, 1) | origin | 1 | 6 at 1 |
/// | `bcc` | (−1, 1, 1)/2, (1, −1, 1)/2, (1, 1, −1)/2 | origin | 1/2 | 8 at √3/2 |
/// | `fcc` | (0, 1, 1)/2, (1, 0, 1)/2, (1, 1, 0)/2 | origin | 1/4 | 12 at 1/√2 |
/// | `hcp` | (1, 0, 0), (1/2, √3/2, 0), (0, 0, √(8/3)) | origin, (1/2, 1/(2√3), √(2/3)) | 1/√2 | 12 at 1 |
///
/// `staggered` is the square lattice with every other row shifted by Δ/2. Δ is the cell edge for `bcc` and `fcc`. `hcp`
/// has the ideal c/a = √(8/3); it is no Bravais lattice and its sites are not centres of inversion.
pub fn catalogue() -> Vec<Lattice> {
    let one = || int(1);
    let zero = [0, 0, 0];
    let entry = |id, name, dimension, squares, vectors, basis| {
        Lattice::new(id, name, dimension, squares, vectors, basis)
            .unwrap_or_else(|error| unreachable!("catalogue entry {id}: {error}"))
    };
    vec![
        entry("line", "line", 1, [one(), one(), one()], [[1, 0, 0], zero, zero], vec![zero]),
        entry("square", "square", 2, [one(), one(), one()], [[1, 0, 0], [0, 1, 0], zero], vec![zero]),
        // Every other row shifted by Δ/2, rows Δ apart: a₁ = (1, 0), a₂ = (1/2, 1).
        entry(
            "staggered",
            "staggered rows",
            2,
            [ratio(1, 4), one(), one()],
            [[2, 0, 0], [1, 1, 0], zero],
            vec![zero],
        ),
        // Triangular cells: a₁ = (1, 0), a₂ = (1/2, √3/2).
        entry(
            "hexagonal",
            "hexagonal (triangular)",
            2,
            [ratio(1, 4), ratio(3, 4), one()],
            [[2, 0, 0], [1, 1, 0], zero],
            vec![zero],
        ),
        entry(
            "simple-cubic",
            "simple cubic",
            3,
            [one(), one(), one()],
            [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            vec![zero],
        ),
        // Cell edge 1: a₁ = (−1, 1, 1)/2 and its permutations.
        entry(
            "bcc",
            "body-centred cubic",
            3,
            [ratio(1, 4), ratio(1, 4), ratio(1, 4)],
            [[-1, 1, 1], [1, -1, 1], [1, 1, -1]],
            vec![zero],
        ),
        // Cell edge 1: a₁ = (0, 1, 1)/2 and its permutations.
        entry(
            "fcc",
            "face-centred cubic",
            3,
            [ratio(1, 4), ratio(1, 4), ratio(1, 4)],
            [[0, 1, 1], [1, 0, 1], [1, 1, 0]],
            vec![zero],
        ),
        // Triangular layers A, B at the ideal distance √(2/3): a₁ = (1, 0, 0), a₂ = (1/2, √3/2, 0), a₃ = (0, 0, √(8/3)).
        entry(
            "hcp",
            "hexagonal close packing",
            3,
            [ratio(1, 4), ratio(1, 12), ratio(2, 3)],
            [[2, 0, 0], [1, 3, 0], [0, 0, 2]],
            vec![zero, [1, 1, 1]],
        ),
    ]
}

/// The lattice of the catalogue with this id.
///
/// # Errors
/// [`ParticleError::UnknownLattice`] with the nearest known id.
pub fn lattice_by_id(id: &str) -> Result<Lattice, ParticleError> {
    lattice_among(id, &[])
}

/// The lattice with this id in the catalogue or among one's own.
///
/// # Errors
/// [`ParticleError::UnknownLattice`] with the nearest known id.
pub fn lattice_among(id: &str, own: &[Lattice]) -> Result<Lattice, ParticleError> {
    let known: Vec<Lattice> = catalogue().into_iter().chain(own.iter().cloned()).collect();
    let ids: Vec<&str> = known.iter().map(Lattice::id).collect();
    match ids.iter().position(|candidate| *candidate == id) {
        Some(index) => Ok(known[index].clone()),
        None => Err(ParticleError::UnknownLattice {
            id: id.to_owned(),
            nearest: nearest(id, &ids),
            known: ids.join(", "),
        }),
    }
}
