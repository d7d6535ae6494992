//! The orders of what disorder adds: the root mean square of S − S^reg, as powers of d̃ and Δ/h.
//!
//! For displacements d small against Δ, S − S^reg = Σ_j ω ∇f(r_ij)·(d_i − d_j) + …, with f the summand. What it comes to is
//! decided by how the displacements are correlated:
//!
//! | model | terms | from |
//! | --- | --- | --- |
//! | independent | d̃ (Δ/h)^{D/2} | a random walk over (h/Δ)^D neighbours; ∫ \|∇f\|² |
//! | | d̃ (Δ/h)^{e−1} | d_i Σ ω ∇f, a lattice sum |
//! | `offset` | d̃^n (Δ/h)^{e−n} | the n-th derivative of the lattice sum, n = 1 or, where that vanishes by symmetry, 2 |
//! | | d̃^a (Δ/h)^D | ω (f(0) − f(d)): particle i carries its own term along; a = p + (q mod 2), or 2 for that 0 |
//! | `wave`, λ/h held | d̃ | −∫ f ∇·d, unless the wave is transverse; and the lattice's d̃ (Δ/h)^{e−1} |
//! | `wave`, λ/Δ held | d̃ (Δ/h)^{e−1} | all of it in the tail of f̂ |
//! | `shear` | d̃^n (Δ/h)^{e−n} | each row is a lattice sum in one dimension less; the nearest rows see the origin |
//! | S(k) ~ k^a up to 1/Δ | d̃ (Δ/h)^{(D+a)/2}, d̃ (Δ/h)^{e−1} | ∫ S(k) \|k f̂(k)\|² dk below and at 1/Δ |
//!
//! e is the exponent of the lattice's deviation, symmetry left aside. Where m − q = 0, f itself jumps at a knot: particles
//! that cross it add d̃^{1/2} in place of d̃. A wave held in h can have a length at which f̂ vanishes (Σωrr∇W of Wendland C2 on a
//! line at λ = R): the exponents are those of other lengths. Two terms compare at fixed d̃/Δ, as ladders in either variable do that hold
//! displacements below the spacing.

use super::regular::{formal_exponent, formal_knot, formal_origin};
use super::tail::Symmetry;
use crate::derived::DeriveError;
use crate::exact::{MultiIndex, Rational, int, ratio, rational_text};
use crate::kernel::{Kernel, SummandTerm};
use crate::particles::{Disorder, Lattice, Law, Moves};
use crate::sums::Moment;
use num_traits::Zero;

/// How displacements are correlated.
#[derive(Debug, Clone, PartialEq)]
pub enum Displaced {
    /// Each particle on its own: `box`, `canonical`, `gaussian`.
    Independent,
    /// Particle i alone.
    Offset,
    /// A plane wave.
    Wave {
        /// Whether λ/h is held; else λ/Δ is.
        in_h: bool,
        /// Whether it displaces across its direction.
        transverse: bool,
    },
    /// Rows, in 3-D layers, that slide along the first axis.
    Shear {
        /// Whether each by a random amount; else every other row by the same.
        random: bool,
    },
    /// A random field of spectrum S(k) ~ k^a for k < 1/Δ, of root mean square d̃, not free of divergence.
    Correlated {
        /// a.
        spectral_exponent: Rational,
    },
}

impl Displaced {
    /// What a model of the catalogue is; `None` for `none`.
    pub fn by(disorder: &Disorder) -> Option<Self> {
        Some(match (disorder.entry().moves, disorder.motion().law) {
            (Moves::Nothing, _) => return None,
            (Moves::CentreOnly, _) => Self::Offset,
            (_, Law::Independent(_)) => Self::Independent,
            (_, Law::Wave { in_h, transverse, .. }) => Self::Wave { in_h, transverse },
            (_, Law::Rows) => Self::Shear { random: true },
            (_, Law::AlternateRows) => Self::Shear { random: false },
        })
    }
}

/// d̃^`displacement` h^`h` (Δ/h)^`dx_over_h`.
#[derive(Debug, Clone, PartialEq)]
pub struct DisorderTerm {
    /// The exponent of d̃.
    pub displacement: Rational,
    /// The exponent of h, p − q less that of d̃.
    pub h: Rational,
    /// The exponent of Δ/h at fixed d̃ and h.
    pub dx_over_h: Rational,
    /// Where it comes from.
    pub from: &'static str,
}

/// The orders of the root mean square of S − S^reg under a disorder.
///
/// # Examples
/// ```
/// use remainder::derived::{Displaced, DisorderOrder};
/// use remainder::{exact::{int, ratio}, kernel, particles::lattice_by_id, sums::Moment};
/// let (kernel, cubic) = (kernel::by_id("wendland-c2").unwrap(), lattice_by_id("simple-cubic").unwrap());
/// let moment = Moment::by_name("sum_dw").unwrap();
/// // Fatehi & Manzari 2011, Table 2, print (Δ/h)^{β−1} = (Δ/h)².
/// let order = DisorderOrder::of(&kernel, &cubic, moment, &Displaced::Independent).unwrap();
/// assert_eq!(order.dominant().dx_over_h, ratio(3, 2));
/// assert_eq!(order.dominant().displacement, int(1));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DisorderOrder {
    /// All terms that were found, the dominant one at fixed d̃/Δ first.
    pub terms: Vec<DisorderTerm>,
    /// Which term dominates, in one sentence.
    pub reason: String,
}

impl DisorderOrder {
    /// Derives the orders of `moment` with constant volumes at a particle of `lattice`.
    ///
    /// # Errors
    /// [`DeriveError::SingularSummand`]; [`DeriveError::Spectrum`] for a spectrum with a ≤ −D, whose root mean square is
    /// that of the longest waves; [`DeriveError::DisorderDimension`] for rows or transverse waves in one dimension.
    pub fn of(
        kernel: &Kernel,
        lattice: &Lattice,
        moment: Moment,
        displaced: &Displaced,
    ) -> Result<Self, DeriveError> {
        let d = lattice.dimension();
        let case = Case {
            dimension: d,
            e: formal_exponent(kernel, d, moment)?,
            knot: formal_knot(kernel, d, moment),
            origin: formal_origin(kernel, d, moment),
            // m − q at the roughest knot: how smooth the summand is there.
            smoothness: formal_knot(kernel, d, moment) - ratio(d as i64 + 1, 2),
            lattice,
            moment,
        };
        let terms = match displaced {
            Displaced::Independent => case.spectrum(&int(0), RANDOM_WALK),
            Displaced::Correlated { spectral_exponent } if *spectral_exponent <= int(-(d as i64)) => {
                return Err(DeriveError::Spectrum {
                    exponent: rational_text(spectral_exponent),
                    dimension: d,
                });
            }
            Displaced::Correlated { spectral_exponent } => case.spectrum(spectral_exponent, LONG_WAVES),
            Displaced::Offset => case.offset(),
            Displaced::Wave { in_h, transverse } => {
                case.needs_two_dimensions(*transverse, "a transverse wave")?;
                case.wave(*in_h, *transverse)
            }
            Displaced::Shear { random } => {
                case.needs_two_dimensions(true, "shear")?;
                case.shear(*random)
            }
        };
        let mut order = Self::sorted(terms, moment);
        if case.smoothness.is_zero() && kernel.polynomial().is_none() {
            let square = kernel.support_over_h() * kernel.support_over_h();
            order.reason += &format!(
                "; a Gaussian jumps by exp(−{}) of its height only, which shows at the smallest d̃ alone",
                rational_text(&square)
            );
        }
        Ok(order)
    }

    /// The term that outweighs the others as Δ/h falls at fixed d̃/Δ.
    pub fn dominant(&self) -> &DisorderTerm {
        &self.terms[0]
    }

    /// The rows (d̃, Δ/h, origin of the term) with the least sum of exponents first.
    fn sorted(rows: Vec<Row>, moment: Moment) -> Self {
        let mut terms: Vec<DisorderTerm> = rows
            .into_iter()
            .map(|(displacement, dx_over_h, from)| DisorderTerm {
                h: int(i64::from(moment.length_power())) - &displacement,
                displacement,
                dx_over_h,
                from,
            })
            .collect();
        let together = |term: &DisorderTerm| &term.displacement + &term.dx_over_h;
        terms.sort_by_key(together);
        let first = &terms[0];
        let ties: Vec<&str> =
            terms[1..].iter().filter(|t| together(t) == together(first)).map(|t| t.from).collect();
        let reason = match (terms.get(1), ties.as_slice()) {
            (None, _) => format!("{} alone", first.from),
            (Some(_), [tie, ..]) => format!("{} and {tie} are of the same size at fixed d̃/Δ", first.from),
            (Some(next), []) => format!(
                "{} outweighs {} by (h/Δ)^{} at fixed d̃/Δ",
                first.from,
                next.from,
                rational_text(&(together(next) - together(first)))
            ),
        };
        Self { terms, reason }
    }
}

/// Exponents of d̃ and Δ/h, and where they come from.
type Row = (Rational, Rational, &'static str);

const RANDOM_WALK: &str = "the random walk over the neighbours";
const LONG_WAVES: &str = "the field's waves of length h";
const CROSSING: &str = "the particles that cross the jump of the summand";
const LATTICE: &str = "the lattice's tail";
const EDGES: &str = "the rows' ends at the knots";
const NEAREST_ROWS: &str = "the rows beside the particle's own";
const EVEN_PART: &str = "the even part of the lattice's tail";
const OWN: &str = "the particle's own term";

struct Case<'a> {
    dimension: usize,
    e: Rational,
    knot: Rational,
    origin: Option<Rational>,
    smoothness: Rational,
    lattice: &'a Lattice,
    moment: Moment,
}

impl Case<'_> {
    fn needs_two_dimensions(&self, if_so: bool, what: &'static str) -> Result<(), DeriveError> {
        match if_so && self.dimension < 2 {
            true => Err(DeriveError::DisorderDimension { what, lattice: self.lattice.id().to_owned() }),
            false => Ok(()),
        }
    }

    /// ∫ k^{D−1} d̃² Δ^{D+a} k^a |k f̂(k)|² dk up to 1/Δ, where |f̂| ~ k^{−e}; a = 0 for independent displacements.
    fn spectrum(&self, a: &Rational, from: &'static str) -> Vec<Row> {
        let smooth = (int(1), (int(self.dimension as i64) + a) / int(2), from);
        if self.smoothness.is_zero() {
            return vec![smooth, (ratio(1, 2), ratio(self.dimension as i64, 2), CROSSING)];
        }
        vec![smooth, (int(1), &self.e - int(1), LATTICE)]
    }

    /// d̃^n (Δ/h)^{e−n} of a lattice sum moved rigidly, or by waves of its own length.
    fn moved(&self, n: i64, e: &Rational, from: &'static str) -> Row {
        // Root mean square over R/Δ: Σ_K |K|^{D−1} |K|^{−2e} min(1, |K|d)^{2n} has its weight at |K| ~ 1/d once
        // n > m − q + 1/2.
        let power = int(n).min(&self.smoothness + ratio(1, 2));
        (power.clone(), e - power, from)
    }

    fn offset(&self) -> Vec<Row> {
        let (p, q) = (i64::from(self.moment.positions()), i64::from(self.moment.derivatives()));
        let own = if p == 0 && q % 2 == 0 { 2 } else { p + q % 2 };
        let mut symmetry = Symmetry::of(self.lattice);
        let components = self.moment.components(self.dimension).into_iter();
        let mut gradients = components.flat_map(|c| gradient(&c.terms, self.dimension));
        let n = if gradients.any(|terms| symmetry.keeps_some(&terms)) { 1 } else { 2 };
        let mut rows = vec![self.moved(n, &self.e, LATTICE), (int(own), int(self.dimension as i64), OWN)];
        if n == 1 && (p + q) % 2 == 0 {
            // A site without inversion: what inversion leaves is of the same size at fixed d̃/Δ, and often larger.
            rows.push(self.moved(2, &self.e, EVEN_PART));
        }
        rows
    }

    fn wave(&self, in_h: bool, transverse: bool) -> Vec<Row> {
        if !in_h {
            return vec![self.moved(1, &self.e, LATTICE)];
        }
        // Σ_j ω ∇f·e (1 − e^{−ik·r}): at the origin the bracket is a power of kr, the first or, by inversion, the second.
        let even = (self.moment.positions() + self.moment.derivatives()) % 2 == 0;
        let at_origin = self.origin.as_ref().map(|origin| origin + int(if even { 1 } else { 2 }));
        let least = at_origin.map_or(self.knot.clone(), |origin| origin.min(self.knot.clone()));
        let lattice = self.moved(1, &least, LATTICE);
        if transverse {
            return vec![lattice];
        }
        vec![(int(1), int(0), "the continuum's answer −∫ f ∇·d"), lattice]
    }

    fn shear(&self, random: bool) -> Vec<Row> {
        // Σ of a row of ∂f/∂x vanishes by reflection where f is even in x; coherent rows by inversion where f is even.
        let (p, q) = (self.moment.positions(), self.moment.derivatives());
        let contracted =
            self.moment.components(self.dimension).iter().all(|c| c.name.len() == usize::from(p));
        let rank = if contracted { p } else { p + q };
        let first = if random { rank > 0 } else { rank % 2 == 1 };
        let n = if first { 1 } else { 2 };
        let mut rows = vec![self.moved(n, &self.knot, EDGES)];
        rows.extend(self.origin.as_ref().map(|origin| (int(n), origin - int(n), NEAREST_ROWS)));
        rows
    }
}

/// ∂_a (r^μ G_k) = μ_a r^{μ−a} G_k + r^{μ+a} G_{k+1}, for each axis a.
fn gradient(terms: &[SummandTerm], dimension: usize) -> Vec<Vec<SummandTerm>> {
    let along = |axis: usize| {
        let moved = |monomial: &MultiIndex, up: bool| {
            let mut powers = monomial.powers;
            if up {
                powers[axis] += 1;
            } else {
                powers[axis] -= 1;
            }
            MultiIndex::new(powers)
        };
        let mut all = Vec::new();
        for term in terms {
            let power = i64::from(term.monomial.powers[axis]);
            if power > 0 {
                all.push(SummandTerm {
                    coefficient: term.coefficient * power,
                    monomial: moved(&term.monomial, false),
                    radial: term.radial,
                });
            }
            all.push(SummandTerm {
                coefficient: term.coefficient,
                monomial: moved(&term.monomial, true),
                radial: term.radial + 1,
            });
        }
        all
    };
    (0..dimension).map(along).collect()
}
