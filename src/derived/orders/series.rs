//! The values of a deviation by its terms: at one R/Δ, at most, and where it crosses zero.

use super::oscillation::{Ingredients, Oscillation, extremes, monomials, turns};
use super::regular::{ComponentOrder, RegularOrder, Term};
use super::spheres::Spheres;
use crate::derived::DeriveError;
use crate::exact::{Rational, rational_to_f64};
use std::f64::consts::PI;

/// The relative rounding error of a sum over shells.
const ROUNDING: f64 = 1e-13;

/// Further terms are below this part of the leading one in the asymptotic regime.
const ASYMPTOTIC: f64 = 0.1;

/// Steps of R/Δ between which a crossing is looked for.
const STEP: f64 = 1.0 / 128.0;

/// S − continuum limit of one component, in units of h^{p−q}.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// The component.
    pub component: String,
    /// The sum of the terms kept.
    pub value: f64,
    /// What the shells left out and rounding may add (bounded), and the terms left out (by those of the next power).
    pub radius: f64,
}

/// The supremum over R/Δ of what multiplies the leading power of Δ/h: of all terms that tie, interfering. In h^{p−q}.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// The supremum of the modulus.
    pub value: f64,
    /// A bound of its error.
    pub radius: f64,
}

/// A sign that is not certain within this of a zero is none to speak of.
const FARTHEST: f64 = 0.25;

/// An R/Δ at which a deviation crosses zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// R/Δ.
    pub support_over_dx: f64,
    /// At this distance on both sides the sign is certain: the deviation exceeds its radius.
    pub radius: f64,
}

/// The shells, and what each term makes of them; by component and term, none for a term of the origin.
#[derive(Debug, Clone)]
pub(super) struct Series {
    spheres: Spheres,
    oscillations: Vec<Vec<Option<Oscillation>>>,
}

impl RegularOrder {
    fn series(&self) -> &Series {
        self.series.get_or_init(|| {
            let terms = || self.components.iter().flat_map(|component| &component.terms);
            let polynomials =
                terms().filter_map(|term| term.wave.as_ref().map(|(_, _, polynomial)| polynomial));
            let spheres = Spheres::gather(&self.reciprocal, &monomials(polynomials));
            let components = self.components.iter();
            let oscillations = components
                .map(|component| {
                    component.terms.iter().map(|term| self.oscillation(&spheres, component, term)).collect()
                })
                .collect();
            Series { spheres, oscillations }
        })
    }

    fn oscillation(&self, spheres: &Spheres, component: &ComponentOrder, term: &Term) -> Option<Oscillation> {
        let (index, order, polynomial) = term.wave.as_ref()?;
        let (d, knot) = (self.lattice.dimension(), &self.singular.knots[*index]);
        let (half, sphere) = ((d as f64 + 1.0) / 2.0, (d as f64 - 1.0) / 2.0);
        let sigma = self.kernel.enclose_normalisation(d, 64).midpoint_f64() * self.singular.factor;
        let factor = sigma * libm::pow(2.0, half) * libm::pow(PI * rational_to_f64(&knot.at), sphere);
        let ingredients = Ingredients {
            knot: *index,
            over_support: &knot.over_support,
            polynomial,
            factor,
            order: *order,
            degree: component.summand.first().map_or(0, |term| term.monomial.order()),
        };
        Some(Oscillation::new(&self.reciprocal, spheres, d, &ingredients))
    }

    /// Δ/h at this R/Δ.
    fn dx_over_h(&self, support_over_dx: f64) -> f64 {
        rational_to_f64(self.kernel.support_over_h()) / support_over_dx
    }

    /// # Errors
    /// [`DeriveError::Diverges`] if the sum over shells of a term does not converge absolutely.
    fn check_convergence(&self) -> Result<(), DeriveError> {
        let diverges = |oscillation: &Oscillation| !oscillation.beyond.is_finite();
        if self.series().oscillations.iter().flatten().flatten().any(diverges) {
            let exponent = self.exponent().map(Rational::to_string).unwrap_or_default();
            return Err(DeriveError::Diverges { moment: self.moment.name(), exponent });
        }
        Ok(())
    }

    /// S − continuum limit of each free component at this R/Δ, by all terms kept, in units of h^{p−q}.
    ///
    /// # Errors
    /// [`DeriveError::Diverges`] if the sum over shells of a term does not converge absolutely: (D + 1)/2 + m − q ≤ D in
    /// two and three dimensions.
    ///
    /// # Examples
    /// ```
    /// use remainder::{derived::RegularOrder, kernel, particles::lattice_by_id, sums::Moment};
    /// let (kernel, line) = (kernel::by_id("wendland-c2").unwrap(), lattice_by_id("line").unwrap());
    /// let order = RegularOrder::of(&kernel, &line, Moment::b_inverse()).unwrap();
    /// // B⁻¹ = 2976/3125 at R/Δ = 5/2, see `LatticeSums`.
    /// let deviation = &order.at(2.5).unwrap()[0];
    /// assert!((1.0 + deviation.value - 2976.0 / 3125.0).abs() <= deviation.radius);
    /// ```
    pub fn at(&self, support_over_dx: f64) -> Result<Vec<Deviation>, DeriveError> {
        self.check_convergence()?;
        Ok(self.sum(support_over_dx, &self.kept))
    }

    /// The same with the terms of the leading exponent of each component alone; the radius is that of the shells and of
    /// rounding.
    ///
    /// # Errors
    /// As [`RegularOrder::at`].
    pub fn leading_at(&self, support_over_dx: f64) -> Result<Vec<Deviation>, DeriveError> {
        self.check_convergence()?;
        let all = self.components.iter().enumerate().map(|(index, component)| {
            let leading = component.leading().cloned().unwrap_or_default();
            self.sum_component(index, support_over_dx, &leading, &self.all_turns(support_over_dx))
        });
        Ok(all.collect())
    }

    fn sum(&self, support_over_dx: f64, kept: &Rational) -> Vec<Deviation> {
        let turns = self.all_turns(support_over_dx);
        (0..self.components.len())
            .map(|index| {
                let mut sum = self.sum_component(index, support_over_dx, kept, &turns);
                sum.radius += self.left_out(index, self.dx_over_h(support_over_dx));
                sum
            })
            .collect()
    }

    fn all_turns(&self, support_over_dx: f64) -> Vec<Vec<(f64, f64)>> {
        let knots = self.singular.knots.iter();
        knots.map(|knot| turns(&self.series().spheres, &knot.over_support, support_over_dx)).collect()
    }

    fn sum_component(
        &self,
        index: usize,
        support_over_dx: f64,
        kept: &Rational,
        turns: &[Vec<(f64, f64)>],
    ) -> Deviation {
        let component = &self.components[index];
        let epsilon = self.dx_over_h(support_over_dx);
        let (mut value, mut radius) = (0.0, 0.0);
        let terms = component.terms.iter().zip(&self.series().oscillations[index]);
        for (term, oscillation) in terms.filter(|(term, _)| term.exponent <= *kept) {
            let power = libm::pow(epsilon, rational_to_f64(&term.exponent));
            if let Some(amplitude) = &term.amplitude {
                value += amplitude.value * power;
                radius += (amplitude.radius + amplitude.value.abs() * ROUNDING) * power;
            }
            if let Some(oscillation) = oscillation {
                value += oscillation.at(support_over_dx, &turns[oscillation.knot]) * power;
                radius += (oscillation.beyond + oscillation.bound * ROUNDING) * power;
            }
        }
        Deviation { component: component.name.clone(), value, radius }
    }

    /// The terms of the next power, in modulus.
    fn left_out(&self, index: usize, epsilon: f64) -> f64 {
        let terms = self.components[index].terms.iter().zip(&self.series().oscillations[index]);
        terms
            .filter(|(term, _)| term.exponent > self.kept)
            .map(|(term, oscillation)| {
                modulus(term, oscillation) * libm::pow(epsilon, rational_to_f64(&term.exponent))
            })
            .sum()
    }

    /// The envelope of each free component; `None` where the sum over shells does not converge absolutely, so that no
    /// multiple of the leading power bounds the deviation.
    pub fn envelopes(&self) -> Vec<Option<Envelope>> {
        let series = self.series();
        let components = self.components.iter().zip(&series.oscillations);
        components
            .map(|(component, oscillations)| {
                let count = component.leading_terms().count();
                let (mut level, mut radius) = (0.0, 0.0);
                for amplitude in component.terms[..count].iter().filter_map(|term| term.amplitude.as_ref()) {
                    level += amplitude.value;
                    radius += amplitude.radius;
                }
                let waves: Vec<&Oscillation> = oscillations[..count].iter().flatten().collect();
                let (low, high, error) = match waves.as_slice() {
                    [] => (0.0, 0.0, 0.0),
                    waves => extremes(&series.spheres, waves),
                };
                let value = f64::max((level + low).abs(), (level + high).abs());
                value.is_finite().then_some(Envelope { value, radius: radius + error })
            })
            .collect()
    }

    /// By component, the least R/Δ from which on all further terms kept are together, whatever R/Δ, at most a tenth of the
    /// leading terms' envelope. `None` where there is no envelope, or nothing further.
    pub fn asymptotic_from(&self) -> Vec<Option<f64>> {
        let envelopes = self.envelopes().into_iter().enumerate();
        envelopes
            .map(|(index, envelope)| {
                let goal = ASYMPTOTIC * envelope?.value;
                let component = &self.components[index];
                let leading = component.leading()?;
                let further: Vec<(f64, f64)> = component
                    .terms
                    .iter()
                    .zip(&self.series().oscillations[index])
                    .filter(|(term, _)| term.exponent > *leading && term.exponent <= self.kept)
                    .map(|(term, o)| (modulus(term, o), rational_to_f64(&(&term.exponent - leading))))
                    .collect();
                let rest =
                    |epsilon: f64| further.iter().map(|(a, e)| a * libm::pow(epsilon, *e)).sum::<f64>();
                if further.is_empty() || goal <= 0.0 {
                    return None;
                }
                // The rest rises with Δ/h: halve until it is below, then bisect.
                let mut low = 1.0;
                while rest(low) > goal {
                    low /= 2.0;
                }
                while rest(2.0 * low) <= goal {
                    low *= 2.0;
                }
                let mut high = 2.0 * low;
                for _ in 0..40 {
                    let middle = (low + high) / 2.0;
                    *(if rest(middle) <= goal { &mut low } else { &mut high }) = middle;
                }
                Some(rational_to_f64(self.kernel.support_over_h()) / low)
            })
            .collect()
    }

    /// By component, the R/Δ between `from` and `to` at which the deviation, by all terms kept, crosses zero: an error
    /// measured there is smaller than its order says.
    ///
    /// # Errors
    /// As [`RegularOrder::at`].
    pub fn zero_crossings(&self, from: f64, to: f64) -> Result<Vec<Vec<Crossing>>, DeriveError> {
        self.check_convergence()?;
        let mut crossings: Vec<Vec<Crossing>> = vec![Vec::new(); self.components.len()];
        let place = |step: usize| (from + step as f64 * STEP).min(to);
        let mut before = self.sum(from, &self.kept);
        for step in 0..((to - from) / STEP).ceil() as usize {
            let after = self.sum(place(step + 1), &self.kept);
            for (index, found) in crossings.iter_mut().enumerate() {
                if (before[index].value < 0.0) != (after[index].value < 0.0) {
                    let crossing = self.crossing(index, place(step), place(step + 1));
                    // Rounding may cross a flat zero more than once.
                    let again = |last: &Crossing| {
                        crossing.is_some_and(|c| {
                            c.support_over_dx - last.support_over_dx <= last.radius + c.radius
                        })
                    };
                    if !found.last().is_some_and(again) {
                        found.extend(crossing);
                    }
                }
            }
            before = after;
        }
        Ok(crossings)
    }

    /// The crossing between two places at which a component has different signs, and how far from it the sign is certain;
    /// `None` if it is the same on both sides, as where a spline reproduces polynomials.
    fn crossing(&self, index: usize, mut low: f64, mut high: f64) -> Option<Crossing> {
        let at = |u: f64| self.sum(u, &self.kept).swap_remove(index);
        let negative = at(low).value < 0.0;
        for _ in 0..24 {
            let middle = (low + high) / 2.0;
            *(if (at(middle).value < 0.0) == negative { &mut low } else { &mut high }) = middle;
        }
        let zero = (low + high) / 2.0;
        let certain = |u: f64| {
            let deviation = at(u);
            (deviation.value.abs() > deviation.radius).then_some(deviation.value < 0.0)
        };
        let mut radius = 1e-6;
        while radius < FARTHEST {
            if let (Some(left), Some(right)) = (certain(zero - radius), certain(zero + radius)) {
                return (left != right).then_some(Crossing { support_over_dx: zero, radius });
            }
            radius *= 2.0;
        }
        // The sum is not certain of any sign nearby.
        None
    }
}

/// A bound of what multiplies the power of Δ/h.
fn modulus(term: &Term, oscillation: &Option<Oscillation>) -> f64 {
    let level = term.amplitude.as_ref().map_or(0.0, |amplitude| amplitude.value.abs());
    level + oscillation.as_ref().map_or(0.0, |oscillation| oscillation.bound)
}
