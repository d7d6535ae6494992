//! The derived column of a study: exponents that follow from the kernel's smoothness, the lattice and the disorder.

use crate::claim::{Claim, Quantity};
use crate::derived::{CoefficientOrder, DisorderOrder, Displaced, RegularOrder};
use crate::exact::{Rational, int, rational_text};
use crate::kernel::Kernel;
use crate::language::Subject;
use crate::particles::{Disorder, Lattice, VolumeRule};
use num_traits::Zero as _;

/// What is derived for one claim in one case.
#[derive(Debug, Clone, PartialEq)]
pub enum DerivedColumn {
    /// d̃^displacement (Δ/h)^dx_over_h; the exponent of h follows from the units.
    Exponents {
        /// Of d̃.
        displacement: Rational,
        /// Of Δ/h.
        dx_over_h: Rational,
        /// Where it comes from.
        from: String,
    },
    /// It vanishes by symmetry.
    ZeroBySymmetry,
}

impl DerivedColumn {
    /// As in `d̃ (Δ/h)^3/2`.
    pub fn power_law(&self) -> String {
        match self {
            Self::ZeroBySymmetry => "zero by symmetry".into(),
            Self::Exponents { displacement, dx_over_h, .. } => {
                let power = |name: &str, exponent: &Rational| match rational_text(exponent).as_str() {
                    "0" => None,
                    "1" => Some(name.to_owned()),
                    text => Some(format!("{name}^{text}")),
                };
                let parts = [power("d̃", displacement), power("(Δ/h)", dx_over_h)];
                let parts: Vec<String> = parts.into_iter().flatten().collect();
                if parts.is_empty() { "a constant".into() } else { parts.join(" ") }
            }
        }
    }
}

/// The derived column of a claim, where it can be derived: volumes are taken as constant.
pub(super) fn derived(
    claim: &Claim,
    kernel: &Kernel,
    lattice: &Lattice,
    disorder: Option<&Disorder>,
    rule: VolumeRule,
    vanishes: bool,
) -> Option<DerivedColumn> {
    let Some(quantity) = claim.quantity() else {
        return vanishes.then_some(DerivedColumn::ZeroBySymmetry);
    };
    if vanishes && !quantity.is_disordered() {
        return Some(DerivedColumn::ZeroBySymmetry);
    }
    if rule != VolumeRule::Constant {
        return None;
    }
    match (quantity, &claim.subject) {
        (Quantity::DisorderDeviation, subject) => {
            let displaced = Displaced::by(disorder?)?;
            let (term, reason) = match subject {
                Subject::Moment(moment) => {
                    let order = DisorderOrder::of(kernel, lattice, *moment, &displaced).ok()?;
                    (order.dominant().clone(), order.reason)
                }
                Subject::Coefficient(coefficient) => {
                    let order = CoefficientOrder::of(coefficient, kernel, lattice).ok()?;
                    order.disordered(kernel, lattice, &displaced).ok()??
                }
            };
            let (displacement, dx_over_h) = (term.displacement, term.dx_over_h);
            Some(DerivedColumn::Exponents { displacement, dx_over_h, from: reason })
        }
        (Quantity::RegularValue | Quantity::RegularDeviation, subject) => {
            let of_value = quantity == Quantity::RegularValue;
            let exponent = match subject {
                Subject::Moment(moment) => {
                    let order = RegularOrder::of(kernel, lattice, *moment).ok()?;
                    if of_value { order.value_exponent() } else { order.exponent().cloned() }
                }
                Subject::Coefficient(coefficient) => {
                    let order = CoefficientOrder::of(coefficient, kernel, lattice).ok()?;
                    let found = if of_value {
                        order.value(kernel, lattice)
                    } else {
                        order.deviation(kernel, lattice)
                    };
                    found.ok()?
                }
            }?;
            let from =
                if exponent.is_zero() { "its continuum limit is not zero" } else { "the lattice's tail" };
            Some(DerivedColumn::Exponents { displacement: int(0), dx_over_h: exponent, from: from.into() })
        }
    }
}
