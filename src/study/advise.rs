//! Which operator, kernel and R/Δ meet a tolerance at the least cost.
//!
//! On the wave u = e^{ik·x}, k along x, an operator's error is Σ_m (ik)^m c_m with the errors c_m that it makes of x^m/m!.
//! Their means and variances under the disorder are derived ([`linearised`]), so that no particle is placed: the relative error is
//! √(|Σ_m (ik)^m ⟨c_m⟩|² + Σ_m k^{2m} var c_m) over |k|^n, n the order of the derivative; correlations between the c_m are left
//! out. Candidates are taken in the order of their cost, the number of weights of an assembled row, and the first that meet the
//! tolerance are the answer: nothing dearer is looked at.

use crate::derived::{Setting, linearised};
use crate::kernel::{self, Kernel};
use crate::language::operators;
use crate::language::{Coefficient, Derivative, Field, Subject, Target};
use crate::particles::{Disorder, Lattice, VolumeRule};
use rayon::prelude::*;
use serde::Serialize;

/// The highest m: what follows is smaller by kR/4 and more.
const HIGHEST: u8 = 4;

/// R/Δ of the candidates: quarters from just above the nearest neighbours.
const SUPPORTS: std::ops::RangeInclusive<u32> = 5..=20;

/// Candidates that are evaluated together.
const TOGETHER: usize = 8;

/// What is asked.
#[derive(Debug, Clone)]
pub struct Request<'a> {
    /// `Derivative::Gradient` or `Derivative::Laplacian`.
    pub derivative: Derivative,
    /// The relative error that must not be exceeded.
    pub tolerance: f64,
    /// The lattice.
    pub lattice: &'a Lattice,
    /// The disorder, or none.
    pub disorder: Option<&'a Disorder>,
    /// Wavelength of the field over Δ.
    pub wavelength: f64,
    /// The most neighbours, the particle itself left out.
    pub budget: Option<usize>,
}

/// One candidate with its error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// Id of the operator.
    pub operator: String,
    /// Id of the kernel.
    pub kernel: String,
    /// R/Δ.
    pub support_over_dx: f64,
    /// Neighbours, the particle itself left out.
    pub neighbours: usize,
    /// Weights of an assembled row: neighbours of neighbours count for operators inside operators.
    pub weights: usize,
    /// Multiplications and additions for each particle and application, once assembled.
    pub flops: usize,
    /// The relative error.
    pub error: f64,
    /// √(Σ k^{2m} var c_m)/|k|^n: what disorder contributes.
    pub disorder_part: f64,
    /// By m: k^m √⟨c_m²⟩ / |k|^n.
    pub by_order: Vec<f64>,
}

/// The answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Advice {
    /// The cheapest that meets the tolerance.
    pub best: Option<Candidate>,
    /// The next one, with another operator or kernel.
    pub runner_up: Option<Candidate>,
    /// Of all that were looked at, the one of least error.
    pub most_accurate: Option<Candidate>,
    /// Candidates evaluated.
    pub evaluated: usize,
    /// Candidates that are dearer than the answer and were not looked at.
    pub left_out: usize,
    /// Candidates that have no value on this lattice at this radius, as B̂ with too few neighbours.
    pub without_value: usize,
}

struct Open {
    operator: &'static str,
    nested: bool,
    kernel: Kernel,
    support_over_dx: f64,
    neighbours: usize,
    weights: usize,
}

/// Looks for the cheapest operator, kernel and radius.
pub fn advise(request: &Request<'_>) -> Advice {
    let candidates = candidates(request);
    let mut advice = Advice {
        best: None,
        runner_up: None,
        most_accurate: None,
        evaluated: 0,
        left_out: candidates.len(),
        without_value: 0,
    };
    for together in candidates.chunks(TOGETHER) {
        let found: Vec<Option<Candidate>> = together.par_iter().map(|open| evaluate(request, open)).collect();
        advice.evaluated += found.len();
        advice.left_out -= found.len();
        for candidate in found {
            let Some(candidate) = candidate else {
                advice.without_value += 1;
                continue;
            };
            if advice.most_accurate.as_ref().is_none_or(|known| candidate.error < known.error) {
                advice.most_accurate = Some(candidate.clone());
            }
            if candidate.error > request.tolerance {
                continue;
            }
            match &advice.best {
                None => advice.best = Some(candidate),
                // As cheap and better takes its place; another operator or kernel is the runner-up.
                Some(best) if candidate.weights == best.weights && candidate.error < best.error => {
                    advice.runner_up = advice.best.replace(candidate);
                }
                Some(best) if candidate.operator != best.operator || candidate.kernel != best.kernel => {
                    if advice.runner_up.is_none() {
                        advice.runner_up = Some(candidate);
                    }
                }
                Some(_) => {}
            }
        }
        if advice.best.is_some() && advice.runner_up.is_some() {
            break;
        }
    }
    advice
}

/// The derived error of one operator, by id, with one kernel at one R/Δ. `None` where it has no value, or none was derived.
pub fn derived_error(
    request: &Request<'_>,
    operator: &str,
    kernel: &Kernel,
    support_over_dx: f64,
) -> Option<Candidate> {
    let entry = operators::by_id(operator).ok()?;
    let nested = Coefficient::new(entry.id, 0).ok()?.is_nested();
    evaluate(request, &open(request.lattice, entry.id, nested, kernel, support_over_dx))
}

fn open(
    lattice: &Lattice,
    operator: &'static str,
    nested: bool,
    kernel: &Kernel,
    support_over_dx: f64,
) -> Open {
    let own = neighbours(lattice, support_over_dx);
    let weights = if nested { neighbours(lattice, 2.0 * support_over_dx) + 1 } else { own + 1 };
    Open { operator, nested, kernel: kernel.clone(), support_over_dx, neighbours: own, weights }
}

/// Particles in the support, the one in its middle left out. W vanishes at R: a particle there is no neighbour.
fn neighbours(lattice: &Lattice, support_over_dx: f64) -> usize {
    lattice.sites_within(support_over_dx * (1.0 - 1e-9)).len() - 1
}

/// All candidates within the budget, the cheapest first.
fn candidates(request: &Request<'_>) -> Vec<Open> {
    let target = Target::plain(request.derivative);
    let fitting = operators::catalogue()
        .into_iter()
        .filter(|entry| entry.field == Field::Scalar && entry.target == target);
    let fitting: Vec<(&'static str, bool)> = fitting
        .filter_map(|entry| Some((entry.id, Coefficient::new(entry.id, 0).ok()?.is_nested())))
        .collect();
    let mut all = Vec::new();
    for quarter in SUPPORTS {
        let support_over_dx = 0.25 * f64::from(quarter);
        let neighbours = neighbours(request.lattice, support_over_dx);
        if request.budget.is_some_and(|budget| neighbours > budget) || neighbours == 0 {
            continue;
        }
        for kernel in kernel::catalogue() {
            for (operator, nested) in &fitting {
                all.push(open(request.lattice, operator, *nested, &kernel, support_over_dx));
            }
        }
    }
    all.sort_by_key(|open| (open.weights, open.nested, open.neighbours));
    all
}

/// The error of a candidate, as far as it takes to see that it is too large.
fn evaluate(request: &Request<'_>, open: &Open) -> Option<Candidate> {
    let k = 2.0 * std::f64::consts::PI / request.wavelength;
    let power = match request.derivative {
        Derivative::Gradient => 1,
        _ => 2,
    };
    let still = Disorder::parse("none").ok()?;
    let setting = Setting {
        kernel: &open.kernel,
        lattice: request.lattice,
        disorder: request.disorder.unwrap_or(&still),
        support_over_dx: open.support_over_dx,
        rule: VolumeRule::Constant,
    };
    let (mut real, mut imaginary, mut variance) = (Vec::new(), Vec::new(), 0.0);
    let mut by_order = Vec::new();
    for m in 0..=HIGHEST {
        let subject = Subject::Coefficient(Coefficient::new(open.operator, m).ok()?);
        let error = linearised(&setting, &subject).ok()?;
        let scale = k.powi(i32::from(m)) / k.powi(power);
        real.resize(error.components.len(), 0.0);
        imaginary.resize(error.components.len(), 0.0);
        for (index, component) in error.components.iter().enumerate() {
            let signed = if m % 4 < 2 { scale * component.mean } else { -scale * component.mean };
            *(if m % 2 == 0 { &mut real[index] } else { &mut imaginary[index] }) += signed;
            variance += component.multiplicity as f64 * scale * scale * component.variance;
        }
        by_order.push(scale * error.rms());
    }
    let mean: f64 = real.iter().chain(&imaginary).map(|part| part * part).sum();
    let error = (mean + variance).sqrt();
    error.is_finite().then(|| Candidate {
        operator: open.operator.to_owned(),
        kernel: open.kernel.id().to_owned(),
        support_over_dx: open.support_over_dx,
        neighbours: open.neighbours,
        weights: open.weights,
        flops: 2 * open.weights,
        error,
        disorder_part: variance.sqrt(),
        by_order,
    })
}
