//! Rotations and reflections.

use proptest::prelude::*;

/// An orthogonal matrix in the first D axes: a product of rotations, times a reflection or not.
pub(crate) fn orthogonal(dimension: usize) -> impl Strategy<Value = [[f64; 3]; 3]> {
    let angle = || 0.0..std::f64::consts::TAU;
    ([angle(), angle(), angle()], any::<bool>()).prop_map(move |(angles, mirrored)| {
        let identity: [[f64; 3]; 3] =
            std::array::from_fn(|a| std::array::from_fn(|b| f64::from(u8::from(a == b))));
        let planes: &[(usize, usize)] = match dimension {
            1 => &[],
            2 => &[(0, 1)],
            _ => &[(0, 1), (1, 2), (0, 1)],
        };
        let mut matrix = identity;
        for ((a, b), angle) in planes.iter().zip(angles) {
            let (sine, cosine) = angle.sin_cos();
            for row in &mut matrix {
                let (x, y) = (row[*a], row[*b]);
                (row[*a], row[*b]) = (cosine * x + sine * y, cosine * y - sine * x);
            }
        }
        if mirrored {
            matrix[0] = matrix[0].map(|entry| -entry);
        }
        matrix
    })
}
