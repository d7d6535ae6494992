//! `wave:A,wavelength=L[,unit=h|dx][,direction=x|y|z|random][,polarisation=longitudinal|transverse]`:
//! d(x) = A Δ e sin(k·x + φ), |k| = 2π/λ, x the site, φ even in [0, 2π) for each sample.
//!
//! λ is L h, the default, or L Δ with `unit=dx`: along a ladder in Δ/h the one stays the same part of the support, the
//! other the same number of spacings. k points along `direction`, by default the first axis; `random` draws it for each
//! sample, uniform on the circle or sphere. e is along k, the default, or across it with `polarisation=transverse`: the
//! quarter turn of k in 2-D, any direction across k in 3-D, drawn for each sample.
//!
//! Neighbours count as free to meet once 2A is their distance, whatever λ is.

use super::draw::unit_interval;
use super::{DisorderModel, Draw, Law, Motion, Moves, Options, Reach, direction};
use std::f64::consts::TAU;

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "wave",
        formula: "d = A Δ e sin(k·x + φ), φ random in each sample; wavelength=L (needed), unit=h|dx, \
                  direction=x|y|z|random, polarisation=longitudinal|transverse",
        citation: "",
        moves: Moves::Together,
        options: &["wavelength", "unit", "direction", "polarisation"],
        motion,
    }
}

/// Along which axis k points.
#[derive(Clone, Copy)]
enum Direction {
    Axis(usize),
    Random,
}

fn motion(options: &Options) -> Result<Motion, String> {
    let in_h = options.choice("unit", &["h", "dx"])? == 0;
    let direction = match options.choice("direction", &["x", "y", "z", "random"])? {
        3 => Direction::Random,
        axis => Direction::Axis(axis),
    };
    let transverse = options.choice("polarisation", &["longitudinal", "transverse"])? == 1;
    let length = options.positive("wavelength")?.ok_or(
        "has no wavelength: say one, in units of h with unit=h or of Δ with unit=dx (wave:0.1,wavelength=4,unit=h)",
    )?;
    let least_dimension = match direction {
        Direction::Axis(axis) => (axis + 1).max(1 + usize::from(transverse)),
        Direction::Random => 1 + usize::from(transverse),
    };
    let unit = move |draw: &mut Draw<'_>| {
        let words = draw.sample_words();
        let n = match direction {
            Direction::Axis(axis) => std::array::from_fn(|a| if a == axis { 1.0 } else { 0.0 }),
            Direction::Random => direction::uniform(draw.dimension, [words[1], words[2]]),
        };
        let wavelength = if in_h { length * draw.h_over_dx } else { length };
        let x = draw.site.position;
        let path = n[0] * x[0] + n[1] * x[1] + n[2] * x[2];
        let sine = libm::sin(TAU * (path / wavelength + unit_interval(words[0])));
        let e = if transverse { direction::across(draw.dimension, n, words[3]) } else { n };
        e.map(|e| e * sine)
    };
    // Rounding may leave |e| an ulp above 1.
    Ok(Motion {
        unit: Box::new(unit),
        reach: Reach::Ball(1.0),
        longest: [1.0 + 1e-12; 3],
        least_dimension,
        law: Law::Wave {
            wavelength: length,
            in_h,
            along: match direction {
                Direction::Axis(axis) => Some(axis),
                Direction::Random => None,
            },
            transverse,
        },
    })
}
