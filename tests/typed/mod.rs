//! W, W′ and W″ of two kernels typed out, lattices by loops, and sums over given pairs.

use remainder::sums::Moment;

/// The moment of this name.
pub(crate) fn moment(name: &str) -> Moment {
    Moment::by_name(name).unwrap()
}

/// W, W′ and W″ at distance r ≥ 0 with support R, in D dimensions.
pub(crate) type Profile = fn(usize, f64, f64) -> [f64; 3];

/// Wendland C2 (Fatehi & Manzari 2011, Eq. 47): W = W₀ (1 − x)⁴ (1 + 4x), W′ = −20 W₀ x (1 − x)³ / R,
/// W″ = −20 W₀ (1 − x)² (1 − 4x) / R², W₀ = 3/2, 7/π, 21/(2π) over R^D.
pub(crate) fn typed_wendland_c2(d: usize, r: f64, radius: f64) -> [f64; 3] {
    use std::f64::consts::PI;
    let x = r / radius;
    if x >= 1.0 {
        return [0.0; 3];
    }
    let w0 = [1.5, 7.0 / PI, 10.5 / PI][d - 1] / radius.powi(d as i32);
    let u = 1.0 - x;
    [
        w0 * u.powi(4) * (1.0 + 4.0 * x),
        -20.0 * w0 * x * u.powi(3) / radius,
        -20.0 * w0 * u * u * (1.0 - 4.0 * x) / (radius * radius),
    ]
}

/// ∂_{a…}W at r_ij for no, one or two indices: W, W′ n_a, or W″ n_a n_b + (W′/r)(δ_ab − n_a n_b), whose limit at the origin
/// is W″(0) δ_ab.
pub(crate) fn derivative(profile: Profile, d: usize, radius: f64, r_ij: &[f64; 3], indices: &[usize]) -> f64 {
    let r = (r_ij[0] * r_ij[0] + r_ij[1] * r_ij[1] + r_ij[2] * r_ij[2]).sqrt();
    let [w, dw, ddw] = profile(d, r, radius);
    let n = |a: usize| r_ij[a] / r;
    match *indices {
        [] => w,
        [_] if r == 0.0 => 0.0,
        [a] => dw * n(a),
        [a, b] if r == 0.0 => ddw * f64::from(u8::from(a == b)),
        [a, b] => ddw * n(a) * n(b) + dw / r * (f64::from(u8::from(a == b)) - n(a) * n(b)),
        _ => unreachable!("no third derivatives"),
    }
}

/// One component of Σ_j ω_j r…r ∇^q W by its name, and Σ|terms|.
pub(crate) fn typed_sum(
    profile: Profile,
    d: usize,
    radius: f64,
    moment: Moment,
    name: &str,
    pairs: &[([f64; 3], f64)],
) -> (f64, f64) {
    let indices: Vec<usize> = name.bytes().map(|letter| usize::from(letter - b'x')).collect();
    let (positions, derivatives) = indices.split_at(moment.positions().into());
    let contracted = moment.name().contains("lap");
    let sign = if moment == Moment::b_inverse() { -1.0 } else { 1.0 };
    pairs.iter().fold((0.0, 0.0), |(sum, scale), (r_ij, weight)| {
        let r: f64 = positions.iter().map(|a| r_ij[*a]).product();
        let w: f64 = if contracted {
            (0..d).map(|a| derivative(profile, d, radius, r_ij, &[a, a])).sum()
        } else {
            derivative(profile, d, radius, r_ij, derivatives)
        };
        let term = sign * weight * r * w;
        (sum + term, scale + term.abs())
    })
}

/// The cubic spline as Monaghan & Lattanzio 1985 print it, q = r/h, R = 2h: 1 − 3/2 q² + 3/4 q³ and (2 − q)³/4, times
/// 2/3, 10/(7π), 1/π over h^D.
pub(crate) fn typed_cubic_spline(d: usize, r: f64, radius: f64) -> [f64; 3] {
    use std::f64::consts::PI;
    let h = 0.5 * radius;
    let q = r / h;
    let sigma = [2.0 / 3.0, 10.0 / (7.0 * PI), 1.0 / PI][d - 1] / h.powi(d as i32);
    let [w, dw, ddw] = if q < 1.0 {
        [1.0 - 1.5 * q * q + 0.75 * q * q * q, -3.0 * q + 2.25 * q * q, -3.0 + 4.5 * q]
    } else if q < 2.0 {
        let u = 2.0 - q;
        [0.25 * u * u * u, -0.75 * u * u, 1.5 * u]
    } else {
        [0.0; 3]
    };
    [sigma * w, sigma * dw / h, sigma * ddw / (h * h)]
}

/// r_ij of a lattice, by plain loops over whole numbers: no basis, no cells.
pub(crate) fn looped(id: &str) -> Vec<[f64; 3]> {
    let range = || (-6..=6).map(f64::from);
    let plane = || range().flat_map(move |x| range().map(move |y| [x, y]));
    match id {
        "line" => range().map(|x| [x, 0.0, 0.0]).collect(),
        "square" => plane().map(|[x, y]| [x, y, 0.0]).collect(),
        "hexagonal" => plane().map(|[m, n]| [m + 0.5 * n, n * 0.75_f64.sqrt(), 0.0]).collect(),
        "simple-cubic" => plane().flat_map(|[x, y]| range().map(move |z| [x, y, z])).collect(),
        _ => unreachable!("no loops for {id}"),
    }
}
