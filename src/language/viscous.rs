//! Models of the viscous term as Basa, Quinlan & Lastiwka (2009) compare them, and the flows they are tried on.
//!
//! All of them are taken for unit density and viscosity, where models C and D of Eqs. (33), (34) and the Laplacian MCG of
//! Chaussonnet et al. (2015), Eq. (30), are one sum times a number: K Σ V (v_ij·r_ij)/(r² + 0.01 h²) ∇W.

use super::{LanguageError, Operator};

/// What the printed constant of a central model stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ViscousModel {
    /// Direct second derivatives, Eq. (27), in the viscous term of Eq. (6).
    A,
    /// Two passes of first derivatives, Eq. (29), in the divergence of the stress of Eq. (4).
    B,
    /// Eq. (33): K = 8.
    C,
    /// Eq. (34): K = 2 ξ.
    D,
    /// Eq. (35).
    E,
    /// Chaussonnet et al., Eq. (30): K = 2 (D + 2) times a factor.
    Mcg,
}

/// A flow v = t (n·r)²/2 about particle i; n and t are unit vectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlowDirection {
    /// t = x, n = y: the flow of a channel along an axis of the lattice.
    ShearAxis,
    /// t = (x − y)/√2, n = (x + y)/√2: a channel along the diagonal.
    ShearDiagonal,
    /// t = n = x: not divergence-free.
    Compression,
}

impl ViscousModel {
    /// The models of the paper.
    pub const OF_THE_PAPER: [Self; 5] = [Self::A, Self::B, Self::C, Self::D, Self::E];

    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
            Self::C => "C",
            Self::D => "D",
            Self::E => "E",
            Self::Mcg => "MCG",
        }
    }

    /// Whether it is K Σ V (v_ij·r_ij)/(r² + η²) ∇W.
    pub fn is_central(self) -> bool {
        matches!(self, Self::C | Self::D | Self::Mcg)
    }

    /// K over the constant that is printed: 1 for C, 2 for ξ, 2 (D + 2) for the factor of Eq. (30).
    pub fn unit_of_constant(self, dimension: usize) -> f64 {
        match self {
            Self::D => 2.0,
            Self::Mcg => 2.0 * (dimension as f64 + 2.0),
            _ => 1.0,
        }
    }

    /// What multiplies ∂²v_t/∂n² in the term that the model is meant for: μ∇²v for C, D and E (Eq. 30), the whole of
    /// Eq. (6), μ(∇²v + ∇(∇·v)/3), for A and B.
    pub fn target(self, direction: FlowDirection) -> f64 {
        match (self, direction) {
            (Self::A | Self::B, FlowDirection::Compression) => 4.0 / 3.0,
            _ => 1.0,
        }
    }

    /// The sum for unit density and viscosity, the constant of a central model and its η² left out if so asked.
    ///
    /// # Errors
    /// None; the texts are checked by a test.
    pub fn bare(self, regularised: bool) -> Result<Operator, LanguageError> {
        Operator::parse(match (self, regularised) {
            (Self::A, _) => "sum_j V_j v_j lapW_ij + 1/3 sum_j V_j gradgradW_ij . v_j",
            (Self::B, _) => {
                "sum_j V_j (sum_k V_k v_k gradW_jk) . gradW_ij + sum_j V_j gradW_ij . (sum_k V_k v_k gradW_jk) \
                 - 2/3 sum_j V_j (sum_k V_k v_k . gradW_jk) gradW_ij"
            }
            (Self::E, _) => "2 sum_j V_j (r_ij . gradW_ij) / |r_ij|^2 (v_i - v_j)",
            (_, true) => "sum_j V_j ((v_i - v_j) . r_ij) / (|r_ij|^2 + 0.01 h^2) gradW_ij",
            (_, false) => "sum_j V_j ((v_i - v_j) . r_ij) / |r_ij|^2 gradW_ij",
        })
    }
}

impl FlowDirection {
    /// Those that exist in `dimension` dimensions.
    pub fn in_dimension(dimension: usize) -> &'static [Self] {
        match dimension {
            1 => &[Self::Compression],
            _ => &[Self::ShearAxis, Self::ShearDiagonal, Self::Compression],
        }
    }

    /// The name used in reports.
    pub fn id(self) -> &'static str {
        match self {
            Self::ShearAxis => "shear-axis",
            Self::ShearDiagonal => "shear-diagonal",
            Self::Compression => "compression",
        }
    }

    /// n and t.
    pub fn vectors(self) -> [[f64; 3]; 2] {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::ShearAxis => [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
            Self::ShearDiagonal => [[half, half, 0.0], [half, -half, 0.0]],
            Self::Compression => [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_is_an_operator() {
        for model in ViscousModel::OF_THE_PAPER {
            for regularised in [false, true] {
                assert!(model.bare(regularised).is_ok(), "{}", model.id());
            }
        }
    }
}
