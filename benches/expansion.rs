//! Expansion of built-in operators to sixth order: aimed at under 50 ms each.

#![allow(clippy::unwrap_used)] // A failed unwrap is a failed benchmark.

use divan::Bencher;
use remainder::derived::Expansion;
use remainder::language::operators;

fn main() {
    divan::main();
}

#[divan::bench(args = ["F4", "S3", "S4", "S1-7-F4", "S1-9-F4", "mixed-correction", "shepard-hessian", "MCG", "C"])]
fn to_sixth_order(bencher: Bencher, id: &str) {
    let entry = operators::by_id(id).unwrap();
    bencher.bench(|| Expansion::of(entry.operator().unwrap(), Some(entry.target.clone()), 6).unwrap());
}
