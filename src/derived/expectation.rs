//! Expectations over the law of one displacement by quadrature, split where the particle crosses a knot of the kernel.
//! Lengths are in units of Δ.

use super::quadrature::{Rule, gauss_hermite, gauss_legendre};
use crate::particles::Shape;
use std::f64::consts::{PI, TAU};
use std::sync::OnceLock;

/// The largest rule that is kept.
const LARGEST: usize = 96;
/// Nodes of a panel of composite rules.
const PANEL: usize = 16;

/// The law's surroundings: how far particles move, and where the kernel has knots.
pub(super) struct Expectation {
    dimension: usize,
    amplitude: f64,
    /// Distances from particle i at which the summand is not smooth.
    knots: Vec<f64>,
    /// p + q, the degree of the summand in the direction of r.
    rank: usize,
    legendre: Vec<OnceLock<Rule>>,
    hermite: Vec<OnceLock<Rule>>,
}

/// A displacement with its weight.
pub(super) type Node = ([f64; 3], f64);

/// What is done at a node.
type Visit<'v> = &'v mut dyn FnMut([f64; 3], f64);

impl Expectation {
    pub(super) fn new(dimension: usize, amplitude: f64, knots: Vec<f64>, rank: usize) -> Self {
        let empty = || (0..=LARGEST).map(|_| OnceLock::new()).collect();
        Self { dimension, amplitude, knots, rank, legendre: empty(), hermite: empty() }
    }

    fn legendre(&self, n: usize) -> &Rule {
        self.legendre[n.min(LARGEST)].get_or_init(|| gauss_legendre(n.min(LARGEST)))
    }

    fn hermite(&self, n: usize) -> &Rule {
        self.hermite[n.min(LARGEST)].get_or_init(|| gauss_hermite(n.min(LARGEST)))
    }

    /// Nodes along an interval, `n` or a few more, with weights of sum 1: in panels where they are many.
    pub(super) fn interval(&self, from: f64, to: f64, n: usize) -> Vec<(f64, f64)> {
        let (panels, n) = if n <= LARGEST { (1, n) } else { (n.div_ceil(PANEL), PANEL) };
        let width = (to - from) / panels as f64;
        let mut nodes = Vec::with_capacity(panels * n);
        for panel in 0..panels {
            let middle = from + width * (panel as f64 + 0.5);
            for (x, weight) in self.legendre(n).iter() {
                nodes.push((middle + 0.5 * width * x, 0.5 * weight / panels as f64));
            }
        }
        nodes
    }

    /// Nodes an axis of rules that are not split, at a level.
    fn per_axis(&self, shape: Shape, level: usize) -> usize {
        match (shape, self.dimension) {
            (Shape::Box { .. }, 1) => 8 + 4 * level,
            (Shape::Box { .. }, 2) => 5 + 2 * level,
            (Shape::Box { .. }, _) => 4 + level,
            (Shape::Normal, 1) => 12 + 8 * level,
            (Shape::Normal, 2) => 8 + 3 * level,
            (Shape::Normal, _) => 5 + level,
            (Shape::Sphere | Shape::Angles { .. }, _) => 6 + 3 * level,
        }
    }

    /// Nodes of a particle j with nothing to split, about.
    pub(super) fn inner_nodes(&self, shape: Shape, level: usize) -> f64 {
        let n = self.per_axis(shape, level) as f64;
        match (shape, self.dimension) {
            (Shape::Sphere | Shape::Angles { .. }, 1) => 2.0,
            (Shape::Sphere, 3) => n * self.azimuths() as f64,
            (Shape::Angles { .. }, 3) => 2.0 * n * n,
            (Shape::Sphere | Shape::Angles { .. }, _) => 2.0 * n,
            (_, d) => n.powi(d as i32),
        }
    }

    /// The displacements of particle i with weights of sum 1; finer where nothing else averages the sum.
    pub(super) fn nodes(&self, shape: Shape, level: usize, alone: bool) -> Vec<Node> {
        let a = self.amplitude;
        match (shape, self.dimension) {
            (Shape::Sphere | Shape::Angles { .. }, 1) => {
                vec![([a, 0.0, 0.0], 0.5), ([-a, 0.0, 0.0], 0.5)]
            }
            (Shape::Sphere | Shape::Angles { .. }, 2) => {
                let count = if alone { 64_usize } else { 16 } << level;
                let at = |k: usize| {
                    let (sine, cosine) = libm::sincos(TAU * (k as f64 + 0.5) / count as f64);
                    ([a * cosine, a * sine, 0.0], 1.0 / count as f64)
                };
                (0..count).map(at).collect()
            }
            (Shape::Sphere, _) => {
                let n = if alone { 16 << level } else { 6 + 3 * level };
                let mut nodes = Vec::new();
                for (z, weight) in self.interval(-1.0, 1.0, n) {
                    let rho = (1.0 - z * z).sqrt();
                    for k in 0..2 * n {
                        let (sine, cosine) = libm::sincos(TAU * (k as f64 + 0.5) / (2 * n) as f64);
                        nodes.push(([a * rho * cosine, a * rho * sine, a * z], weight / (2 * n) as f64));
                    }
                }
                nodes
            }
            (Shape::Angles { axis }, _) => self.by_angles(axis, 6 + 3 * level),
            (Shape::Box { half }, 1) => self
                .interval(-a * half, a * half, 16 << level)
                .into_iter()
                .map(|(x, w)| ([x, 0.0, 0.0], w))
                .collect(),
            (Shape::Box { half }, _) => {
                let n = self.per_axis(shape, level) + usize::from(self.dimension == 2) * 2 * level;
                self.product(self.legendre(n), a * half, 0.5)
            }
            (Shape::Normal, _) => self.product(self.hermite(self.per_axis(shape, level)), a, 1.0),
        }
    }

    /// The expectation over the displacement d of a particle with x_i + d_i − x_j = `y`: nodes with weights of sum 1. `whole`
    /// is what [`Expectation::whole`] gives.
    pub(super) fn visit(&self, shape: Shape, y: [f64; 3], level: usize, whole: &[Node], visit: Visit<'_>) {
        let a = self.amplitude;
        let n = self.per_axis(shape, level);
        match (shape, self.dimension) {
            (Shape::Sphere | Shape::Angles { .. }, 1) => {
                visit([a, 0.0, 0.0], 0.5);
                visit([-a, 0.0, 0.0], 0.5);
            }
            (Shape::Sphere | Shape::Angles { .. }, 2) => self.visit_circle(y, n, visit),
            (Shape::Sphere, _) => self.visit_sphere(y, n, visit),
            (Shape::Angles { .. }, _) | (Shape::Normal, _) => {
                whole.iter().for_each(|(d, weight)| visit(*d, *weight));
            }
            (Shape::Box { half }, _) => self.visit_box(y, a * half, n, 0, 0.0, [0.0; 3], 1.0, visit),
        }
    }

    /// The nodes of rules that are not split, the same for all particles j; none for those that are.
    pub(super) fn whole(&self, shape: Shape, level: usize) -> Vec<Node> {
        let n = self.per_axis(shape, level);
        match (shape, self.dimension) {
            (Shape::Angles { axis }, 3) => self.by_angles(axis, n),
            (Shape::Normal, _) => self.product(self.hermite(n), self.amplitude, 1.0),
            _ => Vec::new(),
        }
    }

    /// cos of the angle between y and d at which |y − d| is a knot, within the circle or sphere of the amplitude.
    fn crossings(&self, distance: f64) -> Vec<f64> {
        let a = self.amplitude;
        let cosine = |knot: &f64| (distance * distance + a * a - knot * knot) / (2.0 * distance * a);
        self.knots.iter().map(cosine).filter(|cosine| cosine.abs() < 1.0).collect()
    }

    fn visit_circle(&self, y: [f64; 3], n: usize, visit: Visit<'_>) {
        let a = self.amplitude;
        let distance = (y[0] * y[0] + y[1] * y[1]).sqrt();
        let e = [y[0] / distance, y[1] / distance];
        let breaks = self.crossings(distance).into_iter().map(libm::acos).collect();
        self.pieces(0.0, PI, breaks, n, &mut |theta, weight| {
            let (sine, cosine) = libm::sincos(theta);
            for sine in [sine, -sine] {
                let d = [a * (cosine * e[0] - sine * e[1]), a * (cosine * e[1] + sine * e[0]), 0.0];
                visit(d, 0.5 * weight / PI);
            }
        });
    }

    /// Azimuths about y that are exact for the square of a summand of degree p + q.
    fn azimuths(&self) -> usize {
        2 * self.rank + 2
    }

    fn visit_sphere(&self, y: [f64; 3], n: usize, visit: Visit<'_>) {
        let a = self.amplitude;
        let distance = (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]).sqrt();
        let e = y.map(|y| y / distance);
        let [u, v] = across(e);
        let count = self.azimuths();
        self.pieces(-1.0, 1.0, self.crossings(distance), n, &mut |cosine, weight| {
            let rho = (1.0 - cosine * cosine).max(0.0).sqrt();
            for k in 0..count {
                let (s, c) = libm::sincos(TAU * k as f64 / count as f64);
                let d = std::array::from_fn(|x| a * (cosine * e[x] + rho * (c * u[x] + s * v[x])));
                visit(d, 0.5 * weight / count as f64);
            }
        });
    }

    /// One axis of a box after the other; `rest` is the square of the distance along the axes before.
    #[expect(clippy::too_many_arguments, reason = "the state of a recursion")]
    fn visit_box(
        &self,
        y: [f64; 3],
        half: f64,
        n: usize,
        axis: usize,
        rest: f64,
        mut d: [f64; 3],
        weight: f64,
        visit: Visit<'_>,
    ) {
        if axis == self.dimension {
            visit(d, weight);
            return;
        }
        // The squares of the distances along the axes to come at which the integral over them is not smooth: the corners and,
        // where the sphere may touch from inside, zero.
        let mut later = vec![0.0];
        for y in &y[axis + 1..self.dimension] {
            let mut ends = vec![(y - half) * (y - half), (y + half) * (y + half)];
            if y.abs() < half {
                ends.push(0.0);
            }
            later = later.iter().flat_map(|sum| ends.iter().map(move |end| sum + end)).collect();
        }
        let mut breaks = Vec::new();
        for knot in &self.knots {
            for later in &later {
                let square = knot * knot - rest - later;
                if square > 0.0 {
                    breaks.extend([y[axis] - square.sqrt(), y[axis] + square.sqrt()]);
                }
            }
        }
        self.pieces(-half, half, breaks, n, &mut |t, share| {
            d[axis] = t;
            let along = y[axis] - t;
            let share = weight * share / (2.0 * half);
            self.visit_box(y, half, n, axis + 1, rest + along * along, d, share, visit);
        });
    }

    /// ∫ from `from` to `to`, `n` nodes in each piece between the breaks.
    fn pieces(&self, from: f64, to: f64, mut breaks: Vec<f64>, n: usize, visit: &mut dyn FnMut(f64, f64)) {
        breaks.retain(|at| *at > from && *at < to);
        breaks.extend([from, to]);
        breaks.sort_by(f64::total_cmp);
        for piece in breaks.windows(2) {
            let (middle, half) = (0.5 * (piece[0] + piece[1]), 0.5 * (piece[1] - piece[0]));
            if half > 0.0 {
                for (x, weight) in self.legendre(n).iter() {
                    visit(middle + half * x, half * weight);
                }
            }
        }
    }

    /// θ even about an axis and φ even from it.
    fn by_angles(&self, axis: usize, n: usize) -> Vec<Node> {
        let mut nodes = Vec::new();
        for (phi, weight) in self.interval(0.0, PI, n) {
            let (sin_phi, cos_phi) = libm::sincos(phi);
            for k in 0..2 * n {
                let (sine, cosine) = libm::sincos(TAU * (k as f64 + 0.5) / (2 * n) as f64);
                let mut d = [0.0; 3];
                d[axis] = self.amplitude * cos_phi;
                d[(axis + 1) % 3] = self.amplitude * sin_phi * cosine;
                d[(axis + 2) % 3] = self.amplitude * sin_phi * sine;
                nodes.push((d, weight / (2 * n) as f64));
            }
        }
        nodes
    }

    /// The same rule along each axis, its nodes times `scale` and its weights times `share`.
    fn product(&self, rule: &Rule, scale: f64, share: f64) -> Vec<Node> {
        (0..self.dimension).fold(vec![([0.0; 3], 1.0)], |nodes, axis| {
            let longer = |(d, weight): &Node| {
                let (d, weight) = (*d, *weight);
                rule.iter().map(move |(x, w)| {
                    let mut d = d;
                    d[axis] = scale * x;
                    (d, weight * share * w)
                })
            };
            nodes.iter().flat_map(longer).collect()
        })
    }

    /// Directions of waves, n and −n alike, with weights of sum 1.
    pub(super) fn directions(&self, level: usize) -> Vec<Node> {
        let n = 12 + 8 * level;
        match self.dimension {
            1 => vec![([1.0, 0.0, 0.0], 1.0)],
            2 => {
                let at = |k: usize| {
                    let (sine, cosine) = libm::sincos(PI * (k as f64 + 0.5) / n as f64);
                    ([cosine, sine, 0.0], 1.0 / n as f64)
                };
                (0..n).map(at).collect()
            }
            _ => {
                let mut nodes = Vec::new();
                for (z, weight) in self.legendre(n).iter() {
                    let rho = (1.0 - z * z).sqrt();
                    for k in 0..n {
                        let (sine, cosine) = libm::sincos(PI * (k as f64 + 0.5) / n as f64);
                        nodes.push(([rho * cosine, rho * sine, z], 0.5 * weight / n as f64));
                    }
                }
                nodes
            }
        }
    }
}

/// The directions in which a wave along `n` moves particles, with weights of sum 1.
pub(super) fn polarisations(dimension: usize, n: [f64; 3], transverse: bool, level: usize) -> Vec<Node> {
    match (transverse, dimension) {
        (false, _) => vec![(n, 1.0)],
        (true, 3) => {
            let [u, v] = across(n);
            // e and −e are the same wave in another phase.
            let count = 6 + 4 * level;
            let at = |k: usize| {
                let (sine, cosine) = libm::sincos(PI * k as f64 / count as f64);
                (std::array::from_fn(|a| cosine * u[a] + sine * v[a]), 1.0 / count as f64)
            };
            (0..count).map(at).collect()
        }
        (true, _) => vec![([-n[1], n[0], 0.0], 1.0)],
    }
}

/// Two unit vectors across a unit vector and each other.
pub(super) fn across(n: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (1..3).fold(0, |least, a| if n[a].abs() < n[least].abs() { a } else { least });
    let axis: [f64; 3] = std::array::from_fn(|a| if a == least { 1.0 } else { 0.0 });
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let first = cross(n, axis);
    let length = first.iter().map(|x| x * x).sum::<f64>().sqrt();
    let first = first.map(|x| x / length);
    [first, cross(n, first)]
}
