//! Operators in time: matrices against operators, integrators against exact solutions and their own orders, runs that blow up.
//!
//! Planted, one for each test but `only_scalar_to_scalar_operators_are_matrices`: a wrong weight, half step, stage or
//! exponential, a limit of stability too high, no end of growth, walls that reflect or conduct wrongly.

#![allow(clippy::unwrap_used, clippy::panic)] // A failed unwrap is a failed test.

use nalgebra::{Complex, DMatrix, DVector};
use remainder::evolve::heat::{Boundary, HeatProblem, layered};
use remainder::evolve::{
    EvolveError, Explicit, Implicit, Matrix, System, assemble, chebyshev_stages, chebyshev_stretches,
    exponential, march, march_implicit, march_stretches, spectrum, steady,
};
use remainder::kernel::by_id;
use remainder::language::{Operator, operators};
use remainder::measured::{Fields, Program};
use remainder::particles::{Cloud, Neighbours, Support};

fn jittered(n: usize) -> Cloud {
    let mut state = 3_u64;
    let mut jitter = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.3 * ((state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
    };
    let places = (0..n * n).map(|k| [(k / n) as f64 + jitter(), (k % n) as f64 + jitter(), 0.0]).collect();
    Cloud::new(2, places, vec![1.0; n * n], Support::Uniform(2.6)).unwrap()
}

fn program(id: &str) -> Program {
    let operator = operators::by_id(id).unwrap().operator().unwrap();
    Program::new(&operator, &by_id("wendland-c2").unwrap(), 2).unwrap()
}

fn heat(n: usize, h_over_dx: f64, epsilon: f64, boundary: Boundary) -> HeatProblem {
    HeatProblem { n, h_over_dx, epsilon, seed: 5, boundary, jump: None }
}

#[test]
fn a_matrix_does_what_its_operator_does() {
    let cloud = jittered(9);
    let u: Vec<f64> =
        cloud.positions().iter().map(|[x, y, _]| (0.7 * x).sin() + (0.4 * y * x).cos()).collect();
    let rows: Vec<usize> = (0..cloud.len()).filter(|k| k % 3 != 0).collect();
    for id in ["S3", "S4", "S2-11", "S1-8-F4", "S1-7-F2"] {
        let program = program(id);
        let matrix = assemble(&program, &cloud, &rows).unwrap();
        let all = program.apply(&cloud, &Neighbours::search(&cloud).unwrap(), Fields::Scalar(&u)).unwrap();
        let largest = all.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (row, value) in rows.iter().zip(matrix.apply(&u)) {
            assert!((value - all[*row]).abs() < 1e-12 * largest, "{id}: {value} is {} at {row}", all[*row]);
        }
    }
}

#[test]
fn rows_of_s4_are_exact_on_quadratics_and_not_on_cubics() {
    let cloud = jittered(9);
    let rows: Vec<usize> = (0..cloud.len()).collect();
    let matrix = assemble(&program("S4"), &cloud, &rows).unwrap();
    let of = |f: &dyn Fn(f64, f64) -> f64| {
        let u: Vec<f64> = cloud.positions().iter().map(|[x, y, _]| f(*x, *y)).collect();
        matrix.apply(&u)
    };
    let quadratic = of(&|x, y| 3.0 - x + 2.0 * y + x * x - 3.0 * x * y + 0.5 * y * y);
    assert!(quadratic.iter().all(|v| (v - 3.0).abs() < 1e-9));
    let cubic = of(&|x, _| x * x * x);
    let worst =
        cubic.iter().zip(cloud.positions()).map(|(v, [x, ..])| (v - 6.0 * x).abs()).fold(0.0, f64::max);
    assert!(worst > 1e-3, "{worst}");
}

#[test]
fn only_scalar_to_scalar_operators_are_matrices() {
    let gradient =
        Program::new(&operators::by_id("F4").unwrap().operator().unwrap(), &by_id("wendland-c2").unwrap(), 2)
            .unwrap();
    assert!(matches!(assemble(&gradient, &jittered(5), &[12]), Err(EvolveError::Rank { components: 2 })));
}

/// A small system that is neither symmetric nor normal.
fn small() -> (System, DMatrix<f64>, DVector<f64>) {
    let n = 12;
    let entry = |i: usize, j: usize| match (i as i64) - (j as i64) {
        0 => -4.0 - 0.1 * i as f64,
        1 => 1.9,
        -1 => 1.2,
        3 => 0.3,
        _ => 0.0,
    };
    let rows = (0..n).map(|i| (0..n).map(|j| (j as u32, entry(i, j))).collect());
    let source: Vec<f64> = (0..n).map(|i| (i as f64 * 0.7).cos()).collect();
    let dense = DMatrix::from_fn(n, n, entry);
    (System { matrix: Matrix::from_rows(n, rows), source: source.clone() }, dense, DVector::from_vec(source))
}

/// u(t) by the dense exponential of the system with one unknown more.
fn dense_solution(a: &DMatrix<f64>, b: &DVector<f64>, u: &[f64], t: f64) -> Vec<f64> {
    let n = u.len();
    let mut wide = DMatrix::zeros(n + 1, n + 1);
    wide.view_mut((0, 0), (n, n)).copy_from(&(a * t));
    wide.view_mut((0, n), (n, 1)).copy_from(&(b * t));
    let start = DVector::from_iterator(n + 1, u.iter().copied().chain([1.0]));
    (wide.exp() * start).iter().take(n).copied().collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn each_method_has_its_order_and_not_one_more() {
    let (system, a, b) = small();
    let u0: Vec<f64> = (0..12).map(|i| (i as f64).sin()).collect();
    let exact = dense_solution(&a, &b, &u0, 1.0);
    let explicit = |method| {
        move |steps: u64| {
            let (system, ..) = small();
            let mut u: Vec<f64> = (0..12).map(|i| (i as f64).sin()).collect();
            march(&system, method, &mut u, 1.0 / steps as f64, steps).unwrap();
            u
        }
    };
    let implicit = |method| {
        let system = &system;
        let u0 = &u0;
        move |steps: u64| {
            let mut u = u0.clone();
            march_implicit(system, method, &mut u, 1.0 / steps as f64, steps).unwrap();
            u
        }
    };
    let check = |name: &str, order: f64, run: &dyn Fn(u64) -> Vec<f64>| {
        let (coarse, fine) = (apart(&run(40), &exact), apart(&run(80), &exact));
        let found = (coarse / fine).log2();
        assert!((found - order).abs() < 0.15, "{name}: order {found:.3}, {coarse:.2e} to {fine:.2e}");
    };
    check("euler", 1.0, &explicit(Explicit::Euler));
    check("rk2", 2.0, &explicit(Explicit::Rk2));
    check("rk4", 4.0, &explicit(Explicit::Rk4));
    check("rkc", 2.0, &explicit(Explicit::Rkc(7)));
    check("implicit euler", 1.0, &implicit(Implicit::Euler));
    check("tr-bdf2", 2.0, &implicit(Implicit::TrBdf2));
}

#[test]
fn steps_that_grow_add_up_to_the_time() {
    for (time, steps, radius) in
        [(0.1, 200, 8e4), (0.1, 1, 8e4), (0.1, 7, 8e4), (3.0, 50, 1.0), (3.0, 50, 0.0)]
    {
        let stretches = chebyshev_stretches(time, steps, radius);
        let (count, sum) = stretches
            .iter()
            .fold((0, 0.0), |(count, sum), s| (count + s.steps, sum + s.step * s.steps as f64));
        assert_eq!(count, steps);
        assert!((sum - time).abs() < 1e-14 * time * steps as f64, "{sum} is {time}");
        assert!(stretches.iter().all(|s| s.steps > 0 && chebyshev_stages(radius * s.step) == s.stages));
        let grows = |pair: &[remainder::evolve::Stretch]| {
            pair[1].step >= pair[0].step * (1.0 - 1e-12) && pair[1].step <= pair[0].step * (1.3 + 1e-12)
        };
        assert!(stretches.windows(2).all(grows), "{stretches:?}");
    }
    assert!(chebyshev_stretches(0.1, 200, 8e4)[0].step == 1.0 / 8e4);
}

/// What the jump at the wall puts into stiff modes is gone before steps get long; with equal steps it is not.
#[test]
fn steps_that_grow_damp_what_a_jump_leaves() {
    let heat = heat(40, 2.5, 0.0, Boundary::CutOff).discretise(&program("S4")).unwrap();
    let start = vec![0.0; heat.places.len()];
    let (exact, _) = exponential(&heat.system, &start, 0.1, 1e-10).unwrap();
    let radius = 1.1 * spectrum::radius(&heat.system.matrix, 60);
    let (mut grown, mut equal) = (start.clone(), start);
    march_stretches(&heat.system, &chebyshev_stretches(0.1, 50, radius), &mut grown).unwrap();
    march(&heat.system, Explicit::Rkc(chebyshev_stages(radius * 0.002)), &mut equal, 0.002, 50).unwrap();
    let (grown, equal) = (apart(&grown, &exact), apart(&equal, &exact));
    assert!(grown < 1e-4 && equal > 20.0 * grown, "{grown:e} {equal:e}");
}

#[test]
fn the_exponential_is_the_dense_one() {
    let (system, a, b) = small();
    let u0: Vec<f64> = (0..12).map(|i| (i as f64).sin()).collect();
    for t in [0.01, 1.0, 50.0] {
        let (u, _) = exponential(&system, &u0, t, 1e-11).unwrap();
        assert!(apart(&u, &dense_solution(&a, &b, &u0, t)) < 1e-9, "t = {t}");
    }
    // More unknowns than a Krylov space, so that the estimate decides on the pieces of time.
    let heat = heat(16, 2.5, 0.3, Boundary::CutOff).discretise(&program("S4")).unwrap();
    let (dense, source) = (heat.system.matrix.dense(), DVector::from_vec(heat.system.source.clone()));
    let zero = vec![0.0; heat.places.len()];
    let (u, _) = exponential(&heat.system, &zero, 0.1, 1e-9).unwrap();
    assert!(apart(&u, &dense_solution(&dense, &source, &zero, 0.1)) < 1e-7);
    let steady = steady(&heat.system).unwrap();
    assert!(apart(&exponential(&heat.system, &zero, 3.0, 1e-9).unwrap().0, &steady) < 1e-7);
}

#[test]
fn a_step_multiplies_a_mode_by_its_amplification() {
    for (method, rate) in
        [(Explicit::Euler, -0.7), (Explicit::Rk2, -1.3), (Explicit::Rk4, -2.1), (Explicit::Rkc(5), -11.0)]
    {
        let system = System { matrix: Matrix::from_rows(1, [vec![(0, rate)]]), source: vec![0.0] };
        let mut u = vec![1.0];
        march(&system, method, &mut u, 1.0, 1).unwrap();
        let factor = method.amplification(Complex::new(rate, 0.0));
        assert!((u[0] - factor.re).abs() < 1e-12 && factor.im == 0.0, "{}: {} {factor}", method.id(), u[0]);
    }
    for stages in 2..60 {
        let inside = 0.6529 * f64::from(stages * stages - 1);
        let worst = (1..400).map(|k| {
            Explicit::Rkc(stages).amplification(Complex::new(-inside * f64::from(k) / 400.0, 0.0)).norm()
        });
        assert!(worst.fold(0.0, f64::max) <= 1.0, "{stages} stages");
        let beyond = Explicit::Rkc(stages).amplification(Complex::new(-1.1 * inside - 2.0, 0.0)).norm();
        assert!(beyond > 1.0, "{stages} stages: {beyond}");
        assert!(chebyshev_stages(inside) <= stages && chebyshev_stages(1.3 * inside + 3.0) > stages);
    }
}

#[test]
fn beyond_its_largest_step_a_run_is_stopped_and_says_where() {
    let heat = heat(10, 2.5, 0.4, Boundary::CutOff).discretise(&program("S4")).unwrap();
    let values = spectrum::eigenvalues(&heat.system.matrix);
    let step = spectrum::largest_step(&values, Explicit::Euler).unwrap();
    let radius = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!((spectrum::radius(&heat.system.matrix, 400) / radius - 1.0).abs() < 1e-3);
    let start: Vec<f64> = (0..heat.places.len()).map(|i| ((i * i) as f64).sin()).collect();
    march(&heat.system, Explicit::Euler, &mut start.clone(), 0.97 * step, 3000).unwrap();
    let Err(EvolveError::Unstable(found)) =
        march(&heat.system, Explicit::Euler, &mut start.clone(), 1.03 * step, 3000)
    else {
        panic!("a step above the largest one went through");
    };
    assert!(
        found.step < 3000 && found.largest > 1e5 && (found.rate / -radius - 1.0).abs() < 0.05,
        "{found:?}"
    );
    assert!(matches!(
        march(&heat.system, Explicit::Euler, &mut start.clone(), f64::NAN, 1),
        Err(EvolveError::Step { .. })
    ));
    // A system with a mode that grows has no stable step.
    let growing = Matrix::from_rows(2, [vec![(0, 1.0)], vec![(1, -1.0)]]);
    assert_eq!(spectrum::largest_step(&spectrum::eigenvalues(&growing), Explicit::Euler), None);
}

#[test]
fn the_steady_heat_problem_of_s4_converges_with_the_second_order_of_its_derivation() {
    // S4 on a regular interior is exact on cubics by symmetry, so its steady error there is O(h²) at constant h/Δ.
    let error = |n: usize| {
        let heat = heat(n, 1.5, 0.0, Boundary::CutOff).discretise(&program("S4")).unwrap();
        heat.errors(&steady(&heat.system).unwrap(), 100.0).l2
    };
    let rate = (error(12) / error(23)).log2();
    assert!((1.7..2.4).contains(&rate), "{rate}");
}

#[test]
fn ghosts_continue_what_is_odd_about_the_walls() {
    // With ghosts a regular grid is a periodic odd extension, on which S3 is symmetric in x and y about every wall: the
    // interior rows next to x = 0 act on sin πx as those in the middle do.
    let problem = heat(21, 2.5, 0.0, Boundary::Ghosts);
    let heat = problem.discretise(&program("S3")).unwrap();
    let u: Vec<f64> = heat
        .places
        .iter()
        .map(|[x, y]| (std::f64::consts::PI * x).sin() * (std::f64::consts::PI * y).sin())
        .collect();
    let ratios: Vec<f64> = heat.system.matrix.apply(&u).iter().zip(&u).map(|(a, u)| a / u).collect();
    let (low, high) =
        ratios.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), r| (l.min(*r), h.max(*r)));
    assert!(high - low < 1e-9 * high.abs(), "sin πx sin πy is an eigenvector: {low} to {high}");
}

/// Mirrored, T is odd about its value on the wall and has no second derivative there. The steady solution has none across three of
/// the walls, and π² sin πx across the fourth: there alone S4 is off by a part of that, whatever the spacing.
#[test]
fn ghosts_lack_a_second_derivative_where_the_solution_has_one() {
    for n in [20, 40] {
        let heat = heat(n, 3.5, 0.2, Boundary::Ghosts).discretise(&program("S4")).unwrap();
        // T − T^num with T^num = 0, long after the last transient.
        let t = heat.difference(&vec![0.0; heat.places.len()], 100.0);
        let residuals = heat.system.matrix.apply(&t).into_iter().zip(&heat.system.source).map(|(a, b)| a + b);
        let mut worst = [0.0_f64; 2];
        for (residual, [_, y]) in residuals.zip(&heat.places) {
            let worst = &mut worst[usize::from(1.0 - y < heat.support)];
            *worst = worst.max(residual.abs());
        }
        let [elsewhere, there] = worst;
        assert!(
            (1.0..30.0).contains(&there) && elsewhere < 0.1,
            "{n}: {there} at the wall y = 1, {elsewhere} elsewhere"
        );
    }
}

#[test]
fn layers_conduct_in_series_with_the_harmonic_mean() {
    let text = "sum_j 4 V_j mu_i mu_j / (mu_i + mu_j) (u_i - u_j) / |r_ij| e_ij . gradW_ij";
    let program = Program::new(&Operator::parse(text).unwrap(), &by_id("wendland-c2").unwrap(), 2).unwrap();
    let jump = 1e6;
    let error = |n: usize| {
        let problem = HeatProblem { jump: Some(jump), ..heat(n, 2.5, 0.0, Boundary::Ghosts) };
        let problem = HeatProblem { boundary: Boundary::CutOff, ..problem };
        let heat = problem.discretise(&program).unwrap();
        let u = steady(&heat.system).unwrap();
        let square: f64 = u.iter().zip(&heat.places).map(|(u, [_, y])| (u - layered(*y, jump)).powi(2)).sum();
        (square / u.len() as f64).sqrt()
    };
    let (coarse, fine) = (error(12), error(24));
    assert!(fine < 0.6 * coarse && fine < 0.1, "{coarse} {fine}");
    assert!((layered(0.5, jump) - layered(0.4999999, jump)).abs() < 1e-5);
}

#[test]
fn threads_do_not_change_a_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let heat = heat(40, 2.5, 0.4, Boundary::CutOff).discretise(&program("S4")).unwrap();
            let (mut u, _) = exponential(&heat.system, &vec![0.0; heat.places.len()], 0.01, 1e-6).unwrap();
            march(&heat.system, Explicit::Rkc(9), &mut u, 1e-3, 3).unwrap();
            march_implicit(&heat.system, Implicit::TrBdf2, &mut u, 0.05, 2).unwrap();
            u
        })
    };
    assert_eq!(run(1), run(3));
}
