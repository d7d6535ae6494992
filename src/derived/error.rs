//! What can go wrong in the derived column.

use crate::exact::ExactError;
use crate::language::ground::MissingQuantity;
use std::ops::Range;
use thiserror::Error;

/// Why an expansion or one of its coefficients is not to be had.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DeriveError {
    /// A divisor vanishes identically.
    #[error("the divisor at bytes {} to {} is zero for all particles", span.start + 1, span.end)]
    DividesByZero {
        /// Bytes in the operator's text.
        span: Range<usize>,
    },
    /// The expansion has too many terms.
    #[error("the expansion takes more than {most} steps: ask for a lower order")]
    TooLarge {
        /// The limit.
        most: usize,
    },
    /// The order asked for is too high.
    #[error("order {order} is above {most}, the highest that can be asked for")]
    Order {
        /// As asked.
        order: usize,
        /// The limit.
        most: usize,
    },
    /// A tensor has another rank than asked.
    #[error("the tensor has rank {found}, not {wanted}")]
    Rank {
        /// Its rank.
        found: usize,
        /// What was asked.
        wanted: usize,
    },
    /// A coefficient has no value on these particles.
    #[error("the coefficient has no value at particle {particle}: {what}")]
    NoValue {
        /// The particle.
        particle: usize,
        /// Why.
        what: &'static str,
    },
    /// An expectation over the whole law of the displacements is not to be had.
    #[error(
        "the finite model takes moment sums with constant volumes, not {what}: ask for the linearised one"
    )]
    Finite {
        /// What was asked.
        what: &'static str,
    },
    /// The particles lack a quantity.
    #[error(transparent)]
    Missing(#[from] MissingQuantity),
    /// Exact arithmetic failed.
    #[error(transparent)]
    Exact(#[from] ExactError),
}
