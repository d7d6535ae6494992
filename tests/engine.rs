//! The engine against a plain double loop with the kernel as the `kernel` layer gives it (modules `sums::engine` and
//! `kernel::evaluate`), and what must not change a bit: threads, instructions, the order of the particles.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::kernel::{Evaluator, Kernel, by_id, catalogue};
use remainder::sums::{Engine, Factor, MAX_POSITIONS, Moment, Path, Points, RadialSum, SumError};

/// Rounding of sums of a few hundred terms, relative to the sum of their magnitudes.
const ROUNDING: f64 = 1e-13;

struct Cloud {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    field: Vec<f64>,
}

/// Some particles in a box, a third of them in a cluster.
fn cloud(dimension: usize, count: usize, box_over_support: f64, seed: u64) -> Cloud {
    let mut state = seed;
    let mut unit = || {
        // SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut cloud = Cloud { positions: Vec::new(), weights: Vec::new(), field: Vec::new() };
    for index in 0..count {
        let scale = if index % 3 == 0 { 0.3 } else { box_over_support };
        cloud.positions.push(std::array::from_fn(|a| if a < dimension { scale * unit() - 0.7 } else { 0.0 }));
        cloud.weights.push(unit() - 0.2);
        cloud.field.push(unit());
    }
    cloud
}

impl Cloud {
    fn points<'a>(&'a self, fields: &'a [&'a [f64]]) -> Points<'a> {
        Points { positions: &self.positions, weights: &self.weights, fields }
    }
}

/// What a row of the result should be, and the sum of magnitudes behind each number.
fn plain(
    kernel: &Kernel,
    dimension: usize,
    support: f64,
    moments: &[Moment],
    cloud: &Cloud,
    i: usize,
) -> (Vec<f64>, Vec<f64>) {
    let evaluator = Evaluator::<f64>::new(kernel, dimension, 2);
    let components: Vec<_> = moments.iter().flat_map(|moment| moment.components(dimension)).collect();
    let (mut sums, mut sizes) = (vec![0.0; components.len()], vec![0.0; components.len()]);
    for (j, x) in cloud.positions.iter().enumerate() {
        let r: [f64; 3] = std::array::from_fn(|a| cloud.positions[i][a] - x[a]);
        let square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        if square >= support * support {
            continue;
        }
        let g = evaluator.radial(square.sqrt() / support);
        for (index, component) in components.iter().enumerate() {
            for term in &component.terms {
                let powers = term.monomial.powers;
                let product: f64 = (0..3).map(|a| r[a].powi(i32::from(powers[a]))).product();
                let unit = support.powi(-(dimension as i32) - 2 * term.radial as i32);
                let value = term.coefficient as f64 * product * g[term.radial] * unit * cloud.weights[j];
                sums[index] += value;
                sizes[index] += value.abs();
            }
        }
    }
    (sums, sizes)
}

fn run(engine: &mut Engine, cloud: &Cloud, threads: usize) -> Vec<f64> {
    let mut out = vec![0.0; cloud.weights.len() * engine.columns()];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let fields = [&cloud.field[..]];
    pool.install(|| engine.run(&cloud.points(&fields), &mut out)).unwrap();
    out
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn check(kernel: &Kernel, dimension: usize, support: f64, moments: &[Moment], cloud: &Cloud, step: usize) {
    let mut engine = Engine::for_moments(kernel, dimension, support, moments).unwrap();
    let out = run(&mut engine, cloud, 2);
    let columns = engine.columns();
    for i in (0..cloud.weights.len()).step_by(step) {
        let (sums, sizes) = plain(kernel, dimension, support, moments, cloud, i);
        for (column, (sum, size)) in sums.iter().zip(&sizes).enumerate() {
            let apart = (out[i * columns + column] - sum).abs();
            assert!(
                apart <= ROUNDING * (size + 1e-300),
                "{} {dimension}-D particle {i} column {column}: {apart:e} of {size:e}",
                kernel.id()
            );
        }
    }
}

#[test]
fn all_moments_of_all_kernels_are_those_of_a_plain_loop() {
    // Planted: y for z in `raise`; neighbours not filled up with zeros.
    for kernel in catalogue() {
        for dimension in 1..=3 {
            let cloud = cloud(dimension, 150, 3.0, 5 + dimension as u64);
            check(&kernel, dimension, 0.8, &Moment::all(MAX_POSITIONS), &cloud, 13);
        }
    }
}

#[test]
fn paths_threads_and_order_change_no_bit() {
    // Planted: lanes added in another order on AVX2; particles in one place sorted by their number.
    for dimension in 1..=3 {
        let mut cloud = cloud(dimension, 2000, 8.0, 17);
        // Some in one place, with other weights and fields.
        for index in (0..2000).step_by(40) {
            cloud.positions[index + 1] = cloud.positions[index];
        }
        for id in ["wendland-c2", "cubic-spline", "gaussian"] {
            let engine =
                || Engine::for_moments(&by_id(id).unwrap(), dimension, 0.6, &Moment::all(3)).unwrap();
            let reference = run(&mut engine().on_path(Path::Portable), &cloud, 1);
            for path in [Path::Portable, Path::Avx2, Path::Avx512] {
                for threads in [1, 2, 3] {
                    let out = run(&mut engine().on_path(path), &cloud, threads);
                    assert_eq!(bits(&out), bits(&reference), "{id} {dimension}-D {path:?} {threads} threads");
                }
            }
            let count = cloud.weights.len();
            let places: Vec<usize> = (0..count).map(|i| i * 1237 % count).collect();
            let shuffled = Cloud {
                positions: places.iter().map(|i| cloud.positions[*i]).collect(),
                weights: places.iter().map(|i| cloud.weights[*i]).collect(),
                field: places.iter().map(|i| cloud.field[*i]).collect(),
            };
            let mut engine = engine();
            let out = run(&mut engine, &shuffled, 2);
            let columns = engine.columns();
            for (place, i) in places.iter().enumerate() {
                let (own, other) = (&out[place * columns..][..columns], &reference[i * columns..][..columns]);
                assert_eq!(bits(own), bits(other), "{id} {dimension}-D particle {i}");
            }
        }
    }
}

#[test]
fn a_field_enters_by_its_differences() {
    let (kernel, support) = (by_id("wendland-c4").unwrap(), 0.9);
    let cloud = cloud(2, 300, 3.0, 3);
    let wanted = |factor| {
        [RadialSum { positions: 1, radial: 1, factor }, RadialSum { positions: 0, radial: 1, factor }]
    };
    let mut engine = Engine::for_radial_sums(&kernel, 2, support, &wanted(Factor::Difference(0))).unwrap();
    let out = run(&mut engine, &cloud, 2);
    for i in (0..300).step_by(17) {
        let of_i = Cloud {
            positions: cloud.positions.clone(),
            weights: cloud.weights.iter().zip(&cloud.field).map(|(w, f)| w * (f - cloud.field[i])).collect(),
            field: Vec::new(),
        };
        let mut plain = Engine::for_radial_sums(&kernel, 2, support, &wanted(Factor::One)).unwrap();
        let mut expected = vec![0.0; 300 * 3];
        plain.run(&of_i.points(&[]), &mut expected).unwrap();
        for column in 0..3 {
            let (own, other) = (out[3 * i + column], expected[3 * i + column]);
            assert!((own - other).abs() < 1e-10 * (1.0 + other.abs()), "particle {i}: {own} {other}");
        }
    }
}

#[test]
fn what_is_made_of_sums_sees_the_particle_they_belong_to() {
    // Planted: the place among the sorted particles for the one among those given; the weight for the field.
    let (kernel, support) = (by_id("wendland-c2").unwrap(), 0.7);
    for dimension in 1..=3 {
        let cloud = cloud(dimension, 500, 4.0, 31);
        let wanted = [RadialSum { positions: 0, radial: 0, factor: Factor::Difference(0) }];
        let mut engine = Engine::for_radial_sums(&kernel, dimension, support, &wanted).unwrap();
        let mut rows = vec![0.0; 500 * 6];
        let made = engine.run_with(&cloud.points(&[&cloud.field]), 6, &mut rows, |i, _, row| {
            row[..3].copy_from_slice(&[i.index() as f64, i.weight(), i.field(0)]);
            (0..dimension).for_each(|axis| row[3 + axis] = i.position(axis));
        });
        made.unwrap();
        for (i, row) in rows.chunks(6).enumerate() {
            assert_eq!(row[..3], [i as f64, cloud.weights[i], cloud.field[i]]);
            assert_eq!(row[3..], cloud.positions[i], "{dimension}-D");
        }
    }
}

/// Two of four fields, more than are written out when compiling.
#[test]
fn fields_enter_on_every_path_alike() {
    let kernel = by_id("cubic-spline").unwrap();
    for dimension in 1..=3 {
        let cloud = cloud(dimension, 700, 6.0, 23);
        let field = |step: f64| -> Vec<f64> { (0..700).map(|i| (f64::from(i) * step).fract()).collect() };
        let fields = [0.31, 0.83, 0.57, 0.19].map(field);
        let fields: Vec<&[f64]> = fields.iter().map(Vec::as_slice).collect();
        let sum = |positions, factor| RadialSum { positions, radial: 1, factor };
        let one = |number: usize| [sum(1, Factor::Difference(number)), sum(0, Factor::Difference(number))];
        let of = |wanted: &[RadialSum], fields: &[&[f64]], path| {
            let engine = Engine::for_radial_sums(&kernel, dimension, 0.8, wanted).unwrap();
            let mut engine = engine.on_path(path);
            let mut out = vec![0.0; 700 * engine.columns()];
            engine.run(&cloud.points(fields), &mut out).unwrap();
            out
        };
        let wanted = [one(0), one(2)].concat();
        let reference = of(&wanted, &fields, Path::Portable);
        for path in [Path::Avx2, Path::Avx512] {
            assert_eq!(bits(&of(&wanted, &fields, path)), bits(&reference), "{dimension}-D {path:?}");
        }
        // Each by itself, as the only field of a run.
        let width = dimension + 1;
        for (place, number) in [0, 2].into_iter().enumerate() {
            let alone = of(&one(0), &[fields[number]], Path::best());
            for (row, own) in reference.chunks(2 * width).zip(alone.chunks(width)) {
                assert_eq!(bits(&row[place * width..][..width]), bits(own), "{dimension}-D field {number}");
            }
        }
    }
}

#[test]
fn far_outliers_cost_neither_memory_nor_neighbours() {
    let moments = [Moment::default(), Moment::b_inverse()];
    for dimension in 1..=3 {
        let mut cloud = cloud(dimension, 900, 6.0, 23);
        for (index, far) in [1e9, -1e30, 1e140, 3e5].into_iter().enumerate() {
            cloud.positions[100 * index + 1][index % dimension] = far;
        }
        // Two in one place, far away.
        cloud.positions[850] = cloud.positions[101];
        let kernel = by_id("cubic-spline").unwrap();
        check(&kernel, dimension, 0.5, &moments, &cloud, 7);
        let mut engine = Engine::for_moments(&kernel, dimension, 0.5, &moments).unwrap();
        run(&mut engine, &cloud, 2);
        assert!(engine.bytes() < 900 * 400, "{} bytes", engine.bytes());
    }
}

#[test]
fn a_particle_at_r_is_no_neighbour_and_one_just_inside_is() {
    // The cut Gaussian jumps at R, so that a neighbour counted there would show.
    let kernel = by_id("gaussian").unwrap();
    let mut engine = Engine::for_moments(&kernel, 1, 0.5, &[Moment::default()]).unwrap();
    let cloud = |x: f64| Cloud {
        positions: vec![[0.0; 3], [x, 0.0, 0.0]],
        weights: vec![1.0; 2],
        field: vec![0.0; 2],
    };
    run(&mut engine, &cloud(0.5), 1);
    assert_eq!(engine.pairs(), 2);
    run(&mut engine, &cloud(0.5_f64.next_down()), 1);
    assert_eq!(engine.pairs(), 4);
    let single = Cloud { positions: vec![[0.3; 3]], weights: vec![2.0], field: vec![0.0] };
    assert_eq!(run(&mut engine, &single, 1), [2.0 * kernel_at_origin(&kernel)]);
    let nobody = Cloud { positions: vec![], weights: vec![], field: vec![] };
    assert!(run(&mut engine, &nobody, 1).is_empty());
}

fn kernel_at_origin(kernel: &Kernel) -> f64 {
    Evaluator::<f64>::new(kernel, 1, 0).radial(0.0)[0] * 2.0
}

#[test]
fn every_pair_is_found_once() {
    // Planted: a window opened too late.
    for dimension in 1..=3 {
        for support in [0.05, 0.4, 20.0] {
            let cloud = cloud(dimension, 700, 4.0, 41);
            let mut expected = 0;
            for x in &cloud.positions {
                let near = cloud.positions.iter().filter(|y| {
                    let r: [f64; 3] = std::array::from_fn(|a| x[a] - y[a]);
                    r[0] * r[0] + r[1] * r[1] + r[2] * r[2] < support * support
                });
                expected += near.count() as u64;
            }
            for path in [Path::Portable, Path::Avx2, Path::Avx512] {
                let engine = Engine::for_moments(
                    &by_id("wendland-c2").unwrap(),
                    dimension,
                    support,
                    &[Moment::default()],
                );
                let mut engine = engine.unwrap().on_path(path);
                run(&mut engine, &cloud, 2);
                assert_eq!(engine.pairs(), expected, "{dimension}-D R = {support} {path:?}");
            }
        }
    }
}

#[test]
fn what_is_not_finite_is_refused_with_the_particle_named() {
    let kernel = by_id("wendland-c2").unwrap();
    let mut engine = Engine::for_moments(&kernel, 2, 0.5, &[Moment::default()]).unwrap();
    let good = cloud(2, 10, 2.0, 1);
    let mut out = vec![0.0; 10];
    let mut refused = |change: &dyn Fn(&mut Cloud)| {
        let mut cloud = Cloud {
            positions: good.positions.clone(),
            weights: good.weights.clone(),
            field: good.field.clone(),
        };
        change(&mut cloud);
        engine.run(&cloud.points(&[]), &mut out).unwrap_err()
    };
    assert_eq!(
        refused(&|cloud| cloud.positions[7][1] = f64::INFINITY),
        SumError::NotFinite { what: "y coordinate".into(), particle: 7, value: f64::INFINITY }
    );
    assert_eq!(
        refused(&|cloud| cloud.weights[3] = f64::NEG_INFINITY).to_string(),
        "particle 3: the weight is -inf; remove the particle, or repair the input or its unit"
    );
    assert!(matches!(
        refused(&|cloud| cloud.positions[9][0] = f64::NAN),
        SumError::NotFinite { particle: 9, .. }
    ));
    assert!(matches!(
        refused(&|cloud| cloud.positions[2][0] = 1e151),
        SumError::NotFinite { particle: 2, .. }
    ));
    assert!(matches!(
        refused(&|cloud| {
            cloud.weights.pop();
        }),
        SumError::Length { found: 9, expected: 10, .. }
    ));
    assert!(matches!(Engine::for_moments(&kernel, 4, 0.5, &[]), Err(SumError::Dimension { found: 4 })));
    for support in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(Engine::for_moments(&kernel, 2, support, &[]), Err(SumError::SupportLength { .. })));
    }
    let beyond = RadialSum { positions: 9, radial: 1, factor: Factor::One };
    assert!(matches!(Engine::for_radial_sums(&kernel, 2, 0.5, &[beyond]), Err(SumError::Moment { .. })));
}
