//! Whether the arithmetic can make a normalised error depend on the scale of the field: the operators of Chaussonnet et al.
//! (2015) in single or double precision, with the field and the positions stored as programs store them.
//!
//! Rounding is relative, so that in exact multiples of a power of two nothing changes and else the error has the size of the
//! roundings whatever the scale. Only a length or a value that does not scale along can make a difference: a distant origin, a
//! field about a reference value, a field written with a fixed number of decimals. Each is tried here.

use super::domain::{Domain, DomainError, Laid};
use crate::exact::rational_to_f64;
use crate::kernel::{Evaluator, Kernel};
use crate::particles::Neighbours;
use num_traits::Float;

/// How numbers are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Storage {
    /// In f32 throughout: positions, volumes, kernel, sums.
    pub single: bool,
    /// The corner of the inner region, in domain sizes from the origin of the stored coordinates.
    pub offset: f64,
    /// A constant added to the field.
    pub reference: f64,
    /// The field is rounded to multiples of this; 0 if it is not.
    pub quantum: f64,
    /// By how much the scale of the field exceeds the K_x that errors are normalised with.
    pub excess: f64,
}

/// What is taken: operator and field.
pub const TAKEN: [(&str, &str); 5] =
    [("G0", "F0"), ("G0", "F1"), ("G-", "F1"), ("MCG-pi", "U1"), ("MEA", "U1")];

/// Root mean squares over the inner particles of the x components of λ and ω, Eqs. (23) and (35), in the order of [`TAKEN`].
///
/// # Errors
/// [`DomainError`].
pub fn stored_errors(
    kernel: &Kernel,
    domain: &Domain,
    laid: &Laid,
    size: f64,
    scale: f64,
    storage: Storage,
) -> Result<[f64; 5], DomainError> {
    let lists = Neighbours::search(&laid.cloud)?;
    Ok(if storage.single {
        Stored::<f32>::new(kernel, domain, laid, &lists, size, scale, storage).errors()
    } else {
        Stored::<f64>::new(kernel, domain, laid, &lists, size, scale, storage).errors()
    })
}

/// Everything in one kind of number.
struct Stored<'a, T> {
    domain: &'a Domain,
    lists: &'a Neighbours,
    evaluator: Evaluator<T>,
    dimension: usize,
    support: T,
    h: T,
    places: Vec<[T; 3]>,
    volumes: Vec<T>,
    /// ξ, and the stored fields: constant and linear.
    fields: [Vec<T>; 2],
    size: T,
    /// Of the field, and the K_x of the norm.
    scale: T,
    norm: T,
}

fn number<T: Float>(value: f64) -> T {
    T::from(value).unwrap_or_else(T::nan)
}

impl<'a, T: Float> Stored<'a, T> {
    fn new(
        kernel: &Kernel,
        domain: &'a Domain,
        laid: &Laid,
        lists: &'a Neighbours,
        size: f64,
        scale: f64,
        storage: Storage,
    ) -> Self {
        let dimension = laid.cloud.dimension();
        let shift = storage.offset * size;
        let places: Vec<[T; 3]> =
            laid.cloud.positions().iter().map(|x| x.map(|x| number::<T>(x + shift))).collect();
        let written = |value: T| {
            let value = value + number(storage.reference);
            if storage.quantum > 0.0 {
                let quantum = number::<T>(storage.quantum);
                (value / quantum).round() * quantum
            } else {
                value
            }
        };
        let (length, shift, k) = (number::<T>(size), number::<T>(shift), number::<T>(scale + storage.excess));
        // With an excess the field is another one, and its own slope is taken off: what is left is the error of the operator.
        let constant = vec![written(k); places.len()];
        let linear = places.iter().map(|x| written(k * ((x[0] - shift) / length))).collect();
        let mut stored = Self {
            domain,
            lists,
            evaluator: Evaluator::new(kernel, dimension, 1),
            dimension,
            support: number(domain.support()),
            h: number(domain.support() / rational_to_f64(kernel.support_over_h())),
            places,
            volumes: Vec::new(),
            fields: [constant, linear],
            size: length,
            scale: k,
            norm: number(scale),
        };
        stored.volumes = (0..stored.places.len())
            .map(|i| {
                let sum = stored.near(i).fold(T::zero(), |sum, (_, _, g)| sum + g[0]);
                T::one() / sum
            })
            .collect();
        stored
    }

    /// The neighbours with r_ij and W, W′/r in metres.
    fn near(&self, i: usize) -> impl Iterator<Item = (usize, [T; 3], [T; 2])> + '_ {
        self.lists.of(i).iter().map(move |neighbour| {
            let j = neighbour.j as usize;
            let r: [T; 3] = std::array::from_fn(|a| self.places[i][a] - self.places[j][a]);
            let length = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
            let [w, g, ..] = self.evaluator.radial(length / self.support);
            let unit = (0..self.dimension).fold(T::one(), |unit, _| unit / self.support);
            (j, r, [unit * w, unit / self.support / self.support * g])
        })
    }

    fn errors(&self) -> [f64; 5] {
        let pi: T = number(std::f64::consts::PI);
        let d: T = number(self.dimension as f64);
        let two: T = number(2.0);
        let theta: T = number::<T>(0.1) * self.h;
        let mut squares = [0.0; 5];
        for i in self.domain.inner() {
            let mut sums = [T::zero(); 5];
            for (j, r, [_, g]) in self.near(*i) {
                let volume = self.volumes[j];
                let gradient = volume * r[0] * g;
                let [constant, linear] = &self.fields;
                let difference = linear[j] - linear[*i];
                let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
                let per_square = T::one() / (square + theta * theta);
                sums[0] = sums[0] + constant[j] * gradient;
                sums[1] = sums[1] + linear[j] * gradient;
                sums[2] = sums[2] + difference * gradient;
                // r_ab = −r_ij and v_ab = v_b − v_a.
                let across = -(r[0] * difference) * per_square;
                sums[3] = sums[3] + two * (d + two) / pi * across * gradient;
                sums[4] = sums[4] - two * volume * g * square * per_square * difference;
            }
            let exact = self.scale / self.size;
            let slope = self.norm / self.size;
            let curvature = slope / self.size;
            let errors = [
                sums[0] / slope,
                (sums[1] - exact) / slope,
                (sums[2] - exact) / slope,
                sums[3] / curvature,
                sums[4] / curvature,
            ];
            for (square, error) in squares.iter_mut().zip(errors) {
                let error = error.to_f64().unwrap_or(f64::NAN);
                *square += error * error;
            }
        }
        squares.map(|square| (square / self.domain.inner().len() as f64).sqrt())
    }
}
