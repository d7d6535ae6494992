//! Moment sums of every particle of a cloud in one pass: millions of particles at the speed of the machine.
//!
//! | file | what it does |
//! | --- | --- |
//! | `request`    | which sums are wanted, and the fewest passes that give them |
//! | `sorted`     | particles in rows of cells, sorted along each row, one column per quantity |
//! | `reach`      | windows that slide along the rows, candidates, and the neighbours among them |
//! | `radial`     | G_k in lanes |
//! | `arithmetic` | a few particles at a time: neighbours, kernel, sums |
//! | `lanes`      | eight f64, and what is done with them; the portable path |
//! | `vector`     | the same on AVX2 and AVX-512; all unsafe code of the crate |
//! | `run`        | checks, blocks, threads |
//! | `counted`    | a test of what sums cost |
//!
//! The neighbours of a particle, in the order of the sorted particles, go to the lanes 0 … 7 in turn. Each lane adds up its
//! own, and the lanes are added in one fixed order, with no fused operation. Neither the number of threads, nor the
//! instructions the machine has, nor the order in which particles are given changes a bit (with the one exception that
//! particles in one place with equal weights and fields are interchangeable, which changes nothing either).

mod arithmetic;
#[cfg(test)]
mod counted;
mod lanes;
mod radial;
mod reach;
mod request;
mod run;
mod sorted;
mod vector;

pub use request::{Factor, RadialSum};
pub use run::{Centre, Engine, Points};
pub use vector::Path;
