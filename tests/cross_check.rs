//! Two ways to one number. Each test names the two modules it sets against each other and the planted errors that were
//! seen to make it fail.
//!
//! Three ways exist: closed forms (`LatticeSums::exact`), enclosures in fixed point (`LatticeSums::enclose`) and floating
//! point over given pairs (`PairSums`). A fourth stands in this file: W, W′ and W″ of two kernels typed out, and loops.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

use num_traits::Signed;
use remainder::exact::{
    Coefficient, Enclosure, Rational, Truth, int, parse_rational, ratio, rational_to_f64,
};
use remainder::kernel::{self, Evaluator, Kernel};
use remainder::language::Subject;
use remainder::measured::{SampleBlock, SampleSpec, Sampler, summarise};
use remainder::particles::{
    Disorder, Draw, Lattice, Moves, PointGroup, SampleStream, Site, VolumeRule, lattice, lattice_by_id,
};
use remainder::sums::{Component, LatticeSums, Moment, PairSums, Reduction, Standing};

/// Memory allowed to lattice sums here.
const MEMORY_MIB: u64 = 64;

/// The kernels with closed forms.
fn polynomial_kernels() -> impl Iterator<Item = Kernel> {
    kernel::catalogue().into_iter().filter(|kernel| kernel.polynomial().is_some())
}

/// R/Δ: a whole number (sites lie exactly at R), a half-integer, Chaussonnet's 3 · 1.05 and an awkward one.
fn supports() -> [Rational; 4] {
    [int(3), ratio(7, 2), ratio(63, 20), ratio(17, 7)]
}

/// Every moment with p ≤ 4 and q ≤ 2, and the contracted ones.
fn moments() -> Vec<Moment> {
    Moment::all(4)
}

fn moment(name: &str) -> Moment {
    Moment::by_name(name).unwrap()
}

/// Two particles on a cell of three: no symmetry at all.
fn lopsided_line() -> Lattice {
    let squares = [int(1), int(1), int(1)];
    Lattice::new(
        "lopsided",
        "lopsided line",
        1,
        squares,
        [[3, 0, 0], [0; 3], [0; 3]],
        vec![[0; 3], [1, 0, 0]],
    )
    .unwrap()
}

/// Neighbours one Δ apart; a site is no centre of inversion, but an axis of order three.
fn honeycomb() -> Lattice {
    let squares = [ratio(3, 4), ratio(1, 4), int(1)];
    Lattice::new(
        "honeycomb",
        "honeycomb",
        2,
        squares,
        [[2, 0, 0], [1, 3, 0], [0; 3]],
        vec![[0; 3], [1, 1, 0]],
    )
    .unwrap()
}

fn all_lattices() -> Vec<Lattice> {
    lattice::catalogue().into_iter().chain([lopsided_line(), honeycomb()]).collect()
}

fn components(moments: &[Moment], dimension: usize) -> Vec<(Moment, Component)> {
    moments.iter().flat_map(|m| m.components(dimension).into_iter().map(move |c| (*m, c))).collect()
}

fn lattice_sums(kernel: &Kernel, lattice: &Lattice, moments: &[Moment]) -> LatticeSums {
    let largest = supports().into_iter().max().unwrap();
    LatticeSums::new(kernel, lattice, &largest, moments, MEMORY_MIB).unwrap()
}

fn label(
    kernel: &Kernel,
    lattice: &Lattice,
    support: &Rational,
    moment: Moment,
    component: &Component,
) -> String {
    format!("{}/{}/R = {support}/{moment}/{}", kernel.id(), lattice.id(), component.name)
}

// ------------------------------------------------------------------------------------------- closed forms and enclosures

/// `LatticeSums::exact` against `LatticeSums::enclose`, which share the shells and the kernel but not the arithmetic.
/// An enclosure must contain the closed form, and be narrow: at most 2⁴⁰ units of its last bit, or it would contain anything.
/// Fails with `ceil() − 1` for `ceil()` in `first_level_beyond`.
#[test]
fn closed_forms_lie_in_the_enclosures() {
    let mut exact_zeros = 0;
    for lattice in all_lattices() {
        // Three dimensions have 385 components: there the two awkward supports have to do.
        let supports: Vec<_> =
            supports().into_iter().skip(if lattice.dimension() == 3 { 2 } else { 0 }).collect();
        let of_moments = components(&moments(), lattice.dimension());
        let components: Vec<Component> = of_moments.iter().map(|(_, c)| c.clone()).collect();
        for kernel in polynomial_kernels() {
            let sums = lattice_sums(&kernel, &lattice, &moments());
            for support in &supports {
                let enclosures: Vec<(u32, Vec<Enclosure>)> = [24, 80, 200]
                    .into_iter()
                    .map(|bits| {
                        (bits, sums.enclose(support, &components, VolumeRule::Constant, bits).unwrap())
                    })
                    .collect();
                for (index, (moment, component)) in of_moments.iter().enumerate() {
                    let exact = sums.exact(support, component, VolumeRule::Constant).unwrap();
                    let place = label(&kernel, &lattice, support, *moment, component);
                    assert!(matches!(exact, Coefficient::Exact(_) | Coefficient::Radical(_)), "{place}");
                    let reference = exact.enclose(400);
                    for (bits, enclosures) in &enclosures {
                        let enclosed = &enclosures[index];
                        assert!(
                            enclosed.overlaps(&reference),
                            "{place} at {bits} bits: {enclosed} and {exact}"
                        );
                        let unit = ratio(1, 2).pow(*bits as i32);
                        assert!(
                            enclosed.radius() <= unit * Rational::from_integer((1_i64 << 40).into()),
                            "{place}"
                        );
                        exact_zeros +=
                            u32::from(enclosed.radius() == int(0) && enclosed.midpoint() == int(0));
                    }
                }
            }
        }
    }
    // Zeros by symmetry are sums of nothing and have radius zero; everything else was rounded.
    assert!(exact_zeros > 0);
}

/// The same for V = 1/ΣW: `Coefficient::quotient` against a division of enclosures.
/// Fails if `exact` keeps the cell's volume in the numerator, or as the test above.
#[test]
fn quotients_lie_in_their_enclosures() {
    let moments = [moment("sum_w"), moment("b_inverse"), moment("sum_rrdw"), moment("sum_lapw")];
    let mut quotients = 0;
    for lattice in all_lattices() {
        for kernel in polynomial_kernels() {
            let sums = lattice_sums(&kernel, &lattice, &moments);
            for support in supports() {
                for (moment, component) in components(&moments, lattice.dimension()) {
                    let place = label(&kernel, &lattice, &support, moment, &component);
                    let exact = sums.exact(&support, &component, VolumeRule::NumberDensity).unwrap();
                    let one = std::slice::from_ref(&component);
                    let enclosed = sums.enclose(&support, one, VolumeRule::NumberDensity, 120).unwrap();
                    assert!(
                        enclosed[0].overlaps(&exact.enclose(300)),
                        "{place}: {} and {exact}",
                        enclosed[0]
                    );
                    quotients += u32::from(matches!(exact, Coefficient::Quotient { .. }));
                    // V = 1/ΣW makes ΣVW = 1, exactly.
                    if moment == Moment::default() {
                        assert_eq!(exact, Coefficient::one(), "{place}");
                    }
                }
            }
        }
    }
    assert!(quotients > 100, "only {quotients} were quotients of radicals");
}

/// An enclosure printed with 30 and with 50 digits contains the number, and says how far off it may be:
/// `Enclosure::decimal` of `LatticeSums::enclose` against the closed form.
/// Fails if `decimal` leaves its own rounding out of the radius.
#[test]
fn printed_digits_are_honest() {
    let lattice = lattice_by_id("hexagonal").unwrap();
    let moments = [moment("sum_w"), moment("sum_rrrdw")];
    for kernel in polynomial_kernels() {
        let sums = lattice_sums(&kernel, &lattice, &moments);
        for (moment, component) in components(&moments, 2) {
            let support = ratio(17, 7);
            let place = label(&kernel, &lattice, &support, moment, &component);
            let exact = sums.exact(&support, &component, VolumeRule::Constant).unwrap().enclose(400);
            let one = std::slice::from_ref(&component);
            for (digits, bits) in [(30, 128), (50, 196)] {
                let enclosed = &sums.enclose(&support, one, VolumeRule::Constant, bits).unwrap()[0];
                let (middle, radius) = enclosed.decimal(digits);
                let (middle, radius) = (parse_rational(&middle).unwrap(), parse_rational(&radius).unwrap());
                assert!(
                    (exact.midpoint() - &middle).abs() <= &radius - exact.radius(),
                    "{place}: {middle} ± {radius}"
                );
                // Half a unit of the last digit is lost in print, little more.
                assert!(radius <= ratio(1, 10).pow(digits as i32), "{place}: ± {radius}");
            }
        }
    }
}

// --------------------------------------------------------------------------------------- closed forms and floating point

/// x = r_ij/R of all sites in the support, from `Lattice::sites_within`.
fn pairs(lattice: &Lattice, support: f64) -> Vec<[f64; 3]> {
    let sites = lattice.sites_within(support);
    sites.iter().map(|site| site.position.map(|x| -x / support)).collect()
}

/// Σ |terms| of a component, in units of R: what rounding is relative to.
fn magnitude(evaluator: &Evaluator<f64>, component: &Component, pairs: &[[f64; 3]], weight: f64) -> f64 {
    let mut sum = 0.0;
    for x in pairs {
        let g = evaluator.evaluate(&[(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt(); 8]).g;
        for term in &component.terms {
            let monomial: f64 = (0..3).map(|a| x[a].powi(term.monomial.powers[a].into())).product();
            sum += (term.coefficient as f64 * monomial * g[term.radial][0] * weight).abs();
        }
    }
    sum
}

/// Sums of up to 200 terms in eight lanes, each term a product of about twenty rounded factors: their errors add to at most
/// (200/8 + 3 + 20) ε Σ|terms| to first order, and near a knot an error of x in the last place counts β-fold.
const ROUNDINGS: f64 = 64.0;

/// `LatticeSums::exact` against `PairSums<f64>` and `PairSums<f32>` over `Lattice::sites_within`.
/// Fails with κ^{2k} for κ^{2k−n} in `Evaluator`, if `PairSums` forgets its last block, and, on the lattices without inversion,
/// if `LatticeSums` takes the position of j for r_ij.
#[test]
fn closed_forms_agree_with_floating_point() {
    for lattice in all_lattices() {
        let d = lattice.dimension();
        let supports: Vec<_> = supports().into_iter().skip(if d == 3 { 2 } else { 0 }).collect();
        let components = components(&moments(), d);
        for kernel in polynomial_kernels() {
            let sums = lattice_sums(&kernel, &lattice, &moments());
            let evaluator = Evaluator::<f64>::new(&kernel, d, 2);
            let double = PairSums::<f64>::new(&kernel, d, &moments());
            let single = PairSums::<f32>::new(&kernel, d, &moments());
            for support in &supports {
                let radius = rational_to_f64(support);
                let weight = lattice.particle_volume().enclose(64).midpoint_f64() / radius.powi(d as i32);
                let pairs = pairs(&lattice, radius);
                let (mut in_double, mut in_single) = (double.start(), single.start());
                for x in &pairs {
                    double.add(&mut in_double, *x, weight);
                    single.add(&mut in_single, x.map(|x| x as f32), weight as f32);
                }
                let (in_double, _) = double.finish(in_double);
                let (in_single, _) = single.finish(in_single);
                for (index, (moment, component)) in components.iter().enumerate() {
                    let place = label(&kernel, &lattice, support, *moment, component);
                    let exact = sums.exact(support, component, VolumeRule::Constant).unwrap().to_f64();
                    let exact = exact * radius.powi(-moment.length_power());
                    let scale = magnitude(&evaluator, component, &pairs, weight);
                    let (double, single) = (in_double[index], f64::from(in_single[index]));
                    let (error, allowed) = ((double - exact).abs(), ROUNDINGS * f64::EPSILON * scale);
                    assert!(error <= allowed, "{place}: {double} and {exact}, off by {error} > {allowed}");
                    let (error, allowed) =
                        ((single - exact).abs(), ROUNDINGS * f64::from(f32::EPSILON) * scale);
                    assert!(error <= allowed, "{place}: {single} and {exact}, off by {error} > {allowed}");
                }
            }
        }
    }
}

// ------------------------------------------------------------------------------------------ formulas typed in this file

/// W, W′ and W″ at distance r ≥ 0 with support R, in D dimensions.
type Profile = fn(usize, f64, f64) -> [f64; 3];

/// Wendland C2 (Fatehi & Manzari 2011, Eq. 47): W = W₀ (1 − x)⁴ (1 + 4x), W′ = −20 W₀ x (1 − x)³ / R,
/// W″ = −20 W₀ (1 − x)² (1 − 4x) / R², W₀ = 3/2, 7/π, 21/(2π) over R^D.
fn typed_wendland_c2(d: usize, r: f64, radius: f64) -> [f64; 3] {
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

/// The cubic spline as Monaghan & Lattanzio 1985 print it, q = r/h, R = 2h: 1 − 3/2 q² + 3/4 q³ and (2 − q)³/4, times
/// 2/3, 10/(7π), 1/π over h^D.
fn typed_cubic_spline(d: usize, r: f64, radius: f64) -> [f64; 3] {
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

fn typed_kernels() -> [(&'static str, Profile); 2] {
    [("wendland-c2", typed_wendland_c2), ("cubic-spline", typed_cubic_spline)]
}

/// ∂_{a…}W at r_ij for no, one or two indices: W, W′ n_a, or W″ n_a n_b + (W′/r)(δ_ab − n_a n_b), whose limit at the origin
/// is W″(0) δ_ab.
fn derivative(profile: Profile, d: usize, radius: f64, r_ij: &[f64; 3], indices: &[usize]) -> f64 {
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
fn typed_sum(
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

/// The lattices that [`looped`] knows.
fn looped_lattices() -> Vec<Lattice> {
    ["line", "square", "hexagonal", "simple-cubic"].map(|id| lattice_by_id(id).unwrap()).to_vec()
}

/// r_ij of a lattice, by plain loops over whole numbers: no basis, no cells.
fn looped(id: &str) -> Vec<[f64; 3]> {
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

/// `LatticeSums::exact`, and with it `kernel` and `particles::lattice`, against formulas and loops typed in this file, for
/// p ≤ 3 and q ≤ 2. Σ|terms| takes the whole ∇∇W as one term although its two parts may cancel, hence 1e-13 for 64 ε.
/// Fails with the sign of B⁻¹ turned, with 2k for 2k − 1 in `radial_function`, with S₂ = π in `normalisation`, with D − 1 for D
/// in ∇·∇W, or without the δ_ab of ∇∇W in `Moment::components`.
#[test]
fn closed_forms_agree_with_typed_formulas() {
    let moments: Vec<_> = moments().into_iter().filter(|moment| moment.positions() <= 3).collect();
    for lattice in looped_lattices() {
        let d = lattice.dimension();
        let volume = if lattice.id() == "hexagonal" { 0.75_f64.sqrt() } else { 1.0 };
        let pairs: Vec<_> = looped(lattice.id()).into_iter().map(|r_ij| (r_ij, volume)).collect();
        for (id, profile) in typed_kernels() {
            let kernel = kernel::by_id(id).unwrap();
            let sums = lattice_sums(&kernel, &lattice, &moments);
            for support in supports().iter().skip(if d == 3 { 2 } else { 0 }) {
                for (moment, component) in components(&moments, d) {
                    let radius = rational_to_f64(support);
                    let (typed, scale) = typed_sum(profile, d, radius, moment, &component.name, &pairs);
                    let exact = sums.exact(support, &component, VolumeRule::Constant).unwrap().to_f64();
                    let place = label(&kernel, &lattice, support, moment, &component);
                    assert!((typed - exact).abs() <= 1e-13 * scale, "{place}: {typed} and {exact}");
                }
            }
        }
    }
}

/// V = 1/ΣW exactly against the typed formulas: on a lattice all volumes are equal, so a moment is Σ r…r∇^qW / ΣW.
/// Fails if `LatticeSums::exact` keeps the cell's volume in the numerator, or with the sign of B⁻¹ turned.
#[test]
fn number_density_quotients_agree_with_typed_formulas() {
    let moments = [moment("b_inverse"), moment("sum_rrw"), moment("sum_ddw")];
    for lattice in looped_lattices() {
        let d = lattice.dimension();
        let pairs: Vec<_> = looped(lattice.id()).into_iter().map(|r_ij| (r_ij, 1.0)).collect();
        for (id, profile) in typed_kernels() {
            let kernel = kernel::by_id(id).unwrap();
            let sums = lattice_sums(&kernel, &lattice, &moments);
            for support in supports() {
                let radius = rational_to_f64(&support);
                let (sum_w, _) = typed_sum(profile, d, radius, Moment::default(), "", &pairs);
                for (moment, component) in components(&moments, d) {
                    let (typed, scale) = typed_sum(profile, d, radius, moment, &component.name, &pairs);
                    let exact = sums.exact(&support, &component, VolumeRule::NumberDensity).unwrap().to_f64();
                    let place = label(&kernel, &lattice, &support, moment, &component);
                    assert!((typed / sum_w - exact).abs() <= 1e-13 * scale / sum_w, "{place}: {exact}");
                }
            }
        }
    }
}

// ----------------------------------------------------------------------------------------------------------- symmetry

/// Orders of the point groups of the line, square, hexagonal and simple cubic lattices: 1̄, 4mm, 6mm, m3̄m. Without a
/// centre: 1 for the lopsided line, 3m for the honeycomb.
/// Fails without `carries_basis_onto_itself`, or if an axis that no operation happens to move counts as one the lattice lacks.
#[test]
fn point_groups_have_the_orders_of_crystallography() {
    let order = |lattice: &Lattice| PointGroup::of(lattice).order();
    for (id, expected) in [("line", 2), ("square", 8), ("hexagonal", 12), ("simple-cubic", 48)] {
        let lattice = lattice_by_id(id).unwrap();
        assert_eq!(order(&lattice), expected, "{id}");
        assert!(PointGroup::of(&lattice).has_inversion(), "{id}");
    }
    for (lattice, expected) in [(lopsided_line(), 1), (honeycomb(), 6)] {
        assert_eq!(order(&lattice), expected, "{}", lattice.id());
        assert!(!PointGroup::of(&lattice).has_inversion(), "{}", lattice.id());
    }
}

/// What `Reduction` proves from the group against what `LatticeSums::exact` finds by adding up: zeros are zero, equal ones
/// are equal, and a free one differs from zero for at least one R/Δ and kernel (the reduction leaves nothing on the table).
/// Fails if `Reduction` compares G_0 and G_1 only, or if `PointGroup` ignores the basis.
#[test]
fn symmetry_says_what_the_sums_say() {
    let kernels = [kernel::wendland_c2(), kernel::quintic_spline()];
    for lattice in all_lattices() {
        let group = PointGroup::of(&lattice);
        let (mut zeros, mut equals, mut frees) = (0, 0, 0);
        for moment in moments() {
            let reduction = Reduction::of(moment, &lattice, &group);
            let mut nonzero = vec![false; reduction.components.len()];
            for kernel in &kernels {
                let sums = lattice_sums(kernel, &lattice, &[moment]);
                for support in [ratio(63, 20), ratio(17, 7)] {
                    let values: Vec<Coefficient> = reduction
                        .components
                        .iter()
                        .map(|c| sums.exact(&support, c, VolumeRule::Constant).unwrap())
                        .collect();
                    for (index, standing) in reduction.standing.iter().enumerate() {
                        let place = label(kernel, &lattice, &support, moment, &reduction.components[index]);
                        match *standing {
                            Standing::ZeroBySymmetry => {
                                assert_eq!(values[index], Coefficient::zero(), "{place}")
                            }
                            Standing::Equal { index: free, negative } => {
                                let same = if negative { -&values[free] } else { values[free].clone() };
                                assert_eq!(values[index], same, "{place}");
                                assert_eq!(reduction.standing[free], Standing::Free, "{place}");
                            }
                            Standing::Free => nonzero[index] |= values[index].is_zero() == Truth::False,
                        }
                    }
                }
            }
            for (index, standing) in reduction.standing.iter().enumerate() {
                let name = &reduction.components[index].name;
                match standing {
                    Standing::Free => {
                        assert!(nonzero[index], "{} {moment} {name} is free but always zero", lattice.id());
                        frees += 1;
                    }
                    Standing::Equal { .. } => equals += 1,
                    Standing::ZeroBySymmetry => zeros += 1,
                }
            }
            // Nothing is counted twice or lost.
            let all: u64 = moment.components(lattice.dimension()).iter().map(|c| c.multiplicity).sum();
            let kept: u64 = reduction.free().iter().map(|c| c.multiplicity).sum();
            let vanishing = reduction.components.iter().zip(&reduction.standing);
            let zero: u64 =
                vanishing.filter(|(_, s)| **s == Standing::ZeroBySymmetry).map(|(c, _)| c.multiplicity).sum();
            assert_eq!(kept + zero, all, "{} {moment}", lattice.id());
        }
        assert!(frees > 0 && (zeros > 0) == (group.order() > 1), "{}", lattice.id());
        assert_eq!(equals > 0, lattice.dimension() > 1, "{}", lattice.id());
    }
}

/// Where a site is no centre of inversion, odd moments stay, in `Reduction` and in `LatticeSums::exact` alike.
/// On the lopsided line Σω∇W is odd in r and nothing cancels it; the threefold axis of the honeycomb leaves no vector but
/// leaves the third-rank tensor x²y − …, so Σω∇W = 0 and Σω r r ∇W ≠ 0. Fails if `PointGroup` ignores the basis.
#[test]
fn without_inversion_odd_moments_stay() {
    let kernel = kernel::wendland_c2();
    let support = ratio(7, 2);
    let look = |lattice: &Lattice, name: &str| {
        let reduction = Reduction::of(moment(name), lattice, &PointGroup::of(lattice));
        let sums = lattice_sums(&kernel, lattice, &[moment(name)]);
        let exact = |c| sums.exact(&support, c, VolumeRule::Constant).unwrap();
        let nonzero = reduction.components.iter().filter(|c| exact(c).is_zero() == Truth::False).count();
        (reduction.standing.contains(&Standing::Free), nonzero > 0)
    };
    assert_eq!(look(&lopsided_line(), "sum_dw"), (true, true));
    assert_eq!(look(&lopsided_line(), "sum_rrdw"), (true, true));
    assert_eq!(look(&honeycomb(), "sum_dw"), (false, false));
    assert_eq!(look(&honeycomb(), "sum_rrdw"), (true, true));
    assert_eq!(look(&lattice_by_id("hexagonal").unwrap(), "sum_rrdw"), (false, false));
}

/// The particles of the basis may be named in any cell: the lattice is the same, `Lattice::sites_within` against itself.
/// Fails if `cell_reach` counts cells as if every particle of the basis lay next to the origin.
#[test]
fn the_basis_may_lie_in_any_cell() {
    let squares = [int(1), int(1), int(1)];
    let positions = |offset: i64| {
        let basis = vec![[0; 3], [offset, 0, 0]];
        let lattice = Lattice::new("line", "line", 1, squares.clone(), [[3, 0, 0], [0; 3], [0; 3]], basis);
        let mut found: Vec<f64> =
            lattice.unwrap().sites_within(4.5).iter().map(|site| site.position[0]).collect();
        found.sort_by(f64::total_cmp);
        found
    };
    assert_eq!(positions(1), [-3.0, -2.0, 0.0, 1.0, 3.0, 4.0]);
    for offset in [-5, 31, -299] {
        assert_eq!(positions(offset), positions(1), "basis particle at {offset}");
    }
}

// ----------------------------------------------------------------------------------------------------------- sampling

fn spec(
    disorder: &str,
    lattice: &str,
    support_over_dx: f64,
    rule: VolumeRule,
    moments: &[&str],
) -> SampleSpec {
    let disorder = Disorder::parse(disorder).unwrap();
    SampleSpec {
        kernel: kernel::wendland_c2(),
        lattice: lattice_by_id(lattice).unwrap(),
        amplitude: disorder.amplitude(),
        disorder,
        support_over_dx,
        rule,
        subjects: moments.iter().map(|name| Subject::Moment(moment(name))).collect(),
        seed: 2011,
    }
}

/// Where sample n of a specification puts the sites within `reach`, the centre first.
fn displaced(spec: &SampleSpec, sample: u64, reach: f64) -> Vec<[f64; 3]> {
    let mut sites = spec.lattice.sites_within(reach);
    let is_centre = |site: &Site| site.cell == [0; 3];
    sites.sort_by_key(|site| !is_centre(site));
    let (entry, motion) = (spec.disorder.entry(), spec.disorder.motion());
    let move_site = |site: &Site| {
        if entry.moves == Moves::CentreOnly && !is_centre(site) {
            return site.position;
        }
        // A stream of its own for every site: what was drawn before must not matter.
        let mut stream = SampleStream::new(spec.seed, sample);
        let kappa = rational_to_f64(spec.kernel.support_over_h());
        let unit =
            (motion.unit)(&mut Draw::new(&spec.lattice, site, spec.support_over_dx / kappa, &mut stream));
        std::array::from_fn(|a| site.position[a] + spec.amplitude * unit[a])
    };
    sites.iter().map(move_site).collect()
}

/// The components of one moment at particle 0 of a neighbourhood, in units of h = R, by typed formulas.
fn typed_moment(spec: &SampleSpec, moment: Moment, positions: &[[f64; 3]]) -> Vec<(f64, u64)> {
    let (d, radius) = (spec.lattice.dimension(), spec.support_over_dx);
    let difference = |i: usize, j: usize| std::array::from_fn(|a| positions[i][a] - positions[j][a]);
    let volume = |j: usize| match spec.rule {
        VolumeRule::Constant => rational_to_f64(&spec.lattice.particle_volume().as_rational().unwrap()),
        VolumeRule::NumberDensity => {
            let all: Vec<_> = (0..positions.len()).map(|k| (difference(j, k), 1.0)).collect();
            1.0 / typed_sum(typed_wendland_c2, d, radius, Moment::default(), "", &all).0
        }
    };
    let near = |r: &[f64; 3]| r.iter().map(|x| x * x).sum::<f64>() < radius * radius;
    let pairs: Vec<_> = (0..positions.len())
        .map(|j| (difference(0, j), j))
        .filter(|(r, _)| near(r))
        .map(|(r, j)| (r, volume(j)))
        .collect();
    let unit = radius.powi(-moment.length_power());
    let component = |c: &Component| {
        let (sum, _) = typed_sum(typed_wendland_c2, d, radius, moment, &c.name, &pairs);
        (sum * unit, c.multiplicity)
    };
    moment.components(d).iter().map(component).collect()
}

/// |S − S^reg| of one sample, by typed formulas over a neighbourhood reaching `reach`.
fn typed_deviation(spec: &SampleSpec, moment: Moment, sample: u64, reach: f64) -> f64 {
    let still = SampleSpec { amplitude: 0.0, ..spec.clone() };
    let moved = typed_moment(spec, moment, &displaced(spec, sample, reach));
    let regular = typed_moment(&still, moment, &displaced(&still, sample, reach));
    let squares =
        moved.iter().zip(&regular).map(|((s, many), (reg, _))| *many as f64 * (s - reg) * (s - reg));
    squares.sum::<f64>().sqrt()
}

/// `Sampler` against neighbourhoods placed and summed by hand, for both volume rules and all models: sample by sample,
/// since a block of one sample has |S − S^reg| as its sum. The hand-made neighbourhood reaches three spacings further than any
/// particle can see, so a site that `Sampler` forgot would show; that it agrees for two R also shows that R does not change
/// a sample. Agreement is to rounding: S is at most about 10 and h-scaled, hence 1e-11.
/// Fails if `Sampler` draws from the stream in the order of visits, if its reach with number-density volumes is R + 4 longest,
/// if `number_density` leaves out k = j, if `offset` moves all particles, or if the other models leave the centre in place.
#[test]
fn samples_agree_with_neighbourhoods_made_by_hand() {
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw", "sum_ddw", "sum_lapw"];
    for rule in VolumeRule::ALL {
        for disorder in ["offset:0.3", "box:0.8", "canonical:0.3"] {
            for (lattice, support) in
                [("line", 2.5), ("line", 6.3), ("square", 2.2), ("square", 3.15), ("simple-cubic", 1.6)]
            {
                let spec = spec(disorder, lattice, support, rule, &names);
                let sampler = Sampler::new(spec.clone()).unwrap();
                let reach = 2.0 * support + 3.0;
                for sample in [0, 1, 77] {
                    let block = sampler.block(sample, 1).unwrap();
                    assert_eq!((block.samples, block.degenerate), (1, 0));
                    for (index, name) in names.iter().enumerate() {
                        let by_hand = typed_deviation(&spec, moment(name), sample, reach);
                        let found = block.moments[index].sum;
                        assert!(
                            (found - by_hand).abs() <= 1e-11,
                            "{rule}/{disorder}/{lattice}/{support}/{name} sample {sample}: {found} and {by_hand}"
                        );
                    }
                }
            }
        }
    }
}

/// Units where R ≠ h: `Sampler` gives S in h^{p−q}; with R = 2h the moment Σω∇W is half of what it is per R, Σωrr∇W twice.
/// `offset:A` on the line against the typed cubic spline: particle i alone at ±A, S(−A) = ∓S(A), so every sample is the same.
/// Fails if `to_h` turns its exponent, if `offset` moves all particles, or with κ^{2k} for κ^{2k−n} in `Evaluator`.
#[test]
fn an_offset_particle_sees_a_rigid_displacement() {
    let support = 4.3;
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw", "sum_lapw"];
    let spec = SampleSpec {
        kernel: kernel::cubic_spline(),
        ..spec("offset:0.2", "line", support, VolumeRule::Constant, &names)
    };
    let block = Sampler::new(spec).unwrap().block(0, 40).unwrap();
    for (index, name) in names.iter().enumerate() {
        let moment = moment(name);
        let at = |a: f64| {
            let others = (-9..=9).filter(|j| *j != 0).map(|j| ([a - f64::from(j), 0.0, 0.0], 1.0));
            let pairs: Vec<_> = others.chain([([0.0; 3], 1.0)]).collect();
            let component = &moment.components(1)[0].name;
            typed_sum(typed_cubic_spline, 1, support, moment, component, &pairs).0
        };
        let h = 0.5 * support;
        for sign in [1.0, -1.0] {
            let by_hand = (at(0.2 * sign) - at(0.0)).abs() * h.powi(-moment.length_power());
            let statistics = block.moments[index];
            assert!(by_hand > 1e-6, "{name} does not notice the displacement");
            assert!((statistics.max - by_hand).abs() <= 1e-12, "{name}: {} and {by_hand}", statistics.max);
            assert!((statistics.sum / 40.0 - by_hand).abs() <= 1e-12, "{name}");
        }
    }
}

/// For a displacement d̃ of particle i alone, Taylor gives S − S^reg = d̃·∇S + ½ d̃d̃:∇∇S: odd moments of a centrosymmetric
/// lattice grow like d̃, even ones like d̃². Between A and 2A the ratio is 2^1 or 2^2 up to terms of relative order A²/Δ²
/// (A for kernels with a kink; Wendland C2 has |r|³). Fails if the amplitude is squared, or if `offset`
/// moves all particles.
#[test]
fn exponents_of_the_displacement() {
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw"];
    let rms = |disorder: &str, index| {
        let spec = spec(disorder, "line", 4.37, VolumeRule::Constant, &names);
        summarise(&[Sampler::new(spec).unwrap().block(0, 8).unwrap()], index).rms
    };
    for (index, exponent) in [(0, 2.0), (1, 1.0), (2, 2.0), (3, 1.0)] {
        let slope = (rms("offset:0.002", index) / rms("offset:0.001", index)).log2();
        assert!((slope - exponent).abs() < 0.02, "{}: {slope}, not {exponent}", names[index]);
    }
}

/// Independent displacements of variance σ² per axis: S = Σω∇W changes by δS_a = Σ_j ω H_ab(r_ij) (d_i − d_j)_b with
/// H = ∇∇W, so
/// ⟨|δS|²⟩ = σ² Σ_ab [(Σ_{j≠i} ω H_ab)² + Σ_{j≠i} (ω H_ab)²]:
/// the first term is the rigid displacement of Fatehi & Manzari's Eq. (38), the second the random walk they leave out.
/// `box:ε` has κ uniform in [−1/4, 1/4], variance (1/2)²/12 = 1/48, so σ² = ε²Δ²/48; `canonical:η` has σ² = η²Δ²/D.
/// The RMS of n samples has a relative standard error of at most 1/√(2n), that of a Gaussian (sums of bounded displacements
/// have lighter tails); it may be off by four of them, 3.2 % for n = 8000. At an amplitude of 1e-3 the second order in d is
/// below that by an order of magnitude. The rigid term alone must miss by more than that.
/// Fails with −1/2 … 1/2 for −1/4 … 1/4 in `random_box`, or if the centre is left in place.
#[test]
fn independent_displacements_add_up_like_a_random_walk() {
    const SAMPLES: u64 = 8000;
    let tolerance = 4.0 / (2.0 * SAMPLES as f64).sqrt();
    for (disorder, lattice, support) in [
        ("box:0.001", "line", 5.3),
        ("canonical:0.001", "line", 3.5),
        ("box:0.001", "square", 3.15),
        ("canonical:0.001", "square", 2.6),
    ] {
        let spec = spec(disorder, lattice, support, VolumeRule::Constant, &["sum_dw"]);
        let d = spec.lattice.dimension();
        let variance = match spec.disorder.model() {
            "box" => spec.amplitude * spec.amplitude / 48.0,
            _ => spec.amplitude * spec.amplitude / d as f64,
        };
        let others: Vec<_> = looped(lattice).into_iter().filter(|r| *r != [0.0; 3]).collect();
        let (mut rigid, mut walk) = (0.0, 0.0);
        for (a, b) in (0..d).flat_map(|a| (0..d).map(move |b| (a, b))) {
            let of = |r: &[f64; 3]| derivative(typed_wendland_c2, d, support, r, &[a, b]);
            rigid += others.iter().map(of).sum::<f64>().powi(2);
            walk += others.iter().map(|r| of(r).powi(2)).sum::<f64>();
        }
        // S is in units of 1/h.
        let rms = |square: f64| (variance * square).sqrt() * support;
        let blocks: Vec<SampleBlock> = {
            let sampler = Sampler::new(spec).unwrap();
            (0..4).map(|block| sampler.block(block * SAMPLES / 4, SAMPLES / 4).unwrap()).collect()
        };
        let measured = summarise(&blocks, 0);
        assert_eq!(measured.samples, SAMPLES);
        let off = |expected: f64| (measured.rms / expected - 1.0).abs();
        let place = format!("{disorder} on the {lattice}");
        assert!(off(rms(rigid + walk)) < tolerance, "{place}: {} and {}", measured.rms, rms(rigid + walk));
        assert!(off(rms(rigid)) > 2.0 * tolerance, "{place}: the rigid term alone explains {}", measured.rms);
        assert!(
            measured.rms_error < measured.rms * tolerance / 4.0 * 1.1,
            "{place}: ± {}",
            measured.rms_error
        );
    }
}

/// The words of a site do not depend on which other sites are visited, nor on the support that asks for them.
/// Fails if `SampleStream::words` does not seek.
#[test]
fn the_support_does_not_change_a_sample() {
    let lattice = lattice_by_id("hexagonal").unwrap();
    let words = |reach: f64| {
        let mut stream = SampleStream::new(5, 9);
        lattice.sites_within(reach).iter().map(|site| (site.cell, stream.words(site))).collect::<Vec<_>>()
    };
    let (near, far) = (words(3.15), words(7.9));
    assert!(near.len() == 37 && far.len() > 200);
    for (cell, words) in &near {
        let same = far.iter().find(|(other, _)| other == cell).unwrap();
        assert_eq!(&same.1, words, "cell {cell:?}");
    }
    // No two sites share their words.
    let mut seen: Vec<_> = far.iter().map(|(_, words)| words[0]).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), far.len());
}
