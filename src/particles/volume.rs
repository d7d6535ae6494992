//! Volume rules: what ω_j is.

use super::ParticleError;
use crate::names::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;

/// How the weight of a particle is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VolumeRule {
    /// ω_j = volume of the lattice cell over the particles in it, whatever the disorder (Fatehi & Manzari 2011, §4.1).
    Constant,
    /// V_j = 1 / Σ_k W_jk, k = j included (Chaussonnet et al. 2015, Eq. 1).
    NumberDensity,
}

impl VolumeRule {
    /// All rules.
    pub const ALL: [Self; 2] = [Self::Constant, Self::NumberDensity];

    /// The id used in scenes and reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::NumberDensity => "number-density",
        }
    }

    /// The rule with this id.
    ///
    /// # Errors
    /// [`ParticleError::UnknownVolumeRule`] with the nearest known id.
    pub fn by_id(id: &str) -> Result<Self, ParticleError> {
        let ids = Self::ALL.map(Self::id);
        Self::ALL.into_iter().find(|rule| rule.id() == id).ok_or_else(|| ParticleError::UnknownVolumeRule {
            id: id.to_owned(),
            nearest: nearest(id, &ids),
            known: ids.join(", "),
        })
    }
}

impl fmt::Display for VolumeRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}
