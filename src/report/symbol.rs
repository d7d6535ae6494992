//! The Fourier symbol of an operator as a record and as text.

use crate::language::Coefficient;
use crate::measured::{Symbol, SymbolValue};
use crate::record::significant;
use serde::Serialize;
use std::fmt::Write as _;

/// The symbol along one direction, and what the operator does not see.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SymbolReport {
    /// Its id, or its text.
    pub operator: String,
    /// What it approximates, if that is known.
    pub approximates: Option<String>,
    /// The order of the target's derivative.
    pub order: Option<u8>,
    /// Unit vector along which k is taken.
    pub direction: Vec<f64>,
    /// The waves, from long to short.
    pub waves: Vec<WaveReport>,
    /// Waves that the operator takes to zero and its target does not, as k Δ: the half reciprocal vectors, and zeros along
    /// the direction.
    pub null_modes: Vec<NullMode>,
    /// Into how many sets the particles fall that no weight connects; null if infinitely many.
    pub decoupled_sets: Option<u64>,
}

/// One wave. Values by component of the field, then of the operator's value, each real and imaginary part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WaveReport {
    /// |k| Δ.
    pub k: f64,
    /// σ(k), in units of a power of 1/Δ.
    pub symbol: Vec<[f64; 2]>,
    /// The target's.
    pub exact: Vec<[f64; 2]>,
    /// k′Δ, the wavenumber for which the target would have this symbol, as far as it points along the target's; of a
    /// second derivative null where that would be imaginary.
    pub modified: Option<f64>,
    /// |σ − exact| / |exact|.
    pub error: Option<f64>,
}

/// A wave that is not seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NullMode {
    /// k Δ.
    pub k: Vec<f64>,
    /// `half reciprocal vector` or `along the direction`.
    pub at: &'static str,
}

/// Waves tried between two that are printed, when zeros are looked for.
const BETWEEN: usize = 32;

/// The symbol of an operator at `count` waves along a unit vector, up to the wave that is shortest on a lattice of spacing Δ,
/// |k| Δ = π.
pub fn symbol_report(
    operator: &Coefficient,
    symbol: &Symbol,
    dimension: usize,
    direction: [f64; 3],
    count: usize,
) -> SymbolReport {
    let order = operator.target().map(crate::language::Target::order);
    let at = |k: f64| symbol.at(direction.map(|n| n * k));
    let step = std::f64::consts::PI / count as f64;
    let waves = (1..=count).map(|n| wave(n as f64 * step, &at(n as f64 * step), order)).collect();
    let mut null_modes: Vec<NullMode> = symbol
        .half_reciprocal_vectors()
        .into_iter()
        .filter(|k| symbol.is_null_mode(*k))
        .map(|k| NullMode { k: k[..dimension].to_vec(), at: "half reciprocal vector" })
        .collect();
    // Zeros along the direction: where the part along the target changes its sign.
    let part = |k: f64| along(&at(k));
    let fine = step / BETWEEN as f64;
    for n in 1..count * BETWEEN {
        let (mut low, mut high) = (n as f64 * fine, (n + 1) as f64 * fine);
        if part(low).signum() == part(high).signum() {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if part(middle).signum() == part(low).signum() {
                low = middle;
            } else {
                high = middle;
            }
        }
        let k = direction.map(|n| n * low);
        let known = null_modes
            .iter()
            .any(|mode| mode.k.iter().zip(k).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 1e-6);
        if symbol.is_null_mode(k) && !known {
            null_modes.push(NullMode { k: k[..dimension].to_vec(), at: "along the direction" });
        }
    }
    SymbolReport {
        operator: operator.id().to_owned(),
        approximates: operator.target().map(|target| target.formula(operator.operator().field)),
        order,
        direction: direction[..dimension].to_vec(),
        waves,
        null_modes,
        decoupled_sets: symbol.decoupled_sets(),
    }
}

/// Re(σ · conj(exact)) / |exact|².
fn along(value: &SymbolValue) -> f64 {
    let products = value.symbol.iter().zip(&value.exact).map(|(s, e)| s[0] * e[0] + s[1] * e[1]);
    let squares = value.exact.iter().map(|e| e[0] * e[0] + e[1] * e[1]);
    products.sum::<f64>() / squares.sum::<f64>()
}

fn wave(k: f64, value: &SymbolValue, order: Option<u8>) -> WaveReport {
    let round = |parts: &[[f64; 2]]| -> Vec<[f64; 2]> {
        parts.iter().map(|z| z.map(|x| significant(x, 12))).collect()
    };
    let ratio = along(value);
    let distance = value.symbol.iter().zip(&value.exact);
    let off: f64 = distance.map(|(s, e)| (s[0] - e[0]).powi(2) + (s[1] - e[1]).powi(2)).sum();
    let size: f64 = value.exact.iter().map(|e| e[0] * e[0] + e[1] * e[1]).sum();
    let known = order.is_some() && size > 0.0;
    WaveReport {
        k,
        symbol: round(&value.symbol),
        exact: if known { round(&value.exact) } else { Vec::new() },
        modified: match order {
            Some(1) if known => Some(significant(k * ratio, 12)),
            Some(2) if known && ratio >= 0.0 => Some(significant(k * ratio.sqrt(), 12)),
            _ => None,
        },
        error: known.then(|| significant((off / size).sqrt(), 8)),
    }
}

impl SymbolReport {
    /// For people.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        let mut line = |text: String| {
            let _ = writeln!(out, "{text}");
        };
        let of = self.approximates.as_ref().map_or_else(String::new, |target| format!(" for {target}"));
        line(format!("Symbol of {}{of}, k along {}", self.operator, vector(&self.direction)));
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "–".to_owned(), |value| format!("{value:.digits$}"))
        };
        line(format!("  {:>10} {:>14} {:>12}", "k Δ", "modified k′Δ", "error"));
        for wave in &self.waves {
            let error = wave.error.map_or_else(|| "–".to_owned(), |error| format!("{error:.3e}"));
            line(format!("  {:>10.6} {:>14} {:>12}", wave.k, number(wave.modified, 8), error));
        }
        match self.null_modes.as_slice() {
            [] => line("No null modes at half reciprocal vectors, or along this direction.".into()),
            modes => {
                line("Null modes (waves that it does not see), k Δ:".into());
                for mode in modes {
                    line(format!("  {}  {}", vector(&mode.k), mode.at));
                }
            }
        }
        line(match self.decoupled_sets {
            Some(1) => "All particles are connected.".into(),
            Some(sets) => format!("The particles fall into {sets} sets that no weight connects."),
            None => "The particles fall into infinitely many sets that no weight connects.".into(),
        });
        out
    }
}

fn vector(k: &[f64]) -> String {
    let parts: Vec<String> = k.iter().map(|x| format!("{x:.6}")).collect();
    format!("({})", parts.join(", "))
}
