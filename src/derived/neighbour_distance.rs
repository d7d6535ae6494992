//! The distance of two particles that stood Δ apart, both displaced onto circles or spheres of radius ηΔ (Chaussonnet et
//! al. 2015, §II.A and Fig. 2), over the whole law of the directions.
//!
//! d = |e + η (n₁ − n₂)| with e the unit vector between the sites, in units of Δ. The directions are averaged by rules that
//! are exact for trigonometric polynomials of a degree at which (2η)^degree is below rounding for η < 0.4.

use super::quadrature::gauss_legendre;
use crate::particles::Shape;
use std::f64::consts::{PI, TAU};

/// Mean, deviation and extremes of d/Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeighbourDistance {
    /// The least distance there can be, 1 − 2η.
    pub least: f64,
    /// The largest, 1 + 2η.
    pub largest: f64,
    /// ⟨d⟩/Δ, 1 + O(η²).
    pub mean: f64,
    /// The standard deviation of d/Δ: η in 2-D and √(2/3) η in 3-D, up to O(η²), where directions are uniform.
    pub deviation: f64,
}

/// Nodes of the rules of 3-D: (azimuths, polar).
const SPHERE: (usize, usize) = (32, 20);
/// Angles of the rule of 2-D.
const CIRCLE: usize = 256;

/// d/Δ for sites along an axis, the mean over all axes; `None` where the displacements are not of one length.
///
/// # Examples
/// ```
/// use remainder::{derived::neighbour_distance, particles::Shape};
/// // ⟨d⟩ = 1 + η²/2 + O(η⁴) in 2-D: only the part across e counts.
/// let distance = neighbour_distance(Shape::Sphere, 2, 0.01).unwrap();
/// assert!((distance.mean - 1.0 - 0.5e-4).abs() < 1e-8 && (distance.deviation - 0.01).abs() < 1e-6);
/// ```
pub fn neighbour_distance(shape: Shape, dimension: usize, eta: f64) -> Option<NeighbourDistance> {
    let directions = directions(shape, dimension)?;
    let (mut mean, mut square) = (0.0, 0.0);
    for axis in 0..dimension {
        for (first, w1) in &directions {
            for (second, w2) in &directions {
                let r: [f64; 3] = std::array::from_fn(|a| {
                    (if a == axis { 1.0 } else { 0.0 }) + eta * (first[a] - second[a])
                });
                let d = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
                // About 1, so that the variance keeps its digits at small η.
                mean += w1 * w2 * (d - 1.0);
                square += w1 * w2 * (d - 1.0) * (d - 1.0);
            }
        }
    }
    let (mean, square) = (mean / dimension as f64, square / dimension as f64);
    Some(NeighbourDistance {
        least: 1.0 - 2.0 * eta,
        largest: 1.0 + 2.0 * eta,
        mean: 1.0 + mean,
        deviation: (square - mean * mean).max(0.0).sqrt(),
    })
}

/// Unit vectors with weights of sum 1.
fn directions(shape: Shape, dimension: usize) -> Option<Vec<([f64; 3], f64)>> {
    let around = |count: usize| (0..count).map(move |n| libm::sincos(TAU * (n as f64 + 0.5) / count as f64));
    let (azimuths, polar) = SPHERE;
    let even = 1.0 / azimuths as f64;
    Some(match (shape, dimension) {
        (Shape::Sphere | Shape::Angles { .. }, 1) => vec![([1.0, 0.0, 0.0], 0.5), ([-1.0, 0.0, 0.0], 0.5)],
        (Shape::Sphere | Shape::Angles { .. }, 2) => {
            around(CIRCLE).map(|(s, c)| ([c, s, 0.0], 1.0 / CIRCLE as f64)).collect()
        }
        (Shape::Sphere, _) => {
            let rule = gauss_legendre(polar);
            let ring = |(z, weight): (f64, f64)| {
                let rho = (1.0 - z * z).sqrt();
                around(azimuths).map(move |(s, c)| ([rho * c, rho * s, z], 0.5 * weight * even))
            };
            rule.iter().flat_map(ring).collect()
        }
        (Shape::Angles { axis }, _) => {
            let rule = gauss_legendre(polar);
            let ring = |(node, weight): (f64, f64)| {
                let (sine, cosine) = libm::sincos(0.5 * PI * (1.0 + node));
                around(azimuths).map(move |(s, c)| {
                    let mut n = [0.0; 3];
                    n[axis] = cosine;
                    n[(axis + 1) % 3] = sine * c;
                    n[(axis + 2) % 3] = sine * s;
                    (n, 0.5 * weight * even)
                })
            };
            rule.iter().flat_map(ring).collect()
        }
        (Shape::Box { .. } | Shape::Normal, _) => return None,
    })
}
