//! The normal form of an expression: unit tensors contracted, inverses cancelled, like terms collected.
//!
//! An expression whose normal form has no terms vanishes for every kernel, every weight and every arrangement of particles.
//! The converse needs more than this form knows (relations between W and its derivatives, say), so a term that is left is
//! not yet proved to be there: that takes an arrangement on which it is not zero.

use super::DeriveError;
use super::algebra::{Bound, Expression, Factor, Index, Label, Symbol, Term};
use super::canonical::canonical;
use super::rules::cancel_inverse;
use crate::exact::int;
use num_traits::Zero;
use std::collections::BTreeMap;

/// More terms than this, and the expansion is refused.
const MOST_TERMS: usize = 20_000;

/// The normal form of an operator's expression: particle 0 is i, bound ones are numbered from 1.
pub(super) fn normalised(expression: Expression) -> Result<Expression, DeriveError> {
    normalised_with(expression, 1)
}

/// The normal form with bound particles numbered from `base`.
pub(super) fn normalised_with(expression: Expression, base: Label) -> Result<Expression, DeriveError> {
    let free = expression.free;
    let mut waiting = expression.terms;
    let mut collected: BTreeMap<(Vec<Bound>, Vec<Factor>), Term> = BTreeMap::new();
    let mut steps = 0;
    while let Some(mut term) = waiting.pop() {
        steps += 1;
        if steps > MOST_TERMS {
            return Err(DeriveError::TooLarge { most: MOST_TERMS });
        }
        if term.coefficient.is_zero() {
            continue;
        }
        simplify(&mut term, &free);
        if let Some(terms) = cancel_inverse(&term) {
            waiting.extend(terms);
            continue;
        }
        let term = canonical(&term, &free, base);
        let key = (term.bounds.clone(), term.factors.clone());
        match collected.get_mut(&key) {
            Some(known) => known.coefficient += term.coefficient,
            None => {
                collected.insert(key, term);
            }
        }
    }
    let mut terms: Vec<Term> = collected.into_values().filter(|term| !term.coefficient.is_zero()).collect();
    terms.sort_by(|a, b| {
        (a.order(), a.bounds.len(), &a.bounds, &a.factors).cmp(&(
            b.order(),
            b.bounds.len(),
            &b.bounds,
            &b.factors,
        ))
    });
    Ok(Expression { free, terms })
}

/// Contracts unit tensors and r·r, and gathers powers of scalars.
pub(super) fn simplify(term: &mut Term, free: &[Index]) {
    while contract_delta(term, free) || contract_self(term) {}
    gather(term);
}

/// One δ_ab with a summed index less.
fn contract_delta(term: &mut Term, free: &[Index]) -> bool {
    for place in 0..term.factors.len() {
        if term.factors[place].symbol != Symbol::Delta {
            continue;
        }
        let [a, b] = term.factors[place].indices[..] else { continue };
        if a == b {
            term.factors[place] = Factor::new(Symbol::Dimension, &[], &[]);
            return true;
        }
        for (gone, kept) in [(a, b), (b, a)] {
            if !free.contains(&gone) && term.count_index(gone) == 2 {
                term.factors.remove(place);
                term.rename_index(gone, kept);
                return true;
            }
        }
    }
    false
}

/// r_pq·r_pq = |r_pq|², tr ∇∇W = ∇·∇W.
fn contract_self(term: &mut Term) -> bool {
    for place in 0..term.factors.len() {
        let factor = &term.factors[place];
        match factor.symbol {
            Symbol::Separation => {
                let (index, particles) = (factor.indices[0], factor.particles.clone());
                let twin = (place + 1..term.factors.len()).find(|other| {
                    let other = &term.factors[*other];
                    other.symbol == Symbol::Separation
                        && other.indices[0] == index
                        && other.particles == particles
                });
                if let Some(twin) = twin {
                    term.factors.remove(twin);
                    let mut pair = particles;
                    pair.sort_unstable();
                    term.factors[place] = Factor::new(Symbol::Distance, &pair, &[]).raised(2);
                    return true;
                }
            }
            Symbol::Hessian if factor.indices[0] == factor.indices[1] => {
                let particles = factor.particles.clone();
                term.factors[place] = Factor::new(Symbol::Laplacian, &particles, &[]);
                return true;
            }
            _ => {}
        }
    }
    false
}

fn gather(term: &mut Term) {
    let mut gathered: Vec<Factor> = Vec::with_capacity(term.factors.len());
    for mut factor in std::mem::take(&mut term.factors) {
        if factor.symbol.is_even() {
            factor.particles.sort_unstable();
        }
        let same = gathered.iter_mut().find(|known| {
            known.indices.is_empty()
                && factor.indices.is_empty()
                && known.symbol == factor.symbol
                && known.particles == factor.particles
        });
        match same {
            Some(known) => known.power += factor.power,
            None => gathered.push(factor),
        }
    }
    // |r_pq|⁰ is 1 but for p = q, where what divided by the distance is left out. An r_pq in the term says so already.
    let tells_apart = |pair: &Factor| {
        pair.symbol == Symbol::Distance
            && !gathered.iter().any(|other| {
                other.symbol == Symbol::Separation
                    && other.particles.iter().all(|p| pair.particles.contains(p))
            })
    };
    let kept: Vec<bool> = gathered.iter().map(|factor| factor.power != 0 || tells_apart(factor)).collect();
    let mut kept = kept.into_iter();
    gathered.retain(|_| kept.next().unwrap_or(true));
    term.factors = gathered;
}

/// The difference of two expressions of the same rank, normalised.
pub(super) fn difference(a: &Expression, b: &Expression) -> Result<Expression, DeriveError> {
    let most = a.free.iter().chain(a.terms.iter().flat_map(|t| t.factors.iter().flat_map(|f| &f.indices)));
    let shift = most.copied().max().unwrap_or(0) + 1;
    let mut other = b.clone().map(|term| {
        term.coefficient *= int(-1);
        term.factors.iter_mut().flat_map(|factor| &mut factor.indices).for_each(|index| *index += shift);
    });
    other.free = b.free.iter().map(|index| index + shift).collect();
    let free = if a.is_zero() && a.free.is_empty() { other.free.clone() } else { a.free.clone() };
    let mut sum = Expression { free: free.clone(), terms: a.terms.clone() };
    sum.terms.extend(other.with_free(&free).terms);
    normalised(sum)
}
