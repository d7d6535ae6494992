//! The derived column: operators expanded in their Taylor series, with proofs of what vanishes; orders of moment sums by
//! Poisson's formula. No particle is placed, no number is fitted or drawn.
//!
//! - `algebra`, `canonical`, `normal`, `rules`: expressions and their normal form.
//! - `build`: from an operator's tree to its expression, the Taylor series in place of the field.
//! - `expansion`: order by order, what multiplies ∇^m u, and what is left when the target is taken off.
//! - `arrangement`: particles with rational places, on which what is left is shown not to vanish.
//! - `jet`, `modes`, `displaced`, `rms`: the error on displaced particles, differentiated with respect to each of them.
//! - `quadrature`, `expectation`, `finite`: moment sums averaged over the whole law of the displacements.
//! - `neighbour_distance`: how far apart neighbours are under canonical disorder.
//! - `laplacian_factor`: by what bare Laplacians multiply u″ in the continuum.
//! - `conserve`: which sums are conserved, whatever the field.
//! - `own_cells`: a sum on a displaced line, with volumes that are the particles' own cells.
//! - `channel`: the start-up of the flow in a channel.
//! - `viscosity`: the constants of viscous models.
//! - `orders`: moment sums as powers of Δ/h and of the displacement.

mod algebra;
mod arrangement;
mod build;
mod canonical;
mod channel;
mod conserve;
mod displaced;
mod error;
mod evaluate;
mod expansion;
mod expectation;
mod finite;
mod jet;
mod laplacian_factor;
mod modes;
mod neighbour_distance;
mod normal;
pub mod orders;
mod own_cells;
mod quadrature;
mod rms;
mod rules;
mod viscosity;
mod write;

pub use arrangement::Arrangement;
pub use channel::Channel as ChannelFlow;
pub use conserve::{Conservation, Conserved};
pub use error::DeriveError;
pub use expansion::{Expansion, MOST_ORDER, OrderTerms, VanishingTerm};
pub use finite::finite;
pub use laplacian_factor::regularisation_factor;
pub use neighbour_distance::{NeighbourDistance, neighbour_distance};
pub use orders::{
    Amplitude, CoefficientOrder, ComponentOrder, Contribution, Crossing, Deviation, DisorderOrder,
    DisorderTerm, Displaced, Envelope, RegularOrder, Source, Term,
};
pub use own_cells::{row_amplitude, row_exponent, row_regular_exponent, row_second_exponent};
pub use rms::{ComponentError, Model, RmsError, Setting, linearised};
pub use viscosity::{
    LatticeFlow, continuum_constant, continuum_response, lattice_response, second_derivative_of_one,
    stress_divergence,
};
pub use write::{Format, Printed};
