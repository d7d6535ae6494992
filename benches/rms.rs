//! RMS errors without samples: the linearised one aimed at under 10 ms in 2-D for R/Δ ≤ 4, the finite one at under 1 s.

#![allow(clippy::unwrap_used)] // A failed unwrap is a failed benchmark.

use divan::Bencher;
use remainder::derived::{Setting, finite, linearised};
use remainder::language::{Coefficient, Subject};
use remainder::particles::{Disorder, VolumeRule, lattice_by_id};
use remainder::{kernel, sums::Moment};

fn main() {
    divan::main();
}

#[divan::bench(args = [VolumeRule::Constant, VolumeRule::NumberDensity], consts = [315, 400])]
fn linearised_f4_square<const SUPPORT: u32>(bencher: Bencher, rule: &VolumeRule) {
    let (kernel, lattice) = (kernel::by_id("quintic-spline").unwrap(), lattice_by_id("square").unwrap());
    let disorder = Disorder::parse("canonical:0.0625").unwrap();
    let subject = Subject::Coefficient(Coefficient::new("F4", 2).unwrap());
    let support_over_dx = f64::from(SUPPORT) / 100.0;
    let setting =
        Setting { kernel: &kernel, lattice: &lattice, disorder: &disorder, support_over_dx, rule: *rule };
    bencher.bench(|| linearised(&setting, &subject).unwrap());
}

#[divan::bench(args = [("line", "box:0.4"), ("square", "box:0.4"), ("square", "canonical:0.1"), ("simple-cubic", "canonical:0.1"), ("simple-cubic", "box:0.4")], sample_count = 5)]
fn finite_sum_dw(bencher: Bencher, (lattice, law): (&str, &str)) {
    let (kernel, lattice) = (kernel::by_id("wendland-c2").unwrap(), lattice_by_id(lattice).unwrap());
    let disorder = Disorder::parse(law).unwrap();
    let setting = Setting {
        kernel: &kernel,
        lattice: &lattice,
        disorder: &disorder,
        support_over_dx: 2.6,
        rule: VolumeRule::Constant,
    };
    let moment = Moment::by_name("sum_dw").unwrap();
    bencher.bench(|| finite(&setting, moment).unwrap());
}
