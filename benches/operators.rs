//! What an operator of the language costs compiled, against the same operator written by hand in Rust: F4 and S4 on the same
//! neighbour lists, 10⁵ particles of a jittered square lattice, R/Δ = 2.5, Wendland C2, one thread, the search not counted.
//! Both are timed in turn, and the medians, the least times and their ratios printed. Fails if their values differ.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed benchmark.
#![allow(clippy::needless_range_loop)] // Written by hand as one would, with indices.

use remainder::kernel::by_id;
use remainder::language::operators;
use remainder::measured::{Fields, Program};
use remainder::particles::{Cloud, Neighbours, Support};
use std::hint::black_box;
use std::time::Instant;

const PER_AXIS: usize = 316;
const ROUNDS: usize = 41;

fn main() {
    let cloud = jittered_square(PER_AXIS, 2.5);
    let lists = Neighbours::search(&cloud).unwrap();
    let u: Vec<f64> = cloud.positions().iter().map(|[x, y, _]| (9.0 * x).sin() * (7.0 * y).cos()).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    println!("{} particles, {} pairs, one thread", cloud.len(), lists.entry_count());
    println!("               by hand    compiled   compiled / by hand");
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for (id, by_hand) in [("F4", f4 as ByHand), ("S4", s4)] {
        if !asked.is_empty() && !asked.iter().any(|asked| asked == id) {
            continue;
        }
        let operator = operators::by_id(id).unwrap().operator().unwrap();
        let program = Program::new(&operator, &by_id("wendland-c2").unwrap(), 2).unwrap();
        let apply = || program.apply(&cloud, &lists, Fields::Scalar(black_box(&u))).unwrap();
        pool.install(|| {
            compare(id, &apply(), &by_hand(&cloud, &lists, &u));
            let (mut hand, mut compiled) = (Vec::new(), Vec::new());
            for _ in 0..ROUNDS {
                hand.push(time(|| by_hand(&cloud, &lists, black_box(&u))));
                compiled.push(time(apply));
            }
            for (name, of) in [("median", median as fn(&[f64]) -> f64), ("least", least)] {
                let (hand, compiled) = (of(&hand) * 1e3, of(&compiled) * 1e3);
                println!("{id:3} {name:6} {hand:8.3} ms {compiled:8.3} ms   {:.2}", compiled / hand);
            }
        });
    }
}

fn time(run: impl FnOnce() -> Vec<f64>) -> f64 {
    let start = Instant::now();
    black_box(run());
    start.elapsed().as_secs_f64()
}

fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// What the machine can do when nothing disturbs it.
fn least(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

fn compare(id: &str, compiled: &[f64], by_hand: &[f64]) {
    assert_eq!(compiled.len(), by_hand.len());
    let largest = by_hand.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for (place, (a, b)) in compiled.iter().zip(by_hand).enumerate() {
        assert!((a - b).abs() <= 1e-10 * largest, "{id}: value {place} is {a} compiled, {b} by hand");
    }
}

/// The unit box, periodic, each particle moved by up to a tenth of the spacing along each axis.
fn jittered_square(per_axis: usize, support: f64) -> Cloud {
    let spacing = 1.0 / per_axis as f64;
    let mut state = 1_u64;
    let mut jitter = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        0.2 * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
    };
    let mut positions = Vec::new();
    for (row, column) in (0..per_axis).flat_map(|row| (0..per_axis).map(move |column| (row, column))) {
        let (x, y) = (column as f64 + jitter(), row as f64 + jitter());
        positions.push([spacing * x, spacing * y, 0.0]);
    }
    let volumes = vec![spacing * spacing; positions.len()];
    Cloud::new(2, positions, volumes, Support::Uniform(support * spacing))
        .unwrap()
        .with_periods([Some(1.0), Some(1.0), None])
        .unwrap()
}

type ByHand = fn(&Cloud, &Neighbours, &[f64]) -> Vec<f64>;

/// W′/r of Wendland C2 in two dimensions: −20 σ (1 − r/R)³ / R⁴ with σ = 7/π.
struct Kernel {
    per_support: f64,
    factor: f64,
}

impl Kernel {
    fn new(support: f64) -> Self {
        Self { per_support: 1.0 / support, factor: -140.0 / (std::f64::consts::PI * support.powi(4)) }
    }

    #[inline]
    fn slope_over_r(&self, r: f64) -> f64 {
        let s = 1.0 - r * self.per_support;
        self.factor * s * s * s
    }
}

/// B of the symmetric tensor −Σ V r ∇W, given by xx, xy, yy.
#[inline]
fn renormalisation([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let inverse = 1.0 / (xx * yy - xy * xy);
    [-yy * inverse, xy * inverse, -xx * inverse]
}

/// Σ_j V_j (u_j − u_i) B_i · ∇W_ij.
fn f4(cloud: &Cloud, lists: &Neighbours, u: &[f64]) -> Vec<f64> {
    let (kernel, volumes) = (Kernel::new(cloud.support_of(0)), cloud.volumes());
    let mut values = Vec::with_capacity(2 * u.len());
    for i in 0..u.len() {
        let (mut gradient, mut moment) = ([0.0; 2], [0.0; 3]);
        for pair in lists.of(i) {
            let [x, y, _] = pair.r_ij;
            let j = pair.j as usize;
            let weight = volumes[j] * kernel.slope_over_r((x * x + y * y).sqrt());
            let (gx, gy) = (weight * x, weight * y);
            let difference = u[j] - u[i];
            gradient[0] += difference * gx;
            gradient[1] += difference * gy;
            moment[0] += x * gx;
            moment[1] += x * gy;
            moment[2] += y * gy;
        }
        let b = renormalisation(moment);
        values.push(b[0] * gradient[0] + b[1] * gradient[1]);
        values.push(b[1] * gradient[0] + b[2] * gradient[1]);
    }
    values
}

/// B̂_i : Σ_j 2 V_j ((u_i − u_j) / r − e · F4_i) e ∇W_ij, F4_i and the moments that B̂ and it need taken in the same pass.
fn s4(cloud: &Cloud, lists: &Neighbours, u: &[f64]) -> Vec<f64> {
    let (kernel, volumes) = (Kernel::new(cloud.support_of(0)), cloud.volumes());
    let mut values = Vec::with_capacity(u.len());
    for i in 0..u.len() {
        let (mut gradient, mut second) = ([0.0; 2], [0.0; 3]);
        // Σ V r ∇W; Σ V e e ∇W; Σ V r r ∇W; Σ V r e e ∇W, distinct components.
        let (mut rg, mut eeg, mut rrg, mut reeg) = ([0.0; 3], [0.0; 4], [0.0; 4], [0.0; 5]);
        for pair in lists.of(i) {
            let [x, y, _] = pair.r_ij;
            let j = pair.j as usize;
            let square = x * x + y * y;
            let weight = volumes[j] * kernel.slope_over_r(square.sqrt());
            let over = if square > 0.0 { weight / square } else { 0.0 };
            let (xx, xy, yy) = (x * x, x * y, y * y);
            let difference = u[j] - u[i];
            let (weighted, over_difference) = (weight * difference, over * difference);
            gradient[0] += weighted * x;
            gradient[1] += weighted * y;
            let (wxx, wxy, wyy) = (weight * xx, weight * xy, weight * yy);
            rg[0] += wxx;
            rg[1] += wxy;
            rg[2] += wyy;
            rrg[0] += wxx * x;
            rrg[1] += wxx * y;
            rrg[2] += wyy * x;
            rrg[3] += wyy * y;
            second[0] -= over_difference * xx;
            second[1] -= over_difference * xy;
            second[2] -= over_difference * yy;
            let (oxx, oxy, oyy) = (over * xx, over * xy, over * yy);
            eeg[0] += oxx * x;
            eeg[1] += oxx * y;
            eeg[2] += oyy * x;
            eeg[3] += oyy * y;
            reeg[0] += oxx * xx;
            reeg[1] += oxx * xy;
            reeg[2] += oxy * xy;
            reeg[3] += oxy * yy;
            reeg[4] += oyy * yy;
        }
        let b = renormalisation(rg);
        let slope = [b[0] * gradient[0] + b[1] * gradient[1], b[1] * gradient[0] + b[2] * gradient[1]];
        // Symmetric third moments: the component depends on how many of the indices are y.
        let mut system = [[0.0; 3]; 3];
        for (column, (a, c)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
            let left = [eeg[a + c], eeg[a + c + 1]];
            let corrected = [left[0] * b[0] + left[1] * b[1], left[0] * b[1] + left[1] * b[2]];
            for (row, (e, f)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                let entry = reeg[a + c + e + f] + corrected[0] * rrg[e + f] + corrected[1] * rrg[e + f + 1];
                system[row][column] = if a == c { entry } else { 2.0 * entry };
            }
        }
        let hat = solve_3(system, [-1.0, 0.0, -1.0]);
        let [xx, xy, yy] =
            std::array::from_fn(|n| 2.0 * (second[n] - eeg[n] * slope[0] - eeg[n + 1] * slope[1]));
        values.push(hat[0] * xx + 2.0 * hat[1] * xy + hat[2] * yy);
    }
    values
}

/// Elimination with partial pivoting.
#[inline]
fn solve_3(mut a: [[f64; 3]; 3], mut b: [f64; 3]) -> [f64; 3] {
    for column in 0..3 {
        let mut pivot = column;
        for row in column + 1..3 {
            if a[row][column].abs() > a[pivot][column].abs() {
                pivot = row;
            }
        }
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..3 {
            let factor = a[row][column] / a[column][column];
            for k in column..3 {
                a[row][k] -= factor * a[column][k];
            }
            b[row] -= factor * b[column];
        }
    }
    for row in (0..3).rev() {
        for k in row + 1..3 {
            b[row] -= a[row][k] * b[k];
        }
        b[row] /= a[row][row];
    }
    b
}
