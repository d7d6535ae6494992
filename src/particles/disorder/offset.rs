//! `offset:A`: particle i alone is displaced, by A Δ in a direction uniform on the circle or sphere (a sign in 1-D).
//!
//! Seen from i, the whole lattice is displaced rigidly: the reading under which Fatehi & Manzari 2011 take d̃ out of the
//! sum in Eq. (38).

use super::{DisorderModel, Law, Motion, Moves, Reach, Shape, direction};

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "offset",
        formula: "d_i = A Δ n, n uniform on the unit sphere; d_j = 0 for j ≠ i",
        citation: "fatehi-manzari-2011, Eq. (38)",
        moves: Moves::CentreOnly,
        options: &[],
        motion: |_| {
            Ok(Motion {
                unit: Box::new(|draw| {
                    let [a, b, ..] = draw.own_words();
                    direction::uniform(draw.dimension, [a, b])
                }),
                reach: Reach::Ball(1.0),
                longest: [1.0; 3],
                least_dimension: 1,
                law: Law::Independent(Shape::Sphere),
            })
        },
    }
}
