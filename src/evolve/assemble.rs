//! An operator as a matrix, by probing: two particles further apart than twice the reach share no row, so that one field
//! with ones on all particles of a colour gives a column of each of them.

use super::{EvolveError, Matrix};
use crate::measured::{Fields, Program};
use crate::particles::{Cloud, Neighbours, Support};
use rayon::prelude::*;
use std::collections::HashMap;

/// The rows of the particles at `rows` (ascending), with a column for each particle of the cloud.
///
/// # Errors
/// [`EvolveError::Rank`], and what the particles or the operator lack.
pub fn assemble(program: &Program, cloud: &Cloud, rows: &[usize]) -> Result<Matrix, EvolveError> {
    if program.components() != 1 {
        return Err(EvolveError::Rank { components: program.components() });
    }
    let support = cloud.support_of(0);
    let reach = support * program.passes() as f64;
    // What needs its neighbours' own sums needs them of all particles.
    let lists =
        if program.passes() == 1 { Neighbours::search_at(cloud, rows)? } else { Neighbours::search(cloud)? };
    let within_reach = if program.passes() == 1 {
        None
    } else {
        let wider = Cloud::new(
            cloud.dimension(),
            cloud.positions().to_vec(),
            cloud.volumes().to_vec(),
            Support::Uniform(reach),
        )?;
        Some(Neighbours::search_at(&wider, rows)?)
    };
    let pattern = within_reach.as_ref().unwrap_or(&lists);
    let (colours, count) = colour(cloud, 2.0 * reach);
    let columns: Vec<Vec<f64>> = (0..count)
        .map(|colour| {
            let field: Vec<f64> = colours.iter().map(|own| f64::from(u8::from(*own == colour))).collect();
            let values = program.apply(cloud, &lists, Fields::Scalar(&field))?;
            let all = program.passes() > 1;
            Ok(if all { rows.iter().map(|row| values[*row]).collect() } else { values })
        })
        .collect::<Result<_, EvolveError>>()?;
    let entries: Vec<Vec<(u32, f64)>> = (0..rows.len())
        .into_par_iter()
        .map(|k| {
            pattern.of(k).iter().map(|pair| (pair.j, columns[colours[pair.j as usize] as usize][k])).collect()
        })
        .collect();
    Ok(Matrix::from_rows(cloud.len(), entries))
}

/// How often an operator that reaches so far is applied when it is assembled: the number of colours.
pub fn probes(cloud: &Cloud, reach: f64) -> u32 {
    colour(cloud, 2.0 * reach).1
}

/// A colour for each particle such that no two of one colour are closer than `apart`, and how many there are.
fn colour(cloud: &Cloud, apart: f64) -> (Vec<u32>, u32) {
    let dimension = cloud.dimension();
    let cell = |x: &[f64; 3]| x.map(|x| (x / apart).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<(usize, u32)>> = HashMap::new();
    let mut colours = Vec::with_capacity(cloud.len());
    let mut count = 0;
    let offsets = |axis: usize| if axis < dimension { -1..=1 } else { 0..=0 };
    for (i, x) in cloud.positions().iter().enumerate() {
        let own = cell(x);
        let mut taken = vec![false; count as usize + 1];
        for a in offsets(0) {
            for b in offsets(1) {
                for c in offsets(2) {
                    let there = cells.get(&[own[0] + a, own[1] + b, own[2] + c]);
                    for (j, colour) in there.into_iter().flatten() {
                        let y = &cloud.positions()[*j];
                        let square: f64 = x.iter().zip(y).map(|(x, y)| (x - y) * (x - y)).sum();
                        if square < apart * apart {
                            taken[*colour as usize] = true;
                        }
                    }
                }
            }
        }
        let free = taken.iter().position(|taken| !taken).unwrap_or(0) as u32;
        count = count.max(free + 1);
        cells.entry(own).or_default().push((i, free));
        colours.push(free);
    }
    (colours, count)
}
