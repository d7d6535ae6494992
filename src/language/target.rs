//! What an operator approximates: c ρ_i^a μ_i^b times a derivative of the field.

use super::tree::{Field, Operator, Units};
use crate::exact::{Rational, int};
use num_traits::Zero;
use std::fmt;

/// A derivative. Index order of the value: the field's own index, then those of ∇; but ∇²v and ∇(∇·v) have one index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Derivative {
    /// u, or v.
    Value,
    /// ∇u, or v∇ (∂_b v_a).
    Gradient,
    /// ∇·v.
    Divergence,
    /// ∇∇u, or v∇∇ (∂_b ∂_c v_a).
    Hessian,
    /// ∇²u, or ∇²v + n ∇(∇·v).
    Laplacian {
        /// n; 0 for u.
        grad_div: i32,
    },
}

/// c ρ_i^a μ_i^b times a derivative.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Target {
    /// The derivative.
    pub derivative: Derivative,
    /// c.
    pub factor: i32,
    /// a.
    pub density: i32,
    /// b.
    pub viscosity: i32,
}

impl Target {
    /// The derivative itself.
    pub const fn plain(derivative: Derivative) -> Self {
        Self { derivative, factor: 1, density: 0, viscosity: 0 }
    }

    /// The derivative that an operator's rank and units say, where these leave one: what is measured in 1/length² and has
    /// the rank of the field is a Laplacian.
    pub fn inferred(operator: &Operator) -> Option<Self> {
        let units = operator.root.units;
        let rank = operator.rank();
        let own = operator.field.rank();
        let derivative = match (-units.length, rank) {
            (0, r) if r == own => Derivative::Value,
            (1, r) if r == own + 1 => Derivative::Gradient,
            (1, 0) if own == 1 => Derivative::Divergence,
            (2, r) if r == own + 2 => Derivative::Hessian,
            (2, r) if r == own => Derivative::Laplacian { grad_div: 0 },
            _ => return None,
        };
        let target = Self { derivative, factor: 1, density: units.mass, viscosity: units.viscosity };
        (target.units() == units).then_some(target)
    }

    /// What it is measured in, the field's unit left out.
    pub fn units(&self) -> Units {
        Units {
            length: -i32::from(self.order()),
            volume: -self.density,
            mass: self.density,
            viscosity: self.viscosity,
        }
    }

    /// The order of the derivative: 0, 1 or 2.
    pub fn order(&self) -> u8 {
        match self.derivative {
            Derivative::Value => 0,
            Derivative::Gradient | Derivative::Divergence => 1,
            Derivative::Hessian | Derivative::Laplacian { .. } => 2,
        }
    }

    /// Rank of the value.
    pub fn rank(&self, field: Field) -> u8 {
        match self.derivative {
            Derivative::Value | Derivative::Laplacian { .. } => field.rank(),
            Derivative::Gradient => field.rank() + 1,
            Derivative::Divergence => 0,
            Derivative::Hessian => field.rank() + 2,
        }
    }

    /// The coefficient, c times 0, 1 or n, of ∂_α v_c (or ∂_α u, `component` 0) in the value's component `value`, for the
    /// derivative indices `alpha` in any order; ρ and μ left out. Zero unless `alpha` has the order of the target.
    pub fn coefficient(&self, field: Field, value: &[usize], alpha: &[usize], component: usize) -> Rational {
        if alpha.len() != usize::from(self.order()) {
            return Rational::zero();
        }
        let vector = field == Field::Vector;
        let own = |given: Option<&usize>| !vector || given == Some(&component);
        let sorted = |indices: &[usize]| {
            let mut indices = indices.to_vec();
            indices.sort_unstable();
            indices
        };
        let rest = &value[usize::from(vector).min(value.len())..];
        let count = match self.derivative {
            Derivative::Value => i64::from(own(value.first())),
            Derivative::Gradient | Derivative::Hessian => {
                // ∂_α is symmetric: where its indices differ, each order of them is the same derivative.
                i64::from(own(value.first()) && sorted(rest) == sorted(alpha))
            }
            Derivative::Divergence => i64::from(alpha[0] == component),
            Derivative::Laplacian { grad_div } => {
                let laplacian = i64::from(own(value.first()) && alpha[0] == alpha[1]);
                let mut mixed = 0;
                if vector {
                    // ∂_a ∂_c v_c, for either order of α = (a, c).
                    let hits = [(0, 1), (1, 0)]
                        .iter()
                        .any(|(a, c)| value.first() == Some(&alpha[*a]) && alpha[*c] == component);
                    mixed = i64::from(grad_div) * i64::from(hits);
                }
                laplacian + mixed
            }
        };
        int(i64::from(self.factor) * count)
    }

    /// As text: `∇²v + 2∇(∇·v)`.
    pub fn formula(&self, field: Field) -> String {
        let f = field.name();
        let vector = field == Field::Vector;
        let derivative = match self.derivative {
            Derivative::Value => f.to_owned(),
            Derivative::Gradient if vector => "v∇".into(),
            Derivative::Gradient => format!("∇{f}"),
            Derivative::Divergence => format!("∇·{f}"),
            Derivative::Hessian if vector => "v∇∇".into(),
            Derivative::Hessian => format!("∇∇{f}"),
            Derivative::Laplacian { grad_div: 0 } => format!("∇²{f}"),
            Derivative::Laplacian { grad_div } => format!("(∇²{f} + {grad_div}∇(∇·{f}))"),
        };
        let power = |name: &str, exponent: i32| match exponent {
            0 => String::new(),
            1 => format!("{name} "),
            n => format!("{name}^{n} "),
        };
        let factor = match self.factor {
            1 => String::new(),
            -1 => "−".into(),
            n => format!("{n} "),
        };
        format!("{factor}{}{}{derivative}", power("μ_i", self.viscosity), power("ρ_i", self.density))
    }
}

impl fmt::Display for Derivative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Value => "value",
            Self::Gradient => "gradient",
            Self::Divergence => "divergence",
            Self::Hessian => "hessian",
            Self::Laplacian { .. } => "laplacian",
        })
    }
}
