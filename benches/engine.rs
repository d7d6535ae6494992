//! What the engine takes for each set of moments: 20 000 particles in 2-D, about 21 neighbours each. Sums of p ≤ 1 must not pay
//! for those of p ≤ 4.

#![allow(clippy::unwrap_used)] // A failed unwrap is a failed bench.

use divan::Bencher;
use divan::counter::ItemsCount;
use remainder::kernel::by_id;
use remainder::sums::{Engine, Moment, Path, Points};

fn main() {
    divan::main();
}

const PER_AXIS: usize = 142;

fn positions() -> Vec<[f64; 3]> {
    let dx = 1.0 / PER_AXIS as f64;
    // Places that fill a lattice's cell evenly without random numbers.
    let shift = |index: usize, step: f64| 0.4 * ((index as f64 * step).fract() - 0.5);
    let place = |index: usize| {
        let (x, y) = ((index / PER_AXIS) as f64, (index % PER_AXIS) as f64);
        [(x + shift(index, 0.754_877_666)) * dx, (y + shift(index, 0.569_840_291)) * dx, 0.0]
    };
    (0..PER_AXIS * PER_AXIS).map(place).collect()
}

fn bench(bencher: Bencher<'_, '_>, kernel: &str, moments: &[Moment], path: Path) {
    let positions = positions();
    let weights = vec![1.0 / positions.len() as f64; positions.len()];
    let points = Points { positions: &positions, weights: &weights, fields: &[] };
    let support = 2.5 / PER_AXIS as f64;
    let engine = Engine::for_moments(&by_id(kernel).unwrap(), 2, support, moments).unwrap();
    let mut engine = engine.on_path(path);
    let mut out = vec![0.0; positions.len() * engine.columns()];
    engine.run(&points, &mut out).unwrap();
    bencher.counter(ItemsCount::new(engine.pairs())).bench_local(|| engine.run(&points, &mut out).unwrap());
}

#[divan::bench(args = [0, 1, 2, 4, 6])]
fn gradients_up_to_p(bencher: Bencher<'_, '_>, p: u8) {
    let moments: Vec<Moment> = (0..=p).map(|p| Moment::new(p, 1).unwrap()).collect();
    bench(bencher, "wendland-c2", &moments, Path::best());
}

#[divan::bench(args = [0, 1, 2])]
fn derivatives(bencher: Bencher<'_, '_>, q: u8) {
    bench(bencher, "wendland-c2", &[Moment::new(1, q).unwrap()], Path::best());
}

#[divan::bench(args = ["wendland-c2", "wendland-c6", "cubic-spline", "quintic-spline", "gaussian"])]
fn kernels(bencher: Bencher<'_, '_>, kernel: &str) {
    bench(bencher, kernel, &[Moment::b_inverse()], Path::best());
}

#[divan::bench(args = ["portable", "avx2", "avx512"])]
fn paths(bencher: Bencher<'_, '_>, path: &str) {
    let path = match path {
        "portable" => Path::Portable,
        "avx2" => Path::Avx2,
        _ => Path::Avx512,
    };
    bench(bencher, "wendland-c2", &[Moment::b_inverse()], path);
}
