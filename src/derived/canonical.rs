//! One name for what differs only in the names of summed particles and indices.
//!
//! A term is a graph: its factors and bound particles are the nodes, shared indices and named particles the edges. Nodes are
//! ranked by what they are, then again and again by the ranks around them, until nothing changes; nodes that stay alike are
//! told apart by choosing one of them (every one in turn, unless they stand to all others in the same way), and the least
//! description is kept.

use super::algebra::{Bound, Factor, Index, Label, Term};
use std::collections::BTreeMap;

/// Ways to choose among nodes that look alike, at most. Beyond it a term may keep a name that is not the least: like terms
/// are then not collected, and nothing is wrongly taken for equal.
const MOST_CHOICES: usize = 720;

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Start<'a> {
    Factor(&'a super::algebra::Symbol, i32, Vec<Option<Label>>, Vec<Option<Index>>),
    Bound(Option<Label>),
}

/// What an edge is: the slots of an index, or the place of a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Edge {
    Index(usize, usize),
    Names(usize),
    NamedBy(usize),
    Centre,
    CentreOf,
}

struct Graph<'a> {
    term: &'a Term,
    /// Edges of each node: factors first, then bounds.
    edges: Vec<Vec<(Edge, usize)>>,
}

/// The term with bound particles numbered from `base` and summed indices from the first number not in `free`; factors in
/// order.
pub(super) fn canonical(term: &Term, free: &[Index], base: Label) -> Term {
    let graph = Graph::of(term, free);
    let ranks = graph.refined(graph.start(free));
    let mut choices = 0;
    graph.least(ranks, free, base, &mut choices)
}

/// Slots that may be exchanged count as one.
fn slot(factor: &Factor, place: usize) -> usize {
    if place < factor.symbol.exchangeable(factor.indices.len()) { 0 } else { place + 1 }
}

/// Particles that may be exchanged count as one.
fn seat(factor: &Factor, place: usize) -> usize {
    if factor.symbol.is_even() { 0 } else { place + 1 }
}

impl<'a> Graph<'a> {
    fn of(term: &'a Term, free: &[Index]) -> Self {
        let factors = term.factors.len();
        let mut edges = vec![Vec::new(); factors + term.bounds.len()];
        let mut met: BTreeMap<Index, (usize, usize)> = BTreeMap::new();
        for (node, factor) in term.factors.iter().enumerate() {
            for (place, index) in factor.indices.iter().enumerate().filter(|(_, index)| !free.contains(index))
            {
                let mine = slot(factor, place);
                match met.insert(*index, (node, mine)) {
                    Some((other, theirs)) => {
                        edges[node].push((Edge::Index(mine, theirs), other));
                        edges[other].push((Edge::Index(theirs, mine), node));
                    }
                    None => continue,
                }
            }
            for (place, label) in factor.particles.iter().enumerate() {
                let bound = term.bounds.iter().position(|bound| bound.particle == *label);
                if let Some(bound) = bound {
                    edges[node].push((Edge::Names(seat(factor, place)), factors + bound));
                    edges[factors + bound].push((Edge::NamedBy(seat(factor, place)), node));
                }
            }
        }
        for (inner, bound) in term.bounds.iter().enumerate() {
            if let Some(outer) = term.bounds.iter().position(|other| other.particle == bound.centre) {
                edges[factors + inner].push((Edge::Centre, factors + outer));
                edges[factors + outer].push((Edge::CentreOf, factors + inner));
            }
        }
        Self { term, edges }
    }

    /// Ranks by what each node is, alone.
    fn start(&self, free: &[Index]) -> Vec<usize> {
        let is_bound = |label: &Label| self.term.bounds.iter().any(|bound| bound.particle == *label);
        let of_factor = |factor: &'a Factor| {
            let mut particles: Vec<Option<Label>> =
                factor.particles.iter().map(|label| (!is_bound(label)).then_some(*label)).collect();
            if factor.symbol.is_even() {
                particles.sort();
            }
            let mut indices: Vec<Option<Index>> =
                factor.indices.iter().map(|index| free.contains(index).then_some(*index)).collect();
            let exchangeable = factor.symbol.exchangeable(indices.len()).min(indices.len());
            indices[..exchangeable].sort();
            Start::Factor(&factor.symbol, factor.power, particles, indices)
        };
        let factors = self.term.factors.iter().map(of_factor);
        let bounds = self.term.bounds.iter();
        let bounds = bounds.map(|bound| Start::Bound((!is_bound(&bound.centre)).then_some(bound.centre)));
        rank(factors.chain(bounds).collect())
    }

    fn refined(&self, mut ranks: Vec<usize>) -> Vec<usize> {
        loop {
            let around = |node: usize| {
                let mut around: Vec<(Edge, usize)> =
                    self.edges[node].iter().map(|(edge, other)| (*edge, ranks[*other])).collect();
                around.sort_unstable();
                (ranks[node], around)
            };
            let next = rank((0..ranks.len()).map(around).collect());
            if next == ranks {
                return ranks;
            }
            ranks = next;
        }
    }

    fn least(&self, ranks: Vec<usize>, free: &[Index], base: Label, choices: &mut usize) -> Term {
        let nodes = ranks.len();
        // The first rank that several nodes share. A rank is the number of nodes before, so the next tells.
        let tied = (0..nodes).find_map(|rank| {
            let same: Vec<usize> = (0..nodes).filter(|node| ranks[*node] == rank).collect();
            (same.len() > 1).then_some(same)
        });
        let Some(tied) = tied else { return self.named(&ranks, free, base) };
        let twins = tied.iter().all(|node| {
            let sorted = |node: usize| {
                let mut edges = self.edges[node].clone();
                edges.sort_unstable();
                edges
            };
            sorted(*node) == sorted(tied[0])
        });
        let among = if twins || *choices > MOST_CHOICES { &tied[..1] } else { &tied[..] };
        let candidates = among.iter().map(|node| {
            *choices += 1;
            // The chosen one comes first, the others of its rank after it.
            let mut chosen = ranks.clone();
            for other in tied.iter().filter(|other| *other != node) {
                chosen[*other] += 1;
            }
            self.least(self.refined(chosen), free, base, choices)
        });
        candidates
            .min_by(|a, b| (&a.bounds, &a.factors).cmp(&(&b.bounds, &b.factors)))
            .unwrap_or_else(|| self.term.clone())
    }

    /// The term as the order of its nodes names it.
    fn named(&self, ranks: &[usize], free: &[Index], base: Label) -> Term {
        let factors = self.term.factors.len();
        let mut bounds: Vec<usize> = (0..self.term.bounds.len()).collect();
        // Outer sums before inner ones.
        let depth = |bound: &usize| {
            let centre_of = |label: Label| self.term.bounds.iter().find(|other| other.particle == label);
            let first = centre_of(self.term.bounds[*bound].centre);
            std::iter::successors(first, |outer| centre_of(outer.centre)).count()
        };
        bounds.sort_by_key(|bound| (depth(bound), ranks[factors + bound]));
        let label = |label: Label| {
            let place = bounds.iter().position(|bound| self.term.bounds[*bound].particle == label);
            place.map_or(label, |place| base + place as Label)
        };
        let mut order: Vec<usize> = (0..factors).collect();
        order.sort_by_key(|factor| ranks[*factor]);
        let mut names: BTreeMap<Index, Index> = BTreeMap::new();
        let mut next = free.iter().copied().max().unwrap_or(0) + 1;
        // Indices are named where they are met; among exchangeable slots, in the order of what they lead to.
        let mut renamed = Vec::with_capacity(factors);
        for node in order {
            let factor = &self.term.factors[node];
            let exchangeable = factor.symbol.exchangeable(factor.indices.len()).min(factor.indices.len());
            let mut indices = factor.indices.clone();
            let leads_to = |index: &Index| {
                let mut ends = (0..factors).filter(|other| self.term.factors[*other].indices.contains(index));
                let other = ends.by_ref().filter(|other| *other != node).map(|other| ranks[other]).min();
                (free.contains(index), other, *index)
            };
            indices[..exchangeable].sort_by_key(leads_to);
            for index in indices.iter_mut().filter(|index| !free.contains(index)) {
                *index = *names.entry(*index).or_insert_with(|| {
                    next += 1;
                    next - 1
                });
            }
            indices[..exchangeable].sort_unstable();
            let mut particles: Vec<Label> = factor.particles.iter().map(|p| label(*p)).collect();
            if factor.symbol.is_even() {
                particles.sort_unstable();
            }
            renamed.push(Factor { symbol: factor.symbol.clone(), particles, indices, power: factor.power });
        }
        let bounds = bounds.iter().map(|bound| {
            let Bound { particle, centre } = self.term.bounds[*bound];
            Bound { particle: label(particle), centre: label(centre) }
        });
        Term { coefficient: self.term.coefficient.clone(), bounds: bounds.collect(), factors: renamed }
    }
}

/// By node, how many nodes come before it: equal for equal keys.
fn rank<K: Ord>(keys: Vec<K>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|a, b| keys[*a].cmp(&keys[*b]));
    let mut ranks = vec![0; keys.len()];
    for (place, node) in order.iter().enumerate() {
        ranks[*node] = match place {
            0 => 0,
            _ if keys[order[place - 1]] == keys[*node] => ranks[order[place - 1]],
            _ => place,
        };
    }
    ranks
}
