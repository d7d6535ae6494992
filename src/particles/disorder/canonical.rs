//! `canonical:η`: each particle on a circle or sphere of radius ηΔ about its site, uniformly (Chaussonnet et al. 2015,
//! §II.A). In 1-D the sphere is a pair of points.

use super::{DisorderModel, Moves, direction};

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "canonical",
        formula: "|d| = η Δ, direction uniform on the circle or sphere (a sign in 1-D), independent for each particle",
        citation: "chaussonnet-2015, §II.A",
        moves: Moves::All,
        unit: direction,
        reach: 1.0,
        longest: [1.0; 3],
    }
}
