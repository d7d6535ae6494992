//! A symbolic-numeric truncation-error analyser for Smoothed Particle Hydrodynamics.
pub mod exact;
pub mod measured;
pub mod particles;
