//! From the units of a figure to places on the page.

use super::text::{SIZE, width, wrapped};
use super::ticks::{Tick, ticks};
use crate::report::figure::{Figure, Layer, Range};

/// How large a figure is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Of the whole drawing.
    pub width: f64,
    /// Of the area between the axes; figures with one scale choose their own.
    pub plot_height: f64,
    /// Whether it stands by itself: with a legend, a description, small ticks.
    pub alone: bool,
}

impl Size {
    /// A figure by itself; as wide as a phone, and as a column of print.
    pub const FULL: Self = Self { width: 360.0, plot_height: 220.0, alone: true };
    /// One of many whose lines are explained once for all.
    pub const SMALL: Self = Self { width: 300.0, plot_height: 150.0, alone: false };
}

/// A rectangle on the page.
#[derive(Debug, Clone, Copy)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

/// Where everything of one figure goes.
pub(super) struct Layout {
    pub(super) plot: Area,
    pub(super) range: Range,
    log: [bool; 2],
    pub(super) x_ticks: Vec<Tick>,
    pub(super) y_ticks: Vec<Tick>,
    pub(super) y_title: Vec<String>,
    pub(super) x_title: Vec<String>,
    pub(super) legend: Vec<Entry>,
    pub(super) size: [f64; 2],
}

/// An entry of the legend.
pub(super) struct Entry {
    /// Place in the figure's layers.
    pub(super) layer: usize,
    pub(super) lines: Vec<String>,
    pub(super) at: [f64; 2],
}

/// From one line of text to the next.
pub(super) const LINE: f64 = SIZE + 4.0;

/// Of the sample in a legend.
pub(super) const SWATCH: f64 = 26.0;

/// An axis's name with its unit.
fn axis_title(name: &str, unit: &str) -> String {
    if unit == "1" || unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") }
}

impl Layout {
    pub(super) fn of(figure: &Figure, size: Size) -> Self {
        let mut range = figure.range();
        let y_title = wrapped(&axis_title(&figure.y.name, &figure.y.unit), size.width - 8.0);
        let top = 4.0 + LINE * y_title.len() as f64 + 4.0;
        let guess = ticks(range.y[0], range.y[1], figure.y.log, 6);
        let widest = |ticks: &[Tick]| {
            ticks.iter().filter_map(|tick| tick.label.as_deref()).map(width).fold(0.0, f64::max)
        };
        let right = size.width - 10.0;
        let mut left = widest(&guess) + 12.0;
        let mut height = size.plot_height;
        if figure.same_scale {
            // Tick labels may be longer once the range has grown.
            left += SIZE;
            height = one_scale(&mut range, right - left);
        }
        let most_y = (height / 28.0) as usize;
        let y_ticks = ticks(range.y[0], range.y[1], figure.y.log, most_y.clamp(2, 7));
        let left = widest(&y_ticks) + 12.0;
        let plot = Area { left, right, top, bottom: top + height };
        let mut x_ticks = x_ticks(figure, &range, right - left);
        let mut y_ticks = y_ticks;
        if !size.alone {
            x_ticks.retain(|tick| tick.label.is_some());
            y_ticks.retain(|tick| tick.label.is_some());
        }
        let x_title = wrapped(&axis_title(&figure.x.name, &figure.x.unit), right - left);
        let below = plot.bottom + 6.0 + LINE + LINE * x_title.len() as f64;
        let (legend, end) =
            if size.alone { legend(&figure.layers, size, below) } else { (Vec::new(), below) };
        Self {
            plot,
            range,
            log: [figure.x.log, figure.y.log],
            x_ticks,
            y_ticks,
            y_title,
            x_title,
            legend,
            size: [size.width, end + 6.0],
        }
    }

    /// The place of a point; it may lie outside the plot.
    pub(super) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        let part = |value: f64, range: [f64; 2], log: bool| {
            if log {
                libm::log(value / range[0]) / libm::log(range[1] / range[0])
            } else {
                (value - range[0]) / (range[1] - range[0])
            }
        };
        let across = part(x, self.range.x, self.log[0]);
        let up = part(y, self.range.y, self.log[1]);
        [
            self.plot.left + across * (self.plot.right - self.plot.left),
            self.plot.bottom - up * (self.plot.bottom - self.plot.top),
        ]
    }
}

/// Makes one unit of x as long as one of y by widening the range that is too narrow, and returns the height.
fn one_scale(range: &mut Range, width: f64) -> f64 {
    let spread = |ends: [f64; 2]| ends[1] - ends[0];
    let wanted = width * spread(range.y) / spread(range.x);
    let height = wanted.clamp(0.35 * width, 1.0 * width);
    let widen = |ends: &mut [f64; 2], to: f64| {
        let middle = 0.5 * (ends[0] + ends[1]);
        *ends = [middle - 0.5 * to, middle + 0.5 * to];
    };
    if wanted < height {
        widen(&mut range.y, spread(range.x) * height / width);
    } else if wanted > height {
        widen(&mut range.x, spread(range.y) * width / height);
    }
    height
}

/// As many labels as stand apart from each other.
fn x_ticks(figure: &Figure, range: &Range, width_there: f64) -> Vec<Tick> {
    let place = |at: f64| {
        if figure.x.log {
            libm::log(at / range.x[0]) / libm::log(range.x[1] / range.x[0]) * width_there
        } else {
            (at - range.x[0]) / (range.x[1] - range.x[0]) * width_there
        }
    };
    let apart = |ticks: &[Tick]| {
        let labels: Vec<(f64, f64)> =
            ticks.iter().filter_map(|tick| Some((place(tick.at), width(tick.label.as_deref()?)))).collect();
        labels.windows(2).all(|two| two[1].0 - two[0].0 > 0.5 * (two[0].1 + two[1].1) + 6.0)
    };
    let tried = (2..=7).rev().map(|most| ticks(range.x[0], range.x[1], figure.x.log, most));
    let mut ticks =
        tried.clone().find(|ticks| apart(ticks)).or_else(|| tried.clone().next_back()).unwrap_or_default();
    // Whatever still touches its neighbour on the left loses its label.
    let mut end = f64::NEG_INFINITY;
    for tick in &mut ticks {
        let Some(label) = &tick.label else { continue };
        let (middle, half) = (place(tick.at), 0.5 * width(label));
        if middle - half < end + 4.0 { tick.label = None } else { end = middle + half }
    }
    ticks
}

/// The entries in columns below `top`, and where they end.
fn legend(layers: &[Layer], size: Size, top: f64) -> (Vec<Entry>, f64) {
    let most = size.width - SWATCH - 12.0;
    let named: Vec<(usize, Vec<String>)> = layers
        .iter()
        .enumerate()
        .filter_map(|(index, layer)| Some((index, wrapped(layer.name.as_deref()?, most))))
        .collect();
    let widest = named.iter().flat_map(|(_, lines)| lines).map(|line| width(line)).fold(0.0, f64::max);
    let column = widest + SWATCH + 14.0;
    let columns = ((size.width / column) as usize).clamp(1, named.len().max(1));
    let mut entries = Vec::new();
    let mut y = top + 2.0;
    for row in named.chunks(columns) {
        for (index, (layer, lines)) in row.iter().enumerate() {
            let at = [4.0 + index as f64 * size.width / columns as f64, y];
            entries.push(Entry { layer: *layer, lines: lines.clone(), at });
        }
        y += LINE * row.iter().map(|(_, lines)| lines.len()).max().unwrap_or(1) as f64;
    }
    (entries, y)
}
