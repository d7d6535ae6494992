//! Random directions.

use super::draw::unit_interval;

/// A direction uniform on the sphere of `dimension` dimensions: a sign, an angle, or Archimedes' cylinder.
pub(super) fn uniform(dimension: usize, words: [u64; 2]) -> [f64; 3] {
    match dimension {
        1 => [if words[0] >> 63 == 0 { 1.0 } else { -1.0 }, 0.0, 0.0],
        2 => {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(words[0]));
            [cosine, sine, 0.0]
        }
        _ => {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(words[0]));
            let z = 2.0 * unit_interval(words[1]) - 1.0;
            let rho = (1.0 - z * z).max(0.0).sqrt();
            [rho * cosine, rho * sine, z]
        }
    }
}

/// In 3-D θ uniform in [0, 2π) about the polar `axis` and φ uniform in [0, π) from it, which crowds the directions at the
/// poles: ⟨n_axis²⟩ = 1/2, ⟨n_other²⟩ = 1/4. As [`uniform`] in 1-D and 2-D.
pub(super) fn by_angles(dimension: usize, words: [u64; 2], axis: usize) -> [f64; 3] {
    if dimension < 3 {
        return uniform(dimension, words);
    }
    let (sin_theta, cos_theta) = libm::sincos(std::f64::consts::TAU * unit_interval(words[0]));
    let (sin_phi, cos_phi) = libm::sincos(std::f64::consts::PI * unit_interval(words[1]));
    let mut n = [0.0; 3];
    n[axis] = cos_phi;
    n[(axis + 1) % 3] = sin_phi * cos_theta;
    n[(axis + 2) % 3] = sin_phi * sin_theta;
    n
}

/// A unit vector across `n`: the one quarter turn in 2-D; in 3-D uniform on the circle.
pub(super) fn across(dimension: usize, n: [f64; 3], word: u64) -> [f64; 3] {
    if dimension < 3 {
        return [-n[1], n[0], 0.0];
    }
    // Two vectors across n and each other, from the axis that n leans on least.
    let least = (1..3).fold(0, |least, a| if n[a].abs() < n[least].abs() { a } else { least });
    let axis: [f64; 3] = std::array::from_fn(|a| if a == least { 1.0 } else { 0.0 });
    let first = cross(n, axis);
    let length = first.iter().map(|x| x * x).sum::<f64>().sqrt();
    let first = first.map(|x| x / length);
    let second = cross(n, first);
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(word));
    std::array::from_fn(|a| cosine * first[a] + sine * second[a])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
