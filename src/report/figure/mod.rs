//! Figures as data, before any renderer: axes, and layers of points, lines and areas in the units of the axes.
//!
//! [`figures`] makes all of a report's figures from its JSON alone; SVG and PGFPlots draw the same [`Figure`].

mod exponents;
mod kernels;
mod ladder;
mod lattice;
mod names;
mod range;
mod series;
mod spectrum;
mod work;

pub use crate::record::Axis;
pub use exponents::exponents;
pub use ladder::{Ladder, ladders};
pub(super) use names::value_of;
pub use range::Range;

use crate::record::Report;

/// One figure. Coordinates are in the units of the axes; what a logarithmic axis cannot show has been left out already.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Unique in the report; not yet fit for a file name, see [`Figure::file_stem`].
    pub id: String,
    /// Its number in the paper, with its panel: `6b`, `1 (S3, L2)`.
    pub number: Option<String>,
    /// What it shows.
    pub title: String,
    /// The abscissa.
    pub x: Axis,
    /// The ordinate.
    pub y: Axis,
    /// What is drawn, first to last.
    pub layers: Vec<Layer>,
    /// Whether a unit of x is as long as one of y.
    pub same_scale: bool,
    /// What has to be said below it.
    pub notes: Vec<String>,
}

/// One layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name in the legend; layers without one are not in it.
    pub name: Option<String>,
    /// 0 is neutral; layers of the same number belong together and share colour and marker.
    pub colour: usize,
    /// What is drawn.
    pub mark: Mark,
}

/// What a layer draws.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// Points, hollow where a fit leaves them out.
    Points {
        /// Where.
        points: Vec<Point>,
        /// Drawn as outlines.
        hollow: bool,
    },
    /// A line through points. It may leave the figure's [`Range`] and is cut off there.
    Line {
        /// Through what.
        points: Vec<[f64; 2]>,
        /// How.
        dash: Dash,
    },
    /// A closed area: the region of stability, the support.
    Area {
        /// Its outline.
        outline: Vec<[f64; 2]>,
    },
    /// The triangle of a power law on logarithmic axes, labelled with its exponent.
    Slope {
        /// Its corner at the smaller x.
        start: [f64; 2],
        /// Its other x.
        to_x: f64,
        /// The exponent.
        exponent: f64,
        /// The exponent as it is known: `5/2`.
        label: String,
    },
}

/// One point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// Half the length of its error bar.
    pub error: Option<f64>,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Fitted, or measured.
    Solid,
    /// Published.
    Dashed,
    /// Derived, and bounds.
    Dotted,
}

impl Layer {
    /// A named line.
    pub fn line(name: impl Into<String>, colour: usize, points: Vec<[f64; 2]>, dash: Dash) -> Self {
        Self { name: Some(name.into()), colour, mark: Mark::Line { points, dash } }
    }

    /// Named points.
    pub fn points(name: impl Into<String>, colour: usize, points: Vec<Point>) -> Self {
        Self { name: Some(name.into()), colour, mark: Mark::Points { points, hollow: false } }
    }

    /// The same without a name.
    #[must_use]
    pub fn unnamed(self) -> Self {
        Self { name: None, ..self }
    }
}

impl Figure {
    /// A figure without layers.
    pub fn new(id: impl Into<String>, title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            id: id.into(),
            number: None,
            title: title.into(),
            x,
            y,
            layers: Vec::new(),
            same_scale: false,
            notes: Vec::new(),
        }
    }

    /// The id as a file name without extension: letters, digits, `-`, `_` and `.` only.
    pub fn file_stem(&self) -> String {
        let mut stem = String::new();
        for c in self.id.chars() {
            match c {
                c if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.') => stem.push(c),
                '+' => stem.push_str("plus"),
                _ if !stem.ends_with('-') => stem.push('-'),
                _ => {}
            }
        }
        stem.trim_matches('-').to_owned()
    }

    /// Whether the axes can show a point.
    pub fn shows(&self, x: f64, y: f64) -> bool {
        x.is_finite() && y.is_finite() && (!self.x.log || x > 0.0) && (!self.y.log || y > 0.0)
    }
}

/// All figures of a report, in the order of a page: exponents, those of the papers, spectra, work, drawings,
/// ladders.
pub fn figures(report: &Report) -> Vec<Figure> {
    let mut all: Vec<Figure> = exponents(report).into_iter().collect();
    all.extend(overviews(report));
    all.extend(drawings(report));
    all.extend(ladders(report).into_iter().map(|ladder| ladder.figure));
    all
}

/// Drawings of what was computed: particles and kernels.
pub fn drawings(report: &Report) -> Vec<Figure> {
    let mut all = lattice::figures(report);
    all.extend(kernels::figures(report));
    all
}

/// The figures of a report without the ladders of its fits, which a page shows where their claims are.
pub fn overviews(report: &Report) -> Vec<Figure> {
    let mut all = series::figures(report);
    all.extend(spectrum::figures(report));
    all.extend(work::figures(report));
    all
}
