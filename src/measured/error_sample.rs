//! The RMS error of a moment sum or an operator over samples of the disorder: what the derived RMS is set beside.

use super::coefficient::target_components;
use super::sample::{SampleError, SampleSpec, Sampler};
use crate::kernel::Kernel;
use crate::language::Subject;
use rayon::prelude::*;

/// What sampling found, in units of Δ.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledError {
    /// Samples evaluated.
    pub samples: u64,
    /// Samples with particles closer than [`super::CLOSEST`] Δ, which were not.
    pub degenerate: u64,
    /// √⟨|e|²⟩.
    pub rms: f64,
    /// Its standard error.
    pub rms_error: f64,
    /// By component: √⟨e²⟩ and ⟨e⟩.
    pub components: Vec<[f64; 2]>,
}

/// Takes `samples` samples of the error of `spec`'s one subject: a moment's distance from its continuum limit, or what an
/// operator makes of x^m/m! about particle i (of (x^m/m!, 0, 0)) less its target. The sums are made in the order of the
/// samples.
///
/// # Errors
/// As [`Sampler::new`] and [`Sampler::block`].
pub fn sampled_error(spec: &SampleSpec, samples: u64) -> Result<SampledError, SampleError> {
    let Some(subject) = spec.subjects.first() else {
        return Ok(SampledError {
            samples: 0,
            degenerate: 0,
            rms: 0.0,
            rms_error: 0.0,
            components: Vec::new(),
        });
    };
    let dimension = spec.lattice.dimension();
    let sampler = Sampler::new(spec.clone())?;
    let radius = spec.support_over_dx;
    // Sums are taken in units of R.
    let unit = radius.powi(subject.length_power());
    let (limits, multiplicities): (Vec<f64>, Vec<f64>) = match subject {
        Subject::Moment(moment) => {
            let all = moment.components(dimension);
            let limit = |terms| unit_limit(&spec.kernel, dimension, terms, moment.length_power());
            let limits = all.iter().map(|component| unit * limit(&component.terms));
            (limits.collect(), all.iter().map(|component| component.multiplicity as f64).collect())
        }
        Subject::Coefficient(coefficient) => {
            // ∂_x^m u is the first of its order, and the field's first component the first in each.
            let count = dimension.pow(u32::from(coefficient.operator().rank()));
            let target = target_components(coefficient, dimension);
            (target[..count].iter().map(|target| unit * target).collect(), vec![1.0; count])
        }
    };
    let all: Vec<Option<Vec<f64>>> =
        (0..samples).into_par_iter().map(|sample| sampler.values(sample)).collect::<Result<_, _>>()?;
    let mut found = SampledError {
        samples: 0,
        degenerate: 0,
        rms: 0.0,
        rms_error: 0.0,
        components: vec![[0.0; 2]; limits.len()],
    };
    let (mut square, mut fourth) = (0.0, 0.0);
    for values in all {
        let Some(values) = values else {
            found.degenerate += 1;
            continue;
        };
        found.samples += 1;
        let mut norm = 0.0;
        for (((value, limit), multiplicity), sums) in
            values.iter().zip(&limits).zip(&multiplicities).zip(&mut found.components)
        {
            let error = unit * value - limit;
            sums[0] += error * error;
            sums[1] += error;
            norm += multiplicity * error * error;
        }
        square += norm;
        fourth += norm * norm;
    }
    let n = found.samples.max(1) as f64;
    for sums in &mut found.components {
        *sums = [(sums[0] / n).sqrt(), sums[1] / n];
    }
    let mean_square = square / n;
    found.rms = mean_square.sqrt();
    let variance = (fourth / n - mean_square * mean_square).max(0.0);
    if found.rms > 0.0 && found.samples > 1 {
        found.rms_error = (variance / (n - 1.0)).sqrt() / (2.0 * found.rms);
    }
    Ok(found)
}

/// The continuum limit in units of R.
fn unit_limit(
    kernel: &Kernel,
    dimension: usize,
    terms: &[crate::kernel::SummandTerm],
    length_power: i32,
) -> f64 {
    let in_h = kernel.continuum_limit(dimension, terms, 96).enclose(96).midpoint_f64();
    in_h / crate::exact::rational_to_f64(kernel.support_over_h()).powi(length_power)
}
