//! What rounding takes from an operator's value: as computed, beside a bound made while computing and the value in twice the
//! digits on the same data.

use super::bounded::{Bounded, UNIT};
use super::constants::vanishes_on_constants;
use super::double_double::Dd;
use super::program::{Fields, Program, ProgramError};
use super::stencil::{Applied, StencilError, value};
use crate::exact::{Number, Polynomial, Rational, int};
use crate::kernel::{Kernel, RadialFunction};
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::OfParticle;
use crate::language::{Field, Operator};
use crate::particles::{Cloud, CloudError, Neighbour, Neighbours};
use nalgebra::DMatrix;
use thiserror::Error;

/// Why there is nothing to compare.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RoundingError {
    /// The operator was refused.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The particles were refused.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// In twice the digits there is no value.
    #[error(transparent)]
    Stencil(#[from] StencilError),
    /// The kernel is no piecewise polynomial.
    #[error("'{kernel}' has no values in twice the digits: take a kernel made of polynomials")]
    Kernel {
        /// Its id.
        kernel: String,
    },
}

/// The value of an operator at one particle.
#[derive(Debug, Clone, PartialEq)]
pub struct Rounding {
    /// As computed, by component.
    pub computed: Vec<f64>,
    /// In twice the digits, on the same data.
    pub exact: Vec<f64>,
    /// Decimal digits lost: log₁₀ of |computed − exact| over 2⁻⁵³ |exact|, both the largest of the components; 0 if none is.
    pub lost: f64,
    /// The same of a bound on |computed − exact|, made without knowing it.
    pub predicted: f64,
    /// Correct digits in `f32`, taken as written; `None` where it has no value.
    pub single: Option<f64>,
    /// Condition number of B_i, in the norm of largest stretch.
    pub condition_b: Option<f64>,
    /// Of B̂_i.
    pub condition_b_hat: Option<f64>,
}

/// Applies an operator at particle `i` of a cloud in the ways there are. Values scale as powers of two with the lengths and the
/// field: cases at the ends of the range of numbers are to be compared after scaling, as the bound and the exact value do not
/// look after overflow.
///
/// # Errors
/// [`RoundingError`].
pub fn rounding(
    operator: &Operator,
    kernel: &Kernel,
    cloud: &Cloud,
    i: usize,
    field: &[[f64; 3]],
) -> Result<Rounding, RoundingError> {
    let program = Program::new(operator, kernel, cloud.dimension())?;
    let lists = Lists::of(&program, cloud, i)?;
    let computed = lists.apply(&program, operator.field, cloud, field)?;
    let numbers = |p: usize| field[p].iter().copied();
    // The bound is on what is computed: differences, where constants do not matter.
    let differences = vanishes_on_constants(operator, cloud.dimension());
    let bounded = on_ground(operator, kernel, cloud, &lists, i, Bounded::exactly, &|p| {
        let own = numbers(p).map(Bounded::exactly);
        let less = numbers(i).map(|u| Bounded::exactly(if differences { u } else { 0.0 }));
        own.zip(less).map(|(u, less)| u - less).collect()
    })?;
    let exact =
        on_ground(operator, kernel, cloud, &lists, i, Dd::from, &|p| numbers(p).map(Dd::from).collect())?;
    let as_single = |x: f64| x as f32;
    let single =
        on_ground(operator, kernel, cloud, &lists, i, as_single, &|p| numbers(p).map(as_single).collect())
            .ok();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let size = largest(&mut exact.components.iter().map(|x| x.to_f64()));
    let digits = |error: f64| if error == 0.0 { 0.0 } else { libm::log10(error / (UNIT * size)).max(0.0) };
    let off = |value: f64, exact: &Dd| (Dd::from(value) - *exact).to_f64();
    let lost = largest(&mut computed.iter().zip(&exact.components).map(|(value, exact)| off(*value, exact)));
    let correct = |found: Applied<f32>| {
        let values = found.components.iter().zip(&exact.components);
        let error = largest(&mut values.map(|(value, exact)| off(f64::from(*value), exact)));
        if error == 0.0 { 7.0 } else { -libm::log10(error / size) }
    };
    Ok(Rounding {
        lost: digits(lost),
        predicted: digits(largest(&mut bounded.components.iter().map(|x| x.error))),
        single: single.map(correct).filter(|digits| digits.is_finite()),
        condition_b: bounded.b.as_deref().map(condition),
        condition_b_hat: bounded.b_hat.as_deref().map(condition),
        exact: exact.components.iter().map(|x| x.to_f64()).collect(),
        computed,
    })
}

/// The value of an operator at particle `i`, as any other program of this crate computes it.
///
/// # Errors
/// [`RoundingError::Program`], [`RoundingError::Cloud`].
pub fn computed(
    operator: &Operator,
    kernel: &Kernel,
    cloud: &Cloud,
    i: usize,
    field: &[[f64; 3]],
) -> Result<Vec<f64>, RoundingError> {
    let program = Program::new(operator, kernel, cloud.dimension())?;
    Lists::of(&program, cloud, i)?.apply(&program, operator.field, cloud, field)
}

/// The neighbours of one particle, or of all where sums at its neighbours are taken.
struct Lists {
    of: Neighbours,
    /// The list of the particle that is looked at.
    at: usize,
}

impl Lists {
    fn of(program: &Program, cloud: &Cloud, i: usize) -> Result<Self, RoundingError> {
        Ok(match program.passes() {
            0 | 1 => Self { of: Neighbours::search_at(cloud, &[i])?, at: 0 },
            _ => Self { of: Neighbours::search(cloud)?, at: i },
        })
    }

    /// The list of a particle: of the one that is looked at, or of any if there are all.
    fn list(&self, p: usize) -> &[Neighbour] {
        self.of.of(if self.of.centre(self.at) == p { self.at } else { p })
    }

    fn apply(
        &self,
        program: &Program,
        kind: Field,
        cloud: &Cloud,
        field: &[[f64; 3]],
    ) -> Result<Vec<f64>, RoundingError> {
        let first: Vec<f64> = field.iter().map(|value| value[0]).collect();
        let fields = match kind {
            Field::Scalar => Fields::Scalar(&first),
            Field::Vector => Fields::Vector(field),
        };
        let values = program.apply(cloud, &self.of, fields)?;
        let count = program.components();
        Ok(values[self.at * count..(self.at + 1) * count].to_vec())
    }
}

fn on_ground<T: Number>(
    operator: &Operator,
    kernel: &Kernel,
    cloud: &Cloud,
    lists: &Lists,
    i: usize,
    number: impl Fn(f64) -> T,
    values: &dyn Fn(usize) -> Vec<T>,
) -> Result<Applied<T>, RoundingError> {
    let ground = Plain::new(kernel, cloud, lists, &number)?;
    Ok(value(operator, &ground, i, values)?)
}

/// κ in the spectral norm.
fn condition(rows: &[Vec<Bounded>]) -> f64 {
    let matrix = DMatrix::from_fn(rows.len(), rows.len(), |a, b| rows[a][b].value);
    let stretches = matrix.singular_values();
    stretches.max() / stretches.min()
}

/// G_k on one piece: coefficients in s = to − q, descending, and the power of 1/q.
struct Piece<T> {
    coefficients: Vec<T>,
    to: T,
    inverse_power: i32,
}

/// A cloud as it stands, each number made one of another kind. Not for clouds with periods that pairs reach across.
struct Plain<'a, T, N> {
    cloud: &'a Cloud,
    lists: &'a Lists,
    number: &'a N,
    /// Ends of the pieces, q = r/h.
    ends: Vec<f64>,
    /// By k, then by piece.
    functions: [Vec<Piece<T>>; 3],
    sigma: T,
    h: T,
    h_f64: f64,
}

impl<'a, T: Number, N: Fn(f64) -> T> Plain<'a, T, N> {
    fn new(
        kernel: &Kernel,
        cloud: &'a Cloud,
        lists: &'a Lists,
        number: &'a N,
    ) -> Result<Self, RoundingError> {
        let mut ends = Vec::new();
        let mut functions = [Vec::new(), Vec::new(), Vec::new()];
        for (k, own) in functions.iter_mut().enumerate() {
            let RadialFunction::Pieces(pieces) = kernel.radial_function(k) else {
                return Err(RoundingError::Kernel { kernel: kernel.id().to_owned() });
            };
            ends = pieces.iter().map(|piece| crate::exact::rational_to_f64(&piece.to)).collect();
            own.extend(pieces.into_iter().map(|piece| {
                let about_end = piece.numerator.compose(&Polynomial::new(vec![piece.to.clone(), -int(1)]));
                Piece {
                    coefficients: about_end.coefficients().iter().rev().map(T::from_rational).collect(),
                    to: T::from_rational(&piece.to),
                    inverse_power: piece.denominator_power as i32,
                }
            }));
        }
        let sigma: Rational = kernel.enclose_normalisation(cloud.dimension(), 160).midpoint();
        let h = number(cloud.support_of(0)) / T::from_rational(kernel.support_over_h());
        let h_f64 = cloud.support_of(0) / crate::exact::rational_to_f64(kernel.support_over_h());
        Ok(Self { cloud, lists, number, ends, functions, sigma: T::from_rational(&sigma), h, h_f64 })
    }
}

impl<T: Number, N: Fn(f64) -> T> Ground<T> for Plain<'_, T, N> {
    fn dimension(&self) -> usize {
        self.cloud.dimension()
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [T; 3])> {
        let (here, number) = (self.cloud.positions()[p], self.number);
        let apart = |j: usize| {
            let there = self.cloud.positions()[j];
            std::array::from_fn(|a| number(here[a]) - number(there[a]))
        };
        self.lists.list(p).iter().map(|pair| (pair.j as usize, apart(pair.j as usize))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<T, MissingQuantity> {
        let name = quantity.field_name();
        let found = match quantity {
            OfParticle::Volume => Some(self.cloud.volumes()[p]),
            _ => self.cloud.field(name).map(|values| values[p]),
        };
        found.map(self.number).ok_or(MissingQuantity { name })
    }

    fn smoothing_length(&self) -> T {
        self.h.clone()
    }

    fn kernel(&self, _p: usize, _q: usize, r: &[T; 3]) -> [T; 3] {
        let square = r.iter().fold(T::nought(), |sum, x| sum + x.clone() * x.clone());
        let distance = square.root().unwrap_or_else(T::nought);
        let piece = self.ends.iter().position(|end| distance.size() < end * self.h_f64);
        let Some(piece) = piece else { return [T::nought(), T::nought(), T::nought()] };
        let q = distance / self.h.clone();
        let mut scale =
            (0..self.cloud.dimension()).fold(self.sigma.clone(), |scale, _| scale / self.h.clone());
        std::array::from_fn(|k| {
            let Piece { coefficients, to, inverse_power } = &self.functions[k][piece];
            let s = to.clone() - q.clone();
            let sum = coefficients.iter().fold(T::nought(), |sum, c| sum * s.clone() + c.clone());
            // At the origin: what belongs to it vanishes by antisymmetry.
            let function = q.power(-inverse_power).map_or_else(T::nought, |inverse| sum * inverse);
            if k > 0 {
                scale = scale.clone() / (self.h.clone() * self.h.clone());
            }
            function * scale.clone()
        })
    }
}
