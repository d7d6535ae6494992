//! Particles: the cloud that is analysed and the pairs that interact.
pub mod cloud;
pub mod neighbours;
