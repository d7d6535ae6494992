//! All derived and measured exponents of a report against each other.

use super::names::value_of;
use super::{Axis, Dash, Figure, Layer, Point};
use crate::record::Report;

/// Measured exponents of Δ/h over derived ones: where both columns agree, points lie on the diagonal. `None` if fewer
/// than three claims have both.
pub fn exponents(report: &Report) -> Option<Figure> {
    let axis = |name: &str| Axis { name: name.into(), unit: "1".into(), log: false };
    let mut figure = Figure::new(
        "exponents",
        "Measured exponents of Δ/h over derived ones, with their intervals; on the diagonal both agree",
        axis("derived exponent of Δ/h"),
        axis("measured exponent of Δ/h"),
    );
    let mut all: Vec<(u8, Point)> = Vec::new();
    for entry in &report.claims {
        let exponent = |column: &Option<crate::record::Column>| {
            column.as_ref().and_then(|c| c.exponents.as_ref()).and_then(|e| e.dx_over_h.clone())
        };
        let (Some(derived), Some(measured)) = (exponent(&entry.derived), exponent(&entry.measured)) else {
            continue;
        };
        let numbers = [&derived.value, &measured.value, &measured.low, &measured.high].map(value_of);
        let [Some(x), Some(y), Some(low), Some(high)] = numbers else { continue };
        all.push((entry.case.dimension, Point { x, y, error: Some(0.5 * (high - low)) }));
    }
    if all.len() < 3 {
        return None;
    }
    let ends = all.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |ends, (_, point)| {
        [ends[0].min(point.x), ends[1].max(point.x)]
    });
    figure.layers.push(Layer::line("equal", 0, ends.map(|end| [end, end]).to_vec(), Dash::Solid));
    let several = all.iter().any(|(dimension, _)| all.first().is_some_and(|(first, _)| first != dimension));
    for dimension in 1..=3 {
        // Side by side, so that the three dimensions do not hide one another.
        let shift = if several { 0.05 * (f64::from(dimension) - 2.0) } else { 0.0 };
        let shifted = |point: &Point| Point { x: point.x + shift, ..*point };
        let own: Vec<Point> =
            all.iter().filter(|(d, _)| *d == dimension).map(|(_, point)| shifted(point)).collect();
        if !own.is_empty() {
            let name = format!("{dimension}-D, {} cases", own.len());
            figure.layers.push(Layer::points(name, usize::from(dimension), own));
        }
    }
    if several {
        figure.notes.push("1-D and 3-D are moved sideways by 0.05 so that they can be told apart.".into());
    }
    Some(figure)
}
