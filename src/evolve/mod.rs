//! Operators in time: on particles that do not move an operator is a sparse matrix, assembled once, and ∂u/∂t = A u + b.
//!
//! - [`Matrix`]: sparse rows; [`assemble`]: any operator of the language that maps a scalar field to a scalar.
//! - [`System`]: u′ = A u + b and its right-hand side.
//! - [`Explicit`]: Euler, two Runge–Kutta methods and the stabilised Runge–Kutta–Chebyshev method, with [`Unstable`] runs stopped.
//! - [`Implicit`]: implicit Euler and TR-BDF2, by BiCGSTAB with an incomplete factorisation.
//! - [`exponential`]: the semi-discrete system solved to a tolerance, by Krylov spaces.
//! - [`spectrum`]: eigenvalues, spectral radius, largest stable steps.
//!
//! All sums are taken in one order, so that results are the same bits on any number of threads.

mod assemble;
mod error;
mod explicit;
pub mod heat;
mod implicit;
mod krylov;
mod matrix;
pub mod spectrum;
mod system;

pub use assemble::assemble;
pub use error::{EvolveError, Unstable};
pub use explicit::{Explicit, Stretch, chebyshev_stages, chebyshev_stretches, march, march_stretches};
pub use implicit::{Implicit, Solver, march_implicit, steady};
pub use krylov::exponential;
pub use matrix::Matrix;
pub use system::System;
