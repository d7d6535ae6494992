//! The rows of `viscosity_constants`: what makes each model give μ∇²v, beside what is printed.

use super::super::TaskError;
use super::viscosity::{Response, is_of_the_paper};
use crate::claim::basa_2009::{CHAUSSONNET_FACTOR, MODEL_C_FACTOR, XI_CLEARY, XI_POISEUILLE};
use crate::derived::continuum_response;
use crate::kernel::{self, Kernel};
use crate::language::{FlowDirection, ViscousModel};
use crate::particles::VolumeRule;
use crate::record::{Report, ViscosityConstant, significant};

/// The printed constants.
const PRINTED: [(ViscousModel, f64); 4] = [
    (ViscousModel::C, MODEL_C_FACTOR),
    (ViscousModel::D, XI_CLEARY),
    (ViscousModel::D, XI_POISEUILLE),
    (ViscousModel::Mcg, CHAUSSONNET_FACTOR),
];

/// In the continuum, with and without η, in 2-D and 3-D.
pub(super) fn continuum_rows(kernel: &Kernel, report: &mut Report) -> Result<(), TaskError> {
    let quintic = kernel::by_id("quintic-spline")?;
    for dimension in [2, 3] {
        for (model, published) in PRINTED {
            let kernel = if model == ViscousModel::Mcg { &quintic } else { kernel };
            for regularised in [false, true] {
                for direction in FlowDirection::in_dimension(dimension) {
                    let f = continuum_response(model, kernel, dimension, *direction, regularised);
                    report.viscosity_constants.push(ViscosityConstant {
                        model: model.id().into(),
                        dimension: dimension as u8,
                        kernel: kernel.id().into(),
                        lattice: "continuum".into(),
                        dx_over_h: 0.0,
                        volume_rule: VolumeRule::Constant.id().into(),
                        regularised,
                        direction: direction.id().into(),
                        derived: significant(1.0 / (model.unit_of_constant(dimension) * f), 10),
                        published,
                    });
                }
            }
        }
    }
    Ok(())
}

/// On the lattices: the paper's kernel at every Δx/h for models C and D, ξ = 4.24 at the spacing it was calibrated at;
/// the quintic spline at h/Δ = 1.05 for MCG.
pub(super) fn constant_rows(all: &[Response], own: &str, paper: f64, report: &mut Report) {
    for (model, published) in PRINTED {
        for response in all.iter().filter(|response| response.model == ViscousModel::C.id()) {
            let asked = match model {
                ViscousModel::Mcg => response.support == 3.15,
                _ if response.kernel != own => false,
                _ if published == XI_POISEUILLE => {
                    response.support == paper || is_of_the_paper(response.dx_over_h)
                }
                _ => true,
            };
            if !asked {
                continue;
            }
            let unit = model.unit_of_constant(response.dimension);
            report.viscosity_constants.push(ViscosityConstant {
                model: model.id().into(),
                dimension: response.dimension as u8,
                kernel: response.kernel.clone(),
                lattice: response.lattice.clone(),
                dx_over_h: significant(response.dx_over_h, 8),
                volume_rule: response.rule.clone(),
                regularised: response.regularised,
                direction: response.direction.clone(),
                derived: significant(1.0 / (unit * response.value()), 10),
                published,
            });
        }
    }
}
