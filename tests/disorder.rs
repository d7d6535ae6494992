//! Disorder models: their statistics, what particles share, that a sample depends on (seed, sample, site) alone, and options.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assert_cmd::cargo::cargo_bin_cmd;
use remainder::particles::{Disorder, Draw, Lattice, SampleStream, Site, lattice_by_id};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// u of every site within `radius` in one sample.
fn units(text: &str, lattice: &Lattice, radius: f64, h_over_dx: f64, sample: u64) -> Vec<(Site, [f64; 3])> {
    let motion = Disorder::parse(text).unwrap().motion();
    let mut stream = SampleStream::new(7, sample);
    let sites = lattice.sites_within(radius);
    let unit = |site: &Site| (motion.unit)(&mut Draw::new(lattice, site, h_over_dx, &mut stream));
    let units: Vec<[f64; 3]> = sites.iter().map(unit).collect();
    let longest = motion.longest[lattice.dimension() - 1];
    assert!(
        units.iter().all(|u| u.iter().map(|x| x * x).sum::<f64>().sqrt() <= longest * (1.0 + 1e-15)),
        "{text}"
    );
    sites.into_iter().zip(units).collect()
}

/// Over the sites of some samples: ⟨u_a⟩, ⟨u_a u_b⟩ and how many.
fn statistics(text: &str, id: &str, radius: f64, samples: u64) -> ([f64; 3], [[f64; 3]; 3], f64) {
    let lattice = lattice_by_id(id).unwrap();
    let all: Vec<[f64; 3]> =
        (0..samples).flat_map(|n| units(text, &lattice, radius, 2.0, n)).map(|(_, u)| u).collect();
    let n = all.len() as f64;
    let mean = std::array::from_fn(|a| all.iter().map(|u| u[a]).sum::<f64>() / n);
    let second =
        std::array::from_fn(|a| std::array::from_fn(|b| all.iter().map(|u| u[a] * u[b]).sum::<f64>() / n));
    (mean, second, n)
}

const BY_DIMENSION: [(&str, f64); 3] = [("line", 20_000.0), ("square", 110.0), ("simple-cubic", 21.0)];

/// Means are 0 and second moments `diagonal[a]` δ_ab within five standard errors. Axes beyond D stay at 0.
fn check_independent(text: &str, id: &str, radius: f64, diagonal: [f64; 3]) {
    let (mean, second, n) = statistics(text, id, radius, 1);
    assert!(n > 3e4, "{id}: {n}");
    for a in 0..3 {
        assert!(mean[a].abs() <= 5.0 * (diagonal[a] / n).sqrt(), "{text} {id}: mean {mean:?}");
        for b in 0..3 {
            let expected = if a == b { diagonal[a] } else { 0.0 };
            // Var(u_a u_b) ≤ 3 ⟨u_a²⟩⟨u_b²⟩ for all that is here.
            let error = 5.0 * (3.0 * diagonal[a] * diagonal[b] / n).sqrt();
            assert!((second[a][b] - expected).abs() <= error, "{text} {id} {a}{b}: {second:?}");
        }
    }
}

fn isotropic(variance: f64, dimension: usize) -> [f64; 3] {
    std::array::from_fn(|a| if a < dimension { variance } else { 0.0 })
}

#[test]
fn independent_models_have_their_means_and_variances() {
    for (index, (id, radius)) in BY_DIMENSION.into_iter().enumerate() {
        let d = index + 1;
        check_independent("gaussian:0.01", id, radius, isotropic(1.0, d));
        check_independent("box:0.4", id, radius, isotropic(1.0 / 48.0, d));
        check_independent("canonical:0.1", id, radius, isotropic(1.0 / d as f64, d));
        check_independent("canonical:0.1,angles=uniform", id, radius, isotropic(1.0 / d as f64, d));
        // In one and two dimensions the printed angles are the uniform ones.
        if d < 3 {
            check_independent("canonical:0.1,angles=printed", id, radius, isotropic(1.0 / d as f64, d));
        }
    }
}

#[test]
fn a_gaussian_has_the_tails_of_one() {
    let (id, radius) = BY_DIMENSION[1];
    let all = units("gaussian:0.01", &lattice_by_id(id).unwrap(), radius, 1.0, 3);
    for axis in 0..2 {
        // P(|ζ| > 1, 2, 3), and ⟨ζ⁴⟩ = 3.
        for (beyond, probability) in [(1.0, 0.317_310_5), (2.0, 0.045_500_3), (3.0, 0.002_699_8)] {
            let share = all.iter().filter(|(_, u)| u[axis].abs() > beyond).count() as f64 / all.len() as f64;
            let error = 5.0 * (probability / all.len() as f64).sqrt();
            assert!((share - probability).abs() < error, "axis {axis} beyond {beyond}: {share}");
        }
        let fourth = all.iter().map(|(_, u)| u[axis].powi(4)).sum::<f64>() / all.len() as f64;
        assert!((fourth - 3.0).abs() < 5.0 * (96.0 / all.len() as f64).sqrt(), "{fourth}");
    }
    assert!(all.iter().any(|(_, u)| u[0].abs() > 3.5), "nothing is cut off");
}

#[test]
fn printed_angles_crowd_at_the_poles_of_their_axis() {
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let text = format!("canonical:0.1,angles=printed,axis={name}");
        let diagonal = std::array::from_fn(|a| if a == axis { 0.5 } else { 0.25 });
        check_independent(&text, "simple-cubic", 21.0, diagonal);
        // Both sides: 1/2 is far from the 1/3 of the uniform sphere, at these errors.
        let (_, second, n) = statistics(&text, "simple-cubic", 21.0, 1);
        assert!(second[axis][axis] - 1.0 / 3.0 > 20.0 * (1.0 / n).sqrt());
    }
    let z = statistics("canonical:0.1,angles=printed", "simple-cubic", 8.0, 1);
    assert_eq!(z, statistics("canonical:0.1,angles=printed,axis=z", "simple-cubic", 8.0, 1));
    for text in ["canonical:0.1", "canonical:0.1,angles=printed"] {
        for (_, u) in units(text, &lattice_by_id("simple-cubic").unwrap(), 4.0, 1.0, 0) {
            assert!((u.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn a_wave_is_one_wave_in_each_sample() {
    let square = lattice_by_id("square").unwrap();
    // λ = 4 h = 10 Δ at h = 2.5 Δ.
    for (text, wavelength) in [("wave:0.1,wavelength=4", 10.0), ("wave:0.1,wavelength=4,unit=dx", 4.0)] {
        let mut phases = Vec::new();
        for sample in 0..400 {
            let all = units(text, &square, 6.0, 2.5, sample);
            let at = |x: f64| all.iter().find(|(site, _)| site.position == [x, 0.0, 0.0]).unwrap().1[0];
            // sin(φ) and sin(kΔ + φ) give cos(φ).
            let k = TAU / wavelength;
            let (sine, cosine) = (at(0.0), (at(1.0) - at(0.0) * k.cos()) / k.sin());
            assert!((sine * sine + cosine * cosine - 1.0).abs() < 1e-12, "{text}");
            for (site, u) in &all {
                let x = k * site.position[0];
                let expected = x.sin() * cosine + x.cos() * sine;
                assert!((u[0] - expected).abs() < 1e-12 && u[1] == 0.0 && u[2] == 0.0, "{text}");
            }
            phases.push([cosine, sine]);
        }
        // φ is even: ⟨cos φ⟩ = ⟨sin φ⟩ = 0, ⟨sin² φ⟩ = 1/2.
        let n = phases.len() as f64;
        for part in 0..2 {
            assert!((phases.iter().map(|p| p[part]).sum::<f64>() / n).abs() < 5.0 * (0.5 / n).sqrt());
        }
        assert!((phases.iter().map(|p| p[1] * p[1]).sum::<f64>() / n - 0.5).abs() < 5.0 * (0.125 / n).sqrt());
    }
}

#[test]
fn a_wave_in_units_of_h_keeps_its_share_of_the_support() {
    let line = lattice_by_id("line").unwrap();
    let at = |text: &str, h: f64, x: f64| {
        units(text, &line, 50.0, h, 5).into_iter().find(|(site, _)| site.position[0] == x).unwrap().1[0]
    };
    // Doubling h/Δ doubles the place at which the same phase is met, with unit=h; it changes nothing with unit=dx.
    for x in [3.0, 7.0, 11.0] {
        assert!(
            (at("wave:0.1,wavelength=5", 4.0, 2.0 * x) - at("wave:0.1,wavelength=5", 2.0, x)).abs() < 1e-14
        );
        let text = "wave:0.1,wavelength=5,unit=dx";
        assert_eq!(at(text, 4.0, x), at(text, 2.0, x));
        assert!((at("wave:0.1,wavelength=5", 4.0, x) - at("wave:0.1,wavelength=5", 2.0, x)).abs() > 1e-3);
    }
}

#[test]
fn waves_point_and_polarise_as_asked() {
    let cubic = lattice_by_id("simple-cubic").unwrap();
    let only = |u: [f64; 3], axis: usize| (0..3).all(|a| (a == axis) == (u[a] != 0.0));
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let text = format!("wave:0.1,wavelength=7.3,unit=dx,direction={name}");
        assert!(units(&text, &cubic, 2.0, 1.0, 0).iter().all(|(_, u)| only(*u, axis)));
    }
    let mut squares = [0.0; 3];
    for sample in 0..600 {
        let long = units("wave:0.1,wavelength=7.3,unit=dx,direction=random", &cubic, 1.0, 1.0, sample);
        let across = "wave:0.1,wavelength=7.3,unit=dx,direction=random,polarisation=transverse";
        let across = units(across, &cubic, 1.0, 1.0, sample);
        for ((_, u), (_, v)) in long.iter().zip(&across) {
            let product = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
            // The same wave, displaced across.
            assert!((product(u, u) - product(v, v)).abs() < 1e-14 && product(u, v).abs() < 1e-14);
            for a in 0..3 {
                squares[a] += v[a] * v[a] / product(v, v) / (600.0 * long.len() as f64);
            }
        }
    }
    assert!(squares.iter().all(|s| (s - 1.0 / 3.0).abs() < 0.06), "{squares:?}");
    let flat = units(
        "wave:0.1,wavelength=3,polarisation=transverse",
        &lattice_by_id("square").unwrap(),
        2.0,
        1.0,
        0,
    );
    assert!(flat.iter().all(|(_, u)| only(*u, 1)));
}

#[test]
fn rows_slide_as_a_whole_and_each_by_its_own_amount() {
    for id in ["square", "staggered", "hexagonal", "simple-cubic", "bcc", "hcp"] {
        let lattice = lattice_by_id(id).unwrap();
        let last = lattice.dimension() - 1;
        let mut slides: Vec<f64> = Vec::new();
        for sample in 0..60 {
            let mut rows: BTreeMap<i64, f64> = BTreeMap::new();
            for (site, u) in units("shear:1", &lattice, 4.5, 2.0, sample) {
                assert_eq!([u[1], u[2]], [0.0, 0.0]);
                let height = (site.position[last] * 1e6).round() as i64;
                assert_eq!(*rows.entry(height).or_insert(u[0]), u[0], "{id}: a row comes apart");
            }
            let mut distinct: Vec<f64> = rows.values().copied().collect();
            distinct.sort_by(f64::total_cmp);
            distinct.dedup();
            assert_eq!(distinct.len(), rows.len(), "{id}: rows move together");
            slides.extend(rows.into_values());
        }
        let n = slides.len() as f64;
        assert!(slides.iter().all(|s| (-0.5..0.5).contains(s)));
        assert!((slides.iter().sum::<f64>() / n).abs() < 5.0 * (1.0 / 12.0 / n).sqrt(), "{id}");
        let variance = slides.iter().map(|s| s * s).sum::<f64>() / n;
        assert!((variance - 1.0 / 12.0).abs() < 5.0 * (1.0 / 180.0 / n).sqrt(), "{id}: {variance}");
    }
}

#[test]
fn given_shear_moves_every_other_row_and_turns_square_into_staggered() {
    let square = lattice_by_id("square").unwrap();
    let moved = |amplitude: f64| {
        let mut places: Vec<[i64; 2]> = units("shear:0.5,amount=given", &square, 3.6, 1.0, 9)
            .iter()
            .map(|(site, u)| {
                [site.position[0] + amplitude * u[0], site.position[1]].map(|x| (x * 1e6) as i64)
            })
            .filter(|p| p.iter().map(|x| x * x).sum::<i64>() < 9_000_000_000_000)
            .collect();
        places.sort_unstable();
        places
    };
    let staggered = |id: &str| {
        let sites = lattice_by_id(id).unwrap().sites_within(2.999);
        let mut places: Vec<[i64; 2]> =
            sites.iter().map(|s| [s.position[0], s.position[1]].map(|x| (x * 1e6) as i64)).collect();
        places.sort_unstable();
        places
    };
    assert_eq!(moved(0.5), staggered("staggered"));
    assert_ne!(moved(0.25), staggered("staggered"));
}

/// All models: the same words give the same sample, another seed or sample another, and a site does not feel how many
/// others are displaced.
#[test]
fn a_sample_is_a_function_of_seed_sample_and_site() {
    let models = [
        "offset:0.1",
        "box:0.4",
        "canonical:0.1",
        "canonical:0.1,angles=printed,axis=x",
        "gaussian:0.01",
        "wave:0.1,wavelength=4",
        "wave:0.1,wavelength=4,direction=random,polarisation=transverse",
        "shear:1",
    ];
    for id in ["hexagonal", "hcp"] {
        let lattice = lattice_by_id(id).unwrap();
        for text in models {
            let (near, far) = (units(text, &lattice, 2.0, 2.0, 4), units(text, &lattice, 5.0, 2.0, 4));
            for (site, u) in &near {
                let same = far.iter().find(|(s, _)| (s.cell, s.basis) == (site.cell, site.basis)).unwrap();
                assert_eq!(same.1, *u, "{text} on {id}");
            }
            assert_eq!(near, units(text, &lattice, 2.0, 2.0, 4));
            assert_ne!(near, units(text, &lattice, 2.0, 2.0, 5), "{text} on {id}");
        }
    }
}

#[test]
fn neighbours_meet_according_to_the_lattice() {
    let meets = |text: &str, id: &str| {
        Disorder::parse(text).unwrap().check_reach(&lattice_by_id(id).unwrap()).is_err()
    };
    let cases = [
        // Box: 2 · A/4 along the axis in which neighbours are farthest apart.
        ("box", "square", 2.0),
        ("box", "hexagonal", 3_f64.sqrt()),
        ("box", "bcc", 1.0),
        ("box", "fcc", 1.0),
        // Ball: half the nearest distance.
        ("canonical", "square", 0.5),
        ("canonical", "fcc", 8_f64.sqrt().recip()),
        ("canonical", "hcp", 0.5),
        // One particle alone: the nearest distance.
        ("offset", "square", 1.0),
        ("offset", "bcc", 0.75_f64.sqrt()),
        ("gaussian", "line", 1.0 / 12.0),
    ];
    for (model, id, limit) in cases {
        assert!(!meets(&format!("{model}:{}", limit * 0.999), id), "{model} {id}");
        assert!(meets(&format!("{model}:{}", limit * 1.001), id), "{model} {id}");
    }
    assert!(meets("box:2", "square") && meets("canonical:0.5", "square"));
    assert!(!meets("shear:10", "square"));
}

#[test]
fn options_are_read_or_refused() {
    let refused: [(&str, &str); 14] = [
        ("box:0.4,axis=x", "it takes none"),
        ("canonical:0.1,angels=printed", "did you mean 'angles'"),
        ("canonical:0.1,angles=print", "did you mean 'printed'"),
        ("canonical:0.1,angles=printed,axis=w", "one of z, x, y"),
        ("canonical:0.1,axis=x", "angles=printed only"),
        ("canonical:0.1,printed", "no key=value"),
        ("wave:0.1", "has no wavelength"),
        ("wave:0.1,wavelength=0", "positive number"),
        ("wave:0.1,wavelength=nan", "positive number"),
        ("wave:0.1,wavelength=4,unit=R", "one of h, dx"),
        ("wave:0.1,wavelength=4,wavelength=5", "twice"),
        ("wave:0.1,wavelength=4,speed=1", "it knows wavelength, unit, direction, polarisation"),
        ("shear:0.5,amount=some", "one of random, given"),
        ("shear:1e9", "more than 16 Δ"),
    ];
    for (text, wanted) in refused {
        let message = Disorder::parse(text).unwrap_err().to_string();
        assert!(message.contains(wanted), "{text}: {message}");
    }
    let disorder = Disorder::parse("wave:0.1, wavelength=8 ,unit=dx").unwrap();
    assert_eq!(disorder.model_and_options(), "wave,unit=dx,wavelength=8");
    assert_eq!(Disorder::parse("box:0.4").unwrap().model_and_options(), "box");
}

#[test]
fn wrong_disorder_in_a_scene_exits_2_at_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        ("line", "shear:0.5", "needs at least 2 dimensions"),
        ("square", "wave:0.1,wavelength=4,direction=z", "needs at least 3 dimensions"),
        ("line", "wave:0.1,wavelength=4,polarisation=transverse", "needs at least 2 dimensions"),
        ("fcc", "canonical:0.4", "neighbours can meet"),
        ("square", "gausian:0.01", "did you mean 'gaussian'"),
        ("square", "wave:0.1,wavelenght=4", "did you mean 'wavelength'"),
    ];
    for (lattice, disorder, wanted) in cases {
        let path = folder.path().join("scene.toml");
        let text = format!(
            "[cases]\nkernels = [\"wendland-c2\"]\nlattices = [\"{lattice}\"]\ndisorders = [\"box:0.1\", \"{disorder}\"]\n"
        );
        std::fs::write(&path, text).unwrap();
        let output = cargo_bin_cmd!("remainder").arg("plan").arg(&path).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).replace('\n', " ");
        assert_eq!(output.status.code(), Some(2), "{disorder}: {message}");
        assert!(message.contains(wanted) && message.contains(":4:25"), "{disorder}: {message}");
    }
}
