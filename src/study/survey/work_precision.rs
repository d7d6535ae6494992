//! Work against precision: for every operator, kernel, R/Δ and disorder the error on a wave, derived and measured, beside what
//! an application costs, counted and timed, and the fronts of those that nothing beats in both.
//!
//! The wave is u = sin(kx) and cos(kx), k = 2π over so many Δ, on a periodic square lattice; errors are root mean squares
//! relative to k (gradients) or k² (Laplacians). Two costs are counted for each particle: of an assembled row (two operations
//! and 12 bytes a weight, and what is read and written), and of taking the sums anew.

use super::super::advise::{Request, derived_error};
use super::super::plan::Omission;
use super::{Parameters, Survey, SurveyTask, TaskError, entry, table_row};
use crate::claim::{Assertion, Measured, Observed, Published};
use crate::evolve::Matrix;
use crate::kernel::Kernel;
use crate::language::{Derivative, Field, Target, operators};
use crate::measured::{Fields, Program};
use crate::particles::{
    Cloud, Disorder, Draw, Lattice, Neighbours, SampleStream, Site, Support, lattice_by_id,
};
use crate::record::{Axis, Case, Line, Report, Series, significant};
use itertools::{Itertools as _, iproduct};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::time::Instant;

/// Significant digits: operators differ in their last ones from one processor to another where libraries do.
const DIGITS: usize = 6;

/// Operators drawn beside a front.
const MOST_LINES: usize = 4;

/// Runs of which the median is timed.
const TIMED: usize = 5;

/// `[survey]` of kind `work-precision`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct WorkPrecision {
    /// `gradient`, `laplacian`.
    pub derivatives: Vec<String>,
    /// Ids of operators; all of the catalogue on a scalar field if there are none.
    pub operators: Vec<String>,
    /// Ids of kernels.
    pub kernels: Vec<String>,
    /// R/Δ.
    pub support_over_dx: Vec<f64>,
    /// `MODEL:AMPLITUDE`, or `none`.
    pub disorders: Vec<String>,
    /// Wavelength over Δ; the periodic box is three of them wide.
    pub wavelength: u32,
}

impl Default for WorkPrecision {
    fn default() -> Self {
        let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect_vec();
        Self {
            derivatives: texts(&["gradient", "laplacian"]),
            operators: Vec::new(),
            kernels: texts(&["wendland-c2", "wendland-c4", "cubic-spline", "quintic-spline"]),
            support_over_dx: vec![1.5, 2.0, 2.5, 3.0, 4.0],
            disorders: texts(&["none", "box:0.05", "box:0.2"]),
            wavelength: 16,
        }
    }
}

fn derivative(name: &str) -> Option<Derivative> {
    match name {
        "gradient" => Some(Derivative::Gradient),
        "laplacian" => Some(Derivative::Laplacian { grad_div: 0 }),
        _ => None,
    }
}

impl Parameters for WorkPrecision {
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        let lattice = lattice_by_id("square").map_err(|error| ("lattice".to_owned(), error.to_string()))?;
        if !(4..=64).contains(&self.wavelength) {
            return Err(("wavelength".into(), format!("{} is not between 4 and 64 Δ", self.wavelength)));
        }
        // Neighbours of neighbours must not meet around the box.
        let most = 0.7 * f64::from(self.wavelength);
        if let Some(r) = self.support_over_dx.iter().find(|r| !(1.0..=most).contains(*r)) {
            return Err(("support_over_dx".into(), format!("{r} is not between 1 and {most:.1}")));
        }
        let mut kernels = Vec::new();
        for id in &self.kernels {
            let kernel =
                crate::kernel::by_id(id).map_err(|error| ("kernels".to_owned(), error.to_string()))?;
            kernels.push(kernel);
        }
        let mut disorders = Vec::new();
        for text in &self.disorders {
            let fault = |error: &dyn std::fmt::Display| ("disorders".to_owned(), error.to_string());
            let disorder = Disorder::parse(text).map_err(|error| fault(&error))?;
            disorder.check_dimension(&lattice).map_err(|error| fault(&error))?;
            disorder.check_reach(&lattice).map_err(|error| fault(&error))?;
            disorders.push((text.clone(), disorder));
        }
        let mut jobs = Vec::new();
        for name in &self.derivatives {
            let Some(derivative) = derivative(name) else {
                return Err(("derivatives".into(), format!("'{name}': write gradient or laplacian")));
            };
            let target = Target::plain(derivative);
            let fitting = operators::catalogue()
                .into_iter()
                .filter(|known| known.field == Field::Scalar && known.target == target)
                .filter(|known| self.operators.is_empty() || self.operators.iter().any(|id| id == known.id));
            for (known, kernel) in fitting.cartesian_product(0..kernels.len()) {
                for disorder in 0..disorders.len() {
                    jobs.push(Job { derivative, name: name.clone(), operator: known.id, kernel, disorder });
                }
            }
        }
        if let Some(id) = self.operators.iter().find(|id| !jobs.iter().any(|job| job.operator == *id)) {
            let known = operators::by_id(id).map_err(|error| ("operators".to_owned(), error.to_string()))?;
            let message =
                format!("'{}' is no gradient or Laplacian of a scalar field that is asked for", known.id);
            return Err(("operators".into(), message));
        }
        let scene = if quick {
            Self {
                support_over_dx: self.support_over_dx.iter().copied().filter(|r| *r <= 2.5).collect(),
                ..self
            }
        } else {
            self
        };
        if quick {
            jobs.retain(|job| job.kernel == 0);
        }
        Ok(Box::new(Fronts { scene, seed, lattice, kernels, disorders, jobs }))
    }
}

struct Job {
    derivative: Derivative,
    name: String,
    operator: &'static str,
    /// Which of the kernels, and of the disorders.
    kernel: usize,
    disorder: usize,
}

struct Fronts {
    scene: WorkPrecision,
    seed: u64,
    lattice: Lattice,
    kernels: Vec<Kernel>,
    disorders: Vec<(String, Disorder)>,
    jobs: Vec<Job>,
}

/// An operator with a kernel at one R/Δ.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Point {
    derivative: String,
    disorder: String,
    operator: String,
    kernel: String,
    support_over_dx: f64,
    /// Without the particle itself.
    neighbours: f64,
    /// Of an assembled row, on the mean.
    weights: f64,
    error_derived: Option<f64>,
    error_measured: f64,
    /// Of an assembled row, for each particle.
    flops_applied: f64,
    bytes_applied: f64,
    /// Of the sums taken anew, for each particle.
    flops_direct: f64,
    bytes_direct: f64,
    /// Of assembling.
    flops_assembled: f64,
    kernels_per_pair: u64,
    systems_per_particle: u64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Timed {
    /// For each particle, medians.
    seconds_applied: f64,
    seconds_direct: f64,
    seconds_assembled: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
enum Found {
    Value(Box<Point>, Timed),
    /// Operator, kernel, R/Δ, and why there is none.
    None(String, String, f64, String),
}

fn median(mut run: impl FnMut()) -> f64 {
    let mut seconds = (0..TIMED).map(|_| {
        let started = Instant::now();
        run();
        started.elapsed().as_secs_f64()
    });
    let mut seconds: [f64; TIMED] = std::array::from_fn(|_| seconds.next().unwrap_or(0.0));
    seconds.sort_by(f64::total_cmp);
    seconds[TIMED / 2]
}

impl Fronts {
    /// The particles, periodic, and the width of the box in Δ.
    fn cloud(&self, disorder: &Disorder, support: f64) -> Result<(Cloud, usize), TaskError> {
        let (n, motion) = (3 * self.scene.wavelength as usize, disorder.motion());
        let mut stream = SampleStream::new(self.seed, 0);
        let mut places = Vec::with_capacity(n * n);
        for (i, j) in iproduct!(0..n, 0..n) {
            let position = [i as f64, j as f64, 0.0];
            let site = Site { cell: [i as i64, j as i64, 0], basis: 0, position };
            let unit = (motion.unit)(&mut Draw::new(&self.lattice, &site, support, &mut stream));
            places.push(std::array::from_fn(|a| position[a] + disorder.amplitude() * unit[a]));
        }
        let cloud = Cloud::new(2, places, vec![1.0; n * n], Support::Uniform(support))?;
        let cloud = cloud.with_field("density", vec![1.0; n * n])?.with_field("mass", vec![1.0; n * n])?;
        Ok((cloud.with_periods([Some(n as f64), Some(n as f64), None])?, n))
    }

    fn point(&self, job: &Job, support: f64) -> Result<Found, TaskError> {
        let (kernel, (text, disorder)) = (&self.kernels[job.kernel], &self.disorders[job.disorder]);
        let operator = operators::by_id(job.operator)?.operator()?;
        let program = Program::new(&operator, kernel, 2)?;
        let (cloud, n) = self.cloud(disorder, support)?;
        let lists = Neighbours::search(&cloud)?;
        let k = 2.0 * std::f64::consts::PI / f64::from(self.scene.wavelength);
        let (count, components) = (n * n, program.components());
        let power = if components == 1 { 2 } else { 1 };
        let mut square = 0.0;
        let mut direct = 0.0;
        for sine in [true, false] {
            let wave = |x: f64| if sine { libm::sin(k * x) } else { libm::cos(k * x) };
            let u = cloud.positions().iter().map(|x| wave(x[0])).collect_vec();
            let found = match program.apply(&cloud, &lists, Fields::Scalar(&u)) {
                Ok(found) => found,
                Err(error) => {
                    let named = (job.operator.to_owned(), kernel.id().to_owned());
                    return Ok(Found::None(named.0, named.1, support, error.to_string()));
                }
            };
            for (own, x) in found.chunks(components).zip(cloud.positions()) {
                // u′ along x, and Δu = −k² u.
                let exact = match (power, sine) {
                    (2, _) => -k * k * wave(x[0]),
                    (_, true) => k * libm::cos(k * x[0]),
                    (_, false) => -k * libm::sin(k * x[0]),
                };
                square += own
                    .iter()
                    .enumerate()
                    .map(|(a, own)| (own - if a == 0 { exact } else { 0.0 }).powi(2))
                    .sum::<f64>();
            }
            if sine {
                direct = median(|| {
                    std::hint::black_box(program.apply(&cloud, &lists, Fields::Scalar(&u)).is_ok());
                });
            }
        }
        let error = (square / count as f64).sqrt() / k.powi(power);
        let weights = program.weights(&cloud, &lists)?;
        let assembled = median(|| {
            std::hint::black_box(program.weights(&cloud, &lists).is_ok());
        });
        // Components share the places of their weights, zeros among them; what an application costs depends on these alone.
        let places = weights.first().into_iter().flatten();
        let rows = places.map(|row| row.iter().map(|(j, _)| (*j, 1.0)).collect());
        let matrix = Matrix::from_rows(count, rows);
        let u = vec![1.0; count];
        let applied = median(|| {
            std::hint::black_box(matrix.apply(&u));
        });
        let (pairs, weights) = (lists.entry_count() as f64, matrix.entries() as f64);
        let counted = program.operations();
        let each = count as f64;
        let rounded = |value: f64| significant(value, DIGITS);
        let flops_direct = (counted.per_pair as f64 * pairs + counted.per_particle as f64 * each) / each;
        let still = disorder.model() == "none";
        let request = Request {
            derivative: job.derivative,
            tolerance: 0.0,
            lattice: &self.lattice,
            disorder: (!still).then_some(disorder),
            wavelength: f64::from(self.scene.wavelength),
            budget: None,
        };
        let derived = derived_error(&request, job.operator, kernel, support);
        let components = components as f64;
        let point = Point {
            derivative: job.name.clone(),
            disorder: text.clone(),
            operator: job.operator.into(),
            kernel: kernel.id().into(),
            support_over_dx: support,
            neighbours: rounded(pairs / each - 1.0),
            weights: rounded(weights / each),
            error_derived: derived.map(|found| rounded(found.error)),
            error_measured: rounded(error),
            flops_applied: rounded(2.0 * components * weights / each),
            bytes_applied: rounded((4.0 + 8.0 * components) * weights / each + 8.0 + 8.0 * components),
            flops_direct: rounded(flops_direct),
            // A list entry of 32 bytes, and 16 of the neighbour's volume and value, for each pair and pass.
            bytes_direct: rounded(program.passes() as f64 * 48.0 * pairs / each),
            flops_assembled: rounded(program.operations_of_weights(pairs / each)),
            kernels_per_pair: counted.kernels_per_pair,
            systems_per_particle: counted.systems_per_particle,
        };
        let timed = Timed {
            seconds_applied: applied * components / each,
            seconds_direct: direct / each,
            seconds_assembled: assembled / each,
        };
        Ok(Found::Value(Box::new(point), timed))
    }
}

/// The points that no other one beats in cost and error, the cheapest first.
fn front<'a, P>(points: &[&'a P], cost: impl Fn(&P) -> f64, error: impl Fn(&P) -> f64) -> Vec<&'a P> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| cost(a).total_cmp(&cost(b)).then(error(a).total_cmp(&error(b))));
    let mut least = f64::INFINITY;
    sorted.retain(|point| {
        let better = error(point) < least;
        if better {
            least = error(point);
        }
        better
    });
    sorted
}

/// A point of a front.
#[derive(Serialize)]
struct OnFront<'a> {
    derivative: &'a str,
    disorder: &'a str,
    by: &'a str,
    operator: &'a str,
    kernel: &'a str,
    support_over_dx: f64,
    cost: f64,
    error: f64,
}

fn assertion() -> Assertion {
    Assertion {
        id: "work-precision/derived-error".into(),
        source: "scene",
        location: "docs/time.md".into(),
        text: "the derived error on a wave is the measured one".into(),
        published: Published::Ratio { value: 1.0, margin: 0.25 },
    }
}

type Counted = fn(&Point) -> f64;
const COSTS: [(&str, Counted); 4] = [
    ("flops_applied", |point| point.flops_applied),
    ("bytes_applied", |point| point.bytes_applied),
    ("flops_direct", |point| point.flops_direct),
    ("bytes_direct", |point| point.bytes_direct),
];

type Second = fn(&(Point, Timed)) -> f64;
const SECONDS: [(&str, Second); 2] =
    [("seconds_applied", |p| p.1.seconds_applied), ("seconds_direct", |p| p.1.seconds_direct)];

impl Fronts {
    fn found(results: &[Value]) -> Result<Vec<Found>, TaskError> {
        let all: Vec<Vec<Found>> =
            results.iter().map(|result| serde_json::from_value(result.clone())).try_collect()?;
        Ok(all.into_iter().flatten().collect())
    }

    fn groups(&self) -> impl Iterator<Item = (&str, &str)> {
        self.scene.derivatives.iter().flat_map(|derivative| {
            self.disorders.iter().map(move |(disorder, _)| (derivative.as_str(), disorder.as_str()))
        })
    }
}

impl Survey for Fronts {
    fn tasks(&self) -> Vec<SurveyTask> {
        let task = |job: &Job| {
            let (kernel, disorder) = (self.kernels[job.kernel].id(), &self.disorders[job.disorder].0);
            let label = format!("{} with {kernel} under {disorder}", job.operator);
            let inputs = format!(
                "work-precision/1\n{label}\nR/Δ {:?}\nwavelength {}\nseed {}",
                self.scene.support_over_dx, self.scene.wavelength, self.seed
            );
            let pairs: f64 = self.scene.support_over_dx.iter().map(|r| 3.2 * r * r).sum();
            let particles = 9.0 * f64::from(self.scene.wavelength).powi(2);
            SurveyTask { label, inputs, cost: (20.0 * pairs * particles) as u64 }
        };
        self.jobs.iter().map(task).collect()
    }

    fn claims(&self) -> Vec<String> {
        vec![assertion().id]
    }

    fn omissions(&self) -> Vec<Omission> {
        vec![Omission {
            what: "errors of the assembled rows".into(),
            why: "rows do what their operator does; errors are taken from the sums".into(),
            saved: Some("two products for each point".into()),
        }]
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let job = &self.jobs[task];
        let points = self.scene.support_over_dx.iter().map(|support| self.point(job, *support));
        Ok(serde_json::to_value(points.collect::<Result<Vec<Found>, TaskError>>()?)?)
    }

    fn found(&self, _task: usize, result: &Value) -> Option<String> {
        let found: Vec<Found> = serde_json::from_value(result.clone()).ok()?;
        let errors = found.iter().filter_map(|found| match found {
            Found::Value(point, _) => Some((point.error_measured, point.support_over_dx)),
            Found::None(..) => None,
        });
        let (error, support) = errors.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(format!("error {error:.1e} at best, at R/Δ = {support}"))
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let all = Self::found(results)?;
        let points = all.iter().filter_map(|found| match found {
            Found::Value(point, _) => Some(&**point),
            Found::None(..) => None,
        });
        let points = points.collect_vec();
        let mut fronts = Vec::new();
        for (derivative, disorder) in self.groups() {
            let own = points.iter().filter(|p| p.derivative == derivative && p.disorder == disorder);
            let own = own.copied().collect_vec();
            for (by, cost) in COSTS {
                let on_front = front(&own, cost, |point| point.error_measured);
                fronts.extend(on_front.iter().map(|point| {
                    table_row(&OnFront {
                        derivative,
                        disorder,
                        by,
                        operator: &point.operator,
                        kernel: &point.kernel,
                        support_over_dx: point.support_over_dx,
                        cost: cost(point),
                        error: point.error_measured,
                    })
                }));
                let xy =
                    |points: &[&Point]| points.iter().map(|p| vec![cost(p), p.error_measured]).collect_vec();
                let mut lines = vec![Line { name: "front".into(), points: xy(&on_front) }];
                // Along R/Δ with the first kernel, those that come up on the front, the most accurate first.
                let drawn = on_front.iter().rev().map(|point| point.operator.as_str()).unique();
                for operator in drawn.take(MOST_LINES) {
                    let along =
                        own.iter().filter(|p| p.operator == operator && p.kernel == self.kernels[0].id());
                    let name = format!("{operator}, {}", self.kernels[0].id());
                    lines.push(Line { name, points: xy(&along.copied().collect_vec()) });
                }
                let name = by.replace('_', " ");
                report.series.push(Series {
                    id: format!("{derivative} {disorder} {name}"),
                    figure: None,
                    x: Axis { name: format!("{name} a particle"), unit: "1".into(), log: true },
                    y: Axis {
                        name: format!("relative error, {derivative}, {disorder}"),
                        unit: "1".into(),
                        log: true,
                    },
                    lines,
                });
            }
            let ratios = own.iter().filter_map(|point| Some(point.error_derived? / point.error_measured));
            let ratios = ratios.filter(|ratio| ratio.is_finite()).sorted_by(f64::total_cmp).collect_vec();
            if let Some(last) = ratios.len().checked_sub(1) {
                let at = |part: f64| significant(ratios[(part * last as f64).round() as usize], DIGITS);
                let found = Measured { value: at(0.5), low: at(0.05), high: at(0.95) };
                let case = Case {
                    source: "cloud".into(),
                    dimension: 2,
                    kernel: self.kernels.iter().map(Kernel::id).join(", "),
                    lattice: Some(self.lattice.id().into()),
                    disorder: Some(disorder.into()),
                    volume_rule: "constant".into(),
                    more: [
                        ("derivative".to_owned(), Value::from(derivative)),
                        ("points".to_owned(), Value::from(ratios.len())),
                    ]
                    .into(),
                };
                report.claims.push(entry(
                    &assertion(),
                    case,
                    None,
                    Some(Observed::Number(found)),
                    Vec::new(),
                ));
            }
        }
        report.tables.insert("fronts".into(), fronts);
        report.tables.insert("work_precision".into(), points.iter().map(table_row).collect());
        let without = all.iter().filter_map(|found| match found {
            Found::Value(..) => None,
            Found::None(operator, kernel, support, why) => Some(table_row(&json!({
                "operator": operator, "kernel": kernel, "support_over_dx": support, "why": why,
            }))),
        });
        let without = without.collect_vec();
        if !without.is_empty() {
            report.tables.insert("without_value".into(), without);
        }
        Ok(())
    }

    fn timings(&self, results: &[Value]) -> Value {
        let Ok(all) = Self::found(results) else { return Value::Null };
        let points = all.into_iter().filter_map(|found| match found {
            Found::Value(point, timed) => Some((*point, timed)),
            Found::None(..) => None,
        });
        let points = points.collect_vec();
        let mut fronts = Vec::new();
        for ((derivative, disorder), (by, cost)) in iproduct!(self.groups().collect_vec(), SECONDS) {
            let own = points.iter().filter(|(p, _)| p.derivative == derivative && p.disorder == disorder);
            let on_front = front(&own.collect_vec(), cost, |(point, _)| point.error_measured);
            fronts.extend(on_front.into_iter().map(|found| {
                json!(OnFront {
                    derivative,
                    disorder,
                    by,
                    operator: &found.0.operator,
                    kernel: &found.0.kernel,
                    support_over_dx: found.0.support_over_dx,
                    cost: significant(cost(found), 3),
                    error: found.0.error_measured,
                })
            }));
        }
        json!({ "fronts": fronts })
    }
}
