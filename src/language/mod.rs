//! The operator language: operators as the papers print them, typed and checked.
//!
//! ```text
//! sum_j V_j (u_j - u_i) B_i . gradW_ij                                     F4, Fatehi & Manzari 2011, Eq. (5)
//! 2 (D + 2) sum_j V_j (r_ij . (v_i - v_j)) / (|r_ij|^2 + 0.01 h^2) gradW_ij   MCG, Chaussonnet et al. 2015, Eq. (30)
//! Σ_j ω_j F2[u]_j · ∇W_ij                                                   S1, Eq. (7), with F2 inside
//! ```
//!
//! The grammar, with an example for each rule, is in `docs/operators.md`. Everything below reads the typed tree
//! ([`tree`]): the symbolic expansion in `derived`, stencils and compiled operators in `measured`.

mod error;
pub mod ground;
pub mod operators;
mod parse;
mod subject;
mod target;
mod token;
pub mod tree;
mod viscous;

pub use error::LanguageError;
pub use subject::{Coefficient, Subject};
pub use target::{Derivative, Target};
pub use tree::{Field, Operator};
pub use viscous::{FlowDirection, ViscousModel};
