//! Why the fitted exponent of K_x is not zero although the operators are linear: what makes −0.085, and what does not.

use super::TaskError;
use super::compute::{PRECISION_CASES, SCALES, Work};
use super::gradients::all_points;
use super::power::four_coefficients;
use super::results::Results;
use crate::claim::chaussonnet_2015::FITS;
use crate::measured::precision::{Storage, TAKEN};
use crate::record::{Report, significant};
use crate::study::survey::table_row;
use serde::Serialize;

const DOUBLE: Storage = Storage { single: false, offset: 0.0, reference: 0.0, quantum: 0.0, excess: 0.0 };
const SINGLE: Storage = Storage { single: true, ..DOUBLE };

/// The ways of storing numbers that are tried.
pub(super) const STORAGES: [(&str, Storage); 10] = [
    ("f64", DOUBLE),
    ("f32", SINGLE),
    ("f32, origin 100 L away", Storage { offset: 100.0, ..SINGLE }),
    ("f32, field about 1", Storage { reference: 1.0, ..SINGLE }),
    ("f32, field about 1000", Storage { reference: 1000.0, ..SINGLE }),
    ("f64, field about 0.015", Storage { reference: 0.015, ..DOUBLE }),
    ("f64, field to 6 decimals", Storage { quantum: 1e-6, ..DOUBLE }),
    ("f64, field to 4 decimals", Storage { quantum: 1e-4, ..DOUBLE }),
    ("f32, field to 4 decimals", Storage { quantum: 1e-4, ..SINGLE }),
    ("f64, field scaled by K_x + 0.015 and normalised by K_x", Storage { excess: 0.015, ..DOUBLE }),
];

/// What a way of storing numbers is called.
pub(super) fn name_of(storage: Storage) -> &'static str {
    STORAGES.iter().find(|(_, known)| *known == storage).map_or("", |(name, _)| *name)
}

/// An exponent of K_x.
#[derive(Serialize)]
struct Row {
    storage: &'static str,
    operator: &'static str,
    field: &'static str,
    eta: f64,
    published: Option<f64>,
    found: f64,
    lowest_over_highest_scale: f64,
}

/// An absolute error ε/K_x added in quadrature to every error.
#[derive(Serialize)]
struct Additive {
    chosen_for: u8,
    absolute_error: f64,
    applied_to: u8,
    a2: f64,
    a3: f64,
    a4: f64,
    published_a3: f64,
    published_a4: f64,
}

pub(super) fn enter(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    storages(found, report);
    additive(found, report)
}

fn storages(found: &Results<'_>, report: &mut Report) {
    let mut rows = Vec::new();
    for (work, by_case) in &found.precision {
        let Work::Precision { storage } = work else { continue };
        let name = name_of(*storage);
        for ((eta, _), by_scale) in PRECISION_CASES.iter().zip(by_case) {
            for (taken, (operator, field)) in TAKEN.into_iter().enumerate() {
                let errors: Vec<f64> = by_scale.iter().map(|errors| errors[taken]).collect();
                let published = FITS.iter().find(|fit| fit.operator == operator && fit.field == field);
                rows.push(table_row(&Row {
                    storage: name,
                    operator,
                    field,
                    eta: *eta,
                    published: published.map(|fit| fit.scale),
                    found: significant(exponent(&errors), 3),
                    lowest_over_highest_scale: significant(errors[0] / errors[errors.len() - 1], 6),
                }));
            }
        }
    }
    report.tables.insert("field_scale_exponents".into(), rows);
}

/// d ln y/d ln K_x over [`SCALES`].
fn exponent(errors: &[f64]) -> f64 {
    let x = SCALES.map(libm::log);
    let y: Vec<f64> = errors.iter().map(|y| libm::log(*y)).collect();
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let cross: f64 = x.iter().zip(&y).map(|(x, y)| x * (y - mean)).sum();
    cross / x.iter().map(|x| x * x).sum::<f64>()
}

/// The error that, added in quadrature, gives one fit its published exponent of K_x; what it does to that fit's other
/// exponents, and to the other fits.
fn additive(found: &Results<'_>, report: &mut Report) -> Result<(), TaskError> {
    let mut rows = Vec::new();
    let laws: Vec<_> = FITS
        .iter()
        .map(|fit| (fit, all_points(found, "square", &format!("{}/{}/x", fit.operator, fit.field), false)))
        .collect();
    if laws.iter().any(|(_, points)| points.len() < 8) {
        return Ok(());
    }
    let with = |points: &[[f64; 4]], absolute: f64| -> Result<_, TaskError> {
        let sum =
            |[h, eta, k, y]: &[f64; 4]| [*h, *eta, *k, (y * y + (absolute / k) * (absolute / k)).sqrt()];
        four_coefficients(&points.iter().map(sum).collect::<Vec<_>>())
    };
    for (chosen, points) in laws.iter().filter(|(fit, _)| [25, 29, 36].contains(&fit.equation)) {
        // The exponent falls as the absolute error grows, as long as that is small: bisection of its logarithm.
        let (mut low, mut high) = (libm::log(1e-12), libm::log(1e3));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let found = with(points, libm::exp(middle))?;
            if found.exponents[2].value > chosen.scale { low = middle } else { high = middle }
        }
        let absolute = libm::exp(0.5 * (low + high));
        for (fit, points) in &laws {
            let found = with(points, absolute)?;
            let [a2, a3, a4] = found.exponents.map(|a| significant(a.value, 4));
            rows.push(table_row(&Additive {
                chosen_for: chosen.equation,
                absolute_error: significant(absolute, 4),
                applied_to: fit.equation,
                a2,
                a3,
                a4,
                published_a3: fit.eta,
                published_a4: fit.scale,
            }));
        }
    }
    report.tables.insert("field_scale_by_additive_error".into(), rows);
    Ok(())
}
