//! Moment sums: exact on lattices, in floating point over given pairs, and over all pairs of a cloud.
//!
//! Follows `particles` and is used by both columns; lattice sums are the common ground that both are checked against.

mod engine;
mod error;
mod lattice_sum;
mod moment;
mod pair_sum;
mod reduction;
mod roots;
mod shells;

pub use engine::{Centre, Engine, Factor, Path, Points, RadialSum};
pub use error::SumError;
pub use lattice_sum::{LatticeSums, SupportCount, nearest_distance};
pub use moment::{Component, MAX_DERIVATIVES, MAX_POSITIONS, Moment};
pub use pair_sum::{Accumulator, PairSums};
pub use reduction::{Reduction, Standing};
pub use shells::Shells;
