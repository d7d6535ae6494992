//! Error against work, with the front of what nothing else beats in both.

use super::{Axis, Dash, Figure, Layer, Point};
use crate::record::Report;
use serde_json::Value;
use std::collections::BTreeMap;

/// From every table that counts floating-point operations beside an L2 error.
pub(super) fn figures(report: &Report) -> Vec<Figure> {
    report.tables.iter().filter_map(|(name, rows)| figure(name, rows)).collect()
}

fn figure(table: &str, rows: &[BTreeMap<String, Value>]) -> Option<Figure> {
    let number = |row: &BTreeMap<String, Value>, key: &str| row.get(key).and_then(Value::as_f64);
    let axis = |name: &str| Axis { name: name.into(), unit: "1".into(), log: true };
    let mut figure = Figure::new(
        format!("work-{table}"),
        "L2 error against floating-point operations; the step line is the front that no run beats in both",
        axis("floating-point operations"),
        axis("L2 error"),
    );
    let mut groups: BTreeMap<String, Vec<Point>> = BTreeMap::new();
    for row in rows {
        // A run that was stopped has an error, but no result.
        if row.get("stopped").is_some_and(|why| !why.is_null()) {
            continue;
        }
        let (Some(x), Some(y)) = (number(row, "flops"), number(row, "l2")) else { continue };
        if figure.shows(x, y) {
            let scheme = row.get("scheme").and_then(Value::as_str).unwrap_or("runs");
            groups.entry(scheme.to_owned()).or_default().push(Point { x, y, error: None });
        }
    }
    let all: Vec<Point> = groups.values().flatten().copied().collect();
    if all.len() < 3 {
        return None;
    }
    figure.layers.push(Layer::line("Pareto front", 0, front(&all), Dash::Solid));
    for (index, (scheme, points)) in groups.into_iter().enumerate() {
        figure.layers.push(Layer::points(scheme, index + 1, points));
    }
    Some(figure)
}

/// The least error for up to this much work, as steps.
fn front(points: &[Point]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut line: Vec<[f64; 2]> = Vec::new();
    for point in sorted {
        match line.last() {
            Some([_, least]) if point.y >= *least => {}
            Some([_, least]) => {
                let corner = [point.x, *least];
                line.extend([corner, [point.x, point.y]]);
            }
            None => line.push([point.x, point.y]),
        }
    }
    line
}
