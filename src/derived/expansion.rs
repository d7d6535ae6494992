//! An operator's expansion about particle i, order by order: ⟨Lu⟩_i = Σ_m C_m ⋮ ∇^m u|_i.

use super::DeriveError;
use super::algebra::{Expression, Factor, Index, Symbol, Term};
use super::arrangement::Arrangement;
use super::build::{Substitute, build};
use super::evaluate::Evaluation;
use super::normal::{difference, normalised};
use crate::exact::{MultiIndex, Number, Order, Rational, int};
use crate::language::ground::Ground;
use crate::language::tree::OfParticle;
use crate::language::{Derivative, Field, Operator, Target};
use crate::particles::PointGroup;

/// The highest order that an expansion is taken to.
pub const MOST_ORDER: usize = 8;

/// The arrangements on which a coefficient is tried before nothing is said about it.
const TRIALS: i64 = 3;

/// What multiplies ∇^m u.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OrderTerms {
    /// m.
    pub order: usize,
    /// C_m.
    pub(super) approximation: Expression,
    /// C_m minus the target's: the truncation error.
    pub(super) error: Expression,
}

/// The expansion of one operator.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The operator.
    pub operator: Operator,
    /// What it approximates, if that is known.
    pub target: Option<Target>,
    /// By order, from 0.
    pub orders: Vec<OrderTerms>,
}

/// A term of an expansion that vanishes on a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VanishingTerm {
    /// A sum over the neighbours of i that no rotation or reflection of the site leaves as it is.
    ByThePointGroup,
    /// An odd number of separations, and inversion at the site.
    ByInversion,
}

impl Expansion {
    /// Expands an operator to order `to`.
    ///
    /// # Errors
    /// [`DeriveError`].
    ///
    /// # Examples
    /// ```
    /// use remainder::{derived::Expansion, exact::Order, language::operators};
    /// let f4 = operators::by_id("F4").unwrap();
    /// let expansion = Expansion::of(f4.operator().unwrap(), Some(f4.target), 3).unwrap();
    /// assert_eq!(expansion.consistency(2).unwrap(), Some(Order::Exactly(1)));
    /// ```
    pub fn of(operator: Operator, target: Option<Target>, to: usize) -> Result<Self, DeriveError> {
        if to > MOST_ORDER {
            return Err(DeriveError::Order { order: to, most: MOST_ORDER });
        }
        let mut orders = Vec::with_capacity(to + 1);
        for order in 0..=to {
            let approximation = normalised(build(&operator, Substitute::Taylor(order))?)?;
            let error = match &target {
                Some(target) if usize::from(target.order()) == order => {
                    difference(&approximation, &target_expression(target, operator.field))?
                }
                _ => approximation.clone(),
            };
            orders.push(OrderTerms { order, approximation, error });
        }
        Ok(Self { operator, target, orders })
    }

    /// The expansion that has this tensor as its one coefficient: the first `order` indices belong to ∇^m u, the others to
    /// a value of rank `rank`.
    ///
    /// # Errors
    /// [`DeriveError`].
    pub fn given(tensor: Operator, field: Field, order: usize, rank: u8) -> Result<Self, DeriveError> {
        let mut expression = build(&tensor, Substitute::Itself)?;
        let found = expression.free.len();
        if found != order + usize::from(rank) {
            return Err(DeriveError::Rank { found, wanted: order + usize::from(rank) });
        }
        let contracted: Vec<Index> = expression.free.drain(..order).collect();
        let derivative = Factor::new(Symbol::Derivative(field), &[], &contracted);
        let expression = normalised(expression.map(|term| term.factors.push(derivative.clone())))?;
        let empty = Expression { free: expression.free.clone(), terms: Vec::new() };
        let orders = (0..=order).map(|m| {
            let own = if m == order { expression.clone() } else { empty.clone() };
            OrderTerms { order: m, approximation: own.clone(), error: own }
        });
        let mut operator = tensor;
        operator.field = field;
        operator.root.rank = rank;
        Ok(Self { orders: orders.collect(), operator, target: None })
    }

    /// The error of one order minus that of another expansion.
    ///
    /// # Errors
    /// [`DeriveError`].
    pub fn minus(&self, other: &Self, order: usize) -> Result<Self, DeriveError> {
        let left = difference(&self.order(order)?.error, &other.order(order)?.error)?;
        let mut rest = self.clone();
        rest.orders[order] = OrderTerms { order, approximation: left.clone(), error: left };
        Ok(rest)
    }

    /// The degree up to which polynomials are taken exactly, on every arrangement of particles: proved by coefficients that
    /// vanish identically, and exact where the next one is shown not to vanish. None if not even constants are.
    ///
    /// # Errors
    /// [`DeriveError`] if a coefficient has no value.
    pub fn consistency(&self, dimension: usize) -> Result<Option<Order>, DeriveError> {
        for terms in &self.orders {
            if terms.error.is_zero() {
                continue;
            }
            let below = terms.order.checked_sub(1).map(|order| order as u32);
            let shown = self.is_shown(terms.order, dimension)?;
            return Ok(match (below, shown) {
                (None, _) => None,
                (Some(order), true) => Some(Order::Exactly(order)),
                (Some(order), false) => Some(Order::AtLeast(order)),
            });
        }
        Ok(self.orders.last().map(|terms| Order::AtLeast(terms.order as u32)))
    }

    /// Whether the error's coefficient of ∇^m u is not zero on some arrangement of rational particles.
    fn is_shown(&self, order: usize, dimension: usize) -> Result<bool, DeriveError> {
        for trial in 0..TRIALS {
            let ground = Arrangement::new(dimension, trial);
            // Where distances or π are not rational, floating point shows it: what is left is no rounding.
            match self.error_at::<Rational>(&ground, 0, order) {
                Ok(values) if values.iter().flatten().flatten().any(|value| !value.is_nought()) => {
                    return Ok(true);
                }
                Ok(_) => {}
                Err(DeriveError::NoValue { .. }) => {
                    let values = self.error_at::<f64>(&ground, 0, order)?;
                    if values.iter().flatten().flatten().any(|value| value.abs() > 1e-6) {
                        return Ok(true);
                    }
                }
                Err(error) => return Err(error),
            }
        }
        Ok(false)
    }

    /// What multiplies ∂_α u at particle `i`, for each α of order m ([`MultiIndex::all`]): by component of the field, then of
    /// the value.
    ///
    /// # Errors
    /// [`DeriveError`] if it has no value there, or the order is beyond the expansion.
    pub fn coefficients_at<T: Number>(
        &self,
        ground: &dyn Ground<T>,
        i: usize,
        order: usize,
    ) -> Result<Vec<Vec<Vec<T>>>, DeriveError> {
        let terms = self.order(order)?;
        self.values(&terms.approximation, ground, i, order)
    }

    /// The same of the truncation error.
    ///
    /// # Errors
    /// As [`Expansion::coefficients_at`].
    pub fn error_at<T: Number>(
        &self,
        ground: &dyn Ground<T>,
        i: usize,
        order: usize,
    ) -> Result<Vec<Vec<Vec<T>>>, DeriveError> {
        let terms = self.order(order)?;
        self.values(&terms.error, ground, i, order)
    }

    /// C_m.
    pub(super) fn approximation(&self, order: usize) -> Result<&Expression, DeriveError> {
        Ok(&self.order(order)?.approximation)
    }

    fn order(&self, order: usize) -> Result<&OrderTerms, DeriveError> {
        let most = self.orders.len().saturating_sub(1);
        self.orders.get(order).ok_or(DeriveError::Order { order, most })
    }

    fn values<T: Number>(
        &self,
        expression: &Expression,
        ground: &dyn Ground<T>,
        i: usize,
        order: usize,
    ) -> Result<Vec<Vec<Vec<T>>>, DeriveError> {
        let d = ground.dimension();
        let vector = self.operator.field == Field::Vector;
        let components = if vector { d } else { 1 };
        let size = d.pow(u32::from(self.operator.rank()));
        let full = Evaluation::new(ground).at(expression, i, order)?;
        let all = MultiIndex::all(d, order as u8)?;
        let mut values = vec![vec![vec![T::nought(); size]; components]; all.len()];
        if full.is_empty() {
            return Ok(values);
        }
        // ∂_α stands once for every order of its indices.
        let derivatives = d.pow(order as u32);
        for out in 0..size {
            for at in 0..derivatives {
                let mut powers = [0; 3];
                let mut rest = at;
                for _ in 0..order {
                    powers[rest % d] += 1;
                    rest /= d;
                }
                let alpha = all.iter().position(|known| known.powers == powers).unwrap_or(0);
                for component in 0..components {
                    let value = full[(out * derivatives + at) * components + component].clone();
                    let sum = &mut values[alpha][component][out];
                    *sum = sum.clone() + value;
                }
            }
        }
        Ok(values)
    }

    /// Whether the error's coefficient of ∇^m u vanishes identically.
    pub fn vanishes(&self, order: usize) -> bool {
        self.orders.get(order).is_some_and(|terms| terms.error.is_zero())
    }

    /// By term of the error of order m: whether it vanishes at the sites of a lattice, and why.
    pub fn vanishing(&self, order: usize, group: &PointGroup) -> Vec<Option<VanishingTerm>> {
        let Some(terms) = self.orders.get(order) else { return Vec::new() };
        terms.error.terms.iter().map(|term| vanishing(term, group)).collect()
    }

    /// Whether every term of the error of order m vanishes at the sites of a lattice.
    pub fn vanishes_on(&self, order: usize, group: &PointGroup) -> bool {
        self.vanishing(order, group).iter().all(Option::is_some)
    }
}

fn vanishing(term: &Term, group: &PointGroup) -> Option<VanishingTerm> {
    let separations = |factors: &[&Factor]| factors.iter().filter(|f| f.symbol == Symbol::Separation).count();
    for bound in term.bounds.iter().filter(|bound| bound.centre == 0) {
        let places = term.naming(bound.particle);
        let factors: Vec<&Factor> = places.iter().map(|place| &term.factors[*place]).collect();
        let alone = term.bounds.iter().all(|other| other.centre != bound.particle)
            && factors.iter().all(|factor| {
                let radial = factor.indices.is_empty() || factor.symbol == Symbol::Separation;
                radial && factor.particles.iter().all(|label| *label == 0 || *label == bound.particle)
            });
        if alone && !has_invariant(group, separations(&factors)) {
            return Some(VanishingTerm::ByThePointGroup);
        }
    }
    let all: Vec<&Factor> = term.factors.iter().collect();
    // Inversion at i carries the whole lattice onto itself, and turns every separation.
    (group.has_inversion() && separations(&all) % 2 == 1).then_some(VanishingTerm::ByInversion)
}

/// Whether some homogeneous polynomial of this degree is left as it is by the group.
fn has_invariant(group: &PointGroup, degree: usize) -> bool {
    let dimension = group.dimension();
    let monomials = MultiIndex::all(dimension, degree as u8).unwrap_or_default();
    monomials.iter().any(|monomial| !group.mean(monomial).is_zero())
}

/// The target as an expression, its value's indices free and in order.
fn target_expression(target: &Target, field: Field) -> Expression {
    let vector = field == Field::Vector;
    let factors = |own: Index, derivatives: &[Index]| {
        let indices = if vector { [derivatives, &[own]].concat() } else { derivatives.to_vec() };
        let mut factors = vec![Factor::new(Symbol::Derivative(field), &[], &indices)];
        for (quantity, power) in
            [(OfParticle::Density, target.density), (OfParticle::Viscosity, target.viscosity)]
        {
            if power != 0 {
                factors.push(Factor::new(Symbol::OfParticle(quantity), &[0], &[]).raised(power));
            }
        }
        factors
    };
    let c = i64::from(target.factor);
    let term = |scale: i64, factors| Term::new(int(c * scale), factors);
    // Indices 1 and on; 9 is summed over.
    let (free, terms) = match target.derivative {
        Derivative::Value => (if vector { vec![1] } else { Vec::new() }, vec![term(1, factors(1, &[]))]),
        Derivative::Gradient => {
            let free = if vector { vec![1, 2] } else { vec![2] };
            (free, vec![term(1, factors(1, &[2]))])
        }
        Derivative::Divergence => (Vec::new(), vec![term(1, factors(9, &[9]))]),
        Derivative::Hessian => {
            let free = if vector { vec![1, 2, 3] } else { vec![2, 3] };
            (free, vec![term(1, factors(1, &[2, 3]))])
        }
        Derivative::Laplacian { grad_div } => {
            let free = if vector { vec![1] } else { Vec::new() };
            let mut terms = vec![term(1, factors(1, &[9, 9]))];
            if vector && grad_div != 0 {
                terms.push(term(i64::from(grad_div), factors(9, &[1, 9])));
            }
            (free, terms)
        }
    };
    Expression { free, terms }
}
