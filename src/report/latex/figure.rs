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
        layer_source(&mut source, &mut data, layer, stem);
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
            let value =
                |values: &Vec<f64>| values.get(row).map_or("nan".to_owned(), |value| format!("{value:e}"));
            let values: Vec<String> = self.columns.iter().map(|(_, values)| value(values)).collect();
            let _ = writeln!(text, "{}", values.join(" "));
        }
        text
    }
}
