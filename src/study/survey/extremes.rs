//! A battery of extreme cases over every operator: what is refused, what loses digits, and whether the loss is foretold.
//!
//! Each value is computed as any program of the crate computes it, and compared with the same in twice the digits and with a
//! bound made while computing ([`rounding`]). Where the bound leaves more than [`KEPT`] of sixteen digits, a value is
//! `accurate`; else it is `degraded`; or it is `refused`, with the reason.

use super::super::plan::Omission;
use super::{Parameters, Row, Survey, SurveyTask, TaskError, entry, table_row};
use crate::claim::{Assertion, Observed, Published};
use crate::kernel::Kernel;
use crate::language::{Operator, operators};
use crate::measured::{Program, Rounding, RoundingError, computed, rounding};
use crate::particles::{Cloud, Support};
use crate::record::{Case, Report, significant};
use itertools::{Itertools as _, iproduct};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::f64::consts::PI;

/// Digits of sixteen that a value keeps to be called accurate.
const KEPT: f64 = 12.0;

/// All digits of an f64.
const ALL: f64 = 15.954_589_770_191_003;

/// More neighbours of neighbours than this are too many: operators inside operators are left out there.
const MOST_NESTED: f64 = 1e5;

/// More neighbours than this are too many for any operator.
const MOST_NEIGHBOURS: f64 = 1e5;

/// How far particles are off their lattice along each axis, over Δ, unless said otherwise.
const JITTER: f64 = 0.1;

/// `[survey]` of kind `extremes`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Extremes {
    /// Id of a kernel made of polynomials.
    pub kernel: String,
    /// Operators, by id or as text; all of the catalogue if there are none.
    pub operators: Vec<String>,
    /// D, 2 or 3; `--quick` takes the first.
    pub dimensions: Vec<usize>,
    /// R/Δ of all cases but those that vary it.
    pub support_over_dx: f64,
    /// R/Δ tried on the regular lattice.
    pub supports: Vec<f64>,
    /// By how much particles are moved along each axis, over Δ.
    pub jitters: Vec<f64>,
    /// Distances of two particles over Δ; 0 is one place.
    pub pairs: Vec<f64>,
    /// Spacings along the other axes over those along the last one.
    pub aspects: Vec<f64>,
    /// Lengths are multiplied by these powers of two; 2^494 is 5e148, and coordinates end at 1e150.
    pub length_powers: Vec<i32>,
    /// The field is multiplied by these powers of two; 2^996 is 7e299.
    pub field_powers: Vec<i32>,
    /// The origin is as many Δ away along each axis.
    pub origins: Vec<f64>,
    /// Constants added to the field.
    pub constants: Vec<f64>,
    /// Volumes spread over so many decades.
    pub decades: Vec<f64>,
}

impl Default for Extremes {
    fn default() -> Self {
        Self {
            kernel: "wendland-c2".into(),
            operators: Vec::new(),
            dimensions: vec![2, 3],
            support_over_dx: 2.5,
            supports: vec![1.02, 1.2, 1.5, 4.0, 16.0, 64.0],
            jitters: vec![0.1, 0.5],
            pairs: vec![1e-6, 1e-12, 0.0],
            aspects: vec![10.0, 100.0, 1000.0],
            length_powers: vec![-494, -249, 249, 494],
            field_powers: vec![-996, 996],
            origins: vec![1e4, 1e8],
            constants: vec![1e6, 1e12],
            decades: vec![10.0],
        }
    }
}

/// What is extreme.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Situation {
    /// R/Δ, on the regular lattice.
    Support(f64),
    /// Particles moved by up to so much of Δ along each axis.
    Jitter(f64),
    /// Another particle at this distance from i.
    PairAtCentre(f64),
    /// Two neighbours of i at this distance.
    PairBeside(f64),
    /// All particles on a line through i that is no axis.
    Line,
    /// None with a coordinate below that of i along x.
    HalfSpace,
    /// None with any coordinate below that of i.
    Corner,
    /// Spacing along the last axis smaller by this factor.
    Aspect(f64),
    /// Lengths times 2^p.
    Length(i32),
    /// The field times 2^p.
    Field(i32),
    /// Coordinates plus so many Δ.
    Origin(f64),
    /// The field plus this.
    Constant(f64),
    /// Volumes over so many decades.
    Volumes(f64),
}

impl Situation {
    /// Where particles stand but for what the situation does to them.
    fn disorder(self) -> Option<String> {
        let by = match self {
            Self::Support(_) => return None,
            Self::Jitter(by) => by,
            _ => JITTER,
        };
        // Under `box:ε` they are moved by up to ε/4.
        Some(format!("box:{}", 4.0 * by))
    }

    fn name(self) -> String {
        match self {
            Self::Support(support) => format!("R/Δ = {support}"),
            Self::Jitter(by) => format!("moved by up to {by} Δ along each axis"),
            Self::PairAtCentre(0.0) => "a particle in the place of i".into(),
            Self::PairAtCentre(apart) => format!("a particle {apart:e} Δ from i"),
            Self::PairBeside(0.0) => "two neighbours in one place".into(),
            Self::PairBeside(apart) => format!("two neighbours {apart:e} Δ apart"),
            Self::Line => "on a line".into(),
            Self::HalfSpace => "in a half-space".into(),
            Self::Corner => "in a corner".into(),
            Self::Aspect(ratio) => format!("aspect ratio 1:{ratio}"),
            Self::Length(power) => format!("lengths times 2^{power}"),
            Self::Field(power) => format!("K_x = 2^{power}"),
            Self::Origin(away) => format!("origin {away:e} Δ away"),
            Self::Constant(plus) => format!("{plus:e} added to u"),
            Self::Volumes(decades) => format!("volumes over {decades} decades"),
        }
    }
}

/// Particles, the one that is looked at, and the field.
struct Setting {
    cloud: Cloud,
    i: usize,
    field: Vec<[f64; 3]>,
}

impl Parameters for Extremes {
    fn survey(self, _seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        let kernel =
            crate::kernel::by_id(&self.kernel).map_err(|error| ("kernel".to_owned(), error.to_string()))?;
        if kernel.polynomial().is_none() {
            let message = format!(
                "'{}' has no values in twice the digits: take a kernel made of polynomials",
                self.kernel
            );
            return Err(("kernel".into(), message));
        }
        let within = |key: &str, values: &[f64], from: f64, to: f64| match values
            .iter()
            .find(|value| !(from..=to).contains(*value))
        {
            Some(value) => Err((key.to_owned(), format!("{value} is not between {from} and {to}"))),
            None => Ok(()),
        };
        if self.dimensions.is_empty() {
            return Err(("dimensions".into(), "names none: give 2, 3 or both".into()));
        }
        if let Some(other) = self.dimensions.iter().find(|dimension| ![2, 3].contains(*dimension)) {
            return Err(("dimensions".into(), format!("{other} is neither 2 nor 3")));
        }
        within("support_over_dx", &[self.support_over_dx], 1.0, 8.0)?;
        within("supports", &self.supports, 0.1, 128.0)?;
        within("jitters", &self.jitters, 0.0, 0.5)?;
        within("pairs", &self.pairs, 0.0, 1.0)?;
        within("aspects", &self.aspects, 1.0, 1000.0)?;
        within("origins", &self.origins, 0.0, 1e12)?;
        within("constants", &self.constants, -1e300, 1e300)?;
        within("decades", &self.decades, 0.0, 300.0)?;
        let powers = |key: &str, powers: &[i32], most: i32| match powers.iter().find(|p| p.abs() > most) {
            Some(power) => Err((key.to_owned(), format!("2^{power} is beyond 2^±{most}"))),
            None => Ok(()),
        };
        powers("length_powers", &self.length_powers, 498)?;
        powers("field_powers", &self.field_powers, 1000)?;
        let named: Vec<String> = match self.operators.is_empty() {
            true => operators::catalogue().into_iter().map(|entry| entry.id.to_owned()).collect(),
            false => self.operators.clone(),
        };
        let mut subjects = Vec::new();
        for name in named {
            let operator =
                operators::named_or_written(&name).map_err(|message| ("operators".to_owned(), message))?;
            let mut nested = false;
            for dimension in &self.dimensions {
                let program = Program::new(&operator, &kernel, *dimension)
                    .map_err(|error| ("operators".to_owned(), format!("'{name}': {error}")))?;
                nested = program.passes() > 1;
            }
            subjects.push(Subject { name, nested, operator });
        }
        use Situation as S;
        let mut situations = Vec::new();
        situations.extend(self.supports.iter().filter(|r| !quick || **r <= 4.0).map(|r| S::Support(*r)));
        situations.extend(self.jitters.iter().map(|by| S::Jitter(*by)));
        situations
            .extend(self.pairs.iter().flat_map(|apart| [S::PairAtCentre(*apart), S::PairBeside(*apart)]));
        situations.extend([S::Line, S::HalfSpace, S::Corner]);
        situations
            .extend(self.aspects.iter().filter(|a| !quick || **a <= 10.0).map(|ratio| S::Aspect(*ratio)));
        situations.extend(self.length_powers.iter().map(|power| S::Length(*power)));
        situations.extend(self.field_powers.iter().map(|power| S::Field(*power)));
        situations.extend(self.origins.iter().map(|away| S::Origin(*away)));
        situations.extend(self.constants.iter().map(|plus| S::Constant(*plus)));
        situations.extend(self.decades.iter().map(|decades| S::Volumes(*decades)));
        let dimensions = self.dimensions.iter().copied().unique().take(if quick { 1 } else { usize::MAX });
        let all = dimensions.cartesian_product(situations).map(|(dimension, situation)| Posed {
            dimension,
            situation,
            neighbours: neighbours(dimension, situation, self.support_over_dx),
        });
        let (posed, too_many) = all.partition(|posed| posed.neighbours <= MOST_NEIGHBOURS);
        Ok(Box::new(Battery { kernel, subjects, posed, too_many, scene: self }))
    }
}

struct Subject {
    name: String,
    operator: Operator,
    /// Whether it takes sums at neighbours.
    nested: bool,
}

/// A situation in so many dimensions.
#[derive(Debug, Clone, Copy)]
struct Posed {
    dimension: usize,
    situation: Situation,
    /// About so many.
    neighbours: f64,
}

impl Posed {
    fn name(self) -> String {
        format!("{}-D, {}", self.dimension, self.situation.name())
    }

    /// Whether a subject is left out here.
    fn leaves_out(self, subject: &Subject) -> bool {
        subject.nested && self.neighbours.powi(2) > MOST_NESTED
    }
}

/// About how many neighbours there are.
fn neighbours(dimension: usize, situation: Situation, support: f64) -> f64 {
    let ball = |r: f64| if dimension == 2 { PI * r * r } else { 4.0 / 3.0 * PI * r.powi(3) };
    match situation {
        Situation::Support(support) => ball(support),
        Situation::Aspect(ratio) => ratio * ball(support),
        _ => ball(support),
    }
}

struct Battery {
    scene: Extremes,
    kernel: Kernel,
    subjects: Vec<Subject>,
    posed: Vec<Posed>,
    /// Left out.
    too_many: Vec<Posed>,
}

/// One operator in one situation.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Found {
    dimension: usize,
    situation: String,
    operator: String,
    neighbours: usize,
    /// `accurate`, `degraded`, `refused`.
    status: String,
    /// Decimal digits that the bound gives up.
    digits_lost_predicted: Option<f64>,
    /// That were lost, on the data as stored.
    digits_lost: Option<f64>,
    /// That storing the data loses before anything is computed.
    digits_lost_in_data: Option<f64>,
    /// Correct digits in f32.
    digits_in_f32: Option<f64>,
    condition_b: Option<f64>,
    condition_b_hat: Option<f64>,
    /// Lengths or field scaled by a power of two: whether the value is the same to the bit.
    same_bits: Option<bool>,
    reason: Option<String>,
}

/// A number in [0, 1) for a place, whatever else there is.
fn random([x, y, z]: [i32; 3], what: u64) -> f64 {
    let mut z = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f)
        ^ (z as u64).wrapping_mul(0x1656_67b1_9e37_79f9)
        ^ what;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

impl Battery {
    /// The particles in units of Δ, before lengths and the field are scaled.
    fn place(&self, posed: Posed, nested: bool) -> Result<Setting, TaskError> {
        let Posed { dimension, situation, .. } = posed;
        let support = match situation {
            Situation::Support(support) => support,
            _ => self.scene.support_over_dx,
        };
        let reach = if nested { 2.0 * support } else { support };
        let jitter = match situation {
            Situation::Support(_) => 0.0,
            Situation::Jitter(by) => by,
            _ => JITTER,
        };
        let ratio = match situation {
            Situation::Aspect(ratio) => ratio,
            _ => 1.0,
        };
        let last = dimension - 1;
        // A wall is straight.
        let wall = |axis: usize| match situation {
            Situation::HalfSpace => axis == 0,
            Situation::Corner => true,
            _ => false,
        };
        let sites = |axis: usize| {
            let there = axis == 0 || axis < dimension && situation != Situation::Line;
            // As dense along the last axis as it takes, but no wider than what is seen.
            let half = match situation {
                _ if !there => 0,
                Situation::Aspect(_) if axis == last => ((reach + 1.0) * ratio).ceil() as i32,
                _ => reach.ceil() as i32 + 1,
            };
            if wall(axis) { 0..=half } else { -half..=half }
        };
        let mut places = Vec::new();
        for (x, y, z) in iproduct!(sites(0), sites(1), sites(2)) {
            let site = [x, y, z];
            let by = |axis: usize| 2.0 * jitter * (random(site, axis as u64 + 1) - 0.5);
            places.push(if site == [0; 3] {
                [0.0; 3]
            } else if situation == Situation::Line {
                unit(dimension, true).map(|e| e * (f64::from(x) + by(0)))
            } else {
                std::array::from_fn(|axis| {
                    let moves = axis < dimension && !(wall(axis) && site[axis] == 0);
                    let along = f64::from(site[axis]) + if moves { by(axis) } else { 0.0 };
                    if axis == last { along / ratio } else { along }
                })
            });
        }
        let i = places.iter().position(|place| *place == [0.0; 3]).unwrap_or(0);
        let direction = unit(dimension, false);
        match situation {
            Situation::PairAtCentre(apart) => places.push(direction.map(|d| d * apart)),
            Situation::PairBeside(apart) => {
                let beside = |p: &[f64; 3]| p[0] > 0.5 && p[0] < 1.5 && p[1].abs().max(p[2].abs()) < 0.5;
                let beside = places[places.iter().position(beside).unwrap_or(0)];
                places.push(std::array::from_fn(|axis| beside[axis] + direction[axis] * apart));
            }
            _ => {}
        }
        let meant = |[x, y, z]: [f64; 3]| {
            let first = libm::sin(0.7 * x + 0.3) + 0.3 * libm::cos(0.9 * y + 0.2) + 0.1 * x * y;
            [
                first + 0.2 * libm::sin(0.8 * z) + 0.1 * x * z,
                libm::cos(0.5 * x - 0.4 * y + 0.1) + 0.1 * y * z,
                if dimension == 3 { libm::sin(0.6 * z + 0.2 * x) } else { 0.0 },
            ]
        };
        let plus = if let Situation::Constant(plus) = situation { plus } else { 0.0 };
        let field = places.iter().map(|place| meant(*place).map(|u| u + plus)).collect();
        let away = if let Situation::Origin(away) = situation { away } else { 0.0 };
        let volumes = (0..places.len()).map(|p| match situation {
            Situation::Volumes(decades) => libm::exp10(decades * (of_particle(p, 3) - 0.5)),
            _ => (1.0 + 0.1 * of_particle(p, 3)) / ratio,
        });
        let shifted = |place: &[f64; 3]| -> [f64; 3] {
            std::array::from_fn(|axis| place[axis] + if axis < dimension { away } else { 0.0 })
        };
        let positions = places.iter().map(shifted).collect();
        let cloud = Cloud::new(dimension, positions, volumes.collect(), Support::Uniform(support))?;
        Ok(Setting { cloud: carrying(cloud, 0)?, i, field })
    }

    fn found(&self, posed: Posed, subject: &Subject) -> Result<Found, TaskError> {
        let situation = posed.situation;
        let setting = self.place(posed, subject.nested)?;
        let Setting { cloud, i, field } = &setting;
        let neighbours = crate::particles::Neighbours::search_at(cloud, &[*i])?.of(0).len() - 1;
        let mut found = Found {
            dimension: posed.dimension,
            situation: situation.name(),
            operator: subject.name.clone(),
            neighbours,
            status: "refused".into(),
            digits_lost_predicted: None,
            digits_lost: None,
            digits_lost_in_data: None,
            digits_in_f32: None,
            condition_b: None,
            condition_b_hat: None,
            same_bits: None,
            reason: None,
        };
        let result = rounding(&subject.operator, &self.kernel, cloud, *i, field);
        let mut result = match result {
            Ok(result) => result,
            Err(error) => {
                found.reason = Some(error.to_string());
                return Ok(found);
            }
        };
        let exact = result.exact.clone();
        let powers = match situation {
            Situation::Length(power) => Some((power, 0)),
            Situation::Field(power) => Some((0, power)),
            _ => None,
        };
        if let Some((length, field)) = powers {
            match self.scaled(subject, &setting, &mut result, length, field)? {
                Ok(same) => found.same_bits = Some(same),
                Err(refusal) => {
                    found.reason = Some(refusal.to_string());
                    return Ok(found);
                }
            }
        }
        match situation {
            Situation::Origin(_) => {
                let meant =
                    self.place(Posed { situation: Situation::Jitter(JITTER), ..posed }, subject.nested)?;
                let meant = rounding(&subject.operator, &self.kernel, &meant.cloud, meant.i, &meant.field)?;
                found.digits_lost_in_data = Some(shown(digits(&exact, &meant.exact)));
            }
            Situation::Constant(plus) => {
                let meant =
                    self.place(Posed { situation: Situation::Jitter(JITTER), ..posed }, subject.nested)?;
                let of = |field: &[[f64; 3]]| rounding(&subject.operator, &self.kernel, cloud, *i, field);
                let (varying, constant) = (of(&meant.field)?, of(&vec![[1.0; 3]; field.len()])?);
                let together = varying.exact.iter().zip(&constant.exact).map(|(u, one)| u + plus * one);
                found.digits_lost_in_data = Some(shown(digits(&exact, &together.collect_vec())));
            }
            _ => {}
        }
        if result.computed.iter().any(|value| !value.is_finite()) {
            found.reason = Some("the value is beyond the largest number".into());
            return Ok(found);
        }
        found.status = if result.predicted <= ALL - KEPT { "accurate".into() } else { "degraded".into() };
        if result.predicted > ALL - KEPT {
            let by = result.predicted.ceil().min(16.0);
            found.reason =
                Some(format!("by {by} digits of 16{}", if by >= 16.0 { ": none may be left" } else { "" }));
        }
        found.digits_lost_predicted = Some(shown(result.predicted.min(ALL)));
        found.digits_lost = Some(shown(result.lost.min(ALL)));
        found.digits_in_f32 = result.single.map(|digits| shown(digits.max(0.0)));
        found.condition_b = result.condition_b.map(|kappa| significant(kappa, 4));
        found.condition_b_hat = result.condition_b_hat.map(|kappa| significant(kappa, 4));
        Ok(found)
    }

    /// Computes with lengths and field multiplied by powers of two, scales back, and says whether the bits are the same.
    fn scaled(
        &self,
        subject: &Subject,
        setting: &Setting,
        result: &mut Rounding,
        length: i32,
        field: i32,
    ) -> Result<Result<bool, RoundingError>, TaskError> {
        let times = |value: f64, power: i32| libm::scalbn(value, power);
        let dimension = setting.cloud.dimension();
        let positions = setting.cloud.positions().iter().map(|x| x.map(|x| times(x, length))).collect();
        let volumes = setting.cloud.volumes().iter().map(|v| times(*v, length * dimension as i32)).collect();
        let support = Support::Uniform(times(setting.cloud.support_of(setting.i), length));
        let cloud = match Cloud::new(dimension, positions, volumes, support) {
            Ok(cloud) => carrying(cloud, length)?,
            Err(refusal) => return Ok(Err(refusal.into())),
        };
        let values = setting.field.iter().map(|u| u.map(|u| times(u, field))).collect_vec();
        let units = subject.operator.root.units;
        let power = length * (units.length + units.volume * dimension as i32) + field;
        let found = match computed(&subject.operator, &self.kernel, &cloud, setting.i, &values) {
            Ok(found) => found,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let back = found.into_iter().map(|value| times(value, -power)).collect_vec();
        let same = back == result.computed;
        result.lost = digits(&back, &result.exact);
        result.computed = back;
        Ok(Ok(same))
    }
}

/// A number in [0, 1) for a particle.
fn of_particle(particle: usize, what: u64) -> f64 {
    random([particle as i32, 0, 0], what)
}

/// A unit vector along no axis, and another.
fn unit(dimension: usize, line: bool) -> [f64; 3] {
    match (dimension, line) {
        (2, true) => [0.8, 0.6, 0.0],
        (2, false) => [0.6, 0.8, 0.0],
        (_, true) => [0.48, 0.6, 0.64],
        (_, false) => [0.36, 0.48, 0.8],
    }
}

/// With ρ, m and μ, where lengths are 2^power.
fn carrying(cloud: Cloud, power: i32) -> Result<Cloud, TaskError> {
    let count = cloud.len();
    let density = libm::scalbn(1.25, -power * cloud.dimension() as i32);
    let mass = cloud.volumes().iter().map(|volume| density * volume).collect();
    Ok(cloud
        .with_field("density", vec![density; count])?
        .with_field("mass", mass)?
        .with_field("viscosity", (0..count).map(|p| 0.5 + 0.1 * of_particle(p, 4)).collect())?)
}

/// log₁₀ of how far `found` is from `exact` over 2⁻⁵³ times that.
fn digits(found: &[f64], exact: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let off = largest(&mut found.iter().zip(exact).map(|(a, b)| a - b));
    let size = largest(&mut exact.iter().copied());
    if off == 0.0 { 0.0 } else { libm::log10(off / (0.5 * f64::EPSILON * size)).clamp(0.0, ALL) }
}

fn shown(digits: f64) -> f64 {
    (100.0 * digits).round() / 100.0
}

/// How many operators came out how in one situation.
#[derive(Serialize)]
struct Summary {
    dimension: usize,
    situation: String,
    accurate: usize,
    degraded: usize,
    refused: usize,
    most_lost: f64,
    by: String,
    predicted_there: f64,
}

fn assertion(id: &str, text: &str) -> Assertion {
    Assertion {
        id: format!("extremes/{id}"),
        source: "scene",
        location: "docs/extremes.md".into(),
        text: text.into(),
        published: Published::Never,
    }
}

fn assertions() -> [Assertion; 2] {
    [
        assertion("loss-foretold", "no value loses more digits than its bound foretells"),
        assertion("powers-of-two", "lengths and fields times powers of two change no bit of a value"),
    ]
}

impl Survey for Battery {
    fn tasks(&self) -> Vec<SurveyTask> {
        let names = self
            .subjects
            .iter()
            .map(|subject| format!("{}: {}", subject.name, subject.operator.text))
            .join("\n");
        let task = |posed: &Posed| {
            let label = posed.name();
            let inputs = format!(
                "extremes/2\n{label}\nkernel {}\nR/Δ {}\n{names}",
                self.kernel.id(),
                self.scene.support_over_dx
            );
            let taken = self.subjects.iter().filter(|subject| !posed.leaves_out(subject));
            let pairs = taken.map(|subject| posed.neighbours.powi(if subject.nested { 2 } else { 1 }));
            SurveyTask { label, inputs, cost: (1e3 * pairs.sum::<f64>()) as u64 }
        };
        self.posed.iter().map(task).collect()
    }

    fn claims(&self) -> Vec<String> {
        assertions().into_iter().map(|assertion| assertion.id).collect()
    }

    fn omissions(&self) -> Vec<Omission> {
        let nested = self.subjects.iter().filter(|subject| subject.nested);
        let names = nested.map(|subject| subject.name.as_str()).join(", ");
        let all = (self.posed.len() + self.too_many.len()) * self.subjects.len();
        let left = iproduct!(&self.posed, &self.subjects).filter(|(posed, of)| posed.leaves_out(of)).count();
        let many = self.too_many.iter().map(|posed| posed.name()).join("; ");
        let nested = (left > 0).then(|| Omission {
            what: format!(
                "operators inside operators with more than {MOST_NESTED:e} neighbours of neighbours ({names})"
            ),
            why: "nothing new is seen there".into(),
            saved: Some(format!("{left} of {all} values")),
        });
        let large = (!self.too_many.is_empty()).then(|| Omission {
            what: format!("more than {MOST_NEIGHBOURS:e} neighbours ({many})"),
            why: "the lower dimension shows what so many do".into(),
            saved: Some(format!("{} of {all} values", self.too_many.len() * self.subjects.len())),
        });
        nested.into_iter().chain(large).collect()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let posed = self.posed[task];
        let taken = self.subjects.iter().filter(|subject| !posed.leaves_out(subject));
        let found: Vec<Found> = taken.map(|subject| self.found(posed, subject)).try_collect()?;
        Ok(serde_json::to_value(found)?)
    }

    fn found(&self, _task: usize, result: &Value) -> Option<String> {
        let found: Vec<Found> = serde_json::from_value(result.clone()).ok()?;
        let counts = found.iter().counts_by(|found| found.status.as_str()).into_iter().sorted();
        Some(counts.map(|(status, count)| format!("{count} {status}")).join(", "))
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let [foretold, powers] = assertions();
        let (mut rows, mut summary): (Vec<Row>, Vec<Row>) = (Vec::new(), Vec::new());
        for (posed, result) in self.posed.iter().zip(results) {
            let situation = posed.situation;
            let found: Vec<Found> = serde_json::from_value(result.clone())?;
            let count = |status: &str| found.iter().filter(|row| row.status == status).count();
            let loss = |row: &&Found| row.digits_lost.unwrap_or(0.0);
            let worst = found.iter().max_by(|a, b| loss(a).total_cmp(&loss(b)));
            summary.push(table_row(&Summary {
                dimension: posed.dimension,
                situation: situation.name(),
                accurate: count("accurate"),
                degraded: count("degraded"),
                refused: count("refused"),
                most_lost: worst.as_ref().map_or(0.0, loss),
                by: worst.map(|row| row.operator.clone()).unwrap_or_default(),
                predicted_there: worst.and_then(|row| row.digits_lost_predicted).unwrap_or(0.0),
            }));
            let case = || Case {
                source: "cloud".into(),
                dimension: posed.dimension as u8,
                kernel: self.kernel.id().into(),
                lattice: Some(if posed.dimension == 2 { "square" } else { "simple-cubic" }.into()),
                disorder: situation.disorder(),
                volume_rule: "constant".into(),
                more: [("situation".to_owned(), Value::from(situation.name()))].into(),
            };
            // Of the values there are, those for which a statement fails.
            let mut judge = |assertion: &Assertion, fails: Vec<bool>| {
                let count = fails.iter().filter(|fails| **fails).count();
                let observed = Observed::Exceptions { count, among: fails.len() };
                report.claims.push(entry(assertion, case(), None, Some(observed), Vec::new()));
            };
            let losses = found.iter().filter_map(|row| row.digits_lost.zip(row.digits_lost_predicted));
            judge(&foretold, losses.map(|(lost, predicted)| lost > predicted + 0.01).collect());
            if matches!(situation, Situation::Length(_) | Situation::Field(_)) {
                judge(&powers, found.iter().filter_map(|row| row.same_bits).map(|same| !same).collect());
            }
            rows.extend(found.iter().map(table_row));
        }
        report.claims.sort_by_key(|claim| claim.id.clone());
        report.tables.insert("extremes".into(), rows);
        report.tables.insert("summary".into(), summary);
        Ok(())
    }
}
