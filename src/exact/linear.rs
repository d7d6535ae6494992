//! Small linear systems over any [`Number`]: Gaussian elimination with full pivoting.

use super::Number;

/// What a system of equations has.
#[derive(Debug, Clone, PartialEq)]
pub enum Solution<T> {
    /// One solution.
    One(Vec<T>),
    /// Many: the matrix has this rank; this is the one of least norm Σ w_k x_k².
    Least {
        /// The solution of least norm.
        solution: Vec<T>,
        /// Rank of the matrix.
        rank: usize,
    },
    /// None: the matrix has this rank and the right side is outside its range.
    None {
        /// Rank of the matrix.
        rank: usize,
    },
}

/// Solves A x = b for a square A given by rows; `weights` are the positive w_k of the norm.
pub fn solve<T: Number>(matrix: &[Vec<T>], right: &[T], weights: &[T]) -> Solution<T> {
    let (solution, rank, consistent) = eliminate(matrix, right);
    if rank == matrix.len() {
        return Solution::One(solution);
    }
    if !consistent {
        return Solution::None { rank };
    }
    // x = W⁻¹ Aᵀ λ with (A W⁻¹ Aᵀ) λ = b.
    let n = matrix.len();
    let product = |row: &[T], other: &[T]| {
        (0..n).fold(T::nought(), |sum, k| sum + row[k].clone() * other[k].clone() / weights[k].clone())
    };
    let normal: Vec<Vec<T>> =
        matrix.iter().map(|row| matrix.iter().map(|other| product(row, other)).collect()).collect();
    let (lambda, ..) = eliminate(&normal, right);
    let solution = (0..n).map(|k| {
        let sum = (0..n).fold(T::nought(), |sum, row| sum + matrix[row][k].clone() * lambda[row].clone());
        sum / weights[k].clone()
    });
    Solution::Least { solution: solution.collect(), rank }
}

/// The inverse, or the rank of a matrix that has none.
///
/// # Errors
/// The rank, if it is less than the number of rows.
pub fn inverse<T: Number>(matrix: &[Vec<T>]) -> Result<Vec<Vec<T>>, usize> {
    let n = matrix.len();
    let one = T::from_rational(&super::int(1));
    let mut columns = Vec::with_capacity(n);
    for column in 0..n {
        let unit: Vec<T> = (0..n).map(|k| if k == column { one.clone() } else { T::nought() }).collect();
        let (solution, rank, _) = eliminate(matrix, &unit);
        if rank < n {
            return Err(rank);
        }
        columns.push(solution);
    }
    Ok((0..n).map(|row| columns.iter().map(|column| column[row].clone()).collect()).collect())
}

/// A solution with zeros for what is free, the rank, and whether the equations that are left hold.
fn eliminate<T: Number>(matrix: &[Vec<T>], right: &[T]) -> (Vec<T>, usize, bool) {
    let n = matrix.len();
    let mut rows: Vec<Vec<T>> = matrix.to_vec();
    let mut b = right.to_vec();
    let largest = rows.iter().flatten().map(T::size).fold(0.0, f64::max);
    let scale = b.iter().map(T::size).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..n).collect();
    let mut rank = 0;
    while rank < n {
        let entries = (rank..n).flat_map(|r| (rank..n).map(move |c| (r, c)));
        let pivot = entries.max_by(|a, b| rows[a.0][a.1].size().total_cmp(&rows[b.0][b.1].size()));
        let Some((r, c)) = pivot.filter(|(r, c)| rows[*r][*c].size() > T::SINGULAR * largest) else { break };
        rows.swap(rank, r);
        b.swap(rank, r);
        for row in &mut rows {
            row.swap(rank, c);
        }
        order.swap(rank, c);
        for below in rank + 1..n {
            let factor = rows[below][rank].clone() / rows[rank][rank].clone();
            if factor.is_nought() {
                continue;
            }
            let (above, rest) = rows.split_at_mut(below);
            for (entry, pivot) in rest[0].iter_mut().zip(&above[rank]).skip(rank) {
                *entry = entry.clone() - factor.clone() * pivot.clone();
            }
            b[below] = b[below].clone() - factor * b[rank].clone();
        }
        rank += 1;
    }
    let consistent = b[rank..].iter().all(|rest| rest.size() <= 1e3 * T::SINGULAR * scale);
    let mut x = vec![T::nought(); n];
    for row in (0..rank).rev() {
        let known = (row + 1..rank)
            .fold(T::nought(), |sum, column| sum + rows[row][column].clone() * x[order[column]].clone());
        x[order[row]] = (b[row].clone() - known) / rows[row][row].clone();
    }
    (x, rank, consistent)
}

#[cfg(test)]
mod tests {
    use super::super::{Rational, int, ratio};
    use super::*;

    #[test]
    fn solves_inverts_and_tells_what_it_cannot() {
        let a = vec![vec![int(0), int(2)], vec![int(3), int(1)]];
        let one = vec![int(1), int(1)];
        assert_eq!(solve(&a, &[int(2), int(4)], &one), Solution::One(vec![int(1), int(1)]));
        assert_eq!(inverse(&a), Ok(vec![vec![ratio(-1, 6), ratio(1, 3)], vec![ratio(1, 2), int(0)]]));
        let line = vec![vec![int(1), int(1)], vec![int(1), int(1)]];
        assert_eq!(inverse(&line), Err(1));
        assert_eq!(solve(&line, &[int(1), int(2)], &one), Solution::None { rank: 1 });
        // x + y = 3 with the least x² + 2y².
        let weights = [int(1), int(2)];
        let least: Solution<Rational> = solve(&line, &[int(3), int(3)], &weights);
        assert_eq!(least, Solution::Least { solution: vec![int(2), int(1)], rank: 1 });
    }
}
