//! The plan: the least work that answers a scene.
//!
//! Tasks are grouped by kernel, lattice and volume rule, and take only the moments that some claim asks for, only the
//! components that symmetry leaves, and only the ladders that some quantity needs.

use super::StudyError;
use super::outcome::{CaseId, Varies};
use super::scene::Scene;
use crate::claim::Claim;
use crate::exact::{Rational, rational_text, rational_to_f64};
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::measured::{RegularSpec, SampleSpec};
use crate::particles::{Disorder, Lattice, Moves, PointGroup, SiteIndex, VolumeRule};
use crate::sums::{Moment, Reduction};
use itertools::Itertools;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;

/// Changes whenever the same inputs may give other bits: blocks stored by another engine are not found.
pub(super) const ENGINE: &str = "remainder-engine/2";

/// A unit of work whose results are stored block by block.
#[derive(Debug, Clone)]
pub enum Task {
    /// One rung of regular particles: exact sums at R/Δ and its offsets. One block.
    Regular(RegularSpec),
    /// One R/Δ and amplitude of disordered particles: as many blocks of samples as the precision needs.
    Samples {
        /// What to sample.
        spec: SampleSpec,
        /// R/Δ, exactly.
        support: Rational,
    },
}

/// A ladder: which tasks make its rungs, and for what.
#[derive(Debug, Clone)]
pub(super) struct LadderPlan {
    pub case: CaseId,
    pub varies: Varies,
    pub subjects: Vec<Subject>,
    /// Indices of tasks by rung; several where an envelope is taken.
    pub rungs: Vec<Vec<usize>>,
}

/// One thing the scene does not need.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Omission {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
    /// What that saves.
    pub saved: Option<String>,
}

/// What will be computed, and what was left out.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The units of work.
    pub tasks: Vec<Task>,
    /// What was left out.
    pub omissions: Vec<Omission>,
    pub(super) ladders: Vec<LadderPlan>,
    /// Exact sums over a support, one per free component and R/Δ.
    pub exact_sums: u64,
    /// The most samples, if every task needs all its blocks.
    pub most_samples: u64,
    /// Estimated pairs for these.
    pub most_pairs: u64,
}

impl Plan {
    /// Plans a scene within the budget it declares.
    ///
    /// # Errors
    /// [`StudyError::Budget`] if the estimate is above `limits.most_pairs`.
    pub fn within_budget(scene: &Scene) -> Result<Self, StudyError> {
        let plan = Self::of(scene);
        match scene.raw.limits.most_pairs {
            Some(allowed) if plan.most_pairs > allowed => {
                Err(StudyError::Budget { needed: plan.most_pairs, allowed })
            }
            _ => Ok(plan),
        }
    }

    /// Plans a scene.
    pub fn of(scene: &Scene) -> Self {
        let mut plan = Self {
            tasks: Vec::new(),
            omissions: Vec::new(),
            ladders: Vec::new(),
            exact_sums: 0,
            most_samples: 0,
            most_pairs: 0,
        };
        let lattices = scene.lattices().map(|lattice| (lattice, PointGroup::of(lattice))).collect_vec();
        for (lattice, group) in &lattices {
            let claims = claims_in(scene, lattice.dimension());
            let regular = regular_subjects(&claims, lattice, group);
            let disordered = disordered_subjects(&claims);
            for cases in scene.cases.iter().filter(|cases| cases.lattice.id() == lattice.id()) {
                plan.add_regular(scene, &cases.kernel, lattice, group, cases.rule, &regular);
                for disorder in cases.disorders.iter().filter(|_| !disordered.is_empty()) {
                    plan.add_disordered(scene, &cases.kernel, lattice, cases.rule, disorder, &disordered);
                }
            }
        }
        let (blocks, _) = scene.sampling();
        for task in &plan.tasks {
            if let Task::Samples { .. } = task {
                plan.most_samples += blocks * scene.raw.samples.block;
            }
            plan.most_pairs = plan.most_pairs.saturating_add(task.cost(scene));
        }
        plan.omissions = omissions(scene, &lattices);
        plan
    }

    fn add_regular(
        &mut self,
        scene: &Scene,
        kernel: &Kernel,
        lattice: &Lattice,
        group: &PointGroup,
        rule: VolumeRule,
        subjects: &[Subject],
    ) {
        if subjects.is_empty() {
            return;
        }
        let free: usize = subjects
            .iter()
            .filter_map(Subject::moment)
            .map(|m| Reduction::of(m, lattice, group).free().len())
            .sum();
        let mut rungs = Vec::new();
        for supports in scene.regular_ladder(lattice.dimension(), kernel) {
            self.exact_sums += (free * supports.len()) as u64;
            rungs.push(vec![self.tasks.len()]);
            self.tasks.push(Task::Regular(RegularSpec {
                kernel: kernel.clone(),
                lattice: lattice.clone(),
                rule,
                subjects: subjects.to_vec(),
                supports,
                memory_mib: scene.raw.limits.memory_mib,
            }));
        }
        let case = CaseId::new(kernel, lattice, None, rule);
        self.ladders.push(LadderPlan { case, varies: Varies::DxOverH, subjects: subjects.to_vec(), rungs });
    }

    fn add_disordered(
        &mut self,
        scene: &Scene,
        kernel: &Kernel,
        lattice: &Lattice,
        rule: VolumeRule,
        disorder: &Disorder,
        subjects: &[Subject],
    ) {
        let dimension = lattice.dimension();
        let case = CaseId::new(kernel, lattice, Some(disorder), rule);
        let mut push = |support: &Rational, amplitude: f64| {
            let spec = SampleSpec {
                kernel: kernel.clone(),
                lattice: lattice.clone(),
                disorder: disorder.clone(),
                amplitude,
                support_over_dx: rational_to_f64(support),
                rule,
                subjects: subjects.to_vec(),
                seed: scene.raw.study.seed,
            };
            self.tasks.push(Task::Samples { spec, support: support.clone() });
            self.tasks.len() - 1
        };
        let ladder = scene.disorder_ladder(dimension, kernel, disorder.entry().moves);
        let finest = ladder.iter().flatten().map(rational_to_f64).fold(0.0, f64::max);
        // d̃ and h are held: the amplitude, in Δ, falls with Δ/h towards the coarse end.
        let rungs = ladder.iter().map(|rung| {
            rung.iter()
                .map(|support| push(support, disorder.amplitude() * (rational_to_f64(support) / finest)))
                .collect_vec()
        });
        let rungs = rungs.collect_vec();
        let (support, factors) = scene.displacement_ladder(dimension);
        let heights =
            factors.iter().map(|factor| vec![push(&support, disorder.amplitude() * factor)]).collect_vec();
        let subjects = subjects.to_vec();
        self.ladders.push(LadderPlan {
            case: case.clone(),
            varies: Varies::DxOverH,
            subjects: subjects.clone(),
            rungs,
        });
        self.ladders.push(LadderPlan { case, varies: Varies::Displacement, subjects, rungs: heights });
    }
}

impl Task {
    /// The kernel it sums.
    pub fn kernel(&self) -> &Kernel {
        match self {
            Self::Regular(spec) => &spec.kernel,
            Self::Samples { spec, .. } => &spec.kernel,
        }
    }

    /// For people.
    pub fn label(&self) -> String {
        match self {
            Self::Regular(spec) => {
                let first = spec.supports.first().map(rational_text).unwrap_or_default();
                format!("{} {} regular, R/Δ = {first}…", spec.lattice.id(), spec.kernel.id())
            }
            Self::Samples { spec, support } => format!(
                "{} {} {} {}, R/Δ = {}, amplitude {:.3e}",
                spec.lattice.id(),
                spec.kernel.id(),
                spec.disorder,
                spec.rule,
                rational_to_f64(support),
                spec.amplitude
            ),
        }
    }

    /// Estimated work in pairs, if every sample is needed.
    pub fn cost(&self, scene: &Scene) -> u64 {
        match self {
            Self::Regular(spec) => {
                let sites =
                    spec.supports.iter().map(|s| spec.lattice.estimate_within(rational_to_f64(s)) as u64);
                sites.fold(0, u64::saturating_add)
            }
            Self::Samples { spec, .. } => {
                let (blocks, _) = scene.sampling();
                (blocks * scene.raw.samples.block).saturating_mul(sample_pairs(spec))
            }
        }
    }

    /// The case key: SHA-256 of the canonical inputs and the engine version.
    pub fn key(&self) -> String {
        #[derive(Serialize)]
        struct Inputs {
            engine: &'static str,
            kernel: Vec<(String, Vec<String>)>,
            dimension: usize,
            axis_squares: Vec<String>,
            vectors: Vec<SiteIndex>,
            basis: Vec<SiteIndex>,
            rule: VolumeRule,
            moments: Vec<String>,
            supports: Vec<String>,
            disorder: Option<(String, f64, u64)>,
        }
        let (kernel, lattice, rule, subjects) = match self {
            Self::Regular(spec) => {
                (spec.kernel.canonical_profile(), &spec.lattice, spec.rule, &spec.subjects)
            }
            Self::Samples { spec, .. } => {
                (spec.kernel.canonical_profile(), &spec.lattice, spec.rule, &spec.subjects)
            }
        };
        let (supports, disorder) = match self {
            Self::Regular(spec) => (spec.supports.iter().map(rational_text).collect(), None),
            Self::Samples { spec, support } => (
                vec![rational_text(support)],
                Some((spec.disorder.model_and_options(), spec.amplitude, spec.seed)),
            ),
        };
        let inputs = Inputs {
            engine: ENGINE,
            kernel,
            dimension: lattice.dimension(),
            axis_squares: lattice.axis_squares().iter().map(rational_text).collect(),
            vectors: lattice.vectors().to_vec(),
            basis: lattice.basis().to_vec(),
            rule,
            moments: subjects.iter().map(Subject::name).collect(),
            supports,
            disorder,
        };
        let canonical =
            serde_json::to_vec(&inputs).unwrap_or_else(|error| unreachable!("plain data: {error}"));
        Sha256::digest(canonical).iter().fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        })
    }
}

/// Estimated pairs of one sample.
pub(super) fn sample_pairs(spec: &SampleSpec) -> u64 {
    let inside = spec.lattice.estimate_within(spec.support_over_dx);
    let pairs = match spec.rule {
        VolumeRule::Constant => inside,
        VolumeRule::NumberDensity => inside * (inside + 1.0),
    };
    (pairs as u64).saturating_add(1)
}

/// The claims that are made for a dimension.
pub(super) fn claims_in(scene: &Scene, dimension: usize) -> Vec<Claim> {
    scene.claims.iter().filter(|claim| claim.dimensions.contains(&dimension)).cloned().collect()
}

/// What some claim needs on regular particles and symmetry does not settle.
fn regular_subjects(claims: &[Claim], lattice: &Lattice, group: &PointGroup) -> Vec<Subject> {
    let asked = claims
        .iter()
        .filter(|claim| !claim.is_disordered())
        .map(|claim| claim.subject.clone())
        .sorted()
        .dedup();
    asked.filter(|subject| !subject.vanishes(lattice, group)).collect()
}

fn disordered_subjects(claims: &[Claim]) -> Vec<Subject> {
    claims
        .iter()
        .filter(|claim| claim.is_disordered())
        .map(|claim| claim.subject.clone())
        .sorted()
        .dedup()
        .collect()
}

fn omissions(scene: &Scene, lattices: &[(&Lattice, PointGroup)]) -> Vec<Omission> {
    let mut omissions = Vec::new();
    for (lattice, group) in lattices {
        let claims = claims_in(scene, lattice.dimension());
        for moment in regular_subjects(&claims, lattice, group).iter().filter_map(Subject::moment) {
            let reduction = Reduction::of(moment, lattice, group);
            let (zero, equal) = reduction.left_out();
            if zero + equal > 0 {
                omissions.push(Omission {
                    what: format!("components of {moment} on {}", lattice.id()),
                    why: format!(
                        "{zero} vanish and {equal} equal another by the symmetry of the site ({} operations)",
                        group.order()
                    ),
                    saved: Some(format!(
                        "{} of {} exact sums per R/Δ",
                        zero + equal,
                        reduction.components.len()
                    )),
                });
            }
        }
        for claim in
            claims.iter().filter(|claim| !claim.is_disordered() && claim.subject.vanishes(lattice, group))
        {
            omissions.push(Omission {
                what: format!("{} on regular {}", claim.subject, lattice.id()),
                why: "vanishes by the symmetry of the site".into(),
                saved: Some("its whole ladder".into()),
            });
        }
    }
    let asked: Vec<Moment> =
        scene.claims.iter().filter_map(|claim| claim.subject.moment()).sorted().dedup().collect();
    let not_asked =
        Moment::all(4).into_iter().filter(|moment| !asked.contains(moment)).map(Moment::name).collect_vec();
    if !not_asked.is_empty() {
        omissions.push(Omission {
            what: format!("moments {}", not_asked.join(", ")),
            why: "no claim asks for them".into(),
            saved: None,
        });
    }
    let dimensions =
        (1..=3).filter(|d| lattices.iter().all(|(lattice, _)| lattice.dimension() != *d)).collect_vec();
    if !dimensions.is_empty() {
        omissions.push(Omission {
            what: format!("dimension {}", dimensions.iter().join(", ")),
            why: "the scene names no lattice there".into(),
            saved: None,
        });
    }
    let kernels = crate::kernel::catalogue();
    let unnamed = kernels
        .iter()
        .filter(|k| scene.kernels().all(|named| named.id() != k.id()))
        .map(Kernel::id)
        .collect_vec();
    if !unnamed.is_empty() {
        omissions.push(Omission {
            what: format!("kernels {}", unnamed.join(", ")),
            why: "the scene does not name them".into(),
            saved: None,
        });
    }
    for kernel in scene.kernels() {
        omissions.extend(kernel.remark().map(|why| Omission {
            what: format!("{} beyond R", kernel.id()),
            why,
            saved: None,
        }));
    }
    if scene.disorders().next().is_some() && scene.claims.iter().all(|claim| !claim.is_disordered()) {
        omissions.push(Omission {
            what: "all disordered particles".into(),
            why: "no claim is about disorder".into(),
            saved: None,
        });
    }
    let independent = scene
        .disorders()
        .filter(|d| d.entry().moves == Moves::All)
        .map(|d| d.model().to_owned())
        .collect_vec();
    if !independent.is_empty() {
        omissions.push(Omission {
            what: format!("offsets of R/Δ under {}", independent.join(", ")),
            why: "sums over independent displacements do not oscillate with R/Δ".into(),
            saved: None,
        });
    }
    omissions
}
