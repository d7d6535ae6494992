//! Neighbour lists against brute force, against the `kdtree` crate and against exact arithmetic; clouds refused.
//!
//! Planted errors that these tests were seen to catch in `particles::neighbours`: see the note at each.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use kdtree::KdTree;
use kdtree::distance::squared_euclidean;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use remainder::particles::{ClosestPair, Cloud, CloudError, LENGTH_LIMIT, Quantity, Support};
use remainder::particles::{Neighbour, Neighbours};

type Lists = Vec<Vec<Neighbour>>;

fn lists(found: &Neighbours) -> Lists {
    (0..found.len()).map(|i| found.of(i).to_vec()).collect()
}

fn search(cloud: &Cloud) -> Lists {
    lists(&Neighbours::search(cloud).expect("these clouds fit in memory"))
}

/// Every image in a range that surely suffices, in the documented order, with x_i - (x_j + nL) as it is written.
fn brute_force(cloud: &Cloud) -> Lists {
    let x = cloud.positions();
    let list = |i: usize| {
        let radius = cloud.support_of(i);
        let mut list = Vec::new();
        for j in 0..x.len() {
            let images = |axis: usize| -> Vec<f64> {
                let Some(period) = cloud.periods()[axis] else { return vec![0.0] };
                let last = (((x[i][axis] - x[j][axis]).abs() + radius) / period).ceil() as i64 + 1;
                (-last..=last).map(|n| n as f64 * period).collect()
            };
            let shifts = [images(0), images(1), images(2)];
            for s_x in &shifts[0] {
                for s_y in &shifts[1] {
                    for s_z in &shifts[2] {
                        let s = [s_x, s_y, s_z];
                        let r_ij: [f64; 3] = std::array::from_fn(|a| x[i][a] - (x[j][a] + s[a]));
                        if r_ij.iter().map(|r| r * r).sum::<f64>() < radius * radius {
                            list.push(Neighbour { j: j as u32, r_ij });
                        }
                    }
                }
            }
        }
        list
    };
    (0..x.len()).map(list).collect()
}

/// Coordinates, periods and supports in 64ths: every operation is exact, and distances equal to R are common.
#[derive(Debug, Clone)]
struct Dyadic {
    dimension: usize,
    positions: Vec<[i32; 3]>,
    periods: [Option<i32>; 3],
    supports: Vec<i32>,
}

fn in_64ths(k: i32) -> f64 {
    f64::from(k) / 64.0
}

impl Dyadic {
    fn cloud(&self, origin: f64) -> Cloud {
        let used = |k: i32, axis: usize| if axis < self.dimension { origin + in_64ths(k) } else { 0.0 };
        let place = |x: &[i32; 3]| [used(x[0], 0), used(x[1], 1), used(x[2], 2)];
        let positions: Vec<_> = self.positions.iter().map(place).collect();
        let support = match self.supports.as_slice() {
            [one] => Support::Uniform(in_64ths(*one)),
            many => Support::PerParticle(many[..positions.len()].iter().map(|&k| in_64ths(k)).collect()),
        };
        let mut periods = self.periods.map(|period| period.map(in_64ths));
        periods[self.dimension..].fill(None);
        let volumes = vec![1.0; positions.len()];
        let cloud = Cloud::new(self.dimension, positions, volumes, support).expect("valid by construction");
        cloud.with_periods(periods).expect("valid by construction")
    }
}

fn dyadic_cloud() -> impl Strategy<Value = Dyadic> {
    // Boxes of 16 to 96, supports up to 2.5 of the shortest (3D: at most 80, for time), particles well outside.
    (1..=3_usize, proptest::collection::vec(proptest::option::of(16..=96_i32), 3)).prop_flat_map(
        |(dimension, periods)| {
            let shortest = periods.iter().take(dimension).flatten().min().copied().unwrap_or(40);
            let most = if dimension == 3 { 80.min(shortest * 5 / 2) } else { shortest * 5 / 2 };
            let count = if dimension == 3 { 12 } else { 24 };
            let one = proptest::collection::vec(1..=most, 1);
            let many = proptest::collection::vec(1..=most, count);
            let positions = proptest::collection::vec(proptest::array::uniform3(-100..=200_i32), 2..=count);
            (positions, prop_oneof![one, many]).prop_map(move |(positions, supports)| Dyadic {
                dimension,
                positions,
                periods: [periods[0], periods[1], periods[2]],
                supports,
            })
        },
    )
}

/// Points of the plain f64 kind; lengths are of order 1.
#[derive(Debug, Clone)]
struct Plain {
    dimension: usize,
    positions: Vec<[f64; 3]>,
    periods: [Option<f64>; 3],
    support: f64,
}

impl Plain {
    fn cloud(&self) -> Cloud {
        let mut positions = self.positions.clone();
        positions.iter_mut().for_each(|x| x[self.dimension..].fill(0.0));
        let mut periods = self.periods;
        periods[self.dimension..].fill(None);
        let volumes = vec![1.0; positions.len()];
        let cloud = Cloud::new(self.dimension, positions, volumes, Support::Uniform(self.support));
        cloud.and_then(|cloud| cloud.with_periods(periods)).expect("valid by construction")
    }
}

fn plain_cloud(box_fractions: std::ops::Range<f64>, far: f64) -> impl Strategy<Value = Plain> {
    let period = || proptest::option::of(0.3..1.1_f64);
    let periods = [period(), period(), period()];
    let positions = proptest::collection::vec(proptest::array::uniform3(-far..far), 2..40);
    (1..=3_usize, positions, periods, box_fractions).prop_map(|(dimension, positions, periods, fraction)| {
        let shortest = periods.iter().take(dimension).flatten().fold(1.0, |a: f64, &b| a.min(b));
        Plain { dimension, positions, periods, support: fraction * shortest }
    })
}

fn one_self_entry_each(found: &Lists) -> TestCaseResult {
    for (i, list) in found.iter().enumerate() {
        let is_self = |pair: &&Neighbour| pair.j as usize == i && pair.r_ij == [0.0; 3];
        prop_assert_eq!(list.iter().filter(is_self).count(), 1, "particle {}", i);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Equal bits, order included. Caught: `<=` for `<`; images beyond ±1 dropped; the last cell or site
    /// of a window missed; wrapping left out; the order left to the cells.
    #[test]
    fn lists_equal_brute_force_where_arithmetic_is_exact(dyadic in dyadic_cloud()) {
        let cloud = dyadic.cloud(0.0);
        let found = search(&cloud);
        prop_assert_eq!(&found, &brute_force(&cloud));
        one_self_entry_each(&found)?;
    }

    /// Numbers near 1e8 hold 64ths exactly, so a translation changes no bit of any list.
    #[test]
    fn translation_by_1e8_changes_nothing(dyadic in dyadic_cloud()) {
        prop_assert_eq!(search(&dyadic.cloud(0.0)), search(&dyadic.cloud(1e8)));
        prop_assert_eq!(search(&dyadic.cloud(0.0)), search(&dyadic.cloud(-1e8)));
    }

    /// The estimate counts exactly while all lists are sampled and no support exceeds two boxes: it then suffices,
    /// and a byte less does not.
    #[test]
    fn memory_estimate_is_exact_for_few_particles(dyadic in dyadic_cloud()) {
        let cloud = dyadic.cloud(0.0);
        let largest = (0..cloud.len()).map(|i| cloud.support_of(i)).fold(0.0, f64::max);
        if cloud.periods().iter().flatten().any(|period| largest > 2.0 * period) {
            return Ok(());
        }
        let needed = Neighbours::estimate_bytes(&cloud);
        prop_assert!(Neighbours::search_within(&cloud, needed).is_ok());
        let refused = Neighbours::search_within(&cloud, needed - 1);
        prop_assert_eq!(refused, Err(CloudError::Memory { needed, allowed: needed - 1 }));
    }

    /// A tree over explicit images, with no code or method in common.
    #[test]
    fn lists_equal_those_of_a_kd_tree(plain in plain_cloud(0.05..1.4, 1.5)) {
        let cloud = plain.cloud();
        let d = cloud.dimension();
        let mut tree = KdTree::new(d);
        let mut images = Vec::new();
        for (j, x) in cloud.positions().iter().enumerate() {
            let range = |axis: usize| if cloud.periods()[axis].is_some() { -13..=13 } else { 0..=0 };
            for n in itertools::iproduct!(range(0), range(1), range(2)) {
                let shift = [f64::from(n.0), f64::from(n.1), f64::from(n.2)];
                let at = |a: usize| x[a] + shift[a] * cloud.periods()[a].unwrap_or(0.0);
                let image = [at(0), at(1), at(2)];
                // Only images that can matter, to keep the tree small.
                if image.iter().all(|c| c.abs() < 1.5 + cloud.support_of(j)) {
                    tree.add(image[..d].to_vec(), images.len()).expect("finite, of dimension d");
                    images.push((j, image));
                }
            }
        }
        let found = search(&cloud);
        for (i, x) in cloud.positions().iter().enumerate() {
            let radius = cloud.support_of(i);
            let within = tree.within(&x[..d], radius * radius, &squared_euclidean).expect("finite, of dimension d");
            prop_assert_eq!(within.len(), found[i].len(), "particle {}", i);
            for pair in &found[i] {
                let matches = |&&(_, &k): &&(f64, &usize)| {
                    let (j, image): (usize, [f64; 3]) = images[k];
                    j == pair.j as usize && (0..3).all(|a| (x[a] - image[a] - pair.r_ij[a]).abs() < 1e-14)
                };
                prop_assert_eq!(within.iter().filter(matches).count(), 1, "particle {}: {:?}", i, pair);
            }
        }
    }

    /// Caught: the order left to the cells; the sign of the image shift.
    #[test]
    fn pairs_are_antisymmetric_to_the_bit_and_in_order(plain in plain_cloud(0.05..2.5, 5.0)) {
        let found = search(&plain.cloud());
        for (i, list) in found.iter().enumerate() {
            prop_assert!(list.windows(2).all(|w| w[0].j < w[1].j || (w[0].j == w[1].j && w[0].r_ij > w[1].r_ij)));
            for pair in list {
                let back = Neighbour { j: i as u32, r_ij: pair.r_ij.map(|r| 0.0 - r) };
                prop_assert!(found[pair.j as usize].contains(&back));
            }
        }
        one_self_entry_each(&found)?;
    }

    /// Against rational arithmetic, for particles up to 1e8 boxes away. Caught: x_i - x_j without its lost part;
    /// nL rounded before it is subtracted.
    #[test]
    fn separations_have_the_documented_accuracy(plain in plain_cloud(0.2..0.9, 1e8)) {
        let cloud = plain.cloud();
        let exact = |x: f64| BigRational::from_float(x).expect("finite");
        let epsilon = exact(f64::EPSILON);
        for (i, list) in search(&cloud).iter().enumerate() {
            for pair in list {
                let (x_i, x_j) = (cloud.positions()[i], cloud.positions()[pair.j as usize]);
                for axis in 0..cloud.dimension() {
                    let d = exact(x_i[axis]) - exact(x_j[axis]);
                    let r = match cloud.periods()[axis].map(exact) {
                        None => d.clone(),
                        Some(period) => {
                            let n = ((&d - exact(pair.r_ij[axis])) / &period).round();
                            &d - n * period
                        }
                    };
                    let error = (exact(pair.r_ij[axis]) - &r).abs();
                    let bound = &epsilon * r.abs() + &epsilon * &epsilon * d.abs();
                    prop_assert!(error <= bound || error.is_zero(), "axis {axis}: error {error}, bound {bound}");
                }
            }
        }
    }

    /// Neighbouring floats around the edge of the support, over a boundary or several. Caught: query ranges without
    /// their margin.
    #[test]
    fn a_pair_barely_inside_is_found_over_any_boundary(
        x in prop_oneof![-3.0..3.0_f64, -0.01..0.01_f64],
        period in 0.3..1.1_f64,
        support in 1e-4..0.1_f64,
        boxes in -4..=4_i32,
        side in prop::bool::ANY,
    ) {
        let edge = x + if side { support } else { -support } + f64::from(boxes) * period;
        let mut places = vec![x, edge];
        let (mut up, mut down) = (edge, edge);
        for _ in 0..6 {
            (up, down) = (up.next_up(), down.next_down());
            places.extend([up, down]);
        }
        let exact = |x: f64| BigRational::from_float(x).expect("finite");
        let positions = places.iter().map(|&c| [c, 0.0, 0.0]).collect();
        let cloud = Cloud::new(1, positions, vec![1.0; places.len()], Support::Uniform(support))
            .and_then(|cloud| cloud.with_periods([Some(period), None, None])).expect("valid");
        let found = search(&cloud);
        for (j, &place) in places.iter().enumerate().skip(1) {
            let r = exact(x) - exact(place) + BigRational::from_integer(boxes.into()) * exact(period);
            let listed = found[0].iter().any(|pair| pair.j as usize == j);
            let ratio = r.abs() / exact(support);
            if ratio < exact(1.0 - 2.0 * f64::EPSILON) {
                prop_assert!(listed, "{place} is inside");
            } else if ratio > exact(1.0 + 2.0 * f64::EPSILON) {
                prop_assert!(!listed, "{place} is outside");
            }
        }
    }

    /// Caught: a reach of a quarter period; half the reach; ties left to the order of the search.
    #[test]
    fn closest_pair_equals_brute_force(dyadic in dyadic_cloud()) {
        let cloud = dyadic.cloud(0.0);
        let x = cloud.positions();
        let distance = |i: usize, j: usize| {
            let r = |a: usize| {
                let d = (x[i][a] - x[j][a]).abs();
                cloud.periods()[a].map_or(d, |period| (d % period).min(period - d % period))
            };
            (r(0) * r(0) + r(1) * r(1) + r(2) * r(2)).sqrt()
        };
        let mut expected = ClosestPair { i: 0, j: 1, distance: f64::INFINITY };
        for j in 0..x.len() {
            for i in 0..j {
                let pair = ClosestPair { i, j, distance: distance(i, j) };
                if (pair.distance, i, j) < (expected.distance, expected.i, expected.j) {
                    expected = pair;
                }
            }
        }
        let found = cloud.closest_pair().expect("at least two particles");
        prop_assert_eq!(found.distance, expected.distance);
        if expected.distance > 0.0 {
            prop_assert_eq!(found, expected);
            prop_assert_eq!(cloud.check_separation(expected.distance), Ok(()));
            let refused = cloud.check_separation(expected.distance * 1.001);
            let ClosestPair { i, j, distance } = expected;
            prop_assert_eq!(refused, Err(CloudError::TooClose { i, j, distance }));
        } else {
            prop_assert_eq!(distance(found.i, found.j), 0.0);
            prop_assert!(found.i < found.j);
        }
    }

    #[test]
    fn lists_at_some_centres_are_those_of_all(
        dyadic in dyadic_cloud(),
        picks in proptest::collection::vec(0..1000_usize, 0..5),
    ) {
        let cloud = dyadic.cloud(0.0);
        let centres: Vec<usize> = picks.iter().map(|pick| pick % cloud.len()).collect();
        let some = Neighbours::search_at(&cloud, &centres).expect("centres in range");
        let all = Neighbours::search(&cloud).expect("fits in memory");
        prop_assert_eq!(some.len(), centres.len());
        for (k, &i) in centres.iter().enumerate() {
            prop_assert_eq!(some.centre(k), i);
            prop_assert_eq!(some.of(k), all.of(i));
        }
    }
}

fn random_box(count: usize, seed: u64, support: f64) -> Cloud {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let positions: Vec<[f64; 3]> = (0..count).map(|_| std::array::from_fn(|_| rng.random::<f64>())).collect();
    Cloud::new(3, positions, vec![1.0; count], Support::Uniform(support)).expect("valid")
}

fn periodic(cloud: Cloud, period: f64) -> Cloud {
    cloud.with_periods([Some(period); 3]).expect("valid")
}

#[test]
fn lists_do_not_depend_on_the_number_of_threads() {
    let cloud = periodic(random_box(3000, 1, 0.15), 1.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a small pool");
        pool.install(|| {
            (Neighbours::search(&cloud), cloud.closest_pair(), Neighbours::estimate_bytes(&cloud))
        })
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn a_shell_at_exactly_the_support_is_left_out() {
    // Simple cubic lattice of spacing 1/4 in the unit box; squared shell radii 0, 1, 2, 3, 4 hold 1, 6, 12, 8, 6.
    let positions: Vec<[f64; 3]> = itertools::iproduct!(0..4, 0..4, 0..4)
        .map(|(a, b, c)| [f64::from(a) / 4.0, f64::from(b) / 4.0, f64::from(c) / 4.0])
        .collect();
    let count_with = |support: f64| -> BTreeMap<usize, usize> {
        let cloud = Cloud::new(3, positions.clone(), vec![1.0 / 64.0; 64], Support::Uniform(support));
        let mut lengths = BTreeMap::new();
        search(&periodic(cloud.expect("valid"), 1.0))
            .iter()
            .for_each(|list| *lengths.entry(list.len()).or_default() += 1);
        lengths
    };
    assert_eq!(count_with(0.5), BTreeMap::from([(27, 64)]));
    assert_eq!(count_with(0.5_f64.next_up()), BTreeMap::from([(33, 64)]));
    assert_eq!(count_with(0.25), BTreeMap::from([(1, 64)]));
}

#[test]
fn with_its_own_support_each_particle_gathers_for_itself() {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
    let supports = Support::PerParticle(vec![0.5, 1.5, 10.0]);
    let cloud = Cloud::new(1, positions, vec![1.0; 3], supports).expect("valid");
    let found = search(&cloud);
    let neighbours = |i: usize| found[i].iter().map(|pair| pair.j).collect::<Vec<_>>();
    assert_eq!([neighbours(0), neighbours(1), neighbours(2)], [vec![0], vec![0, 1], vec![0, 1, 2]]);
}

#[test]
fn a_single_particle_sees_its_images() {
    let cloud = Cloud::new(2, vec![[0.25, 7.0, 0.0]], vec![1.0], Support::Uniform(10.5)).expect("valid");
    let found = search(&cloud.with_periods([Some(1.0), Some(2.0), None]).expect("valid"));
    let inside =
        itertools::iproduct!(-20..=20, -20..=20).filter(|(a, b)| 4 * (a * a + 4 * b * b) < 441).count();
    assert_eq!(found[0].len(), inside);
}

/// Extents, clusters and supports that would need a huge grid, or put everything into one cell of a coarse one.
#[test]
fn awkward_clouds_are_searched_in_good_time() {
    let count = 20_000;
    let base = random_box(count, 2, 0.03);
    let with = |change: &dyn Fn(usize, [f64; 3]) -> [f64; 3], support: f64| {
        let positions = base.positions().iter().enumerate().map(|(i, &x)| change(i, x)).collect();
        Cloud::new(3, positions, vec![1.0; count], Support::Uniform(support)).expect("valid")
    };
    let spread = with(&|_, x| x.map(|c| c * 1e12), 1.0);
    let tiny = with(&|_, x| x, 1e-140);
    let outlier = with(&|i, x| if i == 0 { [1e8; 3] } else { x }, 0.03);
    let flat = with(&|_, x| [x[0] * 1e9, x[1], x[2] * 1e-9], 1e4);
    let needle = with(&|_, x| [x[0] * 1e-9, x[1] * 1e-9, x[2] * 1e9], 1e4);
    let mut supports = vec![1e-6; count];
    supports[7] = 5.0;
    let one_large =
        Cloud::new(3, base.positions().to_vec(), vec![1.0; count], Support::PerParticle(supports));
    let start = Instant::now();
    let entries = |cloud: &Cloud| Neighbours::search(cloud).expect("fits in memory").entry_count();
    assert_eq!(entries(&spread), count);
    assert_eq!(entries(&tiny), count);
    assert_eq!(entries(&periodic(tiny, 1.0)), count);
    assert_eq!(entries(&one_large.expect("valid")), 2 * count - 1);
    let (inside, whole) = (entries(&outlier), entries(&base));
    assert!(inside < whole && whole - inside < 20, "{inside} of {whole}");
    for thin in [flat, needle] {
        let (found, direct) = (search(&thin), brute_force_lengths(&thin, &[0, 777, 19_999]));
        assert_eq!(direct, [found[0].len(), found[777].len(), found[19_999].len()]);
        assert!(thin.closest_pair().is_some_and(|pair| pair.distance > 0.0));
    }
    // Quadratic work takes minutes; this takes about a second.
    assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
}

fn brute_force_lengths(cloud: &Cloud, centres: &[usize]) -> Vec<usize> {
    let x = cloud.positions();
    let near = |i: usize, j: usize| {
        let r: [f64; 3] = std::array::from_fn(|a| x[i][a] - x[j][a]);
        r.iter().map(|c| c * c).sum::<f64>() < cloud.support_of(i).powi(2)
    };
    centres.iter().map(|&i| (0..x.len()).filter(|&j| near(i, j)).count()).collect()
}

#[test]
fn coincident_particles_are_neighbours_at_zero() {
    let cloud = Cloud::new(3, vec![[0.5; 3]; 50], vec![1.0; 50], Support::Uniform(0.1)).expect("valid");
    for list in search(&cloud) {
        assert_eq!(list.iter().map(|pair| pair.j).collect::<Vec<_>>(), (0..50).collect::<Vec<_>>());
        assert!(list.iter().all(|pair| pair.r_ij == [0.0; 3]));
    }
    let too_close = CloudError::TooClose { i: 0, j: 1, distance: 0.0 };
    assert_eq!(cloud.check_separation(1e-9), Err(too_close));
}

#[test]
fn coincidence_is_found_across_the_boundary() {
    let positions = vec![[0.0, 0.3, 0.0], [0.5, 0.5, 0.0], [2.0, 0.3, 0.0]];
    let cloud = Cloud::new(2, positions, vec![1.0; 3], Support::Uniform(0.1)).expect("valid");
    assert_eq!(cloud.check_separation(0.5), Ok(()));
    let cloud = cloud.with_periods([Some(1.0), None, None]).expect("valid");
    assert_eq!(cloud.check_separation(1e-9), Err(CloudError::TooClose { i: 0, j: 2, distance: 0.0 }));
    let alone = Cloud::new(1, vec![[0.0; 3]], vec![1.0], Support::Uniform(1.0)).expect("valid");
    assert_eq!((alone.closest_pair(), alone.check_separation(1.0)), (None, Ok(())));
}

#[test]
fn the_memory_estimate_is_close_on_both_sides() {
    let open = random_box(5000, 3, 0.2);
    let several_boxes = periodic(random_box(40, 4, 3.3), 1.0);
    let mixed = random_box(60, 5, 4.0).with_periods([Some(0.9), None, Some(1.7)]).expect("valid");
    for cloud in [periodic(open.clone(), 1.0), open, several_boxes, mixed] {
        let estimate = Neighbours::estimate_bytes(&cloud) as f64;
        let Err(CloudError::Memory { needed: refused, .. }) = Neighbours::search_within(&cloud, 1) else {
            unreachable!("one byte is not enough")
        };
        assert_eq!(refused as f64, estimate, "far too little is refused without counting");
        let entries = Neighbours::search(&cloud).expect("fits in memory").entry_count();
        let listed = (entries * size_of::<Neighbour>()) as f64;
        assert!(
            listed < 1.1 * estimate && estimate < 1.2 * listed + 300.0 * cloud.len() as f64,
            "{listed} {estimate}"
        );
    }
}

#[test]
fn hopeless_searches_are_refused_at_once() {
    let start = Instant::now();
    let cloud = periodic(random_box(100, 6, 1e6), 1.0);
    let expected = 100.0 * 100.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e18 * 32.0;
    assert!((Neighbours::estimate_bytes(&cloud) as f64 / expected.min(u64::MAX as f64) - 1.0).abs() < 1e-9);
    assert!(matches!(Neighbours::search(&cloud), Err(CloudError::Memory { .. })));
    assert!(matches!(Neighbours::search_at(&cloud, &[3]), Err(CloudError::Memory { .. })));
    let cloud = random_box(2000, 7, 0.5);
    let needed = match Neighbours::search_within(&cloud, Neighbours::estimate_bytes(&cloud) * 3 / 4) {
        Err(CloudError::Memory { needed, .. }) => needed,
        other => unreachable!("{other:?}"),
    };
    assert!(Neighbours::search_within(&cloud, needed).is_ok(), "the size counted suffices");
    assert!(Neighbours::search_within(&cloud, needed - 1).is_err(), "and a byte less does not");
    assert!(start.elapsed() < Duration::from_secs(30));
}

fn unit(dimension: usize, positions: Vec<[f64; 3]>) -> Result<Cloud, CloudError> {
    let volumes = vec![1.0; positions.len()];
    Cloud::new(dimension, positions, volumes, Support::Uniform(1.0))
}

fn refusal<T: std::fmt::Debug>(result: Result<T, CloudError>) -> String {
    result.expect_err("must be refused").to_string()
}

#[test]
fn a_refused_cloud_says_where_and_what_to_do() {
    let two = || vec![[0.0; 3], [1.0, 0.0, 0.0]];
    let with = |volumes: Vec<f64>, support: Support| refusal(Cloud::new(1, two(), volumes, support));
    let one = Support::Uniform(1.0);
    let said = [
        refusal(unit(0, two())),
        refusal(unit(4, two())),
        refusal(unit(1, vec![])),
        refusal(unit(2, vec![[0.0; 3], [0.0, f64::NAN, 0.0]])),
        refusal(unit(3, vec![[0.0; 3], [0.0, 0.0, f64::NEG_INFINITY]])),
        refusal(unit(1, vec![[0.0, 0.0, 2.5]])),
        refusal(unit(2, vec![[1e200, 0.0, 0.0]])),
        with(vec![1.0; 3], one.clone()),
        with(vec![1.0, 0.0], one.clone()),
        with(vec![1.0, f64::NAN], one),
        with(vec![1.0; 2], Support::Uniform(-1.0)),
        with(vec![1.0; 2], Support::PerParticle(vec![1.0])),
        with(vec![1.0; 2], Support::PerParticle(vec![1.0, -2.0])),
        with(vec![1.0; 2], Support::PerParticle(vec![1.0, f64::INFINITY])),
        with(vec![1.0; 2], Support::PerParticle(vec![1.0, 1e-200])),
    ];
    let expected = [
        "the dimension is 0; give 1, 2 or 3",
        "the dimension is 4; give 1, 2 or 3",
        "the cloud has no particles; give at least one",
        "particle 1: the y coordinate is NaN; remove the particle or repair the input",
        "particle 1: the z coordinate is -inf; remove the particle or repair the input",
        "particle 0: the z coordinate is 2.5 in a cloud of dimension 1; set it to 0 or raise the dimension",
        "particle 0: the x coordinate 1e200 exceeds 1e150; choose another unit of length",
        "volume: 3 values for 2 particles; give one value for each particle",
        "particle 1: the volume is 0; it must be positive",
        "particle 1: the volume is NaN; every value must be finite",
        "the support radius is -1; it must be positive, finite and within 1e-150 to 1e150",
        "support radius: 1 values for 2 particles; give one value for each particle",
        "particle 1: the support radius is -2; it must be positive",
        "particle 1: the support radius is inf; every value must be finite",
        "particle 1: the support radius 1e-200 is outside 1e-150 to 1e150; choose another unit of length",
    ];
    assert_eq!(said.each_ref().map(String::as_str), expected);
    for support in [0.0, f64::NAN, f64::INFINITY] {
        let refused = Cloud::new(1, two(), vec![1.0; 2], Support::Uniform(support));
        assert!(matches!(refused, Err(CloudError::UniformSupport { .. })), "{support}");
    }
}

#[test]
fn refused_periods_tags_fields_and_centres() {
    let cloud = || unit(2, vec![[0.0; 3], [1.0, 1e20, 0.0]]).expect("valid");
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.0 * LENGTH_LIMIT] {
        let refused = cloud().with_periods([Some(value), None, None]);
        assert!(matches!(refused, Err(CloudError::Period { axis: 0, .. })), "{value}");
    }
    let refused = cloud().with_periods([None, None, Some(1.0)]);
    assert_eq!(refused, Err(CloudError::UnusedPeriod { axis: 2, dimension: 2 }));
    let refused = cloud().with_periods([None, Some(0.5), None]);
    assert_eq!(refused, Err(CloudError::FarFromBox { particle: 1, axis: 1, value: 1e20, period: 0.5 }));
    let refused = cloud().with_tags(vec![1]);
    assert_eq!(refused, Err(CloudError::Length { quantity: Quantity::Tag, found: 1, expected: 2 }));
    let quantity = || Quantity::Field("rho".to_owned());
    let refused = cloud().with_field("rho", vec![]);
    assert_eq!(refused, Err(CloudError::Length { quantity: quantity(), found: 0, expected: 2 }));
    let refused = cloud().with_field("rho", vec![1.0, f64::INFINITY]);
    assert_eq!(
        refused,
        Err(CloudError::NonFinite { quantity: quantity(), particle: 1, value: f64::INFINITY })
    );
    let refused =
        cloud().with_field("rho", vec![1.0; 2]).and_then(|cloud| cloud.with_field("rho", vec![2.0; 2]));
    assert_eq!(refused, Err(CloudError::DuplicateField { name: "rho".to_owned() }));
    let refused = Neighbours::search_at(&cloud(), &[1, 2]);
    assert_eq!(refused, Err(CloudError::NoSuchParticle { position: 1, particle: 2, count: 2 }));
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(cloud().check_separation(value), Err(CloudError::Separation { .. })), "{value}");
    }
}

#[test]
fn a_cloud_returns_what_it_was_given() {
    let supports = Support::PerParticle(vec![0.5, 0.75]);
    let cloud = Cloud::new(2, vec![[-0.0, 1.0, -0.0], [2.0, 3.0, 0.0]], vec![1.0, 2.0], supports.clone())
        .and_then(|cloud| cloud.with_periods([None, Some(4.0), None]))
        .and_then(|cloud| cloud.with_tags(vec![7, 8]))
        .and_then(|cloud| cloud.with_field("rho", vec![5.0, 6.0]))
        .expect("valid");
    assert_eq!((cloud.dimension(), cloud.len(), cloud.is_empty()), (2, 2, false));
    assert_eq!(cloud.positions(), [[0.0, 1.0, 0.0], [2.0, 3.0, 0.0]]);
    assert!(cloud.positions()[0][0].is_sign_positive(), "-0 is made 0");
    assert_eq!((cloud.volumes(), cloud.support(), cloud.support_of(1)), (&[1.0, 2.0][..], &supports, 0.75));
    assert_eq!((cloud.periods(), cloud.tags()), ([None, Some(4.0), None], &[7, 8][..]));
    assert_eq!(
        (cloud.field("rho"), cloud.field("u"), cloud.fields().len()),
        (Some(&[5.0, 6.0][..]), None, 1)
    );
}
