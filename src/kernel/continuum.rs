//! The continuum limit of a moment: ∫ Σ_t c_t r^{μ_t} G_{k_t}(r) dV over the support, exact or enclosed.

use super::radial::{radial_moment, radial_pieces};
use super::{Kernel, Profile, gaussian};
use crate::exact::{Coefficient, Enclosure, MultiIndex, Piecewise, Rational, int};
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
    /// lattice sums leave it out. Rational for polynomial kernels, since π cancels; for others enclosed with `bits`
    /// fractional bits or so.
    pub fn continuum_limit(&self, dimension: usize, terms: &[SummandTerm], bits: u32) -> Coefficient {
        match self.profile() {
            Profile::Polynomial(profile) => Coefficient::from(polynomial_limit(profile, dimension, terms)),
            Profile::Gaussian { cut } => Coefficient::from(gaussian_limit(cut, dimension, terms, bits)),
        }
    }
}

fn polynomial_limit(profile: &Piecewise, dimension: usize, terms: &[SummandTerm]) -> Rational {
    let functions: Vec<_> = terms.iter().map(|term| radial_pieces(profile, term.radial)).collect();
    let mut total = Rational::zero();
    for piece in 0..profile.pieces().len() {
        // The terms have poles at q = 0 that cancel in their sum: collect by power of q before integrating.
        let mut laurent: BTreeMap<i64, Rational> = BTreeMap::new();
        for (term, pieces) in terms.iter().zip(&functions) {
            let radial = &pieces[piece];
            let weight = sphere_monomial(dimension, &term.monomial) * int(term.coefficient);
            let shift =
                i64::from(term.monomial.order()) + dimension as i64 - 1 - radial.denominator_power as i64;
            for (e, coefficient) in radial.numerator.coefficients().iter().enumerate() {
                *laurent.entry(e as i64 + shift).or_default() += coefficient * &weight;
            }
        }
        let (from, to) = (&profile.knots()[piece], &profile.knots()[piece + 1]);
        for (exponent, coefficient) in laurent.into_iter().filter(|(_, c)| !c.is_zero()) {
            assert!(exponent >= 0, "the summand of a moment is integrable at the origin");
            total += coefficient * (power(to, exponent + 1) - power(from, exponent + 1)) / int(exponent + 1);
        }
    }
    total / radial_moment(profile, dimension - 1)
}

fn gaussian_limit(cut: &Rational, dimension: usize, terms: &[SummandTerm], bits: u32) -> Enclosure {
    let guard = bits + 32;
    let mut total = Enclosure::from_i64(0);
    for term in terms {
        let weight = sphere_monomial(dimension, &term.monomial)
            * int(term.coefficient)
            * int((-2_i64).pow(term.radial as u32));
        if weight.is_zero() {
            continue;
        }
        let n = term.monomial.order() as usize + dimension - 1;
        total = &total + &gaussian::radial_integral(cut, n, guard).scale(&weight, guard);
    }
    // S_D σ_D is 2/√π, 2, 4/√π.
    let surface = match dimension {
        1 => gaussian::normalisation(1, guard).scale(&int(2), guard),
        2 => Enclosure::from_i64(2),
        _ => gaussian::normalisation(1, guard).scale(&int(4), guard),
    };
    (&total * &surface).round(bits + 8)
}

/// base^exponent for exponent ≥ 0.
fn power(base: &Rational, exponent: i64) -> Rational {
    (0..exponent).fold(Rational::one(), |product, _| product * base)
}
