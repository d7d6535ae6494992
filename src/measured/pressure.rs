//! The truncation error of ∇p under corrections, against the reference pressure (Basa et al. 2009, §§ 3 and 4).
//!
//! p = p₀ + g x + g x²/(2L), lengths in units of some ℓ, g = 1, L = 10 ℓ, on disordered particles of spacing Δ. Errors are the
//! root mean square over particles of |⟨∇p⟩ − ∇p|/g.

use super::placed::{PlaceError, Placed};
use super::program::{Fields, Program};
use crate::exact::rational_to_f64;
use crate::kernel::Kernel;
use crate::language::Operator;
use crate::particles::{Disorder, Lattice, VolumeRule};

/// L/ℓ.
const CURVATURE_LENGTH: f64 = 10.0;

/// How the gradient is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum GradientForm {
    /// ρ_i times Eq. (8).
    Eight,
    /// ρ_i times Eq. (9).
    Nine,
    /// Σ V_j p_j ∇W, Eq. (2).
    Volume,
}

/// What is done about the error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Correction {
    /// Nothing.
    None,
    /// The gradient of the Shepard kernel, Eq. (22).
    Shepard,
    /// The corrected gradient of the corrected kernel, Eqs. (24) to (26).
    FirstOrder,
    /// The mean pressure of the neighbours subtracted, Eq. (20).
    Reduction,
    /// p₀ + g x subtracted, as in Morris et al. (1997).
    Hydrostatic,
}

impl GradientForm {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Eight, Self::Nine, Self::Volume];

    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::Eight => "(8)",
            Self::Nine => "(9)",
            Self::Volume => "volume",
        }
    }

    /// Its text with this gradient of the kernel and this value taken off p.
    fn text(self, gradient: &str, less: &str) -> String {
        match self {
            Self::Eight => {
                format!("rho_i sum_j m_j ((u_i{less}) / rho_i^2 + (u_j{less}) / rho_j^2) {gradient}")
            }
            Self::Nine => format!("sum_j m_j / rho_j ((u_i{less}) + (u_j{less})) {gradient}"),
            Self::Volume => format!("sum_j V_j (u_j{less}) {gradient}"),
        }
    }
}

impl Correction {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::None, Self::Shepard, Self::FirstOrder, Self::Reduction, Self::Hydrostatic];

    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Shepard => "Shepard",
            Self::FirstOrder => "first order",
            Self::Reduction => "pressure reduction",
            Self::Hydrostatic => "hydrostatic",
        }
    }

    /// The operator of a form under it; a hydrostatic pressure is taken off the field instead.
    ///
    /// # Errors
    /// [`PlaceError::Language`] never: the texts are checked by a test.
    pub fn operator(self, form: GradientForm) -> Result<Operator, PlaceError> {
        const SHEPARD: &str =
            "(gradW_ij / (sum_k V_k W_ik) - W_ij (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2)";
        const MATRIX: &str = "inverse(-sum_l V_l (gradW_il / (sum_k V_k W_ik) \
                              - W_il (sum_k V_k gradW_ik) / (sum_k V_k W_ik)^2) r_il)";
        let text = match self {
            Self::None | Self::Hydrostatic => form.text("gradW_ij", ""),
            Self::Shepard => form.text(SHEPARD, ""),
            Self::FirstOrder => format!("{MATRIX} . ({})", form.text(SHEPARD, "")),
            Self::Reduction => form.text("gradW_ij", " - mean_k u_k"),
        };
        Ok(Operator::parse(&text)?)
    }
}

/// What is placed.
#[derive(Debug, Clone)]
pub struct PressureSpec<'a> {
    /// The kernel.
    pub kernel: &'a Kernel,
    /// The lattice.
    pub lattice: &'a Lattice,
    /// R/Δ.
    pub support_over_dx: f64,
    /// V.
    pub rule: VolumeRule,
    /// How particles leave the lattice.
    pub disorder: &'a Disorder,
    /// h/ℓ.
    pub h: f64,
    /// Radius of the ball of particles, in Δ.
    pub radius: f64,
    /// Of the disorder.
    pub seed: u64,
}

/// Errors of one form under one correction.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureErrors {
    /// The form.
    pub form: GradientForm,
    /// The correction.
    pub correction: Correction,
    /// By reference pressure: the root mean square error over g, and its standard error.
    pub errors: Vec<[f64; 2]>,
}

/// How far from zero pressures stand once something is taken off, at one reference pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PressureField {
    /// Root mean square over particles and neighbours of |p_j − p_avg|/(g ℓ).
    pub reduced: f64,
    /// Particles looked at.
    pub particles: usize,
    /// Pairs of particles in the lists.
    pub pairs: u64,
}

/// The errors of every form under every correction, at each reference pressure p₀/(g ℓ).
///
/// # Errors
/// [`PlaceError`].
pub fn pressure_errors(
    spec: &PressureSpec<'_>,
    references: &[f64],
) -> Result<(Vec<PressureErrors>, PressureField), PlaceError> {
    let PressureSpec { kernel, lattice, support_over_dx, rule, disorder, h, radius, seed } = *spec;
    let placed = Placed::disordered(kernel, lattice, support_over_dx, rule, disorder, radius, seed)?;
    let h_over_dx = support_over_dx / rational_to_f64(kernel.support_over_h());
    // Δ/ℓ.
    let dx = h / h_over_dx;
    let dimension = lattice.dimension();
    let positions = placed.cloud.positions();
    let field = |reference: f64, x: f64| reference + dx * x + dx * dx * x * x / (2.0 * CURVATURE_LENGTH);
    let mut all = Vec::new();
    for form in GradientForm::ALL {
        for correction in Correction::ALL {
            let program = Program::new(&correction.operator(form)?, kernel, dimension)?;
            let mut errors = Vec::with_capacity(references.len());
            for reference in references {
                let pressure = |x: &[f64; 3]| {
                    let p = field(*reference, x[0]);
                    if correction == Correction::Hydrostatic { p - (reference + dx * x[0]) } else { p }
                };
                let values: Vec<f64> = positions.iter().map(pressure).collect();
                let found = placed.apply(&program, Fields::Scalar(&values))?;
                let squares = found.iter().zip(&placed.inner).map(|(gradient, i)| {
                    let mut exact = [0.0; 3];
                    exact[0] = dx * positions[*i][0] / CURVATURE_LENGTH;
                    if correction != Correction::Hydrostatic {
                        exact[0] += 1.0;
                    }
                    gradient.iter().zip(exact).map(|(g, e)| (g / dx - e) * (g / dx - e)).sum::<f64>()
                });
                errors.push(root_mean_square(&squares.collect::<Vec<f64>>()));
            }
            all.push(PressureErrors { form, correction, errors });
        }
    }
    Ok((all, pressures(&placed, field)))
}

fn pressures(placed: &Placed, field: impl Fn(f64, f64) -> f64) -> PressureField {
    let positions = placed.cloud.positions();
    let (mut reduced, mut pairs) = (0.0, 0_usize);
    for i in &placed.inner {
        let around: Vec<f64> =
            placed.lists.of(*i).iter().map(|n| field(0.0, positions[n.j as usize][0])).collect();
        let mean = around.iter().sum::<f64>() / around.len() as f64;
        reduced += around.iter().map(|p| (p - mean) * (p - mean)).sum::<f64>();
        pairs += around.len();
    }
    PressureField {
        reduced: (reduced / pairs.max(1) as f64).sqrt(),
        particles: placed.inner.len(),
        pairs: placed.lists.entry_count() as u64,
    }
}

/// √⟨e²⟩ and its standard error, taking particles as independent.
pub(super) fn root_mean_square(squares: &[f64]) -> [f64; 2] {
    let n = squares.len().max(1) as f64;
    let mean = squares.iter().sum::<f64>() / n;
    let variance = squares.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / n;
    let root = mean.sqrt();
    [root, if root > 0.0 { (variance / n).sqrt() / (2.0 * root) } else { 0.0 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_is_an_operator() {
        for form in GradientForm::ALL {
            for correction in Correction::ALL {
                correction.operator(form).unwrap();
            }
        }
    }
}
