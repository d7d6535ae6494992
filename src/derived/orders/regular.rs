//! The orders of a moment sum on a regular lattice, term by term.

use super::epstein::{twice_zeta_at_minus, zeta};
use super::series::Series;
use super::singular::Singular;
use super::spheres::Reciprocal;
use super::tail::{Spherical, Symmetry, falling, of_knot, of_power};
use crate::derived::DeriveError;
use crate::exact::{Coefficient, Rational, Truth, int, ratio, rational_to_f64};
use crate::kernel::{Kernel, SummandTerm};
use crate::particles::Lattice;
use crate::sums::{Moment, Reduction};
use num_traits::{ToPrimitive, Zero};
use std::sync::OnceLock;

/// Bits of a continuum limit that has no closed form.
const BITS: u32 = 96;

/// Terms up to this many powers of Δ/h above the leading one are kept; those of the next power tell what is left out.
pub(super) const KEPT: i64 = 6;

/// Where the kernel is not smooth, and how.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// An odd power of r at the origin.
    Origin {
        /// s.
        power: usize,
    },
    /// A knot.
    Knot {
        /// Its place over R.
        at: Rational,
        /// m, the lowest derivative that jumps there.
        jump: usize,
    },
}

impl Source {
    /// Whether what it adds oscillates with R/Δ.
    pub fn oscillates(&self) -> bool {
        matches!(self, Self::Knot { .. })
    }
}

/// A power of Δ/h in a moment sum's deviation, and where it comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contribution {
    /// Where the kernel is not smooth.
    pub source: Source,
    /// The exponent of Δ/h.
    pub exponent: Rational,
}

/// What multiplies a power of Δ/h that does not oscillate, in units of h^{p−q}.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    /// The value.
    pub value: f64,
    /// A bound of its error.
    pub radius: f64,
    /// The same exactly, where it has a closed form: on a line, by ζ at negative odd numbers.
    pub exact: Option<Rational>,
}

/// A term of one component.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Where the kernel is not smooth.
    pub source: Source,
    /// The exponent of Δ/h.
    pub exponent: Rational,
    /// The amplitude of an origin term; what a knot adds oscillates and has an [`super::Envelope`].
    pub amplitude: Option<Amplitude>,
    /// Which knot, N and P, of [`of_knot`].
    pub(super) wave: Option<(usize, usize, Spherical)>,
}

/// One free component of a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentOrder {
    /// `""`, `x`, `xx`, `xxxy`.
    pub name: String,
    /// In how many places of the full tensor it stands, with all that equal it.
    pub multiplicity: u64,
    /// Its continuum limit, in h^{p−q}.
    pub limit: Coefficient,
    /// Its terms, exponents rising.
    pub terms: Vec<Term>,
    pub(super) summand: Vec<SummandTerm>,
}

impl ComponentOrder {
    /// The least exponent of its deviation.
    pub fn leading(&self) -> Option<&Rational> {
        self.terms.first().map(|term| &term.exponent)
    }

    /// The terms of the least exponent: more than one where contributions tie and interfere.
    pub fn leading_terms(&self) -> impl Iterator<Item = &Term> {
        self.terms.iter().take_while(|term| term.exponent == self.terms[0].exponent)
    }
}

/// The deviation S − continuum limit of a moment sum with constant volumes at a particle of a regular lattice, as a
/// function of Δ/h at fixed h: Σ (amplitude) (Δ/h)^e, derived in [`crate::derived::orders`].
///
/// # Examples
/// ```
/// use remainder::{derived::RegularOrder, exact::ratio, kernel, particles::lattice_by_id, sums::Moment};
/// let (kernel, square) = (kernel::by_id("wendland-c2").unwrap(), lattice_by_id("square").unwrap());
/// let order = RegularOrder::of(&kernel, &square, Moment::b_inverse()).unwrap();
/// // The edge, (D + 1)/2 + m − q with m = 4, before the origin, D + s + p − q with s = 3; β + 1 is 4.
/// assert_eq!(order.exponent(), Some(&ratio(9, 2)));
/// ```
#[derive(Debug, Clone)]
pub struct RegularOrder {
    /// The moment.
    pub moment: Moment,
    /// What the free components are made of, exponents rising. Empty if S vanishes by symmetry.
    pub contributions: Vec<Contribution>,
    /// The components that symmetry leaves, in the order of [`Moment::components`].
    pub components: Vec<ComponentOrder>,
    pub(super) kernel: Kernel,
    pub(super) lattice: Lattice,
    pub(super) reciprocal: Reciprocal,
    pub(super) singular: Singular,
    /// Terms of higher exponents are not part of sums, they only tell what is left out.
    pub(super) kept: Rational,
    pub(super) series: OnceLock<Series>,
}

impl RegularOrder {
    /// Derives the orders of `moment`.
    ///
    /// # Errors
    /// [`DeriveError::SingularSummand`] if ∇^q W is singular at the origin.
    pub fn of(kernel: &Kernel, lattice: &Lattice, moment: Moment) -> Result<Self, DeriveError> {
        let mut symmetry = Symmetry::of(lattice);
        let dimension = lattice.dimension();
        let least = formal_exponent(kernel, dimension, moment)?;
        let kept = &least + int(KEPT);
        let last = &kept + int(1);
        let orders = (&last - ratio(dimension as i64 + 1, 2)).floor().to_integer().to_usize().unwrap_or(0);
        let singular = Singular::of(kernel, usize::from(moment.derivatives()) + orders);
        let reciprocal = Reciprocal::of(lattice);
        let reduction = Reduction::of(moment, lattice, symmetry.group());
        let mut components = Vec::new();
        for component in reduction.free() {
            let mut terms = Vec::new();
            for (s, coefficient) in &singular.odd_powers {
                let exponent = int(dimension as i64 + *s as i64 + i64::from(moment.length_power()));
                if exponent <= last && symmetry.keeps(&of_power(*s, &component.terms)) {
                    let amplitude =
                        origin_amplitude(kernel, lattice, &reciprocal, *s, coefficient, &component.terms);
                    let source = Source::Origin { power: *s };
                    terms.push(Term { source, exponent, amplitude: Some(amplitude), wave: None });
                }
            }
            for (index, knot) in singular.knots.iter().enumerate() {
                for order in 0..=orders {
                    let polynomial = of_knot(knot, dimension, &component.terms, order);
                    if symmetry.keeps(&polynomial) {
                        terms.push(Term {
                            source: Source::Knot { at: knot.over_support.clone(), jump: knot.derivative },
                            exponent: ratio(dimension as i64 + 1, 2) + int(order as i64),
                            amplitude: None,
                            wave: Some((index, order, polynomial)),
                        });
                    }
                }
            }
            terms.sort_by(|a, b| a.exponent.cmp(&b.exponent));
            components.push(ComponentOrder {
                limit: kernel.continuum_limit(dimension, &component.terms, BITS),
                name: component.name,
                multiplicity: component.multiplicity,
                terms,
                summand: component.terms,
            });
        }
        let mut contributions: Vec<Contribution> = components
            .iter()
            .flat_map(|component| &component.terms)
            .filter(|term| term.exponent <= kept)
            .map(|term| Contribution { source: term.source.clone(), exponent: term.exponent.clone() })
            .collect();
        contributions.sort_by(|a, b| (&a.exponent, &a.source).cmp(&(&b.exponent, &b.source)));
        contributions.dedup();
        Ok(Self {
            moment,
            contributions,
            components,
            kernel: kernel.clone(),
            lattice: lattice.clone(),
            reciprocal,
            singular,
            kept,
            series: OnceLock::new(),
        })
    }

    /// Whether S vanishes by the symmetry of the lattice, whatever the kernel and R/Δ: then it has no order.
    pub fn vanishes(&self) -> bool {
        self.components.is_empty()
    }

    /// The exponent of Δ/h of the deviation: the least of all contributions. `None` if S vanishes by symmetry, or has no
    /// deviation.
    pub fn exponent(&self) -> Option<&Rational> {
        self.contributions.first().map(|contribution| &contribution.exponent)
    }

    /// The contributions of the least exponent; more than one where they tie and interfere.
    pub fn leading(&self) -> &[Contribution] {
        let ties = self.contributions.iter().take_while(|c| c.exponent == self.contributions[0].exponent);
        &self.contributions[..ties.count()]
    }

    /// The exponent of Δ/h of |S| itself: 0 if the continuum limit is not zero, else that of the deviation.
    pub fn value_exponent(&self) -> Option<Rational> {
        let all_zero = self.components.iter().all(|component| component.limit.is_zero() == Truth::True);
        if !self.vanishes() && !all_zero { Some(Rational::zero()) } else { self.exponent().cloned() }
    }
}

/// min(D + s + p − q, (D + 1)/2 + max(m − q, 0)) over all knots and odd powers, whatever symmetry makes of it: the order at
/// which a lattice without any answers a disturbance of its own wave length.
///
/// # Errors
/// [`DeriveError::SingularSummand`].
pub(super) fn formal_exponent(
    kernel: &Kernel,
    dimension: usize,
    moment: Moment,
) -> Result<Rational, DeriveError> {
    let q = usize::from(moment.derivatives());
    if let Some(power) = kernel.first_odd_power().filter(|s| *s < q) {
        return Err(DeriveError::SingularSummand {
            moment: moment.name(),
            kernel: kernel.id().to_owned(),
            power,
            derivatives: q,
        });
    }
    let knot = formal_knot(kernel, dimension, moment);
    Ok(formal_origin(kernel, dimension, moment).map_or(knot.clone(), |origin| origin.min(knot)))
}

/// (D + 1)/2 + max(m − q, 0) for the roughest knot.
pub(super) fn formal_knot(kernel: &Kernel, dimension: usize, moment: Moment) -> Rational {
    // The last jump exists: no polynomial but zero joins zero smoothly.
    let roughest = kernel.jumps().iter().filter_map(|jump| jump.order).min().unwrap_or(0);
    let above = roughest.saturating_sub(usize::from(moment.derivatives()));
    ratio(dimension as i64 + 1, 2) + int(above as i64)
}

/// D + s + p − q for the first odd power, if there is one.
pub(super) fn formal_origin(kernel: &Kernel, dimension: usize, moment: Moment) -> Option<Rational> {
    let s = kernel.first_odd_power()?;
    Some(int(dimension as i64 + s as i64 + i64::from(moment.length_power())))
}

/// σ_D w_s ω Σ_t c_t s(s−2)…(s−2k_t+2) Z(μ_t, s − 2k_t).
fn origin_amplitude(
    kernel: &Kernel,
    lattice: &Lattice,
    reciprocal: &Reciprocal,
    s: usize,
    coefficient: &Rational,
    terms: &[SummandTerm],
) -> Amplitude {
    let dimension = lattice.dimension();
    if let Some(exact) = exact_on_a_line(kernel, lattice, s, coefficient, terms) {
        return Amplitude { value: rational_to_f64(&exact), radius: 0.0, exact: Some(exact) };
    }
    let sigma = kernel.enclose_normalisation(dimension, BITS).midpoint_f64();
    let factor =
        sigma * rational_to_f64(coefficient) * lattice.particle_volume().enclose(BITS).midpoint_f64();
    let (value, radius) = terms.iter().fold((0.0, 0.0), |(value, radius), term| {
        let weight = rational_to_f64(&(int(term.coefficient) * falling(s, term.radial)));
        let (z, error) = zeta(lattice, reciprocal, &term.monomial, s as i64 - 2 * term.radial as i64);
        (value + factor * weight * z, radius + (factor * weight).abs() * error)
    });
    Amplitude { value, radius, exact: None }
}

fn exact_on_a_line(
    kernel: &Kernel,
    lattice: &Lattice,
    s: usize,
    coefficient: &Rational,
    terms: &[SummandTerm],
) -> Option<Rational> {
    if lattice.dimension() != 1 || lattice.basis().len() != 1 {
        return None;
    }
    let cell = lattice.particle_volume().as_rational()?;
    let sigma = kernel.normalisation(1)?.as_rational()?;
    let first = terms.first()?;
    // |x|^n at every particle, n the same for all terms.
    let n = s + first.monomial.order() as usize - 2 * first.radial;
    let weight = terms.iter().map(|term| int(term.coefficient) * falling(s, term.radial)).sum::<Rational>();
    let power = num_traits::pow(cell, n + 1);
    Some(sigma * coefficient * weight * power * twice_zeta_at_minus(n))
}
