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
//! [`ViscousModel::bare`]; what B makes of a quadratic flow is S n·S n + (t·S n)²/3 with S = B⁻¹ if the sites are centres of
//! inversion, and more if they are not.

use crate::exact::{MultiIndex, Rational, int, rational_to_f64};
use crate::kernel::{Evaluator, Kernel, SummandTerm, sphere_monomial};
use crate::language::{FlowDirection, ViscousModel};
use crate::particles::{Lattice, Site, SiteIndex, VolumeRule};

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
    let radial =
        if regularised { regularised_moment(kernel, dimension) } else { -second_moment(kernel, dimension) };
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

/// The bare sum of a model on a flow, at a site of a lattice: [`LatticeFlow`] for one question.
pub fn lattice_response(
    model: ViscousModel,
    kernel: &Kernel,
    lattice: &Lattice,
    support_over_dx: f64,
    rule: VolumeRule,
    direction: FlowDirection,
    regularised: bool,
) -> f64 {
    LatticeFlow::new(kernel, lattice, support_over_dx, rule).response(model, direction, regularised)
}

/// Σ_j V_j ∂²W/∂x² at a site, in units of Δ: what a direct second derivative makes of u = 1.
pub fn second_derivative_of_one(
    kernel: &Kernel,
    lattice: &Lattice,
    support_over_dx: f64,
    rule: VolumeRule,
) -> f64 {
    LatticeFlow::new(kernel, lattice, support_over_dx, rule)
        .sum(|pair| pair.g[1] + pair.r[0] * pair.r[0] * pair.g[2])
}

/// A pair of sites, lengths in Δ.
struct Pair {
    /// r_ij.
    r: [f64; 3],
    /// W, W′/r, (W′/r)′/r.
    g: [f64; 3],
    /// Which particle of its cell j is.
    basis: usize,
}

/// The neighbours of each particle of a lattice's cell, itself among them, ready for every model and flow.
pub struct LatticeFlow {
    dimension: usize,
    /// By particle of the cell.
    pairs: Vec<Vec<Pair>>,
    volume: f64,
    h: f64,
}

impl LatticeFlow {
    /// At this R/Δ.
    pub fn new(kernel: &Kernel, lattice: &Lattice, support: f64, rule: VolumeRule) -> Self {
        let dimension = lattice.dimension();
        let evaluator = Evaluator::<f64>::new(kernel, dimension, 2);
        let scale = (0..dimension).fold(1.0, |scale, _| scale / support);
        let per_square = 1.0 / (support * support);
        let units = lattice.axis_units();
        let around = |k: &SiteIndex| -> Vec<Pair> {
            let own: [f64; 3] = std::array::from_fn(|a| k[a] as f64 * units[a]);
            let sites = lattice.sites_within(support + dot(&own, &own).sqrt()).into_iter();
            let pair = |site: Site| {
                let r: [f64; 3] = std::array::from_fn(|a| own[a] - site.position[a]);
                let square = dot(&r, &r);
                (square < support * support).then(|| {
                    let g = evaluator.radial(square.sqrt() / support);
                    let g = [g[0] * scale, g[1] * scale * per_square, g[2] * scale * per_square * per_square];
                    Pair { r, g, basis: site.basis }
                })
            };
            sites.filter_map(pair).collect()
        };
        let pairs: Vec<Vec<Pair>> = lattice.basis().iter().map(around).collect();
        let volume = match rule {
            VolumeRule::Constant => lattice.particle_volume().enclose(96).midpoint_f64(),
            VolumeRule::NumberDensity => 1.0 / pairs[0].iter().map(|pair| pair.g[0]).sum::<f64>(),
        };
        Self { dimension, pairs, volume, h: support / rational_to_f64(kernel.support_over_h()) }
    }

    /// ⟨L v⟩·t of the bare sum of a model on v = t (n·r)²/2 about the first particle.
    pub fn response(&self, model: ViscousModel, direction: FlowDirection, regularised: bool) -> f64 {
        let d = self.dimension as f64;
        let [n, t] = direction.vectors();
        let eta = if regularised { self.h * self.h * ETA_SQUARED } else { 0.0 };
        match model {
            ViscousModel::A => self.sum(|Pair { r, g: [_, g1, g2], .. }| {
                let laplacian = d * g1 + dot(r, r) * g2;
                let along = g1 + dot(&t, r) * dot(&t, r) * g2;
                0.5 * dot(&n, r) * dot(&n, r) * (laplacian + along / 3.0)
            }),
            ViscousModel::B => self.two_passes(&n, &t),
            ViscousModel::E => self.sum(|Pair { r, g, .. }| -dot(&n, r) * dot(&n, r) * g[1]),
            ViscousModel::C | ViscousModel::D | ViscousModel::Mcg => self.sum(|Pair { r, g, .. }| {
                let product = dot(&n, r) * dot(&t, r);
                let square = dot(r, r);
                if square == 0.0 { 0.0 } else { -0.5 * product * product * g[1] / (square + eta) }
            }),
        }
    }

    /// The first pass at x_j leaves t ⊗ q with q = ½(n·x_j)² Σ V ∇W + (n·x_j) S n + ½ Σ V (n·r)² ∇W, the sums about j; the
    /// second Σ V [q·∇W + (t·q)(t·∇W)/3]. With inversion q is (n·x_j) S n and the whole S n·S n + (t·S n)²/3.
    fn two_passes(&self, n: &[f64; 3], t: &[f64; 3]) -> f64 {
        // By particle of the cell: Σ V ∇W, S n, Σ V (n·r)² ∇W.
        let about = |pairs: &Vec<Pair>| -> [[f64; 3]; 3] {
            let moment = |weight: &dyn Fn(f64) -> f64| {
                std::array::from_fn(|a| {
                    self.volume
                        * pairs.iter().map(|Pair { r, g, .. }| weight(dot(n, r)) * r[a] * g[1]).sum::<f64>()
                })
            };
            [moment(&|_| 1.0), moment(&|x| -x), moment(&|x| x * x)]
        };
        let sums: Vec<[[f64; 3]; 3]> = self.pairs.iter().map(about).collect();
        self.sum(|Pair { r, g, basis }| {
            // x_j = −r_ij.
            let x = -dot(n, r);
            let [zeroth, first, second] = &sums[*basis];
            let q: [f64; 3] =
                std::array::from_fn(|a| 0.5 * x * x * zeroth[a] + x * first[a] + 0.5 * second[a]);
            g[1] * (dot(&q, r) + dot(t, &q) * dot(t, r) / 3.0)
        })
    }

    fn sum(&self, summand: impl Fn(&Pair) -> f64) -> f64 {
        self.volume * self.pairs[0].iter().map(summand).sum::<f64>()
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
