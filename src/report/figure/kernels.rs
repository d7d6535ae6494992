//! The kernels of a report, and their Fourier transforms.

use super::{Axis, Dash, Figure, Layer};
use crate::kernel::{self, Evaluator, Kernel};
use crate::record::Report;
use std::f64::consts::{PI, TAU};

/// The most kernels of one figure.
const MOST: usize = 6;

/// Up to this k R/2π.
const FARTHEST: f64 = 8.0;

/// Values below this are not told from rounding.
const FLOOR: f64 = 1e-9;

/// Nodes and weights of Gauss and Legendre's rule of five points on (−1, 1).
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Intervals of the rule: the knots of every kernel of the catalogue are among their ends.
const INTERVALS: u32 = 60;

pub(super) fn figures(report: &Report) -> Vec<Figure> {
    let mut used: Vec<(String, Vec<u8>)> = Vec::new();
    for entry in &report.claims {
        let (kernel, dimension) = (&entry.case.kernel, entry.case.dimension);
        match used.iter_mut().find(|(known, _)| known == kernel) {
            Some((_, dimensions)) if dimensions.contains(&dimension) => {}
            Some((_, dimensions)) => dimensions.push(dimension),
            None => used.push((kernel.clone(), vec![dimension])),
        }
    }
    let known: Vec<(Kernel, Vec<u8>)> = used
        .into_iter()
        .filter_map(|(id, dimensions)| Some((kernel::by_id(&id).ok()?, dimensions)))
        .collect();
    let mut figures = Vec::new();
    for (part, group) in known.chunks(MOST).enumerate() {
        let kernels: Vec<&Kernel> = group.iter().map(|(kernel, _)| kernel).collect();
        figures.push(shapes(&kernels, part));
        for dimension in 1..=3_u8 {
            let own: Vec<&Kernel> = group
                .iter()
                .filter(|(_, dimensions)| dimensions.contains(&dimension))
                .map(|(kernel, _)| kernel)
                .collect();
            if !own.is_empty() {
                figures.push(transforms(&own, usize::from(dimension), part));
            }
        }
    }
    figures
}

fn axis(name: &str, log: bool) -> Axis {
    Axis { name: name.into(), unit: "1".into(), log }
}

fn dash(index: usize) -> Dash {
    [Dash::Solid, Dash::Dashed, Dash::Dotted][index % 3]
}

fn shapes(kernels: &[&Kernel], part: usize) -> Figure {
    let mut figure = Figure::new(
        format!("kernels-{part}"),
        "The kernels over the support, each over its value at the origin",
        axis("r/R", false),
        axis("W(r)/W(0)", false),
    );
    for (index, kernel) in kernels.iter().enumerate() {
        let evaluator = Evaluator::<f64>::new(kernel, 1, 0);
        let origin = evaluator.radial(0.0)[0];
        let at = |k: u32| {
            let r = f64::from(k) / 100.0;
            [r, evaluator.radial(r)[0] / origin]
        };
        figure.layers.push(Layer::line(kernel.id(), index + 1, (0..=100).map(at).collect(), dash(index)));
    }
    figure
}

fn transforms(kernels: &[&Kernel], dimension: usize, part: usize) -> Figure {
    let mut figure = Figure::new(
        format!("transforms-{dimension}d-{part}"),
        format!(
            "Fourier transforms of the kernels in {dimension}-D; a lattice sum with support R sees them at k R/2π = R/Δ and beyond"
        ),
        axis("k R/2π", false),
        axis("|Ŵ(k)|", true),
    );
    for (index, kernel) in kernels.iter().enumerate() {
        let points = transform(kernel, dimension);
        figure.layers.push(Layer::line(kernel.id(), index + 1, points, dash(index)));
    }
    figure
}

/// |∫ W(r) exp(i k·r) d^D r| over k R/2π, for R = 1.
fn transform(kernel: &Kernel, dimension: usize) -> Vec<[f64; 2]> {
    let evaluator = Evaluator::<f64>::new(kernel, dimension, 0);
    let half = 0.5 / f64::from(INTERVALS);
    let nodes = (0..INTERVALS).flat_map(|interval| {
        let middle = (2.0 * f64::from(interval) + 1.0) * half;
        GAUSS.map(|(node, weight)| (middle + half * node, weight * half))
    });
    let weighted: Vec<(f64, f64)> = nodes
        .map(|(r, weight)| {
            let shell = match dimension {
                1 => 2.0,
                2 => TAU * r,
                _ => 4.0 * PI * r * r,
            };
            (r, weight * shell * evaluator.radial(r)[0])
        })
        .collect();
    let wave = |kr: f64| match dimension {
        1 => libm::cos(kr),
        2 => libm::j0(kr),
        _ if kr == 0.0 => 1.0,
        _ => libm::sin(kr) / kr,
    };
    let at = |k: u32| {
        let x = FARTHEST * f64::from(k) / 160.0;
        let sum: f64 = weighted.iter().map(|(r, weight)| weight * wave(TAU * x * r)).sum();
        [x, sum.abs()]
    };
    (0..=160).map(at).filter(|[_, value]| *value > FLOOR).collect()
}
