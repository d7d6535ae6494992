//! What part of the plane a figure shows.

use super::{Figure, Mark};

/// The smallest and the largest x and y that a figure shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// From, to.
    pub x: [f64; 2],
    /// From, to.
    pub y: [f64; 2],
}

/// Of the plane outside the data, on each side.
const MARGIN: f64 = 0.06;

impl Figure {
    /// What the figure shows: all points with their error bars, triangles and areas, with a margin. Lines count only
    /// where there is nothing else, so that a published slope far off does not press the data together.
    pub fn range(&self) -> Range {
        let (mut x, mut y) = (Extent::new(self.x.log), Extent::new(self.y.log));
        let lines_count = !self.layers.iter().any(|layer| matches!(layer.mark, Mark::Points { .. }));
        for layer in &self.layers {
            match &layer.mark {
                Mark::Points { points, .. } => {
                    for point in points {
                        let error = point.error.unwrap_or(0.0);
                        x.take(point.x);
                        y.take(point.y);
                        y.take(point.y - error);
                        y.take(point.y + error);
                    }
                }
                Mark::Line { points, .. } if lines_count => {
                    for point in points {
                        x.take(point[0]);
                        y.take(point[1]);
                    }
                }
                Mark::Line { .. } => {}
                Mark::Area { outline } => {
                    for point in outline {
                        x.take(point[0]);
                        y.take(point[1]);
                    }
                }
                Mark::Slope { start, to_x, exponent, .. } => {
                    x.take(start[0]);
                    x.take(*to_x);
                    y.take(start[1]);
                    y.take(start[1] * libm::pow(to_x / start[0], *exponent));
                }
            }
        }
        Range { x: x.padded(), y: y.padded() }
    }
}

/// An interval that grows, in the logarithm where the axis is logarithmic.
struct Extent {
    log: bool,
    low: f64,
    high: f64,
}

impl Extent {
    fn new(log: bool) -> Self {
        Self { log, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    fn take(&mut self, value: f64) {
        if value.is_finite() && (!self.log || value > 0.0) {
            let value = if self.log { libm::log10(value) } else { value };
            self.low = self.low.min(value);
            self.high = self.high.max(value);
        }
    }

    fn padded(&self) -> [f64; 2] {
        let (low, high) = if self.low > self.high { (0.0, 1.0) } else { (self.low, self.high) };
        // A third of a decade, or a part in ten, where there is one value only.
        let least = if self.log { 0.3 } else { 0.1 * low.abs().max(high.abs()).max(1e-12) };
        let spread = (high - low).max(least);
        let (middle, half) = (0.5 * (low + high), (0.5 + MARGIN) * spread);
        let ends = [middle - half, middle + half];
        if self.log { ends.map(|end| libm::pow(10.0, end)) } else { ends }
    }
}
