//! Tensor expressions over particles: sums of terms, each a product of factors under sums over neighbours.
//!
//! A term is flat: a rational coefficient, the particles it sums over, and factors that name particles and indices. An index
//! that stands twice is summed over; one that stands once is free. Nested and multiplied sums look alike,
//! Σ_j ω_j (Σ_k ω_k …) … is one term with the particles j and k, so that factors need not be moved in or out of sums.

use crate::exact::Rational;
use crate::language::tree::{Field, OfParticle};
use std::sync::Arc;

/// A particle of an expression. 0 is particle i.
pub(super) type Label = u16;
/// A tensor index.
pub(super) type Index = u16;

/// What a factor is.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Symbol {
    /// D.
    Dimension,
    /// π.
    Pi,
    /// h.
    SmoothingLength,
    /// V, ρ, m, μ of a particle.
    OfParticle(OfParticle),
    /// |r_pq|. To the power 0 it is 1, and 0 where p = q.
    Distance,
    /// W_pq.
    Kernel,
    /// W′_pq/|r_pq|, so that ∇W = (W′/r) r.
    Slope,
    /// ∇·∇W_pq.
    Laplacian,
    /// 1 / a scalar expression of the particles named.
    Reciprocal(Arc<Expression>),
    /// δ_ab.
    Delta,
    /// B_ab of a particle, symmetric.
    Renormalisation,
    /// B̂_ab of a particle, symmetric.
    RenormalisationHat,
    /// The inverse of an expression of two indices and the particles named.
    Inverse(Arc<Expression>),
    /// ∂_a∂_b W_pq, symmetric.
    Hessian,
    /// r_pq, from a particle to one of its neighbours: p is the centre of the sum over q.
    Separation,
    /// ∂…∂ u at particle i, symmetric; of v, its own index stands last.
    Derivative(Field),
    /// u or v at a particle.
    FieldAt(Field),
}

impl Symbol {
    /// How many of its indices, from the first on, may be exchanged.
    pub(super) fn exchangeable(&self, indices: usize) -> usize {
        match self {
            Self::Delta | Self::Renormalisation | Self::RenormalisationHat | Self::Hessian => indices,
            Self::Derivative(Field::Vector) => indices.saturating_sub(1),
            Self::Derivative(Field::Scalar) => indices,
            _ => 1,
        }
    }

    /// Whether p and q may be exchanged.
    pub(super) fn is_even(&self) -> bool {
        matches!(self, Self::Distance | Self::Kernel | Self::Slope | Self::Laplacian | Self::Hessian)
    }
}

/// One factor.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Factor {
    pub symbol: Symbol,
    pub particles: Vec<Label>,
    pub indices: Vec<Index>,
    /// 1 unless it is a scalar.
    pub power: i32,
}

/// A sum over the neighbours of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Bound {
    pub particle: Label,
    pub centre: Label,
}

/// One term.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Term {
    pub coefficient: Rational,
    pub bounds: Vec<Bound>,
    pub factors: Vec<Factor>,
}

/// A sum of terms with the same free indices, in order.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Expression {
    pub free: Vec<Index>,
    pub terms: Vec<Term>,
}

impl Factor {
    pub(super) fn new(symbol: Symbol, particles: &[Label], indices: &[Index]) -> Self {
        Self { symbol, particles: particles.to_vec(), indices: indices.to_vec(), power: 1 }
    }

    pub(super) fn raised(mut self, power: i32) -> Self {
        self.power = power;
        self
    }
}

impl Term {
    pub(super) fn new(coefficient: Rational, factors: Vec<Factor>) -> Self {
        Self { coefficient, bounds: Vec::new(), factors }
    }

    /// The product of two terms that share no bound particle and no summed index.
    pub(super) fn times(&self, other: &Self) -> Self {
        Self {
            coefficient: &self.coefficient * &other.coefficient,
            bounds: [self.bounds.as_slice(), &other.bounds].concat(),
            factors: [self.factors.as_slice(), &other.factors].concat(),
        }
    }

    pub(super) fn rename_index(&mut self, from: Index, to: Index) {
        for index in self.factors.iter_mut().flat_map(|factor| &mut factor.indices) {
            if *index == from {
                *index = to;
            }
        }
    }

    /// How often an index stands in the term.
    pub(super) fn count_index(&self, index: Index) -> usize {
        self.factors.iter().flat_map(|factor| &factor.indices).filter(|known| **known == index).count()
    }

    /// The factors that name a particle, by place.
    pub(super) fn naming(&self, particle: Label) -> Vec<usize> {
        let names = |factor: &Factor| factor.particles.contains(&particle);
        (0..self.factors.len()).filter(|place| names(&self.factors[*place])).collect()
    }

    /// The order of the derivative of the field in it.
    pub(super) fn order(&self) -> usize {
        let derivative = self.factors.iter().find_map(|factor| match factor.symbol {
            Symbol::Derivative(field) => Some(factor.indices.len() - usize::from(field == Field::Vector)),
            _ => None,
        });
        derivative.unwrap_or(0)
    }
}

impl Expression {
    pub(super) fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    pub(super) fn scalar(term: Term) -> Self {
        Self { free: Vec::new(), terms: vec![term] }
    }

    pub(super) fn map(mut self, mut change: impl FnMut(&mut Term)) -> Self {
        self.terms.iter_mut().for_each(&mut change);
        self
    }

    /// This with its free indices renamed; they must not stand in it already.
    pub(super) fn with_free(mut self, free: &[Index]) -> Self {
        for (from, to) in self.free.clone().into_iter().zip(free) {
            self.terms.iter_mut().for_each(|term| term.rename_index(from, *to));
        }
        self.free = free.to_vec();
        self
    }
}
