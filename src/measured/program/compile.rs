//! A compiled operator, and what it is applied to.

use super::super::constants::vanishes_on_constants;
use super::ProgramError;
use super::expression::Arena;
use super::instruction::Source;
use super::kernel::RadialFunctions;
use super::lower::Lowering;
use super::run::{self, Columns, Context, Inputs};
use super::schedule::{self, Pass};
use crate::exact::rational_to_f64;
use crate::kernel::Kernel;
use crate::language::tree::{OfParticle, Units};
use crate::language::{Field, Operator};
use crate::particles::{Cloud, Neighbours, Support};
use std::borrow::Cow;

/// The values of the field that an operator acts on, in particle order.
#[derive(Debug, Clone, Copy)]
pub enum Fields<'a> {
    /// u.
    Scalar(&'a [f64]),
    /// v, of which the components beyond the dimension are not read.
    Vector(&'a [[f64; 3]]),
}

/// An operator compiled for one kernel in one dimension.
///
/// Sums run over the particles in the support, the particle itself included; there 1/|r_ij|, and any other reciprocal of a
/// pair's quantity that vanishes, counts as 0. An operator that vanishes on constants is applied to u_j − u_i, whatever way it is
/// written: a large constant in the field then costs no digits. h is R over [`Kernel::support_over_h`]; ρ, m and μ are the cloud's fields
/// `density`, `mass` and `viscosity`. The same bits on any number of threads.
///
/// # Examples
/// ```
/// use remainder::kernel::by_id;
/// use remainder::language::Operator;
/// use remainder::measured::{Fields, Program};
/// use remainder::particles::{Cloud, Neighbours, Support};
///
/// // The renormalised gradient is exact for linear functions.
/// let f4 = Operator::parse("sum_j V_j (u_j - u_i) B_i . gradW_ij").unwrap();
/// let program = Program::new(&f4, &by_id("wendland-c2").unwrap(), 1).unwrap();
/// let x = [0.0, 0.9, 2.1, 3.0];
/// let cloud = Cloud::new(1, x.map(|x| [x, 0.0, 0.0]).to_vec(), vec![1.0; 4], Support::Uniform(2.5)).unwrap();
/// let gradient = program.apply(&cloud, &Neighbours::search(&cloud).unwrap(), Fields::Scalar(&x)).unwrap();
/// assert!(gradient.iter().all(|slope| (slope - 1.0).abs() < 1e-14));
/// ```
#[derive(Debug, Clone)]
pub struct Program {
    dimension: usize,
    field: Field,
    kernel: RadialFunctions,
    passes: Vec<Pass>,
    components: usize,
    units: Units,
}

impl Program {
    /// Compiles an operator.
    ///
    /// # Errors
    /// [`ProgramError::Dimension`]; [`ProgramError::Entangled`] for a sum inside another one that depends on the outer
    /// one's particle in another way than by factors and terms, as Σ_j Σ_k V_k W_ik / (ρ_j + ρ_k).
    pub fn new(operator: &Operator, kernel: &Kernel, dimension: usize) -> Result<Self, ProgramError> {
        if !(1..=3).contains(&dimension) {
            return Err(ProgramError::Dimension { found: dimension });
        }
        let functions = RadialFunctions::new(kernel, dimension);
        let smoothing_length = 1.0 / rational_to_f64(kernel.support_over_h());
        let mut lowering =
            Lowering { arena: Arena::default(), kernel: &functions, dimension, smoothing_length };
        let components = lowering.lower(&operator.root)?;
        let mut arena = lowering.arena;
        let mut passes = schedule::passes(&mut arena, &functions, dimension, &components);
        if schedule::takes_values(&passes) && vanishes_on_constants(operator, dimension) {
            schedule::take_differences(&mut passes);
        }
        Ok(Self {
            dimension,
            field: operator.field,
            kernel: functions,
            passes,
            components: components.len(),
            units: operator.root.units,
        })
    }

    /// The number of components of the value: D to the power of its rank.
    pub fn components(&self) -> usize {
        self.components
    }

    /// How often the neighbours are gone through.
    pub fn passes(&self) -> usize {
        self.passes.len() - 1
    }

    /// The operator's values: for each list of neighbours, the components in row-major order of their indices.
    ///
    /// # Errors
    /// [`ProgramError`]: what the cloud lacks, the first particle whose B or B̂ does not exist, the first value that is not
    /// finite.
    pub fn apply(
        &self,
        cloud: &Cloud,
        neighbours: &Neighbours,
        field: Fields<'_>,
    ) -> Result<Vec<f64>, ProgramError> {
        let support = self.check(cloud, neighbours, field)?;
        let inputs = self.inputs(cloud, field, support)?;
        let mut stored: Vec<Columns<'_>> = Vec::with_capacity(self.passes.len());
        for (index, pass) in self.passes.iter().enumerate() {
            let last = index + 1 == self.passes.len();
            // Pass 0 does not look at neighbours; the last one is taken where there are lists.
            let lists = (index > 0 || last).then_some(neighbours);
            let context =
                Context { pass, program: self, inputs: &inputs, stored: &stored, lists, probe: None };
            let values = run::pass(context)?;
            stored.push(Columns { values: Cow::Owned(values), stride: pass.columns.len(), offset: 0 });
        }
        let mut values = stored.pop().map(|columns| columns.values.into_owned()).unwrap_or_default();
        let width = self.components.max(1);
        Self::in_units(values.iter_mut().enumerate(), self.unit(support), |at| {
            neighbours.centre(at / width)
        })?;
        Ok(values)
    }

    /// Multiplies the values by the unit, if the largest of them is a number then that keeps its digits. Each comes with a place,
    /// and each place has a particle.
    pub(super) fn in_units<'a>(
        values: impl Iterator<Item = (usize, &'a mut f64)>,
        unit: f64,
        particle: impl Fn(usize) -> usize,
    ) -> Result<(), ProgramError> {
        let (mut largest, mut there) = (0.0_f64, (0, 0.0));
        for (place, value) in values {
            let before = value.abs();
            *value *= unit;
            if before > largest {
                (largest, there) = (before, (place, *value));
            }
        }
        let (place, value) = there;
        match largest * unit {
            found if !found.is_finite() => Err(ProgramError::NotFinite { particle: particle(place), value }),
            found if largest > 0.0 && found < f64::MIN_POSITIVE => {
                Err(ProgramError::TooSmall { particle: particle(place) })
            }
            _ => Ok(()),
        }
    }

    pub(super) fn all_passes(&self) -> &[Pass] {
        &self.passes
    }

    pub(super) fn dimension(&self) -> usize {
        self.dimension
    }

    pub(super) fn kernel(&self) -> &RadialFunctions {
        &self.kernel
    }

    /// What the value is to be multiplied by, lengths having been in units of R.
    pub(super) fn unit(&self, support: f64) -> f64 {
        support.powi(self.units.length + self.units.volume * self.dimension as i32)
    }

    /// The support of all particles.
    pub(super) fn check(
        &self,
        cloud: &Cloud,
        neighbours: &Neighbours,
        field: Fields<'_>,
    ) -> Result<f64, ProgramError> {
        if cloud.dimension() != self.dimension {
            return Err(ProgramError::OtherDimension { expected: self.dimension, found: cloud.dimension() });
        }
        let (kind, found) = match field {
            Fields::Scalar(values) => (Field::Scalar, values.len()),
            Fields::Vector(values) => (Field::Vector, values.len()),
        };
        if kind != self.field {
            return Err(ProgramError::OtherField { expected: self.field.name() });
        }
        let expected = cloud.len();
        if found != expected {
            return Err(ProgramError::Length { found, expected });
        }
        let complete = neighbours.len() == expected && (0..expected).all(|k| neighbours.centre(k) == k);
        let valid = complete || (0..neighbours.len()).all(|k| neighbours.centre(k) < expected);
        if !valid || (!complete && self.passes() > 1) {
            return Err(ProgramError::Lists { found: neighbours.len(), expected });
        }
        let support = cloud.support_of(0);
        if let Support::PerParticle(radii) = cloud.support() {
            if let Some(particle) = radii.iter().position(|radius| *radius != support) {
                return Err(ProgramError::Supports { particle });
            }
        }
        Ok(support)
    }

    pub(super) fn inputs<'a>(
        &self,
        cloud: &'a Cloud,
        field: Fields<'a>,
        support: f64,
    ) -> Result<Inputs<'a>, ProgramError> {
        let volume = support.powi(self.dimension as i32);
        let carried = |name| cloud.field(name).ok_or(ProgramError::MissingField { name });
        let column = |values| Columns { values, stride: 1, offset: 0 };
        let mut columns = Vec::new();
        for source in self.passes.iter().flat_map(Pass::sources) {
            if columns.iter().any(|(known, _)| *known == source) {
                continue;
            }
            let values = match source {
                Source::Stored { .. } => continue,
                Source::Field(component) => {
                    let values = match field {
                        Fields::Scalar(values) => column(Cow::Borrowed(values)),
                        Fields::Vector(values) => Columns {
                            values: Cow::Borrowed(values.as_flattened()),
                            stride: 3,
                            offset: component,
                        },
                    };
                    columns.push((source, values));
                    continue;
                }
                Source::Quantity(quantity) => match quantity {
                    OfParticle::Volume => scaled(cloud.volumes(), 1.0 / volume),
                    OfParticle::Density => scaled(carried("density")?, volume),
                    OfParticle::Mass => Cow::Borrowed(carried("mass")?),
                    OfParticle::Viscosity => Cow::Borrowed(carried("viscosity")?),
                },
            };
            columns.push((source, column(values)));
        }
        Ok(Inputs { columns, particles: cloud.len(), per_support: 1.0 / support })
    }
}

fn scaled(values: &[f64], factor: f64) -> Cow<'_, [f64]> {
    Cow::Owned(values.iter().map(|value| value * factor).collect())
}
