//! Fits as figures: points, the fitted line, the derived slope as a triangle, the published slope dashed.

use super::names::{case_name, exponent_label, value_of};
use super::{Dash, Figure, Layer, Mark, Point};
use crate::record::{ClaimEntry, Column, Estimate, Exponents, Fit, Report};
use std::collections::BTreeMap;

/// The figure of one fit, and where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// Its place in `report.fits`.
    pub fit: usize,
    /// The places in `report.claims` of the entries that rest on it; the slopes are those of the first.
    pub claims: Vec<usize>,
    /// What is drawn.
    pub figure: Figure,
}

/// One figure per fit, in the order of the report.
pub fn ladders(report: &Report) -> Vec<Ladder> {
    let mut users: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, entry) in report.claims.iter().enumerate() {
        for id in entry.measured.iter().flat_map(|column| &column.fits) {
            users.entry(id).or_default().push(index);
        }
    }
    let of_fit = |(index, fit): (usize, &Fit)| {
        let claims = users.get(fit.id.as_str()).cloned().unwrap_or_default();
        let entry = claims.first().and_then(|first| report.claims.get(*first));
        Ladder { fit: index, figure: figure(fit, entry), claims }
    };
    report.fits.iter().enumerate().map(of_fit).collect()
}

/// The exponent of what the ladder varies.
fn exponent<'a>(column: Option<&'a Column>, varies: &str) -> Option<&'a Estimate> {
    let exponents: &Exponents = column?.exponents.as_ref()?;
    match varies {
        "displacement" => exponents.displacement.as_ref(),
        "h" => exponents.h.as_ref(),
        "dx_over_h" => exponents.dx_over_h.as_ref(),
        "dx" => exponents.dx.as_ref(),
        "dt" => exponents.dt.as_ref(),
        _ => None,
    }
}

fn figure(fit: &Fit, entry: Option<&ClaimEntry>) -> Figure {
    let title = format!("{} against {}: {}", fit.quantity, fit.x.name, case_name(&fit.case));
    let mut figure = Figure::new(fit.id.clone(), title, fit.x.clone(), fit.y.clone());
    let take = |kept: bool| -> Vec<Point> {
        let chosen = fit.points.iter().filter(|point| point.kept == kept && figure.shows(point.x, point.y));
        chosen.map(|point| Point { x: point.x, y: point.y, error: point.y_error }).collect()
    };
    let (kept, left_out) = (take(true), take(false));
    let hidden = fit.points.len() - kept.len() - left_out.len();
    if hidden > 0 {
        figure.notes.push(format!("{hidden} points at zero have no place on logarithmic axes."));
    }
    let sampled = fit.points.iter().any(|point| point.samples.is_some());
    let largest: Vec<[f64; 2]> = fit
        .points
        .iter()
        .filter_map(|point| Some([point.x, point.max?]))
        .filter(|[x, y]| figure.shows(*x, *y))
        .collect();
    let differs = fit.points.iter().any(|point| point.max.is_some_and(|max| max > 1.001 * point.y));
    let triangle = exponent(entry.and_then(|entry| entry.derived.as_ref()), &fit.varies)
        .and_then(|derived| slope_triangle(&kept, derived));
    let published = exponent(entry.and_then(|entry| entry.published.as_ref()), &fit.varies)
        .and_then(|published| published_line(fit, &kept, published));
    let mut layers = Vec::new();
    if sampled && differs {
        layers.push(Layer::line("largest of the samples", 5, largest, Dash::Dotted));
    }
    if let Some(points) = fitted_line(fit, &kept) {
        let name = format!("fit, slope {}", exponent_label(&fit.slope));
        layers.push(Layer::line(name, 1, points, Dash::Solid));
    }
    layers.extend(published);
    layers.extend(triangle);
    let name = match (sampled, fit.points.iter().any(|point| point.support_over_dx.is_some())) {
        (true, _) => "root mean square, kept",
        (false, true) => "envelope over a unit of R/Δ, kept",
        (false, false) => "kept",
    };
    layers.push(Layer::points(name, 1, kept));
    if !left_out.is_empty() {
        layers.push(Layer {
            name: Some("left out".into()),
            colour: 1,
            mark: Mark::Points { points: left_out, hollow: true },
        });
    }
    figure.layers = layers;
    figure
}

/// The window of the fit.
fn window(kept: &[Point]) -> Option<[f64; 2]> {
    let least = kept.iter().map(|point| point.x).reduce(f64::min)?;
    let most = kept.iter().map(|point| point.x).reduce(f64::max)?;
    (least > 0.0 && most > least).then_some([least, most])
}

fn fitted_line(fit: &Fit, kept: &[Point]) -> Option<Vec<[f64; 2]>> {
    let (slope, intercept) = (value_of(&fit.slope.value)?, value_of(&fit.intercept.value)?);
    let at = |x: f64| [x, libm::exp(intercept + slope * libm::log(x))];
    Some(window(kept)?.map(at).to_vec())
}

/// Through the fit's end at large x, where the ladder begins.
fn published_line(fit: &Fit, kept: &[Point], published: &Estimate) -> Option<Layer> {
    let [least, most] = window(kept)?;
    let exponent = value_of(&published.value)?;
    let start = fitted_line(fit, kept)?.last().map(|end| end[1])?;
    let name = format!("published slope {}", exponent_label(published));
    let points = vec![[least, start * libm::pow(least / most, exponent)], [most, start]];
    Some(Layer::line(name, 2, points, Dash::Dashed))
}

/// A triangle under the points, over the middle part of their window.
fn slope_triangle(kept: &[Point], derived: &Estimate) -> Option<Layer> {
    let [least, most] = window(kept)?;
    let exponent = value_of(&derived.value)?;
    let octaves = libm::log(most / least);
    let at = |part: f64| least * libm::exp(part * octaves);
    let (from, to) = (at(0.45), at(0.8));
    // Below every point near it by a quarter of the height that the points take.
    let height = |x: f64| libm::pow(x / from, exponent);
    let low = kept.iter().filter(|point| point.y > 0.0).map(|point| point.y / height(point.x));
    let lowest = low.reduce(f64::min)?;
    let ends = kept.iter().filter(|point| point.y > 0.0).map(|point| libm::log(point.y));
    let (bottom, top) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(b, t), y| (b.min(y), t.max(y)));
    let y = lowest * libm::exp(-(0.16 * (top - bottom)).max(0.35));
    Some(Layer {
        name: Some(format!("derived slope {}", exponent_label(derived))),
        colour: 3,
        mark: Mark::Slope { start: [from, y], to_x: to, exponent, label: exponent_label(derived) },
    })
}
