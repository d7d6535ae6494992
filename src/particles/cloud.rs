//! The particle cloud: what a user measures and hands in.
//!
//! A [`Cloud`] is validated once, when it is built, and cannot be changed into an invalid one. Everything
//! downstream (neighbour lists, discrete moments, remainders) may therefore rely on finite coordinates,
//! positive volumes and positive supports without checking again.
//!
//! Lengths are in one unit chosen by the user, volumes in that unit to the power of the dimension.

use std::collections::BTreeMap;
use std::fmt;

use super::neighbours;

/// Coordinates, supports and periods lie within `1 / LENGTH_LIMIT ..= LENGTH_LIMIT` in magnitude (coordinates
/// may be smaller), so that a squared length neither overflows nor vanishes in `f64`.
pub const LENGTH_LIMIT: f64 = 1e150;

/// A coordinate lies at most this many periods from the origin, so that the number of the box it is in, and the
/// difference of two such numbers, is exact in `f64`.
pub const PERIODS_LIMIT: f64 = (1_u64 << 50) as f64;

/// The support radius $R$: the kernel of particle $i$ vanishes at distances $\ge R_i$.
#[derive(Debug, Clone, PartialEq)]
pub enum Support {
    /// One radius for all particles.
    Uniform(f64),
    /// One radius for each particle, in particle order.
    PerParticle(Vec<f64>),
}

/// A quantity carried by the particles, as named in errors.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Quantity {
    /// Particle volumes.
    Volume,
    /// Support radii.
    Support,
    /// Particle tags.
    Tag,
    /// A named scalar field.
    Field(String),
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Volume => f.write_str("volume"),
            Self::Support => f.write_str("support radius"),
            Self::Tag => f.write_str("tag"),
            Self::Field(name) => write!(f, "field `{name}`"),
        }
    }
}

/// Why a cloud was refused, or its neighbours not searched. Particles and axes are counted from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CloudError {
    /// The dimension is not 1, 2 or 3.
    #[error("the dimension is {found}; give 1, 2 or 3")]
    Dimension {
        /// The dimension given.
        found: usize,
    },
    /// There are no particles.
    #[error("the cloud has no particles; give at least one")]
    Empty,
    /// More particles than a 32-bit index can number.
    #[error(
        "the cloud has {found} particles, more than the {} that can be numbered; analyse a part of it",
        u32::MAX
    )]
    TooManyParticles {
        /// The number of particles given.
        found: usize,
    },
    /// A list does not have one entry for each particle.
    #[error("{quantity}: {found} values for {expected} particles; give one value for each particle")]
    Length {
        /// The list at fault.
        quantity: Quantity,
        /// Its length.
        found: usize,
        /// The number of particles.
        expected: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("particle {particle}: the {} coordinate is {value}; remove the particle or repair the input", axis_name(*.axis))]
    NonFiniteCoordinate {
        /// The particle at fault.
        particle: usize,
        /// The axis at fault.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// A coordinate is too large to be squared safely.
    #[error(
        "particle {particle}: the {} coordinate {value:e} exceeds {LENGTH_LIMIT:e}; choose another unit of length",
        axis_name(*.axis)
    )]
    CoordinateTooLarge {
        /// The particle at fault.
        particle: usize,
        /// The axis at fault.
        axis: usize,
        /// The coordinate.
        value: f64,
    },
    /// A coordinate along an axis that the dimension does not have.
    #[error(
        "particle {particle}: the {} coordinate is {value} in a cloud of dimension {dimension}; \
         set it to 0 or raise the dimension",
        axis_name(*.axis)
    )]
    UnusedAxis {
        /// The particle at fault.
        particle: usize,
        /// The axis at fault.
        axis: usize,
        /// The coordinate.
        value: f64,
        /// The dimension of the cloud.
        dimension: usize,
    },
    /// A value of a particle is NaN or infinite.
    #[error("particle {particle}: the {quantity} is {value}; every value must be finite")]
    NonFinite {
        /// The list at fault.
        quantity: Quantity,
        /// The particle at fault.
        particle: usize,
        /// The value.
        value: f64,
    },
    /// A volume or support radius is zero or negative.
    #[error("particle {particle}: the {quantity} is {value}; it must be positive")]
    NotPositive {
        /// The list at fault.
        quantity: Quantity,
        /// The particle at fault.
        particle: usize,
        /// The value.
        value: f64,
    },
    /// The support radius of one particle is too large or too small to be squared safely.
    #[error(
        "particle {particle}: the support radius {value:e} is outside {:e} to {LENGTH_LIMIT:e}; \
         choose another unit of length",
        LENGTH_LIMIT.recip()
    )]
    SupportOutOfRange {
        /// The particle at fault.
        particle: usize,
        /// The support radius.
        value: f64,
    },
    /// The common support radius cannot be used.
    #[error(
        "the support radius is {value}; it must be positive, finite and within {:e} to {LENGTH_LIMIT:e}",
        LENGTH_LIMIT.recip()
    )]
    UniformSupport {
        /// The support radius.
        value: f64,
    },
    /// A period cannot be used.
    #[error(
        "the period along {} is {value}; it must be positive, finite and within {:e} to {LENGTH_LIMIT:e} \
         (leave it out for an open axis)",
        axis_name(*.axis), LENGTH_LIMIT.recip()
    )]
    Period {
        /// The axis at fault.
        axis: usize,
        /// The period.
        value: f64,
    },
    /// A period along an axis that the dimension does not have.
    #[error(
        "a period is given along {} in a cloud of dimension {dimension}; leave it out or raise the dimension",
        axis_name(*.axis)
    )]
    UnusedPeriod {
        /// The axis at fault.
        axis: usize,
        /// The dimension of the cloud.
        dimension: usize,
    },
    /// A particle is so many boxes away that its place in the box is lost to rounding.
    #[error(
        "particle {particle}: the {} coordinate {value:e} is more than {PERIODS_LIMIT:e} periods of {period:e} away; \
         wrap it into the box",
        axis_name(*.axis)
    )]
    FarFromBox {
        /// The particle at fault.
        particle: usize,
        /// The axis at fault.
        axis: usize,
        /// The coordinate.
        value: f64,
        /// The period along that axis.
        period: f64,
    },
    /// Two fields have the same name.
    #[error("the field `{name}` is given twice; rename or drop one")]
    DuplicateField {
        /// The name.
        name: String,
    },
    /// The distance asked of [`Cloud::check_separation`] is not a positive finite number.
    #[error("the least separation asked for is {value}; give a positive, finite length")]
    Separation {
        /// The distance asked for.
        value: f64,
    },
    /// Two particles are closer than allowed.
    #[error("particles {i} and {j} are {distance:e} apart; remove or move one of them")]
    TooClose {
        /// The lower of the two particles.
        i: usize,
        /// The higher of the two particles.
        j: usize,
        /// Their distance, over the nearest periodic image.
        distance: f64,
    },
    /// A centre of a partial neighbour search is not a particle.
    #[error("centre number {position} is particle {particle}, but the particles are 0 to {}", .count - 1)]
    NoSuchParticle {
        /// The place in the list of centres.
        position: usize,
        /// The particle asked for.
        particle: usize,
        /// The number of particles, at least 1.
        count: usize,
    },
    /// The neighbour lists would need more memory than allowed.
    #[error(
        "the neighbour lists need {needed} bytes and {allowed} are allowed; \
         reduce the support radius, search at fewer centres or allow more"
    )]
    Memory {
        /// Bytes needed.
        needed: u64,
        /// Bytes allowed.
        allowed: u64,
    },
    /// The operating system did not provide the memory.
    #[error(
        "the neighbour lists need {needed} bytes, which could not be obtained; \
         reduce the support radius or search at fewer centres"
    )]
    Allocation {
        /// Bytes needed.
        needed: u64,
    },
}

fn axis_name(axis: usize) -> &'static str {
    ["x", "y", "z"].get(axis).copied().unwrap_or("unknown")
}

/// Two different particles and their distance, over the nearest periodic image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestPair {
    /// The lower particle index.
    pub i: usize,
    /// The higher particle index.
    pub j: usize,
    /// Their distance $|r_{ij}|$.
    pub distance: f64,
}

/// A validated particle cloud in $D = 1, 2, 3$ dimensions.
///
/// Lists are in particle order; positions are `[x, y, z]` with 0 on the unused axes, and may lie outside the
/// periodic box, of which only the lengths are known: $x$ and $x + L$ are the same place.
///
/// # Examples
/// ```
/// use remainder::particles::{Cloud, CloudError, Support};
///
/// let positions = vec![[0.125, 0.0, 0.0], [0.375, 0.0, 0.0], [0.875, 0.0, 0.0]];
/// let cloud = Cloud::new(1, positions, vec![0.25, 0.25, 0.5], Support::Uniform(0.5))?
///     .with_periods([Some(1.0), None, None])?
///     .with_field("density", vec![1.0, 1.0, 0.5])?;
/// let pair = cloud.closest_pair().ok_or(CloudError::Empty)?;
/// assert_eq!((pair.i, pair.j, pair.distance), (0, 1, 0.25)); // 0.875 is as near, over the boundary
/// # Ok::<(), CloudError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    dimension: usize,
    positions: Vec<[f64; 3]>,
    volumes: Vec<f64>,
    support: Support,
    periods: [Option<f64>; 3],
    tags: Vec<u32>,
    fields: BTreeMap<String, Vec<f64>>,
}

impl Cloud {
    /// An open cloud without fields, all tags 0.
    ///
    /// Coincident particles are accepted here, as looking for them costs a search: see
    /// [`check_separation`](Self::check_separation).
    ///
    /// # Errors
    /// [`CloudError`] names the first particle (and axis) at fault: dimension not 1 to 3, no particles, lists of
    /// different lengths, a number that is NaN or infinite, a coordinate on an unused axis, a volume or support
    /// that is not positive, a length beyond [`LENGTH_LIMIT`].
    pub fn new(
        dimension: usize,
        mut positions: Vec<[f64; 3]>,
        volumes: Vec<f64>,
        support: Support,
    ) -> Result<Self, CloudError> {
        if !(1..=3).contains(&dimension) {
            return Err(CloudError::Dimension { found: dimension });
        }
        if positions.is_empty() {
            return Err(CloudError::Empty);
        }
        let count = positions.len();
        if u32::try_from(count).is_err() {
            return Err(CloudError::TooManyParticles { found: count });
        }
        check_length(Quantity::Volume, volumes.len(), count)?;
        check_positions(dimension, &positions)?;
        check_positive(&Quantity::Volume, &volumes)?;
        check_support(&support, count)?;
        // -0 becomes 0, so that equal coordinates are equal bits.
        positions.iter_mut().flatten().for_each(|coordinate| *coordinate += 0.0);
        let tags = vec![0; count];
        Ok(Self { dimension, positions, volumes, support, periods: [None; 3], tags, fields: BTreeMap::new() })
    }

    /// The same cloud with the given box length along each periodic axis, `None` for an open axis.
    ///
    /// # Errors
    /// [`CloudError::Period`] for a length that is not positive, finite and within [`LENGTH_LIMIT`],
    /// [`CloudError::UnusedPeriod`] for one along an axis the cloud does not have, [`CloudError::FarFromBox`]
    /// for a particle beyond [`PERIODS_LIMIT`] boxes.
    pub fn with_periods(mut self, periods: [Option<f64>; 3]) -> Result<Self, CloudError> {
        for (axis, period) in periods.iter().enumerate() {
            let Some(period) = *period else { continue };
            if axis >= self.dimension {
                return Err(CloudError::UnusedPeriod { axis, dimension: self.dimension });
            }
            if !is_safe_length(period) {
                return Err(CloudError::Period { axis, value: period });
            }
            let far = |x: &[f64; 3]| (x[axis] / period).abs() > PERIODS_LIMIT;
            if let Some(particle) = self.positions.iter().position(far) {
                let value = self.positions[particle][axis];
                return Err(CloudError::FarFromBox { particle, axis, value, period });
            }
        }
        self.periods = periods;
        Ok(self)
    }

    /// The same cloud with one tag for each particle (a material, a boundary, a processor: the user's choice).
    ///
    /// # Errors
    /// [`CloudError::Length`] unless there is one tag for each particle.
    pub fn with_tags(mut self, tags: Vec<u32>) -> Result<Self, CloudError> {
        check_length(Quantity::Tag, tags.len(), self.len())?;
        self.tags = tags;
        Ok(self)
    }

    /// The same cloud with one more scalar field, in the user's units.
    ///
    /// # Errors
    /// [`CloudError::Length`] unless there is one value for each particle, [`CloudError::NonFinite`] for NaN or
    /// infinity, [`CloudError::DuplicateField`] if the name is taken.
    pub fn with_field(mut self, name: impl Into<String>, values: Vec<f64>) -> Result<Self, CloudError> {
        let name = name.into();
        if self.fields.contains_key(&name) {
            return Err(CloudError::DuplicateField { name });
        }
        let quantity = Quantity::Field(name.clone());
        check_length(quantity.clone(), values.len(), self.len())?;
        check_finite(&quantity, &values)?;
        self.fields.insert(name, values);
        Ok(self)
    }

    /// The dimension $D$: 1, 2 or 3.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The number of particles, at least 1.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Always false: an empty cloud cannot be built.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Positions as given (not wrapped), `[x, y, z]` for each particle.
    #[must_use]
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Particle volumes.
    #[must_use]
    pub fn volumes(&self) -> &[f64] {
        &self.volumes
    }

    /// The support radius or radii.
    #[must_use]
    pub fn support(&self) -> &Support {
        &self.support
    }

    /// The support radius $R_i$ of one particle.
    ///
    /// # Panics
    /// As a slice does, if supports are per particle and there is no particle `i`.
    #[must_use]
    pub fn support_of(&self, i: usize) -> f64 {
        match &self.support {
            Support::Uniform(radius) => *radius,
            Support::PerParticle(radii) => radii[i],
        }
    }

    /// The box length along each axis, `None` where open.
    #[must_use]
    pub fn periods(&self) -> [Option<f64>; 3] {
        self.periods
    }

    /// Particle tags, 0 unless given.
    #[must_use]
    pub fn tags(&self) -> &[u32] {
        &self.tags
    }

    /// All fields by name.
    #[must_use]
    pub fn fields(&self) -> &BTreeMap<String, Vec<f64>> {
        &self.fields
    }

    /// One field, if there is one of that name.
    #[must_use]
    pub fn field(&self, name: &str) -> Option<&[f64]> {
        self.fields.get(name).map(Vec::as_slice)
    }

    /// A pair $i < j$ of least distance over the nearest periodic images; `None` for a single particle.
    ///
    /// A particle and its own image do not count. Of several equally close pairs the one with the lowest $i$,
    /// then $j$, is returned; if particles coincide, *a* coincident pair is (always the same one).
    #[must_use]
    pub fn closest_pair(&self) -> Option<ClosestPair> {
        neighbours::closest_pair(self)
    }

    /// Makes sure that no two particles are closer than `min_distance` (strictly), which finds duplicates.
    ///
    /// # Errors
    /// [`CloudError::TooClose`] with the closest pair, [`CloudError::Separation`] if `min_distance` is not
    /// positive and finite.
    pub fn check_separation(&self, min_distance: f64) -> Result<(), CloudError> {
        if !(min_distance.is_finite() && min_distance > 0.0) {
            return Err(CloudError::Separation { value: min_distance });
        }
        match self.closest_pair() {
            Some(ClosestPair { i, j, distance }) if distance < min_distance => {
                Err(CloudError::TooClose { i, j, distance })
            }
            _ => Ok(()),
        }
    }
}

fn is_safe_length(length: f64) -> bool {
    (LENGTH_LIMIT.recip()..=LENGTH_LIMIT).contains(&length)
}

fn check_length(quantity: Quantity, found: usize, expected: usize) -> Result<(), CloudError> {
    if found == expected { Ok(()) } else { Err(CloudError::Length { quantity, found, expected }) }
}

fn check_positions(dimension: usize, positions: &[[f64; 3]]) -> Result<(), CloudError> {
    for (particle, x) in positions.iter().enumerate() {
        for (axis, &value) in x.iter().enumerate() {
            if !value.is_finite() {
                return Err(CloudError::NonFiniteCoordinate { particle, axis, value });
            }
            if axis >= dimension && value != 0.0 {
                return Err(CloudError::UnusedAxis { particle, axis, value, dimension });
            }
            if value.abs() > LENGTH_LIMIT {
                return Err(CloudError::CoordinateTooLarge { particle, axis, value });
            }
        }
    }
    Ok(())
}

fn check_finite(quantity: &Quantity, values: &[f64]) -> Result<(), CloudError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(particle) => {
            Err(CloudError::NonFinite { quantity: quantity.clone(), particle, value: values[particle] })
        }
        None => Ok(()),
    }
}

fn check_positive(quantity: &Quantity, values: &[f64]) -> Result<(), CloudError> {
    check_finite(quantity, values)?;
    match values.iter().position(|&value| value <= 0.0) {
        Some(particle) => {
            Err(CloudError::NotPositive { quantity: quantity.clone(), particle, value: values[particle] })
        }
        None => Ok(()),
    }
}

fn check_support(support: &Support, count: usize) -> Result<(), CloudError> {
    match support {
        Support::Uniform(radius) if is_safe_length(*radius) => Ok(()),
        Support::Uniform(radius) => Err(CloudError::UniformSupport { value: *radius }),
        Support::PerParticle(radii) => {
            check_length(Quantity::Support, radii.len(), count)?;
            check_positive(&Quantity::Support, radii)?;
            match radii.iter().position(|&radius| !is_safe_length(radius)) {
                Some(particle) => Err(CloudError::SupportOutOfRange { particle, value: radii[particle] }),
                None => Ok(()),
            }
        }
    }
}
