//! The value of an expression on particles: what its symbols say, taken one neighbourhood at a time.

use super::DeriveError;
use super::algebra::{Bound, Expression, Factor, Index, Label, Symbol, Term};
use crate::exact::{Number, Solution, int, inverse, solve};
use crate::language::ground::Ground;
use crate::language::tree::OfParticle;
use num_traits::One as _;
use std::collections::BTreeMap;

/// A tensor with named indices, the first the slowest.
#[derive(Debug, Clone)]
struct Named<T> {
    indices: Vec<Index>,
    values: Vec<T>,
}

/// Where each particle of an expression stands: the particle of the ground, and its place relative to i.
type Places<T> = BTreeMap<Label, (usize, [T; 3])>;

/// Evaluates expressions on one ground.
pub(super) struct Evaluation<'a, T> {
    ground: &'a dyn Ground<T>,
    dimension: usize,
    b: BTreeMap<usize, Vec<T>>,
    b_hat: BTreeMap<usize, Vec<T>>,
    neighbours: BTreeMap<usize, Vec<(usize, [T; 3])>>,
}

impl<'a, T: Number> Evaluation<'a, T> {
    pub(super) fn new(ground: &'a dyn Ground<T>) -> Self {
        Self {
            ground,
            dimension: ground.dimension(),
            b: BTreeMap::new(),
            b_hat: BTreeMap::new(),
            neighbours: BTreeMap::new(),
        }
    }

    /// The expression at particle `i`, its free indices in order, then those of ∇…∇u, then that of v.
    pub(super) fn at(
        &mut self,
        expression: &Expression,
        i: usize,
        order: usize,
    ) -> Result<Vec<T>, DeriveError> {
        let places: Places<T> = BTreeMap::from([(0, (i, [T::nought(), T::nought(), T::nought()]))]);
        let mut total: Option<Vec<T>> = None;
        for term in expression.terms.iter().filter(|term| term.order() == order) {
            let derivative = term.factors.iter().find_map(|factor| match factor.symbol {
                Symbol::Derivative(_) => Some(factor.indices.clone()),
                _ => None,
            });
            let mut wanted = expression.free.clone();
            let mut term = term.clone();
            // An index of the derivative may be free itself: then a unit tensor carries it.
            for index in derivative.unwrap_or_default() {
                let next = 30_000 + wanted.len() as Index;
                if expression.free.contains(&index) || wanted.contains(&index) {
                    term.factors.push(Factor::new(Symbol::Delta, &[], &[index, next]));
                    wanted.push(next);
                } else {
                    wanted.push(index);
                }
            }
            term.factors.retain(|factor| !matches!(factor.symbol, Symbol::Derivative(_)));
            let value = self.term(&term, &places)?.ordered(&wanted, self.dimension);
            total = Some(match total {
                None => value,
                Some(sum) => sum.into_iter().zip(value).map(|(a, b)| a + b).collect(),
            });
        }
        Ok(total.unwrap_or_default())
    }

    fn term(&mut self, term: &Term, places: &Places<T>) -> Result<Named<T>, DeriveError> {
        let factors: Vec<&Factor> = term.factors.iter().collect();
        let product = self.product(&factors, &term.bounds, places)?;
        Ok(if term.coefficient.is_one() {
            product
        } else {
            product.scaled(&T::from_rational(&term.coefficient))
        })
    }

    /// The product of factors, summed over the bound particles.
    fn product(
        &mut self,
        factors: &[&Factor],
        bounds: &[Bound],
        places: &Places<T>,
    ) -> Result<Named<T>, DeriveError> {
        let ready = |factor: &Factor| factor.particles.iter().all(|label| places.contains_key(label));
        let mut product = Named::one();
        for factor in factors.iter().filter(|factor| ready(factor)) {
            let value = self.factor(factor, places)?;
            product = product.times(&value, self.dimension);
        }
        let mut waiting: Vec<&Factor> = factors.iter().copied().filter(|factor| !ready(factor)).collect();
        let mut open: Vec<Bound> = bounds.to_vec();
        while let Some(first) = open.iter().position(|bound| places.contains_key(&bound.centre)) {
            // All bound particles that share a factor with this one, or hang on it.
            let mut group = vec![open.remove(first)];
            loop {
                let named = |label: Label| group.iter().any(|bound| bound.particle == label);
                let linked = open.iter().position(|bound| {
                    let shares = |factor: &&Factor| {
                        factor.particles.contains(&bound.particle)
                            && factor.particles.iter().any(|p| named(*p))
                    };
                    named(bound.centre) || waiting.iter().any(shares)
                });
                match linked {
                    Some(at) => group.push(open.remove(at)),
                    None => break,
                }
            }
            let inside = |factor: &&Factor| {
                factor.particles.iter().any(|label| group.iter().any(|bound| bound.particle == *label))
            };
            let (mine, rest): (Vec<&Factor>, Vec<&Factor>) = waiting.into_iter().partition(inside);
            waiting = rest;
            let root = group.iter().position(|bound| places.contains_key(&bound.centre)).unwrap_or(0);
            let bound = group.remove(root);
            let Some((centre, place)) = places.get(&bound.centre).cloned() else { break };
            let mut sum: Option<Named<T>> = None;
            for (neighbour, r) in self.list(centre) {
                let mut inner = places.clone();
                let there = std::array::from_fn(|a| place[a].clone() - r[a].clone());
                inner.insert(bound.particle, (neighbour, there));
                let value = self.product(&mine, &group, &inner)?;
                sum = Some(match sum {
                    None => value,
                    Some(sum) => sum.plus(value, self.dimension),
                });
            }
            let value = sum.unwrap_or_else(Named::one);
            product = product.times(&value, self.dimension);
        }
        Ok(product)
    }

    fn list(&mut self, particle: usize) -> Vec<(usize, [T; 3])> {
        self.neighbours.entry(particle).or_insert_with(|| self.ground.neighbours(particle)).clone()
    }

    fn factor(&mut self, factor: &Factor, places: &Places<T>) -> Result<Named<T>, DeriveError> {
        let d = self.dimension;
        let at = |place: usize| {
            let label = factor.particles[place];
            places
                .get(&label)
                .cloned()
                .unwrap_or_else(|| unreachable!("only factors that are ready are taken"))
        };
        let number = |value: i64| T::from_rational(&int(value));
        let particle = factor.particles.first().map_or(0, |_| at(0).0);
        let no_value = |what| DeriveError::NoValue { particle, what };
        let pair = || {
            let (p, q) = (at(0), at(1));
            let r: [T; 3] = std::array::from_fn(|a| p.1[a].clone() - q.1[a].clone());
            let kernel = self.ground.kernel(p.0, q.0, &r);
            let square = r.iter().fold(T::nought(), |sum, x| sum + x.clone() * x.clone());
            (r, kernel, square)
        };
        let scalar = match &factor.symbol {
            Symbol::Dimension => number(d as i64),
            Symbol::Pi => T::pi().ok_or_else(|| no_value("π is no rational number"))?,
            Symbol::SmoothingLength => self.ground.smoothing_length(),
            Symbol::OfParticle(quantity) => self.ground.of_particle(*quantity, at(0).0)?,
            Symbol::Kernel => pair().1[0].clone(),
            Symbol::Slope => pair().1[1].clone(),
            Symbol::Laplacian => {
                let (_, [_, g1, g2], square) = pair();
                number(d as i64) * g1 + square * g2
            }
            Symbol::Distance => {
                let (_, _, square) = pair();
                // What divides by |r_ii| is left out of its sum, also where it has been cancelled: power 0.
                if square.is_nought() {
                    return Ok(Named::scalar(T::nought()));
                }
                // Even powers need no root.
                let (base, power) = match factor.power % 2 {
                    0 => (square, factor.power / 2),
                    _ => (
                        square.root().ok_or_else(|| no_value("a distance is no rational number"))?,
                        factor.power,
                    ),
                };
                return Ok(Named::scalar(base.power(power).unwrap_or_else(T::nought)));
            }
            Symbol::Reciprocal(body) => {
                let value = self.body(body, factor, places)?;
                let value = value.values.into_iter().next().unwrap_or_else(T::nought);
                let inverse = value.power(-1).ok_or_else(|| no_value("a divisor is zero"))?;
                let power = inverse.power(factor.power);
                return Ok(Named::scalar(power.ok_or_else(|| no_value("a divisor is zero"))?));
            }
            Symbol::Delta => return Ok(Named::of(&factor.indices, unit(d), d)),
            Symbol::Separation => {
                let (r, ..) = pair();
                return Ok(Named::of(&factor.indices, r[..d].to_vec(), d));
            }
            Symbol::Hessian => {
                let (r, [_, g1, g2], _) = pair();
                let unit: Vec<T> = unit(d);
                let values = (0..d * d).map(|at| {
                    unit[at].clone() * g1.clone() + r[at / d].clone() * r[at % d].clone() * g2.clone()
                });
                return Ok(Named::of(&factor.indices, values.collect(), d));
            }
            Symbol::Renormalisation => {
                let values = self.renormalisation(particle)?;
                return Ok(Named::of(&factor.indices, values, d));
            }
            Symbol::RenormalisationHat => {
                let values = self.renormalisation_hat(particle)?;
                return Ok(Named::of(&factor.indices, values, d));
            }
            Symbol::Inverse(body) => {
                let value = self.body(body, factor, places)?.ordered(&body.free, d);
                let rows: Vec<Vec<T>> = value.chunks(d).map(<[T]>::to_vec).collect();
                let inverse = inverse(&rows).map_err(|_| no_value("a tensor has no inverse"))?;
                return Ok(Named::of(&factor.indices, inverse.concat(), d));
            }
            Symbol::Derivative(_) | Symbol::FieldAt(_) => return Err(no_value("the field is left in it")),
        };
        let value = scalar.power(factor.power).ok_or_else(|| no_value("a divisor is zero"))?;
        Ok(Named::scalar(value))
    }

    fn body(
        &mut self,
        body: &Expression,
        factor: &Factor,
        places: &Places<T>,
    ) -> Result<Named<T>, DeriveError> {
        let own = |(place, label): (usize, &Label)| places.get(label).map(|at| (place as Label, at.clone()));
        let inner: Places<T> = factor.particles.iter().enumerate().filter_map(own).collect();
        let mut sum: Option<Named<T>> = None;
        for term in &body.terms {
            let value = self.term(term, &inner)?;
            sum = Some(match sum {
                None => value,
                Some(sum) => sum.plus(value, self.dimension),
            });
        }
        Ok(sum.unwrap_or_else(Named::one))
    }

    /// Σ over the neighbours of r_a r_b … times a scalar of the pair.
    fn moment(
        &mut self,
        particle: usize,
        rank: usize,
        weight: impl Fn(T, T) -> Option<T>,
    ) -> Result<Vec<T>, DeriveError> {
        let d = self.dimension;
        let mut sum = vec![T::nought(); d.pow(rank as u32)];
        for (neighbour, r) in self.list(particle) {
            let [_, slope, _] = self.ground.kernel(particle, neighbour, &r);
            let square = r.iter().fold(T::nought(), |sum, x| sum + x.clone() * x.clone());
            let Some(weight) = weight(slope, square) else { continue };
            let weight = weight * self.ground.of_particle(OfParticle::Volume, neighbour)?;
            for (at, sum) in sum.iter_mut().enumerate() {
                let mut product = weight.clone();
                let mut rest = at;
                for _ in 0..rank {
                    product = product * r[rest % d].clone();
                    rest /= d;
                }
                *sum = sum.clone() + product;
            }
        }
        Ok(sum)
    }

    /// B (Eq. 6).
    fn renormalisation(&mut self, particle: usize) -> Result<Vec<T>, DeriveError> {
        if let Some(known) = self.b.get(&particle) {
            return Ok(known.clone());
        }
        let sum = self.moment(particle, 2, |slope, _| Some(-slope))?;
        let rows: Vec<Vec<T>> = sum.chunks(self.dimension).map(<[T]>::to_vec).collect();
        let rows = inverse(&rows).map_err(|_| DeriveError::NoValue { particle, what: "B is singular" })?;
        let b = rows.concat();
        self.b.insert(particle, b.clone());
        Ok(b)
    }

    /// B̂ (Eq. 40), of least norm where it is not determined.
    fn renormalisation_hat(&mut self, particle: usize) -> Result<Vec<T>, DeriveError> {
        if let Some(known) = self.b_hat.get(&particle) {
            return Ok(known.clone());
        }
        let d = self.dimension;
        let b = self.renormalisation(particle)?;
        let by_square = |slope: T, square: T| square.power(-1).map(|inverse| slope * inverse);
        let fourth = self.moment(particle, 4, by_square)?;
        let third = self.moment(particle, 3, by_square)?;
        let second = self.moment(particle, 3, |slope, _| Some(slope))?;
        let of = |tensor: &[T], indices: &[usize]| {
            tensor[indices.iter().fold(0, |at, index| at * d + index)].clone()
        };
        let entry = |a: usize, b_: usize, e: usize, f: usize| {
            let mut sum = of(&fourth, &[a, b_, e, f]);
            for c in 0..d {
                for g in 0..d {
                    sum = sum + of(&third, &[a, b_, c]) * of(&b, &[c, g]) * of(&second, &[g, e, f]);
                }
            }
            sum
        };
        let pairs: Vec<(usize, usize)> = (0..d).flat_map(|a| (a..d).map(move |b| (a, b))).collect();
        let number = |value: i64| T::from_rational(&int(value));
        let weights: Vec<T> = pairs.iter().map(|(a, b)| number(if a == b { 1 } else { 2 })).collect();
        let row = |(e, f): &(usize, usize)| {
            pairs.iter().zip(&weights).map(|((a, b), w)| w.clone() * entry(*a, *b, *e, *f)).collect()
        };
        let mut matrix: Vec<Vec<T>> = pairs.iter().map(row).collect();
        // Where the two parts of the bracket cancel, what is left is their rounding: nothing.
        let largest = |values: &mut dyn Iterator<Item = &T>| values.map(T::size).fold(0.0, f64::max);
        if largest(&mut matrix.iter().flatten()) <= T::SINGULAR * largest(&mut fourth.iter()) {
            matrix.iter_mut().flatten().for_each(|entry| *entry = T::nought());
        }
        let right: Vec<T> = pairs.iter().map(|(e, f)| number(if e == f { -1 } else { 0 })).collect();
        let solution = match solve(&matrix, &right, &weights) {
            Solution::One(solution) | Solution::Least { solution, .. } => solution,
            Solution::None { .. } => return Err(DeriveError::NoValue { particle, what: "B̂ is singular" }),
        };
        let mut b_hat = vec![T::nought(); d * d];
        for ((a, b), value) in pairs.iter().zip(solution) {
            b_hat[a * d + b] = value.clone();
            b_hat[b * d + a] = value;
        }
        self.b_hat.insert(particle, b_hat.clone());
        Ok(b_hat)
    }
}

fn unit<T: Number>(d: usize) -> Vec<T> {
    let one = T::from_rational(&int(1));
    (0..d * d).map(|at| if at / d == at % d { one.clone() } else { T::nought() }).collect()
}

impl<T: Number> Named<T> {
    fn one() -> Self {
        Self::scalar(T::from_rational(&int(1)))
    }

    fn scalar(value: T) -> Self {
        Self { indices: Vec::new(), values: vec![value] }
    }

    /// A tensor with these indices; one that stands twice is summed over.
    fn of(indices: &[Index], values: Vec<T>, d: usize) -> Self {
        match indices {
            [a, b] if a == b => {
                let trace = (0..d).fold(T::nought(), |sum, k| sum + values[k * d + k].clone());
                Self::scalar(trace)
            }
            _ => Self { indices: indices.to_vec(), values },
        }
    }

    fn scaled(mut self, factor: &T) -> Self {
        for value in &mut self.values {
            *value = value.clone() * factor.clone();
        }
        self
    }

    /// The sum of two tensors with the same indices, in any order.
    fn plus(self, other: Self, d: usize) -> Self {
        let aligned = other.ordered(&self.indices, d);
        let values = self.values.into_iter().zip(aligned).map(|(a, b)| a + b).collect();
        Self { indices: self.indices, values }
    }

    fn ordered(self, indices: &[Index], d: usize) -> Vec<T> {
        if self.indices == indices {
            return self.values;
        }
        let steps = self.steps(indices, d);
        (0..d.pow(indices.len() as u32)).map(|at| self.values[place(at, &steps, d)].clone()).collect()
    }

    /// The product, indices in both summed over.
    fn times(&self, other: &Self, d: usize) -> Self {
        if self.indices.is_empty() || other.indices.is_empty() {
            let (factor, tensor) = if self.indices.is_empty() { (self, other) } else { (other, self) };
            return tensor.clone().scaled(&factor.values[0]);
        }
        let shared: Vec<Index> =
            self.indices.iter().copied().filter(|index| other.indices.contains(index)).collect();
        let kept = self.indices.iter().chain(&other.indices).copied().filter(|index| !shared.contains(index));
        let kept: Vec<Index> = kept.collect();
        let (outer, inner) = (
            [self.steps(&kept, d), other.steps(&kept, d)],
            [self.steps(&shared, d), other.steps(&shared, d)],
        );
        let sums = d.pow(shared.len() as u32);
        let values = (0..d.pow(kept.len() as u32)).map(|at| {
            let [mine, theirs] = [place(at, &outer[0], d), place(at, &outer[1], d)];
            let product = |at: usize| {
                let left = self.values[mine + place(at, &inner[0], d)].clone();
                left * other.values[theirs + place(at, &inner[1], d)].clone()
            };
            (1..sums).fold(product(0), |sum, at| sum + product(at))
        });
        let values = values.collect();
        Self { indices: kept, values }
    }

    /// How far apart two values stand that differ by one in each of these indices; 0 for an index that it does not have.
    fn steps(&self, indices: &[Index], d: usize) -> Vec<usize> {
        let own = |index: &Index| self.indices.iter().position(|known| known == index);
        let step = |at: usize| d.pow((self.indices.len() - 1 - at) as u32);
        indices.iter().map(|index| own(index).map_or(0, step)).collect()
    }
}

/// Where the assignment `at` of 0…d−1 to some indices, the first the slowest, leads with these steps.
fn place(at: usize, steps: &[usize], d: usize) -> usize {
    let mut rest = at;
    steps.iter().rev().fold(0, |place, step| {
        let digit = rest % d;
        rest /= d;
        place + digit * step
    })
}
