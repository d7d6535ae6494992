//! What can be wrong with lattices, disorder models and volume rules.

use thiserror::Error;

/// Errors of the particle layer (clouds have their own, [`super::CloudError`]).
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ParticleError {
    /// A lattice that is not one.
    #[error("lattice '{id}' {what}")]
    Lattice {
        /// The lattice.
        id: String,
        /// What is wrong with it.
        what: String,
    },
    /// No lattice of this name.
    #[error("there is no lattice '{id}'{}; known lattices: {known}", hint(nearest))]
    UnknownLattice {
        /// The name given.
        id: String,
        /// The nearest known name.
        nearest: Option<String>,
        /// All known names.
        known: String,
    },
    /// No disorder model of this name.
    #[error("there is no disorder model '{id}'{}; known models: {known}", hint(nearest))]
    UnknownDisorder {
        /// The name given.
        id: String,
        /// The nearest known name.
        nearest: Option<String>,
        /// All known names.
        known: String,
    },
    /// A disorder that cannot be read or makes no sense.
    #[error("disorder '{text}' {what}; write MODEL:AMPLITUDE[,key=value…], for example box:0.4")]
    Disorder {
        /// As written.
        text: String,
        /// What is wrong with it.
        what: String,
    },
    /// A disorder on a lattice of a dimension in which it has no meaning.
    #[error("disorder '{text}' {what}, but lattice '{lattice}' has {dimension} dimension(s)")]
    DisorderDimension {
        /// As written.
        text: String,
        /// What it needs.
        what: String,
        /// The lattice.
        lattice: String,
        /// Its dimension.
        dimension: usize,
    },
    /// Displacements so large that neighbours may meet.
    #[error(
        "disorder '{text}' moves particles by up to {reach} Δ, and on lattice '{lattice}' they stand {apart} Δ apart, so \
         that neighbours can meet: lower the amplitude, or set allow_degenerate = true under [limits] to get typed \
         results instead of numbers"
    )]
    DisorderTooLarge {
        /// As written.
        text: String,
        /// The largest displacement, or that along an axis where it is bounded by axis, in Δ.
        reach: f64,
        /// The lattice.
        lattice: String,
        /// The distance of the neighbours, in the same norm.
        apart: f64,
    },
    /// No volume rule of this name.
    #[error("there is no volume rule '{id}'{}; known rules: {known}", hint(nearest))]
    UnknownVolumeRule {
        /// The name given.
        id: String,
        /// The nearest known name.
        nearest: Option<String>,
        /// All known names.
        known: String,
    },
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(" (did you mean '{name}'?)")).unwrap_or_default()
}
