//! The derived error behind `advise` against particles: a wave on a displaced lattice, the operator applied to it.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use remainder::kernel::by_id;
use remainder::language::{Derivative, operators};
use remainder::measured::{Fields, Program};
use remainder::particles::{Cloud, Disorder, Draw, Neighbours, SampleStream, Site, Support, lattice_by_id};
use remainder::study::{AdviceRequest, advise};

/// Relative RMS error of an operator on e^{ikx} over the particles of a displaced periodic square lattice.
fn on_a_wave(id: &str, kernel: &str, support: f64, disorder: &Disorder, wavelength: usize) -> f64 {
    let lattice = lattice_by_id("square").unwrap();
    let (n, motion) = (3 * wavelength, disorder.motion());
    let mut stream = SampleStream::new(11, 0);
    let mut places = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let site = Site { cell: [i as i64, j as i64, 0], basis: 0, position: [i as f64, j as f64, 0.0] };
        let unit = (motion.unit)(&mut Draw::new(&lattice, &site, support, &mut stream));
        places.push([
            i as f64 + disorder.amplitude() * unit[0],
            j as f64 + disorder.amplitude() * unit[1],
            0.0,
        ]);
    }
    let k = 2.0 * std::f64::consts::PI / wavelength as f64;
    let cloud = Cloud::new(2, places, vec![1.0; n * n], Support::Uniform(support)).unwrap();
    let cloud = cloud.with_periods([Some(n as f64), Some(n as f64), None]).unwrap();
    let lists = Neighbours::search(&cloud).unwrap();
    let operator = operators::by_id(id).unwrap().operator().unwrap();
    let program = Program::new(&operator, &by_id(kernel).unwrap(), 2).unwrap();
    let mut square = 0.0;
    for wave in [f64::sin as fn(f64) -> f64, f64::cos] {
        let u: Vec<f64> = cloud.positions().iter().map(|x| wave(k * x[0])).collect();
        let found = program.apply(&cloud, &lists, Fields::Scalar(&u)).unwrap();
        square += found.iter().zip(&u).map(|(l, u)| (l + k * k * u).powi(2)).sum::<f64>();
    }
    (square / (n * n) as f64).sqrt() / (k * k)
}

#[test]
fn what_is_advised_does_on_particles_what_was_derived() {
    let lattice = lattice_by_id("square").unwrap();
    let disorder = Disorder::parse("box:0.1").unwrap();
    let request = AdviceRequest {
        derivative: Derivative::Laplacian { grad_div: 0 },
        tolerance: 0.3,
        lattice: &lattice,
        disorder: Some(&disorder),
        wavelength: 30.0,
        budget: Some(40),
    };
    let advice = advise(&request);
    let mut compared = 0;
    for candidate in [&advice.best, &advice.runner_up].into_iter().flatten() {
        let measured =
            on_a_wave(&candidate.operator, &candidate.kernel, candidate.support_over_dx, &disorder, 30);
        let ratio = measured / candidate.error;
        assert!((0.85..1.2).contains(&ratio), "{candidate:?}: {measured}");
        compared += 1;
    }
    assert_eq!(compared, 2, "{advice:?}");
    // A tighter budget never gives a dearer answer, and nothing is looked at beyond it.
    let tight = advise(&AdviceRequest { budget: Some(8), tolerance: 1e-9, ..request });
    assert!(
        tight.best.is_none() && tight.most_accurate.is_some_and(|c| c.neighbours <= 8) && tight.left_out == 0
    );
}
