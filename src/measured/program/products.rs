//! Products of many factors as few multiplications: whatever pair of factors occurs in most of them is multiplied once.

use std::collections::{BTreeMap, BTreeSet};

/// Beyond this many products the search for the commonest pair takes too long; each is then taken from its left.
const MOST_SEARCHED: usize = 600;

/// Factors are numbered; products of two of them are numbered on from the highest.
#[derive(Debug, Default)]
pub(super) struct Plan {
    /// The two factors of each product made on the way, by number.
    pub(super) made: BTreeMap<usize, (usize, usize)>,
    /// What is left of each product: two factors, or one.
    pub(super) products: Vec<Vec<usize>>,
}

/// Plans products, given as factors below `count`, with repetitions.
pub(super) fn plan(mut products: Vec<Vec<usize>>, count: usize) -> Plan {
    let mut made = BTreeMap::new();
    let mut next = count;
    products.iter_mut().for_each(|factors| factors.sort_unstable());
    loop {
        let mut counts: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let limit = if products.len() > MOST_SEARCHED { 1 } else { usize::MAX };
        for factors in products.iter().filter(|factors| factors.len() > 2).take(limit) {
            for pair in pairs_of(factors) {
                *counts.entry(pair).or_default() += 1;
            }
        }
        if limit == usize::MAX {
            // A product of just two factors gains from a pair made for others.
            for factors in products.iter().filter(|factors| factors.len() == 2) {
                if let Some(count) = counts.get_mut(&(factors[0], factors[1])) {
                    *count += 1;
                }
            }
        }
        let best = counts.iter().max_by(|(a, n), (b, m)| n.cmp(m).then(b.cmp(a)));
        let Some((pair, _)) = best.map(|(pair, n)| (*pair, *n)) else { break };
        for factors in &mut products {
            while factors.len() > 2 && replace(factors, pair, next) {}
        }
        made.insert(next, pair);
        next += 1;
    }
    Plan { made, products }
}

/// The distinct pairs that can be taken out of a product.
fn pairs_of(factors: &[usize]) -> BTreeSet<(usize, usize)> {
    let mut pairs = BTreeSet::new();
    for (place, a) in factors.iter().enumerate() {
        pairs.extend(factors[place + 1..].iter().map(|b| (*a, *b)));
    }
    pairs
}

/// Takes one occurrence of the pair out, if there is one. The new factor is the highest of all.
fn replace(factors: &mut Vec<usize>, (a, b): (usize, usize), new: usize) -> bool {
    let Some(first) = factors.iter().position(|factor| *factor == a) else { return false };
    let Some(second) = factors.iter().skip(first + 1).position(|factor| *factor == b) else { return false };
    factors.remove(first + 1 + second);
    factors.remove(first);
    factors.push(new);
    true
}
