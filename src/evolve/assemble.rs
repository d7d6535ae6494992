//! An operator as a matrix: on particles that do not move, its weights.

use super::{EvolveError, Matrix};
use crate::measured::Program;
use crate::particles::{Cloud, Neighbours};

/// The rows of the particles at `rows` (ascending), with a column for each particle of the cloud.
///
/// # Errors
/// [`EvolveError::Rank`], and what the particles or the operator lack.
pub fn assemble(program: &Program, cloud: &Cloud, rows: &[usize]) -> Result<Matrix, EvolveError> {
    if program.components() != 1 {
        return Err(EvolveError::Rank { components: program.components() });
    }
    // What needs its neighbours' own sums needs them of all particles.
    let all = program.passes() > 1;
    let lists = if all { Neighbours::search(cloud)? } else { Neighbours::search_at(cloud, rows)? };
    let mut weights = program.weights(cloud, &lists)?.pop().unwrap_or_default();
    let rows = (0..rows.len()).map(|k| std::mem::take(&mut weights[if all { rows[k] } else { k }]));
    Ok(Matrix::from_rows(cloud.len(), rows))
}
