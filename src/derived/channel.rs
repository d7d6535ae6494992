//! The start-up of the flow between two plates, derived anew: Eq. (36) of Basa et al. (2009) does not start from rest as printed.
//!
//! ∂u/∂t = ν ∂²u/∂y² + f with u = 0 at y = ±d and at t = 0. What is left to the steady parabola, w = u − U₀ (1 − y²/d²), decays
//! without a force; its modes are cos((2n+1)πy/2d), and the cosine series of the parabola,
//!
//! ```text
//! 1 − y²/d² = 32/π³ Σ_n (−1)ⁿ/(2n+1)³ cos((2n+1)πy/2d)
//! u/U₀ = 1 − y²/d² − 32/π³ Σ_n (−1)ⁿ/(2n+1)³ cos((2n+1)πy/2d) exp(−(2n+1)² t*)
//! ```
//!
//! with t* = π²νt/4d², Eq. (39). In print a product stands where the second minus should be.

use std::f64::consts::{FRAC_PI_2, PI};

/// Terms of the series: at t* = 10⁻⁴ the last is e^{−400}.
const TERMS: usize = 1000;

/// The flow at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Channel {
    /// t*; infinite for the steady flow.
    pub time: f64,
}

impl Channel {
    /// u/U₀ at y/d.
    pub fn velocity(self, y: f64) -> f64 {
        let c = 32.0 / (PI * PI * PI);
        1.0 - y * y - c * self.series(y, |k| 1.0 / (k * k * k))
    }

    /// ∂²u/∂y² in U₀/d².
    pub fn viscous_term(self, y: f64) -> f64 {
        // Each mode is multiplied by −(kπ/2)².
        -2.0 + 8.0 / PI * self.series(y, |k| 1.0 / k)
    }

    /// Eq. (36) as printed: 1 − 32/π³ (y/d)² Σ ….
    pub fn as_printed(self, y: f64) -> f64 {
        1.0 - 32.0 / (PI * PI * PI) * y * y * self.series(y, |k| 1.0 / (k * k * k))
    }

    /// Σ_n (−1)ⁿ c(2n+1) cos((2n+1)πy/2) exp(−(2n+1)² t*), smallest terms first.
    fn series(self, y: f64, c: impl Fn(f64) -> f64) -> f64 {
        let term = |n: usize| {
            let k = (2 * n + 1) as f64;
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let decay = if self.time == 0.0 { 1.0 } else { libm::exp(-k * k * self.time) };
            sign * c(k) * libm::cos(k * FRAC_PI_2 * y) * decay
        };
        (0..TERMS).rev().map(term).sum()
    }
}
