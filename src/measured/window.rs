//! Power laws on ladders of measurements: which rungs are asymptotic, and the slope through those.
//!
//! A ladder is an error `y` measured at shrinking `x` (spacing, smoothing length). At its coarse end higher powers still
//! contribute; at its fine end round-off takes over; in between `y ≈ C xᵖ`. [`settle`] finds that stretch and says of each
//! point it leaves out why, and [`power_law`] puts a line through the logarithms of the rest with [`super::fit`]. The
//! interval it reports covers scatter, the sampling errors if known, and slow drift of the slope within the window.
//! Logarithms are natural and come from `libm`, so that results have the same bits everywhere.

use super::fit::{Estimate, FitError, Input, LinearFit, line, student_t, weighted_polynomial};
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
/// `max_bend` and `c₂` differs from zero at the two-sided 95 % level, the coarsest abscissa is dropped, and so on. The order of
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
/// # Ok::<(), remainder::measured::fit::FitError>(())
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
}

impl Parabola {
    fn through(points: &[LadderPoint], indices: &[usize]) -> Result<Self, FitError> {
        let ln_x: Vec<f64> = indices.iter().map(|&i| libm::log(points[i].x)).collect();
        let ln_y: Vec<f64> = indices.iter().map(|&i| libm::log(points[i].y)).collect();
        let centre = ln_x.iter().sum::<f64>() / ln_x.len() as f64;
        let u: Vec<f64> = ln_x.iter().map(|v| v - centre).collect();
        let fit = weighted_polynomial(&u, &ln_y, log_weights(points, indices).as_deref(), 2)?;
        Ok(Parabola { centre, fit })
    }

    /// Whether `c₂` differs from zero at the two-sided 95 % level.
    fn is_bent(&self) -> Result<bool, FitError> {
        Ok(!self.fit.interval(2, 0.95)?.contains(0.0))
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const DEFAULT: WindowOptions = WindowOptions {
        coarse: Coarse::Largest,
        max_bend: 0.25,
        min_points: 5,
        min_octaves: 2.0,
        coverage: 0.95,
    };

    fn ladder(xs: impl IntoIterator<Item = f64>, y: impl Fn(f64) -> f64) -> Vec<LadderPoint> {
        xs.into_iter().map(|x| LadderPoint { x, y: y(x), relative_error: None, floor: 0.0 }).collect()
    }

    /// 1, 1/√2, 1/2, … of `rungs` entries.
    fn half_octaves(rungs: i32) -> impl Iterator<Item = f64> {
        (0..rungs).map(|k| libm::exp2(-0.5 * f64::from(k)))
    }

    fn indices_left_out(law: &PowerLaw, reason: Reason) -> Vec<usize> {
        law.left_out.iter().filter(|(_, r)| *r == reason).map(|(i, _)| *i).collect()
    }

    /// The slope through all points whatever they are.
    fn plain_slope(points: &[LadderPoint]) -> f64 {
        line(&points.iter().map(|p| (libm::log(p.x), libm::log(p.y), 1.0)).collect::<Vec<_>>()).unwrap().slope
    }

    #[test]
    fn default_options_are_the_documented_ones() {
        assert_eq!(WindowOptions::default(), DEFAULT);
    }

    #[test]
    fn pure_power_law_is_exact() {
        for p in [-2.0, 0.5, 4.0, 12.0] {
            let law = power_law(&ladder(half_octaves(12), |x| 3.0 * libm::pow(x, p)), &DEFAULT).unwrap();
            // ln y is good to 1e-16 × |ln y| ≤ 5e-15, over a range of ln x of 4.
            assert!((law.slope.value - p).abs() < 1e-12);
            assert!((law.intercept.value - libm::log(3.0)).abs() < 1e-12);
            assert!(law.slope.high - law.slope.low < 1e-12 && law.drift.abs() < 1e-12);
            assert!(law.settled() && law.left_out.is_empty());
            assert_eq!((law.degrees_of_freedom, law.residuals.len()), (10, 12));
        }
    }

    #[test]
    fn points_on_the_round_off_floor_are_left_out() {
        let floor = 1e-9;
        let mut points = ladder(half_octaves(20), |x| libm::pow(x, 4.0) + floor);
        for p in &mut points {
            p.floor = 2.0 * floor;
        }
        let law = power_law(&points, &DEFAULT).unwrap();
        // x⁴ ≤ 1e-9 from k = 15 on: 2^(−2·15) = 9.3e-10.
        assert_eq!(indices_left_out(&law, Reason::RoundOffFloor), [15, 16, 17, 18, 19]);
        assert!(law.slope.contains(4.0) && law.settled());
        // Neither too low a floor nor the strict comparison may pass unnoticed.
        let unaware: Vec<_> = points.iter().map(|p| LadderPoint { floor: 0.0, ..*p }).collect();
        assert!(plain_slope(&unaware) < 3.8);
        points[3].floor = points[3].y;
        let law = power_law(&points, &DEFAULT).unwrap();
        assert_eq!(indices_left_out(&law, Reason::RoundOffFloor), [3, 15, 16, 17, 18, 19]);
    }

    #[test]
    fn pre_asymptotic_points_are_dropped_until_the_slope_settles() {
        let points = ladder(half_octaves(16), |x| libm::pow(x, 4.0) + 30.0 * libm::pow(x, 6.0));
        let plain = plain_slope(&points);
        assert!(plain > 4.4 && plain < 6.0, "plain {plain}");
        let law = power_law(&points, &DEFAULT).unwrap();
        let dropped = indices_left_out(&law, Reason::PreAsymptotic);
        assert!(law.settled() && law.bend.unwrap() <= 0.25);
        assert!(dropped.len() >= 2 && dropped.len() <= 11);
        assert_eq!(dropped, (0..dropped.len()).collect::<Vec<_>>(), "from the coarse end, without gaps");
        assert!(law.slope.contains(4.0), "{:?}", law.slope);
        assert!(law.intercept.contains(0.0), "{:?}", law.intercept);
        assert!(law.slope.value - 4.0 < 0.125 && law.slope.high - law.slope.low < 0.25);
        assert!(law.drift < 0.0, "the finer half is closer to 4 from above");
    }

    #[test]
    fn coarse_end_follows_the_option() {
        let y = |x: f64| libm::pow(x, -4.0) + 30.0 * libm::pow(x, -6.0);
        let points = ladder(half_octaves(16).map(|x| 1.0 / x), y);
        let law = power_law(&points, &WindowOptions { coarse: Coarse::Smallest, ..DEFAULT }).unwrap();
        assert!(law.settled() && law.slope.contains(-4.0));
        assert_eq!(law.window.1, points[15].x);
        let wrong_end = power_law(&points, &DEFAULT).unwrap();
        assert!(!wrong_end.slope.contains(-4.0) && wrong_end.window.0 == 1.0);
    }

    #[test]
    fn order_of_points_does_not_matter() {
        let points = ladder(half_octaves(16), |x| libm::pow(x, 4.0) + 30.0 * libm::pow(x, 6.0));
        let forward = power_law(&points, &DEFAULT).unwrap();
        let backward = power_law(&points.iter().rev().copied().collect::<Vec<_>>(), &DEFAULT).unwrap();
        assert!((forward.slope.value - backward.slope.value).abs() < 1e-14);
        assert_eq!(forward.window, backward.window);
        assert_eq!(backward.left_out.last().unwrap().0, 15);
    }

    #[test]
    fn a_slope_that_keeps_changing_is_reported_as_unsettled() {
        // ln y = ln²x: the slope changes by 2 per unit of ln x, everywhere.
        let points = ladder(half_octaves(12), |x| libm::exp(libm::log(x) * libm::log(x)));
        let law = power_law(&points, &DEFAULT).unwrap();
        // The smallest window is of 5 points, 2 octaves: bend = 2 · 2 ln 2.
        let bend = 4.0 * std::f64::consts::LN_2;
        assert!((law.bend.unwrap() - bend).abs() < 1e-9);
        assert!(matches!(law.unsettled, Some(Unsettled::StillBending { .. })));
        assert_eq!(indices_left_out(&law, Reason::PreAsymptotic), [0, 1, 2, 3, 4, 5, 6]);
        let patient = power_law(&points, &WindowOptions { max_bend: 10.0, ..DEFAULT }).unwrap();
        assert!(patient.settled() && patient.left_out.is_empty());
    }

    #[test]
    fn short_ladders_are_fitted_but_not_settled() {
        let four = power_law(&ladder(half_octaves(4), |x| x * x), &DEFAULT).unwrap();
        assert_eq!(four.unsettled, Some(Unsettled::TooFewPoints { found: 4, needed: 5 }));
        let narrow =
            power_law(&ladder((0..9).map(|k| 1.0 - 0.05 * f64::from(k)), |x| x * x), &DEFAULT).unwrap();
        assert!(matches!(narrow.unsettled, Some(Unsettled::TooNarrow { octaves, .. }) if octaves < 1.0));
        assert!((four.slope.value - 2.0).abs() < 1e-12 && (narrow.slope.value - 2.0).abs() < 1e-12);
        let repeated = ladder(half_octaves(3).chain(half_octaves(3)), |x| x * x);
        let law = power_law(&repeated, &DEFAULT).unwrap();
        assert_eq!(law.unsettled, Some(Unsettled::TooFewPoints { found: 3, needed: 5 }));
        let five = power_law(&ladder(half_octaves(5), |x| x * x), &DEFAULT).unwrap();
        assert!(five.settled());
    }

    #[test]
    fn oscillating_prefactor_is_covered() {
        let y = |x: f64| libm::pow(x, 4.5) * (1.0 + 0.3 * libm::sin(7.0 / x));
        let law = power_law(&ladder(half_octaves(14), y), &DEFAULT).unwrap();
        assert!(law.settled() && law.slope.contains(4.5), "{:?}", law.slope);
        // From the other side: not so wide that 4 or 5 would do as well.
        assert!(!law.slope.contains(4.0) && !law.slope.contains(5.0));
    }

    #[test]
    fn alternating_zeros_are_left_out() {
        let mut points = ladder(half_octaves(14), |x| x.powi(3));
        for p in points.iter_mut().step_by(2) {
            p.y = 0.0;
        }
        let law = power_law(&points, &DEFAULT).unwrap();
        assert_eq!(indices_left_out(&law, Reason::ZeroByValue), [0, 2, 4, 6, 8, 10, 12]);
        assert!((law.slope.value - 3.0).abs() < 1e-12 && law.settled());
        assert_eq!(law.window, (points[13].x, points[1].x));
    }

    #[test]
    fn too_few_usable_points_is_an_error() {
        let mut points = ladder(half_octaves(6), |x| x);
        for p in &mut points[2..] {
            p.y = 0.0;
        }
        assert_eq!(power_law(&points, &DEFAULT), Err(FitError::TooFewPoints { found: 2, needed: 3 }));
        points[4].y = points[4].x;
        assert!(power_law(&points, &DEFAULT).is_ok());
        assert_eq!(power_law(&[], &DEFAULT), Err(FitError::TooFewPoints { found: 0, needed: 3 }));
        let same_x = ladder([0.5; 6], |x| x);
        assert_eq!(power_law(&same_x, &DEFAULT), Err(FitError::RankDeficient { column: 1 }));
    }

    #[test]
    fn faults_are_named_with_their_place() {
        let good = ladder(half_octaves(6), |x| x);
        let with = |change: &dyn Fn(&mut LadderPoint)| {
            let mut points = good.clone();
            change(&mut points[2]);
            power_law(&points, &DEFAULT).map(|_| ())
        };
        let out_of_domain = |result, input| matches!(result, Err(FitError::OutOfDomain { what, index: 2, .. }) if what == input);
        assert!(out_of_domain(with(&|p| p.x = 0.0), Input::X));
        assert!(out_of_domain(with(&|p| p.y = -1.0), Input::Y));
        assert!(out_of_domain(with(&|p| p.floor = -1.0), Input::Floor));
        assert!(out_of_domain(with(&|p| p.relative_error = Some(-0.1)), Input::RelativeError));
        assert!(matches!(
            with(&|p| p.y = f64::NAN),
            Err(FitError::NonFinite { what: Input::Y, index: 2, .. })
        ));
        let option = |options: WindowOptions| power_law(&good, &options).map(|_| ());
        assert!(matches!(
            option(WindowOptions { min_points: 3, ..DEFAULT }),
            Err(FitError::WindowOption { option: "min_points", .. })
        ));
        assert!(matches!(
            option(WindowOptions { max_bend: f64::NAN, ..DEFAULT }),
            Err(FitError::WindowOption { option: "max_bend", .. })
        ));
        assert!(matches!(option(WindowOptions { coverage: 1.0, ..DEFAULT }), Err(FitError::Coverage { .. })));
    }

    #[test]
    fn known_errors_weigh_points_and_bound_the_interval_from_below() {
        // Without scatter the residuals alone would claim certainty; the quoted 10 % may not be forgotten.
        let mut points = ladder(half_octaves(9), |x| x * x);
        for p in &mut points {
            p.relative_error = Some(0.1);
        }
        let law = power_law(&points, &DEFAULT).unwrap();
        // Σ(u − ū)² = (ln 2 / 2)² · 60 for nine rungs; t(0.975, 7) = 2.364624.
        let expected = 2.364_624 * 0.1 / (0.5 * std::f64::consts::LN_2 * 60.0_f64.sqrt());
        assert!((0.5 * (law.slope.high - law.slope.low) / expected - 1.0).abs() < 1e-6);
        // A point that is off by a factor and says so is nearly ignored; one that does not say so is not.
        points[8].y *= 1.5;
        points[8].relative_error = Some(100.0);
        assert!((power_law(&points, &DEFAULT).unwrap().slope.value - 2.0).abs() < 1e-5);
        points[8].relative_error = None;
        assert!((power_law(&points, &DEFAULT).unwrap().slope.value - 2.0).abs() > 1e-2);
    }

    #[test]
    fn interval_reaches_the_finer_slope() {
        // Slope changing by 0.2 across four octaves: within max_bend, so kept, with residuals too small to tell of it.
        let c2 = 0.2 / (2.0 * 4.0 * std::f64::consts::LN_2);
        let points =
            ladder(half_octaves(9), |x| libm::exp(2.0 * libm::log(x) + c2 * libm::log(x) * libm::log(x)));
        let law = power_law(&points, &DEFAULT).unwrap();
        assert!(law.left_out.is_empty());
        // For a parabola, the line through a stretch has the slope of its midpoint, here a quarter of the range apart.
        assert!((law.drift + 0.05).abs() < 1e-9, "{}", law.drift);
        // The curve is an exact parabola, so its bend is certain and the interval reaches the slope at the fine end, 0.1 away.
        assert!((law.slope.value - law.slope.low - 0.1).abs() < 1e-9);
        // Alternating scatter of 3 % hides the bend, and the finer half is what remains.
        let mut hidden = points;
        for p in hidden.iter_mut().step_by(2) {
            p.y *= 1.06;
        }
        let law = power_law(&hidden, &DEFAULT).unwrap();
        let half_width = law.slope.value - law.slope.low;
        assert!(half_width >= law.drift.abs() * (1.0 - 1e-12) && half_width < 0.1, "{law:?}");
    }

    /// SplitMix64 (Steele, Lea & Flood 2014).
    struct SplitMix(u64);

    impl SplitMix {
        fn uniform(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }

        /// Box–Muller.
        fn normal(&mut self) -> f64 {
            let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
            radius * libm::cos(std::f64::consts::TAU * self.uniform())
        }
    }

    /// Intervals that hold the true slope 3 out of 200 ladders of ten rungs with 5 % noise, and their mean half-width.
    fn coverage_over_200(options: &WindowOptions, quoted: Option<f64>) -> (usize, f64) {
        let sigma = 0.05;
        let laws = (0..200).map(|seed| {
            let mut noise = SplitMix(seed);
            let mut points = ladder(half_octaves(10), |x| x * x * x);
            for p in &mut points {
                p.y *= libm::exp(sigma * noise.normal());
                p.relative_error = quoted;
            }
            power_law(&points, options).unwrap().slope
        });
        laws.fold((0, 0.0), |(hits, width), slope| {
            (hits + usize::from(slope.contains(3.0)), width + 0.5 * (slope.high - slope.low) / 200.0)
        })
    }

    #[test]
    fn intervals_cover_the_true_slope() {
        // Standard error of the slope for ten rungs: Σ(u − ū)² = (ln 2 / 2)² · 82.5; t(0.975, 8) = 2.306.
        let honest = 2.306 * 0.05 / (0.5 * std::f64::consts::LN_2 * 82.5_f64.sqrt());
        for quoted in [None, Some(0.05)] {
            let (hits, width) = coverage_over_200(&DEFAULT, quoted);
            println!("quoted {quoted:?}: {hits} of 200, half-width {:.2} of honest", width / honest);
            assert!(hits >= 180);
            // Widening for drift may cost something, but not twice the interval.
            assert!(width > 0.9 * honest && width < 2.0 * honest);
        }
        // From the other side: asked for less, the intervals deliver less.
        let (hits, _) = coverage_over_200(&WindowOptions { coverage: 0.2, ..DEFAULT }, None);
        println!("coverage 0.2: {hits}");
        assert!(hits < 180);
    }

    proptest! {
        #[test]
        fn slope_does_not_depend_on_units(
            log_x_unit in -6.0..6.0_f64,
            log_y_unit in -20.0..20.0_f64,
            seed in 0..1000_u64,
            p in -1.0..6.0_f64,
        ) {
            let (x_unit, y_unit) = (libm::exp(log_x_unit), libm::exp(log_y_unit));
            let mut noise = SplitMix(seed);
            let factors: Vec<f64> = half_octaves(12).map(|_| libm::exp(0.1 * noise.normal())).collect();
            let mut points = ladder(half_octaves(12), |x| libm::pow(x, p) * (1.0 + 4.0 * x * x));
            for (point, factor) in points.iter_mut().zip(factors) {
                point.y *= factor;
                point.floor = 1e-5;
            }
            let scaled: Vec<_> = points
                .iter()
                .map(|q| LadderPoint { x: x_unit * q.x, y: y_unit * q.y, floor: y_unit * q.floor, ..*q })
                .collect();
            let (a, b) = (power_law(&points, &DEFAULT).unwrap(), power_law(&scaled, &DEFAULT).unwrap());
            // Logarithms up to 40, good to 1e-14, over a range of ln x of at least 1.4.
            prop_assert!((a.slope.value - b.slope.value).abs() < 1e-12);
            prop_assert!((a.slope.high - b.slope.high).abs() < 1e-12);
            prop_assert_eq!(a.left_out, b.left_out);
            prop_assert!(
                (b.intercept.value - a.intercept.value - log_y_unit + a.slope.value * log_x_unit).abs() < 1e-10
            );
        }
    }
}
