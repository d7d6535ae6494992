//! The kernel type and what is computed from its profile.

use super::KernelError;
use crate::exact::{ExactError, Piecewise, Polynomial, Radical, Rational, int};
use num_traits::{Signed, Zero};

/// A radial kernel W(r, h) = σ_D h^{-D} w(q), q = r/h, with compact support R = `support_over_h` · h.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    id: String,
    name: String,
    citation: String,
    profile: Piecewise,
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
        let kernel =
            Self { id: id.to_owned(), name: name.to_owned(), citation: citation.to_owned(), profile };
        if kernel.profile.pieces().iter().all(Polynomial::is_zero) {
            return Err(KernelError::Zero { id: kernel.id });
        }
        for dimension in 1..=3 {
            if !kernel.radial_moment(dimension - 1).is_positive() {
                return Err(KernelError::NotNormalisable { id: kernel.id, dimension });
            }
        }
        Ok(kernel)
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
    pub fn profile(&self) -> &Piecewise {
        &self.profile
    }

    /// R/h: the last knot.
    pub fn support_over_h(&self) -> &Rational {
        let knots = self.profile.knots();
        &knots[knots.len() - 1]
    }

    /// ∫ w(q) q^power dq over the support.
    pub fn radial_moment(&self, power: usize) -> Rational {
        self.profile.times(&Polynomial::monomial(int(1), power)).integrate()
    }

    /// σ_D = 1 / (S_D ∫ w q^{D−1} dq) with S_1 = 2, S_2 = 2π, S_3 = 4π.
    ///
    /// # Panics
    /// Never for D in 1..=3; other dimensions do not exist in this crate.
    ///
    /// # Examples
    /// ```
    /// // Fatehi & Manzari 2011, Eq. (47): W_0 = 7/(π h²) in two dimensions.
    /// let kernel = remainder::kernel::by_id("wendland-c2").unwrap();
    /// assert_eq!(kernel.normalisation(2).to_string(), "7·π^-1");
    /// ```
    pub fn normalisation(&self, dimension: usize) -> Radical {
        let surface = int([2, 2, 4][dimension - 1]);
        let pi_power = if dimension == 1 { 0 } else { -1 };
        Radical::pi_power(pi_power).scale(&(int(1) / (surface * self.radial_moment(dimension - 1))))
    }

    /// β: the largest integer such that w and its derivatives up to the β-th vanish at R (−1 if w itself does not).
    pub fn beta(&self) -> i64 {
        let last = self.profile.knots().len() - 1;
        // A polynomial that joins zero smoothly to all orders is zero, so the last jump exists.
        self.profile.jump_order(last).map_or(i64::MAX, |order| order as i64 - 1)
    }

    /// The lowest odd power of q in the first piece: where |r| is not smooth at the origin. `None` if w is even there.
    pub fn first_odd_power(&self) -> Option<usize> {
        self.profile.pieces()[0].first_odd_power()
    }

    /// The order of the lowest derivative that jumps at each knot but the origin, the last one being R.
    pub fn jumps(&self) -> Vec<Jump> {
        (1..self.profile.knots().len())
            .map(|k| Jump { at: self.profile.knots()[k].clone(), order: self.profile.jump_order(k) })
            .collect()
    }

    /// The pieces of G_k, k = 0, 1, 2, … (see [`RadialPiece`]).
    ///
    /// With N_0 = w, N_1 = w′ and N_{k+1} = q N_k′ − (2k − 1) N_k, G_k = N_k / q^{2k−1} for k ≥ 1.
    pub fn radial_function(&self, k: usize) -> Vec<RadialPiece> {
        let knots = self.profile.knots();
        self.profile
            .pieces()
            .iter()
            .enumerate()
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
                let lowest =
                    numerator.coefficients().iter().position(|c| !c.is_zero()).unwrap_or(0).min(power);
                let numerator =
                    Polynomial::new(numerator.coefficients().iter().skip(lowest).cloned().collect());
                RadialPiece {
                    from: knots[index].clone(),
                    to: knots[index + 1].clone(),
                    denominator_power: if numerator.is_zero() { 0 } else { power - lowest },
                    numerator,
                }
            })
            .collect()
    }
}
