//! What can go wrong in time.

use crate::measured::ProgramError;
use crate::particles::CloudError;
use thiserror::Error;

/// A run that grew without bound, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Unstable {
    /// Steps taken when it was stopped.
    pub step: u64,
    /// The time then.
    pub time: f64,
    /// The largest magnitude then.
    pub largest: f64,
    /// The unknown at which it stands.
    pub unknown: usize,
    /// λ = uᵀAu/uᵀu of what grew: the eigenvalue of the mode that took over, if it is one.
    pub rate: f64,
}

/// Errors of this layer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum EvolveError {
    /// The operator has no values on these particles.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The particles are at fault.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// The operator does not map a scalar to a scalar.
    #[error(
        "only an operator that takes a scalar field to a scalar is a matrix here; this one has {components} components"
    )]
    Rank {
        /// Components of its value.
        components: usize,
    },
    /// The step is not positive and finite.
    #[error("the time step {step} is not positive and finite")]
    Step {
        /// The step.
        step: f64,
    },
    /// A run blew up.
    #[error(
        "the run is unstable: after {} steps, at t = {}, the largest value is {:.2e}, growing in a mode of rate {:.3e}: take a smaller step, or a stabilised or implicit method",
        .0.step, .0.time, .0.largest, .0.rate
    )]
    Unstable(Unstable),
    /// The linear solver did not reach its tolerance.
    #[error(
        "the linear solver is left with a relative residual of {residual:.1e} after {iterations} iterations"
    )]
    NotSolved {
        /// What is left.
        residual: f64,
        /// Iterations taken.
        iterations: usize,
    },
    /// A pivot of the incomplete factorisation is zero.
    #[error("row {row} of the matrix has a zero pivot")]
    Pivot {
        /// The row.
        row: usize,
    },
}
