//! `derived::RegularOrder` and `derived::DisorderOrder` against exact lattice sums and against what was measured.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use remainder::derived::RegularOrder;
use remainder::exact::{Rational, parse_rational, ratio, rational_to_f64};
use remainder::kernel::{self, Kernel};
use remainder::particles::{Lattice, PointGroup, VolumeRule, lattice_by_id};
use remainder::sums::{LatticeSums, Moment, Reduction};

/// S − continuum limit of the free components by `sums`, in units of h^{p−q}.
struct Exact {
    sums: LatticeSums,
    kernel: Kernel,
    reduction: Reduction,
    dimension: usize,
    moment: Moment,
}

impl Exact {
    fn new(kernel: &Kernel, lattice: &Lattice, moment: Moment, largest: &Rational) -> Self {
        Self {
            sums: LatticeSums::new(kernel, lattice, largest, &[moment], 2048).unwrap(),
            kernel: kernel.clone(),
            reduction: Reduction::of(moment, lattice, &PointGroup::of(lattice)),
            dimension: lattice.dimension(),
            moment,
        }
    }

    fn at(&self, support: &Rational) -> Vec<f64> {
        let h = support / self.kernel.support_over_h();
        let unit = num_traits::pow::Pow::pow(&h, self.moment.length_power());
        let free = self.reduction.free();
        let sums = self.sums.enclose(support, &free, VolumeRule::Constant, 128).unwrap();
        let values = free.iter().zip(sums).map(|(component, sum)| {
            let limit = self.kernel.continuum_limit(self.dimension, &component.terms, 128).enclose(128);
            rational_to_f64(&(sum.midpoint() / &unit - limit.midpoint()))
        });
        values.collect()
    }
}

const CASES: &[(&str, &str, &[&str])] = &[
    ("wendland-c2", "line", &["b_inverse", "sum_ddw", "sum_w", "sum_rrrdw"]),
    ("cubic-spline", "line", &["b_inverse", "sum_ddw"]),
    ("quintic-spline", "line", &["b_inverse", "sum_rrrdw"]),
    ("wendland-c4-1d", "line", &["b_inverse", "sum_w"]),
    ("wendland-c2", "square", &["b_inverse", "sum_ddw", "sum_w", "sum_rrrdw", "sum_lapw"]),
    ("cubic-spline", "square", &["b_inverse"]),
    ("quartic-spline", "square", &["b_inverse", "sum_rrddw"]),
    ("wendland-c2", "hexagonal", &["b_inverse", "sum_rrrdw"]),
    ("quintic-spline", "staggered", &["b_inverse"]),
    ("wendland-c4", "hexagonal", &["b_inverse"]),
    ("wendland-c2", "simple-cubic", &["b_inverse", "sum_rrrdw", "sum_w"]),
    ("quintic-spline", "bcc", &["b_inverse"]),
    ("wendland-c2", "hcp", &["b_inverse", "sum_rrdw"]),
    ("wendland-c4", "fcc", &["sum_ddw"]),
];

fn support(sixteenths: i64) -> Rational {
    // No knot on a particle.
    ratio(sixteenths, 16) + ratio(1, 97)
}

/// `derived::orders::series` against `sums::lattice_sum`.
#[test]
fn terms_add_up_to_the_lattice_sum() {
    for (kernel_id, lattice_id, moments) in CASES {
        let (kernel, lattice) = (kernel::by_id(kernel_id).unwrap(), lattice_by_id(lattice_id).unwrap());
        for name in *moments {
            let moment = Moment::by_name(name).unwrap();
            let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
            let supports: Vec<Rational> = (0..9).map(|k| support(16 * 16 + 7 * k)).collect();
            let exact = Exact::new(&kernel, &lattice, moment, supports.last().unwrap());
            let envelopes = order.envelopes();
            for u in &supports {
                let (derived, summed) = (order.at(rational_to_f64(u)).unwrap(), exact.at(u));
                let epsilon = rational_to_f64(&(kernel.support_over_h() / u));
                for (index, component) in order.components.iter().enumerate() {
                    let lead = rational_to_f64(component.leading().unwrap());
                    let envelope = envelopes[index].unwrap().value * epsilon.powf(lead);
                    let error = (derived[index].value - summed[index]).abs();
                    println!(
                        "{kernel_id} {lattice_id} {name} {} {:.3}: {:e} {:e} err/env {:e} radius/env {:e}",
                        component.name,
                        rational_to_f64(u),
                        derived[index].value,
                        summed[index],
                        error / envelope,
                        derived[index].radius / envelope
                    );
                }
            }
        }
    }
    let _ = parse_rational("1");
}
