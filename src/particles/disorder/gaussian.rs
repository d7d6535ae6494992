//! `gaussian:σ`: d_a = σ ζ_a Δ per axis with ζ_a standard normal, by Box and Muller:
//! (ζ_1, ζ_2) = √(−2 ln v) (cos 2πw, sin 2πw), v even in (0, 1], w even in [0, 1), multiples of 2⁻⁵³.
//!
//! Nothing is cut off, but v ≥ 2⁻⁵³ bounds |(ζ_1, ζ_2)| by √(106 ln 2) = 8.572, which is the reach of the neighbourhood.
//! Neighbours count as free to meet once displacements of 6 σ along an axis let them, beyond which ζ_a lies with
//! probability 2·10⁻⁹: on the square lattice σ ≥ 1/12.

use super::draw::unit_interval;
use super::{DisorderModel, Law, Motion, Moves, Reach, Shape};

/// √(106 ln 2), rounded up.
const LARGEST: f64 = 8.571_7;

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "gaussian",
        formula: "d_a = σ ζ_a Δ, ζ_a standard normal, independent for each axis and particle",
        citation: "",
        moves: Moves::All,
        options: &[],
        motion: |_| {
            Ok(Motion {
                unit: Box::new(|draw| {
                    let words = draw.own_words();
                    let [x, y] = pair(words[0], words[1]);
                    match draw.dimension {
                        1 => [x, 0.0, 0.0],
                        2 => [x, y, 0.0],
                        _ => [x, y, pair(words[2], words[3])[0]],
                    }
                }),
                reach: Reach::PerAxis(6.0),
                // In 3-D the first two components share their bound, the third has its own.
                longest: [LARGEST, LARGEST, LARGEST * std::f64::consts::SQRT_2],
                least_dimension: 1,
                law: Law::Independent(Shape::Normal),
            })
        },
    }
}

fn pair(first: u64, second: u64) -> [f64; 2] {
    let radius = (-2.0 * libm::log(1.0 - unit_interval(first))).sqrt();
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * unit_interval(second));
    [radius * cosine, radius * sine]
}
