//! Operators in time: assembling a matrix, one product with it, the sums taken anew, and one step of Euler's method on the heat
//! problem with 80 × 80 particles, R/Δ = 2.5.

#![allow(clippy::unwrap_used)] // A bench may fail.

use divan::Bencher;
use remainder::evolve::heat::{Boundary, HeatProblem};
use remainder::evolve::{Explicit, march};
use remainder::kernel::by_id;
use remainder::language::operators;
use remainder::measured::Program;

fn main() {
    divan::main();
}

const SCHEMES: [&str; 2] = ["S3", "S4"];

fn program(scheme: &str) -> Program {
    let operator = operators::by_id(scheme).unwrap().operator().unwrap();
    Program::new(&operator, &by_id("wendland-c2").unwrap(), 2).unwrap()
}

fn problem() -> HeatProblem {
    HeatProblem { n: 80, h_over_dx: 2.5, epsilon: 0.4, seed: 1, boundary: Boundary::CutOff, jump: None }
}

#[divan::bench(args = SCHEMES)]
fn assembly(bencher: Bencher<'_, '_>, scheme: &str) {
    let program = program(scheme);
    bencher.bench(|| problem().discretise(&program).unwrap().system.matrix.entries());
}

#[divan::bench(args = SCHEMES)]
fn product(bencher: Bencher<'_, '_>, scheme: &str) {
    let heat = problem().discretise(&program(scheme)).unwrap();
    let u = vec![1.0; heat.system.matrix.width()];
    bencher.bench(|| heat.system.matrix.apply(&u));
}

#[divan::bench(args = SCHEMES)]
fn hundred_steps_of_euler(bencher: Bencher<'_, '_>, scheme: &str) {
    let heat = problem().discretise(&program(scheme)).unwrap();
    let step = 0.1 * heat.closest * heat.closest;
    bencher.with_inputs(|| vec![0.0; heat.places.len()]).bench_values(|mut u| {
        march(&heat.system, Explicit::Euler, &mut u, step, 100).unwrap();
        u
    });
}
