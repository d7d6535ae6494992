//! Sums over reciprocal shells, Σ_n A_n cos(|K_n| ρ − φ): values, bounds, extremes.
//!
//! On a line of one particle a cell they are Bernoulli polynomials of the fraction of ρ/a:
//! 2 Σ_k (2πk)^{−n} cos(2πkθ − nπ/2) = −B_n({θ})/n!. In more dimensions shells |K| = 2π c √n with equal squarefree n are
//! commensurate; those of different n have frequencies independent over the rationals, so that all classes come near their
//! extremes together (Kronecker): the supremum is the sum of theirs.

use super::epstein::bernoulli;
use super::spheres::{Reciprocal, Spheres};
use super::tail::Spherical;
use crate::exact::{MultiIndex, Rational, rational_to_f64};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, ToPrimitive};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Points per oscillation of the fastest wave when an extreme is looked for.
const POINTS: usize = 32;

/// A term that oscillates with R/Δ, prefactor (Δ/h)^exponent taken out.
#[derive(Debug, Clone)]
pub(super) struct Oscillation {
    /// Which knot.
    pub(super) knot: usize,
    /// The knot over R.
    pub(super) over_support: Rational,
    /// By shell: A_n.
    shells: Vec<f64>,
    /// φ.
    phase: f64,
    /// On a line: −factor/n! and the coefficients of B_n, ascending; `shells` is empty then.
    line: Option<Vec<f64>>,
    /// The cell of the line in Δ.
    cell: f64,
    /// Bound of what the shells left out add; infinite where the sum does not converge absolutely.
    pub(super) beyond: f64,
    /// Bound of |Σ|, what is left out included.
    pub(super) bound: f64,
}

/// What a term is made from.
pub(super) struct Ingredients<'a> {
    /// Which knot.
    pub(super) knot: usize,
    /// The knot over R.
    pub(super) over_support: &'a Rational,
    /// P of [`super::tail::of_knot`].
    pub(super) polynomial: &'a Spherical,
    /// F ρ^{(D−1)/2}.
    pub(super) factor: f64,
    /// N.
    pub(super) order: usize,
    /// M.
    pub(super) degree: u32,
}

impl Oscillation {
    pub(super) fn new(
        reciprocal: &Reciprocal,
        spheres: &Spheres,
        dimension: usize,
        of: &Ingredients,
    ) -> Self {
        let exponent = (dimension as f64 + 1.0) / 2.0 + of.order as f64;
        // i^M, of which the structure factor takes the part that is not real.
        let sign = if (of.degree / 2) % 2 == 0 { 1.0 } else { -1.0 };
        let phase = (dimension as f64 + 1.0) * PI / 4.0 + (f64::from(of.degree) + of.order as f64) * PI / 2.0;
        let mut oscillation = Self {
            knot: of.knot,
            over_support: of.over_support.clone(),
            shells: Vec::new(),
            phase,
            line: None,
            cell: reciprocal.density,
            beyond: 0.0,
            bound: 0.0,
        };
        if dimension == 1 && reciprocal.is_simple() {
            let n = 1 + of.order;
            // A wave of an even M has its sign twice.
            let factor = of.factor * of.polynomial.values().map(rational_to_f64).sum::<f64>();
            let numbers = bernoulli(n);
            let mut coefficients = vec![0.0; n + 1];
            let (mut binomial, mut factorial) = (1.0, 1.0);
            for (k, number) in numbers.iter().enumerate() {
                // B_n(x) = Σ_k C(n, k) B_k x^{n−k}.
                coefficients[n - k] = binomial * rational_to_f64(number);
                binomial *= (n - k) as f64 / (k + 1) as f64;
                factorial *= if k == 0 { 1.0 } else { k as f64 };
            }
            let scale = -factor * libm::pow(oscillation.cell, n as f64) / factorial;
            // |B_n({x})|/n! ≤ 2 ζ(n) (2π)^{−n} ≤ 4 (2π)^{−n}, n ≥ 2; |B_1| ≤ 1/2.
            let most = if n == 1 { 0.5 } else { 4.0 * libm::pow(TAU, -(n as f64)) * factorial };
            oscillation.bound = scale.abs() * most;
            oscillation.line = Some(coefficients.into_iter().map(|c| c * scale).collect());
            return oscillation;
        }
        let moduli: f64 = of.polynomial.values().map(|c| rational_to_f64(c).abs()).sum();
        let mut shells = vec![0.0; spheres.wave_numbers.len()];
        for (nu, c) in of.polynomial {
            let c = rational_to_f64(c);
            for (shell, sum) in shells.iter_mut().zip(spheres.of(nu)) {
                *shell += c * sum;
            }
        }
        for (shell, k) in shells.iter_mut().zip(&spheres.wave_numbers) {
            *shell *= sign * of.factor * libm::pow(*k, -exponent);
        }
        oscillation.beyond = of.factor * moduli * reciprocal.beyond(spheres.radius, exponent);
        oscillation.bound = shells.iter().map(|a| a.abs()).sum::<f64>() + oscillation.beyond;
        oscillation.shells = shells;
        oscillation
    }

    /// The sum at R/Δ; `turns` holds cos and sin of |K_n| ρ by shell.
    pub(super) fn at(&self, support_over_dx: f64, turns: &[(f64, f64)]) -> f64 {
        if let Some(coefficients) = &self.line {
            let theta = rational_to_f64(&self.over_support) * support_over_dx / self.cell;
            let x = theta - theta.floor();
            return coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c);
        }
        let (sine, cosine) = libm::sincos(self.phase);
        self.shells.iter().zip(turns).map(|(a, (c, s))| a * (c * cosine + s * sine)).sum()
    }

    fn is_line(&self) -> bool {
        self.line.is_some()
    }
}

/// cos and sin of |K_n| ρ by shell.
pub(super) fn turns(spheres: &Spheres, over_support: &Rational, support_over_dx: f64) -> Vec<(f64, f64)> {
    let rho = rational_to_f64(over_support) * support_over_dx;
    let turn = |k: &f64| {
        let (sine, cosine) = libm::sincos(k * rho);
        (cosine, sine)
    };
    spheres.wave_numbers.iter().map(turn).collect()
}

/// The least and the greatest value of a sum of oscillations over all R/Δ, each with the same bound of its error.
pub(super) fn extremes(spheres: &Spheres, oscillations: &[&Oscillation]) -> (f64, f64, f64) {
    let beyond: f64 = oscillations.iter().map(|o| o.beyond).sum();
    if !beyond.is_finite() {
        return (f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY);
    }
    if oscillations.iter().all(|o| o.is_line()) {
        return extremes_on_a_line(oscillations);
    }
    let mut classes: BTreeMap<&BigInt, Vec<Wave>> = BTreeMap::new();
    for oscillation in oscillations {
        for ((free, multiple), amplitude) in spheres.roots.iter().zip(&oscillation.shells) {
            let wave = Wave {
                frequency: multiple * &oscillation.over_support,
                amplitude: *amplitude,
                phase: oscillation.phase,
            };
            classes.entry(free).or_default().push(wave);
        }
    }
    let (mut low, mut high, mut error) = (0.0, 0.0, beyond);
    for waves in classes.values() {
        let (least, greatest, slack) = extremes_of_class(waves);
        low += least;
        high += greatest;
        error += slack;
    }
    (low, high, error)
}

struct Wave {
    frequency: Rational,
    amplitude: f64,
    phase: f64,
}

/// By sampling a trigonometric polynomial of degree H at P points of its period: it falls by less than
/// max|p| (πH/P)²/2 between an extreme and the nearest point (Bernstein), half of which is added.
fn extremes_of_class(waves: &[Wave]) -> (f64, f64, f64) {
    if let [wave] = waves {
        return (-wave.amplitude.abs(), wave.amplitude.abs(), 0.0);
    }
    // Frequencies as whole multiples of their common measure.
    let denominator = waves.iter().fold(BigInt::one(), |lcm, wave| lcm.lcm(wave.frequency.denom()));
    let whole: Vec<BigInt> =
        waves.iter().map(|wave| wave.frequency.numer() * (&denominator / wave.frequency.denom())).collect();
    let common = whole.iter().fold(BigInt::from(0), |gcd, n| gcd.gcd(n));
    let harmonics: Vec<usize> = whole.iter().map(|n| (n / &common).to_usize().unwrap_or(1)).collect();
    let degree = harmonics.iter().copied().max().unwrap_or(1);
    let points = POINTS * degree;
    let table: Vec<(f64, f64)> = (0..points).map(|i| libm::sincos(TAU * i as f64 / points as f64)).collect();
    let waves: Vec<(usize, f64, f64)> = waves
        .iter()
        .zip(&harmonics)
        .map(|(wave, harmonic)| {
            let (sine, cosine) = libm::sincos(wave.phase);
            (*harmonic, wave.amplitude * cosine, wave.amplitude * sine)
        })
        .collect();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..points {
        let value: f64 = waves
            .iter()
            .map(|(harmonic, c, s)| {
                let (sine, cosine) = table[(i * harmonic) % points];
                c * cosine + s * sine
            })
            .sum();
        low = low.min(value);
        high = high.max(value);
    }
    let step = PI / POINTS as f64;
    let slack = low.abs().max(high.abs()) / libm::cos(step) * step * step / 4.0;
    (low - slack, high + slack, slack)
}

/// Over the common period of piecewise polynomials; steps as small as make what lies between them negligible, bounded by
/// their slopes.
fn extremes_on_a_line(oscillations: &[&Oscillation]) -> (f64, f64, f64) {
    let Some(first) = oscillations.first() else { return (0.0, 0.0, 0.0) };
    // ρ/a = θ has period 1: R/Δ has period a · lcm(denominators) over gcd(numerators).
    let lcm = oscillations.iter().fold(BigInt::one(), |lcm, o| lcm.lcm(o.over_support.denom()));
    let period = first.cell * lcm.to_f64().unwrap_or(1.0);
    let count = 4096 * lcm.to_usize().unwrap_or(1);
    let step = period / count as f64;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..count {
        // Both sides of a whole θ, where a sum may jump.
        for side in [1e-12, step / 2.0, step * (1.0 - 1e-12)] {
            let u = i as f64 * step + side;
            let value: f64 = oscillations.iter().map(|o| o.at(u, &[])).sum();
            low = low.min(value);
            high = high.max(value);
        }
    }
    let slope: f64 = oscillations.iter().map(|o| o.steepest()).sum();
    // Points at both ends and the middle of each step: no place is farther than step/4.
    let error = slope * step / 4.0;
    (low, high, error)
}

impl Oscillation {
    /// A bound of |d/d(R/Δ)| between the jumps, on a line.
    fn steepest(&self) -> f64 {
        let rate = rational_to_f64(&self.over_support) / self.cell;
        let coefficients = self.line.iter().flatten().enumerate();
        rate * coefficients.map(|(power, c)| power as f64 * c.abs()).sum::<f64>()
    }
}

/// The monomials that these polynomials need.
pub(super) fn monomials<'a>(polynomials: impl Iterator<Item = &'a Spherical>) -> Vec<MultiIndex> {
    let mut all: Vec<MultiIndex> = polynomials.flat_map(|p| p.keys().copied()).collect();
    all.sort();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{int, ratio};

    /// cos x − cos 2x lies between −2 and 9/8; the sum of moduli is 2.
    #[test]
    fn waves_of_one_class_interfere() {
        let wave = |frequency, phase| Wave { frequency, amplitude: 1.0, phase };
        let (low, high, slack) = extremes_of_class(&[wave(ratio(1, 3), 0.0), wave(ratio(2, 3), PI)]);
        assert!(
            (low + 2.0).abs() <= 1.01 * slack && (high - 1.125).abs() <= 1.01 * slack && slack < 0.01,
            "{low} {high} {slack}"
        );
        let (low, high, _) = extremes_of_class(&[wave(int(7), 1.0)]);
        assert_eq!((low, high), (-1.0, 1.0));
    }
}
