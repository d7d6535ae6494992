//! An RMS error as a record and as text.

use crate::derived::{Model, RmsError};
use crate::language::Subject;
use crate::measured::SampledError;
use crate::record::significant;
use serde::Serialize;
use std::fmt::Write as _;

/// An RMS error, its parts and what stands beside it; lengths in units of Δ.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RmsReport {
    /// `F4` or `sum_dw`.
    pub subject: String,
    /// Of an operator: the field about particle i it was applied to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
    /// What the error is measured in: `Δ^-1`.
    pub unit: String,
    /// √⟨|e|²⟩.
    pub rms: f64,
    /// √⟨e²⟩ by component, in the order of `component_names`.
    pub components: Vec<f64>,
    /// `""`, `x`, `xy`: of a moment its positions, then its derivatives; of an operator the indices of its value.
    pub component_names: Vec<String>,
    /// In how many places of the tensor each component stands; `rms` counts each.
    pub multiplicities: Vec<u64>,
    /// ⟨e⟩ of a scalar, |⟨e⟩| of a tensor.
    pub mean: f64,
    /// ⟨e⟩ by component.
    pub component_means: Vec<f64>,
    /// What a component would be without error, by component: its continuum limit; 0 for operators, whose target is taken off.
    pub limits: Vec<f64>,
    /// |e| on the lattice.
    pub regular: f64,
    /// The part of disorder: the standard deviation of e, its norm.
    pub disorder: f64,
    /// `linearised` or `finite`.
    pub model: &'static str,
    /// Bound of the numerical error of `rms` under the model.
    pub radius: f64,
    /// Estimate of what the model leaves out of `rms`: of fourth order in the displacements, 0 for `finite`.
    pub model_error: f64,
    /// From samples, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampled: Option<SampledReport>,
}

/// The same from samples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SampledReport {
    /// Samples evaluated.
    pub samples: u64,
    /// Samples left out because two particles coincide.
    pub degenerate: u64,
    /// √⟨|e|²⟩.
    pub rms: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// √⟨e²⟩ by component.
    pub components: Vec<f64>,
    /// ⟨e⟩ by component.
    pub component_means: Vec<f64>,
}

/// Significant digits of sampled numbers.
const DIGITS: usize = 8;

impl RmsReport {
    /// From what was derived and, perhaps, sampled.
    pub fn new(subject: &Subject, error: &RmsError, sampled: Option<&SampledError>) -> Self {
        let by =
            |value: fn(&crate::derived::ComponentError) -> f64| error.components.iter().map(value).collect();
        let power = subject.length_power();
        let order = subject.coefficient().map(|coefficient| coefficient.order());
        Self {
            subject: subject.coefficient().map_or_else(|| subject.name(), |known| known.id().to_owned()),
            field: order
                .map(|order| ["1", "x", "x²/2"].get(usize::from(order)).map_or("xᵐ/m!", |f| f).into()),
            unit: if power == 0 { "1".into() } else { format!("Δ^{power}") },
            rms: error.rms(),
            components: by(|component| component.mean_square.max(0.0).sqrt()),
            component_names: error.components.iter().map(|component| component.name.clone()).collect(),
            multiplicities: error.components.iter().map(|component| component.multiplicity).collect(),
            mean: error.mean(),
            component_means: by(|component| component.mean),
            limits: by(|component| component.limit),
            regular: error.regular(),
            disorder: error.disorder(),
            model: match error.model {
                Model::Linearised => "linearised",
                Model::Finite => "finite",
            },
            radius: error.radius,
            model_error: error.model_error,
            sampled: sampled.map(|sampled| {
                let round = |value| significant(value, DIGITS);
                SampledReport {
                    samples: sampled.samples,
                    degenerate: sampled.degenerate,
                    rms: round(sampled.rms),
                    standard_error: round(sampled.rms_error),
                    components: sampled.components.iter().map(|c| round(c[0])).collect(),
                    component_means: sampled.components.iter().map(|c| round(c[1])).collect(),
                }
            }),
        }
    }

    /// For people.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        let mut line = |text: String| {
            let _ = writeln!(out, "{text}");
        };
        let on = self.field.as_ref().map_or_else(String::new, |field| format!(" on u = {field}"));
        line(format!("RMS error of {}{on}, in {} ({} model)", self.subject, self.unit, self.model));
        line(format!("  rms       {:<22.15e} ± {:.1e}", self.rms, self.radius));
        line(format!("  regular   {:<22.15e} |e| on the lattice itself", self.regular));
        line(format!("  disorder  {:<22.15e} standard deviation of e", self.disorder));
        line(format!("  mean      {:<22.15e}", self.mean));
        if self.model == "linearised" {
            line(format!("  model     {:<22.2e} left out by the linearisation, estimated", self.model_error));
        }
        if let Some(sampled) = &self.sampled {
            let (n, error) = (sampled.samples, sampled.standard_error);
            line(format!("  sampled   {:<22.8e} ± {error:.1e} ({n} samples)", sampled.rms));
            if sampled.degenerate > 0 {
                line(format!("            {} more had two particles in one place", sampled.degenerate));
            }
        }
        if self.components.len() > 1 {
            line(format!("\n  {:9} {:>22} {:>22}", "component", "rms", "mean"));
            for ((name, rms), mean) in
                self.component_names.iter().zip(&self.components).zip(&self.component_means)
            {
                line(format!("  {name:9} {rms:>22.12e} {mean:>22.12e}"));
            }
        }
        out
    }
}
