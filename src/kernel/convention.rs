//! What h means where: R/h of each kernel in codes and papers, as data.

use super::Kernel;
use super::SummandTerm;
use crate::exact::{Coefficient, MultiIndex, Radical, Rational, int, ratio};

/// R/h as one code or paper defines h.
#[derive(Debug, Clone, PartialEq)]
pub struct Convention {
    /// The code or paper.
    pub who: &'static str,
    /// The dimension, where R/h depends on it.
    pub dimension: Option<usize>,
    /// R/h.
    pub support_over_h: Radical,
    /// Where it is defined.
    pub source: &'static str,
}

const PYSPH: (&str, &str) = ("PySPH", "pysph/base/kernels.py, radius_scale");
const DUAL: (&str, &str) = ("DualSPHysics", "FunSphKernel.h; JCaseCtes.cpp: h = coefh √D Δ");
const SPLISH: (&str, &str) = ("SPlisHSPlasH", "SPHKernels.h: m_radius is the support");
const GADGET: (&str, &str) = ("GADGET-2", "Springel 2005, Eq. (4): h is the support");
const FATEHI: (&str, &str) = ("Fatehi & Manzari 2011", "Eq. (47)");
/// Not in so many words: 2h holds the 30 neighbours of §6, 3h the 29, 37 and 123 of §II.C.
const BASA: (&str, &str) = ("Basa et al. 2009", "§6: about 30 neighbours at Δ/h = 0.637");
const CHAUSSONNET: (&str, &str) = ("Chaussonnet et al. 2015", "§II.C: 29 neighbours at h/Δ = 1.05");
/// h = 2σ with σ² the second moment, for these kernels and dimensions.
const SWIFT: (&str, &str) = ("SWIFT", "kernel_hydro.h (γ); kernel_definitions.tex (2σ)");

/// (who and where, kernel, R/h).
const FIXED: &[((&str, &str), &str, i64)] = &[
    (PYSPH, "cubic-spline", 2),
    (PYSPH, "quintic-spline", 3),
    (PYSPH, "gaussian", 3),
    (PYSPH, "wendland-c2", 2),
    (PYSPH, "wendland-c4", 2),
    (PYSPH, "wendland-c6", 2),
    (PYSPH, "wendland-c2-1d", 2),
    (PYSPH, "wendland-c4-1d", 2),
    (PYSPH, "wendland-c6-1d", 2),
    (DUAL, "wendland-c2", 2),
    (DUAL, "cubic-spline", 2),
    (SPLISH, "cubic-spline", 1),
    (SPLISH, "wendland-c2", 1),
    (GADGET, "cubic-spline", 1),
    (FATEHI, "wendland-c2", 1),
    (BASA, "cubic-spline", 2),
    (CHAUSSONNET, "quintic-spline", 3),
];

/// (kernel, dimensions) of SWIFT; its Wendland C2 has the form made for the dimension, its C4 and
/// C6 are not defined in one.
const BY_SECOND_MOMENT: &[(&str, &[usize])] = &[
    ("cubic-spline", &[1, 2, 3]),
    ("quartic-spline", &[1, 2, 3]),
    ("quintic-spline", &[1, 2, 3]),
    ("wendland-c2", &[2, 3]),
    ("wendland-c4", &[2, 3]),
    ("wendland-c6", &[2, 3]),
    ("wendland-c2-1d", &[1]),
];

/// The conventions known for a kernel.
pub fn conventions(kernel: &Kernel) -> Vec<Convention> {
    let fixed = FIXED.iter().filter(|(_, id, _)| *id == kernel.id());
    let mut all: Vec<Convention> = fixed
        .map(|((who, source), _, support)| Convention {
            who,
            dimension: None,
            support_over_h: Radical::from(int(*support)),
            source,
        })
        .collect();
    let dimensions = BY_SECOND_MOMENT.iter().filter(|(id, _)| *id == kernel.id()).flat_map(|(_, d)| *d);
    for dimension in dimensions {
        let Coefficient::Exact(second) = kernel.second_moment(*dimension, 0) else { continue };
        // R/h = R/(2σ), σ² in units of the entry's own h.
        let square: Rational = kernel.support_over_h() * kernel.support_over_h() * ratio(1, 4) / second;
        let Ok(support_over_h) = Radical::sqrt_of(&square) else { continue };
        let (who, source) = SWIFT;
        all.push(Convention { who, dimension: Some(*dimension), support_over_h, source });
    }
    all
}

impl Kernel {
    /// ∫ x² W dV in units of h²: exact for polynomial kernels, else enclosed with `bits` fractional bits.
    ///
    /// # Examples
    /// ```
    /// // The central B-spline of degree n has the variance (n + 1)/12.
    /// let kernel = remainder::kernel::by_id("cubic-spline").unwrap();
    /// assert_eq!(kernel.second_moment(1, 0).to_string(), "1/3");
    /// ```
    pub fn second_moment(&self, dimension: usize, bits: u32) -> Coefficient {
        let term = SummandTerm { coefficient: 1, monomial: MultiIndex::new([2, 0, 0]), radial: 0 };
        self.continuum_limit(dimension, &[term], bits)
    }
}
