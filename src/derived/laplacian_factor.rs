//! By what a bare pairwise Laplacian multiplies u″ in the continuum.
//!
//! With v_ab = u″ x²/2 e_x + O(x³), r∇W = W′ r̂ r̂ and ∫ r W′ dV = −D, over directions n uniform on the sphere:
//!
//! - Chaussonnet et al. (2015), Eq. (30) without 1/π: 2 (D + 2) ½ ⟨n_x⁴⟩ D J u″, ⟨n_x⁴⟩ = 3/(D (D + 2)): 3 J u″ in every
//!   dimension. It approximates ∇²v + 2 ∇(∇·v), whose x component is 3 u″ on (u(x), 0, 0).
//! - Eq. (31): 2 ½ ⟨n_x²⟩ D J u″ = J u″.
//!
//! J = −(1/D) ∫ r W′ r²/(r² + θ²) dV is 1 without the regularisation θ.

use super::quadrature::gauss_legendre;
use crate::exact::rational_to_f64;
use crate::kernel::{Evaluator, Kernel, Profile};
use std::f64::consts::PI;

/// Nodes of the rule on each panel, and panels between two knots.
const NODES: usize = 16;
const PANELS: usize = 16;

/// J with θ² = `theta_square` h².
///
/// # Examples
/// ```
/// use remainder::{derived::regularisation_factor, kernel};
/// let kernel = kernel::by_id("quintic-spline").unwrap();
/// assert!((regularisation_factor(&kernel, 2, 0.0) - 1.0).abs() < 1e-13);
/// assert!(regularisation_factor(&kernel, 2, 0.01) < 1.0);
/// ```
pub fn regularisation_factor(kernel: &Kernel, dimension: usize, theta_square: f64) -> f64 {
    let evaluator: Evaluator<f64> = Evaluator::new(kernel, dimension, 1);
    let kappa = rational_to_f64(kernel.support_over_h());
    // Lengths in units of R: G_1 = F′/x, so that r W′ = x² G_1.
    let theta_square = theta_square / (kappa * kappa);
    let knots: Vec<f64> = match kernel.profile() {
        Profile::Polynomial(profile) => profile.knots().iter().map(|q| rational_to_f64(q) / kappa).collect(),
        Profile::Gaussian { .. } => vec![0.0, 1.0],
    };
    let surface = [2.0, 2.0 * PI, 4.0 * PI][dimension - 1];
    let rule = gauss_legendre(NODES);
    let mut integral = 0.0;
    for pair in knots.windows(2) {
        let width = (pair[1] - pair[0]) / PANELS as f64;
        for panel in 0..PANELS {
            let from = pair[0] + panel as f64 * width;
            for (node, weight) in rule.iter() {
                let x = from + 0.5 * width * (1.0 + node);
                let area = (1..dimension).fold(surface, |area, _| area * x);
                let [_, g1, ..] = evaluator.radial(x);
                integral += 0.5 * width * weight * area * x * x * g1 * (x * x / (x * x + theta_square));
            }
        }
    }
    -integral / dimension as f64
}
