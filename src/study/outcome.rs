//! What a study found.

use super::derive::DerivedColumn;
use super::plan::Omission;
use super::scene::Scene;
use crate::claim::{Claim, Judgement, Measured, Quantity, Verdict};
use crate::exact::rational_to_f64;
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::measured::window::{PowerLaw, Reason};
use crate::particles::{Disorder, Lattice, VolumeRule};

/// What tells one case from another.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseId {
    /// D.
    pub dimension: usize,
    /// Id of the kernel.
    pub kernel: String,
    /// Its β.
    pub beta: i64,
    /// R/h of the kernel.
    pub support_over_h: f64,
    /// Id of the lattice.
    pub lattice: String,
    /// The disorder, or none.
    pub disorder: Option<Disorder>,
    /// The volume rule.
    pub rule: VolumeRule,
}

impl CaseId {
    pub(super) fn new(
        kernel: &Kernel,
        lattice: &Lattice,
        disorder: Option<&Disorder>,
        rule: VolumeRule,
    ) -> Self {
        Self {
            dimension: lattice.dimension(),
            kernel: kernel.id().to_owned(),
            beta: kernel.beta(),
            support_over_h: rational_to_f64(kernel.support_over_h()),
            lattice: lattice.id().to_owned(),
            disorder: disorder.cloned(),
            rule,
        }
    }

    /// `2d/wendland-c2/square/box:0.4/constant`.
    pub fn path(&self) -> String {
        let disorder = self.disorder.as_ref().map_or("none".to_owned(), ToString::to_string);
        format!("{}d/{}/{}/{disorder}/{}", self.dimension, self.kernel, self.lattice, self.rule)
    }
}

/// What a ladder varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Varies {
    /// Δ/h, with d̃ and h held.
    DxOverH,
    /// d̃, with h and Δ/h held.
    Displacement,
}

impl Varies {
    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::DxOverH => "dx_over_h",
            Self::Displacement => "displacement",
        }
    }
}

/// One rung of a ladder, in units of h.
#[derive(Debug, Clone, PartialEq)]
pub struct Rung {
    /// Δ/h or d̃/h.
    pub x: f64,
    /// The envelope, or the root mean square.
    pub y: f64,
    /// Standard error of y.
    pub y_error: Option<f64>,
    /// Round-off floor of y.
    pub floor: f64,
    /// Mean norm over the samples.
    pub mean: Option<f64>,
    /// Largest norm over the samples.
    pub max: Option<f64>,
    /// Samples evaluated.
    pub samples: Option<u64>,
    /// R/Δ.
    pub support_over_dx: f64,
}

/// A power law fitted along a ladder.
#[derive(Debug, Clone, PartialEq)]
pub struct LadderFit {
    /// Unique in the outcome.
    pub id: String,
    /// For what.
    pub case: CaseId,
    /// The moment sum or coefficient.
    pub subject: Subject,
    /// What was made of it.
    pub quantity: Quantity,
    /// What the ladder varies.
    pub varies: Varies,
    /// What it holds, for people.
    pub held: Vec<(String, String)>,
    /// The rungs from coarse to fine.
    pub rungs: Vec<Rung>,
    /// The fit, or why there is none.
    pub fit: Result<PowerLaw, String>,
}

impl LadderFit {
    /// Why a rung was left out of the fit.
    pub fn reason(&self, rung: usize) -> Option<Reason> {
        let fit = self.fit.as_ref().ok()?;
        fit.left_out.iter().find(|(index, _)| *index == rung).map(|(_, reason)| *reason)
    }
}

/// What was measured for one claim in one case.
#[derive(Debug, Clone, PartialEq)]
pub enum MeasuredColumn {
    /// Exponents of d̃ and Δ/h, with the fits they come from; that of h is p − q minus that of d̃.
    Exponents {
        /// Of d̃.
        displacement: Measured,
        /// Of Δ/h.
        dx_over_h: Measured,
        /// Ids of the fits.
        fits: Vec<String>,
    },
    /// The exponent of Δ at constant h, d̃ in proportion to Δ, on which convergence hangs.
    Rate {
        /// The exponent.
        rate: Measured,
        /// Ids of the fits.
        fits: Vec<String>,
    },
    /// It vanishes by symmetry.
    ZeroBySymmetry,
    /// It does not vanish; its largest norm in units of h.
    NotZero(f64),
    /// No number; the verdict says why.
    Nothing {
        /// Whether particles coincided, so that there is nothing to measure, and no small displacement to derive.
        coincident: bool,
        /// Ids of the fits that did not decide.
        fits: Vec<String>,
    },
}

/// One claim in one case, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedCase {
    /// The claim.
    pub claim: Claim,
    /// The case.
    pub case: CaseId,
    /// What was derived, where it can be.
    pub derived: Option<DerivedColumn>,
    /// What was measured.
    pub measured: MeasuredColumn,
    /// The verdict.
    pub judgement: Judgement,
}

/// One claim over all its cases.
#[derive(Debug, Clone, PartialEq)]
pub struct RolledClaim {
    /// The claim.
    pub id: String,
    /// The verdict.
    pub judgement: Judgement,
    /// What the scene expects.
    pub expected: Option<Verdict>,
    /// Number of cases.
    pub cases: usize,
}

/// All that a study found. A pure function of the scene and its blocks.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The scene.
    pub scene: Scene,
    /// By claim in the scene's order, then by case.
    pub judged: Vec<JudgedCase>,
    /// By claim.
    pub rolled: Vec<RolledClaim>,
    /// All fits.
    pub fits: Vec<LadderFit>,
    /// What was left out.
    pub omissions: Vec<Omission>,
    /// Exact sums taken.
    pub exact_sums: u64,
    /// Samples taken.
    pub samples: u64,
    /// Kernel evaluations in floating point.
    pub pairs: u64,
}
