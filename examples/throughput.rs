//! How fast moment sums are taken: `cargo run --release --example throughput -- 2d1e6 --threads 2 [--shuffle]`.
//!
//! The workload of a program written with numba, beside which `just bench-peers` runs this one: a lattice in the unit box,
//! each coordinate displaced by up to ±0.2 Δ, weights Δ^D (1 ± 0.05), Wendland C2. Each particle gets Σωr^pG of p = 0 (with
//! G = W) and p = 1 … 4 (with G = W′/r), the inverse of Σωr∇W, three forms of a field's gradient, and a Laplacian: 25
//! columns in 2-D, 51 in 3-D. Times start from raw positions. What is computed is compared with a plain double loop.

use remainder::kernel::by_id;
use remainder::sums::{Engine, Factor, Path, Points, RadialSum, SumError};
use std::f64::consts::PI;
use std::time::Instant;

struct Options {
    case: String,
    threads: usize,
    runs: usize,
    shuffle: bool,
    path: Path,
}

struct Case {
    dimension: usize,
    per_axis: usize,
    support_over_dx: f64,
}

fn case(name: &str) -> Option<Case> {
    let (dimension, per_axis, support_over_dx) = match name {
        "2d1e4" => (2, 100, 2.5),
        "2d1e5" => (2, 316, 2.5),
        "2d1e6" => (2, 1000, 2.5),
        "2d1e7" => (2, 3162, 2.5),
        "3d1e5" => (3, 46, 2.0),
        "3d1e6" => (3, 100, 2.0),
        _ => return None,
    };
    Some(Case { dimension, per_axis, support_over_dx })
}

fn options() -> Result<Options, String> {
    let mut options =
        Options { case: String::new(), threads: 2, runs: 7, shuffle: false, path: Path::best() };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number = || arguments.next().and_then(|n| n.parse().ok()).ok_or(format!("{argument} N"));
        match argument.as_str() {
            "--threads" => options.threads = number()?,
            "--runs" => options.runs = number()?,
            "--shuffle" => options.shuffle = true,
            "--path" => {
                options.path = match arguments.next().as_deref() {
                    Some("portable") => Path::Portable,
                    Some("avx2") => Path::Avx2,
                    Some("avx512") => Path::Avx512,
                    _ => return Err("--path portable|avx2|avx512".into()),
                }
            }
            _ => options.case = argument,
        }
    }
    Ok(options)
}

/// SplitMix64: a number in [0, 1) for each state.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

struct Workload {
    positions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    field: Vec<f64>,
}

fn workload(case: &Case, shuffle: bool) -> Workload {
    let dx = 1.0 / case.per_axis as f64;
    let mut random = Random(1);
    let count = case.per_axis.pow(case.dimension as u32);
    let mut particles: Vec<([f64; 3], f64, f64)> = (0..count)
        .map(|index| {
            let mut x = [0.0; 3];
            let mut rest = index;
            for x in x[..case.dimension].iter_mut().rev() {
                *x = ((rest % case.per_axis) as f64 + 0.5 + 0.4 * (random.unit() - 0.5)) * dx;
                rest /= case.per_axis;
            }
            let weight = dx.powi(case.dimension as i32) * (1.0 + 0.1 * (random.unit() - 0.5));
            let along = if case.dimension == 3 { (PI * x[2]).cos() } else { 1.0 };
            (x, weight, (2.0 * PI * x[0]).sin() * (2.0 * PI * x[1]).cos() * along)
        })
        .collect();
    if shuffle {
        for index in (1..count).rev() {
            particles.swap(index, (random.next() % (index as u64 + 1)) as usize);
        }
    }
    Workload {
        positions: particles.iter().map(|p| p.0).collect(),
        weights: particles.iter().map(|p| p.1).collect(),
        field: particles.iter().map(|p| p.2).collect(),
    }
}

fn wanted() -> Vec<RadialSum> {
    let sum = |positions, radial, factor| RadialSum { positions, radial, factor };
    let moments = (1..=4).map(|p| sum(p, 1, Factor::One));
    let of_field = [sum(1, 1, Factor::Difference(0)), sum(0, 1, Factor::Difference(0))];
    [sum(0, 0, Factor::One)].into_iter().chain(moments).chain(of_field).collect()
}

/// The columns from the sums: S0, S1, …, S4, ∇ and L of the field.
fn finish<const D: usize>(f: f64, sums: &[f64], row: &mut [f64]) {
    let moments = sums.len() - D - 1;
    for (slot, sum) in row.iter_mut().zip(&sums[..moments]) {
        *slot = *sum;
    }
    let (first, second) = (&sums[1..=D], &sums[1 + D..]);
    let (gradient, laplacian) = (&sums[moments..moments + D], sums[moments + D]);
    let mut rest = row[moments..].iter_mut();
    let mut put = |value: f64| {
        if let Some(slot) = rest.next() {
            *slot = value;
        }
    };
    let mut inverse = [[0.0; D]; D];
    if D == 2 {
        let [xx, xy, yy] = [second[0], second[1], second[2]];
        let over = 1.0 / (xx * yy - xy * xy);
        (inverse[0][0], inverse[0][1], inverse[1][1]) = (yy * over, -xy * over, xx * over);
        inverse[1][0] = inverse[0][1];
    } else {
        let [xx, xy, xz, yy, yz, zz] = [second[0], second[1], second[2], second[3], second[4], second[5]];
        let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
        let over = 1.0 / (xx * a + xy * b + xz * c);
        let lower = [(xx * zz - xz * xz) * over, (xy * xz - xx * yz) * over, (xx * yy - xy * xy) * over];
        let rows =
            [[a * over, b * over, c * over], [b * over, lower[0], lower[1]], [c * over, lower[1], lower[2]]];
        for (own, row) in inverse.iter_mut().zip(rows) {
            own.copy_from_slice(&row[..D]);
        }
    }
    for a in 0..D {
        inverse[a][a..].iter().for_each(|value| put(*value));
    }
    gradient.iter().for_each(|g| put(*g));
    gradient.iter().zip(first).for_each(|(g, s)| put(g + 2.0 * f * s));
    for row in &inverse {
        put(-row.iter().zip(gradient).map(|(b, g)| b * g).sum::<f64>());
    }
    put(-2.0 * laplacian);
}

/// The sums of one particle over all others, one after another.
fn plain(case: &Case, work: &Workload, i: usize) -> Vec<f64> {
    let d = case.dimension;
    let support = case.support_over_dx / case.per_axis as f64;
    let alpha = if d == 2 { 7.0 / (PI * support.powi(2)) } else { 21.0 / (2.0 * PI * support.powi(3)) };
    let mut sums: [Vec<f64>; 6] =
        std::array::from_fn(|p| if p == 5 { vec![0.0; d + 1] } else { vec![0.0; d.pow(p as u32)] });
    for j in 0..work.weights.len() {
        let r: Vec<f64> = (0..d).map(|a| work.positions[i][a] - work.positions[j][a]).collect();
        let q = r.iter().map(|x| x * x).sum::<f64>().sqrt() / support;
        if q >= 1.0 {
            continue;
        }
        let g = -20.0 * alpha / support.powi(2) * (1.0 - q).powi(3) * work.weights[j];
        sums[0][0] += alpha * (1.0 - q).powi(4) * (1.0 + 4.0 * q) * work.weights[j];
        for (p, sums) in sums.iter_mut().enumerate().take(5).skip(1) {
            for (index, sum) in sums.iter_mut().enumerate() {
                let axes = (0..p as u32).map(|place| index / d.pow(place) % d);
                *sum += axes.map(|axis| r[axis]).product::<f64>() * g;
            }
        }
        let difference = work.field[j] - work.field[i];
        for a in 0..d {
            sums[5][a] += difference * g * r[a];
        }
        sums[5][d] += difference * g;
    }
    // Of each tensor, the components with sorted indices.
    let mut sorted = Vec::new();
    for (p, sums) in sums.iter().enumerate().take(5) {
        for (index, sum) in sums.iter().enumerate() {
            let axes: Vec<usize> = (0..p as u32).rev().map(|place| index / d.pow(place) % d).collect();
            if axes.is_sorted() {
                sorted.push(*sum);
            }
        }
    }
    sorted.extend(&sums[5]);
    sorted
}

fn run(engine: &mut Engine, work: &Workload, columns: usize, out: &mut [f64]) -> Result<(), SumError> {
    let points = Points { positions: &work.positions, weights: &work.weights, fields: &[&work.field] };
    if columns == 25 {
        engine.run_with(&points, columns, out, |i, sums, row| finish::<2>(i.field(0), sums, row))
    } else {
        engine.run_with(&points, columns, out, |i, sums, row| finish::<3>(i.field(0), sums, row))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = options()?;
    let case = case(&options.case).ok_or("give one of 2d1e4, 2d1e5, 2d1e6, 2d1e7, 3d1e5, 3d1e6")?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let work = workload(&case, options.shuffle);
    let count = work.weights.len();
    let (support, columns) =
        (case.support_over_dx / case.per_axis as f64, if case.dimension == 2 { 25 } else { 51 });
    let kernel = by_id("wendland-c2")?;
    let engine = Engine::for_radial_sums(&kernel, case.dimension, support, &wanted())?;
    let mut engine = engine.on_path(options.path);
    let mut out = vec![0.0; count * columns];
    let mut times = Vec::new();
    for _ in 0..options.runs + 2 {
        let start = Instant::now();
        pool.install(|| run(&mut engine, &work, columns, &mut out))?;
        times.push(start.elapsed().as_secs_f64());
    }
    let mut sorted = times.split_off(2);
    sorted.sort_by(f64::total_cmp);
    let seconds = sorted[sorted.len() / 2];

    let mut worst: f64 = 0.0;
    let step = (count / 40).max(1);
    for i in (0..count).step_by(step) {
        let expected = plain(&case, &work, i);
        let mut row = vec![0.0; columns];
        match case.dimension {
            2 => finish::<2>(work.field[i], &expected, &mut row),
            _ => finish::<3>(work.field[i], &expected, &mut row),
        }
        // Relative to the largest of its tensor: what cancels in one sum does not make it wrong.
        let ends = if case.dimension == 2 {
            vec![0, 1, 3, 6, 10, 15, 18, 20, 22, 24, 25]
        } else {
            vec![0, 1, 4, 10, 20, 35, 41, 44, 47, 50, 51]
        };
        for bounds in ends.windows(2) {
            let (own, other) = (&out[i * columns..][bounds[0]..bounds[1]], &row[bounds[0]..bounds[1]]);
            let scale = other.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let apart = own.iter().zip(other).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            worst = worst.max(apart / scale);
        }
    }
    if worst.is_nan() || worst > 1e-9 {
        return Err(format!("the sums differ from a plain loop by {worst:e}").into());
    }
    let pairs = engine.pairs() - count as u64;
    let record = serde_json::json!({
        "tool": format!("remainder {}", env!("CARGO_PKG_VERSION")),
        "path": format!("{:?}", engine.path()),
        "threads": options.threads,
        "case": options.case,
        "shuffled": options.shuffle,
        "particles": count,
        "directed_pairs": pairs,
        "seconds": seconds,
        "ns_per_pair": seconds / pairs as f64 * 1e9,
        "runs": sorted,
        "checksum": out.iter().map(|x| x.abs()).sum::<f64>(),
        "bytes_per_particle": (engine.bytes() + out.len() * 8) as f64 / count as f64,
        "worst_difference": worst,
    });
    println!("{record}");
    Ok(())
}
