//! What inverses cancel: B·B⁻¹ = I, B̂ by its definition, 1/S · S = 1.
//!
//! An inverse P⁻¹ of P = c M + rest is cancelled against the one sum M of P: P⁻¹ M → (I − P⁻¹ rest)/c.

use super::algebra::{Bound, Expression, Factor, Index, Label, Symbol, Term};
use crate::exact::int;
use crate::language::tree::OfParticle;

/// A sum over one particle j of scalars that name it and of r's from its centre: the part of a term that an inverse may
/// cancel against.
struct Cluster {
    /// Place of its bound in the term.
    bound: usize,
    /// Its scalars, with j written as [`Label::MAX`]; sorted.
    scalars: Vec<Factor>,
    /// The indices of its r's.
    indices: Vec<Index>,
    /// Places of its factors.
    places: Vec<usize>,
}

/// The cluster over the particle of a bound, if it is one.
fn cluster(term: &Term, bound: usize) -> Option<Cluster> {
    let Bound { particle, centre } = term.bounds[bound];
    if term.bounds.iter().any(|other| other.centre == particle) {
        return None;
    }
    let places = term.naming(particle);
    let (mut scalars, mut indices) = (Vec::new(), Vec::new());
    for place in &places {
        let factor = &term.factors[*place];
        match factor.symbol {
            Symbol::Separation if factor.particles == [centre, particle] => indices.push(factor.indices[0]),
            _ if factor.indices.is_empty() => {
                let mut factor = factor.clone();
                for label in &mut factor.particles {
                    *label = if *label == particle { Label::MAX } else { *label };
                }
                if factor.symbol.is_even() {
                    factor.particles.sort_unstable();
                }
                scalars.push(factor);
            }
            _ => return None,
        }
    }
    scalars.sort();
    Some(Cluster { bound, scalars, indices, places })
}

/// The term with an inverse cancelled, as the terms that stand for it; none if there is nothing to cancel.
pub(super) fn cancel_inverse(term: &Term) -> Option<Vec<Term>> {
    (0..term.factors.len()).find_map(|place| match &term.factors[place].symbol {
        Symbol::Renormalisation => cancel_b(term, place),
        Symbol::RenormalisationHat => cancel_b_hat(term, place),
        Symbol::Reciprocal(body) => cancel_body(term, place, body),
        Symbol::Inverse(body) => cancel_body(term, place, body),
        _ => None,
    })
}

/// ω_j and W′/r of the pair, to which `more` is added; sorted.
fn weights(centre: Label, more: Option<Factor>) -> Vec<Factor> {
    let mut scalars = vec![
        Factor::new(Symbol::OfParticle(OfParticle::Volume), &[Label::MAX], &[]),
        Factor::new(Symbol::Slope, &[centre, Label::MAX], &[]),
    ];
    scalars.extend(more);
    scalars.sort();
    scalars
}

/// B_ab Σ ω r_b ∇_c W = −δ_ac.
fn cancel_b(term: &Term, place: usize) -> Option<Vec<Term>> {
    let factor = &term.factors[place];
    let centre = factor.particles[0];
    let scalars = weights(centre, None);
    for bound in (0..term.bounds.len()).filter(|bound| term.bounds[*bound].centre == centre) {
        let Some(found) = cluster(term, bound).filter(|c| c.scalars == scalars && c.indices.len() == 2)
        else {
            continue;
        };
        for (mine, other) in [(0, 1), (1, 0)] {
            for (theirs, rest) in [(0, 1), (1, 0)] {
                if factor.indices[mine] == found.indices[theirs] {
                    let delta = [factor.indices[other], found.indices[rest]];
                    let mut result = without(term, &found, &[place]);
                    result.coefficient *= int(-1);
                    result.factors.push(Factor::new(Symbol::Delta, &[], &delta));
                    return Some(vec![result]);
                }
            }
        }
    }
    None
}

/// B̂_ab Σ ω r_e e_a e_b ∇_f W = −δ_ef − B̂_ab (Σ ω e_a e_b ∇_c W) B_cd (Σ ω r_e r_f ∇_d W) (Eq. 40).
fn cancel_b_hat(term: &Term, place: usize) -> Option<Vec<Term>> {
    let factor = &term.factors[place];
    let centre = factor.particles[0];
    let inverse_square = Factor::new(Symbol::Distance, &[centre, Label::MAX], &[]).raised(-2);
    let scalars = weights(centre, Some(inverse_square.clone()));
    for bound in (0..term.bounds.len()).filter(|bound| term.bounds[*bound].centre == centre) {
        let Some(found) = cluster(term, bound).filter(|c| c.scalars == scalars && c.indices.len() == 4)
        else {
            continue;
        };
        let mut rest = found.indices.clone();
        let both = factor.indices.iter().all(|index| match rest.iter().position(|known| known == index) {
            Some(at) => {
                rest.remove(at);
                true
            }
            None => false,
        });
        let [e, f] = rest[..] else { continue };
        if !both {
            continue;
        }
        let mut first = without(term, &found, &[place]);
        first.coefficient *= int(-1);
        first.factors.push(Factor::new(Symbol::Delta, &[], &[e, f]));
        let mut second = without(term, &found, &[]);
        second.coefficient *= int(-1);
        let [c, d] = fresh_indices(term);
        let [j, k] = fresh_labels(term);
        let [a, b] = factor.indices[..] else { continue };
        for (particle, indices, distance) in [(j, [a, b, c], true), (k, [e, f, d], false)] {
            second.bounds.push(Bound { particle, centre });
            second.factors.push(Factor::new(Symbol::OfParticle(OfParticle::Volume), &[particle], &[]));
            second.factors.push(Factor::new(Symbol::Slope, &[centre, particle], &[]));
            if distance {
                second.factors.push(Factor::new(Symbol::Distance, &[centre, particle], &[]).raised(-2));
            }
            let r = indices.map(|index| Factor::new(Symbol::Separation, &[centre, particle], &[index]));
            second.factors.extend(r);
        }
        second.factors.push(Factor::new(Symbol::Renormalisation, &[centre], &[c, d]));
        return Some(vec![first, second]);
    }
    None
}

/// P⁻¹ against the sum of one term of P, P a scalar or a tensor of rank 2 whose sums are clusters.
fn cancel_body(term: &Term, place: usize, body: &Expression) -> Option<Vec<Term>> {
    let factor = &term.factors[place];
    if factor.power < 1 {
        return None;
    }
    let (chosen, pivot) = body.terms.iter().enumerate().find(|(_, term)| term.bounds.len() == 1)?;
    // The pivot, with the particles of the term in place of the body's own.
    let named = |label: Label| factor.particles.get(usize::from(label)).copied();
    let wanted = cluster(pivot, 0)?;
    let rename = |factor: &Factor| {
        let mut factor = factor.clone();
        for label in factor.particles.iter_mut().filter(|label| **label != Label::MAX) {
            *label = named(*label)?;
        }
        if factor.symbol.is_even() {
            factor.particles.sort_unstable();
        }
        Some(factor)
    };
    let mut scalars = wanted.scalars.iter().map(rename).collect::<Option<Vec<_>>>()?;
    scalars.sort();
    let outside = (0..pivot.factors.len()).filter(|place| !wanted.places.contains(place));
    let outside = outside.map(|place| rename(&pivot.factors[place])).collect::<Option<Vec<_>>>()?;
    if outside.iter().any(|factor| !factor.indices.is_empty()) || wanted.indices.len() != body.free.len() {
        return None;
    }
    let centre = named(pivot.bounds[0].centre)?;
    for bound in (0..term.bounds.len()).filter(|bound| term.bounds[*bound].centre == centre) {
        let Some(found) = cluster(term, bound).filter(|c| {
            c.scalars == scalars && c.indices.len() == body.free.len() && !c.places.contains(&place)
        }) else {
            continue;
        };
        // P⁻¹_ab P_bc = δ_ac, and P_ab P⁻¹_bc = δ_ac.
        let pairings: Vec<Option<([Index; 2], [Index; 2])>> = match (&factor.indices[..], &found.indices[..])
        {
            ([], []) => vec![None],
            ([a, b], [c, d]) => {
                let ways = [(b, a, c, d, false), (b, a, d, c, false), (a, b, c, d, true), (a, b, d, c, true)];
                let met = ways.into_iter().filter(|(mine, _, theirs, ..)| mine == theirs);
                met.map(|(mine, other, _, rest, left)| {
                    // The free indices of P that the pivot's stand for, in order.
                    Some(([*other, *rest], if left { [*rest, *mine] } else { [*mine, *rest] }))
                })
                .collect()
            }
            _ => continue,
        };
        let Some(pairing) = pairings.into_iter().next() else { continue };
        // The scalars outside the pivot's sum must be there to be taken.
        let mut base = without(term, &found, &[]);
        if !outside.iter().all(|factor| take(&mut base, factor)) {
            continue;
        }
        let at = base.factors.iter().position(|known| {
            known.symbol == factor.symbol
                && known.particles == factor.particles
                && known.indices == factor.indices
        })?;
        base.coefficient /= &pivot.coefficient;
        let mut first = base.clone();
        first.factors[at].power -= 1;
        if first.factors[at].power == 0 {
            first.factors.remove(at);
        }
        if let Some((delta, _)) = pairing {
            first.factors.push(Factor::new(Symbol::Delta, &[], &delta));
        }
        let mut terms = vec![first];
        for (other, rest) in body.terms.iter().enumerate() {
            if other != chosen {
                let free = pairing.map(|(_, free)| free);
                terms.push(times_body(&base, rest, body, factor, free)?);
            }
        }
        return Some(terms);
    }
    None
}

/// −`base` times a term of a body, with fresh names for what the body binds and sums.
fn times_body(
    base: &Term,
    rest: &Term,
    body: &Expression,
    factor: &Factor,
    free: Option<[Index; 2]>,
) -> Option<Term> {
    let mut inner = rest.clone();
    let first_label = next_label(base);
    let first_index = next_index(base).max(body.free.iter().copied().max().unwrap_or(0) + 1);
    let outer = factor.particles.len() as Label;
    let rename = |label: Label| match label < outer {
        true => factor.particles[usize::from(label)],
        false => first_label + (label - outer),
    };
    for bound in &mut inner.bounds {
        *bound = Bound { particle: rename(bound.particle), centre: rename(bound.centre) };
    }
    for factor in &mut inner.factors {
        factor.particles.iter_mut().for_each(|label| *label = rename(*label));
        for index in &mut factor.indices {
            *index = match (body.free.iter().position(|known| known == index), free) {
                (Some(at), Some(free)) => *free.get(at)?,
                _ => *index + first_index,
            };
        }
    }
    let mut product = base.times(&inner);
    product.coefficient *= int(-1);
    Some(product)
}

/// Takes a scalar factor out of a term, if it is there to that power.
fn take(term: &mut Term, wanted: &Factor) -> bool {
    let found = term.factors.iter().position(|known| {
        known.symbol == wanted.symbol
            && known.particles == wanted.particles
            && known.power.signum() == wanted.power.signum()
            && known.power.abs() >= wanted.power.abs()
    });
    let Some(place) = found else { return false };
    term.factors[place].power -= wanted.power;
    if term.factors[place].power == 0 {
        term.factors.remove(place);
    }
    true
}

/// The term without a cluster and without the factors at these places.
fn without(term: &Term, cluster: &Cluster, places: &[usize]) -> Term {
    let gone = |place: &usize| cluster.places.contains(place) || places.contains(place);
    let factors =
        (0..term.factors.len()).filter(|place| !gone(place)).map(|place| term.factors[place].clone());
    let bounds =
        (0..term.bounds.len()).filter(|bound| *bound != cluster.bound).map(|bound| term.bounds[bound]);
    Term { coefficient: term.coefficient.clone(), bounds: bounds.collect(), factors: factors.collect() }
}

fn next_label(term: &Term) -> Label {
    let named = term.factors.iter().flat_map(|factor| &factor.particles);
    named.chain(term.bounds.iter().map(|bound| &bound.particle)).copied().max().unwrap_or(0) + 1
}

fn next_index(term: &Term) -> Index {
    term.factors.iter().flat_map(|factor| &factor.indices).copied().max().unwrap_or(0) + 1
}

fn fresh_labels(term: &Term) -> [Label; 2] {
    let next = next_label(term);
    [next, next + 1]
}

fn fresh_indices(term: &Term) -> [Index; 2] {
    let next = next_index(term);
    [next, next + 1]
}
