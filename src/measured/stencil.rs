//! An operator at one particle as a stencil, ⟨Lu⟩_i = Σ_j c_ij u_j, by walking its tree over real particles. Nothing is
//! expanded: this is what the expansion of `derived` is checked against.

use super::tensor::Tensor;
use crate::exact::{MultiIndex, Number, Rational, Solution, int, inverse, solve};
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::{Kind, Node, OfPair, Particle};
use crate::language::{Field, Operator};
use std::collections::HashMap;
use std::rc::Rc;
use thiserror::Error;

/// Why an operator has no stencil at a particle.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum StencilError {
    /// B or B̂ does not exist.
    #[error("{tensor} of particle {particle} is singular: {why}")]
    Singular {
        /// `B`, `B̂` or `inverse`.
        tensor: &'static str,
        /// The particle.
        particle: usize,
        /// What is wrong with its neighbours.
        why: Degeneracy,
    },
    /// The particles lack a quantity.
    #[error(transparent)]
    Missing(#[from] MissingQuantity),
    /// A divisor is zero, and not by the distance of a particle from itself.
    #[error("the divisor at bytes {} to {} is zero at particle {particle}: it has no neighbours that count", span.start + 1, span.end)]
    DividesByZero {
        /// The particle.
        particle: usize,
        /// Bytes of the divisor in the operator's text.
        span: std::ops::Range<usize>,
    },
    /// In exact arithmetic a distance or π has no value.
    #[error("{what} is no rational number here")]
    NotRational {
        /// What.
        what: &'static str,
    },
}

/// What is wrong with the neighbours of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Degeneracy {
    /// Fewer than the unknowns need.
    #[error("too few neighbours ({neighbours})")]
    TooFew {
        /// How many there are, the particle left out.
        neighbours: usize,
    },
    /// All on a line through the particle.
    #[error("its neighbours lie on a line")]
    OnALine,
    /// All in a plane through the particle.
    #[error("its neighbours lie in a plane")]
    InAPlane,
    /// Enough of them, and the equations still have no or no single solution.
    #[error("its neighbours leave the equations without a solution (rank {rank})")]
    Unsolvable {
        /// The rank of the equations.
        rank: usize,
    },
}

/// An operator reduced to weights at one particle.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencil<T> {
    /// D.
    pub dimension: usize,
    /// Rank of the value.
    pub rank: u8,
    /// The field it acts on.
    pub field: Field,
    /// What multiplies the field at each particle; a particle met twice stands twice.
    pub entries: Vec<StencilEntry<T>>,
    /// Particles whose B̂ is not determined by its equations; the solution of least norm was taken.
    pub least_norm: Vec<usize>,
}

/// One particle of a stencil.
#[derive(Debug, Clone, PartialEq)]
pub struct StencilEntry<T> {
    /// The particle.
    pub particle: usize,
    /// r_j − r_i, through the images it was reached by.
    pub displacement: [T; 3],
    /// By component of the field: the value's components, the first index slowest.
    pub weights: Vec<Vec<T>>,
}

/// The stencil of an operator at particle `i` of a ground.
///
/// # Errors
/// [`StencilError`].
pub fn stencil<T: Number>(
    operator: &Operator,
    ground: &dyn Ground<T>,
    i: usize,
) -> Result<Stencil<T>, StencilError> {
    let mut walk = Walk::new(operator, ground, i);
    let Value::Linear(terms) = walk.value(&operator.root)? else {
        unreachable!("the parser has checked that operators are linear")
    };
    let entries = terms.into_iter().map(|term| StencilEntry {
        particle: term.particle,
        displacement: term.place,
        weights: term.parts.into_iter().map(|part| part.values.to_vec()).collect(),
    });
    Ok(Stencil {
        dimension: walk.dimension,
        rank: operator.rank(),
        field: operator.field,
        entries: entries.collect(),
        least_norm: walk.least_norm,
    })
}

/// An operator's value at particle i on a field given at each particle, taken as it is written, by component; and the B and B̂
/// of particle i, where the operator has them.
pub(super) fn value<T: Number>(
    operator: &Operator,
    ground: &dyn Ground<T>,
    i: usize,
    field: &dyn Fn(usize) -> Vec<T>,
) -> Result<Applied<T>, StencilError> {
    let mut walk = Walk::new(operator, ground, i);
    walk.instead = Instead::Values(field);
    let Value::Linear(terms) = walk.value(&operator.root)? else {
        unreachable!("the parser has checked that operators are linear")
    };
    let components = terms.into_iter().flat_map(|term| term.parts).flat_map(|part| part.values.to_vec());
    let rows = |tensors: &HashMap<usize, Tensor<T>>| tensors.get(&i).map(Tensor::rows);
    Ok(Applied { components: components.collect(), b: rows(&walk.b), b_hat: rows(&walk.b_hat) })
}

/// What [`value`] finds.
pub(super) struct Applied<T> {
    pub(super) components: Vec<T>,
    pub(super) b: Option<Vec<Vec<T>>>,
    pub(super) b_hat: Option<Vec<Vec<T>>>,
}

/// An operator applied to monomials about particle i: its moments, without a stencil. What does not depend on the
/// neighbour is taken once for all of them, so that an operator inside another costs one pass more and not one for each.
pub(super) struct Moments<'a, T> {
    walk: Walk<'a, T>,
    operator: &'a Operator,
}

impl<'a, T: Number> Moments<'a, T> {
    pub(super) fn new(operator: &'a Operator, ground: &'a dyn Ground<T>, i: usize) -> Self {
        Self { walk: Walk::new(operator, ground, i), operator }
    }

    /// For each α: Σ_j c_ij (r_j − r_i)^α / α!, by component of the field, then of the value. And the sum of the terms'
    /// magnitudes.
    pub(super) fn of(&mut self, all: &[MultiIndex]) -> Result<(Vec<Vec<T>>, f64), StencilError> {
        self.walk.magnitude = 0.0;
        self.walk.instead = Instead::Monomials(all.to_vec());
        self.walk.kept.clear();
        let Value::Linear(terms) = self.walk.value(&self.operator.root)? else {
            unreachable!("the parser has checked that operators are linear")
        };
        let parts = terms.into_iter().flat_map(|term| term.parts).map(|part| part.values.to_vec());
        Ok((parts.collect(), self.walk.magnitude))
    }
}

impl<T: Number> Stencil<T> {
    /// Σ_j c_ij (r_j − r_i)^α / α!, by component of the field, then by component of the value: what multiplies ∂_α u.
    pub fn moment(&self, alpha: &MultiIndex) -> Vec<Vec<T>> {
        let factorial = Rational::from_integer(alpha.factorial().into());
        let inverse = T::from_rational(&(int(1) / factorial));
        self.sum_over(|entry| monomial(&entry.displacement, alpha) * inverse.clone())
    }

    /// The same with the magnitude of every term: what rounding errors are relative to.
    pub fn magnitude(&self, order: u8) -> f64 {
        let size = |entry: &StencilEntry<T>| {
            let distance = entry.displacement.iter().map(|x| x.size() * x.size()).sum::<f64>().sqrt();
            let weight = entry.weights.iter().flatten().map(T::size).fold(0.0, f64::max);
            weight * distance.powi(i32::from(order))
        };
        self.entries.iter().map(size).sum()
    }

    /// The value at particle i for a field given at each particle, by component.
    pub fn apply(&self, field: impl Fn(usize) -> Vec<T>) -> Vec<T> {
        let mut value: Vec<T> = Vec::new();
        for entry in &self.entries {
            let u = field(entry.particle);
            for (weights, u) in entry.weights.iter().zip(u) {
                value.resize(weights.len(), T::nought());
                for (sum, weight) in value.iter_mut().zip(weights) {
                    *sum = sum.clone() + weight.clone() * u.clone();
                }
            }
        }
        value
    }

    fn sum_over(&self, factor: impl Fn(&StencilEntry<T>) -> T) -> Vec<Vec<T>> {
        let components = if self.field == Field::Vector { self.dimension } else { 1 };
        let size = self.dimension.pow(u32::from(self.rank));
        let mut sums = vec![vec![T::nought(); size]; components];
        for entry in &self.entries {
            let factor = factor(entry);
            for (sum, weights) in sums.iter_mut().zip(&entry.weights) {
                for (sum, weight) in sum.iter_mut().zip(weights) {
                    *sum = sum.clone() + weight.clone() * factor.clone();
                }
            }
        }
        sums
    }
}

fn monomial<T: Number>(x: &[T; 3], alpha: &MultiIndex) -> T {
    let mut product = T::from_rational(&int(1));
    for (x, power) in x.iter().zip(alpha.powers) {
        for _ in 0..power {
            product = product * x.clone();
        }
    }
    product
}

/// In place of a particle: the field was a monomial there, and its value is in the part.
const APPLIED: usize = usize::MAX;

/// A tensor, or a tensor linear in the field.
#[derive(Clone)]
enum Value<T> {
    Free(Tensor<T>),
    Linear(Vec<Term<T>>),
}

/// The part of a linear value that multiplies the field at one particle, or what it gives for monomials.
#[derive(Clone)]
struct Term<T> {
    particle: usize,
    /// r_j − r_i.
    place: [T; 3],
    /// By component of the field; by monomial first, if it was applied to several.
    parts: Vec<Tensor<T>>,
}

impl<T: Number> Value<T> {
    /// Each tensor in it, changed.
    fn map(self, change: impl Fn(Tensor<T>) -> Tensor<T>) -> Self {
        match self {
            Self::Free(tensor) => Self::Free(change(tensor)),
            Self::Linear(mut terms) => {
                for term in &mut terms {
                    term.parts = std::mem::take(&mut term.parts).into_iter().map(&change).collect();
                }
                Self::Linear(terms)
            }
        }
    }
}

/// What stands in place of the field.
enum Instead<'a, T> {
    /// Nothing: it is left open.
    Open,
    /// Monomials about particle i, each in each component.
    Monomials(Vec<MultiIndex>),
    /// Its values: by component, at each particle.
    Values(&'a dyn Fn(usize) -> Vec<T>),
}

/// The neighbours of a particle with their separations.
type List<T> = Rc<[(usize, [T; 3])]>;

struct Walk<'a, T> {
    ground: &'a dyn Ground<T>,
    dimension: usize,
    field: Field,
    /// By particle of the operator: the particle of the ground, and r_p − r_i.
    bound: Vec<Option<(usize, [T; 3])>>,
    b: HashMap<usize, Tensor<T>>,
    b_hat: HashMap<usize, Tensor<T>>,
    neighbours: HashMap<usize, List<T>>,
    least_norm: Vec<usize>,
    /// What stands in place of the field.
    instead: Instead<'a, T>,
    /// Sums that depend on particle i alone, by the place of their node.
    kept: HashMap<*const Node, Value<T>>,
    /// With a monomial: the largest sum of magnitudes of any sum over the field.
    magnitude: f64,
}

impl<'a, T: Number> Walk<'a, T> {
    fn new(operator: &Operator, ground: &'a dyn Ground<T>, i: usize) -> Self {
        let mut walk = Walk {
            ground,
            dimension: ground.dimension(),
            field: operator.field,
            bound: vec![None; operator.particles.len()],
            b: HashMap::new(),
            b_hat: HashMap::new(),
            neighbours: HashMap::new(),
            least_norm: Vec::new(),
            instead: Instead::Open,
            kept: HashMap::new(),
            magnitude: 0.0,
        };
        walk.bound[0] = Some((i, [T::nought(), T::nought(), T::nought()]));
        walk
    }

    fn bound(&self, p: Particle) -> (usize, [T; 3]) {
        self.bound[p].clone().unwrap_or_else(|| unreachable!("the parser binds every index"))
    }

    fn free(&mut self, node: &Node) -> Result<Tensor<T>, StencilError> {
        match self.value(node)? {
            Value::Free(tensor) => Ok(tensor),
            Value::Linear(_) => unreachable!("the parser has checked what is linear"),
        }
    }

    fn value(&mut self, node: &Node) -> Result<Value<T>, StencilError> {
        let d = self.dimension;
        let scalar = |value: T| Ok(Value::Free(Tensor::scalar(d, value)));
        match &node.kind {
            Kind::Number(value) => scalar(T::from_rational(value)),
            Kind::Pi => scalar(T::pi().ok_or(StencilError::NotRational { what: "π" })?),
            Kind::Dimension => scalar(T::from_rational(&int(d as i64))),
            Kind::SmoothingLength => scalar(self.ground.smoothing_length()),
            Kind::Identity => Ok(Value::Free(Tensor::unit(d))),
            Kind::OfParticle(quantity, p) => scalar(self.ground.of_particle(*quantity, self.bound(*p).0)?),
            Kind::Renormalisation(p) => Ok(Value::Free(self.renormalisation(self.bound(*p).0)?)),
            Kind::RenormalisationHat(p) => Ok(Value::Free(self.renormalisation_hat(self.bound(*p).0)?)),
            Kind::OfPair(quantity, p, q) => Ok(Value::Free(self.pair(*quantity, *p, *q)?)),
            Kind::Field(p) => Ok(Value::Linear(vec![match &self.instead {
                Instead::Open => self.field(*p),
                Instead::Monomials(all) => self.monomials_at(*p, all),
                Instead::Values(values) => self.value_at(*p, *values),
            }])),
            Kind::Add(nodes) => {
                let mut values = nodes.iter().map(|node| self.value(node));
                let first = values.next().unwrap_or_else(|| unreachable!("a sum has terms"))?;
                values.try_fold(first, |sum, value| Ok(add(sum, value?)))
            }
            Kind::Negate(a) => Ok(self.value(a)?.map(|tensor| tensor.negated())),
            Kind::Outer(a, b) => self.product(a, b, 0),
            Kind::Contract(a, b, count) => self.product(a, b, usize::from(*count)),
            Kind::Divide(a, b) => {
                let divisor = self.free(b)?.into_scalar();
                let inverse = self.reciprocal(b, &divisor, 1)?;
                Ok(self.value(a)?.map(|tensor| tensor.scaled(&inverse)))
            }
            Kind::Power(a, n) => {
                let base = self.free(a)?.into_scalar();
                match n {
                    0.. => scalar(base.power(*n).unwrap_or_else(|| unreachable!("not negative"))),
                    _ => scalar(self.reciprocal(a, &base, -n)?),
                }
            }
            Kind::Inverse(a) => {
                let tensor = self.free(a)?;
                let particle = self.bound(0).0;
                let rows = inverse(&tensor.rows()).map_err(|rank| StencilError::Singular {
                    tensor: "inverse",
                    particle,
                    why: self.degeneracy(particle, rank, d),
                })?;
                Ok(Value::Free(Tensor::from_rows(d, rows)))
            }
            Kind::Sum { bound, centre, body } if self.is_applied() && of_centre_alone(node) => {
                if let Some(known) = self.kept.get(&std::ptr::from_ref(node)) {
                    return Ok(known.clone());
                }
                let value = self.sum(*bound, *centre, body, node)?;
                self.kept.insert(std::ptr::from_ref(node), value.clone());
                Ok(value)
            }
            Kind::Sum { bound, centre, body } => self.sum(*bound, *centre, body, node),
        }
    }

    fn sum(
        &mut self,
        bound: Particle,
        centre: Particle,
        body: &Node,
        node: &Node,
    ) -> Result<Value<T>, StencilError> {
        let (particle, place) = self.bound(centre);
        let d = self.dimension;
        let mut total = match node.linear {
            true => Value::Linear(Vec::new()),
            false => Value::Free(Tensor::zero(d, usize::from(node.rank))),
        };
        let mut magnitude = 0.0;
        for (neighbour, r) in self.list(particle).iter() {
            let there = std::array::from_fn(|a| place[a].clone() - r[a].clone());
            self.bound[bound] = Some((*neighbour, there));
            let value = self.value(body)?;
            if let (true, Value::Linear(terms)) = (self.is_applied(), &value) {
                let parts = terms.iter().flat_map(|term| &term.parts).flat_map(|part| part.values.iter());
                magnitude += parts.map(T::size).fold(0.0, f64::max);
            }
            total = add(total, value);
        }
        self.magnitude = self.magnitude.max(magnitude);
        self.bound[bound] = None;
        Ok(total)
    }

    fn list(&mut self, particle: usize) -> List<T> {
        self.neighbours.entry(particle).or_insert_with(|| self.ground.neighbours(particle).into()).clone()
    }

    fn is_applied(&self) -> bool {
        !matches!(self.instead, Instead::Open)
    }

    fn value_at(&self, p: Particle, values: &dyn Fn(usize) -> Vec<T>) -> Term<T> {
        let (particle, place) = self.bound(p);
        let mut values = values(particle);
        values.resize(3, T::nought());
        let part = match self.field {
            Field::Scalar => Tensor::scalar(self.dimension, values[0].clone()),
            Field::Vector => Tensor::vector(self.dimension, &std::array::from_fn(|a| values[a].clone())),
        };
        Term { particle: APPLIED, place, parts: vec![part] }
    }

    fn monomials_at(&self, p: Particle, all: &[MultiIndex]) -> Term<T> {
        let (_, place) = self.bound(p);
        let mut parts = Vec::with_capacity(3 * all.len());
        for alpha in all {
            let factorial: i64 =
                alpha.powers.iter().map(|power| (1..=i64::from(*power)).product::<i64>()).product();
            let value = monomial(&place, alpha) / T::from_rational(&int(factorial));
            parts.extend(self.field(p).parts.into_iter().map(|unit| unit.scaled(&value)));
        }
        Term { particle: APPLIED, place, parts }
    }

    /// 1/x^n. What divides by the distance of a particle from itself is left out of its sum: zero.
    fn reciprocal(&self, node: &Node, value: &T, n: i32) -> Result<T, StencilError> {
        if let Some(inverse) = value.power(-n) {
            return Ok(inverse);
        }
        let met = |kind: &Kind| matches!(kind, Kind::OfPair(_, p, q) if self.separation(*p, *q).iter().all(T::is_nought));
        if node.any(&met) && !node.any(&|kind| matches!(kind, Kind::Sum { .. })) {
            return Ok(T::nought());
        }
        Err(StencilError::DividesByZero { particle: self.bound(0).0, span: node.span.clone() })
    }

    fn separation(&self, p: Particle, q: Particle) -> [T; 3] {
        match (&self.bound[p], &self.bound[q]) {
            (Some((_, p)), Some((_, q))) => std::array::from_fn(|a| p[a].clone() - q[a].clone()),
            _ => std::array::from_fn(|_| T::from_rational(&int(1))),
        }
    }

    fn pair(&self, quantity: OfPair, p: Particle, q: Particle) -> Result<Tensor<T>, StencilError> {
        let d = self.dimension;
        let r = self.separation(p, q);
        let square = r.iter().fold(T::nought(), |sum, x| sum + x.clone() * x.clone());
        let distance = || square.root().ok_or(StencilError::NotRational { what: "a distance" });
        let vector = Tensor::vector(d, &r);
        let [g0, g1, g2] = self.ground.kernel(self.bound(p).0, self.bound(q).0, &r);
        Ok(match quantity {
            OfPair::Separation => vector,
            OfPair::Distance => Tensor::scalar(d, distance()?),
            OfPair::Direction => match distance()?.power(-1) {
                Some(inverse) => vector.scaled(&inverse),
                None => vector,
            },
            OfPair::Kernel => Tensor::scalar(d, g0),
            OfPair::Gradient => vector.scaled(&g1),
            OfPair::Hessian => vector.outer(&vector).scaled(&g2).plus(&Tensor::unit(d).scaled(&g1)),
            OfPair::Laplacian => {
                let dimension = T::from_rational(&int(d as i64));
                Tensor::scalar(d, dimension * g1 + square * g2)
            }
        })
    }

    fn field(&self, p: Particle) -> Term<T> {
        let (particle, place) = self.bound(p);
        let one = T::from_rational(&int(1));
        let parts = match self.field {
            Field::Scalar => vec![Tensor::scalar(self.dimension, one)],
            Field::Vector => {
                let unit = |c: usize| std::array::from_fn(|a| if a == c { one.clone() } else { T::nought() });
                (0..self.dimension).map(|c| Tensor::vector(self.dimension, &unit(c))).collect()
            }
        };
        Term { particle, place, parts }
    }

    fn product(&mut self, a: &Node, b: &Node, count: usize) -> Result<Value<T>, StencilError> {
        if a.linear {
            let right = self.free(b)?;
            return Ok(self.value(a)?.map(|left| left.contract(&right, count)));
        }
        let left = self.free(a)?;
        Ok(self.value(b)?.map(|right| left.contract(&right, count)))
    }

    /// Σ over the neighbours of `particle` of a tensor made of ω, r and the kernel.
    fn moment(
        &mut self,
        particle: usize,
        rank: usize,
        summand: impl Fn(&Tensor<T>, [T; 3], T) -> Option<Tensor<T>>,
    ) -> Result<Tensor<T>, StencilError> {
        let d = self.dimension;
        let mut sum = Tensor::zero(d, rank);
        for (neighbour, r) in self.list(particle).iter() {
            let neighbour = *neighbour;
            let volume = self.ground.of_particle(crate::language::tree::OfParticle::Volume, neighbour)?;
            let kernel = self.ground.kernel(particle, neighbour, r);
            let square = r.iter().fold(T::nought(), |sum, x| sum + x.clone() * x.clone());
            if let Some(term) = summand(&Tensor::vector(d, r), kernel, square) {
                sum = sum.plus(&term.scaled(&volume));
            }
        }
        Ok(sum)
    }

    /// B = −[Σ ω r ∇W]⁻¹ (Fatehi & Manzari 2011, Eq. 6).
    fn renormalisation(&mut self, particle: usize) -> Result<Tensor<T>, StencilError> {
        if let Some(known) = self.b.get(&particle) {
            return Ok(known.clone());
        }
        let sum = self.moment(particle, 2, |r, [_, g1, _], _| Some(r.outer(r).scaled(&-g1)))?;
        let rows = inverse(&sum.rows()).map_err(|rank| StencilError::Singular {
            tensor: "B",
            particle,
            why: self.degeneracy(particle, rank, self.dimension),
        })?;
        let b = Tensor::from_rows(self.dimension, rows);
        self.b.insert(particle, b.clone());
        Ok(b)
    }

    /// B̂ : [Σ ω r e e ∇W + (Σ ω e e ∇W) · B · (Σ ω r r ∇W)] = −I (Eq. 40), for the symmetric B̂.
    fn renormalisation_hat(&mut self, particle: usize) -> Result<Tensor<T>, StencilError> {
        if let Some(known) = self.b_hat.get(&particle) {
            return Ok(known.clone());
        }
        let d = self.dimension;
        let b = self.renormalisation(particle)?;
        // e e ∇W = (W′/r) r r r / r².
        let over_square = |g1: T, square: T| square.power(-1).map(|inverse| g1 * inverse);
        let fourth = self.moment(particle, 4, |r, [_, g1, _], square| {
            let factor = over_square(g1, square)?;
            Some(r.outer(r).outer(r).outer(r).scaled(&factor))
        })?;
        let eegrad = self.moment(particle, 3, |r, [_, g1, _], square| {
            let factor = over_square(g1, square)?;
            Some(r.outer(r).outer(r).scaled(&factor))
        })?;
        let rrgrad = self.moment(particle, 3, |r, [_, g1, _], _| Some(r.outer(r).outer(r).scaled(&g1)))?;
        // K_{ab,ef}; Σ ω r r ∇W is symmetric, so it does not matter which of its indices meets B.
        let mut tensor = fourth.plus(&eegrad.contract(&b, 1).contract(&rrgrad, 1));
        // Where the two parts cancel, what is left is their rounding: nothing.
        let largest = |tensor: &Tensor<T>| tensor.values.iter().map(T::size).fold(0.0, f64::max);
        if largest(&tensor) <= T::SINGULAR * largest(&fourth) {
            tensor = Tensor::zero(d, 4);
        }
        let pairs: Vec<(usize, usize)> = (0..d).flat_map(|a| (a..d).map(move |b| (a, b))).collect();
        let (one, two) = (T::from_rational(&int(1)), T::from_rational(&int(2)));
        // Off-diagonal unknowns stand twice in the contraction.
        let weights: Vec<T> =
            pairs.iter().map(|(a, b)| if a == b { one.clone() } else { two.clone() }).collect();
        let row = |(e, f): &(usize, usize)| {
            let unknowns = pairs.iter().zip(&weights);
            unknowns.map(|((a, b), weight)| tensor.at(&[*a, *b, *e, *f]) * weight.clone()).collect()
        };
        let matrix: Vec<Vec<T>> = pairs.iter().map(row).collect();
        let right: Vec<T> =
            pairs.iter().map(|(e, f)| if e == f { -one.clone() } else { T::nought() }).collect();
        let solution = match solve(&matrix, &right, &weights) {
            Solution::One(solution) => solution,
            Solution::Least { solution, .. } => {
                self.least_norm.push(particle);
                solution
            }
            Solution::None { rank } => {
                let why = self.degeneracy(particle, rank, pairs.len());
                return Err(StencilError::Singular { tensor: "B̂", particle, why });
            }
        };
        let mut b_hat = Tensor::zero(d, 2);
        for ((a, b), value) in pairs.iter().zip(solution) {
            b_hat.set(&[*a, *b], value.clone());
            b_hat.set(&[*b, *a], value);
        }
        self.b_hat.insert(particle, b_hat.clone());
        Ok(b_hat)
    }

    fn degeneracy(&self, particle: usize, rank: usize, unknowns: usize) -> Degeneracy {
        let list = self.ground.neighbours(particle);
        let others: Vec<Vec<T>> =
            list.iter().map(|(_, r)| r.to_vec()).filter(|r| !r.iter().all(T::is_nought)).collect();
        // The rank of Σ r r, row by row, is the number of directions that the neighbours span.
        let gram: Vec<Vec<T>> = (0..3)
            .map(|a| {
                let product =
                    |b: usize| others.iter().fold(T::nought(), |sum, r| sum + r[a].clone() * r[b].clone());
                (0..3).map(product).collect()
            })
            .collect();
        let spanned = match solve(
            &gram,
            &[T::nought(), T::nought(), T::nought()],
            &[T::from_rational(&int(1)), T::from_rational(&int(1)), T::from_rational(&int(1))],
        ) {
            Solution::One(_) => 3,
            Solution::Least { rank, .. } | Solution::None { rank } => rank,
        };
        match spanned {
            _ if others.len() < unknowns.min(self.dimension) => {
                Degeneracy::TooFew { neighbours: others.len() }
            }
            1 if self.dimension > 1 => Degeneracy::OnALine,
            2 if self.dimension > 2 => Degeneracy::InAPlane,
            _ if others.len() < unknowns => Degeneracy::TooFew { neighbours: others.len() },
            _ => Degeneracy::Unsolvable { rank },
        }
    }
}

/// Whether a sum depends on particle i and on what it binds itself, and on nothing else.
fn of_centre_alone(node: &Node) -> bool {
    fn free_of_others(node: &Node, own: &mut Vec<Particle>) -> bool {
        let known = |p: &Particle| *p == 0 || own.contains(p);
        let named = match &node.kind {
            Kind::Field(p)
            | Kind::OfParticle(_, p)
            | Kind::Renormalisation(p)
            | Kind::RenormalisationHat(p) => known(p),
            Kind::OfPair(_, p, q) => known(p) && known(q),
            Kind::Sum { bound, centre, .. } => {
                let known = known(centre);
                own.push(*bound);
                known
            }
            _ => true,
        };
        named && node.children().into_iter().all(|child| free_of_others(child, own))
    }
    free_of_others(node, &mut Vec::new())
}

fn add<T: Number>(a: Value<T>, b: Value<T>) -> Value<T> {
    match (a, b) {
        (Value::Free(a), Value::Free(b)) => Value::Free(a.plus(&b)),
        // What was applied to monomials is added up; the parts of a stencil stand side by side.
        (Value::Linear(mut a), Value::Linear(b)) => {
            for term in b {
                match a.iter_mut().find(|known| term.particle == APPLIED && known.particle == APPLIED) {
                    Some(known) => {
                        for (sum, part) in known.parts.iter_mut().zip(&term.parts) {
                            *sum = sum.plus(part);
                        }
                    }
                    None => a.push(term),
                }
            }
            Value::Linear(a)
        }
        _ => unreachable!("the parser has checked what is linear"),
    }
}
