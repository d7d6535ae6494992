//! What can be wrong with a kernel.

use thiserror::Error;

/// Errors of the kernel layer.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum KernelError {
    /// No kernel of this name.
    #[error("there is no kernel '{id}'{}; known kernels: {known}", nearest.as_ref().map(|n| format!(" (did you mean '{n}'?)")).unwrap_or_default())]
    Unknown {
        /// The name given.
        id: String,
        /// The known name nearest to it.
        nearest: Option<String>,
        /// All known names.
        known: String,
    },
    /// The profile integrates to zero or less, so it cannot be normalised.
    #[error("kernel '{id}' has ∫ w(q) q^{} dq ≤ 0 and cannot be normalised in {dimension}-D", dimension - 1)]
    NotNormalisable {
        /// The kernel.
        id: String,
        /// The dimension.
        dimension: usize,
    },
    /// The profile vanishes identically.
    #[error("kernel '{id}' is zero everywhere: give at least one piece that is not")]
    Zero {
        /// The kernel.
        id: String,
    },
}
