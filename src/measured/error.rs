//! What the measured layer refuses: the one error type of the fits and of their windows.

use thiserror::Error;

/// What a fit can fail on. Every index counts from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is no degree of freedom left for the residuals.
    #[error("{found} usable points cannot carry this fit with an error estimate: give at least {needed}")]
    TooFewPoints {
        /// Points that were there.
        found: usize,
        /// Points the fit needs: one more than it has coefficients.
        needed: usize,
    },
    /// The design has no columns.
    #[error("the design has no columns: give at least one, for instance a column of ones for a constant")]
    NoColumns,
    /// Two inputs that go point by point differ in length.
    #[error("{what} has {found} entries where {expected} points were given: pass one entry per point")]
    LengthMismatch {
        /// The input at fault.
        what: Input,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A row of the design differs in length from the first.
    #[error(
        "design row {row} has {found} columns where row 0 has {expected}: give every row the same columns"
    )]
    RaggedDesign {
        /// The row at fault.
        row: usize,
        /// Its number of columns.
        found: usize,
        /// The number of columns of row 0.
        expected: usize,
    },
    /// A NaN or an infinity.
    #[error("{what} of point {index} is {value}: leave that point out or correct it")]
    NonFinite {
        /// The input at fault.
        what: Input,
        /// The point.
        index: usize,
        /// What stands there.
        value: f64,
    },
    /// A value that is finite and yet has no meaning here, such as a length that is not positive.
    #[error("{what} of point {index} is {value}, and must be {must_be}: leave that point out or correct it")]
    OutOfDomain {
        /// The input at fault.
        what: Input,
        /// The point.
        index: usize,
        /// What stands there.
        value: f64,
        /// The condition it breaks.
        must_be: &'static str,
    },
    /// A design column is a linear combination of those before it, as far as `f64` input can tell.
    #[error(
        "design column {column} is a combination of the columns before it to within rounding: \
         leave it out, add points at other abscissae, or subtract a common offset from the abscissae"
    )]
    RankDeficient {
        /// The first such column.
        column: usize,
    },
    /// A coefficient, its variance or a residual is beyond the range of `f64`.
    #[error("the fitted values exceed the range of f64: rescale the abscissae, y or the weights")]
    Overflow,
    /// A coverage outside the open interval (0, 1).
    #[error("coverage {coverage} is not strictly between 0 and 1: use for instance 0.95")]
    Coverage {
        /// The coverage asked for.
        coverage: f64,
    },
    /// An interval was asked for a coefficient that the fit does not have.
    #[error("there is no coefficient {index}: this fit has {count}, counted from 0")]
    NoSuchCoefficient {
        /// The coefficient asked for.
        index: usize,
        /// The number of coefficients.
        count: usize,
    },
    /// A window option has no meaning.
    #[error("window option {option} is {value}, and must be {must_be}")]
    WindowOption {
        /// The option's field name.
        option: &'static str,
        /// Its value.
        value: f64,
        /// The condition it breaks.
        must_be: &'static str,
    },
}

/// The input a [`FitError`] speaks of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Input {
    /// Abscissa.
    X,
    /// Ordinate.
    Y,
    /// Weight of the squared residual.
    Weight,
    /// An entry of the design in this column.
    Design(usize),
    /// One-sigma relative sampling error of `y`.
    RelativeError,
    /// Round-off floor of `y`.
    Floor,
}

impl std::fmt::Display for Input {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Input::X => f.write_str("x"),
            Input::Y => f.write_str("y"),
            Input::Weight => f.write_str("the weight"),
            Input::Design(column) => write!(f, "design column {column}"),
            Input::RelativeError => f.write_str("the relative error"),
            Input::Floor => f.write_str("the round-off floor"),
        }
    }
}
