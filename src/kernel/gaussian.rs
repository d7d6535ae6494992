//! The Gaussian, cut off.
//!
//! w(q) = exp(−q²) for q < c, zero beyond, R = c h. R. A. Gingold & J. J. Monaghan, Mon. Not. R. Astron. Soc. 181 (1977)
//! 375–389. Its normalisation is that of the whole space, σ_D = π^{−D/2}, as codes use it: on its support it integrates to
//! less than 1, and at R it jumps to zero. G_k = (−2)^k exp(−q²).

use super::{Kernel, KernelError, Profile};
use crate::exact::{Enclosure, Rational, int, ratio, rational_from_decimal};
use num_bigint::{BigInt, BigUint};
use num_traits::{One, ToPrimitive, Zero};

/// The largest cut: beyond it, exp(−c²) is below 1e-27 and the truncation is no longer seen.
const LARGEST_CUT: i64 = 8;

/// The Gaussian cut at 3h.
pub fn gaussian() -> Kernel {
    of_cut("gaussian".into(), int(3))
}

/// `gaussian:cut=C`, from the text after the colon.
pub(super) fn with_parameters(parameters: &str) -> Result<Kernel, KernelError> {
    let cut = parameters
        .strip_prefix("cut=")
        .and_then(|text| text.trim().parse::<f64>().ok())
        .and_then(|value| rational_from_decimal(value).ok())
        .filter(|cut| *cut > int(0) && *cut <= int(LARGEST_CUT))
        .ok_or_else(|| KernelError::Cut { parameters: parameters.to_owned(), largest: LARGEST_CUT })?;
    if cut == int(3) {
        return Ok(gaussian());
    }
    Ok(of_cut(format!("gaussian:cut={}", crate::exact::rational_to_f64(&cut)), cut))
}

fn of_cut(id: String, cut: Rational) -> Kernel {
    let name = format!("Gaussian cut at {cut} h");
    Kernel::from_parts(id, name, "gingold-monaghan-1977; PySPH, Gaussian".into(), Profile::Gaussian { cut })
}

/// σ_D = π^{−D/2}.
pub(super) fn normalisation(dimension: usize, bits: u32) -> Enclosure {
    let working = bits + 8;
    let pi = Enclosure::pi(working + 8);
    let root = pi.sqrt(working + 8).unwrap_or_else(|error| unreachable!("π is positive: {error}"));
    let power = match dimension {
        1 => root,
        2 => pi,
        _ => &pi * &root,
    };
    Enclosure::from_i64(1)
        .div(&power, working)
        .unwrap_or_else(|error| unreachable!("a power of π is positive: {error}"))
}

/// ∫_0^c q^n exp(−q²) dq = exp(−c²) Σ_k 2^k c^{n+1+2k} / ((n+1)(n+3)…(n+1+2k)); all terms are positive.
pub(super) fn radial_integral(cut: &Rational, n: usize, bits: u32) -> Enclosure {
    let square = cut * cut;
    // The sum is exp(c²) times the integral, and no term exceeds it: c² / ln 2 < 3/2 c² binary digits.
    let growth = (&square * int(2)).ceil().to_integer().to_u32().unwrap_or(0);
    let working = bits + growth + 32;
    let first = (0..=n).fold(Rational::one(), |power, _| power * cut) / int(n as i64 + 1);
    let least = ratio(1, 2).pow(working as i32);
    let mut term = Enclosure::exact(&first, working);
    let mut sum = term.clone();
    for k in 1.. {
        let quotient = &square * ratio(2, n as i64 + 1 + 2 * k);
        term = term.scale(&quotient, working);
        sum = &sum + &term;
        // Once each term is less than half of the one before, the rest is less than the last.
        if quotient < ratio(1, 2) && term.midpoint() + term.radius() <= &least * int(4) {
            break;
        }
    }
    let rest = Enclosure::from_parts(BigInt::zero(), BigUint::from(4_u32), -i64::from(working));
    (&(&sum + &rest) * &Enclosure::exp_of_negative(&square, working)).round(bits + 8)
}
