//! The exact solution of u′ = A u + b up to a tolerance: u(t) = e^{tA} u₀ + ∫ e^{sA} b ds, by Arnoldi's method on the
//! system with one unknown more, u₀ ↦ (u₀, 1), in as many pieces of time as the error estimate asks for (R. B. Sidje, ACM
//! Trans. Math. Softw. 24 (1998) 130–156).

use super::matrix::{add, dot, norm};
use super::{EvolveError, System};
use nalgebra::DMatrix;

/// Dimension of the Krylov spaces.
const SPACE: usize = 40;

/// u(t) from u(0) = `u`, with an error of about `tolerance` times the norm of the solution; and products with the matrix.
///
/// # Errors
/// [`EvolveError::Step`] for a time that is not positive and finite.
pub fn exponential(
    system: &System,
    u: &[f64],
    time: f64,
    tolerance: f64,
) -> Result<(Vec<f64>, u64), EvolveError> {
    if !(time.is_finite() && time > 0.0) {
        return Err(EvolveError::Step { step: time });
    }
    let count = u.len();
    // The last unknown is 1 and stays so.
    let product = |v: &[f64]| {
        let mut out = vec![0.0; count + 1];
        let last = v[count];
        system.matrix.rows_with(&v[..count], &mut out[..count], |i, value| value + last * system.source[i]);
        out
    };
    let mut w: Vec<f64> = u.iter().copied().chain([1.0]).collect();
    let (mut now, mut products) = (0.0, 0);
    let mut piece = time;
    while now < time {
        let beta = norm(&w);
        let mut basis = vec![w.iter().map(|w| w / beta).collect::<Vec<f64>>()];
        let mut h = DMatrix::<f64>::zeros(SPACE + 2, SPACE + 2);
        let mut size = SPACE;
        for j in 0..SPACE {
            let mut p = product(&basis[j]);
            products += 1;
            for (i, v) in basis.iter().enumerate() {
                let along = dot(v, &p);
                h[(i, j)] = along;
                add(&mut p, -along, v);
            }
            let rest = norm(&p);
            if rest <= 1e-14 * h[(j, j)].abs().max(f64::MIN_POSITIVE) {
                size = j + 1;
                break;
            }
            h[(j + 1, j)] = rest;
            basis.push(p.iter().map(|p| p / rest).collect());
        }
        let exact = size < SPACE;
        piece = piece.min(time - now);
        let weights = loop {
            let (weights, error) = small(&h, size, exact, piece);
            let allowed = tolerance * piece / time;
            if exact || error <= allowed || piece < 1e-14 * time {
                let grow = if error > 0.0 { 0.9 * (allowed / error).powf(1.0 / size as f64) } else { 5.0 };
                now += piece;
                piece *= grow.clamp(0.5, 5.0);
                break weights;
            }
            piece *= (0.9 * (allowed / error).powf(1.0 / size as f64)).clamp(0.1, 0.9);
        };
        let mut next = vec![0.0; count + 1];
        for (weight, v) in weights.iter().zip(&basis) {
            add(&mut next, beta * weight, v);
        }
        w = next;
        // Rounding must not let the constant drift.
        w[count] = 1.0;
        if time - now < 1e-14 * time {
            break;
        }
    }
    w.truncate(count);
    Ok((w, products))
}

/// The first column of e^{piece H}, and the size of what the next vector of the basis would add.
fn small(h: &DMatrix<f64>, size: usize, exact: bool, piece: f64) -> (Vec<f64>, f64) {
    if exact {
        let e = (h.view((0, 0), (size, size)) * piece).exp();
        return (e.column(0).iter().copied().collect(), 0.0);
    }
    // With a row more, the entry below the square is what φ₁ brings along the next vector.
    let mut wider = h.view((0, 0), (size + 1, size + 1)).into_owned();
    wider.fill_column(size, 0.0);
    let e = (wider * piece).exp();
    (e.column(0).iter().copied().collect(), e[(size, 0)].abs())
}
