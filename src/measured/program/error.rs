//! What compiling an operator, or applying it, can fail on.

use std::ops::Range;
use thiserror::Error;

/// Why an operator was not compiled, or not applied. Particles are counted from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ProgramError {
    /// A dimension that is not 1, 2 or 3.
    #[error("the dimension is {found}; give 1, 2 or 3")]
    Dimension {
        /// The dimension given.
        found: usize,
    },
    /// A sum over the neighbours of one particle that cannot be taken without knowing another.
    #[error(
        "bytes {} to {}: this sum depends on a particle that is neither its own nor its neighbour, and not by a factor; \
         write it without that particle inside",
        .span.start + 1, .span.end
    )]
    Entangled {
        /// The bytes of the sum in the operator's text.
        span: Range<usize>,
    },
    /// The cloud has another dimension than the program.
    #[error("the program was compiled for dimension {expected}, the cloud has dimension {found}")]
    OtherDimension {
        /// The dimension of the program.
        expected: usize,
        /// The dimension of the cloud.
        found: usize,
    },
    /// The particles do not have the same support.
    #[error("particle {particle} has another support than particle 0; a program wants one support for all")]
    Supports {
        /// The first such particle.
        particle: usize,
    },
    /// The cloud lacks a quantity.
    #[error("the operator wants the {name} of each particle; give the cloud a field '{name}'")]
    MissingField {
        /// The name of the cloud's field.
        name: &'static str,
    },
    /// The operator acts on u and v was given, or the other way round.
    #[error("the operator acts on {expected}; give its values")]
    OtherField {
        /// `u` or `v`.
        expected: &'static str,
    },
    /// There is not one value of the field for each particle.
    #[error("{found} values of the field for {expected} particles; give one for each")]
    Length {
        /// The number of values.
        found: usize,
        /// The number of particles.
        expected: usize,
    },
    /// The neighbours of some particles only, where sums at neighbours need those of all.
    #[error(
        "{found} neighbour lists for {expected} particles; this operator needs the list of every particle"
    )]
    Lists {
        /// The number of lists.
        found: usize,
        /// The number of particles.
        expected: usize,
    },
    /// A tensor that has no inverse.
    #[error(
        "particle {particle}: {tensor} does not exist, the tensor to be inverted is singular; add neighbours"
    )]
    Singular {
        /// The particle.
        particle: usize,
        /// What was to be computed.
        tensor: &'static str,
    },
    /// The largest of all values is below the numbers that keep their digits.
    #[error(
        "particle {particle}: the value is too small for a number that keeps its digits; choose another unit of length"
    )]
    TooSmall {
        /// The particle of the largest value.
        particle: usize,
    },
    /// A value that is not finite: a division by zero, a neighbour that the cloud does not have, or a field that is not
    /// finite itself.
    #[error(
        "particle {particle}: the value is {value}; look for a divisor that vanishes, or a field that is not finite"
    )]
    NotFinite {
        /// The particle.
        particle: usize,
        /// The value.
        value: f64,
    },
}
