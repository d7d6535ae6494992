//! What must hold whatever the particles, the kernel and the moment: symmetries, identities, independence of company.
//!
//! Planted errors that were seen to fail are named above each test.
#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

mod strategies;

use proptest::prelude::*;
use remainder::exact::{Rational, int, rational_to_f64};
use remainder::kernel::{Evaluator, Kernel, RadialFunction};
use remainder::particles::{Cloud, Neighbours, Support, VolumeRule};
use remainder::sums::{LatticeSums, Moment, PairSums};

/// How many times a cheap property is tried, and one that sums a lattice.
const CASES: u32 = 200;
const LATTICE_CASES: u32 = 60;

/// Memory allowed to lattice sums here.
const MEMORY_MIB: u64 = 64;

type Pairs = [([f64; 3], f64)];

fn sum(kernel: &Kernel, dimension: usize, moments: &[Moment], pairs: &Pairs) -> Vec<f64> {
    let sums = PairSums::<f64>::new(kernel, dimension, moments);
    let mut running = sums.start();
    for (x, weight) in pairs {
        sums.add(&mut running, *x, *weight);
    }
    sums.finish(running).0
}

/// A bound of Σ|terms| for every component of every moment, in units of R: |x| ≤ 1 leaves D|G_1| + x²|G_2| at most.
fn magnitude(kernel: &Kernel, dimension: usize, pairs: &Pairs) -> f64 {
    let evaluator = Evaluator::<f64>::new(kernel, dimension, 2);
    let term = |(x, weight): &([f64; 3], f64)| {
        let square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
        let g = evaluator.evaluate(&[square.sqrt(); 8]).g;
        weight * (g[0][0].abs() + dimension as f64 * g[1][0].abs() + square * g[2][0].abs())
    };
    pairs.iter().map(term).sum()
}

/// Sums of at most 61 terms in eight lanes, each of about twenty factors, and W″ of a spline turns by a relative β/(1 − x) per
/// relative error of x: 256 ε Σ|terms| covers it and is still 10⁻¹³.
fn tolerance(scale: f64) -> f64 {
    256.0 * f64::EPSILON * scale
}

/// The full tensor of one moment: rank, and the component at any indices.
fn tensor<'a>(moment: Moment, dimension: usize, values: &'a [f64]) -> (usize, impl Fn(&[usize]) -> f64 + 'a) {
    let names: Vec<String> = moment.components(dimension).into_iter().map(|c| c.name).collect();
    let contracted = moment.name().contains("lap");
    let p = usize::from(moment.positions());
    let rank = p + if contracted { 0 } else { usize::from(moment.derivatives()) };
    let component = move |indices: &[usize]| {
        let (mut positions, mut derivatives) = (indices[..p].to_vec(), indices[p..].to_vec());
        positions.sort_unstable();
        derivatives.sort_unstable();
        let name: String =
            positions.iter().chain(&derivatives).map(|a| char::from(b'x' + *a as u8)).collect();
        values[names.iter().position(|known| *known == name).unwrap()]
    };
    (rank, component)
}

/// All index tuples of this rank.
fn tuples(dimension: usize, rank: usize) -> Vec<Vec<usize>> {
    (0..rank).fold(vec![Vec::new()], |tuples, _| {
        tuples.iter().flat_map(|t| (0..dimension).map(move |a| [t.as_slice(), &[a]].concat())).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    /// Turning and mirroring all pairs turns and mirrors the tensor: M′_{ab…} = Q_{aα} Q_{bβ} … M_{αβ…}; its Frobenius norm
    /// stays, and is the root of the sum of squares over the full tensor. Fails if `multiplicity` counts position
    /// indices only, or if `PairSums` takes one product for another with the same radial function.
    #[test]
    fn moments_turn_as_tensors(
        (dimension, pairs, q) in strategies::dimension()
            .prop_flat_map(|d| (Just(d), strategies::pairs(d), strategies::orthogonal(d))),
        kernel in strategies::kernel(),
        moment in strategies::moment(),
    ) {
        let turn = |x: &[f64; 3]| std::array::from_fn(|a| (0..3).map(|b| q[a][b] * x[b]).sum());
        let turned: Vec<_> = pairs.iter().map(|(x, weight)| (turn(x), *weight)).collect();
        let (before, after) = (sum(&kernel, dimension, &[moment], &pairs), sum(&kernel, dimension, &[moment], &turned));
        let (rank, old) = tensor(moment, dimension, &before);
        let (_, new) = tensor(moment, dimension, &after);
        // A pair at R may fall out of the support when turned; all that vanishes there is W, W′ and W″ of these kernels.
        let all = tuples(dimension, rank);
        let scale = magnitude(&kernel, dimension, &pairs) * all.len() as f64;
        let mut squares = 0.0;
        for a in &all {
            let expected: f64 = all
                .iter()
                .map(|b| a.iter().zip(b).map(|(a, b)| q[*a][*b]).product::<f64>() * old(b))
                .sum();
            prop_assert!((new(a) - expected).abs() <= tolerance(scale), "{moment} {a:?}: {} and {expected}", new(a));
            squares += new(a) * new(a);
        }
        let sums = PairSums::<f64>::new(&kernel, dimension, &[moment]);
        let (norm, turned_norm) = (sums.frobenius(0, &before), sums.frobenius(0, &after));
        prop_assert!((turned_norm - squares.sqrt()).abs() <= tolerance(scale));
        prop_assert!((norm - turned_norm).abs() <= tolerance(scale));
    }

    /// Mirroring one axis turns the sign of the components with an odd number of its letters and nothing else, bit for bit:
    /// there is no rounding in it. Fails with x (x + ε) for x² in the radius.
    #[test]
    fn a_mirror_turns_signs_bit_for_bit(
        (dimension, axis, pairs) in strategies::dimension()
            .prop_flat_map(|d| (Just(d), 0..d, strategies::pairs(d))),
        kernel in strategies::kernel(),
        moment in strategies::moment(),
    ) {
        let mirrored: Vec<_> = pairs
            .iter()
            .map(|(x, weight)| {
                let mut x = *x;
                x[axis] = -x[axis];
                (x, *weight)
            })
            .collect();
        let (before, after) = (sum(&kernel, dimension, &[moment], &pairs), sum(&kernel, dimension, &[moment], &mirrored));
        for (component, (old, new)) in moment.components(dimension).iter().zip(before.iter().zip(&after)) {
            let letters = component.name.bytes().filter(|letter| usize::from(letter - b'x') == axis).count();
            let expected = if letters % 2 == 1 { -old } else { *old };
            prop_assert!(*new == expected, "{moment} {}: {new} and {expected}", component.name);
        }
    }

    /// The order of the pairs changes a sum by rounding only. Fails if `finish` forgets the last, incomplete block.
    #[test]
    fn the_order_of_pairs_matters_to_rounding_only(
        (dimension, pairs, shuffled) in strategies::dimension().prop_flat_map(|d| {
            (Just(d), strategies::pairs(d))
        }).prop_flat_map(|(d, pairs)| (Just(d), Just(pairs.clone()), Just(pairs).prop_shuffle())),
        kernel in strategies::kernel(),
    ) {
        let moments = Moment::all(3);
        let (one, other) = (sum(&kernel, dimension, &moments, &pairs), sum(&kernel, dimension, &moments, &shuffled));
        let allowed = tolerance(magnitude(&kernel, dimension, &pairs));
        for (one, other) in one.iter().zip(&other) {
            prop_assert!((one - other).abs() <= allowed, "{one} and {other}");
        }
    }

    /// A moment has the same bits whether taken alone, with others, or in another order. Fails if
    /// `PairSums` takes one product for another with the same radial function.
    #[test]
    fn company_does_not_change_a_moment(
        (dimension, pairs) in strategies::dimension().prop_flat_map(|d| (Just(d), strategies::pairs(d))),
        kernel in strategies::kernel(),
        moments in strategies::moments(),
    ) {
        let together = sum(&kernel, dimension, &moments, &pairs);
        let sums = PairSums::<f64>::new(&kernel, dimension, &moments);
        for (moment, range) in moments.iter().zip(sums.ranges()) {
            let alone = sum(&kernel, dimension, &[*moment], &pairs);
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&alone), bits(&together[range.clone()]), "{}", moment);
        }
    }

    /// Σ_a (Σωr…∂_a∂_aW) = Σωr…∇²W. Fails if the contracted moment takes D − 1 for D, or without the δ_ab of ∇∇W.
    #[test]
    fn the_trace_of_second_derivatives_is_the_laplacian(
        (dimension, pairs) in strategies::dimension().prop_flat_map(|d| (Just(d), strategies::pairs(d))),
        kernel in strategies::kernel(),
        p in 0_u8..=3,
    ) {
        let (full, contracted) = (Moment::new(p, 2).unwrap(), Moment::laplacian(p).unwrap());
        let (full_values, traces) =
            (sum(&kernel, dimension, &[full], &pairs), sum(&kernel, dimension, &[contracted], &pairs));
        let (_, component) = tensor(full, dimension, &full_values);
        let (_, laplacian) = tensor(contracted, dimension, &traces);
        let allowed = tolerance(3.0 * magnitude(&kernel, dimension, &pairs));
        for positions in tuples(dimension, p.into()) {
            let trace: f64 = (0..dimension).map(|a| component(&[positions.as_slice(), &[a, a]].concat())).sum();
            prop_assert!((trace - laplacian(&positions)).abs() <= allowed, "{trace} and {}", laplacian(&positions));
        }
    }

    /// Lists of a cloud, then sums: a translation on the grid and a change of unit by a power of two change no bit (S carries
    /// the power p − q of a length), any other change of unit only rounding. `Neighbours` and `PairSums` together.
    /// Fails if `Neighbours` compares distances with an absolute slack of 0.05.
    #[test]
    fn translation_and_change_of_unit(
        (dimension, positions) in strategies::dimension().prop_flat_map(|d| (Just(d), strategies::positions(d))),
        shift in [-4096_i32..4096, -4096..4096, -4096..4096],
        unit in 0.1..10.0_f64,
        doublings in -20_i32..20,
        kernel in strategies::kernel(),
        moment in strategies::moment(),
    ) {
        // |r|² is a whole multiple of 2⁻²⁴ and R² lies 2⁻²⁹ above one: no pair is at R to within rounding.
        let radius = 1.0 + 2.0_f64.powi(-30);
        let evaluate = |positions: Vec<[f64; 3]>, radius: f64| {
            let volumes = vec![1.0; positions.len()];
            let cloud = Cloud::new(dimension, positions, volumes, Support::Uniform(radius)).unwrap();
            let lists = Neighbours::search(&cloud).unwrap();
            let pairs: Vec<_> = lists.of(0).iter().map(|n| (n.r_ij.map(|x| x / radius), 1.0)).collect();
            let physical = sum(&kernel, dimension, &[moment], &pairs).into_iter();
            let scale = magnitude(&kernel, dimension, &pairs);
            (physical.map(|s| s * radius.powi(moment.length_power())).collect::<Vec<_>>(), scale)
        };
        let (still, scale) = evaluate(positions.clone(), radius);
        let moved = |x: &[f64; 3]| std::array::from_fn(|a| if a < dimension { x[a] + f64::from(shift[a]) / 64.0 } else { 0.0 });
        let (shifted, _) = evaluate(positions.iter().map(moved).collect(), radius);
        prop_assert_eq!(&still, &shifted, "translation");
        for (unit, exact) in [(2.0_f64.powi(doublings), true), (unit, false)] {
            let scaled: Vec<_> = positions.iter().map(|x| x.map(|x| x * unit)).collect();
            let (scaled, _) = evaluate(scaled, radius * unit);
            let factor = unit.powi(moment.length_power());
            for (still, scaled) in still.iter().zip(&scaled) {
                let allowed = if exact { 0.0 } else { tolerance(4.0 * scale) };
                prop_assert!((scaled / factor - still).abs() <= allowed, "unit {unit}: {scaled} and {still}");
            }
        }
    }

    /// `Evaluator` against exact rational arithmetic: F = σ w(κx) κ^D, F′/x and (F′/x)′/x = (F″ − F′/x)/x², from the
    /// derivatives of `Piecewise` and not from `radial_function`. The error is at most 32 ε of the terms of the polynomial in
    /// s = x_right − x; near R, where one power of s leads, that makes it relative, however small the value.
    /// Fails with κ^{2k} for κ^{2k−n} in `Evaluator`, or with 2k for 2k − 1 in `radial_function`.
    #[test]
    fn evaluation_agrees_with_rational_arithmetic(
        kernel in strategies::kernel(),
        dimension in strategies::dimension(),
        mantissa in 1_u64..(1 << 52),
        closer in 0_u32..40,
    ) {
        // x uniform, or ever closer to 1: 1 − y 2^{−closer} is rounded, but then exact as a rational.
        let x = 1.0 - (1.0 - mantissa as f64 / (1_u64 << 52) as f64) * 0.5_f64.powi(closer as i32);
        prop_assume!(x < 1.0);
        let exact_x = Rational::from_float(x).unwrap();
        let kappa = kernel.support_over_h();
        let q = &exact_x * kappa;
        let derivative = kernel.polynomial().unwrap().derivative();
        let (w, dw, ddw) =
            (kernel.polynomial().unwrap().evaluate(&q), derivative.evaluate(&q), derivative.derivative().evaluate(&q));
        let g1 = kappa * dw / &exact_x;
        let g2 = (kappa * kappa * ddw - &g1) / (&exact_x * &exact_x);
        let sigma = kernel.enclose_normalisation(dimension, 128).midpoint_f64()
            * rational_to_f64(kappa).powi(dimension as i32);
        let found = Evaluator::<f64>::new(&kernel, dimension, 2).evaluate(&[x; 8]).g;
        // The largest term any piece can have: |coefficient| s^n over x^n, from the value at s = −(x_right − x).
        for (k, exact) in [w, g1, g2].iter().enumerate() {
            let expected = rational_to_f64(exact) * sigma;
            let scale = sigma * terms_in_s(&kernel, k, &exact_x);
            for lane in found[k] {
                prop_assert!((lane - expected).abs() <= 32.0 * f64::EPSILON * scale, "G_{k}({x}): {lane} and {expected}");
                if x > 0.95 {
                    let relative = (lane / expected - 1.0).abs();
                    prop_assert!(relative <= 64.0 * f64::EPSILON, "G_{k}({x}) off by {relative}");
                }
            }
        }
        let beyond = Evaluator::<f64>::new(&kernel, dimension, 2).evaluate(&[1.0 + mantissa as f64 * 1e-16; 8]).g;
        prop_assert_eq!(beyond, [[0.0; 8]; 3], "beyond the support");
    }
}

/// Σ |c_n| sⁿ / x^m of G_k in units of R, with s measured from the right end of the piece.
fn terms_in_s(kernel: &Kernel, k: usize, x: &Rational) -> f64 {
    use remainder::exact::Polynomial;
    let kappa = kernel.support_over_h();
    let q = x * kappa;
    let RadialFunction::Pieces(pieces) = kernel.radial_function(k) else { panic!("a polynomial kernel") };
    let piece = pieces.into_iter().find(|piece| q < piece.to).unwrap();
    let s = rational_to_f64(&(&piece.to - &q));
    let in_s = piece.numerator.compose(&Polynomial::new(vec![piece.to.clone(), int(-1)]));
    let terms = in_s.coefficients().iter().enumerate();
    let sum: f64 = terms.map(|(n, c)| rational_to_f64(c).abs() * s.powi(n as i32)).sum();
    sum * rational_to_f64(kappa).powi(2 * k as i32) / rational_to_f64(&q).powi(piece.denominator_power as i32)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(LATTICE_CASES))]

    /// Closed forms and enclosures agree for kernels nobody has looked at: any pieces, jumps and poles.
    /// Fails with `ceil() − 1` for `ceil()` in `first_level_beyond`.
    #[test]
    fn random_kernels_close_and_enclose(
        kernel in strategies::polynomial_kernel(),
        lattice in strategies::any_lattice(),
        support in strategies::support(),
        moment in strategies::moment(),
        bits in 20_u32..200,
    ) {
        let sums = LatticeSums::new(&kernel, &lattice, &support, &[moment], MEMORY_MIB).unwrap();
        let components = moment.components(lattice.dimension());
        let enclosed = sums.enclose(&support, &components, VolumeRule::Constant, bits).unwrap();
        for (component, enclosed) in components.iter().zip(&enclosed) {
            let exact = sums.exact(&support, component, VolumeRule::Constant).unwrap();
            prop_assert!(enclosed.overlaps(&exact.enclose(400)), "{}: {enclosed} and {exact}", component.name);
            let width = rational_to_f64(&enclosed.radius()) * 2.0_f64.powi(bits as i32);
            prop_assert!(width <= 2.0_f64.powi(50), "{}: {enclosed} is {width} units wide", component.name);
        }
    }

    /// The trace identity again, exactly: Σ_a of the closed forms of ∂_a∂_aW is that of ∇²W.
    /// Fails as the one in floating point does.
    #[test]
    fn the_trace_is_the_laplacian_exactly(
        kernel in strategies::polynomial_kernel(),
        lattice in strategies::any_lattice(),
        support in strategies::support(),
    ) {
        let (full, contracted) = (Moment::new(0, 2).unwrap(), Moment::laplacian(0).unwrap());
        let sums = LatticeSums::new(&kernel, &lattice, &support, &[full, contracted], MEMORY_MIB).unwrap();
        let exact = |component| sums.exact(&support, component, VolumeRule::Constant).unwrap();
        let components = full.components(lattice.dimension());
        let diagonal = components.iter().filter(|c| c.name.bytes().all(|letter| letter == c.name.as_bytes()[0]));
        let trace = diagonal.map(exact).reduce(|sum, next| &sum + &next).unwrap();
        prop_assert_eq!(trace, exact(&contracted.components(lattice.dimension())[0]));
    }
}
