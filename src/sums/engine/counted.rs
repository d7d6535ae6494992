//! What sums cost, counted: lanes that count what is done with them.

use super::arithmetic::{Scratch, Task, block_of};
use super::lanes::{Lanes, Portable};
use super::radial::Radial;
use super::request::{Factor, Plan, RadialSum};
use super::run::Points;
use super::sorted::Sorted;
use crate::kernel::{LANES, by_id};
use std::cell::Cell;

/// Multiplications, additions, and roots, of which each eight neighbours take one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Count {
    products: i64,
    additions: i64,
    eights: i64,
}

thread_local! {
    static COUNT: Cell<Count> = const { Cell::new(Count { products: 0, additions: 0, eights: 0 }) };
}

fn count(more: Count) {
    COUNT.with(|count| {
        let Count { products, additions, eights } = count.get();
        count.set(Count {
            products: products + more.products,
            additions: additions + more.additions,
            eights: eights + more.eights,
        });
    });
}

#[derive(Clone, Copy)]
struct Counted(Portable);

impl Lanes for Counted {
    fn splat(value: f64) -> Self {
        Self(Portable::splat(value))
    }

    fn load(values: &[f64; LANES]) -> Self {
        Self(Portable::load(values))
    }

    fn store(self, values: &mut [f64; LANES]) {
        self.0.store(values);
    }

    fn add(self, other: Self) -> Self {
        count(Count { additions: 1, ..Count::default() });
        Self(self.0.add(other.0))
    }

    fn sub(self, other: Self) -> Self {
        Self(self.0.sub(other.0))
    }

    fn mul(self, other: Self) -> Self {
        count(Count { products: 1, ..Count::default() });
        Self(self.0.mul(other.0))
    }

    fn div(self, other: Self) -> Self {
        Self(self.0.div(other.0))
    }

    fn sqrt(self) -> Self {
        count(Count { eights: 1, ..Count::default() });
        Self(self.0.sqrt())
    }

    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    fn where_below(self, other: Self, yes: Self, no: Self) -> Self {
        Self(self.0.where_below(other.0, yes.0, no.0))
    }

    fn below(self, other: Self) -> u8 {
        self.0.below(other.0)
    }

    fn pack(self, inside: u8, to: &mut [f64; LANES]) {
        self.0.pack(inside, to);
    }

    fn totals(of: [Self; LANES]) -> Self {
        Self(Portable::totals(of.map(|lanes| lanes.0)))
    }
}

/// Of Σ ω r^p G_k for some (p, k), on a lattice in 2-D.
fn cost(wanted: &[(u8, u8)]) -> Count {
    let positions: Vec<[f64; 3]> =
        (0..400).map(|index| [f64::from(index / 20), f64::from(index % 20), 0.0]).collect();
    let weights = vec![1.0; positions.len()];
    let points = Points { positions: &positions, weights: &weights, fields: &[] };
    let sum = |(positions, radial): &(u8, u8)| RadialSum {
        positions: *positions,
        radial: *radial,
        factor: Factor::One,
    };
    let wanted: Vec<RadialSum> = wanted.iter().map(sum).collect();
    let Ok(plan) = Plan::of_radial(2, &wanted) else { return Count::default() };
    let order = plan.radials.iter().rposition(|wanted| *wanted).unwrap_or(0);
    let Ok(kernel) = by_id("wendland-c2") else { return Count::default() };
    let (radial, support) = (Radial::new(&kernel, 2, order, |_| 1.0), 2.5);
    let mut sorted = Sorted::default();
    sorted.rebuild(&points, 2, support);
    let task = Task { sorted: &sorted, plan: &plan, radial: &radial, support };
    COUNT.with(Cell::take);
    block_of::<Counted, 2>(&task, 0..positions.len(), &mut Scratch::new(&plan, 2), &mut |_, _, _| {});
    COUNT.with(Cell::take)
}

/// What a cost more than another comes to for each eight neighbours.
fn apart(more: &[(u8, u8)], less: &[(u8, u8)]) -> (i64, i64) {
    let (more, less) = (cost(more), cost(less));
    assert!(more.eights > 400 && more.eights == less.eights, "{more:?} {less:?}");
    let (products, additions) = (more.products - less.products, more.additions - less.additions);
    assert_eq!((products % more.eights, additions % more.eights), (0, 0));
    (products / more.eights, additions / more.eights)
}

#[test]
fn an_unwanted_moment_costs_nothing() {
    // Planted: `highest` always 8; sums added up without a look at the degrees; all G_k evaluated whatever is wanted.
    let low = [(0, 1), (1, 1)];
    let high = [(0, 1), (1, 1), (2, 1), (3, 1), (4, 1)];
    // Of degrees 2, 3 and 4 there are 3 + 4 + 5 products, each made by one multiplication from an earlier one.
    assert_eq!(apart(&high, &low), (12, 12));
    // Lower ones are on the way to a higher one, but are not added up: 1 + 2 + 3 + 4 additions less.
    assert_eq!(apart(&high, &[(4, 1)]), (0, 10));
    // G_0 = s⁴ (a s + b): one multiplication and one addition, four multiplications, one by ω; one sum.
    assert_eq!(apart(&[(0, 0), (0, 1)], &[(0, 1)]), (6, 2));
    assert_eq!(apart(&low, &low), (0, 0));
}
