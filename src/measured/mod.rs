//! The measured column: particles placed, sums taken, power laws fitted.
//!
//! Uses floating point and random numbers (and the exact lattice sums, the ground that both columns are checked against);
//! never the derived column.

mod coefficient;
mod double_double;
mod error;
mod error_sample;
pub mod fit;
mod program;
mod regular;
mod sample;
mod stencil;
mod symbol;
mod tensor;
pub mod window;

pub use error::{FitError, Input};
pub use error_sample::{SampledError, sampled_error};
pub use program::{Fields, Program, ProgramError};
pub use regular::{RegularError, RegularNorm, RegularRung, RegularSpec, regular_rung};
pub use sample::{
    CLOSEST, MomentStatistics, SampleBlock, SampleError, SampleSpec, Sampler, Summary, is_precise,
    neighbourhood_radius, summarise,
};
pub use stencil::{Degeneracy, Stencil, StencilEntry, StencilError, stencil};
pub use symbol::{Symbol, SymbolError, SymbolValue};
