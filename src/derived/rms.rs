//! The RMS error of a moment sum or an operator on displaced particles, without a sample.
//!
//! With displacements d of zero mean and covariance C, to second order in d,
//! e = e₀ + J·d + ½ d·H·d: ⟨e⟩ = e₀ + ½ tr(H C), Var e = J C J^T, ⟨e²⟩ = e₀² + e₀ tr(H C) + J C J^T. J and H are
//! the exact derivatives with respect to the place of every particle that enters, volumes and B_i among what depends on it.

use super::DeriveError;
use super::displaced::{Analytic, DisplacedGround, Neighbourhood};
use super::expansion::Expansion;
use super::jet::{Jet, LANES};
use super::modes::{Mode, Modes};
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::particles::{Disorder, Lattice, VolumeRule};
use crate::sums::{Component, Moment};

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

impl ComponentError {
    fn with_limit(name: String, multiplicity: u64, limit: f64) -> Self {
        Self { name, multiplicity, limit, regular: 0.0, mean: 0.0, variance: 0.0, mean_square: 0.0 }
    }
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

/// How many signed sums of modes estimate what the linearised model leaves out; at most [`LANES`].
const DESIGNS: usize = 8;

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
        let errors = evaluated(&what, &DisplacedGround::along(&around, block))?;
        for ((component, jet), trace) in components.iter_mut().zip(&errors).zip(&mut trace) {
            component.regular = jet.value - component.limit;
            for lane in 0..block.len() {
                component.variance += jet.first[lane] * jet.first[lane];
                *trace += jet.second[lane];
            }
        }
    }
    let along_mean = evaluated(&what, &DisplacedGround::along(&around, std::slice::from_ref(&modes.mean)))?;
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

/// How far ⟨e²⟩ is off, on a few displacements ±v of signed sums of all modes: |e(±v)|² less its expansion to second order
/// and what of it the linearised mean square leaves out.
fn left_out(
    what: &Differentiated,
    around: &Neighbourhood<'_>,
    modes: &Modes,
    error: &RmsError,
) -> Result<f64, DeriveError> {
    let designs = modes.signed_sums(DESIGNS);
    let jets: Vec<Jet> = evaluated(what, &DisplacedGround::along(around, &designs))?;
    let mut off = 0.0;
    for (lane, design) in designs.iter().enumerate() {
        let there: Vec<f64> = evaluated(what, &DisplacedGround::by(around, design, 1.0))?;
        // A mean displacement has one sign only.
        let opposite = modes.mean.is_empty();
        let back = if opposite {
            evaluated(what, &DisplacedGround::by(around, design, -1.0))?
        } else {
            there.clone()
        };
        let mut square = 0.0;
        for (((component, jet), there), back) in error.components.iter().zip(&jets).zip(there).zip(back) {
            let exact =
                [there, back].map(|value| (value - component.limit).powi(2)).iter().sum::<f64>() / 2.0;
            let (e, first, second) = (component.regular, jet.first[lane], jet.second[lane]);
            let odd = if opposite { 0.0 } else { 2.0 * e * first };
            square += component.multiplicity as f64 * (exact - (e * e + odd + e * second + first * first));
        }
        off += square.abs() / DESIGNS as f64;
    }
    let rms = error.rms();
    Ok((rms * rms + off).sqrt() - rms)
}

/// The components with their limits, and what gives their values.
fn prepared(
    subject: &Subject,
    kernel: &Kernel,
    dimension: usize,
    h: f64,
) -> Result<(Differentiated, Vec<ComponentError>), DeriveError> {
    match subject {
        Subject::Moment(moment) => {
            let entries = moment_components(*moment, kernel, dimension, h);
            Ok((Differentiated::Moment(moment.components(dimension)), entries))
        }
        Subject::Coefficient(coefficient) => {
            let order = usize::from(coefficient.order());
            let target = coefficient.target().cloned();
            let expansion = Expansion::of(coefficient.operator().clone(), target, order)?;
            let rank = usize::from(coefficient.operator().rank());
            // The expansion has the target taken off already.
            let entries =
                words(dimension, rank).into_iter().map(|name| ComponentError::with_limit(name, 1, 0.0));
            Ok((Differentiated::Operator { expansion: Box::new(expansion), order }, entries.collect()))
        }
    }
}

/// The components of a moment with their continuum limits, in units of Δ.
pub(super) fn moment_components(
    moment: Moment,
    kernel: &Kernel,
    dimension: usize,
    h: f64,
) -> Vec<ComponentError> {
    let unit = h.powi(moment.length_power());
    let entry = |component: Component| {
        let limit = kernel.continuum_limit(dimension, &component.terms, 96).enclose(96).midpoint_f64();
        ComponentError::with_limit(component.name, component.multiplicity, unit * limit)
    };
    moment.components(dimension).into_iter().map(entry).collect()
}

/// The components on displaced particles.
fn evaluated<T: Analytic>(
    what: &Differentiated,
    ground: &DisplacedGround<'_, T>,
) -> Result<Vec<T>, DeriveError> {
    match what {
        Differentiated::Moment(components) => {
            let mut sums = vec![T::nought(); components.len()];
            for (r, volume, g) in ground.pairs() {
                for (sum, component) in sums.iter_mut().zip(components) {
                    for term in &component.terms {
                        let mut value = g[term.radial].clone() * volume.clone();
                        for (x, power) in r.iter().zip(term.monomial.powers) {
                            for _ in 0..power {
                                value = value * x.clone();
                            }
                        }
                        *sum = sum.clone() + value * T::constant(term.coefficient as f64);
                    }
                }
            }
            Ok(sums)
        }
        Differentiated::Operator { expansion, order } => {
            // ∂_x^m u alone is not zero, and its multi-index is the first.
            let values = expansion.error_at(ground, ground.centre(), *order)?;
            let first = values.into_iter().next().and_then(|components| components.into_iter().next());
            Ok(first.unwrap_or_default())
        }
    }
}

/// The components of a tensor by their letters, the first index slowest.
fn words(dimension: usize, rank: usize) -> Vec<String> {
    (0..rank).fold(vec![String::new()], |words, _| {
        let longer =
            |word: &String| ["x", "y", "z"][..dimension].iter().map(|l| format!("{word}{l}")).collect();
        words.iter().flat_map::<Vec<String>, _>(longer).collect()
    })
}
