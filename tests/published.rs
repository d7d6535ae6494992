//! Published truths: constants, counts and limits that stand in print or follow in a few lines from what does.
//!
//! No reference value here comes from this crate. Constants are typed from the source named beside them; integrals are
//! Euler's ∫₀ᵃ (a − q)ⁿ qᵇ dq = n! b! aⁿ⁺ᵇ⁺¹/(n + b + 1)!, which shares nothing with the polynomials of `exact`; slopes are
//! derived in the comment above the test. Planted errors that were seen to fail are named there too.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use num_traits::{One, Zero};
use remainder::exact::{Coefficient, MultiIndex, Radical, Rational, int, ratio, rational_to_f64};
use remainder::kernel::{self, Kernel};
use remainder::language::Subject;
use remainder::measured::window::{LadderPoint, PowerLaw, WindowOptions, power_law};
use remainder::measured::{RegularNorm, RegularRung, RegularSpec, regular_rung};
use remainder::particles::{PointGroup, VolumeRule, lattice_by_id};
use remainder::sums::{LatticeSums, Moment};

/// Memory allowed to lattice sums here.
const MEMORY_MIB: u64 = 64;

/// c · π^k.
fn with_pi(c: Rational, k: i32) -> Radical {
    Radical::pi_power(k).scale(&c)
}

fn kernel(id: &str) -> Kernel {
    kernel::by_id(id).unwrap()
}

fn moment(name: &str) -> Moment {
    Moment::by_name(name).unwrap()
}

fn power(base: &Rational, exponent: u32) -> Rational {
    (0..exponent).fold(Rational::one(), |product, _| product * base)
}

fn factorial(n: u32) -> Rational {
    (1..=i64::from(n)).map(int).product()
}

// ------------------------------------------------------------------------------------------------- profiles as printed

/// A profile as its source prints it: Σ c (a − q)₊ⁿ qᵉ.
struct Printed {
    id: &'static str,
    /// (c, a, n, e)
    terms: Vec<(Rational, i64, u32, u32)>,
}

impl Printed {
    /// ∫ w(q) qᵇ dq over the support, from Euler's integral.
    fn integral(&self, b: u32) -> Rational {
        let euler = |a: i64, n: u32, b: u32| {
            factorial(n) * factorial(b) / factorial(n + b + 1) * power(&int(a), n + b + 1)
        };
        self.terms.iter().map(|(c, a, n, e)| c * euler(*a, *n, b + e)).sum()
    }

    fn value(&self, q: &Rational) -> Rational {
        let truncated = |a: i64, n: u32| {
            let base = int(a) - q;
            if base > Rational::zero() { power(&base, n) } else { Rational::zero() }
        };
        self.terms.iter().map(|(c, a, n, e)| c * truncated(*a, *n) * power(q, *e)).sum()
    }
}

/// Wendland C2: Fatehi & Manzari 2011, Eq. (47). C4: Dehnen & Aly 2012, Table 1. Splines: Schoenberg 1946, the form with
/// truncated powers (Monaghan 1992 and Morris 1996 in SPH).
fn printed() -> Vec<Printed> {
    vec![
        Printed { id: "wendland-c2", terms: vec![(int(1), 1, 4, 0), (int(4), 1, 4, 1)] },
        Printed {
            id: "wendland-c4",
            terms: vec![(int(1), 1, 6, 0), (int(6), 1, 6, 1), (ratio(35, 3), 1, 6, 2)],
        },
        Printed { id: "cubic-spline", terms: vec![(int(1), 2, 3, 0), (int(-4), 1, 3, 0)] },
        Printed {
            id: "quintic-spline",
            terms: vec![(int(1), 3, 5, 0), (int(-6), 2, 5, 0), (int(15), 1, 5, 0)],
        },
    ]
}

/// Guards `kernel::{wendland, bspline}` against `printed`. Fails with 6 for 35/3 in Wendland C4, or with (order − k − 1) for
/// (order − k) in the binomials of the splines.
#[test]
fn the_profiles_are_those_printed() {
    for printed in printed() {
        let kernel = kernel(printed.id);
        // More points than a polynomial of degree 8 needs on every piece, and beyond the support.
        for n in 0..=70 {
            let q = ratio(n, 20);
            assert_eq!(
                kernel.polynomial().unwrap().evaluate(&q),
                printed.value(&q),
                "{} at q = {q}",
                printed.id
            );
        }
    }
}

/// Guards `Kernel::normalisation` against Euler's integral: σ_D S_D ∫ w q^{D−1} dq = 1, with nothing left of π.
/// Fails with S₂ = π for 2π.
#[test]
fn kernels_integrate_to_one_exactly() {
    let sphere = [with_pi(int(2), 0), with_pi(int(2), 1), with_pi(int(4), 1)];
    for printed in printed() {
        for (dimension, surface) in (1_u32..=3).zip(&sphere) {
            let sigma = kernel(printed.id).normalisation(dimension as usize).unwrap();
            let integral = &sigma * &surface.scale(&printed.integral(dimension - 1));
            assert_eq!(integral, Radical::one(), "{} in {dimension}-D", printed.id);
        }
    }
}

/// The factors in front of W as they are printed. The profile of the cubic spline is four times that of Monaghan &
/// Lattanzio (1 − 3/2 q² + 3/4 q³ starts at 1, (2 − q)³ − 4 (1 − q)³ at 4), so that its factor is a quarter of theirs.
/// Fails with S₂ = π for 2π, and with 6 for 35/3 in Wendland C4.
#[test]
fn normalisations_are_those_printed() {
    let table = [
        // Fatehi & Manzari 2011, Eq. (47); Dehnen & Aly 2012, Table 1.
        ("wendland-c2", 2, with_pi(int(7), -1)),
        ("wendland-c2", 3, with_pi(ratio(21, 2), -1)),
        ("wendland-c4", 2, with_pi(int(9), -1)),
        ("wendland-c4", 3, with_pi(ratio(495, 32), -1)),
        // Monaghan & Lattanzio 1985: 2/3, 10/(7π), 1/π, each over 4.
        ("cubic-spline", 1, with_pi(ratio(2, 3) / int(4), 0)),
        ("cubic-spline", 2, with_pi(ratio(10, 7) / int(4), -1)),
        ("cubic-spline", 3, with_pi(int(1) / int(4), -1)),
        // Morris 1996: 1/120, 7/(478π), 1/(120π).
        ("quintic-spline", 1, with_pi(ratio(1, 120), 0)),
        ("quintic-spline", 2, with_pi(ratio(7, 478), -1)),
        ("quintic-spline", 3, with_pi(ratio(1, 120), -1)),
    ];
    for (id, dimension, sigma) in table {
        assert_eq!(kernel(id).normalisation(dimension).unwrap(), sigma, "{id} in {dimension}-D");
    }
    // The quarter above is the ratio of the two forms of the cubic spline.
    for q in [ratio(0, 1), ratio(1, 2), ratio(6, 7)] {
        let printed = int(1) - ratio(3, 2) * power(&q, 2) + ratio(3, 4) * power(&q, 3);
        assert_eq!(kernel("cubic-spline").polynomial().unwrap().evaluate(&q), int(4) * printed);
    }
    for q in [ratio(1, 1), ratio(3, 2), ratio(2, 1)] {
        let printed = ratio(1, 4) * power(&(int(2) - &q), 3);
        assert_eq!(kernel("cubic-spline").polynomial().unwrap().evaluate(&q), int(4) * printed);
    }
}

/// 3/(359π) is widely copied for the quintic spline in 3-D, where 3/(360π) = 1/(120π) is right. An integral that is off by
/// one part in 360 must not pass for 1.
#[test]
fn the_misprint_359_does_not_pass() {
    let quintic = printed().into_iter().find(|printed| printed.id == "quintic-spline").unwrap();
    let misprint = with_pi(ratio(3, 359), -1);
    assert_ne!(kernel("quintic-spline").normalisation(3).unwrap(), misprint);
    let integral = &misprint * &with_pi(int(4) * quintic.integral(2), 1);
    assert_eq!(integral, Radical::from(ratio(360, 359)));
}

/// β of Wendland C2 is 3 in print (Fatehi & Manzari 2011, below Eq. 47). (1 − q)⁶ · … and truncated powers of degree n leave
/// 5 and n − 1. The origin: the first odd power of (1 − q)⁴(1 + 4q) = 1 − 10q² + 20q³ − …, of the C4 form q⁵ by
/// construction (C⁴ in space), of a spline of degree n its qⁿ. Fails with jump_order for jump_order − 1 in `Kernel::beta`.
#[test]
fn smoothness_at_the_edge_and_at_the_origin() {
    for (id, beta, first_odd) in
        [("wendland-c2", 3, 3), ("wendland-c4", 5, 5), ("cubic-spline", 2, 3), ("quintic-spline", 4, 5)]
    {
        assert_eq!(kernel(id).beta(), beta, "β of {id}");
        assert_eq!(kernel(id).first_odd_power(), Some(first_odd), "first odd power of {id}");
    }
    for (id, degree, knots) in [("cubic-spline", 3, 2), ("quintic-spline", 5, 3)] {
        let jumps = kernel(id).jumps();
        assert_eq!(jumps.len(), knots, "{id}");
        for (jump, at) in jumps.iter().zip(1..) {
            assert_eq!((&jump.at, jump.order), (&int(at), Some(degree)), "{id}");
        }
    }
}

// ------------------------------------------------------------------------------------------------------ counted particles

/// 29, 37 and 123 particles, i included, at R = 3h, h = 1.05 Δx (Chaussonnet et al. 2015, §II.A, §II.B); 8 without i at
/// R = h = 1.5 Δ on the square lattice (Fatehi & Manzari 2011, §6.1).
/// Fails if `Shells::within` drops the last shell.
#[test]
fn particles_in_the_support() {
    let cases = [
        ("square", ratio(315, 100), 29),
        ("hexagonal", ratio(315, 100), 37),
        ("simple-cubic", ratio(315, 100), 123),
        ("square", ratio(3, 2), 9),
    ];
    for (id, support, in_support) in cases {
        let lattice = lattice_by_id(id).unwrap();
        let sums =
            LatticeSums::new(&kernel("quintic-spline"), &lattice, &support, &[Moment::default()], MEMORY_MIB);
        let count = sums.unwrap().count(&support).unwrap();
        assert_eq!(
            (count.in_support, count.neighbours),
            (in_support, in_support - 1),
            "{id} at R/Δ = {support}"
        );
        assert_eq!(lattice.sites_within(rational_to_f64(&support)).len() as u64, in_support, "{id}");
    }
}

// ------------------------------------------------------------------------------------------------------ continuum limits

/// Limits for Δ/h → 0, by parts over the whole space where W has compact support, and ∫W = 1:
/// −∫ r_a ∂_b W = δ_ab; ∫ r_a r_b ∇²W = ∫ W ∇²(r_a r_b) = 2δ_ab; ∫ ∂_a∂_b W = 0 and ∫ ∂_a W = 0;
/// ∫ r_a r_b r_c ∂_d W = −M (δ_ad δ_bc + δ_bd δ_ac + δ_cd δ_ab) with M = ∫ r_x² W = ∫w q^{D+1} / (D ∫w q^{D−1}), in h².
/// The limits B⁻¹ → I and Σω r r ∇·∇W → 2I are those of Fatehi & Manzari 2011, Eqs. (33), (35).
/// Guards `kernel::continuum` against Euler's integral. Fails with (D + step) for (D + 2·step) in `sphere_monomial`,
/// with the sign of B⁻¹ turned, and without the δ_ab of ∇∇W.
#[test]
fn continuum_limits() {
    let delta = |a: usize, b: usize| int(i64::from(a == b));
    for printed in printed() {
        let kernel = kernel(printed.id);
        for dimension in 1_u32..=3 {
            let second =
                printed.integral(dimension + 1) / (int(dimension.into()) * printed.integral(dimension - 1));
            let expected = |name: &str, i: &[usize]| match name {
                "sum_w" => int(1),
                "sum_rw" | "sum_dw" | "sum_ddw" | "sum_lapw" | "sum_rlapw" | "sum_rddw" => int(0),
                "sum_rrw" => &second * delta(i[0], i[1]),
                "b_inverse" => delta(i[0], i[1]),
                "sum_rrlapw" => int(2) * delta(i[0], i[1]),
                "sum_rrrdw" => {
                    -&second
                        * (delta(i[0], i[3]) * delta(i[1], i[2])
                            + delta(i[1], i[3]) * delta(i[0], i[2])
                            + delta(i[2], i[3]) * delta(i[0], i[1]))
                }
                _ => unreachable!("no limit derived for {name}"),
            };
            for name in [
                "sum_w",
                "sum_rw",
                "sum_rrw",
                "sum_dw",
                "b_inverse",
                "sum_rrrdw",
                "sum_ddw",
                "sum_rddw",
                "sum_lapw",
                "sum_rlapw",
                "sum_rrlapw",
            ] {
                for component in moment(name).components(dimension as usize) {
                    let indices: Vec<usize> = component.name.bytes().map(|b| usize::from(b - b'x')).collect();
                    let limit = kernel.continuum_limit(dimension as usize, &component.terms, 64);
                    let place = format!("{} {name} {} in {dimension}-D", printed.id, component.name);
                    assert_eq!(limit, Coefficient::Exact(expected(name, &indices)), "{place}");
                }
            }
        }
    }
    // Means over the circle and the sphere that every handbook has: ⟨n_x²⟩ = 1/D, ⟨n_x⁴⟩ = 3/8 and 1/5, ⟨n_x²n_y²⟩ = 1/8 and 1/15.
    let mean = |dimension, powers| kernel::sphere_monomial(dimension, &MultiIndex::new(powers));
    assert_eq!([2, 3].map(|d| mean(d, [2, 0, 0])), [ratio(1, 2), ratio(1, 3)]);
    assert_eq!([2, 3].map(|d| mean(d, [4, 0, 0])), [ratio(3, 8), ratio(1, 5)]);
    assert_eq!([2, 3].map(|d| mean(d, [2, 2, 0])), [ratio(1, 8), ratio(1, 15)]);
    assert_eq!(mean(3, [2, 1, 0]), int(0));
}

// --------------------------------------------------------------------------------------------------------- 1-D envelopes

/// R/Δ of the rungs: even, so that all have the same phases, also in h/Δ when R = 2h.
const RUNGS: [i64; 9] = [32, 48, 64, 96, 128, 192, 256, 384, 512];
/// R/Δ runs over rung + n/8 for n = 0 … 15: two spacings, half-integers included, and h/Δ a whole one when R = 2h.
const OFFSETS: i64 = 16;

/// The moments whose slopes are derived below, with p and q.
const ENVELOPES: [(&str, u32, u32); 3] = [("sum_w", 0, 0), ("b_inverse", 1, 1), ("sum_lapw", 0, 2)];

struct Envelope {
    rungs: Vec<RegularRung>,
}

impl Envelope {
    /// Regular sums of one kernel on the line.
    fn of(id: &str) -> Self {
        let lattice = lattice_by_id("line").unwrap();
        let group = PointGroup::of(&lattice);
        let rung = |rung: &i64| {
            let spec = RegularSpec {
                kernel: kernel(id),
                lattice: lattice.clone(),
                rule: VolumeRule::Constant,
                subjects: ENVELOPES.iter().map(|(name, _, _)| Subject::Moment(moment(name))).collect(),
                supports: (0..OFFSETS).map(|n| ratio(8 * rung + n, 8)).collect(),
                memory_mib: MEMORY_MIB,
            };
            regular_rung(&spec, &group).unwrap()
        };
        Self { rungs: RUNGS.iter().map(rung).collect() }
    }

    /// Each rung's largest deviation of one moment, with the R/Δ where it is reached.
    fn maxima(&self, index: usize) -> impl Iterator<Item = (f64, RegularNorm)> {
        self.rungs.iter().map(move |rung| {
            let norms =
                rung.supports.iter().zip(&rung.norms).map(|(support, norms)| (*support, norms[index]));
            norms.max_by(|a, b| a.1.deviation.total_cmp(&b.1.deviation)).unwrap()
        })
    }

    fn law(&self, index: usize) -> PowerLaw {
        let point = |(support, norm): (f64, RegularNorm)| LadderPoint {
            x: 1.0 / support,
            y: norm.deviation,
            relative_error: None,
            floor: norm.radius,
        };
        let points: Vec<_> = self.maxima(index).map(point).collect();
        power_law(&points, &WindowOptions::default()).unwrap()
    }
}

/// On the line Poisson's formula gives the error of a sum over j of f((i − j)Δ) exactly: Σ_{m≠0} f̂(2πm/Δ), f̂ the Fourier
/// transform. For large wave numbers k, f̂ is what the points make of it where f is not smooth: a jump in the n-th derivative
/// gives a term J k^{−n−1}, and |r|^n with odd n counts as such a jump at r = 0. With f = r^p W^{(q)}:
///
/// - the origin, where w has its first odd power s: n = s + p − q, error ∝ (Δ/h)^{s+p−q+1};
/// - a knot or R, where the m-th derivative of w jumps (m = β + 1 at R): n = m − q, error ∝ (Δ/h)^{m−q+1}. Its phase turns with
///   R/Δ, the origin's does not; hence the envelope.
///
/// The slope is the smaller of the two.
///
/// | kernel | s | m | ΣωW: p = q = 0 | B⁻¹: p = q = 1 | Σω∇²W: p = 0, q = 2 |
/// |---|---|---|---|---|---|
/// | Wendland C2 | 3 | 4 | min(4, 5) = 4 | min(4, 4) = 4 | min(2, 3) = 2 |
/// | Wendland C4 | 5 | 6 | 6 | 6 | 4 |
/// | cubic spline | 3 | 3 | min(4, 4) = 4 | min(4, 3) = 3 | min(2, 2) = 2 |
/// | quintic spline | 5 | 5 | 6 | 5 | 4 |
///
/// So for odd β they are β + 1, β + 1, β − 1 (Fatehi & Manzari 2011, Eqs. 28–33), and even β costs B⁻¹ one order.
/// The neglected terms are smaller by Δ/R, at most 1/32: they can tilt a line over four octaves by a few hundredths, and
/// 0.1 tells neighbouring whole numbers apart by far.
/// Guards `LatticeSums::enclose`, `regular_rung` and `power_law` against this derivation. Fails if `regular_rung` scales by
/// h^{+(p−q)}, with D − 1 for D in ∇·∇W, or with ω twice too large.
#[test]
fn one_dimensional_envelope_slopes() {
    for (id, s, m) in
        [("wendland-c2", 3, 4), ("wendland-c4", 5, 6), ("cubic-spline", 3, 3), ("quintic-spline", 5, 5)]
    {
        let envelope = Envelope::of(id);
        for (index, (name, p, q)) in ENVELOPES.into_iter().enumerate() {
            let derived = f64::from((s + p - q + 1).min(m - q + 1));
            let law = envelope.law(index);
            let slope = law.slope.value;
            assert!((slope - derived).abs() < 0.1, "{id} {name}: slope {slope}, derived {derived}");
            assert!(law.settled() && law.left_out.is_empty(), "{id} {name}: {:?}", law.left_out);
        }
    }
    // The table again, so that a slip in the formula shows.
    let slopes = |s: u32, m: u32| ENVELOPES.map(|(_, p, q)| (s + p - q + 1).min(m - q + 1));
    assert_eq!([slopes(3, 4), slopes(5, 6)], [[4, 4, 2], [6, 6, 4]]);
    assert_eq!([slopes(3, 3), slopes(5, 5)], [[4, 3, 2], [6, 5, 4]]);
}

/// The same derivation gives the prefactor where the origin alone leads. Wendland C2 on the line is W = 3/2 (1 − 10x² + 20|x|³ − …)/R with
/// x = r/R, and |x|³ transforms to 12/k⁴, so that Ŵ ≈ 360/k⁴ and
/// ΣωW − 1 → 2 Σ_m 360 (2πm R/Δ)^{−4} = 720 ζ(4)/(2π)⁴ (Δ/R)⁴ = 1/2 (Δ/R)⁴;
/// R² Σω∇²W → −2 Σ_m 360 (2πm R/Δ)^{−2} = −720 ζ(2)/(2π)² (Δ/R)² = −30 (Δ/R)².
/// The next term comes from R and has one more power of Δ/R; at R/Δ ≥ 512 its share is less than 2 %.
/// Fails if `regular_rung` scales by h^{+(p−q)}, with D − 1 for D in ∇·∇W, or with ω twice too large.
#[test]
fn one_dimensional_prefactors() {
    let envelope = Envelope::of("wendland-c2");
    for (index, power, prefactor) in [(0, 4, 0.5), (2, 2, 30.0)] {
        let (support, norm) = envelope.maxima(index).last().unwrap();
        let found = norm.deviation * support.powi(power);
        assert!((found / prefactor - 1.0).abs() < 0.02, "{}: {found}", ENVELOPES[index].0);
    }
}
