//! `canonical:η[,angles=uniform|printed][,axis=z|x|y]`: each particle on a circle or sphere of radius ηΔ about its site
//! (Chaussonnet et al. 2015, §II.A). In 1-D the sphere is a pair of points.
//!
//! With `angles=uniform`, the default, the direction is uniform on the sphere. §II.A prints θ even in [0, 2π] and in 3-D φ
//! even in [0, π]: that is `angles=printed`. It is not uniform on the sphere. With the polar `axis` z,
//! n = (sin φ cos θ, sin φ sin θ, cos φ), ⟨n_z²⟩ = 1/2 and ⟨n_x²⟩ = ⟨n_y²⟩ = 1/4 in place of 1/3, so the axis matters; the
//! paper does not say which it is. In 1-D and 2-D both readings are the same.

use super::{DisorderModel, Law, Motion, Moves, Options, Reach, Shape, direction};

pub(super) fn model() -> DisorderModel {
    DisorderModel {
        id: "canonical",
        formula: "|d| = η Δ, independent for each particle, direction uniform on the circle or sphere (a sign in 1-D); \
                  angles=printed in 3-D: θ even in [0, 2π), φ even in [0, π) from axis=z|x|y",
        citation: "chaussonnet-2015, §II.A",
        moves: Moves::All,
        options: &["angles", "axis"],
        motion,
    }
}

fn motion(options: &Options) -> Result<Motion, String> {
    let printed = options.choice("angles", &["uniform", "printed"])? == 1;
    let axis = [2, 0, 1][options.choice("axis", &["z", "x", "y"])?];
    if options.has("axis") && !printed {
        return Err("has an axis, which has a meaning with angles=printed only".into());
    }
    let mut motion = Motion {
        unit: Box::new(|draw| {
            let [a, b, ..] = draw.own_words();
            direction::uniform(draw.dimension, [a, b])
        }),
        reach: Reach::Ball(1.0),
        longest: [1.0; 3],
        least_dimension: 1,
        law: Law::Independent(Shape::Sphere),
    };
    if printed {
        motion.law = Law::Independent(Shape::Angles { axis });
        motion.unit = Box::new(move |draw| {
            let [a, b, ..] = draw.own_words();
            direction::by_angles(draw.dimension, [a, b], axis)
        });
    }
    Ok(motion)
}
