//! Where a polynomial changes sign, by Sturm's theorem: nothing is sampled, so nothing is missed.
//!
//! C. Sturm, Bull. Sci. Férussac 11 (1829) 419: a squarefree p has V(a) − V(b) roots in (a, b], where V counts the changes
//! of sign along p, p′, and the negated remainders of Euclid's algorithm.

use super::{Polynomial, Rational, ratio};
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// A stretch of an interval on which a polynomial keeps its sign (but for isolated zeros of even order).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stretch {
    /// Bounds of its left end, equal where that is known exactly.
    pub from: (Rational, Rational),
    /// Bounds of its right end.
    pub to: (Rational, Rational),
    /// The sign.
    pub sign: Ordering,
}

impl Polynomial {
    /// The stretches of constant sign on `[from, to]`, ends of stretches to within `2^-bits`, and exactly where they are
    /// rational with a small denominator.
    ///
    /// # Examples
    /// ```
    /// use remainder::exact::{Polynomial, int, ratio};
    /// let p = Polynomial::new(vec![int(-1), int(4)]);
    /// let stretches = p.stretches(&int(0), &int(1), 60);
    /// assert_eq!((stretches.len(), stretches[1].from.0.clone()), (2, ratio(1, 4)));
    /// ```
    pub fn stretches(&self, from: &Rational, to: &Rational, bits: u32) -> Vec<Stretch> {
        let whole = |sign| Stretch { from: (from.clone(), from.clone()), to: (to.clone(), to.clone()), sign };
        if self.is_zero() {
            return vec![whole(Ordering::Equal)];
        }
        let chain = self.squarefree_part().sturm_chain();
        let width = ratio(1, 2).pow(bits as i32);
        let mut roots = Vec::new();
        isolate(&chain, from, to, &width, &mut roots);
        roots.retain(|(_, high)| high < to);
        let mut edges = vec![(from.clone(), from.clone())];
        edges.extend(roots);
        edges.push((to.clone(), to.clone()));
        let mut stretches: Vec<Stretch> = Vec::new();
        for pair in edges.windows(2) {
            let between = (&pair[0].1 + &pair[1].0) * ratio(1, 2);
            let sign = self.evaluate(&between).cmp(&Rational::zero());
            match stretches.last_mut().filter(|last| last.sign == sign) {
                Some(last) => last.to = pair[1].clone(),
                None => stretches.push(Stretch { from: pair[0].clone(), to: pair[1].clone(), sign }),
            }
        }
        stretches
    }

    /// The polynomial with each root once.
    fn squarefree_part(&self) -> Self {
        let (mut a, mut b) = (self.clone(), self.derivative());
        while !b.is_zero() {
            let remainder = a.divide(&b).1.with_unit_lead();
            (a, b) = (b, remainder);
        }
        self.divide(&a).0
    }

    fn sturm_chain(self) -> Vec<Self> {
        let mut chain = vec![self.derivative(), self];
        chain.reverse();
        while let [.., a, b] = &chain[..] {
            if b.is_zero() {
                chain.pop();
                break;
            }
            // A positive factor changes no sign and keeps the coefficients short.
            let next = -&a.divide(b).1.with_unit_lead();
            chain.push(next);
        }
        chain
    }

    /// Divided by the absolute value of its leading coefficient.
    fn with_unit_lead(&self) -> Self {
        self.coefficients().last().map_or_else(Self::zero, |lead| self.scale(&lead.abs().recip()))
    }

    /// Quotient and remainder, for a divisor that is not zero.
    fn divide(&self, divisor: &Self) -> (Self, Self) {
        let (mut quotient, mut rest) = (Self::zero(), self.clone());
        while let (Some(high), Some(low)) = (rest.degree(), divisor.degree()) {
            if high < low {
                break;
            }
            let factor = &rest.coefficients()[high] / &divisor.coefficients()[low];
            let term = Self::monomial(factor, high - low);
            rest = &rest - &(&term * divisor);
            quotient = &quotient + &term;
        }
        (quotient, rest)
    }
}

/// V(x).
fn variations(chain: &[Polynomial], x: &Rational) -> usize {
    let signs: Vec<bool> =
        chain.iter().map(|p| p.evaluate(x)).filter(|v| !v.is_zero()).map(|v| v.is_positive()).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Brackets of the roots in (from, to], rising; a bracket's left end is never a root.
fn isolate(
    chain: &[Polynomial],
    from: &Rational,
    to: &Rational,
    width: &Rational,
    found: &mut Vec<(Rational, Rational)>,
) {
    let count = variations(chain, from) - variations(chain, to);
    if count == 0 {
        return;
    }
    let is_root = |x: &Rational| chain[0].evaluate(x).is_zero();
    if count == 1 {
        if is_root(to) {
            return found.push((to.clone(), to.clone()));
        }
        if to - from <= *width && !is_root(from) {
            let simple = simplest_between(from, to);
            return found.push(if is_root(&simple) {
                (simple.clone(), simple)
            } else {
                (from.clone(), to.clone())
            });
        }
    }
    let middle = (from + to) * ratio(1, 2);
    isolate(chain, from, &middle, width, found);
    isolate(chain, &middle, to, width, found);
}

/// The fraction of least denominator in `[low, high]`, for `0 ≤ low ≤ high`.
fn simplest_between(low: &Rational, high: &Rational) -> Rational {
    let whole = low.ceil();
    if whole <= *high {
        return whole;
    }
    let floor = low.floor();
    &floor + (Rational::one() / simplest_between(&(high - &floor).recip(), &(low - &floor).recip()))
}
