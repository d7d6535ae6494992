//! From the typed tree of an operator to an expression: the Taylor series in place of the field.
//!
//! u_p = Σ_m 1/m! ((r_p − r_i)·∇)^m u (Fatehi & Manzari 2011, Eq. 14), and r_p − r_i = −Σ r_cq over the sums (c, q) that lead
//! from i to p.

use super::DeriveError;
use super::algebra::{Bound, Expression, Factor, Index, Label, Symbol, Term};
use super::normal::normalised_with;
use crate::exact::{Rational, int};
use crate::language::tree::{Kind, Node, OfPair, Particle};
use crate::language::{Field, Operator};
use num_traits::{One, Zero};
use std::sync::Arc;

/// What stands for the field.
#[derive(Debug, Clone, Copy)]
pub(super) enum Substitute {
    /// The term of order m of its Taylor series about particle i.
    Taylor(usize),
    /// Itself.
    Itself,
}

/// An operator as an expression, not yet normalised. Its free indices are those of its value, in order.
pub(super) fn build(operator: &Operator, substitute: Substitute) -> Result<Expression, DeriveError> {
    let mut builder = Builder {
        substitute,
        field: operator.field,
        labels: vec![0; operator.particles.len()],
        centres: vec![None],
        next_index: 0,
    };
    builder.expression(&operator.root)
}

/// The expression of a text without a field, for tensors that a definition gives.
pub(super) struct Builder {
    substitute: Substitute,
    field: Field,
    /// By particle of the operator.
    labels: Vec<Label>,
    /// By label: the label of its centre.
    centres: Vec<Option<Label>>,
    next_index: Index,
}

impl Builder {
    fn index(&mut self) -> Index {
        self.next_index += 1;
        self.next_index
    }

    fn expression(&mut self, node: &Node) -> Result<Expression, DeriveError> {
        let constant = |value: Rational| Expression::scalar(Term::new(value, Vec::new()));
        let symbol =
            |symbol| Expression::scalar(Term::new(Rational::one(), vec![Factor::new(symbol, &[], &[])]));
        Ok(match &node.kind {
            Kind::Number(value) if value.is_zero() => Expression::default(),
            Kind::Number(value) => constant(value.clone()),
            Kind::Pi => symbol(Symbol::Pi),
            Kind::Dimension => symbol(Symbol::Dimension),
            Kind::SmoothingLength => symbol(Symbol::SmoothingLength),
            Kind::Identity => self.rank_two(Symbol::Delta, &[]),
            Kind::OfParticle(quantity, p) => {
                let factor = Factor::new(Symbol::OfParticle(*quantity), &[self.labels[*p]], &[]);
                Expression::scalar(Term::new(Rational::one(), vec![factor]))
            }
            Kind::Renormalisation(p) => self.rank_two(Symbol::Renormalisation, &[self.labels[*p]]),
            Kind::RenormalisationHat(p) => self.rank_two(Symbol::RenormalisationHat, &[self.labels[*p]]),
            Kind::Field(p) => self.field_at(*p),
            Kind::OfPair(quantity, p, q) => self.pair(*quantity, *p, *q),
            Kind::Add(nodes) => {
                let mut sum = Expression::default();
                for (place, node) in nodes.iter().enumerate() {
                    let next = self.expression(node)?;
                    if place == 0 || sum.is_zero() {
                        sum = next;
                    } else if !next.is_zero() {
                        let free = sum.free.clone();
                        sum.terms.extend(next.with_free(&free).terms);
                    }
                }
                sum
            }
            Kind::Negate(a) => self.expression(a)?.map(|term| term.coefficient = -term.coefficient.clone()),
            Kind::Outer(a, b) => self.product(a, b, 0)?,
            Kind::Contract(a, b, count) => self.product(a, b, usize::from(*count))?,
            Kind::Divide(a, b) => {
                let reciprocal = self.reciprocal(b, 1)?;
                multiplied(&self.expression(a)?, &reciprocal)
            }
            Kind::Power(a, n) if *n < 0 => self.reciprocal(a, n.unsigned_abs() as i32)?,
            Kind::Power(a, n) => {
                let mut product = constant(Rational::one());
                for _ in 0..*n {
                    product = multiplied(&product, &self.expression(a)?);
                }
                product
            }
            Kind::Inverse(a) => {
                let body = self.expression(a)?;
                let (body, particles) = self.closed(body)?;
                self.rank_two(Symbol::Inverse(Arc::new(body)), &particles)
            }
            Kind::Sum { bound, centre, body } => {
                let label = self.centres.len() as Label;
                let centre = self.labels[*centre];
                self.centres.push(Some(centre));
                self.labels[*bound] = label;
                self.expression(body)?.map(|term| term.bounds.insert(0, Bound { particle: label, centre }))
            }
        })
    }

    fn rank_two(&mut self, symbol: Symbol, particles: &[Label]) -> Expression {
        let free = vec![self.index(), self.index()];
        let factor = Factor::new(symbol, particles, &free);
        Expression { free, terms: vec![Term::new(Rational::one(), vec![factor])] }
    }

    /// The sums that lead from i to a particle, outermost first.
    fn path(&self, label: Label) -> Vec<Bound> {
        let mut path = Vec::new();
        let mut particle = label;
        while let Some(centre) = self.centres[usize::from(particle)] {
            path.insert(0, Bound { particle, centre });
            particle = centre;
        }
        path
    }

    fn field_at(&mut self, p: Particle) -> Expression {
        let label = self.labels[p];
        let own: Vec<Index> = if self.field == Field::Vector { vec![self.index()] } else { Vec::new() };
        let order = match self.substitute {
            Substitute::Itself => {
                let factor = Factor::new(Symbol::FieldAt(self.field), &[label], &own);
                return Expression { free: own, terms: vec![Term::new(Rational::one(), vec![factor])] };
            }
            Substitute::Taylor(order) => order,
        };
        let path = self.path(label);
        let indices: Vec<Index> = (0..order).map(|_| self.index()).collect();
        let derivative =
            Factor::new(Symbol::Derivative(self.field), &[], &[indices.clone(), own.clone()].concat());
        let sign = if order % 2 == 0 { int(1) } else { int(-1) };
        let terms = shares(order, path.len()).into_iter().map(|shares| {
            let mut term = Term::new(sign.clone(), vec![derivative.clone()]);
            let mut rest = indices.iter();
            for (step, count) in path.iter().zip(shares) {
                term.coefficient /=
                    Rational::from_integer((1..=count).map(num_bigint::BigInt::from).product());
                for index in rest.by_ref().take(count) {
                    term.factors.push(Factor::new(
                        Symbol::Separation,
                        &[step.centre, step.particle],
                        &[*index],
                    ));
                }
            }
            term
        });
        Expression { free: own, terms: terms.collect() }
    }

    fn pair(&mut self, quantity: OfPair, p: Particle, q: Particle) -> Expression {
        let (p, q) = (self.labels[p], self.labels[q]);
        let pair = [p.min(q), p.max(q)];
        let scalar = |symbol| Factor::new(symbol, &pair, &[]);
        let one = |factor| Expression::scalar(Term::new(Rational::one(), vec![factor]));
        match quantity {
            OfPair::Distance => one(scalar(Symbol::Distance)),
            OfPair::Kernel => one(scalar(Symbol::Kernel)),
            OfPair::Laplacian => one(scalar(Symbol::Laplacian)),
            OfPair::Hessian => self.rank_two(Symbol::Hessian, &pair),
            OfPair::Separation => self.separation(p, q),
            OfPair::Direction => {
                multiplied(&one(scalar(Symbol::Distance).raised(-1)), &self.separation(p, q))
            }
            OfPair::Gradient => multiplied(&one(scalar(Symbol::Slope)), &self.separation(p, q)),
        }
    }

    /// r_p − r_q along the sums: (r_p − r_i) − (r_q − r_i), what they share left out.
    fn separation(&mut self, p: Label, q: Label) -> Expression {
        let index = self.index();
        let (to_p, to_q) = (self.path(p), self.path(q));
        let shared = to_p.iter().zip(&to_q).take_while(|(a, b)| a == b).count();
        let step = |sign: i64, step: &Bound| {
            let factor = Factor::new(Symbol::Separation, &[step.centre, step.particle], &[index]);
            Term::new(int(sign), vec![factor])
        };
        let terms =
            to_p[shared..].iter().map(|s| step(-1, s)).chain(to_q[shared..].iter().map(|s| step(1, s)));
        Expression { free: vec![index], terms: terms.collect() }
    }

    fn product(&mut self, a: &Node, b: &Node, count: usize) -> Result<Expression, DeriveError> {
        let (left, right) = (self.expression(a)?, self.expression(b)?);
        if left.is_zero() || right.is_zero() {
            return Ok(Expression::default());
        }
        let kept = left.free.len() - count;
        let inner = left.free[kept..].to_vec();
        let free = [inner.as_slice(), &right.free[count..]].concat();
        let right = right.with_free(&free);
        let mut product = multiplied(&left, &right);
        product.free = [&left.free[..kept], &right.free[count..]].concat();
        Ok(product)
    }

    /// 1/x^n of a scalar: a monomial where it is one, else a factor of its own.
    fn reciprocal(&mut self, node: &Node, n: i32) -> Result<Expression, DeriveError> {
        match &node.kind {
            Kind::Power(a, m) if *m > 0 => return self.reciprocal(a, n * m),
            Kind::Outer(a, b) => return Ok(multiplied(&self.reciprocal(a, n)?, &self.reciprocal(b, n)?)),
            _ => {}
        }
        let expression = self.expression(node)?;
        // Numbers below are those of particles outside.
        let expression = normalised_with(expression, self.centres.len() as Label)?;
        if expression.is_zero() {
            return Err(DeriveError::DividesByZero { span: node.span.clone() });
        }
        if let [term] = &expression.terms[..] {
            if term.bounds.is_empty() {
                let mut inverse = term.clone();
                let power = (0..n).fold(Rational::one(), |power, _| power * &term.coefficient);
                inverse.coefficient = power.recip();
                inverse.factors.iter_mut().for_each(|factor| factor.power *= -n);
                return Ok(Expression::scalar(inverse));
            }
        }
        let (body, particles) = self.closed(expression)?;
        let factor = Factor::new(Symbol::Reciprocal(Arc::new(body)), &particles, &[]).raised(n);
        Ok(Expression::scalar(Term::new(Rational::one(), vec![factor])))
    }

    /// An expression on its own: normalised, and the particles it does not bind itself.
    fn closed(&self, expression: Expression) -> Result<(Expression, Vec<Label>), DeriveError> {
        let mut outer: Vec<Label> = Vec::new();
        for term in &expression.terms {
            let inner: Vec<Label> = term.bounds.iter().map(|bound| bound.particle).collect();
            let named = term.factors.iter().flat_map(|factor| factor.particles.iter().copied());
            let named = named.chain(term.bounds.iter().map(|bound| bound.centre));
            outer.extend(named.filter(|label| !inner.contains(label)));
        }
        outer.sort_unstable();
        outer.dedup();
        // Inside, the particles are numbered from 0 in their order; what the body binds comes after.
        let place = |label: Label| outer.iter().position(|known| *known == label).map(|place| place as Label);
        let body = expression.map(|term| {
            let bounds: Vec<Label> = term.bounds.iter().map(|bound| bound.particle).collect();
            let inner = |label: Label| {
                let at = bounds.iter().position(|known| *known == label).unwrap_or(0);
                (outer.len() + at) as Label
            };
            let rename = |label: Label| place(label).unwrap_or_else(|| inner(label));
            for bound in &mut term.bounds {
                *bound = Bound { particle: rename(bound.particle), centre: rename(bound.centre) };
            }
            for label in term.factors.iter_mut().flat_map(|factor| &mut factor.particles) {
                *label = rename(*label);
            }
        });
        Ok((normalised_with(body, outer.len() as Label)?, outer))
    }
}

fn multiplied(a: &Expression, b: &Expression) -> Expression {
    let terms = a.terms.iter().flat_map(|left| b.terms.iter().map(|right| left.times(right)));
    Expression { free: [a.free.as_slice(), &b.free].concat(), terms: terms.collect() }
}

/// All ways to write `total` as a sum of `parts` whole numbers.
fn shares(total: usize, parts: usize) -> Vec<Vec<usize>> {
    match parts {
        0 if total == 0 => vec![Vec::new()],
        0 => Vec::new(),
        1 => vec![vec![total]],
        _ => (0..=total)
            .flat_map(|first| {
                shares(total - first, parts - 1)
                    .into_iter()
                    .map(move |rest| [&[first], rest.as_slice()].concat())
            })
            .collect(),
    }
}
