//! Viscous models applied to quadratic flows on particles.

use super::placed::{PlaceError, Placed};
use crate::kernel::Kernel;
use crate::language::{FlowDirection, ViscousModel};
use crate::particles::{Lattice, VolumeRule};

/// What the bare sum of a model gives along t on v = t (n·r)²/2, at a site of a lattice.
///
/// # Errors
/// [`PlaceError`].
pub fn measured_response(
    model: ViscousModel,
    kernel: &Kernel,
    lattice: &Lattice,
    support_over_dx: f64,
    rule: VolumeRule,
    direction: FlowDirection,
    regularised: bool,
) -> Result<f64, PlaceError> {
    // The second pass of model B reads the first of all neighbours.
    let reach = if model == ViscousModel::B { 2.0 } else { 1.0 };
    let placed = Placed::regular(kernel, lattice, support_over_dx, rule, reach)?;
    let [n, t] = direction.vectors();
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let flow = |x: &[f64; 3]| t.map(|t| 0.5 * t * dot(&n, x) * dot(&n, x));
    let values = placed.vector(kernel, &model.bare(regularised)?, flow)?;
    let of_centre = values.into_iter().flatten();
    Ok(of_centre.zip(t).map(|(value, t)| value * t).sum())
}
