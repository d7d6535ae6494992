//! Weighted linear least squares, accurate to the digits its input holds.
//!
//! Measured errors arrive as ladders `(x, y)`; [`crate::measured::window`] takes their logarithms and asks this module for the
//! line through them. The fit minimises
//!
//! $$ S(b) = \sum_i w_i \Bigl( y_i - \sum_j X_{ij} b_j \Bigr)^2 $$
//!
//! by Householder QR (Golub & Van Loan, *Matrix Computations*, §5.3) of the weighted design, carried out from end to end in
//! double-double arithmetic (Dekker, *Numer. Math.* 18 (1971) 224; about 32 digits). Columns, weights and `y` are first scaled by
//! powers of two, which is exact. No fused multiply-add is used and nothing depends on the processor's vector width, so
//! the same input gives the same bits on every machine; a general matrix library does not promise that.
//! `tests/nist.rs` holds the result against the NIST Statistical Reference Datasets.

use double_double::Dd;
use thiserror::Error;

/// A column whose part orthogonal to the columns before it is this small, relative to its own norm, counts as dependent on them.
///
/// Entries of a column that is a linear combination of others, computed in `f64`, carry a few roundings of 2⁻⁵³ each: 8 × 2⁻⁵²
/// is above those, and below it the orthogonal part would be made of input rounding, however exact the arithmetic here.
const RANK_TOLERANCE: f64 = 8.0 * f64::EPSILON;

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

/// A value with the interval around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Estimate {
    /// The interval `value ± half_width`.
    pub fn symmetric(value: f64, half_width: f64) -> Self {
        Estimate { value, low: value - half_width, high: value + half_width }
    }

    /// Whether `x` lies in the closed interval `[low, high]`.
    pub fn contains(&self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }
}

/// A weighted linear least-squares fit with `p` coefficients through `n` points.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearFit {
    /// $b_j$, in the order of the design's columns; units of `y` over those of the column.
    pub coefficients: Vec<f64>,
    /// $\sqrt{\mathrm{covariance}_{jj}}$, the scale being estimated from the residuals.
    pub standard_errors: Vec<f64>,
    /// $s = \sqrt{S(b) / (n - p)}$; units of `y` times those of $\sqrt{w}$.
    pub residual_sd: f64,
    /// $n - p \ge 1$.
    pub degrees_of_freedom: usize,
    /// $1 - S(b) / \sum_i w_i (y_i - \bar y)^2$ with the weighted mean $\bar y$ when a column of the design is constant, and
    /// $\bar y = 0$ otherwise (as NIST does for fits without a constant). `None` when the denominator is zero.
    pub r_squared: Option<f64>,
    /// $y_i - \sum_j X_{ij} b_j$ in the order of the points, not multiplied by a weight; units of `y`.
    pub residuals: Vec<f64>,
    /// $s^2 (X^\mathsf{T} W X)^{-1}$, `p × p`, symmetric, indexed `[j][k]` as the coefficients.
    pub covariance: Vec<Vec<f64>>,
    /// $(X^\mathsf{T} W X)^{-1}$, indexed as `covariance`: the covariance itself if the weights are $1/\sigma_i^2$ with
    /// known $\sigma_i$.
    pub cofactor: Vec<Vec<f64>>,
}

impl LinearFit {
    /// Coefficient `k` with its Student-t interval, $b_k \pm t_{\mathrm{coverage},\,n-p}\; \mathrm{se}_k$.
    ///
    /// # Errors
    /// [`FitError::NoSuchCoefficient`], [`FitError::Coverage`].
    pub fn interval(&self, k: usize, coverage: f64) -> Result<Estimate, FitError> {
        let (Some(&value), Some(&standard_error)) = (self.coefficients.get(k), self.standard_errors.get(k))
        else {
            return Err(FitError::NoSuchCoefficient { index: k, count: self.coefficients.len() });
        };
        Ok(Estimate::symmetric(value, student_t(coverage, self.degrees_of_freedom)? * standard_error))
    }
}

/// A weighted straight line, `y = intercept + slope·x`.
#[derive(Debug, Clone, PartialEq)]
pub struct LineFit {
    /// The value at `x = 0`.
    pub intercept: f64,
    /// The change of `y` per unit of `x`.
    pub slope: f64,
    /// Everything else, coefficients in the order intercept, slope.
    pub fit: LinearFit,
}

/// Weighted straight line through `points`, each `(x, y, weight)`; the weight multiplies the squared residual.
///
/// # Errors
/// [`FitError::TooFewPoints`] below three points, [`FitError::NonFinite`], [`FitError::OutOfDomain`] for a weight that is not
/// positive, [`FitError::RankDeficient`] when all `x` agree, [`FitError::Overflow`].
///
/// # Examples
/// ```
/// use remainder::measured::fit::line;
/// let fit = line(&[(0.0, 1.0, 1.0), (1.0, 3.0, 1.0), (2.0, 5.0, 1.0)])?;
/// assert_eq!((fit.intercept, fit.slope), (1.0, 2.0));
/// # Ok::<(), remainder::measured::fit::FitError>(())
/// ```
pub fn line(points: &[(f64, f64, f64)]) -> Result<LineFit, FitError> {
    let x: Vec<f64> = points.iter().map(|point| point.0).collect();
    let y: Vec<f64> = points.iter().map(|point| point.1).collect();
    let weights: Vec<f64> = points.iter().map(|point| point.2).collect();
    let fit = weighted_polynomial(&x, &y, Some(&weights), 1)?;
    Ok(LineFit { intercept: fit.coefficients[0], slope: fit.coefficients[1], fit })
}

/// Polynomial $y = \sum_{j=0}^{\mathrm{degree}} b_j x^j$ with unit weights; the powers are formed in double-double.
///
/// # Errors
/// As [`line()`], and [`FitError::LengthMismatch`]; it needs `degree + 2` points at `degree + 1` distinct abscissae.
pub fn polynomial(x: &[f64], y: &[f64], degree: usize) -> Result<LinearFit, FitError> {
    weighted_polynomial(x, y, None, degree)
}

/// As [`polynomial`], point `i` weighing `weights[i]`.
///
/// # Errors
/// As [`polynomial`].
pub fn weighted_polynomial(
    x: &[f64],
    y: &[f64],
    weights: Option<&[f64]>,
    degree: usize,
) -> Result<LinearFit, FitError> {
    check_finite(Input::X, x)?;
    let exponent = scale_exponent(x.iter().copied());
    let scaled: Vec<f64> = x.iter().map(|&v| libm::scalbn(v, -exponent)).collect();
    let mut columns = Vec::with_capacity(degree + 1);
    let mut power = vec![Dd::ONE; x.len()];
    for _ in 0..degree {
        let next = power.iter().zip(&scaled).map(|(&p, &v)| p * Dd::from(v)).collect();
        columns.push(Column::new(std::mem::replace(&mut power, next), exponent * columns.len() as i32));
    }
    columns.push(Column::new(power, exponent * degree as i32));
    solve(&columns, y, weights, x.len())
}

/// Least squares with a design of the caller's columns; `design[i][j]` is column `j` at point `i`, and a constant term is a
/// column of ones.
///
/// # Errors
/// [`FitError::TooFewPoints`] unless there are more points than columns, [`FitError::NoColumns`], [`FitError::RaggedDesign`],
/// [`FitError::LengthMismatch`], [`FitError::NonFinite`], [`FitError::OutOfDomain`] for a weight that is not positive,
/// [`FitError::RankDeficient`], [`FitError::Overflow`].
///
/// # Examples
/// ```
/// use remainder::measured::fit::multilinear;
/// // y = 2 x₁ − x₂, without a constant
/// let design = [vec![1.0, 0.0], vec![0.0, 1.0], vec![1.0, 1.0]];
/// let fit = multilinear(&design, &[2.0, -1.0, 1.0], None)?;
/// assert!((fit.coefficients[0] - 2.0).abs() < 1e-15 && (fit.coefficients[1] + 1.0).abs() < 1e-15);
/// # Ok::<(), remainder::measured::fit::FitError>(())
/// ```
pub fn multilinear(design: &[Vec<f64>], y: &[f64], weights: Option<&[f64]>) -> Result<LinearFit, FitError> {
    let Some(first) = design.first() else { return Err(FitError::TooFewPoints { found: 0, needed: 2 }) };
    let expected = first.len();
    if let Some((row, entries)) = design.iter().enumerate().find(|(_, entries)| entries.len() != expected) {
        return Err(FitError::RaggedDesign { row, found: entries.len(), expected });
    }
    let mut columns = Vec::with_capacity(expected);
    for j in 0..expected {
        let column: Vec<f64> = design.iter().map(|row| row[j]).collect();
        check_finite(Input::Design(j), &column)?;
        columns.push(Column::new(column.into_iter().map(Dd::from).collect(), 0));
    }
    solve(&columns, y, weights, design.len())
}

/// The half-width of a two-sided Student-t interval in standard errors: the `t` with `P(|T| ≤ t) = coverage`.
///
/// # Formula
/// With `θ = atan(t/√ν)` the probability is a finite trigonometric sum (Abramowitz & Stegun 26.7.3–4), here solved for `θ`
/// by bisection down to neighbouring numbers. It uses `libm` alone and so gives the same bits everywhere; `statrs` is
/// its witness in the tests.
///
/// # Errors
/// [`FitError::Coverage`] outside (0, 1); [`FitError::TooFewPoints`] without a degree of freedom.
///
/// # Examples
/// ```
/// use remainder::measured::fit::student_t;
/// assert!((student_t(0.95, 10)? - 2.228_138_851_986_275).abs() < 1e-14); // printed tables: 2.228
/// # Ok::<(), remainder::measured::fit::FitError>(())
/// ```
pub fn student_t(coverage: f64, degrees_of_freedom: usize) -> Result<f64, FitError> {
    if !(coverage > 0.0 && coverage < 1.0) {
        return Err(FitError::Coverage { coverage });
    }
    if degrees_of_freedom == 0 {
        return Err(FitError::TooFewPoints { found: 0, needed: 1 });
    }
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    loop {
        let theta = 0.5 * (low + high);
        if theta <= low || theta >= high {
            return Ok((degrees_of_freedom as f64).sqrt() * libm::tan(low));
        }
        if probability_within(theta, degrees_of_freedom) < coverage { low = theta } else { high = theta }
    }
}

/// `P(|T| ≤ √ν tan θ)` for `ν ≥ 1` degrees of freedom, Abramowitz & Stegun 26.7.3 (odd ν) and 26.7.4 (even ν).
fn probability_within(theta: f64, nu: usize) -> f64 {
    let (sine, cosine) = (libm::sin(theta), libm::cos(theta));
    let odd = nu % 2 == 1;
    let mut term = if odd { cosine } else { 1.0 };
    let mut sum = if nu == 1 { 0.0 } else { term };
    for k in (if odd { 3 } else { 2 }..nu.saturating_sub(1)).step_by(2) {
        term *= cosine * cosine * (k - 1) as f64 / k as f64;
        sum += term;
        // The rest is below term/sin²θ, and sin²θ ≈ t²/ν: negligible for any ν a list of points can have.
        if term < 1e-24 * sum {
            break;
        }
    }
    if odd { std::f64::consts::FRAC_2_PI * (theta + sine * sum) } else { sine * sum }
}

/// One column of the design, stored as `2^-exponent` times its true value with largest magnitude in [1/2, 1).
struct Column {
    scaled: Vec<Dd>,
    exponent: i32,
}

impl Column {
    /// The column of true value `entries · 2^exponent`.
    fn new(entries: Vec<Dd>, exponent: i32) -> Self {
        let extra = scale_exponent(entries.iter().map(|entry| entry.to_f64()));
        let scaled = entries.into_iter().map(|entry| entry.scaled_by(-extra)).collect();
        Column { scaled, exponent: exponent + extra }
    }

    /// Whether the column holds one non-zero value throughout, and so lets the fit have a constant term.
    fn is_constant(&self) -> bool {
        self.scaled.first().is_some_and(|&first| first != Dd::ZERO && self.scaled.iter().all(|&v| v == first))
    }
}

/// The `e` for which the largest magnitude lies in `[2^(e-1), 2^e)`; 0 if all are zero.
fn scale_exponent(values: impl Iterator<Item = f64>) -> i32 {
    libm::frexp(values.fold(0.0, |largest: f64, v| largest.max(v.abs()))).1
}

fn check_finite(what: Input, values: &[f64]) -> Result<(), FitError> {
    match values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        Some((index, &value)) => Err(FitError::NonFinite { what, index, value }),
        None => Ok(()),
    }
}

fn check_length(what: Input, found: usize, expected: usize) -> Result<(), FitError> {
    if found == expected { Ok(()) } else { Err(FitError::LengthMismatch { what, found, expected }) }
}

/// √w for every point, as `2^-exponent` times its true value.
fn root_weights(weights: Option<&[f64]>, points: usize) -> Result<(Vec<Dd>, i32), FitError> {
    let Some(weights) = weights else { return Ok((vec![Dd::ONE; points], 0)) };
    check_length(Input::Weight, weights.len(), points)?;
    check_finite(Input::Weight, weights)?;
    if let Some((index, &value)) = weights.iter().enumerate().find(|&(_, &w)| w <= 0.0) {
        return Err(FitError::OutOfDomain { what: Input::Weight, index, value, must_be: "positive" });
    }
    let half = scale_exponent(weights.iter().copied()).div_euclid(2);
    Ok((weights.iter().map(|&w| Dd::from(libm::scalbn(w, -2 * half)).sqrt()).collect(), half))
}

/// The fit itself, on checked and scaled columns of `points` entries each.
fn solve(
    columns: &[Column],
    y: &[f64],
    weights: Option<&[f64]>,
    points: usize,
) -> Result<LinearFit, FitError> {
    let p = columns.len();
    if p == 0 {
        return Err(FitError::NoColumns);
    }
    check_length(Input::Y, y.len(), points)?;
    check_finite(Input::Y, y)?;
    let (root_w, w_exponent) = root_weights(weights, points)?;
    if points <= p {
        return Err(FitError::TooFewPoints { found: points, needed: p + 1 });
    }
    let y_exponent = scale_exponent(y.iter().copied());
    let y: Vec<Dd> = y.iter().map(|&v| Dd::from(libm::scalbn(v, -y_exponent))).collect();

    let weighted = |values: &[Dd]| values.iter().zip(&root_w).map(|(&v, &rw)| v * rw).collect();
    let qr = Triangle::factor(columns.iter().map(|c| weighted(&c.scaled)).collect(), weighted(&y))?;
    let b = qr.coefficients();
    let r_inverse = qr.inverse();

    let mut residuals = y.clone();
    for (column, &b_j) in columns.iter().zip(&b) {
        for (r, &x) in residuals.iter_mut().zip(&column.scaled) {
            *r = *r - x * b_j;
        }
    }
    let square_sum = |values: &[Dd]| {
        values.iter().zip(&root_w).map(|(&v, &rw)| v * rw * (v * rw)).fold(Dd::ZERO, |sum, term| sum + term)
    };
    let residual_square_sum = square_sum(&residuals);
    let degrees_of_freedom = points - p;
    let variance = residual_square_sum / Dd::from(degrees_of_freedom as f64);

    let mean = if columns.iter().any(Column::is_constant) {
        let total = root_w.iter().fold(Dd::ZERO, |sum, &rw| sum + rw * rw);
        y.iter().zip(&root_w).fold(Dd::ZERO, |sum, (&v, &rw)| sum + rw * rw * v) / total
    } else {
        Dd::ZERO
    };
    let total_square_sum = square_sum(&y.iter().map(|&v| v - mean).collect::<Vec<_>>());
    let r_squared =
        (total_square_sum != Dd::ZERO).then(|| (Dd::ONE - residual_square_sum / total_square_sum).to_f64());

    // (XᵀWX)⁻¹ = R⁻¹ R⁻ᵀ in scaled columns; `exponents[j]` undoes the scaling of column j.
    let exponents: Vec<i32> = columns.iter().map(|c| c.exponent).collect();
    let scaled_cofactor = |j: usize, k: usize| {
        (0..p).map(|m| r_inverse[m][j] * r_inverse[m][k]).fold(Dd::ZERO, |sum, term| sum + term)
    };
    let matrix = |factor: Dd, exponent: i32| -> Vec<Vec<f64>> {
        let entry = |j: usize, k: usize| {
            (scaled_cofactor(j, k) * factor).scaled_by(exponent - exponents[j] - exponents[k]).to_f64()
        };
        (0..p).map(|j| (0..p).map(|k| entry(j, k)).collect()).collect()
    };
    let standard_error =
        |j: usize| (variance * scaled_cofactor(j, j)).sqrt().scaled_by(y_exponent - exponents[j]).to_f64();
    let fit = LinearFit {
        coefficients: (0..p).map(|j| b[j].scaled_by(y_exponent - exponents[j]).to_f64()).collect(),
        standard_errors: (0..p).map(standard_error).collect(),
        residual_sd: variance.sqrt().scaled_by(y_exponent + w_exponent).to_f64(),
        degrees_of_freedom,
        r_squared,
        residuals: residuals.iter().map(|r| r.scaled_by(y_exponent).to_f64()).collect(),
        covariance: matrix(variance, 2 * y_exponent),
        cofactor: matrix(Dd::ONE, -2 * w_exponent),
    };
    let vectors = [&fit.coefficients, &fit.standard_errors, &fit.residuals];
    let numbers = vectors.into_iter().chain(&fit.covariance).chain(&fit.cofactor).flatten();
    if numbers.chain([&fit.residual_sd]).all(|v| v.is_finite()) { Ok(fit) } else { Err(FitError::Overflow) }
}

/// The upper triangle `R` of a QR factorisation and `Qᵀy`.
struct Triangle {
    /// `columns[k][..=k]` holds column `k` of `R`; below it stands nothing of use.
    columns: Vec<Vec<Dd>>,
    rotated_y: Vec<Dd>,
}

impl Triangle {
    /// Householder QR of `columns` (at least as many rows as columns), `y` going along.
    fn factor(mut columns: Vec<Vec<Dd>>, mut y: Vec<Dd>) -> Result<Self, FitError> {
        let norms: Vec<Dd> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
        for k in 0..columns.len() {
            let (done, rest) = columns.split_at_mut(k + 1);
            let pivot = &mut done[k];
            let norm_squared = dot(&pivot[k..], &pivot[k..]);
            let norm = norm_squared.sqrt();
            if norm.to_f64() <= RANK_TOLERANCE * norms[k].to_f64() {
                return Err(FitError::RankDeficient { column: k });
            }
            let diagonal = if pivot[k].to_f64() > 0.0 { -norm } else { norm };
            let half_v_squared = norm_squared - diagonal * pivot[k];
            let mut v = pivot[k..].to_vec();
            v[0] = v[0] - diagonal;
            for column in rest.iter_mut().chain(std::iter::once(&mut y)) {
                let factor = dot(&v, &column[k..]) / half_v_squared;
                for (entry, &v_i) in column[k..].iter_mut().zip(&v) {
                    *entry = *entry - factor * v_i;
                }
            }
            pivot[k] = diagonal;
        }
        Ok(Triangle { columns, rotated_y: y })
    }

    /// The solution of `R b = Qᵀy`.
    fn coefficients(&self) -> Vec<Dd> {
        self.back_substitute(self.rotated_y[..self.columns.len()].to_vec())
    }

    /// `R⁻¹`, one vector per column: `inverse()[m][j]` stands in row `j` of column `m`.
    fn inverse(&self) -> Vec<Vec<Dd>> {
        let p = self.columns.len();
        let unit = |m: usize| (0..p).map(|j| if j == m { Dd::ONE } else { Dd::ZERO }).collect();
        (0..p).map(|m| self.back_substitute(unit(m))).collect()
    }

    /// Solves `R x = right`.
    fn back_substitute(&self, mut right: Vec<Dd>) -> Vec<Dd> {
        for (k, column) in self.columns.iter().enumerate().rev() {
            right[k] = right[k] / column[k];
            let solved = right[k];
            for (entry, &r) in right[..k].iter_mut().zip(column) {
                *entry = *entry - r * solved;
            }
        }
        right
    }
}

fn dot(a: &[Dd], b: &[Dd]) -> Dd {
    a.iter().zip(b).fold(Dd::ZERO, |sum, (&x, &y)| sum + x * y)
}

/// Numbers held as an unevaluated sum of two `f64`, after Dekker (1971) and Knuth (TAOCP 2, §4.2.2); no fused operations.
mod double_double {
    use std::ops::{Add, Div, Mul, Neg, Sub};

    /// `hi + lo` with `|lo|` at most half an ulp of `hi`: about 106 bits. Magnitudes must stay well below 2⁹⁹⁶, where
    /// Veltkamp's split overflows.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub(super) struct Dd {
        hi: f64,
        lo: f64,
    }

    /// `a + b` and its rounding error (Knuth).
    fn two_sum(a: f64, b: f64) -> Dd {
        let hi = a + b;
        let b_part = hi - a;
        Dd { hi, lo: (a - (hi - b_part)) + (b - b_part) }
    }

    /// As [`two_sum`] for `|a| ≥ |b|` (Dekker).
    fn ordered_sum(a: f64, b: f64) -> Dd {
        let hi = a + b;
        Dd { hi, lo: b - (hi - a) }
    }

    /// Two parts of at most 26 bits (Veltkamp), so that products of parts are exact.
    fn split(a: f64) -> (f64, f64) {
        const TWO_TO_27_PLUS_1: f64 = 134_217_729.0;
        let c = TWO_TO_27_PLUS_1 * a;
        let high = c - (c - a);
        (high, a - high)
    }

    /// `a · b` and its rounding error (Dekker).
    fn two_product(a: f64, b: f64) -> Dd {
        let hi = a * b;
        let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
        Dd { hi, lo: ((a_high * b_high - hi) + a_high * b_low + a_low * b_high) + a_low * b_low }
    }

    impl Dd {
        pub(super) const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };
        pub(super) const ONE: Dd = Dd { hi: 1.0, lo: 0.0 };

        pub(super) fn to_f64(self) -> f64 {
            self.hi
        }

        /// `self · 2^exponent`.
        pub(super) fn scaled_by(self, exponent: i32) -> Dd {
            Dd { hi: libm::scalbn(self.hi, exponent), lo: libm::scalbn(self.lo, exponent) }
        }

        /// The root of a number that is not negative: one Newton step from the `f64` root doubles its digits.
        pub(super) fn sqrt(self) -> Dd {
            let root = self.hi.sqrt();
            if root == 0.0 {
                return Dd::ZERO;
            }
            let remainder = self - two_product(root, root);
            ordered_sum(root, remainder.hi / (2.0 * root))
        }
    }

    impl From<f64> for Dd {
        fn from(hi: f64) -> Self {
            Dd { hi, lo: 0.0 }
        }
    }

    impl Neg for Dd {
        type Output = Dd;
        fn neg(self) -> Dd {
            Dd { hi: -self.hi, lo: -self.lo }
        }
    }

    impl Add for Dd {
        type Output = Dd;
        fn add(self, other: Dd) -> Dd {
            let high = two_sum(self.hi, other.hi);
            let low = two_sum(self.lo, other.lo);
            let sum = ordered_sum(high.hi, high.lo + low.hi);
            ordered_sum(sum.hi, sum.lo + low.lo)
        }
    }

    impl Sub for Dd {
        type Output = Dd;
        fn sub(self, other: Dd) -> Dd {
            self + -other
        }
    }

    impl Mul for Dd {
        type Output = Dd;
        fn mul(self, other: Dd) -> Dd {
            let product = two_product(self.hi, other.hi);
            ordered_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
        }
    }

    impl Div for Dd {
        type Output = Dd;
        /// Long division with three `f64` digits of the quotient.
        fn div(self, other: Dd) -> Dd {
            let first = self.hi / other.hi;
            let remainder = self - other * Dd::from(first);
            let second = remainder.hi / other.hi;
            let third = (remainder - other * Dd::from(second)).hi / other.hi;
            ordered_sum(first, second) + Dd::from(third)
        }
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        /// 2⁻¹⁰²: a few units in the last of 106 bits.
        const ROUNDING: f64 = 1.97e-31;

        #[test]
        fn keeps_what_a_double_drops() {
            let tiny = 1e-25;
            assert_eq!((Dd::ONE + Dd::from(tiny) - Dd::ONE).to_f64(), tiny);
            // (2²⁷ + 1)² = 2⁵⁴ + 2²⁸ + 1 does not fit in 53 bits.
            let square = Dd::from(134_217_729.0) * Dd::from(134_217_729.0);
            assert_eq!((square.hi, square.lo), (18_014_398_777_917_440.0, 1.0));
        }

        #[test]
        fn quotient_and_root_undo_product() {
            let (a, b) = (Dd::from(2.0).sqrt(), Dd::ONE / Dd::from(3.0));
            assert!((a * a - Dd::from(2.0)).to_f64().abs() <= 2.0 * ROUNDING);
            assert!((b * Dd::from(3.0) - Dd::ONE).to_f64().abs() <= ROUNDING);
            assert!((a * b / b - a).to_f64().abs() <= 2.0 * ROUNDING);
            assert!(a.lo != 0.0 && b.lo != 0.0);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use statrs::distribution::{ContinuousCDF, StudentsT};

    #[test]
    fn t_quantile_agrees_with_closed_forms_and_with_statrs() {
        // ν = 1: tan(πC/2); ν = 2: C √(2/(1 − C²)). Six units of rounding through bisection, tan and the closed form.
        let coverage: f64 = 0.95;
        let cauchy = libm::tan(std::f64::consts::FRAC_PI_2 * coverage);
        let two = coverage * (2.0 / (1.0 - coverage * coverage)).sqrt();
        assert!((student_t(coverage, 1).unwrap() / cauchy - 1.0).abs() < 1e-14);
        assert!((student_t(coverage, 2).unwrap() / two - 1.0).abs() < 1e-14);
        for nu in [1, 2, 3, 4, 5, 8, 13, 40, 101, 1000] {
            for coverage in [0.1, 0.5, 0.68, 0.95, 0.99] {
                let witness = StudentsT::new(0.0, 1.0, nu as f64).unwrap().inverse_cdf(0.5 + 0.5 * coverage);
                // statrs inverts its incomplete beta function to about 1e-9.
                assert!(
                    (student_t(coverage, nu).unwrap() / witness - 1.0).abs() < 1e-8,
                    "nu {nu}, {coverage}"
                );
            }
        }
    }

    #[test]
    fn t_quantile_refuses_what_has_no_meaning() {
        for coverage in [0.0, 1.0, -0.5, f64::NAN] {
            assert!(matches!(student_t(coverage, 3), Err(FitError::Coverage { .. })));
        }
        assert!(matches!(student_t(0.9, 0), Err(FitError::TooFewPoints { .. })));
    }

    #[test]
    fn a_weight_acts_as_a_repeated_point() {
        let (x, y) = ([0.0, 1.0, 2.0, 4.0], [1.0, 2.5, 2.0, 6.0]);
        let weighted: Vec<_> = (0..4).map(|i| (x[i], y[i], if i == 1 { 3.0 } else { 1.0 })).collect();
        let mut repeated: Vec<_> = (0..4).map(|i| (x[i], y[i], 1.0)).collect();
        repeated.extend([repeated[1]; 2]);
        let (a, b) = (line(&weighted).unwrap(), line(&repeated).unwrap());
        // Both are the exact fit rounded once from 106 bits.
        assert!((a.slope - b.slope).abs() <= f64::EPSILON * b.slope.abs());
        assert!((a.intercept - b.intercept).abs() <= f64::EPSILON * b.intercept.abs());
        for j in 0..2 {
            assert!((a.fit.cofactor[j][j] / b.fit.cofactor[j][j] - 1.0).abs() <= f64::EPSILON);
        }
        let unweighted = line(&(0..4).map(|i| (x[i], y[i], 1.0)).collect::<Vec<_>>()).unwrap();
        assert!((a.slope - unweighted.slope).abs() > 1e-3);
    }

    #[test]
    fn common_weight_leaves_the_covariance_and_scales_the_cofactor() {
        let points = |w: f64| [(1.0, 2.0, w), (2.0, 2.5, w), (3.0, 4.5, w), (5.0, 4.0, w)];
        let (one, many) = (line(&points(1.0)).unwrap().fit, line(&points(1e12)).unwrap().fit);
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 4.0 * f64::EPSILON;
        assert!(close(one.standard_errors[1], many.standard_errors[1]));
        assert!(close(one.covariance[0][1], many.covariance[0][1]));
        assert!(close(one.cofactor[1][1], 1e12 * many.cofactor[1][1]));
        assert!(close(1e6 * one.residual_sd, many.residual_sd));
    }

    #[test]
    fn extreme_units_do_not_disturb_the_fit() {
        let at = |ux: f64, uy: f64| {
            line(&[1.0, 2.0, 3.0, 4.0].map(|x: f64| (ux * x, uy * (1.0 + 2.0 * x), 1.0))).map(|fit| fit.slope)
        };
        for (ux, uy) in [(1e-150, 1e-150), (1e140, 1e140), (1e-100, 1e30)] {
            assert!((at(ux, uy).unwrap() / (2.0 * uy / ux) - 1.0).abs() < 1e-14);
        }
        assert_eq!(at(1e-200, 1e200), Err(FitError::Overflow));
    }

    #[test]
    fn r_squared_is_centred_only_with_a_constant_column() {
        let y = [10.0, 10.5, 11.5];
        let with = multilinear(&[1.0, 2.0, 3.0].map(|x| vec![1.0, x]), &y, None).unwrap();
        let without = multilinear(&[1.0, 2.0, 3.0].map(|x| vec![x]), &y, None).unwrap();
        // By hand: slope 3/4, S = 1/24, SST = 7/6; and b = 65.5/14, R² = 65.5²/14/342.5.
        assert!((with.r_squared.unwrap() - (1.0 - 1.0 / 28.0)).abs() < 1e-15);
        assert!((without.r_squared.unwrap() - 65.5 * 65.5 / 14.0 / 342.5).abs() < 1e-15);
        assert_eq!(line(&[(0.0, 2.0, 1.0), (1.0, 2.0, 1.0), (2.0, 2.0, 1.0)]).unwrap().fit.r_squared, None);
    }

    #[test]
    fn faults_are_named_with_their_place() {
        let rows =
            |columns: [[f64; 4]; 2]| (0..4).map(|i| vec![columns[0][i], columns[1][i]]).collect::<Vec<_>>();
        let good = rows([[1.0; 4], [1.0, 2.0, 3.0, 4.0]]);
        let y = [1.0, 2.0, 2.0, 3.0];
        assert!(multilinear(&good, &y, None).is_ok());
        assert_eq!(
            multilinear(&rows([[0.1, 0.2, 0.3, 0.4], [0.3, 0.6, 0.9, 1.2]]), &y, None),
            Err(FitError::RankDeficient { column: 1 })
        );
        assert_eq!(
            multilinear(&rows([[0.0; 4], [1.0; 4]]), &y, None),
            Err(FitError::RankDeficient { column: 0 })
        );
        assert!(matches!(
            multilinear(&good, &y[..3], None),
            Err(FitError::LengthMismatch { what: Input::Y, found: 3, expected: 4 })
        ));
        assert!(matches!(
            multilinear(&good, &y, Some(&[1.0; 5])),
            Err(FitError::LengthMismatch { what: Input::Weight, found: 5, expected: 4 })
        ));
        for bad in [0.0, -1.0] {
            assert!(matches!(
                multilinear(&good, &y, Some(&[1.0, 1.0, bad, 1.0])),
                Err(FitError::OutOfDomain { what: Input::Weight, index: 2, .. })
            ));
        }
        assert!(matches!(
            multilinear(&good, &[1.0, 2.0, 3.0, f64::INFINITY], None),
            Err(FitError::NonFinite { what: Input::Y, index: 3, .. })
        ));
        assert!(matches!(
            polynomial(&[1.0, f64::NAN, 2.0], &[1.0; 3], 1),
            Err(FitError::NonFinite { what: Input::X, index: 1, .. })
        ));
        assert!(matches!(
            multilinear(&[vec![1.0], vec![1.0, 2.0]], &[1.0; 2], None),
            Err(FitError::RaggedDesign { row: 1, found: 2, expected: 1 })
        ));
        assert_eq!(multilinear(&[vec![], vec![]], &[1.0; 2], None), Err(FitError::NoColumns));
        assert_eq!(
            multilinear(&good[..2], &y[..2], None),
            Err(FitError::TooFewPoints { found: 2, needed: 3 })
        );
        assert_eq!(line(&[]).map(|fit| fit.slope), Err(FitError::TooFewPoints { found: 0, needed: 3 }));
        assert_eq!(
            line(&[(1.0, 2.0, 1.0); 5]).map(|fit| fit.slope),
            Err(FitError::RankDeficient { column: 1 })
        );
        let fit = multilinear(&good, &y, None).unwrap();
        assert_eq!(fit.interval(2, 0.95), Err(FitError::NoSuchCoefficient { index: 2, count: 2 }));
        assert!(matches!(fit.interval(0, 1.0), Err(FitError::Coverage { .. })));
    }
}
