//! `box:ε`: x_i = x_i^reg + ε κ Δ per axis with κ uniform in [−1/4, 1/4] (Fatehi & Manzari 2011, §6.2).

use super::draw::unit_interval;
use super::{DisorderModel, Law, Motion, Moves, Reach, Shape};

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "box",
        formula: "d_a = ε κ_a Δ, κ_a uniform in [−1/4, 1/4], independent for each axis and particle",
        citation: "fatehi-manzari-2011, §6.2",
        moves: Moves::All,
        options: &[],
        motion: |_| {
            Ok(Motion {
                unit: Box::new(|draw| {
                    let (words, dimension) = (draw.own_words(), draw.dimension);
                    std::array::from_fn(|a| {
                        if a < dimension { 0.5 * unit_interval(words[a]) - 0.25 } else { 0.0 }
                    })
                }),
                reach: Reach::PerAxis(0.25),
                longest: [0.25, 0.25 * std::f64::consts::SQRT_2, 0.433_012_701_892_219_4],
                least_dimension: 1,
                law: Law::Independent(Shape::Box { half: 0.25 }),
            })
        },
    }
}
