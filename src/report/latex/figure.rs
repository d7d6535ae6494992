//! Figures as PGFPlots sources with their data beside them.

use super::text::tex;
use crate::record::Axis;
use crate::report::figure::{Dash, Figure, Layer, Mark};
use std::fmt::Write as _;

/// How many colours and markers there are beside the neutral ones.
const COLOURS: usize = 7;

/// Filled, and each told from the others without its colour.
const MARKERS: [&str; COLOURS + 1] = ["*", "*", "square*", "triangle*", "diamond*", "pentagon*", "x", "+"];

/// A legend longer than this hides more than it says.
const MOST_NAMES: usize = 24;

/// The source, which reads `STEM.dat`, and that file: a pair of columns a layer, a third where there are error bars.
pub(super) fn pgfplots(figure: &Figure, stem: &str) -> (String, String) {
    let mut source = format!("% {}\n", figure.title.replace('\n', " "));
    for note in &figure.notes {
        let _ = writeln!(source, "% {}", note.replace('\n', " "));
    }
    let ([left, right], [bottom, top]) = (figure.range().x, thick(figure));
    let ends = [("xmin", left), ("xmax", right), ("ymin", bottom), ("ymax", top)];
    let mut options: Vec<String> = vec!["remainder".into()];
    options.extend(
        ends.into_iter().filter(|(_, end)| end.is_finite()).map(|(key, end)| format!("{key}={end:e}")),
    );
    options.push(format!("xlabel={{{}}}", label(&figure.x)));
    options.push(format!("ylabel={{{}}}", label(&figure.y)));
    for (axis, mode) in [(&figure.x, "xmode"), (&figure.y, "ymode")] {
        if axis.log {
            options.push(format!("{mode}=log"));
        }
    }
    if figure.same_scale {
        options.push("axis equal image".into());
    }
    let _ = writeln!(source, "\\begin{{tikzpicture}}\n\\begin{{axis}}[{}]", options.join(",\n  "));
    let mut data = Data::default();
    for layer in &figure.layers {
        match &layer.mark {
            // TeX has no numbers for what lies far off.
            Mark::Line { points, dash } => {
                let mark = Mark::Line { points: cut(points, figure), dash: *dash };
                layer_source(&mut source, &mut data, &Layer { mark, ..layer.clone() }, stem);
            }
            _ => layer_source(&mut source, &mut data, layer, stem),
        }
    }
    let names: Vec<&str> = figure.layers.iter().filter_map(|layer| layer.name.as_deref()).collect();
    if names.len() > MOST_NAMES {
        let _ = writeln!(source, "\\legend{{}}  % {} names are more than a legend holds", names.len());
    }
    source.push_str("\\end{axis}\n\\end{tikzpicture}\n");
    (source, data.text())
}

/// The range of y. Where both axes have one scale, what lies on a line (particles in 1-D) gets some room about it: a picture
/// without height cannot be drawn.
fn thick(figure: &Figure) -> [f64; 2] {
    let range = figure.range();
    let least = 0.1 * (range.x[1] - range.x[0]);
    if !figure.same_scale || range.y[1] - range.y[0] >= least {
        return range.y;
    }
    let middle = 0.5 * (range.y[0] + range.y[1]);
    [middle - 0.5 * least, middle + 0.5 * least]
}

/// A line as far as it runs within the figure and as much again on each side; `nan` where it is interrupted.
fn cut(points: &[[f64; 2]], figure: &Figure) -> Vec<[f64; 2]> {
    let log = [figure.x.log, figure.y.log];
    let to = |axis: usize, value: f64| if log[axis] { libm::log(value) } else { value };
    let from = |axis: usize, value: f64| if log[axis] { libm::exp(value) } else { value };
    let ends = [figure.range().x, thick(figure)];
    let room: [[f64; 2]; 2] = std::array::from_fn(|axis| {
        let [low, high] = ends[axis].map(|end| to(axis, end));
        [low - (high - low), high + (high - low)]
    });
    let mut line: Vec<[f64; 2]> = Vec::new();
    for pair in points.windows(2) {
        let [a, b] = [0, 1].map(|end| [to(0, pair[end][0]), to(1, pair[end][1])]);
        // The part of the segment, from 0 to 1, that lies in the room along both axes.
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let step = b[axis] - a[axis];
            let [enters, leaves] = [0, 1].map(|end| (room[axis][end] - a[axis]) / step);
            if step == 0.0 {
                let inside = (room[axis][0]..=room[axis][1]).contains(&a[axis]);
                last = if inside { last } else { -1.0 };
            } else {
                first = first.max(enters.min(leaves));
                last = last.min(enters.max(leaves));
            }
        }
        if first > last || !(first + last).is_finite() {
            continue;
        }
        let at = |part: f64| std::array::from_fn(|axis| from(axis, a[axis] + part * (b[axis] - a[axis])));
        let start = if first == 0.0 { pair[0] } else { at(first) };
        if line.last() != Some(&start) {
            if !line.is_empty() {
                line.push([f64::NAN; 2]);
            }
            line.push(start);
        }
        line.push(if last == 1.0 { pair[1] } else { at(last) });
    }
    line
}

fn label(axis: &Axis) -> String {
    match axis.unit.as_str() {
        "1" | "" => tex(&axis.name),
        unit => format!("{} / {}", tex(&axis.name), tex(unit)),
    }
}

fn layer_source(source: &mut String, data: &mut Data, layer: &Layer, stem: &str) {
    let index = if layer.colour == 0 { 0 } else { (layer.colour - 1) % COLOURS + 1 };
    let colour = format!("remainder{index}");
    let forget = if layer.name.is_none() { ", forget plot" } else { "" };
    match &layer.mark {
        Mark::Points { points, hollow } => {
            let errors = points.iter().any(|point| point.error.is_some());
            let columns =
                data.add(points.iter().map(|point| [point.x, point.y, point.error.unwrap_or(0.0)]), errors);
            let style = if *hollow { ", remainder hollow" } else { "" };
            let bars = if errors { ", error bars/.cd, y dir=both, y explicit" } else { "" };
            let marker = MARKERS[index];
            let _ = writeln!(
                source,
                "\\addplot[{colour}, only marks, mark={marker}{style}{forget}{bars}] table[{columns}] {{\\remainderfolder/{stem}.dat}};"
            );
        }
        Mark::Line { points, dash } => {
            let columns = data.add(points.iter().map(|point| [point[0], point[1], 0.0]), false);
            let dash = match dash {
                Dash::Solid => "solid",
                Dash::Dashed => "dashed",
                Dash::Dotted => "densely dotted",
            };
            let _ = writeln!(
                source,
                "\\addplot[{colour}, thick, no marks, {dash}{forget}] table[{columns}] {{\\remainderfolder/{stem}.dat}};"
            );
        }
        Mark::Area { outline } => {
            let columns = data.add(outline.iter().map(|point| [point[0], point[1], 0.0]), false);
            let _ = writeln!(
                source,
                "\\addplot[{colour}, fill={colour}, fill opacity=0.1, no marks{forget}] table[{columns}] {{\\remainderfolder/{stem}.dat}} -- cycle;"
            );
        }
        Mark::Slope { start: [x, y], to_x, exponent, label } => {
            let end = y * libm::pow(to_x / x, *exponent);
            let _ = writeln!(
                source,
                "\\draw[{colour}] (axis cs:{x:e},{y:e}) -- (axis cs:{to_x:e},{y:e}) -- (axis cs:{to_x:e},{end:e}) \
                 node[midway, right, font=\\scriptsize] {{{}}} -- cycle;",
                tex(label)
            );
            if let Some(name) = &layer.name {
                let _ = writeln!(source, "\\addlegendimage{{{colour}}}\n\\addlegendentry{{{}}}", tex(name));
            }
            return;
        }
    }
    if let Some(name) = &layer.name {
        let _ = writeln!(source, "\\addlegendentry{{{}}}", tex(name));
    }
}

fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:e}") } else { "nan".into() }
}

/// Columns of unequal length side by side.
#[derive(Default)]
struct Data {
    columns: Vec<(String, Vec<f64>)>,
    layers: usize,
}

impl Data {
    /// Adds a layer's points; the keys by which PGFPlots finds them.
    fn add(&mut self, points: impl Iterator<Item = [f64; 3]>, errors: bool) -> String {
        self.layers += 1;
        let layer = self.layers;
        let points: Vec<[f64; 3]> = points.collect();
        let names = ["x", "y", "e"].map(|letter| format!("{letter}{layer}"));
        for (axis, name) in names.iter().enumerate().take(if errors { 3 } else { 2 }) {
            self.columns.push((name.clone(), points.iter().map(|point| point[axis]).collect()));
        }
        let error = if errors { format!(", y error={}", names[2]) } else { String::new() };
        format!("x={}, y={}{error}", names[0], names[1])
    }

    /// With a head; where a column has ended, `nan`, which PGFPlots leaves out.
    fn text(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = format!("{}\n", names.join(" "));
        let height = self.columns.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        for row in 0..height {
            let value = |values: &Vec<f64>| values.get(row).map_or("nan".to_owned(), |value| number(*value));
            let values: Vec<String> = self.columns.iter().map(|(_, values)| value(values)).collect();
            let _ = writeln!(text, "{}", values.join(" "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::cut;
    use crate::record::Axis;
    use crate::report::figure::{Figure, Layer, Point};

    #[test]
    fn lines_end_where_tex_would_lose_count() {
        let axis = |log| Axis { name: "x".into(), unit: "1".into(), log };
        let mut figure = Figure::new("id", "title", axis(true), axis(true));
        let points = [(1.0, 1.0), (10.0, 10.0)].map(|(x, y)| Point { x, y, error: None });
        figure.layers.push(Layer::points("p", 1, points.to_vec()));
        let line = cut(&[[1.0, 1.0], [10.0, 1e40]], &figure);
        assert_eq!(line[0], [1.0, 1.0]);
        assert!(line[1][1] > 10.0 && line[1][1] < 1e3 && line[1][0] < 2.0, "{line:?}");
        assert!(cut(&[[1.0, 1e30], [10.0, 1e30]], &figure).is_empty());
        let back = cut(&[[1.0, 1.0], [2.0, 1e30], [4.0, 1.0], [10.0, 1.0]], &figure);
        assert_eq!(back.iter().filter(|point| point[0].is_nan()).count(), 1, "{back:?}");
    }
}
