//! From the typed tree to scalar expressions, one for each component, with every sum as small as it can be made.
//!
//! Components are in row-major order of their indices.

use super::ProgramError;
use super::expression::{Arena, Atom, Expression, Id, System, SystemKind};
use super::kernel::RadialFunctions;
use crate::exact::rational_to_f64;
use crate::language::Field;
use crate::language::tree::{Kind, Node, OfPair, OfParticle, Particle};
use std::collections::BTreeMap;

/// Lowers one operator.
pub(super) struct Lowering<'a> {
    pub(super) arena: Arena,
    pub(super) kernel: &'a RadialFunctions,
    pub(super) dimension: usize,
    /// h/R.
    pub(super) smoothing_length: f64,
}

/// A sum being taken apart: who is summed over, around whom, and from which pass on it can be taken at the earliest.
#[derive(Clone, Copy)]
struct Summation {
    bound: Particle,
    centre: Particle,
    pass: usize,
}

impl Lowering<'_> {
    /// The components of a node's value.
    pub(super) fn lower(&mut self, node: &Node) -> Result<Vec<Id>, ProgramError> {
        let dimension = self.dimension;
        Ok(match &node.kind {
            Kind::Number(value) => vec![self.arena.constant(rational_to_f64(value))],
            Kind::Pi => vec![self.arena.constant(std::f64::consts::PI)],
            Kind::Dimension => vec![self.arena.constant(dimension as f64)],
            Kind::SmoothingLength => vec![self.arena.constant(self.smoothing_length)],
            Kind::Identity => pairs(dimension).map(|(a, b)| self.delta(a, b)).collect(),
            Kind::Field(p) => {
                let components = if node.rank == Field::Vector.rank() { dimension } else { 1 };
                (0..components).map(|a| self.arena.atom(Atom::Field(a, *p))).collect()
            }
            Kind::OfParticle(quantity, p) => vec![self.arena.atom(Atom::Quantity(*quantity, *p))],
            Kind::Renormalisation(p) => self.renormalisation(*p),
            Kind::RenormalisationHat(p) => self.renormalisation_hat(*p),
            Kind::OfPair(quantity, p, q) => self.of_pair(*quantity, *p, *q),
            Kind::Add(nodes) => {
                let lowered: Vec<Vec<Id>> = nodes.iter().map(|n| self.lower(n)).collect::<Result<_, _>>()?;
                let component = |arena: &mut Arena, c: usize| {
                    let terms: Vec<Id> = lowered.iter().map(|components| components[c]).collect();
                    arena.add(&terms)
                };
                (0..lowered[0].len()).map(|c| component(&mut self.arena, c)).collect()
            }
            Kind::Negate(a) => self.lower(a)?.iter().map(|a| self.arena.scale(-1.0, *a)).collect(),
            Kind::Outer(a, b) => {
                let (a, b) = (self.lower(a)?, self.lower(b)?);
                a.iter()
                    .flat_map(|a| b.iter().map(|b| (*a, *b)))
                    .map(|(a, b)| self.arena.multiply(a, b))
                    .collect()
            }
            Kind::Contract(a, b, count) => {
                let (a, b) = (self.lower(a)?, self.lower(b)?);
                let inner = dimension.pow(u32::from(*count));
                let (rows, columns) = (a.len() / inner, b.len() / inner);
                let mut components = Vec::with_capacity(rows * columns);
                for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
                    let products: Vec<Id> = (0..inner)
                        .map(|k| self.arena.multiply(a[row * inner + k], b[k * columns + column]))
                        .collect();
                    components.push(self.arena.add(&products));
                }
                components
            }
            Kind::Divide(a, b) => {
                let (a, b) = (self.lower(a)?, self.lower(b)?[0]);
                a.iter().map(|a| self.arena.product(&[(*a, 1), (b, -1)])).collect()
            }
            Kind::Power(a, power) => {
                let a = self.lower(a)?[0];
                vec![self.arena.product(&[(a, *power)])]
            }
            Kind::Inverse(a) => {
                let matrix = self.lower(a)?;
                let system = System { kind: SystemKind::Inverse, size: dimension, matrix };
                pairs(dimension).map(|(a, b)| self.arena.solution(system.clone(), b, a)).collect()
            }
            Kind::Sum { bound, centre, body } => {
                let body = self.lower(body)?;
                let sums = body.iter().map(|component| self.sum(*component, *bound, *centre));
                let sums: Option<Vec<Id>> = sums.collect();
                sums.ok_or_else(|| ProgramError::Entangled { span: node.span.clone() })?
            }
        })
    }

    fn delta(&mut self, a: usize, b: usize) -> Id {
        self.arena.constant(f64::from(u8::from(a == b)))
    }

    /// Pairs are kept with the lower particle first: what is odd in r changes its sign.
    fn of_pair(&mut self, quantity: OfPair, p: Particle, q: Particle) -> Vec<Id> {
        let sign = if p < q { 1.0 } else { -1.0 };
        let (p, q) = (p.min(q), p.max(q));
        let dimension = self.dimension;
        let r: Vec<Id> = (0..dimension).map(|axis| self.arena.atom(Atom::Separation(axis, p, q))).collect();
        let times = |this: &mut Self, factor: Id, a: usize| {
            let product = this.arena.multiply(factor, r[a]);
            this.arena.scale(sign, product)
        };
        match quantity {
            OfPair::Separation => r.iter().map(|r| self.arena.scale(sign, *r)).collect(),
            OfPair::Distance => vec![self.arena.atom(Atom::Distance(p, q))],
            OfPair::Direction => {
                let inverse = self.arena.atom(Atom::InverseDistance(p, q));
                (0..dimension).map(|a| times(self, inverse, a)).collect()
            }
            OfPair::Kernel => vec![self.radial(0, p, q)],
            OfPair::Gradient => {
                let g = self.radial(1, p, q);
                (0..dimension).map(|a| times(self, g, a)).collect()
            }
            OfPair::Hessian => {
                let (g1, g2) = (self.radial(1, p, q), self.radial(2, p, q));
                let component = |(a, b): (usize, usize)| {
                    let outer = self.arena.product(&[(r[a], 1), (r[b], 1), (g2, 1)]);
                    if a == b { self.arena.add(&[g1, outer]) } else { outer }
                };
                pairs(dimension).map(component).collect()
            }
            OfPair::Laplacian => {
                let (g1, g2) = (self.radial(1, p, q), self.radial(2, p, q));
                let square = self.arena.atom(Atom::Square(p, q));
                let outer = self.arena.multiply(square, g2);
                vec![self.arena.linear(&[(dimension as f64, g1), (1.0, outer)])]
            }
        }
    }

    /// G_k, or for the Gaussian, whose G_k are multiples of each other, that multiple of G_0.
    fn radial(&mut self, k: usize, p: Particle, q: Particle) -> Id {
        match self.kernel.multiple_of_first(k) {
            Some(multiple) => {
                let first = self.arena.atom(Atom::Radial(0, p, q));
                self.arena.scale(multiple, first)
            }
            None => self.arena.atom(Atom::Radial(k, p, q)),
        }
    }

    /// Σ_q V_q G_1 (1/r²)^`inverse_squares` r_a r_b … at p.
    fn moment(&mut self, p: Particle, axes: &[usize], inverse_squares: i32) -> Id {
        let mut factors =
            vec![(self.arena.atom(Atom::Quantity(OfParticle::Volume, 1)), 1), (self.radial(1, 0, 1), 1)];
        if inverse_squares > 0 {
            factors.push((self.arena.atom(Atom::InverseSquare(0, 1)), inverse_squares));
        }
        for axis in axes {
            factors.push((self.arena.atom(Atom::Separation(*axis, 0, 1)), 1));
        }
        let summand = self.arena.product(&factors);
        self.sum_of_summand(summand, p)
    }

    /// B_p, inverse of −Σ_q V_q r_pq ∇W_pq (Fatehi & Manzari 2011, Eq. 6). Symmetric.
    fn renormalisation(&mut self, p: Particle) -> Vec<Id> {
        let dimension = self.dimension;
        let component = |(a, b): (usize, usize)| {
            let moment = self.moment(p, &[a, b], 0);
            self.arena.scale(-1.0, moment)
        };
        let matrix: Vec<Id> = pairs(dimension).map(component).collect();
        let system = System { kind: SystemKind::Renormalisation, size: dimension, matrix };
        pairs(dimension).map(|(a, b)| self.arena.solution(system.clone(), a.min(b), a.max(b))).collect()
    }

    /// B̂_p of Eq. (40): B̂_ab K_abef = −δ_ef with K = Σ V r e e ∇W + (Σ V e e ∇W) · B · (Σ V r r ∇W). Symmetric.
    fn renormalisation_hat(&mut self, p: Particle) -> Vec<Id> {
        let dimension = self.dimension;
        let b = self.renormalisation(p);
        let distinct: Vec<(usize, usize)> = pairs(dimension).filter(|(a, b)| a <= b).collect();
        // (Σ V e_a e_b ∂_c W) B_cd, by (a, b), then d.
        let mut corrected = Vec::new();
        for (row, d) in distinct.iter().flat_map(|row| (0..dimension).map(move |d| (*row, d))) {
            let terms: Vec<Id> = (0..dimension)
                .map(|c| {
                    let moment = self.moment(p, &[row.0, row.1, c], 1);
                    self.arena.multiply(moment, b[c * dimension + d])
                })
                .collect();
            corrected.push(self.arena.add(&terms));
        }
        let mut matrix = Vec::new();
        for (e, f) in &distinct {
            for (column, (a, b)) in distinct.iter().enumerate() {
                let mut terms = vec![self.moment(p, &[*a, *b, *e, *f], 1)];
                for d in 0..dimension {
                    let moment = self.moment(p, &[d, *e, *f], 0);
                    terms.push(self.arena.multiply(corrected[column * dimension + d], moment));
                }
                let entry = self.arena.add(&terms);
                matrix.push(if a == b { entry } else { self.arena.scale(2.0, entry) });
            }
        }
        let system = System { kind: SystemKind::RenormalisationHat, size: distinct.len(), matrix };
        let place = |a: usize, b: usize| distinct.iter().position(|known| *known == (a.min(b), a.max(b)));
        pairs(dimension)
            .map(|(a, b)| self.arena.solution(system.clone(), 0, place(a, b).unwrap_or(0)))
            .collect()
    }

    /// Σ_bound body over the neighbours of the centre; `None` if what is left inside depends on yet another particle.
    fn sum(&mut self, body: Id, bound: Particle, centre: Particle) -> Option<Id> {
        let pass = 1 + self.level_at(body, bound);
        let summation = Summation { bound, centre, pass };
        let mut outer_by_summand: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
        for (outer, inner) in self.split(body, summation) {
            if self.arena.particles(inner).iter().any(|p| *p != bound && *p != centre) {
                return None;
            }
            let summand = self.arena.rename(inner, &[(centre, 0), (bound, 1)]);
            outer_by_summand.entry(summand).or_default().push(outer);
        }
        let mut terms = Vec::new();
        for (summand, outer) in outer_by_summand {
            let outer = self.arena.add(&outer);
            let sum = self.sum_of_summand(summand, centre);
            terms.push(self.arena.multiply(outer, sum));
        }
        Some(self.arena.add(&terms))
    }

    /// A sum whose summand is free of constant factors.
    fn sum_of_summand(&mut self, summand: Id, centre: Particle) -> Id {
        match self.arena.get(summand).clone() {
            Expression::Linear(constant, terms) if terms.is_empty() && constant.get() == 0.0 => summand,
            Expression::Linear(constant, terms) if terms.len() == 1 && constant.get() == 0.0 => {
                let sum = self.arena.sum(terms[0].1, centre);
                self.arena.scale(terms[0].0.get(), sum)
            }
            _ => self.arena.sum(summand, centre),
        }
    }

    /// The highest level of what belongs to this particle alone.
    fn level_at(&self, id: Id, particle: Particle) -> usize {
        if self.arena.level(id) == 0 || !self.arena.depends_on(id, particle) {
            return 0;
        }
        match self.arena.get(id) {
            Expression::Atom(_) => self.arena.level(id),
            Expression::Linear(_, terms) => {
                terms.iter().map(|(_, id)| self.level_at(*id, particle)).max().unwrap_or(0)
            }
            Expression::Product(factors) => {
                factors.iter().map(|(id, _)| self.level_at(*id, particle)).max().unwrap_or(0)
            }
        }
    }

    /// e = Σ outer × inner: the outer factors free of the bound particle, the inner ones, if it can be done, free of
    /// particles other than the bound one and the centre, and of sums at the centre that the same pass could take.
    fn split(&mut self, id: Id, summation: Summation) -> Vec<(Id, Id)> {
        let one = self.arena.constant(1.0);
        if !self.arena.depends_on(id, summation.bound) {
            return vec![(id, one)];
        }
        match self.arena.get(id).clone() {
            Expression::Atom(_) => vec![(one, id)],
            Expression::Linear(constant, terms) => {
                if !self.distributes(id, summation) && terms.len() > 1 {
                    return vec![(one, id)];
                }
                let constant = self.arena.constant(constant.get());
                let mut parts = Vec::new();
                if self.arena.constant_of(constant) != Some(0.0) {
                    parts.push((constant, one));
                }
                for (coefficient, term) in terms {
                    for (outer, inner) in self.split(term, summation) {
                        parts.push((self.arena.scale(coefficient.get(), outer), inner));
                    }
                }
                parts
            }
            Expression::Product(factors) => {
                let mut parts = vec![(one, one)];
                for (factor, power) in factors {
                    let (split, times) = if !self.arena.depends_on(factor, summation.bound) {
                        (vec![(self.arena.product(&[(factor, power)]), one)], 1)
                    } else if power > 0 && self.distributes(factor, summation) {
                        (self.split(factor, summation), power)
                    } else {
                        (vec![(one, self.arena.product(&[(factor, power)]))], 1)
                    };
                    for _ in 0..times {
                        let mut product = Vec::with_capacity(parts.len() * split.len());
                        for ((o1, i1), (o2, i2)) in
                            parts.iter().flat_map(|part| split.iter().map(move |s| (*part, *s)))
                        {
                            product.push((self.arena.multiply(o1, o2), self.arena.multiply(i1, i2)));
                        }
                        parts = product;
                    }
                }
                parts
            }
        }
    }

    /// Whether to distribute over a sum of expressions. A difference of two particles' own values, as u_j minus a mean at
    /// i, is kept even at the cost of another pass, for what it saves from rounding.
    fn distributes(&self, id: Id, summation: Summation) -> bool {
        let Expression::Linear(_, terms) = self.arena.get(id) else { return false };
        let own = [summation.bound, summation.centre];
        if self.arena.particles(id).iter().any(|p| !own.contains(p)) {
            return true;
        }
        let late: Vec<Id> =
            terms.iter().map(|(_, id)| *id).filter(|id| self.is_late(*id, summation)).collect();
        !late.is_empty()
            && late
                .iter()
                .all(|id| self.arena.depends_on(*id, summation.bound) && !self.stays_late(*id, summation))
    }

    /// Whether it contains a sum at the centre that is not known before the pass.
    fn is_late(&self, id: Id, summation: Summation) -> bool {
        self.level_at(id, summation.centre) >= summation.pass
    }

    /// Whether that is so even after the factors free of the bound particle are taken out.
    fn stays_late(&self, id: Id, summation: Summation) -> bool {
        if !self.arena.depends_on(id, summation.bound) || !self.is_late(id, summation) {
            return false;
        }
        match self.arena.get(id) {
            Expression::Atom(_) => false,
            Expression::Linear(..) => !self.distributes(id, summation),
            Expression::Product(factors) => factors.iter().any(|(factor, power)| {
                let late =
                    self.arena.depends_on(*factor, summation.bound) && self.is_late(*factor, summation);
                late && (*power < 0 || self.stays_late(*factor, summation))
            }),
        }
    }
}

/// (0, 0), (0, 1), …
fn pairs(dimension: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..dimension).flat_map(move |a| (0..dimension).map(move |b| (a, b)))
}
