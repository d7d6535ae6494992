//! The RMS error of a moment sum or an operator on displaced particles, without a sample.
//!
//! With displacements d of zero mean and covariance C, to second order in d,
//! e = e₀ + J·d + ½ d·H·d: ⟨e⟩ = e₀ + ½ tr(H C), Var e = J C J^T, ⟨e²⟩ = e₀² + e₀ tr(H C) + J C J^T. J and H are
//! the exact derivatives with respect to the place of every particle that enters, volumes and B_i among what depends on it.

use super::displaced::{Displaced, Neighbourhood};
use super::expansion::Expansion;
use super::jet::{Jet, LANES};
use super::modes::{Mode, Modes};
use super::DeriveError;
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::particles::{Disorder, Lattice, VolumeRule};
use crate::sums::Component;

/// Where an RMS error is asked for.
#[derive(Debug, Clone)]
pub struct Setting<'a> {
    /// The kernel.
    pub kernel: &'a Kernel,
    /// The lattice.
    pub lattice: &'a Lattice,
    /// How particles leave it.
    pub disorder: &'a Disorder,
    /// R/Δ.
    pub support_over_dx: f64,
    /// Which volumes.
    pub rule: VolumeRule,
}

/// How an expectation was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// To second order in the displacements.
    Linearised,
    /// Over the whole law of the displacements.
    Finite,
}

/// One component of an error, in units of Δ.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentError {
    /// `""`, `x`, `xy`, ….
    pub name: String,
    /// In how many places of the tensor it stands.
    pub multiplicity: u64,
    /// What it would be without error: the target, or the continuum limit.
    pub limit: f64,
    /// The error on the lattice itself.
    pub regular: f64,
    /// ⟨e⟩.
    pub mean: f64,
    /// Var e.
    pub variance: f64,
    /// ⟨e²⟩.
    pub mean_square: f64,
}

/// An RMS error, in units of Δ.
#[derive(Debug, Clone, PartialEq)]
pub struct RmsError {
    /// How it was taken.
    pub model: Model,
    /// By component.
    pub components: Vec<ComponentError>,
    /// Bound of the error of `rms` under the model.
    pub radius: f64,
    /// An estimate of what the model leaves out of `rms`.
    pub model_error: f64,
}

impl RmsError {
    /// √⟨|e|²⟩, the norm of all components.
    pub fn rms(&self) -> f64 {
        self.norm(|component| component.mean_square)
    }

    /// |e| on the lattice itself.
    pub fn regular(&self) -> f64 {
        self.norm(|component| component.regular * component.regular)
    }

    /// The part of disorder: the norm of the standard deviations.
    pub fn disorder(&self) -> f64 {
        self.norm(|component| component.variance)
    }

    /// |⟨e⟩|, of a scalar with its sign.
    pub fn mean(&self) -> f64 {
        match self.components.as_slice() {
            [one] => one.mean,
            _ => self.norm(|component| component.mean * component.mean),
        }
    }

    fn norm(&self, square: impl Fn(&ComponentError) -> f64) -> f64 {
        let squares = self.components.iter().map(|c| c.multiplicity as f64 * square(c));
        squares.sum::<f64>().max(0.0).sqrt()
    }
}

/// What is differentiated: the error of a moment sum, or of an operator on x^m/m!.
enum Differentiated {
    Moment(Vec<Component>),
    Operator { expansion: Box<Expansion>, order: usize },
}

/// How many signed sums of modes estimate what the linearised model leaves out.
const DESIGNS: usize = 2 * LANES;

/// The linearised RMS error. Of a coefficient C_m the error on the field x^m/m! about particle i is meant; operators on a
/// vector take (x^m/m!, 0, 0).
///
/// # Errors
/// [`DeriveError`] if the operator has no value on the lattice.
pub fn linearised(setting: &Setting<'_>, subject: &Subject) -> Result<RmsError, DeriveError> {
    let Setting { kernel, lattice, support_over_dx, rule, disorder } = setting;
    let dimension = lattice.dimension();
    let nested = subject.coefficient().is_some_and(|coefficient| coefficient.is_nested());
    let around = Neighbourhood::new(kernel, lattice, *support_over_dx, *rule, nested);
    let modes = Modes::of(disorder, lattice, &around.sites, around.centre, around.h)?;
    let (what, mut components) = prepared(subject, kernel, dimension, around.h)?;
    let mut trace = vec![0.0; components.len()];
    let still = Modes { mean: Mode::new(), random: vec![Mode::new()] };
    let random = if modes.random.is_empty() { &still.random } else { &modes.random };
    for block in random.chunks(LANES) {
        let errors = evaluated(&what, &around, block)?;
        for ((component, jet), trace) in components.iter_mut().zip(&errors).zip(&mut trace) {
            component.regular = jet.value - component.limit;
            for lane in 0..block.len() {
                component.variance += jet.first[lane] * jet.first[lane];
                *trace += jet.second[lane];
            }
        }
    }
    let along_mean = evaluated(&what, &around, std::slice::from_ref(&modes.mean))?;
    for ((component, trace), shift) in components.iter_mut().zip(&trace).zip(&along_mean) {
        let second = shift.first[0] + 0.5 * (shift.second[0] + trace);
        component.mean = component.regular + second;
        component.mean_square = component.regular * component.regular
            + 2.0 * component.regular * second
            + shift.first[0] * shift.first[0]
            + component.variance;
    }
    let mut error = RmsError { model: Model::Linearised, components, radius: 0.0, model_error: 0.0 };
    error.model_error = left_out(&what, &around, &modes, &error)?;
    // The terms of sums over the support are of the order R^L, L the power of a length that e carries.
    let size = support_over_dx.powi(subject.length_power());
    let pairs = around.sites.len() as f64;
    error.radius = f64::EPSILON * (256.0 + 8.0 * pairs.sqrt()) * (size + error.rms());
    Ok(error)
}

/// √(rms² + q) − rms with q = ½ ⟨(d·H·d)²⟩: of the three terms of fourth order in d, ¼⟨(dHd)²⟩, ⅓⟨(Jd)(Tddd)⟩ and
/// e₀⟨Qdddd⟩/12, the first stands for all, doubled.
fn left_out(
    what: &Differentiated,
    around: &Neighbourhood<'_>,
    modes: &Modes,
    error: &RmsError,
) -> Result<f64, DeriveError> {
    let mut sum = 0.0;
    for block in modes.signed_sums(DESIGNS).chunks(LANES) {
        let jets = evaluated(what, around, block)?;
        for (jet, component) in jets.iter().zip(&error.components) {
            let squares = jet.second.iter().take(block.len()).map(|second| second * second);
            sum += component.multiplicity as f64 * squares.sum::<f64>();
        }
    }
    let rms = error.rms();
    Ok((rms * rms + 0.5 * sum / DESIGNS as f64).sqrt() - rms)
}

/// The components with their limits, and what gives their values.
fn prepared(
    subject: &Subject,
    kernel: &Kernel,
    dimension: usize,
    h: f64,
) -> Result<(Differentiated, Vec<ComponentError>), DeriveError> {
    let entry = |name: String, multiplicity: u64, limit: f64| ComponentError {
        name,
        multiplicity,
        limit,
        regular: 0.0,
        mean: 0.0,
        variance: 0.0,
        mean_square: 0.0,
    };
    match subject {
        Subject::Moment(moment) => {
            let all = moment.components(dimension);
            let unit = (0..moment.length_power().abs()).fold(1.0, |unit, _| unit * h);
            let unit = if moment.length_power() < 0 { 1.0 / unit } else { unit };
            let limit = |component: &Component| {
                unit * kernel.continuum_limit(dimension, &component.terms, 96).enclose(96).midpoint_f64()
            };
            let entries = all.iter().map(|c| entry(c.name.clone(), c.multiplicity, limit(c))).collect();
            Ok((Differentiated::Moment(all), entries))
        }
        Subject::Coefficient(coefficient) => {
            let order = usize::from(coefficient.order());
            let target = coefficient.target().cloned();
            let expansion = Expansion::of(coefficient.operator().clone(), target, order)?;
            let rank = usize::from(coefficient.operator().rank());
            // The expansion has the target taken off already.
            let entries = words(dimension, rank).into_iter().map(|name| entry(name, 1, 0.0)).collect();
            Ok((Differentiated::Operator { expansion: Box::new(expansion), order }, entries))
        }
    }
}

/// The components differentiated along a block of modes.
fn evaluated(
    what: &Differentiated,
    around: &Neighbourhood<'_>,
    block: &[Mode],
) -> Result<Vec<Jet>, DeriveError> {
    let ground = Displaced::along(around, block);
    match what {
        Differentiated::Moment(components) => {
            let mut sums = vec![Jet::constant(0.0); components.len()];
            for (r, volume, g) in ground.pairs() {
                for (sum, component) in sums.iter_mut().zip(components) {
                    for term in &component.terms {
                        let mut value = g[term.radial].clone() * volume.clone();
                        for (x, power) in r.iter().zip(term.monomial.powers) {
                            for _ in 0..power {
                                value = value * x.clone();
                            }
                        }
                        *sum = sum.clone() + value * Jet::constant(term.coefficient as f64);
                    }
                }
            }
            Ok(sums)
        }
        Differentiated::Operator { expansion, order } => {
            // ∂_x^m u alone is not zero, and its multi-index is the first.
            let values = expansion.error_at(&ground, around.centre, *order)?;
            let first = values.into_iter().next().and_then(|components| components.into_iter().next());
            Ok(first.unwrap_or_default())
        }
    }
}

/// The components of a tensor by their letters, the first index slowest.
fn words(dimension: usize, rank: usize) -> Vec<String> {
    (0..rank).fold(vec![String::new()], |words, _| {
        let longer = |word: &String| ["x", "y", "z"][..dimension].iter().map(|l| format!("{word}{l}")).collect();
        words.iter().flat_map::<Vec<String>, _>(longer).collect()
    })
}
