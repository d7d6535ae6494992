//! The measured column: particles placed, sums taken, power laws fitted.
//!
//! Uses floating point and random numbers (and the exact lattice sums, the ground that both columns are checked against);
//! never the derived column.

mod bounded;
mod coefficient;
mod constants;
mod domain;
mod double_double;
mod error;
mod error_sample;
pub mod fit;
mod momentum;
mod placed;
pub mod precision;
mod pressure;
mod program;
mod regular;
mod rounding;
mod row;
mod sample;
mod squared_error;
mod stencil;
mod symbol;
mod tensor;
mod viscosity;
mod walls;
pub mod window;

pub use domain::{Domain, DomainError, DomainSpec, Laid};
pub use error::{FitError, Input};
pub use error_sample::{SampledError, sampled_error};
pub use momentum::{Totals, totals};
pub use placed::{PlaceError, Placed};
pub use pressure::{Correction, GradientForm, PressureErrors, PressureField, PressureSpec, pressure_errors};
pub use program::{Fields, Operations, Program, ProgramError, Weights};
pub use regular::{RegularError, RegularNorm, RegularRung, RegularSpec, regular_rung};
pub use rounding::{Rounding, RoundingError, computed, rounding};
pub use row::{RowErrors, RowVolumes, row_errors};
pub use sample::{
    CLOSEST, MomentStatistics, SampleBlock, SampleError, SampleSpec, Sampler, Summary, is_precise,
    neighbourhood_radius, summarise,
};
pub use squared_error::{SquaredError, applied, mean_neighbours};
pub use stencil::{Degeneracy, Stencil, StencilEntry, StencilError, stencil};
pub use symbol::{Symbol, SymbolError, SymbolValue};
pub use viscosity::measured_response;
pub use walls::{Channel, Wall, WallError};
