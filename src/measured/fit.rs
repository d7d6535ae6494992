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
//! the same input gives the same fit to the bit on every machine; a general matrix library does not promise that. Interval ends
//! agree to the digits of [`student_t`], fewer than those of the fit.
//! `tests/nist.rs` holds the result against the NIST Statistical Reference Datasets, `tests/fit.rs` against cases done by hand.

use super::double_double::Dd;
use statrs::distribution::{ContinuousCDF, StudentsT};

pub use super::error::{FitError, Input};

/// A column whose part orthogonal to the columns before it is this small, relative to its own norm, counts as dependent on them.
///
/// Entries of a column that is a linear combination of others, computed in `f64`, carry a few roundings of 2⁻⁵³ each: 8 × 2⁻⁵²
/// is above those, and below it the orthogonal part would be made of input rounding, however exact the arithmetic here.
const RANK_TOLERANCE: f64 = 8.0 * f64::EPSILON;

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
/// # Ok::<(), remainder::measured::FitError>(())
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
/// # Ok::<(), remainder::measured::FitError>(())
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
/// It comes from `statrs`, whose inverse of the incomplete beta function was found good to a relative 1e-8 wherever it was sampled
/// between coverages of 0.02 and 0.9999 with up to 1000 degrees of freedom; far outside (a coverage of 1 − 10⁻⁹ or 10⁻⁶) it is
/// wrong. It uses the platform's logarithms and powers, so that the last digits are not the same everywhere; reports round them
/// away.
///
/// # Errors
/// [`FitError::Coverage`] outside (0, 1); [`FitError::TooFewPoints`] without a degree of freedom.
///
/// # Examples
/// ```
/// use remainder::measured::fit::student_t;
/// assert!((student_t(0.95, 10)? - 2.228_138_852).abs() < 1e-8); // printed tables: 2.228
/// # Ok::<(), remainder::measured::FitError>(())
/// ```
pub fn student_t(coverage: f64, degrees_of_freedom: usize) -> Result<f64, FitError> {
    if !(coverage > 0.0 && coverage < 1.0) {
        return Err(FitError::Coverage { coverage });
    }
    if degrees_of_freedom == 0 {
        return Err(FitError::TooFewPoints { found: 0, needed: 1 });
    }
    let t = StudentsT::new(0.0, 1.0, degrees_of_freedom as f64).expect("at least one degree of freedom");
    // The lower tail, because 1 − coverage keeps its digits where (1 + coverage)/2 rounds to 1.
    Ok(-t.inverse_cdf(0.5 * (1.0 - coverage)))
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
