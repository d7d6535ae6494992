//! What can be wrong with a kernel.

use crate::exact::ExactError;
use thiserror::Error;

/// Errors of the kernel layer.
#[derive(Debug, Clone, PartialEq, Error)]
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
    /// The cut of the Gaussian is missing or out of range.
    #[error(
        "'{parameters}' is no parameter of the Gaussian: write gaussian:cut=C with 0 < C ≤ {largest}, in units of h"
    )]
    Cut {
        /// What was given after the colon.
        parameters: String,
        /// The largest cut.
        largest: i64,
    },
    /// An id that cannot be used in scenes and reports.
    #[error("'{id}' cannot be the id of a kernel: use letters, digits, '-', '_' and '.'")]
    BadId {
        /// The id.
        id: String,
    },
    /// An id of the catalogue.
    #[error("'{id}' is a kernel of the catalogue: give your own another id")]
    Shadows {
        /// The id.
        id: String,
    },
    /// A number that is not rational.
    #[error("{source}")]
    Number {
        /// The path of its key.
        field: String,
        /// What is wrong with it.
        source: ExactError,
    },
    /// No pieces.
    #[error(
        "kernel '{id}' has no pieces: give at least one, as {{ to = \"1\", coefficients = [\"1\", \"-1\"] }}"
    )]
    NoPieces {
        /// The kernel.
        id: String,
    },
    /// A knot that is not beyond the one before.
    #[error("the piece ends at q = {to}, which is not beyond q = {from}, where it begins")]
    Knots {
        /// Which piece.
        piece: usize,
        /// Where it begins.
        from: String,
        /// Where it ends.
        to: String,
    },
    /// Two pieces that do not meet.
    #[error(
        "the pieces do not meet at q = {at}: {left} on the left, {right} on the right, a jump of {jump}; mend the \
         coefficients, or write allow_jumps = true if that is meant"
    )]
    DoNotMeet {
        /// The piece on the right.
        piece: usize,
        /// The knot.
        at: String,
        /// Value on the left.
        left: String,
        /// Value on the right.
        right: String,
        /// Right minus left.
        jump: String,
    },
    /// A printed constant that cannot be read.
    #[error("'{text}' is no normalisation in {dimension}-D: write {expected}")]
    Constant {
        /// What was given.
        text: String,
        /// The dimension.
        dimension: usize,
        /// What to write.
        expected: &'static str,
    },
    /// Not three constants.
    #[error("{given} normalisations: give three, for 1-D, 2-D and 3-D")]
    Constants {
        /// How many were given.
        given: usize,
    },
}

impl KernelError {
    /// The path of the key at fault in a definition of one's own.
    pub fn field(&self) -> String {
        match self {
            Self::Number { field, .. } => field.clone(),
            Self::Knots { piece, .. } => format!("pieces.{piece}.to"),
            Self::DoNotMeet { piece, .. } => format!("pieces.{piece}.coefficients"),
            Self::Constant { dimension, .. } => format!("normalisation.{}", dimension - 1),
            Self::Constants { .. } => "normalisation".into(),
            Self::BadId { .. } | Self::Shadows { .. } => "id".into(),
            _ => "pieces".into(),
        }
    }
}
