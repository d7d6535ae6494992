//! The heat problem of Fatehi & Manzari (2011), §6, with any Laplacian, radius, disorder, boundary and integrator.

mod judge;
pub(super) mod run;

use super::super::plan::Omission;
use super::{Parameters, Survey, SurveyTask, TaskError};
use crate::evolve::heat::{Boundary, HeatProblem};
use crate::language::{Field, Operator, operators};
use crate::record::Report;
use itertools::iproduct;
use run::{Configuration, Integrator, compute};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// `[survey]` of kind `heat`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Heat {
    /// When the errors are taken.
    pub time: f64,
    /// Δt over d²/α of explicit methods but Runge–Kutta–Chebyshev, d the least distance between two particles.
    pub courant: f64,
    /// Id of the kernel.
    pub kernel: String,
    /// `[[survey.runs]]`: every combination is a run.
    pub runs: Vec<Runs>,
}

/// `[[survey.runs]]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Runs {
    /// Particles a side, walls included.
    pub n: Vec<u32>,
    /// R/Δ.
    pub h_over_dx: Vec<f64>,
    /// ε: particles are moved by up to ε/4 Δ along each axis.
    #[serde(default = "regular")]
    pub epsilon: Vec<f64>,
    /// Operators, by id or as text.
    pub schemes: Vec<String>,
    /// `euler`, `rk2`, `rk4`, `rkc`, `implicit-euler`, `tr-bdf2`, `exact` (the semi-discrete system solved to 1e-9).
    #[serde(default = "euler")]
    pub integrators: Vec<String>,
    /// Steps of `rkc` (short ones first), `implicit-euler` and `tr-bdf2`.
    #[serde(default = "fifty")]
    pub steps: u32,
    /// `cut-off`, `ghosts`.
    #[serde(default = "cut_off")]
    pub boundaries: Vec<Boundary>,
    /// Whether the steady solution is taken too, and the error in it apart from that in the transient part.
    #[serde(default)]
    pub steady: bool,
}

fn regular() -> Vec<f64> {
    vec![0.0]
}

fn euler() -> Vec<String> {
    vec!["euler".into()]
}

fn fifty() -> u32 {
    50
}

fn cut_off() -> Vec<Boundary> {
    vec![Boundary::CutOff]
}

impl Default for Heat {
    fn default() -> Self {
        let runs = Runs {
            n: vec![10, 20, 40],
            h_over_dx: vec![1.5, 2.0, 2.5, 3.0, 3.5],
            epsilon: regular(),
            schemes: vec!["S3".into(), "S4".into()],
            integrators: euler(),
            steps: fifty(),
            boundaries: cut_off(),
            steady: false,
        };
        Self { time: 0.1, courant: 0.2, kernel: "wendland-c2".into(), runs: vec![runs] }
    }
}

/// An operator by its id or as text, that takes a scalar to a scalar.
pub(super) fn laplacian(text: &str) -> Result<Operator, String> {
    let operator = operators::named_or_written(text)?;
    if operator.field != Field::Scalar || operator.rank() != 0 {
        return Err(format!("'{text}' does not take a scalar to a scalar: name a Laplacian of a scalar"));
    }
    Ok(operator)
}

/// The largest grid of a first look.
const QUICK: u32 = 40;

impl Parameters for Heat {
    fn survey(self, seed: u64, quick: bool) -> Result<Box<dyn Survey>, (String, String)> {
        let at = |key: &str, message: String| (key.to_owned(), message);
        let positive = |key: &str, value: f64| {
            let message = || at(key, format!("{value} must be finite and positive"));
            if value.is_finite() && value > 0.0 { Ok(()) } else { Err(message()) }
        };
        positive("time", self.time)?;
        positive("courant", self.courant)?;
        let kernel = crate::kernel::by_id(&self.kernel).map_err(|error| at("kernel", error.to_string()))?;
        if self.runs.is_empty() {
            return Err(at("runs", "names no run: give at least one [[survey.runs]]".into()));
        }
        let mut configurations: Vec<Configuration> = Vec::new();
        for (index, runs) in self.runs.iter().enumerate() {
            let place = |field: &str| format!("runs.{index}.{field}");
            for scheme in &runs.schemes {
                laplacian(scheme).map_err(|message| at(&place("schemes"), message))?;
            }
            let integrators: Vec<Integrator> = runs
                .integrators
                .iter()
                .map(|name| {
                    Integrator::by_id(name, runs.steps).map_err(|message| at(&place("integrators"), message))
                })
                .collect::<Result<_, _>>()?;
            for h in &runs.h_over_dx {
                if !(*h > 1.0 && *h <= 16.0) {
                    let message =
                        format!("R/Δ = {h} must be above 1, where there is a neighbour, and at most 16");
                    return Err(at(&place("h_over_dx"), message));
                }
            }
            if let Some(epsilon) = runs.epsilon.iter().find(|e| !(0.0..2.0).contains(*e)) {
                let message =
                    format!("ε = {epsilon} must be at least 0, and below 2, where particles can meet");
                return Err(at(&place("epsilon"), message));
            }
            if let Some(n) = runs.n.iter().find(|n| !(4..=1000).contains(*n)) {
                return Err(at(&place("n"), format!("{n} particles a side: give 4 to 1000")));
            }
            let all = iproduct!(&runs.schemes, &runs.h_over_dx, &runs.epsilon, &runs.boundaries, &runs.n);
            for (scheme, h, epsilon, boundary, n) in all {
                if quick && *n > QUICK {
                    continue;
                }
                let problem = HeatProblem {
                    n: *n as usize,
                    h_over_dx: *h,
                    epsilon: *epsilon,
                    seed,
                    boundary: *boundary,
                    jump: None,
                };
                let known = configurations
                    .iter_mut()
                    .find(|known| known.scheme == *scheme && known.problem == problem);
                match known {
                    Some(known) => {
                        let new = integrators.iter().filter(|i| !known.integrators.contains(i)).copied();
                        let new: Vec<Integrator> = new.collect();
                        known.integrators.extend(new);
                        known.steady |= runs.steady;
                    }
                    None => configurations.push(Configuration {
                        scheme: scheme.clone(),
                        problem,
                        integrators: integrators.clone(),
                        steady: runs.steady,
                    }),
                }
            }
        }
        Ok(Box::new(HeatSurvey { time: self.time, courant: self.courant, kernel, configurations }))
    }
}

struct HeatSurvey {
    time: f64,
    courant: f64,
    kernel: crate::kernel::Kernel,
    configurations: Vec<Configuration>,
}

impl HeatSurvey {
    /// About how often a configuration multiplies by its matrix.
    fn products(&self, c: &Configuration) -> f64 {
        let dx = 1.0 / (c.problem.n - 1) as f64;
        let least = 1.0 - 0.5 * c.problem.epsilon;
        let explicit = self.time / (self.courant * dx * dx * least * least);
        c.integrators.iter().map(|i| i.products(explicit)).sum()
    }
}

impl Survey for HeatSurvey {
    fn tasks(&self) -> Vec<SurveyTask> {
        let task = |c: &Configuration| {
            let p = &c.problem;
            let label = format!(
                "{} on {n} × {n}, R/Δ = {}, ε = {}, {}",
                c.scheme,
                p.h_over_dx,
                p.epsilon,
                p.boundary.id(),
                n = p.n
            );
            let integrators: Vec<String> = c.integrators.iter().map(|i| i.id()).collect();
            let inputs = format!(
                "heat/1\n{label}\nkernel {}\nseed {}\ntime {:e}\ncourant {:e}\nintegrators {}\nsteady {}",
                self.kernel.id(),
                p.seed,
                self.time,
                self.courant,
                integrators.join(" "),
                c.steady
            );
            let pairs = p.n as f64 * p.n as f64 * std::f64::consts::PI * p.h_over_dx * p.h_over_dx;
            SurveyTask { label, inputs, cost: (pairs * (self.products(c) + 1000.0)) as u64 }
        };
        self.configurations.iter().map(task).collect()
    }

    fn claims(&self) -> Vec<String> {
        judge::claims()
    }

    fn omissions(&self) -> Vec<Omission> {
        let steady = self.configurations.iter().filter(|c| !c.steady).count();
        let assembled = self.configurations.len();
        let applied: f64 = self.configurations.iter().map(|c| self.products(c)).sum();
        vec![
            Omission {
                what: "stencils at every step".into(),
                why: "particles do not move: each operator is assembled once, S4 with its tensors too".into(),
                saved: (applied > assembled as f64).then(|| {
                    format!("all but {assembled} of about {applied:.1e} times that stencils are asked for")
                }),
            },
            Omission {
                what: "steady solutions".into(),
                why: "only some runs ask for them".into(),
                saved: Some(format!("{steady} of {} solutions", self.configurations.len())),
            },
        ]
    }

    fn compute(&self, task: usize) -> Result<Value, TaskError> {
        let found = compute(&self.configurations[task], &self.kernel, self.time, self.courant)?;
        Ok(serde_json::to_value(found)?)
    }

    fn found(&self, _task: usize, result: &Value) -> Option<String> {
        let found: run::Found = serde_json::from_value(result.clone()).ok()?;
        let of = |run: &run::RunFound| {
            let [l2, ..] = *run.errors.as_ref().ok()?;
            Some(format!("L₂ = {l2:.2e} ({})", run.integrator))
        };
        found.runs.iter().find_map(of)
    }

    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError> {
        let found = results.iter().map(|result| serde_json::from_value(result.clone()));
        let found = found.collect::<Result<Vec<run::Found>, _>>()?;
        judge::report(&self.configurations, self.kernel.id(), &found, report);
        Ok(())
    }
}
