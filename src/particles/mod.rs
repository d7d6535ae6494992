//! Particles: lattices with exact coordinates, disorder, volume rules, clouds and their neighbours.
//!
//! Follows `kernel` and is used by `sums`.

mod cloud;
pub mod disorder;
mod error;
pub mod lattice;
mod neighbours;
mod stream;
mod symmetry;
mod volume;

pub use cloud::{ClosestPair, Cloud, CloudError, LENGTH_LIMIT, PERIODS_LIMIT, Quantity, Support};
pub use disorder::{Disorder, DisorderModel, Draw, Law, Motion, Moves, Reach, Shape};
pub use error::ParticleError;
pub use lattice::{Lattice, Site, SiteIndex, lattice_among, lattice_by_id};
pub use neighbours::{Neighbour, Neighbours};
pub use stream::SampleStream;
pub use symmetry::{Operation, PointGroup, sites_are_equivalent};
pub use volume::VolumeRule;
