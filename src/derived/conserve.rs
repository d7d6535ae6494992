//! Which totals an operator conserves.
//!
//! Σ_i w_i ⟨Lu⟩_i, w_i the volume (or the mass, where the operator is an acceleration), is a sum over all pairs, and over all
//! triples where sums are nested. Sorted by the particle p whose field stands in it, it is Σ_p u_p (…)_p: what multiplies u_p
//! must vanish identically. So it does where what two particles exchange is antisymmetric, f_ij = −f_ji. The total of
//! r_i × ⟨Lu⟩_i then vanishes too if what multiplies u_p in Σ_i w_i (r_i − r_p) ⊗ ⟨Lu⟩_i is symmetric: where f_ij is parallel to
//! r_ij, but also for the symmetrised renormalised gradient, by B_p · Σ ω r ∇W = −I (Bonet & Lok 1999).
//!
//! Particles are neighbours of each other: the support is one.

use super::DeriveError;
use super::algebra::{Bound, Expression, Factor, Index, Label, Symbol, Term};
use super::build::{Substitute, build};
use super::normal::{difference, normalised, normalised_with};
use crate::exact::int;
use crate::language::tree::OfParticle;
use crate::language::{Field, Operator};
use std::sync::Arc;

/// Whether a total is conserved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conserved {
    /// Exactly, whatever the field and the arrangement.
    Yes,
    /// What would have to vanish does not, as far as its normal form knows.
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
    /// Decides it from what multiplies the field of each particle.
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
        let by_field = |term: &Term| by_field(term, weight);
        let terms: Vec<Sorted> = expression.terms.iter().map(by_field).collect::<Result<_, _>>()?;
        let of_terms = |free: Vec<Index>, terms| normalised(Expression { free, terms });
        let total =
            of_terms(expression.free.clone(), terms.iter().map(|sorted| sorted.term.clone()).collect())?;
        if !total.is_zero() {
            return Ok(no(angular_no));
        }
        let [b] = expression.free[..] else {
            return Ok(Self { total: Conserved::Yes, angular: Conserved::DoesNotApply });
        };
        let used =
            expression.terms.iter().flat_map(|term| term.factors.iter().flat_map(|factor| &factor.indices));
        let a = used.copied().max().unwrap_or(0) + 1;
        // (r_i − r_p)_a, one step of the way after the other; both signs turn.
        let with_steps = terms.iter().flat_map(|sorted| {
            sorted.way.iter().map(|step| {
                let mut term = sorted.term.clone();
                term.factors.push(Factor::new(Symbol::Separation, &[step.centre, step.particle], &[a]));
                term
            })
        });
        let with_steps: Vec<Term> = with_steps.collect();
        let tensor = of_terms(vec![a, b], with_steps.clone())?;
        let transposed = of_terms(vec![b, a], with_steps)?;
        let angular = match difference(&tensor, &transposed)?.is_zero() {
            true => Conserved::Yes,
            false => Conserved::No,
        };
        Ok(Self { total: Conserved::Yes, angular })
    }
}

/// A term with the particle of its field as particle 0.
struct Sorted {
    term: Term,
    /// The sums that lead from that particle to i.
    way: Vec<Bound>,
}

/// A term of w_i ⟨Lu⟩_i summed over i, with its sums turned round so that they start from the particle of the field.
fn by_field(term: &Term, weight: OfParticle) -> Result<Sorted, DeriveError> {
    let mut term = term.clone();
    term.factors.push(Factor::new(Symbol::OfParticle(weight), &[0], &[]));
    let fields = term.factors.iter().filter(|factor| matches!(factor.symbol, Symbol::FieldAt(_)));
    let field: Label = fields.map(|factor| factor.particles[0]).next().unwrap_or(0);
    let mut way = Vec::new();
    let mut at = field;
    while let Some(place) = term.bounds.iter().position(|bound| bound.particle == at) {
        let Bound { particle, centre } = term.bounds.remove(place);
        way.push(Bound { particle: centre, centre: particle });
        at = centre;
    }
    for factor in term.factors.iter_mut().filter(|factor| factor.symbol == Symbol::Separation) {
        if way.iter().any(|step| factor.particles == [step.particle, step.centre]) {
            factor.particles.reverse();
            term.coefficient *= int(-1);
        }
    }
    term.bounds.splice(0..0, way.iter().copied());
    // The two ends exchange their names.
    let exchange = |label: &mut Label| {
        *label = match *label {
            0 => field,
            label if label == field => 0,
            label => label,
        }
    };
    for bound in term.bounds.iter_mut().chain(&mut way) {
        exchange(&mut bound.particle);
        exchange(&mut bound.centre);
    }
    term.factors.iter_mut().flat_map(|factor| &mut factor.particles).for_each(exchange);
    term.factors.iter_mut().try_for_each(sort_particles)?;
    Ok(Sorted { term, way })
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
