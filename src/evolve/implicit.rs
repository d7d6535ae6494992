//! Implicit methods: implicit Euler, and TR-BDF2 with γ = 2 − √2, which is L-stable and of second order (R. E. Bank et al.,
//! IEEE Trans. Comput.-Aided Des. 4 (1985) 436–451). The systems are solved by BiCGSTAB (H. A. van der Vorst, SIAM J. Sci. Stat.
//! Comput. 13 (1992) 631–644) with an incomplete factorisation on the pattern of the matrix.

use super::matrix::{add, dot, norm};
use super::{EvolveError, Matrix, System};

/// An implicit method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Implicit {
    /// Implicit Euler, of order one.
    Euler,
    /// A trapezoidal stage, then BDF2: L-stable, of order two.
    TrBdf2,
}

impl Implicit {
    /// The name used in scenes and reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::Euler => "implicit-euler",
            Self::TrBdf2 => "tr-bdf2",
        }
    }
}

/// Relative residual at which a solution is accepted.
const TOLERANCE: f64 = 1e-12;

/// The most iterations.
const MOST: usize = 2000;

/// I − factor · A with its incomplete factors.
#[derive(Debug, Clone)]
pub struct Solver {
    matrix: Matrix,
    factors: Vec<f64>,
    diagonal: Vec<usize>,
    /// Products with the matrix so far.
    pub products: u64,
}

impl Solver {
    /// For (`shift` I − `factor` A) x = b.
    ///
    /// # Errors
    /// [`EvolveError::Pivot`].
    pub fn new(a: &Matrix, shift: f64, factor: f64) -> Result<Self, EvolveError> {
        let rows = (0..a.len()).map(|i| {
            let mut row: Vec<(u32, f64)> = a.row(i).map(|(j, value)| (j as u32, -factor * value)).collect();
            row.push((i as u32, shift));
            row
        });
        let matrix = Matrix::from_rows(a.width(), rows);
        let (starts, columns, values) = matrix.parts();
        let mut factors = values.to_vec();
        let mut diagonal = vec![0; matrix.len()];
        // Where in `factors` the columns of the row in hand stand.
        let mut place = vec![usize::MAX; matrix.width()];
        for i in 0..matrix.len() {
            let range = starts[i] as usize..starts[i + 1] as usize;
            for k in range.clone() {
                place[columns[k] as usize] = k;
            }
            for k in range.clone() {
                let j = columns[k] as usize;
                if j >= i {
                    break;
                }
                let ratio = factors[k] / factors[diagonal[j]];
                factors[k] = ratio;
                for l in diagonal[j] + 1..starts[j + 1] as usize {
                    let at = place[columns[l] as usize];
                    if at != usize::MAX {
                        factors[at] -= ratio * factors[l];
                    }
                }
            }
            diagonal[i] = place[i];
            if diagonal[i] == usize::MAX || factors[diagonal[i]] == 0.0 {
                return Err(EvolveError::Pivot { row: i });
            }
            for k in range {
                place[columns[k] as usize] = usize::MAX;
            }
        }
        Ok(Self { matrix, factors, diagonal, products: 0 })
    }

    fn precondition(&self, b: &[f64]) -> Vec<f64> {
        let (starts, columns, _) = self.matrix.parts();
        let mut x = b.to_vec();
        for i in 0..x.len() {
            let known =
                (starts[i] as usize..self.diagonal[i]).map(|k| self.factors[k] * x[columns[k] as usize]);
            x[i] -= known.sum::<f64>();
        }
        for i in (0..x.len()).rev() {
            let known = (self.diagonal[i] + 1..starts[i + 1] as usize)
                .map(|k| self.factors[k] * x[columns[k] as usize]);
            let sum: f64 = known.sum();
            x[i] = (x[i] - sum) / self.factors[self.diagonal[i]];
        }
        x
    }

    /// Solves, starting from `x`.
    ///
    /// # Errors
    /// [`EvolveError::NotSolved`].
    pub fn solve(&mut self, b: &[f64], x: &mut [f64]) -> Result<(), EvolveError> {
        let scale = norm(b);
        if scale == 0.0 {
            x.fill(0.0);
            return Ok(());
        }
        let mut r = b.to_vec();
        add(&mut r, -1.0, &self.matrix.apply(x));
        self.products += 1;
        let mut residual = norm(&r) / scale;
        let shadow = r.clone();
        let (mut rho, mut alpha, mut omega) = (1.0, 1.0, 1.0);
        let (mut p, mut v) = (vec![0.0; r.len()], vec![0.0; r.len()]);
        for _ in 0..MOST {
            if residual <= TOLERANCE {
                return Ok(());
            }
            let next = dot(&shadow, &r);
            let beta = next / rho * (alpha / omega);
            rho = next;
            for i in 0..p.len() {
                p[i] = r[i] + beta * (p[i] - omega * v[i]);
            }
            let y = self.precondition(&p);
            v = self.matrix.apply(&y);
            alpha = rho / dot(&shadow, &v);
            add(x, alpha, &y);
            add(&mut r, -alpha, &v);
            let z = self.precondition(&r);
            let t = self.matrix.apply(&z);
            omega = dot(&t, &r) / dot(&t, &t).max(f64::MIN_POSITIVE);
            add(x, omega, &z);
            add(&mut r, -omega, &t);
            self.products += 2;
            residual = norm(&r) / scale;
            if !residual.is_finite() {
                break;
            }
        }
        // Rounding may keep the residual that is carried along from the one that is.
        if residual <= 1e3 * TOLERANCE {
            return Ok(());
        }
        Err(EvolveError::NotSolved { residual, iterations: MOST })
    }
}

/// Takes `steps` steps of length `step` from `u`; products with the matrix.
///
/// # Errors
/// [`EvolveError::Step`], and as [`Solver`] has them.
pub fn march_implicit(
    system: &System,
    method: Implicit,
    u: &mut Vec<f64>,
    step: f64,
    steps: u64,
) -> Result<u64, EvolveError> {
    if !(step.is_finite() && step > 0.0) {
        return Err(EvolveError::Step { step });
    }
    let gamma = 2.0 - 2.0_f64.sqrt();
    let factor = match method {
        Implicit::Euler => step,
        Implicit::TrBdf2 => 0.5 * gamma * step,
    };
    let mut solver = Solver::new(&system.matrix, 1.0, factor)?;
    for _ in 0..steps {
        match method {
            Implicit::Euler => {
                let mut b = u.clone();
                add(&mut b, step, &system.source);
                solver.solve(&b, u)?;
            }
            Implicit::TrBdf2 => {
                let mut b = u.clone();
                add(&mut b, factor, &system.rate(u));
                add(&mut b, factor, &system.source);
                solver.products += 1;
                let mut middle = u.clone();
                solver.solve(&b, &mut middle)?;
                let weight = 1.0 / (gamma * (2.0 - gamma));
                let before = (1.0 - gamma) * (1.0 - gamma) * weight;
                let mut b: Vec<f64> =
                    middle.iter().zip(u.iter()).map(|(m, u)| weight * m - before * u).collect();
                add(&mut b, factor, &system.source);
                u.clone_from(&middle);
                solver.solve(&b, u)?;
            }
        }
    }
    Ok(solver.products)
}

/// The steady solution, A u = −b.
///
/// # Errors
/// As [`Solver`] has them.
pub fn steady(system: &System) -> Result<Vec<f64>, EvolveError> {
    let mut u = vec![0.0; system.source.len()];
    Solver::new(&system.matrix, 0.0, 1.0)?.solve(&system.source, &mut u)?;
    Ok(u)
}
