//! The stored results by what they are of.

use super::compute::{Distances, Errors, Moments, Work};
use super::model::{Model, Place};
use super::{ChaussonnetTable, KERNEL, RULE, TaskError};
use crate::claim::Measured;
use crate::particles::VolumeRule;
use crate::record::{Axis, Case, Line, Series, significant};
use serde_json::Value;
use std::collections::BTreeMap;

/// Half-width of a 95 % interval in standard errors.
const NORMAL: f64 = 1.96;

/// Derived errors are of second order in the displacements, and are not given beyond this η: at 0.3125 they are off by up to
/// 15 %, at 0.0625 by less than 1 %.
const DERIVED_UP_TO: f64 = 0.1;

/// All that was measured and derived.
pub(super) struct Results<'a> {
    pub table: &'a ChaussonnetTable,
    distances: Vec<(&'a Work, Distances)>,
    errors: Vec<(&'a Work, Errors)>,
    derived: Vec<(&'a Work, Moments)>,
    pub precision: Vec<(&'a Work, Vec<Vec<[f64; 5]>>)>,
    pub checks: Vec<(&'a Work, super::compute::Checks)>,
    pub samples: u64,
    pub pairs: u64,
}

impl<'a> Results<'a> {
    pub(super) fn new(
        table: &'a ChaussonnetTable,
        works: &'a [Work],
        values: &[Value],
    ) -> Result<Self, TaskError> {
        let mut results = Self {
            table,
            distances: Vec::new(),
            errors: Vec::new(),
            derived: Vec::new(),
            precision: Vec::new(),
            checks: Vec::new(),
            samples: 0,
            pairs: 0,
        };
        for (work, value) in works.iter().zip(values) {
            let value = value.clone();
            match work {
                Work::Distances { .. } => {
                    let found: Distances = serde_json::from_value(value)?;
                    results.samples += found.samples;
                    results.pairs += found.pairs;
                    results.distances.push((work, found));
                }
                Work::Consistency { .. } | Work::Operators { .. } => {
                    let found: Errors = serde_json::from_value(value)?;
                    results.samples += found.samples;
                    results.pairs += found.pairs;
                    results.errors.push((work, found));
                }
                Work::Precision { .. } => results.precision.push((work, serde_json::from_value(value)?)),
                Work::Derived { .. } => results.derived.push((work, serde_json::from_value(value)?)),
                Work::Checks { .. } => results.checks.push((work, serde_json::from_value(value)?)),
            }
        }
        Ok(results)
    }

    pub(super) fn distances(&self) -> impl Iterator<Item = (&'static str, f64, &Distances)> {
        self.distances.iter().filter_map(|(work, found)| match work {
            Work::Distances { lattice, eta } => Some((*lattice, *eta, found)),
            _ => None,
        })
    }

    fn of(&self, wanted: &Work) -> Option<&Errors> {
        self.errors.iter().find(|(work, _)| *work == wanted).map(|(_, errors)| errors)
    }

    /// Consistency errors.
    pub(super) fn consistency(&self, lattice: &'static str, eta: f64, h: f64) -> Option<&Errors> {
        self.of(&Work::Consistency { lattice, eta, h })
    }

    /// Errors of operators.
    pub(super) fn operators(&self, lattice: &'static str, eta: f64, h: f64, scale: f64) -> Option<&Errors> {
        self.of(&Work::Operators { lattice, eta, h, scale })
    }

    /// Λ or Ω by name, `G0/F1/x`: value and standard error.
    pub(super) fn rms(&self, at: At, name: &str) -> Option<(f64, f64)> {
        let found = self.operators(at.lattice, at.eta, at.h, at.scale)?.squares.get(name)?;
        Some((found.rms(), found.rms_error()))
    }

    /// The same with its interval.
    pub(super) fn measured(&self, at: At, name: &str) -> Option<Measured> {
        self.rms(at, name).map(interval)
    }

    /// The derived model under the disorder of the scene and V = 1/ΣW.
    pub(super) fn model(&self, lattice: &str) -> Option<Model<'_>> {
        let printed = ChaussonnetTable::is_3d(lattice) && self.table.angles == "printed";
        self.model_of(lattice, printed, RULE)
    }

    pub(super) fn model_of(&self, lattice: &str, printed: bool, rule: VolumeRule) -> Option<Model<'_>> {
        let found = self.derived.iter().find(|(work, _)| match work {
            Work::Derived { lattice: of, disorder, rule: by } => {
                *of == lattice && disorder.ends_with("printed") == printed && *by == rule
            }
            _ => false,
        });
        found.map(|(_, moments)| Model(moments))
    }

    /// Where the errors of a case are taken.
    pub(super) fn place(&self, at: At) -> Option<Place> {
        let means = &self.operators(at.lattice, at.eta, at.h, at.scale)?.means;
        Some(Place {
            eta: at.eta,
            dx_over_size: at.h / self.table.h_over_dx / self.table.domain_size_m,
            xi_square: *means.get("ξ²")?,
            xi_inverse_square: *means.get("1/ξ²")?,
        })
    }

    /// Whether there are derived errors at this η.
    pub(super) fn is_derived_at(eta: f64) -> bool {
        eta <= DERIVED_UP_TO
    }

    /// The derived E of the same name.
    pub(super) fn derived_consistency(&self, lattice: &str, eta: f64, name: &str) -> Option<f64> {
        let model = self.model(lattice).filter(|_| Self::is_derived_at(eta))?;
        Some(model.consistency(name, eta, self.table.h_over_dx))
    }

    /// The derived Λ or Ω of the same name.
    pub(super) fn derived(&self, at: At, name: &str) -> Option<f64> {
        if !Self::is_derived_at(at.eta) {
            return None;
        }
        let mut parts = name.split('/');
        let (operator, field, axis) = (parts.next()?, parts.next()?, parts.next()?);
        let field = field.chars().last()?.to_digit(10)? as u8;
        let axis = ["x", "y", "z"].iter().position(|known| *known == axis)?;
        Some(self.model(at.lattice)?.error(operator, field, axis, self.place(at)?))
    }

    /// The largest h of the operator tests on all lattices, at which lattices are compared.
    pub(super) fn common_h(&self) -> f64 {
        self.table.h_m[0]
    }

    /// A case of a claim, `more` telling it from others.
    pub(super) fn case(&self, lattice: &str, eta: Option<f64>, more: &[(&str, Value)]) -> Case {
        Case {
            source: "cloud".into(),
            dimension: if ChaussonnetTable::is_3d(lattice) { 3 } else { 2 },
            kernel: KERNEL.into(),
            lattice: Some(lattice.into()),
            disorder: eta.map(|eta| self.table.disorder(lattice, eta)),
            volume_rule: RULE.id().into(),
            more: more
                .iter()
                .map(|(key, value)| ((*key).to_owned(), value.clone()))
                .collect::<BTreeMap<_, _>>(),
        }
    }
}

/// One case of the operator tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct At {
    pub lattice: &'static str,
    pub eta: f64,
    pub h: f64,
    pub scale: f64,
}

/// A value with its standard error as an interval of 95 %.
pub(super) fn interval((value, error): (f64, f64)) -> Measured {
    Measured { value, low: value - NORMAL * error, high: value + NORMAL * error }
}

/// a/b of two values that do not vary together.
pub(super) fn ratio(a: Measured, b: Measured) -> Measured {
    let value = a.value / b.value;
    let relative = |m: Measured| 0.5 * (m.high - m.low) / m.value.abs();
    let (ra, rb) = (relative(a), relative(b));
    let half = value.abs() * (ra * ra + rb * rb).sqrt();
    Measured { value, low: value - half, high: value + half }
}

/// An axis.
pub(super) fn axis(name: &str, unit: &str) -> Axis {
    Axis { name: name.into(), unit: unit.into(), log: true }
}

/// A line of a figure: points \[x, y, standard error\].
pub(super) fn line(name: impl Into<String>, points: impl Iterator<Item = (f64, f64, f64)>) -> Line {
    let points = points.map(|(x, y, error)| vec![x, significant(y, 8), significant(error, 3)]).collect();
    Line { name: name.into(), points }
}

/// A figure.
pub(super) fn figure(id: &str, figure: &str, x: Axis, y: Axis, lines: Vec<Line>) -> Series {
    Series { id: id.into(), figure: Some(figure.into()), x, y, lines }
}
