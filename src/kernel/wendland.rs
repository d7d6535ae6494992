//! Wendland's compactly supported positive definite functions, in the form for two and three dimensions.
//!
//! H. Wendland, Adv. Comput. Math. 4 (1995) 389–396; as smoothing kernels: W. Dehnen & H. Aly,
//! Mon. Not. R. Astron. Soc. 425 (2012) 1068–1082, Table 1. The smoothing length is the support: R = h.

use super::Kernel;
use crate::exact::{Piecewise, Polynomial, Rational, int, ratio};

/// Wendland C2: w(q) = (1 − q)⁴ (1 + 4q). Fatehi & Manzari 2011, Eq. (47), who call it the quintic Wendland function.
pub fn wendland_c2() -> Kernel {
    from_factors("wendland-c2", "Wendland C2", 4, vec![int(1), int(4)], "fatehi-manzari-2011, Eq. (47)")
}

/// Wendland C4: w(q) = (1 − q)⁶ (1 + 6q + 35/3 q²). Dehnen & Aly 2012, Table 1.
pub fn wendland_c4() -> Kernel {
    from_factors(
        "wendland-c4",
        "Wendland C4",
        6,
        vec![int(1), int(6), ratio(35, 3)],
        "dehnen-aly-2012, Table 1",
    )
}

/// (1 − q)^power × the polynomial with these ascending coefficients, on 0 ≤ q < 1.
fn from_factors(id: &str, name: &str, power: u32, factor: Vec<Rational>, citation: &str) -> Kernel {
    let edge = Polynomial::new(vec![int(1), int(-1)]).pow(power);
    let profile = Piecewise::new(vec![int(0), int(1)], vec![&edge * &Polynomial::new(factor)]);
    Kernel::of_catalogue(id, name, citation, profile)
}
