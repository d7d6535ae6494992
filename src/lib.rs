//! A symbolic-numeric truncation-error analyser for Smoothed Particle Hydrodynamics.
pub mod claim;
pub mod cli;
pub mod exact;
pub mod kernel;
pub mod measured;
pub mod names;
pub mod particles;
pub mod report;
pub mod study;
pub mod sums;
