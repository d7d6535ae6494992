//! Which totals an operator conserves.
//!
//! Particle j gives particle i what stands under the sum, times the weight of i (V_i, or m_i where the operator is an
//! acceleration). Σ_i of it vanishes for every field if the exchange is antisymmetric, f_ij = −f_ji; the sum of r_i × f_i
//! vanishes too if f_ij is parallel to r_ij.

use super::DeriveError;
use super::algebra::{Expression, Factor, Label, Symbol, Term};
use super::build::{Substitute, build};
use super::normal::{difference, normalised_with};
use crate::exact::int;
use crate::language::tree::OfParticle;
use crate::language::{Field, Operator};
use std::sync::Arc;

/// Whether a total is conserved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conserved {
    /// Exactly, whatever the field and the arrangement.
    Yes,
    /// The exchange of two particles is not of that form.
    No,
    /// The value is no force, so the question has no meaning.
    DoesNotApply,
}

/// What an operator conserves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Conservation {
    /// Σ_i V_i ⟨Lu⟩_i = 0: linear momentum where the value is a force, heat where it is a source.
    pub total: Conserved,
    /// Σ_i V_i r_i × ⟨Lu⟩_i = 0.
    pub angular: Conserved,
}

impl Conservation {
    /// Decides it from the operator's pair term.
    ///
    /// # Errors
    /// [`DeriveError`].
    pub fn of(operator: &Operator) -> Result<Self, DeriveError> {
        let acts_as_force = operator.rank() == 1;
        let no = |angular| Self { total: Conserved::No, angular };
        let angular_no = if acts_as_force { Conserved::No } else { Conserved::DoesNotApply };
        let units = operator.root.units;
        if operator.rank() > 1
            || units.length == 0
            || (operator.field == Field::Vector && operator.rank() == 0)
        {
            return Ok(Self { total: Conserved::DoesNotApply, angular: Conserved::DoesNotApply });
        }
        let weight = match units.mass {
            0 => OfParticle::Volume,
            -1 => OfParticle::Mass,
            _ => return Ok(Self { total: Conserved::DoesNotApply, angular: Conserved::DoesNotApply }),
        };
        let expression = build(operator, Substitute::Itself)?;
        // A field at i alone, under no sum, is no exchange; neither is what goes through a third particle.
        let is_pair = |term: &Term| matches!(&term.bounds[..], [bound] if bound.centre == 0);
        if !expression.terms.iter().all(is_pair) {
            return Ok(no(angular_no));
        }
        // f_ij with j as particle 1 and no sum; f_ji with the two exchanged.
        let (one, two): (Label, Label) = (1, 2);
        let opened = |first: Label, second: Label| {
            let terms = expression.terms.iter().map(|term| {
                let mut term = term.clone();
                let j = term.bounds[0].particle;
                term.bounds.clear();
                let mut sign = 1;
                for factor in &mut term.factors {
                    for label in &mut factor.particles {
                        *label = if *label == j { second } else { first };
                    }
                    if factor.symbol == Symbol::Separation && factor.particles[0] > factor.particles[1] {
                        factor.particles.reverse();
                        sign = -sign;
                    }
                }
                for factor in &mut term.factors {
                    sort_particles(factor)?;
                }
                term.coefficient *= int(sign);
                term.factors.push(Factor::new(Symbol::OfParticle(weight), &[first], &[]));
                Ok(term)
            });
            let terms = terms.collect::<Result<_, DeriveError>>()?;
            Ok::<_, DeriveError>(Expression { free: expression.free.clone(), terms })
        };
        let (here, there) = (opened(one, two)?, opened(two, one)?);
        let there = there.map(|term| term.coefficient *= int(-1));
        let here = normalised_with(here, 3)?;
        if !difference(&here, &normalised_with(there, 3)?)?.is_zero() {
            return Ok(no(angular_no));
        }
        let along = |term: &Term| {
            let free = expression.free.first();
            term.factors
                .iter()
                .any(|factor| factor.symbol == Symbol::Separation && factor.indices.first() == free)
        };
        let angular = match (acts_as_force, here.terms.iter().all(along)) {
            (false, _) => Conserved::DoesNotApply,
            (true, true) => Conserved::Yes,
            (true, false) => Conserved::No,
        };
        Ok(Self { total: Conserved::Yes, angular })
    }
}

/// The particles of 1/x(p, q) in rising order, x changed to match: 1/(ρ_p + ρ_q) is one thing.
fn sort_particles(factor: &mut Factor) -> Result<(), DeriveError> {
    let (Symbol::Reciprocal(body) | Symbol::Inverse(body)) = &factor.symbol else { return Ok(()) };
    let mut order: Vec<usize> = (0..factor.particles.len()).collect();
    order.sort_by_key(|place| factor.particles[*place]);
    let outer = order.len();
    let rename = |label: &mut Label| {
        if let Some(place) = order.iter().position(|old| *old == usize::from(*label)) {
            *label = place as Label;
        }
    };
    let body = (**body).clone().map(|term| {
        term.bounds.iter_mut().for_each(|bound| rename(&mut bound.centre));
        term.factors.iter_mut().flat_map(|factor| &mut factor.particles).for_each(rename);
    });
    let body = Arc::new(normalised_with(body, outer as Label)?);
    factor.symbol = match factor.symbol {
        Symbol::Inverse(_) => Symbol::Inverse(body),
        _ => Symbol::Reciprocal(body),
    };
    factor.particles.sort_unstable();
    Ok(())
}
