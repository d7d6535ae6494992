//! Wendland's compactly supported positive definite functions, in the forms for one dimension and for two and three.
//!
//! H. Wendland, Adv. Comput. Math. 4 (1995) 389–396; as smoothing kernels: W. Dehnen & H. Aly,
//! Mon. Not. R. Astron. Soc. 425 (2012) 1068–1082, Table 1. The smoothing length is the support: R = h. The forms for two
//! and three dimensions may be used in one; an id with the suffix `-1d` is the form for one dimension.

use super::Kernel;
use crate::exact::{Piecewise, Polynomial, Radical, Rational, int, ratio};

const TABLE: &str = "dehnen-aly-2012, Table 1";

/// Wendland C2: w(q) = (1 − q)⁴ (1 + 4q). Fatehi & Manzari 2011, Eq. (47), who call it the quintic Wendland function.
pub fn wendland_c2() -> Kernel {
    from_factors("wendland-c2", "Wendland C2", 4, &[int(1), int(4)], "fatehi-manzari-2011, Eq. (47)")
        .printed_by("fatehi-manzari-2011, Eq. (47)", int(1), [None, over_pi(7, 1), None])
        .printed_by(TABLE, int(1), [None, over_pi(7, 1), over_pi(21, 2)])
}

/// Wendland C4: w(q) = (1 − q)⁶ (1 + 6q + 35/3 q²). Dehnen & Aly 2012, Table 1.
pub fn wendland_c4() -> Kernel {
    from_factors("wendland-c4", "Wendland C4", 6, &[int(1), int(6), ratio(35, 3)], TABLE).printed_by(
        TABLE,
        int(1),
        [None, over_pi(9, 1), over_pi(495, 32)],
    )
}

/// Wendland C6: w(q) = (1 − q)⁸ (1 + 8q + 25q² + 32q³). Dehnen & Aly 2012, Table 1.
pub fn wendland_c6() -> Kernel {
    from_factors("wendland-c6", "Wendland C6", 8, &[int(1), int(8), int(25), int(32)], TABLE).printed_by(
        TABLE,
        int(1),
        [None, over_pi(78, 7), over_pi(1365, 64)],
    )
}

/// Wendland C2 for one dimension: w(q) = (1 − q)³ (1 + 3q). Dehnen & Aly 2012, Table 1.
pub fn wendland_c2_1d() -> Kernel {
    from_factors("wendland-c2-1d", "Wendland C2, 1-D form", 3, &[int(1), int(3)], TABLE).printed_by(
        TABLE,
        int(1),
        [rational(5, 4), None, None],
    )
}

/// Wendland C4 for one dimension: w(q) = (1 − q)⁵ (1 + 5q + 8q²). Dehnen & Aly 2012, Table 1.
pub fn wendland_c4_1d() -> Kernel {
    from_factors("wendland-c4-1d", "Wendland C4, 1-D form", 5, &[int(1), int(5), int(8)], TABLE).printed_by(
        TABLE,
        int(1),
        [rational(3, 2), None, None],
    )
}

/// Wendland C6 for one dimension: w(q) = (1 − q)⁷ (1 + 7q + 19q² + 21q³). Dehnen & Aly 2012, Table 1.
pub fn wendland_c6_1d() -> Kernel {
    from_factors("wendland-c6-1d", "Wendland C6, 1-D form", 7, &[int(1), int(7), int(19), int(21)], TABLE)
        .printed_by(TABLE, int(1), [rational(55, 32), None, None])
}

/// (1 − q)^power × the polynomial with these ascending coefficients, on 0 ≤ q < 1.
fn from_factors(id: &str, name: &str, power: u32, factor: &[Rational], citation: &str) -> Kernel {
    let edge = Polynomial::new(vec![int(1), int(-1)]).pow(power);
    let profile = Piecewise::new(vec![int(0), int(1)], vec![&edge * &Polynomial::new(factor.to_vec())]);
    Kernel::of_catalogue(id, name, citation, profile)
}

/// A printed constant p/q.
pub(super) fn rational(p: i64, q: i64) -> Option<Radical> {
    Some(Radical::from(ratio(p, q)))
}

/// A printed constant p/(qπ).
pub(super) fn over_pi(p: i64, q: i64) -> Option<Radical> {
    Some(Radical::pi_power(-1).scale(&ratio(p, q)))
}
