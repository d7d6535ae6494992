//! Operators of the language compiled for speed.
//!
//! ```text
//! typed tree ─▶ lower: scalar expressions, shared ─▶ schedule: passes of instructions ─▶ run: blocks of pairs
//! ```
//!
//! [`lower`] writes every component of the tree as scalar expressions, of which equal ones are one, and takes out of each
//! sum whatever the particle summed over does not enter: F4 = B_i · Σ V_j (u_j − u_i) ∇W_ij, so that B_i⁻¹ and the sum are
//! taken in one pass over the pairs. What a sum needs of its neighbours' own sums is stored by an earlier pass.
//! [`schedule`] turns the expressions of each pass into instructions on registers, and [`run`] carries these out on a few
//! hundred pairs at a time. Lengths are in units of R throughout; the result is given its unit at the end. On particles that
//! do not move, [`weights`] takes what the operator multiplies each neighbour's u by.

mod compile;
mod count;
mod error;
mod expression;
mod instruction;
mod kernel;
mod lower;
mod products;
mod run;
mod schedule;
mod solve;
mod split;
mod weights;

pub use compile::{Fields, Program};
pub use count::Operations;
pub use error::ProgramError;
pub use weights::Weights;
