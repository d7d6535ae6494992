//! Disorder models: how particles leave their lattice.
//!
//! A scene writes `MODEL:AMPLITUDE[,key=value…]` with the amplitude as in the model's paper. Displacements are linear in
//! the amplitude: d = amplitude · Δ · u(site), with u drawn from random words that are a pure function of (seed, sample,
//! site). A new model is one file here and one entry in [`catalogue`].

mod canonical;
mod direction;
mod draw;
mod gaussian;
mod law;
mod offset;
mod options;
mod random_box;
mod shear;
mod wave;

pub use draw::{Draw, SiteWords};
pub use law::{Law, Shape};
pub use options::Options;

use super::ParticleError;
use super::lattice::Lattice;
use crate::names::nearest;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Which particles a model moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moves {
    /// No particle.
    Nothing,
    /// Particle i, at which the sums are taken, and no other.
    CentreOnly,
    /// All particles, the centre like any other, each by a displacement independent of the others'.
    All,
    /// All particles, by displacements that depend on each other: sums may oscillate with R/Δ as on the lattice.
    Together,
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
    /// The keys of the options it knows.
    pub options: &'static [&'static str],
    /// The motion under the options of a scene; what is wrong with them otherwise.
    pub motion: fn(&Options) -> Result<Motion, String>,
}

/// u(site), the displacement in units of amplitude · Δ.
pub type Displacement = Box<dyn Fn(&mut Draw<'_>) -> [f64; 3] + Send + Sync>;

/// A model with its options read.
pub struct Motion {
    /// u(site).
    pub unit: Displacement,
    /// How far u brings two particles together.
    pub reach: Reach,
    /// The largest |u| in each dimension 1, 2, 3.
    pub longest: [f64; 3],
    /// The smallest dimension in which it has a meaning.
    pub least_dimension: usize,
    /// What u is distributed like, for those who take expectations.
    pub law: Law,
}

/// How far u of two particles brings them together: whether neighbours can meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// Not at all: the motion keeps particles apart.
    Never,
    /// |u| ≤ this in any direction.
    Ball(f64),
    /// |u_a| ≤ this along each axis.
    PerAxis(f64),
}

/// Displacements beyond this many Δ are refused whatever the model: they only cost memory.
const FARTHEST: f64 = 16.0;

/// All disorder models.
pub fn catalogue() -> Vec<DisorderModel> {
    vec![
        DisorderModel {
            id: "none",
            formula: "d = 0",
            citation: "fatehi-manzari-2011, §4.1",
            moves: Moves::Nothing,
            options: &[],
            motion: |_| {
                Ok(Motion {
                    unit: Box::new(|_| [0.0; 3]),
                    reach: Reach::Never,
                    longest: [0.0; 3],
                    least_dimension: 1,
                    law: Law::Independent(Shape::Sphere),
                })
            },
        },
        offset::model(),
        random_box::model(),
        canonical::model(),
        gaussian::model(),
        wave::model(),
        shear::model(),
    ]
}

/// A disorder as a scene asks for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Disorder {
    model: String,
    amplitude: f64,
    options: Options,
    text: String,
}

impl Disorder {
    /// Reads `MODEL:AMPLITUDE[,key=value…]`; `none` stands alone.
    ///
    /// # Errors
    /// Unknown models (with the nearest known one), missing, negative or non-finite amplitudes, displacements beyond 16 Δ,
    /// options that the model does not know (with those it does), options without meaning.
    ///
    /// # Examples
    /// ```
    /// use remainder::particles::Disorder;
    /// assert_eq!(Disorder::parse("box:0.4").unwrap().amplitude(), 0.4);
    /// assert!(Disorder::parse("boxx:0.4").unwrap_err().to_string().contains("did you mean 'box'"));
    /// assert!(Disorder::parse("wave:0.1,wavelength=8,unit=dx").is_ok());
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
        let options = Options::parse(parts, model, entry.options).map_err(fault)?;
        let motion = (entry.motion)(&options).map_err(fault)?;
        let farthest = motion.longest.iter().fold(0.0, |most: f64, u| most.max(u * amplitude));
        if farthest > FARTHEST {
            return Err(fault(format!("moves particles by up to {farthest} Δ, more than {FARTHEST} Δ")));
        }
        Ok(Self { model: model.to_owned(), amplitude, options, text: text.trim().to_owned() })
    }

    /// The id of the model.
    pub fn model(&self) -> &str {
        &self.model
    }

    /// The model and its options in alphabetical order, `wave,unit=dx,wavelength=8`: all but the amplitude.
    pub fn model_and_options(&self) -> String {
        format!("{}{}", self.model, self.options)
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

    /// The model with the options read.
    pub fn motion(&self) -> Motion {
        (self.entry().motion)(&self.options)
            .unwrap_or_else(|what| unreachable!("parse has read these options: {what}"))
    }

    /// # Errors
    /// [`ParticleError::DisorderTooLarge`] if two particles of the lattice can meet.
    pub fn check_reach(&self, lattice: &Lattice) -> Result<(), ParticleError> {
        let movers = if self.entry().moves == Moves::CentreOnly { 1.0 } else { 2.0 };
        type Norm = fn([f64; 3]) -> f64;
        let (reach, norm): (f64, Norm) = match self.motion().reach {
            Reach::Never => return Ok(()),
            Reach::Ball(reach) => (reach, |r| (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt()),
            Reach::PerAxis(reach) => (reach, |r| r.iter().fold(0.0, |most, x| most.max(x.abs()))),
        };
        let reach = reach * self.amplitude;
        // What two particles can cross, as a ball that holds the box.
        let radius = movers * reach * (lattice.dimension() as f64).sqrt();
        let apart = lattice.separations_within(radius).into_iter().map(norm).fold(f64::INFINITY, f64::min);
        if movers * reach < apart {
            return Ok(());
        }
        let text = self.text.clone();
        Err(ParticleError::DisorderTooLarge { text, reach, lattice: lattice.id().to_owned(), apart })
    }

    /// # Errors
    /// [`ParticleError::DisorderDimension`] if the lattice has too few dimensions for it.
    pub fn check_dimension(&self, lattice: &Lattice) -> Result<(), ParticleError> {
        let least = self.motion().least_dimension;
        if lattice.dimension() >= least {
            return Ok(());
        }
        Err(ParticleError::DisorderDimension {
            text: self.text.clone(),
            what: format!("needs at least {least} dimensions"),
            lattice: lattice.id().to_owned(),
            dimension: lattice.dimension(),
        })
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
