//! What can be wrong with claims.

use thiserror::Error;

/// Errors of the claim layer.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ClaimError {
    /// No claim or group of claims of this name.
    #[error("there is no claim '{name}'{}; `remainder list claims` prints all", nearest.as_ref().map(|n| format!(" (did you mean '{n}'?)")).unwrap_or_default())]
    Unknown {
        /// The name given.
        name: String,
        /// The nearest known name.
        nearest: Option<String>,
    },
    /// An exponent that cannot be read.
    #[error("'{text}' is no exponent: write a rational in beta such as 2, -1/2, beta-1 or 2*beta+1/2")]
    Exponent {
        /// As written.
        text: String,
    },
    /// Exponents of lengths that do not match what the claim is about.
    #[error("the exponents of d̃ and h add up to {found}, but {subject} is a length to the power {needed}")]
    Dimension {
        /// The moment sum or coefficient.
        subject: String,
        /// The sum of the exponents.
        found: String,
        /// p − q.
        needed: i32,
    },
}
