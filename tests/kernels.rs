//! The catalogue of kernels against what the literature prints, the Gaussian against sums done another way, kernels of
//! one's own, and the audit, from both sides: what holds at one order fails at the next.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use assert_cmd::Command;
use num_traits::{One, Zero};
use remainder::exact::{Coefficient, Enclosure, Polynomial, Rational, int, ratio};
use remainder::kernel::{self, Audit, Evaluator, KernelDefinition, KernelError, PieceDefinition};
use remainder::particles::{VolumeRule, lattice_by_id};
use remainder::study::{Scene, SceneText};
use remainder::sums::{LatticeSums, Moment, PairSums};

/// exp(−x) between two rationals: a Taylor series about 0 with its Lagrange remainder |R| ≤ x^n/n!, for x ≥ 0.
fn exp_bounds(x: &Rational, terms: i64) -> (Rational, Rational) {
    let (mut sum, mut term) = (Rational::zero(), Rational::one());
    for n in 0..terms {
        sum += &term;
        term = -term * x / int(n + 1);
    }
    let rest = if term < int(0) { -term } else { term };
    (&sum - &rest, sum + rest)
}

fn holds(enclosure: &Enclosure, (low, high): &(Rational, Rational)) {
    let (mid, rad) = (enclosure.midpoint(), enclosure.radius());
    assert!(&mid - &rad <= *high && *low <= &mid + &rad, "{enclosure} misses [{low}, {high}]");
}

#[test]
fn beta_origin_and_jumps_of_the_catalogue() {
    // (id, R/h, β, first odd power, order of the jump at each knot). Dehnen & Aly 2012: a Wendland function C^{2k} joins
    // zero with 2k + 1 continuous derivatives for D = 2, 3 and 2k for D = 1; a spline of degree n with n − 1.
    type Row = (&'static str, Rational, i64, Option<usize>, &'static [usize]);
    let expected: [Row; 10] = [
        ("wendland-c2", int(1), 3, Some(3), &[4]),
        ("wendland-c4", int(1), 5, Some(5), &[6]),
        ("wendland-c6", int(1), 7, Some(7), &[8]),
        ("wendland-c2-1d", int(1), 2, Some(3), &[3]),
        ("wendland-c4-1d", int(1), 4, Some(5), &[5]),
        ("wendland-c6-1d", int(1), 6, Some(7), &[7]),
        ("cubic-spline", int(2), 2, Some(3), &[3, 3]),
        ("quartic-spline", ratio(5, 2), 3, None, &[4, 4, 4]),
        ("quintic-spline", int(3), 4, Some(5), &[5, 5, 5]),
        ("gaussian", int(3), -1, None, &[0]),
    ];
    assert_eq!(kernel::catalogue().len(), expected.len());
    for (id, support, beta, odd, jumps) in expected {
        let kernel = kernel::by_id(id).unwrap();
        let orders: Vec<usize> = kernel.jumps().iter().filter_map(|jump| jump.order).collect();
        assert_eq!((kernel.support_over_h(), kernel.beta()), (&support, beta), "{id}");
        assert_eq!((kernel.first_odd_power(), orders.as_slice()), (odd, jumps), "{id}");
    }
}

#[test]
fn printed_constants_are_right_but_for_the_known_misprint() {
    // Each factor by which a source scales its profile, from the value it prints at the origin.
    let at_origin = |id: &str| kernel::by_id(id).unwrap().polynomial().unwrap().evaluate(&int(0));
    assert_eq!(ratio(1, 4) * at_origin("cubic-spline"), int(1), "Monaghan & Lattanzio: w(0) = 1");
    assert_eq!((at_origin("quartic-spline"), at_origin("quintic-spline")), (ratio(115, 8), int(66)));
    let mut checked = 0;
    let mut wrong = Vec::new();
    for kernel in kernel::catalogue() {
        let audit = Audit::of(&kernel);
        checked += audit.normalisation.iter().map(|n| n.printed.len()).sum::<usize>();
        wrong.extend(
            audit.misprints().map(|(d, p)| (kernel.id().to_owned(), d, p.printed.clone(), p.right.clone())),
        );
    }
    assert_eq!(checked, 21);
    let misprint = ("quintic-spline".into(), 3, "3/359·π^-1".to_owned(), "1/120·π^-1".to_owned());
    assert_eq!(wrong, [misprint]);
}

#[test]
fn the_quartic_spline_is_its_truncated_powers_and_the_variance_is_that_of_five_boxes() {
    // (5/2 − q)⁴ − 5 (3/2 − q)⁴ + 10 (1/2 − q)⁴, each where it is positive (Price 2012).
    let kernel = kernel::by_id("quartic-spline").unwrap();
    for q in [int(0), ratio(1, 3), ratio(1, 2), ratio(7, 5), ratio(3, 2), ratio(12, 5)] {
        let power = |edge: Rational| {
            let s = &edge - &q;
            if s > int(0) { &s * &s * &s * &s } else { int(0) }
        };
        let expected = power(ratio(5, 2)) - int(5) * power(ratio(3, 2)) + int(10) * power(ratio(1, 2));
        assert_eq!(kernel.polynomial().unwrap().evaluate(&q), expected);
    }
    for (id, variance) in
        [("cubic-spline", ratio(4, 12)), ("quartic-spline", ratio(5, 12)), ("quintic-spline", ratio(6, 12))]
    {
        assert_eq!(kernel::by_id(id).unwrap().second_moment(1, 0), Coefficient::Exact(variance));
    }
    // Dehnen & Aly 2012, Table 1: σ²/H² of the Wendland functions in three dimensions.
    for (id, variance) in
        [("wendland-c2", ratio(1, 15)), ("wendland-c4", ratio(2, 39)), ("wendland-c6", ratio(1, 24))]
    {
        assert_eq!(kernel::by_id(id).unwrap().second_moment(3, 0), Coefficient::Exact(variance), "{id}");
    }
}

#[test]
fn swift_gamma_follows_from_the_second_moment() {
    // kernel_hydro.h of SWIFT.
    for (id, gammas) in
        [("cubic-spline", [1.732051, 1.778002, 1.825742]), ("quartic-spline", [1.936492, 1.977173, 2.018932])]
    {
        let audit = Audit::of(&kernel::by_id(id).unwrap());
        for (d, gamma) in (1..=3).zip(gammas) {
            let ours = audit.conventions.iter().find(|c| c.who == "SWIFT" && c.dimension == Some(d)).unwrap();
            assert!((ours.value - gamma).abs() < 1e-6, "{id} {d}-D: {} and {gamma}", ours.value);
        }
    }
}

#[test]
fn enclosed_exponentials_hold_the_taylor_series_and_nothing_else() {
    for x in [int(0), ratio(1, 1000), ratio(1, 2), int(1), ratio(25, 4), int(9), int(64)] {
        for bits in [64, 200] {
            let enclosed = Enclosure::exp_of_negative(&x, bits);
            assert!(enclosed.radius() <= ratio(1, 2).pow(bits as i32), "radius of exp(-{x}) at {bits} bits");
            holds(&enclosed, &exp_bounds(&x, 500));
            let off = ratio(1, 2).pow(bits as i32 - 2);
            assert!(!enclosed.contains(&(exp_bounds(&x, 500).0 - off)));
        }
    }
}

#[test]
fn the_gaussian_integrates_to_what_erf_says() {
    // erf(3), erf(3)³-like truncations: 1-D erf(c), 2-D 1 − exp(−c²), 3-D erf(c) − 2c exp(−c²)/√π; erf(3) and √π from
    // Abramowitz & Stegun, Table 7.1 and elsewhere to 15 digits.
    let (erf, root_pi) = (0.999_977_909_503_001_4_f64, 1.772_453_850_905_516_f64);
    let expected = [erf, 1.0 - (-9.0_f64).exp(), erf - 6.0 * (-9.0_f64).exp() / root_pi];
    let gaussian = kernel::by_id("gaussian").unwrap();
    for (dimension, expected) in (1..=3).zip(expected) {
        let term = &Moment::default().components(dimension)[0].terms;
        let limit = gaussian.continuum_limit(dimension, term, 128);
        assert_eq!(limit.kind(), "enclosed");
        assert!((limit.to_f64() - expected).abs() < 1e-14, "{dimension}-D: {limit} and {expected}");
        assert!(limit.enclose(128).radius() < ratio(1, 2).pow(120));
    }
    assert!(gaussian.remark().unwrap().contains("truncated kernel"));
    assert!(kernel::by_id("wendland-c6").unwrap().remark().is_none());
}

#[test]
fn gaussian_sums_hold_a_direct_rational_sum_and_the_floating_point_one() {
    let gaussian = kernel::by_id("gaussian:cut=2.5").unwrap();
    assert_eq!((gaussian.id(), gaussian.support_over_h()), ("gaussian:cut=2.5", &ratio(5, 2)));
    let support = ratio(17, 4);
    for name in ["line", "square", "simple-cubic"] {
        let lattice = lattice_by_id(name).unwrap();
        let d = lattice.dimension();
        let moments = [Moment::default(), Moment::b_inverse(), Moment::laplacian(2).unwrap()];
        let sums = LatticeSums::new(&gaussian, &lattice, &support, &moments, 64).unwrap();
        let h = &support / int_or(&gaussian);
        // π^{D/2} h^D ΣW = Σ exp(−n²/h²), by rational bounds.
        let component = &moments[0].components(d)[0];
        let exact = sums.exact(&support, component, VolumeRule::Constant).unwrap();
        assert_eq!(exact.kind(), "enclosed");
        let (mut low, mut high) = (int(0), int(0));
        let reach: i64 = 4;
        let axis = |used: bool| if used { -reach..=reach } else { 0..=0 };
        for x in axis(true) {
            for y in axis(d > 1) {
                for z in axis(d > 2) {
                    let square = int(x * x + y * y + z * z);
                    if square < &support * &support {
                        let bounds = exp_bounds(&(square / (&h * &h)), 60);
                        low += bounds.0;
                        high += bounds.1;
                    }
                }
            }
        }
        let h_power = (0..d).fold(int(1), |p, _| p * &h);
        let root = Enclosure::pi(300).sqrt(300).unwrap();
        let pi_power = (0..d).fold(Enclosure::from_i64(1), |p, _| &p * &root);
        holds(&(&exact.enclose(256) * &pi_power), &(low / &h_power, high / &h_power));
        // In floating point, over the same sites.
        let pairs = PairSums::<f64>::new(&gaussian, d, &moments);
        let mut taken = pairs.start();
        let r = 4.25;
        for site in lattice.sites_within(r) {
            pairs.add(&mut taken, site.position.map(|x| x / r), r.powi(-(d as i32)));
        }
        let (floats, _) = pairs.finish(taken);
        let components: Vec<_> = moments.iter().flat_map(|m| m.components(d)).collect();
        let enclosed = sums.enclose(&support, &components, VolumeRule::Constant, 128).unwrap();
        let powers = moments.iter().flat_map(|m| m.components(d).into_iter().map(|_| m.length_power()));
        for ((float, enclosed), power) in floats.iter().zip(&enclosed).zip(powers) {
            let float = float * r.powi(power);
            assert!((float - enclosed.midpoint_f64()).abs() < 1e-13, "{name}: {float} and {enclosed}");
            assert!(enclosed.radius() < ratio(1, 2).pow(100));
        }
    }
}

fn int_or(kernel: &kernel::Kernel) -> &Rational {
    kernel.support_over_h()
}

#[test]
fn signs_slopes_and_inflection_points_are_certified() {
    for kernel in kernel::catalogue() {
        let audit = Audit::of(&kernel);
        assert!(audit.nonnegative && audit.decreasing, "{}", kernel.id());
    }
    let at = |id: &str, dimension: usize| {
        let audit = Audit::of(&kernel::by_id(id).unwrap());
        audit.inflections.into_iter().find(|inflection| inflection.dimension == dimension).unwrap()
    };
    let q = |id: &str| at(id, 1);
    // w″ = 20 (1 − q)² (4q − 1); −3 + 9q/2 on the first piece of the cubic spline.
    assert_eq!((q("wendland-c2").q.as_str(), q("cubic-spline").q.as_str()), ("1/4", "2/3"));
    assert_eq!((q("cubic-spline").greatest_h_over_dx, q("wendland-c2").greatest_support_over_dx), (1.5, 4.0));
    // ∇²w = 20 (1 − q)² ((D + 3) q − D) for C2.
    assert_eq!((at("wendland-c2", 2).q.as_str(), at("wendland-c2", 3).q.as_str()), ("2/5", "1/2"));
    assert_eq!((at("cubic-spline", 2).q.as_str(), at("cubic-spline", 3).q.as_str()), ("8/9", "1"));
    assert!((at("gaussian", 3).value - 1.5_f64.sqrt()).abs() < 1e-15);
    assert!((q("gaussian").value - 0.5_f64.sqrt()).abs() < 1e-15);
    // (1 − q)² (1 − 4q) is negative beyond 1/4, falls to its minimum at 1/2, and rises from there.
    let w = Polynomial::new(vec![int(1), int(-1)]).pow(2);
    let w = &w * &Polynomial::new(vec![int(1), int(-4)]);
    let stretches = w.stretches(&int(0), &int(1), 80);
    assert_eq!(stretches.len(), 2);
    assert_eq!(stretches[1].from, (ratio(1, 4), ratio(1, 4)));
    let rise = w.derivative().stretches(&int(0), &int(1), 80);
    assert_eq!((rise.len(), &rise[1].from.0), (2, &ratio(1, 2)));
    // √2/2 is bracketed, not named.
    let p = Polynomial::new(vec![ratio(-1, 2), int(0), int(1)]);
    let root = &p.stretches(&int(0), &int(1), 80)[1].from;
    assert!(root.0 < root.1 && &root.0 * &root.0 < ratio(1, 2) && &root.1 * &root.1 > ratio(1, 2));
}

/// One Euler step of u_t = ∇²u by Fatehi's Eq. (11) on a line keeps a step monotone below the bound and not above it.
#[test]
fn monotone_data_stay_monotone_up_to_the_bound_and_not_beyond() {
    for id in ["wendland-c2", "cubic-spline", "quintic-spline"] {
        let kernel = kernel::by_id(id).unwrap();
        let profile = kernel.polynomial().unwrap();
        let second = profile.derivative().derivative();
        let bound = Audit::of(&kernel).inflections[0].greatest_h_over_dx;
        let is_monotone = |h: f64| {
            let weight = |k: i64| {
                let q = remainder::exact::rational_from_decimal(k.abs() as f64 / h).unwrap();
                remainder::exact::rational_to_f64(&second.evaluate(&q))
            };
            let u = |i: i64| if i < 0 { 0.0 } else { 1.0 };
            let reach = 40;
            let rate =
                |i: i64| (1..reach).map(|k| weight(k) * (u(i + k) + u(i - k) - 2.0 * u(i))).sum::<f64>();
            (-reach..reach).all(|i| u(i + 1) + 1e-6 * rate(i + 1) >= u(i) + 1e-6 * rate(i) - 1e-15)
        };
        assert!(is_monotone(bound * 0.98) && !is_monotone(bound * 1.02), "{id}: {bound}");
    }
}

fn own(pieces: &[(&str, &[&str])]) -> KernelDefinition {
    let piece = |(to, coefficients): &(&str, &[&str])| PieceDefinition {
        to: (*to).into(),
        coefficients: coefficients.iter().map(|c| (*c).into()).collect(),
    };
    KernelDefinition {
        id: "mine".into(),
        citation: None,
        pieces: pieces.iter().map(piece).collect(),
        normalisation: None,
        allow_jumps: false,
    }
}

const CUBIC: &[(&str, &[&str])] = &[("1", &["1", "0", "-3/2", "3/4"]), ("2", &["2", "-3", "3/2", "-1/4"])];

#[test]
fn a_kernel_of_ones_own_is_the_catalogues_where_the_pieces_are() {
    let mut mine = own(CUBIC);
    mine.normalisation = Some(vec!["2/3".into(), "10/(7π)".into(), "1/pi".into()]);
    let kernel = mine.build().unwrap();
    assert_eq!(Audit::of(&kernel).misprints().count(), 0);
    for d in 1..=3 {
        let theirs = kernel::by_id("cubic-spline").unwrap().second_moment(d, 0);
        assert_eq!(kernel.second_moment(d, 0), theirs);
    }
    mine.normalisation = Some(vec!["2/3".into(), "15/(7 pi)".into(), "1/pi".into()]);
    let audit = Audit::of(&mine.build().unwrap());
    let wrong: Vec<_> = audit.misprints().map(|(d, p)| (d, p.right.clone())).collect();
    assert_eq!(wrong, [(2, "10/7·π^-1".to_owned())]);
}

#[test]
fn what_is_wrong_with_a_definition_is_named_with_its_place() {
    let place = |definition: KernelDefinition| {
        let error = definition.build().unwrap_err();
        (error.field(), error.to_string())
    };
    let (field, message) = place(own(&[("1", &["1", "-1/2"]), ("2", &["1/3"])]));
    assert_eq!(field, "pieces.1.coefficients");
    assert!(message.contains("q = 1") && message.contains("a jump of -1/6"), "{message}");
    let jumping = KernelDefinition { allow_jumps: true, ..own(&[("1", &["1", "-1/2"]), ("2", &["1/3"])]) };
    assert_eq!(jumping.build().unwrap().jumps()[0].order, Some(0));
    assert_eq!(place(own(&[("1", &["1"]), ("1", &["1"])])).0, "pieces.1.to");
    assert_eq!(place(own(&[("1", &["1", "x"])])).0, "pieces.0.coefficients.1");
    assert!(matches!(own(&[("1", &["0"])]).build(), Err(KernelError::Zero { .. })));
    assert!(matches!(own(&[("1", &["1", "-3"])]).build(), Err(KernelError::NotNormalisable { .. })));
    assert!(matches!(own(&[]).build(), Err(KernelError::NoPieces { .. })));
    let shadow = KernelDefinition { id: "gaussian".into(), ..own(CUBIC) };
    assert!(matches!(shadow.build(), Err(KernelError::Shadows { .. })));
    let constant = |text: &str| KernelDefinition {
        normalisation: Some(vec!["2/3".into(), text.into(), "1/pi".into()]),
        ..own(CUBIC)
    };
    assert_eq!(place(constant("10/7")).0, "normalisation.1");
    for text in ["10/(7*pi)", "10/7·π^-1"] {
        assert!(constant(text).build().is_ok(), "{text}");
    }
    for id in ["gaussian:cut=0", "gaussian:cut=-1", "gaussian:cut=nan", "gaussian:3", "gaussian:cut=9"] {
        assert!(matches!(kernel::by_id(id), Err(KernelError::Cut { .. })), "{id}");
    }
}

fn scene(define: &str, kernels: &str) -> Result<Scene, String> {
    let text = format!(
        "cases = {{ kernels = [{kernels}], lattices = [\"line\"], disorders = [\"offset:0.1\"] }}\n{define}"
    );
    let text = SceneText { path: "scene.toml".into(), text };
    Scene::from_text(&text, "test", true).map_err(|error| error.to_string())
}

#[test]
fn a_scene_defines_kernels_and_its_errors_have_line_and_column() {
    let mine =
        "[[define.kernel]]\nid = \"mine\"\npieces = [{ to = \"1\", coefficients = [\"1\", \"-1\"] }]\n";
    let read = scene(mine, "\"mine\", \"wendland-c6\"").unwrap();
    assert_eq!((read.cases[0].kernel.id(), read.cases[0].kernel.beta()), ("mine", 0));
    let twice = scene(&format!("{mine}{mine}"), "\"mine\"").unwrap_err();
    assert!(twice.contains("scene.toml:6:6") && twice.contains("twice"), "{twice}");
    let shadow = scene(&mine.replace("mine", "cubic-spline"), "\"cubic-spline\"").unwrap_err();
    assert!(shadow.contains("scene.toml:3:6") && shadow.contains("catalogue"), "{shadow}");
    let unknown = scene(mine, "\"mind\"").unwrap_err();
    assert!(unknown.contains("scene.toml:1:") && unknown.contains("did you mean 'mine'"), "{unknown}");
    let apart = "[[define.kernel]]\nid = \"mine\"\npieces = [\n  { to = \"1\", coefficients = [\"1\"] },\n  { to = \"2\", coefficients = [\"1/2\"] },\n]\n";
    let apart = scene(apart, "\"mine\"").unwrap_err();
    assert!(apart.contains("scene.toml:6:30") && apart.contains("do not meet at q = 1"), "{apart}");
}

#[test]
fn evaluators_follow_the_gaussian_to_its_cut_and_no_further() {
    let evaluator = Evaluator::<f64>::new(&kernel::gaussian(), 2, 2);
    let x = [0.0, 0.1, 0.5, 0.9, 0.999, 1.0, 1.1, 2.0];
    let values = evaluator.evaluate(&x).g;
    for (lane, x) in x.into_iter().enumerate() {
        let w = if x < 1.0 { 9.0 / std::f64::consts::PI * (-9.0 * x * x).exp() } else { 0.0 };
        for (k, factor) in [1.0, -18.0, 324.0].into_iter().enumerate() {
            assert!((values[k][lane] - factor * w).abs() <= 1e-13 * (1.0 + (factor * w).abs()), "{k} at {x}");
        }
    }
}

#[test]
fn the_command_audits_names_and_files_and_refuses_the_rest() {
    let run = |arguments: &[&str]| {
        let output = Command::cargo_bin("remainder").unwrap().arg("kernel").args(arguments).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    for kernel in kernel::catalogue() {
        let (code, out, _) = run(&[kernel.id()]);
        assert_eq!(code, Some(0));
        let widest = out.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(widest <= 100, "{}: {widest} columns\n{out}", kernel.id());
    }
    let (_, out, _) = run(&["quintic-spline"]);
    assert!(out.contains("WRONG, right is 1/120·π^-1"), "{out}");
    let (_, out, _) = run(&["gaussian", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&json["beta"], &json["polynomial"]), (&(-1).into(), &false.into()));
    let (code, _, err) = run(&["wendland-c3"]);
    assert_eq!(code, Some(2));
    assert!(err.contains("did you mean"), "{err}");

    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let pieces = "pieces = [{ to = \"1\", coefficients = [\"1\", \"-1\"] }]\n";
    let file = write("hat.toml", &format!("{pieces}normalisation = [\"1\", \"3/pi\", \"3/359 pi^-1\"]\n"));
    let (code, out, _) = run(&[&file]);
    assert_eq!(code, Some(0));
    assert!(out.starts_with("hat:") && out.contains("right is 3·π^-1"), "{out}");
    let file = write("hat.json", "{\"pieces\": [{\"to\": \"1\", \"coefficients\": [\"1\", \"-1\"]}]}");
    assert_eq!(run(&[&file]).0, Some(0));
    for (text, expected) in [
        ("pieces = []\n", "no pieces"),
        ("pieces = [{ to = \"0\", coefficients = [\"1\"] }]\n", "not beyond"),
        ("pieces = 3\n", "invalid type"),
        ("peices = []\n", "unknown field"),
    ] {
        let (code, out, err) = run(&[&write("bad.toml", text)]);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{text}");
        assert!(err.contains(expected) && err.contains("bad.toml:1:"), "{err}");
    }
    assert_eq!(run(&["nowhere.toml"]).0, Some(2));
}
