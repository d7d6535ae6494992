//! No-slip walls of a channel as Basa et al. (2009), § 6.1.2, model them: the viscous term near them, and the steady flow that
//! balances a body force.
//!
//! A square lattice of `rows` rows lies between walls half a spacing beyond its outer rows, periodic along the flow. Virtual
//! particles stand where the fluid's are mirrored, three supports deep, as two passes with volumes V = 1/ΣW need.
//! A particle on the wall stands below each column: the nearest point on the wall to all fluid particles of the column is one.
//! Lengths are in Δ unless said otherwise.

use super::placed::{PlaceError, Placed, number_volumes};
use super::program::{Fields, Program};
use crate::exact::{Solution, solve};
use crate::kernel::Kernel;
use crate::language::{Field, Operator};
use crate::particles::{Cloud, Neighbours, Support};
use thiserror::Error;

/// How virtual particles get their velocity along the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wall {
    /// Minus that of the fluid particle mirrored.
    Mirroring,
    /// On the line through zero at the wall and the nearest fluid particle.
    Linear,
    /// On the parabola through zero at the wall and the two nearest.
    Quadratic,
    /// On the parabola with zeros at both walls through the nearest.
    GlobalQuadratic,
}

impl Wall {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Mirroring, Self::Linear, Self::Quadratic, Self::GlobalQuadratic];

    /// The name used in reports, as in the paper.
    pub fn id(self) -> &'static str {
        match self {
            Self::Mirroring => "mirroring",
            Self::Linear => "linear extrapolation",
            Self::Quadratic => "quadratic extrapolation",
            Self::GlobalQuadratic => "globalised quadratic extrapolation",
        }
    }

    /// The velocity `s` behind a wall, by the fluid's row by row from that wall.
    fn behind(self, s: f64, row: usize, fluid: &[f64]) -> f64 {
        let (x, first, second) = (-s, 0.5, 1.5);
        match self {
            Self::Mirroring => -fluid[row],
            Self::Linear => fluid[0] * x / first,
            Self::Quadratic => {
                fluid[0] * x * (x - second) / (first * (first - second))
                    + fluid[1] * x * (x - first) / (second * (second - first))
            }
            Self::GlobalQuadratic => {
                let width = fluid.len() as f64;
                fluid[0] * x * (width - x) / (first * (width - first))
            }
        }
    }
}

/// What is wrong with a channel.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WallError {
    /// The particles.
    #[error(transparent)]
    Place(#[from] PlaceError),
    /// The viscous term of the rows has no inverse.
    #[error("the viscous term has no steady flow: the equations of the {rows} rows are singular")]
    Singular {
        /// Rows.
        rows: usize,
    },
}

/// What a particle of the channel is.
#[derive(Debug, Clone, Copy)]
enum Role {
    Fluid(usize),
    /// Distance behind the wall, the row mirrored counted from that wall, whether it is the upper wall.
    Virtual(f64, usize, bool),
    OnWall,
}

/// A channel full of particles.
pub struct Channel {
    placed: Placed,
    roles: Vec<Role>,
    rows: usize,
}

impl Channel {
    /// A channel of `rows` rows with a support of `support` Δ, volumes 1/ΣW.
    ///
    /// # Errors
    /// [`WallError`].
    pub fn new(kernel: &Kernel, support: f64, rows: usize, on_wall: bool) -> Result<Self, WallError> {
        let half = 0.5 * rows as f64;
        let columns = (2.0 * support).ceil() as usize + 2;
        let depth = ((3.0 * support).ceil() as usize).min(rows);
        let mut levels: Vec<(f64, Role)> = Vec::new();
        for k in 0..depth {
            let s = k as f64 + 0.5;
            levels.push((-half - s, Role::Virtual(s, k, false)));
            levels.push((half + s, Role::Virtual(s, k, true)));
        }
        levels.extend((0..rows).map(|k| (k as f64 + 0.5 - half, Role::Fluid(k))));
        if on_wall {
            levels.extend([-half, half].map(|y| (y, Role::OnWall)));
        }
        let (mut places, mut roles) = (Vec::new(), Vec::new());
        for (y, role) in levels {
            for column in 0..columns {
                places.push([column as f64 + 0.5, y, 0.0]);
                roles.push(role);
            }
        }
        let count = places.len();
        let periods = [Some(columns as f64), None, None];
        let cloud = |places: Vec<[f64; 3]>, volumes: Vec<f64>| {
            Cloud::new(2, places, volumes, Support::Uniform(support))
                .and_then(|cloud| cloud.with_periods(periods))
                .map_err(PlaceError::from)
        };
        let bare = cloud(places.clone(), vec![1.0; count])?;
        let lists = Neighbours::search(&bare).map_err(PlaceError::from)?;
        let volumes = number_volumes(kernel, &bare, &lists);
        let cloud = cloud(places, volumes.clone())?
            .with_field("density", vec![1.0; count])
            .and_then(|cloud| cloud.with_field("mass", volumes))
            .and_then(|cloud| cloud.with_field("viscosity", vec![1.0; count]))
            .map_err(PlaceError::from)?;
        // One particle of each row, from the lower wall up.
        let inner = (0..rows).filter_map(|row| {
            roles.iter().position(|role| matches!(role, Role::Fluid(known) if *known == row))
        });
        let inner = inner.collect();
        Ok(Self { placed: Placed { cloud, lists, inner }, roles, rows })
    }

    /// Velocities of all particles, from those of the rows.
    fn velocities(&self, wall: Wall, fluid: &[f64]) -> Vec<f64> {
        let turned: Vec<f64> = fluid.iter().rev().copied().collect();
        let of = |role: &Role| match *role {
            Role::Fluid(row) => fluid[row],
            Role::OnWall => 0.0,
            Role::Virtual(s, row, upper) => wall.behind(s, row, if upper { &turned } else { fluid }),
        };
        self.roles.iter().map(of).collect()
    }

    /// The viscous term along the channel, row by row, for velocities given row by row, in 1/Δ².
    ///
    /// # Errors
    /// [`WallError`].
    pub fn viscous_term(
        &self,
        kernel: &Kernel,
        model: &Operator,
        wall: Wall,
        fluid: &[f64],
    ) -> Result<Vec<f64>, WallError> {
        let program = Program::new(model, kernel, 2).map_err(PlaceError::from)?;
        self.apply(&program, model.field, wall, fluid)
    }

    fn apply(
        &self,
        program: &Program,
        field: Field,
        wall: Wall,
        fluid: &[f64],
    ) -> Result<Vec<f64>, WallError> {
        let scalar = self.velocities(wall, fluid);
        let vector: Vec<[f64; 3]> = scalar.iter().map(|u| [*u, 0.0, 0.0]).collect();
        let fields = match field {
            Field::Scalar => Fields::Scalar(&scalar),
            Field::Vector => Fields::Vector(&vector),
        };
        Ok(self.placed.apply(program, fields)?.into_iter().map(|value| value[0]).collect())
    }

    /// The steady velocities, row by row, under a body force that the viscous term balances: ⟨ν∇²u⟩ = −1 in 1/Δ².
    ///
    /// # Errors
    /// [`WallError`].
    pub fn steady_flow(&self, kernel: &Kernel, model: &Operator, wall: Wall) -> Result<Vec<f64>, WallError> {
        let program = Program::new(model, kernel, 2).map_err(PlaceError::from)?;
        let mut matrix = vec![vec![0.0; self.rows]; self.rows];
        for column in 0..self.rows {
            let mut unit = vec![0.0; self.rows];
            unit[column] = 1.0;
            let values = self.apply(&program, model.field, wall, &unit)?;
            for (row, value) in matrix.iter_mut().zip(values) {
                row[column] = value;
            }
        }
        match solve(&matrix, &vec![-1.0; self.rows], &vec![1.0; self.rows]) {
            Solution::One(velocities) => Ok(velocities),
            _ => Err(WallError::Singular { rows: self.rows }),
        }
    }

    /// y of the rows in half-widths d, from the lower wall at −1.
    pub fn heights(&self) -> Vec<f64> {
        let half = 0.5 * self.rows as f64;
        (0..self.rows).map(|row| (row as f64 + 0.5 - half) / half).collect()
    }

    /// y in half-widths and velocity of all particles of a column, upwards: what the fluid sees.
    pub fn seen(&self, wall: Wall, fluid: &[f64]) -> Vec<[f64; 2]> {
        let half = 0.5 * self.rows as f64;
        let velocities = self.velocities(wall, fluid);
        let first = self.placed.cloud.positions().iter().zip(velocities).filter(|(x, _)| x[0] == 0.5);
        let mut column: Vec<[f64; 2]> = first.map(|(x, u)| [x[1] / half, u]).collect();
        column.sort_by(|a, b| a[0].total_cmp(&b[0]));
        column
    }
}
