//! The laws that displacements are drawn from, for those who take expectations in place of samples.

/// What one displacement u is distributed like, in units of amplitude · Δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Each component even in [−a, a], independently.
    Box {
        /// a.
        half: f64,
    },
    /// A direction uniform on the unit circle or sphere; in 1-D a sign.
    Sphere,
    /// In 3-D the angle about `axis` even and the angle from it even too, which is not uniform; else as `Sphere`.
    Angles {
        /// The polar axis.
        axis: usize,
    },
    /// Each component standard normal, independently.
    Normal,
}

impl Shape {
    /// ⟨u_a²⟩; different components are uncorrelated in every shape.
    pub fn variance(self, dimension: usize, axis: usize) -> f64 {
        match self {
            Self::Box { half } => half * half / 3.0,
            Self::Angles { axis: pole } if dimension == 3 => {
                if axis == pole {
                    0.5
                } else {
                    0.25
                }
            }
            Self::Sphere | Self::Angles { .. } => 1.0 / dimension as f64,
            Self::Normal => 1.0,
        }
    }
}

/// The joint law of all displacements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// Particles that move do so independently, each by this.
    Independent(Shape),
    /// u = e sin(k·x + φ) with φ even in [0, 2π).
    Wave {
        /// The wavelength, in units of h or of Δ.
        wavelength: f64,
        /// Whether in units of h.
        in_h: bool,
        /// The axis along which k points; drawn uniformly from the circle or sphere if none.
        along: Option<usize>,
        /// Whether e is across k, uniform on the circle across it in 3-D, and not along it.
        transverse: bool,
    },
    /// u = ξ x̂, ξ even in [−1/2, 1/2) and independent for each row.
    Rows,
    /// u = x̂ for every other row, without chance.
    AlternateRows,
}
