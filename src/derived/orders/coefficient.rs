//! The orders of what an operator's expansion multiplies ∇^m u by, from the moment sums that it is made of.
//!
//! A coefficient C_m is a sum of products of sums over neighbours, of B and B̂ among them, each sum a moment Σ ω r^p ∇^q W up to
//! contractions. On a lattice every particle has the same sums, so that a sum inside another is a factor of it. A product whose
//! sums all have a limit deviates from it like the slowest of them; one with a sum that vanishes by symmetry is zero. Under
//! disorder a product answers like its one odd sum, or like any of its even ones.
//!
//! No cancellation between the products is looked for, beyond what the normal form of the expansion has cancelled already.

use super::disorder::{DisorderOrder, DisorderTerm, Displaced};
use super::regular::RegularOrder;
use crate::derived::DeriveError;
use crate::derived::algebra::{Expression, Factor, Label, Symbol, Term};
use crate::derived::displaced::{DisplacedGround, Neighbourhood};
use crate::derived::expansion::Expansion;
use crate::exact::Rational;
use crate::kernel::Kernel;
use crate::language::Coefficient;
use crate::particles::{Lattice, VolumeRule};
use crate::sums::Moment;
use num_traits::Zero;

/// The orders of one coefficient of an expansion on one lattice.
#[derive(Debug, Clone)]
pub struct CoefficientOrder {
    /// By product, its sums. `None` if one of them is no moment, as those with e⊗e are.
    products: Option<Vec<Vec<Moment>>>,
    /// The most derivatives of W in any sum.
    derivatives: u8,
    /// Whether the coefficient without its error, C_m, tends to something else than zero.
    has_limit: bool,
}

/// R/Δ at which a limit is told from zero, twice as fine the second time.
const COARSE: f64 = 6.0;

impl CoefficientOrder {
    /// Reads the coefficient of an operator's expansion.
    ///
    /// # Errors
    /// [`DeriveError`] if the operator has no such coefficient on the lattice.
    pub fn of(coefficient: &Coefficient, kernel: &Kernel, lattice: &Lattice) -> Result<Self, DeriveError> {
        let order = usize::from(coefficient.order());
        let expansion = Expansion::of(coefficient.operator().clone(), coefficient.target().cloned(), order)?;
        let found = expansion.approximation(order)?;
        let mut derivatives = 0;
        let mut products = Some(Vec::new());
        for term in &found.terms {
            match sums_of(term, &mut derivatives) {
                Some(sums) => products.iter_mut().for_each(|all| all.push(sums.clone())),
                None => products = None,
            }
        }
        // S = c + O(Δ/h): what it changes by between the two is more than it still has to go.
        let size = |support: f64| -> Result<f64, DeriveError> {
            let nested = coefficient.is_nested();
            let around = Neighbourhood::new(kernel, lattice, support, VolumeRule::Constant, nested);
            let ground: DisplacedGround<'_, f64> = DisplacedGround::by(&around, &Vec::new(), 0.0);
            let values = expansion.coefficients_at(&ground, ground.centre(), order)?;
            let squares: f64 = values.iter().flatten().flatten().map(|value| value * value).sum();
            let length = coefficient.operator().root.units.length + i32::from(coefficient.order());
            Ok(squares.sqrt() / support.powi(length))
        };
        let [coarse, fine] = [size(COARSE)?, size(2.0 * COARSE)?];
        Ok(Self { products, derivatives, has_limit: fine > 2.0 * (fine - coarse).abs() && fine > 1e-9 })
    }

    /// The exponent of Δ/h of C_m's distance from its limit on the lattice. `None` if it is not known.
    ///
    /// # Errors
    /// As [`RegularOrder::of`].
    pub fn deviation(&self, kernel: &Kernel, lattice: &Lattice) -> Result<Option<Rational>, DeriveError> {
        let mut least: Option<Rational> = None;
        for product in self.products.iter().flatten() {
            let orders: Vec<RegularOrder> = product
                .iter()
                .map(|moment| RegularOrder::of(kernel, lattice, *moment))
                .collect::<Result<_, _>>()?;
            if orders.iter().any(RegularOrder::vanishes) {
                continue;
            }
            for exponent in orders.iter().filter_map(RegularOrder::exponent) {
                least = Some(least.map_or(exponent.clone(), |least| least.min(exponent.clone())));
            }
        }
        Ok(least)
    }

    /// The exponent of Δ/h of C_m itself: 0 if it has a limit, else that of the deviation.
    ///
    /// # Errors
    /// As [`RegularOrder::of`].
    pub fn value(&self, kernel: &Kernel, lattice: &Lattice) -> Result<Option<Rational>, DeriveError> {
        if self.has_limit { Ok(Some(Rational::zero())) } else { self.deviation(kernel, lattice) }
    }

    /// The dominant order of the root mean square of C_m − C_m^reg. `None` if it is not known.
    ///
    /// # Errors
    /// As [`DisorderOrder::of`].
    pub fn disordered(
        &self,
        kernel: &Kernel,
        lattice: &Lattice,
        displaced: &Displaced,
    ) -> Result<Option<(DisorderTerm, String)>, DeriveError> {
        let of = |moment: Moment| DisorderOrder::of(kernel, lattice, moment, displaced);
        if *displaced == Displaced::Independent {
            // Whatever p: the neighbours' random walk.
            let order = of(Moment::new(0, self.derivatives).unwrap_or_default())?;
            return Ok(Some((order.dominant().clone(), order.reason)));
        }
        let is_odd = |moment: &&Moment| (moment.positions() + moment.derivatives()) % 2 == 1;
        let mut rows: Vec<(DisorderTerm, String)> = Vec::new();
        for product in self.products.iter().flatten() {
            let odd: Vec<&Moment> = product.iter().filter(is_odd).collect();
            match odd.as_slice() {
                [] => {
                    for moment in product {
                        let order = of(*moment)?;
                        rows.push((order.dominant().clone(), order.reason));
                    }
                }
                [one] => {
                    let order = of(**one)?;
                    rows.push((order.dominant().clone(), order.reason));
                }
                [one, other] => {
                    let (one, other) = (of(**one)?, of(**other)?);
                    let mut both = one.dominant().clone();
                    both.displacement += &other.dominant().displacement;
                    both.dx_over_h += &other.dominant().dx_over_h;
                    rows.push((both, "two sums that vanish on the lattice, multiplied".into()));
                }
                _ => {}
            }
        }
        Ok(rows.into_iter().min_by_key(|(term, _)| &term.displacement + &term.dx_over_h))
    }
}

/// The sums of a product, and the most derivatives of W in any. `None` if a sum is no moment.
fn sums_of(term: &Term, derivatives: &mut u8) -> Option<Vec<Moment>> {
    let mut sums = Vec::new();
    let mut all_known = true;
    for bound in &term.bounds {
        // A factor of two particles belongs to the one whose sum is inside.
        let depth = |label: Label| term.bounds.iter().position(|bound| bound.particle == label);
        let mine = |factor: &&Factor| {
            factor.particles.iter().copied().max_by_key(|label| depth(*label)) == Some(bound.particle)
        };
        let (mut length, mut q, mut contracted) = (0, None, false);
        for factor in term.factors.iter().filter(mine) {
            match &factor.symbol {
                Symbol::Kernel => q = Some(0),
                Symbol::Slope => {
                    q = Some(1);
                    length -= 2;
                }
                Symbol::Laplacian => {
                    q = Some(2);
                    contracted = true;
                    length -= 2;
                }
                Symbol::Hessian => {
                    q = Some(2);
                    length -= 2;
                }
                Symbol::Separation => length += 1,
                // e⊗e is not smooth at the origin, where W is: another order.
                Symbol::Distance if factor.power % 2 == 0 && factor.power > 0 => length += factor.power,
                Symbol::OfParticle(_) => {}
                Symbol::Renormalisation => sums.push(Moment::b_inverse()),
                _ => all_known = false,
            }
        }
        *derivatives = (*derivatives).max(q.unwrap_or(0));
        let moment = q.and_then(|q| {
            let p = u8::try_from(length + i32::from(q)).ok()?;
            if contracted { Moment::laplacian(p).ok() } else { Moment::new(p, q).ok() }
        });
        match moment {
            Some(moment) => sums.push(moment),
            None => all_known = false,
        }
    }
    for factor in term.factors.iter().filter(|factor| factor.particles.iter().all(|label| *label == 0)) {
        match &factor.symbol {
            Symbol::Renormalisation => {
                *derivatives = (*derivatives).max(1);
                sums.push(Moment::b_inverse());
            }
            Symbol::RenormalisationHat => {
                *derivatives = (*derivatives).max(1);
                all_known = false;
            }
            Symbol::Reciprocal(body) | Symbol::Inverse(body) => {
                all_known &= sums_of_all(body, derivatives, &mut sums);
            }
            _ => {}
        }
    }
    all_known.then_some(sums)
}

/// Adds all sums of an expression; false if one is no moment.
fn sums_of_all(body: &Expression, derivatives: &mut u8, sums: &mut Vec<Moment>) -> bool {
    let each: Vec<Option<Vec<Moment>>> = body.terms.iter().map(|term| sums_of(term, derivatives)).collect();
    sums.extend(each.iter().flatten().flatten());
    each.iter().all(Option::is_some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{int, ratio};
    use crate::{kernel, particles::lattice_by_id};

    fn order(name: &str, m: u8, lattice: &str) -> (CoefficientOrder, Kernel, Lattice) {
        let (kernel, lattice) = (
            kernel::by_id("wendland-c2").unwrap_or_else(|error| unreachable!("{error}")),
            lattice_by_id(lattice).unwrap_or_else(|error| unreachable!("{error}")),
        );
        let coefficient = Coefficient::new(name, m).unwrap_or_else(|error| unreachable!("{error}"));
        let order = CoefficientOrder::of(&coefficient, &kernel, &lattice);
        (order.unwrap_or_else(|error| unreachable!("{error}")), kernel, lattice)
    }

    #[test]
    fn coefficients_have_the_orders_of_their_sums() {
        // Σωr∇W: (D + 1)/2 + m − q = 9/2 on the square lattice, D + s + p − q = 4 on the line; Σωrr∇²W: 2 less.
        for (name, m, lattice, deviation, has_limit) in [
            ("F1", 1, "square", ratio(9, 2), true),
            ("F1", 1, "line", int(4), true),
            ("S3", 2, "square", ratio(9, 2), true),
            ("S2-11", 2, "square", ratio(7, 2), true),
            ("S2-10", 0, "square", int(3), false),
            ("S1-8-F2", 2, "line", int(4), true),
        ] {
            let (order, kernel, site) = order(name, m, lattice);
            assert_eq!(order.deviation(&kernel, &site), Ok(Some(deviation)), "{name} on {lattice}");
            assert_eq!(order.has_limit, has_limit, "{name} on {lattice}");
        }
        assert!(order("F4", 3, "square").0.has_limit && order("S4", 4, "line").0.has_limit);
    }
}
