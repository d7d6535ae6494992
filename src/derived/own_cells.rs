//! Σ V_b W′(x_a − x_b) on a line whose particles are displaced, to first order in the displacements: Eq. (15) of Basa et al.
//! (2009) derived.
//!
//! With V = Δ what multiplies d_b is −Δ W″(x_ab), of size Δ/h³ for each of 2R/Δ particles: independent displacements add up to
//! ξ (F/h) (Δ/h)^{3/2}. With V_b = (x_{b+1} − x_{b−1})/2, the particle's own cell, the sum is the trapezoidal rule and what
//! multiplies d_b is
//!
//! ```text
//! −Δ W″(x_ab) + ½ [W′(x_a − x_{b−1}) − W′(x_a − x_{b+1})] = Δ³/6 W⁗ + …
//! ```
//!
//! which leaves (Δ/h)^{7/2} from smooth stretches, and (Δ/h)^m from a knot, R or the origin, where the m-th derivative of W jumps:
//! few particles, but Δ² [W^{(m)}] Δ^{m−3} each. In second order −(Δ/4) Σ (d_{b+1} − d_b)² W‴ adds up to ξ² (F/h) (Δ/h)^{5/2}
//! with either volume.

use crate::exact::{Rational, int, ratio, rational_to_f64};
use crate::kernel::{Evaluator, Kernel};

/// e of ξ (F/h) (Δ/h)^e for independent displacements, cells of their own or not.
pub fn row_exponent(kernel: &Kernel, own_cells: bool) -> Rational {
    if !own_cells {
        return ratio(3, 2);
    }
    let knots = kernel.jumps().into_iter().filter_map(|jump| jump.order);
    let lowest = knots.chain(kernel.first_odd_power()).min();
    let knot = lowest.map_or_else(|| ratio(7, 2), |order| int(order as i64));
    knot.min(ratio(7, 2))
}

/// e of ξ² (F/h) (Δ/h)^e.
pub fn row_second_exponent() -> Rational {
    ratio(5, 2)
}

/// e of the error of ⟨∂x/∂x⟩ on a regular line, for any R/Δ or for knots that all stand at particles or half-way between two,
/// by Euler & Maclaurin. x W′ and its derivatives up to the (β − 1)-th vanish at R; a jump of its k-th leaves
/// Δ^{k+1} B_{k+1}({R/Δ}), and B of an odd index vanishes at 0 and at 1/2. B-splines at whole h/Δ are exact beyond that.
pub fn row_regular_exponent(kernel: &Kernel, aligned: bool) -> i64 {
    // The derivative of x W′ that jumps at each knot is one lower than that of W; at the origin x W′ has the power s itself.
    let knots = kernel.jumps().into_iter().filter_map(|jump| jump.order).map(|order| order as i64 - 1);
    let at_knots = knots.map(|k| if aligned && k % 2 == 0 { k + 2 } else { k + 1 });
    let origin = kernel.first_odd_power().map(|power| power as i64 + 1);
    at_knots.chain(origin).min().unwrap_or(i64::MAX)
}

/// The root mean square of the sum over independent displacements of root mean square ξΔ, to first order in ξ, over ξ F/h.
/// Lengths of the line are in Δ; the particle itself moves too.
pub fn row_amplitude(kernel: &Kernel, support: f64, own_cells: bool) -> f64 {
    let evaluator = Evaluator::<f64>::new(kernel, 1, 2);
    let slope = |x: f64| {
        let distance = (x / support).abs();
        if distance < 1.0 { evaluator.radial(distance)[1] * x / (support * support * support) } else { 0.0 }
    };
    let curvature = |x: f64| {
        let distance = (x / support).abs();
        if distance >= 1.0 {
            return 0.0;
        }
        let [_, g1, g2, _, _] = evaluator.radial(distance);
        (g1 + distance * distance * g2) / (support * support * support)
    };
    let reach = support as i64 + 2;
    let (mut squares, mut own) = (0.0, 0.0);
    for b in -reach..=reach {
        let x = -(b as f64);
        own += curvature(x);
        let cells = if own_cells { 0.5 * (slope(x + 1.0) - slope(x - 1.0)) } else { 0.0 };
        if b != 0 {
            let weight = cells - curvature(x);
            squares += weight * weight;
        }
    }
    // Particle a: what it takes from each pair, its own cell's share, but not its distance from itself.
    own -= curvature(0.0);
    let own_cell = if own_cells { 0.5 * (slope(1.0) - slope(-1.0)) } else { 0.0 };
    squares += (own + own_cell) * (own + own_cell);
    support / rational_to_f64(kernel.support_over_h()) * squares.sqrt()
}
