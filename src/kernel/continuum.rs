//! The continuum limit of a moment: ∫ Σ_t c_t r^{μ_t} G_{k_t}(r) dV over the support, exactly.

use super::Kernel;
use crate::exact::{MultiIndex, Radical, Rational, int};
use num_traits::{One, Zero};
use std::collections::BTreeMap;

/// One term of the summand of a moment: coefficient · r^monomial · G_radial(r).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SummandTerm {
    /// The factor in front.
    pub coefficient: i64,
    /// The power of each coordinate.
    pub monomial: MultiIndex,
    /// Which of G_0, G_1, G_2.
    pub radial: usize,
}

/// ∫ n^μ dS over the unit sphere in D dimensions, divided by its surface S_D: zero if a power is odd, else
/// Π (μ_a − 1)!! / (D (D + 2) … (D + |μ| − 2)).
pub fn sphere_monomial(dimension: usize, monomial: &MultiIndex) -> Rational {
    let powers = monomial.powers;
    if powers.iter().any(|power| power % 2 == 1) {
        return Rational::zero();
    }
    let odd_factors = powers.iter().flat_map(|power| (1..i64::from(*power)).step_by(2));
    let numerator: i64 = odd_factors.product();
    let denominator: i64 =
        (0..i64::from(monomial.order()) / 2).map(|step| dimension as i64 + 2 * step).product();
    int(numerator) / int(denominator)
}

impl Kernel {
    /// The integral of σ_D Σ_t c_t q^{μ_t} G_{k_t} over the support, lengths in units of h: the limit Δ/h → 0 of the
    /// lattice sum of the same summand. What a delta function at R would add (where w jumps there) is left out, as
    /// lattice sums leave it out. π always cancels, so the result is rational.
    pub fn continuum_limit(&self, dimension: usize, terms: &[SummandTerm]) -> Rational {
        let mut total = Rational::zero();
        for piece in 0..self.profile().pieces().len() {
            // The terms have poles at q = 0 that cancel in their sum: collect by power of q before integrating.
            let mut laurent: BTreeMap<i64, Rational> = BTreeMap::new();
            let (mut from, mut to) = (int(0), int(0));
            for term in terms {
                let radial = &self.radial_function(term.radial)[piece];
                let weight = sphere_monomial(dimension, &term.monomial) * int(term.coefficient);
                let shift =
                    i64::from(term.monomial.order()) + dimension as i64 - 1 - radial.denominator_power as i64;
                for (e, coefficient) in radial.numerator.coefficients().iter().enumerate() {
                    *laurent.entry(e as i64 + shift).or_default() += coefficient * &weight;
                }
                (from, to) = (radial.from.clone(), radial.to.clone());
            }
            for (exponent, coefficient) in laurent.into_iter().filter(|(_, c)| !c.is_zero()) {
                assert!(exponent >= 0, "the summand of a moment is integrable at the origin");
                total +=
                    coefficient * (power(&to, exponent + 1) - power(&from, exponent + 1)) / int(exponent + 1);
            }
        }
        total / self.radial_moment(dimension - 1)
    }

    /// σ_D as in [`Kernel::normalisation`] for lengths in units of R instead of h: W = R^{-D} F(r/R).
    pub fn normalisation_in_support(&self, dimension: usize) -> Radical {
        self.normalisation(dimension).scale(&power(self.support_over_h(), dimension as i64))
    }
}

/// base^exponent for exponent ≥ 0.
fn power(base: &Rational, exponent: i64) -> Rational {
    (0..exponent).fold(Rational::one(), |product, _| product * base)
}
