//! Power laws through errors: slopes along one variable, and the four coefficients of the paper's fits.

use super::TaskError;
use crate::claim::Measured;
use crate::measured::fit::multilinear;
use crate::record::{Axis, Case, Estimate, Fit, FitPoint, Source, significant};
use std::collections::BTreeMap;

/// Coverage of all intervals.
const COVERAGE: f64 = 0.95;
/// Digits kept of what passed through Student's t.
const DIGITS: usize = 8;

/// y = a₁ h^a₂ η^a₃ K_x^a₄ with intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FourCoefficients {
    /// a₁, lengths in metres.
    pub prefactor: Measured,
    /// a₂, a₃, a₄.
    pub exponents: [Measured; 3],
    /// Standard deviation of ln y about the law.
    pub residual: f64,
    pub points: usize,
}

/// The law through points \[h, η, K_x, y\].
pub(super) fn four_coefficients(points: &[[f64; 4]]) -> Result<FourCoefficients, TaskError> {
    let design: Vec<Vec<f64>> = points
        .iter()
        .map(|[h, eta, k, _]| vec![1.0, libm::log(*h), libm::log(*eta), libm::log(*k)])
        .collect();
    let y: Vec<f64> = points.iter().map(|point| libm::log(point[3])).collect();
    let fit = multilinear(&design, &y, None)?;
    let interval = |k: usize| -> Result<Measured, TaskError> {
        let interval = fit.interval(k, COVERAGE)?;
        Ok(Measured { value: interval.value, low: interval.low, high: interval.high })
    };
    let prefactor = interval(0)?;
    let exp = |x: f64| significant(libm::exp(x), DIGITS);
    Ok(FourCoefficients {
        prefactor: Measured {
            value: exp(prefactor.value),
            low: exp(prefactor.low),
            high: exp(prefactor.high),
        },
        exponents: [interval(1)?, interval(2)?, interval(3)?].map(rounded),
        residual: significant(fit.residual_sd, DIGITS),
        points: points.len(),
    })
}

/// The mean of numbers with its interval.
pub(super) fn mean(values: &[f64]) -> Result<Measured, TaskError> {
    if let [one] = values {
        return Ok(Measured::exactly(*one));
    }
    let design = vec![vec![1.0]; values.len()];
    let interval = multilinear(&design, values, None)?.interval(0, COVERAGE)?;
    Ok(rounded(Measured { value: interval.value, low: interval.low, high: interval.high }))
}

pub(super) fn rounded(found: Measured) -> Measured {
    let round = |x| significant(x, DIGITS);
    Measured { value: round(found.value), low: round(found.low), high: round(found.high) }
}

/// What a line is fitted to.
pub(super) struct Ladder<'a> {
    pub id: String,
    pub quantity: String,
    pub case: Case,
    /// `h`, `eta`, `field-scale`.
    pub varies: &'a str,
    /// Unit of the abscissa.
    pub unit: &'a str,
}

/// d ln y/d ln x with its interval, and the fit for the record. Points are (x, y, standard error of y).
pub(super) fn slope(ladder: Ladder<'_>, points: &[(f64, f64, f64)]) -> Result<(Measured, Fit), TaskError> {
    let design: Vec<Vec<f64>> = points.iter().map(|(x, ..)| vec![1.0, libm::log(*x)]).collect();
    let y: Vec<f64> = points.iter().map(|(_, y, _)| libm::log(*y)).collect();
    let fit = multilinear(&design, &y, None)?;
    let [intercept, slope] = [fit.interval(0, COVERAGE)?, fit.interval(1, COVERAGE)?]
        .map(|interval| rounded(Measured { value: interval.value, low: interval.low, high: interval.high }));
    let estimate = |m: Measured| Estimate::float(m.value, m.low, m.high, Source::Fit);
    let axis = |name: &str, unit: &str| Axis { name: name.into(), unit: unit.into(), log: true };
    let entry = Fit {
        id: ladder.id,
        y: axis(&ladder.quantity, "1"),
        quantity: ladder.quantity,
        case: ladder.case,
        varies: ladder.varies.into(),
        held: BTreeMap::new(),
        x: axis(ladder.varies, ladder.unit),
        points: points
            .iter()
            .zip(&fit.residuals)
            .map(|((x, y, error), residual)| FitPoint {
                x: *x,
                y: significant(*y, 12),
                y_error: Some(significant(*error, 4)),
                mean: None,
                max: None,
                samples: None,
                support_over_dx: None,
                kept: true,
                why: None,
                residual: Some(significant(*residual, 6)),
            })
            .collect(),
        slope: estimate(slope),
        intercept: estimate(intercept),
        residual_sd: significant(fit.residual_sd, 6),
        degrees_of_freedom: fit.degrees_of_freedom,
        coverage: COVERAGE,
        interval: "Student's t of the residuals".into(),
    };
    Ok((slope, entry))
}
