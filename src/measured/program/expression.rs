//! Scalar expressions of particle and pair quantities, in one normal form, equal ones stored once.

use crate::language::tree::{OfParticle, Particle};
use std::collections::{BTreeMap, HashMap};

/// An expression in its [`Arena`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Id(u32);

/// A coefficient by its bits, which can be compared and hashed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Real(u64);

impl Real {
    pub(super) fn new(value: f64) -> Self {
        Self((value + 0.0).to_bits())
    }

    pub(super) fn get(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// What is not made of other expressions. Pairs name the lower particle first, r_pq = r_p − r_q; lengths are in units of R.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Atom {
    /// V, ρ, m, μ.
    Quantity(OfParticle, Particle),
    /// A component of the field.
    Field(usize, Particle),
    /// A component of r_pq.
    Separation(usize, Particle, Particle),
    /// |r_pq|.
    Distance(Particle, Particle),
    /// |r_pq|².
    Square(Particle, Particle),
    /// 1/|r_pq|; 0 where p = q.
    InverseDistance(Particle, Particle),
    /// 1/|r_pq|²; 0 where p = q.
    InverseSquare(Particle, Particle),
    /// G_k(|r_pq|).
    Radial(usize, Particle, Particle),
    /// A sum over the neighbours of a particle, by its place in [`Arena::sums`].
    Sum(usize, Particle),
    /// A component of the solution of a linear system, by its place in [`Arena::systems`]: (right side, unknown).
    Solution(usize, usize, usize),
    /// An expression of one particle (there named particle 0) that was computed before.
    Stored(Id, Particle),
}

/// An expression.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Expression {
    /// See [`Atom`].
    Atom(Atom),
    /// A constant and a sum of multiples, no term of which is itself such a sum.
    Linear(Real, Vec<(Real, Id)>),
    /// Powers, never zero. One expression may occur with a positive and with a negative power: at j = i they do not cancel.
    Product(Vec<(Id, i32)>),
}

/// What a linear system is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum SystemKind {
    /// B = M⁻¹; right side a is the unit vector a.
    Renormalisation,
    /// B̂, one right side: −I in its distinct components.
    RenormalisationHat,
    /// The inverse of what the text says.
    Inverse,
}

/// A square system, row by row.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct System {
    pub(super) kind: SystemKind,
    pub(super) size: usize,
    pub(super) matrix: Vec<Id>,
}

#[derive(Debug, Clone)]
struct Facts {
    /// Ascending.
    particles: Vec<Particle>,
    level: usize,
    divides: bool,
}

/// All expressions of a program.
#[derive(Debug, Default)]
pub(super) struct Arena {
    expressions: Vec<Expression>,
    facts: Vec<Facts>,
    places: HashMap<Expression, Id>,
    /// Summands: particle 0 is the one whose neighbours are summed over, 1 the neighbour.
    pub(super) sums: Vec<Id>,
    pub(super) systems: Vec<System>,
}

impl Arena {
    pub(super) fn get(&self, id: Id) -> &Expression {
        &self.expressions[id.0 as usize]
    }

    /// The particles it depends on, ascending.
    pub(super) fn particles(&self, id: Id) -> &[Particle] {
        &self.facts[id.0 as usize].particles
    }

    pub(super) fn depends_on(&self, id: Id, particle: Particle) -> bool {
        self.particles(id).contains(&particle)
    }

    /// The pass over the pairs after which it can be computed, 0 if it needs none.
    pub(super) fn level(&self, id: Id) -> usize {
        self.facts[id.0 as usize].level
    }

    /// Whether there is a division in it, other than by a distance.
    pub(super) fn divides(&self, id: Id) -> bool {
        self.facts[id.0 as usize].divides
    }

    /// Its value if it is a constant.
    pub(super) fn constant_of(&self, id: Id) -> Option<f64> {
        match self.get(id) {
            Expression::Linear(constant, terms) if terms.is_empty() => Some(constant.get()),
            _ => None,
        }
    }

    fn intern(&mut self, expression: Expression) -> Id {
        if let Some(id) = self.places.get(&expression) {
            return *id;
        }
        let children: Vec<Id> = match &expression {
            Expression::Atom(Atom::Solution(system, ..)) => self.systems[*system].matrix.clone(),
            Expression::Atom(_) => Vec::new(),
            Expression::Linear(_, terms) => terms.iter().map(|(_, id)| *id).collect(),
            Expression::Product(factors) => factors.iter().map(|(id, _)| *id).collect(),
        };
        let mut particles: Vec<Particle> = match expression {
            Expression::Atom(atom) => match atom {
                Atom::Quantity(_, p) | Atom::Field(_, p) | Atom::Sum(_, p) | Atom::Stored(_, p) => vec![p],
                Atom::Separation(_, p, q) | Atom::Radial(_, p, q) => vec![p, q],
                Atom::Distance(p, q) | Atom::Square(p, q) => vec![p, q],
                Atom::InverseDistance(p, q) | Atom::InverseSquare(p, q) => vec![p, q],
                Atom::Solution(..) => Vec::new(),
            },
            _ => Vec::new(),
        };
        particles.extend(children.iter().flat_map(|id| self.particles(*id)));
        particles.sort_unstable();
        particles.dedup();
        let level = match expression {
            Expression::Atom(Atom::Sum(sum, _)) => 1 + self.level(self.sums[sum]),
            Expression::Atom(Atom::Stored(id, _)) => self.level(id),
            _ => children.iter().map(|id| self.level(*id)).max().unwrap_or(0),
        };
        let own = match &expression {
            Expression::Atom(atom) => matches!(atom, Atom::Solution(..)),
            Expression::Linear(..) => false,
            Expression::Product(factors) => factors.iter().any(|(_, power)| *power < 0),
        };
        let divides = own || children.iter().any(|id| self.divides(*id));
        let id = Id(self.expressions.len() as u32);
        self.expressions.push(expression.clone());
        self.facts.push(Facts { particles, level, divides });
        self.places.insert(expression, id);
        id
    }

    pub(super) fn atom(&mut self, atom: Atom) -> Id {
        self.intern(Expression::Atom(atom))
    }

    pub(super) fn constant(&mut self, value: f64) -> Id {
        self.intern(Expression::Linear(Real::new(value), Vec::new()))
    }

    /// Σ coefficient × term.
    pub(super) fn linear(&mut self, terms: &[(f64, Id)]) -> Id {
        let mut constant = 0.0;
        let mut merged: BTreeMap<Id, f64> = BTreeMap::new();
        for (coefficient, id) in terms {
            match self.get(*id) {
                Expression::Linear(own, inner) => {
                    constant += coefficient * own.get();
                    for (c, id) in inner {
                        *merged.entry(*id).or_default() += coefficient * c.get();
                    }
                }
                _ => *merged.entry(*id).or_default() += coefficient,
            }
        }
        merged.retain(|_, coefficient| *coefficient != 0.0);
        if let (0.0, 1, Some((id, 1.0))) =
            (constant, merged.len(), merged.iter().next().map(|(i, c)| (*i, *c)))
        {
            return id;
        }
        let terms = merged.into_iter().map(|(id, c)| (Real::new(c), id)).collect();
        self.intern(Expression::Linear(Real::new(constant), terms))
    }

    pub(super) fn scale(&mut self, coefficient: f64, id: Id) -> Id {
        self.linear(&[(coefficient, id)])
    }

    pub(super) fn add(&mut self, terms: &[Id]) -> Id {
        let terms: Vec<(f64, Id)> = terms.iter().map(|id| (1.0, *id)).collect();
        self.linear(&terms)
    }

    /// The product; sums are not multiplied out.
    pub(super) fn product(&mut self, factors: &[(Id, i32)]) -> Id {
        let mut coefficient = 1.0;
        let mut powers = BTreeMap::new();
        for (id, power) in factors {
            self.collect(*id, *power, &mut coefficient, &mut powers);
        }
        if coefficient == 0.0 {
            return self.constant(0.0);
        }
        let powers: Vec<(Id, i32)> = powers.into_iter().map(|((id, _), power)| (id, power)).collect();
        let id = match powers[..] {
            [] => return self.constant(coefficient),
            [(id, 1)] => id,
            _ => self.intern(Expression::Product(powers)),
        };
        if coefficient == 1.0 { id } else { self.scale(coefficient, id) }
    }

    pub(super) fn multiply(&mut self, a: Id, b: Id) -> Id {
        self.product(&[(a, 1), (b, 1)])
    }

    /// Enters factor^power into a product. Sums lose the magnitude that their coefficients share, and the sign of the
    /// first, to the coefficient of the product: a − b and b − a are one expression.
    fn collect(&mut self, id: Id, power: i32, coefficient: &mut f64, powers: &mut BTreeMap<(Id, bool), i32>) {
        let pair = |atom| match atom {
            Atom::Distance(p, q) => Some((p, q, Atom::Square(p, q), Atom::InverseDistance(p, q))),
            Atom::InverseDistance(p, q) => Some((p, q, Atom::InverseSquare(p, q), Atom::Distance(p, q))),
            Atom::Square(p, q) => Some((p, q, Atom::Square(p, q), Atom::InverseSquare(p, q))),
            Atom::InverseSquare(p, q) => Some((p, q, Atom::InverseSquare(p, q), Atom::Square(p, q))),
            _ => None,
        };
        match self.get(id).clone() {
            Expression::Product(factors) => {
                for (factor, n) in factors {
                    self.collect(factor, n * power, coefficient, powers);
                }
            }
            Expression::Linear(constant, terms) if terms.is_empty() => {
                *coefficient *= constant.get().powi(power);
            }
            Expression::Linear(constant, terms) => {
                let first = terms[0].0.get();
                let shared = terms.iter().all(|(c, _)| c.get().abs() == first.abs())
                    && (constant.get() == 0.0 || constant.get().abs() == first.abs());
                let unit = if shared { first } else { first.signum() };
                *coefficient *= unit.powi(power);
                let scaled = self.scale(1.0 / unit, id);
                if matches!(self.get(scaled), Expression::Linear(..)) {
                    *powers.entry((scaled, power > 0)).or_default() += power;
                } else {
                    self.collect(scaled, power, coefficient, powers);
                }
            }
            Expression::Atom(atom) => match pair(atom) {
                // A negative power of a length is a power of its inverse, and two of them are one of the square's.
                Some((_, _, _, inverse)) if power < 0 => {
                    let inverse = self.atom(inverse);
                    self.collect(inverse, -power, coefficient, powers);
                }
                Some((_, _, square, _)) => {
                    let own = powers.remove(&(id, true)).unwrap_or(0) + power;
                    if square == atom {
                        powers.insert((id, true), own);
                    } else {
                        if own % 2 == 1 {
                            powers.insert((id, true), 1);
                        }
                        if own > 1 {
                            let square = self.atom(square);
                            *powers.entry((square, true)).or_default() += own / 2;
                        }
                    }
                }
                None => *powers.entry((id, power > 0)).or_default() += power,
            },
        }
    }

    /// The sum of a summand over the neighbours of `centre`.
    pub(super) fn sum(&mut self, summand: Id, centre: Particle) -> Id {
        let known = self.sums.iter().position(|known| *known == summand);
        let place = known.unwrap_or_else(|| {
            self.sums.push(summand);
            self.sums.len() - 1
        });
        self.atom(Atom::Sum(place, centre))
    }

    /// A component of the solution of a system.
    pub(super) fn solution(&mut self, system: System, side: usize, unknown: usize) -> Id {
        let known = self.systems.iter().position(|known| *known == system);
        let place = known.unwrap_or_else(|| {
            self.systems.push(system);
            self.systems.len() - 1
        });
        self.atom(Atom::Solution(place, side, unknown))
    }

    /// The expression with other particles in place of its own, in the same order.
    pub(super) fn rename(&mut self, id: Id, names: &[(Particle, Particle)]) -> Id {
        self.rename_with(id, names, &mut HashMap::new())
    }

    fn rename_with(&mut self, id: Id, names: &[(Particle, Particle)], known: &mut HashMap<Id, Id>) -> Id {
        if let Some(renamed) = known.get(&id) {
            return *renamed;
        }
        let name = |p: Particle| names.iter().find(|(old, _)| *old == p).map_or(p, |(_, new)| *new);
        let renamed = match self.get(id).clone() {
            Expression::Atom(atom) => {
                let atom = match atom {
                    Atom::Quantity(quantity, p) => Atom::Quantity(quantity, name(p)),
                    Atom::Field(component, p) => Atom::Field(component, name(p)),
                    Atom::Separation(axis, p, q) => Atom::Separation(axis, name(p), name(q)),
                    Atom::Distance(p, q) => Atom::Distance(name(p), name(q)),
                    Atom::Square(p, q) => Atom::Square(name(p), name(q)),
                    Atom::InverseDistance(p, q) => Atom::InverseDistance(name(p), name(q)),
                    Atom::InverseSquare(p, q) => Atom::InverseSquare(name(p), name(q)),
                    Atom::Radial(k, p, q) => Atom::Radial(k, name(p), name(q)),
                    Atom::Sum(sum, p) => Atom::Sum(sum, name(p)),
                    Atom::Stored(stored, p) => Atom::Stored(stored, name(p)),
                    Atom::Solution(system, side, unknown) => {
                        let System { kind, size, matrix } = self.systems[system].clone();
                        let matrix = matrix.iter().map(|id| self.rename_with(*id, names, known)).collect();
                        let solution = self.solution(System { kind, size, matrix }, side, unknown);
                        known.insert(id, solution);
                        return solution;
                    }
                };
                self.atom(atom)
            }
            Expression::Linear(constant, terms) => {
                let constant = self.constant(constant.get());
                let mut renamed = vec![(1.0, constant)];
                for (c, id) in terms {
                    renamed.push((c.get(), self.rename_with(id, names, known)));
                }
                self.linear(&renamed)
            }
            Expression::Product(factors) => {
                let renamed: Vec<(Id, i32)> =
                    factors.iter().map(|(id, n)| (self.rename_with(*id, names, known), *n)).collect();
                self.product(&renamed)
            }
        };
        known.insert(id, renamed);
        renamed
    }
}
