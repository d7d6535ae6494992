//! Disorder models: how particles leave their lattice.
//!
//! A scene writes `MODEL:AMPLITUDE[,key=value…]` with the amplitude as in the model's paper. Displacements are linear in
//! the amplitude: d = amplitude · Δ · u(site), with u drawn from the random words of the site alone. A new model is one
//! file here and one entry in [`catalogue`].

mod canonical;
mod offset;
mod random_box;

use super::ParticleError;
use crate::names::nearest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// Random words of one site: a pure function of (seed, sample, site).
pub type SiteWords = [u64; 4];

/// Which particles a model moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moves {
    /// No particle.
    Nothing,
    /// Particle i, at which the sums are taken, and no other.
    CentreOnly,
    /// All particles, the centre like any other.
    All,
}

/// One disorder model of the catalogue.
pub struct DisorderModel {
    /// The id used in scenes and reports.
    pub id: &'static str,
    /// The displacement in words and formula.
    pub formula: &'static str,
    /// Where it comes from.
    pub citation: &'static str,
    /// What it moves.
    pub moves: Moves,
    /// u(site), the displacement in units of amplitude · Δ, from the dimension and the words of the site.
    pub unit: fn(usize, &SiteWords) -> [f64; 3],
    /// The largest |u| along a coordinate axis or between two neighbours on a line: `reach · amplitude` ≥ 1/2 lets
    /// neighbours meet.
    pub reach: f64,
    /// The largest |u| in each dimension 1, 2, 3.
    pub longest: [f64; 3],
}

/// All disorder models.
pub fn catalogue() -> Vec<DisorderModel> {
    vec![
        DisorderModel {
            id: "none",
            formula: "d = 0",
            citation: "fatehi-manzari-2011, §4.1",
            moves: Moves::Nothing,
            unit: |_, _| [0.0; 3],
            reach: 0.0,
            longest: [0.0; 3],
        },
        offset::model(),
        random_box::model(),
        canonical::model(),
    ]
}

/// A disorder as a scene asks for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Disorder {
    model: String,
    amplitude: f64,
    options: BTreeMap<String, String>,
    text: String,
}

impl Disorder {
    /// Reads `MODEL:AMPLITUDE[,key=value…]`; `none` stands alone.
    ///
    /// # Errors
    /// Unknown models (with the nearest known one), missing, negative or non-finite amplitudes, unknown options.
    ///
    /// # Examples
    /// ```
    /// use remainder::particles::Disorder;
    /// assert_eq!(Disorder::parse("box:0.4").unwrap().amplitude(), 0.4);
    /// assert!(Disorder::parse("boxx:0.4").unwrap_err().to_string().contains("did you mean 'box'"));
    /// ```
    pub fn parse(text: &str) -> Result<Self, ParticleError> {
        let fault = |what: String| ParticleError::Disorder { text: text.to_owned(), what };
        let (model, rest) = match text.split_once(':') {
            Some((model, rest)) => (model.trim(), Some(rest)),
            None => (text.trim(), None),
        };
        let known = catalogue();
        let ids: Vec<&str> = known.iter().map(|entry| entry.id).collect();
        let entry =
            known.iter().find(|entry| entry.id == model).ok_or_else(|| ParticleError::UnknownDisorder {
                id: model.to_owned(),
                nearest: nearest(model, &ids),
                known: ids.join(", "),
            })?;
        let mut parts = rest.unwrap_or_default().split(',').map(str::trim);
        let first = parts.next().unwrap_or_default();
        let amplitude = match (entry.moves, first) {
            (Moves::Nothing, "") => 0.0,
            (Moves::Nothing, _) => return Err(fault("takes no amplitude".into())),
            (_, "") => return Err(fault("has no amplitude".into())),
            (_, number) => number
                .parse::<f64>()
                .map_err(|_| fault(format!("has an amplitude '{number}' that is no number")))?,
        };
        if !amplitude.is_finite() || amplitude < 0.0 || (amplitude == 0.0 && entry.moves != Moves::Nothing) {
            return Err(fault(format!("has an amplitude {amplitude}, which must be finite and positive")));
        }
        if let Some(option) = parts.next() {
            return Err(fault(format!("has an option '{option}' that model '{model}' does not know")));
        }
        Ok(Self {
            model: model.to_owned(),
            amplitude,
            options: BTreeMap::new(),
            text: text.trim().to_owned(),
        })
    }

    /// The id of the model.
    pub fn model(&self) -> &str {
        &self.model
    }

    /// The amplitude in the units of its paper.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// The catalogue entry.
    pub fn entry(&self) -> DisorderModel {
        catalogue()
            .into_iter()
            .find(|entry| entry.id == self.model)
            .unwrap_or_else(|| unreachable!("parse admits known models only"))
    }

    /// # Errors
    /// [`ParticleError::DisorderTooLarge`] if neighbours can meet: displacements of 0.5 Δ or more along a line.
    pub fn check_reach(&self) -> Result<(), ParticleError> {
        let reach = self.entry().reach * self.amplitude;
        if reach >= 0.5 && self.entry().moves == Moves::All || reach >= 1.0 {
            return Err(ParticleError::DisorderTooLarge { text: self.text.clone(), reach });
        }
        Ok(())
    }
}

impl fmt::Display for Disorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl From<Disorder> for String {
    fn from(disorder: Disorder) -> Self {
        disorder.text
    }
}

impl TryFrom<String> for Disorder {
    type Error = ParticleError;
    fn try_from(text: String) -> Result<Self, ParticleError> {
        Self::parse(&text)
    }
}

/// A number in [0, 1) from a random word.
fn unit_interval(word: u64) -> f64 {
    (word >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// A direction uniform on the sphere of `dimension` dimensions: a sign, an angle, or Archimedes' cylinder.
fn direction(dimension: usize, words: &SiteWords) -> [f64; 3] {
    match dimension {
        1 => [if words[0] >> 63 == 0 { 1.0 } else { -1.0 }, 0.0, 0.0],
        2 => {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(words[0]));
            [cosine, sine, 0.0]
        }
        _ => {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(words[0]));
            let z = 2.0 * unit_interval(words[1]) - 1.0;
            let rho = (1.0 - z * z).max(0.0).sqrt();
            [rho * cosine, rho * sine, z]
        }
    }
}
