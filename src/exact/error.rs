//! The one error type of the exact layer.

/// Why an exact computation has no result.
///
/// "Undefined" and "cannot tell" are different failures: [`DivisionByZero`](Self::DivisionByZero) is a proof that the
/// quotient does not exist, [`DivisorMayVanish`](Self::DivisorMayVanish) only says that the enclosure is too wide to
/// exclude it. The same holds for the two square-root errors.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExactError {
    /// The text is not a number this layer reads exactly.
    #[error(
        "`{text}` is not a rational number: write an integer, a fraction such as -7/2, or a decimal such as 2.5 or 1e-3"
    )]
    NotARational {
        /// The offending text.
        text: String,
    },
    /// The decimal exponent is so large that the number would not fit in memory.
    #[error("the decimal exponent of `{text}` is beyond ±{limit}: write the number with a smaller exponent")]
    ExponentTooLarge {
        /// The offending text.
        text: String,
        /// Largest exponent read.
        limit: u32,
    },
    /// A NaN or an infinity where a number is needed.
    #[error("{value} is not a finite number and has no exact value")]
    NotFinite {
        /// The offending value.
        value: f64,
    },
    /// The divisor is proved to be zero.
    #[error("division by zero in {what}: the quotient does not exist")]
    DivisionByZero {
        /// The expression that was to be divided by.
        what: String,
    },
    /// The enclosure of the divisor contains zero.
    #[error("the divisor {divisor} is not separated from zero: compute it with more bits")]
    DivisorMayVanish {
        /// The enclosure of the divisor.
        divisor: String,
    },
    /// The radicand is proved to be negative.
    #[error("the square root of {radicand} is not real")]
    NegativeRadicand {
        /// The radicand.
        radicand: String,
    },
    /// The enclosure of the radicand reaches below zero.
    #[error("the radicand {radicand} is not separated from the negative numbers: compute it with more bits")]
    RadicandMayBeNegative {
        /// The enclosure of the radicand.
        radicand: String,
    },
    /// The squarefree part of an integer was not found by trial division.
    #[error(
        "the squarefree part of {integer} was not found with divisors up to {limit}: use Enclosure::sqrt_of_integer"
    )]
    NotFactored {
        /// The integer.
        integer: String,
        /// Largest divisor that was tried.
        limit: u64,
    },
    /// The number of knots does not fit the number of pieces.
    #[error(
        "{knots} knots cannot bound {pieces} pieces: give one knot more than pieces, and at least one piece"
    )]
    KnotCount {
        /// Number of knots given.
        knots: usize,
        /// Number of pieces given.
        pieces: usize,
    },
    /// The first knot is not zero.
    #[error("the first knot is {knot}: a radial function starts at 0")]
    FirstKnot {
        /// The first knot.
        knot: String,
    },
    /// The knots do not increase.
    #[error("knot {index} ({knot}) is not above the knot before it: list the knots in increasing order")]
    KnotsNotIncreasing {
        /// Position of the offending knot, counted from 0.
        index: usize,
        /// The offending knot.
        knot: String,
    },
    /// The text is not a product of the letters x, y and z.
    #[error(
        "`{text}` is not a multi-index: write at most 255 of each of the letters x, y and z, as in `xxy`"
    )]
    NotAMultiIndex {
        /// The offending text.
        text: String,
    },
    /// The dimension is not 1, 2 or 3.
    #[error("dimension {dimension} is not supported: use 1, 2 or 3")]
    Dimension {
        /// The offending dimension.
        dimension: usize,
    },
    /// The value is not inside its own bounds.
    #[error(
        "{value} with bounds [{low}, {high}] is not an interval: give finite numbers with low <= value <= high"
    )]
    NotAnInterval {
        /// The value.
        value: f64,
        /// The lower bound.
        low: f64,
        /// The upper bound.
        high: f64,
    },
}
