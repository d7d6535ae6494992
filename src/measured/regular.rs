//! Rungs of the regular ladder at one R/Δ and its offsets: exact lattice sums of moments, stencils in floating point for
//! what an operator's expansion multiplies ∇^m u by.

use super::coefficient::{coefficients, made_ready, norm, regular_patch, target_components};
use super::sample::FLOOR_FACTOR;
use super::stencil::StencilError;
use crate::exact::{Enclosure, Rational, int, rational_to_f64};
use crate::kernel::Kernel;
use crate::language::{Coefficient, Subject};
use crate::particles::{Lattice, PointGroup, VolumeRule};
use crate::sums::{LatticeSums, Moment, Reduction, SumError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What to sum.
#[derive(Debug, Clone)]
pub struct RegularSpec {
    /// The kernel.
    pub kernel: Kernel,
    /// The lattice.
    pub lattice: Lattice,
    /// Which volumes.
    pub rule: VolumeRule,
    /// Moment sums and coefficients of operators, sorted.
    pub subjects: Vec<Subject>,
    /// R/Δ of the rung and its offsets.
    pub supports: Vec<Rational>,
    /// Memory that gathering the shells may take.
    pub memory_mib: u64,
}

/// One subject at one R/Δ, in units of h.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RegularNorm {
    /// |S^reg|, Frobenius.
    pub value: f64,
    /// |S^reg − continuum limit|, Frobenius; of a coefficient, its distance from the target's.
    pub deviation: f64,
    /// Bound of the error of both.
    pub radius: f64,
}

/// A rung: by R/Δ, then by subject.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegularRung {
    /// R/Δ, decimal.
    pub supports: Vec<f64>,
    /// By R/Δ, then by subject in the order of the request.
    pub norms: Vec<Vec<RegularNorm>>,
    /// Particles in the support with i, by R/Δ.
    pub in_support: Vec<u64>,
    /// Exact sums taken: one per component left by symmetry and R/Δ.
    pub exact_sums: u64,
}

/// Why a rung could not be taken.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RegularError {
    /// A lattice sum.
    #[error(transparent)]
    Sum(#[from] SumError),
    /// A stencil.
    #[error(transparent)]
    Stencil(#[from] StencilError),
}

/// Fractional bits of the first attempt, and of the last: a norm whose enclosure still holds zero at the last is taken
/// as zero by value.
const BITS: [u32; 3] = [160, 320, 640];

/// Sums one rung.
///
/// # Errors
/// [`RegularError`].
pub fn regular_rung(spec: &RegularSpec, group: &PointGroup) -> Result<RegularRung, RegularError> {
    let Some(largest) = spec.supports.iter().max() else {
        return Ok(RegularRung {
            supports: Vec::new(),
            norms: Vec::new(),
            in_support: Vec::new(),
            exact_sums: 0,
        });
    };
    let moments: Vec<Moment> = spec.subjects.iter().filter_map(Subject::moment).collect();
    let sums = LatticeSums::new(&spec.kernel, &spec.lattice, largest, &moments, spec.memory_mib)?;
    let dimension = spec.lattice.dimension();
    let reductions: Vec<Reduction> =
        moments.iter().map(|moment| Reduction::of(*moment, &spec.lattice, group)).collect();
    let free: Vec<_> = reductions.iter().map(Reduction::free).collect();
    // As accurate as the last attempt needs it: exact limits are rounded to each attempt's bits below.
    let finest = BITS[BITS.len() - 1] + 32;
    let limits: Vec<Vec<crate::exact::Coefficient>> = free
        .iter()
        .map(|components| {
            components.iter().map(|c| spec.kernel.continuum_limit(dimension, &c.terms, finest)).collect()
        })
        .collect();
    let mut rung =
        RegularRung { supports: Vec::new(), norms: Vec::new(), in_support: Vec::new(), exact_sums: 0 };
    for support in &spec.supports {
        rung.in_support.push(sums.count(support)?.in_support);
        rung.supports.push(rational_to_f64(support));
        let h = support / spec.kernel.support_over_h();
        let mut norms = Vec::with_capacity(free.len());
        for ((moment, components), limits) in moments.iter().zip(&free).zip(&limits) {
            rung.exact_sums += components.len() as u64;
            let scale = power(&h, -moment.length_power());
            let mut norm = RegularNorm { value: 0.0, deviation: 0.0, radius: 0.0 };
            for bits in BITS {
                let enclosed = sums.enclose(support, components, spec.rule, bits)?;
                let squares = |subtract: bool| {
                    let mut total = Enclosure::from_i64(0);
                    for ((sum, limit), component) in enclosed.iter().zip(limits).zip(components) {
                        let mut scaled = sum * &Enclosure::exact(&scale, bits + 32);
                        if subtract {
                            scaled = &scaled - &limit.enclose(bits + 32).round(bits + 32);
                        }
                        let square = &scaled * &scaled;
                        total = &total + &(&square * &Enclosure::from_i64(component.multiplicity as i64));
                    }
                    total.round(2 * bits)
                };
                let (value, deviation) = (squares(false), squares(true));
                let accurate =
                    |square: &Enclosure| square.relative_accuracy_bits().is_some_and(|bits| bits >= 48);
                norm = norm_of(&value, &deviation);
                if components.is_empty() || (accurate(&value) && accurate(&deviation)) {
                    break;
                }
            }
            norms.push(norm);
        }
        norms.extend(coefficient_norms(spec, support)?);
        rung.norms.push(norms);
    }
    Ok(rung)
}

/// The coefficients at one R/Δ; moments sort before them.
fn coefficient_norms(spec: &RegularSpec, support: &Rational) -> Result<Vec<RegularNorm>, RegularError> {
    let asked: Vec<&Coefficient> = spec.subjects.iter().filter_map(Subject::coefficient).collect();
    if asked.is_empty() {
        return Ok(Vec::new());
    }
    let dimension = spec.lattice.dimension();
    let (evaluator, h) = made_ready(&spec.kernel, dimension);
    let nested = asked.iter().any(|coefficient| coefficient.is_nested());
    let patch = regular_patch(&evaluator, h, &spec.lattice, rational_to_f64(support), spec.rule, nested);
    let values = coefficients(&spec.subjects, &patch)?;
    let norms = asked.iter().zip(values).map(|(coefficient, (components, magnitude))| {
        let power = Subject::Coefficient((*coefficient).clone()).length_power();
        let to_h = h.powi(-power);
        let target = target_components(coefficient, dimension);
        let deviation: Vec<f64> = components.iter().zip(target).map(|(c, t)| c - t).collect();
        RegularNorm {
            value: norm(coefficient, dimension, &components) * to_h,
            deviation: norm(coefficient, dimension, &deviation) * to_h,
            radius: FLOOR_FACTOR * f64::EPSILON * magnitude * to_h,
        }
    });
    Ok(norms.collect())
}

fn norm_of(value: &Enclosure, deviation: &Enclosure) -> RegularNorm {
    let root = |square: &Enclosure| {
        let (low, high) = square.bounds_f64();
        let (low, high) = (low.max(0.0).sqrt(), high.max(0.0).sqrt());
        // Not shown to differ from zero at the last precision: zero by value.
        if low == 0.0 {
            (0.0, high)
        } else {
            (0.5 * (low + high), 0.5 * (high - low) * (1.0 + 4.0 * f64::EPSILON))
        }
    };
    let (value, deviation) = (root(value), root(deviation));
    RegularNorm { value: value.0, deviation: deviation.0, radius: value.1.max(deviation.1) }
}

fn power(base: &Rational, exponent: i32) -> Rational {
    let positive = (0..exponent.abs()).fold(int(1), |product, _| product * base);
    if exponent < 0 { positive.recip() } else { positive }
}
