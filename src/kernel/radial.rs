//! The kernel type and what is computed from its profile.

use super::KernelError;
use super::gaussian;
use crate::exact::{Enclosure, ExactError, Piecewise, Polynomial, Radical, Rational, int, rational_text};
use num_traits::{Signed, Zero};

/// A radial kernel W(r, h) = σ_D h^{-D} w(q), q = r/h, with compact support R = `support_over_h` · h.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    id: String,
    name: String,
    citation: String,
    profile: Profile,
    printed: Vec<Printed>,
}

/// The shape of w. What has a closed form depends on it; enclosures and floating-point values exist for all.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// Piecewise polynomial with rational coefficients, normalised on its support.
    Polynomial(Piecewise),
    /// exp(−q²) for q < cut, normalised over the whole space.
    Gaussian {
        /// R/h.
        cut: Rational,
    },
}

/// Normalisations as a source prints them, to be held against the right ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// Where they are printed.
    pub source: String,
    /// Its profile over the one of this entry: the sources scale w differently.
    pub factor: Rational,
    /// σ_1, σ_2, σ_3, where it gives them.
    pub constants: [Option<Radical>; 3],
}

/// The radial function G_k: G_0 = w and G_{k+1} = G_k′/q.
#[derive(Debug, Clone, PartialEq)]
pub enum RadialFunction {
    /// By piece.
    Pieces(Vec<RadialPiece>),
    /// factor · exp(−q²).
    Gaussian {
        /// (−2)^k.
        factor: i64,
    },
}

/// Where the profile is not smooth.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jump {
    /// The knot, q = r/h.
    pub at: Rational,
    /// The order of the lowest derivative that jumps there; `None` if the profile is smooth.
    pub order: Option<usize>,
}

/// One piece of the radial function G_k(q) = numerator(q) / q^`denominator_power`, with no common factor q.
///
/// G_0 = w and G_{k+1} = G_k′/q, so that ∂_a W = r_a G_1 and ∂_a∂_b W = δ_ab G_1 + r_a r_b G_2 (with q for r).
#[derive(Debug, Clone, PartialEq)]
pub struct RadialPiece {
    /// Left end of the piece.
    pub from: Rational,
    /// Right end of the piece.
    pub to: Rational,
    /// The numerator.
    pub numerator: Polynomial,
    /// The power of q in the denominator.
    pub denominator_power: usize,
}

impl Kernel {
    /// A kernel of one's own.
    ///
    /// # Errors
    /// [`KernelError::Zero`] if w vanishes, [`KernelError::NotNormalisable`] if ∫ w q^{D−1} dq ≤ 0 for a D of 1, 2, 3.
    pub fn new(id: &str, name: &str, citation: &str, profile: Piecewise) -> Result<Self, KernelError> {
        if profile.pieces().iter().all(Polynomial::is_zero) {
            return Err(KernelError::Zero { id: id.to_owned() });
        }
        for dimension in 1..=3 {
            if !radial_moment(&profile, dimension - 1).is_positive() {
                return Err(KernelError::NotNormalisable { id: id.to_owned(), dimension });
            }
        }
        Ok(Self::from_parts(id.into(), name.into(), citation.into(), Profile::Polynomial(profile)))
    }

    /// A kernel whose profile is known to be normalisable.
    pub(super) fn from_parts(id: String, name: String, citation: String, profile: Profile) -> Self {
        Self { id, name, citation, profile, printed: Vec::new() }
    }

    /// A kernel of the catalogue, whose profile is known to be well formed.
    pub(super) fn of_catalogue(
        id: &str,
        name: &str,
        citation: &str,
        profile: Result<Piecewise, ExactError>,
    ) -> Self {
        let profile = profile.unwrap_or_else(|error| unreachable!("catalogue entry {id}: {error}"));
        Self::new(id, name, citation, profile)
            .unwrap_or_else(|error| unreachable!("catalogue entry {id}: {error}"))
    }

    /// With the constants that a source prints for `factor` times this profile.
    #[must_use]
    pub fn printed_by(mut self, source: &str, factor: Rational, constants: [Option<Radical>; 3]) -> Self {
        self.printed.push(Printed { source: source.to_owned(), factor, constants });
        self
    }

    /// What sources print for its normalisation.
    pub fn printed(&self) -> &[Printed] {
        &self.printed
    }

    /// The id used in scenes and reports.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// A name for people.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where the profile is printed.
    pub fn citation(&self) -> &str {
        &self.citation
    }

    /// The profile w(q), not normalised.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The profile if it is piecewise polynomial: then, and only then, there are closed forms.
    pub fn polynomial(&self) -> Option<&Piecewise> {
        match &self.profile {
            Profile::Polynomial(pieces) => Some(pieces),
            Profile::Gaussian { .. } => None,
        }
    }

    /// R/h: the last knot.
    pub fn support_over_h(&self) -> &Rational {
        match &self.profile {
            Profile::Polynomial(pieces) => pieces.support(),
            Profile::Gaussian { cut } => cut,
        }
    }

    /// What a reader of its numbers must know; nothing for a kernel that is normalised on its support.
    pub fn remark(&self) -> Option<String> {
        match &self.profile {
            Profile::Polynomial(_) => None,
            Profile::Gaussian { cut } => Some(format!(
                "normalised over the whole space and cut at R = {cut} h, where it jumps: continuum limits are those of \
                 the truncated kernel, whose integral is not 1"
            )),
        }
    }

    /// The profile as text, the same for equal profiles only: last knot and ascending coefficients of each piece.
    pub fn canonical_profile(&self) -> Vec<(String, Vec<String>)> {
        match &self.profile {
            Profile::Polynomial(profile) => {
                let pieces = profile.pieces().iter().zip(&profile.knots()[1..]);
                let coefficients = |p: &Polynomial| p.coefficients().iter().map(rational_text).collect();
                pieces.map(|(p, knot)| (rational_text(knot), coefficients(p))).collect()
            }
            Profile::Gaussian { cut } => vec![(rational_text(cut), vec!["exp(-q^2)".into()])],
        }
    }

    /// σ_D = 1 / (S_D ∫ w q^{D−1} dq) with S_1 = 2, S_2 = 2π, S_3 = 4π; `None` where σ_D has no closed form with whole
    /// powers of π, as for a kernel that is not polynomial.
    ///
    /// # Panics
    /// Never for D in 1..=3; other dimensions do not exist in this crate.
    ///
    /// # Examples
    /// ```
    /// // Fatehi & Manzari 2011, Eq. (47): W_0 = 7/(π h²) in two dimensions.
    /// let kernel = remainder::kernel::by_id("wendland-c2").unwrap();
    /// assert_eq!(kernel.normalisation(2).unwrap().to_string(), "7·π^-1");
    /// ```
    pub fn normalisation(&self, dimension: usize) -> Option<Radical> {
        let profile = self.polynomial()?;
        let surface = int([2, 2, 4][dimension - 1]);
        let pi_power = if dimension == 1 { 0 } else { -1 };
        Some(Radical::pi_power(pi_power).scale(&(int(1) / (surface * radial_moment(profile, dimension - 1)))))
    }

    /// σ_D, enclosed.
    pub fn enclose_normalisation(&self, dimension: usize, bits: u32) -> Enclosure {
        match self.normalisation(dimension) {
            Some(sigma) => sigma.enclose(bits),
            None => gaussian::normalisation(dimension, bits),
        }
    }

    /// β: the largest integer such that w and its derivatives up to the β-th vanish at R (−1 if w itself does not).
    pub fn beta(&self) -> i64 {
        // A polynomial that joins zero smoothly to all orders is zero, so the last jump exists.
        self.jumps().last().and_then(|jump| jump.order).map_or(i64::MAX, |order| order as i64 - 1)
    }

    /// The lowest odd power of q in the first piece: where |r| is not smooth at the origin. `None` if w is even there.
    pub fn first_odd_power(&self) -> Option<usize> {
        self.polynomial()?.pieces()[0].first_odd_power()
    }

    /// The order of the lowest derivative that jumps at each knot but the origin, the last one being R.
    pub fn jumps(&self) -> Vec<Jump> {
        match &self.profile {
            Profile::Polynomial(profile) => (1..profile.knots().len())
                .map(|k| Jump { at: profile.knots()[k].clone(), order: profile.jump_order(k) })
                .collect(),
            Profile::Gaussian { cut } => vec![Jump { at: cut.clone(), order: Some(0) }],
        }
    }

    /// G_k, k = 0, 1, 2, ….
    pub fn radial_function(&self, k: usize) -> RadialFunction {
        match &self.profile {
            Profile::Polynomial(profile) => RadialFunction::Pieces(radial_pieces(profile, k)),
            Profile::Gaussian { .. } => RadialFunction::Gaussian { factor: (-2_i64).pow(k as u32) },
        }
    }
}

/// ∫ w(q) q^power dq over the support.
pub(super) fn radial_moment(profile: &Piecewise, power: usize) -> Rational {
    profile.times(&Polynomial::monomial(int(1), power)).integrate()
}

/// The pieces of G_k (see [`RadialPiece`]).
///
/// With N_0 = w, N_1 = w′ and N_{k+1} = q N_k′ − (2k − 1) N_k, G_k = N_k / q^{2k−1} for k ≥ 1.
pub(super) fn radial_pieces(profile: &Piecewise, k: usize) -> Vec<RadialPiece> {
    let knots = profile.knots();
    let pieces = profile.pieces().iter().enumerate();
    pieces
        .map(|(index, w)| {
            let (mut numerator, mut power) = (w.clone(), 0);
            for step in 0..k {
                let derivative = numerator.derivative();
                if step == 0 {
                    (numerator, power) = (derivative, 1);
                } else {
                    numerator = &(&Polynomial::monomial(int(1), 1) * &derivative)
                        - &numerator.scale(&int(power as i64));
                    power += 2;
                }
            }
            let lowest = numerator.coefficients().iter().position(|c| !c.is_zero()).unwrap_or(0).min(power);
            let numerator = Polynomial::new(numerator.coefficients().iter().skip(lowest).cloned().collect());
            RadialPiece {
                from: knots[index].clone(),
                to: knots[index + 1].clone(),
                denominator_power: if numerator.is_zero() { 0 } else { power - lowest },
                numerator,
            }
        })
        .collect()
}
