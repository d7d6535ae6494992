//! One configuration of the heat problem: assembled once, then run with each integrator.

use super::super::TaskError;
use crate::evolve::heat::{HeatErrors, HeatProblem, HeatSystem};
use crate::evolve::{
    EvolveError, Explicit, Implicit, chebyshev_stretches, exponential, march, march_implicit,
    march_stretches, spectrum, steady,
};
use crate::kernel::Kernel;
use crate::measured::Program;
use crate::record::significant;
use serde::{Deserialize, Serialize};

/// Significant digits: what goes through dense exponentials and iterations is the same on every machine to that many.
const DIGITS: usize = 6;

/// The tolerance of [`Integrator::Exact`].
const TOLERANCE: f64 = 1e-9;

/// Products that estimate the spectral radius, and what is added to it.
const POWER_STEPS: usize = 60;
const SAFETY: f64 = 1.1;

/// How time is gone through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) enum Integrator {
    /// With the step that the Courant number gives.
    Explicit(Explicit),
    /// Runge–Kutta–Chebyshev with this many steps, and as many stages as they need.
    Chebyshev(u32),
    Implicit(Implicit, u32),
    Exact,
}

impl Integrator {
    pub(in super::super) fn by_id(id: &str, steps: u32) -> Result<Self, String> {
        let stepped = |integrator| match steps {
            0 => Err(format!("'{id}' needs at least one step: steps = 0")),
            _ => Ok(integrator),
        };
        match id {
            "euler" => Ok(Self::Explicit(Explicit::Euler)),
            "rk2" => Ok(Self::Explicit(Explicit::Rk2)),
            "rk4" => Ok(Self::Explicit(Explicit::Rk4)),
            "rkc" => stepped(Self::Chebyshev(steps)),
            "implicit-euler" => stepped(Self::Implicit(Implicit::Euler, steps)),
            "tr-bdf2" => stepped(Self::Implicit(Implicit::TrBdf2, steps)),
            "exact" => Ok(Self::Exact),
            _ => Err(format!(
                "there is no integrator '{id}': euler, rk2, rk4, rkc, implicit-euler, tr-bdf2 and exact are there"
            )),
        }
    }

    /// Its name, with the steps where these are given.
    pub(in super::super) fn id(self) -> String {
        match self {
            Self::Explicit(method) => method.id(),
            Self::Chebyshev(steps) => format!("rkc-{steps}"),
            Self::Implicit(method, steps) => format!("{}-{steps}", method.id()),
            Self::Exact => "exact".into(),
        }
    }

    /// About how many products with the matrix, if Euler takes `explicit` steps.
    pub(super) fn products(self, explicit: f64) -> f64 {
        match self {
            Self::Explicit(method) => explicit * f64::from(method.stages()),
            Self::Chebyshev(steps) => (explicit * f64::from(steps)).sqrt() * 2.0,
            Self::Implicit(_, steps) => 30.0 * f64::from(steps),
            Self::Exact => 0.3 * explicit,
        }
    }
}

/// What is run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Configuration {
    pub(super) scheme: String,
    pub(super) problem: HeatProblem,
    pub(super) integrators: Vec<Integrator>,
    pub(super) steady: bool,
}

/// What was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Found {
    /// The least distance in Δ.
    pub(super) closest: f64,
    pub(super) neighbours: usize,
    pub(super) unknowns: usize,
    pub(super) entries: usize,
    pub(super) bytes: usize,
    pub(super) runs: Vec<RunFound>,
    /// (L₂, L∞, EC) of the steady solution.
    pub(super) steady: Option<[f64; 3]>,
}

/// What one integrator gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct RunFound {
    pub(super) integrator: String,
    pub(super) steps: u64,
    pub(super) products: u64,
    /// (L₂, L∞, EC), or why there are none.
    pub(super) errors: Result<[f64; 3], String>,
    /// Root mean squares nearer than R to a wall, and further.
    pub(super) near_far: Option<[f64; 2]>,
    /// L₂ of the difference to the semi-discrete solution, where that was taken.
    pub(super) in_time: Option<f64>,
    /// L₂ of the error less that of the steady solution.
    pub(super) transient: Option<f64>,
}

pub(super) fn compute(
    configuration: &Configuration,
    kernel: &Kernel,
    time: f64,
    courant: f64,
) -> Result<Found, TaskError> {
    let problem = &configuration.problem;
    let operator = super::laplacian(&configuration.scheme)?;
    let program = Program::new(&operator, kernel, 2)?;
    let heat = problem.discretise(&program)?;
    let steady_error = match configuration.steady {
        true => {
            let u = steady(&heat.system)?;
            // Far beyond the last transient.
            Some(heat.difference(&u, 100.0))
        }
        false => None,
    };
    let exact = configuration
        .integrators
        .contains(&Integrator::Exact)
        .then(|| exponential(&heat.system, &vec![0.0; heat.places.len()], time, TOLERANCE))
        .transpose()?;
    let semi_discrete = exact.as_ref().map(|(u, _)| heat.difference(u, time));
    let mut runs = Vec::new();
    for integrator in &configuration.integrators {
        let (steps, products, result) = match (integrator, &exact) {
            (Integrator::Exact, Some((u, products))) => (0, *products, Ok(u.clone())),
            _ => integrate(&heat, *integrator, time, courant)?,
        };
        let difference = result.map(|u| heat.difference(&u, time));
        let less = |a: &[f64], b: &Option<Vec<f64>>| {
            let of = b.as_ref().map(|b| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>());
            of.map(|of| rounded(heat.norms(&of).l2))
        };
        let there = difference.as_ref().ok();
        runs.push(RunFound {
            integrator: integrator.id(),
            steps,
            products,
            near_far: there.map(|e| heat.near_and_far(e).map(rounded)),
            in_time: there.filter(|_| *integrator != Integrator::Exact).and_then(|e| less(e, &semi_discrete)),
            transient: there.and_then(|e| less(e, &steady_error)),
            errors: difference.map(|e| three(heat.norms(&e))),
        });
    }
    Ok(Found {
        closest: rounded(heat.closest * (problem.n - 1) as f64),
        neighbours: heat.neighbours,
        unknowns: heat.places.len(),
        entries: heat.system.matrix.entries(),
        bytes: heat.system.matrix.bytes(),
        runs,
        steady: steady_error.map(|e| three(heat.norms(&e))),
    })
}

/// Steps, products with the matrix, and the solution, or why it was stopped.
pub(in super::super) type Integrated = (u64, u64, Result<Vec<f64>, String>);

pub(in super::super) fn integrate(
    heat: &HeatSystem,
    integrator: Integrator,
    time: f64,
    courant: f64,
) -> Result<Integrated, TaskError> {
    let mut u = vec![0.0; heat.places.len()];
    let ended = |steps: u64, products: u64, u: Vec<f64>, result: Result<(), EvolveError>| match result {
        Ok(()) => Ok((steps, products, Ok(u))),
        Err(EvolveError::Unstable(unstable)) => {
            Ok((steps, products, Err(EvolveError::Unstable(unstable).to_string())))
        }
        Err(error) => Err(TaskError::from(error)),
    };
    match integrator {
        Integrator::Explicit(method) => {
            let step = courant * heat.closest * heat.closest;
            let steps = ((time / step - 1e-9).ceil() as u64).max(1);
            let result = march(&heat.system, method, &mut u, time / steps as f64, steps);
            ended(steps, steps * u64::from(method.stages()), u, result)
        }
        Integrator::Chebyshev(steps) => {
            let radius = SAFETY * spectrum::radius(&heat.system.matrix, POWER_STEPS);
            let stretches = chebyshev_stretches(time, u64::from(steps), radius);
            let products = stretches.iter().map(|s| s.steps * u64::from(s.stages)).sum::<u64>();
            let result = march_stretches(&heat.system, &stretches, &mut u);
            ended(u64::from(steps), products + POWER_STEPS as u64, u, result)
        }
        Integrator::Implicit(method, steps) => {
            let step = time / f64::from(steps);
            let products = march_implicit(&heat.system, method, &mut u, step, u64::from(steps))?;
            Ok((u64::from(steps), products, Ok(u)))
        }
        Integrator::Exact => {
            let (u, products) = exponential(&heat.system, &u, time, TOLERANCE)?;
            Ok((0, products, Ok(u)))
        }
    }
}

fn three(errors: HeatErrors) -> [f64; 3] {
    [errors.l2, errors.linf, errors.ec].map(rounded)
}

fn rounded(value: f64) -> f64 {
    significant(value, DIGITS)
}
