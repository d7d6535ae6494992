//! `[[define.lattice]]`: lattices of one's own, from written coordinates to the whole numbers of [`Lattice`].
//!
//! A written coordinate c_a is rational; the place it means is c_a √s_a with s_a of `axis_squares`, in a unit that drops out:
//! all lengths are divided by Δ. With c_a = k_a / n_a the lattice has r_a/Δ = k_a √(s_a / (n_a² Δ²)), where Δ² is rational,
//! so nothing is rounded.

use super::source::{SceneError, SceneText};
use crate::exact::{Rational, int, parse_rational};
use crate::names::nearest;
use crate::particles::lattice::{MOST_PARTICLES, catalogue};
use crate::particles::{Lattice, SiteIndex};
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive, Zero};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[[define.lattice]]`: a lattice of one's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OwnLattice {
    /// The id it is named by in `cases.lattices`; none of the catalogue's.
    pub id: String,
    /// D: 1, 2 or 3.
    pub dimension: u8,
    /// The D vectors that span a cell, each with D rational coordinates: `[["1", "0"], ["1/2", "1"]]`.
    pub vectors: Vec<Vec<String>>,
    /// The particles of a cell; sums are taken at the first. By default one particle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub basis: Vec<Vec<String>>,
    /// By axis, the square of what a written coordinate is multiplied with: `["1", "3"]` makes (1/2, 1/2) the place
    /// (1/2, √3/2). By default ones.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axis_squares: Vec<String>,
    /// What Δ is: `cell-edge`, the length of the first vector (the default), or `nearest-neighbour`, the least distance.
    #[serde(default = "cell_edge")]
    pub unit: String,
}

const UNITS: [&str; 2] = ["cell-edge", "nearest-neighbour"];

fn cell_edge() -> String {
    UNITS[0].into()
}

/// Written coordinates are multiples of one fraction per axis, at most this many times it: whole-number volumes and sums
/// over supports then stay within their types.
const MOST_STEPS: i64 = 10_000;

/// Numerators and denominators of `axis_squares` are at most this.
const LARGEST_SQUARE_PART: i64 = 1_000_000;

/// The lattices a scene defines.
///
/// # Errors
/// [`SceneError`] at the entry at fault.
pub(super) fn resolve(own: &[OwnLattice], text: &SceneText) -> Result<Vec<Lattice>, SceneError> {
    let mut lattices: Vec<Lattice> = Vec::new();
    for (index, entry) in own.iter().enumerate() {
        let fault = |keys: String, message: String| {
            text.error_at(&format!("define.lattice.{index}.{keys}"), message, None)
        };
        let lattice = entry.lattice().map_err(|(keys, message)| fault(keys, message))?;
        if catalogue().iter().any(|known| known.id() == entry.id) {
            let message = format!("'{}' is a lattice of the catalogue: choose another id", entry.id);
            return Err(fault("id".into(), message));
        }
        if lattices.iter().any(|known| known.id() == entry.id) {
            return Err(fault("id".into(), format!("'{}' is defined twice", entry.id)));
        }
        lattices.push(lattice);
    }
    Ok(lattices)
}

/// The keys of what is at fault within the entry, and what is wrong with it.
type Fault = (String, String);

impl OwnLattice {
    fn lattice(&self) -> Result<Lattice, Fault> {
        let fault = |keys: &str, message: String| Err((keys.to_owned(), message));
        if self.id.trim().is_empty() || self.id.contains(['/', ',', ':']) || self.id != self.id.trim() {
            return fault("id", format!("'{}' is no id: write a word without '/', ',' and ':'", self.id));
        }
        let d = usize::from(self.dimension);
        if !(1..=3).contains(&d) {
            return fault("dimension", format!("dimension {d} is not 1, 2 or 3"));
        }
        if self.vectors.len() != d {
            return fault("vectors", format!("{} vectors in dimension {d}: give {d}", self.vectors.len()));
        }
        if self.basis.len() > MOST_PARTICLES {
            let count = self.basis.len();
            return fault(
                "basis",
                format!("{count} particles in a cell, more than the {MOST_PARTICLES} admitted"),
            );
        }
        let Some(unit) = UNITS.iter().position(|unit| *unit == self.unit) else {
            let hint =
                nearest(&self.unit, &UNITS).map(|u| format!(" (did you mean '{u}'?)")).unwrap_or_default();
            return fault(
                "unit",
                format!("there is no unit '{}'{hint}; units are {}", self.unit, UNITS.join(", ")),
            );
        };
        let squares = self.squares(d)?;
        let vectors = places("vectors", &self.vectors, d)?;
        let mut basis = places("basis", &self.basis, d)?;
        let first = basis.first().cloned().unwrap_or_else(|| vec![int(0); d]);
        basis.iter_mut().for_each(|place| place.iter_mut().zip(&first).for_each(|(c, origin)| *c -= origin));
        if basis.is_empty() {
            basis.push(first);
        }

        let mut steps: [Rational; 3] = [int(1), int(1), int(1)];
        for (a, step) in steps.iter_mut().enumerate().take(d) {
            *step = common_measure(vectors.iter().chain(&basis).map(|place| &place[a]));
        }
        let whole = |(list, index): (&str, usize), place: &[Rational]| -> Result<SiteIndex, Fault> {
            let mut k = [0; 3];
            for (a, c) in place.iter().enumerate() {
                k[a] = (c / &steps[a]).to_integer().to_i64().filter(|k| k.abs() <= MOST_STEPS).ok_or_else(|| {
                    let message = format!(
                        "coordinate {c} is more than {MOST_STEPS} times {}, the common measure of its axis: write \
                         coordinates with smaller denominators",
                        steps[a]
                    );
                    (format!("{list}.{index}.{a}"), message)
                })?;
            }
            Ok(k)
        };
        let mut k_vectors = [[0; 3]; 3];
        for (index, place) in vectors.iter().enumerate() {
            k_vectors[index] = whole(("vectors", index), place)?;
        }
        let k_basis: Vec<SiteIndex> = basis
            .iter()
            .enumerate()
            .map(|(index, place)| whole(("basis", index), place))
            .collect::<Result<_, _>>()?;
        let scaled: [Rational; 3] =
            std::array::from_fn(|a| if a < d { &squares[a] * &steps[a] * &steps[a] } else { int(1) });
        let lattice = |squares: &[Rational; 3], vectors, basis: &[SiteIndex]| {
            Lattice::new(&self.id, &self.id, d, squares.clone(), vectors, basis.to_vec())
                .map_err(|error| ("vectors".to_owned(), error.to_string()))
        };
        let cell = lattice(&scaled, k_vectors, &[[0; 3]])?;
        for (j, b) in k_basis.iter().enumerate() {
            let same = |a: &SiteIndex| cell.is_lattice_vector(std::array::from_fn(|axis| b[axis] - a[axis]));
            if let Some(i) = k_basis[..j].iter().position(same) {
                let message = format!(
                    "particles {} and {} of the basis are in one place, cells repeated: move or remove one",
                    i + 1,
                    j + 1
                );
                return fault(&format!("basis.{j}"), message);
            }
        }
        let vectors = reduced(&cell, k_vectors);
        let dx_square = match unit {
            0 => cell.square(&k_vectors[0]),
            _ => lattice(&scaled, vectors, &k_basis)?.least_square(),
        };
        let squares = std::array::from_fn(|a| if a < d { &scaled[a] / &dx_square } else { int(1) });
        lattice(&squares, vectors, &k_basis)
    }

    fn squares(&self, d: usize) -> Result<Vec<Rational>, Fault> {
        if self.axis_squares.is_empty() {
            return Ok(vec![int(1); d]);
        }
        if self.axis_squares.len() != d {
            let message = format!("{} axis squares in dimension {d}: give {d}", self.axis_squares.len());
            return Err(("axis_squares".to_owned(), message));
        }
        let read = |(a, text): (usize, &String)| {
            let fault = |message: String| (format!("axis_squares.{a}"), message);
            let square = parse_rational(text).map_err(|error| fault(error.to_string()))?;
            let small = |n: &num_bigint::BigInt| n.to_i64().is_some_and(|n| n <= LARGEST_SQUARE_PART);
            if !square.is_positive() || !small(square.numer()) || !small(square.denom()) {
                return Err(fault(format!(
                    "the axis square {square} must be positive, its numerator and denominator at most {LARGEST_SQUARE_PART}"
                )));
            }
            Ok(square)
        };
        self.axis_squares.iter().enumerate().map(read).collect()
    }
}

/// Reads a list of places with D coordinates each.
fn places(list: &str, written: &[Vec<String>], d: usize) -> Result<Vec<Vec<Rational>>, Fault> {
    let place = |(index, place): (usize, &Vec<String>)| {
        if place.len() != d {
            let message = format!("{} coordinates in dimension {d}: give {d}", place.len());
            return Err((format!("{list}.{index}"), message));
        }
        let read = |(a, text): (usize, &String)| {
            parse_rational(text).map_err(|error| (format!("{list}.{index}.{a}"), error.to_string()))
        };
        place.iter().enumerate().map(read).collect()
    };
    written.iter().enumerate().map(place).collect()
}

/// The largest rational of which all values are whole multiples; 1 if all are zero.
fn common_measure<'a>(values: impl Iterator<Item = &'a Rational> + Clone) -> Rational {
    let denominator = values.clone().fold(int(1).to_integer(), |lcm, value| lcm.lcm(value.denom()));
    let scale = Rational::from_integer(denominator.clone());
    let numerator = values.fold(int(0).to_integer(), |gcd, value| gcd.gcd(&(value * &scale).to_integer()));
    if numerator.is_zero() { int(1) } else { Rational::new(numerator, denominator) }
}

/// Shorter vectors that span the same cell lattice: each is shortened by whole multiples of the others until none can be.
/// Long slanted cells would make every search for sites walk through empty space.
fn reduced(lattice: &Lattice, mut vectors: [SiteIndex; 3]) -> [SiteIndex; 3] {
    let d = lattice.dimension();
    let product = |a: &SiteIndex, b: &SiteIndex| {
        (0..d).fold(int(0), |sum, axis| sum + &lattice.axis_squares()[axis] * int(a[axis] * b[axis]))
    };
    loop {
        let mut changed = false;
        for i in 0..d {
            for j in (0..d).filter(|j| *j != i) {
                let other = vectors[j];
                let times = (product(&vectors[i], &other) / product(&other, &other)).round().to_integer();
                let times = times.to_i64().unwrap_or(0);
                let shorter: SiteIndex = std::array::from_fn(|a| vectors[i][a] - times * other[a]);
                if product(&shorter, &shorter) < product(&vectors[i], &vectors[i]) {
                    vectors[i] = shorter;
                    changed = true;
                }
            }
        }
        if !changed {
            return vectors;
        }
    }
}
