//! Moment sums over samples of disorder, against neighbourhoods placed and summed by hand. Each test names the planted errors
//! that were seen to make it fail.
#![allow(clippy::unwrap_used)] // A failed unwrap is a failed test.

mod typed;

use remainder::exact::rational_to_f64;
use remainder::kernel;
use remainder::language::Subject;
use remainder::measured::{SampleBlock, SampleSpec, Sampler, summarise};
use remainder::particles::{Disorder, Draw, Moves, SampleStream, Site, VolumeRule, lattice_by_id};
use remainder::sums::{Component, Moment};
use typed::{derivative, looped, moment, typed_cubic_spline, typed_sum, typed_wendland_c2};

fn spec(
    disorder: &str,
    lattice: &str,
    support_over_dx: f64,
    rule: VolumeRule,
    moments: &[&str],
) -> SampleSpec {
    let disorder = Disorder::parse(disorder).unwrap();
    SampleSpec {
        kernel: kernel::wendland_c2(),
        lattice: lattice_by_id(lattice).unwrap(),
        amplitude: disorder.amplitude(),
        disorder,
        support_over_dx,
        rule,
        subjects: moments.iter().map(|name| Subject::Moment(moment(name))).collect(),
        seed: 2011,
    }
}

/// Where sample n of a specification puts the sites within `reach`, the centre first.
fn displaced(spec: &SampleSpec, sample: u64, reach: f64) -> Vec<[f64; 3]> {
    let mut sites = spec.lattice.sites_within(reach);
    let is_centre = |site: &Site| site.cell == [0; 3];
    sites.sort_by_key(|site| !is_centre(site));
    let (entry, motion) = (spec.disorder.entry(), spec.disorder.motion());
    let move_site = |site: &Site| {
        if entry.moves == Moves::CentreOnly && !is_centre(site) {
            return site.position;
        }
        // A stream of its own for every site: what was drawn before must not matter.
        let mut stream = SampleStream::new(spec.seed, sample);
        let kappa = rational_to_f64(spec.kernel.support_over_h());
        let unit =
            (motion.unit)(&mut Draw::new(&spec.lattice, site, spec.support_over_dx / kappa, &mut stream));
        std::array::from_fn(|a| site.position[a] + spec.amplitude * unit[a])
    };
    sites.iter().map(move_site).collect()
}

/// The components of one moment at particle 0 of a neighbourhood, in units of h = R, by typed formulas.
fn typed_moment(spec: &SampleSpec, moment: Moment, positions: &[[f64; 3]]) -> Vec<(f64, u64)> {
    let (d, radius) = (spec.lattice.dimension(), spec.support_over_dx);
    let difference = |i: usize, j: usize| std::array::from_fn(|a| positions[i][a] - positions[j][a]);
    let volume = |j: usize| match spec.rule {
        VolumeRule::Constant => rational_to_f64(&spec.lattice.particle_volume().as_rational().unwrap()),
        VolumeRule::NumberDensity => {
            let all: Vec<_> = (0..positions.len()).map(|k| (difference(j, k), 1.0)).collect();
            1.0 / typed_sum(typed_wendland_c2, d, radius, Moment::default(), "", &all).0
        }
    };
    let near = |r: &[f64; 3]| r.iter().map(|x| x * x).sum::<f64>() < radius * radius;
    let pairs: Vec<_> = (0..positions.len())
        .map(|j| (difference(0, j), j))
        .filter(|(r, _)| near(r))
        .map(|(r, j)| (r, volume(j)))
        .collect();
    let unit = radius.powi(-moment.length_power());
    let component = |c: &Component| {
        let (sum, _) = typed_sum(typed_wendland_c2, d, radius, moment, &c.name, &pairs);
        (sum * unit, c.multiplicity)
    };
    moment.components(d).iter().map(component).collect()
}

/// |S − S^reg| of one sample, by typed formulas over a neighbourhood reaching `reach`.
fn typed_deviation(spec: &SampleSpec, moment: Moment, sample: u64, reach: f64) -> f64 {
    let still = SampleSpec { amplitude: 0.0, ..spec.clone() };
    let moved = typed_moment(spec, moment, &displaced(spec, sample, reach));
    let regular = typed_moment(&still, moment, &displaced(&still, sample, reach));
    let squares =
        moved.iter().zip(&regular).map(|((s, many), (reg, _))| *many as f64 * (s - reg) * (s - reg));
    squares.sum::<f64>().sqrt()
}

/// `Sampler` against neighbourhoods placed and summed by hand, for both volume rules and all models: sample by sample,
/// since a block of one sample has |S − S^reg| as its sum. The hand-made neighbourhood reaches three spacings further than any
/// particle can see, so a site that `Sampler` forgot would show; that it agrees for two R also shows that R does not change
/// a sample. Agreement is to rounding: S is at most about 10 and h-scaled, hence 1e-11.
/// Fails if `Sampler` draws from the stream in the order of visits, if its reach with number-density volumes is R + 4 longest,
/// if `number_density` leaves out k = j, if `offset` moves all particles, or if the other models leave the centre in place.
#[test]
fn samples_agree_with_neighbourhoods_made_by_hand() {
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw", "sum_ddw", "sum_lapw"];
    for rule in VolumeRule::ALL {
        for disorder in ["offset:0.3", "box:0.8", "canonical:0.3"] {
            for (lattice, support) in
                [("line", 2.5), ("line", 6.3), ("square", 2.2), ("square", 3.15), ("simple-cubic", 1.6)]
            {
                let spec = spec(disorder, lattice, support, rule, &names);
                let sampler = Sampler::new(spec.clone()).unwrap();
                let reach = 2.0 * support + 3.0;
                for sample in [0, 1, 77] {
                    let block = sampler.block(sample, 1).unwrap();
                    assert_eq!((block.samples, block.degenerate), (1, 0));
                    for (index, name) in names.iter().enumerate() {
                        let by_hand = typed_deviation(&spec, moment(name), sample, reach);
                        let found = block.moments[index].sum;
                        assert!(
                            (found - by_hand).abs() <= 1e-11,
                            "{rule}/{disorder}/{lattice}/{support}/{name} sample {sample}: {found} and {by_hand}"
                        );
                    }
                }
            }
        }
    }
}

/// Units where R ≠ h: `Sampler` gives S in h^{p−q}; with R = 2h the moment Σω∇W is half of what it is per R, Σωrr∇W twice.
/// `offset:A` on the line against the typed cubic spline: particle i alone at ±A, S(−A) = ∓S(A), so every sample is the same.
/// Fails if `to_h` turns its exponent, if `offset` moves all particles, or with κ^{2k} for κ^{2k−n} in `Evaluator`.
#[test]
fn an_offset_particle_sees_a_rigid_displacement() {
    let support = 4.3;
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw", "sum_lapw"];
    let spec = SampleSpec {
        kernel: kernel::cubic_spline(),
        ..spec("offset:0.2", "line", support, VolumeRule::Constant, &names)
    };
    let block = Sampler::new(spec).unwrap().block(0, 40).unwrap();
    for (index, name) in names.iter().enumerate() {
        let moment = moment(name);
        let at = |a: f64| {
            let others = (-9..=9).filter(|j| *j != 0).map(|j| ([a - f64::from(j), 0.0, 0.0], 1.0));
            let pairs: Vec<_> = others.chain([([0.0; 3], 1.0)]).collect();
            let component = &moment.components(1)[0].name;
            typed_sum(typed_cubic_spline, 1, support, moment, component, &pairs).0
        };
        let h = 0.5 * support;
        for sign in [1.0, -1.0] {
            let by_hand = (at(0.2 * sign) - at(0.0)).abs() * h.powi(-moment.length_power());
            let statistics = block.moments[index];
            assert!(by_hand > 1e-6, "{name} does not notice the displacement");
            assert!((statistics.max - by_hand).abs() <= 1e-12, "{name}: {} and {by_hand}", statistics.max);
            assert!((statistics.sum / 40.0 - by_hand).abs() <= 1e-12, "{name}");
        }
    }
}

/// For a displacement d̃ of particle i alone, Taylor gives S − S^reg = d̃·∇S + ½ d̃d̃:∇∇S: odd moments of a centrosymmetric
/// lattice grow like d̃, even ones like d̃². Between A and 2A the ratio is 2^1 or 2^2 up to terms of relative order A²/Δ²
/// (A for kernels with a kink; Wendland C2 has |r|³). Fails if the amplitude is squared, or if `offset`
/// moves all particles.
#[test]
fn exponents_of_the_displacement() {
    let names = ["sum_w", "sum_dw", "b_inverse", "sum_rrdw"];
    let rms = |disorder: &str, index| {
        let spec = spec(disorder, "line", 4.37, VolumeRule::Constant, &names);
        summarise(&[Sampler::new(spec).unwrap().block(0, 8).unwrap()], index).rms
    };
    for (index, exponent) in [(0, 2.0), (1, 1.0), (2, 2.0), (3, 1.0)] {
        let slope = (rms("offset:0.002", index) / rms("offset:0.001", index)).log2();
        assert!((slope - exponent).abs() < 0.02, "{}: {slope}, not {exponent}", names[index]);
    }
}

/// Independent displacements of variance σ² per axis: S = Σω∇W changes by δS_a = Σ_j ω H_ab(r_ij) (d_i − d_j)_b with
/// H = ∇∇W, so
/// ⟨|δS|²⟩ = σ² Σ_ab [(Σ_{j≠i} ω H_ab)² + Σ_{j≠i} (ω H_ab)²]:
/// the first term is the rigid displacement of Fatehi & Manzari's Eq. (38), the second the random walk they leave out.
/// `box:ε` has κ uniform in [−1/4, 1/4], variance (1/2)²/12 = 1/48, so σ² = ε²Δ²/48; `canonical:η` has σ² = η²Δ²/D.
/// The RMS of n samples has a relative standard error of at most 1/√(2n), that of a Gaussian (sums of bounded displacements
/// have lighter tails); it may be off by four of them, 3.2 % for n = 8000. At an amplitude of 1e-3 the second order in d is
/// below that by an order of magnitude. The rigid term alone must miss by more than that.
/// Fails with −1/2 … 1/2 for −1/4 … 1/4 in `random_box`, or if the centre is left in place.
#[test]
fn independent_displacements_add_up_like_a_random_walk() {
    const SAMPLES: u64 = 8000;
    let tolerance = 4.0 / (2.0 * SAMPLES as f64).sqrt();
    for (disorder, lattice, support) in [
        ("box:0.001", "line", 5.3),
        ("canonical:0.001", "line", 3.5),
        ("box:0.001", "square", 3.15),
        ("canonical:0.001", "square", 2.6),
    ] {
        let spec = spec(disorder, lattice, support, VolumeRule::Constant, &["sum_dw"]);
        let d = spec.lattice.dimension();
        let variance = match spec.disorder.model() {
            "box" => spec.amplitude * spec.amplitude / 48.0,
            _ => spec.amplitude * spec.amplitude / d as f64,
        };
        let others: Vec<_> = looped(lattice).into_iter().filter(|r| *r != [0.0; 3]).collect();
        let (mut rigid, mut walk) = (0.0, 0.0);
        for (a, b) in (0..d).flat_map(|a| (0..d).map(move |b| (a, b))) {
            let of = |r: &[f64; 3]| derivative(typed_wendland_c2, d, support, r, &[a, b]);
            rigid += others.iter().map(of).sum::<f64>().powi(2);
            walk += others.iter().map(|r| of(r).powi(2)).sum::<f64>();
        }
        // S is in units of 1/h.
        let rms = |square: f64| (variance * square).sqrt() * support;
        let blocks: Vec<SampleBlock> = {
            let sampler = Sampler::new(spec).unwrap();
            (0..4).map(|block| sampler.block(block * SAMPLES / 4, SAMPLES / 4).unwrap()).collect()
        };
        let measured = summarise(&blocks, 0);
        assert_eq!(measured.samples, SAMPLES);
        let off = |expected: f64| (measured.rms / expected - 1.0).abs();
        let place = format!("{disorder} on the {lattice}");
        assert!(off(rms(rigid + walk)) < tolerance, "{place}: {} and {}", measured.rms, rms(rigid + walk));
        assert!(off(rms(rigid)) > 2.0 * tolerance, "{place}: the rigid term alone explains {}", measured.rms);
        assert!(
            measured.rms_error < measured.rms * tolerance / 4.0 * 1.1,
            "{place}: ± {}",
            measured.rms_error
        );
    }
}

/// The words of a site do not depend on which other sites are visited, nor on the support that asks for them.
/// Fails if `SampleStream::words` does not seek.
#[test]
fn the_support_does_not_change_a_sample() {
    let lattice = lattice_by_id("hexagonal").unwrap();
    let words = |reach: f64| {
        let mut stream = SampleStream::new(5, 9);
        lattice.sites_within(reach).iter().map(|site| (site.cell, stream.words(site))).collect::<Vec<_>>()
    };
    let (near, far) = (words(3.15), words(7.9));
    assert!(near.len() == 37 && far.len() > 200);
    for (cell, words) in &near {
        let same = far.iter().find(|(other, _)| other == cell).unwrap();
        assert_eq!(&same.1, words, "cell {cell:?}");
    }
    // No two sites share their words.
    let mut seen: Vec<_> = far.iter().map(|(_, words)| words[0]).collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), far.len());
}
