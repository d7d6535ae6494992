//! Layers as SVG paths.

use super::layout::{Area, Layout};
use super::text::{Anchor, SIZE, element, number};
use crate::report::figure::{Dash, Layer, Mark, Point};
use std::fmt::Write as _;

/// How many colours there are beside the neutral one.
const COLOURS: usize = 7;

/// More points than this are drawn smaller.
const CROWD: usize = 60;

/// The class of a colour.
pub(super) fn class(colour: usize) -> String {
    if colour == 0 { "c0".into() } else { format!("c{}", (colour - 1) % COLOURS + 1) }
}

/// One layer inside the plot.
pub(super) fn layer(layer: &Layer, layout: &Layout) -> String {
    let class = class(layer.colour);
    match &layer.mark {
        Mark::Points { points, hollow } => {
            let places: Vec<[f64; 2]> = points.iter().map(|p| layout.place(p.x, p.y)).collect();
            let bars = error_bars(points, layout);
            let bars =
                if bars.is_empty() { bars } else { format!("<path class=\"b {class}\" d=\"{bars}\"/>") };
            bars + &markers(&places, layer.colour, *hollow)
        }
        Mark::Line { points, dash } => {
            let places: Vec<[f64; 2]> = points.iter().map(|p| layout.place(p[0], p[1])).collect();
            let path = path(&cut(&places, &layout.plot));
            if path.is_empty() {
                path
            } else {
                format!("<path class=\"l{} {class}\" d=\"{path}\"/>", dashed(*dash))
            }
        }
        Mark::Area { outline } => {
            let places: Vec<[f64; 2]> = outline.iter().map(|p| layout.place(p[0], p[1])).collect();
            format!("<path class=\"a {class}\" d=\"{}z\"/>", path(&[places]))
        }
        Mark::Slope { start, to_x, exponent, label } => {
            let end = start[1] * libm::pow(to_x / start[0], *exponent);
            let (from, to) = (layout.place(start[0], start[1]), layout.place(*to_x, end));
            let text = element(to[0] + 5.0, 0.5 * (from[1] + to[1]) + 0.35 * SIZE, Anchor::Start, label);
            let path =
                format!("M{} {}H{}V{}z", number(from[0]), number(from[1]), number(to[0]), number(to[1]));
            format!("<path class=\"t {class}\" d=\"{path}\"/>{text}")
        }
    }
}

/// The sample of a layer in the legend.
pub(super) fn swatch(layer: &Layer, [x, y]: [f64; 2], length: f64) -> String {
    let class = class(layer.colour);
    let middle = [x + 0.5 * length, y];
    match &layer.mark {
        Mark::Points { hollow, .. } => markers(&[middle], layer.colour, *hollow),
        Mark::Line { dash, .. } => {
            let (x, y) = (number(x), number(y));
            format!("<path class=\"l{} {class}\" d=\"M{x} {y}h{}\"/>", dashed(*dash), number(length))
        }
        Mark::Area { .. } => {
            let (x, y) = (number(x + 3.0), number(y - 4.0));
            format!(
                "<path class=\"a {class}\" d=\"M{x} {y}h{}v8h-{}z\"/>",
                number(length - 6.0),
                number(length - 6.0)
            )
        }
        Mark::Slope { .. } => {
            let (x, y) = (number(x + 4.0), number(y + 4.0));
            format!("<path class=\"t {class}\" d=\"M{x} {y}h{}v-8z\"/>", number(length - 8.0))
        }
    }
}

fn dashed(dash: Dash) -> &'static str {
    match dash {
        Dash::Solid => "",
        Dash::Dashed => " d1",
        Dash::Dotted => " d2",
    }
}

/// One path for all markers of a layer: a shape per colour, so that colour is never alone.
fn markers(places: &[[f64; 2]], colour: usize, hollow: bool) -> String {
    let class = class(colour);
    let shape = match (colour.max(1) - 1) % COLOURS {
        // A stroke of no length has the shape of its cap.
        0 => "h0",
        1 if places.len() > CROWD => "m-1.3-1.3h2.6v2.6h-2.6z",
        1 => "m-2.6-2.6h5.2v5.2h-5.2z",
        2 => "m0-3.4l3.3 5.8h-6.6z",
        3 => "m0-3.5l3.5 3.5-3.5 3.5-3.5-3.5z",
        4 => "m0 3.4l3.3-5.8h-6.6z",
        5 => "m-3-3l6 6m-6 0l6-6",
        _ => "m-3.6 0h7.2m-3.6-3.6v7.2",
    };
    let mut path = String::new();
    for [x, y] in places {
        let _ = write!(path, "M{} {}{shape}", number(*x), number(*y));
    }
    let kind = match (shape, hollow) {
        ("h0", false) if places.len() > CROWD => "p n",
        ("h0", false) => "p",
        ("h0", true) => {
            return format!("<path class=\"p {class}\" d=\"{path}\"/><path class=\"o\" d=\"{path}\"/>");
        }
        (_, true) => "q h",
        _ => "q",
    };
    if path.is_empty() { path } else { format!("<path class=\"{kind} {class}\" d=\"{path}\"/>") }
}

/// Only where they would be seen beside a marker.
fn error_bars(points: &[Point], layout: &Layout) -> String {
    let mut bars = String::new();
    for point in points {
        let Some(error) = point.error else { continue };
        let [x, upper] = layout.place(point.x, point.y + error);
        // Down to zero or below, the bar ends at the axis.
        let low = point.y - error;
        let lower = layout.place(point.x, low)[1];
        let lower = if lower.is_finite() { lower.min(layout.plot.bottom) } else { layout.plot.bottom };
        let upper = upper.max(layout.plot.top);
        if lower - upper > 5.0 {
            let (left, height) = (number(x - 2.0), number(lower - upper));
            let _ = write!(bars, "M{left} {}h4m-2 0v{height}m-2 0h4", number(upper));
        }
    }
    bars
}

/// Absolute to the first point, then relative, in tenths of a pixel so that rounding does not add up.
fn path(lines: &[Vec<[f64; 2]>]) -> String {
    let mut text = String::new();
    for line in lines {
        let mut at = [0_i64; 2];
        for (index, place) in line.iter().enumerate() {
            let next = place.map(|value| (value * 10.0).round() as i64);
            let step = [next[0] - at[0], next[1] - at[1]].map(|tenths| number(tenths as f64 / 10.0));
            let letter = if index == 0 { "M" } else { "l" };
            let _ = write!(text, "{letter}{} {}", step[0], step[1]);
            at = next;
        }
    }
    text
}

/// What of a line lies inside the plot, in pieces.
fn cut(places: &[[f64; 2]], plot: &Area) -> Vec<Vec<[f64; 2]>> {
    let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
    for two in places.windows(2) {
        let Some([from, to]) = cut_segment(two[0], two[1], plot) else { continue };
        match lines.last_mut() {
            Some(line) if line.last() == Some(&from) => line.push(to),
            _ => lines.push(vec![from, to]),
        }
    }
    lines
}

/// The part of a segment inside a rectangle (Liang and Barsky).
fn cut_segment(from: [f64; 2], to: [f64; 2], plot: &Area) -> Option<[[f64; 2]; 2]> {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (axis, low, high) in [(0, plot.left, plot.right), (1, plot.top, plot.bottom)] {
        let step = to[axis] - from[axis];
        if !step.is_finite() {
            return None;
        }
        if step == 0.0 {
            if from[axis] < low || from[axis] > high {
                return None;
            }
            continue;
        }
        let ends = [(low - from[axis]) / step, (high - from[axis]) / step];
        first = first.max(ends[0].min(ends[1]));
        last = last.min(ends[0].max(ends[1]));
    }
    let at = |part: f64| {
        if part == 0.0 {
            from
        } else if part == 1.0 {
            to
        } else {
            [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])]
        }
    };
    (first < last).then(|| [at(first), at(last)])
}
