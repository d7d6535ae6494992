//! Radial kernels as exact piecewise polynomials.
//!
//! W(r, h) = σ_D h^{-D} w(q), q = r/h. A kernel is its profile w with a citation; everything else (σ_D, β, the
//! behaviour at the origin and at each knot, the derivatives, the continuum moments) is computed from w. This is the
//! only layer that the derived and the measured column share.
//!
//! A new family is one file beside `wendland.rs` and `bspline.rs` and one line in [`catalogue`].

mod bspline;
mod continuum;
mod error;
mod evaluate;
mod radial;
mod wendland;

pub use bspline::{cubic_spline, quintic_spline};
pub use continuum::{SummandTerm, sphere_monomial};
pub use error::KernelError;
pub use evaluate::{Evaluator, RadialValues};
pub use radial::{Jump, Kernel, RadialPiece};
pub use wendland::{wendland_c2, wendland_c4};

use crate::names::nearest;

/// The kernels that can be named in a scene or on the command line.
pub fn catalogue() -> Vec<Kernel> {
    vec![wendland_c2(), wendland_c4(), cubic_spline(), quintic_spline()]
}

/// The kernel of the catalogue with this id.
///
/// # Errors
/// [`KernelError::Unknown`] with the nearest known id.
///
/// # Examples
/// ```
/// let kernel = remainder::kernel::by_id("wendland-c2").unwrap();
/// assert_eq!(kernel.beta(), 3);
/// ```
pub fn by_id(id: &str) -> Result<Kernel, KernelError> {
    let known = catalogue();
    let ids: Vec<&str> = known.iter().map(Kernel::id).collect();
    match ids.iter().position(|candidate| *candidate == id) {
        Some(index) => Ok(known[index].clone()),
        None => {
            Err(KernelError::Unknown { id: id.to_owned(), nearest: nearest(id, &ids), known: ids.join(", ") })
        }
    }
}
