//! What the parts share: tasks, cases, judged entries.

use super::super::{SurveyTask, TaskError, entry};
use super::parameters::BasaParameters;
use crate::claim::basa_2009::basa_2009;
use crate::claim::{Measured, Observed};
use crate::exact::rational_to_f64;
use crate::kernel::Kernel;
use crate::measured::fit::line;
use crate::particles::{Disorder, VolumeRule};
use crate::record::{Axis, Case, Line, Report, Series, significant};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;

/// A part of the study.
pub(super) trait Part: Send + Sync {
    /// Its tasks, in a fixed order.
    fn tasks(&self) -> Vec<SurveyTask>;

    /// The result of one of them.
    fn compute(&self, task: usize) -> Result<Value, TaskError>;

    /// Enters what follows from the results.
    fn report(&self, results: &[Value], report: &mut Report) -> Result<(), TaskError>;
}

/// What the scene says.
pub(super) struct Common {
    pub kernel: Kernel,
    pub parameters: BasaParameters,
    pub disorders: Vec<Disorder>,
    pub seed: u64,
    /// Whether this is a first look.
    pub quick: bool,
}

impl Common {
    /// R/Δ at a Δx/h of the paper, whose h is R/2 (cubic spline).
    pub(super) fn support(dx_over_h: f64) -> f64 {
        2.0 / dx_over_h
    }

    /// Δ/h of a kernel with its own h, at this R/Δ.
    pub(super) fn dx_over_h(kernel: &Kernel, support: f64) -> f64 {
        rational_to_f64(kernel.support_over_h()) / support
    }

    /// A task whose inputs are its name, the kernel, the seed and whatever it depends on besides.
    pub(super) fn task(&self, name: &str, more: &impl Serialize, cost: u64) -> SurveyTask {
        let more = serde_json::to_string(more).unwrap_or_default();
        let kernel = serde_json::to_string(&self.kernel.canonical_profile()).unwrap_or_default();
        let inputs = format!("basa\n{name}\n{kernel}\n{}\n{more}", self.seed);
        SurveyTask { label: format!("basa {name}"), inputs, cost }
    }

    /// A case on regular particles of the paper's kernel.
    pub(super) fn case(&self, lattice: &str, dimension: usize, rule: VolumeRule) -> Case {
        case(self.kernel.id(), lattice, dimension, rule.id())
    }
}

/// A case; `lattice` may be `continuum`.
pub(super) fn case(kernel: &str, lattice: &str, dimension: usize, rule: &str) -> Case {
    Case {
        source: "lattice".into(),
        dimension: dimension as u8,
        kernel: kernel.into(),
        lattice: Some(lattice.into()),
        disorder: None,
        volume_rule: rule.into(),
        more: BTreeMap::new(),
    }
}

/// More fields of a case.
pub(super) trait With {
    /// With this field.
    fn with(self, name: &str, value: impl Into<Value>) -> Self;
    /// With this disorder.
    fn disordered(self, disorder: &str) -> Self;
}

impl With for Case {
    fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.more.insert(name.into(), value.into());
        self
    }

    fn disordered(mut self, disorder: &str) -> Self {
        self.disorder = Some(disorder.into());
        self
    }
}

/// Enters a claim in one case.
pub(super) fn judge(
    report: &mut Report,
    id: &str,
    case: Case,
    derived: Option<Observed>,
    measured: Option<Observed>,
) -> Result<(), TaskError> {
    let id = format!("basa-{id}");
    let known = basa_2009();
    let assertion = known.iter().find(|assertion| assertion.id == id);
    let assertion = assertion.ok_or_else(|| format!("there is no assertion '{id}'"))?;
    report.claims.push(entry(assertion, case, derived, measured, Vec::new()));
    Ok(())
}

/// A number known without error.
pub(super) fn number(value: f64) -> Option<Observed> {
    Some(Observed::Number(Measured::exactly(value)))
}

/// Both sides of a relation, known without error.
pub(super) fn sides(left: f64, right: f64) -> Option<Observed> {
    Some(Observed::Sides { left: Measured::exactly(left), right: Measured::exactly(right) })
}

/// Both sides with their standard errors: 95 % of a normal distribution.
pub(super) fn sides_within(left: [f64; 2], right: [f64; 2]) -> Option<Observed> {
    let around =
        |[value, error]: [f64; 2]| Measured { value, low: value - 1.96 * error, high: value + 1.96 * error };
    Some(Observed::Sides { left: around(left), right: around(right) })
}

/// What vanishes exactly.
pub(super) fn nothing() -> Option<Observed> {
    Some(Observed::Zero { largest: 0.0, floor: 0.0 })
}

/// What reaches `largest`; 0 and a floor of 0 mean exactly zero.
pub(super) fn zero(largest: f64, floor: f64) -> Option<Observed> {
    Some(Observed::Zero { largest, floor })
}

/// The slope of ln y against ln x with its 95 % interval.
pub(super) fn slope(points: &[[f64; 2]]) -> Result<Measured, TaskError> {
    let logs: Vec<(f64, f64, f64)> =
        points.iter().map(|[x, y]| (libm::log(*x), libm::log(*y), 1.0)).collect();
    let fit = line(&logs)?.fit;
    let interval = fit.interval(1, 0.95)?;
    let round = |value| significant(value, 8);
    Ok(Measured { value: round(interval.value), low: round(interval.low), high: round(interval.high) })
}

/// A figure.
pub(super) fn series(
    id: &str,
    figure: Option<&str>,
    x: (&str, &str, bool),
    y: (&str, &str, bool),
    lines: Vec<(String, Vec<Vec<f64>>)>,
) -> Series {
    let axis = |(name, unit, log): (&str, &str, bool)| Axis { name: name.into(), unit: unit.into(), log };
    let round = |points: Vec<Vec<f64>>| {
        points.into_iter().map(|point| point.into_iter().map(|v| significant(v, 8)).collect()).collect()
    };
    Series {
        id: id.into(),
        figure: figure.map(Into::into),
        x: axis(x),
        y: axis(y),
        lines: lines.into_iter().map(|(name, points)| Line { name, points: round(points) }).collect(),
    }
}

/// A result as it was stored.
pub(super) fn stored<T: DeserializeOwned>(value: &Value) -> Result<T, TaskError> {
    Ok(T::deserialize(value)?)
}
