//! Moment sums over given neighbours in floating point: what the measured column rests on.
//!
//! Positions are in units of R, x = r_ij / R. All components asked for are taken in one pass, with one evaluation of the
//! kernel for each pair. What is summed are the distinct products r^μ G_k, which many components share; the components
//! are put together from them at the end. Eight lanes: pair n goes to lane n mod 8, and the lanes are added in one fixed order. No
//! fused operations, so the same pairs in the same order give the same bits on every machine.

use super::moment::Moment;
use crate::exact::MultiIndex;
use crate::kernel::{Evaluator, Kernel};
use num_traits::Float;
use std::ops::Range;

const LANES: usize = 8;

/// Which moments to take, made ready: their components, and the monomials and radial functions these need.
#[derive(Debug, Clone)]
pub struct PairSums<T> {
    dimension: usize,
    evaluator: Evaluator<T>,
    moments: Vec<Moment>,
    /// The components of each moment in `terms`.
    ranges: Vec<Range<usize>>,
    multiplicities: Vec<T>,
    /// By component: (coefficient, index into the products).
    terms: Vec<Vec<(T, usize)>>,
    /// The distinct products r^μ G_k: (index into the monomials, radial function).
    products: Vec<(usize, usize)>,
    /// Each monomial as an earlier one times an axis, the constant first.
    steps: Vec<(usize, usize)>,
}

/// Sums being taken: eight lanes per product.
#[derive(Debug, Clone)]
pub struct Accumulator<T> {
    lanes: Vec<[T; LANES]>,
    /// Scratch: each monomial of the pairs in the block.
    monomials: Vec<[T; LANES]>,
    block: Block<T>,
    filled: usize,
    pairs: u64,
}

#[derive(Debug, Clone)]
struct Block<T> {
    x: [[T; LANES]; 3],
    weight: [T; LANES],
}

impl<T: Float> Block<T> {
    fn empty() -> Self {
        Self { x: [[T::zero(); LANES]; 3], weight: [T::zero(); LANES] }
    }
}

impl<T: Float> PairSums<T> {
    /// Prepares the sums of these moments of a kernel in `dimension` dimensions.
    pub fn new(kernel: &Kernel, dimension: usize, moments: &[Moment]) -> Self {
        let mut monomials = vec![MultiIndex::default()];
        let mut steps = vec![(0, 0)];
        let mut ranges = Vec::new();
        let (mut terms, mut multiplicities) = (Vec::new(), Vec::new());
        let mut products: Vec<(usize, usize)> = Vec::new();
        for moment in moments {
            let start = terms.len();
            for component in moment.components(dimension) {
                multiplicities.push(number(component.multiplicity as f64));
                let summand = component.terms.iter().map(|term| {
                    let product = (place_of(&term.monomial, &mut monomials, &mut steps), term.radial);
                    let place = products.iter().position(|known| *known == product).unwrap_or_else(|| {
                        products.push(product);
                        products.len() - 1
                    });
                    (number(term.coefficient as f64), place)
                });
                terms.push(summand.collect());
            }
            ranges.push(start..terms.len());
        }
        let order = products.iter().map(|(_, radial)| *radial).max().unwrap_or(0);
        Self {
            dimension,
            evaluator: Evaluator::new(kernel, dimension, order),
            moments: moments.to_vec(),
            ranges,
            multiplicities,
            terms,
            products,
            steps,
        }
    }

    /// The moments, in the order they were asked for.
    pub fn moments(&self) -> &[Moment] {
        &self.moments
    }

    /// D.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of components of all moments.
    pub fn components(&self) -> usize {
        self.terms.len()
    }

    /// Where the components of each moment stand.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.ranges
    }

    /// An empty sum.
    pub fn start(&self) -> Accumulator<T> {
        Accumulator {
            lanes: vec![[T::zero(); LANES]; self.products.len()],
            monomials: vec![[T::one(); LANES]; self.steps.len()],
            block: Block::empty(),
            filled: 0,
            pairs: 0,
        }
    }

    /// Adds the pair at x = r_ij / R with weight ω_j / R^D. Pairs beyond the support add nothing.
    pub fn add(&self, sums: &mut Accumulator<T>, x: [T; 3], weight: T) {
        let lane = sums.filled;
        for (lanes, x) in sums.block.x.iter_mut().zip(x) {
            lanes[lane] = x;
        }
        sums.block.weight[lane] = weight;
        sums.filled += 1;
        sums.pairs += 1;
        if sums.filled == LANES {
            self.flush(sums);
        }
    }

    /// The components, in units of R (a moment with p positions and q derivatives is to be multiplied by R^{p−q}), and
    /// the number of pairs.
    pub fn finish(&self, mut sums: Accumulator<T>) -> (Vec<T>, u64) {
        if sums.filled > 0 {
            self.flush(&mut sums);
        }
        let products: Vec<T> = sums.lanes.iter().map(tree_sum).collect();
        let component = |terms: &Vec<(T, usize)>| {
            terms
                .iter()
                .fold(T::zero(), |sum, (coefficient, product)| sum + *coefficient * products[*product])
        };
        (self.terms.iter().map(component).collect(), sums.pairs)
    }

    /// The Frobenius norm of one moment's components, each counted as often as it stands in the full tensor.
    pub fn frobenius(&self, moment: usize, components: &[T]) -> T {
        let range = self.ranges[moment].clone();
        let squares = range.map(|c| self.multiplicities[c] * components[c] * components[c]);
        squares.fold(T::zero(), |sum, square| sum + square).sqrt()
    }

    fn flush(&self, sums: &mut Accumulator<T>) {
        let block = &sums.block;
        let [x, y, z] = &block.x;
        let mut radius = [T::zero(); LANES];
        for lane in 0..LANES {
            radius[lane] = (x[lane] * x[lane] + y[lane] * y[lane] + z[lane] * z[lane]).sqrt();
        }
        let mut g = self.evaluator.evaluate(&radius).g;
        for function in &mut g {
            for (value, weight) in function.iter_mut().zip(&block.weight) {
                *value = *value * *weight;
            }
        }
        for (index, (earlier, axis)) in self.steps.iter().enumerate().skip(1) {
            let (before, rest) = sums.monomials.split_at_mut(index);
            for lane in 0..LANES {
                rest[0][lane] = before[*earlier][lane] * block.x[*axis][lane];
            }
        }
        for (sum, (monomial, radial)) in sums.lanes.iter_mut().zip(&self.products) {
            let (monomial, radial) = (&sums.monomials[*monomial], &g[*radial]);
            for lane in 0..LANES {
                sum[lane] = sum[lane] + monomial[lane] * radial[lane];
            }
        }
        sums.block = Block::empty();
        sums.filled = 0;
    }
}

/// The index of a monomial, entered with its predecessors if it is not there yet.
fn place_of(
    monomial: &MultiIndex,
    monomials: &mut Vec<MultiIndex>,
    steps: &mut Vec<(usize, usize)>,
) -> usize {
    if let Some(place) = monomials.iter().position(|known| known == monomial) {
        return place;
    }
    let axis = (0..3).rev().find(|a| monomial.powers[*a] > 0).unwrap_or(0);
    let mut powers = monomial.powers;
    powers[axis] -= 1;
    let earlier = place_of(&MultiIndex::new(powers), monomials, steps);
    monomials.push(*monomial);
    steps.push((earlier, axis));
    monomials.len() - 1
}

fn number<T: Float>(value: f64) -> T {
    T::from(value).unwrap_or_else(T::nan)
}

/// ((0+4)+(2+6)) + ((1+5)+(3+7)).
fn tree_sum<T: Float>(lanes: &[T; LANES]) -> T {
    let [a, b, c, d, e, f, g, h] = *lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}
