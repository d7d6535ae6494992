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
    /// ∇^q W is singular at the origin, where the sum has no limit to have an order against.
    #[error(
        "{kernel} has the odd power r^{power} at the origin, so that the {derivatives} derivatives in {moment} are singular \
         there: take a moment with fewer derivatives, or a kernel that is smoother at the origin"
    )]
    SingularSummand {
        /// The moment.
        moment: String,
        /// The kernel.
        kernel: String,
        /// s.
        power: usize,
        /// q.
        derivatives: usize,
    },
    /// A sum over reciprocal shells does not converge absolutely.
    #[error(
        "the sum over shells that multiplies (Δ/h)^{exponent} in {moment} does not converge absolutely: the exponent stands, \
         the amplitude has no bound"
    )]
    Diverges {
        /// The moment.
        moment: String,
        /// The leading exponent.
        exponent: String,
    },
    /// A spectrum has no root mean square of its own.
    #[error(
        "a spectrum k^({exponent}) is not integrable at k = 0 in {dimension} dimensions: give an exponent above -{dimension}"
    )]
    Spectrum {
        /// As asked.
        exponent: String,
        /// D.
        dimension: usize,
    },
    /// A disorder has no meaning in one dimension.
    #[error("{what} needs at least 2 dimensions, and lattice '{lattice}' has one: take a lattice of 2 or 3")]
    DisorderDimension {
        /// What.
        what: &'static str,
        /// The lattice.
        lattice: String,
    },
    /// The particles lack a quantity.
    #[error(transparent)]
    Missing(#[from] MissingQuantity),
    /// Exact arithmetic failed.
    #[error(transparent)]
    Exact(#[from] ExactError),
}
