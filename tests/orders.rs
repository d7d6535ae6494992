//! `derived::RegularOrder` and `derived::DisorderOrder` against exact lattice sums and against what was measured.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use remainder::derived::{DisorderOrder, Displaced, RegularOrder, Source};
use remainder::exact::{Piecewise, Polynomial, Rational, int, parse_rational, ratio, rational_to_f64};
use remainder::kernel::{self, Evaluator, Kernel};
use remainder::particles::{Disorder, Lattice, PointGroup, VolumeRule, lattice_by_id};
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

fn named(kernel: &str, lattice: &str, moment: &str) -> (Kernel, Lattice, Moment) {
    (kernel::by_id(kernel).unwrap(), lattice_by_id(lattice).unwrap(), Moment::by_name(moment).unwrap())
}

const CASES: &[(&str, &str, &[&str])] = &[
    ("wendland-c2", "line", &["b_inverse", "sum_ddw", "sum_w", "sum_rrrdw", "sum_rrrrrdw"]),
    ("cubic-spline", "line", &["b_inverse", "sum_ddw"]),
    ("quintic-spline", "line", &["b_inverse", "sum_rrrdw"]),
    ("wendland-c4-1d", "line", &["b_inverse", "sum_w"]),
    ("gaussian", "line", &["sum_w", "b_inverse"]),
    ("wendland-c2", "square", &["b_inverse", "sum_ddw", "sum_w", "sum_rrrdw", "sum_lapw", "sum_rrrrw"]),
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

/// Away from the places where a knot passes a particle.
fn support(from: i64, sixteenth: i64) -> Rational {
    int(from) + ratio(sixteenth, 16) + ratio(1, 97)
}

/// `derived::orders::series` against `sums::lattice_sum`: to 1 % of the envelope, and within the radius that it states.
/// Planted and found: the sign of the Bessel function's second term turned, the structure factor of the basis left out, ω left
/// out of an origin's amplitude.
#[test]
fn terms_add_up_to_the_lattice_sum() {
    for (kernel_id, lattice_id, moments) in CASES {
        for name in *moments {
            let (kernel, lattice, moment) = named(kernel_id, lattice_id, name);
            let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
            let envelopes = order.envelopes();
            let supports: Vec<Rational> = (0..9).map(|k| support(16, 7 * k)).collect();
            let exact = Exact::new(&kernel, &lattice, moment, supports.last().unwrap());
            for u in &supports {
                let (derived, summed) = (order.at(rational_to_f64(u)).unwrap(), exact.at(u));
                let epsilon = rational_to_f64(&(kernel.support_over_h() / u));
                assert_eq!(derived.len(), summed.len());
                for (index, component) in order.components.iter().enumerate() {
                    let lead = rational_to_f64(component.leading().unwrap());
                    let envelope = envelopes[index].unwrap().value * epsilon.powf(lead);
                    let (derived, summed) = (&derived[index], summed[index]);
                    let error = (derived.value - summed).abs();
                    let case = format!("{kernel_id} {lattice_id} {name} {} at {u}", component.name);
                    assert!(error < 0.01 * envelope, "{case}: {} for {summed}", derived.value);
                    // 1e-15: what the exact sum loses in its last conversion.
                    assert!(
                        error <= derived.radius + 1e-15 * summed.abs(),
                        "{case}: {error:e} > {:e}",
                        derived.radius
                    );
                    assert!(derived.radius < 0.03 * envelope, "{case}: {:e}", derived.radius);
                }
            }
        }
    }
}

/// The largest value over offsets of R/Δ that span a spacing.
fn largest(from: i64, value: impl Fn(&Rational) -> f64) -> f64 {
    (0..48).map(|k| value(&(support(from, 0) + ratio(k, 48))).abs()).fold(0.0, f64::max)
}

/// With the leading terms alone, what is left falls at the exponent of the next ones: not faster, not slower.
/// Planted and found: the exponents of knots raised by one.
#[test]
fn what_is_left_falls_at_the_next_exponent() {
    for (kernel_id, lattice_id, name, far) in [
        ("wendland-c2", "line", "b_inverse", 256),
        ("wendland-c4", "line", "sum_ddw", 256),
        ("wendland-c2", "square", "b_inverse", 96),
        ("wendland-c2", "square", "sum_w", 96),
        ("wendland-c2", "hexagonal", "b_inverse", 96),
    ] {
        let (kernel, lattice, moment) = named(kernel_id, lattice_id, name);
        let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
        let exact = Exact::new(&kernel, &lattice, moment, &int(far + 2));
        let left = |u: &Rational| exact.at(u)[0] - order.leading_at(rational_to_f64(u)).unwrap()[0].value;
        let component = &order.components[0];
        let next = component.terms.iter().find(|term| term.exponent > *component.leading().unwrap()).unwrap();
        let near = far / 4;
        let slope = (largest(near, left) / largest(far, left)).ln() / (far as f64 / near as f64).ln();
        let expected = rational_to_f64(&next.exponent);
        assert!((slope - expected).abs() < 0.2, "{kernel_id} {lattice_id} {name}: {slope}, {expected}");
        let lead = rational_to_f64(component.leading().unwrap());
        let whole = (largest(near, |u| exact.at(u)[0]) / largest(far, |u| exact.at(u)[0])).ln()
            / (far as f64 / near as f64).ln();
        assert!((whole - lead).abs() < 0.2, "{kernel_id} {lattice_id} {name}: {whole}, {lead}");
    }
}

/// No value exceeds the envelope, and on a line, where one period is all, some come near it.
/// Planted and found: the exponents of knots raised by one.
#[test]
fn envelopes_are_suprema() {
    for (kernel_id, lattice_id, name, least) in [
        ("wendland-c2", "line", "b_inverse", 0.98),
        ("quintic-spline", "line", "b_inverse", 0.98),
        ("cubic-spline", "line", "sum_ddw", 0.98),
        ("wendland-c2", "square", "b_inverse", 0.8),
        ("wendland-c2", "simple-cubic", "b_inverse", 0.6),
    ] {
        let (kernel, lattice, moment) = named(kernel_id, lattice_id, name);
        let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
        let envelope = order.envelopes()[0].unwrap();
        let lead = rational_to_f64(order.components[0].leading().unwrap());
        let scaled = |k: i64| {
            let u = 64.0 + k as f64 / 200.0;
            let epsilon = rational_to_f64(kernel.support_over_h()) / u;
            order.leading_at(u).unwrap()[0].value.abs() / epsilon.powf(lead)
        };
        let most = (0..6000).map(scaled).fold(0.0, f64::max);
        let (low, high) = (least * envelope.value, envelope.value + envelope.radius);
        assert!(low <= most && most <= high, "{kernel_id} {lattice_id}: {most} outside [{low}, {high}]");
        assert!(envelope.radius < 0.05 * envelope.value, "{kernel_id} {lattice_id}: {envelope:?}");
    }
}

/// At each zero crossing named, the exact sum changes sign.
#[test]
fn exact_sums_change_sign_at_the_crossings() {
    for (kernel_id, lattice_id, name) in [
        ("wendland-c2", "line", "b_inverse"),
        ("quintic-spline", "line", "b_inverse"),
        ("wendland-c2", "square", "b_inverse"),
        ("cubic-spline", "hexagonal", "b_inverse"),
        ("quintic-spline", "square", "b_inverse"),
        ("wendland-c2", "simple-cubic", "b_inverse"),
        ("quintic-spline", "simple-cubic", "b_inverse"),
    ] {
        let (kernel, lattice, moment) = named(kernel_id, lattice_id, name);
        let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
        let crossings = order.zero_crossings(2.0, 8.0).unwrap().swap_remove(0);
        let exact = Exact::new(&kernel, &lattice, moment, &int(9));
        let at = |u: f64| exact.at(&ratio((u * 1e6).round() as i64, 1_000_000))[0];
        for crossing in &crossings {
            let (u, near) = (crossing.support_over_dx, crossing.radius + 2e-6);
            println!("{kernel_id} {lattice_id} {name}: {u} ± {}", crossing.radius);
            assert!(at(u - near) * at(u + near) < 0.0, "{kernel_id} {lattice_id} {name}: {crossing:?}");
        }
        // None is missed from where on all are sharp.
        let blurred = crossings.iter().filter(|c| c.radius > 0.01).map(|c| c.support_over_dx + c.radius);
        let from = blurred.fold(3.1, f64::max);
        let sharp = crossings.iter().filter(|c| c.support_over_dx > from).count();
        let steps = ((8.0 - from) / 0.002) as usize;
        let changes = (0..steps).filter(|k| {
            let u = from + *k as f64 * 0.002;
            at(u) * at(u + 0.002) < 0.0
        });
        assert_eq!(changes.count(), sharp, "{kernel_id} {lattice_id} {name}: {crossings:?}");
        assert!(from < 4.0, "{kernel_id} {lattice_id} {name}: {crossings:?}");
    }
}

/// Exponents known otherwise. On a line they are those of the Euler–Maclaurin formula; in more dimensions those measured
/// by `analyses/moment-orders`, which read 4.00, 4.69, 4.65, 4.98 for the first four.
#[test]
fn exponents() {
    for (kernel, lattice, moment, exponent) in [
        ("wendland-c2", "line", "b_inverse", "4"),
        ("wendland-c2", "square", "b_inverse", "9/2"),
        ("wendland-c2", "hexagonal", "b_inverse", "9/2"),
        ("wendland-c2", "simple-cubic", "b_inverse", "5"),
        ("wendland-c4", "line", "b_inverse", "6"),
        ("wendland-c4", "square", "b_inverse", "13/2"),
        ("wendland-c4", "simple-cubic", "b_inverse", "7"),
        ("cubic-spline", "line", "b_inverse", "3"),
        ("cubic-spline", "square", "b_inverse", "7/2"),
        ("cubic-spline", "simple-cubic", "b_inverse", "4"),
        ("wendland-c2", "line", "sum_ddw", "2"),
        ("wendland-c2", "simple-cubic", "sum_ddw", "4"),
        ("wendland-c2", "line", "sum_w", "4"),
        ("wendland-c2", "square", "sum_w", "5"),
        ("gaussian", "square", "sum_ddw", "3/2"),
    ] {
        let (k, l, m) = named(kernel, lattice, moment);
        let order = RegularOrder::of(&k, &l, m).unwrap();
        assert_eq!(order.exponent(), Some(&parse_rational(exponent).unwrap()), "{kernel} {lattice} {moment}");
        // A component other than 0 in the limit, or the deviation itself.
        let value = if moment == "sum_ddw" && kernel != "gaussian" { exponent } else { "0" };
        assert_eq!(
            order.value_exponent(),
            Some(parse_rational(value).unwrap()),
            "{kernel} {lattice} {moment}"
        );
    }
    let (kernel, square, moment) = named("wendland-c2", "square", "sum_dw");
    let order = RegularOrder::of(&kernel, &square, moment).unwrap();
    assert!(order.vanishes() && order.exponent().is_none() && order.value_exponent().is_none());
    // Ties: on a line the jump of w⁗ at R and |r|³ at the origin.
    let (kernel, line, moment) = named("wendland-c2", "line", "b_inverse");
    let order = RegularOrder::of(&kernel, &line, moment).unwrap();
    let sources: Vec<&Source> = order.leading().iter().map(|c| &c.source).collect();
    assert_eq!(sources, [&Source::Origin { power: 3 }, &Source::Knot { at: int(1), jump: 4 }]);
    // No odd power, no origin.
    let (kernel, square, moment) = named("quartic-spline", "square", "b_inverse");
    let order = RegularOrder::of(&kernel, &square, moment).unwrap();
    assert!(order.contributions.iter().all(|c| c.source.oscillates()));
}

/// Closed forms on a line: with w = 1 − 6q² + 8q³ − 3q⁴, σ = 5/4 and ΣωW − 1, the origin adds
/// 2 ζ(−3) · 8 · 5/4 (Δ/h)⁴ = (1/6) (Δ/h)⁴.
#[test]
fn amplitudes_in_closed_form() {
    let (kernel, line, moment) = named("wendland-c2-1d", "line", "sum_w");
    let order = RegularOrder::of(&kernel, &line, moment).unwrap();
    let amplitude = order.components[0].terms[0].amplitude.clone().unwrap();
    assert_eq!(amplitude.exact, Some(ratio(1, 6)));
}

/// A profile with |r| itself: the hat w = 1 − q on a line, where ΣωW is exact at whole R/Δ.
#[test]
fn a_hat_has_its_kink_at_the_origin() {
    let profile = Piecewise::new(vec![int(0), int(1)], vec![Polynomial::new(vec![int(1), int(-1)])]).unwrap();
    let hat = Kernel::new("hat", "hat", "", profile).unwrap();
    let line = lattice_by_id("line").unwrap();
    let sum_w = RegularOrder::of(&hat, &line, Moment::by_name("sum_w").unwrap()).unwrap();
    assert_eq!(sum_w.exponent(), Some(&int(2)));
    for (name, far) in [("sum_w", 40), ("b_inverse", 40)] {
        let moment = Moment::by_name(name).unwrap();
        let order = RegularOrder::of(&hat, &line, moment).unwrap();
        let u = support(far, 3);
        let (derived, exact) =
            (&order.at(rational_to_f64(&u)).unwrap()[0], Exact::new(&hat, &line, moment, &u).at(&u));
        assert!((derived.value - exact[0]).abs() <= derived.radius + 1e-15, "{name}: {derived:?} {exact:?}");
    }
    let refused = RegularOrder::of(&hat, &line, Moment::by_name("sum_ddw").unwrap()).unwrap_err().to_string();
    assert!(refused.contains("r^1") && refused.contains("smoother"), "{refused}");
}

/// Where the sum over shells does not converge absolutely there is an exponent and no amplitude.
#[test]
fn divergent_envelopes_are_said_to_be() {
    for (kernel, lattice, moment) in
        [("gaussian", "square", "sum_w"), ("cubic-spline", "simple-cubic", "sum_ddw")]
    {
        let (kernel, lattice, moment) = named(kernel, lattice, moment);
        let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
        assert!(order.exponent().is_some());
        assert!(order.envelopes().iter().all(Option::is_none));
        assert!(order.at(16.0).unwrap_err().to_string().contains("does not converge absolutely"));
    }
}

fn exponents_of(kernel: &str, lattice: &str, moment: &str, disorder: &str) -> (Rational, Rational) {
    let (kernel, lattice, moment) = named(kernel, lattice, moment);
    let displaced = Displaced::by(&Disorder::parse(disorder).unwrap()).unwrap();
    let order = DisorderOrder::of(&kernel, &lattice, moment, &displaced).unwrap();
    let first = order.dominant();
    assert_eq!(&first.h + &first.displacement, int(i64::from(moment.length_power())));
    (first.displacement.clone(), first.dx_over_h.clone())
}

/// Each model, as the module's table has it.
#[test]
fn exponents_under_disorder() {
    for (kernel, lattice, moment, disorder, displacement, dx_over_h) in [
        ("wendland-c2", "line", "b_inverse", "box:0.4", "1", "1/2"),
        ("wendland-c2", "square", "sum_ddw", "canonical:0.1", "1", "1"),
        ("cubic-spline", "simple-cubic", "sum_ddw", "gaussian:0.1", "1", "3/2"),
        ("wendland-c2", "square", "sum_dw", "offset:0.1", "1", "2"),
        ("wendland-c2", "square", "sum_rrdw", "offset:0.1", "1", "7/2"),
        ("wendland-c2", "square", "b_inverse", "offset:0.1", "2", "2"),
        ("wendland-c2", "square", "sum_rddw", "offset:0.1", "1", "2"),
        ("wendland-c4", "square", "sum_rrdw", "offset:0.1", "3", "2"),
        ("wendland-c2", "hcp", "sum_w", "offset:0.1", "2", "3"),
        ("cubic-spline", "square", "b_inverse", "offset:0.1", "2", "3/2"),
        ("wendland-c2", "square", "b_inverse", "wave:0.1,wavelength=1", "1", "0"),
        ("wendland-c2", "square", "b_inverse", "wave:0.1,wavelength=1,polarisation=transverse", "1", "7/2"),
        ("wendland-c2", "square", "b_inverse", "wave:0.1,wavelength=8,unit=dx", "1", "7/2"),
        ("wendland-c2", "square", "sum_dw", "shear:0.1", "1", "3"),
        ("cubic-spline", "square", "sum_dw", "shear:0.1", "1", "5/2"),
        ("wendland-c2", "square", "sum_w", "shear:0.1", "2", "3"),
        ("gaussian", "square", "sum_w", "box:0.4", "1/2", "1"),
    ] {
        let expected = (parse_rational(displacement).unwrap(), parse_rational(dx_over_h).unwrap());
        let found = exponents_of(kernel, lattice, moment, disorder);
        assert_eq!(found, expected, "{kernel} {lattice} {moment} {disorder}");
    }
    let (kernel, cubic, moment) = named("wendland-c2", "simple-cubic", "b_inverse");
    let field = |a: Rational| {
        let displaced = Displaced::Correlated { spectral_exponent: a };
        DisorderOrder::of(&kernel, &cubic, moment, &displaced)
    };
    // a = 0 is a random walk; a steep enough spectrum leaves the waves of length Δ alone.
    assert_eq!(field(int(0)).unwrap().dominant().dx_over_h, ratio(3, 2));
    assert_eq!(field(int(2)).unwrap().dominant().dx_over_h, ratio(5, 2));
    assert_eq!(field(int(9)).unwrap().dominant().dx_over_h, int(4));
    assert!(field(int(-3)).unwrap_err().to_string().contains("above -3"));
    let line = lattice_by_id("line").unwrap();
    let refused = DisorderOrder::of(&kernel, &line, moment, &Displaced::Shear { random: true }).unwrap_err();
    assert!(refused.to_string().contains("at least 2 dimensions"));
}

/// The quantity of a fit, `sum_dw/disorder-deviation/1d/…`, and its moment.
fn subject(claim: &serde_json::Value) -> Option<(Moment, String)> {
    let fit = claim["measured"]["fits"][0].as_str()?;
    let mut parts = fit.split('/');
    let moment = Moment::by_name(parts.next()?).ok()?;
    Some((moment, parts.next()?.to_owned()))
}

/// Derived exponents beside those that the committed reports measured, volumes constant: inside the 95 % interval in nine
/// of ten, and elsewhere within the margin of 1/4 at which reports tell exponents apart, but for [`APART`]
/// and for smooth kernels in 2-D and 3-D whose ladders end before the asymptotic regime.
#[test]
fn measured_exponents_agree() {
    let (mut inside, mut outside, mut apart) = (0, Vec::new(), Vec::new());
    for report in ["fatehi-table-2", "fatehi-equations", "moment-orders"] {
        let path = format!("{}/reports/{report}/report.json", env!("CARGO_MANIFEST_DIR"));
        let report: serde_json::Value =
            serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        for claim in report["claims"].as_array().unwrap() {
            let case = &claim["case"];
            let Some((moment, quantity)) = subject(claim) else { continue };
            if case["volume_rule"] != "constant" || claim["kind"] != "power_law" {
                continue;
            }
            let text = |key: &str| case[key].as_str().unwrap_or("none").to_owned();
            let (kernel, lattice) =
                (kernel::by_id(&text("kernel")).unwrap(), lattice_by_id(&text("lattice")).unwrap());
            let mut derived = Vec::new();
            let mut regular = None;
            if quantity == "disorder-deviation" {
                let displaced = Displaced::by(&Disorder::parse(&text("disorder")).unwrap()).unwrap();
                let order = DisorderOrder::of(&kernel, &lattice, moment, &displaced).unwrap();
                derived.push(("displacement", Some(order.dominant().displacement.clone())));
                derived.push(("dx_over_h", Some(order.dominant().dx_over_h.clone())));
            } else {
                let order = RegularOrder::of(&kernel, &lattice, moment).unwrap();
                let exponent = match quantity.as_str() {
                    "regular-value" => order.value_exponent(),
                    _ => order.exponent().cloned(),
                };
                derived.push(("dx_over_h", exponent));
                regular = Some(order);
            }
            for (axis, exponent) in derived {
                let number = |which: &str| claim["measured"]["exponents"][axis][which].as_f64();
                let (Some(low), Some(value), Some(high)) = (number("low"), number("value"), number("high"))
                else {
                    continue;
                };
                let case = format!(
                    "{axis} {} {quantity} {} {} {}",
                    moment.name(),
                    text("kernel"),
                    text("lattice"),
                    text("disorder")
                );
                let Some(exponent) = exponent else { panic!("{case}: measured {value}, derived none") };
                let exponent = rational_to_f64(&exponent);
                if low <= exponent && exponent <= high {
                    inside += 1;
                } else if (value - exponent).abs() <= 0.25 || regular.as_ref().is_some_and(starts_late) {
                    outside.push(format!("{case}: derived {exponent}, measured {value} [{low}, {high}]"));
                } else {
                    apart.push(format!("{case}: derived {exponent}, measured {value} [{low}, {high}]"));
                }
            }
        }
    }
    println!(
        "{inside} inside, {} outside, {} apart\n{}\n\n{}",
        outside.len(),
        apart.len(),
        outside.join("\n"),
        apart.join("\n")
    );
    let unexpected: Vec<&String> =
        apart.iter().filter(|case| !APART.iter().any(|known| case.starts_with(known))).collect();
    assert!(unexpected.is_empty(), "{unexpected:#?}");
    assert!(inside > 500 && inside > 9 * (outside.len() + apart.len()), "{inside} inside, {outside:#?}");
}

/// Whether the leading term outweighs the others from R/Δ = 16 on only or later, where the ladders of three to four octaves
/// from R/Δ = 6 or 8 are half over.
fn starts_late(order: &RegularOrder) -> bool {
    let latest = order.asymptotic_from().into_iter().flatten().fold(0.0, f64::max);
    println!("{:?} asymptotic from {latest}", order.leading());
    latest > 16.0
}

/// - The Gaussian jumps by exp(−9) at R: d̃^{1/2} is below the smooth part's d̃ at all amplitudes that were measured.
/// - The offset's terms tie on the cubic lattice for the cubic spline, and on hcp, whose sites are no centres of inversion.
/// - ∫ x² W′ sin kx dx ~ ∫ x³ (1 − x)³ sin 2πx dx vanishes by symmetry: the continuum does not answer this one wave.
/// - Σωrr∇W under shear for the cubic spline: see the linear response above, which has the derived exponent farther out.
const APART: &[&str] = &[
    "displacement sum_dw disorder-deviation gaussian",
    "displacement b_inverse disorder-deviation gaussian",
    "displacement sum_rrdw disorder-deviation gaussian",
    "displacement sum_rrrdw disorder-deviation gaussian",
    "displacement sum_ddw disorder-deviation gaussian",
    "displacement sum_rddw disorder-deviation gaussian",
    "dx_over_h sum_dw disorder-deviation cubic-spline simple-cubic offset",
    "dx_over_h b_inverse disorder-deviation wendland-c2 hcp offset",
    "dx_over_h sum_ddw disorder-deviation wendland-c2 hcp offset",
    "displacement b_inverse disorder-deviation wendland-c2 hcp offset",
    "displacement sum_ddw disorder-deviation wendland-c2 hcp offset",
    "dx_over_h sum_rrdw disorder-deviation wendland-c2 line wave:0.1,wavelength=1,unit=h",
    "dx_over_h sum_rrdw disorder-deviation cubic-spline square shear",
];

/// J of S − S^reg = Σ_j J_j·(d_i − d_j) for each component, in f64: the sites, their rows, and J by component. h = 1.
struct Linear {
    sites: Vec<([f64; 3], i64)>,
    components: Vec<(f64, Vec<[f64; 3]>)>,
    dx: f64,
}

impl Linear {
    fn new(kernel: &Kernel, lattice: &Lattice, moment: Moment, support_over_dx: f64) -> Self {
        let (d, support) = (lattice.dimension(), rational_to_f64(kernel.support_over_h()));
        let dx = support / support_over_dx;
        let omega = lattice.particle_volume().enclose(64).midpoint_f64() * dx.powi(d as i32);
        let evaluator = Evaluator::<f64>::new(kernel, d, 2);
        let sites: Vec<([f64; 3], i64)> = lattice
            .sites_within(support_over_dx)
            .iter()
            .filter(|site| site.position != [0.0; 3])
            .map(|site| (site.position.map(|x| -x * dx), lattice.row(site.cell, site.basis)))
            .collect();
        let radial = |r: &[f64; 3]| -> [f64; 3] {
            let x = r.iter().map(|x| x * x).sum::<f64>().sqrt() / support;
            let g = evaluator.evaluate(&[x; 8]).g;
            std::array::from_fn(|k| g[k][0] * support.powi(-(d as i32) - 2 * k as i32))
        };
        let functions: Vec<[f64; 3]> = sites.iter().map(|(r, _)| radial(r)).collect();
        let components = moment.components(d).into_iter().map(|component| {
            let at = |(r, _): &([f64; 3], i64), g: &[f64; 3]| {
                std::array::from_fn(|a| {
                    let terms = component.terms.iter().map(|term| {
                        let raise = |extra: i32| -> f64 {
                            (0..3)
                                .map(|b| {
                                    let power =
                                        i32::from(term.monomial.powers[b]) + if a == b { extra } else { 0 };
                                    if power < 0 { 0.0 } else { r[b].powi(power) }
                                })
                                .product()
                        };
                        let power = f64::from(term.monomial.powers[a]);
                        let inner = power * raise(-1) * g[term.radial] + raise(1) * g[term.radial + 1];
                        term.coefficient as f64 * inner
                    });
                    if a < d { omega * terms.sum::<f64>() } else { 0.0 }
                })
            };
            let all = sites.iter().zip(&functions).map(|(site, g)| at(site, g)).collect();
            (component.multiplicity as f64, all)
        });
        let components = components.collect();
        Self { sites, components, dx }
    }

    fn rms(&self, variance: impl Fn(&[[f64; 3]]) -> f64) -> f64 {
        self.components.iter().map(|(count, j)| count * variance(j)).sum::<f64>().sqrt()
    }

    fn independent(&self) -> f64 {
        self.rms(|j| {
            let total: [f64; 3] = std::array::from_fn(|a| j.iter().map(|j| j[a]).sum());
            let square = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
            j.iter().map(square).sum::<f64>() + square(&total)
        })
    }

    fn shear(&self) -> f64 {
        self.rms(|j| {
            let mut rows = std::collections::BTreeMap::<i64, f64>::new();
            for ((_, row), j) in self.sites.iter().zip(j).filter(|((_, row), _)| *row != 0) {
                *rows.entry(*row).or_default() += j[0];
            }
            rows.values().map(|g| g * g).sum::<f64>() + rows.values().sum::<f64>().powi(2)
        })
    }

    /// Along x with wave number k, displaced along `axis`.
    fn wave(&self, k: f64, axis: usize) -> f64 {
        self.rms(|j| {
            let (mut real, mut imaginary) = (0.0, 0.0);
            for ((r, _), j) in self.sites.iter().zip(j) {
                real += j[axis] * (1.0 - (k * r[0]).cos());
                imaginary += j[axis] * (k * r[0]).sin();
            }
            real * real + imaginary * imaginary
        })
    }

    /// A spectrum k^a up to 1/Δ, on a line.
    fn field(&self, a: i32) -> f64 {
        let points = 600;
        let at = |i: usize| (i as f64 + 0.5) / points as f64 / self.dx;
        let weights: f64 = (0..points).map(|i| at(i).powi(a)).sum();
        ((0..points).map(|i| at(i).powi(a) * self.wave(at(i), 0).powi(2)).sum::<f64>() / weights).sqrt()
    }
}

/// `derived::orders::disorder` against the variance of the linear response, summed particle by particle without a random
/// number.
#[test]
fn linear_response_has_the_derived_exponents() {
    type Rms = fn(&Linear) -> f64;
    let held = |linear: &Linear| linear.wave(6.0, 0);
    let across = |linear: &Linear| linear.wave(6.0, 1);
    type Case<'a> = (&'a str, &'a str, &'a str, &'a str, Rms, [i64; 2]);
    let cases: Vec<Case> = vec![
        ("wendland-c2", "line", "b_inverse", "box:0.1", Linear::independent, [32, 256]),
        ("wendland-c2", "square", "sum_dw", "box:0.1", Linear::independent, [16, 64]),
        ("cubic-spline", "hexagonal", "b_inverse", "box:0.1", Linear::independent, [16, 64]),
        ("wendland-c2", "simple-cubic", "sum_dw", "box:0.1", Linear::independent, [8, 24]),
        ("wendland-c2", "square", "sum_dw", "shear:0.1", Linear::shear, [32, 128]),
        ("wendland-c2", "square", "b_inverse", "shear:0.1", Linear::shear, [16, 64]),
        ("cubic-spline", "square", "sum_dw", "shear:0.1", Linear::shear, [16, 64]),
        ("cubic-spline", "square", "sum_rrdw", "shear:0.1", Linear::shear, [64, 256]),
        ("wendland-c2", "square", "b_inverse", "wave:0.1,wavelength=1", held, [16, 64]),
        (
            "wendland-c2",
            "square",
            "b_inverse",
            "wave:0.1,wavelength=1,polarisation=transverse",
            across,
            [16, 64],
        ),
        (
            "cubic-spline",
            "square",
            "b_inverse",
            "wave:0.1,wavelength=5,unit=dx",
            |linear| linear.wave(std::f64::consts::TAU / (5.0 * linear.dx), 0),
            [16, 64],
        ),
    ];
    let slope =
        |kernel: &Kernel, lattice: &Lattice, moment: Moment, rms: &dyn Fn(&Linear) -> f64, ends: [i64; 2]| {
            let most = |from: i64| {
                let offsets = (0..12).map(|k| from as f64 + 0.013 + f64::from(k) / 12.0);
                offsets.map(|u| rms(&Linear::new(kernel, lattice, moment, u))).fold(0.0, f64::max)
            };
            (most(ends[0]) / most(ends[1])).ln() / (ends[1] as f64 / ends[0] as f64).ln()
        };
    for (kernel_id, lattice_id, name, disorder, rms, ends) in cases {
        let (kernel, lattice, moment) = named(kernel_id, lattice_id, name);
        let (displacement, exponent) = exponents_of(kernel_id, lattice_id, name, disorder);
        assert_eq!(displacement, int(1), "{disorder}");
        let (found, exponent) = (slope(&kernel, &lattice, moment, &rms, ends), rational_to_f64(&exponent));
        println!("{kernel_id} {lattice_id} {name} {disorder}: {found}, derived {exponent}");
        assert!(
            (found - exponent).abs() < 0.2,
            "{kernel_id} {lattice_id} {name} {disorder}: {found}, {exponent}"
        );
    }
    let (kernel, line, moment) = named("wendland-c2", "line", "b_inverse");
    for a in [0, 1, 3, 8] {
        let displaced = Displaced::Correlated { spectral_exponent: int(i64::from(a)) };
        let order = DisorderOrder::of(&kernel, &line, moment, &displaced).unwrap();
        let exponent = rational_to_f64(&order.dominant().dx_over_h);
        let found = slope(&kernel, &line, moment, &|linear: &Linear| linear.field(a), [16, 64]);
        println!("spectrum {a}: {found}, derived {exponent}");
        assert!((found - exponent).abs() < 0.2, "k^{a}: {found}, {exponent}");
    }
}
