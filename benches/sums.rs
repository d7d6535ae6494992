//! Lattice sums in process: a certified 50-digit sum over a square lattice at R/Δ = 32, and what it is made of; the sums
//! over pairs that sampling rests on. `just bench-sums` puts the same 50-digit sum by python-flint and mpmath beside it.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use divan::{Bencher, black_box};
use remainder::exact::int;
use remainder::kernel::{Kernel, by_id};
use remainder::particles::{Lattice, VolumeRule, lattice_by_id};
use remainder::sums::{LatticeSums, Moment, PairSums};

fn main() {
    divan::main();
}

fn subject() -> (Kernel, Lattice) {
    (by_id("wendland-c2").unwrap(), lattice_by_id("square").unwrap())
}

/// 50 digits and a guard: 50 log₂ 10 + 40.
const BITS: u32 = 210;

#[divan::bench(args = ["sum_w", "b_inverse", "sum_ddw"])]
fn certified_50_digits(bencher: Bencher<'_, '_>, name: &str) {
    let (kernel, lattice) = subject();
    let moment = Moment::by_name(name).unwrap();
    let component = &moment.components(2)[0];
    bencher.bench(|| {
        let sums = LatticeSums::new(black_box(&kernel), &lattice, &int(32), &[moment], 64).unwrap();
        let enclosed =
            sums.enclose(&int(32), std::slice::from_ref(component), VolumeRule::Constant, BITS).unwrap();
        assert!(enclosed[0].radius_is_below(168));
        enclosed
    });
}

#[divan::bench]
fn gathering_the_shells(bencher: Bencher<'_, '_>) {
    let (kernel, lattice) = subject();
    bencher.bench(|| {
        LatticeSums::new(black_box(&kernel), &lattice, &int(32), &[Moment::default()], 64).unwrap()
    });
}

#[divan::bench(args = [1, 4])]
fn pair_sums_up_to_p(bencher: Bencher<'_, '_>, p: u8) {
    let (kernel, lattice) = subject();
    let moments: Vec<Moment> = (0..=p).map(|p| Moment::new(p, 1).unwrap()).collect();
    let sums = PairSums::<f64>::new(&kernel, 2, &moments);
    let sites = lattice.sites_within(16.0);
    bencher.counter(divan::counter::ItemsCount::new(sites.len())).bench(|| {
        let mut accumulator = sums.start();
        for site in &sites {
            sums.add(&mut accumulator, site.position.map(|x| -x / 16.0), 1.0 / 256.0);
        }
        sums.finish(accumulator)
    });
}
