//! Power laws on ladders of measurements: which rungs are asymptotic, and the slope through those.
//!
//! A ladder is an error `y` measured at shrinking `x` (spacing, smoothing length). At its coarse end higher powers still
//! contribute; at its fine end round-off takes over; in between `y ≈ C xᵖ`. [`settle`] finds that stretch and says of each
//! point it leaves out why, and [`power_law`] puts a line through the logarithms of the rest with [`super::fit`]. The
//! interval it reports covers scatter, the sampling errors if known, and slow drift of the slope within the window.
//! Logarithms are natural and come from `libm`, so that fitted values have the same bits everywhere; interval ends also carry
//! [`super::fit::student_t`], whose last digits depend on the platform. `tests/ladders.rs` tries it on ladders of known slope.

use super::error::{FitError, Input};
use super::fit::{Estimate, LinearFit, line, student_t, weighted_polynomial};
use std::fmt;

/// No point weighs more than one of this relative error.
///
/// An error quoted as zero must not make a point's weight infinite. 1e-6 moves a slope over one octave by 1e-6, far below
/// anything a measured order is read to, so the limit never shows in a result.
const SMALLEST_RELATIVE_ERROR: f64 = 1e-6;

/// Slack in octaves when a window is compared with [`WindowOptions::min_octaves`]: ladders reach `x` by repeated division, and
/// a ratio that should be 4 may come out a few roundings short of it.
const OCTAVE_SLACK: f64 = 1e-9;

/// The number of distinct abscissae a quadratic needs to leave a residual.
const QUADRATIC_NEEDS: usize = 4;

/// One measurement of a ladder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LadderPoint {
    /// Abscissa, positive.
    pub x: f64,
    /// Measured magnitude, not negative.
    pub y: f64,
    /// One-sigma sampling error of `y` divided by `y`, if known.
    pub relative_error: Option<f64>,
    /// A conservative bound on the round-off in `y`, in the units of `y`; 0 if there is none.
    pub floor: f64,
}

/// Which end of the ladder is far from the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coarse {
    /// The power law holds as `x → 0`.
    #[default]
    Largest,
    /// The power law holds as `x → ∞`.
    Smallest,
}

/// How a window is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowOptions {
    /// The end from which points are dropped.
    pub coarse: Coarse,
    /// The largest change of the local slope across the window that is let pass. The default, 1/4, keeps the slope at either end
    /// within 1/8 of the fitted one: less than half the distance between neighbouring half-integer orders.
    pub max_bend: f64,
    /// The fewest distinct abscissae the window may shrink to, at least 4.
    pub min_points: usize,
    /// The smallest `log₂(x_max / x_min)` the window may shrink to.
    pub min_octaves: f64,
    /// Coverage of the reported intervals.
    pub coverage: f64,
}

impl Default for WindowOptions {
    fn default() -> Self {
        WindowOptions {
            coarse: Coarse::Largest,
            max_bend: 0.25,
            min_points: 5,
            min_octaves: 2.0,
            coverage: 0.95,
        }
    }
}

/// Why a point takes no part in the fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// `y` is exactly zero.
    ZeroByValue,
    /// `0 < y ≤ floor`.
    RoundOffFloor,
    /// The slope still changes when this point is included.
    PreAsymptotic,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Reason::ZeroByValue => "the value is exactly zero and has no logarithm",
            Reason::RoundOffFloor => "the value does not rise above its round-off floor",
            Reason::PreAsymptotic => {
                "the slope is still changing here: the point is too coarse for the power law"
            }
        })
    }
}

/// Why a window does not count as settled.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Unsettled {
    /// Too few distinct abscissae to judge.
    TooFewPoints {
        /// Distinct abscissae of usable points.
        found: usize,
        /// [`WindowOptions::min_points`].
        needed: usize,
    },
    /// Too short a range of `x` to judge.
    TooNarrow {
        /// `log₂(x_max / x_min)` of the usable points.
        octaves: f64,
        /// [`WindowOptions::min_octaves`].
        needed: f64,
    },
    /// The slope still changes, and the window cannot shrink further.
    StillBending {
        /// Change of slope across the smallest window allowed.
        bend: f64,
        /// [`WindowOptions::max_bend`].
        max_bend: f64,
    },
}

impl fmt::Display for Unsettled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unsettled::TooFewPoints { found, needed } => {
                write!(f, "only {found} usable abscissae where {needed} are needed: add rungs to the ladder")
            }
            Unsettled::TooNarrow { octaves, needed } => {
                write!(
                    f,
                    "the usable points span {octaves:.2} octaves where {needed} are needed: widen the ladder"
                )
            }
            Unsettled::StillBending { bend, max_bend } => write!(
                f,
                "the slope changes by {bend:.2} across the smallest window allowed, more than {max_bend}: \
                 extend the ladder towards its fine end"
            ),
        }
    }
}

/// The outcome of [`settle`].
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Whether point `i` is in the window.
    pub kept: Vec<bool>,
    /// The points that are not, by index, each with its reason.
    pub left_out: Vec<(usize, Reason)>,
    /// `|2 c₂| · (range of ln x)`, the change of the local slope across the window; `None` if there was too little to judge.
    pub bend: Option<f64>,
    /// `None` if the window is settled.
    pub unsettled: Option<Unsettled>,
}

impl Window {
    /// Whether the slope is steady across the window.
    pub fn settled(&self) -> bool {
        self.unsettled.is_none()
    }
}

/// The power law `y ≈ exp(intercept) · x^slope` through a window.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLaw {
    /// Exponent.
    pub slope: Estimate,
    /// Natural logarithm of the prefactor, `ln y` at `x = 1`.
    pub intercept: Estimate,
    /// Slope through the finer half of the window minus `slope.value`; the interval of `slope` reaches at least as far.
    pub drift: f64,
    /// As [`Window::bend`].
    pub bend: Option<f64>,
    /// `ln y − intercept − slope · ln x` of the kept points, by rising index.
    pub residuals: Vec<f64>,
    /// Kept points minus 2.
    pub degrees_of_freedom: usize,
    /// Smallest and largest `x` kept.
    pub window: (f64, f64),
    /// As [`Window::left_out`].
    pub left_out: Vec<(usize, Reason)>,
    /// As [`Window::unsettled`].
    pub unsettled: Option<Unsettled>,
}

impl PowerLaw {
    /// Whether the slope is steady across the window.
    pub fn settled(&self) -> bool {
        self.unsettled.is_none()
    }
}

/// Finds the stretch of the ladder on which `ln y` is a straight line in `ln x`.
///
/// Points that are zero or no higher than their floor go first. Then the quadratic `ln y = c₀ + c₁ u + c₂ u²`, with `u` the centred
/// `ln x`, is fitted with the weights of [`power_law`]. If the slope's change across the window, `|2 c₂| · range(u)`, exceeds
/// `max_bend` and `c₂` differs from zero at the two-sided 95 % level (by residuals and by sampling errors alike), the coarsest abscissa is dropped, and so on. The order of
/// the points does not matter; several points may share an abscissa, and leave together.
///
/// # Errors
/// [`FitError::NonFinite`] and [`FitError::OutOfDomain`] for a point, [`FitError::WindowOption`], [`FitError::Coverage`];
/// [`FitError::RankDeficient`] if abscissae differ by no more than rounding.
pub fn settle(points: &[LadderPoint], options: &WindowOptions) -> Result<Window, FitError> {
    check_options(options)?;
    for (index, point) in points.iter().enumerate() {
        check_point(index, point)?;
    }
    let mut left_out = Vec::new();
    let mut candidates = Vec::new();
    for (index, point) in points.iter().enumerate() {
        if point.y == 0.0 {
            left_out.push((index, Reason::ZeroByValue));
        } else if point.y <= point.floor {
            left_out.push((index, Reason::RoundOffFloor));
        } else {
            candidates.push(index);
        }
    }
    let mut rungs = Rungs::from_coarse_to_fine(points, &candidates, options.coarse);
    let mut bend = None;
    let mut unsettled = rungs.too_small(options);
    while unsettled.is_none() {
        let parabola = Parabola::through(points, &rungs.indices())?;
        let change = (2.0 * parabola.fit.coefficients[2]).abs() * rungs.octaves() * std::f64::consts::LN_2;
        bend = Some(change);
        if change <= options.max_bend || !parabola.is_bent()? {
            break;
        }
        let finer = rungs.without_coarsest();
        if finer.too_small(options).is_some() {
            unsettled = Some(Unsettled::StillBending { bend: change, max_bend: options.max_bend });
        } else {
            left_out.extend(rungs.coarsest().iter().map(|&index| (index, Reason::PreAsymptotic)));
            rungs = finer;
        }
    }
    left_out.sort_unstable_by_key(|&(index, _)| index);
    let mut kept = vec![false; points.len()];
    for index in rungs.indices() {
        kept[index] = true;
    }
    Ok(Window { kept, left_out, bend, unsettled })
}

/// Fits `ln y = intercept + slope · ln x` through the window that [`settle`] finds.
///
/// # Formula
/// Weighted least squares with weights `1/σᵢ²`, `σᵢ` the relative error (which is the standard error of `ln y` while small), if every
/// kept point has one, and equal weights otherwise. The half-width of an interval is the larger of
/// - `t · se`, with Student's `t` and with `se` the residual-scaled standard error or, if relative errors are known and it is larger,
///   the a-priori one `√((XᵀWX)⁻¹)ⱼⱼ`;
/// - the distance to the same coefficient fitted through the finer half of the window alone: what is left of a slow drift;
/// - if the window is still bent at the two-sided 95 % level (by no more than `max_bend`, or it would not be settled), the distance
///   to the tangent of its parabola at the fine end. For `x⁴ + 30 x⁶` the slope approaches 4 from one side, and the finer
///   half has not arrived; with mere scatter this term is absent 19 times in 20.
///
/// A window that is not settled is still fitted; `unsettled` says so.
///
/// # Errors
/// [`FitError::TooFewPoints`] with fewer than three usable points, [`FitError::RankDeficient`] if they share one abscissa, and those
/// of [`settle`].
///
/// # Examples
/// ```
/// use remainder::measured::window::{LadderPoint, WindowOptions, power_law};
/// let ladder: Vec<_> = (1..8)
///     .map(|k| 1.0 / f64::from(1 << k))
///     .map(|x| LadderPoint { x, y: 3.0 * x * x, relative_error: None, floor: 0.0 })
///     .collect();
/// let law = power_law(&ladder, &WindowOptions::default())?;
/// assert!((law.slope.value - 2.0).abs() < 1e-12 && law.settled());
/// # Ok::<(), remainder::measured::FitError>(())
/// ```
pub fn power_law(points: &[LadderPoint], options: &WindowOptions) -> Result<PowerLaw, FitError> {
    let Window { kept, left_out, bend, unsettled } = settle(points, options)?;
    let kept: Vec<usize> = (0..points.len()).filter(|&index| kept[index]).collect();
    if kept.len() < 3 {
        return Err(FitError::TooFewPoints { found: kept.len(), needed: 3 });
    }
    let weights = log_weights(points, &kept);
    let in_logs = |(&index, &w): (&usize, &f64)| (libm::log(points[index].x), libm::log(points[index].y), w);
    let logs: Vec<_> =
        kept.iter().zip(weights.as_deref().unwrap_or(&vec![1.0; kept.len()])).map(in_logs).collect();
    let fitted = line(&logs)?;

    let rungs = Rungs::from_coarse_to_fine(points, &kept, options.coarse);
    let finer = rungs.finer_half();
    let finer_logs: Vec<_> =
        kept.iter().zip(&logs).filter(|(index, _)| finer.contains(index)).map(|(_, &log)| log).collect();
    let (finer_intercept, finer_slope) = bare_line(&finer_logs);
    let (end_intercept, end_slope) =
        rungs.bent_tangent_at_fine_end(points)?.unwrap_or((finer_intercept, finer_slope));

    let t = student_t(options.coverage, fitted.fit.degrees_of_freedom)?;
    let estimate = |k: usize, finer: [f64; 2]| {
        let a_priori = if weights.is_some() { fitted.fit.cofactor[k][k].sqrt() } else { 0.0 };
        let value = fitted.fit.coefficients[k];
        let scatter = t * fitted.fit.standard_errors[k].max(a_priori);
        let half_width = finer.iter().fold(scatter, |half, other| half.max((other - value).abs()));
        Estimate::symmetric(value, half_width)
    };
    let x = |index: &usize| points[*index].x;
    Ok(PowerLaw {
        slope: estimate(1, [finer_slope, end_slope]),
        intercept: estimate(0, [finer_intercept, end_intercept]),
        drift: finer_slope - fitted.slope,
        bend,
        degrees_of_freedom: fitted.fit.degrees_of_freedom,
        window: (
            kept.iter().map(x).fold(f64::INFINITY, f64::min),
            kept.iter().map(x).fold(f64::NEG_INFINITY, f64::max),
        ),
        residuals: fitted.fit.residuals,
        left_out,
        unsettled,
    })
}

/// Points grouped by abscissa, coarsest group first.
struct Rungs(Vec<(f64, Vec<usize>)>);

impl Rungs {
    fn from_coarse_to_fine(points: &[LadderPoint], indices: &[usize], coarse: Coarse) -> Self {
        let mut sorted = indices.to_vec();
        sorted.sort_by(|&a, &b| {
            let rising = points[a].x.total_cmp(&points[b].x);
            if coarse == Coarse::Largest { rising.reverse() } else { rising }
        });
        let mut rungs: Vec<(f64, Vec<usize>)> = Vec::new();
        for index in sorted {
            match rungs.last_mut() {
                Some((x, members)) if *x == points[index].x => members.push(index),
                _ => rungs.push((points[index].x, vec![index])),
            }
        }
        Rungs(rungs)
    }

    fn coarsest(&self) -> &[usize] {
        self.0.first().map_or(&[], |(_, members)| members)
    }

    fn without_coarsest(&self) -> Self {
        Rungs(self.0.iter().skip(1).cloned().collect())
    }

    /// The points of the finer half of the abscissae, the middle one included, and of two abscissae at least.
    fn finer_half(&self) -> Vec<usize> {
        let coarser = (self.0.len() / 2).min(self.0.len().saturating_sub(2));
        self.0[coarser..].iter().flat_map(|(_, members)| members).copied().collect()
    }

    /// Tangent at the finest abscissa, if there are enough points to tell that they lie on a bent curve and they do.
    fn bent_tangent_at_fine_end(&self, points: &[LadderPoint]) -> Result<Option<(f64, f64)>, FitError> {
        let Some((finest, _)) = self.0.last().filter(|_| self.0.len() >= QUADRATIC_NEEDS) else {
            return Ok(None);
        };
        let parabola = Parabola::through(points, &self.indices())?;
        Ok(parabola.is_bent()?.then(|| parabola.tangent(libm::log(*finest))))
    }

    /// Indices into the ladder, rising.
    fn indices(&self) -> Vec<usize> {
        let mut indices: Vec<usize> = self.0.iter().flat_map(|(_, members)| members).copied().collect();
        indices.sort_unstable();
        indices
    }

    fn octaves(&self) -> f64 {
        match (self.0.first(), self.0.last()) {
            (Some((first, _)), Some((last, _))) => (libm::log2(*first) - libm::log2(*last)).abs(),
            _ => 0.0,
        }
    }

    fn too_small(&self, options: &WindowOptions) -> Option<Unsettled> {
        if self.0.len() < options.min_points {
            Some(Unsettled::TooFewPoints { found: self.0.len(), needed: options.min_points })
        } else if self.octaves() < options.min_octaves - OCTAVE_SLACK {
            Some(Unsettled::TooNarrow { octaves: self.octaves(), needed: options.min_octaves })
        } else {
            None
        }
    }
}

/// `1/σ²` of `ln y` for the points at `indices`, or `None` unless the relative error of each is known.
fn log_weights(points: &[LadderPoint], indices: &[usize]) -> Option<Vec<f64>> {
    let weight = |sigma: f64| 1.0 / (sigma * sigma);
    indices.iter().map(|&i| Some(weight(points[i].relative_error?.max(SMALLEST_RELATIVE_ERROR)))).collect()
}

/// The weighted fit `ln y = c₀ + c₁ u + c₂ u²` with `u = ln x − centre`.
struct Parabola {
    centre: f64,
    fit: LinearFit,
    /// Standard error of `c₂` from the relative errors of the points; 0 where these are not known.
    a_priori: f64,
}

impl Parabola {
    fn through(points: &[LadderPoint], indices: &[usize]) -> Result<Self, FitError> {
        let ln_x: Vec<f64> = indices.iter().map(|&i| libm::log(points[i].x)).collect();
        let ln_y: Vec<f64> = indices.iter().map(|&i| libm::log(points[i].y)).collect();
        let centre = ln_x.iter().sum::<f64>() / ln_x.len() as f64;
        let u: Vec<f64> = ln_x.iter().map(|v| v - centre).collect();
        let weights = log_weights(points, indices);
        let fit = weighted_polynomial(&u, &ln_y, weights.as_deref(), 2)?;
        let a_priori = if weights.is_some() { fit.cofactor[2][2].sqrt() } else { 0.0 };
        Ok(Parabola { centre, fit, a_priori })
    }

    /// Whether `c₂` differs from zero at the two-sided 95 % level, by the residuals and by the sampling errors: rungs that
    /// share their random numbers scatter together, and their residuals alone would call that a bend.
    fn is_bent(&self) -> Result<bool, FitError> {
        let by_sampling = self.fit.coefficients[2].abs() > 1.96 * self.a_priori;
        Ok(by_sampling && !self.fit.interval(2, 0.95)?.contains(0.0))
    }

    /// Intercept at `ln x = 0` and slope of the tangent at `ln_x`.
    fn tangent(&self, ln_x: f64) -> (f64, f64) {
        let c = &self.fit.coefficients;
        let u = ln_x - self.centre;
        let slope = c[1] + 2.0 * c[2] * u;
        (c[0] + c[1] * u + c[2] * u * u - slope * ln_x, slope)
    }
}

/// Intercept and slope of the weighted line through at least two distinct abscissae, which may leave no residual.
fn bare_line(points: &[(f64, f64, f64)]) -> (f64, f64) {
    let total: f64 = points.iter().map(|(_, _, w)| w).sum();
    let x_mean = points.iter().map(|(x, _, w)| w * x).sum::<f64>() / total;
    let y_mean = points.iter().map(|(_, y, w)| w * y).sum::<f64>() / total;
    let xy: f64 = points.iter().map(|(x, y, w)| w * (x - x_mean) * (y - y_mean)).sum();
    let xx: f64 = points.iter().map(|(x, _, w)| w * (x - x_mean) * (x - x_mean)).sum();
    (y_mean - xy / xx * x_mean, xy / xx)
}

fn check_options(options: &WindowOptions) -> Result<(), FitError> {
    let fault = |option, value, must_be| Err(FitError::WindowOption { option, value, must_be });
    if options.max_bend.is_nan() || options.max_bend < 0.0 {
        return fault("max_bend", options.max_bend, "zero or positive");
    }
    if !options.min_octaves.is_finite() || options.min_octaves < 0.0 {
        return fault("min_octaves", options.min_octaves, "finite, and zero or positive");
    }
    if options.min_points < QUADRATIC_NEEDS {
        return fault(
            "min_points",
            options.min_points as f64,
            "at least 4, or no bend can be told from scatter",
        );
    }
    student_t(options.coverage, 1).map(|_| ())
}

fn check_point(index: usize, point: &LadderPoint) -> Result<(), FitError> {
    let fields = [
        (Input::X, point.x),
        (Input::Y, point.y),
        (Input::RelativeError, point.relative_error.unwrap_or(0.0)),
        (Input::Floor, point.floor),
    ];
    for (what, value) in fields {
        if !value.is_finite() {
            return Err(FitError::NonFinite { what, index, value });
        }
        if what == Input::X && value <= 0.0 {
            return Err(FitError::OutOfDomain { what, index, value, must_be: "positive" });
        }
        if value < 0.0 {
            return Err(FitError::OutOfDomain { what, index, value, must_be: "zero or positive" });
        }
    }
    Ok(())
}
