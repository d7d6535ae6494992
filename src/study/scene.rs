//! Scenes: one analysis as a file, TOML or JSON through the same structs.

use super::define_lattice;
use super::source::{SceneError, SceneText};
use super::tables::{CasesTable, DefineTable, DxLadder, OwnClaim, RawScene};
use crate::claim::{self, BetaExponent, Claim, Powers, Quantity, Statement};
use crate::exact::{Rational, int, ratio, rational_from_decimal, rational_to_f64};
use crate::kernel::{Kernel, KernelDefinition, by_id_among};
use crate::language::{Coefficient, Subject};
use crate::measured::neighbourhood_radius;
use crate::particles::{Disorder, Lattice, Moves, VolumeRule, lattice_among};
use crate::sums::{Moment, nearest_distance};
use itertools::Itertools as _;
use num_traits::ToPrimitive;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::path::Path;

/// A scene whose names are resolved and whose numbers are checked.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Name: that of its folder, or of its file.
    pub name: String,
    /// As written.
    pub raw: RawScene,
    /// SHA-256 of the canonical form of `raw`, in hexadecimal.
    pub sha256: String,
    /// Whether ladders and samples were shortened for a first look.
    pub quick: bool,
    /// What to place: a kernel on a lattice with a volume rule, regular and under disorder. Each once.
    pub cases: Vec<CaseGroup>,
    /// The claims.
    pub claims: Vec<Claim>,
}

/// A kernel on a lattice with a volume rule, and the disorders it is asked under.
#[derive(Debug, Clone)]
pub struct CaseGroup {
    /// The lattice.
    pub lattice: Lattice,
    /// The kernel.
    pub kernel: Kernel,
    /// The volume rule.
    pub rule: VolumeRule,
    /// The disorders, without `none`.
    pub disorders: Vec<Disorder>,
}

/// The kinds of study that a [`Scene`] may be of.
pub const KINDS: &[&str] = &["moment-orders", "operator-orders"];

impl Scene {
    /// Reads a scene from its text.
    ///
    /// # Errors
    /// [`SceneError`] with line and column where there is one.
    pub fn from_text(text: &SceneText, name: &str, quick: bool) -> Result<Self, SceneError> {
        Self::resolve(parse(text)?, text, name, quick)
    }

    fn resolve(raw: RawScene, text: &SceneText, name: &str, quick: bool) -> Result<Self, SceneError> {
        if !KINDS.contains(&raw.study.kind.as_str()) {
            let message = format!("'{}' is no study of orders: {}", raw.study.kind, KINDS.join(", "));
            return Err(text.error_at("study.kind", message, None));
        }
        let at = |keys: String, message: String| text.error_at(&keys, message, None);
        let own = own_kernels(&raw.define, text)?;
        let own_lattices = define_lattice::resolve(&raw.define.lattice, text)?;
        let cases = resolve_cases(&raw, &own, &own_lattices, at)?;
        let claims = resolve_claims(&raw, at)?;
        for id in raw.expect.keys() {
            if !claims.iter().any(|claim| claim.id == *id) {
                return Err(at(
                    format!("expect.{id}"),
                    format!("expects a verdict on '{id}', which is not among the scene's claims"),
                ));
            }
        }
        if cases.iter().all(|group| group.disorders.is_empty()) && claims.iter().any(Claim::is_disordered) {
            return Err(text.error_at(
                "cases",
                "the claims need disorder, and cases.disorders names no model",
                Some("for example disorders = [\"offset:0.1\", \"box:0.4\"]"),
            ));
        }
        let lattices = cases.iter().map(|group| &group.lattice).unique_by(|lattice| lattice.id());
        // Samples hold the neighbours of i, and no more.
        let nested = |claim: &&Claim| {
            claim.is_disordered() && claim.subject.coefficient().is_some_and(Coefficient::is_nested)
        };
        if let Some(claim) = claims.iter().find(nested) {
            let message = format!(
                "'{}' needs disordered neighbours of neighbours, which samples do not hold: ask for its regular orders",
                claim.id
            );
            return Err(at("claims".into(), message));
        }
        check_numbers(&raw, &lattices.collect_vec(), at)?;
        let canonical = serde_json::to_string(&raw).map_err(|error| text.error(error.to_string()))?;
        let sha256 = Sha256::digest(canonical.as_bytes()).iter().fold(String::new(), |mut hex, byte| {
            let _ = write!(hex, "{byte:02x}");
            hex
        });
        let scene = Self { name: name.to_owned(), raw, sha256, quick, cases, claims };
        scene.check_neighbourhoods(text)?;
        Ok(scene)
    }

    /// The kernels, each once.
    pub fn kernels(&self) -> impl Iterator<Item = &Kernel> {
        self.cases.iter().map(|group| &group.kernel).unique_by(|kernel| kernel.id())
    }

    /// The lattices, each once.
    pub fn lattices(&self) -> impl Iterator<Item = &Lattice> {
        self.cases.iter().map(|group| &group.lattice).unique_by(|lattice| lattice.id())
    }

    /// The disorders, each once.
    pub fn disorders(&self) -> impl Iterator<Item = &Disorder> {
        self.cases.iter().flat_map(|group| &group.disorders).unique_by(|disorder| disorder.to_string())
    }

    /// What is laid must fit in memory: regular supports, and disordered neighbourhoods, which reach further than R by
    /// what particles may move.
    fn check_neighbourhoods(&self, text: &SceneText) -> Result<(), SceneError> {
        let allowed = self.raw.limits.memory_mib;
        let largest = |ladder: Vec<Vec<Rational>>| {
            ladder.into_iter().flatten().map(|support| rational_to_f64(&support)).fold(0.0, f64::max)
        };
        let written = |find: &dyn Fn(&CasesTable) -> Option<(usize, &'static str)>| {
            let mut tables = self.raw.cases.tables.iter().enumerate();
            let found =
                tables.find_map(|(table, cases)| find(cases).map(|(index, field)| (table, index, field)));
            found.map_or("cases".to_owned(), |(table, index, field)| {
                self.raw.cases.place(table, &format!("{field}.{index}"))
            })
        };
        for CaseGroup { lattice, kernel, rule, disorders } in &self.cases {
            let dimension = lattice.dimension();
            let support = largest(self.regular_ladder(dimension, kernel));
            let sites = lattice.estimate_within(support);
            let needed = sites * MIB_PER_SITE;
            if needed > allowed as f64 {
                let message = format!(
                    "R/Δ = {support} on lattice '{}' needs about {needed:.0} MiB for {sites:.2e} sites, more than \
                     the {allowed} MiB of limits.memory_mib: lower `to` of a [[ladders.regular]] for dimension {dimension}",
                    lattice.id()
                );
                let place = written(&|cases| {
                    Some((cases.lattices.iter().position(|id| id == lattice.id())?, "lattices"))
                });
                return Err(text.error_at(&place, message, None));
            }
            for disorder in disorders {
                let longest = disorder.motion().longest[dimension - 1] * disorder.amplitude();
                let ladder = self.disorder_ladder(dimension, kernel, disorder.entry().moves);
                let support = largest(ladder).max(rational_to_f64(&self.displacement_ladder(dimension).0));
                let sites = lattice.estimate_within(neighbourhood_radius(*rule, support, longest));
                let needed = sites * MIB_PER_SITE;
                if needed > allowed as f64 {
                    let message = format!(
                        "disorder '{disorder}' at R/Δ = {support} with {rule} volumes on lattice '{}' needs about \
                         {needed:.0} MiB for {sites:.2e} sites, more than the {allowed} MiB of limits.memory_mib",
                        lattice.id()
                    );
                    let place = written(&|cases| {
                        let mut names = cases.disorders.iter();
                        Some((names.position(|name| name.trim() == disorder.to_string())?, "disorders"))
                    });
                    return Err(text.error_at(&place, message, None));
                }
            }
        }
        Ok(())
    }

    /// The ladder in Δ/h on regular particles: by rung, R/Δ and its offsets.
    pub fn regular_ladder(&self, dimension: usize, kernel: &Kernel) -> Vec<Vec<Rational>> {
        let default = [(8, 512, 13, 16), (8, 256, 15, 16), (6, 64, 11, 16)][dimension - 1];
        let ladder = dx_ladder(&self.raw.ladders.regular, dimension, default);
        self.supports(&ladder, kernel)
    }

    /// The ladder in Δ/h under a disorder. Sums over independent displacements do not oscillate with R/Δ and take the
    /// half-integer alone.
    pub fn disorder_ladder(&self, dimension: usize, kernel: &Kernel, moves: Moves) -> Vec<Vec<Rational>> {
        let default = [(4, 256, 11, 8), (4, 96, 12, 8), (3, 24, 11, 8)][dimension - 1];
        let ladder = dx_ladder(&self.raw.ladders.disorder, dimension, default);
        let rungs = self.supports(&ladder, kernel);
        match moves {
            Moves::All => rungs.into_iter().map(|rung| vec![&rung[0] + ratio(1, 2)]).collect(),
            _ => rungs,
        }
    }

    /// R/Δ of the ladder in d̃, and the factors of the amplitude, falling.
    pub fn displacement_ladder(&self, dimension: usize) -> (Rational, Vec<f64>) {
        let default = [(8.5, 8), (6.5, 8), (4.5, 8)][dimension - 1];
        let own =
            self.raw.ladders.displacement.iter().find(|ladder| usize::from(ladder.dimension) == dimension);
        let (support, rungs) = own.map_or(default, |ladder| (ladder.support_over_dx, ladder.rungs));
        let support = rational_from_decimal(support).unwrap_or_else(|_| int(0));
        let rungs = if self.quick { rungs.min(5) } else { rungs };
        (support, (0..rungs).map(|step| 0.5_f64.powi(step as i32)).collect())
    }

    /// The most blocks, and the relative precision at which sampling stops.
    pub fn sampling(&self) -> (u64, f64) {
        let samples = &self.raw.samples;
        if self.quick {
            (samples.most_blocks.min(8), samples.precision.max(0.05))
        } else {
            (samples.most_blocks, samples.precision)
        }
    }

    /// Whole R/Δ in geometric steps, each with offsets over one spacing of h/Δ: the knots of a kernel lie at multiples of
    /// h, so that is how long it takes all of them to pass a particle.
    fn supports(&self, ladder: &DxLadder, kernel: &Kernel) -> Vec<Vec<Rational>> {
        // A first look stops at a third of the reach, but keeps the two octaves that a fit needs.
        let to = if self.quick { (ladder.to / 3).max(4 * ladder.from).min(ladder.to) } else { ladder.to };
        let steps = ladder.rungs.max(2) - 1;
        let ratio_of_ends = f64::from(to) / f64::from(ladder.from);
        let mut rungs: Vec<i64> = (0..=steps)
            .map(|step| {
                let exponent = f64::from(step) / f64::from(steps);
                (f64::from(ladder.from) * libm::pow(ratio_of_ends, exponent)).round() as i64
            })
            .collect();
        rungs.dedup();
        let per_spacing = i64::from(ladder.offsets.max(1));
        let span = kernel.support_over_h();
        let count = (span * int(per_spacing)).ceil().to_integer().to_i64().unwrap_or(per_spacing);
        rungs.iter().map(|rung| (0..count).map(|k| int(*rung) + ratio(k, count) * span).collect()).collect()
    }
}

/// Reads TOML or JSON, with the place of what does not fit.
pub(super) fn parse<T: serde::de::DeserializeOwned>(text: &SceneText) -> Result<T, SceneError> {
    if text.is_json() {
        serde_json::from_str(&text.text).map_err(|error| {
            let line_start: usize =
                text.text.split_inclusive('\n').take(error.line().max(1) - 1).map(str::len).sum();
            let at = (line_start + error.column().saturating_sub(1)).min(text.text.len());
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or_default().to_owned();
            SceneError { scene: text.clone(), span: Some(at..at), message, help: None }
        })
    } else {
        toml::from_str(&text.text).map_err(|error| SceneError {
            scene: text.clone(),
            span: error.span(),
            message: error.message().to_owned(),
            help: None,
        })
    }
}

/// Reads a kernel from a file of its own.
///
/// # Errors
/// [`SceneError`] with line and column where there is one.
pub fn read_kernel(path: &Path) -> Result<Kernel, SceneError> {
    let nowhere = SceneText { path: path.to_owned(), text: String::new() };
    let text = std::fs::read_to_string(path)
        .map_err(|error| nowhere.error(format!("cannot be read as a kernel ({error})")))?;
    let text = SceneText { path: path.to_owned(), text };
    let mut definition: KernelDefinition = parse(&text)?;
    if definition.id.is_empty() {
        definition.id = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or("kernel").into();
    }
    definition.build().map_err(|error| text.error_at(&error.field(), error.to_string(), None))
}

fn dx_ladder(
    own: &[DxLadder],
    dimension: usize,
    (from, to, rungs, offsets): (u32, u32, u32, u32),
) -> DxLadder {
    let default = DxLadder { dimension: dimension as u8, from, to, rungs, offsets };
    own.iter().find(|ladder| usize::from(ladder.dimension) == dimension).cloned().unwrap_or(default)
}

/// Resolves a list of names, with the place of the one at fault.
fn each<T, E: std::fmt::Display>(
    names: &[String],
    keys: &str,
    at: impl Fn(String, String) -> SceneError,
    resolve: impl Fn(&str) -> Result<T, E>,
) -> Result<Vec<T>, SceneError> {
    let resolved = names.iter().enumerate().map(|(index, name)| {
        if names[..index].contains(name) {
            return Err(at(format!("{keys}.{index}"), format!("names '{name}' twice")));
        }
        resolve(name).map_err(|error| at(format!("{keys}.{index}"), error.to_string()))
    });
    resolved.collect()
}

fn own_kernels(define: &DefineTable, text: &SceneText) -> Result<Vec<Kernel>, SceneError> {
    let at = |keys: String, message: String| text.error_at(&keys, message, None);
    let mut own: Vec<Kernel> = Vec::new();
    for (index, definition) in define.kernel.iter().enumerate() {
        let place = |field: &str| format!("define.kernel.{index}.{field}");
        let kernel = definition.build().map_err(|error| at(place(&error.field()), error.to_string()))?;
        if own.iter().any(|known| known.id() == kernel.id()) {
            return Err(at(place("id"), format!("defines the kernel '{}' twice", kernel.id())));
        }
        own.push(kernel);
    }
    Ok(own)
}

/// Reads what a scene defines (`[[define.kernel]]`, `[[define.lattice]]`), and nothing else of it.
///
/// # Errors
/// [`SceneError`] with line and column where there is one.
pub fn read_definitions(path: &Path) -> Result<(Vec<Kernel>, Vec<Lattice>), SceneError> {
    #[derive(Deserialize)]
    struct Definitions {
        #[serde(default)]
        define: DefineTable,
    }
    let nowhere = SceneText { path: path.to_owned(), text: String::new() };
    let text = std::fs::read_to_string(path)
        .map_err(|error| nowhere.error(format!("cannot be read as a scene ({error})")))?;
    let text = SceneText { path: path.to_owned(), text };
    let Definitions { define } = parse(&text)?;
    Ok((own_kernels(&define, &text)?, define_lattice::resolve(&define.lattice, &text)?))
}

/// Resolves the names under `[cases]`, and joins what several tables ask for.
fn resolve_cases(
    raw: &RawScene,
    own_kernels: &[Kernel],
    own_lattices: &[Lattice],
    at: impl Fn(String, String) -> SceneError + Copy,
) -> Result<Vec<CaseGroup>, SceneError> {
    let mut groups: Vec<CaseGroup> = Vec::new();
    for (table, cases) in raw.cases.tables.iter().enumerate() {
        let place = |field: &str| raw.cases.place(table, field);
        let kernels = each(&cases.kernels, &place("kernels"), at, |id| by_id_among(id, own_kernels))?;
        let lattices = each(&cases.lattices, &place("lattices"), at, |id| lattice_among(id, own_lattices))?;
        let rules = each(&cases.volume_rules, &place("volume_rules"), at, VolumeRule::by_id)?;
        for (list, key) in
            [(kernels.len(), "kernels"), (lattices.len(), "lattices"), (rules.len(), "volume_rules")]
        {
            if list == 0 {
                return Err(at(place(key), format!("names no {key}: give at least one")));
            }
        }
        let allow = raw.limits.allow_degenerate;
        let disorders = each(&cases.disorders, &place("disorders"), at, |text| {
            let disorder = Disorder::parse(text)?;
            for lattice in &lattices {
                disorder.check_dimension(lattice)?;
                if !allow {
                    disorder.check_reach(lattice)?;
                }
            }
            Ok::<_, crate::particles::ParticleError>(disorder)
        })?;
        let placed = disorders.iter().filter(|disorder| disorder.entry().moves != Moves::Nothing);
        let placed = placed.collect_vec();
        for ((lattice, kernel), rule) in lattices.iter().cartesian_product(&kernels).cartesian_product(&rules)
        {
            let same = |known: &CaseGroup| {
                known.lattice.id() == lattice.id() && known.kernel.id() == kernel.id() && known.rule == *rule
            };
            let index = groups.iter().position(same).unwrap_or_else(|| {
                let (lattice, kernel) = (lattice.clone(), kernel.clone());
                groups.push(CaseGroup { lattice, kernel, rule: *rule, disorders: Vec::new() });
                groups.len() - 1
            });
            let group = &mut groups[index];
            for disorder in &placed {
                if group.disorders.iter().all(|known| known.to_string() != disorder.to_string()) {
                    group.disorders.push((*disorder).clone());
                }
            }
        }
    }
    if groups.is_empty() {
        return Err(at("cases".into(), "names no case: give kernels and lattices".into()));
    }
    Ok(groups)
}

fn resolve_claims(
    raw: &RawScene,
    at: impl Fn(String, String) -> SceneError,
) -> Result<Vec<Claim>, SceneError> {
    let mut claims: Vec<Claim> = Vec::new();
    for (index, name) in raw.claims.chosen.iter().enumerate() {
        let chosen =
            claim::select(name).map_err(|error| at(format!("claims.use.{index}"), error.to_string()))?;
        for claim in chosen {
            if claims.iter().all(|known| known.id != claim.id) {
                claims.push(claim);
            }
        }
    }
    for (index, own) in raw.claims.own.iter().enumerate() {
        let place = |field: &str| format!("claims.own.{index}.{field}");
        let subject = own_subject(own, place, &at)?;
        let quantity = Quantity::by_id(&own.quantity).ok_or_else(|| {
            let message = format!(
                "there is no quantity '{}': write regular-value, regular-deviation or disorder-deviation",
                own.quantity
            );
            at(place("quantity"), message)
        })?;
        let written = [("displacement", &own.displacement), ("h", &own.h), ("dx_over_h", &own.dx_over_h)];
        for (field, text) in written {
            BetaExponent::parse(text).map_err(|error| at(place(field), error.to_string()))?;
        }
        let powers = Powers::parse(&own.displacement, &own.h, &own.dx_over_h)
            .map_err(|error| at(place("dx_over_h"), error.to_string()))?;
        powers.check(&subject).map_err(|error| at(place("h"), error.to_string()))?;
        claims.push(Claim {
            id: format!("own/{}", own.name),
            source: "scene".into(),
            location: format!("[[claims.own]] {}", index + 1),
            text: format!("{} = {powers}", quantity.formula(&subject)),
            subject,
            statement: Statement::PowerLaw { quantity, powers: Box::new(powers) },
            dimensions: &[1, 2, 3],
        });
    }
    if claims.is_empty() {
        return Err(at("claims".into(), "the scene checks no claim: name one under [claims] use".into()));
    }
    Ok(claims)
}

/// What a claim of one's own is about.
fn own_subject(
    own: &OwnClaim,
    place: impl Fn(&str) -> String,
    at: impl Fn(String, String) -> SceneError,
) -> Result<Subject, SceneError> {
    let Some(operator) = &own.operator else {
        let moment = Moment::by_name(&own.moment).map_err(|error| at(place("moment"), error.to_string()))?;
        return Ok(Subject::Moment(moment));
    };
    if !own.moment.is_empty() {
        return Err(at(place("operator"), "a claim is about a moment or an operator, not about both".into()));
    }
    let Some(order) = own.order.filter(|order| usize::from(*order) <= MOST_ORDER) else {
        let message = format!("an operator's claim needs order = 0 to {MOST_ORDER}: which ∇^m u it is about");
        return Err(at(place(if own.order.is_some() { "order" } else { "operator" }), message));
    };
    let coefficient = Coefficient::new(operator, order).map_err(|error| {
        let shown = operator.get(error.span.clone()).unwrap_or_default();
        at(place("operator"), format!("{error} (at byte {}: '{shown}')", error.span.start + 1))
    })?;
    Ok(Subject::Coefficient(coefficient))
}

/// The highest order of a coefficient in a claim.
const MOST_ORDER: usize = 8;

/// Memory per lattice site, for estimates before anything is laid.
const MIB_PER_SITE: f64 = 400.0 / (1_u64 << 20) as f64;

/// The most rungs or offsets of a ladder: a slip of the keyboard must not exhaust memory.
const MOST_STEPS: u32 = 1000;

/// The most samples in a block, and the most blocks.
const MOST_SAMPLES: u64 = 1 << 20;

fn twice(ladder: &str, dimension: u8) -> String {
    format!("there are two [[ladders.{ladder}]] for dimension {dimension}: keep one of them")
}

fn check_numbers(
    raw: &RawScene,
    lattices: &[&Lattice],
    at: impl Fn(String, String) -> SceneError,
) -> Result<(), SceneError> {
    let lists = [("regular", &raw.ladders.regular), ("disorder", &raw.ladders.disorder)];
    for (name, list) in lists {
        for (index, ladder) in list.iter().enumerate() {
            let place = |field: &str| format!("ladders.{name}.{index}.{field}");
            if !(1..=3).contains(&ladder.dimension) {
                return Err(at(
                    place("dimension"),
                    format!("dimension {} is not 1, 2 or 3", ladder.dimension),
                ));
            }
            if ladder.from == 0 {
                return Err(at(place("from"), "R/Δ must be positive".into()));
            }
            if list[..index].iter().any(|other| other.dimension == ladder.dimension) {
                return Err(at(place("dimension"), twice(name, ladder.dimension)));
            }
            if ladder.to / 4 < ladder.from {
                let message = format!(
                    "the window {} … {} spans less than two octaves, which decides no order: raise `to` to at least {}",
                    ladder.from,
                    ladder.to,
                    4 * u64::from(ladder.from)
                );
                return Err(at(place("to"), message));
            }
            if ladder.rungs < 5 {
                return Err(at(
                    place("rungs"),
                    format!("{} rungs decide no order: give at least 5", ladder.rungs),
                ));
            }
            if ladder.offsets == 0 {
                return Err(at(place("offsets"), "an envelope needs at least one offset".into()));
            }
            for (field, count) in [("rungs", ladder.rungs), ("offsets", ladder.offsets)] {
                if count > MOST_STEPS {
                    return Err(at(place(field), format!("{count} {field}: give at most {MOST_STEPS}")));
                }
            }
            for lattice in
                lattices.iter().filter(|lattice| lattice.dimension() == usize::from(ladder.dimension))
            {
                let nearest = nearest_distance(lattice);
                if f64::from(ladder.from) <= nearest {
                    let message = format!(
                        "R/Δ = {} leaves particle i without neighbours on lattice '{}', whose nearest is at {nearest} Δ",
                        ladder.from,
                        lattice.id()
                    );
                    return Err(at(place("from"), message));
                }
                let sites = lattice.estimate_within(f64::from(ladder.to) + 1.0);
                let needed = sites * MIB_PER_SITE;
                if needed > raw.limits.memory_mib as f64 {
                    let message = format!(
                        "R/Δ = {} on lattice '{}' needs about {needed:.0} MiB for {sites:.2e} sites, more than the {} MiB of limits.memory_mib",
                        ladder.to,
                        lattice.id(),
                        raw.limits.memory_mib
                    );
                    return Err(at(place("to"), message));
                }
            }
        }
    }
    for (index, ladder) in raw.ladders.displacement.iter().enumerate() {
        let place = |field: &str| format!("ladders.displacement.{index}.{field}");
        if !(1..=3).contains(&ladder.dimension) {
            return Err(at(place("dimension"), format!("dimension {} is not 1, 2 or 3", ladder.dimension)));
        }
        if raw.ladders.displacement[..index].iter().any(|other| other.dimension == ladder.dimension) {
            return Err(at(place("dimension"), twice("displacement", ladder.dimension)));
        }
        let support = ladder.support_over_dx;
        if !support.is_finite() || support <= 0.0 {
            return Err(at(place("support_over_dx"), format!("R/Δ = {support} must be finite and positive")));
        }
        if ladder.rungs < 5 || ladder.rungs > 40 {
            return Err(at(
                place("rungs"),
                format!("{} rungs: give 5 to 40 halvings of the amplitude", ladder.rungs),
            ));
        }
        for lattice in lattices.iter().filter(|lattice| lattice.dimension() == usize::from(ladder.dimension))
        {
            let nearest = nearest_distance(lattice);
            if support <= nearest {
                let message = format!(
                    "R/Δ = {support} leaves particle i without neighbours on lattice '{}', whose nearest is at {nearest} Δ",
                    lattice.id()
                );
                return Err(at(place("support_over_dx"), message));
            }
            let needed = lattice.estimate_within(support + 1.0) * MIB_PER_SITE;
            if needed > raw.limits.memory_mib as f64 {
                let message = format!(
                    "R/Δ = {support} on lattice '{}' needs about {needed:.0} MiB, more than the {} MiB of limits.memory_mib",
                    lattice.id(),
                    raw.limits.memory_mib
                );
                return Err(at(place("support_over_dx"), message));
            }
        }
    }
    let samples = &raw.samples;
    if samples.block < 2 || samples.most_blocks < 1 {
        return Err(at(
            "samples.block".into(),
            "sampling needs blocks of at least 2 samples, and at least one block".into(),
        ));
    }
    for (field, count) in [("block", samples.block), ("most_blocks", samples.most_blocks)] {
        if count > MOST_SAMPLES {
            return Err(at(
                format!("samples.{field}"),
                format!("{count} is too many: give at most {MOST_SAMPLES}"),
            ));
        }
    }
    if !(samples.precision.is_finite() && samples.precision > 0.0) {
        return Err(at(
            "samples.precision".into(),
            format!("the precision {} must be finite and positive", samples.precision),
        ));
    }
    if !(raw.comparison.margin.is_finite() && raw.comparison.margin > 0.0) {
        return Err(at(
            "comparison.margin".into(),
            format!("the margin {} must be finite and positive", raw.comparison.margin),
        ));
    }
    Ok(())
}
