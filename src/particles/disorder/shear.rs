//! `shear:A[,amount=random|given]`: whole rows slide past each other along the first axis.
//!
//! Basa, Quinlan & Lastiwka 2009, §6.1.4: before the channel flow fails, "particles maintain movement in ordered rows along
//! the channel". Rows at different speeds stand at any phase of each other; how far is not said. Here a row (sites of one
//! last coordinate; in 3-D a layer) moves as a whole:
//!
//! - `amount=random`, the default: d = A ξ_row Δ x̂, ξ_row even in [−1/2, 1/2) and independent for each row. A = 1 is
//!   every phase of rows of period Δ.
//! - `amount=given`: d = A Δ x̂ for every other row, none for the row of particle i and those that go with it.
//!
//! Rows keep their distance and the spacing within, so no two particles can meet. What §6.1.4 says of motion across the
//! rows (rows that swing as a whole by 0.1 to 0.5 % of Δ, then a drift of single particles) is not part of the model; a
//! `wave` and a `gaussian` come close.

use super::draw::unit_interval;
use super::{DisorderModel, Law, Motion, Moves, Options, Reach};

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "shear",
        formula: "d = A ξ Δ along x, ξ even in [−1/2, 1/2) for each row (3-D: layer) of equal last coordinate; \
                  amount=given: d = A Δ for every other row",
        citation: "basa-quinlan-lastiwka-2009, §6.1.4",
        moves: Moves::Together,
        options: &["amount"],
        motion,
    }
}

fn motion(options: &Options) -> Result<Motion, String> {
    Ok(match options.choice("amount", &["random", "given"])? {
        0 => Motion {
            unit: Box::new(|draw| [unit_interval(draw.row_words()[0]) - 0.5, 0.0, 0.0]),
            reach: Reach::Never,
            longest: [0.5; 3],
            least_dimension: 2,
            law: Law::Rows,
        },
        _ => Motion {
            unit: Box::new(|draw| [if draw.row().rem_euclid(2) == 1 { 1.0 } else { 0.0 }, 0.0, 0.0]),
            reach: Reach::Never,
            longest: [1.0; 3],
            least_dimension: 2,
            law: Law::AlternateRows,
        },
    })
}
