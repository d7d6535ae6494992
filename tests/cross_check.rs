//! Two ways to one number. Each test names the two modules it sets against each other and the planted errors that were
//! seen to make it fail.
//!
//! Three ways exist: closed forms (`LatticeSums::exact`), enclosures in fixed point (`LatticeSums::enclose`) and floating
//! point over given pairs (`PairSums`). A fourth is typed out, here and in `typed`: W, W′ and W″ of two kernels, and loops. Samples of
//! disorder are checked in `tests/sampled_moments.rs`.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

mod typed;

use num_traits::Signed;
use remainder::exact::{
    Coefficient, Enclosure, Rational, Truth, int, parse_rational, ratio, rational_to_f64,
};
use remainder::kernel::{self, Evaluator, Kernel};
use remainder::particles::{Lattice, PointGroup, VolumeRule, lattice, lattice_by_id};
use remainder::sums::{Component, LatticeSums, Moment, PairSums, Reduction, Standing};
use typed::{Profile, looped, moment, typed_cubic_spline, typed_sum, typed_wendland_c2};

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

fn typed_kernels() -> [(&'static str, Profile); 2] {
    [("wendland-c2", typed_wendland_c2), ("cubic-spline", typed_cubic_spline)]
}

/// The lattices that [`looped`] knows.
fn looped_lattices() -> Vec<Lattice> {
    ["line", "square", "hexagonal", "simple-cubic"].map(|id| lattice_by_id(id).unwrap()).to_vec()
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
