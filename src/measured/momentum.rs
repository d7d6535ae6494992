//! Total forces and torques of an isolated body of particles: what is conserved, measured.

use super::placed::{PlaceError, Placed};
use super::program::{Fields, Program};
use crate::kernel::Kernel;
use crate::language::{Field, Operator};

/// |Σ m_i a_i| and |Σ m_i r_i × a_i|, over the sums of the magnitudes of their terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// Of the forces.
    pub linear: f64,
    /// Of the torques.
    pub angular: f64,
}

/// The totals of an acceleration over all particles of a cloud in two or three dimensions, on a field without symmetry.
///
/// # Errors
/// [`PlaceError`].
pub fn totals(placed: &Placed, kernel: &Kernel, operator: &Operator) -> Result<Totals, PlaceError> {
    let cloud = &placed.cloud;
    let dimension = cloud.dimension();
    let program = Program::new(operator, kernel, dimension)?;
    let scalar: Vec<f64> = cloud.positions().iter().map(|x| 2.0 + bump(x, 0.3) + 0.1 * x[0]).collect();
    let vector: Vec<[f64; 3]> = cloud
        .positions()
        .iter()
        .map(|x| [bump(x, 0.3) + 0.1 * x[1], bump(x, 1.1) - 0.05 * x[0], 0.0])
        .collect();
    let fields = match operator.field {
        Field::Scalar => Fields::Scalar(&scalar),
        Field::Vector => Fields::Vector(&vector),
    };
    let values = program.apply(cloud, &placed.lists, fields)?;
    let mass = cloud.field("mass").unwrap_or_else(|| cloud.volumes());
    let (mut force, mut torque, mut forces, mut torques) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
    for ((a, x), m) in values.chunks_exact(dimension).zip(cloud.positions()).zip(mass) {
        let mut f = [0.0; 3];
        for (f, a) in f.iter_mut().zip(a) {
            *f = m * a;
        }
        let t = [x[1] * f[2] - x[2] * f[1], x[2] * f[0] - x[0] * f[2], x[0] * f[1] - x[1] * f[0]];
        for axis in 0..3 {
            force[axis] += f[axis];
            torque[axis] += t[axis];
        }
        forces += length(&f);
        torques += length(&t);
    }
    Ok(Totals { linear: length(&force) / forces, angular: length(&torque) / torques })
}

fn length(x: &[f64; 3]) -> f64 {
    (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
}

/// A smooth function without symmetry: a polynomial over a polynomial, so that every machine gives the same bits.
fn bump(x: &[f64; 3], shift: f64) -> f64 {
    let (a, b) = (0.2 * x[0] - shift, 0.2 * x[1] + 0.5 * shift);
    (1.0 + a * b + 0.5 * a) / (1.0 + a * a + b * b)
}
