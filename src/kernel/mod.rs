//! Radial kernels: exact piecewise polynomials, and the Gaussian, cut off.
//!
//! W(r, h) = σ_D h^{-D} w(q), q = r/h. A kernel is its profile w with a citation; everything else (σ_D, β, the
//! behaviour at the origin and at each knot, the derivatives, the continuum moments) is computed from w. This is the
//! only layer that the derived and the measured column share.
//!
//! A new family is one file beside `wendland.rs` and `bspline.rs` and one line in [`catalogue`].

mod audit;
mod bspline;
mod continuum;
mod convention;
mod definition;
mod error;
mod evaluate;
mod gaussian;
mod radial;
mod wendland;

pub use audit::{Audit, ConventionAudit, Inflection, NormalisationAudit, PrintedAudit};
pub use bspline::{cubic_spline, quartic_spline, quintic_spline};
pub use continuum::{SummandTerm, sphere_monomial};
pub use convention::{Convention, conventions};
pub use definition::{KernelDefinition, PieceDefinition};
pub use error::KernelError;
pub use evaluate::{Evaluator, RadialValues};
pub(crate) use evaluate::{LANES, Shape};
pub use gaussian::gaussian;
pub use radial::{Jump, Kernel, Printed, Profile, RadialFunction, RadialPiece};
pub use wendland::{wendland_c2, wendland_c2_1d, wendland_c4, wendland_c4_1d, wendland_c6, wendland_c6_1d};

use crate::names::nearest;

/// An id and what constructs its kernel.
type Entry = (&'static str, fn() -> Kernel);

/// By id, so that naming one does not construct them all.
const ENTRIES: [Entry; 10] = [
    ("wendland-c2", wendland_c2),
    ("wendland-c4", wendland_c4),
    ("wendland-c6", wendland_c6),
    ("wendland-c2-1d", wendland_c2_1d),
    ("wendland-c4-1d", wendland_c4_1d),
    ("wendland-c6-1d", wendland_c6_1d),
    ("cubic-spline", cubic_spline),
    ("quartic-spline", quartic_spline),
    ("quintic-spline", quintic_spline),
    ("gaussian", gaussian),
];

/// The kernels that can be named in a scene or on the command line.
pub fn catalogue() -> Vec<Kernel> {
    ENTRIES.iter().map(|(_, construct)| construct()).collect()
}

/// The kernel of the catalogue with this id; `gaussian:cut=2.5` cuts the Gaussian at 2.5 h.
///
/// # Errors
/// [`KernelError::Unknown`] with the nearest known id, [`KernelError::Cut`].
///
/// # Examples
/// ```
/// let kernel = remainder::kernel::by_id("wendland-c2").unwrap();
/// assert_eq!(kernel.beta(), 3);
/// ```
pub fn by_id(id: &str) -> Result<Kernel, KernelError> {
    by_id_among(id, &[])
}

/// The kernel with this id, of the catalogue or of one's own.
///
/// # Errors
/// As [`by_id`].
pub fn by_id_among(id: &str, own: &[Kernel]) -> Result<Kernel, KernelError> {
    if let Some(parameters) = id.strip_prefix("gaussian:") {
        return gaussian::with_parameters(parameters);
    }
    if let Some(kernel) = own.iter().find(|kernel| kernel.id() == id) {
        return Ok(kernel.clone());
    }
    if let Some((_, construct)) = ENTRIES.iter().find(|(known, _)| *known == id) {
        return Ok(construct());
    }
    let ids: Vec<&str> = own.iter().map(Kernel::id).chain(ENTRIES.map(|(known, _)| known)).collect();
    Err(KernelError::Unknown { id: id.to_owned(), nearest: nearest(id, &ids), known: ids.join(", ") })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_constructs_the_kernel_that_it_names() {
        for (id, construct) in ENTRIES {
            assert_eq!(construct().id(), id);
        }
    }
}
