//! The constants of viscous models, from fourth moments of the kernel sum.
//!
//! On v = t (n·r)²/2 the central sum Σ V (v_ij·r_ij)/(r² + η²) ∇W gives, along t,
//!
//! ```text
//! F = −½ Σ_j V_j (n·r_ij)² (t·r_ij)² (W′/r) / (r² + η²)
//! ```
//!
//! so that K = 1/F. In the continuum, η = 0, ∫ r W′ dV = −D and the mean of n_a²n_b² over the sphere leave F = 1/(2(D + 2)) for
//! n ⊥ t and three times that for n = t, whatever the kernel: K = 2 (D + 2), which is 8 in 2-D (model C) and ξ = D + 2.
//! Model E gives −Σ V (n·r)² W′/r, the component of B⁻¹ along n. Models A and B follow from their texts in
//! [`ViscousModel::bare`]; what B makes of a quadratic flow is S n·S n + (t·S n)²/3 with S = B⁻¹, if the sites are centres of
//! inversion.

use crate::exact::{MultiIndex, Rational, int, rational_to_f64};
use crate::kernel::{Evaluator, Kernel, SummandTerm, sphere_monomial};
use crate::language::{FlowDirection, ViscousModel};
use crate::particles::{Lattice, PointGroup, VolumeRule};

/// η²/h² of Eqs. (32) to (34), and what Chaussonnet et al. call θ.
const ETA_SQUARED: f64 = 0.01;
/// Steps of Simpson's rule between two knots.
const STEPS: usize = 4000;
/// Fractional bits of continuum limits of kernels that are not polynomial.
const BITS: u32 = 96;

/// The bare sum of a model on a flow in the continuum limit, h → 0 after Δ/h → 0. Exact up to rounding without η, by
/// Simpson's rule with it.
pub fn continuum_response(
    model: ViscousModel,
    kernel: &Kernel,
    dimension: usize,
    direction: FlowDirection,
    regularised: bool,
) -> f64 {
    if !model.is_central() {
        return model.target(direction);
    }
    let mean = sphere_monomial(dimension, &fourth(direction));
    let radial = if regularised {
        regularised_moment(kernel, dimension)
    } else {
        -second_moment(kernel, dimension)
    };
    0.5 * rational_to_f64(&mean) * radial
}

/// The exact K in the continuum without η: 2 (D + 2) for shear, a third of it for compression.
pub fn continuum_constant(dimension: usize, direction: FlowDirection) -> Rational {
    int(2) / sphere_monomial(dimension, &fourth(direction)) / int(dimension as i64)
}

/// What multiplies ∂²u/∂x², ∂²u/∂y² and ∂²v/∂x∂y in the first component of ∇·τ over μ, for τ = μ (∇u + ∇uᵀ) + c μ (∇·u) I:
/// 2 + c, 1 and 1 + c.
pub fn stress_divergence(c: &Rational) -> [Rational; 3] {
    [int(2) + c, int(1), int(1) + c]
}

/// n_x² n_y², or n_x⁴: shear along the diagonal is shear, turned.
fn fourth(direction: FlowDirection) -> MultiIndex {
    let powers = match direction {
        FlowDirection::Compression => [4, 0, 0],
        _ => [2, 2, 0],
    };
    MultiIndex { powers }
}

/// ∫ r W′ dV = Σ_a ∫ x_a² W′/r dV: −D for a polynomial kernel, less the mass beyond the cut for others.
fn second_moment(kernel: &Kernel, dimension: usize) -> f64 {
    let squares = (0..dimension).map(|axis| {
        let mut powers = [0; 3];
        powers[axis] = 2;
        SummandTerm { coefficient: 1, monomial: MultiIndex { powers }, radial: 1 }
    });
    let terms: Vec<SummandTerm> = squares.collect();
    kernel.continuum_limit(dimension, &terms, BITS).to_f64()
}

/// −∫ r³ W′/(r² + η²) dV.
fn regularised_moment(kernel: &Kernel, dimension: usize) -> f64 {
    let support = rational_to_f64(kernel.support_over_h());
    let eta = ETA_SQUARED / (support * support);
    let evaluator = Evaluator::<f64>::new(kernel, dimension, 1);
    let surface = [2.0, 2.0 * std::f64::consts::PI, 4.0 * std::f64::consts::PI][dimension - 1];
    let value = |x: f64| {
        // x^{D-1} · x³ · W′ with W′ = x G_1; the last point of an interval belongs to it.
        let inside = x.min(1.0 - f64::EPSILON);
        let weight = (0..dimension + 3).fold(1.0, |power, _| power * x);
        -weight * evaluator.radial(inside)[1] / (x * x + eta)
    };
    let mut knots: Vec<f64> = match kernel.polynomial() {
        Some(profile) => profile.knots().iter().map(|knot| rational_to_f64(knot) / support).collect(),
        None => vec![0.0, 1.0],
    };
    // The pole at ± iη calls for short steps near the origin.
    knots.extend([0.5, 1.0, 2.0, 4.0].map(|multiple: f64| multiple * eta.sqrt()));
    knots.retain(|knot| *knot <= 1.0);
    knots.sort_by(f64::total_cmp);
    let pieces = knots.windows(2).map(|ends| simpson(&value, ends[0], ends[1]));
    surface * pieces.sum::<f64>()
}

fn simpson(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let step = (to - from) / STEPS as f64;
    let inner = (1..STEPS).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * f(from + k as f64 * step));
    // Just inside both ends: the kernel may be another polynomial beyond them.
    let inside = 1e-12 * (to - from);
    (f(from + inside) + inner.sum::<f64>() + f(to - inside)) * step / 3.0
}

/// The bare sum of a model on a flow, at a site of a lattice.
///
/// `None` for model B where sites are no centres of inversion: its second pass then sees what the first adds to a linear
/// function.
pub fn lattice_response(
    model: ViscousModel,
    kernel: &Kernel,
    lattice: &Lattice,
    support_over_dx: f64,
    rule: VolumeRule,
    direction: FlowDirection,
    regularised: bool,
) -> Option<f64> {
    if model == ViscousModel::B && !(lattice.basis().len() == 1 || PointGroup::of(lattice).has_inversion()) {
        return None;
    }
    let pairs = Pairs::of(kernel, lattice, support_over_dx, rule);
    let d = lattice.dimension() as f64;
    let [n, t] = direction.vectors();
    let eta = if regularised { pairs.h * pairs.h * ETA_SQUARED } else { 0.0 };
    Some(match model {
        ViscousModel::A => pairs.sum(|r, [_, g1, g2]| {
            let laplacian = d * g1 + dot(r, r) * g2;
            let along = g1 + dot(&t, r) * dot(&t, r) * g2;
            0.5 * dot(&n, r) * dot(&n, r) * (laplacian + along / 3.0)
        }),
        ViscousModel::B => {
            let s_n: [f64; 3] = std::array::from_fn(|a| pairs.sum(|r, [_, g1, _]| -r[a] * dot(&n, r) * g1));
            dot(&s_n, &s_n) + dot(&t, &s_n) * dot(&t, &s_n) / 3.0
        }
        ViscousModel::E => pairs.sum(|r, [_, g1, _]| -dot(&n, r) * dot(&n, r) * g1),
        ViscousModel::C | ViscousModel::D | ViscousModel::Mcg => pairs.sum(|r, [_, g1, _]| {
            let product = dot(&n, r) * dot(&t, r);
            let square = dot(r, r);
            if square == 0.0 { 0.0 } else { -0.5 * product * product * g1 / (square + eta) }
        }),
    })
}

/// Σ_j V_j ∂²W/∂x² at a site, in units of Δ: what a direct second derivative makes of u = 1.
pub fn second_derivative_of_one(
    kernel: &Kernel,
    lattice: &Lattice,
    support_over_dx: f64,
    rule: VolumeRule,
) -> f64 {
    Pairs::of(kernel, lattice, support_over_dx, rule).sum(|r, [_, g1, g2]| g1 + r[0] * r[0] * g2)
}

/// The neighbours of a site, itself among them, lengths in Δ.
struct Pairs {
    of: Vec<([f64; 3], [f64; 3])>,
    volume: f64,
    h: f64,
}

impl Pairs {
    fn of(kernel: &Kernel, lattice: &Lattice, support: f64, rule: VolumeRule) -> Self {
        let dimension = lattice.dimension();
        let evaluator = Evaluator::<f64>::new(kernel, dimension, 2);
        let scale = (0..dimension).fold(1.0, |scale, _| scale / support);
        let per_square = 1.0 / (support * support);
        let sites = lattice.sites_within(support).into_iter().map(|site| site.position);
        let pairs = sites.filter(|r| dot(r, r) < support * support).map(|r| {
            let g = evaluator.radial(dot(&r, &r).sqrt() / support);
            (r, [g[0] * scale, g[1] * scale * per_square, g[2] * scale * per_square * per_square])
        });
        let of: Vec<([f64; 3], [f64; 3])> = pairs.collect();
        let volume = match rule {
            VolumeRule::Constant => lattice.particle_volume().enclose(96).midpoint_f64(),
            VolumeRule::NumberDensity => 1.0 / of.iter().map(|(_, g)| g[0]).sum::<f64>(),
        };
        Self { of, volume, h: support / rational_to_f64(kernel.support_over_h()) }
    }

    fn sum(&self, summand: impl Fn(&[f64; 3], [f64; 3]) -> f64) -> f64 {
        self.volume * self.of.iter().map(|(r, g)| summand(r, *g)).sum::<f64>()
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
