//! RMS errors on displaced particles: `derived::{linearised, finite}` against values computed in another way
//! (`fixtures/rms/independent_values.py`), against each other, and against samples (`measured::sampled_error`).

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::derived::{DeriveError, Model, RmsError, Setting, finite, linearised};
use remainder::kernel::{self, Kernel};
use remainder::language::{Coefficient, Subject};
use remainder::measured::{SampleSpec, SampledError, sampled_error};
use remainder::particles::{Disorder, Lattice, VolumeRule, lattice_by_id};
use remainder::sums::Moment;

struct Case {
    kernel: Kernel,
    lattice: Lattice,
    disorder: Disorder,
    support_over_dx: f64,
    rule: VolumeRule,
}

impl Case {
    fn new(kernel: &str, lattice: &str, support_over_dx: f64, disorder: &str) -> Self {
        Self {
            kernel: kernel::by_id(kernel).unwrap(),
            lattice: lattice_by_id(lattice).unwrap(),
            disorder: Disorder::parse(disorder).unwrap(),
            support_over_dx,
            rule: VolumeRule::Constant,
        }
    }

    fn with(mut self, rule: VolumeRule) -> Self {
        self.rule = rule;
        self
    }

    fn setting(&self) -> Setting<'_> {
        Setting {
            kernel: &self.kernel,
            lattice: &self.lattice,
            disorder: &self.disorder,
            support_over_dx: self.support_over_dx,
            rule: self.rule,
        }
    }

    fn linearised(&self, subject: &Subject) -> RmsError {
        linearised(&self.setting(), subject).unwrap()
    }

    fn finite(&self, moment: &str) -> RmsError {
        finite(&self.setting(), Moment::by_name(moment).unwrap()).unwrap()
    }

    fn sampled(&self, subject: &Subject, samples: u64) -> SampledError {
        let spec = SampleSpec {
            kernel: self.kernel.clone(),
            lattice: self.lattice.clone(),
            disorder: self.disorder.clone(),
            amplitude: self.disorder.amplitude(),
            support_over_dx: self.support_over_dx,
            rule: self.rule,
            subjects: vec![subject.clone()],
            seed: 20_090,
        };
        sampled_error(&spec, samples).unwrap()
    }
}

fn moment(name: &str) -> Subject {
    Subject::Moment(Moment::by_name(name).unwrap())
}

fn operator(name: &str, order: u8) -> Subject {
    Subject::Coefficient(Coefficient::new(name, order).unwrap())
}

#[test]
fn values_computed_in_another_way() {
    let near = |found: f64, wanted: f64, tolerance: f64| {
        assert!((found / wanted - 1.0).abs() < tolerance, "{found:e} where {wanted:e} is right");
    };
    let line = Case::new("wendland-c2", "line", 2.2, "box:0.4").finite("sum_dw");
    near(line.rms(), 0.102_092_986_725_365_12, 1e-13);
    let plane = Case::new("wendland-c2", "square", 2.6, "canonical:0.2");
    near(plane.finite("sum_dw").rms(), 0.160_520_075_255_273, 1e-11);
    near(plane.finite("sum_w").rms(), 0.081_038_943_626_418_11, 1e-12);
    let f4 = |rule| {
        let case = Case::new("quintic-spline", "square", 3.15, "canonical:0.0625").with(rule);
        case.linearised(&operator("F4", 2)).rms()
    };
    // As far as differences of sixth order go.
    near(f4(VolumeRule::Constant), 0.018_587_479_823_722, 1e-11);
    near(f4(VolumeRule::NumberDensity), 0.015_107_121_165_503, 1e-10);
}

/// Exact polynomials leave no error whatever the displacements.
#[test]
fn exact_operators_have_no_rms() {
    for rule in [VolumeRule::Constant, VolumeRule::NumberDensity] {
        let case = Case::new("wendland-c4", "hexagonal", 2.7, "box:0.3").with(rule);
        for (name, order) in [("F2", 0), ("F4", 0), ("F4", 1), ("S4", 1), ("S4", 2), ("shepard", 0)] {
            let error = case.linearised(&operator(name, order));
            assert!(error.rms() <= error.radius, "{name} on degree {order}: {:e}", error.rms());
        }
        let inexact = case.linearised(&operator("F2", 1));
        assert!(inexact.disorder() > 1e-3, "F2 is not exact on u = x: {:e}", inexact.disorder());
    }
}

/// Every law of displacements, moments and operators, one to three dimensions; small amplitudes for the linearised model.
#[test]
fn samples_agree() {
    let mut checked = 0;
    let mut compare = |case: &Case, subject: &Subject, error: &RmsError, samples: u64| {
        let sampled = case.sampled(subject, samples);
        let off = (sampled.rms - error.rms()).abs();
        let allowed = 4.5 * sampled.rms_error + error.model_error + error.radius + 1e-8 * error.rms();
        let label = format!("{} {} {} {:?}", case.lattice.id(), case.disorder, subject.name(), error.model);
        assert!(off <= allowed, "{label}: {:e} derived, {:e} sampled", error.rms(), sampled.rms);
        assert!(sampled.rms_error < 0.03 * sampled.rms, "{label}: too few samples to tell");
        for (component, [rms, mean]) in error.components.iter().zip(&sampled.components) {
            // Of a component's mean square, four standard errors of a normal law would be 4 √(2/n).
            let n = samples as f64;
            let spread = (rms * rms - mean * mean).max(0.0).sqrt().max(1e-9);
            assert!(
                (mean - component.mean).abs() < 5.0 * spread / n.sqrt() + error.model_error + 1e-9,
                "{label}"
            );
            let found = component.mean_square.max(0.0).sqrt();
            assert!((rms - found).abs() < 8.0 * spread / n.sqrt() + error.model_error + 1e-9, "{label}");
        }
        checked += 1;
    };
    let large = [
        ("line", 3.3, "box:0.8", "sum_dw"),
        ("square", 2.7, "box:0.8", "sum_rrdw"),
        ("square", 2.7, "gaussian:0.07", "b_inverse"),
        ("square", 2.7, "offset:0.3", "sum_ddw"),
        ("square", 2.7, "wave:0.3,wavelength=1,unit=h", "sum_dw"),
        ("square", 2.7, "wave:0.2,wavelength=2,unit=h,direction=random", "sum_w"),
        ("square", 2.7, "wave:0.2,wavelength=3,unit=dx,direction=y,polarisation=transverse", "sum_dw"),
        ("square", 2.7, "shear:1", "sum_rddw"),
        ("hexagonal", 2.7, "canonical:0.2", "sum_rddw"),
        ("simple-cubic", 2.2, "canonical:0.2", "sum_dw"),
        ("simple-cubic", 2.2, "canonical:0.2,angles=printed,axis=x", "sum_ddw"),
        ("hcp", 2.2, "box:0.4", "sum_rrdw"),
    ];
    for (lattice, support, disorder, name) in large {
        let case = Case::new("wendland-c2", lattice, support, disorder);
        let error = case.finite(name);
        assert_eq!(error.model, Model::Finite);
        compare(&case, &moment(name), &error, 6000);
    }
    let small = [
        ("line", "box:0.05", "F1", 0),
        ("square", "canonical:0.02", "F4", 2),
        ("square", "gaussian:0.01", "S2-11", 2),
        ("square", "wave:0.02,wavelength=2,unit=h", "F2", 1),
        ("square", "shear:0.05", "S3", 2),
        ("hexagonal", "offset:0.03", "F3", 0),
        ("hexagonal", "box:0.1", "S4", 3),
        ("simple-cubic", "canonical:0.02", "S3", 1),
        ("square", "box:0.1", "MCG", 1),
    ];
    for (lattice, disorder, name, order) in small {
        let case = Case::new("cubic-spline", lattice, 2.7, disorder);
        let subject = operator(name, order);
        compare(&case, &subject, &case.linearised(&subject), 2000);
    }
    for (lattice, disorder, subject) in [
        ("square", "box:0.1", operator("F4", 2)),
        ("hexagonal", "wave:0.02,wavelength=2,unit=h", moment("sum_dw")),
    ] {
        let case = Case::new("wendland-c2", lattice, 2.2, disorder).with(VolumeRule::NumberDensity);
        compare(&case, &subject, &case.linearised(&subject), 2000);
    }
    assert_eq!(checked, large.len() + small.len() + 2);
}

/// As the amplitude goes to zero the whole law gives what J and H give, and the difference falls with its square; the estimate
/// of it has its size.
#[test]
fn the_linearised_model_is_the_limit_of_the_finite_one() {
    for (lattice, law, name) in [
        ("line", "box:", "sum_dw"),
        ("square", "canonical:", "b_inverse"),
        ("square", "box:", "sum_w"),
        ("square", "offset:", "sum_rrdw"),
        ("hexagonal", "gaussian:", "sum_ddw"),
    ] {
        // Wendland C6: smooth enough that nothing is left of the knot at R. The scale of `box` is a quarter.
        let scale = if law == "box:" { 4.0 } else { 1.0 };
        let [coarse, fine] = [0.008, 0.004].map(|amplitude| {
            let case = Case::new("wendland-c6", lattice, 3.3, &format!("{law}{}", scale * amplitude));
            let (whole, linear) = (case.finite(name), case.linearised(&moment(name)));
            let difference = whole.rms() - linear.rms();
            assert!(difference.abs() < 2e-3 * whole.rms(), "{lattice} {law} {name}: {difference:e}");
            let estimate = linear.model_error / difference.abs();
            assert!((0.2..20.0).contains(&estimate), "{lattice} {law} {name}: estimated {estimate} times");
            // The mean square is off by the fourth power.
            difference * (whole.rms() + linear.rms())
        });
        let ratio = coarse / fine;
        assert!((14.0..18.5).contains(&ratio), "{lattice} {law} {name}: {coarse:e} to {fine:e}");
    }
}

/// What symmetry says: axes that are alike have the same error, and turning the wave turns the components.
#[test]
fn turned_displacements_turn_the_error() {
    let of = |disorder: &str, name: &str| Case::new("wendland-c2", "square", 2.9, disorder).finite(name);
    let (x, y) = (
        of("wave:0.1,wavelength=1.5,unit=h,direction=x", "sum_dw"),
        of("wave:0.1,wavelength=1.5,unit=h,direction=y", "sum_dw"),
    );
    let squares = |error: &RmsError| error.components.iter().map(|c| c.mean_square).collect::<Vec<_>>();
    assert!((squares(&x)[0] - squares(&y)[1]).abs() < 1e-14 && squares(&x)[1] < 1e-25, "{x:?} {y:?}");
    for error in [of("canonical:0.1", "sum_dw"), of("box:0.4", "sum_dw")] {
        assert!((squares(&error)[0] / squares(&error)[1] - 1.0).abs() < 1e-9, "{error:?}");
    }
    let case = Case::new("wendland-c2", "simple-cubic", 2.3, "box:0.1");
    let f2 = case.linearised(&operator("F1", 0));
    assert!(squares(&f2).iter().all(|s| (s / squares(&f2)[0] - 1.0).abs() < 1e-12), "{f2:?}");
}

/// The square lattice turned by an eighth and √2 coarser: all errors turn and scale with it. Only what no direction enters is
/// compared: norms of moments, and what an operator makes of u = 1, or of u = x where the law has no direction.
#[test]
fn turning_the_lattice_and_scaling_all_lengths_changes_nothing_but_units() {
    let root = std::f64::consts::SQRT_2;
    let zero = [0; 3];
    let turned = |eta: f64| {
        let mut case = Case::new("wendland-c4", "square", 2.9 * root, &format!("canonical:{}", eta * root));
        let vectors = [[1, 1, 0], [1, -1, 0], zero];
        let one = || remainder::exact::int(1);
        case.lattice =
            Lattice::new("turned", "turned square", 2, [one(), one(), one()], vectors, vec![zero]).unwrap();
        case
    };
    let square = |eta: f64| Case::new("wendland-c4", "square", 2.9, &format!("canonical:{eta}"));
    for name in ["sum_w", "sum_dw", "b_inverse", "sum_rddw"] {
        let length = Moment::by_name(name).unwrap().length_power();
        let (one, other) = (square(0.1).finite(name), turned(0.1).finite(name));
        let ratio = other.rms() / (one.rms() * root.powi(length));
        assert!((ratio - 1.0).abs() < 1e-8, "{name}: {ratio}");
    }
    for rule in [VolumeRule::Constant, VolumeRule::NumberDensity] {
        for (name, order) in [("F1", 0), ("S2-10", 0), ("S3", 1)] {
            let subject = operator(name, order);
            let (one, other) =
                (square(0.02).with(rule).linearised(&subject), turned(0.02).with(rule).linearised(&subject));
            let ratio = other.rms() / (one.rms() * root.powi(subject.length_power()));
            assert!((ratio - 1.0).abs() < 1e-11, "{name}: {ratio}");
        }
    }
}

/// Where J vanishes by symmetry the disorder's part is of second order: a rigid offset and an even moment.
#[test]
fn a_rigid_offset_moves_even_moments_by_the_square() {
    let part = |amplitude: f64| {
        let case = Case::new("wendland-c4", "square", 3.3, &format!("offset:{amplitude}"));
        let error = case.linearised(&moment("b_inverse"));
        assert!(error.disorder() < 1e-14, "J is zero: {:e}", error.disorder());
        let whole = case.finite("b_inverse");
        whole.components.iter().map(|c| (c.mean - c.regular).abs()).fold(0.0, f64::max)
    };
    let ratio = part(0.02) / part(0.01);
    assert!((3.95..4.05).contains(&ratio), "{ratio}");
}

#[test]
fn what_cannot_be_done_is_said() {
    let case = Case::new("wendland-c2", "square", 2.2, "box:0.4").with(VolumeRule::NumberDensity);
    let refused = finite(&case.setting(), Moment::by_name("sum_w").unwrap());
    assert!(matches!(refused, Err(DeriveError::Finite { .. })), "{refused:?}");
    // Only i itself in the support: B does not exist.
    let alone = Case::new("wendland-c2", "square", 0.9, "box:0.1");
    let refused = linearised(&alone.setting(), &operator("F4", 2));
    assert!(matches!(refused, Err(DeriveError::NoValue { .. })), "{refused:?}");
}
