//! A few particles in no symmetry, with rational places, weights and kernel values: where a coefficient that is not zero
//! shows that it is not.
//!
//! The kernel between each two particles is three independent rationals in place of W, W′/r and (W″ − W′/r)/r², and all
//! particles are neighbours. The distances from particle 0 are rational too, so that |r_ij| and e_ij are; between others
//! they need not be, and an operator with |r_jk| to an odd power has no exact value here.

use crate::exact::{Number, Rational, int, ratio};
use crate::language::ground::{Ground, MissingQuantity};
use crate::language::tree::OfParticle;

/// Particles with rational places. The numbers are fixed: arrangement n is always the same.
#[derive(Debug, Clone)]
pub struct Arrangement {
    dimension: usize,
    number: i64,
    places: Vec<[Rational; 3]>,
}

impl Arrangement {
    /// Arrangement `number` in `dimension` dimensions, of particle 0 and as many others as every operator of the catalogue
    /// needs.
    pub fn new(dimension: usize, number: i64) -> Self {
        let others = [5, 8, 12][dimension.clamp(1, 3) - 1];
        let mut places = vec![[int(0), int(0), int(0)]];
        for n in 1..=others {
            let (s, t) = (rational(n, number, 3), rational(n, number, 11));
            let length = rational(n, number, 29) + ratio(1, 3);
            // A point of the unit sphere with rational coordinates, by stereographic projection.
            let mut place = match dimension {
                1 => [if n % 2 == 0 { int(1) } else { int(-1) }, int(0), int(0)],
                2 => {
                    let square = &s * &s;
                    let scale = int(1) + &square;
                    [(int(1) - &square) / &scale, int(2) * &s / &scale, int(0)]
                }
                _ => {
                    let square = &s * &s + &t * &t;
                    let scale = int(1) + &square;
                    [int(2) * &s / &scale, int(2) * &t / &scale, (&square - int(1)) / &scale]
                }
            };
            let sign = if (n + number) % 3 == 0 { int(-1) } else { int(1) };
            for x in &mut place {
                *x = &*x * &length * &sign;
            }
            places.push(place);
        }
        Self { dimension, number, places }
    }

    /// How many particles.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Never.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The places of the particles.
    pub fn places(&self) -> &[[Rational; 3]] {
        &self.places
    }
}

/// A rational of either sign without a pattern that an operator could share.
fn rational(n: i64, number: i64, salt: i64) -> Rational {
    let mixed = (n * n * 37 + n * 113 * salt + number * 271 + salt * salt * 59).rem_euclid(211);
    let other = (n * 17 + salt * 7 + number * 5).rem_euclid(23);
    ratio(mixed - 97, 1) / (int(other) + int(31))
}

impl<T: Number> Ground<T> for Arrangement {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn neighbours(&self, p: usize) -> Vec<(usize, [T; 3])> {
        let separation =
            |q: usize| std::array::from_fn(|a| T::from_rational(&(&self.places[p][a] - &self.places[q][a])));
        (0..self.places.len()).map(|q| (q, separation(q))).collect()
    }

    fn of_particle(&self, quantity: OfParticle, p: usize) -> Result<T, MissingQuantity> {
        let positive = |salt: i64| {
            let value = rational(p as i64 + 2, self.number, salt);
            &value * &value + ratio(1, 2)
        };
        let (volume, density) = (positive(41), positive(43));
        Ok(T::from_rational(&match quantity {
            OfParticle::Volume => volume,
            OfParticle::Density => density,
            OfParticle::Mass => volume * density,
            OfParticle::Viscosity => positive(47),
        }))
    }

    fn smoothing_length(&self) -> T {
        T::from_rational(&ratio(7, 5))
    }

    fn kernel(&self, p: usize, q: usize, _r: &[T; 3]) -> [T; 3] {
        let (low, high) = (p.min(q) as i64, p.max(q) as i64);
        let value = |salt: i64| T::from_rational(&rational(low * 29 + high * 31 + 5, self.number, salt));
        [value(53), value(61), value(67)]
    }
}
