//! From derived moments to the errors that the paper defines.
//!
//! With δ = Δ/L, e.g. of the x component: a gradient Σ V_b (φ_b + K φ_a) ∇W has on F₁ the error (1 + K) ξ_a S L + (M − 1), on F₂ relative to
//! the local gradient ½ (1 + K) ξ_a S L + (M − 1) + Q/(ξ_a L), with S = ΣV∇W, M = ΣV x ∇W, Q = ½ΣV x² ∇W, x = x_b − x_a. S and Q
//! are odd under inversion, M is even, so that M is uncorrelated with both; the correlation of S and Q, of relative size δ², is left out.
//! Laplacians: T L on U₁ and ξ_a T L + (P − 1) on U₂, T and P what they make of x and x²/2.

use super::compute::{Component, Moments};
use std::f64::consts::PI;

/// Where errors are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub eta: f64,
    /// Δ/L.
    pub dx_over_size: f64,
    /// ⟨ξ²⟩ over the inner particles.
    pub xi_square: f64,
    /// ⟨ξ⁻²⟩.
    pub xi_inverse_square: f64,
}

/// Derived errors under one disorder law and volume rule on one lattice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Model<'a>(pub &'a Moments);

impl Model<'_> {
    pub(super) fn component(&self, subject: &str, axis: usize) -> Component {
        self.0.get(subject).and_then(|components| components.get(axis)).copied().unwrap_or_default()
    }

    /// ⟨e²⟩ of a component divided by `factor`, with `off` taken from its regular value.
    fn square(component: Component, eta: f64, factor: f64, off: f64) -> f64 {
        let regular = (component.regular + off) / factor;
        let shift = component.shift / factor * eta * eta;
        let variance = component.variance / (factor * factor) * eta * eta;
        regular * regular + 2.0 * regular * shift + variance
    }

    /// The deviation of ΣV∇W · Δ per η.
    pub(super) fn gradient_of_one(&self, axis: usize) -> f64 {
        self.component("G0[0]", axis).variance.sqrt()
    }

    /// The deviation of what a Laplacian makes of x, times Δ, per η.
    pub(super) fn laplacian_of_x(&self, operator: &str, axis: usize) -> f64 {
        let (name, factor, _) = laplacian(operator);
        self.component(&format!("{name}[1]"), axis).variance.sqrt() / factor
    }

    /// Λ or Ω by operator, field (0, 1, 2) and axis.
    pub(super) fn error(&self, operator: &str, field: u8, axis: usize, place: Place) -> f64 {
        let square = match operator {
            "G0" | "G+" | "G-" => self.gradient(operator, field, axis, place),
            _ => self.laplacian(operator, field, axis, place),
        };
        square.max(0.0).sqrt()
    }

    fn gradient(&self, operator: &str, field: u8, axis: usize, place: Place) -> f64 {
        let Place { eta, dx_over_size, xi_square, xi_inverse_square } = place;
        let k = match operator {
            "G-" => 0.0,
            "G0" => 1.0,
            _ => 2.0,
        };
        let s = k * k * self.component("G0[0]", axis).variance * eta * eta / (dx_over_size * dx_over_size);
        let m = Self::square(self.component("G-[1]", axis), eta, 1.0, 0.0);
        match field {
            0 => s,
            1 => xi_square * s + m,
            _ => {
                let q = self.component("G-[2]", axis).variance * eta * eta * dx_over_size * dx_over_size;
                0.25 * xi_square * s + m + q * xi_inverse_square
            }
        }
    }

    fn laplacian(&self, operator: &str, field: u8, axis: usize, place: Place) -> f64 {
        let (name, factor, target) = laplacian(operator);
        let along = self.component(&format!("{name}[1]"), axis).variance / (factor * factor);
        let t = along * place.eta * place.eta / (place.dx_over_size * place.dx_over_size);
        match field {
            0 => 0.0,
            1 => t,
            _ => {
                // The derived error has its own target taken off: 3 u″ of MCG.
                let off = if axis == 0 { target - factor } else { 0.0 };
                let p = self.component(&format!("{name}[2]"), axis);
                place.xi_square * t + Self::square(p, place.eta, factor, off)
            }
        }
    }

    /// By what a bare Laplacian multiplies u″ on this lattice: MCG with 2 (D + 2), without 1/π.
    pub(super) fn factor(&self, operator: &str) -> f64 {
        let (name, _, target) = laplacian(operator);
        target + self.component(&format!("{name}[2]"), 0).regular
    }

    /// E by name, at η.
    pub(super) fn consistency(&self, name: &str, eta: f64, h_over_dx: f64) -> f64 {
        let (moment, unit) = match name {
            "E_0^0" => ("sum_w", 1.0),
            "E_0^1" => ("sum_dw", h_over_dx),
            "E_1^0" => ("sum_rw", 1.0 / h_over_dx),
            _ => ("b_inverse", 1.0),
        };
        let components = self.0.get(moment).map(Vec::as_slice).unwrap_or_default();
        let sum: f64 = components.iter().map(|component| Self::square(*component, eta, 1.0, 0.0)).sum();
        unit * sum.max(0.0).sqrt()
    }
}

/// The derived operator behind a name, what its value is divided by, and the x component of what it approximates on
/// (x²/2, 0, 0).
fn laplacian(operator: &str) -> (&'static str, f64, f64) {
    match operator {
        "MCG-pi" => ("MCG", PI, 3.0),
        "MCG" => ("MCG", 1.0, 3.0),
        _ => ("MEA", 1.0, 1.0),
    }
}
