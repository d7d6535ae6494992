//! Stiffness: spectra of assembled Laplacians, the largest steps they allow, what happens beyond, and layers whose
//! diffusivities differ by orders of magnitude.

use super::super::plan::Omission;
use super::heat::laplacian;
use super::heat::run::{Integrator, integrate};
use super::{Parameters, Row, Survey, SurveyTask, TaskError, entry, table_row};
use crate::claim::{Assertion, Measured, Observed, Published, Sign};
use crate::evolve::heat::{Boundary, HeatProblem, HeatSystem, layered};
use crate::evolve::{EvolveError, Explicit, Implicit, Matrix, march, march_implicit, spectrum, steady};
use crate::kernel::Kernel;
use crate::measured::Program;
use crate::record::{Axis, Case, Line, Report, Series, significant};
use itertools::{Itertools as _, iproduct};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// Significant digits: eigenvalues differ in their last ones from one processor to another.
const DIGITS: usize = 6;

/// Steps between which the largest stable one is tried out.
const TRIED: [f64; 2] = [0.95, 1.05];

/// Steps that a trial takes: a mode that grows by one part in ten reaches 10⁶ and more.
const TRIAL_STEPS: u64 = 2000;

/// `[survey]` of kind `stiff`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Stiff {
    /// Id of the kernel.
    pub kernel: String,
    /// Operators whose spectra are taken, by id or as text.
    pub schemes: Vec<String>,
    /// Particles a side, walls included; all eigenvalues are computed.
    pub n: Vec<u32>,
    /// R/Δ.
    pub h_over_dx: Vec<f64>,
    /// ε: particles are moved by up to ε/4 Δ along each axis.
    pub epsilon: Vec<f64>,
    /// Integrators compared on the heat problem at the last of `n`, h = 2.5Δ, with each scheme.
    pub integrators: Vec<String>,
    /// Numbers of steps of those whose step is free.
    pub steps: Vec<u32>,
    /// Jumps of the diffusivity between two layers.
    pub jumps: Vec<f64>,
    /// Operators for the layers, by name: they read the diffusivity as `mu_i` and `mu_j`.
    pub means: BTreeMap<String, String>,
}

impl Default for Stiff {
    fn default() -> Self {
        let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect_vec();
        let pair = "(u_i - u_j) / |r_ij| e_ij . gradW_ij";
        let means = [
            ("arithmetic", format!("sum_j V_j (mu_i + mu_j) {pair}")),
            ("harmonic", format!("sum_j 4 V_j mu_i mu_j / (mu_i + mu_j) {pair}")),
        ];
        Self {
            kernel: "wendland-c2".into(),
            schemes: texts(&["S3", "S4"]),
            n: vec![10, 14, 20],
            h_over_dx: vec![1.5, 2.5, 3.5],
            epsilon: vec![0.0, 0.4],
            integrators: texts(&["euler", "rk2", "rk4", "rkc", "implicit-euler", "tr-bdf2"]),
            steps: vec![5, 10, 20, 40, 80],
            jumps: vec![1e2, 1e4, 1e6],
            means: means.into_iter().map(|(name, text)| (name.to_owned(), text)).collect(),
        }
    }
}

impl Parameters for Stiff {
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        let kernel =
            crate::kernel::by_id(&self.kernel).map_err(|error| ("kernel".to_owned(), error.to_string()))?;
        for (key, list) in
            [("schemes", self.schemes.iter().collect_vec()), ("means", self.means.values().collect())]
        {
            for text in list {
                laplacian(text).map_err(|message| (key.to_owned(), message))?;
            }
        }
        if let Some(n) = self.n.iter().find(|n| !(5..=40).contains(*n)) {
            return Err(("n".into(), format!("{n} particles a side: all eigenvalues are for 5 to 40")));
        }
        if let Some(h) = self.h_over_dx.iter().find(|h| !(**h > 1.0 && **h <= 8.0)) {
            return Err(("h_over_dx".into(), format!("R/Δ = {h} must be above 1 and at most 8")));
        }
        if let Some(epsilon) = self.epsilon.iter().find(|e| !(0.0..2.0).contains(*e)) {
            return Err(("epsilon".into(), format!("ε = {epsilon} must be at least 0 and below 2")));
        }
        if let Some(jump) = self.jumps.iter().find(|jump| !(**jump > 0.0 && jump.is_finite())) {
            return Err((
                "jumps".into(),
                format!("a jump of {jump} must be finite and positive: a layer conducts"),
            ));
        }
        let n = if quick { self.n.iter().copied().filter(|n| *n <= 14).collect() } else { self.n.clone() };
        for name in &self.integrators {
            for steps in &self.steps {
                Integrator::by_id(name, *steps).map_err(|message| ("integrators".to_owned(), message))?;
            }
        }
        let mut jobs = Vec::new();
        for (scheme, h, epsilon, n) in iproduct!(&self.schemes, &self.h_over_dx, &self.epsilon, &n) {
            jobs.push(Job::Spectrum(scheme.clone(), problem(*n, *h, *epsilon, seed, None)));
        }
        if let Some(n) = n.last() {
            for (scheme, epsilon) in iproduct!(&self.schemes, &self.epsilon) {
                jobs.push(Job::Methods(scheme.clone(), problem(*n, 2.5, *epsilon, seed, None)));
            }
            for ((name, text), jump, epsilon) in iproduct!(&self.means, &self.jumps, &self.epsilon) {
                jobs.push(Job::Layers(
                    name.clone(),
                    text.clone(),
                    problem(*n, 2.5, *epsilon, seed, Some(*jump)),
                ));
            }
        }
        Ok(Box::new(StiffSurvey { scene: self, kernel, jobs }))
    }
}

fn problem(n: u32, h_over_dx: f64, epsilon: f64, seed: u64, jump: Option<f64>) -> HeatProblem {
    HeatProblem { n: n as usize, h_over_dx, epsilon, seed, boundary: Boundary::CutOff, jump }
}

enum Job {
    /// All eigenvalues.
    Spectrum(String, HeatProblem),
    /// The heat problem with every integrator.
    Methods(String, HeatProblem),
    /// Two layers, with a mean by name and text.
    Layers(String, String, HeatProblem),
}

struct StiffSurvey {
    scene: Stiff,
    kernel: Kernel,
    jobs: Vec<Job>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct SpectrumRow {
    scheme: String,
    n: usize,
    h_over_dx: f64,
    epsilon: f64,
    unknowns: usize,
    /// ρΔ².
    radius_dx2: f64,
    /// The least decay rate; of the problem itself, 2π² = 19.74.
    slowest: f64,
    /// Eigenvalues with a real part above rounding.
    growing: usize,
    largest_real_dx2: f64,
    largest_imaginary_dx2: f64,
    /// max |A − Aᵀ| / max |A|.
    asymmetry: f64,
    closest: f64,
    /// Largest stable steps in units of Δ².
    euler: Option<f64>,
    rk2: Option<f64>,
    rk4: Option<f64>,
    rkc10: Option<f64>,
    /// What became of Euler at 0.95 and 1.05 of its largest step.
    below: String,
    above: String,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct MethodRow {
    scheme: String,
    n: usize,
    epsilon: f64,
    integrator: String,
    steps: u64,
    products: u64,
    flops: u64,
    l2: Option<f64>,
    /// L₂ of the difference to the semi-discrete solution.
    l2_in_time: Option<f64>,
    stopped: Option<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct LayerRow {
    mean: String,
    n: usize,
    jump: f64,
    epsilon: f64,
    integrator: String,
    /// Δt over the largest step of Euler's method, from the spectral radius.
    step_over_euler: f64,
    steps: u64,
    products: u64,
    /// Root mean square distance from the steady solution of the semi-discrete system.
    from_steady: Option<f64>,
    /// Of that from the exact one.
    steady_error: Option<f64>,
    failed: Option<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
enum Found {
    Spectrum(Box<SpectrumRow>, Vec<[f64; 2]>),
    Methods(Vec<MethodRow>),
    Layers(Vec<LayerRow>),
}

fn rounded(value: f64) -> f64 {
    significant(value, DIGITS)
}

impl StiffSurvey {
    fn system(&self, scheme: &str, problem: &HeatProblem) -> Result<HeatSystem, TaskError> {
        let program = Program::new(&laplacian(scheme)?, &self.kernel, 2)?;
        Ok(problem.discretise(&program)?)
    }

    fn spectrum(&self, scheme: &str, problem: &HeatProblem) -> Result<Found, TaskError> {
        let heat = self.system(scheme, problem)?;
        let matrix = &heat.system.matrix;
        let values = spectrum::eigenvalues(matrix);
        let dx = 1.0 / (problem.n - 1) as f64;
        let radius = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
        let highest = values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max);
        let step = |method| spectrum::largest_step(&values, method);
        let shown = |method| step(method).map(|step| rounded(step / (dx * dx)));
        let tried = |factor: f64| match step(Explicit::Euler) {
            None => "no step is stable".to_owned(),
            Some(step) => {
                // From noise, so that every mode is there.
                let mut u = noise(heat.places.len());
                match march(&heat.system, Explicit::Euler, &mut u, factor * step, TRIAL_STEPS) {
                    Ok(()) => "stable".into(),
                    Err(EvolveError::Unstable(found)) => {
                        format!(
                            "stopped after {} steps, mode of rate {:.3} ρ",
                            found.step,
                            found.rate / radius
                        )
                    }
                    Err(error) => error.to_string(),
                }
            }
        };
        let row = SpectrumRow {
            scheme: scheme.to_owned(),
            n: problem.n,
            h_over_dx: problem.h_over_dx,
            epsilon: problem.epsilon,
            unknowns: heat.places.len(),
            radius_dx2: rounded(radius * dx * dx),
            slowest: rounded(-highest),
            growing: values.iter().filter(|value| value.re > 1e-9 * radius).count(),
            largest_real_dx2: rounded(highest * dx * dx),
            largest_imaginary_dx2: rounded(
                chopped(values.iter().map(|value| value.im).fold(0.0, f64::max), 1e-7 * radius) * dx * dx,
            ),
            asymmetry: rounded(chopped(asymmetry(matrix), 1e-12)),
            closest: rounded(heat.closest / dx),
            euler: shown(Explicit::Euler),
            rk2: shown(Explicit::Rk2),
            rk4: shown(Explicit::Rk4),
            rkc10: shown(Explicit::Rkc(10)),
            below: tried(TRIED[0]),
            above: tried(TRIED[1]),
        };
        let chop = 1e-7 * radius;
        let points =
            values.iter().map(|value| [value.re, chopped(value.im, chop)].map(|v| rounded(v * dx * dx)));
        Ok(Found::Spectrum(Box::new(row), points.collect()))
    }

    fn methods(&self, scheme: &str, problem: &HeatProblem) -> Result<Found, TaskError> {
        let heat = self.system(scheme, problem)?;
        let time = 0.1;
        let radius = spectrum::radius(&heat.system.matrix, 200);
        // Explicit methods near the largest step that Euler allows.
        let courant = 0.9 * 2.0 / radius / (heat.closest * heat.closest);
        let (_, _, exact) = integrate(&heat, Integrator::Exact, time, courant)?;
        let exact = exact.map_err(TaskError::from)?;
        let mut rows = Vec::new();
        let mut seen = Vec::new();
        for (name, steps) in iproduct!(&self.scene.integrators, &self.scene.steps) {
            let integrator = Integrator::by_id(name, *steps)?;
            if seen.contains(&integrator) {
                continue;
            }
            seen.push(integrator);
            let (steps, products, result) = integrate(&heat, integrator, time, courant)?;
            let there = result.as_ref().ok();
            let apart = there.map(|u| u.iter().zip(&exact).map(|(a, b)| a - b).collect_vec());
            rows.push(MethodRow {
                scheme: scheme.to_owned(),
                n: problem.n,
                epsilon: problem.epsilon,
                integrator: integrator.id(),
                steps,
                products,
                flops: 2 * products * heat.system.matrix.entries() as u64,
                l2: there.map(|u| rounded(heat.errors(u, time).l2)),
                l2_in_time: apart.map(|apart| rounded(heat.norms(&apart).l2)),
                stopped: result.err(),
            });
        }
        Ok(Found::Methods(rows))
    }

    fn layers(&self, mean: &str, text: &str, problem: &HeatProblem) -> Result<Found, TaskError> {
        let heat = self.system(text, problem)?;
        let jump = problem.jump.unwrap_or(1.0);
        let rms = |a: &[f64], b: &[f64]| {
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            rounded((square / a.len() as f64).sqrt())
        };
        let exact = heat.places.iter().map(|[_, y]| layered(*y, jump)).collect_vec();
        let steady = steady(&heat.system);
        let euler = 2.0 / spectrum::radius(&heat.system.matrix, 200);
        let mut rows = Vec::new();
        for (method, factor) in iproduct!([Implicit::Euler, Implicit::TrBdf2], [1e2, 1e4]) {
            // Long enough for the slow layer to settle.
            let steps = ((2.0 / (factor * euler)).ceil() as u64).clamp(10, 400);
            let mut u = vec![0.0; heat.places.len()];
            let result = march_implicit(&heat.system, method, &mut u, factor * euler, steps);
            let (products, failed) = match result {
                Ok(products) => (products, None),
                Err(error) => (0, Some(error.to_string())),
            };
            rows.push(LayerRow {
                mean: mean.to_owned(),
                n: problem.n,
                jump,
                epsilon: problem.epsilon,
                integrator: method.id().into(),
                step_over_euler: factor,
                steps,
                products,
                from_steady: steady.as_ref().ok().filter(|_| failed.is_none()).map(|s| rms(&u, s)),
                steady_error: steady.as_ref().ok().map(|s| rms(s, &exact)),
                failed: failed.or_else(|| steady.as_ref().err().map(ToString::to_string)),
            });
        }
        Ok(Found::Layers(rows))
    }
}

/// Rounding is no part of a spectrum.
fn chopped(value: f64, below: f64) -> f64 {
    if value.abs() < below { 0.0 } else { value }
}

fn noise(count: usize) -> Vec<f64> {
    let mut state = 7_u64;
    let next = |_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..count).map(next).collect()
}

fn asymmetry(matrix: &Matrix) -> f64 {
    let dense = matrix.dense();
    (&dense - dense.transpose()).abs().max() / dense.abs().max()
}

fn assertions() -> [Assertion; 3] {
    let statement = |id: &str, location: &str, text: &str, published| Assertion {
        id: format!("stiff/{id}"),
        source: "fatehi-manzari-2011",
        location: location.into(),
        text: text.into(),
        published,
    };
    let not_symmetric = |left| Published::Relation { left, sign: Sign::Greater, right: "0" };
    [
        statement(
            "courant",
            "Sec. 6",
            "explicit Euler is run with Δt = 0.2 d²/α: it is stable",
            Published::Relation {
                left: "0.2 d²",
                sign: Sign::Less,
                right: "the largest stable step of Euler",
            },
        ),
        statement(
            "S3-not-symmetric",
            "Sec. 6.1",
            "scheme S3 is not symmetric",
            not_symmetric("asymmetry of S3"),
        ),
        statement(
            "S4-not-symmetric",
            "Sec. 6.1",
            "scheme S4 is not symmetric",
            not_symmetric("asymmetry of S4"),
        ),
    ]
}

impl Survey for StiffSurvey {
    fn tasks(&self) -> Vec<SurveyTask> {
        let task = |job: &Job| {
            let (what, scheme, p) = match job {
                Job::Spectrum(scheme, p) => ("spectrum", scheme.clone(), p),
                Job::Methods(scheme, p) => ("integrators", scheme.clone(), p),
                Job::Layers(mean, text, p) => ("layers", format!("{mean}: {text}"), p),
            };
            let jump = p.jump.map(|jump| format!(", jump {jump:e}")).unwrap_or_default();
            let label = format!(
                "{what} of {scheme}, {n} × {n}, R/Δ = {}, ε = {}{jump}",
                p.h_over_dx,
                p.epsilon,
                n = p.n
            );
            let more = match job {
                Job::Methods(..) => format!("{} {:?}", self.scene.integrators.join(" "), self.scene.steps),
                _ => String::new(),
            };
            let inputs = format!("stiff/1\n{label}\nkernel {}\nseed {}\n{more}", self.kernel.id(), p.seed);
            let unknowns = ((p.n - 2) * (p.n - 2)) as f64;
            let cost = match job {
                Job::Spectrum(..) => 50.0 * unknowns.powi(3),
                _ => 1e5 * unknowns,
            };
            SurveyTask { label, inputs, cost: cost as u64 }
        };
        self.jobs.iter().map(task).collect()
    }

    fn claims(&self) -> Vec<String> {
        assertions().into_iter().map(|assertion| assertion.id).collect()
    }

    fn omissions(&self) -> Vec<Omission> {
        Vec::new()
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let found = match &self.jobs[task] {
            Job::Spectrum(scheme, problem) => self.spectrum(scheme, problem)?,
            Job::Methods(scheme, problem) => self.methods(scheme, problem)?,
            Job::Layers(mean, text, problem) => self.layers(mean, text, problem)?,
        };
        Ok(serde_json::to_value(found)?)
    }

    fn found(&self, _task: usize, result: &Value) -> Option<String> {
        Some(match serde_json::from_value(result.clone()).ok()? {
            Found::Spectrum(row, _) => format!("ρΔ² = {:.3}, {} modes grow", row.radius_dx2, row.growing),
            Found::Methods(rows) => {
                let stopped = rows.iter().filter(|row| row.stopped.is_some()).count();
                format!("{} runs, {stopped} stopped", rows.len())
            }
            Found::Layers(rows) => {
                let apart = rows.iter().filter_map(|row| row.from_steady).reduce(f64::min)?;
                let failed = rows.iter().filter(|row| row.failed.is_some()).count();
                format!("{} runs, {failed} failed, {apart:.1e} from the steady solution at best", rows.len())
            }
        })
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let mut tables: BTreeMap<&str, Vec<Row>> = BTreeMap::new();
        let mut spectra = Vec::new();
        for result in results {
            match serde_json::from_value(result.clone())? {
                Found::Spectrum(row, values) => {
                    tables.entry("spectra").or_default().push(table_row(&row));
                    spectra.push((row, values));
                }
                Found::Methods(rows) => {
                    tables.entry("integrators").or_default().extend(rows.iter().map(table_row))
                }
                Found::Layers(rows) => tables.entry("layers").or_default().extend(rows.iter().map(table_row)),
            }
        }
        let exactly = |value: f64| Measured::exactly(value);
        let [courant, s3, s4] = assertions();
        for (row, _) in &spectra {
            let case = |more: &[(&str, Value)]| Case {
                source: "cloud".into(),
                dimension: 2,
                kernel: self.kernel.id().into(),
                lattice: Some("square".into()),
                disorder: Some(if row.epsilon > 0.0 {
                    format!("box:{}", row.epsilon)
                } else {
                    "none".into()
                }),
                volume_rule: "constant".into(),
                more: more.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect(),
            };
            let own = [
                ("n", Value::from(row.n)),
                ("h_over_dx", Value::from(row.h_over_dx)),
                ("operator", Value::from(row.scheme.clone())),
            ];
            let limit = row.euler.unwrap_or(0.0);
            let step = rounded(0.2 * row.closest * row.closest);
            let sides = Observed::Sides { left: exactly(step), right: exactly(limit) };
            report.claims.push(entry(&courant, case(&own), None, Some(sides), Vec::new()));
            let asymmetry = Observed::Sides { left: exactly(row.asymmetry), right: exactly(0.0) };
            for (assertion, scheme) in [(&s3, "S3"), (&s4, "S4")] {
                if row.scheme == scheme {
                    report.claims.push(entry(assertion, case(&own[..2]), None, Some(asymmetry), Vec::new()));
                }
            }
        }
        report.claims.sort_by_key(|claim| assertions().iter().position(|known| known.id == claim.id));
        let axis = |name: &str| Axis { name: name.into(), unit: "1/Δ²".into(), log: false };
        report.series = spectra
            .iter()
            .map(|(row, values)| Series {
                id: format!("spectrum-{}-n{}-h{}-e{}", row.scheme, row.n, row.h_over_dx, row.epsilon),
                figure: None,
                x: axis("Re λ"),
                y: axis("Im λ"),
                lines: vec![Line {
                    name: row.scheme.clone(),
                    points: values.iter().map(|v| v.to_vec()).collect(),
                }],
            })
            .collect();
        report.tables.extend(tables.into_iter().map(|(name, rows)| (name.to_owned(), rows)));
        Ok(())
    }
}
